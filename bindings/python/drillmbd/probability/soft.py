"""Torque and drag of a sample as a soft string: pulled out, pushed in without rotation, and rotated while drilling, the
last two with the load of the bit. The scene file is read and checked once: samples change the numbers of a description
that the library has again each time."""
from __future__ import annotations

import copy
import math
from collections.abc import Iterator
from ctypes import Structure, byref, c_double, c_uint32, c_void_p
from types import SimpleNamespace
from typing import Any

from .. import enums
from .._library import lib as _lib
from .._optional import need
from .._structs import Id, ModelOptions, Operation, SimOptions, TorqueDragOptions, TorqueDragRow
from ..enums import Status
from ..errors import Error
from ..model import _DEFINITIONS
from ..operating import Operating, has_rock_law, operating, operations_of
from ..scene import Scene, SceneError, loads
from ..scene.failure import Failure
from .draw import Draw
from .limits import Soft, soft_margin
from .sampling import stream

STRENGTH = 1e9  #: [Pa] yield strength that the pipes get, so that the shares of the rows are stresses
PIECE = 30.0    #: [m] of pipes that are described as one
STATIONS = 401  #: of a profile of the wall force
STATES = {"pulled out": enums.OPERATION_PICK_UP, "pushed in": enums.OPERATION_SLIDE, "rotated": enums.OPERATION_DRILL}
_KEPT = ("set_environment", "add_wall", "add_hole_sections", "add_string", "add_pipes", "add_bit", "compile")
_LEFT_OUT = ("add_time_function", "add_drive", "add_input", "add_event")  #: nothing of them acts on a soft string
TRIES = 20  #: samples drawn at random
_SAME = 1e-11  #: relative, between numbers that went through the text of a scene and those that did not

Path = tuple[Any, ...]  #: of a number in a description: call, argument, key, ...


class NotFast(ValueError):
    """A scene of which each sample must be read again, and why."""


# ---- Numbers of a description ----------------------------------------------------------------------------------------
def _leaves(value: Any, path: Path = ()) -> dict[Path, float]:
    """Every number by its path."""
    if isinstance(value, bool) or value is None or isinstance(value, (str, Id)):
        return {}
    if isinstance(value, (int, float)):
        return {path: float(value)}
    items: Any = (value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, (list, tuple))
                  else ())
    return {key: one for name, inside in items for key, one in _leaves(inside, path + (name,)).items()}


def _lists(value: Any) -> Any:
    """Tuples as lists, so that numbers can be replaced."""
    if isinstance(value, dict):
        return {key: _lists(one) for key, one in value.items()}
    return [_lists(one) for one in value] if isinstance(value, (list, tuple)) else value


def _differ(a: float, b: float) -> bool:
    return not abs(a - b) <= _SAME * max(abs(a), abs(b))


