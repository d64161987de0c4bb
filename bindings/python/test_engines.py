"""Tests of the engines of a study: the same numbers in one process, threads, processes, MPI and Dask, whatever the
order and the number of workers; workers that die, one and all; samples that cannot be computed; files that grow, that
are cut, and that are of something else."""
import contextlib
import csv
import importlib.util
import json
import math
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import time
import unittest

from shared_tests import COMMAND, DRIVES, ENVIRONMENT, SHORT_STRING, FolderTest, needs

needs("h5py", "numpy", "scipy")

import h5py
import numpy as np

from drillmbd.probability import engines
from drillmbd.probability.sampling import Points
from drillmbd.probability.sample import DONE, FAILED, Result, SceneSample
from drillmbd.probability.study import Study, StudyError, StudyFile, differences, read_rows

MPIRUN = ("mpirun", "--allow-run-as-root", "--oversubscribe", "-n")

SCENE = """title = "short rig"
[hole]
diameter = "94 mm"
""" + SHORT_STRING + """load = "rock"
[[time_function]]
name = "turning"
segment = {kind = "step", x1 = "20 ms", h1 = "100 rpm"}
[[time_function]]
name = "rock"
segment = {kind = "step", x1 = "20 ms", h1 = "2 kN"}
""" + DRIVES + """[run]
end = "30 ms"
step = "1 ms"
static = true
[results]
interval = "2 ms"
[variability]
seed = 7
samples = 20
[[variability.scatter]]
name = "friction"
keys = ["hole.mu_static", "hole.mu_dynamic"]
relative = true
distribution = "lognormal"
mean = 1
deviation = "30 %"
[[variability.field]]
name = "masses"
key = "string[0].pipes.eccentricity"
distribution = "uniform"
low = "0 mm"
high = "2 mm"
correlation_length = "3 m"
[[variability.process]]
name = "rock load"
time_function = "rock"
distribution = "gamma"
mean = 1
deviation = 0.2
correlation_time = "10 ms"
[[failure]]
kind = "rig-torque"
limit = "111 N m"
[[failure]]
kind = "stress"
strength = "40 MPa"
"""


class Toy:
    """A sample that is quick; some do what `deeds` says: "die" (once), "kill" (always), "fail"."""
    names, inputs, dimension = ["one", "two"], ["x"], 3

    def __init__(self, folder, deeds=None, pause=0.0):
        self.folder, self.deeds, self.pause = str(folder), deeds or {}, pause

    def describe(self):
        return {"toy": "toy"}

    def __call__(self, number, z):
        deed = self.deeds.get(number)
        mark = pathlib.Path(self.folder, f"died {number}")
        if deed == "kill" or (deed == "die" and not mark.exists()):
            mark.touch()
            os.kill(os.getpid(), signal.SIGKILL)
        time.sleep(self.pause)
        if deed == "fail":
            return Result(number, FAILED, [math.nan] * 2, [math.nan] * 2, [0.0], 0.0, "it does not converge")
        return Result(number, DONE, [float(z.sum()), float(z[0])], [0.0, 0.0], [float(z[1])], 0.0)


def there(*names):
    return unittest.skipIf([one for one in names if importlib.util.find_spec(one) is None],
                           f"not there: {', '.join(names)}")


def point(number):
    """z of the toy."""
    return Points("monte-carlo", 5, 3, 1000).z(number)


class Base(FolderTest):
    SCENE = SCENE

    def command(self, *words, status=0):
        return self.call("probability", *words, status=status)

    def rows(self, name="out"):
        rows = read_rows(self.folder / name / "study.h5")[0]
        return rows["number"].tolist(), rows["margin"].tolist()


