"""Critical factors of buckling of the whole scene, and the thrusts at which a soft string begins to buckle and locks
up, by depth."""
from __future__ import annotations

import math
import re
from collections.abc import Callable
from typing import Any

from . import enums
from ._structs import TorqueDragRow
from .analysis import Buckling, usual_operation
from .results import CommandOutput, file_name
from .errors import Error, NoResult, Usage, status_text
from .commands import along_pipes, stations_of, to_rest
from .profile import span
from .scene import Scene
from .sim import Sim
from .torque_drag import depths_of
from .unit_systems import Units

DEPTHS = 5           #: of the table of thrusts
DOUBLINGS, HALVINGS = 60, 45
SLIPS = ("slip_axial", "slip_rotation")
ENDS = {int(value): value.name.lower() for value in enums.BucklingEnd}


def buckle(scene: Scene, out: CommandOutput, options: Any) -> int:
    """Both; status 1 if neither is found."""
    if not scene.pipes:
        raise Usage("buckle is about a string, the scene has none")
    reasons: list[str] = []
    with scene.new_sim() as sim:
        soft = [_thrusts(scene, sim, out, name) for name in scene.pipes]
        try:
            _factors(scene, sim, out)
        except KeyboardInterrupt:
            out.stopped("stopped by Ctrl-C before the critical factors were found")
            return out.finish()
        except Error as error:
            reasons.append(out.units.sentence(reason_of(scene, sim, error)))
            out.note_text(f"critical factors: not assessed, because {reasons[-1]}")
            out.summary["buckling"] = {"factors": [], "not_assessed": reasons[-1]}
    if reasons and not any(soft):
        raise NoResult(f"buckling: not assessed, because {reasons[-1]}")
    return out.finish()


# ---- Critical factors ------------------------------------------------------------------------------------------------
def _factors(scene: Scene, sim: Sim, out: CommandOutput) -> None:
    values = scene.fields_of("buckling")
    static = scene.fields_of("static")
    for key in SLIPS:  # the equilibrium of [static] is one with this friction only
        if key in static:
            values.setdefault(key, static[key])
    to_rest(scene, sim, out)
    with _found(sim, values, out) as found:
        confirmed = found.info.confirmed
        for index, factor in enumerate(found.factors):
            out.say(f"critical factor {factor:.6g}: {_loads(values, factor)}; " + ("confirmed" if index < confirmed
                                                                                   else "extrapolated, not confirmed"))
        if not found.factors:
            out.say("no critical factor was found in the range of [buckling] factor_max")
        if math.isfinite(found.info.sinusoidal_share):
            out.say(f"for comparison: at the last state that was followed, {100.0 * found.info.sinusoidal_share:.3g} % "
                    "of the sinusoidal buckling load of a "
                       "pipe on the wall")
        out.summary["buckling"] = {"factors": found.factors, "confirmed": confirmed, "end": ENDS[found.info.end]}
        out.table("buckling.csv", ["factor", "confirmed"],
                     [(factor, int(index < confirmed)) for index, factor in enumerate(found.factors)])
        for name, places, along in stations_of(scene) if found.factors else []:
            shape = found.shapes(0, places)
            out.picture(f"buckling_{file_name(name)}.png", lambda plots: along_pipes(
                plots.buckling(shape, along, found.factors[0], scene.title, out.units)))


def _found(sim: Sim, values: dict[str, Any], out: CommandOutput) -> Buckling:
    """Followed along the equilibria; if that fails, extrapolated from the present state, with a note."""
    try:
        found = sim.buckling(**values)
    except Error as error:
        if error.status != enums.Status.ERR_NO_CONVERGENCE or not values.get("follow", 1):
            raise
        present: dict[str, Any] = {**values, "follow": 0}
        found = sim.buckling(**present)
        reached = re.search(r"stable up to factor = [-+.\de]+", error.message)
        out.note_text("buckling: the equilibria " + (f"are {reached[0]} and " if reached else "")
                      + "could not be followed to the critical factor; "
                         "factors are extrapolated from the static state. Use more elements or a softer wall to "
                         "confirm them")
        return found
    if found.status > 0:
        out.note_text("buckling: " + out.units.sentence(sim.message
                                                        or status_text(found.status)).removeprefix("buckling: "))
    return found


def _loads(values: dict[str, Any], factor: float) -> str:
    scale = int(values.get("scale", enums.SCALE_LOADS))
    if scale == enums.SCALE_PART:
        return "times the part of [buckling]"
    return (f"{'weight and all loads' if scale == enums.SCALE_ALL else 'all loads but weight'} at {1.0 + factor:.4g} "
            "times the present ones")


