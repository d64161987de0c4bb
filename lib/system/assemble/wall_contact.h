/* Contact sites at the wall of the hole: their forces in the residual, and how a force changes with the motion of its
 * site. */
#ifndef DMB_SYSTEM_ASSEMBLE_WALL_CONTACT_H
#define DMB_SYSTEM_ASSEMBLE_WALL_CONTACT_H

#include "kernel/kernels.h"
#include "sim/sim.h"
#include "system/assemble/evaluation.h"
#include "system/assemble/point_motion.h"

typedef struct dmb_contact_slope {
    double normal_by_depth;       /* [N/m] 0 of an open site, and of PATH sites, whose force is that of their tension */
    double normal_by_rate;        /* [N s/m] */
    double friction_by_slip[4];   /* [N s/m] shape (2, 2) */
    double friction_by_normal[2]; /* [-] shape (2) */
} dmb_contact_slope;

/* site: counted as dmb_query_contact does. Friction without memory only: of bristles what they are once they slide. */
void dmb_contact_slope_of(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t site,
                          dmb_contact_slope *out);
/* Of a ring of a FULL node in the trial just evaluated: normal n and, for a unit of normal force, what friction adds to
 * the side of the forces that balance the wall, f = -(F_t j_t + F_b j_b) with its moment about the node, both in body
 * axes. 0: it does not touch or not slip. */
int dmb_contact_friction_by_normal(const dmb_evaluation *evaluation, uint32_t site, double n[3], double f[6]);
/* Law of friction at a site, counted likewise: that of the scene, or `local` with the coefficients of a section. */
const dmb_friction_law *dmb_contact_friction_law(const dmb_scene *scene, const dmb_configuration *configuration,
                                                 uint32_t site, dmb_friction_law *local);
/* Node of a site. */
uint32_t dmb_contact_node(const dmb_scene *scene, uint32_t site);

/* Rings on FULL nodes against the wall of the hole: normal and friction force in the contact frame
 * (n outward from the axis, t along the axis, b = t x n). */

typedef struct dmb_site_force {
    double normal[3];    /* [-] world */
    double tangent[3];   /* [-] world, along the axis */
    double penetration;  /* [m] */
    double rate;         /* [m/s] of penetration */
    double normal_force; /* [N] >= 0 */
    double along;        /* [N] on the ring along t, where radius or stiffness of the wall change */
    double friction[2];  /* [N] on the ring along t and b */
    double slip[2];      /* [m/s] along t and b */
    int32_t closed, sticks;
} dmb_site_force;

/* Force of one site in a finished configuration (bristles as they are). */
void dmb_site_force_of(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t site,
                       dmb_site_force *out);
/* The same for a PATH site; normal_force by Johancsik. */
void dmb_path_site_force_of(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t path_site,
                            dmb_site_force *out);

/* Friction of a finished state under the normal force and at the slip in `out`: bristles as they are (NULL where the
 * law has none), smooth laws by speed. */
void dmb_finished_friction(const dmb_friction_law *law, const double *bristle, int32_t sticks, dmb_site_force *out);
/* The law of bristles in steady sliding, F = -mu N v/|v|, without a memory. */
dmb_friction_law dmb_sliding_law(const dmb_friction_law *law);
/* Friction of a site of this radius in a static state that assumed a slip, in place of that of the speeds: by the
 * smooth law under the normal force in `out`, as its equilibrium took it. Nothing where none was assumed. */
void dmb_assumed_friction(const dmb_friction_law *law, const dmb_configuration *configuration, double radius,
                          dmb_site_force *out);

/* Memory of contacts in the configurations: normals and depths of now at the start; the slip that friction of the trial
 * acts as at, by the evaluation, and that of the trial into now; no bristle of the trial is deflected and no contact
 * has begun; bristles of now are where they are while their rings slide on as they do. */
void dmb_contacts_start(dmb_sim *sim);
void dmb_contacts_assume_slip(const dmb_evaluation *evaluation);
void dmb_contacts_take_slip(dmb_sim *sim);
void dmb_contacts_forget(dmb_sim *sim);
void dmb_contacts_slide(dmb_sim *sim);

void dmb_gather_contacts(dmb_evaluation *evaluation);
void dmb_gather_path_friction(dmb_evaluation *evaluation);

/* Rings inside elements: contact along the element, at integration points of its own interpolation. They are the last
 * of the sites. */

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
