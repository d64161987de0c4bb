"""Channels over time, into memory that Python shows without copying."""
from __future__ import annotations

import ctypes
from collections.abc import Sequence
from ctypes import POINTER, byref, c_double
from typing import TYPE_CHECKING, Any

from ._keep import as_place, mirrors, path_of
from ._library import lib as _lib
from ._optional import need, numpy
from ._structs import Channel, RecorderStruct
from .enums import Quantity
from .errors import check

if TYPE_CHECKING:
    from .sim import Sim

UNITS = {"DISPLACEMENT": "m", "VELOCITY": "m/s", "POSITION": "m", "ROTATION": "rad", "SPIN": "rad/s", "AXIAL_FORCE": "N",
         "TORQUE": "N m", "BENDING_MOMENT": "N m", "KINETIC_ENERGY": "J", "NORMAL_FORCE": "N", "DRIVE_FORCE": "N or N m",
         "DRIVE_SPEED": "m/s or rad/s", "BIT_WEIGHT": "N", "ENERGY_ERROR": "-"}


class Recorder:
    """A table of rows (time, channels...). channels are pairs (place, CHANNEL_...), or triples with a name for the
    column; a part stands for its reference point, None for a channel without a place. Call take() after every step."""

    def __init__(self, sim: Sim, channels: Sequence[Any], capacity: int, interval: float = 0.0) -> None:
        self._sim = sim
        self._names = [self._name(*channel) for channel in channels]
        self._channels = (Channel * len(channels))(*[Channel(as_place(place), quantity, 0)
                                                     for place, quantity, *_ in channels])
        self._width = 1 + len(channels)
        if numpy is not None:
            self._memory: Any = numpy.zeros((capacity, self._width))
            table = self._memory.ctypes.data_as(POINTER(c_double))
        else:
            self._memory = (c_double * (capacity * self._width))()
            table = ctypes.cast(self._memory, POINTER(c_double))
        self._struct = RecorderStruct(channel_count=len(channels), capacity=capacity, interval=interval)
        self._struct.channels = ctypes.cast(self._channels, POINTER(Channel))
        self._struct.table = table

    @staticmethod
    def _name(place: Any, quantity: int, name: str | None = None) -> str:
        if name is not None:
            return name
        known = Quantity(quantity).name
        unit = next((unit for start, unit in UNITS.items() if known.startswith(start)), "")
        at = as_place(place)
        where = f" part {at.part.index & 0xFFFFFF} pipe {at.pipe} at {at.fraction:g}" if at.part else ""
        return f"{known.lower()}{where} [{unit}]"

    @mirrors("dmb_recorder_take")
    def take(self) -> int:
        """Writes a row if its time has come; returns the status, NOTE_FULL when there is no room."""
        return check(_lib.dmb_recorder_take(byref(self._struct), self._sim._handle))

    def __len__(self) -> int:
        return int(self._struct.row_count)

    @property
    def columns(self) -> list[str]:
        """Names of the columns with their units, "time [s]" first."""
        return ["time [s]", *self._names]

    @property
    def table(self) -> Any:
        """The rows so far: a numpy array of shape (rows, 1 + channels) that shares the recorder's memory, or a list of
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
        check(_lib.dmb_recorder_write_csv(byref(self._struct), path_of(path)))
