"""Points of a study. A sample is its number: its uniform numbers come from a stream of Philox (counter-based) keyed by
the seed of the study and the number, whoever draws it, whenever (Salmon et al. 2011)."""
from __future__ import annotations

import functools
from typing import Any

from .._optional import need

MOST_NUMBERS = 200_000_000  #: of a latin hypercube or of Sobol's points that are held in memory


def stream(seed: int, number: int) -> Any:
    """The generator of a sample."""
    numpy = need("numpy")
    return numpy.random.Generator(numpy.random.Philox(key=[seed, number]))


def normal(uniform: Any) -> Any:
    """Standard normal numbers of uniform ones; never infinite."""
    numpy = need("numpy")
    return need("scipy.special").ndtri(numpy.clip(uniform, 2.0 ** -54, 1.0 - 2.0 ** -53))


def drawn(seed: int, number: int, dimension: int) -> Any:
    """The standard normal numbers of a sample of a Monte Carlo study."""
    return normal(stream(seed, number).random(dimension) + 2.0 ** -54)


class Points:
    """z(number) of a method. The designs of latin-hypercube and sobol are `replicates` independent ones of equal size,
    one after the other; the number of Sobol's points in one is raised to a power of 2."""

    def __init__(self, method: str, seed: int, dimension: int, samples: int, replicates: int = 10) -> None:
        self.method, self.seed, self.dimension = method, seed, dimension
        self.replicates = 1 if method == "monte-carlo" else replicates
        self.each = samples if method == "monte-carlo" else max(2, -(-samples // replicates))
        if method == "sobol":
            self.each = 1 << (self.each - 1).bit_length()
        self.samples = self.each * self.replicates
        if method != "monte-carlo" and self.each * dimension > MOST_NUMBERS:
            raise ValueError(f"a design of {self.each} points of {dimension} numbers, must be <= {MOST_NUMBERS} "
                             "numbers; "
                             "use method = \"monte-carlo\" or more replicates")
        self.design = functools.lru_cache(maxsize=1)(self._design)

    def _design(self, replicate: int) -> Any:
        qmc, generator = need("scipy.stats").qmc, stream(self.seed, (1 << 62) + replicate)
        if self.method == "sobol":
            made = qmc.Sobol(self.dimension, scramble=True, seed=generator)
            return made.random_base2(self.each.bit_length() - 1)
        return qmc.LatinHypercube(self.dimension, seed=generator).random(self.each)

    def z(self, number: int) -> Any:
        """Standard normal numbers of a sample."""
        if self.method == "monte-carlo":
            return drawn(self.seed, number, self.dimension)
        return normal(self.design(number // self.each)[number % self.each])
