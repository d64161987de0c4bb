"""A study: samples by their numbers, evaluated by an engine, kept in one HDF5 file that can be read while it grows (SWMR).

The file has one table, "samples", a row for each sample in the order in which they came in, and attributes that say what the study is
of. A run that was killed goes on from the rows that are there. A file of another scene, code or seed is refused."""
from __future__ import annotations

import difflib
import fcntl
import functools
import hashlib
import json
import math
import os
import pathlib
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

from .. import __version__
from .._library import lib
from .._optional import need
from .sample import DONE, FAILED, Result

LONGEST = 240  #: bytes of a message that are kept
_OPEN: set[str] = set()  # files that this process writes


class StudyError(ValueError):
    """A study file that is refused."""


class Sample(Protocol):
    """The subject of a study: a SceneSample, or anything with these."""

    @property
    def names(self) -> list[str]:
        """Of the margins."""

    @property
    def inputs(self) -> list[str]:
        """Of what varies."""

    @property
    def dimension(self) -> int:
        """Of z."""

    def describe(self) -> dict[str, str]:
        """All that the results depend on."""

    def __call__(self, number: int, z: Any) -> Result:
        """The result of a sample."""


Engine = Callable[[Any, "Iterable[tuple[int, Any]]"], "Iterator[Result]"]


