"""Critical bands over the range of the uncertain parameters in [variability]: diameters, friction and all else that
scatters."""
from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any

from .results import RPM, CommandOutput
from .errors import Error
from .scene import Scene, SceneError
from .unit_systems import SI, TABLE, Units

if TYPE_CHECKING:
    from .critical_speeds import Found

QUANTILE = 1.6448536269514722  #: of the standard normal distribution, at 95 %
#: uncertain values of which all combinations of low and high are computed; more: one after the other
MOST_BREAKPOINTS = 4
NO_RANGE = ("range: not assessed, because the scene gives no uncertain diameter or friction; the bands are those of "
            "the described values. Give "
            "[[variability.scatter]] with keys = [\"hole.mu_static\", \"hole.mu_dynamic\"] and relative = true "
            "(factors of both), or with "
            "key = \"hole.diameter\" (not below the diameter of the bit)")


def ends_of(marginal: Any) -> tuple[float, float]:
    """Both ends of a distribution that has them, else its 5 % and 95 %."""
    if "low" in marginal.values:
        return marginal.values["low"], marginal.values["high"]
    from .probability.marginals import Translation
    translation = Translation(marginal)
    return float(translation(-QUANTILE)), float(translation(QUANTILE))


def breakpoints(scene: Scene) -> list[dict[str, Any]]:
    """Changes of the scene, one case each. Fields along hole or string have one value along all of it; processes in
    time are left out."""
    from .probability.draw import Draw
    assert scene.variability is not None
    draw = Draw(scene)
    middle = draw.values([0.0] * draw.dimension)
    parts: list[Any] = [*scene.variability.scatters, *scene.variability.fields]
    ends = {one.name: ends_of(one.marginal) for one in parts}
    if len(parts) <= MOST_BREAKPOINTS:
        choices = [dict(zip(ends, values)) for values in itertools.product(*ends.values())]
    else:
        choices = [{name: value} for name, pair in ends.items() for value in pair]
    return [draw.overrides({name: 0.0 * value + choice.get(name, value) if name in ends else value
                          for name, value in middle.items()})
            for choice in choices]


def union(bands: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Bands that together cover the same speeds, ascending and apart."""
    found: list[tuple[float, float]] = []
    for low, high in sorted(bands):
        if found and low <= found[-1][1]:
            found[-1] = found[-1][0], max(found[-1][1], high)
        else:
            found.append((low, high))
    return found


def bands_over_range(scene: Scene, out: CommandOutput, found: Found) -> list[tuple[float, float]]:
    """The union of the bands [rad/s] of the described scene and of all breakpoints of its range; it is printed and
    noted in the summary."""
    from .critical_speeds import analyse
    if scene.variability is None or not (scene.variability.scatters
                                         or scene.variability.fields) or scene.changed is None:
        out.say(NO_RANGE)
        out.summary["speeds_range"] = None
        return []
    bands = [(band.low, band.high) for band in found.bands]
    cases = breakpoints(scene)
    failed: list[str] = []
    lost = 0
    for changes in cases:
        try:
            case = analyse(scene.changed(changes), lambda sim, state: sim.static(**state.static), failed.append)
            bands += [(band.low, band.high) for band in case.bands]
            lost += not case.whole
        except (Error, SceneError) as error:
            failed.append(str(error))
            lost += 1
    parts: list[Any] = [*scene.variability.scatters, *scene.variability.fields]
    parts_text = ", ".join(_words(one, out.units) for one in parts)
    ranges = union(bands)
    text = "; ".join(f"avoid {low / RPM:.0f} .. {high / RPM:.0f} rpm"
                     for low, high in ranges) or ("not assessed" if lost == len(cases)
                                                  else f"no critical speed in {len(cases) - lost} of them")
    if lost:
        text += f"; {lost} of the {len(cases)} cases are not assessed, or not for all outputs and orders"
    if len(ranges) > 1:
        text += "; speeds between these bands are not shown to be free, because bands move as the values change " \
            "between the cases"
    how = "all combinations" if len(parts) <= MOST_BREAKPOINTS else "one at its end, the others in the middle"
    out.say(f"over the range of {parts_text} ({len(cases)} cases, {how}): {text}")
    for one in dict.fromkeys(failed):
        out.note_text(f"speeds, a case of the range: {one}")
    if scene.variability.processes:
        out.say("random processes in time are left out of the range")
    out.summary["speeds_range"] = {"bands_rpm": [[low / RPM, high / RPM] for low, high in ranges], "cases": len(cases),
                                   "not_assessed": lost,
                                      "of": [one.name for one in parts]}
    return ranges


def _words(one: Any, units: Units) -> str:
    low, high = ends_of(one.marginal)
    if one.relative:
        return f"{one.name} (factor {low:.4g} .. {high:.4g})"
    shown = units if one.unit in TABLE else SI
    return f"{one.name} ({shown.number(low, one.unit)} .. {shown.text(high, one.unit)})".replace(" -)", ")")
