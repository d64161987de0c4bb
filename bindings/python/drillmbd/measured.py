"""Hook loads and torques measured at the rig: read from a table, compared with the soft string, and the friction
coefficient that fits them by operation, with its confidence interval."""
from __future__ import annotations

import math
import pathlib
from ctypes import c_double
from dataclasses import dataclass, field
from typing import Any

from . import enums
from ._optional import need
from ._structs import Operation, TorqueDragOptions
from .results import CommandOutput, file_name
from .errors import Error, Usage
from .scene import columns, table_file
from .scene.columns import Column
from .scene.survey import COLUMNS as SURVEY_COLUMNS
from .sim import Sim
from .unit_systems import Units

COLUMNS = (
    Column("depth", "m", SURVEY_COLUMNS[0].names + ("bit depth", "bit md", "depth of bit", "depth bit")),
    Column("pick-up", "N", ("pick up", "pickup", "pick up load", "pick up weight", "pick up hook load",
                            "hook load pick up", "pu", "puw", "pu weight",
                            "p u", "trip out", "pull out", "poh", "pooh", "上提"), "", False, True),
    Column("slack-off", "N", ("slack off", "slackoff", "slack off load", "slack off weight", "slack off hook load",
                              "hook load slack off", "so",
                              "sow", "so weight", "s o", "trip in", "run in", "rih", "下放"), "", False, True),
    Column("rotate", "N", ("rotate", "rotating", "rotate load", "rotating weight", "rotate hook load",
                           "hook load rotate", "rotating off bottom",
                           "rot", "rotw", "rob", "free rotating", "free rotating weight", "空转"), "", False, True),
    Column("torque", "N m", ("torque", "torque rotate", "rotate torque", "rotating torque", "off bottom torque",
                             "surface torque",
                             "rotary torque", "tq", "tor", "trq", "扭矩"), "", False, True),
    Column("hook load", "N", ("hook load", "hookload", "hkld", "hkl", "hook load measured", "measured hook load",
                              "大钩载荷"), "", False, True),
    Column("operation", "", ("operation", "op", "mode", "activity", "工况"), "", False))
ADVICE = "give the heads in the file, as \"depth [m], pick_up [kN], slack_off [kN], rotate [kN], torque [kN m]\""
KINDS = {"pick-up": enums.OPERATION_PICK_UP, "slack-off": enums.OPERATION_SLACK_OFF, "rotate": enums.OPERATION_ROTATE,
         "torque": enums.OPERATION_ROTATE}  #: operation of each column
CONFIDENCE = 0.95
STEPS, MOST_FRICTION = 30, 10.0


@dataclass
class Series:
    """The measurements of one column: hook loads [N], or torques [N m] while rotating."""
    word: str
    depths: list[float] = field(default_factory=list)
    values: list[float] = field(default_factory=list)


@dataclass
class Fit:
    """The friction coefficient of a series."""
    friction: float | None        #: None: not assessed
    reason: str = ""              #: why not
    half_width: float | None = None    #: of the interval with CONFIDENCE; None for a single measurement
    scatter: float = math.nan     #: root mean square of the differences [N, N m]
    computed: list[float] = field(default_factory=list)
    by_point: list[float] = field(default_factory=list)   #: coefficient that explains each measurement; NaN: none does


# ---- The file --------------------------------------------------------------------------------------------------------
def read(name: str) -> tuple[dict[str, Series], list[str]]:
    """Series by "pick-up", "slack-off", "rotate", "torque", and remarks. Raises Usage with all faults."""
    try:
        found = columns.read(table_file.read(pathlib.Path(name)), COLUMNS, None, ADVICE, "")
    except table_file.TableError as error:
        raise Usage(f"--measured {name}: {error}") from None
    series = {word: Series(word) for word in KINDS}
    for line, cells in found.rows:
        _take(line, cells, series, found.faults)
    if not found.faults and not any(one.depths for one in series.values()):
        found.faults.append("no column of loads; " + ADVICE)
    if found.faults:
        raise Usage("\n".join(f"--measured {name}: {one}" for one in found.faults))
    return {word: one for word, one in series.items() if one.depths}, found.remarks


def _take(line: int, cells: dict[str, Any], series: dict[str, Series], faults: list[str]) -> None:
    depth = cells["depth"].value
    known = {word: cells[word].value for word in KINDS if word in cells}
    load = cells["hook load"].value if "hook load" in cells else None
    if load is not None:
        text = cells["operation"].text if "operation" in cells else ""
        word = text.strip().casefold().replace("_", "-").replace(" ", "-")
        if word not in ("pick-up", "slack-off", "rotate"):
            faults.append(f"line {line}: hook load of " + (f"operation \"{text}\"" if text else "no operation")
                          + "; a column \"operation\" must "
                          "say pick-up, slack-off or rotate, or each of them has a column of its own")
            return
        known[word] = load
        if word != "rotate":
            known.pop("torque", None)
    for word, value in known.items():
        if value is not None:
            series[word].depths.append(depth)
            series[word].values.append(value)


