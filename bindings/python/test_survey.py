"""Tests of survey files as they come: separators, encodings, heads, units, LAS, Excel, missing and unsorted values,
dips, and the course of the hole against published positions: x north, y west, z up, azimuth clockwise seen from
above."""
import importlib.util
import math
import pathlib
import random
import tempfile
import unittest

import drillmbd as mbd
from drillmbd import scene
from drillmbd.scene import words

SCENE = """[hole]
diameter = "216 mm"
survey_file = "%s"
%s
[[string]]
[[string.pipes]]
count = 20
length = "9 m"
"""
ROWS = ((0, 0, 0), (100, 0, 0), (200, 10, 45), (300, 20, 45))
CSV = "depth [m],inclination [deg],azimuth [deg]\n0,0,0\n100,0,0\n200,10,45\n300,20,45\n"
LAS = """~Version
VERS.   2.0 : CWLS LOG ASCII STANDARD
WRAP.   NO  : One line per depth step
~Well
STRT.M  0   : first depth
NULL.  -999.25 : missing value
UWI.  100/01-02-003-04W5 : well
~Curve
DEPT.M      : Depth
GR  .GAPI   : Gamma
INCL.DEG    : Inclination
AZIM.DEG    : Azimuth
~ASCII
0 80 0 0
100 75 0 0
200 70 10 45
300 71 20 45
"""

