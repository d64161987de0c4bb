"""The constants of the C interface as enumerations, and its version. Made from the headers by generate.py: do not edit, run that instead."""

from enum import IntEnum, IntFlag

VERSION = (0, 1, 0)
__version__ = "0.1.0"


class Status(IntEnum):
    """Values DMB_... of the headers.

    OK: done
    NOTE_STEP_CUT: done; the step was divided to converge
    NOTE_WORK_LIMITED: done; the bounded number of iterations was used up above the tolerance
    NOTE_PROJECTED: done; poses or velocities were projected onto the allowed motion
    NOTE_STOPPED: done; stopped early: bound on steps, or function of accepted steps
    NOTE_FULL: done; the caller's memory is full, nothing more is recorded
    NOTE_TOLERANCE: done; the smallest step allowed was too long for the error tolerance
    NOTE_UNSTABLE: done; the equilibrium that was found is not stable
    NOTE_NOT_STEADY: done; drives move but no steady state was found: only their components have a speed
    NOTE_EXTRAPOLATED: done; some of the results are extrapolations that were not confirmed
    NOTE_CANCELLED: done up to where the caller's progress function ended it
    NOTE_INCOMPLETE: done; the scene or the range leaves something out: see the message
    NOTE_FLUTTER: done; a mode grows before the stiffness is singular, the message states from where on
    NOTE_CLAMPED: done; a value beyond its bounds was taken for the bound
    NOTE_NOT_SMOOTH: done; a derivative is the mean of both sides of a breakpoint
    NOTE_EVENT: done up to an event, the message names it
    ERR_NULL: a required pointer is NULL
    ERR_HANDLE: not a live object of this kind
    ERR_STRUCT_SIZE: struct_size is not a size of this library; fill structs by their _default first
    ERR_ID: the id does not name a part of this model
    ERR_VALUE: a value lies outside its bounds
    ERR_NOT_FINITE: a value is NaN or infinite
    ERR_ORDER: the call does not fit the state of the object
    ERR_NO_MEMORY: memory could not be allocated
    ERR_TOO_LARGE: a size overflows or exceeds its limit
    ERR_SINGULAR: a stiffness or iteration matrix is singular
    ERR_NO_CONVERGENCE: the iteration did not converge
    ERR_CALLBACK: a callback failed or returned a value beyond +-1e30
    ERR_IO: a file could not be written
    ERR_ROTATION: relative rotation in one element exceeds 2.5 rad
    ERR_GEOMETRY: parts do not fit together
    ERR_UNSUPPORTED: a combination that this version does not offer
    ERR_CANCELLED: the caller's progress function ended the call
    """
    OK = 0
    NOTE_STEP_CUT = 1
    NOTE_WORK_LIMITED = 2
    NOTE_PROJECTED = 3
    NOTE_STOPPED = 4
    NOTE_FULL = 5
    NOTE_TOLERANCE = 6
    NOTE_UNSTABLE = 7
    NOTE_NOT_STEADY = 8
    NOTE_EXTRAPOLATED = 9
    NOTE_CANCELLED = 10
    NOTE_INCOMPLETE = 11
    NOTE_FLUTTER = 12
    NOTE_CLAMPED = 13
    NOTE_NOT_SMOOTH = 14
    NOTE_EVENT = 15
    ERR_NULL = -1
    ERR_HANDLE = -2
    ERR_STRUCT_SIZE = -3
    ERR_ID = -4
    ERR_VALUE = -5
    ERR_NOT_FINITE = -6
    ERR_ORDER = -7
    ERR_NO_MEMORY = -8
    ERR_TOO_LARGE = -9
    ERR_SINGULAR = -10
    ERR_NO_CONVERGENCE = -11
    ERR_CALLBACK = -12
    ERR_IO = -13
    ERR_ROTATION = -14
    ERR_GEOMETRY = -15
    ERR_UNSUPPORTED = -16
    ERR_CANCELLED = -17


OK = Status.OK
NOTE_STEP_CUT = Status.NOTE_STEP_CUT
NOTE_WORK_LIMITED = Status.NOTE_WORK_LIMITED
NOTE_PROJECTED = Status.NOTE_PROJECTED
NOTE_STOPPED = Status.NOTE_STOPPED
NOTE_FULL = Status.NOTE_FULL
NOTE_TOLERANCE = Status.NOTE_TOLERANCE
NOTE_UNSTABLE = Status.NOTE_UNSTABLE
NOTE_NOT_STEADY = Status.NOTE_NOT_STEADY
NOTE_EXTRAPOLATED = Status.NOTE_EXTRAPOLATED
NOTE_CANCELLED = Status.NOTE_CANCELLED
NOTE_INCOMPLETE = Status.NOTE_INCOMPLETE
NOTE_FLUTTER = Status.NOTE_FLUTTER
NOTE_CLAMPED = Status.NOTE_CLAMPED
NOTE_NOT_SMOOTH = Status.NOTE_NOT_SMOOTH
NOTE_EVENT = Status.NOTE_EVENT
ERR_NULL = Status.ERR_NULL
ERR_HANDLE = Status.ERR_HANDLE
ERR_STRUCT_SIZE = Status.ERR_STRUCT_SIZE
ERR_ID = Status.ERR_ID
ERR_VALUE = Status.ERR_VALUE
ERR_NOT_FINITE = Status.ERR_NOT_FINITE
ERR_ORDER = Status.ERR_ORDER
ERR_NO_MEMORY = Status.ERR_NO_MEMORY
ERR_TOO_LARGE = Status.ERR_TOO_LARGE
ERR_SINGULAR = Status.ERR_SINGULAR
ERR_NO_CONVERGENCE = Status.ERR_NO_CONVERGENCE
ERR_CALLBACK = Status.ERR_CALLBACK
ERR_IO = Status.ERR_IO
ERR_ROTATION = Status.ERR_ROTATION
ERR_GEOMETRY = Status.ERR_GEOMETRY
ERR_UNSUPPORTED = Status.ERR_UNSUPPORTED
ERR_CANCELLED = Status.ERR_CANCELLED


class Has(IntEnum):
    """Values DMB_HAS_... of the headers."""
    LAPACK = 0
    FILES = 1
    HEAP = 2


HAS_LAPACK = Has.LAPACK
HAS_FILES = Has.FILES
HAS_HEAP = Has.HEAP


class LogLevel(IntEnum):
    """Values DMB_LOG_... of the headers."""
    ERROR = 0
    WARNING = 1
    INFO = 2


LOG_ERROR = LogLevel.ERROR
LOG_WARNING = LogLevel.WARNING
LOG_INFO = LogLevel.INFO


class Name(IntEnum):
    """Values DMB_NAME_... of the headers."""
    SIZE = 24


NAME_SIZE = Name.SIZE


class PartKind(IntEnum):
    """Values DMB_PART_... of the headers."""
    ANY = 0
    TIME_FUNCTION = 1
    WALL = 2
    STRING = 3
    BODY = 4
    BIT = 5
    DRIVE = 6
    LOAD = 7
    JOINT = 8
    COUPLING = 9
    CONSTRAINT = 10
    SPRING = 11
    FORCE = 12
    STABILISER = 13
    STUCK = 14
    INPUT = 20
    EVENT = 21


PART_ANY = PartKind.ANY
PART_TIME_FUNCTION = PartKind.TIME_FUNCTION
PART_WALL = PartKind.WALL
PART_STRING = PartKind.STRING
PART_BODY = PartKind.BODY
PART_BIT = PartKind.BIT
PART_DRIVE = PartKind.DRIVE
PART_LOAD = PartKind.LOAD
PART_JOINT = PartKind.JOINT
PART_COUPLING = PartKind.COUPLING
PART_CONSTRAINT = PartKind.CONSTRAINT
PART_SPRING = PartKind.SPRING
PART_FORCE = PartKind.FORCE
PART_STABILISER = PartKind.STABILISER
PART_STUCK = PartKind.STUCK
PART_INPUT = PartKind.INPUT
PART_EVENT = PartKind.EVENT


class Component(IntEnum):
    """Values DMB_... of the headers."""
    X = 0
    Y = 1
    Z = 2
    RX = 3
    RY = 4
    RZ = 5


X = Component.X
Y = Component.Y
Z = Component.Z
RX = Component.RX
RY = Component.RY
RZ = Component.RZ


class Free(IntFlag):
    """Bits DMB_FREE_... of the headers.

    CYLINDRICAL: along and about one axis: X, RX; _Y: Y, RY; _Z: Z, RZ
    PLANAR: normal x: Y, Z, RX; _Y: X, Z, RY; _Z: X, Y, RZ
    SCHOENFLIES: X, Y, Z with RX; _Y: with RY; _Z: with RZ
    """
    X = 256
    Y = 512
    Z = 1024
    RX = 2048
    RY = 4096
    RZ = 8192
    NONE = 16384
    XY = 768
    XZ = 1280
    YZ = 1536
    TRANSLATIONS = 1792
    SPHERICAL = 14336
    ALL = 16128
    CYLINDRICAL = 2304
    CYLINDRICAL_Y = 4608
    CYLINDRICAL_Z = 9216
    PLANAR = 3584
    PLANAR_Y = 5376
    PLANAR_Z = 8960
    SCHOENFLIES = 3840
    SCHOENFLIES_Y = 5888
    SCHOENFLIES_Z = 9984


