"""Limit states: demand of a run for each failure, and its margin. A limit state asks for signals (series in time,
looked at in regular intervals) and makes one number of them, the demand; the margin is limit - demand (demand - limit
where little is bad; eq:probability.margin), below 0 in a failure."""
from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from .. import enums
from .._keep import as_place
from .._optional import need
from .._structs import TorqueDragRow
from ..profile import ends_of_elements, extremes_of
from ..scene.failure import KINDS, Failure
from ..sim import Sim

if TYPE_CHECKING:
    from ..scene import Scene

#: Signals are named (part, quantity, extreme): of a part by OUTPUT_... "", of a string by PROFILE_... "max" or "min"
#: over it.
COURSE = 100  #: stretches between the depths at which courses are compared


# ---- From signals to a demand ----------------------------------------------------------------------------------------
def longest(times: Any, state: Any) -> float:
    """[s] of the longest stretch in which the state is true: from the first to the last look at it, so that a state
    seen once lasts 0."""
    best = begin = 0.0
    before = False
    for time, now in zip(times, state):
        if now and not before:
            begin = float(time)
        if now:
            best = max(best, float(time) - begin)
        before = bool(now)
    return best


def mean_in_time(times: Any, values: Any) -> float:
    """By the trapezoidal rule."""
    numpy = need("numpy")
    if len(times) < 2:
        return float(values[0])
    times, values = numpy.asarray(times), numpy.asarray(values)
    areas = 0.5 * (values[1:] + values[:-1]) * numpy.diff(times)  # trapezia: numpy.trapz is gone in numpy 2
    return float(areas.sum() / (times[-1] - times[0]))


def _magnitude(times: Any, s: dict[str, Any], values: dict[str, float]) -> float:
    return float(abs(s["value"]).max())


def _bit_stuck(times: Any, s: dict[str, Any], values: dict[str, float]) -> float:
    return longest(times, (abs(s["spin"]) <= values["speed"]) & (abs(s["turning"]) > values["speed"]))


def _lock_up(times: Any, s: dict[str, Any], values: dict[str, float]) -> float:
    push = mean_in_time(times, s["push"])
    return mean_in_time(times, s["weight"]) / push if push > 0.0 else math.inf


def _stick_slip(times: Any, s: dict[str, Any], values: dict[str, float]) -> float:
    mean = mean_in_time(times, abs(s["spin"]))
    if mean == 0.0:
        raise ArithmeticError("stick-slip: not assessed, because the bit does not turn")
    return float(s["spin"].max() - s["spin"].min()) / (2.0 * mean)


def _from_zero(values: Any) -> float:
    """The largest value, 0 at least; NaN where one is."""
    largest = float(values.max())
    return largest if math.isnan(largest) else max(0.0, largest)


def _tightening(times: Any, s: dict[str, Any], values: dict[str, float]) -> float:
    """Torque that tightens a right-hand thread (TORQUE_SIGN)."""
    return _from_zero(s["most"] if TORQUE_SIGN > 0.0 else -s["least"])


def _loosening(times: Any, s: dict[str, Any], values: dict[str, float]) -> float:
    return _from_zero(-s["least"] if TORQUE_SIGN > 0.0 else s["most"])


def _largest(times: Any, s: dict[str, Any], values: dict[str, float]) -> float:
    known = s["value"][~need("numpy").isnan(s["value"])]
    return float(known.max()) if len(known) else math.nan


def _over(key: str) -> Callable[[Any, dict[str, Any], dict[str, float]], float]:
    """The largest value over a key of the failure."""
    return lambda times, s, values: _largest(times, s, values) / values[key]


def _profile(quantity: int) -> dict[str, tuple[str, int, str]]:
    return {"value": ("string", int(quantity), "max")}


# ---- From torque and drag to a demand --------------------------------------------------------------------------------
@dataclass
class Soft:
    """Torque and drag of one sample: rows of the operations by their word, the load on the bit, the largest wall force
    per length."""
    rows: dict[str, TorqueDragRow]  #: "pulled out", "pushed in", "rotated"
    weight_on_bit: float       #: [N]
    yield_strength: float      #: [Pa] that the shares of the rows are of
    wall_force: float = 0.0    #: [N/m]

    def largest(self, of: Callable[[TorqueDragRow], float]) -> float:
        """Over the operations; infinite where one of them locks up, because no thrust at the rig does it."""
        values = [math.inf if row.locked else of(row) for row in self.rows.values()]
        return math.nan if any(math.isnan(one) for one in values) else max(values)


def _soft_lock_up(soft: Soft, values: dict[str, float]) -> float:
    push = soft.largest(lambda row: -row.hook_load)
    return soft.weight_on_bit / push if push > 0.0 else math.inf


