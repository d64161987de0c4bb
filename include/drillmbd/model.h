/* libdrillmbd - describe a scene and compile it.
 * Besides the bounds stated here, lengths must lie in 1e-6 .. 1e6 m, moduli in 1e-6 .. 1e15 Pa, and so on for every
 * quantity: far beyond any drill string, so that nothing overflows later; messages state the bound.
 * World frame, right-handed: x north and along the default hole, away from the rig; y west; z up. Azimuth is clockwise
 * seen from above: 0 along +x, 90 deg (east) along -y. Body and section frames: origin on the axis of the pipe, x along
 * it towards the bit, rotating with the material; positive rotation is clockwise seen from the rig. Pipes count from
 * the rig end. Drawing: examples/conventions. */
#ifndef DRILLMBD_MODEL_H
#define DRILLMBD_MODEL_H

#include "base.h"

DMB_C_BEGIN

typedef struct dmb_model dmb_model; /* a scene: described, then compiled */

typedef struct dmb_model_options {
    uint32_t struct_size;
    uint32_t reserved;
    const dmb_allocator *allocator; /* copied; NULL: malloc and free */
    dmb_log_fn log;                 /* NULL: silent */
    void *log_context;
    dmb_error_fn on_error; /* NULL: none */
    void *error_context;
} dmb_model_options;
DMB_SIZED_STRUCT(dmb_model_options)

/* Creates an empty model. options may be NULL. Errors: DMB_ERR_NULL, _STRUCT_SIZE, _NO_MEMORY; *model is NULL then. */
DMB_API int32_t dmb_model_create(const dmb_model_options *options, dmb_model **model);
/* Gives up the caller's hold and sets *model to NULL; sims made from the model keep it alive. The hold is one: while
 * they do, copies of the handle are refused (DMB_ERR_HANDLE) and destroying through them does nothing. Nor does it
 * within a call that describes or compiles the model (by its allocator or log), where such calls give DMB_ERR_ORDER.
 * NULL-safe. */
DMB_API void dmb_model_destroy(dmb_model **model);
/* Message of the last failing or noteworthy call on this model. Never NULL; lives until the next call on the model. Of
 * a compiled model, and of questions, each thread reads the failure of its own calls. */
DMB_API const char *dmb_model_message(const dmb_model *model);
/* dmb_model_compile fails with the first refusal of a part, unless a later part of its kind was added with the same
 * name, or, without names, with at most one other field; a wall or environment clears all refusals of its kind before
 * it. This clears all refusals, as the wrappers of C++ and Python do where they throw: an exception is never
 * overlooked. */
DMB_API int32_t dmb_model_clear_refused(dmb_model *model);

/* ---- Components of motion ----------------------------------------------------------------------------------------
 * Components of body-frame velocity, also bits of a mask. A set of free components must be closed under motion (the
 * subgroups of displacements along the axes, Herve 1978): these 22 with names. Others need a joint and are refused. */
/* clang-format off */
enum {
    DMB_X = 0, DMB_Y = 1, DMB_Z = 2, DMB_RX = 3, DMB_RY = 4, DMB_RZ = 5,
    DMB_FREE_NONE = 0, DMB_FREE_X = 1, DMB_FREE_RX = 8, DMB_FREE_RZ = 32, DMB_FREE_CYLINDRICAL = 9, /* X, RX */
    DMB_FREE_SPHERICAL = 56, DMB_FREE_ALL = 63,
    DMB_FREE_Y = 2, DMB_FREE_Z = 4, DMB_FREE_RY = 16,
    DMB_FREE_XY = 3, DMB_FREE_XZ = 5, DMB_FREE_YZ = 6, DMB_FREE_TRANSLATIONS = 7,
    DMB_FREE_CYLINDRICAL_Y = 18, DMB_FREE_CYLINDRICAL_Z = 36,                        /* Y, RY; Z, RZ */
    DMB_FREE_PLANAR = 14, DMB_FREE_PLANAR_Y = 21, DMB_FREE_PLANAR_Z = 35,            /* normal x, y, z: Y, Z, RX ... */
    DMB_FREE_SCHOENFLIES = 15, DMB_FREE_SCHOENFLIES_Y = 23, DMB_FREE_SCHOENFLIES_Z = 39 /* X, Y, Z with RX; RY; RZ */
};
/* clang-format on */

