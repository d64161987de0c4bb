/* libdrillmbd - ask a sim about its last accepted state. Nothing here changes a sim; every query is O(1) unless it says
 * otherwise (O(log) of stations, contact points or described runs where a place has to be looked up), allocates nothing
 * and returns DMB_OK, DMB_ERR_NULL, _HANDLE, _STRUCT_SIZE, _ID, _VALUE or _NOT_FINITE, leaving the result untouched on
 * error. Between nodes a flexible pipe is interpolated with its own shape functions. */
#ifndef DRILLMBD_QUERY_H
#define DRILLMBD_QUERY_H

#include "sim.h"

DMB_C_BEGIN

typedef struct dmb_pose {
    uint32_t struct_size;
    uint32_t reserved;
    double position[3];     /* [m] of the section's centre, world frame, shape (3) */
    double rotation[9];     /* [-] columns are the section's axes in the world frame, row-major, shape (3, 3) */
    double displacement[3]; /* [m] position less that at time 0 as described, world frame, shape (3) */
    double depth;           /* [m] measured depth of the closest point of the hole's axis; 0 without a hole */
} dmb_pose;
DMB_SIZED_STRUCT(dmb_pose)
DMB_API int32_t dmb_query_pose(const dmb_sim *sim, dmb_place place, dmb_pose *pose);

typedef struct dmb_motion {
    uint32_t struct_size;
    int32_t frame;          /* in: DMB_FRAME_WORLD (default) or DMB_FRAME_BODY */
    double velocity[6];     /* [m/s, rad/s] of the section's centre, in `frame`, shape (6) */
    double acceleration[6]; /* [m/s2, rad/s2] there, in `frame`, shape (6); BODY: rate of velocity in that frame */
} dmb_motion;
DMB_SIZED_STRUCT(dmb_motion)
DMB_API int32_t dmb_query_motion(const dmb_sim *sim, dmb_place place, dmb_motion *motion);

/* [rad] rotation about the pipe's own axis since time 0, revolutions counted. */
DMB_API int32_t dmb_query_rotation(const dmb_sim *sim, dmb_place place, double *angle);

typedef struct dmb_section {
    uint32_t struct_size;
    uint32_t reserved;
    double force[6];  /* [N, N m] on the near side from the far side: axial (tension > 0), shear y, z; torque, bending
                         moment y, z; section frame, shape (6). It balances all that acts between two sections:
                         weight and inertia along the pipe and its tool joint, eccentric mass too, and wall
                         forces, loads, springs at their points (axial-torsional pipes: mean of the element) */
    double strain[6]; /* [-, -, -, rad/m, rad/m, rad/m] mean of element: stretch, shear; twist, curvature; shape (6) */
} dmb_section;
DMB_SIZED_STRUCT(dmb_section)
/* Section loads of a flexible or axial-torsional pipe; DMB_ERR_UNSUPPORTED on rigid ones. */
DMB_API int32_t dmb_query_section(const dmb_sim *sim, dmb_place place, dmb_section *section);

typedef struct dmb_contact {
    uint32_t struct_size;
    int32_t closed;  /* 1 when touching */
    int32_t sticks;  /* 1 when the bristle law holds it */
    uint32_t number; /* [-] of the contact point, 0 .. info.contact_points - 1 */
    dmb_id part;     /* string or body the contact point belongs to */
    uint32_t pipe;   /* [-] pipe whose far end it is, or that it is on; DMB_NONE for the rig end of the string */
    uint32_t reserved;
    double length;       /* [m] of pipe it represents */
    double gap;          /* [m] to the wall, < 0 when penetrating */
    double normal[3];    /* [-] outward, from the axis to the wall, world frame, shape (3) */
    double normal_force; /* [N] on the wall, >= 0 */
    double approach;     /* [m/s] normal speed towards the wall */
    double friction[2];  /* [N] on the pipe: along its axis, along axis x normal; after a static start that assumed a
                            slip (dmb_static_options) that of the equilibrium, until the next step; shape (2) */
    double slip[2];      /* [m/s] of the contact point on the wall, same directions, shape (2) */
    double along;        /* [N] on the pipe along its axis where the wall's diameter or stiffness changes (hole.h) */
} dmb_contact;
DMB_SIZED_STRUCT(dmb_contact)
/* Contact of contact point `number`, counted along the strings (stabilisers before the pipe at their nodes), then the
 * bodies, then points along elements (contact_points), then axial-torsional pipes. */
