"""Tests of the report: catalogue of its languages, the page in Chinese, plan and section of the hole, verdicts that are
not given, limits for the crew, probability."""
import ast
import dataclasses
import html
import json
import math
import os
import re
import shutil
import subprocess
import unittest
import unittest.mock

from shared_tests import DRIVES, HERE, SHORT_STRING, FolderTest, needs

needs("numpy", "tomllib")

import tomllib  # noqa: E402

from drillmbd import (results, enums, language, report, report_figures, report_hole, report_linear, report_page,
                      report_probability, scene, unit_systems, verdict)  # noqa: E402
from drillmbd._structs import Id, SpeedBand  # noqa: E402
from drillmbd.analysis import OPERATIONS, operation_name  # noqa: E402
from drillmbd.errors import status_text  # noqa: E402
from drillmbd.scene import words  # noqa: E402
from drillmbd.scene.largest import range_of  # noqa: E402
from drillmbd.frames import SpeedBands  # noqa: E402
from drillmbd.profile import values_of  # noqa: E402
from drillmbd.operating import BIT_FRICTION, Operating, largest_of, operating, operations_of  # noqa: E402

PACKAGE = HERE / "drillmbd"
LIBRARY = HERE.parents[1] / "lib"
CATALOGUE = tomllib.loads((PACKAGE / "language_zh.toml").read_text(encoding="utf-8"))
FIELDS = re.compile(r"\{[^{}]*\}")
SCENE = """title = "演示钻孔"
[environment]
fluid_density = "1000 kg/m3"
[hole]
diameter = "94 mm"
dip = "5 deg"
azimuth = "90 deg"
""" + SHORT_STRING.replace('diameter = 0\n', 'diameter = "94 mm"\nload = "2 kN"\n') + """[[time_function]]
name = "turning"
segment = {kind = "step", x1 = "20 ms", h1 = "100 rpm"}
""" + DRIVES + """[limits]
torque = "5 kN m"
push = "100 kN"
pull = "100 kN"
yield_stress = "400 MPa"
[run]
end = "20 ms"
step = "1 ms"
static = true
[fatigue]
curve_stress = "100 MPa"
slope = 4
[speeds]
speed_low = "30 rpm"
speed_high = "300 rpm"
points = 30
[[speeds.order]]
order = 1
[[speeds.output]]
place = {part = "main", pipe = 4}
quantity = "vibration-z"
limit = "1 m"
"""
OTHER_STRING = ('[[string]]\nname = "other"\nstart_free = []\n[[string.pipes]]\ncount = 2\neccentricity = "1 mm"\n'
                '[[bit]]\nstring = "main"')
FATIGUE = re.compile(r"\[fatigue\].*?(?=\[speeds\])", re.DOTALL)
STUDY = """[variability]
seed = 3
samples = 12
question = "static"
[[variability.scatter]]
name = "friction"
keys = ["hole.mu_static", "hole.mu_dynamic"]
distribution = "uniform"
low = 0.2
high = 0.4
[[failure]]
name = "pull"
kind = "rig-pull"
limit = "1 kN"
"""
#: Words of the Chinese page that no catalogue translates: units, names of programs, keys and people, axes.
LATIN = set("kN N MPa kPa Pa m mm s ms rad deg rpm h kg drillmbd rig toml Python Pessier Fear S main run speeds "
            "buckling fatigue end psi lbf ft in lbm ppg "
            "klbf hp kft x L load bit feed head turning string pipes static report PNG e string out".split())


def phrases():
    """File and call of each sentence that goes through the catalogue."""
    for path in sorted(PACKAGE.rglob("*.py")):
        tree = ast.parse(path.read_text(encoding="utf-8"))
        names = {one.asname or one.name for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)
                 and node.module == "language" for one in node.names}
        names |= {"phrase"} if path.name == "language.py" else set()
        for node in ast.walk(tree):
            if (isinstance(node, ast.Call) and isinstance(node.func, ast.Name)
                and node.func.id in names & {"phrase", "joined"}):
                yield path.name, node


def sources():
    """Literals of messages, values replaced by NUL, in the C library and in the package."""
    for path in LIBRARY.rglob("*.[ch]"):
        for found in re.finditer(r'"(?:[^"\\\n]|\\.)*"(?:\s*"(?:[^"\\\n]|\\.)*")*', path.read_text(encoding="utf-8")):
            text = "".join(re.findall(r'"((?:[^"\\\n]|\\.)*)"', found[0])).replace("\\n", "\n").replace('\\"', '"')
            yield re.sub(r"%[-+0-9.]*[a-z]", "\0", text.replace("%%", "%"))
    for path in PACKAGE.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Constant) and isinstance(node.value, str):
                yield node.value
            elif isinstance(node, ast.JoinedStr):
                yield "".join(one.value if isinstance(one, ast.Constant) else "\0" for one in node.values)


