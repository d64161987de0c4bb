/* The equations of a compiled scene as a system of first order, for integrators from elsewhere:
 *
 *     u' = R v         q' = q o omega/2         residual(u, q, v, v') = 0
 *
 * The residual and its tangents are the library's own (system/assemble/evaluation.h), so that what differs is the
 * integrator alone. Unknowns of a node: displacement u (3, world), quaternion q (4), body-frame velocity (v, omega)
 * (6). Nodes that drives and supports hold altogether move as the library prescribes; their unknowns stand still. Nodes
 * held in part are refused.
 *
 * The linear system of an implicit step,
 *     J = dF/dy + rate dF/dy',      rate = d y'/d y of the integrator's formula,
 * is reduced node by node to its velocities, exactly: what is left is block-tridiagonal as in the library and goes to
 * the library's solver. */
#ifndef BENCH_PEER_EQUATIONS_H
#define BENCH_PEER_EQUATIONS_H

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "math/block_tridiagonal.h"
#include "math/se3.h"
#include "system/assemble/drives.h"
#include "system/assemble/evaluation.h"

enum { PEER_U = 0, PEER_Q = 3, PEER_V = 7, PEER_NODE = 13 };

/* Calls of dmb_system_evaluate in this program, the library's own and the peer's; the linker leads them through here.
 */
static double residuals_evaluated, tangents_evaluated;
int32_t __real_dmb_system_evaluate(dmb_evaluation *evaluation);
int32_t __wrap_dmb_system_evaluate(dmb_evaluation *evaluation);
int32_t __wrap_dmb_system_evaluate(dmb_evaluation *evaluation)
{
    residuals_evaluated += 1.0;
    tangents_evaluated += evaluation->tangent ? 1.0 : 0.0;
    return __real_dmb_system_evaluate(evaluation);
}

typedef struct equations {
    dmb_sim *sim; /* its `now` stays at the start; its trial is worked on */
    const dmb_scene *scene;
    dmb_evaluation evaluation;
    double rate;                      /* [1/s] of the factors */
    double *factored_pose;            /* y of the factors */
    double *turning;                  /* W: body-frame pose change by velocity change, shape (node, 6, 6) */
    double *shift;                    /* pose change that the kinematic rows alone ask for, shape (row) */
    double *force;                    /* shape (row) */
    double *diagonal, *lower, *upper; /* stiffness at the factors, shape (node, 6, 6) each */
    /* of the explicit form only: */
    double *mass_memory;
    uint8_t *mass_pivot;
    dmb_block_matrix mass, mass_factors;
    double *still;  /* y' = 0 */
    double *scaled; /* shape (node, 13) */
} equations;

static int is_constrained(const dmb_scene *compiled, uint32_t node)
{
    return !compiled->solved_row[compiled->layout.row[node]];
}

/* 1 if every node is free or held altogether, and one chain is all there is. */
static int equations_suit(const dmb_scene *compiled)
{
    if (compiled->chain_count != 1 || compiled->cluster_count || compiled->bit_count) return 0;
    for (uint32_t i = 0; i < compiled->node_count; i++) {
        const uint8_t *solved = compiled->solved_row + compiled->layout.row[i];
        if (compiled->layout.size[i] != 6) return 0;
        for (int k = 1; k < 6; k++)
            if (solved[k] != solved[0]) return 0;
    }
    return 1;
}

static void equations_close(equations *e)
{
    free(e->factored_pose);
    free(e->turning);
    free(e->shift);
    free(e->force);
    free(e->diagonal);
    free(e->lower);
    free(e->upper);
    free(e->mass_memory);
    free(e->mass_pivot);
    free(e->still);
    free(e->scaled);
}

