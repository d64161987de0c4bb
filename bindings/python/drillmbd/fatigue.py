"""Fatigue of places during a run."""
from __future__ import annotations

from collections.abc import Sequence
from ctypes import byref, c_double, c_void_p
from typing import TYPE_CHECKING, Any

from ._handle import Handle
from ._keep import as_place, mirrors
from ._library import lib as _lib
from ._structs import FatigueOptions, FatigueResult, Place
from .errors import check

if TYPE_CHECKING:
    from .sim import Sim


class Fatigue(Handle):
    """Counts the cycles of stress at places of a sim; made by Sim.fatigue. Call take() after every step."""
    _kind = "fatigue"

    def __init__(self, sim: Sim, places: Sequence[Any], options: FatigueOptions) -> None:
        self._sim, self._handle, self._options = sim, c_void_p(), options
        asked = (Place * len(places))(*[as_place(place) for place in places])
        sim._check(_lib.dmb_fatigue_create(sim._handle, byref(options), asked, len(places), byref(self._handle)))

    @mirrors("dmb_fatigue_take")
    def take(self) -> int:
        """Takes a sample; returns the status."""
        return check(_lib.dmb_fatigue_take(self._handle, self._sim._handle))

    @mirrors("dmb_fatigue_get")
    def result(self, place: int = 0) -> FatigueResult:
        """Damage, cycles, largest range [Pa] and life [s] of a place, by its number."""
        answer: FatigueResult = FatigueResult.blank()
        check(_lib.dmb_fatigue_get(self._handle, place, byref(answer)))
        return answer

    @mirrors("dmb_fatigue_histogram")
    def histogram(self, place: int = 0) -> tuple[list[float], list[float]]:
        """Ranges [Pa] and how many cycles have them, at the worst point of a place."""
        cycles = (c_double * self._options.classes)()
        check(_lib.dmb_fatigue_histogram(self._handle, place, cycles))
        width = 2.0 * self._options.stress_range / self._options.classes
        return [i * width for i in range(len(cycles))], list(cycles)
