/* Memory of the linear system. */
#include "analysis/linearise_parts.h"
#include "base/allocator.h"
#include "base/arena.h"

static void lay_out_matrix(dmb_arena *arena, const dmb_scene *scene, dmb_linear_matrix *A)
{
    const dmb_block_layout *layout = &scene->layout;
    A->diagonal = DMB_ARENA_DOUBLES(arena, layout->diag[layout->n]);
    A->lower = DMB_ARENA_DOUBLES(arena, layout->link[layout->n - 1]);
    A->upper = DMB_ARENA_DOUBLES(arena, layout->link[layout->n - 1]);
    A->joints = DMB_ARENA_DOUBLES(arena, scene->tangent_count);
}

/* Entries of R: one of an independent row, as many as its cluster has columns of a dependent one at most. */
static size_t entries_of(const dmb_scene *scene)
{
    size_t sum = scene->row_count;
    for (uint32_t k = 0; k < scene->cluster_count; k++)
        sum += (size_t)scene->clusters[k].columns * scene->clusters[k].columns;
    return sum;
}

static void lay_out(dmb_arena *arena, const dmb_scene *scene, dmb_linear *to)
{
    const size_t rows = scene->row_count;
    lay_out_matrix(arena, scene, &to->mass);
    lay_out_matrix(arena, scene, &to->damping);
    lay_out_matrix(arena, scene, &to->stiffness);
    to->spin = DMB_ARENA_DOUBLES(arena, rows);
    to->rest = DMB_ARENA_DOUBLES(arena, rows);
    to->stiffness_size = DMB_ARENA_DOUBLES(arena, rows);
    to->unbalanced = DMB_ARENA_DOUBLES(arena, rows);
    to->row_of = DMB_ARENA_ARRAY(arena, uint32_t, rows);
    to->start = DMB_ARENA_ARRAY(arena, uint32_t, rows + 1);
    to->column = DMB_ARENA_ARRAY(arena, uint32_t, entries_of(scene));
    to->value = DMB_ARENA_DOUBLES(arena, entries_of(scene));
    to->held_columns = DMB_ARENA_DOUBLES(arena, 54 * (size_t)scene->held_count);
    to->held_rows = DMB_ARENA_DOUBLES(arena, 54 * (size_t)scene->held_count);
    to->whole_joints = DMB_ARENA_DOUBLES(arena, 3 * (size_t)scene->tangent_count);
}

dmb_linear *dmb_linear_allocate(const dmb_sim *sim)
{
    dmb_arena arena;
    dmb_linear nowhere;
    dmb_linear *linear = dmb_allocate(&sim->allocator, sizeof *linear);
    if (linear == NULL) return NULL;
    linear->allocator = sim->allocator;
    const dmb_scene *scene = dmb_dense_scene(sim->scene);
    linear->scene = *scene;
    linear->rows = scene->row_count;
    dmb_arena_count(&arena);
    lay_out(&arena, scene, &nowhere);
    linear->block_size = dmb_arena_block_size(&arena);
    if (!arena.overflow) linear->block = dmb_allocate(&sim->allocator, linear->block_size);
    if (linear->block != NULL) linear->work = dmb_state_copy(sim);
    if (linear->work == NULL) {
        dmb_linear_release(&linear);
        return NULL;
    }
    dmb_arena_place(&arena, linear->block, linear->block_size);
    lay_out(&arena, scene, linear);
    return linear;
}

void dmb_linear_release(dmb_linear **linear)
{
    if (*linear == NULL) return;
    const dmb_allocator allocator = (*linear)->allocator;
    dmb_state_discard((*linear)->work);
    dmb_release(&allocator, (*linear)->block, (*linear)->block_size);
    dmb_release(&allocator, *linear, sizeof **linear);
    *linear = NULL;
}
