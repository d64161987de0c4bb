/* Partition and multipliers of constraint components. The only way for small mechanisms, and the one to read first;
 * large components (lib/model/mesh_constraint chooses) use sparse_cluster with the same calls.
 *
 *     call                       when                            result
 *     ------------------------   -----------------------------   ------------------------------------------------
 *     dmb_clusters_prepare       once per sim                    units of columns, no choice yet
 *     dmb_clusters_assemble      at each trial                   rows, matrix B
 *     dmb_clusters_choose        at the start, after switches    dependent columns (eq:joints.partition)
 *     dmb_clusters_watch         after each accepted step        a new choice, counted, if the quality is below a
 *                                                                tenth of its best or the active rows are others
 *     dmb_clusters_factor        at each trial, projected        factors of B_d, G
 *     dmb_clusters_balance       at each residual                multipliers (eq:joints.multipliers)
 *     dmb_clusters_least_norm    once per accepted state         of redundant rows (eq:joints.least-norm) */
#include "system/constrain/constrain.h"

#include <string.h>

#include "math/vec3.h"
#include "sim/node.h"

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

void dmb_cluster_note_places(dmb_sim *sim, uint32_t k)
{
    const dmb_cluster *cluster = sim->scene->clusters + k;
    const uint32_t *order = sim->partition_column + cluster->column;
    for (uint32_t i = 0; i < cluster->columns; i++) sim->cluster_place[cluster->column + order[i]] = i;
}

uint32_t dmb_cluster_active_rows(const dmb_sim *sim, const dmb_cluster *cluster)
{
    uint32_t count = 0;
    for (uint32_t r = cluster->row; r < cluster->row + cluster->rows; r++)
        count += sim->constraint_type[r] != DMB_ROW_IDLE;
    return count;
}

/* B of a component from the blocks of its constraints; dense, because components treated in this way are small. */
static void gather_matrix(dmb_sim *sim, const dmb_cluster *cluster)
{
    const dmb_scene *scene = sim->scene;
    double *B = dmb_cluster_matrix(sim, cluster);
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

int32_t dmb_clusters_assemble(dmb_evaluation *evaluation)
{
    dmb_sim *sim = evaluation->sim;
    const int32_t status = dmb_constraint_rows(evaluation);
    sim->reduced_mode->metric = 0;
    for (uint32_t k = 0; k < sim->scene->cluster_count && status >= 0; k++)
        if (!sim->scene->clusters[k].sparse) gather_matrix(sim, sim->scene->clusters + k);
    return status;
}

/* Factors of the chosen columns at this trial. The choice itself stays: a step that changed it within its iteration
 * would change the unknowns of the equations that it solves. A trial in which it is singular fails
 * (DMB_ERR_SINGULAR). */
int32_t dmb_clusters_factor(dmb_sim *sim)
{
    for (uint32_t k = 0; k < sim->scene->cluster_count; k++) {
        const dmb_cluster *cluster = sim->scene->clusters + k;
        const dmb_partition partition = dmb_cluster_partition(sim, k);
        if (cluster->sparse) continue;
        dmb_cluster_note_places(sim, k); /* the choice may be one restored with an older state */
        sim->cluster_quality[k] = dmb_partition_factor(
            dmb_cluster_matrix(sim, cluster), cluster->columns, sim->cluster_weight + cluster->column, &partition,
            sim->cluster_lu + cluster->square, sim->cluster_pivot + cluster->row);
        if (!(sim->cluster_quality[k] > 0.0)) return dmb_cluster_singular(sim, cluster->row, 0.0);
    }
    return sim->scene->sparse_count ? dmb_sparse_refresh(sim) : DMB_OK;
}

/* Choice of dependent coordinates, and its renewal. */

/* [-] Ratio of the quality of a choice to its best value, below which the choice is renewed. */
#define DMB_QUALITY_FALL 0.1

/* Length that scales rotations of a body: its whole extent in the choice of the partition, about twice its longest arm.
 * In projections it is larger: a step computes rotations more accurately than the displacements of the points they
 * carry, so displacements should absorb the projection (rolling disc: errors of 7.1, 3.6, 1.2 in 1e-6 for a factor of
 * 1, 2, 4). */
#define DMB_BODY_EXTENT 2.0
#define DMB_BODY_METRIC 10.0

/* Weights of columns: 1 for translations, 1/length of the chain for rotations; 0 in rows that are not solved. */
void dmb_clusters_weigh(dmb_sim *sim, int bodies_only)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        const uint32_t k = scene->node_cluster[i], size = scene->layout.size[i];
        if (k == DMB_NONE) continue;
        double *weight = sim->cluster_weight + scene->clusters[k].column + scene->node_place[i];
        double *metric = sim->cluster_metric + scene->clusters[k].column + scene->node_place[i];
        const dmb_chain *chain = scene->chains + scene->node_chain[i];
        const double length = chain->count > 1 ? chain->length : DMB_BODY_EXTENT * chain->length;
        for (uint32_t c = 0; c < size; c++) {
            weight[c] = 2 * c < size ? 1.0 : 1.0 / length;
            if (!scene->solved_row[scene->layout.row[i] + c]) weight[c] = 0.0;
            if (bodies_only && chain->count > 1) weight[c] = 0.0;
            metric[c] = 2 * c < size || chain->count > 1 ? weight[c] : weight[c] * (DMB_BODY_EXTENT / DMB_BODY_METRIC);
        }
    }
}

