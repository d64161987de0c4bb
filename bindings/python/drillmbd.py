"""libdrillmbd from Python: describe - compile - run - ask. Needs ctypes only; uses numpy for tables where it is there.

    import drillmbd as mbd

    model = mbd.Model()
    model.add_wall(diameter=0.094)
    string = model.add_pipes(100, outer_diameter=0.073, inner_diameter=0.061)
    model.add_bit(mass=5.0)
    feed = model.add_programme(mbd.Term(kind=mbd.TERM_STEP, x1=1.0, h1=0.01))
    model.add_drive(programme=feed)
    model.compile()
    with model.sim() as sim:
        while sim.time < 40.0:
            sim.step(1e-3)
        print(sim.pose(mbd.station(string, 99, 1.0)).position[:])

Structs carry the names of the C interface without dmb_ and in capitals (dmb_pipe_def is PipeDef), with the same fields,
units and defaults: see the headers. Functions that take one also take its fields as keywords. A call that fails raises
Error; a status above 0 is in the `status` of the answer. The library is the file that the environment variable
DRILLMBD_LIBRARY names, otherwise the one the system finds.
"""
import ctypes
import ctypes.util
import os
import threading
from ctypes import (CFUNCTYPE, POINTER, byref, c_char, c_char_p, c_double, c_int32, c_int64, c_size_t, c_uint32,
                    c_uint64, c_void_p)

try:
    import numpy
except ImportError:
    numpy = None

VERSION = (0, 1, 0)  # of the interface mirrored here

# ---- Constants, as in the headers without DMB_ ----------------------------------------------------------------------
OK, NOTE_STEP_CUT, NOTE_WORK_LIMITED, NOTE_PROJECTED, NOTE_STOPPED, NOTE_FULL, NOTE_TOLERANCE, NOTE_UNSTABLE, \
    NOTE_NOT_STEADY, NOTE_EXTRAPOLATED = range(10)
(ERR_NULL, ERR_HANDLE, ERR_STRUCT_SIZE, ERR_ID, ERR_VALUE, ERR_NOT_FINITE, ERR_ORDER, ERR_NO_MEMORY, ERR_TOO_LARGE,
 ERR_SINGULAR, ERR_NO_CONVERGENCE, ERR_CALLBACK, ERR_IO, ERR_ROTATION, ERR_GEOMETRY,
 ERR_UNSUPPORTED) = range(-1, -17, -1)

LOG_ERROR, LOG_WARNING, LOG_INFO = range(3)
STATIC_NEWTON, STATIC_RELAXATION = range(2)
STIFFNESS_SYMMETRIC, STIFFNESS_UNSYMMETRIC = range(2)
BUCKLING_EXTRAPOLATED, BUCKLING_BIFURCATION, BUCKLING_LIMIT, BUCKLING_STABLE = range(4)
SCALE_ALL, SCALE_LOADS, SCALE_PART = range(3)
PATH_REGULAR, PATH_LIMIT, PATH_BIFURCATION, PATH_BRANCH = range(4)
X, Y, Z, RX, RY, RZ = range(6)
FREE_NONE, FREE_X, FREE_RX, FREE_RZ = 0, 1, 8, 32
FREE_CYLINDRICAL, FREE_SPHERICAL, FREE_ALL = 9, 56, 63
TERM_CONSTANT, TERM_STEP, TERM_STEP5, TERM_HARMONIC, TERM_TABLE, TERM_CALLBACK = range(6)
PROVIDES_RATE, PROVIDES_INTEGRAL = 1, 2
PROVIDES_JACOBIAN = 1
(NORMAL_NONE, NORMAL_KELVIN_VOIGT, NORMAL_HUNT_CROSSLEY, NORMAL_LANKARANI_NIKRAVESH, NORMAL_FLORES, NORMAL_EXACT,
 NORMAL_IMPACT) = range(-1, 6)
FRICTION_NONE, FRICTION_COULOMB, FRICTION_AMBROSIO, FRICTION_STRIBECK, FRICTION_BRISTLE = range(-1, 4)
PIPE_FLEXIBLE, PIPE_AXIAL_TORSIONAL, PIPE_RIGID = range(3)
ATTACH_NONE, ATTACH_START, ATTACH_END = range(3)
ROCK_NONE, ROCK_RATE, ROCK_REGENERATIVE = range(3)
(JOINT_FIXED, JOINT_REVOLUTE, JOINT_PRISMATIC, JOINT_CYLINDRICAL, JOINT_UNIVERSAL, JOINT_SPHERICAL, JOINT_PLANAR,
 JOINT_POINT_ON_LINE, JOINT_POINT_ON_HOLE, JOINT_DISTANCE, JOINT_FREE, JOINT_KNIFE_EDGE, JOINT_ROLLING) = range(13)
JOINT_ACTIVE, JOINT_LOCKED, JOINT_OPEN = range(3)
CONSTRAINT_HOLONOMIC, CONSTRAINT_NONHOLONOMIC = range(2)
METHOD_INDEPENDENT, METHOD_MULTIPLIERS = range(2)
DRIVE_MOTION, DRIVE_LOAD, DRIVE_CONTROL = range(3)
FRAME_WORLD, FRAME_BODY, FRAME_HOLE = range(3)
FEATURE_GRAVITY, FEATURE_CONTACT, FEATURE_FRICTION, FEATURE_ECCENTRICITY = 1, 2, 4, 8
FEATURE_EXCITATION, FEATURE_ROCK, FEATURE_DAMPING = 16, 32, 64
FEATURE_VIBRATION, FEATURE_ALL = 24, 127
(CHANNEL_DISPLACEMENT_X, CHANNEL_DISPLACEMENT_Y, CHANNEL_DISPLACEMENT_Z, CHANNEL_VELOCITY_X, CHANNEL_VELOCITY_Y,
 CHANNEL_VELOCITY_Z, CHANNEL_POSITION_X, CHANNEL_POSITION_Y, CHANNEL_POSITION_Z, CHANNEL_ROTATION, CHANNEL_SPIN,
 CHANNEL_AXIAL_FORCE, CHANNEL_TORQUE, CHANNEL_BENDING_MOMENT, CHANNEL_KINETIC_ENERGY, CHANNEL_NORMAL_FORCE,
 CHANNEL_DRIVE_FORCE, CHANNEL_DRIVE_SPEED, CHANNEL_BIT_WEIGHT, CHANNEL_ENERGY_ERROR, CHANNEL_COUNT) = range(21)
(INPUT_DRIVE, INPUT_LOAD, INPUT_BIT_LOAD, INPUT_FORCE, INPUT_UNBALANCE, INPUT_ECCENTRICITY,
 INPUT_FRICTION) = range(7)
(OUTPUT_DISPLACEMENT, OUTPUT_VELOCITY, OUTPUT_ACCELERATION, OUTPUT_SECTION_FORCE, OUTPUT_SECTION_STRAIN, OUTPUT_CONTACT,
 OUTPUT_DRIVE, OUTPUT_REACTION, OUTPUT_JOINT_POSITION, OUTPUT_JOINT_SPEED, OUTPUT_JOINT_ACCELERATION,
 OUTPUT_JOINT_REACTION, OUTPUT_JOINT_ACTION, OUTPUT_MULTIPLIER, OUTPUT_BIT) = range(15)
CONTACT_AS_IS, CONTACT_OPEN, CONTACT_CLOSED = range(3)
COMBINED = 0xFFFFFFFF
MODES_UNDAMPED, MODES_DAMPED = range(2)
MODES_TURNING, MODES_STILL = range(2)
STEADY_AUTO, STEADY_AT_REST, STEADY_SLIDING, STEADY_RIGID = range(4)
MODES_LOWEST, MODES_ALL, MODES_BAND = range(3)


# ---- The library -----------------------------------------------------------------------------------------------------
def _load():
    name = os.environ.get("DRILLMBD_LIBRARY") or ctypes.util.find_library("drillmbd")
    if not name:
        raise ImportError("libdrillmbd was not found: set DRILLMBD_LIBRARY to its file")
    library = ctypes.CDLL(name)
    library.dmb_version.restype, library.dmb_version.argtypes = c_uint32, []
    found = library.dmb_version()
    if found // 10000 != VERSION[0] or found < 10000 * VERSION[0] + 100 * VERSION[1]:
        raise ImportError(f"{name} has version {found // 10000}.{found // 100 % 100}.{found % 100}, "
                          f"this binding needs {VERSION[0]}.{VERSION[1]}")
    return library