/* ---- Surroundings ------------------------------------------------------------------------------------------------ */
typedef struct dmb_environment_def {
    uint32_t struct_size;
    uint32_t reserved;
    double gravity[3];      /* [m/s2] world frame, default (0, 0, -9.81), shape (3) */
    double fluid_density;   /* [kg/m3] inside and outside of pipes and tool joints, for buoyancy; default 0 */
    double lateral_damping; /* [N s/m2] external damping force per metre of pipe and m/s of sideways speed; default 0 */
    double axial_damping;   /* [N s/m2] the same along the pipe; default 0 */
    double torsional_damping; /* [N s] external moment per metre of pipe and rad/s of spin; default 0 */
    double inner_density;     /* [kg/m3] inside, fluid_density is that outside then; 0 .. ; -1 (default): as outside */
    double added_mass;  /* [-] of the mud outside pipes over the displaced mass (1: far from any wall), >= 0; -1: (D^2 +
                           d^2)/(D^2 - d^2) of each pipe in the wall's `diameter` (Fritz 1972). Where it is not 0 the mud
                           inside moves, too, tool joints are spread over their pipe, stabilisers have that of the mud
                           they displace beyond the pipe; bodies and bits have own fields. 0 (default): no inertia */
    double flow_rate;   /* [m3/s] of mud down the one string of the model, which follows its hole, and back in the
                           annulus, concentric, of the diameters where it is described: drag, pressures, thrust of the
                           nozzles (dmb_query_flow); no inertia of its own sideways. 0 (default): mud rests */
    double consistency; /* [Pa s] K: shear stress = yield_stress + K (shear rate)^n; > 0 with a flow_rate; default 0 */
    double flow_exponent;     /* [-] n, 0.2 .. 1; 1 (default): Newtonian, Bingham's fluid with a yield_stress */
    double yield_stress;      /* [Pa] of the mud, >= 0; 0 (default): power law; with flow_eccentricity = 0 only */
    double nozzle_area;       /* [m2] of the bit in all; 0 (default): the last pipe is open */
    double flow_eccentricity; /* [-] of the annulus, everywhere: distance of the axes over half the difference of the
                                 diameters, 0 (default) .. 0.95; > 0 with flow_exponent >= 0.4 and pipes of 0.3 .. 0.9
                                 hole diameters only. For pressures and drag; poses have no part in it */
} dmb_environment_def;
DMB_SIZED_STRUCT(dmb_environment_def)
DMB_API int32_t dmb_model_set_environment(dmb_model *model, const dmb_environment_def *def);

/* ---- Time functions ----------------------------------------------------------------------------------------------
 * A time function is a sum of segments. Integration steps end at their breakpoints, except bounded-work steps. */
enum {
    DMB_SEGMENT_CONSTANT = 0, /* h0 */
    DMB_SEGMENT_STEP = 1,     /* h0 before x0, h1 after x1, D^2 (3 - 2D) between, D = (t - x0)/(x1 - x0) */
    DMB_SEGMENT_STEP5 = 2,    /* the same with D^3 (10 - 15 D + 6 D^2) */
    DMB_SEGMENT_HARMONIC = 3, /* h0 + h1 sin(omega t + phase) */
    DMB_SEGMENT_TABLE = 4,    /* straight lines through (time, value) pairs, constant outside */
    DMB_SEGMENT_CALLBACK = 5  /* the caller's function */
};
/* out[0] = value, out[1] = its time derivative, out[2] = its integral from 0 to t. The callback must write out[0];
 * values that `provides` does not announce are computed by differences and quadrature. All within
 * +-1e30. Returns 0, or nonzero to stop the step. */
typedef int32_t (*dmb_time_fn)(void *context, double time, double out[3]);
enum { DMB_PROVIDES_RATE = 1, DMB_PROVIDES_INTEGRAL = 2 };

typedef struct dmb_segment {
    uint32_t struct_size;
    int32_t kind;              /* DMB_SEGMENT_..., default DMB_SEGMENT_CONSTANT */
    double x0, x1;             /* [s] start and end of STEP and STEP5, x1 > x0; default 0 and 1 */
    double h0, h1;             /* [unit of the time function] default 0 and 0 */
    double omega;              /* [rad/s] of HARMONIC; default 0 */
    double phase;              /* [rad] of HARMONIC; default 0 */
    const double *table_time;  /* [s] strictly increasing, shape (table_count); copied */
    const double *table_value; /* [unit of the time function] shape (table_count); copied */
    uint32_t table_count;      /* [-] 1 .. 2^20 */
    int32_t provides;          /* DMB_PROVIDES_..., of CALLBACK */
    dmb_time_fn callback;      /* of CALLBACK; pure: same values for the same time, callable from any thread */
    void *callback_context;
} dmb_segment;
DMB_SIZED_STRUCT(dmb_segment)
/* Adds a time function of segment_count segments (1 .. 64), each with the same struct_size. */
DMB_API int32_t dmb_model_add_time_function(dmb_model *model, const dmb_segment *segments, uint32_t segment_count,
                                            dmb_id *time_function);

