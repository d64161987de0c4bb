#include "system/cluster.h"

#include <float.h>
#include <string.h>

#include "math/se3.h"
#include "system/constraint_rows.h"

/* Projections onto the constraints end at this misfit times the size of the scene, or when they no longer help. */
#define DMB_SETTLED 2e-15
#define DMB_SETTLE_MAX 30
/* A projection that ends above this part of the size has failed. */
#define DMB_UNSETTLED 2e-10
/* The choice is made anew when its quality falls below this part of what it was. */
#define DMB_QUALITY_FALL 0.1
/* Longest step of putting a scene together, in lengths of its parts. */
#define DMB_APPROACH 0.3
/* Drives that a message names. */
enum { DMB_NAMED_DRIVES = 4 };

dmb_partition dmb_cluster_partition(const dmb_sim *sim, uint32_t k)
{
    const dmb_cluster *cluster = sim->scene->clusters + k;
    dmb_partition partition;
    partition.rows = cluster->rows;
    partition.columns = cluster->columns;
    partition.rank = sim->partition_rank[k];
    partition.reserved = 0;
    partition.row_order = sim->partition_row + cluster->row;
    partition.column_order = sim->partition_column + cluster->column;
    return partition;
}

static double *matrix_of(const dmb_sim *sim, const dmb_cluster *cluster)
{
    return sim->cluster_matrix + cluster->dense;
}

/* ---- Choice ------------------------------------------------------------------------------------------------------ */

/* Rotations of a body go with its whole extent, about twice its longest arm, in the choice of the partition. In
 * projections they weigh more: a step of rotation is more exact than that of the points it carries round, so those
 * should move rather (a disc that rolls: 7.1, 3.6, 1.2 in 1e-6 for a factor of 1, 2, 4). */
#define DMB_BODY_EXTENT 2.0
#define DMB_BODY_METRIC 10.0

/* Metres for translations, metres at the length of its chain for rotations; 0 for rows that are not solved. */
static void set_weights(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        const uint32_t k = scene->node_cluster[i], size = scene->layout.size[i];
        if (k == UINT32_MAX) continue;
        double *weight = sim->cluster_weight + scene->clusters[k].column + scene->node_place[i];
        double *metric = sim->cluster_metric + scene->clusters[k].column + scene->node_place[i];
        const dmb_chain *chain = scene->chains + scene->node_chain[i];
        const double length = chain->count > 1 ? chain->length : DMB_BODY_EXTENT * chain->length;
        for (uint32_t c = 0; c < size; c++) {
            weight[c] = 2 * c < size ? 1.0 : 1.0 / length;
            if (!scene->solved_row[scene->layout.row[i] + c]) weight[c] = 0.0;
            metric[c] = 2 * c < size || chain->count > 1 ? weight[c] : weight[c] * (DMB_BODY_EXTENT / DMB_BODY_METRIC);
        }
    }
}

static void note_places(dmb_sim *sim, uint32_t k)
{
    const dmb_cluster *cluster = sim->scene->clusters + k;
    const uint32_t *order = sim->partition_column + cluster->column;
    for (uint32_t i = 0; i < cluster->columns; i++) sim->cluster_place[cluster->column + order[i]] = i;
}

static void choose(dmb_sim *sim, uint32_t k)
{
    const dmb_cluster *cluster = sim->scene->clusters + k;
    dmb_partition partition = dmb_cluster_partition(sim, k);
    sim->partition_quality[k] =
        dmb_partition_choose(matrix_of(sim, cluster), cluster->columns, sim->cluster_weight + cluster->column,
                             sim->cluster_scratch, &partition);
    sim->partition_rank[k] = partition.rank;
    note_places(sim, k);
}

void dmb_clusters_choose(dmb_sim *sim)
{
    for (uint32_t k = 0; k < sim->scene->cluster_count; k++) choose(sim, k);
}

static uint32_t active_rows(const dmb_sim *sim, const dmb_cluster *cluster)
{
    uint32_t count = 0;
    for (uint32_t r = cluster->row; r < cluster->row + cluster->rows; r++)
        count += sim->constraint_type[r] != DMB_ROW_IDLE;
    return count;
}

/* A number that tells sets of dependent columns apart, in whatever order. */
static uint64_t mark_of_dependent(const dmb_sim *sim, uint32_t k)
{
    const uint32_t *order = sim->partition_column + sim->scene->clusters[k].column;
    uint64_t sum = sim->partition_rank[k];
    for (uint32_t i = 0; i < sim->partition_rank[k]; i++) {
        const uint64_t mixed = (order[i] + UINT64_C(1)) * UINT64_C(0x9E3779B97F4A7C15);
        sum += mixed ^ mixed >> 29;
    }
    return sum;
}

