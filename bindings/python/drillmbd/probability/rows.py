"""Rows of a study file, an HDF5 file behind a head of its own that describes the study. Each row carries a mark, which
is a digest of that description, its place among the rows, and a check sum of its bytes. Rows are therefore read from
the bytes of the file, without HDF5: damage is found, sound rows are recovered beside damaged ones, and no reader waits,
as HDF5 does (SWMR) where a check sum of its own is wrong."""
from __future__ import annotations

import hashlib
import json
import pathlib
import time
import zlib
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from .._optional import need
from .sample import Result

LONGEST = 240  #: bytes of a message that are kept
#: readings of a file that another process writes, whose last rows may be seen half written; [s]
_TRIES, _PAUSE = 3, 0.05


class StudyError(ValueError):
    """A study file that is refused."""


class Damaged(StudyError):
    """A study file of which bytes are wrong or missing; `rows` are those that are sound."""

    def __init__(self, path: Any, reason: str, rows: Any) -> None:
        self.rows = rows
        found = f"{len(rows)} sound {'row' if len(rows) == 1 else 'rows'}"
        super().__init__(f"{path}: is damaged: {reason}; {found} can be recovered: drillmbd probability --salvage "
                         "keeps them, computes the others again "
                         f"and leaves the damaged file beside as {pathlib.Path(path).name}.damaged")


MAGIC = b"drillmbd study 1\n"
_SUPERBLOCK = b"\x89HDF\r\n\x1a\n"


def row_type(names: int, inputs: int) -> Any:
    """The row of a study with so many margins and inputs, without gaps."""
    return need("numpy").dtype([("mark", "<u8"), ("row", "<i8"), ("number", "<i8"), ("status", "<i4"),
                                ("seconds", "<f8"), ("margin", "<f8", (names,)),
                                ("demand", "<f8", (names,)), ("input", "<f8", (inputs,)), ("message", f"S{LONGEST}"),
                                ("check", "<u4")])


def head_of(attributes: dict[str, str]) -> bytes:
    """The head of a file: description and its check sum, in the size that HDF5 leaves free before its own (a power of
    2)."""
    text = json.dumps(attributes).encode()
    head = MAGIC + b"%08x %d\n" % (zlib.crc32(text), len(text)) + text
    return head.ljust(max(512, 1 << (len(head) - 1).bit_length()), b"\0")


def mark_of(attributes: dict[str, str]) -> int:
    """Digest of the description of a study; never 0."""
    return int.from_bytes(hashlib.sha256(json.dumps(attributes).encode()).digest()[:8], "little") | 1


def _sum(row: Any) -> int:
    """Check sum of a row without its last bytes, which hold it; never 0, as where it is not written yet."""
    return zlib.crc32(row[:-4]) or 1


def packed(results: Sequence[Result], kind: Any, mark: int, first: int) -> Any:
    """Results as rows, of which the first has this place."""
    numpy = need("numpy")
    rows = numpy.zeros(len(results), kind)
    for place, (row, one) in enumerate(zip(rows, results)):
        row["mark"], row["row"], row["number"], row["status"], row["seconds"] = (mark, first + place, one.number,
                                                                                 one.status, one.seconds)
        row["margin"], row["demand"], row["input"] = one.margins, one.demands, one.inputs
        row["message"] = one.message.encode()[:LONGEST]
    size, data = kind.itemsize, memoryview(rows.tobytes())
    rows["check"] = [_sum(data[i * size:(i + 1) * size]) for i in range(len(rows))]
    return rows


def result(row: Any) -> Result:
    """A row as the result of its sample."""
    return Result(int(row["number"]), int(row["status"]), [float(v) for v in row["margin"]],
                  [float(v) for v in row["demand"]],
                  [float(v) for v in row["input"]], float(row["seconds"]), row["message"].decode("utf-8", "replace"))


def once(rows: Any) -> Any:
    """Each number once, in rising order."""
    return rows[need("numpy").unique(rows["number"], return_index=True)[1]]