_lib = _load()


def _declare(name, result, *arguments):
    function = getattr(_lib, name)
    function.restype, function.argtypes = result, list(arguments)
    return function


# ---- Structs ---------------------------------------------------------------------------------------------------------
STRUCTS = {}  # name in C -> class


def _mirrors(c_name):
    def register(cls):
        STRUCTS[c_name] = cls
        if issubclass(cls, _Sized):
            cls._init = _declare(c_name + "_init", c_int32, POINTER(cls), c_uint32)
        return cls
    return register


class _Record(ctypes.Structure):
    """A struct that knows its fields: a misspelt one is an error, a sequence fills an array, a part stands for its
    reference point where a place is needed and None for no part."""

    def __setattr__(self, name, value):
        if not name.startswith("_"):
            if not hasattr(type(self), name):
                raise AttributeError(f"{type(self).__name__} has no field '{name}'")
            present = getattr(self, name)
            if isinstance(present, ctypes.Array):
                value = type(present)(*_numbers(value, len(present)))
            elif isinstance(present, bytes) and isinstance(value, str):
                value = value.encode()
            elif isinstance(present, Place) and not isinstance(value, Place):
                value = station(_as_id(value))
        super().__setattr__(name, value)

    def __repr__(self):
        def shown(value):
            return list(value) if isinstance(value, ctypes.Array) else value
        fields = ", ".join(f"{name}={shown(getattr(self, name))!r}" for name, *_ in self._fields_
                           if name not in ("struct_size", "reserved"))
        return f"{type(self).__name__}({fields})"


class _Sized(_Record):
    """A struct with struct_size, filled with the library's defaults and then with the given fields."""
    status = 0  # of the call that answered with it

    def __init__(self, **fields):
        super().__init__()
        _check(type(self)._init(byref(self), ctypes.sizeof(self)))
        for name, value in fields.items():
            setattr(self, name, value)


CONSTRAINT_FN = CFUNCTYPE(c_int32, c_void_p, c_double, c_uint32, POINTER(c_double * 12), POINTER(c_double),
                          POINTER(c_double))
PROGRAMME_FN = CFUNCTYPE(c_int32, c_void_p, c_double, POINTER(c_double))
LOG_FN = CFUNCTYPE(None, c_void_p, c_int32, c_char_p)
_ALLOCATE_FN = CFUNCTYPE(c_void_p, c_void_p, c_size_t, c_size_t)
_RELEASE_FN = CFUNCTYPE(None, c_void_p, c_void_p, c_size_t, c_size_t)


@_mirrors("dmb_id")
class Id(_Record):
    """Names a part of a model. Id() names nothing."""
    _fields_ = [("index", c_uint32), ("generation", c_uint32)]

    def __eq__(self, other):
        return isinstance(other, Id) and (self.index, self.generation) == (other.index, other.generation)

    def __hash__(self):
        return hash((self.index, self.generation))

    def __bool__(self):
        return self.generation != 0


@_mirrors("dmb_place")
class Place(_Record):
    _fields_ = [("part", Id), ("pipe", c_uint32), ("reserved", c_uint32), ("fraction", c_double)]


def station(part, pipe=0, fraction=0.0):
    """A place on a part: a station of a string, or the reference point of a body."""
    return Place(part, pipe, 0, fraction)


@_mirrors("dmb_allocator")
class Allocator(_Sized):
    _fields_ = [("struct_size", c_uint32), ("reserved", c_uint32), ("context", c_void_p), ("allocate", _ALLOCATE_FN),
                ("release", _RELEASE_FN)]


@_mirrors("dmb_model_options")
class ModelOptions(_Sized):
    _fields_ = [("struct_size", c_uint32), ("reserved", c_uint32), ("allocator", POINTER(Allocator)), ("log", LOG_FN),
                ("log_context", c_void_p)]


@_mirrors("dmb_environment_def")
class EnvironmentDef(_Sized):
    _fields_ = [("struct_size", c_uint32), ("reserved", c_uint32), ("gravity", c_double * 3),
                ("fluid_density", c_double), ("lateral_damping", c_double), ("axial_damping", c_double),
                ("torsional_damping", c_double)]


@_mirrors("dmb_term")
class Term(_Sized):
    """One term of a programme. `table` takes pairs (time, value); `function` takes a function of time that returns a
    value, or (value, rate), or (value, rate, integral)."""
    _fields_ = [("struct_size", c_uint32), ("kind", c_int32), ("x0", c_double), ("x1", c_double), ("h0", c_double),
                ("h1", c_double), ("omega", c_double), ("phase", c_double), ("table_time", POINTER(c_double)),
                ("table_value", POINTER(c_double)), ("table_count", c_uint32), ("provides", c_int32),
                ("callback", PROGRAMME_FN), ("callback_context", c_void_p)]

    def __init__(self, table=None, function=None, **fields):
        super().__init__(**fields)
        self._function = function
        if table is not None:
            times, values = zip(*table)
            self.kind, self.table_count = TERM_TABLE, len(times)
            self.table_time, self.table_value = (c_double * len(times))(*times), (c_double * len(times))(*values)
        if function is not None:
            self.kind = TERM_CALLBACK


@_mirrors("dmb_wall_def")
class WallDef(_Sized):
    """The hole. `stations` takes triples (measured depth, inclination, azimuth)."""
    _fields_ = [("struct_size", c_uint32), ("survey_count", c_uint32), ("survey", POINTER(c_double)),
                ("origin", c_double * 3), ("direction", c_double * 3), ("diameter", c_double),
                ("normal_law", c_int32), ("friction_law", c_int32), ("stiffness", c_double), ("exponent", c_double),
                ("restitution", c_double), ("damping", c_double), ("impact_depth", c_double),
                ("approach_speed", c_double), ("mu_static", c_double), ("mu_dynamic", c_double),
                ("stribeck_speed", c_double), ("smoothing_speed", c_double), ("full_speed", c_double),
                ("bristle_stiffness", c_double), ("bristle_damping", c_double)]

    def __init__(self, stations=None, **fields):
        super().__init__(**fields)
        if stations is not None:
            numbers = [number for triple in stations for number in _numbers(triple, 3)]
            self.survey_count = len(numbers) // 3
            self.survey = (c_double * len(numbers))(*numbers)


@_mirrors("dmb_string_def")
class StringDef(_Sized):
    _fields_ = [("struct_size", c_uint32), ("follows_hole", c_int32), ("start_depth", c_double),
                ("offset", c_double * 2), ("position", c_double * 3), ("rotation", c_double * 3),
                ("velocity", c_double * 6), ("start_free", c_int32), ("end_free", c_int32)]


@_mirrors("dmb_pipe_def")
class PipeDef(_Sized):
    _fields_ = [("struct_size", c_uint32), ("kind", c_int32), ("string", Id), ("elements", c_uint32),
                ("seed", c_uint32), ("length", c_double), ("outer_diameter", c_double), ("inner_diameter", c_double),
                ("young_modulus", c_double), ("poisson_ratio", c_double), ("density", c_double),
                ("shear_factor", c_double), ("damping_time", c_double), ("joint_length", c_double),
                ("joint_outer_diameter", c_double), ("joint_inner_diameter", c_double), ("joint_mass", c_double),
                ("joint_inertia", c_double * 2), ("eccentricity", c_double), ("eccentricity_angle", c_double),
                ("eccentricity_spread", c_double), ("angle_spread", c_double), ("curvature", c_double * 3),
                ("section_stiffness", c_double * 6), ("section_mass", c_double), ("section_inertia", c_double * 2)]