void dmb_clusters_watch(dmb_sim *sim)
{
    for (uint32_t k = 0; k < sim->scene->cluster_count; k++) {
        const int fallen = sim->cluster_quality[k] < DMB_QUALITY_FALL * sim->partition_quality[k];
        sim->partition_quality[k] = fmax(sim->partition_quality[k], sim->cluster_quality[k]);
        if (!fallen && sim->partition_rank[k] == active_rows(sim, sim->scene->clusters + k)) continue;
        const uint64_t before = mark_of_dependent(sim, k);
        choose(sim, k);
        sim->counters->switches += before != mark_of_dependent(sim, k);
    }
}

/* ---- Matrices ---------------------------------------------------------------------------------------------------- */

/* B of a cluster from the blocks of its constraints. */
static void gather_matrix(dmb_sim *sim, const dmb_cluster *cluster)
{
    const dmb_scene *scene = sim->scene;
    double *B = matrix_of(sim, cluster);
    memset(B, 0, (size_t)cluster->rows * cluster->columns * sizeof(double));
    for (uint32_t i = cluster->constraint; i < cluster->constraint + cluster->constraint_count; i++) {
        const dmb_constraint *c = scene->constraints + i;
        for (uint32_t k = 0; k < c->rows; k++) {
            const double *from = sim->constraint_jacobian + c->jacobian + (size_t)k * c->columns;
            double *to = B + (size_t)(c->row - cluster->row + k) * cluster->columns;
            for (uint32_t n = 0; n < c->node_count; n++)
                memcpy(to + scene->node_place[c->node[n]], from + c->column[n],
                       scene->layout.size[c->node[n]] * sizeof(double));
        }
    }
}

int32_t dmb_clusters_gather(dmb_evaluation *evaluation)
{
    dmb_sim *sim = evaluation->sim;
    const int32_t status = dmb_constraint_rows(evaluation);
    for (uint32_t k = 0; k < sim->scene->cluster_count && status >= 0; k++)
        gather_matrix(sim, sim->scene->clusters + k);
    return status;
}

static int32_t singular(dmb_sim *sim, uint32_t row, double misfit)
{
    sim->linked_mode->row = row;
    sim->linked_mode->misfit = misfit;
    return DMB_ERR_SINGULAR;
}

static int32_t factor_dependent(dmb_sim *sim)
{
    for (uint32_t k = 0; k < sim->scene->cluster_count; k++) {
        const dmb_cluster *cluster = sim->scene->clusters + k;
        const dmb_partition partition = dmb_cluster_partition(sim, k);
        note_places(sim, k); /* the choice may have come back with an older state */
        sim->cluster_quality[k] =
            dmb_partition_factor(matrix_of(sim, cluster), cluster->columns, sim->cluster_weight + cluster->column,
                                 &partition, sim->cluster_lu + cluster->square, sim->cluster_pivot + cluster->row);
        if (!(sim->cluster_quality[k] > 0.0)) return singular(sim, cluster->row, 0.0);
    }
    return DMB_OK;
}

static int32_t factor_gram(dmb_sim *sim)
{
    for (uint32_t k = 0; k < sim->scene->cluster_count; k++) {
        const dmb_cluster *cluster = sim->scene->clusters + k;
        const dmb_partition partition = dmb_cluster_partition(sim, k);
        if (dmb_partition_gram(matrix_of(sim, cluster), cluster->columns, sim->cluster_metric + cluster->column,
                               &partition, sim->cluster_gram + cluster->square) < 0)
            return singular(sim, cluster->row, 0.0);
    }
    return DMB_OK;
}

/* ---- Projection -------------------------------------------------------------------------------------------------- */

/* Shortest change of the rows of a cluster with B x = d, d by constraint row, into cluster_move. */
static const double *shortest(dmb_sim *sim, uint32_t k, const double *d)
{
    const dmb_cluster *cluster = sim->scene->clusters + k;
    const dmb_partition partition = dmb_cluster_partition(sim, k);
    for (uint32_t i = 0; i < partition.rank; i++) sim->cluster_rows[i] = d[cluster->row + partition.row_order[i]];
    dmb_partition_project(matrix_of(sim, cluster), cluster->columns, sim->cluster_metric + cluster->column, &partition,
                          sim->cluster_gram + cluster->square, sim->cluster_rows, sim->cluster_move);
    return sim->cluster_move;
}