# Name of the file: content. All describe ROWS.
SAME = {
    "ok.csv": CSV, "crlf.csv": CSV.replace("\n", "\r\n"), "mark.csv": "\ufeff" + CSV, "cr.csv": CSV.replace("\n", "\r"),
    "semicolon.csv": CSV.replace(",", ";"), "tabs.txt": CSV.replace(",", "\t"),
    "comment.csv": "# survey by MWD\n" + CSV,
    "title.csv": "Well A\nsurveyed 2024-03-01, magnetic\n\n" + CSV,
    "order.csv": "azimuth [deg],depth [m],inclination [deg]\n0,0,0\n0,100,0\n45,200,10\n45,300,20\n",
    "extra.csv": "No,MD (m),TVD (m),Inc (deg),Azi (deg),N/S "
                 "(m)\n1,0,0,0,0,0\n2,100,100,0,0,0\n3,200,199,10,45,6\n4,300,295,20,45,25\n",
    "many_columns.csv": "MD (m),Inc (deg),Azi (deg),TVD (m),N (m),E "
                        "(m),DLS\n0,0,0,0,0,0,0\n100,0,0,100,0,0,0\n200,10,45,199,6,6,3\n300,20,45,295,25,25,3\n",
    "unit_row.csv": "Measured Depth,Inclination,Azimuth\n(m),(deg),(deg)\n0,0,0\n100,0,0\n200,10,45\n300,20,45\n",
    "blanks.txt": "Measured Depth (m)   Inclination (deg)   Azimuth (deg)\n   0.00   0.0   0.0\n 100.00   0.0   0.0\n "
                  "200.00  10.0  45.0\n 300.00  20.0  45.0\n",
    "one_blank.txt": "MD (m) Inc (deg) Azi (deg)\n0 0 0\n100 0 0\n200 10 45\n300 20 45\n",
    "decimal.csv": "MD [m];Inc [°];Azi [°]\n0,00;0,0;0,0\n100,00;0,0;0,0\n200,00;10,0;45,000\n300,00;20,0;45,000\n",
    "decimal.txt": "MD[m]  Inc[deg]  Azi[deg]\n0,0  0,0  0,0\n100,0  0,0  0,0\n200,0  10,0  45,0\n300,0  20,0  45,0\n",
    "thousands.csv": 'MD [mm],Inc [deg],Azi [deg]\n0,0,0\n"100,000.0",0,0\n"200,000.0",10,45\n"300,000.0",20,45\n',
    "feet.csv": "MD (ft),Inc (deg),Azi (deg)\n" + "".join(f"{d / 0.3048!r},{i},{a}\n" for d, i, a in ROWS),
    "rad.csv": "MD (m),Inc (rad),Azi (rad)\n" + "".join(f"{d},{math.radians(i)!r},{math.radians(a)!r}\n"
                                                        for d, i, a in ROWS),
    "turned.csv": "MD (m),Inc (deg),Azi (deg)\n0,0,360\n100,0,720\n200,10,405\n300,20,-315\n",
    "empty.csv": "MD (m),Inc (deg),Azi (deg)\n0,0,\n100,0,\n200,10,45\n300,20,45\n",
    "bearing.csv": "Depth (m),Drift (deg),Bearing\n0,0,N0E\n100,0,N 0 E\n200,10,N 45 E\n300,20,N45°E\n",
    "dip.csv": "depth [m],dip [deg],azimuth [deg]\n0,-90,0\n100,-90,0\n200,-80,45\n300,-70,45\n",
    "chinese.csv": "孔深(m),井斜角(°),方位角(°)\n0,0,0\n100,0,0\n200,10,45\n300,20,45\n",
    "full_width.csv": "测点，孔深（米），倾角（度），方位角（度）\n1，0，-90，0\n2，100，-90，0\n3，200，-80，45\n4，300，-70，45\n".replace("，", ","),
    "slash.csv": "孔深/m,倾角/°,方位角/°\n0,-90,0\n100,-90,0\n200,-80,45\n300,-70,45\n",
    "blank_unit.csv": "孔深 m,仰角 °,方位 °\n0,-90,0\n100,-90,0\n200,-80,45\n300,-70,45\n",
    "down.csv": "孔深(m),俯角(°),方位角(°)\n0,90,0\n100,90,0\n200,80,45\n300,70,45\n",
    "plunge.csv": "depth [m],dip [deg] (down positive),azimuth [deg]\n0,90,0\n100,90,0\n200,80,45\n300,70,45\n",
    "down_only.csv": "depth [m],Dip (down),azimuth [deg]\n0,90,0\n100,90,0\n200,80,45\n300,70,45\n",
    "down_positive.csv": "depth [m],Dip (down positive),azimuth [deg]\n0,90,0\n100,90,0\n200,80,45\n300,70,45\n",
    "up_positive.csv": "depth [m],Dip (up positive),azimuth [deg]\n0,-90,0\n100,-90,0\n200,-80,45\n300,-70,45\n",
    "from_vertical.csv": CSV.replace("inclination [deg]", "Inclination (from vertical)"),
    "gon.csv": "Depth (m),Drift (gon),Bearing (gon)\n0,0,S 0 W\n100,0,N 0 E\n200,11.1111111111,N 50 E\n"
               "300,22.2222222222,N50E\n",
    "feet.las": LAS.replace("DEPT.M", "DEPT.F").replace("100 75",
                                                        f"{100 / 0.3048!r} 75").replace("200 70",
                                                                                        f"{200 / 0.3048!r} 70").replace(
        "300 71", f"{300 / 0.3048!r} 71"),
    "devi.las": LAS.replace("INCL.DEG", "DEVI.DEG").replace("AZIM.DEG", "HAZI.DEG"),
    "remark.csv": "MD (m),Inc (deg),Azi (deg)\n0,0,0,tie-in\n100,0,0\n200,10,45,good,\n300,20,45\n",
    "well.csv": "well,depth [m],inclination [deg],azimuth [deg]\nA,0,0,0\nA,100,0,0\nA,200,10,45\nA,300,20,45\n",
    "twice.csv": CSV.replace("200,10,45\n", "200,10,45\n200,10,45\n"),
    "log.las": LAS, "log.csv": LAS,
    "wrapped.las": LAS.replace("NO  :", "YES :").replace("200 70 10 45", "200\n70 10\n45"),
    "cells.csv": "MD,Inc,Azi\n0 m,0 deg,0 deg\n100 m,0°,0°\n200 m,10 deg,45 deg\n0.3 km,20 deg,45 deg\n"}

