"""The keys of scene files as `drillmbd keys` lists them: unit, default and meaning, those in common use first."""
from __future__ import annotations

import re
from typing import Any

from . import hole, units
from .settings import LIMITS, OUTPUT, RUN
from .fields import DEFINITIONS, Field, fields_of, output_fields, words_of
from .problems import meant

# Tables in the order in which a scene is written, with the struct of their fields and the keys in common use.
TABLES: dict[str, tuple[str, str]] = {
    "environment": ("environment", "fluid_density gravity lateral_damping flow_rate viscometer"),
    "hole": ("hole",
             "diameter survey_file survey survey_columns dip inclination azimuth direction mu_static mu_dynamic "
             "friction_table stiffness"),
    "hole.section": ("section", "depth diameter mu_static mu_dynamic"), "string": ("string", "name start_depth"),
    "string.pipes": ("pipes",
                     "count pipe length outer_diameter inner_diameter elements joint_length joint_outer_diameter "
                     "joint_inner_diameter "
                              "eccentricity damping_time yield_strength"),
    "bit": ("bit", "name load mass diameter rock_law"), "drive": ("drive", "name component time_function kind"),
    "time_function.segment": ("segment", "kind h0 h1 x0 x1 table"), "stabiliser": ("stabiliser", ""),
    "body": ("body", "name mass"),
    "joint": ("joint", "kind place_a place_b"), "coupling": ("coupling", ""), "load": ("load", "place force"),
    "spring": ("spring", ""),
    "stuck": ("stuck", ""), "input": ("input", ""), "limits": ("", "rig torque push pull yield_stress make_up_torque"),
    "run": ("", "end step static"),
    "results": ("", "interval units"), "output": ("", "name place"),
    "static": ("static", "slip_axial slip_rotation"), "modes": ("modes", "count"),
    "response": ("response", ""), "response.excitation": ("response excitation", ""),
    "response.output": ("", "name place"), "speeds": ("speeds", ""),
    "speeds.order": ("response excitation", "order kind place component"), "speeds.output": ("", "name place"),
    "buckling": ("buckling", ""), "fatigue": ("fatigue", ""), "compile": ("compile", ""),
    "sim": ("sim", "")}

_TEXT = {"pipe": ("", "", 'name of a catalogue, as "5 in 19.50 S135" or "phi 73 x 6.5": drillmbd catalogue'),
         "viscometer": ("", "",
                        "readings in degrees of a Fann 35 viscometer by speed in rpm, as {600 = 52, 300 = 34}, for "
                        "consistency, "
                                "flow_exponent and yield_stress"),
         "rig": ("", "", "name of a catalogue, for torque, push and pull: drillmbd catalogue"),
         "count": ("", "1", "number of equal pipes, one after the other"),
         "name": ("", "", "for messages, and for other tables to refer to"),
         "survey": ("", "", 'rows of depth, inclination and azimuth, as [["0 m", "90 deg", "0 deg"], ...]'),
         "survey_file": ("", "", "file of the survey: CSV, text with blanks, LAS 2.0, Excel"),
         "survey_columns": ("", "",
                            'heads of the columns in their order, as ["depth [m]", "dip [deg]", "azimuth [deg]"]'),
         "friction_table": ("", "",
                            'pairs of speed of sliding and coefficient, as [["0 m/s", 0.5], ["70 mm/s", 0.5], ["80 '
                            'mm/s", 0.24]] (static until '
                            "70 mm/s), instead of mu_static, mu_dynamic and stribeck_speed; friction_law stribeck or "
                            "bristle"),
         "place": ("", "", 'a part by its name, and where on it, as {part = "main", pipe = 6}'),
         "table": ("", "", 'pairs, as [["0 s", "0 kN"], ["2 s", "8 kN"]]')}


NO_BOUND = 1e30  # a default from here on, or NaN, is no value of the field


def _fields(table: str) -> dict[str, Field]:
    own: dict[str, dict[str, Field]] = {"limits": LIMITS, "run": RUN, "results": OUTPUT, "output": output_fields(),
                                        "response.output": output_fields(), "speeds.output": output_fields()}
    found = dict(own[table] if table in own else fields_of(DEFINITIONS[TABLES[table][0]]))
    if table == "speeds.order":
        found = {"order": fields_of(DEFINITIONS["order"])["order"], **found}
    if table == "string.pipes":
        del found["string"]  # they stand in their string
    return {**found, **hole.STRAIGHT} if table == "hole" else found


def _default(table: str, field: Field) -> str:
    struct: Any = DEFINITIONS.get(TABLES[table][0]) if TABLES[table][0] else None
    value = getattr(struct(), field.name, None) if struct is not None else None
    if value is None or field.kind in ("id", "place", "text"):
        return ""
    if field.enum is not None and field.kind == "enum":
        return next((word for word, number in words_of(field.enum).items() if number == value), "")
    if isinstance(value, float) and (not abs(value) < NO_BOUND or value == -1.0 and "left out" in field.about):
        return ""
    if hasattr(value, "__len__"):
        return "[" + ", ".join(f"{one:g}" for one in value) + "]" if len(value) <= 6 else ""
    unit = field.unit.split(",")[0] if "," not in field.unit else ""
    return str(units.text(value, unit)) if field.kind == "quantity" else str(value)


def _meaning(field: Field) -> str:
    if field.kind == "enum":
        return "one of " + ", ".join(word for word in words_of(field.enum) if word != "callback")
    if field.kind == "flags":
        return "array of " + ", ".join(words_of(field.enum))
    text = re.sub(r"(?:;|,)? ?default(?:[^;.]|\.(?! ))*|\(default\)|(?:;|,)? ?shape \([^)]*\)", "", field.about)
    text = re.sub(r"\s+", " ", text).replace(" : ", ": ")  # "0 (default): none" without "(default)"
    return text.replace("{0, 0}: ", "left out: ").strip(" ;,")


def listed(table: str) -> list[tuple[str, str, str, str]]:
    """Key, unit, default and meaning of the keys of a table, those in common use first."""
    known, usual = _fields(table), TABLES[table][1].split()
    rows = []
    for key in [*usual, *(one for one in known if one not in usual)]:
        if key in known and (known[key].about or key not in _TEXT) and key != "name":
            rows.append((key, known[key].unit, _default(table, known[key]), _meaning(known[key])))
        else:
            rows.append((key, *_TEXT[key]))
    return rows


def text(table: str | None) -> str:
    """The keys of a table, or of all tables those in common use. Raises ValueError for a table that does not exist."""
    if table is not None and table not in TABLES:
        raise ValueError(f"{table}: no such table{meant(table, TABLES)}")
    lines = []
    for one in [table] if table else TABLES:
        usual = len(TABLES[one][1].split())
        rows = listed(one)[:None if table else usual]
        lines.append(f"[{one}]" if rows else f"[{one}]  drillmbd keys {one}")
        lines += [_line(row, number == usual and bool(usual)) for number, row in enumerate(rows)]
        if not table and rows and len(listed(one)) > usual:
            lines.append(f"  and {len(listed(one)) - usual} more: drillmbd keys {one}")
        lines.append("")
    return "\n".join(lines)


def _line(row: tuple[str, str, str, str], first_of_rest: bool) -> str:
    key, unit, default, meaning = row
    about = ", ".join(part for part in (f"[{unit}]" if unit else "", f"default {default}" if default else "") if part)
    return ("\n" if first_of_rest else "") + f"  {key:22} {about}{': ' if about and meaning else ''}{meaning}"