@_mirrors("dmb_body_def")
class BodyDef(_Sized):
    _fields_ = [("struct_size", c_uint32), ("attach", c_int32), ("string", Id), ("mass", c_double),
                ("centre", c_double * 3), ("inertia", c_double * 6), ("position", c_double * 3),
                ("rotation", c_double * 3), ("velocity", c_double * 6), ("free_mask", c_int32), ("reserved", c_int32),
                ("contact_diameter", c_double), ("contact_length", c_double)]


@_mirrors("dmb_bit_def")
class BitDef(_Sized):
    _fields_ = [("struct_size", c_uint32), ("rock_law", c_int32), ("string", Id), ("load", Id), ("mass", c_double),
                ("inertia", c_double * 2), ("diameter", c_double), ("length", c_double), ("radius", c_double),
                ("intrinsic_energy", c_double), ("cutting_ratio", c_double), ("contact_strength", c_double),
                ("wear_length", c_double), ("contact_friction", c_double), ("intrusion_depth", c_double),
                ("bottom", c_double), ("blades", c_uint32), ("history", c_uint32)]


@_mirrors("dmb_joint_def")
class JointDef(_Sized):
    """A joint between place_a (None: the ground) and place_b."""
    _fields_ = [("struct_size", c_uint32), ("kind", c_int32), ("name", c_char * 24), ("place_a", Place),
                ("place_b", Place), ("origin_a", c_double * 3), ("axis_a", c_double * 3), ("normal_a", c_double * 3),
                ("origin_b", c_double * 3), ("axis_b", c_double * 3), ("normal_b", c_double * 3), ("match", c_int32),
                ("state", c_int32), ("length", c_double), ("stiffness", c_double * 6), ("damping", c_double * 6),
                ("rest", c_double * 6), ("friction", c_double * 6), ("friction_speed", c_double),
                ("stop_low", c_double * 6), ("stop_high", c_double * 6), ("stop_stiffness", c_double),
                ("stop_damping", c_double), ("initial_mask", c_int32), ("reserved", c_int32),
                ("initial_position", c_double * 6), ("initial_speed", c_double * 6)]


@_mirrors("dmb_coupling_def")
class CouplingDef(_Sized):
    _fields_ = [("struct_size", c_uint32), ("reserved", c_int32), ("name", c_char * 24), ("joint", Id * 2),
                ("component", c_int32 * 2), ("ratio", c_double)]


@_mirrors("dmb_constraint_def")
class ConstraintDef(_Sized):
    """A constraint on the poses of one to four `places`. `function` takes the time and a sequence of poses, each of
    twelve numbers (position, rotation matrix by rows), and returns `rows` numbers (or one, if rows is 1); with
    provides=PROVIDES_JACOBIAN a pair of these and of the rows x 6 places jacobian, flat or row by row."""
    _fields_ = [("struct_size", c_uint32), ("kind", c_int32), ("name", c_char * 24), ("rows", c_uint32),
                ("count", c_uint32), ("place", Place * 4), ("provides", c_int32), ("reserved", c_int32),
                ("callback", CONSTRAINT_FN), ("callback_context", c_void_p)]

    def __init__(self, places=None, function=None, **fields):
        super().__init__(**fields)
        self._function = function
        if places is not None:
            places = [place if isinstance(place, Place) else station(place) for place in places]
            self.count = len(places)
            self.place = (places + [Place()] * 4)[:4]


@_mirrors("dmb_drive_def")
class DriveDef(_Sized):
    _fields_ = [("struct_size", c_uint32), ("kind", c_int32), ("part", Id), ("component", c_int32),
                ("reserved", c_int32), ("programme", Id), ("excitation", Id), ("gain", c_double),
                ("integral_gain", c_double), ("limit_low", c_double), ("limit_high", c_double)]


@_mirrors("dmb_load_def")
class LoadDef(_Sized):
    _fields_ = [("struct_size", c_uint32), ("frame", c_int32), ("place", Place), ("force", c_double * 3),
                ("moment", c_double * 3), ("programme", Id)]


@_mirrors("dmb_compile_options")
class CompileOptions(_Sized):
    _fields_ = [("struct_size", c_uint32), ("features", c_int32), ("pipe_kind", c_int32), ("reserved", c_int32)]


@_mirrors("dmb_model_info")
class ModelInfo(_Sized):
    _fields_ = [("struct_size", c_uint32), ("strings", c_uint32), ("pipes", c_uint32), ("rigid_bodies", c_uint32),
                ("nodes", c_uint32), ("elements", c_uint32), ("contact_sites", c_uint32), ("freedoms", c_uint32),
                ("prescribed", c_uint32), ("structural_joints", c_uint32), ("model_bytes", c_uint64),
                ("sim_bytes", c_uint64), ("mass", c_double), ("length", c_double), ("joints", c_uint32),
                ("constraint_rows", c_uint32), ("clusters", c_uint32), ("linked_nodes", c_uint32)]


@_mirrors("dmb_sim_options")
class SimOptions(_Sized):
    _fields_ = [("struct_size", c_uint32), ("max_iterations", c_uint32), ("allocator", POINTER(Allocator)),
                ("log", LOG_FN), ("log_context", c_void_p), ("spectral_radius", c_double),
                ("newton_tolerance", c_double), ("tolerance_translation", c_double), ("tolerance_rotation", c_double),
                ("step_min", c_double), ("step_max", c_double), ("max_cuts", c_uint32), ("bounded_work", c_int32),
                ("energy_ledger", c_int32), ("max_steps", c_uint32), ("constraint_method", c_int32),
                ("reserved", c_int32)]


@_mirrors("dmb_step_report")
class StepReport(_Sized):
    _fields_ = [("struct_size", c_uint32), ("steps", c_uint32), ("iterations", c_uint32), ("rejected", c_uint32),
                ("worst", c_uint32), ("reserved", c_uint32), ("time", c_double), ("residual", c_double),
                ("last_step", c_double)]


@_mirrors("dmb_static_options")
class StaticOptions(_Sized):
    _fields_ = [("struct_size", c_uint32), ("max_iterations", c_uint32), ("tolerance", c_double),
                ("slip_axial", c_double), ("slip_rotation", c_double), ("load_steps", c_uint32),
                ("lay_on_wall", c_int32), ("steady", c_int32), ("reserved", c_int32)]


@_mirrors("dmb_static_report")
class StaticReport(_Sized):
    _fields_ = [("struct_size", c_uint32), ("iterations", c_uint32), ("load_steps", c_uint32), ("method", c_int32),
                ("residual", c_double), ("largest_force", c_double), ("lateral_move", c_double),
                ("cuts", c_uint32), ("line_searches", c_uint32), ("negative", c_int32), ("stiffness", c_int32),
                ("steady", c_int32), ("steady_reserved", c_int32)]


@_mirrors("dmb_buckling_options")
class BucklingOptions(_Sized):
    _fields_ = [("struct_size", c_uint32), ("count", c_uint32), ("scale", c_int32), ("follow", c_int32),
                ("part", Id), ("factor_max", c_double), ("tolerance", c_double), ("step", c_double),
                ("slip_axial", c_double), ("slip_rotation", c_double)]


@_mirrors("dmb_buckling_info")
class BucklingInfo(_Sized):
    _fields_ = [("struct_size", c_uint32), ("count", c_uint32), ("confirmed", c_uint32), ("linearisations", c_uint32),
                ("points", c_uint32), ("stiffness", c_int32), ("end", c_int32), ("reserved", c_int32),
                ("estimate", c_double), ("linearised_at", c_double), ("reached", c_double)]


@_mirrors("dmb_path_point")
class PathPoint(_Sized):
    _fields_ = [("struct_size", c_uint32), ("number", c_uint32), ("kind", c_int32), ("negative", c_int32),
                ("iterations", c_uint32), ("stiffness", c_int32), ("factor", c_double), ("rate", c_double),
                ("arc", c_double), ("displacement", c_double)]


_PATH_FN = CFUNCTYPE(c_int32, c_void_p, c_void_p, POINTER(PathPoint))


@_mirrors("dmb_path_options")
class PathOptions(_Sized):
    _fields_ = [("struct_size", c_uint32), ("max_points", c_uint32), ("max_iterations", c_uint32), ("scale", c_int32),
                ("part", Id), ("place", Place), ("component", c_int32), ("branch", c_int32), ("factor_end", c_double),
                ("displacement_end", c_double), ("first_step", c_double), ("step_max", c_double),
                ("branch_size", c_double), ("tolerance", c_double), ("slip_axial", c_double),
                ("slip_rotation", c_double), ("callback", _PATH_FN), ("callback_context", c_void_p)]


