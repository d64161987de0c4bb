"""Outputs over time, into memory that Python shows without copying."""
from __future__ import annotations

import ctypes
import math
from collections.abc import Sequence
from ctypes import POINTER, byref, c_double
from typing import TYPE_CHECKING, Any

from ._keep import as_id, mirrors, path_of, written
from ._library import lib as _lib
from ._optional import need, numpy
from ._structs import Output, Id, ProfileRecorderStruct, ProfileStruct, RecorderStruct
from ._values import real, reals, refuse_type, refuse_value, whole
from .outputs import output_name, output_of, output_text
from .enums import OUTPUT_PROFILE, PROFILE_DISTANCE, ProfileQuantity

from .profile import unit_of, values_of
from .running import sample_due

if TYPE_CHECKING:
    from .sim import Sim
    from .window import Window

def _output(number: int, given: Any, parts: Any) -> tuple[Any, ...]:
    """The Output, perhaps with a name, of a pair or triple."""
    part = f"recorder output {number}"
    if isinstance(given, (str, Output)):
        return (output_of(given, parts, part),)
    if not isinstance(given, (tuple, list)) or len(given) not in (2, 3):
        refuse_type(part, "output", given, 'be a pair (place, "bit_speed") or a triple with a name')
    if len(given) == 3 and not isinstance(given[2], str):
        refuse_type(part, "name", given[2], "be a text")
    return output_of(tuple(given[:2]), parts, part), *given[2:]


def _interval(value: Any) -> float:
    interval = real(value, "recorder", "interval", "s")
    if not 0.0 <= interval < float("inf"):
        refuse_value("recorder", "interval", interval, "be >= 0 and finite")
    return interval


class Recorder:
    """A table of rows (time, outputs...). outputs are pairs (place, "bit_speed") or (place, OUTPUT_...), or triples
    with a name for the column; a part, or its name, means its reference point, None (or "bit_speed" alone) for an
    output without a place. Of a window
    place is the number of the watched output. Call take() after every step."""

    def __init__(self, sim: Sim, outputs: Sequence[Any], capacity: int, interval: float = 0.0,
                 window: Window | None = None) -> None:
        self.sim, self._window = sim, window
        capacity, interval = whole(capacity, "recorder", "capacity", 1, 2 ** 40), _interval(interval)
        requested = [_output(number, one, sim._parts) for number, one in enumerate(outputs)]
        self._outputs = (Output * len(outputs))(*[one for one, *_ in requested])
        self._names = [name[0] if name else output_text(one, sim._handle) for one, *name in requested]
        self._width = 1 + len(outputs)
        if window is None:
            sim._check(_lib.dmb_output_check(sim._handle, self._outputs, len(outputs)))
        if numpy is not None:
            self._memory: Any = numpy.zeros((capacity, self._width))
            table = self._memory.ctypes.data_as(POINTER(c_double))
        else:
            self._memory = (c_double * (capacity * self._width))()
            table = ctypes.cast(self._memory, POINTER(c_double))
        self._struct = RecorderStruct(output_count=len(outputs), capacity=capacity, interval=interval)
        self._struct.outputs = ctypes.cast(self._outputs, POINTER(Output))
        self._struct.table = table
        self._struct.window = None if window is None else window._handle

    @mirrors("dmb_recorder_take")
    def take(self) -> int:
        """Writes a row if its time has come; returns the status, NOTE_FULL when there is no room."""
        return self.sim._told(_lib.dmb_recorder_take(byref(self._struct), self.sim._handle), _lib.dmb_recorder_take)

    def due(self) -> float:
        """[s] of the sim before which take() writes no row"""
        rows, interval = len(self), self._struct.interval
        if not rows or not interval > 0.0:
            return -math.inf
        return sample_due(interval, self._struct.table[0], self._struct.table[(rows - 1) * self._width])

    def take_up(self, table: Any) -> None:
        """Begins with the rows of another recorder of the same outputs and interval."""
        rows, width = (*table.shape, 0, 0)[:2]
        if width != self._width or rows > self._struct.capacity:
            refuse_value("recorder", "table", (rows, width),
                         f"be of {self._width} columns and at most {self._struct.capacity} rows")
        need("numpy").frombuffer(self._memory,
                                 dtype="float64")[:rows * width] = need("numpy").asarray(table, dtype="float64").ravel()
        self._struct.row_count = rows

    def __len__(self) -> int:
        return int(self._struct.row_count)

    def _asdict(self) -> dict[str, Any]:
        """The rows so far by column."""
        return {name: [row[number] for row in self.table] if numpy is None else self.table[:, number].copy()
                for number, name in enumerate(self.columns)}

    @property
    def columns(self) -> list[str]:
        """Names of the columns with their units, "time [s]" first."""
        return ["time [s]", *self._names]

    @property
    def table(self) -> Any:
        """The rows so far: a numpy array of shape (rows, 1 + outputs) that shares the recorder's memory, or a list of
        tuples."""
        if numpy is not None and not isinstance(self._memory, ctypes.Array):
            return self._memory[:len(self)]
        width = self._width
        return [tuple(self._memory[i * width:(i + 1) * width]) for i in range(len(self))]

    def frame(self) -> Any:
        """The rows so far as a pandas frame, units in the names of its columns; a copy."""
        return need("pandas").DataFrame(self.table, columns=self.columns).copy()

    @mirrors("dmb_recorder_write_csv")
    def write_csv(self, path: Any) -> None:
        """Writes the table as CSV."""
        written(path, self._struct, _lib.dmb_recorder_write_csv(byref(self._struct), self.sim._handle, path_of(path)))


