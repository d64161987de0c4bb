"""The structs and types of callbacks of the C interface. Made from the headers by generate.py: do not edit, run that instead."""
# mypy: disable-error-code="misc"
from __future__ import annotations

from collections.abc import Iterable
from ctypes import (CFUNCTYPE, POINTER, Array, c_char, c_char_p, c_double, c_int32, c_int64, c_size_t, c_uint32, c_uint64,
                    c_void_p)
from math import inf
from typing import TYPE_CHECKING, Any, ClassVar, SupportsFloat

from ._record import (ConstraintPart, DrivePart, ForcePart, IdPart, MotorPart, Record, Sized, SpringPart, SegmentPart, WallPart,
                      read_as_numpy)


class Id(IdPart, Record):
    c_name, about = "dmb_id", "Frozen. Given out by the dmb_model_add_ functions and checked at every use: kind, index and model. {0, 0} names nothing."
    index: int
    generation: int
    _fields_: ClassVar[Any] = [
        ("index", c_uint32),
        ("generation", c_uint32),
    ]
    field_docs = {
        "index": ("-", "kind in the upper 8 bits, number of the part within its kind in the lower 24"),
        "generation": ("-", "stamp of the model that gave it out; 0 only in the id that names nothing"),
    }


if TYPE_CHECKING:  # ids of different kinds are different types for a type checker
    class TimeFunctionId(Id): ...
    class WallId(Id): ...
    class StringId(Id): ...
    class BodyId(Id): ...
    class BitId(Id): ...
    class StabiliserId(Id): ...
    class JointId(Id): ...
    class CouplingId(Id): ...
    class ConstraintId(Id): ...
    class DriveId(Id): ...
    class LoadId(Id): ...
    class SpringId(Id): ...
    class StuckId(Id): ...
    class ForceId(Id): ...
    class InputId(Id): ...
    class EventId(Id): ...
else:
    TimeFunctionId = Id
    WallId = Id
    StringId = Id
    BodyId = Id
    BitId = Id
    StabiliserId = Id
    JointId = Id
    CouplingId = Id
    ConstraintId = Id
    DriveId = Id
    LoadId = Id
    SpringId = Id
    StuckId = Id
    ForceId = Id
    InputId = Id
    EventId = Id


class Allocator(Sized):
    c_name, about = "dmb_allocator", "Memory and log"
    struct_size: int
    reserved: int
    context: Any
    allocate: Any
    release: Any
    if TYPE_CHECKING:
        def __init__(self, *, context: Any = ..., allocate: Any = ..., release: Any = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("reserved", c_uint32),
        ("context", c_void_p),
        ("allocate", CFUNCTYPE(c_void_p, c_void_p, c_size_t, c_size_t)),
        ("release", CFUNCTYPE(None, c_void_p, c_void_p, c_size_t, c_size_t)),
    ]
    field_docs = {
        "context": ("", "handed to both functions"),
        "allocate": ("byte", "NULL on failure"),
        "release": ("", "a block of allocate, same sizes"),
    }


class ErrorStruct(Sized):
    c_name, about = "dmb_error", "dmb_last_error gives the last call of this thread that failed, on any object; a call that succeeds leaves it unchanged. dmb_model_message and dmb_sim_message give the message alone."
    struct_size: int
    status: int
    number: int
    component: int
    value: float
    low: float
    high: float
    part: bytes
    kind: bytes
    name: bytes
    field: bytes
    given: bytes
    bound: bytes
    advice: bytes
    message: bytes
    if TYPE_CHECKING:
        def __init__(self, *, status: int = ..., number: int = ..., component: int = ..., value: SupportsFloat = ..., low: SupportsFloat = ..., high: SupportsFloat = ..., part: str | bytes = ..., kind: str | bytes = ..., name: str | bytes = ..., field: str | bytes = ..., given: str | bytes = ..., bound: str | bytes = ..., advice: str | bytes = ..., message: str | bytes = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("status", c_int32),
        ("number", c_uint32),
        ("component", c_uint32),
        ("value", c_double),
        ("low", c_double),
        ("high", c_double),
        ("part", c_char * 128),
        ("kind", c_char * 32),
        ("name", c_char * 24),
        ("field", c_char * 64),
        ("given", c_char * 96),
        ("bound", c_char * 256),
        ("advice", c_char * 384),
        ("message", c_char * 512),
    ]
    field_docs = {
        "status": ("", "ERR_...; 0: no call of this thread has failed"),
        "number": ("-", "number of the part in its kind"),
        "component": ("-", "index in an array field (NONE: there is none)"),
        "value": ("unit of the field", "refused value and its range; NaN: no number, no range"),
        "low": ("unit of the field", "refused value and its range; NaN: no number, no range"),
        "high": ("unit of the field", "refused value and its range; NaN: no number, no range"),
        "part": ("", "\"string 0 (main), pipe 12 (collars)\", as in the message. All texts end with 0; \"\": there is none"),
        "kind": ("", "\"pipe\", \"collars\": of the innermost part"),
        "name": ("", "\"pipe\", \"collars\": of the innermost part"),
        "field": ("", "\"outer_diameter\""),
        "given": ("", "the value as text: \"0.07\", \"(1, 2, 3)\""),
        "bound": ("", "\"be finite and > inner_diameter (0.08)\"; a bound after > or < is not in the range"),
        "advice": ("", "the remedy"),
        "message": ("", "all of it in one sentence"),
    }


class EnvironmentDef(Sized):
    c_name, about = "dmb_environment_def", "For dmb_model_set_environment."
    struct_size: int
    reserved: int
    gravity: Any
    fluid_density: float
    lateral_damping: float
    axial_damping: float
    torsional_damping: float
    inner_density: float
    added_mass: float
    flow_rate: float
    consistency: float
    flow_exponent: float
    yield_stress: float
    nozzle_area: float
    flow_eccentricity: float
    if TYPE_CHECKING:
        def __init__(self, *, gravity: Iterable[float] = ..., fluid_density: SupportsFloat = ..., lateral_damping: SupportsFloat = ..., axial_damping: SupportsFloat = ..., torsional_damping: SupportsFloat = ..., inner_density: SupportsFloat = ..., added_mass: SupportsFloat = ..., flow_rate: SupportsFloat = ..., consistency: SupportsFloat = ..., flow_exponent: SupportsFloat = ..., yield_stress: SupportsFloat = ..., nozzle_area: SupportsFloat = ..., flow_eccentricity: SupportsFloat = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("reserved", c_uint32),
        ("gravity", c_double * 3),
        ("fluid_density", c_double),
        ("lateral_damping", c_double),
        ("axial_damping", c_double),
        ("torsional_damping", c_double),
        ("inner_density", c_double),
        ("added_mass", c_double),
        ("flow_rate", c_double),
        ("consistency", c_double),
        ("flow_exponent", c_double),
        ("yield_stress", c_double),
        ("nozzle_area", c_double),
        ("flow_eccentricity", c_double),
    ]
    field_docs = {
        "gravity": ("m/s2", "world frame, default (0, 0, -9.81)"),
        "fluid_density": ("kg/m3", "inside and outside of pipes and tool joints, for buoyancy; default 0"),
        "lateral_damping": ("N s/m2", "external, per metre of pipe, against speed sideways, along; default 0"),
        "axial_damping": ("N s/m2", "external, per metre of pipe, against speed sideways, along; default 0"),
        "torsional_damping": ("N s", "external moment per metre of pipe and rad/s of spin; default 0"),
        "inner_density": ("kg/m3", "inside, fluid_density is that outside then; 0 .. ; NOT_GIVEN (default): as outside"),
        "added_mass": ("-", "of the mud outside pipes over the displaced mass (1: far from any wall), >= 0; NOT_GIVEN: (D^2 + d^2)/(D^2 - d^2) of each pipe in the wall's `diameter` (Fritz 1972). Where it is not 0 the mud inside moves, too, and tool joints are spread over their pipe; stabilisers: of the mud they displace beyond the pipe. 0 (default): no inertia"),
        "flow_rate": ("m3/s", "of mud down the string, the only one of the model, which follows its hole, and back in a concentric annulus with the diameters at the depth where the string is described. Gives drag, pressures and thrust of the nozzles (dmb_query_flow), no lateral inertia. 0 (default): mud at rest"),
        "consistency": ("Pa s", "K: shear stress = yield_stress + K (shear rate)^n; > 0 with a flow_rate; default 0"),
        "flow_exponent": ("-", "n, 0.2 .. 1; 1 (default): Newtonian, Bingham's fluid with a yield_stress"),
        "yield_stress": ("Pa", "of the mud, >= 0; 0 (default): power law; with flow_eccentricity = 0 only"),
        "nozzle_area": ("m2", "of the bit in all; 0 (default): the last pipe is open"),
        "flow_eccentricity": ("-", "of the annulus, everywhere: distance of the axes over half the difference of diameters, 0 (default) .. 0.95; > 0 with flow_exponent >= 0.4 and pipes of 0.3 .. 0.9 hole diameters. For pressures and drag"),
    }


class LawMemory(Record):
    c_name, about = "dmb_law_memory", "Frozen. State of a caller's law: hysteresis, bristles, a delay. The sim keeps it with the motion, in snapshots, hashes and transfers, and drops that of rejected steps; it begins at 0. The law computes `trial` from `accepted`, the motion and `step` alone, and its tangent with the state eliminated: dF/dx + dF/dz dz/dx."
    accepted: Any
    trial: Any
    step: float
    _fields_: ClassVar[Any] = [
        ("accepted", POINTER(c_double)),
        ("trial", POINTER(c_double)),
        ("step", c_double),
    ]
    field_docs = {
        "accepted": ("", "at the last accepted time, shape (state_count)"),
        "trial": ("", "at `time`, written, shape (state_count); `accepted` when called"),
        "step": ("s", "between them. 0: no time passes, as in statics, where the state follows the path of load steps, and after jumps: the accepted motion must give `accepted`. Linear analyses read damping and stiffness from short steps: use the trapezoidal rule for rates"),
    }


class FrictionAt(Record):
    c_name, about = "dmb_friction_at", "Frozen. Arguments of a friction law of the caller; components along the hole and around it."
    normal_force: float
    slip: Any
    slip_before: Any
    mu_static: float
    mu_dynamic: float
    _fields_: ClassVar[Any] = [
        ("normal_force", c_double),
        ("slip", c_double * 2),
        ("slip_before", c_double * 2),
        ("mu_static", c_double),
        ("mu_dynamic", c_double),
    ]
    field_docs = {
        "normal_force": ("N", ">= 0"),
        "slip": ("m/s", "of the pipe over the wall"),
        "slip_before": ("m/s", "at the last accepted time"),
        "mu_static": ("-", "of the wall or section, times inputs (a law need not use them)"),
        "mu_dynamic": ("-", "of the wall or section, times inputs (a law need not use them)"),
    }


class HoleSection(Sized):
    c_name, about = "dmb_hole_section", "A section of the hole: cased, open, washed out, coal, rock. Above the first one the values of dmb_wall_def hold; a field left at NOT_GIVEN is that of dmb_wall_def, as are the laws and all other values everywhere. Values change smoothly within `transition` (eq:hole.section): where its diameter changes the wall pushes along the axis, so that no energy is made."
    struct_size: int
    shape: int
    depth: float
    transition: float
    diameter: float
    stiffness: float
    restitution: float
    damping: float
    mu_static: float
    mu_dynamic: float
    strength: float
    name: bytes
    if TYPE_CHECKING:
        def __init__(self, *, shape: int = ..., depth: SupportsFloat = ..., transition: SupportsFloat = ..., diameter: SupportsFloat = ..., stiffness: SupportsFloat = ..., restitution: SupportsFloat = ..., damping: SupportsFloat = ..., mu_static: SupportsFloat = ..., mu_dynamic: SupportsFloat = ..., strength: SupportsFloat = ..., name: str | bytes = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("shape", c_int32),
        ("depth", c_double),
        ("transition", c_double),
        ("diameter", c_double),
        ("stiffness", c_double),
        ("restitution", c_double),
        ("damping", c_double),
        ("mu_static", c_double),
        ("mu_dynamic", c_double),
        ("strength", c_double),
        ("name", c_char * 24),
    ]
    field_docs = {
        "shape": ("", "HOLE_...; default HOLE_STEP; the last one must be a step"),
        "depth": ("m", "measured depth where it begins; strictly increasing; default 0"),
        "transition": ("m", "> 0; neighbours may not overlap, nor the radius change by more than 1 m/m; default 0.1"),
        "diameter": ("m", "> 0; default NOT_GIVEN"),
        "stiffness": ("N/m^(n+1)", "K per metre of pipe, > 0; default NOT_GIVEN"),
        "restitution": ("-", "0 .. 1 (> 0 for FLORES); default NOT_GIVEN"),
        "damping": ("N s/m2", "c per metre of pipe, of KELVIN_VOIGT and IMPACT, >= 0; default NOT_GIVEN"),
        "mu_static": ("-", ">= 0, mu_static >= mu_dynamic for STRIBECK and BRISTLE; default NOT_GIVEN"),
        "mu_dynamic": ("-", ">= 0, mu_static >= mu_dynamic for STRIBECK and BRISTLE; default NOT_GIVEN"),
        "strength": ("Pa", "unconfined compressive strength, >= 0, for dmb_query_hole; no force depends on it; default 0"),
        "name": ("", "returned by dmb_query_hole; default \"\""),
    }


class StringDef(Sized):
    c_name, about = "dmb_string_def", "Strings and pipes"
    struct_size: int
    follows_hole: int
    start_depth: float
    offset: Any
    position: Any
    rotation: Any
    velocity: Any
    start_free: int
    end_free: int
    name: bytes
    if TYPE_CHECKING:
        def __init__(self, *, follows_hole: int = ..., start_depth: SupportsFloat = ..., offset: Iterable[float] = ..., position: Iterable[float] = ..., rotation: Iterable[float] = ..., velocity: Iterable[float] = ..., start_free: int = ..., end_free: int = ..., name: str | bytes = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("follows_hole", c_int32),
        ("start_depth", c_double),
        ("offset", c_double * 2),
        ("position", c_double * 3),
        ("rotation", c_double * 3),
        ("velocity", c_double * 6),
        ("start_free", c_int32),
        ("end_free", c_int32),
        ("name", c_char * 24),
    ]
    field_docs = {
        "follows_hole": ("", "1: starts on the hole's axis at start_depth; 0: straight from `position`. default 1"),
        "start_depth": ("m", "measured depth of the rig end; default 0"),
        "offset": ("m", "sideways shift from the hole's axis along its y and z axes; default 0"),
        "position": ("m", "rig end (world, if follows_hole is 0 or there is no hole)"),
        "rotation": ("rad", "its rotation vector"),
        "velocity": ("m/s, rad/s", "of the string as one rigid body, rig end, body frame, at time 0"),
        "start_free": ("-", "sets of free components at the rig end, the far end: with X in both and no drive along it the string slides, and a load on its bit pushes it out of the hole; default FREE_CYLINDRICAL, FREE_ALL"),
        "end_free": ("-", "sets of free components at the rig end, the far end: with X in both and no drive along it the string slides, and a load on its bit pushes it out of the hole; default FREE_CYLINDRICAL, FREE_ALL"),
        "name": ("", "for messages and look-up, ends with 0; default \"\""),
    }


class Motor(MotorPart, Sized):
    c_name, about = "dmb_motor", "A mud motor between two sections of a string is a drive on a revolute joint between them (place_a at the far end of the section above, place_b at the rig end of the one below). Its torque T of the relative speed w is a line to w0 = 2 pi flow/displacement (eq:drive.motor), or a table as measured at table_flow and table_pressure, scaled by flow and pressure; w0 is its last speed. Below w = 0 it gives its torque at stall."
    struct_size: int
    brakes: int
    stall_torque: float
    displacement: float
    flow: float
    pressure: float
    efficiency: float
    table_flow: float
    table_pressure: float
    table_count: int
    reserved: int
    table_speed: Any
    table_torque: Any
    if TYPE_CHECKING:
        def __init__(self, table: Any = ..., *, brakes: int = ..., stall_torque: SupportsFloat = ..., displacement: SupportsFloat = ..., flow: SupportsFloat = ..., pressure: SupportsFloat = ..., efficiency: SupportsFloat = ..., table_flow: SupportsFloat = ..., table_pressure: SupportsFloat = ..., table_count: int = ..., table_speed: Iterable[float] = ..., table_torque: Iterable[float] = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("brakes", c_int32),
        ("stall_torque", c_double),
        ("displacement", c_double),
        ("flow", c_double),
        ("pressure", c_double),
        ("efficiency", c_double),
        ("table_flow", c_double),
        ("table_pressure", c_double),
        ("table_count", c_uint32),
        ("reserved", c_uint32),
        ("table_speed", c_double * 15),
        ("table_torque", c_double * 15),
    ]
    field_docs = {
        "brakes": ("", "1: beyond w0 it holds back along the same line, as a pump; 0 (default): it runs free there"),
        "stall_torque": ("N m", "at w = 0, the largest, > 0"),
        "displacement": ("m3", "volume of mud per revolution, > 0"),
        "flow": ("m3/s", "through the motor, > 0"),
        "pressure": ("Pa", "drop across it at stall, > 0 in place of stall_torque; with a table > 0, or 0: table_pressure"),
        "efficiency": ("-", "of pressure to torque, > 0, <= 1; default 1; of a line by pressure only"),
        "table_flow": ("m3/s", "of the table: > 0, or 0 (default): flow"),
        "table_pressure": ("Pa", "> 0 with a pressure, else >= 0"),
        "table_count": ("-", "0 (default): a line; 2 .. 15: a table, without stall_torque and displacement"),
        "table_speed": ("rad/s", "strictly increasing from 0, shape (table_count)"),
        "table_torque": ("N m", ">= 0, > 0 at the first, 0 at the last, shape (table_count)"),
    }


class CompileOptions(Sized):
    c_name, about = "dmb_compile_options", "For dmb_model_compile."
    struct_size: int
    features: int
    pipe_kind: int
    reserved: int
    if TYPE_CHECKING:
        def __init__(self, *, features: int = ..., pipe_kind: int = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("features", c_int32),
        ("pipe_kind", c_int32),
        ("reserved", c_int32),
    ]
    field_docs = {
        "features": ("", "mask of FEATURE_...; others are not compiled; default FEATURE_ALL"),
        "pipe_kind": ("", "PIPE_... for every pipe, or NOT_GIVEN (default): as described"),
    }


class ModelInfo(Sized):
    c_name, about = "dmb_model_info", "For dmb_model_get_info."
    struct_size: int
    strings: int
    pipes: int
    rigid_bodies: int
    nodes: int
    elements: int
    contact_points: int
    degrees_of_freedom: int
    prescribed: int
    structural_joints: int
    model_bytes: int
    sim_bytes: int
    mass: float
    length: float
    joints: int
    constraint_rows: int
    clusters: int
    reduced_nodes: int
    if TYPE_CHECKING:
        def __init__(self, *, strings: int = ..., pipes: int = ..., rigid_bodies: int = ..., nodes: int = ..., elements: int = ..., contact_points: int = ..., degrees_of_freedom: int = ..., prescribed: int = ..., structural_joints: int = ..., model_bytes: int = ..., sim_bytes: int = ..., mass: SupportsFloat = ..., length: SupportsFloat = ..., joints: int = ..., constraint_rows: int = ..., clusters: int = ..., reduced_nodes: int = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("strings", c_uint32),
        ("pipes", c_uint32),
        ("rigid_bodies", c_uint32),
        ("nodes", c_uint32),
        ("elements", c_uint32),
        ("contact_points", c_uint32),
        ("degrees_of_freedom", c_uint32),
        ("prescribed", c_uint32),
        ("structural_joints", c_uint32),
        ("model_bytes", c_uint64),
        ("sim_bytes", c_uint64),
        ("mass", c_double),
        ("length", c_double),
        ("joints", c_uint32),
        ("constraint_rows", c_uint32),
        ("clusters", c_uint32),
        ("reduced_nodes", c_uint32),
    ]
    field_docs = {
        "strings": ("-", "as described"),
        "pipes": ("-", "as described"),
        "rigid_bodies": ("-", "merged ones count once"),
        "nodes": ("-", "nodes"),
        "elements": ("-", "flexible and axial-torsional elements"),
        "contact_points": ("-", "contact points"),
        "degrees_of_freedom": ("-", "free velocity components, prescribed ones not counted"),
        "prescribed": ("-", "components moved by drives"),
        "structural_joints": ("-", "fixed joints that cost no unknowns"),
        "model_bytes": ("byte", "held by the compiled scene"),
        "sim_bytes": ("byte", "of one sim with default options"),
        "mass": ("kg", "of all parts"),
        "length": ("m", "of all strings"),
        "joints": ("-", "described"),
        "constraint_rows": ("-", "equations of joints, couplings, callbacks and joint drives at time 0"),
        "clusters": ("-", "groups of parts that joints connect directly"),
        "reduced_nodes": ("-", "nodes solved by the sparse solver, the others by the block-tridiagonal one"),
    }


class StepReport(Sized):
    c_name, about = "dmb_step_report", "For dmb_sim_step, dmb_sim_steps, dmb_sim_advance, dmb_sim_advance_to_event."
    struct_size: int
    steps: int
    iterations: int
    rejected: int
    most_iterations: int
    reserved: int
    time: float
    residual: float
    last_step: float
    if TYPE_CHECKING:
        def __init__(self, *, steps: int = ..., iterations: int = ..., rejected: int = ..., most_iterations: int = ..., time: SupportsFloat = ..., residual: SupportsFloat = ..., last_step: SupportsFloat = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("steps", c_uint32),
        ("iterations", c_uint32),
        ("rejected", c_uint32),
        ("most_iterations", c_uint32),
        ("reserved", c_uint32),
        ("time", c_double),
        ("residual", c_double),
        ("last_step", c_double),
    ]
    field_docs = {
        "steps": ("-", "accepted integration steps in this call"),
        "iterations": ("-", "Newton iterations, rejected steps included"),
        "rejected": ("-", "steps tried and not accepted"),
        "most_iterations": ("-", "of an accepted step"),
        "time": ("s", "reached"),
        "residual": ("-", "largest relative residual of an accepted step"),
        "last_step": ("s", "length of the last accepted step"),
    }


class InputState(Sized):
    c_name, about = "dmb_input_state", "For dmb_sim_get_input."
    struct_size: int
    is_set: int
    value: float
    present: float
    rate: float
    arrives: float
    if TYPE_CHECKING:
        def __init__(self, *, is_set: int = ..., value: SupportsFloat = ..., present: SupportsFloat = ..., rate: SupportsFloat = ..., arrives: SupportsFloat = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("is_set", c_int32),
        ("value", c_double),
        ("present", c_double),
        ("rate", c_double),
        ("arrives", c_double),
    ]
    field_docs = {
        "is_set": ("", "0: its time function is in force, since it was not set yet"),
        "value": ("unit", "set point; of a time function its value now"),
        "present": ("unit", "in force now, changing towards `value`"),
        "rate": ("unit/s", "in force now, changing towards `value`"),
        "arrives": ("s", "time at which `present` reaches or reached `value`; 0 with a time function"),
    }


class InputRecord(Record):
    c_name, about = "dmb_input_record", "Frozen. One line of the log of inputs."
    time: float
    value: float
    input: int
    call: int
    _fields_: ClassVar[Any] = [
        ("time", c_double),
        ("value", c_double),
        ("input", c_uint32),
        ("call", c_uint32),
    ]
    field_docs = {
        "time": ("s", "time of the sim"),
        "value": ("unit of the input", "value that was set, after clamping"),
        "input": ("-", "number of the input in the order of description"),
        "call": ("-", "number of the call that set it: those of one call are set at once"),
    }


