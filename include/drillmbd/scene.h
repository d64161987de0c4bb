/* libdrillmbd - description of a scene: hole, strings, bodies, bit, joints, forces, drives, inputs, events; names. */
#ifndef DRILLMBD_SCENE_H
#define DRILLMBD_SCENE_H
#include "base.h"
DMB_C_BEGIN
typedef struct dmb_model dmb_model; /* a scene: described, then compiled */

/* Models belong to one thread until they are compiled. Errors of every function of this header that has a model: DMB_ERR_NULL,
 * _HANDLE, _STRUCT_SIZE, _ORDER (of a compiled model, but for its questions; within a call on it); of those that add or set parts
 * also _VALUE, _NOT_FINITE, _ID, _TOO_LARGE, _UNSUPPORTED, _NO_MEMORY: nothing is added then, the id is left as it was, and the
 * message names part, field, value and bounds. They copy the definition and all it points to; the id may be NULL. Parts may be
 * added in any order in which the ids exist that they name. Further errors are listed at each function. */

typedef struct dmb_model_options {
    uint32_t struct_size, reserved;
    const dmb_allocator *allocator; /* copied; NULL: malloc and free */
    dmb_log_fn log; /* NULL: silent */
    void *log_context;
    dmb_error_fn on_error; /* NULL: none */
    void *error_context;
} dmb_model_options;
DMB_SIZED_STRUCT(dmb_model_options)
/* Creates an empty model. options may be NULL. Errors: DMB_ERR_NO_MEMORY; *model is NULL then. */
DMB_API int32_t dmb_model_create(const dmb_model_options *options, dmb_model **model);
/* Releases the caller's reference and sets *model to NULL; sims made from the model keep it alive. There is one reference: while
 * they do, copies of the handle are refused (DMB_ERR_HANDLE) and destroying them does nothing. Within a call that describes or
 * compiles the model (from its allocator or log) it does nothing either, and other calls give DMB_ERR_ORDER. NULL-safe. */
DMB_API void dmb_model_destroy(dmb_model **model);
/* Message of the last failing or noteworthy call on this model. Never NULL; lives until the next call on the model. Of a compiled
 * model, and of questions, each thread reads the failure of its own calls. */
DMB_API const char *dmb_model_message(const dmb_model *model);
/* dmb_model_compile fails with the first refusal of a part, unless a later part of its kind was added with the same name, or,
 * without names, with at most one other field; a wall or environment clears all refusals of its kind before it. This clears all
 * refusals, as the wrappers of C++ and Python do where they throw: an exception is never overlooked. */
DMB_API int32_t dmb_model_clear_refused(dmb_model *model);

/* ---- Names --------------------------------------------------------------------------------------------------------
 * A definition of a part has a `name`, or dmb_model_set_name gives it one; messages state it beside the part's number,
 * dmb_model_find looks it up. A name is text in UTF-8 without control characters, at most 23 bytes and a 0, unique among the
 * parts of its kind. "" (default) is no name; any number of parts may have none. */
enum { DMB_NAME_SIZE = 24 }; /* [byte] of a name and its 0 */
/* clang-format off */
enum { /* kinds of parts, as in the upper 8 bits of an id's index */
    DMB_PART_ANY = 0, DMB_PART_TIME_FUNCTION = 1, DMB_PART_WALL = 2, DMB_PART_STRING = 3, DMB_PART_BODY = 4,
    DMB_PART_BIT = 5, DMB_PART_DRIVE = 6, DMB_PART_LOAD = 7, DMB_PART_JOINT = 8, DMB_PART_COUPLING = 9,
    DMB_PART_CONSTRAINT = 10, DMB_PART_SPRING = 11, DMB_PART_FORCE = 12, DMB_PART_STABILISER = 13, DMB_PART_STUCK = 14,
    DMB_PART_INPUT = 20, DMB_PART_EVENT = 21
};
/* clang-format on */
/* Gives a part another name, or none by ""; an input or an event needs one. Before dmb_model_compile. */
DMB_API int32_t dmb_model_set_name(dmb_model *model, dmb_id part, const char *name);
/* The name of a part into the caller's text, size [byte] >= DMB_NAME_SIZE; "" if it has none. DMB_ERR_ID, _VALUE. */
DMB_API int32_t dmb_model_get_name(const dmb_model *model, dmb_id part, char *name, uint32_t size);
/* The part of that name, of a kind or (DMB_PART_ANY) of all. Errors, which leave *part as it was: DMB_ERR_ID: there is none;
 * _VALUE: parts of several kinds have it, give the kind. */
DMB_API int32_t dmb_model_find(const dmb_model *model, int32_t kind, const char *name, dmb_id *part);
/* The part whose id has that index (of dmb_id), as another model of the same description has it. DMB_ERR_ID: none. */
DMB_API int32_t dmb_model_part(const dmb_model *model, uint32_t index, dmb_id *part);
/* The pipes that one call of dmb_model_add_pipes added under that name (`name` of dmb_pipe_def): *count pipes of *string from
 * *first on. Each may be NULL. DMB_ERR_ID: none. */
DMB_API int32_t dmb_model_find_pipes(const dmb_model *model, const char *name, dmb_id *string, uint32_t *first, uint32_t *count);

/* ---- Components of motion ----------------------------------------------------------------------------------------- */
/* clang-format off */
/* Component indices of body-frame velocity. */
enum { DMB_X = 0, DMB_Y = 1, DMB_Z = 2, DMB_RX = 3, DMB_RY = 4, DMB_RZ = 5 };
/* Sets of components are built from DMB_FREE_* by |; a set of component indices is refused, as is 0; DMB_FREE_NONE is the empty
 * set and may be in any. A set of free components must be closed under motion (the subgroups of displacements, Herve 1978): these
 * with names; others are refused and need a joint. */
enum {
    DMB_FREE_X = 256, DMB_FREE_Y = 512, DMB_FREE_Z = 1024,
    DMB_FREE_RX = 2048, DMB_FREE_RY = 4096, DMB_FREE_RZ = 8192, DMB_FREE_NONE = 16384,
    DMB_FREE_XY = 768, DMB_FREE_XZ = 1280, DMB_FREE_YZ = 1536, DMB_FREE_TRANSLATIONS = 1792,
    DMB_FREE_SPHERICAL = 14336, DMB_FREE_ALL = 16128,
    DMB_FREE_CYLINDRICAL = 2304, /* along and about one axis: X, RX; _Y: Y, RY; _Z: Z, RZ */
    DMB_FREE_CYLINDRICAL_Y = 4608, DMB_FREE_CYLINDRICAL_Z = 9216,
    DMB_FREE_PLANAR = 3584, /* normal x: Y, Z, RX; _Y: X, Z, RY; _Z: X, Y, RZ */
    DMB_FREE_PLANAR_Y = 5376, DMB_FREE_PLANAR_Z = 8960,
    DMB_FREE_SCHOENFLIES = 3840, /* X, Y, Z with RX; _Y: with RY; _Z: with RZ */
    DMB_FREE_SCHOENFLIES_Y = 5888, DMB_FREE_SCHOENFLIES_Z = 9984
};
/* clang-format on */

/* ---- Surroundings ------------------------------------------------------------------------------------------------ */
typedef struct dmb_environment_def {
    uint32_t struct_size, reserved;
    double gravity[3]; /* [m/s2] world frame, default (0, 0, -9.81) */
    double fluid_density; /* [kg/m3] inside and outside of pipes and tool joints, for buoyancy; default 0 */
    double lateral_damping, axial_damping; /* [N s/m2] external, per metre of pipe, against speed sideways, along; default 0 */
    double torsional_damping; /* [N s] external moment per metre of pipe and rad/s of spin; default 0 */
    double inner_density; /* [kg/m3] inside, fluid_density is that outside then; 0 .. ; DMB_NOT_GIVEN (default): as outside */
    double added_mass; /* [-] of the mud outside pipes over the displaced mass (1: far from any wall), >= 0; DMB_NOT_GIVEN: (D^2 +
        d^2)/(D^2 - d^2) of each pipe in the wall's `diameter` (Fritz 1972). Where it is not 0 the mud inside moves, too, and tool
        joints are spread over their pipe; stabilisers: of the mud they displace beyond the pipe. 0 (default): no inertia */
    double flow_rate; /* [m3/s] of mud down the string, the only one of the model, which follows its hole, and back in a
        concentric annulus with the diameters at the depth where the string is described. Gives drag, pressures and thrust of the
        nozzles (dmb_query_flow), no lateral inertia. 0 (default): mud at rest */
    double consistency; /* [Pa s] K: shear stress = yield_stress + K (shear rate)^n; > 0 with a flow_rate; default 0 */
    double flow_exponent; /* [-] n, 0.2 .. 1; 1 (default): Newtonian, Bingham's fluid with a yield_stress */
    double yield_stress; /* [Pa] of the mud, >= 0; 0 (default): power law; with flow_eccentricity = 0 only */
    double nozzle_area; /* [m2] of the bit in all; 0 (default): the last pipe is open */
    double flow_eccentricity; /* [-] of the annulus, everywhere: distance of the axes over half the difference of diameters, 0
        (default) .. 0.95; > 0 with flow_exponent >= 0.4 and pipes of 0.3 .. 0.9 hole diameters. For pressures and drag */
} dmb_environment_def;
DMB_SIZED_STRUCT(dmb_environment_def)
DMB_API int32_t dmb_model_set_environment(dmb_model *model, const dmb_environment_def *def);

