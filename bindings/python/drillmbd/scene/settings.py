"""Settings of a scene file: options of the run, its outputs, the analyses."""
from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

from .. import enums
from ..unit_choice import UnitSystem
from . import fields, units
from .content import ANALYSES, Scene
from .fields import DEFINITIONS, Field, fields_of
from .lines import Path

if TYPE_CHECKING:
    from .load import Loader

RUN = {"end": Field("end", "quantity", "s", about="where the run ends"),
       "step": Field("step", "quantity", "s", about="length of a step; left out: chosen by the library"),
       "static": Field("static", "integer", about="true: starts from the static state of [static]")}
OUTPUT = {"interval": Field("interval", "quantity", "s", about="between rows of the table"),
          "vtk_interval": Field("vtk_interval", "quantity", "s", about="between files for ParaView; left out: none"),
          "units": Field("units", "enum", enum=UnitSystem,
                         about="of texts, tables and pictures; files for ParaView and summary.json stay in SI")}

LIMITS = {"torque": Field("torque", "quantity", "N m", about="of the rig"),
          "push": Field("push", "quantity", "N", about="of the rig"),
          "pull": Field("pull", "quantity", "N", about="of the rig"),
          "yield_stress": Field("yield_stress", "quantity", "Pa", about="allowed in the pipes"),
          "make_up_torque": Field("make_up_torque", "quantity", "N m",
                                  about="of the threads, limit of the failure connection-torque")}

# Settings of which the second must be above the first, and whether it may be equal to it.
ORDERED = {"speeds": ("speed_low", "speed_high", False), "response": ("frequency_low", "frequency_high", True)}


