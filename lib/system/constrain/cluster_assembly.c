/* Assembly: joints closed at the start (lib/theory/joints.md). The first row of the table that closes all joints
 * without a flipped joint is the result; if none does, the assembly fails with DMB_ERR_GEOMETRY.
 *
 *     start of the moves                          movable, in this order
 *     -----------------------------------------   ---------------------------------------------------------------------
 *     1 poses as described                        bodies; strings as rigid bodies within their supports
 *     2 poses placed by joints one after the      the same; closes chains and trees over any distance and rotation
 *       other (cluster_placement)
 *     3 poses as described                        the same, then all nodes, which strains elements
 *
 * Scenes without elements move all nodes in each row. Sparse components move all nodes at once; in scenes with
 * elements, in row 3 only, unless nothing is left to close. Bodies and nodes move by Newton's iteration in the
 * coordinates of a partition (Wehage, Haug 1982); if redundant equations change its choice without end, and for
 * strings as rigid bodies, by the iteration of Levenberg and Marquardt, which uses all equations at once
 * (eq:joints.levenberg). */
#include <string.h>

#include "math/mat6.h"
#include "math/se3.h"
#include "math/so3.h"
#include "sim/layout.h"
#include "sim/node.h"
#include "system/constrain/constrain.h"

enum { DMB_ASSEMBLY_MAX = 200, DMB_ASSEMBLY_STALLED = 30 };
#define DMB_ASSEMBLY_CLOSED 1e-13 /* [-] violation of closed joints over the length of the parts */
/* [m, -] Largest violation of a redundant equation, or at the end. */
#define DMB_ASSEMBLY_VIOLATION 1e-8

static void set_up(dmb_sim *sim, dmb_evaluation *evaluation)
{
    memset(evaluation, 0, sizeof *evaluation);
    evaluation->sim = sim;
    evaluation->time = sim->clock->time;
    evaluation->load_factor = evaluation->pseudo_factor = 1.0;
}

/* Joint states as described; a joint locked from the start is locked in its described pose. */
static void described_states(dmb_sim *sim)
{
    for (uint32_t j = 0; j < sim->scene->joint_count; j++) {
        const int32_t state = sim->scene->joints[j].state;
        dmb_joint_place_find(sim, j);
        if (state != DMB_JOINT_LOCKED) dmb_joint_hold(sim, j); /* until it is locked */
        dmb_joint_set_state(sim, j, state);
    }
}

static int32_t check_callbacks(dmb_sim *sim)
{
    for (uint32_t i = 0; i < sim->scene->callback_count; i++) {
        const int32_t status = dmb_callback_check(sim, i);
        if (status < 0) return status;
    }
    return DMB_OK;
}

static int32_t refuse(dmb_sim *sim, uint32_t row, double violation, const char *what)
{
    sim->reduced_mode->row = row;
    sim->reduced_mode->violation = violation;
    dmb_clusters_explain(sim, what);
    return DMB_ERR_GEOMETRY;
}

/* ---- Distances --------------------------------------------------------------------------------------------------- */

static int is_closed(dmb_sim *sim, uint32_t *row)
{
    return dmb_clusters_violation(sim, 0, row) <= DMB_ASSEMBLY_VIOLATION * sim->reduced_mode->length;
}

/* ---- Levenberg and Marquardt ------------------------------------------------------------------------------------- */

#define DMB_DAMPING_MOST 1e-2 /* [-] damping over the diagonal */
#define DMB_DAMPING_LEAST 1e-13

/* G = B W^2 B^T, its diagonal times 1 + damping (eq:joints.levenberg); 1 in rows without entries. */
static void fill_gram(dmb_sim *sim, const dmb_cluster *cluster, double damping, double *G)
{
    const double *B = dmb_cluster_matrix(sim, cluster), *metric = sim->cluster_metric + cluster->column;
    const size_t n = cluster->rows, columns = cluster->columns;
    for (size_t r = 0; r < n; r++) {
        for (size_t s = 0; s <= r; s++) {
            double sum = 0.0;
            for (size_t c = 0; c < columns; c++) sum += B[r * columns + c] * metric[c] * metric[c] * B[s * columns + c];
            G[r * n + s] = sum;
        }
        G[r * n + r] = G[r * n + r] > 0.0 ? G[r * n + r] * (1.0 + damping) : 1.0;
    }
}

