"""Tests of the page of failure probabilities: its tiny form is made by one command, its figures are those of its study files, and called
again it computes nothing anew."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

from shared_tests import needs

needs("h5py", "matplotlib", "numpy", "openturns")

import numpy as np

from drillmbd import scene
from drillmbd.probability.study import read_rows

ROOT = pathlib.Path(__file__).resolve().parents[2]
STUDY = ROOT / "examples" / "failure_probability"
sys.path.insert(0, str(STUDY))
from study import compared


class StudyTest(unittest.TestCase):
    def test_page(self):
        with tempfile.TemporaryDirectory() as folder:
            words = [sys.executable, "-W", "ignore", STUDY / "study.py", "--tiny", "-o", folder, "--workers", "2"]
            environment = {**os.environ, "PYTHONPATH": str(ROOT / "bindings" / "python")}
            done = subprocess.run(words, env=environment, capture_output=True, text=True, timeout=600)
            self.assertEqual(done.returncode, 0, done.stderr)
            page = pathlib.Path(folder, "failure_probability.html").read_text(encoding="utf-8")
            found = json.loads(pathlib.Path(folder, "failure_probability.json").read_text(encoding="utf-8"))
            for model, speed, feed, told, *_ in found["cases"]:
                rows, _ = read_rows(pathlib.Path(folder, f"{model.replace(' ', '-')}_{speed}rpm_{feed}mms.h5"))
                self.assertEqual(len(rows), 4)
                self.assertEqual(float(told.split()[0]), (rows["margin"].min(axis=1) <= 0.0).mean())
            self.assertIn("Most important variables", page)
            self.assertNotIn("src=\"http", page)
            rows, _ = read_rows(pathlib.Path(folder, "indices.h5"))
            subprocess.run(words, env=environment, check=True, capture_output=True, timeout=600)
            again, _ = read_rows(pathlib.Path(folder, "indices.h5"))
            self.assertEqual(rows["seconds"].tolist(), again["seconds"].tolist())  # they were not computed again

    def test_pairs(self):
        a, b = np.ones((20, 2)), np.ones((20, 2))
        b[:8, 0] = -1.0
        self.assertEqual(compared(a, b), (0.4, 8, 0, "raises"))
        self.assertEqual(compared(b, a), (-0.4, 0, 8, "lowers"))
        b[3:, 0] = 1.0
        self.assertEqual(compared(a, b)[3], "not told apart")

    def test_scene_is_itself(self):
        rig = scene.load(STUDY / "rig.toml")
        self.assertTrue(rig.same_as(scene.loads(scene.saves(rig))))


if __name__ == "__main__":
    unittest.main()