/* ---- Hole wall --------------------------------------------------------------------------------------------------- */
enum {
    DMB_NORMAL_NONE = -1,               /* no contact */
    DMB_NORMAL_KELVIN_VOIGT = 0,        /* K d^n + c d', never pulling */
    DMB_NORMAL_HUNT_CROSSLEY = 1,       /* K d^n (1 + mu d'/v0), mu = 3(1-e)/2 */
    DMB_NORMAL_LANKARANI_NIKRAVESH = 2, /* mu = 3(1-e^2)/4 */
    DMB_NORMAL_FLORES = 3,              /* mu = 8(1-e)/(5e) */
    DMB_NORMAL_EXACT = 4,               /* mu such that the restitution is the one given */
    DMB_NORMAL_IMPACT = 5               /* K d^n + STEP(d; 0, 0, impact_depth, damping) d', never pulling */
};
enum {
    DMB_FRICTION_NONE = -1,
    DMB_FRICTION_COULOMB = 0,  /* mu_dynamic s_/s with s = sqrt(v^2 + smoothing_speed^2) */
    DMB_FRICTION_AMBROSIO = 1, /* 0 up to smoothing_speed, linear up to full_speed, mu_dynamic beyond */
    DMB_FRICTION_STRIBECK = 2, /* mu_d + (mu_s - mu_d) exp(-s/stribeck_speed), smoothed; its maximum is mu_static */
    DMB_FRICTION_BRISTLE = 3   /* elastic bristle that sticks; breaks away at mu_static, one step late (order 1) */
};

typedef struct dmb_wall_def {
    uint32_t struct_size;
    uint32_t survey_count;    /* [-] 0 (straight hole along `direction`), or 2 .. 2^16 */
    const double *survey;     /* [m, rad, rad] measured depth, inclination from the downward vertical (0 .. pi), azimuth
                                 clockwise seen from above, from +x (north) towards -y (east), -2 pi .. 2 pi; depths
                                 strictly increasing; minimum curvature between; shape (survey_count, 3); copied */
    double origin[3];         /* [m] start of the axis, world frame; default 0, shape (3) */
    double direction[3];      /* [-] of a straight hole, any length, world frame; default (1, 0, 0), shape (3) */
    double diameter;          /* [m] of the hole, > 0; default 0.094 */
    int32_t normal_law;       /* DMB_NORMAL_..., default DMB_NORMAL_EXACT */
    int32_t friction_law;     /* DMB_FRICTION_..., default DMB_FRICTION_STRIBECK */
    double stiffness;         /* [N/m^(n+1)] K per metre of pipe, > 0; default 1e7. Bounces that fixed steps h do not
                                 resolve, h w > 1.4 with w^2 = K l/m, gain no energy, but their restitution is not that
                                 of the law; dmb_statistics.bounces counts them */
    double exponent;          /* [-] n, 1 .. 3; default 1 */
    double restitution;       /* [-] e, 0 .. 1 (> 0 for FLORES); default 0.4. EXACT returns this speed ratio, 1e-3 for
                                 less; HUNT_CROSSLEY returns 0.768, 0.620, 0.516 for 0.7, 0.4, 0.1 */
    double damping;           /* [N s/m2] c per metre of pipe, of KELVIN_VOIGT and IMPACT; default 0 */
    double impact_depth;      /* [m] full damping from here on, of IMPACT; default 1e-4 */
    double approach_speed;    /* [m/s] floor of v0, > 0; default 0.01. Slower impacts return more than e (EXACT, 0.4:
                                 0.878 at 1 mm/s); with less, lasting contacts (damped by K d mu/v0) iterate more */
    double mu_static;         /* [-] largest friction over normal force, >= mu_dynamic; default 0.35. Up to it STRIBECK
                                 creeps, at most at 2.1 smoothing_speed with the defaults, and BRISTLE sticks */
    double mu_dynamic;        /* [-] >= 0; default 0.30 */
    double stribeck_speed;    /* [m/s] > 0; default 1e-2 */
    double smoothing_speed;   /* [m/s] > 0; default 1e-3 */
    double full_speed;        /* [m/s] of AMBROSIO, > smoothing_speed; default 1e-2 */
    double bristle_stiffness; /* [1/m] tangential stiffness over normal force, > 0; default 1e4 */
    double bristle_damping;   /* [s/m] tangential damping over normal force, >= 0; default 0 */
    char name[24];            /* for messages and look-up (names.h), ends with 0; default "" */
    double cut_spacing;       /* [m] > 0: bits and reamers with a rock law leave a hole of their diameter behind, where
                                 it is wider than described: round, about the described axis. Kept at stations this far
                                 apart; the wall goes over from one to the next within it. Beyond the face that cuts and
                                 up to two spacings the hole is as described, which is the pilot hole of a reamer. At
                                 most 2^18 stations. 0 (default): the hole stays as described */
    double cut_start;         /* [m] measured depth of the first of these stations and */
    double cut_end;           /* [m] of the last one, >= three spacings apart: beyond, nothing is cut; default 0 */
    uint32_t friction_table_count; /* [-] points, 2 .. 8, of a table of STRIBECK and BRISTLE for mu_static (its first
                                coefficient), mu_dynamic (its last one) and stribeck_speed; 0 (default): none. Sections
                                of the hole give mu_dynamic alone, and the table acts in proportion */
    uint32_t reserved;
    double friction_table_speed[8]; /* [m/s] of sliding, from 0, strictly increasing, shape (friction_table_count);
                                 static until v_c: 0, v_c and slightly more with mu_static, mu_static, mu_dynamic */
    double friction_table_mu[8]; /* [-] coefficients there, >= 0, the last one > 0; straight between, constant beyond,
                              shape (friction_table_count) */
} dmb_wall_def;
DMB_SIZED_STRUCT(dmb_wall_def)
/* Adds the hole. One hole a model; wall may be NULL. */
DMB_API int32_t dmb_model_add_wall(dmb_model *model, const dmb_wall_def *def, dmb_id *wall);