@_mirrors("dmb_path_report")
class PathReport(_Sized):
    _fields_ = [("struct_size", c_uint32), ("points", c_uint32), ("limits", c_uint32), ("bifurcations", c_uint32),
                ("iterations", c_uint32), ("cuts", c_uint32), ("factor", c_double), ("displacement", c_double),
                ("first_limit", c_double), ("first_bifurcation", c_double)]


@_mirrors("dmb_check_report")
class CheckReport(_Sized):
    _fields_ = [("struct_size", c_uint32), ("rigid_parts", c_uint32), ("flexible_parts", c_uint32),
                ("elements", c_uint32), ("structural_joints", c_uint32), ("joints", c_uint32 * 16),
                ("open_joints", c_uint32), ("locked_joints", c_uint32), ("couplings", c_uint32),
                ("constraints", c_uint32), ("motion_drives", c_uint32), ("other_drives", c_uint32),
                ("loads", c_uint32), ("coordinates", c_uint32), ("held", c_uint32), ("prescribed", c_uint32),
                ("rows", c_uint32), ("rank", c_uint32), ("freedoms", c_uint32), ("redundant", c_uint32),
                ("tridiagonal_nodes", c_uint32), ("sparse_nodes", c_uint32), ("blocks", c_uint32),
                ("fill", c_uint32), ("clusters", c_uint32), ("largest_cluster", c_uint32), ("warnings", c_uint32),
                ("gruebler", c_int64), ("largest_misfit", c_double), ("condition", c_double)]


@_mirrors("dmb_pose")
class Pose(_Sized):
    _fields_ = [("struct_size", c_uint32), ("reserved", c_uint32), ("position", c_double * 3),
                ("rotation", c_double * 9), ("displacement", c_double * 3), ("depth", c_double)]


@_mirrors("dmb_motion")
class Motion(_Sized):
    _fields_ = [("struct_size", c_uint32), ("frame", c_int32), ("velocity", c_double * 6),
                ("acceleration", c_double * 6)]


@_mirrors("dmb_section")
class Section(_Sized):
    _fields_ = [("struct_size", c_uint32), ("reserved", c_uint32), ("force", c_double * 6), ("strain", c_double * 6)]


@_mirrors("dmb_contact")
class Contact(_Sized):
    _fields_ = [("struct_size", c_uint32), ("closed", c_int32), ("sticks", c_int32), ("site", c_uint32), ("part", Id),
                ("pipe", c_uint32), ("reserved", c_uint32), ("length", c_double), ("gap", c_double),
                ("normal", c_double * 3), ("normal_force", c_double), ("approach", c_double),
                ("friction", c_double * 2), ("slip", c_double * 2)]


@_mirrors("dmb_contact_sum")
class ContactSum(_Sized):
    _fields_ = [("struct_size", c_uint32), ("closed", c_uint32), ("normal_force", c_double),
                ("friction", c_double * 2), ("deepest", c_double)]


@_mirrors("dmb_energy")
class Energy(_Sized):
    _fields_ = [("struct_size", c_uint32), ("reserved", c_int32), ("kinetic", c_double), ("strain", c_double),
                ("gravity", c_double), ("contact", c_double), ("drives", c_double), ("loads", c_double),
                ("friction", c_double), ("impact", c_double), ("damping", c_double), ("rock", c_double),
                ("scheme", c_double), ("input", c_double), ("balance", c_double), ("unexplained", c_double),
                ("error", c_double)]


@_mirrors("dmb_momentum")
class Momentum(_Sized):
    _fields_ = [("struct_size", c_uint32), ("reserved", c_uint32), ("linear", c_double * 3), ("angular", c_double * 3),
                ("mass", c_double), ("centre", c_double * 3)]


@_mirrors("dmb_drive_state")
class DriveState(_Sized):
    _fields_ = [("struct_size", c_uint32), ("reserved", c_uint32), ("target", c_double), ("position", c_double),
                ("speed", c_double), ("force", c_double), ("power", c_double), ("work", c_double)]


@_mirrors("dmb_joint_state")
class JointState(_Sized):
    _fields_ = [("struct_size", c_uint32), ("frame", c_int32), ("state", c_int32), ("rows", c_uint32),
                ("redundant", c_uint32), ("reserved", c_uint32), ("position", c_double * 6), ("speed", c_double * 6),
                ("acceleration", c_double * 6), ("reaction", c_double * 6), ("action", c_double * 6),
                ("misfit", c_double)]


@_mirrors("dmb_bit_state")
class BitState(_Sized):
    _fields_ = [("struct_size", c_uint32), ("on_bottom", c_int32), ("advance", c_double), ("bottom", c_double),
                ("depth_of_cut", c_double), ("weight", c_double), ("torque", c_double), ("load", c_double)]


@_mirrors("dmb_statistics")
class Statistics(_Sized):
    _fields_ = [("struct_size", c_uint32), ("worst_iterations", c_uint32), ("steps", c_uint64), ("rejected", c_uint64),
                ("iterations", c_uint64), ("limited", c_uint64), ("bytes", c_uint64), ("worst_residual", c_double),
                ("projection", c_double * 2), ("assembly", c_double * 2), ("switches", c_uint64),
                ("dependent", c_uint32), ("redundant", c_uint32), ("misfit", c_double)]


@_mirrors("dmb_channel")
class Channel(_Record):
    _fields_ = [("place", Place), ("quantity", c_int32), ("reserved", c_int32)]


@_mirrors("dmb_recorder")
class _RecorderStruct(_Sized):
    _fields_ = [("struct_size", c_uint32), ("channel_count", c_uint32), ("channels", POINTER(Channel)),
                ("table", POINTER(c_double)), ("capacity", c_uint64), ("rows", c_uint64), ("interval", c_double)]


@_mirrors("dmb_input")
class Input(_Sized):
    _fields_ = [("struct_size", c_uint32), ("kind", c_int32), ("place", Place), ("component", c_int32),
                ("frame", c_int32), ("amplitude", c_double), ("phase", c_double)]


@_mirrors("dmb_output")
class Output(_Sized):
    _fields_ = [("struct_size", c_uint32), ("kind", c_int32), ("place", Place), ("component", c_int32),
                ("frame", c_int32)]


@_mirrors("dmb_response_options")
class ResponseOptions(_Sized):
    _fields_ = [("struct_size", c_uint32), ("points", c_uint32), ("frequency_low", c_double),
                ("frequency_high", c_double), ("frequencies", POINTER(c_double)), ("logarithmic", c_int32),
                ("refinement", c_uint32), ("structural_damping", c_double), ("equilibrium_tolerance", c_double),
                ("contact", c_int32), ("friction", c_int32), ("contact_gap", c_double)]


@_mirrors("dmb_sine_options")
class SineOptions(_Sized):
    _fields_ = [("struct_size", c_uint32), ("steps_per_period", c_uint32), ("periods", c_uint32),
                ("windows", c_uint32), ("harmonics", c_uint32), ("reserved", c_uint32), ("tolerance", c_double),
                ("floor", c_double)]


@_mirrors("dmb_sine_report")
class SineReport(_Sized):
    _fields_ = [("struct_size", c_uint32), ("settled", c_int32), ("windows", c_uint32), ("rejected", c_uint32),
                ("steps", c_uint64), ("change", c_double), ("remaining", c_double), ("time", c_double)]


@_mirrors("dmb_modes_options")
class ModesOptions(_Sized):
    _fields_ = [("struct_size", c_uint32), ("kind", c_int32), ("select", c_int32), ("count", c_uint32),
                ("band", c_double * 2), ("contact", c_int32), ("friction", c_int32), ("contact_gap", c_double),
                ("equilibrium_tolerance", c_double), ("axes", c_int32), ("reserved", c_int32), ("spin", c_double)]