/* Scratch memory is that of the projections, which do not run at the same time. */
static void choose(dmb_sim *sim, uint32_t k)
{
    const dmb_cluster *cluster = sim->scene->clusters + k;
    dmb_partition partition = dmb_cluster_partition(sim, k);
    sim->partition_quality[k] =
        dmb_partition_choose(dmb_cluster_matrix(sim, cluster), cluster->columns, sim->cluster_weight + cluster->column,
                             sim->cluster_scratch, &partition);
    sim->partition_rank[k] = partition.rank;
    dmb_cluster_note_places(sim, k);
}

void dmb_clusters_choose(dmb_sim *sim)
{
    for (uint32_t k = 0; k < sim->scene->cluster_count; k++)
        if (!sim->scene->clusters[k].sparse) choose(sim, k);
    dmb_sparse_choose(sim);
}

/* Hash of a set, independent of the order of its items. */
static uint64_t mark_of(uint32_t count, const uint32_t *items)
{
    uint64_t sum = count;
    for (uint32_t i = 0; i < count; i++) {
        const uint64_t mixed = (items[i] + UINT64_C(1)) * UINT64_C(0x9E3779B97F4A7C15);
        sum += mixed ^ mixed >> 29;
    }
    return sum;
}

/* Hashes of the set of dependent columns, and of chosen rows. */
static uint64_t mark_of_dependent(const dmb_sim *sim, uint32_t k)
{
    return mark_of(sim->partition_rank[k], sim->partition_column + sim->scene->clusters[k].column);
}

static uint64_t mark_of_rows(const dmb_sim *sim, uint32_t k)
{
    return mark_of(sim->partition_rank[k], sim->partition_row + sim->scene->clusters[k].row);
}

/* 1: the choice of component k is to be renewed. Quality is held against the best since the choice, not against a fixed
 * bound, because its size depends on units and geometry; DMB_QUALITY_FALL leaves room for motion without a switch in
 * each step. */
static int is_due(dmb_sim *sim, uint32_t k)
{
    const int fallen = sim->cluster_quality[k] < DMB_QUALITY_FALL * sim->partition_quality[k];
    sim->partition_quality[k] = fmax(sim->partition_quality[k], sim->cluster_quality[k]);
    return fallen || sim->partition_rank[k] != dmb_cluster_active_rows(sim, sim->scene->clusters + k);
}