def reason_of(scene: Scene, sim: Sim, error: Error) -> str:
    """Why factors could not be computed, without names of functions of the library."""
    if error.status == enums.Status.ERR_SINGULAR and re.search("holds it", error.message):
        return ("no drive holds the string's angle about its axis, so its stiffness is singular. Hold it by a drive "
                "with component = \"rx\" and "
                "kind = \"motion\"" + _hanging(scene, sim))
    text = re.sub(r"^(buckling|static): ", "", error.message)
    text = re.sub(r"(call|with) dmb_analysis_static first", "choose other values of [static]", text)
    return re.sub(r"\bdmb_\w+", "the library", text) + _hanging(scene, sim)


def _hanging(scene: Scene, sim: Sim) -> str:
    try:
        spans = [span(sim.profile(scene.names[name], pipes).axial_force) for name, pipes in scene.pipes.items()]
    except Error:
        return ""
    lowest, largest = span(sum(spans, ()))
    if largest > 0.0 and lowest > -1e-3 * largest:
        return ". No part of the string is compressed in the static state either: give the bit a load"
    return ""


# ---- Thrusts of the soft string --------------------------------------------------------------------------------------
def _row(sim: Sim, string: Any, depth: float, weight: float) -> TorqueDragRow:
    return sim.torque_drag([usual_operation(enums.OPERATION_SLACK_OFF, weight_on_bit=weight)], [depth],
                           string=string).rows[0][0]


def first_weight(of: Callable[[float], bool]) -> float:
    """[N] The lowest load of the bit for which a rising condition holds, by doubling and halving; infinite if there is
    none."""
    low, high = 0.0, 1e3
    if of(low):
        return 0.0
    for _ in range(DOUBLINGS):
        if of(high):
            break
        low, high = high, 2.0 * high
    else:
        return math.inf
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if of(middle) else (middle, high)
    return low


def _thrusts(scene: Scene, sim: Sim, out: CommandOutput, name: str) -> bool:
    """A table of the loads at the rig and at the bit by depth; whether there is one."""
    string = scene.names[name]
    try:
        depths = depths_of(sim, string, str(DEPTHS))
    except Error as error:
        out.say(f"{name}, thrust of buckling: not assessed, because the soft string needs a hole: "
                f"{out.units.sentence(error.message)}")
        return False
    rows = []
    for depth in depths:
        if math.isnan(_row(sim, string, depth, 1e3).helical_share):
            out.say(f"{name}, thrust of buckling: not assessed, because at {out.units.text(depth, 'm')} a compressed "
                    "part is not pressed to the wall")
            return False
        weights = [first_weight(lambda weight: _beyond(_row(sim, string, depth, weight), field))
                   for field in ("sinusoidal_share", "helical_share", "")]
        rows.append([depth, *(value for weight in weights[:2] for value in (-_row(sim, string, depth, weight).hook_load,
                                                                            weight)), weights[2]])
    heads = ["depth [m]", "sinusoidal buckling: thrust at the rig [N]", "sinusoidal buckling: weight on bit [N]",
             "helical buckling: thrust at the rig [N]", "helical buckling: weight on bit [N]",
             "lock-up: weight on bit [N]"]
    out.table(f"buckling_thrust_{file_name(name)}.csv", heads, rows)
    out.summary.setdefault("buckling_thrust", {})[name] = {
        "depth_m": depths, "sinusoidal_thrust_N": [row[1] for row in rows],
        "helical_thrust_N": [row[3] for row in rows],
        "lock_up_weight_on_bit_N": [row[5] for row in rows]}
    units = out.units
    for row in rows:
        out.say(f"{name} at {units.text(row[0], 'm')}, pushed without rotation: sinusoidal buckling "
                f"{_thrust(row[1], units)}, "
                   f"helical {_thrust(row[3], units)}, locks up at {units.text(row[5] / 1e3, 'kN')} on the bit")
    return True


def _beyond(row: TorqueDragRow, field: str) -> bool:
    return bool(row.locked) or (bool(field) and not getattr(row, field) < 1.0)


def _thrust(value: float, units: Units) -> str:
    return f"from a thrust of {units.text(value / 1e3, 'kN')}" if value >= 0.0 else \
        f"from a hook load below {units.text(-value / 1e3, 'kN')}"
