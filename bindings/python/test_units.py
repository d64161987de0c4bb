"""Tests of quantities as people write them: spellings of the trade with their values, what is refused and how, what is
assumed of a mass or a bare diameter, and that one refused value causes one message."""
import math
import unittest

from drillmbd import scene
from drillmbd.scene import units

LBF, FT, INCH, GALLON, BARREL, G = 4.4482216152605, 0.3048, 0.0254, 0.003785411784, 0.158987294928, 9.80665
RPM, DEG, PSI = math.pi / 30, math.pi / 180, 4.4482216152605 / 0.0254 ** 2

# Unit wanted: {value in SI: spellings}
SPELLINGS = {
    "m": {8.5 * INCH: ["8.5 in", "8.5 inch", "8.5 inches", '8.5"', "8 1/2 in", "8-1/2 in", "8.5in", "8½ in", '8½"',
                       "8.5 IN", "8.5″"],
          30 * FT: ["30 ft", "30'", "30 feet", "30 FT", "30 ft.", "30′", "29'12\""], 98.4 * FT: ["98,4 ft"],
          1000.0: ["1 000 m", "1000 M", "1 km"],
          300.0: ["0.3 km", "300 metres", "300 米"], 0.9144: ["1 yd"], 3.5 * INCH: ["3.5 in.", "3 1/2 英寸"],
          9.625 * INCH: ["9 5/8 in", "9-5/8\""],
          0.073: ["73 MM", "73 ㎜", "73 毫米", "73 mm", "φ73 mm", "phi 73", "Φ73", "Ø 73 mm", "⌀73", "7.3 cm", "73,0 mm"],
          1234.5: ["1,234.5 m", "1.234,5 m", "1 234,5 m"], 0.125: ["0,125 m"], 1e6: ["1,000,000 m", "1e6 m"]},
    "N": {20e3: ["20 kN", "20 KN", "20 千牛", "2000 daN", "0.02 MN"], 2e5: ["20 kdaN"],
          2e4 * LBF: ["20 klbf", "20 klb", "20 kips", "20 kip", "20000 lbf", "20000 lbs", "20000 lb", "20 klbs",
                      "20 kilolbf", "20 KLBF", "20000 #"],
          5e3 * G: ["5 t", "5 tf", "5 tonne", "5 metric tons", "5 吨", "5000 kg"], 5 * G: ["5 kgf", "5 kp"],
          50.0: ["5 daN"]},
    "N m": {3e3: ["3 kN m", "3 kN.m", "3 kN·m", "3 kN*m", "3 kN-m", "3 kNm", "3000 Nm", "3000 N·m", "3 KN.m", "3 KNM",
                  "3000 牛·米", "3 千牛·米"],
            10 * FT * LBF: ["10 ft lbf", "10 ft-lbf", "10 ft-lb", "10 ft.lbf", "10 lbf ft", "10 lbf-ft", "10 lb-ft",
                            "10 ft*lbf", "10 ft·lbf",
                            "10 ftlbf", "10 ft-lbs", "10 FT-LB"],
            1e4 * FT * LBF: ["10 kft-lbf", "10 kft lbf", "10 kft.lbf", "10 kft-lb", "10 klbf-ft", "10 klbf ft",
                             "10 kilofoot pound", "10 kft-lbs"],
            50.0: ["5 daN m"], 5 * G: ["5 kgf m", "5 kgf·m", "5 kg·m"], 10 * INCH * LBF: ["10 in-lbf", "10 in lbs"]},
    "kg/m3": {10 * 0.45359237 / GALLON: ["10 ppg", "10 lb/gal", "10 lbm/gal", "10 lbs/gal", "10 lb/USgal", "10 PPG",
                                         "10 lb/US gal"],
              1200.0: ["1.2 sg", "1.2 SG", "1.2 s.g.", "1.2 g/cm3", "1.2 g/cc", "1.2 g/cm^3", "1200 kg/m3",
                       "1200 kg/m^3", "1200 kg/m³", "1.2 kg/L",
                       "1.2 kg/l", "1.2 t/m3"],
              75 * 0.45359237 / FT ** 3: ["75 lb/ft3", "75 pcf"], 0.5 * PSI / FT / G: ["0.5 psi/ft"]},
    "kg/m": {13.3 * 0.45359237 / FT: ["13.3 lb/ft", "13.3 lbm/ft", "13.3 lbs/ft", "13.3 ppf", "13.3 #/ft",
                                      "13.3 lbf/ft"], 19.8: ["19.8 kg/m"]},
    "Pa": {75e3 * PSI: ["75000 psi", "75 ksi", "75 KSI", "75 kpsi"], 5e8: ["500 MPa", "500 Mpa", "500 MPA", "500 N/mm2",
                                                                           "500 N/mm^2", "500 兆帕"],
           3e3 * PSI: ["3000 psi"], 2.1e11: ["210 GPa"], 3e7 * PSI: ["30e6 psi", "30 Mpsi"], 2e6: ["20 bar"],
           2e5 * G: ["20 kgf/cm2", "20 kgf/cm^2", "20 kg/cm2"], 500.0: ["0.5 kPa"], 133.322387415: ["1 mmHg"],
           15 * LBF / 100 / FT ** 2: ["15 lbf/100 ft2", "15 lb/100ft²"]},
    "rad/s": {120 * RPM: ["120 rpm", "120 RPM", "120 r/min", "120 rev/min", "120 1/min", "120 min-1", "120 U/min",
                          "120 min^-1", "2 rev/s", "2 rps",
                          "720 deg/s", "120 rev per minute", "120 turns/min", "120 об/мин", "120 转/分", "120 r.p.m."],
              12.0: ["12 rad/s"]},
    "m3/s": {500 * GALLON / 60: ["500 gpm", "500 gal/min", "500 GPM", "500 USgpm", "500 US gal/min"],
             0.025: ["1500 l/min", "1500 L/min", "1500 lpm", "1500 LPM", "1.5 m3/min", "1.5 m^3/min", "25 l/s",
                     "90 m3/h", "90 m³/h"],
             10 * BARREL / 60: ["10 bbl/min", "10 bpm"]},
    "m/s": {60 * FT / 3600: ["60 ft/hr", "60 ft/h", "60 ft/hour", "60 fph"], 20 / 3600: ["20 m/h", "20 m/hr"],
            0.01: ["10 mm/s"], 0.5 / 60: ["0.5 m/min"],
            30 * FT / 60: ["30 ft/min", "30 fpm"]},
    "rad": {45 * DEG: ["45 deg", "45°", "45 degrees", "45 DEG", "45 °", "45 degree", "45 º", "50 gon", "45 度"],
            0.5: ["0.5 rad"], 12.5 * DEG: ["12°30'"],
            12.51 * DEG: ["12°30'36\""]},
    "kg": {5.0: ["5 kg", "5 KG", "5 公斤", "5000 g"], 11 * 0.45359237: ["11 lb", "11 lbs", "11 lbm"],
           5e3: ["5 t", "5 tonnes"]},
    "s": {5.0: ["5 s", "5 sec", "5 S", "5000 ms"], 300.0: ["5 min", "5 minutes"], 5e-3: ["5 ms"],
          3600.0: ["1 hr", "1 h"]},
    "N/m2": {1e7: ["1e7 N/m^2", "10 MPa", "1e7 N/m2"]},
    "rad/m": {3 * DEG / 30: ["3 deg/30m", "3 deg/30 m", "3°/30m", "3 deg/(30 m)", "1 deg/10 m"],
              3 * DEG / 100 / FT: ["3 deg/100ft", "3 deg/100 ft"]},
    "Pa s": {0.012: ["12 cP", "12 mPa s", "0.012 Pa.s"]}}