class CatalogueTest(unittest.TestCase):
    def test_every_sentence_is_there_and_used(self):
        wanted = set()
        for file, call in phrases():
            self.assertIsInstance(call.args[0], ast.Constant, f"{file}:{call.lineno}: the sentence must be a literal")
            wanted.add(call.args[0].value)
        self.assertGreater(len(wanted), 150)
        self.assertEqual(wanted - set(CATALOGUE["phrases"]), set(), "missing in language_zh.toml")
        self.assertEqual(set(CATALOGUE["phrases"]) - wanted, set(), "unused in language_zh.toml")

    def test_fields_are_those_of_the_english(self):
        for part in CATALOGUE.values():
            for english, other in part.items():
                self.assertEqual(sorted(FIELDS.findall(english)), sorted(FIELDS.findall(other)), english)
                self.assertTrue(other.strip(), english)

    def test_fields_have_values(self):
        for file, call in phrases():
            if call.func.id == "phrase":
                fields = set(re.findall(r"\{(\w+)", call.args[0].value))
                self.assertEqual(fields, {one.arg for one in call.keywords}, f"{file}:{call.lineno}")

    def test_translations_are_chinese(self):
        """Outside fields, keys and names there is no English word."""
        for part in CATALOGUE.values():
            for english, other in part.items():
                left = set(re.findall(r"[A-Za-z]+", re.sub(r"\{[^{}]*\}|\[+[\w. ]*\]+|\\?\"[^\"]*\"", " ", other)))
                allowed = LATIN | set("NULL NaN Ctrl C elements eccentricity damping time stress range struct size "
                                      "outer diameter follow "
                                       # keys of scene files and freedoms that a remedy names
                                       "Hz RX RY RZ EI limit high steps slip axial rotation steady hole follows stuck "
                                       "flow eccentricity rate consistency fluid "
                                       "density environment kind rock law step min max part component default "
                                       # names of the live page: of the browser's parts, and its keys
                                       "WebAssembly WebGL libdrillmbd K R".split()) | {"load"}
                self.assertEqual(left - allowed, set(), (english, other))

    def test_messages_are_those_of_the_library(self):
        known = [*sources(), *map(status_text, enums.Status)]
        for template in CATALOGUE["messages"]:
            text = FIELDS.sub("\0", template).removeprefix("\0: ")  # the name of the analysis or part
            for part in text.split("; "):  # a remedy is put behind a failure
                self.assertTrue(any(part in one for one in known), template)

    def test_every_message_is_met(self):
        """Each message of the catalogue gives its own translation: no entry before it fits too. Names of C do not
        appear in English."""
        for english, other in CATALOGUE["messages"].items():
            values = {name[1:-1]: f"{7 + number}" for number, name in enumerate(sorted(set(FIELDS.findall(english))))}
            message = language.Foreign(english.format(**values))
            self.assertEqual(language.Language("zh")(message), other.format(**values), english)
            self.assertNotRegex(str(message), r"dmb_|DMB_")

    def test_parts_of_a_message(self):
        """Parts with semicolons between are translated if all are known; else the whole stays English and is said to be
        so."""
        chinese = language.Language("zh")
        known = language.Foreign("is taken as 73 x 6.5 mm (outer diameter x wall); no grade is named: the yield "
                                 "strength is not known; without tool joints")
        self.assertNotRegex(chinese(known), r"taken|grade|原文")
        self.assertIn("来源：A; B",
                      chinese(language.Foreign("is taken as 73 x 6.5 mm (outer diameter x wall); source: A; B")))
        self.assertIn("英文原文", chinese(language.Foreign("without tool joints; something new")))

    def test_every_status_is_there(self):
        for status in enums.Status:
            self.assertIn(status_text(status), CATALOGUE["messages"])

    def test_names_of_operations_are_those_of_the_library(self):
        self.assertEqual(list(report.OPERATION_NAMES), [operation_name(kind) for kind in OPERATIONS])


class LanguageTest(unittest.TestCase):
    def test_english_is_the_sentence(self):
        self.assertEqual(language.phrase("factor {factor:.4g}", factor=1.23456), "factor 1.235")
        self.assertEqual(language.ENGLISH(language.phrase("OK")), "OK")

    def test_chinese(self):
        to = language.Language("zh")
        tile = verdict.Tile(language.phrase("Thrust at the rig"), "5 kN", language.phrase("no damage"), verdict.OK)
        self.assertEqual(to(tile.line()), "钻机推力：5 kN，合格（无损伤）")
        self.assertEqual(to(language.joined(", ", [language.phrase("pick-up"), "x"])), "上提、x")
        self.assertEqual(to("名 name"), "名 name")
        self.assertEqual(to(language.Foreign("the iteration did not converge")), "迭代不收敛")
        self.assertEqual(to(language.Foreign("never seen 5")), "程序信息（英文原文）：never seen 5")
        self.assertEqual(to.lines("  rigid parts                   97\n"), "  刚性部件                      97\n")

    def test_units_are_converted_in_every_language(self):
        field = unit_systems.Units("field")
        said = field.sentence(language.phrase("surveyed length {length:.6g} m", length=30.48))
        self.assertEqual((said, language.Language("zh")(said)), ("surveyed length 100 ft", "测斜长度 100 ft"))


class HoleTest(unittest.TestCase):
    def view(self, dip="5 deg", azimuth="90 deg", units="si"):
        made = scene.loads(SCENE.replace('"5 deg"', f'"{dip}"').replace('"90 deg"', f'"{azimuth}"'))
        with made.new_sim() as sim:
            sim.static(**made.fields_of("static"))
            found = sim.profile(made.names["main"], made.pipes["main"])
        return report_hole.hole_view(made, found, unit_systems.Units(units)), found

    def test_place_of_the_end(self):
        """A straight hole: the end is length times cosine of the dip along its azimuth, length times sine above;
        nothing to the side."""
        for azimuth in (0.0, 90.0, 200.0):
            view, found = self.view(azimuth=f"{azimuth:g} deg")
            length = float(found.depth.max())
            self.assertAlmostEqual(math.degrees(view.azimuth) % 360.0, azimuth, 6)
            for value, wanted in zip(view.course[-1], (length * math.cos(math.radians(5.0)), 0.0,
                                                       length * math.sin(math.radians(5.0)))):
                self.assertAlmostEqual(value, wanted, 6)
            self.assertAlmostEqual(view.dips[0], 5.0, 6)

    def test_units(self):
        si, field = self.view()[0], self.view(units="field")[0]
        self.assertAlmostEqual(field.course[-1][0] / si.course[-1][0], 1 / 0.3048, 9)
        self.assertAlmostEqual(max(field.force) / max(si.force), 0.3048 / 4.4482216152605, 9)
        self.assertEqual((field.length_unit, field.force_unit), ("ft", "lbf/ft"))

    def test_azimuth_and_sides(self):
        """East of north, seen from above, is to the right: north is x, west is y."""
        self.assertAlmostEqual(report_hole.azimuth_of((0.0, -3.0, 0.0), 3.0, 0.0), 0.5 * math.pi)
        self.assertEqual(report_hole.azimuth_of((0.0, 0.0, -50.0), 50.0, 1.25), 1.25)
        along, right, up = report_hole.turned((10.0, -1.0, 2.0), 0.0, 1.0)
        self.assertEqual((along, right, up), (10.0, 1.0, 2.0))

    def test_both_views_have_one_scale(self):
        view, _ = self.view()
        for width in (960.0, 340.0):
            drawn = report_hole.Drawing(view, width, language.ENGLISH).svg()
            course = [[tuple(map(float, one.split(","))) for one in points.split()]
                      for points in re.findall(r'points="([^"]*)" fill="none" stroke="#e2e2e2"', drawn)]
            self.assertEqual(len(course), 2)
            (plan, section) = course
            self.assertAlmostEqual(plan[-1][0] - plan[0][0], section[-1][0] - section[0][0], 1)
            rise = (section[0][1] - section[-1][1]) / (section[-1][0] - section[0][0])
            self.assertAlmostEqual(rise, math.tan(math.radians(5.0)), 2)
            places = ([float(one) for one in re.findall(r'[ "]x="([-\d.]+)"', drawn)] + [point[0] for one in course
                                                                                         for point in one])
            self.assertTrue(all(0.0 <= place <= width for place in places), places)

    def test_north_arrow(self):
        """Along azimuth 90 the hole goes to the right of the page and north is up; along 0 north is to the right."""
        for azimuth, wanted in (("90 deg", (0.0, -1.0)), ("0 deg", (1.0, 0.0)),
                                ("200 deg", (math.cos(math.radians(200)), -math.sin(math.radians(200))))):
            drawn = report_hole.Drawing(self.view(azimuth=azimuth)[0], 960.0, language.ENGLISH).svg()
            tail, tip = (tuple(map(float, one.split(",")))
                         for one in re.search(r'points="([^"]*)"[^>]*stroke-width="1.6"', drawn)[1].split())
            length = math.dist(tail, tip)
            for i in range(2):
                self.assertAlmostEqual((tip[i] - tail[i]) / length, wanted[i], 2)

    def test_upright_hole(self):
        drawn = report_hole.Drawing(self.view(dip="-90 deg")[0], 340.0, language.ENGLISH).svg()
        self.assertIn("collar, dip -90.0°", drawn)
        self.assertNotIn("nan", drawn)

    def test_contact_force_has_its_class(self):
        """Thicker and darker with the force, also without colours; the string that lies on the wall bears its weight in
        the mud."""
        light = [0.2126 * int(colour[1:3], 16) + 0.7152 * int(colour[3:5], 16) + 0.0722 * int(colour[5:], 16)
                 for _, colour in report_hole.CLASSES[1:]]
        self.assertTrue(all(a > b + 30.0 for a, b in zip(light, light[1:])), light)
        self.assertEqual([width for width, _ in report_hole.CLASSES],
                         sorted({width for width, _ in report_hole.CLASSES}))
        view, found = self.view()
        self.assertEqual(len(view.force), 8)
        self.assertGreater(max(view.force), 0.0)
        self.assertAlmostEqual(max(view.force), float(max(found["normal_force"])), 9)
        self.assertEqual(view.class_of(0.0), 0)
        self.assertEqual([view.class_of(view.step * (i + 0.5)) for i in range(4)], [1, 2, 3, 4])
        self.assertLessEqual(max(view.force), 4.0 * view.step)


