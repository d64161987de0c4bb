"""A sample of a scene: standard normal numbers z to values of all that varies, and to changes of the scene file."""
from __future__ import annotations

import math
import re
from typing import Any

from .._optional import need
from ..enums import (SEGMENT_CONSTANT, SEGMENT_HARMONIC, SEGMENT_PERIODIC, SEGMENT_STEP, SEGMENT_STEP5, SEGMENT_TABLE,
                     SegmentKind)
from ..scene import Scene
from ..scene.fields import word_of
from ..scene.segments import value_at
from ..scene.units import text
from ..scene.variability import RandomField, RandomProcess, Scatter, normal_correlation
from .blas import one_thread
from .fields import Expansion, Markov, expansion
from .marginals import Translation


class CannotDraw(ValueError):
    """Something that varies and does not fit the scene."""


def value_of_segments(segments: list[dict[str, Any]], time: float) -> float:
    """A time function at a time, by its described segments."""
    numpy, total = need("numpy"), 0.0
    for segment in segments:
        kind = segment.get("kind", SEGMENT_TABLE if segment.get("table") else SEGMENT_CONSTANT)
        if kind in (SEGMENT_TABLE, SEGMENT_PERIODIC):
            times, values = zip(*segment["table"])
            total += float(numpy.interp(time, times, values, period=times[-1] - times[0] if kind == SEGMENT_PERIODIC
                                        else None))
        elif kind == SEGMENT_STEP5:
            d = min(max((time - segment.get("x0", 0.0)) / (segment.get("x1", 1.0) - segment.get("x0", 0.0)), 0.0), 1.0)
            total += segment.get("h0", 0.0) + (segment.get("h1", 0.0)
                                               - segment.get("h0", 0.0)) * d ** 3 * (10.0 - 15.0 * d + 6.0 * d * d)
        elif kind in (SEGMENT_CONSTANT, SEGMENT_STEP, SEGMENT_HARMONIC):
            total += value_at(time, segment)
        else:
            raise CannotDraw(f"a segment of kind {word_of(SegmentKind(kind))} cannot be multiplied, because its values "
                             "are known in the run only; use "
                             "how = \"added\"")
    return total


HARMONIC_PARTS, STEP_PARTS = 48, 32  #: rows of a period, of a step: straight lines between them are off by 0.2 %
PARTS = 8                            #: rows of a time function that changes, between two points of the process
LEAST_GAP = 4e-12                    #: [s] between rows; the library takes 1e-12
MOST_ROWS = 20_000                   #: of a time function that is multiplied by a process


def own_times(segments: list[dict[str, Any]], begin: float, end: float) -> Any:
    """[s] Times between which a time function is straight, or nearly so; peaks of harmonics among them."""
    numpy, found = need("numpy"), [need("numpy").zeros(0)]
    for segment in segments:
        kind = segment.get("kind", SEGMENT_TABLE if segment.get("table") else SEGMENT_CONSTANT)
        if kind in (SEGMENT_STEP, SEGMENT_STEP5):
            found.append(numpy.linspace(segment.get("x0", 0.0), segment.get("x1", 1.0), STEP_PARTS + 1))
        elif kind == SEGMENT_TABLE:
            found.append(numpy.array([time for time, _ in segment["table"]], dtype=float))
        elif kind == SEGMENT_PERIODIC:
            own = numpy.array([time for time, _ in segment["table"]], dtype=float)
            found.append(_repeated(own, own[-1] - own[0], begin, end))
        elif kind == SEGMENT_HARMONIC and segment.get("omega", 0.0) and segment.get("h1", 0.0):
            period = 2.0 * math.pi / abs(segment["omega"])
            first = -segment.get("phase", 0.0) / segment["omega"]
            found.append(_repeated(first + period / HARMONIC_PARTS * numpy.arange(HARMONIC_PARTS), period, begin, end))
    times = numpy.concatenate(found)
    return times[(times > begin) & (times < end)]


