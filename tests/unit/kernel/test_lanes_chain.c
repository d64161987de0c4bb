/* The solver of a step from both ends of a chain, in every width, as a whole and in parts, against dense LU by LAPACK:
 * chains of 1 to 40 blocks of six, two, or 1 to 6 rows by turns, with good blocks, unequal units, pivots off the
 * diagonal, and soft chains of stiff links; errors against a solution that is given. Checks eq:integration.elimination.
 */
#include <lapacke.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "kernel/kernels.h"

enum { NODES = 40, ROWS_MAX = 6 * NODES, BLOCKS_MAX = 36 * NODES };
enum { GOOD, UNITS, EXCHANGED, SOFT, KINDS };

typedef struct chain {
    uint8_t size[NODES], pivot[ROWS_MAX];
    uint32_t row[NODES + 1], diag[NODES + 1], link[NODES], n, rows;
    double diagonal[BLOCKS_MAX], lower[BLOCKS_MAX], upper[BLOCKS_MAX];
    double known[ROWS_MAX], unit[ROWS_MAX], right[ROWS_MAX]; /* solution, unit of each unknown, right-hand side */
    double dense[ROWS_MAX * ROWS_MAX];
    dmb_block_layout layout;
} chain;

static double one(uint64_t *seed)
{
    return draw_between(seed, -1.0, 1.0);
}

static void lay_out(uint32_t n, int sizes, chain *c)
{
    memset(c, 0, sizeof *c);
    for (uint32_t i = 0; i < n; i++) c->size[i] = (uint8_t)(sizes == 0 ? 6 : sizes == 1 ? 2 : 1 + i * 5 % 6);
    dmb_block_fill(n, c->size, c->row, c->diag, c->link);
    c->n = n;
    c->rows = c->row[n];
    c->layout = (dmb_block_layout){n, c->size, c->row, c->diag, c->link};
}

/* Adds B B^T + I/10 of random B, times `factor`, to the blocks of the chain that join the nodes i and j; blocks of one
 * size. */
static void add_link(uint64_t *seed, uint32_t i, uint32_t j, double factor, chain *c)
{
    const uint32_t n = c->size[i];
    double B[36];
    for (int k = 0; k < 36; k++) B[k] = one(seed);
    for (uint32_t r = 0; r < n; r++)
        for (uint32_t s = 0; s < n; s++) {
            double sum = r == s ? 0.1 : 0.0;
            for (uint32_t k = 0; k < n; k++) sum += B[6 * r + k] * B[6 * s + k];
            c->diagonal[c->diag[i] + n * r + s] += factor * sum;
            if (i == j) continue;
            c->diagonal[c->diag[j] + n * r + s] += factor * sum;
            c->upper[c->link[i] + n * r + s] = c->lower[c->link[i] + n * r + s] = -factor * sum;
        }
}

/* Stiff links between neighbours, held by a soft one at the last node: the smallest eigenvalue is some 1e-7 of the
 * largest over the length squared. */
static void draw_soft(uint64_t *seed, chain *c)
{
    for (uint32_t i = 0; i + 1 < c->n; i++) add_link(seed, i, i + 1, 1.0, c);
    add_link(seed, c->n - 1, c->n - 1, 1e-7, c);
}

/* Blocks about a multiple of the identity, or, exchanged, of the matrix that turns the order of the rows. */
static void draw_random(uint64_t *seed, int kind, chain *c)
{
    for (uint32_t i = 0; i < c->n; i++) {
        const uint32_t n = c->size[i], m = i + 1 < c->n ? c->size[i + 1] : 0;
        for (uint32_t k = 0; k < n * n; k++) c->diagonal[c->diag[i] + k] = one(seed);
        for (uint32_t k = 0; k < n; k++)
            c->diagonal[c->diag[i] + (kind == EXCHANGED ? n * k + n - 1 - k : (n + 1) * k)] += 5.0;
        for (uint32_t k = 0; k < n * m; k++) c->upper[c->link[i] + k] = 0.3 * one(seed);
        for (uint32_t k = 0; k < n * m; k++) c->lower[c->link[i] + k] = 0.3 * one(seed);
    }
}

