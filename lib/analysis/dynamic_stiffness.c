#include "analysis/dynamic_stiffness.h"

#include <math.h>
#include <string.h>

#include "analysis/joint_condensation.h"
#include "base/allocator.h"
#include "base/arena.h"

/* ---- Memory ------------------------------------------------------------------------------------------------------ */

static dmb_complex_array take(dmb_arena *arena, size_t count)
{
    dmb_complex_array array;
    array.re = DMB_ARENA_DOUBLES(arena, count);
    array.im = DMB_ARENA_DOUBLES(arena, count);
    return array;
}

static void lay_out(dmb_arena *arena, const dmb_linear *linear, uint32_t joint_rows, dmb_dynamic_stiffness *out)
{
    const dmb_block_layout *layout = &linear->scene.layout;
    out->factors.diagonal = take(arena, layout->diag[layout->n]);
    out->factors.lower = take(arena, layout->link[layout->n - 1]);
    out->factors.upper = take(arena, layout->link[layout->n - 1]);
    out->factors.pivot = DMB_ARENA_ARRAY(arena, uint8_t, linear->rows);
    out->held = DMB_ARENA_ARRAY(arena, uint8_t, linear->rows);
    out->told = take(arena, linear->scene.held_count);
    dmb_condensation_lay_out(arena, linear, joint_rows, &out->condensation);
}

static void mark_held(dmb_dynamic_stiffness *s)
{
    const dmb_linear *linear = s->linear;
    for (uint32_t r = 0; r < linear->rows; r++)
        s->held[r] = linear->scene.solved_row[r] && s->condensation.place[r] == UINT32_MAX ? 0 : 1;
}

int32_t dmb_dynamic_stiffness_make(const dmb_linear *linear, double structural_damping, dmb_dynamic_stiffness *out)
{
    const uint32_t joint_rows = dmb_condensation_rows(linear);
    dmb_arena arena;
    memset(out, 0, sizeof *out);
    out->linear = linear;
    out->structural_damping = structural_damping;
    dmb_arena_count(&arena);
    lay_out(&arena, linear, joint_rows, out);
    out->block_size = dmb_arena_block_size(&arena);
    out->block = arena.overflow ? NULL : dmb_allocate(&linear->allocator, out->block_size);
    if (out->block == NULL) return DMB_ERR_NO_MEMORY;
    dmb_arena_place(&arena, out->block, out->block_size);
    lay_out(&arena, linear, joint_rows, out);
    dmb_condensation_number(linear, &out->condensation);
    mark_held(out);
    return DMB_OK;
}

void dmb_dynamic_stiffness_release(dmb_dynamic_stiffness *stiffness)
{
    if (stiffness->linear != NULL) dmb_release(&stiffness->linear->allocator, stiffness->block, stiffness->block_size);
    memset(stiffness, 0, sizeof *stiffness);
}

/* ---- Assembly ---------------------------------------------------------------------------------------------------- */

static void assemble_array(const dmb_dynamic_stiffness *s, size_t count, const double *restrict M,
                           const double *restrict C, const double *restrict K, double *restrict re, double *restrict im)
{
    const double w = s->omega, w2 = w * w, eta = s->structural_damping;
    for (size_t i = 0; i < count; i++) re[i] = K[i] - w2 * M[i];
    for (size_t i = 0; i < count; i++) im[i] = w * C[i] + eta * K[i];
}

static void assemble(dmb_dynamic_stiffness *s)
{
    const dmb_linear_matrix *M = &s->linear->mass, *C = &s->linear->damping, *K = &s->linear->stiffness;
    const dmb_block_layout *layout = &s->linear->scene.layout;
    const size_t diagonal = layout->diag[layout->n], link = layout->link[layout->n - 1];
    const dmb_complex_block_matrix *A = &s->factors;
    assemble_array(s, diagonal, M->diagonal, C->diagonal, K->diagonal, A->diagonal.re, A->diagonal.im);
    assemble_array(s, link, M->lower, C->lower, K->lower, A->lower.re, A->lower.im);
    assemble_array(s, link, M->upper, C->upper, K->upper, A->upper.re, A->upper.im);
}

static void clear(dmb_complex_array block, uint32_t at)
{
    block.re[at] = block.im[at] = 0.0;
}

