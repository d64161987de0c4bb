"""Tests of the analyses of a study: torque and drag, static states, runs, and auto; against closed forms, against each
other, and against the analyses of the library on scenes that are read anew; of demands, stop rules and maps."""
import csv
import json
import math
import unittest
import unittest.mock

from shared_tests import FolderTest, needs

needs("h5py", "numpy", "scipy")

import numpy as np
import scipy.stats as stats

from drillmbd import scene
from drillmbd.operating import operating, operations_of
from drillmbd.probability import auto, demands, engines, limits, soft, until
from drillmbd.probability.draw import CannotDraw
from drillmbd.probability.estimates import Estimate, clopper_pearson, counted
from drillmbd.probability.sampling import drawn
from drillmbd.probability.sample import SceneSample, worst
from drillmbd.probability.study import Study, read_rows
from drillmbd.scene.failure import KINDS
from test_engines import SCENE as SHORT

#: A straight horizontal hole of 60 m without buoyancy: thrust = load + mu w L, pull = mu w L, torque = mu w L D/2 + 0.5
#: load d/3.
LEVEL = """[environment]
fluid_density = 0
[hole]
diameter = "94 mm"
mu_static = 0.3
mu_dynamic = 0.3
survey = [["0 m", "90 deg", 0], ["60 m", "90 deg", 0]]
[[time_function]]
name = "rock"
segment = {table = [["0 s", 0], ["1 s", "8 kN"]]}
[[time_function]]
name = "turning"
segment = {kind = "step5", x1 = "1 s", h1 = "100 rpm"}
[[time_function]]
name = "feeding"
segment = {kind = "step5", x1 = "1 s", h1 = "10 mm/s"}
[[string]]
name = "rods"
[[string.pipes]]
count = 40
length = "1.5 m"
outer_diameter = "73 mm"
inner_diameter = "61 mm"
[[bit]]
name = "bit"
load = "rock"
mass = "1 g"
diameter = "94 mm"
[[drive]]
name = "feed"
time_function = "feeding"
[[drive]]
name = "head"
component = "rx"
time_function = "turning"
[static]
lay_on_wall = true
[run]
end = "2 s"
step = "1 ms"
[variability]
question = "torque-drag"
[[variability.scatter]]
name = "friction"
keys = ["hole.mu_static", "hole.mu_dynamic"]
distribution = "normal"
mean = 0.3
deviation = 0.03
"""
WEIGHT = 9.81 * 7850.0 * math.pi / 4.0 * (0.073 ** 2 - 0.061 ** 2) * 60.0  # [N]


def failure(kind, **keys):
    return f'[[failure]]\nkind = "{kind}"\n' + "".join(f"{key} = {value!r}\n" for key, value in keys.items())


FORCES = failure("rig-push", limit="12 kN") + failure("rig-pull", limit="3 kN") + failure("rig-torque", limit="250 N m")
ALL = FORCES + failure("lock-up") + failure("helical-buckling") + failure("stress", strength="500 MPa") \
    + failure("connection-torque", limit="2 kN m") + failure("wall-pressure", limit="1 MPa", width="20 mm")
FIELD = """[[variability.field]]
name = "size"
key = "hole.diameter"
distribution = "uniform"
low = "94.5 mm"
high = "100 mm"
correlation_length = "8 m"
to = "60 m"
[[variability.scatter]]
name = "wear"
key = "string[0].pipes[0].outer_diameter"
relative = true
distribution = "uniform"
low = 0.97
high = 1
[[variability.scatter]]
name = "mud"
key = "environment.fluid_density"
distribution = "uniform"
low = "900 kg/m3"
high = "1100 kg/m3"
[[variability.process]]
name = "rock load"
time_function = "rock"
distribution = "gamma"
mean = 1
deviation = 0.2
correlation_time = "0.1 s"
"""


def known_demands(sample, z):
    """Torque and drag by the analyses of the library on the whole scene, read anew for the sample."""
    made = scene.loads(sample.text, changes={**sample.draw.overrides(sample.draw.values(z)),
                                             "string[0].pipes[0].yield_strength": "500 MPa"})
    plan = operating(made)
    with made.new_sim() as sim:
        usual = operations_of(plan)
        chosen = [usual[int(kind)] for kind in soft.STATES.values()]
        pull, push, turn = rows = sim.torque_drag(chosen).rows[0]
        force = max(max(sim.torque_drag_profile(one, soft.STATIONS)["wall_force"]) for one in chosen)
    thrust = max(-row.hook_load for row in rows)
    return [max(-push.hook_load, -turn.hook_load), pull.hook_load, turn.torque, plan.weight_on_bit / thrust,
            max(row.helical_share for row in rows),
            max(row.yield_share for row in rows), turn.torque, force / 0.02]


