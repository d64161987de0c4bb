"""Tests of units of the output: the same numbers in SI, field and mine units by every command, in texts, tables,
pictures and the page of the report; no unit of another system beside them; refusals."""
import csv
import json
import math
import re
import unittest

from shared_tests import FolderTest, needs

needs("numpy", "matplotlib")

from drillmbd import results, scene, unit_systems  # noqa: E402
from drillmbd.outputs import output_numbers, output_unit  # noqa: E402
from drillmbd.profile import QUANTITIES, unit_of  # noqa: E402
from drillmbd.scene.units import factor_and_kind, fits  # noqa: E402
from drillmbd.unit_systems import TABLE, Units, UnknownUnit  # noqa: E402

SCENE = """title = "short rig"
[hole]
diameter = "94 mm"
dip = "-20 deg"
[[string]]
name = "main"
[[string.pipes]]
count = 6
length = "1.5 m"
eccentricity = "1 mm"
yield_strength = "500 MPa"
[[bit]]
name = "bit"
load = "8 kN"
diameter = "94 mm"
[[time_function]]
name = "turning"
segment = {kind = "step", x1 = "10 ms", h1 = "100 rpm"}
[[drive]]
name = "feed"
time_function = "0 m/s"
[[drive]]
name = "head"
component = "rx"
time_function = "turning"
[run]
end = "20 ms"
step = "1 ms"
static = true
[limits]
torque = "3 kN m"
push = "50 kN"
pull = "60 kN"
yield_stress = "500 MPa"
[[output]]
name = "torque"
quantity = "drive-force"
place = "head"
[[output]]
name = "speed [rad/s]"
quantity = "bit-speed"
place = "main"
[modes]
count = 3
[buckling]
scale = "all"
[fatigue]
curve_stress = "300 MPa"
slope = 5
[response]
frequency_low = "1 Hz"
frequency_high = "30 Hz"
points = 10
[[response.excitation]]
kind = "eccentricity"
[[response.output]]
name = "middle"
place = {part = "main", pipe = 3}
quantity = "vibration-z"
[speeds]
speed_low = "30 rpm"
speed_high = "300 rpm"
points = 10
[[speeds.order]]
order = 1
[[speeds.output]]
name = "middle"
place = {part = "main", pipe = 3}
quantity = "vibration-z"
limit = "0.01 um"
"""
COMMANDS = {"check": (), "static": (), "run": ("--verify",), "modes": (), "response": (), "speeds": (), "buckle": (),
            "report": (),
            "torque-drag": ("--depths", "4", "--frictions", "0.2,0.3", "--block-weight", "10 kN", "--measured",
                            "log.csv"),
            "stuck": ("--overpull", "20 kN", "--stretch", "0.05 mm")}
LOG = "depth [m],pick_up [kN],rotate [kN],torque [kN m]\n4,10.5,10.2,0.005\n9,11,10.4,0.01\n"
NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
HEAD = re.compile(r"\[([^\[\]]*)\]")
ONLY_SI = re.compile(r"\d (m|mm|m/s|mm/s|N|kN|N m|kN m|Pa|MPa|kg|rad|rad/s)(?![\w/^-])(?! m\b)")
ONLY_FIELD = re.compile(r"\d (ft|in(?! \d)|ft/h|lbf|klbf|ft-lbf|kft-lbf|psi|lbm)(?!\w)")


def ratio(unit, other):
    """One of the first unit in the other one, by the parser of scene files."""
    return 1.0 if unit == other else float(factor_and_kind(unit)[0] / factor_and_kind(other)[0])


