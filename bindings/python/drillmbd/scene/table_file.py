"""Tables of files as they come: CSV with any separator, text with blanks, LAS 2.0, Excel. Rows of cells with their
lines."""
from __future__ import annotations

import csv
import io
import pathlib
import re
from dataclasses import dataclass, field
from typing import Any

from .._optional import need
from .read_file import TooLarge, limited

MOST_BYTES = 100_000_000
_COMMENT = re.compile(r"\s*(?:#|//|%|\*|!|')")
_CHINESE = "深井孔斜倾方位角度测"


class TableError(ValueError):
    """A file that cannot be read as a table."""


@dataclass
class Row:
    """A line of a file."""
    line: int           #: from 1; in Excel: of the sheet
    cells: list[str]


@dataclass
class Table:
    """The rows of a file; comments and empty lines are left out."""
    rows: list[Row] = field(default_factory=list)
    heads: Row | None = None     #: of a LAS file, "DEPT [m]"
    missing: str = ""            #: the text that stands for a missing value, of a LAS file
    separator: str = ""          #: "," where a comma cannot be decimal


def read(path: pathlib.Path) -> Table:
    """The table of a file. Raises TableError, OSError, ImportError (Excel without openpyxl)."""
    if path.suffix.lower() in (".xlsx", ".xlsm"):
        return _excel(path)
    if path.exists() and not path.is_file():
        raise TableError("is a folder or a device, must be a file")
    try:
        data = limited(path, MOST_BYTES)
    except TooLarge as error:
        raise TableError(str(error)) from error
    if data[:4] == b"PK\x03\x04":
        raise TableError("is an Excel file; its name must end with .xlsx")
    if data[:8] == b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1":
        raise TableError("is a file of an old Excel (.xls); save it as .xlsx or CSV")
    return of_text(decoded(data))


def decoded(data: bytes) -> str:
    """UTF-8 with or without its mark, UTF-16 with its mark, the Chinese GB 18030, else Latin-1."""
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        return data.decode("utf-16", "replace")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        pass
    try:
        text = data.decode("gb18030")
        if any(sign in text for sign in _CHINESE):
            return text
    except UnicodeDecodeError:
        pass
    return data.decode("cp1252", "replace")


def of_text(text: str) -> Table:
    """The table of a text."""
    lines = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    first = next((line for line in lines if line.strip() and not _COMMENT.match(line)), "")
    if first.lstrip().startswith("~"):
        return _las(lines)
    kept = [(number, line) for number, line in enumerate(lines, 1) if line.strip() and not _COMMENT.match(line)]
    separator = _separator([line for _, line in kept])
    table = Table(separator=separator)
    for number, line in kept:
        cells = _split(line, separator)
        if any(cells):
            table.rows.append(Row(number, cells))
    return table


def _separator(lines: list[str]) -> str:
    """Of the signs that stand in most lines the first one; "" for blanks."""
    for sign in ("\t", ";"):
        if sum(sign in line for line in lines) * 2 > len(lines):
            return sign
    with_blanks = sum(_by_blanks(line) for line in lines)
    if sum("," in line for line in lines) * 2 > len(lines) and with_blanks * 2 <= len(lines):
        return ","
    return ""


def _by_blanks(line: str) -> bool:
    """Whether a line is numbers with blanks between, decimal commas perhaps."""
    words = line.split()
    return len(words) >= 3 and sum(bool(re.fullmatch(r"[-+]?\d+(?:[.,]\d+)?", word)) for word in words) >= 3


def _split(line: str, separator: str) -> list[str]:
    if separator:
        try:
            return [cell.strip()
                    for cell in next(csv.reader(io.StringIO(line), delimiter=separator, skipinitialspace=True), [])]
        except csv.Error as error:
            raise TableError(f"has a line that is no row of a table ({error}): {line[:40]}") from error
    wide = re.split(r"\s{2,}", line.strip())
    return wide if len(wide) >= 3 else _with_units(line.split())


def _with_units(words: list[str]) -> list[str]:
    """"Depth (m)" as one cell."""
    found: list[str] = []
    for word in words:
        if found and re.match(r"[\[(]", word) or (found and found[-1].count("(") > found[-1].count(")")):
            found[-1] += " " + word
        else:
            found.append(word)
    return found


# ---- LAS 2.0 (Canadian Well Logging Society) -------------------------------------------------------------------------
def _las(lines: list[str]) -> Table:
    """Curves with their units, and the data below ~A; wrapped rows are joined."""
    table, section, names, wrapped = Table(), "", list[str](), False
    start = 0
    pending: list[str] = []
    for number, line in enumerate(lines, 1):
        text = line.strip()
        if not text or text.startswith("#"):
            continue
        if text.startswith("~"):
            section = text[1:2].upper()
            start = number
            continue
        if section == "A":
            words = re.split(r"[\s,]+", text)
            pending = pending + words if wrapped else words
            if not wrapped or len(pending) >= len(names):
                table.rows.append(Row(number, pending))
                pending = []
            continue
        match = re.match(r"([^.:]+?)\s*\.(\S*)\s*(.*?)\s*(?::\s*([^:]*))?$", text)
        if match is None:
            continue
        if section == "C":
            unit = "ft" if match[2].upper() == "F" else match[2]  # the sign of LAS for feet
            names.append(f"{match[1].strip()} [{unit}]" if unit else match[1].strip())
        elif match[1].strip().upper() == "NULL":
            table.missing = match[3].strip()
        elif match[1].strip().upper() == "WRAP":
            wrapped = match[3].strip().upper() == "YES"
    if not names:
        raise TableError("is a LAS file without curves (~C)")
    if section != "A":
        raise TableError("is a LAS file without data (~A)")
    table.heads = Row(start, names)
    return table


# ---- Excel -----------------------------------------------------------------------------------------------------------
def _excel(path: pathlib.Path) -> Table:
    """The sheet with most rows that have three cells or more."""
    excel = need("openpyxl")
    try:
        book = excel.load_workbook(path, read_only=True, data_only=True)
    except OSError:
        raise
    except Exception as error:  # zipfile, XML and openpyxl raise many kinds
        raise TableError(f"is no Excel file that can be read: {error}") from error
    tables = []
    for sheet in book.worksheets:
        table = Table(separator=";")
        for number, values in enumerate(sheet.iter_rows(values_only=True), 1):
            cells = ["" if value is None else repr(value) if isinstance(value, float) else str(value).strip()
                     for value in values]
            if any(cells) and not _COMMENT.match(next(cell for cell in cells if cell)):
                table.rows.append(Row(number, cells))
        tables.append(table)
    book.close()
    if not tables:
        raise TableError("has no sheet with cells")
    best = max(range(len(tables)), key=lambda i: sum(sum(bool(cell) for cell in row.cells) >= 3
                                                     for row in tables[i].rows))
    _mark_formulas(excel.load_workbook(path, read_only=True).worksheets[best], tables[best])
    return tables[best]


def _mark_formulas(sheet: Any, table: Table) -> None:
    """Cells that are empty because their formula was not computed become that formula."""
    rows = {row.line: row for row in table.rows if not all(row.cells)}
    if not rows:
        return
    for number, values in enumerate(sheet.iter_rows(values_only=True), 1):
        for index, value in enumerate(values):
            if number in rows and isinstance(value, str) and value.startswith("=") and not rows[number].cells[index]:
                rows[number].cells[index] = value
