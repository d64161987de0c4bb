#!/usr/bin/env python3
"""Makes four modules of the package from the public headers, which own these facts: enums.py (constants), _structs.py
(structs with unit and meaning of every field, types of callbacks), _functions.py (prototypes, comments of functions) and
_typed.py (methods that take the fields of a struct as keywords, as type checkers and editors see them).

usage: generate.py            writes them
       generate.py --check    tells whether they are up to date; exit status 1 if not
"""
import functools
import math
import pathlib
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent
HEADERS = HERE.parents[1] / "include" / "drillmbd"
LISTS = HERE.parents[1] / "lib" / "fields"
PACKAGE = HERE / "drillmbd"

# Names of enumerations whose members share too little, or whose prefix says too little. Key: the first member.
ENUM_NAMES = {"OK": "Status", "LOG_ERROR": "LogLevel", "X": "Component", "SEGMENT_CONSTANT": "SegmentKind",
              "NORMAL_NONE": "NormalLaw", "FRICTION_NONE": "FrictionLaw", "PIPE_FLEXIBLE": "PipeKind",
              "ROCK_NONE": "RockLaw", "JOINT_FIXED": "JointKind", "JOINT_ACTIVE": "JointMode",
              "CONSTRAINT_HOLONOMIC": "ConstraintKind", "PROVIDES_RATE": "TimeFunctionProvides",
              "PROVIDES_JACOBIAN": "ConstraintProvides", "PROVIDES_TANGENT": "ForceProvides", "DRIVE_MOTION": "DriveKind",
              "OUTPUT_DISPLACEMENT_X": "Quantity", "OUTPUT_HOOK_LOAD": "Reading", "EXCITATION_DRIVE": "ExcitationKind",
              "TARGET_SET_POINT": "InputTarget", "OUTSIDE_REFUSED": "Outside",
              "STATE_FULL": "StateForm", "MOTION_SPEED": "MotionInput", "MATRIX_A": "Matrix", "ARRAY_VELOCITY": "Array",
              "ROW_FREE": "RowState",
              "PATH_REGULAR": "PathKind", "CONTACT_AS_IS": "ContactState", "MODES_UNDAMPED": "ModesKind",
              "MODES_LOWEST": "ModesSelect",
              "MODES_AXES_TURNING": "ModesAxes", "RESPONSE_AXES_TURNING": "ResponseAxes",
              "OPERATION_PICK_UP": "OperationKind", "MEASURED_HOOK_LOAD": "Measured",
              "PROFILE_DISTANCE": "ProfileQuantity", "HOLE_ABOVE": "HoleBeyond", "HOLE_STEP": "HoleShape",
              "EVENT_EITHER": "EventDirection", "PART_ANY": "PartKind",
              "STATIC_NEWTON": "StaticMethod", "METHOD_INDEPENDENT": "ConstraintMethod",
              "BUCKLING_EXTRAPOLATED": "BucklingEnd", "SPRING_BOTH": "SpringActs", "STUCK_AXIAL": "StuckHolds", "TABLE_LINES": "TableKind", "SCALE_ALL": "Scale"}
FLAGS = ("FREE", "FEATURE", "PROVIDES", "STUCK")  # prefixes of bits of masks
STRUCT_NAMES = {"dmb_error": "ErrorStruct", "dmb_recorder": "RecorderStruct", "dmb_profile": "ProfileStruct",
                "dmb_profile_recorder": "ProfileRecorderStruct"}
MIXINS = {"Id": "IdPart", "Segment": "SegmentPart", "WallDef": "WallPart", "ConstraintDef": "ConstraintPart",
          "SpringDef": "SpringPart", "DriveDef": "DrivePart", "Motor": "MotorPart", "ForceDef": "ForcePart"}
NUMBERS = {"int32_t": "c_int32", "uint32_t": "c_uint32", "int64_t": "c_int64", "uint64_t": "c_uint64",
           "double": "c_double", "size_t": "c_size_t", "char": "c_char"}
PYTHON = {"c_double": "float", "c_char": "bytes"}