FREE_X = Free.X
FREE_Y = Free.Y
FREE_Z = Free.Z
FREE_RX = Free.RX
FREE_RY = Free.RY
FREE_RZ = Free.RZ
FREE_NONE = Free.NONE
FREE_XY = Free.XY
FREE_XZ = Free.XZ
FREE_YZ = Free.YZ
FREE_TRANSLATIONS = Free.TRANSLATIONS
FREE_SPHERICAL = Free.SPHERICAL
FREE_ALL = Free.ALL
FREE_CYLINDRICAL = Free.CYLINDRICAL
FREE_CYLINDRICAL_Y = Free.CYLINDRICAL_Y
FREE_CYLINDRICAL_Z = Free.CYLINDRICAL_Z
FREE_PLANAR = Free.PLANAR
FREE_PLANAR_Y = Free.PLANAR_Y
FREE_PLANAR_Z = Free.PLANAR_Z
FREE_SCHOENFLIES = Free.SCHOENFLIES
FREE_SCHOENFLIES_Y = Free.SCHOENFLIES_Y
FREE_SCHOENFLIES_Z = Free.SCHOENFLIES_Z


class SegmentKind(IntEnum):
    """Values DMB_SEGMENT_... of the headers.

    CONSTANT: h0
    STEP: h0 before x0, h1 after x1, D^2 (3 - 2D) between, D = (t - x0)/(x1 - x0)
    STEP5: the same with D^3 (10 - 15 D + 6 D^2)
    HARMONIC: h0 + h1 sin(omega t + phase)
    TABLE: straight lines through (time, value) pairs, constant outside
    CALLBACK: the caller's function
    PERIODIC: TABLE repeated before and after, with the period last time - first time
    PER_REVOLUTION: h0 + (h1 + share w) sin(order theta + phase): w is the time function `of`, theta its integral from 0 s. Its own integral is exact to round-off. A worn gear: share alone, `of` the speed that turns it
    """
    CONSTANT = 0
    STEP = 1
    STEP5 = 2
    HARMONIC = 3
    TABLE = 4
    CALLBACK = 5
    PERIODIC = 6
    PER_REVOLUTION = 7


SEGMENT_CONSTANT = SegmentKind.CONSTANT
SEGMENT_STEP = SegmentKind.STEP
SEGMENT_STEP5 = SegmentKind.STEP5
SEGMENT_HARMONIC = SegmentKind.HARMONIC
SEGMENT_TABLE = SegmentKind.TABLE
SEGMENT_CALLBACK = SegmentKind.CALLBACK
SEGMENT_PERIODIC = SegmentKind.PERIODIC
SEGMENT_PER_REVOLUTION = SegmentKind.PER_REVOLUTION


class TimeFunctionProvides(IntFlag):
    """Bits DMB_PROVIDES_... of the headers."""
    RATE = 1
    INTEGRAL = 2


PROVIDES_RATE = TimeFunctionProvides.RATE
PROVIDES_INTEGRAL = TimeFunctionProvides.INTEGRAL


class NormalLaw(IntEnum):
    """Values DMB_NORMAL_... of the headers.

    NONE: no contact
    KELVIN_VOIGT: K d^n + c d', never pulling
    HUNT_CROSSLEY: K d^n (1 + mu d'/v0), mu = 3(1-e)/2
    LANKARANI_NIKRAVESH: mu = 3(1-e^2)/4
    FLORES: mu = 8(1-e)/(5e)
    EXACT: mu such that the restitution is the one given
    IMPACT: K d^n + STEP(d; 0, 0, impact_depth, damping) d', never pulling
    """
    NONE = -1
    KELVIN_VOIGT = 0
    HUNT_CROSSLEY = 1
    LANKARANI_NIKRAVESH = 2
    FLORES = 3
    EXACT = 4
    IMPACT = 5


NORMAL_NONE = NormalLaw.NONE
NORMAL_KELVIN_VOIGT = NormalLaw.KELVIN_VOIGT
NORMAL_HUNT_CROSSLEY = NormalLaw.HUNT_CROSSLEY
NORMAL_LANKARANI_NIKRAVESH = NormalLaw.LANKARANI_NIKRAVESH
NORMAL_FLORES = NormalLaw.FLORES
NORMAL_EXACT = NormalLaw.EXACT
NORMAL_IMPACT = NormalLaw.IMPACT


class FrictionLaw(IntEnum):
    """Values DMB_FRICTION_... of the headers.

    COULOMB: mu_dynamic s_/s with s = sqrt(v^2 + smoothing_speed^2)
    AMBROSIO: 0 up to smoothing_speed, linear up to full_speed, mu_dynamic beyond
    STRIBECK: mu_d + (mu_s - mu_d) exp(-s/stribeck_speed), smoothed; its maximum is mu_static
    BRISTLE: elastic bristle that sticks; breaks away at mu_static, one step late (order 1)
    CALLBACK: friction_callback
    """
    NONE = -1
    COULOMB = 0
    AMBROSIO = 1
    STRIBECK = 2
    BRISTLE = 3
    CALLBACK = 4


FRICTION_NONE = FrictionLaw.NONE
FRICTION_COULOMB = FrictionLaw.COULOMB
FRICTION_AMBROSIO = FrictionLaw.AMBROSIO
FRICTION_STRIBECK = FrictionLaw.STRIBECK
FRICTION_BRISTLE = FrictionLaw.BRISTLE
FRICTION_CALLBACK = FrictionLaw.CALLBACK


class HoleShape(IntEnum):
    """Values DMB_HOLE_... of the headers.

    STEP: the values hold up to the next section, or to the end of the hole
    LINE: they vary linearly to those of the next section
    """
    STEP = 0
    LINE = 1


HOLE_STEP = HoleShape.STEP
HOLE_LINE = HoleShape.LINE


class PipeKind(IntEnum):
    """Values DMB_PIPE_... of the headers.

    FLEXIBLE: SE(3) beam elements: bending, shear, stretch, torsion
    AXIAL_TORSIONAL: stretch and torsion on the hole's axis, 2 coordinates a node
    RIGID: neighbouring rigid pipes are one rigid body
    """
    FLEXIBLE = 0
    AXIAL_TORSIONAL = 1
    RIGID = 2


PIPE_FLEXIBLE = PipeKind.FLEXIBLE
PIPE_AXIAL_TORSIONAL = PipeKind.AXIAL_TORSIONAL
PIPE_RIGID = PipeKind.RIGID


class Attach(IntEnum):
    """Values DMB_ATTACH_... of the headers."""
    NONE = 0
    START = 1
    END = 2


ATTACH_NONE = Attach.NONE
ATTACH_START = Attach.START
ATTACH_END = Attach.END


class RockLaw(IntEnum):
    """Values DMB_ROCK_... of the headers.

    RATE: Detournay, Defourny 1992: depth of cut 2 pi V/Omega, for drilling at a steady speed. Its torque grows as Omega falls, so that a bit that is slowed down stops at once: where a bit may stick or bounce (undamped pipes, say) steps may find no solution, however short; take the next one
    REGENERATIVE: Richard, Germay, Detournay 2007: depth of cut over the surface the last blade left
    """
    NONE = 0
    RATE = 1
    REGENERATIVE = 2


ROCK_NONE = RockLaw.NONE
ROCK_RATE = RockLaw.RATE
ROCK_REGENERATIVE = RockLaw.REGENERATIVE


class JointKind(IntEnum):
    """Values DMB_JOINT_... of the headers.

    FIXED: none
    REVOLUTE: RX
    PRISMATIC: X
    CYLINDRICAL: X, RX
    SPHERICAL: RX, RY, RZ
    UNIVERSAL: RY, RZ: crossed axes y of a and z of b
    PLANAR: Y, Z, RX: x is the normal of the plane
    POINT_ON_LINE: X, RX, RY, RZ: origin of b on the x axis of a
    POINT_ON_HOLE: origin of b on the axis of the hole; a must be the ground (support, centraliser)
    DISTANCE: origins `length` apart
    FREE: holds nothing: carries springs, dampers, stops, friction
    KNIFE_EDGE: nonholonomic: the origin of b does not move along y of b (no lateral slip)
    ROLLING: a rim of radius `length` about x of b rolls without slip on plane y, z of a, on the side x > 0
    TRANSLATIONAL: X, Y, Z: b does not turn against a
    CROSS_SLIDE: Y, Z: two slides across each other
    SCHOENFLIES: X, Y, Z, RX: x of b stays parallel to x of a
    """
    FIXED = 0
    REVOLUTE = 1
    PRISMATIC = 2
    CYLINDRICAL = 3
    SPHERICAL = 5
    UNIVERSAL = 4
    PLANAR = 6
    POINT_ON_LINE = 7
    POINT_ON_HOLE = 8
    DISTANCE = 9
    FREE = 10
    KNIFE_EDGE = 11
    ROLLING = 12
    TRANSLATIONAL = 13
    CROSS_SLIDE = 14
    SCHOENFLIES = 15


