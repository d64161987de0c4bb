"""Tests of all commands alike: on every shipped scene, with the same warnings, statuses and summaries, after Ctrl-C and
after failures."""
import importlib.util
import json
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import time
import unittest
from unittest import mock

from shared_tests import COMMAND, ENVIRONMENT, HERE, FolderTest, needs
from test_command import SCENE

needs("numpy")
ROOT = HERE.parents[1]
SHIPPED = [*sorted((ROOT / "examples" / "scenes").glob("*.toml")),
           *sorted((ROOT / "examples" / "failure_probability").glob("*.toml"))]
#: Short settings in the place of those of the shipped scenes.
SHORT = ((r'(\[run\]\nend =) "[^"]*"', r'\1 "20 ms"'), (r"(?m)^points = \d+", "points = 5"),
         (r'"2 s"(?=\s*#? ?\n|$)', '"2 s"'),
         (r'(?m)^from = "2 s"', 'from = "5 ms"'),
         # test_command.py follows the paths of buckling
         (r"(\[buckling\].*\nscale = .*\n)(?!follow)", r"\1follow = false\n"))
COMMANDS = (("check",), ("static",), ("run", "--until", "10 ms"), ("modes", "--count", "2"), ("response",), ("speeds",),
            ("buckle",),
            ("torque-drag", "--depths", "2"), ("stuck", "--pull", "20 kN"), ("rod-by-rod",),
            ("sweep", "check", "--vary", "hole.mu_dynamic=0.1,0.2"),
            ("probability", "--samples", "1", "--method", "monte-carlo", "--engine", "serial"))
# nothing holds the string along its axis
LOOSE = SCENE.replace('[[drive]]\nname = "feed"\ntime_function = "0 m/s"\n', "")
HEAVY = SCENE.replace("count = 8", "count = 3000").replace('end = "20 ms"', 'end = "200 s"') + """[buckling]
scale = "all"
[variability]
[[variability.scatter]]
key = "hole.mu_dynamic"
distribution = "uniform"
low = 0.1
high = 0.3
[[failure]]
kind = "rig-torque"
limit = "1 N m"
"""


