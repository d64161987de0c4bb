/* Rank of the equations by LAPACK for the model check, compared with the choice of the partition. The sim is only read:
 * a copy of its struct has own arrays where rows and matrices are written, and reads pose and motion of the accepted
 * state in place.
 *
 *     component   rank                                      redundant rows
 *     ---------   ---------------------------------------   ---------------------------------------------------------
 *     dense       singular values (dmb_rank_of_rows)        those of the partition if both ranks agree, else LAPACK's
 *     large       that of its choice of rows                those of the choice */
#include "system/constrain/constrain.h"

#include <string.h>

#include "base/memory.h"
#include "math/bridge.h"
#include "sim/access.h"

/* Configuration at which the rows are evaluated, and memory for LAPACK. */
typedef struct scratch {
    dmb_sim sim;        /* copy of the caller's sim, whose arrays are only read, except for those below */
    uint8_t *redundant; /* of the result */
    double *work;
    int32_t *order;
} scratch;

/* ---- A sim whose rows may be written ----------------------------------------------------------------------------- */

static uint32_t longest_cluster(const dmb_scene *scene)
{
    uint32_t most = 0;
    for (uint32_t k = 0; k < scene->cluster_count; k++)
        if (scene->clusters[k].rows > most) most = scene->clusters[k].rows;
    return most;
}

static size_t largest_work(const dmb_scene *scene)
{
    size_t most = 0;
    for (uint32_t k = 0; k < scene->cluster_count; k++) {
        const size_t here = dmb_rank_work(scene->clusters[k].rows, scene->clusters[k].columns);
        if (here > most) most = here;
    }
    return most;
}

/* Arrays written by dmb_clusters_assemble. Pose and motion of the accepted state are read in place. */
static void lay_out(dmb_arena *arena, scratch *s)
{
    const dmb_scene *scene = s->sim.scene;
    const size_t c = scene->constraint_row_count;
    dmb_sim *to = &s->sim;
    to->trial.joint_depth = DMB_ARENA_DOUBLES(arena, scene->joint_count);
    to->trial.joint_segment = DMB_ARENA_ARRAY(arena, uint32_t, scene->joint_count);
    to->reduced_mode = DMB_ARENA_ARRAY(arena, dmb_reduced_mode, 1);
    to->constraint_type = DMB_ARENA_ARRAY(arena, uint8_t, c);
    to->constraint_value = DMB_ARENA_DOUBLES(arena, c);
    to->constraint_rate = DMB_ARENA_DOUBLES(arena, c);
    to->constraint_convective = DMB_ARENA_DOUBLES(arena, c);
    to->constraint_jacobian = DMB_ARENA_DOUBLES(arena, scene->jacobian_count);
    to->cluster_matrix = DMB_ARENA_DOUBLES(arena, scene->dense_count);
    s->redundant = DMB_ARENA_ARRAY(arena, uint8_t, c);
    s->order = DMB_ARENA_ARRAY(arena, int32_t, longest_cluster(scene));
    s->work = DMB_ARENA_DOUBLES(arena, largest_work(scene));
}

/* The dense scene, if the sim's has sparse components and a dense twin: all components then have a matrix for LAPACK.
 */
static int32_t open_scratch(const dmb_sim *sim, scratch *s, dmb_cluster_rank *rank)
{
    dmb_arena arena;
    s->sim = *sim;
    s->sim.scene = dmb_dense_scene(sim->scene);
    s->sim.trial = sim->now;
    dmb_arena_count(&arena);
    lay_out(&arena, s);
    rank->block_size = dmb_arena_block_size(&arena);
    if (arena.overflow) return DMB_ERR_NO_MEMORY;
    rank->block = dmb_allocate(&sim->allocator, rank->block_size);
    if (rank->block == NULL) return DMB_ERR_NO_MEMORY;
    dmb_arena_place(&arena, rank->block, rank->block_size);
    lay_out(&arena, s);
    memcpy(s->sim.trial.joint_segment, sim->now.joint_segment, sim->scene->joint_count * sizeof(uint32_t));
    rank->redundant = s->redundant;
    return DMB_OK;
}

static int32_t evaluate_rows(scratch *s)
{
    dmb_evaluation evaluation;
    memset(&evaluation, 0, sizeof evaluation);
    evaluation.sim = &s->sim;
    evaluation.time = s->sim.clock->time;
    return dmb_clusters_assemble(&evaluation);
}

/* ---- Rank -------------------------------------------------------------------------------------------------------- */

/* Moves the active rows to the front of the matrix of a component. Returns their number. */
static uint32_t pack_rows(scratch *s, const dmb_cluster *cluster)
{
    const size_t n = cluster->columns;
    double *B = s->sim.cluster_matrix + cluster->dense;
    uint32_t count = 0;
    for (uint32_t r = 0; r < cluster->rows; r++) {
        if (s->sim.constraint_type[cluster->row + r] == DMB_ROW_IDLE) continue;
        if (r != count) memmove(B + n * count, B + n * r, n * sizeof(double));
        count++;
    }
    return count;
}

/* Row of the component that is active row number `count`. */
static uint32_t acting_row(const scratch *s, const dmb_cluster *cluster, uint32_t count)
{
    uint32_t r = 0;
    for (;; r++) {
        if (s->sim.constraint_type[cluster->row + r] == DMB_ROW_IDLE) continue;
        if (count-- == 0) return r;
    }
}

