"""Tests of scene files: units, shipped scenes against the C program and themselves, file to model to file, and bad
files: each fault reported with its line, key and bound, and nothing but SceneError whatever the bytes."""
import json
import math
import os
import pathlib
import random
import shutil
import subprocess
import tempfile
import unittest

import drillmbd as mbd
from shared_tests import TURNING, WORN

try:
    from drillmbd import scene
    from drillmbd.model import remake
    from drillmbd.scene import fields, lines, schema, source, units
except ImportError as missing:
    raise unittest.SkipTest(f"not there: {missing.name}") from missing

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
SCENES = sorted((ROOT / "examples" / "scenes").glob("*.toml"))
BUILD = pathlib.Path(os.environ.get("DRILLMBD_BUILD", ROOT / "build" / "release")).resolve()

RODS = """[[string]]
name = "main"
[[string.pipes]]
count = 3
"""
SMALL = """title = "small"
[hole]
diameter = "94 mm"
[[time_function]]
name = "feed"
segment = {kind = "step", x1 = "1 s", h1 = "10 mm/s"}
""" + RODS + """[[drive]]
name = "head"
time_function = "feed"
[run]
end = "10 ms"
step = "1 ms"
"""

GEAR = TURNING.replace("100 rpm", "200 rpm") + WORN + RODS + """[[drive]]
name = "head"
component = "rx"
time_function = "turning"
excitation = "worn"
"""
EVERYTHING = """title = "every kind of part"
[environment]
gravity = [0, 0, "-9.8 m/s^2"]
fluid_density = "1 g/cm^3"
[hole]
survey = [["0 m", "90 deg", 0], ["30 m", "92 deg", "2 deg"]]
exponent = 1.5
stiffness = "2e9 N/m^2.5"
friction_law = "bristle"
[[hole.section]]
depth = "10 m"
name = "open"
diameter = "0.11 m"
stiffness = "1e9 N/m^2.5"
[[hole.section]]
shape = "line"
depth = "20 m"
strength = "40 MPa"
[[hole.section]]
depth = "25 m"
mu_dynamic = 0.2
[[time_function]]
name = "shake"
segment = [{kind = "harmonic", h1 = "3 N", omega = "300 rpm", phase = "90 deg"}, {table = [[0, 0], ["1 s", "5 N"]]}, {kind = "periodic", table = [["2 ms", 0], ["3 ms", "5 N"], ["8 ms", 0]]}]
[[time_function]]
name = "half"
segment = {h0 = 0.5}
[[time_function]]
name = "unused"
unit = "m/s"
segment = {h0 = "1 m/s"}
[[string]]
name = "main"
start_free = ["x", "rx"]
[[string.pipes]]
count = 2
kind = "rigid"
[[string.pipes]]
count = 4
joint_length = "10 cm"
curvature = [0, "1 deg/m", 0]
[[string]]
name = "other"
follows_hole = false
position = ["1 m", 0, "1 mm"]
[[string.pipes]]
[[body]]
name = "head"
attach = "start"
string = "main"
mass = "30 kg"
[[body]]
name = "swing"
mass = "2 kg"
position = ["5 m", 0, "2 m"]
inertia = ["10 kg m2", "10 kg m^2", "10 kg m^2", 0, 0, 0]
[[body]]
name = "wheel"
mass = "2 kg"
position = ["5 m", "1 m", "2 m"]
[[bit]]
name = "bit"
string = "main"
rock_law = "rate"
load = "shake"
[[joint]]
name = "hinge"
kind = "revolute"
place_b = "swing"
origin_a = ["5 m", 0, "3 m"]
axis_a = [0, 1, 0]
match = true
stiffness = [0, 0, 0, "2 N m/deg", 0, 0]
[[joint]]
name = "axle"
kind = "revolute"
place_b = "wheel"
origin_a = ["5 m", "1 m", "2 m"]
axis_a = [0, 1, 0]
match = true
[[coupling]]
joint = ["hinge", "axle"]
ratio = -2
[[drive]]
name = "torque"
kind = "load"
part = "hinge"
component = "rx"
time_function = "3 N m"
[[drive]]
name = "feed"
kind = "control"
component = "x"
time_function = "10 mm/s"
gain = "1 kN s/m"
limit_high = "5 kN"
[[load]]
name = "weight"
place = {part = "main", pipe = 3, fraction = 1.0}
force = [0, 0, "-10 N"]
time_function = "half"
[[input]]
name = "feed speed"
target = "set-point"
part = "feed"
low = "-1 mm/s"
high = "20 mm/s"
rate_limit = "0.1 m/s2"
slope_limit = "2 m/s^3"
outside = "clamped"
[[event]]
name = "fast"
quantity = "bit-speed"
direction = "falling"
level = "30 rpm"
hold = "500 ms"
[[event]]
name = "limit"
quantity = "drive-force"
place = "feed"
level = "3 kN"
[[input]]
name = "mud"
target = "fluid-density"
initial = "1.2 g/cm^3"
high = "2 g/cm^3"
[[input]]
name = "grip"
target = "limit-high"
part = "feed"
initial = "4 kN"
[[spring]]
name = "rope"
acts = "tension"
place_b = {part = "main", pipe = 4, fraction = 0.4}
offset_a = [0, 0, "2 m"]
offset_b = [0, "1 cm", 0]
free_length = "1 m"
stiffness = "2 kN/m"
table_kind = "cubic"
table = [["0 m", "0 N"], ["10 cm", "50 N"], ["20 cm", "200 N"]]
[[spring]]
place_a = "swing"
place_b = "wheel"
stiffness = "1 N/m"
damping = "3 N s/m"
[[stuck]]
name = "jam"
holds = ["axial", "lateral"]
place = {part = "main", pipe = 3, fraction = 0.3}
stuck = false
stiffness = ["2e8 N/m", "1e6 N m/rad", "1e8 N/m"]
overpull = "50 kN"
[[event]]
name = "quick"
quantity = "input-present"
place = "feed speed"
level = "15 mm/s"
[[output]]
name = "asked for"
quantity = "input-present"
place = "feed speed"
[[output]]
name = "pull of the rope"
quantity = "spring-force"
place = "rope"
[[input]]
name = "jammed"
target = "stuck"
part = "jam"
[[stabiliser]]
name = "stabiliser"
string = "main"
pipe = 3
fraction = 0.35
outer_diameter = "90 mm"
length = "30 cm"
mass = "7 kg"
[[stabiliser]]
string = "main"
pipe = 1
[compile]
features = ["gravity", "contact", "friction", "damping"]
[sim]
spectral_radius = 0.9
[run]
end = "20 ms"
step = "1 ms"
[results]
interval = "2 ms"
[limits]
torque = "2 kN m"
yield_stress = "400 MPa"
[[output]]
name = "swing"
quantity = "position-z"
place = "swing"
[static]
slip_axial = "1 mm/s"
[response]
frequency_low = "1 Hz"
frequency_high = "10 Hz"
[[response.excitation]]
kind = "drive"
place = "torque"
amplitude = "2 N m"
[[response.excitation]]
kind = "setting"
place = "feed speed"
amplitude = "3 mm/s"
[[response.output]]
place = "swing"
quantity = "vibration-z"
[speeds]
speed_high = "100 rpm"
[[speeds.order]]
order = 2
kind = "unbalance"
place = "swing"
amplitude = "3 g m"
[[speeds.output]]
quantity = "vibration-x"
place = "swing"
limit = "1 mm"
[fatigue]
curve_stress = "95 MPa"
slope = 4
concentration = 2
[buckling]
part = "feed"
scale = "part"
factor_max = "100 kN"
"""  # noqa: E501

