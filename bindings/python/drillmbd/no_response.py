"""Outputs that nothing moves but rounding. A linear response of 1e-16 m is no amplitude: the excitation does not reach
that output. It is held against the motion of the strings in all directions, or against the other components of the same
section."""
from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from . import enums, station
from ._structs import Excitation, Output
from .language import Phrase, phrase
from .outputs import output_of
from .scene import Scene
from .sim import Sim

ROUNDING = 1e-9   #: of the largest component, below which an amplitude is rounding: static states balance to 1e-10
SURE = 1e-6       #: of its limit, above which a severity is not looked at again
RADIUS = 0.05     #: [m] by which rotations count as displacements, and moments as forces: about that of a pipe
FORCES = -1       #: the kind of section forces; 0, 1, 2: vibrations, their rates and accelerations

NOTHING_EXCITES = phrase("all excitations are zero. Give the pipes an eccentricity (string.pipes.eccentricity, for "
                         "example \"0.5 mm\"), or "
                         "excite the string by a drive, load or force")
NO_RESPONSE = phrase("the excitation moves the string, but not this output; amplitudes below 1e-9 of the largest are "
                     "rounding. Components are "
                     "north, west and up, those of the pipe in vibration_body")
UNREACHED = phrase("the orders of [speeds] excite none of its outputs; amplitudes below 1e-9 of the largest are "
                   "rounding. Components are north, west "
                   "and up, those of the pipe in vibration_body")


def _kind(out: Output) -> int | None:
    """0, 1, 2 of a vibration, its rate, its acceleration; FORCES; None of other outputs."""
    kind = (out.quantity - enums.OUTPUT_VIBRATION) // 20
    if kind in (0, 1, 2):
        return int(kind)
    return FORCES if 0 <= out.quantity - enums.OUTPUT_SECTION_FORCE < 6 else None


def _probes(scene: Scene, out: Output) -> list[Output]:
    """All components of both ends and the middle of each string, of motions of the same kind, else displacements; of
    section forces those of the same place too."""
    base = enums.OUTPUT_VIBRATION + 20 * max(_kind(out) or 0, 0)
    places = [station(scene.names[name], pipe, fraction) for name, pipes in scene.pipes.items()
              for pipe, fraction in ((0, 0.0), (pipes // 2, 0.5), (pipes - 1, 1.0))]
    found = [output_of((place, int(base + component))) for place in places for component in range(6)]
    if _kind(out) == FORCES:
        found += [output_of((out.place, int(enums.OUTPUT_SECTION_FORCE + component))) for component in range(6)]
    return found


def with_grid(options: dict[str, Any]) -> dict[str, Any]:
    """The options without refinement."""
    return {**options, "refinement": 0}


def _weight(out: Output) -> float:
    """Factor of an amplitude for comparison: rotations by RADIUS, moments by its inverse."""
    turning = _kind(out) is not None and out.quantity % 10 >= enums.RX
    return (1.0 / RADIUS if _kind(out) == FORCES else RADIUS) if turning else 1.0


def _comparable(out: Output, other: Output) -> bool:
    """Whether both have one unit, rotations counted as displacements."""
    return _kind(out) is not None and _kind(out) == _kind(other)


def _judged(own: float, out: Output, around: list[tuple[Output, float]]) -> Phrase | None:
    """None where the output moves, else why it does not."""
    alike = [size for one, size in around if _comparable(out, one)]
    if own > ROUNDING * max(alike, default=0.0) and own > 0.0:
        return None
    return NO_RESPONSE if max([own, *(size for _, size in around)]) > 0.0 else NOTHING_EXCITES


def of_response(sim: Sim, scene: Scene, inputs: Sequence[Excitation], out: Output, options: dict[str, Any],
                frequency: float) -> Phrase | None:
    """Why the response of an output at a frequency [Hz] is none; None where it is one."""
    listed = [out, *_probes(scene, out)]
    with sim.response(inputs, listed, frequencies=[frequency], **with_grid(options)) as found:
        sizes = [_weight(one) * abs(complex(found.transfer(output=number)[0])) for number, one in enumerate(listed)]
    return _judged(sizes[0], out, list(zip(listed[1:], sizes[1:])))


def of_speeds(sim: Sim, scene: Scene, options: dict[str, Any]) -> list[Phrase | None]:
    """Why the orders of [speeds] do not move an output, for each of its outputs; None where they do."""

    def largest(listed: list[Output], limits: list[float]) -> float:
        return max(sim.speeds(scene.orders(), listed, limits, **with_grid(options))[1])

    def amplitude(listed: list[Output]) -> float:
        return largest(listed, [1.0 / _weight(one) for one in listed])

    reasons: list[Phrase | None] = []
    for out, limit in zip(scene.response_outputs("speeds"),
                          [one["limit"] for one in scene.analyses["speeds"]["output"]]):
        if largest([out], [limit]) > SURE:
            reasons.append(None)
            continue
        around = _probes(scene, out)
        reasons.append(_judged(amplitude([out]), out,
                               [(around[-1], amplitude([one for one in around if _kind(one) == _kind(around[-1])]))]))
    return reasons


def of_all(reasons: Sequence[Phrase | None]) -> Phrase | None:
    """Why no output is moved; None where one is."""
    if None in reasons:
        return None
    return UNREACHED if NO_RESPONSE in reasons else NOTHING_EXCITES
