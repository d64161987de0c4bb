"""Errors: a status and a message with its part, field, value and bound. Those of the library come as data
(dmb_last_error); the package's own messages have one form, "part: field = value, must bound; advice"."""
from __future__ import annotations

import math
import re
from ctypes import byref
from typing import Any

from ._library import lib
from .enums import NONE, Status

_MESSAGE = re.compile(r"""(?:(?P<part>[^:=]+?):\s+)?     # 'joint 1 (crank): '
                          (?P<field>[^=:;]+?)\s+=\s+     # 'axis_a = '
                          (?P<value>\([^)]*\)|\{[^}]*\}|[^,;]+?)  # '0', '(1, 2, 3)', '-0.1 m'
                          ,\s+must\s+(?P<bound>[^;]*?)   # ', must be > 0'
                          (?:;\s*(?P<advice>.*))?$""", re.X | re.S)


def status_name(status: int) -> str:
    """The name of a status: "DMB_ERR_VALUE"."""
    return str(lib.dmb_status_name(status).decode())


def status_text(status: int) -> str:
    """The text of a status: "a value lies outside its bounds"."""
    return str(lib.dmb_status_text(status).decode())


#: Functions of C that a method calls, by their names, and that method; _keep.mirrors fills it.
MIRRORED: dict[str, str] = {}


def in_python(text: str) -> str:
    """A message of the library with the names of Python: compile() for dmb_model_compile, STEADY_AT_REST for that of
    C."""
    def name(match: re.Match[str]) -> str:
        found = match[0]
        return found[4:] if found.startswith("DMB_") else MIRRORED[found] + "()" if found in MIRRORED else found
    return re.sub(r"\b(?:dmb|DMB)_\w+", name, text)


def _number(text: str) -> float | str:
    try:
        return float(text.split()[0])
    except (ValueError, IndexError):
        return text


class Error(Exception):
    """A call that was refused or failed, with nothing changed.

    status, name ("DMB_ERR_VALUE") and message give the reason. Where the failure has them, else None: part ("joint 1
    (crank)"), field ("axis_a"), component (of a field that is an array), value (a float where it is a number; its unit
    is in the message), low and high (the permitted range), bound ("be of length > 0") and advice (the remedy)."""

    def __init__(self, status: int, message: str = "") -> None:
        try:
            self.status: int = Status(status)
        except ValueError:
            self.status = status  # of a newer library
        self.message = message or status_text(status)
        self.part: str | None = None
        self.field: str | None = None
        self.component: int | None = None
        self.value: float | str | None = None
        self.low: float | None = None
        self.high: float | None = None
        self.bound: str | None = None
        self.advice: str | None = None
        if not self._of_library():
            self._of_text()
        self.message = in_python(self.message)
        self.bound, self.advice = self.bound and in_python(self.bound), self.advice and in_python(self.advice)
        name = status_name(status)
        super().__init__(f"{name}: {self.message}")
        self.name = name  # after AttributeError, whose constructor clears it

    def _of_library(self) -> bool:
        """The data of the thread's last failing call, if that has this message."""
        from ._structs import ErrorStruct
        last: Any = ErrorStruct()
        if lib.dmb_last_error(byref(last)) < 0 or last.status != self.status or last.message.decode() != self.message:
            return False
        self.part, self.field, given, self.bound, self.advice = (
            text.decode() or None for text in (last.part, last.field, last.given, last.bound, last.advice))
        self.component = None if last.component == NONE else int(last.component)
        self.value, self.low, self.high = (None if math.isnan(one) else one
                                           for one in (last.value, last.low, last.high))
        if self.value is None and given is not None:
            self.value = _number(given)
        return True

    def _of_text(self) -> None:
        """The parts of a message of this package."""
        found = _MESSAGE.match(self.message)
        if found:
            self.part, self.field, self.bound, self.advice = (found["part"], found["field"], found["bound"],
                                                              found["advice"])
            self.value = _number(found["value"])

    def __reduce__(self) -> Any:
        return type(self), (int(self.status), self.message), dict(vars(self))


class WrongType(Error, TypeError):
    """A value of the wrong type, found in Python: a text or an array where one number belongs, a part where a place
    does."""


class WrongValue(Error, ValueError):
    """A value that is not allowed, found in Python: a whole number out of its range, a table of no pairs."""


class WrongName(Error, AttributeError):
    """A field that the struct does not have."""


class NoResult(ArithmeticError):
    """An analysis that has no result for a scene, with the reason."""


class Usage(ValueError):
    """A command line or a scene that does not fit the command."""


def last_message() -> bytes:
    """The message of the thread's last failing call."""
    from ._structs import ErrorStruct
    last: Any = ErrorStruct()
    return bytes(last.message) if lib.dmb_last_error(byref(last)) >= 0 else b""


def check(status: int, message: bytes = b"") -> int:
    """The status, if it is none of an error; else raises Error."""
    if status < 0:
        raise Error(status, message.decode())
    return status
