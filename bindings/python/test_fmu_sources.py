"""A unit with its sources: what buildDescription.xml says is compiled as it says, in a folder without this project, and
the binary gives the numbers of the one that was exported, bit for bit."""
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest
import zipfile
from concurrent.futures import ThreadPoolExecutor
from xml.etree import ElementTree

from shared_tests import needs

needs("numpy")

from drillmbd import fmu, scene  # noqa: E402
from test_fmu import SCENE, Unit3  # noqa: E402

CC = shutil.which("ccache"), shutil.which("cc")
if not CC[1]:
    raise unittest.SkipTest("no compiler")


def compiled(folder):
    """The binary that the description of the build asks for; without optimization, which changes no bits."""
    build = ElementTree.parse(folder / "buildDescription.xml").getroot().find("BuildConfiguration")
    files = build.find("SourceFileSet")
    words = [one for one in CC if one] + ["-std=c11", "-fPIC", "-c", *files.get("compilerOptions").split()]
    words += [f"-D{one.get('name')}" for one in files.findall("PreprocessorDefinition")]
    words += [f"-I{one.get('name')}" for one in files.findall("IncludeDirectory")]
    names = [one.get("name") for one in files.findall("SourceFile")]
    with ThreadPoolExecutor(2) as pool:
        for done in pool.map(lambda name: subprocess.run([*words, name, "-o", name + ".o"], cwd=folder,
                                                         capture_output=True, text=True),
                             names):
            if done.returncode != 0:
                raise AssertionError(done.stderr)
    binary = folder / "unit.so"
    libraries = [f"-l{one.get('name')}" for one in build.findall("Library")]
    subprocess.run([CC[1], "-shared", "-o", str(binary), *(name + ".o" for name in names), *libraries], cwd=folder,
                   check=True)
    return binary


def run(folder, token):
    unit = Unit3(folder, token, "unit")
    unit.begin()
    rows = []
    for step in range(10):
        unit.set(100000, 5.0 + step)
        unit.step(2e-3 * step, 2e-3)
        rows.append(unit.get(200000, 200001, 200002))
    unit.close()
    return rows


class Sources(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def test_compiled_elsewhere(self):
        fmu.export(scene.loads(SCENE), self.folder / "unit.fmu", 3, sources=True)
        with zipfile.ZipFile(self.folder / "unit.fmu") as archive:
            archive.extractall(self.folder)
        token = ElementTree.parse(self.folder / "modelDescription.xml").getroot().get("instantiationToken")
        want = run(self.folder, token)
        binary = next((self.folder / "binaries").glob("*/unit.so"))
        shutil.copy(compiled(self.folder / "sources"), binary.with_name("again.so"))
        binary.unlink()
        binary.with_name("again.so").rename(binary.with_name("unit.again.so"))
        self.assertEqual(run(self.folder, token), want)
        self.assertNotEqual(want[0], want[-1])

    def test_listed_in_version_2(self):
        fmu.export(scene.loads(SCENE), self.folder / "unit.fmu", 2, sources=True)
        with zipfile.ZipFile(self.folder / "unit.fmu") as archive:
            root = ElementTree.fromstring(archive.read("modelDescription.xml"))
            listed = {one.get("name") for one in root.find("CoSimulation").find("SourceFiles")}
            held = {name[len("sources/"):] for name in archive.namelist() if name.startswith("sources/")
                    and name.endswith(".c")}
        self.assertEqual(listed, held)
        self.assertIn("fmi/fmi2.c", listed)

    def test_sources_that_are_not_there(self):
        with self.assertRaisesRegex(fmu.CannotExport, "does not hold the sources"):
            fmu.export(scene.loads(SCENE), self.folder / "unit.fmu", 3, sources=self.folder)


if __name__ == "__main__":
    sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
    unittest.main()
