"""The largest magnitude of a programme over all times."""
from __future__ import annotations

import bisect
from typing import Any

from .. import enums

STEPS = (enums.TERM_STEP, enums.TERM_STEP5)
BETWEEN, MOST_CORNERS = 16, 2000  #: times between corners, corners up to which there are such


def largest_of(terms: Any) -> float | None:
    """The largest magnitude of a sum of terms over all times; None if a function of the caller is among them. Steps and tables are added at
    the same times, so that a step up and one down later do not add up; harmonics count with their amplitude at any time."""
    terms = [{**term, "kind": int(enums.TERM_TABLE if "table" in term else term.get("kind", enums.TERM_CONSTANT))} for term in terms]
    if any(term["kind"] == enums.TERM_CALLBACK or term.get("function") is not None for term in terms):
        return None
    if len(terms) == 1 and terms[0].get("table"):
        return float(max(abs(value) for _, value in terms[0]["table"]))
    swing = sum(abs(term.get("h1", 0.0)) for term in terms if term["kind"] == enums.TERM_HARMONIC)
    return float(swing + max(abs(sum(_value_at(term, time) for term in terms)) for time in _times(terms)))


def _times(terms: list[dict[str, Any]]) -> list[float]:
    """Ends of steps and corners of tables, and times between them where steps overlap."""
    found = {0.0}
    for term in terms:
        if term["kind"] == enums.TERM_TABLE:
            found.update(float(time) for time, _ in term.get("table", ()))
        elif term["kind"] in STEPS:
            found.update((term.get("x0", 0.0), term.get("x1", 1.0)))
    corners = sorted(found)
    if sum(term["kind"] in STEPS for term in terms) + any(term["kind"] == enums.TERM_TABLE for term in terms) < 2 or len(corners) > MOST_CORNERS:
        return corners
    return [a + (b - a) * k / BETWEEN for a, b in zip(corners, corners[1:]) for k in range(BETWEEN)] + corners[-1:]


def _value_at(term: dict[str, Any], time: float) -> float:
    """Of one term; of a harmonic its middle."""
    if term["kind"] == enums.TERM_TABLE:
        return _between(term.get("table", ()), time)
    h0, h1 = float(term.get("h0", 0.0)), float(term.get("h1", 0.0))
    if term["kind"] not in STEPS:
        return h0
    begin, end = term.get("x0", 0.0), term.get("x1", 1.0)
    d = float(min(max((time - begin) / (end - begin), 0.0), 1.0))
    rise: float = d * d * (3.0 - 2.0 * d) if term["kind"] == enums.TERM_STEP else d ** 3 * (10.0 - 15.0 * d + 6.0 * d * d)
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