class SoftTest(unittest.TestCase):
    def check(self, text, why=""):
        sample = SceneSample(text)
        self.assertEqual(sample.soft.why, why)
        for number in range(5):
            z = drawn(3, number, sample.dimension)
            for mine, known in zip(sample(number, z).demands, known_demands(sample, z)):
                self.assertLess(abs(mine / known - 1.0), 1e-9, (number, mine, known))

    def test_against_the_library(self):
        self.check(LEVEL + ALL)
        self.check(LEVEL + FIELD + ALL)

    def test_scenes_that_are_read_anew(self):
        more = '[[variability.field]]\nname = "survey"\nkey = "hole.survey.inclination"\ndistribution = "normal"\n' \
               'mean = 0\ndeviation = "0.3 deg"\ncorrelation_length = "20 m"\n'
        self.check(LEVEL + more + ALL, "survey is no factor of the numbers that it changes")
        self.assertIn("reads the scene again", SceneSample(LEVEL + more + ALL).soft.notes()[0])

    def test_another_string(self):
        """Torque and drag computes the first string: a failure of another one is refused, by string, drive and bit; a
        static state computes it."""
        thick = LEVEL.replace('[[bit]]', """[[string]]
name = "thick"
[[string.pipes]]
count = 60
outer_diameter = "89 mm"
[[drive]]
name = "other head"
part = "thick"
component = "rx"
time_function = "turning"
[[drive]]
name = "other feed"
part = "thick"
time_function = "feeding"
[[bit]]
string = "thick"
name = "other bit"
diameter = 0
[[bit]]
""", 1).replace('name = "feed"', 'name = "feed"\npart = "rods"').replace('name = "head"',
                                                                         'name = "head"\npart = "rods"')
        kept = failure("rig-torque", head="head", limit="1 kN m") + failure("lock-up", bit="bit", feed="feed")
        self.assertEqual(len(SceneSample(thick + kept).names), 2)
        for more in (failure("connection-torque", string="thick", limit="1 kN m"),
                     failure("rig-torque", name="other", head="other head", limit="1 kN m"),
                     failure("lock-up", name="other", bit="other bit", feed="feed")):
            with self.assertRaisesRegex(CannotDraw, "is about the string thick: torque and drag computes the first "
                                                    "string only, rods"):
                SceneSample(thick + kept + more).names
        both = SceneSample(thick.replace('"torque-drag"', '"static"') + "".join(
            failure("connection-torque", name=one, string=one, limit="1 kN m") for one in ("rods", "thick")))
        thin, heavy = both(0, np.zeros(both.dimension)).demands
        # the estimated torque of the bit is part of both
        self.assertGreater(heavy, 1.5 * thin)

    def test_closed_form(self):
        sample = SceneSample(LEVEL + FORCES)
        for number in range(5):
            z = drawn(3, number, 1)
            mu = 0.3 + 0.03 * z[0]
            push, pull, torque = sample(number, z).demands
            self.assertAlmostEqual(push / (8000.0 + mu * WEIGHT), 1.0, 5)  # the bit's 1 g, and the helix-free contact
            self.assertAlmostEqual(pull / (mu * WEIGHT), 1.0, 5)
            around = 200.0 * math.pi / 60.0 * 0.0365
            # share of the friction that resists the rotation, beside the feed
            turned = around / math.hypot(around, 0.01)
            self.assertAlmostEqual(torque / (turned * mu * WEIGHT * 0.0365 + 0.5 * 8000.0 * 0.094 / 3.0), 1.0, 5)

    def test_linear_gaussian(self):
        """P(load + mu w L > limit) = Phi(-beta), exact by FORM because the margin is linear."""
        needs("openturns")
        from drillmbd.probability.estimates import form
        sample = SceneSample(LEVEL + failure("rig-push", limit="9.5 kN"))
        found = form(Study(sample, engines.serial).evaluate(0), 1)
        slope = (sample(0, np.ones(1)).demands[0] - sample(1, -np.ones(1)).demands[0]) / 2.0
        beta = (9500.0 - 8000.0 - 0.3 * WEIGHT) / (0.03 * WEIGHT)
        self.assertLess(abs(slope / (0.03 * WEIGHT) - 1.0), 1e-6)
        self.assertLess(abs(found.probability - stats.norm.cdf(-beta)), 1e-6)

    def test_lock_up(self):
        """A string that no thrust moves fails by every kind that thrust decides, and has no finite demand."""
        made = limits.Soft({"pulled out": _row(100.0), "pushed in": _row(math.nan, 1), "rotated": _row(-50.0)}, 10.0,
                           1e9)
        failures = scene.loads(LEVEL + FORCES + failure("lock-up")).failures
        found = {one.kind: limits.soft_margin(one, made) for one in failures}
        self.assertEqual(found["rig-push"], (-math.inf, math.inf))
        self.assertEqual(found["lock-up"], (-0.1, 0.0))
        self.assertEqual(found["rig-pull"], (2900.0, 100.0))

    def test_jamming(self):
        """The rig overcomes what its pull leaves beyond the friction, or its torque at the radius of the rods."""
        mu, radius = 0.3, 0.0365
        for pull, torque in ((20e3, 400.0), (20e3, 2000.0)):
            sample = SceneSample(LEVEL + failure("jamming", limit="10 kN", pull=f"{pull} N", torque=f"{torque} N m",
                                                 diameter="73 mm"))
            around = 200.0 * math.pi / 60.0 * radius
            turned = mu * WEIGHT * radius * around / math.hypot(around, 0.01) + 0.5 * 8000.0 * 0.094 / 3.0
            known = max(pull - mu * WEIGHT, (torque - turned) / radius)
            found = sample(0, np.zeros(1))
            self.assertAlmostEqual(found.demands[0] / known, 1.0, 5)
            self.assertAlmostEqual(found.margins[0], found.demands[0] - 10e3, 9)
        with self.assertRaisesRegex(scene.SceneError,
                                    'jamming: needs question = "torque-drag"|needs question = "torque-drag"'):
            scene.loads(LEVEL.replace('"torque-drag"', '"static"') + failure("jamming", limit="1 kN", pull="1 N",
                                                                             torque="1 N m", diameter="73 mm"))

    def test_leaves_seam(self):
        """An error of the dip that is the same along the hole: sin of it times the length."""
        more = '[[variability.field]]\nname = "survey"\nkey = "hole.survey.inclination"\ndistribution = "normal"\n' \
               'mean = 0\ndeviation = "0.5 deg"\ncorrelation_length = "1000 km"\nkernel = "gaussian"\n'
        for question in ("torque-drag", "static"):
            sample = SceneSample(LEVEL + more + failure("leaves-seam", limit="0.4 m")
                                 + failure("rig-pull", limit="3 kN"), given_question=question)
            z = np.zeros(sample.dimension)
            z[1] = 1.3
            known = 60.0 * math.sin(math.radians(0.5 * 1.3 * sample.draw.fields[0][1].matrix[0, 0]))
            self.assertLess(abs(sample(0, z).demands[0] / abs(known) - 1.0), 1e-3)
        deeper = LEVEL.replace('name = "rods"', 'name = "rods"\nstart_depth = "20 m"').replace("count = 40",
                                                                                              "count = 20")
        sample = SceneSample(deeper + more + failure("leaves-seam", limit="0.4 m"), given_question="torque-drag")
        self.assertLess(abs(sample(0, z).demands[0] / abs(known) * 60.0 / 50.0 - 1.0), 1e-3)  # 30 m from 20 m on
        self.assertEqual(SceneSample(LEVEL + failure("leaves-seam", limit="0.4 m"))(0, np.zeros(1)).demands, [0.0])

    def test_registry(self):
        for word, kind in KINDS.items():
            if word not in limits.BESIDE:
                self.assertEqual("torque-drag" in kind.questions, limits.HOW[word].soft is not None, word)
            self.assertTrue(kind.questions)


