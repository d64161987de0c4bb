"""The base of every struct of the interface: fields that are checked, defaults from the library, a description
in plain Python that it can be made from again, and so copies and pickles."""
from __future__ import annotations

import ctypes
import difflib
import enum
import re
from collections.abc import Callable, Sequence
from ctypes import c_double
from typing import Any, ClassVar

from ._values import ERR_VALUE, flat, points, real, reals, refuse_type, refuse_value, text, whole

_FUNCTION: Any = ctypes.CFUNCTYPE(None).__mro__[1]
_DOUBLES = ctypes.POINTER(c_double)
_WHOLE = {ctypes.c_int32: (-2 ** 31, 2 ** 31 - 1), ctypes.c_uint32: (0, 2 ** 32 - 1), ctypes.c_int64: (-2 ** 63, 2 ** 63 - 1),
          ctypes.c_uint64: (0, 2 ** 64 - 1), ctypes.c_size_t: (0, 2 ** 64 - 1)}


def _plain(value: Any) -> Any:
    """A field as plain Python: arrays as lists, texts as str."""
    if hasattr(value, "ravel"):
        return value.ravel().tolist()  # numpy's
    if isinstance(value, ctypes.Array):
        return [_plain(one) for one in value]
    return value.decode(errors="replace") if isinstance(value, bytes) else value


def _is_pointer(kind: Any) -> bool:
    return isinstance(kind, type) and (issubclass(kind, ctypes._Pointer) or issubclass(kind, _FUNCTION)
                                       or kind is ctypes.c_void_p)


class Numbers:
    """A field of several numbers: read as a numpy array that shares the struct's memory, of the shape that the field's text gives; where
    numpy is not installed as an array of ctypes."""

    def __init__(self, field: Any, count: int, about: str) -> None:
        self.field, self.count = field, count
        self.offset, self.size = field.offset, field.size
        shape = re.search(r"\bshape \((\d+(?:, \d+)+)\)", about)
        self.shape = tuple(int(one) for one in shape[1].split(", ")) if shape else (count,)

    def __get__(self, struct: Any, owner: Any = None) -> Any:
        if struct is None:
            return self
        from ._optional import numpy
        if numpy is None:
            return self.field.__get__(struct, owner)
        return numpy.frombuffer(struct, "float64", self.count, self.offset).reshape(self.shape)

    def __set__(self, struct: Any, value: Any) -> None:
        self.field.__set__(struct, value)