JOINT_FIXED = JointKind.FIXED
JOINT_REVOLUTE = JointKind.REVOLUTE
JOINT_PRISMATIC = JointKind.PRISMATIC
JOINT_CYLINDRICAL = JointKind.CYLINDRICAL
JOINT_SPHERICAL = JointKind.SPHERICAL
JOINT_UNIVERSAL = JointKind.UNIVERSAL
JOINT_PLANAR = JointKind.PLANAR
JOINT_POINT_ON_LINE = JointKind.POINT_ON_LINE
JOINT_POINT_ON_HOLE = JointKind.POINT_ON_HOLE
JOINT_DISTANCE = JointKind.DISTANCE
JOINT_FREE = JointKind.FREE
JOINT_KNIFE_EDGE = JointKind.KNIFE_EDGE
JOINT_ROLLING = JointKind.ROLLING
JOINT_TRANSLATIONAL = JointKind.TRANSLATIONAL
JOINT_CROSS_SLIDE = JointKind.CROSS_SLIDE
JOINT_SCHOENFLIES = JointKind.SCHOENFLIES


class JointMode(IntEnum):
    """Values DMB_JOINT_... of the headers.

    ACTIVE: constrains as its kind says
    LOCKED: holds all six coordinates where they were when it was locked
    OPEN: holds nothing; its springs, dampers, stops and friction do not act
    """
    ACTIVE = 0
    LOCKED = 1
    OPEN = 2


JOINT_ACTIVE = JointMode.ACTIVE
JOINT_LOCKED = JointMode.LOCKED
JOINT_OPEN = JointMode.OPEN


class ConstraintKind(IntEnum):
    """Values DMB_CONSTRAINT_... of the headers."""
    HOLONOMIC = 0
    NONHOLONOMIC = 1


CONSTRAINT_HOLONOMIC = ConstraintKind.HOLONOMIC
CONSTRAINT_NONHOLONOMIC = ConstraintKind.NONHOLONOMIC


class ConstraintProvides(IntFlag):
    """Bits DMB_PROVIDES_... of the headers."""
    JACOBIAN = 1


PROVIDES_JACOBIAN = ConstraintProvides.JACOBIAN


class DriveKind(IntEnum):
    """Values DMB_DRIVE_... of the headers.

    MOTION: the speed of the component follows the time function exactly [m/s, rad/s]
    LOAD: the time function is a force or torque on the component [N, N m]
    CONTROL: force = clamp(kp (v* - v) + ki integral(v* - v)), v* from the time function
    """
    MOTION = 0
    LOAD = 1
    CONTROL = 2


DRIVE_MOTION = DriveKind.MOTION
DRIVE_LOAD = DriveKind.LOAD
DRIVE_CONTROL = DriveKind.CONTROL


class Frame(IntEnum):
    """Values DMB_FRAME_... of the headers."""
    WORLD = 0
    BODY = 1
    HOLE = 2


FRAME_WORLD = Frame.WORLD
FRAME_BODY = Frame.BODY
FRAME_HOLE = Frame.HOLE


class SpringActs(IntEnum):
    """Values DMB_SPRING_... of the headers."""
    BOTH = 0
    TENSION = 1
    COMPRESSION = 2


SPRING_BOTH = SpringActs.BOTH
SPRING_TENSION = SpringActs.TENSION
SPRING_COMPRESSION = SpringActs.COMPRESSION


class TableKind(IntEnum):
    """Values DMB_TABLE_... of the headers."""
    LINES = 0
    CUBIC = 1


TABLE_LINES = TableKind.LINES
TABLE_CUBIC = TableKind.CUBIC


class ForceProvides(IntFlag):
    """Bits DMB_PROVIDES_... of the headers."""
    TANGENT = 1
    POTENTIAL = 2


PROVIDES_TANGENT = ForceProvides.TANGENT
PROVIDES_POTENTIAL = ForceProvides.POTENTIAL


class StuckHolds(IntFlag):
    """Bits DMB_STUCK_... of the headers."""
    AXIAL = 1
    ROTATION = 2
    LATERAL = 4


STUCK_AXIAL = StuckHolds.AXIAL
STUCK_ROTATION = StuckHolds.ROTATION
STUCK_LATERAL = StuckHolds.LATERAL


class InputTarget(IntEnum):
    """Values DMB_TARGET_... of the headers.

    SET_POINT: of a drive, instead of its time function; its excitation continues
    GAIN: [N s/m, N m s], [N/m, N m] >= 0
    INTEGRAL_GAIN: [N s/m, N m s], [N/m, N m] >= 0
    LIMIT_LOW: [N, N m] the first below the second
    LIMIT_HIGH: [N, N m] the first below the second
    LOAD_FACTOR: [-] of a load, [N] of a bit, replaces its time function
    BIT_LOAD: [-] of a load, [N] of a bit, replaces its time function
    FRICTION: [-] factor of both coefficients of the wall, [kg/m3]
    FLUID_DENSITY: [-] factor of both coefficients of the wall, [kg/m3]
    LATERAL_DAMPING: [N s/m2]
    AXIAL_DAMPING: [N s/m2]
    TORSIONAL_DAMPING: [N s]
    STUCK: [-] 1: a place is stuck from now on, 0: it is free
    FLOW_RATE: [m3/s] of mud, >= 0; all that flow needs of string, hole and mud must be there
    """
    SET_POINT = 0
    GAIN = 1
    INTEGRAL_GAIN = 2
    LIMIT_LOW = 3
    LIMIT_HIGH = 4
    LOAD_FACTOR = 5
    BIT_LOAD = 6
    FRICTION = 7
    FLUID_DENSITY = 8
    LATERAL_DAMPING = 9
    AXIAL_DAMPING = 10
    TORSIONAL_DAMPING = 11
    STUCK = 12
    FLOW_RATE = 13


TARGET_SET_POINT = InputTarget.SET_POINT
TARGET_GAIN = InputTarget.GAIN
TARGET_INTEGRAL_GAIN = InputTarget.INTEGRAL_GAIN
TARGET_LIMIT_LOW = InputTarget.LIMIT_LOW
TARGET_LIMIT_HIGH = InputTarget.LIMIT_HIGH
TARGET_LOAD_FACTOR = InputTarget.LOAD_FACTOR
TARGET_BIT_LOAD = InputTarget.BIT_LOAD
TARGET_FRICTION = InputTarget.FRICTION
TARGET_FLUID_DENSITY = InputTarget.FLUID_DENSITY
TARGET_LATERAL_DAMPING = InputTarget.LATERAL_DAMPING
TARGET_AXIAL_DAMPING = InputTarget.AXIAL_DAMPING
TARGET_TORSIONAL_DAMPING = InputTarget.TORSIONAL_DAMPING
TARGET_STUCK = InputTarget.STUCK
TARGET_FLOW_RATE = InputTarget.FLOW_RATE


class Outside(IntEnum):
    """Values DMB_OUTSIDE_... of the headers."""
    REFUSED = 0
    CLAMPED = 1


OUTSIDE_REFUSED = Outside.REFUSED
OUTSIDE_CLAMPED = Outside.CLAMPED


class EventDirection(IntEnum):
    """Values DMB_EVENT_... of the headers."""
    EITHER = 0
    RISING = 1
    FALLING = 2


EVENT_EITHER = EventDirection.EITHER
EVENT_RISING = EventDirection.RISING
EVENT_FALLING = EventDirection.FALLING


class Events(IntEnum):
    """Values DMB_EVENTS_... of the headers."""
    MAX = 64


EVENTS_MAX = Events.MAX


class Feature(IntFlag):
    """Bits DMB_FEATURE_... of the headers.

    VIBRATION: eccentricity and drive excitation
    """
    GRAVITY = 1
    CONTACT = 2
    FRICTION = 4
    ECCENTRICITY = 8
    EXCITATION = 16
    ROCK = 32
    DAMPING = 64
    ALL = 127
    VIBRATION = 24


FEATURE_GRAVITY = Feature.GRAVITY
FEATURE_CONTACT = Feature.CONTACT
FEATURE_FRICTION = Feature.FRICTION
FEATURE_ECCENTRICITY = Feature.ECCENTRICITY
FEATURE_EXCITATION = Feature.EXCITATION
FEATURE_ROCK = Feature.ROCK
FEATURE_DAMPING = Feature.DAMPING
FEATURE_ALL = Feature.ALL
FEATURE_VIBRATION = Feature.VIBRATION


class ConstraintMethod(IntEnum):
    """Values DMB_METHOD_... of the headers.

    INDEPENDENT: the step solves for independent coordinates, found by partition
    MULTIPLIERS: it solves for all coordinates and the multipliers, for comparison; not in statics
    """
    INDEPENDENT = 0
    MULTIPLIERS = 1


METHOD_INDEPENDENT = ConstraintMethod.INDEPENDENT
METHOD_MULTIPLIERS = ConstraintMethod.MULTIPLIERS


class HoleBeyond(IntEnum):
    """Values DMB_HOLE_... of the headers."""
    ABOVE = -1
    SURVEYED = 0
    BELOW = 1


HOLE_ABOVE = HoleBeyond.ABOVE
HOLE_SURVEYED = HoleBeyond.SURVEYED
HOLE_BELOW = HoleBeyond.BELOW


