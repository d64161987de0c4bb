"""Tests of limits of failures: those that vary, those that a scene does not give, keys that vary together, and pairs of
cells."""
import csv
import json
import math
import tomllib
import unittest
import unittest.mock

from shared_tests import FolderTest, needs

needs("h5py", "matplotlib", "numpy", "scipy")

import numpy as np
from scipy import stats
from test_study_analyses import LEVEL, WEIGHT, failure

from drillmbd import scene
from drillmbd.probability.cells import Cell, Map, paired
from drillmbd.probability.draw import Draw
from drillmbd.probability.sample import FAILED, SceneSample
from drillmbd.scene.failure import KINDS
from drillmbd.scene.overrides import by_number, key_of_path, path_of_key
from drillmbd.sweep import settings_of, varied

RIG = """[limits]
torque = "250 N m"
[[variability.scatter]]
name = "push of the rig"
key = "failure[0].limit"
distribution = "normal"
mean = "9.7 kN"
deviation = "0.1 kN"
"""
SHARE = """[[variability.scatter]]
name = "torque of the rig"
key = "limits.torque"
relative = true
distribution = "uniform"
low = 0.5
high = 1
"""
PUSH = failure("rig-push", limit="9.7 kN")


class DrawnTest(FolderTest):
    SCENE = LEVEL + RIG + PUSH

    def test_every_analysis(self):
        """margin = limit of the sample - demand, by a limit of the failure itself and by one of [limits] that it
        takes."""
        for question in ("torque-drag", "static"):
            sample = SceneSample(LEVEL + RIG + SHARE + PUSH + failure("rig-torque") + failure("rig-pull", limit="3 kN"),
                                 given_question=question)
            for number in range(3):
                one = sample(number, np.random.default_rng(number).standard_normal(sample.dimension))
                friction, push, torque = one.inputs
                for margin, demand, limit in zip(one.margins, one.demands, (push, 250.0 * torque, 3000.0), strict=True):
                    self.assertLess(abs(margin + demand - limit), 1e-9 * limit)

    def test_keys_that_vary(self):
        text = LEVEL + failure("jamming", limit="1 kN", pull="5 kN", torque="1 N m",
                               diameter="73 mm") + """[[variability.scatter]]
name = "pull"
key = "failure.pull"
distribution = "uniform"
low = "4 kN"
high = "6 kN"
"""
        sample = SceneSample(text)
        for number in range(3):
            one = sample(number, np.random.default_rng(number).standard_normal(2))
            friction, pull = one.inputs
            self.assertLess(abs(one.demands[0] - (pull - friction * WEIGHT)), 1e-6 * WEIGHT)

    def test_limits_that_cannot_be(self):
        """A sample with a limit that is not permitted is lost, with the parameter in its message."""
        sample = SceneSample(LEVEL + RIG.replace('"0.1 kN"', '"9.7 kN"') + PUSH)
        one = sample(0, np.array([0.0, -3.0]))
        self.assertEqual(one.status, FAILED)
        self.assertRegex(one.message, "limit = -19.4 kN of push of the rig, must be > 0|limit = -19400")

    def test_probability(self):
        """P(limit < demand) of two normal numbers; the limit is what to measure better."""
        out = self.call("probability", self.scene, "-o", self.folder / "out", "--samples", 2000, "--engine", "serial")
        summary = json.loads((self.folder / "out" / "summary.json").read_text(encoding="utf-8"))
        mean, deviation = 8000.0 + 0.3 * WEIGHT - 9700.0, math.hypot(0.03 * WEIGHT, 100.0)
        known, one = stats.norm.sf(-mean / deviation), summary["estimates"]["rig-push"]
        self.assertTrue(one["low"] <= known <= one["high"], (known, one))
        ranks = summary["demands"]["rig-push"]["rank_correlation"]
        self.assertLess(ranks["push of the rig"]["value"], -5.0 * ranks["push of the rig"]["least_that_counts"])
        self.assertIn("of the limit of the scene file", out)

    def test_refused(self):
        for key, wanted in (("failure[3].limit", "single number"), ("failure[0].pull", "single number"),
                            ("limits.rig", "single number"),
                          ("failure[0].from", "single number"), ("limits.torque.x", "single number")):
            with self.assertRaisesRegex(scene.SceneError, wanted, msg=key):
                scene.loads(LEVEL + RIG.replace("failure[0].limit", key) + PUSH)