# ---- Reading ---------------------------------------------------------------------------------------------------------
def header_text():
    """All headers, each after those it includes."""
    texts = {path.name: path.read_text(encoding="utf-8") for path in sorted(HEADERS.glob("*.h"))}
    order = []

    def take(name):
        for other in re.findall(r'^#include "(\w+\.h)"', texts[name], re.M):
            if other in texts and other not in order:
                take(other)
        if name not in order:
            order.append(name)

    for name in texts:
        take(name)
    return "\n".join(texts[name] for name in order)


def words(comment):
    """The text of a comment as one line, without the marks of the C language."""
    text = re.sub(r"^/\*|\*/$", "", comment.strip())
    text = re.sub(r"\n\s*\*?\s*", " ", text)
    text = re.sub(r"\bDMB_(?=[A-Z])", "", text)
    return " ".join(text.replace("\\", "/").split()).strip("- ")


def without_comments(text):
    return re.sub(r"/\*.*?\*/", " ", text, flags=re.S)


def class_name(c_name):
    return STRUCT_NAMES.get(c_name) or "".join(word.capitalize() for word in c_name.split("_")[1:])


def function_type(c_name):
    """dmb_path_fn -> PATH_FN"""
    return c_name[4:].upper()


class Reader:
    def __init__(self, text):
        self.text = text
        self.opaque = re.findall(r"^typedef struct (\w+) \1;", text, re.M)
        self.callbacks = re.findall(r"^typedef (\w+) \(\*(\w+)\)\(([^;]*?)\);", without_comments(text), re.M | re.S)
        self.sized = re.findall(r"^DMB_SIZED_STRUCT\((\w+)\)", text, re.M)

    def ctype(self, declaration, argument=False):
        """'const dmb_pose *pose' -> 'POINTER(Pose)'; the type of a field or an argument, its name left out."""
        declaration = " ".join(declaration.replace("const ", "").split())
        pointer_to_array = re.match(r"double \(\*\w*\)\[(\d+)\]$", declaration)
        if pointer_to_array:
            return f"POINTER(c_double * {pointer_to_array.group(1)})"
        kind, stars, array = re.match(r"(\w+) ?(\**) ?\w*((?:\[\w*\])?)$", declaration).groups()
        depth = len(stars)
        if array and argument:
            depth += 1
        if kind in self.opaque or kind == "void":
            base, depth = "c_void_p", depth - 1
        elif kind == "char" and depth:
            base, depth = "c_char_p", depth - 1
        elif kind in NUMBERS:
            base = NUMBERS[kind]
        elif any(kind == name for _, name, _ in self.callbacks):
            base = function_type(kind)
        else:
            base = class_name(kind)
        for _ in range(depth):
            base = f"POINTER({base})"
        if array and not argument:
            base = f"{base} * {array[1:-1]}"
        return base

    def arguments(self, text):
        text = " ".join(text.split())
        return [] if text in ("void", "") else [self.ctype(part.strip(), True) for part in text.split(",")]

    def signature(self, result, arguments):
        back = "None" if result == "void" else self.ctype(result + " x")
        return ", ".join([back, *self.arguments(arguments)])

    def fields(self, body):
        """[(name, ctype, unit, text)] of a struct."""
        found = []
        for match in re.finditer(r"([^;/]+);[ \t]*(/\*.*?\*/)?", body, re.S):
            declaration = " ".join(match.group(1).split())
            unit, text = unit_and_text(words(match.group(2) or ""))
            function = re.match(r"(\w+ ?\*?) ?\(\*(\w+)\)\((.*)\)$", declaration)
            if function:
                kind = f"CFUNCTYPE({self.signature(function.group(1).strip(), function.group(3))})"
                found.append((function.group(2), kind, unit, text))
                continue
            first, *rest = declaration.split(",")
            base, name, array = re.match(r"(.*?[ *])(\w+)(\[\w+\])?$", first).groups()
            parts = [name + (array or "")] + [other.strip() for other in rest]
            names = [re.match(r"\w+", part).group(0) for part in parts]
            units = units_of(names, unit)
            texts = texts_of(names, text)
            found += [(bare, self.ctype(base.strip() + " " + part), units[bare], texts[bare]) for bare, part in zip(names, parts)]
        return found

    def structs(self):
        """[(C name, [field], text)]"""
        found = []
        for match in re.finditer(r"^typedef struct (\w+) \{\n(.*?)^\} \1;", self.text, re.M | re.S):
            found.append((match.group(1), self.fields(match.group(2)), self.comment_before(match.start())))
        return found

    def comment_before(self, place):
        end = len(self.text[:place].rstrip(" "))
        begin = self.text.rfind("/*", 0, end) if self.text.endswith("*/\n", 0, end) else end
        text = words(self.text[begin:end]) if begin < end else ""
        return re.sub(r"^(---- )?[^-]*? -{5,} ?", "", text)

    def enums(self):
        """[(class name, [(member, value, text)])]; the members of one enum that begin differently are apart."""
        found = [("Status", [(name, int(value), words(text)) for name, value, text in
                             re.findall(r'^\s*X\(DMB_(\w+), (-?\d+), "(.*?)"\)', self.text, re.M)])]
        for body in re.findall(r"^enum \w*\s*\{(.*?)\};", re.sub(r"^#define.*$", "", self.text, flags=re.M),
                               re.M | re.S):
            if "DMB_STATUS_LIST" in body:
                continue
            members = [(name, int(value), words(text)) for name, value, text in
                       re.findall(r"DMB_(\w+) = (-?\d+)\s*(?:,|\Z|(?=/))[ \t]*(/\*.*?\*/)?", spread(body), re.S)]
            if len(members) != len(re.findall(r"\bDMB_\w+ =", without_comments(body))):
                raise SystemExit(f"generate.py: a constant after {members and members[0][0]} is no plain whole number")
            for group in split_by_prefix(members):
                found.append((enum_class(group[0][0], group), group))
        return found

    def users(self, name):
        """A sentence of the functions that a struct is for."""
        found = [function for function, signature, _ in self.prototypes()
                 if f"POINTER({name})" in signature and not function.endswith("_init")]
        return f"For {', '.join(found[:4])}." if found else ""

    @functools.lru_cache
    def prototypes(self):
        """[(name, signature, text)]"""
        found = []
        for match in re.finditer(r"^DMB_API\s+([^;{]*?)\(([^;{]*?)\);", self.text, re.M | re.S):
            result, name = re.match(r"(.*?[ *])(\w+)$", " ".join(match.group(1).split())).groups()
            found.append((name, self.signature(result.replace("const", "").strip(),
                                               without_comments(match.group(2))), self.comment_before(match.start())))
        for name in self.sized:
            found.append((name + "_init", f"c_int32, POINTER({class_name(name)}), c_uint32", ""))
        return found


