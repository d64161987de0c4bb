"""A scene in words, as `check` prints it: the course of the hole, string, bit and operation, and settings by which an answer
has nothing to show."""
from __future__ import annotations

import math
from typing import Any

from .. import enums
from .._structs import Term
from .content import Scene
from .fields import DEFINITIONS
from .survey import dogleg

_STEPS = (enums.TERM_STEP, enums.TERM_STEP5)


def describe(scene: Scene, mass: float) -> list[str]:
    """Sentences without a stop. mass [kg]: of all that is suspended."""
    calls = _calls(scene)
    gravity = math.hypot(*DEFINITIONS["environment"](**calls.get("set_environment", [({},)])[0][0]).gravity)
    found = _hole(scene, calls) + _pipes(scene, calls)
    if mass > 0.0 and gravity > 0.0:
        found.append(f"weight {mass * gravity / 1e3:.3g} kN in air")
    found += _bits(scene, calls) + _operation(calls)
    step = scene.run.get("step")
    if "end" in scene.run:
        found.append(f"run of {scene.run['end']:g} s, " + (f"time step {1e3 * step:.3g} ms" if step else "time step chosen by the library"))
    return found


def trivial(scene: Scene) -> list[str]:
    """Excitations and damping that the scene leaves out, with the answers that have nothing to show then."""
    calls = _calls(scene)
    found = []
    pipes = [DEFINITIONS["pipes"](**{key: value for key, value in one.items() if key != "string"}) for _, one in calls.get("add_pipes", [])]
    if not scene.model.inputs() and not any(one.get("kind") for one, in calls.get("add_drive", []) if one.get("component") == enums.RX) and not any(
            spin for component, spin in _speeds(calls) if component == enums.RX):
        found.append("no rotation: torque, whirl and critical speeds are not excited")
    if pipes and not any(one.eccentricity or one.eccentricity_spread for one in pipes):
        found.append("no eccentricity of the pipes: rotation excites no lateral vibration; set eccentricity in [[string.pipes]]")
    if calls.get("add_bit") and not any(_bit_load(calls, one) for one, in calls["add_bit"]):
        found.append("no load on the bit: buckling and bit torque are not assessed; set load in [[bit]]")
    if pipes and not any(one.damping_time for one in pipes):
        found.append("no material damping of the pipes: vibrations do not decay by themselves; set damping_time in [[string.pipes]]")
    return found


def _calls(scene: Scene) -> dict[str, list[tuple[Any, ...]]]:
    found: dict[str, list[tuple[Any, ...]]] = {}
    for name, arguments in scene.model.calls:
        found.setdefault(name, []).append(arguments)
    return found


# ---- The hole --------------------------------------------------------------------------------------------------------
def _hole(scene: Scene, calls: dict[str, list[tuple[Any, ...]]]) -> list[str]:
    if "add_wall" not in calls:
        return ["no hole"]
    stations = calls["add_wall"][0][0].get("stations") or []
    top = stations[0][0] if stations else 0.0
    found = [f"collar at {_direction(scene.model.hole(top))}"]
    if not stations:
        return found + ["straight hole"]
    found += [f"surveyed length {stations[-1][0] - top:.4g} m", _end(scene.model.hole(top), scene.model.hole(stations[-1][0]))]
    sharpest = max((dogleg(a, b), a[0], b[0]) for a, b in zip(stations, stations[1:]))
    found.append(f"largest dogleg {math.degrees(sharpest[0]) * 30.0:.2g} deg/30 m between {sharpest[1]:g} m and {sharpest[2]:g} m"
                 if sharpest[0] > 1e-9 else "no dogleg")
    return found


def _direction(point: Any) -> str:
    """By dip where it is flatter than 45 deg, else by inclination."""
    dip = math.degrees(point.inclination) - 90.0
    azimuth = f"azimuth {math.degrees(point.azimuth) % 360.0:.4g} deg"
    if abs(dip) > 45.0:
        way = "down" if dip < 0.0 else "up"
        steep = f"inclination {dip + 90.0:.3g} deg from the downward vertical ({way})"
        return steep if 90.0 - abs(dip) < 1e-3 else f"{steep}, {azimuth}"
    return f"dip {dip:+.1f} deg ({'level' if abs(dip) < 0.05 else 'rises' if dip > 0.0 else 'falls'}), {azimuth}"


