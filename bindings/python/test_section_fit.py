"""Friction coefficients by section of the hole from measurements at several depths: recovered from computed loads, with
noise within the confidence, and the reasons where they are not determined."""
import json
import random
import unittest

from shared_tests import FolderTest, needs

needs("numpy", "scipy.stats", "drillmbd")

from drillmbd import enums, scene, section_fit  # noqa: E402

WELL = """
[environment]
fluid_density = "1250 kg/m3"
[hole]
diameter = "216 mm"
mu_static = 0.2
mu_dynamic = 0.2
survey = [["0 m", "0 deg", "0 deg"], ["400 m", "0 deg", "0 deg"], ["1000 m", "60 deg", "30 deg"],
          ["2000 m", "60 deg", "30 deg"]]
[[hole.section]]
depth = "4000 ft"
name = "open hole"
mu_static = 0.35
mu_dynamic = 0.35
[[string]]
name = "string"
[[string.pipes]]
count = 220
length = "9 m"
pipe = "5 in 19.50 S135"
"""
GUESS = WELL.replace("0.35", "0.25")
DEPTHS = [500.0 + 100.0 * one for one in range(15)]


def loads(depths):
    """[N, N m] Pick-up, slack-off and torque while rotating."""
    loaded = scene.loads(WELL)
    with loaded.new_sim() as sim:
        rows = sim.torque_drag([enums.OPERATION_PICK_UP, enums.OPERATION_SLACK_OFF, enums.OPERATION_ROTATE],
                               depths).rows
    return [(row[0].hook_load, row[1].hook_load, row[2].torque) for row in rows]


class SectionFitTest(FolderTest):
    def by_section(self, depths, noise=0.0, text=GUESS):
        draw = random.Random(7)
        rows = [[depth, *(value / 1e3 * (1.0 + noise * draw.gauss(0.0, 1.0)) for value in values)]
                for depth, values in zip(depths, loads(depths))]
        log = self.write("log.csv", "\n".join(["depth [m],pick_up [kN],slack_off [kN],torque [kN m]",
                                               *(",".join(map(repr, row)) for row in rows)]))
        said = self.call("torque-drag", self.write("well.toml", text), "--measured", log, "--output",
                         self.folder / "out")
        return (said, json.loads((self.folder / "out" / "summary.json").read_text()).get("measured_by_section",
                                                                                         {}).get("string", {}))

    def test_computed_loads_give_their_friction(self):
        said, found = self.by_section(DEPTHS)
        for word in ("pick-up", "slack-off", "torque"):
            cased, open_hole = found[word]["sections"]
            self.assertAlmostEqual(cased["friction"], 0.2, delta=1e-6)
            self.assertAlmostEqual(open_hole["friction"], 0.35, delta=1e-6)
            self.assertAlmostEqual(open_hole["from_m"], 1219.2, delta=1e-6)
        self.assertIn("open hole from 1219 m friction 0.35", said)

    def test_noise_lies_within_the_confidence(self):
        _, found = self.by_section(DEPTHS, noise=0.01)
        for word in ("pick-up", "slack-off", "torque"):
            for section, right in zip(found[word]["sections"], (0.2, 0.35)):
                self.assertGreater(section["half_width_95"], 0.0)
                self.assertLess(abs(section["friction"] - right), 1.5 * section["half_width_95"])

    def test_not_determined(self):
        _, found = self.by_section([1900.0] * 4)
        self.assertIn("do not separate", found["pick-up"]["reason"])
        self.assertIsNone(found["pick-up"]["sections"][0]["friction"])
        (self.folder / "out" / "summary.json").unlink()

    def test_best_coefficients_out_of_range(self):
        """Loads below those without friction, or beyond those of the largest coefficient, explain no coefficient."""
        def at(friction):
            return [100.0 + friction[0] * (1.0 + x) + friction[1] * x * x for x in range(6)]
        for right, outside in (((0.3, 0.2), False), ((-0.1, 0.2), True), ((0.3, -0.05), True), ((11.0, 0.2), True)):
            found = section_fit.fit(at, at(right), [0.3, 0.3])
            self.assertEqual("examine the block weight" in found.reason, outside)
            self.assertEqual(bool(found.half_widths), not outside)

    def test_few_measurements(self):
        _, found = self.by_section([900.0, 1900.0])
        self.assertIn("2 measurements are not more than 2 coefficients", found["pick-up"]["reason"])

    def test_one_section_has_the_one_fit(self):
        for text, depths in ((GUESS, [600.0, 800.0, 1000.0]),
                             (GUESS[:GUESS.index("[[hole.section]]")] + GUESS[GUESS.index("[[string]]"):], DEPTHS)):
            with self.subTest(depths=depths):
                self.assertEqual(self.by_section(depths, text=text)[1], {})
                for path in (self.folder / "out").iterdir():
                    path.unlink()

    def test_values_in_lines_have_no_sections(self):
        self.assertEqual(section_fit.sections_of('[hole]\nmu_dynamic = 0.3\n[[hole.section]]\ndepth = "1 m"\nshape = '
                                                 '"line"\n'), [])


if __name__ == "__main__":
    unittest.main()