def is_plain(name):
    return name != "struct_size" and not re.search(r"reserved\d*$", name)


def units_of(names, unit):
    """Units of the members of one declaration: "m; rad" is one for each."""
    own = [name for name in names if is_plain(name)]
    units = unit.split("; ")
    return {**dict.fromkeys(names, unit), **(dict(zip(own, units)) if len(units) == len(own) else {})}


def spread(body):
    """Constants in one line before a comment share it."""
    return re.sub(r"((?:DMB_\w+ = -?\d+,?[ \t]*){2,})(/\*.*?\*/)",
                  lambda match: re.sub(r"= -?\d+,?", lambda one: f"{one.group(0)} {match.group(2)}", match.group(1)), body, flags=re.S)


def unit_and_text(text):
    match = re.match(r"\[([^\]]*)\]\s*;?\s*(.*)$", text)
    return match.groups() if match else ("", text)


def texts_of(names, text):
    """{member: text} of members with one comment: "a; b; default 1, 2" has a text and a default for each of two members, others are
    shared."""
    shared = dict.fromkeys(names, text)
    *said, last = [part.strip() for part in text.split(";")]
    defaults = last.removeprefix("default ").split(", ") if last.startswith("default ") else []
    if not defaults:
        said.append(last)
    own = [name for name in names if is_plain(name)]
    if len(own) == 1 or len(said) != len(own) or (defaults and len(defaults) != len(own)):
        return shared
    return {**shared, **{name: f"{one}; default {defaults[i]}" if defaults else one for i, (name, one) in enumerate(zip(own, said))}}


def split_by_prefix(members):
    """X, Y, Z, RX, ... and FREE_... stand in one enum of the header."""
    groups = {}
    for member in members:
        prefix = member[0].split("_")[0] if "_" in member[0] else ""
        groups.setdefault(prefix, []).append(member)
    return list(groups.values())


