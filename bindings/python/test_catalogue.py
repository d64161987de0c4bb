"""Tests of the catalogue: its numbers against closed formulas and published strengths, names as people write them,
scene files, the command."""
import contextlib
import io
import math
import pathlib
import tempfile
import unittest

from drillmbd import scene
from drillmbd.command import main
from drillmbd.scene import catalogue, units

LBF, FT_LBF, PSI = 4.4482216152605, 1.3558179483314, 6894.757293168
#: API RP 7G, Tables 2: tension [lbf] and torsional yield [ft lbf] of new E75 pipe by size and nominal weight.
E75 = {"2 3/8 in 4.85": (97817, 4763), "2 3/8 in 6.65": (138214, 6250), "2 7/8 in 6.85": (135902, 8083),
       "2 7/8 in 10.40": (214344, 11554),
       "3 1/2 in 9.50": (194264, 14146), "3 1/2 in 13.30": (271569, 18551), "3 1/2 in 15.50": (322775, 21086),
       "4 in 11.85": (230755, 19474),
       "4 in 14.00": (285359, 23288), "4 in 15.70": (324118, 25810), "4 1/2 in 13.75": (270034, 25907),
       "4 1/2 in 16.60": (330558, 30807),
       "4 1/2 in 20.00": (412358, 36901), "4 1/2 in 22.82": (471239, 40912), "5 in 16.25": (328073, 35044),
       "5 in 19.50": (395595, 41167),
       "5 in 25.60": (530144, 52257), "5 1/2 in 19.20": (372181, 44074), "5 1/2 in 21.90": (437116, 50710),
       "5 1/2 in 24.70": (497222, 56574),
       "6 5/8 in 25.20": (489464, 70580), "6 5/8 in 27.70": (534198, 76295)}
SCENE = """{head}
[hole]
diameter = "12 in"
dip = "-90 deg"
[[string]]
[[string.pipes]]
count = 3
length = "9 m"
{pipes}
[limits]
{limits}
"""
OWN = """
[[pipe]]
name = "phi 73 mine"
outer_diameter = "73 mm"
inner_diameter = "59 mm"
joint_length = "0.3 m"
joint_outer_diameter = "75 mm"
joint_inner_diameter = "40 mm"
[[grade]]
name = "R780"
yield_strength = "520 MPa"
source = "certificate 12"
[[rig]]
name = "ZDY4000S"
torque = "4 kN m"
push = "100 kN"
"""


def strengths(values):
    """Tension [N], torsional yield [N m] and mass per length [kg/m] of a pipe."""
    outer, inner = (units.parse(values[key], "m") for key in ("outer_diameter", "inner_diameter"))
    area = math.pi / 4 * (outer ** 2 - inner ** 2)
    stress = units.parse(values["yield_strength"], "Pa") if "yield_strength" in values else 0.0
    return area * stress, math.pi / 16 * (outer ** 4 - inner ** 4) / outer * stress / math.sqrt(3), 7850.0 * area


def pipes_of(text, head="", limits="", folder="."):
    """The scene, the keys of its pipes, and what was remarked."""
    made = scene.loads(SCENE.format(head=head, pipes=text, limits=limits), folder=folder)
    return made, next(call[1][1] for call in made.model.calls
                      if call[0] == "add_pipes"), [one.text for one in made.remarks]


