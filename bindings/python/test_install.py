"""Tests of the installed package: by pip into a virtual environment without network, and by cmake --install. Both find
their library without an environment variable. DRILLMBD_BUILD names the build folder."""
import importlib.util
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
BUILD = pathlib.Path(os.environ.get("DRILLMBD_BUILD", HERE.parents[1] / "build" / "release")).resolve()
PROGRAM = ("import drillmbd as m; model = m.Model(); model.add_pipes(2); model.compile(); sim = model.sim(); "
           "sim.step(1e-3); print(m.__file__, m.__version__, sim.time)")


def environment(**more):
    kept = {name: value for name, value in os.environ.items() if not name.startswith(("DRILLMBD_", "PYTHON"))}
    return {**kept, **more}


def run(*command, **more):
    done = subprocess.run(command, capture_output=True, text=True, cwd="/", env=environment(**more))
    if done.returncode != 0:
        raise AssertionError(f"{command}: {done.stdout}{done.stderr}")
    return done.stdout


class InstallTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def sources(self):
        """A copy: setuptools builds in the folder it installs."""
        shutil.copytree(HERE, self.folder / "python", ignore=shutil.ignore_patterns("__pycache__", "build", "*.egg-info"))
        return self.folder / "python"

    def test_pip(self):
        try:
            import ensurepip  # noqa: F401
            import setuptools  # noqa: F401
        except ImportError as error:
            self.skipTest(f"not there: {error.name}")
        run(sys.executable, "-m", "venv", "--system-site-packages", self.folder / "env")
        python = self.folder / "env" / "bin" / "python"
        run(python, "-m", "pip", "install", "--no-index", "--no-build-isolation", self.sources(),
            DRILLMBD_BUNDLE=str(BUILD / "libdrillmbd.so"))
        out = run(python, "-c", PROGRAM)
        self.assertIn(str(self.folder / "env"), out)
        self.assertIn("usage: drillmbd", run(self.folder / "env" / "bin" / "drillmbd", "--help"))
        self.finds_units(python, self.folder / "env")
        self.assertIn("drillmbd/scene/scene.schema.json", run(python, "-m", "pip", "show", "-f", "drillmbd"))
        self.assertIn("py.typed", run(python, "-m", "pip", "show", "-f", "drillmbd"))

    def finds_units(self, python, folder, **more):
        """The binary of co-simulation units is installed beside the library, where it was built."""
        if (BUILD / "drillmbd_fmu.so").exists() and importlib.util.find_spec("pint"):
            out = run(python, "-W", "ignore", "-c", "from drillmbd import fmu; print(fmu.find_binary())", **more)
            self.assertIn(str(folder), out)

    def test_pip_without_a_library_of_its_own(self):
        """It takes the one of DRILLMBD_LIBRARY, and says what is missing where there is none."""
        target = self.folder / "target"
        shutil.copytree(HERE / "drillmbd", target / "drillmbd", ignore=shutil.ignore_patterns("__pycache__"))
        out = run(sys.executable, "-c", PROGRAM, PYTHONPATH=str(target), DRILLMBD_LIBRARY=str(BUILD / "libdrillmbd.so"))
        self.assertIn(str(target), out)
        code = "import ctypes.util; ctypes.util.find_library = lambda name: None; import drillmbd"
        with self.assertRaisesRegex(AssertionError, "set DRILLMBD_LIBRARY"):
            run(sys.executable, "-c", code, PYTHONPATH=str(target))

    def manual(self, prefix):
        """The page names every command that the help does; bash completes them, their options and values."""
        page = (prefix / "share" / "man" / "man1" / "drillmbd.1").read_text(encoding="utf-8").replace("\\-", "-")
        commands = re.findall(r"^    ([a-z-]+)(?:  |$)", run(prefix / "bin" / "drillmbd", "--help"), re.M)
        self.assertIn("torque-drag", commands)
        for name in commands:
            self.assertIn(f".SS drillmbd {name}\n" if name != "schema" else f"\\fB{name}\\fR", page)
        if shutil.which("man"):
            shown = subprocess.run(["man", "--warnings", "-l", prefix / "share" / "man" / "man1" / "drillmbd.1"],
                                   capture_output=True, text=True, env=environment(MANWIDTH="100", LC_ALL="C.UTF-8"))
            self.assertEqual(shown.stderr, "")
            self.assertIn("--weight-on-bit FORCE", shown.stdout)
        source = prefix / "share" / "bash-completion" / "completions" / "drillmbd"
        for words, wanted in ((["drillmbd", "tor"], "torque-drag"), (["drillmbd", "run", "x.toml", "--un"], "--until"),
                              (["drillmbd", "probability", "--engine", "da"], "dask")):
            ask = f'. {source}; COMP_WORDS=({" ".join(words)}); COMP_CWORD={len(words) - 1}; _drillmbd; echo "${{COMPREPLY[@]}}"'
            self.assertEqual(run("bash", "-c", ask).strip(), wanted)

    def test_cmake(self):
        prefix = self.folder / "prefix"
        run("cmake", "--install", str(BUILD), "--prefix", str(prefix))
        package = next(prefix.rglob("drillmbd/__init__.py"))
        out = run(sys.executable, "-c", PROGRAM, PYTHONPATH=str(package.parents[1]))
        self.assertIn(str(prefix), out)
        self.finds_units(sys.executable, prefix, PYTHONPATH=str(package.parents[1]))
        self.manual(prefix)
        moved = self.folder / "elsewhere"
        prefix.rename(moved)
        self.assertIn("usage: drillmbd", run(moved / "bin" / "drillmbd", "--help"))
        run(sys.executable, "-c", PROGRAM, PYTHONPATH=str(moved / package.parents[1].relative_to(prefix)))


if __name__ == "__main__":
    unittest.main()
