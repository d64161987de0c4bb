"""Tests of runs in time: many steps in a call give the bits, rows and samples of single ones; notes are kept; Ctrl-C
ends a run soon."""
import math
import os
import signal
import threading
import time
import unittest
import warnings
from unittest import mock

import drillmbd as mbd
from drillmbd import run_quality, running

STEP = 1e-3


def model(callback=False):
    """A string of six eccentric pipes that is turned up to 10 rad/s in a hole."""
    made = mbd.Model()
    made.add_wall()
    string = made.add_pipes(6, eccentricity=1e-3, damping_time=1e-3)
    made.add_bit()
    turning = made.add_time_function((lambda time: 10.0 * min(time, 1.0)) if callback else
                                     mbd.Segment(kind=mbd.SEGMENT_STEP5, x1=0.1, h1=10.0))
    drive = made.add_drive(part=string, component=mbd.RX, time_function=turning)
    made.add_drive(part=string, time_function=made.add_time_function(0.0))
    made.compile()
    return made, string, drive


class Counter:
    """Notes the times of its calls, and how it may be called."""

    def __init__(self, sim, times=None):
        self.sim, self.calls, self.times = sim, [], times

    def take(self):
        self.calls.append(round(self.sim.time / STEP))
        return mbd.OK


class DueCounter(Counter):
    """Has something to do at given times [steps] only, and is called at others too."""

    def take(self):
        if self.times and round(self.sim.time / STEP) >= self.times[0]:
            self.calls.append(round(self.sim.time / STEP))
            self.times = self.times[1:]
        return mbd.OK

    def due(self):
        return STEP * self.times[0] if self.times else float("inf")


class StrideTest(unittest.TestCase):
    def test_same_bits_and_rows(self):
        """Intervals that are, and are not, multiples of the step; the last step is shorter."""
        made, string, drive = model()
        for interval in (0.0, 1e-2, 7.3e-3, 0.4e-3, 1.0):
            with made.sim() as one, made.sim() as other:
                outputs = [(drive, "drive_force"), (string, "rotation")]
                first, second = one.recorder(outputs, 1000, interval), other.recorder(outputs, 1000, interval)
                second.take()
                for _ in range(250):
                    other.step(STEP)
                    second.take()
                other.step(0.2505 - 250 * STEP)
                second.take()
                at = one.run(0.2505, step=STEP, recorder=first)
                self.assertEqual(one.hash(), other.hash())
                self.assertEqual(at.steps, other.statistics().steps)
                self.assertEqual([list(row) for row in first.table], [list(row) for row in second.table], interval)

    def test_profile_recorder(self):
        made, string, _ = model()
        with made.sim() as one, made.sim() as other:
            first, second = (sim.profile_recorder([mbd.PROFILE_TORQUE], 4, 100, 0.013) for sim in (one, other))
            second.take()
            for _ in range(200):
                other.step(STEP)
                second.take()
            first.take()
            one.run(0.2, step=STEP, counters=[first])
            self.assertEqual(first.values.tolist(), second.values.tolist())
            self.assertEqual(first.time.tolist(), second.time.tolist())

    def test_samples_are_taken_when_they_are_due(self):
        made, _, _ = model()
        with made.sim() as sim:
            each, due = Counter(sim), DueCounter(sim, [3, 4, 57, 199])
            sim.run(0.05, step=STEP, counters=[due])
            self.assertEqual(due.calls, [3, 4])
            sim.run(0.1, step=STEP, counters=[each, due])
            self.assertEqual((due.calls, each.calls), ([3, 4, 57], list(range(51, 101))))
            sim.run(0.25, step=STEP, counters=[due])
            self.assertEqual(due.calls, [3, 4, 57, 199])

    def test_calls_are_few(self):
        """Rows each 20 steps: soon 20 steps a call. A callback does not change that."""
        for callback in (False, True):
            made, _, drive = model(callback)
            with made.sim() as sim, mock.patch.object(running, "LONGEST", 10.0), \
                    mock.patch.object(mbd.Sim, "steps", autospec=True, side_effect=mbd.Sim.steps) as steps:
                recorder = sim.recorder([(drive, "drive_force")], 100, 0.02)
                sim.run(1.0, step=STEP, recorder=recorder)
                self.assertEqual(len(recorder), 51)
                self.assertLess(steps.call_count, 60)
                self.assertEqual(max(call.args[2] for call in steps.call_args_list), 20)

    def test_steps(self):
        made, _, _ = model()
        with made.sim() as one, made.sim() as other:
            report = one.steps(STEP, 7)
            for _ in range(7):
                other.step(STEP)
            self.assertEqual((one.hash(), report.steps), (other.hash(), 7))
            self.assertEqual(one.steps(STEP, 0).steps, 0)
            for wrong in ((STEP, -1), (STEP, 1.5), (0.0, 3), ("1 ms", 3)):
                with self.assertRaises(mbd.Error):
                    one.steps(*wrong)
            self.assertEqual(one.hash(), other.hash())