def _row(hook_load, locked=0):
    made = soft.TorqueDragRow.blank()
    made.locked = locked
    soft.Structure.__setattr__(made, "hook_load", hook_load)
    return made


class StaticTest(unittest.TestCase):
    def test_worst_of_three(self):
        """Pushed in with the load of the bit, pulled out without, rotated with its torque; the bit load is 0 at time
        0."""
        sample = SceneSample(LEVEL + FORCES, given_question="static")
        inertia = math.pi / 64.0 * (0.073 ** 4 - 0.061 ** 4)
        # [m] not on the floor behind the rig, which bears 2/3 of its weight
        lifted = (72.0 * 2.1e11 * inertia * 0.0105 / (WEIGHT / 60.0)) ** 0.25
        for z in (-1.0, 0.0, 1.0):
            push, pull, torque = sample(0, np.array([z])).demands
            friction = (0.3 + 0.03 * z) * WEIGHT * (1.0 - 2.0 / 3.0 * lifted / 60.0)
            # a string that turns lies beside the bottom, where its weight has a part along the wall
            climbs = math.hypot(1.0, 0.3 + 0.03 * z)
            for found in (push - 8000.0, pull, (torque - 0.5 * 8000.0 * 0.094 / 3.0) / 0.0365 * climbs):
                self.assertLess(abs(found / friction - 1.0), 0.03)  # contact is 1.5 m apart

    def test_refused(self):
        with self.assertRaisesRegex(CannotDraw,
                                    r"failure stick-slip \(stick-slip\): the question static says nothing about it; "
                                    r"ask --question run"):
            SceneSample(LEVEL.replace('question = "torque-drag"', "") + failure("stick-slip"),
                        given_question="static").names
        with self.assertRaisesRegex(CannotDraw, "from = 1 s is for runs in time"):
            SceneSample(LEVEL.replace('question = "torque-drag"', "")
                        + failure("rig-push", limit="1 kN", **{"from": "1 s"}), given_question="torque-drag").names
        with self.assertRaisesRegex(scene.SceneError, "needs question = \"static\" or|needs a run in time"):
            scene.loads(LEVEL + failure("stick-slip"))


