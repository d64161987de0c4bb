"""Writes a scene, or a model alone, as a scene file. Every number is written in SI with all its digits, so that reading
it gives the same scene and the same run to the bit."""
from __future__ import annotations

import json
import pathlib
import re
from typing import Any

from .. import enums
from .._structs import Channel, Id, Place
from ..channels import Named
from ..model import Model
from . import failure, fields, units, variability
from .asked import LIMITS, OUTPUT, RUN
from .content import ANALYSES, NAMED, PARTS, Scene
from .fields import DEFINITIONS, fields_of
from .terms import PerRevolution


class CannotSave(ValueError):
    """A model with what a file cannot say, as functions of Python."""


def save(scene: Scene | Model, path: Any) -> None:
    """Writes the file. Raises CannotSave where the model has what a file cannot say."""
    pathlib.Path(path).write_text(saves(scene), encoding="utf-8")


def saves(scene: Scene | Model) -> str:
    """The text of the file."""
    return Writer(scene).text()


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

    def __init__(self, scene: Scene | Model) -> None:
        self.scene = scene if isinstance(scene, Scene) else None
        self.model = scene.model if isinstance(scene, Scene) else scene
        self.lines: list[str] = []
        self.names = {id.index: name for name, id in self.scene.names.items()} if self.scene else {}
        self.parts: dict[str, list[tuple[Id, Any]]] = {}       # kind -> (id, description) in order
        self.pipes: dict[int, list[tuple[int, dict[str, Any]]]] = {}  # string -> sections
        self.single: dict[str, dict[str, Any]] = {}
        self.sections: list[dict[str, Any]] = []               # of the hole
        self.set_names: dict[int, str] = {}                    # given by Model.set_name
        self._sort()

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
                self.parts.setdefault(kind, []).append((made, list(arguments) if kind == "programme" else arguments[0]))
        for kind, parts in self.parts.items():
            for number, (made, description) in enumerate(parts):
                if made.index in self.set_names and isinstance(description, dict):
                    description["name"] = self.set_names[made.index]
                own = description.get("name", "") if isinstance(description, dict) else self.set_names.get(made.index, "")
                free = own and own not in self.names.values()
                self.names.setdefault(made.index, own if free else f"{kind}-{number}")

    def _pipes(self, string: Id, count: int, description: dict[str, Any]) -> None:
        if all(string != one for one, _ in self.parts.get("string", [])):
            self.parts.setdefault("string", []).append((string, {}))
        plain = {key: value for key, value in description.items() if key != "string"}
        self.pipes.setdefault(string.index, []).append((count, plain))

    def _units(self) -> dict[int, str]:
        """The unit of every programme, by what uses it."""
        found = {}
        for _, drive in self.parts.get("drive", []):
            unit = fields.drive_unit(drive.get("kind", 0), drive.get("component", 0))
            found.update({drive[key].index: unit for key in ("programme", "excitation") if key in drive})
        for kind, key, unit in (("bit", "load", "N"), ("load", "programme", "-")):
            found.update({part[key].index: unit for _, part in self.parts.get(kind, []) if key in part})
        return found

    # ---- From parts to lines ----------------------------------------------------------------------------------------
    def text(self) -> str:
        """The whole file."""
        self._key("title", self.scene.title if self.scene else "")
        for name in ("environment", "hole"):
            if name in self.single:
                self._head(f"[{name}]")
                self._hole(self.single[name]) if name == "hole" else self._table(name, self.single[name])
        programme_units = self._units()
        for made, terms in self.parts.get("programme", []):
            self._programme(self.names[made.index], terms, programme_units.get(made.index))
        for made, description in self.parts.get("string", []):
            self._head("[[string]]", self._own_name("string", made, description))
            self._table("string", description)
            for count, pipes in self.pipes.get(made.index, []):
                self._head("[[string.pipes]]")
                self._key("count", count)
                self._table("pipes", {"elements": 1, "damping_time": 0.0, **pipes})  # a file without them means other values
        for kind in PARTS[1:]:
            for made, description in self.parts.get(kind, []):
                self._part(kind, self._own_name(kind, made, description), description)
        self._settings()
        return "\n".join(self.lines) + "\n"

    def _own_name(self, kind: str, made: Id, description: dict[str, Any]) -> str | None:
        """One of kind and number is left out, so that the library has none for messages."""
        name = self.names[made.index]
        return None if "name" not in description and name == f"{kind}-{made.index & 0xFFFFFF}" else name

    def _head(self, head: str, name: str | None = None) -> None:
        self.lines += ["", head]
        if name is not None:
            self._key("name", name)

    def _key(self, key: str, value: Any) -> None:
        self.lines.append(f"{key} = {_value(value)}")

    def _table(self, struct: str, values: dict[str, Any], unit_of: Any = None) -> None:
        """The fields of a struct that are not at their defaults."""
        known = fields_of(DEFINITIONS[struct])
        for key, value in values.items():
            if key in known and not (key == "name" and struct in NAMED):
                self._key(key, self._plain(known[key], value, unit_of(key) if unit_of else None))

    def _plain(self, field: Any, value: Any, unit: str | None) -> Any:
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
        self._table("hole", values, special.get)
        if values.get("stations"):
            self.lines.append("survey = [")
            for depth, inclination, azimuth in values["stations"]:
                row = [units.text(depth, "m"), units.text(inclination, "rad"), units.text(azimuth, "rad")]
                self.lines.append(f"    {_value(row)},")
            self.lines.append("]")
        for section in self.sections:
            self._head("[[hole.section]]")
            self._table("section", section, special.get)

    def _programme(self, name: str, terms: list[dict[str, Any]], unit: str | None) -> None:
        self._head("[[programme]]", name)
        if unit is None:
            unit = self.scene.programme_units.get(name, "-") if self.scene else "-"
            self._key("unit", unit)
        for term in terms:
            self._head("[[programme.term]]")
            self._term(name, term, unit)

    def _term(self, name: str, term: dict[str, Any], unit: str) -> None:
        function = term.get("function")
        if isinstance(function, PerRevolution):
            for key, value in (("kind", "per-revolution"), ("of", function.of), ("share", function.share),
                               ("order", function.order)):
                self._key(key, value)
            return
        if function is not None:
            raise CannotSave(f"programme {name}: a function of Python cannot be written to a file; use a table")
        self._table("term", term, lambda key: unit if key in ("h0", "h1") else None)
        if term.get("table"):
            self._key("table", [[units.text(t, "s"), units.text(v, unit)] for t, v in term["table"]])

    def _part(self, kind: str, name: str | None, description: dict[str, Any]) -> None:
        self._head(f"[[{kind}]]", name)
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

        self._table(kind, description, unit_of)
        for key in fields.DRIVE_PAIRS if kind == "drive" else ():
            if description.get(key):
                speed, force = (fields.by_component(one, component) for one in ("m/s, rad/s", "N, N m"))
                self._key(key, [[units.text(v, speed), units.text(f, force)] for v, f in description[key]])
        if kind == "spring" and description.get("table"):
            self._key("table", [[units.text(x, "m"), units.text(f, "N")] for x, f in description["table"]])

    def _event(self, description: dict[str, Any]) -> None:
        output = description.get("output", Channel())
        known = fields.event_fields()
        drive = next((one for made, one in self.parts.get("drive", []) if output.place.part == made), None)
        unit = fields.unit_of_channel(output.quantity, self._setting_unit(output.place),
                                      None if drive is None else drive.get("component", 0))
        self._key("quantity", fields.write(known["quantity"], output.quantity))
        if output.place.part:
            self._key("place", self._place(output.place))
        for key, value in description.items():
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

    # ---- What is asked ----------------------------------------------------------------------------------------------
    def _settings(self) -> None:
        compiled = self.single.get("compile")
        if compiled:
            self._head("[compile]")
            self._table("compile", compiled)
        if self.scene is None:
            return
        for name, values, known in (("sim", self.scene.sim, fields_of(DEFINITIONS["sim"])),
                                    ("run", self.scene.run, RUN), ("output", self.scene.output, OUTPUT),
                                    ("limits", self.scene.limits, LIMITS)):
            if values:
                self._head(f"[{name}]")
                for key, value in values.items():
                    self._key(key, self._plain(known[key], value, None))
        for channel, place, quantity in self.scene.channels:
            self._head("[[channel]]", channel)
            self._key("quantity", fields.word_of(Named(quantity)))
            if place is not None:
                self._key("place", self._place(place))
        for name in ANALYSES:
            if name in self.scene.analyses:
                self._analysis(name, self.scene.analyses[name])
        self._chance(self.scene)

    def _chance(self, scene: Scene) -> None:
        """The tables of variability and failure."""
        for head, table in variability.tables_of(scene.variability) if scene.variability else ():
            self._head(head)
            for key, value in table.items():
                self._key(key, value)
        for one in scene.failures:
            self._head("[[failure]]")
            for key, value in failure.table_of(one).items():
                self._key(key, value)

    def _analysis(self, name: str, values: dict[str, Any]) -> None:
        assert self.scene is not None
        self._head(f"[{name}]")
        self._table(name, self.scene.fields_of(name), self._factor_unit(values))
        for one in values.get("input", []):
            self._head(f"[[{name}.input]]")
            self._input(one)
        if name == "speeds":
            for one in values["order"]:
                self._head("[[speeds.order]]")
                self._key("order", one["order"])
                self._input({key: value for key, value in one.items() if key != "order"})
        for one in values.get("output", []):
            self._head(f"[[{name}.output]]", one["name"])
            if one.get("kind") == enums.OUTPUT_CHANNEL:
                self._key("quantity", fields.word_of(Named(one["component"])))
                one = {key: value for key, value in one.items() if key not in ("kind", "component")}
            self._table("output", one)
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

    def _input(self, values: dict[str, Any]) -> None:
        unit = fields.input_unit(values.get("kind", int(enums.INPUT_FORCE)), values.get("component", 0))
        if values.get("kind") == enums.INPUT_DRIVE:
            made = {one.index: description for one, description in self.parts.get("drive", [])}
            drive = made.get(values["place"].part.index, {})
            unit = fields.drive_unit(drive.get("kind", 0), drive.get("component", 0))
        if values.get("kind") == enums.INPUT_SETTING:
            unit = self._setting_unit(values["place"]) or unit
        self._table("response input", values, lambda key: unit if key == "amplitude" else None)


def clean_name(text: str) -> str:
    """A text as the name of a file."""
    return re.sub(r"[^A-Za-z0-9_.-]+", "_", text) or "scene"