@unittest.skipUnless(SHIPPED, "not there: the shipped scenes")
class ShippedTest(FolderTest):
    """All commands on all shipped scenes."""

    def setUp(self):
        super().setUp()
        for path in ROOT.glob("examples/scenes/*.csv"):
            shutil.copy(path, self.folder)

    def short(self, path):
        text = path.read_text(encoding="utf-8")
        for pattern, new in SHORT:
            text = re.sub(pattern, new, text)
        return self.write(path.name, text)

    def test_every_command(self):
        """Status 0, a result, no traceback, and each warning of the scene as a note."""
        from drillmbd import scene
        from drillmbd.scene.warned import warnings_of
        for path in SHIPPED:
            short = self.short(path)
            known = [f"note: {text}\n" for text in warnings_of(scene.load(short))]
            for words in COMMANDS:
                with self.subTest(scene=path.name, command=words[0]):
                    out = self.call(words[0], short, *words[1:])
                    self.assertGreater(len(out), 40)
                    self.assertNotIn("Traceback", out)
                    self.assertEqual([text for text in known if text not in out], [])

    def test_report_save_and_unit(self):
        for path in SHIPPED:
            short = self.short(path)
            self.assertIn("[sim]", self.call("save", short, "-"))
            try:
                import plotly.offline  # noqa: F401
                self.call("report", short, "-o", self.folder / "report")
                self.assertTrue((self.folder / "report" / "report.html").exists())
            except ImportError:
                pass
            unit = self.folder / "x.fmu"
            process = subprocess.run([*COMMAND, "fmu", short, "-o", unit], capture_output=True, text=True,
                                     env=ENVIRONMENT)
            if process.returncode == 2 and "is not there; build" in process.stderr:
                continue  # a build without it
            self.assertEqual((process.returncode, process.stderr), (0, ""))

    def test_warnings_have_a_cause(self):
        """Each cause of a warning, alone, is warned of; reference rig: of none, its load of the bit ends before the run
        does."""
        from drillmbd import scene
        from drillmbd.scene.warned import warnings_of
        path = next(path for path in SHIPPED if path.stem == "reference_rig")
        text = path.read_text(encoding="utf-8")
        self.assertEqual(warnings_of(scene.loads(text)), [])
        for old, new, told in (('eccentricity = "1 mm"', "", "no eccentricity"),
                               ('damping_time = "0.1 ms"', "damping_time = 0", "no material damping"),
                               ('h1 = "2960 N"', "h1 = 0", "no load on the bit"),
                               ('h1 = "200 rpm"', "h1 = 0", "no rotation"),
                               ('"94 mm"', '"94 m"', "diameter = 94 m, which is unusual"),
                               ('"94 mm"', '"94 in"', "pipes of 73 mm are narrow for their hole of 2388 mm"),
                               ('h1 = "200 rpm"', 'h1 = "200 rad/s"', "rotation of up to"),
                               ('h1 = "200 rpm"', 'h1 = "-200 rad/s"', "rotation of up to"),
                               ('eccentricity = "1 mm"', 'eccentricity = "20 mm"', "eccentricity = 0.02 m, which is"),
                               ('h1 = "2960 N"', 'h1 = "300 kg"', "a unit of mass: its weight is taken"),
                               ('length = "1 m"', 'length = "10 m"', "divided into")):
            changed = text.replace(old, new).replace(old.replace('"', '"-', 1), new)
            found = warnings_of(scene.loads(changed))
            self.assertTrue(any(told in one for one in found), (old, found))
        inline = '[hole]\ndiameter = "94 mm"\n[[string]]\n[[string.pipes]]\ncount = 2\n[[bit]]\nload = "300 kg"\n'
        self.assertTrue(any('load = "300 kg": has \'kg\', a unit of mass: its weight is taken' in one
                            for one in warnings_of(scene.loads(inline))))
        rock = text.replace('h1 = "2960 N"', "h1 = 0").replace('h1 = "-2960 N"',
                                                               "h1 = 0").replace('mass = "5 kg"\n',
                                                                                 'mass = "5 kg"\nrock_law = '
                                                                                 '"regenerative"\n')
        self.assertEqual([one for one in warnings_of(scene.loads(rock)) if "no load on the bit" in one], [])

    def test_signs_of_load_and_feed(self):
        """A load below 0 and a feed out of the hole are shown with their sign and warned of, and are no operation."""
        from drillmbd import scene
        from drillmbd.operating import operating
        from drillmbd.scene.warned import warnings_of
        from drillmbd.scene.words import describe
        text = ('hole = {diameter = "94 mm"}\nstring = {pipes = {count = 3, pipe = "phi 73 x 6"}}\nbit = {load = '
                '"%s"}\ndrive = {component = "x", time_function = "%s"}\n')
        for load, feed, expected, weight, speed in (
                ("8 kN", "10 mm/s", [], 8e3, 0.01),
                ("-8 kN", "10 mm/s", ["the load on the bit falls to -8 kN"], 0.0, 0.01),
                ("8 kN", "-10 mm/s", ["the feed of -10 mm/s pulls"], 8e3, 0.0), ("0 kN", "-10 mm/s", [], 0.0, 0.0),
                ("8 kN", "2 m/s", ["feed of up to 2 m/s"], 8e3, 2.0), ("8 kN", "0 mm/s", [], 8e3, 0.0)):
            made = scene.loads(text % (load, feed))
            found = [one for one in warnings_of(made) if "the load on" in one or "feed of" in one]
            self.assertEqual(len(found), len(expected), (load, feed, found))
            for one, part in zip(found, expected):
                self.assertIn(part, one)
            plan = operating(made)
            self.assertEqual((plan.weight_on_bit, plan.feed), (weight, speed))
            if load != "0 kN":
                self.assertIn(f"{load} on the bit", str(describe(made, 0.0)[-1]))
            if feed == "-10 mm/s":
                self.assertIn(f"feed {feed}", str(describe(made, 0.0)[-1]))

    def test_narrow_bits(self):
        from drillmbd import scene
        from drillmbd.scene.warned import warnings_of
        text = ('hole = {diameter = "%s"}\nstring = {pipes = {count = 3, pipe = "phi 73 x 6"}}\n'
                'bit = {diameter = "%s"}\n')
        for hole, bit, expected in (("94 mm", "92 mm", None), ("94 in", "92 mm", "the bit of 92 mm is narrow"),
                                ("190 mm", "92 mm", "the bit of 92 mm is narrow"), ("180 mm", "92 mm", None),
                                ("94 in", "0 mm", "pipes of 73 mm are narrow"), ("500 mm", "0 mm", None)):
            found = [one for one in warnings_of(scene.loads(text % (hole, bit))) if "narrow" in one]
            self.assertEqual(len(found), int(expected is not None), found)
            self.assertTrue(expected is None or expected in found[0], found)

    def test_load_that_nothing_bears(self):
        """A load on the bit without a drive along the string pushes it out of the hole, in `run` with status 0."""
        from drillmbd import scene
        from drillmbd.scene.warned import warnings_of
        text = ('hole = {diameter = "94 mm"}\nstring = {pipes = {count = 3, pipe = "phi 73 x 6"}}\nbit = {load = '
                '"push"}\n'
                'time_function = [{name = "push", segment = {h0 = "10 kN"}}, {name = "feed", segment = {h0 = "10 '
                'mm/s"}}]\n%s')
        for drive, found in (("", 1), ('drive = {component = "x", time_function = "feed"}\n', 0)):
            told = [one for one in warnings_of(scene.loads(text % drive if drive else (text % "").replace(
                ', {name = "feed", segment = {h0 = "10 mm/s"}}', ""))) if "bears the load" in one]
            self.assertEqual(len(told), found, drive)