def _jamming(soft: Soft, values: dict[str, float]) -> float:
    """[N] Reserve of pull, or of torque over the radius; without bound below where the string locks up."""
    pulled, turned = soft.rows["pulled out"], soft.rows["rotated"]
    pull = -math.inf if pulled.locked else values["pull"] - pulled.hook_load
    torque = -math.inf if turned.locked else 2.0 * (values["torque"] - turned.torque) / values["diameter"]
    return float(max(pull, torque))


def _never(times: Any, s: dict[str, Any], values: dict[str, float]) -> float:
    return math.nan


class Course:
    """The course of the hole that a scene gives, as far as its strings reach."""

    def __init__(self, scene: Scene) -> None:
        lengths = [arguments[0] * arguments[1].get("length", 1.0) for name, arguments in scene.model.calls
                   if name == "add_pipes"]
        begin = max((float(arguments[0].get("start_depth", 0.0)) for name, arguments in scene.model.calls
                     if name == "add_string"), default=0.0)
        self.depths = [(begin + math.fsum(lengths)) * i / COURSE for i in range(COURSE + 1)]
        self.heights = self._heights(scene)

    def _heights(self, scene: Scene) -> list[float]:
        return [float(scene.model.hole(depth).position[2]) for depth in self.depths]

    def off(self, scene: Scene) -> float:
        """[m] Largest vertical distance of another scene's hole from it."""
        return max(abs(a - b) for a, b in zip(self.heights, self._heights(scene)))


@dataclass(frozen=True)
class How:
    """The functions that find the demand of a kind from series in time or from torque and drag, and the outputs that
    the series are of."""
    demand: Callable[[Any, dict[str, Any], dict[str, float]], float]
    signals: dict[str, tuple[str, int, str]]  #: part, quantity, extreme: "", "max", "min" or "damage"
    soft: Callable[[Soft, dict[str, float]], float] | None = None


C, P = enums.Quantity, enums.ProfileQuantity
HOW: dict[str, How] = {
    "bit-stuck": How(_bit_stuck, {"spin": ("bit", C.SPIN, ""), "turning": ("head", C.DRIVE_SPEED, "")}),
    "rig-torque": How(_magnitude, {"value": ("head", C.DRIVE_FORCE, "")},
                      lambda soft, v: soft.largest(lambda row: row.torque)),
    "rig-push": How(_largest, {"value": ("feed", C.DRIVE_FORCE, "")},
                    lambda soft, v: soft.largest(lambda row: -row.hook_load)),
    "rig-pull": How(lambda t, s, v: float(-s["value"].min()), {"value": ("feed", C.DRIVE_FORCE, "")},
                    lambda soft, v: math.inf if soft.rows["pulled out"].locked else soft.rows["pulled out"].hook_load),
    "lock-up": How(_lock_up, {"push": ("feed", C.DRIVE_FORCE, ""), "weight": ("bit", C.BIT_WEIGHT, "")}, _soft_lock_up),
    "helical-buckling": How(_largest, _profile(P.HELICAL_SHARE),
                            lambda soft, v: soft.largest(lambda row: row.helical_share)),
    "stress": How(_over("strength"), _profile(P.VON_MISES),
                  lambda soft, v: soft.largest(lambda row: row.yield_share) * soft.yield_strength / v["strength"]),
    "connection-torque": How(_tightening, {"most": ("string", P.TORQUE, "max"), "least": ("string", P.TORQUE, "min")},
                             lambda soft, v: soft.largest(lambda row: row.torque)),
    "back-off": How(_loosening, {"most": ("string", P.TORQUE, "max"), "least": ("string", P.TORQUE, "min")}),
    "fatigue": How(_largest, {"value": ("string", -1, "damage")}),
    "lateral-acceleration": How(_largest, _profile(P.ACCELERATION_LATERAL)),
    "bit-off-bottom": How(lambda t, s, v: longest(t, s["weight"] <= v["load"]), {"weight": ("bit", C.BIT_WEIGHT, "")}),
    "wall-pressure": How(_over("width"), _profile(P.NORMAL_FORCE), lambda soft, v: soft.wall_force / v["width"]),
    "stick-slip": How(_stick_slip, {"spin": ("bit", C.SPIN, "")}),
    "jamming": How(_never, {}, _jamming)}
BESIDE = ("own", "leaves-seam")  #: kinds that a sample finds from its scene, not from signals


def margin_of(failure: Failure, demand: float) -> float:
    """limit - demand, or demand - limit where little is bad. NaN is refused: it is no margin."""
    if math.isnan(demand):
        raise ValueError(f"{failure.name}: the demand is not a number; the scene lacks the parts that {failure.kind} "
                         "needs")
    return demand - failure.limit if KINDS[failure.kind].low else failure.limit - demand


def margin(failure: Failure, times: Any, signals: dict[str, Any]) -> tuple[float, float]:
    """Margin and demand of a failure, by its signals in time."""
    numpy, values = need("numpy"), failure.values
    keep = (times >= values.get("from", -math.inf)) & (times <= values.get("to", math.inf))
    if not keep.any():
        raise ValueError(f"{failure.name}: no look at the run within from .. to; it was looked at {times[0]:g} .. "
                         f"{times[-1]:g} s")
    demand = HOW[failure.kind].demand(times[keep], {name: numpy.asarray(one)[keep] for name, one in signals.items()},
                                      values)
    return margin_of(failure, demand), demand


