/* Free rigid bodies and strings: their translation is integrated at the centre of mass, in axes that do not rotate
 * (eq:integration.free-rigid).
 *
 * In body axes m (u' + w x u) = f couples translation and rotation, so that integration errors of one enter the other:
 * a reference point 10 m from the centre of mass drifted by 1.7 m in 100 s at 20 rad/s. With c the centre of mass from
 * the node and the axes of the node at the start of the step (E = exp(theta) maps axes at the end to those at the
 * start),
 *     W = E (u + w x c),   W' = E (u' + w' x c + w x (u + w x c)),   x1 = x0 + R0 (z + c - E c),
 * generalized-alpha is applied to (W, w) and its increments (z, theta) instead of (u, w). Then m W' = f, so that
 * linear momentum is conserved to rounding and a ballistic trajectory is exact. The rotation is integrated as for
 * other nodes: angular momentum to second order; so is the translation of a body with added mass, which depends on the
 * direction. Used only in scenes without joints, for parts without supports and motion drives. */
#include "system/assemble/assemble.h"

#include <string.h>

#include "element/added_mass.h"
#include "element/rigid_mass.h"
#include "math/so3.h"

uint32_t dmb_free_rigid_on(const dmb_scene *scene, uint32_t node)
{
    uint32_t first = 0, end = scene->free_rigid_count;
    while (first < end) {
        const uint32_t middle = first + (end - first) / 2;
        if (scene->free_rigids[middle].node < node)
            first = middle + 1;
        else
            end = middle;
    }
    return first < scene->free_rigid_count && scene->free_rigids[first].node == node ? first : DMB_NONE;
}

/* ---- Between the node and the centre of mass -------------------------------------------------------------------- */

/* (u; w) to (u + w x c; w) */
static void to_centre(const double c[3], const double v[6], double out[6])
{
    double x[3];
    dmb_vec3_cross(v + 3, c, x);
    dmb_vec3_add(v, x, out);
    dmb_vec3_copy(v + 3, out + 3);
}

static void from_centre(const double c[3], const double v[6], double out[6])
{
    double x[3];
    dmb_vec3_cross(v + 3, c, x);
    dmb_vec3_sub(v, x, out);
    dmb_vec3_copy(v + 3, out + 3);
}

void dmb_free_rigid_added(const dmb_scene *scene, uint32_t rigid, double acceleration[6])
{
    to_centre(scene->free_rigids[rigid].centre, acceleration, acceleration);
}

/* At the start both axes are the same, E = I. */
void dmb_free_rigid_start(const dmb_sim *sim, uint32_t rigid, double start[18])
{
    const dmb_free_rigid *body = sim->scene->free_rigids + rigid;
    const uint32_t row = sim->scene->layout.row[body->node];
    double centripetal[3];
    to_centre(body->centre, sim->now.velocity + row, start);
    to_centre(body->centre, sim->now.acceleration + row, start + 6);
    to_centre(body->centre, sim->now.pseudo_acceleration + row, start + 12);
    dmb_vec3_cross(start + 3, start, centripetal);
    dmb_vec3_add(start + 6, centripetal, start + 6);
    dmb_vec3_add(start + 12, centripetal, start + 12);
}

/* ---- A step ------------------------------------------------------------------------------------------------------ */

void dmb_free_rigids_predict(dmb_sim *sim, const dmb_predict_args *args)
{
    for (uint32_t i = 0; i < sim->scene->free_rigid_count; i++) {
        double start[18], *motion = dmb_free_rigid_motion(sim, i);
        dmb_predict_args rows = *args;
        dmb_free_rigid_start(sim, i, start);
        rows.count = 6;
        rows.now_velocity = start;
        rows.now_acceleration = start + 6;
        rows.now_pseudo_acceleration = start + 12;
        rows.velocity = motion;
        rows.acceleration = motion + 6;
        rows.pseudo_acceleration = motion + 12;
        rows.increment = sim->increment + sim->scene->layout.row[sim->scene->free_rigids[i].node];
        sim->scene->kernels->predict(&rows);
    }
}