static int equations_open(equations *e, dmb_sim *sim)
{
    memset(e, 0, sizeof *e);
    e->sim = sim;
    e->scene = sim->scene;
    if (!equations_suit(e->scene)) return 0;
    const size_t nodes = e->scene->node_count, rows = e->scene->row_count;
    e->factored_pose = calloc(PEER_NODE * nodes, sizeof(double));
    e->turning = calloc(36 * nodes, sizeof(double));
    e->shift = calloc(rows, sizeof(double));
    e->force = calloc(rows, sizeof(double));
    e->diagonal = calloc(36 * nodes, sizeof(double));
    e->lower = calloc(36 * nodes, sizeof(double));
    e->upper = calloc(36 * nodes, sizeof(double));
    e->evaluation.sim = sim;
    e->evaluation.load_factor = e->evaluation.pseudo_factor = e->evaluation.velocity_factor = 1.0;
    e->evaluation.dynamic = 1;
    return e->factored_pose && e->turning && e->shift && e->force && e->diagonal && e->lower && e->upper;
}

/* ---- Kinematics -------------------------------------------------------------------------------------------------- */

/* (u', q') of a node: R v and q o (0, omega)/2 */
static void kinematics(const double *y, double out[7])
{
    const double *w = y + PEER_V + 3, half[4] = {0.0, 0.5 * w[0], 0.5 * w[1], 0.5 * w[2]};
    double q[4];
    dmb_quat_copy(y + PEER_Q, q);
    dmb_quat_normalize(q);
    dmb_quat_rotate(q, y + PEER_V, out);
    dmb_quat_mul(y + PEER_Q, half, out + 3);
}

/* The accepted state of the library as y and y'. */
static void equations_start(const equations *e, double *y, double *dy)
{
    const dmb_configuration *now = &e->sim->now;
    for (uint32_t i = 0; i < e->scene->node_count; i++, y += PEER_NODE, dy += PEER_NODE) {
        const uint32_t row = e->scene->layout.row[i];
        memset(dy, 0, PEER_NODE * sizeof(double));
        dmb_vec3_copy(now->displacement + 3 * (size_t)i, y + PEER_U);
        dmb_quat_copy(now->quaternion + 4 * (size_t)i, y + PEER_Q);
        dmb_vec6_copy(now->velocity + row, y + PEER_V);
        if (is_constrained(e->scene, i)) continue;
        dmb_vec6_copy(now->acceleration + row, dy + PEER_V);
        kinematics(y, dy);
    }
}

/* ---- Residual ---------------------------------------------------------------------------------------------------- */

static void put_held_node(dmb_sim *sim, uint32_t i)
{
    double *q = sim->trial.quaternion + 4 * (size_t)i, *u = sim->trial.displacement + 3 * (size_t)i;
    dmb_quat_copy(sim->now.quaternion + 4 * (size_t)i, q);
    dmb_vec3_copy(sim->now.displacement + 3 * (size_t)i, u);
    dmb_se3_advance(q, u, sim->increment + sim->scene->layout.row[i]);
}

/* y and y' into the library's trial. Held rows move from `now` on as their drives say, or not at all. */
static int32_t put_trial(equations *e, double time, const double *y, const double *dy)
{
    dmb_sim *sim = e->sim;
    const dmb_scene *compiled = e->scene;
    for (uint32_t i = 0; i < compiled->constrained_count; i++) {
        const uint32_t row = compiled->layout.row[compiled->constrained_node[i]] + compiled->constrained_component[i];
        sim->trial.velocity[row] = sim->trial.acceleration[row] = sim->increment[row] = 0.0;
    }
    e->evaluation.time = time;
    e->evaluation.step = time - sim->clock->time;
    const int32_t status = dmb_system_prescribe(&e->evaluation);
    for (uint32_t i = 0; i < compiled->node_count; i++, y += PEER_NODE, dy += PEER_NODE) {
        const uint32_t row = compiled->layout.row[i];
        if (is_constrained(compiled, i)) {
            put_held_node(sim, i);
            continue;
        }
        dmb_vec3_copy(y + PEER_U, sim->trial.displacement + 3 * (size_t)i);
        dmb_quat_copy(y + PEER_Q, sim->trial.quaternion + 4 * (size_t)i);
        dmb_quat_normalize(sim->trial.quaternion + 4 * (size_t)i);
        dmb_vec6_copy(y + PEER_V, sim->trial.velocity + row);
        dmb_vec6_copy(dy + PEER_V, sim->trial.acceleration + row);
    }
    return status;
}

