/* Pressures of the mud inside and outside a string. */
#ifndef DMB_QUERY_MUD_PRESSURE_H
#define DMB_QUERY_MUD_PRESSURE_H

#include "sim/sim.h"

typedef struct dmb_mud_pressure {
    double outside, inside; /* [Pa] */
} dmb_mud_pressure;

/* 1: the pressures inside and outside differ. */
static inline int dmb_mud_is_apart(const dmb_scene *scene)
{
    return scene->flow_count > 0 || !(scene->inner_density < 0.0);
}

/* At a distance from the rig end of the string [m], x [m] in the world. At rest each mud stands up to the start of the
 * hole, or to the rig end as described without a hole. Where it flows the annulus has what it loses from here up to the
 * rig end in addition; inside it is the pressure outside at the far end, the loss there, and that on the way to it. */
dmb_mud_pressure dmb_mud_pressure_at(const dmb_sim *sim, uint32_t string, double distance, const double x[3]);

#endif