DMB_API int32_t dmb_query_contact(const dmb_sim *sim, uint32_t number, dmb_contact *contact);
typedef struct dmb_contact_total {
    uint32_t struct_size;
    uint32_t closed;     /* [-] contact points that touch */
    double normal_force; /* [N] sum over the contact points */
    double friction[2];  /* [N] sum of the friction components, shape (2) */
    double deepest;      /* [m] largest penetration, >= 0 */
} dmb_contact_total;
DMB_SIZED_STRUCT(dmb_contact_total)
/* O(number of contact points). */
DMB_API int32_t dmb_query_contact_total(const dmb_sim *sim, dmb_contact_total *sum);

/* [J] kinetic energy of one pipe of a string with half of the parts fixed to its two ends, or of a body. */
DMB_API int32_t dmb_query_kinetic_energy(const dmb_sim *sim, dmb_id part, uint32_t pipe, double *energy);

typedef struct dmb_energy {
    uint32_t struct_size;
    int32_t reserved;
    double kinetic;     /* [J] now */
    double strain;      /* [J] now, flexible pipes, springs and stops of joints */
    double gravity;     /* [J] now, 0 at time 0 as described */
    double contact;     /* [J] now, stored in the wall's stiffness */
    double drives;      /* [J] work put in by all drives since the start */
    double loads;       /* [J] work of described loads, the bottom-hole load, the caller's constraints that move */
    double friction;    /* [J] taken by friction on the wall and in joints, energy stored in bristles included */
    double impact;      /* [J] dissipated by the damping of the normal law and of stops, and by dmb_sim_set_joint:
                           impulses, springs released less those engaged, so it may be negative */
    double damping;     /* [J] dissipated by material and external damping and dampers of joints */
    double rock;        /* [J] spent at the bit */
    double scheme;      /* [J] taken out by the time integration: work of its discrete inertia and potential forces
                           less the change of the energies */
    double input;       /* [J] integral of the sum of each drive's |power| and of |power| of all loads */
    double balance;     /* [J] input and changes of energy that physics leaves open: scheme + unexplained */
    double unexplained; /* [J] balance - scheme: from unconverged iterations only */
    double error;       /* [-] |balance| / scale; 0 only if nothing is missing */
    double scale;       /* [J] largest of the energies supplied (input), dissipated, exchanged with gravity, and present
                           (at the start; now, without gravity) */
    double growth;      /* [-] change of the balance over the last tenth of the time since the start, over scale */
} dmb_energy;
DMB_SIZED_STRUCT(dmb_energy)
/* Energy ledger since the start; DMB_ERR_UNSUPPORTED where the options left it out. O(number of nodes). */
DMB_API int32_t dmb_query_energy(const dmb_sim *sim, dmb_energy *energy);

typedef struct dmb_momentum {
    uint32_t struct_size;
    uint32_t reserved;
    double linear[3];  /* [kg m/s] world frame, shape (3) */
    double angular[3]; /* [kg m2/s] about the world's origin, world frame, shape (3) */
    double mass;       /* [kg] */
    double centre[3];  /* [m] centre of mass, world frame, shape (3) */
} dmb_momentum;
DMB_SIZED_STRUCT(dmb_momentum)
/* O(number of nodes). */
DMB_API int32_t dmb_query_momentum(const dmb_sim *sim, dmb_momentum *momentum);

