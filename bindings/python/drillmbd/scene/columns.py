"""Columns of numbers out of a table as it comes: found by their heads, with units out of heads, of a line of units or
of the scene file. Messages name line, column, the value as written and the likely cause."""
from __future__ import annotations

import math
import re
from dataclasses import dataclass
from decimal import Decimal

from . import number_text, units
from .table_file import Row, Table, TableError
from .unit_text import plain

MOST_FAULTS = 8  # that are listed of one file
#: Words in brackets that say from where or in which sense an angle counts.
SENSE = re.compile(r"horiz|vert|down|\bup|below|above|水平|垂|[上下]", re.I)
NOT_ANGLES = ("%", "‰", "percent", "mil", "mils")  # units of slopes and of artillery, which are not read as degrees
_MISSING = re.compile(r"-?9{3,5}(?:[.,]\d*)?|nan|null|none|n/?a|#n/?a|-+|\*+|x+", re.I)


@dataclass(frozen=True)
class Column:
    """A quantity that a table has."""
    key: str
    unit: str                     #: in SI; "": a text
    names: tuple[str, ...]        #: small letters, without signs; Chinese ones count within a head, too
    assumed: str = ""             #: unit where the file gives none; "": it must give one
    needed: bool = True
    may_be_empty: bool = False


@dataclass
class Cell:
    """A number of a table."""
    value: float | None           #: SI; None: empty
    text: str                     #: as written, with its unit
    number: float = 0.0           #: as written


@dataclass
class Found:
    """The numbers of a table."""
    rows: list[tuple[int, dict[str, Cell]]]   #: line, cells
    heads: dict[str, str]                     #: of the columns, as they are understood: "MD [m]"
    unit: dict[str, str]
    faults: list[str]
    remarks: list[str]


@dataclass
class _Place:
    """A column of the file."""
    index: int
    column: Column
    unit: str
    head: str


def _name_and_unit(head: str) -> tuple[str, str]:
    """"Measured Depth (ft)" as name and unit."""
    text = plain(head).strip()
    match = re.search(r"[\[({<]\s*([^\])}>]*?)\s*[\])}>]", text)
    name, unit = (text[:match.start()] + " " + text[match.end():], match[1]) if match else (text, "")
    return _words(name), unit


def _words(text: str) -> str:
    """In small letters, without signs."""
    return re.sub(r"[^\w°]+", " ", text.replace("_", " ")).strip().casefold()


def _is(name: str, column: Column) -> bool:
    return name in column.names or any(not one.isascii() and one in name for one in column.names)


def names_column(head: str, column: Column) -> bool:
    """Whether a head names a column."""
    known = _column_of(head, (column,))
    return known is not None


def _column_of(head: str, columns: tuple[Column, ...]) -> tuple[Column, str] | None:
    """The column that a head names, and its unit; "depth m" and "MD_ft" count, too. A sense in brackets belongs to the
    name: "dip (down positive)" is no dip, which is up positive."""
    name, unit = _name_and_unit(head)
    if SENSE.search(unit):
        whole = f"{name} {_words(unit)}"
        return next(((column, "") for column in columns if whole in column.names), None)
    words = name.split()
    if not unit and len(words) > 1 and words[-1] not in ("s",):
        for column in columns:
            if column.unit and _is(" ".join(words[:-1]), column) and units.fits(words[-1], column.unit):
                return column, words[-1]
    for column in columns:
        if _is(name, column):
            return column, unit if unit and column.unit and units.fits(unit, column.unit) else ""
    return None


def _places(row: Row, columns: tuple[Column, ...]) -> list[_Place]:
    found: dict[str, _Place] = {}
    for index, head in enumerate(row.cells):
        known = _column_of(head, columns) if head else None
        if known and known[0].key not in found:
            found[known[0].key] = _Place(index, known[0], known[1], head)
    return list(found.values())


