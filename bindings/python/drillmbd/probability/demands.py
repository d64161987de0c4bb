"""Demands of a study beside their probabilities of failure: percentiles and their share of the limit, a histogram, and
rank correlations with all that varies."""
from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from .._optional import need
from ..scene.failure import KINDS, Failure
from ..unit_systems import SI, Units
from ..verdict import shown

PERCENTS = (5, 50, 95)
BINS = 20  #: of a histogram
ROUNDING = 1e-9  #: of a limit: a demand below it is 0


@dataclass
class Percentile:
    """A percentile of the demand with its interval; an end that so few samples do not bound is infinite."""
    percent: int
    value: float
    low: float
    high: float
    share: float  #: of the limit; where little is bad the limit over the value


@dataclass
class Matter:
    """The rank correlation (Spearman 1904) of a demand with one of the inputs."""
    name: str
    rank: float
    least: float  #: of so many samples that have nothing to do with each other, 95 of 100 stay below it


@dataclass
class Demand:
    """The demand of one failure over all samples that have one."""
    failure: Failure
    percentiles: list[Percentile]
    edges: list[float]      #: of the histogram
    counts: list[int]
    infinite: int           #: samples in which the string locks up
    matters: list[Matter]   #: the largest first
    limit_varies: bool = False  #: the limit is that of the scene file, and samples have others
    samples: int = 0        #: with a demand
    lost: int = 0           #: without one, which the intervals count as the smallest or the largest
    least: float = 0.0      #: demand of all samples
    most: float = 0.0
    weighted: bool = False  #: samples represent different numbers of them, as in the question auto

    @property
    def worst(self) -> Percentile:
        """The percentile on the side of the limit: P95, or P5 where little is bad."""
        return self.percentiles[0 if KINDS[self.failure.kind].low else -1]

    def sentence(self, confidence: float) -> str:
        """One line."""
        unit, worst = KINDS[self.failure.kind].unit, self.worst
        parts = [f"P{one.percent} {amount(one.value, unit)}" for one in self.percentiles]
        interval = (f"{100 * confidence:g} % interval of P{worst.percent} {amount(worst.low, unit)} .. "
                    f"{amount(worst.high, unit)}")
        limit = "limit of the scene file," if self.limit_varies else "limit"
        share = f"{100.0 * worst.share:.3g} % of the {limit} {amount(self.failure.limit, unit)}" \
            if math.isfinite(worst.share) else \
            f"{limit} {amount(self.failure.limit, unit)}"
        known = f" (of the {self.samples} of {self.samples + self.lost} samples that have one)" if self.lost else ""
        known = (f" (of {self.samples} runs by their weights{f', {self.lost} more are lost' if self.lost else ''})"
                 if self.weighted else known)
        return f"{self.failure.name}: demand{known} {', '.join(parts)}; {share} at P{worst.percent}; {interval}"

    def doubts(self, question: str) -> list[str]:
        """Why no failure, or one in every sample, says little about the hole."""
        name, kind, nothing = self.failure.name, self.failure.kind, ROUNDING * abs(self.failure.limit)
        if kind in ("rig-push", "rig-pull") and self.most <= nothing:
            more = ("; ask --question torque-drag or static, which push the string in and pull it out"
                    if question in ("run", "auto") else "")
            return [f"{name}: not assessed, because the rig never {'pushes' if kind == 'rig-push' else 'pulls'} "
                    "(largest demand "
                    f"{amount(self.most, KINDS[kind].unit)}){more}"]
        if self.samples > 1 and self.least == self.most and abs(self.most) > nothing and math.isfinite(self.most):
            follows = "is that of its limit" if self.limit_varies else "is that of the scene as it is written"
            return [f"{name}: the demand is the same in all samples: nothing that varies acts on it, and its "
                    f"probability {follows}"]
        return []

    def record(self) -> dict[str, Any]:
        """For summary.json."""
        return {"unit": KINDS[self.failure.kind].unit, "limit": self.failure.limit,
                "fails_below": KINDS[self.failure.kind].low, "limit_varies": self.limit_varies,
                "percentiles": {f"P{one.percent}": {key: value for key, value in vars(one).items() if key != "percent"}
                                for one in self.percentiles},
                "histogram": {"edges": self.edges, "counts": self.counts, "locked_up": self.infinite},
                "rank_correlation": {one.name: {"value": one.rank, "least_that_counts": one.least}
                                     for one in self.matters}}


def amount(value: float, unit: str, units: Units = SI) -> str:
    """A number with its unit, with a prefix where that is usual."""
    if math.isinf(value):
        return "without bound" if value > 0.0 else "-"
    return shown(value, unit, units) if unit in ("N", "N m",
                                                 "Pa") else f"{value:.3g}" if unit == "-" else units.text(value, unit,
                                                                                                          ".3g")


def percentile(ranked: Any, percent: int, confidence: float, lost: int = 0) -> tuple[float, float, float]:
    """Value and interval of a percentile of n ranked values, by order statistics: x_(i) is below the percentile q with
    the probability that a binomial number of n and q is i at least (David and Nagaraja 2003). Lost samples may be
    anything: the lower end counts them as the smallest values, the upper one as the largest."""
    binom, known, q = need("scipy.stats").binom, len(ranked), percent / 100.0
    n = known + lost
    low, high = int(binom.ppf(0.5 * (1.0 - confidence), n, q)), int(binom.isf(0.5 * (1.0 - confidence), n, q)) + 1
    return (float(ranked[max(0, math.ceil(q * known) - 1)]), float(ranked[low - lost - 1]) if low - lost >= 1
            else -math.inf,
            float(ranked[high - 1]) if high <= known else math.inf)


