/* Projection of a trial onto its constraints, at all three levels (eq:joints.projection). */
#include <string.h>

#include "math/se3.h"
#include "sim/layout.h"
#include "system/constrain/constrain.h"
#include "system/constrain/rotor.h"

/* ---- The trial --------------------------------------------------------------------------------------------------- */

/* Projections onto the constraints end at this violation times the size of the scene, or when they no longer help. */
#define DMB_SETTLED 2e-15
#define DMB_SETTLE_MAX 30
/* A projection that ends above this part of the size has failed. */
#define DMB_UNSETTLED 2e-10
/* Longest step of putting a scene together, in lengths of its parts, unless parts are further apart. */
#define DMB_CORRECTION_MOST 0.3

static int32_t factor_gram(dmb_sim *sim)
{
    for (uint32_t k = 0; k < sim->scene->cluster_count; k++) {
        const dmb_cluster *cluster = sim->scene->clusters + k;
        const dmb_partition partition = dmb_cluster_partition(sim, k);
        if (cluster->sparse) continue;
        if (dmb_partition_gram(&(dmb_jacobian){dmb_cluster_matrix(sim, cluster), cluster->columns,
                                               sim->cluster_metric + cluster->column},
                               &partition, sim->cluster_gram + cluster->square) < 0)
            return dmb_cluster_singular(sim, cluster->row, 0.0);
    }
    return sim->scene->sparse_count ? dmb_sparse_factor(sim, 0) : DMB_OK;
}

/* Shortest change of the rows of a cluster with B x = d, d by constraint row, into cluster_move. That of sparse
 * clusters has been found before. */
static const double *shortest(dmb_sim *sim, uint32_t k, const double *d)
{
    const dmb_cluster *cluster = sim->scene->clusters + k;
    if (cluster->sparse) {
        dmb_sparse_get(sim, k, sim->cluster_move);
        return sim->cluster_move;
    }
    const dmb_partition partition = dmb_cluster_partition(sim, k);
    for (uint32_t i = 0; i < partition.rank; i++) sim->cluster_rows[i] = d[cluster->row + partition.row_order[i]];
    dmb_partition_project(
        &(dmb_jacobian){dmb_cluster_matrix(sim, cluster), cluster->columns, sim->cluster_metric + cluster->column},
        &partition, sim->cluster_gram + cluster->square, sim->cluster_rows, sim->cluster_move);
    return sim->cluster_move;
}

/* The part of the acceleration of a rotor that follows its speed. */
static void turn_motion(const dmb_evaluation *step, uint32_t node, const double dz[6])
{
    const dmb_sim *sim = step->sim;
    const uint32_t rotor = dmb_rotor_on(sim->scene, node), row = sim->scene->layout.row[node];
    double *const to[4] = {sim->raw_acceleration, sim->raw_pseudo_acceleration, sim->trial.acceleration,
                           sim->trial.pseudo_acceleration};
    double turning[6];
    if (rotor == DMB_NONE) return;
    dmb_rotor_turning(sim, rotor, dz, turning);
    for (int k = 0; k < 4; k++)
        for (uint32_t i = 0; i < 6; i++) to[k][row + i] -= step->velocity_factor * turning[i];
}

/* In a step speeds and accelerations follow the pose by Newmark's formulas, so they and the increment z follow its
 * projection too (eq:integration.projection). A part of z across the constraints would stay there, as
 * large as the way that Newton has come by, and be felt in the motion: it would depend on the choice of coordinates. */
static void move_motion(const dmb_evaluation *step, uint32_t node, const double *x)
{
    dmb_sim *sim = step->sim;
    const uint32_t size = sim->scene->layout.size[node], row = sim->scene->layout.row[node];
    const double factor[3] = {step->velocity_factor, step->mass_factor, step->mass_factor * step->pseudo_factor};
    double *const raw[3] = {sim->raw_velocity, sim->raw_acceleration, sim->raw_pseudo_acceleration};
    double *const trial[3] = {sim->trial.velocity, sim->trial.acceleration, sim->trial.pseudo_acceleration};
    double dz[6] = {x[0], x[1]};
    if (size == DMB_NODE_SIX_DOF) {
        dmb_se3_inverse_tangent T;
        dmb_se3_inverse_tangent_at(sim->increment + row, NULL, &T);
        dmb_se3_tangent_apply(&T, x, dz);
    }
    for (uint32_t i = 0; i < size; i++) {
        if (!sim->scene->solved_row[row + i]) continue;
        sim->increment[row + i] += dz[i];
        for (int k = 0; k < 3; k++) {
            raw[k][row + i] += factor[k] * dz[i];
            trial[k][row + i] += factor[k] * dz[i];
        }
    }
    if (sim->scene->rotor_count) turn_motion(step, node, dz);
}

