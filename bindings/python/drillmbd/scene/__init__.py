"""Scene files: a drill string in its hole, its rig and the settings of commands, in TOML with units. Frames, angles and
signs: examples/conventions/README.md.

    from drillmbd import scene
    rig = scene.load("rig.toml")          # SceneError lists all faults, with lines
    with rig.new_sim() as sim: ...
    scene.save(rig, "copy.toml")
"""
from .content import Scene
from .load import load, loads
from .problems import Problem, SceneError
from .save import CannotSave, save, save_record, saves

__all__ = ["CannotSave", "Problem", "Scene", "SceneError", "load", "loads", "save", "save_record", "saves"]
