"""Tests of the command: every analysis of a scene with its files, what is refused with its exit status, Ctrl-C,
help."""
import csv
import importlib.util
import json
import math
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import time
import types
import unittest

from shared_tests import COMMAND, ENVIRONMENT, HERE, SHORT_RIG, FolderTest, needs

needs("numpy")


SCENE = 'title = "short rig"\n' + SHORT_RIG + """[run]
end = "20 ms"
step = "1 ms"
static = true
[results]
interval = "2 ms"
vtk_interval = "10 ms"
[[output]]
name = "torque [N m]"
quantity = "drive-force"
place = "head"
[static]
slip_axial = "1 mm/s"
[modes]
count = 5
[response]
frequency_low = "1 Hz"
frequency_high = "30 Hz"
points = 30
[[response.excitation]]
kind = "eccentricity"
[[response.output]]
name = "middle"
place = {part = "main", pipe = 4}
quantity = "vibration-z"
[speeds]
speed_low = "30 rpm"
speed_high = "300 rpm"
points = 30
[[speeds.order]]
order = 1
[[speeds.output]]
name = "middle"
place = {part = "main", pipe = 4}
quantity = "vibration-z"
limit = "0.01 um"
"""

def drilled(scene):
    """The scene with a load on the bit, of which the torque of the bit is estimated."""
    return scene.replace('diameter = 0\n', 'diameter = "94 mm"\nload = "100 N"\n')


COLUMN = """[environment]
gravity = [0, 0, 0]
[[string]]
name = "column"
follows_hole = false
start_free = []
[[string.pipes]]
count = 5
section_stiffness = ["1e12 N", "1e12 N", "1e12 N", "1e5 N m2", "1e5 N m2", "1e5 N m2"]
[[time_function]]
name = "none yet"
segment = {h0 = 0}
[[load]]
name = "push"
place = {part = "column", pipe = "last", fraction = 1.0}
force = ["-1 N", 0, 0]
time_function = "none yet"
[buckling]
scale = "part"
part = "push"
"""