/* ---- Time functions ----------------------------------------------------------------------------------------------
 * A time function is a sum of segments. Integration steps end at their breakpoints, except bounded-work steps. */
enum {
    DMB_SEGMENT_CONSTANT = 0, /* h0 */
    DMB_SEGMENT_STEP = 1, /* h0 before x0, h1 after x1, D^2 (3 - 2D) between, D = (t - x0)/(x1 - x0) */
    DMB_SEGMENT_STEP5 = 2, /* the same with D^3 (10 - 15 D + 6 D^2) */
    DMB_SEGMENT_HARMONIC = 3, /* h0 + h1 sin(omega t + phase) */
    DMB_SEGMENT_TABLE = 4, /* straight lines through (time, value) pairs, constant outside */
    DMB_SEGMENT_CALLBACK = 5, /* the caller's function */
    DMB_SEGMENT_PERIODIC = 6, /* TABLE repeated before and after, with the period last time - first time */
    DMB_SEGMENT_PER_REVOLUTION = 7 /* h0 + (h1 + share w) sin(order theta + phase): w is the time function `of`, theta its
        integral from 0 s. Its own integral is exact to round-off. A worn gear: share alone, `of` the speed that turns it */
};
/* out[0] = value, out[1] = its time derivative, out[2] = its integral from 0 to t. The callback must write out[0]; values that
 * `provides` does not announce are computed by differences and quadrature. All within +-DMB_UNLIMITED. Nonzero stops. */
typedef int32_t (*dmb_time_fn)(void *context, double time, double out[3]);
enum { DMB_PROVIDES_RATE = 1, DMB_PROVIDES_INTEGRAL = 2 };
typedef struct dmb_segment {
    uint32_t struct_size;
    int32_t kind; /* DMB_SEGMENT_..., default DMB_SEGMENT_CONSTANT */
    double x0, x1; /* [s] start and end of STEP and STEP5, x1 > x0; default 0 and 1 */
    double h0, h1; /* [unit of the time function] default 0 and 0 */
    double omega, phase; /* [rad/s; rad] of HARMONIC; of HARMONIC and PER_REVOLUTION; default 0 */
    const double *table_time; /* [s] strictly increasing, shape (table_count); copied */
    const double *table_value; /* [unit of the time function] shape (table_count); copied. First = last for PERIODIC */
    uint32_t table_count; /* [-] 1 .. 2^20; 2 .. 2^20 of PERIODIC, with a period of at least 1 us */
    int32_t provides; /* DMB_PROVIDES_..., of CALLBACK */
    dmb_time_fn callback; /* of CALLBACK; pure: same values for the same time, callable from any thread */
    void *callback_context;
    dmb_id of; /* of PER_REVOLUTION: a time function [rad/s] added before, of kinds other than CALLBACK and PER_REVOLUTION. It is
        followed as described; inputs (compile warns of them), dmb_sim_set_drive and limits of drives do not change it */
    double share, order; /* [-] of PER_REVOLUTION: amplitude over w; periods a revolution, > 0; default 0, 1 */
} dmb_segment;
DMB_SIZED_STRUCT(dmb_segment)
/* Adds a time function of segment_count segments (1 .. 64), each with the same struct_size. */
DMB_API int32_t dmb_model_add_time_function(dmb_model *model, const dmb_segment *segments, uint32_t segment_count,
                                            dmb_id *time_function);
/* Adds a time function that is `from` up to `start` [s], `to` from `end` > start on, smooth between: DMB_SEGMENT_STEP5. */
DMB_API int32_t dmb_model_add_ramp(dmb_model *model, double from, double to, double start, double end, dmb_id *time_function);

/* ---- Laws of the caller with a state ---------------------------------------------------------------------------- */
/* Frozen. State of a caller's law: hysteresis, bristles, a delay. The sim keeps it with the motion, in snapshots, hashes and
 * transfers, and drops that of rejected steps; it begins at 0. The law computes `trial` from `accepted`, the motion and `step`
 * alone, and its tangent with the state eliminated: dF/dx + dF/dz dz/dx. */
typedef struct dmb_law_memory {
    const double *accepted; /* at the last accepted time, shape (state_count) */
    double *trial; /* at `time`, written, shape (state_count); `accepted` when called */
    double step; /* [s] between them. 0: no time passes, as in statics, where the state follows the path of load steps, and after
        jumps: the accepted motion must give `accepted`. Linear analyses read damping and stiffness from short steps: use the
        trapezoidal rule for rates */
} dmb_law_memory;
/* Called at each accepted step, just before the function of accepted steps (run.h). number: the contact point, 0 of a force. */
typedef void (*dmb_accept_fn)(void *context, double time, uint32_t number, const double *state);

/* ---- Hole wall --------------------------------------------------------------------------------------------------- */
enum {
    DMB_NORMAL_NONE = -1, /* no contact */
    DMB_NORMAL_KELVIN_VOIGT = 0, /* K d^n + c d', never pulling */
    DMB_NORMAL_HUNT_CROSSLEY = 1, /* K d^n (1 + mu d'/v0), mu = 3(1-e)/2 */
    DMB_NORMAL_LANKARANI_NIKRAVESH = 2, /* mu = 3(1-e^2)/4 */
    DMB_NORMAL_FLORES = 3, /* mu = 8(1-e)/(5e) */
    DMB_NORMAL_EXACT = 4, /* mu such that the restitution is the one given */
    DMB_NORMAL_IMPACT = 5 /* K d^n + STEP(d; 0, 0, impact_depth, damping) d', never pulling */
};
enum {
    DMB_FRICTION_NONE = -1,
    DMB_FRICTION_COULOMB = 0, /* mu_dynamic s_/s with s = sqrt(v^2 + smoothing_speed^2) */
    DMB_FRICTION_AMBROSIO = 1, /* 0 up to smoothing_speed, linear up to full_speed, mu_dynamic beyond */
    DMB_FRICTION_STRIBECK = 2, /* mu_d + (mu_s - mu_d) exp(-s/stribeck_speed), smoothed; its maximum is mu_static */
    DMB_FRICTION_BRISTLE = 3, /* elastic bristle that sticks; breaks away at mu_static, one step late (order 1) */
    DMB_FRICTION_CALLBACK = 4 /* friction_callback */
};
/* Frozen. Arguments of a friction law of the caller; components along the hole and around it. */
typedef struct dmb_friction_at {
    double normal_force; /* [N] >= 0 */
    double slip[2], slip_before[2]; /* [m/s] of the pipe over the wall; at the last accepted time */
    double mu_static, mu_dynamic; /* [-] of the wall or section, times inputs (a law need not use them) */
} dmb_friction_at;
/* The caller's friction at a contact point: force [N] on the pipe, by_slip (2, 2) and by_normal (2) its derivatives by slip and
 * normal force with the state taken along (consistent tangent); all 0 when called. The state is that of the point and 0 whenever
 * it begins to touch. memory->step = INFINITY asks for the friction of steady sliding at this slip, from any state: statics that
 * slip, linear analyses, drives that move steadily. Returns 0, or nonzero to stop. Pure, from the thread of the call. */
typedef int32_t (*dmb_friction_fn)(void *context, const dmb_friction_at *at, double force[2], double by_slip[4],
                                   double by_normal[2], const dmb_law_memory *memory);
