"""The survey of a hole: measured depth, inclination from the downward vertical or dip from the horizontal (up
positive), and azimuth clockwise from north, in the scene file or in a file of its own."""
from __future__ import annotations

import math
import pathlib
from dataclasses import dataclass, field
from typing import Any

from . import columns, table_file, units
from .columns import Cell, Column
from .lines import Path
from .problems import Problems

COLUMNS = (
    Column("depth", "m", ("md", "m d", "depth", "dept", "measured depth", "meas depth", "measdepth", "depth md",
                          "md depth", "hole depth",
                          "along hole depth", "ahd", "ah depth", "measured depth md", "station depth", "survey depth",
                          "depth measured",
                          "孔深", "井深", "测深", "斜深", "深度")),
    Column("inclination", "rad", ("inc", "incl", "inclination", "inclination angle", "incl angle", "inc angle",
                                  "inclination from vertical",
                                  "deviation", "dev", "devi", "drift",
                                  "drift angle", "zenith", "zenith angle", "hole inclination", "hole angle",
                                  "hole deviation", "hdev", "sdev", "inclinaison", "neigung", "井斜", "顶角",
                                  "天顶角"), "deg", False),
    Column("dip", "rad", ("dip", "dip angle", "dip up", "dip up positive", "dip positive up", "pitch",
                          "pitch angle", "elevation", "elevation angle", "倾角", "俯仰角", "仰角"), "deg", False),
    Column("depression", "rad", ("depression", "depression angle", "angle of depression", "plunge", "dip down",
                                 "dip down positive", "dip positive down",
                                 "俯角", "下倾角"), "deg", False),
    Column("azimuth", "rad", ("azi", "azim", "azimuth", "az", "azimuth angle", "azi angle", "azm", "azimuth grid",
                              "grid azimuth", "azimuth true", "true azimuth",
                              "azi grid", "azi true", "azimuth mag", "azi mag", "azi magn", "azimuth magn",
                              "azimuth magnetic", "azimuth magnetic north", "hazi", "haz", "azin", "azmt",
                              "magnetic azimuth", "hole azimuth", "bearing", "brg", "direction",
                              "hole direction", "azimut", "方位"), "deg", True, True),
    Column("hole", "", ("well", "well name", "well id", "hole", "hole id", "holeid", "bhid", "borehole", "wellbore",
                        "uwi", "孔号", "钻孔", "井号"), "",
           False))

VERTICAL = 1e-6      # [rad] no azimuth within this of the vertical
MOST_BEND = 2.5      # [rad] between two stations, that of the library
MANY_TURNS = 4.0 * math.pi + 1e-6   # [rad] of azimuth, above which it is noted
MANY_DEGREES = math.radians(30.0) / 30.0
EXAMPLE = '["30 m", "90 deg", "15 deg"]'
BOTH_ANGLES = "has columns of inclination and of dip: the inclination is read"


@dataclass
class Station:
    """A row of a survey."""
    where: str          #: "line 4"
    depth: Cell
    angle: Cell         #: inclination or dip
    azimuth: Cell
    hole: str = ""


@dataclass
class Survey:
    """Stations as the library takes them, with notes for the reader."""
    rows: list[list[float]]                          #: depth [m], inclination, azimuth [rad]
    by_dip: bool
    heads: dict[str, str] = field(default_factory=dict)
    unit: dict[str, str] = field(default_factory=dict)
    remarks: list[str] = field(default_factory=list)


class _Faults(Exception):
    """All faults of a survey."""


def inline(problems: Problems, path: Path, rows: Any, heads: Any) -> list[list[float]] | None:
    """The stations of survey = [["0 m", "90 deg", "0 deg"], ...]; None where something is wrong. heads:
    survey_columns."""
    if not isinstance(rows, list) or len(rows) < 2:
        problems.add(path, rows, 'must be an array of at least two rows, as [["0 m", "90 deg", "0 deg"], ...]')
        return None
    names = _given(problems, path, heads) or ["depth", "inclination", "azimuth"]
    before, found = len(problems.found), list[Station]()
    for number, row in enumerate(rows):
        if not isinstance(row, list) or len(row) != len(names):
            problems.add(path + (number,), row, f"must be a row of {', '.join(names)}, as {EXAMPLE}")
            continue
        try:
            found.append(_inline_station(f"row {number + 1}", dict(zip(names, row))))
        except units.UnitError as error:
            problems.add(path + (number,), row, str(error))
    if len(problems.found) > before:
        return None
    survey = Survey([], "dip" in names and "inclination" not in names)
    if "dip" in names and not survey.by_dip:
        survey.remarks.append(BOTH_ANGLES)
    return _finished(problems, path, None, found, survey)