class FactorTest(FolderTest):
    SCENE = LEVEL.replace('segment = {kind = "step5", x1 = "1 s", h1 = "10 mm/s"}',
                          'segment = [{h0 = "10 mm/s"}, {kind = "per-revolution", of = "turning", h1 = "1 mm/s"}]') + \
        PUSH + '''[[variability.process]]
name = "speed of the feed"
time_function = "feeding"
how = "factor"
correlation_time = "0.5 s"
distribution = "normal"
mean = 1
deviation = 0.1
'''

    def test_a_segment_per_revolution_has_no_factor(self):
        """Its values are known in a run only: refused once, before the first sample."""
        said = self.call("probability", self.scene, "--samples", 4, "--engine", "serial", status=2)
        self.assertIn("speed of the feed: time function feeding: a segment of kind per-revolution cannot be multiplied",
                      said)
        self.assertIn('use how = "added"', said)
        added = self.SCENE.replace('how = "factor"', 'how = "added"').replace("mean = 1\ndeviation = 0.1",
                                                                              'mean = "0 mm/s"\ndeviation = "1 mm/s"')
        self.assertEqual(len(Draw(scene.loads(added)).processes), 1)


class DefaultTest(FolderTest):
    SCENE = LEVEL + failure("wall-pressure", width="20 mm")

    def test_sources(self):
        """A default of a coal seam is stated with its source; without a source there is none."""
        out = self.call("probability", self.scene, "--samples", 10, "--engine", "serial", "-o", self.folder / "out")
        notes = json.loads((self.folder / "out" / "summary.json").read_text(encoding="utf-8"))["notes"]
        self.assertTrue(any("is assumed" in one and "10.3390/pr13072195" in one for one in notes), (out, notes))
        self.assertEqual(scene.loads(LEVEL + failure("wall-pressure", width="20 mm")).failures[0].limit,
                         KINDS["wall-pressure"].default)
        for kind, wanted in (("jamming", "no public measurement"), ("leaves-seam", "thickness of the seam"),
                             ("connection-torque", "make_up_torque")):
            with self.assertRaisesRegex(scene.SceneError, f"(?s)must have a limit.*{wanted}"):
                scene.loads(LEVEL + failure(kind))

    def test_make_up_torque(self):
        made = scene.loads(LEVEL + '[limits]\nmake_up_torque = "900 N m"\n' + failure("connection-torque"))
        self.assertEqual(made.failures[0].limit, 900.0)
        self.assertTrue(made.same_as(scene.loads(scene.saves(made))))