class DemandTest(unittest.TestCase):
    def test_order_statistics(self):
        """Ranks 40 and 61 bound the median of 100 values with 95 % (tables of Hahn and Meeker 1991)."""
        self.assertEqual(demands.percentile(np.arange(1.0, 101.0), 50, 0.95), (50.0, 40.0, 61.0))
        value, low, high = demands.percentile(np.arange(1.0, 21.0), 95, 0.95)
        self.assertEqual((value, high), (19.0, math.inf))
        self.assertGreater(low, 10.0)

    def test_coverage(self):
        rng, inside = np.random.default_rng(1), 0
        for _ in range(400):
            _, low, high = demands.percentile(np.sort(rng.standard_normal(200)), 95, 0.95)
            inside += low <= stats.norm.ppf(0.95) <= high
        self.assertGreaterEqual(inside, 372)

    def test_lost_samples(self):
        """The interval of a percentile holds whatever the lost samples are."""
        ranked, lost = np.sort(np.random.default_rng(4).standard_normal(200)), 20
        for percent in demands.PERCENTS:
            _, low, high = demands.percentile(ranked, percent, 0.95, lost)
            for guess in (-9.0, 0.0, 9.0):
                whole = demands.percentile(np.sort(np.concatenate([ranked, np.full(lost, guess)])), percent, 0.95)
                self.assertTrue(low <= whole[1] and whole[2] <= high, (percent, guess))
        one = scene.loads(LEVEL + failure("rig-push", limit="12 kN")).failures[0]
        found = demands.demand_of(one, np.append(ranked, [math.nan] * lost), np.zeros((220, 1)), ["x"], 0.95)
        self.assertIn("of the 200 of 220 samples that have one", found.sentence(0.95))

    def test_weighted_percentiles(self):
        """Samples with weights, as the runs of the question auto: the intervals contain the true percentile; equal
        weights give the values of order statistics; lost weight widens the interval on both sides; a sample with nearly
        all of the weight bounds nothing."""
        random, inside, spread = np.random.default_rng(11), {5: 0, 50: 0, 95: 0}, math.sqrt(1.09)
        for _ in range(100):
            soft = random.standard_normal(400)
            run = soft + 0.3 * random.standard_normal(400)
            near = soft > 1.2
            taken = near | (random.random(400) < 0.25)
            for percent in inside:
                value, low, high = demands.weighted_percentile(run[taken], np.where(near, 1.0, 4.0)[taken], percent,
                                                               0.95)
                self.assertTrue(low <= value <= high)
                inside[percent] += low <= spread * stats.norm.ppf(percent / 100.0) <= high
        self.assertGreaterEqual(min(inside.values()), 88, inside)
        values, ones = random.standard_normal(200), np.ones(200)
        for percent in inside:
            found, plain = demands.weighted_percentile(values, ones, percent,
                                                       0.95), demands.percentile(np.sort(values), percent, 0.95)
            self.assertEqual(found[0], plain[0])
            self.assertEqual(found[0], demands.weighted_percentile(values, 3.0 * ones, percent, 0.95)[0])
            ranks = [np.searchsorted(np.sort(values), one) for one in (*found[1:], *plain[1:])]
            self.assertLessEqual(max(abs(ranks[0] - ranks[2]), abs(ranks[1] - ranks[3])), 4)
            lost = demands.weighted_percentile(values, ones, percent, 0.95, 20.0)
            self.assertTrue(lost[1] <= found[1] and lost[2] >= found[2])
        self.assertEqual(demands.weighted_percentile(values, ones, 95, 0.95, 20.0)[2], math.inf)
        one = np.where(np.arange(200) == 7, 1e9, 1.0)
        for percent in inside:
            self.assertEqual(demands.weighted_percentile(values, one, percent, 0.95), (values[7], -math.inf, math.inf))

    def test_weighted_matters(self):
        """A sample with the weight 2 counts as two of them."""
        random = np.random.default_rng(3)
        inputs = random.standard_normal((40, 2))
        values, twice = inputs[:, 0] + random.standard_normal(40), np.where(np.arange(40) % 3, 1, 2)
        a = demands.matters(values, inputs, ["x", "y"], twice.astype(float))
        b = demands.matters(np.repeat(values, twice), np.repeat(inputs, twice, axis=0), ["x", "y"])
        for one, other in zip(a, b):
            self.assertEqual(one.name, other.name)
            self.assertAlmostEqual(one.rank, other.rank, 12)
        self.assertAlmostEqual(b[0].rank, stats.spearmanr(np.repeat(values, twice), np.repeat(inputs[:, 0], twice))[0],
                               12)

    def test_matters(self):
        rng = np.random.default_rng(2)
        inputs = rng.standard_normal((500, 3))
        found = demands.matters(3.0 * inputs[:, 1] - inputs[:, 0] + 0.1 * rng.standard_normal(500), inputs,
                                ["a", "b", "c"])
        self.assertEqual([one.name for one in found], ["b", "a", "c"])
        known = stats.spearmanr(inputs[:, 1], 3.0 * inputs[:, 1] - inputs[:, 0])[0]
        self.assertLess(abs(found[0].rank - known), 0.01)
        self.assertLess(abs(found[2].rank), 2.0 * found[2].least)

    def test_signals_without_a_value(self):
        """A signal or a state without a value is no demand of 0, and no margin."""
        signals = {key: np.array([1.0, math.nan]) for key in ("most", "least")}
        for demand in (limits._tightening, limits._loosening):
            self.assertTrue(math.isnan(demand(np.array([0.0, 1.0]), signals, {})))
            self.assertEqual(demand(np.zeros(1), {"most": np.array([-1.0]), "least": np.array([1.0])}, {}), 0.0)
        self.assertEqual(worst([(2.0, 5.0), (1.0, 7.0)]), (1.0, 7.0))
        for found in ([(math.nan, 0.0), (1.0, 7.0)], [(1.0, 7.0), (math.nan, 0.0)]):
            self.assertTrue(math.isnan(worst(found)[0]))

    def test_strings_that_lock_up(self):
        one = scene.loads(LEVEL + failure("rig-push", limit="12 kN")).failures[0]
        values = np.array([1.0, 2.0, math.nan] + [math.inf] * 10)
        found = demands.demand_of(one, values, np.zeros((13, 1)), ["x"], 0.95)
        self.assertEqual((found.infinite, found.percentiles[-1].value, sum(found.counts)), (10, math.inf, 2))
        self.assertIn("P95 without bound", found.sentence(0.95))
        self.assertIsNone(demands.demand_of(one, np.full(3, math.nan), np.zeros((3, 1)), ["x"], 0.95))


