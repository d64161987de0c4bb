"""A study: samples by their numbers, evaluated by an engine, kept in one HDF5 file that can be read while it grows
(SWMR).

The file has one table, "samples", a row for each sample in the order in which they came in, and attributes that
identify the study in it. A run that was killed continues from the rows that are there. A file of another scene, code or
seed is refused."""
from __future__ import annotations

import contextlib
import difflib
import errno
import fcntl
import functools
import glob
import hashlib
import io
import itertools
import json
import math
import os
import pathlib
import re
import threading
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

from .. import __version__
from .._library import lib
from .._optional import need
from .rows import (Damaged, StudyError, content_of, end_of, head_of, mark_of, packed, read_rows, recovered, result,
                   row_type)
from .sample import FAILED, Result


class Sample(Protocol):
    """The subject of a study: a SceneSample, or anything with these."""

    @property
    def names(self) -> list[str]:
        """Of the margins."""

    @property
    def inputs(self) -> list[str]:
        """Of the uncertain parameters."""

    @property
    def dimension(self) -> int:
        """Of z."""

    def describe(self) -> dict[str, str]:
        """All that the results depend on."""

    def __call__(self, number: int, z: Any) -> Result:
        """The result of a sample."""


Engine = Callable[[Any, "Iterable[tuple[int, Any]]"], "Iterator[Any]"]