def said(*words):
    """Exit status, output and errors of the command."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        status = main(list(words))
    return status, out.getvalue(), err.getvalue()


class NumbersTest(unittest.TestCase):
    def setUp(self):
        self.names = catalogue.Catalogue()

    def test_masses(self):
        rows = [one for one in self.names.of("pipe") if "plain_end_mass" in one.values]
        self.assertEqual({one.name for one in rows}, set(E75))
        for one in rows:
            self.assertAlmostEqual(strengths(one.values)[2] / units.parse(one.values["plain_end_mass"], "kg/m"), 1.0,
                                   delta=0.003)
            # with a threaded joint of old: more than the body's
            nominal = units.parse(one.name.split()[-1] + " lb/ft", "kg/m")
            self.assertTrue(0.75 < strengths(one.values)[2] / nominal < 1.0, one.name)

    def test_strengths(self):
        for name, (tension, torque) in E75.items():
            found = strengths(self.names.pipe(f"{name} E75").values)
            self.assertAlmostEqual(found[0] / (tension * LBF), 1.0, delta=1e-5)
            self.assertAlmostEqual(found[1] / (torque * FT_LBF), 1.0, delta=1e-3)  # the table has 0.577 for 1 / sqrt 3
        for grade, tension, torque in (("X95", 501087, 52144), ("G105", 553833, 57633), ("S135", 712070, 74100)):
            found = strengths(self.names.pipe(f"5 in 19.5 lb/ft {grade}").values)
            self.assertAlmostEqual(found[0] / (tension * LBF), 1.0, delta=1e-5)
            self.assertAlmostEqual(found[1] / (torque * FT_LBF), 1.0, delta=1e-3)

    def test_premium(self):
        new, worn = (self.names.pipe(f"5 in 19.50 S135{word}").values for word in (" new", " premium"))
        self.assertEqual(new, self.names.pipe("5 in 19.50 S135").values)
        walls = [units.parse(one["outer_diameter"], "m") - units.parse(one["inner_diameter"], "m")
                 for one in (new, worn)]
        self.assertAlmostEqual(walls[1] / walls[0], 0.8, delta=1e-6)
        tension, torque, _ = strengths(worn)  # API RP 7G, Table 4
        self.assertAlmostEqual(tension / (560764 * LBF), 1.0, delta=1e-4)
        self.assertAlmostEqual(torque / (58113 * FT_LBF), 1.0, delta=1e-3)

    def test_every_number_has_a_source(self):
        for one in self.names.of(*catalogue.KINDS):
            self.assertGreater(len(one.source), 20, one)
            self.assertNotIn("no source", one.source)
        for one in self.names.of("collar"):  # a bore below half the outside, 100 ksi from 7 in
            outer, inner = (units.parse(one.values[key], "m") for key in ("outer_diameter", "inner_diameter"))
            self.assertTrue(0.0 < inner < 0.5 * outer)
            self.assertAlmostEqual(units.parse(one.values["yield_strength"], "Pa") / PSI,
                                   100e3 if outer >= 0.1778 else 110e3, delta=1.0)

    def test_rods_are_their_names(self):
        for one in self.names.of("pipe"):
            if one.name.startswith("phi"):
                by_size, _ = self.names._by_dimensions(one.name)
                for key, value in by_size.items():
                    self.assertAlmostEqual(units.parse(value, "m"), units.parse(one.values[key], "m"), delta=1e-9)


class NamesTest(unittest.TestCase):
    def setUp(self):
        self.names = catalogue.Catalogue()

    def test_spellings(self):
        for spelled in ("5in 19.5 lb/ft S-135", '5" 19.50 ppf s135', "5.0 in 19,5 S135"):
            self.assertEqual(self.names.pipe(spelled).values, self.names.pipe("5 in 19.50 S135").values)
        for spelled in ("4-1/2in 16.6 E75", "4½ in 16.60 E-75", "4.5 in 16.6 e75"):
            self.assertEqual(self.names.pipe(spelled).values, self.names.pipe("4 1/2 in 16.60 E75").values)
        for spelled in ("phi 73 x 6.5", "φ73×6.5", "Φ 73*6,5 mm", "73 mm x 6.5 mm", "直径 73 x 6.5", "73 x 6.5 mm",
                        "7.3 cm x 0.65"):
            values = self.names.pipe(spelled).values
            self.assertAlmostEqual(units.parse(values["outer_diameter"], "m"), 0.073, delta=1e-12)
            self.assertAlmostEqual(units.parse(values["inner_diameter"], "m"), 0.060, delta=1e-12)
        for spelled in ("2 7/8 in x 0.362 in", '2 7/8" x 0.362"', "phi 2 7/8 in x 0.362"):  # one unit holds for both
            self.assertAlmostEqual(units.parse(self.names.pipe(spelled).values["inner_diameter"], "m"), 2.151 * 0.0254,
                                   delta=1e-9)

    def test_grades_of_rods(self):
        self.assertEqual(units.parse(self.names.pipe("phi 73 x 7 780 MPa").values["yield_strength"], "Pa"), 780e6)
        self.assertEqual(self.names.pipe("phi 73 x 7 S135").values["yield_strength"], "135 ksi")
        unknown = self.names.pipe("phi 73 x 7 R780")
        self.assertNotIn("yield_strength", unknown.values)  # a number in a name is no yield strength
        self.assertIn("R780 is in no catalogue", unknown.text())
        self.assertNotIn("R780", unknown.text(["yield_strength"]))

    def test_refused(self):
        for name, part in (("5 in 19.4 S135", "did you mean 5 in 16.25 or 5 in 19.50"),
                           ("5 in 19.5 S136", "did you mean S135"),
                           ("73x6.5", "phi 73 x 6.5"), ("phi 73 x 59", "wall of 59 mm, which must be below a third"),
                           ("phi 73 x 0", "wall of 0 mm"), ("rubbish", "lists the names"),
                           ("phi 73 x 6.5 x 1500", "must be a grade"),
                           ("phi 73 x 6.5 780", "as 780 MPa"), ("", "in no catalogue"), ("phi 73", "phi 73 x"),
                           ("8 x 2 13/16", "collar 8 x 2 13/16"), ("phi 1,000 x 5", "may be 1000 mm or 1.000 mm")):
            with self.assertRaisesRegex(catalogue.CatalogueError, part):
                self.names.pipe(name)
        for name, part in (("ZDY4000S", "no public data sheet"), ("Flecher LHD", "did you mean Fletcher LHD")):
            with self.assertRaisesRegex(catalogue.CatalogueError, part):
                self.names.rig(name)


class SceneTest(unittest.TestCase):
    def test_keys_of_the_file_come_first(self):
        made, pipes, remarks = pipes_of('pipe = "5 in 19.50 S135"\ninner_diameter = "100 mm"',
                                        limits='rig = "Fletcher LHD"\npush = "50 kN"')
        self.assertEqual((pipes["outer_diameter"], pipes["inner_diameter"]), (0.127, 0.1))
        self.assertAlmostEqual(pipes["yield_strength"] / (135e3 * PSI), 1.0, delta=1e-12)
        self.assertEqual(made.limits["push"], 50e3)
        self.assertAlmostEqual(made.limits["pull"], 40000 * LBF, delta=1e-6)
        self.assertAlmostEqual(made.limits["torque"], 11000 / 12 * FT_LBF, delta=1e-6)
        self.assertIn("own inner_diameter holds instead", remarks[0])
        self.assertIn("source: API RP 7G", remarks[0])
        self.assertTrue(made.same_as(scene.loads(scene.saves(made))))

    def test_same_as_written_out(self):
        named, _, _ = pipes_of('pipe = "phi 73 x 6.5"')
        plain, _, remarks = pipes_of('outer_diameter = "73 mm"\ninner_diameter = "60 mm"')
        self.assertTrue(named.same_as(plain))
        self.assertEqual(remarks, [])

    def test_refused_by_line(self):
        for text, part in (('pipe = "5 in 19.4"\ninner_diameter = "100 mm"',
                            r"scene:9: string\[0\].pipes\[0\].pipe = \"5 in 19.4\": is in no"),
                           ("pipe = 3", "in quotes")):
            with self.assertRaisesRegex(scene.SceneError, part) as caught:
                pipes_of(text)
            self.assertEqual(len(caught.exception.problems), 1)  # no fault of default diameters beside it
        with self.assertRaisesRegex(scene.SceneError, "scene:11: limits.rig = \"ZDY4000S\": is in no catalogue"):
            pipes_of('pipe = "phi 73 x 7"', limits='rig = "ZDY4000S"')
        for head, part in (('catalogue = "no.toml"', "No such file"), ("catalogue = 3", "must name a file")):
            with self.assertRaisesRegex(scene.SceneError, part):
                pipes_of('pipe = "phi 73 x 7"', head)

    def test_own_catalogue(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "own.toml")
            file.write_text(OWN, encoding="utf-8")
            made, pipes, remarks = pipes_of('pipe = "phi 73 mine R780"', 'catalogue = "own.toml"', 'rig = "ZDY4000S"',
                                            folder)
            self.assertEqual([pipes[key] for key in ("inner_diameter", "joint_length", "yield_strength")],
                             [0.059, 0.3, 520e6])
            self.assertEqual(made.limits, {"torque": 4e3, "push": 100e3})
            self.assertIn("own.toml, no source given; certificate 12", remarks[0])
            self.assertIn("pull is not known", remarks[1])
            self.assertEqual(pipes_of('pipe = "phi 89 x 5 R780"', 'catalogue = ["own.toml"]',
                                      folder=folder)[1]["yield_strength"], 520e6)
            self.assertIn("phi 73 mine", said("catalogue", "mine", "--file", str(file))[1])
            for old, new, part in (("yield_strength", "yield_stress",
                                    "unknown key yield_stress; did you mean yield_strength"),
                                   ("520 MPa", "520 mm", "R780: yield_strength"),
                                   ('name = "R780"', "", "without a name"),
                                   ("[[rig]]", "[[rigs]]", "unknown table rigs; did you mean rig"),
                                   ("[[rig]]", "[[rig", "no TOML")):
                file.write_text(OWN.replace(old, new), encoding="utf-8")
                with self.assertRaisesRegex(scene.SceneError, "own.toml: .*" + part):
                    pipes_of('pipe = "phi 73 x 7"', 'catalogue = "own.toml"', folder=folder)


class CommandTest(unittest.TestCase):
    def test_list(self):
        status, text, _ = said("catalogue")
        self.assertEqual(status, 0)
        for one in catalogue.Catalogue().of(*catalogue.KINDS):
            self.assertIn(one.name, text)
        self.assertRegex(said("catalogue", "5 in")[1],
                         r"5 in 19.50 +outer_diameter 5 in, inner_diameter 4.276 in, plain_end_mass 17.93 lb/ft +\[1\]")
        self.assertNotIn("5 1/2", said("catalogue", "5 in")[1])
        self.assertEqual(said("catalogue", "Fletchr LHD")[0], 2)

    def test_new(self):
        status, text, _ = said("new", "drainage", "--rods", "phi 73 x 6.5", "--rig", "Fletcher LHD")
        self.assertEqual(status, 0)
        made = scene.loads(text)
        self.assertAlmostEqual(made.limits["push"], 30000 * LBF, delta=1e-6)
        self.assertEqual(said("new", "well", "--rods", "5 in 19.50 S135")[0], 0)
        for words in (("--rods", "phi 110 x 8"), ("--rods", "phi 73 x 65"), ("--rig", "ZDY4000S")):
            status, _, told = said("new", "drainage", *words)
            self.assertEqual(status, 2)
            self.assertIn(words[0], told)


if __name__ == "__main__":
    unittest.main()