def soft_margin(failure: Failure, soft: Soft) -> tuple[float, float]:
    """Margin and demand of a failure by torque and drag."""
    function = HOW[failure.kind].soft
    if function is None:
        raise ValueError(f"{failure.name}: torque and drag say nothing about {failure.kind}")
    demand = function(soft, failure.values)
    return margin_of(failure, demand), demand


#: Sign of the section torque where a rig turns a string towards +x against a resistance, clockwise looking into the
#: hole, which tightens right-hand threads: the far part holds back, so the moment that it exerts on the near one is <
#: 0.
TORQUE_SIGN = -1.0


# ---- Signals of a run ------------------------------------------------------------------------------------------------
class Watch:
    """Takes the signals that some failures need, at each look."""

    def __init__(self, scene: Scene, sim: Sim, failures: list[Failure], looks: int) -> None:
        self.scene, self.sim, self.failures = scene, sim, [one for one in failures if one.kind not in BESIDE]
        signals = {(one.names[part], quantity, what) for one in self.failures
                   for part, quantity, what in HOW[one.kind].signals.values()}
        self.outputs = sorted(one for one in signals if one[2] == "")
        self.profiles = sorted(one for one in signals if one[2] in ("max", "min"))
        self.stations = {name: ends_of_elements(scene.model.calls, scene.names[name])
                         for name in dict.fromkeys(one[0] for one in self.profiles)}
        self.counters = {one.name: self._fatigue(one) for one in self.failures if one.kind == "fatigue"}
        places = [(as_place(scene.names[name]), quantity) for name, quantity, _ in self.outputs]
        self.recorder = sim.recorder(places, looks + 2) if places else None
        self.times: list[float] = []
        self.rows: list[list[float]] = []

    def _fatigue(self, one: Failure) -> Any:
        name = one.names["string"]
        values: dict[str, Any] = {key: one.values[key] for key in ("curve_stress", "curve_cycles", "slope", "endurance",
                                                                   "concentration")}
        values["stress_range"] = 2.0 * values["concentration"] * self.scene.limits.get("yield_stress", 5e8)
        return self.sim.string_fatigue(self.scene.names[name], self.scene.pipes[name], **values)

    def count(self) -> None:
        """Cycles of stress: after each step, because looks may be a cycle apart."""
        for counter in self.counters.values():
            counter.take()

    def look(self) -> None:
        """One more."""
        self.times.append(self.sim.time)
        if self.recorder is not None:
            self.recorder.take()
        self.rows.append(self._extremes())

    def _extremes(self) -> list[float]:
        row = [math.nan] * len(self.profiles)
        for name in dict.fromkeys(one[0] for one in self.profiles):
            mine = [(i, one) for i, one in enumerate(self.profiles) if one[0] == name]
            quantities = list(dict.fromkeys(one[1] for _, one in mine))
            found = dict(zip(quantities, extremes_of(self.sim, self.scene.names[name], quantities,
                                                     self.stations[name])))
            for i, (_, quantity, what) in mine:
                row[i] = found[quantity].maximum if what == "max" else found[quantity].minimum
        return row

    def signals(self, failure: Failure) -> dict[str, Any]:
        """The series of one failure."""
        numpy, found = need("numpy"), {}
        table = None if self.recorder is None else numpy.array(self.recorder.table)
        rows = numpy.array(self.rows)
        for signal, (part, quantity, what) in HOW[failure.kind].signals.items():
            key = (failure.names[part], int(quantity), what)
            if what == "damage":
                results = self.counters[failure.name].results
                worst = max(one.damage for one in results)
                if any(one.clipped for one in results) and worst < failure.limit:
                    raise ArithmeticError(f"{failure.name}: not assessed, because cycles of stress beyond the range of "
                                          "counting are missed; raise yield_stress of [limits]")
                found[signal] = numpy.full(len(self.times), worst)
            elif what == "":
                assert table is not None
                found[signal] = table[:, 1 + [(a, int(b), c) for a, b, c in self.outputs].index(key)]
            else:
                found[signal] = rows[:, [(a, int(b), c) for a, b, c in self.profiles].index(key)]
        return found

    def margins(self, more: Mapping[str, float]) -> dict[str, tuple[float, float]]:
        """Margin and demand of each failure, by its name; more: added to demands by name, for parts that a static state
        lacks."""
        times, found = need("numpy").array(self.times), {}
        for one in self.failures:
            demand = (margin(one, times, self.signals(one))[1] + more.get(one.name, 0.0)
                      / one.values.get("strength", 1.0))
            found[one.name] = (margin_of(one, demand), demand)
        return found