class CommandTest(FolderTest):
    SCENE = SCENE

    def setUp(self):
        super().setUp()
        self.output = self.folder / "out"

    def results(self, command, *more):
        out = self.call(command, self.scene, "--output", self.output, *more)
        summary = json.loads((self.output / "summary.json").read_text(encoding="utf-8"))
        for name in summary["files"]:
            self.assertGreater((self.output / name).stat().st_size, 30, name)
        return out, summary

    def test_check(self):
        out, summary = self.results("check")
        self.assertIn("degrees of freedom", out)
        self.assertEqual(summary["model"]["pipes"], 8)

    def test_static(self):
        out, summary = self.results("static")
        self.assertIn("axial force", out)
        self.assertIn("static_main.csv", summary["files"])
        self.assertIn("static.vtp", summary["files"])
        self.assertEqual(summary["static"]["status_name"], "OK")
        with open(self.output / "static_main.csv", encoding="utf-8", newline="") as file:
            rows = list(csv.reader(file))
        self.assertEqual(len(rows), 18)
        self.assertEqual(rows[0][5], "axial force [N]")

    def test_rigid_pipes(self):
        """Forces are those of the pipes that have some; a string of rigid pipes alone has none."""
        mixed = self.SCENE.replace("[[string.pipes]]\n", '[[string.pipes]]\nkind = "rigid"\n[[string.pipes]]\n', 1)
        for count, scene in (("some", mixed), ("all", self.SCENE.replace("[[string.pipes]]\n",
                                                                         '[[string.pipes]]\nkind = "rigid"\n', 1))):
            with self.subTest(rigid=count):
                self.scene = self.write(f"{count}.toml", scene)
                self.output = self.folder / count
                out, summary = self.results("static")
                axial = summary["strings"]["main"]["axial_force_N"]
                self.assertNotIn("nan", out)
                self.assertEqual("rigid pipes, which have no section forces" in out, count == "all")
                self.assertEqual(axial == [None, None], count == "all")

    def test_run_and_its_hash(self):
        out, summary = self.results("run")
        self.assertEqual(summary["run"]["steps"], 20)
        self.assertIn("ran to 0.02 s", out)
        with open(self.output / "run.csv", encoding="utf-8", newline="") as file:
            rows = list(csv.reader(file))
        self.assertEqual((len(rows), rows[0]), (12, ["time [s]", "torque [N m]"]))
        self.assertEqual(len([name for name in summary["files"] if name.startswith("string_")]), 3)
        # the scene that was written beside gives the same bits, without files and in another folder
        self.scene = self.output / "scene.toml"
        self.output = self.folder / "again"
        self.assertEqual(self.results("run")[1]["hash"], summary["hash"])
        self.assertEqual(self.results("run", "--until", "0.005 s", "--step", "0.5 ms")[1]["run"]["steps"], 10)

    def test_bent_elements(self):
        """A rod of one element that sags by 0.065 rad, which is described straight: the states that are reached say so;
        four elements and a stiff rod do not."""
        rod = """
            [[string]]
            name = "rod"
            [[string.pipes]]
            count = 1
            elements = 1
            length = "3 m"
            outer_diameter = "20 mm"
            inner_diameter = 0
            young_modulus = "210 GPa"
            poisson_ratio = 0.3
            density = "7850 kg/m^3"
            [run]
            end = "20 ms"
            step = "1 ms"
            static = true
            """
        for text, notes in ((rod, 1), (rod.replace("elements = 1", "elements = 8"), 0),
                            (rod.replace("20 mm", "80 mm"), 0)):
            self.scene = self.write("rod.toml", text)
            for command in ("static", "run"):
                found = [one for one in self.results(command)[1]["notes"]
                         if "mass of a straight one is bent by 0.06" in one]
                self.assertEqual(len(found), notes, (command, found))

    def test_rotation_a_step(self):
        """A note from 0.12 rad a step on, where slow whirl is off by 1 %; none below, nor of pipes that move along
        their axis."""
        out, _ = self.results("run", "--until", "0.2 s", "--step", "9 ms")
        self.assertNotIn("rad a step", out)
        out, summary = self.results("run", "--until", "0.2 s", "--step", "20 ms")
        self.assertRegex(out,
                         r"main turns by 0\.2\d rad a step: rates of its slow whirl and precession are off by up to "
                         r"[345]\S* %; a step of \S+ ms gives 1 %")
        self.assertTrue(any("rad a step" in one for one in summary["notes"]))
        out, _ = self.results("run", "--until", "0.5 s", "--step", "10 s")  # one step, to the end of the run
        self.assertRegex(out, r"main turns by [\d.]+ rad a step: .* off by up to (100|\d\d) %")
        self.scene = self.write("rig.toml", SCENE.replace("[run]", '[compile]\npipe_kind = "axial-torsional"\n[run]',
                                                          1))
        self.assertNotIn("rad a step", self.results("run", "--until", "0.2 s", "--step", "20 ms")[0])

    def test_verified_run(self):
        """The last part again with half the step: the same bits before, values that come closer with the step, and
        refusals."""
        out, plain = self.results("run")
        self.assertRegex(out,
                         r"energy error \S+ of the largest energy .*change in the first tenth of the run \S+, in the "
                         r"last tenth \S+")
        self.assertIn("energy_error_first_tenth", plain)
        changes = []
        for step in ("1 ms", "0.25 ms"):
            out, summary = self.results("run", "--verify", "--step", step)
            found = summary["verification"]
            self.assertAlmostEqual(found["end_s"], 0.02)
            output = found["outputs"]["torque [N m]"]
            changes.append(abs(output["step"] - output["half_step"]) / abs(output["step"]))
            if step == "1 ms":
                self.assertEqual((summary["hash"], summary["run"]["steps"]), (plain["hash"], plain["run"]["steps"]))
                with open(self.output / "run.csv", encoding="utf-8", newline="") as file:
                    largest = max(abs(float(row["torque [N m]"])) for row in csv.DictReader(file))
                # all of the run: it has 20 steps; a row of the table every other one
                self.assertGreaterEqual(output["step"], largest)
            self.assertIn("again with half the step", out)
        self.assertLess(changes[1], changes[0])
        self.scene = self.write("rig.toml", SCENE.replace('step = "1 ms"\n', ""))
        self.assertIn("--verify needs a given step", self.call("run", self.scene, "--verify", status=2))
        self.scene = self.write("rig.toml", SCENE.replace('[hole]\ndiameter = "94 mm"\n', "").replace(
            "[[output]]", '[[output]]\nname = "share"\nquantity = "profile-helical-share"\nplace = {part = "main", '
            'pipe = 1}\n[[output]]', 1))
        self.assertIn("verification: share cannot be compared", self.call("run", self.scene, "--verify"))

    def test_fatigue(self):
        """The worst pipe against stresses of the same run that are counted here: half cycles of a monotone load."""
        curve = '[fatigue]\ncurve_stress = "1 MPa"\nslope = 3\nconcentration = 1.5\n'
        self.scene = self.write("rig.toml", SCENE + curve)
        out, summary = self.results("run")
        found = summary["fatigue"]["main"]
        self.assertIn("fatigue_main.csv", summary["files"])
        self.assertIn("fatigue_main.png", summary["files"])
        with open(self.output / "fatigue_main.csv", encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), 8)
        self.assertEqual(max(float(row["damage [-]"]) for row in rows), found["damage"])
        from drillmbd import scene, station
        loaded = scene.load(str(self.scene))
        with loaded.new_sim() as sim:
            sim.static(**loaded.fields_of("static"))
            places = [(i, fraction) for i in range(8) for fraction in (0.0, 0.5)] + [(7, 1.0)]
            counter = sim.fatigue([station(loaded.names["main"], i, fraction) for i, fraction in places],
                                  curve_stress=1e6, slope=3.0, concentration=1.5)
            for _ in range(20):
                sim.step(1e-3)
                counter.take()
            damages = [max(counter.result(k).damage for k, (pipe, _) in enumerate(places) if pipe == i)
                       for i in range(8)]
        self.assertGreater(max(damages), 0.0)
        self.assertAlmostEqual(max(damages) / found["damage"], 1.0, 2)  # levels of stress are not the same
        self.assertEqual(damages.index(max(damages)), found["pipe"])

    def test_fatigue_refused(self):
        for lines, told in (("", "curve_stress"), ('curve_stress = "1 MPa"', "slope"),
                            ('curve_stress = "1 MPa"\nslope = 0.5', "1 .. 50"),
                            ('curve_stress = "-1 MPa"\nslope = 3', "must be 1 .. 1e+15 (in Pa)"),
                            ('curve_stress = "1 kg"\nslope = 3', "kg"),
                            ('curve_stress = "1 MPa"\nslope = 3\nconcentration = 0.5', "1 .. 100"),
                            ('curve_stress = "1 MPa"\nslope = 3\nclasses = 4', "8 .. 65536"),
                            ('curve_stress = "1 MPa"\nslope = 3\npoints = 1', "2 .. 360")):
            scene = self.write("bad.toml", SCENE + "[fatigue]\n" + lines + "\n")
            self.assertIn(told, self.call("check", scene, status=2))
        no_end = self.write("end.toml",
                            SCENE.replace('end = "20 ms"\n', "") + '[fatigue]\ncurve_stress = "1 MPa"\nslope = 3\n')
        self.assertIn("[run] end", self.call("check", no_end, status=2))

    def test_modes_response_speeds(self):
        out, summary = self.results("modes", "--count", "3")
        self.assertEqual(len(summary["modes"]["frequency_Hz"]), 3)
        self.assertIn("without the slip", summary["notes"][0])
        self.assertIn("mode_00.vtp", summary["files"])
        out, summary = self.results("response")
        self.assertIn("middle [m]: largest", out)
        out, summary = self.results("speeds")
        self.assertTrue(summary["speeds"])
        self.assertIn("avoid ", out)

    def test_buckle(self):
        self.scene = self.write("column.toml", COLUMN)
        out, summary = self.results("buckle")
        self.assertAlmostEqual(summary["buckling"]["factors"][0] / (3.141592653589793 ** 2 * 1e5 / 100.0), 1.0, 3)
        self.assertEqual(summary["buckling"]["end"], "bifurcation")

    def test_buckle_of_shipped_scenes(self):
        """The lines that buckle recommends are enough for each shipped scene: factors, or a reason, and thrusts of the
        soft string."""
        shipped = HERE.parents[1] / "examples" / "scenes"
        if not shipped.exists():
            self.skipTest("no shipped scenes beside the package")
        for path in shipped.iterdir():
            (self.folder / path.name).write_bytes(path.read_bytes())
        for path in sorted(shipped.glob("*.toml")):
            without = re.sub(r"\[buckling\][^[]*", "", path.read_text(encoding="utf-8"))
            lines = self.call("buckle", self.write("without.toml", without), status=2).split("for example:\n")[1]
            if path.stem != "drainage_300m":
                # paths of a minute; that of the reference rig ends before the factor, which is extrapolated then
                lines += "follow = 0\n"
            self.scene = self.write(path.name, without + lines)
            out, summary = self.results("buckle")
            found, thrust = summary["buckling"], next(iter(summary["buckling_thrust"].values()))
            self.assertEqual(bool(found["factors"]), path.stem != "vertical_1000m", out)
            self.assertEqual(len(thrust["depth_m"]), 5)
            for sinusoidal, helical in zip(thrust["sinusoidal_thrust_N"], thrust["helical_thrust_N"]):
                self.assertLess(sinusoidal, helical)
            if path.stem == "vertical_1000m":
                self.assertIn("not assessed, because no drive holds the string's angle", out)

    def test_thrust_of_buckling(self):
        """Level hole without friction: 2 sqrt(EI w / r) of Dawson and Paslay, 2 sqrt(2) sqrt(EI w / r) of the helix."""
        self.scene = self.write("rig.toml", SCENE.replace('diameter = "94 mm"',
                                                          'diameter = "94 mm"\nmu_static = 0\nmu_dynamic = 0', 1)
                                + '[buckling]\nscale = "all"\nfollow = 0\n')
        out, summary = self.results("buckle")
        area, inertia = (3.141592653589793 / 2 ** n * (0.073 ** k - 0.061 ** k) for n, k in ((2, 2), (6, 4)))
        load = 2.0 * (2.1e11 * inertia * 9.81 * 7850 * area / 0.0105) ** 0.5
        found = summary["buckling_thrust"]["main"]
        self.assertAlmostEqual(found["sinusoidal_thrust_N"][-1] / load, 1.0, 6)
        self.assertAlmostEqual(found["helical_thrust_N"][-1] / (2 ** 0.5 * load), 1.0, 6)
        self.scene = self.write("column.toml", COLUMN.replace("start_free = []", "start_free = [\"rx\"]"))
        self.assertRegex(self.call("buckle", self.scene, status=1),
                         "^drillmbd: buckling: not assessed, because no drive holds")
        told = self.call("torque-drag", self.scene, status=1)
        self.assertRegex(told, "^drillmbd: torque and drag: the model has no hole")

    def test_torque_drag(self):
        out, summary = self.results("torque-drag", "--weight-on-bit", "1 kN", "--torque-on-bit", "50 N m", "--depths",
                                    "5")
        rows = next(iter(summary["torque_drag"].values()))
        self.assertEqual(sorted(rows), ["back-ream", "drill", "pick-up", "rotate", "slack-off", "slide"])
        self.assertAlmostEqual(rows["slack-off"]["hook_load_N"] - rows["slide"]["hook_load_N"], 1000.0)
        self.assertIn("arrives", out)

    def test_torque_drag_table_and_broomstick(self):
        """Level hole: closed forms of wall force, stretch, torque and hook loads; all fields by depth; chosen depths
        and frictions."""
        self.scene = self.write("rig.toml", SCENE.replace("eccentricity", 'yield_strength = "400 MPa"\neccentricity',
                                                          1))
        out, summary = self.results("torque-drag", "--depths", "4 m,8 m", "--frictions", "0.5,0.2", "--block-weight",
                                    "3 kN",
                                    "--weight-on-bit", "1 kN")
        area = 3.141592653589793 / 4 * (0.073 ** 2 - 0.061 ** 2)
        weight = 9.81 * 7850 * area
        table = summary["torque_drag_by_depth"]["main"]["pick-up"]
        self.assertEqual(table["depth_m"], [4.0, 8.0])
        for depth, load, wall, stretch in zip(*(table[key] for key in ("depth_m", "hook_load_N", "wall_force_N",
                                                                       "stretch_m"))):
            self.assertAlmostEqual(load, 3e3 + 0.3 * weight * depth, 6)
            self.assertAlmostEqual(wall, weight * depth, 6)
            self.assertAlmostEqual(stretch / (0.15 * weight * depth ** 2 / (2.1e11 * area)), 1.0, 6)
        slide = summary["torque_drag"]["main"]["slide"]
        self.assertAlmostEqual(slide["lowest_force_N"], -1e3 - 0.3 * weight * 8, 6)
        self.assertAlmostEqual(slide["yield_share"] / ((1e3 + 0.3 * weight * 8) / area / 400e6), 1.0, 1)
        self.assertIn("hook loads include 3 kN of block and top drive", out)
        self.assertIn("torque on bit 0 N m: it is not estimated", out)
        with open(self.output / "torque_drag_main.csv", encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), 12)
        self.assertIn("yield share [-]", rows[0])
        broom = summary["broomstick"]["main"]
        self.assertEqual(broom["friction"], [0.2, 0.5])
        for friction, loads, torques in zip(broom["friction"], broom["slack-off_hook_load_N"],
                                            broom["rotate_torque_N_m"]):
            self.assertAlmostEqual(loads[1], 3e3 - friction * weight * 8, 6)
            self.assertAlmostEqual(torques[0], friction * weight * 4 * 0.0365, 6)
        self.assertIn("broomstick_main.png", summary["files"])
        self.assertIn("friction coefficients 0.15, 0.3, 0.45", self.call("torque-drag", self.scene, "--depths", "2"))
        for words, wanted in ((["--depths", "9 m"], "at most 8 m"), (["--depths", "0"], "outside 1"),
                              (["--frictions", "0.2,x"], "no number"),
                              (["--frictions", "-1"], "outside 0 .. 10"),
                              (["--block-weight", "3 m"], "--block-weight")):
            self.assertIn(wanted, self.call("torque-drag", self.scene, *words, status=2))

    def test_broomstick_of_a_hole_with_sections(self):
        """The friction of each section times 0.5, 1 and 1.5; a coefficient of the command line takes the place of
        all."""
        weight = 9.81 * 7850 * 3.141592653589793 / 4 * (0.073 ** 2 - 0.061 ** 2)
        self.scene = self.write("rig.toml",
                                SCENE
                                + '[[hole.section]]\ndepth = "4 m"\nmu_static = 0.5\nmu_dynamic = 0.4\ntransition = "1 '
                                  'mm"\n')
        out, summary = self.results("torque-drag", "--depths", "8 m")
        broom = summary["broomstick"]["main"]
        self.assertEqual((broom["factor"], broom["friction"]), ([0.5, 1.0, 1.5], None))
        for factor, loads in zip(broom["factor"], broom["pick-up_hook_load_N"]):
            self.assertAlmostEqual(loads[0] / (factor * weight * 4 * (0.3 + 0.4)), 1.0, 4)
        self.assertAlmostEqual(broom["pick-up_hook_load_N"][1][0],
                               summary["torque_drag"]["main"]["pick-up"]["hook_load_N"], 9)
        self.assertIn("broomstick: 0.5, 1 and 1.5 times the wall's friction at each depth", out)
        log = self.write("log.csv", f"depth [m],pick-up [N]\n8,{weight * 4 * (0.3 + 0.4):.6f}\n")
        out, summary = self.results("torque-drag", "--depths", "8 m", "--measured", log)
        self.assertIn("first one coefficient for all sections of the hole, then one for each section", out)
        self.assertAlmostEqual(summary["measured"]["main"]["pick-up"]["friction"], 0.35, 4)
        out, summary = self.results("torque-drag", "--depths", "8 m", "--friction", "0.2")
        self.assertEqual(summary["broomstick"]["main"]["friction"], [0.1, 0.2, 0.3])

    def test_torque_drag_loads_of_the_scene(self):
        """Load and torque of the bit are those of the scene; with another load the estimate of the torque follows."""
        scene = SCENE.replace("diameter = 0", 'diameter = "90 mm"\nload = "bit load"') + \
            '[[time_function]]\nname = "bit load"\nsegment = {h0 = "2 kN"}\n'
        self.scene = self.write("rig.toml", scene)
        for words, weight, torque in ((), 2e3, 30.0), (("--weight-on-bit", "4 kN"), 4e3, 60.0):
            out, summary = self.results("torque-drag", *words)
            self.assertAlmostEqual(summary["operations"]["drill"]["weight_on_bit_N"], weight)
            self.assertAlmostEqual(summary["operations"]["drill"]["torque_on_bit_N_m"], torque)
            self.assertIn("estimated: 0.5 x weight on bit x bit diameter / 3", out)

    def test_measured_hook_loads(self):
        """Loads made with a known friction are found again; scatter of two measurements at one depth gives Student's
        interval."""
        weight = 9.81 * 7850 * 3.141592653589793 / 4 * (0.073 ** 2 - 0.061 ** 2)
        rows = [(depth, 2e3 + 0.25 * weight * depth, 2e3 - 0.35 * weight * depth + error, 2000.0,
                 0.2 * weight * depth * 0.0365)
                for depth, error in ((4.0, 0.0), (8.0, 10.0), (8.0, -10.0))]
        path = self.write("log.csv", "MD [ft];pick_up [kN];slack_off [lbf];Rotating weight [kN];Torque [N m]\n"
                          + "".join(f"{d / 0.3048:.9f};{p / 1e3:.9f};{s / 4.4482216152605:.9f};{r / 1e3:.3f};{t:.9f}\n"
                                    for d, p, s, r, t in rows))
        out, summary = self.results("torque-drag", "--measured", path, "--block-weight", "2 kN")
        found = summary["measured"]["main"]
        self.assertAlmostEqual(found["pick-up"]["friction"], 0.25, 6)
        self.assertAlmostEqual(found["torque"]["friction"], 0.2, 6)
        self.assertIsNone(found["rotate"]["friction"])
        slopes = weight ** 2 * (16 + 64 + 64)
        self.assertAlmostEqual(found["slack-off"]["friction"], 0.35, 6)
        self.assertAlmostEqual(found["slack-off"]["half_width_95"] / (4.302653 * (200 / 2 / slopes) ** 0.5), 1.0, 3)
        self.assertIn("hook load, rotate: friction not assessed, because", out)
        self.assertIn("measured_main.csv", summary["files"])
        for text, wanted in (("depth [m],hook load [kN]\n5,3\n", "line 2: hook load of no operation"),
                             ("depth [m],pick up\n5,3\n", "has no unit"),
                             ("depth [m],pick up [kN]\n5,-999.25\n", "missing value"),
                             ("depth [m],pick up [kN]\n9,3\n", "at most 8 m"),
                             ("depth [m],inc [deg],azi [deg]\n5,3,3\n", "no column of loads"),
                             ("a,b\n1,2\n", "no head names depth; give the heads")):
            self.assertIn(wanted, self.call("torque-drag", self.scene, "--measured", self.write("bad.csv", text),
                                            status=2))
        self.call("torque-drag", self.scene, "--measured", self.folder / "none.csv", status=3)
        log = "depth [m],hook load [kN],operation\n4,0.3,pick-up\n8,99,slack off\n"
        out = self.call("torque-drag", self.scene, "--measured", self.write("log.csv", log))
        self.assertIn("confidence not assessed, because one measurement has no scatter", out)
        self.assertIn("hook load, slack-off: friction not assessed, because no coefficient", out)

    def test_rig_limits(self):
        """Level hole: the torque of rotation and the friction of sliding grow with depth, so the reach has a closed
        form."""
        weight = 9.81 * 7850 * 3.141592653589793 / 4 * (0.073 ** 2 - 0.061 ** 2)
        turning = 0.3 * weight * 0.0365  # N m per metre
        self.scene = self.write("rig.toml", SCENE + f'[limits]\ntorque = "{5.5 * turning:.9f} N m"\npull = "1 kN"\n')
        out, summary = self.results("torque-drag", "--depths", "8")
        found = summary["rig_limits"]["main"]
        self.assertAlmostEqual(found["reach_m"], 5.5, 6)
        self.assertEqual(found["first_limit"], "torque")
        self.assertAlmostEqual(found["share"]["torque"], 8 / 5.5, 6)
        self.assertAlmostEqual(found["share"]["pull"], 8 * 0.3 * weight / 1e3, 6)
        self.assertIn("this rig reaches 5.5 m: torque (rotate)", out)
        self.assertIn("thrust: not assessed, because [limits] has no push", out)
        self.assertIn("rig_limits_main.csv", summary["files"])
        self.assertRegex(self.call("torque-drag", self.scene, "--weight-on-bit", "800 kN"),
                         r"\d{3,4} % of the helical buckling load")
        self.assertIn("exceeded at 6 m, the first depth", self.call("torque-drag", self.scene, "--depths", "6 m"))
        self.scene = self.write("rig.toml", SCENE + '[limits]\npush = "1 kN"\n')
        self.assertRegex(self.call("torque-drag", self.scene),
                         r"not reached down to 8 m: thrust 233 N, 23 % of the limit \(slack-off at 8 m\)")
        self.assertIn("this rig reaches 7.999 m: thrust (slide)",
                      self.call("torque-drag", self.scene, "--weight-on-bit",
                                f"{1e3 - 0.3 * weight * 7.999:.6f} N", "--depths", "4"))
        self.scene = self.write("rig.toml", SCENE)
        self.assertIn("limits of the rig: not assessed, because the scene has no [limits]",
                      self.call("torque-drag", self.scene))

    def test_pull_that_lifts_the_string(self):
        """In a hole that rises in a bend, weight hangs on the pull and the pull lifts the string off the wall: more
        arrives at the bit than the rig pulls. Other holes and loads alike: with that force at the bit the rig has the
        given load."""
        from drillmbd import enums, scene, stuck
        from drillmbd.analysis import usual_operation
        holes = {"rises": (90.0, 130.0), "rises more": (130.0, 170.0), "falls": (90.0, 50.0), "level": (90.0, 90.0)}
        for name, (first, last) in holes.items():
            made = scene.loads(f"""[hole]
survey = [["0 m", "{first} deg", 0], ["140 m", "{last} deg", 0]]
mu_static = 0.35
mu_dynamic = 0.35
[[string]]
[[string.pipes]]
count = 140
outer_diameter = "73 mm"
inner_diameter = "55 mm"
""")
            string = made.names[next(iter(made.pipes))]
            with made.new_sim() as sim:
                for load in (1e3, 30e3, 60e3):
                    force, _ = stuck.pull_at_bit(sim, string, load)
                    pull = usual_operation(enums.OPERATION_PICK_UP, weight_on_bit=-force)
                    self.assertAlmostEqual(sim.torque_drag([pull], string=string).rows[0][0].hook_load / load, 1.0, 9)
                    force, _ = stuck.push_at_bit(sim, string, load)
                    push = usual_operation(enums.OPERATION_SLACK_OFF, weight_on_bit=force)
                    self.assertAlmostEqual(-sim.torque_drag([push], string=string).rows[0][0].hook_load / load, 1.0, 8)
                if name == "rises":
                    weight = 9.81 * 7850.0 * math.pi / 4.0 * (0.073 ** 2 - 0.055 ** 2)
                    known, steps, radius = 30e3, 20000, 140.0 / math.radians(40.0)
                    for i in range(steps):  # dN/ds = w sin(dip) - mu |w cos(dip) - N/R|
                        dip, before = math.radians(40.0) * (i + 0.5) / steps, known
                        for _ in range(2):
                            middle = 0.5 * (before + known)
                            known = before + 140.0 / steps * (weight * math.sin(dip) - 0.35 * abs(
                                weight * math.cos(dip) - middle / radius))
                    self.assertGreater(known, 34e3)
                    self.assertAlmostEqual(stuck.pull_at_bit(sim, string, 30e3)[0] / known, 1.0, 6)

    def test_stuck(self):
        out, summary = self.results("stuck", "--pull", "20 kN", "--push", "10 kN", "--torque", "500 N m", "--friction",
                                    "0")
        self.assertAlmostEqual(summary["stuck"]["pull"]["at_bit_N"], 20e3, 3)
        self.assertAlmostEqual(summary["stuck"]["push"]["at_bit_N"], 10e3, 3)
        self.assertAlmostEqual(summary["stuck"]["torque"]["at_bit_N_m"], 500.0)
        out, summary = self.results("stuck", "--pull", "20 kN", "--push", "10 kN", "--torque", "500 N m", "--overpull",
                                    "10 kN",
                                    "--stretch", "0.1 mm")
        area = 3.141592653589793 / 4 * (0.073 ** 2 - 0.061 ** 2)
        rubbed = 0.3 * 8 * 9.81 * 7850 * area
        self.assertAlmostEqual(summary["stuck"]["pull"]["at_bit_N"], 20e3 - rubbed, 3)
        self.assertAlmostEqual(summary["stuck"]["push"]["at_bit_N"], 10e3 - rubbed, 3)
        self.assertIn("free down to", out)
        self.assertNotIn("free as far as", out)
        whole = 1e3 * 10e3 * 8 / (2.1e11 * area)  # [mm]
        for stretch, noted in ((1.1 * whole, False), (1.3 * whole, True), (1000.0, True)):
            found = self.call("stuck", self.scene, "--overpull", "10 kN", "--stretch", f"{stretch} mm")
            self.assertIn(f"free as far as the string goes: it would lengthen by {whole:.4g} mm, which is less", found)
            self.assertEqual("check --stretch and --overpull" in found, noted, found)
        self.assertAlmostEqual(summary["stuck"]["free_length_m"], 0.1e-3 * 2.1e11 * area / 10e3)
        self.assertIn("nothing arrives", self.call("stuck", self.scene, "--push", "1 N", "--friction", "0.5"))
        for words in (["--pull", "3 m"], ["--friction", "-1"], ["--friction", "nan"], ["--overpull", "1 kN"],
                      ["--overpull", "-1 kN", "--stretch", "1 mm"]):
            self.call("stuck", self.scene, *words, status=2)
        self.scene = self.write("two.toml", SCENE + '[[string]]\nname = "other"\n[[string.pipes]]\n')
        self.assertIn("stuck is about the string main; other: not assessed", self.call("stuck", self.scene))

    def test_sweep(self):
        self.call("sweep", self.scene, "torque-drag", "--vary", "hole.mu_dynamic=0.1:0.3:3", "--vary",
                  "hole.diameter=94 mm,5 mm",
                  "-o", self.output, "--", "--depths", "2", status=1)
        # 0.35, not more
        self.call("sweep", self.scene, "check", "--vary", "hole.mu_dynamic=0.1:0.35:6", "-o", self.folder / "grid")
        self.assertIn("\n6,0.35,ok", (self.folder / "grid" / "sweep.csv").read_text())
        self.assertIn("--output", self.call("sweep", self.scene, "report", "--vary", "hole.mu_dynamic=0.1,0.2",
                                            status=2))
        with open(self.output / "sweep.csv", encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([row["status"] for row in rows], ["ok", "failed"] * 3)
        self.assertIn("diameter", rows[1]["message"])
        column = next(name for name in rows[0] if name.endswith("pick-up.hook_load_N"))
        pulls = [float(row[column]) for row in rows[::2]]
        self.assertAlmostEqual(pulls[2] - pulls[1], pulls[1] - pulls[0])
        self.assertGreater(pulls[1], pulls[0])
        self.assertTrue((self.output / "00001" / "summary.json").exists())
        for wrong in ("diameter", "hole.diameter=", "[0]=1", "hole.diameter=1 mm:2 m:3", "hole.diameter=1:2:1"):
            self.assertIn("--vary", self.call("sweep", self.scene, "check", "--vary", wrong, status=2))
        self.assertIn("no table nothing", self.call("sweep", self.scene, "check", "--vary", "nothing[3].there=1,2",
                                                    status=2))

    def test_without_a_folder_nothing_is_written(self):
        self.call("static", self.scene)
        self.assertEqual(self.call("run", self.scene, "--quiet"), "")
        self.assertEqual(os.listdir(self.folder), ["rig.toml"])

    def test_save_and_schema(self):
        self.call("save", self.scene, self.folder / "copy.toml")
        self.assertEqual(self.call("save", self.folder / "copy.toml", "-"), (self.folder / "copy.toml").read_text())
        self.assertEqual(json.loads(self.call("schema"))["type"], "object")

    @unittest.skipUnless(importlib.util.find_spec("argcomplete"), "not there: argcomplete")
    def test_completion(self):
        """As bash asks: the line typed so far in COMP_LINE, words on file descriptor 8."""
        line = "drillmbd torque-drag --de"
        code = ("import os; os.dup2(os.open('words', os.O_CREAT | os.O_WRONLY), 8); from drillmbd.command import main; "
                "main()")
        subprocess.run([sys.executable, "-c", code], cwd=self.folder, check=True, env={
            **os.environ, "PYTHONPATH": str(pathlib.Path(__file__).parent), "_ARGCOMPLETE": "1", "COMP_LINE": line,
            "COMP_POINT": str(len(line)), "_ARGCOMPLETE_COMP_WORDBREAKS": " ", "COMP_TYPE": "9"})
        self.assertIn("--depths", pathlib.Path(self.folder, "words").read_text())

    def test_help(self):
        self.assertIn("examples:", self.call("--help"))
        for command in ("check", "static", "run", "modes", "response", "speeds", "buckle", "torque-drag", "report",
                        "save", "schema"):
            self.assertIn("usage: drillmbd", self.call(command, "--help"))
        self.assertRegex(self.call("--version"), r"drillmbd \d+\.\d+\.\d+")

    def test_refusals(self):
        bad = self.write("bad.toml", SCENE.replace("diameter = \"94 mm\"", "diametre = \"94 mm\"\nmu_static = -1"))
        told = self.call("check", bad, status=2)
        self.assertIn("bad.toml:3: hole.diametre: unknown key; did you mean diameter?", told)
        self.assertIn("bad.toml:4: hole.mu_static = -1: must", told)
        self.call(status=2)
        self.call("chek", self.scene, status=2)
        self.call("run", self.scene, "--until", "5 kg", status=2)
        self.call("run", self.scene, "--until", "-5 s", status=2)
        self.assertIn("[buckling]", self.call("buckle", self.scene, status=2))
        self.assertIn("none.toml", self.call("check", self.folder / "none.toml", status=3))
        self.assertIn("modes", self.call("modes", self.scene, "--count", "100000", status=1))
        no_end = self.write("end.toml", SCENE.replace('end = "20 ms"\n', ""))
        self.assertIn("--until", self.call("run", no_end, status=2))

    def test_unit_needs_a_file(self):
        self.assertIn("is a folder", self.call("fmu", self.scene, "-o", self.folder, status=2))

    def test_folder_that_cannot_be_written(self):
        for target in ("/dev/null/out", self.scene, "/proc/out"):
            self.call("static", self.scene, "--output", target, status=3)

    def test_report(self):
        try:
            import plotly.offline  # noqa: F401
        except ImportError:
            self.skipTest("not there: plotly")
        self.scene = self.write("rig.toml", drilled(SCENE) + '[limits]\npush = "1 N"\ntorque = "5 kN m"\n'
                                '[fatigue]\ncurve_stress = "100 MPa"\nslope = 4\n')
        out, summary = self.results("report")
        self.assertRegex(out, r"Thrust at the rig: .*, OVER \(\d+ % of 1 N")
        self.assertRegex(out, r"Torque at the rig: .*, OK \(")
        self.assertIn("0.02", str(summary["run"]["time_s"]))
        page = (self.output / "report.html").read_text(encoding="utf-8")
        self.assertLess(len(page), 10_000_000)
        self.assertNotRegex(page.split('id="plotly"')[0], r"https?://|src=|<link")
        for part in ("Critical speeds", "Fatigue along the string", "Thrust at the rig", "Assumptions", "model check",
                     summary["hash"]):
            self.assertIn(part, page)
        self.assertIn("--output", self.call("report", self.scene, status=2))
        self.browse(self.output / "report.html", page.count('class="figure"'))

    def test_verdicts(self):
        """Each verdict has an input for which it is another one; an analysis that fails leaves the others."""
        try:
            import plotly.offline  # noqa: F401
        except ImportError:
            self.skipTest("not there: plotly")
        import drillmbd.report as report
        from drillmbd import scene
        from drillmbd.results import CommandOutput

        def verdicts(text, failing=""):
            study = report.Study(scene.loads(text), CommandOutput(None, "x.toml", scene.loads(text), "report", True))
            if failing:
                setattr(study, failing, lambda: (_ for _ in ()).throw(ArithmeticError("no solution")))
            study.compute()
            return {tile.title: (tile.verdict, tile.text) for tile in study.tiles}

        without_load = SCENE.replace('end = "20 ms"', 'end = "2 ms"')
        quick = drilled(without_load)
        known = verdicts(quick + '[limits]\ntorque = "5 kN m"\npush = "100 kN"\n')
        self.assertEqual((known["Torque at the rig"][0], known["Thrust at the rig"][0]), ("OK", "OK"))
        self.assertEqual(known["Pull at the rig"][0], "NO LIMIT GIVEN")
        self.assertEqual(known["Fatigue"][0], "NOT ASSESSED")
        unknown = verdicts(without_load
                           + '[limits]\ntorque = "5 kN m"\npush = "100 kN"\npull = "100 kN"\nyield_stress = "400 '
                             'MPa"\n')
        for title in ("Torque at the rig", "Thrust at the rig", "Von Mises stress"):
            self.assertEqual(unknown[title][0], "NOT ASSESSED", title)
            self.assertIn("without the load on the bit", unknown[title][1])
        self.assertEqual((unknown["Pull at the rig"][0], unknown["Buckling in the hole"][0]), ("OK", "NOT ASSESSED"))
        over = verdicts(quick + '[limits]\ntorque = "1 N m"\npush = "1 N"\n')
        self.assertEqual((over["Torque at the rig"][0], over["Thrust at the rig"][0]), ("OVER", "OVER"))
        for failing in ("_torque_drag", "_operations", "_run"):
            lost = verdicts(quick + '[limits]\ntorque = "5 kN m"\n', failing)
            self.assertEqual(lost["Torque at the rig"][0], "NOT ASSESSED", failing)
            self.assertIn("no solution", lost["Torque at the rig"][1])
        still = "\n".join(one for one in quick.split("\n") if "eccentricity" not in one or "kind" in one)
        self.assertNotEqual(still, quick)
        self.assertEqual(verdicts(still)["Critical speeds"][0], "NOT ASSESSED")
        lost = verdicts(quick, "_speeds")["Critical speeds"]
        self.assertEqual(lost, ("NOT COMPUTED", "no solution"))

    def test_nothing_excites(self):
        self.scene = self.write("still.toml", "\n".join(one for one in SCENE.split("\n") if "eccentricity" not in one
                                                        or "kind" in one))
        out, summary = self.results("speeds")
        self.assertIn("not assessed, because all excitations are zero", out)
        self.assertFalse(summary["speeds_assessed"])
        out, summary = self.results("response")
        self.assertIn("not assessed", out)
        self.assertNotIn("largest 0", out)

    def browse(self, path, figures):
        """The page in a browser: all figures drawn, nothing on its console."""
        browser = shutil.which("chromium")
        if browser is None:
            self.skipTest("not there: chromium; the page was not looked at")
        done = subprocess.run([browser, "--headless=new", "--no-sandbox", "--disable-dev-shm-usage",
                               "--enable-logging=stderr", "--enable-unsafe-swiftshader",
                               "--virtual-time-budget=30000", "--dump-dom", f"file://{path}"],
                              capture_output=True, text=True, timeout=300,
                              env={**os.environ, "HOME": str(self.folder)})
        self.assertIn(f'data-drawn="{figures}"', done.stdout)
        self.assertIn('<pre id="problems" data-count="0"></pre>', done.stdout)
        self.assertEqual(done.stdout.count("figure js-plotly-plot"), figures)
        self.assertNotRegex(done.stderr, r"CONSOLE.*(Error|error)")

    def test_as_a_program(self):
        done = subprocess.run([*COMMAND, "static", self.scene], capture_output=True, text=True, env=ENVIRONMENT)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        done = subprocess.run([*COMMAND, "check", "none.toml"], capture_output=True, text=True, env=ENVIRONMENT)
        self.assertEqual((done.returncode, done.stderr), (3, "drillmbd: No such file or directory: none.toml\n"))

    def test_bounces_are_noted_once(self):
        from drillmbd.results import note_bounces
        for bounces in (0, 3):
            notes = []
            out = types.SimpleNamespace(summary={"run": {}}, note_text=notes.append)
            note_bounces(types.SimpleNamespace(statistics=lambda: types.SimpleNamespace(bounces=bounces)), out)
            self.assertEqual(out.summary["run"]["bounces"], bounces)
            self.assertEqual(len(notes), 1 if bounces else 0)

    def test_ctrl_c_leaves_what_is_done(self):
        process = subprocess.Popen([*COMMAND, "run", self.scene, "--until", "2000 s", "--output", self.output],
                                   stderr=subprocess.PIPE, stdout=subprocess.PIPE, env=ENVIRONMENT,
                                   preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler))
        limit = time.monotonic() + 120.0
        while not (self.output / "string_0001.vtp").exists() and time.monotonic() < limit:
            time.sleep(0.05)
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=120)
        self.assertEqual(process.returncode, 130)
        summary = json.loads((self.output / "summary.json").read_text(encoding="utf-8"))
        # a note of bounces may follow
        self.assertTrue(any("stopped by Ctrl-C" in note for note in summary["notes"]), summary["notes"])
        self.assertIn("run.csv", summary["files"])
        self.assertGreater(summary["run"]["elapsed_s"], 0.0)
        self.assertGreater(summary["run"]["real_time_factor"], 0.0)


if __name__ == "__main__":
    unittest.main()
