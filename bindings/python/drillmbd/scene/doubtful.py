"""Speeds, loads and diameters of a scene that are probably in another unit or have the wrong sign. Those of pipes, wall
and mud are warnings of the model check."""
from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from .. import enums
from ..language import phrase
from .content import Scene
from .fields import DEFINITIONS
from .largest import range_of

FAST_ROTATION = 20.0 * math.pi  #: [rad/s] 600 rpm
FAST_FEED = 1.0                 #: [m/s]
NARROW_BIT, NARROW_PIPE = 0.5, 0.1  #: of the diameter of the hole


def doubtful(scene: Scene) -> list[str]:
    """Phrases without a stop."""
    calls = scene.model.calls
    time_functions = [arguments for name, arguments in calls if name == "add_time_function"]
    feeds, rotations = (list(_ranges_of_drives(calls, time_functions, one)) for one in (enums.X, enums.RX))
    loads = [_range(time_functions, one["load"]) for one in _of(calls, "add_bit") if one.get("load")]
    return [*_fast(rotations, feeds), *_signs(feeds, loads), *_narrow(calls)]


def _of(calls: Any, wanted: str) -> list[dict[str, Any]]:
    return [arguments[0] for name, arguments in calls if name == wanted]


def _range(time_functions: list[Any], part: Any) -> tuple[float, float]:
    """Of a time function by its id; 0 of a function of Python."""
    return range_of(time_functions[part.index & 0xFFFFFF], time_functions) or (0.0, 0.0)


def _ranges_of_drives(calls: Any, time_functions: list[Any], component: int) -> Iterator[tuple[float, float]]:
    """Speeds that drives of strings prescribe or control."""
    for one in _of(calls, "add_drive"):
        of_string = not one.get("part") or (one["part"].index >> 24) == enums.PART_STRING
        if (of_string and one.get("component", enums.X) == component and one.get("time_function")
                and one.get("kind", enums.DRIVE_MOTION) != enums.DRIVE_LOAD):
            yield _range(time_functions, one["time_function"])


def _fast(rotations: list[tuple[float, float]], feeds: list[tuple[float, float]]) -> list[str]:
    rotation, feed = (max((max(-low, high) for low, high in found), default=0.0) for found in (rotations, feeds))
    found: list[str] = []
    if rotation > FAST_ROTATION:
        found.append(phrase("rotation of up to {speed:.5g} rpm, which is unusual; usual are up to {limit:.5g} rpm; "
                            "check value and unit",
                            speed=rotation * 30.0 / math.pi, limit=FAST_ROTATION * 30.0 / math.pi))
    if feed > FAST_FEED:
        found.append(phrase("feed of up to {speed:.5g} m/s, which is unusual; usual are up to {limit:.5g} m/s; check "
                            "value and unit",
                            speed=feed, limit=FAST_FEED))
    return found


def _signs(feeds: list[tuple[float, float]], loads: list[tuple[float, float]]) -> list[str]:
    found: list[str] = []
    low, high = min((one[0] for one in loads), default=0.0), max((one[1] for one in loads), default=0.0)
    if low < -1e-9 * high:  # beyond the rounding of segments that cancel
        found.append(phrase("the load on the bit falls to {load:.4g} kN: below 0 it pulls the string into the hole, "
                            "and torque-drag counts it as 0; the load of a rock is > 0",
                            load=low / 1e3))
    if high > 0.0 and feeds and max(one[1] for one in feeds) <= 0.0 and min(one[0] for one in feeds) < 0.0:
        found.append(phrase("the feed of {speed:.4g} mm/s pulls the string out of the hole while a load acts on the "
                            "bit; a feed into the hole is > 0",
                            speed=1e3 * min(one[0] for one in feeds)))
    return found


def _narrow(calls: Any) -> list[str]:
    """Bits and strings that are narrow for their hole. A bit of diameter 0 does not touch it, and a reamer is a
    stabiliser."""
    holes = _of(calls, "add_wall")
    if not holes:
        return []
    hole = holes[0].get("diameter", DEFINITIONS["hole"]().diameter)
    gauges = [one.get("diameter", DEFINITIONS["bit"]().diameter) for one in _of(calls, "add_bit")
              if "stabiliser" not in one]
    found: list[str] = [phrase("the bit of {gauge:.4g} mm is narrow for its hole of {hole:.4g} mm; check values and "
                               "units", gauge=1e3 * gauge, hole=1e3 * hole)
                        for gauge in gauges if 0.0 < gauge < NARROW_BIT * hole]
    pipes = [arguments[1].get("outer_diameter", DEFINITIONS["pipes"]().outer_diameter)
             for name, arguments in calls if name == "add_pipes"]
    if not found and pipes and max(pipes) < NARROW_PIPE * hole:
        found.append(phrase("pipes of {diameter:.4g} mm are narrow for their hole of {hole:.4g} mm; check values and "
                            "units", diameter=1e3 * max(pipes), hole=1e3 * hole))
    return found
