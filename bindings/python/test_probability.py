"""Tests of what varies and what fails: distributions against their moments, ranks, covariances and Nataf's closed form;
the margin of every limit state against what is known in closed form; the tables of scene files, good and bad.
Equations: eq:probability.margin, eq:probability.translation, eq:probability.nataf, eq:probability.field,
eq:probability.markov."""
import json
import math
import pathlib
import tempfile
import unittest

from shared_tests import DRIVES, needs

needs("numpy", "scipy.stats")

import numpy as np
import scipy.stats as stats

from drillmbd import enums, scene
from drillmbd.operating import BIT_FRICTION
from drillmbd.probability import limits, sample as samples, statics
from drillmbd.probability.draw import CannotDraw, Draw, value_of_segments
from drillmbd.probability.fields import Expansion, Markov, kernel
from drillmbd.probability.marginals import Translation, frozen, nataf, value_correlation
from drillmbd.probability.sample import DONE, FAILED, Own, SceneSample
from drillmbd.scene.failure import KINDS
from drillmbd.scene.variability import DISTRIBUTIONS, KERNELS, Marginal

MARGINALS = [Marginal("normal", {"mean": 3.0, "deviation": 0.5}),
             Marginal("lognormal", {"mean": 3.0, "deviation": 1.5}),
             Marginal("gamma", {"mean": 3.0, "deviation": 1.5}), Marginal("gumbel", {"mean": 3.0, "deviation": 1.5}),
             Marginal("weibull", {"shape": 2.0, "scale": 3.0}), Marginal("exponential", {"mean": 3.0}),
             Marginal("uniform", {"low": 1.0, "high": 4.0}),
             Marginal("triangular", {"low": 1.0, "mode": 2.0, "high": 6.0}),
             Marginal("beta", {"low": 1.0, "high": 5.0, "mean": 2.0, "deviation": 0.7}),
             Marginal("truncated-normal", {"mean": 0.0, "deviation": 1.0, "low": -1.0, "high": 1.0})]
#: Mean and deviation in closed form where they are no parameters.
MOMENTS = {"weibull": (3.0 * math.gamma(1.5), 3.0 * math.sqrt(1.0 - math.gamma(1.5) ** 2)), "exponential": (3.0, 3.0),
           "uniform": (2.5, 3.0 / math.sqrt(12.0)), "triangular": (3.0, math.sqrt((1 + 4 + 36 - 2 - 6 - 12) / 18.0)),
           "truncated-normal": (0.0, math.sqrt(1.0 - 2.0 * math.exp(-0.5) / math.sqrt(2.0 * math.pi)
                                               / math.erf(math.sqrt(0.5))))}

RIG = """title = "rig"
[environment]
gravity = [0, 0, 0]
[hole]
diameter = "94 mm"
mu_static = 0
mu_dynamic = 0
[[string]]
name = "main"
[[string.pipes]]
count = 10
outer_diameter = "73 mm"
inner_diameter = "61 mm"
[[time_function]]
name = "rock"
segment = {h0 = "2 kN"}
[[time_function]]
name = "on"
segment = {h0 = 1}
[[time_function]]
name = "turning"
segment = {h0 = 0}
[[bit]]
name = "bit"
diameter = 0
load = "rock"
[[load]]
place = {part = "main", pipe = "last", fraction = 1.0}
moment = ["-500 N m", 0, 0]
time_function = "on"
""" + DRIVES + """[run]
end = "0.1 s"
step = "1 ms"
static = true
[variability]
question = "static"
[[variability.scatter]]
name = "mud"
key = "environment.fluid_density"
distribution = "uniform"
low = "0 kg/m3"
high = "1e-9 kg/m3"
"""
AREA = math.pi / 4.0 * (0.073 ** 2 - 0.061 ** 2)
INERTIA = math.pi / 64.0 * (0.073 ** 4 - 0.061 ** 4)
WEIGHT = 9.81 * 7850.0 * AREA  # [N/m]
#: [m] length that a beam held at its end 10.5 mm above the floor does not touch: h = w l^4/(72 E I). The floor bears w
#: l/3 where it begins, the rig 2 w l/3.
LIFTED = (72.0 * 2.1e11 * INERTIA * 0.0105 / WEIGHT) ** 0.25


def sampled(failures, text=RIG, overrides=None, own=None):
    """The demands of one sample, by name."""
    sample = SceneSample(text + failures, overrides=overrides or {}, own=own or {})
    found = sample(0, np.zeros(sample.dimension))
    if found.status != DONE:
        raise AssertionError(found.message)
    return dict(zip(sample.names, found.demands)), dict(zip(sample.names, found.margins))


def failure(kind, **keys):
    """A table of the scene file."""
    return f'[[failure]]\nkind = "{kind}"\n' + "".join(f'{key.strip("_")} = {value!r}\n' for key, value in keys.items())