typedef struct dmb_wall_def {
    uint32_t struct_size, survey_count; /* [-] 0 (straight hole along `direction`), or 2 .. 2^16 */
    const double *survey; /* [m, rad, rad] measured depth, inclination from the downward vertical (0 .. pi), azimuth clockwise
        seen from above, from +x (north) towards -y (east), -2 pi .. 2 pi; depths strictly increasing; minimum curvature between
        stations, straight on beyond the last one; shape (survey_count, 3); copied */
    double origin[3]; /* [m] start of the axis, world frame; default 0 */
    double direction[3]; /* [-] of a straight hole, any length, world frame; default (1, 0, 0) */
    double diameter; /* [m] of the hole, > 0; default 0.094 */
    int32_t normal_law, friction_law; /* DMB_NORMAL_...; DMB_FRICTION_...; default DMB_NORMAL_EXACT, DMB_FRICTION_STRIBECK */
    double stiffness; /* [N/m^(n+1)] K per metre of pipe, > 0; default 1e7. Bounces that fixed steps h do not resolve, h w > 1.4
        with w^2 = K l/m, gain no energy, but their restitution is not that of the law; dmb_statistics.bounces counts them */
    double exponent; /* [-] n, 1 .. 3; default 1 */
    double restitution; /* [-] e, 0 .. 1 (> 0 for FLORES); default 0.4. EXACT returns this speed ratio, 1e-3 for less;
        HUNT_CROSSLEY returns 0.768, 0.620, 0.516 for 0.7, 0.4, 0.1 */
    double damping, impact_depth; /* [N s/m2; m] c per metre of pipe, of KELVIN_VOIGT and IMPACT; penetration of full damping, of
        IMPACT; default 0, 1e-4 */
    double approach_speed; /* [m/s] floor of v0, > 0; default 0.01. Slower impacts return more than e (EXACT, 0.4: 0.878 at 1
        mm/s); with less, lasting contacts (damped by K d mu/v0) iterate more */
    double mu_static; /* [-] largest friction over normal force, >= mu_dynamic; default 0.35. Up to it STRIBECK creeps, at most at
        2.1 smoothing_speed with the defaults, and BRISTLE sticks */
    double mu_dynamic; /* [-] >= 0; default 0.30 */
    double stribeck_speed, smoothing_speed; /* [m/s] > 0; default 1e-2, 1e-3 */
    double full_speed; /* [m/s] of AMBROSIO, > smoothing_speed; default 1e-2 */
    double bristle_stiffness, bristle_damping; /* [1/m; s/m] > 0; >= 0, tangential, over normal force; default 1e4, 0 */
    char name[24]; /* for messages and look-up, ends with 0; default "" */
    double cut_spacing; /* [m] > 0: bits and reamers with a rock law leave a hole of their diameter behind, where it is wider than
        described: round, about the described axis. Kept at stations this far apart; the wall goes over from one to the next
        within it. Beyond the face that cuts and up to two spacings the hole is as described, which is the pilot hole of a reamer.
        At most 2^18 stations. 0 (default): the hole stays as described */
    double cut_start, cut_end; /* [m] measured depths of first and last station, >= 3 spacings apart: no cut beyond; default 0 */
    uint32_t friction_table_count; /* [-] points, 2 .. 8, of a table of STRIBECK and BRISTLE for mu_static (its first
        coefficient), mu_dynamic (its last one) and stribeck_speed; 0 (default): none. Sections of the hole give mu_dynamic alone,
        and the table acts in proportion */
    uint32_t friction_state_count; /* [-] numbers of its state at a contact point, 0 .. 16; default 0 */
    double friction_table_speed[8]; /* [m/s] of sliding, from 0, strictly increasing, shape (friction_table_count); static until
        v_c: 0, v_c and slightly more with mu_static, mu_static, mu_dynamic */
    double friction_table_mu[8]; /* [-] >= 0, last > 0; straight between, constant beyond; shape as the speeds */
    dmb_friction_fn friction_callback; /* of DMB_FRICTION_CALLBACK, required */
    void *friction_context;
    dmb_accept_fn friction_accept; /* for each contact point; NULL (default): none */
} dmb_wall_def;
DMB_SIZED_STRUCT(dmb_wall_def)
/* Adds the hole. One hole a model; wall may be NULL. */
DMB_API int32_t dmb_model_add_wall(dmb_model *model, const dmb_wall_def *def, dmb_id *wall);

/* ---- Sections of the hole --------------------------------------------------------------------------------------- */
enum {
    DMB_HOLE_STEP = 0, /* the values hold up to the next section, or to the end of the hole */
    DMB_HOLE_LINE = 1 /* they vary linearly to those of the next section */
};
/* A section of the hole: cased, open, washed out, coal, rock. Above the first one the values of dmb_wall_def hold; a field left
 * at DMB_NOT_GIVEN is that of dmb_wall_def, as are the laws and all other values everywhere. Values change smoothly within
 * `transition` (eq:hole.section): where its diameter changes the wall pushes along the axis, so that no energy is made. */
typedef struct dmb_hole_section {
    uint32_t struct_size;
    int32_t shape; /* DMB_HOLE_...; default DMB_HOLE_STEP; the last one must be a step */
    double depth; /* [m] measured depth where it begins; strictly increasing; default 0 */
    double transition; /* [m] > 0; neighbours may not overlap, nor the radius change by more than 1 m/m; default 0.1 */
    double diameter; /* [m] > 0; default DMB_NOT_GIVEN */
    double stiffness; /* [N/m^(n+1)] K per metre of pipe, > 0; default DMB_NOT_GIVEN */
    double restitution; /* [-] 0 .. 1 (> 0 for FLORES); default DMB_NOT_GIVEN */
    double damping; /* [N s/m2] c per metre of pipe, of KELVIN_VOIGT and IMPACT, >= 0; default DMB_NOT_GIVEN */
    double mu_static, mu_dynamic; /* [-] >= 0, mu_static >= mu_dynamic for STRIBECK and BRISTLE; default DMB_NOT_GIVEN */
    double strength; /* [Pa] unconfined compressive strength, >= 0, for dmb_query_hole; no force depends on it; default 0 */
    char name[24]; /* returned by dmb_query_hole; default "" */
} dmb_hole_section;
DMB_SIZED_STRUCT(dmb_hole_section)
/* Adds sections below those that the model has, sections with the same struct_size, 1 .. 2^18 of them in all; the wall may be
 * added before or after. dmb_model_compile refuses overlapping transitions, a line without an end, radii that change too fast,
 * and parts wider than the hole (DMB_ERR_GEOMETRY). dmb_query_hole costs O(log sections) then. */
DMB_API int32_t dmb_model_add_hole_sections(dmb_model *model, const dmb_hole_section *sections, uint32_t count);

/* ---- Strings and pipes ------------------------------------------------------------------------------------------- */
typedef struct dmb_string_def {
    uint32_t struct_size;
    int32_t follows_hole; /* 1: starts on the hole's axis at start_depth; 0: straight from `position`. default 1 */
    double start_depth; /* [m] measured depth of the rig end; default 0 */
    double offset[2]; /* [m] sideways shift from the hole's axis along its y and z axes; default 0 */
    double position[3], rotation[3]; /* [m; rad] rig end (world, if follows_hole is 0 or there is no hole); its rotation vector */
    double velocity[6]; /* [m/s, rad/s] of the string as one rigid body, rig end, body frame, at time 0 */
    int32_t start_free, end_free; /* [-] sets of free components at the rig end, the far end: with X in both and no drive along it
        the string slides, and a load on its bit pushes it out of the hole; default DMB_FREE_CYLINDRICAL, DMB_FREE_ALL */
    char name[24]; /* for messages and look-up, ends with 0; default "" */
} dmb_string_def;
DMB_SIZED_STRUCT(dmb_string_def)
/* Adds a string without pipes. The first dmb_model_add_pipes without a string makes one by default. */
DMB_API int32_t dmb_model_add_string(dmb_model *model, const dmb_string_def *def, dmb_id *string);
enum {
    DMB_PIPE_FLEXIBLE = 0, /* SE(3) beam elements: bending, shear, stretch, torsion */
    DMB_PIPE_AXIAL_TORSIONAL = 1, /* stretch and torsion on the hole's axis, 2 coordinates a node */
    DMB_PIPE_RIGID = 2 /* neighbouring rigid pipes are one rigid body */
};
typedef struct dmb_pipe_def {
    uint32_t struct_size;
    int32_t kind; /* DMB_PIPE_..., default DMB_PIPE_FLEXIBLE */
    dmb_id string; /* where to append; {0, 0}: the model's first string, made if there is none */
    uint32_t elements, seed; /* [-] elements in a pipe, 1 .. 1024; seed of the random eccentricity; default 1, 1 */
    double length; /* [m] of one pipe with its joint, > 0; default 1 */
    double outer_diameter, inner_diameter; /* [m] the first > the second >= 0; default 0.073 and 0.061 */
    double young_modulus, poisson_ratio; /* [Pa; -] > 0; -1 < nu < 0.5; default 2.1e11, 0.3 */
    double density, shear_factor; /* [kg/m3; -] > 0; kappa in GA = kappa G A, > 0; default 7850, 0.5 (thin tube) */
    double damping_time; /* [s] tau of stress-proportional damping s = K (d + tau d')/L; the damping ratio at f [Hz] is pi f tau;
        default 0: without damping vibrations of a run do not decay, and peaks of torque grow with its length; 1e-4 is usual for
        steel pipes in a hole */
    double joint_length; /* [m] of the rigid tool joint at the far end of each pipe; 0: none; < length; default 0 */
    double joint_outer_diameter, joint_inner_diameter; /* [m] default 0: as the pipe */
    double joint_mass; /* [kg] 0: from the diameters, length and density */
    double joint_inertia[2]; /* [kg m2] about its axis and across, at its centre, first <= twice the second; 0: by geometry */
    double eccentricity, eccentricity_angle; /* [m; rad] distance of the pipe's centre of mass from its axis, >= 0; its angle from
        y towards z of the section frame; default 0 */
    double eccentricity_spread, angle_spread; /* [m; rad] uniform random additions pipe by pipe, -spread .. spread, >= 0
        (eccentricity cut at 0); default 0 */
    double curvature[3]; /* [rad/m] unstressed twist and curvature about x, y, z; default 0 */
    double section_stiffness[6]; /* [N, N, N, N m2, N m2, N m2] EA, GA_y, GA_z, GJ, EI_y, EI_z; 0: from the diameters */
    double section_mass; /* [kg/m] 0: from the diameters */
    double section_inertia[2]; /* [kg m] rotary inertia per metre about x and across; 0: from the diameters; of a rigid pipe as a
        body about its axis <= twice across */
    double yield_strength; /* [Pa] for the share of yield of a profile; 0 (default): not known */
    char name[24]; /* of the pipes that one call adds, for messages and dmb_model_find_pipes; default "" */
    uint32_t contact_points, contact_reserved; /* [-] 3, 4 or 5: flexible pipes meet the wall at as many Gauss-Lobatto points of
        each element, its ends among them, each for its weight of the length, tool joints for their own length at the far end; 0
        (default): at nodes only, so that sections bear the weight w between them as those of a beam on these points: w L^2/12 at
        the nodes of pipes that lie on the wall, where contact along the elements gives 0 */
} dmb_pipe_def;
DMB_SIZED_STRUCT(dmb_pipe_def)
/* Appends count (1 .. 2^20) equal pipes at the far end of a string; *string (may be NULL) names the string. Pipes are numbered
 * along the whole string, 0 at the rig end. */
