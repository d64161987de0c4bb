/* Rank by LAPACK: of matrices of known rank, against the partition, singular values of known matrices, rows that are no
 * numbers, empty shapes. */
#include "check.h"

#include <stdlib.h>
#include <string.h>

#include "constraint/partition.h"
#include "math/bridge.h"

enum { MAX = 40 };

typedef struct ranked {
    double B[MAX * MAX], weight[MAX];
    uint32_t rows, columns;
    int32_t order[MAX];
    dmb_rank found;
} ranked;

static void clear(ranked *r, uint32_t rows, uint32_t columns)
{
    memset(r, 0, sizeof *r);
    r->rows = rows;
    r->columns = columns;
    for (uint32_t j = 0; j < MAX; j++) r->weight[j] = 1.0;
}

/* In memory of just the size that was told, so that a sanitizer sees what goes beyond. */
static void find(ranked *r)
{
    const size_t size = dmb_rank_work(r->rows, r->columns);
    double *work = malloc((size + 1) * sizeof(double)), copy[MAX * MAX];
    assert_non_null(work);
    work[size] = 42.0;
    memcpy(copy, r->B, sizeof copy);
    const dmb_weighted_rows of = {r->B, r->rows, r->columns, r->weight};
    dmb_rank_of_rows(&of, DMB_RANK_TOLERANCE, work, r->order, &r->found);
    assert_memory_equal(copy, r->B, sizeof copy);
    assert_true(work[size] == 42.0);
    free(work);
}

/* Every row once. */
static void expect_order(const ranked *r)
{
    int seen[MAX] = {0};
    for (uint32_t i = 0; i < r->rows; i++) {
        assert_in_range(r->order[i], 0, r->rows - 1);
        assert_int_equal(seen[r->order[i]]++, 0);
    }
}

static uint32_t draw_integer(uint64_t *seed, uint32_t low, uint32_t high)
{
    return low + (uint32_t)draw_between(seed, 0.0, (double)(high - low) + 0.999999);
}

/* Product of rows x rank and rank x columns, rows of very different length. */
static uint32_t draw(ranked *r, uint64_t *seed)
{
    static double right[MAX * MAX];
    clear(r, draw_integer(seed, 1, MAX), draw_integer(seed, 1, MAX));
    const uint32_t rank = draw_integer(seed, 0, r->rows < r->columns ? r->rows : r->columns);
    for (uint32_t i = 0; i < MAX * MAX; i++) right[i] = draw_between(seed, -1.0, 1.0);
    for (uint32_t j = 0; j < r->columns; j++) r->weight[j] = pow(10.0, draw_between(seed, -1.0, 1.0));
    for (uint32_t i = 0; i < r->rows; i++) {
        const double scale = pow(10.0, draw_between(seed, -6.0, 6.0));
        for (uint32_t k = 0; k < rank; k++) {
            const double left = scale * draw_between(seed, -1.0, 1.0);
            for (uint32_t j = 0; j < r->columns; j++) r->B[i * r->columns + j] += left * right[MAX * k + j];
        }
    }
    return rank;
}

static uint32_t partition_rank(const ranked *r)
{
    static double work[MAX * MAX + MAX];
    uint32_t row_order[MAX], column_order[MAX];
    dmb_partition p = {r->rows, r->columns, 0, 0, row_order, column_order};
    (void)dmb_partition_choose(r->B, r->columns, r->weight, work, &p);
    return p.rank;
}

static void random_matrices(void **state)
{
    uint64_t seed = 4711;
    ranked r;
    (void)state;
    for (int k = 0; k < 300; k++) {
        const uint32_t rank = draw(&r, &seed);
        find(&r);
        assert_int_equal(r.found.rank, rank);
        assert_int_equal(partition_rank(&r), rank);
        assert_true(r.found.exact);
        assert_true(r.found.smallest > 0.0 && r.found.smallest <= r.found.largest);
        expect_order(&r);
    }
}

/* The redundant rows can go: what is left has the same rank, and so has it of fewer rows. */
static void redundant_rows_are_redundant(void **state)
{
    uint64_t seed = 99;
    ranked r, rest;
    (void)state;
    for (int k = 0; k < 100; k++) {
        (void)draw(&r, &seed);
        find(&r);
        clear(&rest, r.found.rank, r.columns);
        memcpy(rest.weight, r.weight, sizeof rest.weight);
        for (uint32_t i = 0; i < r.found.rank; i++)
            memcpy(rest.B + i * r.columns, r.B + (uint32_t)r.order[i] * r.columns, r.columns * sizeof(double));
        find(&rest);
        assert_int_equal(rest.found.rank, r.found.rank);
    }
}