/* Solves A x = b in place by Cholesky factors of A, given by its lower triangle; pivots of rounding size become those
 * of the damping. */
static void solve_symmetric(size_t n, double *A, double *b)
{
    for (size_t k = 0; k < n; k++) {
        const double least = DMB_DAMPING_LEAST * A[k * n + k];
        for (size_t j = 0; j < k; j++) A[k * n + k] -= A[k * n + j] * A[k * n + j];
        A[k * n + k] = sqrt(fmax(A[k * n + k], fmax(least, 1e-300)));
        for (size_t r = k + 1; r < n; r++) {
            for (size_t j = 0; j < k; j++) A[r * n + k] -= A[r * n + j] * A[k * n + j];
            A[r * n + k] /= A[k * n + k];
        }
        for (size_t j = 0; j < k; j++) b[k] -= A[k * n + j] * b[j];
        b[k] /= A[k * n + k];
    }
    for (size_t k = n; k-- > 0;) {
        for (size_t r = k + 1; r < n; r++) b[k] -= A[r * n + k] * b[r];
        b[k] /= A[k * n + k];
    }
}

/* x of eq:joints.levenberg by column into cluster_move. As the damping goes to 0 with the violation squared, the
 * iteration becomes Newton's near the solution; away from it, rows that depend on each other share the move instead of
 * making it infinite. */
static void damped_move(dmb_sim *sim, uint32_t k, double damping)
{
    const dmb_cluster *cluster = sim->scene->clusters + k;
    const double *B = dmb_cluster_matrix(sim, cluster), *metric = sim->cluster_metric + cluster->column;
    double *G = sim->cluster_gram + cluster->square, *y = sim->cluster_rows;
    fill_gram(sim, cluster, damping, G);
    memcpy(y, sim->constraint_value + cluster->row, cluster->rows * sizeof *y);
    solve_symmetric(cluster->rows, G, y);
    for (uint32_t c = 0; c < cluster->columns; c++) {
        double sum = 0.0;
        for (uint32_t r = 0; r < cluster->rows; r++) sum += B[(size_t)r * cluster->columns + c] * y[r];
        sim->cluster_move[c] = -metric[c] * metric[c] * sum;
    }
}

/* Factor on a move of a component that rotates no node by more than DMB_TURN_MOST and moves none further than the
 * distance of the parts. */
#define DMB_TURN_MOST 0.5 /* [rad] */
static double part_of_move(const dmb_sim *sim, const dmb_cluster *cluster, double apart)
{
    const dmb_scene *scene = sim->scene;
    double most = 1.0;
    for (uint32_t i = cluster->node; i < cluster->node + cluster->node_count; i++) {
        const uint32_t node = scene->cluster_nodes[i], size = scene->layout.size[node];
        const double *x = sim->cluster_move + scene->node_place[node];
        for (uint32_t c = 0; c < size; c++)
            most = fmax(most,
                        2 * c < size ? fabs(x[c]) / (apart + sim->reduced_mode->length) : fabs(x[c]) / DMB_TURN_MOST);
    }
    return 1.0 / most;
}

/* ---- Chains as rigid bodies -------------------------------------------------------------------------------------- */

/* Twist of node i, in its axes, for unit component c of the twist of the base. */
static void column_of(const dmb_sim *sim, uint32_t base, uint32_t i, uint32_t c, double column[6])
{
    const dmb_scene *scene = sim->scene;
    double unit[6] = {0.0}, R[9], Ri[9], x[3], xi[3], turn[9], arm[3], away[3];
    unit[c] = 1.0;
    dmb_node_pose(scene, &sim->trial, base, R, x);
    dmb_node_pose(scene, &sim->trial, i, Ri, xi);
    dmb_vec3_add(x, scene->reference_position + 3 * (size_t)base, x);
    dmb_vec3_add(xi, scene->reference_position + 3 * (size_t)i, xi);
    dmb_vec3_sub(xi, x, away);
    dmb_mat3_tvec(R, away, arm);
    dmb_mat3_mul_tn(R, Ri, turn);
    dmb_adjoint_inverse_apply(turn, arm, unit, column);
}

