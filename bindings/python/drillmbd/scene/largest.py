"""The largest magnitude of a time function over all times, and its range."""
from __future__ import annotations

import bisect
import math
from collections.abc import Sequence
from typing import Any

from .. import enums
from .segments import by_numbers

STEPS = (enums.SEGMENT_STEP, enums.SEGMENT_STEP5)
BETWEEN, MOST_BREAKPOINTS = 16, 2000  #: times between breakpoints, breakpoints up to which there are such


def bounded(segments: Any, time_functions: Sequence[Any]) -> list[dict[str, Any]]:
    """The segments, each one per revolution as a harmonic of its largest amplitude |h1| + |share| max |w|; w is the
    time function `of`.
    Where w is a function of the caller, whose largest value is not known, the segment stays. time_functions: the
    segments of all time functions of the model, by number."""
    found = []
    for one in segments:
        if one.get("kind") == enums.SEGMENT_PER_REVOLUTION:
            share, speed = abs(one.get("share", 0.0)), largest_of(time_functions[one["of"].index & 0xFFFFFF])
            if share and speed is None:
                found.append(one)
                continue
            one = {"kind": int(enums.SEGMENT_HARMONIC), "h0": one.get("h0", 0.0),
                   "h1": abs(one.get("h1", 0.0)) + share * (speed or 0.0)}
        found.append(one)
    return found


def largest_of(segments: Any, time_functions: Sequence[Any] = ()) -> float | None:
    """The largest magnitude of a sum of segments over all times; None as of range_of."""
    found = range_of(segments, time_functions)
    return None if found is None else max(abs(found[0]), abs(found[1]))


def range_of(segments: Any, time_functions: Sequence[Any] = (), end: float = math.inf) -> tuple[float, float] | None:
    """The smallest and largest value of a sum of segments over all times, or up to `end` [s]; None if a function of
    the caller is among them, or a segment per revolution whose time function is not among `time_functions`. Steps and
    tables are added at the same times, so that a step up and one down later do not add up; harmonics, segments per
    revolution and tables that repeat count with their largest magnitude at any time."""
    if time_functions:
        segments = bounded(segments, time_functions)
    segments = [{**segment, "kind": int(segment.get("kind", enums.SEGMENT_TABLE if "table" in segment
                                                    else enums.SEGMENT_CONSTANT))} for segment in segments]
    if not all(by_numbers(segment) for segment in segments):
        return None
    if len(segments) == 1 and segments[0].get("table") and end == math.inf:
        values = [float(value) for _, value in segments[0]["table"]]
        return min(values), max(values)
    swing = sum(abs(segment.get("h1", 0.0)) for segment in segments if segment["kind"] == enums.SEGMENT_HARMONIC)
    swing += sum(max(abs(value) for _, value in segment["table"])
                 for segment in segments if segment["kind"] == enums.SEGMENT_PERIODIC)
    values = [sum(_value_at(segment, time) for segment in segments)
              for time in (*(one for one in _times(segments) if one <= end), *([end] if end < math.inf else []))]
    return float(min(values) - swing), float(max(values) + swing)


def _times(segments: list[dict[str, Any]]) -> list[float]:
    """Ends of steps and breakpoints of tables, and times between them where steps overlap."""
    found = {0.0}
    for segment in segments:
        if segment["kind"] == enums.SEGMENT_TABLE:
            found.update(float(time) for time, _ in segment.get("table", ()))
        elif segment["kind"] in STEPS:
            found.update((segment.get("x0", 0.0), segment.get("x1", 1.0)))
    breakpoints = sorted(found)
    if (sum(segment["kind"] in STEPS for segment in segments) + any(segment["kind"] == enums.SEGMENT_TABLE
                                                                    for segment in segments) < 2
        or len(breakpoints) > MOST_BREAKPOINTS):
        return breakpoints
    return [a + (b - a) * k / BETWEEN for a, b in zip(breakpoints, breakpoints[1:])
            for k in range(BETWEEN)] + breakpoints[-1:]


def _value_at(segment: dict[str, Any], time: float) -> float:
    """Of one segment; of a harmonic its middle, of a table that repeats 0."""
    if segment["kind"] == enums.SEGMENT_TABLE:
        return _between(segment.get("table", ()), time)
    h0, h1 = float(segment.get("h0", 0.0)), float(segment.get("h1", 0.0))
    if segment["kind"] not in STEPS:
        return h0
    begin, end = segment.get("x0", 0.0), segment.get("x1", 1.0)
    d = float(min(max((time - begin) / (end - begin), 0.0), 1.0))
    rise: float = (d * d * (3.0 - 2.0 * d) if segment["kind"] == enums.SEGMENT_STEP
                   else d ** 3 * (10.0 - 15.0 * d + 6.0 * d * d))
    return h0 + (h1 - h0) * rise


def _between(table: Any, time: float) -> float:
    """By straight lines, constant outside."""
    if not table:
        return 0.0
    times = [float(one) for one, _ in table]
    i = bisect.bisect_right(times, time)
    if i in (0, len(times)):
        return float(table[min(i, len(times) - 1)][1])
    (t0, v0), (t1, v1) = table[i - 1], table[i]
    return float(v0 + (v1 - v0) * (time - t0) / (t1 - t0))
