"""Random fields and processes: standard normal numbers z, independent, to correlated ones at points (Karhunen and
Loeve's expansion of the covariance matrix at these points, exact with all of its modes; eq:probability.field)."""
from __future__ import annotations

import functools
import math
from typing import Any

from .._optional import need
from .blas import one_thread


def kernel(name: str, distance: Any, length: float) -> Any:
    """Correlation of the normal field at a distance; L is the correlation length (or time):
    exponential e^(-d/L), gaussian e^(-(d/L)^2), Matern's (1 + a) e^-a with a = sqrt(3) d/L and
    (1 + a + a^2/3) e^-a with a = sqrt(5) d/L."""
    numpy = need("numpy")
    d = numpy.abs(distance)
    if name == "independent":
        return (d == 0.0).astype(float)
    x = d / length
    if name == "exponential":
        return numpy.exp(-x)
    if name == "gaussian":
        return numpy.exp(-x * x)
    if name == "matern-3/2":
        a = math.sqrt(3.0) * x
        return (1.0 + a) * numpy.exp(-a)
    if name == "matern-5/2":
        a = math.sqrt(5.0) * x
        return (1.0 + a + a * a / 3.0) * numpy.exp(-a)
    raise ValueError(f"{name} is no kernel")


class Expansion:
    """sum of sqrt(lambda_k) phi_k z_k over the largest eigenvalues of the correlation matrix. With modes left out every
    point is scaled back to variance 1; `kept` is the share of the variance before."""

    def __init__(self, name: str, length: float, points: tuple[float, ...], modes: int = 0) -> None:
        numpy = need("numpy")
        one_thread()
        at = numpy.asarray(points, dtype=float)
        count = len(at)
        self.points, self.modes = at, count if not modes else min(modes, count)
        self.kept = 1.0
        if name == "independent":
            self.matrix: Any = None
            self.modes = count
            return
        values, vectors = numpy.linalg.eigh(kernel(name, at[:, None] - at[None, :], length))
        order = numpy.argsort(values)[::-1][:self.modes]
        vectors = vectors[:, order] * numpy.where(vectors[0, order] < 0.0, -1.0, 1.0)  # sign: the same on every machine
        self.matrix = vectors * numpy.sqrt(numpy.maximum(values[order], 0.0))
        variance = (self.matrix ** 2).sum(axis=1)
        self.kept = float(variance.mean())
        if self.modes < count:
            self.matrix = self.matrix / numpy.sqrt(variance)[:, None]

    def __call__(self, z: Any) -> Any:
        return need("numpy").asarray(z, dtype=float) if self.matrix is None else self.matrix @ z

    def many(self, z: Any) -> Any:
        """Of several rows; row by row, so that the digits of one do not depend on the others."""
        return need("numpy").array([self(row) for row in z])


class Markov:
    """The exponential kernel on an even grid without a matrix: x_0 = z_0, x_k = a x_(k-1) + sqrt(1 - a^2) z_k with
    a = e^(-h/L), exact (Ornstein and Uhlenbeck; eq:probability.markov)."""

    def __init__(self, length: float, spacing: float, count: int) -> None:
        self.a, self.modes = math.exp(-spacing / length), count

    def __call__(self, z: Any) -> Any:
        return self.many([z])[0]

    def many(self, z: Any) -> Any:
        """Of several rows."""
        z = need("numpy").asarray(z, dtype=float)
        scaled = math.sqrt(1.0 - self.a * self.a) * z
        scaled[:, 0] = z[:, 0]
        return need("scipy.signal").lfilter([1.0], [1.0, -self.a], scaled, axis=1)


@functools.lru_cache(maxsize=16)
def expansion(name: str, length: float, points: tuple[float, ...], modes: int = 0) -> Expansion:
    """The same, kept for the next sample."""
    return Expansion(name, length, points, modes)