class ProfileQuantity(IntEnum):
    """Values DMB_PROFILE_... of the headers.

    DISTANCE: [m] along the string from its rig end
    DEPTH: [m] measured depth; 0 without a hole
    X: [m] position, world frame
    Y: [m] position, world frame
    Z: [m] position, world frame
    DEVIATION: [m] distance from the hole's axis
    DEVIATION_SIDE: [m] its horizontal part, along z_world x tangent: left looking ahead
    DEVIATION_UP: [m] its other part: towards the high side
    AXIAL_FORCE: [N] true axial force N
    EFFECTIVE_FORCE: [N] effective force N_e, as dmb_query_section
    TORQUE: [N m]
    BENDING_MOMENT: [N m] magnitude; of axial-torsional pipes EI times the curvature of eq:drilling.bending
    SHEAR_FORCE: [N] magnitude
    CURVATURE: [rad/m] of bending, magnitude, less the unstressed one; 0 in tool joints
    NORMAL_FORCE: [N/m] of the wall on the string, >= 0; that of the nearest contact point
    FRICTION_AXIAL: [N/m] of the wall on the string along its axis
    FRICTION_AROUND: [N/m] of the wall on the string along axis x outward normal
    VON_MISES: [Pa] largest at the outer surface, by the diameters (eq:drilling.von-mises); with an inner_density or flow_rate of both surfaces, hoop stress too
    YIELD_SHARE: [-] of `yield_strength`; NaN where the pipe has none
    SINUSOIDAL_SHARE: [-] -N_e over the load of sinusoidal buckling; 0 in tension; NaN without a hole, and in compression where nothing presses the pipe to the wall
    HELICAL_SHARE: [-] compression over the helical buckling load
    VELOCITY_AXIAL: [m/s] along the pipe
    VELOCITY_LATERAL: [m/s] across, magnitude
    SPIN: [rad/s] about the pipe's axis
    ACCELERATION_AXIAL: [m/s2] of the section's centre, along the pipe's axis
    ACCELERATION_LATERAL: [m/s2] across, magnitude
    ROTATION: [rad] about the pipe's axis since time 0, unwrapped
    DISPLACEMENT_X: [m] since time 0 as described, world frame
    DISPLACEMENT_Y: [m] since time 0 as described, world frame
    DISPLACEMENT_Z: [m] the same
    SHEAR_Y: [N] section frame, as dmb_query_section
    SHEAR_Z: [N] section frame, as dmb_query_section
    MOMENT_Y: [N m] bending about y, z; section frame
    MOMENT_Z: [N m] bending about y, z; section frame
    GAP: [m] of the nearest contact point, < 0 when penetrating; NaN without one
    """
    DISTANCE = 0
    DEPTH = 1
    X = 2
    Y = 3
    Z = 4
    DEVIATION = 5
    DEVIATION_SIDE = 6
    DEVIATION_UP = 7
    AXIAL_FORCE = 8
    EFFECTIVE_FORCE = 9
    TORQUE = 10
    BENDING_MOMENT = 11
    SHEAR_FORCE = 12
    CURVATURE = 13
    NORMAL_FORCE = 14
    FRICTION_AXIAL = 15
    FRICTION_AROUND = 16
    VON_MISES = 17
    YIELD_SHARE = 18
    SINUSOIDAL_SHARE = 19
    HELICAL_SHARE = 20
    VELOCITY_AXIAL = 21
    VELOCITY_LATERAL = 22
    SPIN = 23
    ACCELERATION_AXIAL = 24
    ACCELERATION_LATERAL = 25
    ROTATION = 26
    DISPLACEMENT_X = 27
    DISPLACEMENT_Y = 28
    DISPLACEMENT_Z = 29
    SHEAR_Y = 30
    SHEAR_Z = 31
    MOMENT_Y = 32
    MOMENT_Z = 33
    GAP = 34


PROFILE_DISTANCE = ProfileQuantity.DISTANCE
PROFILE_DEPTH = ProfileQuantity.DEPTH
PROFILE_X = ProfileQuantity.X
PROFILE_Y = ProfileQuantity.Y
PROFILE_Z = ProfileQuantity.Z
PROFILE_DEVIATION = ProfileQuantity.DEVIATION
PROFILE_DEVIATION_SIDE = ProfileQuantity.DEVIATION_SIDE
PROFILE_DEVIATION_UP = ProfileQuantity.DEVIATION_UP
PROFILE_AXIAL_FORCE = ProfileQuantity.AXIAL_FORCE
PROFILE_EFFECTIVE_FORCE = ProfileQuantity.EFFECTIVE_FORCE
PROFILE_TORQUE = ProfileQuantity.TORQUE
PROFILE_BENDING_MOMENT = ProfileQuantity.BENDING_MOMENT
PROFILE_SHEAR_FORCE = ProfileQuantity.SHEAR_FORCE
PROFILE_CURVATURE = ProfileQuantity.CURVATURE
PROFILE_NORMAL_FORCE = ProfileQuantity.NORMAL_FORCE
PROFILE_FRICTION_AXIAL = ProfileQuantity.FRICTION_AXIAL
PROFILE_FRICTION_AROUND = ProfileQuantity.FRICTION_AROUND
PROFILE_VON_MISES = ProfileQuantity.VON_MISES
PROFILE_YIELD_SHARE = ProfileQuantity.YIELD_SHARE
PROFILE_SINUSOIDAL_SHARE = ProfileQuantity.SINUSOIDAL_SHARE
PROFILE_HELICAL_SHARE = ProfileQuantity.HELICAL_SHARE
PROFILE_VELOCITY_AXIAL = ProfileQuantity.VELOCITY_AXIAL
PROFILE_VELOCITY_LATERAL = ProfileQuantity.VELOCITY_LATERAL
PROFILE_SPIN = ProfileQuantity.SPIN
PROFILE_ACCELERATION_AXIAL = ProfileQuantity.ACCELERATION_AXIAL
PROFILE_ACCELERATION_LATERAL = ProfileQuantity.ACCELERATION_LATERAL
PROFILE_ROTATION = ProfileQuantity.ROTATION
PROFILE_DISPLACEMENT_X = ProfileQuantity.DISPLACEMENT_X
PROFILE_DISPLACEMENT_Y = ProfileQuantity.DISPLACEMENT_Y
PROFILE_DISPLACEMENT_Z = ProfileQuantity.DISPLACEMENT_Z
PROFILE_SHEAR_Y = ProfileQuantity.SHEAR_Y
PROFILE_SHEAR_Z = ProfileQuantity.SHEAR_Z
PROFILE_MOMENT_Y = ProfileQuantity.MOMENT_Y
PROFILE_MOMENT_Z = ProfileQuantity.MOMENT_Z
PROFILE_GAP = ProfileQuantity.GAP


class Quantity(IntEnum):
    """Values DMB_OUTPUT_... of the headers.

    DISPLACEMENT_X: [m] world
    DISPLACEMENT_Y: [m] world
    DISPLACEMENT_Z: [m] world
    VELOCITY_X: [m/s] world
    VELOCITY_Y: [m/s] world
    VELOCITY_Z: [m/s] world
    POSITION_X: [m] world
    POSITION_Y: [m] world
    POSITION_Z: [m] world
    ROTATION: [rad] unwrapped
    SPIN: [rad/s] about the pipe's axis
    AXIAL_FORCE: [N] tension > 0
    TORQUE: [N m]
    BENDING_MOMENT: [N m] magnitude
    KINETIC_ENERGY: [J] of the pipe or body
    NORMAL_FORCE: [N] at the pipe's far end, or of the body
    DRIVE_FORCE: [N, N m] place.part is a drive
    DRIVE_SPEED: [m/s, rad/s] place.part is a drive
    BIT_WEIGHT: [N] place.part is a bit, bottom-hole load included
    ENERGY_ERROR: [-] of the ledger; place is ignored
    """
    DISPLACEMENT_X = 0
    DISPLACEMENT_Y = 1
    DISPLACEMENT_Z = 2
    VELOCITY_X = 3
    VELOCITY_Y = 4
    VELOCITY_Z = 5
    POSITION_X = 6
    POSITION_Y = 7
    POSITION_Z = 8
    ROTATION = 9
    SPIN = 10
    AXIAL_FORCE = 11
    TORQUE = 12
    BENDING_MOMENT = 13
    KINETIC_ENERGY = 14
    NORMAL_FORCE = 15
    DRIVE_FORCE = 16
    DRIVE_SPEED = 17
    BIT_WEIGHT = 18
    ENERGY_ERROR = 19


OUTPUT_DISPLACEMENT_X = Quantity.DISPLACEMENT_X
OUTPUT_DISPLACEMENT_Y = Quantity.DISPLACEMENT_Y
OUTPUT_DISPLACEMENT_Z = Quantity.DISPLACEMENT_Z
OUTPUT_VELOCITY_X = Quantity.VELOCITY_X
OUTPUT_VELOCITY_Y = Quantity.VELOCITY_Y
OUTPUT_VELOCITY_Z = Quantity.VELOCITY_Z
OUTPUT_POSITION_X = Quantity.POSITION_X
OUTPUT_POSITION_Y = Quantity.POSITION_Y
OUTPUT_POSITION_Z = Quantity.POSITION_Z
OUTPUT_ROTATION = Quantity.ROTATION
OUTPUT_SPIN = Quantity.SPIN
OUTPUT_AXIAL_FORCE = Quantity.AXIAL_FORCE
OUTPUT_TORQUE = Quantity.TORQUE
OUTPUT_BENDING_MOMENT = Quantity.BENDING_MOMENT
OUTPUT_KINETIC_ENERGY = Quantity.KINETIC_ENERGY
OUTPUT_NORMAL_FORCE = Quantity.NORMAL_FORCE
OUTPUT_DRIVE_FORCE = Quantity.DRIVE_FORCE
OUTPUT_DRIVE_SPEED = Quantity.DRIVE_SPEED
OUTPUT_BIT_WEIGHT = Quantity.BIT_WEIGHT
OUTPUT_ENERGY_ERROR = Quantity.ENERGY_ERROR


