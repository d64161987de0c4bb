/* Rings inside elements: contact along the element, at integration points of its own interpolation. They are the last
 * of the sites. */
#ifndef DMB_SYSTEM_ASSEMBLE_WALL_CONTACT_INSIDE_H
#define DMB_SYSTEM_ASSEMBLE_WALL_CONTACT_INSIDE_H

#include "kernel/kernels.h"
#include "system/assemble/point_motion.h"

/* Section that ring s is fixed to. */
static inline const dmb_scene_point *dmb_inside_point(const dmb_scene *scene, uint32_t s)
{
    return scene->inside + (s - dmb_node_sites(scene));
}

/* The force of all of them and its tangent. job: that of the rings on nodes, whose laws and sums serve here too. */
void dmb_gather_contacts_inside(dmb_evaluation *evaluation, dmb_wall_job *job);

/* Axes of the body that ring s is on, body to world. Any site. */
void dmb_site_axes(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t s, double R[9]);
/* rows += factor times the wrench w at the centre of ring s, in its body axes, on the rows of its nodes. Any site. */
void dmb_site_add_wrench(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t s, double factor,
                         const double w[6], double *rows);

#endif
