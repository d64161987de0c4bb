/* Rings of FULL nodes against the wall.
 *
 * In body axes, with n, t, b the contact frame (n outward, t along the hole, b = t x n), V the velocity of the ring's
 * centre and r its radius, three generalised directions carry everything:
 *     j_n = (n; 0)    j_t = (t; -r b)    j_b = (b; r t)          contact speed v_k = j_k . V
 *     wrench on the ring = -N j_n + F_t j_t + F_b j_b
 * so drag and torque share one friction force. The tangent follows by the product rule: change of the forces with
 * penetration and speeds, swing of n and b around the axis (the pendulum term N/e), turning of the frame as the ring
 * moves along a bend of the hole, and turning of the body. */
#include "system/wall_contact.h"

#include <string.h>

#include "element/beam.h"
#include "math/mat6.h"
#include "system/evaluation.h"
#include "system/node.h"

typedef struct contact_frame {
    double world_normal[3], world_tangent[3];
    double n[3], t[3], b[3]; /* body axes */
    double j[3][6];          /* j_n, j_t, j_b */
    double distance;         /* [m] e */
    double bend[3];          /* [rad/m] world: the frame turns by `bend` a metre of the axis; 0 where it is straight */
    double V[6];
    double speed[3]; /* v_n, v_t, v_b */
} contact_frame;

/* Forces and their derivatives: F = (-N, F_t, F_b), D[k][l] = dF_k/dv_l, P[k] = dF_k/d penetration. */
typedef struct contact_force {
    double F[3], D[3][3], P[3];
    double elastic; /* [N] part of N that the wall stores */
    int32_t sticks;
} contact_force;

/* Curvature times the binormal, which is one vector all along an arc. */
static void bend_at(const dmb_hole *hole, double depth, uint32_t segment, double bend[3])
{
    dmb_vec3_zero(bend);
    if (dmb_hole_is_straight(hole)) return;
    const dmb_hole_station *arc = hole->station + segment;
    if (arc->curvature == 0.0 || depth < arc->depth) return;
    dmb_vec3_cross(arc->tangent, arc->normal, bend);
    dmb_vec3_scale(arc->curvature, bend, bend);
}

/* Closest point of the axis and the direction from it; depth and segment are hints on entry, answers on return. */
static void locate(const dmb_scene *scene, const dmb_configuration *c, const double R[9], uint32_t s, double *depth,
                   uint32_t *segment, contact_frame *f)
{
    const dmb_site *site = scene->sites + s;
    double x[3], point[3], arm[3] = {site->offset, 0.0, 0.0};
    dmb_mat3_vec(R, arm, arm);
    dmb_vec3_add(scene->reference_position + 3 * site->node, c->displacement + 3 * site->node, x);
    dmb_vec3_add(x, arm, x);
    dmb_hole_project(&scene->hole, x, depth, segment, point, f->world_tangent);
    dmb_radial(x, point, f->world_tangent, c->site_normal + 3 * s, &f->distance, f->world_normal);
    bend_at(&scene->hole, *depth, *segment, f->bend);
}

static void frame_of(const dmb_scene *scene, const dmb_configuration *c, const double R[9], uint32_t s,
                     contact_frame *f)
{
    const dmb_site *site = scene->sites + s;
    dmb_mat3_tvec(R, f->world_normal, f->n);
    dmb_mat3_tvec(R, f->world_tangent, f->t);
    dmb_vec3_cross(f->t, f->n, f->b);
    memset(f->j, 0, sizeof f->j);
    dmb_vec3_copy(f->n, f->j[0]);
    dmb_vec3_copy(f->t, f->j[1]);
    dmb_vec3_scale(-site->radius, f->b, f->j[1] + 3);
    dmb_vec3_copy(f->b, f->j[2]);
    dmb_vec3_scale(site->radius, f->t, f->j[2] + 3);
    dmb_vec6_copy(c->velocity + scene->layout.row[site->node], f->V);
    dmb_arm_velocity(site->offset, f->V);
    for (int k = 0; k < 3; k++) f->speed[k] = dmb_vec6_dot(f->j[k], f->V);
}

