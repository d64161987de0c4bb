"""Rods added one by one at the rig: thrust, pull, torque and the torque that the joint just made up carries, for each
number of rods. The engine is that of torque-drag, the soft string of the rods that are in the hole, at the depth that
they reach."""
from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from .results import CommandOutput, file_name, quantity
from .errors import Usage
from .remade import number_of
from .rig_limits import QUANTITIES, Load, loads_at, unknown
from .scene import Scene
from .torque_drag import WORDS, depths_of, settings_of_strings
from .unit_systems import Units
from .verdict import NEAR, NEAR_SHARE, NO_LIMIT, NOT_ASSESSED, OK, OVER

MOST_LINES = 12  #: on the terminal; all are in the table
MAKE_UP = "make_up"
NOT_GIVEN = "make-up torque: not assessed, because none is given; give that of the rods, as --make-up \"2 kN m\""


@dataclass
class Row:
    """Loads of one number of rods."""
    rods: int
    depth: float             #: [m] of the bit
    loads: dict[str, Load]   #: by key of [limits]; the largest of all operations
    unknown: str = ""        #: limits that are not assessed, with the reason

    @property
    def make_up(self) -> float:
        """[N m] The largest torque at the rig, where the last joint is: it is made up with more, or turns on in the
        hole."""
        return self.loads["torque"].value

    @property
    def locked(self) -> bool:
        """Whether no thrust moves the string in one of the operations."""
        return math.isinf(self.loads["push"].value)

    def share(self, limits: dict[str, float]) -> float:
        """The largest share of a limit; infinite where the string locks up, NaN without limits."""
        if self.locked:
            return math.inf
        found = [self.make_up / limit if key == MAKE_UP else self.loads[key].share(limit)
                 for key, limit in limits.items()]
        return max(found, default=math.nan)

    def verdict(self, limits: dict[str, float]) -> str:
        """On all limits together."""
        share = self.share(limits)
        if not limits and not self.locked:
            return NO_LIMIT
        return OVER if share > 1.0 else NEAR if share > NEAR_SHARE else NOT_ASSESSED if self.unknown else OK


def rod_by_rod(scene: Scene, out: CommandOutput, options: Any) -> int:
    """Loads for each number of rods of each string."""
    every = settings_of_strings(scene, options, out)
    limits = {key: scene.limits[key] for key, _, _ in QUANTITIES if key in scene.limits}
    if options.make_up is not None:
        limits[MAKE_UP] = quantity(options.make_up, "N*m", "--make-up")
        if not limits[MAKE_UP] > 0.0:
            raise Usage(f"--make-up {options.make_up}: must be > 0")
    out.say("engine: the soft string of torque-drag, without bending stiffness and vibration; the last rods of the "
            "scene go into the hole first")
    out.summary["rod_by_rod"] = {}
    with scene.new_sim() as sim:
        for name, settings in every.items():
            string = scene.names[name]
            last = depths_of(sim, string, "1")[0]
            depths = depths_of_rods(lengths_of(scene, string), last)
            found = sim.torque_drag(settings.operations, depths, string=string, **settings.more)
            rows = [Row(number + 1, depth, loads_at(one, list(WORDS.values()), settings.block_weight),
                        unknown(settings.plan, limits))
                    for number, (depth, one) in enumerate(zip(depths, found.rows))]
            _write(out, name, rows, limits)
    return out.finish()


def lengths_of(scene: Scene, string: Any) -> list[float]:
    """[m] of the rods of a string, from the rig end on."""
    from ._structs import PipeDef
    found: list[float] = []
    for name, arguments in scene.model.calls:
        if (name == "add_pipes" and arguments[1].get("string")
            and number_of(arguments[1]["string"]) == number_of(string)):
            found += [float(arguments[1].get("length", PipeDef().length))] * int(arguments[0])
    return found


def depths_of_rods(lengths: list[float], last: float) -> list[float]:
    """[m] Depths of the bit with one rod, two, ... and all of them, at the last depth. The rods at the bit are the
    first ones in."""
    below, found = 0.0, []
    begin = last - sum(lengths)
    for length in reversed(lengths):
        below += length
        found.append(begin + below)
    found[-1] = last
    return found


