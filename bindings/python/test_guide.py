"""The user's guide, examples/README.md, and README.md: scenes, commands and programs run and give the figures of the
text."""
import contextlib
import io
import math
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile
import unittest

import drillmbd as mbd

ROOT = pathlib.Path(__file__).resolve().parents[2]
GUIDE = (ROOT / "examples" / "README.md").read_text(encoding="utf-8")
README = (ROOT / "README.md").read_text(encoding="utf-8")


def block(language, page=GUIDE):
    found = re.findall(rf"^```{language}\n(.*?)^```", page, re.M | re.S)
    assert len(found) == 1, f"{len(found)} blocks of {language}"
    return found[0]


def output_of(function, *arguments):
    out = io.StringIO()
    with contextlib.redirect_stdout(out):
        function(*arguments)
    return out.getvalue()


class GuideTest(unittest.TestCase):
    def test_drawing_of_the_conventions(self):
        """The drawing is the one that its script makes."""
        script = ROOT / "examples" / "conventions" / "draw.py"
        self.assertEqual(subprocess.run([sys.executable, str(script), "--check"], check=False).returncode, 0)

    def run_commands(self, scene, lines):
        """Output of each command of a page, run beside its scene."""
        try:
            import matplotlib  # noqa: F401
        except ImportError as error:
            self.skipTest(f"not there: {error.name}")
        from drillmbd.command import main
        before, printed = os.getcwd(), {}
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            try:
                pathlib.Path("hole.toml").write_text(scene, encoding="utf-8")
                for line in lines:
                    words = shlex.split(line, comments=True)
                    self.assertEqual(words[0], "drillmbd")
                    printed[words[1]] = output_of(lambda: self.assertEqual(main(words[1:]), 0, line))
                self.assertTrue(pathlib.Path("out", "run.csv").exists())
            finally:
                os.chdir(before)
        return printed

    def test_scene_and_commands(self):
        printed = self.run_commands(block("toml"), block("sh").splitlines())
        self.assertIn("warnings of the model: none; notes on the scene: 2, above", printed["check"])
        self.assertIn("displacement up to 10.5", printed["static"])
        self.assertIn("torque at the rig [N m]: 0 .. 126.9", printed["run"])  # "reaches 127 N m"
        self.assertIn("energy error 3.1e-06", printed["run"])
        self.assertRegex(printed["torque-drag"], r"rotate at 90 m: .*torque 79\.\d+ N m|rotate at 90 m: .*torque 80")

    def test_readme_scene(self):
        """Ten lines, and the figures that README gives for them."""
        scene = block("toml", README)
        self.assertEqual(len(scene.splitlines()), 10)
        printed = self.run_commands(scene, re.findall(r"^    (drillmbd .*hole\.toml.*)$", README, re.M))
        drill = re.search(r"drill at 100 m: .*", printed["torque-drag"]).group()
        page = " ".join(README.split())
        for word in ("thrust 10.04 kN", "torque 259.8 N m", "9.5 % of the helical buckling load",
                     "1.9 % of the yield strength"):
            self.assertIn(word, drill)
            self.assertIn(word, page)
        quoted = re.search(r"`(thrust [^`]*limit [^`]*)`", README).group(1)
        self.assertIn(quoted, printed["torque-drag"])
        low, high = map(float, re.search(r"torque \[N m\]: (\S+) \.\. (\S+)", printed["run"]).groups())
        self.assertIn(f"{low:.1f} to {high:.0f} N m", page)
        self.assertLessEqual(len(README.splitlines()), 130)

    def test_lines_that_a_question_needs(self):
        """A command whose table the scene lacks prints an example of it; the scene with its lines has a result."""
        from drillmbd.command import main
        scene = block("toml").replace('count = 30', 'count = 6\neccentricity = "1 mm"')
        for command in ("response", "speeds", "buckle"):
            with tempfile.TemporaryDirectory() as folder:
                path = pathlib.Path(folder, "hole.toml")
                path.write_text(scene, encoding="utf-8")
                told = io.StringIO()
                with contextlib.redirect_stderr(told):
                    self.assertEqual(main([command, str(path)]), 2)
                lines = told.getvalue().split("for example:\n")[1]
                path.write_text(scene + lines, encoding="utf-8")
                if command == "buckle":  # whether it buckles is the scene's affair
                    output_of(lambda: self.assertEqual(main(["check", str(path)]), 0))
                else:
                    output_of(lambda: self.assertEqual(main([command, str(path)]), 0, command))

    def test_program(self):
        told = output_of(exec, compile(block("python"), "guide", "exec"), {})
        torque = float(re.search(r"rig ([\d.]+) N m", told).group(1))
        model = mbd.Model()
        model.add_wall(diameter=0.094, mu_dynamic=0.25)
        string = model.add_pipes(30, length=3.0, outer_diameter=0.073, inner_diameter=0.061)
        bit = mbd.BitDef(mass=5.0)
        model.add_bit(bit)
        model.compile()
        with model.sim() as sim:
            sim.static()
            on_the_wall = sum(sim.contact(site).normal_force for site in range(model.info().contact_points)
                              if sim.contact(site).part == string)
            below_the_bit = sim.contact_total().normal_force - on_the_wall
        self.assertAlmostEqual(on_the_wall, 8186.0, delta=1.0)  # "leave 8.2 kN to it"
        climbed = 0.25 / math.sqrt(1.0 + 0.25 ** 2)  # friction on the side that the turning string climbs to
        wanted = climbed * (0.5 * 0.073 * on_the_wall + 0.5 * bit.diameter * below_the_bit)
        self.assertAlmostEqual(torque, wanted, delta=0.01 * wanted)  # "swings about 75 N m"
        self.assertAlmostEqual(torque, 75.0, delta=1.0)

    def test_names_exist(self):
        """Functions, commands, tests and files that the guide names."""
        for name in set(re.findall(r"`(dmb_\w+)", GUIDE)):
            self.assertTrue(hasattr(mbd._lib, name) or hasattr(mbd._lib, name + "_init")
                            or name in ("dmb_model", "dmb_sim"), name)
        for path in set(re.findall(r"`((?:tests|pkgconfig|examples|bindings|\.ci)/[\w/.-]+)", GUIDE)):
            self.assertTrue((ROOT / path).exists(), path)
        help_text = output_of(lambda: self.assertRaises(SystemExit, __import__("drillmbd.command").command.main,
                                                        ["--help"]))
        for name in re.findall(r"^\|[^|]*\| `([a-z-]+)`", GUIDE, re.M):
            if not name.startswith("["):
                self.assertIn(f"drillmbd {name} " if name != "sweep" else "drillmbd sweep", help_text)


if __name__ == "__main__":
    sys.exit(unittest.main())