void dmb_trial_move_node(dmb_sim *sim, uint32_t node, const double *x)
{
    if (sim->scene->layout.size[node] == DMB_NODE_SIX_DOF) {
        dmb_se3_advance(sim->trial.quaternion + 4 * (size_t)node, sim->trial.displacement + 3 * (size_t)node, x);
        return;
    }
    sim->trial.displacement[3 * (size_t)node] += x[0];
    sim->trial.turn[node] += x[1];
}

static void move_by(dmb_sim *sim, const dmb_evaluation *step, uint32_t node, const double *x)
{
    dmb_trial_move_node(sim, node, x);
    if (step != NULL) move_motion(step, node, x);
}

/* [m] size that rounding of positions goes with: how far nodes are from where they are measured from. */
static double scene_size(const dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    double far = 0.0;
    for (uint32_t i = 0; i < scene->constraint_node_count; i++) {
        const double *u = sim->trial.displacement + 3 * (size_t)scene->cluster_nodes[i];
        far = fmax(far, fmax(fabs(u[0]), fmax(fabs(u[1]), fabs(u[2]))));
    }
    return sim->reduced_mode->size + far;
}

/* Moves the poses by the shortest change that makes C = 0, but none by more than `most` [m], and with them the motion
 * of a step, NULL: none. Returns the largest. */
static double move_poses(dmb_sim *sim, double most, const dmb_evaluation *step)
{
    const dmb_scene *scene = sim->scene;
    double largest = 0.0;
    if (scene->sparse_count) dmb_sparse_project(sim, sim->constraint_value);
    for (uint32_t k = 0; k < scene->cluster_count; k++) {
        const dmb_cluster *cluster = scene->clusters + k;
        const double *x = shortest(sim, k, sim->constraint_value);
        double here = 0.0;
        const double *weight = sim->cluster_weight + cluster->column;
        for (uint32_t i = 0; i < cluster->columns; i++)
            if (weight[i] > 0.0) here = fmax(here, fabs(x[i]) / weight[i]);
        const double factor = here > most ? -most / here : -1.0;
        largest = fmax(largest, here);
        for (uint32_t i = 0; i < cluster->columns; i++) sim->cluster_move[i] = factor * x[i];
        for (uint32_t i = cluster->node; i < cluster->node + cluster->node_count; i++)
            move_by(sim, step, scene->cluster_nodes[i], sim->cluster_move + scene->node_place[scene->cluster_nodes[i]]);
    }
    return largest;
}

int32_t dmb_clusters_correct(dmb_evaluation *evaluation)
{
    dmb_sim *sim = evaluation->sim;
    int32_t status = dmb_clusters_assemble(evaluation);
    if (status < 0) return status;
    dmb_clusters_choose(sim);
    status = factor_gram(sim);
    if (status < 0) return status;
    return move_poses(sim, DMB_CORRECTION_MOST * sim->reduced_mode->length, NULL) <= DMB_SETTLED * scene_size(sim)
               ? DMB_NOTE_STOPPED
               : DMB_OK;
}

/* Newton on C = 0 until rounding; `motion` 1: of a step. */
static int32_t settle_poses(dmb_evaluation *evaluation, int32_t motion)
{
    dmb_sim *sim = evaluation->sim;
    const double size = scene_size(sim);
    double last = (double)INFINITY;
    uint32_t row = 0;
    for (uint32_t k = 0;; k++) {
        int32_t status = dmb_clusters_assemble(evaluation);
        if (status < 0) return status;
        const double violation = dmb_clusters_pivot_violation(sim, &row);
        const int done =
            violation <= DMB_SETTLED * size || (violation < DMB_UNSETTLED * size && violation > 0.5 * last);
        if (done || k == DMB_SETTLE_MAX || !isfinite(violation)) {
            if (violation < DMB_UNSETTLED * size) return factor_gram(sim);
            (void)dmb_cluster_singular(sim, row, fabs(sim->constraint_value[row]));
            return DMB_ERR_NO_CONVERGENCE;
        }
        status = factor_gram(sim);
        if (status < 0) return status;
        last = violation;
        (void)move_poses(sim, (double)INFINITY, motion ? evaluation : NULL);
    }
}

