/* libdrillmbd - ask a sim about its last accepted state. Nothing here changes a sim; every query is O(1) unless it says
 * otherwise (O(log) of stations, sites or described runs where a place has to be looked up), allocates nothing and
 * returns DMB_OK, DMB_ERR_NULL, _HANDLE, _STRUCT_SIZE, _ID, _VALUE or _NOT_FINITE, leaving the answer untouched on
 * error. Between nodes a flexible pipe is interpolated with its own shape functions. */
#ifndef DRILLMBD_QUERY_H
#define DRILLMBD_QUERY_H

#include "sim.h"

#ifdef __cplusplus
extern "C" {
#endif

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
    double acceleration[6]; /* [m/s2, rad/s2] likewise, shape (6); in the body frame the rate of velocity there */
} dmb_motion;
DMB_SIZED_STRUCT(dmb_motion)
DMB_API int32_t dmb_query_motion(const dmb_sim *sim, dmb_place place, dmb_motion *motion);

/* [rad] rotation about the pipe's own axis since time 0, revolutions counted. */
DMB_API int32_t dmb_query_rotation(const dmb_sim *sim, dmb_place place, double *angle);

typedef struct dmb_section {
    uint32_t struct_size;
    uint32_t reserved;
    double force[6];  /* [N, N m] on the near side from the far side: axial (tension > 0), shear y, z; torque, bending
                         moment y, z; section frame; the pipe's own weight and inertia included between its
                         nodes, where wall forces act (axial-torsional pipes: mean of the element); shape (6) */
    double strain[6]; /* [-, -, -, rad/m, rad/m, rad/m] mean of element: stretch, shear; twist, curvature; shape (6) */
} dmb_section;
DMB_SIZED_STRUCT(dmb_section)
/* Section loads of a flexible or axial-torsional pipe; DMB_ERR_UNSUPPORTED on rigid ones. */
DMB_API int32_t dmb_query_section(const dmb_sim *sim, dmb_place place, dmb_section *section);

typedef struct dmb_contact {
    uint32_t struct_size;
    int32_t closed; /* 1 when touching */
    int32_t sticks; /* 1 when the bristle law holds it */
    uint32_t site;  /* [-] number of the site, 0 .. info.contact_sites - 1 */
    dmb_id part;    /* string or body the site belongs to */
    uint32_t pipe;  /* [-] pipe whose far end it is; DMB_NONE for the rig end of the string */
    uint32_t reserved;
    double length;       /* [m] of pipe it stands for */
    double gap;          /* [m] to the wall, < 0 when penetrating */
    double normal[3];    /* [-] outward, from the axis to the wall, world frame, shape (3) */
    double normal_force; /* [N] on the wall, >= 0 */
    double approach;     /* [m/s] normal speed towards the wall */
    double friction[2];  /* [N] on the pipe: along its axis, along axis x normal; after a static start that assumed a
                            slip (dmb_static_options) what its equilibrium took, until the next step; shape (2) */
    double slip[2];      /* [m/s] of the contact point on the wall, same directions, shape (2) */
} dmb_contact;
DMB_SIZED_STRUCT(dmb_contact)
/* Contact of one site, sites counted along the strings and then the bodies. */
DMB_API int32_t dmb_query_contact(const dmb_sim *sim, uint32_t site, dmb_contact *contact);
typedef struct dmb_contact_total {
    uint32_t struct_size;
    uint32_t closed;     /* [-] sites that touch */
    double normal_force; /* [N] sum over the sites */
    double friction[2];  /* [N] sum of the friction components over the sites, shape (2) */
    double deepest;      /* [m] largest penetration, >= 0 */
} dmb_contact_total;
DMB_SIZED_STRUCT(dmb_contact_total)
/* O(number of sites). */
DMB_API int32_t dmb_query_contact_total(const dmb_sim *sim, dmb_contact_total *sum);

/* [J] kinetic energy of one pipe of a string with half of what is fixed to its two ends, or of a body. */
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
    double friction;    /* [J] taken by friction on the wall and in joints, what bristles store included */
    double impact;      /* [J] dissipated by the damping of the normal law and of stops, and what dmb_sim_set_joint
                           takes: impulses, springs let go less those taken up, so it may be negative */
    double damping;     /* [J] dissipated by material and external damping and dampers of joints */
    double rock;        /* [J] spent at the bit */
    double scheme;      /* [J] taken out by the time integration: what its discrete inertia and potential forces did
                           less what the energies changed */
    double input;       /* [J] integral of the sum of each drive's |power| and of |power| of all loads, the scale of
                           `error` */
    double balance;     /* [J] input and changes of energy that physics leaves open: scheme + unexplained */
    double unexplained; /* [J] balance - scheme: from unconverged iterations only */
    double error;       /* [-] |balance| / input, 0 while input is 0 */
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
    double target;   /* [unit of the programme] now, excitation included */
    double position; /* [m, rad] of the component since time 0, unwrapped */
    double speed;    /* [m/s, rad/s] */
    double force;    /* [N, N m] that the drive exerts on the part, along the component */
    double power;    /* [W] */
    double work;     /* [J] since the start; 0 without the energy ledger */
} dmb_drive_state;
DMB_SIZED_STRUCT(dmb_drive_state)
DMB_API int32_t dmb_query_drive(const dmb_sim *sim, dmb_id drive, dmb_drive_state *state);
/* [N, N m] force and moment of the guide and the motion drives on the rig end of a string or on a guided body, body
 * frame, shape (6); 0 in components that are free. */
DMB_API int32_t dmb_query_reaction(const dmb_sim *sim, dmb_id part, double reaction[6]);