/* Least-squares twist z of the base from the required twists x of the jointed nodes of the chain. Normal equations of
 * sum |W (J z - x)|^2 over the jointed nodes, W the length of the chain for rotations; components of z that supports of
 * the base constrain are left out. 1e-12 on the diagonal makes z = 0 of what no joint determines. */
static void fit_twist(const dmb_sim *sim, const dmb_chain *chain, uint32_t base, const double open[6], const double *x,
                      double z[6])
{
    const dmb_scene *scene = sim->scene;
    double A[36] = {0.0}, J[6][6];
    for (int c = 0; c < 6; c++) z[c] = 0.0;
    for (uint32_t i = chain->first; i < chain->first + chain->count; i++) {
        if (scene->node_cluster[i] == DMB_NONE) continue;
        for (uint32_t c = 0; c < 6; c++) column_of(sim, base, i, c, J[c]);
        for (int r = 0; r < 6; r++)
            for (int k = 0; k < 6; k++) {
                const double weight = k < 3 ? 1.0 : chain->length * chain->length;
                z[r] += open[r] * weight * J[r][k] * x[scene->layout.row[i] + (uint32_t)k];
                for (int c = 0; c <= r; c++) A[6 * r + c] += open[r] * open[c] * weight * J[r][k] * J[c][k];
            }
    }
    for (int r = 0; r < 6; r++) A[7 * r] = open[r] == 0.0 || !(A[7 * r] > 0.0) ? 1.0 : A[7 * r] * (1.0 + 1e-12);
    solve_symmetric(6, A, z);
}

/* Moves the whole chain with the twist z of its base. */
static void move_chain(dmb_sim *sim, const dmb_chain *chain, uint32_t base, const double z[6])
{
    const dmb_scene *scene = sim->scene;
    dmb_rigid_motion motion = {.node = base};
    double before[9], after[9];
    dmb_node_pose(scene, &sim->trial, base, before, motion.before);
    dmb_trial_move_node(sim, base, z);
    dmb_node_pose(scene, &sim->trial, base, after, motion.after);
    dmb_mat3_mul_nt(after, before, motion.Q);
    dmb_chain_follow(sim, chain, &motion);
}

/* Moves of all components, by row into `increment`, limited for the largest violation `apart`. */
static void assemble_moves(dmb_sim *sim, double damping, double apart)
{
    const dmb_scene *scene = sim->scene;
    memset(sim->increment, 0, scene->row_count * sizeof(double));
    for (uint32_t k = 0; k < scene->cluster_count; k++) {
        const dmb_cluster *cluster = scene->clusters + k;
        damped_move(sim, k, damping);
        const double part = part_of_move(sim, cluster, apart);
        for (uint32_t c = 0; c < cluster->columns; c++)
            sim->increment[scene->cluster_columns[cluster->column + c]] = part * sim->cluster_move[c];
    }
}

static void apply_moves(dmb_sim *sim, int rigid)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t c = 0; c < scene->chain_count; c++) {
        const dmb_chain *chain = scene->chains + c;
        double open[6], z[6];
        if (rigid && chain->count > 1) {
            const uint32_t base = dmb_chain_base(scene, chain, open);
            if (base == DMB_NONE || !chain->jointed) continue;
            fit_twist(sim, chain, base, open, sim->increment, z);
            move_chain(sim, chain, base, z);
            continue;
        }
        for (uint32_t i = chain->first; i < chain->first + chain->count; i++)
            if (scene->node_cluster[i] != DMB_NONE) dmb_trial_move_node(sim, i, sim->increment + scene->layout.row[i]);
    }
}

/* Levenberg-Marquardt iteration until all joints are closed or the violation stagnates. It stagnates if the violation
 * has not fallen by a tenth in DMB_ASSEMBLY_STALLED iterations. */