# Text, unit wanted, parts of the message.
REFUSED = (("1,000 m", "m", ("1000 m", "1.000 m")), ("7,000 lb", "N", ("7000 lb", "7.000 lb")),
           ("5 ton", "N", ("tonne", "short ton", "long ton")), ("3 tons", "kg", ("tonne", "short ton", "long ton")),
           ("5 tonf", "N", ("tonne", "short ton", "long ton")), ("2 Hz", "rad/s", ("rpm",)),
           ("5 1/s", "rad/s", ("rpm",)),
           ("45", "rad", ("has no unit", "90 deg")), ("5 mn", "N", ("MN", "mN")), ("500 mpa", "Pa", ("MPa", "mPa")),
           ("20 klbff", "N", ("did you mean klbf", "kN")), ("120 rmp", "rad/s", ("did you mean", "rpm")),
           ("5 xyz", "N", ("N, kN, daN",)),
           ("5 Nm", "N", ("a force",)), ("10 m 5", "m", ("not a known unit",)), ("1 2 m", "m", ("not a known unit",)),
           ("1.2.3 m", "m", ("decimal points",)), ("1,5,3 m", "m", ("commas",)), ("phi 73", "N", ("a diameter",)),
           ("5 t", "m", ("a length",)),
           ("ninety", "rad", ("an angle",)), ("1,000", "-", ("1000", "1.000")))