class UntilTest(FolderTest):
    SCENE = LEVEL + failure("rig-push", limit="9.9 kN")

    def test_rules(self):
        one = Estimate(0.1, 0.08, 0.13, 0.95, "", 1, 1, 0)
        self.assertTrue(until.rule("30%").met(one))
        self.assertFalse(until.rule("20 %").met(one))
        self.assertTrue(until.rule("below 0.2").met(one))
        self.assertTrue(until.rule("below 0.05").met(one))
        self.assertIn("is above 0.05", until.rule("below 0.05").verdict(one))
        self.assertFalse(until.rule("below 0.1").met(one))
        self.assertFalse(until.rule("30%").met(Estimate(0.0, 0.0, 0.1, 0.95, "", 1, 0, 0)))
        self.assertIn("no sample with a margin failed",
                      until.rule("30%").verdict(Estimate(0.0, 0.0, 0.1, 0.95, "", 2, 0, 1)))
        lost = counted([math.nan] * 5)
        for text in ("30%", "below 0.5"):
            self.assertFalse(until.rule(text).met(lost))
            self.assertEqual(until.rule(text).verdict(lost), "not assessed, because no sample has a margin")
        for text in ("", "many", "0 %", "200%", "below 2", "below", "1e-12"):
            with self.assertRaisesRegex(Exception, "write a share of the probability"):
                until.rule(text)

    def test_verdicts_hold(self):
        """A study that stops as soon as its interval leaves the bound, at a probability that is the bound: a verdict is
        wrong in 5 of 100 cases at most, though there are nine looks; in more than 20 if each look had an interval of 95
        %."""
        bound, repeats, most = 0.02, 400, 20_000
        self.assertEqual(until.looks(most), 9)

        def wrong(confidence):
            rng, count = np.random.default_rng(5), 0
            for _ in range(repeats):
                failures = samples = 0
                while samples < most:
                    more = until.following(samples, most)
                    failures += int(rng.binomial(more - samples, bound))
                    samples = more
                    low, high = clopper_pearson(failures, samples, confidence)
                    if high < bound or low > bound:
                        count += 1
                        break
            return count / repeats

        self.assertLessEqual(wrong(until.spent(0.95, most)), 0.05)
        self.assertGreater(wrong(0.95), 0.2)

    def test_command(self):
        """Stops at the first look at which the rule is met, and at --samples where it never is."""
        out = self.call("probability", self.scene, "-o", self.folder / "out", "--until", "30%", "--engine", "serial")
        estimate = json.loads((self.folder / "out"
                               / "summary.json").read_text(encoding="utf-8"))["estimates"]["rig-push"]
        self.assertLessEqual(0.5 * (estimate["high"] - estimate["low"]), 0.3 * estimate["probability"])
        self.assertIn("half of the interval is", out)
        margins = read_rows(self.folder / "out" / "study.h5")[0]["margin"][:, 0]
        looks = [until.FIRST]
        while looks[-1] < len(margins):
            looks.append(until.following(looks[-1], until.MOST))
        self.assertEqual((looks[-1], len(looks) > 1), (len(margins), True))
        self.assertFalse(until.rule("30%").met(counted(margins[:looks[-2]], confidence=until.spent(0.95, until.MOST))))
        out = self.call("probability", self.scene, "--until", "below 1e-6", "--samples", 300, "--engine", "serial")
        self.assertIn("after", out)
        self.assertIn("write a share", self.call("probability", self.scene, "--until", "soon", status=2))
        self.assertIn("--until adds samples", self.call("probability", self.scene, "--until", "30%", "--method",
                                                        "sobol", status=2))


