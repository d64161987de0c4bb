"""The systems of units to choose from: data alone, so that the command line can be read without the library."""
from __future__ import annotations

from enum import IntEnum


class UnitSystem(IntEnum):
    """Units of the output: SI, those of oil wells, those of mines."""
    SI = 0
    FIELD = 1
    MINE = 2


NAMES = tuple(one.name.lower() for one in UnitSystem)