# The same rig with [[sub]]s, and with bodies, strings and joints where these place them.
SUBS = """
[[string]]
name = "upper"
follows_hole = false
[[string.pipes]]
count = 2
length = "1.5 m"
[[sub]]
string = "upper"
length = "0.3 m"
body = {name = "collar", mass = "20 kg"}
after = {name = "knuckle", kind = "spherical", stiffness = [0, 0, 0, "1 kN m/rad", "1 kN m/rad", "1 kN m/rad"]}
[sub.section]
name = "middle"
[[sub.section.pipes]]
length = "2 m"
[[sub]]
string = "middle"
length = "0.2 m"
section = {pipes = {length = "1 m"}}
[[body]]
mass = "3 kg"
[[joint]]
kind = "spherical"
place_b = "body-2"
match = true
origin_a = [0, "1 m", 0]
[[load]]
place = "collar"
force = [0, 0, "-500 N"]
[[output]]
name = "end"
quantity = "position-z"
place = {part = "string-2", fraction = 1.0}
[run]
end = "20 ms"
step = "1 ms"
"""

BY_HAND = """
[[string]]
name = "upper"
follows_hole = false
[[string.pipes]]
count = 2
length = "1.5 m"
[[string]]
name = "middle"
follows_hole = false
position = ["3.3 m", 0, 0]
start_free = ["x", "y", "z", "rx", "ry", "rz"]
[[string.pipes]]
length = "2 m"
[[string]]
follows_hole = false
position = ["5.5 m", 0, 0]
start_free = ["x", "y", "z", "rx", "ry", "rz"]
[[string.pipes]]
length = "1 m"
[[body]]
name = "collar"
mass = "20 kg"
position = ["3 m", 0, 0]
[[body]]
position = ["5.3 m", 0, 0]
[[body]]
mass = "3 kg"
[[joint]]
place_a = {part = "upper", pipe = 1, fraction = 1}
place_b = "collar"
match = true
[[joint]]
name = "knuckle"
kind = "spherical"
stiffness = [0, 0, 0, "1 kN m/rad", "1 kN m/rad", "1 kN m/rad"]
place_a = "collar"
place_b = "middle"
origin_a = ["0.3 m", 0, 0]
match = true
[[joint]]
place_a = {part = "middle", fraction = 1}
place_b = "body-1"
match = true
[[joint]]
place_a = "body-1"
place_b = "string-2"
origin_a = ["0.2 m", 0, 0]
match = true
""" + SUBS[SUBS.index("[[joint]]"):]


def problems(text, folder="."):
    try:
        scene.loads(text, "x.toml", folder)
    except scene.SceneError as error:
        return error.problems
    return []


def after_run(loaded, steps=20):
    with loaded.new_sim() as sim:
        for _ in range(steps):
            sim.step(1e-3)
        return sim.hash()


class UnitsTest(unittest.TestCase):
    def test_quantities(self):
        for text, wanted, value in (
                ("63.5 mm", "m", 0.0635), ("120 rpm", "rad/s", 120 * math.pi / 30), ("90 deg", "rad", math.pi / 2),
                ("-9.81 m/s^2", "m/s2", -9.81), ("210 GPa", "Pa", 2.1e11), ("2 %", "-", 0.02), ("5", "-", 5.0),
                ("12 rev/min", "rad/s", 12 * math.pi / 30), ("10 N m s/deg", "N m s", 1800 / math.pi),
                ("4.5 in", "m", 0.1143), ("1e7 N/m^2", "N/m^2", 1e7), ("3 kg m2", "kg m2", 3.0), (0, "m", 0.0),
                ("5 kN", "N, N m", 5e3), ("5 kN m", "N, N m", 5e3), ("1_000 m", "m", 1000.0), ("8 1/s", "Hz", 8.0)):
            self.assertAlmostEqual(units.parse(text, wanted) / (value or 1.0), 1.0 if value else 0.0, 14, text)
        self.assertEqual(units.parse("63.5 mm", "m"), 0.0635)  # the double itself
        self.assertEqual(units.parse("0.1 ms", "s"), 1e-4)

    def test_other_kinds_are_refused(self):
        for text, wanted in (("120 kg", "m/s"), ("5 Hz", "rad/s"), ("60 rpm", "Hz"), (5, "m"), ("5", "m"), ("1", "rad"),
                             ("mm", "m"), ("5 furlongs per", "m"), (True, "m"), (None, "m"), ([1], "m"),
                             ("1e999 m", "m"),
                             ("nan m", "m"), ("5 m", "N, N m"), ("5 m", "-"), ("1 __import__('os')", "m"),
                             ("5 ()", "m")):
            with self.assertRaises(units.UnitError, msg=text):
                units.parse(text, wanted)

    def test_all_units_of_the_headers_are_known(self):
        for struct in fields.DEFINITIONS.values():
            for field in fields.fields_of(struct).values():
                for unit in field.unit.split(","):
                    if field.kind == "quantity" and unit and "unit of" not in unit and "n+1" not in unit:
                        units.factor_and_kind(unit.strip())


