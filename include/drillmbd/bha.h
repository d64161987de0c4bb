/* libdrillmbd - bottom-hole assembly: stuck places of a string, mud motors, bodies in the middle of a string. */
#ifndef DRILLMBD_BHA_H
#define DRILLMBD_BHA_H

#include "control.h"
#include "joints.h"

DMB_C_BEGIN

/* A place that can be stuck in the hole: a jammed bit, tool joint, key seat. While it is stuck, springs and dampers
 * hold it at the pose where it got stuck, in the axes that its section had there: k s + c s', s along the axis, about
 * it, and sideways. It is released at the time at which the axial force reaches `overpull` or the torque
 * `overtorque` (found within 1e-10 of it by shorter steps; with bounded work at the end of the step); the energy of the
 * springs is then lost (`impact` of the energies). While it is not stuck it costs one check a step. It connects no
 * parts. Stuck or not is part of snapshots and hashes. An input of target DMB_TARGET_STUCK (control.h) sets it, 0 or 1;
 * it is 0 again once the place was released by overpull. */
enum { DMB_STUCK_AXIAL = 1, DMB_STUCK_ROTATION = 2, DMB_STUCK_LATERAL = 4 };
typedef struct dmb_stuck_def {
    uint32_t struct_size;
    int32_t holds;   /* mask of DMB_STUCK_...; default AXIAL and ROTATION */
    char name[24];   /* for messages, ends with 0; default "" */
    dmb_place place; /* of a pipe, or a body or bit; required */
    int32_t stuck;   /* 1: from time 0 on, in the pose there (default); 0: not yet */
    int32_t reserved;
    double stiffness[3]; /* [N/m, N m/rad, N/m] along the axis, about it, sideways, > 0; default 1e9, 1e8, 1e9 */
    double damping[3];   /* [N s/m, N m s, N s/m] >= 0; not there without DMB_FEATURE_DAMPING; default 0 */
    double overpull;     /* [N] axial force, pull or push, at which it is released, > 0; default 0: never */
    double overtorque;   /* [N m] torque, either way, > 0, at most stiffness[1] times 1 rad; default 0: at 1 rad */
} dmb_stuck_def;
DMB_SIZED_STRUCT(dmb_stuck_def)
/* Errors: DMB_ERR_ID, _VALUE, _NOT_FINITE; of compile: _VALUE (no such pipe), _UNSUPPORTED (axial-torsional). */
DMB_API int32_t dmb_model_add_stuck(dmb_model *model, const dmb_stuck_def *def, dmb_id *stuck);

typedef struct dmb_stuck_state {
    uint32_t struct_size;
    int32_t stuck;    /* 1: held */
    double offset[4]; /* [m, m, m, rad] from where it got stuck: along, sideways y and z, turned; 0 where it is not */
    double force[4];  /* [N, N, N, N m] that holds it, on the string, in the same order */
    double share;     /* [-] largest of |axial force|/overpull and |torque|/overtorque; it is released at 1 */
    double energy;    /* [J] stored in the springs */
} dmb_stuck_state;
DMB_SIZED_STRUCT(dmb_stuck_state)
DMB_API int32_t dmb_query_stuck(const dmb_sim *sim, dmb_id stuck, dmb_stuck_state *state);

/* A mud motor between two sections of a string is a drive on a revolute joint between them (place_a at the far end of
 * the section above, place_b at the rig end of the one below): its torque T of the relative speed w acts on both
 * sections, equal and opposite, and its power is that of a drive.
 *   A line:  T = stall_torque (1 - w/w0), w0 = 2 pi flow/displacement; stall_torque as given, or by `pressure` as
 *            efficiency displacement pressure/(2 pi) (Tiraspolsky, Hydraulic downhole drilling motors, 1985).
 *   A table: T(w) as measured at table_flow and table_pressure, straight between its points; speeds times
 *            flow/table_flow, torques times pressure/table_pressure, by the same laws; w0 is its last speed.
 * Below w = 0 it gives its torque at stall. */