/* Row and column of a row that is not solved in the chains: identity. */
static void hold(const dmb_dynamic_stiffness *s, uint32_t node, uint32_t c)
{
    const dmb_block_layout *layout = &s->linear->scene.layout;
    const uint32_t size = layout->size[node], D = layout->diag[node];
    for (uint32_t i = 0; i < size; i++) {
        clear(s->factors.diagonal, D + size * c + i);
        clear(s->factors.diagonal, D + size * i + c);
    }
    s->factors.diagonal.re[D + (size + 1) * c] = 1.0;
    if (node > 0) {
        const uint32_t before = layout->size[node - 1], link = layout->link[node - 1];
        for (uint32_t i = 0; i < before; i++) {
            clear(s->factors.lower, link + before * c + i);
            clear(s->factors.upper, link + size * i + c);
        }
    }
    if (node + 1 < layout->n) {
        const uint32_t after = layout->size[node + 1], link = layout->link[node];
        for (uint32_t i = 0; i < after; i++) {
            clear(s->factors.upper, link + after * c + i);
            clear(s->factors.lower, link + size * i + c);
        }
    }
}

static void hold_all(const dmb_dynamic_stiffness *s)
{
    const dmb_block_layout *layout = &s->linear->scene.layout;
    for (uint32_t node = 0; node < layout->n; node++)
        for (uint32_t c = 0; c < layout->size[node]; c++)
            if (s->held[layout->row[node] + c]) hold(s, node, c);
}

/* ---- Factors and solution ---------------------------------------------------------------------------------------- */

/* A pivot this small against the stiffness and inertia of its own row is rounding: nothing holds the node at this
 * frequency. A cantilever of 10000 elements still leaves 1e-13. */
#define DMB_LOOSE_PIVOT 1e-14

/* First node with such a pivot, or -1. The reciprocal pivots stand on the diagonal. */
static int64_t loose_node(const dmb_dynamic_stiffness *s)
{
    const dmb_block_layout *layout = &s->linear->scene.layout;
    const double *M = s->linear->mass.diagonal, *K = s->linear->stiffness.diagonal, w2 = s->omega * s->omega;
    for (uint32_t node = 0; node < layout->n; node++)
        for (uint32_t c = 0; c < layout->size[node]; c++) {
            const uint32_t at = layout->diag[node] + (layout->size[node] + 1u) * c;
            const double scale = fabs(K[at]) + w2 * fabs(M[at]);
            const double largest = fmax(fabs(s->factors.diagonal.re[at]), fabs(s->factors.diagonal.im[at]));
            if (!s->held[layout->row[node] + c] && largest * scale * DMB_LOOSE_PIVOT > 1.0) return (int64_t)node;
        }
    return -1;
}

int64_t dmb_dynamic_stiffness_factor(dmb_dynamic_stiffness *s, double omega)
{
    const dmb_scene *scene = &s->linear->scene;
    s->omega = omega;
    assemble(s);
    hold_all(s);
    for (uint32_t c = 0; c < scene->chain_count; c++) {
        const int64_t bad =
            dmb_complex_block_factor(&scene->layout, &s->factors, scene->chains[c].first, scene->chains[c].count);
        if (bad >= 0) return bad;
    }
    const int64_t loose = loose_node(s);
    return loose < 0 && s->condensation.rows > 0 ? dmb_condensation_factor(s) : loose;
}

void dmb_dynamic_chain_solve(const dmb_dynamic_stiffness *s, uint32_t chain, dmb_complex_array x)
{
    const dmb_scene *scene = &s->linear->scene;
    dmb_complex_block_solve(&scene->layout, &s->factors, scene->chains[chain].first, scene->chains[chain].count, x);
}

/* y_r -= A_rj x_j in the rows of one block, rows x columns, column j */
static void subtract_block_column(const dmb_dynamic_stiffness *s, const double *M, const double *C, const double *K,
                                  uint32_t rows, uint32_t columns, uint32_t j, dmb_complex_number x, double *re,
                                  double *im)
{
    for (uint32_t r = 0; r < rows; r++) {
        const uint32_t at = columns * r + j;
        const dmb_complex_number a = dmb_dynamic_entry(s, M[at], C[at], K[at]);
        re[r] -= a.re * x.re - a.im * x.im;
        im[r] -= a.re * x.im + a.im * x.re;
    }
}

void dmb_dynamic_subtract_column(const dmb_dynamic_stiffness *s, uint32_t node, uint32_t c, dmb_complex_number x,
                                 dmb_complex_array y)
{
    const dmb_block_layout *layout = &s->linear->scene.layout;
    const dmb_linear_matrix *M = &s->linear->mass, *C = &s->linear->damping, *K = &s->linear->stiffness;
    const uint32_t size = layout->size[node], row = layout->row[node], D = layout->diag[node];
    subtract_block_column(s, M->diagonal + D, C->diagonal + D, K->diagonal + D, size, size, c, x, y.re + row,
                          y.im + row);
    if (node > 0) {
        const uint32_t U = layout->link[node - 1], before = layout->row[node - 1];
        subtract_block_column(s, M->upper + U, C->upper + U, K->upper + U, layout->size[node - 1], size, c, x,
                              y.re + before, y.im + before);
    }
    if (node + 1 < layout->n) {
        const uint32_t L = layout->link[node], after = layout->row[node + 1];
        subtract_block_column(s, M->lower + L, C->lower + L, K->lower + L, layout->size[node + 1], size, c, x,
                              y.re + after, y.im + after);
    }
}