class MarginalTest(unittest.TestCase):
    def test_every_distribution_has_its_moments(self):
        self.assertEqual({one.name for one in MARGINALS}, set(DISTRIBUTIONS))
        for one in MARGINALS:
            mean, deviation = MOMENTS.get(one.name) or (one.values["mean"], one.values["deviation"])
            z = (np.arange(400000) + 0.5) / 400000
            x = Translation(one)(stats.norm.ppf(z))
            self.assertAlmostEqual(x.mean() / (mean or 1.0), 1.0 if mean else 0.0, 4, one.name)
            self.assertAlmostEqual(x.std() / deviation, 1.0, 3, one.name)

    def test_both_tails(self):
        for one in MARGINALS:
            for z in (-8.0, -3.0, 0.0, 3.0, 8.0):
                x, law = float(Translation(one)(z)), frozen(one)
                if one.name in ("weibull", "exponential", "normal", "lognormal", "gumbel", "gamma"):
                    found = law.cdf(x) / stats.norm.cdf(z) if z < 0 else law.sf(x) / stats.norm.sf(z)
                    self.assertAlmostEqual(found, 1.0, 6, (one, z))

    def test_nataf_of_lognormals(self):
        """rho_x = (e^(rho s1 s2) - 1)/sqrt((e^s1^2 - 1)(e^s2^2 - 1)) (Liu and Der Kiureghian 1986)."""
        a, b = (Marginal("lognormal", {"mean": 2.0, "deviation": 1.0}),
                Marginal("lognormal", {"mean": 1.0, "deviation": 0.3}))
        s1, s2 = math.sqrt(math.log(1.25)), math.sqrt(math.log(1.09))
        for rho in (-0.8, 0.3, 0.9):
            known = math.expm1(rho * s1 * s2) / math.sqrt(math.expm1(s1 * s1) * math.expm1(s2 * s2))
            self.assertAlmostEqual(value_correlation(a, b, rho), known, 8)
            self.assertAlmostEqual(nataf(a, b, known), rho, 7)
        with self.assertRaisesRegex(ValueError, "must be"):
            nataf(a, b, -0.99)


class FieldTest(unittest.TestCase):
    def test_covariance_is_exact(self):
        points = tuple(np.sort(np.random.default_rng(3).uniform(0.0, 50.0, 60)))
        for name in KERNELS:
            made = Expansion(name, 7.0, points)
            matrix = np.array([made(row) for row in np.eye(60)]).T
            wanted = kernel(name, np.subtract.outer(points, points), 7.0)
            self.assertLess(abs(matrix @ matrix.T - wanted).max(), 1e-10, name)

    def test_few_modes(self):
        """The share of the variance kept by the first mode of e^-|d|/L on a length 2a is lambda_1/2a,
        lambda = 2 c/(w^2 + c^2), c = 1/L, w tan(w a) = c (Ghanem and Spanos 1991)."""
        from scipy.optimize import brentq
        w = brentq(lambda w: w * math.tan(w * 5.0) - 0.1, 1e-6, math.pi / 10.0 - 1e-9)
        points = tuple((np.arange(400) + 0.5) * 10.0 / 400)
        made = Expansion("exponential", 10.0, points, 1)
        self.assertAlmostEqual(made.kept, 2.0 * 0.1 / (w * w + 0.01) / 10.0, 4)
        self.assertAlmostEqual(float((made.matrix ** 2).sum(axis=1).min()), 1.0, 12)

    def test_markov_is_the_same_as_the_matrix(self):
        made = Markov(0.3, 0.1, 40)
        matrix = np.array([made(row) for row in np.eye(40)]).T
        times = 0.1 * np.arange(40)
        self.assertLess(abs(matrix @ matrix.T - kernel("exponential", np.subtract.outer(times, times), 0.3)).max(),
                        1e-12)


VARIED = """[[variability.scatter]]
name = "friction"
keys = ["hole.mu_static", "hole.mu_dynamic"]
relative = true
distribution = "lognormal"
mean = 1
deviation = "30 %"
[[variability.scatter]]
name = "stiffness"
key = "hole.stiffness"
distribution = "lognormal"
mean = "1e7 N/m^2"
deviation = "3e6 N/m^2"
[[variability.correlation]]
between = ["friction", "stiffness"]
rank = -0.6
[[variability.field]]
name = "wear"
key = "string[0].pipes.outer_diameter"
relative = true
distribution = "beta"
low = 0.95
high = 1
mean = 0.98
deviation = 0.01
correlation_length = "3 m"
[[variability.field]]
name = "survey error"
key = "hole.survey.azimuth"
distribution = "normal"
mean = 0
deviation = "0.2 deg"
kernel = "gaussian"
correlation_length = "5 m"
[[variability.process]]
name = "rock load"
time_function = "rock"
distribution = "gamma"
mean = 1
deviation = 0.2
correlation_time = "20 ms"
[[variability.process]]
name = "pump"
time_function = "turning"
how = "added"
distribution = "normal"
mean = "0 rpm"
deviation = "5 rpm"
correlation_time = "20 ms"
kernel = "matern-3/2"
[[failure]]
kind = "rig-torque"
limit = "2 kN m"
[[failure]]
kind = "fatigue"
curve_stress = "100 MPa"
slope = 5
"""
SURVEY = 'survey = [["0 m", "90 deg", 0], ["20 m", "90 deg", 0]]\n'
ALL = (RIG.replace("mu_static = 0\nmu_dynamic = 0", "mu_static = 0.35\n" + SURVEY).replace('question = "static"',
                                                                                           "seed = 3") + VARIED)