/* ---- Strings and pipes ------------------------------------------------------------------------------------------- */
typedef struct dmb_string_def {
    uint32_t struct_size;
    int32_t follows_hole; /* 1: starts on the hole's axis at start_depth; 0: straight from `position`. default 1 */
    double start_depth;   /* [m] measured depth of the rig end; default 0 */
    double offset[2];     /* [m] sideways shift from the hole's axis along its y and z axes; default 0, shape (2) */
    double position[3];   /* [m] rig end, world frame, where follows_hole is 0 or there is no hole; shape (3) */
    double rotation[3];   /* [rad] rotation vector of the rig end's frame, as above; shape (3) */
    double velocity[6];   /* [m/s, rad/s] of the string as one rigid body, rig end, body frame, at time 0; shape (6) */
    int32_t start_free;   /* [-] mask of free components at the rig end; default DMB_FREE_CYLINDRICAL */
    int32_t end_free;     /* [-] the same at the far end; default DMB_FREE_ALL */
    char name[24];        /* for messages and look-up (names.h), ends with 0; default "" */
} dmb_string_def;
DMB_SIZED_STRUCT(dmb_string_def)
/* Adds a string without pipes. The first dmb_model_add_pipes without a string makes one by default. */
DMB_API int32_t dmb_model_add_string(dmb_model *model, const dmb_string_def *def, dmb_id *string);