def _inline_station(where: str, values: dict[str, Any]) -> Station:
    cells = {}
    for column in COLUMNS:
        if column.key in values and column.unit:
            value = values[column.key]
            cells[column.key] = Cell(units.parse(value, column.unit), str(value))
    return Station(where, cells["depth"], cells.get("inclination") or cells["dip"], cells["azimuth"])


def _given(problems: Problems, path: Path, heads: Any) -> list[str] | None:
    """The keys of survey_columns, for rows in the scene file."""
    if heads is None:
        return None
    if not isinstance(heads, list) or not all(isinstance(one, str) for one in heads):
        problems.add(path[:-1] + ("survey_columns",), heads,
                     'must be an array of heads, as ["depth", "dip", "azimuth"]')
        return None
    known = [next((one.key for one in COLUMNS if columns.names_column(head, one)), "") for head in heads]
    if not {"depth", "azimuth"} <= set(known) or not {"inclination", "dip"} & set(known):
        problems.add(path[:-1] + ("survey_columns",), heads, "must name depth, inclination or dip, and azimuth")
        return None
    return known


def from_file(problems: Problems, path: Path, name: Any, folder: pathlib.Path, heads: Any) -> list[list[float]] | None:
    """The stations of a file. heads: survey_columns, for a file whose heads are missing or unknown."""
    if not isinstance(name, str):
        problems.add(path, name, "must be the name of a file of the survey")
        return None
    if heads is not None and _given(problems, path, heads) is None:
        return None
    try:
        found = columns.read(table_file.read(folder / name), COLUMNS, heads)
    except (OSError, ImportError, ValueError, KeyError, EOFError) as error:
        problems.add(path, name, f"could not be read: {getattr(error, 'strerror', None) or error}"
                     if not isinstance(error, table_file.TableError) else str(error))
        return None
    if "depression" in found.heads and not {"dip", "inclination"} & set(found.heads):
        _turn_down(found)
    by_dip = "dip" in found.heads and "inclination" not in found.heads
    if not by_dip and "inclination" not in found.heads and not found.faults:
        found.faults.append("no head names an inclination (from the downward vertical) or a dip (from the horizontal); "
                            + columns.SURVEY_ADVICE)
    if found.faults:
        for one in found.faults:
            problems.add(path, name, one)
        return None
    key = "dip" if by_dip else "inclination"
    odd = next((one for line, cells in found.rows for one in [cells["azimuth"]] if abs(one.value or 0.0) > MANY_TURNS),
               None)
    if odd is not None and odd.value is not None:
        found.remarks.append(f"the azimuth {odd.text} is more than two turns; {math.degrees(odd.value) % 360.0:.6g} "
                             "deg is read")
    stations = [Station(f"line {line}", cells["depth"], cells[key], cells["azimuth"],
                        cells["hole"].text if "hole" in cells else "")
                for line, cells in found.rows]
    survey = Survey([], by_dip, found.heads, found.unit, found.remarks)
    if "dip" in found.heads and not by_dip:
        survey.remarks.append(BOTH_ANGLES)
    return _finished(problems, path, name, stations, survey)


def _turn_down(found: columns.Found) -> None:
    """Angles below the horizontal, down positive, as dips."""
    for _, cells in found.rows:
        one = cells.pop("depression")
        cells["dip"] = Cell(None if one.value is None else -one.value, one.text, -one.number)
    for values in (found.heads, found.unit):
        values["dip"] = values.pop("depression")
    found.remarks.append(f"{found.heads['dip']} is read as an angle below the horizontal, down positive")


