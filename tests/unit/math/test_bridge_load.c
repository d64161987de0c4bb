/* A build that loads LAPACKE when it is needed, where it cannot be loaded, or lacks a function: the same results by the
 * library's own code. The loader of this program can fail on demand. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>

#include "base/build.h"
#include "check.h"
#include "math/bridge.h"

typedef void *open_call(const char *name, int flags);

static enum { THERE, MISSING, LACKING } libraries;
static int loads; /* tried */

/* In place of the C library's, which it calls. */
void *dlopen(const char *name, int flags);
void *dlopen(const char *name, int flags)
{
    open_call *further;
    void *symbol = dlsym(RTLD_NEXT, "dlopen");
    memcpy(&further, &symbol, sizeof further);
    loads++;
    if (libraries == MISSING) return NULL;
    return further(libraries == LACKING ? "libm.so.6" : name, flags); /* one without those functions */
}

enum { N = 12 };

static double A[N * N], B[N * N], values[3][2][N], imaginary[2][N], vectors[N * N], work[40 * N * N];

static void draw(uint64_t seed, int symmetric)
{
    for (int i = 0; i < N * N; i++) A[i] = draw_between(&seed, -1.0, 1.0);
    for (int i = 0; i < N && symmetric; i++)
        for (int j = 0; j < i; j++) A[i + N * j] = A[j + N * i];
}

static void other_eigenvalues(void **state)
{
    (void)state;
    for (libraries = THERE; libraries <= LACKING; libraries++) {
        const int k = libraries != THERE;
        if (libraries == THERE && !dmb_has_lapack()) skip();
        draw(7, 1);
        assert_int_equal(dmb_eigen_symmetric(N, A, values[0][k], work), 0);
        if (k) check_below("symmetric", largest_difference(N, values[0][1], values[0][0]), 1e-13);
        draw(7, 1);
        for (int i = 0; i < N * N; i++) B[i] = i % (N + 1) == 0 ? 2.0 + i : 0.1;
        assert_int_equal(dmb_eigen_pair(N, A, B, values[1][k], work), 0);
        if (k) check_below("pair", largest_difference(N, values[0][1], values[0][0]), 1e-13);
        draw(7, 1); /* of real values, which come in any order */
        assert_int_equal(dmb_eigen_general(N, A, values[2][k], imaginary[k], vectors, work), 0);
        double sum[2] = {0.0, 0.0};
        for (int i = 0; i < N; i++)
            for (int m = 0; m <= k; m++) sum[m] += values[2][m][i] * values[2][m][i];
        if (k) check_close("general, sum of squares", sum[1], sum[0], 1e-12);
        if (k) check_below("    imaginary", largest(N, imaginary[k]), 1e-12);
    }
    libraries = THERE;
}

static void other_rank(void **state)
{
    (void)state;
    const double weight[N] = {1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0};
    int32_t order[N];
    dmb_rank found[2];
    if (!dmb_has_lapack()) skip();
    for (libraries = THERE; libraries <= LACKING; libraries++) {
        const int k = libraries != THERE;
        draw(11, 0);
        for (int j = 0; j < N; j++) A[N * 5 + j] = 2.0 * A[N * 3 + j] - A[j]; /* row 5 of rows 0 and 3 */
        const dmb_weighted_rows of = {A, 8, N, weight};
        dmb_rank_of_rows(&of, 1e-10, work, order, &found[k]);
        assert_int_equal(found[k].rank, 7);
        assert_true(found[k].exact);
        if (k) check_relative("largest singular value", found[1].largest, found[0].largest, 1e-13);
        if (k) check_relative("smallest", found[1].smallest, found[0].smallest, 1e-12);
    }
    libraries = THERE;
}

/* Where LAPACKE is linked, or the build has none, there is nothing to fail. */
int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(other_eigenvalues), cmocka_unit_test(other_rank)};
    (void)dmb_has_lapack();
    if (loads == 0) return 0;
    return cmocka_run_group_tests(tests, NULL, NULL);
}