class Reading(IntEnum):
    """Values DMB_OUTPUT_... of the headers.

    HOOK_LOAD: [N] effective axial force at the rig end, as dmb_query_section: > 0 pull, < 0 thrust
    ROTATION_TORQUE: [N m] that the rig puts into that section, > 0 along the string's x axis
    WEIGHT_ON_BIT: [N] of all bits on the string: rock law and bottom-hole load
    TORQUE_ON_BIT: [N m] of all bits on the string: rock law, against the rotation
    RATE_OF_PENETRATION: [m/s] of the string's first bit into the hole; with a rock law 0 while off bottom. The rate of dmb_bit_state.advance
    BIT_SPEED: [rad/s] about its axis, of the string's far end
    BIT_DEPTH: [m] measured depth of the string's far end; 0 without a hole
    ROTARY_SPEED: [rad/s] about its axis, of the string's rig end
    FEED_SPEED: [m/s] along its axis, of the string's rig end, > 0 into the hole
    STRETCH: [m] elastic, > 0 longer: sum of the axial strain over the flexible lengths
    WIND_UP: [rad] elastic, of the rig end against the far end: less the sum of the twist
    OFF_BOTTOM: [-] 1: no bit with a rock law is on bottom, else 0; its mean in windows: off-bottom share
    RIG_FORCE: [N] by support and drives on the rig end, > 0 the rig pulls: hook load, and inertia, weight and friction of the end itself; 0 where a joint holds it
    RIG_TORQUE: [N m] by support and drives, > 0 along the string's x axis
    BIT_ADVANCE: [m]
    BIT_BOTTOM: [m]
    BIT_DEPTH_OF_CUT: [m]
    BIT_ROCK_WEIGHT: [N] of the rock law alone; bottom-hole load
    BIT_LOAD: [N] of the rock law alone; bottom-hole load
    BIT_TORQUE: [N m]
    BIT_ON_BOTTOM: [-] 1 or 0
    STUCK: [-] 1 or 0
    STUCK_FORCE: [N] axial
    STUCK_TORQUE: [N m]
    DRIVE_TARGET: [unit of the time function]
    DRIVE_POSITION: [m, rad]
    DRIVE_POWER: [W]
    DRIVE_WORK: [J]
    DRIVE_COMMAND: [N, N m]
    DRIVE_MADE: [N, N m]
    CONTACT_GAP: [m]
    CONTACT_NORMAL_FORCE: [N]
    CONTACT_APPROACH: [m/s]
    CONTACT_FRICTION_AXIAL: [N]
    CONTACT_FRICTION_AROUND: [N]
    CONTACT_SLIP_AXIAL: [m/s]
    CONTACT_SLIP_AROUND: [m/s]
    CONTACT_CLOSED: [-] 1 or 0
    CONTACT_STICKS: [-] 1 or 0
    CONTACTS_CLOSED: [-]
    CONTACTS_NORMAL_FORCE: [N]
    CONTACTS_FRICTION_AXIAL: [N]
    CONTACTS_FRICTION_AROUND: [N]
    CONTACTS_DEEPEST: [m]
    ENERGY_KINETIC: [J]
    ENERGY_STRAIN: [J]
    ENERGY_GRAVITY: [J]
    ENERGY_CONTACT: [J]
    ENERGY_DRIVES: [J]
    ENERGY_LOADS: [J]
    ENERGY_FRICTION: [J]
    ENERGY_IMPACT: [J]
    ENERGY_DAMPING: [J]
    ENERGY_ROCK: [J]
    ENERGY_SCHEME: [J]
    ENERGY_INPUT: [J]
    ENERGY_BALANCE: [J]
    ENERGY_UNEXPLAINED: [J]
    MOMENTUM_X: [kg m/s] linear, world
    MOMENTUM_Y: [kg m/s] linear, world
    MOMENTUM_Z: [kg m/s] linear, world
    ANGULAR_MOMENTUM_X: [kg m2/s] about the world's origin, world
    ANGULAR_MOMENTUM_Y: [kg m2/s] about the world's origin, world
    ANGULAR_MOMENTUM_Z: [kg m2/s] the same
    MASS: [kg]
    CENTRE_X: [m] of mass, world
    CENTRE_Y: [m] of mass, world
    CENTRE_Z: [m] of mass, world
    STEPS: [-] dmb_query_statistics, O(joints)
    REJECTED: [-] dmb_query_statistics, O(joints)
    ITERATIONS: [-] dmb_query_statistics, O(joints)
    LIMITED_STEPS: [-]
    MOST_ITERATIONS: [-]
    LARGEST_RESIDUAL: [-]
    SWITCHES: [-]
    DEPENDENT: [-]
    REDUNDANT: [-]
    VIOLATION: [m, -] of all joints
    SPRING_LENGTH: [m]
    SPRING_ELONGATION: [m]
    SPRING_SPEED: [m/s]
    SPRING_FORCE: [N] tension > 0, sum of the next two
    SPRING_ELASTIC: [N]
    SPRING_DAMPER: [N]
    SPRING_ENERGY: [J]
    INPUT_PRESENT: [unit of the input] in force now
    INPUT_RATE: [unit of the input/s] of that
    INPUT_VALUE: [unit of the input] set point
    JOINT_POSITION: [m, rad]; 1/s; 1/s2
    JOINT_SPEED: [m, rad]; 1/s; 1/s2
    JOINT_ACCELERATION: [m, rad]; 1/s; 1/s2
    JOINT_REACTION: [N, N m] world; (_BODY) frame b
    JOINT_REACTION_BODY: [N, N m] world; (_BODY) frame b
    JOINT_ACTION: [N, N m]
    JOINT_VIOLATION: [m, -]
    JOINT_STATE: [-] JOINT_...; equations it holds now
    JOINT_ROWS: [-] JOINT_...; equations it holds now
    MULTIPLIER: [N, ...] number 0 .. 5 of a joint, coupling, constraint or joint drive; six
    REACTION: [N, N m] of a string or body: dmb_query_reaction; six
    SECTION_FORCE: [N, N m] dmb_query_section
    SECTION_STRAIN: [-, rad/m]
    WORLD_VELOCITY: [m/s, rad/s] dmb_query_motion
    BODY_VELOCITY: [m/s, rad/s] dmb_query_motion
    WORLD_ACCELERATION: [m/s2, rad/s2]
    BODY_ACCELERATION: [m/s2, rad/s2]
    VIBRATION: [m, rad] displacement from the state
    VIBRATION_BODY: [m, rad] displacement from the state
    VIBRATION_VELOCITY: [m/s, rad/s] its rate
    VIBRATION_VELOCITY_BODY: [m/s, rad/s] its rate
    VIBRATION_ACCELERATION: [m/s2, rad/s2]
    VIBRATION_ACCELERATION_BODY: [m/s2, rad/s2]
    PROFILE: + PROFILE_...: at a place of a string; as dmb_query_profile, NaN included
    WINDOW_MINIMUM: [its unit]
    WINDOW_MAXIMUM: [its unit]
    WINDOW_MEAN: [its unit]
    WINDOW_RMS: [its unit]
    STICK_SLIP_INDEX: [-] index, low_share of dmb_window_result
    WINDOW_LOW_SHARE: [-] index, low_share of dmb_window_result
    """
    HOOK_LOAD = 100
    ROTATION_TORQUE = 101
    WEIGHT_ON_BIT = 102
    TORQUE_ON_BIT = 103
    RATE_OF_PENETRATION = 104
    BIT_SPEED = 105
    BIT_DEPTH = 106
    ROTARY_SPEED = 107
    FEED_SPEED = 108
    STRETCH = 109
    WIND_UP = 110
    OFF_BOTTOM = 111
    RIG_FORCE = 112
    RIG_TORQUE = 113
    BIT_ADVANCE = 120
    BIT_BOTTOM = 121
    BIT_DEPTH_OF_CUT = 122
    BIT_ROCK_WEIGHT = 123
    BIT_LOAD = 125
    BIT_TORQUE = 124
    BIT_ON_BOTTOM = 126
    STUCK = 127
    STUCK_FORCE = 128
    STUCK_TORQUE = 129
    DRIVE_TARGET = 130
    DRIVE_POSITION = 131
    DRIVE_POWER = 132
    DRIVE_WORK = 133
    DRIVE_COMMAND = 134
    DRIVE_MADE = 135
    CONTACT_GAP = 140
    CONTACT_NORMAL_FORCE = 141
    CONTACT_APPROACH = 142
    CONTACT_FRICTION_AXIAL = 143
    CONTACT_FRICTION_AROUND = 144
    CONTACT_SLIP_AXIAL = 145
    CONTACT_SLIP_AROUND = 146
    CONTACT_CLOSED = 147
    CONTACT_STICKS = 148
    CONTACTS_CLOSED = 150
    CONTACTS_NORMAL_FORCE = 151
    CONTACTS_FRICTION_AXIAL = 152
    CONTACTS_FRICTION_AROUND = 153
    CONTACTS_DEEPEST = 154
    ENERGY_KINETIC = 160
    ENERGY_STRAIN = 161
    ENERGY_GRAVITY = 162
    ENERGY_CONTACT = 163
    ENERGY_DRIVES = 164
    ENERGY_LOADS = 165
    ENERGY_FRICTION = 166
    ENERGY_IMPACT = 167
    ENERGY_DAMPING = 168
    ENERGY_ROCK = 169
    ENERGY_SCHEME = 170
    ENERGY_INPUT = 171
    ENERGY_BALANCE = 172
    ENERGY_UNEXPLAINED = 173
    MOMENTUM_X = 180
    MOMENTUM_Y = 181
    MOMENTUM_Z = 182
    ANGULAR_MOMENTUM_X = 183
    ANGULAR_MOMENTUM_Y = 184
    ANGULAR_MOMENTUM_Z = 185
    MASS = 186
    CENTRE_X = 187
    CENTRE_Y = 188
    CENTRE_Z = 189
    STEPS = 200
    REJECTED = 201
    ITERATIONS = 202
    LIMITED_STEPS = 203
    MOST_ITERATIONS = 204
    LARGEST_RESIDUAL = 205
    SWITCHES = 206
    DEPENDENT = 207
    REDUNDANT = 208
    VIOLATION = 209
    SPRING_LENGTH = 220
    SPRING_ELONGATION = 221
    SPRING_SPEED = 222
    SPRING_FORCE = 223
    SPRING_ELASTIC = 224
    SPRING_DAMPER = 225
    SPRING_ENERGY = 226
    INPUT_PRESENT = 230
    INPUT_RATE = 231
    INPUT_VALUE = 232
    JOINT_POSITION = 300
    JOINT_SPEED = 310
    JOINT_ACCELERATION = 320
    JOINT_REACTION = 330
    JOINT_REACTION_BODY = 340
    JOINT_ACTION = 350
    JOINT_VIOLATION = 360
    JOINT_STATE = 361
    JOINT_ROWS = 362
    MULTIPLIER = 370
    REACTION = 380
    SECTION_FORCE = 400
    SECTION_STRAIN = 410
    WORLD_VELOCITY = 420
    BODY_VELOCITY = 440
    WORLD_ACCELERATION = 430
    BODY_ACCELERATION = 450
    VIBRATION = 460
    VIBRATION_BODY = 470
    VIBRATION_VELOCITY = 480
    VIBRATION_VELOCITY_BODY = 490
    VIBRATION_ACCELERATION = 500
    VIBRATION_ACCELERATION_BODY = 510
    PROFILE = 1000
    WINDOW_MINIMUM = 2000
    WINDOW_MAXIMUM = 2001
    WINDOW_MEAN = 2002
    WINDOW_RMS = 2003
    STICK_SLIP_INDEX = 2004
    WINDOW_LOW_SHARE = 2005


