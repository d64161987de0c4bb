"""[variability] of a scene file: parameters that scatter, random fields along hole or string, random processes in time,
with their distributions and rank correlations. Read and checked here; drawn by drillmbd.probability.

A distribution has a name and parameters. With `relative` its numbers are factors of the values of the scene."""
from __future__ import annotations

import math
import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from .._optional import need
from . import units
from .overrides import by_number, path_of_key
from .failure import QUESTIONS
from .failure import unit_of as unit_of_failure
from .fields import DEFINITIONS, Field, fields_of
from .lines import Path
from .problems import meant

if TYPE_CHECKING:
    from .load import Loader

#: Parameters of each distribution: "value" has the unit of what varies, "number" none.
DISTRIBUTIONS: dict[str, dict[str, str]] = {
    "normal": {"mean": "value", "deviation": "value"},
    "truncated-normal": {"mean": "value", "deviation": "value", "low": "value", "high": "value"},
    "lognormal": {"mean": "value", "deviation": "value"}, "gamma": {"mean": "value", "deviation": "value"},
    "gumbel": {"mean": "value", "deviation": "value"}, "weibull": {"shape": "number", "scale": "value"},
    "exponential": {"mean": "value"}, "uniform": {"low": "value", "high": "value"},
    "triangular": {"low": "value", "mode": "value", "high": "value"},
    "beta": {"low": "value", "high": "value", "mean": "value", "deviation": "value"}}
PARAMETERS = ("mean", "deviation", "low", "mode", "high", "shape", "scale")
KERNELS = ("exponential", "gaussian", "matern-3/2", "matern-5/2", "independent")
METHODS = ("monte-carlo", "latin-hypercube", "sobol", "subset")
PROCESS = ("factor", "added")
ALONG_HOLE = ("mu_static", "mu_dynamic", "diameter", "stiffness", "restitution", "damping")  #: of a section of the hole
MOST_POINTS = 4000  #: of a field or a process: the covariance is a full matrix

SETTINGS = {
    "seed": Field("seed", "integer", about="of the study; default 1"),
    "samples": Field("samples", "integer", about="number of samples; default 100"),
    "replicates": Field("replicates", "integer",
                        about="independent designs that the samples of latin-hypercube and sobol are "
                        "divided into, for the interval; default 10"),
    "confidence": Field("confidence", "quantity", "-", about="of intervals; default 0.95"),
    "look": Field("look", "quantity", "s", about="between looks at the run; default: [results] interval, or each step")}


@dataclass(frozen=True)
class Marginal:
    """A distribution by name and parameters (SI)."""
    name: str
    values: dict[str, float]


@dataclass(frozen=True)
class Scatter:
    """A parameter that has one value in a sample, at one or several keys of the scene."""
    name: str
    keys: list[str]
    unit: str
    marginal: Marginal
    relative: bool = False
    base: tuple[float, ...] = ()  #: what the factors multiply, of each key
    units: tuple[str, ...] = ()   #: of each key


@dataclass(frozen=True)
class RandomField:
    """A value that varies along the hole or along the string; at several keys of the hole where relative."""
    name: str
    keys: list[str]
    unit: str
    marginal: Marginal
    kernel: str
    length: float         #: [m] correlation length; 0 where independent
    spacing: float = 0.0  #: [m] between sections of a field along the hole
    modes: int = 0        #: of Karhunen and Loeve that are kept; 0: all
    relative: bool = False
    #: [m] depths between which a field along the hole has its sections; it goes on as at its ends
    ends: tuple[float, float] = (0.0, 0.0)
    base: tuple[float, ...] = ()  #: what the factors multiply, of each key of the hole
    units: tuple[str, ...] = ()   #: of each key

    @property
    def key(self) -> str:
        """The first."""
        return self.keys[0]


@dataclass(frozen=True)
class RandomProcess:
    """A time function that varies in time, by a factor or a sum."""
    name: str
    time_function: str
    unit: str
    marginal: Marginal
    kernel: str
    length: float         #: [s] correlation time
    spacing: float        #: [s] between rows of its table
    how: str = "factor"   #: or "added"


