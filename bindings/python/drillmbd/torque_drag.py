"""Hook load and torque of the rig by depth and operation, as a soft string, and the broomstick picture over friction
coefficients."""
from __future__ import annotations

import math
import re
from ctypes import c_double
from dataclasses import dataclass, field
from typing import Any

from . import broomstick, enums, hydraulics, measured, rig_limits, section_fit
from ._structs import Operation, TorqueDragOptions, TorqueDragRow
from .analysis import OPERATIONS, TorqueDrag, operation_name
from .results import RPM, CommandOutput, file_name, finite, friction_option, key_of, percent, quantity
from .errors import Error, Usage
from .operating import BIT_FRICTION, Operating, operating, operations_of, with_weight
from .profile import values_of
from .scene import Scene
from .sim import Sim
from .unit_systems import SI, Units

MOST_DEPTHS, MOST_FRICTIONS = 2 ** 20, 20
FIELDS = {name: unit for name, (unit, _) in TorqueDragRow.field_docs.items()
          if name not in ("struct_size", "reserved", "depth", "locked")}
WORDS = {int(kind): operation_name(kind) for kind in OPERATIONS}


@dataclass
class Settings:
    """Of the command line and the scene."""
    plan: Operating
    operations: list[Operation]
    block_weight: float                                    #: [N]
    more: dict[str, Any]                                   #: options of the analysis: friction
    frictions: list[float] = field(default_factory=list)   #: of the broomstick; empty: by the wall
    notes: list[str] = field(default_factory=list)         #: origins of the values
    series: dict[str, measured.Series] = field(default_factory=dict)  #: measured at the rig, of the first string


@dataclass
class Curves:
    """Of one string in its hole."""
    name: str
    string: Any
    found: TorqueDrag
    block_weight: float

    def hook_load(self, row: TorqueDragRow) -> float:
        """[N] with block and top drive."""
        return float(row.hook_load) + self.block_weight


def torque_drag(scene: Scene, out: CommandOutput, options: Any) -> int:
    """All results of the soft string by depth and operation."""
    if not scene.pipes:
        raise Usage("torque-drag is about a string, the scene has none")
    every = settings_of_strings(scene, options, out)
    first = every[next(iter(every))]
    out.summary["block_weight_N"], out.summary["operations"] = first.block_weight, _summary_of(first)
    if len(every) > 1:
        out.summary["operations_by_string"] = {name: _summary_of(one) for name, one in every.items()}
    if options.measured is not None:
        first.series, remarks = measured.read(options.measured)
        for text in remarks:
            out.note_text(f"{options.measured}: {text}")
    with scene.new_sim() as sim:
        for name, settings in every.items():
            string = scene.names[name]
            depths = depths_of(sim, string, options.depths, out.units)
            found = sim.torque_drag(settings.operations, depths, string=string, **settings.more)
            curves = Curves(name, string, found, settings.block_weight)
            _write_rows(sim, out, curves, settings)
            loads = [rig_limits.loads_at(rows, list(WORDS.values()), settings.block_weight) for rows in found.rows]
            rig_limits.write(out, name, found.column("depth"), loads, scene.limits, settings.plan)
            trip_speed = abs(settings.operations[int(enums.OPERATION_PICK_UP)].axial_speed)
            hydraulics.write(sim, out, name, found.column("depth"), trip_speed)
            _compare(scene, sim, out, curves, settings)
            broomstick.write(scene, sim, out, curves, settings)
    return out.finish()


def _summary_of(settings: Settings) -> dict[str, dict[str, float]]:
    return {word: {"weight_on_bit_N": one.weight_on_bit, "torque_on_bit_N_m": one.torque_on_bit,
                   "rotary_speed_rad_s": one.rotary_speed, "axial_speed_m_s": one.axial_speed}
            for word, one in zip(WORDS.values(), settings.operations)}


# ---- Settings --------------------------------------------------------------------------------------------------------
def settings_of_strings(scene: Scene, options: Any, out: CommandOutput) -> dict[str, Settings]:
    """Of each string by its name, from its own drives and bit; their origins are printed."""
    every = {name: settings_of(scene, options, out.units, number) for number, name in enumerate(scene.pipes)}
    for name, one in every.items():
        for text in one.notes:
            out.say(text if len(every) == 1 else f"{name}: {text}")
    return every


