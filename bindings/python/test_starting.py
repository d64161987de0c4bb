"""Tests of the commands that a scene begins with: new writes scenes that load, keys lists every key with unit and default."""
import contextlib
import io
import pathlib
import tempfile
import unittest

from drillmbd import scene
from drillmbd.command import main
from drillmbd.scene import keys, new


def said(*words):
    """Exit status, output and errors of the command."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        status = main(list(words))
    return status, out.getvalue(), err.getvalue()


class StartingTest(unittest.TestCase):
    def test_new_scenes_load(self):
        for kind in new.OPTIONS:
            status, text, _ = said("new", kind, "--length", "200", "--rod", "73", "--bore", "59 mm")
            self.assertEqual(status, 0)
            self.assertEqual(scene.loads(text).remarks, [])
        self.assertIn('diameter = "8 1/2 in"', said("new", "well", "--hole", '8 1/2"')[1])

    def test_new_refuses(self):
        with tempfile.TemporaryDirectory() as folder:
            target = str(pathlib.Path(folder, "hole.toml"))
            self.assertEqual(said("new", "drainage", "-o", target)[0], 0)
            self.assertEqual(said("new", "drainage", "-o", target)[0], 3)  # never over a file that is there
        for words, part in ((("--dip", "5 m"), "--dip 5 m"), (("--rod", "120 mm"), "must lie between"), (("--length", "1 m"), "at least one")):
            status, _, told = said("new", "drainage", *words)
            self.assertEqual(status, 2)
            self.assertIn(part, told)

    def test_keys(self):
        self.assertLess(len(said("keys")[1]), 20000)
        for table, (_, usual) in keys.TABLES.items():
            status, text, _ = said("keys", table)
            self.assertEqual(status, 0)
            self.assertNotIn("DMB_", text)
            listed = [row[0] for row in keys.listed(table)]
            self.assertEqual(listed[:len(usual.split())], usual.split())
            self.assertEqual(len(listed), len(set(listed)))
        self.assertRegex(said("keys", "string.pipes")[1], r"outer_diameter +\[m\], default 0.073 m")
        self.assertEqual(said("keys", "pips")[0], 2)


if __name__ == "__main__":
    unittest.main()
