"""Failure probabilities with their intervals.

An `evaluate` takes the numbers of samples and their standard normal numbers, shape (n, dimension), and returns the
margins, shape
(n); NaN where a sample failed to be computed. A margin <= 0 is a failure."""
from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

from .._optional import need
from .sampling import Points, normal, stream

Evaluate = Callable[[Sequence[int], Any], Any]


@dataclass
class Estimate:
    """A probability with its interval."""
    probability: float
    low: float                #: of the interval
    high: float
    confidence: float
    method: str
    samples: int              #: requested
    failures: int             #: margins <= 0
    #: samples without a margin; the interval holds whether they fail or not, where the method allows it
    lost: int
    about: str = ""           #: how the interval was found
    more: dict[str, Any] = field(default_factory=dict)


# ---- Counting --------------------------------------------------------------------------------------------------------
def clopper_pearson(failures: int, samples: int, confidence: float) -> tuple[float, float]:
    """The exact interval of a share (eq:probability.clopper-pearson): never less than its confidence."""
    beta, rest = need("scipy.stats").beta, 0.5 * (1.0 - confidence)
    low = 0.0 if failures == 0 else float(beta.ppf(rest, failures, samples - failures + 1))
    high = 1.0 if failures == samples else float(beta.isf(rest, failures + 1, samples - failures))
    return low, high


def students(values: Any, confidence: float) -> tuple[float, float, float]:
    """Mean of independent estimates and its interval by Student's t."""
    numpy = need("numpy")
    mean, half = float(numpy.mean(values)), 0.0
    if len(values) > 1:
        quantile = float(need("scipy.stats").t.isf(0.5 * (1.0 - confidence), len(values) - 1))
        half = quantile * float(numpy.std(values, ddof=1)) / math.sqrt(len(values))
    return mean, mean - half, mean + half


def effective(probability: float, low: float, high: float, confidence: float) -> float | None:
    """Samples of plain Monte Carlo whose interval would be as wide; None where that is not defined."""
    width, quantile = high - low, float(need("scipy.stats").norm.isf(0.5 * (1.0 - confidence)))
    if not 0.0 < probability < 1.0 or not width > 0.0:
        return None
    return 4.0 * quantile * quantile * probability * (1.0 - probability) / (width * width)


