"""The JSON schema of scene files, for editors: made from the same fields as the reading."""
from __future__ import annotations

import json
from typing import Any

from .._structs import Motor
from . import failure, hole, sub, variability
from .settings import LIMITS, OUTPUT, RUN
from .content import ANALYSES, PARTS
from .fields import DEFINITIONS, Field, event_fields, fields_of, output_fields, words_of

_NAME = {"type": "string", "minLength": 1}
_PLACE: dict[str, Any] = {"oneOf": [_NAME, {
    "type": "object", "required": ["part"], "additionalProperties": False,
    "properties": {"part": _NAME, "pipe": {"oneOf": [{"type": "integer", "minimum": 0}, {"const": "last"}]},
                   "fraction": {"type": "number", "minimum": 0, "maximum": 1}}}]}
_QUANTITY: dict[str, Any] = {"oneOf": [{"type": "string", "pattern": r"^\s*[-+]?[\d.]"}, {"type": "number"}]}

_TABLE: dict[str, Any] = {"type": "array", "minItems": 1,
                          "items": {"type": "array", "minItems": 2, "maxItems": 2, "items": _QUANTITY}}


def _field(field: Field) -> dict[str, Any]:
    number: dict[str, Any] = {"type": ["number", "string"]}
    single: dict[str, Any] = {"quantity": _QUANTITY if field.unit not in ("", "-") else number,
                              "integer": {"type": ["integer", "boolean"]}, "text": {"type": "string"},
                              "id": _NAME, "place": _PLACE}.get(field.kind, {})
    if field.kind == "enum":
        single = {"enum": list(words_of(field.enum))}
    if field.kind == "flags":
        single = {"type": "array", "items": {"enum": list(words_of(field.enum))}}
    made = dict(single)
    if field.count:
        made = {"type": "array", "items": single, "minItems": field.count, "maxItems": field.count}
    about = (f"[{field.unit}] " if field.unit else "") + field.about
    return {**made, "description": about} if about else made


def _object(known: dict[str, Field], required: tuple[str, ...] = (), **more: Any) -> dict[str, Any]:
    found: dict[str, Any] = {"type": "object", "additionalProperties": False,
                             "properties": {**{name: _field(field) for name, field in known.items()}, **more}}
    return {**found, "required": list(required)} if required else found


def _many(one: dict[str, Any]) -> dict[str, Any]:
    return {"oneOf": [{"type": "array", "items": one}, one]}


def _segment() -> dict[str, Any]:
    known = fields_of(DEFINITIONS["segment"])
    made = _object(known, table=_TABLE)
    made["properties"]["kind"]["enum"].remove("callback")
    return made


_VISCOMETER = {"type": "object", "additionalProperties": {"type": "number"},
               "description": "readings [degree] of a Fann 35 viscometer (R1, "
               "B1, F1) by speed [rpm], as {600 = 52, 300 = 34}, in place of consistency, flow_exponent and "
               "yield_stress"}


def schema() -> dict[str, Any]:
    """The schema as plain Python."""
    row = {"type": "array", "minItems": 3, "maxItems": 3, "items": _QUANTITY}
    pipes = _object({key: field for key, field in fields_of(DEFINITIONS["pipes"]).items() if key != "string"},
                    count={"type": "integer", "minimum": 1},
                    pipe={**_NAME,
                          "description": "name of a catalogue, for the keys that are left out: drillmbd catalogue"})
    properties: dict[str, Any] = {
        "title": {"type": "string"},
        "catalogue": {**_many(_NAME),
                      "description": "files of names of your own, in the form of drillmbd/scene/catalogue.toml"},
        "environment": _object(fields_of(DEFINITIONS["environment"]), viscometer=_VISCOMETER),
        "hole": _object({**fields_of(DEFINITIONS["hole"]), **hole.STRAIGHT},
                        section=_many(_object(fields_of(DEFINITIONS["section"]))),
                        friction_table={**_TABLE,
                                        "description": "speed of sliding [m/s] and friction coefficient, 2 to 8 pairs, "
                                                       "in the place "
                                        "of mu_static, mu_dynamic and stribeck_speed"},
                        survey={"type": "array", "minItems": 2, "items": row},
                        survey_columns={"type": "array", "items": _NAME,
                                        "description": "heads of the columns of survey or of survey_file "
                                        "in their order, where it has none: depth [m], inclination [deg] or dip [deg], "
                                        "azimuth [deg]"},
                        survey_file={"type": "string",
                                     "description": "CSV, text with blanks, LAS 2.0 or Excel, with heads: depth [m], "
                                     "inclination [deg] (from the downward vertical) or dip [deg] (from the "
                                     "horizontal, up positive), "
                                     "azimuth [deg] (clockwise from north)"}),
        "time_function": _many(_object({}, ("segment",), name=_NAME, unit=_NAME, segment=_many(_segment()))),
        "compile": _object(fields_of(DEFINITIONS["compile"])), "sim": _object(fields_of(DEFINITIONS["sim"])),
        "run": _object(RUN), "results": _object(OUTPUT),
        "limits": _object(LIMITS,
                          rig={**_NAME,
                               "description": "name of a catalogue, for torque, push and pull that are left out: "
                                              "drillmbd catalogue"}),
        "output": _many(_object(output_fields(), ("quantity",), name=_NAME))}
    for kind in PARTS:
        more: dict[str, Any] = {"name": _NAME, **({"pipes": _many(pipes)} if kind == "string" else {}),
                                **({"table": _TABLE} if kind == "spring" else {}),
                                **({"curve": _TABLE, "gain_table": _TABLE,
                                    "motor": _object(fields_of(Motor), table=_TABLE)}
                                   if kind == "drive" else {})}
        known = event_fields() if kind == "event" else fields_of(DEFINITIONS[kind])
        properties[kind] = _many(_object(known, **more))
    tables: dict[str, Any] = {key: _object(sub.known_fields(key), name=_NAME) for key in sub.TABLES}
    tables["section"]["properties"]["pipes"] = _many(pipes)
    properties["sub"] = _many(_object(sub.own_fields(), (), **tables))
    for kind in ANALYSES:
        properties[kind] = _object(fields_of(DEFINITIONS[kind]), **_analysis_tables(kind))
    number = {"type": ["number", "string"]}
    properties["variability"] = variability.schema(_many, _object, number, _NAME)
    properties["failure"] = failure.schema(_many, _object, number, _NAME)
    return {"$schema": "http://json-schema.org/draft-07/schema#", "title": "A scene of libdrillmbd", "type": "object",
            "additionalProperties": False, "properties": properties}


def _analysis_tables(kind: str) -> dict[str, Any]:
    out = output_fields()
    if kind == "response":
        return {"excitation": _many(_object(fields_of(DEFINITIONS["response excitation"]))),
                "output": _many(_object(out, ("quantity",), name=_NAME))}
    if kind == "speeds":
        order = {"order": fields_of(DEFINITIONS["order"])["order"], **fields_of(DEFINITIONS["response excitation"])}
        return {"order": _many(_object(order)),
                "output": _many(_object(out, ("quantity", "limit"), name=_NAME, limit=_QUANTITY))}
    return {}


def text() -> str:
    """The schema as the file that ships."""
    return json.dumps(schema(), indent=1, sort_keys=True) + "\n"