# Content, parts of the message.
REFUSED = (("depth [m],inclination [deg],azimuth [deg]\n0,0,0\n100,,\n200,10,45\n", ("line 3, column 2", "empty")),
           (CSV.replace("200,10,45", "200,-999.25,45"), ("line 4, column 2 (inclination [deg]) = \"-999.25\"",
                                                         "missing value")),
           (CSV.replace("200,10,45", "200,NaN,45"), ("line 4, column 2", "missing value")),
           (CSV.replace("200,10,45", "200,ten,45"), ("line 4, column 2", "\"ten\"", "no number")),
           (CSV.replace("200,10,45", "200,10,1e999"), ("line 4, column 3", "finite")),
           (CSV.replace("200,10,45", "200,10,1e9999999"), ("line 4, column 3", "finite")),
           (CSV.replace("200,10,45", "200,10,"), ("line 4", "azimuth is empty", "inclination 10 deg")),
           (CSV.replace("200,10,45", "50,10,45"), ("line 4", "50 m comes after 100 m (line 3)", "sort")),
           (CSV.replace("200,10,45", "100,10,45"), ("line 4", "100 m appears twice")),
           ("depth [m],inclination [deg],azimuth [deg]\n300,20,45\n200,10,45\n0,0,0\n", ("line 3", "reverse order")),
           (CSV.replace("200,10,45", "200,190,45"), ("line 4", "190 deg", "0 .. 180 deg")),
           (CSV.replace("200,10,45", "200,-5,45"), ("line 4", "dip (from the horizontal)")),
           (CSV.replace("200,10,45", "200;10;45").replace(",", ";").replace("200;", "1,200;"),
            ("line 4, column 1", "1200", "1.200")),
           ("MD,Inclination,Azimuth\n0,0,0\n100,0,0\n", ("MD", "has no unit", "survey_columns")),
           ("MD m,Incl. from vertical,Azi\n0,0,0\n100,0,0\n", ("no head names an inclination", "survey_columns")),
           ("a,b,c\n0,0,0\n100,0,0\n", ("line 1 (a, b, c)", "survey_columns")), ("", ("empty",)),
           ("depth [m],azimuth [deg]\n0,0\n100,0\n", ("inclination", "dip")),
           ("well,depth [m],inclination [deg],azimuth [deg]\nA,0,0,0\nA,100,0,0\nB,200,0,0\n", ("2 holes", "A, B")),
           ("MD [m],Inc [deg],Azi [deg]\n0,0,0,0,0,0\n10,5,1,5,45,0\n20,5,2,5,45,0\n", ("6 cells", "semicolons")),
           ("MD [m],Inc [deg],Azi [deg]\n0,0,0\n10,90,0\n20,90,180\n", ("line 4: the hole turns by 180 deg from line 3",
                                                                        "at most 143 deg")),
           (LAS.replace("-999.25 :", "-1 :").replace("200 70 10 45", "200 70 -1.000 45"),
            ("\"-1.000\"", "missing value")),
           (CSV.replace("200,10,45", "200," + "1" * 400 + "z,45"), ("111...\"",)),
           (CSV.replace("200,10,45", "1,200,10,45").replace("300,20,45", "1300,20,45"),
            ("line 4 has 4 cells below 3 heads", "as 1,000?")),
           ("MD [m],Inclination (from horizontal),Azi [deg]\n0,5,0\n100,5,0\n", ("no head names an inclination",)),
           ("孔深(m),倾角(下倾为正),方位角(°)\n0,5,0\n100,5,0\n", ("no head names an inclination",)),
           ("MD [m],Dip (%),Azi [deg]\n0,5,0\n100,5,0\n", ("column 2 (Dip (%)) is no angle in deg, rad or gon",)),
           ("MD [m],Dip [deg],Azi (mils)\n0,5,0\n100,5,1600\n", ("column 3 (Azi (mils)) is no angle",)),
           (CSV.replace("200,10,45", "200,10,N 120 E"), ("line 4, column 3", "more than 90 from N")),
           (LAS.replace("200 70 10 45", "200 70 -999.25 45"), ("-999.25", "missing value")))