enum {
    DMB_PIPE_FLEXIBLE = 0,        /* SE(3) beam elements: bending, shear, stretch, torsion */
    DMB_PIPE_AXIAL_TORSIONAL = 1, /* stretch and torsion on the hole's axis, 2 coordinates a node */
    DMB_PIPE_RIGID = 2            /* neighbouring rigid pipes are one rigid body */
};
typedef struct dmb_pipe_def {
    uint32_t struct_size;
    int32_t kind;          /* DMB_PIPE_..., default DMB_PIPE_FLEXIBLE */
    dmb_id string;         /* where to append; {0, 0}: the model's first string, made if there is none */
    uint32_t elements;     /* [-] elements in a pipe, 1 .. 1024; default 1 */
    uint32_t seed;         /* [-] of the random eccentricity; default 1 */
    double length;         /* [m] of one pipe with its joint, > 0; default 1 */
    double outer_diameter; /* [m] > inner_diameter; default 0.073 */
    double inner_diameter; /* [m] >= 0; default 0.061 */
    double young_modulus;  /* [Pa] > 0; default 2.1e11 */
    double poisson_ratio;  /* [-] -1 < nu < 0.5; default 0.3 */
    double density;        /* [kg/m3] > 0; default 7850 */
    double shear_factor;   /* [-] kappa in GA = kappa G A, > 0; default 0.5 (thin tube) */
    double damping_time; /* [s] tau of stress-proportional damping s = K (d + tau d')/L; the damping ratio at f [Hz] is
                            pi f tau; default 0: without damping vibrations of a run do not decay, and peaks of torque
                            grow with its length; 1e-4 s is usual for steel pipes in a hole */
    double joint_length; /* [m] of the rigid tool joint at the far end of each pipe; 0: none; < length; default 0 */
    double joint_outer_diameter; /* [m] default 0: as the pipe */
    double joint_inner_diameter; /* [m] default 0: as the pipe */
    double joint_mass;           /* [kg] 0: from the diameters, length and density */
    double joint_inertia[2];     /* [kg m2] about its axis and across, at its centre, the first <= twice the
                                    second; 0: from the geometry; shape (2) */
    double eccentricity;         /* [m] distance of the pipe's centre of mass from its axis, >= 0; default 0 */
    double eccentricity_angle;   /* [rad] from y towards z of the section frame; default 0 */
    double eccentricity_spread;  /* [m] uniform random addition -spread .. spread (cut at 0) pipe by pipe; default 0 */
    double angle_spread;         /* [rad] uniform random addition -spread .. spread pipe by pipe; default 0 */
    double curvature[3];         /* [rad/m] unstressed twist and curvature about x, y, z; default 0, shape (3) */
    double section_stiffness[6]; /* [N, N, N, N m2, N m2, N m2] EA, GA_y, GA_z, GJ, EI_y, EI_z; 0: from the diameters */
    double section_mass;         /* [kg/m] 0: from the diameters */
    double section_inertia[2]; /* [kg m] rotary inertia per metre about x and across; 0: from the diameters; of a rigid
                                  pipe as a body about its axis <= twice across; shape (2) */
    double yield_strength;     /* [Pa] for the share of yield of a profile; 0 (default): not known */
    char name[24];             /* of the pipes that one call adds, for messages and dmb_model_find_pipes; default "" */
    uint32_t contact_points;   /* [-] 3, 4 or 5: flexible pipes meet the wall at as many Gauss-Lobatto points of each
                                  element, its ends among them, each for its weight of the length, tool joints for
                                  their own length at the far end; 0 (default): at nodes only, so that sections bear
                                  the weight w between them as those of a beam on these points: w L^2/12 at the nodes
                                  of pipes that lie on the wall, where contact along the elements gives 0 */
    uint32_t contact_reserved;
} dmb_pipe_def;
DMB_SIZED_STRUCT(dmb_pipe_def)
/* Appends count (1 .. 2^20) equal pipes at the far end of a string; *string (may be NULL) names the string.
 * Pipes are numbered along the whole string, 0 at the rig end. */
DMB_API int32_t dmb_model_add_pipes(dmb_model *model, const dmb_pipe_def *def, uint32_t count, dmb_id *string);

/* ---- Rigid bodies ------------------------------------------------------------------------------------------------ */
enum { DMB_ATTACH_NONE = 0, DMB_ATTACH_START = 1, DMB_ATTACH_END = 2 };
typedef struct dmb_body_def {
    uint32_t struct_size;
    int32_t attach;     /* DMB_ATTACH_START (rig head) or _END: fixed to that end of `string`, no unknowns of its own,
                           reference point and axes those of the end; DMB_ATTACH_NONE: a body of its own (default) */
    dmb_id string;      /* {0, 0}: the model's first string */
    double mass;        /* [kg] > 0; default 1 */
    double centre[3];   /* [m] centre of mass from the reference point, body frame; default 0, shape (3) */
    double inertia[6];  /* [kg m2] xx, yy, zz, xy, xz, yz elements of the inertia matrix at the centre of mass, body
                           axes, positive definite, no principal moment above the sum of the other two by more
                           than 1e-6 of itself; default 1e-3 on the diagonal, shape (6) */
    double position[3]; /* [m] reference point of a free body, world frame; default 0, shape (3) */
    double rotation[3]; /* [rad] rotation vector of a free body; default 0, shape (3) */
    double velocity[6]; /* [m/s, rad/s] of a free body at time 0, body frame; default 0, shape (6) */
    int32_t free_mask;  /* [-] free components of a free body at its reference point; default DMB_FREE_ALL */
    int32_t reserved;
    double contact_diameter; /* [m] of the contact ring at the reference point; 0: none (default) */
    double contact_length;   /* [m] length of wall it represents, > 0; default 1 */
    char name[24];           /* for messages and look-up (names.h), ends with 0; default "" */
    double displaced_volume; /* [m3] that the fluid outside lifts at the centre of mass, >= 0; default 0 */
    double added_mass[2]; /* [kg] of mud that goes along with it where it speeds up along body x, and across, at the x
                             of the centre of mass: as of a body of revolution in mud at rest (a sphere: half the mud
                             displaced; a disc along its axis: 8/3 rho r^3). No weight; >= 0; default 0, shape (2) */
} dmb_body_def;
DMB_SIZED_STRUCT(dmb_body_def)
DMB_API int32_t dmb_model_add_body(dmb_model *model, const dmb_body_def *def, dmb_id *body);

