"""Set-up that the tests share: packages that a test cannot do without, a folder with a scene, the command in this
process."""
import contextlib
import importlib
import io
import json
import os
import pathlib
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
COMMAND = (sys.executable, "-W", "ignore", "-m", "drillmbd")
ENVIRONMENT = {**os.environ, "PYTHONPATH": str(HERE), "OMP_NUM_THREADS": "1"}
# Pieces of scenes: eight eccentric pipes with a bit, the drives of a rig head that stays in place and turns, its
# rotation, and a worn gear that follows it; all in one hole.
SHORT_STRING = """[[string]]
name = "main"
[[string.pipes]]
count = 8
eccentricity = "1 mm"
[[bit]]
name = "bit"
diameter = 0
"""
DRIVES = """[[drive]]
name = "feed"
time_function = "0 m/s"
[[drive]]
name = "head"
component = "rx"
time_function = "turning"
"""
TURNING = """[[time_function]]
name = "turning"
segment = {kind = "step", x1 = "20 ms", h1 = "100 rpm"}
"""
WORN = """[[time_function]]
name = "worn"
segment = {kind = "per-revolution", of = "turning", share = "5 %", order = 3}
"""
SHORT_RIG = '[hole]\ndiameter = "94 mm"\n' + SHORT_STRING + TURNING + DRIVES


def needs(*names):
    """Skips the file where a package is not installed."""
    for name in names:
        try:
            importlib.import_module(name)
        except ImportError as missing:
            raise unittest.SkipTest(f"not there: {missing.name}") from missing


class FolderTest(unittest.TestCase):
    """A folder of its own for each test, with a scene in it."""
    SCENE = ""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.scene = self.write("rig.toml", self.SCENE)

    def write(self, name, text):
        (self.folder / name).write_text(text, encoding="utf-8")
        return self.folder / name

    def results(self, command, *more):
        """Output and summary of a command on the scene, whose files are there."""
        output = self.folder / "out"
        out = self.call(command, self.scene, "--output", output, *more)
        summary = json.loads((output / "summary.json").read_text(encoding="utf-8"))
        for name in summary["files"]:
            self.assertGreater((output / name).stat().st_size, 30, name)
        return out, summary

    def call(self, *words, status=0):
        """The command in this process, which has loaded the packages: its output, or its errors where it fails."""
        from drillmbd.command import main
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            try:
                found = main([str(word) for word in words])
            except SystemExit as stop:  # argparse
                found = stop.code
        self.assertEqual(found, status, out.getvalue() + err.getvalue())
        return out.getvalue() if status == 0 else err.getvalue()
