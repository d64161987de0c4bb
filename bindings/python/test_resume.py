"""Tests of run and report that are stopped and go on: to the last bit as if nothing had happened, and only from a state
of their own."""
import json
import signal
import subprocess
import time
import unittest
from unittest import mock

from shared_tests import COMMAND, ENVIRONMENT, FolderTest, needs

needs("numpy")

import drillmbd as mbd  # noqa: E402
from drillmbd import commands, run_state  # noqa: E402
from drillmbd._progress import INTERRUPTS  # noqa: E402

SCENE = """title = "stopped run"
[hole]
diameter = "94 mm"
mu_dynamic = 0.3
[[time_function]]
name = "turning"
segment = {kind = "step5", x1 = "20 ms", h1 = "120 rpm"}
[[string]]
name = "main"
[[string.pipes]]
count = 4
length = "1.5 m"
outer_diameter = "73 mm"
inner_diameter = "59 mm"
eccentricity = "0.5 mm"
[[bit]]
diameter = "94 mm"
[[drive]]
name = "feed"
time_function = "0 m/s"
[[drive]]
name = "head"
component = "rx"
time_function = "turning"
[run]
step = "1 ms"
end = "0.2 s"
static = true
[results]
interval = "2 ms"
vtk_interval = "0.05 s"
[[output]]
name = "torque [N m]"
quantity = "drive-force"
place = "head"
[[output]]
name = "middle, turn [rad]"
quantity = "rotation"
place = {part = "main", pipe = 2}
[fatigue]
curve_stress = "100 MPa"
slope = 4
"""
RESULTS = ("outputs", "fatigue", "hash", "strings", "static", "energy_error", "verification")