def _passed_over(row: Row, places: list[_Place]) -> list[str]:
    """Heads that begin with the name of a column that another head gives: a second azimuth, depths in feet too."""
    found = []
    for index, head in enumerate(row.cells):
        name = _name_and_unit(head)[0]
        chosen = next((one for one in places if one.column.unit and one.index != index and (
            _is(name, one.column) or name.split(" ")[0] in one.column.names)), None)
        if name and chosen is not None and all(index != one.index for one in places):
            found.append(f"column {index + 1} ({head[:40]}) is not read: the {chosen.column.key} is column "
                         f"{chosen.index + 1} ({chosen.head[:40]})")
    return found


def _is_number(cell: str) -> bool:
    try:
        number_text.split(cell)
        return True
    except number_text.NoNumber:
        return bool(re.match(r"[-+]?\d", cell))


def _heads(table: Table, columns: tuple[Column, ...], given: list[str] | None) -> tuple[list[_Place], list[Row],
                                                                                        Row | None]:
    """Columns, the rows below their heads, and the heads of the file."""
    if given is not None:
        return _places(Row(0, given), columns), _from_numbers(table.rows), None
    if table.heads is not None:
        return _places(table.heads, columns), table.rows, table.heads
    best: tuple[list[_Place], int] = ([], -1)
    for at, row in enumerate(table.rows[:200]):
        if sum(map(_is_number, row.cells)) > 1:
            continue
        places = _places(row, columns)
        if len(places) > len(best[0]):
            best = places, at
    return best[0], table.rows[best[1] + 1:], table.rows[best[1]] if best[1] >= 0 else None


def _from_numbers(rows: list[Row]) -> list[Row]:
    at = next((i for i, row in enumerate(rows) if sum(map(_is_number, row.cells)) >= 2), len(rows))
    return rows[at:]


def _take_units(places: list[_Place], rows: list[Row]) -> list[Row]:
    """Units of a line below the heads."""
    if not rows:
        return rows
    cells = [re.sub(r"^[\[({]|[\])}]$", "", one.strip()).strip() for one in rows[0].cells]
    own = [(one, cells[one.index] if one.index < len(cells) else "") for one in places if one.column.unit]
    if (any(_is_number(text) for _, text in own) or not any(text and units.fits(text, one.column.unit)
                                                            for one, text in own)):
        return rows
    for one, text in own:
        if text and units.fits(text, one.column.unit):
            one.unit = text
    return rows[1:]


#: Advice for a survey without the heads that are needed, and the key of the scene file that gives them.
SURVEY_ADVICE = ("give the heads in the file, as \"depth [m], inclination [deg], azimuth [deg]\", or in the scene "
                 "file, as survey_columns = "
                 "[\"depth [m]\", \"dip [deg]\", \"azimuth [deg]\"]")
SURVEY_KEY = "survey_columns"


def read(table: Table, columns: tuple[Column, ...], given: list[str] | None = None, advice: str = SURVEY_ADVICE,
         key: str = SURVEY_KEY) -> Found:
    """The numbers of the wanted columns. given: heads in the order of the columns, for a file without. advice: to an
    author whose file has no such heads; key: of the scene file that gives them, "" if there is none. Raises TableError
    where the columns are not found."""
    places, rows, head_row = _heads(table, columns, given)
    width = len(given) if given is not None else len(head_row.cells) if head_row is not None else 0
    rows = _take_units(places, rows)
    keys = {one.column.key for one in places}
    missing = [one for one in columns if one.needed and one.key not in keys]
    if missing:
        raise TableError(_no_columns(table, missing, given, advice))
    found = Found([], {}, {}, [], [] if head_row is None else _passed_over(head_row, places))
    for one in places:
        _settle_unit(one, found, rows, key)
    if given is not None:
        found.remarks += _against_own_heads(table, places, width, key)
    comma = _decimal_comma(table, places, rows)
    for row in rows:
        if any(any(row.cells[one.index:one.index + 1]) for one in places if one.column.unit):
            _read_row(row, places, table, comma, found)
    if table.separator == "," and not found.faults:
        _check_widths(width, rows, found, given is not None)
    if len(found.faults) > MOST_FAULTS:
        found.faults[MOST_FAULTS:] = [f"and {len(found.faults) - MOST_FAULTS} more lines are wrong"]
    return found