# ---- Results ---------------------------------------------------------------------------------------------------------
def _write(out: CommandOutput, name: str, rows: list[Row], limits: dict[str, float]) -> None:
    units = out.units
    listed = sorted({round(i * (len(rows) - 1) / (MOST_LINES - 1)) for i in range(MOST_LINES)})
    for row in (rows[i] for i in listed):
        out.say(f"  {name}, {row.rods:4d} {'rod' if row.rods == 1 else 'rods'}, bit at {units.text(row.depth, 'm')}: "
                f"{_loads(row, units)}, {row.verdict(limits)}")
    out.say(f"{name}: {_reach(rows, limits, units)}")
    if rows[0].unknown:
        out.say(f"{name}, {rows[0].unknown}")
    if MAKE_UP not in limits:
        out.say(f"{name}, {NOT_GIVEN}")
    for key, word, _ in QUANTITIES:
        if key not in limits:
            out.say(f"{name}, {word}: not assessed, because [limits] has no {key}")
    out.table(f"rods_{file_name(name)}.csv", heads(limits), [
        [row.rods, row.depth,
         *(cell for key, _, _ in QUANTITIES for cell in (row.loads[key].value, row.loads[key].operation)), row.make_up,
         row.share(limits), row.verdict(limits)] for row in rows])
    out.summary["rod_by_rod"][name] = {
        "rods_within_limits": within(rows, limits), "limits": dict(limits), "rods": [
            {"rods": row.rods, "depth_m": row.depth, "push_N": row.loads["push"].value,
             "pull_N": row.loads["pull"].value,
             "torque_N_m": row.loads["torque"].value, "make_up_above_N_m": row.make_up, "share": row.share(limits),
             "verdict": row.verdict(limits)}
            for row in rows]}
    out.picture(f"rods_{file_name(name)}.png", lambda plots: plots.rods(rows, limits, name, units))


def heads(limits: dict[str, float]) -> list[str]:
    """Of the columns of the table."""
    found = ["rods", "depth of the bit [m]"]
    for _, word, unit in QUANTITIES:
        found += [f"{word} [{unit}]", f"{word}: operation"]
    return [*found, "make-up torque above [N m]", "largest share of a limit [-]", "verdict"]


def within(rows: list[Row], limits: dict[str, float]) -> int | None:
    """The number of rods up to which no limit is exceeded and nothing locks up at a smaller depth; None without limits
    or lock-up."""
    over = next((row.rods for row in rows if row.share(limits) > 1.0), None)
    return over - 1 if over is not None else rows[-1].rods if limits else None


def _loads(row: Row, units: Units) -> str:
    parts = []
    for key, word, unit in QUANTITIES:
        load = row.loads[key]
        if math.isinf(load.value):
            return f"the string locks up ({load.operation}), no thrust moves it"  # push is the first one
        parts.append(f"{word} {units.scaled(load.value, unit)}" + (f" ({load.operation})" if load.operation else ""))
    return ", ".join([*parts, f"make-up above {units.scaled(row.make_up, 'N m')}"])


def _reach(rows: list[Row], limits: dict[str, float], units: Units) -> str:
    count = within(rows, limits)
    if count is None:
        return "number of rods within limits: not assessed, because neither [limits] nor --make-up is given"
    if count == len(rows):
        return (f"all {count} rods stay within the given limits, {100.0 * max(row.share(limits) for row in rows):.0f} "
                "% of them at most")
    causes = [word for key, word in (*((key, word) for key, word, _ in QUANTITIES), (MAKE_UP, "make-up torque"))
              if key in limits and (rows[count].make_up if key == MAKE_UP else rows[count].loads[key].value)
              > limits[key]]
    if rows[count].locked:
        return (f"{count} rods stay within the given limits; with rod {count + 1} the string locks up "
                f"({rows[count].loads['push'].operation}), no thrust "
                "moves it")
    depth = f", bit at {units.text(rows[count - 1].depth, 'm')}" if count else ""
    return f"{count} rods stay within the given limits{depth}; rod {count + 1} exceeds {' and '.join(causes)}"