/* In statics speeds are 0, but friction may act as at a given slip. */
static void static_speeds(const dmb_evaluation *evaluation, const dmb_site *site, contact_frame *f)
{
    memset(f->V, 0, sizeof f->V);
    f->speed[0] = 0.0;
    f->speed[1] = evaluation->slip[0];
    f->speed[2] = site->radius * evaluation->slip[1];
}

/* Speed of the ring at the last accepted instant towards where it is now: it may have crossed the axis since. */
static double speed_before(const dmb_sim *sim, const dmb_site *site, const double normal[3])
{
    double R[9], V[6];
    dmb_vec6_copy(sim->now.velocity + sim->scene->layout.row[site->node], V);
    dmb_arm_velocity(site->offset, V);
    dmb_quat_to_matrix(sim->now.quaternion + 4 * site->node, R);
    dmb_mat3_vec(R, V, V);
    return dmb_vec3_dot(normal, V);
}

/* Speed v0 of the restitution laws: that at the last accepted instant before touching. While open the field follows the
 * present normal speed. A ring that opens and falls back within one step comes as fast as it left. */
static double approach_speed(const dmb_sim *sim, uint32_t s, double penetration, const contact_frame *f)
{
    if (!(penetration > 0.0)) return sim->now.site_penetration[s] > 0.0 ? sim->now.site_approach[s] : f->speed[0];
    if (sim->site_return[s] > 0.0) return sim->site_return[s];
    if (sim->now.site_penetration[s] > 0.0) return sim->now.site_approach[s];
    return speed_before(sim, sim->scene->sites + s, f->world_normal);
}

static void friction(const dmb_evaluation *evaluation, uint32_t s, double N, double N_depth, double N_rate,
                     const contact_frame *f, contact_force *out)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_friction_law *law = &sim->scene->friction_law;
    const double *v = f->speed + 1;
    double F[2], dv[4], dN[2];
    if (law->kind == DMB_FRICTION_BRISTLE && evaluation->dynamic) {
        dmb_friction_bristle(law, N, v, sim->now.site_bristle + 2 * s, sim->now.site_slip + 2 * s,
                             sim->now.site_sticks[s], evaluation->step, sim->trial.site_bristle + 2 * s, F, dv, dN,
                             &out->sticks);
        sim->trial.site_sticks[s] = out->sticks;
    } else {
        dmb_friction_smooth(law, N, v, F, dv, dN);
    }
    for (int k = 0; k < 2; k++) {
        out->F[1 + k] = F[k];
        out->P[1 + k] = dN[k] * N_depth;
        out->D[1 + k][0] = dN[k] * N_rate;
        out->D[1 + k][1] = dv[2 * k];
        out->D[1 + k][2] = dv[2 * k + 1];
    }
}

static void normal(const dmb_scene *scene, uint32_t s, double penetration, double rate, double approach,
                   contact_force *out)
{
    const double length = scene->sites[s].length;
    double N, depth, dot, elastic, e_depth, e_dot;
    dmb_normal_force(&scene->normal_law, penetration, rate, approach, &N, &depth, &dot);
    dmb_normal_force(&scene->normal_law, penetration, 0.0, approach, &elastic, &e_depth, &e_dot);
    out->F[0] = -length * N;
    out->P[0] = -length * depth;
    out->D[0][0] = -length * dot;
    out->elastic = length * elastic;
}

