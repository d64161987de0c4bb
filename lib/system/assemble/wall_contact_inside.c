/* A ring inside an element is one on a node of its own for the wall, whose pose H and velocity V are those of the
 * section:
 *
 *     V = A(d) v,   residual r = A^T f,   f = -wrench(H, V)
 *     dr = (d A^T) f + A^T [f_H A + f_V dA v] dq + A^T f_V A dv
 *
 * with A the map of element/section_shape.h, v the velocities of both nodes, dq their body-frame displacements, and
 * f_H, f_V what force/contact_law.h gives for a node. */
#include "system/assemble/assemble.h"

#include <string.h>

#include "element/beam.h"
#include "math/mat6.h"
#include "math/so3.h"

/* The node that the section is taken for. */
typedef struct section_node {
    double displacement[3], quaternion[4], velocity[6];
    double now_quaternion[4], now_velocity[6];
    double residual[6], scale[6], stiffness[36], inertia[36];
    dmb_site site;
} section_node;

static void take_motion(const dmb_point_motion *motion, double quaternion[4], double velocity[6])
{
    dmb_quat_from_matrix(motion->R, quaternion);
    dmb_quat_normalize(quaternion);
    dmb_vec6_copy(motion->V, velocity);
}

/* The last accepted motion counts where the ring was open: it tells how fast the ring comes. */
static void take_node(const dmb_sim *sim, uint32_t s, const dmb_point_motion *motion, section_node *at)
{
    memset(at, 0, sizeof *at);
    dmb_vec3_copy(motion->x, at->displacement);
    take_motion(motion, at->quaternion, at->velocity);
    at->site = sim->scene->sites[s];
    at->site.node = 0;
    at->site.offset = 0.0;
    at->now_quaternion[0] = 1.0;
    if (sim->now.site_penetration[s] > 0.0) return;
    dmb_point_motion before;
    dmb_point_motion_of(sim->scene, &sim->now, motion->point, &before);
    take_motion(&before, at->now_quaternion, at->now_velocity);
}

static void shift_fields(dmb_site_fields *fields, uint32_t s, int32_t bristles)
{
    fields->normal += 3 * (size_t)s;
    fields->depth += s;
    fields->penetration += s;
    fields->impact_speed += s;
    fields->slip += 2 * (size_t)s;
    fields->segment += s;
    if (!bristles) return;
    fields->bristle += 2 * (size_t)s;
    fields->sticks += s;
}

/* ---- Tangent ----------------------------------------------------------------------------------------------------- */

/* out (12, 12) += A^T M B, A and B of shape (6, 12) */
static void add_products(const double A[72], const double M[36], const double B[72], double out[144])
{
    for (int i = 0; i < 6; i++) {
        double row[12] = {0.0};
        for (int j = 0; j < 6; j++)
            for (int k = 0; k < 12; k++) row[k] += M[6 * i + j] * B[12 * j + k];
        for (int r = 0; r < 12; r++)
            for (int k = 0; k < 12; k++) out[12 * r + k] += A[12 * i + r] * row[k];
    }
}

/* K (12, 12) = (d A^T) f,  W (6, 12) = dA v */
static void map_changes(const dmb_point_motion *motion, const double gradient[864], const double f[6], double K[144],
                        double W[72])
{
    memset(K, 0, 144 * sizeof *K);
    memset(W, 0, 72 * sizeof *W);
    for (int i = 0; i < 6; i++)
        for (int r = 0; r < 12; r++) {
            const double *g = gradient + 12 * (12 * i + r);
            for (int k = 0; k < 12; k++) {
                K[12 * r + k] += f[i] * g[k];
                W[12 * i + k] += motion->v[r] * g[k];
            }
        }
}

static void add_block(const dmb_evaluation *evaluation, const dmb_point_motion *motion, int by, const double K[144])
{
    dmb_force_tangent tangent;
    dmb_force_tangent_begin(&tangent);
    dmb_force_tangent_touch(evaluation->sim->scene, motion, &tangent);
    dmb_force_tangent_clear(&tangent);
    dmb_force_tangent_block(evaluation->sim->scene, &tangent, motion, 1.0, K);
    dmb_force_tangent_add(evaluation, DMB_NONE, by, &tangent);
}

static void add_tangent(const dmb_evaluation *evaluation, const dmb_point_motion *motion, const section_node *at)
{
    double gradient[864], K[144], W[72];
    dmb_point_map_gradient(evaluation->sim->scene, motion, gradient);
    map_changes(motion, gradient, at->residual, K, W);
    add_products(motion->map, at->stiffness, motion->map, K);
    if (evaluation->dynamic) add_products(motion->map, at->inertia, W, K);
    add_block(evaluation, motion, DMB_BY_DISPLACEMENT, K);
    if (!evaluation->dynamic) return;
    memset(K, 0, sizeof K);
    add_products(motion->map, at->inertia, motion->map, K);
    add_block(evaluation, motion, DMB_BY_VELOCITY, K);
}

/* ---- Forces ------------------------------------------------------------------------------------------------------ */

static int touches(const dmb_sim *sim, uint32_t s, const section_node *at)
{
    return sim->trial.site_penetration[s] > 0.0 || at->site.clearance <= 0.0;
}

static void gather(dmb_evaluation *evaluation, uint32_t s, dmb_wall_job *sums)
{
    static const uint32_t first = 0;
    dmb_sim *sim = evaluation->sim;
    const dmb_scene_point *point = dmb_inside_point(sim->scene, s);
    dmb_wall_job job = *sums;
    dmb_point_motion motion;
    section_node at;
    dmb_point_motion_of(sim->scene, &sim->trial, point, &motion);
    take_node(sim, s, &motion, &at);
    job.count = 1;
    job.sites = &at.site;
    job.row = job.diagonal = &first;
    job.reference += 3 * (size_t)point->node;
    job.displacement = at.displacement;
    job.quaternion = at.quaternion;
    job.velocity = at.velocity;
    job.now_quaternion = at.now_quaternion;
    job.now_velocity = at.now_velocity;
    job.site_return += s;
    job.velocity_factor = 1.0;
    job.residual = at.residual;
    job.scale = at.scale;
    job.stiffness = at.stiffness;
    job.inertia = at.inertia;
    shift_fields(&job.now, s, dmb_scene_has_bristles(sim->scene));
    shift_fields(&job.trial, s, dmb_scene_has_bristles(sim->scene));
    dmb_kernels_of(1)->walls(&job);
    sums->rounding = job.rounding;
    sums->potential = job.potential;
    sums->impact = job.impact;
    sums->friction = job.friction;
    if (!touches(sim, s, &at)) return;
    double w[6];
    for (int i = 0; i < 6; i++) w[i] = -at.residual[i];
    dmb_point_apply(sim, &motion, w);
    if (evaluation->tangent) add_tangent(evaluation, &motion, &at);
}

void dmb_gather_contacts_inside(dmb_evaluation *evaluation, dmb_wall_job *job)
{
    const dmb_scene *scene = evaluation->sim->scene;
    for (uint32_t s = dmb_node_sites(scene); s < scene->site_count; s++) gather(evaluation, s, job);
}

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