/* Renews the choice of all sparse components together, because one factorisation covers them. */
static void watch_sparse(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    uint64_t before = 0, after = 0;
    int due = 0;
    for (uint32_t k = 0; k < scene->cluster_count; k++) {
        if (!scene->clusters[k].sparse) continue;
        due |= is_due(sim, k);
        before += mark_of_rows(sim, k);
    }
    if (!due) return;
    dmb_sparse_choose(sim);
    for (uint32_t k = 0; k < scene->cluster_count; k++)
        if (scene->clusters[k].sparse) after += mark_of_rows(sim, k);
    sim->counters->switches += before != after;
}

/* Changes are counted only if the set of dependent columns differs: a renewed choice may be the old one. */
void dmb_clusters_watch(dmb_sim *sim)
{
    for (uint32_t k = 0; k < sim->scene->cluster_count; k++) {
        if (sim->scene->clusters[k].sparse || !is_due(sim, k)) continue;
        const uint64_t before = mark_of_dependent(sim, k);
        choose(sim, k);
        sim->counters->switches += before != mark_of_dependent(sim, k);
    }
    if (sim->scene->sparse_count) watch_sparse(sim);
}

int32_t dmb_clusters_refresh(dmb_evaluation *evaluation)
{
    dmb_clusters_watch(evaluation->sim);
    return dmb_clusters_factor(evaluation->sim);
}

static void set_lengths(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    dmb_reduced_mode *mode = sim->reduced_mode;
    double span = 0.0;
    mode->length = 0.0;
    for (uint32_t c = 0; c < scene->chain_count; c++)
        if (scene->chains[c].jointed) mode->length = fmax(mode->length, scene->chains[c].length);
    for (uint32_t j = 0; j < scene->joint_count; j++) span = fmax(span, dmb_vec3_norm(scene->joints[j].span));
    mode->size = mode->length + span;
}

void dmb_clusters_prepare(dmb_sim *sim)
{
    if (sim->scene->cluster_count == 0) return;
    dmb_clusters_weigh(sim, 0);
    set_lengths(sim);
    sim->reduced_mode->row = DMB_NONE;
    for (uint32_t k = 0; k < sim->scene->cluster_count; k++) { /* no dependent column until one is chosen */
        const dmb_cluster *cluster = sim->scene->clusters + k;
        for (uint32_t i = 0; i < cluster->rows; i++) sim->partition_row[cluster->row + i] = i;
        for (uint32_t i = 0; i < cluster->columns; i++) sim->partition_column[cluster->column + i] = i;
        sim->partition_rank[k] = 0;
        dmb_cluster_note_places(sim, k);
    }
}

/* Multipliers of the constraints: the forces that balance the dependent rows. */

/* C_d^T f = -residual in the dependent columns (eq:joints.multipliers). */
static void solve_multipliers(dmb_sim *sim, uint32_t k)
{
    const dmb_cluster *cluster = sim->scene->clusters + k;
    const dmb_partition partition = dmb_cluster_partition(sim, k);
    const uint32_t *row_of = sim->scene->cluster_columns + cluster->column;
    double *f = sim->cluster_rows;
    for (uint32_t i = 0; i < partition.rank; i++) f[i] = -sim->residual[row_of[partition.column_order[i]]];
    dmb_partition_solve_transposed(&partition, sim->cluster_lu + cluster->square, sim->cluster_pivot + cluster->row, f);
    for (uint32_t r = 0; r < cluster->rows; r++) sim->trial.multiplier[cluster->row + r] = 0.0;
    for (uint32_t i = 0; i < partition.rank; i++) sim->trial.multiplier[cluster->row + partition.row_order[i]] = f[i];
}