static dmb_complex_number block_row_times(const dmb_dynamic_stiffness *s, const double *M, const double *C,
                                          const double *K, uint32_t columns, const double *re, const double *im)
{
    dmb_complex_number sum = {0.0, 0.0};
    for (uint32_t j = 0; j < columns; j++) {
        const dmb_complex_number a = dmb_dynamic_entry(s, M[j], C[j], K[j]);
        sum.re += a.re * re[j] - a.im * im[j];
        sum.im += a.re * im[j] + a.im * re[j];
    }
    return sum;
}

dmb_complex_number dmb_dynamic_row_times(const dmb_dynamic_stiffness *s, uint32_t node, uint32_t c, dmb_complex_array x)
{
    const dmb_block_layout *layout = &s->linear->scene.layout;
    const dmb_linear_matrix *M = &s->linear->mass, *C = &s->linear->damping, *K = &s->linear->stiffness;
    const uint32_t size = layout->size[node], row = layout->row[node], D = layout->diag[node] + size * c;
    dmb_complex_number sum =
        block_row_times(s, M->diagonal + D, C->diagonal + D, K->diagonal + D, size, x.re + row, x.im + row);
    if (node > 0) {
        const uint32_t n = layout->size[node - 1], L = layout->link[node - 1] + n * c, before = layout->row[node - 1];
        const dmb_complex_number y =
            block_row_times(s, M->lower + L, C->lower + L, K->lower + L, n, x.re + before, x.im + before);
        sum.re += y.re, sum.im += y.im;
    }
    if (node + 1 < layout->n) {
        const uint32_t n = layout->size[node + 1], U = layout->link[node] + n * c, after = layout->row[node + 1];
        const dmb_complex_number y =
            block_row_times(s, M->upper + U, C->upper + U, K->upper + U, n, x.re + after, x.im + after);
        sum.re += y.re, sum.im += y.im;
    }
    return sum;
}

static uint32_t row_of_held(const dmb_scene *scene, uint32_t i)
{
    return scene->layout.row[scene->held_node[i]] + scene->held_component[i];
}

/* A_.h d of a held row, the columns of which the matrices lack. */
static void subtract_held_column(const dmb_dynamic_stiffness *s, uint32_t i, dmb_complex_number d, dmb_complex_array y)
{
    const dmb_block_layout *layout = &s->linear->scene.layout;
    const double *M = s->linear->held_columns + 54 * (size_t)i, *C = M + 18, *K = C + 18;
    const size_t node = s->linear->scene.held_node[i];
    for (size_t k = 0; k < 3; k++) {
        if ((k == 0 && node == 0) || node + k > layout->n) continue;
        const uint32_t row = layout->row[node + k - 1];
        subtract_block_column(s, M + 6 * k, C + 6 * k, K + 6 * k, layout->size[node + k - 1], 1, 0, d, y.re + row,
                              y.im + row);
    }
}

/* What rows that move as they are told exert on the others, f -= A_.h d_h; they themselves stand aside. */
static void take_prescribed(dmb_dynamic_stiffness *s, dmb_complex_array x)
{
    const dmb_scene *scene = &s->linear->scene;
    for (uint32_t i = 0; i < scene->held_count; i++) {
        const uint32_t row = row_of_held(scene, i);
        s->told.re[i] = x.re[row];
        s->told.im[i] = x.im[row];
    }
    for (uint32_t i = 0; i < scene->held_count; i++) {
        const dmb_complex_number d = {s->told.re[i], s->told.im[i]};
        if (d.re != 0.0 || d.im != 0.0) subtract_held_column(s, i, d, x);
    }
    for (uint32_t i = 0; i < scene->held_count; i++) x.re[row_of_held(scene, i)] = x.im[row_of_held(scene, i)] = 0.0;
}

static void give_prescribed(const dmb_dynamic_stiffness *s, dmb_complex_array x)
{
    const dmb_scene *scene = &s->linear->scene;
    for (uint32_t i = 0; i < scene->held_count; i++) {
        x.re[row_of_held(scene, i)] = s->told.re[i];
        x.im[row_of_held(scene, i)] = s->told.im[i];
    }
}

void dmb_dynamic_stiffness_solve(dmb_dynamic_stiffness *s, int32_t joint_moves, dmb_complex_array x)
{
    take_prescribed(s, x);
    if (s->condensation.rows > 0) dmb_condensation_take(s, joint_moves, x);
    for (uint32_t c = 0; c < s->linear->scene.chain_count; c++) dmb_dynamic_chain_solve(s, c, x);
    if (s->condensation.rows > 0) dmb_condensation_give(s, x);
    give_prescribed(s, x);
}
