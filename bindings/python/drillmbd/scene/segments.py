"""A speed that swings once (or `order` times) a revolution of another time function, as by a worn gear in the head: with w the
rate of the other and theta its integral from 0,
    value  share w sin(order theta),
    rate   share (w' sin(order theta) + order w^2 cos(order theta)),
    integral  share (1 - cos(order theta))/order.
It rests when the other rests."""
from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

from ..enums import SEGMENT_CONSTANT, SEGMENT_HARMONIC, SEGMENT_STEP

_KNOWN = (SEGMENT_CONSTANT, SEGMENT_STEP, SEGMENT_HARMONIC)
_CONSTANT, _STEP, _HARMONIC = (int(kind) for kind in _KNOWN)  # compared faster than members of an enumeration


# Of a segment: its kind, h0, h1 - h0 or h1, and x0, x1, x1 - x0 or omega, phase.
_Segment = tuple[int, float, float, float, float, float]


def _segment(given: dict[str, Any]) -> _Segment:
    kind, h0, h1 = int(given.get("kind", SEGMENT_CONSTANT)), given.get("h0", 0.0), given.get("h1", 0.0)
    if kind == SEGMENT_STEP:
        begin, end = given.get("x0", 0.0), given.get("x1", 1.0)
        return _STEP, h0, h1 - h0, begin, end, end - begin
    return (_HARMONIC if kind == SEGMENT_HARMONIC else _CONSTANT), h0, h1, given.get("omega", 0.0), given.get("phase", 0.0), 0.0


def _harmonic(t: float, h0: float, h1: float, omega: float, phase: float) -> tuple[float, float, float]:
    """Rate, value and integral of h0 + h1 sin(omega t + phase)."""
    swing = (math.cos(phase) - math.cos(omega * t + phase)) / omega if omega else math.sin(phase) * t
    return h1 * omega * math.cos(omega * t + phase), h0 + h1 * math.sin(omega * t + phase), h0 * t + h1 * swing


def _sums(t: float, segments: tuple[_Segment, ...]) -> tuple[float, float, float]:
    """Rate, value and integral of all segments. It is called a few times in each step."""
    rate = value = integral = 0.0
    for kind, h0, height, begin, end, length in segments:
        if kind == _STEP:  # the smooth step from h0 to h0 + height: height D^2 (3 - 2 D), D = (t - begin)/length
            x = (t - begin) / length
            if x >= 1.0:
                value += h0 + height
                integral += h0 * t + height * (0.5 * length + (t - end))
            elif x > 0.0:
                rate += height * (6.0 * x * (1.0 - x) / length)
                value += h0 + height * (x * x * (3.0 - 2.0 * x))
                integral += h0 * t + height * (length * x * x * x * (1.0 - 0.5 * x))
            else:
                value += h0
                integral += h0 * t
        elif kind == _HARMONIC:
            more = _harmonic(t, h0, height, begin, end)
            rate, value, integral = rate + more[0], value + more[1], integral + more[2]
        else:
            value, integral = value + h0, integral + h0 * t
    return rate, value, integral


def value_at(time: float, segment: dict[str, Any]) -> float:
    """The value of one constant, step or harmonic segment, by its described fields."""
    return _sums(time, (_segment(segment),))[1]


@dataclass(frozen=True)
class PerRevolution:
    """The function of a segment of kind "per-revolution"."""
    of: str                  #: name of the other time function
    share: float             #: [-] of its rate
    order: float = 1.0       #: [-] swings a revolution
    segments: tuple[dict[str, Any], ...] = field(default=(), hash=False)  #: of the other time function
    _numbers: tuple[_Segment, ...] = field(default=(), init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "_numbers", tuple(_segment(one) for one in self.segments))

    @staticmethod
    def knows(segments: Any) -> bool:
        """Whether the other time function is of kinds that this follows: constants, steps and harmonics."""
        return all(segment.get("kind", SEGMENT_CONSTANT) in _KNOWN and not segment.get("table") and not segment.get("function")
                   for segment in segments)

    def __call__(self, time: float) -> tuple[float, float, float]:
        rate, value, integral = _sums(time, self._numbers)
        sine, cosine = math.sin(self.order * integral), math.cos(self.order * integral)
        return (self.share * value * sine, self.share * (rate * sine + self.order * value * value * cosine),
                self.share * (1.0 - cosine) / self.order)