class EventReport(Sized):
    c_name, about = "dmb_event_report", "For dmb_sim_advance_to_event, dmb_sim_steps_to_event."
    struct_size: int
    count: int
    events: int
    time: float
    located: float
    crossing: float
    if TYPE_CHECKING:
        def __init__(self, *, count: int = ..., events: int = ..., time: SupportsFloat = ..., located: SupportsFloat = ..., crossing: SupportsFloat = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("count", c_uint32),
        ("events", c_uint64),
        ("time", c_double),
        ("located", c_double),
        ("crossing", c_double),
    ]
    field_docs = {
        "count": ("-", "events reported: those within the tolerance of the first count as simultaneous"),
        "events": ("-", "bit i: event number i in the order of description is reported"),
        "time": ("s", "reached"),
        "located": ("s", "bound of the time from the crossing to `time`; 0 without an event, and where a `hold` ends; of dmb_sim_steps_to_event the length of the step that contains the crossing or the end of the hold"),
        "crossing": ("s", "time of the crossing, of the first of several, before its `hold`; NaN without an event"),
    }


class Pose(Sized):
    c_name, about = "dmb_pose", "For dmb_query_pose, dmb_query_pose_at."
    struct_size: int
    reserved: int
    position: Any
    rotation: Any
    displacement: Any
    depth: float
    if TYPE_CHECKING:
        def __init__(self, *, position: Iterable[float] = ..., rotation: Iterable[float] = ..., displacement: Iterable[float] = ..., depth: SupportsFloat = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("reserved", c_uint32),
        ("position", c_double * 3),
        ("rotation", c_double * 9),
        ("displacement", c_double * 3),
        ("depth", c_double),
    ]
    field_docs = {
        "position": ("m", "of the section's centre, world frame; between the nodes of an element by its shape, without its sag under its own weight, w L^4/(384 EI) at most"),
        "rotation": ("-", "columns are the section's axes in the world frame, row-major, shape (3, 3)"),
        "displacement": ("m", "position less that at time 0 as described, world frame"),
        "depth": ("m", "measured depth of the closest point of the hole's axis; 0 without a hole"),
    }


class Motion(Sized):
    c_name, about = "dmb_motion", "For dmb_query_motion, dmb_query_motion_at."
    struct_size: int
    frame: int
    velocity: Any
    acceleration: Any
    if TYPE_CHECKING:
        def __init__(self, *, frame: int = ..., velocity: Iterable[float] = ..., acceleration: Iterable[float] = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("frame", c_int32),
        ("velocity", c_double * 6),
        ("acceleration", c_double * 6),
    ]
    field_docs = {
        "frame": ("", "in: FRAME_WORLD (default) or FRAME_BODY"),
        "velocity": ("m/s, rad/s", "of the section's centre, in `frame`"),
        "acceleration": ("m/s2, rad/s2", "there, in `frame`; BODY: rate of velocity in that frame"),
    }


class Section(Sized):
    c_name, about = "dmb_section", "For dmb_query_section."
    struct_size: int
    reserved: int
    force: Any
    strain: Any
    if TYPE_CHECKING:
        def __init__(self, *, force: Iterable[float] = ..., strain: Iterable[float] = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("reserved", c_uint32),
        ("force", c_double * 6),
        ("strain", c_double * 6),
    ]
    field_docs = {
        "force": ("N, N m", "on the near side from the far side: axial (tension > 0), shear y, z; torque, bending moment y, z; section frame. It balances all that acts between two sections: weight and inertia along the pipe and its tool joint, eccentric mass too, and wall forces, loads, springs at their points (axial-torsional pipes: mean of the element)"),
        "strain": ("-, -, -, rad/m, rad/m, rad/m", "mean of element: stretch, shear; twist, curvature"),
    }


class ContactTotal(Sized):
    c_name, about = "dmb_contact_total", "For dmb_query_contact_total."
    struct_size: int
    closed: int
    normal_force: float
    friction: Any
    deepest: float
    if TYPE_CHECKING:
        def __init__(self, *, closed: int = ..., normal_force: SupportsFloat = ..., friction: Iterable[float] = ..., deepest: SupportsFloat = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("closed", c_uint32),
        ("normal_force", c_double),
        ("friction", c_double * 2),
        ("deepest", c_double),
    ]
    field_docs = {
        "closed": ("-", "contact points that touch"),
        "normal_force": ("N", "sum over points"),
        "friction": ("N", "sum by component"),
        "deepest": ("m", "largest penetration, >= 0"),
    }


class Energy(Sized):
    c_name, about = "dmb_energy", "For dmb_query_energy."
    struct_size: int
    reserved: int
    kinetic: float
    strain: float
    gravity: float
    contact: float
    drives: float
    loads: float
    friction: float
    impact: float
    damping: float
    rock: float
    scheme: float
    input: float
    balance: float
    unexplained: float
    error: float
    scale: float
    growth: float
    if TYPE_CHECKING:
        def __init__(self, *, kinetic: SupportsFloat = ..., strain: SupportsFloat = ..., gravity: SupportsFloat = ..., contact: SupportsFloat = ..., drives: SupportsFloat = ..., loads: SupportsFloat = ..., friction: SupportsFloat = ..., impact: SupportsFloat = ..., damping: SupportsFloat = ..., rock: SupportsFloat = ..., scheme: SupportsFloat = ..., input: SupportsFloat = ..., balance: SupportsFloat = ..., unexplained: SupportsFloat = ..., error: SupportsFloat = ..., scale: SupportsFloat = ..., growth: SupportsFloat = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("reserved", c_uint32),
        ("kinetic", c_double),
        ("strain", c_double),
        ("gravity", c_double),
        ("contact", c_double),
        ("drives", c_double),
        ("loads", c_double),
        ("friction", c_double),
        ("impact", c_double),
        ("damping", c_double),
        ("rock", c_double),
        ("scheme", c_double),
        ("input", c_double),
        ("balance", c_double),
        ("unexplained", c_double),
        ("error", c_double),
        ("scale", c_double),
        ("growth", c_double),
    ]
    field_docs = {
        "kinetic": ("J", "now"),
        "strain": ("J", "now, of flexible pipes, springs and stops of joints"),
        "gravity": ("J", "now; gravity 0 at time 0 as described; contact stored in the wall's stiffness"),
        "contact": ("J", "now; gravity 0 at time 0 as described; contact stored in the wall's stiffness"),
        "drives": ("J", "work put in by all drives since the start"),
        "loads": ("J", "work of described loads, the bottom-hole load, the caller's constraints that move"),
        "friction": ("J", "taken by friction on the wall and in joints, energy stored in bristles included"),
        "impact": ("J", "dissipated by the damping of the normal law and of stops, and by dmb_sim_set_joint: impulses, springs released less those engaged, so it may be negative"),
        "damping": ("J", "dissipated by material and external damping and dampers of joints"),
        "rock": ("J", "spent at the bit"),
        "scheme": ("J", "taken out by the integration: work of its discrete forces less change of energies (eq:motion.work)"),
        "input": ("J", "integral of the sum of each drive's |power| and of |power| of all loads"),
        "balance": ("J", "input and changes of energy that physics leaves open: scheme + unexplained"),
        "unexplained": ("J", "balance - scheme: from unconverged iterations only"),
        "error": ("-", "|balance| / scale; 0 only if nothing is missing"),
        "scale": ("J", "largest of the energies supplied, dissipated, exchanged with gravity, present (without gravity)"),
        "growth": ("-", "change of the balance over the last tenth of the time since the start, over scale"),
    }


class Momentum(Sized):
    c_name, about = "dmb_momentum", "For dmb_query_momentum."
    struct_size: int
    reserved: int
    linear: Any
    angular: Any
    mass: float
    centre: Any
    if TYPE_CHECKING:
        def __init__(self, *, linear: Iterable[float] = ..., angular: Iterable[float] = ..., mass: SupportsFloat = ..., centre: Iterable[float] = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("reserved", c_uint32),
        ("linear", c_double * 3),
        ("angular", c_double * 3),
        ("mass", c_double),
        ("centre", c_double * 3),
    ]
    field_docs = {
        "linear": ("kg m/s", "with added mass of mud; angular about the world's origin; world frame"),
        "angular": ("kg m2/s", "with added mass of mud; angular about the world's origin; world frame"),
        "mass": ("kg", "of all parts, without mud"),
        "centre": ("m", "centre of mass, world frame"),
    }


class DriveState(Sized):
    c_name, about = "dmb_drive_state", "For dmb_query_drive."
    struct_size: int
    reserved: int
    target: float
    position: float
    speed: float
    force: float
    power: float
    work: float
    command: float
    made: float
    if TYPE_CHECKING:
        def __init__(self, *, target: SupportsFloat = ..., position: SupportsFloat = ..., speed: SupportsFloat = ..., force: SupportsFloat = ..., power: SupportsFloat = ..., work: SupportsFloat = ..., command: SupportsFloat = ..., made: SupportsFloat = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("reserved", c_uint32),
        ("target", c_double),
        ("position", c_double),
        ("speed", c_double),
        ("force", c_double),
        ("power", c_double),
        ("work", c_double),
        ("command", c_double),
        ("made", c_double),
    ]
    field_docs = {
        "target": ("unit of the time function", "now, excitation included"),
        "position": ("m, rad", "of the component since time 0, unwrapped"),
        "speed": ("m/s, rad/s", "of the component since time 0, unwrapped"),
        "force": ("N, N m", "that the drive exerts on the part, along the component"),
        "power": ("W", "since the start, 0 without the energy ledger"),
        "work": ("J", "since the start, 0 without the energy ledger"),
        "command": ("N, N m", "commanded by a LOAD or CONTROL drive now; of MOTION its force"),
        "made": ("N, N m", "command after delay, rate limit and lag of the actuator, before its curve and drag"),
    }


class JointState(Sized):
    c_name, about = "dmb_joint_state", "For dmb_query_joint."
    struct_size: int
    frame: int
    state: int
    constraint_rows: int
    redundant: int
    reserved: int
    position: Any
    speed: Any
    acceleration: Any
    reaction: Any
    action: Any
    violation: float
    if TYPE_CHECKING:
        def __init__(self, *, frame: int = ..., state: int = ..., constraint_rows: int = ..., redundant: int = ..., position: Iterable[float] = ..., speed: Iterable[float] = ..., acceleration: Iterable[float] = ..., reaction: Iterable[float] = ..., action: Iterable[float] = ..., violation: SupportsFloat = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("frame", c_int32),
        ("state", c_int32),
        ("constraint_rows", c_uint32),
        ("redundant", c_uint32),
        ("reserved", c_uint32),
        ("position", c_double * 6),
        ("speed", c_double * 6),
        ("acceleration", c_double * 6),
        ("reaction", c_double * 6),
        ("action", c_double * 6),
        ("violation", c_double),
    ]
    field_docs = {
        "frame": ("", "in: frame of `reaction`: FRAME_WORLD (default) or FRAME_BODY, which is frame b of the joint; none for frame a (ERR_VALUE)"),
        "state": ("", "JOINT_..."),
        "constraint_rows": ("-", "equations it holds now"),
        "redundant": ("-", "of them dropped because others imply them"),
        "position": ("m, rad", "coordinates, RX and RY over full turns, and their rates"),
        "speed": ("m/s, rad/s", "coordinates, RX and RY over full turns, and their rates"),
        "acceleration": ("m/s2, rad/s2", "rate of `speed`"),
        "reaction": ("N, N m", "force and moment of the constraint on b from a, at b's origin; redundant: of least norm"),
        "action": ("N, N m", "generalised force of springs, dampers, stops and friction on the coordinates"),
        "violation": ("m, -", "largest violation of its equations of position"),
    }


class BitState(Sized):
    c_name, about = "dmb_bit_state", "For dmb_query_bit."
    struct_size: int
    on_bottom: int
    advance: float
    bottom: float
    depth_of_cut: float
    weight: float
    torque: float
    load: float
    side_force: Any
    side_speed: float
    if TYPE_CHECKING:
        def __init__(self, *, on_bottom: int = ..., advance: SupportsFloat = ..., bottom: SupportsFloat = ..., depth_of_cut: SupportsFloat = ..., weight: SupportsFloat = ..., torque: SupportsFloat = ..., load: SupportsFloat = ..., side_force: Iterable[float] = ..., side_speed: SupportsFloat = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("on_bottom", c_int32),
        ("advance", c_double),
        ("bottom", c_double),
        ("depth_of_cut", c_double),
        ("weight", c_double),
        ("torque", c_double),
        ("load", c_double),
        ("side_force", c_double * 3),
        ("side_speed", c_double),
    ]
    field_docs = {
        "on_bottom": ("", "1 while cutting or touching"),
        "advance": ("m", "along the hole's axis since time 0"),
        "bottom": ("m", "advance at which rock begins"),
        "depth_of_cut": ("m", "per revolution, all blades"),
        "weight": ("N", "weight on bit, >= 0"),
        "torque": ("N m", "torque on bit, against the rotation, from the rock law"),
        "load": ("N", "bottom-hole load of the time function"),
        "side_force": ("N", "of the rock on the bit across its axis (side_cutting), world frame"),
        "side_speed": ("m/s", "of the lateral cut, across its axis"),
    }


class Statistics(Sized):
    c_name, about = "dmb_statistics", "For dmb_query_statistics."
    struct_size: int
    most_iterations: int
    steps: int
    rejected: int
    iterations: int
    limited_steps: int
    bytes: int
    largest_residual: float
    projection: Any
    assembly: Any
    switches: int
    dependent: int
    redundant: int
    violation: float
    bounces: int
    if TYPE_CHECKING:
        def __init__(self, *, most_iterations: int = ..., steps: int = ..., rejected: int = ..., iterations: int = ..., limited_steps: int = ..., bytes: int = ..., largest_residual: SupportsFloat = ..., projection: Iterable[float] = ..., assembly: Iterable[float] = ..., switches: int = ..., dependent: int = ..., redundant: int = ..., violation: SupportsFloat = ..., bounces: int = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("most_iterations", c_uint32),
        ("steps", c_uint64),
        ("rejected", c_uint64),
        ("iterations", c_uint64),
        ("limited_steps", c_uint64),
        ("bytes", c_uint64),
        ("largest_residual", c_double),
        ("projection", c_double * 2),
        ("assembly", c_double * 2),
        ("switches", c_uint64),
        ("dependent", c_uint32),
        ("redundant", c_uint32),
        ("violation", c_double),
        ("bounces", c_uint64),
    ]
    field_docs = {
        "most_iterations": ("-", "of an accepted step"),
        "steps": ("-", "accepted"),
        "rejected": ("-", "steps tried and not accepted"),
        "iterations": ("-", "iterations in all"),
        "limited_steps": ("-", "steps accepted above the tolerance in bounded-work mode"),
        "bytes": ("byte", "of the sim"),
        "largest_residual": ("-", "relative, of an accepted step"),
        "projection": ("m/s, rad/s", "largest correction of initial velocities"),
        "assembly": ("m, rad", "largest correction of the described pose when joints were closed"),
        "switches": ("-", "times the independent coordinates of a cluster were chosen again"),
        "dependent": ("-", "coordinates that constraints determine now, equations that are dropped now"),
        "redundant": ("-", "coordinates that constraints determine now, equations that are dropped now"),
        "violation": ("m, -", "largest violation of a joint's equation of position now, not of couplings, drives, constraints"),
        "bounces": ("-", "contacts with the wall, stops of joints and springs that opened within fewer than ten steps after they closed: steps do not resolve them, and their speeds after it are uncertain. Lasting contacts are not counted."),
    }


class HolePoint(Sized):
    c_name, about = "dmb_hole_point", "For dmb_query_hole, dmb_query_hole_now."
    struct_size: int
    beyond: int
    position: Any
    tangent: Any
    normal: Any
    curvature: float
    dogleg_severity: float
    inclination: float
    azimuth: float
    diameter: float
    stiffness: float
    restitution: float
    damping: float
    mu_static: float
    mu_dynamic: float
    strength: float
    section: int
    reserved: int
    section_name: bytes
    if TYPE_CHECKING:
        def __init__(self, *, beyond: int = ..., position: Iterable[float] = ..., tangent: Iterable[float] = ..., normal: Iterable[float] = ..., curvature: SupportsFloat = ..., dogleg_severity: SupportsFloat = ..., inclination: SupportsFloat = ..., azimuth: SupportsFloat = ..., diameter: SupportsFloat = ..., stiffness: SupportsFloat = ..., restitution: SupportsFloat = ..., damping: SupportsFloat = ..., mu_static: SupportsFloat = ..., mu_dynamic: SupportsFloat = ..., strength: SupportsFloat = ..., section: int = ..., section_name: str | bytes = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("beyond", c_int32),
        ("position", c_double * 3),
        ("tangent", c_double * 3),
        ("normal", c_double * 3),
        ("curvature", c_double),
        ("dogleg_severity", c_double),
        ("inclination", c_double),
        ("azimuth", c_double),
        ("diameter", c_double),
        ("stiffness", c_double),
        ("restitution", c_double),
        ("damping", c_double),
        ("mu_static", c_double),
        ("mu_dynamic", c_double),
        ("strength", c_double),
        ("section", c_uint32),
        ("reserved", c_uint32),
        ("section_name", c_char * 24),
    ]
    field_docs = {
        "beyond": ("", "HOLE_ABOVE the first station or _BELOW the last one, where the axis goes straight on; a hole without survey is HOLE_SURVEYED everywhere"),
        "position": ("m", "of the axis, world frame"),
        "tangent": ("-", "unit, to greater depth; to the centre of curvature, 0 where straight; world frame"),
        "normal": ("-", "unit, to greater depth; to the centre of curvature, 0 where straight; world frame"),
        "curvature": ("rad/m", ">= 0"),
        "dogleg_severity": ("deg/30m", "the same in the drillers' unit"),
        "inclination": ("rad", "from downward vertical, 0 .. pi"),
        "azimuth": ("rad", "from +x (north) to -y (east), -pi .. pi, vertical: 0"),
        "diameter": ("m", "of the hole"),
        "stiffness": ("N/m^(n+1)", "per metre of pipe (and the wall's other constants: scene.h)"),
        "restitution": ("-", "per metre of pipe"),
        "damping": ("N s/m2", "per metre of pipe"),
        "mu_static": ("-", ""),
        "mu_dynamic": ("-", ""),
        "strength": ("Pa", "of a section; 0: not given"),
        "section": ("", "number of the last section that begins at or above the depth; NONE: none"),
        "section_name": ("", "of that section, ends with 0; \"\" without one"),
    }


class FlowState(Sized):
    c_name, about = "dmb_flow_state", "Flow of mud"
    struct_size: int
    reserved: int
    rate: float
    pump_pressure: float
    bore_loss: float
    bit_loss: float
    annulus_loss: float
    column: float
    drag: float
    thrust: float
    pressure_stretch: float
    bore_reynolds: float
    annulus_reynolds: float
    motor_loss: float
    if TYPE_CHECKING:
        def __init__(self, *, rate: SupportsFloat = ..., pump_pressure: SupportsFloat = ..., bore_loss: SupportsFloat = ..., bit_loss: SupportsFloat = ..., annulus_loss: SupportsFloat = ..., column: SupportsFloat = ..., drag: SupportsFloat = ..., thrust: SupportsFloat = ..., pressure_stretch: SupportsFloat = ..., bore_reynolds: SupportsFloat = ..., annulus_reynolds: SupportsFloat = ..., motor_loss: SupportsFloat = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("reserved", c_uint32),
        ("rate", c_double),
        ("pump_pressure", c_double),
        ("bore_loss", c_double),
        ("bit_loss", c_double),
        ("annulus_loss", c_double),
        ("column", c_double),
        ("drag", c_double),
        ("thrust", c_double),
        ("pressure_stretch", c_double),
        ("bore_reynolds", c_double),
        ("annulus_reynolds", c_double),
        ("motor_loss", c_double),
    ]
    field_docs = {
        "rate": ("m3/s", "flow_rate of the environment"),
        "pump_pressure": ("Pa", "at the rig end, inside over outside: losses, motors and difference of columns"),
        "bore_loss": ("Pa", "down the string, by friction"),
        "bit_loss": ("Pa", "through nozzle_area (eq:mud.nozzle)"),
        "annulus_loss": ("Pa", "up the annulus, by friction"),
        "column": ("Pa", "mud outside over that inside, far end under rig end"),
        "drag": ("N", "of the flow along the string, towards the rig, in its effective axial force"),
        "thrust": ("N", "rho Q V of nozzles or open end, on the far end towards the rig"),
        "pressure_stretch": ("m", "by true axial force and pressures on the walls, beyond that of N_e and of poses"),
        "bore_reynolds": ("-", "largest; laminar up to 3470 - 1370 n, by 16/f (Metzner, Reed 1955); beyond 1e5 the smooth wall's law is low in the annulus: 7 % at 3e5, 15 % at 1e6"),
        "annulus_reynolds": ("-", "largest; laminar up to 3470 - 1370 n, by 16/f (Metzner, Reed 1955); beyond 1e5 the smooth wall's law is low in the annulus: 7 % at 3e5, 15 % at 1e6"),
        "motor_loss": ("Pa", "through mud motors at the far end at their present torque; in pump_pressure"),
    }


class SpringState(Sized):
    c_name, about = "dmb_spring_state", "For dmb_query_spring."
    struct_size: int
    reserved: int
    length: float
    elongation: float
    speed: float
    force: float
    elastic: float
    damper: float
    energy: float
    direction: Any
    point_a: Any
    point_b: Any
    if TYPE_CHECKING:
        def __init__(self, *, length: SupportsFloat = ..., elongation: SupportsFloat = ..., speed: SupportsFloat = ..., force: SupportsFloat = ..., elastic: SupportsFloat = ..., damper: SupportsFloat = ..., energy: SupportsFloat = ..., direction: Iterable[float] = ..., point_a: Iterable[float] = ..., point_b: Iterable[float] = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("reserved", c_uint32),
        ("length", c_double),
        ("elongation", c_double),
        ("speed", c_double),
        ("force", c_double),
        ("elastic", c_double),
        ("damper", c_double),
        ("energy", c_double),
        ("direction", c_double * 3),
        ("point_a", c_double * 3),
        ("point_b", c_double * 3),
    ]
    field_docs = {
        "length": ("m", "between its points, and beyond its free length"),
        "elongation": ("m", "between its points, and beyond its free length"),
        "speed": ("m/s", "rate of the elongation"),
        "force": ("N", "tension > 0: sum of the next two"),
        "elastic": ("N", ""),
        "damper": ("N", ""),
        "energy": ("J", "stored, from the free length on, or from where a one-sided one is slack"),
        "direction": ("-", "from a to b, world frame"),
        "point_a": ("m", "world"),
        "point_b": ("m", "world"),
    }


class StuckState(Sized):
    c_name, about = "dmb_stuck_state", "For dmb_query_stuck."
    struct_size: int
    stuck: int
    offset: Any
    force: Any
    share: float
    energy: float
    if TYPE_CHECKING:
        def __init__(self, *, stuck: int = ..., offset: Iterable[float] = ..., force: Iterable[float] = ..., share: SupportsFloat = ..., energy: SupportsFloat = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("stuck", c_int32),
        ("offset", c_double * 4),
        ("force", c_double * 4),
        ("share", c_double),
        ("energy", c_double),
    ]
    field_docs = {
        "stuck": ("", "1: held"),
        "offset": ("m, m, m, rad", "from where it got stuck: along, sideways y and z, turned; 0 where it is not"),
        "force": ("N, N, N, N m", "that holds it, on the string, in the same order"),
        "share": ("-", "largest of |axial force|/overpull and |torque|/overtorque, released at 1"),
        "energy": ("J", "stored"),
    }


