"""Samples of the run for the report: shapes of the string, stresses, and the least and largest of hook load and
torque."""
from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from ._optional import need
from .sim import Sim


class Frames:
    """Shapes by time, from which the picture in space is made, and extremes of outputs."""

    def __init__(self, shapes: list[tuple[Any, Any]], times: list[float]) -> None:
        self.shapes, self.times = shapes, times
        self.stresses: list[tuple[float, float]] = []   #: [Pa] the largest at a time [s]
        #: extremes of the part of the run before the state that it goes on from
        self.before: list[list[float]] = []
        self.sim: Any = None
        self.stress: Callable[[], float] = lambda: math.nan
        self.every = 0.0   #: [s] between stresses
        self.window: Any = None

    def watch(self, sim: Sim, outputs: list[tuple[Any, str]], stress: Callable[[], float], every: float) -> None:
        """Takes the extremes of these outputs, and the stress [Pa] once in each `every` [s], from now on."""
        self.sim, self.window, self.stress, self.every = sim, sim.window(outputs), stress, every
        self.before = [[math.inf, -math.inf] for _ in outputs]

    def take(self) -> int:
        """A sample; returns the status."""
        if self.sim.time >= self._stressed() + self.every * (1.0 - 1e-6):
            self.take_stress()
        return int(self.window.take())

    def _stressed(self) -> float:
        """[s] of the last stress that was taken."""
        return self.stresses[-1][1] if self.stresses else -math.inf

    def take_stress(self) -> None:
        """The stress now; pipes that are all rigid have none."""
        stress = self.stress() if self.sim.time > self._stressed() else math.nan
        if not math.isnan(stress):
            self.stresses.append((stress, self.sim.time))

    def extremes(self) -> list[list[float]]:
        """Least and largest value of each output; NaN where there was no sample."""
        found = [self.window.result(number) for number in range(len(self.before))]
        return [[min(low, one.minimum), max(high, one.maximum)] for (low, high), one in zip(self.before, found)]

    # ---- A run that is stopped and goes on --------------------------------------------------------------------------
    def keep(self) -> dict[str, Any]:
        """For the state of the run."""
        array = need("numpy").array
        return {"positions": array([one for one, _ in self.shapes]),
                "displacements": array([one for _, one in self.shapes]),
                "times": array(self.times), "stresses": array(self.stresses).reshape(-1, 2),
                "extremes": array(self.extremes())}

    def take_up(self, kept: dict[str, Any]) -> None:
        """Continues from it."""
        self.shapes = list(zip(kept["positions"], kept["displacements"]))
        self.times = [float(one) for one in kept["times"]]
        self.stresses = [(float(stress), float(time)) for stress, time in kept["stresses"]]
        self.before = [[float(low), float(high)] for low, high in kept["extremes"]]
