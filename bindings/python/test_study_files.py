"""Tests that a study loses nothing and waits for nothing: damaged files, lost locks, full disks, workers and ranks that
fail."""
import contextlib
import importlib.util
import math
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import time
import unittest

from shared_tests import ENVIRONMENT, FolderTest, needs

needs("h5py", "numpy", "scipy")

import h5py
import numpy as np

from drillmbd import scene
from drillmbd.results import no_formula
from drillmbd.probability import engines
from drillmbd.probability.rows import Damaged
from drillmbd.probability.study import Study, StudyError, StudyFile, read_rows
from test_engines import MPIRUN, SCENE, Toy, point, there

ROOT = pathlib.Path(__file__).resolve().parents[2]


class DamageTest(FolderTest):
    def setUp(self):
        super().setUp()
        self.file = self.folder / "s.h5"
        self.study(range(40))
        self.data = self.file.read_bytes()
        self.known = {int(row["number"]): row["margin"].tolist() for row in read_rows(self.file)[0]}

    def study(self, numbers, salvage=False):
        """Number of samples that are computed, and all rows after them."""
        with StudyFile(self.file, Toy(self.folder), {}, salvage) as file:
            study = Study(Toy(self.folder), engines.serial, file)
            study.run(numbers, point)
        return study.evaluated, read_rows(self.file)[0]

    def test_other_programs_read_it(self):
        with h5py.File(self.file, "r") as file:
            self.assertEqual(file["samples"]["margin"].tolist(), [self.known[n] for n in range(40)])

    def damaged(self, how, seed):
        """One bit, a cut, zeros, nonsense."""
        rng, data = random.Random(seed), bytearray(self.data)
        at = rng.randrange(len(data))
        if how == "bit":
            data[at] ^= 1 << rng.randrange(8)
        elif how == "cut":
            del data[at:]
        else:
            size = min(rng.randrange(1, 3000), len(data) - at)
            data[at:at + size] = bytes(size) if how == "zeros" else rng.randbytes(size)
        return bytes(data)

    def test_any_damage(self):
        """A file that is damaged anywhere is refused at once with what can be recovered, or all of its rows that count
        are right."""
        refused = 0
        for how in ("bit", "cut", "zeros", "nonsense"):
            for seed in range(8):
                data = self.damaged(how, seed)
                self.file.write_bytes(data)
                for one in self.folder.glob("s.h5.*"):
                    one.unlink()
                try:
                    _, rows = self.study(range(0))
                except Damaged as error:
                    refused += 1
                    self.assertIn(f"{len(error.rows)} sound row", str(error))
                    self.assertIn("--salvage", str(error))
                    self.assertEqual(self.file.read_bytes(), data)  # a call that fails changes nothing
                    _, rows = self.study(range(0), salvage=True)
                    self.assertEqual((self.folder / "s.h5.damaged").read_bytes(), data)
                    self.assertEqual(len(rows), len(error.rows))
                self.assertEqual([row["margin"].tolist() for row in rows],
                                 [self.known[int(row["number"])] for row in rows])
                evaluated, rows = self.study(range(40))
                self.assertEqual((evaluated + len(rows) >= 40, rows["margin"].tolist()),
                                 (True, list(self.known.values())))
        self.assertGreater(refused, 8)

    def test_a_row_in_the_middle(self):
        at = self.data.index(np.float64(self.known[20][0]).tobytes())
        self.file.write_bytes(self.data[:at] + b"x" + self.data[at + 1:])
        with self.assertRaisesRegex(Damaged, "1 of 40 rows are damaged or missing; 39 sound rows can be recovered"):
            read_rows(self.file)
        self.assertEqual(self.study(range(40), salvage=True)[0], 1)

    def test_a_row_that_was_cut_off(self):
        """A process that is killed while it writes leaves a last row without its check sum: it is computed again, and
        nothing is said."""
        size = read_rows(self.file)[0].dtype.itemsize
        last = self.data.rindex(np.float64(self.known[39][0]).tobytes())
        end = last + size - 44  # mark, place, number, status and seconds stand before the margin
        self.assertEqual(self.data[end:end + 4], self.data[end:end + 4])
        self.file.write_bytes(self.data[:last + 8] + bytes(end - last - 8 + 8) + self.data[end + 8:])
        self.assertEqual(self.study(range(40))[0], 1)

    def test_command_says_how(self):
        path = self.write("rig.toml", SCENE)
        words = (path, "-o", self.folder / "out", "--samples", 4, "--engine", "serial")
        self.call("probability", *words)
        file = self.folder / "out" / "study.h5"
        data = file.read_bytes()
        at = data.rindex(b"drillmbd study", 0, 100) if data.rfind(b"drillmbd study", 0, 100) >= 0 else 0
        file.write_bytes(data[:at] + b"X" + data[at + 1:])
        out = self.call("probability", *words, status=2)
        self.assertIn("is damaged", out)
        self.assertIn("4 sound rows can be recovered", out)
        self.assertIn("4 samples are in", self.call("probability", *words, "--salvage"))