/* w = [-N (b;0) + F_t (0; r n) + F_b (-n; 0)] + sum j_k D_kl (dj_l/dpsi . V): change by a swing psi around the axis */
static void swing_vector(const contact_frame *f, const contact_force *c, double radius, double out[6])
{
    const double dv[3] = {dmb_vec3_dot(f->b, f->V), radius * dmb_vec3_dot(f->n, f->V + 3), -dmb_vec3_dot(f->n, f->V)};
    for (int i = 0; i < 3; i++) {
        out[i] = c->F[0] * f->b[i] - c->F[2] * f->n[i];
        out[3 + i] = radius * c->F[1] * f->n[i];
    }
    for (int k = 0; k < 3; k++) {
        const double s = c->D[k][0] * dv[0] + c->D[k][1] * dv[1] + c->D[k][2] * dv[2];
        for (int i = 0; i < 6; i++) out[i] += s * f->j[k][i];
    }
}

/* Turning of the body by dtheta turns the frame back: d(j . V) = (j x dtheta) . V = (V x j) . dtheta, translation and
 * rotation parts added. */
static void turning_rows(const contact_frame *f, double turning[3][3])
{
    double a[3], b[3];
    for (int l = 0; l < 3; l++) {
        dmb_vec3_cross(f->V, f->j[l], a);
        dmb_vec3_cross(f->V + 3, f->j[l] + 3, b);
        dmb_vec3_add(a, b, turning[l]);
    }
}

/* d wrench / d pose at the ring, shape (6, 6):
 *     sum j_k (P_k n ; sum_l D_kl turning_l)^T + swing (b/e ; 0)^T + the wrench turning with the body */
static void pose_tangent(const contact_frame *f, const contact_force *c, double radius, const double wrench[6],
                         double out[36])
{
    const double pendulum = f->distance > 1e-9 ? 1.0 / f->distance : 0.0;
    double swing[6], turning[3][3], row[6];
    dmb_mat6_zero(out);
    turning_rows(f, turning);
    for (int k = 0; k < 3; k++) {
        dmb_vec3_scale(c->P[k], f->n, row);
        dmb_vec3_scale(c->D[k][0], turning[0], row + 3);
        dmb_vec3_axpy(c->D[k][1], turning[1], row + 3);
        dmb_vec3_axpy(c->D[k][2], turning[2], row + 3);
        dmb_mat6_add_outer(1.0, f->j[k], row, out);
    }
    swing_vector(f, c, radius, swing);
    for (int i = 0; i < 6; i++) dmb_vec3_axpy(pendulum * swing[i], f->b, out + 6 * i);
    if (pendulum == 0.0) /* on the axis of a pinned pipe: the wall holds alike in every direction */
        for (int i = 0; i < 3; i++) dmb_vec3_axpy(c->P[0] * f->b[i], f->b, out + 6 * i);
    dmb_mat6_add_skew(1.0, wrench, 0, 1, out);
    dmb_mat6_add_skew(1.0, wrench + 3, 1, 1, out);
}

/* Moving by dx along the axis takes the closest point on by ds = t . dx/(1 - e n . (bend x t)), and the frame turns by
 * bend ds: forces turn with it, and speeds change by bend . (j x V). */
static void add_bend_tangent(const contact_frame *f, const contact_force *c, const double R[9], const double wrench[6],
                             double out[36])
{
    double w[3], a[3], b[3], column[6], row[3], speed[3];
    dmb_mat3_tvec(R, f->bend, w);
    dmb_vec3_cross(w, wrench, column);
    dmb_vec3_cross(w, wrench + 3, column + 3);
    for (int l = 0; l < 3; l++) {
        dmb_vec3_cross(f->j[l], f->V, a);
        dmb_vec3_cross(f->j[l] + 3, f->V + 3, b);
        speed[l] = dmb_vec3_dot(w, a) + dmb_vec3_dot(w, b);
    }
    for (int k = 0; k < 3; k++) {
        const double s = c->D[k][0] * speed[0] + c->D[k][1] * speed[1] + c->D[k][2] * speed[2];
        for (int i = 0; i < 6; i++) column[i] += s * f->j[k][i];
    }
    dmb_vec3_cross(w, f->t, a);
    dmb_vec3_scale(1.0 / (1.0 - f->distance * dmb_vec3_dot(a, f->n)), f->t, row);
    for (int i = 0; i < 6; i++) dmb_vec3_axpy(column[i], row, out + 6 * i);
}

