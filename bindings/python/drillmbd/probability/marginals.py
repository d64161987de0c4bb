"""Distributions by name and parameters, by SciPy: x = F^-1(Phi(z)) of a standard normal z
(eq:probability.translation)."""
from __future__ import annotations

import math
from typing import Any

from .._optional import need
from ..scene.variability import Marginal

_EULER = 0.5772156649015329


def frozen(marginal: Marginal) -> Any:
    """The distribution of scipy.stats."""
    stats, v = need("scipy.stats"), marginal.values
    name = marginal.name
    if name == "normal":
        return stats.norm(v["mean"], v["deviation"])
    if name == "truncated-normal":  # mean and deviation are those before the ends are cut off
        low, high = ((v[key] - v["mean"]) / v["deviation"] for key in ("low", "high"))
        return stats.truncnorm(low, high, v["mean"], v["deviation"])
    if name == "lognormal":
        s2 = math.log1p((v["deviation"] / v["mean"]) ** 2)
        return stats.lognorm(math.sqrt(s2), scale=v["mean"] * math.exp(-0.5 * s2))
    if name == "gamma":
        shape = (v["mean"] / v["deviation"]) ** 2
        return stats.gamma(shape, scale=v["mean"] / shape)
    if name == "gumbel":  # of largest values
        scale = v["deviation"] * math.sqrt(6.0) / math.pi
        return stats.gumbel_r(v["mean"] - _EULER * scale, scale)
    if name == "weibull":
        return stats.weibull_min(v["shape"], scale=v["scale"])
    if name == "exponential":
        return stats.expon(scale=v["mean"])
    width = v["high"] - v["low"]
    if name == "uniform":
        return stats.uniform(v["low"], width)
    if name == "triangular":
        return stats.triang((v["mode"] - v["low"]) / width, v["low"], width)
    if name == "beta":  # by its moments
        mean, variance = (v["mean"] - v["low"]) / width, (v["deviation"] / width) ** 2
        size = mean * (1.0 - mean) / variance - 1.0
        return stats.beta(mean * size, (1.0 - mean) * size, v["low"], width)
    raise ValueError(f"{name} is no distribution")


class Translation:
    """Standard normal numbers to numbers of a distribution; both tails to full accuracy."""

    def __init__(self, marginal: Marginal) -> None:
        self.marginal, self.distribution = marginal, frozen(marginal)

    def __call__(self, z: Any) -> Any:
        numpy, special = need("numpy"), need("scipy.special")
        z, v, name = numpy.asarray(z, dtype=float), self.marginal.values, self.marginal.name
        if name == "normal":
            return v["mean"] + v["deviation"] * z
        if name == "lognormal":
            s2 = math.log1p((v["deviation"] / v["mean"]) ** 2)
            return v["mean"] * numpy.exp(math.sqrt(s2) * z - 0.5 * s2)
        if name == "gumbel":  # -log(-log Phi(z))
            loc, scale = self.distribution.args
            return loc - scale * numpy.log(-special.log_ndtr(z))
        if name in ("weibull", "exponential"):  # -log(1 - Phi(z)) = -log Phi(-z)
            return v.get("scale", v.get("mean", 1.0)) * (-special.log_ndtr(-z)) ** (1.0 / v.get("shape", 1.0))
        below = self.distribution.ppf(special.ndtr(numpy.minimum(z, 0.0)))
        above = self.distribution.isf(special.ndtr(-numpy.maximum(z, 0.0)))
        return numpy.where(z < 0.0, below, above)


def value_correlation(a: Marginal, b: Marginal, rho: float, points: int = 64) -> float:
    """Correlation of the values where that of the normal numbers is rho (Nataf): the integral of
    (x_a - m_a)(x_b - m_b)/(s_a s_b) over the bivariate normal density, by Gauss and Hermite (eq:probability.nataf)."""
    numpy = need("numpy")
    nodes, weights = numpy.polynomial.hermite_e.hermegauss(points)
    weights = weights / weights.sum()
    first, second = Translation(a), Translation(b)
    x = first(nodes)
    y = second(rho * nodes[:, None] + math.sqrt(max(0.0, 1.0 - rho * rho)) * nodes[None, :])
    ys = second(nodes)
    mx, my = weights @ x, weights @ ys
    sx, sy = math.sqrt(weights @ (x - mx) ** 2), math.sqrt(weights @ (ys - my) ** 2)
    return float((weights * (x - mx)) @ (y - my) @ weights / (sx * sy))


def nataf(a: Marginal, b: Marginal, wanted: float) -> float:
    """The correlation of the normal numbers that gives the values the wanted one. ValueError where none does."""
    optimize = need("scipy.optimize")
    low, high = value_correlation(a, b, -1.0), value_correlation(a, b, 1.0)
    if not low <= wanted <= high:
        raise ValueError(f"correlation = {wanted:g}, must be {low:.4g} .. {high:.4g} for {a.name} and {b.name}")
    return float(optimize.brentq(lambda rho: value_correlation(a, b, rho) - wanted, -1.0, 1.0, xtol=1e-12))