typedef struct dmb_drive_state {
    uint32_t struct_size;
    uint32_t reserved;
    double target;   /* [unit of the time function] now, excitation included */
    double position; /* [m, rad] of the component since time 0, unwrapped */
    double speed;    /* [m/s, rad/s] */
    double force;    /* [N, N m] that the drive exerts on the part, along the component */
    double power;    /* [W] */
    double work;     /* [J] since the start; 0 without the energy ledger */
    double command;  /* [N, N m] commanded by a LOAD or CONTROL drive now; of MOTION its force */
    double made;     /* [N, N m] command after delay, rate limit and lag of the actuator, before its curve and drag */
} dmb_drive_state;
DMB_SIZED_STRUCT(dmb_drive_state)
DMB_API int32_t dmb_query_drive(const dmb_sim *sim, dmb_id drive, dmb_drive_state *state);
/* [N, N m] force and moment of the support and the motion drives on the rig end of a string or on a supported body,
 * body frame, shape (6); 0 in components that are free. */
DMB_API int32_t dmb_query_reaction(const dmb_sim *sim, dmb_id part, double reaction[6]);

typedef struct dmb_joint_state {
    uint32_t struct_size;
    int32_t frame;            /* in: frame of `reaction`: DMB_FRAME_WORLD (default) or DMB_FRAME_BODY, which is frame b
                                 of the joint; there is none for frame a: DMB_ERR_VALUE */
    int32_t state;            /* DMB_JOINT_... */
    uint32_t constraint_rows; /* [-] equations it holds now */
    uint32_t redundant;       /* [-] of them dropped because others already imply them */
    uint32_t reserved;
    double position[6];     /* [m, rad] coordinates, RX and RY counted over full turns, shape (6) */
    double speed[6];        /* [m/s, rad/s] their rates, shape (6) */
    double acceleration[6]; /* [m/s2, rad/s2] the rates of those, shape (6) */
    double reaction[6];     /* [N, N m] force and moment of the constraint on b from a, at the origin of b, shape (6);
                               of redundant joints those of least norm */
    double action[6];       /* [N, N m] generalised force of springs, dampers, stops and friction on the coordinates,
                               shape (6) */
    double violation;       /* [m, -] largest violation of its equations of position */
} dmb_joint_state;
DMB_SIZED_STRUCT(dmb_joint_state)
DMB_API int32_t dmb_query_joint(const dmb_sim *sim, dmb_id joint, dmb_joint_state *state);
/* Multipliers of a joint, coupling, constraint or joint drive: count of its rows (at most 6), in the units of a force
 * per unit of its value. *count on return is the number of rows. */
DMB_API int32_t dmb_query_multipliers(const dmb_sim *sim, dmb_id part, double multipliers[6], uint32_t *count);

typedef struct dmb_bit_state {
    uint32_t struct_size;
    int32_t on_bottom;    /* 1 while cutting or touching */
    double advance;       /* [m] along the hole's axis since time 0 */
    double bottom;        /* [m] advance at which rock begins */
    double depth_of_cut;  /* [m] per revolution, all blades */
    double weight;        /* [N] weight on bit from the rock law, >= 0 */
    double torque;        /* [N m] torque on bit from the rock law, against the rotation */
    double load;          /* [N] bottom-hole load of the time function */
    double side_force[3]; /* [N] of the rock on the bit across its axis (side_cutting), world frame, shape (3) */
    double side_speed;    /* [m/s] it is cut sideways at, across its axis */
} dmb_bit_state;
DMB_SIZED_STRUCT(dmb_bit_state)
DMB_API int32_t dmb_query_bit(const dmb_sim *sim, dmb_id bit, dmb_bit_state *state);

typedef struct dmb_statistics {
    uint32_t struct_size;
    uint32_t most_iterations; /* [-] of an accepted step */
    uint64_t steps;           /* [-] accepted */
    uint64_t rejected;        /* [-] */
    uint64_t iterations;      /* [-] in accepted and rejected steps */
    uint64_t limited_steps;   /* [-] steps accepted above the tolerance in bounded-work mode */
    uint64_t bytes;           /* [byte] of the sim */
    double largest_residual;  /* [-] relative, of an accepted step */
    double projection[2];     /* [m/s, rad/s] largest correction of initial velocities, shape (2) */
    double assembly[2];       /* [m, rad] largest correction of the described pose when joints were closed, shape (2) */
    uint64_t switches;        /* [-] times the independent coordinates of a cluster were chosen again */
    uint32_t dependent;       /* [-] coordinates that constraints determine now */
    uint32_t redundant;       /* [-] equations that are dropped now */
    double violation;         /* [m, -] largest violation of an equation of position of a joint now; couplings, drives
                                 and the caller's constraints do not count */
    uint64_t bounces;         /* [-] contacts with the wall, stops of joints and springs that opened within fewer than
                                 ten steps after they closed: steps do not resolve them, and their speeds after it are
                                 uncertain. Lasting contacts are not counted. */
} dmb_statistics;
DMB_SIZED_STRUCT(dmb_statistics)
/* O(number of joints, couplings and constraints). */
DMB_API int32_t dmb_query_statistics(const dmb_sim *sim, dmb_statistics *statistics);

