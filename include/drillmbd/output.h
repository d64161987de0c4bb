/* libdrillmbd - outputs of a running sim: named numbers beyond those of query.h, among them the readings of a
 * driller; a moving window over outputs; profiles at a coarser rate. */
#ifndef DRILLMBD_OUTPUT_H
#define DRILLMBD_OUTPUT_H

#include "query.h"

DMB_C_BEGIN

/* ---- Outputs ----------------------------------------------------------------------------------------------------
 * Numbers of dmb_output.quantity that continue those of query.h. Where six follow each other, the number is the one
 * given plus DMB_X .. DMB_RZ. Each is the result of the query it is named after. Numbers 500 .. 999 and from 3000 on
 * are kept free. A stretch of numbers may grow at its end. */
enum {
    /* Readings of a driller; place.part is a string, {0, 0}: the model's first. O(pipes) of stretch and wind-up. */
    DMB_OUTPUT_HOOK_LOAD = 100,           /* [N] effective axial force of the section at the rig end, as
                                              dmb_query_section: > 0 the rig pulls, < 0 it thrusts */
    DMB_OUTPUT_ROTATION_TORQUE = 101,     /* [N m] that the rig puts into that section, > 0 along the string's x axis */
    DMB_OUTPUT_WEIGHT_ON_BIT = 102,       /* [N] of all bits on the string: rock law and bottom-hole load */
    DMB_OUTPUT_TORQUE_ON_BIT = 103,       /* [N m] of all bits on the string: rock law, against the rotation */
    DMB_OUTPUT_RATE_OF_PENETRATION = 104, /* [m/s] of the string's first bit along the hole, > 0 into it; with a rock
                                              law 0 while it is off bottom. The rate of dmb_bit_state.advance */
    DMB_OUTPUT_BIT_SPEED = 105,           /* [rad/s] about its axis, of the string's far end */
    DMB_OUTPUT_BIT_DEPTH = 106,           /* [m] measured depth of the string's far end; 0 without a hole */
    DMB_OUTPUT_ROTARY_SPEED = 107,        /* [rad/s] about its axis, of the string's rig end */
    DMB_OUTPUT_FEED_SPEED = 108,          /* [m/s] along its axis, of the string's rig end, > 0 into the hole */
    DMB_OUTPUT_STRETCH = 109,    /* [m] elastic, > 0 longer: sum of the axial strain over the flexible lengths */
    DMB_OUTPUT_WIND_UP = 110,    /* [rad] elastic, of the rig end against the far end: less the sum of the twist */
    DMB_OUTPUT_OFF_BOTTOM = 111, /* [-] 1: no bit of the string with a rock law is on the bottom, else 0; its mean over
                                     a window is the off-bottom share */
    DMB_OUTPUT_RIG_FORCE = 112,  /* [N] that support and drives pull the rig end with: hook load, and of the end itself
                                     inertia, weight, friction; 0 where a joint holds it */
    DMB_OUTPUT_RIG_TORQUE = 113, /* [N m] by support and drives, > 0 along the string's x axis */

    /* place.part a bit: dmb_query_bit */
    DMB_OUTPUT_BIT_ADVANCE = 120,      /* [m] */
    DMB_OUTPUT_BIT_BOTTOM = 121,       /* [m] */
    DMB_OUTPUT_BIT_DEPTH_OF_CUT = 122, /* [m] */
    DMB_OUTPUT_BIT_ROCK_WEIGHT = 123,  /* [N] of the rock law alone */
    DMB_OUTPUT_BIT_TORQUE = 124,       /* [N m] */
    DMB_OUTPUT_BIT_LOAD = 125,         /* [N] */
    DMB_OUTPUT_BIT_ON_BOTTOM = 126,    /* [-] 1 or 0 */

    /* place.part a stuck place: dmb_query_stuck */
    DMB_OUTPUT_STUCK = 127,        /* [-] 1 or 0 */
    DMB_OUTPUT_STUCK_FORCE = 128,  /* [N] axial */
    DMB_OUTPUT_STUCK_TORQUE = 129, /* [N m] */

    /* place.part a drive: dmb_query_drive */
    DMB_OUTPUT_DRIVE_TARGET = 130,   /* [unit of the time function] */
    DMB_OUTPUT_DRIVE_POSITION = 131, /* [m, rad] */
    DMB_OUTPUT_DRIVE_POWER = 132,    /* [W] */
    DMB_OUTPUT_DRIVE_WORK = 133,     /* [J] */
    DMB_OUTPUT_DRIVE_COMMAND = 134,  /* [N, N m] */
    DMB_OUTPUT_DRIVE_MADE = 135,     /* [N, N m] */