/* Marks the rows dropped by the partition, or those found redundant by LAPACK. */
static void mark_redundant(scratch *s, uint32_t k, uint32_t rows, const dmb_rank *found)
{
    const dmb_cluster *cluster = s->sim.scene->clusters + k;
    const dmb_partition partition = dmb_cluster_partition(&s->sim, k);
    uint8_t *redundant = s->redundant + cluster->row;
    if (partition.rank == found->rank) {
        for (uint32_t i = partition.rank; i < cluster->rows; i++) {
            const uint32_t r = partition.row_order[i];
            redundant[r] = s->sim.constraint_type[cluster->row + r] != DMB_ROW_IDLE;
        }
        return;
    }
    for (uint32_t i = found->rank; i < rows; i++) redundant[acting_row(s, cluster, (uint32_t)s->order[i])] = 1;
}

/* Result for a component too large for LAPACK, from its choice of rows. */
static void read_choice(scratch *s, uint32_t k, dmb_cluster_rank *rank)
{
    const dmb_rank found = {.rank = s->sim.partition_rank[k]};
    const uint32_t rows = dmb_cluster_active_rows(&s->sim, s->sim.scene->clusters + k);
    mark_redundant(s, k, rows, &found);
    rank->rows += rows;
    rank->rank += found.rank;
    if (!(s->sim.partition_quality[k] < rank->condition)) return;
    rank->condition = s->sim.partition_quality[k];
    rank->poorest = k;
}

static void rank_cluster(scratch *s, uint32_t k, dmb_cluster_rank *rank)
{
    const dmb_cluster *cluster = s->sim.scene->clusters + k;
    if (cluster->sparse) {
        read_choice(s, k, rank);
        return;
    }
    const uint32_t rows = pack_rows(s, cluster);
    dmb_rank found;
    const dmb_weighted_rows of = {s->sim.cluster_matrix + cluster->dense, rows, cluster->columns,
                                  s->sim.cluster_weight + cluster->column};
    dmb_rank_of_rows(&of, DMB_RANK_TOLERANCE, s->work, s->order, &found);
    mark_redundant(s, k, rows, &found);
    rank->rows += rows;
    rank->rank += found.rank;
    rank->differing += found.rank != s->sim.partition_rank[k];
    if (!(found.smallest < rank->condition * found.largest)) return;
    rank->condition = found.smallest / found.largest;
    rank->poorest = k;
}

int32_t dmb_cluster_rank_make(const dmb_sim *sim, dmb_cluster_rank *rank)
{
    scratch s;
    memset(rank, 0, sizeof *rank);
    rank->condition = 1.0;
    rank->violation_row = DMB_NONE;
    if (sim->scene->cluster_count == 0) return DMB_OK;
    int32_t status = open_scratch(sim, &s, rank);
    if (status >= 0) status = evaluate_rows(&s);
    if (status < 0) {
        dmb_cluster_rank_release(sim, rank);
        return status;
    }
    rank->violation = dmb_clusters_violation(&s.sim, 0, &rank->violation_row);
    for (uint32_t k = 0; k < sim->scene->cluster_count; k++) {
        dmb_progress_at(sim, (double)k / sim->scene->cluster_count);
        status = dmb_progress_pulse(sim);
        if (status < 0) {
            dmb_cluster_rank_release(sim, rank);
            return status;
        }
        rank_cluster(&s, k, rank);
    }
    return DMB_OK;
}

void dmb_cluster_rank_release(const dmb_sim *sim, dmb_cluster_rank *rank)
{
    dmb_release(&sim->allocator, rank->block, rank->block_size);
    rank->block = NULL;
    rank->redundant = NULL;
}

/* ---- Names ------------------------------------------------------------------------------------------------------- */

void dmb_constraint_row_text(const dmb_sim *sim, uint32_t row, dmb_message *text)
{
    const dmb_constraint *c = sim->scene->constraints + dmb_constraint_of_row(sim->scene, row);
    const uint32_t k = row - c->row;
    static const char *const components[] = {"x", "y", "z", "rotation x", "rotation y", "rotation z"};
    dmb_message owner;
    dmb_constraint_text(sim->scene, (uint32_t)(c - sim->scene->constraints), &owner);
    if (c->kind == DMB_OF_JOINT) {
        const int locked = sim->joint_state[c->index] == DMB_JOINT_LOCKED;
        const int32_t kind = locked ? (int32_t)DMB_JOINT_FIXED : sim->scene->joints[c->index].kind;
        dmb_message_set(text, "%s: %s%s", owner.text, dmb_joint_row_name(kind, k), locked ? " (locked)" : "");
    } else if (c->kind == DMB_OF_CALLBACK) {
        dmb_message_set(text, "%s: row %u", owner.text, k);
    } else if (c->kind == DMB_OF_DRIVE) {
        const dmb_scene_drive *drive = sim->scene->drives + c->index;
        dmb_message_set(text, "%s: %s of joint %u", owner.text, components[drive->component], drive->joint);
    } else {
        dmb_message_set(text, "%s: its condition", owner.text);
    }
}