/* ---- The hole at a depth ----------------------------------------------------------------------------------------- */
enum { DMB_HOLE_ABOVE = -1, DMB_HOLE_SURVEYED = 0, DMB_HOLE_BELOW = 1 };
typedef struct dmb_hole_point {
    uint32_t struct_size;
    int32_t beyond;         /* DMB_HOLE_ABOVE the first station or _BELOW the last one, where the axis goes straight on;
                               a hole without survey is DMB_HOLE_SURVEYED everywhere */
    double position[3];     /* [m] of the axis, world frame, shape (3) */
    double tangent[3];      /* [-] unit, towards greater depth, world frame, shape (3) */
    double normal[3];       /* [-] unit, towards the centre of curvature, world frame; 0 where straight; shape (3) */
    double curvature;       /* [rad/m] >= 0 */
    double dogleg_severity; /* [deg/30m] the same in the drillers' unit */
    double inclination;     /* [rad] from the downward vertical, 0 .. pi */
    double azimuth;     /* [rad] clockwise seen from above, from +x (north) to -y (east), -pi .. pi; 0 if vertical */
    double diameter;    /* [m] and the wall's other constants here (hole.h): */
    double stiffness;   /* [N/m^(n+1)] per metre of pipe */
    double restitution; /* [-] */
    double damping;     /* [N s/m2] per metre of pipe */
    double mu_static;   /* [-] */
    double mu_dynamic;  /* [-] */
    double strength;    /* [Pa] of a section; 0: not given */
    int32_t section;    /* number of the last section that begins at or above the depth; -1: none */
    uint32_t reserved;
    char section_name[24]; /* of that section, ends with 0; "" without one */
} dmb_hole_point;
DMB_SIZED_STRUCT(dmb_hole_point)
/* The axis at a measured depth [m], by minimum curvature (Taylor, Mason 1972) between stations. A compiled model;
 * DMB_ERR_ORDER before, DMB_ERR_UNSUPPORTED without a hole. O(log stations). */
DMB_API int32_t dmb_query_hole(const dmb_model *model, double depth, dmb_hole_point *point);
/* The same with the diameter that the cutters have left up to now (cut_spacing of dmb_wall_def). */
DMB_API int32_t dmb_query_hole_now(const dmb_sim *sim, double depth, dmb_hole_point *point);

/* ---- Flow of mud ------------------------------------------------------------------------------------------------- */
typedef struct dmb_flow_state {
    uint32_t struct_size;
    uint32_t reserved;
    double rate;             /* [m3/s] flow_rate of the environment */
    double pump_pressure;    /* [Pa] at the rig end, inside over outside: losses, motors and difference of columns */
    double bore_loss;        /* [Pa] of pressure down the string, by friction */
    double bit_loss;         /* [Pa] through nozzle_area, rho Q^2/(2 0.95^2 A^2) (Eckel, Bielstein 1951) */
    double annulus_loss;     /* [Pa] up the annulus of the string, by friction */
    double column;           /* [Pa] of the mud outside over that inside, far end under rig end */
    double drag;             /* [N] of the flow along the string, towards the rig, in its effective axial force */
    double thrust;           /* [N] rho Q V of nozzles or open end, on the far end towards the rig */
    double pressure_stretch; /* [m] by true axial force and pressures on the walls, beyond that of N_e and of poses */
    double bore_reynolds;    /* [-] largest; laminar up to 3470 - 1370 n, by 16/f (Metzner, Reed 1955) */
    double annulus_reynolds; /* [-] largest; beyond 1e5 the smooth wall's law is low: 7 % at 3e5, 15 % at 1e6 */
    double motor_loss;       /* [Pa] through mud motors at the far end at their present torque; in pump_pressure */
} dmb_flow_state;
DMB_SIZED_STRUCT(dmb_flow_state)
/* Pressures and forces of the mud that flows, at the present position of the string; all 0 without a flow_rate but for
 * pressure_stretch of mud at rest. Kinetic heads, steps between diameters, bodies, bits and stabilisers in the annulus
 * and the motion of the string are neglected. The annulus has the flow_eccentricity of the environment, wherever the
 * string lies. O(elements). */
