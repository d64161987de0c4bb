"""A window over outputs: least, greatest, mean, stick-slip index."""
from __future__ import annotations

from collections.abc import Sequence
from ctypes import byref, c_double, c_void_p
from typing import TYPE_CHECKING, Any

from ._handle import Handle
from ._keep import mirrors
from ._library import lib as _lib
from ._parts import index_of
from ._structs import WindowOptions, WindowResult
from ._values import reals
from .outputs import outputs_of

if TYPE_CHECKING:
    from .sim import Sim


class Window(Handle):
    """Watches outputs over the last so many seconds; made by Sim.window. Call take() after every step."""
    _kind = "window"

    def __init__(self, sim: Sim, outputs: Sequence[Any], options: WindowOptions,
                 levels: Sequence[float] | None) -> None:
        self.sim, self._handle = sim, c_void_p()
        self._count = len(outputs)
        requested = outputs_of(outputs, sim._parts, "window")
        if levels is not None:
            self._levels = (c_double * self._count)(*reals(levels, "window", "levels", self._count))
            options.levels = self._levels
        sim._check(_lib.dmb_window_create(sim._handle, byref(options), requested, len(outputs), byref(self._handle)))

    @mirrors("dmb_window_take")
    def take(self) -> int:
        """Takes a sample; returns the status."""
        return self._sure(_lib.dmb_window_take(self._handle, self.sim._handle))

    @mirrors("dmb_window_get")
    def result(self, output: int = 0) -> WindowResult:
        """Least, greatest, mean, index of a watched output, by its number."""
        result: WindowResult = WindowResult.blank()
        output = index_of("window", "output", output, self._count)
        self._sure(_lib.dmb_window_get(self._handle, output, byref(result)))
        return result

    def _asdict(self) -> dict[str, list[Any]]:
        """The fields of the results by name, output by output."""
        from .frames import by_field
        return by_field(WindowResult, (self.result(output) for output in range(self._count)))

    @mirrors("dmb_window_reset")
    def reset(self) -> None:
        """Forgets all samples."""
        self._sure(_lib.dmb_window_reset(self._handle))