def _against_own_heads(table: Table, places: list[_Place], width: int, key: str) -> list[str]:
    """Given heads that the heads of the file contradict: another unit, or columns counted from the wrong one."""
    before = table.rows[:len(table.rows) - len(_from_numbers(table.rows))]
    own = table.heads or (before[-1] if before else Row(0, []))
    read = [(one, own.cells[one.index][:40]) for one in places if one.column.unit and one.index < len(own.cells)]
    found = []
    for one, head in read:
        unit = _name_and_unit(head)[1]
        if units.fits(unit, one.column.unit) and units.factor(unit, one.column.unit) != units.factor(one.unit,
                                                                                                    one.column.unit):
            found.append(f"column {one.index + 1} ({head}) is read in {one.unit}, as {key} says; is that its unit?")
    if read and width < len(own.cells):
        found.append(f"{key} names {width} of {len(own.cells)} columns, counted from the first: "
                     + ", ".join(f"{one.column.key} is column {one.index + 1} ({head})" for one, head in read)
                     + "; name columns that are not read, too, as \"\"")
    return found


def _no_columns(table: Table, missing: list[Column], given: list[str] | None, advice: str) -> str:
    words = " and ".join(one.key for one in missing)
    if given is not None:
        return f"survey_columns must name {words}"
    first = table.heads or next(iter(table.rows), None)
    if first is None:
        return "is empty"
    return f"line {first.line} ({', '.join(first.cells)[:80]}): no head names {words}; {advice}"


def _settle_unit(one: _Place, found: Found, rows: list[Row], key: str) -> None:
    column = one.column
    if not column.unit:
        return
    if not one.unit and any(_own_unit(row, one) for row in rows[:1]):
        one.unit = column.assumed or column.unit  # each cell has its own
    elif not one.unit and column.unit == "rad" and _name_and_unit(one.head)[1].casefold() in NOT_ANGLES:
        found.faults.append(f"column {one.index + 1} ({one.head}) is no angle in deg, rad or gon; convert it")
        one.unit = column.assumed
    elif not one.unit and column.assumed:
        found.remarks.append(f"column {one.index + 1} ({one.head}) has no unit: {column.assumed} is assumed")
        one.unit = column.assumed
    elif not one.unit:
        found.faults.append(f"column {one.index + 1} ({one.head}) has no unit; write it in the head, as \"{one.head} "
                            f"[{column.unit}]\""
                            + (f", or give {key} in the scene file" if key else ""))
        one.unit = column.unit
    found.heads[column.key], found.unit[column.key] = one.head, one.unit


def _own_unit(row: Row, one: _Place) -> bool:
    text = row.cells[one.index] if one.index < len(row.cells) else ""
    try:
        return bool(number_text.split(text)[1])
    except number_text.NoNumber:
        return False


def _decimal_comma(table: Table, places: list[_Place], rows: list[Row]) -> bool:
    """Whether some cell has a comma that can only be decimal, and none has a point: then all commas of the file are."""
    if table.separator == ",":
        return False
    cells = [row.cells[one.index] for row in rows for one in places if one.column.unit and one.index < len(row.cells)]
    if any("." in cell for cell in cells):
        return False
    sure = [cell for cell in cells if re.fullmatch(r"[-+]?(?:\d{4,},\d+|\d+,\d{1,2}|\d+,\d{4,}|0\d*,\d+)",
                                                   cell.strip())]
    return bool(sure)