static int32_t iterate_damped(dmb_evaluation *evaluation, int rigid)
{
    dmb_sim *sim = evaluation->sim;
    double best = (double)INFINITY;
    uint32_t row = 0, stalled = 0;
    for (uint32_t k = 0; k < DMB_ASSEMBLY_MAX && stalled < DMB_ASSEMBLY_STALLED; k++) {
        const int32_t status = dmb_clusters_assemble(evaluation);
        if (status < 0) return status;
        const double apart = dmb_clusters_violation(sim, 0, &row), part = apart / sim->reduced_mode->length;
        if (part <= DMB_ASSEMBLY_CLOSED) break;
        stalled = apart < 0.9 * best ? 0 : stalled + 1;
        best = fmin(best, apart);
        assemble_moves(sim, fmax(DMB_DAMPING_LEAST, fmin(DMB_DAMPING_MOST, part * part)), apart);
        apply_moves(sim, rigid);
    }
    const int32_t status = dmb_clusters_assemble(evaluation);
    if (status >= 0) dmb_clusters_choose(sim);
    return status;
}

/* ---- The three attempts ------------------------------------------------------------------------------------------ */

/* Newton iteration with a new choice of partition each time, because the rank may change. */
static int32_t iterate_newton(dmb_evaluation *evaluation)
{
    int32_t status = DMB_OK;
    for (uint32_t k = 0; k < DMB_ASSEMBLY_MAX && status >= 0; k++) {
        uint32_t row;
        status = dmb_clusters_correct(evaluation);
        (void)dmb_clusters_violation(evaluation->sim, 0, &row);
        if (status == DMB_NOTE_STOPPED) return DMB_OK; /* no node moves any more */
    }
    return status;
}

enum { BODIES_MOVE, CHAINS_MOVE, NODES_MOVE };

/* Newton first; where it leaves joints open, the damped iteration continues from there. Sparse components have no dense
 * matrix for the latter. */
static int32_t move_parts(dmb_evaluation *evaluation, int movers)
{
    dmb_sim *sim = evaluation->sim;
    uint32_t row = 0;
    dmb_clusters_weigh(sim, movers == BODIES_MOVE);
    int32_t status = movers == CHAINS_MOVE ? iterate_damped(evaluation, 1) : iterate_newton(evaluation);
    if (status == DMB_ERR_CALLBACK || movers == CHAINS_MOVE || sim->scene->sparse_count) return status;
    if (status >= 0 && is_closed(sim, &row)) return status;
    return iterate_damped(evaluation, 0);
}

static int has_elements(const dmb_scene *scene)
{
    return scene->element_count > 0;
}

/* [rad] dmb_joint_flip of the trial: angle between axes that the joint keeps parallel; 0 if they do not oppose. */
static double flip_of(const dmb_sim *sim, uint32_t joint)
{
    const int locked = sim->joint_state[joint] == DMB_JOINT_LOCKED;
    dmb_relative relative;
    double R[9];
    if (sim->joint_state[joint] == DMB_JOINT_OPEN) return 0.0;
    dmb_joint_motion_of(sim->scene, &sim->trial, joint, &relative, NULL);
    dmb_mat3_copy(relative.R, R);
    if (locked) dmb_mat3_mul_nt(relative.R, sim->joint_lock + 12 * (size_t)joint, R);
    return dmb_joint_flip(locked ? DMB_JOINT_FIXED : sim->scene->joints[joint].kind, R);
}

static int any_flip(const dmb_sim *sim)
{
    for (uint32_t j = 0; j < sim->scene->joint_count; j++)
        if (flip_of(sim, j) != 0.0) return 1;
    return 0;
}

int32_t dmb_joint_refuse_flip(dmb_sim *sim, uint32_t joint)
{
    const double angle = flip_of(sim, joint);
    dmb_message owner;
    if (angle == 0.0) return DMB_OK;
    dmb_constraint_text(sim->scene, sim->scene->joints[joint].constraint, &owner);
    dmb_message_set(&sim->message, "%s: turned over: axes that it keeps parallel are %g rad apart at time %g",
                    owner.text, angle, sim->clock->time);
    return DMB_ERR_GEOMETRY;
}

/* Starts of the moves (table at the head of this file). */
enum { FROM_DESCRIBED, FROM_PLACED, FROM_DESCRIBED_STRAINING, STARTS };

/* Scenes with sparse components: all nodes move at once, which strains elements unless nothing is left to close. */
static int32_t close_sparse(dmb_evaluation *evaluation, int start, int *closed)
{
    dmb_sim *sim = evaluation->sim;
    uint32_t row = 0;
    int32_t status = dmb_clusters_assemble(evaluation);
    *closed = 0;
    if (status < 0) return status;
    dmb_clusters_choose(sim);
    if (has_elements(sim->scene) && start != FROM_DESCRIBED_STRAINING && !is_closed(sim, &row)) return status;
    status = move_parts(evaluation, NODES_MOVE);
    *closed = status >= 0 && is_closed(sim, &row);
    return status;
}

