"""A horizontal string with a random friction field, pushed by a constant force, shaken at the bit by a mud motor,
against a constant load of the rock, after the published one (Ritto, Escalante, Sampaio, Rosales, J. Sound Vib. 332,
2013; not with its numbers). The ratio of the power that arrives to the power put in has two heaps: strings that slide
all along give load over push, strings that the motor shakes loose in part creep and give less. A rigid bar on the same
friction, which is solved exactly, tells which is which."""
import math
import unittest

from shared_tests import needs

needs("numpy", "scipy")

import numpy as np

from drillmbd.probability import engines
from drillmbd.probability.sampling import Points
from drillmbd.probability.sample import SceneSample
from drillmbd.probability.study import Study

PUSH, ROCK, SAMPLES = 6000.0, 500.0, 24
PIPE = 9.81 * 7850.0 * math.pi / 4.0 * (0.1 ** 2 - 0.08 ** 2)  # [N/m]
SCENE = """title = "horizontal string"
[environment]
gravity = [0, 0, "-9.81 m/s2"]
[hole]
diameter = "0.2 m"
mu_static = 0.30
mu_dynamic = 0.30
smoothing_speed = "0.1 mm/s"
[[string]]
name = "main"
[[string.pipes]]
count = 50
kind = "axial-torsional"
length = "2 m"
outer_diameter = "100 mm"
inner_diameter = "80 mm"
damping_time = "1 ms"
[[time_function]]
name = "motor"
segment = {kind = "harmonic", h1 = 3000, omega = "60 rad/s"}
[[time_function]]
name = "push"
segment = {h0 = 6000}
[[time_function]]
name = "rock"
segment = {h0 = "500 N"}
[[bit]]
name = "bit"
mass = "20 kg"
diameter = 0
load = "rock"
[[load]]
name = "mud motor"
place = {part = "main", pipe = "last", fraction = 1.0}
force = ["1 N", 0, 0]
time_function = "motor"
[[load]]
name = "feed"
place = {part = "main"}
force = ["1 N", 0, 0]
time_function = "push"
[[drive]]
name = "head"
component = "rx"
time_function = "0 rad/s"
[run]
end = "1.5 s"
step = "1 ms"
[results]
interval = "1 ms"
[[output]]
name = "bit"
quantity = "velocity-x"
place = {part = "main", pipe = "last", fraction = 1.0}
[[output]]
name = "rig"
quantity = "velocity-x"
place = {part = "main"}
[variability]
[[variability.field]]
name = "friction"
keys = ["hole.mu_static", "hole.mu_dynamic"]
relative = true
distribution = "lognormal"
mean = 0.9
deviation = "30 %"
correlation_length = "30 m"
spacing = "5 m"
to = "110 m"
[[failure]]
kind = "own"
name = "power ratio"
[[failure]]
kind = "own"
name = "advance"
"""


def power_ratio(look):
    """Power at the rock over that of push and motor, means over the run's second half."""
    late = look.times > 0.5 * look.times[-1]
    bit, rig = look.outputs["bit"][late], look.outputs["rig"][late]
    motor = 3000.0 * np.sin(60.0 * look.times[late]) if motor_runs(look) else 0.0
    return float(np.mean(ROCK * bit) / np.mean(PUSH * rig + motor * bit))


def motor_runs(look):
    return look.scene.model.calls[[name for name, _
                                   in look.scene.model.calls].index("add_time_function")][1][0].get("h1", 0.0) != 0.0


def advance(look):
    """[m] of the rig end, over the run."""
    return float((0.5 * np.diff(look.times) * (look.outputs["rig"][1:] + look.outputs["rig"][:-1])).sum())


def studied(**overrides):
    sample = SceneSample(SCENE, own={"power ratio": power_ratio, "advance": advance}, overrides=overrides)
    points = Points("monte-carlo", 2, sample.dimension, SAMPLES)
    found = Study(sample, engines.processes(2)).run(range(SAMPLES), points.z)
    values = [sample.draw.values(points.z(i))["friction"] for i in range(SAMPLES)]
    messages = [one.message for one in found if one.message]
    if messages:
        raise AssertionError(messages[0])
    return np.array([one.demands for one in found]), np.array(values)


def resistance(factors):
    """[N] friction of a string that slides all along: its weight, the bit's at its end."""
    at = np.arange(0.5, 100.0)
    mu = 0.30 * np.interp(at, 5.0 * np.arange(len(factors)), factors)
    return PIPE * mu.sum() + 20.0 * 9.81 * 0.30 * np.interp(100.0, 5.0 * np.arange(len(factors)), factors)


class RatioTest(unittest.TestCase):
    def test_rigid_bar(self):
        """Without the motor: it advances where the push exceeds friction and rock, by 1/2 (F - R)/m t^2."""
        found, values = studied(**{"time_function[0].segment.h1": 0})
        mass = PIPE / 9.81 * 100.0 + 20.0

        def exact(friction):
            return max(0.0, 0.5 * (PUSH - ROCK - friction) / mass * 1.5 ** 2)
        rests = np.array([resistance(one) for one in values])
        self.assertGreater((rests < PUSH - ROCK).sum(), 3)
        self.assertGreater((rests > PUSH - ROCK).sum(), 3)
        for found_advance, friction in zip(found[:, 1], rests):
            # stretch and the first wave: within 2 % of the friction
            bounds = exact(1.02 * friction), exact(0.98 * friction) + 0.01
            self.assertTrue(bounds[0] <= found_advance <= bounds[1], (found_advance, bounds))

    def test_two_heaps(self):
        found, values = studied(**{"run.end": "3 s"})
        share, rests = found[:, 0] / (ROCK / PUSH), np.array([resistance(one) for one in values]) / (PUSH - ROCK)
        sliding, creeping = share[rests < 0.97], share[rests > 1.03]
        self.assertGreater(min(len(sliding), len(creeping)), 4)
        self.assertLess(abs(sliding - 1.0).max(), 0.02, sliding)
        self.assertLess(creeping.max(), 0.98, creeping)
        self.assertLess(creeping.mean(), 0.93)
        self.assertGreater(creeping.std(), 5.0 * sliding.std())


if __name__ == "__main__":
    unittest.main()
