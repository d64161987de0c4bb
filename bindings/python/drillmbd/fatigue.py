"""Fatigue of places during a run, and of whole strings."""
from __future__ import annotations

from collections.abc import Sequence
from ctypes import Structure, byref, c_double, c_size_t, c_void_p, create_string_buffer
from typing import TYPE_CHECKING, Any

from ._handle import Handle
from ._keep import as_place, mirrors, station
from ._library import lib as _lib
from ._parts import index_of
from ._structs import FatigueOptions, FatigueResult, Place
from ._values import refuse_type, whole

if TYPE_CHECKING:
    from ._structs import Id
    from .sim import Sim

PLACES = 200  #: pipes along a string, at most


def counted(pipes: int) -> list[int]:
    """Numbers of the pipes of a string that are counted, spread evenly where there are more than PLACES."""
    count = min(pipes, PLACES)
    return [round((i + 0.5) * pipes / count - 0.5) for i in range(count)]


class Fatigue(Handle):
    """Counts the cycles of stress at places of a sim; made by Sim.fatigue. Call take() after every step."""
    _kind = "fatigue"

    def __init__(self, sim: Sim, places: Sequence[Any], options: FatigueOptions) -> None:
        self.sim, self._handle, self._options = sim, c_void_p(), options
        self._count = len(places)
        requested = (Place * len(places))(*[as_place(place, sim._parts) for place in places])
        sim._check(_lib.dmb_fatigue_create(sim._handle, byref(options), requested, len(places), byref(self._handle)))

    @mirrors("dmb_fatigue_take")
    def take(self) -> int:
        """Takes a sample; returns the status."""
        return self._sure(_lib.dmb_fatigue_take(self._handle, self.sim._handle))

    @mirrors("dmb_fatigue_get")
    def result(self, place: int = 0) -> FatigueResult:
        """Damage, cycles, largest range [Pa] and life [s] of a place, by its number."""
        result: FatigueResult = FatigueResult.blank()
        place = index_of("fatigue", "place", place, self._count)
        self._sure(_lib.dmb_fatigue_get(self._handle, place, byref(result)))
        return result

    @mirrors("dmb_fatigue_snapshot")
    def snapshot(self) -> bytes:
        """The counts so far, as bytes; a copy."""
        size = c_size_t()
        self._sure(_lib.dmb_fatigue_snapshot_size(self._handle, byref(size)))
        block = create_string_buffer(size.value)
        self._sure(_lib.dmb_fatigue_snapshot(self._handle, block, size.value))
        return block.raw

    @mirrors("dmb_fatigue_restore")
    def restore(self, snapshot: Any) -> None:
        """Counts on from a snapshot of a Fatigue of the same options and places, of another process too."""
        if isinstance(snapshot, (str, int)) or not hasattr(snapshot, "__len__"):
            refuse_type("fatigue snapshot", "snapshot", snapshot, "be bytes of Fatigue.snapshot")
        snapshot = bytes(snapshot)
        self._sure(_lib.dmb_fatigue_restore(self._handle, snapshot, len(snapshot)))

    def _asdict(self) -> dict[str, list[Any]]:
        """The fields of the results by name, place by place."""
        from .frames import by_field
        return by_field(FatigueResult, (self.result(place) for place in range(self._count)))

    def frame(self) -> Any:
        """The places as a pandas frame, one row each, units in the names of its columns."""
        from .frames import frame_of
        return frame_of(FatigueResult, [self.result(place) for place in range(self._count)])

    @mirrors("dmb_fatigue_histogram")
    def histogram(self, place: int = 0) -> tuple[list[float], list[float]]:
        """Ranges [Pa] and how many cycles have them, at the worst point of a place."""
        cycles = (c_double * self._options.classes)()
        place = index_of("fatigue", "place", place, self._count)
        self._sure(_lib.dmb_fatigue_histogram(self._handle, place, cycles))
        width = 2.0 * self._options.stress_range / self._options.classes
        return [i * width for i in range(len(cycles))], list(cycles)


class StringFatigue:
    """Counts along a whole string, at the beginning and in the middle of each pipe, and where the body of the last pipe
    of a kind ends; made by Sim.string_fatigue. The end of another pipe is the beginning of the next one."""

    def __init__(self, sim: Sim, string: Id, pipes: int, **fields: Any) -> None:
        pipes = whole(pipes, "string fatigue", "pipes", 1)
        self.pipes = counted(pipes)  #: numbers of the pipes, from the rig end
        self.count = pipes  #: of the string; there may be more than are counted
        ends = sim._parts.ends.get(string.index, {})
        places = [(i, station(string, number, fraction)) for i, number in enumerate(self.pipes)
                  for fraction in (0.0, 0.5, *([ends[number]] if number in ends else []))]
        self._owners = [i for i, _ in places]
        self.sim, self.counter = sim, sim.fatigue([place for _, place in places], **fields)

    def take(self) -> int:
        """A sample; returns the status."""
        return self.counter.take()

    def _worst_places(self) -> list[tuple[int, FatigueResult]]:
        """Of each of the pipes the place of the largest damage, or without any of the largest range. Stresses beyond
        the range at another place count as its own, because the worst one is not known then."""
        found: list[tuple[int, FatigueResult]] = []
        for place, owner in enumerate(self._owners):
            one = self.counter.result(place)
            if owner == len(found):
                found.append((place, one))
                continue
            before = found[owner][1]
            clipped = max(one.clipped, before.clipped)
            if (one.damage, one.largest_range) > (before.damage, before.largest_range):
                found[owner] = place, one
            Structure.__setattr__(found[owner][1], "clipped", clipped)
        return found

    @property
    def results(self) -> list[FatigueResult]:
        """Of each of the pipes, of its worst place."""
        return [one for _, one in self._worst_places()]

    def histogram(self) -> tuple[list[float], list[float]]:
        """Ranges [Pa] and how many cycles have them, at the worst place of the worst pipe."""
        return self.counter.histogram(self._worst_places()[self.worst][0])

    def _asdict(self) -> dict[str, list[Any]]:
        """Numbers of the pipes, and the fields of their results by name."""
        from .frames import by_field
        return {"pipe": list(self.pipes), **by_field(FatigueResult, self.results)}

    def frame(self) -> Any:
        """The pipes as a pandas frame, one row each, units in the names of its columns."""
        from .frames import frame_of
        return frame_of(FatigueResult, self.results, {"pipe": self.pipes})

    @property
    def worst(self) -> int:
        """The index in `pipes` of the largest damage, or without any of the largest range."""
        found = self.results
        return max(range(len(found)), key=lambda i: (found[i].damage, found[i].largest_range))