class EngineTest(Base):
    def test_equal_numbers(self):
        """The scene in all engines of this machine; MPI is below."""
        sample = SceneSample(SCENE)
        points = Points("monte-carlo", 7, sample.dimension, 12)
        known = [one.margins for one in Study(sample, engines.serial).run(range(12), points.z)]
        self.assertEqual([one.margins for one in Study(sample, engines.serial).run(range(11, -1, -1), points.z)][::-1],
                         known)
        made = {"threads 2": engines.threads(2), "processes 1": engines.processes(1),
                "processes 3": engines.processes(3)}
        if importlib.util.find_spec("distributed"):
            made["dask 2"] = engines.dask(2)
        for name, engine in made.items():
            found = Study(sample, engine).run(range(12), points.z)
            self.assertEqual([one.margins for one in found], known, name)
            self.assertEqual([one.number for one in found], list(range(12)), name)

    def test_threads_of_blas(self):
        """A field's matrix in processes whose OpenBLAS has one thread and two."""
        script = ("import hashlib; from drillmbd.probability.fields import Expansion; "
                  "e = Expansion('exponential', 3.0, tuple(0.1 * i for i in range(300))); "
                  "print(hashlib.sha256(e.matrix.tobytes() + e(e.matrix[0]).tobytes()).hexdigest())")
        found = {subprocess.run([sys.executable, "-c", script], env={**ENVIRONMENT, "OMP_NUM_THREADS": count,
                                                                     "OPENBLAS_NUM_THREADS": count},
                                check=True, capture_output=True, text=True).stdout for count in ("1", "2")}
        self.assertEqual(len(found), 1)

    def test_one_worker_dies(self):
        toy = Toy(self.folder, {3: "die", 17: "die"}, 0.002)
        study = Study(toy, engines.processes(2))
        found = study.run(range(30), point)
        self.assertEqual([one.margins for one in found], [Toy(self.folder)(i, point(i)).margins for i in range(30)])
        self.assertEqual(study.evaluated, 30)
        self.assertTrue((self.folder / "died 17").exists())

    def test_the_last_sample_kills_the_only_worker(self):
        found = Study(Toy(self.folder, {9: "die"}), engines.processes(1)).run(range(10), point)
        self.assertEqual([one.status for one in found], [DONE] * 10)

    def test_a_sample_that_kills_every_worker(self):
        found = Study(Toy(self.folder, {4: "kill"}), engines.processes(2)).run(range(10), point)
        self.assertEqual([one.status for one in found], [DONE] * 4 + [FAILED] + [DONE] * 5)
        self.assertIn("its worker died (signal SIGKILL), 3 times", found[4].message)

    @there("distributed")
    def test_a_dask_worker_dies(self):
        found = Study(Toy(self.folder, {3: "die"}), engines.dask(2)).run(range(10), point)
        self.assertEqual([one.margins for one in found], [Toy(self.folder)(i, point(i)).margins for i in range(10)])

    def test_samples_that_fail_are_kept(self):
        told = []
        with StudyFile(self.folder / "s.h5", Toy(self.folder), {}) as file:
            Study(Toy(self.folder, {2: "fail"}), engines.serial, file, told.append).run(range(5), point)
        rows, _ = read_rows(self.folder / "s.h5")
        self.assertEqual(rows["status"].tolist(), [DONE, DONE, FAILED, DONE, DONE])
        self.assertEqual(rows["message"][2], b"it does not converge")
        self.assertEqual((told[-1].lost, told[-1].done), (1, 5))
        self.assertIn("sample 2: it does not converge", told[2].message)


class FileTest(Base):
    def test_grows_and_is_read(self):
        with StudyFile(self.folder / "s.h5", Toy(self.folder), {}) as file:
            study = Study(Toy(self.folder), engines.serial, file)
            for end in (3, 7):
                study.run(range(end), point)
                code = ("import sys; from drillmbd.probability.study import read_rows; "
                        "print(len(read_rows(sys.argv[1])[0]))")
                done = subprocess.run([sys.executable, "-c", code, self.folder / "s.h5"], env=ENVIRONMENT,
                                      capture_output=True, text=True)
                self.assertEqual(done.stdout.strip(), str(end), done.stderr)
            with self.assertRaisesRegex(StudyError, "another run writes it"):
                StudyFile(self.folder / "s.h5", Toy(self.folder), {})

    def test_goes_on(self):
        for end, evaluated in ((4, 4), (9, 5), (9, 0)):
            with StudyFile(self.folder / "s.h5", Toy(self.folder), {}) as file:
                study = Study(Toy(self.folder), engines.serial, file)
                found = study.run(range(end), point)
                self.assertEqual(study.evaluated, evaluated)
        self.assertEqual([one.margins for one in found], [Toy(self.folder)(i, point(i)).margins for i in range(9)])

    def test_of_something_else(self):
        StudyFile(self.folder / "s.h5", SceneSample(SCENE), {"seed": 1}).close()
        before = (self.folder / "s.h5").read_bytes()
        for sample, settings, told in ((SceneSample(SCENE.replace("count = 8", "count = 9")), {"seed": 1},
                                        "scene: 'count = 8' in the file, 'count = 9' now"),
                                       (SceneSample(SCENE), {"seed": 2}, "setting seed: '1' in the file, '2' now")):
            with self.assertRaisesRegex(StudyError, told):
                StudyFile(self.folder / "s.h5", sample, settings)
        self.assertEqual((self.folder / "s.h5").read_bytes(), before)
        self.assertEqual(differences({"code library": "a", "x": "1"}, {"code library": "b", "y": "1"}),
                         ["code library: 'a' in the file, 'b' now", "x: only in the file", "y: only in this run"])

    def test_no_study(self):
        (self.folder / "s.h5").write_text("no HDF5", encoding="utf-8")
        with self.assertRaisesRegex(StudyError, "is no study file"):
            StudyFile(self.folder / "s.h5", Toy(self.folder), {})
        with h5py.File(self.folder / "t.h5", "w") as file:
            file["other"] = np.zeros(3)
        with self.assertRaisesRegex(StudyError, "is no study file"):
            StudyFile(self.folder / "t.h5", Toy(self.folder), {})
        self.assertEqual((self.folder / "s.h5").read_text(encoding="utf-8"), "no HDF5")

    def test_own_function_that_has_changed(self):
        text, file = SCENE + '[[failure]]\nkind = "own"\nname = "mine"\n', self.folder / "mine.py"
        self.scene.write_text(text, encoding="utf-8")
        file.write_text("def margin(look):\n    return 1.0\n", encoding="utf-8")
        words = (self.scene, "-o", self.folder / "out", "--samples", 2, "--engine", "serial", "--own",
                 f"mine={file}:margin")
        self.assertIn("mine: 0, 95 %", self.command(*words))
        file.write_text("def margin(look):\n    return -1.0\n", encoding="utf-8")
        self.assertIn("'    return 1.0' in the file, '    return -1.0' now", self.command(*words, status=2))


