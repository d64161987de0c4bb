"""A scene in words, as `check` prints it: the course of the hole, string, bit and operation, and settings for which a
result is empty."""
from __future__ import annotations

import math
from typing import Any

from .. import enums
from ..language import Phrase, joined, phrase
from .content import Scene
from .fields import DEFINITIONS
from .largest import bounded, range_of
from .segments import by_numbers
from .survey import dogleg


def describe(scene: Scene, mass: float) -> list[str]:
    """Phrases without a stop. mass [kg]: of all that is suspended."""
    calls = _calls(scene)
    gravity = math.hypot(*DEFINITIONS["environment"](**calls.get("set_environment", [({},)])[0][0]).gravity)
    found: list[str] = [*_hole(scene, calls), *_pipes(scene, calls)]
    if mass > 0.0 and gravity > 0.0:
        found.append(phrase("weight {weight:.3g} kN in air", weight=mass * gravity / 1e3))
    found += _bits(scene, calls) + _operation(calls)
    step = scene.run.get("step")
    if "end" in scene.run:
        end = scene.run["end"]
        found.append(phrase("run of {end:g} s, time step {step:.3g} ms", end=end, step=1e3 * step) if step else
                     phrase("run of {end:g} s, time step chosen by the library", end=end))
    return found


def trivial(scene: Scene) -> list[str]:
    """Excitations and damping that the scene leaves out, with the results that are empty then."""
    calls = _calls(scene)
    found: list[str] = []
    pipes = [DEFINITIONS["pipes"](**{key: value for key, value in one.items() if key != "string"})
             for _, one in calls.get("add_pipes", [])]
    if pipes and not scene.model.inputs() and not any(one.get("kind") for one, in calls.get("add_drive", [])
                                                      if one.get("component") == enums.RX) and not any(
            one.get("component") == enums.RX and _ever(calls, one.get("time_function"))
            for one, in calls.get("add_drive", [])):
        found.append(phrase("no rotation: torque, whirl and critical speeds are not excited"))
    if pipes and not any(one.eccentricity or one.eccentricity_spread for one in pipes):
        found.append(phrase("no eccentricity of the pipes: rotation excites no lateral vibration; set eccentricity in "
                            "[[string.pipes]]"))
    if calls.get("add_bit") and not any(one.get("rock_law") or _ever(calls, one.get("load"))
                                        for one, in calls["add_bit"]):
        found.append(phrase("no load on the bit: buckling and bit torque are not assessed; set load in [[bit]]"))
    if pipes and not any(one.damping_time for one in pipes):
        found.append(phrase("no material damping of the pipes: vibrations do not decay by themselves; set damping_time "
                            "in [[string.pipes]]"))
    return found


def _calls(scene: Scene) -> dict[str, list[tuple[Any, ...]]]:
    found: dict[str, list[tuple[Any, ...]]] = {}
    for name, arguments in scene.model.calls:
        found.setdefault(name, []).append(arguments)
    return found


# ---- The hole --------------------------------------------------------------------------------------------------------
def _hole(scene: Scene, calls: dict[str, list[tuple[Any, ...]]]) -> list[str]:
    if "add_wall" not in calls:
        return [phrase("no hole")]
    stations = calls["add_wall"][0][0].get("stations") or []
    top = stations[0][0] if stations else 0.0
    found: list[str] = [phrase("collar at {direction}", direction=_direction(scene.model.hole(top)))]
    if not stations:
        return found + [phrase("straight hole")]
    found += [phrase("surveyed length {length:.6g} m", length=stations[-1][0] - top),
              _end(scene.model.hole(top), scene.model.hole(stations[-1][0]))]
    sharpest = max((dogleg(a, b), a[0], b[0]) for a, b in zip(stations, stations[1:]))
    found.append(phrase("largest dogleg {dogleg:.2g} deg/30 m between {begin:g} m and {end:g} m",
                        dogleg=math.degrees(sharpest[0]) * 30.0,
                        begin=sharpest[1], end=sharpest[2]) if sharpest[0] > 1e-9 else phrase("no dogleg"))
    return found


def _direction(point: Any) -> Phrase:
    """By dip where it is flatter than 45 deg, else by inclination."""
    dip, azimuth = math.degrees(point.inclination) - 90.0, math.degrees(point.azimuth) % 360.0
    if abs(dip) > 45.0:
        way = phrase("down") if dip < 0.0 else phrase("up")
        if 90.0 - abs(dip) < 1e-3:
            return phrase("inclination {inclination:.3g} deg from the downward vertical ({way})",
                          inclination=dip + 90.0, way=way)
        return phrase("inclination {inclination:.3g} deg from the downward vertical ({way}), azimuth {azimuth:.4g} deg",
                      inclination=dip + 90.0,
                      way=way, azimuth=azimuth)
    way = phrase("level") if abs(dip) < 0.05 else phrase("rises") if dip > 0.0 else phrase("falls")
    return phrase("dip {dip:+.1f} deg ({way}), azimuth {azimuth:.4g} deg", dip=dip, way=way, azimuth=azimuth)