# ---- The fit ---------------------------------------------------------------------------------------------------------
@dataclass
class Model:
    """The soft string at the depths of a series."""
    sim: Sim
    string: Any
    operation: Operation
    block_weight: float
    series: Series

    def at(self, friction: float) -> list[float]:
        """[N, N m] Computed values, NaN where the string locks up."""
        rows = self.sim.torque_drag([self.operation], self.series.depths, string=self.string, friction=friction).rows
        if self.series.word == "torque":
            return [float(row[0].torque) for row in rows]
        return [float(row[0].hook_load) + self.block_weight for row in rows]

    def inverse(self) -> list[float]:
        """[-] The coefficient for each measurement alone; NaN where none explains it."""
        found = []
        for depth, value in zip(self.series.depths, self.series.values):
            options = TorqueDragOptions(string=self.string, depth_count=1)
            options.depths = (c_double * 1)(depth)
            given: dict[str, Any] = ({"torque": value} if self.series.word == "torque"
                                     else {"hook_load": value - self.block_weight})
            try:
                found.append(self.sim.friction_factor(self.operation, **given, options=options))
            except Error:
                found.append(math.nan)
        return found


def fit(model: Model, start: float) -> Fit:
    """Least squares over all depths by Gauss-Newton corrections; the interval from the scatter about the fit, of
    Student's distribution."""
    values = model.series.values
    if model.series.word == "rotate":
        computed = model.at(start)
        return Fit(None, "the hook load while rotating depends little on friction", computed=computed,
                   scatter=_scatter(computed, values))
    by_point = model.inverse()
    known = sorted(one for one in by_point if math.isfinite(one))
    if not known:
        computed = model.at(start)
        return Fit(None,
                   "no coefficient between 0 and 10 explains any of the measurements; examine the block weight, the "
                   "sign and the unit",
                   computed=computed, by_point=by_point, scatter=_scatter(computed, values))
    friction, slope = _least_squares(model, known[len(known) // 2])
    computed = model.at(friction)
    total = sum((a - b) ** 2 for a, b in zip(computed, values))
    found = Fit(friction, scatter=_scatter(computed, values), computed=computed, by_point=by_point)
    if len(values) > 1 and slope > 0.0:
        quantile = float(need("scipy.stats").t.isf(0.5 * (1.0 - CONFIDENCE), len(values) - 1))
        found.half_width = quantile * math.sqrt(total / (len(values) - 1) / slope)
    return found


def _least_squares(model: Model, friction: float) -> tuple[float, float]:
    """The coefficient of the least sum of squares, and the sum of the squares of the slopes there."""
    values, slope = model.series.values, 0.0
    for _ in range(STEPS):
        step = 1e-4 * max(friction, 0.1)
        here, there = model.at(friction), model.at(friction + step)
        if not all(map(math.isfinite, here + there)):
            friction *= 0.8  # the string locks up
            continue
        slopes = [(b - a) / step for a, b in zip(here, there)]
        slope = sum(one * one for one in slopes)
        if slope == 0.0:
            break
        change = sum(one * (value - a) for one, value, a in zip(slopes, values, here)) / slope
        change = max(-0.5 * friction - 0.1, min(0.5 * friction + 0.1, change))
        new = min(MOST_FRICTION, max(0.0, friction + change))
        if abs(new - friction) <= 1e-9:
            return new, slope
        friction = new
    return friction, slope


def _scatter(computed: list[float], values: list[float]) -> float:
    return math.sqrt(sum((a - b) ** 2 for a, b in zip(computed, values)) / len(values))


# ---- Results ---------------------------------------------------------------------------------------------------------
def compare(sim: Sim, string: Any, name: str, out: CommandOutput, series: dict[str, Series],
            operations: list[Operation],
            block_weight: float, friction: float) -> None:
    """A line for each series, a table of all measurements, and the summary."""
    rows: list[list[Any]] = []
    result: dict[str, Any] = {}
    for word, one in series.items():
        found = fit(Model(sim, string, operations[KINDS[word]], block_weight, one), friction)
        out.say(f"{name}, measured {label(word)}: {_text(one, found, friction, out.units)}")
        result[word] = {"measurements": len(one.values), "friction": found.friction, "reason": found.reason or None,
                      "half_width_95": found.half_width, "scatter": found.scatter}
        factor = out.units.factor("N m" if word == "torque" else "N")
        points = found.by_point or [math.nan] * len(one.values)
        rows += [[depth, label(word), value * factor, computed * factor, point]
                 for depth, value, computed, point in zip(one.depths, one.values, found.computed, points)]
    out.summary.setdefault("measured", {})[name] = result
    out.table(f"measured_{file_name(name)}.csv", ["depth [m]", "quantity", "measured [N or N m]",
                                                  "computed with the fit [N or N m]",
                                                    "friction of this measurement [-]"], rows)


def label(word: str) -> str:
    """In words."""
    return "torque while rotating" if word == "torque" else f"hook load, {word}"


def _text(series: Series, found: Fit, friction: float, units: Units) -> str:
    unit, scale = ("N m", 1.0) if series.word == "torque" else ("kN", 1e-3)
    if found.friction is None:
        mean = sum(a - b for a, b in zip(series.values, found.computed)) / len(series.values)
        return (f"friction not assessed, because {found.reason}; measured minus computed "
                f"{units.text(scale * mean, unit)} on average at friction "
                f"{friction:.3g}")
    failed = sum(not math.isfinite(one) for one in found.by_point)
    interval = ("confidence not assessed, because one measurement has no scatter" if found.half_width is None else
                f"95 % confidence {max(0.0, found.friction - found.half_width):.3g} .. "
                f"{found.friction + found.half_width:.3g}")
    known = [one for one in found.by_point if math.isfinite(one)]
    return (f"friction {found.friction:.4g} ({interval}) from {len(series.values)} measurements, scatter "
            f"{units.text(scale * found.scatter, unit, '.3g')}, "
            f"each alone {min(known):.3g} .. {max(known):.3g}" + (f"; {failed} are explained by no coefficient"
                                                                  if failed else ""))