class MapTest(FolderTest):
    SCENE = LEVEL + failure("rig-push", limit="9.5 kN")
    WORDS = ("--vary", "hole.diameter=94 mm,98 mm", "--vary", "failure.limit=9.3 kN:9.7 kN:3", "--samples", 400,
             "--engine", "serial")

    def test_map(self):
        out = self.call("probability", self.scene, "-o", self.folder / "out", *self.WORDS)
        summary = json.loads((self.folder / "out" / "summary.json").read_text(encoding="utf-8"))
        with open(self.folder / "out" / "map.csv", encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), 6)
        for row, cell in zip(rows, summary["cells"]):
            limit = 1000.0 * float(row["failure.limit"].split()[0])
            known = stats.norm.sf((limit - 8000.0 - 0.3 * WEIGHT) / (0.03 * WEIGHT))
            low, high = float(row["low of rig-push"]), float(row["high of rig-push"])
            self.assertTrue(low <= known <= high, (low, known, high))
            known = 8000.0 + (0.3 + 0.03 * stats.norm.ppf(0.95)) * WEIGHT
            ends = cell["demands"]["rig-push"]["percentiles"]["P95"]
            self.assertTrue(ends["low"] <= known <= ends["high"])
        shares = [float(row["probability of rig-push"]) for row in rows]
        # the same random numbers, and the diameter does not matter in a straight hole
        self.assertEqual(shares[:3], shares[3:])
        self.assertTrue(shares[0] > shares[1] > shares[2])
        self.assertEqual([row["fails only here"] for row in rows], ["0"] * 6)
        self.assertEqual(int(rows[1]["fails only in the first cell"]), round(400 * (shares[0] - shares[1])))
        self.assertIn("cell 6: hole.diameter = 98 mm, failure.limit = 9.7 kN: any failure", out)
        self.assertGreater((self.folder / "out" / "map.png").stat().st_size, 5000)
        before = read_rows(self.folder / "out" / "00004" / "study.h5")[0]["seconds"].tolist()
        self.call("probability", self.scene, "-o", self.folder / "out", *self.WORDS)
        # nothing is computed again
        self.assertEqual(read_rows(self.folder / "out" / "00004" / "study.h5")[0]["seconds"].tolist(), before)

    def test_a_second_master(self):
        """It is refused at once and changes nothing; afterwards the folder is free."""
        from drillmbd.probability.study import Lock
        folder = self.folder / "out"
        folder.mkdir()
        lock = Lock(folder / "map")
        words = ("probability", self.scene, "-o", folder, "--vary", "hole.diameter=94 mm,98 mm", "--samples", 20,
                 "--engine", "serial")
        said = self.call(*words, status=2)
        self.assertIn("another run writes it now; wait for it, or give another --output folder", said)
        self.assertNotIn("cell 1", said)
        self.assertFalse((folder / "00001").exists())
        lock.release()
        self.assertIn("cell 2", self.call(*words))

    def test_a_cell_that_cannot_be(self):
        out = self.call("probability", self.scene, "--vary", "hole.diameter=94 mm,60 mm,-1 mm", "--samples", 20,
                        "--engine", "serial", status=1)
        self.assertNotIn("Traceback", out)

    def test_refused(self):
        for words, wanted in ((("--vary", "x"), "write KEY=V1,V2"),
                              (("--vary", "hole.diameter=1:2:401"), "401 cells, must be <= 400"),
                            (("--vary", "hole.diameter=1", "--vary", "hole.diameter=2"), "give each key once"),
                            (("--vary", "hole.diameter=94 mm", "--method", "subset"),
                             "leave --indices and --method subset out")):
            self.assertIn(wanted, self.call("probability", self.scene, *words, status=2))
        said = self.call("sweep", self.scene, "probability", "--vary", "hole.diameter=94 mm", status=2)
        self.assertIn("drillmbd probability", said)
        self.assertIn("--vary 'hole.diameter=94 mm'", said)