# ---- Reading ---------------------------------------------------------------------------------------------------------
@dataclass
class Content:
    """A study file as it is read: sound rows, each number once, description, faults of the file."""
    rows: Any
    attributes: dict[str, str] = field(default_factory=dict)
    damage: str = ""


def _described(data: bytes) -> dict[str, str]:
    """The description in the head. Raises ValueError."""
    if not data.startswith(MAGIC):
        raise ValueError("it does not begin with the description of a study")
    line, _, rest = data[len(MAGIC):].partition(b"\n")
    try:
        total, length = int(line[:8], 16), int(line[9:])
        found = json.loads(rest[:length]) if zlib.crc32(rest[:length]) == total else None
    except ValueError:
        found = None
    if not isinstance(found, dict):
        raise ValueError("the description of the study has a wrong check sum")
    return found


def _rows(data: bytes, kind: Any, mark: int) -> tuple[Any, str]:
    """Rows by their mark, and evidence that some are damaged or missing. A row without its check sum, which is the last
    of it to be written, was cut off when a process was killed: it is not damage."""
    numpy, wanted, found, wrong = need("numpy"), mark.to_bytes(8, "little"), [], 0
    at = data.find(wanted)
    while at >= 0:
        row = data[at:at + kind.itemsize]
        good = len(row) == kind.itemsize and int.from_bytes(row[-4:], "little") == _sum(row)
        wrong += not good and row[-4:] != b"\0\0\0\0"
        found += [row] if good else []
        at = data.find(wanted, at + (kind.itemsize if good else 1))
    rows = numpy.frombuffer(b"".join(found), dtype=kind)
    missing = int(rows["row"].max()) + 1 - len(numpy.unique(rows["row"])) if len(rows) else 0
    if wrong or missing:
        many = max(len(rows) + wrong, len(rows) + missing)
        return once(rows), f"{max(wrong, missing)} of {many} rows are damaged or missing"
    return once(rows), ""


def end_of(data: bytes) -> int:
    """[bytes] that the file has by the superblock of HDF5; 0 where that is missing."""
    at = data.find(_SUPERBLOCK)
    return int.from_bytes(data[at + 28:at + 36], "little") if at >= 0 and len(data) >= at + 48 else 0


def _cut(data: bytes) -> str:
    """The size that a file should have, where it has less."""
    end = end_of(data)
    return ("" if 0 < end <= len(data) else f"it has {len(data)} bytes, {end} were written" if end
            else "the beginning of its table is missing")


def _read(path: Any) -> Content:
    data = pathlib.Path(path).read_bytes()
    attributes = _described(data)
    kind = row_type(len(json.loads(attributes["names"])), len(json.loads(attributes["inputs"])))
    rows, damage = _rows(data, kind, mark_of(attributes))
    return Content(rows, attributes, damage or _cut(data))


def content_of(path: Any) -> Content:
    """The file; read again where rows seem damaged, because another process may be writing them. Raises StudyError,
    OSError."""
    try:
        found = _read(path)
        for _ in range(_TRIES - 1):
            if not found.damage:
                break
            time.sleep(_PAUSE)
            found = _read(path)
    except (ValueError, KeyError) as error:
        raise StudyError(f"{path}: is no study file: {error}") from error
    return found


def read_rows(path: Any) -> tuple[Any, dict[str, str]]:
    """The rows of a study file that are complete, a numpy array of records (mark, row, number, status, seconds, margin,
    demand, input, message, check) in the order of number, and its attributes; also while another process writes it. A
    damaged file is refused (Damaged)."""
    try:
        found = content_of(path)
    except OSError as error:
        raise StudyError(f"{path}: {error.strerror or error}") from error
    if found.damage:
        raise Damaged(path, found.damage, found.rows)
    return found.rows, found.attributes


def recovered(path: Any, attributes: dict[str, str]) -> Any:
    """The sound rows of a study anywhere among the bytes of a file."""
    kind = row_type(len(json.loads(attributes["names"])), len(json.loads(attributes["inputs"])))
    return _rows(pathlib.Path(path).read_bytes(), kind, mark_of(attributes))[0]