DMB_API int32_t dmb_model_add_pipes(dmb_model *model, const dmb_pipe_def *def, uint32_t count, dmb_id *string);

/* ---- Stabilisers ------------------------------------------------------------------------------------------------ */
/* A stabiliser, centraliser or other body of revolution at any place of a string, rigid with the section of the pipe at its
 * middle. Its mass and inertia are added to those of the pipe, which bends under it as before. It meets the wall at its middle,
 * by the laws of the wall, as `length` metres of pipe of its diameter; the pipe keeps its own contact. It has a node of its own
 * (examples/programming, Parts on strings). {its id, 0, 0}: its middle, in queries, loads, springs, joints, forces. */
typedef struct dmb_stabiliser_def {
    uint32_t struct_size, pipe; /* [-] number along the string; default 0 */
    dmb_id string; /* {0, 0}: the model's first string */
    double fraction; /* [-] 0 .. 1 of the pipe's length: its middle; default 0.5 */
    double outer_diameter; /* [m] that meets the wall, >= outer diameter of the pipe, <= hole; default 0.09 */
    double length, mass; /* [m; kg] > 0; 0: of a hollow cylinder around the pipe, of `density`; default 0.3, 0 */
    double inertia[2]; /* [kg m2] about its axis and across, at the middle, first <= twice second; 0 (default): the cylinder's */
    double density; /* [kg/m3] > 0, also for its buoyancy: its volume is mass/density; default 7850 */
    char name[24]; /* for messages, ends with 0; default "" */
    double added_mass[2]; /* [kg] of mud that moves with it, besides that of the pipe, along its axis and across, >= 0; default 0,
        and DMB_NOT_GIVEN across: by added_mass of the environment, of the mud it displaces beyond the pipe, its ends left out */
} dmb_stabiliser_def;
DMB_SIZED_STRUCT(dmb_stabiliser_def)
/* Pipes may be added before or after. dmb_model_compile refuses pipes that are not there (DMB_ERR_VALUE), stabilisers that
 * overlap, are thinner than their pipe or too wide for the hole (DMB_ERR_GEOMETRY). */
DMB_API int32_t dmb_model_add_stabiliser(dmb_model *model, const dmb_stabiliser_def *def, dmb_id *stabiliser);

/* ---- Rigid bodies ------------------------------------------------------------------------------------------------ */
enum { DMB_ATTACH_NONE = 0, DMB_ATTACH_START = 1, DMB_ATTACH_END = 2 };
typedef struct dmb_body_def {
    uint32_t struct_size;
    int32_t attach; /* DMB_ATTACH_START (rig head) or _END: fixed to that end of `string`, no unknowns of its own, reference point
        and axes those of the end; DMB_ATTACH_NONE: a body of its own (default) */
    dmb_id string; /* {0, 0}: the model's first string */
    double mass; /* [kg] > 0; default 1 */
    double centre[3]; /* [m] centre of mass from the reference point, body frame; default 0 */
    double inertia[6]; /* [kg m2] xx, yy, zz, xy, xz, yz elements of the inertia matrix at the centre of mass, body axes, positive
        definite, no principal moment above the sum of the others by more than 1e-6 of itself; default 1e-3 on the diagonal */
    double position[3], rotation[3]; /* [m; rad] reference point and rotation vector of a free body, world frame; default 0 */
    double velocity[6]; /* [m/s, rad/s] of a free body at time 0, body frame; default 0 */
    int32_t free_mask, reserved; /* [-] free components of a free body at its reference point; default DMB_FREE_ALL */
    double contact_diameter, contact_length; /* [m] of the contact ring at the reference point, 0: none; length of wall that it
        represents, > 0; default 0, 1 */
    char name[24]; /* for messages and look-up, ends with 0; default "" */
    double displaced_volume; /* [m3] that the fluid outside lifts at the centre of mass, >= 0; default 0 */
    double added_mass[2]; /* [kg] added mass of mud along body x and across, at the x of the centre of mass, as of a body of
        revolution in mud at rest (sphere: half that displaced; disc along its axis: 8/3 rho r^3), weightless; >= 0; default 0 */
} dmb_body_def;
DMB_SIZED_STRUCT(dmb_body_def)
DMB_API int32_t dmb_model_add_body(dmb_model *model, const dmb_body_def *def, dmb_id *body);
enum {
    DMB_ROCK_NONE = 0,
    DMB_ROCK_RATE = 1, /* Detournay, Defourny 1992: depth of cut 2 pi V/Omega, for drilling at a steady speed. Its torque grows as
        Omega falls, so that a bit that is slowed down stops at once: where a bit may stick or bounce (undamped pipes, say) steps
        may find no solution, however short; take the next one */
    DMB_ROCK_REGENERATIVE = 2 /* Richard, Germay, Detournay 2007: depth of cut over the surface the last blade left */
};
typedef struct dmb_bit_def {
    uint32_t struct_size;
    int32_t rock_law; /* DMB_ROCK_..., default DMB_ROCK_NONE */
    dmb_id string; /* the bit is fixed to the far end of it; {0, 0}: the model's first string */
    dmb_id load; /* [N] time function of the bottom-hole load along the axis, > 0 against the feed; {0, 0}: none */
    double mass; /* [kg] > 0; default 5 */
    double inertia[2]; /* [kg m2] about the axis and across, at the centre, first <= twice second; 0 (default): solid cylinder */
    double diameter, length; /* [m] gauge that meets the wall, <= hole, 0: no contact; > 0, centre at half of it beyond the
        string's end; default 0.092, 0.1 */
    double radius; /* [m] a of the rock law, > 0; default 0.047 */
    double intrinsic_energy, cutting_ratio; /* [Pa; -] eps, > 0; zeta, > 0; default 1e7, 0.6 */
    double contact_strength; /* [Pa] sigma, >= 0; default 1e7 */
    double wear_length, contact_friction; /* [m; -] l, >= 0; the product mu gamma, >= 0; default 1e-3, 0.5 */
    double intrusion_depth, bottom; /* [m] over which the wear-flat force is taken up, > 0; bottom ahead of the bit at time 0, >=
        0; default 1e-4, 0 */
    uint32_t blades, history; /* [-] 1 .. 64; samples of the cut surface, of REGENERATIVE, 64 .. 2^20; default 4, 1024 */
    char name[24]; /* for messages and look-up, ends with 0; default "" */
    double side_cutting; /* [-] steerability: depth of cut per revolution by a side force over that by the same axial force, d =
        F/(cutting_ratio intrinsic_energy radius), 0 .. 1e3, in the bit's own axes, on and off bottom, with any rock_law; the
        smaller, the more it drills along its own axis. The hole that it cuts does not act on the string: give the bit no
        `diameter`. No effect in statics at rest. 0 (default): no lateral force of the rock */
    double walk_angle; /* [rad] from the side force to the direction of the cut, clockwise seen from the rig: > 0 takes a bit that
        is pushed upwards to the right (azimuth grows); -1.5 .. 1.5; default 0 */
    double displaced_volume; /* [m3] as of a body */
    dmb_id stabiliser; /* {0, 0} (default): the bit at the string's end; a stabiliser: a reamer, whose cutting surface is at the
        middle of that stabiliser. The stabiliser has mass, buoyancy and contact; mass, inertia, diameter, length,
        displaced_volume and string are ignored, and `bottom` is the distance of the shoulder ahead. Weight on bit, torque and
        other driller's outputs are those of the bit */
    double inner_radius; /* [m] b of the surface that is cut up to `radius`: pilot hole of a reamer, core of a core bit; 0 .. <
        radius. The rock law has a - b for a, a^2 - b^2 for a^2; default 0 */
    double added_mass[2]; /* [kg] as of a body, at the bit's centre; a reamer's is that of its stabiliser; default 0 */
} dmb_bit_def;
DMB_SIZED_STRUCT(dmb_bit_def)
DMB_API int32_t dmb_model_add_bit(dmb_model *model, const dmb_bit_def *def, dmb_id *bit);

