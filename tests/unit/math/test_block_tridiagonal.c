/* Block-tridiagonal solver against LAPACK, pivoting, singular and non-finite systems, ranges, repeatability. */
#include "math_test.h"

#include <lapacke.h>
#include <stdlib.h>

#include "math/block_tridiagonal.h"

#define BLOCKS_MAX 40
#define ROWS_MAX (BLOCKS_MAX * DMB_BLOCK_SIZE_MAX)

/* A system with its layout, big enough for every test. */
typedef struct block_system {
    uint8_t size[BLOCKS_MAX], pivot[ROWS_MAX];
    uint32_t row[BLOCKS_MAX + 1], diag[BLOCKS_MAX + 1], link[BLOCKS_MAX];
    double diagonal[36 * BLOCKS_MAX], lower[36 * BLOCKS_MAX], upper[36 * BLOCKS_MAX];
    dmb_block_layout layout;
    dmb_block_matrix matrix;
    dmb_block_totals totals;
} block_system;

static void layout_system(block_system *s, uint32_t n)
{
    assert_int_equal(dmb_block_count(n, s->size, &s->totals), 0);
    dmb_block_fill(n, s->size, s->row, s->diag, s->link);
    s->layout = (dmb_block_layout){n, s->size, s->row, s->diag, s->link};
    s->matrix = (dmb_block_matrix){s->diagonal, s->lower, s->upper, s->pivot};
}

/* Random blocks; `weight` on the diagonal keeps the whole well conditioned, `turn` shifts it off the diagonal by that
 * many rows, so that only pivoting finds it. */
static void fill_system(block_system *s, random_stream *r, double weight, uint32_t turn)
{
    draw_vector(r, 36 * BLOCKS_MAX, s->diagonal);
    draw_vector(r, 36 * BLOCKS_MAX, s->lower);
    draw_vector(r, 36 * BLOCKS_MAX, s->upper);
    for (uint32_t i = 0; i < s->layout.n; i++) {
        const uint32_t n = s->size[i];
        for (uint32_t k = 0; k < n; k++) s->diagonal[s->diag[i] + n * ((k + turn) % n) + k] += weight;
    }
}

/* The dense matrix of blocks [first, first + count), order N, row-major. */
static void to_dense(const block_system *s, uint32_t first, uint32_t count, uint32_t N, double *A)
{
    memset(A, 0, sizeof(double) * N * N);
    for (uint32_t i = first; i < first + count; i++) {
        const uint32_t n = s->size[i], at = s->row[i] - s->row[first];
        for (uint32_t p = 0; p < n; p++)
            for (uint32_t q = 0; q < n; q++) A[N * (at + p) + at + q] = s->diagonal[s->diag[i] + n * p + q];
        if (i + 1 == first + count) break;
        const uint32_t m = s->size[i + 1], next = at + n;
        for (uint32_t p = 0; p < n; p++)
            for (uint32_t q = 0; q < m; q++) {
                A[N * (at + p) + next + q] = s->upper[s->link[i] + m * p + q];
                A[N * (next + q) + at + p] = s->lower[s->link[i] + n * q + p];
            }
    }
}

/* Solve a range by both; compare solutions, and the residual with the multiplication of the library. */
static void compare_range(const block_system *s, uint32_t first, uint32_t count, random_stream *r, double tolerance)
{
    static double A[ROWS_MAX * ROWS_MAX];
    static lapack_int exchanged[ROWS_MAX];
    static double b[ROWS_MAX], x[ROWS_MAX], y[ROWS_MAX], z[ROWS_MAX];
    block_system copy = *s;
    copy.matrix = (dmb_block_matrix){copy.diagonal, copy.lower, copy.upper, copy.pivot};
    const uint32_t begin = s->row[first], N = s->row[first + count] - begin;
    draw_vector(r, (int)s->totals.rows, b);
    memcpy(x, b, sizeof b);
    memcpy(z, b, sizeof b);
    to_dense(s, first, count, N, A);
    assert_int_equal(LAPACKE_dgesv(LAPACK_ROW_MAJOR, (lapack_int)N, 1, A, (lapack_int)N, exchanged, z + begin, 1), 0);
    assert_int_equal(dmb_block_factor(&s->layout, &copy.matrix, first, count), -1);
    dmb_block_solve(&s->layout, &copy.matrix, first, count, x);
    const double scale = max_abs((int)N, z + begin);
    CHECK_BELOW(max_difference((int)N, x + begin, z + begin), tolerance * scale);
    memcpy(y, b, sizeof b);
    dmb_block_multiply(&s->layout, &s->matrix, first, count, x, y);
    CHECK_BELOW(max_difference((int)s->totals.rows, y, b), tolerance * 10.0 * (1.0 + scale));
    for (uint32_t i = 0; i < s->totals.rows; i++) /* rows of other chains are left alone */
        if (i < begin || i >= begin + N) assert_true(x[i] == b[i] && y[i] == b[i]);
}