enum {
    DMB_ROCK_NONE = 0,
    DMB_ROCK_RATE = 1, /* Detournay, Defourny 1992: depth of cut 2 pi V/Omega, for drilling at a steady speed. Its
                          torque grows as Omega falls, so that a bit that is slowed down stops at once, and sticks
                          by nothing but its string: there steps may find no solution, however short. Where a bit
                          may stick or bounce (undamped pipes, say) take the next one */
    DMB_ROCK_REGENERATIVE = 2 /* Richard, Germay, Detournay 2007: depth of cut over the surface the last blade left */
};
typedef struct dmb_bit_def {
    uint32_t struct_size;
    int32_t rock_law; /* DMB_ROCK_..., default DMB_ROCK_NONE */
    dmb_id string;    /* the bit is fixed to the far end of it; {0, 0}: the model's first string */
    dmb_id load;      /* [N] time function of the bottom-hole load along the axis, > 0 against the feed; {0, 0}: none */
    double mass;      /* [kg] > 0; default 5 */
    double inertia[2];       /* [kg m2] about the axis and across, at the centre, the first <= twice the second;
                                0 (default): of a solid cylinder */
    double diameter;         /* [m] gauge that meets the wall, <= hole; 0: no contact; default 0.092 */
    double length;           /* [m] > 0, centre at half of it beyond the string's end; default 0.1 */
    double radius;           /* [m] a of the rock law, > 0; default 0.047 */
    double intrinsic_energy; /* [Pa] eps, > 0; default 1e7 */
    double cutting_ratio;    /* [-] zeta, > 0; default 0.6 */
    double contact_strength; /* [Pa] sigma, >= 0; default 1e7 */
    double wear_length;      /* [m] l, >= 0; default 1e-3 */
    double contact_friction; /* [-] the product mu gamma, >= 0; default 0.5 */
    double intrusion_depth;  /* [m] over which the wear-flat force is taken up, > 0; default 1e-4 */
    double bottom;           /* [m] distance of the hole bottom ahead of the bit at time 0, >= 0; default 0 */
    uint32_t blades;         /* [-] 1 .. 64; default 4 */
    uint32_t history;    /* [-] samples of the cut surface kept for the regenerative law, 64 .. 2^20; default 1024 */
    char name[24];       /* for messages and look-up (names.h), ends with 0; default "" */
    double side_cutting; /* [-] steerability: depth that a side force cuts a revolution over the depth that the same
                            force cuts along, d = F/(cutting_ratio intrinsic_energy radius), 0 .. 1e3, in the bit's own
                            axes, whether it is on bottom or not, with any rock_law; the smaller, the more it drills
                            along its own axis. The string behind does not feel the hole that it leaves: give the bit no
                            `diameter`. Nothing at rest in statics. 0 (default): nothing holds the bit sideways */
    double walk_angle; /* [rad] from the side force to the direction of the cut, clockwise seen from the rig: > 0 takes
                          a bit that is pushed upwards to the right (azimuth grows); -1.5 .. 1.5; default 0 */
    double displaced_volume; /* [m3] as of a body */
    dmb_id stabiliser;   /* {0, 0} (default): the bit at the string's end; a stabiliser: a reamer, whose cutting surface
                      is at the middle of that stabiliser. The stabiliser has mass, buoyancy and contact; mass, inertia,
                      diameter, length, displaced_volume and string are ignored, and `bottom` is the distance
                      of the shoulder ahead. Weight on bit, torque and other driller's outputs are those of the bit */
    double inner_radius; /* [m] b of the surface that is cut up to `radius`: pilot hole of a reamer, core of a core bit;
                            0 .. < radius. The rock law has a - b for a, a^2 - b^2 for a^2; default 0 */
    double added_mass[2]; /* [kg] as of a body, at the bit's centre; not of a reamer, whose stabiliser has it;
                             default 0, shape (2) */
} dmb_bit_def;
DMB_SIZED_STRUCT(dmb_bit_def)
DMB_API int32_t dmb_model_add_bit(dmb_model *model, const dmb_bit_def *def, dmb_id *bit);

