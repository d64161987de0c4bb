/* The dynamic stiffness at several frequencies in lanes: conversion of right-hand sides and solutions to and from the
 * layout of the kernel. */
#include <string.h>

#include "analysis/linear/linear.h"
#include "base/memory.h"

/* Numbers of a right-hand side or a block at all frequencies, real and imaginary parts. */
enum { NUMBERS = 2 * DMB_FREQUENCIES };

int32_t dmb_dynamic_group_suits(const dmb_dynamic_stiffness *stiffness)
{
    return stiffness->linear->scene.cluster_count == 0;
}

static void lay_out(dmb_arena *arena, const dmb_dynamic_stiffness *stiffness, dmb_dynamic_group *out)
{
    const dmb_block_layout *layout = &stiffness->linear->scene.layout;
    out->sides = DMB_ARENA_DOUBLES(arena, (size_t)NUMBERS * out->columns * stiffness->linear->rows);
    out->work = DMB_ARENA_DOUBLES(arena, (size_t)NUMBERS * layout->link[layout->n - 1]);
}

int32_t dmb_dynamic_group_make(dmb_dynamic_stiffness *stiffness, uint32_t columns, dmb_dynamic_group *out)
{
    dmb_arena arena;
    memset(out, 0, sizeof *out);
    out->columns = columns;
    dmb_arena_count(&arena);
    lay_out(&arena, stiffness, out);
    const size_t size = dmb_arena_block_size(&arena);
    out->block = dmb_allocate(&stiffness->linear->allocator, size);
    if (out->block == NULL) return DMB_ERR_NO_MEMORY;
    out->stiffness = stiffness;
    out->block_size = size;
    dmb_arena_place(&arena, out->block, size);
    lay_out(&arena, stiffness, out);
    return DMB_OK;
}

void dmb_dynamic_group_release(dmb_dynamic_group *group)
{
    if (group->stiffness != NULL) dmb_release(&group->stiffness->linear->allocator, group->block, group->block_size);
    memset(group, 0, sizeof *group);
}

/* Real part of a row in a right-hand side; the imaginary part is DMB_FREQUENCIES further. */
static double *number(const dmb_dynamic_group *group, uint32_t row, uint32_t column, uint32_t frequency)
{
    return group->sides + (size_t)NUMBERS * ((size_t)group->columns * row + column) + frequency;
}

static void go_to(dmb_dynamic_group *group, uint32_t frequency)
{
    group->stiffness->growth = 0.0;
    group->stiffness->omega = group->omega[frequency];
}

void dmb_dynamic_group_put(dmb_dynamic_group *group, uint32_t frequency, uint32_t column, int32_t moves,
                           dmb_complex_array x)
{
    const dmb_scene *scene = &group->stiffness->linear->scene;
    go_to(group, frequency);
    if (moves) dmb_dynamic_set_prescribed(group->stiffness, x);
    for (uint32_t r = 0; r < scene->row_count; r++) {
        double *to = number(group, r, column, frequency);
        to[0] = scene->solved_row[r] ? x.re[r] : 0.0;
        to[DMB_FREQUENCIES] = scene->solved_row[r] ? x.im[r] : 0.0;
    }
}

static dmb_response_blocks blocks(const double *mass, const double *damping, const double *stiffness)
{
    const dmb_response_blocks all = {mass, damping, stiffness};
    return all;
}

uint32_t dmb_dynamic_group_solve(dmb_dynamic_group *group, uint32_t columns)
{
    const dmb_linear *linear = group->stiffness->linear;
    const dmb_linear_matrix *M = &linear->mass, *C = &linear->damping, *K = &linear->stiffness;
    const dmb_scene *scene = &linear->scene;
    dmb_response_args args = {.used = group->used,
                              .columns = columns,
                              .stride = group->columns,
                              .layout = &scene->layout,
                              .diagonal = blocks(M->diagonal, C->diagonal, K->diagonal),
                              .lower = blocks(M->lower, C->lower, K->lower),
                              .upper = blocks(M->upper, C->upper, K->upper),
                              .solved = scene->solved_row,
                              .structural_damping = group->stiffness->structural_damping,
                              .sides = group->sides,
                              .work = group->work};
    uint32_t bad = 0;
    for (uint32_t l = 0; l < DMB_FREQUENCIES; l++) args.omega[l] = group->omega[l < group->used ? l : group->used - 1];
    for (uint32_t c = 0; c < scene->chain_count; c++) {
        args.first = scene->chains[c].first;
        args.count = scene->chains[c].count;
        scene->kernels->responses(&args);
        bad |= args.bad;
    }
    return bad;
}

void dmb_dynamic_group_get(dmb_dynamic_group *group, uint32_t frequency, uint32_t column, int32_t moves,
                           dmb_complex_array x)
{
    go_to(group, frequency);
    for (uint32_t r = 0; r < group->stiffness->linear->rows; r++) {
        const double *from = number(group, r, column, frequency);
        x.re[r] = moves ? from[0] + x.re[r] : from[0];
        x.im[r] = moves ? from[DMB_FREQUENCIES] + x.im[r] : from[DMB_FREQUENCIES];
    }
}