DMB_API int32_t dmb_query_flow(const dmb_sim *sim, dmb_flow_state *flow);

/* ---- Profiles: a string's state over its length ------------------------------------------------------------------
 * Forces are of the section, tension > 0. Section forces of the library are effective ones: true axial force less that
 * of a fluid at rest, N_e = N + p_o A_o - p_i A_i (p the pressure of `fluid_density` under the start of the hole, or
 * the rig end without a hole, >= 0, and of its flow): it is N_e that bends, buckles and yields. Where mud flows N_e
 * is less by rho Q V of that inside, which bends and buckles as compression does. Shares are load over limit: 1 is the
 * limit, 1 - share the margin. */
enum {
    DMB_PROFILE_DISTANCE = 0,            /* [m] along the string from its rig end */
    DMB_PROFILE_DEPTH = 1,               /* [m] measured depth; 0 without a hole */
    DMB_PROFILE_X = 2,                   /* [m] position, world frame */
    DMB_PROFILE_Y = 3,                   /* [m] position, world frame */
    DMB_PROFILE_Z = 4,                   /* [m] position, world frame */
    DMB_PROFILE_DEVIATION = 5,           /* [m] distance from the hole's axis */
    DMB_PROFILE_DEVIATION_SIDE = 6,      /* [m] its horizontal part, along z_world x tangent: left looking ahead */
    DMB_PROFILE_DEVIATION_UP = 7,        /* [m] its other part: towards the high side */
    DMB_PROFILE_AXIAL_FORCE = 8,         /* [N] true axial force N */
    DMB_PROFILE_EFFECTIVE_FORCE = 9,     /* [N] effective axial force N_e, as dmb_query_section */
    DMB_PROFILE_TORQUE = 10,             /* [N m] */
    DMB_PROFILE_BENDING_MOMENT = 11,     /* [N m] magnitude; of axial-torsional pipes EI times the hole's curvature */
    DMB_PROFILE_SHEAR_FORCE = 12,        /* [N] magnitude */
    DMB_PROFILE_CURVATURE = 13,          /* [rad/m] of bending, magnitude, less the unstressed one; 0 in tool joints */
    DMB_PROFILE_NORMAL_FORCE = 14,       /* [N/m] of the wall on the string, >= 0; that of the nearest contact point */
    DMB_PROFILE_FRICTION_AXIAL = 15,     /* [N/m] of the wall on the string along its axis */
    DMB_PROFILE_FRICTION_AROUND = 16,    /* [N/m] of the wall on the string along axis x outward normal */
    DMB_PROFILE_VON_MISES = 17,          /* [Pa] largest at the outer surface, by the diameters: N_e/A and M r/I
                                            together, T r/J (one fluid at rest leaves shape and yield alone); with an
                                            inner_density or flow_rate the largest of both surfaces, hoop stress too */
    DMB_PROFILE_YIELD_SHARE = 18,        /* [-] of `yield_strength`; NaN where the pipe has none */
    DMB_PROFILE_SINUSOIDAL_SHARE = 19,   /* [-] -N_e over the load of sinusoidal buckling; 0 in tension; NaN without
                                            a hole, and in compression where neither weight nor curvature presses the
                                            pipe to the wall */
    DMB_PROFILE_HELICAL_SHARE = 20,      /* [-] compression over the helical buckling load */
    DMB_PROFILE_VELOCITY_AXIAL = 21,     /* [m/s] along the pipe's axis */
    DMB_PROFILE_VELOCITY_LATERAL = 22,   /* [m/s] across, magnitude */
    DMB_PROFILE_SPIN = 23,               /* [rad/s] about the pipe's axis */
    DMB_PROFILE_ACCELERATION_AXIAL = 24, /* [m/s2] of the section's centre, along the pipe's axis */
    DMB_PROFILE_ACCELERATION_LATERAL = 25, /* [m/s2] across, magnitude */
    DMB_PROFILE_ROTATION = 26,             /* [rad] about the pipe's axis since time 0, unwrapped */
    DMB_PROFILE_DISPLACEMENT_X = 27,       /* [m] since time 0 as described, world frame */
    DMB_PROFILE_DISPLACEMENT_Y = 28,       /* [m] since time 0 as described, world frame */
    DMB_PROFILE_DISPLACEMENT_Z = 29,       /* [m] since time 0 as described, world frame */
    DMB_PROFILE_SHEAR_Y = 30,              /* [N] section frame, as dmb_query_section */
    DMB_PROFILE_SHEAR_Z = 31,              /* [N] section frame, as dmb_query_section */
    DMB_PROFILE_MOMENT_Y = 32,             /* [N m] bending about y, section frame */
    DMB_PROFILE_MOMENT_Z = 33,             /* [N m] bending about z, section frame */
    DMB_PROFILE_GAP = 34,                  /* [m] of the nearest contact point to the wall, < 0 when penetrating; NaN
                                              without one */
    DMB_PROFILE_COUNT = 35
};
typedef struct dmb_profile {
    uint32_t struct_size;
    uint32_t station_count;    /* [-] 1 .. 2^24 */
    dmb_id string;             /* {0, 0}: the model's first string */
    const double *distance;    /* [m] of the stations along the string, 0 .. its length, any order, shape
                                  (station_count); NULL: spread evenly from the rig end to the far end */
    const int32_t *quantities; /* DMB_PROFILE_..., shape (quantity_count) */
    uint32_t quantity_count;   /* [-] 1 .. DMB_PROFILE_COUNT, repetitions allowed */
    uint32_t reserved;
    double *values;           /* the caller's; value of quantity q at station i is values[i * station_stride + q *
                                 quantity_stride] */
    uint64_t station_stride;  /* [-] in doubles; both 0 (default): quantity_count and 1 */
    uint64_t quantity_stride; /* [-] */
} dmb_profile;
DMB_SIZED_STRUCT(dmb_profile)
/* Fills profile->values. Section forces, stresses and shares are NaN on rigid pipes. Buckling loads are those of a long
 * pipe that lies on the wall without friction: sinusoidal sqrt(4 EI w_c/r) with the contact force per metre that the
 * unbuckled pipe would have, w_c = |w_across + N_e dt/ds| (Dawson, Paslay 1984; He, Kyllingstad 1995), helical sqrt(2)
 * times that (Chen, Lin, Cheatham 1990), but at least 2.55 and 5.55 times (EI w_along^2)^(1/3) of a vertical hole (Wu,
 * Juvkam-Wold 1995); r the clearance of the nearest contact point, w the weight per metre with buoyancy and tool
 * joints. Errors: DMB_ERR_VALUE (quantity, station off the string, strides that overlap), DMB_ERR_NOT_FINITE,
 * DMB_ERR_ID; nothing is written then. O(station_count). */
