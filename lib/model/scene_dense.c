#include "model/scene.h"

#include <string.h>

#include "base/checked_size.h"
#include "base/memory.h"
#include "model/limits.h"

int32_t dmb_scene_place_storage(uint32_t count, dmb_cluster *clusters, dmb_scene *scene)
{
    size_t dense = 0, square = 0, full = 0;
    for (uint32_t c = 0; c < count; ++c) {
        dmb_cluster *cluster = clusters + c;
        cluster->dense = dense;
        cluster->square = square;
        cluster->full = full;
        if (cluster->sparse) continue;
        if (!dmb_checked_add_size(dense, (size_t)cluster->rows * cluster->columns, &dense) ||
            !dmb_checked_add_size(square, (size_t)cluster->rows * cluster->rows, &square) ||
            !dmb_checked_add_size(full, (size_t)cluster->columns * cluster->columns, &full))
            return 0;
    }
    scene->dense_count = dense;
    scene->square_count = square;
    scene->full_count = full;
    return 1;
}

static int fits(const dmb_scene *scene)
{
    for (uint32_t c = 0; c < scene->cluster_count; ++c) {
        const dmb_cluster *cluster = scene->clusters + c;
        if (cluster->columns > DMB_CLUSTER_COLUMNS_MAX || cluster->rows > DMB_CLUSTER_ROWS_MAX) return 0;
    }
    return 1;
}

/* The struct and what differs from the scene; all else is the scene's. */
static dmb_scene *lay_out(dmb_arena *arena, const dmb_scene *scene)
{
    dmb_scene nowhere;
    dmb_scene *made = DMB_ARENA_ARRAY(arena, dmb_scene, 1), *to = made != NULL ? made : &nowhere;
    *to = *scene;
    to->clusters = DMB_ARENA_ARRAY(arena, dmb_cluster, scene->cluster_count);
    to->node_block = DMB_ARENA_ARRAY(arena, uint32_t, scene->node_count);
    to->link_offset = DMB_ARENA_ARRAY(arena, size_t, 2 * (size_t)scene->node_count);
    return made;
}

int32_t dmb_scene_make_dense(dmb_scene *scene, const dmb_allocator *allocator)
{
    dmb_arena arena;
    if (scene->sparse_count == 0 || !fits(scene)) return DMB_OK;
    dmb_arena_count(&arena);
    (void)lay_out(&arena, scene);
    const size_t bytes = dmb_arena_block_size(&arena);
    if (arena.overflow) return DMB_ERR_TOO_LARGE;
    void *block = dmb_allocate(allocator, bytes);
    if (block == NULL) return DMB_ERR_NO_MEMORY;
    dmb_arena_place(&arena, block, bytes);
    dmb_scene *dense = lay_out(&arena, scene);
    memcpy(dense->clusters, scene->clusters, scene->cluster_count * sizeof *dense->clusters);
    for (uint32_t c = 0; c < dense->cluster_count; ++c) dense->clusters[c].sparse = 0;
    memset(&dense->pattern, 0, sizeof dense->pattern);
    dense->bytes = bytes;
    const int32_t status = dmb_scene_place_storage(dense->cluster_count, dense->clusters, dense)
                               ? dmb_scene_link(dense, allocator)
                               : DMB_ERR_TOO_LARGE;
    if (status < 0)
        dmb_release(allocator, block, bytes);
    else
        scene->dense = dense;
    return status;
}

void dmb_scene_release_dense(const dmb_scene *dense, const dmb_allocator *allocator)
{
    if (dense == NULL) return;
    dmb_scene whole = *dense;
    dmb_block_pattern_release(&whole.pattern, allocator);
    dmb_release(allocator, (void *)(uintptr_t)dense, whole.bytes);
}
