"""Callbacks that the library may still call, and help with arguments."""
from __future__ import annotations

import os
import threading
from collections.abc import Callable
from typing import Any, TypeVar

from ._functions import FUNCTION_DOCS
from ._parts import Parts, closed, is_closed
from ._record import Record
from ._structs import ACCEPT_FN, CONSTRAINT_FN, FORCE_FN, FRICTION_FN, LOG_FN, TIME_FN, Id, Place
from ._values import flat, real, reals, refuse_type, shown
from .enums import ERR_IO, PROVIDES_INTEGRAL, PROVIDES_JACOBIAN, PROVIDES_POTENTIAL, PROVIDES_RATE, PROVIDES_TANGENT
from .errors import MIRRORED, Error, check

S = TypeVar("S", bound=Record)
F = TypeVar("F", bound=Callable[..., Any])


def station(part: Id, pipe: int = 0, fraction: float = 0.0) -> Place:
    """A place on a part: a station of a string (pipe from 0 at the rig end, fraction 0 .. 1 along it), or the reference
    point of a body."""
    return Place(part, pipe, 0, fraction)


def as_id(part: Id | str | None, parts: Parts | None = None, word: str = "") -> Id:
    """The id, or the id of nothing for None; of a name where the parts of the model are given."""
    if part is None:
        return Id()
    if isinstance(part, str) and parts is not None:
        return parts.find(part, word)
    return part if isinstance(part, Id) else refuse_type("call", "part", part, "be the id of a part")


def as_place(place: Place | Id | str | None, parts: Parts | None = None) -> Place:
    """The place. A part, or its name if the parts of the model are given, means its reference point; None means no place."""
    if isinstance(place, Place):
        return place
    if place is not None and not isinstance(place, (Id, str) if parts is not None else Id):
        refuse_type("call", "place", place, "be a place, station(string, pipe, fraction), or a part")
    if isinstance(place, str) and parts is not None:
        return station(parts.find(place, field="place"))
    return station(as_id(place))


def struct(cls: type[S], given: S | None, fields: dict[str, Any]) -> S:
    """The caller's struct, or one made of keywords."""
    if given is None:
        return cls(**fields)
    if not isinstance(given, cls):
        refuse_type("call", "definition", given, f"be a {cls.__name__}, or its fields by name as diameter=0.1")
    if fields:
        raise TypeError(f"give a {cls.__name__} or its fields, not both")
    return given


def path_of(path: Any) -> bytes:
    """The path as the C library takes it."""
    return os.fsencode(path)


def written(path: Any, handle: Any, status: int) -> int:
    """The status of a call that writes a file; an Error that names the file where it could not."""
    if is_closed(handle, status):
        raise closed("writer")
    if status == ERR_IO:
        raise Error(status, f"file: path = {shown(os.fspath(path))}, must be one that can be written")
    return check(status)


def mirrors(name: str) -> Callable[[F], F]:
    """A method whose docstring ends with the comment of the C function in the header."""
    def put(method: F) -> F:
        text = FUNCTION_DOCS.get(name, "")
        MIRRORED.setdefault(name, method.__name__)
        method.__doc__ = "\n\n".join(part for part in (method.__doc__, text and f"{name}: {text}") if part)
        return method
    return put