static void scale_block(uint32_t rows, uint32_t columns, const double *left, const double *right, double *A)
{
    for (uint32_t i = 0; i < rows; i++)
        for (uint32_t j = 0; j < columns; j++) A[columns * i + j] /= left[i] * right[j];
}

/* Rows and unknowns in units that lie up to eight decades apart, as newtons beside newton metres and worse. */
static void change_units(chain *c)
{
    for (uint32_t i = 0; i < c->n; i++) {
        const uint32_t n = c->size[i], m = i + 1 < c->n ? c->size[i + 1] : 0;
        const double *u = c->unit + c->row[i], *v = c->unit + c->row[i + 1];
        scale_block(n, n, u, u, c->diagonal + c->diag[i]);
        scale_block(n, m, u, v, c->upper + c->link[i]);
        scale_block(m, n, v, u, c->lower + c->link[i]);
    }
    for (uint32_t i = 0; i < c->rows; i++) c->known[i] *= c->unit[i];
}

static void put(const chain *c, uint32_t i, uint32_t j, const double *block, double *dense)
{
    for (uint32_t r = 0; r < c->size[i]; r++)
        for (uint32_t s = 0; s < c->size[j]; s++)
            dense[c->rows * (c->row[i] + r) + c->row[j] + s] = block[c->size[j] * r + s];
}

static void make_dense(chain *c)
{
    for (uint32_t i = 0; i < c->n; i++) {
        put(c, i, i, c->diagonal + c->diag[i], c->dense);
        if (i + 1 == c->n) continue;
        put(c, i, i + 1, c->upper + c->link[i], c->dense);
        put(c, i + 1, i, c->lower + c->link[i], c->dense);
    }
    for (uint32_t i = 0; i < c->rows; i++) {
        long double sum = 0.0L;
        for (uint32_t j = 0; j < c->rows; j++) sum += (long double)c->dense[c->rows * i + j] * (long double)c->known[j];
        c->right[i] = (double)sum;
    }
}

static void draw_chain(uint64_t seed, uint32_t n, int sizes, int kind, chain *c)
{
    lay_out(n, sizes, c);
    for (uint32_t i = 0; i < c->rows; i++) {
        c->known[i] = one(&seed);
        c->unit[i] = kind == UNITS ? pow(10.0, 4.0 * one(&seed)) : 1.0;
    }
    if (kind == SOFT)
        draw_soft(&seed, c);
    else
        draw_random(&seed, kind, c);
    change_units(c);
    make_dense(c);
}

/* Largest error in units of the unknowns. */
static double error_of(const chain *c, const double *x)
{
    double worst = 0.0;
    for (uint32_t i = 0; i < c->rows; i++) worst = fmax(worst, fabs(x[i] - c->known[i]) / c->unit[i]);
    return worst;
}

static double error_of_lapack(const chain *c)
{
    static double A[ROWS_MAX * ROWS_MAX], x[ROWS_MAX];
    static lapack_int pivot[ROWS_MAX];
    memcpy(A, c->dense, sizeof A);
    memcpy(x, c->right, sizeof x);
    const lapack_int n = (lapack_int)c->rows;
    assert_int_equal(LAPACKE_dgesv(LAPACK_ROW_MAJOR, n, 1, A, n, pivot, x, 1), 0);
    return error_of(c, x);
}

static void solve_by(const dmb_kernels *kernels, const chain *c, chain *factored, double *x)
{
    memcpy(factored, c, sizeof *c);
    memcpy(x, c->right, sizeof c->right);
    factored->layout = (dmb_block_layout){c->n, factored->size, factored->row, factored->diag, factored->link};
    dmb_block_matrix matrix = {factored->diagonal, factored->lower, factored->upper, factored->pivot};
    assert_int_equal(kernels->factor(&factored->layout, &matrix, 0, c->n), -1);
    kernels->solve(&factored->layout, &matrix, 0, c->n, x);
}

