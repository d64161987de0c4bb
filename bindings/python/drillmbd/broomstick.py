"""Hook load by depth for several friction coefficients, or for multiples of the wall's own: the broomstick picture."""
from __future__ import annotations

import math
import tomllib
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from . import enums
from ._structs import TorqueDragRow, WallDef
from .analysis import operation_name
from .results import CommandOutput, file_name
from .scene import CannotSave, Scene, loads, saves
from .sim import Sim

if TYPE_CHECKING:
    from .torque_drag import Curves, Settings

KINDS = (enums.OPERATION_PICK_UP, enums.OPERATION_SLACK_OFF, enums.OPERATION_ROTATE)
FACTORS = (0.5, 1.0, 1.5)   #: of the wall's friction coefficient, where no coefficients are given
SAMPLES = 101


@dataclass
class Family:
    """The rows of all depths for one friction."""
    label: str                            #: "friction 0.3", "0.5 x the wall's friction"
    value: float                          #: the coefficient, or the factor
    rows: list[list[TorqueDragRow]]


def wall_frictions(scene: Scene, first: float, last: float) -> list[float]:
    """The wall's dynamic coefficient at places spread evenly between two depths [m]."""
    depths = [first + (last - first) * (i + 0.5) / SAMPLES for i in range(SAMPLES)]
    return [float(scene.model.hole(depth).mu_dynamic) for depth in depths]


def wall_friction(scene: Scene, first: float, last: float) -> float:
    """The mean of these."""
    return sum(wall_frictions(scene, first, last)) / SAMPLES


def _scaled(scene: Scene, factor: float) -> Scene | None:
    """The scene with all friction coefficients of the wall times a factor; None if no section has its own, or if it
    cannot be written."""
    try:
        text = saves(scene, False)
    except CannotSave:
        return None
    hole = tomllib.loads(text).get("hole", {})
    sections = hole.get("section", [])
    if not any("mu_dynamic" in one for one in sections):
        return None
    usual = WallDef()
    table = hole.get("friction_table")
    changes: dict[str, Any] = {"hole.friction_table": [[speed, factor * mu] for speed, mu in table]} if table else {
        f"hole.{key}": factor * float(hole.get(key, getattr(usual, key))) for key in ("mu_static", "mu_dynamic")}
    changes.update({f"hole.section[{number}].{key}": factor * float(one[key]) for number, one in enumerate(sections)
                    for key in ("mu_static", "mu_dynamic") if key in one})
    return loads(text, changes=changes)


def _families(scene: Scene, sim: Sim, out: CommandOutput, curves: Curves, settings: Settings,
              depths: list[float]) -> list[Family]:
    operations = [settings.operations[kind] for kind in KINDS]
    frictions, base, found = settings.frictions, settings.more.get("friction"), list[Family]()
    if not frictions and base is None:
        for factor in FACTORS:
            scaled = _scaled(scene, factor)
            if scaled is None:
                break
            with scaled.new_sim() as other:
                rows = other.torque_drag(operations, depths, string=scaled.names[curves.name]).rows
            found.append(Family(f"{factor:g} x the wall's friction", factor, rows))
        if found:
            out.say(f"{curves.name}, broomstick: 0.5, 1 and 1.5 times the wall's friction at each depth")
            return found
    if not frictions:
        mean = wall_friction(scene, 0.0, depths[-1]) if base is None else base
        frictions = [round(factor * mean, 12) for factor in FACTORS] if mean > 0.0 else [0.0]
        out.say(f"{curves.name}, broomstick: friction coefficients {', '.join(f'{one:.4g}' for one in frictions)}"
                   + (f" (0.5, 1 and 1.5 times that of {'the wall' if base is None else '--friction'})" if mean > 0.0
                      else ""))
    return [Family(f"friction {one:.4g}", one, sim.torque_drag(operations, depths, string=curves.string,
                                                               friction=one).rows) for one in frictions]


def write(scene: Scene, sim: Sim, out: CommandOutput, curves: Curves, settings: Settings) -> None:
    """Table, picture and summary, and the depths at which the string locks up."""
    depths = [float(one) for one in curves.found.column("depth")]
    families = _families(scene, sim, out, curves, settings, depths)
    words = [operation_name(kind) for kind in KINDS]
    columns = {(word, one.label): [curves.hook_load(row[number]) for row in one.rows]
               for number, word in enumerate(words) for one in families}
    torques = {one.label: [float(row[2].torque) for row in one.rows] for one in families}
    for (word, label), column in columns.items():
        locked = next((depth for depth, value in zip(depths, column) if not math.isfinite(value)), None)
        if locked is not None:
            out.say(f"{curves.name}, {word}, {label}: locks up from {out.units.text(locked, 'm')} on")
    by_factor = not families[0].label.startswith("friction")
    out.summary.setdefault("broomstick", {})[curves.name] = {
        "depth_m": depths, "friction": None if by_factor else [one.value for one in families],
        "factor": [one.value for one in families] if by_factor else None,
        **{f"{word}_hook_load_N": [columns[word, one.label] for one in families] for word in words},
        "rotate_torque_N_m": list(torques.values())}
    heads = ["depth [m]", *(f"{word}, {label}: hook load [N]" for word, label in columns),
             *(f"rotate, {label}: torque [N m]" for label in torques)]
    out.table(f"broomstick_{file_name(curves.name)}.csv", heads, zip(depths, *columns.values(), *torques.values()))
    title = curves.name + (f", with {out.units.scaled(curves.block_weight, 'N')} of block and top drive"
                           if curves.block_weight else "")
    out.picture(f"broomstick_{file_name(curves.name)}.png", lambda plots: plots.broomstick(
        depths, columns, torques, title, {word: (one.depths, one.values) for word, one in settings.series.items()},
        out.units))
