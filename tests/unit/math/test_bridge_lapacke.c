/* Work of LAPACK's eigensolvers against what their manual pages ask for, up to the size where 32 bits no longer count
 * it; and a small problem of each kind against its closed form. */
#define _GNU_SOURCE 1 /* feenableexcept */
#include <fenv.h>
#include <math.h>
#include <string.h>

#include "check.h"
#include "math/bridge.h"

/* dsyevd: 1 + 6n + 2n^2 doubles and 3 + 5n integers, which stand in doubles here. */
static void work_fits_32_bits(void **state)
{
    (void)state;
    const int64_t most = DMB_EIGEN_MAX, next = most + 1;
    assert_true(1 + 6 * most + 2 * most * most <= INT32_MAX);
    assert_true(1 + 6 * next + 2 * next * next > INT32_MAX);
    assert_true(dmb_eigen_work(DMB_EIGEN_MAX) >= (size_t)(1 + 6 * most + 2 * most * most + 3 + 5 * most));
    assert_true(dmb_eigen_work(DMB_EIGEN_MAX) < SIZE_MAX / 8);
    assert_true(dmb_eigen_general_work(DMB_EIGEN_MAX) >= (size_t)(4 * most));
    for (size_t n = DMB_EIGEN_MAX + 1; n < 200000; n = 2 * n + 1) {
        assert_true(dmb_eigen_work(n) == SIZE_MAX);
        assert_true(dmb_eigen_general_work(n) == SIZE_MAX);
    }
    assert_true(dmb_eigen_work(SIZE_MAX) == SIZE_MAX && dmb_eigen_general_work(SIZE_MAX) == SIZE_MAX);
}

static void work_of_the_rank_fits_32_bits(void **state)
{
    (void)state;
    const uint32_t most = DMB_RANK_SIDE_MAX;
    assert_true(dmb_rank_work(most, 1) < SIZE_MAX && dmb_rank_work(1, most) < SIZE_MAX);
    assert_true(34 * (int64_t)most + 32 <= INT32_MAX && 4 * ((int64_t)most + 1) + 3 <= INT32_MAX);
    assert_true(dmb_rank_work(most + 1, 1) == SIZE_MAX && dmb_rank_work(1, most + 1) == SIZE_MAX);
    assert_true(dmb_rank_work(UINT32_MAX, UINT32_MAX) == SIZE_MAX);
}

/* [2 1; 1 2]: 1 and 3; over M = diag(1, 4): value^2 - 2.5 value + 0.75 = 0; [0 1; -1 0]: +-i. */
static void small_problems(void **state)
{
    (void)state;
    double A[4] = {2.0, 1.0, 1.0, 2.0}, K[4] = {2.0, 1.0, 1.0, 2.0}, M[4] = {1.0, 0.0, 0.0, 4.0};
    double G[4] = {0.0, -1.0, 1.0, 0.0}, V[4], re[2], im[2], work[200];
    assert_true(dmb_eigen_work(2) <= 200 && dmb_eigen_general_work(2) <= 200);
    assert_int_equal(dmb_eigen_symmetric(2, A, re, work), 0);
    assert_true(fabs(re[0] - 1.0) < 1e-15 && fabs(re[1] - 3.0) < 2e-15);
    assert_int_equal(dmb_eigen_pair(2, K, M, re, work), 0);
    for (int i = 0; i < 2; i++) assert_true(fabs((re[i] - 2.5) * re[i] + 0.75) < 2e-15);
    assert_int_equal(dmb_eigen_general(2, G, re, im, V, work), 0);
    assert_true(fabs(re[0]) + fabs(re[1]) < 1e-15 && fabs(im[0] - 1.0) < 1e-15 && fabs(im[1] + 1.0) < 1e-15);
}

#ifdef __GLIBC__
/* A host that traps floating-point exceptions is not ended by those that LAPACK raises (dgesvd, by ieeeck, divides by
 * zero), its traps stay on, and its flags are its own. */
static void traps_of_the_host_stay(void **state)
{
    (void)state;
    enum { ROWS = 12, COLUMNS = 40, SIZE = 20000 };
    static double rows[ROWS * COLUMNS], weight[COLUMNS], work[SIZE], A[4], re[2], im[2], V[4];
    const int traps = FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW;
    int32_t order[ROWS];
    dmb_rank rank;
    for (int i = 0; i < ROWS * COLUMNS; i++) rows[i] = sin(1.0 + i);
    for (int i = 0; i < COLUMNS; i++) weight[i] = 1.0;
    const dmb_weighted_rows of = {rows, ROWS, COLUMNS, weight};
    assert_true(dmb_rank_work(ROWS, COLUMNS) <= SIZE);
    (void)feclearexcept(FE_ALL_EXCEPT);
    (void)feenableexcept(traps);
    dmb_rank_of_rows(&of, 1e-12, work, order, &rank);
    memcpy(A, (double[4]){2.0, 1.0, 1.0, 2.0}, sizeof A);
    assert_int_equal(dmb_eigen_symmetric(2, A, re, work), 0);
    memcpy(A, (double[4]){0.0, -1.0, 1.0, 0.0}, sizeof A);
    assert_int_equal(dmb_eigen_general(2, A, re, im, V, work), 0);
    assert_int_equal(fegetexcept() & traps, traps);
    (void)fedisableexcept(traps);
    assert_int_equal(fetestexcept(traps), 0);
    assert_int_equal(rank.rank, 2); /* sin(i + 40 k) = a sin i + b cos i */
    assert_int_equal(rank.exact, 1);
}
#else
static void traps_of_the_host_stay(void **state)
{
    (void)state;
}
#endif

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(work_fits_32_bits),
                                       cmocka_unit_test(work_of_the_rank_fits_32_bits),
                                       cmocka_unit_test(small_problems), cmocka_unit_test(traps_of_the_host_stay)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