@dataclass
class Variability:
    """All that varies, and how the study goes."""
    method: str = "monte-carlo"
    question: str = "run"
    settings: dict[str, Any] = field(default_factory=dict)
    scatters: list[Scatter] = field(default_factory=list)
    fields: list[RandomField] = field(default_factory=list)
    processes: list[RandomProcess] = field(default_factory=list)
    correlations: list[tuple[str, str, float]] = field(default_factory=list)  #: of ranks, between scattered parameters

    @property
    def names(self) -> list[str]:
        """Of all that varies."""
        return [one.name for one in self.parts]

    @property
    def parts(self) -> list[Scatter | RandomField | RandomProcess]:
        """All that varies."""
        return [*self.scatters, *self.fields, *self.processes]


# ---- Distributions ---------------------------------------------------------------------------------------------------
def refusal(name: str, v: dict[str, float]) -> tuple[str, str] | None:
    """The parameter of a complete distribution that is out of bounds, and its bound."""
    for key in ("deviation", "shape", "scale"):
        if key in v and not v[key] > 0.0:
            return key, "must be > 0"
    if name in ("lognormal", "gamma", "exponential") and not v["mean"] > 0.0:
        return "mean", "must be > 0"
    if "low" in v and not v["high"] > v["low"]:
        return "high", f"must be > low = {v['low']:g}"
    if name == "triangular" and not v["low"] <= v["mode"] <= v["high"]:
        return "mode", f"must be within low = {v['low']:g} .. high = {v['high']:g}"
    if name == "beta":
        if not v["low"] < v["mean"] < v["high"]:
            return "mean", f"must be within low = {v['low']:g} .. high = {v['high']:g}"
        most = math.sqrt((v["mean"] - v["low"]) * (v["high"] - v["mean"]))
        if not v["deviation"] < most:
            return "deviation", f"must be < sqrt((mean - low)(high - mean)) = {most:g}"
    return None


def unit_of_key(loader: Loader, path: Path) -> str | None:
    """The unit of a single number at a path of the scene; None where there is none."""
    table = next((part for part in reversed(path[:-1]) if isinstance(part, str)), "")
    key = path[-1]
    if table == "segment" and path[0] == "time_function" and key in ("h0", "h1"):
        number = path[1] if len(path) > 1 and isinstance(path[1], int) else 0
        found = loader.parts("time_function")
        return loader.units.get(loader.name("time_function", number, found[number][1])) if number < len(found) else None
    if path[0] == "failure":
        return unit_of_failure(loader, path)
    if path[0] == "limits":
        from .settings import LIMITS
        return LIMITS[str(key)].unit if len(path) == 2 and key in LIMITS else None
    known = fields_of(DEFINITIONS[table]).get(str(key)) if table in DEFINITIONS else None
    if known is None or known.kind != "quantity" or known.count:
        return None
    if path == ("hole", "stiffness"):
        exponent = loader.table(("hole",)).get("exponent", 1.0)
        return f"N/m^{(float(exponent) if isinstance(exponent, (int, float)) else 1.0) + 1.0:g}"
    if table == "drive" and known.name in ("gain", "integral_gain", "limit_low", "limit_high"):
        return None
    return known.unit.split(",")[0].strip() or "-"


