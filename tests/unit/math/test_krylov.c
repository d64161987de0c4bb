/* Eigenvalues of operators with known ones: a diagonal in a metric of its own, equal values, complex pairs, a space
 * that closes early. And the dense problems of math/bridge_lapacke that they rest on. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "base/memory.h"
#include "math/bridge.h"
#include "math/krylov.h"

enum { N = 200 };

/* A diagonal of 2x2 blocks [a b; -b a] in the metric diag(1 .. 2). */
typedef struct blocks {
    double a[N / 2], b[N / 2];
} blocks;

static double weight(size_t i)
{
    return 1.0 + (double)i / N;
}

static void metric(void *context, const double *x, double *y)
{
    (void)context;
    for (size_t i = 0; i < N; i++) y[i] = weight(i) * x[i];
}

static void apply(void *context, const double *x, const double *Gx, double *y)
{
    const blocks *A = context;
    (void)x;
    for (size_t i = 0; i < N; i += 2) { /* of G x, so that it is symmetric in the metric where b is 0 */
        const double p = Gx[i] / weight(i), q = Gx[i + 1] / weight(i + 1);
        y[i] = A->a[i / 2] * p + A->b[i / 2] * q;
        y[i + 1] = -A->b[i / 2] * p + A->a[i / 2] * q;
    }
}

static void draw(void *context, uint64_t *seed, double *x)
{
    (void)context;
    for (size_t i = 0; i < N; i++) {
        *seed = *seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
        x[i] = (double)(*seed >> 11) * 0x1p-52 - 1.0;
    }
}

static dmb_operator operator_of(blocks *A, int32_t symmetric)
{
    const dmb_operator o = {A, N, N, symmetric, 0, metric, apply, draw, NULL, 0, 0, 0, {0.0, 0.0}, 0};
    return o;
}

static dmb_krylov find(blocks *A, int32_t symmetric, uint32_t wanted)
{
    const dmb_allocator allocator = dmb_allocator_default();
    const dmb_operator o = operator_of(A, symmetric);
    dmb_krylov found;
    assert_int_equal(dmb_krylov_largest(&o, wanted, 2, 1e-10, &allocator, &found), DMB_OK);
    assert_int_equal(found.count, wanted);
    return found;
}

static void near(double got, double want, double tolerance)
{
    if (!(fabs(got - want) <= tolerance)) fail_msg("%.17g, wanted %.17g", got, want);
}

/* Each value stands twice, and one four times. */
static void equal_values_are_all_found(void **state)
{
    (void)state;
    blocks A;
    for (int i = 0; i < N / 2; i++) {
        A.a[i] = 1.0 / (1 + i);
        A.b[i] = 0.0;
    }
    A.a[1] = 1.0;
    dmb_krylov found = find(&A, 1, 10);
    const double want[10] = {1, 1, 1, 1, 1 / 3., 1 / 3., 1 / 4., 1 / 4., 1 / 5., 1 / 5.};
    for (int i = 0; i < 10; i++) near(found.re[i], want[i], 1e-14);
    double sum = 0.0;
    for (size_t i = 0; i < N; i++) sum += weight(i) * found.x[i] * found.x[i];
    near(sum, 1.0, 1e-13);
    assert_null(found.y);
    dmb_krylov_release(&found);
    assert_null(found.block);
}

static void complex_pairs_are_found(void **state)
{
    (void)state;
    blocks A;
    for (int i = 0; i < N / 2; i++) {
        A.a[i] = (i % 2 ? 0.3 : -0.2) / (1 + i);
        A.b[i] = 1.0 / (1 + i);
    }
    dmb_krylov found = find(&A, 0, 5);
    for (int i = 0; i < 5; i++) {
        near(found.re[i], A.a[i], 1e-9);
        near(found.im[i], A.b[i], 1e-9);
    }
    dmb_krylov_release(&found);
}

/* Rank 4: the space closes, and random vectors open it up to the dimension. */
static void closed_spaces_are_opened(void **state)
{
    (void)state;
    blocks A;
    memset(&A, 0, sizeof A);
    A.a[3] = 2.0;
    A.a[7] = -1.0;
    dmb_krylov found = find(&A, 1, 4);
    const double want[4] = {2, 2, -1, -1};
    for (int i = 0; i < 4; i++) near(found.re[i], want[i], 1e-13);
    dmb_krylov_release(&found);
}

static void dense_problems(void **state)
{
    (void)state;
    static double work[2000];
    double K[4] = {3, 1, 1, 3}, M[4] = {2, 0, 0, 1}, values[2];
    assert_true(dmb_eigen_work(2) < 2000 && dmb_eigen_work(100000) == SIZE_MAX);
    assert_int_equal(dmb_eigen_pair(2, K, M, values, work), 0);
    near(values[0] * values[1], 4.0, 1e-14); /* det K/det M */
    near(values[0] + values[1], 4.5, 1e-14);
    double S[4] = {2, 1, 1, 2}, R[4] = {0, -1, 1, 0}, re[2], im[2], V[4];
    assert_int_equal(dmb_eigen_symmetric(2, S, values, work), 0);
    near(values[0], 1.0, 1e-15);
    near(values[1], 3.0, 1e-15);
    assert_int_equal(dmb_eigen_general(2, R, re, im, V, work), 0);
    near(re[0], 0.0, 1e-15);
    near(im[0], 1.0, 1e-15);
    double twice[4] = {2, 0, 0, 1}, not_positive[4] = {1, 2, 2, 1};
    assert_true(dmb_eigen_pair(2, twice, not_positive, values, work) > 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(equal_values_are_all_found),
        cmocka_unit_test(complex_pairs_are_found),
        cmocka_unit_test(closed_spaces_are_opened),
        cmocka_unit_test(dense_problems),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