class SubTest(unittest.TestCase):
    def test_as_typed_by_hand(self):
        subs, by_hand = scene.loads(SUBS), scene.loads(BY_HAND)
        self.assertEqual(subs.names["middle"].index, by_hand.names["middle"].index)
        for name in ("collar", "knuckle", "body-1", "body-2", "joint-4", "string-2"):
            self.assertEqual(subs.names[name].index, by_hand.names[name].index, name)
        self.assertEqual(subs.pipes, {"upper": 2, "middle": 1, "string-2": 1})
        ends = []
        for one in (subs, by_hand):
            with one.new_sim() as sim:
                for _ in range(20):
                    sim.step(1e-3)
                name, place, quantity = one.outputs[0]
                ends.append(sim.output(quantity, place))
        self.assertNotEqual(ends[0], 0.0)
        self.assertAlmostEqual(ends[0] / ends[1], 1.0, 11)

    def test_file_to_model_to_file(self):
        first = scene.loads(SUBS)
        second = scene.loads(scene.saves(first))
        self.assertTrue(first.same_as(second))
        self.assertEqual(scene.saves(first), scene.saves(second))
        self.assertEqual(after_run(first), after_run(second))

    def test_faults(self):
        for change, says in (
                (('mass = "20 kg"', 'mass = "-1 kg"'), "mass"), (('mass = "20 kg"', 'weight = "20 kg"'), "weight"),
                (('length = "0.3 m"', 'length = "-3 m"'), "length = -3, must be"),
                (('string = "middle"', 'string = "upper"'), "take string 1"),
                (('string = "middle"', 'string = "string-2"'), "made after this"),
                (('name = "knuckle"', 'name = "upper"'), "every name once"),
                (('name = "collar"', 'position = [0, 0, 0]'), "position"),
                (('section = {pipes = {length = "1 m"}}', ''), "[[sub.section.pipes]]"),
                (('body = {name = "collar", mass = "20 kg"}', 'body = 3'), "table"), (('[[sub]]', '[sub]'), "TOML")):
            self.assertIn(says, " ".join(map(str, problems(SUBS.replace(*change)))), change)


COLLARS = """
[hole]
diameter = "311 mm"
[[string]]
[[string.pipes]]
count = 3
length = "9.4 m"
outer_diameter = "127 mm"
inner_diameter = "108 mm"
[[string.pipes]]
length = "37.72 m"
outer_diameter = "209.55 mm"
inner_diameter = "73 mm"
"""


class DividedTest(unittest.TestCase):
    def test_long_pipes_are_divided(self):
        loaded = scene.loads(COLLARS)
        self.assertEqual([(one.first, one.count, one.elements) for one in loaded.divided], [(0, 3, 2), (3, 1, 8)])
        self.assertEqual(loaded.model.info().elements, 3 * 2 + 8)
        self.assertLess(max(loaded.model.mesh_errors(loaded.names["string-0"], 4)), 0.01)
        self.assertIn("pipe 3: divided into 8 elements each", str(loaded.divided[1]))
        with loaded.new_sim() as sim:
            self.assertNotIn("set elements", sim.check_text())
        saved = scene.loads(scene.saves(loaded))
        self.assertTrue(saved.same_as(loaded))
        self.assertEqual(saved.divided, [])  # the saved file has the number

    def test_usual_damping(self):
        """Pipes of a file are damped unless it says otherwise; saved files keep either."""
        def damping(loaded):
            return [arguments[1].get("damping_time", 0.0) for name, arguments in loaded.model.calls
                    if name == "add_pipes"]
        self.assertEqual(damping(scene.loads(COLLARS)), [1e-4, 1e-4])
        none = scene.loads(COLLARS.replace("count = 3", "count = 3\ndamping_time = 0"))
        self.assertEqual(damping(none), [0.0, 1e-4])
        self.assertEqual(damping(scene.loads(scene.saves(none))), [0.0, 1e-4])
        one = scene.loads(COLLARS.replace("count = 3", "count = 3\nelements = 1"))
        self.assertEqual(scene.loads(scene.saves(one)).model.info().elements, one.model.info().elements)

    def test_given_numbers_and_rods_are_kept(self):
        given = scene.loads(COLLARS.replace('length = "37',
                                            'elements = 1\nlength = "37').replace("count = 3",
                                                                                  "count = 3\nelements = 2"))
        self.assertEqual((given.divided, given.model.info().elements), ([], 7))
        with given.new_sim() as sim:
            self.assertIn("set elements", sim.check_text())
        rods = COLLARS.replace("9.4 m", "3 m").replace("37.72 m", "1 m").replace("127 mm",
                                                                                 "73 mm").replace("108 mm", "61 mm")
        self.assertEqual(scene.loads(rods).divided, [])
        for change in (('length = "9.4 m"', 'kind = "axial-torsional"\nlength = "9.4 m"'),
                       ("[hole]", "[compile]\npipe_kind = \"axial-torsional\"\n[hole]")):
            self.assertNotIn(0, [one.first for one in scene.loads(COLLARS.replace(*change)).divided])