/* ---- Joints -------------------------------------------------------------------------------------------------------
 * A joint holds frame b on one part against frame a on another. Its coordinates are frame b seen from frame a: X, Y, Z the origin
 * of b in a [m]; RX, RY, RZ the angles of the rotation Ry(RY) Rz(RZ) Rx(RX) from a to b [rad], RX and RY counted over full turns.
 * The x axis of the frames is the joint's axis. Parts need not fit as described, dmb_sim_create brings them together;
 * DMB_ERR_GEOMETRY where axes that the joint keeps parallel end up pointing against each other, and where |RZ| is within 0.01 rad
 * of a right angle (RX and RY are not defined there) in joints that use these angles, at creation, in statics and in a run
 * (lib/theory/joints.md, Joints that are refused). */
/* clang-format off */
enum { /* coordinates that are free */
    DMB_JOINT_FIXED = 0, /* none */ DMB_JOINT_REVOLUTE = 1, /* RX */ DMB_JOINT_PRISMATIC = 2, /* X */
    DMB_JOINT_CYLINDRICAL = 3, /* X, RX */ DMB_JOINT_SPHERICAL = 5, /* RX, RY, RZ */
    DMB_JOINT_UNIVERSAL = 4, /* RY, RZ: crossed axes y of a and z of b */
    DMB_JOINT_PLANAR = 6, /* Y, Z, RX: x is the normal of the plane */
    DMB_JOINT_POINT_ON_LINE = 7, /* X, RX, RY, RZ: origin of b on the x axis of a */
    DMB_JOINT_POINT_ON_HOLE = 8, /* origin of b on the axis of the hole; a must be the ground (support, centraliser) */
    DMB_JOINT_DISTANCE = 9, /* origins `length` apart */
    DMB_JOINT_FREE = 10, /* holds nothing: carries springs, dampers, stops, friction */
    DMB_JOINT_KNIFE_EDGE = 11, /* nonholonomic: the origin of b does not move along y of b (no lateral slip) */
    DMB_JOINT_ROLLING = 12, /* a rim of radius `length` about x of b rolls without slip on plane y, z of a, on the side x > 0 */
    DMB_JOINT_TRANSLATIONAL = 13, /* X, Y, Z: b does not turn against a */
    DMB_JOINT_CROSS_SLIDE = 14, /* Y, Z: two slides across each other */
    DMB_JOINT_SCHOENFLIES = 15 /* X, Y, Z, RX: x of b stays parallel to x of a */
};
/* clang-format on */
enum {
    DMB_JOINT_ACTIVE = 0, /* constrains as its kind says */
    DMB_JOINT_LOCKED = 1, /* holds all six coordinates where they were when it was locked */
    DMB_JOINT_OPEN = 2 /* holds nothing; its springs, dampers, stops and friction do not act */
};
typedef struct dmb_joint_def {
    uint32_t struct_size;
    int32_t kind; /* DMB_JOINT_..., default DMB_JOINT_FIXED */
    char name[24]; /* for messages and look-up, ends with 0; default "" */
    dmb_place place_a; /* node of a string (pipe end, element end), a body or a bit; part {0, 0}: the ground */
    dmb_place place_b; /* node, body or bit as place_a, not the ground */
    double origin_a[3]; /* [m] of frame a, in the frame of place a (ground: world); default 0 */
    double axis_a[3]; /* [-] its x axis, any length > 0; default (1, 0, 0) */
    double normal_a[3]; /* [-] its y axis, made perpendicular to x; 0 (default): y of the place, or z if x is along that */
    double origin_b[3]; /* [m] of frame b, in the frame of place b */
    double axis_b[3], normal_b[3]; /* [-] its x and y axis, as of a */
    int32_t match; /* 1: frame b is where frame a is as described, without origin_b, axis_b, normal_b; 0 (default): as given */
    int32_t state; /* DMB_JOINT_... at time 0; default DMB_JOINT_ACTIVE */
    double length; /* [m] of DISTANCE, radius of ROLLING; > 0; default 1 */
    double stiffness[6]; /* [N/m, N m/rad] of springs along the coordinates, >= 0; default 0 */
    double damping[6]; /* [N s/m, N m s] >= 0; not there without DMB_FEATURE_DAMPING; default 0 */
    double rest[6]; /* [m, rad] where the springs are unstressed; default 0 */
    double friction[6]; /* [N, N m] independent of the reaction, >= 0; not there without DMB_FEATURE_FRICTION; default 0 */
    double friction_speed; /* [m/s, rad/s] over which friction is smoothed, f s/sqrt(s^2 + friction_speed^2), > 0; default 1e-3 */
    double stop_low[6], stop_high[6]; /* [m, rad] stop_high > stop_low; default -DMB_UNLIMITED and DMB_UNLIMITED */
    double stop_stiffness, stop_damping; /* [N/m, N m/rad; N s/m, N m s] > 0; in the stop, never pulling, >= 0; default 1e6, 0 */
    int32_t initial_mask, reserved; /* [-] set of coordinates that are given below, DMB_FREE_X ...; they must be free, and no more
        than 6 with the joint's equations: 5 of KNIFE_EDGE and DISTANCE, 3 of ROLLING, none of a joint described locked; of one
        described open they count all the same; default DMB_FREE_NONE */
    double initial_position[6], initial_speed[6]; /* [m, rad; m/s, rad/s] at time 0 */
} dmb_joint_def;
DMB_SIZED_STRUCT(dmb_joint_def)
/* DMB_ERR_VALUE for a part joined to itself, an axis of zero length, two grounds. */
DMB_API int32_t dmb_model_add_joint(dmb_model *model, const dmb_joint_def *def, dmb_id *joint);
/* A linear relation of two to four joint coordinates: coordinate 0 - ratio * coordinate 1 keeps its value of time 0. Gear: two
 * revolutes; screw: X and RX of one cylindrical joint, ratio = lead/(2 pi). A third and a fourth one are subtracted too, each
 * times its ratio. Differential: cage - 0.5 left - 0.5 right; planetary gear: carrier, sun, annulus gear; tackle: ropes. */
typedef struct dmb_coupling_def {
    uint32_t struct_size, reserved;
    char name[24]; /* for messages and look-up, ends with 0; default "" */
    dmb_id joint[2]; /* may be the same */
    int32_t component[2]; /* DMB_X .. DMB_RZ, free in its joint; default DMB_RX */
    double ratio; /* [-, m/rad, rad/m] not 0; default 1 */
    dmb_id third_joint, fourth_joint; /* {0, 0} (default): two coordinates, or three */
    int32_t third_component, fourth_component; /* DMB_X .. DMB_RZ, free in its joint; default DMB_RX */
    double third_ratio, fourth_ratio; /* [-, m/rad, rad/m] not 0; default 1 */
} dmb_coupling_def;
DMB_SIZED_STRUCT(dmb_coupling_def)
DMB_API int32_t dmb_model_add_coupling(dmb_model *model, const dmb_coupling_def *def, dmb_id *coupling);
/* The caller's constraint on the poses of `place_count` places. poses[i]: position [m] in the world (3), rotation matrix from the
 * place's frame to the world, row-major (9). DMB_CONSTRAINT_HOLONOMIC: value = C(q, t), jacobian = dC by body-frame displacements
 * (translation; rotation) of the places; DMB_CONSTRAINT_NONHOLONOMIC: A(q, t) v + b(q, t) = 0 with value = b and jacobian = A, v
 * the body-frame velocities. Must write value; jacobian is not NULL and must be written where `provides` says so. Returns 0, or
 * nonzero to stop. Pure, from any thread; also called at poses and times near those of the run. */
enum { DMB_CONSTRAINT_HOLONOMIC = 0, DMB_CONSTRAINT_NONHOLONOMIC = 1 };
enum { DMB_PROVIDES_JACOBIAN = 1 };
typedef int32_t (*dmb_constraint_fn)(void *context, double time, uint32_t place_count, const double (*poses)[12],
                                     double *value /* (row_count) */,
                                     double *jacobian /* (row_count, 6 place_count), row-major */);
typedef struct dmb_constraint_def {
    uint32_t struct_size;
    int32_t kind; /* DMB_CONSTRAINT_..., default DMB_CONSTRAINT_HOLONOMIC */
    char name[24]; /* for messages and look-up, ends with 0; default "" */
    uint32_t row_count; /* [-] equations, 1 .. 6; default 1 */
    uint32_t place_count; /* [-] 1 .. 4; default 1 */
    dmb_place place[4]; /* as of a joint, not the ground, shape (place_count) */
    int32_t provides, reserved; /* DMB_PROVIDES_JACOBIAN or 0 (default): built by differences. Nonholonomic must provide it. A
        Jacobian of its own is compared with differences when a sim is made: DMB_ERR_CALLBACK */
    dmb_constraint_fn callback; /* required */
    void *callback_context;
} dmb_constraint_def;
DMB_SIZED_STRUCT(dmb_constraint_def)
DMB_API int32_t dmb_model_add_constraint(dmb_model *model, const dmb_constraint_def *def, dmb_id *constraint);