class Keep:
    """Functions that the library may still call: held by the model and by every sim made from it. An exception of a
    callback is held until the call returns in the same thread."""

    def __init__(self) -> None:
        self.references: list[Any] = []
        self.raised = threading.local()

    def _c_function(self, kind: Any, call: Callable[..., None]) -> Any:
        """The C function of a type whose calls return 0, or 1 with the exception held: it must not unwind through C."""
        def guarded(*arguments: Any) -> int:
            try:
                call(*arguments)
                return 0
            except BaseException as error:
                self.raised.error = error
                return 1

        return self._kept(kind(guarded))

    def _kept(self, wrapped: Any) -> Any:
        self.references.append(wrapped)
        return wrapped

    def time_function(self, function: Callable[[float], Any], provides: int) -> Any:
        """The C function around a Python function of time. An exception stops the step and comes out of the call."""
        wanted = 3 if provides & PROVIDES_INTEGRAL else 2 if provides & PROVIDES_RATE else 1

        def call(_context: Any, time: float, out: Any) -> None:
            returned = function(time)
            # at once
            if type(returned) is tuple and len(returned) == wanted and all(type(one) is float for one in returned):
                for i in range(wanted):
                    out[i] = returned[i]
                return
            if wanted == 1:
                out[0] = real(returned, "time_function", "result of the function")
                return
            for i, value in enumerate(reals(returned, "time_function", "result of the function", wanted)):
                out[i] = value

        return self._c_function(TIME_FN, call)

    def constraint(self, function: Callable[..., Any], rows: int, provides: int) -> Any:
        """The C function around a Python function of time and poses."""
        def call(_context: Any, time: float, count: int, poses: Any, value: Any, jacobian: Any) -> None:
            returned = function(time, [list(poses[i]) for i in range(count)])
            values, derivatives = returned if provides & PROVIDES_JACOBIAN else (returned, None)
            for i, number in enumerate(reals(flat(values), "constraint", "values of the function", rows)):
                value[i] = number
            if derivatives is not None:
                for i, number in enumerate(reals(flat(derivatives), "constraint", "jacobian", 6 * rows * count)):
                    jacobian[i] = number

        return self._c_function(CONSTRAINT_FN, call)

    def force(self, function: Callable[..., Any], provides: int, states: int = 0) -> Any:
        """The C function around a Python function of time, poses and velocities, of a law with a state also of the state
        at the last accepted time and the time since."""
        words = "".join(f", {word}" for word, given in (("tangent", provides & PROVIDES_TANGENT),
                                                        ("potential", provides & PROVIDES_POTENTIAL),
                                                        ("state", states)) if given)
        wanted = 1 + words.count(",")

        def call(_context: Any, time: float, count: int, poses: Any, velocities: Any, forces: Any, tangent: Any,
                 potential: Any, memory: Any) -> None:
            motion = [list(poses[i]) for i in range(count)], [list(velocities[i]) for i in range(count)]
            law = memory.contents
            returned = function(time, *motion, law.accepted[:states], law.step) if states else function(time, *motion)
            parts = list(returned) if wanted > 1 else [returned]
            if len(parts) != wanted:
                refuse_type("force", "result of the function", returned, f"be a tuple of {wanted}: force{words}")
            if states:
                for i, number in enumerate(reals(flat(parts.pop()), "force", "state", states)):
                    law.trial[i] = number
            for i, number in enumerate(reals(flat(parts.pop(0)), "force", "result of the function", 6 * count)):
                forces[i // 6][i % 6] = number
            if provides & PROVIDES_TANGENT:
                entries = [one for _ in range(2) for one in reals(flat(parts.pop(0)), "force", "tangent", 36 * count * count)]
                for i, number in enumerate(entries if tangent else ()):
                    tangent[i] = number
            if provides & PROVIDES_POTENTIAL:
                potential[0] = float(parts.pop(0))

        return self._c_function(FORCE_FN, call)

    def friction(self, function: Callable[..., Any], states: int) -> Any:
        """The C function around a Python law of friction on the wall."""
        def call(_context: Any, at: Any, force: Any, by_slip: Any, by_normal: Any, memory: Any) -> None:
            law, arguments = memory.contents, at.contents
            returned = list(function(arguments, law.accepted[:states], law.step) if states else function(arguments))
            if len(returned) != 3 + (states > 0):
                refuse_type("friction", "result of the function", returned,
                            f"be a tuple of force, by_slip, by_normal{', state' if states else ''}")
            for to, count, word in ((force, 2, "force"), (by_slip, 4, "by_slip"), (by_normal, 2, "by_normal")):
                for i, number in enumerate(reals(flat(returned.pop(0)), "friction", word, count)):
                    to[i] = number
            for i, number in enumerate(reals(flat(returned.pop(0)), "friction", "state", states) if states else ()):
                law.trial[i] = number

        return self._c_function(FRICTION_FN, call)

    def accept(self, function: Callable[[float, int, list[float]], Any], states: int) -> Any:
        """The C function around a Python function of time, number and accepted state of a law."""
        def call(_context: Any, time: float, number: int, state: Any) -> None:
            try:
                function(time, number, state[:states] if states else [])
            except BaseException as error:  # the first one is raised when the call ends
                if getattr(self.raised, "accept", None) is None:
                    self.raised.accept = error

        return self._kept(ACCEPT_FN(call))

    def log(self, function: Callable[[int, str], None]) -> Any:
        """The C function around a Python function of level and text."""
        def call(_context: Any, level: int, text: bytes) -> None:
            try:
                function(level, text.decode(errors="replace"))
            except BaseException as error:
                self.raised.error = error

        return self._kept(LOG_FN(call))

    def forget(self) -> tuple[BaseException | None, BaseException | None]:
        """The exceptions of callbacks and of accept functions in the last call, which are then held no longer."""
        held = getattr(self.raised, "error", None), getattr(self.raised, "accept", None)
        self.raised.error = self.raised.accept = None
        return held

    def check(self, status: int, message: bytes) -> int:
        """Raises Error for a failed call, from the exception of a callback if there is one."""
        raised, after_step = self.forget()
        if raised is not None and not isinstance(raised, Exception):
            raise raised  # KeyboardInterrupt and the like
        if status < 0:
            raise Error(status, message.decode()) from raised or after_step
        if after_step is not None:
            raise after_step
        return status