/* v so that B v + rate = 0; `level` rows of what B v must cancel. */
static void settle_rows(dmb_sim *sim, const double *level, double *v, double *also, double factor)
{
    const dmb_scene *scene = sim->scene;
    double *d = sim->cluster_scratch;
    if (scene->sparse_count) {
        dmb_sparse_deficit(sim, level, v, d);
        dmb_sparse_project(sim, d);
    }
    for (uint32_t k = 0; k < scene->cluster_count; k++) {
        const dmb_cluster *cluster = scene->clusters + k;
        const uint32_t *row_of = scene->cluster_columns + cluster->column;
        const double *B = dmb_cluster_matrix(sim, cluster);
        for (uint32_t r = 0; r < (cluster->sparse ? 0 : cluster->rows); r++) {
            double sum = level[cluster->row + r];
            for (uint32_t c = 0; c < cluster->columns; c++) sum += B[(size_t)r * cluster->columns + c] * v[row_of[c]];
            d[cluster->row + r] = -sum;
        }
        const double *x = shortest(sim, k, d);
        for (uint32_t c = 0; c < cluster->columns; c++) {
            v[row_of[c]] += x[c];
            if (also != NULL) also[row_of[c]] += factor * x[c];
        }
    }
}

static void take_raw(dmb_sim *sim)
{
    const size_t bytes = sim->scene->row_count * sizeof(double);
    memcpy(sim->trial.velocity, sim->raw_velocity, bytes);
    memcpy(sim->trial.acceleration, sim->raw_acceleration, bytes);
    memcpy(sim->trial.pseudo_acceleration, sim->raw_pseudo_acceleration, bytes);
}

static void drop_near_redundant(dmb_sim *sim)
{
    for (uint32_t k = 0; k < sim->scene->cluster_count; k++) {
        const dmb_cluster *cluster = sim->scene->clusters + k;
        const dmb_partition partition = dmb_cluster_partition(sim, k);
        if (cluster->sparse) continue;
        dmb_partition_drop_near_redundant(
            &(dmb_jacobian){dmb_cluster_matrix(sim, cluster), cluster->columns, sim->cluster_metric + cluster->column},
            &partition, sim->cluster_gram + cluster->square);
    }
    if (sim->scene->sparse_count && sim->reduced_mode->near_redundant) (void)dmb_sparse_factor(sim, 1);
}

int32_t dmb_clusters_settle(dmb_evaluation *evaluation, int32_t levels, int32_t from_raw)
{
    dmb_sim *sim = evaluation->sim;
    int32_t status = DMB_OK;
    if (from_raw) take_raw(sim);
    if (from_raw && !evaluation->extrapolated) /* the first iteration of a step, which may solve for them */
        memcpy(sim->trial.multiplier, sim->now.multiplier, sim->scene->constraint_row_count * sizeof(double));
    if (levels & DMB_SETTLE_POSE)
        status = settle_poses(evaluation, from_raw);
    else
        status = dmb_clusters_assemble(evaluation);
    if (status >= 0 && !(levels & DMB_SETTLE_POSE)) status = factor_gram(sim);
    if (status >= 0 && from_raw) drop_near_redundant(sim);
    if (status >= 0 && levels & DMB_SETTLE_SPEED) {
        settle_rows(sim, sim->constraint_rate, sim->trial.velocity, NULL, 0.0);
        if (from_raw && sim->scene->rotor_count) dmb_rotors_follow(sim, sim->raw_velocity);
        status = dmb_constraint_rows(evaluation);
    }
    if (status >= 0 && levels & DMB_SETTLE_ACCELERATION) /* the recursion of a goes with that of v' */
        settle_rows(sim, sim->constraint_convective, sim->trial.acceleration, sim->trial.pseudo_acceleration,
                    evaluation->pseudo_factor);
    return status < 0 ? status : dmb_clusters_factor(sim);
}
