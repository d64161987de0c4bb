/* Projection of a trial onto its constraints, at all three levels in this order (eq:joints.projection):
 *     poses           Newton on C = 0 by shortest moves, until rounding (2e-15 of the size) or stagnation below 2e-10
 *     speeds          one shortest change with B v + rate = 0
 *     accelerations   one shortest change with B v' + convective = 0, a by the same change times pseudo_factor
 * It ends with the factors of the partition (dmb_clusters_factor). A projection that stagnates above 2e-10, or whose
 * rows are dependent, fails: DMB_ERR_NO_CONVERGENCE, DMB_ERR_SINGULAR; the step is then divided. */
#include <string.h>

#include "math/se3.h"
#include "sim/layout.h"
#include "system/constrain/constrain.h"
#include "system/constrain/rotor.h"

/* ---- The trial --------------------------------------------------------------------------------------------------- */

/* [-] Violation over the size of the scene at which projections end; they also end when stagnating. */
#define DMB_SETTLED 2e-15
#define DMB_SETTLE_MAX 30
/* [-] Violation over the size above which a stagnating projection has failed. */
#define DMB_UNSETTLED 2e-10
/* [-] Longest move of one iteration of the assembly, in lengths of parts, unless parts are further apart. */
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

/* Shortest change x with B x = d, d by constraint row, into cluster_move. That of sparse components is already
 * computed. By eq:joints.projection with the weights cluster_metric. */
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

/* Change of a rotor's acceleration with its speed. */
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

/* Changes increment, velocity and accelerations by the projection of the pose, as Newmark's formulas require
 * (eq:integration.projection). Otherwise a component of z across the constraints would remain, as large as the distance
 * covered by Newton, and the result would depend on the choice of coordinates. */
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

/* [m] Size that scales the rounding of positions: lengths of the parts and distance of nodes from their reference
 * positions. */
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

/* Moves the poses by the shortest change that makes C = 0, but none by more than `most` [m]; with `step` also the
 * motion of the step. Returns the largest move [m]. */
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

/* Newton on C = 0 until rounding; motion 1: within a step. Ends at rounding, or where the violation no longer halves
 * below DMB_UNSETTLED: near-singular rows amplify the rounding of positions. Each move changes poses, hence the rows
 * are evaluated again after it; the last evaluation belongs to the result. */
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

/* Changes v by the shortest change so that B v + level = 0; `also` changes by factor times that. */
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

static void copy_raw(dmb_sim *sim)
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

/* In a step (from_raw) velocity and accelerations start from the raw motion, which Newton corrects and which no
 * projection of speeds or accelerations has changed. Near-redundant rows are left out of speeds and accelerations, not
 * of poses. After the speeds the rows are evaluated again, because convective terms depend on them; a rotor's
 * accelerations follow its speed (dmb_rotors_follow). */
int32_t dmb_clusters_settle(dmb_evaluation *evaluation, int32_t levels, int32_t from_raw)
{
    dmb_sim *sim = evaluation->sim;
    int32_t status = DMB_OK;
    if (from_raw) copy_raw(sim);
    if (from_raw &&
        !evaluation
             ->extrapolated) /* first iteration of a step: initial values for methods that solve for multipliers */
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
    if (status >= 0 && levels & DMB_SETTLE_ACCELERATION) /* a changes with v' by the recursion of the method */
        settle_rows(sim, sim->constraint_convective, sim->trial.acceleration, sim->trial.pseudo_acceleration,
                    evaluation->pseudo_factor);
    return status < 0 ? status : dmb_clusters_factor(sim);
}