/* F(t, y, y') */
static int32_t equations_residual(equations *e, double time, const double *y, const double *dy, double *F)
{
    int32_t status = put_trial(e, time, y, dy);
    e->evaluation.tangent = 0;
    if (status >= 0) status = dmb_system_evaluate(&e->evaluation);
    if (status < 0) return status;
    for (uint32_t i = 0; i < e->scene->node_count; i++, y += PEER_NODE, dy += PEER_NODE, F += PEER_NODE) {
        double k[7];
        memcpy(F, dy, PEER_NODE * sizeof(double)); /* a held node: y' = 0 */
        if (is_constrained(e->scene, i)) continue;
        kinematics(y, k);
        for (int j = 0; j < 7; j++) F[j] -= k[j];
        dmb_vec6_copy(e->sim->residual + e->scene->layout.row[i], F + PEER_V);
    }
    return status;
}

/* ---- The linear system of a step --------------------------------------------------------------------------------- */

/* out = x o (rate, omega/2)/(rate^2 + omega^2/4), which solves rate out - out o omega/2 = x */
static void divide_by_turning(double rate, const double w[3], const double x[4], double out[4])
{
    const double factor = 1.0 / (rate * rate + 0.25 * dmb_vec3_dot(w, w));
    const double r[4] = {factor * rate, 0.5 * factor * w[0], 0.5 * factor * w[1], 0.5 * factor * w[2]};
    dmb_quat_mul(x, r, out);
}

/* W: rotation (rate I - omega~/2)/(rate^2 + omega^2/4), translation (I - v~ rotation)/rate */
static void turning_of(double rate, const double *v, double W[36])
{
    const double factor = 1.0 / (rate * rate + 0.25 * dmb_vec3_dot(v + 3, v + 3));
    double S[9], skew[9], B[9];
    dmb_skew(v + 3, S);
    for (int i = 0; i < 9; i++) S[i] = factor * ((i % 4 == 0 ? rate : 0.0) - 0.5 * S[i]);
    dmb_skew(v, skew);
    dmb_mat3_mul(skew, S, B);
    dmb_mat6_zero(W);
    for (int i = 0; i < 3; i++) W[7 * i] = 1.0 / rate;
    dmb_mat6_set_block(S, 1, 1, W);
    dmb_mat6_add_block(-1.0 / rate, B, 0, 1, W);
}

/* inertia <- inertia + stiffness W, blocks of node i and the link after it */
static void reduce_node(const equations *e, uint32_t i)
{
    const dmb_sim *sim = e->sim;
    const dmb_block_layout *layout = &e->scene->layout;
    const double *W = e->turning + 36 * (size_t)i, *next = W + 36;
    double product[36];
    dmb_mat6_mul(e->diagonal + layout->diag[i], W, product);
    for (int k = 0; k < 36; k++) dmb_inertia_of(sim, i)[k] += product[k];
    if (i + 1 == e->scene->node_count) return;
    dmb_mat6_mul(e->upper + layout->link[i], next, product);
    for (int k = 0; k < 36; k++) sim->stiffness_upper[layout->link[i] + (uint32_t)k] += product[k];
    dmb_mat6_mul(e->lower + layout->link[i], W, product);
    for (int k = 0; k < 36; k++) sim->stiffness_lower[layout->link[i] + (uint32_t)k] += product[k];
}