typedef struct dmb_joint_state {
    uint32_t struct_size;
    int32_t frame;            /* in: frame of `reaction`: DMB_FRAME_WORLD (default) or DMB_FRAME_BODY, which is frame b
                                 of the joint; there is none for frame a: DMB_ERR_VALUE */
    int32_t state;            /* DMB_JOINT_... */
    uint32_t constraint_rows; /* [-] equations it holds now */
    uint32_t redundant;       /* [-] of them dropped because others already hold what they hold */
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
    int32_t on_bottom;   /* 1 while cutting or touching */
    double advance;      /* [m] along the hole's axis since time 0 */
    double bottom;       /* [m] advance at which rock begins */
    double depth_of_cut; /* [m] per revolution, all blades */
    double weight;       /* [N] weight on bit from the rock law, >= 0 */
    double torque;       /* [N m] torque on bit from the rock law, against the rotation */
    double load;         /* [N] bottom-hole load of the programme */
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
    uint64_t switches;        /* [-] times the independent coordinates of a cluster were chosen anew */
    uint32_t dependent;       /* [-] coordinates that constraints determine now */
    uint32_t redundant;       /* [-] equations that are dropped now */
    double violation;         /* [m, -] largest violation of an equation of position of a joint now; couplings, drives
                                 and the caller's constraints do not count */
} dmb_statistics;
DMB_SIZED_STRUCT(dmb_statistics)
/* O(number of joints, couplings and constraints). */
DMB_API int32_t dmb_query_statistics(const dmb_sim *sim, dmb_statistics *statistics);

/* ---- Recorder ----------------------------------------------------------------------------------------------------
 * Chosen channels at a chosen rate into the caller's memory: a table of rows (time, channels...). Take a sample after
 * every step; one is kept when its time has come. */
enum {
    DMB_CHANNEL_DISPLACEMENT_X = 0,
    DMB_CHANNEL_DISPLACEMENT_Y = 1,
    DMB_CHANNEL_DISPLACEMENT_Z = 2, /* [m] world */
    DMB_CHANNEL_VELOCITY_X = 3,
    DMB_CHANNEL_VELOCITY_Y = 4,
    DMB_CHANNEL_VELOCITY_Z = 5, /* [m/s] world */
    DMB_CHANNEL_POSITION_X = 6,
    DMB_CHANNEL_POSITION_Y = 7,
    DMB_CHANNEL_POSITION_Z = 8,      /* [m] world */
    DMB_CHANNEL_ROTATION = 9,        /* [rad] unwrapped */
    DMB_CHANNEL_SPIN = 10,           /* [rad/s] about the pipe's axis */
    DMB_CHANNEL_AXIAL_FORCE = 11,    /* [N] tension > 0 */
    DMB_CHANNEL_TORQUE = 12,         /* [N m] */
    DMB_CHANNEL_BENDING_MOMENT = 13, /* [N m] magnitude */
    DMB_CHANNEL_KINETIC_ENERGY = 14, /* [J] of the pipe or body */
    DMB_CHANNEL_NORMAL_FORCE = 15,   /* [N] at the pipe's far end, or of the body */
    DMB_CHANNEL_DRIVE_FORCE = 16,    /* [N, N m] place.part is a drive */
    DMB_CHANNEL_DRIVE_SPEED = 17,    /* [m/s, rad/s] place.part is a drive */
    DMB_CHANNEL_BIT_WEIGHT = 18,     /* [N] place.part is a bit, bottom-hole load included */
    DMB_CHANNEL_ENERGY_ERROR = 19,   /* [-] of the ledger; place is ignored */
    DMB_CHANNEL_COUNT = 20
};
typedef struct dmb_channel {
    dmb_place place;
    int32_t quantity; /* DMB_CHANNEL_... */
    int32_t reserved; /* 0 */
} dmb_channel;

typedef struct dmb_recorder {
    uint32_t struct_size;
    uint32_t channel_count;      /* [-] 1 .. 4096 */
    const dmb_channel *channels; /* shape (channel_count); the caller's, kept alive by it */
    double *table;               /* shape (capacity, 1 + channel_count); the caller's */
    uint64_t capacity;           /* [-] rows of table */
    uint64_t row_count;          /* [-] rows written; start with 0 */
    double interval;             /* [s] between samples, 0: every call */
} dmb_recorder;
DMB_SIZED_STRUCT(dmb_recorder)
/* Writes a row if its time has come. DMB_NOTE_FULL when the table has no room. O(channels). */
DMB_API int32_t dmb_recorder_take(dmb_recorder *recorder, const dmb_sim *sim);
/* Writes the table as CSV (comma, '.', a header line of names [units], 17 digits, nan). DMB_ERR_IO on failure: this and
 * all that write files write beside path (path.part0) and rename, so that the old file stays, unless path is a
 * device. */
DMB_API int32_t dmb_recorder_write_csv(const dmb_recorder *recorder, const char *path);
/* VTK XML poly-data for ParaView: the strings as lines with fields (displacement, velocity, diameter, axial force,
 * torque, bending moment, normal force), `per_element` points an element (1 .. 64). DMB_ERR_IO on failure. */
DMB_API int32_t dmb_write_vtk_strings(const dmb_sim *sim, uint32_t per_element, const char *path);
/* The hole as a tube of `around` facets (3 .. 360) with a ring each `spacing` [m] from depth0 to depth1 [m]. */
DMB_API int32_t dmb_write_vtk_hole(const dmb_model *model, double depth0, double depth1, double spacing,
                                   uint32_t around, const char *path);

#ifdef __cplusplus
}
#endif
#endif
