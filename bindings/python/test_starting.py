"""Tests of the commands that a scene begins with: new writes scenes that load, keys lists every key with unit and
default."""
import contextlib
import io
import math
import pathlib
import re
import sys
import tempfile
import unittest

from shared_tests import needs

from drillmbd import scene
from drillmbd.command import main
from drillmbd.scene import keys, new


def said(*words):
    """Exit status, output and errors of the command."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        status = main(list(words))
    return status, out.getvalue(), err.getvalue()


class StartingTest(unittest.TestCase):
    def test_missing_module(self):
        """The message names the interpreter that misses it: another one may have it."""
        from drillmbd._optional import need
        with self.assertRaisesRegex(ImportError,
                                    f"nowhere.module is needed .* by {re.escape(sys.executable)}: "
                                    "pip install nowhere, .*"
                                    "install-packages command"):
            need("nowhere.module")

    def test_command_has_the_interpreter_of_the_packages(self):
        """Debian's packages are for /usr/bin/python3; the first python3 of PATH may be another one."""
        lines = (pathlib.Path(__file__).parent / "drillmbd-command").read_text(encoding="utf-8").splitlines()
        self.assertEqual(lines[0], "#!/usr/bin/python3")

    def test_new_scenes_load(self):
        for kind in new.OPTIONS:
            status, text, _ = said("new", kind, "--length", "200", "--rod", "73", "--bore", "59 mm")
            self.assertEqual(status, 0)
            self.assertEqual(scene.loads(text).remarks, [])
        self.assertIn('diameter = "8 1/2 in"', said("new", "well", "--hole", '8 1/2"')[1])

    def test_variability_of_new_scenes(self):
        """The lines about scatter load where their # are taken away, and a study has a result."""
        needs("numpy", "scipy")
        from drillmbd.probability.sample import DONE, SceneSample
        for kind in new.OPTIONS:
            text = said("new", kind)[1]
            before, after = text.split("drillmbd probability FILE\n")
            self.assertNotIn("\n[variability]", text)
            sample = SceneSample(before + "\n" + "".join(line.removeprefix("#").removeprefix(" ") + "\n"
                                                         for line in after.splitlines()))
            self.assertEqual(sample.soft.why, "")
            found = sample(0, [0.0] * sample.dimension)
            self.assertEqual((found.status, len(found.margins)), (DONE, 5), found.message)

    def test_values_below_zero(self):
        """A value that begins with a minus sign is no option."""
        for dip in ("-5deg", "-5", "-5 deg", "-.5deg"):
            self.assertIn('dip = "-', said("new", "drainage", "--dip", dip)[1])

    def test_the_example_of_a_study_loses_no_sample(self):
        """The lines that `probability` prints for a scene without [variability] suit a scene as `new` writes it."""
        needs("h5py", "scipy")
        with tempfile.TemporaryDirectory() as folder:
            target = pathlib.Path(folder, "hole.toml")
            self.assertEqual(said("new", "drainage", "-o", str(target))[0], 0)
            status, _, message = said("probability", str(target))
            self.assertEqual(status, 2)
            target.write_text(target.read_text(encoding="utf-8") + message[message.index("[variability]\n"):],
                              encoding="utf-8")
            status, out, _ = said("probability", str(target), "--question", "torque-drag", "--engine", "serial", "-o",
                                  str(pathlib.Path(folder, "out")))
            self.assertEqual(status, 0)
            self.assertIn("of 100;", out)
            self.assertNotIn("without a margin", out)

    def test_the_strength_that_torque_and_drag_asks_for(self):
        """With the commented limits of `new` the stress is not assessed; with the key that the message names it is."""
        text = re.sub(r"(?m)^# (\[limits\]|torque =|push =|pull =|yield_stress =)", r"\1", said("new", "drainage")[1])
        with tempfile.TemporaryDirectory() as folder:
            target = pathlib.Path(folder, "hole.toml")
            target.write_text(text, encoding="utf-8")
            out = said("torque-drag", str(target))[1]
            self.assertIn("give it in [[string.pipes]] (yield_stress of [limits] is compared by report and "
                          "probability)", out)
            target.write_text(text.replace("[[string.pipes]]\n", '[[string.pipes]]\nyield_strength = "550 MPa"\n'),
                              encoding="utf-8")
            status, out, _ = said("torque-drag", str(target))
            self.assertEqual(status, 0)
            self.assertNotIn("stress: not assessed", out)
            self.assertNotIn("limits of the rig: not assessed", out)

    def test_new_refuses(self):
        with tempfile.TemporaryDirectory() as folder:
            target = str(pathlib.Path(folder, "hole.toml"))
            self.assertEqual(said("new", "drainage", "-o", target)[0], 0)
            self.assertEqual(said("new", "drainage", "-o", target)[0], 3)  # never over a file that is there
        for words, part in ((("--dip", "5 m"), "--dip 5 m"), (("--dip", "95"), "within -90 deg .. 90 deg"),
                            (("--rod", "120 mm"), "must lie between"), (("--length", "1 m"), "times --rod-length"),
                            (("--length", "-5m"), "times --rod-length"), (("--rod", "0mm"), "must lie between"),
                            (("--dip", "-95deg"), "within -90 deg")):
            status, _, told = said("new", "drainage", *words)
            self.assertEqual(status, 2)
            self.assertIn(part, told)

    def test_new_from_a_survey(self):
        with tempfile.TemporaryDirectory() as folder:
            survey, target = pathlib.Path(folder, "dips.csv"), pathlib.Path(folder, "scenes", "hole.toml")
            target.parent.mkdir()
            survey.write_text("depth(m);dip(deg);azimuth(deg)\n0;5,0;92\n90;6,0;94,5\n180;3,2;96,4\n")
            self.assertEqual(said("new", "drainage", "--survey", str(survey), "--rods", "73", "-o", str(target))[0], 0)
            loaded = scene.load(target)
            # it rises
            self.assertAlmostEqual(loaded.model.hole(180.0).position[2], 180.0 * math.sin(math.radians(5.05)),
                                   delta=0.5)
            with loaded.new_sim() as sim:
                self.assertEqual(sim.torque_drag([0]).rows[0][0].depth, 180.0)
            self.assertIn("must be left out with --survey", said("new", "drainage", "--survey", str(survey), "--dip",
                                                                 "3")[2])
            survey.write_text("depth(m);dip(deg)\n0;5\n")
            self.assertIn("--survey", said("new", "drainage", "--survey", str(survey))[2])
            self.assertEqual(said("new", "drainage", "--survey", str(pathlib.Path(folder, "none.csv")))[0], 2)

    def test_rods_by_their_outer_diameter(self):
        for words, bore in ((("--rods", "73"), "59 mm"), (("--rods", "89 mm"), "75 mm"),
                            (("--rod", "63.5"), "49.5 mm")):
            text = said("new", "drainage", "--hole", "110", *words)[1]
            self.assertIn(f'inner_diameter = "{bore}"        # the wall is an assumption', text)
        self.assertNotIn("the wall is an assumption", said("new", "drainage", "--rod", "73", "--bore", "60")[1])

    def test_keys(self):
        self.assertLess(len(said("keys")[1]), 20000)
        for table, (_, usual) in keys.TABLES.items():
            status, text, _ = said("keys", table)
            self.assertEqual(status, 0)
            self.assertNotIn("DMB_", text)
            self.assertNotIn(" : ", text)  # "0 (default): none" is read as "0: none"
            self.assertNotIn("default nan", text)
            listed = [row[0] for row in keys.listed(table)]
            for key, _, _, meaning in keys.listed(table):  # in words of scene files, not of C
                self.assertNotRegex(meaning, r"\bdmb_|\.h\b|\b[A-Z]{2,}_[A-Z_]+|callback$", (table, key))
            self.assertEqual(listed[:len(usual.split())], usual.split())
            self.assertEqual(len(listed), len(set(listed)))
        self.assertRegex(said("keys", "string.pipes")[1], r"outer_diameter +\[m\], default 0.073 m")
        self.assertRegex(said("keys", "drive")[1], r'time_function +required: .* a constant, as "120 rpm"')
        self.assertRegex(said("keys", "speeds.order")[1], r"order +\[-\]: frequency over rotary speed, > 0")
        self.assertRegex(said("keys", "speeds.output")[1], r"quantity +one of displacement-x")
        self.assertEqual(said("keys", "pips")[0], 2)


if __name__ == "__main__":
    unittest.main()
