"""Thrust, pull and torque of all operations by depth against the limits of the rig: how far it reaches with the
string."""
from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from .results import CommandOutput, file_name
from .operating import Operating
from .unit_systems import Units
from .verdict import shown

#: key of [limits], word, unit
QUANTITIES = (("push", "thrust", "N"), ("pull", "pull", "N"), ("torque", "torque", "N m"))
NOT_ASSESSED = "not assessed, because the scene has no [limits]"
LOCKED = "lock-up"


@dataclass
class Load:
    """The largest load of one kind at one depth."""
    value: float       #: N, N m; infinite where the string locks up
    operation: str     #: that causes it; "" where the load is 0

    def share(self, limit: float | None) -> float:
        """Of the limit; NaN without one."""
        return self.value / limit if limit else math.nan


@dataclass
class Reach:
    """The shallowest depth at which a load is at its limit."""
    depth: float
    word: str          #: thrust, pull, torque or LOCKED
    operation: str


def loads_at(rows: Sequence[Any], words: Sequence[str], block_weight: float) -> dict[str, Load]:
    """By key of [limits], the largest load over the operations of one depth."""
    found = {key: Load(0.0, "") for key, _, _ in QUANTITIES}
    for word, row in zip(words, rows):
        hook_load = row.hook_load + block_weight
        values = {"push": math.inf, "torque": 0.0, "pull": 0.0} if row.locked else {
            "push": -hook_load, "pull": hook_load, "torque": row.torque}
        for key, value in values.items():
            if value > found[key].value:
                found[key] = Load(value, word)
    return found


def reach(depths: Sequence[float], table: Sequence[dict[str, Load]], limits: dict[str, float]) -> Reach | None:
    """The first limit by rising depth, by straight lines between the depths; None if all loads stay below their
    limits."""
    found: list[Reach] = []
    for key, word, _ in QUANTITIES:
        limit = limits.get(key, math.inf)
        for number, loads in enumerate(table):
            load = loads[key]
            if load.value <= limit and not math.isinf(load.value):
                continue
            before = table[number - 1][key].value if number else load.value
            depth = depths[number]
            if number and math.isfinite(load.value):
                depth = depths[number - 1] + (depth - depths[number - 1]) * (limit - before) / (load.value - before)
            found.append(Reach(depth, LOCKED if math.isinf(load.value) else word, load.operation))
            break
    return min(found, key=lambda one: one.depth) if found else None


def unknown(plan: Operating, limits: Iterable[str]) -> str:
    """The limits that cannot be assessed because a load of drilling is missing, with the reason; "" where none is."""
    given = set(limits) - {"pull"}
    if given and plan.cuts:
        return ("drilling is not assessed, because a rock law gives load and torque of the bit in a run only; give "
                "--weight-on-bit and --torque-on-bit")
    if given and not plan.weight_on_bit:
        return "drilling is not assessed, because no load on the bit is given; give load in [[bit]], or --weight-on-bit"
    if given - {"push"} and not plan.torque_on_bit:
        return ("the torque of drilling is not assessed, because that of the bit is neither given nor estimated; give "
                "--torque-on-bit")
    return ""


def write(out: CommandOutput, name: str, depths: Sequence[float], table: Sequence[dict[str, Load]],
          limits: dict[str, float], plan: Operating) -> None:
    """The table, its last row, and the depth that the rig reaches with this string."""
    given = {key: limits[key] for key, _, _ in QUANTITIES if key in limits}
    if not given:
        out.say(f"{name}, limits of the rig: " + (NOT_ASSESSED if not limits
                                                  else NOT_ASSESSED + " of thrust, pull or torque"))
        out.summary.setdefault("rig_limits", {})[name] = None
        return
    first = reach(depths, table, given)
    out.say(f"{name}, limits of the rig: {_text(depths, table, given, first, out.units)}")
    missing = unknown(plan, given)
    if missing:
        out.say(f"{name}, {missing}")
    for key, word, _ in QUANTITIES:
        if key not in given:
            out.say(f"{name}, {word}: not assessed, because [limits] has no {key}")
    heads = ["depth [m]"]
    for _, word, unit in QUANTITIES:
        heads += [f"{word} [{unit}]", f"{word}: operation", f"{word}: share of the limit [-]"]
    out.table(f"rig_limits_{file_name(name)}.csv", heads, [
        [depth, *(cell for key, _, _ in QUANTITIES for cell in (loads[key].value, loads[key].operation,
                                                                loads[key].share(given.get(key))))]
        for depth, loads in zip(depths, table)])
    out.summary.setdefault("rig_limits", {})[name] = {
        "reach_m": first.depth if first and first.depth > depths[0] else None, "first_limit": first.word if first
        else None,
        "assessed_to_m": depths[-1], "drilling_assessed": not missing,
        "share": {key: max(loads[key].share(limit) for loads in table) for key, limit in given.items()}}


def _text(depths: Sequence[float], table: Sequence[dict[str, Load]], given: dict[str, float], first: Reach | None,
          units: Units) -> str:
    if first is not None and first.depth <= depths[0]:
        return (f"exceeded at {units.text(depths[0], 'm')}, the first depth: {_cause(first)}; choose smaller --depths "
                "to find the reach")
    if first is not None:
        return f"this rig reaches {units.text(first.depth, 'm')}: {_cause(first)}"
    shares = {word: max(((loads[key].share(given[key]), depth, loads[key]) for depth, loads in zip(depths, table)),
                        key=lambda one: one[0])
              for key, word, _ in QUANTITIES if key in given}
    texts = [f"{word} {shown(load.value, 'N m' if word == 'torque' else 'N', units)}, {100.0 * share:.0f} % of the "
             "limit"
             + (f" ({load.operation} at {units.text(depth, 'm')})" if load.operation else "")
             for word, (share, depth, load) in shares.items()]
    return f"not reached down to {units.text(depths[-1], 'm')}: " + "; ".join(texts)


def _cause(first: Reach) -> str:
    if first.word == LOCKED:
        return f"the string locks up ({first.operation}), no thrust moves it"
    return f"{first.word} ({first.operation})"