class SettingsReader:
    """Reads the settings of commands into the scene, with the names and tables of a loader."""

    def __init__(self, loader: Loader) -> None:
        self.loader = loader

    def settings(self, scene: Scene) -> None:
        scene.sim = self.loader.read(("sim",), self.loader.table(("sim",)), fields_of(DEFINITIONS["sim"]))
        scene.run = self.loader.read(("run",), self.loader.table(("run",)), RUN)
        scene.results = self.loader.read(("results",), self.loader.table(("results",)), OUTPUT)
        scene.limits = self.loader.read(("limits",), self.loader.table(("limits",)), LIMITS, ("rig",))
        for key, value in scene.limits.items():
            if not value > 0.0:
                self.loader.problems.add(("limits", key), self.loader.written(("limits", key)), "must be > 0")
        for key, table in (("end", scene.run), ("step", scene.run), ("interval", scene.results),
                           ("vtk_interval", scene.results)):
            if key in table and not table[key] > 0.0:
                section = "run" if table is scene.run else "results"
                self.loader.problems.add((section, key), self.loader.written((section, key)), "must be > 0 s")
        for number, (path, table) in enumerate(self.loader.parts("output")):
            self._output(scene, path, number, table)
        for kind in ANALYSES:
            if kind in self.loader.content:
                scene.analyses[kind] = self._analysis(kind)

    def _output(self, scene: Scene, path: Path, number: int, table: dict[str, Any]) -> None:
        values = self.loader.read(path, table, fields.output_fields(), ("name",))
        name = table.get("name", f"output-{number}")
        if not isinstance(name, str):
            self.loader.problems.add(path + ("name",), name, "must be a text")
        if "quantity" not in table:
            self.loader.problems.add(path, None, "must have a quantity")
        if "quantity" in values and ("place" in values or "place" not in table):
            scene.outputs.append((str(name), values.get("place"), values["quantity"]))
            scene.output_units.append(self.loader.output_unit(values["quantity"], table.get("place")))
            self._check_named_unit(path, str(name), scene.output_units[-1])

    def _check_named_unit(self, path: Path, name: str, unit: str) -> None:
        """A unit in brackets at the end of an output's name heads a column of values in SI."""
        written = re.search(r"\[([^\[\]]+)\]$", name.strip())
        if written and units.other_than(written[1], unit):
            plain = f"{name[:name.rindex('[')].rstrip()} [{unit}]"
            self.loader.problems.add(path + ("name",), name, f"names the unit {written[1]}, but the values are in "
                                     f"{unit}; write \"{plain}\", and [results] units for tables in other units")

    def _analysis(self, kind: str) -> dict[str, Any]:
        table = self.loader.table((kind,))
        extra = {"response": ("excitation", "output"), "speeds": ("order", "output")}.get(kind, ())
        unit = self._factor_unit(table) if kind == "buckling" else None
        values = self.loader.read((kind,), table, fields_of(DEFINITIONS[kind]), extra,
                           lambda name: unit if name in ("factor_max", "step") else None)
        if kind == "fatigue":
            self._curve(table)
        self._check_order(kind, values)
        if kind == "response":
            values["excitation"] = [self._excitation(path, one)
                                    for path, one in self.loader.tables(table, (kind,), "excitation")]
        if kind == "speeds":
            order = {"order": fields_of(DEFINITIONS["order"])["order"]}
            values["order"] = [{**self._excitation(path, one, ("order",)),
                                "order": self.loader.read(path, {k: v for k, v in one.items() if k == "order"}, order
                                                   ).get("order", 1.0)}
                               for path, one in self.loader.tables(table, (kind,), "order")]
        if extra:
            values["output"] = [self._response_output(path, one, kind == "speeds")
                                for path, one in self.loader.tables(table, (kind,), "output")]
            for key in extra:
                if not values[key]:
                    self.loader.problems.add((kind,), None, f"must have at least one [[{kind}.{key}]]")
        return values

    def _check_order(self, kind: str, values: dict[str, Any]) -> None:
        """Ends of a range in their order; those left out have their defaults."""
        if kind == "modes" and "band" in values and not values["band"][0] < values["band"][1]:
            self.loader.problems.add((kind, "band"), self.loader.written((kind, "band")), "must increase")
        if kind not in ORDERED:
            return
        low, high, may_be_equal = ORDERED[kind]
        default = DEFINITIONS[kind]()
        ends = [values.get(key, getattr(default, key)) for key in (low, high)]
        if ends[0] < ends[1] or (may_be_equal and ends[0] == ends[1]):
            return
        key, other, words = (high, low, "above") if high in values else (low, high, "below")
        written = self.loader.written((kind, other)) or \
            f"{getattr(default, other):g} {fields_of(DEFINITIONS[kind])[other].unit} by default"
        self.loader.problems.add((kind, key), self.loader.written((kind, key)), f"must be {words} {other}, {written}")

    def _curve(self, table: dict[str, Any]) -> None:
        """The S-N curve is required. Fatigue is counted in a run."""
        for key in ("curve_stress", "slope"):
            if key not in table:
                self.loader.problems.add(("fatigue",), None, f"must have a {key}, of the S-N curve of the pipes")
        if "end" not in self.loader.table(("run",)):
            self.loader.problems.add(("fatigue",), None, "counts the cycles of a run: give [run] end")

    def _factor_unit(self, table: dict[str, Any]) -> str:
        """The factor of a drive of a motion is a length or an angle; else it is a number."""
        name = table.get("part")
        for number, (_, drive) in enumerate(self.loader.parts("drive")):
            if self.loader.name("drive", number, drive) == name:
                kind = self.loader.word(fields_of(DEFINITIONS["drive"])["kind"], drive.get("kind"), 0)
                component = self.loader.word(fields_of(DEFINITIONS["drive"])["component"], drive.get("component"), 0)
                return fields.by_component("m, rad" if kind == enums.DRIVE_MOTION else "N, N m", component)
        return "-"

    def _excitation(self, path: Path, table: dict[str, Any], extra: tuple[str, ...] = ()) -> dict[str, Any]:
        known = fields_of(DEFINITIONS["response excitation"])
        eccentric = int(enums.EXCITATION_ECCENTRICITY) if extra else int(enums.EXCITATION_FORCE)
        kind = self.loader.word(known["kind"], table.get("kind"), eccentric)
        component = self.loader.word(known["component"], table.get("component"), 0)
        unit = fields.excitation_unit(kind, component)
        if kind == enums.EXCITATION_DRIVE:
            place = table.get("place")
            name = place.get("part") if isinstance(place, dict) else place
            unit = next((self.loader.drive_unit(drive) for number, (_, drive) in enumerate(self.loader.parts("drive"))
                         if self.loader.name("drive", number, drive) == name), unit)
        if kind == enums.EXCITATION_SETTING:
            unit = self.loader.setting_unit(table.get("place")) or unit
        return self.loader.read(path, table, known, extra, lambda key: unit if key == "amplitude" else None)

    def _response_output(self, path: Path, table: dict[str, Any], limited: bool) -> dict[str, Any]:
        values = self.loader.read(path, table, fields.output_fields(), ("name", "limit") if limited else ("name",))
        if "quantity" not in table:
            self.loader.problems.add(path, None, 'must have a quantity, as "vibration-z" or "hook-load"')
        unit = self.loader.output_unit(values["quantity"], table.get("place")) if "quantity" in values else "-"
        values["name"] = str(table.get("name", f"output-{path[-1]}"))
        if limited:
            try:
                values["limit"] = units.parse(table.get("limit"), unit)
                if not values["limit"] > 0.0:
                    raise units.UnitError("must be > 0")
            except units.UnitError as error:
                self.loader.problems.add(path + ("limit",), table.get("limit"), str(error))
        values["unit"] = unit
        return values