def counted(margins: Any, method: str = "monte-carlo", replicates: int = 1, confidence: float = 0.95) -> Estimate:
    """From the margins of all samples in order. Samples without a margin count as safe for the lower end and as
    failures for the upper one, and are left out of the probability."""
    numpy = need("numpy")
    margins = numpy.asarray(margins, dtype=float)
    known = ~numpy.isnan(margins)
    lost, failures, samples = int((~known).sum()), int((margins[known] <= 0.0).sum()), len(margins)
    probability = failures / (samples - lost) if samples > lost else math.nan
    low, high = (clopper_pearson(failures, samples, confidence)[0],
                 clopper_pearson(failures + lost, samples, confidence)[1])
    about = "Clopper-Pearson"
    if replicates > 1 and samples % replicates == 0 and failures + lost < samples and failures > 0:
        each = numpy.where(known, margins <= 0.0, False).reshape(replicates, -1).mean(axis=1)
        most = numpy.where(known, margins <= 0.0, True).reshape(replicates, -1).mean(axis=1)
        if numpy.count_nonzero(each) == replicates:  # each design saw failures; else its scatter is no estimate
            # Counts are whole: designs may agree and all miss a part f of a sample; each sees it with the probability
            # f.
            whole = clopper_pearson(0, replicates, confidence)[1] / (samples // replicates)
            low, high = max(0.0, students(each, confidence)[1] - whole), min(1.0, students(most, confidence)[2] + whole)
            about = f"Student's t of {replicates} independent designs, and a count's step"  # eq:probability.designs
    return Estimate(probability, low, high, confidence, method, samples, failures, lost, about)


def sampled(evaluate: Evaluate, points: Points, confidence: float = 0.95) -> Estimate:
    """Monte Carlo, Latin hypercube or Sobol's points."""
    numpy = need("numpy")
    numbers = list(range(points.samples))
    margins = evaluate(numbers, numpy.array([points.z(number) for number in numbers]))
    return counted(margins, points.method, points.replicates, confidence)


HOPE = 3.0  #: a subset simulation goes on where failures are within so many times the levels that it has left


# ---- Rare failures ---------------------------------------------------------------------------------------------------
class Subset:
    """Subset simulation (eq:probability.subset) with conditional sampling of the normal numbers
    (eq:probability.conditional): a new state is sqrt(1 - s^2) z + s xi, taken where its margin is below the level; s
    follows the share taken from level to level.
    `replicates` independent ones, each of `each` samples a level; the interval is Student's t of their results, widened
    on both sides by the largest bias that a run with this scatter can have, half of its squared coefficient of
    variation (the sum over pairs of levels of Au and Beck's equation 29, all levels correlated). Numbers of samples:
    (replicate << 40) + count in the replicate."""

    def __init__(self, seed: int, dimension: int, each: int, replicates: int = 10, share: float = 0.1,
                 levels: int = 12) -> None:
        self.seed, self.dimension, self.replicates, self.share, self.levels = seed, dimension, replicates, share, levels
        self.chains = max(2, round(each * share))
        self.length = max(2, round(1.0 / share))
        self.each = self.chains * self.length
        self.evaluated = self.lost = 0
        self.thresholds: list[list[float]] = []  # margins that end the levels so far, of each replicate

    def _xi(self, first: int, count: int) -> Any:
        """Of `count` samples of a replicate, by the number of the first: the study draws them, not its workers."""
        return normal(stream(self.seed, first).random((count, self.dimension)) + 2.0 ** -54)

    def _margins(self, evaluate: Evaluate, numbers: list[int], z: Any) -> Any:
        numpy = need("numpy")
        margins = numpy.asarray(evaluate(numbers, z), dtype=float)
        self.evaluated += len(numbers)
        self.lost += int(numpy.isnan(margins).sum())
        return numpy.where(numpy.isnan(margins), numpy.inf, margins)  # counted as safe; `lost` has their number

    def run(self, evaluate: Evaluate, confidence: float = 0.95) -> Estimate:
        """The estimate."""
        numpy = need("numpy")
        rows = [[(replicate << 40) + i for i in range(self.each)] for replicate in range(self.replicates)]
        numbers = [number for row in rows for number in row]
        z = numpy.array([self._xi(row[0], self.each) for row in rows])
        margins = self._margins(evaluate, numbers, z.reshape(-1, self.dimension)).reshape(self.replicates, self.each)
        result, steps = numpy.ones(self.replicates), numpy.full(self.replicates, 0.6)
        going, used = list(range(self.replicates)), [self.each] * self.replicates
        levels, self.thresholds, early = 0, [[] for _ in going], ""
        while going and levels <= self.levels:
            going = [r for r in going if not self._ends(r, margins[r], result, last=levels == self.levels)]
            early = self._hopeless(going, self.levels - levels)
            if early:
                result[going] = 0.0
                break
            if going:
                self._level(evaluate, going, z, margins, steps, used)
            levels += 1
        probability, low, high = students(result, confidence)
        scatter = float(numpy.std(result, ddof=1)) if len(result) > 1 else math.nan
        bias = 0.5 * scatter * scatter / probability if probability > 0.0 else 0.0  # eq:probability.subset-bias
        low, high = low - bias, high + bias
        if not (probability > 0.0 and math.isfinite(scatter)):
            low, high = 0.0, 1.0  # nothing seen in so many levels says nothing
        about = early or f"Student's t of {self.replicates} independent runs, and the bias"
        if self.lost:
            about += f"; counts the {self.lost} samples without a margin as safe, as its interval does"
        return Estimate(probability, max(0.0, low), min(1.0, high), confidence, "subset", self.evaluated,
                        int((margins <= 0.0).sum()), self.lost, about,
                        {"levels": levels, "deviation of one run": scatter})

    def _ends(self, r: int, margins: Any, result: Any, last: bool) -> bool:
        """Whether a replicate has seen enough failures; multiplies its result."""
        failing = int((margins <= 0.0).sum())
        if failing >= self.chains or last:
            result[r] *= failing / self.each
            return True
        result[r] *= self.share
        return False

    def _hopeless(self, going: list[int], left: int) -> str:
        """Why the replicates that continue will not reach a failure: their thresholds fall so slowly that HOPE times
        the levels that are left would not do. "" where they may."""
        if not going or any(len(self.thresholds[r]) < 3 for r in going):
            return ""
        last = [self.thresholds[r][-1] for r in going]
        falls = [(self.thresholds[r][-3] - self.thresholds[r][-1]) / 2.0 for r in going]
        if any(fall > 0.0 and value <= HOPE * left * fall for value, fall in zip(last, falls)):
            return ""
        return (f"ended after {len(self.thresholds[going[0]])} levels, because it cannot reach a failure: the smallest "
                "margins fall by "
                f"{sum(falls) / len(falls):.3g} a level and {min(last):.3g} are left, for {left} more levels; nothing "
                "is known of the probability: ask for more samples a level, or "
                "for plain samples and their percentiles")

    def _level(self, evaluate: Evaluate, going: list[int], z: Any, margins: Any, steps: Any, used: list[int]) -> None:
        """One more level of the replicates that continue, all chains side by side."""
        numpy = need("numpy")
        order = {r: numpy.argsort(margins[r], kind="stable")[:self.chains] for r in going}
        level = {r: 0.5 * (margins[r][order[r][-1]] + numpy.sort(margins[r])[self.chains]) for r in going}
        for r in going:
            self.thresholds[r].append(float(level[r]))
        states = numpy.array([z[r][order[r]] for r in going])
        values = numpy.array([margins[r][order[r]] for r in going])
        taken = numpy.zeros(len(going))
        kept_z, kept_m = [states.copy()], [values.copy()]
        for _ in range(self.length - 1):
            numbers = [(r << 40) + used[r] + c for r in going for c in range(self.chains)]
            xi = numpy.array([self._xi((r << 40) + used[r], self.chains) for r in going])
            for r in going:
                used[r] += self.chains
            s = steps[going][:, None, None]
            new = numpy.sqrt(1.0 - s * s) * states + s * xi
            found = self._margins(evaluate, numbers, new.reshape(-1, self.dimension)).reshape(values.shape)
            good = found <= numpy.array([level[r] for r in going])[:, None]
            states = numpy.where(good[:, :, None], new, states)
            values = numpy.where(good, found, values)
            taken += good.mean(axis=1)
            kept_z.append(states.copy())
            kept_m.append(values.copy())
        for i, r in enumerate(going):
            z[r] = numpy.array([one[i] for one in kept_z]).reshape(self.each, self.dimension)
            margins[r] = numpy.array([one[i] for one in kept_m]).reshape(self.each)
            share = taken[i] / (self.length - 1)
            steps[r] = min(1.0, max(0.05, steps[r] * math.exp(share - 0.44)))


# ---- FORM ------------------------------------------------------------------------------------------------------------
def _function(evaluate: Evaluate, dimension: int) -> Any:
    """An OpenTURNS function; samples are numbered in the order of the calls."""
    ot, numpy = need("openturns"), need("numpy")
    count = [0]

    def many(x: Any) -> Any:
        z = numpy.array(x, dtype=float)
        numbers = list(range(count[0], count[0] + len(z)))
        count[0] += len(z)
        margins = numpy.asarray(evaluate(numbers, z), dtype=float)
        if numpy.isnan(margins).any():
            raise ArithmeticError(f"{int(numpy.isnan(margins).sum())} samples have no margin; FORM needs all of them")
        return margins[:, None]

    return ot.PythonFunction(dimension, 1, func=lambda x: many([x])[0].tolist(), func_sample=many), count


@dataclass
class Form:
    """A first-order result."""
    beta: float          #: reliability index: distance of the failure from the origin, < 0 where the origin fails
    probability: float   #: Phi(-beta), exact where the margin is linear in the normal numbers
    point: Any           #: the closest failure, in normal numbers
    importance: Any      #: squared direction cosines
    evaluations: int


def form(evaluate: Evaluate, dimension: int) -> Form:
    """The first-order reliability method (eq:probability.form; solver of Rackwitz and Fiessler 1978), by OpenTURNS."""
    ot, numpy = need("openturns"), need("numpy")
    function, count = _function(evaluate, dimension)
    event = ot.ThresholdEvent(ot.CompositeRandomVector(function, ot.RandomVector(ot.Normal(dimension))),
                              ot.LessOrEqual(), 0.0)
    solver = ot.AbdoRackwitz()
    solver.setMaximumIterationNumber(200)
    for name in ("AbsoluteError", "RelativeError", "ResidualError", "ConstraintError"):
        getattr(solver, "setMaximum" + name)(1e-10)
    start = numpy.full(dimension, 1e-3)
    algorithm = ot.FORM(solver, event, start)
    algorithm.run()
    found = algorithm.getResult()
    point = numpy.array(found.getStandardSpaceDesignPoint())
    beta = float(found.getHasoferReliabilityIndex()) * (-1.0 if found.getIsStandardPointOriginInFailureSpace() else 1.0)
    norm = float(point @ point)
    return Form(beta, float(need("scipy.special").ndtr(-beta)), point, point * point / norm if norm > 0.0 else point,
                count[0])


# ---- What matters ----------------------------------------------------------------------------------------------------
@dataclass
class Indices:
    """Sobol' indices of groups of numbers."""
    names: list[str]
    first: Any          #: share of the variance by each alone
    total: Any          #: with its interplay
    first_interval: Any  #: shape (groups, 2)
    total_interval: Any
    evaluations: int
    lost: int


def sobol_indices(evaluate: Evaluate, groups: dict[str, int], count: int, seed: int = 1,
                  confidence: float = 0.95) -> Indices:
    """Sobol' indices of the margin by Jansen's estimators (eq:probability.sobol) on scrambled Sobol' points, intervals
    by bootstrap
    (OpenTURNS). groups: sizes of consecutive groups of the normal numbers by their names; a random field is one group.
    It takes count (2 + groups) samples; a row of which one has no margin is left out."""
    ot, numpy = need("openturns"), need("numpy")
    dimension, names = sum(groups.values()), list(groups)
    points = Points("sobol", seed, 2 * dimension, count, 1)
    both = numpy.array([points.z(i) for i in range(points.samples)])
    a, b = both[:, :dimension], both[:, dimension:]
    blocks, at = [a, b], 0
    for size in groups.values():
        mixed = a.copy()
        mixed[:, at:at + size] = b[:, at:at + size]
        blocks.append(mixed)
        at += size
    z = numpy.concatenate(blocks)
    margins = numpy.asarray(evaluate(list(range(len(z))), z), dtype=float).reshape(len(blocks), -1)
    good = ~numpy.isnan(margins).any(axis=0)
    kept = int(good.sum())
    if kept < 8:
        raise ArithmeticError(f"{kept} of {len(good)} rows have all of their margins, must be >= 8")
    output = margins[:, good].reshape(-1, 1)
    if not numpy.isfinite(output).all():
        raise ArithmeticError(f"{int((~numpy.isfinite(output)).sum())} of {output.size} margins are infinite, as where "
                              "a string locks up; they have no variance "
                              "to share out: choose a failure by --failure whose demand stays finite")
    if numpy.ptp(output) == 0.0:
        raise ArithmeticError("the margin is the same in all samples; nothing that varies acts on it")
    dummy = ot.Sample(numpy.zeros((len(output), len(names))))  # only its size is looked at
    ot.RandomGenerator.SetSeed(seed)
    algorithm = ot.JansenSensitivityAlgorithm(dummy, ot.Sample(output - output.mean()), kept)
    algorithm.setConfidenceLevel(confidence)
    algorithm.setUseAsymptoticDistribution(False)

    def interval(found: Any) -> Any:
        return numpy.stack([numpy.array(found.getLowerBound()), numpy.array(found.getUpperBound())], axis=1)

    return Indices(names, numpy.array(algorithm.getFirstOrderIndices()), numpy.array(algorithm.getTotalOrderIndices()),
                   interval(algorithm.getFirstOrderIndicesInterval()),
                   interval(algorithm.getTotalOrderIndicesInterval()),
                   len(z), len(good) - kept)


# ---- Surrogate -------------------------------------------------------------------------------------------------------
LEAST_Q2 = 0.6  #: of a surrogate whose interval is reported


MOST_TERMS, ALL_TERMS = 300, 2000  #: polynomials above degree 1, and in all
SECONDS = 1.2e-6  #: of a processor for each margin and square of the number of polynomials, measured


@dataclass(frozen=True)
class Plan:
    """The fit of a surrogate before it is made."""
    degree: int
    terms: int      #: polynomials among which the fit chooses
    seconds: float  #: of a processor, predicted


def _enumeration(dimension: int) -> Any:
    return need("openturns").HyperbolicAnisotropicEnumerateFunction(dimension, 0.6)


def _count(dimension: int, degree: int) -> int:
    """Polynomials in the first strata of equal hyperbolic degree (sum of a_i^0.6)^(1/0.6): 0, 1, 2 and 3 of one
    variable, then 3.17 of products of two, a fourth degree where there is one variable only. Counted here because
    OpenTURNS counts them one by one."""
    if degree > 4:
        return int(_enumeration(dimension).getStrataCumulatedCardinal(degree))
    if degree < 4 or dimension == 1:
        return 1 + degree * dimension
    return 1 + 3 * dimension + dimension * (dimension - 1) // 2


def plan(dimension: int, samples: int, degree: int = 4) -> Plan:
    """The largest degree, up to the given one, with MOST_TERMS polynomials or fewer; 1 at least."""
    while degree > 1 and _count(dimension, degree) > MOST_TERMS:
        degree -= 1
    terms = min(_count(dimension, degree), ALL_TERMS)
    return Plan(degree, terms, SECONDS * 0.8 * samples * terms * terms)


class Surrogate:
    """A polynomial chaos of the margin (sparse, by least angle regression, OpenTURNS), fitted to 4 of 5 samples. The
    others give its error (eq:probability.surrogate): q2 = 1 - mean square error/variance, the root mean square error,
    and how many margins have the wrong sign."""

    def __init__(self, z: Any, margins: Any, degree: int = 4) -> None:
        ot, numpy = need("openturns"), need("numpy")
        z, margins = numpy.asarray(z, dtype=float), numpy.asarray(margins, dtype=float)
        good = ~numpy.isnan(margins)
        z, margins = z[good], margins[good]
        if not numpy.isfinite(margins).all():
            raise ValueError(f"{int((~numpy.isfinite(margins)).sum())} margins that are infinite, as where a string "
                             "locks up, which no polynomial follows")
        if len(margins) and numpy.ptp(margins) == 0.0:
            raise ValueError("margins that are all the same")
        test = numpy.arange(len(z)) % 5 == 4
        if test.sum() < 2:
            raise ValueError(f"{len(z)} samples with margins, must be >= 10")
        self.dimension = z.shape[1]
        standard = ot.Normal(self.dimension)
        basis = ot.OrthogonalProductPolynomialFactory([ot.HermiteFactory()] * self.dimension,
                                                      _enumeration(self.dimension))
        terms = plan(self.dimension, len(z), degree).terms
        selection = ot.LeastSquaresMetaModelSelectionFactory(ot.LARS(), ot.CorrectedLeaveOneOut())
        algorithm = ot.FunctionalChaosAlgorithm(ot.Sample(z[~test]), ot.Sample(margins[~test][:, None]), standard,
                                                ot.FixedStrategy(basis, terms), ot.LeastSquaresStrategy(selection))
        algorithm.run()
        self.model = algorithm.getResult().getMetaModel()
        self.errors = margins[test] - self(z[test])
        self.error = float(numpy.sqrt((self.errors ** 2).mean()))
        variance = float(margins[test].var())
        self.q2 = 1.0 - self.error ** 2 / variance if variance > 0.0 else math.nan
        self.wrong = int(((margins[test] <= 0.0) != (self(z[test]) <= 0.0)).sum())
        self.tested = int(test.sum())

    def __call__(self, z: Any) -> Any:
        """Margins."""
        numpy = need("numpy")
        return numpy.array(self.model(need("openturns").Sample(numpy.asarray(z, dtype=float)))).reshape(-1)

    def estimate(self, seed: int = 1, samples: int = 100_000, confidence: float = 0.95) -> Estimate:
        """The probability by Monte Carlo on the surrogate. The interval's ends count margins that are twice the root
        mean square error smaller and larger."""
        generator = stream(seed, (1 << 61))
        found = self(generator.standard_normal((samples, self.dimension)))
        failures, most, least = (int((found <= shift).sum()) for shift in (0.0, 2.0 * self.error, -2.0 * self.error))
        low, high = clopper_pearson(least, samples, confidence)[0], clopper_pearson(most, samples, confidence)[1]
        about = "margins shifted by twice the surrogate's error"
        if not self.q2 >= LEAST_Q2:
            low, high = 0.0, 1.0
            about = f"the surrogate explains too little: q2 = {self.q2:.3g}, must be >= {LEAST_Q2:g}"
        return Estimate(failures / samples, low, high, confidence, "surrogate", samples, failures, 0, about,
                        {"q2": self.q2, "error": self.error, "wrong signs": self.wrong, "tested": self.tested})