def enum_class(first, members):
    prefix = first.split("_")[0]
    return ENUM_NAMES.get(first) or prefix.capitalize()


# ---- Ranges of options -------------------------------------------------------------------------------------------------
def rows(text):
    """{struct: [(field, unit, bound, arguments of the bound)]} of lists of fields in C."""
    text = re.sub(r"/\*.*?\*/", "", text.replace("\\\n", " "), flags=re.S)
    lists = {name: re.findall(r'(?:FIELD\(T, \d+, (\w+)|ARRAY\(T, \d+, (\w+), \w+, \d+), "(.*?)", (\w+)(?:\(((?:[^()]|\(.*?\))*)\))?,', body)
             for name, body in re.findall(r"#define (DMB_\w+_FIELDS)\(FIELD, ARRAY, T\)(.*?)(?=#define|\Z)", text, re.S)}
    return {struct: [(one or other, unit, bound, arguments) for one, other, unit, bound, arguments in lists[name]]
            for struct, name in re.findall(r"X\(\d+, (\w+), .*?, (DMB_\w+_FIELDS)\)", text)}


@functools.lru_cache
def constants(reader):
    """Constants of the headers and of lib/fields/bounds.h by name."""
    known = {"UINT32_MAX": 0xFFFFFFFF}
    known.update({"DMB_" + name: value for _, members in reader.enums() for name, value, _ in members})
    text = (LISTS / "bounds.h").read_text(encoding="utf-8")
    shared = {name: float(value.strip("()")) for name, value in re.findall(r"^#define (DMB_NOT_GIVEN|DMB_UNLIMITED) (\S+)", reader.text, re.M)}
    known.update(shared)
    known.update({name: shared[value] if value in shared else float(value)
                  for name, value in re.findall(r"^#define (DMB_\w+) (\S+)", text, re.M)})
    known.update({name: int(value) for name, value in re.findall(r"^    (DMB_\w+) = (\d+)", text, re.M)})
    return known


@functools.lru_cache
def options(reader):
    """{struct: {field: (bound, low, high)}} of the structs of options."""
    known = constants(reader)
    ranges = {}
    for struct, fields in rows((LISTS / "options.h").read_text(encoding="utf-8")).items():
        ends = {field: (bound.lower(), *(float(eval(one, {}, known)) for one in arguments.split(",")))
                for field, _, bound, arguments in fields if bound != "ANY"}
        ranges[struct] = {field: one if len(one) == 3 else (*one, math.inf) for field, one in ends.items()}
    return ranges


# ---- Methods that take the fields of a struct ------------------------------------------------------------------------
# Kinds of parts that have a type of id of their own for type checkers; when a program runs each is Id.
ID_KINDS = ("TimeFunction", "Wall", "String", "Body", "Bit", "Stabiliser", "Joint", "Coupling", "Constraint", "Drive", "Load", "Spring",
            "Stuck", "Force", "Input", "Event")
PLACES = "excitations: Sequence[Excitation], outputs: Sequence[Any]"
# class: {method: (struct, parameters before and after that of the struct, result)}
TYPED = {
    "ModelCalls": {
        "set_environment": ("EnvironmentDef", "", "", "None"),
        **{f"add_{kind}": (f"{kind.capitalize()}Def", "", "", f"{kind.capitalize()}Id") for kind in (
            "wall", "string", "body", "bit", "stabiliser", "joint", "coupling", "constraint", "drive", "load", "input", "spring", "stuck",
            "event", "force")},
        "add_pipes": ("PipeDef", "count: int = 1, ", "", "StringId"),
        "compile": ("CompileOptions", "", "", "int"),
        "sim_memory_size": ("SimOptions", "", "", "int"),
        "sim": ("SimOptions", "", "log: Callable[[int, str], None] | None = None, ", "Sim")},
    "AnalysisCalls": {
        "static": ("StaticOptions", "", "", "StaticReport"),
        "buckling": ("BucklingOptions", "", "", "Buckling"),
        "path": ("PathOptions", "visit: Callable[[Sim, PathPoint], Any] | None = None, ", "", "PathReport"),
        "response": ("ResponseOptions", PLACES + ", ", "frequencies: Any = None, ", "Response"),
        "stepped_sine": ("SteppedSineOptions", "frequency: float, outputs: Sequence[Any], ", "", "tuple[Any, Any]"),
        "modes": ("ModesOptions", "", "", "Modes"),
        "speeds": ("SpeedsOptions", "orders: Sequence[Order], outputs: Sequence[Any], limits: Sequence[float], room: int = 64, ", "",
                   "tuple[SpeedBands, list[float]]"),
        "torque_drag": ("TorqueDragOptions", "operations: Any = None, depths: Sequence[float] | None = None, ", "", "TorqueDrag"),
        "torque_drag_profile": ("TorqueDragOptions", "operation: Operation | int, stations: int = 101, ", "", "Columns"),
        "friction_factor": ("TorqueDragOptions", "operation: Operation | int, hook_load: float | None = None, torque: float | None = None, ", "",
                            "float")}}