DMB_API int32_t dmb_query_profile(const dmb_sim *sim, const dmb_profile *profile);
/* Name of a quantity ("axial_force") and its unit in *unit (may be NULL); NULL for a number that is none. */
DMB_API const char *dmb_profile_name(int32_t quantity, const char **unit);

/* ---- Recorder ----------------------------------------------------------------------------------------------------
 * Chosen outputs at a chosen rate into the caller's memory: a table of rows (time, outputs...). Take a sample after
 * every step; one is kept when its time has come. */
enum {
    DMB_OUTPUT_DISPLACEMENT_X = 0,
    DMB_OUTPUT_DISPLACEMENT_Y = 1,
    DMB_OUTPUT_DISPLACEMENT_Z = 2, /* [m] world */
    DMB_OUTPUT_VELOCITY_X = 3,
    DMB_OUTPUT_VELOCITY_Y = 4,
    DMB_OUTPUT_VELOCITY_Z = 5, /* [m/s] world */
    DMB_OUTPUT_POSITION_X = 6,
    DMB_OUTPUT_POSITION_Y = 7,
    DMB_OUTPUT_POSITION_Z = 8,      /* [m] world */
    DMB_OUTPUT_ROTATION = 9,        /* [rad] unwrapped */
    DMB_OUTPUT_SPIN = 10,           /* [rad/s] about the pipe's axis */
    DMB_OUTPUT_AXIAL_FORCE = 11,    /* [N] tension > 0 */
    DMB_OUTPUT_TORQUE = 12,         /* [N m] */
    DMB_OUTPUT_BENDING_MOMENT = 13, /* [N m] magnitude */
    DMB_OUTPUT_KINETIC_ENERGY = 14, /* [J] of the pipe or body */
    DMB_OUTPUT_NORMAL_FORCE = 15,   /* [N] at the pipe's far end, or of the body */
    DMB_OUTPUT_DRIVE_FORCE = 16,    /* [N, N m] place.part is a drive */
    DMB_OUTPUT_DRIVE_SPEED = 17,    /* [m/s, rad/s] place.part is a drive */
    DMB_OUTPUT_BIT_WEIGHT = 18,     /* [N] place.part is a bit, bottom-hole load included */
    DMB_OUTPUT_ENERGY_ERROR = 19,   /* [-] of the ledger; place is ignored */
    DMB_OUTPUT_COUNT = 20           /* of these; output.h continues from number 100 */
};
/* Frozen. One number of the many that can be recorded, watched and waited for. `place` is any point on the axis of a
 * pipe, or the reference point of a part: there is no offset. A spring of stiffness 0 to a point off these gives
 * its length and speed (forces.h, as outputs); so do dmb_query_motion with the arm, and a body that is fixed there. */