def _digest(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()[:16]


@functools.lru_cache(maxsize=1)
def code() -> dict[str, str]:
    """Version of the package, and digests of its files and of the library, as they were at the first call."""
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
    """All that the results depend on, by name; long texts as they are, so that a difference can be shown."""
    return {**{f"code {key}": value for key, value in code().items()}, **sample.describe(),
            **{f"setting {key}": str(value) for key, value in settings.items()}, "dimension": str(sample.dimension)}


def differences(old: dict[str, str], new: dict[str, str]) -> list[str]:
    """The differences, a line each; of texts the first lines that differ."""
    found = []
    for key in sorted(set(old) | set(new)):
        a, b = old.get(key), new.get(key)
        if a == b:
            continue
        if a is None or b is None:
            found.append(f"{key}: only in {'this run' if a is None else 'the file'}")
            continue
        first, second = a.splitlines(), b.splitlines()
        blocks = difflib.SequenceMatcher(None, first, second, autojunk=False).get_opcodes()
        _, i1, i2, j1, j2 = next((one for one in blocks if one[0] != "equal"), ("", 0, 0, 0, 0))
        of = ["; ".join(lines) or "(nothing)" for lines in (first[i1:i2], second[j1:j2])]
        found.append(f"{key}: {of[0]!r} in the file, {of[1]!r} now")
    return found


# ---- The file --------------------------------------------------------------------------------------------------------
CHUNK = 256  #: rows that HDF5 keeps together
SPARE, INDEX = 1 << 16, 1 << 8  #: bytes that a study file may need beside its rows, in all and for each chunk
_GUARD = threading.Lock()
_OPEN: set[tuple[int, int]] = set()  # lock files that this process holds, by device and inode


class Lock:
    """The right to write a study file, or those of a map, a POSIX lock on a file beside it. Such a lock is lost with
    any close of that file by its process, so a process that holds it never opens the file again. Workers that outlive
    their parent do not hold it."""

    def __init__(self, path: pathlib.Path, other: str = "file") -> None:
        place, busy = path.with_name(path.name
                                     + ".lock"), StudyError(f"{path}: another run writes it now; wait for it, or give "
                                                            f"another {other}")
        with _GUARD:
            if place.exists() and _place_of(place) in _OPEN:
                raise busy
            self._file = open(place, "w", encoding="utf-8")
            try:
                fcntl.lockf(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except OSError:
                self._file.close()
                raise busy from None
            self._key = _place_of(self._file.fileno())
            _OPEN.add(self._key)

    def release(self) -> None:
        with _GUARD:
            _OPEN.discard(self._key)
            self._file.close()


def _place_of(file: Any) -> tuple[int, int]:
    """Device and inode."""
    found = os.stat(file)
    return found.st_dev, found.st_ino


def _image(rows: Any, attributes: dict[str, str]) -> bytes:
    """A study file in memory: a full disk then fails where Python writes it, not within HDF5."""
    stream, head = io.BytesIO(), head_of(attributes)
    with need("h5py").File(stream, "w", libver="latest", userblock_size=len(head)) as file:
        file.create_dataset("samples", data=rows, maxshape=(None,), chunks=(CHUNK,), dtype=rows.dtype)
        for key, value in attributes.items():
            file.attrs[key] = value
    stream.seek(0)
    stream.write(head)
    return stream.getvalue()


class StudyFile:
    """The file; one writer at a time, held by a lock beside it. Rows that a killed writer left are copied to a new
    file, which then takes the old one's place, so that nothing that is there is ever written over. A damaged file is
    refused (Damaged); with `salvage` its sound rows are taken and it is kept beside as NAME.damaged."""

    def __init__(self, path: Any, sample: Sample, settings: dict[str, Any], salvage: bool = False) -> None:
        self.path = pathlib.Path(path)
        self.path.parent.mkdir(parents=True, exist_ok=True)
        self.names, self.inputs = list(sample.names), list(sample.inputs)
        self._known = identity(sample, settings)
        self._attributes = {"study": json.dumps(self._known), "names": json.dumps(self.names),
                            "inputs": json.dumps(self.inputs)}
        self._mark, self._kind = mark_of(self._attributes), row_type(len(self.names), len(self.inputs))
        self._waiting: list[Result] = []
        self._lock = Lock(self.path)
        try:
            self._open(salvage)
        except BaseException:
            self._lock.release()
            raise

    def _open(self, salvage: bool) -> None:
        old, kept = self._old(salvage), self._kept_files()
        self.results = {int(row["number"]): result(row)
                        for rows in [old, *(recovered(one, self._attributes) for one in kept)] for row in rows}
        new = self.path.with_name(self.path.name + ".new")
        _write(new, self._whole())
        os.replace(new, self.path)
        for one in kept:
            one.unlink()
        self._file = need("h5py").File(self.path, "r+", libver="latest")
        self._table = self._file["samples"]
        self._file.swmr_mode = True
        self._place = _place_of(self.path)
        self._end = os.open(self.path, os.O_RDWR)
        self._reserved = self._begin = os.fstat(self._end).st_size  # [bytes]

    def _whole(self) -> bytes:
        """A file with all results."""
        return _image(packed(list(self.results.values()), self._kind, self._mark, 0), self._attributes)

    def _kept_files(self) -> list[pathlib.Path]:
        """Rows of this study that a writer put aside when it had lost its file."""
        found = sorted(self.path.parent.glob(glob.escape(self.path.name) + ".kept-*"))
        return [one for one in found if len(recovered(one, self._attributes))]

    def _old(self, salvage: bool) -> Any:
        """The rows of the file that is there."""
        if not self.path.exists():
            return need("numpy").zeros(0, self._kind)
        try:
            return self._sound_rows()
        except Damaged as error:
            if not salvage:
                raise
            os.replace(self.path, self.path.with_name(self.path.name + ".damaged"))
            return error.rows

    def _sound_rows(self) -> Any:
        try:
            found = content_of(self.path)
        except StudyError as error:
            rows = recovered(self.path, self._attributes)
            if len(rows):
                raise Damaged(self.path, str(error).split(": is no study file: ", 1)[-1], rows) from error
            raise
        different = differences(json.loads(found.attributes["study"]), self._known)
        if different:
            raise StudyError(f"{self.path}: belongs to a different study; choose another --output folder or move the "
                             "file. Differences:\n  "
                             + "\n  ".join(different))
        if found.damage:
            raise Damaged(self.path, found.damage, found.rows)
        return found.rows

    def add(self, one: Result) -> None:
        """One more; every number once."""
        if one.number not in self.results:
            self.results[one.number] = one
            self._waiting.append(one)

    def flush(self) -> None:
        """Writes added rows into the file. Raises OSError if the disk is full."""
        if not self._waiting:
            return
        self._still_there()
        rows = packed(self._waiting, self._kind, self._mark, len(self._table))
        self._reserve(len(self._table) + len(rows))
        try:
            count = len(self._table)
            self._table.resize((count + len(rows),))
            self._table[count:] = rows
            self._table.flush()
        except (RuntimeError, OSError) as error:
            raise _os_error(error, self.path) from error
        self._waiting.clear()

    def _reserve(self, rows: int) -> None:
        """Makes the file longer than HDF5 needs it for so many rows. Raises OSError if the disk has no room: HDF5
        itself ends the process then."""
        end = self._begin + SPARE + (rows // CHUNK + 2) * (CHUNK * self._kind.itemsize + INDEX)
        if end <= self._reserved or not hasattr(os, "posix_fallocate"):
            return
        try:
            os.posix_fallocate(self._end, self._reserved, end - self._reserved)
        except OSError as error:
            raise OSError(error.errno, f"{os.strerror(error.errno or errno.EIO)}; the rows so far are in the file",
                          str(self.path)) from error
        self._reserved = end

    def _still_there(self) -> None:
        """Raises StudyError if another file has taken the place of this one; all rows are put aside then, for the next
        run."""
        try:
            if _place_of(self.path) == self._place:
                return
        except FileNotFoundError:
            pass
        aside = self.path.with_name(f"{self.path.name}.kept-{os.getpid()}")
        _write(aside, self._whole())
        self._waiting.clear()
        raise StudyError(f"{self.path}: was moved or replaced while this run wrote it, as by another run on a file "
                         "system without locks; "
                         f"its {len(self.results)} finished rows are in {aside.name}, which the same command takes in "
                         "when it is called again")

    def close(self) -> None:
        """Writes the remaining rows and closes the file."""
        try:
            self.flush()
        finally:
            try:
                self._file.close()
                end = end_of(os.pread(self._end, 1 << 20, 0))
                if end:  # what was reserved and not used
                    os.ftruncate(self._end, end)
            except RuntimeError as error:
                raise _os_error(error, self.path) from error
            finally:
                os.close(self._end)
                self._lock.release()

    def __enter__(self) -> StudyFile:
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()


def _write(path: pathlib.Path, data: bytes) -> None:
    """The whole or nothing."""
    try:
        with open(path, "wb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
    except OSError:
        with contextlib.suppress(OSError):
            path.unlink()
        raise


def _os_error(error: BaseException, path: pathlib.Path) -> OSError:
    """An error of HDF5 as one of the system."""
    number = re.search(r"errno = (\d+)", str(error))
    code = int(number.group(1)) if number else errno.EIO
    return OSError(code, os.strerror(code), str(path))


@dataclass
class Progress:
    """Progress of a study."""
    done: int
    total: int
    lost: int      #: samples without a margin so far
    message: str   #: of the last such


BLOCK = 200  #: samples of torque and drag that are one task of an engine and one addition to the file


class Blocks:
    """Quick samples as tasks of several, (number of the first, [(number, z), ...]); the result is a list."""

    def __init__(self, sample: Any) -> None:
        self.sample, self.names, self.inputs = sample, sample.names, sample.inputs
        sample.soft  # made here, so that forked workers need not

    def __call__(self, number: int, tasks: Sequence[tuple[int, Any]]) -> list[Result]:
        found: list[Result] = self.sample.many(tasks)
        return found

    @staticmethod
    def of(tasks: Iterable[tuple[int, Any]]) -> Iterator[tuple[int, Any]]:
        """Tasks of BLOCK samples."""
        source = iter(tasks)
        while block := list(itertools.islice(source, BLOCK)):
            yield block[0][0], block


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
            for results in self._computed((number, z_of(number)) for number in missing):
                self._keep(results)
                for one in results:
                    if one.status == FAILED:
                        lost, message = lost + 1, f"sample {one.number}: {one.message}"
                if self.progress is not None:
                    self.progress(Progress(len(self.results), len(numbers), lost, message))
        finally:
            if self.file is not None:
                self.file.flush()
        return [self.results[number] for number in numbers]

    def _computed(self, tasks: Iterable[tuple[int, Any]]) -> Iterator[list[Result]]:
        if getattr(self.sample, "quick", False):
            yield from self.engine(Blocks(self.sample), Blocks.of(tasks))
        else:
            yield from ([one] for one in self.engine(self.sample, tasks))

    def _keep(self, results: list[Result]) -> None:
        self.evaluated += len(results)
        if self.file is None:
            self.results.update((one.number, one) for one in results)
            return
        for one in results:
            self.file.add(one)
        self.file.flush()

    def evaluate(self, limit: int = 0, scales: Sequence[float] | None = None) -> Callable[[Sequence[int], Any], Any]:
        """The margins of limit state `limit`; or the smallest of all over their scales, a failure of anything, where
        scales are given. NaN of a sample that failed."""
        numpy = need("numpy")

        def margins_of(numbers: Sequence[int], z: Any) -> Any:
            by_number = dict(zip(numbers, z))
            margins = numpy.array([one.margins for one in self.run(numbers, by_number.__getitem__)])
            return margins[:, limit] if scales is None else (margins / numpy.asarray(scales)).min(axis=1)
        return margins_of


def usable(margins: Sequence[float]) -> bool:
    """Whether a result has all of its margins."""
    return not any(math.isnan(one) for one in margins)


__all__ = ["Damaged", "Progress", "Sample", "Study", "StudyError", "StudyFile", "code", "differences", "identity",
           "read_rows", "usable"]