/* residual += B^T f in all columns; the dependent ones then balance. */
static void add_multipliers(dmb_sim *sim, uint32_t k)
{
    const dmb_cluster *cluster = sim->scene->clusters + k;
    const uint32_t *row_of = sim->scene->cluster_columns + cluster->column;
    const double *B = dmb_cluster_matrix(sim, cluster);
    for (uint32_t r = 0; r < cluster->rows; r++) {
        const double f = sim->trial.multiplier[cluster->row + r];
        for (uint32_t c = 0; c < cluster->columns && f != 0.0; c++) {
            const double force = f * B[(size_t)r * cluster->columns + c];
            sim->residual[row_of[c]] += force;
            sim->scale_row[row_of[c]] += fabs(force);
        }
    }
}

/* Clears the residual of dependent rows, which balance by construction; the remainder is rounding. */
static void clear_dependent(dmb_sim *sim, uint32_t k)
{
    const dmb_cluster *cluster = sim->scene->clusters + k;
    const uint32_t *order = sim->partition_column + cluster->column;
    for (uint32_t i = 0; i < sim->partition_rank[k]; i++)
        sim->residual[sim->scene->cluster_columns[cluster->column + order[i]]] = 0.0;
}

/* Multipliers of least norm with the same forces (eq:joints.least-norm); unchanged if no row is dropped. */
static void least_norm(dmb_sim *sim, uint32_t k)
{
    const dmb_cluster *cluster = sim->scene->clusters + k;
    const dmb_partition partition = dmb_cluster_partition(sim, k);
    if (partition.rank == dmb_cluster_active_rows(sim, cluster)) return;
    dmb_partition_least_norm(&(dmb_jacobian){dmb_cluster_matrix(sim, cluster), cluster->columns, NULL}, &partition,
                             sim->cluster_lu + cluster->square, sim->cluster_pivot + cluster->row,
                             sim->cluster_gram + cluster->square, sim->trial.multiplier + cluster->row);
}

/* Multipliers that are given (unknowns of DMB_METHOD_MULTIPLIERS) leave a residual in the dependent rows too, which is
 * part of their equations and is not cleared. */
void dmb_clusters_balance(dmb_evaluation *evaluation)
{
    dmb_sim *sim = evaluation->sim;
    const int given = evaluation->given;
    for (uint32_t k = 0; k < sim->scene->cluster_count; k++) {
        if (sim->scene->clusters[k].sparse) continue;
        if (!given) solve_multipliers(sim, k);
        add_multipliers(sim, k);
        if (!given) clear_dependent(sim, k);
    }
    dmb_sparse_balance(sim, given);
}

void dmb_clusters_least_norm(dmb_sim *sim)
{
    for (uint32_t k = 0; k < sim->scene->cluster_count; k++)
        if (!sim->scene->clusters[k].sparse) least_norm(sim, k);
    dmb_sparse_least_norm(sim);
}

void dmb_clusters_clear_multipliers(dmb_sim *sim)
{
    memset(sim->trial.multiplier, 0, sim->scene->constraint_row_count * sizeof(double));
}

void dmb_cluster_move_multiplier(dmb_sim *sim, uint32_t row, double change)
{
    sim->trial.multiplier[row] += change;
}

void dmb_clusters_copy_multipliers(dmb_sim *sim)
{
    memcpy(sim->now.multiplier, sim->trial.multiplier, sim->scene->constraint_row_count * sizeof(double));
}

/* The constraint violation of a trial, in metres. */

/* [m] Shortest move that satisfies one row alone: its violation over the length of the row in weighted columns. */
static double way_of(const dmb_sim *sim, uint32_t k, uint32_t row)
{
    const dmb_cluster *cluster = sim->scene->clusters + k;
    const double *b = dmb_cluster_matrix(sim, cluster) + (size_t)row * cluster->columns;
    const double *weight = sim->cluster_weight + cluster->column;
    const double value = fabs(sim->constraint_value[cluster->row + row]);
    double sum = 0.0;
    if (value == 0.0) return 0.0;
    for (uint32_t c = 0; c < cluster->columns; c++) sum += b[c] * b[c] * weight[c] * weight[c];
    return sum > 0.0 ? value / sqrt(sum) : value;
}