class WindowOptions(Sized):
    c_name, about = "dmb_window_options", "Minimum, maximum and mean of outputs over the last `length` seconds of a run, in memory that does not grow: time is divided into slots, and the oldest slot is dropped as a whole. Means are by time, with straight lines between samples. The stick-slip index of the bit speed and the off-bottom share are numbers of such windows."
    struct_size: int
    slots: int
    length: float
    levels: Any
    if TYPE_CHECKING:
        def __init__(self, *, slots: int = ..., length: SupportsFloat = ..., levels: Any = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("slots", c_uint32),
        ("length", c_double),
        ("levels", POINTER(c_double)),
    ]
    field_docs = {
        "slots": ("-", "2 .. 65536; the window covers (slots - 1)/slots to all of `length`; default 100"),
        "length": ("s", ">= 0; 0 (default): all since the first sample"),
        "levels": ("unit of the output", "of low_share, shape (output_count), >= 0; NULL (default): 0"),
    }


class WindowResult(Sized):
    c_name, about = "dmb_window_result", "For dmb_window_get."
    struct_size: int
    reserved: int
    samples: int
    time: float
    minimum: float
    maximum: float
    mean: float
    rms: float
    index: float
    low_share: float
    if TYPE_CHECKING:
        def __init__(self, *, samples: int = ..., time: SupportsFloat = ..., minimum: SupportsFloat = ..., maximum: SupportsFloat = ..., mean: SupportsFloat = ..., rms: SupportsFloat = ..., index: SupportsFloat = ..., low_share: SupportsFloat = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("reserved", c_uint32),
        ("samples", c_uint64),
        ("time", c_double),
        ("minimum", c_double),
        ("maximum", c_double),
        ("mean", c_double),
        ("rms", c_double),
        ("index", c_double),
        ("low_share", c_double),
    ]
    field_docs = {
        "samples": ("-", "in the window"),
        "time": ("s", "that it spans; 0 with one sample: means are the sample then"),
        "minimum": ("unit of the output", "of the samples, NaN without one, as are the members below"),
        "maximum": ("unit of the output", "of the samples, NaN without one, as are the members below"),
        "mean": ("unit of the output", "over time"),
        "rms": ("unit of the output", "root of the mean of the squares over time"),
        "index": ("-", "(maximum - minimum)/(2 |mean|): of the bit speed the stick-slip index, 1 where the bit comes to rest; 0 where nothing varies, infinite about a mean of 0"),
        "low_share": ("-", "of the time, |value| <= its level, by the sample at the end of each interval"),
    }


class StaticOptions(Sized):
    c_name, about = "dmb_static_options", "For dmb_analysis_static."
    struct_size: int
    max_iterations: int
    tolerance: float
    slip_axial: float
    slip_rotation: float
    load_steps: int
    lay_on_wall: int
    steady: int
    reserved: int
    if TYPE_CHECKING:
        def __init__(self, *, max_iterations: int = ..., tolerance: SupportsFloat = ..., slip_axial: SupportsFloat = ..., slip_rotation: SupportsFloat = ..., load_steps: int = ..., lay_on_wall: int = ..., steady: int = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("max_iterations", c_uint32),
        ("tolerance", c_double),
        ("slip_axial", c_double),
        ("slip_rotation", c_double),
        ("load_steps", c_uint32),
        ("lay_on_wall", c_int32),
        ("steady", c_int32),
        ("reserved", c_int32),
    ]
    field_docs = {
        "max_iterations": ("-", "of one load step, 1 .. 10000; default 60"),
        "tolerance": ("-", "residual over the norm of the forces that balance in it; default 1e-10"),
        "slip_axial": ("m/s", "friction acts as if the string slid along the hole and turned at these speeds, both 0 (default): no friction in the static state. With a slip the state is quasi-static: until the next step its accelerations are 0 and section forces contain neither inertia nor damping"),
        "slip_rotation": ("rad/s", "friction acts as if the string slid along the hole and turned at these speeds, both 0 (default): no friction in the static state. With a slip the state is quasi-static: until the next step its accelerations are 0 and section forces contain neither inertia nor damping"),
        "load_steps": ("-", "equal steps from no load to full load, <= 10000, before the library chooses them itself; 0 (default): the whole load at once"),
        "lay_on_wall": ("", "1 (default): start from the string lying on the low side of its hole; 0: from the present pose"),
        "steady": ("", "STEADY_..., default STEADY_AUTO"),
    }
    bounds = {
        "max_iterations": ("within", 1, 10000),
        "tolerance": ("within", 1e-15, 0.1),
        "slip_axial": ("within", -1000000, 1000000),
        "slip_rotation": ("within", -1000000, 1000000),
        "load_steps": ("within", 0, 10000),
        "lay_on_wall": ("within", 0, 1),
        "steady": ("within", 0, 3),
    }


class StaticReport(Sized):
    c_name, about = "dmb_static_report", "For dmb_analysis_static."
    struct_size: int
    iterations: int
    load_steps: int
    method: int
    residual: float
    largest_force: float
    lateral_move: float
    cuts: int
    line_searches: int
    negative: int
    stiffness: int
    steady: int
    steady_reserved: int
    free_spins: int
    unresolved: int
    resolution: float
    if TYPE_CHECKING:
        def __init__(self, *, iterations: int = ..., load_steps: int = ..., method: int = ..., residual: SupportsFloat = ..., largest_force: SupportsFloat = ..., lateral_move: SupportsFloat = ..., cuts: int = ..., line_searches: int = ..., negative: int = ..., stiffness: int = ..., steady: int = ..., free_spins: int = ..., unresolved: int = ..., resolution: SupportsFloat = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("iterations", c_uint32),
        ("load_steps", c_uint32),
        ("method", c_int32),
        ("residual", c_double),
        ("largest_force", c_double),
        ("lateral_move", c_double),
        ("cuts", c_uint32),
        ("line_searches", c_uint32),
        ("negative", c_int32),
        ("stiffness", c_int32),
        ("steady", c_int32),
        ("steady_reserved", c_int32),
        ("free_spins", c_int32),
        ("unresolved", c_int32),
        ("resolution", c_double),
    ]
    field_docs = {
        "iterations": ("-", "in all"),
        "load_steps": ("-", "carried out"),
        "method": ("", "STATIC_...: the last resort that was needed"),
        "residual": ("-", "relative; largest component of it; at the end"),
        "largest_force": ("N, N m over the element length", "relative; largest component of it; at the end"),
        "lateral_move": ("m", "largest displacement from the starting pose"),
        "cuts": ("-", "load steps that were halved"),
        "line_searches": ("-", "corrections that were shortened by a line search"),
        "negative": ("-", "negative eigenvalues of the stiffness (eq:signs.bounds), by which the equilibrium is unstable; -1: not resolved (none is known to be negative; `unresolved`). UNSYMMETRIC: the real negative ones; above 400 coordinates those within reach of the symmetric part, or if there are any, those among the 108 nearest 0. Of a state that moves (`steady`): in its moving axes with centrifugal forces; gyroscopic ones may hold it, or damping not"),
        "stiffness": ("", "STIFFNESS_...: the kind that was assessed"),
        "steady": ("", "STEADY_AT_REST, _SLIDING or _RIGID: kind of the state"),
        "free_spins": ("-", "rotations of strings about their own axes that nothing resists, strings that turn together counted once: every angle is an equilibrium, and the starting one is kept"),
        "unresolved": ("-", "eigenvalues of rounding size, whose signs the count does not resolve: motions that nothing resists, or a mesh too fine for double precision; SYMMETRIC only"),
        "resolution": ("N/m", "largest eigenvalue, rotations over the square of the mean element length, that may be of rounding size: 4 eps of the largest stiffness"),
    }


class BucklingInfo(Sized):
    c_name, about = "dmb_buckling_info", "For dmb_buckling_get_info."
    struct_size: int
    count: int
    confirmed: int
    linearisations: int
    points: int
    stiffness: int
    end: int
    flutter: int
    estimate: float
    linearised_at: float
    reached: float
    flutter_factor: float
    flutter_root: Any
    dip: float
    sinusoidal_share: float
    if TYPE_CHECKING:
        def __init__(self, *, count: int = ..., confirmed: int = ..., linearisations: int = ..., points: int = ..., stiffness: int = ..., end: int = ..., flutter: int = ..., estimate: SupportsFloat = ..., linearised_at: SupportsFloat = ..., reached: SupportsFloat = ..., flutter_factor: SupportsFloat = ..., flutter_root: Iterable[float] = ..., dip: SupportsFloat = ..., sinusoidal_share: SupportsFloat = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("count", c_uint32),
        ("confirmed", c_uint32),
        ("linearisations", c_uint32),
        ("points", c_uint32),
        ("stiffness", c_int32),
        ("end", c_int32),
        ("flutter", c_int32),
        ("estimate", c_double),
        ("linearised_at", c_double),
        ("reached", c_double),
        ("flutter_factor", c_double),
        ("flutter_root", c_double * 2),
        ("dip", c_double),
        ("sinusoidal_share", c_double),
    ]
    field_docs = {
        "count": ("-", "factors"),
        "confirmed": ("-", "of them, the lowest: half the step length along the equilibria ends at the same first factor (1e-5 of it, of a dip 1e-3), others are the same or have not changed from one linearisation to the other; the others are extrapolations. The mesh is not halved: compare with one of twice the elements"),
        "linearisations": ("-", "of states on the path, the present one included"),
        "points": ("-", "equilibria found on the path"),
        "stiffness": ("", "STIFFNESS_... of the state linearised last. UNSYMMETRIC: divergence, det K = 0; see `flutter`"),
        "end": ("", "BUCKLING_..., FLUTTER_..."),
        "flutter": ("", "BUCKLING_..., FLUTTER_..."),
        "estimate": ("unit of the factor", "the lowest factor, from the present state alone; infinite: none"),
        "linearised_at": ("unit of the factor", "state that the shapes and further factors were linearised about"),
        "reached": ("unit of the factor", "last equilibrium on the path before the end"),
        "flutter_factor": ("unit of the factor", "of FOUND: a mode grows from there on; 0: in the present state"),
        "flutter_root": ("1/s", "its root there, real and imaginary part, 0 without swinging"),
        "dip": ("-", "of BUCKLING_DIP: 1 - lowest eigenvalue over its largest value before; 1: a perfect string; below 0.92 it bends off gradually, and another mesh may give another minimum; 0: another end"),
        "sinusoidal_share": ("-", "at the lowest factor that was followed to: largest PROFILE_SINUSOIDAL_SHARE of all strings, for comparison with the closed form; NaN without a hole or a factor"),
    }


class PathPoint(Sized):
    c_name, about = "dmb_path_point", ""
    struct_size: int
    number: int
    kind: int
    negative: int
    iterations: int
    stiffness: int
    factor: float
    rate: float
    arc: float
    displacement: float
    if TYPE_CHECKING:
        def __init__(self, *, number: int = ..., kind: int = ..., negative: int = ..., iterations: int = ..., stiffness: int = ..., factor: SupportsFloat = ..., rate: SupportsFloat = ..., arc: SupportsFloat = ..., displacement: SupportsFloat = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("number", c_uint32),
        ("kind", c_int32),
        ("negative", c_int32),
        ("iterations", c_uint32),
        ("stiffness", c_int32),
        ("factor", c_double),
        ("rate", c_double),
        ("arc", c_double),
        ("displacement", c_double),
    ]
    field_docs = {
        "number": ("-", "0: the state the path begins in"),
        "kind": ("", "PATH_..."),
        "negative": ("-", "as in dmb_static_report, of the 12 nearest 0 where UNSYMMETRIC; 0: stable"),
        "iterations": ("-", "of this point"),
        "stiffness": ("", "STIFFNESS_..."),
        "factor": ("unit of the factor", "its rate along the path, < 0 where it falls"),
        "rate": ("unit of the factor/m", "its rate along the path, < 0 where it falls"),
        "arc": ("m", "length of the path so far, root of the mean square of the motion of the nodes"),
        "displacement": ("m", "of the watched place and component since time 0; 0: none is watched"),
    }


class PathReport(Sized):
    c_name, about = "dmb_path_report", "For dmb_analysis_path."
    struct_size: int
    points: int
    limits: int
    bifurcations: int
    iterations: int
    cuts: int
    factor: float
    displacement: float
    first_limit: float
    first_bifurcation: float
    if TYPE_CHECKING:
        def __init__(self, *, points: int = ..., limits: int = ..., bifurcations: int = ..., iterations: int = ..., cuts: int = ..., factor: SupportsFloat = ..., displacement: SupportsFloat = ..., first_limit: SupportsFloat = ..., first_bifurcation: SupportsFloat = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("points", c_uint32),
        ("limits", c_uint32),
        ("bifurcations", c_uint32),
        ("iterations", c_uint32),
        ("cuts", c_uint32),
        ("factor", c_double),
        ("displacement", c_double),
        ("first_limit", c_double),
        ("first_bifurcation", c_double),
    ]
    field_docs = {
        "points": ("-", "beyond the start, limit points and bifurcations included"),
        "limits": ("-", "limit points passed"),
        "bifurcations": ("-", "bifurcations passed or left at"),
        "iterations": ("-", "in all"),
        "cuts": ("-", "steps that were halved"),
        "factor": ("unit of the factor", "at the end"),
        "displacement": ("m", "at the end"),
        "first_limit": ("unit of the factor", "at the first limit point, the first bifurcation, NaN: none"),
        "first_bifurcation": ("unit of the factor", "at the first limit point, the first bifurcation, NaN: none"),
    }


class CheckReport(Sized):
    c_name, about = "dmb_check_report", "The parts of a scene, its degrees of freedom, and warnings."
    struct_size: int
    rigid_parts: int
    flexible_parts: int
    elements: int
    structural_joints: int
    joints: 'Array[c_uint32]'
    open_joints: int
    locked_joints: int
    couplings: int
    constraints: int
    motion_drives: int
    other_drives: int
    loads: int
    coordinates: int
    held: int
    prescribed: int
    constraint_rows: int
    rank: int
    degrees_of_freedom: int
    redundant: int
    tridiagonal_nodes: int
    sparse_nodes: int
    blocks: int
    fill: int
    clusters: int
    largest_cluster: int
    warnings: int
    gruebler: int
    largest_violation: float
    condition: float
    if TYPE_CHECKING:
        def __init__(self, *, rigid_parts: int = ..., flexible_parts: int = ..., elements: int = ..., structural_joints: int = ..., joints: Iterable[Any] = ..., open_joints: int = ..., locked_joints: int = ..., couplings: int = ..., constraints: int = ..., motion_drives: int = ..., other_drives: int = ..., loads: int = ..., coordinates: int = ..., held: int = ..., prescribed: int = ..., constraint_rows: int = ..., rank: int = ..., degrees_of_freedom: int = ..., redundant: int = ..., tridiagonal_nodes: int = ..., sparse_nodes: int = ..., blocks: int = ..., fill: int = ..., clusters: int = ..., largest_cluster: int = ..., warnings: int = ..., gruebler: int = ..., largest_violation: SupportsFloat = ..., condition: SupportsFloat = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("rigid_parts", c_uint32),
        ("flexible_parts", c_uint32),
        ("elements", c_uint32),
        ("structural_joints", c_uint32),
        ("joints", c_uint32 * 32),
        ("open_joints", c_uint32),
        ("locked_joints", c_uint32),
        ("couplings", c_uint32),
        ("constraints", c_uint32),
        ("motion_drives", c_uint32),
        ("other_drives", c_uint32),
        ("loads", c_uint32),
        ("coordinates", c_uint32),
        ("held", c_uint32),
        ("prescribed", c_uint32),
        ("constraint_rows", c_uint32),
        ("rank", c_uint32),
        ("degrees_of_freedom", c_uint32),
        ("redundant", c_uint32),
        ("tridiagonal_nodes", c_uint32),
        ("sparse_nodes", c_uint32),
        ("blocks", c_uint32),
        ("fill", c_uint32),
        ("clusters", c_uint32),
        ("largest_cluster", c_uint32),
        ("warnings", c_uint32),
        ("gruebler", c_int64),
        ("largest_violation", c_double),
        ("condition", c_double),
    ]
    field_docs = {
        "rigid_parts": ("-", "bodies and bits (fixed to a string or not), rigid pipes, rigid tool joints"),
        "flexible_parts": ("-", "flexible and axial-torsional pipes"),
        "elements": ("-", "elements of those"),
        "structural_joints": ("-", "fixed joints inside strings, which cost no unknowns"),
        "joints": ("-", "described joints that are not open, by JOINT_ kind; 0 beyond the kinds"),
        "open_joints": ("-", "described joints that are open now"),
        "locked_joints": ("-", "of `joints` those that are locked now"),
        "couplings": ("-", "couplings"),
        "constraints": ("-", "constraints of the caller"),
        "motion_drives": ("-", "DRIVE_MOTION"),
        "other_drives": ("-", "DRIVE_LOAD and _CONTROL"),
        "loads": ("-", "loads"),
        "coordinates": ("-", "velocity components of all nodes: 6 or (axial-torsional) 2 each"),
        "held": ("-", "of them held by supports (start_free, end_free, free_mask)"),
        "prescribed": ("-", "moved by motion drives of strings and bodies"),
        "constraint_rows": ("-", "equations that act now: of joints, couplings, constraints, joint motion drives"),
        "rank": ("-", "rank of their matrix in the coordinates that are neither held nor prescribed"),
        "degrees_of_freedom": ("-", "coordinates - held - prescribed - rank"),
        "redundant": ("-", "rows - rank, implied by others"),
        "tridiagonal_nodes": ("-", "nodes whose chains the block-tridiagonal solver takes"),
        "sparse_nodes": ("-", "nodes of chains that equations connect: the sparse solver's"),
        "blocks": ("-", "of the sparse solver: clusters and the other nodes of those chains"),
        "fill": ("-", "couplings of blocks that its elimination adds"),
        "clusters": ("-", "groups of nodes that equations connect directly"),
        "largest_cluster": ("-", "coordinates of the largest"),
        "warnings": ("-", "lines of warning in the text"),
        "gruebler": ("-", "coordinates - held - prescribed - rows; < degrees_of_freedom if equations are redundant"),
        "largest_violation": ("m, -", "largest violation of an equation of position"),
        "condition": ("-", "smallest over largest singular value of a cluster's equations, redundant ones apart, at unit length, rotations at the mean element length; of the worst cluster; an estimate above 300 equations; 1 without any"),
    }


class ModesOptions(Sized):
    c_name, about = "dmb_modes_options", "For dmb_analysis_modes."
    struct_size: int
    kind: int
    select: int
    count: int
    band: Any
    contact: int
    friction: int
    contact_gap: float
    equilibrium_tolerance: float
    axes: int
    reserved: int
    spin: float
    if TYPE_CHECKING:
        def __init__(self, *, kind: int = ..., select: int = ..., count: int = ..., band: Iterable[float] = ..., contact: int = ..., friction: int = ..., contact_gap: SupportsFloat = ..., equilibrium_tolerance: SupportsFloat = ..., axes: int = ..., spin: SupportsFloat = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("kind", c_int32),
        ("select", c_int32),
        ("count", c_uint32),
        ("band", c_double * 2),
        ("contact", c_int32),
        ("friction", c_int32),
        ("contact_gap", c_double),
        ("equilibrium_tolerance", c_double),
        ("axes", c_int32),
        ("reserved", c_int32),
        ("spin", c_double),
    ]
    field_docs = {
        "kind": ("", "MODES_UNDAMPED (default), _DAMPED"),
        "select": ("", "MODES_LOWEST (default), _ALL, _BAND"),
        "count": ("-", "of LOWEST, 1 .. number of coordinates, twice that if DAMPED, where every real root is a mode (fewer come back where there are fewer); default 10"),
        "band": ("Hz", "of BAND, 0 <= band[0] < band[1]; default 0 and 100"),
        "contact": ("", "CONTACT_..., default CONTACT_AS_IS"),
        "friction": ("", "1 (default): the slope of the friction law on the wall acts; 0: friction is a dead load"),
        "contact_gap": ("m", "of CONTACT_CLOSED, >= 0; default 0"),
        "equilibrium_tolerance": ("-", "residual over the forces that balance in it, > 0, of a state; default 1e-6"),
        "axes": ("", "MODES_AXES_TURNING (default), _AT_REST"),
        "spin": ("rad/s", "strings turn at this speed in the state, about their own x axis; 0 (default): as they do. A static state with slip_rotation of this speed is in balance with friction but for the tilt of the pipes in the hole, some 1e-5"),
    }
    bounds = {
        "kind": ("within", 0, 1),
        "select": ("within", 0, 2),
        "count": ("within", 1, 4294967294),
        "band": ("within", 0, 1e+12),
        "contact": ("within", 0, 2),
        "friction": ("within", 0, 1),
        "contact_gap": ("within", 0, 1000000),
        "equilibrium_tolerance": ("above", 0, inf),
        "axes": ("within", 0, 1),
        "spin": ("within", -1000000, 1000000),
    }


class ModesInfo(Sized):
    c_name, about = "dmb_modes_info", "For dmb_modes_get_info."
    struct_size: int
    count: int
    rigid: int
    coordinates: int
    dense: int
    solves: int
    residual_of_state: float
    asymmetry: float
    residual: float
    double_roots: int
    reserved: int
    if TYPE_CHECKING:
        def __init__(self, *, count: int = ..., rigid: int = ..., coordinates: int = ..., dense: int = ..., solves: int = ..., residual_of_state: SupportsFloat = ..., asymmetry: SupportsFloat = ..., residual: SupportsFloat = ..., double_roots: int = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("count", c_uint32),
        ("rigid", c_uint32),
        ("coordinates", c_uint32),
        ("dense", c_int32),
        ("solves", c_uint32),
        ("residual_of_state", c_double),
        ("asymmetry", c_double),
        ("residual", c_double),
        ("double_roots", c_uint32),
        ("reserved", c_uint32),
    ]
    field_docs = {
        "count": ("-", "modes found, by rising frequency"),
        "rigid": ("-", "of them rigid-body modes: motions of all parts as rigid bodies that neither joints nor supports nor any force hold, K d = 0. They are found as such, not as small eigenvalues; each is reported once, with s = 0"),
        "coordinates": ("-", "independent coordinates of the linear system"),
        "dense": ("", "1: by LAPACK on all coordinates; 0: by Krylov subspaces on sparse factors"),
        "solves": ("-", "with those factors"),
        "residual_of_state": ("-", "relative residual of the state without its body-frame accelerations"),
        "asymmetry": ("-", "asymmetry of K, above 1e-9 treated as unsymmetric (friction, follower loads)"),
        "residual": ("-", "largest |(s^2 M + s C + K) d| over the norms of the terms that balance in it"),
        "double_roots": ("-", "roots that were reported as the mean of two or more with one shape (critical damping, the edge of flutter, straight motion seen in axes that spin): eq:modes.double"),
    }