def _end(top: Any, end: Any) -> Phrase:
    """The place of the end, seen from the collar along its azimuth."""
    east, north, up = -(end.position[1]
                        - top.position[1]), end.position[0] - top.position[0], end.position[2] - top.position[2]
    height = phrase("{height:.1f} m above", height=up) if up >= 0.0 else phrase("{height:.1f} m below", height=-up)
    if abs(math.degrees(top.inclination) - 90.0) > 45.0:
        away = math.hypot(east, north)
        if away <= 0.05:
            return phrase("ends {height} the collar and {away:.1f} m away", height=height, away=away)
        return phrase("ends {height} the collar and {away:.1f} m away towards azimuth {azimuth:.3g} deg", height=height,
                      away=away,
                      azimuth=math.degrees(math.atan2(east, north)) % 360.0)
    right = 0.0 + round(east * math.cos(top.azimuth) - north * math.sin(top.azimuth), 6)  # no -0.0
    aside = (phrase("{distance:.1f} m right", distance=right) if right >= 0.0
             else phrase("{distance:.1f} m left", distance=-right))
    return phrase("ends {height} the collar and {aside} of its line", height=height, aside=aside)


# ---- String, bit, operation ------------------------------------------------------------------------------------------
def _pipes(scene: Scene, calls: dict[str, list[tuple[Any, ...]]]) -> list[Phrase]:
    found, ends = list[Phrase](), dict[int, float]()
    for count, one in calls.get("add_pipes", []):
        pipe = DEFINITIONS["pipes"](**{key: value for key, value in one.items() if key != "string"})
        wall = 0.5e3 * (pipe.outer_diameter - pipe.inner_diameter)
        outer = 1e3 * pipe.outer_diameter
        bore = phrase("{outer:.4g} x {wall:.3g} mm", outer=outer,
                      wall=wall) if pipe.inner_diameter else phrase("{outer:.4g} mm solid", outer=outer)
        found.append(phrase("{count} pipes of {length:.4g} m, {bore}", count=count, length=pipe.length, bore=bore)
                     if count > 1 else
                     phrase("1 pipe of {length:.4g} m, {bore}", length=pipe.length, bore=bore))
        key = one["string"].index if "string" in one else -1
        ends[key] = ends.get(key, 0.0) + count * pipe.length
    if found and len(ends) == 1:
        found[-1] = phrase("{pipes}, reach {reach:.5g} m", pipes=found[-1], reach=max(ends.values()))
    return found


def _bits(scene: Scene, calls: dict[str, list[tuple[Any, ...]]]) -> list[str]:
    found: list[str] = []
    hole = DEFINITIONS["hole"](**{k: v for k, v in calls["add_wall"][0][0].items()
                                  if k != "stations"}).diameter if "add_wall" in calls else 0.0
    for one, in calls.get("add_bit", []):
        gauge = DEFINITIONS["bit"](**{key: value for key, value in one.items() if key == "diameter"}).diameter
        if gauge:
            found.append(phrase("bit {gauge:.4g} mm in a {hole:.4g} mm hole", gauge=1e3 * gauge, hole=1e3 * hole)
                         if hole else
                         phrase("bit {gauge:.4g} mm", gauge=1e3 * gauge))
    return found


def _operation(calls: dict[str, list[tuple[Any, ...]]]) -> list[str]:
    found = [phrase("rotation {speed:.4g} rpm", speed=abs(speed) * 30.0 / math.pi) if component == enums.RX else
             phrase("feed {speed:.4g} mm/s", speed=1e3 * speed) for component, speed in _speeds(calls)
             if component in (enums.RX, enums.X)]
    found += [phrase("{load:.4g} kN on the bit", load=_bit_load(calls, one) / 1e3) for one, in calls.get("add_bit", [])
              if _bit_load(calls, one)]
    return [joined(", ", found) if found else phrase("no operation: nothing is driven")]


def _speeds(calls: dict[str, list[tuple[Any, ...]]]) -> list[tuple[int, float]]:
    """Component and speed of largest magnitude of the drives that prescribe a motion."""
    return [(one.get("component", int(enums.X)), _largest(calls, one["time_function"]))
            for one, in calls.get("add_drive", [])
            if "time_function" in one and one.get("kind", int(enums.DRIVE_MOTION)) != enums.DRIVE_LOAD]


def _bit_load(calls: dict[str, list[tuple[Any, ...]]], bit: dict[str, Any]) -> float:
    return _largest(calls, bit["load"]) if "load" in bit else 0.0


def _ever(calls: dict[str, list[tuple[Any, ...]]], time_function: Any) -> bool:
    """Whether a time function has a value other than 0 at any time."""
    segments = _segments(calls, time_function) if time_function else []
    return any(not by_numbers(one) or one.get("h0")
               or (one.get("h1") and one.get("kind", enums.SEGMENT_CONSTANT) != enums.SEGMENT_CONSTANT)
               or any(value for _, value in one.get("table", ())) for one in segments)


def _largest(calls: dict[str, list[tuple[Any, ...]]], time_function: Any) -> float:
    """The value of largest magnitude of a time function, with its sign; of one with a function of Python that of the
    others."""
    low, high = range_of([one for one in _segments(calls, time_function) if by_numbers(one)]) or (0.0, 0.0)
    return high if high >= -low else low


def _segments(calls: dict[str, list[tuple[Any, ...]]], time_function: Any) -> list[dict[str, Any]]:
    known = calls["add_time_function"]
    return bounded(known[time_function.index & 0xFFFFFF], known)