def read_as_numpy(cls: type[Record]) -> None:
    """Fields of several numbers are read as numpy arrays from now on. ctypes makes its fields after a class is made, so this cannot be done
    while it is."""
    for name, kind in cls._kinds.items():
        if isinstance(kind, type) and issubclass(kind, ctypes.Array) and kind.__name__.startswith("c_double"):
            setattr(cls, name, Numbers(cls.__dict__[name], ctypes.sizeof(kind) // 8, cls.field_docs.get(name, ("", ""))[1]))


class Record(ctypes.Structure):
    """A struct that checks its fields: a misspelt one is an error, a sequence fills an array, a part means its
    reference point where a place is needed and None for no part. dict(struct) and struct["field"] read it as a mapping."""
    c_name: ClassVar[str] = ""
    about: ClassVar[str] = ""
    field_docs: ClassVar[dict[str, tuple[str, str]]] = {}  # field -> (unit, meaning)
    bounds: ClassVar[dict[str, tuple[str, float, float]]] = {}  # field of options -> (kind of range, low, high), SI

    _kinds: ClassVar[dict[str, Any]] = {}  # field -> its type
    _constants: ClassVar[dict[str, set[str]]] = {}  # field -> prefixes of the constants that it takes

    def __init_subclass__(cls, **more: Any) -> None:
        super().__init_subclass__(**more)
        if cls.c_name:
            cls._kinds = dict(cls.__dict__["_fields_"])
            cls._constants = {name: {"X"} if text.startswith("X (") else set(re.findall(r"\b([A-Z][A-Z_]*)_\.\.\.", text))
                              for name, (_, text) in cls.field_docs.items()}
            own = cls.__doc__ if "__doc__" in cls.__dict__ else None
            mixed = cls.__mro__[1].__doc__ if cls.__mro__[1].__name__.endswith("Part") else None
            parts = [f"{cls.c_name} of the headers.", mixed or own or "", cls.about]
            named = {name: f" ({cls._kinds[name].__name__})" for name in cls._kinds
                     if getattr(cls._kinds[name], "__name__", "") in ("Place", "Id", "Output")}
            fields = "\n".join(f"{name}{named.get(name, '')}: " + (f"[{unit}] " if unit else "") + text
                               for name, (unit, text) in cls.field_docs.items())
            cls.__doc__ = "\n\n".join(part for part in [*parts, fields] if part)

    def __setattr__(self, name: str, value: Any) -> None:
        kind = self._kinds.get(name)
        if kind is not None:
            value = self._fit(name, kind, value)
        elif not name.startswith("_") and not hasattr(type(self), name):
            from .errors import WrongName
            close = difflib.get_close_matches(name, self._kinds, 1)
            raise WrongName(ERR_VALUE, f"{type(self).__name__} has no field '{name}'" + (f"; '{close[0]}'?" if close else ""))
        super().__setattr__(name, value)

    def _fit(self, name: str, kind: Any, value: Any) -> Any:
        """The value as ctypes takes it for a field of a kind; other values are refused."""
        part = type(self).__name__
        if kind is c_double:
            return real(value, part, name, self.field_docs.get(name, ("",))[0])
        if kind in _WHOLE:
            self._is_constant_of(name, value)
            return whole(value, part, name, *_WHOLE[kind])
        if isinstance(kind, type) and issubclass(kind, ctypes.Array):
            return self._fit_array(name, kind, value)
        if isinstance(kind, type) and issubclass(kind, Record):
            return _fit_record(part, name, kind, value)
        if kind is _DOUBLES and value is not None and not isinstance(value, (ctypes.Array, ctypes._Pointer)):
            return self._fit_pointer(name, value)
        return value

    def _fit_pointer(self, name: str, value: Any) -> Any:
        """Numbers, or rows of numbers, behind a pointer; ctypes keeps their memory with the struct. The field that counts them is set."""
        numbers = reals(flat(value), type(self).__name__, name)
        if f"{name.removesuffix('s')}_count" in self._kinds:
            setattr(self, f"{name.removesuffix('s')}_count", len(value))
        return (c_double * len(numbers))(*numbers)

    def _fit_array(self, name: str, kind: Any, value: Any) -> Any:
        part = type(self).__name__
        if kind._type_ is ctypes.c_char:
            return text(value, part, name, kind._length_)
        if kind._type_ is c_double:
            return kind(*reals(value.ravel() if hasattr(value, "ravel") else value, part, name, kind._length_))
        values = list(value)
        if len(values) != kind._length_:
            refuse_value(part, name, value, f"be {kind._length_} values: {len(values)} are given")
        return kind(*values)

    def _is_constant_of(self, name: str, value: Any) -> None:
        """Refuses a constant of another enumeration, as JOINT_FIXED for the kind of a pipe."""
        prefixes = self._constants.get(name)
        if prefixes and isinstance(value, enum.Enum):
            own = re.search(r"DMB_(\w*?)_?\.\.\.", type(value).__doc__ or "")
            if own and own[1] and not any(f"{one}_".startswith(f"{own[1]}_") for one in prefixes):
                bound = " or ".join(sorted(one + "_..." for one in prefixes)) if prefixes != {"X"} else "X .. RZ"
                refuse_type(type(self).__name__, name, value, f"be {bound}")

    def __repr__(self) -> str:
        fields = ", ".join(f"{name}={value!r}" for name, value in self.describe(every=True).items())
        return f"{type(self).__name__}({fields})"

    def describe(self, every: bool = False) -> dict[str, Any]:
        """The fields as plain Python, lists for arrays: type(self)(**fields) makes an equal struct. `every` shows those
        at their defaults too. Functions of the caller's are those of Python that were given."""
        default = None if every else type(self)()
        found = {}
        for name, kind in self._fields_:
            if name == "struct_size" or name.rstrip("0123456789").endswith("reserved") or _is_pointer(kind):
                continue
            value = _plain(getattr(self, name))
            usual = _plain(getattr(default, name)) if default is not None else None
            if every or not (value == usual or (value != value and usual != usual)):  # NaN may be the default
                found[name] = value
        return found

    def keys(self) -> list[str]:
        """Names of the fields, without those that are reserved."""
        return [name for name in self._kinds if name != "struct_size" and not name.rstrip("0123456789").endswith("reserved")]

    def __getitem__(self, name: str) -> Any:
        if not isinstance(name, str):
            raise TypeError(f"{type(self).__name__}[{name!r}]: give the name of a field")
        if name not in self._kinds:
            raise KeyError(name)
        return getattr(self, name)

    def _asdict(self) -> dict[str, Any]:
        """The fields by name."""
        return {name: self[name] for name in self.keys()}

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Record) or type(other) is not type(self):
            return NotImplemented
        return self.describe() == other.describe()

    __hash__ = None  # type: ignore[assignment]

    def __reduce__(self) -> Any:
        return _make, (type(self), self.describe())

    def __copy__(self) -> Any:
        return type(self)(**self.describe())

    def __deepcopy__(self, memo: Any) -> Any:
        return self.__copy__()


def _make(cls: type[Record], fields: dict[str, Any]) -> Record:
    return cls(**fields)


def _fit_record(part: str, name: str, kind: Any, value: Any) -> Any:
    """A struct of the kind: a part or None for a place, None for no part, a pair (place, quantity) for an output."""
    if isinstance(value, kind):
        return value
    word = kind.__name__
    if value is None and word in ("Place", "Id"):
        return kind()
    if word == "Place" and isinstance(value, IdPart):
        return kind(value)
    if word == "Output" and isinstance(value, tuple) and len(value) == 2:
        from .outputs import output_quantity
        return kind(place=value[0], quantity=output_quantity(value[1]))
    bound = {"Place": "be a place, station(string, pipe, fraction), or a part", "Id": "be the id of a part",
             "Output": 'be an Output or a pair (place, "bit_speed")'}
    refuse_type(part, name, value, bound.get(word, f"be a {word}"))


class Sized(Record):
    """A struct with struct_size, filled with the library's defaults and then with the given fields."""
    status: Any = 0  # of the call that returned it
    _template: ClassVar[bytes] = b""

    def __init__(self, **fields: Any) -> None:
        super().__init__()
        template = type(self)._template or self._learn()
        ctypes.memmove(ctypes.byref(self), template, len(template))
        for name, value in fields.items():
            setattr(self, name, value)

    @classmethod
    def _learn(cls) -> bytes:
        """The defaults, read from the library once."""
        from ._library import lib
        from .errors import check
        blank = cls.from_buffer_copy(bytes(ctypes.sizeof(cls)))
        check(getattr(lib, cls.c_name + "_init")(ctypes.byref(blank), ctypes.sizeof(cls)))
        cls._template = bytes(blank)
        return cls._template

    @classmethod
    def blank(cls) -> Any:
        """One with the defaults, as fast as can be."""
        return cls.from_buffer_copy(cls._template or cls._learn())


# ---- Structs with more than fields -----------------------------------------------------------------------------------
class IdPart:
    """Names a part of a model. Id() names nothing."""
    index: int
    generation: int

    def __eq__(self, other: object) -> bool:
        return isinstance(other, IdPart) and (self.index, self.generation) == (other.index, other.generation)

    def __hash__(self) -> int:
        return hash((self.index, self.generation))

    def __bool__(self) -> bool:
        return self.generation != 0


class SegmentPart:
    """One segment of a time function. `table` takes pairs (time, value) or two sequences, (times, values), which SEGMENT_PERIODIC repeats;
    `function` takes a function of time that returns a value, or (value, rate), or (value, rate, integral)."""

    def __init__(self, table: Any = None, function: Callable[[float], Any] | None = None, **fields: Any) -> None:
        super().__init__(**fields)
        self._function = function
        self._table: list[tuple[float, float]] = []
        if table is not None:
            if fields.get("kind", 4) not in (4, 6):
                refuse_value("Segment", "kind", fields["kind"], "be SEGMENT_TABLE or SEGMENT_PERIODIC with a table; leave out the one or the other")
            self._set_table(*points(table, "Segment"), 6 if fields.get("kind") == 6 else 4)
        if function is not None:
            if not callable(function):
                refuse_type("Segment", "function", function, "be a function of time")
            self.kind = 5

    def _set_table(self, times: Sequence[float], values: Sequence[float], kind: int) -> None:
        self.kind, self.table_count = kind, len(times)
        self.table_time, self.table_value = (c_double * len(times))(*times), (c_double * len(times))(*values)
        self._table = list(zip(times, values))

    def describe(self, every: bool = False) -> dict[str, Any]:
        """The fields as plain Python, `table` and `function` as given."""
        found: dict[str, Any] = super().describe(every)  # type: ignore[misc]
        for name in ("table_count",) + (("kind",) if self.kind in (4, 5) and (self._table or self._function) else ()):
            found.pop(name, None)
        if self._table:
            found["table"] = list(self._table)
        if self._function is not None:
            found["function"] = self._function
        return found


class PairsPart:
    """A struct with columns of fixed length, each two of which one key takes as pairs."""
    PAIRS: ClassVar[dict[str, tuple[str, str, str]]] = {}  #: key: names of its count and columns

    def __init__(self, **fields: Any) -> None:
        given = {key: fields.pop(key, None) for key in self.PAIRS}
        super().__init__(**fields)
        for key, pairs in given.items():
            if pairs is None:
                continue
            count, *names = self.PAIRS[key]
            columns = points(pairs, type(self).__name__, key)
            room = len(getattr(self, names[0]))
            if len(columns[0]) > room:
                refuse_value(type(self).__name__, key, pairs, f"have at most {room} points: {len(columns[0])} are given")
            setattr(self, count, len(columns[0]))
            for name, column in zip(names, columns):
                setattr(self, name, (column + [0.0] * room)[:room])

    def describe(self, every: bool = False) -> dict[str, Any]:
        """The fields as plain Python, columns as pairs."""
        found: dict[str, Any] = super().describe(every)  # type: ignore[misc]
        for key, (count, one, other) in self.PAIRS.items():
            for name in (count, one, other):
                found.pop(name, None)
            if getattr(self, count):
                found[key] = list(zip(getattr(self, one), getattr(self, other)))[:getattr(self, count)]
        return found


class WallPart(PairsPart):
    """The hole. `stations` takes triples (measured depth [m], inclination [rad], azimuth [rad]); `friction_table` up to 8 pairs (speed of sliding
    [m/s], coefficient [-])."""
    PAIRS = {"friction_table": ("friction_table_count", "friction_table_speed", "friction_table_mu")}
    friction_table_count: int
    friction_table_mu: Any

    def __init__(self, stations: Any = None, **fields: Any) -> None:
        survey = fields.get("survey")
        if survey is not None and not isinstance(survey, (ctypes.Array, ctypes._Pointer)):  # the name in C of the same triples
            if stations is not None:
                raise TypeError("give stations or survey, not both")
            stations = fields.pop("survey")
        super().__init__(**fields)
        if self.friction_table_count and not {"mu_static", "mu_dynamic"} & set(fields):
            self.mu_static, self.mu_dynamic = self.friction_table_mu[0], self.friction_table_mu[self.friction_table_count - 1]
        self._stations: list[list[float]] = []
        if stations is not None:
            if isinstance(stations, (str, bytes, dict)) or not hasattr(stations, "__iter__"):
                refuse_type("WallDef", "stations", stations, "be triples (depth [m], inclination [rad], azimuth [rad])")
            self._stations = [reals(triple, "WallDef", f"stations[{i}]", 3) for i, triple in enumerate(stations)]
            if not self._stations:
                refuse_value("WallDef", "stations", stations, "be at least 2 triples; leave it out for a straight hole")
            values = [number for triple in self._stations for number in triple]
            self.survey_count, self.survey = len(self._stations), (c_double * len(values))(*values)

    def describe(self, every: bool = False) -> dict[str, Any]:
        """The fields as plain Python, `stations` as given."""
        found: dict[str, Any] = super().describe(every)
        found.pop("survey_count", None)
        for key in ("mu_static", "mu_dynamic") if self.friction_table_count else ():  # the table says them
            found.pop(key, None)
        if self._stations:
            found["stations"] = [list(triple) for triple in self._stations]
        return found


class SpringPart:
    """A spring and damper between two points. `table` takes pairs (elongation [m], force [N]) or two sequences."""

    def __init__(self, table: Any = None, **fields: Any) -> None:
        super().__init__(**fields)
        self._table: list[tuple[float, float]] = []
        if table is not None:
            lengths, forces = points(table, "SpringDef")
            self.table_count, self._table = len(lengths), list(zip(lengths, forces))
            self.table_elongation, self.table_force = (c_double * len(lengths))(*lengths), (c_double * len(forces))(*forces)

    def describe(self, every: bool = False) -> dict[str, Any]:
        """The fields as plain Python, `table` as given."""
        found: dict[str, Any] = super().describe(every)  # type: ignore[misc]
        found.pop("table_count", None)
        if self._table:
            found["table"] = list(self._table)
        return found


class DrivePart(PairsPart):
    """A drive of a component of motion. `curve` takes up to 8 pairs (speed [m/s, rad/s], force [N, N m]) of the actuator,
    `gain_table` up to 16 (error of the speed, force) of a controller."""
    PAIRS = {"curve": ("curve_count", "curve_speed", "curve_force"),
             "gain_table": ("gain_count", "gain_error", "gain_force")}


class MotorPart(PairsPart):
    """A mud motor. `table` takes up to 15 pairs (speed [rad/s], torque [N m]) from stall to no load."""
    PAIRS = {"table": ("table_count", "table_speed", "table_torque")}


class PlacesPart:
    """A part on one to four `places`, computed by a `function`."""
    place_count: int
    place: Any

    def __init__(self, places: Any = None, function: Callable[..., Any] | None = None, **fields: Any) -> None:
        super().__init__(**fields)
        self._function = function
        if function is not None and not callable(function):
            refuse_type(type(self).__name__, "function", function, "be a function")
        if places is not None:
            kind, part = type(self.place[0]), type(self).__name__
            if isinstance(places, str) or not hasattr(places, "__iter__"):
                refuse_type(part, "places", places, "be a list of places or parts")
            given = [_fit_record(part, f"places[{i}]", kind, place) for i, place in enumerate(places)]
            self.place_count = len(given)
            self.place = (given + [kind()] * 4)[:4]

    def describe(self, every: bool = False) -> dict[str, Any]:
        """The fields as plain Python, `places` and `function` as given."""
        found: dict[str, Any] = super().describe(every)  # type: ignore[misc]
        for name in ("place_count", "place"):
            found.pop(name, None)
        found["places"] = list(self.place)[:self.place_count]
        if self._function is not None:
            found["function"] = self._function
        return found


class ForcePart(PlacesPart):
    """A force on one to four `places` (places, bodies, or joints with their `component`). `function` takes the time, a
    sequence of poses, each of twelve numbers (position, rotation matrix by rows), and one of velocities, each of six; it
    returns six numbers a place. With provides=PROVIDES_TANGENT it returns a tuple that also has the derivatives by
    displacements and by velocities, 6 places x 6 places each; with PROVIDES_POTENTIAL the energy [J] comes last. With
    state_count > 0 the function also takes the state at the last accepted time and the time [s] since, and returns the
    new state last of a tuple."""


class ConstraintPart(PlacesPart):
    """A constraint on the poses of one to four `places`. `function` takes the time and a sequence of poses, each of
    twelve numbers (position, rotation matrix by rows), and returns `row_count` numbers (or one); with
    provides=PROVIDES_JACOBIAN a pair of these and of the row_count x 6 places jacobian, flat or row by row."""