class LockTest(FolderTest):
    OTHER = ("import sys; from test_study_files import *; f = StudyFile(sys.argv[1], Toy(sys.argv[2]), {}); "
             "s = Study(Toy(sys.argv[2]), engines.serial, f); s.run([99], point); f.close()")

    def other(self):
        """Another process that writes one row."""
        return subprocess.run([sys.executable, "-W", "ignore", "-c", self.OTHER, self.folder / "s.h5", self.folder],
                              env=ENVIRONMENT,
                              capture_output=True, text=True, timeout=100)

    def test_a_refused_opening_keeps_the_lock(self):
        """POSIX locks go with any close of the file by its process."""
        link = self.folder / "link.h5"
        with StudyFile(self.folder / "s.h5", Toy(self.folder), {}) as file:
            link.symlink_to(self.folder / "s.h5")
            os.link(self.folder / "s.h5.lock", self.folder / "link.h5.lock")
            for name in ("s.h5", "link.h5"):
                with self.assertRaisesRegex(StudyError, "another run writes it"):
                    StudyFile(self.folder / name, Toy(self.folder), {})
            done = self.other()
            self.assertIn("another run writes it now", done.stderr)
            Study(Toy(self.folder), engines.serial, file).run(range(5), point)
        self.assertEqual(read_rows(self.folder / "s.h5")[0]["number"].tolist(), [0, 1, 2, 3, 4])

    def test_without_locks(self):
        """Where locks do nothing, as on some network drives, the writer whose file was replaced stops; no row of either
        is lost."""
        path = self.folder / "s.h5"
        file = StudyFile(path, Toy(self.folder), {})
        study = Study(Toy(self.folder), engines.serial, file)
        study.run(range(5), point)
        (self.folder / "s.h5.lock").unlink()  # as good as no lock
        done = self.other()
        self.assertEqual(done.returncode, 0, done.stderr)
        with self.assertRaisesRegex(StudyError, "6 finished rows are in s.h5.kept-"):
            study.run(range(6), point)
        file.close()
        with StudyFile(path, Toy(self.folder), {}) as again:
            self.assertEqual(sorted(again.results), [0, 1, 2, 3, 4, 5, 99])
        self.assertEqual(list(self.folder.glob("*.kept-*")), [])

    def test_removed(self):
        path = self.folder / "s.h5"
        file = StudyFile(path, Toy(self.folder), {})
        path.unlink()
        with self.assertRaisesRegex(StudyError, "was moved or replaced"):
            Study(Toy(self.folder), engines.serial, file).run(range(1), point)
        file.close()
        with StudyFile(path, Toy(self.folder), {}) as again:
            self.assertEqual(sorted(again.results), [0])


class FullDiskTest(FolderTest):
    SCENE = SCENE.replace('end = "30 ms"', 'end = "3 ms"')

    def test_status(self):
        """A limit of the size of files stands for a full disk: before the first row, and after some."""
        for limit, kept in ((10_000, False), (300_000, True)):
            out = self.folder / f"out{limit}"
            code = ("import resource, signal; signal.signal(signal.SIGXFSZ, signal.SIG_IGN); "
                    f"resource.setrlimit(resource.RLIMIT_FSIZE, ({limit}, {limit})); "
                    "from drillmbd.command import program; program()")
            words = [sys.executable, "-W", "ignore", "-c", code, "probability", self.scene, "-o", out, "--samples",
                     "400", "--workers", "2"]
            done = subprocess.run(words, env=ENVIRONMENT, capture_output=True, text=True, timeout=300)
            self.assertEqual(done.returncode, 3, done.stderr[-800:] + done.stdout[-200:])
            self.assertIn("File too large", done.stderr)
            self.assertNotIn("Traceback", done.stderr)
            if kept:
                self.assertGreater(len(read_rows(out / "study.h5")[0]), 0)
            else:
                self.assertFalse((out / "study.h5").exists())


