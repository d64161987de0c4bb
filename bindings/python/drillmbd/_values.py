"""Values as they come from Python: numbers, texts, parts and places, or an error with part, field, value and bound."""
from __future__ import annotations

import numbers as kinds
import operator
from typing import TYPE_CHECKING, Any, NoReturn

if TYPE_CHECKING:
    from .errors import Error

ERR_VALUE, ERR_ID = -5, -4  # of the headers; enums.py cannot be read here by all


def shown(value: Any) -> str:
    """A value as a message shows it: on one line, not too long, without characters that end the field of the
    message."""
    text = " ".join(repr(value).split())
    text = text if len(text) <= 60 else text[:57] + "..."
    return text.replace(",", " ").replace(";", " ") if not text.startswith(("(", "{")) else text.replace(";", " ")


def refuse(wrong: str, part: str, field: str, value: Any, bound: str, status: int = ERR_VALUE) -> Error:
    """The Error of a value of the wrong type ("type") or of the wrong size ("value")."""
    from .errors import WrongType, WrongValue
    cls = WrongType if wrong == "type" else WrongValue
    error = cls(status, f"{part}: {field} = {shown(value)}, must {bound}")
    error.part, error.field, error.bound = part, field, bound  # whatever signs the value has
    error.value = float(value) if isinstance(value, (int, float)) and abs(value) < 1e300 else shown(value)
    return error


def refuse_type(part: str, field: str, value: Any, bound: str) -> NoReturn:
    """Raises the Error of a value of the wrong type."""
    raise refuse("type", part, field, value, bound)


def refuse_value(part: str, field: str, value: Any, bound: str) -> NoReturn:
    """Raises the Error of a value that is not allowed."""
    raise refuse("value", part, field, value, bound)


def real(value: Any, part: str, field: str, unit: str = "") -> float:
    """The number as float; texts and other values that are no real numbers are refused."""
    if type(value) is float:
        return value
    if getattr(value, "size", 1) == 1 and hasattr(value, "item"):
        value = value.item()  # numpy's, an array of one too
    unreal = isinstance(value, (str, bytes, bytearray)) or (isinstance(value, kinds.Complex)
                                                            and not isinstance(value, kinds.Real))
    if not unreal and hasattr(value, "__float__"):
        try:
            return float(value)
        except OverflowError:
            refuse_value(part, field, value, "be at most 1.8e308")
        except TypeError:
            pass
    refuse_type(part, field, value, "be a number" + (f" [{unit}]" if unit else ""))


def whole(value: Any, part: str, field: str, low: int = 0, high: int = 2 ** 32 - 1) -> int:
    """The whole number within its bounds."""
    if type(value) is not int:
        try:
            value = operator.index(value)
        except TypeError:
            refuse_type(part, field, value, "be a whole number")
    if not low <= value <= high:
        refuse_value(part, field, value, f"be {low} .. {high}")
    return int(value)


def reals(value: Any, part: str, field: str, count: int | None = None, unit: str = "") -> list[float]:
    """A sequence of numbers; `count` of them, or any number."""
    try:
        values = list(value) if not isinstance(value, (str, bytes, dict)) else None
    except TypeError:
        values = None
    if values is None:
        refuse_type(part, field, value, f"be a sequence of {'numbers' if count is None else f'{count} numbers'}")
    if count is not None and len(values) != count:
        refuse_value(part, field, value, f"be {count} numbers: {len(values)} are given")
    return [real(one, part, f"{field}[{i}]", unit) for i, one in enumerate(values)]


def text(value: Any, part: str, field: str, room: int) -> bytes:
    """The text as bytes that fit with their 0."""
    found = value.encode() if isinstance(value, str) else value
    if not isinstance(found, bytes):
        refuse_type(part, field, value, "be a text")
    if b"\0" in found or len(found) >= room:
        refuse_value(part, field, value, f"be of at most {room - 1} bytes without 0")
    return found


def flat(values: Any) -> list[float]:
    """A number, a sequence, or a sequence of sequences as one list."""
    if isinstance(values, (str, bytes)) or not hasattr(values, "__iter__") or getattr(values, "ndim", 1) == 0:
        return [real(values, "result of a function", "number")]
    return [number for value in values for number in flat(value)]


def points(table: Any, part: str, field: str = "table") -> tuple[list[float], list[float]]:
    """The two columns of a table given as pairs or as two sequences. Two pairs are pairs, unless arrays."""
    bound = "be pairs [(x, y), ...] or two sequences of one length (xs, ys)"
    if isinstance(table, (str, bytes, dict)) or not hasattr(table, "__iter__"):
        refuse_type(part, field, table, bound)
    rows = list(table)
    columns = isinstance(table, tuple) and len(rows) == 2 and all(hasattr(one, "__len__") for one in rows)
    if columns and not all(isinstance(one, tuple) and len(one) == 2 for one in rows):
        one, other = (list(column) for column in rows)
    else:
        if not all(hasattr(row, "__len__") and len(row) == 2 and not isinstance(row, str) for row in rows):
            refuse_value(part, field, table, bound)
        one, other = [row[0] for row in rows], [row[1] for row in rows]
    if len(one) != len(other):
        refuse_value(part, field, table, f"{bound}: {len(one)} and {len(other)} are given")
    return reals(one, part, field), reals(other, part, field)
