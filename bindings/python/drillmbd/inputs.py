"""Inputs of a sim: values that a controller or an operator changes while it runs."""
from __future__ import annotations

from collections.abc import Iterator, Mapping, MutableMapping
from ctypes import byref, c_double, c_uint32
from typing import TYPE_CHECKING, Any

from ._keep import mirrors
from ._library import lib as _lib
from ._values import real, whole
from ._structs import Id, InputInfo, InputRecord, InputState

if TYPE_CHECKING:
    from .sim import Sim


class Inputs(MutableMapping[str, float]):
    """Names to values [unit of the input]: reading one gives the set point, setting one holds from now on."""

    def __init__(self, sim: Sim) -> None:
        self._sim = sim

    @property
    def info(self) -> Mapping[str, InputInfo]:
        """Unit, bounds and limits of each input, by name."""
        return self._sim._inputs

    def _id(self, name: str) -> Id:
        try:
            return self._sim._inputs[name].input
        except KeyError:
            known = ", ".join(self._sim._inputs) or "none"
            raise KeyError(f"no input {name!r}; the model has {known}") from None

    @mirrors("dmb_sim_get_input")
    def state(self, name: str) -> InputState:
        """The set point, the value in force, its rate, and the time at which the set point is reached."""
        result: InputState = self._sim._query(_lib.dmb_sim_get_input, InputState.blank(), self._id(name))
        return result

    def __getitem__(self, name: str) -> float:
        return float(self.state(name).value)

    def __setitem__(self, name: str, value: float) -> None:
        self.set({name: value})

    def __delitem__(self, name: str) -> None:
        raise TypeError("an input is part of the model and cannot be taken away")

    def __iter__(self) -> Iterator[str]:
        return iter(self._sim._inputs)

    def __len__(self) -> int:
        return len(self._sim._inputs)

    @mirrors("dmb_sim_set_inputs")
    def set(self, values: Mapping[str, float]) -> int:
        """Sets several at once, all or none; returns the status, NOTE_CLAMPED where a bound was taken instead."""
        ids = (Id * len(values))(*(self._id(name) for name in values))
        numbers = (c_double * len(values))(*(real(value, f"input {name}", "value", self.info[name].unit.decode())
                                             for name, value in values.items()))
        return self._sim._check(_lib.dmb_sim_set_inputs(self._sim._handle, ids, numbers, len(values)))

    @mirrors("dmb_sim_record_inputs")
    def record(self, capacity: int = 10000) -> InputLog:
        """Values set from now on go into a log of at most `capacity` records."""
        return InputLog(self._sim, capacity)

    @mirrors("dmb_sim_replay_inputs")
    def replay(self, records: Any, next_record: int = 0) -> int:
        """Sets the values of the records (of InputLog.take) from number next_record on up to the present time; returns
        the number of the first that is still to come. Called before each step, it gives the states of the recorded
        run."""
        array = (InputRecord * len(records))(*records)
        place = c_uint32(next_record)
        self._sim._check(_lib.dmb_sim_replay_inputs(self._sim._handle, array, len(records), byref(place)))
        return place.value


class InputLog:
    """Records of set points and times, written by the library while the sim lives."""

    def __init__(self, sim: Sim, capacity: int) -> None:
        capacity = whole(capacity, "input log", "capacity", 1)
        self._sim, self._records = sim, (InputRecord * capacity)()
        sim._log = self  # the memory lives as long as the sim may write to it
        sim._check(_lib.dmb_sim_record_inputs(sim._handle, self._records, capacity))

    def _asdict(self) -> dict[str, list[Any]]:
        """The fields of the records so far by name."""
        from .frames import by_field
        return by_field(InputRecord, self.take())

    def take(self) -> list[InputRecord]:
        """The records so far, copied."""
        count = _lib.dmb_sim_recorded_inputs(self._sim._handle) if self._sim._log is self else 0
        return [InputRecord.from_buffer_copy(self._records[i]) for i in range(count)]
