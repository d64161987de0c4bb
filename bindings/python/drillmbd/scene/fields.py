"""Keys of the tables of a scene file: the fields of a struct of the interface, with the units, enumerations and
meaning that the headers give them. Nothing is written down twice."""
from __future__ import annotations

import ctypes
import functools
import math
import re
from dataclasses import dataclass, replace
from enum import IntEnum, IntFlag
from typing import Any

from .. import _structs, enums
from .._structs import Id, Place
from ..outputs import output_unit
from ..outputs import Named
from . import units
from .problems import meant

# Fields whose text in the header does not name the enumeration.
ENUM_OF = {"component": enums.Component, "third_component": enums.Component, "fourth_component": enums.Component,
           "initial_mask": enums.Free, "start_free": enums.Free, "end_free": enums.Free,
           "free_mask": enums.Free, "pipe_kind": enums.PipeKind, "contact": enums.ContactState, "outside": enums.Outside,
           "target": enums.InputTarget, "holds": enums.StuckHolds}
UNIT_OF = {"contact_gap": "m", "structural_damping": "-", "equilibrium_tolerance": "-"}  # where one comment is of several fields
MOST_WORDS = 10  #: that are listed where another one is written
LEFT_OUT = {"struct_size", "survey_count", "friction_table_count", "friction_table_speed", "friction_table_mu",
            "friction_state_count", "friction_callback", "friction_context", "friction_accept", "state_count", "accept", "curve_count", "curve_speed", "curve_force", "gain_count", "gain_error", "gain_force", "table_count",
            "table_speed", "table_torque",
            "provides", "callback_context", "callback", "log", "allocator",
            "log_context"}
LEFT_OUT_OF = {("DriveDef", "value")}  # time_function = "120 rpm" says the same
#: Meaning of a key that scene files read in another way than C.
ABOUT_OF = {("DriveDef", "time_function"): 'required: the name of a time function, or a constant, as "120 rpm"; "0 m/s" holds',
            ("InputDef", "part"): "drive, load, bit or stuck place; left out: wall and environment",
            ("InputDef", "initial"): "at time 0, within the bounds; left out: as described, which for set-point, load-factor and "
                                     "bit-load is the time function, until the input is set",
            ("InputDef", "rate_limit"): "of set-point, load-factor and bit-load: the most it changes in a second, > 0; 0: it jumps. "
                                        "Required for the set point of a motion drive: largest acceleration"}


#: C names in the header comments, and the words of scene files that replace them.
WORDS_OF = {"not there without FEATURE_": "not there without the feature FEATURE_", "of CONTACT_": "of contact = CONTACT_",
            "of SCALE_": "of scale = SCALE_", "X .. RZ": "x .. RZ", "X (feed": "x (feed", "or _END:": 'or "end":',
            "default NOT_GIVEN": "left out: that of [hole]",
            " (dmb_query_flow)": "", "dmb_statistics.bounces counts them": "a run notes them", ", for dmb_query_hole": "",
            "; by dmb_motor_drive": "", ", dmb_sim_set_drive and limits": " and limits", "NOT_GIVEN": "left out",
            "dmb_static_options": "[static]", "dmb_modes_options": "[modes]", "dmb_response_options": "[response]",
            "local error in dmb_sim_advance": "local error of a step that the library chooses",
            "shortest step of dmb_sim_advance and": "shortest step that the library chooses, and",
            "accepted steps in one dmb_sim_advance, then NOTE_STOPPED":
                "accepted steps in one call of the library, after which a run continues",
            "dmb_sim_step does one step": "each step of a run with `step` is one",
            "and accepts a finite result with NOTE_WORK_LIMITED": "that accepts a finite result with a note",
            "dmb_sim_create": "the start of a run", "More is ERR_GEOMETRY": "More is refused",
            " and dmb_model_find_pipes": "", "returned by dmb_query_hole": "for results"}