/* The increments themselves are corrected with all rows. */
void dmb_free_rigids_correct(dmb_sim *sim, const dmb_correct_args *args)
{
    for (uint32_t i = 0; i < sim->scene->free_rigid_count; i++) {
        const double *z = args->correction + sim->scene->layout.row[sim->scene->free_rigids[i].node];
        double *motion = dmb_free_rigid_motion(sim, i);
        for (uint32_t k = 0; k < 6; k++) {
            motion[k] += args->to_velocity * z[k];
            motion[6 + k] += args->to_acceleration * z[k];
            motion[12 + k] += args->to_pseudo_acceleration * z[k];
        }
    }
}

/* Body-frame accelerations (u'; w') at the node from those of the centre in the axes of the start. */
static void accelerations_of(const dmb_free_rigid *body, const double E[9], const double centre_velocity[6],
                             const double from[6], double to[6])
{
    double a[6], centripetal[3];
    dmb_mat3_tvec(E, from, a);
    dmb_vec3_cross(centre_velocity + 3, centre_velocity, centripetal);
    dmb_vec3_sub(a, centripetal, a);
    dmb_vec3_copy(from + 3, a + 3);
    from_centre(body->centre, a, to);
}

static void place(dmb_sim *sim, uint32_t rigid)
{
    const dmb_free_rigid *body = sim->scene->free_rigids + rigid;
    const uint32_t row = sim->scene->layout.row[body->node];
    const double *z = sim->increment + row, *motion = dmb_free_rigid_motion(sim, rigid);
    double E[9], R0[9], x[3], arm[3], v[6];
    dmb_so3_exp(z + 3, NULL, E);
    dmb_quat_to_matrix(sim->now.quaternion + 4 * (size_t)body->node, R0);
    dmb_mat3_vec(E, body->centre, arm);
    dmb_vec3_sub(body->centre, arm, arm);
    dmb_vec3_add(z, arm, x);
    dmb_mat3_vec(R0, x, x);
    dmb_vec3_add(sim->now.displacement + 3 * (size_t)body->node, x, sim->trial.displacement + 3 * (size_t)body->node);
    dmb_mat3_tvec(E, motion, v);
    dmb_vec3_copy(motion + 3, v + 3);
    from_centre(body->centre, v, sim->trial.velocity + row);
    accelerations_of(body, E, v, motion + 6, sim->trial.acceleration + row);
    accelerations_of(body, E, v, motion + 12, sim->trial.pseudo_acceleration + row);
}

/* Positions of the bodies; their orientations have been moved with all nodes by the rotation of the increment. */
void dmb_free_rigids_place(dmb_sim *sim)
{
    for (uint32_t i = 0; i < sim->scene->free_rigid_count; i++) place(sim, i);
}

/* ---- Tangent ----------------------------------------------------------------------------------------------------- */

/* Quantities of one body for its derivatives, at the end of the step, in body axes there. */
typedef struct rigid_end {
    double Et[9], T[9];     /* E^T; right tangent of theta */
    double velocity[6];     /* of the centre */
    double acceleration[3]; /* E^T W' */
    const double *centre;
} rigid_end;

static void end_of(const dmb_sim *sim, uint32_t rigid, rigid_end *end)
{
    const dmb_free_rigid *body = sim->scene->free_rigids + rigid;
    const double *z = sim->increment + sim->scene->layout.row[body->node], *motion = dmb_free_rigid_motion(sim, rigid);
    double E[9];
    dmb_so3_exp(z + 3, NULL, E);
    dmb_so3_tangent(z + 3, NULL, end->T);
    dmb_mat3_transpose(E, end->Et);
    dmb_mat3_vec(end->Et, motion, end->velocity);
    dmb_vec3_copy(motion + 3, end->velocity + 3);
    dmb_mat3_vec(end->Et, motion + 6, end->acceleration);
    end->centre = body->centre;
}

/* A += s a~ B */
static void add_cross(double s, const double a[3], const double B[9], double A[9])
{
    double skew[9], product[9];
    dmb_skew(a, skew);
    dmb_mat3_mul(skew, B, product);
    dmb_mat3_axpy(s, product, A);
}