/* ---- Drives and loads -------------------------------------------------------------------------------------------- */
enum {
    DMB_DRIVE_MOTION = 0, /* the speed of the component follows the time function exactly [m/s, rad/s] */
    DMB_DRIVE_LOAD = 1, /* the time function is a force or torque on the component [N, N m] */
    DMB_DRIVE_CONTROL = 2 /* force = clamp(kp (v* - v) + ki integral(v* - v)), v* from the time function */
};
typedef struct dmb_drive_def {
    uint32_t struct_size;
    int32_t kind; /* DMB_DRIVE_..., default DMB_DRIVE_MOTION */
    dmb_id part; /* a string (its rig end), a body of its own, or a joint; {0, 0}: the model's first string */
    int32_t component, reserved; /* DMB_X (feed, default) .. DMB_RZ; must be free there; of a joint: its coordinate */
    dmb_id time_function, excitation; /* {0, 0} (default): the constant `value`; added to it (vibration), {0, 0}: none */
    double value; /* [m/s, rad/s; N, N m of LOAD] without a time function, 0 with one; default 0: MOTION holds its component */
    double gain, integral_gain; /* [N s/m, N m s; N/m, N m] kp; ki of CONTROL, >= 0; default 0 */
    double limit_low, limit_high; /* [N, N m] limit_high > limit_low; default -DMB_UNLIMITED and DMB_UNLIMITED */
    char name[24]; /* for messages and look-up, ends with 0; default "" */
    /* Actuator of a LOAD or CONTROL drive: its command (time function, or that of the controller within the limits) becomes a
     * force after `delay`, changing by at most `force_rate`, with a `lag`, within the torque-speed curve, less the drag. All 0
     * (default): the force is the command. At the start it has come to its command. On a joint that is open then nothing was
     * commanded, and on one that opens it stays as it is until the joint closes. */
    double delay, force_rate; /* [s; N/s, N m/s] from command to force, 0 or 1e-6 .. 1e4; its largest rate, > 0; 0: jumps */
    double lag; /* [s] time constant of the force, 0 or >= 1e-6 */
    double drag, back_drag; /* [N s/m, N m s] >= 0, of the actuator at speeds > 0; >= 0, at speeds < 0 (back-spin) */
    double inertia; /* [kg m2] >= 0 of rotor and gear, turning with the component, RX of a string or a body; of MOTION too */
    uint32_t curve_count, reserved2; /* [-] points of the torque-speed curve: 0 (none) or 2 .. 8 */
    double curve_speed[8]; /* [m/s, rad/s] strictly increasing, shape (curve_count) */
    double curve_force[8]; /* [N, N m] >= 0: largest force towards > 0 at a speed, linear between points, constant beyond;
        mirrored for forces < 0; shape (curve_count) */
    uint32_t gain_count, reserved3; /* [-] points of a table of CONTROL instead of `gain`, then 0: 0 (none) or 2 .. 16 */
    double gain_error[16]; /* [m/s, rad/s] v* - v, strictly increasing, shape (gain_count) */
    double gain_force[16]; /* [N, N m] instead of kp (v* - v), straight between points, constant beyond, shape (gain_count) */
    double mud_pressure; /* [Pa/(N m)] fall of the mud's pressure for each N m of a motor, >= 0, of RX of a joint, with a
        flow_rate at the far end of the string; by dmb_motor_drive; 0 (default): no mud flows through it */
} dmb_drive_def;
DMB_SIZED_STRUCT(dmb_drive_def)
DMB_API int32_t dmb_model_add_drive(dmb_model *model, const dmb_drive_def *def, dmb_id *drive);
enum { DMB_FRAME_WORLD = 0, DMB_FRAME_BODY = 1, DMB_FRAME_HOLE = 2 };
typedef struct dmb_load_def {
    uint32_t struct_size;
    int32_t frame; /* DMB_FRAME_WORLD: dead load (default); DMB_FRAME_BODY: follower */
    dmb_place place; /* any place of a pipe, or a body; inside an element it gets a node, which divides the element. Within a
        quarter of the pipe's diameter of a node it acts by the element's interpolation */
    double force[3], moment[3]; /* [N; N m] in `frame` */
    dmb_id time_function; /* [-] factor over time; {0, 0}: 1 */
    char name[24]; /* for messages and look-up, ends with 0; default "" */
    double offset[3]; /* [m] of the point where it acts from the place, in its axes; default 0 */
} dmb_load_def;
DMB_SIZED_STRUCT(dmb_load_def)
DMB_API int32_t dmb_model_add_load(dmb_model *model, const dmb_load_def *def, dmb_id *load);

/* ---- Springs and forces of the caller --------------------------------------------------------------------------- */
enum { DMB_SPRING_BOTH = 0, DMB_SPRING_TENSION = 1, DMB_SPRING_COMPRESSION = 2 }; /* sides on which a spring acts */
enum { DMB_TABLE_LINES = 0, DMB_TABLE_CUBIC = 1 }; /* curve through a table */
/* Spring and damper between two points, tension > 0: preload + stiffness e + table(e) + damping e', e the elongation beyond
 * free_length; its length is sqrt(d^2 + (1e-9 m)^2), since points that meet have no direction. */
typedef struct dmb_spring_def {
    uint32_t struct_size;
    int32_t acts; /* DMB_SPRING_...: TENSION (rope) only pulls, COMPRESSION (buffer) only pushes; the damper acts as long as their
        sum does so; default DMB_SPRING_BOTH */
    char name[24]; /* for messages and look-up, ends with 0; default "" */
    dmb_place place_a, place_b; /* part {0, 0} (default): the ground, not both */
    double offset_a[3], offset_b[3]; /* [m] of the points from their places in their axes; ground: world; default 0 */
    double free_length; /* [m] >= 0; DMB_NOT_GIVEN (default): the length at time 0 as described, > 0 */
    double stiffness, damping; /* [N/m; N s/m] >= 0; the damping not there without DMB_FEATURE_DAMPING; default 0 */
    double preload; /* [N] tension at free_length, < 0 pushes; default 0 */
    const double *table_elongation; /* [m] strictly increasing, shape (table_count); copied */
    const double *table_force; /* [N] shape (table_count); extended along its last slopes; not falling if one-sided; copied */
    uint32_t table_count; /* [-] 0 (default): none; 2 .. 2^16 */
    int32_t table_kind; /* DMB_TABLE_LINES (default), or DMB_TABLE_CUBIC: monotone between points */
} dmb_spring_def;
DMB_SIZED_STRUCT(dmb_spring_def)
/* dmb_model_compile refuses with DMB_ERR_VALUE (no such pipe, points that move as one), _GEOMETRY (points that coincide at time 0
 * with a force between them), _UNSUPPORTED (axial-torsional pipes in a curved hole). Within one body or element and the ground it
 * costs no coupling of parts; else it connects parts as a joint does. */
DMB_API int32_t dmb_model_add_spring(dmb_model *model, const dmb_spring_def *def, dmb_id *spring);
/* The caller's force on up to four places or joint coordinates by their poses, velocities and time, in the axes of `frame`.
 * poses[i]: position [m] in the world (3), rotation matrix to the world, row-major (9); velocities[i] [m/s, rad/s]; forces[i]:
 * force [N] and moment [N m] on the place, 0 when called. Of a joint's coordinate number 0 of each counts: value, speed, force
 * along it. tangent, shape (2, 6 place_count, 6 place_count), row-major, 0 when called, may be NULL: derivatives of the forces by
 * displacements of the places in the same axes, velocities there staying the same; then by velocities. potential: [J] by poses
 * and time, counted as stored energy (`strain`); the other power is work of loads. Returns 0, or nonzero to stop. Pure, from any
 * thread; also called at arguments near those of the run. Load steps and factors of buckling leave it alone. */
enum { DMB_PROVIDES_TANGENT = 1, DMB_PROVIDES_POTENTIAL = 2 };
typedef int32_t (*dmb_force_fn)(void *context, double time, uint32_t place_count, const double (*poses)[12],
                                const double (*velocities)[6], double (*forces)[6], double *tangent, double *potential,
                                const dmb_law_memory *memory);
