"""Readings of a rotational viscometer (Fann 35 with rotor R1, bob B1 and spring F1) as constants of a mud.

At N rev/min the bob sees the rate of shear 1.703 N 1/s, and a reading of one degree is 0.511 Pa (API RP 13B-1). Two
readings give Bingham's fluid, three or more the fluid of Herschel and Bulkley that has the least squares of stress."""
from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

SHEAR_RATE, STRESS = 1.703, 0.511  #: [1/s] of 1 rev/min, [Pa] of one degree
LEAST_EXPONENT, MOST_EXPONENT = 0.2, 1.0


class Mud(NamedTuple):
    """shear stress = yield_stress + consistency (shear rate)^flow_exponent"""
    yield_stress: float   #: [Pa]
    consistency: float    #: [Pa s^n]
    flow_exponent: float  #: [-]
    misfit: float         #: [degree] largest difference from a reading


def fit(readings: Sequence[tuple[float, float]]) -> Mud:
    """The mud of pairs of speed [rev/min] and reading [degree]. Raises ValueError that states the fault."""
    pairs = sorted(readings)
    if len(pairs) < 2:
        raise ValueError("must have two speeds at least")
    for (speed, reading), (above, more) in zip(pairs, pairs[1:]):
        if speed == above:
            raise ValueError(f"has {speed:g} rpm twice")
        if more <= reading:
            raise ValueError(f"{more:g} degrees at {above:g} rpm must be more than {reading:g} degrees at {speed:g} "
                             "rpm")
    if pairs[0][0] <= 0.0 or pairs[0][1] < 0.0:
        raise ValueError("must have speeds > 0 and readings >= 0")
    rates, stresses = [SHEAR_RATE * one for one, _ in pairs], [STRESS * one for _, one in pairs]
    exponent = MOST_EXPONENT if len(pairs) == 2 else _exponent(rates, stresses)
    yield_stress, consistency = _line(rates, stresses, exponent)
    misfit = max(abs(yield_stress + consistency * rate ** exponent - stress)
                 for rate, stress in zip(rates, stresses)) / STRESS
    return Mud(yield_stress, consistency, exponent, misfit)


def _line(rates: list[float], stresses: list[float], exponent: float) -> tuple[float, float]:
    """Yield stress >= 0 and consistency of the least squares for an exponent."""
    powers = [rate ** exponent for rate in rates]
    count, sum_x, sum_y = len(powers), sum(powers), sum(stresses)
    sum_xx, sum_xy = sum(x * x for x in powers), sum(x * y for x, y in zip(powers, stresses))
    slope = (count * sum_xy - sum_x * sum_y) / (count * sum_xx - sum_x * sum_x)
    start = (sum_y - slope * sum_x) / count
    return (start, slope) if start >= 0.0 else (0.0, sum_xy / sum_xx)


def _squares(rates: list[float], stresses: list[float], exponent: float) -> float:
    start, slope = _line(rates, stresses, exponent)
    return float(sum((start + slope * rate ** exponent - stress) ** 2 for rate, stress in zip(rates, stresses)))


def _exponent(rates: list[float], stresses: list[float]) -> float:
    """The exponent of the least squares: the best of a grid, then by thirds about it."""
    steps = 80
    grid = [LEAST_EXPONENT + (MOST_EXPONENT - LEAST_EXPONENT) * i / steps for i in range(steps + 1)]
    best = min(range(steps + 1), key=lambda i: _squares(rates, stresses, grid[i]))
    low, high = grid[max(0, best - 1)], grid[min(steps, best + 1)]
    for _ in range(60):
        left, right = low + (high - low) / 3.0, high - (high - low) / 3.0
        if _squares(rates, stresses, left) < _squares(rates, stresses, right):
            high = right
        else:
            low = left
    return 0.5 * (low + high)