@_mirrors("dmb_modes_info")
class ModesInfo(_Sized):
    _fields_ = [("struct_size", c_uint32), ("count", c_uint32), ("rigid", c_uint32), ("coordinates", c_uint32),
                ("dense", c_int32), ("solves", c_uint32), ("unbalance", c_double), ("asymmetry", c_double),
                ("residual", c_double)]


@_mirrors("dmb_mode")
class Mode(_Sized):
    _fields_ = [("struct_size", c_uint32), ("rigid", c_int32), ("frequency", c_double), ("damping", c_double),
                ("eigenvalue", c_double * 2), ("kinetic", c_double), ("strain", c_double), ("share", c_double * 3),
                ("participation", c_double * 3), ("effective_mass", c_double * 3), ("whirl", c_double),
                ("strain_share", c_double * 3)]


@_mirrors("dmb_mode_shape")
class ModeShape(_Sized):
    _fields_ = [("struct_size", c_uint32), ("frame", c_int32), ("re", c_double * 6), ("im", c_double * 6)]


@_mirrors("dmb_order")
class Order(_Sized):
    _fields_ = [("struct_size", c_uint32), ("reserved", c_uint32), ("order", c_double), ("input", Input)]


@_mirrors("dmb_speeds_options")
class SpeedsOptions(_Sized):
    _fields_ = [("struct_size", c_uint32), ("points", c_uint32), ("speed_low", c_double), ("speed_high", c_double),
                ("threshold", c_double), ("margin", c_double), ("refinement", c_uint32), ("contact", c_int32),
                ("friction", c_int32), ("reserved", c_int32), ("contact_gap", c_double),
                ("structural_damping", c_double), ("equilibrium_tolerance", c_double)]


@_mirrors("dmb_speed_band")
class SpeedBand(_Sized):
    _fields_ = [("struct_size", c_uint32), ("order", c_uint32), ("output", c_uint32), ("reserved", c_uint32),
                ("low", c_double), ("high", c_double), ("speed", c_double), ("severity", c_double),
                ("frequency", c_double)]


# ---- Functions -------------------------------------------------------------------------------------------------------
def _declare_all():
    model, sim = c_void_p, c_void_p
    number, count, size, text = c_double, c_uint32, c_size_t, c_char_p
    status, buckling = c_int32, c_void_p

    def add(name, definition):
        _declare("dmb_model_add_" + name, status, model, POINTER(definition), POINTER(Id))

    def ask(name, *arguments):
        _declare("dmb_query_" + name, status, sim, *arguments)

    _declare("dmb_status_name", text, status)
    _declare("dmb_status_text", text, status)
    _declare("dmb_model_create", status, POINTER(ModelOptions), POINTER(model))
    _declare("dmb_model_destroy", None, POINTER(model))
    _declare("dmb_model_message", text, model)
    _declare("dmb_model_set_environment", status, model, POINTER(EnvironmentDef))
    _declare("dmb_model_add_programme", status, model, POINTER(Term), count, POINTER(Id))
    _declare("dmb_model_add_pipes", status, model, POINTER(PipeDef), count, POINTER(Id))
    for name, definition in (("wall", WallDef), ("string", StringDef), ("body", BodyDef), ("bit", BitDef),
                             ("joint", JointDef), ("coupling", CouplingDef), ("constraint", ConstraintDef),
                             ("drive", DriveDef), ("load", LoadDef)):
        add(name, definition)
    _declare("dmb_model_compile", status, model, POINTER(CompileOptions))
    _declare("dmb_model_get_info", status, model, POINTER(ModelInfo))
    _declare("dmb_sim_memory_size", status, model, POINTER(SimOptions), POINTER(size))
    _declare("dmb_sim_create", status, model, POINTER(SimOptions), POINTER(sim))
    _declare("dmb_sim_create_in", status, model, POINTER(SimOptions), c_void_p, size, POINTER(sim))
    _declare("dmb_sim_destroy", None, POINTER(sim))
    _declare("dmb_sim_message", text, sim)
    _declare("dmb_sim_time", number, sim)
    _declare("dmb_sim_step", status, sim, number, POINTER(StepReport))
    _declare("dmb_sim_advance", status, sim, number, POINTER(StepReport))
    _declare("dmb_sim_set_drive", status, sim, Id, number)
    _declare("dmb_sim_set_joint", status, sim, Id, c_int32)
    _declare("dmb_sim_carry_over", status, sim, sim)
    _declare("dmb_sim_snapshot_size", status, sim, POINTER(size))
    _declare("dmb_sim_snapshot", status, sim, c_void_p, size)
    _declare("dmb_sim_restore", status, sim, c_void_p, size)
    _declare("dmb_sim_hash", status, sim, POINTER(c_uint64))
    _declare("dmb_analysis_static", status, sim, POINTER(StaticOptions), POINTER(StaticReport))
    _declare("dmb_analysis_buckling", status, sim, POINTER(BucklingOptions), POINTER(buckling))
    _declare("dmb_buckling_get_info", status, buckling, POINTER(BucklingInfo))
    _declare("dmb_analysis_path", status, sim, POINTER(PathOptions), POINTER(PathReport))
    _declare("dmb_buckling_destroy", None, POINTER(buckling))
    _declare("dmb_buckling_count", count, buckling)
    _declare("dmb_buckling_factor", status, buckling, count, POINTER(number))
    _declare("dmb_buckling_shape", status, buckling, count, Place, POINTER(number))
    _declare("dmb_analysis_check", status, sim, POINTER(CheckReport))
    _declare("dmb_analysis_check_text", status, sim, text, size, POINTER(size))
    response = c_void_p
    _declare("dmb_analysis_response", status, sim, POINTER(ResponseOptions), POINTER(Input), count, POINTER(Output),
             count, POINTER(response))
    _declare("dmb_analysis_sine", status, sim, number, POINTER(SineOptions), POINTER(Output), count,
             POINTER(number), POINTER(SineReport))
    _declare("dmb_analysis_speeds", status, sim, POINTER(SpeedsOptions), POINTER(Order), count, POINTER(Output),
             POINTER(number), count, POINTER(SpeedBand), POINTER(c_uint32), POINTER(number))
    _declare("dmb_response_destroy", None, POINTER(response))
    _declare("dmb_response_shape", status, response, POINTER(c_uint32))
    _declare("dmb_response_frequencies", status, response, POINTER(number))
    _declare("dmb_response_transfer", status, response, count, count, POINTER(number))
    _declare("dmb_response_write_csv", status, response, text)
    modes = c_void_p
    _declare("dmb_analysis_modes", status, sim, POINTER(ModesOptions), POINTER(modes))
    _declare("dmb_modes_destroy", None, POINTER(modes))
    _declare("dmb_modes_get_info", status, modes, POINTER(ModesInfo))
    _declare("dmb_modes_get", status, modes, count, POINTER(Mode))
    _declare("dmb_modes_shape", status, modes, count, Place, POINTER(ModeShape))
    _declare("dmb_modes_part", status, modes, count, Id, count, POINTER(number), POINTER(number))
    _declare("dmb_write_vtk_mode", status, modes, count, number, number, count, text)
    ask("pose", Place, POINTER(Pose))
    ask("motion", Place, POINTER(Motion))
    ask("rotation", Place, POINTER(number))
    ask("section", Place, POINTER(Section))
    ask("contact", count, POINTER(Contact))
    ask("contact_sum", POINTER(ContactSum))
    ask("kinetic_energy", Id, count, POINTER(number))
    ask("energy", POINTER(Energy))
    ask("momentum", POINTER(Momentum))
    ask("drive", Id, POINTER(DriveState))
    ask("reaction", Id, POINTER(number))
    ask("joint", Id, POINTER(JointState))
    ask("multipliers", Id, POINTER(number), POINTER(c_uint32))
    ask("bit", Id, POINTER(BitState))
    ask("statistics", POINTER(Statistics))
    _declare("dmb_recorder_take", status, POINTER(_RecorderStruct), sim)
    _declare("dmb_recorder_write_csv", status, POINTER(_RecorderStruct), text)
    _declare("dmb_write_vtk_strings", status, sim, count, text)
    _declare("dmb_write_vtk_hole", status, model, number, number, number, count, text)