class Reader:
    """Reads the tables with the problems of a loader."""

    def __init__(self, loader: Loader) -> None:
        self.loader, self.problems = loader, loader.problems
        self.names: set[str] = set()

    def variability(self) -> Variability | None:
        """The whole; None where the scene has no such table."""
        if "variability" not in self.loader.content:
            return None
        table, path = self.loader.table(("variability",)), ("variability",)
        parts = ("method", "question", "scatter", "field", "process", "correlation")
        found = Variability(settings=self.loader.read(path, table, SETTINGS, parts))
        found.method = self._word(path, table, "method", METHODS, "monte-carlo")
        found.question = self._word(path, table, "question", QUESTIONS, "run")
        self._bounds(found.settings)
        lists: dict[str, list[Any]] = {"scatter": found.scatters, "field": found.fields, "process": found.processes}
        for kind, into in lists.items():
            for number, (where, one) in enumerate(self.loader.tables(table, path, kind)):
                made = getattr(self, "_" + kind)(where, one, self._name(kind, number, where, one))
                if made is not None:
                    into.append(made)
        for where, one in self.loader.tables(table, path, "correlation"):
            self._correlation(found, where, one)
        if not found.names and not self.problems.found:
            self.problems.add(path, None,
                              "must have something that varies: [[variability.scatter]], [[variability.field]] or "
                                          "[[variability.process]]")
        if found.question in ("run", "auto") and "end" not in self.loader.table(("run",)):
            self.problems.add(path, None,
                              "needs [run] end, as end = \"40 s\"; or question = \"static\" or \"torque-drag\"")
        if found.correlations and not self.problems.found:
            self._definite(found)
        return found

    def _bounds(self, settings: dict[str, Any]) -> None:
        for key, low, high, bound in (("seed", 0, 2 ** 32, ">= 0"), ("samples", 1, 10 ** 9, "1 .. 10^9"),
                                      ("replicates", 2, 1000, "2 .. 1000"), ("look", 1e-12, 1e12, "> 0 s"),
                                      ("confidence", 0.5, 1.0 - 1e-12, "0.5 .. 1, below 1")):
            if key in settings and not low <= settings[key] <= high:
                self.problems.add(("variability", key), self.loader.written(("variability", key)), f"must be {bound}")

    def _name(self, kind: str, number: int, path: Path, table: dict[str, Any]) -> str:
        name = table.get("name", f"{kind}-{number}")
        if not isinstance(name, str) or not name:
            self.problems.add(path + ("name",), name, "must be a text that is not empty")
        elif name in self.names:
            self.problems.add(path + ("name",), name, "names something that varies already; every name once")
        else:
            self.names.add(name)
        return str(name)

    def _word(self, path: Path, table: dict[str, Any], key: str, known: tuple[str, ...], default: str | None) -> str:
        value = table.get(key, default)
        if not isinstance(value, str) or value not in known:
            self.problems.add(path + (key,) if key in table else path, value if key in table else None,
                              ("must be one of the words" if key in table else f"must have a {key}")
                              + meant(str(value), known))
            return known[0]
        return value

    def marginal(self, path: Path, table: dict[str, Any], unit: str) -> Marginal | None:
        """The distribution of a table."""
        name = self._word(path, table, "distribution", tuple(DISTRIBUTIONS), None)
        if table.get("distribution") != name:
            return None
        wanted, values = DISTRIBUTIONS[name], dict[str, float]()
        for key in PARAMETERS:
            if key in table and key not in wanted:
                self.problems.add(path + (key,), table[key], f"is no parameter of {name}; it has {', '.join(wanted)}")
            elif key in wanted and key not in table:
                self.problems.add(path, None, f"{name} must have {key}")
            elif key in wanted:
                try:
                    values[key] = units.parse(table[key], unit if wanted[key] == "value" else "-")
                except units.UnitError as error:
                    self.problems.add(path + (key,), table[key], str(error))
        if len(values) < len(wanted):
            return None
        wrong = refusal(name, values)
        if wrong is not None:
            self.problems.add(path + (wrong[0],), table[wrong[0]], f"{wrong[1]} (in {unit})" if unit != "-"
                              else wrong[1])
            return None
        return Marginal(name, values)

    def _common(self, path: Path, table: dict[str, Any], more: dict[str, Field],
                words: tuple[str, ...]) -> dict[str, Any]:
        """Numbers that are read by their fields; the other keys are the caller's."""
        return self.loader.read(path, table, more, ("name", "distribution", *PARAMETERS, *words))

    def _relative(self, path: Path, table: dict[str, Any]) -> bool:
        if not isinstance(table.get("relative", False), bool):
            self.problems.add(path + ("relative",), table["relative"], "must be true or false")
        return table.get("relative", False) is True

    def _key(self, path: Path, key: Any) -> str | None:
        """The unit at a key; a key of a number that the scene has."""
        try:
            where = path_of_key(key) if isinstance(key, str) else None
        except ValueError as error:
            self.problems.add(path, key, str(error))
            return None
        unit = unit_of_key(self.loader, where) if where else None
        if unit is None or where is None:
            self.problems.add(path, key,
                              "must be the key of a single number, as hole.mu_dynamic or "
                              "string[0].pipes[0].eccentricity")
            return None
        holder = self._holder(where)
        if not isinstance(holder, dict):
            self.problems.add(path, key, "the scene has no such table")
            return None
        return unit

    def _by_number(self, path: Path, keys: list[Any]) -> list[Any] | None:
        """Keys with the numbers of the tables that they name; None where one is wrong."""
        try:
            found = [by_number(key, self.loader.content) if isinstance(key, str) else key for key in keys]
            try:
                for key in keys:
                    if isinstance(key, str):
                        by_number(key, self.loader.content, typed=True)
            except ValueError as error:  # no fault: saved scenes have numbers
                self.problems.remark(path, None, str(error))
            return found
        except ValueError as error:
            self.problems.add(path, keys if len(keys) > 1 else keys[0], str(error))
            return None

    def _holder(self, where: Path) -> Any:
        """The table that a key stands in; None where there is none."""
        holder: Any = self.loader.content
        for part in where[:-1]:
            if isinstance(part, str):
                holder = holder[0] if isinstance(holder, list) and len(holder) == 1 else holder
                holder = holder.get(part) if isinstance(holder, dict) else None
            elif isinstance(holder, dict):
                holder = holder if part == 0 else None
            else:
                holder = holder[part] if isinstance(holder, list) and part < len(holder) else None
        return holder[0] if isinstance(holder, list) and len(holder) == 1 else holder

    def _scatter(self, path: Path, table: dict[str, Any], name: str) -> Scatter | None:
        self._common(path, table, {}, ("key", "keys", "relative"))
        keys = [table["key"]] if "key" in table else table.get("keys", [])
        if not isinstance(keys, list) or not keys or ("key" in table) == ("keys" in table):
            self.problems.add(path, None, 'must have a key, as key = "hole.diameter", or several, as keys = [...]')
            return None
        keys = self._by_number(path + ("key" if "key" in table else "keys",), keys)
        if keys is None:
            return None
        found = [self._key(path + ("key" if "key" in table else "keys",), key) for key in keys]
        relative = self._relative(path, table)
        if None in found:
            return None
        if not relative and len(set(found)) > 1:
            self.problems.add(path + ("keys",), keys, "must be of one unit, or relative = true")
            return None
        base = [self._base(str(key)) for key in keys] if relative else []
        for key, value in zip(keys, base):
            if value is None or value == 0.0:
                self.problems.add(path, None, f"relative = true needs a value of {key} that is not 0")
        unit = "-" if relative else str(found[0])
        made = self.marginal(path, table, unit)
        return None if made is None else Scatter(name, [str(key) for key in keys], unit, made, relative,
                                                 tuple(one or 0.0 for one in base),
                               tuple(str(one) for one in found))

    def _base(self, key: str) -> float | None:
        """The value in the scene, or the default."""
        path = path_of_key(key)
        holder: Any = self._holder(path) or {}
        unit = unit_of_key(self.loader, path) or "-"
        if path[-1] in holder:
            try:
                return units.parse(holder[path[-1]], unit)
            except units.UnitError:
                return None
        table = next((part for part in reversed(path[:-1]) if isinstance(part, str)), "")
        value = getattr(DEFINITIONS[table](), str(path[-1]), None) if table in DEFINITIONS else None
        return float(value) if value is not None else None

    def _kernel(self, path: Path, table: dict[str, Any], key: str, values: dict[str, Any]) -> tuple[str, float]:
        kernel = self._word(path, table, "kernel", KERNELS, "exponential")
        length = values.get(key, 0.0)
        if kernel == "independent" and key in table:
            self.problems.add(path + (key,), table[key], "must be left out where the kernel is independent")
        if kernel != "independent" and not length > 0.0:
            self.problems.add(path + (key,) if key in table else path, table.get(key), f"must have a {key} > 0")
        return kernel, length

    def _field(self, path: Path, table: dict[str, Any], name: str) -> RandomField | None:
        known = {"correlation_length": Field("correlation_length", "quantity", "m"),
                 "spacing": Field("spacing", "quantity", "m"),
                 "modes": Field("modes", "integer"), "from": Field("from", "quantity", "m"),
                 "to": Field("to", "quantity", "m")}
        values = self._common(path, table, known, ("key", "keys", "kernel", "relative"))
        kernel, length = self._kernel(path, table, "correlation_length", values)
        for key in ("spacing", "modes", "to"):
            if key in values and not values[key] > 0:
                self.problems.add(path + (key,), table[key], "must be > 0")
        keys, relative = [table["key"]] if "key" in table else table.get("keys", []), self._relative(path, table)
        if not isinstance(keys, list) or not keys or ("key" in table) == ("keys" in table):
            self.problems.add(path, None,
                              'must have a key, as key = "hole.mu_dynamic", or several of the hole, as keys = [...]')
            return None
        keys = self._by_number(path + ("key" if "key" in table else "keys",), keys)
        if keys is None:
            return None
        along_hole = [isinstance(key, str) and key.startswith("hole.") and key[5:] in ALONG_HOLE for key in keys]
        if any(along_hole) or len(keys) > 1:
            return self._hole_field(path, table, name, keys, along_hole, (kernel, length, values, relative))
        unit = self._field_unit(path, keys[0])
        for key in ("spacing", "from", "to"):
            if key in table:
                self.problems.add(path + (key,), table[key], "is for a field along the hole, as hole.mu_dynamic")
        if unit is None:
            return None
        made = self.marginal(path, table, "-" if relative else unit)
        return None if made is None else RandomField(name, [str(keys[0])], "-" if relative else unit, made, kernel,
                                                     length, 0.0,
                                                     values.get("modes", 0), relative)

    def _hole_field(self, path: Path, table: dict[str, Any], name: str, keys: list[Any], along: list[bool],
                    how: tuple[str, float, dict[str, Any], bool]) -> RandomField | None:
        """Sections of the hole, with straight lines between them."""
        kernel, length, values, relative = how
        if not all(along) or (len(keys) > 1 and not relative) or len(set(keys)) < len(keys):
            self.problems.add(path + ("keys" if "keys" in table else "key",), keys, "must be different ones of "
                              + ", ".join(f"hole.{one}" for one in ALONG_HOLE) + "; several need relative = true")
            return None
        if "hole" not in self.loader.content:
            self.problems.add(path + ("keys" if "keys" in table else "key",), keys,
                              "vary along the hole, and the scene has no [hole]")
            return None
        if self.loader.table(("hole",)).get("section"):
            self.problems.add(path, None, "the hole has [[hole.section]] already; a field makes sections of its own")
        if "to" not in values or values.get("from", 0.0) >= values["to"]:
            self.problems.add(path + ("to",) if "to" in table else path, table.get("to"),
                              "must have a depth `to` that is > from, as "
                                                                                          'to = "120 m"')
            return None
        spacing = values.get("spacing", length / 3.0)
        count = (values["to"] - values.get("from", 0.0)) / spacing if spacing > 0.0 else math.inf
        if not 1.0 <= count <= MOST_POINTS:
            self.problems.add(path + ("spacing",) if "spacing" in table else path, table.get("spacing"),
                              f"makes {count:.4g} sections from {values.get('from', 0.0):g} m to {values['to']:g} m, "
                              f"must be 1 .. {MOST_POINTS}")
            return None
        units_of = [unit_of_key(self.loader, path_of_key(key)) or "-" for key in keys]
        base = [self._base(key) for key in keys] if relative else []
        unit = "-" if relative else units_of[0]
        made = self.marginal(path, table, unit)
        return None if made is None else RandomField(name, keys, unit, made, kernel, length, spacing,
                                                     values.get("modes", 0), relative,
                                                     (values.get("from", 0.0), values["to"]),
                                                     tuple(one or 0.0 for one in base),
                                                     tuple(units_of))

    def _field_unit(self, path: Path, key: Any) -> str | None:
        """Of hole.survey.inclination, hole.survey.azimuth (added values), or of a number of pipes:
        string[0].pipes.eccentricity."""
        if key in ("hole.survey.inclination", "hole.survey.azimuth"):
            if not {"survey", "survey_file"} & set(self.loader.table(("hole",))):
                self.problems.add(path + ("key",), key, "needs a survey of the hole")
            return "rad"
        match = re.fullmatch(r"string\[(\d+)\]\.pipes\.(\w+)", key) if isinstance(key, str) else None
        known = fields_of(DEFINITIONS["pipes"]).get(match.group(2)) if match else None
        if (match and known and known.kind == "quantity" and not known.count
            and int(match.group(1)) < len(self.loader.parts("string"))):
            return known.unit or "-"
        self.problems.add(path + ("key",), key,
                          "must be a quantity that varies along the string, as string[0].pipes.eccentricity, or "
                          "along the hole: " + ", ".join(f"hole.{one}" for one in ALONG_HOLE)
                          + ", hole.survey.inclination, "
                          "hole.survey.azimuth (a value that is added to them)")
        return None

    def _process(self, path: Path, table: dict[str, Any], name: str) -> RandomProcess | None:
        known = {"correlation_time": Field("correlation_time", "quantity", "s"),
                 "spacing": Field("spacing", "quantity", "s")}
        values = self._common(path, table, known, ("time_function", "kernel", "how"))
        kernel, length = self._kernel(path, table, "correlation_time", values)
        how = self._word(path, table, "how", PROCESS, "factor")
        spacing = values.get("spacing", length / 5.0)
        if not spacing > 0.0:
            self.problems.add(path + ("spacing",) if "spacing" in table else path, table.get("spacing"),
                              "must have a spacing > 0 s")
        time_function = table.get("time_function")
        if not isinstance(time_function, str) or self.loader.kinds.get(time_function) != "time_function":
            known_names = [one for one, kind in self.loader.kinds.items() if kind == "time_function"]
            self.problems.add(path + ("time_function",), time_function,
                              "must name a time function" + meant(str(time_function), known_names))
            return None
        unit = "-" if how == "factor" else self.loader.units.get(time_function, "-")
        if spacing > 0.0 and self.loader.content.get("run"):
            self._points(path, spacing)
        made = self.marginal(path, table, unit)
        return None if made is None else RandomProcess(name, time_function, unit, made, kernel, length, spacing, how)

    def _points(self, path: Path, spacing: float) -> None:
        try:
            end = units.parse(self.loader.table(("run",)).get("end", 0), "s")
        except units.UnitError:
            return
        if end / spacing > MOST_POINTS:
            self.problems.add(path + ("spacing",), f"{spacing:g} s",
                              f"makes {end / spacing:.0f} rows in a run of {end:g} s, must be "
                                                                     f"<= {MOST_POINTS}")

    def _correlation(self, found: Variability, path: Path, table: dict[str, Any]) -> None:
        values = self.loader.read(path, table, {"rank": Field("rank", "quantity", "-")}, ("between",))
        pair, known = table.get("between"), [one.name for one in found.scatters]
        if not isinstance(pair, list) or len(pair) != 2 or pair[0] == pair[1] or not all(one in known for one in pair):
            wrong = next((str(one) for one in pair if one not in known), "") if isinstance(pair, list) else ""
            self.problems.add(path + ("between",), pair,
                              "must be two names of [[variability.scatter]]" + meant(wrong, known))
            return
        if "rank" not in values or not -1.0 < values["rank"] < 1.0:
            self.problems.add(path + ("rank",), table.get("rank"), "must be a number between -1 and 1")
            return
        if any({pair[0], pair[1]} == {a, b} for a, b, _ in found.correlations):
            self.problems.add(path + ("between",), pair, "appears twice; give every pair once")
            return
        found.correlations.append((pair[0], pair[1], values["rank"]))

    def _definite(self, found: Variability) -> None:
        least = float(need("numpy").linalg.eigvalsh(normal_correlation(found)).min())
        if not least > 1e-10:
            self.problems.add(("variability", "correlation", len(found.correlations) - 1), None,
                              f"the rank correlations contradict each other: least eigenvalue {least:.3g}, must be > "
                              "1e-10")


