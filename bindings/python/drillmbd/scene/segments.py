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


def _step(t: float, begin: float, end: float) -> tuple[float, float, float]:
    """Rate, value and integral of the smooth step from 0 to 1."""
    length = end - begin
    x = (t - begin) / length
    if x <= 0.0:
        return 0.0, 0.0, 0.0
    if x < 1.0:
        return 6.0 * x * (1.0 - x) / length, x * x * (3.0 - 2.0 * x), length * x * x * x * (1.0 - 0.5 * x)
    return 0.0, 1.0, 0.5 * length + (t - end)


def _segment(t: float, segment: dict[str, Any]) -> tuple[float, float, float]:
    kind, h0, h1 = segment.get("kind", SEGMENT_CONSTANT), segment.get("h0", 0.0), segment.get("h1", 0.0)
    if kind == SEGMENT_STEP:
        rate, value, integral = _step(t, segment.get("x0", 0.0), segment.get("x1", 1.0))
        height = h1 - h0
        return height * rate, h0 + height * value, h0 * t + height * integral
    if kind == SEGMENT_HARMONIC:
        omega, phase = segment.get("omega", 0.0), segment.get("phase", 0.0)
        swing = (math.cos(phase) - math.cos(omega * t + phase)) / omega if omega else math.sin(phase) * t
        return (h1 * omega * math.cos(omega * t + phase), h0 + h1 * math.sin(omega * t + phase), h0 * t + h1 * swing)
    return 0.0, h0, h0 * t


@dataclass(frozen=True)
class PerRevolution:
    """The function of a segment of kind "per-revolution"."""
    of: str                  #: name of the other time function
    share: float             #: [-] of its rate
    order: float = 1.0       #: [-] swings a revolution
    segments: tuple[dict[str, Any], ...] = field(default=(), hash=False)  #: of the other time function

    @staticmethod
    def knows(segments: Any) -> bool:
        """Whether the other time function is of kinds that this follows: constants, steps and harmonics."""
        return all(segment.get("kind", SEGMENT_CONSTANT) in _KNOWN and not segment.get("table") and not segment.get("function")
                   for segment in segments)

    def __call__(self, time: float) -> tuple[float, float, float]:
        rate = value = integral = 0.0
        for segment in self.segments:
            more = _segment(time, segment)
            rate, value, integral = rate + more[0], value + more[1], integral + more[2]
        sine, cosine = math.sin(self.order * integral), math.cos(self.order * integral)
        return (self.share * value * sine, self.share * (rate * sine + self.order * value * value * cosine),
                self.share * (1.0 - cosine) / self.order)