def _end(top: Any, end: Any) -> str:
    """The place of the end, seen from the collar along its azimuth."""
    east, north, up = -(end.position[1] - top.position[1]), end.position[0] - top.position[0], end.position[2] - top.position[2]
    height = f"{abs(up):.1f} m {'above' if up >= 0.0 else 'below'}"
    if abs(math.degrees(top.inclination) - 90.0) > 45.0:
        away = math.hypot(east, north)
        towards = f" towards azimuth {math.degrees(math.atan2(east, north)) % 360.0:.3g} deg" if away > 0.05 else ""
        return f"ends {height} the collar and {away:.1f} m away{towards}"
    right = east * math.cos(top.azimuth) - north * math.sin(top.azimuth)
    return f"ends {height} and {abs(right):.1f} m {'right' if right >= 0.0 else 'left'} of the collar line"


# ---- String, bit, operation ------------------------------------------------------------------------------------------
def _pipes(scene: Scene, calls: dict[str, list[tuple[Any, ...]]]) -> list[str]:
    found, ends = [], dict[int, float]()
    for count, one in calls.get("add_pipes", []):
        pipe = DEFINITIONS["pipes"](**{key: value for key, value in one.items() if key != "string"})
        wall = 0.5e3 * (pipe.outer_diameter - pipe.inner_diameter)
        bore = f"{1e3 * pipe.outer_diameter:.4g} x {wall:.3g} mm" if pipe.inner_diameter else f"{1e3 * pipe.outer_diameter:.4g} mm solid"
        found.append(f"{count} pipe{'s' if count > 1 else ''} of {pipe.length:.4g} m, {bore}")
        key = one["string"].index if "string" in one else -1
        ends[key] = ends.get(key, 0.0) + count * pipe.length
    if found:
        found[-1] += f", reach {max(ends.values()):.5g} m" if len(ends) == 1 else ""
    return found


def _bits(scene: Scene, calls: dict[str, list[tuple[Any, ...]]]) -> list[str]:
    found = []
    hole = DEFINITIONS["hole"](**{k: v for k, v in calls["add_wall"][0][0].items() if k != "stations"}).diameter if "add_wall" in calls else 0.0
    for one, in calls.get("add_bit", []):
        gauge = DEFINITIONS["bit"](**{key: value for key, value in one.items() if key == "diameter"}).diameter
        if gauge:
            found.append(f"bit {1e3 * gauge:.4g} mm" + (f" in a {1e3 * hole:.4g} mm hole" if hole else ""))
    return found


def _operation(calls: dict[str, list[tuple[Any, ...]]]) -> list[str]:
    found = [f"rotation {speed * 30.0 / math.pi:.4g} rpm" if component == enums.RX else f"feed {1e3 * speed:.4g} mm/s"
             for component, speed in _speeds(calls) if component in (enums.RX, enums.X)]
    found += [f"{_bit_load(calls, one) / 1e3:.4g} kN on the bit" for one, in calls.get("add_bit", []) if _bit_load(calls, one)]
    return [", ".join(found)] if found else ["no operation: nothing is driven"]


def _speeds(calls: dict[str, list[tuple[Any, ...]]]) -> list[tuple[int, float]]:
    """Component and last value of the drives that prescribe a motion."""
    return [(one.get("component", int(enums.X)), _last(calls, one["programme"])) for one, in calls.get("add_drive", [])
            if "programme" in one and one.get("kind", int(enums.DRIVE_MOTION)) != enums.DRIVE_LOAD]


def _bit_load(calls: dict[str, list[tuple[Any, ...]]], bit: dict[str, Any]) -> float:
    return _last(calls, bit["load"]) if "load" in bit else 0.0


def _last(calls: dict[str, list[tuple[Any, ...]]], programme: Any) -> float:
    """The value at which a programme ends; swings count by their middle."""
    terms = calls["add_programme"][programme.index & 0xFFFFFF]
    total = 0.0
    for one in terms:
        if one.get("table"):
            total += one["table"][-1][1]
        elif "function" not in one:
            term = Term(**one)
            total += term.h1 if term.kind in _STEPS else term.h0
    return total