# north, east, down [m] at measured depth, inclination, azimuth: minimum curvature, published by well-path software.
POSITIONS = ((0.0, 0.01, 0.0, 0.0, 0.0, 0.0), (302.3619048, 0.01, 0.0, 0.05277210744569916, 0.0, 302.3619001947901),
             (304.8, 1.5, 225.0, 0.0304191361568411, -0.022565747500432352, 304.7997182081437),
             (335.28, 1.5, 215.0, -0.5784625680354337, -0.5334781609187639, 335.269326362587),
             (365.76, 1.5, 210.0, -1.250741977379501, -0.9617673795650964, 365.7388948811014),
             (396.24, 1.5, 200.0, -1.9711104035856784, -1.2976806933981009, 396.2085030355447))


def load(name, data, more=""):
    """The scene with a survey file of these bytes or this text."""
    with tempfile.TemporaryDirectory() as folder:
        pathlib.Path(folder, name).write_bytes(data if isinstance(data, bytes) else data.encode("utf-8"))
        return scene.loads(SCENE % (name, more), folder=folder)


class SurveyTest(unittest.TestCase):
    def setUp(self):
        self.expected = load("ok.csv", CSV)

    def same(self, found, name):
        for depth in (50.0, 150.0, 250.0, 300.0, 400.0):
            for a, b in zip(found.model.hole(depth).position, self.expected.model.hole(depth).position):
                self.assertAlmostEqual(a, b, 9, name)

    def test_files_as_they_come(self):
        for name, text in SAME.items():
            self.same(load(name, text), name)

    def test_encodings(self):
        self.same(load("latin.csv",
                       "Profondeur mesurée;x\nDepth (m);Inclinaison (°);Azimut "
                       "(°)\n0;0;0\n100;0;0\n200;10;45\n300;20;45\n".encode("latin-1")), "latin-1")
        self.same(load("gb.csv", SAME["chinese.csv"].encode("gb18030")), "GB 18030")
        self.same(load("utf16.csv", SAME["tabs.txt"].encode("utf-16")), "UTF-16")

    def test_excel(self):
        if not importlib.util.find_spec("openpyxl"):
            self.skipTest("not there: openpyxl")
        import openpyxl
        book = openpyxl.Workbook()
        book.active.append(["Well A"])
        for row in (["MD (m)", "Inc (deg)", "Azi (deg)", "remark"], *ROWS):
            book.active.append(list(row))
        with tempfile.TemporaryDirectory() as folder:
            book.save(pathlib.Path(folder, "s.xlsx"))
            self.same(scene.loads(SCENE % ("s.xlsx", ""), folder=folder), "Excel")
        book.active["A4"] = "=50*2"
        with tempfile.TemporaryDirectory() as folder:
            book.save(pathlib.Path(folder, "s.xlsx"))
            with self.assertRaisesRegex(scene.SceneError,
                                        "line 4, column 1 .MD .m.. = .=50.2.: is a formula without a value"):
                scene.loads(SCENE % ("s.xlsx", ""), folder=folder)
        with self.assertRaisesRegex(scene.SceneError, "save it as .xlsx or CSV"):
            load("old.csv", b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + b"\0" * 100)

    def test_refused(self):
        for text, parts in REFUSED:
            with self.assertRaises(scene.SceneError, msg=text) as caught:
                load("s.csv", text)
            self.assertEqual(len({one.line for one in caught.exception.problems}), 1)
            for part in parts:
                self.assertIn(part, str(caught.exception), text)

    def test_damaged_files(self):
        """Bytes that are changed, added or lost: a scene or a SceneError, nothing else."""
        draw = random.Random(5)
        texts = [text.encode("utf-8") for text in SAME.values()]
        for number in range(200):
            data = bytearray(draw.choice(texts))
            for _ in range(draw.randint(1, 6)):
                at = draw.randrange(len(data))
                data[at:at + draw.randint(0, 12)] = draw.choice([b"", b'"', b"\0", b"1e999", b"nan", b"~A\n", b"\n\n",
                                                                 b",,,,", b"\xff", b"{", b";"])
            try:
                load(draw.choice(["s.csv", "s.las", "s.txt"]) if number % 40 else "s.xlsx", bytes(data))
            except scene.SceneError:
                pass

    def test_one_fault_each_line(self):
        with self.assertRaises(scene.SceneError) as caught:
            load("s.csv", CSV.replace("100,0,0", "100,,").replace("200,10,45", "200,-999.25,45"))
        self.assertEqual(len(caught.exception.problems), 2)

    def test_columns_of_the_scene_file(self):
        rows = "0 0 0 x\n100 0 0 y\n200 10 45 z\n300 20 45 u\n"
        self.same(load("bare.txt", rows, 'survey_columns = ["depth [m]", "inclination [deg]", "azimuth [deg]"]'),
                  "without heads")
        openworks = "Well          MD      Inclination     Azimuth   TVD\nW1   0.00   0.00   0.00   0.0\n" \
                    "W1   100.00   0.00   0.00   100.0\n" \
                    "W1   200.00   10.00   45.00   199.0\nW1   300.00   20.00   45.00   295.0\n"
        self.same(load("open.csv", openworks, 'survey_columns = ["well", "MD [m]", "Inclination", "Azimuth"]'),
                  "OpenWorks")
        with self.assertRaisesRegex(scene.SceneError, "line 3 has 4 cells below 3 heads"):
            load("bare.csv", "0,0,0\n100,0,0\n1,200,10,45\n",
                 'survey_columns = ["depth [m]", "inclination [deg]", "azimuth [deg]"]')
        more = "".join(line.replace(" x", "").replace(" y", "").replace(" z", "").replace(" u", "").replace(" ", ",")
                       + ",7\n" for line in rows.splitlines())
        self.same(load("bare.csv", more, 'survey_columns = ["depth [m]", "inclination [deg]", "azimuth [deg]"]'),
                  "more columns")
        for wrong, part in (("3", "array of heads"), ('["depth [m]"]', "must name depth"),
                            ('["a", "b", "c"]', "must name depth")):
            with self.assertRaisesRegex(scene.SceneError, part):
                load("bare.txt", rows, "survey_columns = " + wrong)

    def test_columns_against_the_heads_of_the_file(self):
        """survey_columns that name fewer columns than the file has, or another unit than its heads."""
        rows = "No,MD (ft),Drift,Dir,By\n1,0,80,10,x\n2,60,82,11,x\n3,120,84,12,x\n"
        for columns, expected in (('"", "depth [ft]", "inclination [deg]", "azimuth [deg]", ""', []),
                              ('"", "depth [m]", "inclination [deg]", "azimuth [deg]", ""',
                               ["column 2 (MD (ft)) is read in m, as survey_columns says"]),
                              ('"", "depth [ft]", "inclination [deg]", "azimuth [deg]"',
                               ["survey_columns names 4 of 5 columns"]),
                              ('"depth [m]", "inclination [deg]", "azimuth [deg]"',
                               ["depth is column 1 (No), inclination is column 2 (MD (ft)), azimuth is column 3"])):
            found = [one.text for one in load("s.csv", rows, f"survey_columns = [{columns}]").remarks
                     if "bends by" not in one.text and "tie-in" not in one.text]
            self.assertEqual(len(found), len(expected), found)
            for one, part in zip(found, expected):
                self.assertIn(part, one)

    def test_remarks(self):
        def told(text, more=""):
            return " | ".join(one.text for one in load("s.csv", text, more).remarks)

        self.assertIn("line 5 repeats line 4 (200 m)", told(SAME["twice.csv"]))
        self.assertIn("begins at 50 m (tie-in)", told("depth [m],inclination [deg],azimuth [deg]\n50,1,30\n100,2,40\n"))
        self.assertIn("are they radians", told("depth [m],inclination [deg],azimuth [deg]\n0,1.57,0.1\n100,1.6,0.12\n"))
        self.assertIn("are the depths feet", told("MD (m),inc (deg),azi (deg)\n0,0,0\n93,1,0\n186,2,0\n"))
        self.assertIn("deg/30 m between 100 m and 110 m",
                      told("MD (m),inc (deg),azi (deg)\n0,0,0\n100,1,0\n110,40,0\n"))
        self.assertIn("has no unit: deg is assumed", told("MD (m),inc,azi\n0,0,0\n100,1,0\n"))
        for name in ("ok.csv", "dip.csv", "log.las", "feet.csv", "chinese.csv", "turned.csv"):
            self.assertEqual(load(name, SAME[name]).remarks, [], name)

    def test_columns_that_are_not_read(self):
        """A second azimuth, or the depth in another unit, is named."""
        def told(text):
            return " | ".join(one.text for one in load("s.csv", text).remarks)

        self.assertIn("column 4 (Azi Grid [deg]) is not read: the azimuth is column 3 (Azi Magn [deg])",
                      told("MD [m],Inc [deg],Azi Magn [deg],Azi Grid [deg]\n0,0,0,5\n100,1,20,25\n"))
        self.assertIn("column 4 (MD [ft]) is not read: the depth is column 1",
                      told("MD [m],Inc [deg],Azi [deg],MD [ft]\n0,0,0,0\n100,1,20,328\n"))
        self.assertIn("280 deg is read", told("MD [m],Inc [deg],Azi [deg]\n0,90,1000000\n100,90,280\n"))

    def test_depths_of_nines(self):
        """999 and 9999 are depths; as angles they are missing values."""
        rows = "".join(f"{depth},{10.0 + 1e-4 * depth},0\n" for depth in range(0, 10001, 1))
        self.assertEqual(load("s.csv", "MD [m],Inc [deg],Azi [deg]\n" + rows).remarks, [])
        with self.assertRaisesRegex(scene.SceneError, "missing value"):
            load("s.csv", "MD [m],Inc [deg],Azi [deg]\n0,0,0\n999,999,0\n")

    def test_dips(self):
        """A hole of dip 5 deg rises; rows of the scene file and a straight hole alike."""
        rises = load("s.csv", "depth [m],dip [deg],azimuth [deg]\n0,5,0\n100,5,90\n").model.hole(100.0)
        self.assertGreater(rises.position[2], 8.0)
        self.assertLess(rises.position[1], 0.0)
        self.assertAlmostEqual(rises.inclination, math.radians(95.0), 12)
        self.assertAlmostEqual(rises.azimuth, math.radians(90.0), 12)
        inline = SCENE.replace('survey_file = "%s"\n%s',
                               'survey_columns = ["depth", "azimuth", "dip"]\nsurvey = [["0 m", 0, "5 deg"], ["9 m", '
                               '0, "5 deg"]]')
        self.assertAlmostEqual(scene.loads(inline).model.hole(9.0).position[2], 9.0 * math.sin(math.radians(5.0)), 12)
        both = SCENE.replace('survey_file = "%s"\n%s', 'survey_columns = ["depth", "dip", "inclination", "azimuth"]\n'
                             'survey = [["0 m", "-10 deg", "80 deg", 0], ["9 m", "-10 deg", "80 deg", 0]]')
        self.assertAlmostEqual(scene.loads(both).model.hole(9.0).position[2], -9.0 * math.sin(math.radians(10.0)), 12)
        self.assertIn("the inclination is read", scene.loads(both).remarks[0].text)
        straight = SCENE.replace('survey_file = "%s"\n%s', 'dip = "5 deg"\nazimuth = "30 deg"')
        point = scene.loads(straight).model.hole(10.0)
        self.assertAlmostEqual(point.position[2], 10.0 * math.sin(math.radians(5.0)), 12)
        self.assertAlmostEqual(point.azimuth, math.radians(30.0), 12)
        self.assertLess(point.position[1], 0.0)
        for wrong in ('dip = "5 deg"\ninclination = "85 deg"', 'dip = "5 deg"\ndirection = [1, 0, 0]'):
            with self.assertRaisesRegex(scene.SceneError, "must be left out"):
                scene.loads(SCENE.replace('survey_file = "%s"\n%s', wrong))


