/* Contact points inside elements in runs, by the kernels (kernel/lanes_wall_inside.h, eq:contact.inside). Most points
 * of a long pipe cannot reach the wall within a step. Such a point is not evaluated in the iterations: it keeps
 * penetration and normal of the start and is evaluated once, at acceptance (dmb_contacts_accept). The bound on its way
 * is a sum of the largest displacements that the increments of both nodes allow (reach_of). */
#include "system/assemble/assemble.h"

#include <string.h>

#include "element/beam_math.h"
#include "kernel/kernels.h"
#include "math/so3.h"

static dmb_inside_args inside_of(const dmb_evaluation *evaluation)
{
    enum { STRIDE = sizeof(dmb_scene_point) / sizeof(double) };
    const dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    const dmb_inside_args inside = {
        .fraction = &scene->inside->fraction,
        .stride = STRIDE,
        .inertia_only = evaluation->inertia_only,
        .types = scene->types,
        .element_type = scene->element_type,
        .node_element = scene->node_element,
        .span = scene->element_span,
        .now_displacement = sim->now.displacement,
        .increment = sim->increment,
        .link = scene->layout.link,
        .upper = sim->stiffness_upper,
        .lower = sim->stiffness_lower,
    };
    return inside;
}

/* Forces of the contact points from `first` to before `end`, added to the sums given. */
static void press_run(const dmb_evaluation *evaluation, uint32_t first, uint32_t end, dmb_wall_args *sums)
{
    const dmb_scene *scene = evaluation->sim->scene;
    dmb_wall_args args = *sums;
    dmb_inside_args inside = inside_of(evaluation);
    args.count = end - first;
    args.sites += first;
    dmb_wall_args_skip(&args, first);
    inside.fraction += (size_t)inside.stride * (first - dmb_node_sites(scene));
    scene->kernels->walls_inside(&args, &inside);
    sums->rounding = args.rounding;
    sums->potential = args.potential;
    sums->impact = args.impact;
    sums->friction = args.friction;
}

/* [m] Largest distance of a section from the line through the ends. */
static double sag_of(const dmb_sim *sim, const dmb_element_type *type, uint32_t element)
{
    const double *d = sim->element_strain + 6 * (size_t)element;
    double sag = 0.0;
    for (int i = 1; i < 3; i++)
        sag += fabs(d[i]) + fabs(type->rest[i]) + type->length * (fabs(d[3 + i]) + fabs(type->rest[3 + i]));
    return sag;
}

/* [m] Largest displacement of a section in the step: with the nodes, by their rotation across the axis, and about the
 * line through them by their rotation about it. */
static double reach_of(const dmb_sim *sim, const dmb_scene_point *point)
{
    const double *a = sim->increment + sim->scene->layout.row[point->node];
    const double *b = sim->increment + sim->scene->layout.row[point->node + 1];
    const dmb_element_type *type = sim->scene->types + sim->scene->element_type[point->element];
    const double length = type->length + fabs(type->arm[0]) + fabs(type->arm[1]);
    const double across = fabs(a[4]) + fabs(a[5]) + fabs(b[4]) + fabs(b[5]), about = fabs(a[3]) + fabs(b[3]);
    return dmb_vec3_norm(a) + dmb_vec3_norm(b) + length * across + sag_of(sim, type, point->element) * about;
}

/* 1: the contact point cannot touch within the step. Its distance from the axis of the hole changes by no more than its
 * displacement; not used in holes whose wall has sections. */
static int stays_open(const dmb_evaluation *evaluation, const dmb_scene_point *point, uint32_t s)
{
    const dmb_sim *sim = evaluation->sim;
    if (!evaluation->dynamic || !(evaluation->step > 0.0) || sim->scene->hole.pieces > 0) return 0;
    return sim->now.site_penetration[s] + 2.0 * reach_of(sim, point) < 0.0;
}

static void keep_open(dmb_sim *sim, uint32_t s)
{
    sim->trial.site_penetration[s] = sim->now.site_penetration[s];
    dmb_vec3_copy(sim->now.site_normal + 3 * (size_t)s, sim->trial.site_normal + 3 * (size_t)s);
}

/* Neighbouring points that are due form runs, which the kernels compute in lanes. */
void dmb_assemble_contacts_inside(dmb_evaluation *evaluation, int waiting, dmb_wall_args *args)
{
    const dmb_scene *scene = evaluation->sim->scene;
    uint32_t first = dmb_node_sites(scene);
    for (uint32_t s = first; s < scene->site_count; s++) {
        const int waits = stays_open(evaluation, dmb_inside_point(scene, s), s);
        if (waits && !waiting) keep_open(evaluation->sim, s);
        if (waits == waiting) continue;
        if (first < s) press_run(evaluation, first, s, args);
        first = s + 1;
    }
    if (first < scene->site_count) press_run(evaluation, first, scene->site_count, args);
}

/* Axes of a contact point in which its force is: of its node, or of its section (eq:beam.section-pose). */
void dmb_site_axes(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t s, double R[9])
{
    if (!dmb_is_inside(scene, s)) {
        dmb_quat_to_matrix(configuration->quaternion + 4 * (size_t)scene->sites[s].node, R);
        return;
    }
    dmb_point_motion motion;
    dmb_point_motion_of(scene, configuration, dmb_inside_point(scene, s), &motion);
    memcpy(R, motion.R, sizeof motion.R);
}

/* The wrench at the point becomes map^T w on the nodes, with equal power; on a node the map is the shift by the offset.
 */
void dmb_site_add_wrench(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t s, double factor,
                         const double w[6], double *rows)
{
    const dmb_site *site = scene->sites + s;
    double f[6];
    if (!dmb_is_inside(scene, s)) {
        dmb_vec6_copy(w, f);
        dmb_arm_wrench(site->offset, f);
        for (uint32_t i = 0; i < 6; i++) rows[scene->layout.row[site->node] + i] += factor * f[i];
        return;
    }
    dmb_point_motion motion;
    dmb_point_motion_of(scene, configuration, dmb_inside_point(scene, s), &motion);
    for (uint32_t k = 0; k < 12; k++) {
        double sum = 0.0;
        for (uint32_t i = 0; i < 6; i++) sum += motion.map[12 * i + k] * w[i];
        rows[scene->layout.row[motion.node[k / 6]] + k % 6] += factor * sum;
    }
}