class ResumeTest(FolderTest):
    """Ctrl-C is noted at given steps; the loop looks for it after each."""
    SCENE = SCENE

    def setUp(self):
        super().setUp()
        for patch in (mock.patch.object(commands, "LOOK", 0.0), mock.patch.object(run_state, "EVERY", 1e9),
                      mock.patch("drillmbd.results.CommandOutput.picture", lambda *_: None)):
            patch.start()
            self.addCleanup(patch.stop)

    def stop_at(self, number, *words, raising=None, status=130):
        """The command, which is stopped in its step of this number."""
        real, seen = mbd.Sim.step, []

        def step(sim, duration):
            seen.append(0)
            if len(seen) == number:
                if raising is not None:
                    raise raising
                INTERRUPTS(signal.SIGINT, None)
            return real(sim, duration)

        with mock.patch.object(mbd.Sim, "step", step):
            return self.call(*words, status=status)

    def summary(self, name):
        return json.loads((self.folder / name / "summary.json").read_text(encoding="utf-8"))

    def assert_same(self, first, second, results=RESULTS):
        a, b = self.summary(first), self.summary(second)
        for key in results:
            self.assertEqual(a.get(key), b.get(key), key)
        self.assertEqual(sorted(a["files"]), sorted(b["files"]))
        for name in a["files"]:
            if name.endswith((".csv", ".vtp")):
                self.assertEqual((self.folder / first / name).read_bytes(), (self.folder / second / name).read_bytes(),
                                 name)

    def test_same_bits(self):
        """Stopped twice within stretches and once between two, with all that counts on the way."""
        self.call("run", self.scene, "-o", self.folder / "whole", "--verify")
        words = ("run", self.scene, "-o", self.folder / "parts", "--verify")
        for step, at in ((13, 0.013), (37, 0.05), (135, 0.185)):
            self.stop_at(step, *words)
            found = self.summary("parts")
            self.assertAlmostEqual(found["run"]["time_s"], at)
            self.assertIn("the same command continues from there", found["notes"][-1])
        out = self.call(*words)
        self.assertIn("the run continues at 0.185 s", out)
        self.assert_same("whole", "parts")
        self.assertEqual(self.summary("parts")["run"]["steps"], 200)
        self.assertFalse((self.folder / "parts" / run_state.FILE).exists())
        self.assertNotIn("goes on", self.call(*words))  # complete: from the beginning

    def test_steps_of_its_own_choice(self):
        """Without a step the run is divided into hundredths of all of it, not of the rest."""
        self.scene.write_text(SCENE.replace('step = "1 ms"\n', "").replace('vtk_interval = "0.05 s"\n', ""),
                              encoding="utf-8")
        self.call("run", self.scene, "-o", self.folder / "whole")
        real, seen = mbd.Sim.advance, []

        def advance(sim, time_):
            seen.append(0)
            if len(seen) == 30:
                INTERRUPTS(signal.SIGINT, None)
            return real(sim, time_)

        with mock.patch.object(mbd.Sim, "advance", advance):
            self.call("run", self.scene, "-o", self.folder / "parts", status=130)
        self.call("run", self.scene, "-o", self.folder / "parts")
        self.assert_same("whole", "parts")

    def test_after_a_crash(self):
        """The state that is kept once a minute is there after the program went down."""
        self.call("run", self.scene, "-o", self.folder / "whole")
        with mock.patch.object(run_state, "EVERY", -1.0):
            with self.assertRaises(RuntimeError):
                self.stop_at(42, "run", self.scene, "-o", self.folder / "parts", raising=RuntimeError("down"), status=1)
        self.assertIn("continues at 0.041 s", self.call("run", self.scene, "-o", self.folder / "parts"))
        self.assert_same("whole", "parts")

    def test_other_settings(self):
        """Another step, end, scene, command or version starts again and says so; another unit system goes on."""
        def stopped():
            (self.folder / "out" / run_state.FILE).unlink(missing_ok=True)
            self.stop_at(40, "run", self.scene, "-o", self.folder / "out")

        other = self.write("other.toml", SCENE.replace("mu_dynamic = 0.3", "mu_dynamic = 0.31"))
        (self.folder / "out").mkdir()
        for words in (("run", self.scene, "--step", "2 ms"), ("run", self.scene, "--until", "0.1 s"), ("run", other)):
            stopped()
            self.assertIn("is of another scene, other options or another version; the run starts again",
                          self.call(*words, "-o", self.folder / "out"), words)
        stopped()
        with mock.patch.object(run_state, "code", lambda: {"version": "another"}):
            self.assertIn("starts again", self.call("run", self.scene, "-o", self.folder / "out"))
        stopped()
        self.assertIn("continues at 0.04 s",
                      self.call("run", self.scene, "--units", "field", "-o", self.folder / "out"))

    def test_damaged_state(self):
        """A file that is none, or half of one, is passed over; bytes of the state that do not fit are refused with the
        remedy."""
        self.stop_at(40, "run", self.scene, "-o", self.folder / "out")
        file = self.folder / "out" / run_state.FILE
        whole = file.read_bytes()
        for content in (b"", b"no archive", whole[:len(whole) // 2]):
            file.write_bytes(content)
            self.assertIn("cannot be read; the run starts again",
                          self.call("run", self.scene, "-o", self.folder / "out"))
        import numpy
        file.write_bytes(whole)
        with numpy.load(file) as read:
            arrays = {name: read[name] for name in read.files}
        arrays["sim"] = arrays["sim"][:-8]
        numpy.savez(file, **arrays)
        self.assertIn("remove it, and the run starts again", self.call("run", self.scene, "-o", self.folder / "out",
                                                                       status=2))

    def test_nothing_to_go_on_from(self):
        """Without a folder, and after a second Ctrl-C that came between a step and its samples, the run starts again
        and says so."""
        real = mbd.Sim.step

        def impatient(sim, duration):
            report = real(sim, duration)
            if sim.time > 0.03:
                INTERRUPTS(signal.SIGINT, None)
                INTERRUPTS(signal.SIGINT, None)
            return report

        with mock.patch.object(mbd.Sim, "step", impatient):
            self.call("run", self.scene, "-o", self.folder / "out", status=130)
        self.assertIn("the same command starts again", self.summary("out")["notes"][-1])
        self.assertFalse((self.folder / "out" / run_state.FILE).exists())
        self.stop_at(40, "run", self.scene)

    def test_sweep_goes_on_within_a_case(self):
        words = ("sweep", self.scene, "run", "--vary", "hole.mu_dynamic=0.2,0.3", "-o")
        self.call(*words, self.folder / "whole")
        self.stop_at(240, *words, self.folder / "parts")
        self.call(*words, self.folder / "parts")
        self.assertIn("continues at 0.04 s", self.summary("parts/00002")["notes"][0])
        self.assert_same("whole/00002", "parts/00002")

    def test_report_goes_on(self):
        """Stopped in the run, and after it; the page is the same but for the note."""
        needs("plotly.offline")
        from drillmbd import report_linear
        self.call("report", self.scene, "-o", self.folder / "whole")
        words = ("report", self.scene, "-o", self.folder / "parts")
        self.stop_at(51, *words)
        self.assertIn("the same command continues from there", " ".join(self.summary("parts")["notes"]))
        with mock.patch("drillmbd.report.speeds", side_effect=KeyboardInterrupt), mock.patch.dict(
                "drillmbd.report.__dict__", {"buckling_tile": mock.Mock(side_effect=KeyboardInterrupt)}):
            with mock.patch.object(report_linear, "speeds", side_effect=KeyboardInterrupt), mock.patch(
                    "drillmbd.report.limits_at_the_rig", side_effect=KeyboardInterrupt):
                self.call(*words, status=130)
        real = []
        with mock.patch.object(mbd.Sim, "step", lambda *_: real.append(0)):
            out = self.call(*words)
        self.assertEqual(real, [])  # no step is computed again
        self.assertIn("continues at 0.2 s", out)
        self.assert_same("whole", "parts", ("verdicts", "hash", "energy_error", "run", "fatigue"))
        pages = [(self.folder / name / "report.html").read_text(encoding="utf-8") for name in ("whole", "parts")]
        self.assertLess(abs(len(pages[0]) - len(pages[1])), 600)

    def test_real_process(self):
        """By the signal of a terminal, wherever it comes."""
        self.scene.write_text(SCENE.replace('end = "0.2 s"', 'end = "4 s"'), encoding="utf-8")
        command = [*COMMAND, "run", str(self.scene), "-q", "-o"]
        subprocess.run([*command, self.folder / "whole"], check=True, env=ENVIRONMENT)
        stops = 0
        for _ in range(40):
            process = subprocess.Popen([*command, self.folder / "parts"], env=ENVIRONMENT,
                                       preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler))
            begun = time.monotonic()
            while not (self.folder / "parts" / "string_0000.vtp").exists() and time.monotonic() < begun + 60.0:
                time.sleep(0.02)
            time.sleep(0.2 if stops == 0 else 1.0 + 0.3 * stops)
            if stops < 3:
                process.send_signal(signal.SIGINT)
            status = process.wait(timeout=120)
            stops += status == 130
            if status == 0:
                break
        self.assertEqual(status, 0)
        self.assertGreater(stops, 0)
        self.assert_same("whole", "parts")


if __name__ == "__main__":
    unittest.main()