class TogetherTest(FolderTest):
    SCENE = LEVEL.replace("mean = 0.3\ndeviation = 0.03", "relative = true\nmean = 1\ndeviation = 0.1") + PUSH

    def test_grammar(self):
        self.assertEqual(varied("a.b & c=1 & 2 m,3"), ("a.b & c", ["1 & 2 m", 3]))
        self.assertEqual(settings_of({"a.b & c": "1 & 2 m", "d": "x & y"}), {"a.b": 1, "c": "2 m", "d": "x & y"})
        self.assertEqual(settings_of({"a & b": 3.5}), {"a": 3.5, "b": 3.5})
        self.assertEqual(varied("a & b=1 m:3 m:2"), ("a & b", ["1.0 m", "3.0 m"]))
        for wrong, wanted in (("a & b=1 & 2 & 3", "3 values for 2 keys"), ("a &=1", "is no key"),
                              ("& a=1", "is no key")):
            with self.assertRaisesRegex(ValueError, wanted):
                varied(wrong)

    def test_tables_by_their_names(self):
        """time_function[feeding] is the item of the array with this name, in --vary of both commands and in
        [variability]."""
        content = tomllib.loads(self.SCENE)
        for key, number in (("time_function[feeding].segment.h1", "time_function[2].segment.h1"),
                            ("string[rods].pipes[0].length", "string[0].pipes[0].length"),
                            ("hole.diameter", "hole.diameter"),
                            ("string[0].pipes.eccentricity", "string[0].pipes.eccentricity")):
            self.assertEqual(by_number(key, content), number)
            self.assertEqual(key_of_path(path_of_key(key)), key)
        for key, wanted in (("time_function[feding].segment.h1",
                             "no .*time_function.* is named feding; did you mean feeding"),
                            ("time_function[zz].segment.h1", "possible are feeding, rock, turning"),
                            ("string[rods].pipes[a].length", "none has a name.*string\\[0\\].pipes\\[0\\]"),
                            ("hole[x].diameter", "none has a name"), ("nothing[x].y", "the scene has no .*nothing"),
                            ("time_function[a[0]].segment.h1",
                             "a table whose name has brackets is given by its number")):
            with self.assertRaisesRegex(ValueError, wanted):
                by_number(key, content)
        for command in (("sweep", self.scene, "check"), ("probability", self.scene, "--samples", 10, "--engine",
                                                         "serial")):
            self.call(*command, "--vary", "time_function[turning].segment.h1=60 rpm,80 rpm", "-o",
                      self.folder / command[0])
            said = self.call(*command, "--vary", "time_function[turn].segment.h1=60 rpm,80 rpm", status=2)
            self.assertIn("did you mean turning?", said)
        saved = scene.load(self.folder / "probability" / "00002" / "scene.toml")
        segments = [arguments for name, arguments in saved.model.calls if name == "add_time_function"][1]
        self.assertAlmostEqual(segments[0]["h1"], 80.0 * math.pi / 30.0, 12)
        said = self.call("probability", self.scene, "--vary", "time_function[turning].segment.h1=60 rpm", "--vary",
                         "time_function[1].segment.h1=70 rpm", status=2)
        self.assertIn("each key once", said)
        rock = '''[[variability.scatter]]
name = "speed"
key = "time_function[turning].segment.h1"
distribution = "uniform"
low = "60 rpm"
high = "90 rpm"
'''
        made = scene.loads(self.SCENE + rock)
        self.assertEqual(made.variability.scatters[-1].keys, ["time_function[1].segment.h1"])
        self.assertTrue(made.same_as(scene.loads(scene.saves(made))))
        with self.assertRaisesRegex(scene.SceneError, "no .*time_function.* is named turn; did you mean turning"):
            scene.loads(self.SCENE + rock.replace("[turning]", "[turn]"))
        (self.folder / "more.toml").write_text(self.SCENE + rock, encoding="utf-8")
        said = self.call("probability", self.folder / "more.toml", "--vary", "time_function[turning].segment.h1=60 rpm",
                         status=2)
        self.assertIn("each sample has a value of its own, of speed", said)

    def test_names_that_look_like_something_else(self):
        """Names with = and & in brackets are one key; a number that is the name of another table, and a name that two
        have, are refused."""
        self.assertEqual(varied("time_function[a=b & c].segment.h1=1,2"), ("time_function[a=b & c].segment.h1", [1, 2]))
        self.assertEqual(settings_of({"f[a & b].h & g": "1 & 2"}), {"f[a & b].h": 1, "g": 2})
        content = {"f": [{"name": "1"}, {"name": "a.b"}, {"name": "é"}, {"name": "3"}, {"name": "twice"},
                         {"name": "twice"}]}
        for key, number in (("f[a.b].x", "f[1].x"), ("f[é].x", "f[2].x"), ("f[3].x", "f[3].x"), ("f[0].x", "f[0].x"),
                            ("f[9].x", "f[9].x")):
            self.assertEqual(by_number(key, content, typed=True), number)
        self.assertEqual(by_number("failure[stress].limit", {"failure": [{"kind": "stress", "name": "x"},
                                                                         {"kind": "stress"}]}), "failure[1].limit")
        self.assertEqual(by_number("f[1].x", content), "f[1].x")  # as the package itself writes it
        with self.assertRaisesRegex(ValueError,
                                    r"\[1\] is the number of a table, and f\[0\] is named 1; give that table a name "
                                    r"that is not a number"):
            by_number("f[1].x", content, typed=True)
        with self.assertRaisesRegex(ValueError, r"2 tables .*f.* are named twice; write the number, as f\[4\]"):
            by_number("f[twice].x", content)
        (self.folder / "one.toml").write_text(self.SCENE.replace('"feeding"', '"1"'), encoding="utf-8")
        for command in (("sweep", self.folder / "one.toml", "check"), ("probability", self.folder / "one.toml",
                                                                       "--samples", 10, "--engine", "serial")):
            self.assertIn("is named 1", self.call(*command, "--vary", "time_function[1].segment.h1=60 rpm,80 rpm",
                                                  status=2))
        speed = ('[[variability.scatter]]\nkey = "time_function[1].segment.h1"\ndistribution = "uniform"\nlow = "60 '
                 'rpm"\nhigh = "90 rpm"\n')
        named = self.SCENE.replace('name = "feeding"', 'name = "1"').replace('time_function = "feeding"',
                                                                             'time_function = "1"')
        self.assertIn("is named 1; give that table", str(scene.loads(named + speed).remarks[0]))
        self.assertEqual(scene.loads(self.SCENE + speed).remarks, scene.loads(self.SCENE).remarks)

    def test_map(self):
        """One value for both keys, and one each."""
        keys = "hole.mu_static & hole.mu_dynamic"
        for command in (("sweep", self.scene, "check"), ("probability", self.scene, "--samples", 20, "--engine",
                                                         "serial")):
            self.call(*command, "--vary", f"{keys}=0.2,0.4 & 0.25", "-o", self.folder / command[0])
        with open(self.folder / "sweep" / "sweep.csv", encoding="utf-8", newline="") as file:
            self.assertEqual([row[keys] for row in csv.DictReader(file)], ["0.2", "0.4 & 0.25"])
        saved = scene.load(self.folder / "probability" / "00002" / "scene.toml")
        wall = next(arguments[0] for name, arguments in saved.model.calls if name == "add_wall")
        self.assertEqual((wall["mu_static"], wall["mu_dynamic"]), (0.4, 0.25))
        said = self.call("probability", self.scene, "--vary", f"{keys}=0.2", "--vary", "hole.mu_static=0.3", status=2)
        self.assertIn("each key once", said)

    def test_a_map_of_the_question_auto(self):
        """The runs of a cell are those of samples near its limits, others in each cell: pairs of them would be no
        test."""
        cells = [Cell({"a": value}, failing={0: value > 1}, dimension=2, estimates={"any failure": None})
                 for value in (1, 2)]
        made = Map.__new__(Map)
        made.vary, made.cells, made.output = [("a", [1, 2])], cells, unittest.mock.Mock(summary={})
        for question, tables in (("run", 1), ("auto", 0)):
            made.question = question
            made.output.reset_mock()
            made._pairs()
            self.assertEqual((made.output.table.call_count, made.output.note_text.call_count), (tables, 1 - tables))
            self.assertEqual(made._against(*cells)[:2], [1, 0] if tables else ["", ""])

    def test_pairs(self):
        """Exact McNemar test of the samples that decide differently; lost samples do not count."""
        def cell(failing, **more):
            return Cell({}, failing=dict(enumerate(failing)), dimension=2, **more)
        a, b = cell([False] * 20), cell([True] * 8 + [False] * 12)
        found = paired(a, b)
        self.assertEqual((found.samples, found.more, found.fewer, found.word), (20, 8, 0, "the probability rises"))
        self.assertAlmostEqual(found.chance, 2.0 / 2 ** 8, 12)
        self.assertEqual(paired(b, a).word, "the probability falls")
        self.assertEqual(paired(a, cell([True] * 5 + [False] * 15)).word, "a difference is not shown")
        self.assertEqual(paired(a, a).word, "no sample differs")
        self.assertEqual(paired(a, cell([])).word, "not assessed, because no sample has all margins in both")
        self.assertEqual(paired(a, cell([])).words, paired(a, cell([])).word)
        self.assertEqual(paired(a, b).words, "+0.4: the probability rises (exact McNemar test, p = 0.0078)")
        self.assertEqual(paired(a, cell([True] * 8)).samples, 8)
        self.assertIsNone(paired(a, cell([True], message="failed")))
        self.assertIsNone(paired(a, Cell({}, failing={0: True}, dimension=3)))


if __name__ == "__main__":
    unittest.main()
