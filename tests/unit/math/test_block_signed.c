/* Signed factors of quasi-definite block-sparse matrices against dense elimination: solutions, left-out rows, and
 * choices of rows with redundant ones among them. */
#include "check.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "math/block_signed.h"

enum { BLOCKS = 7, NODE = 3, ROWS = 2, MOST = BLOCKS * (NODE + ROWS) };

/* [I B^T; B 0] of a tree of blocks with a loop; each block but the first has ROWS rows of B, on itself and its
 * parent. */
typedef struct system_of {
    dmb_allocator allocator;
    dmb_block_pattern pattern;
    uint32_t size[BLOCKS], plus[BLOCKS], row[BLOCKS], order[MOST];
    double length[MOST], *values;
    double dense[MOST][MOST];
    uint32_t rows;
} system_of;

static double draw(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return (double)(*seed >> 8) / 8388608.0 - 1.0;
}

static uint32_t parent_of(uint32_t b)
{
    return b == BLOCKS - 1 ? 0 : (b - 1) / 2; /* the last closes a loop with the first */
}

static void open_system(system_of *s, uint32_t seed)
{
    dmb_block_edge edges[BLOCKS + 1];
    uint32_t capacity[BLOCKS], count = 0;
    memset(s, 0, sizeof *s);
    assert_int_equal(dmb_allocator_copy(&s->allocator, NULL), DMB_OK);
    for (uint32_t b = 0; b < BLOCKS; b++) {
        capacity[b] = NODE + ROWS;
        s->plus[b] = NODE;
        s->size[b] = b > 0 ? NODE + ROWS : NODE;
        s->row[b] = s->rows;
        s->rows += s->size[b];
        if (b > 0) edges[count++] = (dmb_block_edge){b, parent_of(b)};
    }
    edges[count++] = (dmb_block_edge){BLOCKS - 1, BLOCKS - 2};
    assert_int_equal(dmb_block_pattern_make(&s->allocator, BLOCKS, capacity, count, edges, &s->pattern), DMB_OK);
    s->values = dmb_allocate(&s->allocator, s->pattern.values * sizeof(double));
    for (uint32_t b = 0; b < BLOCKS; b++)
        for (uint32_t k = 0; k < NODE; k++) s->dense[s->row[b] + k][s->row[b] + k] = 1.0;
    for (uint32_t b = 1; b < BLOCKS; b++)
        for (uint32_t r = 0; r < ROWS; r++) {
            const uint32_t at = s->row[b] + NODE + r, from[2] = {s->row[b], s->row[parent_of(b)]};
            for (uint32_t e = 0; e < 2; e++)
                for (uint32_t k = 0; k < NODE; k++) s->dense[at][from[e] + k] = s->dense[from[e] + k][at] = draw(&seed);
        }
}

static void close_system(system_of *s)
{
    dmb_release(&s->allocator, s->values, s->pattern.values * sizeof(double));
    dmb_block_pattern_release(&s->pattern, &s->allocator);
}

static dmb_block_signed fill(system_of *s)
{
    const dmb_block_signed matrix = {s->values, s->size, s->plus, s->row, s->length, s->order};
    dmb_block_signed_clear(&s->pattern, &matrix);
    for (uint32_t i = 0; i < BLOCKS; i++)
        for (uint32_t j = 0; j < BLOCKS; j++) {
            const size_t at = dmb_block_pattern_offset(&s->pattern, i, j);
            if (at == DMB_BLOCK_NO_OFFSET || s->pattern.position[i] > s->pattern.position[j]) continue;
            for (uint32_t r = 0; r < s->size[i]; r++)
                for (uint32_t c = 0; c < s->size[j]; c++)
                    s->values[at + r * s->size[j] + c] = s->dense[s->row[i] + r][s->row[j] + c];
        }
    for (uint32_t b = 1; b < BLOCKS; b++)
        for (uint32_t r = s->row[b] + NODE; r < s->row[b] + s->size[b]; r++) {
            s->length[r] = 0.0;
            for (uint32_t k = 0; k < s->rows; k++) s->length[r] += s->dense[r][k] * s->dense[r][k];
        }
    return matrix;
}

