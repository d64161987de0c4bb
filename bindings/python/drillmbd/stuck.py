"""A string whose far end is stuck: pull, push and torque of the rig that arrive there, and how deep it is free."""
from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from . import enums
from ._structs import TorqueDragRow
from .analysis import usual_operation
from .results import CommandOutput, friction_option, percent, quantity
from .errors import Usage
from .model import _DEFINITIONS
from .scene import Scene
from .sim import Sim


MOST = 1e12     #: [N, N m] a limit that no rig has
TOO_LONG = 1.2  #: measured stretch over that of the free string, up to which tolerances of pipes may explain it


def _solve(of: Callable[[float], float], size: float) -> float:
    """[N] The zero of a rising function, by bisection. size: about that of the zero; the interval is widened until it
    contains it, because the weight that a pull lifts off the wall rubs no more, and more may arrive than leaves the
    rig."""
    low, high = -size, size
    while of(low) > 0.0 and low > -MOST:
        low *= 2.0
    while of(high) < 0.0 and high < MOST:
        high *= 2.0
    for _ in range(80):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if of(middle) < 0.0 else (low, middle)
    return 0.5 * (low + high)


def _row(sim: Sim, string: Any, kind: int, weight: float, **more: Any) -> TorqueDragRow:
    return sim.torque_drag([usual_operation(kind, weight_on_bit=weight)], string=string, **more).rows[0][0]


def pull_at_bit(sim: Sim, string: Any, hook_load: float, **more: Any) -> tuple[float, TorqueDragRow]:
    """[N] effective tension at the far end when the rig pulls with hook_load [N], friction against it; and the row."""
    free = _row(sim, string, enums.OPERATION_PICK_UP, 0.0, **more).hook_load
    force = _solve(lambda pull: _row(sim, string, enums.OPERATION_PICK_UP, -pull, **more).hook_load - hook_load,
                   abs(hook_load) + abs(free) + 1.0)
    return force, _row(sim, string, enums.OPERATION_PICK_UP, -force, **more)


def push_at_bit(sim: Sim, string: Any, thrust: float, **more: Any) -> tuple[float, TorqueDragRow]:
    """[N] compression at the far end when the rig pushes with thrust [N]; less than thrust where it locks up."""
    def too_much(push: float) -> float:
        row = _row(sim, string, enums.OPERATION_SLACK_OFF, push, **more)
        return math.inf if row.locked else -row.hook_load - thrust
    free = abs(_row(sim, string, enums.OPERATION_PICK_UP, 0.0, **more).hook_load)
    force = _solve(too_much, thrust + free + 1.0)
    return force, _row(sim, string, enums.OPERATION_SLACK_OFF, force - 1e-9 * (abs(force) + 1.0), **more)


def free_length(scene: Scene, string: Any, pull: float, stretch: float) -> tuple[float | None, float]:
    """[m] from the rig end that lengthens by stretch [m] under pull [N] more (Hooke, pipe by pipe, friction left out);
    None where the whole string lengthens by less: it is free. And [m] by which the string lengthens up to there."""
    length = reached = 0.0
    for name, arguments in scene.model.calls:
        if name != "add_pipes" or arguments[1].get("string") != string:
            continue
        pipe = _DEFINITIONS["add_pipes"](**arguments[1])
        area = math.pi / 4.0 * (pipe.outer_diameter ** 2 - pipe.inner_diameter ** 2)
        stiffness = pipe.section_stiffness[0] or pipe.young_modulus * area
        run = arguments[0] * pipe.length
        soft = (pipe.length - pipe.joint_length) / pipe.length  # tool joints are rigid
        part = pull * soft * run / stiffness
        if part >= stretch - reached:
            return float(length + run * (stretch - reached) / part), stretch
        reached += part
        length += run
    return None, reached


def stuck(scene: Scene, out: CommandOutput, options: Any) -> int:
    """Force and torque that arrive at a stuck far end, and how far the string is free by its stretch."""
    limits = {name: quantity(text, unit, f"--{name}") if text is not None else scene.limits.get(name)
              for name, text, unit in (("pull", options.pull, "N"), ("push", options.push, "N"),
                                       ("torque", options.torque, "N*m"))}
    for name, limit in limits.items():
        if limit is not None and not 0.0 < limit <= MOST:
            raise Usage(f"--{name} {getattr(options, name)}: must be > 0 and at most {MOST:g} in SI units")
    if not scene.pipes:
        raise Usage("stuck is about a string, the scene has none")
    if (options.overpull is None) != (options.stretch is None):
        raise Usage("--overpull and --stretch belong together")
    more: dict[str, Any] = friction_option(options)
    first, *others = scene.pipes
    string = scene.names[first]
    if others:
        out.note_text(f"stuck is about the string {first}; {', '.join(others)}: not assessed")
    result: dict[str, Any] = {}
    units = out.units
    with scene.new_sim() as sim:
        for name, compute in (("pull", pull_at_bit), ("push", push_at_bit)):
            limit = limits[name]
            if limit is None:
                out.say(f"{name}: no limit in the scene; give --{name}")
                continue
            force, row = compute(sim, string, limit, **more)
            if not force > 0.0:
                result[name] = {"at_rig_N": limit, "at_bit_N": 0.0}
                out.say(f"{name} of {units.text(limit / 1e3, 'kN')} at the rig: nothing arrives, weight and friction "
                        "take it all")
                continue
            result[name] = {"at_rig_N": limit, "at_bit_N": force, "helical_share": row.helical_share,
                          "yield_share": None if math.isnan(row.yield_share) else row.yield_share}
            out.say(f"{name} of {units.text(limit / 1e3, 'kN')} at the rig: {units.text(force / 1e3, 'kN')} at the far "
                    "end, "
                    + (f"{row.helical_share:.2g} of helical buckling" if math.isfinite(row.helical_share) else
                       "buckling not assessed")
                    + (f", stress {percent(row.yield_share)} of the yield strength" if math.isfinite(row.yield_share)
                       else ""))
        torque = limits["torque"]
        if torque is None:
            out.say("torque: no limit in the scene; give --torque")
        else:
            lost = _row(sim, string, enums.OPERATION_ROTATE, 0.0, **more).torque
            result["torque"] = {"at_rig_N_m": torque, "at_bit_N_m": max(0.0, torque - lost)}
            out.say(f"torque of {units.text(torque, 'N m')} at the rig: {units.text(max(0.0, torque - lost), 'N m')} "
                    "at the far end")
    if options.stretch is not None:
        pull, by = quantity(options.overpull, "N", "--overpull"), quantity(options.stretch, "m", "--stretch")
        if not pull > 0.0 or not by > 0.0:
            raise Usage("--overpull and --stretch must be > 0")
        length, reached = free_length(scene, string, pull, by)
        result["free_length_m"] = length
        out.say(f"free as far as the string goes: it would lengthen by {units.text(1e3 * reached, 'mm')}, which is less"
                if length is None else f"free down to {units.text(length, 'm')} from the rig end, friction left out")
        if by > TOO_LONG * reached:
            out.note_text(f"the stretch of {units.text(1e3 * by, 'mm')} is more than a pull of "
                          f"{units.text(pull / 1e3, 'kN')} lengthens the free string, which friction makes even less; "
                          "check --stretch and --overpull")
    out.summary["stuck"] = result
    return out.finish()
