"""Tests of rod-by-rod: each number of rods against a scene that has only these, limits, lock-up, units."""
import csv
import math
import unittest

from shared_tests import FolderTest, needs

needs("numpy")

from drillmbd import rig_limits, rod_by_rod, scene as scenes  # noqa: E402

SCENE = """title = "curved hole"
[hole]
diameter = "94 mm"
survey = [["0 m", "80 deg", "0 deg"], ["20 m", "85 deg", "3 deg"], ["60 m", "95 deg", "0 deg"]]
mu_static = 0.30
mu_dynamic = 0.30
[[time_function]]
name = "turning"
segment = {kind = "step5", x1 = "1 s", h1 = "100 rpm"}
[[string]]
name = "main"
start_depth = "2 m"
[[string.pipes]]
count = 8
length = "1.5 m"
outer_diameter = "73 mm"
inner_diameter = "59 mm"
[[string.pipes]]
count = 2
length = "3 m"
outer_diameter = "80 mm"
inner_diameter = "40 mm"
[[bit]]
name = "bit"
mass = "6 kg"
diameter = "94 mm"
load = "5 kN"
[[drive]]
name = "feed"
time_function = "10 mm/s"
[[drive]]
name = "head"
component = "rx"
time_function = "turning"
"""


class RodsTest(FolderTest):
    """The command."""
    SCENE = SCENE

    def test_no_all_clear_without_a_load_on_the_bit(self):
        """Thrust and torque of drilling are not known then: no OK, and it is said; a limit of the pull alone is
        assessed."""
        bare = SCENE.replace('load = "5 kN"\n', "")
        for limits, cleared in (('[limits]\ntorque = "50 kN m"\npull = "500 kN"\n', False),
                                ('[limits]\npull = "500 kN"\n', True)):
            for text, drilled in ((bare, False), (SCENE, True)):
                scene = self.write("bare.toml", text + limits)
                out = self.call("rod-by-rod", scene)
                self.assertEqual((", OK\n" in out, "drilling is not assessed" in out),
                                 (cleared or drilled, not cleared and not drilled), out)
                self.assertEqual("drilling is not assessed" in self.call("torque-drag", scene, "--depths", "2"),
                                 not cleared and not drilled)
        law = self.write("law.toml", SCENE.replace('diameter = "94 mm"\nload', 'diameter = 0\nload')
                         + '[limits]\ntorque = "50 kN m"\n')
        for command in ("rod-by-rod", "torque-drag"):
            self.assertIn("the torque of drilling is not assessed", self.call(command, law))
            self.assertNotIn("not assessed, because that", self.call(command, law, "--torque-on-bit", "100 N m"))

    def test_each_number_of_rods(self):
        """The same loads as of a scene that has only the rods in the hole, from the bit on, at the depth that they
        reach."""
        out, summary = self.results("rod-by-rod")
        rows = summary["rod_by_rod"]["main"]["rods"]
        self.assertEqual([row["depth_m"] for row in rows], [5.0, 8.0, 9.5, 11.0, 12.5, 14.0, 15.5, 17.0, 18.5, 20.0])
        for rods in (1, 2, 5, 10):
            text = SCENE.replace("count = 2", f"count = {min(rods, 2)}")
            text = text.replace("count = 8", f"count = {rods - 2}") if rods > 2 else text.replace(
                text[text.index("[[string.pipes]]\ncount = 8"):text.index("[[string.pipes]]\ncount = "
                                                                          + str(min(rods, 2)))], "")
            with scenes.load(self.write("few.toml", text)).new_sim() as sim:
                from drillmbd.operating import operating, operations_of
                found = sim.torque_drag(operations_of(operating(scenes.load(self.folder / "few.toml")))).rows[0]
            row = rows[rods - 1]
            self.assertAlmostEqual(found[0].depth, row["depth_m"], 9)
            self.assertAlmostEqual(max(one.torque for one in found), row["torque_N_m"], 6)
            self.assertAlmostEqual(max(-one.hook_load for one in found), row["push_N"], 6)
            self.assertAlmostEqual(max(max(one.hook_load for one in found), 0.0), row["pull_N"], 6)
            self.assertEqual(row["make_up_above_N_m"], row["torque_N_m"])
        self.assertIn("number of rods within limits: not assessed", out)
        self.assertIn("make-up torque: not assessed, because none is given", out)
        self.assertIn("rods_main.png", summary["files"])

    def test_limits(self):
        _, free = self.results("rod-by-rod")
        torque = [row["torque_N_m"] for row in free["rod_by_rod"]["main"]["rods"]]
        between = 0.5 * (torque[5] + torque[6])
        out, summary = self.results("rod-by-rod", "--make-up", f"{between!r} N m")
        found = summary["rod_by_rod"]["main"]
        self.assertEqual(found["rods_within_limits"], 6)
        self.assertEqual([row["verdict"] for row in found["rods"]][6:], ["OVER"] * 4)
        self.assertIn("6 rods stay within the given limits, bit at 14 m; rod 7 exceeds make-up torque", out)
        self.scene = self.write("limits.toml",
                                SCENE + '[limits]\ntorque = "100 kN m"\npush = "100 kN"\npull = "100 kN"\n')
        out, summary = self.results("rod-by-rod", "--make-up", "100 kN m")
        self.assertIn("all 10 rods stay within the given limits", out)
        self.assertNotIn("torque: not assessed", out)
        self.assertIn("must be > 0", self.call("rod-by-rod", self.scene, "--make-up", "0 N m", status=2))
        self.assertIn("--make-up", self.call("rod-by-rod", self.scene, "--make-up", "2 kN", status=2))

    def test_rock_law(self):
        """Its load is added in a run only: thrust is not cleared, unless the load is given."""
        self.scene = self.write("cuts.toml", SCENE.replace("[[bit]]\n", '[[bit]]\nrock_law = "rate"\n')
                                + '[limits]\npush = "100 kN"\n')
        for more, wanted in (((), "NOT ASSESSED"), (("--weight-on-bit", "5 kN"), "OK")):
            out, summary = self.results("rod-by-rod", *more)
            self.assertEqual({row["verdict"] for row in summary["rod_by_rod"]["main"]["rods"]}, {wanted})
            self.assertEqual("because a rock law gives load and torque of the bit in a run only" in out, not more)
            _, summary = self.results("torque-drag", *more)
            self.assertEqual(summary["rig_limits"]["main"]["drilling_assessed"], bool(more))

    def test_each_string_by_its_own_drives_and_bit(self):
        """Two strings have the results of scenes with one of them: load and torque of the bit, rotation and feed are
        those of the string, whichever is described first."""
        begin = SCENE.index("[[time_function]]")
        other = (SCENE[begin:].replace('"main"', '"other"').replace("5 kN", "3 kN").replace(
            '"bit"', '"other bit"').replace('"94 mm"', '"90 mm"').replace('"feed"', '"other feed"').replace(
                '"10 mm/s"', '"4 mm/s"').replace('"head"', '"other head"').replace("73 mm", "76 mm"))
        other = other.replace('[[bit]]\n', '[[bit]]\nstring = "other"\n').replace(
            '[[drive]]\n', '[[drive]]\npart = "other"\n').replace('"turning"', '"slower"').replace("100 rpm", "40 rpm")
        named = SCENE[begin:].replace('[[bit]]\n', '[[bit]]\nstring = "main"\n').replace(
            '[[drive]]\n', '[[drive]]\npart = "main"\n')
        alone = {}
        for name, text in (("main", named), ("other", other)):
            self.scene = self.write("one.toml", SCENE[:begin] + text)
            _, alone[name] = self.results("torque-drag", "--depths", "3")
            self.assertEqual(list(alone[name]["torque_drag"]), [name])
            _, alone[name + " rods"] = self.results("rod-by-rod")
        rest = named.index("[[bit]]")  # of the other string are the first bit and the first drives of the file
        for text in (other + named, named[:rest] + other + named[rest:]):
            self.scene = self.write("both.toml", SCENE[:begin] + text)
            said, both = self.results("torque-drag", "--depths", "3")
            _, rods = self.results("rod-by-rod")
            for name, load in (("main", "5 kN"), ("other", "3 kN")):
                self.assertIn(f"{name}: weight on bit {load}", said)
                self.assertEqual(both["torque_drag_by_depth"][name], alone[name]["torque_drag_by_depth"][name])
                self.assertEqual(both["operations_by_string"][name], alone[name]["operations"])
                self.assertEqual(rods["rod_by_rod"][name], alone[name + " rods"]["rod_by_rod"][name])
        # of the first string only: a study has the same demands with and without the other one
        study = """[variability]
question = "torque-drag"
[[variability.scatter]]
name = "friction"
keys = ["hole.mu_static", "hole.mu_dynamic"]
distribution = "uniform"
low = 0.29
high = 0.31
[[failure]]
kind = "rig-torque"
head = "head"
limit = "1 kN m"
"""
        needs("scipy")
        from drillmbd.probability.sample import SceneSample
        first, = SceneSample(SCENE[:begin] + named + study)(0, [0.3]).demands
        for text in (named + other, named[:rest] + other + named[rest:]):
            found, = SceneSample(SCENE[:begin] + text + study)(0, [0.3]).demands
            self.assertAlmostEqual(found / first, 1.0, 9)

    def test_lock_up(self):
        """A string that locks up is over any limit, and without one too."""
        loads = {key: rig_limits.Load(math.inf if key == "push" else 0.0, "slide")
                 for key, _, _ in rig_limits.QUANTITIES}
        free = {key: rig_limits.Load(1.0, "drill") for key, _, _ in rig_limits.QUANTITIES}
        rows = [rod_by_rod.Row(1, 3.0, free), rod_by_rod.Row(2, 6.0, loads)]
        for limits in ({}, {"torque": 5.0}):
            self.assertEqual(rows[1].verdict(limits), "OVER")
            self.assertEqual(rod_by_rod.within(rows, limits), 1)
            self.assertIn("with rod 2 the string locks up (slide)", rod_by_rod._reach(rows, limits, rod_by_rod.Units()))

    def test_units(self):
        out, summary = self.results("rod-by-rod", "--units", "field")
        self.assertEqual(summary["units"], "field")
        with open(self.folder / "out" / "rods_main.csv", encoding="utf-8") as file:
            table = list(csv.reader(file))
        self.assertEqual(table[0][:3], ["rods", "depth of the bit [ft]", "thrust [lbf]"])
        self.assertAlmostEqual(float(table[1][1]), 5.0 / 0.3048)
        self.assertIn("ft-lbf", out)

    def test_sweep(self):
        self.call("sweep", self.scene, "rod-by-rod", "--vary", "hole.mu_dynamic=0.2,0.3", "-o", self.folder / "sweep",
                  "-q")
        with open(self.folder / "sweep" / "sweep.csv", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([row["status"] for row in rows], ["ok", "ok"])


if __name__ == "__main__":
    unittest.main()