OUTPUT_HOOK_LOAD = Reading.HOOK_LOAD
OUTPUT_ROTATION_TORQUE = Reading.ROTATION_TORQUE
OUTPUT_WEIGHT_ON_BIT = Reading.WEIGHT_ON_BIT
OUTPUT_TORQUE_ON_BIT = Reading.TORQUE_ON_BIT
OUTPUT_RATE_OF_PENETRATION = Reading.RATE_OF_PENETRATION
OUTPUT_BIT_SPEED = Reading.BIT_SPEED
OUTPUT_BIT_DEPTH = Reading.BIT_DEPTH
OUTPUT_ROTARY_SPEED = Reading.ROTARY_SPEED
OUTPUT_FEED_SPEED = Reading.FEED_SPEED
OUTPUT_STRETCH = Reading.STRETCH
OUTPUT_WIND_UP = Reading.WIND_UP
OUTPUT_OFF_BOTTOM = Reading.OFF_BOTTOM
OUTPUT_RIG_FORCE = Reading.RIG_FORCE
OUTPUT_RIG_TORQUE = Reading.RIG_TORQUE
OUTPUT_BIT_ADVANCE = Reading.BIT_ADVANCE
OUTPUT_BIT_BOTTOM = Reading.BIT_BOTTOM
OUTPUT_BIT_DEPTH_OF_CUT = Reading.BIT_DEPTH_OF_CUT
OUTPUT_BIT_ROCK_WEIGHT = Reading.BIT_ROCK_WEIGHT
OUTPUT_BIT_LOAD = Reading.BIT_LOAD
OUTPUT_BIT_TORQUE = Reading.BIT_TORQUE
OUTPUT_BIT_ON_BOTTOM = Reading.BIT_ON_BOTTOM
OUTPUT_STUCK = Reading.STUCK
OUTPUT_STUCK_FORCE = Reading.STUCK_FORCE
OUTPUT_STUCK_TORQUE = Reading.STUCK_TORQUE
OUTPUT_DRIVE_TARGET = Reading.DRIVE_TARGET
OUTPUT_DRIVE_POSITION = Reading.DRIVE_POSITION
OUTPUT_DRIVE_POWER = Reading.DRIVE_POWER
OUTPUT_DRIVE_WORK = Reading.DRIVE_WORK
OUTPUT_DRIVE_COMMAND = Reading.DRIVE_COMMAND
OUTPUT_DRIVE_MADE = Reading.DRIVE_MADE
OUTPUT_CONTACT_GAP = Reading.CONTACT_GAP
OUTPUT_CONTACT_NORMAL_FORCE = Reading.CONTACT_NORMAL_FORCE
OUTPUT_CONTACT_APPROACH = Reading.CONTACT_APPROACH
OUTPUT_CONTACT_FRICTION_AXIAL = Reading.CONTACT_FRICTION_AXIAL
OUTPUT_CONTACT_FRICTION_AROUND = Reading.CONTACT_FRICTION_AROUND
OUTPUT_CONTACT_SLIP_AXIAL = Reading.CONTACT_SLIP_AXIAL
OUTPUT_CONTACT_SLIP_AROUND = Reading.CONTACT_SLIP_AROUND
OUTPUT_CONTACT_CLOSED = Reading.CONTACT_CLOSED
OUTPUT_CONTACT_STICKS = Reading.CONTACT_STICKS
OUTPUT_CONTACTS_CLOSED = Reading.CONTACTS_CLOSED
OUTPUT_CONTACTS_NORMAL_FORCE = Reading.CONTACTS_NORMAL_FORCE
OUTPUT_CONTACTS_FRICTION_AXIAL = Reading.CONTACTS_FRICTION_AXIAL
OUTPUT_CONTACTS_FRICTION_AROUND = Reading.CONTACTS_FRICTION_AROUND
OUTPUT_CONTACTS_DEEPEST = Reading.CONTACTS_DEEPEST
OUTPUT_ENERGY_KINETIC = Reading.ENERGY_KINETIC
OUTPUT_ENERGY_STRAIN = Reading.ENERGY_STRAIN
OUTPUT_ENERGY_GRAVITY = Reading.ENERGY_GRAVITY
OUTPUT_ENERGY_CONTACT = Reading.ENERGY_CONTACT
OUTPUT_ENERGY_DRIVES = Reading.ENERGY_DRIVES
OUTPUT_ENERGY_LOADS = Reading.ENERGY_LOADS
OUTPUT_ENERGY_FRICTION = Reading.ENERGY_FRICTION
OUTPUT_ENERGY_IMPACT = Reading.ENERGY_IMPACT
OUTPUT_ENERGY_DAMPING = Reading.ENERGY_DAMPING
OUTPUT_ENERGY_ROCK = Reading.ENERGY_ROCK
OUTPUT_ENERGY_SCHEME = Reading.ENERGY_SCHEME
OUTPUT_ENERGY_INPUT = Reading.ENERGY_INPUT
OUTPUT_ENERGY_BALANCE = Reading.ENERGY_BALANCE
OUTPUT_ENERGY_UNEXPLAINED = Reading.ENERGY_UNEXPLAINED
OUTPUT_MOMENTUM_X = Reading.MOMENTUM_X
OUTPUT_MOMENTUM_Y = Reading.MOMENTUM_Y
OUTPUT_MOMENTUM_Z = Reading.MOMENTUM_Z
OUTPUT_ANGULAR_MOMENTUM_X = Reading.ANGULAR_MOMENTUM_X
OUTPUT_ANGULAR_MOMENTUM_Y = Reading.ANGULAR_MOMENTUM_Y
OUTPUT_ANGULAR_MOMENTUM_Z = Reading.ANGULAR_MOMENTUM_Z
OUTPUT_MASS = Reading.MASS
OUTPUT_CENTRE_X = Reading.CENTRE_X
OUTPUT_CENTRE_Y = Reading.CENTRE_Y
OUTPUT_CENTRE_Z = Reading.CENTRE_Z
OUTPUT_STEPS = Reading.STEPS
OUTPUT_REJECTED = Reading.REJECTED
OUTPUT_ITERATIONS = Reading.ITERATIONS
OUTPUT_LIMITED_STEPS = Reading.LIMITED_STEPS
OUTPUT_MOST_ITERATIONS = Reading.MOST_ITERATIONS
OUTPUT_LARGEST_RESIDUAL = Reading.LARGEST_RESIDUAL
OUTPUT_SWITCHES = Reading.SWITCHES
OUTPUT_DEPENDENT = Reading.DEPENDENT
OUTPUT_REDUNDANT = Reading.REDUNDANT
OUTPUT_VIOLATION = Reading.VIOLATION
OUTPUT_SPRING_LENGTH = Reading.SPRING_LENGTH
OUTPUT_SPRING_ELONGATION = Reading.SPRING_ELONGATION
OUTPUT_SPRING_SPEED = Reading.SPRING_SPEED
OUTPUT_SPRING_FORCE = Reading.SPRING_FORCE
OUTPUT_SPRING_ELASTIC = Reading.SPRING_ELASTIC
OUTPUT_SPRING_DAMPER = Reading.SPRING_DAMPER
OUTPUT_SPRING_ENERGY = Reading.SPRING_ENERGY
OUTPUT_INPUT_PRESENT = Reading.INPUT_PRESENT
OUTPUT_INPUT_RATE = Reading.INPUT_RATE
OUTPUT_INPUT_VALUE = Reading.INPUT_VALUE
OUTPUT_JOINT_POSITION = Reading.JOINT_POSITION
OUTPUT_JOINT_SPEED = Reading.JOINT_SPEED
OUTPUT_JOINT_ACCELERATION = Reading.JOINT_ACCELERATION
OUTPUT_JOINT_REACTION = Reading.JOINT_REACTION
OUTPUT_JOINT_REACTION_BODY = Reading.JOINT_REACTION_BODY
OUTPUT_JOINT_ACTION = Reading.JOINT_ACTION
OUTPUT_JOINT_VIOLATION = Reading.JOINT_VIOLATION
OUTPUT_JOINT_STATE = Reading.JOINT_STATE
OUTPUT_JOINT_ROWS = Reading.JOINT_ROWS
OUTPUT_MULTIPLIER = Reading.MULTIPLIER
OUTPUT_REACTION = Reading.REACTION
OUTPUT_SECTION_FORCE = Reading.SECTION_FORCE
OUTPUT_SECTION_STRAIN = Reading.SECTION_STRAIN
OUTPUT_WORLD_VELOCITY = Reading.WORLD_VELOCITY
OUTPUT_BODY_VELOCITY = Reading.BODY_VELOCITY
OUTPUT_WORLD_ACCELERATION = Reading.WORLD_ACCELERATION
OUTPUT_BODY_ACCELERATION = Reading.BODY_ACCELERATION
OUTPUT_VIBRATION = Reading.VIBRATION
OUTPUT_VIBRATION_BODY = Reading.VIBRATION_BODY
OUTPUT_VIBRATION_VELOCITY = Reading.VIBRATION_VELOCITY
OUTPUT_VIBRATION_VELOCITY_BODY = Reading.VIBRATION_VELOCITY_BODY
OUTPUT_VIBRATION_ACCELERATION = Reading.VIBRATION_ACCELERATION
OUTPUT_VIBRATION_ACCELERATION_BODY = Reading.VIBRATION_ACCELERATION_BODY
OUTPUT_PROFILE = Reading.PROFILE
OUTPUT_WINDOW_MINIMUM = Reading.WINDOW_MINIMUM
OUTPUT_WINDOW_MAXIMUM = Reading.WINDOW_MAXIMUM
OUTPUT_WINDOW_MEAN = Reading.WINDOW_MEAN
OUTPUT_WINDOW_RMS = Reading.WINDOW_RMS
OUTPUT_STICK_SLIP_INDEX = Reading.STICK_SLIP_INDEX
OUTPUT_WINDOW_LOW_SHARE = Reading.WINDOW_LOW_SHARE