/* Rows and columns of a held node: identity. */
static void hold_node(const equations *e, uint32_t i)
{
    dmb_sim *sim = e->sim;
    const dmb_block_layout *layout = &e->scene->layout;
    double *D = dmb_inertia_of(sim, i);
    memset(D, 0, 36 * sizeof(double));
    for (int k = 0; k < 6; k++) D[7 * k] = 1.0;
    if (i > 0) {
        memset(sim->stiffness_upper + layout->link[i - 1], 0, 36 * sizeof(double));
        memset(sim->stiffness_lower + layout->link[i - 1], 0, 36 * sizeof(double));
    }
    if (i + 1 == e->scene->node_count) return;
    memset(sim->stiffness_upper + layout->link[i], 0, 36 * sizeof(double));
    memset(sim->stiffness_lower + layout->link[i], 0, 36 * sizeof(double));
}

static dmb_block_matrix reduced_matrix(const dmb_sim *sim)
{
    const dmb_block_matrix matrix = {sim->inertia_diagonal, sim->stiffness_lower, sim->stiffness_upper, sim->pivot};
    return matrix;
}

/* The stiffness alone, kept until the next tangent: solutions need it. */
static int32_t take_stiffness(equations *e)
{
    const dmb_sim *sim = e->sim;
    const dmb_block_layout *layout = &e->scene->layout;
    const uint32_t nodes = e->scene->node_count;
    dmb_evaluation evaluation = e->evaluation;
    evaluation.tangent = 1;
    evaluation.mass_factor = evaluation.velocity_factor = 0.0;
    memset(sim->increment, 0, e->scene->row_count * sizeof(double));
    const int32_t status = dmb_system_evaluate(&evaluation);
    if (status < 0) return status;
    memcpy(e->diagonal, sim->stiffness_diagonal, layout->diag[nodes] * sizeof(double));
    memcpy(e->lower, sim->stiffness_lower, layout->link[nodes - 1] * sizeof(double));
    memcpy(e->upper, sim->stiffness_upper, layout->link[nodes - 1] * sizeof(double));
    return DMB_OK;
}

/* Factors J at (t, y, y'). */
static int32_t equations_factor(equations *e, double time, double rate, const double *y, const double *dy)
{
    const uint32_t nodes = e->scene->node_count;
    int32_t status = put_trial(e, time, y, dy);
    e->rate = rate;
    e->evaluation.tangent = 1;
    e->evaluation.mass_factor = rate;
    if (status >= 0) status = take_stiffness(e);
    e->evaluation.inertia_only = 1;
    if (status >= 0) status = dmb_system_evaluate(&e->evaluation);
    e->evaluation.inertia_only = 0;
    if (status < 0) return status;
    memcpy(e->factored_pose, y, PEER_NODE * nodes * sizeof(double));
    for (uint32_t i = 0; i < nodes; i++)
        turning_of(rate, y + (size_t)PEER_NODE * i + PEER_V, e->turning + 36 * (size_t)i);
    for (uint32_t i = 0; i < nodes; i++) reduce_node(e, i);
    for (uint32_t i = 0; i < nodes; i++)
        if (is_constrained(e->scene, i)) hold_node(e, i);
    dmb_block_matrix matrix = reduced_matrix(e->sim);
    return dmb_block_factor(&e->scene->layout, &matrix, 0, nodes) < 0 ? DMB_OK : DMB_ERR_SINGULAR;
}

/* Change of a node's (u, q) for its kinematic rows b and a change dv of its velocity; NULL: none. Body-frame pose
 * change into `pose`, its quaternion with the part that changes the norm into eta. */
static void pose_change(double rate, const double *y, const double *b, const double *dv, double pose[6], double eta[4])
{
    double q[4], x[4], u[3], swing[3];
    dmb_quat_copy(y + PEER_Q, q);
    dmb_quat_normalize(q);
    dmb_quat_between(q, b + PEER_Q, x);
    dmb_quat_rotate_inverse(q, b, u);
    if (dv) {
        dmb_vec3_axpy(0.5, dv + 3, x + 1);
        dmb_vec3_add(u, dv, u);
    }
    divide_by_turning(rate, y + PEER_V + 3, x, eta);
    dmb_vec3_scale(2.0, eta + 1, pose + 3);
    dmb_vec3_cross(y + PEER_V, pose + 3, swing); /* d(R v) = -R v~ dtheta */
    dmb_vec3_axpy(-1.0, swing, u);
    dmb_vec3_scale(1.0 / rate, u, pose);
}

