/* The solver of a step, by inverses, in every width: same bits, and the solution of the LU solver. */
#include <string.h>

#include "check.h"
#include "kernel/kernels.h"

enum { NODES = 9, ROWS_MAX = 6 * NODES, BLOCKS_MAX = 36 * NODES };

typedef struct chain {
    uint8_t size[NODES], pivot[ROWS_MAX];
    uint32_t row[NODES + 1], diag[NODES + 1], link[NODES];
    double diagonal[BLOCKS_MAX], lower[BLOCKS_MAX], upper[BLOCKS_MAX], x[ROWS_MAX];
    dmb_block_layout layout;
} chain;

static void draw_all(uint64_t *seed, size_t n, double *x)
{
    for (size_t i = 0; i < n; i++) x[i] = draw_between(seed, -1.0, 1.0);
}

/* Sizes 6, 2, or anything from 1 to 6 by turns; pivots have to be looked for. */
static void draw_chain(uint64_t seed, int kind, chain *c)
{
    memset(c, 0, sizeof *c);
    for (int i = 0; i < NODES; i++) c->size[i] = (uint8_t)(kind == 0 ? 6 : kind == 1 ? 2 : 1 + (i * 5 + (int)seed) % 6);
    dmb_block_fill(NODES, c->size, c->row, c->diag, c->link);
    draw_all(&seed, BLOCKS_MAX, c->diagonal);
    draw_all(&seed, BLOCKS_MAX, c->lower);
    draw_all(&seed, BLOCKS_MAX, c->upper);
    draw_all(&seed, ROWS_MAX, c->x);
    c->layout.n = NODES;
    c->layout.size = c->size;
    c->layout.row = c->row;
    c->layout.diag = c->diag;
    c->layout.link = c->link;
}

static dmb_block_matrix matrix_of(chain *c)
{
    const dmb_block_matrix matrix = {c->diagonal, c->lower, c->upper, c->pivot};
    return matrix;
}

static void solve_by(const dmb_kernels *kernels, chain *c, uint32_t first, uint32_t count)
{
    dmb_block_matrix matrix = matrix_of(c);
    c->layout.size = c->size, c->layout.row = c->row, c->layout.diag = c->diag, c->layout.link = c->link;
    if (kernels) {
        assert_int_equal(kernels->factor(&c->layout, &matrix, first, count), -1);
        kernels->solve(&c->layout, &matrix, first, count, c->x);
    } else {
        assert_int_equal(dmb_block_factor(&c->layout, &matrix, first, count), -1);
        dmb_block_solve(&c->layout, &matrix, first, count, c->x);
    }
}

static void solutions_agree(void **state)
{
    double worst = 0.0;
    (void)state;
    for (int kind = 0; kind < 3; kind++)
        for (uint64_t seed = 1; seed <= 20; seed++)
            for (uint32_t count = 1; count <= NODES; count += 4) {
                const uint32_t first = NODES - count;
                chain one, lu;
                draw_chain(seed, kind, &one);
                memcpy(&lu, &one, sizeof one);
                solve_by(dmb_kernels_of(1), &one, first, count);
                solve_by(NULL, &lu, first, count);
                const uint32_t from = one.row[first], to = one.row[first + count];
                worst = fmax(worst, largest_difference(to - from, one.x + from, lu.x + from) /
                                        largest(to - from, lu.x + from));
                for (uint32_t lanes = 2; lanes <= 8; lanes *= 2) {
                    chain wide;
                    if (!dmb_kernels_of(lanes)) continue;
                    draw_chain(seed, kind, &wide);
                    solve_by(dmb_kernels_of(lanes), &wide, first, count);
                    assert_memory_equal(wide.x, one.x, sizeof one.x);
                    assert_memory_equal(wide.diagonal, one.diagonal, sizeof one.diagonal);
                }
            }
    check_below("inverses against LU, relative", worst, 1e-10);
}

/* Row k of block i is 0, and nothing comes to it from its neighbours. */
static void draw_singular(int kind, uint32_t i, uint32_t k, chain *c)
{
    draw_chain(3, kind, c);
    const uint32_t n = c->size[i];
    memset(c->diagonal + c->diag[i] + n * k, 0, n * sizeof(double));
    if (i > 0) memset(c->lower + c->link[i - 1], 0, (size_t)n * c->size[i - 1] * sizeof(double));
    if (i + 1 < NODES) memset(c->upper + c->link[i], 0, (size_t)n * c->size[i + 1] * sizeof(double));
}

/* The whole elimination and that part of it which the block is in tell it; the others find nothing. */
static void check_singular(const dmb_kernels *kernels, int kind, uint32_t i, uint32_t k)
{
    const uint32_t middle = NODES / 2;
    chain c;
    draw_singular(kind, i, k, &c);
    dmb_block_matrix matrix = matrix_of(&c);
    assert_int_equal(kernels->factor(&c.layout, &matrix, 0, NODES), i);
    const int32_t its = i + 1 < middle ? 0 : i > middle + 1 ? 1 : 2;
    draw_singular(kind, i, k, &c);
    for (int32_t part = 0; part <= its; part++)
        assert_int_equal(kernels->factor_part(&c.layout, &matrix, 0, NODES, part), part == its ? (int64_t)i : -1);
}

static void singular_blocks_are_told(void **state)
{
    (void)state;
    for (uint32_t lanes = 1; lanes <= 8; lanes *= 2) {
        if (!dmb_kernels_of(lanes)) continue;
        for (int kind = 0; kind < 3; kind++)
            for (uint32_t i = 0; i < NODES; i++) {
                chain c;
                draw_chain(3, kind, &c);
                for (uint32_t k = 0; k < c.size[i]; k++) check_singular(dmb_kernels_of(lanes), kind, i, k);
            }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(solutions_agree), cmocka_unit_test(singular_blocks_are_told)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
