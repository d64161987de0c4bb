"""Tests of verdicts that would be all-clears: failures that no sample can show are refused, demands that nothing acts
on are named."""
import unittest

from shared_tests import FolderTest, needs

needs("h5py", "matplotlib", "numpy", "scipy")

from test_study_analyses import LEVEL, failure

TURNING = LEVEL.replace('question = "torque-drag"', 'look = "10 ms"').replace('end = "2 s"', 'end = "50 ms"')
SURVEY = """[[variability.field]]
name = "survey"
key = "hole.survey.inclination"
distribution = "normal"
mean = 0
deviation = "0.5 deg"
correlation_length = "10 m"
"""
FEW = ("--samples", 4, "--engine", "serial")


class AssessedTest(FolderTest):
    SCENE = LEVEL

    def words_of(self, text, status, *more):
        return self.call("probability", self.write("scene.toml", text), *FEW, *more, status=status)

    def still(self, text):
        """The scene with a string that is not turned."""
        name = text.index('name = "turning"')
        end = text.index("[[", name)
        return text[:name] + 'name = "turning"\nunit = "rad/s"\nsegment = {h0 = 0}\n' + text[end:]

    def test_a_string_that_does_not_turn(self):
        for kind, more in (("stick-slip", {}), ("bit-stuck", {"limit": "1 s"})):
            out = self.words_of(self.still(TURNING) + failure(kind, **more), 2)
            self.assertIn("not assessed, because no drive of rotation turns", out)
            self.words_of(TURNING + failure(kind, **more), 0)

    def test_a_string_without_a_drive_of_rotation(self):
        """Its bit does not turn at all, which is no smooth rotation."""
        text = TURNING[:TURNING.index('[[drive]]\nname = "head"')] + TURNING[TURNING.index("[run]"):]
        text = text.replace('name = "turning"', 'name = "turning"\nunit = "rad/s"')
        self.assertIn("not assessed, because no drive of rotation turns",
                      self.words_of(text + failure("stick-slip"), 2))

    def test_torque_of_rotation(self):
        text = failure("rig-torque", limit="1 kN m")
        self.assertIn("torque of rotation is not assessed", self.words_of(self.still(TURNING) + text, 0))
        self.assertNotIn("torque of rotation is not assessed", self.words_of(TURNING + text, 0))

    def test_a_string_that_is_not_pulled(self):
        """A run that only pushes says nothing about pulling out."""
        text = failure("rig-pull", limit="3 kN")
        self.assertIn("not assessed, because the rig never pulls", self.words_of(TURNING + text, 0))
        self.assertNotIn("not assessed, because the rig never", self.words_of(LEVEL + text, 0))

    def test_a_bit_without_load(self):
        free = LEVEL.replace('"8 kN"', '"0 kN"')
        self.assertNotEqual(free, LEVEL)
        self.assertIn("not assessed, because the scene gives the bit no load",
                      self.words_of(free + failure("lock-up"), 2))
        self.words_of(LEVEL + failure("lock-up"), 0)

    def test_a_course_that_does_not_vary(self):
        self.assertIn("nothing that varies changes the course",
                      self.words_of(LEVEL + failure("leaves-seam", limit="1 m"), 2))
        self.words_of(LEVEL + SURVEY + failure("leaves-seam", limit="1 m"), 0)

    def test_maps(self):
        """A cell that is not assessed says so, and the map has status 1."""
        out = self.words_of(TURNING + failure("stick-slip"), 1, "--vary", "time_function[1].segment.h0=0,10")
        self.assertNotIn("Traceback", out)
        for key in ("seed", "samples", "question"):
            self.assertIn("is a setting of the study", self.words_of(LEVEL + failure("rig-push", limit="9 kN"), 2,
                                                                     "--vary", f"variability.{key}=1,2"))

    def test_keys_that_samples_write(self):
        """A value of --vary that each sample replaces by its own."""
        text = LEVEL + failure("rig-push", limit="9 kN")
        self.assertIn("each sample has a value of its own, of friction",
                      self.words_of(text, 2, "--vary", "hole.mu_dynamic=0.1,0.2"))
        self.assertIn("each sample has a value of its own",
                      self.words_of(text, 2, "--vary", "hole.diameter & hole[0].mu_static=0.1,0.2"))
        self.words_of(text, 0, "--vary", "variability.scatter[0].mean=0.2,0.3")
        factor = text.replace("mean = 0.3\ndeviation = 0.03", "relative = true\nmean = 1\ndeviation = 0.1")
        self.assertNotEqual(factor, text)
        self.words_of(factor, 0, "--vary", "hole.mu_static & hole.mu_dynamic=0.1,0.2")

    def test_a_map_that_is_flat(self):
        """Torque and drag do not depend on the rotary speed: a note says so, and that dynamics are left out."""
        text = LEVEL + failure("rig-push", limit="9.5 kN")
        out = self.words_of(text, 0, "--vary", "time_function[1].segment.h1=60 rpm,120 rpm", "--vary",
                            "variability.scatter.mean=0.2,0.3")
        self.assertIn("time_function[1].segment.h1 changes no percentile", out)
        self.assertIn("leaves out dynamics", out)
        out = self.words_of(text, 0, "--vary", "failure.limit=9 kN,9.5 kN")
        self.assertNotIn("changes no percentile", out)

    def test_demands_that_nothing_acts_on(self):
        text = LEVEL + failure("rig-push", limit="9 kN")
        mud = text.replace('keys = ["hole.mu_static", "hole.mu_dynamic"]\ndistribution = "normal"\nmean = '
                           '0.3\ndeviation = 0.03',
                           'key = "hole.restitution"\ndistribution = "uniform"\nlow = 0.3\nhigh = 0.4')
        self.assertNotEqual(mud, text)
        self.assertIn("nothing that varies acts on it", self.words_of(mud, 0))
        self.assertNotIn("nothing that varies acts on it", self.words_of(text, 0))
        limits = mud + """[[variability.scatter]]
name = "push of the rig"
key = "failure[0].limit"
distribution = "normal"
mean = "9.5 kN"
deviation = "0.1 kN"
"""
        said = self.words_of(limits, 0)
        self.assertIn("its probability is that of its limit", said)
        self.assertNotIn("scene as it is written", said)
        self.assertNotIn("changes no percentile",
                         self.words_of(limits, 0, "--vary", "variability.scatter[1].mean=9 kN,9.5 kN"))

    def test_nonsense(self):
        text = LEVEL + failure("rig-push", limit="9 kN")
        for words, wanted in ((("--samples", 10 ** 12), "must be <= 10000000"),
                              (("--surrogate", "--method", "subset"), "--surrogate is fitted"),
                            (("--surrogate", "--indices", 8), "--surrogate is fitted")):
            self.assertIn(wanted, self.words_of(text, 2, *words))


if __name__ == "__main__":
    unittest.main()