/* ---- Drives and loads -------------------------------------------------------------------------------------------- */
enum {
    DMB_DRIVE_MOTION = 0, /* the speed of the component follows the time function exactly [m/s, rad/s] */
    DMB_DRIVE_LOAD = 1,   /* the time function is a force or torque on the component [N, N m] */
    DMB_DRIVE_CONTROL = 2 /* force = clamp(kp (v* - v) + ki integral(v* - v)), v* from the time function */
};
typedef struct dmb_drive_def {
    uint32_t struct_size;
    int32_t kind;      /* DMB_DRIVE_..., default DMB_DRIVE_MOTION */
    dmb_id part;       /* a string (its rig end), a body of its own, or a joint; {0, 0}: the model's first string */
    int32_t component; /* DMB_X (feed, default) .. DMB_RZ; must be free there; of a joint: its coordinate */
    int32_t reserved;
    dmb_id time_function; /* required */
    dmb_id excitation;    /* time function added to the first (vibration); {0, 0}: none */
    double gain;          /* [N s/m, N m s] kp of CONTROL, >= 0; default 0 */
    double integral_gain; /* [N/m, N m] ki of CONTROL, >= 0; default 0 */
    double limit_low;     /* [N, N m] default -1e30 */
    double limit_high;    /* [N, N m] > limit_low; default 1e30 */
    char name[24];        /* for messages and look-up (names.h), ends with 0; default "" */
    /* Actuator of a LOAD or CONTROL drive: its command (time function, or that of the controller within the
     * limits) becomes a force after `delay`, changing by at most `force_rate`, with a `lag`, within the torque-speed
     * curve, less the drag. All 0 (default): the force is the command. At the start it has come to its command. On a
     * joint that is open then nothing was commanded, and on one that opens it stays as it is until the joint closes. */
    double delay;      /* [s] from command to force, 0 or 1e-6 .. 1e4 */
    double force_rate; /* [N/s, N m/s] the most its force changes in a second, > 0; 0: it jumps */
    double lag;        /* [s] time constant of the force, 0 or >= 1e-6 */
    double drag;       /* [N s/m, N m s] of the actuator where the component's speed is > 0, >= 0 */
    double back_drag;  /* [N s/m, N m s] where it is < 0: back-spin, >= 0 */
    double inertia;    /* [kg m2] of rotor and gear, turning with the component, which must be RX of a string or a body;
                          >= 0; of MOTION too */
    uint32_t curve_count; /* [-] points of the torque-speed curve: 0 (none) or 2 .. 8 */
    int32_t reserved2;
    double curve_speed[8]; /* [m/s, rad/s] strictly increasing, shape (curve_count) */
    double curve_force[8]; /* [N, N m] >= 0: the most that it pushes towards > 0 at a speed, straight between points,
                              constant beyond; the same mirrored towards < 0; shape (curve_count) */
    uint32_t gain_count;   /* [-] points of a table of CONTROL instead of `gain`, then 0: 0 (none) or 2 .. 16 */
    int32_t reserved3;
    double gain_error[16]; /* [m/s, rad/s] v* - v, strictly increasing, shape (gain_count) */
    double gain_force[16]; /* [N, N m] instead of kp (v* - v), straight between points, constant beyond, shape
                              (gain_count) */
    double mud_pressure; /* [Pa/(N m)] by which the mud's pressure falls through a motor for each N m that it gives, >=
                            0, of RX of a joint; in scenes with a flow_rate that joint is at the far end of the string.
                            dmb_motor_drive fills it. Default 0: no mud flows through it */
} dmb_drive_def;
DMB_SIZED_STRUCT(dmb_drive_def)
DMB_API int32_t dmb_model_add_drive(dmb_model *model, const dmb_drive_def *def, dmb_id *drive);

