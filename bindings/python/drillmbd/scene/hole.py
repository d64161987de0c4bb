"""The table of the hole: its course by a survey, or straight by inclination or dip and azimuth, and its sections."""
from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from . import survey
from .fields import DEFINITIONS, Field, fields_of
from .lines import Path

if TYPE_CHECKING:
    from .load import Loader

#: Of a straight hole, in the place of `direction`.
STRAIGHT = {"inclination": Field("inclination", "quantity", "rad",
                                 about="of a straight hole, from the downward vertical; instead of direction"),
            "dip": Field("dip", "quantity", "rad",
                         about="of a straight hole, from the horizontal, up positive; instead of direction"),
            "azimuth": Field("azimuth", "quantity", "rad",
                             about="of a straight hole, clockwise from north (+x) seen from above; default 0")}
FRICTION, MOST_POINTS, LAWS = "friction_table", 8, ("stribeck", "bristle")
SURVEY = ("survey", "survey_file", "survey_columns")


def describe(loader: Loader) -> None:
    """Adds the hole and its sections to the model."""
    path: Path = ("hole",)
    table = loader.table(path)
    exponent = table.get("exponent", 1.0)
    power = float(exponent) if isinstance(exponent, (int, float)) and 0 < exponent < 10 else 1.0
    special = {"stiffness": f"N/m^{power + 1.0:g}"}
    values = loader.read(path, table, {**fields_of(DEFINITIONS["hole"]), **STRAIGHT}, (*SURVEY, "section", FRICTION),
                         special.get)
    straight = {key: values.pop(key) for key in STRAIGHT if key in values}
    _direction(loader, path, table, straight, values)
    _course(loader, path, table, values)
    _friction(loader, path, table, values)
    if values.get("stations", ()) is not None:
        loader.add(path, loader.model.add_wall, DEFINITIONS["hole"], values)
    known = fields_of(DEFINITIONS["section"])
    for where, section in loader.tables(table, path, "section"):
        loader.add(where, loader.model.add_hole_sections, DEFINITIONS["section"],
                   loader.read(where, section, known, (), special.get))


def _course(loader: Loader, path: Path, table: dict[str, Any], values: dict[str, Any]) -> None:
    heads = table.get("survey_columns")
    if "survey" in table and "survey_file" in table:
        loader.problems.add(path + ("survey_file",), table["survey_file"], "must be left out where there is a survey")
    elif "survey" in table:
        values["stations"] = survey.inline(loader.problems, path + ("survey",), table["survey"], heads)
    elif "survey_file" in table:
        values["stations"] = survey.from_file(loader.problems, path + ("survey_file",), table["survey_file"],
                                              loader.folder, heads)
    elif "survey_columns" in table:
        loader.problems.add(path + ("survey_columns",), heads, "needs a survey or survey_file")


def _friction(loader: Loader, path: Path, table: dict[str, Any], values: dict[str, Any]) -> None:
    """The coefficient against the speed of sliding, instead of the coefficients at its ends."""
    if FRICTION not in table:
        return
    found = len(loader.problems.found)
    values[FRICTION] = loader.pairs(path + (FRICTION,), table[FRICTION], "m/s", "-",
                                    "speed of sliding and friction coefficient")
    for key in ("mu_static", "mu_dynamic", "stribeck_speed"):
        if key in table:
            loader.problems.add(path + (key,), table[key],
                                f"must be left out where there is a {FRICTION}, which says it")
    if table.get("friction_law", LAWS[0]) not in LAWS:
        loader.problems.add(path + ("friction_law",), table["friction_law"],
                            f"must be {' or '.join(LAWS)} where there is a {FRICTION}")
    if not 2 <= len(values[FRICTION]) <= MOST_POINTS and len(loader.problems.found) == found:
        loader.problems.add(path + (FRICTION,), table[FRICTION], f"must have 2 to {MOST_POINTS} pairs")
    if len(loader.problems.found) > found:
        del values[FRICTION]


def _direction(loader: Loader, path: Path, table: dict[str, Any], straight: dict[str, float],
               values: dict[str, Any]) -> None:
    """x is north, y west, z up."""
    if not straight:
        return
    other = next((key for key in ("direction", "survey", "survey_file") if key in table), "")
    if other or {"inclination", "dip"} <= set(straight):
        key = next(iter(straight))
        loader.problems.add(path + (key,), table[key],
                            f"must be left out where there is {other or 'the other one of inclination and dip'}")
        return
    inclination = straight.get("inclination", 0.5 * math.pi + straight.get("dip", 0.0))
    azimuth = straight.get("azimuth", 0.0)
    values["direction"] = (math.sin(inclination) * math.cos(azimuth), 0.0 - math.sin(inclination) * math.sin(azimuth),
                           -math.cos(inclination))
