/* The six stages of one drilling cycle and what the rig head does in them. */
#ifndef RIG_CYCLE_H
#define RIG_CYCLE_H

#include <drillmbd/drillmbd.h>

enum { RIG_STAGES = 6 };

#define RIG_ROTATION_RPM 200.0 /* [1/min] */
#define RIG_FEED 10e-3         /* [m/s] into the hole */
#define RIG_BOTTOM_LOAD 2960.0 /* [N] on the bit, against the feed */
#define RIG_SHAKE 0.02         /* [-] of the rotation speed, once a revolution */

/* Stage i lasts from time[i] to time[i + 1]. The real cycle takes 40 s, the quick one 8 s. */
typedef struct rig_cycle {
    double time[RIG_STAGES + 1]; /* [s] */
} rig_cycle;

rig_cycle rig_cycle_full(void);
rig_cycle rig_cycle_quick(void);
const char *rig_stage_name(int stage);

/* Time functions of the cycle; the shake follows the rotation. */
int32_t rig_add_rotation(dmb_model *model, const rig_cycle *cycle, dmb_id *time_function);
int32_t rig_add_feed(dmb_model *model, const rig_cycle *cycle, dmb_id *time_function);
int32_t rig_add_bottom_load(dmb_model *model, const rig_cycle *cycle, dmb_id *time_function);
int32_t rig_add_shake(dmb_model *model, dmb_id rotation, dmb_id *time_function);

#endif