class Mode(Sized):
    c_name, about = "dmb_mode", "For dmb_modes_get."
    struct_size: int
    rigid: int
    frequency: float
    damping: float
    eigenvalue: Any
    kinetic: float
    strain: float
    share: Any
    participation: Any
    effective_mass: Any
    whirl: float
    strain_share: Any
    if TYPE_CHECKING:
        def __init__(self, *, rigid: int = ..., frequency: SupportsFloat = ..., damping: SupportsFloat = ..., eigenvalue: Iterable[float] = ..., kinetic: SupportsFloat = ..., strain: SupportsFloat = ..., share: Iterable[float] = ..., participation: Iterable[float] = ..., effective_mass: Iterable[float] = ..., whirl: SupportsFloat = ..., strain_share: Iterable[float] = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("rigid", c_int32),
        ("frequency", c_double),
        ("damping", c_double),
        ("eigenvalue", c_double * 2),
        ("kinetic", c_double),
        ("strain", c_double),
        ("share", c_double * 3),
        ("participation", c_double * 3),
        ("effective_mass", c_double * 3),
        ("whirl", c_double),
        ("strain_share", c_double * 3),
    ]
    field_docs = {
        "rigid": ("", "1: a rigid-body mode: nothing holds or strains it"),
        "frequency": ("Hz", "|s|/(2 pi)"),
        "damping": ("-", "-Re s/|s|, 1 of an overdamped root, one mode, 0 of a rigid one"),
        "eigenvalue": ("1/s", "s, real and imaginary part >= 0. Flutter is two modes, one that grows and one that decays. Without damping, divergence (s, -s) is one mode, s > 0"),
        "kinetic": ("J", "|s|^2 d^H M d/2 of the shape with d^H M d = 1 kg m2 (or kg)"),
        "strain": ("J", "of elements, elastic part"),
        "share": ("-", "of the kinetic energy that is axial, torsional, lateral motion of pipes and bodies in their own axes; of a rigid mode at unit |s|; sum 1"),
        "participation": ("kg^0.5", "d^T M e for a base that moves along world x, y, z"),
        "effective_mass": ("kg", "their squares: sum over all modes = mass that is free to move"),
        "whirl": ("-", "part of the kinetic energy in circles from y to z (forward, of spin > 0) less that in circles from z to y (backward), in `axes`: 1 .. -1; 0 of real shapes"),
        "strain_share": ("-", "of the strain energy that is stretch, twist, bending with shear; sum 1 or 0"),
    }


class ModeShape(Sized):
    c_name, about = "dmb_mode_shape", "For dmb_modes_shape."
    struct_size: int
    frame: int
    re: Any
    im: Any
    if TYPE_CHECKING:
        def __init__(self, *, frame: int = ..., re: Iterable[float] = ..., im: Iterable[float] = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("frame", c_int32),
        ("re", c_double * 6),
        ("im", c_double * 6),
    ]
    field_docs = {
        "frame": ("", "in: FRAME_WORLD (default) or FRAME_BODY, axes of re and im"),
        "re": ("m, rad", "displacement and rotation of a place, d = Re(shape e^(s t))"),
        "im": ("m, rad", "im 0 if undamped"),
    }


class ResponseOptions(Sized):
    c_name, about = "dmb_response_options", "For dmb_analysis_response."
    struct_size: int
    points: int
    frequency_low: float
    frequency_high: float
    frequencies: Any
    logarithmic: int
    refinement: int
    structural_damping: float
    equilibrium_tolerance: float
    contact: int
    friction: int
    contact_gap: float
    axes: int
    reserved: int
    spin: float
    if TYPE_CHECKING:
        def __init__(self, *, points: int = ..., frequency_low: SupportsFloat = ..., frequency_high: SupportsFloat = ..., frequencies: Any = ..., logarithmic: int = ..., refinement: int = ..., structural_damping: SupportsFloat = ..., equilibrium_tolerance: SupportsFloat = ..., contact: int = ..., friction: int = ..., contact_gap: SupportsFloat = ..., axes: int = ..., spin: SupportsFloat = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("points", c_uint32),
        ("frequency_low", c_double),
        ("frequency_high", c_double),
        ("frequencies", POINTER(c_double)),
        ("logarithmic", c_int32),
        ("refinement", c_uint32),
        ("structural_damping", c_double),
        ("equilibrium_tolerance", c_double),
        ("contact", c_int32),
        ("friction", c_int32),
        ("contact_gap", c_double),
        ("axes", c_int32),
        ("reserved", c_int32),
        ("spin", c_double),
    ]
    field_docs = {
        "points": ("-", "of the grid, 2 .. 1e6; 1 where both ends are one frequency; default 1000"),
        "frequency_low": ("Hz", ">= 0, > 0 of a logarithmic grid, the second >= the first; default 1 and 100"),
        "frequency_high": ("Hz", ">= 0, > 0 of a logarithmic grid, the second >= the first; default 1 and 100"),
        "frequencies": ("Hz", "ascending, shape (points): these instead of a grid; NULL (default): the grid"),
        "logarithmic": ("", "1: equal ratios between frequencies; 0 (default): equal differences"),
        "refinement": ("-", "times the intervals on both sides of each peak of a transfer function are halved, 0 .. 40; default 0. A peak that falls between two points unseen is not found"),
        "structural_damping": ("-", "eta: stiffness (1 + i eta) K, >= 0; default 0"),
        "equilibrium_tolerance": ("-", "residual over the forces that balance in it; default 1e-6"),
        "contact": ("", "CONTACT_..., default CONTACT_AS_IS"),
        "friction": ("", "1 (default): the slope of the friction law damps or drives; 0: left out"),
        "contact_gap": ("m", "of CONTACT_CLOSED, >= 0; default 0"),
        "axes": ("", "RESPONSE_AXES_TURNING (default), _AT_REST"),
        "spin": ("rad/s", "strings turn at this speed in the state, as of dmb_modes_options; 0 (default): as they do"),
    }
    bounds = {
        "points": ("within", 1, 1000000),
        "frequency_low": ("within", 0, 1000000000),
        "frequency_high": ("within", 0, 1000000000),
        "logarithmic": ("within", 0, 1),
        "refinement": ("within", 0, 40),
        "structural_damping": ("within", 0, 1000),
        "equilibrium_tolerance": ("within", 1e-06, 1),
        "contact": ("within", 0, 2),
        "friction": ("within", 0, 1),
        "contact_gap": ("within", 0, 1000000),
        "axes": ("within", 0, 1),
        "spin": ("within", -1000000, 1000000),
    }


class SteppedSineOptions(Sized):
    c_name, about = "dmb_stepped_sine_options", "Response in time to the scene's own time functions at one frequency, where the linear one fails: contacts that open, friction that sticks, large motion. One call is one frequency; describe a scene for each (a HARMONIC time function, a drive's speed), and transfer the state by dmb_sim_transfer_state. Different sims may run in parallel, with the same bits."
    struct_size: int
    steps_per_period: int
    periods: int
    windows: int
    harmonics: int
    reserved: int
    tolerance: float
    floor: float
    if TYPE_CHECKING:
        def __init__(self, *, steps_per_period: int = ..., periods: int = ..., windows: int = ..., harmonics: int = ..., tolerance: SupportsFloat = ..., floor: SupportsFloat = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("steps_per_period", c_uint32),
        ("periods", c_uint32),
        ("windows", c_uint32),
        ("harmonics", c_uint32),
        ("reserved", c_uint32),
        ("tolerance", c_double),
        ("floor", c_double),
    ]
    field_docs = {
        "steps_per_period": ("-", "16 .. 1e6; default 100: frequency error about (2 pi/this)^2/12"),
        "periods": ("-", "of a window, 1 .. 1e4, more than 1 where multiples of the period are awaited; default 4"),
        "windows": ("-", "windows at most, 3 .. 1e6; default 500"),
        "harmonics": ("-", "1 .. 16, at most an eighth of steps_per_period; default 3"),
        "tolerance": ("-", "settled: the remaining change, extrapolated from the last windows, is below this part of the largest harmonic of each output; default 1e-3"),
        "floor": ("unit of the output", "changes of a harmonic below it count as none, > 0; default 1e-12"),
    }
    bounds = {
        "steps_per_period": ("within", 16, 1000000),
        "periods": ("within", 1, 10000),
        "windows": ("within", 3, 1000000),
        "harmonics": ("within", 1, 16),
        "tolerance": ("within", 1e-12, 1),
        "floor": ("within", 1e-300, 1e+30),
    }


class SteppedSineReport(Sized):
    c_name, about = "dmb_stepped_sine_report", "For dmb_analysis_stepped_sine."
    struct_size: int
    settled: int
    windows: int
    rejected: int
    steps: int
    change: float
    remaining: float
    time: float
    if TYPE_CHECKING:
        def __init__(self, *, settled: int = ..., windows: int = ..., rejected: int = ..., steps: int = ..., change: SupportsFloat = ..., remaining: SupportsFloat = ..., time: SupportsFloat = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("settled", c_int32),
        ("windows", c_uint32),
        ("rejected", c_uint32),
        ("steps", c_uint64),
        ("change", c_double),
        ("remaining", c_double),
        ("time", c_double),
    ]
    field_docs = {
        "settled": ("", "1: the amplitudes settled; 0: they did not"),
        "windows": ("-", "run"),
        "rejected": ("-", "steps tried and not accepted"),
        "steps": ("-", "accepted"),
        "change": ("-", "change between the last two windows, worst output"),
        "remaining": ("-", "estimated remaining change"),
        "time": ("s", "reached"),
    }


class SpeedsReport(Sized):
    c_name, about = "dmb_speeds_report", ""
    struct_size: int
    bands: int
    silent_orders: int
    undamped: int
    truncated: int
    reserved: int
    if TYPE_CHECKING:
        def __init__(self, *, bands: int = ..., silent_orders: int = ..., undamped: int = ..., truncated: int = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("bands", c_uint32),
        ("silent_orders", c_uint32),
        ("undamped", c_int32),
        ("truncated", c_int32),
        ("reserved", c_int32),
    ]
    field_docs = {
        "bands": ("-", "that were found, those without room included"),
        "silent_orders": ("-", "orders whose excitation moves no output at any speed"),
        "undamped": ("", "1: nothing damps, so that heights at resonances mean nothing"),
        "truncated": ("", "1: a band continues below speed_low, 2: above speed_high, 3: both, 0: none"),
    }


class SpeedBand(Sized):
    c_name, about = "dmb_speed_band", "For dmb_analysis_speeds."
    struct_size: int
    order: int
    output: int
    reserved: int
    low: float
    high: float
    speed: float
    severity: float
    frequency: float
    truncated: int
    reserved1: int
    if TYPE_CHECKING:
        def __init__(self, *, order: int = ..., output: int = ..., low: SupportsFloat = ..., high: SupportsFloat = ..., speed: SupportsFloat = ..., severity: SupportsFloat = ..., frequency: SupportsFloat = ..., truncated: int = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("order", c_uint32),
        ("output", c_uint32),
        ("reserved", c_uint32),
        ("low", c_double),
        ("high", c_double),
        ("speed", c_double),
        ("severity", c_double),
        ("frequency", c_double),
        ("truncated", c_int32),
        ("reserved1", c_int32),
    ]
    field_docs = {
        "order": ("-", "number of the order that counts most at the worst speed, and of its worst output"),
        "output": ("-", "number of the order that counts most at the worst speed, and of its worst output"),
        "low": ("rad/s", "of the band, margin included"),
        "high": ("rad/s", "of the band, margin included"),
        "speed": ("rad/s", "the worst in it, and its severity"),
        "severity": ("-", "the worst in it, and its severity"),
        "frequency": ("Hz", "of that order there"),
        "truncated": ("", "1: continues below speed_low, 2: above speed_high, 3: both, 0: whole"),
    }


class StateSpaceOptions(Sized):
    c_name, about = "dmb_state_space_options", "For dmb_analysis_state_space."
    struct_size: int
    form: int
    motion: int
    static_correction: int
    modes: Any
    mode_list: Any
    mode_count: int
    contact: int
    friction: int
    reserved: int
    contact_gap: float
    equilibrium_tolerance: float
    shift: float
    if TYPE_CHECKING:
        def __init__(self, *, form: int = ..., motion: int = ..., static_correction: int = ..., modes: Any = ..., mode_list: Any = ..., mode_count: int = ..., contact: int = ..., friction: int = ..., contact_gap: SupportsFloat = ..., equilibrium_tolerance: SupportsFloat = ..., shift: SupportsFloat = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("form", c_int32),
        ("motion", c_int32),
        ("static_correction", c_int32),
        ("modes", c_void_p),
        ("mode_list", POINTER(c_int32)),
        ("mode_count", c_uint32),
        ("contact", c_int32),
        ("friction", c_int32),
        ("reserved", c_int32),
        ("contact_gap", c_double),
        ("equilibrium_tolerance", c_double),
        ("shift", c_double),
    ]
    field_docs = {
        "form": ("", "STATE_..., default STATE_FULL"),
        "motion": ("", "MOTION_..., default MOTION_SPEED"),
        "static_correction": ("", "1 (default): quasi-static shapes of the inputs in the basis; 0: modes alone"),
        "modes": ("", "of STATE_REDUCED: modes about this state, of any kind, contact as here"),
        "mode_list": ("-", "numbers of those that are taken, shape (mode_count); NULL (default): all"),
        "mode_count": ("-", "of mode_list; 0 (default) without one"),
        "contact": ("", "CONTACT_...; default CONTACT_AS_IS"),
        "friction": ("", "as of a response; default 1"),
        "contact_gap": ("m", "of CONTACT_CLOSED, >= 0; default 0"),
        "equilibrium_tolerance": ("-", "residual over the forces that balance in it; default 1e-6"),
        "shift": ("Hz", ">= 0: quasi-static shapes are (K + w^2 M)^-1 f; default 0; > 0 where something is free to move as a rigid body, far below the frequencies that count"),
    }
    bounds = {
        "form": ("within", 0, 2),
        "motion": ("within", 0, 1),
        "static_correction": ("within", 0, 1),
        "contact": ("within", 0, 2),
        "friction": ("within", 0, 1),
        "contact_gap": ("within", 0, 1000000),
        "equilibrium_tolerance": ("within", 1e-06, 1),
        "shift": ("within", 0, 1000000000),
    }


class StateSpaceInfo(Sized):
    c_name, about = "dmb_state_space_info", "For dmb_state_space_get_info."
    struct_size: int
    states: int
    inputs: int
    outputs: int
    coordinates: int
    mode_shapes: int
    input_states: int
    rows: int
    independent: int
    constraint_rows: int
    residual_of_state: float
    largest_force: float
    if TYPE_CHECKING:
        def __init__(self, *, states: int = ..., inputs: int = ..., outputs: int = ..., coordinates: int = ..., mode_shapes: int = ..., input_states: int = ..., rows: int = ..., independent: int = ..., constraint_rows: int = ..., residual_of_state: SupportsFloat = ..., largest_force: SupportsFloat = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("states", c_uint32),
        ("inputs", c_uint32),
        ("outputs", c_uint32),
        ("coordinates", c_uint32),
        ("mode_shapes", c_uint32),
        ("input_states", c_uint32),
        ("rows", c_uint32),
        ("independent", c_uint32),
        ("constraint_rows", c_uint32),
        ("residual_of_state", c_double),
        ("largest_force", c_double),
    ]
    field_docs = {
        "states": ("-", "2 coordinates + input_states; 0 of STATE_MATRICES"),
        "inputs": ("-", ""),
        "outputs": ("-", ""),
        "coordinates": ("-", "of A: independent ones, or shapes of the basis"),
        "mode_shapes": ("-", "of these, of modes, the others being quasi-static"),
        "input_states": ("-", "states of inputs"),
        "rows": ("-", "of M, C, K: all rows of the scene, held ones too"),
        "independent": ("-", "columns of MATRIX_COORDINATES"),
        "constraint_rows": ("-", "of the Jacobian: equations that act"),
        "residual_of_state": ("-", "relative"),
        "largest_force": ("N", "of it"),
    }


class Parameter(Sized):
    c_name, about = "dmb_parameter", "derivatives of one run"
    struct_size: int
    one_sided: int
    step: float
    low: Any
    high: Any
    name: bytes
    if TYPE_CHECKING:
        def __init__(self, *, one_sided: int = ..., step: SupportsFloat = ..., low: Any = ..., high: Any = ..., name: str | bytes = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("one_sided", c_int32),
        ("step", c_double),
        ("low", c_void_p),
        ("high", c_void_p),
        ("name", c_char * 24),
    ]
    field_docs = {
        "one_sided": ("", "1: steps on the high side only, half the cost, errors of first order in `step`, not second; default 0"),
        "step": ("unit of the parameter", "> 0: `high` has it this much above the sim, `low` this much below. Quantities that depend on it should change by 1e-9 .. 1e-6 of their scale: less is lost in rounding, of more the third power is felt"),
        "low": ("", "only read, and only by dmb_sensitivity_create"),
        "high": ("", "as `low`"),
        "name": ("", "for messages, ends with 0; default \"\""),
    }


class Operation(Sized):
    c_name, about = "dmb_operation", "For dmb_operation_usual, dmb_analysis_torque_drag, dmb_analysis_torque_drag_profile, dmb_analysis_friction_factor."
    struct_size: int
    reserved: int
    axial_speed: float
    rotary_speed: float
    weight_on_bit: float
    torque_on_bit: float
    if TYPE_CHECKING:
        def __init__(self, *, axial_speed: SupportsFloat = ..., rotary_speed: SupportsFloat = ..., weight_on_bit: SupportsFloat = ..., torque_on_bit: SupportsFloat = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("reserved", c_uint32),
        ("axial_speed", c_double),
        ("rotary_speed", c_double),
        ("weight_on_bit", c_double),
        ("torque_on_bit", c_double),
    ]
    field_docs = {
        "axial_speed": ("m/s", "along the hole, > 0 into it; about its axis; friction is along their sum at the pipe's surface; default 0"),
        "rotary_speed": ("rad/s", "along the hole, > 0 into it; about its axis; friction is along their sum at the pipe's surface; default 0"),
        "weight_on_bit": ("N", "on the string's end, towards the rig; default 0"),
        "torque_on_bit": ("N m", "against rotation, >= 0; default 0"),
    }


class TorqueDragRow(Sized):
    c_name, about = "dmb_torque_drag_row", "For dmb_analysis_torque_drag."
    struct_size: int
    locked: int
    depth: float
    hook_load: float
    torque: float
    transfer: float
    lowest_force: float
    lowest_at: float
    sinusoidal_share: float
    helical_share: float
    buckled_at: float
    helix_length: float
    yield_share: float
    yield_at: float
    stretch: float
    wind_up: float
    wall_force: float
    if TYPE_CHECKING:
        def __init__(self, *, locked: int = ..., depth: SupportsFloat = ..., hook_load: SupportsFloat = ..., torque: SupportsFloat = ..., transfer: SupportsFloat = ..., lowest_force: SupportsFloat = ..., lowest_at: SupportsFloat = ..., sinusoidal_share: SupportsFloat = ..., helical_share: SupportsFloat = ..., buckled_at: SupportsFloat = ..., helix_length: SupportsFloat = ..., yield_share: SupportsFloat = ..., yield_at: SupportsFloat = ..., stretch: SupportsFloat = ..., wind_up: SupportsFloat = ..., wall_force: SupportsFloat = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("locked", c_int32),
        ("depth", c_double),
        ("hook_load", c_double),
        ("torque", c_double),
        ("transfer", c_double),
        ("lowest_force", c_double),
        ("lowest_at", c_double),
        ("sinusoidal_share", c_double),
        ("helical_share", c_double),
        ("buckled_at", c_double),
        ("helix_length", c_double),
        ("yield_share", c_double),
        ("yield_at", c_double),
        ("stretch", c_double),
        ("wind_up", c_double),
        ("wall_force", c_double),
    ]
    field_docs = {
        "locked": ("", "1: compression exceeds 1 % of EA below the rig: no push does this; results at the rig are NaN"),
        "depth": ("m", "measured depth of the far end"),
        "hook_load": ("N", "effective axial force at the rig end, > 0: it pulls, < 0: it pushes"),
        "torque": ("N m", "at the rig end, against friction and bit"),
        "transfer": ("-", "share of a little more push at the rig that arrives at the bit; 1 without friction"),
        "lowest_force": ("N", "least effective axial force, most compressed where < 0"),
        "lowest_at": ("m", "measured depth where"),
        "sinusoidal_share": ("-", "largest share of the sinusoidal buckling load, as of a profile; NaN without wall force"),
        "helical_share": ("-", "the same of helical buckling"),
        "buckled_at": ("m", "measured depth where that is"),
        "helix_length": ("m", "of string above the load of helical buckling"),
        "yield_share": ("-", "largest von Mises stress over yield_strength, bending to the hole's curvature between rigid tool joints included; NaN where a pipe has no yield_strength; measured depth where"),
        "yield_at": ("m", "largest von Mises stress over yield_strength, bending to the hole's curvature between rigid tool joints included; NaN where a pipe has no yield_strength; measured depth where"),
        "stretch": ("m", "by the effective force, > 0 longer; of the rig end against the bit; tool joints rigid"),
        "wind_up": ("rad", "by the effective force, > 0 longer; of the rig end against the bit; tool joints rigid"),
        "wall_force": ("N", "sum over the string"),
    }


class Hydraulics(Sized):
    c_name, about = "dmb_hydraulics", "For dmb_analysis_hydraulics."
    struct_size: int
    reserved: int
    depth: float
    vertical_depth: float
    bore_loss: float
    bit_loss: float
    annulus_loss: float
    pump_pressure: float
    circulating_density: float
    trip_pressure: float
    surge_density: float
    swab_density: float
    reynolds: float
    if TYPE_CHECKING:
        def __init__(self, *, depth: SupportsFloat = ..., vertical_depth: SupportsFloat = ..., bore_loss: SupportsFloat = ..., bit_loss: SupportsFloat = ..., annulus_loss: SupportsFloat = ..., pump_pressure: SupportsFloat = ..., circulating_density: SupportsFloat = ..., trip_pressure: SupportsFloat = ..., surge_density: SupportsFloat = ..., swab_density: SupportsFloat = ..., reynolds: SupportsFloat = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("reserved", c_uint32),
        ("depth", c_double),
        ("vertical_depth", c_double),
        ("bore_loss", c_double),
        ("bit_loss", c_double),
        ("annulus_loss", c_double),
        ("pump_pressure", c_double),
        ("circulating_density", c_double),
        ("trip_pressure", c_double),
        ("surge_density", c_double),
        ("swab_density", c_double),
        ("reynolds", c_double),
    ]
    field_docs = {
        "depth": ("m", "measured depth of the far end"),
        "vertical_depth": ("m", "vertical one below the string's start, < 0 above"),
        "bore_loss": ("Pa", "friction in the string"),
        "bit_loss": ("Pa", "through nozzle_area"),
        "annulus_loss": ("Pa", "friction in the annulus"),
        "pump_pressure": ("Pa", "sum of the three and of the difference of the columns; motors are left out"),
        "circulating_density": ("kg/m3", "fluid_density + annulus_loss/(g vertical_depth); NaN if that is <= 0"),
        "trip_pressure": ("Pa", "of the closed string at the trip speed, more going in, less coming out"),
        "surge_density": ("kg/m3", "fluid_density +, - trip_pressure/(g vertical_depth), NaN if that is <= 0"),
        "swab_density": ("kg/m3", "fluid_density +, - trip_pressure/(g vertical_depth), NaN if that is <= 0"),
        "reynolds": ("-", "largest of bore, annulus and trip"),
    }