    /* place.pipe the number of a contact point: dmb_query_contact */
    DMB_OUTPUT_CONTACT_GAP = 140,             /* [m] */
    DMB_OUTPUT_CONTACT_NORMAL_FORCE = 141,    /* [N] */
    DMB_OUTPUT_CONTACT_APPROACH = 142,        /* [m/s] */
    DMB_OUTPUT_CONTACT_FRICTION_AXIAL = 143,  /* [N] */
    DMB_OUTPUT_CONTACT_FRICTION_AROUND = 144, /* [N] */
    DMB_OUTPUT_CONTACT_SLIP_AXIAL = 145,      /* [m/s] */
    DMB_OUTPUT_CONTACT_SLIP_AROUND = 146,     /* [m/s] */
    DMB_OUTPUT_CONTACT_CLOSED = 147,          /* [-] 1 or 0 */
    DMB_OUTPUT_CONTACT_STICKS = 148,          /* [-] 1 or 0 */
    /* place is ignored from here to the statistics; dmb_query_contact_total, O(contact points) */
    DMB_OUTPUT_CONTACTS_CLOSED = 150,          /* [-] */
    DMB_OUTPUT_CONTACTS_NORMAL_FORCE = 151,    /* [N] */
    DMB_OUTPUT_CONTACTS_FRICTION_AXIAL = 152,  /* [N] */
    DMB_OUTPUT_CONTACTS_FRICTION_AROUND = 153, /* [N] */
    DMB_OUTPUT_CONTACTS_DEEPEST = 154,         /* [m] */

    DMB_OUTPUT_ENERGY_KINETIC = 160, /* [J] dmb_query_energy, O(nodes) */
    DMB_OUTPUT_ENERGY_STRAIN = 161,
    DMB_OUTPUT_ENERGY_GRAVITY = 162,
    DMB_OUTPUT_ENERGY_CONTACT = 163,
    DMB_OUTPUT_ENERGY_DRIVES = 164,
    DMB_OUTPUT_ENERGY_LOADS = 165,
    DMB_OUTPUT_ENERGY_FRICTION = 166,
    DMB_OUTPUT_ENERGY_IMPACT = 167,
    DMB_OUTPUT_ENERGY_DAMPING = 168,
    DMB_OUTPUT_ENERGY_ROCK = 169,
    DMB_OUTPUT_ENERGY_SCHEME = 170,
    DMB_OUTPUT_ENERGY_INPUT = 171,
    DMB_OUTPUT_ENERGY_BALANCE = 172,
    DMB_OUTPUT_ENERGY_UNEXPLAINED = 173,

    DMB_OUTPUT_MOMENTUM_X = 180, /* [kg m/s] world, 180 .. 182: dmb_query_momentum, O(nodes) */
    DMB_OUTPUT_MOMENTUM_Y = 181,
    DMB_OUTPUT_MOMENTUM_Z = 182,
    DMB_OUTPUT_ANGULAR_MOMENTUM_X = 183, /* [kg m2/s] world, 183 .. 185 */
    DMB_OUTPUT_ANGULAR_MOMENTUM_Y = 184,
    DMB_OUTPUT_ANGULAR_MOMENTUM_Z = 185,
    DMB_OUTPUT_MASS = 186,     /* [kg] */
    DMB_OUTPUT_CENTRE_X = 187, /* [m] of mass, world, 187 .. 189 */
    DMB_OUTPUT_CENTRE_Y = 188,
    DMB_OUTPUT_CENTRE_Z = 189,

    DMB_OUTPUT_STEPS = 200, /* [-] dmb_query_statistics, O(joints) */
    DMB_OUTPUT_REJECTED = 201,
    DMB_OUTPUT_ITERATIONS = 202,
    DMB_OUTPUT_LIMITED_STEPS = 203,
    DMB_OUTPUT_MOST_ITERATIONS = 204,
    DMB_OUTPUT_LARGEST_RESIDUAL = 205,
    DMB_OUTPUT_SWITCHES = 206,
    DMB_OUTPUT_DEPENDENT = 207,
    DMB_OUTPUT_REDUNDANT = 208,
    DMB_OUTPUT_VIOLATION = 209, /* [m, -] of all joints */