class DrawTest(unittest.TestCase):
    def test_ranks(self):
        draw = Draw(scene.loads(ALL))
        rng = np.random.default_rng(1)
        found = [draw.values(rng.standard_normal(draw.dimension)) for _ in range(4000)]
        rank = stats.spearmanr([one["friction"] for one in found], [one["stiffness"] for one in found])[0]
        self.assertAlmostEqual(rank, -0.6, 1)
        self.assertLess(abs(rank + 0.6), 3.5 * (1 - 0.36) / math.sqrt(4000))  # of the estimate's deviation

    def test_changes_reach_the_model(self):
        draw = Draw(scene.loads(ALL))
        values = draw.values(np.random.default_rng(2).standard_normal(draw.dimension))
        varied = scene.loads(ALL, changes=draw.overrides(values))
        calls = {name: [arguments for called, arguments in varied.model.calls if called == name]
                 for name, _ in varied.model.calls}
        wall = calls["add_wall"][0][0]
        self.assertAlmostEqual(wall["mu_static"], 0.35 * values["friction"], 15)
        self.assertAlmostEqual(wall.get("mu_dynamic", 0.30), 0.30 * values["friction"], 15)
        self.assertEqual(wall["stiffness"], values["stiffness"])
        self.assertEqual([row[2] for row in wall["stations"]], list(values["survey error"]))
        wear = [arguments[1]["outer_diameter"] for arguments in calls["add_pipes"]]
        self.assertEqual(wear, [0.073 * one for one in values["wear"]])
        rock, _, turning = (calls["add_time_function"][i] for i in range(3))
        self.assertEqual([row[1] for row in rock[0]["table"]], [2000.0 * one for one in values["rock load"]])
        self.assertEqual([row[1] for row in turning[1]["table"]], list(values["pump"]))

    def test_process_of_a_time_function_that_changes_faster(self):
        """The product of a process with segments that are faster than its spacing has their peaks, steps and
        harmonics: it is that of both at each time, within 0.6 % of the amplitudes."""
        segments = [{"h0": "10 kN"}, {"kind": "harmonic", "h1": "5 kN", "omega": "600 rpm", "phase": "50 deg"},
                    {"kind": "step5", "x0": "1.31 s", "x1": "1.34 s", "h1": "2 kN"},
                    {"kind": "periodic", "table": [["0 s", "0 N"], ["10 ms", "3 kN"], ["70 ms", "0 N"]]},
                    {"table": [["2.01 s", "0 N"], ["2.02 s", "7 kN"], ["2.03 s", "0 N"]]}]
        for number in range(1, len(segments) + 1):
            kept = segments[:1] + segments[number - 1:number] if number < len(segments) else segments
            written = json.dumps(kept).replace('":', '" =')
            text = RIG[:RIG.index("[variability]")].replace('segment = {h0 = "2 kN"}', f"segment = {written}").replace(
                'end = "0.1 s"', 'end = "4 s"') + """[variability]
[[variability.process]]
time_function = "rock"
distribution = "uniform"
low = 0.5
high = 1.5
correlation_time = "1 s"
"""
            draw = Draw(scene.loads(text))
            z = np.random.default_rng(3).standard_normal(draw.dimension)
            values = draw.values(z)
            made = scene.loads(text, changes=draw.overrides(values))
            one, how, times = draw.processes[0]
            factors = draw.translations[one.name](how(z))
            self.assertAlmostEqual(draw.mean(one.name, values[one.name]), factors.mean(), 9)
            base, product = (next(arguments for name, arguments in rig.model.calls if name == "add_time_function")
                             for rig in (draw.scene, made))
            for time in np.linspace(0.0, 4.0, 601):
                known = value_of_segments(base, time) * np.interp(time, times, factors)
                self.assertLess(abs(value_of_segments(product, time) - known), 0.006 * 15e3, (number, time))

    def test_time_function_as_the_library_has_it(self):
        text = RIG.replace('name = "turning"\nsegment = {h0 = 0}', '''name = "turning"
segment = [{h0 = "2 rpm"}, {kind = "step", x0 = "10 ms", x1 = "60 ms", h1 = "30 rpm"},
    {kind = "step5", x1 = "90 ms", h1 = "9 rpm"},
    {kind = "harmonic", h1 = "3 rpm", omega = "900 rpm", phase = "20 deg"},
    {table = [["20 ms", 0], ["70 ms", "8 rpm"]]}]''')
        rig = scene.loads(text + failure("rig-torque", limit="1 N m"))
        terms = [arguments for name, arguments in rig.model.calls if name == "add_time_function"][2]
        with rig.new_sim() as sim:
            for _ in range(10):
                sim.step(0.01)
                self.assertAlmostEqual(value_of_segments(terms, sim.time), sim.drive(rig.names["head"]).target, 12)

    def test_file_to_scene_to_file(self):
        first = scene.loads(ALL)
        again = scene.loads(scene.saves(first))
        self.assertTrue(first.same_as(again))
        self.assertEqual(scene.saves(first), scene.saves(again))
        self.assertFalse(first.same_as(scene.loads(ALL.replace("-0.6", "-0.5"))))
        self.assertFalse(first.same_as(scene.loads(ALL.replace("slope = 5", "slope = 4"))))

    def test_what_varies_twice_is_refused(self):
        text = ALL + '[[variability.scatter]]\nname = "speed"\nkey = "time_function[0].segment.h0"\n' \
                     'distribution = "uniform"\nlow = "1 kN"\nhigh = "2 kN"\n'
        with self.assertRaisesRegex(CannotDraw, "varies by another key"):
            Draw(scene.loads(text))
        text = ALL + '[[variability.scatter]]\nname = "size"\nkey = "string[0].pipes[0].outer_diameter"\n' \
                     'distribution = "uniform"\nlow = "70 mm"\nhigh = "73 mm"\n'
        with self.assertRaisesRegex(CannotDraw, "varies by size and by wear"):
            Draw(scene.loads(text))