def normal_correlation(found: Variability) -> Any:
    """Correlation of the normal variables of a Gaussian copula: rho = 2 sin(pi r/6) for a rank correlation r (Spearman)
    (Pearson 1907)."""
    numpy = need("numpy")
    names = [one.name for one in found.scatters]
    matrix = numpy.eye(len(names))
    for a, b, rank in found.correlations:
        i, j = names.index(a), names.index(b)
        matrix[i, j] = matrix[j, i] = 2.0 * math.sin(math.pi * rank / 6.0)
    return matrix


# ---- Writing and the schema ------------------------------------------------------------------------------------------
def _written(made: Marginal, unit: str) -> dict[str, Any]:
    wanted = DISTRIBUTIONS[made.name]
    return {"distribution": made.name, **{key: units.text(value, unit if wanted[key] == "value" else "-")
                                          for key, value in made.values.items()}}


def tables_of(found: Variability) -> list[tuple[str, dict[str, Any]]]:
    """Heads and keys as they are written."""
    settings = {key: units.text(value, "-" if known.kind == "integer" else known.unit)
                for key, known in SETTINGS.items() for value in [found.settings.get(key)] if value is not None}
    tables: list[tuple[str, dict[str, Any]]] = [("[variability]", {"method": found.method, "question": found.question,
                                                                   **settings})]
    for scatter in found.scatters:
        tables.append(("[[variability.scatter]]", {"name": scatter.name, "keys": scatter.keys,
                                                   "relative": scatter.relative,
                                                   **_written(scatter.marginal, scatter.unit)}))
    for one in found.fields:
        more: dict[str, Any] = {"correlation_length": units.text(one.length, "m")} if one.length else {}
        more.update({"spacing": units.text(one.spacing, "m")} if one.spacing else {})
        more.update({"modes": one.modes} if one.modes else {})
        more.update({"from": units.text(one.ends[0], "m"), "to": units.text(one.ends[1], "m")} if one.ends[1] else {})
        tables.append(("[[variability.field]]", {"name": one.name, "keys": one.keys, "relative": one.relative,
                                                 "kernel": one.kernel,
                                                 **more, **_written(one.marginal, "-" if one.relative else one.unit)}))
    for process in found.processes:
        time = {"correlation_time": units.text(process.length, "s")} if process.length else {}
        tables.append(("[[variability.process]]", {
            "name": process.name, "time_function": process.time_function, "how": process.how, "kernel": process.kernel,
            **time,
            "spacing": units.text(process.spacing, "s"), **_written(process.marginal, process.unit)}))
    tables += [("[[variability.correlation]]", {"between": [a, b], "rank": rank}) for a, b, rank in found.correlations]
    return tables