class VerdictTest(unittest.TestCase):
    """Each all-clear has an input for which it is not given."""

    def test_duration(self):
        for seconds, text in ((5.4e3, "1.5 h"), (7.2e6, "2000 h"), (3.156e9, "100 years"),
                              (1e14, "more than 1000 years")):
            self.assertEqual(verdict.duration(seconds), text)

    def speeds(self, bands=(), severity=0.5, rotation=10.0, silent=0, unmoved=()):
        found = SpeedBands()
        for low, high in bands:
            found.append(SpeedBand(low=low, high=high))
        found.report.silent_orders = silent
        made = report_linear.Speeds(found, [severity] * 3, [5.0, 15.0, 25.0], unmoved=unmoved)
        return made, report_linear.speeds_tile(made, Operating(rotation=rotation))

    def test_speeds(self):
        self.assertEqual(self.speeds()[1].verdict, "OK")
        self.assertEqual(self.speeds(severity=0.0)[1].verdict, "NOT ASSESSED")
        self.assertEqual(self.speeds(rotation=None)[1].verdict, "NOT ASSESSED")
        self.assertEqual(self.speeds(rotation=30.0)[1].verdict, "NOT ASSESSED")
        self.assertEqual(self.speeds(silent=1)[1].verdict, "NOT ASSESSED")
        self.assertEqual(self.speeds(unmoved=["turn"])[1].verdict, "NOT ASSESSED")
        self.assertIn("does not move turn", self.speeds(unmoved=["turn"])[1].text)
        self.assertEqual(self.speeds(bands=[(9.0, 11.0)])[1].verdict, "OVER")
        self.assertEqual(self.speeds(bands=[(10.5, 11.0)])[1].verdict, "NEAR LIMIT")
        self.assertEqual(self.speeds(bands=[(20.0, 22.0)])[1].verdict, "OK")

    def test_speeds_that_may_be(self):
        """Whole revolutions per minute outside of all bands, inside the range."""
        rpm = math.pi / 30.0
        self.assertEqual(self.speeds()[0].allowed(), [(48, 238)])
        self.assertEqual(self.speeds(bands=[(100.2 * rpm, 120.7 * rpm), (200.0 * rpm, 25.0)])[0].allowed(),
                         [(48, 100), (121, 200)])
        self.assertEqual(self.speeds(bands=[(5.0, 25.0)])[0].allowed(), [])
        self.assertEqual(self.speeds(bands=[(200.0 * rpm, 25.0)])[0].avoid(), "200 rpm and more")

    def test_demand(self):
        def verdict_of(limit, value, failed=()):
            demand = verdict.Demand("x", "N", limit, failed=list(failed))
            if value is not None:
                demand.add(value, "s")
            return demand.tile().verdict
        self.assertEqual([verdict_of(10.0, 5.0), verdict_of(10.0, 9.0), verdict_of(10.0, 11.0)],
                         ["OK", "NEAR LIMIT", "OVER"])
        self.assertEqual([verdict_of(None, 5.0), verdict_of(10.0, None), verdict_of(10.0, 5.0, ["a"])],
                         ["NO LIMIT GIVEN", "NOT COMPUTED", "NOT ASSESSED"])
        tile = verdict.Demand("x", "N", None, [(5.0, "slide")], key="push").tile()
        self.assertEqual(tile.text, "slide; for a verdict give push in [limits]")
        tile = verdict.Demand("x", "N", 10.0, [(5.0, "slide")], key="push").tile()
        self.assertEqual(tile.text, "50 % of 10 N; slide")

    def test_an_analysis_without_a_value(self):
        """NaN of one analysis is never left out in silence."""
        demand = verdict.Demand("x", "N", 10.0)
        demand.add(math.nan, "first")
        self.assertEqual((demand.tile().verdict, demand.tile().text), ("NOT COMPUTED", "first: no value"))
        demand.add(5.0, "second")
        self.assertEqual((demand.tile().verdict, demand.tile().value), ("NOT ASSESSED", "5 N"))
        self.assertIn("without first: no value", str(demand.tile()))
        demand.add(11.0, "third")
        self.assertEqual(demand.tile().verdict, "OVER")

    def study(self, text, **more):
        made = report.Study(scene.loads(text), results.CommandOutput(None, "x.toml", scene.loads(text), "report", True))
        for name, value in more.items():
            setattr(made, name, value)
        made.compute()
        return made, {tile.title: tile for tile in made.tiles}

    def test_page_of_a_scene(self):
        """The scene has every excitation and load, so that its values are compared; torque of the bit by hand."""
        made, tiles = self.study(SCENE)
        for title in ("Thrust at the rig", "Pull at the rig", "Torque at the rig", "Von Mises stress",
                      "Buckling in the hole", "Critical speeds"):
            self.assertEqual(tiles[title].verdict, "OK", tiles[title])
        self.assertEqual(made.plan.torque_on_bit, BIT_FRICTION * 2000.0 * 0.094 / 3.0)
        self.assertIn("bit torque 31.33 N m, estimated from the bit load", made.headline)
        self.assertEqual([row[0] for row in made.rows], ["Thrust at the rig", "Pull at the rig", "Torque at the rig",
                                                         "Rotary speed", "Load on the bit",
                                                         "Feed rate"])
        self.assertEqual(made.rows[0][1:3], ("100 kN", tiles["Thrust at the rig"].value))
        self.assertEqual(made.rows[4][1], "2 kN: more is not assessed")

    def test_stress_of_the_estimated_torque(self):
        """Its shear stress is added to those of stiff string and run, by hand: pipes of 73 x 61 mm."""
        made, tiles = self.study(SCENE)
        bare, _ = self.study(SCENE, _bit_torque=lambda: None)
        outer, inner = 0.073, 0.061
        shear = made.plan.torque_on_bit * 0.5 * outer / (math.pi / 32.0 * (outer ** 4 - inner ** 4))
        self.assertAlmostEqual(made.demands["yield_stress"].value - bare.demands["yield_stress"].value,
                               math.sqrt(3.0) * shear, 3)
        self.assertIn("by the estimated torque of the bit", tiles["Von Mises stress"].text)

    def test_thrust_of_a_short_string(self):
        """Where the hole goes down, the load on the bit is thrust of the rig at the first rods and weight of the string
        at the last; the largest loads of all depths decide, as in torque-drag."""
        text = SCENE.replace('"5 deg"', '"-60 deg"').replace("count = 8", "count = 60").replace(
            'push = "100 kN"', 'push = "1.8 kN"')
        made, tiles = self.study(text)
        with made.scene.new_sim() as sim:
            found = sim.torque_drag(operations_of(made.plan), [60.0 * (i + 1) / report.DEPTHS
                                                               for i in range(report.DEPTHS)])
        self.assertGreater(min(row.hook_load for row in found.rows[-1]), 0.0)
        largest = max(-row.hook_load for rows in found.rows for row in rows)
        self.assertEqual(made.demands["push"].value, largest)
        self.assertEqual(tiles["Thrust at the rig"].verdict, "OVER")
        self.assertIn("soft string, slide, bit at 1.5 m", tiles["Thrust at the rig"].text)
        self.assertEqual({row[0]: row[3] for row in made.rows}["Load on the bit"], "OVER")

    def test_buckling_in_the_hole(self):
        self.assertEqual(self.study(SCENE.replace('"2 kN"', '"900 kN"'))[1]["Buckling in the hole"].verdict, "OVER")
        self.assertEqual(self.study(SCENE.replace('load = "2 kN"\n', ''))[1]["Buckling in the hole"].verdict,
                         "NOT ASSESSED")

    def test_without_a_run(self):
        """No analysis has the load of the bit in the stress then."""
        text = FATIGUE.sub("", SCENE.replace('end = "20 ms"\n', ""))
        tiles = self.study(text)[1]
        self.assertEqual((tiles["Von Mises stress"].verdict, tiles["Run in time"].verdict),
                         ("NOT ASSESSED", "NOT ASSESSED"))
        with_strength = self.study(text.replace('eccentricity = "1 mm"',
                                                'eccentricity = "1 mm"\nyield_strength = "500 MPa"'))[1]
        self.assertEqual(with_strength["Von Mises stress"].verdict, "OK")

    def test_a_run_that_ends_before_the_load(self):
        """No analysis has the stress of the load on the bit then, unless pipes have a yield strength."""
        loading = '[[time_function]]\nname = "loading"\nsegment = {kind = "step5", x1 = "%s", h1 = "2 kN"}\n[[bit]]'
        scheduled = FATIGUE.sub("", SCENE.replace('load = "2 kN"', 'load = "loading"'))
        for time, wanted in (("20 ms", "OK"), ("2 s", "NOT ASSESSED")):
            text = scheduled.replace("[[bit]]", loading % time)
            made, tiles = self.study(text)
            self.assertEqual(made.plan.weight_on_bit, 2000.0)
            self.assertEqual(tiles["Von Mises stress"].verdict, wanted, tiles["Von Mises stress"])
        self.assertIn("the load on the bit, which the run of 0.02 s does not reach", tiles["Von Mises stress"].text)
        self.assertEqual(self.study(text.replace('eccentricity = "1 mm"', 'eccentricity = "1 mm"\nyield_strength = '
                                                 '"500 MPa"'))[1]["Von Mises stress"].verdict, "OK")

    def test_nonlinear_buckling(self):
        """The string buckles at 1 + factor times the present loads: OK only for a confirmed factor above 0.25, without
        flutter before it, and where flutter was assessed."""
        class Found:
            def __init__(self, factors, **info):
                self.factors, self.status = factors, info.pop("status", 0)
                self.info = unittest.mock.Mock(**{"confirmed": 1, "flutter": enums.FLUTTER_NOT_JUDGED, **info})

            def __enter__(self):
                return self

            def __exit__(self, *_):
                pass

        def verdict_of(factors, part=None, **info):
            made = unittest.mock.MagicMock()
            made.new_sim().__enter__().buckling.return_value = Found(factors, **info)
            made.fields_of.return_value = {"part": part} if part else {}
            return report_linear.buckling_tile(made, lambda sim: None, unittest.mock.MagicMock()).verdict
        flutter = {"flutter": enums.FLUTTER_FOUND}
        self.assertEqual([verdict_of([2.0]), verdict_of([0.26]), verdict_of([0.24]), verdict_of([2.0], confirmed=0),
                          verdict_of([])], ["OK", "OK", "NEAR LIMIT", "NOT ASSESSED", "NOT ASSESSED"])
        self.assertEqual([verdict_of([2.0], flutter_factor=0.0, **flutter),
                          verdict_of([], flutter_factor=0.2, **flutter),
                          verdict_of([2.0], status=enums.NOTE_INCOMPLETE),
                          verdict_of([2.0], part=Id(enums.PART_DRIVE << 24, 1))],
                         ["OVER", "NEAR LIMIT", "NOT ASSESSED", "NOT ASSESSED"])

    def test_largest_sinusoidal_share(self):
        """Of all operations, not of that with the largest helical share: their ratio differs along the hole."""
        described = scene.loads(SCENE)
        made = report.Study(described, results.CommandOutput(None, "x.toml", described, "report", True))
        for sinusoidal, wanted in ((1.2, "NEAR LIMIT"), (0.8, "OK")):
            made._confinement([unittest.mock.Mock(helical_share=one, sinusoidal_share=other, buckled_at=1.0, locked=0)
                               for one, other in ((0.6, 0.85), (0.55, sinusoidal))])
            self.assertEqual(made.tiles[-1].verdict, wanted)

    def test_stress_of_a_short_pipe(self):
        """A thin pipe that is shorter than the spacing of stations has its stress in statics and run."""
        thin = ('[[string.pipes]]\ncount = 3\n[[string.pipes]]\nlength = "100 mm"\nouter_diameter = "40 mm"\n'
                'inner_diameter = "36 mm"\n[[string.pipes]]\ncount = 8')
        text = SCENE.replace("[[string.pipes]]\ncount = 8", thin).replace("2 kN", "20 kN")
        made, _ = self.study(text, _bit_torque=lambda: None)
        loaded = made.scene
        with loaded.new_sim() as sim:
            sim.static(**loaded.fields_of("static"))
            values = values_of(sim, loaded.names["main"], [enums.PROFILE_VON_MISES], count=20001)
            self.assertGreater(made._stress(sim), 0.95 * values.max())
            even = sim.profile(loaded.names["main"], 12)["von_mises"]
        self.assertLess(even.max(), 0.8 * values.max())
        self.assertGreater(made.demands["yield_stress"].value, 0.95 * values.max())

    def test_rigid_pipes(self):
        """They have no stress, so that the others alone are not cleared."""
        text = FATIGUE.sub("", SCENE.replace('eccentricity = "1 mm"',
                                              'eccentricity = "1 mm"\n[[string.pipes]]\nkind = "rigid"'))
        tile = self.study(text)[1]["Von Mises stress"]
        self.assertEqual(tile.verdict, "NOT ASSESSED", tile)
        self.assertIn("rigid pipes, which have no stress", tile.text)

    def test_an_unstable_state(self):
        """A straight string that is pushed beyond its buckling load has none of the stress of the buckled one."""
        for load, stable in (("2 kN", True), ("60 kN", False)):
            text = SCENE.replace("5 deg", "90 deg").replace('"2 kN"', f'"{load}"')
            tiles = self.study(text.replace("eccentricity", "damping_time").replace("1 mm", "1 ms"))[1]
            for title in ("Thrust at the rig", "Von Mises stress"):
                self.assertEqual(tiles[title].verdict, "OK" if stable else "NOT ASSESSED", tiles[title])
                self.assertEqual("an unstable state, which the string leaves" in tiles[title].text, not stable)

    def test_nonlinear_buckling_decides_on_the_load(self):
        with unittest.mock.patch.object(report, "buckling_tile", return_value=verdict.Tile(
                "Buckling, nonlinear", "", "", "NEAR LIMIT")):
            made, _ = self.study(SCENE.replace('"0 m/s"', '"1 mm/s"') + "[buckling]\n")
        rows = {row[0]: row[3] for row in made.rows}
        self.assertEqual((rows["Load on the bit"], rows["Feed rate"], rows["Pull at the rig"]),
                         ("NEAR LIMIT", "NEAR LIMIT", "OK"))

    def test_rows_for_the_crew(self):
        """Load on the bit and feed are cleared with what they cause only; the page says not to drill where a value is
        over."""
        made, tiles = self.study(SCENE.replace('torque = "5 kN m"', 'torque = "20 N m"').replace('"0 m/s"', '"1 mm/s"'))
        rows = {row[0]: row for row in made.rows}
        self.assertEqual((rows["Torque at the rig"][3], rows["Load on the bit"][3], rows["Feed rate"][3]),
                         ("OVER",) * 3)
        self.assertEqual(rows["Feed rate"][1], "1 mm/s: more is not assessed")
        self.assertIn("Do not drill as described here. Over the limit: Torque at the rig.",
                      report_page.Page(made).limits())
        made, tiles = self.study(SCENE.replace('"0 m/s"', '"1 mm/s"'))
        self.assertEqual({row[3] for row in made.rows}, {"OK"})
        self.assertNotIn("Do not drill", report_page.Page(made).limits())
        self.assertEqual(verdict.worst(["OK", "NOT ASSESSED", "NO LIMIT GIVEN"]), "NOT ASSESSED")

    def test_noise_is_drawn_as_zero(self):
        self.assertEqual(report_figures.value_axis("x", [1e-24, -3e-20])["range"], [-1, 1])
        self.assertNotIn("range", report_figures.value_axis("x", [1e-24, 2e-6]))
        demand = verdict.Demand("x", "N", 5.0)
        demand.add(-0.0, "s")
        self.assertEqual(demand.tile().value, "0 N")

    def test_rock_law(self):
        """The torque of a bit that cuts rock is not estimated; without a run its load is not known."""
        text = FATIGUE.sub("", SCENE.replace('load = "2 kN"', 'load = "2 kN"\nrock_law = "rate"'))
        made, tiles = self.study(text.replace('end = "20 ms"\n', ""))
        self.assertFalse(made.plan.estimated)
        self.assertNotIn("estimated", made.headline)
        self.assertEqual([tiles[name].verdict for name in ("Thrust at the rig", "Torque at the rig",
                                                           "Von Mises stress")], ["NOT ASSESSED"] * 3)
        made, tiles = self.study(text)
        self.assertFalse(made.plan.estimated)
        self.assertNotIn("rock law", tiles["Torque at the rig"].text)

    def test_two_strings(self):
        """Analyses of one string clear nothing of a scene with two."""
        text = SCENE.replace("[[bit]]", OTHER_STRING)
        self.assertEqual(len(scene.loads(text).pipes), 2)
        tiles = self.study(text)[1]
        for title in ("Thrust at the rig", "Pull at the rig", "Torque at the rig", "Von Mises stress",
                      "Buckling in the hole"):
            self.assertNotEqual(tiles[title].verdict, "OK", title)
        self.assertIn("other strings (other)", tiles["Pull at the rig"].text)

    def test_operation_of_the_first_string(self):
        """Its own bit and drives, also where those of another string come first in the file."""
        before = '[[bit]]\nstring = "other"\ndiameter = "94 mm"\nload = "30 kN"\n'
        made, _ = self.study(SCENE.replace("[[bit]]", OTHER_STRING.replace('[[bit]]', before + '[[bit]]')))
        self.assertEqual(made.plan.weight_on_bit, 2000.0)

    def test_bit_without_a_diameter(self):
        """Its torque is not estimated, so that torque and stress are not cleared."""
        made, tiles = self.study(SCENE.replace('diameter = "94 mm"\nload', 'diameter = 0\nload'))
        self.assertFalse(made.plan.estimated)
        self.assertEqual([tiles[name].verdict for name in ("Thrust at the rig", "Torque at the rig",
                                                           "Von Mises stress")],
                         ["OK", "NOT ASSESSED", "NOT ASSESSED"])

    def test_stopped_run(self):
        """After Ctrl-C nothing that needs the whole run is cleared."""
        made = report.Study(scene.loads(SCENE), results.CommandOutput(None, "x.toml", scene.loads(SCENE), "report",
                                                                      True))

        def stopped(sim):
            if sim.statistics().steps:
                raise KeyboardInterrupt
            return shape(sim)
        shape, made._shape = made._shape, stopped
        made.compute()
        self.assertTrue(made.out.interrupted)
        self.assertEqual({tile.verdict for tile in made.tiles
                          if tile.title in [one.title for one in made.demands.values()]}, {"NOT ASSESSED"})

    def test_fatigue(self):
        endless = SCENE.replace('slope = 4', 'slope = 4\nendurance = "90 MPa"')
        self.assertEqual(self.study(endless)[1]["Fatigue"].verdict, "OK")
        clipped = endless.replace('endurance = "90 MPa"', 'endurance = "90 MPa"\nstress_range = "1 kPa"')
        self.assertNotEqual(self.study(clipped)[1]["Fatigue"].verdict, "OK")
        with unittest.mock.patch("drillmbd.fatigue.PLACES", 4):  # of eight pipes
            made, tiles = self.study(endless)
        self.assertEqual(tiles["Fatigue"].verdict, "NOT ASSESSED")
        self.assertIn("fatigue of main: cycles are counted in 4 of its 8 pipes, spread evenly",
                      made.out.summary["notes"])
        self.assertEqual(self.study(SCENE)[1]["Fatigue"].verdict, "NO LIMIT GIVEN")

    def test_stress_between_frames(self):
        """A blow of 2 ms between two frames of the page: the largest stress of the run is that of all steps."""
        text = FATIGUE.sub("", SCENE.replace('end = "20 ms"', 'end = "0.6 s"')) + """[[time_function]]
name = "blow"
segment = {table = [[0, 0], ["203.5 ms", 0], ["204.5 ms", 1], ["205.5 ms", 0], ["1 s", 0]]}
[[load]]
place = {part = "main", pipe = "last", fraction = 1.0}
force = ["-100 kN", 0, 0]
time_function = "blow"
"""
        made, _ = self.study(text, _bit_torque=lambda: None)
        known = 0.0
        loaded = scene.loads(text)
        with loaded.new_sim() as sim:
            sim.static(**loaded.fields_of("static"))
            for _ in range(600):
                sim.step(1e-3)
                known = max(known, sim.profile_extremes([enums.PROFILE_VON_MISES], loaded.names["main"], 8, 1)[
                    enums.PROFILE_VON_MISES].maximum)
        self.assertEqual(made.demands["yield_stress"].value, known)

    def test_fatigue_of_the_worst_string(self):
        """Not of the first one only; the cycles of all strings are counted."""
        text = SCENE.replace("[[bit]]", OTHER_STRING)
        for damage, wanted in ((0.0, "main"), (1e-3, "other")):
            def found(counters, out, damage=damage):
                return {name: unittest.mock.Mock(damage=one, largest_range=1e6, life=1.0 / one if one else math.inf)
                        for name, one in zip(counters, (0.0, damage))}
            with unittest.mock.patch.object(report, "report_fatigue", found):
                tile = self.study(text)[1]["Fatigue"]
            self.assertTrue(tile.text.startswith(f"string {wanted}: "), tile)
            self.assertEqual(tile.verdict, "NO LIMIT GIVEN" if damage else "OK")