class SystemTest(unittest.TestCase):
    def test_values(self):
        lbf, inch = 4.4482216152605, 0.0254
        for si, name, unit, value in (("m", "field", "ft", 1 / 0.3048), ("mm", "field", "in", 1 / 25.4),
                                      ("N", "field", "lbf", 1 / lbf),
                                      ("kN", "field", "klbf", 1 / lbf), ("N m", "field", "ft-lbf", 1 / (lbf * 0.3048)),
                                      ("Pa", "field", "psi", inch ** 2 / lbf),
                                      ("MPa", "field", "psi", 1e6 * inch ** 2 / lbf),
                                      ("kg/m", "field", "lb/ft", 0.3048 / 0.45359237),
                                      ("kg/m3", "field", "ppg", 0.003785411784 / 0.45359237),
                                      ("rad/s", "field", "rpm", 30 / math.pi), ("mm/s", "field", "ft/h", 3600 / 304.8),
                                      ("rad/m", "field", "deg/100 ft", 30.48 * 180 / math.pi),
                                      ("rad/m", "mine", "deg/30 m", 30 * 180 / math.pi),
                                      ("N", "mine", "kN", 1e-3), ("Pa", "mine", "MPa", 1e-6), ("mm", "mine", "mm", 1.0),
                                      ("N m", "mine", "N m", 1.0),
                                      ("m3/s", "field", "gpm", 60 / 0.003785411784),
                                      ("m3/s", "mine", "l/min", 60000.0)):
            self.assertEqual(Units(name).unit(si), unit)
            self.assertAlmostEqual(Units(name).factor(si) / value, 1.0, 12, (si, name))

    def test_every_unit_is_of_its_kind(self):
        for si, systems in TABLE.items():
            for unit in (one for system in systems for one in system if si not in ("", "%")):
                self.assertTrue(fits(unit, si), (unit, si))

    def test_all_quantities_of_the_library(self):
        """Units of outputs and profiles have an equivalent, but those that depend on the scene."""
        found = {unit_of(one) for one in QUANTITIES} | {part for one in output_numbers()
                                                        for part in output_unit(one).split(" or ")}
        self.assertEqual({one for one in found if one not in TABLE and not one.startswith("unit of the ")}, set())

    def test_si_changes_nothing(self):
        si = Units()
        self.assertEqual(si.text(12345.678, "kN"), "1.235e+04 kN")
        self.assertEqual(si.head("torque [kft lbf]"), "torque [kft lbf]")
        self.assertEqual(si.sentence("at 5 m"), "at 5 m")
        self.assertEqual((si.scaled(1500.0, "N"), si.scaled(2.5e6, "Pa", ".3g", "kMG")), ("1.5 kN", "2.5 MPa"))
        self.assertEqual(si.axis("N", [1500.0]), (1e-3, "kN"))

    def test_sentences(self):
        field = Units("field")
        for text, wanted in (("the string begins at 30.48 m.", "the string begins at 100 ft."),
                             ("3.048 .. 6.096 m", "10 .. 20 ft"),
                             ("-4448.22 N, 1.5 N m/rad", "-1000 lbf, 1.5 N m/rad"),
                             ("largest dogleg 3 deg/30 m", "largest dogleg 3.048 deg/100 ft"),
                             ("pipe 3 of main, 100 rpm, 8 elements", "pipe 3 of main, 100 rpm, 8 elements"),
                             ("73 x 6.35 mm", "2.874 x 0.25 in"),
                             ('load = "9 t": of 3.048 m', 'load = "9 t": of 10 ft')):  # as it is written
            self.assertEqual(field.sentence(text), wanted)

    def test_unknown_unit_is_refused(self):
        with self.assertRaisesRegex(UnknownUnit, "'N m s' has no equivalent in field units; give --units si"):
            Units("field").head("gain [N m s]")