static void move_node(dmb_sim *sim, uint32_t node, const double *x)
{
    if (sim->scene->layout.size[node] == DMB_NODE_FULL) {
        dmb_se3_advance(sim->trial.quaternion + 4 * (size_t)node, sim->trial.displacement + 3 * (size_t)node, x);
        return;
    }
    sim->trial.displacement[3 * (size_t)node] += x[0];
    sim->trial.turn[node] += x[1];
}

/* [m] least move that satisfies a row of a cluster alone: its misfit over the length of its row in weighted columns. */
static double way_of(const dmb_sim *sim, uint32_t k, uint32_t row)
{
    const dmb_cluster *cluster = sim->scene->clusters + k;
    const double *b = matrix_of(sim, cluster) + (size_t)row * cluster->columns;
    const double *weight = sim->cluster_weight + cluster->column;
    const double value = fabs(sim->constraint_value[cluster->row + row]);
    double sum = 0.0;
    if (value == 0.0) return 0.0;
    for (uint32_t c = 0; c < cluster->columns; c++) sum += b[c] * b[c] * weight[c] * weight[c];
    return sum > 0.0 ? value / sqrt(sum) : value;
}

/* Largest misfit of the pivot rows, or of the dropped ones. */
static double misfit_of(const dmb_sim *sim, uint32_t k, int32_t dropped, uint32_t *row)
{
    const dmb_cluster *cluster = sim->scene->clusters + k;
    const uint32_t *order = sim->partition_row + cluster->row, rank = sim->partition_rank[k];
    double most = 0.0;
    for (uint32_t i = dropped ? rank : 0; i < (dropped ? cluster->rows : rank); i++) {
        const double misfit = way_of(sim, k, order[i]);
        if (!(misfit > most)) continue;
        most = misfit;
        *row = cluster->row + order[i];
    }
    return most;
}

static double worst_pivot_misfit(const dmb_sim *sim, uint32_t *row)
{
    double most = 0.0;
    for (uint32_t k = 0; k < sim->scene->cluster_count; k++) most = fmax(most, misfit_of(sim, k, 0, row));
    return most;
}

double dmb_clusters_misfit(const dmb_sim *sim, int32_t dropped, uint32_t *row)
{
    double most = 0.0;
    *row = UINT32_MAX;
    for (uint32_t k = 0; k < sim->scene->cluster_count; k++)
        for (int32_t which = dropped; which <= 1; which++) {
            uint32_t found = UINT32_MAX;
            const double here = misfit_of(sim, k, which, &found);
            if (!(here > most)) continue;
            most = here;
            *row = found;
        }
    return most;
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
    return sim->linked_mode->size + far;
}

/* Moves the poses by the shortest change that makes C = 0, but none by more than `most` [m]. Returns the largest. */
static double move_poses(dmb_sim *sim, double most)
{
    const dmb_scene *scene = sim->scene;
    double largest = 0.0;
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
            move_node(sim, scene->cluster_nodes[i], sim->cluster_move + scene->node_place[scene->cluster_nodes[i]]);
    }
    return largest;
}

int32_t dmb_clusters_approach(dmb_evaluation *evaluation)
{
    dmb_sim *sim = evaluation->sim;
    int32_t status = dmb_clusters_gather(evaluation);
    if (status < 0) return status;
    dmb_clusters_choose(sim);
    status = factor_gram(sim);
    if (status < 0) return status;
    return move_poses(sim, DMB_APPROACH * sim->linked_mode->length) <= DMB_SETTLED * scene_size(sim) ? DMB_NOTE_STOPPED
                                                                                                     : DMB_OK;
}

/* Newton on C = 0 until rounding. */
static int32_t settle_poses(dmb_evaluation *evaluation)
{
    dmb_sim *sim = evaluation->sim;
    const double size = scene_size(sim);
    double last = (double)INFINITY;
    uint32_t row = 0;
    for (uint32_t k = 0;; k++) {
        int32_t status = dmb_clusters_gather(evaluation);
        if (status < 0) return status;
        const double misfit = worst_pivot_misfit(sim, &row);
        const int done = misfit <= DMB_SETTLED * size || (misfit < DMB_UNSETTLED * size && misfit > 0.5 * last);
        if (done || k == DMB_SETTLE_MAX || !isfinite(misfit)) {
            if (misfit < DMB_UNSETTLED * size) return factor_gram(sim);
            (void)singular(sim, row, fabs(sim->constraint_value[row]));
            return DMB_ERR_NO_CONVERGENCE;
        }
        status = factor_gram(sim);
        if (status < 0) return status;
        last = misfit;
        (void)move_poses(sim, (double)INFINITY);
    }
}