class ShippedTest(unittest.TestCase):
    def assert_saved(self, found):
        """The saved scene is the same, and so is its run."""
        again = scene.loads(scene.saves(found))
        self.assertTrue(again.same_as(found))
        self.assertEqual(after_run(again), after_run(found))

    def test_there_are_three(self):
        self.assertGreaterEqual(len(SCENES), 3)

    def test_file_to_model_to_file(self):
        for path in SCENES:
            first = scene.load(path)
            text = scene.saves(first)
            second = scene.loads(text)
            self.assertTrue(second.same_as(first), path)
            self.assertEqual(scene.saves(second), text)
            self.assertEqual(after_run(second), after_run(first))

    def test_saved_files_keep_comments_and_units(self):
        """Every comment of every shipped scene stays at the end of the line of its key, or before it; a value has its
        unit still."""
        for path in [*SCENES, ROOT / "examples" / "failure_probability" / "rig.toml"]:
            text = path.read_text(encoding="utf-8")
            saved = scene.saves(scene.load(path))
            lines = [line.strip() for line in saved.splitlines()]
            known = 0
            for key, comment, begins in source.scan(text):
                if comment and begins and key[-1] not in source.REPLACED:
                    known += 1
                    head = key[-2] if isinstance(key[-1], int) else key[-1]
                    self.assertTrue(any(comment in line and str(head) in line for line in lines), (path, key, comment))
                elif comment:
                    self.assertIn(comment, saved, path)
            self.assertGreater(known, 0, path)
            self.assertEqual(lines[0], text.splitlines()[0])
        saved = scene.saves(scene.load(ROOT / "examples" / "scenes" / "drainage_300m.toml"))
        for line in ('diameter = "96 mm"', 'h1 = "120 rpm"', 'torque = "3 kN m"', 'static = true',
                     '[fatigue]  # an assumption',
                     '# written out here: survey_file = "drainage_300m.csv"'):
            self.assertIn(line, saved)

    def test_saved_files_have_all_defaults(self):
        """Each field of the library with a number as its default is in the file; another default of the library changes
        nothing then."""
        text = scene.saves(scene.load(ROOT / "examples" / "scenes" / "reference_rig.toml"))
        import tomllib
        saved = tomllib.loads(text)
        for struct, table in (("environment", saved["environment"]), ("hole", saved["hole"]),
                              ("pipes", saved["string"][0]["pipes"][0]),
                              ("bit", saved["bit"][0]), ("drive", saved["drive"][0]), ("sim", saved["sim"]),
                              ("static", saved["static"]),
                              ("modes", saved["modes"]), ("compile", saved["compile"])):
            usual = fields.DEFINITIONS[struct]().describe(every=True)
            for key, field in fields.fields_of(fields.DEFINITIONS[struct]).items():
                if field.kind in ("quantity", "integer",
                                  "flags") and isinstance(usual[key], (int, float)) and 0 <= usual[key] < 1e30:
                    self.assertIn(key, table, struct)
        self.assertEqual(saved["run"]["static"], True)
        self.assertEqual([line for line in text.splitlines() if "1e+30" in line], [])

    def test_saved_after_a_change(self):
        """Values that the command line replaces are written, not those of the file; the first line stays first, the
        last comment last."""
        text = '# mine\n\n[hole]\n# wide\ndiameter = "94 mm" # bit\n[[string]]\npipes = {count = 2} # two\n# the end\n'
        saved = scene.saves(scene.loads(text, changes={"hole.diameter": "100 mm", "string[0].pipes.length": "2 m"}))
        self.assertTrue(saved.startswith("# mine\n"), saved)
        self.assertIn('# wide\ndiameter = "0.1 m"  # bit\n', saved)
        self.assertIn("[[string.pipes]]  # two\n", saved)
        self.assertTrue(saved.endswith("# the end\n"), saved)
        self.assertEqual(scene.saves(scene.loads(saved)), saved)
        self.assertNotIn("#", scene.saves(scene.loads(text), False).replace("# defaults", ""))
        sub = '[[sub]] # in between\nstring = "string-0"\nlength = "0.3 m"\nsection = {pipes = {length = "1 m"}}\n'
        self.assertIn("# in between\n", scene.saves(scene.loads(text + sub)))

    def test_same_bits_as_the_c_program(self):
        compiler = shutil.which(os.environ.get("CC", "cc"))
        if compiler is None or not (BUILD / "libdrillmbd.so").exists():
            self.skipTest("not there: a C compiler, or the library of the build")
        rig = ROOT / "examples" / "gas_drainage_rig"
        with tempfile.TemporaryDirectory() as folder:
            program = pathlib.Path(folder, "rig")
            subprocess.run([compiler, "-std=c11", "-O1", "-ffp-contract=off", f"-I{rig}", f"-I{ROOT / 'include'}",
                            HERE / "scene_rig.c", rig / "scene.c", rig / "cycle.c", "-o", program, f"-L{BUILD}",
                            "-ldrillmbd", "-lm", f"-Wl,-rpath,{BUILD}"], check=True)
            expected = subprocess.run([program], capture_output=True, text=True, check=True).stdout.split()
        loaded = scene.load(ROOT / "examples" / "scenes" / "reference_rig.toml")
        with loaded.new_sim() as sim:
            sim.static(**loaded.fields_of("static"))
            found = [f"{sim.hash():016x}"]
            sim.run(0.05, step=loaded.run["step"])
            found.append(f"{sim.hash():016x}")
        self.assertEqual(found, expected)

    def test_every_kind_of_part(self):
        first = scene.loads(EVERYTHING)
        text = scene.saves(first)
        second = scene.loads(text)
        self.assertTrue(second.same_as(first))
        self.assertEqual(scene.saves(second), text)
        self.assertEqual(after_run(second), after_run(first))
        self.assertEqual(first.analyses["buckling"]["factor_max"], 1e5)
        self.assertEqual(first.analyses["fatigue"]["curve_stress"], 95e6)
        self.assertEqual(first.analyses["response"]["excitation"][0]["amplitude"], 2.0)

    def test_model_without_a_file(self):
        model = mbd.Model()
        model.add_wall()
        string = model.add_pipes(3)
        model.add_drive(part=string, time_function=model.add_time_function(mbd.Segment(kind=mbd.SEGMENT_STEP, h1=0.1)))
        model.compile()
        again = scene.loads(scene.saves(model))
        with model.sim() as one, again.new_sim() as other:
            for sim in (one, other):
                sim.run(0.01, step=1e-3)
            self.assertEqual(one.hash(), other.hash())

    def test_actuators_and_differentials(self):
        text = """[[body]]
name = "rotor"
free_mask = ["rx"]
[[body]]
name = "cage"
[[joint]]
name = "a"
kind = "cylindrical"
place_b = "cage"
[[body]]
name = "wheel"
[[joint]]
name = "b"
kind = "revolute"
place_b = "wheel"
[[coupling]]
name = "three"
joint = ["a", "b"]
component = ["rx", "rx"]
third_joint = "a"
third_component = "x"
third_ratio = 0.25
[[drive]]
name = "head"
kind = "control"
part = "rotor"
component = "rx"
time_function = "60 rpm"
gain = "800 N m s"
delay = "50 ms"
lag = "0.1 s"
force_rate = "20 kN m/s"
drag = "5 N m s"
back_drag = "60 N m s"
inertia = "12 kg m^2"
curve = [["0 rpm", "4 kN m"], ["60 rpm", "4 kN m"], ["140 rpm", "0 N m"]]
"""
        found = scene.loads(text)
        head = dict(found.model.calls)["add_drive"][0]
        self.assertEqual((head["delay"], head["force_rate"], head["inertia"], len(head["curve"])), (0.05, 2e4, 12.0, 3))
        self.assert_saved(found)
        with self.assertRaisesRegex(scene.SceneError, "curve"):
            scene.loads(text.replace('["0 rpm", "4 kN m"]', '["0 rpm"]'))

    def test_settings_outside_their_ranges(self):
        """Refused when the file is read, with line, key, value and range, by every command."""
        for old, new, fault in (
                ("spectral_radius = 0.9", "spectral_radius = 3", "sim.spectral_radius = 3: must be 0 .. 1"),
                ("spectral_radius = 0.9", "newton_tolerance = 0.5",
                 "sim.newton_tolerance = 0.5: must be 0 or 1e-14 .. 0.1"),
                ("spectral_radius = 0.9", 'tolerance_rotation = "-1 deg"',
                 'sim.tolerance_rotation = "-1 deg": must be > 0 (in rad)'),
                ('slip_axial = "1 mm/s"', "tolerance = -1", "static.tolerance = -1: must be 1e-15 .. 0.1"),
                ('frequency_high = "10 Hz"', 'frequency_high = "0.5 Hz"',
                 'response.frequency_high = "0.5 Hz": must be above frequency_low, 1 Hz'),
                ('frequency_high = "10 Hz"', "points = 0", "response.points = 0: must be 1 .. 1e+06"),
                ('speed_high = "100 rpm"', 'speed_low = "500 rpm"',
                 'speeds.speed_low = "500 rpm": must be below speed_high, 30 rad/s by default'),
                ("order = 2", "order = -2", "speeds.order[0].order = -2: must be 0.001 .. 1000"),
                ("slope = 4", "slope = 0.5", "fatigue.slope = 0.5: must be 1 .. 50"),
                ("[static]", '[modes]\nband = ["9 Hz", "2 Hz"]\n[static]',
                 "modes.band = ['9 Hz', '2 Hz']: must increase"),
                ('factor_max = "100 kN"', 'factor_max = "-1 N"',
                 'buckling.factor_max = "-1 N": must be 1e-300 .. 1e+300')):
            found = problems(EVERYTHING.replace(old, new))
            self.assertEqual([str(one) for one in found], [fault], new)

    def test_rate_of_flow_as_an_input(self):
        text = """
[environment]
fluid_density = "1100 kg/m^3"
consistency = "0.05 Pa s"
[hole]
direction = [0, 0, -1]
diameter = "96 mm"
""" + RODS + """[[input]]
name = "pump"
target = "flow-rate"
high = "1200 l/min"
initial = "600 l/min"
"""
        found = scene.loads(text)
        self.assertAlmostEqual(dict(found.model.calls)["add_input"][0]["high"], 0.02, 12)
        self.assert_saved(found)
        with self.assertRaisesRegex(scene.SceneError, "Reynolds"):
            scene.loads(text.replace('"1200 l/min"', '"1e6 l/min"'))

    def test_mud_motors(self):
        text = """
[[body]]
name = "stator"
[[body]]
name = "rotor"
[[joint]]
name = "bearing"
kind = "revolute"
place_a = "stator"
place_b = "rotor"
[[drive]]
name = "motor"
part = "bearing"
motor = {flow = "1200 l/min", table_flow = "1800 l/min", table = [["0 rpm", "900 N m"], ["90 rpm", "700 N m"], ["150 rpm", "0 N m"]]}
"""  # noqa: E501
        found = scene.loads(text)
        drive = dict(found.model.calls)["add_drive"][0]
        self.assertEqual([round(one, 9) for pair in drive["gain_table"] for one in pair],
                         [round(one, 9) for pair in ((0.0, 0.0), (4 * math.pi / 3, 700.0), (10 * math.pi / 3, 900.0))
                          for one in pair])
        self.assert_saved(found)
        for wrong, wanted in (('["90 rpm", "700 N m"]', '["90 rpm"]'), ("1200 l/min", "-1 l/min"),
                              ("table_flow", "flux"),
                            ('"bearing"\nmotor', '"bearing"\ngain = 1\nmotor'),
                              ('["90 rpm", "700 N m"]', '["200 rpm", "700 N m"]')):
            with self.assertRaisesRegex(scene.SceneError, "motor|gain"):
                scene.loads(text.replace(wrong, wanted))

    def test_names_go_to_the_library(self):
        text = """[[string]]
name = "main"
[[string.pipes]]
count = 3
name = "collars"
[[body]]
name = "rotary head"
attach = "start"
[[bit]]
name = "pdc"
"""
        found = scene.loads(text)
        for name in ("main", "rotary head", "pdc"):
            self.assertEqual(found.model[name], found.names[name])
        self.assertEqual(found.model.find_pipes("collars"), (found.names["main"], range(3)))
        again = scene.loads(scene.saves(found))
        self.assertTrue(again.same_as(found))
        self.assertEqual(again.model["pdc"], again.names["pdc"])
        self.assertEqual(again.model.find_pipes("collars"), (again.names["main"], range(3)))
        with self.assertRaisesRegex(scene.SceneError, "23 bytes"):
            scene.loads(text.replace("rotary head", "a name of more than 23 bytes"))

    def test_functions_cannot_be_saved(self):
        model = mbd.Model()
        model.add_pipes(1)
        model.add_drive(time_function=model.add_time_function(lambda time: time))
        model.compile()
        with self.assertRaisesRegex(scene.CannotSave, "function of Python"):
            scene.saves(model)

    def test_worn_gear(self):
        """A speed per revolution moves the head as a function of the caller with the same formulas does, to rounding;
        so it does in the saved file, to the bit."""
        gear = scene.loads(GEAR)
        turning = gear.model.calls[0][1][0]

        def worn(time):
            x, height, length = min(time / 0.02, 1.0), turning["h1"], turning["x1"]
            w, rate = height * x * x * (3.0 - 2.0 * x), height * 6.0 * x * (1.0 - x) / length
            theta = height * (length * x ** 3 * (1.0 - 0.5 * x) + max(time - length, 0.0))
            sine, cosine = math.sin(3.0 * theta), math.cos(3.0 * theta)
            return 0.05 * w * sine, 0.05 * (rate * sine + 3.0 * w * w * cosine), 0.05 / 3.0 * (1.0 - cosine)

        calls = [(name, (mbd.Segment(function=worn, provides=3).describe(),) if name == "add_time_function"
                  and "of" in arguments[0] else arguments)
                 for name, arguments in gear.model.calls]
        with gear.new_sim() as one, remake(mbd.Model,
                                           calls).sim() as other, scene.loads(scene.saves(gear)).new_sim() as saved:
            for sim in (one, other, saved):
                sim.run(0.1, step=1e-3)
            self.assertEqual(one.hash(), saved.hash())
            for at in (one.motion("main").velocity[3], one.rotation("main"), one.drive("head").force):
                self.assertGreater(abs(at), 0.01)
            self.assertAlmostEqual(one.rotation("main"), other.rotation("main"), 13)
            self.assertAlmostEqual(one.drive("head").speed, other.drive("head").speed, 12)
            self.assertAlmostEqual(one.drive("head").force, other.drive("head").force, 6)

    def test_models_of_programs(self):
        """Drives of a constant value and drives that hold, and a time function that is used per revolution alone, are
        read again as they are."""
        model = mbd.Model()
        speed = model.add_time_function(12.0)
        worn = model.add_time_function(12.0, mbd.Segment(kind=mbd.SEGMENT_PER_REVOLUTION, of=speed, share=0.05, h1=0.5,
                                                         order=2.0, phase=0.1))
        body = model.add_body(mass=3.0)
        model.add_pipes(3)
        model.add_drive(component=mbd.RX, time_function=worn)
        model.add_drive(component=mbd.X)
        model.add_drive(part=body, component=mbd.Y, value=0.25)
        model.add_drive(part=body, component=mbd.RZ, kind=mbd.DRIVE_LOAD, value=-4.0)
        model.compile()
        again = scene.loads(scene.saves(model))
        self.assertEqual([one.get("h0", 0.0) for name, (one, *_) in again.model.calls if name == "add_time_function"],
                         [12.0, 12.0, 0.0, 0.25, -4.0])
        with model.sim() as first, again.new_sim() as second:
            for sim in (first, second):
                sim.run(0.05, step=1e-3)
            self.assertEqual(first.hash(), second.hash())

    def test_faults_of_segments_per_revolution(self):
        for old, new, wanted in (
                ('of = "turning"', 'of = "later"', "must name a time function that stands before this one"),
                ('of = "turning"', 'of = "worn"', "must name a time function that stands before this one"),
                ("order = 3}", 'order = 3, table = [["0 s", 0], ["1 s", "2 rpm"]]}',
                 'must be "table" or "periodic" with a table'),
                ("order = 3", "order = 0", "order"), ('share = "5 %"', 'share = "5 m"', "'m'"),
                ('kind = "per-revolution"', 'kind = "harmonic"', 'belongs to segments with kind = "per-revolution"'),
                ('component = "rx"\ntime_function = "turning"', 'component = "x"\ntime_function = "0 m/s"',
                 "this time function is in m/s; use h1"),
                ('h1 = "200 rpm"}',
                 'h1 = "200 rpm"}\n[[time_function]]\nname = "t"\nsegment = {kind = "periodic", table = [["0 s", 0], '
                 '["1 s", "2 rpm"]]}\nunit = "rpm"',
                 "equal to the first value")):
            text = GEAR.replace(old, new)
            self.assertNotEqual(text, GEAR)
            with self.subTest(new=new), self.assertRaises(scene.SceneError) as caught:
                scene.loads(text)
            self.assertIn(wanted, str(caught.exception))

    def test_schema(self):
        shipped = HERE / "drillmbd" / "scene" / "scene.schema.json"
        self.assertEqual(shipped.read_text(encoding="utf-8"), schema.text(),
                         "python3 -m drillmbd schema > bindings/python/drillmbd/scene/scene.schema.json")
        try:
            import jsonschema
        except ImportError:
            self.skipTest("not there: jsonschema")
        import tomllib
        jsonschema.Draft7Validator.check_schema(schema.schema())
        check = jsonschema.Draft7Validator(json.loads(shipped.read_text(encoding="utf-8")))
        for text in [path.read_text(encoding="utf-8") for path in SCENES] + [SMALL, EVERYTHING]:
            check.validate(tomllib.loads(text))
            check.validate(tomllib.loads(scene.saves(scene.loads(text, folder=ROOT / "examples" / "scenes"))))
        for bad in ("[hole]\ndiametre = 1", "[hole]\nnormal_law = \"hertz\"", "[[drive]]\ntime_function = 3",
                    "strings = 1"):
            self.assertFalse(check.is_valid(tomllib.loads(bad)), bad)