static void compare_sizes(uint8_t (*size)(uint32_t i), uint64_t seed)
{
    static block_system s;
    random_stream r = {seed};
    for (uint32_t n = 1; n <= BLOCKS_MAX; n++) {
        for (uint32_t i = 0; i < n; i++) s.size[i] = size(i);
        layout_system(&s, n);
        s.matrix = (dmb_block_matrix){s.diagonal, s.lower, s.upper, s.pivot};
        for (uint32_t turn = 0; turn < 6; turn++) {
            fill_system(&s, &r, 8.0, turn);
            compare_range(&s, 0, n, &r, 2e-15);
        }
        fill_system(&s, &r, 2.5, 0);
        compare_range(&s, 0, n, &r, 5e-13); /* little help from the diagonal: both lose a few digits */
    }
}

static uint8_t all_six(uint32_t i)
{
    (void)i;
    return 6;
}

static uint8_t all_two(uint32_t i)
{
    (void)i;
    return 2;
}

static uint8_t six_then_two(uint32_t i)
{
    return i % 5 < 3 ? 6 : 2;
}

static uint8_t alternating(uint32_t i)
{
    return i % 2 ? 6 : 2;
}

static uint8_t one_to_six(uint32_t i)
{
    return (uint8_t)(1 + (i * 5 + i / 3) % 6);
}

static void agrees_with_lapack_six(void **state)
{
    (void)state;
    compare_sizes(all_six, 41);
}

static void agrees_with_lapack_two(void **state)
{
    (void)state;
    compare_sizes(all_two, 42);
}

static void agrees_with_lapack_mixed(void **state)
{
    (void)state;
    compare_sizes(six_then_two, 43);
    compare_sizes(alternating, 44);
    compare_sizes(one_to_six, 45);
}

static void several_chains_in_one_layout(void **state)
{
    (void)state;
    static block_system s;
    random_stream r = {46};
    const uint32_t begin[] = {0, 1, 9, 10, 22, 30};
    for (uint32_t i = 0; i < 30; i++) s.size[i] = six_then_two(i);
    layout_system(&s, 30);
    fill_system(&s, &r, 8.0, 1);
    for (uint32_t c = 0; c < 5; c++) { /* whatever stands in the links between chains plays no part */
        if (c > 0) s.lower[s.link[begin[c] - 1]] = s.upper[s.link[begin[c] - 1]] = (double)NAN;
        compare_range(&s, begin[c], begin[c + 1] - begin[c], &r, 2e-15);
    }
    assert_int_equal(dmb_block_factor(&s.layout, &s.matrix, 7, 0), -1);
}

/* A saddle: the first diagonal entry of every block is zero, as a constraint row would have it. */
static void zero_on_the_diagonal(void **state)
{
    (void)state;
    static block_system s;
    random_stream r = {47};
    for (uint32_t i = 0; i < 20; i++) s.size[i] = 6;
    layout_system(&s, 20);
    fill_system(&s, &r, 8.0, 3);
    for (uint32_t i = 0; i < 20; i++) s.diagonal[s.diag[i]] = 0.0;
    compare_range(&s, 0, 20, &r, 2e-15);
    s.diagonal[s.diag[0]] = 1e-14; /* small is as bad as zero without pivoting */
    compare_range(&s, 0, 20, &r, 2e-15);
}

/* Rows of stiffness and rows of mass differ by ten decades; pivots are compared inside a column only. */
static void badly_scaled_rows(void **state)
{
    (void)state;
    static block_system s;
    static double b[ROWS_MAX], y[ROWS_MAX], x[ROWS_MAX];
    random_stream r = {48};
    for (uint32_t i = 0; i < 20; i++) s.size[i] = 6;
    layout_system(&s, 20);
    fill_system(&s, &r, 8.0, 0);
    for (uint32_t i = 0; i < 20; i++)
        for (uint32_t p = 0; p < 6; p++) {
            const double f = p < 3 ? 1e6 : 1e-4;
            for (uint32_t q = 0; q < 6; q++) {
                s.diagonal[s.diag[i] + 6 * p + q] *= f;
                if (i < 19) s.upper[s.link[i] + 6 * p + q] *= f;
                if (i > 0) s.lower[s.link[i - 1] + 6 * p + q] *= f;
            }
        }
    draw_vector(&r, 120, x);
    dmb_block_multiply(&s.layout, &s.matrix, 0, 20, x, b);
    memcpy(y, b, sizeof b);
    assert_int_equal(dmb_block_factor(&s.layout, &s.matrix, 0, 20), -1);
    dmb_block_solve(&s.layout, &s.matrix, 0, 20, y);
    CHECK_BELOW(max_difference(120, x, y), 3e-15);
}