def typed_lines(reader, name, calls):
    """The class with the signatures of the methods. Keywords are the fields of the struct, and of its class in _record.py."""
    structs = {class_name(c_name): fields for c_name, fields, _ in reader.structs()}
    yield f"class {name}:"
    yield '    """Signatures only: the methods themselves stand in the class that has this as its base for type checkers."""'
    for method, (struct, before, after, result) in calls.items():
        word = "options" if struct.endswith("Options") else "definition"
        own = before + after
        keys = [f"{key}: Any = ..." for key in MORE_KEYS.get(struct, ())]
        keys += [f"{field}: {given_type(kind)} = ..." for field, kind, _, _ in structs[struct]
                 if is_plain(field) and f"{field}:" not in own]
        given = f"{before}{word}: {struct} | None = None, {after}*, {', '.join(keys)}"
        yield f"    def {method}(self, {given}) -> {result}: ..."
    yield ""
    yield ""


def typed_text(reader):
    """The module of signatures. It is read by type checkers alone."""
    lines = MADE.format("Methods that take the fields of a struct as keywords, as type checkers see them.").splitlines()
    lines += ["# mypy: disable-error-code=\"empty-body\"", "from __future__ import annotations", "",
              "from collections.abc import Callable, Iterable, Sequence", "from typing import Any, SupportsFloat", "",
              "from ._structs import *  # noqa: F401,F403", "from .analysis import Buckling, Modes, Response, TorqueDrag",
              "from .frames import Columns, SpeedBands", "from .sim import Sim", "", ""]
    for name, calls in TYPED.items():
        lines += typed_lines(reader, name, calls)
    return lines[:-2]


# ---- Writing ---------------------------------------------------------------------------------------------------------
def quoted(text):
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


def enum_lines(name, members):
    prefix = members[0][0].split("_")[0] + "_" if "_" in members[0][0] else ""
    kind = "IntFlag" if prefix[:-1] in FLAGS else "IntEnum"
    if name == "Status":
        prefix = ""
    yield f"class {name}({kind}):"
    shorts = [short if not short[0].isdigit() else "_" + short for short in (member[len(prefix):] for member, _, _ in members)]
    told = [f"    {short}: {text}" for short, (_, _, text) in zip(shorts, members) if text]
    yield f'    """{"Bits" if kind == "IntFlag" else "Values"} DMB_{prefix}... of the headers.' + ('' if told else '"""')
    if told:
        yield from ["", *(line.replace('"', "'") for line in told), '    """']
    for short, (_, value, _) in zip(shorts, members):
        yield f"    {short} = {value}"
    yield ""
    yield ""
    for short, (member, _, _) in zip(shorts, members):
        yield f"{member} = {name}.{short}"
    yield ""
    yield ""


def python_type(kind):
    array = re.match(r"(\w+) \* (\d+)$", kind)
    if array:
        return "bytes" if array.group(1) == "c_char" else "Any" if array.group(1) == "c_double" else f"'Array[{array.group(1)}]'"
    if kind in PYTHON:
        return PYTHON[kind]
    if kind.startswith(("c_int", "c_uint", "c_size")):
        return "int"
    return kind if re.match(r"[A-Z][a-z]\w*$", kind) else "Any"


# What the classes of _record.py take besides fields, and the fields that it stands for.
MORE_KEYS = {"Segment": ("table", "function"), "WallDef": ("stations", "friction_table"), "SpringDef": ("table",), "Motor": ("table",),
             "DriveDef": ("curve", "gain_table"), "ForceDef": ("places", "function"), "ConstraintDef": ("places", "function")}