class LinesTest(unittest.TestCase):
    def test_lines(self):
        found = lines.find_lines('a = 1\n[b]\n"c d" = [\n1,\n]\ne.f = """\n[x]\n"""\n'
                                 '[[g]]\nh = 1\n[[g.i]]\n[[g]]\n[[g.i]]\nj=2\n')
        self.assertEqual([found[path] for path in (("a",), ("b",), ("b", "c d"), ("b", "e", "f"), ("g", 0, "h"),
                                                   ("g", 0, "i", 0), ("g", 1), ("g", 1, "i", 0, "j"))],
                         [1, 2, 3, 6, 10, 11, 12, 14])
        self.assertNotIn(("x",), found)
        self.assertEqual(lines.line_of(found, ("b", "c d", 3)), 3)


class BadFilesTest(unittest.TestCase):
    def one(self, old, new, line, key, *parts):
        """The file with a fault has this one problem."""
        self.assertIn(old, SMALL)
        found = problems(SMALL.replace(old, new, 1))
        self.assertEqual(len(found), 1, [str(one) for one in found])
        self.assertEqual((found[0].line, found[0].key), (line, key), str(found[0]))
        for part in parts:
            self.assertIn(part, str(found[0]))

    def test_single_faults(self):
        self.assertEqual(problems(SMALL), [])
        self.one("diameter", "diametre", 3, "hole.diametre", "unknown key", "did you mean diameter?")
        self.one('"94 mm"', '"94 kg"', 3, "hole.diameter", '"94 kg"', "has the unit 'kg'", "length")
        self.one('"94 mm"', '"-94 mm"', 3, "hole.diameter", '"-94 mm"', "must", "(in m)")
        self.one('"94 mm"', "94", 3, "hole.diameter", "must have a unit")
        self.one('"94 mm"', '"94 zz"', 3, "hole.diameter", "'zz' is not a known unit")
        self.one('kind = "step"', 'kind = "stop"', 6, "time_function[0].segment.kind", "did you mean step?")
        self.one('h1 = "10 mm/s"', 'h1 = "120 kg"', 6, "time_function[0].segment.h1", "has the unit 'kg'", "speed")
        self.one('h1 = "10 mm/s"', 'h1 = "10 rpm"', 6, "time_function[0].segment.h1", "speed, as \"10 mm/s\"")
        self.one("count = 3", "count = 0", 10, "string[0].pipes[0].count", "1 .. 2^20")
        self.one("count = 3", 'count = 3\nouter_diameter = "50 mm"', 11, "string[0].pipes[0].outer_diameter", "must")
        self.one('end = "10 ms"', 'end = "-10 ms"', 15, "run.end", "must be > 0 s")
        self.one('end = "10 ms"', 'end = "10 m"', 15, "run.end", "has the unit 'm'", "time")
        self.one("[run]", "[[bitt]]\nx = 1\n[[bitt]]\n[run]", 14, "bitt", "unknown key", "did you mean bit?")
        self.one("[run]", "[[string.bits]]\nx = 1\n[run]", 14, "string[0].bits", "unknown key")
        self.one("[run]", "[rum]", 14, "rum", "unknown key", "did you mean run?")
        self.one('name = "main"', 'name = "feed"', 8, "string[0].name", "names a time function already")
        self.one('name = "main"', "name = 3", 8, "string[0].name", "must be a text")
        self.one('title = "small"', "title = 3", 1, "title", "must be a text")
        self.one('step = "1 ms"', 'step = "1 ms"\n[[output]]\nplace = "main"', 17, "output[0]", "must have a quantity")
        self.one('step = "1 ms"', 'step = "1 ms"\n[[output]]\nquantity = "spin"\nplace = {part = "main", pipe = 3}', 19,
                 "output[0].place.pipe", "0 .. 2")

    def test_units_in_names_of_outputs(self):
        """Values of a column are in SI: another unit in its head is refused, other words in brackets are a name."""
        for name, quantity, unit in (("push [kN]", "hook-load", "N"), ("bit [rpm]", "bit-speed", "rad/s"),
                                     ("depth [ft]", "bit-depth", "m"), ("depth [-]", "bit-depth", "m"),
                                     ("push [s]", "hook-load", "N"), ("share [%]", "off-bottom", "-")):
            self.one('step = "1 ms"', f'step = "1 ms"\n[[output]]\nname = "{name}"\nquantity = "{quantity}"\n'
                     'place = "main"', 18, "output[0].name", f"the values are in {unit}; write",
                     f"{name[:name.index('[')]}[{unit}]\"")
        for name, quantity in (("push [N]", "hook-load"), ("torque [Nm]", "rotation-torque"), ("push", "hook-load"),
                               ("push [rig]", "hook-load"), ("push [rod 3]", "hook-load"), ("[kN] push", "hook-load")):
            self.assertEqual(problems(SMALL.replace('step = "1 ms"', f'step = "1 ms"\n[[output]]\nname = "{name}"\n'
                                                    f'quantity = "{quantity}"\nplace = "main"')), [], name)

    def test_no_second_fault(self):
        """A misspelt table or name is one fault; the time function that is not used because of it is none. Alone it is
        one."""
        text = ('[[time_function]]\nname = "load"\nsegment = {h0 = "2 kN"}\n[hole]\ndiameter = "94 '
                'mm"\n[[string]]\n[[string.pipes]]\ncount = 2\n'
                '[[bit]]\nload = "load"\n')
        mbd.scene.loads(text)
        for old, new, wanted in (("[[bit]]", "[[bitt]]", ["bitt: unknown key"]),
                                 ('load = "load"', 'load = "lead"', ["bit[0].load"]),
                               ('[[bit]]\nload = "load"\n', "", ["is used by no drive, load or bit"]),
                               ('diameter = "94 mm"', 'diameter = "20 mm"',
                                ["string[0]: pipes of string 0: outer_diameter"])):
            with self.assertRaises(mbd.scene.SceneError) as caught:
                mbd.scene.loads(text.replace(old, new))
            self.assertEqual(len(caught.exception.problems), len(wanted), str(caught.exception))
            for part in wanted:
                self.assertIn(part, str(caught.exception))

    def test_name_that_is_none(self):
        found = problems(SMALL.replace('time_function = "feed"', 'time_function = "fed"'))
        self.assertIn("drive[0].time_function", [one.key for one in found])
        self.assertTrue(any("names no time function; did you mean feed?" in str(one) for one in found))
        # no drives among the candidates
        found = [str(one) for one in problems(SMALL.replace('time_function = "feed"', 'time_function = "nope"'))]
        self.assertTrue(any(one.endswith("names no time function; possible are feed") for one in found), found)

    def test_drive_without_time_function(self):
        for component, held in (("x", "0 m/s"), ("rx", "0 rpm")):
            text = SMALL.replace('[[drive]]', f'[[drive]]\nname = "bare"\ncomponent = "{component}"\n\n[[drive]]', 1)
            found = [str(one) for one in problems(text)]
            self.assertTrue(any(f'must have a time function: the name of one, or a constant as time_function = "{held}"'
                                in one for one in found), found)

    def test_all_faults_at_once(self):
        text = SMALL.replace('"94 mm"', '"-94 mm"\nrestitution = 3\nmu_dynamics = 0.1').replace('"10 ms"', '"10 kg"')
        keys = [one.key for one in problems(text)]
        self.assertEqual(keys, ["hole.diameter", "hole.restitution", "hole.mu_dynamics", "run.end"])

    def test_faults_of_the_whole_scene(self):
        found = problems(SMALL + '[[bit]]\ndiameter = "10 m"\n')
        self.assertEqual(len(found), 1)
        self.assertIn("must", str(found[0]))

    def test_no_toml(self):
        for text, line in (("title = \n", 1), ("[hole\n", 1), ("a = 1\na = 2\n", 2), ("x = " + "[" * 5000, 1)):
            found = problems(text)
            self.assertEqual(len(found), 1)
            self.assertIn("is no TOML", str(found[0]))
            self.assertLessEqual(abs(found[0].line - line), 1)

    def test_time_function_used_twice(self):
        found = problems(SMALL + '[[drive]]\ncomponent = "rx"\ntime_function = "feed"\n')
        self.assertIn("make two time functions", str(found[0]))

    def test_not_a_text_file(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "x.toml")
            path.write_bytes(b"title = 'a'\n\xff\xfe\x00")
            with self.assertRaisesRegex(scene.SceneError, "x.toml:2: the file: must be text in UTF-8"):
                scene.load(path)
            with self.assertRaises(OSError):
                scene.load(pathlib.Path(folder, "none.toml"))

    def test_surveys(self):
        def reported(name_or_rows, csv=None):
            with tempfile.TemporaryDirectory() as folder:
                if csv is not None:
                    pathlib.Path(folder, "s.csv").write_text(csv, encoding="utf-8")
                found = problems(SMALL.replace('diameter = "94 mm"', name_or_rows), folder)
            return " ".join(str(one) for one in found)

        heads = "depth [m], inclination [deg], azimuth [deg]\n"
        good = heads + "0, 90, 0\n30, 95, 1\n"
        self.assertEqual(reported('survey_file = "s.csv"', good), "")
        feet = "Measured depth [ft],Inclination [rad],Azimuth [deg]\n0,1.5,0\n99,1.6,0\n"
        self.assertEqual(reported('survey_file = "s.csv"', feet), "")
        for csv, part in ((None, "could not be read"), ("", "is empty"), (heads, "at least two stations"),
                          (heads + "0, ninety, 0\n30, 95, 1\n", 'line 2, column 2 (inclination [deg]) = "ninety"'),
                          (heads + "0, 90\n30, 95, 1\n", "azimuth is empty"),
                          ("depth [kg], i [deg], a [deg]\n", "heads"),
                          (heads + "30, 90, 0\n0, 95, 1\n", "must"), (heads + "0, 900, 0\n30, 95, 1\n", "must")):
            self.assertIn(part, reported('survey_file = "s.csv"', csv), csv)
        self.assertIn("at least two rows", reported("survey = []"))
        self.assertIn("must be a row", reported('survey = [["0 m"], ["1 m", "1 rad", "0 rad"]]'))
        self.assertIn("must be a length", reported('survey = [["x", "1 rad", "0 rad"], ["1 m", "1 rad", "0 rad"]]'))

    def test_files_cut_at_every_line(self):
        for text in [path.read_text(encoding="utf-8") for path in SCENES] + [EVERYTHING]:
            rows = text.splitlines(keepends=True)
            for end in range(len(rows)):
                for one in problems("".join(rows[:end]), ROOT / "examples" / "scenes"):
                    self.assertTrue(1 <= one.line <= end + 1)

    def test_every_key_misspelt(self):
        rows = EVERYTHING.splitlines()
        for number, row in enumerate(rows):
            key = row.split("=")[0].strip()
            if "=" in row and key not in ("title", "segment"):
                wrong = "\n".join(rows[:number] + [row.replace(key, key + "x", 1)] + rows[number + 1:])
                said = [one for one in problems(wrong) if "unknown key" in one.text]
                self.assertEqual([one.line for one in said], [number + 1], row)
                self.assertIn(f"did you mean {key}?", str(said[0]))

    def test_values_of_other_types(self):
        """Every value replaced by every kind of value: SceneError or a scene, nothing else."""
        draw = random.Random(1)
        rows = EVERYTHING.splitlines()
        for number, row in enumerate(rows):
            if "=" in row:
                for value in draw.sample(['"x"', "3", "-1e300", "nan", "true", "[]", "{}", '["1 m", 2]', "1979-05-27",
                                          '""',
                                          '"-1 m"', "[[[]]]", '{part = "main", pipe = -1}'], 5):
                    problems("\n".join(rows[:number] + [row.split("=")[0] + "= " + value] + rows[number + 1:]))



