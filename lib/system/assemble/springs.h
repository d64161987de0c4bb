/* Springs and dampers between two points.
 *
 *     d = x_b - x_a,  l = sqrt(|d|^2 + 1e-18 m2),  n = d/l,  l' = n . (R_b v_b - R_a v_a)
 *
 * tension t(l - l0, l') pulls with -t n on b and t n on a; the elastic part is the gradient of E(l - l0). */
#ifndef DMB_SYSTEM_ASSEMBLE_SPRINGS_H
#define DMB_SYSTEM_ASSEMBLE_SPRINGS_H

#include "system/assemble/point_motion.h"

typedef struct dmb_spring_motion {
    dmb_point_motion a, b;
    double n[3];         /* [-] from a to b, world; shorter than 1 only where the points nearly meet */
    double length, rate; /* [m], [m/s] */
    dmb_spring_force force;
} dmb_spring_motion;

/* rates 0: as in statics */
void dmb_spring_motion_of(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t spring, int rates,
                          dmb_spring_motion *motion);
/* Without those of constraints' tangents these are cleared before. */
void dmb_gather_springs(dmb_evaluation *evaluation);
/* [J] stored in all springs */
double dmb_springs_energy(const dmb_scene *scene, const dmb_configuration *configuration);

#endif
