"""The parts of a model as messages need them: C queries return only a status for a wrong part or place."""
from __future__ import annotations

import difflib
import math
from typing import Any

from ._structs import Id, Place
from ._values import shown
from .enums import ERR_HANDLE, ERR_NULL, ERR_VALUE, PartKind
from .errors import Error, WrongValue, status_text

WHOLE_STRING = 0xFFFFFFFF


class Parts:
    """Stamp of the model, pipes of its strings by their id's index, contact points."""

    def __init__(self) -> None:
        self.stamp = 0
        self.pipes: dict[int, int] = {}
        self.ends: dict[int, dict[int, float]] = {}  # last pipes of each kind, and where their body ends
        self.sites = 0
        self.names: dict[str, list[Id]] = {}

    def add(self, part: Id, pipes: int = 0) -> None:
        """A part of the model, with as many further pipes."""
        self.stamp = part.generation
        if part.index >> 24 == PartKind.STRING:
            self.pipes[part.index] = self.pipes.get(part.index, 0) + pipes

    def add_end(self, string: Id, joint: float) -> None:
        """Ends a kind of pipes, with tool joints of that share of their length, at the present end of a string."""
        within = 1e-9 if joint > 0.0 else 0.0  # the tool joint has another section
        self.ends.setdefault(string.index, {})[self.pipes[string.index] - 1] = 1.0 - joint - within

    def find(self, name: str, word: str = "", field: str = "part") -> Id:
        """The part of that name; of a kind by `word`, as "drive", where parts of several kinds have it."""
        found = list(dict.fromkeys(self.names.get(name, [])))
        if len(found) > 1 and word:
            found = [one for one in found if named(one).split()[0] == word] or found
        if len(found) == 1:
            return found[0]
        known = ", ".join(f"'{one}'" for one in self.names) or "none"
        close = difflib.get_close_matches(name, self.names, 1)
        bound = (f"be the name of a part of the model: {known if len(known) < 200 else known[:200] + ' ...'}"
                 if not found else
                 f"name one part: {' and '.join(named(one) for one in found)} have this name; give the id")
        raise WrongValue(ERR_VALUE, f"{word or 'call'}: {field} = {shown(name)}, must {bound}"
                         + (f"; '{close[0]}'?" if close else ""))

    def first_string(self) -> Id:
        """The first string of the model; of nothing where it has none."""
        return Id(min(self.pipes), self.stamp) if self.pipes else Id()

    def name_of(self, part: Id) -> str:
        """The name of a part, "" if it has none."""
        return next((name for name, ids in self.names.items() if part in ids), "")

    def why_part(self, word: str, part: Id, wanted: str) -> str:
        """The message of a part where one of the kinds `wanted` is needed; "" where nothing is wrong."""
        if not part:
            return f"{word}: part = none, must be {wanted} of this model"
        if part.generation != self.stamp:
            return (f"{word}: part = {named(part)} of another model, must be {wanted} of this model; "
                    "model.own(part) finds that of a copy")
        kind = named(part).split()[0]
        return "" if kind in wanted else f"{word}: part = {named(part)}, must be {wanted} of this model"

    def why_place(self, word: str, place: Place) -> str:
        """The message of a place that does not fit; "" where nothing is wrong."""
        wrong = self.why_part(word, place.part, "a string, body, bit or stabiliser")
        if wrong or place.part.index not in self.pipes:
            return wrong
        count = self.pipes[place.part.index]
        if place.pipe >= count:
            return f"{word} at {named(place.part)}: pipe = {place.pipe}, must be 0 .. {count - 1}"
        if not 0.0 <= place.fraction <= 1.0 or math.isnan(place.fraction):
            return f"{word} at {named(place.part)}: fraction = {place.fraction:g}, must be 0 .. 1"
        return ""

    def why(self, status: int, word: str, arguments: tuple[Any, ...]) -> str:
        """The message of a query that failed for its part or place; the text of the status where it did not."""
        for one in arguments:
            wrong = ""
            if isinstance(one, Place):
                wrong = self.why_place(word, one)
            elif isinstance(one, Id):
                wrong = self.why_part(word, one, _WANTED.get(word, "a part"))
            if wrong:
                return wrong
        return f"{word}: {status_text(status)}"


_WANTED = {"drive": "a drive", "joint": "a joint", "bit": "a bit", "spring": "a spring", "stuck": "a stuck place",
           "reaction": "a string or body", "multipliers": "a joint, coupling, constraint or drive",
           "kinetic energy": "a string or body", "profile": "a string"}


def named(part: Id) -> str:
    """ "string 0", "drive 2" """
    try:
        kind = PartKind(part.index >> 24).name.lower()
    except ValueError:
        kind = "part"
    return f"{kind} {part.index & 0xFFFFFF}"


def closed(kind: str) -> Error:
    """The Error of a query to a destroyed object."""
    return Error(ERR_HANDLE,
                 f"{kind}: handle = closed, must be open; close() or the end of its with block gave it back")


def is_closed(handle: Any, status: int) -> bool:
    """Whether a status says that an object of the library was destroyed."""
    return status == ERR_NULL and not handle


def index_of(word: str, field: str, value: Any, count: int) -> int:
    """The number of one of `count` things."""
    from ._values import whole
    number = whole(value, word, field, -2 ** 31, 2 ** 32 - 1)
    if not 0 <= number < count:
        bound = f"be 0 .. {count - 1}" if count else "not be asked: there are none"
        raise WrongValue(-5, f"{word}: {field} = {shown(value)}, must {bound}")
    return number