def schema(many: Any, table: Any, quantity: Any, name: Any) -> dict[str, Any]:
    """The part of the JSON schema, by functions of scene.schema."""
    def words(known: Any) -> dict[str, Any]:
        return {"enum": list(known)}
    common = {"name": name, "distribution": words(DISTRIBUTIONS), **{key: quantity for key in PARAMETERS}}
    relative = {"type": "boolean", "description": "numbers are factors of the values of the scene"}
    return table(SETTINGS, (), method=words(METHODS), question=words(QUESTIONS),  # type: ignore[no-any-return]
                 scatter=many(table({}, ("distribution",), key=name,
                                    keys={"type": "array", "items": name, "minItems": 1},
                                    relative=relative, **common)),
                 field=many(table({"modes": Field("modes", "integer")}, ("distribution",), key=name,
                                  keys={"type": "array", "items": name,
                                        "minItems": 1}, kernel=words(KERNELS), **{"from": quantity, "to": quantity},
                                  correlation_length=quantity, spacing=quantity, relative=relative, **common)),
                 process=many(table({}, ("time_function", "distribution"), time_function=name, kernel=words(KERNELS),
                                    how=words(PROCESS),
                                    correlation_time=quantity, spacing=quantity, **common)),
                 correlation=many(table({}, ("between", "rank"), rank={"type": ["number", "string"]},
                                        between={"type": "array", "items": name, "minItems": 2, "maxItems": 2})))


__all__ = ["DISTRIBUTIONS", "Marginal", "RandomField", "RandomProcess", "Reader", "Scatter", "Variability"]
