/* How the force of a contact site changes with its motion, in a finished configuration. */
#ifndef DMB_SYSTEM_CONTACT_SLOPE_H
#define DMB_SYSTEM_CONTACT_SLOPE_H

#include "system/evaluation.h"

typedef struct dmb_contact_slope {
    double normal_by_depth;       /* [N/m] 0 of an open site, and of PATH sites, whose force is that of their tension */
    double normal_by_rate;        /* [N s/m] */
    double friction_by_slip[4];   /* [N s/m] shape (2, 2) */
    double friction_by_normal[2]; /* [-] shape (2) */
} dmb_contact_slope;

/* site: counted as dmb_query_contact does. Friction without memory only: of bristles what they are once they slide. */
void dmb_contact_slope_of(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t site,
                          dmb_contact_slope *out);
/* Of a ring of a FULL node in the trial just evaluated: normal n and, for a unit of normal force, what friction adds to the
 * side of the forces that balance the wall, f = -(F_t j_t + F_b j_b) with its moment about the node, both in body axes.
 * 0: it does not touch or not slip. */
int dmb_contact_friction_by_normal(const dmb_evaluation *evaluation, uint32_t site, double n[3], double f[6]);
/* Node of a site. */
uint32_t dmb_contact_node(const dmb_scene *scene, uint32_t site);

#endif
