/* The dynamic stiffness at several frequencies in lanes: conversion of right-hand sides and solutions to and from the
 * layout of the kernel, which is (row, column, part, frequency). Rows of the scene come first, then the reduced
 * coordinates of jointed chains. The kernels assemble, factor and solve in one pass; they agree with
 * dmb_dynamic_stiffness_solve to the bit. */
#include <string.h>

#include "analysis/linear/linear.h"
#include "base/memory.h"

/* Numbers of a right-hand side or a block at all frequencies, real and imaginary parts. */
enum { NUMBERS = 2 * DMB_FREQUENCIES };

/* Largest number of values in the upper blocks of a chain without joints: the kernel stores W_i = D_i^-1 U_i of one
 * chain at a time there. */
static size_t largest_chain(const dmb_scene *scene)
{
    size_t most = 0;
    for (uint32_t c = 0; c < scene->chain_count; c++) {
        const dmb_chain *chain = scene->chains + c;
        const size_t end = scene->layout.link[chain->first + chain->count - 1];
        if (!chain->jointed && end - scene->layout.link[chain->first] > most)
            most = end - scene->layout.link[chain->first];
    }
    return most;
}

static void lay_out(dmb_arena *arena, const dmb_dynamic_stiffness *stiffness, dmb_dynamic_group *out)
{
    const dmb_jointed_chains *links = &stiffness->links;
    const size_t chain = largest_chain(&stiffness->linear->scene), jointed = links->pattern.values + links->widest;
    out->sides =
        DMB_ARENA_DOUBLES(arena, (size_t)NUMBERS * out->columns * ((size_t)stiffness->linear->rows + links->count));
    out->work = DMB_ARENA_DOUBLES(arena, NUMBERS * (chain > jointed ? chain : jointed));
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

/* One right-hand side or solution of a frequency, between the sides of the group and arrays. */
static void copy_to(const dmb_dynamic_group *group, uint32_t frequency, uint32_t column, uint32_t row, uint32_t count,
                    dmb_complex_array from)
{
    for (uint32_t r = 0; r < count; r++) {
        double *to = number(group, row + r, column, frequency);
        to[0] = from.re[r];
        to[DMB_FREQUENCIES] = from.im[r];
    }
}

static void copy_from(const dmb_dynamic_group *group, uint32_t frequency, uint32_t column, uint32_t row, uint32_t count,
                      dmb_complex_array to)
{
    for (uint32_t r = 0; r < count; r++) {
        const double *from = number(group, row + r, column, frequency);
        to.re[r] = from[0];
        to.im[r] = from[DMB_FREQUENCIES];
    }
}

/* A prescribed motion p enters by its forces -A p on the other rows (dmb_dynamic_set_prescribed). Constrained rows have
 * no equation; jointed chains get R^T f. */
void dmb_dynamic_group_put(dmb_dynamic_group *group, uint32_t frequency, uint32_t column, int32_t moves,
                           dmb_complex_array x)
{
    dmb_dynamic_stiffness *s = group->stiffness;
    const dmb_scene *scene = &s->linear->scene;
    go_to(group, frequency);
    if (moves) dmb_dynamic_set_prescribed(s, x);
    for (uint32_t r = 0; r < scene->row_count; r++)
        if (!scene->solved_row[r]) x.re[r] = x.im[r] = 0.0;
    copy_to(group, frequency, column, 0, s->linear->rows, x);
    if (scene->cluster_count == 0) return;
    dmb_jointed_chains_restrict(s, x);
    copy_to(group, frequency, column, s->linear->rows, s->links.count, s->links.solution);
}

static dmb_response_blocks blocks(const double *mass, const double *damping, const double *stiffness)
{
    const dmb_response_blocks all = {mass, damping, stiffness};
    return all;
}

/* Unused lanes repeat the last used frequency, so that they fail only where it does. */
static void set_frequencies(const dmb_dynamic_group *group, double omega[DMB_FREQUENCIES])
{
    for (uint32_t l = 0; l < DMB_FREQUENCIES; l++) omega[l] = group->omega[l < group->used ? l : group->used - 1];
}

/* Jointed chains are one graph and are solved in one call; chains without joints follow one by one. */
static uint32_t solve_jointed(const dmb_dynamic_group *group, uint32_t columns)
{
    const dmb_dynamic_stiffness *s = group->stiffness;
    const dmb_jointed_chains *links = &s->links;
    dmb_jointed_response_args args = {.used = group->used,
                                      .columns = columns,
                                      .stride = group->columns,
                                      .pattern = &links->pattern,
                                      .size = links->size,
                                      .row = links->row,
                                      .blocks = blocks(links->blocks[0], links->blocks[1], links->blocks[2]),
                                      .stiffness = links->stiffness,
                                      .mass = links->mass,
                                      .structural_damping = s->structural_damping,
                                      .sides = number(group, s->linear->rows, 0, 0),
                                      .work = group->work};
    set_frequencies(group, args.omega);
    s->linear->scene.kernels->jointed_responses(&args);
    return args.bad;
}

/* One bit for each frequency at which a motion is unconstrained; the caller solves these alone and reports the
 * reason. */
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
    uint32_t bad = scene->cluster_count > 0 ? solve_jointed(group, columns) : 0;
    set_frequencies(group, args.omega);
    for (uint32_t c = 0; c < scene->chain_count; c++) {
        if (scene->chains[c].jointed) continue;
        args.first = scene->chains[c].first;
        args.count = scene->chains[c].count;
        scene->kernels->responses(&args);
        bad |= args.bad;
    }
    return bad;
}

/* The reverse of `put`: dependent rows by R z, and the prescribed motion, which x contains on entry, is added. */
void dmb_dynamic_group_get(dmb_dynamic_group *group, uint32_t frequency, uint32_t column, int32_t moves,
                           dmb_complex_array x)
{
    dmb_dynamic_stiffness *s = group->stiffness;
    const size_t bytes = s->linear->rows * sizeof(double);
    go_to(group, frequency);
    memcpy(s->prescribed.re, x.re, bytes);
    memcpy(s->prescribed.im, x.im, bytes);
    copy_from(group, frequency, column, 0, s->linear->rows, x);
    if (s->linear->scene.cluster_count > 0) {
        copy_from(group, frequency, column, s->linear->rows, s->links.count, s->links.solution);
        dmb_jointed_chains_expand(s, x);
    }
    if (moves) dmb_dynamic_add_prescribed(s, x);
}
