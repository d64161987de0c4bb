/* Moves of the trial by a correction. All variants agree to first order; in a hole the finite move keeps the invariants
 * of the equations, therefore strings that wind up by radians and climb around the wall converge as fast as others. */
#include "analysis/linear/linear.h"
#include "analysis/static/static.h"
#include "math/se3.h"
#include "math/so3.h"
#include "math/vec3.h"
#include "system/constrain/constrain.h"
#include <math.h>

/* ---- Joints ------------------------------------------------------------------------------------------------------ */

static int32_t choose_anew(dmb_static_search *search)
{
    const int32_t status = dmb_clusters_assemble(&search->evaluation);
    if (status >= 0) dmb_clusters_choose(search->sim);
    return status;
}

static void note_edge(dmb_static_search *search)
{
    uint32_t joint;
    const double gimbal_margin = 1.0 - dmb_joints_nearest_gimbal_singularity(search->sim, &joint);
    if (!(gimbal_margin > search->gimbal_margin)) return;
    search->gimbal_margin = gimbal_margin;
    search->gimbal_joint = joint;
}

/* Closes the joints, and chooses a new partition if the present one is ill-conditioned. A large move may have made it
 * singular, which is treated first. */
int32_t dmb_static_settle(dmb_static_search *search)
{
    int32_t status = dmb_clusters_settle(&search->evaluation, DMB_SETTLE_POSE, 0);
    if (status == DMB_ERR_SINGULAR) {
        status = choose_anew(search);
        if (status >= 0) status = dmb_clusters_settle(&search->evaluation, DMB_SETTLE_POSE, 0);
    }
    if (status < 0) return status;
    search->sim->reduced_mode->row = DMB_NONE;
    status = dmb_joints_refuse_gimbal_flip(search->sim);
    if (status < 0) return status;
    note_edge(search);
    dmb_joints_follow(&search->evaluation);
    return dmb_clusters_refresh(&search->evaluation);
}

/* ---- Moves ------------------------------------------------------------------------------------------------------- */

static void add_increment(dmb_sim *sim, const double *correction, double factor)
{
    for (uint32_t i = 0; i < sim->scene->row_count; i++) sim->increment[i] += factor * correction[i];
}

/* z (6) = factor times the correction of a node */
static void copy_rows(const dmb_scene *scene, uint32_t node, const double *correction, double factor, double z[6])
{
    for (uint32_t c = 0; c < 6; c++)
        z[c] = c < scene->layout.size[node] ? factor * correction[scene->layout.row[node] + c] : 0.0;
}

static void displace_node(dmb_sim *sim, uint32_t node, const double z[6])
{
    if (sim->scene->layout.size[node] == DMB_NODE_SIX_DOF) {
        dmb_se3_advance(sim->trial.quaternion + 4 * (size_t)node, sim->trial.displacement + 3 * (size_t)node, z);
    } else {
        sim->trial.displacement[3 * (size_t)node] += z[0];
        sim->trial.turn[node] += z[1];
    }
}

/* Adds the increments; the sum in `increment` includes all rotations. */
void dmb_static_displace(dmb_sim *sim, const double *correction, double factor)
{
    double z[6];
    add_increment(sim, correction, factor);
    for (uint32_t i = 0; i < sim->scene->node_count; i++) {
        copy_rows(sim->scene, i, correction, factor, z);
        displace_node(sim, i, z);
    }
}

/* Rotation of a node about its own axis [rad]. The correction of a pipe that winds up by radians moves it sideways
 * along its axes before the move: H <- H exp(z less its spin) exp(spin) (eq:static.move), and back in the reverse
 * order. In the single exponential of z the lateral displacement would rotate with the spin. */
static void spin(dmb_sim *sim, uint32_t node, double angle)
{
    double *q = sim->trial.quaternion + 4 * (size_t)node;
    const double turn[4] = {cos(0.5 * angle), sin(0.5 * angle), 0.0, 0.0};
    dmb_quat_mul(q, turn, q);
}

#define DMB_LONGEST_ROLL 1.5 /* [rad] around the hole by one correction: larger moves are straight */