class NonsenseTest(FolderTest):
    """Nonsense is refused by each command with a line that names the fault; nothing is overwritten."""
    SCENE = SCENE + HEAVY[HEAVY.index("[variability]"):]

    def test_options(self):
        body = self.write("body.toml", '[[body]]\nmass = "3 kg"\n[run]\nend = "1 ms"\nstep = "1 ms"\n')
        for told, *words in (("more than 1e+12: give a longer step", "run", "--step", "1e-300 s"),
                             ("rows of 2 numbers", "run", "--until", "1e7 s"),
                             ("must be a length", "torque-drag", "--depths", "\u00b2"),
                             ("must be >= 0", "torque-drag", "--block-weight", "-1 kN"),
                             ("--weight-on-bit -1 kN: must be >= 0", "torque-drag", "--weight-on-bit", "-1 kN"),
                             ("--torque-on-bit -1 N m: must be >= 0", "torque-drag", "--torque-on-bit", "-1 N m"),
                             ("must be > 0", "stuck", "--pull", "-1 kN"), ("must be > 0", "stuck", "--torque", "0 N m"),
                             ("at most 1e+12", "stuck", "--push", "1e300 N"),
                             ("2^63 - 1", "probability", "--seed", "9" * 25),
                             ("2 .. 100000", "sweep", "check", "--vary", "hole.diameter=1 m:2 m:99999999999"),
                             ("2 .. 100000", "sweep", "check", "--vary", "hole.diameter=1 m:2 m:1e3"),
                             ("is empty", "check", "-o", "")):
            with self.subTest(words=words):
                self.assertIn(told, self.call(words[0], self.scene, *words[1:], status=2))
        for command in ("torque-drag", "stuck"):
            self.assertIn("is about a string, the scene has none", self.call(command, body, status=2))
        self.assertNotIn("no rotation", self.call("check", body))
        self.assertIn("is empty", self.call("check", "", status=2))

    def test_unit_replaces_no_device(self):
        """A target that is no file stays what it is."""
        import os
        from drillmbd import fmu
        pipe = self.folder / "pipe"
        os.mkfifo(pipe)
        with self.assertRaisesRegex(fmu.CannotExport, "folder or a device"):
            fmu._write(pipe, {"a": b"b"})
        self.assertTrue(pipe.is_fifo())

    def test_scenes(self):
        """Numbers without end, devices as files, and what varies along a hole that is not there."""
        for told, text in (("must be finite", f"[hole]\nmu_dynamic = {'1' * 400}\n"),
                           ("2: the file: has a number of too many digits", f"[hole]\nmu_dynamic = {'1' * 5000}\n"),
                           ("is a folder or a device", '[hole]\nsurvey_file = "/dev/zero"\n'),
                           ("is a device or a named pipe", 'catalogue = "/dev/zero"\n'),
                           ("the scene has no [hole]",
                            '[[variability.field]]\nname = "f"\nkeys = ["hole.mu_static"]\nrelative = '
                            'true\ndistribution = "lognormal"\n'
                            'mean = 1\ndeviation = "40 %"\ncorrelation_length = "10 m"\nspacing = "5 m"\nto = "300 '
                            'm"\n')):
            with self.subTest(text=text[:60]):
                self.assertIn(told, self.call("check", self.write("bad.toml", text), status=2))

    def test_missing_tables(self):
        """The least lines are enough."""
        bare = SCENE[:SCENE.index("[response]")]
        for command, more in (("response", ()), ("speeds", ()), ("buckle", ()),
                              ("probability", ("--samples", "1", "--engine", "serial"))):
            with self.subTest(command=command):
                lines = self.call(command, self.write("bare.toml", bare), *more, status=2).split("for example:\n")[1]
                self.call(command, self.write("more.toml", bare + lines), *more)