_declare_all()


# ---- Errors ----------------------------------------------------------------------------------------------------------
def status_name(status):
    return _lib.dmb_status_name(status).decode()


def status_text(status):
    return _lib.dmb_status_text(status).decode()


class Error(Exception):
    """A call that was refused or failed, with nothing changed. status, name ("DMB_ERR_VALUE") and message tell why."""

    def __init__(self, status, message=""):
        self.status, self.name, self.message = status, status_name(status), message or status_text(status)
        super().__init__(f"{self.name}: {self.message}")


def _check(status, message=b""):
    if status < 0:
        raise Error(status, message.decode())
    return status


# ---- Help with arguments ---------------------------------------------------------------------------------------------
def _numbers(values, count):
    values = list(values)
    if len(values) != count:
        raise ValueError(f"{count} numbers are needed, {len(values)} given")
    return values


def _flat(values):
    """A number, a sequence, or a sequence of sequences as one list."""
    try:
        values = list(values)
    except TypeError:
        return [float(values)]
    return [number for value in values for number in _flat(value)]


def _struct(cls, given, fields):
    """The caller's struct, or one made of keywords."""
    if given is None:
        return cls(**fields)
    if fields:
        raise TypeError(f"give a {cls.__name__} or its fields, not both")
    if not isinstance(given, cls):
        raise TypeError(f"a {cls.__name__} is needed, {type(given).__name__} given")
    return given


def _as_id(part):
    return Id() if part is None else part


def _path(path):
    return os.fsencode(path)


class _Keep:
    """What the library may still call back: held by the model and by every sim made from it. What a callback raises is
    kept until the call returns in the same thread."""

    def __init__(self):
        self.references = []
        self.raised = threading.local()

    def programme(self, function, provides):
        """The C function around a Python function of time. An exception stops the step and comes out of the call."""
        wanted = 3 if provides & PROVIDES_INTEGRAL else 2 if provides & PROVIDES_RATE else 1

        def call(_context, time, out):
            try:
                answer = function(time)
                answer = tuple(answer) if wanted > 1 else (answer,)
                for i, value in enumerate(_numbers(answer, wanted)):
                    out[i] = value
                return 0
            except BaseException as error:  # must not unwind through C
                self.raised.error = error
                return 1

        wrapped = PROGRAMME_FN(call)
        self.references.append(wrapped)
        return wrapped

    def constraint(self, function, rows, provides):
        """The C function around a Python function of time and poses."""
        def call(_context, time, count, poses, value, jacobian):
            try:
                answer = function(time, [list(poses[i]) for i in range(count)])
                values, derivatives = answer if provides & PROVIDES_JACOBIAN else (answer, None)
                for i, number in enumerate(_numbers(_flat(values), rows)):
                    value[i] = number
                if derivatives is not None:
                    for i, number in enumerate(_numbers(_flat(derivatives), 6 * rows * count)):
                        jacobian[i] = number
                return 0
            except BaseException as error:  # must not unwind through C
                self.raised.error = error
                return 1

        wrapped = CONSTRAINT_FN(call)
        self.references.append(wrapped)
        return wrapped

    def log(self, function):
        def call(_context, level, text):
            try:
                function(level, text.decode(errors="replace"))
            except BaseException as error:
                self.raised.error = error

        wrapped = LOG_FN(call)
        self.references.append(wrapped)
        return wrapped

    def check(self, status, message):
        """Raises Error for a failed call, because of what a callback raised if there is such."""
        raised, self.raised.error = getattr(self.raised, "error", None), None
        if raised is not None and not isinstance(raised, Exception):
            raise raised  # KeyboardInterrupt and the like
        if status < 0:
            raise Error(status, message.decode()) from raised
        return status


# ---- Model -----------------------------------------------------------------------------------------------------------
class Model:
    """A scene. Describe it with the add_ functions, compile it once, then make any number of sims of it."""

    def __init__(self, log=None):
        self._keep = _Keep()
        self._handle = c_void_p()
        options = ModelOptions()
        if log is not None:
            options.log = self._keep.log(log)
        self._keep.check(_lib.dmb_model_create(byref(options), byref(self._handle)), b"")

    def close(self):
        """Gives the model back; its sims go on."""
        _lib.dmb_model_destroy(byref(self._handle))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def __del__(self):
        if getattr(self, "_handle", None) and _lib is not None:
            self.close()

    @property
    def message(self):
        return _lib.dmb_model_message(self._handle).decode()

    def _check(self, status):
        return self._keep.check(status, _lib.dmb_model_message(self._handle))

    def _add(self, function, cls, given, fields):
        part, definition = Id(), _struct(cls, given, fields)
        self._check(function(self._handle, byref(definition), byref(part)))
        return part

    def set_environment(self, definition=None, **fields):
        definition = _struct(EnvironmentDef, definition, fields)
        self._check(_lib.dmb_model_set_environment(self._handle, byref(definition)))

    def add_programme(self, *terms):
        """A programme of one or more terms. A number stands for a constant term, a function of time for a callback."""
        array = (Term * len(terms))()
        for i, term in enumerate(terms):
            array[i] = self._term(term)
        part = Id()
        self._check(_lib.dmb_model_add_programme(self._handle, array, len(terms), byref(part)))
        return part

    def _term(self, term):
        if callable(term):
            term = Term(function=term)
        elif not isinstance(term, Term):
            term = Term(h0=float(term))
        function = getattr(term, "_function", None)
        if function is not None:
            term.callback = self._keep.programme(function, term.provides)
        return term

    def add_wall(self, definition=None, **fields):
        return self._add(_lib.dmb_model_add_wall, WallDef, definition, fields)

    def add_string(self, definition=None, **fields):
        return self._add(_lib.dmb_model_add_string, StringDef, definition, fields)

    def add_pipes(self, count=1, definition=None, **fields):
        """Appends equal pipes; returns the string they belong to."""
        string, definition = Id(), _struct(PipeDef, definition, fields)
        self._check(_lib.dmb_model_add_pipes(self._handle, byref(definition), count, byref(string)))
        return string

    def add_body(self, definition=None, **fields):
        return self._add(_lib.dmb_model_add_body, BodyDef, definition, fields)

    def add_bit(self, definition=None, **fields):
        return self._add(_lib.dmb_model_add_bit, BitDef, definition, fields)

    def add_joint(self, definition=None, **fields):
        return self._add(_lib.dmb_model_add_joint, JointDef, definition, fields)

    def add_coupling(self, definition=None, **fields):
        return self._add(_lib.dmb_model_add_coupling, CouplingDef, definition, fields)

    def add_constraint(self, definition=None, **fields):
        definition = _struct(ConstraintDef, definition, fields)
        function = getattr(definition, "_function", None)
        if function is not None:
            definition.callback = self._keep.constraint(function, definition.rows, definition.provides)
        return self._add(_lib.dmb_model_add_constraint, ConstraintDef, definition, {})

    def add_drive(self, definition=None, **fields):
        return self._add(_lib.dmb_model_add_drive, DriveDef, definition, fields)

    def add_load(self, definition=None, **fields):
        return self._add(_lib.dmb_model_add_load, LoadDef, definition, fields)

    def compile(self, options=None, **fields):
        """Checks and freezes the scene; returns the status."""
        options = _struct(CompileOptions, options, fields)
        return self._check(_lib.dmb_model_compile(self._handle, byref(options)))

    def info(self):
        info = ModelInfo()
        info.status = self._check(_lib.dmb_model_get_info(self._handle, byref(info)))
        return info

    def sim_memory_size(self, options=None, **fields):
        size, options = c_size_t(), _struct(SimOptions, options, fields)
        self._check(_lib.dmb_sim_memory_size(self._handle, byref(options), byref(size)))
        return size.value

    def sim(self, options=None, log=None, **fields):
        """A sim of the compiled scene at time 0."""
        return Sim(self, options, log, **fields)

    def write_vtk_hole(self, path, depth0, depth1, spacing=1.0, around=24):
        self._check(_lib.dmb_write_vtk_hole(self._handle, depth0, depth1, spacing, around, _path(path)))