/* Rolling of a ring in wall contact: it moves around and along the hole instead of straight. With e n its position off
 * the axis before, d = (along, out, a e) in the hole's frame t, n, b = t x n, and k the curvature vector, it moves to
 *
 *     (e + out) r,    r = cos(a) n + sin(a) b made orthogonal to t + along k,
 *
 * off the axis, which itself moved to along t + along^2/2 k. `more` [m] is the difference from d, without the rounding
 * of positions. Without it a pipe that climbs around a hole penetrates the wall by the square of its displacement over
 * 2 e. */
static void roll(const dmb_sim *sim, uint32_t s, const double before[3], const double d[3], double more[3])
{
    const dmb_scene *scene = sim->scene;
    const dmb_site *site = scene->sites + s;
    double x[3], point[3], t[3], n[3], b[3], k[3], r[3], depth = sim->trial.site_depth[s];
    uint32_t segment = sim->trial.site_segment[s];
    dmb_vec3_zero(more);
    dmb_vec3_add(scene->reference_position + 3 * (size_t)site->node, before, x);
    dmb_hole_project(&scene->hole, x, &depth, &segment, point, t);
    dmb_hole_frame(&scene->hole, depth, point, t, k);
    dmb_vec3_sub(x, point, n);
    dmb_vec3_axpy(-dmb_vec3_dot(n, t), t, n);
    const double e = dmb_vec3_norm(n);
    if (!(e > dmb_site_clearance(scene, site, depth)) || !(e > 0.0)) return;
    dmb_vec3_scale(1.0 / e, n, n);
    dmb_vec3_cross(t, n, b);
    const double along = dmb_vec3_dot(d, t), out = e + dmb_vec3_dot(d, n), a = dmb_vec3_dot(d, b) / e;
    if (!(fabs(a) <= DMB_LONGEST_ROLL) || !(out > 0.0)) return;
    for (int i = 0; i < 3; i++) r[i] = cos(a) * n[i] + sin(a) * b[i];
    dmb_vec3_axpy(along, k, t);
    dmb_vec3_axpy(-dmb_vec3_dot(r, t) / dmb_vec3_dot(t, t), t, r);
    dmb_vec3_scale(out / dmb_vec3_norm(r), r, r);
    for (int i = 0; i < 3; i++) more[i] = (r[i] - out * n[i] - a * e * b[i]) + 0.5 * along * along * k[i];
}

/* Ring at a node, with which the node rolls, from the ring `s` on; rings are in the order of their nodes. DMB_NONE also
 * for a laterally constrained node, which moves straight. */
static uint32_t ring_of(const dmb_scene *scene, uint32_t node, uint32_t *s)
{
    while (*s < scene->site_count && scene->sites[*s].node < node) ++*s;
    const int at_node = *s < scene->site_count && scene->sites[*s].node == node && scene->sites[*s].offset == 0.0;
    return at_node && dmb_static_is_free_across(scene, node) ? *s : DMB_NONE;
}

/* side 1: move from the present pose; -1: reverse move by this z (rolling: to third order). */
static void wind(dmb_sim *sim, uint32_t node, uint32_t ring, int side, double z[6])
{
    double *u = sim->trial.displacement + 3 * (size_t)node, before[3], d[3], more[3];
    const double angle = z[DMB_RX];
    z[DMB_RX] = 0.0;
    if (side < 0) {
        spin(sim, node, -angle);
        for (int i = 0; i < 6; i++) z[i] = -z[i];
    }
    dmb_vec3_copy(u, before);
    displace_node(sim, node, z);
    if (ring != DMB_NONE) {
        dmb_vec3_sub(side > 0 ? u : before, side > 0 ? before : u, d);
        roll(sim, ring, side > 0 ? before : u, d, more);
        dmb_vec3_axpy(side, more, u);
        dmb_vec3_scale(-side, more, more);
        dmb_static_stay_along(sim, node, more);
    }
    if (side > 0) spin(sim, node, angle);
}