/* By (z, theta): pose [E^T, c~ T; 0, T] */
static void pose_derivative(const rigid_end *end, double J[36])
{
    double block[9];
    dmb_mat6_zero(J);
    dmb_mat6_set_block(end->Et, 0, 0, J);
    dmb_mat3_zero(block);
    add_cross(1.0, end->centre, end->T, block);
    dmb_mat6_set_block(block, 0, 1, J);
    dmb_mat6_set_block(end->T, 1, 1, J);
}

/* velocity [s E^T, U~ T + s c~; 0, s], U the velocity of the centre, s = velocity_factor */
static void velocity_derivative(const rigid_end *end, double s, double J[36])
{
    double block[9];
    dmb_mat6_zero(J);
    dmb_mat6_add_block(s, end->Et, 0, 0, J);
    dmb_mat3_zero(block);
    add_cross(1.0, end->velocity, end->T, block);
    dmb_mat6_set_block(block, 0, 1, J);
    dmb_mat6_add_skew(s, end->centre, 0, 1, J);
    for (int i = 21; i < 36; i += 7) J[i] = s;
}

/* acceleration [m E^T - s w~ E^T, A~ T + s U~ - w~ U~ T + m c~; 0, m], A = E^T W', m = mass_factor */
static void acceleration_derivative(const rigid_end *end, double m, double s, double J[36])
{
    const double *U = end->velocity, *w = end->velocity + 3;
    double block[9], UT[9];
    dmb_mat3_zero(block);
    dmb_mat3_axpy(m, end->Et, block);
    add_cross(-s, w, end->Et, block);
    dmb_mat6_zero(J);
    dmb_mat6_set_block(block, 0, 0, J);
    dmb_mat3_zero(UT);
    add_cross(1.0, U, end->T, UT);
    dmb_mat3_zero(block);
    add_cross(1.0, end->acceleration, end->T, block);
    add_cross(-1.0, w, UT, block);
    dmb_mat6_set_block(block, 0, 1, J);
    dmb_mat6_add_skew(s, U, 0, 1, J);
    dmb_mat6_add_skew(m, end->centre, 0, 1, J);
    for (int i = 21; i < 36; i += 7) J[i] = m;
}

/* The mass matrix M. */
static void mass_of(const dmb_scene *scene, const dmb_free_rigid *body, double M[36])
{
    const double rest[6] = {0.0};
    dmb_rigid_mass_constants c;
    dmb_rigid_mass_load(scene->rigid_masses + body->rigid_mass, 0, &c);
    dmb_mat6_zero(M);
    dmb_rigid_mass_add_tangent(&c, rest, rest, 1.0, 0.0, M);
    if (body->added_mass != DMB_NONE) dmb_added_mass_add(scene->added_masses + body->added_mass, 1.0, M);
}

static void add_product(const double A[36], const double B[36], double sum[36])
{
    double product[36];
    dmb_mat6_mul(A, B, product);
    dmb_mat6_axpy(1.0, product, sum);
}

/* D = K J_pose + C J_velocity + M J_acceleration, the inertia block being mass_factor M + velocity_factor C. */
void dmb_free_rigids_matrix(const dmb_evaluation *evaluation)
{
    dmb_sim *sim = evaluation->sim;
    const double m = evaluation->mass_factor, s = evaluation->velocity_factor;
    for (uint32_t i = 0; i < sim->scene->free_rigid_count; i++) {
        const dmb_free_rigid *body = sim->scene->free_rigids + i;
        double *stiffness = dmb_stiffness_of(sim, body->node), *inertia = dmb_inertia_of(sim, body->node);
        double D[36], M[36], J[36];
        rigid_end end;
        end_of(sim, i, &end);
        mass_of(sim->scene, body, M);
        dmb_mat6_zero(D);
        pose_derivative(&end, J);
        add_product(stiffness, J, D);
        acceleration_derivative(&end, m, s, J);
        add_product(M, J, D);
        velocity_derivative(&end, s, J);
        dmb_mat6_axpy(-m, M, inertia);
        for (int k = 0; k < 36; k++) inertia[k] /= s;
        add_product(inertia, J, D);
        dmb_mat6_copy(D, stiffness);
        dmb_mat6_zero(inertia);
    }
}