/* Unit rows (1, 0) and (cos, sin): singular values sqrt(1 +- cos). */
static void singular_values(void **state)
{
    ranked r;
    (void)state;
    for (int k = 0; k < 2; k++) {
        const double angle = k ? 0.3 : 1e-3;
        clear(&r, 3, 2);
        const double B[6] = {7.0, 0.0, 2.0 * cos(angle), 2.0 * sin(angle), 0.0, 0.0};
        memcpy(r.B, B, sizeof B);
        find(&r);
        assert_int_equal(r.found.rank, 2);
        assert_int_equal(r.order[2], 2); /* the row of zeros */
        check_relative("largest", r.found.largest, sqrt(1.0 + cos(angle)), 1e-14);
        check_relative("smallest", r.found.smallest, sqrt(2.0) * sin(0.5 * angle), 1e-11);
    }
}

/* Of (x, y) only y counts where x is held. */
static void weights(void **state)
{
    ranked r;
    (void)state;
    clear(&r, 2, 2);
    const double B[4] = {1.0, 1.0, 1.0, -1.0};
    memcpy(r.B, B, sizeof B);
    find(&r);
    assert_int_equal(r.found.rank, 2);
    r.weight[0] = 0.0;
    find(&r);
    assert_int_equal(r.found.rank, 1);
    check_relative("value", r.found.largest, sqrt(2.0), 1e-15);
    r.weight[1] = 0.0;
    find(&r);
    assert_int_equal(r.found.rank, 0);
    check_close("nothing", r.found.smallest, 1.0, 0.0);
}

static void what_is_no_number(void **state)
{
    const double odd[4] = {(double)NAN, (double)INFINITY, 1e-310, 1e300}; /* the third is shorter than 1e-300 */
    ranked r;
    (void)state;
    for (int k = 0; k < 4; k++) {
        clear(&r, 3, 3);
        for (uint32_t i = 0; i < 3; i++) r.B[4 * i] = 1.0;
        r.B[4] = odd[k];
        if (k == 3) r.weight[1] = 1e100; /* overflows */
        find(&r);
        expect_order(&r);
        assert_int_equal(r.found.rank, 2);
        assert_int_equal(r.order[2], 1);
    }
}

static void huge_and_tiny_rows(void **state)
{
    ranked r;
    (void)state;
    clear(&r, 2, 2);
    const double B[4] = {1e250, 1e250, 1e-250, -1e-250};
    memcpy(r.B, B, sizeof B);
    find(&r);
    assert_int_equal(r.found.rank, 2);
    check_relative("condition", r.found.smallest / r.found.largest, 1.0, 1e-14);
}

static void empty_shapes(void **state)
{
    ranked r;
    (void)state;
    for (uint32_t rows = 0; rows < 3; rows++)
        for (uint32_t columns = 0; columns < 3; columns++) {
            if (rows > 0 && columns > 0) continue;
            clear(&r, rows, columns);
            find(&r);
            assert_int_equal(r.found.rank, 0);
            if (rows > 0) expect_order(&r);
        }
}

/* Above the limit singular values are estimates, of the right size. */
static void large_matrix(void **state)
{
    enum { N = DMB_RANK_SINGULAR_MAX + 20 };
    double *B = calloc((size_t)N * N, sizeof *B), *weight = malloc(N * sizeof *weight);
    double *work = malloc(dmb_rank_work(N, N) * sizeof *work);
    int32_t *order = malloc(N * sizeof *order);
    dmb_rank found;
    (void)state;
    assert_true(B != NULL && weight != NULL && work != NULL && order != NULL);
    for (size_t i = 0; i < N; i++) {
        weight[i] = 1.0;
        B[i * N + i] = 1.0;
        if (i > 0) B[i * N + i - 1] = i % 10 == 0 ? 0.0 : 0.5;
    }
    memcpy(B + 5 * N, B + 7 * N, N * sizeof *B);
    const dmb_weighted_rows of = {B, N, N, weight};
    dmb_rank_of_rows(&of, DMB_RANK_TOLERANCE, work, order, &found);
    assert_int_equal(found.rank, N - 1);
    assert_true(order[N - 1] == 5 || order[N - 1] == 7);
    assert_int_equal(found.exact, 0);
    assert_true(found.smallest > 0.05 && found.smallest <= found.largest && found.largest < 5.0);
    free(B);
    free(weight);
    free(work);
    free(order);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_matrices),   cmocka_unit_test(redundant_rows_are_redundant),
        cmocka_unit_test(singular_values),   cmocka_unit_test(weights),
        cmocka_unit_test(what_is_no_number), cmocka_unit_test(huge_and_tiny_rows),
        cmocka_unit_test(empty_shapes),      cmocka_unit_test(large_matrix),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