class UnitOfDriveTest(unittest.TestCase):
    """"N or N m" of an output depends on its drive: a torque on a rotary drive was requested in N."""
    SCENE = """
[[string]]
name = "rods"
[[string.pipes]]
count = 2
[[drive]]
name = "table"
component = "rx"
time_function = "0 rpm"
[[drive]]
name = "feed"
component = "x"
time_function = "0 mm/s"
[[event]]
name = "torque"
quantity = "drive-force"
place = "table"
level = "100 N m"
[[event]]
name = "push"
quantity = "drive-force"
place = "feed"
level = "2 kN"
[speeds]
[[speeds.order]]
[[speeds.output]]
quantity = "drive-force"
place = "table"
limit = "5 N m"
"""

    def test_levels_and_limits(self):
        from drillmbd import scene
        made = scene.loads(self.SCENE)
        self.assertEqual([arguments[0]["level"] for name, arguments in made.model.calls if name == "add_event"],
                         [100.0, 2000.0])
        self.assertEqual(made.analyses["speeds"]["output"][0]["limit"], 5.0)
        saved = scene.saves(made)
        self.assertIn('level = "100 N m"', saved)  # as the file has it
        self.assertTrue(scene.loads(saved).model.same_scene(made.model))
        for wrong in (self.SCENE.replace("100 N m", "100 N"), self.SCENE.replace("2 kN", "2 N m"),
                      self.SCENE.replace("5 N m", "5 N")):
            with self.assertRaisesRegex(scene.SceneError, "has the unit"):
                scene.loads(wrong)


if __name__ == "__main__":
    unittest.main()