    /* place.part a spring: dmb_query_spring */
    DMB_OUTPUT_SPRING_LENGTH = 220,     /* [m] */
    DMB_OUTPUT_SPRING_ELONGATION = 221, /* [m] */
    DMB_OUTPUT_SPRING_SPEED = 222,      /* [m/s] */
    DMB_OUTPUT_SPRING_FORCE = 223,      /* [N] tension > 0, sum of the next two */
    DMB_OUTPUT_SPRING_ELASTIC = 224,    /* [N] */
    DMB_OUTPUT_SPRING_DAMPER = 225,     /* [N] */
    DMB_OUTPUT_SPRING_ENERGY = 226,     /* [J] */

    /* place.part an input: dmb_sim_get_input */
    DMB_OUTPUT_INPUT_PRESENT = 230, /* [unit of the input] in force now */
    DMB_OUTPUT_INPUT_RATE = 231,    /* [unit of the input/s] of that */
    DMB_OUTPUT_INPUT_VALUE = 232,   /* [unit of the input] set point */

    /* place.part a joint: dmb_query_joint; six each but for the last three */
    DMB_OUTPUT_JOINT_POSITION = 300,      /* [m, rad] */
    DMB_OUTPUT_JOINT_SPEED = 310,         /* [m/s, rad/s] */
    DMB_OUTPUT_JOINT_ACCELERATION = 320,  /* [m/s2, rad/s2] */
    DMB_OUTPUT_JOINT_REACTION = 330,      /* [N, N m] world */
    DMB_OUTPUT_JOINT_REACTION_BODY = 340, /* [N, N m] frame b */
    DMB_OUTPUT_JOINT_ACTION = 350,        /* [N, N m] */
    DMB_OUTPUT_JOINT_VIOLATION = 360,     /* [m, -] */
    DMB_OUTPUT_JOINT_STATE = 361,         /* [-] DMB_JOINT_... */
    DMB_OUTPUT_JOINT_ROWS = 362,          /* [-] */
    DMB_OUTPUT_MULTIPLIER = 370, /* [N, ...] number 0 .. 5 of a joint, coupling, constraint or joint drive; six */
    DMB_OUTPUT_REACTION = 380,   /* [N, N m] of a string or body: dmb_query_reaction; six */

    /* any place; six each */
    DMB_OUTPUT_SECTION_FORCE = 400,      /* [N, N m] dmb_query_section */
    DMB_OUTPUT_SECTION_STRAIN = 410,     /* [-, rad/m] */
    DMB_OUTPUT_WORLD_VELOCITY = 420,     /* [m/s, rad/s] dmb_query_motion */
    DMB_OUTPUT_WORLD_ACCELERATION = 430, /* [m/s2, rad/s2] */
    DMB_OUTPUT_BODY_VELOCITY = 440,      /* [m/s, rad/s] */
    DMB_OUTPUT_BODY_ACCELERATION = 450,  /* [m/s2, rad/s2] */

    DMB_OUTPUT_PROFILE = 1000, /* + DMB_PROFILE_...: at a place of a string; as dmb_query_profile, NaN included */

    /* of a window, place.pipe the number of the watched output; in recorders with a window only */
    DMB_OUTPUT_WINDOW_MINIMUM = 2000,
    DMB_OUTPUT_WINDOW_MAXIMUM = 2001,
    DMB_OUTPUT_WINDOW_MEAN = 2002,
    DMB_OUTPUT_WINDOW_RMS = 2003,
    DMB_OUTPUT_STICK_SLIP_INDEX = 2004,
    DMB_OUTPUT_WINDOW_LOW_SHARE = 2005
};

/* [unit of the output] The present value. Errors: those of the query behind it, DMB_ERR_VALUE for an unknown quantity
 * or a multiplier that is not there, DMB_ERR_UNSUPPORTED for a string without the part it needs (a bit, a rock law, a
 * flexible first pipe) and for outputs of a window. */
DMB_API int32_t dmb_query_output(const dmb_sim *sim, const dmb_output *output, double *value);
/* "bit_speed", and its unit in *unit (may be NULL); NULL for a number that is none. Names do not change. */
DMB_API const char *dmb_output_name(int32_t quantity, const char **unit);
/* The number of a name; DMB_ERR_VALUE where it is none. */
DMB_API int32_t dmb_output_quantity(const char *name, int32_t *quantity);
/* All numbers that have a name, ascending: the one after `quantity`, -1 before the first; -1 after the last. */
DMB_API int32_t dmb_output_next(int32_t quantity);
/* Whether this sim has each output; dmb_sim_message names the first that cannot, and a valid place.
 * Errors: as dmb_query_output. */