class FatigueOptions(Sized):
    c_name, about = "dmb_fatigue_options", "For dmb_fatigue_create."
    struct_size: int
    classes: int
    points: int
    reserved: int
    stress_range: float
    concentration: float
    curve_stress: float
    curve_cycles: float
    slope: float
    endurance: float
    tensile_strength: float
    if TYPE_CHECKING:
        def __init__(self, *, classes: int = ..., points: int = ..., stress_range: SupportsFloat = ..., concentration: SupportsFloat = ..., curve_stress: SupportsFloat = ..., curve_cycles: SupportsFloat = ..., slope: SupportsFloat = ..., endurance: SupportsFloat = ..., tensile_strength: SupportsFloat = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("classes", c_uint32),
        ("points", c_uint32),
        ("reserved", c_uint32),
        ("stress_range", c_double),
        ("concentration", c_double),
        ("curve_stress", c_double),
        ("curve_cycles", c_double),
        ("slope", c_double),
        ("endurance", c_double),
        ("tensile_strength", c_double),
    ]
    field_docs = {
        "classes": ("-", "levels of stress, 8 .. 65536; default 1024"),
        "points": ("-", "points around a section, 2 .. 360, the first on its y axis; default 8"),
        "stress_range": ("Pa", "levels spread over -stress_range .. stress_range, > 0; default 1e9"),
        "concentration": ("-", "factor on the stress, >= 1; default 1"),
        "curve_stress": ("Pa", "amplitude borne for curve_cycles, > 0; the user's, no default; cycles 1e6"),
        "curve_cycles": ("-", "amplitude borne for curve_cycles, > 0; the user's, no default; cycles 1e6"),
        "slope": ("-", "1 .. 50, the user's, no default"),
        "endurance": ("Pa", "amplitudes up to this do no damage, >= 0, default 0"),
        "tensile_strength": ("Pa", "of Goodman's rule, S/(1 - mean/tensile_strength) for a mean > 0; 0 (default): without"),
    }
    bounds = {
        "classes": ("within", 8, 65536),
        "points": ("within", 2, 360),
        "stress_range": ("within", 1, 1e+15),
        "concentration": ("within", 1, 100),
        "curve_stress": ("within", 1, 1e+15),
        "curve_cycles": ("within", 1, 1e+30),
        "slope": ("within", 1, 50),
        "endurance": ("within", 0, 1e+15),
        "tensile_strength": ("within", 0, 1e+15),
    }


class FatigueResult(Sized):
    c_name, about = "dmb_fatigue_result", "For dmb_fatigue_get."
    struct_size: int
    point: int
    samples: int
    clipped: int
    damage: float
    cycles: float
    largest_range: float
    lowest: float
    highest: float
    time: float
    life: float
    if TYPE_CHECKING:
        def __init__(self, *, point: int = ..., samples: int = ..., clipped: int = ..., damage: SupportsFloat = ..., cycles: SupportsFloat = ..., largest_range: SupportsFloat = ..., lowest: SupportsFloat = ..., highest: SupportsFloat = ..., time: SupportsFloat = ..., life: SupportsFloat = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("point", c_uint32),
        ("samples", c_uint64),
        ("clipped", c_uint64),
        ("damage", c_double),
        ("cycles", c_double),
        ("largest_range", c_double),
        ("lowest", c_double),
        ("highest", c_double),
        ("time", c_double),
        ("life", c_double),
    ]
    field_docs = {
        "point": ("-", "the point of the section with the largest damage, or else the largest range"),
        "samples": ("-", "taken"),
        "clipped": ("-", "of them beyond stress_range, at any point: cycles wholly beyond it are missed"),
        "damage": ("-", "1: the S-N curve is reached; cycles that are not closed count half; INFINITY where the mean stress of a cycle reaches tensile_strength: the section breaks at once"),
        "cycles": ("-", "at that point, halves included"),
        "largest_range": ("Pa", "largest range of them"),
        "lowest": ("Pa", "stresses at that point, concentration included"),
        "highest": ("Pa", "stresses at that point, concentration included"),
        "time": ("s", "between the first and the last sample"),
        "life": ("s", "time until damage 1 at this rate; INFINITY without damage, 0 with an infinite one"),
    }


LOG_FN = CFUNCTYPE(None, c_void_p, c_int32, c_char_p)
LOG_FN.__doc__ = "Called with a line of text, never during a step. The text lives only for the call."


TIME_FN = CFUNCTYPE(c_int32, c_void_p, c_double, POINTER(c_double))
TIME_FN.__doc__ = "out[0] = value, out[1] = its time derivative, out[2] = its integral from 0 to t. The callback must write out[0]; values that `provides` does not announce are computed by differences and quadrature. All within +-UNLIMITED. Nonzero stops."


ACCEPT_FN = CFUNCTYPE(None, c_void_p, c_double, c_uint32, POINTER(c_double))
ACCEPT_FN.__doc__ = "Called at each accepted step, just before the function of accepted steps (run.h). number: the contact point, 0 of a force."


CONSTRAINT_FN = CFUNCTYPE(c_int32, c_void_p, c_double, c_uint32, POINTER(c_double * 12), POINTER(c_double), POINTER(c_double))
CONSTRAINT_FN.__doc__ = "The function dmb_constraint_fn of the headers."


PART_FN = CFUNCTYPE(None, c_void_p, c_uint32)
PART_FN.__doc__ = "The function dmb_part_fn of the headers."


PROGRESS_FN = CFUNCTYPE(c_int32, c_void_p, c_double)
PROGRESS_FN.__doc__ = "[-] fraction, 0 .. 1, of the call that is done: never falls within a call, and is a guess where the work cannot be foreseen. Returns 0, or nonzero to end the call."


STEP_FN = CFUNCTYPE(c_int32, c_void_p, c_void_p)
STEP_FN.__doc__ = "Sees the sim after an accepted step; may query, record and save it, not change it. Nonzero ends the call."


class Place(Record):
    c_name, about = "dmb_place", "Frozen. A place on a part: a station of a string, or the reference point of a body. Made by dmb_station."
    part: Id
    pipe: int
    reserved: int
    fraction: float
    _fields_: ClassVar[Any] = [
        ("part", Id),
        ("pipe", c_uint32),
        ("reserved", c_uint32),
        ("fraction", c_double),
    ]
    field_docs = {
        "part": ("", "a string, a body or a bit"),
        "pipe": ("-", "pipe of the string, 0 at the rig end; 0 for a body"),
        "fraction": ("-", "0 at the rig end of the pipe .. 1 at its far end; 0 for a body"),
    }


class Segment(SegmentPart, Sized):
    c_name, about = "dmb_segment", "For dmb_model_add_time_function."
    struct_size: int
    kind: int
    x0: float
    x1: float
    h0: float
    h1: float
    omega: float
    phase: float
    table_time: Any
    table_value: Any
    table_count: int
    provides: int
    callback: Any
    callback_context: Any
    of: Id
    share: float
    order: float
    if TYPE_CHECKING:
        def __init__(self, table: Any = ..., function: Any = ..., *, kind: int = ..., x0: SupportsFloat = ..., x1: SupportsFloat = ..., h0: SupportsFloat = ..., h1: SupportsFloat = ..., omega: SupportsFloat = ..., phase: SupportsFloat = ..., table_time: Any = ..., table_value: Any = ..., table_count: int = ..., provides: int = ..., callback: Any = ..., callback_context: Any = ..., of: Id | None = ..., share: SupportsFloat = ..., order: SupportsFloat = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("kind", c_int32),
        ("x0", c_double),
        ("x1", c_double),
        ("h0", c_double),
        ("h1", c_double),
        ("omega", c_double),
        ("phase", c_double),
        ("table_time", POINTER(c_double)),
        ("table_value", POINTER(c_double)),
        ("table_count", c_uint32),
        ("provides", c_int32),
        ("callback", TIME_FN),
        ("callback_context", c_void_p),
        ("of", Id),
        ("share", c_double),
        ("order", c_double),
    ]
    field_docs = {
        "kind": ("", "SEGMENT_..., default SEGMENT_CONSTANT"),
        "x0": ("s", "start and end of STEP and STEP5, x1 > x0; default 0 and 1"),
        "x1": ("s", "start and end of STEP and STEP5, x1 > x0; default 0 and 1"),
        "h0": ("unit of the time function", "default 0 and 0"),
        "h1": ("unit of the time function", "default 0 and 0"),
        "omega": ("rad/s", "of HARMONIC; of HARMONIC and PER_REVOLUTION; default 0"),
        "phase": ("rad", "of HARMONIC; of HARMONIC and PER_REVOLUTION; default 0"),
        "table_time": ("s", "strictly increasing, shape (table_count); copied"),
        "table_value": ("unit of the time function", "shape (table_count); copied. First = last for PERIODIC"),
        "table_count": ("-", "1 .. 2^20; 2 .. 2^20 of PERIODIC, with a period of at least 1 us"),
        "provides": ("", "PROVIDES_..., of CALLBACK"),
        "callback": ("", "of CALLBACK; pure: same values for the same time, callable from any thread"),
        "callback_context": ("", ""),
        "of": ("", "of PER_REVOLUTION: a time function [rad/s] added before, of kinds other than CALLBACK and PER_REVOLUTION. It is followed as described; inputs (compile warns of them), dmb_sim_set_drive and limits of drives do not change it"),
        "share": ("-", "of PER_REVOLUTION: amplitude over w; default 0"),
        "order": ("-", "periods a revolution, > 0; default 1"),
    }


class PipeDef(Sized):
    c_name, about = "dmb_pipe_def", "For dmb_model_add_pipes."
    struct_size: int
    kind: int
    string: Id
    elements: int
    seed: int
    length: float
    outer_diameter: float
    inner_diameter: float
    young_modulus: float
    poisson_ratio: float
    density: float
    shear_factor: float
    damping_time: float
    joint_length: float
    joint_outer_diameter: float
    joint_inner_diameter: float
    joint_mass: float
    joint_inertia: Any
    eccentricity: float
    eccentricity_angle: float
    eccentricity_spread: float
    angle_spread: float
    curvature: Any
    section_stiffness: Any
    section_mass: float
    section_inertia: Any
    yield_strength: float
    name: bytes
    contact_points: int
    contact_reserved: int
    if TYPE_CHECKING:
        def __init__(self, *, kind: int = ..., string: Id | None = ..., elements: int = ..., seed: int = ..., length: SupportsFloat = ..., outer_diameter: SupportsFloat = ..., inner_diameter: SupportsFloat = ..., young_modulus: SupportsFloat = ..., poisson_ratio: SupportsFloat = ..., density: SupportsFloat = ..., shear_factor: SupportsFloat = ..., damping_time: SupportsFloat = ..., joint_length: SupportsFloat = ..., joint_outer_diameter: SupportsFloat = ..., joint_inner_diameter: SupportsFloat = ..., joint_mass: SupportsFloat = ..., joint_inertia: Iterable[float] = ..., eccentricity: SupportsFloat = ..., eccentricity_angle: SupportsFloat = ..., eccentricity_spread: SupportsFloat = ..., angle_spread: SupportsFloat = ..., curvature: Iterable[float] = ..., section_stiffness: Iterable[float] = ..., section_mass: SupportsFloat = ..., section_inertia: Iterable[float] = ..., yield_strength: SupportsFloat = ..., name: str | bytes = ..., contact_points: int = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("kind", c_int32),
        ("string", Id),
        ("elements", c_uint32),
        ("seed", c_uint32),
        ("length", c_double),
        ("outer_diameter", c_double),
        ("inner_diameter", c_double),
        ("young_modulus", c_double),
        ("poisson_ratio", c_double),
        ("density", c_double),
        ("shear_factor", c_double),
        ("damping_time", c_double),
        ("joint_length", c_double),
        ("joint_outer_diameter", c_double),
        ("joint_inner_diameter", c_double),
        ("joint_mass", c_double),
        ("joint_inertia", c_double * 2),
        ("eccentricity", c_double),
        ("eccentricity_angle", c_double),
        ("eccentricity_spread", c_double),
        ("angle_spread", c_double),
        ("curvature", c_double * 3),
        ("section_stiffness", c_double * 6),
        ("section_mass", c_double),
        ("section_inertia", c_double * 2),
        ("yield_strength", c_double),
        ("name", c_char * 24),
        ("contact_points", c_uint32),
        ("contact_reserved", c_uint32),
    ]
    field_docs = {
        "kind": ("", "PIPE_..., default PIPE_FLEXIBLE"),
        "string": ("", "where to append; {0, 0}: the model's first string, made if there is none"),
        "elements": ("-", "elements in a pipe, 1 .. 1024; default 1"),
        "seed": ("-", "seed of the random eccentricity; default 1"),
        "length": ("m", "of one pipe with its joint, > 0; default 1"),
        "outer_diameter": ("m", "the first > the second >= 0; default 0.073 and 0.061"),
        "inner_diameter": ("m", "the first > the second >= 0; default 0.073 and 0.061"),
        "young_modulus": ("Pa", "> 0; default 2.1e11"),
        "poisson_ratio": ("-", "-1 < nu < 0.5; default 0.3"),
        "density": ("kg/m3", "> 0; default 7850"),
        "shear_factor": ("-", "kappa in GA = kappa G A, > 0; default 0.5 (thin tube)"),
        "damping_time": ("s", "tau of stress-proportional damping s = K (d + tau d')/L; the damping ratio at f [Hz] is pi f tau; default 0: without damping vibrations of a run do not decay, and peaks of torque grow with its length; 1e-4 is usual for steel pipes in a hole"),
        "joint_length": ("m", "of the rigid tool joint at the far end of each pipe; 0: none; < length; default 0"),
        "joint_outer_diameter": ("m", "default 0: as the pipe"),
        "joint_inner_diameter": ("m", "default 0: as the pipe"),
        "joint_mass": ("kg", "0: from the diameters, length and density"),
        "joint_inertia": ("kg m2", "about its axis and across, at its centre, first <= twice the second; 0: by geometry"),
        "eccentricity": ("m", "distance of the pipe's centre of mass from its axis, >= 0; its angle from y towards z of the section frame; default 0"),
        "eccentricity_angle": ("rad", "distance of the pipe's centre of mass from its axis, >= 0; its angle from y towards z of the section frame; default 0"),
        "eccentricity_spread": ("m", "uniform random additions pipe by pipe, -spread .. spread, >= 0 (eccentricity cut at 0); default 0"),
        "angle_spread": ("rad", "uniform random additions pipe by pipe, -spread .. spread, >= 0 (eccentricity cut at 0); default 0"),
        "curvature": ("rad/m", "unstressed twist and curvature about x, y, z; default 0"),
        "section_stiffness": ("N, N, N, N m2, N m2, N m2", "EA, GA_y, GA_z, GJ, EI_y, EI_z; 0: from the diameters"),
        "section_mass": ("kg/m", "0: from the diameters"),
        "section_inertia": ("kg m", "rotary inertia per metre about x and across; 0: from the diameters; of a rigid pipe as a body about its axis <= twice across"),
        "yield_strength": ("Pa", "for the share of yield of a profile; 0 (default): not known"),
        "name": ("", "of the pipes that one call adds, for messages and dmb_model_find_pipes; default \"\""),
        "contact_points": ("-", "3, 4 or 5: flexible pipes meet the wall at as many Gauss-Lobatto points of each element, its ends among them, each for its weight of the length, tool joints for their own length at the far end; 0 (default): at nodes only, so that sections bear the weight w between them as those of a beam on these points: w L^2/12 at the nodes of pipes that lie on the wall, where contact along the elements gives 0"),
    }


class StabiliserDef(Sized):
    c_name, about = "dmb_stabiliser_def", "A stabiliser, centraliser or other body of revolution at any place of a string, rigid with the section of the pipe at its middle. Its mass and inertia are added to those of the pipe, which bends under it as before. It meets the wall at its middle, by the laws of the wall, as `length` metres of pipe of its diameter; the pipe keeps its own contact. It has a node of its own (examples/programming, Parts on strings). {its id, 0, 0}: its middle, in queries, loads, springs, joints, forces."
    struct_size: int
    pipe: int
    string: Id
    fraction: float
    outer_diameter: float
    length: float
    mass: float
    inertia: Any
    density: float
    name: bytes
    added_mass: Any
    if TYPE_CHECKING:
        def __init__(self, *, pipe: int = ..., string: Id | None = ..., fraction: SupportsFloat = ..., outer_diameter: SupportsFloat = ..., length: SupportsFloat = ..., mass: SupportsFloat = ..., inertia: Iterable[float] = ..., density: SupportsFloat = ..., name: str | bytes = ..., added_mass: Iterable[float] = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("pipe", c_uint32),
        ("string", Id),
        ("fraction", c_double),
        ("outer_diameter", c_double),
        ("length", c_double),
        ("mass", c_double),
        ("inertia", c_double * 2),
        ("density", c_double),
        ("name", c_char * 24),
        ("added_mass", c_double * 2),
    ]
    field_docs = {
        "pipe": ("-", "number along the string; default 0"),
        "string": ("", "{0, 0}: the model's first string"),
        "fraction": ("-", "0 .. 1 of the pipe's length: its middle; default 0.5"),
        "outer_diameter": ("m", "that meets the wall, >= outer diameter of the pipe, <= hole; default 0.09"),
        "length": ("m", "> 0; default 0.3"),
        "mass": ("kg", "0: of a hollow cylinder around the pipe, of `density`; default 0"),
        "inertia": ("kg m2", "about its axis and across, at the middle, first <= twice second; 0 (default): the cylinder's"),
        "density": ("kg/m3", "> 0, also for its buoyancy: its volume is mass/density; default 7850"),
        "name": ("", "for messages, ends with 0; default \"\""),
        "added_mass": ("kg", "of mud that moves with it, besides that of the pipe, along its axis and across, >= 0; default 0, and NOT_GIVEN across: by added_mass of the environment, of the mud it displaces beyond the pipe, its ends left out"),
    }


class BodyDef(Sized):
    c_name, about = "dmb_body_def", "For dmb_model_add_body, dmb_model_place_at_end."
    struct_size: int
    attach: int
    string: Id
    mass: float
    centre: Any
    inertia: Any
    position: Any
    rotation: Any
    velocity: Any
    free_mask: int
    reserved: int
    contact_diameter: float
    contact_length: float
    name: bytes
    displaced_volume: float
    added_mass: Any
    if TYPE_CHECKING:
        def __init__(self, *, attach: int = ..., string: Id | None = ..., mass: SupportsFloat = ..., centre: Iterable[float] = ..., inertia: Iterable[float] = ..., position: Iterable[float] = ..., rotation: Iterable[float] = ..., velocity: Iterable[float] = ..., free_mask: int = ..., contact_diameter: SupportsFloat = ..., contact_length: SupportsFloat = ..., name: str | bytes = ..., displaced_volume: SupportsFloat = ..., added_mass: Iterable[float] = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("attach", c_int32),
        ("string", Id),
        ("mass", c_double),
        ("centre", c_double * 3),
        ("inertia", c_double * 6),
        ("position", c_double * 3),
        ("rotation", c_double * 3),
        ("velocity", c_double * 6),
        ("free_mask", c_int32),
        ("reserved", c_int32),
        ("contact_diameter", c_double),
        ("contact_length", c_double),
        ("name", c_char * 24),
        ("displaced_volume", c_double),
        ("added_mass", c_double * 2),
    ]
    field_docs = {
        "attach": ("", "ATTACH_START (rig head) or _END: fixed to that end of `string`, no unknowns of its own, reference point and axes those of the end; ATTACH_NONE: a body of its own (default)"),
        "string": ("", "{0, 0}: the model's first string"),
        "mass": ("kg", "> 0; default 1"),
        "centre": ("m", "centre of mass from the reference point, body frame; default 0"),
        "inertia": ("kg m2", "xx, yy, zz, xy, xz, yz elements of the inertia matrix at the centre of mass, body axes, positive definite, no principal moment above the sum of the others by more than 1e-6 of itself; default 1e-3 on the diagonal"),
        "position": ("m", "reference point and rotation vector of a free body, world frame; default 0"),
        "rotation": ("rad", "reference point and rotation vector of a free body, world frame; default 0"),
        "velocity": ("m/s, rad/s", "of a free body at time 0, body frame; default 0"),
        "free_mask": ("-", "free components of a free body at its reference point; default FREE_ALL"),
        "contact_diameter": ("m", "of the contact ring at the reference point, 0: none; default 0"),
        "contact_length": ("m", "length of wall that it represents, > 0; default 1"),
        "name": ("", "for messages and look-up, ends with 0; default \"\""),
        "displaced_volume": ("m3", "that the fluid outside lifts at the centre of mass, >= 0; default 0"),
        "added_mass": ("kg", "added mass of mud along body x and across, at the x of the centre of mass, as of a body of revolution in mud at rest (sphere: half that displaced; disc along its axis: 8/3 rho r^3), weightless; >= 0; default 0"),
    }


class BitDef(Sized):
    c_name, about = "dmb_bit_def", "For dmb_model_add_bit."
    struct_size: int
    rock_law: int
    string: Id
    load: Id
    mass: float
    inertia: Any
    diameter: float
    length: float
    radius: float
    intrinsic_energy: float
    cutting_ratio: float
    contact_strength: float
    wear_length: float
    contact_friction: float
    intrusion_depth: float
    bottom: float
    blades: int
    history: int
    name: bytes
    side_cutting: float
    walk_angle: float
    displaced_volume: float
    stabiliser: Id
    inner_radius: float
    added_mass: Any
    if TYPE_CHECKING:
        def __init__(self, *, rock_law: int = ..., string: Id | None = ..., load: Id | None = ..., mass: SupportsFloat = ..., inertia: Iterable[float] = ..., diameter: SupportsFloat = ..., length: SupportsFloat = ..., radius: SupportsFloat = ..., intrinsic_energy: SupportsFloat = ..., cutting_ratio: SupportsFloat = ..., contact_strength: SupportsFloat = ..., wear_length: SupportsFloat = ..., contact_friction: SupportsFloat = ..., intrusion_depth: SupportsFloat = ..., bottom: SupportsFloat = ..., blades: int = ..., history: int = ..., name: str | bytes = ..., side_cutting: SupportsFloat = ..., walk_angle: SupportsFloat = ..., displaced_volume: SupportsFloat = ..., stabiliser: Id | None = ..., inner_radius: SupportsFloat = ..., added_mass: Iterable[float] = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("rock_law", c_int32),
        ("string", Id),
        ("load", Id),
        ("mass", c_double),
        ("inertia", c_double * 2),
        ("diameter", c_double),
        ("length", c_double),
        ("radius", c_double),
        ("intrinsic_energy", c_double),
        ("cutting_ratio", c_double),
        ("contact_strength", c_double),
        ("wear_length", c_double),
        ("contact_friction", c_double),
        ("intrusion_depth", c_double),
        ("bottom", c_double),
        ("blades", c_uint32),
        ("history", c_uint32),
        ("name", c_char * 24),
        ("side_cutting", c_double),
        ("walk_angle", c_double),
        ("displaced_volume", c_double),
        ("stabiliser", Id),
        ("inner_radius", c_double),
        ("added_mass", c_double * 2),
    ]
    field_docs = {
        "rock_law": ("", "ROCK_..., default ROCK_NONE"),
        "string": ("", "the bit is fixed to the far end of it; {0, 0}: the model's first string"),
        "load": ("N", "time function of the bottom-hole load along the axis, > 0 against the feed; {0, 0}: none"),
        "mass": ("kg", "> 0; default 5"),
        "inertia": ("kg m2", "about the axis and across, at the centre, first <= twice second; 0 (default): solid cylinder"),
        "diameter": ("m", "gauge that meets the wall, <= hole, 0: no contact; default 0.092"),
        "length": ("m", "> 0, centre at half of it beyond the string's end; default 0.1"),
        "radius": ("m", "a of the rock law, > 0; default 0.047"),
        "intrinsic_energy": ("Pa", "eps, > 0; default 1e7"),
        "cutting_ratio": ("-", "zeta, > 0; default 0.6"),
        "contact_strength": ("Pa", "sigma, >= 0; default 1e7"),
        "wear_length": ("m", "l, >= 0; default 1e-3"),
        "contact_friction": ("-", "the product mu gamma, >= 0; default 0.5"),
        "intrusion_depth": ("m", "over which the wear-flat force is taken up, > 0; default 1e-4"),
        "bottom": ("m", "bottom ahead of the bit at time 0, >= 0; default 0"),
        "blades": ("-", "1 .. 64; default 4"),
        "history": ("-", "samples of the cut surface, of REGENERATIVE, 64 .. 2^20; default 1024"),
        "name": ("", "for messages and look-up, ends with 0; default \"\""),
        "side_cutting": ("-", "steerability: depth of cut per revolution by a side force over that by the same axial force, d = F/(cutting_ratio intrinsic_energy radius), 0 .. 1e3, in the bit's own axes, on and off bottom, with any rock_law; the smaller, the more it drills along its own axis. The hole that it cuts does not act on the string: give the bit no `diameter`. No effect in statics at rest. 0 (default): no lateral force of the rock"),
        "walk_angle": ("rad", "from the side force to the direction of the cut, clockwise seen from the rig: > 0 takes a bit that is pushed upwards to the right (azimuth grows); -1.5 .. 1.5; default 0"),
        "displaced_volume": ("m3", "as of a body"),
        "stabiliser": ("", "{0, 0} (default): the bit at the string's end; a stabiliser: a reamer, whose cutting surface is at the middle of that stabiliser. The stabiliser has mass, buoyancy and contact; mass, inertia, diameter, length, displaced_volume and string are ignored, and `bottom` is the distance of the shoulder ahead. Weight on bit, torque and other driller's outputs are those of the bit"),
        "inner_radius": ("m", "b of the surface that is cut up to `radius`: pilot hole of a reamer, core of a core bit; 0 .. < radius. The rock law has a - b for a, a^2 - b^2 for a^2; default 0"),
        "added_mass": ("kg", "as of a body, at the bit's centre; a reamer's is that of its stabiliser; default 0"),
    }