def given_type(kind):
    """The type of what may be given for a field: more than what is read from it."""
    if re.match(r"c_char \*", kind):
        return "str | bytes"
    if re.match(r"c_double \*", kind):
        return "Iterable[float]"
    if re.match(r"\w+ \*", kind):
        return "Iterable[Any]"
    return {"Place": "Place | Id | None", "Id": "Id | None", "Output": "Output | tuple[Any, Any]",
            "c_double": "SupportsFloat"}.get(kind, python_type(kind).replace("'", ""))


def constructor_lines(name, fields):
    """The constructor as type checkers and editors see it: misspelt fields and texts for numbers are found there."""
    keys = [f"{key}: Any = ..." for key in MORE_KEYS.get(name, ())]
    keys += ["*"] + [f"{field}: {given_type(kind)} = ..." for field, kind, _, _ in fields
                     if is_plain(field)]
    if keys[-1] == "*":
        keys.pop()
    yield "    if TYPE_CHECKING:"
    yield f"        def __init__(self, {', '.join(keys)}) -> None: ..."


def struct_lines(reader, c_name, fields, text):
    name = class_name(c_name)
    bases = ([MIXINS[name]] if name in MIXINS else []) + ["Sized" if c_name in reader.sized else "Record"]
    yield f"class {name}({', '.join(bases)}):"
    shown = [field for field in fields if is_plain(field[0])]
    yield f"    c_name, about = {quoted(c_name)}, {quoted(text if len(text.split()) > 2 else reader.users(name))}"
    for field, kind, _, _ in fields:
        yield f"    {field}: {python_type(kind)}"
    if c_name in reader.sized:
        yield from constructor_lines(name, fields)
    yield "    _fields_: ClassVar[Any] = ["
    for field, kind, _, _ in fields:
        yield f"        ({quoted(field)}, {kind}),"
    yield "    ]"
    yield "    field_docs = {"
    for field, _, unit, meaning in shown:
        yield f"        {quoted(field)}: ({quoted(unit)}, {quoted(meaning)}),"
    yield "    }"
    if c_name in options(reader):
        yield "    bounds = {"
        yield from (f'        "{field}": ("{bound}", {low:.10g}, {high:.10g}),' for field, (bound, low, high) in options(reader)[c_name].items())
        yield "    }"
    yield ""
    yield ""


MADE = '"""{} Made from the headers by generate.py: do not edit, run that instead."""\n'
STRUCTS_HEAD = MADE.format("The structs and types of callbacks of the C interface.") + '''# mypy: disable-error-code="misc"
from __future__ import annotations

from collections.abc import Iterable
from ctypes import (CFUNCTYPE, POINTER, Array, c_char, c_char_p, c_double, c_int32, c_int64, c_size_t, c_uint32, c_uint64,
                    c_void_p)
from math import inf
from typing import TYPE_CHECKING, Any, ClassVar, SupportsFloat

from ._record import (ConstraintPart, DrivePart, ForcePart, IdPart, MotorPart, Record, Sized, SpringPart, SegmentPart, WallPart,
                      read_as_numpy)

'''
FUNCTIONS_HEAD = MADE.format("The functions of the C interface.") + '''from __future__ import annotations

import ctypes
from ctypes import POINTER, c_char_p, c_double, c_int32, c_int64, c_size_t, c_uint32, c_uint64, c_void_p  # noqa: F401
from typing import Any

from ._structs import *  # noqa: F403

'''


def order_items(reader):
    """Structs and types of callbacks, each after what it names."""
    items = [("struct", s[0], s, {m for f in s[1] for m in re.findall(r"[A-Za-z_]\w*", f[1])})
             for s in reader.structs()]
    items += [("callback", name, (result, name, arguments),
               set(re.findall(r"[A-Za-z_]\w*", reader.signature(result, arguments))))
              for result, name, arguments in reader.callbacks]
    python = {name: class_name(name) if kind == "struct" else function_type(name) for kind, name, _, _ in items}
    known, waiting = set(), items
    while waiting:
        ready = [item for item in waiting if not (item[3] & set(python.values())) - known]
        if not ready:
            sys.exit(f"generate: {[item[1] for item in waiting]} name each other")
        yield from ready
        known |= {python[item[1]] for item in ready}
        waiting = [item for item in waiting if item not in ready]