DMB_API int32_t dmb_output_check(dmb_sim *sim, const dmb_output *outputs, uint32_t output_count);

/* ---- A window over outputs --------------------------------------------------------------------------------------
 * Least, greatest and mean of outputs over the last so many seconds of a run, in memory that does not grow: time is
 * divided into slots, and the oldest slot is dropped as a whole. Means are by time, with straight lines between
 * samples. The stick-slip index of the bit speed and the off-bottom share are numbers of such windows. */
typedef struct dmb_window_options {
    uint32_t struct_size;
    uint32_t slots;       /* [-] 2 .. 65536; the window covers (slots - 1)/slots to all of `length`; default
                             100 */
    double length;        /* [s] >= 0; 0 (default): all since the first sample */
    const double *levels; /* [unit of the output] of low_share, shape (output_count), >= 0; NULL (default): 0 */
} dmb_window_options;
DMB_SIZED_STRUCT(dmb_window_options)

typedef struct dmb_window_result {
    uint32_t struct_size;
    uint32_t reserved;
    uint64_t samples; /* [-] in the window */
    double time;      /* [s] that it spans; 0 with one sample: means are the sample then */
    double minimum;   /* [unit of the output] of the samples; NaN, as all that follow, without one */
    double maximum;   /* [unit of the output] */
    double mean;      /* [unit of the output] over time */
    double rms;       /* [unit of the output] root of the mean of the squares over time */
    double index;     /* [-] (maximum - minimum)/(2 |mean|): of the bit speed the stick-slip index, 1 where the bit
                         comes to rest; 0 where nothing varies, infinite about a mean of 0 */
    double low_share; /* [-] of the time, |value| <= its level, by the sample at the end of each interval */
} dmb_window_result;
DMB_SIZED_STRUCT(dmb_window_result)

/* outputs, shape (output_count), 1 .. 4096, are copied. Memory from the model's allocator: 48 bytes a output and
 * slot. options may be NULL. Errors: those of dmb_output_check, DMB_ERR_VALUE, _NOT_FINITE, _NO_MEMORY; *window is
 * NULL then. */
DMB_API int32_t dmb_window_create(dmb_sim *sim, const dmb_window_options *options, const dmb_output *outputs,
                                  uint32_t output_count, dmb_window **window);
/* Takes a sample; call it after each step. A second one at the same time is ignored; DMB_ERR_ORDER for an
 * earlier time: dmb_window_reset. The sim may be another one of the same model. Allocates nothing. O(outputs). */
DMB_API int32_t dmb_window_take(dmb_window *window, const dmb_sim *sim);
/* O(slots). DMB_ERR_NULL, _HANDLE, _STRUCT_SIZE, _VALUE (no such output). */
DMB_API int32_t dmb_window_get(const dmb_window *window, uint32_t output, dmb_window_result *result);
/* Forgets all samples. */
DMB_API int32_t dmb_window_reset(dmb_window *window);
/* Sets *window to NULL. NULL-safe. */
DMB_API void dmb_window_destroy(dmb_window **window);

/* ---- Profiles over time ------------------------------------------------------------------------------------------
 * Rows of whole profiles, at a coarser rate, in the caller's memory. */
typedef struct dmb_profile_recorder {
    uint32_t struct_size;
    uint32_t reserved;
    const dmb_profile *profile; /* quantities of a row; its `values` and strides are ignored. The caller's, kept
                                   alive by it and not changed once there is a row */
    double *table;      /* the caller's: time [s], then quantity q at station i at 1 + i quantity_count + q; shape
                           (capacity, 1 + station_count quantity_count) */
    uint64_t capacity;  /* [-] rows of table */
    uint64_t row_count; /* [-] rows written; start with 0 */
    double interval;    /* [s] between rows, 0: every call */
} dmb_profile_recorder;
DMB_SIZED_STRUCT(dmb_profile_recorder)
/* Writes a row if its time has come. DMB_NOTE_FULL when the table has no room; errors of dmb_query_profile;
 * DMB_ERR_ORDER before the time of the last row, as after a restore: set row_count to the number of rows to keep. */
DMB_API int32_t dmb_profile_recorder_take(dmb_profile_recorder *recorder, const dmb_sim *sim);
/* CSV, a line for each row and station: time [s], station, then the quantities with their units. DMB_ERR_IO. */
DMB_API int32_t dmb_profile_recorder_write_csv(const dmb_profile_recorder *recorder, const char *path);

DMB_C_END
#endif