class TimeCounter(Counter):
    """Notes the times themselves."""

    def take(self):
        self.calls.append(self.sim.time)
        return mbd.OK


class OwnStepsTest(unittest.TestCase):
    """Steps of the library's choice: samples are taken after each of them, not only where a call ends."""

    def test_samples_after_each_step(self):
        made, _, drive = model()
        with made.sim(step_max=1e-3) as one, made.sim(step_max=1e-3) as other:
            wanted = []
            other.on_step = wanted.append
            other.run(0.3)
            counter, each, some = TimeCounter(one), *(one.recorder([(drive, "drive_force")], 2000, interval)
                                                      for interval in (0.0, 2e-3))
            some.take()
            at = one.run(0.3, recorder=each, counters=[counter, some])
            self.assertEqual((one.hash(), at.steps), (other.hash(), len(wanted)))
            self.assertGreater(len(wanted), 299)
            self.assertEqual(counter.calls, wanted)
            self.assertEqual([row[0] for row in each.table], [0.0, *wanted])
            self.assertEqual(len(some), 151)

    def test_a_function_of_accepted_steps_stays(self):
        made, _, _ = model()
        with made.sim(step_max=1e-3) as sim:
            seen, counter = [], TimeCounter(sim)

            def ends(time):
                seen.append(time)
                return len(seen) == 5

            sim.on_step = ends
            at = sim.run(0.3, counters=[counter])
            self.assertEqual((at.steps, at.time, counter.calls), (5, seen[-1], seen))
            self.assertIs(sim.on_step, ends)

    def test_bending_once_in_each_call(self):
        """A cantilever turns once in each hundredth of the run, so that the ends of the calls see one stress only. Its
        damage is that of equal steps."""
        rotation = 10.0 * math.pi
        made = mbd.Model()
        string = made.add_pipes(2, damping_time=1e-3)
        turning = made.add_time_function(mbd.Segment(kind=mbd.SEGMENT_STEP5, x1=0.5, h1=rotation))
        made.add_drive(part=string, component=mbd.RX, time_function=turning)
        made.add_drive(part=string, time_function=made.add_time_function(0.0))
        made.compile()
        found = []
        for step in (None, 2e-3):
            with made.sim() as sim:
                sim.static()
                counter = sim.string_fatigue(string, 2, curve_stress=1e8, slope=4.0)
                sim.run(100.0 * 2.0 * math.pi / rotation, step=step, counters=[counter])
                found.append(max(one.damage for one in counter.results))
        self.assertGreater(found[1], 0.0)
        self.assertLess(abs(found[0] / found[1] - 1.0), 0.1)

    def test_fatigue_of_ends_of_pipes(self):
        """A string that sags and turns, held at the rig: cycles are largest at the beginning of its first pipe, and
        where the thin pipes end; by counters at single places."""
        made = mbd.Model()
        string = made.add_pipes(2, length=2.0, joint_length=0.2, joint_outer_diameter=0.09, damping_time=1e-3)
        made.add_pipes(1, string=string, outer_diameter=0.12, damping_time=1e-3)
        turning = made.add_time_function(mbd.Segment(kind=mbd.SEGMENT_STEP5, x1=0.5, h1=10.0))
        made.add_drive(part=string, component=mbd.RX, time_function=turning)
        made.add_drive(part=string, time_function=made.add_time_function(0.0))
        made.compile()
        options, fractions = {"curve_stress": 1e8, "slope": 4.0}, (0.0, 0.5, 0.9 - 1e-9)
        with made.sim() as sim:
            sim.static()
            counter = sim.string_fatigue(string, **options)
            single = {(pipe, fraction): sim.fatigue([mbd.station(string, pipe, fraction)], **options)
                      for pipe in range(2) for fraction in fractions}
            sim.run(3.0, step=2e-3, counters=[counter, *single.values()])
            damage = {place: one.result().damage for place, one in single.items()}
            found = [one.damage for one in counter.results]
            self.assertEqual(found[0], damage[0, 0.0])
            self.assertEqual(found[1], max(damage[1, fraction] for fraction in fractions))
            self.assertGreater(found[0], 2.0 * damage[0, 0.5])
            self.assertEqual(counter.worst, 0)
            self.assertEqual(counter.histogram(), single[0, 0.0].histogram())