# ---- Stations --------------------------------------------------------------------------------------------------------
def _finished(problems: Problems, path: Path, name: Any, stations: list[Station],
              survey: Survey) -> list[list[float]] | None:
    """The rows that the library takes, after all checks."""
    before = len(problems.found)
    stations = _without_duplicates(problems, path, name, stations, survey)
    _check_holes(problems, path, name, stations)
    _check_order(problems, path, name, stations)
    _fill_azimuth(problems, path, name, stations, survey)
    _check_angles(problems, path, name, stations, survey)
    if len(problems.found) == before:
        _check_bends(problems, path, name, stations, survey)
    if len(stations) < 2 and len(problems.found) == before:
        problems.add(path, name, "must have at least two stations at different depths")
    if len(problems.found) > before:
        return None
    for one in stations:
        survey.rows.append([_value(one.depth), _inclination(one, survey),
                            math.fmod(_value(one.azimuth), 2.0 * math.pi)])
    for text in survey.remarks + suspicions(survey):
        problems.remark(path, name, text)
    return survey.rows


def _value(cell: Cell) -> float:
    return 0.0 if cell.value is None else cell.value


def _inclination(one: Station, survey: Survey) -> float:
    return 0.5 * math.pi + _value(one.angle) if survey.by_dip else _value(one.angle)


def _without_duplicates(problems: Problems, path: Path, name: Any, stations: list[Station],
                        survey: Survey) -> list[Station]:
    """Equal stations that follow each other are one; two directions at one depth are refused."""
    kept: list[Station] = []
    for one in stations:
        last = kept[-1] if kept else None
        if last is None or one.depth.value != last.depth.value:
            kept.append(one)
        elif (one.angle.value, one.azimuth.value) == (last.angle.value, last.azimuth.value):
            survey.remarks.append(f"{one.where} repeats {last.where} ({one.depth.text}): it is left out")
        else:
            problems.add(path, name,
                         f"{one.where}: measured depth {one.depth.text} appears twice, with other angles in "
                         f"{last.where}; "
                                     "depths must increase")
    return kept


def _check_holes(problems: Problems, path: Path, name: Any, stations: list[Station]) -> None:
    holes = list(dict.fromkeys(one.hole for one in stations if one.hole))
    if len(holes) > 1:
        problems.add(path, name,
                     f"has stations of {len(holes)} holes ({', '.join(holes)[:60]}); keep those of one in the file")


def _check_order(problems: Problems, path: Path, name: Any, stations: list[Station]) -> None:
    depths = [_value(one.depth) for one in stations]
    if len(depths) > 2 and all(b < a for a, b in zip(depths, depths[1:])):
        problems.add(path, name,
                     f"{stations[1].where}: measured depth {stations[1].depth.text} comes after "
                     f"{stations[0].depth.text} "
                                 f"({stations[0].where}): the stations are in reverse order; depths must increase")
        return
    for a, b in zip(stations, stations[1:]):
        if _value(b.depth) < _value(a.depth):
            problems.add(path, name,
                         f"{b.where}: measured depth {b.depth.text} comes after {a.depth.text} ({a.where}); depths "
                         "must increase, "
                                     "so sort the stations")


def _fill_azimuth(problems: Problems, path: Path, name: Any, stations: list[Station], survey: Survey) -> None:
    """A vertical hole has no azimuth; that of the next station is as good as any."""
    for number, one in enumerate(stations):
        if one.azimuth.value is not None:
            continue
        if abs(math.sin(_inclination(one, survey))) > VERTICAL:
            kind = "dip" if survey.by_dip else "inclination"
            problems.add(path, name,
                         f"{one.where}: the azimuth is empty at {kind} {one.angle.text}; only a vertical hole has none")
            continue
        known = next((other.azimuth for other in stations[number:] if other.azimuth.value is not None),
                     Cell(0.0, "0 deg"))
        one.azimuth = known