def _digest(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()[:16]


@functools.lru_cache(maxsize=1)
def code() -> dict[str, str]:
    """Version of the package, and digests of its files and of the library, as they were when first asked for."""
    root = pathlib.Path(__file__).resolve().parents[1]
    mine = hashlib.sha256()
    for file in sorted(root.rglob("*.py")):
        mine.update(str(file.relative_to(root)).encode() + file.read_bytes())
    library = getattr(lib, "_name", None)
    found = {"version": __version__, "package": mine.hexdigest()[:16]}
    if isinstance(library, str) and os.path.isfile(library):
        found["library"] = _digest(pathlib.Path(library).read_bytes())
    return found


def identity(sample: Sample, settings: dict[str, Any]) -> dict[str, str]:
    """All that the results depend on, by name; long texts as they are, so that a difference can be told."""
    return {**{f"code {key}": value for key, value in code().items()}, **sample.describe(),
            **{f"setting {key}": str(value) for key, value in settings.items()}, "dimension": str(sample.dimension)}


def differences(old: dict[str, str], new: dict[str, str]) -> list[str]:
    """The differences, a line each; of texts the first lines that differ."""
    told = []
    for key in sorted(set(old) | set(new)):
        a, b = old.get(key), new.get(key)
        if a == b:
            continue
        if a is None or b is None:
            told.append(f"{key}: only in {'this run' if a is None else 'the file'}")
            continue
        first, second = a.splitlines(), b.splitlines()
        blocks = difflib.SequenceMatcher(None, first, second, autojunk=False).get_opcodes()
        _, i1, i2, j1, j2 = next((one for one in blocks if one[0] != "equal"), ("", 0, 0, 0, 0))
        of = ["; ".join(lines) or "(nothing)" for lines in (first[i1:i2], second[j1:j2])]
        told.append(f"{key}: {of[0]!r} in the file, {of[1]!r} now")
    return told


def _row_type(names: int, inputs: int) -> Any:
    numpy = need("numpy")
    return numpy.dtype([("number", "<i8"), ("status", "<i4"), ("seconds", "<f8"), ("margin", "<f8", (names,)),
                        ("demand", "<f8", (names,)), ("input", "<f8", (inputs,)), ("message", f"S{LONGEST}")])


class StudyFile:
    """The file; one writer at a time, held by a lock beside it. Rows that a killed writer left are copied to a new file, which then
    takes the old one's place, so that nothing that is there is ever written over."""

    def __init__(self, path: Any, sample: Sample, settings: dict[str, Any]) -> None:
        self.path = pathlib.Path(path)
        h5py, numpy = need("h5py"), need("numpy")
        self.path.parent.mkdir(parents=True, exist_ok=True)
        self._lock = open(self.path.with_name(self.path.name + ".lock"), "w", encoding="utf-8")
        try:
            if str(self.path.resolve()) in _OPEN:
                raise OSError
            fcntl.lockf(self._lock, fcntl.LOCK_EX | fcntl.LOCK_NB)  # of this process; workers that outlive it do not hold it
        except OSError:
            self._lock.close()
            raise StudyError(f"{self.path}: another run writes it now; wait for it, or give another file") from None
        self.names, self.inputs = list(sample.names), list(sample.inputs)
        known = identity(sample, settings)
        kind = _row_type(len(self.names), len(self.inputs))
        try:
            rows = self._old(known) if self.path.exists() else numpy.zeros(0, kind)
        except BaseException:
            self._lock.close()
            raise
        new = self.path.with_name(self.path.name + ".new")
        self._file = h5py.File(new, "w", libver="latest")
        self._table = self._file.create_dataset("samples", data=rows.astype(kind), maxshape=(None,), chunks=(256,), dtype=kind)
        self._file.attrs["study"] = json.dumps(known)
        self._file.attrs["names"], self._file.attrs["inputs"] = json.dumps(self.names), json.dumps(self.inputs)
        self._file.flush()
        os.replace(new, self.path)
        self._file.swmr_mode = True
        _OPEN.add(str(self.path.resolve()))
        self.results = {int(row["number"]): _result(row) for row in rows}
        self._waiting: list[Result] = []

    def _old(self, known: dict[str, str]) -> Any:
        rows, attributes = read_rows(self.path)
        different = differences(json.loads(attributes["study"]), known)
        if different:
            raise StudyError(f"{self.path}: is a study of something else; give another file, or move this one away. What differs:\n  "
                             + "\n  ".join(different))
        return rows

    def add(self, result: Result) -> None:
        """One more; every number once."""
        if result.number not in self.results:
            self.results[result.number] = result
            self._waiting.append(result)

    def flush(self) -> None:
        """Puts what was added into the file."""
        numpy = need("numpy")
        if not self._waiting:
            return
        rows = numpy.zeros(len(self._waiting), self._table.dtype)
        for row, one in zip(rows, self._waiting):
            row["number"], row["status"], row["seconds"] = one.number, one.status, one.seconds
            row["margin"], row["demand"], row["input"] = one.margins, one.demands, one.inputs
            row["message"] = one.message.encode()[:LONGEST]
        count = len(self._table)
        self._table.resize((count + len(rows),))
        self._table[count:] = rows
        self._table.flush()
        self._waiting.clear()

    def close(self) -> None:
        """Writes the rest and lets the file go."""
        try:
            self.flush()
        finally:
            _OPEN.discard(str(self.path.resolve()))
            self._file.close()
            self._lock.close()

    def __enter__(self) -> StudyFile:
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()


def _result(row: Any) -> Result:
    return Result(int(row["number"]), int(row["status"]), [float(v) for v in row["margin"]], [float(v) for v in row["demand"]],
                  [float(v) for v in row["input"]], float(row["seconds"]), row["message"].decode("utf-8", "replace"))


def read_rows(path: Any) -> tuple[Any, dict[str, str]]:
    """The rows of a study file that are complete, a numpy array of records (number, status, seconds, margin, demand, input,
    message), and its attributes; also while another process writes it."""
    h5py, numpy = need("h5py"), need("numpy")
    try:
        with h5py.File(path, "r", libver="latest", swmr=True) as file:
            rows = file["samples"][:]
            attributes = {key: str(value) for key, value in file.attrs.items()}
            attributes["study"], attributes["names"]
    except (OSError, KeyError, ValueError) as error:
        raise StudyError(f"{path}: is no study file: {error}") from error
    rows = rows[(rows["status"] == DONE) | (rows["status"] == FAILED)]  # a row that was cut off is all 0
    return rows[numpy.unique(rows["number"], return_index=True)[1]], attributes


@dataclass
class Progress:
    """Progress of a study."""
    done: int
    asked: int
    lost: int      #: samples without a margin so far
    message: str   #: of the last such


class Study:
    """Evaluates samples by an engine. Samples in the file are not computed again; without a file all is kept in
    memory."""

    def __init__(self, sample: Sample, engine: Engine, file: StudyFile | None = None,
                 progress: Callable[[Progress], Any] | None = None) -> None:
        self.sample, self.engine, self.file, self.progress = sample, engine, file, progress
        self.results: dict[int, Result] = file.results if file is not None else {}
        self.evaluated = 0  #: in this run

    def run(self, numbers: Sequence[int], z_of: Callable[[int], Any]) -> list[Result]:
        """Their results, in this order."""
        missing = [number for number in numbers if number not in self.results]
        lost, message = sum(self.results[n].status == FAILED for n in numbers if n in self.results), ""
        try:
            for result in self.engine(self.sample, ((number, z_of(number)) for number in missing)):
                self._keep(result)
                if result.status == FAILED:
                    lost, message = lost + 1, f"sample {result.number}: {result.message}"
                if self.progress is not None:
                    self.progress(Progress(len(self.results), len(numbers), lost, message))
        finally:
            if self.file is not None:
                self.file.flush()
        return [self.results[number] for number in numbers]

    def _keep(self, result: Result) -> None:
        self.evaluated += 1
        if self.file is not None:
            self.file.add(result)
            self.file.flush()
        else:
            self.results[result.number] = result

    def evaluate(self, limit: int = 0, scales: Sequence[float] | None = None) -> Callable[[Sequence[int], Any], Any]:
        """The margins of limit state `limit`; or the smallest of all over their scales, a failure of anything, where scales are
        given. NaN of a sample that failed."""
        numpy = need("numpy")

        def ask(numbers: Sequence[int], z: Any) -> Any:
            by_number = dict(zip(numbers, z))
            margins = numpy.array([one.margins for one in self.run(numbers, by_number.__getitem__)])
            return margins[:, limit] if scales is None else (margins / numpy.asarray(scales)).min(axis=1)
        return ask


def usable(margins: Sequence[float]) -> bool:
    """Whether a result has all of its margins."""
    return not any(math.isnan(one) for one in margins)