/* The same in parts: both ends of the elimination in either order, then what is between them; then the way to the
 * middle, and back from it. */
static void solve_in_parts_by(const dmb_kernels *kernels, const chain *c, int32_t begin, chain *factored, double *x)
{
    memcpy(factored, c, sizeof *c);
    memcpy(x, c->right, sizeof c->right);
    factored->layout = (dmb_block_layout){c->n, factored->size, factored->row, factored->diag, factored->link};
    dmb_block_matrix matrix = {factored->diagonal, factored->lower, factored->upper, factored->pivot};
    const int32_t order[3] = {begin, 1 - begin, 2};
    for (int k = 0; k < 3; k++)
        assert_int_equal(kernels->factor_part(&factored->layout, &matrix, 0, c->n, order[k]), -1);
    for (int k = 0; k < 3; k++) kernels->towards_part(&factored->layout, &matrix, 0, c->n, order[k], x);
    for (int k = 0; k < 2; k++) kernels->away_part(&factored->layout, &matrix, 0, c->n, order[k], x);
}

static void parts_agree(const dmb_kernels *kernels, const chain *c, const chain *whole, const double *x)
{
    static chain factored;
    static double in_parts[ROWS_MAX];
    for (int32_t begin = 0; begin < 2; begin++) {
        solve_in_parts_by(kernels, c, begin, &factored, in_parts);
        assert_memory_equal(in_parts, x, c->rows * sizeof(double));
        assert_memory_equal(factored.diagonal, whole->diagonal, sizeof whole->diagonal);
        assert_memory_equal(factored.upper, whole->upper, sizeof whole->upper);
        assert_memory_equal(factored.lower, whole->lower, sizeof whole->lower);
    }
}

static void widths_agree(const chain *c, const chain *first, const double *x)
{
    static chain factored;
    static double wide[ROWS_MAX];
    parts_agree(dmb_kernels_of(1), c, first, x);
    for (uint32_t lanes = 2; lanes <= 8; lanes *= 2) {
        if (!dmb_kernels_of(lanes)) continue;
        solve_by(dmb_kernels_of(lanes), c, &factored, wide);
        assert_memory_equal(wide, x, c->rows * sizeof(double));
        assert_memory_equal(factored.diagonal, first->diagonal, sizeof first->diagonal);
        assert_memory_equal(factored.upper, first->upper, sizeof first->upper);
        assert_memory_equal(factored.lower, first->lower, sizeof first->lower);
        parts_agree(dmb_kernels_of(lanes), c, first, x);
    }
}

static void solutions_are_as_good_as_those_of_lapack(void **state)
{
    static chain c, factored;
    static double x[ROWS_MAX];
    static const char *const names[KINDS] = {"good blocks", "unequal units", "rows exchanged", "soft chains"};
    (void)state;
    for (int kind = 0; kind < KINDS; kind++) {
        double worst = 0.0, lapack = 0.0, ratio = 0.0;
        for (uint32_t n = 1; n <= NODES; n++)
            for (int sizes = 0; sizes < (kind == SOFT ? 2 : 3); sizes++) {
                draw_chain(100 * n + (uint64_t)kind, n, sizes, kind, &c);
                solve_by(dmb_kernels_of(1), &c, &factored, x);
                widths_agree(&c, &factored, x);
                const double error = error_of(&c, x), reference = error_of_lapack(&c);
                worst = fmax(worst, error);
                lapack = fmax(lapack, reference);
                ratio = fmax(ratio, error / (reference + 1e-15));
            }
        print_message("%s: largest error %.1e, of LAPACK %.1e, the most over its own %.1f\n", names[kind], worst,
                      lapack, ratio);
        assert_true(ratio < 100.0);
        assert_true(worst < 10.0 * lapack);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(solutions_are_as_good_as_those_of_lapack)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