typedef struct dmb_output {
    dmb_place place;  /* where the quantity is one of a place */
    int32_t quantity; /* DMB_OUTPUT_... */
    int32_t reserved; /* 0 */
} dmb_output;

typedef struct dmb_window dmb_window; /* output.h */
typedef struct dmb_recorder {
    uint32_t struct_size;
    uint32_t output_count;     /* [-] 1 .. 4096 */
    const dmb_output *outputs; /* shape (output_count); the caller's, kept alive by it */
    double *table;             /* shape (capacity, 1 + output_count); the caller's */
    uint64_t capacity;         /* [-] rows of table */
    uint64_t row_count;        /* [-] rows written; start with 0 */
    double interval;           /* [s] between samples, 0: every call */
    const dmb_window *window;  /* of the outputs of a window (output.h), fed by the caller before; default NULL */
} dmb_recorder;
DMB_SIZED_STRUCT(dmb_recorder)
/* Writes a row if its time has come. DMB_NOTE_FULL when the table has no room; DMB_ERR_ORDER before the time of the last
 * row, as after a restore: set row_count to the number of rows to keep. O(outputs). */
DMB_API int32_t dmb_recorder_take(dmb_recorder *recorder, const dmb_sim *sim);
/* Writes the table as CSV (comma, '.', a header line of names [units], 17 digits, nan). DMB_ERR_IO on failure: this and
 * all that write files write beside path (path.part0) and rename, so that the old file stays, unless path is a
 * device. */
DMB_API int32_t dmb_recorder_write_csv(const dmb_recorder *recorder, const char *path);
/* VTK XML poly-data for ParaView: the strings as lines with fields (displacement, velocity, diameter, axial force,
 * torque, bending moment, normal force), `per_element` points an element (1 .. 64). DMB_ERR_IO on failure. */
DMB_API int32_t dmb_write_vtk_strings(const dmb_sim *sim, uint32_t per_element, const char *path);
/* The hole as a tube of `around` facets (3 .. 360) with a circle each `spacing` [m] from depth0 to depth1 [m]. */
DMB_API int32_t dmb_write_vtk_hole(const dmb_model *model, double depth0, double depth1, double spacing,
                                   uint32_t around, const char *path);

DMB_C_END
#endif