def settings_of(scene: Scene, options: Any, units: Units, string: int) -> Settings:
    """Of a string by its number."""
    plan, notes = operating(scene, string), []
    if options.weight_on_bit is not None:
        plan = with_weight(scene, plan, _not_below_0(options.weight_on_bit, "N", "--weight-on-bit"), string)
        notes.append(f"weight on bit {units.scaled(plan.weight_on_bit or 0.0, 'N')}, as given")
    elif plan.weight_on_bit:
        notes.append(f"weight on bit {units.scaled(plan.weight_on_bit, 'N')}, the largest load of the bit in the scene")
    else:
        notes.append(f"weight on bit 0 {units.unit('N')}, because the scene gives the bit no load; give "
                     "--weight-on-bit")
    if options.torque_on_bit is not None:
        plan.torque_on_bit, plan.estimated = _not_below_0(options.torque_on_bit, "N*m", "--torque-on-bit"), False
        notes.append(f"torque on bit {units.scaled(plan.torque_on_bit, 'N m')}, as given")
    elif plan.estimated:
        notes.append(f"torque on bit {units.scaled(plan.torque_on_bit, 'N m')}, estimated: {BIT_FRICTION:g} x weight "
                     "on bit x bit diameter / 3")
    elif plan.weight_on_bit:
        notes.append(f"torque on bit 0 {units.unit('N m')}: it is not estimated for a bit with a rock law or without a "
                     "diameter; give --torque-on-bit")
    block = _not_below_0(options.block_weight, "N", "--block-weight") if options.block_weight is not None else 0.0
    if block:
        notes.append(f"hook loads include {units.scaled(block, 'N')} of block and top drive")
    operations = operations_of(plan)
    drill = operations[enums.OPERATION_DRILL]
    notes.append(f"drilling at {units.text(drill.rotary_speed / RPM, 'rpm')} and "
                 f"{units.text(1e3 * drill.axial_speed, 'mm/s')}"
                 + ("" if plan.rotation and plan.feed else " (usual values where the scene gives none)"))
    return Settings(plan, operations, block, friction_option(options), _frictions(getattr(options, "frictions", None)),
                    ["; ".join(notes)])


def _not_below_0(text: str, unit: str, option: str) -> float:
    found = quantity(text, unit, option)
    if found < 0.0:
        raise Usage(f"{option} {text}: must be >= 0")
    return found


def _frictions(text: str | None) -> list[float]:
    if text is None:
        return []
    found = []
    for one in text.split(","):
        try:
            found.append(float(one))
        except ValueError:
            raise Usage(f"--frictions {text}: {one.strip()!r} is no number; give coefficients as 0.2,0.3,0.4") from None
        if not 0.0 <= found[-1] <= 10.0:
            raise Usage(f"--frictions {text}: {one.strip()} is outside 0 .. 10")
    if len(found) > MOST_FRICTIONS:
        raise Usage(f"--frictions: {len(found)} coefficients, at most {MOST_FRICTIONS} are allowed")
    return sorted(set(found))


def depths_of(sim: Sim, string: Any, text: str, units: Units = SI) -> list[float]:
    """[m] Depths of the bit: a number of them up to the described one, or a list."""
    first, last = _range(sim, string)
    if re.fullmatch(r"\s*[-+]?[0-9]+\s*", text):
        count = int(text)
        if not 1 <= count <= MOST_DEPTHS:
            raise Usage(f"--depths {count} is outside 1 .. {MOST_DEPTHS}; it is a number of depths, depths have units, "
                        "as \"100 m,200 m\"")
        return [first + (last - first) * (i + 1) / count for i in range(count)]
    found = sorted({quantity(one.strip(), "m", "--depths") for one in text.split(",")})
    for depth in found:
        _check_depth("--depths", depth, (first, last), units)
    return [min(depth, last) for depth in found]


def _range(sim: Sim, string: Any) -> tuple[float, float]:
    """[m] Measured depths of the two ends."""
    last = float(sim.torque_drag([enums.OPERATION_ROTATE], string=string).rows[0][0].depth)
    return last - float(values_of(sim, string, [enums.PROFILE_DISTANCE], count=2)[1, 0]), last


def _check_depth(option: str, depth: float, ends: tuple[float, float], units: Units) -> None:
    first, last = ends
    if not first < depth <= last + 1e-9 * abs(last):
        raise Usage(f"{option}: {units.text(depth, 'm', 'g')} must be above {units.text(first, 'm', 'g')}, where the "
                    "string begins, and at most "
                    f"{units.text(last, 'm', 'g')}, where it ends in the scene")


def _compare(scene: Scene, sim: Sim, out: CommandOutput, curves: Curves, settings: Settings) -> None:
    """The measurements against this string; those beyond it are refused."""
    if not settings.series:
        return
    first, last = _range(sim, curves.string)
    for one in settings.series.values():
        for depth in one.depths:
            _check_depth("--measured", depth, (first, last), out.units)
    friction = settings.more.get("friction")
    if friction is None:
        friction = broomstick.wall_friction(scene, first, last)
    values = broomstick.wall_frictions(scene, first, last)
    if max(values) - min(values) > 1e-9:
        out.say(f"{curves.name}, measured: first one coefficient for all sections of the hole, then one for each "
                "section")
    measured.compare(sim, curves.string, curves.name, out, settings.series, settings.operations, settings.block_weight,
                     friction)
    section_fit.compare(scene, curves.name, out, settings.series, settings.operations, settings.block_weight)