class OperatingTest(unittest.TestCase):
    def test_range_up_to_a_time(self):
        table = {"table": [(0.0, 0.0), (2.0, 0.0), (4.0, 6.0), (5.0, 1.0)]}
        step = {"kind": enums.SEGMENT_STEP5, "x1": 2.0, "h1": 5.0}
        self.assertEqual([range_of([table], (), end) for end in (1.0, 3.0, 4.5, math.inf)],
                         [(0.0, 0.0), (0.0, 3.0), (0.0, 6.0), (0.0, 6.0)])
        self.assertEqual([range_of([step], (), end)[1] for end in (1.0, 2.0, 9.0)], [2.5, 5.0, 5.0])

    def test_largest(self):
        """Steps up and down again, in time; against sums by hand."""
        up, down = ({"kind": enums.SEGMENT_STEP, "x0": 0.0, "x1": 1.0, "h1": 20.0},
                    {"kind": enums.SEGMENT_STEP5, "x0": 19.0, "x1": 20.0, "h1": -20.0})
        back = {**down, "x0": 21.0, "x1": 22.0}
        self.assertEqual(largest_of([up]), 20.0)
        self.assertEqual(largest_of([up, down, back]), 20.0)
        self.assertEqual(largest_of([up, {**down, "h1": -50.0}]), 30.0)
        self.assertEqual(largest_of([{"kind": enums.SEGMENT_HARMONIC, "h0": 3.0, "h1": 2.0}]), 5.0)
        self.assertEqual(largest_of([{"h0": -4.0}, {"kind": enums.SEGMENT_HARMONIC, "h1": 2.0}]), 6.0)
        self.assertEqual(largest_of([{"table": [(0.0, 0.0), (2.0, 0.0), (4.0, 6.0)]},
                                     {**down, "x0": 1.0, "x1": 3.0, "h1": 5.0}]), 11.0)
        self.assertEqual(largest_of([{"table": [(0.0, 5.0), (10.0, 0.0)]}, {**down, "x0": 2.0, "x1": 9.0, "h1": -5.0}]),
                         5.0)
        self.assertEqual(largest_of([]), 0.0)
        worn = {"kind": enums.SEGMENT_PER_REVOLUTION, "of": Id(0, 1), "share": -0.02, "h1": 1.0}
        self.assertEqual(largest_of([{"h0": 5.0}, worn], [[{"h0": -100.0}]]), 8.0)
        plain = {"kind": enums.SEGMENT_CALLBACK}
        self.assertIsNone(largest_of([worn], [[plain]]))
        self.assertEqual(largest_of([{**worn, "share": 0.0}], [[plain]]), 1.0)
        self.assertIsNone(largest_of([up, {"kind": enums.SEGMENT_CALLBACK}]))
        worn = {"kind": enums.SEGMENT_PER_REVOLUTION, "of": Id(1 << 24 | 1, 1), "h0": -3.0, "h1": -2.0, "share": 0.1}
        self.assertEqual(largest_of([worn], [[worn], [up]]), 7.0)
        self.assertIsNone(largest_of([worn]))

    def test_shipped_rig(self):
        """It turns by 200 rpm forward, then backward."""
        plan = operating(scene.load(HERE.parents[1] / "examples" / "scenes" / "reference_rig.toml"))
        self.assertAlmostEqual(plan.rotation * 30.0 / math.pi, 200.0, 9)
        self.assertAlmostEqual(plan.feed, 0.01, 12)
        self.assertAlmostEqual(plan.weight_on_bit, 2960.0, 6)
        rig = scene.load(HERE.parents[1] / "examples" / "scenes" / "reference_rig.toml")
        self.assertIn("feed 10 mm/s, rotation 200 rpm, 2.96 kN on the bit", words.describe(rig, 1.0))