class AutoTest(FolderTest):
    SCENE = SHORT.replace('limit = "111 N m"', 'limit = "1.5 N m"')

    def test_unbiased(self):
        """Torque and drag that are wrong for some of the samples: the estimate is right in the mean, its interval in 95
        of 100."""
        rng, truth, values, inside, repeats = np.random.default_rng(3), 0.0, [], 0, 300
        a, b = 1.2, 0.8
        truth = float(stats.norm.sf(a / math.hypot(1.0, b)))
        for _ in range(repeats):
            x, y = rng.standard_normal(1000), rng.standard_normal(1000)
            cheap, run = a - x, a - x - b * y
            near = abs(cheap) < auto.NEAR
            ran = near | (rng.random(1000) < auto.FAR)
            one = auto.Stage(cheap <= 0.0, near, ran, ran, ran & (run <= 0.0), auto.FAR).estimate(0.95)
            values.append(one.probability)
            inside += one.low <= truth <= one.high
        self.assertLess(abs(np.mean(values) - truth), 4.0 * np.std(values) / math.sqrt(repeats))
        self.assertGreaterEqual(inside / repeats, 0.95)

    def test_nothing_far_was_seen(self):
        """No run among samples that are far: their share stays in the interval."""
        safe = np.zeros(100, bool)
        one = auto.Stage(safe, safe, safe, safe, safe, auto.FAR).estimate(0.95)
        self.assertEqual((one.probability, one.low, one.high), (0.0, 0.0, 1.0))

    def test_lost_runs(self):
        """The interval holds whatever lost runs would have shown: all of them failures, or none, among samples that are
        near a limit and among the others, predicted as failures or not."""
        rng = np.random.default_rng(5)
        for share, predicted_share, near_share in ((0.05, 0.0, 0.0), (0.05, 0.0, 0.5), (0.95, 1.0, 0.0),
                                                   (0.5, 0.5, 0.2)):
            for lost_fail in (True, False):
                inside = 0
                for _ in range(100):
                    fails, near = rng.random(2000) < share, rng.random(2000) < near_share
                    chosen = near | (rng.random(2000) < auto.FAR)
                    ran = chosen & (fails != lost_fail)
                    one = auto.Stage(rng.random(2000) < predicted_share, near, chosen, ran, ran & fails,
                                     auto.FAR).estimate(0.95)
                    self.assertEqual(one.lost, int((chosen & ~ran).sum()))
                    inside += one.low <= share <= one.high
                self.assertGreaterEqual(inside, 95, (share, predicted_share, near_share, lost_fail))

    def test_all_runs_are_lost(self):
        """No probability, also where torque and drag of all samples predict no failure."""
        self.scene = self.write("lost.toml",
                                self.SCENE + "[sim]\nnewton_tolerance = 1e-14\nmax_iterations = 2\nmax_cuts = 0\n")
        with unittest.mock.patch.object(auto, "LEAST", 4), unittest.mock.patch.object(auto.CommandOutput, "say") as say:
            self.call("probability", self.scene, "-o", self.folder / "auto", "--samples", 40, "--workers", 2,
                      "--question", "auto", status=1)
        out = "\n".join(str(one.args[0]) for one in say.call_args_list)
        self.assertRegex(out, r"any failure: not assessed, because none of [0-9]+ runs has a margin")
        self.assertNotIn("interval", out)
        summary = json.loads((self.folder / "auto" / "summary.json").read_text(encoding="utf-8"))
        self.assertIsNone(summary["estimates"]["any failure"]["probability"])

    def test_against_plain_runs(self):
        """The same decision for every sample that both computed."""
        self.call("probability", self.scene, "-o", self.folder / "plain", "--samples", 40, "--workers", 2)
        with unittest.mock.patch.object(auto, "LEAST", 4):
            out = self.call("probability", self.scene, "-o", self.folder / "auto", "--samples", 40, "--workers", 2,
                            "--question", "auto")
        plain = {int(row["number"]): row["margin"].tolist() for row in read_rows(self.folder / "plain" / "study.h5")[0]}
        rows = read_rows(self.folder / "auto" / "study.h5")[0]
        self.assertTrue(0 < len(rows) < 40, len(rows))
        self.assertEqual([row["margin"].tolist() for row in rows], [plain[int(row["number"])] for row in rows])
        summary = json.loads((self.folder / "auto" / "summary.json").read_text(encoding="utf-8"))
        self.assertEqual(summary["question"], "auto")
        found = summary["estimates"]["any failure"]
        known = sum(min(margins) <= 0.0 for margins in plain.values()) / 40
        self.assertTrue(found["low"] <= known <= found["high"])
        self.assertIn("others with the weight 10", out)
        self.assertEqual(len(read_rows(self.folder / "auto" / "study_torque_drag.h5")[0]), 40)
        again = self.call("probability", self.scene, "-o", self.folder / "auto", "--samples", 40, "--workers", 2,
                          "--question", "auto")
        self.assertIn(f"{40 - len(rows)} samples computed", again)  # so few are all run
        summary = json.loads((self.folder / "auto" / "summary.json").read_text(encoding="utf-8"))
        self.assertAlmostEqual(summary["estimates"]["any failure"]["probability"], known, 12)
        whole = json.loads((self.folder / "plain" / "summary.json").read_text(encoding="utf-8"))["demands"]
        self.assertEqual(summary["demands"].keys(), whole.keys())
        for name, demand in whole.items():
            self.assertEqual([one["value"] for one in summary["demands"][name]["percentiles"].values()],
                             [one["value"] for one in demand["percentiles"].values()])
        self.assertIn("runs by their weights) P5", out)
        self.assertIn("Monte Carlo study", self.call(
            "probability", self.scene, "--question", "auto", "--until", "30%", status=2))


if __name__ == "__main__":
    unittest.main()