class ProfileRecorder:
    """Rows of whole profiles over time: quantities PROFILE_... at `stations` spread evenly over a string, or at
    distances [m]. Call take() after every step."""

    def __init__(self, sim: Sim, quantities: Sequence[int], stations: int | Sequence[float], capacity: int,
                 interval: float = 0.0, string: Id | str | None = None) -> None:
        string = as_id(string, sim._parts, "string")
        self.sim, self._quantities = sim, [whole(one, "profile recorder", "quantity", 0, len(ProfileQuantity) - 1)
                                           for one in quantities]
        capacity, interval = whole(capacity, "profile recorder", "capacity", 1, 2 ** 40), _interval(interval)
        if not isinstance(stations, int):
            stations = reals(stations, "profile recorder", "stations", unit="m")
        count = whole(stations, "profile recorder", "stations", 1) if isinstance(stations, int) else len(stations)
        self._shape = (count, len(self._quantities))
        self._width = 1 + count * len(self._quantities)
        self._c_quantities = (ctypes.c_int32 * len(self._quantities))(*self._quantities)
        self._profile = ProfileStruct(station_count=count, quantity_count=len(self._quantities), string=as_id(string))
        self._profile.quantities = ctypes.cast(self._c_quantities, POINTER(ctypes.c_int32))
        if not isinstance(stations, int):
            self._distance = (c_double * count)(*stations)
            self._profile.distance = ctypes.cast(self._distance, POINTER(c_double))
        self._along: Any = stations
        if numpy is not None:
            self._along = (values_of(sim, as_id(string), [PROFILE_DISTANCE], count=count)[:, 0]
                           if isinstance(stations, int)
                           else numpy.array(stations))
        self._memory = (c_double * (capacity * self._width))()
        self._struct = ProfileRecorderStruct(capacity=capacity, interval=interval)
        self._struct.profile = ctypes.pointer(self._profile)
        self._struct.table = ctypes.cast(self._memory, POINTER(c_double))

    @mirrors("dmb_profile_recorder_take")
    def take(self) -> int:
        """Writes a row if its time has come; returns the status, NOTE_FULL when there is no room."""
        return self.sim._check(_lib.dmb_profile_recorder_take(byref(self._struct), self.sim._handle))

    def due(self) -> float:
        """[s] of the sim before which take() writes no row"""
        rows, interval = len(self), self._struct.interval
        if not rows or not interval > 0.0:
            return -math.inf
        return sample_due(interval, self._memory[0], self._memory[(rows - 1) * self._width])

    def __len__(self) -> int:
        return int(self._struct.row_count)

    @property
    def columns(self) -> list[str]:
        """Names of the quantities with their units."""
        return [f"{output_name(OUTPUT_PROFILE + quantity)[len('profile_'):]} [{unit_of(quantity)}]"
                for quantity in self._quantities]

    @property
    def along(self) -> Any:
        """[m] distances of the stations from the rig end, a numpy array of shape (stations)"""
        need("numpy")
        return self._along

    def _asdict(self) -> dict[str, Any]:
        """Time, distance along the string and quantities by column, an entry for each row and station."""
        rows, stations = len(self), self._shape[0]
        values = self.values.reshape(rows * stations, self._shape[1])
        table = {"time [s]": self.time.repeat(stations), "along the string [m]": need("numpy").tile(self.along, rows)}
        table.update((name, values[:, number]) for number, name in enumerate(self.columns))
        return table

    def frame(self) -> Any:
        """A pandas frame with a row for each time and station, units in the names of its columns."""
        return need("pandas").DataFrame(self._asdict())

    @property
    def time(self) -> Any:
        """[s] of the rows, a numpy array"""
        return need("numpy").array(self._memory[:len(self) * self._width:self._width])

    @property
    def values(self) -> Any:
        """A numpy array of shape (rows, stations, quantities)"""
        rows = need("numpy").array(self._memory[:len(self) * self._width]).reshape(len(self), self._width)
        return rows[:, 1:].reshape(len(self), *self._shape)

    @mirrors("dmb_profile_recorder_write_csv")
    def write_csv(self, path: Any) -> None:
        """Writes a line for each row and station."""
        written(path, self._struct, _lib.dmb_profile_recorder_write_csv(byref(self._struct), path_of(path)))
