"""Errors: a status and a message, taken apart into part, field, value and bound."""
from __future__ import annotations

import re
from typing import Any

from ._library import lib
from .enums import Status

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


def _number(text: str) -> float | str:
    try:
        return float(text.split()[0])
    except (ValueError, IndexError):
        return text


class Error(Exception):
    """A call that was refused or failed, with nothing changed.

    status, name ("DMB_ERR_VALUE") and message give the reason. Where the message says so, else None: part ("joint 1 (crank)"),
    field ("axis_a"), value (a float where it is a number; its unit is in the message), bound ("be of length > 0") and
    advice (the remedy)."""

    def __init__(self, status: int, message: str = "") -> None:
        try:
            self.status: int = Status(status)
        except ValueError:
            self.status = status  # of a newer library
        self.message = message or status_text(status)
        found = _MESSAGE.match(self.message)
        self.part: str | None = found["part"] if found else None
        self.field: str | None = found["field"] if found else None
        self.value: float | str | None = _number(found["value"]) if found else None
        self.bound: str | None = found["bound"] if found else None
        self.advice: str | None = found["advice"] if found else None
        name = status_name(status)
        super().__init__(f"{name}: {self.message}")
        self.name = name  # after AttributeError, whose constructor clears it

    def __reduce__(self) -> Any:
        return type(self), (int(self.status), self.message), dict(vars(self))


class WrongType(Error, TypeError):
    """A value of the wrong type, found in Python: a text or an array where one number belongs, a part where a place does."""


class WrongValue(Error, ValueError):
    """A value that is not allowed, found in Python: a whole number out of its range, a table of no pairs."""


class WrongName(Error, AttributeError):
    """A field that the struct does not have."""


class Unanswered(ArithmeticError):
    """A question of the command that has no answer for a scene, with the reason."""


class Usage(ValueError):
    """A command line or a scene that does not fit the question."""


def check(status: int, message: bytes = b"") -> int:
    """The status, if it is none of an error; else raises Error."""
    if status < 0:
        raise Error(status, message.decode())
    return status