class Places:
    """Where the values of all that varies stand in the description of a scene, each as a factor of a number. Found by
    reading the scene with one of them changed at a time, and verified with all of them changed."""

    def __init__(self, draw: Draw, read: Any) -> None:
        numpy = need("numpy")
        drawn, first = self._drawn(draw, read)
        known = _leaves(first)
        self.calls, self.found = first, list[tuple[Path, str, int, float]]()
        for name in draw.varies.names:
            changed = _leaves(read({**drawn[0], name: drawn[1][name]}))
            if changed.keys() != known.keys():
                raise NotFast(f"{name} changes the parts of the scene")
            a, b = (numpy.atleast_1d(one[name]).astype(float) for one in drawn[:2])
            for path in known:
                if _differ(known[path], changed[path]):
                    self.found.append((path, name, *self._factor(name, a, b, known[path], changed[path])))
        self.last = drawn[2]  #: values of the third
        self._verify(drawn[2], _leaves(read(drawn[2])))

    @staticmethod
    def _drawn(draw: Draw, read: Any) -> tuple[list[dict[str, Any]], Any]:
        """The values of three samples of which the scene can be read, and the description of the first."""
        found, first, message = list[dict[str, Any]](), None, ""
        for number in range(TRIES):
            values = draw.values(stream(20, number).standard_normal(draw.dimension))
            try:
                calls = read(values)
            except (Error, SceneError, ValueError) as error:
                message = str(error)
                continue
            first = calls if first is None else first
            found.append(values)
            if len(found) == 3:
                return found, first
        raise NotFast(f"of {TRIES} samples drawn at random only {len(found)} can be read; the last: {message}")

    @staticmethod
    def _factor(name: str, a: Any, b: Any, first: float, second: float) -> tuple[int, float]:
        """Index of the value at that place, and its factor."""
        numpy = need("numpy")
        with numpy.errstate(divide="ignore", invalid="ignore"):
            one, other = first / a, second / b
        good = numpy.flatnonzero((abs(one - other) <= 10.0 * _SAME * abs(one)) & numpy.isfinite(one))
        if len(good) == 0:
            raise NotFast(f"{name} is no factor of the numbers that it changes")
        return int(good[0]), float(one[good[0]])

    def numbers(self, values: dict[str, Any]) -> Iterator[tuple[Path, float]]:
        """Paths and numbers of a sample."""
        lists = {name: [value] if isinstance(value, float) else value.tolist() for name, value in values.items()}
        return ((path, factor * lists[name][index]) for path, name, index, factor in self.found)

    def _verify(self, values: dict[str, Any], wanted: dict[Path, float]) -> None:
        mine = {**_leaves(self.calls), **dict(self.numbers(values))}
        if mine.keys() != wanted.keys() or any(_differ(mine[path], wanted[path]) for path in wanted):
            raise NotFast("several uncertain parameters act on the same numbers of the scene")


def put(calls: Any, path: Path, value: float) -> None:
    """Replaces a number of a description."""
    for part in path[:-1]:
        calls = calls[part]
    calls[path[-1]] = value


# ---- Describing it to the library ------------------------------------------------------------------------------------
class Described:
    """The parts of a scene that a soft string has, as structs of the library that a sample changes in place."""

    def __init__(self, calls: Any, moving: frozenset[Any] = frozenset()) -> None:
        self.structs: dict[tuple[int, int], Any] = {}   # by call and argument
        self.calls = {number for number, (name, _) in enumerate(calls) if name in _KEPT}
        self.order: list[tuple[str, list[Any], int]] = []  # call, its structs, count of pipes
        self.ids: list[tuple[Any, str, int]] = []       # fields that name a string
        for number, (name, arguments) in enumerate(calls):
            if name in _LEFT_OUT:
                continue
            if name not in _KEPT:
                raise NotFast(f"the scene has {name.removeprefix('add_')} parts")
            made, count = [], arguments[0] if name == "add_pipes" else 0
            if name == "add_pipes":
                count, merged = _fewer(count, arguments[1], moving)
                arguments = [count, merged]
            for place, fields in enumerate(arguments):
                if isinstance(fields, dict):
                    made.append(self._struct(name, fields))
                    self.structs[number, place] = made[-1]
            self.order.append((name, made, count))

    def _struct(self, name: str, fields: dict[str, Any]) -> Any:
        kept = {key: value for key, value in fields.items() if not isinstance(value, Id)}
        if name == "add_pipes":
            kept.update(yield_strength=STRENGTH, elements=1)
        found = _DEFINITIONS[name](**kept)
        self.ids += [(found, key, value.index) for key, value in fields.items() if isinstance(value, Id)
                     and key == "string"]
        return found

    def put(self, path: Path, value: float) -> None:
        """A number of the description, of those that the library has."""
        Structure.__setattr__(self.structs[path[0], path[2]], path[3], value)

    def model(self, handle: c_void_p) -> None:
        """Describes and compiles it. Raises Error."""
        options, made = ModelOptions(), Id()
        _check(_lib.dmb_model_create(byref(options), byref(handle)), handle)
        for name, structs, count in self.order:
            if name == "set_environment":
                status = _lib.dmb_model_set_environment(handle, byref(structs[0]))
            elif name == "add_hole_sections":
                array = (type(structs[0]) * len(structs))(*structs)
                status = _lib.dmb_model_add_hole_sections(handle, array, len(structs))
            elif name == "add_pipes":
                status = _lib.dmb_model_add_pipes(handle, byref(structs[0]), count, byref(made))
            elif name == "compile":
                status = _lib.dmb_model_compile(handle, byref(structs[0]))
            else:
                status = getattr(_lib, f"dmb_model_{name}")(handle, byref(structs[0]), byref(made))
            _check(status, handle)
            if name == "add_string":
                for owner, key, index in self.ids:
                    if index == made.index:
                        Structure.__setattr__(owner, key, Id(made.index, made.generation))


