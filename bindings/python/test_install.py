"""Tests of the installed package: by pip into a bare virtual environment without network, setuptools or wheel, by the
command that README has, and by cmake --install. Both find their library without an environment variable. DRILLMBD_BUILD
names the build folder."""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
import unittest
import unittest.mock
import zipfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
BUILD = pathlib.Path(os.environ.get("DRILLMBD_BUILD", ROOT / "build" / "release")).resolve()
PROGRAM = ("import drillmbd as m; model = m.Model(); model.add_pipes(2); model.compile(); sim = model.sim(); "
           "sim.step(1e-3); print(m.__file__, m.__version__, sim.time)")


def environment(**more):
    kept = {name: value for name, value in os.environ.items() if not name.startswith(("DRILLMBD_", "PYTHON"))}
    return {**kept, **more}


def run(*command, cwd="/", **more):
    done = subprocess.run(command, capture_output=True, text=True, cwd=cwd, env=environment(PWD=str(cwd), **more))
    if done.returncode != 0:
        raise AssertionError(f"{command}: {done.stdout}{done.stderr}")
    return done.stdout


class InstallTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def readme_command(self):
        """Words of README's command. It builds the library by the preset user; here, ours is in its place."""
        line = re.search(r"^    pip (install .*)$", (ROOT / "README.md").read_text(encoding="utf-8"), re.M)
        return line.group(1).split()

    def test_pip(self):
        try:
            import ensurepip  # noqa: F401
        except ImportError as error:
            self.skipTest(f"not there: {error.name}")
        run(sys.executable, "-m", "venv", self.folder / "env")
        python, before = self.folder / "env" / "bin" / "python", sorted(HERE.iterdir())
        library = os.path.relpath(BUILD / "libdrillmbd.so", ROOT)
        subprocess.run([python, "-m", "pip", "uninstall", "-y", "setuptools"], capture_output=True, env=environment())
        run(python, "-m", "pip", *self.readme_command(), cwd=ROOT, DRILLMBD_BUNDLE=library)
        self.assertEqual([one for one in sorted(HERE.iterdir()) if one.name != "__pycache__"],
                         [one for one in before if one.name != "__pycache__"])  # nothing is built among the sources
        out = run(python, "-c", PROGRAM)
        self.assertIn(str(self.folder / "env"), out)
        self.assertIn("usage: drillmbd", run(self.folder / "env" / "bin" / "drillmbd", "--help"))
        files = run(python, "-m", "pip", "show", "-f", "drillmbd")
        for name in ("drillmbd/scene/scene.schema.json", "py.typed", "drillmbd/libdrillmbd.so"):
            self.assertIn(name, files)
        config = self.folder / "env" / "pyvenv.cfg"
        config.write_text(config.read_text().replace("packages = false", "packages = true"))
        self.finds_units(python, self.folder / "env")

    def test_backend(self):
        """It makes a wheel for this machine with the library, one for all without, the sources, a path to them."""
        sys.path.insert(0, str(HERE))
        self.addCleanup(sys.path.remove, str(HERE))
        import backend
        self.addCleanup(os.environ.pop, "DRILLMBD_BUNDLE", None)
        os.environ["DRILLMBD_BUNDLE"] = str(BUILD / "libdrillmbd.so")
        name = backend.build_wheel(self.folder)
        self.assertNotIn("-any", name)
        names = zipfile.ZipFile(self.folder / name).namelist()
        self.assertIn("drillmbd/libdrillmbd.so", names)
        self.assertIn("drillmbd/scene/catalogue.toml", names)
        os.environ["DRILLMBD_BUNDLE"] = "no/such.so"
        with self.assertRaisesRegex(SystemExit, "must be the file of a library that is built"):
            backend.build_wheel(self.folder)
        self.builds_the_library(backend)
        os.environ["DRILLMBD_BUNDLE"] = "none"
        name = backend.build_wheel(self.folder)
        self.assertTrue(name.endswith("-py3-none-any.whl"))
        wheel = zipfile.ZipFile(self.folder / name)
        wanted = {path.relative_to(HERE).as_posix() for path in (HERE / "drillmbd").rglob("*.py")}
        self.assertEqual({path for path in wheel.namelist() if path.endswith(".py")}, wanted)
        text = wheel.read(next(path for path in wheel.namelist() if path.endswith("METADATA"))).decode()
        self.assertIn('Requires-Dist: pandas; extra == "frames"', text)
        first = (self.folder / name).read_bytes()
        self.assertEqual(first, (self.folder / backend.build_wheel(self.folder)).read_bytes())
        with tarfile.open(self.folder / backend.build_sdist(self.folder)) as archive:
            self.assertTrue(any(path.endswith("/backend.py") for path in archive.getnames()))
        editable = zipfile.ZipFile(self.folder / backend.build_editable(self.folder))
        self.assertEqual(editable.read("drillmbd.pth").decode().strip(), str(HERE))

    def builds_the_library(self, backend):
        """Without the variable, CMake builds it where the sources are; here, a stand-in for cmake makes the files."""
        tree, tools = self.folder / "tree", self.folder / "tools"
        tools.mkdir()
        (tree / "bindings" / "python").mkdir(parents=True)
        (tree / "CMakePresets.json").write_text("{}")
        (tools / "cmake").write_text('#!/bin/sh\n[ "$1" = --build ] || exit 0\nmkdir -p build/user\n'
                                     'echo library > build/user/libdrillmbd.so; echo unit > '
                                     'build/user/drillmbd_fmu.so; exit ${FAIL:-0}\n')
        (tools / "cmake").chmod(0o755)
        with unittest.mock.patch.object(backend, "HERE", tree / "bindings" / "python"), \
                unittest.mock.patch.dict(os.environ, {"PATH": f"{tools}:{os.environ['PATH']}"}):
            del os.environ["DRILLMBD_BUNDLE"]
            self.assertEqual([(name, path.read_text()) for name, path in backend.bundled()],
                             [("libdrillmbd.so", "library\n"), ("drillmbd_fmu.so", "unit\n")])
            os.environ["FAIL"] = "1"
            with self.assertRaisesRegex(SystemExit, "DRILLMBD_BUNDLE=none"):
                backend.bundled()
            (tree / "CMakePresets.json").unlink()
            self.assertEqual(backend.bundled(), [])

    def finds_units(self, python, folder, **more):
        """The binary of co-simulation units is installed beside the library, where it was built."""
        if (BUILD / "drillmbd_fmu.so").exists():
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
        for words, wanted in ((["drillmbd", "tor"], "torque-drag"), (["drillmbd", "run", "x.toml", "--unt"], "--until"),
                              (["drillmbd", "probability", "--engine", "da"], "dask")):
            call = (f'. {source}; COMP_WORDS=({" ".join(words)}); COMP_CWORD={len(words) - 1}; _drillmbd; echo '
                    f'"${{COMPREPLY[@]}}"')
            self.assertEqual(run("bash", "-c", call).strip(), wanted)

    def test_cmake(self):
        prefix = self.folder / "prefix"
        run("cmake", "--install", str(BUILD), "--prefix", str(prefix))
        package = next(prefix.rglob("drillmbd/__init__.py"))
        out = run(sys.executable, "-c", PROGRAM, PYTHONPATH=str(package.parents[1]))
        self.assertIn(str(prefix), out)
        self.finds_units(sys.executable, prefix, PYTHONPATH=str(package.parents[1]))
        self.assertIn(str(prefix), run(sys.executable, "-c", PROGRAM, PYTHONUSERBASE=str(prefix)))  # as below ~/.local
        self.manual(prefix)
        moved = self.folder / "elsewhere"
        prefix.rename(moved)
        self.assertIn("usage: drillmbd", run(moved / "bin" / "drillmbd", "--help"))
        run(sys.executable, "-c", PROGRAM, PYTHONPATH=str(moved / package.parents[1].relative_to(prefix)))


if __name__ == "__main__":
    unittest.main()
