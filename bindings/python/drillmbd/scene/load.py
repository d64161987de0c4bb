"""Reads a scene file and makes its model; reports all its faults at once."""
from __future__ import annotations

import copy
import functools
import os
import pathlib
import re
from collections.abc import Callable, Mapping
from typing import Any

from .. import enums
from .._keep import station
from .._structs import Output, Id, Motor, Place, Segment
from ..errors import Error
from ..model import Model, motor_drive
from . import catalogue, failure, fields, hole, units, variability, viscometer
from .settings import SettingsReader
from .overrides import apply
from .content import ANALYSES, NAMED, PARTS, SINGLE, Scene
from .divide import Divided, divide
from .fields import DEFINITIONS, Field, ValueProblem, fields_of
from .lines import Path, find_lines
from .problems import Problem, Problems, SceneError, meant
from .read_file import TooLarge, limited
from .source import Source
from .sub import Subs
from .segments import by_numbers

MOST_BYTES = 50_000_000
#: [s] damping_time of pipes that a scene file does not give: 0.03 % of critical damping at 1 Hz, 3 % at 100 Hz. Without
#: any, vibrations of a run do not decay.
USUAL_DAMPING = 1e-4


def load(path: Any, changes: Mapping[str, Any] | None = None) -> Scene:
    """The scene of a TOML file; changes: values by their keys, "hole.diameter", instead of those of the file. Raises
    SceneError with everything that is wrong, OSError where it cannot be read."""
    path = pathlib.Path(path)
    try:
        data = limited(path, MOST_BYTES)
    except TooLarge as error:
        raise SceneError(str(path), [Problem(1, "the file", None, str(error))]) from error
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data[:error.start].count(b"\n") + 1
        raise SceneError(str(path), [Problem(line, "the file", None, "must be text in UTF-8")]) from error
    return loads(text, str(path), path.parent, changes)


def loads(text: str, name: str = "scene", folder: Any = ".", changes: Mapping[str, Any] | None = None) -> Scene:
    """The scene of a TOML text; files that it names are searched in `folder`."""
    import tomllib
    try:
        content = tomllib.loads(text)
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        match = re.search(r"line (\d+)", str(error))
        line = int(match.group(1)) if match else text.count("\n") + 1
        raise SceneError(name, [Problem(line, "the file", None, f"is no TOML: {error}")]) from error
    except ValueError as error:  # a whole number longer than Python reads
        long = re.search(r"\d[\d_]{4000,}", text)
        line = text.count("\n", 0, long.start()) + 1 if long else 1
        raise SceneError(name, [Problem(line, "the file", None, "has a number of too many digits")]) from error
    problems = Problems(find_lines(text))
    apply(content, changes or {}, problems)
    catalogue.expand(content, problems, folder)
    scene, divided = _scene_of(copy.deepcopy(content), problems, folder, name)
    if divide(scene, divided, content):
        scene, _ = _scene_of(content, problems, folder, name, divided)
    assert scene.source is not None
    scene.source.read(text)
    scene.changed = functools.partial(_changed, text, name, folder, dict(changes or {}))
    return scene


def _changed(text: str, name: str, folder: Any, before: dict[str, Any], changes: Mapping[str, Any]) -> Scene:
    """The scene of the same text with more changes."""
    return loads(text, name, folder, {**before, **changes})


def _scene_of(content: dict[str, Any], problems: Problems, folder: Any, name: str,
              divided: list[Divided] | None = None) -> tuple[Scene, list[Divided]]:
    """The scene of a content, and its pipes whose number of elements is not given. divided: of an earlier reading."""
    loader = Loader(content, problems, pathlib.Path(folder))
    scene = loader.scene()
    if loader.problems.found:
        raise SceneError(name, loader.problems.found)
    assert scene is not None
    scene.remarks = problems.remarks
    scene.divided = [one for one in divided or [] if one.elements > 1]
    return scene, loader.undivided

#: Kinds of the parts that a key names; those of other keys: any part.
NAMES_OF = {"time_function": ("time_function",), "excitation": ("time_function",), "load": ("time_function",),
            "string": ("string",), "stabiliser": ("stabiliser",),
            "input": ("input",), "body": ("body",), "third_joint": ("joint",), "fourth_joint": ("joint",)}