def _check(status: int, handle: c_void_p) -> None:
    if status < 0:
        raise Error(status, _lib.dmb_model_message(handle).decode())


def _fewer(count: int, fields: dict[str, Any], moving: frozenset[Any]) -> tuple[int, dict[str, Any]]:
    """The same pipes in longer pieces with as much of tool joints: weight, stiffness and diameters per length, which is
    all that a soft string has of them, stay the same."""
    length, joint = fields.get("length", 1.0), fields.get("joint_length", 0.0)
    pieces = max(1, math.ceil(count * length / PIECE))
    if pieces >= count or {"joint_mass", "joint_inertia"} & fields.keys() or {"length", "joint_length"} & moving:
        return count, fields
    share = count / pieces
    return pieces, {**fields, "length": length * share, **({"joint_length": joint * share} if joint else {})}


class Rows:
    """Torque and drag of a model: rows of the states, and the largest wall force where it is needed."""

    def __init__(self, wall: bool, string: Any = None) -> None:
        self.options, self.wall, self.string = TorqueDragOptions(), wall, string
        self.rows = (TorqueDragRow * len(STATES)).from_buffer_copy(bytes(TorqueDragRow.blank()) * len(STATES))
        self.forces = (c_double * STATIONS)() if wall else None
        self.sim_options = SimOptions()
        self.known: tuple[Any, ...] = ()  # what the operations are of
        self.operations = (Operation * len(STATES))()

    def of(self, model: c_void_p, plan: Operating) -> Soft:
        """Raises Error."""
        sim, operations = c_void_p(), self._operations(plan)
        _check(_lib.dmb_sim_create(model, byref(self.sim_options), byref(sim)), model)
        try:
            status = _lib.dmb_analysis_torque_drag(sim, byref(self.options), operations, c_uint32(len(STATES)),
                                                   self.rows)
            if status < 0:
                raise Error(status, _lib.dmb_sim_message(sim).decode())
            force = max(self._force(sim, one) for one in operations) if self.wall else 0.0
        finally:
            _lib.dmb_sim_destroy(byref(sim))
        return Soft(dict(zip(STATES, self.rows)), plan.weight_on_bit or 0.0, STRENGTH, force)

    def _operations(self, plan: Operating) -> Any:
        wanted = (plan.rotation, plan.feed, plan.weight_on_bit, plan.torque_on_bit)
        if wanted != self.known:
            usual = operations_of(plan)
            self.known, self.operations = (wanted, (Operation * len(STATES))(*[usual[int(kind)]
                                                                               for kind in STATES.values()]))
        return self.operations

    def _force(self, sim: c_void_p, operation: Operation) -> float:
        """[N/m] Infinite where the string locks up."""
        status = _lib.dmb_analysis_torque_drag_profile(sim, byref(self.options), byref(operation), c_uint32(STATIONS),
                                                       None, None, None, self.forces)
        if status == Status.ERR_NO_CONVERGENCE:
            return math.inf
        if status < 0:
            raise Error(status, _lib.dmb_sim_message(sim).decode())
        assert self.forces is not None
        return float(max(self.forces))