class WorkerTest(FolderTest):
    SCENE = SCENE

    def test_real_time_signal(self):
        class Killed(Toy):
            def __call__(self, number, z):
                if number == 4:
                    os.kill(os.getpid(), signal.SIGRTMIN + 1)
                return super().__call__(number, z)
        found = Study(Killed(self.folder), engines.processes(2)).run(range(8), point)
        self.assertEqual([math.isnan(one.margins[0]) for one in found], [n == 4 for n in range(8)])
        self.assertIn(f"its worker died (signal {signal.SIGRTMIN + 1}), 3 times", found[4].message)

    @there("distributed")
    def test_dask_of_the_installed_command(self):
        """Workers that are not forked import the file of the command."""
        command = self.write("drillmbd", (ROOT / "bindings/python/drillmbd-command").read_text(encoding="utf-8"))
        words = [sys.executable, "-W", "ignore", command, "probability", self.scene, "-o", self.folder / "out",
                 "--samples", "4", "--engine", "dask",
                 "--workers", "2"]
        done = subprocess.run(words, env=ENVIRONMENT, capture_output=True, text=True, timeout=120)
        self.assertEqual(done.returncode, 0, done.stderr[-800:])
        self.assertIn("4 samples computed", done.stdout)

    @unittest.skipIf(shutil.which("mpirun") is None or importlib.util.find_spec("mpi4py") is None,
                     "not there: mpirun, mpi4py")
    def test_exception_in_a_rank(self):
        """SystemError passes through a sample: no limit state of a user's may raise it."""
        code = """import sys
from drillmbd.probability import sample
known = sample.SceneSample.__call__
def call(self, number, z):
    if number == 3:
        raise SystemError("a fault of the program")
    return known(self, number, z)
sample.SceneSample.__call__ = call
from drillmbd.command import program
program()
"""
        words = (*MPIRUN, "3", sys.executable, "-W", "ignore", "-c", code, "probability", self.scene, "-o",
                 self.folder / "out", "--samples", "8",
                 "--engine", "mpi")
        done = subprocess.run(words, env=ENVIRONMENT, capture_output=True, text=True, timeout=120)
        self.assertNotEqual(done.returncode, 0)
        self.assertRegex(done.stderr, "rank [12] of 3 failed, all are ended: SystemError: a fault of the program")


class InputTest(FolderTest):
    SCENE = SCENE

    def test_pipes_and_devices(self):
        os.mkfifo(self.folder / "pipe.toml")
        for name in (self.folder / "pipe.toml", "/dev/null", "/dev/zero"):
            started = time.monotonic()
            self.assertIn(f"{name}:1: the file: is a device or a named pipe, must be a regular file",
                          self.call("check", name, status=2))
            self.assertLess(time.monotonic() - started, 5.0)

    def test_failure_after_the_run(self):
        late = SCENE.replace('limit = "111 N m"', 'limit = "111 N m"\nfrom = "31 ms"')
        line = late[:late.index("31 ms")].count("\n") + 1
        self.assertIn(f"rig.toml:{line}: failure[0].from = \"31 ms\": must be <= 0.03 s, the end of the run",
                      self.call("check", self.write("rig.toml", late), status=2))
        self.call("check", self.write("rig.toml", late.replace("31 ms", "30 ms")))
        static = SCENE.replace("seed = 7", 'seed = 7\nquestion = "static"').replace('limit = "111 N m"',
                                                                                    'limit = "111 N m"\nfrom = "1 ms"')
        with self.assertRaisesRegex(scene.SceneError, "must be <= 0 s, the time of a static state"):
            scene.loads(static)
        with self.assertRaisesRegex(scene.SceneError, "must be >= 0 s, the beginning of the run"):
            scene.loads(SCENE.replace('limit = "111 N m"', 'limit = "111 N m"\nto = "-1 ms"'))

    def test_no_formula(self):
        for text in ("=1+1", "+SUM(A1)", "-cmd|' /C calc'!A0", "@x", "\t=1", "-x drive", "+1+cmd()"):
            self.assertEqual(no_formula(text), "'" + text)
        for cell in ("torque", "-5 mm", "+1.5e-3 kN m", "-3", 7, -1.5, "", None):
            self.assertEqual(no_formula(cell), cell)
        named = SCENE.replace('name = "friction"', 'name = "=HYPERLINK(1)"')
        self.call("probability", self.write("rig.toml", named), "-o", self.folder / "out", "--samples", 2, "--engine",
                  "serial")
        head = (self.folder / "out" / "samples.csv").read_text(encoding="utf-8").splitlines()[0]
        self.assertIn(",'=HYPERLINK(1),", head)


if __name__ == "__main__":
    with contextlib.suppress(KeyboardInterrupt):
        unittest.main()
