#include "analysis/linear/dynamic_stiffness.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"

/* ---- Memory ------------------------------------------------------------------------------------------------------ */

static dmb_complex_array take(dmb_arena *arena, size_t count)
{
    dmb_complex_array array;
    array.re = DMB_ARENA_DOUBLES(arena, count);
    array.im = DMB_ARENA_DOUBLES(arena, count);
    return array;
}

static void lay_out(dmb_arena *arena, const dmb_linear *linear, dmb_links_size links, dmb_dynamic_stiffness *out)
{
    const dmb_block_layout *layout = &linear->scene.layout;
    out->factors.diagonal = take(arena, layout->diag[layout->n]);
    out->factors.lower = take(arena, layout->link[layout->n - 1]);
    out->factors.upper = take(arena, layout->link[layout->n - 1]);
    out->factors.pivot = DMB_ARENA_ARRAY(arena, uint8_t, linear->rows);
    out->told = take(arena, linear->rows);
    dmb_dynamic_links_lay_out(arena, linear, links, &out->links);
}

int32_t dmb_dynamic_stiffness_make(const dmb_linear *linear, double structural_damping, dmb_dynamic_stiffness *out)
{
    const dmb_links_size links = dmb_dynamic_links_size(linear);
    dmb_arena arena;
    memset(out, 0, sizeof *out);
    out->linear = linear;
    out->structural_damping = structural_damping;
    dmb_arena_count(&arena);
    lay_out(&arena, linear, links, out);
    out->block_size = dmb_arena_block_size(&arena);
    out->block = arena.overflow ? NULL : dmb_allocate(&linear->allocator, out->block_size);
    if (out->block == NULL) return DMB_ERR_NO_MEMORY;
    dmb_arena_place(&arena, out->block, out->block_size);
    lay_out(&arena, linear, links, out);
    dmb_dynamic_links_number(linear, links, &out->links);
    return DMB_OK;
}

void dmb_dynamic_stiffness_release(dmb_dynamic_stiffness *stiffness)
{
    if (stiffness->linear != NULL) dmb_release(&stiffness->linear->allocator, stiffness->block, stiffness->block_size);
    memset(stiffness, 0, sizeof *stiffness);
}

/* ---- Assembly ---------------------------------------------------------------------------------------------------- */

static void assemble_array(const dmb_dynamic_stiffness *s, size_t count, const double *restrict M,
                           const double *restrict C, const double *restrict K, dmb_complex_array A)
{
    double *restrict re = A.re, *restrict im = A.im;
    const double w = s->omega, w2 = w * w, eta = s->structural_damping, g = s->growth;
    for (size_t i = 0; i < count; i++) re[i] = K[i] - w2 * M[i];
    for (size_t i = 0; i < count; i++) im[i] = w * C[i] + eta * K[i];
    if (g == 0.0) return;
    for (size_t i = 0; i < count; i++) re[i] += g * (C[i] + g * M[i]);
    for (size_t i = 0; i < count; i++) im[i] += 2.0 * g * w * M[i];
}

/* Rows and columns that are held are zero but for a one. */
static void assemble(dmb_dynamic_stiffness *s)
{
    const dmb_linear_matrix *M = &s->linear->mass, *C = &s->linear->damping, *K = &s->linear->stiffness;
    const dmb_scene *scene = &s->linear->scene;
    const dmb_block_layout *layout = &scene->layout;
    const size_t diagonal = layout->diag[layout->n], link = layout->link[layout->n - 1];
    const dmb_complex_block_matrix *A = &s->factors;
    assemble_array(s, diagonal, M->diagonal, C->diagonal, K->diagonal, A->diagonal);
    assemble_array(s, link, M->lower, C->lower, K->lower, A->lower);
    assemble_array(s, link, M->upper, C->upper, K->upper, A->upper);
    for (uint32_t i = 0; i < scene->held_count; i++) {
        const uint32_t node = scene->held_node[i];
        A->diagonal.re[layout->diag[node] + (layout->size[node] + 1u) * scene->held_component[i]] = 1.0;
    }
}

/* ---- Factors and solution ---------------------------------------------------------------------------------------- */

/* First node of a chain with a pivot of rounding size, or -1. The reciprocal pivots stand on the diagonal. */
static int64_t loose_node(const dmb_dynamic_stiffness *s, const dmb_chain *chain)
{
    const dmb_block_layout *layout = &s->linear->scene.layout;
    const double *M = s->linear->mass.diagonal, *K = s->linear->stiffness.diagonal;
    for (uint32_t node = chain->first; node < chain->first + chain->count; node++)
        for (uint32_t c = 0; c < layout->size[node]; c++) {
            const uint32_t at = layout->diag[node] + (layout->size[node] + 1u) * c;
            if (dmb_dynamic_is_loose(s, s->factors.diagonal.re[at], s->factors.diagonal.im[at], fabs(K[at]),
                                     fabs(M[at])))
                return (int64_t)node;
        }
    return -1;
}

int64_t dmb_dynamic_stiffness_factor(dmb_dynamic_stiffness *s, double omega)
{
    return dmb_dynamic_stiffness_factor_at(s, 0.0, omega);
}

int64_t dmb_dynamic_stiffness_factor_at(dmb_dynamic_stiffness *s, double growth, double omega)
{
    const dmb_scene *scene = &s->linear->scene;
    s->growth = growth;
    s->omega = omega;
    assemble(s);
    for (uint32_t c = 0; c < scene->chain_count; c++) {
        const dmb_chain *chain = scene->chains + c;
        if (chain->jointed) continue;
        int64_t bad = dmb_complex_block_factor(&scene->layout, &s->factors, chain->first, chain->count);
        if (bad < 0) bad = loose_node(s, chain);
        if (bad >= 0) return bad;
    }
    return scene->cluster_count > 0 ? dmb_dynamic_links_factor(s) : -1;
}

/* Displacements that are told, and the forces -A p in their place. */
static void take_told(dmb_dynamic_stiffness *s, dmb_complex_array x)
{
    const size_t bytes = s->linear->rows * sizeof(double);
    memcpy(s->told.re, x.re, bytes);
    memcpy(s->told.im, x.im, bytes);
    memset(x.re, 0, bytes);
    memset(x.im, 0, bytes);
    dmb_dynamic_subtract(s, s->told, x);
}

static void add_told(const dmb_dynamic_stiffness *s, dmb_complex_array x)
{
    for (uint32_t r = 0; r < s->linear->rows; r++) {
        x.re[r] += s->told.re[r];
        x.im[r] += s->told.im[r];
    }
}

void dmb_dynamic_stiffness_solve(dmb_dynamic_stiffness *s, int32_t moves, dmb_complex_array x)
{
    const dmb_scene *scene = &s->linear->scene;
    if (moves) take_told(s, x);
    for (uint32_t r = 0; r < scene->row_count; r++)
        if (!scene->solved_row[r]) x.re[r] = x.im[r] = 0.0;
    for (uint32_t c = 0; c < scene->chain_count; c++)
        if (!scene->chains[c].jointed)
            dmb_complex_block_solve(&scene->layout, &s->factors, scene->chains[c].first, scene->chains[c].count, x);
    if (scene->cluster_count > 0) dmb_dynamic_links_solve(s, x);
    if (moves) add_told(s, x);
}