HOLE = """[[variability.field]]
name = "friction"
keys = ["hole.mu_static", "hole.mu_dynamic"]
relative = true
distribution = "lognormal"
mean = 1
deviation = "30 %"
correlation_length = "5 m"
spacing = "2 m"
to = "20 m"
[[variability.field]]
name = "size"
key = "hole.diameter"
distribution = "uniform"
low = "93 mm"
high = "100 mm"
kernel = "matern-5/2"
correlation_length = "8 m"
spacing = "3 m"
from = "1 m"
to = "19 m"
"""


class HoleTest(unittest.TestCase):
    TEXT = RIG.replace("mu_static = 0\nmu_dynamic = 0", "mu_static = 0.35") + HOLE + """[[failure]]
kind = "rig-torque"
limit = "2 kN m"
"""

    def test_file_to_scene_to_file(self):
        first = scene.loads(self.TEXT)
        self.assertTrue(first.same_as(scene.loads(scene.saves(first))))

    def test_sections(self):
        """The hole of a sample has the drawn diameters between the breakpoints of its straight lines."""
        draw = Draw(scene.loads(self.TEXT))
        values = draw.values(np.random.default_rng(1).standard_normal(draw.dimension))
        self.assertEqual([len(values["friction"]), len(values["size"])], [11, 7])
        made = scene.loads(self.TEXT, changes=draw.overrides(values))
        for depth in (2.5, 5.5, 9.0, 12.5, 18.5, 30.0):
            known = np.interp(depth, 1.0 + 3.0 * np.arange(7), values["size"])
            self.assertAlmostEqual(made.model.hole(depth).diameter, known, 12)
        sections = [one for name, arguments in made.model.calls if name == "add_hole_sections" for one in arguments]
        at = {one.get("depth", 0.0): one for one in sections}
        self.assertEqual(at[4.0]["mu_static"], 0.35 * values["friction"][2])
        self.assertEqual(at[4.0]["mu_dynamic"], 0.30 * values["friction"][2])

    def test_friction_adds_up(self):
        """Sliding in at the Stribeck speed v_s = 1 cm/s, the rig pushes more by the sum of the friction forces, each
        the contact force times the drawn friction there and the law (eq:friction.peak), which is within 0.002 of
        mu_dynamic + (mu_static - mu_dynamic)/e."""
        text = self.TEXT.replace("count = 10", "count = 16").replace('kind = "rig-torque"\nlimit = "2 kN m"',
                                                                     'kind = "rig-push"\nlimit = "9 kN"')
        text = text[:text.index('[[variability.field]]\nname = "size"')] + text[text.index("[[failure]]"):]
        sample = SceneSample(text, overrides={"environment.gravity": [0, 0, "-9.81 m/s2"], "load.moment": [0, 0, 0],
                                              "static.lay_on_wall": True,
                                              "static.slip_axial": "1 cm/s"})
        z = np.random.default_rng(4).standard_normal(sample.dimension)
        found = sample(0, z)
        values = sample.draw.values(z)
        made = scene.loads(text, changes={**sample.overrides, **sample.draw.overrides(values)})
        with made.new_sim() as sim:
            sim.static(**made.fields_of("static"))
            profile = sim.profile(made.names["main"], 16)
            eps, slow = 1e-3, 0.01
            top = max(np.roots([1.0, 0.0, -eps**2, -eps**2 * slow]).real)  # where the smoothed decay is largest
            ratio, s = slow / math.hypot(slow, eps), math.hypot(slow, eps)
            kappa, eta = math.exp(top / slow) / math.sqrt(1.0 - (eps / top)**2), ratio * math.exp(-s / slow)
            law = (0.30 + 0.05 * math.exp(-s / slow)) * ratio
            law += eta**4 * kappa**3 * ((kappa - 1.0) * 0.05 + kappa * 0.30 * (1.0 - ratio))
            self.assertAlmostEqual(law - 0.30 - 0.05 / math.e, 0.0, delta=0.002)
            friction = np.interp(profile.contact_depth, 2.0 * np.arange(11), values["friction"])
            contacts = [sim.contact(number) for number in range(16)]
            total = -sum(one.friction[0] for one in contacts)
        # between the knots of the field
        pressed = [number for number in range(0, 16, 2) if contacts[number].normal_force > 0.0]
        self.assertGreaterEqual(len(pressed), 5)
        for number in pressed:
            self.assertAlmostEqual(-contacts[number].friction[0] / contacts[number].normal_force
                                   / (law * friction[number]), 1.0, 5)
        self.assertAlmostEqual((found.demands[0] - 2000.0) / total, 1.0, 6)
        self.assertGreater(np.ptp(friction), 0.15)

    def test_refused(self):
        for old, new, told in (('to = "20 m"\n', "", "must have a depth `to`"),
                               ('spacing = "3 m"', 'spacing = "1 mm"', "must be 1 .. 4000"),
                               ('relative = true\n', "", "several need relative = true"),
                               ('"hole.mu_dynamic"]', '"hole.stribeck_speed"]', "must be different ones of"),
                               ("[hole]\n", "[hole]\nsection = [{depth = 0}]\n", "a field makes sections of its own")):
            with self.assertRaisesRegex(scene.SceneError, told):
                scene.loads(self.TEXT.replace(old, new, 1))
        with self.assertRaisesRegex(CannotDraw, "hole.diameter varies by"):
            Draw(scene.loads(self.TEXT
                             + '[[variability.scatter]]\nname = "width"\nkey = "hole.diameter"\ndistribution = '
                               '"uniform"\n'
                             'low = "93 mm"\nhigh = "95 mm"\n'))