class PictureTest(unittest.TestCase):
    """Axes and curves that show what there is, and no rounding."""

    def setUp(self):
        needs("matplotlib")
        import matplotlib
        matplotlib.use("Agg")
        from matplotlib import pyplot

        from drillmbd import plots
        self.plots = plots
        self.addCleanup(pyplot.close, "all")

    def test_profile_at_rest(self):
        """Rounding of forces and torques stays near 0; a torque that friction could give fills its axis."""
        import numpy
        found = mock.Mock(depth=numpy.linspace(0, 100, 101), along=numpy.linspace(0, 100, 101),
                          axial_force=1e-9 * numpy.sin(numpy.arange(101)),
                          torque=1e-12 * numpy.cos(numpy.arange(101)), bending_moment=numpy.ones(101),
                          contact_depth=numpy.arange(3000.0) / 30,
                          contact_force=numpy.full(3000, 3.0))
        axial, torque, _, wall = self.plots.profile(found).axes
        self.assertGreaterEqual(axial.get_xlim()[1], 90.0)       # 1 % of 9 kN on the wall
        self.assertGreaterEqual(torque.get_xlim()[1], 4.5)
        # one artist for all contacts
        self.assertEqual((len(wall.patches), len(wall.collections), wall.get_xlim()[0]), (0, 1, 0.0))
        found.torque = 90.0 * numpy.cos(numpy.arange(101))
        self.assertLess(self.plots.profile(found).axes[1].get_xlim()[1], 110.0)

    def test_long_run(self):
        """Many swings are a band with their mean; few are the curve itself."""
        import numpy
        time = numpy.linspace(0.0, 60.0, 6001)
        for cycles, banded in ((20.0, False), (600.0, True)):
            values = 5.0 + numpy.sin(2.0 * numpy.pi * cycles * time / 60.0)
            axes = self.plots.history(numpy.column_stack([time, values]), ["time [s]", "torque [N m]"]).axes[0]
            self.assertEqual(len(axes.collections), int(banded))
            drawn = axes.get_lines()[0].get_ydata()
            self.assertLess(float(abs(drawn - 5.0).max()), 0.3 if banded else 1.01)
            if banded:
                edge = axes.collections[0].get_paths()[0].vertices[:, 1]
                self.assertEqual(edge.max(), values.max())
                self.assertEqual(edge.min(), values.min())

    def test_log_axis_of_less_than_two_decades(self):
        for low, high in ((0.9, 0.93), (0.02, 0.05), (1e-6, 1e-3)):
            figure = self.plots.severity([1.0, 2.0, 3.0], [low, high, high], [], 1.0)
            axes = figure.axes[0]
            figure.canvas.draw()
            below, above = axes.get_ylim()
            labels = [text.get_text() for which in ("major", "minor")
                      for place, text in zip(axes.yaxis.get_ticklocs(minor=which == "minor"),
                                             axes.get_yticklabels(which=which)) if below <= place <= above]
            self.assertGreaterEqual(len([text for text in labels if text]), 3, (low, high, labels))
            self.assertGreaterEqual(above / below, 9.99)