class WordsTest(unittest.TestCase):
    def test_the_scene_in_words(self):
        text = SCENE % ("s.csv", "") + \
            'damping_time = 0\n[[bit]]\nload = "8 kN"\n[[drive]]\ncomponent = "rx"\n' \
            'time_function = "130 rpm"\n[run]\nend = "1 s"\nstep = "2 ms"\n'
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, "s.csv").write_text("depth [m],dip [deg],azimuth [deg]\n0,5,350\n100,5,0\n200,4,10\n",
                                                     encoding="utf-8")
            rig = scene.loads(text, folder=folder)
        told = "; ".join(words.describe(rig, 1000.0))
        for part in ("collar at dip +5.0 deg (rises), azimuth 350 deg", "surveyed length 200 m",
                     "right of its line",
                     "between 100 m and 200 m", "20 pipes of 9 m", "reach 180 m", "weight 9.81 kN", "in a 216 mm hole",
                     "rotation 130 rpm", "8 kN on the bit",
                     "time step 2 ms"):
            self.assertIn(part, told)
        self.assertEqual([one.split(":")[0] for one in words.trivial(rig)],
                         ["no eccentricity of the pipes",
                          "no material damping of the pipes"])
        bare = scene.loads(SCENE.replace('survey_file = "%s"\n%s', 'direction = [0, 0, -1]'))
        self.assertIn("inclination 0 deg from the downward vertical", words.describe(bare, 0.0)[0])
        self.assertIn("no rotation", words.trivial(bare)[0])
        small = SCENE.replace('survey_file = "%s"\n%s',
                              "") + 'outer_diameter = "89 mm"\njoint_length = "0.1 m"\njoint_outer_diameter = "80 mm"\n'
        self.assertIn("is smaller than the pipe's outer_diameter", scene.loads(small).remarks[0].text)


