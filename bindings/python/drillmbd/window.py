"""A window over channels: least, greatest, mean, stick-slip index."""
from __future__ import annotations

from collections.abc import Sequence
from ctypes import byref, c_double, c_void_p
from typing import TYPE_CHECKING, Any

from ._handle import Handle
from ._keep import as_place, mirrors
from ._library import lib as _lib
from ._parts import index_of
from ._structs import Channel, WindowOptions, WindowResult
from ._values import reals, refuse_type
from .channels import channel_quantity

if TYPE_CHECKING:
    from .sim import Sim


class Window(Handle):
    """Watches channels over the last so many seconds; made by Sim.window. Call take() after every step."""
    _kind = "window"

    def __init__(self, sim: Sim, channels: Sequence[Any], options: WindowOptions, levels: Sequence[float] | None) -> None:
        self.sim, self._handle = sim, c_void_p()
        self._count = len(channels)
        for number, one in enumerate(channels):
            if not isinstance(one, (tuple, list)) or len(one) != 2:
                refuse_type(f"window channel {number}", "channel", one, 'be a pair (place, "bit_speed")')
        asked = (Channel * len(channels))(*[Channel(as_place(place), channel_quantity(quantity), 0)
                                            for place, quantity in channels])
        if levels is not None:
            self._levels = (c_double * self._count)(*reals(levels, "window", "levels", self._count))
            options.levels = self._levels
        sim._check(_lib.dmb_window_create(sim._handle, byref(options), asked, len(channels), byref(self._handle)))

    @mirrors("dmb_window_take")
    def take(self) -> int:
        """Takes a sample; returns the status."""
        return self._sure(_lib.dmb_window_take(self._handle, self.sim._handle))

    @mirrors("dmb_window_get")
    def result(self, channel: int = 0) -> WindowResult:
        """Least, greatest, mean, index of a watched channel, by its number."""
        answer: WindowResult = WindowResult.blank()
        channel = index_of("window", "channel", channel, self._count)
        self._sure(_lib.dmb_window_get(self._handle, channel, byref(answer)))
        return answer

    @mirrors("dmb_window_reset")
    def reset(self) -> None:
        """Forgets all samples."""
        self._sure(_lib.dmb_window_reset(self._handle))