enum { DMB_FRAME_WORLD = 0, DMB_FRAME_BODY = 1, DMB_FRAME_HOLE = 2 };
typedef struct dmb_load_def {
    uint32_t struct_size;
    int32_t frame;    /* DMB_FRAME_WORLD: dead load (default); DMB_FRAME_BODY: follower */
    dmb_place place;  /* any place of a pipe, or a body; inside an element it gets a node, which divides the element.
                         Within a quarter of the pipe's diameter of a node it acts by the element's interpolation */
    double force[3];  /* [N] in `frame`, shape (3) */
    double moment[3]; /* [N m] in `frame`, shape (3) */
    dmb_id time_function; /* [-] factor over time; {0, 0}: 1 */
    char name[24];        /* for messages and look-up (names.h), ends with 0; default "" */
    double offset[3];     /* [m] of the point where it acts from the place, in its axes; default 0, shape (3) */
} dmb_load_def;
DMB_SIZED_STRUCT(dmb_load_def)
DMB_API int32_t dmb_model_add_load(dmb_model *model, const dmb_load_def *def, dmb_id *load);

/* ---- Compile ----------------------------------------------------------------------------------------------------- */
enum {
    DMB_FEATURE_GRAVITY = 1,
    DMB_FEATURE_CONTACT = 2,
    DMB_FEATURE_FRICTION = 4,
    DMB_FEATURE_ECCENTRICITY = 8,
    DMB_FEATURE_EXCITATION = 16,
    DMB_FEATURE_ROCK = 32,
    DMB_FEATURE_DAMPING = 64,
    DMB_FEATURE_VIBRATION = 24, /* eccentricity and drive excitation */
    DMB_FEATURE_ALL = 127
};
typedef struct dmb_compile_options {
    uint32_t struct_size;
    int32_t features;  /* mask of DMB_FEATURE_...; others are not compiled; default DMB_FEATURE_ALL */
    int32_t pipe_kind; /* DMB_PIPE_... for every pipe, or -1 (default): as described */
    int32_t reserved;
} dmb_compile_options;
DMB_SIZED_STRUCT(dmb_compile_options)
/* Checks the scene as a whole, meshes and numbers it, chooses kernels, and freezes the model: no more parts can be
 * added, any number of threads may make sims of it. options may be NULL. A failed compile leaves the model as it was.
 * Warns (log, dmb_model_message, dmb_analysis_check) of contact rings of bodies and bits that a support keeps off the
 * wall. Errors: that of a part that was refused (dmb_model_clear_refused); DMB_ERR_ORDER (already compiled), _ID (the
 * first string is meant and there is none), _VALUE, _GEOMETRY, _UNSUPPORTED, _TOO_LARGE, _NO_MEMORY. O(elements). */
DMB_API int32_t dmb_model_compile(dmb_model *model, const dmb_compile_options *options);

typedef struct dmb_model_info {
    uint32_t struct_size;
    uint32_t strings;            /* [-] */
    uint32_t pipes;              /* [-] */
    uint32_t rigid_bodies;       /* [-] merged ones count once */
    uint32_t nodes;              /* [-] */
    uint32_t elements;           /* [-] flexible and axial-torsional */
    uint32_t contact_points;     /* [-] */
    uint32_t degrees_of_freedom; /* [-] free velocity components, prescribed ones not counted */
    uint32_t prescribed;         /* [-] components moved by drives */
    uint32_t structural_joints;  /* [-] fixed joints that cost no unknowns */
    uint64_t model_bytes;        /* [byte] held by the compiled scene */
    uint64_t sim_bytes;          /* [byte] of one sim with default options */
    double mass;                 /* [kg] */
    double length;               /* [m] of all strings */
    uint32_t joints;             /* [-] described joints */
    uint32_t constraint_rows;    /* [-] equations of joints, couplings, callbacks and joint drives, active at time 0 */
    uint32_t clusters;           /* [-] groups of parts that joints connect directly */
    uint32_t reduced_nodes;      /* [-] nodes solved by the sparse solver; the others by the block-tridiagonal one */
} dmb_model_info;
DMB_SIZED_STRUCT(dmb_model_info)
/* Counts of a compiled model. Errors: DMB_ERR_ORDER before compile. */
DMB_API int32_t dmb_model_get_info(const dmb_model *model, dmb_model_info *info);

DMB_C_END
#endif