# ---- Rows ------------------------------------------------------------------------------------------------------------
def _values(curves: Curves, row: TorqueDragRow) -> list[float]:
    return [curves.hook_load(row) if name == "hook_load" else float(getattr(row, name)) for name in FIELDS]


def _write_rows(sim: Sim, out: CommandOutput, curves: Curves, settings: Settings) -> None:
    found, result = curves.found, {}
    for kind, row in zip(WORDS, found.rows[-1]):
        neutral = _neutral_point(sim, curves, settings, kind, float(row.depth))
        out.say(f"{curves.name}, {WORDS[kind]} at {out.units.text(row.depth, 'm')}: "
                f"{_sentence(curves, row, neutral, out.units)}")
        result[WORDS[kind]] = {"depth_m": row.depth, "locked": bool(row.locked), "neutral_point_m": neutral,
                             **{key_of(name, FIELDS[name]): finite(value)
                                for name, value in zip(FIELDS, _values(curves, row))}}
    if any(not row.locked and not math.isfinite(row.yield_share) for row in found.rows[-1]):
        out.say(f"{curves.name}, stress: not assessed, because not all pipes have a yield_strength; give it in "
                "[[string.pipes]]"
                + (" (yield_stress of [limits] is compared by report and probability)"
                   if "yield_stress" in out.scene.limits else ""))
    out.summary.setdefault("torque_drag", {})[curves.name] = result
    out.summary.setdefault("torque_drag_by_depth", {})[curves.name] = {
        word: {"depth_m": found.column("depth", number),
               "locked": [bool(one) for one in found.column("locked", number)],
               **{key_of(name, FIELDS[name]): list(column)
                  for name, column in zip(FIELDS, zip(*(_values(curves, rows[number]) for rows in found.rows)))}}
        for number, word in WORDS.items()}
    heads = ["depth [m]", "operation", "locked", *(f"{name.replace('_', ' ')} [{unit or '-'}]"
                                                   for name, unit in FIELDS.items())]
    out.table(f"torque_drag_{file_name(curves.name)}.csv", heads,
                 [[row.depth, word, row.locked, *_values(curves, row)]
                  for number, word in WORDS.items() for row in (rows[number] for rows in found.rows)])
    out.picture(f"torque_drag_{file_name(curves.name)}.png",
                   lambda plots: plots.torque_drag(found, list(WORDS.values()), curves.name, curves.block_weight,
                                                   out.units))


def _sentence(curves: Curves, row: TorqueDragRow, neutral: float | None, units: Units) -> str:
    if row.locked:
        return "locks up: no thrust at the rig moves the string"
    load = curves.hook_load(row)
    parts = [f"hook load {units.text(load / 1e3, 'kN')}" if load >= 0.0 else f"thrust {units.text(-load / 1e3, 'kN')}",
             f"torque {units.text(row.torque, 'N m')}",
             f"{100.0 * row.transfer:.0f} % of a small increase of thrust arrives at the bit"]
    if row.lowest_force < 0.0:
        parts.append(f"largest compression {units.text(-row.lowest_force / 1e3, 'kN')} at "
                     f"{units.text(row.lowest_at, 'm')}, "
                     + (f"{percent(row.helical_share)} of the helical buckling load at "
                        f"{units.text(row.buckled_at, 'm')}"
                        if math.isfinite(row.helical_share)
                        else "buckling not assessed, because a compressed part is not pressed to the wall"))
    if neutral is not None:
        parts.append(f"neutral point at {units.text(neutral, 'm')}")
    if row.helix_length > 0.0:
        parts.append(f"{units.text(row.helix_length, 'm')} of helix")
    if math.isfinite(row.yield_share):
        parts.append(f"stress {percent(row.yield_share)} of the yield strength at {units.text(row.yield_at, 'm')}")
    stretch = (units.text(row.stretch, "m", ".3g") if abs(row.stretch) >= 1.0
               else units.text(1e3 * row.stretch, "mm", ".3g"))
    parts.append(f"stretch {stretch}, wind-up {math.degrees(row.wind_up):.3g} deg, wall force "
                 f"{units.text(row.wall_force / 1e3, 'kN', '.3g')}")
    return ", ".join(parts)


def _neutral_point(sim: Sim, curves: Curves, settings: Settings, kind: int, depth: float) -> float | None:
    """[m] The shallowest depth where the effective axial force changes its sign; None if it does not."""
    options = TorqueDragOptions(string=curves.string, depth_count=1, **settings.more)
    options.depths = (c_double * 1)(depth)
    try:
        along = sim.torque_drag_profile(settings.operations[kind], 201, options)
    except Error:
        return None  # it locks up
    places = list(zip(along["depth"], along["axial_force"]))
    for (above, first), (below, second) in zip(places, places[1:]):
        if first * second < 0.0:
            return float(above + (below - above) * first / (first - second))
    return None