/* d wrench / d velocity at the ring: sum j_k D_kl j_l^T, times `factor` */
static void velocity_tangent(const contact_frame *f, const contact_force *c, double factor, double out[36])
{
    double row[6];
    dmb_mat6_zero(out);
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < 6; i++)
            row[i] = c->D[k][0] * f->j[0][i] + c->D[k][1] * f->j[1][i] + c->D[k][2] * f->j[2][i];
        dmb_mat6_add_outer(factor, f->j[k], row, out);
    }
}

/* Adds -K, moved from the ring to its node, to a tangent block. */
static void subtract_at_node(double offset, double K[36], double *out)
{
    if (offset != 0.0) dmb_beam_block_to_nodes(offset, offset, K);
    for (int i = 0; i < 36; i++) out[i] -= K[i];
}

static void add_tangent(const dmb_evaluation *evaluation, const dmb_site *site, const contact_frame *f,
                        const contact_force *c, const double wrench[6])
{
    dmb_sim *sim = evaluation->sim;
    double K[36];
    pose_tangent(f, c, site->radius, wrench, K);
    if (dmb_vec3_norm_squared(f->bend) > 0.0) add_bend_tangent(f, c, sim->rotation + 9 * site->node, wrench, K);
    subtract_at_node(site->offset, K, dmb_stiffness_of(sim, site->node));
    if (!evaluation->dynamic) return;
    velocity_tangent(f, c, evaluation->velocity_factor, K);
    subtract_at_node(site->offset, K, dmb_inertia_of(sim, site->node));
}

static void add_power(dmb_evaluation *evaluation, const contact_frame *f, const contact_force *c)
{
    if (!evaluation->dynamic) return;
    evaluation->power[DMB_POWER_POTENTIAL] -= c->elastic * f->speed[0];
    evaluation->power[DMB_POWER_IMPACT] += (c->F[0] + c->elastic) * f->speed[0];
    evaluation->power[DMB_POWER_FRICTION] += c->F[1] * f->speed[1] + c->F[2] * f->speed[2];
}

/* [m] size of the coordinates that the distance across the hole is a difference of: in a hole along x next to nothing,
 * in an inclined one the way along it. */
static double reach_of(const dmb_sim *sim, uint32_t s)
{
    const uint32_t node = sim->scene->sites[s].node;
    const double offset = sim->scene->sites[s].offset, *axis = sim->rotation + 9 * (size_t)node;
    const double *x = sim->scene->reference_position + 3 * (size_t)node,
                 *u = sim->trial.displacement + 3 * (size_t)node;
    double sum = 0.0;
    for (size_t i = 0; i < 3; i++)
        sum += fabs(sim->trial.site_normal[3 * (size_t)s + i] * (x[i] + u[i] + offset * axis[3 * i]));
    return sum;
}

static void press(dmb_evaluation *evaluation, uint32_t s, double penetration, const contact_frame *f)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_site *site = sim->scene->sites + s;
    contact_force c;
    double wrench[6];
    memset(&c, 0, sizeof c);
    normal(sim->scene, s, penetration, f->speed[0], sim->trial.site_approach[s], &c);
    if (sim->scene->friction_law.kind != DMB_FRICTION_NONE && (evaluation->dynamic || evaluation->slipping))
        friction(evaluation, s, -c.F[0], -c.P[0], -c.D[0][0], f, &c);
    const double rounding = c.P[0] * reach_of(sim, s);
    evaluation->rounding += rounding * rounding;
    if (!evaluation->dynamic) memset(c.D, 0, sizeof c.D);
    for (int i = 0; i < 6; i++) wrench[i] = c.F[0] * f->j[0][i] + c.F[1] * f->j[1][i] + c.F[2] * f->j[2][i];
    if (evaluation->tangent) add_tangent(evaluation, site, f, &c, wrench);
    add_power(evaluation, f, &c);
    dmb_arm_wrench(site->offset, wrench);
    dmb_apply_wrench(sim, site->node, wrench);
}

