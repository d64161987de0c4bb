"""Tests of examples/failure_probability: its README's command on a short form, whose figures are those of its study
files, and that computes nothing twice."""
import csv
import json
import pathlib
import re
import shlex
import unittest

from shared_tests import FolderTest, needs

needs("h5py", "matplotlib", "numpy", "scipy")

from drillmbd import scene
from drillmbd.probability.study import read_rows
from drillmbd.scene.fields import DEFINITIONS

STUDY = pathlib.Path(__file__).resolve().parents[2] / "examples" / "failure_probability"
SHORT = ("--vary", "run.end=0.2 s", "--vary", "failure[5].from=0.1 s", "--samples", 4, "--engine", "serial")


class StudyTest(FolderTest):
    def words(self):
        """The options of the first command of README.md, without those of its size."""
        text = (STUDY / "README.md").read_text(encoding="utf-8").replace("\\\n", " ")
        command = next(line for line in text.splitlines() if line.startswith("    drillmbd probability"))
        words = shlex.split(command)
        self.assertEqual(words[2], "examples/failure_probability/rig.toml")
        return [one for name, one in zip(words[3:], words[4:]) if name == "--vary"]

    def test_command(self):
        out, vary = self.folder / "out", [word for one in self.words() for word in ("--vary", one)]
        said = self.call("probability", STUDY / "rig.toml", "-o", out, *vary, *SHORT)
        summary = json.loads((out / "summary.json").read_text(encoding="utf-8"))
        self.assertEqual(len(summary["cells"]), 4)  # contact only, vibration, friction, both
        failing = []
        for number, cell in enumerate(summary["cells"], 1):
            rows, _ = read_rows(out / f"{number:05d}" / "study.h5")
            failing.append(dict(zip(rows["number"].tolist(), (rows["margin"].min(axis=1) <= 0.0).tolist())))
            self.assertEqual(cell["estimates"]["any failure"]["failures"], sum(failing[-1].values()))
        with open(out / "pairs.csv", encoding="utf-8", newline="") as file:
            pairs = list(csv.DictReader(file))
        for pair, (a, b) in zip(pairs, ((0, 2), (1, 3), (0, 1), (2, 3)), strict=True):
            more = sum(failing[b][n] and not failing[a][n] for n in range(4))
            self.assertEqual((int(pair["samples"]), int(pair["fail only after"])), (4, more))
        self.assertIn("exact McNemar test", said)
        self.assertTrue((out / "map.png").exists())  # keys with one value are no axes
        before = [read_rows(out / f"{number:05d}" / "study.h5")[0]["seconds"].tolist() for number in range(1, 5)]
        self.call("probability", STUDY / "rig.toml", "-o", out, *vary, *SHORT)
        self.assertEqual([read_rows(out / f"{number:05d}" / "study.h5")[0]["seconds"].tolist()
                          for number in range(1, 5)], before)

    def test_coupling_changes_the_scene(self):
        """Each key that the command varies is one of the scene: friction is gone in the first value, vibration too."""
        from drillmbd.sweep import settings_of, varied
        first = settings_of({key: values[0] for key, values in map(varied, self.words())})
        rig, bare = scene.load(STUDY / "rig.toml"), scene.load(STUDY / "rig.toml", first)

        def of(made, name, key):
            """A field; default values are left out of the description."""
            return next(arguments[-1].get(key, getattr(DEFINITIONS["hole" if name == "wall" else name](), key))
                        for one, arguments in made.model.calls if one == "add_" + name)
        self.assertEqual([of(bare, "wall", key) for key in ("mu_static", "mu_dynamic")]
                         + [of(bare, "pipes", "eccentricity")], [0.0] * 3)
        self.assertEqual([of(rig, "wall", key) for key in ("mu_static", "mu_dynamic")]
                         + [of(rig, "pipes", "eccentricity")], [0.35, 0.3, 1e-3])
        self.assertEqual(len([key for key in first if re.search("share|mu_|eccentricity", key)]), 4)

    def test_scene_is_itself(self):
        rig = scene.load(STUDY / "rig.toml")
        self.assertTrue(rig.same_as(scene.loads(scene.saves(rig))))


if __name__ == "__main__":
    unittest.main()