def enums_text(reader):
    version = [re.search(rf"^#define DMB_VERSION_{part} (\d+)", reader.text, re.M).group(1)
               for part in ("MAJOR", "MINOR", "PATCH")]
    lines = [MADE.format("The constants of the C interface as enumerations, and its version."),
             "from enum import IntEnum, IntFlag",
             "", f"VERSION = ({', '.join(version)})", f'__version__ = "{".".join(version)}"', "", ""]
    enums = reader.enums()
    for name, members in enums:
        lines += enum_lines(name, members)
    lines += [f"{name} = 0xFFFFFFFF" for name in re.findall(r"^#define DMB_(\w+) UINT32_MAX", reader.text, re.M)]
    lines += [f"{name} = {value.strip('()')}" for name, value in re.findall(r"^#define DMB_(NOT_GIVEN|UNLIMITED) (\S+)", reader.text, re.M)]
    lines += ["", "ENUMS = ("] + [f"    {name}," for name, _ in enums] + [")"]
    return lines + ["", "for _enum in ENUMS:  # help(drillmbd.PIPE_RIGID) tells its own line",
                    '    for _line in (_enum.__doc__ or "").splitlines()[2:-1]:',
                    '        _name, _text = _line.strip().split(": ", 1)',
                    "        _enum[_name].__doc__ = _text"]


def structs_text(reader):
    lines = STRUCTS_HEAD.splitlines() + [""]
    for kind, _, content, _ in order_items(reader):
        if kind == "struct":
            lines += struct_lines(reader, *content)
            if content[0] == "dmb_id":
                lines += ["if TYPE_CHECKING:  # ids of different kinds are different types for a type checker",
                          *(f"    class {one}Id(Id): ..." for one in ID_KINDS), "else:",
                          *(f"    {one}Id = Id" for one in ID_KINDS), "", ""]
        else:
            name, place = function_type(content[1]), re.search(rf"^typedef \w+ \(\*{content[1]}\)", reader.text, re.M).start()
            lines += [f"{name} = CFUNCTYPE({reader.signature(content[0], content[2])})",
                      f"{name}.__doc__ = {quoted(reader.comment_before(place) or f'The function {content[1]} of the headers.')}",
                      "", ""]
    lines.append("STRUCTS: dict[str, Any] = {}  # name in C -> class")
    lines += [f"STRUCTS[{quoted(name)}] = {class_name(name)}" for name, _, _ in reader.structs()]
    return lines + ["", "for _cls in STRUCTS.values():", "    read_as_numpy(_cls)", "del _cls"]


def functions_text(reader):
    prototypes = sorted(reader.prototypes())
    lines = FUNCTIONS_HEAD.splitlines() + ["# name: (result, arguments...)", "PROTOTYPES: dict[str, tuple[Any, ...]] = {"]
    lines += [f"    {quoted(name)}: ({signature},)," for name, signature, _ in prototypes]
    lines += ["}", "", "FUNCTION_DOCS = {"]
    lines += [f"    {quoted(name)}:\n        {quoted(text)}," for name, _, text in prototypes if text]
    return lines + ["}", "", "", "def declare(library: ctypes.CDLL) -> None:",
                    '    """Tells ctypes the types of all functions."""',
                    "    for name, (result, *arguments) in PROTOTYPES.items():",
                    "        function = getattr(library, name)",
                    "        function.restype, function.argtypes = result, arguments"]


def generated():
    """{path: text}"""
    reader = Reader(header_text())
    made = {"enums.py": enums_text, "_structs.py": structs_text, "_functions.py": functions_text, "_typed.py": typed_text}
    return {PACKAGE / name: re.sub(r"\n{4,}", "\n\n\n", "\n".join(lines(reader)) + "\n")
            for name, lines in made.items()}


def main():
    texts = generated()
    if sys.argv[1:] == ["--check"]:
        old = [path.name for path, text in texts.items()
               if not path.exists() or path.read_text(encoding="utf-8") != text]
        if old:
            print(f"{', '.join(old)}: not what the headers say; run bindings/python/generate.py")
        return 1 if old else 0
    if sys.argv[1:]:
        print(__doc__)
        return 2
    for path, text in texts.items():
        path.write_text(text, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