class Loader:
    """Goes through the content: names, units of time functions, then part by part into the model."""

    def __init__(self, content: dict[str, Any], problems: Problems, folder: pathlib.Path) -> None:
        self.content, self.problems, self.folder = content, problems, folder
        self.model, self.names = Model(), dict[str, Any]()  # name -> id, None where it was refused
        self.kinds: dict[str, str] = {}                     # name -> "string", "drive", ...
        self.pipes: dict[str, int] = {}                     # string -> number of its pipes
        self.units: dict[str, str] = {}                     # time function -> unit
        self.segments: dict[str, list[dict[str, Any]]] = {}    # time function -> its segments, plain
        self.paths: dict[tuple[str, str], Path] = {}        # (kind, name) -> its table
        self.unused: list[tuple[Path, str]] = []            # time functions, and the fault if no other one is the cause
        self.inline: set[str] = set()                       # time functions that are values in the place of names
        self.undivided: list[Divided] = []                  # pipes whose number of elements is not given
        self.subs = Subs(self)

    # ---- Shape of the file ------------------------------------------------------------------------------------------
    def scene(self) -> Scene | None:
        """The whole."""
        known = ["title", "catalogue", "run", "results", "limits", "output", "time_function", "sub", *SINGLE, *PARTS,
                 *ANALYSES, "compile", "sim", "variability",
                 "failure"]
        for key in self.content:
            if key not in known:
                self.problems.unknown((key,), known)
        title = self.content.get("title", "")
        if not isinstance(title, str):
            self.problems.add(("title",), title, "must be a text")
        self._collect_names()
        self._find_time_function_units()
        self._describe()
        scene = Scene(title=str(title), model=self.model, names={n: i for n, i in self.names.items() if i is not None},
                      pipes=self.pipes, time_function_units=self.units, source=Source(self.paths), inline=self.inline)
        SettingsReader(self).settings(scene)
        scene.variability = variability.Reader(self).variability()
        scene.failures = failure.Reader(self, scene.limits).failures()
        compiled = self.read(("compile",), self.table(("compile",)), fields_of(DEFINITIONS["compile"]))
        for path, text in self.unused if not self.problems.found else []:
            self.problems.add(path, None, text)
        if not self.problems.found:
            self._compile(compiled)
        return None if self.problems.found else scene

    def table(self, path: Path) -> dict[str, Any]:
        value: Any = self.content
        for part in path:
            if isinstance(value, list) and isinstance(part, int) and part < len(value):
                value = value[part]
            else:
                value = value.get(part, {}) if isinstance(value, dict) else {}
        if not isinstance(value, dict):
            self.problems.add(path, value, "must be a table")
            return {}
        return value

    def tables(self, holder: dict[str, Any], path: Path, key: str) -> list[tuple[Path, dict[str, Any]]]:
        """An array of tables below a table; one table counts as an array of one."""
        value = holder.get(key, [])
        value = [value] if isinstance(value, dict) else value
        if not isinstance(value, list):
            self.problems.add(path + (key,), value, f"must be an array of tables: [[{key}]]")
            return []
        found = []
        for number, one in enumerate(value):
            here = path + ((key, number) if isinstance(holder.get(key), list) else (key,))
            if isinstance(one, dict):
                found.append((here, one))
            else:
                self.problems.add(here, one, "must be a table")
        return found

    def parts(self, kind: str) -> list[tuple[Path, dict[str, Any]]]:
        """All tables of a kind of part."""
        return self.tables(self.content, (), kind)

    # ---- Names ------------------------------------------------------------------------------------------------------
    def _collect_names(self) -> None:
        own = [(kind, f"{kind}-{number + self.subs.offset(kind)}", path, table)
               for kind in ("time_function", *PARTS) for number, (path, table) in enumerate(self.parts(kind))]
        for kind, by_number, path, table in own + self.subs.names():
            name = table.get("name", by_number) if isinstance(table, dict) else by_number
            if not isinstance(name, str) or not name:
                self.problems.add(path + ("name",), name, "must be a text that is not empty")
            elif name in self.kinds:
                self.problems.add(path + ("name",), name,
                                  f"names a {self.kinds[name].replace('_', ' ')} already; every name once")
            else:
                self.kinds[name] = kind
                self.paths[kind, name] = path

    def put(self, name: str, kind: str, made: Id | None) -> None:
        """Notes the id of a part, if the name is its own."""
        if self.kinds.get(name) == kind:
            self.names[name] = made

    def name(self, kind: str, number: int, table: dict[str, Any]) -> str:
        by_number = f"{kind}-{number + self.subs.offset(kind)}"
        name = table.get("name", by_number)
        return name if isinstance(name, str) and name else by_number

    def _find_time_function_units(self) -> None:
        """A time function has the unit of the drive, load or bit that uses it."""
        uses: list[tuple[Path, Any, str]] = []
        for path, table in self.parts("drive"):
            uses += [(path + (key,), table.get(key), self.drive_unit(table)) for key in ("time_function", "excitation")]
        uses += [(path + ("load",), table.get("load"), "N") for path, table in self.parts("bit")]
        uses += [(path + ("time_function",), table.get("time_function"), "-") for path, table in self.parts("load")]
        for path, table in self.parts("time_function"):
            uses += [(where + ("of",), one["of"], "rad/s") for where, one in self._segments(path, table) if "of" in one]
        for path, name, unit in uses:
            if isinstance(name, str) and self.kinds.get(name) == "time_function":
                if self.units.setdefault(name, unit) != unit:
                    self.problems.add(path, name, f"is used in {self.units[name]} elsewhere and in {unit} here; "
                                                  "make two time functions")

    def _segments(self, path: Path, table: dict[str, Any]) -> list[tuple[Path, dict[str, Any]]]:
        """The segments of a time function that are tables; others are refused later."""
        given = table.get("segment")
        found: list[tuple[Path, Any]] = [(path + ("segment",), given)]
        if isinstance(given, list):
            found = [(path + ("segment", number), one) for number, one in enumerate(given)]
        return [(where, one) for where, one in found if isinstance(one, dict)]

    def drive_unit(self, table: dict[str, Any]) -> str:
        """The unit of the time function of a drive."""
        known = fields_of(DEFINITIONS["drive"])
        return fields.drive_unit(*(self.word(known[key], table.get(key), 0) for key in ("kind", "component")))

    def word(self, field: Field, value: Any, default: int) -> int:
        try:
            return default if value is None else int(fields.read(field, value))
        except ValueProblem:
            return default

    # ---- One table --------------------------------------------------------------------------------------------------
    def read(self, path: Path, table: dict[str, Any], known: dict[str, Field], extra: tuple[str, ...] = (),
             unit_of: Callable[[str], str | None] = lambda name: None) -> dict[str, Any]:
        """The plain values of a table; wrong ones become problems and are left out. `extra` keys are the caller's."""
        found = {}
        for key, value in table.items():
            if key in extra:
                continue
            if key not in known:
                self.problems.unknown(path + (key,), [*known, *extra])
                continue
            field = known[key]
            if field.kind in ("id", "place"):
                made = self._reference(path + (key,), field, value)
                if made is not None:
                    found[key] = made
                continue
            try:
                found[key] = fields.read(field, value, unit_of(key))
                if self._is_outside(path + (key,), field, value, found[key]):
                    del found[key]
                    continue
                self.problems.remark(path + (key,), value, fields.remark(field, value, unit_of(key)))
            except ValueProblem as error:
                self.problems.add(path + (key,), value, str(error))
        return found

    def _is_outside(self, path: Path, field: Field, written: Any, value: Any) -> bool:
        """Whether a number of a setting is outside its range, which becomes a problem."""
        reason = next(filter(None, (field.outside(float(one))
                                    for one in (value if isinstance(value, (list, tuple)) else [value])
                                    if isinstance(one, (int, float)))), "")
        if reason:
            self.problems.add(path, written, reason)
        return bool(reason)

    def _reference(self, path: Path, field: Field, value: Any) -> Any:
        if field.kind == "place":
            return self._place(path, value)
        if field.count:
            if not isinstance(value, list) or len(value) != field.count:
                self.problems.add(path, value, f"must be an array of {field.count} names")
                return None
            made = [self._id(path, one) for one in value]
            return None if None in made else made
        return self._id(path, value)

    def _id(self, path: Path, value: Any) -> Id | None:
        if isinstance(value, str) and value in self.names:
            return self.names[value]  # type: ignore[no-any-return]
        if not isinstance(value, str) or value not in self.kinds:
            wanted = next((part for part in reversed(path) if isinstance(part, str)), "part")
            kinds = NAMES_OF.get(wanted, PARTS)
            self.problems.add(path, value, f"names no {kinds[0].replace('_', ' ') if len(kinds) == 1 else 'part'}"
                              + meant(str(value), [name for name, kind in self.kinds.items() if kind in kinds]))
        elif not self.problems.found:
            self.problems.add(path, value,
                              f"names a {self.kinds[value].replace('_', ' ')} that is made after this; time functions "
                              "come first, "
                                           "then strings, subs, bodies, bits, stabilisers, joints, couplings, drives, "
                                           "loads, springs, "
                                           "stuck places, inputs")
        return None

    def _place(self, path: Path, value: Any) -> Place | None:
        if isinstance(value, str):
            value = {"part": value}
        if not isinstance(value, dict) or "part" not in value:
            self.problems.add(path, value, 'must be a name, or a table as {part = "main", pipe = 3, fraction = 1.0}')
            return None
        for key in value:
            if key not in ("part", "pipe", "fraction"):
                self.problems.unknown(path + (key,), ("part", "pipe", "fraction"))
        name, pipe, fraction = value["part"], value.get("pipe", 0), value.get("fraction", 0.0)
        part = self._id(path + ("part",), name)
        pipes = self.pipes.get(name, 0) if isinstance(name, str) else 0
        pipe = pipes - 1 if pipe == "last" and pipes else pipe
        if isinstance(pipe, bool) or not isinstance(pipe, int) or pipe < 0 or (pipes and pipe >= pipes):
            bound = f"0 .. {pipes - 1}" if pipes else ">= 0"
            self.problems.add(path + ("pipe",), value.get("pipe"), f'must be a whole number {bound}, or "last"')
            return None
        if isinstance(fraction, bool) or not isinstance(fraction, (int, float)) or not 0 <= fraction <= 1:
            self.problems.add(path + ("fraction",), fraction, "must be a number 0 .. 1")
            return None
        return None if part is None else station(part, pipe, float(fraction))

    # ---- Parts into the model ---------------------------------------------------------------------------------------
    def add(self, path: Path, add: Callable[..., Any], struct: Any, values: dict[str, Any]) -> Any:
        """The id of the added part. Each field that the library refuses becomes a problem; it is left out then, so that
        the next one is found."""
        values = dict(values)
        while True:
            try:
                return add(struct(**values))
            except Error as error:
                field = re.match(r"\w*", error.field or "")
                name = field.group(0) if field else ""
                known = fields_of(struct).get(name)
                unit = f" (in {known.unit})" if known and known.unit not in ("", "-") else ""
                if self._follows_from_refused(path, name, values, str(error.bound or error.message)):
                    if values.pop(name, None) is None:
                        return None
                    continue
                written = self.written(path + (name,))
                message = error.message.removeprefix(f"{error.part}: ")
                text = f"must {error.bound}{unit}" if error.bound and name in values else message
                self.problems.add(path + (name,) if name in values else path, written if name in values else None, text)
                if values.pop(name, None) is None:
                    return None
            except ValueError as error:
                self.problems.add(path, None, str(error))
                return None

    def _follows_from_refused(self, path: Path, name: str, values: dict[str, Any], text: str) -> bool:
        """Whether the library refuses a default instead of a value that was refused, or a value beside it."""
        refused = self.problems.refused_below(path) & set(self.table(path))
        return ((name in refused and name not in values) or any(re.search(rf"\b{one}\b", text)
                                                                for one in refused - {name}))

    def written(self, path: Path) -> Any:
        value: Any = self.content
        for part in path:
            try:
                value = value[part]
            except (KeyError, IndexError, TypeError):
                return None
        return value

    def _describe(self) -> None:
        if "environment" in self.content:
            values = self.read(("environment",), self.table(("environment",)), fields_of(DEFINITIONS["environment"]),
                               ("viscometer",))
            mud = self._viscometer(("environment", "viscometer"), self.table(("environment",)))
            if mud is not None:  # else the library would miss the constants that follow from it
                self.add(("environment",), self.model.set_environment, DEFINITIONS["environment"], {**values, **mud})
        if "hole" in self.content:
            hole.describe(self)
        for number, (path, table) in enumerate(self.parts("time_function")):
            self._time_function(path, self.name("time_function", number, table), table)
        for number, (path, table) in enumerate(self.parts("string")):
            self._string(path, self.name("string", number, table), table)
        self.subs.describe()
        for kind in PARTS[1:]:
            for number, (path, table) in enumerate(self.parts(kind)):
                self._part(kind, path, self.name(kind, number, table), table)

    def _viscometer(self, path: Path, environment: dict[str, Any]) -> dict[str, float] | None:
        """The constants of the mud by the readings of a viscometer; None where they are refused."""
        given = environment.get("viscometer")
        if given is None:
            return {}
        for key in {"consistency", "flow_exponent", "yield_stress"} & set(environment):
            self.problems.add(path[:1] + (key,), environment[key], "must be left out with viscometer, which gives it")
        if not isinstance(given, dict) or not all(re.fullmatch(r"\d+", key) and type(one) in (int, float)
                                                  for key, one in given.items()):
            self.problems.add(path, given,
                              "must be a table of readings in degrees by speed in rpm, as {600 = 52, 300 = 34}")
            return None
        try:
            mud = viscometer.fit([(float(key), float(one)) for key, one in given.items()])
        except ValueError as error:
            self.problems.add(path, None, str(error))
            return None
        return {"yield_stress": mud.yield_stress, "consistency": mud.consistency, "flow_exponent": mud.flow_exponent}

    def _time_function(self, path: Path, name: str, table: dict[str, Any]) -> None:
        for key in table:
            if key not in ("name", "unit", "segment"):
                self.problems.unknown(path + (key,), ("name", "unit", "segment"))
        unit = self.units.get(name) or table.get("unit")
        if not isinstance(unit, str):
            self.unused.append((path,
                                f"time function {name} is used by no drive, load or bit: take it out, or give its "
                                "unit"))
            return
        self.units[name] = unit
        segments = self.tables(table, path, "segment")
        if not segments:
            self.problems.add(path, None, "must have at least one segment")
        plain = [one for one in (self._segment(where, segment, unit) for where, segment in segments) if one is not None]
        if segments and len(plain) == len(segments):
            self.put(name, "time_function", self._add_time_function(path, plain))
            self.segments[name] = plain
        else:
            self.put(name, "time_function", None)

    def _add_time_function(self, path: Path, plain: list[dict[str, Any]]) -> Any:
        try:
            segments = [Segment(**one) for one in plain]
            plain[:] = [segment.describe() for segment in segments]  # as a saved file has them
            return self.model.add_time_function(*segments)
        except Error as error:
            self.problems.add(path, None, error.message)
        except ValueError as error:
            self.problems.add(path, None, str(error))
        return None

    def _segment(self, path: Path, table: dict[str, Any], unit: str) -> dict[str, Any] | None:
        """The fields of a Segment."""
        before = len(self.problems.found)
        try:
            units.factor_and_kind(unit)
        except units.UnitError as error:
            self.problems.add(path[:2] + ("unit",), unit, str(error))
            return None
        values = self.read(path, table, fields_of(DEFINITIONS["segment"]), ("table", "of"),
                           lambda name: unit if name in ("h0", "h1") else None)
        kind = values.get("kind")
        if kind == enums.SEGMENT_CALLBACK:
            self.problems.add(path + ("kind",), "callback", "is for programs; a file has tables")
        if kind == enums.SEGMENT_PER_REVOLUTION:
            self._per_revolution(path, table, values, unit)
        for key in (key for key in ("of", "share", "order") if key in table and kind != enums.SEGMENT_PER_REVOLUTION):
            self.problems.add(path + (key,), table[key], 'belongs to segments with kind = "per-revolution"')
        if "table" in table:
            values["table"] = self.pairs(path + ("table",), table["table"], "s", unit, "time and value")
            if kind not in (None, enums.SEGMENT_TABLE, enums.SEGMENT_PERIODIC):
                self.problems.add(path + ("kind",), table["kind"],
                                  'must be "table" or "periodic" with a table; leave out the one or the other')
            if kind != enums.SEGMENT_PERIODIC:
                values.pop("kind", None)
        elif kind in (enums.SEGMENT_TABLE, enums.SEGMENT_PERIODIC):
            self.problems.add(path, None, 'must have a table, as table = [["0 s", "0 m/s"], ["1 s", "0.1 m/s"]]')
        return values if len(self.problems.found) == before else None

    def _per_revolution(self, path: Path, table: dict[str, Any], values: dict[str, Any], unit: str) -> None:
        of = table.get("of")
        if not isinstance(of, str) or of not in self.segments:
            self.problems.add(path + ("of",), of, "must name a time function that stands before this one"
                              + meant(str(of), list(self.segments)))
            return
        if any(not by_numbers(segment) for segment in self.segments[of]):
            self.problems.add(path + ("of",), of, "must name a time function without segments per revolution")
        if values.get("share") and unit != "rad/s":
            self.problems.add(path + ("share",), table["share"],
                              f"is of a speed in rad/s, and this time function is in {unit}; use h1")
        values["of"] = self.names.get(of)

    def pairs(self, path: Path, rows: Any, first: str, second: str, what: str) -> list[tuple[float, float]]:
        """A table of pairs in those units."""
        found: list[tuple[float, float]] = []
        if not isinstance(rows, list) or not rows:
            self.problems.add(path, rows, f"must be an array of pairs of {what}")
            return found
        for number, row in enumerate(rows):
            if not isinstance(row, list) or len(row) != 2:
                self.problems.add(path + (number,), row, f"must be a pair of {what}")
                continue
            try:
                found.append((units.parse(row[0], first), units.parse(row[1], second)))
                self.problems.remark(path, None, units.remark(row[1], second))
            except units.UnitError as error:
                self.problems.add(path + (number,), row, str(error))
        return found

    def _string(self, path: Path, name: str, table: dict[str, Any]) -> None:
        values = self.read(path, table, fields_of(DEFINITIONS["string"]), ("name", "pipes"))
        self.own_name(path, table, values)
        string = self.add(path, self.model.add_string, DEFINITIONS["string"], values)
        self.put(name, "string", string)
        self.pipes_of(path, name, table, string)

    def pipes_of(self, path: Path, name: str, table: dict[str, Any], string: Id | None) -> None:
        """The pipes of a string, which is None where it was refused."""
        self.pipes[name] = 0
        sections = self.tables(table, path, "pipes")
        if not sections:
            self.problems.add(path, None,
                              f"must have pipes: [[{'.'.join(one for one in path if isinstance(one, str))}.pipes]]")
        for where, section in sections:
            count = section.get("count", 1)
            if isinstance(count, bool) or not isinstance(count, int) or not 1 <= count <= 2 ** 20:
                self.problems.add(where + ("count",), count, "must be a whole number 1 .. 2^20")
                count = 1
            known = {key: field for key, field in fields_of(DEFINITIONS["pipes"]).items() if key != "string"}
            plain = self.read(where, section, known, ("count", "pipe"))
            # its diameters are not known: no second fault of the default ones
            if "pipe" in self.problems.refused_below(where):
                plain = {key: value for key, value in plain.items() if key == "length"}
            if 0.0 < plain.get("joint_outer_diameter", 0.0) < plain.get("outer_diameter", 0.073) - 1e-6:
                self.problems.remark(where + ("joint_outer_diameter",), section["joint_outer_diameter"],
                                     "is smaller than the pipe's outer_diameter")
            if string is not None:
                plain["string"] = string
                plain.setdefault("damping_time", USUAL_DAMPING)
                self.add(where, lambda one, n=count: self.model.add_pipes(n, one),
                          DEFINITIONS["pipes"], plain)
            if "elements" not in section:
                self.undivided.append(Divided(name, where, self.pipes[name], count))
            self.pipes[name] += count

    def _part(self, kind: str, path: Path, name: str, table: dict[str, Any]) -> None:
        struct, before = DEFINITIONS[kind], len(self.problems.found)
        known = {key: field for key, field in fields_of(struct).items() if key != "name"}
        if kind == "event":
            self._event(path, name, table)
            return
        table = dict(table)
        motor = self._motor(path, table) if kind == "drive" and "motor" in table else {}
        self._inline_time_functions(kind, path, table)
        component = self.word(fields_of(DEFINITIONS["drive"])["component"], table.get("component"), 0)
        special = {key: fields.by_component(known[key].unit, component)
                   for key in fields.OF_COMPONENT if kind == "drive"}
        if kind == "input":
            special = self._setting_units(known, table)
        values = self.read(path, table, known,
                           {"spring": ("name", "table"), "drive": ("name", *fields.DRIVE_PAIRS)}.get(kind, ("name",)),
                           special.get)
        for key in fields.DRIVE_PAIRS if kind == "drive" else ():
            if key in table:
                values[key] = self.pairs(path + (key,), table[key], fields.by_component("m/s, rad/s", component),
                                          fields.by_component("N, N m", component), "speed and force")
        values.update(motor)
        if kind == "spring" and "table" in table:
            values["table"] = self.pairs(path + ("table",), table["table"], "m", "N", "elongation and force")
        if kind == "input":
            table["name"] = name
        if kind in NAMED:
            self.own_name(path, table, values)
        if kind == "drive" and "time_function" not in table:
            held = "0 m/s" if component < 3 else "0 rpm"
            self.problems.add(path, None, "must have a time function: the name of one, or a constant as "
                              f'time_function = "{held}" (a motion that is held)')
        refused = any(isinstance(value, str) and self.names.get(value, "") is None for value in table.values())
        self.put(name, kind, None)
        if not refused and not (kind == "drive" and "time_function" not in values) and not (
                len(self.problems.found) > before and kind in ("joint", "coupling", "spring", "input", "load")):
            self.put(name, kind, self.add(path, getattr(self.model, "add_" + kind), struct, values))

    def _motor(self, path: Path, table: dict[str, Any]) -> dict[str, Any]:
        """The keys that make a drive a mud motor; its set point is the no-load speed, where the drive has no time
        function."""
        given, before, where = table.pop("motor"), len(self.problems.found), path + ("motor",)
        table.update(kind="control", component="rx",
                     **({} if "time_function" in table else {"time_function": "0 rad/s"}))
        if not isinstance(given, dict):
            self.problems.add(where, given, "must be a table of the keys of a mud motor")
            return {}
        values = self.read(where, given, fields_of(Motor), ("table",))
        if "table" in given:
            values["table"] = self.pairs(where + ("table",), given["table"], "rad/s", "N m", "speed and torque")
        for key in ("gain", "gain_table", "integral_gain", "limit_low", "limit_high"):
            if key in table:
                self.problems.add(path + (key,), table[key], "must be left out with motor, which says it")
        if len(self.problems.found) > before:
            return {}
        try:
            drive, speed = motor_drive(**values)
        except (Error, ValueError) as error:
            self.problems.add(where, None,
                              f"{error}: must have flow with displacement and stall_torque or pressure, or with a "
                              "table "
                                           "of 2 .. 15 increasing speeds from 0 to no load, where the torque is 0")
            return {}
        if table["time_function"] == "0 rad/s":
            table["time_function"] = f"{speed!r} rad/s"
        return drive.describe()

    def own_name(self, path: Path, table: dict[str, Any], values: dict[str, Any]) -> None:
        """The name goes to the library too, where it is a text at all."""
        name = table.get("name")
        if not isinstance(name, str) or not name:
            return
        try:
            values["name"] = fields.read(fields_of(DEFINITIONS["string"])["name"], name)
        except ValueProblem as error:
            self.problems.add(path + ("name",), name, str(error))

    def _event(self, path: Path, name: str, table: dict[str, Any]) -> None:
        """quantity and place are the output, whose unit the level has."""
        known, before = fields.event_fields(), len(self.problems.found)
        quantity = self.word(known["quantity"], table.get("quantity"), -1)
        values = self.read(path, table, known, ("name",), {"level": self.output_unit(quantity, table.get("place"))}.get)
        if "quantity" not in table:
            self.problems.add(path, None, "must have a quantity, that of a output")
        self.put(name, "event", None)
        if len(self.problems.found) > before:
            return
        out = Output(place=values.pop("place", Place()), quantity=values.pop("quantity"))
        values["name"] = name
        self.put(name, "event", self.add(path, self.model.add_event, DEFINITIONS["event"], {**values, "output": out}))

    def output_unit(self, quantity: int, place: Any) -> str:
        """The unit of a output at a place as the file names it."""
        return fields.unit_of_output(quantity, self.setting_unit(place), self._component(place))

    def _component(self, place: Any) -> int | None:
        """The component of the drive that a place names."""
        name, known = place.get("part") if isinstance(place, dict) else place, fields_of(DEFINITIONS["drive"])
        return next((self.word(known["component"], drive.get("component"), 0) for number, (_, drive)
                     in enumerate(self.parts("drive")) if self.name("drive", number, drive) == name), None)

    def setting_unit(self, place: Any) -> str | None:
        """The unit of the input that a place names."""
        name = place.get("part") if isinstance(place, dict) else place
        known = fields_of(DEFINITIONS["input"])
        return next((self._setting_units(known, one)["initial"] for number, (_, one) in enumerate(self.parts("input"))
                     if self.name("input", number, one) == name), None)

    def _setting_units(self, known: dict[str, Field], table: dict[str, Any]) -> dict[str, str]:
        """Units of an input: those of the quantity that it sets."""
        part, drive = table.get("part"), None
        for number, (_, one) in enumerate(self.parts("drive")):
            if self.name("drive", number, one) == part:
                of_drive = fields_of(DEFINITIONS["drive"])
                drive = (self.word(of_drive["kind"], one.get("kind"), 0),
                         self.word(of_drive["component"], one.get("component"), 0))
        return fields.setting_units(self.word(known["target"], table.get("target"), 0), drive)

    def _inline_time_functions(self, kind: str, path: Path, table: dict[str, Any]) -> None:
        """time_function = "120 rpm" is a time function of that constant."""
        keys = {"drive": ("time_function", "excitation"), "bit": ("load",), "load": ("time_function",)}.get(kind, ())
        unit = {"bit": "N", "load": "-"}.get(kind) or self.drive_unit(table)
        for key in keys:
            value = table.get(key)
            if key in table and (not isinstance(value, str)
                                 or (value not in self.kinds and re.match(r"\s*[-+.\d]", value))):
                try:
                    constant = units.parse(value, unit)
                    self.problems.remark(path + (key,), value, units.remark(value, unit))
                except units.UnitError as error:
                    self.problems.add(path + (key,), value, f"{error}; or the name of a time function")
                    del table[key]
                    continue
                name = f"{key} of {'.'.join(map(str, path))}"
                self.kinds[name], self.units[name], self.segments[name] = "time_function", unit, [{"h0": constant}]
                self.names[name] = self._add_time_function(path + (key,), self.segments[name])
                self.inline.add(name)
                table[key] = name

    # ---- The end -----------------------------------------------------------------------------------------------------
    def _compile(self, values: dict[str, Any]) -> None:
        try:
            self.model.compile(**values)
        except Error as error:
            self.problems.add(self._path_of(error.part or ""), None, error.message)

    def _path_of(self, part: str) -> Path:
        """The table of a part that the library calls "joint 1 (crank)"; the whole file else."""
        pipes = re.match(r"pipes of (string \d+)", part)
        match = re.match(r"(\w+) (\d+)", pipes[1] if pipes else part)
        number = int(match.group(2)) - self.subs.offset(match.group(1)) if match else -1
        if match and match.group(1) in self.content and number >= 0:
            return (match.group(1), number)
        return (part,) if part in self.content else ("hole",) if part.startswith("wall") else ()


def load_all(folder: Any) -> dict[str, Scene]:
    """The scenes of all .toml files in a folder, by name."""
    return {name: load(os.path.join(folder, name)) for name in sorted(os.listdir(folder)) if name.endswith(".toml")}
