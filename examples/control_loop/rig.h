/* The rig that is controlled: string, bit and rock, hydraulic rotation head and feed cylinder, and the sensors that a
 * control unit really has. */
#ifndef CONTROL_LOOP_RIG_H
#define CONTROL_LOOP_RIG_H

#include <drillmbd/drillmbd.h>

enum { SENSOR_DELAY = 20 }; /* [ms] from the sensor to the control unit */

/* One reading of each sensor. */
typedef struct readings {
    double pressure; /* [Pa] of the rotation head's hydraulics */
    double torque;   /* [N m] from the pressure */
    double speed;    /* [rad/s] of the head */
    double hook;     /* [N] that the rig end is pulled with, < 0: pushed */
    double feed;     /* [m] of the carriage */
} readings;

/* Set points and limits, each an input of the scene. */
typedef struct commands {
    double speed;        /* [rad/s] */
    double torque_limit; /* [N m] the pressure that is let through */
    double feed_speed;   /* [m/s] */
} commands;

typedef struct rig {
    dmb_model *model;
    dmb_sim *sim;
    dmb_id head, carriage, jam;
    dmb_id inputs[3]; /* in the order of `commands` */
    readings delayed[SENSOR_DELAY];
    uint32_t count; /* [-] readings so far */
} rig;

int32_t rig_create(rig *r, uint32_t pipes);
void rig_destroy(rig *r);
/* From now on the bit is held in the hole (1), until it is pulled free. */
int32_t rig_jam(rig *r);
/* The readings of SENSOR_DELAY cycles ago, with their noise. */
int32_t rig_measure(rig *r, readings *seen);
int32_t rig_command(rig *r, const commands *wanted);

#endif