/* Index in `tangent` of d(component k of force i)/d(component l of displacement j; of velocity j if by_velocity). */
static inline uint32_t dmb_tangent_index(uint32_t place_count, int by_velocity, uint32_t i, uint32_t k, uint32_t j, uint32_t l)
{
    return ((by_velocity ? 6 * place_count : 0) + 6 * i + k) * 6 * place_count + 6 * j + l;
}
typedef struct dmb_force_def {
    uint32_t struct_size;
    int32_t frame; /* DMB_FRAME_WORLD (default), or DMB_FRAME_BODY: axes of each place */
    char name[24]; /* for messages and look-up, ends with 0; default "" */
    uint32_t place_count; /* [-] of places and coordinates, 1 .. 4; default 1 */
    int32_t provides; /* DMB_PROVIDES_...; a tangent is checked by dmb_sim_create (_CALLBACK); 0 (default): by differences */
    dmb_place place[4]; /* not the ground; or part is a joint: its coordinate; shape (place_count) */
    double offset[12]; /* [m] of each point from its place, in its axes, shape (place_count, 3); default 0 */
    int32_t component[4]; /* of a joint: DMB_X .. DMB_RZ, free in it; shape (place_count); default 0 */
    double pose_step, speed_step; /* [m, rad; m/s, rad/s] of differences, 1e-12 .. 1; default 1e-5 */
    dmb_force_fn callback; /* required */
    void *callback_context;
    uint32_t state_count, reserved; /* [-] numbers of its state, 0 .. 65536, then without a potential; default 0 */
    dmb_accept_fn accept; /* has callback_context; NULL (default): none */
} dmb_force_def;
DMB_SIZED_STRUCT(dmb_force_def)
/* Errors as of a spring. It does not act on an open joint. Steady states refuse it on moving parts. */
DMB_API int32_t dmb_model_add_force(dmb_model *model, const dmb_force_def *def, dmb_id *force);

/* ---- Bottom-hole assembly --------------------------------------------------------------------------------------- */
/* A place that can be stuck in the hole: a jammed bit, tool joint, key seat. While it is stuck, springs and dampers hold it at
 * the pose where it got stuck, in the axes that its section had there: along the axis, about it, and sideways. It is released
 * when the axial force reaches `overpull` or the torque `overtorque`; the energy of the springs goes to `impact`. An input of
 * target DMB_TARGET_STUCK sets it, 0 or 1; it is 0 again once the place was released (examples/programming, Parts on strings). */
enum { DMB_STUCK_AXIAL = 1, DMB_STUCK_ROTATION = 2, DMB_STUCK_LATERAL = 4 };
typedef struct dmb_stuck_def {
    uint32_t struct_size;
    int32_t holds; /* mask of DMB_STUCK_...; default AXIAL and ROTATION */
    char name[24]; /* for messages, ends with 0; default "" */
    dmb_place place; /* of a pipe, or a body or bit; required */
    int32_t stuck, reserved; /* 1 (default): from time 0 on, in the pose at time 0; 0: free until an input sets it */
    double stiffness[3]; /* [N/m, N m/rad, N/m] along the axis, about it, sideways, > 0; default 1e9, 1e8, 1e9 */
    double damping[3]; /* [N s/m, N m s, N s/m] >= 0; not there without DMB_FEATURE_DAMPING; default 0 */
    double overpull, overtorque; /* [N; N m] axial force, pull or push; torque, either way, at which it is released, > 0,
        overtorque at most stiffness[1] times 1 rad; 0 (default): never, at 1 rad */
} dmb_stuck_def;
DMB_SIZED_STRUCT(dmb_stuck_def)
/* dmb_model_compile refuses with DMB_ERR_VALUE (no such pipe), _UNSUPPORTED (axial-torsional). */
DMB_API int32_t dmb_model_add_stuck(dmb_model *model, const dmb_stuck_def *def, dmb_id *stuck);
/* A mud motor between two sections of a string is a drive on a revolute joint between them (place_a at the far end of the section
 * above, place_b at the rig end of the one below). Its torque T of the relative speed w is a line to w0 = 2 pi flow/displacement
 * (eq:drive.motor), or a table as measured at table_flow and table_pressure, scaled by flow and pressure; w0 is its last speed.
 * Below w = 0 it gives its torque at stall. */
typedef struct dmb_motor {
    uint32_t struct_size;
    int32_t brakes; /* 1: beyond w0 it holds back along the same line, as a pump; 0 (default): it runs free there */
    double stall_torque, displacement; /* [N m; m3] at w = 0, the largest, > 0; volume of mud per revolution, > 0 */
    double flow; /* [m3/s] through the motor, > 0 */
    double pressure; /* [Pa] drop across it at stall, > 0 in place of stall_torque; with a table > 0, or 0: table_pressure */
    double efficiency; /* [-] of pressure to torque, > 0, <= 1; default 1; of a line by pressure only */
    double table_flow, table_pressure; /* [m3/s; Pa] of the table: > 0, or 0 (default): flow; > 0 with a pressure, else >= 0 */
    uint32_t table_count, reserved; /* [-] 0 (default): a line; 2 .. 15: a table, without stall_torque and displacement */
    double table_speed[15]; /* [rad/s] strictly increasing from 0, shape (table_count) */
    double table_torque[15]; /* [N m] >= 0, > 0 at the first, 0 at the last, shape (table_count) */
} dmb_motor;
DMB_SIZED_STRUCT(dmb_motor)
/* Fills the fields of the drive for this motor (kind CONTROL, component RX, gain or its table, limits, mud_pressure; part, time
 * function and name stay) and returns w0 [rad/s], the constant value of its time function (eq:drive.motor). Another flow while it
 * runs: an input of the set point w0, in proportion to it. Errors: DMB_ERR_NULL, _STRUCT_SIZE, _VALUE, _NOT_FINITE. */
DMB_API int32_t dmb_motor_drive(const dmb_motor *motor, dmb_drive_def *drive, double *no_load_speed);
/* A sub: a body in the middle of a string (stabiliser, motor, jar, sensor) at the far end of the string as it is described so
 * far, and the section of pipes that continues the string `length` further along the body's x axis (examples/programming, Parts
 * on strings). Of the structs pointed to, poses, velocities, attach, follows_hole, start_depth, offset, start_free (all free) and
 * places of joints are ignored; frames a of joints are in the axes of the string's end. */
typedef struct dmb_sub_def {
    uint32_t struct_size, reserved;
    dmb_id string; /* with its pipes so far, end_free DMB_FREE_ALL; {0, 0}: the model's first */
    double length; /* [m] >= 0; default 0 */
    const dmb_body_def *body; /* NULL (default): a body by default */
    const dmb_joint_def *before; /* string to body; NULL (default): fixed */
    const dmb_joint_def *after; /* body to section; NULL (default): fixed */
    const dmb_string_def *section; /* its name and end_free; NULL (default): a string by default */
} dmb_sub_def;
DMB_SIZED_STRUCT(dmb_sub_def)
typedef struct dmb_sub {
    uint32_t struct_size, reserved;
    dmb_id body, section, before, after; /* section: the string to add the next pipes to */
    dmb_place end; /* of the string, that `before` joins to the body */
} dmb_sub;
DMB_SIZED_STRUCT(dmb_sub)
/* Adds all parts or none. The string then ends there: dmb_model_add_pipes and _add_bit to it are DMB_ERR_ORDER, and so is
 * dmb_model_add_wall after a sub of a string that would follow the hole. Errors: DMB_ERR_ORDER (no pipes yet, a bit at the end,
 * continued already), _GEOMETRY (survey). */
DMB_API int32_t dmb_model_add_sub(dmb_model *model, const dmb_sub_def *def, dmb_sub *sub);
/* Fills poses and velocities of a body, and of a section follows_hole, start_depth, offset and start_free too, as
 * dmb_model_add_sub has them, `length` beyond the end of the string as it is described so far; for parts that other joints hold
 * there. Either may be NULL. Errors as dmb_model_add_sub. */
DMB_API int32_t dmb_model_place_at_end(dmb_model *model, dmb_id string, double length, dmb_body_def *body,
                                       dmb_string_def *section);