class SurveyTest(unittest.TestCase):
    def test_beyond_the_vertical(self):
        """Errors of a vertical hole tilt it to either side, downwards and upwards, with the same distribution; the
        course stays smooth where an inclination passes 0 or 180 deg."""
        for vertical, azimuth in (("0 deg", "30 deg"), ("180 deg", "30 deg"), ("1 deg", "-200 deg")):
            rows = ", ".join(f'["{depth} m", "{vertical}", "{azimuth}"]' for depth in (0, 30, 60))
            text = f"""[hole]
survey = [{rows}]
[[string]]
[[string.pipes]]
count = 60
[variability]
question = "static"
[[variability.field]]
key = "hole.survey.inclination"
distribution = "normal"
mean = 0
deviation = "2 deg"
correlation_length = "500 m"
"""
            draw, ends = Draw(scene.loads(text)), []
            for sign in (1.0, -1.0):
                values = draw.values(sign * np.eye(draw.dimension)[0])
                rows = scene.loads(text, changes=draw.overrides(values)).model
                known = math.radians(float(vertical.split()[0])) + values["field-0"]
                for depth, inclination in zip((0.0, 30.0, 60.0), known):
                    point = rows.hole(depth)
                    tangent = np.array(rows.hole(depth + 1e-3).position) - point.position
                    side = math.sin(inclination) * np.array([math.cos(math.radians(float(azimuth.split()[0]))),
                                                             -math.sin(math.radians(float(azimuth.split()[0])))])
                    self.assertLess(np.abs(tangent[:2] / 1e-3 - side).max(), 1e-6, (vertical, depth))
                ends.append(np.array(rows.hole(60.0).position[:2]))
            if vertical != "1 deg":
                self.assertLess(np.abs(ends[0] + ends[1]).max(), 1e-9)
                self.assertGreater(np.abs(ends[0]).max(), 1.0)