/* Solution of a node from its velocity change. */
static void unreduce_node(const equations *e, const double *y, const double *b, const double *dv, double *x)
{
    double q[4], pose[6], eta[4];
    dmb_quat_copy(y + PEER_Q, q);
    dmb_quat_normalize(q);
    pose_change(e->rate, y, b, dv, pose, eta);
    dmb_quat_rotate(q, pose, x);
    dmb_quat_mul(q, eta, x + PEER_Q);
    dmb_vec6_copy(dv, x + PEER_V);
}

/* J x = b by the factors at hand; x and b may not overlap. */
static void equations_solve(equations *e, const double *b, double *x)
{
    const dmb_sim *sim = e->sim;
    const dmb_block_layout *layout = &e->scene->layout;
    const uint32_t nodes = e->scene->node_count;
    const dmb_block_matrix stiffness = {e->diagonal, e->lower, e->upper, NULL};
    const dmb_block_matrix matrix = reduced_matrix(sim);
    double eta[4];
    for (uint32_t i = 0; i < nodes; i++) {
        const size_t at = (size_t)PEER_NODE * i;
        if (is_constrained(e->scene, i))
            memset(e->shift + layout->row[i], 0, 6 * sizeof(double));
        else
            pose_change(e->rate, e->factored_pose + at, b + at, NULL, e->shift + layout->row[i], eta);
    }
    dmb_block_multiply(layout, &stiffness, 0, nodes, e->shift, e->force);
    for (uint32_t i = 0; i < nodes; i++)
        for (uint32_t k = 0; k < 6; k++)
            e->force[layout->row[i] + k] =
                is_constrained(e->scene, i) ? 0.0 : b[PEER_NODE * i + PEER_V + k] - e->force[layout->row[i] + k];
    dmb_block_solve(layout, &matrix, 0, nodes, e->force);
    for (uint32_t i = 0; i < nodes; i++) {
        const size_t at = (size_t)PEER_NODE * i;
        if (!is_constrained(e->scene, i))
            unreduce_node(e, e->factored_pose + at, b + at, e->force + layout->row[i], x + at);
        else
            for (int k = 0; k < PEER_NODE; k++) x[at + (size_t)k] = b[at + (size_t)k] / e->rate;
    }
}

/* ---- Explicit form: y' = f(t, y) --------------------------------------------------------------------------------- */

/* Takes M apart from the other terms, as it is in the body frame for good, and factors it with held rows as identity.
 */
static int32_t equations_mass(equations *e, const double *y)
{
    dmb_sim *sim = e->sim;
    const dmb_block_layout *layout = &e->scene->layout;
    const uint32_t nodes = e->scene->node_count;
    const size_t diagonal = layout->diag[nodes], link = layout->link[nodes - 1], rows = e->scene->row_count;
    e->mass_memory = calloc(2 * (diagonal + 2 * link), sizeof(double));
    e->mass_pivot = calloc(rows, 1);
    e->still = calloc(PEER_NODE * (size_t)nodes, sizeof(double));
    e->scaled = calloc(PEER_NODE * (size_t)nodes, sizeof(double));
    if (!e->mass_memory || !e->mass_pivot || !e->still || !e->scaled) return DMB_ERR_NO_MEMORY;
    double *next = e->mass_memory;
    dmb_block_matrix *const kinds[2] = {&e->mass, &e->mass_factors};
    for (int k = 0; k < 2; k++, next += diagonal + 2 * link) {
        const dmb_block_matrix at = {next, next + diagonal, next + diagonal + link, e->mass_pivot};
        *kinds[k] = at;
    }
    int32_t status = put_trial(e, sim->clock->time, y, e->still);
    e->evaluation.tangent = 1;
    e->evaluation.inertia_only = 1;
    e->evaluation.mass_factor = 1.0;
    e->evaluation.velocity_factor = 0.0;
    if (status >= 0) status = dmb_system_evaluate(&e->evaluation);
    e->evaluation.inertia_only = 0;
    e->evaluation.velocity_factor = 1.0;
    for (int k = 0; k < 2; k++) {
        memcpy(kinds[k]->diagonal, sim->inertia_diagonal, diagonal * sizeof(double));
        memcpy(kinds[k]->lower, sim->stiffness_lower, link * sizeof(double));
        memcpy(kinds[k]->upper, sim->stiffness_upper, link * sizeof(double));
        for (uint32_t i = 0; i < nodes; i++)
            if (is_constrained(e->scene, i)) hold_node(e, i);
    }
    if (status < 0) return status;
    return dmb_block_factor(layout, &e->mass_factors, 0, nodes) < 0 ? DMB_OK : DMB_ERR_SINGULAR;
}

