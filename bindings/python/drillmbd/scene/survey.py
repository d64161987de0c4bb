"""The survey of a hole: rows of measured depth, inclination and azimuth, in the scene file or in a CSV file."""
from __future__ import annotations

import csv
import pathlib
import re
from typing import Any

from . import units
from .lines import Path
from .problems import Problems

COLUMNS = (("depth", "m"), ("inclination", "rad"), ("azimuth", "rad"))


def inline(problems: Problems, path: Path, rows: Any) -> list[list[float]] | None:
    """The stations of survey = [["0 m", "90 deg", "0 deg"], ...]; None where something is wrong."""
    if not isinstance(rows, list) or len(rows) < 2:
        problems.add(path, rows, 'must be an array of at least two rows, as [["0 m", "90 deg", "0 deg"], ...]')
        return None
    before, found = len(problems.found), []
    for number, row in enumerate(rows):
        if not isinstance(row, list) or len(row) != 3:
            problems.add(path + (number,), row, 'must be a row of depth, inclination and azimuth, as ["30 m", "90 deg", "15 deg"]')
            continue
        try:
            found.append([units.parse(value, unit) for value, (_, unit) in zip(row, COLUMNS)])
        except units.UnitError as error:
            problems.add(path + (number,), row, str(error))
    return found if len(problems.found) == before else None


def from_file(problems: Problems, path: Path, name: Any, folder: pathlib.Path) -> list[list[float]] | None:
    """The stations of a CSV file with a line of heads: "depth [m], inclination [deg], azimuth [deg]"."""
    if not isinstance(name, str):
        problems.add(path, name, "must be the name of a CSV file")
        return None
    try:
        with open(folder / name, encoding="utf-8", newline="") as text:
            rows = [[cell.strip() for cell in row] for row in csv.reader(text)]
    except (OSError, UnicodeDecodeError, csv.Error, ValueError) as error:
        problems.add(path, name, f"could not be read: {error}")
        return None
    heads = _units_of(rows[0]) if rows else None
    if heads is None:
        problems.add(path, name, "line 1 must be heads with units: depth [m], inclination [deg], azimuth [deg]")
        return None
    before, found = len(problems.found), []
    for number, row in enumerate(rows[1:], 2):
        if not any(row):
            continue
        try:
            if len(row) != 3:
                raise units.UnitError(f"has {len(row)} columns, must have 3")
            found.append([units.parse(f"{cell} {unit}", wanted)
                          for cell, unit, (_, wanted) in zip(row, heads, COLUMNS)])
        except units.UnitError as error:
            problems.add(path, name, f"line {number} ({', '.join(row)}): {error}")
    if len(found) < 2 and len(problems.found) == before:
        problems.add(path, name, "must have at least two rows below its heads")
    return found if len(problems.found) == before else None


def _units_of(heads: list[str]) -> list[str] | None:
    """The units of the heads, if these are depth, inclination and azimuth."""
    found = []
    for head, (word, wanted) in zip(heads, COLUMNS):
        match = re.search(r"\[(.*)\]", head)
        try:
            if match is None or word not in head.lower() or not units.fits(match.group(1), wanted):
                return None
        except units.UnitError:
            return None
        found.append(match.group(1))
    return found if len(found) == 3 else None