def weighted_percentile(values: Any, weights: Any, percent: int, confidence: float,
                        lost: float = 0.0) -> tuple[float, float, float]:
    """Value and interval of a percentile of values that represent different numbers of samples. With the weights w of n
    values that were drawn independently, F(t) = sum of w over values <= t / sum of w has at the percentile q the
    variance

        v = sum w^2 (1(x <= t) - q)^2 / (sum w)^2,

    that of m = q (1 - q)/v equal samples. The interval is that of the order statistics of m samples, found on F
    (Woodruff 1952; Korn and Graubard
    1998). lost: weight of those without a value, which the lower end counts as the smallest values, the upper one as
    the largest."""
    numpy, beta, q = need("numpy"), need("scipy.stats").beta, percent / 100.0
    order = numpy.argsort(values, kind="stable")
    ranked, w = values[order], weights[order]
    known, total = float(w.sum()), float(w.sum()) + lost
    below = numpy.cumsum(w)

    def at(weight: float) -> int:
        """The first value up to which there is so much weight, within rounding."""
        return int(numpy.searchsorted(below, weight - 1e-9 * total))

    value = ranked[min(at(q * known), len(ranked) - 1)]
    inside = ranked <= value
    variance = (float((w ** 2 * (inside - q) ** 2).sum()) + lost ** 2 / max(1, len(w))) / total ** 2
    m = max(1.0, min(q * (1.0 - q) / variance, float(len(w))) if variance > 0.0 else 1.0)
    low = float(beta.ppf(0.5 * (1.0 - confidence), q * m, (1.0 - q) * m + 1.0))
    high = float(beta.isf(0.5 * (1.0 - confidence), q * m + 1.0, (1.0 - q) * m))
    first, last = at(low * total - lost), at(high * total)
    # one more sample of that weight could lie beyond
    smallest, largest = float(w.max()) / total > low, float(w.max()) / total > 1.0 - high
    return (float(value), -math.inf if smallest or low * total <= lost else float(ranked[min(first, len(ranked) - 1)]),
            math.inf if largest or last >= len(ranked) else float(ranked[last]))


def _share(value: float, failure: Failure) -> float:
    if not failure.limit or not math.isfinite(value):
        return math.nan if not math.isinf(value) or KINDS[failure.kind].low else math.inf
    if KINDS[failure.kind].low:
        return failure.limit / value if value > 0.0 else math.inf
    return value / failure.limit


def _ranks(values: Any, weights: Any) -> Any:
    """Mean ranks of values that represent so many samples, about their mean."""
    numpy = need("numpy")
    _, place = numpy.unique(values, return_inverse=True)
    sums = numpy.bincount(place, weights)
    ranks = (numpy.cumsum(sums) - 0.5 * sums)[place]
    return ranks - float(weights @ ranks) / float(weights.sum())


def matters(demands: Any, inputs: Any, names: Sequence[str], weights: Any = None) -> list[Matter]:
    """The rank correlation of a demand with each input; with weights w that of (sum w)^2/sum w^2 samples (Kish
    1965)."""
    numpy, n = need("numpy"), len(demands)
    if n < 10 or numpy.ptp(numpy.where(numpy.isinf(demands), 0.0, demands)) == 0.0:
        return []
    w = numpy.ones(n) if weights is None else weights
    ranks, least = _ranks(demands, w), 1.96 / math.sqrt(max(1.0, float(w.sum() ** 2 / (w ** 2).sum()) - 1.0))
    found = []
    for i, name in enumerate(names):
        column = _ranks(inputs[:, i], w)
        spread = math.sqrt(float(w @ column ** 2) * float(w @ ranks ** 2))
        found.append(Matter(name, float(w @ (column * ranks)) / spread if spread > 0.0 else 0.0, least))
    return sorted(found, key=lambda one: -abs(one.rank))


def _excess(failure: Failure, margins: Any) -> Any:
    """demand - limit."""
    return margins if KINDS[failure.kind].low else -margins


def demand_of(failure: Failure, demands: Any, inputs: Any, names: Sequence[str], confidence: float, margins: Any = None,
              weights: Any = None) -> Demand | None:
    """Of the samples of one failure in order, NaN where there is none; None where no sample has one. margins: where the
    limit varies too, so that rank correlations are those of demand - limit. weights: numbers of samples that each
    represents, where they differ."""
    numpy = need("numpy")
    good = ~numpy.isnan(demands)
    known = demands[good]
    if not len(known):
        return None
    ranked, lost = numpy.sort(known), int(len(demands) - len(known))
    finite = known[numpy.isfinite(known)]
    w = weights[good] if weights is not None else None
    counts, edges = numpy.histogram(finite, BINS, weights=None if w is None
                                    else w[numpy.isfinite(known)]) if len(finite) else (numpy.zeros(0), numpy.zeros(0))
    points = [(percent, *(percentile(ranked, percent, confidence, lost) if w is None else
                          weighted_percentile(known, w, percent, confidence, float(weights[~good].sum()))))
              for percent in PERCENTS]
    return Demand(failure, [Percentile(*one, _share(one[1], failure)) for one in points], edges.tolist(),
                  [round(one) for one in counts.tolist()], int(len(known) - len(finite)),
                  matters(known if margins is None else _excess(failure, margins[good]), inputs[good], names, w),
                  margins is not None,
                  len(known), lost, float(ranked[0]), float(ranked[-1]), weights is not None)
