"""Channels by their names: numbers that a recorder, a window or a response is asked for."""
from __future__ import annotations

import difflib
from collections.abc import Iterator
from ctypes import byref, c_char_p, c_int32
from enum import IntEnum
from typing import Any

from ._library import lib as _lib
from ._values import refuse_value, shown, whole
from .enums import CHANNEL_WINDOW_MINIMUM, ERR_VALUE, Quantity, Reading
from .errors import WrongValue


def channel_numbers() -> Iterator[int]:
    """The numbers of all channels, ascending."""
    number = _lib.dmb_channel_next(-1)
    while number >= 0:
        yield int(number)
        number = _lib.dmb_channel_next(number)


def channel_name(quantity: int) -> str:
    """Name of a channel, as "bit_speed"."""
    found = _lib.dmb_channel_name(int(quantity), None)
    if found is None:
        refuse_value("channel", "quantity", quantity, "be the number of a channel, CHANNEL_...")
    return str(found.decode())


def channel_unit(quantity: int) -> str:
    """Unit of a channel, as "rad/s"."""
    unit = c_char_p()
    if _lib.dmb_channel_name(int(quantity), byref(unit)) is None:
        refuse_value("channel", "quantity", quantity, "be the number of a channel, CHANNEL_...")
    return (unit.value or b"").decode()


def channel_quantity(name: str | int) -> int:
    """The number of a channel by its name, as "bit_speed"; a number stays what it is."""
    if not isinstance(name, str):
        number_given = whole(name, "channel", "quantity", 0, 2 ** 31 - 1)
        channel_name(number_given)
        return number_given
    number = c_int32()
    if _lib.dmb_channel_quantity(name.encode(), byref(number)) < 0:
        close = difflib.get_close_matches(name, channel_names(), 1)
        raise WrongValue(ERR_VALUE, f"channel: quantity = {shown(name)}, must be one of drillmbd.channel_names()"
                         + (f"; '{close[0]}'?" if close else ""))
    return number.value


def channel_names() -> list[str]:
    """The names of all channels."""
    return [channel_name(number) for number in channel_numbers()]


for _member in (*Quantity, *Reading):  # what the headers have no sentence of
    if _member.__doc__ == type(_member).__doc__ and _lib.dmb_channel_name(int(_member), None):
        _member.__doc__ = f"[{channel_unit(_member)}] the channel {channel_name(_member)}"

#: All channels but those of windows, as an enumeration: what a scene file may ask for.
Named: Any = IntEnum("Named", {channel_name(number).upper(): number for number in channel_numbers()  # type: ignore[misc]
                               if number < CHANNEL_WINDOW_MINIMUM})