class CouplingDef(Sized):
    c_name, about = "dmb_coupling_def", "A linear relation of two to four joint coordinates: coordinate 0 - ratio * coordinate 1 keeps its value of time 0. Gear: two revolutes; screw: X and RX of one cylindrical joint, ratio = lead/(2 pi). A third and a fourth one are subtracted too, each times its ratio. Differential: cage - 0.5 left - 0.5 right; planetary gear: carrier, sun, annulus gear; tackle: ropes."
    struct_size: int
    reserved: int
    name: bytes
    joint: 'Array[Id]'
    component: 'Array[c_int32]'
    ratio: float
    third_joint: Id
    fourth_joint: Id
    third_component: int
    fourth_component: int
    third_ratio: float
    fourth_ratio: float
    if TYPE_CHECKING:
        def __init__(self, *, name: str | bytes = ..., joint: Iterable[Any] = ..., component: Iterable[Any] = ..., ratio: SupportsFloat = ..., third_joint: Id | None = ..., fourth_joint: Id | None = ..., third_component: int = ..., fourth_component: int = ..., third_ratio: SupportsFloat = ..., fourth_ratio: SupportsFloat = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("reserved", c_uint32),
        ("name", c_char * 24),
        ("joint", Id * 2),
        ("component", c_int32 * 2),
        ("ratio", c_double),
        ("third_joint", Id),
        ("fourth_joint", Id),
        ("third_component", c_int32),
        ("fourth_component", c_int32),
        ("third_ratio", c_double),
        ("fourth_ratio", c_double),
    ]
    field_docs = {
        "name": ("", "for messages and look-up, ends with 0; default \"\""),
        "joint": ("", "may be the same"),
        "component": ("", "X .. RZ, free in its joint; default RX"),
        "ratio": ("-, m/rad, rad/m", "not 0; default 1"),
        "third_joint": ("", "{0, 0} (default): two coordinates, or three"),
        "fourth_joint": ("", "{0, 0} (default): two coordinates, or three"),
        "third_component": ("", "X .. RZ, free in its joint; default RX"),
        "fourth_component": ("", "X .. RZ, free in its joint; default RX"),
        "third_ratio": ("-, m/rad, rad/m", "not 0; default 1"),
        "fourth_ratio": ("-, m/rad, rad/m", "not 0; default 1"),
    }


class DriveDef(DrivePart, Sized):
    c_name, about = "dmb_drive_def", "For dmb_model_add_drive, dmb_motor_drive."
    struct_size: int
    kind: int
    part: Id
    component: int
    reserved: int
    time_function: Id
    excitation: Id
    value: float
    gain: float
    integral_gain: float
    limit_low: float
    limit_high: float
    name: bytes
    delay: float
    force_rate: float
    lag: float
    drag: float
    back_drag: float
    inertia: float
    curve_count: int
    reserved2: int
    curve_speed: Any
    curve_force: Any
    gain_count: int
    reserved3: int
    gain_error: Any
    gain_force: Any
    mud_pressure: float
    if TYPE_CHECKING:
        def __init__(self, curve: Any = ..., gain_table: Any = ..., *, kind: int = ..., part: Id | None = ..., component: int = ..., time_function: Id | None = ..., excitation: Id | None = ..., value: SupportsFloat = ..., gain: SupportsFloat = ..., integral_gain: SupportsFloat = ..., limit_low: SupportsFloat = ..., limit_high: SupportsFloat = ..., name: str | bytes = ..., delay: SupportsFloat = ..., force_rate: SupportsFloat = ..., lag: SupportsFloat = ..., drag: SupportsFloat = ..., back_drag: SupportsFloat = ..., inertia: SupportsFloat = ..., curve_count: int = ..., curve_speed: Iterable[float] = ..., curve_force: Iterable[float] = ..., gain_count: int = ..., gain_error: Iterable[float] = ..., gain_force: Iterable[float] = ..., mud_pressure: SupportsFloat = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("kind", c_int32),
        ("part", Id),
        ("component", c_int32),
        ("reserved", c_int32),
        ("time_function", Id),
        ("excitation", Id),
        ("value", c_double),
        ("gain", c_double),
        ("integral_gain", c_double),
        ("limit_low", c_double),
        ("limit_high", c_double),
        ("name", c_char * 24),
        ("delay", c_double),
        ("force_rate", c_double),
        ("lag", c_double),
        ("drag", c_double),
        ("back_drag", c_double),
        ("inertia", c_double),
        ("curve_count", c_uint32),
        ("reserved2", c_uint32),
        ("curve_speed", c_double * 8),
        ("curve_force", c_double * 8),
        ("gain_count", c_uint32),
        ("reserved3", c_uint32),
        ("gain_error", c_double * 16),
        ("gain_force", c_double * 16),
        ("mud_pressure", c_double),
    ]
    field_docs = {
        "kind": ("", "DRIVE_..., default DRIVE_MOTION"),
        "part": ("", "a string (its rig end), a body of its own, or a joint; {0, 0}: the model's first string"),
        "component": ("", "X (feed, default) .. RZ; must be free there; of a joint: its coordinate"),
        "time_function": ("", "{0, 0} (default): the constant `value`"),
        "excitation": ("", "added to it (vibration), {0, 0}: none"),
        "value": ("m/s, rad/s; N, N m of LOAD", "without a time function, 0 with one; default 0: MOTION holds its component"),
        "gain": ("N s/m, N m s", "kp; ki of CONTROL, >= 0; default 0"),
        "integral_gain": ("N/m, N m", "kp; ki of CONTROL, >= 0; default 0"),
        "limit_low": ("N, N m", "limit_high > limit_low; default -UNLIMITED and UNLIMITED"),
        "limit_high": ("N, N m", "limit_high > limit_low; default -UNLIMITED and UNLIMITED"),
        "name": ("", "for messages and look-up, ends with 0; default \"\""),
        "delay": ("s", "from command to force, 0 or 1e-6 .. 1e4; its largest rate, > 0; 0: jumps"),
        "force_rate": ("N/s, N m/s", "from command to force, 0 or 1e-6 .. 1e4; its largest rate, > 0; 0: jumps"),
        "lag": ("s", "time constant of the force, 0 or >= 1e-6"),
        "drag": ("N s/m, N m s", ">= 0, of the actuator at speeds > 0"),
        "back_drag": ("N s/m, N m s", ">= 0, at speeds < 0 (back-spin)"),
        "inertia": ("kg m2", ">= 0 of rotor and gear, turning with the component, RX of a string or a body; of MOTION too"),
        "curve_count": ("-", "points of the torque-speed curve: 0 (none) or 2 .. 8"),
        "curve_speed": ("m/s, rad/s", "strictly increasing, shape (curve_count)"),
        "curve_force": ("N, N m", ">= 0: largest force towards > 0 at a speed, linear between points, constant beyond; mirrored for forces < 0; shape (curve_count)"),
        "gain_count": ("-", "points of a table of CONTROL instead of `gain`, then 0: 0 (none) or 2 .. 16"),
        "gain_error": ("m/s, rad/s", "v* - v, strictly increasing, shape (gain_count)"),
        "gain_force": ("N, N m", "instead of kp (v* - v), straight between points, constant beyond, shape (gain_count)"),
        "mud_pressure": ("Pa/(N m)", "fall of the mud's pressure for each N m of a motor, >= 0, of RX of a joint, with a flow_rate at the far end of the string; by dmb_motor_drive; 0 (default): no mud flows through it"),
    }


class InputDef(Sized):
    c_name, about = "dmb_input_def", "For dmb_model_add_input."
    struct_size: int
    target: int
    name: bytes
    part: Id
    initial: float
    low: float
    high: float
    rate_limit: float
    slope_limit: float
    outside: int
    reserved: int
    if TYPE_CHECKING:
        def __init__(self, *, target: int = ..., name: str | bytes = ..., part: Id | None = ..., initial: SupportsFloat = ..., low: SupportsFloat = ..., high: SupportsFloat = ..., rate_limit: SupportsFloat = ..., slope_limit: SupportsFloat = ..., outside: int = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("target", c_int32),
        ("name", c_char * 24),
        ("part", Id),
        ("initial", c_double),
        ("low", c_double),
        ("high", c_double),
        ("rate_limit", c_double),
        ("slope_limit", c_double),
        ("outside", c_int32),
        ("reserved", c_int32),
    ]
    field_docs = {
        "target": ("", "TARGET_..., default TARGET_SET_POINT"),
        "name": ("", "required, unique among the inputs, ends with 0"),
        "part": ("", "drive, load, bit or stuck place; {0, 0} of wall and environment"),
        "initial": ("unit of the target", "at time 0, within the bounds; NaN (default): as described, until it is set: of SET_POINT, LOAD_FACTOR and BIT_LOAD by the time function"),
        "low": ("unit of the target", "bounds, low <= high; default -UNLIMITED, UNLIMITED: those of the target"),
        "high": ("unit of the target", "bounds, low <= high; default -UNLIMITED, UNLIMITED: those of the target"),
        "rate_limit": ("unit/s", "of SET_POINT, LOAD_FACTOR, BIT_LOAD: the most it changes in a second, > 0; 0 (default): it jumps. Required for the set point of a MOTION drive: largest acceleration"),
        "slope_limit": ("unit/s2", "the most that rate changes in a second, > 0 (largest jerk); 0 (default): it jumps. The value then reaches the set point in the least time that both limits allow"),
        "outside": ("", "OUTSIDE_...: a value beyond the bounds is refused (default) or taken for the bound"),
    }


class InputInfo(Sized):
    c_name, about = "dmb_input_info", "For dmb_model_get_input."
    struct_size: int
    target: int
    input: Id
    part: Id
    name: bytes
    unit: bytes
    low: float
    high: float
    rate_limit: float
    slope_limit: float
    if TYPE_CHECKING:
        def __init__(self, *, target: int = ..., input: Id | None = ..., part: Id | None = ..., name: str | bytes = ..., unit: str | bytes = ..., low: SupportsFloat = ..., high: SupportsFloat = ..., rate_limit: SupportsFloat = ..., slope_limit: SupportsFloat = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("target", c_int32),
        ("input", Id),
        ("part", Id),
        ("name", c_char * 24),
        ("unit", c_char * 16),
        ("low", c_double),
        ("high", c_double),
        ("rate_limit", c_double),
        ("slope_limit", c_double),
    ]
    field_docs = {
        "target": ("", "TARGET_..."),
        "input": ("", "its own id, and the part it acts on"),
        "part": ("", "its own id, and the part it acts on"),
        "name": ("", "ends with 0"),
        "unit": ("", "\"rad/s\", \"-\", ... ends with 0"),
        "low": ("", "bounds in force: the narrower of its own and those of the target"),
        "high": ("", "bounds in force: the narrower of its own and those of the target"),
        "rate_limit": ("", "bounds in force: the narrower of its own and those of the target"),
        "slope_limit": ("", "bounds in force: the narrower of its own and those of the target"),
    }


class Contact(Sized):
    c_name, about = "dmb_contact", "For dmb_query_contact."
    struct_size: int
    closed: int
    sticks: int
    number: int
    part: Id
    pipe: int
    reserved: int
    length: float
    gap: float
    normal: Any
    normal_force: float
    approach: float
    friction: Any
    slip: Any
    along: float
    if TYPE_CHECKING:
        def __init__(self, *, closed: int = ..., sticks: int = ..., number: int = ..., part: Id | None = ..., pipe: int = ..., length: SupportsFloat = ..., gap: SupportsFloat = ..., normal: Iterable[float] = ..., normal_force: SupportsFloat = ..., approach: SupportsFloat = ..., friction: Iterable[float] = ..., slip: Iterable[float] = ..., along: SupportsFloat = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("closed", c_int32),
        ("sticks", c_int32),
        ("number", c_uint32),
        ("part", Id),
        ("pipe", c_uint32),
        ("reserved", c_uint32),
        ("length", c_double),
        ("gap", c_double),
        ("normal", c_double * 3),
        ("normal_force", c_double),
        ("approach", c_double),
        ("friction", c_double * 2),
        ("slip", c_double * 2),
        ("along", c_double),
    ]
    field_docs = {
        "closed": ("", "1 when touching"),
        "sticks": ("", "1 when the bristle law holds it"),
        "number": ("-", "of the contact point, 0 .. info.contact_points - 1"),
        "part": ("", "string or body the contact point belongs to"),
        "pipe": ("-", "pipe whose far end it is, or that it is on; NONE for the rig end of the string"),
        "length": ("m", "of pipe it represents"),
        "gap": ("m", "to the wall, < 0 when penetrating"),
        "normal": ("-", "outward, from the axis to the wall, world frame"),
        "normal_force": ("N", "on the wall, >= 0"),
        "approach": ("m/s", "normal speed towards the wall"),
        "friction": ("N", "on the pipe: along its axis, along axis x normal; after a static start that assumed a slip (dmb_static_options) that of the equilibrium, until the next step"),
        "slip": ("m/s", "of the contact point on the wall, same directions"),
        "along": ("N", "on the pipe along its axis where the wall's diameter or stiffness changes (scene.h)"),
    }


class ProfileStruct(Sized):
    c_name, about = "dmb_profile", "For dmb_query_profile, dmb_query_profile_extremes."
    struct_size: int
    station_count: int
    string: Id
    distance: Any
    quantities: Any
    quantity_count: int
    reserved: int
    values: Any
    station_stride: int
    quantity_stride: int
    if TYPE_CHECKING:
        def __init__(self, *, station_count: int = ..., string: Id | None = ..., distance: Any = ..., quantities: Any = ..., quantity_count: int = ..., values: Any = ..., station_stride: int = ..., quantity_stride: int = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("station_count", c_uint32),
        ("string", Id),
        ("distance", POINTER(c_double)),
        ("quantities", POINTER(c_int32)),
        ("quantity_count", c_uint32),
        ("reserved", c_uint32),
        ("values", POINTER(c_double)),
        ("station_stride", c_uint64),
        ("quantity_stride", c_uint64),
    ]
    field_docs = {
        "station_count": ("-", "1 .. 2^24"),
        "string": ("", "{0, 0}: the model's first string"),
        "distance": ("m", "of the stations along the string, 0 .. its length, any order, shape (station_count); NULL: spread evenly from the rig end to the far end"),
        "quantities": ("", "PROFILE_..., shape (quantity_count)"),
        "quantity_count": ("-", "1 .. the number of them; repetitions allowed"),
        "values": ("", "the caller's; value of quantity q at station i is values[i * station_stride + q * quantity_stride]"),
        "station_stride": ("-", "in doubles, both 0 (default): quantity_count and 1"),
        "quantity_stride": ("-", "in doubles, both 0 (default): quantity_count and 1"),
    }


class BucklingOptions(Sized):
    c_name, about = "dmb_buckling_options", "For dmb_analysis_buckling."
    struct_size: int
    count: int
    scale: int
    follow: int
    part: Id
    factor_max: float
    tolerance: float
    step: float
    slip_axial: float
    slip_rotation: float
    if TYPE_CHECKING:
        def __init__(self, *, count: int = ..., scale: int = ..., follow: int = ..., part: Id | None = ..., factor_max: SupportsFloat = ..., tolerance: SupportsFloat = ..., step: SupportsFloat = ..., slip_axial: SupportsFloat = ..., slip_rotation: SupportsFloat = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("count", c_uint32),
        ("scale", c_int32),
        ("follow", c_int32),
        ("part", Id),
        ("factor_max", c_double),
        ("tolerance", c_double),
        ("step", c_double),
        ("slip_axial", c_double),
        ("slip_rotation", c_double),
    ]
    field_docs = {
        "count": ("-", "of critical factors wanted, 1 .. 10000; default 1"),
        "scale": ("", "SCALE_..., default SCALE_LOADS"),
        "follow": ("", "1 (default): along the equilibria to the lowest factor; 0: extrapolated from the present state alone"),
        "part": ("", "load or drive of SCALE_PART"),
        "factor_max": ("unit of the factor", "largest sought, > 0; default 1e12"),
        "tolerance": ("-", "relative, 1e-15 .. 0.1; default 1e-10"),
        "step": ("unit of the factor", "difference for the change of the stiffness; 0 (default): strings move by 1e-6 elements"),
        "slip_axial": ("m/s", "friction as in dmb_static_options, the stiffness is unsymmetric then"),
        "slip_rotation": ("rad/s", "friction as in dmb_static_options, the stiffness is unsymmetric then"),
    }
    bounds = {
        "count": ("within", 1, 10000),
        "scale": ("within", 0, 2),
        "follow": ("within", 0, 1),
        "factor_max": ("within", 1e-300, 1e+300),
        "tolerance": ("within", 1e-15, 0.1),
        "step": ("within", 0, 1e+30),
        "slip_axial": ("within", -1000000, 1000000),
        "slip_rotation": ("within", -1000000, 1000000),
    }


class SpeedsOptions(Sized):
    c_name, about = "dmb_speeds_options", "For dmb_analysis_speeds."
    struct_size: int
    points: int
    speed_low: float
    speed_high: float
    threshold: float
    margin: float
    refinement: int
    contact: int
    friction: int
    reserved: int
    contact_gap: float
    structural_damping: float
    equilibrium_tolerance: float
    report: Any
    spin: float
    if TYPE_CHECKING:
        def __init__(self, *, points: int = ..., speed_low: SupportsFloat = ..., speed_high: SupportsFloat = ..., threshold: SupportsFloat = ..., margin: SupportsFloat = ..., refinement: int = ..., contact: int = ..., friction: int = ..., contact_gap: SupportsFloat = ..., structural_damping: SupportsFloat = ..., equilibrium_tolerance: SupportsFloat = ..., report: Any = ..., spin: SupportsFloat = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("points", c_uint32),
        ("speed_low", c_double),
        ("speed_high", c_double),
        ("threshold", c_double),
        ("margin", c_double),
        ("refinement", c_uint32),
        ("contact", c_int32),
        ("friction", c_int32),
        ("reserved", c_int32),
        ("contact_gap", c_double),
        ("structural_damping", c_double),
        ("equilibrium_tolerance", c_double),
        ("report", POINTER(SpeedsReport)),
        ("spin", c_double),
    ]
    field_docs = {
        "points": ("-", "of the grid of speeds, 2 .. 1e5; default 200"),
        "speed_low": ("rad/s", "> 0, the second above the first; default 1 and 30"),
        "speed_high": ("rad/s", "> 0, the second above the first; default 1 and 30"),
        "threshold": ("-", "severity above which a speed is to be avoided, > 0; default 1"),
        "margin": ("-", "by which bands are wider on both sides, part of the speed, 0 .. 0.5; default 0.03"),
        "refinement": ("-", "as of a response, for each order; default 12"),
        "contact": ("", "CONTACT_..., as of a response"),
        "friction": ("", "1: as of a response; 0 (default): left out: while a string turns, its slope is close to 0"),
        "contact_gap": ("m", "as of a response, same defaults"),
        "structural_damping": ("-", "as of a response, same defaults"),
        "equilibrium_tolerance": ("-", "as of a response, same defaults"),
        "report": ("", "written where the call succeeds; NULL (default): none"),
        "spin": ("rad/s", "as of dmb_response_options; default 0. After a static state with slip_rotation of this speed and friction 1 the string lies where friction carries it; eccentric masses are out of balance there: equilibrium_tolerance"),
    }
    bounds = {
        "points": ("within", 2, 100000),
        "speed_low": ("within", 1e-06, 1000000),
        "speed_high": ("within", 1e-06, 1000000),
        "threshold": ("within", 1e-09, 1000000000),
        "margin": ("within", 0, 0.5),
        "refinement": ("within", 0, 40),
        "contact": ("within", 0, 2),
        "friction": ("within", 0, 1),
        "contact_gap": ("within", 0, 1000000),
        "structural_damping": ("within", 0, 1000),
        "equilibrium_tolerance": ("within", 1e-06, 1),
        "spin": ("within", -1000000, 1000000),
    }


class Row(Sized):
    c_name, about = "dmb_row", "For dmb_query_row."
    struct_size: int
    component: int
    part: Id
    pipe: int
    node: int
    state: int
    reserved: int
    if TYPE_CHECKING:
        def __init__(self, *, component: int = ..., part: Id | None = ..., pipe: int = ..., node: int = ..., state: int = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("component", c_int32),
        ("part", Id),
        ("pipe", c_uint32),
        ("node", c_uint32),
        ("state", c_int32),
        ("reserved", c_int32),
    ]
    field_docs = {
        "component": ("", "X .. RZ of the body-frame velocity"),
        "part": ("", "string or body that the node belongs to"),
        "pipe": ("-", "of the string, the one before the node"),
        "node": ("-", "number of the node"),
        "state": ("", "ROW_FREE, held by a support, or driven by a motion drive"),
    }


class TorqueDragOptions(Sized):
    c_name, about = "dmb_torque_drag_options", "For dmb_analysis_torque_drag, dmb_analysis_torque_drag_profile, dmb_analysis_friction_factor."
    struct_size: int
    post_buckling: int
    string: Id
    friction: float
    depths: Any
    depth_count: int
    friction_by_depth: int
    if TYPE_CHECKING:
        def __init__(self, *, post_buckling: int = ..., string: Id | None = ..., friction: SupportsFloat = ..., depths: Any = ..., depth_count: int = ..., friction_by_depth: int = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("post_buckling", c_int32),
        ("string", Id),
        ("friction", c_double),
        ("depths", POINTER(c_double)),
        ("depth_count", c_uint32),
        ("friction_by_depth", c_int32),
    ]
    field_docs = {
        "post_buckling": ("", "1 (default): a helix presses r F^2/(4 EI) per metre more on the wall (Mitchell 1986) where the compression F is above the load of helical buckling; 0: not"),
        "string": ("", "{0, 0}: the model's first string"),
        "friction": ("-", "coefficient of all the hole, 0 .. 10; NOT_GIVEN (default): the wall's mu_dynamic at each depth"),
        "depths": ("m", "measured depths of the string's far end, shape (depth_count), beyond its start_depth by at most its length; NULL: one, where it ends as described"),
        "depth_count": ("-", "1 .. 2^20; default 1"),
        "friction_by_depth": ("", "of dmb_analysis_friction_factor: 0 (default): it finds one coefficient for all the hole; 1: the factor on the wall's mu_dynamic at each depth (scene.h)"),
    }
    bounds = {
        "post_buckling": ("within", 0, 1),
        "friction": ("not_given_or", 0, 10),
        "depth_count": ("within", 1, 1048576),
        "friction_by_depth": ("within", 0, 1),
    }


