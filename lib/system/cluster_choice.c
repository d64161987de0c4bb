/* The choice of dependent coordinates, and when it is made anew. */
#include "math/vec3.h"
#include "system/cluster_parts.h"
#include "system/sparse.h"

/* The choice is made anew when its quality falls below this part of what it was. */
#define DMB_QUALITY_FALL 0.1

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

/* A number that tells sets apart, in whatever order. */
static uint64_t mark_of(uint32_t count, const uint32_t *items)
{
    uint64_t sum = count;
    for (uint32_t i = 0; i < count; i++) {
        const uint64_t mixed = (items[i] + UINT64_C(1)) * UINT64_C(0x9E3779B97F4A7C15);
        sum += mixed ^ mixed >> 29;
    }
    return sum;
}

/* Of dependent columns; of the rows that are chosen. */
static uint64_t mark_of_dependent(const dmb_sim *sim, uint32_t k)
{
    return mark_of(sim->partition_rank[k], sim->partition_column + sim->scene->clusters[k].column);
}

static uint64_t mark_of_rows(const dmb_sim *sim, uint32_t k)
{
    return mark_of(sim->partition_rank[k], sim->partition_row + sim->scene->clusters[k].row);
}

/* Whether the choice of a cluster is to be made anew. */
static int is_due(dmb_sim *sim, uint32_t k)
{
    const int fallen = sim->cluster_quality[k] < DMB_QUALITY_FALL * sim->partition_quality[k];
    sim->partition_quality[k] = fmax(sim->partition_quality[k], sim->cluster_quality[k]);
    return fallen || sim->partition_rank[k] != dmb_cluster_active_rows(sim, sim->scene->clusters + k);
}

/* Sparse clusters choose together. */
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
        dmb_cluster_note_places(sim, k);
    }
}