class LimitTest(unittest.TestCase):
    """Each margin against what is known."""

    def test_forces_at_the_rig(self):
        found, margins = sampled(failure("rig-push", limit="3 kN") + failure("rig-pull", limit="3 kN")
                                 + failure("rig-torque", limit="400 N m") + failure("lock-up"))
        self.assertAlmostEqual(found["rig-push"], 2000.0, 3)
        self.assertAlmostEqual(margins["rig-push"], 1000.0, 3)
        self.assertAlmostEqual(found["rig-pull"], -2000.0, 3)
        self.assertAlmostEqual(found["rig-torque"], 500.0, 3)
        self.assertAlmostEqual(margins["rig-torque"], -100.0, 3)
        self.assertAlmostEqual(found["lock-up"], 1.0, 6)

    def test_lock_up_by_friction(self):
        """Sliding in, the rig pushes more than arrives by mu times the weight that it does not bear itself."""
        weight = WEIGHT * (100.0 - 2.0 / 3.0 * LIFTED)
        found, margins = sampled(failure("lock-up", limit=0.99), overrides={
            "environment.gravity": [0, 0, "-9.81 m/s2"], "hole.mu_static": 0.3, "hole.mu_dynamic": 0.3,
            "load.moment": [0, 0, 0], "static.lay_on_wall": True, "static.slip_axial": "1 cm/s",
            "string[0].pipes.count": 100})
        share = 2000.0 / (2000.0 + 0.3 * (weight + 5.0 * 9.81))  # the bit's 5 kg lie there too
        self.assertLess(abs(found["lock-up"] / share - 1.0), 0.02)  # the rig's guide bears some of the weight
        self.assertAlmostEqual(margins["lock-up"], found["lock-up"] - 0.99, 12)

    def test_connections(self):
        kinds = failure("connection-torque", limit="400 N m") + failure("back-off", limit="400 N m")
        tight, _ = sampled(kinds)
        loose, margins = sampled(kinds, overrides={"load.moment": ["500 N m", 0, 0]})
        self.assertAlmostEqual(tight["connection-torque"], 500.0, 3)
        self.assertAlmostEqual(tight["back-off"], 0.0, 3)
        self.assertAlmostEqual(loose["back-off"], 500.0, 3)
        self.assertAlmostEqual(margins["back-off"], -100.0, 3)

    def test_stress_of_a_short_pipe(self):
        """A thin pipe of 100 mm between pipes of 1 m is seen, wherever it is; torsion by the closed form."""
        pipes = '[[string.pipes]]\nlength = "{}"\nouter_diameter = "{} mm"\ninner_diameter = "{} mm"\n'
        first = RIG[RIG.index("[[string.pipes]]"):RIG.index("[[time_function]]")]
        wanted = math.sqrt(3.0) * 500.0 * 0.0225 / (math.pi / 32.0 * (0.045 ** 4 - 0.035 ** 4)) / 400e6
        for joint in ("", 'joint_length = "10 mm"\n'):
            thin = pipes.format("100 mm", 45, 35) + joint
            for text in (thin + 3 * first, first + thin + 3 * pipes.format("1 m", 73, 61), 2 * first + thin):
                found, _ = sampled(failure("stress", strength="400 MPa"), RIG.replace(first, text),
                                   {"time_function[0].segment.h0": 0})
                self.assertAlmostEqual(found["stress"] / wanted, 1.0, 5)

    def test_stress_and_buckling(self):
        found, _ = sampled(failure("stress", strength="400 MPa"), overrides={"load.moment": [0, 0, 0]})
        self.assertAlmostEqual(found["stress"] / (2000.0 / AREA / 400e6), 1.0, 5)
        torsion = 500.0 * 0.0365 / (2.0 * INERTIA)
        found, margins = sampled(failure("stress", strength="50 MPa"), overrides={"time_function[0].segment.h0": 0})
        self.assertAlmostEqual(found["stress"] / (math.sqrt(3.0) * torsion / 50e6), 1.0, 5)
        self.assertAlmostEqual(margins["stress"], 1.0 - found["stress"], 12)
        found, _ = sampled(failure("helical-buckling"), overrides={"environment.gravity": [0, 0, "-9.81 m/s2"],
                                                                   "load.moment": [0, 0, 0],
                                                                   "static.lay_on_wall": True})
        helical = 2.0 * math.sqrt(2.0) * math.sqrt(2.1e11 * INERTIA * WEIGHT / 0.0105)
        self.assertLess(abs(found["helical-buckling"] / (2000.0 / helical) - 1.0), 0.01)

    def test_wall_pressure(self):
        """A string at rest in a horizontal hole presses most where it begins to lie: the site of 1 m there bears w l/3
        and w."""
        found, _ = sampled(failure("wall-pressure", limit="1 MPa", width="20 mm"), overrides={
            "environment.gravity": [0, 0, "-9.81 m/s2"], "load.moment": [0, 0, 0], "static.lay_on_wall": True,
            "bit.mass": "1 g",
            "time_function[0].segment.h0": 0})
        self.assertLess(abs(found["wall-pressure"] / ((WEIGHT * LIFTED / 3.0 + WEIGHT) / 0.02) - 1.0), 0.1)

    def test_off_bottom(self):
        text = RIG.replace('segment = {h0 = "2 kN"}',
                           'segment = {table = [[0, "2 kN"], ["0.02 s", "2 kN"], ["21 ms", 0], ["61 ms", 0], '
                           '["62 ms", "2 kN"]]}').replace('question = "static"', 'look = "1 ms"')
        found, margins = sampled(failure("bit-off-bottom", limit="30 ms"), text)
        self.assertAlmostEqual(found["bit-off-bottom"], 0.040, 12)
        self.assertAlmostEqual(margins["bit-off-bottom"], -0.010, 12)
        later, _ = sampled(failure("bit-off-bottom", limit="30 ms", from_="0.05 s"), text)
        self.assertAlmostEqual(later["bit-off-bottom"], 0.011, 12)

    def test_spin_of_the_bit(self):
        """A stiff string that turns with 100 rpm + 30 rpm sin: stick-slip severity 0.3."""
        text = RIG.replace('name = "turning"\nsegment = {h0 = 0}', '''name = "turning"
segment = [{h0 = "100 rpm"}, {kind = "harmonic", h1 = "30 rpm", omega = "600 rpm"}]''').replace('question = "static"',
                                                                                                'look = "1 ms"')
        found, _ = sampled(failure("stick-slip") + failure("bit-stuck", limit="1 s"), text,
                           {"load.moment": [0, 0, 0], "bit.mass": "1 g", "string[0].pipes.count": 1,
                            "run.end": "0.2 s"})
        self.assertAlmostEqual(found["stick-slip"], 0.3, 2)
        self.assertEqual(found["bit-stuck"], 0.0)

    def test_a_bit_that_does_not_turn(self):
        """It is no bit without stick-slip."""
        one = scene.loads(RIG.replace('question = "static"', "") + failure("stick-slip")).failures[0]
        times = 0.1 * np.arange(3)
        self.assertEqual(limits.margin(one, times, {"spin": np.array([1.0, 3.0, 1.0])})[1], 0.5)
        with self.assertRaisesRegex(ArithmeticError, "the bit does not turn"):
            limits.margin(one, times, {"spin": np.zeros(3)})

    def test_torque_of_the_bit_by_string(self):
        """Each string has that of its own bit, by hand; one without a bit that of the larger one."""
        text = RIG.replace("diameter = 0", 'diameter = "94 mm"') + """[[string]]
name = "other"
[[string.pipes]]
outer_diameter = "50 mm"
inner_diameter = "40 mm"
[[bit]]
name = "small"
string = "other"
diameter = "60 mm"
load = "rock"
[[string]]
name = "bare"
[[string.pipes]]
""" + failure("connection-torque", string="other", limit="1 N m")
        state = statics.states(scene.loads(text))[2]
        torques = {name: BIT_FRICTION * 2000.0 * diameter / 3.0
                   for name, diameter in (("main", 0.094), ("other", 0.06), ("bare", 0.094))}
        for name, torque in torques.items():
            self.assertAlmostEqual(state.torque[name, "rig-torque"], torque, 9)
        self.assertAlmostEqual(state.torque["other", "stress"], math.sqrt(3.0) * torques["other"] * 16.0 * 0.05
                               / (math.pi * (0.05 ** 4 - 0.04 ** 4)), 3)
        self.assertEqual(samples._lacking(state), {"connection-torque": state.torque["other", "connection-torque"]})

    def test_series(self):
        times = 0.1 * np.arange(11)
        self.assertAlmostEqual(limits.longest(times, [0, 1, 1, 1, 0, 1, 1, 1, 1, 1, 0]), 0.4)
        self.assertEqual(limits.longest(times, [0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0]), 0.0)
        self.assertAlmostEqual(limits.longest(times, [1] * 11), 1.0)
        self.assertAlmostEqual(limits.mean_in_time(times, times), 0.5)
        stuck = scene.loads(RIG.replace('question = "static"', "") + failure("bit-stuck", limit="0.25 s",
                                                                             speed="1 rad/s")).failures[0]
        spin = np.array([5, 5, 0.5, -0.5, 0.2, 9, 9, 0, 0, 5, 5])
        self.assertAlmostEqual(limits.margin(stuck, times, {"spin": spin, "turning": np.full(11, 4.0)})[1], 0.2)
        # the rig is at rest
        self.assertEqual(limits.margin(stuck, times, {"spin": spin, "turning": np.zeros(11)})[1], 0.0)

    def test_lateral_acceleration(self):
        """A string that falls: g."""
        text = RIG.replace('name = "main"',
                           'name = "main"\nstart_free = ["x", "y", "z", "rx", "ry", "rz"]\nfollows_hole = false')
        text = text[:text.index("[[time_function]]")].replace("[hole]\ndiameter = \"94 mm\"\nmu_static = 0\nmu_dynamic "
                                                              "= 0", "") \
            + '[run]\nend = "0.05 s"\nstep = "1 ms"\n' + \
            text[text.index("[variability]"):].replace('question = "static"', "")
        found, _ = sampled(failure("lateral-acceleration", limit="10 m/s2", from_="10 ms"), text,
                           {"environment.gravity": [0, 0, "-9.81 m/s2"]})
        self.assertAlmostEqual(found["lateral-acceleration"], 9.81, 5)

    def test_fatigue(self):
        """Slow push and pull of amplitude F: damage n/(N (S/(F/A))^m), also where looks are a period apart: cycles are
        counted in all steps, of the library's choice too."""
        text = RIG.replace('segment = {h0 = "2 kN"}',
                           'segment = {kind = "harmonic", h1 = "100 kN", omega = "20 rad/s"}') \
            .replace('question = "static"', '')
        cycles = 4.5 + 1.0 / 16.0  # five periods: nine halves from end to end, two of half the range
        known = cycles / 1e6 * (1e5 / AREA / 100e6) ** 4
        for look, step in ((1e-3, 'step = "1 ms"\n'), (math.pi / 10.0, 'step = "1 ms"\n'), (math.pi / 10.0, "")):
            found, _ = sampled(failure("fatigue", curve_stress="100 MPa", slope=4, curve_cycles=1e6),
                               text.replace('step = "1 ms"\n', step),
                               {"load.moment": [0, 0, 0], "string[0].pipes.count": 2, "run.end": f"{math.pi / 2.0!r} s",
                                "variability.look": f"{look!r} s"})
            self.assertLess(abs(found["fatigue"] / known - 1.0), 0.03, (look, step))
        with self.assertRaisesRegex(AssertionError, "beyond the range of counting"):
            sampled(failure("fatigue", curve_stress="100 MPa", slope=4), text + '[limits]\nyield_stress = "1 MPa"\n',
                    {"load.moment": [0, 0, 0], "string[0].pipes.count": 2})

    def test_own(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "mine.py")
            file.write_text("def margin(look):\n    return 3.0 - look.sim.drive(look.scene.names['feed']).force / "
                            "1000.0\n"
                            "def wrong(look):\n    return {}['no key']\n", encoding="utf-8")
            found, margins = sampled(failure("own", name="mine"), own={"mine": Own(str(file), "margin")})
            self.assertAlmostEqual(margins["mine"], 1.0, 6)
            sample = SceneSample(RIG + failure("own", name="mine"), own={"mine": Own(str(file), "wrong")})
            result = sample(7, np.zeros(sample.dimension))
        self.assertEqual((result.status, result.number), (FAILED, 7))
        self.assertIn("mine: KeyError", result.message)
        with self.assertRaisesRegex(CannotDraw, "give its function"):
            sampled(failure("own", name="mine"))

    def test_every_kind_is_known(self):
        self.assertEqual(set(KINDS) - set(limits.BESIDE), set(limits.HOW))

    def test_what_cannot_be_solved_is_told(self):
        sample = SceneSample(RIG + failure("rig-push", limit="1 kN"), overrides={
            "variability.scatter.key": "hole.diameter", "variability.scatter.low": "10 mm",
            "variability.scatter.high": "20 mm"})
        found = sample(3, np.zeros(sample.dimension))
        self.assertEqual(found.status, FAILED)
        self.assertTrue(math.isnan(found.margins[0]))
        self.assertIn("diameter", found.message)