# ---- Sim -------------------------------------------------------------------------------------------------------------
class Sim:
    """All that changes. One thread at a time; the library does not hold Python's lock while it runs."""

    def __init__(self, model, options=None, log=None, **fields):
        self._handle = c_void_p()
        self._keep = _Keep()  # its own log
        self._scene = model._keep  # callbacks live as long as the last sim
        options = _struct(SimOptions, options, fields)
        said = []

        def tell(level, text):
            said.append(text)
            if log is not None:
                log(level, text)

        options.log = self._keep.log(tell)
        status = _lib.dmb_sim_create(model._handle, byref(options), byref(self._handle))
        self._keep.check(OK, b"")
        self.status = self._scene.check(status, said[-1].encode() if said else b"")

    def close(self):
        _lib.dmb_sim_destroy(byref(self._handle))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def __del__(self):
        if getattr(self, "_handle", None) and _lib is not None:
            self.close()

    @property
    def message(self):
        return _lib.dmb_sim_message(self._handle).decode()

    @property
    def time(self):
        """[s] of the last accepted state"""
        return _lib.dmb_sim_time(self._handle)

    def _check(self, status):
        return self._scene.check(status, _lib.dmb_sim_message(self._handle) if status < 0 else b"")

    def _run(self, function, value):
        report = StepReport()
        report.status = self._check(function(self._handle, value, byref(report)))
        return report

    def step(self, duration):
        """Advances by duration [s]; returns the report, whose status may be a note."""
        return self._run(_lib.dmb_sim_step, duration)

    def advance(self, time):
        """Advances to time [s] with steps of its own choice."""
        return self._run(_lib.dmb_sim_advance, time)

    def static(self, options=None, **fields):
        """Puts the sim at rest in equilibrium; returns the report."""
        options, report = _struct(StaticOptions, options, fields), StaticReport()
        report.status = self._check(_lib.dmb_analysis_static(self._handle, byref(options), byref(report)))
        return report

    def buckling(self, options=None, **fields):
        """Critical factors and shapes about the present static state."""
        return Buckling(self, _struct(BucklingOptions, options, fields))

    def path(self, visit=None, options=None, **fields):
        """Follows the path of equilibrium from here; returns the report. visit(at, point) is called at each point with a
        sim that stands there and may be asked until it returns; what is true stops the path."""
        options, report, raised = _struct(PathOptions, options, fields), PathReport(), []

        def call(_context, handle, point):
            at = _SimAt(self, handle)
            try:
                return 1 if visit(at, PathPoint.from_buffer_copy(point.contents)) else 0
            except BaseException as error:  # must not unwind through C
                raised.append(error)
                return 1
            finally:
                at.close()

        if visit is not None:
            options.callback = _PATH_FN(call)
        report.status = self._check(_lib.dmb_analysis_path(self._handle, byref(options), byref(report)))
        if raised:
            raise raised[0]
        return report

    def check(self):
        """Parts, joints, degrees of freedom, redundant equations and the number of warnings: the model check."""
        report = CheckReport()
        report.status = self._scene.check(_lib.dmb_analysis_check(self._handle, byref(report)), b"")
        return report

    def check_text(self):
        """The model check as a sheet of text, redundant equations and warnings by name."""
        size = c_size_t()
        self._scene.check(_lib.dmb_analysis_check_text(self._handle, None, 0, byref(size)), b"")
        text = ctypes.create_string_buffer(size.value)
        self._scene.check(_lib.dmb_analysis_check_text(self._handle, text, size.value, None), b"")
        return text.value.decode()

    def response(self, inputs, outputs, options=None, frequencies=None, **fields):
        """Frequency response from every Input to every Output about the present state, at `frequencies` [Hz] or on the
        grid that the ResponseOptions describe."""
        options = _struct(ResponseOptions, options, fields)
        if frequencies is not None:
            frequencies = [float(f) for f in frequencies]
            options.frequencies, options.points = (c_double * len(frequencies))(*frequencies), len(frequencies)
        inputs, outputs = (Input * len(inputs))(*inputs), (Output * len(outputs))(*outputs)
        handle = c_void_p()
        self._check(_lib.dmb_analysis_response(self._handle, byref(options), inputs, len(inputs), outputs,
                                               len(outputs), byref(handle)))
        return Response(handle)

    def sine(self, frequency, outputs, options=None, **fields):
        """Runs on until the Fourier amplitudes at frequency [Hz] have settled. Returns a list for each Output, mean and
        then the complex harmonics, and the report, whose status may be NOTE_STOPPED."""
        options, report = _struct(SineOptions, options, fields), SineReport()
        outputs, width = (Output * len(outputs))(*outputs), 1 + options.harmonics
        values = (c_double * (2 * width * len(outputs)))()
        report.status = self._check(_lib.dmb_analysis_sine(self._handle, frequency, byref(options), outputs,
                                                           len(outputs), values, byref(report)))
        numbers = [complex(values[2 * i], values[2 * i + 1]) for i in range(width * len(outputs))]
        return [[numbers[i * width].real] + numbers[i * width + 1:(i + 1) * width]
                for i in range(len(outputs))], report

    def modes(self, options=None, **fields):
        """Natural frequencies and modes about the present state, as the ModesOptions say: a Modes, a sequence of Mode."""
        options, handle = _struct(ModesOptions, options, fields), c_void_p()
        self._check(_lib.dmb_analysis_modes(self._handle, byref(options), byref(handle)))
        return Modes(handle, self._scene)

    def speeds(self, orders, outputs, limits, room=64, options=None, **fields):
        """Bands of rotary speed to avoid, at most `room` of them, and the severity at the speeds of the grid: each Order
        shakes, and limits are the amplitudes allowed of the Outputs."""
        options = _struct(SpeedsOptions, options, fields)
        limits = (c_double * len(outputs))(*_numbers(limits, len(outputs)))
        orders, outputs = (Order * len(orders))(*orders), (Output * len(outputs))(*outputs)
        bands, count = (SpeedBand * room)(*[SpeedBand() for _ in range(room)]), c_uint32(room)
        severity = (c_double * options.points)()
        self._check(_lib.dmb_analysis_speeds(self._handle, byref(options), orders, len(orders), outputs, limits,
                                             len(outputs), bands, byref(count), severity))
        return list(bands)[:count.value], list(severity)

    def set_drive(self, drive, value):
        """The drive's programme is the constant value from now on; None: its programme again."""
        self._check(_lib.dmb_sim_set_drive(self._handle, drive, float("nan") if value is None else value))

    def set_joint(self, joint, state):
        """The joint is JOINT_ACTIVE, JOINT_LOCKED or JOINT_OPEN from now on; returns the status, NOTE_PROJECTED if
        speeds changed."""
        return self._check(_lib.dmb_sim_set_joint(self._handle, joint, state))

    def carry_over(self, other):
        """Goes on where `other` stands, a sim of another model: pipes may have come or gone at the rig end."""
        return self._check(_lib.dmb_sim_carry_over(self._handle, other._handle))

    def snapshot(self):
        """All that changes, as bytes."""
        size = c_size_t()
        self._check(_lib.dmb_sim_snapshot_size(self._handle, byref(size)))
        block = ctypes.create_string_buffer(size.value)
        self._check(_lib.dmb_sim_snapshot(self._handle, block, size.value))
        return block.raw

    def restore(self, snapshot):
        snapshot = bytes(snapshot)
        self._check(_lib.dmb_sim_restore(self._handle, snapshot, len(snapshot)))

    def hash(self):
        found = c_uint64()
        self._check(_lib.dmb_sim_hash(self._handle, byref(found)))
        return found.value

    def _ask(self, function, answer, *arguments):
        answer.status = _check(function(self._handle, *arguments, byref(answer)))  # queries leave no message
        return answer

    def _ask_number(self, function, *arguments):
        value = c_double()
        _check(function(self._handle, *arguments, byref(value)))
        return value.value

    def pose(self, place):
        return self._ask(_lib.dmb_query_pose, Pose(), place)

    def motion(self, place, frame=FRAME_WORLD):
        return self._ask(_lib.dmb_query_motion, Motion(frame=frame), place)

    def rotation(self, place):
        """[rad] about the pipe's own axis since time 0, revolutions counted"""
        return self._ask_number(_lib.dmb_query_rotation, place)

    def section(self, place):
        return self._ask(_lib.dmb_query_section, Section(), place)

    def contact(self, site):
        return self._ask(_lib.dmb_query_contact, Contact(), site)

    def contact_sum(self):
        return self._ask(_lib.dmb_query_contact_sum, ContactSum())

    def kinetic_energy(self, part, pipe=0):
        """[J] of one pipe of a string, or of a body"""
        return self._ask_number(_lib.dmb_query_kinetic_energy, part, pipe)

    def energy(self):
        return self._ask(_lib.dmb_query_energy, Energy())

    def momentum(self):
        return self._ask(_lib.dmb_query_momentum, Momentum())

    def drive(self, drive):
        return self._ask(_lib.dmb_query_drive, DriveState(), drive)

    def reaction(self, part):
        """[N, N m] of guide and motion drives on the rig end of a string or a body, body frame, six numbers"""
        values = (c_double * 6)()
        _check(_lib.dmb_query_reaction(self._handle, part, values))
        return list(values)

    def joint(self, joint, frame=FRAME_WORLD):
        return self._ask(_lib.dmb_query_joint, JointState(frame=frame), joint)

    def multipliers(self, part):
        """[N, N m per unit of its value] of a joint, coupling, constraint or joint drive, one for each row"""
        values, count = (c_double * 6)(), c_uint32()
        _check(_lib.dmb_query_multipliers(self._handle, part, values, byref(count)))
        return list(values)[:count.value]

    def bit(self, bit):
        return self._ask(_lib.dmb_query_bit, BitState(), bit)

    def statistics(self):
        return self._ask(_lib.dmb_query_statistics, Statistics())

    def recorder(self, channels, capacity, interval=0.0):
        return Recorder(self, channels, capacity, interval)

    def write_vtk(self, path, per_element=8):
        _check(_lib.dmb_write_vtk_strings(self._handle, per_element, _path(path)))