def _check_angles(problems: Problems, path: Path, name: Any, stations: list[Station], survey: Survey) -> None:
    rounding = 1e-9
    for one in stations:
        inclination = _inclination(one, survey)
        if not -rounding <= inclination <= math.pi + rounding:
            kind, bound = ("dip", "-90 .. 90 deg") if survey.by_dip else ("inclination", "0 .. 180 deg")
            hint = "; is the column a dip (from the horizontal)?" if not survey.by_dip and inclination < 0.0 else ""
            hint = hint or (_missing_hint(one.angle) or "")
            problems.add(path, name, f"{one.where}: {kind} {one.angle.text} must be {bound}{hint}")
        hint = _missing_hint(one.depth) or _missing_hint(one.azimuth)
        if hint:
            problems.add(path, name, f"{one.where}: depth {one.depth.text}, azimuth {one.azimuth.text}{hint}")


def _check_bends(problems: Problems, path: Path, name: Any, stations: list[Station], survey: Survey) -> None:
    """An arc between two stations has a direction of its own only below half a turn."""
    def row(one: Station) -> list[float]:
        return [_value(one.depth), _inclination(one, survey), _value(one.azimuth)]

    for a, b in zip(stations, stations[1:]):
        angle = dogleg(row(a), row(b)) * (_value(b.depth) - _value(a.depth))
        if angle > MOST_BEND:
            problems.add(path, name,
                         f"{b.where}: the hole turns by {math.degrees(angle):.0f} deg from {a.where}, at most "
                                     f"{math.degrees(MOST_BEND):.0f} deg fit between two stations; is a sign or an "
                                     "azimuth wrong?")


def _missing_hint(cell: Cell) -> str:
    return ("; this is a usual sign of a missing value" if cell.number in (-999.25, -999.0, -9999.0, -99999.0, -999.9)
            else "")


# ---- Suspicions ------------------------------------------------------------------------------------------------------
def suspicions(survey: Survey) -> list[str]:
    """Units that look wrong, doglegs that no string follows, a tie-in."""
    found = []
    rows = survey.rows
    if rows[0][0] > 0.0:
        found.append(f"begins at {rows[0][0]:g} m (tie-in): above it the hole is straight, in the direction of the "
                     "first station")
    if _radians_as_degrees(survey):
        found.append("all angles lie within 2 pi but are read as degrees; are they radians? Then the heads must say "
                     "[rad]")
    spacing = sorted(b[0] - a[0] for a, b in zip(rows, rows[1:]))
    if survey.unit.get("depth") == "m" and 85.0 < spacing[len(spacing) // 2] < 100.0:
        found.append(f"stations are {spacing[len(spacing) // 2]:.3g} m apart, as stands of pipes are in feet; are the "
                     "depths feet? Then the head must "
                     "say [ft]")
    sharp = [(dogleg(a, b), a, b) for a, b in zip(rows, rows[1:]) if dogleg(a, b) > MANY_DEGREES]
    if sharp:
        worst = max(sharp)
        found.append(f"bends by {math.degrees(worst[0]) * 30.0:.3g} deg/30 m between {worst[1][0]:g} m and "
                     f"{worst[2][0]:g} m"
                     + (f", and above 30 deg/30 m in {len(sharp)} intervals" if len(sharp) > 1 else "")
                     + "; is the survey right?")
    return found


def _radians_as_degrees(survey: Survey) -> bool:
    if not any(survey.unit.get(key) in ("deg", "°", "DEG", "degrees") for key in ("inclination", "dip", "azimuth")):
        return False
    angles = [abs(math.degrees(row[1]) - (90.0 if survey.by_dip else 0.0)) for row in survey.rows]
    around = [abs(math.degrees(row[2])) for row in survey.rows]
    most = 0.5 * math.pi if survey.by_dip else math.pi
    if max(angles) > most or max(around) > 2.0 * math.pi or survey.rows[-1][0] - survey.rows[0][0] < 10.0:
        return False
    return max(angles) > 0.3 and any(abs(value - round(value)) > 1e-6
                                     for value in angles) and (not survey.by_dip or max(around) > 3.2)


def dogleg(a: list[float], b: list[float]) -> float:
    """[rad/m] Curvature of the arc between two stations."""
    half = math.sin(0.5 * (b[1] - a[1])) ** 2 + math.sin(a[1]) * math.sin(b[1]) * math.sin(0.5 * (b[2] - a[2])) ** 2
    return 2.0 * math.asin(min(1.0, math.sqrt(max(0.0, half)))) / (b[0] - a[0])