ERROR_FN = CFUNCTYPE(None, c_void_p, POINTER(ErrorStruct))
ERROR_FN.__doc__ = "Sees each failing call on a model and its sims, at its end and in its thread; may not change them."


FRICTION_FN = CFUNCTYPE(c_int32, c_void_p, POINTER(FrictionAt), POINTER(c_double), POINTER(c_double), POINTER(c_double), POINTER(LawMemory))
FRICTION_FN.__doc__ = "The caller's friction at a contact point: force [N] on the pipe, by_slip (2, 2) and by_normal (2) its derivatives by slip and normal force with the state taken along (consistent tangent); all 0 when called. The state is that of the point and 0 whenever it begins to touch. memory->step = INFINITY asks for the friction of steady sliding at this slip, from any state: statics that slip, linear analyses, drives that move steadily. Returns 0, or nonzero to stop. Pure, from the thread of the call."


FORCE_FN = CFUNCTYPE(c_int32, c_void_p, c_double, c_uint32, POINTER(c_double * 12), POINTER(c_double * 6), POINTER(c_double * 6), POINTER(c_double), POINTER(c_double), POINTER(LawMemory))
FORCE_FN.__doc__ = "The function dmb_force_fn of the headers."


PARALLEL_FN = CFUNCTYPE(c_int32, c_void_p, c_uint32, PART_FN, c_void_p)
PARALLEL_FN.__doc__ = "Long strings on several cores, with threads of the caller's (examples/programming, Threads; examples/two_cores). It calls part(work, i) once for each i < count, in any threads and order, and returns 0 when all have returned; another value, or parts left out, end the step with ERR_CALLBACK, the sim unchanged. Results have the same bits in any number of parts."


PATH_FN = CFUNCTYPE(c_int32, c_void_p, c_void_p, POINTER(PathPoint))
PATH_FN.__doc__ = "Called at each point with a sim that is there at rest: every query works, snapshots may be taken and, after the call, restored into the sim the path began with. Returns 0, or nonzero to stop."


class ModelOptions(Sized):
    c_name, about = "dmb_model_options", "For dmb_model_create, dmb_model_read."
    struct_size: int
    reserved: int
    allocator: Any
    log: Any
    log_context: Any
    on_error: Any
    error_context: Any
    if TYPE_CHECKING:
        def __init__(self, *, allocator: Any = ..., log: Any = ..., log_context: Any = ..., on_error: Any = ..., error_context: Any = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("reserved", c_uint32),
        ("allocator", POINTER(Allocator)),
        ("log", LOG_FN),
        ("log_context", c_void_p),
        ("on_error", ERROR_FN),
        ("error_context", c_void_p),
    ]
    field_docs = {
        "allocator": ("", "copied; NULL: malloc and free"),
        "log": ("", "NULL: silent"),
        "log_context": ("", ""),
        "on_error": ("", "NULL: none"),
        "error_context": ("", ""),
    }


class WallDef(WallPart, Sized):
    c_name, about = "dmb_wall_def", "For dmb_model_add_wall."
    struct_size: int
    survey_count: int
    survey: Any
    origin: Any
    direction: Any
    diameter: float
    normal_law: int
    friction_law: int
    stiffness: float
    exponent: float
    restitution: float
    damping: float
    impact_depth: float
    approach_speed: float
    mu_static: float
    mu_dynamic: float
    stribeck_speed: float
    smoothing_speed: float
    full_speed: float
    bristle_stiffness: float
    bristle_damping: float
    name: bytes
    cut_spacing: float
    cut_start: float
    cut_end: float
    friction_table_count: int
    friction_state_count: int
    friction_table_speed: Any
    friction_table_mu: Any
    friction_callback: Any
    friction_context: Any
    friction_accept: Any
    if TYPE_CHECKING:
        def __init__(self, stations: Any = ..., friction_table: Any = ..., *, survey_count: int = ..., survey: Any = ..., origin: Iterable[float] = ..., direction: Iterable[float] = ..., diameter: SupportsFloat = ..., normal_law: int = ..., friction_law: int = ..., stiffness: SupportsFloat = ..., exponent: SupportsFloat = ..., restitution: SupportsFloat = ..., damping: SupportsFloat = ..., impact_depth: SupportsFloat = ..., approach_speed: SupportsFloat = ..., mu_static: SupportsFloat = ..., mu_dynamic: SupportsFloat = ..., stribeck_speed: SupportsFloat = ..., smoothing_speed: SupportsFloat = ..., full_speed: SupportsFloat = ..., bristle_stiffness: SupportsFloat = ..., bristle_damping: SupportsFloat = ..., name: str | bytes = ..., cut_spacing: SupportsFloat = ..., cut_start: SupportsFloat = ..., cut_end: SupportsFloat = ..., friction_table_count: int = ..., friction_state_count: int = ..., friction_table_speed: Iterable[float] = ..., friction_table_mu: Iterable[float] = ..., friction_callback: Any = ..., friction_context: Any = ..., friction_accept: Any = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("survey_count", c_uint32),
        ("survey", POINTER(c_double)),
        ("origin", c_double * 3),
        ("direction", c_double * 3),
        ("diameter", c_double),
        ("normal_law", c_int32),
        ("friction_law", c_int32),
        ("stiffness", c_double),
        ("exponent", c_double),
        ("restitution", c_double),
        ("damping", c_double),
        ("impact_depth", c_double),
        ("approach_speed", c_double),
        ("mu_static", c_double),
        ("mu_dynamic", c_double),
        ("stribeck_speed", c_double),
        ("smoothing_speed", c_double),
        ("full_speed", c_double),
        ("bristle_stiffness", c_double),
        ("bristle_damping", c_double),
        ("name", c_char * 24),
        ("cut_spacing", c_double),
        ("cut_start", c_double),
        ("cut_end", c_double),
        ("friction_table_count", c_uint32),
        ("friction_state_count", c_uint32),
        ("friction_table_speed", c_double * 8),
        ("friction_table_mu", c_double * 8),
        ("friction_callback", FRICTION_FN),
        ("friction_context", c_void_p),
        ("friction_accept", ACCEPT_FN),
    ]
    field_docs = {
        "survey_count": ("-", "0 (straight hole along `direction`), or 2 .. 2^16"),
        "survey": ("m, rad, rad", "measured depth, inclination from the downward vertical (0 .. pi), azimuth clockwise seen from above, from +x (north) towards -y (east), -2 pi .. 2 pi; depths strictly increasing; minimum curvature between stations, straight on beyond the last one; shape (survey_count, 3); copied"),
        "origin": ("m", "start of the axis, world frame; default 0"),
        "direction": ("-", "of a straight hole, any length, world frame; default (1, 0, 0)"),
        "diameter": ("m", "of the hole, > 0; default 0.094"),
        "normal_law": ("", "NORMAL_...; default NORMAL_EXACT"),
        "friction_law": ("", "FRICTION_...; default FRICTION_STRIBECK"),
        "stiffness": ("N/m^(n+1)", "K per metre of pipe, > 0; default 1e7. Bounces that fixed steps h do not resolve, h w > 1.4 with w^2 = K l/m, gain no energy, but their restitution is not that of the law; dmb_statistics.bounces counts them"),
        "exponent": ("-", "n, 1 .. 3; default 1"),
        "restitution": ("-", "e, 0 .. 1 (> 0 for FLORES); default 0.4. EXACT returns this speed ratio, 1e-3 for less; HUNT_CROSSLEY returns 0.768, 0.620, 0.516 for 0.7, 0.4, 0.1"),
        "damping": ("N s/m2", "c per metre of pipe, of KELVIN_VOIGT and IMPACT; default 0"),
        "impact_depth": ("m", "penetration of full damping, of IMPACT; default 1e-4"),
        "approach_speed": ("m/s", "floor of v0, > 0; default 0.01. Slower impacts return more than e (EXACT, 0.4: 0.878 at 1 mm/s); with less, lasting contacts (damped by K d mu/v0) iterate more"),
        "mu_static": ("-", "largest friction over normal force, >= mu_dynamic; default 0.35. Up to it STRIBECK creeps, at most at 2.1 smoothing_speed with the defaults, and BRISTLE sticks"),
        "mu_dynamic": ("-", ">= 0; default 0.30"),
        "stribeck_speed": ("m/s", "> 0; default 1e-2, 1e-3"),
        "smoothing_speed": ("m/s", "> 0; default 1e-2, 1e-3"),
        "full_speed": ("m/s", "of AMBROSIO, > smoothing_speed; default 1e-2"),
        "bristle_stiffness": ("1/m", "> 0; default 1e4"),
        "bristle_damping": ("s/m", ">= 0, tangential, over normal force; default 0"),
        "name": ("", "for messages and look-up, ends with 0; default \"\""),
        "cut_spacing": ("m", "> 0: bits and reamers with a rock law leave a hole of their diameter behind, where it is wider than described: round, about the described axis. Kept at stations this far apart; the wall goes over from one to the next within it. Beyond the face that cuts and up to two spacings the hole is as described, which is the pilot hole of a reamer. At most 2^18 stations. 0 (default): the hole stays as described"),
        "cut_start": ("m", "measured depths of first and last station, >= 3 spacings apart: no cut beyond; default 0"),
        "cut_end": ("m", "measured depths of first and last station, >= 3 spacings apart: no cut beyond; default 0"),
        "friction_table_count": ("-", "points, 2 .. 8, of a table of STRIBECK and BRISTLE for mu_static (its first coefficient), mu_dynamic (its last one) and stribeck_speed; 0 (default): none. Sections of the hole give mu_dynamic alone, and the table acts in proportion"),
        "friction_state_count": ("-", "numbers of its state at a contact point, 0 .. 16; default 0"),
        "friction_table_speed": ("m/s", "of sliding, from 0, strictly increasing, shape (friction_table_count); static until v_c: 0, v_c and slightly more with mu_static, mu_static, mu_dynamic"),
        "friction_table_mu": ("-", ">= 0, last > 0; straight between, constant beyond; shape as the speeds"),
        "friction_callback": ("", "of FRICTION_CALLBACK, required"),
        "friction_context": ("", ""),
        "friction_accept": ("", "for each contact point; NULL (default): none"),
    }


class JointDef(Sized):
    c_name, about = "dmb_joint_def", "For dmb_model_add_joint."
    struct_size: int
    kind: int
    name: bytes
    place_a: Place
    place_b: Place
    origin_a: Any
    axis_a: Any
    normal_a: Any
    origin_b: Any
    axis_b: Any
    normal_b: Any
    match: int
    state: int
    length: float
    stiffness: Any
    damping: Any
    rest: Any
    friction: Any
    friction_speed: float
    stop_low: Any
    stop_high: Any
    stop_stiffness: float
    stop_damping: float
    initial_mask: int
    reserved: int
    initial_position: Any
    initial_speed: Any
    if TYPE_CHECKING:
        def __init__(self, *, kind: int = ..., name: str | bytes = ..., place_a: Place | Id | None = ..., place_b: Place | Id | None = ..., origin_a: Iterable[float] = ..., axis_a: Iterable[float] = ..., normal_a: Iterable[float] = ..., origin_b: Iterable[float] = ..., axis_b: Iterable[float] = ..., normal_b: Iterable[float] = ..., match: int = ..., state: int = ..., length: SupportsFloat = ..., stiffness: Iterable[float] = ..., damping: Iterable[float] = ..., rest: Iterable[float] = ..., friction: Iterable[float] = ..., friction_speed: SupportsFloat = ..., stop_low: Iterable[float] = ..., stop_high: Iterable[float] = ..., stop_stiffness: SupportsFloat = ..., stop_damping: SupportsFloat = ..., initial_mask: int = ..., initial_position: Iterable[float] = ..., initial_speed: Iterable[float] = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("kind", c_int32),
        ("name", c_char * 24),
        ("place_a", Place),
        ("place_b", Place),
        ("origin_a", c_double * 3),
        ("axis_a", c_double * 3),
        ("normal_a", c_double * 3),
        ("origin_b", c_double * 3),
        ("axis_b", c_double * 3),
        ("normal_b", c_double * 3),
        ("match", c_int32),
        ("state", c_int32),
        ("length", c_double),
        ("stiffness", c_double * 6),
        ("damping", c_double * 6),
        ("rest", c_double * 6),
        ("friction", c_double * 6),
        ("friction_speed", c_double),
        ("stop_low", c_double * 6),
        ("stop_high", c_double * 6),
        ("stop_stiffness", c_double),
        ("stop_damping", c_double),
        ("initial_mask", c_int32),
        ("reserved", c_int32),
        ("initial_position", c_double * 6),
        ("initial_speed", c_double * 6),
    ]
    field_docs = {
        "kind": ("", "JOINT_..., default JOINT_FIXED"),
        "name": ("", "for messages and look-up, ends with 0; default \"\""),
        "place_a": ("", "node of a string (pipe end, element end), a body or a bit; part {0, 0}: the ground"),
        "place_b": ("", "node, body or bit as place_a, not the ground"),
        "origin_a": ("m", "of frame a, in the frame of place a (ground: world); default 0"),
        "axis_a": ("-", "its x axis, any length > 0; default (1, 0, 0)"),
        "normal_a": ("-", "its y axis, made perpendicular to x; 0 (default): y of the place, or z if x is along that"),
        "origin_b": ("m", "of frame b, in the frame of place b"),
        "axis_b": ("-", "its x and y axis, as of a"),
        "normal_b": ("-", "its x and y axis, as of a"),
        "match": ("", "1: frame b is where frame a is as described, without origin_b, axis_b, normal_b; 0 (default): as given"),
        "state": ("", "JOINT_... at time 0; default JOINT_ACTIVE"),
        "length": ("m", "of DISTANCE, radius of ROLLING; > 0; default 1"),
        "stiffness": ("N/m, N m/rad", "of springs along the coordinates, >= 0; default 0"),
        "damping": ("N s/m, N m s", ">= 0; not there without FEATURE_DAMPING; default 0"),
        "rest": ("m, rad", "where the springs are unstressed; default 0"),
        "friction": ("N, N m", "independent of the reaction, >= 0; not there without FEATURE_FRICTION; default 0"),
        "friction_speed": ("m/s, rad/s", "over which friction is smoothed, f s/sqrt(s^2 + friction_speed^2), > 0; default 1e-3"),
        "stop_low": ("m, rad", "stop_high > stop_low; default -UNLIMITED and UNLIMITED"),
        "stop_high": ("m, rad", "stop_high > stop_low; default -UNLIMITED and UNLIMITED"),
        "stop_stiffness": ("N/m, N m/rad", "> 0; default 1e6"),
        "stop_damping": ("N s/m, N m s", "in the stop, never pulling, >= 0; default 0"),
        "initial_mask": ("-", "set of coordinates that are given below, FREE_X ...; they must be free, and no more than 6 with the joint's equations: 5 of KNIFE_EDGE and DISTANCE, 3 of ROLLING, none of a joint described locked; of one described open they count all the same; default FREE_NONE"),
        "initial_position": ("m, rad", "at time 0"),
        "initial_speed": ("m/s, rad/s", "at time 0"),
    }


class ConstraintDef(ConstraintPart, Sized):
    c_name, about = "dmb_constraint_def", "For dmb_model_add_constraint."
    struct_size: int
    kind: int
    name: bytes
    row_count: int
    place_count: int
    place: 'Array[Place]'
    provides: int
    reserved: int
    callback: Any
    callback_context: Any
    if TYPE_CHECKING:
        def __init__(self, places: Any = ..., function: Any = ..., *, kind: int = ..., name: str | bytes = ..., row_count: int = ..., place_count: int = ..., place: Iterable[Any] = ..., provides: int = ..., callback: Any = ..., callback_context: Any = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("kind", c_int32),
        ("name", c_char * 24),
        ("row_count", c_uint32),
        ("place_count", c_uint32),
        ("place", Place * 4),
        ("provides", c_int32),
        ("reserved", c_int32),
        ("callback", CONSTRAINT_FN),
        ("callback_context", c_void_p),
    ]
    field_docs = {
        "kind": ("", "CONSTRAINT_..., default CONSTRAINT_HOLONOMIC"),
        "name": ("", "for messages and look-up, ends with 0; default \"\""),
        "row_count": ("-", "equations, 1 .. 6; default 1"),
        "place_count": ("-", "1 .. 4; default 1"),
        "place": ("", "as of a joint, not the ground, shape (place_count)"),
        "provides": ("", "PROVIDES_JACOBIAN or 0 (default): built by differences. Nonholonomic must provide it. A Jacobian of its own is compared with differences when a sim is made: ERR_CALLBACK"),
        "callback": ("", "required"),
        "callback_context": ("", ""),
    }


class LoadDef(Sized):
    c_name, about = "dmb_load_def", "For dmb_model_add_load."
    struct_size: int
    frame: int
    place: Place
    force: Any
    moment: Any
    time_function: Id
    name: bytes
    offset: Any
    if TYPE_CHECKING:
        def __init__(self, *, frame: int = ..., place: Place | Id | None = ..., force: Iterable[float] = ..., moment: Iterable[float] = ..., time_function: Id | None = ..., name: str | bytes = ..., offset: Iterable[float] = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("frame", c_int32),
        ("place", Place),
        ("force", c_double * 3),
        ("moment", c_double * 3),
        ("time_function", Id),
        ("name", c_char * 24),
        ("offset", c_double * 3),
    ]
    field_docs = {
        "frame": ("", "FRAME_WORLD: dead load (default); FRAME_BODY: follower"),
        "place": ("", "any place of a pipe, or a body; inside an element it gets a node, which divides the element. Within a quarter of the pipe's diameter of a node it acts by the element's interpolation"),
        "force": ("N", "in `frame`"),
        "moment": ("N m", "in `frame`"),
        "time_function": ("-", "factor over time; {0, 0}: 1"),
        "name": ("", "for messages and look-up, ends with 0; default \"\""),
        "offset": ("m", "of the point where it acts from the place, in its axes; default 0"),
    }


class SpringDef(SpringPart, Sized):
    c_name, about = "dmb_spring_def", "Spring and damper between two points, tension > 0: preload + stiffness e + table(e) + damping e', e the elongation beyond free_length; its length is sqrt(d^2 + (1e-9 m)^2), since points that meet have no direction."
    struct_size: int
    acts: int
    name: bytes
    place_a: Place
    place_b: Place
    offset_a: Any
    offset_b: Any
    free_length: float
    stiffness: float
    damping: float
    preload: float
    table_elongation: Any
    table_force: Any
    table_count: int
    table_kind: int
    if TYPE_CHECKING:
        def __init__(self, table: Any = ..., *, acts: int = ..., name: str | bytes = ..., place_a: Place | Id | None = ..., place_b: Place | Id | None = ..., offset_a: Iterable[float] = ..., offset_b: Iterable[float] = ..., free_length: SupportsFloat = ..., stiffness: SupportsFloat = ..., damping: SupportsFloat = ..., preload: SupportsFloat = ..., table_elongation: Any = ..., table_force: Any = ..., table_count: int = ..., table_kind: int = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("acts", c_int32),
        ("name", c_char * 24),
        ("place_a", Place),
        ("place_b", Place),
        ("offset_a", c_double * 3),
        ("offset_b", c_double * 3),
        ("free_length", c_double),
        ("stiffness", c_double),
        ("damping", c_double),
        ("preload", c_double),
        ("table_elongation", POINTER(c_double)),
        ("table_force", POINTER(c_double)),
        ("table_count", c_uint32),
        ("table_kind", c_int32),
    ]
    field_docs = {
        "acts": ("", "SPRING_...: TENSION (rope) only pulls, COMPRESSION (buffer) only pushes; the damper acts as long as their sum does so; default SPRING_BOTH"),
        "name": ("", "for messages and look-up, ends with 0; default \"\""),
        "place_a": ("", "part {0, 0} (default): the ground, not both"),
        "place_b": ("", "part {0, 0} (default): the ground, not both"),
        "offset_a": ("m", "of the points from their places in their axes; ground: world; default 0"),
        "offset_b": ("m", "of the points from their places in their axes; ground: world; default 0"),
        "free_length": ("m", ">= 0; NOT_GIVEN (default): the length at time 0 as described, > 0"),
        "stiffness": ("N/m", ">= 0; the damping not there without FEATURE_DAMPING; default 0"),
        "damping": ("N s/m", ">= 0; the damping not there without FEATURE_DAMPING; default 0"),
        "preload": ("N", "tension at free_length, < 0 pushes; default 0"),
        "table_elongation": ("m", "strictly increasing, shape (table_count); copied"),
        "table_force": ("N", "shape (table_count); extended along its last slopes; not falling if one-sided; copied"),
        "table_count": ("-", "0 (default): none; 2 .. 2^16"),
        "table_kind": ("", "TABLE_LINES (default), or TABLE_CUBIC: monotone between points"),
    }


class ForceDef(ForcePart, Sized):
    c_name, about = "dmb_force_def", "For dmb_model_add_force."
    struct_size: int
    frame: int
    name: bytes
    place_count: int
    provides: int
    place: 'Array[Place]'
    offset: Any
    component: 'Array[c_int32]'
    pose_step: float
    speed_step: float
    callback: Any
    callback_context: Any
    state_count: int
    reserved: int
    accept: Any
    if TYPE_CHECKING:
        def __init__(self, places: Any = ..., function: Any = ..., *, frame: int = ..., name: str | bytes = ..., place_count: int = ..., provides: int = ..., place: Iterable[Any] = ..., offset: Iterable[float] = ..., component: Iterable[Any] = ..., pose_step: SupportsFloat = ..., speed_step: SupportsFloat = ..., callback: Any = ..., callback_context: Any = ..., state_count: int = ..., accept: Any = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("frame", c_int32),
        ("name", c_char * 24),
        ("place_count", c_uint32),
        ("provides", c_int32),
        ("place", Place * 4),
        ("offset", c_double * 12),
        ("component", c_int32 * 4),
        ("pose_step", c_double),
        ("speed_step", c_double),
        ("callback", FORCE_FN),
        ("callback_context", c_void_p),
        ("state_count", c_uint32),
        ("reserved", c_uint32),
        ("accept", ACCEPT_FN),
    ]
    field_docs = {
        "frame": ("", "FRAME_WORLD (default), or FRAME_BODY: axes of each place"),
        "name": ("", "for messages and look-up, ends with 0; default \"\""),
        "place_count": ("-", "of places and coordinates, 1 .. 4; default 1"),
        "provides": ("", "PROVIDES_...; a tangent is checked by dmb_sim_create (_CALLBACK); 0 (default): by differences"),
        "place": ("", "not the ground; or part is a joint: its coordinate; shape (place_count)"),
        "offset": ("m", "of each point from its place, in its axes, shape (place_count, 3); default 0"),
        "component": ("", "of a joint: X .. RZ, free in it; shape (place_count); default 0"),
        "pose_step": ("m, rad", "of differences, 1e-12 .. 1; default 1e-5"),
        "speed_step": ("m/s, rad/s", "of differences, 1e-12 .. 1; default 1e-5"),
        "callback": ("", "required"),
        "callback_context": ("", ""),
        "state_count": ("-", "numbers of its state, 0 .. 65536, then without a potential; default 0"),
        "accept": ("", "has callback_context; NULL (default): none"),
    }