class AzimuthTest(unittest.TestCase):
    def test_published_positions(self):
        model = mbd.Model()
        model.add_wall(diameter=0.2, stations=[(depth, math.radians(i), math.radians(a))
                                               for depth, i, a, *_ in POSITIONS])
        model.add_pipes(2, length=5.0)
        model.compile()
        for depth, _, azimuth, north, east, down in POSITIONS:
            point = model.hole(depth)
            for a, b in zip(point.position, (north, -east, -down)):
                self.assertAlmostEqual(a, b, 5)
            self.assertAlmostEqual(math.cos(point.azimuth - math.radians(azimuth)), 1.0, 9)

    def test_a_turning_string_climbs_to_the_right(self):
        """Turned clockwise seen from the rig, friction carries the string to the right, whichever way the hole
        turns."""
        def side(azimuth, spin):
            model = mbd.Model()
            model.add_wall(diameter=0.094, mu_dynamic=0.3, mu_static=0.3,
                           stations=[(d, math.pi / 2, math.radians(a))
                                     for d, a in ((0, 0), (10, 0), (110, azimuth), (150, azimuth))])
            string = model.add_pipes(40, length=3.0, outer_diameter=0.073, inner_diameter=0.061)
            turn = model.add_time_function(0.0)
            model.add_drive(component=mbd.X, time_function=turn)
            model.add_drive(component=mbd.RX, time_function=turn)
            model.compile()
            sim = model.sim()
            sim.static(**({"slip_rotation": spin, "slip_axial": 1e-6} if spin else {}))
            position, axis = sim.pose(mbd.station(string, 20, 0.5)).position, model.hole(61.5)
            left = (-axis.tangent[1], axis.tangent[0])
            return sum((position[i] - axis.position[i]) * left[i] for i in range(2))

        for azimuth in (30, -30):
            self.assertLess(side(azimuth, 10.0), side(azimuth, 0.0) - 1e-3)  # left is positive


if __name__ == "__main__":
    unittest.main()
