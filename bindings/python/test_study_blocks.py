"""Tests that torque and drag of a study, which engines pass on in blocks of samples, has the same digits by threads,
processes, ranks of MPI and dask. Runs in time by each engine, and what fails there: test_engines."""
import importlib.util
import pathlib
import shutil
import subprocess
import tempfile
import unittest

from shared_tests import COMMAND, ENVIRONMENT, needs

needs("h5py", "numpy", "scipy")

from drillmbd.probability import engines
from drillmbd.probability.sample import SceneSample
from drillmbd.probability.sampling import Points
from drillmbd.probability.study import Study, read_rows
from test_engines import MPIRUN, there
from test_study_analyses import ALL, FIELD, LEVEL


class BlockTest(unittest.TestCase):
    def test_engines(self):
        sample = SceneSample(LEVEL + FIELD + ALL)
        points = Points("monte-carlo", 7, sample.dimension, 450)
        known = [one.margins for one in Study(sample, engines.serial).run(range(450), points.z)]
        self.assertEqual([sample(n, points.z(n)).margins for n in (0, 199, 200, 449)],
                         [known[n] for n in (0, 199, 200, 449)])
        for engine in (engines.threads(2), engines.processes(2)):
            self.assertEqual([one.margins for one in Study(sample, engine).run(range(449, -1, -1), points.z)][::-1],
                             known)

    @unittest.skipIf(shutil.which("mpirun") is None or importlib.util.find_spec("mpi4py") is None,
                     "not there: mpirun, mpi4py")
    def test_mpi(self):
        """Blocks of samples on ranks, with the same digits."""
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "level.toml")
            path.write_text(LEVEL + ALL, encoding="utf-8")
            words = (*MPIRUN, "3", *COMMAND, "probability", path, "-o", pathlib.Path(folder, "out"), "--samples", "450",
                     "--engine", "mpi")
            done = subprocess.run(words, env=ENVIRONMENT, capture_output=True, text=True, timeout=300)
            self.assertEqual(done.returncode, 0, done.stderr[-800:])
            sample = SceneSample(LEVEL + ALL)
            known = [one.margins for one in Study(sample, engines.serial).run(range(450),
                                                                              Points("monte-carlo", 1, 1, 450).z)]
            self.assertEqual(read_rows(pathlib.Path(folder, "out", "study.h5"))[0]["margin"].tolist(), known)

    @there("distributed")
    def test_dask(self):
        sample = SceneSample(LEVEL + ALL)
        points = Points("monte-carlo", 7, 1, 450)
        known = [one.margins for one in Study(sample, engines.serial).run(range(450), points.z)]
        self.assertEqual([one.margins for one in Study(sample, engines.dask(2)).run(range(450), points.z)], known)


if __name__ == "__main__":
    unittest.main()