/* Largest violation of the pivot rows, or of the dropped rows. */
static double violation_of(const dmb_sim *sim, uint32_t k, int32_t dropped, uint32_t *row)
{
    const dmb_cluster *cluster = sim->scene->clusters + k;
    const uint32_t *order = sim->partition_row + cluster->row, rank = sim->partition_rank[k];
    double most = 0.0;
    for (uint32_t i = dropped ? rank : 0; i < (dropped ? cluster->rows : rank); i++) {
        const double violation = way_of(sim, k, order[i]);
        if (!(violation > most)) continue;
        most = violation;
        *row = cluster->row + order[i];
    }
    return most;
}

double dmb_clusters_pivot_violation(const dmb_sim *sim, uint32_t *row)
{
    double most = 0.0;
    for (uint32_t k = 0; k < sim->scene->cluster_count; k++)
        if (!sim->scene->clusters[k].sparse) most = fmax(most, violation_of(sim, k, 0, row));
    if (sim->scene->sparse_count == 0) return most;
    uint32_t found = *row;
    const double here = dmb_sparse_violation(sim, 0, &found);
    if (here > most) *row = found;
    return fmax(most, here);
}

double dmb_clusters_violation(const dmb_sim *sim, int32_t dropped, uint32_t *row)
{
    double most = 0.0;
    *row = DMB_NONE;
    for (uint32_t k = 0; k < sim->scene->cluster_count; k++)
        for (int32_t which = dropped; which <= 1; which++) {
            uint32_t found = DMB_NONE;
            if (sim->scene->clusters[k].sparse) continue;
            const double here = violation_of(sim, k, which, &found);
            if (!(here > most)) continue;
            most = here;
            *row = found;
        }
    for (int32_t which = dropped; which <= 1 && sim->scene->sparse_count; which++) {
        uint32_t found = DMB_NONE;
        const double here = dmb_sparse_violation(sim, which, &found);
        if (here > most) *row = found;
        most = fmax(most, here);
    }
    return most;
}

/* Message on a row that could not be satisfied. */

/* Largest number of drives named in a message. */
enum { DMB_NAMED_DRIVES = 4 };

/* "; drive 0, drive 2 move it": the motion drives in the component of a constraint, other than itself. */
static void name_drives(const dmb_scene *scene, uint32_t constraint, dmb_message *text)
{
    const dmb_cluster *cluster = scene->clusters + scene->constraints[constraint].cluster;
    dmb_message before, name;
    uint32_t count = 0;
    dmb_message_clear(text);
    for (uint32_t i = cluster->constraint; i < cluster->constraint + cluster->constraint_count; i++) {
        if (scene->constraints[i].kind != DMB_OF_DRIVE || i == constraint || count == DMB_NAMED_DRIVES) continue;
        before = *text;
        dmb_message_set(text, "%s%s %s", before.text, count++ ? "," : ";",
                        dmb_drive_text(scene, scene->constraints[i].index, &name));
    }
    if (count == 0) return;
    before = *text;
    dmb_message_set(text, "%s %s it", before.text, count > 1 ? "move" : "moves");
}

void dmb_clusters_explain(dmb_sim *sim, const char *what)
{
    dmb_message owner, drives;
    const uint32_t row = sim->reduced_mode->row;
    if (row == DMB_NONE) return;
    const uint32_t constraint = dmb_constraint_of_row(sim->scene, row);
    dmb_constraint_text(sim->scene, constraint, &owner);
    name_drives(sim->scene, constraint, &drives);
    dmb_message_set(&sim->message, "%s: %s at time %g, violation = %g%s", owner.text, what, sim->clock->time,
                    sim->reduced_mode->violation, drives.text);
}