/* ---- Inputs ----------------------------------------------------------------------------------------------------- */
/* clang-format off */
enum { /* targets of inputs: GAIN .. LIMIT_HIGH of CONTROL drives; FRICTION .. TORSIONAL_DAMPING, FLOW_RATE of hole, mud, >= 0 */
    DMB_TARGET_SET_POINT = 0, /* of a drive, instead of its time function; its excitation continues */
    DMB_TARGET_GAIN = 1, DMB_TARGET_INTEGRAL_GAIN = 2, /* [N s/m, N m s], [N/m, N m] >= 0 */
    DMB_TARGET_LIMIT_LOW = 3, DMB_TARGET_LIMIT_HIGH = 4, /* [N, N m] the first below the second */
    DMB_TARGET_LOAD_FACTOR = 5, DMB_TARGET_BIT_LOAD = 6, /* [-] of a load, [N] of a bit, replaces its time function */
    DMB_TARGET_FRICTION = 7, DMB_TARGET_FLUID_DENSITY = 8, /* [-] factor of both coefficients of the wall, [kg/m3] */
    DMB_TARGET_LATERAL_DAMPING = 9, DMB_TARGET_AXIAL_DAMPING = 10, /* [N s/m2] */ DMB_TARGET_TORSIONAL_DAMPING = 11, /* [N s] */
    DMB_TARGET_STUCK = 12, /* [-] 1: a place is stuck from now on, 0: it is free */
    DMB_TARGET_FLOW_RATE = 13 /* [m3/s] of mud, >= 0; all that flow needs of string, hole and mud must be there */
};
/* clang-format on */
/* Joint states are no inputs (dmb_sim_set_joint; examples/programming, Runs); DMB_TARGET_STUCK fixes and releases places. */
enum { DMB_OUTSIDE_REFUSED = 0, DMB_OUTSIDE_CLAMPED = 1 };
typedef struct dmb_input_def {
    uint32_t struct_size;
    int32_t target; /* DMB_TARGET_..., default DMB_TARGET_SET_POINT */
    char name[24]; /* required, unique among the inputs, ends with 0 */
    dmb_id part; /* drive, load, bit or stuck place; {0, 0} of wall and environment */
    double initial; /* [unit of the target] at time 0, within the bounds; NaN (default): as described, until it is set: of
        SET_POINT, LOAD_FACTOR and BIT_LOAD by the time function */
    double low, high; /* [unit of the target] bounds, low <= high; default -DMB_UNLIMITED, DMB_UNLIMITED: those of the target */
    double rate_limit; /* [unit/s] of SET_POINT, LOAD_FACTOR, BIT_LOAD: the most it changes in a second, > 0; 0 (default): it
        jumps. Required for the set point of a MOTION drive: largest acceleration */
    double slope_limit; /* [unit/s2] the most that rate changes in a second, > 0 (largest jerk); 0 (default): it jumps. The value
        then reaches the set point in the least time that both limits allow */
    int32_t outside, reserved; /* DMB_OUTSIDE_...: a value beyond the bounds is refused (default) or taken for the bound */
} dmb_input_def;
DMB_SIZED_STRUCT(dmb_input_def)
/* DMB_ERR_VALUE too for a target that has an input already; DMB_ERR_UNSUPPORTED: the part has no such target. */
DMB_API int32_t dmb_model_add_input(dmb_model *model, const dmb_input_def *def, dmb_id *input);
typedef struct dmb_input_info {
    uint32_t struct_size;
    int32_t target; /* DMB_TARGET_... */
    dmb_id input, part; /* its own id, and the part it acts on */
    char name[24]; /* ends with 0 */
    char unit[16]; /* "rad/s", "-", ... ends with 0 */
    double low, high, rate_limit, slope_limit; /* bounds in force: the narrower of its own and those of the target */
} dmb_input_info;
DMB_SIZED_STRUCT(dmb_input_info)
/* [-] inputs described so far, 0 for an invalid handle; the input at `index` in that order, or of a name (DMB_ERR_ID: none). */
DMB_API uint32_t dmb_model_input_count(const dmb_model *model);
DMB_API int32_t dmb_model_get_input(const dmb_model *model, uint32_t index, dmb_input_info *info);
DMB_API int32_t dmb_model_find_input(const dmb_model *model, const char *name, dmb_id *input);

/* ---- Events ----------------------------------------------------------------------------------------------------- */
/* Frozen. A quantity at a place, for recorders, windows, events and the outputs of responses, stepped sine, state space and FMI
 * units. `place` is any point on the axis of a pipe, or the reference point of a part: there is no offset. A spring of stiffness
 * 0 to a point off these gives length and speed as outputs; dmb_query_motion_at has its motion. */
typedef struct dmb_output {
    dmb_place place; /* place or part that the quantity belongs to */
    int32_t quantity, reserved; /* DMB_OUTPUT_... */
} dmb_output;
/* An event is an output that crosses a level, evaluated at the ends of steps: a crossing and return within one step is missed. It
 * is located by steps really taken to it, so the state lies on it: at most `tolerance` in time beyond the first crossing, on the
 * far side of the level. EITHER: it changes side (a start on the level is on neither). RISING: from at or below the level to
 * above it. FALLING: from at or above it to below. */
enum { DMB_EVENT_EITHER = 0, DMB_EVENT_RISING = 1, DMB_EVENT_FALLING = 2, DMB_EVENTS_MAX = 64 };
typedef struct dmb_event_def {
    uint32_t struct_size;
    int32_t direction; /* DMB_EVENT_..., default DMB_EVENT_RISING */
    char name[24]; /* required, unique among the events, ends with 0 */
    dmb_output output; /* as of a recorder; dmb_sim_create fails if the scene does not have it */
    double level, hold; /* [unit of the output; s] reported when it has stayed beyond so long, >= 0, 0 with EITHER; default 0 */
    double tolerance; /* [s] 1e-12 .. 1, default 1e-9; no less than the rounding of time allows */
} dmb_event_def;
DMB_SIZED_STRUCT(dmb_event_def)
DMB_API int32_t dmb_model_add_event(dmb_model *model, const dmb_event_def *def, dmb_id *event);
DMB_API uint32_t dmb_model_event_count(const dmb_model *model); /* as of inputs; get: as described */
DMB_API int32_t dmb_model_get_event(const dmb_model *model, uint32_t index, dmb_event_def *event);
DMB_API int32_t dmb_model_find_event(const dmb_model *model, const char *name, dmb_id *event);

/* ---- Scene record ------------------------------------------------------------------------------------------------ */
/* The description of a model as bytes that are the same for all machines and for later versions: for files, firmware and other
 * programs. Writes at most `room` bytes; *size is the length of the record, also with bytes NULL and room 0. Of a compiled model
 * too; compile options are not part of it. Errors, which write nothing: DMB_ERR_TOO_LARGE (room), _UNSUPPORTED (functions of the
 * caller, which no record holds), that of a refused part. */
DMB_API int32_t dmb_model_write(const dmb_model *model, void *bytes, size_t room, size_t *size);
/* Makes the model of a record, open for changes before dmb_model_compile. Its scene is the same to the bit, its ids have the same
 * indices. Errors: DMB_ERR_NULL, _VALUE (damaged: length, checksum or content), _UNSUPPORTED (of a newer version), _TOO_LARGE,
 * _NO_MEMORY, those of the calls that add parts; *model is NULL then, dmb_last_error has the reason. */
DMB_API int32_t dmb_model_read(const void *bytes, size_t size, const dmb_model_options *options, dmb_model **model);

/* ---- Compile ----------------------------------------------------------------------------------------------------- */
/* clang-format off */
enum {
    DMB_FEATURE_GRAVITY = 1, DMB_FEATURE_CONTACT = 2, DMB_FEATURE_FRICTION = 4, DMB_FEATURE_ECCENTRICITY = 8,
    DMB_FEATURE_EXCITATION = 16, DMB_FEATURE_ROCK = 32, DMB_FEATURE_DAMPING = 64, DMB_FEATURE_ALL = 127,
    DMB_FEATURE_VIBRATION = 24 /* eccentricity and drive excitation */
};
/* clang-format on */
typedef struct dmb_compile_options {
    uint32_t struct_size;
    int32_t features; /* mask of DMB_FEATURE_...; others are not compiled; default DMB_FEATURE_ALL */
    int32_t pipe_kind, reserved; /* DMB_PIPE_... for every pipe, or DMB_NOT_GIVEN (default): as described */
} dmb_compile_options;
DMB_SIZED_STRUCT(dmb_compile_options)
/* Checks the scene as a whole, meshes and numbers it, chooses kernels, and freezes the model: no more parts can be added, any
 * number of threads may make sims of it. options may be NULL. A failed compile leaves the model as it was. Warns (log,
 * dmb_model_message, dmb_analysis_check) of contact rings of bodies and bits that a support keeps off the wall. Errors: that of a
 * part that was refused (dmb_model_clear_refused); DMB_ERR_ID (the first string is meant and there is none), _VALUE, _GEOMETRY,
 * _UNSUPPORTED, _TOO_LARGE, _NO_MEMORY. O(elements). */
DMB_API int32_t dmb_model_compile(dmb_model *model, const dmb_compile_options *options);
typedef struct dmb_model_info {
    uint32_t struct_size;
    uint32_t strings, pipes, rigid_bodies; /* [-] as described; as described; merged ones count once */
    uint32_t nodes, elements; /* [-] nodes; flexible and axial-torsional elements */
    uint32_t contact_points, degrees_of_freedom; /* [-] contact points; free velocity components, prescribed ones not counted */
    uint32_t prescribed, structural_joints; /* [-] components moved by drives; fixed joints that cost no unknowns */
    uint64_t model_bytes, sim_bytes; /* [byte] held by the compiled scene; of one sim with default options */
    double mass, length; /* [kg; m] of all parts; of all strings */
    uint32_t joints, constraint_rows; /* [-] described; equations of joints, couplings, callbacks and joint drives at time 0 */
    uint32_t clusters, reduced_nodes; /* [-] groups of parts that joints connect directly; nodes solved by the sparse solver, the
        others by the block-tridiagonal one */
} dmb_model_info;
DMB_SIZED_STRUCT(dmb_model_info)
/* Counts of a compiled model. Errors: DMB_ERR_ORDER before compile. */
DMB_API int32_t dmb_model_get_info(const dmb_model *model, dmb_model_info *info);
DMB_C_END
#endif