typedef struct dmb_motor {
    uint32_t struct_size;
    int32_t brakes; /* 1: beyond w0 it holds back along the same line, as a pump; 0 (default): it runs free there */
    double stall_torque;   /* [N m] at w = 0, and the most it gives, > 0 */
    double displacement;   /* [m3] of mud a revolution, > 0 */
    double flow;           /* [m3/s] through the motor, > 0 */
    double pressure;       /* [Pa] drop across it at stall, > 0 instead of stall_torque, which is 0 then; with a table
                              > 0 or 0: table_pressure */
    double efficiency;     /* [-] of pressure to torque, > 0, <= 1; default 1; of a line by pressure only */
    double table_flow;     /* [m3/s] of the table, > 0; 0 (default): flow */
    double table_pressure; /* [Pa] of the table, > 0; 0 (default): pressure */
    uint32_t table_count;  /* [-] 0 (default): a line, or 2 .. 15 points in its place; stall_torque and displacement are
                              0  then */
    uint32_t reserved;
    double table_speed[15];  /* [rad/s] strictly increasing from 0, shape (table_count) */
    double table_torque[15]; /* [N m] >= 0, > 0 at the first, 0 at the last, shape (table_count) */
} dmb_motor;
DMB_SIZED_STRUCT(dmb_motor)
/* Fills the fields of the drive for this motor (kind CONTROL, component RX, gain or its table, limits, mud_pressure: 2
 * pi over efficiency and displacement, or of a table with pressures the pressure over the torque at stall, else
 * w0/flow; part, time function and name stay) and returns w0 [rad/s], the constant value of its time function. Another
 * flow while it runs: an input of the set point w0, which is in proportion to it; the torque by w0 - w, the leakage
 * past the rotor, stays then (a positive displacement motor; Tiraspolsky). Errors: DMB_ERR_NULL, _STRUCT_SIZE, _VALUE,
 * _NOT_FINITE; nothing is written then.
 */
DMB_API int32_t dmb_motor_drive(const dmb_motor *motor, dmb_drive_def *drive, double *no_load_speed);

/* A sub: a body in the middle of a string (stabiliser, motor, jar, sensor), and the section of pipes that continues
 * the string after it. The body's reference point and axes are those of the far end of the string as it is described so
 * far; the section begins `length` further along the body's x axis; both move with the string at time 0. Along a hole
 * their frames are the hole's. The structs that are pointed to count but for poses, velocities, attach, follows_hole,
 * start_depth, offset, start_free (all free) and places of joints; frames a of joints are in the axes of the string's
 * end, and of the section's rig end. */
typedef struct dmb_sub_def {
    uint32_t struct_size;
    uint32_t reserved;
    dmb_id string;                 /* with its pipes so far, end_free DMB_FREE_ALL; {0, 0}: the model's first */
    double length;                 /* [m] >= 0; default 0 */
    const dmb_body_def *body;      /* NULL (default): a body by default */
    const dmb_joint_def *before;   /* string to body; NULL (default): fixed */
    const dmb_joint_def *after;    /* body to section; NULL (default): fixed */
    const dmb_string_def *section; /* its name and end_free; NULL (default): a string by default */
} dmb_sub_def;
DMB_SIZED_STRUCT(dmb_sub_def)
typedef struct dmb_sub {
    uint32_t struct_size;
    uint32_t reserved;
    dmb_id body, section, before, after; /* section: the string to add the next pipes to */
    dmb_place end;                       /* of the string, that `before` joins to the body */
} dmb_sub;
DMB_SIZED_STRUCT(dmb_sub)
/* All of it or nothing. The string is at its end then: dmb_model_add_pipes and _add_bit to it are DMB_ERR_ORDER, and so
 * is dmb_model_add_wall after a sub of a string that would follow the hole. Errors: DMB_ERR_NULL, _STRUCT_SIZE, _ID,
 * _VALUE, _ORDER (no pipes yet, a bit at the end, continued already), _GEOMETRY (survey), those of dmb_model_add_body,
 * _string and _joint. */
DMB_API int32_t dmb_model_add_sub(dmb_model *model, const dmb_sub_def *def, dmb_sub *sub);
/* Fills poses and velocities of a body, and of a section follows_hole, start_depth, offset and start_free too, as
 * dmb_model_add_sub has them, `length` beyond the end of the string as it is described so far; for parts that other
 * joints hold there. Either may be NULL. Errors: as above. */
DMB_API int32_t dmb_model_place_at_end(dmb_model *model, dmb_id string, double length, dmb_body_def *body,
                                       dmb_string_def *section);

DMB_C_END
#endif
