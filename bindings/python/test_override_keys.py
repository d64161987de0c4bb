"""Tests of the keys of --vary: wrong ones are refused before any case; all keys of the shipped scenes are accepted."""
import csv
import pathlib
import re
import tomllib
import unittest

from drillmbd.scene.override_keys import refuse_wrong
from drillmbd.scene.overrides import key_of_path
from shared_tests import HERE, SHORT_RIG, FolderTest

EXAMPLES = pathlib.Path(HERE).parents[1] / "examples"
WRONG = (("hole.mu_dynamik=0.1,0.2", "'hole.mu_dynamik': hole has no key mu_dynamik; did you mean hole.mu_dynamic?"),
         ("hole[0].mu_dynamik=0.1", "did you mean hole[0].mu_dynamic?"),
         ("nosuch.key=1", "a scene has no table nosuch; possible are bit, body"),
         ("mu_dynamic=0.1", "did you mean hole.mu_dynamic or hole.section.mu_dynamic?"),
         ("string[main].pipes[0].lenght=1", "did you mean string[main].pipes[0].length? (drillmbd keys string.pipes"),
         ("time_function[turning].segment.h2=1", "possible are h0, h1, kind"),
         ("hole.diameter & hole.diametre=94 mm", "'hole.diametre': hole has no key diametre; did you mean hole.diam"),
         ("hole.diameter.low=1", "hole.diameter has no keys that --vary can set"),
         ("drive[0].motor=1", "'drive[0].motor': is a table; give one of its keys: drive[0].motor.brakes"),
         ("hole=94 mm", "'hole': is a table; give one of its keys: hole.approach_speed"),
         ("string[7].pipes[0].length=1", "string[7]: the scene has 1 such table, numbered from 0"),
         ("drive[2].gain=1", "drive[2]: the scene has 2 such tables, numbered from 0"),
         ("drive.gain=1", "drive.gain: drive holds no keys; name one of its items by [0], [1]"),
         ("joint[1].damping=1", "joint[1]: the scene has no such table"),
         ("joint[0].damping=1", "joint[0]: the scene has no such table; describe it in the scene file"),
         ("hole.section[0].diameter=96 mm", "hole.section[0]: the scene has no such table"),
         ("variability.scatter[0].men=1", "scatter[0] has no key men; did you mean variability.scatter[0].mean?"))
VARIABILITY = """[variability]
question = "torque-drag"
[[variability.scatter]]
keys = ["hole.mu_static", "hole.mu_dynamic"]
relative = true
distribution = "uniform"
low = 0.7
high = 1.3
[[failure]]
kind = "rig-torque"
limit = "100 N m"
"""


def leaves(table, path=()):
    """The keys of a scene with values, which --vary can write."""
    items = table.items() if isinstance(table, dict) else enumerate(table)
    for part, value in items:
        if isinstance(value, dict) or isinstance(value, list) and value and isinstance(value[0], dict):
            yield from leaves(value, path + (part,))
        elif re.fullmatch("[A-Za-z_].*", str(part)):
            yield key_of_path(path + (part,))


class OverrideKeysTest(FolderTest):
    SCENE = SHORT_RIG + VARIABILITY

    def test_wrong_keys_are_refused_before_any_case(self):
        for command in (("sweep", self.scene, "check"),
                        ("probability", self.scene, "--samples", 5, "--engine", "serial")):
            for vary, wanted in WRONG:
                said = self.call(*command, "--vary", vary, "-o", self.folder / "out", status=2)
                self.assertTrue(said.startswith("drillmbd: --vary '"), said)
                self.assertIn(wanted, said)
                self.assertEqual(list(self.folder.glob("out/*/")), [])

    def test_unknown_command(self):
        said = self.call("sweep", self.scene, "statics", "--vary", "hole.mu_dynamic=0.2", status=2)
        self.assertIn("argument COMMAND: invalid choice: 'statics'", said)
        self.assertIn("'torque-drag'", said)

    def test_each_key_once(self):
        for command in (("sweep", self.scene, "check"), ("probability", self.scene)):
            said = self.call(*command, "--vary", "hole.diameter=94 mm", "--vary", "hole[0].diameter=98 mm", status=2)
            self.assertIn("'hole.diameter': is given 2 times; give each key once", said)

    def test_faults_of_values_and_of_the_file_are_those_of_cases(self):
        for vary, wanted in (("hole.mu_dynamic=0.2,-1", "mu_dynamic = -1"), ("hole.diameter=94 mm,3 s", "3 s"),
                             ("string.pipes.count=8,-2", "count = -2")):
            out = self.folder / wanted
            self.call("sweep", self.scene, "check", "--vary", vary, "-o", out, status=1)
            with open(out / "sweep.csv", encoding="utf-8", newline="") as file:
                rows = list(csv.DictReader(file))
            self.assertEqual([row["status"] for row in rows], ["ok", "failed"])
            self.assertIn(wanted, rows[1]["message"])
        broken = self.write("broken.toml", self.SCENE + "\n[hole\n")
        self.call("sweep", broken, "check", "--vary", "hole.mu_dynamic=0.2", status=1)
        self.assertIn("did you mean", self.call("sweep", broken, "check", "--vary", "hole.mu_dynamik=0.2", status=2))

    def test_tables_that_the_scene_leaves_out_are_made(self):
        self.call("sweep", self.scene, "check", "--vary", "environment.fluid_density=1000 kg/m^3,1200 kg/m^3", "--vary",
                  "run.end=1 s", "--vary", "modes.count=3", "--vary", "hole.section.diameter=96 mm", "--vary",
                  "hole.section.depth=3 m")

    def test_keys_of_the_shipped_scenes_are_accepted(self):
        count = 0
        for file in sorted(EXAMPLES.rglob("*.toml")):
            content = tomllib.loads(file.read_text(encoding="utf-8-sig"))
            if "hole" in content or "string" in content:
                refuse_wrong(list(leaves(content)), content)
                count += 1
        self.assertGreater(count, 5)


if __name__ == "__main__":
    unittest.main()
