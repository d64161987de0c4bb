"""Muds with a yield stress in scene files and readings of a viscometer; pressures by depth of the command
torque-drag."""
import json
import math
import unittest

from shared_tests import FolderTest, needs

needs("drillmbd")

from drillmbd import scene  # noqa: E402
from drillmbd.scene import viscometer  # noqa: E402

WELL = """
[environment]
fluid_density = "1250 kg/m3"
flow_rate = "1200 l/min"
viscometer = {600 = 65, 300 = 42, 200 = 33, 100 = 24, 6 = 9, 3 = 8}
nozzle_area = "300 mm2"
[hole]
diameter = "216 mm"
survey = [["0 m", "0 deg", "0 deg"], ["200 m", "30 deg", "0 deg"]]
[[string]]
name = "string"
[[string.pipes]]
count = 20
length = "9 m"
pipe = "5 in 19.50 S135"
"""


class ViscometerTest(unittest.TestCase):
    def test_exact_readings_give_their_mud(self):
        for yield_stress, consistency, exponent in ((4.0, 0.6, 0.7), (0.0, 0.6, 0.55), (9.0, 0.02, 1.0),
                                                    (2.0, 3.0, 0.25)):
            readings = [(speed, (yield_stress + consistency * (1.703 * speed) ** exponent) / 0.511)
                        for speed in (600.0, 300.0, 200.0, 100.0, 6.0, 3.0)]
            found = viscometer.fit(readings)
            self.assertAlmostEqual(found.yield_stress, yield_stress, delta=1e-5)
            self.assertAlmostEqual(found.consistency, consistency, delta=1e-5)
            self.assertAlmostEqual(found.flow_exponent, exponent, delta=1e-6)
            self.assertLess(found.misfit, 1e-6)

    def test_two_speeds_are_plastic_viscosity_and_yield_point(self):
        """PV = R600 - R300 in cP, YP = R300 - PV in lbf/100 ft2 (API RP 13B-1), by rounded constants."""
        found = viscometer.fit([(600.0, 52.0), (300.0, 34.0)])
        self.assertEqual(found.flow_exponent, 1.0)
        self.assertAlmostEqual(found.consistency / 1e-3, 18.0, delta=0.02)
        # the spring has 1.067 lbf/100 ft2 a degree
        self.assertAlmostEqual(found.yield_stress / (4.4482216 / 9.290304), 16.0, delta=1.1)

    def test_no_yield_stress_below_zero(self):
        found = viscometer.fit([(600.0, 60.0), (300.0, 29.0), (3.0, 0.1)])
        self.assertEqual(found.yield_stress, 0.0)

    def test_refused_readings(self):
        for readings, words in (("{600 = 65}", "two speeds"), ("{600 = 60, 300 = 65}", "must be more than"),
                                ("5", "table of readings"),
                                ("{a = 3, 300 = 2}", "table of readings"),
                                ('{600 = "65", 300 = 40}', "table of readings"),
                                ("{300 = 3, 0 = 2}", "speeds > 0")):
            with self.assertRaises(scene.SceneError) as refused:
                scene.loads(WELL.replace("{600 = 65, 300 = 42, 200 = 33, 100 = 24, 6 = 9, 3 = 8}", readings))
            self.assertIn(words, str(refused.exception))
            self.assertNotIn("consistency = 0", str(refused.exception))
        with self.assertRaisesRegex(scene.SceneError, "must be left out with viscometer"):
            scene.loads(WELL.replace("nozzle_area", 'yield_stress = "3 Pa"\nnozzle_area'))
        with self.assertRaisesRegex(scene.SceneError, "yield_stress"):
            scene.loads(WELL.replace("nozzle_area", "flow_eccentricity = 0.5\nnozzle_area"))

    def test_saved_scene_has_the_constants(self):
        loaded = scene.loads(WELL)
        found = viscometer.fit([(600.0, 65.0), (300.0, 42.0), (200.0, 33.0), (100.0, 24.0), (6.0, 9.0), (3.0, 8.0)])
        with loaded.new_sim() as sim, scene.loads(WELL.replace(
                "viscometer = {600 = 65, 300 = 42, 200 = 33, 100 = 24, 6 = 9, 3 = 8}",
                f'consistency = "{found.consistency!r} Pa s"\nflow_exponent = {found.flow_exponent!r}\n'
                f'yield_stress = "{found.yield_stress!r} Pa"')).new_sim() as other:
            self.assertEqual(sim.hydraulics(150.0, 0.2), other.hydraulics(150.0, 0.2))
            self.assertGreater(sim.hydraulics(150.0).annulus_loss, 0.0)


class HydraulicsTest(FolderTest):
    def command(self, text):
        self.write("well.toml", text)
        said = self.call("torque-drag", str(self.folder / "well.toml"), "--output", str(self.folder / "out"),
                         "--depths", "90 m,180 m")
        return said, json.loads((self.folder / "out" / "summary.json").read_text()), self.folder / "out"

    def test_table_and_sentence(self):
        said, summary, folder = self.command(WELL)
        with scene.loads(WELL).new_sim() as sim:
            found = summary["hydraulics"]["string"]
            self.assertEqual(found["depth_m"], [90.0, 180.0])
            for number, depth in enumerate((90.0, 180.0)):
                one = sim.hydraulics(depth, found["trip_speed_m_s"])
                self.assertEqual(found["circulating_density_kg_m3"][number], one.circulating_density)
                self.assertEqual(found["surge_density_kg_m3"][number], one.surge_density)
                self.assertAlmostEqual(one.circulating_density - 1250.0, one.annulus_loss / (9.81 * one.vertical_depth),
                                       delta=1e-9)
                self.assertLess(one.swab_density, 1250.0)
        self.assertIn("equivalent circulating density", said)
        self.assertTrue((folder / "hydraulics_string.csv").exists())

    def test_rising_hole_has_no_equivalent_density(self):
        said, summary, _ = self.command(WELL.replace('"0 deg", "0 deg"]',
                                                     '"95 deg", "0 deg"]').replace('"30 deg", "0 deg"]',
                                                                                   '"95 deg", "0 deg"]'))
        self.assertIn("not assessed, because the bit is not below the collar", said)
        self.assertEqual(summary["hydraulics"]["string"]["circulating_density_kg_m3"], [None, None])

    def test_mud_at_rest_has_no_table(self):
        said, summary, folder = self.command(WELL.replace('flow_rate = "1200 l/min"\n', ""))
        self.assertNotIn("circulating", said)
        self.assertNotIn("hydraulics", summary)
        self.assertFalse((folder / "hydraulics_string.csv").exists())
        self.assertTrue(math.isfinite(summary["torque_drag"]["string"]["rotate"]["hook_load_N"]))


if __name__ == "__main__":
    unittest.main()