static int32_t close_dense(dmb_evaluation *evaluation, int start, int *closed)
{
    dmb_sim *sim = evaluation->sim;
    const int rigid = has_elements(sim->scene) && start != FROM_DESCRIBED_STRAINING;
    uint32_t row = 0;
    int32_t status = DMB_OK;
    *closed = 0;
    for (int movers = has_elements(sim->scene) ? BODIES_MOVE : NODES_MOVE;
         movers <= (rigid ? CHAINS_MOVE : NODES_MOVE) && !*closed && status != DMB_ERR_CALLBACK; movers++) {
        status = move_parts(evaluation, movers);
        *closed = status >= 0 && is_closed(sim, &row);
    }
    return status;
}

/* Rows 2 and 3 of the table begin from the described poses, not from those that the row before has left. */
static int32_t close_from(dmb_evaluation *evaluation, int start, int *closed)
{
    dmb_sim *sim = evaluation->sim;
    if (start != FROM_DESCRIBED) dmb_configuration_copy(sim, &sim->now, &sim->trial);
    if (start == FROM_PLACED) dmb_place_by_joints(sim);
    dmb_clusters_weigh(sim, 0);
    return sim->scene->sparse_count ? close_sparse(evaluation, start, closed) : close_dense(evaluation, start, closed);
}

/* Tries the starts in order. A closed but flipped joint counts as open while another start remains. */
static int32_t close_positions(dmb_evaluation *evaluation)
{
    dmb_sim *sim = evaluation->sim;
    int32_t status = DMB_OK;
    int closed = 0;
    for (int start = FROM_DESCRIBED; start < STARTS && status != DMB_ERR_CALLBACK; start++) {
        status = close_from(evaluation, start, &closed);
        if (closed && !any_flip(sim)) break;
    }
    dmb_clusters_weigh(sim, 0);
    if (closed) {
        dmb_clusters_choose(sim); /* choice among the coordinates of all parts */
        return DMB_OK;
    }
    if (status == DMB_ERR_CALLBACK) {
        dmb_message owner;
        dmb_constraint_text(sim->scene, dmb_constraint_of_row(sim->scene, sim->reduced_mode->row), &owner);
        dmb_message_set(&sim->message, "%s: the callback failed or gave a value beyond +-1e30 at time %g", owner.text,
                        sim->clock->time);
        return status;
    }
    uint32_t row = DMB_NONE;
    (void)dmb_clusters_violation(sim, 0, &row);
    if (row == DMB_NONE) row = 0;
    return refuse(sim, row, fabs(sim->constraint_value[row]), "its parts cannot be brought together");
}

static int32_t refuse_flips(dmb_sim *sim)
{
    for (uint32_t j = 0; j < sim->scene->joint_count; j++) {
        const int32_t status = dmb_joint_refuse_flip(sim, j);
        if (status < 0) return status;
    }
    return DMB_OK;
}

/* Checks B v + rate = 0 in all rows, including dropped ones. */
int32_t dmb_assembled_speeds(dmb_evaluation *evaluation)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0; i < scene->constraint_count; i++) {
        const dmb_constraint *c = scene->constraints + i;
        for (uint32_t k = 0; k < c->rows; k++) {
            const double *B = sim->constraint_jacobian + c->jacobian + (size_t)k * c->columns;
            double sum = sim->constraint_rate[c->row + k], size = 1.0 + fabs(sum);
            for (uint32_t n = 0; n < c->node_count; n++)
                for (uint32_t s = 0; s < scene->layout.size[c->node[n]]; s++) {
                    const double part = B[c->column[n] + s] * sim->trial.velocity[scene->layout.row[c->node[n]] + s];
                    sum += part;
                    size += fabs(part); /* size of rounding, in the unit of the row */
                }
            if (fabs(sum) > DMB_ASSEMBLY_VIOLATION * size)
                return refuse(sim, c->row + k, sum, "its speed cannot be had");
        }
    }
    return DMB_OK;
}