class Steady(IntEnum):
    """Values DMB_STEADY_... of the headers.

    AUTO: AT_REST where nothing moves or a slip is assumed, SLIDING where strings are moved along and about their axis, RIGID else, or where masses are eccentric; AT_REST with NOTE_NOT_STEADY where neither is steady
    AT_REST: all is at rest; only components of motion drives have their speed
    SLIDING: axes at rest; strings slide along the hole and turn about their axis as drives say
    RIGID: all turns about one fixed axis like a rigid body, under centrifugal forces
    """
    AUTO = 0
    AT_REST = 1
    SLIDING = 2
    RIGID = 3


STEADY_AUTO = Steady.AUTO
STEADY_AT_REST = Steady.AT_REST
STEADY_SLIDING = Steady.SLIDING
STEADY_RIGID = Steady.RIGID


class Stiffness(IntEnum):
    """Values DMB_STIFFNESS_... of the headers.

    SYMMETRIC: forces have a potential: the state is stable where no eigenvalue is negative
    UNSYMMETRIC: friction that slips, moments with a fixed axis, followers: the state diverges by each real negative eigenvalue; by complex ones it may flutter, which depends on mass and damping and is computed by dmb_analysis_modes with MODES_DAMPED
    """
    SYMMETRIC = 0
    UNSYMMETRIC = 1


STIFFNESS_SYMMETRIC = Stiffness.SYMMETRIC
STIFFNESS_UNSYMMETRIC = Stiffness.UNSYMMETRIC


class StaticMethod(IntEnum):
    """Values DMB_STATIC_... of the headers."""
    NEWTON = 0
    RELAXATION = 1


STATIC_NEWTON = StaticMethod.NEWTON
STATIC_RELAXATION = StaticMethod.RELAXATION


class Scale(IntEnum):
    """Values DMB_SCALE_... of the headers.

    ALL: gravity, all loads, bit loads, forces of load drives: 1 + factor times the present ones
    LOADS: the same without gravity
    PART: one part: `factor` times a load as described; [N, N m] of a load drive; [m, rad] that a motion drive of a string or body moves its component by, not held by joints, springs or forces at several parts (ERR_UNSUPPORTED)
    """
    ALL = 0
    LOADS = 1
    PART = 2


SCALE_ALL = Scale.ALL
SCALE_LOADS = Scale.LOADS
SCALE_PART = Scale.PART


class BucklingEnd(IntEnum):
    """Values DMB_BUCKLING_... of the headers.

    EXTRAPOLATED: no path was followed: follow = 0, or nothing buckles about the present state
    BIFURCATION: an eigenvalue of the stiffness passes 0, and the equilibria continue, unstable
    LIMIT: the factor is at a maximum of the path, or a contact that opens turns it back
    STABLE: none: det K keeps its sign up to `reached`
    DIP: no eigenvalue of the stiffness passes 0, but the lowest one has a minimum of less than half its largest value before (`dip`): the equilibria bend off into the buckled shape, as those of an imperfect string do
    """
    EXTRAPOLATED = 0
    BIFURCATION = 1
    LIMIT = 2
    STABLE = 3
    DIP = 4


BUCKLING_EXTRAPOLATED = BucklingEnd.EXTRAPOLATED
BUCKLING_BIFURCATION = BucklingEnd.BIFURCATION
BUCKLING_LIMIT = BucklingEnd.LIMIT
BUCKLING_STABLE = BucklingEnd.STABLE
BUCKLING_DIP = BucklingEnd.DIP


class Flutter(IntEnum):
    """Values DMB_FLUTTER_... of the headers.

    NOT_JUDGED: K is symmetric on the whole path, which allows none; friction is assumed to slip; no path is followed and no mode grows in the present state; no modes found (message)
    NONE: none of all modes (up to 60 coordinates), or of the 24 lowest (more), grows
    FOUND: one grows from flutter_factor on
    """
    NOT_JUDGED = 0
    NONE = 1
    FOUND = 2


FLUTTER_NOT_JUDGED = Flutter.NOT_JUDGED
FLUTTER_NONE = Flutter.NONE
FLUTTER_FOUND = Flutter.FOUND


class PathKind(IntEnum):
    """Values DMB_PATH_... of the headers.

    LIMIT: the factor is at a maximum or minimum of the path
    BIFURCATION: another path crosses: the stiffness is singular and the factor continues
    BRANCH: first point of the path that crossed
    """
    REGULAR = 0
    LIMIT = 1
    BIFURCATION = 2
    BRANCH = 3


PATH_REGULAR = PathKind.REGULAR
PATH_LIMIT = PathKind.LIMIT
PATH_BIFURCATION = PathKind.BIFURCATION
PATH_BRANCH = PathKind.BRANCH


class ContactState(IntEnum):
    """Values DMB_CONTACT_... of the headers.

    AS_IS: contact rings that touch the wall press on it, others do not
    OPEN: there is no wall; its forces in the state stay as dead loads
    CLOSED: contact rings up to `contact_gap` from the wall are held across it too
    """
    AS_IS = 0
    OPEN = 1
    CLOSED = 2


CONTACT_AS_IS = ContactState.AS_IS
CONTACT_OPEN = ContactState.OPEN
CONTACT_CLOSED = ContactState.CLOSED


class ModesKind(IntEnum):
    """Values DMB_MODES_... of the headers.

    UNDAMPED: M d'' + K d = 0
    DAMPED: with C: damping and gyroscopic terms
    """
    UNDAMPED = 0
    DAMPED = 1


MODES_UNDAMPED = ModesKind.UNDAMPED
MODES_DAMPED = ModesKind.DAMPED


class ModesSelect(IntEnum):
    """Values DMB_MODES_... of the headers."""
    LOWEST = 0
    ALL = 1
    BAND = 2