class StuckDef(Sized):
    c_name, about = "dmb_stuck_def", "For dmb_model_add_stuck."
    struct_size: int
    holds: int
    name: bytes
    place: Place
    stuck: int
    reserved: int
    stiffness: Any
    damping: Any
    overpull: float
    overtorque: float
    if TYPE_CHECKING:
        def __init__(self, *, holds: int = ..., name: str | bytes = ..., place: Place | Id | None = ..., stuck: int = ..., stiffness: Iterable[float] = ..., damping: Iterable[float] = ..., overpull: SupportsFloat = ..., overtorque: SupportsFloat = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("holds", c_int32),
        ("name", c_char * 24),
        ("place", Place),
        ("stuck", c_int32),
        ("reserved", c_int32),
        ("stiffness", c_double * 3),
        ("damping", c_double * 3),
        ("overpull", c_double),
        ("overtorque", c_double),
    ]
    field_docs = {
        "holds": ("", "mask of STUCK_...; default AXIAL and ROTATION"),
        "name": ("", "for messages, ends with 0; default \"\""),
        "place": ("", "of a pipe, or a body or bit; required"),
        "stuck": ("", "1 (default): from time 0 on, in the pose at time 0; 0: free until an input sets it"),
        "stiffness": ("N/m, N m/rad, N/m", "along the axis, about it, sideways, > 0; default 1e9, 1e8, 1e9"),
        "damping": ("N s/m, N m s, N s/m", ">= 0; not there without FEATURE_DAMPING; default 0"),
        "overpull": ("N", "axial force, pull or push; torque, either way, at which it is released, > 0, overtorque at most stiffness[1] times 1 rad; 0 (default): never, at 1 rad"),
        "overtorque": ("N m", "axial force, pull or push; torque, either way, at which it is released, > 0, overtorque at most stiffness[1] times 1 rad; 0 (default): never, at 1 rad"),
    }


class Sub(Sized):
    c_name, about = "dmb_sub", "For dmb_model_add_sub."
    struct_size: int
    reserved: int
    body: Id
    section: Id
    before: Id
    after: Id
    end: Place
    if TYPE_CHECKING:
        def __init__(self, *, body: Id | None = ..., section: Id | None = ..., before: Id | None = ..., after: Id | None = ..., end: Place | Id | None = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("reserved", c_uint32),
        ("body", Id),
        ("section", Id),
        ("before", Id),
        ("after", Id),
        ("end", Place),
    ]
    field_docs = {
        "body": ("", "section: the string to add the next pipes to"),
        "section": ("", "section: the string to add the next pipes to"),
        "before": ("", "section: the string to add the next pipes to"),
        "after": ("", "section: the string to add the next pipes to"),
        "end": ("", "of the string, that `before` joins to the body"),
    }


class Output(Record):
    c_name, about = "dmb_output", "Frozen. A quantity at a place, for recorders, windows, events and the outputs of responses, stepped sine, state space and FMI units. `place` is any point on the axis of a pipe, or the reference point of a part: there is no offset. A spring of stiffness 0 to a point off these gives length and speed as outputs; dmb_query_motion_at has its motion."
    place: Place
    quantity: int
    reserved: int
    _fields_: ClassVar[Any] = [
        ("place", Place),
        ("quantity", c_int32),
        ("reserved", c_int32),
    ]
    field_docs = {
        "place": ("", "place or part that the quantity belongs to"),
        "quantity": ("", "OUTPUT_..."),
    }


class SimOptions(Sized):
    c_name, about = "dmb_sim_options", "For dmb_sim_memory_size, dmb_sim_create, dmb_sim_create_in."
    struct_size: int
    max_iterations: int
    allocator: Any
    log: Any
    log_context: Any
    spectral_radius: float
    newton_tolerance: float
    tolerance_translation: float
    tolerance_rotation: float
    step_min: float
    step_max: float
    max_cuts: int
    bounded_work: int
    energy_ledger: int
    max_steps: int
    constraint_method: int
    reserved: int
    parallel: Any
    parallel_context: Any
    parallel_parts: int
    parallel_least: int
    assembly_energy: float
    if TYPE_CHECKING:
        def __init__(self, *, max_iterations: int = ..., allocator: Any = ..., log: Any = ..., log_context: Any = ..., spectral_radius: SupportsFloat = ..., newton_tolerance: SupportsFloat = ..., tolerance_translation: SupportsFloat = ..., tolerance_rotation: SupportsFloat = ..., step_min: SupportsFloat = ..., step_max: SupportsFloat = ..., max_cuts: int = ..., bounded_work: int = ..., energy_ledger: int = ..., max_steps: int = ..., constraint_method: int = ..., parallel: Any = ..., parallel_context: Any = ..., parallel_parts: int = ..., parallel_least: int = ..., assembly_energy: SupportsFloat = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("max_iterations", c_uint32),
        ("allocator", POINTER(Allocator)),
        ("log", LOG_FN),
        ("log_context", c_void_p),
        ("spectral_radius", c_double),
        ("newton_tolerance", c_double),
        ("tolerance_translation", c_double),
        ("tolerance_rotation", c_double),
        ("step_min", c_double),
        ("step_max", c_double),
        ("max_cuts", c_uint32),
        ("bounded_work", c_int32),
        ("energy_ledger", c_int32),
        ("max_steps", c_uint32),
        ("constraint_method", c_int32),
        ("reserved", c_int32),
        ("parallel", PARALLEL_FN),
        ("parallel_context", c_void_p),
        ("parallel_parts", c_uint32),
        ("parallel_least", c_uint32),
        ("assembly_energy", c_double),
    ]
    field_docs = {
        "max_iterations": ("-", "Newton iterations of one step, 1 .. 1000; default 12"),
        "allocator": ("", "copied; NULL: the model's"),
        "log": ("", "NULL: silent"),
        "log_context": ("", ""),
        "spectral_radius": ("-", "of generalized-alpha at infinite frequency, 0 .. 1; default 0.8"),
        "newton_tolerance": ("-", "0 (default): iterations leave a few hundredths of the step's own error at most, and a residual below 1e-7 of the forces' work (lib/theory/integration.md). 1e-14 .. 1e-1: they end at this residual over the norm of the balancing forces"),
        "tolerance_translation": ("m", "local error in dmb_sim_advance, > 0; default 1e-6, 1e-5"),
        "tolerance_rotation": ("rad", "local error in dmb_sim_advance, > 0; default 1e-6, 1e-5"),
        "step_min": ("s", "shortest step of dmb_sim_advance and part of a divided step, > 0; default 1e-9"),
        "step_max": ("s", "longest, > step_min; default 0.1"),
        "max_cuts": ("-", "times a step that does not converge is halved, 0 .. 30; default 12"),
        "bounded_work": ("", "1: dmb_sim_step does one step of at most max_iterations and accepts a finite result with NOTE_WORK_LIMITED unless it grows a millionfold; such a step is not divided at breakpoints, and fails if a stop or one-sided spring turns a body by more than a radian in it; for control loops; default 0"),
        "energy_ledger": ("", "1 (default): keep the energy ledger; 0: it is not computed"),
        "max_steps": ("-", "accepted steps in one dmb_sim_advance, then NOTE_STOPPED; 0 (default): no bound"),
        "constraint_method": ("", "METHOD_..., algebra of joints in a step; default METHOD_INDEPENDENT"),
        "parallel": ("", "NULL (default): steps are made in the thread of the call alone. Not for functions of Python"),
        "parallel_context": ("", ""),
        "parallel_parts": ("-", "most parts at once, 1 .. 64 (the equations of a chain have two); default 2"),
        "parallel_least": ("-", "elements of a scene from which on `parallel` is called; default 1000"),
        "assembly_energy": ("J", "most that dmb_sim_create may store in flexible pipes to close joints, >= 0; default 1e-3, the rounding of described places. More is ERR_GEOMETRY"),
    }
    bounds = {
        "max_iterations": ("within", 1, 1000),
        "spectral_radius": ("within", 0, 1),
        "newton_tolerance": ("zero_or", 1e-14, 0.1),
        "tolerance_translation": ("above", 0, inf),
        "tolerance_rotation": ("above", 0, inf),
        "step_min": ("above", 0, inf),
        "step_max": ("above", 0, inf),
        "max_cuts": ("within", 0, 30),
        "bounded_work": ("within", 0, 1),
        "energy_ledger": ("within", 0, 1),
        "constraint_method": ("within", 0, 1),
        "parallel_parts": ("within", 1, 64),
        "assembly_energy": ("within", 0, 1e+300),
    }


class ProfileRecorderStruct(Sized):
    c_name, about = "dmb_profile_recorder", "Rows of whole profiles, at a coarser rate, in the caller's memory."
    struct_size: int
    reserved: int
    profile: Any
    table: Any
    capacity: int
    row_count: int
    interval: float
    if TYPE_CHECKING:
        def __init__(self, *, profile: Any = ..., table: Any = ..., capacity: int = ..., row_count: int = ..., interval: SupportsFloat = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("reserved", c_uint32),
        ("profile", POINTER(ProfileStruct)),
        ("table", POINTER(c_double)),
        ("capacity", c_uint64),
        ("row_count", c_uint64),
        ("interval", c_double),
    ]
    field_docs = {
        "profile": ("", "quantities of a row, without `values` and strides; the caller's, kept alive and unchanged"),
        "table": ("", "time [s], then quantity q at station i at 1 + i quantity_count + q; (capacity, 1 + stations quantities)"),
        "capacity": ("-", "rows of table"),
        "row_count": ("-", "rows written, start with 0"),
        "interval": ("s", "between rows, 0: every call"),
    }


class PathOptions(Sized):
    c_name, about = "dmb_path_options", "For dmb_analysis_path."
    struct_size: int
    max_points: int
    max_iterations: int
    scale: int
    part: Id
    place: Place
    component: int
    branch: int
    factor_end: float
    displacement_end: float
    first_step: float
    step_max: float
    branch_size: float
    tolerance: float
    slip_axial: float
    slip_rotation: float
    callback: Any
    callback_context: Any
    if TYPE_CHECKING:
        def __init__(self, *, max_points: int = ..., max_iterations: int = ..., scale: int = ..., part: Id | None = ..., place: Place | Id | None = ..., component: int = ..., branch: int = ..., factor_end: SupportsFloat = ..., displacement_end: SupportsFloat = ..., first_step: SupportsFloat = ..., step_max: SupportsFloat = ..., branch_size: SupportsFloat = ..., tolerance: SupportsFloat = ..., slip_axial: SupportsFloat = ..., slip_rotation: SupportsFloat = ..., callback: Any = ..., callback_context: Any = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("max_points", c_uint32),
        ("max_iterations", c_uint32),
        ("scale", c_int32),
        ("part", Id),
        ("place", Place),
        ("component", c_int32),
        ("branch", c_int32),
        ("factor_end", c_double),
        ("displacement_end", c_double),
        ("first_step", c_double),
        ("step_max", c_double),
        ("branch_size", c_double),
        ("tolerance", c_double),
        ("slip_axial", c_double),
        ("slip_rotation", c_double),
        ("callback", PATH_FN),
        ("callback_context", c_void_p),
    ]
    field_docs = {
        "max_points": ("-", "1 .. 1000000; default 200"),
        "max_iterations": ("-", "of one point, 2 .. 1000; default 15"),
        "scale": ("", "SCALE_..., default SCALE_LOADS"),
        "part": ("", "load or drive of SCALE_PART"),
        "place": ("", "place that is watched; part {0, 0} (default): none"),
        "component": ("", "of its displacement in the world, X (default) .. Z"),
        "branch": ("", "1 or -1: leaves the path at the first bifurcation, to that side; 0 (default): stays"),
        "factor_end": ("unit of the factor", "where the path ends and towards which it begins, not 0; default 1"),
        "displacement_end": ("m", "ends there; default UNLIMITED: nowhere"),
        "first_step": ("unit of the factor", "> 0, 0: factor_end/10; default 0"),
        "step_max": ("m", "longest arc, > 0; default UNLIMITED"),
        "branch_size": ("m", "arc of the first step on a branch; 0 (default): that of the step before"),
        "tolerance": ("-", "of the residual, as in dmb_static_options; default 1e-10"),
        "slip_axial": ("m/s", "friction as in dmb_static_options"),
        "slip_rotation": ("rad/s", "friction as in dmb_static_options"),
        "callback": ("", "may be NULL"),
        "callback_context": ("", ""),
    }
    bounds = {
        "max_points": ("within", 1, 1000000),
        "max_iterations": ("within", 2, 1000),
        "scale": ("within", 0, 2),
        "component": ("within", 0, 2),
        "branch": ("within", -1, 1),
        "factor_end": ("within", -1e+30, 1e+30),
        "displacement_end": ("within", -1e+30, 1e+30),
        "first_step": ("within", 0, 1e+30),
        "step_max": ("above", 0, inf),
        "branch_size": ("within", 0, 1000000),
        "tolerance": ("within", 1e-15, 0.1),
        "slip_axial": ("within", -1000000, 1000000),
        "slip_rotation": ("within", -1000000, 1000000),
    }


class Excitation(Sized):
    c_name, about = "dmb_excitation", "For dmb_analysis_response, dmb_analysis_state_space."
    struct_size: int
    kind: int
    place: Place
    component: int
    frame: int
    amplitude: float
    phase: float
    if TYPE_CHECKING:
        def __init__(self, *, kind: int = ..., place: Place | Id | None = ..., component: int = ..., frame: int = ..., amplitude: SupportsFloat = ..., phase: SupportsFloat = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("kind", c_int32),
        ("place", Place),
        ("component", c_int32),
        ("frame", c_int32),
        ("amplitude", c_double),
        ("phase", c_double),
    ]
    field_docs = {
        "kind": ("", "EXCITATION_..., default EXCITATION_FORCE"),
        "place": ("", "as the kind says"),
        "component": ("", "X .. RZ, default X"),
        "frame": ("", "FRAME_WORLD (default), _BODY: axes of the place"),
        "amplitude": ("unit of the kind", "in the combined response; default 1, 0"),
        "phase": ("rad", "in the combined response; default 1, 0"),
    }


class SubDef(Sized):
    c_name, about = "dmb_sub_def", "A sub: a body in the middle of a string (stabiliser, motor, jar, sensor) at the far end of the string as it is described so far, and the section of pipes that continues the string `length` further along the body's x axis (examples/programming, Parts on strings). Of the structs pointed to, poses, velocities, attach, follows_hole, start_depth, offset, start_free (all free) and places of joints are ignored; frames a of joints are in the axes of the string's end."
    struct_size: int
    reserved: int
    string: Id
    length: float
    body: Any
    before: Any
    after: Any
    section: Any
    if TYPE_CHECKING:
        def __init__(self, *, string: Id | None = ..., length: SupportsFloat = ..., body: Any = ..., before: Any = ..., after: Any = ..., section: Any = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("reserved", c_uint32),
        ("string", Id),
        ("length", c_double),
        ("body", POINTER(BodyDef)),
        ("before", POINTER(JointDef)),
        ("after", POINTER(JointDef)),
        ("section", POINTER(StringDef)),
    ]
    field_docs = {
        "string": ("", "with its pipes so far, end_free FREE_ALL; {0, 0}: the model's first"),
        "length": ("m", ">= 0; default 0"),
        "body": ("", "NULL (default): a body by default"),
        "before": ("", "string to body; NULL (default): fixed"),
        "after": ("", "body to section; NULL (default): fixed"),
        "section": ("", "its name and end_free; NULL (default): a string by default"),
    }


class EventDef(Sized):
    c_name, about = "dmb_event_def", "For dmb_model_add_event, dmb_model_get_event."
    struct_size: int
    direction: int
    name: bytes
    output: Output
    level: float
    hold: float
    tolerance: float
    if TYPE_CHECKING:
        def __init__(self, *, direction: int = ..., name: str | bytes = ..., output: Output | tuple[Any, Any] = ..., level: SupportsFloat = ..., hold: SupportsFloat = ..., tolerance: SupportsFloat = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("direction", c_int32),
        ("name", c_char * 24),
        ("output", Output),
        ("level", c_double),
        ("hold", c_double),
        ("tolerance", c_double),
    ]
    field_docs = {
        "direction": ("", "EVENT_..., default EVENT_RISING"),
        "name": ("", "required, unique among the events, ends with 0"),
        "output": ("", "as of a recorder; dmb_sim_create fails if the scene does not have it"),
        "level": ("unit of the output", "reported when it has stayed beyond so long, >= 0, 0 with EITHER; default 0"),
        "hold": ("s", "reported when it has stayed beyond so long, >= 0, 0 with EITHER; default 0"),
        "tolerance": ("s", "1e-12 .. 1, default 1e-9; no less than the rounding of time allows"),
    }


class RecorderStruct(Sized):
    c_name, about = "dmb_recorder", "a window over outputs, below"
    struct_size: int
    output_count: int
    outputs: Any
    table: Any
    capacity: int
    row_count: int
    interval: float
    window: Any
    if TYPE_CHECKING:
        def __init__(self, *, output_count: int = ..., outputs: Any = ..., table: Any = ..., capacity: int = ..., row_count: int = ..., interval: SupportsFloat = ..., window: Any = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("output_count", c_uint32),
        ("outputs", POINTER(Output)),
        ("table", POINTER(c_double)),
        ("capacity", c_uint64),
        ("row_count", c_uint64),
        ("interval", c_double),
        ("window", c_void_p),
    ]
    field_docs = {
        "output_count": ("-", "1 .. 4096"),
        "outputs": ("", "shape (output_count); the caller's, kept alive by it"),
        "table": ("", "shape (capacity, 1 + output_count); the caller's"),
        "capacity": ("-", "rows of table"),
        "row_count": ("-", "rows written, start with 0"),
        "interval": ("s", "between samples, 0: every call"),
        "window": ("", "of outputs of a window; dmb_window_take comes before dmb_recorder_take; default NULL"),
    }


class Order(Sized):
    c_name, about = "dmb_order", "A string that turns at W [rad/s] is shaken at orders of its speed: at W by eccentric masses, at 2 W by misalignment, at 3 W by a tricone bit, at the number of blades times W by the cut."
    struct_size: int
    reserved: int
    order: float
    excitation: Excitation
    if TYPE_CHECKING:
        def __init__(self, *, order: SupportsFloat = ..., excitation: Excitation = ...) -> None: ...
    _fields_: ClassVar[Any] = [
        ("struct_size", c_uint32),
        ("reserved", c_uint32),
        ("order", c_double),
        ("excitation", Excitation),
    ]
    field_docs = {
        "order": ("-", "frequency over rotary speed, > 0; default 1"),
        "excitation": ("", "with its amplitude; default: the scene's eccentric masses, as they are"),
    }
    bounds = {
        "order": ("within", 0.001, 1000),
    }


STRUCTS: dict[str, Any] = {}  # name in C -> class
STRUCTS["dmb_id"] = Id
STRUCTS["dmb_place"] = Place
STRUCTS["dmb_allocator"] = Allocator
STRUCTS["dmb_error"] = ErrorStruct
STRUCTS["dmb_model_options"] = ModelOptions
STRUCTS["dmb_environment_def"] = EnvironmentDef
STRUCTS["dmb_segment"] = Segment
STRUCTS["dmb_law_memory"] = LawMemory
STRUCTS["dmb_friction_at"] = FrictionAt
STRUCTS["dmb_wall_def"] = WallDef
STRUCTS["dmb_hole_section"] = HoleSection
STRUCTS["dmb_string_def"] = StringDef
STRUCTS["dmb_pipe_def"] = PipeDef
STRUCTS["dmb_stabiliser_def"] = StabiliserDef
STRUCTS["dmb_body_def"] = BodyDef
STRUCTS["dmb_bit_def"] = BitDef
STRUCTS["dmb_joint_def"] = JointDef
STRUCTS["dmb_coupling_def"] = CouplingDef
STRUCTS["dmb_constraint_def"] = ConstraintDef
STRUCTS["dmb_drive_def"] = DriveDef
STRUCTS["dmb_load_def"] = LoadDef
STRUCTS["dmb_spring_def"] = SpringDef
STRUCTS["dmb_force_def"] = ForceDef
STRUCTS["dmb_stuck_def"] = StuckDef
STRUCTS["dmb_motor"] = Motor
STRUCTS["dmb_sub_def"] = SubDef
STRUCTS["dmb_sub"] = Sub
STRUCTS["dmb_input_def"] = InputDef
STRUCTS["dmb_input_info"] = InputInfo
STRUCTS["dmb_output"] = Output
STRUCTS["dmb_event_def"] = EventDef
STRUCTS["dmb_compile_options"] = CompileOptions
STRUCTS["dmb_model_info"] = ModelInfo
STRUCTS["dmb_sim_options"] = SimOptions
STRUCTS["dmb_step_report"] = StepReport
STRUCTS["dmb_input_state"] = InputState
STRUCTS["dmb_input_record"] = InputRecord
STRUCTS["dmb_event_report"] = EventReport
STRUCTS["dmb_pose"] = Pose
STRUCTS["dmb_motion"] = Motion
STRUCTS["dmb_section"] = Section
STRUCTS["dmb_contact"] = Contact
STRUCTS["dmb_contact_total"] = ContactTotal
STRUCTS["dmb_energy"] = Energy
STRUCTS["dmb_momentum"] = Momentum
STRUCTS["dmb_drive_state"] = DriveState
STRUCTS["dmb_joint_state"] = JointState
STRUCTS["dmb_bit_state"] = BitState
STRUCTS["dmb_statistics"] = Statistics
STRUCTS["dmb_hole_point"] = HolePoint
STRUCTS["dmb_flow_state"] = FlowState
STRUCTS["dmb_profile"] = ProfileStruct
STRUCTS["dmb_recorder"] = RecorderStruct
STRUCTS["dmb_spring_state"] = SpringState
STRUCTS["dmb_stuck_state"] = StuckState
STRUCTS["dmb_window_options"] = WindowOptions
STRUCTS["dmb_window_result"] = WindowResult
STRUCTS["dmb_profile_recorder"] = ProfileRecorderStruct
STRUCTS["dmb_static_options"] = StaticOptions
STRUCTS["dmb_static_report"] = StaticReport
STRUCTS["dmb_buckling_options"] = BucklingOptions
STRUCTS["dmb_buckling_info"] = BucklingInfo
STRUCTS["dmb_path_point"] = PathPoint
STRUCTS["dmb_path_options"] = PathOptions
STRUCTS["dmb_path_report"] = PathReport
STRUCTS["dmb_check_report"] = CheckReport
STRUCTS["dmb_modes_options"] = ModesOptions
STRUCTS["dmb_modes_info"] = ModesInfo
STRUCTS["dmb_mode"] = Mode
STRUCTS["dmb_mode_shape"] = ModeShape
STRUCTS["dmb_excitation"] = Excitation
STRUCTS["dmb_response_options"] = ResponseOptions
STRUCTS["dmb_stepped_sine_options"] = SteppedSineOptions
STRUCTS["dmb_stepped_sine_report"] = SteppedSineReport
STRUCTS["dmb_order"] = Order
STRUCTS["dmb_speeds_report"] = SpeedsReport
STRUCTS["dmb_speeds_options"] = SpeedsOptions
STRUCTS["dmb_speed_band"] = SpeedBand
STRUCTS["dmb_state_space_options"] = StateSpaceOptions
STRUCTS["dmb_state_space_info"] = StateSpaceInfo
STRUCTS["dmb_row"] = Row
STRUCTS["dmb_parameter"] = Parameter
STRUCTS["dmb_operation"] = Operation
STRUCTS["dmb_torque_drag_options"] = TorqueDragOptions
STRUCTS["dmb_torque_drag_row"] = TorqueDragRow
STRUCTS["dmb_hydraulics"] = Hydraulics
STRUCTS["dmb_fatigue_options"] = FatigueOptions
STRUCTS["dmb_fatigue_result"] = FatigueResult

for _cls in STRUCTS.values():
    read_as_numpy(_cls)
del _cls