static void measure(dmb_sim *sim)
{
    double *most = sim->counters->assembly;
    most[0] = most[1] = 0.0;
    for (uint32_t i = 0; i < sim->scene->node_count; i++) {
        double move[3], q[4], turn[3];
        dmb_vec3_sub(sim->trial.displacement + 3 * (size_t)i, sim->now.displacement + 3 * (size_t)i, move);
        dmb_quat_between(sim->now.quaternion + 4 * (size_t)i, sim->trial.quaternion + 4 * (size_t)i, q);
        dmb_quat_log(q, turn);
        most[0] = fmax(most[0], dmb_vec3_norm(move));
        most[1] = fmax(most[1], fmax(dmb_vec3_norm(turn), fabs(sim->trial.turn[i] - sim->now.turn[i])));
    }
}

void dmb_note_projection(dmb_sim *sim)
{
    const dmb_block_layout *layout = &sim->scene->layout;
    double *most = sim->counters->projection;
    for (uint32_t i = 0; i < sim->scene->node_count; i++)
        for (uint32_t c = 0; c < layout->size[i]; c++) {
            const uint32_t row = layout->row[i] + c, kind = 2 * c < layout->size[i] ? 0 : 1;
            most[kind] = fmax(most[kind], fabs(sim->trial.velocity[row] - sim->now.velocity[row]));
        }
}

static double coordinate_of(dmb_sim *sim, uint32_t j, int32_t component)
{
    dmb_relative relative;
    dmb_joint_coordinates c;
    dmb_joint_motion(sim->scene, &sim->trial, j, &relative, NULL);
    dmb_joint_coordinates_at(relative.R, relative.p, relative.V, sim->trial.joint_turn + 2 * (size_t)j, &c);
    return c.value[component];
}

/* Stores the turns of coordinates, the constants of couplings and the initial coordinates of drives of the closed
 * scene. */
static void keep_coordinates(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t j = 0; j < scene->joint_count; j++) {
        const dmb_scene_joint *joint = scene->joints + j;
        dmb_relative relative;
        dmb_joint_coordinates c;
        dmb_joint_motion(scene, &sim->trial, j, &relative, NULL);
        dmb_joint_coordinates_at(relative.R, relative.p, relative.V, joint->initial_position + 3, &c);
        dmb_joint_set_turns(sim, j, &c);
        for (uint32_t i = joint->first_drive; i < joint->first_drive + joint->drive_count; i++)
            sim->drive_offset[scene->joint_drives[i]] = c.value[scene->drives[scene->joint_drives[i]].component];
    }
    for (uint32_t i = 0; i < scene->coupling_count; i++) {
        const dmb_scene_coupling *coupling = scene->couplings + i;
        double sum = 0.0;
        for (uint32_t k = 0; k < coupling->count; k++)
            sum += coupling->factor[k] * coordinate_of(sim, coupling->joint[k], coupling->component[k]);
        sim->constraint_offset[scene->constraints[coupling->constraint].row] = sum;
    }
}

/* Order: Jacobians of callers' constraints against differences; units of columns; states of joints; poses; speeds; then
 * constants of the closed scene (revolutions, offsets of drives and couplings). During assembly given initial
 * coordinates are equations too, couplings and joint drives are not, since their constants are those of the closed
 * pose. The trial becomes the accepted state at the end: a failure changes no pose. */
int32_t dmb_assemble(dmb_sim *sim)
{
    dmb_evaluation evaluation;
    int32_t status = check_callbacks(sim);
    if (status < 0) return status;
    set_up(sim, &evaluation);
    dmb_clusters_prepare(sim);
    described_states(sim);
    dmb_configuration_copy(sim, &sim->now, &sim->trial);
    evaluation.assembling = 1;
    status = close_positions(&evaluation);
    if (status >= 0) status = dmb_clusters_settle(&evaluation, DMB_SETTLE_POSE | DMB_SETTLE_SPEED, 0);
    if (status >= 0) status = refuse_flips(sim);
    if (status >= 0) status = dmb_assembled_speeds(&evaluation);
    if (status < 0) return status;
    measure(sim);
    dmb_note_projection(sim);
    keep_coordinates(sim);
    dmb_configuration_copy(sim, &sim->trial, &sim->now);
    return DMB_OK;
}