class CommandTest(Base):
    def test_result(self):
        out = self.command(self.scene, "-o", self.folder / "out", "--samples", 30, "--workers", 2)
        summary = json.loads((self.folder / "out" / "summary.json").read_text(encoding="utf-8"))
        with open(self.folder / "out" / "samples.csv", encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        failing = sum(float(row["margin of rig-torque"]) <= 0.0 for row in rows)
        self.assertEqual(summary["estimates"]["rig-torque"]["failures"], failing)
        self.assertIn(f"rig-torque: {failing / 30:.4g}, 95 % interval", out)
        for one in summary["estimates"].values():
            self.assertTrue(one["low"] <= one["probability"] <= one["high"])
        again = self.command(self.scene, "-o", self.folder / "out", "--samples", 40, "--engine", "serial")
        self.assertIn("30 samples are in", again)
        self.assertIn("10 samples computed", again)

    def test_methods(self):
        for method in ("latin-hypercube", "sobol", "subset"):
            out = self.command(self.scene, "--samples", 40, "--method", method, "--failure", "rig-torque", "--engine",
                               "serial", *(
                ("-o", self.folder / method)))
            self.assertIn("rig-torque: ", out)
            again = self.command(self.scene, "--samples", 40, "--method", method, "--failure", "rig-torque",
                                 "--workers", 2, *(
                ("-o", self.folder / method)))
            self.assertIn("0 samples computed", again)
            self.assertEqual(*(one.splitlines()[[i for i, line in enumerate(one.splitlines())
                                                 if line.startswith("rig-torque")][0]]
                               for one in (out, again)))

    def test_indices(self):
        out = self.command(self.scene, "-o", self.folder / "out", "--indices", 16, "--failure", "rig-torque",
                           "--workers", 2)
        summary = json.loads((self.folder / "out" / "summary.json").read_text(encoding="utf-8"))
        self.assertEqual(set(summary["indices"]), {"friction", "masses", "rock load"})
        self.assertIn("total", out)

    def test_refused(self):
        bare = self.folder / "bare.toml"
        bare.write_text(SCENE[:SCENE.index("[variability]")], encoding="utf-8")
        self.assertIn("has no [variability]", self.command(bare, status=2))
        bare.write_text(SCENE[:SCENE.index("[[failure]]")], encoding="utf-8")
        self.assertIn("has no [[failure]]", self.command(bare, status=2))
        self.assertIn("is none of the scene's", self.command(self.scene, "--failure", "nothing", status=2))
        self.assertIn("must be >= 1", self.command(self.scene, "--samples", 0, status=2))
        self.assertIn("write NAME=FILE.py:FUNCTION", self.command(self.scene, "--own", "x", status=2))
        self.assertIn("invalid choice", self.command(self.scene, "--engine", "cluster", status=2))
        self.command(self.folder / "none.toml", status=3)

    def test_all_killed_and_begun_again(self):
        """The whole group of processes is killed in the middle, twice; nothing is lost or done twice."""
        self.scene.write_text(SCENE.replace('end = "30 ms"', 'end = "0.4 s"'), encoding="utf-8")
        words = (*COMMAND, "probability", self.scene, "-o", self.folder / "out", "--samples", "24", "--workers", "2")
        kept = 0
        for wanted in (4, 10):
            run = subprocess.Popen(words, env=ENVIRONMENT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                   start_new_session=True)
            deadline = time.monotonic() + 120.0
            while run.poll() is None and time.monotonic() < deadline:
                with contextlib.suppress(StudyError):
                    if len(self.rows()[0]) >= wanted:
                        break
                time.sleep(0.02)
            os.killpg(run.pid, signal.SIGKILL)
            run.wait()
            now = self.rows()[0]
            self.assertGreaterEqual(len(now), max(kept, min(wanted, 24)))
            kept = len(now)
        out = self.command(self.scene, "-o", self.folder / "out", "--samples", 24, "--workers", 2)
        self.assertIn(f"{kept} samples are in", out)
        self.assertIn(f"{24 - kept} samples computed", out)
        with h5py.File(self.folder / "out" / "study.h5", "r") as file:
            self.assertEqual(sorted(file["samples"]["number"].tolist()), list(range(24)))
        self.command(self.scene, "-o", self.folder / "other", "--samples", 24, "--engine", "serial")
        self.assertEqual(self.rows(), self.rows("other"))

    def test_parent_killed_leaves_no_workers(self):
        """Workers of a killed parent end; they hold no lock."""
        self.scene.write_text(SCENE.replace('end = "30 ms"', 'end = "2 s"'), encoding="utf-8")
        words = (*COMMAND, "probability", self.scene, "-o", self.folder / "out", "--samples", "100", "--workers", "3")
        run = subprocess.Popen(words, env=ENVIRONMENT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                               start_new_session=True)
        deadline = time.monotonic() + 120.0
        while run.poll() is None and time.monotonic() < deadline:
            with contextlib.suppress(StudyError):
                if self.rows()[0]:
                    break
            time.sleep(0.02)
        run.kill()
        run.wait()
        self.command(self.scene, "-o", self.folder / "out", "--samples", 2, "--engine", "serial")
        gone = False
        while not gone and time.monotonic() < deadline:
            try:
                os.killpg(run.pid, 0)
                time.sleep(0.1)
            except ProcessLookupError:
                gone = True
        self.assertTrue(gone)

    @unittest.skipIf(shutil.which("mpirun") is None or importlib.util.find_spec("mpi4py") is None,
                     "not there: mpirun, mpi4py")
    def test_mpi(self):
        words = (*MPIRUN, "3", *COMMAND, "probability", self.scene, "-o", self.folder / "out", "--samples", "12",
                 "--engine", "mpi")
        done = subprocess.run(words, env=ENVIRONMENT, capture_output=True, text=True, timeout=200)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stdout.count("samples computed"), 1, done.stdout)
        self.command(self.scene, "-o", self.folder / "other", "--samples", 12, "--engine", "serial")
        self.assertEqual(self.rows(), self.rows("other"))
        alone = subprocess.run((*MPIRUN, "1", *words[5:]), env=ENVIRONMENT, capture_output=True, text=True, timeout=100)
        self.assertNotEqual(alone.returncode, 0)
        self.assertIn("two ranks or more", alone.stderr)

    @unittest.skipIf(shutil.which("mpirun") is None or importlib.util.find_spec("mpi4py") is None,
                     "not there: mpirun, mpi4py")
    def test_a_rank_dies(self):
        """A rank that dies ends the whole run, as MPI has it; called again, it computes what is not in the file."""
        self.scene.write_text(SCENE + '[[failure]]\nkind = "own"\nname = "mine"\n', encoding="utf-8")
        own = self.folder / "mine.py"
        own.write_text(f"""import os, pathlib, signal
CALLS, MARK = pathlib.Path({str(self.folder / "calls")!r}), pathlib.Path({str(self.folder / "died")!r})
def margin(look):
    with open(CALLS, "a") as file:
        file.write("x")
    if CALLS.stat().st_size >= 6 and not MARK.exists():
        MARK.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return 1.0
""", encoding="utf-8")
        words = ("--samples", "12", "--own", f"mine={own}:margin")
        many = (*MPIRUN, "3", *COMMAND, "probability", self.scene, "-o", self.folder / "out", "--engine", "mpi", *words)
        done = subprocess.run(many, env=ENVIRONMENT, capture_output=True, text=True, timeout=200)
        self.assertNotEqual(done.returncode, 0)
        kept = len(self.rows()[0])
        self.assertTrue(0 < kept < 12, kept)
        done = subprocess.run(many, env=ENVIRONMENT, capture_output=True, text=True, timeout=200)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn(f"{kept} samples are in", done.stdout)
        self.assertIn(f"{12 - kept} samples computed", done.stdout)
        self.command(self.scene, "-o", self.folder / "other", "--engine", "serial", *words)
        self.assertEqual(self.rows(), self.rows("other"))


if __name__ == "__main__":
    unittest.main()