def _repeated(times: Any, period: float, begin: float, end: float) -> Any:
    """Times of one period in all periods between begin and end, at most somewhat more than MOST_ROWS."""
    numpy = need("numpy")
    first, last = math.floor((begin - times[0]) / period) - 1, math.ceil((end - times[0]) / period)
    count = min(last - first + 1, MOST_ROWS // len(times) + 2)
    return (times[None, :] + period * (first + numpy.arange(count))[:, None]).reshape(-1)


class Draw:
    """The parts of z are those of the scattered parameters, then of each field, then of each process, in the order of
    the scene file."""

    def __init__(self, scene: Scene) -> None:
        if scene.variability is None:
            raise CannotDraw("the scene has no [variability]")
        self.scene, self.varies = scene, scene.variability
        self.translations = {one.name: Translation(one.marginal)
                             for one in self.varies.parts}
        numpy = need("numpy")
        one_thread()
        self.mix = (numpy.linalg.cholesky(normal_correlation(self.varies)) if self.varies.scatters
                    else numpy.zeros((0, 0)))
        self.fields: list[tuple[RandomField, Expansion]] = [(one, self._field(one)) for one in self.varies.fields]
        self.processes: list[tuple[RandomProcess, Expansion | Markov, Any]] = [
            (one, *self._process(one)) for one in self.varies.processes]
        self._refuse_both()
        self._refuse_twice()
        self._factors = {one.name: self._base(one, times) for one, _, times in self.processes if one.how == "factor"}
        self.sizes = [len(self.varies.scatters), *(made.modes for _, made in self.fields),
                      *(made.modes for _, made, _ in self.processes)]
        self.dimension = sum(self.sizes)

    def _refuse_both(self) -> None:
        """A time function that a process replaces loses its scattered values."""
        for one in self.varies.processes:
            key = f"time_function[{self._time_function_number(one)}]"
            if any(name == key or name.startswith(key + ".") for scatter in self.varies.scatters
                   for name in scatter.keys) \
                    or sum(other.time_function == one.time_function for other in self.varies.processes) > 1:
                raise CannotDraw(f"{one.name}: the time function {one.time_function} varies by another key, too; use "
                                 "two time functions")

    def _refuse_twice(self) -> None:
        """A key that is written by two of them: one would be lost."""
        known: dict[str, str] = {}
        written: list[Scatter | RandomField] = [*self.varies.scatters, *self.varies.fields]
        for one in written:
            for key in {re.sub(r"\.pipes\[\d+\]\.", ".pipes.", re.sub(r"^hole\[0\]", "hole", key)) for key in one.keys}:
                other = known.setdefault(key, one.name)
                if other != one.name and (key.startswith("hole") or isinstance(one, RandomField)):
                    raise CannotDraw(f"{key} varies by {other} and by {one.name}; only one of them may write it")

    # ---- Where fields and processes live -----------------------------------------------------------------------------
    def _depths(self, one: RandomField) -> Any:
        """[m] of the sections of a field along the hole, spread evenly from end to end."""
        count = max(1, round((one.ends[1] - one.ends[0]) / one.spacing))
        return one.ends[0] + (one.ends[1] - one.ends[0]) * need("numpy").arange(count + 1) / count

    def _field(self, one: RandomField) -> Expansion:
        if one.ends[1]:
            return expansion(one.kernel, one.length, tuple(float(depth) for depth in self._depths(one)), one.modes)
        if one.key.startswith("hole.survey"):
            points = tuple(float(row[0]) for row in self._stations())
        else:
            points, at = (), 0.0
            for length, count in self._pipes(one):
                points += tuple(at + (i + 0.5) * length for i in range(count))
                at += length * count
        from ..scene.variability import MOST_POINTS
        if len(points) > MOST_POINTS:
            raise CannotDraw(f"{one.name}: the field has {len(points)} points, must be <= {MOST_POINTS}")
        return expansion(one.kernel, one.length, points, one.modes)

    def _stations(self) -> Any:
        return next(arguments[0].get("stations") for name, arguments in self.scene.model.calls if name == "add_wall")

    def _sections(self, key: str) -> list[tuple[int, dict[str, Any]]]:
        """Number and fields of the pipes of the string that a key names."""
        match = re.match(r"string\[(\d+)\]", key)
        number = int(match.group(1)) if match else 0
        strings = [made for made, (name, _) in zip(self.scene.model.ids, self._parts()) if name == "add_string"]
        return [(arguments[0], arguments[1]) for made, (name, arguments) in zip(self.scene.model.ids, self._parts())
                if name == "add_pipes" and made == strings[number]]

    def _parts(self) -> list[tuple[str, tuple[Any, ...]]]:
        return [one for one in self.scene.model.calls if one[0].startswith("add_") and one[0] != "add_hole_sections"]

    def _pipes(self, one: RandomField) -> list[tuple[float, int]]:
        return [(fields.get("length", 1.0), count) for count, fields in self._sections(one.key)]

    def _process(self, one: RandomProcess) -> tuple[Expansion | Markov, Any]:
        numpy = need("numpy")
        self._refuse_factor(one)
        end = self.scene.run.get("end", 0.0)
        if not end > 0.0:
            raise CannotDraw(f"{one.name}: a process in time needs [run] end")
        count = int(math.floor(end / one.spacing)) + 2
        times = numpy.arange(count) * one.spacing
        if one.kernel == "exponential":
            return Markov(one.length, one.spacing, count), times
        return expansion(one.kernel, one.length, tuple(times)), times

    # ---- One sample -------------------------------------------------------------------------------------------------
    def values(self, z: Any) -> dict[str, Any]:
        """Of each thing that varies by its name: a number, or an array along string, hole or time; of a process that
        multiplies a time function at the rows of their product."""
        numpy = need("numpy")
        z = numpy.asarray(z, dtype=float)
        if z.shape != (self.dimension,):
            raise ValueError(f"z has the shape {z.shape}, must be ({self.dimension},)")
        return self.values_of([z])[0]

    def values_of(self, many: Any) -> list[dict[str, Any]]:
        """The values of several samples, of each the same as alone: products row by row, distributions of all rows at
        once."""
        numpy = need("numpy")
        rows = numpy.asarray(many, dtype=float)
        parts = [rows[:, end - size:end] for size, end in zip(self.sizes, numpy.cumsum(self.sizes))]
        correlated = numpy.array([self.mix @ row for row in parts[0]])
        found: dict[str, Any] = {one.name: self.translations[one.name](correlated[:, i]).tolist()
                                 for i, one in enumerate(self.varies.scatters)}
        made = [(one.name, how) for one, how in self.fields] + [(one.name, how) for one, how, _ in self.processes]
        found.update({name: self.translations[name](how.many(part)) for (name, how), part in zip(made, parts[1:])})
        for one, _, times in self.processes:
            if one.how == "factor" and len(self._factors[one.name][0]) > len(times):
                found[one.name] = numpy.array([numpy.interp(self._factors[one.name][0], times, row)
                                               for row in found[one.name]])
        return [{name: values[i] for name, values in found.items()} for i in range(len(rows))]

    def mean(self, name: str, value: Any) -> float:
        """The value of a sample as one number: of fields and processes the mean."""
        if isinstance(value, float):
            return value
        times = next((times for one, _, times in self.processes if one.name == name), None)
        if times is not None and len(value) > len(times):
            value = need("numpy").interp(times, self._factors[name][0], value)
        return float(value.mean())

    def overrides(self, values: dict[str, Any]) -> dict[str, Any]:
        """Changes for scene.load that make the scene of one sample."""
        found: dict[str, Any] = {}
        for one in self.varies.scatters:
            for key, base, unit in zip(one.keys, one.base or (1.0,) * len(one.keys), one.units):
                found[key] = text(values[one.name] * base, unit)
        self._field_overrides(values, found)
        for process, _, times in self.processes:
            found.update(self._time_function(process, times, values[process.name]))
        found["variability"] = None  # nothing varies in the sample itself
        return found

    def _field_overrides(self, values: dict[str, Any], found: dict[str, Any]) -> None:
        survey = [one for one, _ in self.fields if one.key.startswith("hole.survey")]
        if survey:
            rows = [list(row) for row in self._stations()]
            for one in survey:
                column = 1 if one.key.endswith("inclination") else 2
                for row, error in zip(rows, values[one.name]):
                    row[column] = row[column] * error if one.relative else row[column] + error
                    if column == 1:
                        row[1:] = _beyond_vertical(row[1], row[2])
            found["hole.survey_file"] = found["hole.survey_columns"] = None
            found["hole.survey"] = [[text(float(number), unit) for number, unit in zip(row, ("m", "rad", "rad"))]
                                    for row in rows]
        along = [one for one, _ in self.fields if one.ends[1]]
        if along:
            found["hole.section"] = self._hole_sections(along, values)
        for key in dict.fromkeys(one.key.split(".")[0] for one, _ in self.fields if one.key.startswith("string")):
            found[f"{key}.pipes"] = self._pipe_tables(key, values, found)

    def _hole_sections(self, along: list[RandomField], values: dict[str, Any]) -> list[dict[str, Any]]:
        """Sections at all depths of all fields, lines between them. A parabola rounds each breakpoint
        (`transition`)."""
        numpy = need("numpy")
        depths = sorted({float(depth) for one in along for depth in self._depths(one)})
        depths = [depth for i, depth in enumerate(depths) if i == 0 or depth - depths[i - 1] > 1e-6 * one_span(along)]
        room = min((b - a for a, b in zip(depths, depths[1:])), default=0.2)
        tables: list[dict[str, Any]] = [{"depth": text(depth, "m"), "shape": "line",
                                         "transition": text(0.5 * room, "m")} for depth in depths]
        for one in along:
            at = numpy.interp(depths, self._depths(one), values[one.name])
            for key, base, unit in zip(one.keys, one.base or (1.0,) * len(one.keys), one.units):
                for table, value in zip(tables, at):
                    table[key[5:]] = text(float(value) * base, unit)
        tables[-1]["shape"] = "step"
        return tables

    def _pipe_tables(self, string: str, values: dict[str, Any], found: dict[str, Any]) -> list[dict[str, Any]]:
        """One table for each pipe, with its own values and those that scatter for all."""
        from ..scene import fields as known
        struct = known.fields_of(known.DEFINITIONS["pipes"])
        tables, at = [], 0
        for section, (count, fields) in enumerate(self._sections(string)):
            own = {key: known.write(struct[key], value) for key, value in fields.items() if key in struct
                   and key != "string"}
            for key in [key for key in found if re.fullmatch(re.escape(string) + rf"\.pipes(\[{section}\])?\.\w+",
                                                             key)]:
                own[key.rsplit(".", 1)[1]] = found[key]
            for pipe in range(count):
                one = dict(own, count=1, **({"seed": int(fields.get("seed", 1)) + pipe}))
                for varied, _ in self.fields:
                    if varied.key.startswith(string + "."):
                        name = varied.key.rsplit(".", 1)[1]
                        value = float(values[varied.name][at + pipe])
                        one[name] = text(value * fields.get(name, getattr(known.DEFINITIONS["pipes"](), name))
                                         if varied.relative else value, struct[name].unit or "-")
                tables.append(one)
            at += count
        for key in [key for key in found if key.startswith(string + ".pipes")]:
            del found[key]  # they stand in the tables now
        return tables

    def _refuse_factor(self, one: RandomProcess) -> None:
        """A factor of a time function whose values are not known before the run, once for all samples."""
        if one.how == "factor":
            try:
                value_of_segments(self._segments(one), 0.0)
            except CannotDraw as error:
                raise CannotDraw(f"{one.name}: time function {one.time_function}: {error}") from None

    def _segments(self, one: RandomProcess) -> list[dict[str, Any]]:
        """The described segments of the time function of a process."""
        return list([arguments for name, arguments in self._parts()
                     if name == "add_time_function"][self._time_function_number(one)])

    def _time_function_number(self, one: RandomProcess) -> int:
        made = [made for made, (name, _) in zip(self.scene.model.ids, self._parts()) if name == "add_time_function"]
        return made.index(self.scene.names[one.time_function])

    def _time_function(self, one: RandomProcess, times: Any, factors: Any) -> dict[str, Any]:
        number = self._time_function_number(one)
        segments = self._segments(one)
        unit = self.scene.time_function_units[one.time_function]
        if one.how == "added":
            rows = [[text(float(t), "s"), text(float(v), unit)] for t, v in zip(times, factors)]
            return {f"time_function[{number}].segment": [*self._written(segments, unit), {"table": rows}]}
        rows = [[text(float(t), "s"), text(float(b * v), unit)]
                for t, b, v in zip(*self._factors[one.name], factors)]
        return {f"time_function[{number}].segment": [{"table": rows}]}

    def _base(self, one: RandomProcess, times: Any) -> tuple[Any, Any]:
        """Times [s] of a time function that a process multiplies, those of the process among them, and its values."""
        numpy, segments = need("numpy"), self._segments(one)
        at, own = numpy.asarray(times, dtype=float), own_times(segments, float(times[0]), float(times[-1]))
        if len(own):  # the product of two slopes is a parabola
            at = numpy.linspace(at[0], at[-1], PARTS * (len(at) - 1) + 1)
        at = numpy.union1d(at, own)
        at = at[numpy.append(True, numpy.diff(at) > LEAST_GAP)]
        if len(at) > MOST_ROWS:
            raise CannotDraw(f"{one.name}: the time function {one.time_function} changes so fast that its product with "
                             f"the process takes more than {MOST_ROWS} rows of a table; use how = \"added\", or give "
                             "the process a time function of its own")
        return at, numpy.array([value_of_segments(segments, float(time)) for time in at])

    def _written(self, segments: list[dict[str, Any]], unit: str) -> list[dict[str, Any]]:
        from ..scene import fields as known
        struct = known.fields_of(known.DEFINITIONS["segment"])
        found = []
        for segment in segments:
            one = {key: known.write(struct[key], value, unit if key in ("h0", "h1") else None)
                   for key, value in segment.items() if key in struct and key != "of"}
            if "of" in segment:
                one["of"] = next(name for name, part in self.scene.names.items() if part == segment["of"])
            if segment.get("table"):
                one["table"] = [[text(float(t), "s"), text(float(v), unit)] for t, v in segment["table"]]
            found.append(one)
        return found


def _beyond_vertical(inclination: float, azimuth: float) -> tuple[float, float]:
    """[rad] Inclination and azimuth of the same direction with the inclination within 0 .. pi: a hole that passes the
    vertical tilts to the other side."""
    inclination = math.fmod(inclination, 2.0 * math.pi)
    if abs(inclination) > math.pi:
        inclination -= math.copysign(2.0 * math.pi, inclination)
    if inclination >= 0.0:
        return inclination, azimuth
    return -inclination, azimuth + (math.pi if azimuth <= 0.0 else -math.pi)


def one_span(along: list[RandomField]) -> float:
    """[m] from the first to the last section."""
    return max(one.ends[1] for one in along) - min(one.ends[0] for one in along)


__all__ = ["CannotDraw", "Draw", "value_of_segments"]