/* Gauss with row exchanges; rows of `out` are taken for identity. */
static void solve_dense(const system_of *s, const uint8_t *out, double *x)
{
    static double A[MOST][MOST];
    const uint32_t n = s->rows;
    for (uint32_t i = 0; i < n; i++)
        for (uint32_t j = 0; j < n; j++) A[i][j] = out[i] || out[j] ? (double)(i == j) : s->dense[i][j];
    for (uint32_t i = 0; i < n; i++) x[i] = out[i] ? 0.0 : x[i];
    for (uint32_t k = 0; k < n; k++) {
        uint32_t p = k;
        for (uint32_t i = k + 1; i < n; i++)
            if (fabs(A[i][k]) > fabs(A[p][k])) p = i;
        for (uint32_t j = 0; j < n; j++) {
            const double t = A[k][j];
            A[k][j] = A[p][j];
            A[p][j] = t;
        }
        const double t = x[k];
        x[k] = x[p];
        x[p] = t;
        for (uint32_t i = k + 1; i < n; i++) {
            const double f = A[i][k] / A[k][k];
            for (uint32_t j = k; j < n; j++) A[i][j] -= f * A[k][j];
            x[i] -= f * x[k];
        }
    }
    for (uint32_t k = n; k-- > 0;) {
        for (uint32_t j = k + 1; j < n; j++) x[k] -= A[k][j] * x[j];
        x[k] /= A[k][k];
    }
}

static double solve_both(system_of *s, double weak, const uint8_t *out)
{
    double x[MOST], y[MOST], most = 0.0;
    uint32_t seed = 77;
    const dmb_block_signed matrix = fill(s);
    assert_int_equal(dmb_block_signed_factor(&s->pattern, &matrix, weak), -1);
    for (uint32_t i = 0; i < s->rows; i++) x[i] = y[i] = draw(&seed);
    dmb_block_signed_solve(&s->pattern, &matrix, x);
    solve_dense(s, out, y);
    for (uint32_t i = 0; i < s->rows; i++) most = fmax(most, fabs(x[i] - y[i]));
    return most;
}

static void solutions(void **state)
{
    static const uint8_t none[MOST] = {0};
    (void)state;
    for (uint32_t seed = 1; seed <= 20; seed++) {
        system_of s;
        open_system(&s, seed);
        const double off = solve_both(&s, 0.0, none);
        if (seed == 1) check_below("against Gauss", off, 1e-11);
        assert_true(off <= 1e-9);
        close_system(&s);
    }
}

/* The second row of a block is the first one times 2, or the like of it. */
static void redundant_rows(void **state)
{
    (void)state;
    for (uint32_t b = 1; b < BLOCKS; b++)
        for (int exact = 0; exact < 2; exact++) {
            system_of s;
            uint8_t out[MOST] = {0};
            open_system(&s, 5 + b);
            const uint32_t r = s.row[b] + NODE;
            for (uint32_t k = 0; k < s.rows; k++) s.dense[r + 1][k] = s.dense[k][r + 1] = 2.0 * s.dense[r][k];
            if (!exact) s.dense[r + 1][s.row[b]] = s.dense[s.row[b]][r + 1] += 1e-7;
            const dmb_block_signed matrix = fill(&s);
            dmb_block_signed_choose(&s.pattern, &matrix, 1e-11);
            uint32_t left = 0;
            for (uint32_t i = 1; i < BLOCKS; i++)
                for (uint32_t k = s.row[i] + NODE; k < s.row[i] + s.size[i]; k++) left += s.length[k] == 0.0;
            assert_int_equal(left, 1);
            assert_true((s.length[r] == 0.0) != (s.length[r + 1] == 0.0));
            out[r + 1] = 1;
            check_below("without the row left out", solve_both(&s, 1e-11, out), 1e-9);
            close_system(&s);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(solutions),
        cmocka_unit_test(redundant_rows),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