static void displace_winding(const dmb_static_search *search, const double *correction, double factor, int side)
{
    dmb_sim *sim = search->sim;
    double z[6];
    add_increment(sim, correction, side * factor);
    for (uint32_t i = 0, s = 0; i < sim->scene->node_count; i++) {
        copy_rows(sim->scene, i, correction, factor, z);
        const uint32_t ring = search->rolling ? ring_of(sim->scene, i, &s) : DMB_NONE;
        if (sim->scene->layout.size[i] == DMB_NODE_SIX_DOF) {
            wind(sim, i, ring, side, z);
        } else {
            for (int c = 0; c < 2; c++) z[c] *= side;
            displace_node(sim, i, z);
        }
    }
}

int32_t dmb_static_move(dmb_static_search *search, const double *correction, double factor)
{
    if (search->winding)
        displace_winding(search, correction, factor, 1);
    else
        dmb_static_displace(search->sim, correction, factor);
    return search->sim->scene->cluster_count ? dmb_static_settle(search) : DMB_OK;
}

void dmb_static_move_back(dmb_static_search *search, const double *correction, double factor)
{
    if (search->winding)
        displace_winding(search, correction, factor, -1);
    else
        dmb_static_displace(search->sim, correction, -factor);
}

/* ---- Residual and work ------------------------------------------------------------------------------------------- */

double dmb_static_work(const dmb_static_search *search, const double *direction, double part)
{
    const dmb_sim *sim = search->sim;
    const dmb_scene *scene = sim->scene;
    double sum = 0.0;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        const uint32_t row = scene->layout.row[i], size = scene->layout.size[i];
        double z[6];
        copy_rows(scene, i, direction, 1.0, z);
        if (search->winding && size == DMB_NODE_SIX_DOF) {
            const double c = cos(part * z[3]), s = sin(part * z[3]);
            for (uint32_t k = 1; k < 6; k += 3) {
                const double y = c * z[k] + s * z[k + 1];
                z[k + 1] = c * z[k + 1] - s * z[k];
                z[k] = y;
            }
        }
        for (uint32_t k = 0; k < size; k++) sum += scene->solved_row[row + k] ? z[k] * sim->residual[row + k] : 0.0;
    }
    return sum;
}

/* Tangent in axes that do not spin. The residual r is expressed in axes of the node. A spin phi rotates these, dr =
 * -phi e_x x r + (change of the forces), and far from equilibrium a correction with a large spin would reduce r by that
 * term alone. The root of the residual is the same without it: the tangent becomes that of the residual in inertial
 * axes, K e_x + e_x x r in the columns of spin (eq:static.fixed-axes). The residual of a constrained row is a reaction,
 * which does not vanish, so that the pair of such a row is unchanged. */
void dmb_static_fix_axes(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        if (scene->layout.size[i] != DMB_NODE_SIX_DOF) continue;
        const uint8_t *solved = scene->solved_row + scene->layout.row[i];
        const double *r = sim->residual + scene->layout.row[i];
        double *K = dmb_stiffness_of(sim, i);
        for (int c = 1; c < 6; c += 3) {
            if (!solved[c] || !solved[c + 1]) continue;
            K[6 * c + DMB_RX] -= r[c + 1];
            K[6 * (c + 1) + DMB_RX] += r[c];
        }
    }
}

int dmb_static_is_free_across(const dmb_scene *scene, uint32_t node)
{
    const uint8_t *solved = scene->solved_row + scene->layout.row[node];
    return scene->layout.size[node] == DMB_NODE_SIX_DOF && solved[DMB_Y] && solved[DMB_Z];
}

int dmb_static_is_free_along(const dmb_scene *scene, uint32_t node)
{
    return scene->solved_row[scene->layout.row[node] + DMB_X] != 0;
}

void dmb_static_stay_along(dmb_sim *sim, uint32_t node, const double back[3])
{
    const double x[3] = {1.0, 0.0, 0.0};
    double axis[3];
    if (dmb_static_is_free_along(sim->scene, node)) return;
    dmb_quat_rotate(sim->trial.quaternion + 4 * (size_t)node, x, axis);
    dmb_vec3_axpy(dmb_vec3_dot(back, axis), axis, sim->trial.displacement + 3 * (size_t)node);
}