class BadScene(unittest.TestCase):
    def test_problems(self):
        for old, new, line in (
                ('relative = true\ndistribution = "lognormal"', 'distribution = "lognormal"\nrelative = 1',
                 "relative = 1: must be true or false"),
                ("mean = 1\ndeviation = \"30 %\"", "mean = -1\ndeviation = \"30 %\"", "mean = -1: must be > 0"),
                ('deviation = "30 %"', 'deviation = "30 kg"', "has the unit 'kg'"),
                ('deviation = "30 %"', "", "lognormal must have deviation"),
                ('"lognormal"\nmean = 1\n', '"lognorml"\nmean = 1\n', "did you mean lognormal?"),
                ('"hole.mu_dynamic"]', '"hole.mu_dinamic"]', "must be the key of a single number"),
                ('"hole.mu_dynamic"]', '"hole.diameter"]\ncolour = 3', "unknown key"),
                ("rank = -0.6", "rank = 1.5", "must be a number between -1 and 1"),
                ('["friction", "stiffness"]', '["friction", "stifness"]', "did you mean stiffness?"),
                ("correlation_length = \"3 m\"", "correlation_length = \"3 s\"", "has the unit 's', must be a length"),
                ('kernel = "gaussian"', 'kernel = "gauss"', "did you mean gaussian?"),
                ('time_function = "rock"\ndistribution', 'time_function = "rok"\ndistribution', "did you mean rock?"),
                ("high = 1\n", "high = 0.9\n", "must be > low = 0.95"),
                ("mean = 0.98", "mean = 0.94", "must be within low"),
                ('key = "string[0].pipes.outer_diameter"', 'key = "string[4].pipes.outer_diameter"',
                 "must be a quantity that varies along"),
                ('name = "pump"', 'name = "wear"', "varies already"),
                ('kind = "fatigue"', 'kind = "fatige"', "did you mean fatigue?"),
                ("slope = 5", "", "fatigue must have a slope"),
                ('limit = "2 kN m"', 'limit = "2 kN"', "must be a torque"),
                ('limit = "2 kN m"', "", "or [limits] torque"),
                ('limit = "2 kN m"', 'limit = "2 kN m"\nhead = "feed"', "must name a drive of rotation (rx)"),
                ('limit = "2 kN m"', 'limit = "2 kN m"\nfrom = "2 s"\nto = "1 s"', "must be > from"),
                ("seed = 3", "seed = 3\nquestion = \"static\"", "needs a run in time"),
                ("seed = 3", "seed = 3\nconfidence = 2", "must be 0.5 .. 1"),
                ("seed = 3", "seed = 3\nsamples = 0", "must be 1 .. 10^9"),
                ('end = "0.1 s"\n', "", "needs [run] end"),
                ('correlation_time = "20 ms"\nkernel', 'correlation_time = "20 ms"\nspacing = "1 us"\nkernel',
                 "must be <= 4000")):
            self.assertIn(old, ALL)
            with self.assertRaises(scene.SceneError) as refused:
                scene.loads(ALL.replace(old, new, 1))
            self.assertIn(line, str(refused.exception))
            self.assertTrue(all(one.line > 1 for one in refused.exception.problems), refused.exception)

    def test_contradicting_ranks(self):
        more = '[[variability.scatter]]\nname = "third"\nkey = "hole.stribeck_speed"\ndistribution = "uniform"\n' \
               'low = "1 mm/s"\n' \
               'high = "2 mm/s"\n[[variability.correlation]]\nbetween = ["friction", "third"]\nrank = 0.9\n' \
               '[[variability.correlation]]\nbetween = ["stiffness", "third"]\nrank = 0.9\n'
        with self.assertRaisesRegex(scene.SceneError, "contradict"):
            scene.loads(ALL + more)

    def test_cut_at_every_line(self):
        lines = ALL.splitlines(keepends=True)
        for count in range(len(lines)):
            try:
                scene.loads("".join(lines[:count]))
            except scene.SceneError:
                pass


if __name__ == "__main__":
    assert enums is not None
    unittest.main()