class EndTest(FolderTest):
    """The end of each command: done, failed, stopped."""
    SCENE = SCENE + '[buckling]\nscale = "all"\n[limits]\ntorque = "1 kN m"\n'

    def summary(self, name="out"):
        return json.loads((self.folder / name / "summary.json").read_text(encoding="utf-8"))

    def test_statuses_are_listed_once(self):
        from drillmbd.exit_status import STATUSES, text
        self.assertIn(text(), self.call("--help"))
        guide = ROOT / "examples" / "README.md"
        if guide.exists():
            table = dict(re.findall(r"^\| (\d+) \| (.*) \|$", guide.read_text(encoding="utf-8"), re.M))
            self.assertEqual(table, {str(status): about for status, about in STATUSES.items()})

    def test_summary_of_a_failure(self):
        """An analysis that fails leaves the reason, the status and the time."""
        loose = self.write("loose.toml", LOOSE)
        for command in ("static", "run"):
            error = self.call(command, loose, "-o", self.folder / command, status=1)
            found = self.summary(command)
            self.assertEqual(found["status"], 1)
            self.assertEqual(f"drillmbd: {found['error']}\n", error)
            self.assertIn("nothing holds it", error)
            self.assertGreater(found["elapsed_s"], 0.0)

    def test_every_command_stops(self):
        """Ctrl-C within an analysis: status 130, and a summary with what is known."""
        from drillmbd import commands
        for name in commands.COMMANDS:
            with mock.patch.dict(commands.COMMANDS, {name: mock.Mock(side_effect=KeyboardInterrupt)}):
                self.call(name, self.scene, "-o", self.folder / "out", status=130)
            found = self.summary()
            self.assertEqual((found["command"], found["status"]), (name, 130))
            self.assertIn("stopped by Ctrl-C", found["notes"][-1])
            self.assertGreater(found["elapsed_s"], 0.0)

    def test_stopped_within_an_exec(self):
        """Python ends by the signal where Ctrl-C came within an exec, though it was dealt with; the command has its own
        status still."""
        for end, status in (("program()", 130),):  # sys.exit(main()) has -2 there by Python 3.11
            self.write("stopped.py",
                       "import sys\nfrom drillmbd import commands\nfrom drillmbd.command import main, program\n"
                       f"commands.COMMANDS['check'] = lambda *_: exec('raise KeyboardInterrupt')\n{end}\n")
            process = subprocess.run([COMMAND[0], "-m", "stopped", "check", self.scene, "-o", self.folder / "out"],
                                     capture_output=True, text=True,
                                     env=ENVIRONMENT, cwd=self.folder)
            self.assertEqual((process.returncode, process.stderr), (status, ""))
            self.assertIn("stopped by Ctrl-C", process.stdout)
            self.assertEqual(self.summary()["status"], 130)

    def test_nobody_reads_on(self):
        """Behind "| head" the command ends with its status and without a word."""
        for words in (("keys", "string.pipes"), ("schema",), ("check", self.scene)):
            process = subprocess.Popen([*COMMAND, *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                       env=ENVIRONMENT)
            process.stdout.close()
            error = process.stderr.read()
            process.stderr.close()
            self.assertEqual((process.wait(timeout=120), error), (3, b""), words)

    def test_elapsed(self):
        """The time of the whole command, by the clock."""
        begun = time.perf_counter()
        self.call("run", self.scene, "-o", self.folder / "out")
        elapsed = time.perf_counter() - begun
        found = self.summary()
        self.assertEqual(found["status"], 0)
        self.assertLess(found["elapsed_s"], elapsed)
        self.assertGreater(found["elapsed_s"], 0.5 * elapsed)
        self.assertGreater(found["elapsed_s"], found["run"]["elapsed_s"])

    def test_sweep_goes_on(self):
        """Cases of the same settings are kept; of another scene, command or option they are computed again."""
        from drillmbd import commands
        words = ("sweep", self.scene, "stuck", "--vary", "hole.mu_dynamic=0.1:0.3:3", "-o", self.folder / "out", "--",
                 "--pull", "20 kN")
        real, seen = commands.COMMANDS["stuck"], []

        def stop_at_third(*arguments):
            seen.append(0)
            if len(seen) == 3:
                raise KeyboardInterrupt
            return real(*arguments)

        with mock.patch.dict(commands.COMMANDS, {"stuck": stop_at_third}):
            self.call(*words, status=130)
            found = self.summary()
            self.assertEqual((found["status"], found["computed"], found["cases"]), (130, 2, 3))
            out = self.call(*words)
        self.assertEqual(len(seen), 4)  # the third case alone
        self.assertEqual(out.count("as computed before"), 2)
        found, table = self.summary(), (self.folder / "out" / "sweep.csv").read_text()
        self.assertEqual((found["status"], found["computed"], found["kept"]), (0, 1, 2))
        shutil.rmtree(self.folder / "out")
        self.call(*words)
        self.assertEqual((self.folder / "out" / "sweep.csv").read_text(), table)
        self.assertIn("3 of 3 cases", self.call(*words[:-1], "30 kN"))
        self.assertEqual(self.summary()["kept"], 0)
        self.scene.write_text(self.scene.read_text().replace('"1 mm"', '"2 mm"'))
        self.call(*words[:-1], "30 kN")
        self.assertEqual(self.summary()["kept"], 0)

    def test_interrupted_imports(self):
        """Ctrl-C within the import of a package that catches everything ends the command all the same."""
        from drillmbd._optional import need
        self.write("swallows.py", "import os, signal\ntry:\n    os.kill(os.getpid(), signal.SIGINT)\n"
                                  "    sum(range(10**5))\nexcept BaseException:\n    raise ValueError\n")
        usual = signal.signal(signal.SIGINT, signal.default_int_handler)
        sys.path.insert(0, str(self.folder))
        try:
            with self.assertRaises(KeyboardInterrupt):
                need("swallows")
            self.assertIs(signal.getsignal(signal.SIGINT), signal.default_int_handler)
        finally:
            sys.path.remove(str(self.folder))
            signal.signal(signal.SIGINT, usual)

    def test_interrupted_processes(self):
        """Real processes in the middle of long analyses end within seconds."""
        heavy = self.write("heavy.toml", HEAVY)
        for words in (("static",), ("run",), ("modes",), ("response",), ("speeds",), ("buckle",),
                      ("torque-drag", "--depths", "500"), ("report",),
                      ("sweep", "static", "--vary", "hole.mu_dynamic=0.1,0.2"),
                      ("probability", "--engine", "processes", "--workers", "2")):
            if words[0] == "report" and importlib.util.find_spec("plotly") is None:
                continue  # it ends at once, since plotly draws its figures
            with self.subTest(command=words[0]):
                output = self.folder / words[0]
                process = subprocess.Popen([*COMMAND, words[0], heavy, *words[1:], "-o", output],
                                           stderr=subprocess.PIPE, stdout=subprocess.PIPE,
                                           env=ENVIRONMENT, text=True,
                                           preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler))
                begun = output / ("00001/scene.toml" if words[0] == "sweep" else "scene.toml")
                limit = time.monotonic() + 120.0
                while not begun.exists() and time.monotonic() < limit and process.poll() is None:
                    time.sleep(0.02)
                time.sleep(0.3)
                process.send_signal(signal.SIGINT)
                _, error = process.communicate(timeout=120)
                self.assertEqual(process.returncode, 130, error)
                self.assertNotIn("Traceback", error)
                found = json.loads((output / "summary.json").read_text(encoding="utf-8"))
                self.assertEqual(found["status"], 130)
                self.assertTrue(any("stopped by Ctrl-C" in note for note in found["notes"]), found["notes"])
                self.assertGreater(found["elapsed_s"], 0.0)
                shutil.rmtree(pathlib.Path(output))


if __name__ == "__main__":
    unittest.main()
