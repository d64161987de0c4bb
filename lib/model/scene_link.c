#include "model/scene_link.h"

#include "base/vector.h"

/* ---- Nodes of clusters ------------------------------------------------------------------------------------------- */

static void place_nodes(dmb_scene *scene, uint32_t c)
{
    const dmb_cluster *cluster = &scene->clusters[c];
    uint32_t *column = scene->cluster_columns + cluster->column, place = 0;
    for (uint32_t i = 0; i < cluster->node_count; ++i) {
        const uint32_t node = scene->cluster_nodes[cluster->node + i];
        scene->node_cluster[node] = c;
        scene->node_block[node] = cluster->block;
        scene->node_place[node] = place;
        for (uint32_t k = 0; k < scene->layout.size[node]; ++k) column[place++] = scene->layout.row[node] + k;
    }
}

static int32_t has_cluster(const dmb_scene *scene, const dmb_chain *chain)
{
    for (uint32_t i = 0; i < chain->count; ++i) {
        if (scene->node_cluster[chain->first + i] != UINT32_MAX) return 1;
    }
    return 0;
}

/* The clusters have the first blocks; the other nodes of linked chains have one each. */
static void number_blocks(dmb_scene *scene)
{
    scene->block_count = scene->cluster_count;
    for (uint32_t c = 0; c < scene->chain_count; ++c) {
        dmb_chain *chain = &scene->chains[c];
        chain->linked = has_cluster(scene, chain);
        if (!chain->linked) continue;
        scene->linked_count += chain->count;
        for (uint32_t i = chain->first; i < chain->first + chain->count; ++i) {
            if (scene->node_cluster[i] == UINT32_MAX) scene->node_block[i] = scene->block_count++;
        }
    }
}

/* ---- Pattern ----------------------------------------------------------------------------------------------------- */

/* True if an element leads from node i to a node of another block. */
static int leads_on(const dmb_scene *scene, uint32_t i)
{
    if (scene->node_block[i] == UINT32_MAX || scene->node_element[i] == UINT32_MAX) return 0;
    return scene->node_block[i] != scene->node_block[i + 1];
}

/* A cluster's block has room for its multipliers too. */
static void fill_capacity(const dmb_scene *scene, uint32_t *capacity)
{
    for (uint32_t i = 0; i < scene->node_count; ++i) {
        const uint32_t block = scene->node_block[i];
        if (block == UINT32_MAX) continue;
        const dmb_cluster *cluster = block < scene->cluster_count ? &scene->clusters[block] : NULL;
        capacity[block] = cluster != NULL ? cluster->columns + cluster->rows : scene->layout.size[i];
    }
}

static int32_t make_pattern(dmb_scene *scene, const dmb_allocator *allocator)
{
    dmb_vector capacity = dmb_vector_of(sizeof(uint32_t)), edges = dmb_vector_of(sizeof(dmb_block_edge));
    int32_t status = dmb_vector_append(&capacity, allocator, NULL, scene->block_count);
    if (status >= 0) status = dmb_vector_reserve(&edges, allocator, scene->linked_count);
    for (uint32_t i = 0; i < scene->node_count && status >= 0; ++i) {
        const dmb_block_edge edge = {scene->node_block[i], leads_on(scene, i) ? scene->node_block[i + 1] : 0};
        if (leads_on(scene, i)) status = dmb_vector_append(&edges, allocator, &edge, 1);
    }
    if (status >= 0) {
        fill_capacity(scene, capacity.items);
        status = dmb_block_pattern_make(allocator, scene->block_count, capacity.items, (uint32_t)edges.count,
                                        edges.items, &scene->pattern);
    }
    dmb_vector_release(&capacity, allocator);
    dmb_vector_release(&edges, allocator);
    return status;
}

static void find_links(dmb_scene *scene)
{
    for (uint32_t i = 0; i < scene->node_count; ++i) {
        size_t *link = scene->link_offset + 2 * (size_t)i;
        link[0] = link[1] = SIZE_MAX;
        if (!leads_on(scene, i)) continue;
        link[0] = dmb_block_pattern_offset(&scene->pattern, scene->node_block[i], scene->node_block[i + 1]);
        link[1] = dmb_block_pattern_offset(&scene->pattern, scene->node_block[i + 1], scene->node_block[i]);
    }
}

int32_t dmb_scene_link(dmb_scene *scene, const dmb_allocator *allocator)
{
    if (scene->cluster_count == 0) return DMB_OK;
    for (uint32_t i = 0; i < scene->node_count; ++i) scene->node_cluster[i] = scene->node_block[i] = UINT32_MAX;
    for (uint32_t c = 0; c < scene->cluster_count; ++c) place_nodes(scene, c);
    number_blocks(scene);
    const int32_t status = make_pattern(scene, allocator);
    if (status >= 0) find_links(scene);
    return status;
}
