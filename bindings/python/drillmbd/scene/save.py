"""Writes a scene, or a model alone, as a scene file, so that reading it gives the same scene and the same run to the
bit. Every value that decides the result is written, defaults too. Values keep the units in which the file has them;
others are written in SI with all their digits. Comments stay beside their keys."""
from __future__ import annotations

import json
import pathlib
import re
from typing import Any

from .. import enums
from .._structs import Output, Id, Place
from ..outputs import Named
from ..model import Model
from . import failure, fields, units, variability
from .settings import LIMITS, OUTPUT, RUN
from .content import ANALYSES, NAMED, PARTS, Scene
from .fields import DEFINITIONS, fields_of
from .hole import FRICTION
from .lines import Path
from .source import Source, decorated

DEFAULTS = "# defaults"
#: Absent limits and delays are numbers of this size in the library; they are left out.
NO_LIMIT = 1e30
#: Fields of the segments of a time function by their kind.
SEGMENT_FIELDS = {enums.SEGMENT_CONSTANT: ("kind", "h0"), enums.SEGMENT_STEP: ("kind", "x0", "x1", "h0", "h1"),
                  enums.SEGMENT_STEP5: ("kind", "x0", "x1", "h0", "h1"),
                  enums.SEGMENT_HARMONIC: ("kind", "h0", "h1", "omega", "phase"),
                  enums.SEGMENT_PER_REVOLUTION: ("kind", "h0", "h1", "phase", "of", "share", "order")}


class CannotSave(ValueError):
    """A model with parts that a file cannot describe, as functions of Python."""


def save(scene: Scene | Model, path: Any) -> None:
    """Writes the file. Raises CannotSave where the model has parts that a file cannot describe."""
    pathlib.Path(path).write_text(saves(scene), encoding="utf-8")


def save_record(scene: Scene | Model, path: Any) -> None:
    """Writes the model as a scene record, for dmb_model_read: NAME.scene, or NAME.h with the bytes as an array of C."""
    path, model = pathlib.Path(path), scene.model if isinstance(scene, Scene) else scene
    found = model.record()
    if path.suffix != ".h":
        path.write_bytes(found)
        return
    name = re.sub(r"\W", "_", path.stem, flags=re.ASCII)
    name = name if re.match(r"[A-Za-z_]", name) else f"scene_{name}"
    rows = [", ".join(f"0x{one:02x}" for one in found[at:at + 16]) + "," for at in range(0, len(found), 16)]
    text = [f"/* Scene record for dmb_model_read({name}, sizeof {name}, NULL, &model). */", "/* clang-format off */",
            f"static const unsigned char {name}[{len(found)}] = {{",
            *(f"    {row}" for row in rows), "};"]
    path.write_text("\n".join(text) + "\n", encoding="utf-8")


def saves(scene: Scene | Model, as_written: bool = True) -> str:
    """The text of the file. as_written: with the comments and units of the file that the scene was read from; else in
    SI without comments, so that two scenes that say the same have the same text."""
    return Writer(scene, scene.source if as_written and isinstance(scene, Scene) else None).text()


def _is_default(value: Any) -> bool:
    """Whether a default is a value, and no sign of one that is absent or as elsewhere: nothing, no part, no limit, a
    negative number."""
    if (value is None or value == "" or isinstance(value, (Id, Place))
        or (isinstance(value, list) and any(isinstance(one, Id) for one in value))):
        return False
    numbers = value if isinstance(value, list) else [value]
    if any(isinstance(one, float) and not abs(one) < NO_LIMIT for one in numbers):
        return False
    return not (isinstance(value, (int, float)) and value < 0)


def defaults_of(struct: str, values: dict[str, Any]) -> dict[str, Any]:
    """The fields of a table that are not given, with their defaults."""
    usual = DEFINITIONS[struct]().describe(every=True)
    return {key: usual[key] for key in fields_of(DEFINITIONS[struct]) if key not in values and key in usual
            and _is_default(usual[key])}