MODES_LOWEST = ModesSelect.LOWEST
MODES_ALL = ModesSelect.ALL
MODES_BAND = ModesSelect.BAND


class ModesAxes(IntEnum):
    """Values DMB_MODES_... of the headers."""
    AXES_TURNING = 0
    AXES_AT_REST = 1


MODES_AXES_TURNING = ModesAxes.AXES_TURNING
MODES_AXES_AT_REST = ModesAxes.AXES_AT_REST


class ExcitationKind(IntEnum):
    """Values DMB_EXCITATION_... of the headers.

    DRIVE: time function of the drive place.part [its unit]: speed of MOTION, target speed of CONTROL, force of LOAD
    LOAD: [-] factor of the load place.part
    BIT_LOAD: [N] bottom-hole load of the bit place.part
    FORCE: [N, N m] `component` of a force or moment at `place`, in `frame`
    UNBALANCE: [kg m] mass times its distance from the axis at `place`: force times w^2. component RX: turning from y to z of `frame`; X .. Z: to and fro along that axis
    ECCENTRICITY: [-] the scene's own eccentric masses (those of axial-torsional pipes, which are held across the hole, do nothing: ERR_UNSUPPORTED where all are), each times this factor, turning with the frequency about the axes of their pipes, from y to z, as they lie in the state at t = 0
    FRICTION: [-] coefficient: every contact ring on the wall is rubbed by it times its normal force in the state, along the hole (component X) or around it (RX)
    SETTING: the input place.part of scene.h [its unit]: a set point, load factor or bit load; limits on its rate are ignored. Others (gains, limits, friction, mud, stuck) change the scene: ERR_UNSUPPORTED; one that still changes is ERR_VALUE
    """
    DRIVE = 0
    LOAD = 1
    BIT_LOAD = 2
    FORCE = 3
    UNBALANCE = 4
    ECCENTRICITY = 5
    FRICTION = 6
    SETTING = 7


EXCITATION_DRIVE = ExcitationKind.DRIVE
EXCITATION_LOAD = ExcitationKind.LOAD
EXCITATION_BIT_LOAD = ExcitationKind.BIT_LOAD
EXCITATION_FORCE = ExcitationKind.FORCE
EXCITATION_UNBALANCE = ExcitationKind.UNBALANCE
EXCITATION_ECCENTRICITY = ExcitationKind.ECCENTRICITY
EXCITATION_FRICTION = ExcitationKind.FRICTION
EXCITATION_SETTING = ExcitationKind.SETTING


class ResponseAxes(IntEnum):
    """Values DMB_RESPONSE_... of the headers."""
    AXES_TURNING = 0
    AXES_AT_REST = 1


RESPONSE_AXES_TURNING = ResponseAxes.AXES_TURNING
RESPONSE_AXES_AT_REST = ResponseAxes.AXES_AT_REST


class StateForm(IntEnum):
    """Values DMB_STATE_... of the headers.

    FULL: all coordinates
    REDUCED: amplitudes of the shapes of chosen modes, and of quasi-static ones: one for each force of an input, two or three for a motion drive, so that results are exact at frequency `shift`. Galerkin's method on that real basis, orthonormal in M, which needs no left vectors; of complex shapes it takes real and imaginary part
    MATRICES: none: sparse matrices alone, about any state; no inputs nor outputs
    """
    FULL = 0
    REDUCED = 1
    MATRICES = 2


STATE_FULL = StateForm.FULL
STATE_REDUCED = StateForm.REDUCED
STATE_MATRICES = StateForm.MATRICES


class MotionInput(IntEnum):
    """Values DMB_MOTION_... of the headers.

    SPEED: the input of a motion drive is its speed. Outputs that feel accelerations at once (forces beside the drive) would depend on its rate: ERR_UNSUPPORTED
    ACCELERATION: it is the rate of that [m/s2, rad/s2], with displacement and speed as states
    """
    SPEED = 0
    ACCELERATION = 1


MOTION_SPEED = MotionInput.SPEED
MOTION_ACCELERATION = MotionInput.ACCELERATION


class Matrix(IntEnum):
    """Values DMB_MATRIX_... of the headers.

    A: shape (states, states)
    B: shape (states, inputs)
    C: shape (outputs, states)
    D: shape (outputs, inputs)
    DAMPING: with gyroscopic terms
    STIFFNESS: each by all rows, body-frame displacements; shape (rows, rows)
    JACOBIAN: of the equations that act; shape (constraint_rows, rows)
    COORDINATES: R of d = R z, z the independent coordinates; shape (rows, independent)
    """
    A = 0
    B = 1
    C = 2
    D = 3
    MASS = 4
    DAMPING = 5
    STIFFNESS = 6
    JACOBIAN = 7
    COORDINATES = 8


MATRIX_A = Matrix.A
MATRIX_B = Matrix.B
MATRIX_C = Matrix.C
MATRIX_D = Matrix.D
MATRIX_MASS = Matrix.MASS
MATRIX_DAMPING = Matrix.DAMPING
MATRIX_STIFFNESS = Matrix.STIFFNESS
MATRIX_JACOBIAN = Matrix.JACOBIAN
MATRIX_COORDINATES = Matrix.COORDINATES


class Array(IntEnum):
    """Values DMB_ARRAY_... of the headers.

    VELOCITY: [m/s, rad/s] shape (rows)
    ACCELERATION: [m/s2, rad/s2] rates of those, shape (rows)
    POSITION: [m] of the nodes, world, shape (nodes, 3)
    QUATERNION: [-] body to world, scalar first, shape (nodes, 4)
    MULTIPLIER: [N, ...] of the rows of MATRIX_JACOBIAN: residual + J^T multiplier = 0
    RESIDUAL: [N, N m] of the equations of motion without forces of constraint, at the present pose, speeds and accelerations, shape (rows): M v' + ... - f; rows of supports keep theirs
    """
    VELOCITY = 0
    ACCELERATION = 1
    POSITION = 2
    QUATERNION = 3
    MULTIPLIER = 4
    RESIDUAL = 5


ARRAY_VELOCITY = Array.VELOCITY
ARRAY_ACCELERATION = Array.ACCELERATION
ARRAY_POSITION = Array.POSITION
ARRAY_QUATERNION = Array.QUATERNION
ARRAY_MULTIPLIER = Array.MULTIPLIER
ARRAY_RESIDUAL = Array.RESIDUAL


class RowState(IntEnum):
    """Values DMB_ROW_... of the headers."""
    FREE = 0
    HELD = 1
    DRIVEN = 2


ROW_FREE = RowState.FREE
ROW_HELD = RowState.HELD
ROW_DRIVEN = RowState.DRIVEN


class OperationKind(IntEnum):
    """Values DMB_OPERATION_... of the headers.

    PICK_UP: pulled without turning
    SLACK_OFF: lowered or pushed without turning
    ROTATE: turned off bottom
    DRILL: turned and fed, with load and torque on the bit
    SLIDE: fed without turning the string, with load and the motor's torque on the bit
    BACK_REAM: turned and pulled
    """
    PICK_UP = 0
    SLACK_OFF = 1
    ROTATE = 2
    DRILL = 3
    SLIDE = 4
    BACK_REAM = 5


OPERATION_PICK_UP = OperationKind.PICK_UP
OPERATION_SLACK_OFF = OperationKind.SLACK_OFF
OPERATION_ROTATE = OperationKind.ROTATE
OPERATION_DRILL = OperationKind.DRILL
OPERATION_SLIDE = OperationKind.SLIDE
OPERATION_BACK_REAM = OperationKind.BACK_REAM


class Measured(IntEnum):
    """Values DMB_MEASURED_... of the headers."""
    HOOK_LOAD = 0
    TORQUE = 1


MEASURED_HOOK_LOAD = Measured.HOOK_LOAD
MEASURED_TORQUE = Measured.TORQUE


NONE = 0xFFFFFFFF
COMBINED = 0xFFFFFFFF
NOT_GIVEN = -1
UNLIMITED = 1e30

ENUMS = (
    Status,
    Has,
    LogLevel,
    Name,
    PartKind,
    Component,
    Free,
    SegmentKind,
    TimeFunctionProvides,
    NormalLaw,
    FrictionLaw,
    HoleShape,
    PipeKind,
    Attach,
    RockLaw,
    JointKind,
    JointMode,
    ConstraintKind,
    ConstraintProvides,
    DriveKind,
    Frame,
    SpringActs,
    TableKind,
    ForceProvides,
    StuckHolds,
    InputTarget,
    Outside,
    EventDirection,
    Events,
    Feature,
    ConstraintMethod,
    HoleBeyond,
    ProfileQuantity,
    Quantity,
    Reading,
    Steady,
    Stiffness,
    StaticMethod,
    Scale,
    BucklingEnd,
    Flutter,
    PathKind,
    ContactState,
    ModesKind,
    ModesSelect,
    ModesAxes,
    ExcitationKind,
    ResponseAxes,
    StateForm,
    MotionInput,
    Matrix,
    Array,
    RowState,
    OperationKind,
    Measured,
)

for _enum in ENUMS:  # help(drillmbd.PIPE_RIGID) tells its own line
    for _line in (_enum.__doc__ or "").splitlines()[2:-1]:
        _name, _text = _line.strip().split(": ", 1)
        _enum[_name].__doc__ = _text
