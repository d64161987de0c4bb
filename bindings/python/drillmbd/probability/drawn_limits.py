"""Limits and keys of failures that vary, as the torque limit of a rig that is known roughly: the failures of one
sample."""
from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

from ..scene import Scene
from ..scene.failure import KINDS, Failure
from ..scene.units import text
from ..scene.variability import Scatter
from .draw import Draw


@dataclass(frozen=True)
class Moved:
    """A number of a failure that varies: factor times the value of a scattered parameter."""
    failure: str
    key: str
    parameter: str
    factor: float


class DrawnLimits:
    """Found by reading the scene with two values of each scattered parameter that has a key of [[failure]] or
    [limits]."""

    def __init__(self, draw: Draw, read: Callable[[dict[str, Any]], Scene]) -> None:
        self.moved: list[Moved] = []
        for one in draw.varies.scatters:
            if any(re.match(r"(failure|limits)\b", key) for key in one.keys):
                self.moved += self._of(one, [float(draw.translations[one.name](z)) for z in (0.25, 0.5)], read)
        self.names = {one.failure for one in self.moved}

    @staticmethod
    def _of(one: Scatter, values: list[float], read: Callable[[dict[str, Any]], Scene]) -> list[Moved]:
        bases = one.base or (1.0,) * len(one.keys)
        first, second = (read({key: text(value * base, unit)
                               for key, base, unit in zip(one.keys, bases, one.units)}).failures for value in values)
        return [Moved(a.name, key, one.name, before / values[0]) for a, b in zip(first, second)
                for key, before, after in [("limit", a.limit, b.limit), *((key, a.values[key], b.values[key])
                                                                          for key in a.values)] if before != after]

    def of(self, failures: Sequence[Failure], values: dict[str, Any]) -> list[Failure]:
        """The failures of a sample by the values of all that varies. Raises ValueError where a limit is not
        permitted."""
        found = {one.name: one for one in failures}
        for one in self.moved:
            if one.failure in found:
                found[one.failure] = _with(found[one.failure], one.key, one.factor * values[one.parameter],
                                           one.parameter)
        return list(found.values())


def _with(failure: Failure, key: str, value: float, parameter: str) -> Failure:
    kind = KINDS[failure.kind]
    if key == "limit":
        if not value > 0.0 and not kind.free:
            raise ValueError(f"{failure.name}: limit = {text(value, kind.unit)} of {parameter}, must be > 0; choose a "
                             "distribution that stays above 0")
        return replace(failure, limit=value)
    least = kind.keys[key]
    if value < 0.0 or (least.positive and value == 0.0):
        raise ValueError(f"{failure.name}: {key} = {text(value, least.unit)} of {parameter}, must be "
                         f"{'> 0' if least.positive else '>= 0'}; "
                         "choose a distribution that stays above 0")
    return replace(failure, values={**failure.values, key: value})