/* v so that B v + rate = 0; `level` rows of what B v must cancel. */
static void settle_rows(dmb_sim *sim, const double *level, double *v, double *also, double factor)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t k = 0; k < scene->cluster_count; k++) {
        const dmb_cluster *cluster = scene->clusters + k;
        const uint32_t *row_of = scene->cluster_columns + cluster->column;
        const double *B = matrix_of(sim, cluster);
        double *d = sim->cluster_scratch;
        for (uint32_t r = 0; r < cluster->rows; r++) {
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

static void leave_weak(dmb_sim *sim)
{
    for (uint32_t k = 0; k < sim->scene->cluster_count; k++) {
        const dmb_cluster *cluster = sim->scene->clusters + k;
        const dmb_partition partition = dmb_cluster_partition(sim, k);
        dmb_partition_leave_weak(matrix_of(sim, cluster), cluster->columns, sim->cluster_metric + cluster->column,
                                 &partition, sim->cluster_gram + cluster->square);
    }
}

int32_t dmb_clusters_settle(dmb_evaluation *evaluation, int32_t levels, int32_t from_raw)
{
    dmb_sim *sim = evaluation->sim;
    int32_t status = DMB_OK;
    if (from_raw) take_raw(sim);
    if (from_raw && !evaluation->extrapolated) /* the first iteration of a step, which may solve for them */
        memcpy(sim->trial.multiplier, sim->now.multiplier, sim->scene->constraint_row_count * sizeof(double));
    if (levels & DMB_SETTLE_POSE)
        status = settle_poses(evaluation);
    else
        status = dmb_clusters_gather(evaluation);
    if (status >= 0 && !(levels & DMB_SETTLE_POSE)) status = factor_gram(sim);
    if (status >= 0 && from_raw) leave_weak(sim);
    if (status >= 0 && levels & DMB_SETTLE_SPEED) {
        settle_rows(sim, sim->constraint_rate, sim->trial.velocity, NULL, 0.0);
        status = dmb_constraint_rows(evaluation);
    }
    if (status >= 0 && levels & DMB_SETTLE_ACCELERATION) /* the recursion of a goes with that of v' */
        settle_rows(sim, sim->constraint_convective, sim->trial.acceleration, sim->trial.pseudo_acceleration,
                    evaluation->pseudo_factor);
    return status < 0 ? status : factor_dependent(sim);
}

int32_t dmb_clusters_refresh(dmb_evaluation *evaluation)
{
    dmb_clusters_watch(evaluation->sim);
    return factor_dependent(evaluation->sim);
}

/* ---- Multipliers ------------------------------------------------------------------------------------------------- */

/* C_d^T f = -residual in the dependent columns. */
static void solve_multipliers(dmb_sim *sim, uint32_t k)
{
    const dmb_cluster *cluster = sim->scene->clusters + k;
    const dmb_partition partition = dmb_cluster_partition(sim, k);
    const uint32_t *row_of = sim->scene->cluster_columns + cluster->column;
    double *f = sim->cluster_rows;
    for (uint32_t i = 0; i < partition.rank; i++) f[i] = -sim->correction[row_of[partition.column_order[i]]];
    dmb_partition_solve_transposed(&partition, sim->cluster_lu + cluster->square, sim->cluster_pivot + cluster->row, f);
    for (uint32_t r = 0; r < cluster->rows; r++) sim->trial.multiplier[cluster->row + r] = 0.0;
    for (uint32_t i = 0; i < partition.rank; i++) sim->trial.multiplier[cluster->row + partition.row_order[i]] = f[i];
}

static void add_multipliers(dmb_sim *sim, uint32_t k)
{
    const dmb_cluster *cluster = sim->scene->clusters + k;
    const uint32_t *row_of = sim->scene->cluster_columns + cluster->column;
    const double *B = matrix_of(sim, cluster);
    for (uint32_t r = 0; r < cluster->rows; r++) {
        const double f = sim->trial.multiplier[cluster->row + r];
        for (uint32_t c = 0; c < cluster->columns && f != 0.0; c++) {
            const double force = f * B[(size_t)r * cluster->columns + c];
            sim->correction[row_of[c]] += force;
            sim->scale_row[row_of[c]] += fabs(force);
        }
    }
}

/* Dependent rows balance by construction; what is left there is rounding. */
static void clear_dependent(dmb_sim *sim, uint32_t k)
{
    const dmb_cluster *cluster = sim->scene->clusters + k;
    const uint32_t *order = sim->partition_column + cluster->column;
    for (uint32_t i = 0; i < sim->partition_rank[k]; i++)
        sim->correction[sim->scene->cluster_columns[cluster->column + order[i]]] = 0.0;
}

/* What does the same with the least forces: no change where no row is dropped. */
static void least_norm(dmb_sim *sim, uint32_t k)
{
    const dmb_cluster *cluster = sim->scene->clusters + k;
    const dmb_partition partition = dmb_cluster_partition(sim, k);
    if (partition.rank == active_rows(sim, cluster)) return;
    dmb_partition_least_norm(matrix_of(sim, cluster), cluster->columns, &partition, sim->cluster_lu + cluster->square,
                             sim->cluster_pivot + cluster->row, sim->cluster_gram + cluster->square,
                             sim->trial.multiplier + cluster->row);
}

void dmb_clusters_balance(dmb_evaluation *evaluation)
{
    dmb_sim *sim = evaluation->sim;
    const int given = sim->linked_mode->multipliers;
    for (uint32_t k = 0; k < sim->scene->cluster_count; k++) {
        if (!given) solve_multipliers(sim, k);
        if (!given) least_norm(sim, k);
        add_multipliers(sim, k);
        if (!given) clear_dependent(sim, k);
    }
}

void dmb_clusters_least_norm(dmb_sim *sim)
{
    for (uint32_t k = 0; k < sim->scene->cluster_count; k++) least_norm(sim, k);
}

/* ---- The rest ---------------------------------------------------------------------------------------------------- */

static void set_lengths(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    dmb_linked_mode *mode = sim->linked_mode;
    double span = 0.0;
    mode->length = 0.0;
    for (uint32_t c = 0; c < scene->chain_count; c++)
        if (scene->chains[c].linked) mode->length = fmax(mode->length, scene->chains[c].length);
    for (uint32_t j = 0; j < scene->joint_count; j++) span = fmax(span, dmb_vec3_norm(scene->joints[j].span));
    mode->size = mode->length + span;
}

void dmb_clusters_prepare(dmb_sim *sim)
{
    if (sim->scene->cluster_count == 0) return;
    set_weights(sim);
    set_lengths(sim);
    sim->linked_mode->row = UINT32_MAX;
    for (uint32_t k = 0; k < sim->scene->cluster_count; k++) { /* no dependent column until one is chosen */
        const dmb_cluster *cluster = sim->scene->clusters + k;
        for (uint32_t i = 0; i < cluster->rows; i++) sim->partition_row[cluster->row + i] = i;
        for (uint32_t i = 0; i < cluster->columns; i++) sim->partition_column[cluster->column + i] = i;
        sim->partition_rank[k] = 0;
        note_places(sim, k);
    }
}

/* "; drive 0, drive 2 move it": the motion drives that a constraint hangs together with, but for itself. */
static void name_drives(const dmb_scene *scene, uint32_t constraint, dmb_message *text)
{
    const dmb_cluster *cluster = scene->clusters + scene->constraints[constraint].cluster;
    dmb_message before;
    uint32_t count = 0;
    dmb_message_clear(text);
    for (uint32_t i = cluster->constraint; i < cluster->constraint + cluster->constraint_count; i++) {
        if (scene->constraints[i].kind != DMB_OF_DRIVE || i == constraint || count == DMB_NAMED_DRIVES) continue;
        before = *text;
        dmb_message_set(text, "%s%s drive %u", before.text, count++ ? "," : ";", scene->constraints[i].index);
    }
    if (count == 0) return;
    before = *text;
    dmb_message_set(text, "%s %s it", before.text, count > 1 ? "move" : "moves");
}

void dmb_clusters_explain(dmb_sim *sim, const char *what)
{
    dmb_message owner, drives;
    const uint32_t row = sim->linked_mode->row;
    if (row == UINT32_MAX) return;
    const uint32_t constraint = dmb_constraint_of_row(sim->scene, row);
    dmb_constraint_text(sim->scene, constraint, &owner);
    name_drives(sim->scene, constraint, &drives);
    dmb_message_set(&sim->message, "%s: %s at time %g, misfit = %g%s", owner.text, what, sim->clock->time,
                    sim->linked_mode->misfit, drives.text);
}
