"""A window over channels: least, greatest, mean, stick-slip index."""
from __future__ import annotations

from collections.abc import Sequence
from ctypes import byref, c_double, c_void_p
from typing import TYPE_CHECKING, Any

from ._handle import Handle
from ._keep import as_place, mirrors
from ._library import lib as _lib
from ._structs import Channel, WindowOptions, WindowResult
from .channels import channel_quantity
from .errors import check

if TYPE_CHECKING:
    from .sim import Sim


class Window(Handle):
    """Watches channels over the last so many seconds; made by Sim.window. Call take() after every step."""
    _kind = "window"

    def __init__(self, sim: Sim, channels: Sequence[Any], options: WindowOptions, levels: Sequence[float] | None) -> None:
        self._sim, self._handle = sim, c_void_p()
        asked = (Channel * len(channels))(*[Channel(as_place(place), channel_quantity(quantity), 0)
                                            for place, quantity in channels])
        if levels is not None:
            if len(levels) != len(channels):
                raise ValueError(f"{len(levels)} levels for {len(channels)} channels")
            self._levels = (c_double * len(levels))(*levels)
            options.levels = self._levels
        sim._check(_lib.dmb_window_create(sim._handle, byref(options), asked, len(channels), byref(self._handle)))

    @mirrors("dmb_window_take")
    def take(self) -> int:
        """Takes a sample; returns the status."""
        return check(_lib.dmb_window_take(self._handle, self._sim._handle))

    @mirrors("dmb_window_get")
    def result(self, channel: int = 0) -> WindowResult:
        """Least, greatest, mean, index of a watched channel, by its number."""
        answer: WindowResult = WindowResult.blank()
        check(_lib.dmb_window_get(self._handle, channel, byref(answer)))
        return answer

    @mirrors("dmb_window_reset")
    def reset(self) -> None:
        """Forgets all samples."""
        check(_lib.dmb_window_reset(self._handle))