static void gather_site(dmb_evaluation *evaluation, uint32_t s)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    const dmb_site *site = scene->sites + s;
    const double *R = sim->rotation + 9 * site->node;
    contact_frame f;
    sim->trial.site_depth[s] = sim->now.site_depth[s];
    sim->trial.site_segment[s] = sim->now.site_segment[s];
    dmb_vec3_copy(sim->now.site_normal + 3 * s, sim->trial.site_normal + 3 * s);
    locate(scene, &sim->trial, R, s, &sim->trial.site_depth[s], &sim->trial.site_segment[s], &f);
    frame_of(scene, &sim->trial, R, s, &f);
    if (!evaluation->dynamic) static_speeds(evaluation, site, &f);
    const double penetration = f.distance - site->clearance;
    dmb_vec3_copy(f.world_normal, sim->trial.site_normal + 3 * s);
    sim->trial.site_penetration[s] = penetration;
    sim->trial.site_approach[s] = approach_speed(sim, s, penetration, &f);
    sim->trial.site_slip[2 * s] = f.speed[1];
    sim->trial.site_slip[2 * s + 1] = f.speed[2];
    if (penetration > 0.0 || site->clearance == 0.0) {
        press(evaluation, s, fmax(penetration, 1e-15), &f);
    } else {
        sim->trial.site_bristle[2 * s] = sim->trial.site_bristle[2 * s + 1] = 0.0;
        sim->trial.site_sticks[s] = 0;
    }
}

void dmb_gather_contacts(dmb_evaluation *evaluation)
{
    for (uint32_t s = 0; s < evaluation->sim->scene->site_count; s++) gather_site(evaluation, s);
}

void dmb_finished_friction(const dmb_friction_law *law, double N, const double slip[2], const double bristle[2],
                           int32_t sticks, double F[2])
{
    double z[2], dv[4], dN[2];
    int32_t unused;
    F[0] = F[1] = 0.0;
    if (law->kind == DMB_FRICTION_NONE) return;
    if (law->kind == DMB_FRICTION_BRISTLE)
        dmb_friction_bristle(law, N, slip, bristle, slip, sticks, 0.0, z, F, dv, dN, &unused);
    else
        dmb_friction_smooth(law, N, slip, F, dv, dN);
}

void dmb_site_force_of(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t s, dmb_site_force *out)
{
    const dmb_site *site = scene->sites + s;
    double R[9], hint = configuration->site_depth[s], depth, dot;
    uint32_t segment = configuration->site_segment[s];
    contact_frame f;
    memset(out, 0, sizeof *out);
    dmb_quat_to_matrix(configuration->quaternion + 4 * site->node, R);
    locate(scene, configuration, R, s, &hint, &segment, &f);
    frame_of(scene, configuration, R, s, &f);
    dmb_vec3_copy(f.world_normal, out->normal);
    dmb_vec3_copy(f.world_tangent, out->tangent);
    out->penetration = f.distance - site->clearance;
    out->rate = f.speed[0];
    out->slip[0] = f.speed[1];
    out->slip[1] = f.speed[2];
    if (!(out->penetration > 0.0 || site->clearance == 0.0)) return;
    dmb_normal_force(&scene->normal_law, fmax(out->penetration, 1e-15), out->rate, configuration->site_approach[s],
                     &out->normal_force, &depth, &dot);
    out->normal_force *= site->length;
    out->closed = 1;
    dmb_finished_friction(&scene->friction_law, out->normal_force, out->slip, configuration->site_bristle + 2 * s,
                          configuration->site_sticks[s], out->friction);
    out->sticks = configuration->site_sticks[s];
}