class NotesTest(unittest.TestCase):
    def run_of(self, **options):
        made, _, _ = model()
        sim = made.sim(**options)
        self.addCleanup(sim.close)
        return sim

    def test_work_limited(self):
        sim = self.run_of(bounded_work=1, max_iterations=1)
        with self.assertWarnsRegex(RuntimeWarning, "^run: step to time .* accepted as asked"):
            at = sim.run(0.2, step=STEP)
        self.assertGreater(sim.statistics().limited_steps, 0)
        self.assertEqual(at.status, mbd.NOTE_WORK_LIMITED)
        self.assertEqual(list(at.notes), [mbd.NOTE_WORK_LIMITED])

    def test_tolerance(self):
        sim = self.run_of(step_min=5e-4, tolerance_translation=1e-12, tolerance_rotation=1e-12)
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            at = sim.run(0.1)
        self.assertEqual(len(caught), 1)  # of a hundred calls
        self.assertEqual(caught[0].filename, __file__)
        self.assertEqual(at.status, mbd.NOTE_TOLERANCE)
        self.assertIn("above the error tolerance", at.notes[mbd.NOTE_TOLERANCE])

    def test_none(self):
        sim = self.run_of()
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            at = sim.run(0.05, step=STEP)
        self.assertLessEqual(set(at.notes), {mbd.NOTE_STEP_CUT})  # which costs no accuracy
        self.assertEqual(at.status, max(at.notes, default=mbd.OK))


class InterruptTest(unittest.TestCase):
    def setUp(self):
        """As in a program of a user's, whatever a command of another test has installed."""
        self.addCleanup(signal.signal, signal.SIGINT, signal.signal(signal.SIGINT, signal.default_int_handler))

    def test_within_a_third_of_a_second(self):
        """With and without a callback; the recorder has all rows up to there, and the sim goes on."""
        for callback in (False, True):
            made, _, drive = model(callback)
            with made.sim() as sim:
                recorder = sim.recorder([(drive, "drive_force")], 10 ** 6, 2e-3)
                sent = []

                def send():
                    sent.append(time.monotonic())
                    os.kill(os.getpid(), signal.SIGINT)

                timer = threading.Timer(0.3, send)
                timer.start()
                with self.assertRaises(KeyboardInterrupt):
                    sim.run(1e3, step=STEP, recorder=recorder)
                took = time.monotonic() - sent[0]
                timer.join()
                self.assertLess(took, 0.3 + running.LONGEST)
                self.assertIs(signal.getsignal(signal.SIGINT), signal.default_int_handler)
                self.assertEqual(len(recorder), int(sim.time / 2e-3 + 1e-6) + 1)
                before = sim.time
                sim.run(before + 0.01, step=STEP, recorder=recorder)
                self.assertEqual(len(recorder), int(sim.time / 2e-3 + 1e-6) + 1)


class EnergyTest(unittest.TestCase):
    """A spinning body on a spring beside its axis that is far too stiff for the step loses energy by the numerical
    damping of spectral radius 0; with radius 1 it does not, and not with a step of 1e-6 s."""

    def notes(self, step, count, radius):
        made = mbd.Model()
        spinning = made.add_body(mass=10.0, inertia=(0.4, 0.4, 0.4, 0.0, 0.0, 0.0),
                                 velocity=(0.0, 0.0, 0.0, 0.0, 0.0, 60.0))
        made.add_spring(place_b=spinning, offset_b=(0.0, 0.3, 0.0), offset_a=(1.0, 0.3, 0.0), free_length=0.5,
                        stiffness=1e6)
        made.compile()
        out = mock.Mock(summary={})
        with mbd.Sim(made, spectral_radius=radius, energy_ledger=1) as sim:
            sim.steps(step, count)
            run_quality.energy_error(sim, out, run_quality.FirstTenth(sim, 0.0, sim.time), False)
        return [str(call.args[0]) for call in out.note_text.call_args_list], out.summary["energy_error"]

    def test_a_run_that_loses_energy_is_named(self):
        notes, error = self.notes(1e-2, 20, 0.0)
        self.assertGreater(abs(error), run_quality.LARGE)
        self.assertIn("not reliable", " ".join(notes))

    def test_a_run_that_keeps_it_is_not(self):
        for step, count, radius in ((1e-2, 20, 1.0), (1e-6, 200, 0.0)):
            notes, error = self.notes(step, count, radius)
            self.assertLess(abs(error), 1e-3)
            self.assertEqual(notes, [])


if __name__ == "__main__":
    unittest.main()