/* Make block `bad` singular in column k after elimination of what comes before it. */
static void singular_block_is_reported(void **state)
{
    (void)state;
    static block_system s;
    random_stream r = {49};
    uint8_t (*const sizes[])(uint32_t) = {all_six, all_two, six_then_two};
    for (int kind = 0; kind < 3; kind++)
        for (uint32_t bad = 0; bad < 12; bad++) {
            for (uint32_t i = 0; i < 12; i++) s.size[i] = sizes[kind](i);
            layout_system(&s, 12);
            fill_system(&s, &r, 8.0, 0);
            const uint32_t n = s.size[bad], k = bad % n;
            for (uint32_t p = 0; p < n; p++) s.diagonal[s.diag[bad] + n * p + k] = 0.0;
            if (bad > 0) /* no coupling upwards either, else elimination would fill the column */
                memset(s.lower + s.link[bad - 1], 0, sizeof(double) * n * s.size[bad - 1]);
            dmb_block_weakest weakest;
            block_system copy = s;
            copy.matrix = (dmb_block_matrix){copy.diagonal, copy.lower, copy.upper, copy.pivot};
            assert_int_equal(dmb_block_factor(&s.layout, &s.matrix, 0, 12), bad);
            assert_int_equal(dmb_block_factor_watched(&s.layout, &copy.matrix, 0, 12, &weakest), bad);
            assert_int_equal(weakest.block, bad);
            assert_int_equal(weakest.unknown, k);
            assert_true(weakest.ratio == 0.0);
        }
}

/* 0, 1e-301, NaN and infinity in a diagonal block are found in that block; NaN in a link one block later. */
static void what_is_not_a_number_is_reported(void **state)
{
    (void)state;
    static block_system s, fresh;
    random_stream r = {50};
    const double bad[] = {(double)NAN, (double)INFINITY, -(double)INFINITY};
    for (uint32_t i = 0; i < 8; i++) fresh.size[i] = six_then_two(i);
    layout_system(&fresh, 8);
    fill_system(&fresh, &r, 8.0, 0);
    for (uint32_t at = 0; at < fresh.totals.diagonal; at++)
        for (int kind = 0; kind < 3; kind++) {
            uint32_t block = 0;
            s = fresh;
            s.matrix = (dmb_block_matrix){s.diagonal, s.lower, s.upper, s.pivot};
            while (s.diag[block + 1] <= at) block++;
            s.diagonal[at] = bad[kind];
            assert_int_equal(dmb_block_factor(&s.layout, &s.matrix, 0, 8), block);
        }
    for (uint32_t i = 0; i < 7; i++)
        for (int side = 0; side < 2; side++) {
            s = fresh;
            s.matrix = (dmb_block_matrix){s.diagonal, s.lower, s.upper, s.pivot};
            (side ? s.lower : s.upper)[s.link[i] + 1] = (double)NAN;
            assert_int_equal(dmb_block_factor(&s.layout, &s.matrix, 0, 8), i + 1);
        }
}

static void smallest_pivot_accepted(void **state)
{
    (void)state;
    static block_system s;
    s.size[0] = 1;
    layout_system(&s, 1);
    s.diagonal[0] = 1e-301;
    assert_int_equal(dmb_block_factor(&s.layout, &s.matrix, 0, 1), 0);
    s.diagonal[0] = 2e-300;
    assert_int_equal(dmb_block_factor(&s.layout, &s.matrix, 0, 1), -1);
    double b = 4e-300;
    dmb_block_solve(&s.layout, &s.matrix, 0, 1, &b);
    CHECK_CLOSE(b, 2.0, 1e-15);
}

static void weakest_pivot_is_found(void **state)
{
    (void)state;
    static block_system s, copy;
    random_stream r = {51};
    for (uint32_t i = 0; i < 20; i++) s.size[i] = 6;
    layout_system(&s, 20);
    fill_system(&s, &r, 8.0, 0);
    for (uint32_t p = 0; p < 6; p++) s.diagonal[s.diag[13] + 6 * p + 4] *= 1e-9;
    memset(s.lower + s.link[12], 0, sizeof(double) * 36);
    copy = s;
    copy.matrix = (dmb_block_matrix){copy.diagonal, copy.lower, copy.upper, copy.pivot};
    dmb_block_weakest weakest;
    assert_int_equal(dmb_block_factor_watched(&s.layout, &s.matrix, 0, 20, &weakest), -1);
    assert_int_equal(weakest.block, 13);
    assert_int_equal(weakest.unknown, 4);
    assert_true(weakest.ratio > 1e-10 && weakest.ratio < 2e-9);
    assert_int_equal(dmb_block_factor(&s.layout, &copy.matrix, 0, 20), -1);
    assert_memory_equal(copy.diagonal, s.diagonal, sizeof s.diagonal); /* watching changes no bit */
    assert_memory_equal(copy.upper, s.upper, sizeof s.upper);
    assert_int_equal(dmb_block_factor_watched(&s.layout, &s.matrix, 3, 0, &weakest), -1);
    assert_true(isinf(weakest.ratio));
}