def _read_row(row: Row, places: list[_Place], table: Table, comma: bool, found: Found) -> None:
    cells: dict[str, Cell] = {}
    for one in places:
        text = row.cells[one.index].strip() if one.index < len(row.cells) else ""
        try:
            cells[one.column.key] = _cell(text, one, table.missing, comma)
        except units.UnitError as error:
            where = f"line {row.line}, column {one.index + 1} ({one.head})"
            found.faults.append(f"{where} = \"{text if len(text) <= 40 else text[:37] + '...'}\": {error}")
            return
    found.rows.append((row.line, cells))


def _cell(text: str, one: _Place, missing: str, comma: bool) -> Cell:
    if not one.column.unit or (not text and one.column.may_be_empty):
        return Cell(None, text)
    if not text:
        raise units.UnitError("is empty; fill in the value or delete the line")
    if _is_missing(text, one, missing):
        raise units.UnitError("is a missing value; fill in the value or delete the line")
    if text.startswith("="):
        raise units.UnitError("is a formula without a value; open the file in Excel, so that it is computed, "
                              "and save it")
    if comma:
        text = text.replace(",", ".")
    bearing = re.fullmatch(r"([NS])\s*([\d.]+)\s*°?\s*([EW])", text, re.I) if one.column.unit == "rad" else None
    if bearing:
        return _cell_of(_of_bearing(bearing, _half_turn(one.unit)), one, "")
    try:
        number, rest, _ = number_text.split(text)
    except number_text.NoNumber as error:
        raise units.UnitError(str(error) or "is no number") from error
    return _cell_of(number, one, rest)


def _is_missing(text: str, one: _Place, missing: str) -> bool:
    """The sign of a LAS file, in any number of digits, or a usual one. 999 and 9999 are depths, too."""
    if missing and (text == missing or _same_number(text, missing)):
        return True
    return bool(_MISSING.fullmatch(text)) and not (one.column.key == "depth" and text[0] == "9")


def _same_number(a: str, b: str) -> bool:
    try:
        return float(a) == float(b)
    except ValueError:
        return False


def _half_turn(unit: str) -> Decimal:
    """180 of degrees, 200 of gon."""
    half = Decimal(repr(math.pi)) / units.factor(unit, "rad")
    return Decimal(round(half)) if abs(half - round(half)) < Decimal("1e-9") else half


def _of_bearing(match: re.Match[str], half_turn: Decimal) -> Decimal:
    """N 45 E, S 30 W: at most a quarter turn from north or south."""
    angle = Decimal(match[2])
    if angle > half_turn / 2:
        raise units.UnitError(f"is more than {half_turn / 2} from {match[1].upper()}; give an azimuth, or a bearing of "
                              "at most a quarter turn")
    from_north = angle if match[1].upper() == "N" else half_turn - angle
    return from_north if match[3].upper() == "E" else -from_north


def _cell_of(number: Decimal, one: _Place, rest: str) -> Cell:
    unit = rest or one.unit
    value = units.scaled(number, units.factor(unit, one.column.unit))
    return Cell(value, f"{number} {unit}", float(number))


def _check_widths(width: int, rows: list[Row], found: Found, bare: bool) -> None:
    """Cells that are separated by commas, of which one may be within a number: twice as many cells as heads in all rows
    are decimal commas; more numbers than heads in some row may be 1,000. bare: a file without heads, which may have
    more columns, the same in all rows."""
    bad = [row for row in rows if len(row.cells) >= 2 * width]
    if bad and len(bad) == len(rows):
        found.faults.append(f"line {bad[0].line} has {len(bad[0].cells)} cells below {width} heads: with decimal "
                            "commas the cells must "
                            "be separated by semicolons, tabs or blanks")
        return
    usual = max(width, min((len(row.cells) for row in rows), default=0)) if bare else width
    for row in rows:
        if any(_is_number(cell) for cell in row.cells[usual:] if cell):
            found.faults.append(f"line {row.line} has {len(row.cells)} cells below {usual} heads: is a comma within a "
                                "number, as 1,000? Take it out, put the "
                                "number in quotes, or separate the cells by semicolons")