class PageTest(FolderTest):
    SCENE = SCENE

    def setUp(self):
        needs("plotly")
        super().setUp()

    def page(self, *more, text=None, name="out"):
        if text is not None:
            self.scene = self.write("rig.toml", text)
        out = self.call("report", self.scene, "-o", self.folder / name, *more)
        return out, (self.folder / name
                     / "report.html").read_text(encoding="utf-8"), json.loads((self.folder / name
                                                                               / "summary.json").read_text())

    @staticmethod
    def words(page):
        """The visible text."""
        return html.unescape(re.sub(r"<script.*?</script>|<style.*?</style>|<[^>]*>", "\n", page, flags=re.DOTALL))

    @staticmethod
    def labels(value):
        """Texts of the figures."""
        if isinstance(value, dict):
            for key, one in value.items():
                if isinstance(one, str) and key in ("text", "name", "label", "prefix"):
                    yield one
                elif key not in ("frames",):
                    yield from PageTest.labels(one)
        elif isinstance(value, list):
            for one in value:
                yield from PageTest.labels(one)

    def assertChinese(self, text):
        self.assertRegex(text, "[\u4e00-\u9fff]")
        left = ({one for one in re.findall(r"[A-Za-z]+", re.sub(r"\b[0-9a-f]{16}\b|\d+\.\d+\.\d+|https?:\S+|\{[^{}]*\}",
                                                                " ", text))} - LATIN)
        self.assertEqual(left, set(), text[:3000])

    def test_whole_page_in_chinese(self):
        out, page, summary = self.page("--language", "zh")
        out = re.sub(r"/\S*", "", out)
        self.assertIn('<html lang="zh-CN">', page)
        self.assertChinese(out)
        self.assertChinese(self.words(page))
        figures = list(self.labels(json.loads(re.search(r'id="figures">(.*?)</script>', page)[1])))
        self.assertGreater(len(figures), 30)
        self.assertChinese("\n".join(figures))
        self.assertIn("钻机推力", page)
        self.assertEqual(summary["verdicts"][0]["verdict"], "OK")  # for programs: English
        self.assertNotRegex(page.split('id="plotly"')[0], r"https?://|src=|<link")

    def test_chinese_with_failures_and_other_units(self):
        """Analyses that fail or are left out, notes, another system of units: nothing of it is English, but what the
        library itself wrote."""
        text = SCENE.replace('load = "2 kN"\n', '').replace('end = "20 ms"\n', '')
        text = re.sub(r"\[speeds\].*", "", FATIGUE.sub("", text), flags=re.DOTALL).replace('push = "100 kN"\n', "")
        for system in ("field", "mine"):
            out, page, _ = self.page("--language", "zh", "--units", system, text=text, name=system)
            self.assertChinese(re.sub(r"在 \[limits\] 中给出 \w+", " ", self.words(page)))
            self.assertIn("未评估", out)
        self.assertIn("未给出：开钻前必须询问", page)

    def test_english_page(self):
        _, page, _ = self.page()
        self.assertIn('<html lang="en">', page)
        self.assertNotRegex(page.split('id="plotly"')[0].replace("演示钻孔", ""), "[\u4e00-\u9fff]")
        for part in ("Limits that must not be exceeded", "Plan and section", 'class="still"', "@page{size:A4",
                     "only 30 to 300 rpm", "dip +5.0 deg"):
            self.assertIn(part, page)

    def test_remarks_on_the_scene_file_in_chinese(self):
        """A mass for a force, and a survey that begins below the collar."""
        self.write("survey.csv", "depth [m],dip [deg],azimuth [deg]\n5,5,90\n20,5,90\n")
        text = SCENE.replace('pull = "100 kN"', 'pull = "10 t"').replace('dip = "5 deg"\nazimuth = "90 deg"',
                                                                         'survey_file = "survey.csv"').replace(
            'name = "main"', 'name = "main"\nstart_depth = "5 m"')
        out, page, _ = self.page("--language", "zh", text=text)
        self.assertIn("是质量单位：按其重量取值", page)
        self.assertIn("从 5 m 开始（连接点）", page)
        self.assertChinese(re.sub(r"hole\.survey_file|survey\.csv|limits\.pull = \S+ t|“t”", " ", self.words(page)))

    def test_fits_a_phone(self):
        """In a frame of 360 pixels nothing is wider, tables scroll inside themselves, and all figures are drawn."""
        browser = shutil.which("chromium")
        if browser is None:
            self.skipTest("not there: chromium; the page was not looked at")
        text = SCENE.replace('dip = "5 deg"',
                             'dip = "-60 deg"').replace("[run]", '[results]\nvtk_interval = "1 s"\n[run]')
        _, page, _ = self.page("--language", "zh", text=text)
        frame = self.write("frame.html",
                           f"""<html><body><iframe id="phone" src="file://{self.folder}/out/report.html" width="360" height="700"></iframe>
<script>setInterval(()=>{{const inside=document.getElementById("phone").contentDocument;
document.body.dataset.width=inside.documentElement.scrollWidth;document.body.dataset.ready=inside.body.dataset.drawn;
document.body.dataset.trouble=inside.getElementById("problems").dataset.count;
document.body.dataset.widest=Math.max(...[...inside.querySelectorAll(".js-plotly-plot,.narrow svg,.card")].map(one=>one.getBoundingClientRect().right))}},500)
</script></body></html>""")  # noqa: E501
        done = subprocess.run([browser, "--headless=new", "--no-sandbox", "--disable-dev-shm-usage",
                               "--enable-unsafe-swiftshader",
                               "--allow-file-access-from-files", "--virtual-time-budget=30000", "--dump-dom",
                               f"file://{frame}"],
                              capture_output=True, text=True, timeout=300, env={**os.environ, "HOME": str(self.folder)})
        found = dict(re.findall(r'data-(\w+)="([\d.]+)"', done.stdout))
        self.assertEqual(found.get("ready"), str(page.count('class="figure"')), found)
        self.assertEqual(found["trouble"], "0")
        self.assertLessEqual(float(found["width"]), 360.0)
        self.assertLessEqual(float(found["widest"]), 360.0)

    def test_failing_analysis_says_why_in_the_language(self):
        study = report.Study(scene.load(self.scene), results.CommandOutput(None, "x.toml", scene.load(self.scene),
                                                                           "report", True))
        study._speeds = lambda: (_ for _ in ()).throw(ArithmeticError("no solution"))
        study.compute()
        tile = next(one for one in study.tiles if one.title == "Critical speeds")
        self.assertEqual((tile.verdict, tile.text), ("NOT COMPUTED", "no solution"))
        self.assertIn("程序信息（英文原文）：no solution", language.Language("zh")(tile.text))

    def test_probability(self):
        needs("h5py", "scipy", "openturns")
        self.scene = self.write("rig.toml", SCENE + STUDY)
        self.call("probability", self.scene, "-o", self.folder / "study", "--engine", "serial", "-q")
        studied = json.loads((self.folder / "study" / "summary.json").read_text(encoding="utf-8"))["estimates"]["pull"]
        out, page, summary = self.page("--probability", self.folder / "study")
        tiles = {one["title"]: one for one in summary["verdicts"]}
        tile = tiles["Probability: pull"]
        self.assertEqual(tile["verdict"], "NO LIMIT GIVEN")
        self.assertIn(f"{studied['failures']} of 12 samples fail, 0 have no result", tile["text"])
        self.assertIn(f"95 % interval {100 * studied['low']:.3g} % to {100 * studied['high']:.3g} %", tile["text"])
        with open(self.folder / "study" / "samples.csv", encoding="utf-8") as file:
            heads, *rows = (line.strip().split(",") for line in file)
        margins = sorted(float(row[heads.index("margin of pull")]) for row in rows)
        self.assertIn(f"smallest {verdict.shown(margins[0], 'N')}", tile["text"])
        self.assertIn(f"median {verdict.shown(margins[6], 'N')}", tile["text"])
        self.assertIn("by the static state of each sample", tile["text"])
        studied = json.loads((self.folder / "study"
                              / "summary.json").read_text(encoding="utf-8"))["demands"]["pull"]["percentiles"]["P95"]
        self.assertIn(f"the demand is {verdict.shown(studied['value'], 'N')} or less severe, "
                      f"{100 * studied['share']:.3g} % of the limit", tile["text"])
        self.assertIn("Margins of the study", page)
        self.assertIn("Probability: any failure", out)
        self.assertChinese(self.words(self.page("--probability", self.folder / "study", "--language",
                                                "zh")[1]).replace("pull", "").replace("study", ""))

    def test_margins_that_are_infinite_or_not_known(self):
        """A string that locks up has the smallest margin there is; a sample without one of its margins has no smallest
        one; limits that vary are named."""
        self.assertEqual(report_probability._known([-math.inf, math.nan, 1.0]), [-math.inf, 1.0])
        for row in ((0.5, math.nan), (math.nan, -1.0)):
            self.assertTrue(math.isnan(report_probability._least(row)))
        demand = {"percentiles": {"P95": {"value": 900.0, "share": 0.9}}}
        one = report_probability.Outcome("pull", {}, "N", 1e3, [-math.inf, 100.0, 200.0], demand=demand)
        self.assertIn("median 100 N, smallest -∞", str(one.margin_text(unit_systems.SI)))
        drawn = dataclasses.replace(one, demand={**demand, "limit_varies": True})
        for known, wanted in ((one, False), (drawn, True)):
            for text in (known.margin_text(unit_systems.SI), known.percentile_text(unit_systems.SI)):
                self.assertEqual("which varies" in str(text), wanted)
                self.assertChinese(language.Language("zh")(text))
        figure = report_probability.Probability("study", [one]).figures()[0][2]["data"][0]
        self.assertEqual((list(figure["x"]), list(figure["y"])), ([0.1, 0.2], [0.666667, 1.0]))

    def test_probability_of_another_scene(self):
        needs("h5py", "scipy", "openturns")
        self.scene = self.write("rig.toml", SCENE + STUDY)
        self.call("probability", self.scene, "-o", self.folder / "study", "--engine", "serial", "-q", "--samples", "2")
        other = self.write("other.toml", (SCENE + STUDY).replace('"2 kN"', '"3 kN"'))
        text = self.call("report", other, "-o", self.folder / "x", "--probability", self.folder / "study", status=2)
        self.assertIn("is a study of another scene", text)
        self.assertIn("no complete study", self.call("report", other, "-o", self.folder / "x", "--probability",
                                                     self.folder / "none", status=2))
        before = (self.folder / "study" / "summary.json").read_bytes()
        self.assertIn("give another --output", self.call("report", self.scene, "-o", self.folder / "study",
                                                         "--probability", self.folder / "study", status=2))
        self.assertEqual((self.folder / "study" / "summary.json").read_bytes(), before)

    def test_no_failure_seen_is_no_zero(self):
        from drillmbd.report_probability import Outcome, amount
        one = Outcome("x", {"probability": 0.0, "low": 0.0, "high": 0.26, "confidence": 0.95, "failures": 0,
                            "samples": 12, "lost": 0})
        self.assertEqual(one.value, "at most 26 %")
        lost = Outcome("x", {"probability": None, "low": 0.0, "high": 1.0, "confidence": 0.95, "failures": 0,
                             "samples": 12, "lost": 12})
        self.assertEqual(lost.value, "not computed")
        si = unit_systems.Units()
        self.assertEqual([amount(1500.0, unit, si) for unit in ("N", "-", "s", "m/s2")],
                         ["1.5 kN", "1.5e+03", "1.5e+03 s", "1.5e+03 m/s2"])


if __name__ == "__main__":
    unittest.main()
