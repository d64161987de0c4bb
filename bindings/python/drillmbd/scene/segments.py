"""Values of described segments of time functions."""
from __future__ import annotations

import math
from typing import Any

from .. import enums


def by_numbers(segment: dict[str, Any]) -> bool:
    """Whether a segment is given by numbers alone: not by a function of the caller, nor by another time function."""
    return (segment.get("function") is None and segment.get("kind") not in (enums.SEGMENT_CALLBACK,
                                                                            enums.SEGMENT_PER_REVOLUTION))


def value_at(time: float, segment: dict[str, Any]) -> float:
    """The value of one constant, step or harmonic segment, by its described fields."""
    kind, h0, h1 = segment.get("kind",
                               enums.SEGMENT_CONSTANT), float(segment.get("h0", 0.0)), float(segment.get("h1", 0.0))
    if kind == enums.SEGMENT_HARMONIC:
        return h0 + h1 * math.sin(segment.get("omega", 0.0) * time + segment.get("phase", 0.0))
    if kind != enums.SEGMENT_STEP:
        return h0
    begin, end = segment.get("x0", 0.0), segment.get("x1", 1.0)
    x = min(max((time - begin) / (end - begin), 0.0), 1.0)
    return h0 + (h1 - h0) * float(x * x * (3.0 - 2.0 * x))