WRONG_TWICE = """[hole]
diameter = "210 mm"
[[string]]
[[string.pipes]]
outer_diameter = "5 zoll"
inner_diameter = "4.276 in"
restitution = 3
"""


class UnitsTest(unittest.TestCase):
    def test_spellings(self):
        for wanted, values in SPELLINGS.items():
            for value, texts in values.items():
                for text in texts:
                    self.assertAlmostEqual(units.parse(text, wanted) / value, 1.0, 13, f"{text} as {wanted}")

    def test_refused(self):
        for text, wanted, parts in REFUSED:
            with self.assertRaises(units.UnitError, msg=text) as caught:
                units.parse(text, wanted)
            for part in parts:
                self.assertIn(part, str(caught.exception), text)

    def test_weight_of_a_mass(self):
        """A mass in the place of a force is its weight, and the other way round; never where both would be something
        else."""
        for text, wanted in (("20 klb", "N"), ("5 t", "N"), ("10 ft-lb", "N m"), ("1 kg/cm2", "Pa"),
                             ("120 lb/in", "N/m")):
            self.assertIn("its weight", units.remark(text, wanted), text)
        for text, wanted in (("13.3 lbf/ft", "kg/m"), ("0.5 psi/ft", "kg/m3")):
            self.assertIn("the mass of that weight", units.remark(text, wanted), text)
        for text, wanted in (("20 klbf", "N"), ("10 ft-lbf", "N m"), ("13.3 lb/ft", "kg/m"), ("5 kg", "kg")):
            self.assertEqual(units.remark(text, wanted), "", text)
        self.assertEqual(units.remark("phi 73", "m"), "is taken as 73 mm")
        for text, wanted in (("5 m/s2", "-"), ("5 kg", "m"), ("5 kg/s", "N"), ("5", "m/s2")):
            with self.assertRaises(units.UnitError, msg=text):
                units.parse(text, wanted)

    def test_one_refused_value_is_one_message(self):
        with self.assertRaises(scene.SceneError) as caught:
            scene.loads(WRONG_TWICE)
        self.assertEqual([one.key for one in caught.exception.problems],
                         ["string[0].pipes[0].outer_diameter", "string[0].pipes[0].restitution"])

    def test_remarks_of_a_scene(self):
        text = '\ufeff[hole]\ndiameter = "phi 94"\n[[string]]\n[[string.pipes]]\ncount = 3\n[limits]\npull = "5 t"\n'
        with self.assertRaises(scene.SceneError):
            scene.loads(text)  # a mark of byte order is taken off files only
        told = {one.key: (one.line, one.text) for one in scene.loads(text[1:]).remarks}
        self.assertEqual(told["hole.diameter"], (2, "is taken as 94 mm"))
        self.assertEqual(told["limits.pull"][0], 7)


if __name__ == "__main__":
    unittest.main()