# ---- Frequency response ----------------------------------------------------------------------------------------------
class Response:
    """Transfer functions that Sim.response has found."""

    def __init__(self, handle):
        self._handle = handle
        self.shape = (c_uint32 * 3)()
        _check(_lib.dmb_response_shape(handle, self.shape))
        self.shape = tuple(self.shape)  # points, inputs, outputs

    def __del__(self):
        _lib.dmb_response_destroy(byref(self._handle))

    @property
    def frequencies(self):
        """[Hz] ascending: a numpy array, or a list."""
        values = (c_double * self.shape[0])()
        _check(_lib.dmb_response_frequencies(self._handle, values))
        return numpy.array(values) if numpy is not None else list(values)

    def transfer(self, input=COMBINED, output=0):
        """The output per unit of the input, or for all inputs with their amplitudes and phases (COMBINED): complex
        numbers, one for each frequency."""
        values = (c_double * (2 * self.shape[0]))()
        _check(_lib.dmb_response_transfer(self._handle, input, output, values))
        if numpy is not None:
            return numpy.array(values).view(complex)
        return [complex(values[2 * i], values[2 * i + 1]) for i in range(self.shape[0])]

    def write_csv(self, path):
        _check(_lib.dmb_response_write_csv(self._handle, _path(path)))


class _SimAt(Sim):
    """A sim that the library lends to a callback."""

    def __init__(self, of, handle):
        self._handle, self._keep, self._scene = c_void_p(handle), of._keep, of._scene

    def close(self):
        self._handle = None


# ---- Buckling --------------------------------------------------------------------------------------------------------
class Buckling:
    """Critical factors, rising, and their shapes. status is NOTE_STOPPED where fewer were found than asked for,
    NOTE_EXTRAPOLATED where info.confirmed is less than their number."""

    def __init__(self, sim, options):
        self._handle = c_void_p()
        self._scene = sim._scene  # the model's callbacks
        self.status = sim._check(_lib.dmb_analysis_buckling(sim._handle, byref(options), byref(self._handle)))
        self.info = BucklingInfo()
        _check(_lib.dmb_buckling_get_info(self._handle, byref(self.info)))
        value = c_double()
        self.factors = []
        for mode in range(_lib.dmb_buckling_count(self._handle)):
            _check(_lib.dmb_buckling_factor(self._handle, mode, byref(value)))
            self.factors.append(value.value)

    def shape(self, mode, place):
        """[m, rad] displacement and rotation of a section, world frame"""
        values = (c_double * 6)()
        _check(_lib.dmb_buckling_shape(self._handle, mode, place, values))
        return list(values)

    def close(self):
        _lib.dmb_buckling_destroy(byref(self._handle))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def __del__(self):
        if getattr(self, "_handle", None) and _lib is not None:
            self.close()


# ---- Modes -----------------------------------------------------------------------------------------------------------
class Modes:
    """Modes that Sim.modes has found, by rising frequency: modes[0].frequency, len(modes)."""

    def __init__(self, handle, scene):
        self._handle, self._scene = handle, scene
        self.info = ModesInfo()
        _check(_lib.dmb_modes_get_info(handle, byref(self.info)))

    def __del__(self):
        if _lib is not None:
            _lib.dmb_modes_destroy(byref(self._handle))

    def __len__(self):
        return self.info.count

    def __getitem__(self, index):
        if not 0 <= index < len(self):
            raise IndexError(index)
        mode = Mode()
        _check(_lib.dmb_modes_get(self._handle, index, byref(mode)))
        return mode

    def shape(self, index, place, frame=FRAME_WORLD):
        """Displacement and rotation at a place, real and imaginary part: re, im"""
        shape = ModeShape(frame=frame)
        _check(_lib.dmb_modes_shape(self._handle, index, place, byref(shape)))
        return shape

    def part(self, index, part, pipe=0xFFFFFFFF):
        """[J] kinetic and strain energy of a mode in a pipe of a string, in a whole string, or (pipe 0) in a body"""
        kinetic, strain = c_double(), c_double()
        _check(_lib.dmb_modes_part(self._handle, index, _as_id(part), pipe, byref(kinetic), byref(strain)))
        return kinetic.value, strain.value

    def write_vtk(self, index, path, scale=1.0, phase=0.0, per_element=8):
        """A frame of the mode's animation."""
        _check(_lib.dmb_write_vtk_mode(self._handle, index, scale, phase, per_element, _path(path)))


# ---- Recorder --------------------------------------------------------------------------------------------------------
class Recorder:
    """A table of rows (time, channels...). channels are pairs (place, CHANNEL_...); a part stands for its reference
    point, None for a channel without a place. Call take() after every step."""

    def __init__(self, sim, channels, capacity, interval=0.0):
        self._sim = sim
        self._channels = (Channel * len(channels))(*[self._channel(*channel) for channel in channels])
        self._width = 1 + len(channels)
        numbers = capacity * self._width
        if numpy is not None:
            self._memory = numpy.zeros((capacity, self._width))
            table = self._memory.ctypes.data_as(POINTER(c_double))
        else:
            self._memory = (c_double * numbers)()
            table = ctypes.cast(self._memory, POINTER(c_double))
        self._struct = _RecorderStruct(channel_count=len(channels), capacity=capacity, interval=interval)
        self._struct.channels = ctypes.cast(self._channels, POINTER(Channel))
        self._struct.table = table

    @staticmethod
    def _channel(place, quantity):
        if not isinstance(place, Place):
            place = station(_as_id(place))
        return Channel(place, quantity, 0)

    def take(self):
        """Writes a row if its time has come; returns the status, NOTE_FULL when there is no room."""
        return _check(_lib.dmb_recorder_take(byref(self._struct), self._sim._handle))

    def __len__(self):
        return self._struct.rows

    @property
    def table(self):
        """The rows so far: a numpy array of shape (rows, 1 + channels) that shares memory, or a list of tuples."""
        if numpy is not None:
            return self._memory[:len(self)]
        width = self._width
        return [tuple(self._memory[i * width:(i + 1) * width]) for i in range(len(self))]

    def write_csv(self, path):
        _check(_lib.dmb_recorder_write_csv(byref(self._struct), _path(path)))