/* f(t, y), v' by M^-1. */
static int32_t equations_rates(equations *e, double time, const double *y, double *f)
{
    const dmb_block_layout *layout = &e->scene->layout;
    const uint32_t nodes = e->scene->node_count;
    int32_t status = put_trial(e, time, y, e->still);
    e->evaluation.tangent = 0;
    if (status >= 0) status = dmb_system_evaluate(&e->evaluation);
    if (status < 0) return status;
    for (uint32_t i = 0; i < nodes; i++)
        for (uint32_t k = 0; k < 6; k++)
            e->force[layout->row[i] + k] = is_constrained(e->scene, i) ? 0.0 : -e->sim->residual[layout->row[i] + k];
    dmb_block_solve(layout, &e->mass_factors, 0, nodes, e->force);
    for (uint32_t i = 0; i < nodes; i++, y += PEER_NODE, f += PEER_NODE) {
        memset(f, 0, PEER_NODE * sizeof(double));
        if (is_constrained(e->scene, i)) continue;
        kinematics(y, f);
        dmb_vec6_copy(e->force + layout->row[i], f + PEER_V);
    }
    return status;
}

/* (I - df/dy/rate) x = b: the rows of J x, times 1/rate, those of velocities by M^-1. */
static void equations_solve_explicit(equations *e, const double *b, double *x)
{
    const dmb_block_layout *layout = &e->scene->layout;
    const uint32_t nodes = e->scene->node_count;
    for (uint32_t i = 0; i < nodes; i++) {
        for (uint32_t k = 0; k < PEER_NODE; k++) e->scaled[PEER_NODE * i + k] = e->rate * b[PEER_NODE * i + k];
        dmb_vec6_copy(e->scaled + (size_t)PEER_NODE * i + PEER_V, e->shift + layout->row[i]);
    }
    dmb_block_multiply(layout, &e->mass, 0, nodes, e->shift, e->force);
    for (uint32_t i = 0; i < nodes; i++)
        if (!is_constrained(e->scene, i))
            dmb_vec6_copy(e->force + layout->row[i], e->scaled + (size_t)PEER_NODE * i + PEER_V);
    equations_solve(e, e->scaled, x);
}

/* ---- Answers ----------------------------------------------------------------------------------------------------- */

/* Makes (t, y, y') the state that queries are asked of; for once, the start is gone. Turns are counted from the drive.
 */
static int32_t equations_finish(equations *e, double time, const double *y, const double *dy, double driven)
{
    dmb_sim *sim = e->sim;
    int32_t status = put_trial(e, time, y, dy);
    e->evaluation.tangent = 0;
    if (status >= 0) status = dmb_system_evaluate(&e->evaluation);
    for (uint32_t i = 0; i < e->scene->node_count; i++) {
        double q[4];
        dmb_quat_between(e->scene->reference_quaternion + 4 * (size_t)i, sim->trial.quaternion + 4 * (size_t)i, q);
        sim->trial.turn[i] = dmb_quat_twist(q, driven);
    }
    const dmb_configuration start = sim->now;
    sim->now = sim->trial;
    sim->trial = start;
    sim->clock->time = time;
    return status;
}

#endif
