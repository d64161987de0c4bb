"""The basis of the report: operation, hole and string in words, limits at the rig, assumptions."""
from __future__ import annotations

import platform
from typing import Any

from . import __version__, _structs, enums
from .results import RPM
from .language import Phrase, joined, phrase
from .operating import BIT_FRICTION, Operating
from .report_linear import Speeds
from .scene import Scene
from .unit_systems import Units
from .verdict import NOT_ASSESSED, OK, Demand, Tile, shown, worst

NAMES_OF = {"si": phrase("SI"), "field": phrase("field units (ft, lbf, psi)"),
            "mine": phrase("mine units (m, kN, MPa)")}
Row = tuple[str, str, str, str]  # quantity, limit, expected, verdict


def headline(string: str, plan: Operating, units: Units) -> Phrase:
    """String and operation, with the assumption that is made of the torque of the bit."""
    known: list[str] = [one for value, one in (
        (plan.rotation, phrase("rotation {value}", value=units.text((plan.rotation or 0.0) / RPM, "rpm"))),
        (plan.feed, phrase("feed {value}", value=units.text(1e3 * (plan.feed or 0.0), "mm/s"))),
        (plan.weight_on_bit, phrase("{load} on the bit", load=units.text((plan.weight_on_bit or 0.0) / 1e3, "kN"))))
                        if value]
    if plan.estimated:
        known.append(phrase("bit torque {torque}, estimated from the bit load with a coefficient of sliding friction "
                            "of {friction:g} "
                            "(Pessier and Fear 1992), because the scene has no rock law",
                            torque=units.text(plan.torque_on_bit, "N m"),
                            friction=BIT_FRICTION))
    if not known:
        return phrase("String {string}. The scene describes no operation.", string=string)
    return phrase("String {string}. Operation: {operation}.", string=string, operation=joined(", ", known))


def limits_at_the_rig(demands: dict[str, Demand], tiles: list[Tile], speeds: Speeds | None, plan: Operating,
                      units: Units) -> list[Row]:
    """Limits for the crew: a row for each quantity that the rig shows, also where no limit is known. Load on the bit
    and feed have the worst verdict of the results that they decide."""
    verdicts = {tile.title: tile.verdict for tile in tiles}
    rows: list[Row] = []
    for key in ("push", "pull", "torque"):
        demand = demands[key]
        limit = shown(demand.limit, demand.unit, units) if demand.limit else phrase("not given: ask before drilling")
        expected = shown(demand.value, demand.unit, units) if demand.value is not None else phrase("not known")
        rows.append((demand.title, limit, expected, verdicts[demand.title]))
    rotation = units.text((plan.rotation or 0.0) / RPM, "rpm") if plan.rotation else phrase("not known")
    speed = verdicts.get("Critical speeds", NOT_ASSESSED)
    if speeds is None or not speeds.assessed:
        rows.append((phrase("Rotary speed"), phrase("not known: no speeds were assessed"), rotation, speed))
    elif speeds.partial:
        rows.append((phrase("Rotary speed"), phrase("not known: not all outputs and orders were assessed"), rotation,
                     speed))
    else:
        ranges = [phrase("{low} to {high} rpm", low=low, high=high) for low, high in speeds.allowed()]
        limit = phrase("only {ranges}",
                       ranges=joined(" or ",
                                     ranges)) if ranges else phrase("no assessed speed is free of critical speeds")
        rows.append((phrase("Rotary speed"), limit, rotation, speed))
    decided = worst([verdicts[demand.title] for key, demand in demands.items() if key != "pull"]
                    + [verdicts.get("Buckling in the hole", NOT_ASSESSED), verdicts.get("Buckling, nonlinear", OK)])
    return [*rows, _planned(phrase("Load on the bit"), units.text((plan.weight_on_bit or 0.0) / 1e3, "kN"),
                            plan.weight_on_bit, decided),
            _planned(phrase("Feed rate"), units.text(1e3 * (plan.feed or 0.0), "mm/s"), plan.feed, decided)]


def _planned(title: str, shown_value: str, value: float | None, verdict: str) -> Row:
    """A quantity that the analyses had as the scene gives it."""
    if not value:
        return (title, phrase("not known: the scene gives none"), phrase("not known"), NOT_ASSESSED)
    return (title, phrase("{value}: more is not assessed", value=shown_value), shown_value, verdict)


def assumptions(scene: Scene, units: Units, hash_of_state: str) -> list[tuple[str, str]]:
    """The basis of the results."""
    info, calls = scene.model.info(), scene.model.calls
    features = next((arguments[0].get("features") for name, arguments in calls if name == "compile"), None)
    left_out = [] if features is None else [one.name for one in enums.Feature
                                            if one.name and not one & features and one & (one - 1) == 0]
    found: list[tuple[str, str]] = [
        (phrase("pipes, elements, degrees of freedom"), f"{info.pipes}, {info.elements}, {info.degrees_of_freedom}"),
        (phrase("mass, length"), f"{units.text(info.mass, 'kg')}, {units.text(info.length, 'm')}"), *_mud(calls, units),
        *_wall(calls, units)]
    return found + [
        (phrase("left out"), ", ".join(str(one).lower() for one in left_out)
         or phrase("nothing that the scene describes")),
        (phrase("not in this page"),
         phrase("connections (make-up torque), other friction factors; the stiff string at rest has the loads of time "
                "0 s")),
        (phrase("units"), NAMES_OF[units.name]),
        (phrase("library"), phrase("{version}, hash of the last state {hash}", version=__version__,
                                   hash=hash_of_state)),
        ("Python", platform.python_version())]


def _mud(calls: Any, units: Units) -> list[tuple[str, str]]:
    given: dict[str, Any] = next((arguments[0] for name, arguments in calls if name == "set_environment"), {})
    environment: Any = _structs.EnvironmentDef(**{key: value for key, value in given.items()
                                                  if key in ("fluid_density", "flow_rate")})
    if not environment.fluid_density:
        return [(phrase("mud"), phrase("none: the string is in air"))]
    density = units.text(environment.fluid_density, "kg/m3")
    if not environment.flow_rate:
        return [(phrase("mud"), phrase("density {density}, no flow", density=density))]
    return [(phrase("mud"), phrase("density {density}, flow rate {rate}", density=density,
                                   rate=units.text(environment.flow_rate, "m3/s")))]


def _wall(calls: Any, units: Units) -> list[tuple[str, str]]:
    if not any(name == "add_wall" for name, _ in calls):
        return []
    wall: Any = _structs.WallDef(**next((arguments[0] for name, arguments in calls if name == "add_wall"), {}))
    sections = (phrase("other values in its sections") if any(name == "add_hole_sections" for name, _ in calls) else
                phrase("the same along the hole"))
    diameter = units.text(1e3 * wall.diameter, "mm", "g")
    stiffness = _stiffness(wall, units)
    friction = phrase("friction {at_rest:g} at rest and {sliding:g} sliding", at_rest=wall.mu_static,
                      sliding=wall.mu_dynamic)
    return [(phrase("wall"), joined(", ", [phrase("diameter {diameter}", diameter=diameter), *stiffness, friction,
                                           sections]))]


def _stiffness(wall: Any, units: Units) -> list[Phrase]:
    """Left out where its unit, N/m^(n+1), has no equivalent."""
    if units.name == "si":
        return [phrase("stiffness {value:g} per metre", value=wall.stiffness)]
    return [phrase("stiffness {value}", value=units.text(wall.stiffness, "N/m2"))] if wall.exponent == 1.0 else []