# ---- Samples ---------------------------------------------------------------------------------------------------------
class SoftString:
    """Margins and demands of samples by torque and drag."""

    def __init__(self, text: str, name: str, folder: str, overrides: Any, draw: Draw, failures: list[Failure]) -> None:
        self.text, self.name, self.folder, self.given, self.draw = text, name, folder, dict(overrides), draw
        self.failures = failures
        wall = any(one.kind == "wall-pressure" for one in self.failures)
        self.rows, self.why = Rows(wall), ""
        try:
            self.places: Places | None = Places(draw, lambda values: self._calls(self._scene(values)))
            self.described = Described(self.places.calls, frozenset(path[-1] for path, *_ in self.places.found))
            self.moving = {path[0] for path, *_ in self.places.found
                           if self.places.calls[path[0]][0] in ("add_time_function", "add_bit", "add_drive")}
            self.plan = self._plan(self.places.calls)
            self._refuse_lost()
            self._compare(self.places.last)
        except (NotFast, Error, SceneError) as error:
            self.places, self.why = None, str(error)

    def _scene(self, values: dict[str, Any]) -> Scene:
        return loads(self.text, self.name, self.folder, {**self.given, **self.draw.overrides(values)})

    @staticmethod
    def _calls(scene: Scene) -> Any:
        return [[name, _lists(copy.deepcopy(arguments) if name == "add_time_function" else arguments)]
                for name, arguments in scene.model.calls]

    @staticmethod
    def _plan(calls: Any) -> Operating:
        return operating(SimpleNamespace(model=SimpleNamespace(calls=calls)), 0)  # type: ignore[arg-type]

    def _refuse_lost(self) -> None:
        """Numbers that vary and that the structs do not have, as stations of a survey."""
        assert self.places is not None
        for path, name, *_ in self.places.found:
            kind = self.places.calls[path[0]][0]
            if kind in _KEPT and (len(path) != 4 or (path[0], path[2]) not in self.described.structs):
                raise NotFast(f"{name} changes a list of numbers")

    def _compare(self, values: dict[str, Any]) -> None:
        """The short way against the long one, of one sample."""
        try:
            mine, wanted = ([soft_margin(one, found)[1] for one in self.failures]
                            for found in (self._fast(values), self._slow(values)))
        except (Error, ArithmeticError, ValueError):
            return  # a sample without a result has none either way
        if any(a != b and not abs(a - b) <= 1e-9 * max(abs(a), abs(b)) for a, b in zip(mine, wanted)):
            raise NotFast("longer pieces of pipe give other results")

    def margins(self, values: dict[str, Any], failures: list[Failure]) -> list[tuple[float, float]]:
        """Of one sample. Raises Error and the errors of reading the scene."""
        soft = self._slow(values) if self.places is None else self._fast(values)
        return [soft_margin(one, soft) for one in failures]

    def _fast(self, values: dict[str, Any]) -> Soft:
        assert self.places is not None
        for path, value in self.places.numbers(values):
            if path[0] in self.moving:
                put(self.places.calls, path, value)
            if path[0] in self.described.calls:
                self.described.put(path, value)
        return self._of(self.described, self._plan(self.places.calls) if self.moving else self.plan)

    def _slow(self, values: dict[str, Any]) -> Soft:
        scene = self._scene(values)
        calls = self._calls(scene)
        try:
            return self._of(Described(calls, frozenset({"length"})), self._plan(calls))
        except NotFast:  # parts that only a whole model has
            calls = [(name, (args[0], {**args[1], "yield_strength": STRENGTH}) if name == "add_pipes" else args)
                     for name, args in scene.model.calls]
            from ..model import Model, remake
            model = remake(Model, calls)
            return self.rows.of(model._handle, operating(scene, 0))

    def _of(self, described: Described, plan: Operating) -> Soft:
        handle = c_void_p()
        try:
            described.model(handle)
            return self.rows.of(handle, plan)
        finally:
            _lib.dmb_model_destroy(byref(handle))

    def notes(self) -> list[str]:
        """Loads that the result neglects, and the reason for long computing times."""
        found = []
        if self.why:
            found.append("torque and drag: each sample reads the scene again, which takes about ten times as long, "
                         f"because {self.why}")
        if has_rock_law(self.draw.scene):
            found.append("torque and drag: the load and torque of the bit are left out, because a rock law gives them "
                         "in a run only; ask --question run")
        elif not self._plan(self.draw.scene.model.calls).weight_on_bit:
            found.append("torque and drag: without load and torque of the bit, because the scene gives the bit no load")
        return found