@dataclass(frozen=True)
class Field:
    """One key of a table."""
    name: str
    kind: str            #: quantity, integer, enum, flags, text, id, place
    unit: str = ""       #: as in the header, alternatives with a comma
    count: int = 0       #: of an array; 0: a single value
    enum: Any = None
    about: str = ""
    bound: tuple[str, float, float] | None = None  #: kind of range, low, high, SI; None: the library checks the whole part

    def outside(self, value: float) -> str:
        """The range in words if a number is not in it, otherwise nothing."""
        if self.bound is None:
            return ""
        kind, low, high = self.bound
        unit = "" if self.unit in ("", "-") or self.unit.startswith("unit of") else f" (in {self.unit})"
        if kind == "above":
            return "" if low < value < math.inf else f"must be > {low:g}{unit}"
        if low <= value <= high or (kind == "zero_or" and value == 0.0) or (kind == "minus_one_or" and value == -1.0):
            return ""
        return f"must be {dict(zero_or='0 or ', minus_one_or='-1 or ').get(kind, '')}{low:g} .. {high:g}{unit}"

    def unit_at(self, index: int) -> str:
        """The unit of one number of an array: three of translation then three of rotation, or one each."""
        listed = [one.strip() for one in self.unit.split(",")]
        if self.count and len(listed) == self.count:
            return listed[index]
        if self.count == 6 and len(listed) == 2:
            return listed[index // 3]
        return self.unit


@functools.lru_cache(maxsize=None)
def fields_of(struct: Any) -> dict[str, Field]:
    """The keys that mirror the fields of a struct."""
    found = {}
    for name, kind in struct._fields_:
        if name not in LEFT_OUT and (struct.__name__, name) not in LEFT_OUT_OF and "reserved" not in name and not _is_pointer(kind):
            unit, about = struct.field_docs.get(name, ("", ""))
            about = ABOUT_OF.get((struct.__name__, name), about)
            found[name] = replace(_field(name, kind, unit, about), bound=struct.bounds.get(name), about=in_scene(about))
    return found


def in_scene(text: str) -> str:
    """A text of the headers with the words of scene files: per-revolution for PER_REVOLUTION, "damping" for
    FEATURE_DAMPING."""
    for name, words in WORDS_OF.items():
        text = text.replace(name, words)
    text = re.sub(r"(mask of )?\b[A-Z][A-Z_]*_\.\.\.[,;:]? ?", "", text)  # a schema lists the words
    return re.sub(r"\b[A-Z][A-Z0-9_]+\b", lambda match: _word_in_scene(match[0]), text)


def _word_in_scene(name: str) -> str:
    member = getattr(enums, name, None)
    if isinstance(member, enums.Component):
        return word_of(member)
    if isinstance(member, (IntEnum, IntFlag)):
        return f'"{word_of(member)}"'
    return name.lower().replace("_", "-") if name in _members() else name


@functools.lru_cache(maxsize=None)
def _members() -> set[str]:
    """Names of the members of enumerations, as the headers have them beside the field that they are values of."""
    return {name for kind in vars(enums).values() if isinstance(kind, type) and issubclass(kind, IntEnum) and kind is not enums.Status
            for name in kind.__members__}


def _is_pointer(kind: Any) -> bool:
    return hasattr(kind, "contents") or kind is ctypes.c_void_p or hasattr(kind, "_flags_")


def _field(name: str, kind: Any, unit: str, about: str) -> Field:
    count = 0
    if issubclass(kind, ctypes.Array):
        if kind._type_ is ctypes.c_char:
            return Field(name, "text", about=about)
        count, kind = kind._length_, kind._type_
    if kind is Id:
        return Field(name, "id", count=count, about=about)
    if kind is Place:
        return Field(name, "place", count=count, about=about)
    if kind is ctypes.c_double:
        return Field(name, "quantity", UNIT_OF.get(name) or unit, count, about=about)
    enum = ENUM_OF.get(name) or (_enum_in(about) if kind is ctypes.c_int32 else None)
    if enum is not None:
        return Field(name, "flags" if issubclass(enum, IntFlag) else "enum", "", count, enum, about)
    return Field(name, "integer", "", count, about=about)


def _enum_in(about: str) -> Any:
    """The enumeration that the text of a field names a member of."""
    for word in re.findall(r"\b[A-Z]+_[A-Z0-9_]+", about):
        member = getattr(enums, word, None)
        if isinstance(member, (IntEnum, IntFlag)) and not isinstance(member, enums.Status):
            return type(member)
    return None


# ---- Names of values -------------------------------------------------------------------------------------------------
def word_of(member: Any) -> str:
    """SegmentKind.STEP5 as "step5", NormalLaw.HUNT_CROSSLEY as "hunt-crossley"."""
    return str(member.name).lower().replace("_", "-")


def words_of(enum: Any) -> dict[str, int]:
    """The words for an enumeration, with their values."""
    if enum is enums.Free:
        return {word_of(member): int(enums.Free[member.name]) for member in enums.Component}
    left_out = {"count", "callback"} if enum is enums.FrictionLaw else {"count"}  # a law of one's own is for programs
    return {word_of(member): int(member.value) for member in enum.__members__.values() if word_of(member) not in left_out}


def flag_words(enum: Any, value: int) -> list[str]:
    """A mask as the words of its bits."""
    return [word for word, bit in words_of(enum).items() if bit & value and bit & (bit - 1) == 0]


class ValueProblem(ValueError):
    """A value that does not fit its field."""


def read(field: Field, value: Any, unit: str | None = None) -> Any:
    """The plain value (SI) of a field as written; ids and places are left to the caller."""
    if field.count:
        if not isinstance(value, list) or len(value) != field.count:
            raise ValueProblem(f"must be an array of {field.count}" + _shape(value, field.count))
        return [_single(field, one, field.unit_at(i) if unit is None else unit) for i, one in enumerate(value)]
    return _single(field, value, field.unit if unit is None else unit)


def remark(field: Field, value: Any, unit: str | None = None) -> str:
    """The assumption that read makes of a value; "" if it makes none."""
    if field.kind != "quantity":
        return ""
    if field.count:
        remarks = [units.remark(one, field.unit_at(i) if unit is None else unit) for i, one in enumerate(value)]
        return next((one for one in remarks if one), "")
    return units.remark(value, (field.unit if unit is None else unit) or "-")


def _shape(value: Any, count: int) -> str:
    """The length of another array; an array of a lone value as an example."""
    if isinstance(value, list):
        return f", not of {len(value)}"
    one = f'"{value}"' if isinstance(value, str) else str(value)
    return f", as [{', '.join([one] * count)}]" if isinstance(value, (str, int, float)) else ""


def _single(field: Field, value: Any, unit: str) -> Any:
    if field.kind == "quantity":
        try:
            return units.parse(value, "-" if unit == "" else unit)
        except units.UnitError as error:
            raise ValueProblem(str(error)) from error
    if field.kind == "integer":
        if not isinstance(value, int):
            raise ValueProblem("must be a whole number")
        if not -2 ** 31 <= value < 2 ** 32:
            raise ValueProblem("must be below 2^32")
        return int(value)
    if field.kind == "text":
        if not isinstance(value, str):
            raise ValueProblem("must be a text")
        if len(value.encode()) > 23:
            raise ValueProblem("must be of at most 23 bytes")
        return value
    words = words_of(field.enum)
    if field.kind == "enum":
        if not isinstance(value, str) or value not in words:
            near = meant(str(value), words)
            listed = len(words) <= MOST_WORDS and not near.startswith("; possible")
            raise ValueProblem("must be one of the words" + (f" {', '.join(words)}" if listed else " of this key") + near)
        return words[value]
    mask = _flags(value, words)
    return int(enums.Free.NONE) if field.enum is enums.Free and not mask else mask


def _flags(value: Any, words: dict[str, int]) -> int:
    if not isinstance(value, list):
        raise ValueProblem(f"must be an array of words; possible are {', '.join(words)}")
    mask = 0
    for one in value:
        if not isinstance(one, str) or one not in words:
            raise ValueProblem(f"{one!r} is none of the words" + meant(str(one), words))
        mask |= words[one]
    return mask


def write(field: Field, value: Any, unit: str | None = None) -> Any:
    """A plain value as it is written; the inverse of read."""
    if field.count:
        return [_written(field, one, field.unit_at(i) if unit is None else unit) for i, one in enumerate(value)]
    return _written(field, value, field.unit if unit is None else unit)


def _written(field: Field, value: Any, unit: str) -> Any:
    if field.kind == "quantity":
        return units.text(value, unit.split(",")[0].strip())
    if field.kind == "enum":
        return next(word for word, number in words_of(field.enum).items() if number == value)
    if field.kind == "flags":
        return flag_words(field.enum, value)
    return value


# ---- Units that depend on the table ----------------------------------------------------------------------------------
def by_component(units_of_two: str, component: int) -> str:
    """The first of "N/m, N m" for a translation, the second for a rotation."""
    listed = [one.strip() for one in units_of_two.split(",")]
    return listed[0] if len(listed) == 1 or component < 3 else listed[1]


def drive_unit(kind: int, component: int) -> str:
    """The unit of a drive's time function."""
    return by_component("N, N m" if kind == enums.DRIVE_LOAD else "m/s, rad/s", component)


# Keys of a drive whose unit goes with its component.
DRIVE_PAIRS = ("curve", "gain_table")  # of speed and force
OF_COMPONENT = ("gain", "integral_gain", "limit_low", "limit_high", "force_rate", "drag", "back_drag")


def excitation_unit(kind: int, component: int) -> str:
    """The unit of the amplitude of an input, that of a drive's time function apart."""
    known: dict[int, str] = {enums.EXCITATION_FORCE: by_component("N, N m", component), enums.EXCITATION_BIT_LOAD: "N",
                             enums.EXCITATION_UNBALANCE: "kg m"}
    return known.get(kind, "-")


def event_fields() -> dict[str, Field]:
    """The keys of an event: those of its struct, with quantity and place instead of its output."""
    known = {key: field for key, field in fields_of(_structs.EventDef).items() if key not in ("output", "name")}
    return {**output_fields(), **known}


def output_fields() -> dict[str, Field]:
    """The keys of an output."""
    return {"quantity": Field("quantity", "enum", enum=Named), "place": Field("place", "place")}


def unit_of_output(quantity: int, setting: str | None, component: int | None) -> str:
    """The unit of an output. setting: of the input that it reads, where it depends on it; component: of the drive that it
    is about, by which "N or N m" is a force or a torque."""
    unit = output_unit(quantity) if quantity >= 0 else "-"
    listed = unit.replace("unit of the input", setting or "-").split(" or ")
    return listed[-1 if component is not None and component >= enums.RX else 0].split(",")[0]


def setting_units(target: int, drive: tuple[int, int] | None) -> dict[str, str]:
    """The units of the fields of an input; drive: kind and component of the drive that it moves."""
    kind, component = drive or (0, 0)
    known: dict[int, str] = {enums.TARGET_SET_POINT: drive_unit(kind, component), enums.TARGET_BIT_LOAD: "N",
                             enums.TARGET_GAIN: by_component("N s/m, N m s", component),
                             enums.TARGET_INTEGRAL_GAIN: by_component("N/m, N m", component),
                             enums.TARGET_LIMIT_LOW: by_component("N, N m", component),
                             enums.TARGET_LIMIT_HIGH: by_component("N, N m", component),
                             enums.TARGET_FLUID_DENSITY: "kg/m3", enums.TARGET_LATERAL_DAMPING: "N s/m2",
                             enums.TARGET_AXIAL_DAMPING: "N s/m2", enums.TARGET_TORSIONAL_DAMPING: "N s",
                             enums.TARGET_FLOW_RATE: "m3/s"}
    unit = known.get(target, "-")
    by_time = {"-": ("1/s", "1/s2"), "m/s": ("m/s2", "m/s3"), "rad/s": ("rad/s2", "rad/s3")}
    rate, slope = by_time.get(unit, (unit + "/s", unit + "/s2"))
    return {"initial": unit, "low": unit, "high": unit, "rate_limit": rate, "slope_limit": slope}


DEFINITIONS: dict[str, Any] = {
    "environment": _structs.EnvironmentDef, "hole": _structs.WallDef, "section": _structs.HoleSection, "string": _structs.StringDef,
    "pipes": _structs.PipeDef, "body": _structs.BodyDef, "bit": _structs.BitDef, "stabiliser": _structs.StabiliserDef,
    "joint": _structs.JointDef,
    "coupling": _structs.CouplingDef, "drive": _structs.DriveDef, "load": _structs.LoadDef,
    "spring": _structs.SpringDef, "stuck": _structs.StuckDef, "sub": _structs.SubDef, "segment": _structs.Segment,
    "compile": _structs.CompileOptions, "sim": _structs.SimOptions, "static": _structs.StaticOptions,
    "modes": _structs.ModesOptions, "response": _structs.ResponseOptions, "speeds": _structs.SpeedsOptions,
    "buckling": _structs.BucklingOptions, "fatigue": _structs.FatigueOptions, "input": _structs.InputDef, "event": _structs.EventDef, "response excitation": _structs.Excitation,
    "order": _structs.Order}