def _value(value: Any) -> str:
    """A value as TOML."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_value(one) for one in value) + "]"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key} = {_value(one)}" for key, one in value.items()) + "}"
    return repr(value)


class Writer:
    """Gathers the lines. Parts of a model without names are named by kind and number."""

    def __init__(self, scene: Scene | Model, source: Source | None = None) -> None:
        self.source = source
        self.scene = scene if isinstance(scene, Scene) else None
        self.model = scene.model if isinstance(scene, Scene) else scene
        self.lines: list[tuple[str, Path | None]] = []         # each with its place in the source
        self.at: Path | None = ()                              # of the table that is being written
        self.names = {id.index: name for name, id in self.scene.names.items()} if self.scene else {}
        self.parts: dict[str, list[tuple[Id, Any]]] = {}       # kind -> (id, description) in order
        self.pipes: dict[int, list[tuple[int, dict[str, Any]]]] = {}  # string -> sections
        self.single: dict[str, dict[str, Any]] = {}
        self.sections: list[dict[str, Any]] = []               # of the hole
        self.set_names: dict[int, str] = {}                    # given by Model.set_name
        self._sort()
        # time function -> its value and unit, where a drive, bit or load states it
        self.inline = self._constants()

    # ---- From calls to parts ----------------------------------------------------------------------------------------
    def _sort(self) -> None:
        ids = iter(self.model.ids)
        for name, arguments in self.model.calls:
            kind = name.replace("add_", "")
            if name in ("set_environment", "compile"):
                self.single[kind.replace("set_", "")] = arguments[0]
                continue
            if name == "set_name":
                self.set_names[arguments[0].index] = arguments[1]
                continue
            if kind == "hole_sections":
                self.sections += arguments
                continue
            made = next(ids)
            if kind == "wall":
                self.single["hole"] = arguments[0]
            elif kind == "pipes":
                self._pipes(made, *arguments)
            elif kind in ("constraint", "force"):
                raise CannotSave(f"a {kind} by a function of Python cannot be written to a file")
            else:
                self.parts.setdefault(kind, []).append((made, list(arguments) if kind == "time_function"
                                                        else arguments[0]))
        for kind, parts in self.parts.items():
            for number, (made, description) in enumerate(parts):
                if made.index in self.set_names and isinstance(description, dict):
                    description["name"] = self.set_names[made.index]
                own = (description.get("name", "") if isinstance(description, dict)
                       else self.set_names.get(made.index, ""))
                free = own and own not in self.names.values()
                self.names.setdefault(made.index, own if free else f"{kind}-{number}")

    def _pipes(self, string: Id, count: int, description: dict[str, Any]) -> None:
        if all(string != one for one, _ in self.parts.get("string", [])):
            self.parts.setdefault("string", []).append((string, {}))
        plain = {key: value for key, value in description.items() if key != "string"}
        self.pipes.setdefault(string.index, []).append((count, plain))

    def _units(self) -> dict[int, str]:
        """The unit of every time function, by the part that uses it."""
        found = {}
        for _, drive in self.parts.get("drive", []):
            unit = fields.drive_unit(drive.get("kind", 0), drive.get("component", 0))
            found.update({drive[key].index: unit for key in ("time_function", "excitation") if key in drive})
        for kind, key, unit in (("bit", "load", "N"), ("load", "time_function", "-")):
            found.update({part[key].index: unit for _, part in self.parts.get(kind, []) if key in part})
        found.update({segment["of"].index: "rad/s" for _, segments in self.parts.get("time_function", [])
                      for segment in segments if segment.get("of")})
        return found

    def _constants(self) -> dict[int, tuple[float, str]]:
        """Time functions that the file gives as a value instead of a name."""
        if self.scene is None:
            return {}
        known = self._units()
        return {made.index: (float(segments[0].get("h0", 0.0)), known[made.index])
                for made, segments in self.parts.get("time_function", [])
                if self.names[made.index] in self.scene.inline and made.index in known}

    # ---- From parts to lines ----------------------------------------------------------------------------------------
    def text(self) -> str:
        """The whole file."""
        self._key("title", self.scene.title if self.scene else "")
        self._head("[environment]", ("environment",))
        self._table("environment", self.single.get("environment", {}))
        if "hole" in self.single:
            self._head("[hole]", ("hole",))
            self._hole(self.single["hole"])
        time_function_units = self._units()
        for made, segments in self.parts.get("time_function", []):
            if made.index not in self.inline:
                self._time_function(self.names[made.index], segments, time_function_units.get(made.index))
        for made, description in self.parts.get("string", []):
            self._part_head("string", made, description)
            self._table("string", description)
            path = self.at
            for number, (count, pipes) in enumerate(self.pipes.get(made.index, [])):
                self._head("[[string.pipes]]", None if path is None else path + ("pipes", number))
                self._key("count", count)
                # a file without them means other values
                self._table("pipes", {"elements": 1, "damping_time": 0.0, **pipes})
        for kind in PARTS[1:]:
            for made, description in self.parts.get(kind, []):
                self._part(kind, made, description)
        self._settings()
        lines = (decorated(self.lines, self.source) if self.source else [line for text, _ in self.lines
                                                                         for line in text.split("\n")])
        return "\n".join(lines) + "\n"

    def _own_name(self, kind: str, made: Id, description: dict[str, Any]) -> str | None:
        """One of kind and number is left out, so that the library has none for messages."""
        name = self.names[made.index]
        return None if "name" not in description and name == f"{kind}-{made.index & 0xFFFFFF}" else name

    def _part_head(self, kind: str, made: Id, description: dict[str, Any]) -> None:
        path = self.source.paths.get((kind, self.names[made.index])) if self.source else None
        self._head(f"[[{kind}]]", path, self._own_name(kind, made, description))

    def _head(self, head: str, path: Path | None, name: str | None = None) -> None:
        self.at = path
        self.lines.append(("\n" + head, path))
        if name is not None:
            self._key("name", name)

    def _key(self, key: str, value: Any) -> None:
        path = None if self.at is None else self.at + (key,)
        if self.source is not None:
            value = self.source.spelling(path, value)
        self.lines.append((f"{key} = {_value(value)}", path))

    def _table(self, struct: str, values: dict[str, Any], unit_of: Any = None, left_out: tuple[str, ...] = ()) -> None:
        """The fields of a struct: those of the source in its order, the other given ones, then those at their
        defaults."""
        known = fields_of(DEFINITIONS[struct])
        order = self.source.order(self.at) if self.source else {}
        every = {**values, **defaults_of(struct, values)}
        given = sorted((key for key in every if key in values or key in order),
                       key=lambda key: order.get(key, len(order)))
        usual = [key for key in every if key not in given]
        lines = [(key, self._plain(known[key], every[key], unit_of(key) if unit_of else None))
                 for key in (*given, *usual)
                 if key in known and key not in left_out and not (key == "name" and struct in NAMED)]
        explained = False
        for key, value in lines:
            if key in usual and not explained and not order.keys() & set(usual):
                explained = True
                self.lines.append((DEFAULTS, None))
            self._key(key, value)

    def _plain(self, field: Any, value: Any, unit: str | None) -> Any:
        if field.kind == "id" and not field.count and value.index in self.inline:
            return units.text(*self.inline[value.index])
        if field.kind == "id":
            return [self.names[one.index] for one in value] if field.count else self.names[value.index]
        if field.kind == "place":
            return self._place(value)
        return fields.write(field, value, unit)

    def _place(self, place: Place) -> Any:
        name = self.names[place.part.index]
        return name if not place.pipe and not place.fraction else {"part": name, "pipe": place.pipe,
                                                                   "fraction": place.fraction}

    def _hole(self, values: dict[str, Any]) -> None:
        power = values.get("exponent", 1.0)
        special = {"stiffness": f"N/m^{power + 1.0:g}"}
        stations = values.get("stations")
        table = values.get(FRICTION)
        said = (("direction",) if stations else ()) + (("mu_static", "mu_dynamic", "stribeck_speed") if table else ())
        self._table("hole", values, special.get, said)
        if table:
            self._key(FRICTION, [[units.text(speed, "m/s"), mu] for speed, mu in table])
        if stations:
            rows: list[Any] = [[units.text(depth, "m"), units.text(inclination, "rad"), units.text(azimuth, "rad")]
                               for depth, inclination, azimuth in stations]
            rows = self.source.spelling(("hole", "survey"), rows) if self.source else rows
            self.lines.append(("\n".join(["survey = [", *(f"    {_value(row)}," for row in rows), "]"]),
                               ("hole", "survey")))
        for number, section in enumerate(self.sections):
            self._head("[[hole.section]]", ("hole", "section", number))
            self._table("section", section, special.get)

    def _time_function(self, name: str, segments: list[dict[str, Any]], unit: str | None) -> None:
        path = self.source.paths.get(("time_function", name)) if self.source else None
        self._head("[[time_function]]", path, name)
        if unit is None:
            unit = self.scene.time_function_units.get(name, "-") if self.scene else "-"
            self._key("unit", unit)
        for number, segment in enumerate(segments):
            self._head("[[time_function.segment]]", None if path is None else path + ("segment", number))
            self._segment(name, segment, unit)

    def _segment(self, name: str, segment: dict[str, Any], unit: str) -> None:
        if segment.get("function") is not None:
            raise CannotSave(f"time function {name}: a function of Python cannot be written to a file; use a table")
        if segment.get("table"):
            if segment.get("kind") == enums.SEGMENT_PERIODIC:
                self._key("kind", "periodic")
            self._key("table", [[units.text(t, "s"), units.text(v, unit)] for t, v in segment["table"]])
            return
        used = SEGMENT_FIELDS.get(segment.get("kind", enums.SEGMENT_CONSTANT), ())
        unused = tuple(key for key in defaults_of("segment", segment) if used and key not in used)
        self._table("segment", segment, lambda key: unit if key in ("h0", "h1") else None, unused)

    def _part(self, kind: str, made: Id, description: dict[str, Any]) -> None:
        self._part_head(kind, made, description)
        component = description.get("component", 0)
        if kind == "event":
            self._event(description)
            return
        if kind == "input":
            self._table(kind, description, self._setting_units(description).get)
            return

        def unit_of(key: str) -> str | None:
            if kind == "drive" and key in fields.OF_COMPONENT:
                return fields.by_component(fields_of(DEFINITIONS[kind])[key].unit, component)
            return None

        if kind == "drive" and not description.get("time_function"):
            self._key("time_function", units.text(description.get("value", 0.0),
                                                  fields.drive_unit(description.get("kind", 0), component)))
        self._table(kind, description, unit_of)
        for key in fields.DRIVE_PAIRS if kind == "drive" else ():
            if description.get(key):
                speed, force = (fields.by_component(one, component) for one in ("m/s, rad/s", "N, N m"))
                self._key(key, [[units.text(v, speed), units.text(f, force)] for v, f in description[key]])
        if kind == "spring" and description.get("table"):
            self._key("table", [[units.text(x, "m"), units.text(f, "N")] for x, f in description["table"]])

    def _quantity(self, place: Place | None, quantity: int) -> None:
        """The keys of an output."""
        self._key("quantity", fields.word_of(Named(quantity)))
        if place is not None:
            self._key("place", self._place(place))

    def _event(self, description: dict[str, Any]) -> None:
        out = description.get("output", Output())
        known = fields.event_fields()
        drive = next((one for made, one in self.parts.get("drive", []) if out.place.part == made), None)
        unit = fields.unit_of_output(out.quantity, self._setting_unit(out.place),
                                      None if drive is None else drive.get("component", 0))
        self._key("quantity", fields.write(known["quantity"], out.quantity))
        if out.place.part:
            self._key("place", self._place(out.place))
        for key, value in {**description, **defaults_of("event", description)}.items():
            if key in known:
                self._key(key, self._plain(known[key], value, unit if key == "level" else None))

    def _setting_unit(self, place: Place) -> str | None:
        made = {one.index: description for one, description in self.parts.get("input", [])}
        found = made.get(place.part.index) if place.part else None
        return self._setting_units(found)["initial"] if found is not None else None

    def _setting_units(self, description: dict[str, Any]) -> dict[str, str]:
        part = description.get("part")
        drive = next((one for made, one in self.parts.get("drive", []) if part and made.index == part.index), None)
        known = (drive.get("kind", 0), drive.get("component", 0)) if drive is not None else None
        return fields.setting_units(description.get("target", 0), known)

    # ---- Settings and analyses --------------------------------------------------------------------------------------
    def _settings(self) -> None:
        self._head("[compile]", ("compile",))
        self._table("compile", self.single.get("compile") or {})
        if self.scene is None:
            return
        self._head("[sim]", ("sim",))
        self._table("sim", self.scene.sim)
        for name, values, known in (("run", {"static": 0, **self.scene.run}, RUN),
                                    ("results", self.scene.results, OUTPUT),
                                    ("limits", self.scene.limits, LIMITS)):
            if values:
                self._head(f"[{name}]", (name,))
                order = self.source.order(self.at) if self.source else {}
                for key, value in sorted(values.items(), key=lambda one: order.get(one[0], len(order))):
                    self._key(key, self._plain(known[key], value, None))
        for number, (output, place, quantity) in enumerate(self.scene.outputs):
            self._head("[[output]]", ("output", number), output)
            self._quantity(place, quantity)
        for name in ANALYSES:
            if name in self.scene.analyses or name in ("static", "modes"):
                self._analysis(name, self.scene.effective(name))
        self._chance(self.scene)

    def _chance(self, scene: Scene) -> None:
        """The tables of variability and failure."""
        counts: dict[str, int] = {}
        for head, table in variability.tables_of(scene.variability) if scene.variability else ():
            path: Path = tuple(head.strip("[]").split("."))
            if len(path) > 1:
                path += (counts.setdefault(head, 0),)
                counts[head] += 1
            self._head(head, path)
            for key, value in table.items():
                self._key(key, value)
        for number, one in enumerate(scene.failures):
            self._head("[[failure]]", ("failure", number))
            for key, value in failure.table_of(one).items():
                self._key(key, value)

    def _analysis(self, name: str, values: dict[str, Any]) -> None:
        self._head(f"[{name}]", (name,))
        own = {key: value for key, value in values.items() if key not in ("excitation", "output")
               and not (name == "speeds" and key == "order")}
        self._table(name, own, self._factor_unit(values))
        for number, one in enumerate(values.get("excitation", [])):
            self._head(f"[[{name}.excitation]]", (name, "excitation", number))
            self._excitation(one)
        if name == "speeds":
            for number, one in enumerate(values["order"]):
                self._head("[[speeds.order]]", (name, "order", number))
                self._key("order", one["order"])
                self._excitation({"kind": enums.EXCITATION_ECCENTRICITY,
                                  **{key: value for key, value in one.items() if key != "order"}})
        for number, one in enumerate(values.get("output", [])):
            self._head(f"[[{name}.output]]", (name, "output", number), one["name"])
            self._quantity(one.get("place"), one["quantity"])
            if "limit" in one:
                self._key("limit", units.text(one["limit"], one["unit"]))

    def _factor_unit(self, values: dict[str, Any]) -> Any:
        part = values.get("part")
        drive = next((one for made, one in self.parts.get("drive", []) if part and made.index == part.index), None)
        unit = "-"
        if drive is not None:
            motion = drive.get("kind", 0) == enums.DRIVE_MOTION
            unit = fields.by_component("m, rad" if motion else "N, N m", drive.get("component", 0))
        return lambda key: unit if key in ("factor_max", "step") else None

    def _excitation(self, values: dict[str, Any]) -> None:
        unit = fields.excitation_unit(values.get("kind", int(enums.EXCITATION_FORCE)), values.get("component", 0))
        if values.get("kind") == enums.EXCITATION_DRIVE:
            made = {one.index: description for one, description in self.parts.get("drive", [])}
            drive = made.get(values["place"].part.index, {})
            unit = fields.drive_unit(drive.get("kind", 0), drive.get("component", 0))
        if values.get("kind") == enums.EXCITATION_SETTING:
            unit = self._setting_unit(values["place"]) or unit
        self._table("response excitation", values, lambda key: unit if key == "amplitude" else None)


def clean_name(text: str) -> str:
    """A text as the name of a file."""
    return re.sub(r"[^A-Za-z0-9_.-]+", "_", text) or "scene"
