"""Tests that 95 % intervals of failure probabilities hold the known one in 88 of 100 repeats at least, of every method.
Equations: eq:probability.clopper-pearson, eq:probability.designs, eq:probability.subset."""
import unittest

from shared_tests import needs

needs("numpy", "scipy.linalg", "scipy.stats")

import numpy as np
from scipy.stats import norm

from drillmbd.probability.estimates import Subset, counted
from drillmbd.probability.sampling import Points
from test_estimates import FOUR, RARE, Oscillator, four_branches, linear


class CoverageTest(unittest.TestCase):
    def test_coverage(self):
        """Small designs, fixed seeds."""
        small = (("linear", linear(1.5), 2, norm.cdf(-1.5), 200),
                 ("oscillator", Oscillator(1.5, 40), 40, norm.cdf(-1.5), 200),
                 ("four branches", four_branches, 2, FOUR, 1000))
        inside = dict[str, int]()
        for method in ("monte-carlo", "latin-hypercube", "sobol"):
            for name, margin, dimension, known, samples in small:
                ends = []
                for seed in range(100):
                    points = Points(method, seed, dimension, samples, 10)
                    margins = margin(None, np.array([points.z(i) for i in range(points.samples)]))
                    ends.append(counted(margins, method, points.replicates, 0.95))
                inside[f"{method}, {name}"] = sum(one.low <= known <= one.high for one in ends)
        for name, margin, dimension, known in RARE:
            ends = [Subset(seed, dimension, 100).run(margin, 0.95) for seed in range(100)]
            inside[f"subset, {name}"] = sum(one.low <= known <= one.high for one in ends)
        self.assertGreaterEqual(min(inside.values()), 88, inside)


if __name__ == "__main__":
    unittest.main()
