"""Outputs by their names: numbers for recorders, windows and responses."""
from __future__ import annotations

import difflib
from collections.abc import Iterator
from ctypes import byref, c_char_p, c_int32, create_string_buffer
from enum import IntEnum
from typing import Any

from ._keep import as_place, station
from ._library import lib as _lib
from ._parts import Parts
from ._structs import Id, Output, Place
from ._values import refuse_type, refuse_value, shown, whole
from .enums import OUTPUT_WINDOW_MINIMUM, ERR_VALUE, Quantity, Reading
from .errors import WrongValue, check


def output_numbers() -> Iterator[int]:
    """The numbers of all outputs, ascending."""
    number = _lib.dmb_output_next(-1)
    while number >= 0:
        yield int(number)
        number = _lib.dmb_output_next(number)


def output_name(quantity: int) -> str:
    """Name of an output, as "bit_speed"."""
    found = _lib.dmb_output_name(int(quantity), None)
    if found is None:
        refuse_value("output", "quantity", quantity, "be the number of an output, OUTPUT_...")
    return str(found.decode())


def output_unit(quantity: int) -> str:
    """Unit of an output, as "rad/s"."""
    unit = c_char_p()
    if _lib.dmb_output_name(int(quantity), byref(unit)) is None:
        refuse_value("output", "quantity", quantity, "be the number of an output, OUTPUT_...")
    return (unit.value or b"").decode()


def output_quantity(name: str | int) -> int:
    """The number of an output by its name, as "bit_speed"; a number is returned unchanged."""
    if not isinstance(name, str):
        number_given = whole(name, "output", "quantity", 0, 2 ** 31 - 1)
        output_name(number_given)
        return number_given
    number = c_int32()
    if _lib.dmb_output_quantity(name.encode(), byref(number)) < 0:
        close = difflib.get_close_matches(name, output_names(), 1)
        raise WrongValue(ERR_VALUE, f"output: quantity = {shown(name)}, must be one of drillmbd.output_names()"
                         + (f"; '{close[0]}'?" if close else ""))
    return number.value


def output_of(given: Any, parts: Parts | None = None, word: str = "output") -> Output:
    """The Output: one, a pair (place, "bit_speed") or (place, OUTPUT_...), or a name or number without a place. The
    place may be a part or its name."""
    if isinstance(given, Output):
        output_name(given.quantity)
        return given
    if isinstance(given, (str, int)):
        given = (None, given)
    if not isinstance(given, (tuple, list)) or len(given) != 2:
        refuse_type(word, "output", given, 'be a pair (place, "bit_speed")')
    place, quantity = given
    if isinstance(quantity, (Place, Id)):
        refuse_type(word, "output", given, 'have the place first: (place, "bit_speed")')
    return Output(station(Id(), place) if isinstance(place, int) else as_place(place, parts), output_quantity(quantity),
                  0)


def outputs_of(outputs: Any, parts: Parts | None = None, word: str = "call") -> Any:
    """The C array of outputs, each as of output_of."""
    if isinstance(outputs, (Output, str)):
        refuse_type(word, "outputs", outputs, 'be a list, [(place, "bit_speed")]')
    made = [output_of(one, parts, f"{word} output {number}") for number, one in enumerate(outputs)]
    return (Output * len(made))(*made)


def output_text(output: Output, sim: Any = None) -> str:
    """The output as the head of a column, "drive_force of drive table [N m]"; without a sim parts have numbers."""
    text = create_string_buffer(512)
    check(_lib.dmb_output_text(sim, byref(output), text, len(text)))
    return text.value.decode()


def output_names() -> list[str]:
    """The names of all outputs."""
    return [output_name(number) for number in output_numbers()]


for _member in (*Quantity, *Reading):  # members without a sentence in the headers
    if _member.__doc__ == type(_member).__doc__ and _lib.dmb_output_name(int(_member), None):
        _member.__doc__ = f"[{output_unit(_member)}] the output {output_name(_member)}"

#: All outputs but those of windows, as an enumeration: those that a scene file may name.
Named: Any = IntEnum("Named", {output_name(number).upper(): number for number in output_numbers()  # type: ignore[misc]
                               if number < OUTPUT_WINDOW_MINIMUM})