class OutputTest(FolderTest):
    SCENE = SCENE

    def setUp(self):
        super().setUp()
        self.write("log.csv", LOG)
        self.figures = []
        plain = results.CommandOutput.picture

        def picture(output, name, draw):
            plain(output, name, lambda plots: self._seen(name, draw(plots)))
        results.CommandOutput.picture = picture
        self.addCleanup(setattr, results.CommandOutput, "picture", plain)

    def _seen(self, name, figure):
        self.figures.append((name, [(one.get_xlabel(), one.get_ylabel(),
                                     [line.get_xydata() for line in one.get_lines()]) for one in figure.axes]))
        return figure

    def results(self, command, system, *more):
        self.figures = []
        folder = self.folder / f"{command}-{system}"
        words = [str(self.folder / one) if one == "log.csv" else one for one in COMMANDS[command]]
        out = self.call(command, self.scene, "--output", folder, *words, *more)
        return out, folder, json.loads((folder / "summary.json").read_text(encoding="utf-8")), self.figures

    def compare(self, command):
        out, folder, summary, figures = self.results(command, "si")
        self.assertEqual(summary["units"], "si")
        for system in ("field", "mine"):
            other, place, found, drawn = self.results(command, system, "--units", system)
            self.assertEqual((found["units"], found["units_of_numbers"], found["files"]),
                             (system, "si", summary["files"]))
            self._same_numbers_in_summary(summary, found)
            self.compare_text(out, other, system)
            for name in (one for one in found["files"] if one.endswith(".csv") and command != "response"):
                self.compare_table(folder / name, place / name)
            self.compare_figures(figures, drawn)
        return summary["files"]

    def _same_numbers_in_summary(self, one, other):
        for key in set(one) - {"units", "notes", "warnings", "understood", "run", "verdicts", "elapsed_s"}:
            self.assertEqual(one[key], other[key], key)

    def compare_text(self, out, other, system):
        lines = [[line for line in text.splitlines() if "real time" not in line and "files in" not in line]
                 for text in (out, other)]
        self.assertEqual(len(lines[0]), len(lines[1]))
        self.assertIsNone((ONLY_SI if system == "field" else ONLY_FIELD).search("\n".join(lines[1])), other)
        for si, shown in zip(*lines):
            pairs = [self._numbers(one) for one in (si, shown)]
            self.assertEqual(len(pairs[0]), len(pairs[1]), (si, shown))
            for (value, unit), (seen, name) in zip(*pairs):
                wanted = value * ratio(unit, name)
                self.assertLessEqual(abs(seen - wanted), 6e-3 * abs(wanted) + 1e-9, (value, unit, seen, name, shown))

    @staticmethod
    def _numbers(line):
        """All numbers of a line with the unit behind them; of a range, that of its end; of a output, that before the
        colon."""
        line = re.sub(r"\b(30 m|100 ft)\b(?=,| between|$)", lambda one: one[0].replace(" ", "_"),
                      line) if "deg/" in line else line
        names = sorted({one for si, systems in TABLE.items() for one in (si, *systems[0], *systems[1])}
                       - {"", "-", "%"}, key=len, reverse=True)
        units = "|".join(re.escape(one).replace(r"\ ", "[ _]") for one in names)
        head = re.match(r"\s*[\w ]+ \[([^\]]*)\]:", line)
        found = []
        for one in NUMBER.finditer(line):
            unit = re.match(rf"(?:(?: \.\.| x)\s*[-+\d.e]+)? ({units})(?![\w/^-])(?! m\b)", line[one.end():])
            own = unit[1].replace("_",
                                  " ") if unit else head[1] if head and not line[one.end():].startswith(" %") else "-"
            found.append((float(one[0]), own))
        return found

    def compare_table(self, file, other):
        rows = [list(csv.reader(one.read_text(encoding="utf-8").splitlines())) for one in (file, other)]
        self.assertEqual(len(rows[0]), len(rows[1]))
        for number, heads in enumerate(zip(rows[0][0], rows[1][0])):
            units = [(HEAD.findall(one) or ["-"])[-1] for one in heads]
            if heads[0] in ("torque", "speed [rad/s]"):  # names of outputs, as the scene has them
                units[0] = "N m" if heads[0] == "torque" else "rad/s"
            pairs = list(zip(*(one.split(" or ") for one in units), strict=True))
            for row, shown in zip(rows[0][1:], rows[1][1:], strict=True):
                factor, a, b = ratio(*pairs["torque while rotating" in row
                                            and len(pairs) - 1]), row[number], shown[number]
                if not NUMBER.fullmatch(a):
                    self.assertEqual(a, b)
                else:
                    self.assertAlmostEqual(float(b), float(a) * factor, delta=1e-12 * abs(float(a) * factor), msg=heads)

    def compare_figures(self, figures, drawn):
        self.assertEqual([name for name, _ in figures], [name for name, _ in drawn])
        output = {"torque": "N m"}  # of the scene: without a unit in SI
        for (name, panels), (_, others) in zip(figures, drawn):
            for (x, y, lines), (other_x, other_y, other_lines) in zip(panels, others):
                # shared axes have one label
                labels = ((x or panels[-1][0], other_x or others[-1][0]), (y or panels[0][1], other_y or others[0][1]))
                for axis, (a, b) in enumerate(labels):
                    factor = ratio((HEAD.findall(a) or [output.get(a, "-")])[0], (HEAD.findall(b) or ["-"])[0])
                    for line, shown in zip(lines, other_lines, strict=True):
                        values, seen = (one[:, axis] for one in (line, shown))
                        if len(values) == 2 and set(values) <= {0.0, 1.0}:
                            continue  # a reference line
                        size = max((abs(one) for one in values if math.isfinite(one)), default=0.0) * factor
                        for one, other in zip(values, seen, strict=True):
                            self.assertTrue(not math.isfinite(one) or abs(other - one * factor) <= 1e-9 * size,
                                            (name, a, b, one, other))

    def test_check(self):
        self.compare("check")

    def test_static(self):
        self.assertIn("static_main.csv", self.compare("static"))

    def test_run(self):
        self.assertLessEqual({"run.csv", "run.png", "fatigue_main.csv"}, set(self.compare("run")))
        with open(self.folder / "run-field" / "run.csv", encoding="utf-8") as file:
            self.assertEqual(file.readline().strip(), "time [s],torque [ft-lbf],speed [rpm]")

    def test_modes(self):
        self.compare("modes")

    def test_response(self):
        self.compare("response")
        with open(self.folder / "response-field" / "response.csv", encoding="utf-8") as file:
            self.assertEqual(file.readline().strip(), "frequency [Hz],amplitude of middle [ft],phase of middle [deg]")

    def test_speeds(self):
        self.compare("speeds")

    def test_buckle(self):
        self.assertIn("buckling_thrust_main.csv", self.compare("buckle"))

    def test_torque_drag(self):
        self.assertLessEqual({"rig_limits_main.csv", "broomstick_main.csv", "measured_main.csv"},
                             set(self.compare("torque-drag")))

    def test_stuck(self):
        self.compare("stuck")

    def test_report(self):
        needs("plotly")
        self.compare("report")
        pages = {}
        for system in ("si", "field", "mine"):
            page = (self.folder / f"report-{system}" / "report.html").read_text(encoding="utf-8")
            pages[system] = json.loads(re.search(r'id="figures">(.*?)</script>', page)[1])
            words = re.sub(r"<script.*?</script>|<style.*?</style>|<[^>]*>", "\n", page, flags=re.DOTALL)
            self.assertNotRegex(words, {"si": ONLY_FIELD, "field": ONLY_SI, "mine": ONLY_FIELD}[system])
            self.assertIn({"si": "SI", "field": "field units (ft, lbf, psi)",
                           "mine": "mine units (m, kN, MPa)"}[system], words)
        for system in ("field", "mine"):
            for one, other in zip(pages["si"], pages[system], strict=True):
                for axis in "xy":
                    titles = [layout.get(f"{axis}axis", {}).get("title", {}).get("text", "")
                              for layout in (one["layout"], other["layout"])]
                    units = [(HEAD.findall(title) or ["-"])[0] for title in titles]
                    if titles[0] in ("torque", "speed [rad/s]"):
                        units[0] = "N m" if titles[0] == "torque" else "rad/s"
                    if "scene" in one["layout"]:
                        units = [HEAD.findall(layout["scene"][f"{axis}axis"]["title"]["text"])[0]
                                 for layout in (one["layout"], other["layout"])]
                    for line, drawn in zip(one["data"], other["data"], strict=True):
                        if line["type"] in ("scatter", "scatter3d", "bar"):
                            size = max(map(abs, line[axis]), default=0.0) * ratio(*units)
                            for a, b in zip(line[axis], drawn[axis], strict=True):
                                self.assertAlmostEqual(b, a * ratio(*units), delta=2e-5 * size, msg=(titles, units))

    def test_key_of_the_scene(self):
        self.scene = self.write("rig.toml", SCENE + '[results]\nunits = "field"\n')
        self.assertRegex(self.call("static", self.scene), r"axial force .* lbf, torque up to .* ft-lbf")
        self.assertRegex(self.call("static", self.scene, "--units", "mine"), r"axial force .* kN, torque up to .* N m")
        self.assertIn('units = "field"', scene.saves(scene.load(self.scene)))
        self.assertIn("one of si, field, mine", self.call("keys", "results"))

    def test_wrong_names(self):
        error = self.call("static", self.scene, "--units", "metric", status=2)
        self.assertRegex(error, "invalid choice: 'metric' .*si.*field.*mine")
        self.scene = self.write("rig.toml", SCENE + '[results]\nunits = "fields"\n')
        self.assertIn('results.units = "fields": must be one of the words si, field, mine',
                      self.call("static", self.scene, status=2))
        self.assertEqual(unit_systems.NAMES, ("si", "field", "mine"))

    def test_refused_depths_have_the_units_of_the_output(self):
        for system, text in (("field",
                              "--depths: 100 ft must be above 0 ft, where the string begins, and at most 29.5276 ft"),
                             ("si", "--depths: 30.48 m must be above 0 m, where the string begins, and at most 9 m")):
            self.assertIn(text, self.call("torque-drag", self.scene, "--depths", "100 ft", "--units", system, "-q",
                                          status=2))

    def test_sweep_passes_units(self):
        out = self.folder / "sweep"
        self.call("sweep", self.scene, "static", "--vary", "hole.mu_dynamic=0.2", "--output", out, "--", "--units",
                  "field")
        with open(out / "00001" / "static_main.csv", encoding="utf-8") as file:
            self.assertIn("along [ft]", file.readline())


if __name__ == "__main__":
    unittest.main()