/* Same bits: from run to run, wherever the arrays stand, and for a chain alone or among others. */
static void repeats_bit_for_bit(void **state)
{
    (void)state;
    static block_system s, part;
    static double x[ROWS_MAX], y[ROWS_MAX + 1];
    random_stream r = {52};
    for (uint32_t i = 0; i < 30; i++) s.size[i] = i < 20 ? 6 : six_then_two(i);
    layout_system(&s, 30);
    fill_system(&s, &r, 4.0, 2);
    draw_vector(&r, (int)s.totals.rows, x);
    part = s;
    double *moved = malloc(sizeof s.diagonal + sizeof(double)); /* off by half an SSE register */
    assert_non_null(moved);
    memcpy(moved + 1, s.diagonal, sizeof s.diagonal);
    memcpy(y + 1, x, sizeof x);
    part.matrix = (dmb_block_matrix){moved + 1, part.lower, part.upper, part.pivot};
    assert_int_equal(dmb_block_factor(&s.layout, &s.matrix, 11, 17), -1);
    assert_int_equal(dmb_block_factor(&s.layout, &part.matrix, 11, 17), -1);
    dmb_block_solve(&s.layout, &s.matrix, 11, 17, x);
    dmb_block_solve(&s.layout, &part.matrix, 11, 17, y + 1);
    assert_memory_equal(moved + 1, s.diagonal, sizeof s.diagonal);
    assert_memory_equal(part.upper, s.upper, sizeof s.upper);
    assert_memory_equal(y + 1, x, sizeof x);
    free(moved);
}

static void many_right_hand_sides(void **state)
{
    (void)state;
    static block_system s;
    static double x[ROWS_MAX], y[ROWS_MAX];
    random_stream r = {53};
    for (uint32_t i = 0; i < 25; i++) s.size[i] = six_then_two(i);
    layout_system(&s, 25);
    fill_system(&s, &r, 8.0, 0);
    block_system factored = s;
    factored.matrix = (dmb_block_matrix){factored.diagonal, factored.lower, factored.upper, factored.pivot};
    assert_int_equal(dmb_block_factor(&s.layout, &factored.matrix, 0, 25), -1);
    for (int i = 0; i < 50; i++) {
        draw_vector(&r, (int)s.totals.rows, x);
        dmb_block_multiply(&s.layout, &s.matrix, 0, 25, x, y);
        dmb_block_solve(&s.layout, &factored.matrix, 0, 25, y);
        CHECK_BELOW(max_difference((int)s.totals.rows, x, y), 3e-15);
    }
}

static void layout_totals_and_refusals(void **state)
{
    (void)state;
    const uint8_t size[4] = {6, 2, 2, 6};
    uint32_t row[5], diag[5], link[4];
    dmb_block_totals t;
    assert_int_equal(dmb_block_count(4, size, &t), 0);
    assert_true(t.rows == 16 && t.diagonal == 80 && t.link == 28);
    dmb_block_fill(4, size, row, diag, link);
    assert_true(row[0] == 0 && row[1] == 6 && row[2] == 8 && row[3] == 10 && row[4] == 16);
    assert_true(diag[0] == 0 && diag[1] == 36 && diag[2] == 40 && diag[3] == 44 && diag[4] == 80);
    assert_true(link[0] == 0 && link[1] == 12 && link[2] == 16 && link[3] == 28);
    assert_int_equal(dmb_block_count(0, NULL, &t), 0);
    assert_true(t.rows == 0 && t.diagonal == 0 && t.link == 0);
    const uint8_t none[2] = {6, 0}, large[2] = {7, 6};
    assert_int_equal(dmb_block_count(2, none, &t), -1);
    assert_int_equal(dmb_block_count(2, large, &t), -1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(agrees_with_lapack_six),     cmocka_unit_test(agrees_with_lapack_two),
        cmocka_unit_test(agrees_with_lapack_mixed),   cmocka_unit_test(several_chains_in_one_layout),
        cmocka_unit_test(zero_on_the_diagonal),       cmocka_unit_test(badly_scaled_rows),
        cmocka_unit_test(singular_block_is_reported), cmocka_unit_test(what_is_not_a_number_is_reported),
        cmocka_unit_test(smallest_pivot_accepted),    cmocka_unit_test(weakest_pivot_is_found),
        cmocka_unit_test(repeats_bit_for_bit),        cmocka_unit_test(many_right_hand_sides),
        cmocka_unit_test(layout_totals_and_refusals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
