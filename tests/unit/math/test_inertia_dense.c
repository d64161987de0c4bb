/* Signs of the eigenvalues of dense symmetric matrices whose signs are known, also by way of their LU factors. */
#include <string.h>

#include "check.h"
#include "math/dense.h"
#include "math/inertia.h"

#define MOST 20

/* B^T diag(signs) B with a random B: by Sylvester's law the signs are those of the diagonal. */
static uint32_t random_matrix(uint32_t n, uint64_t *seed, double *A)
{
    double B[MOST * MOST], sign[MOST];
    uint32_t negative = 0;
    for (uint32_t i = 0; i < n * n; i++) B[i] = draw_between(seed, -1.0, 1.0);
    for (uint32_t k = 0; k < n; k++) {
        sign[k] = draw_between(seed, -1.0, 1.0) < 0.0 ? -1.0 : 1.0;
        negative += sign[k] < 0.0;
    }
    for (uint32_t i = 0; i < n; i++)
        for (uint32_t j = 0; j < n; j++) {
            A[n * i + j] = 0.0;
            for (uint32_t k = 0; k < n; k++) A[n * i + j] += B[n * k + i] * sign[k] * B[n * k + j];
        }
    return negative;
}

static void signs_of_random_matrices(void **state)
{
    (void)state;
    uint64_t seed = 5;
    double worst = 0.0;
    for (int t = 0; t < 2000; t++) {
        const uint32_t n = 1 + (uint32_t)t % MOST;
        double A[MOST * MOST], LU[MOST * MOST], again[MOST * MOST], most;
        uint32_t pivot[MOST];
        const uint32_t want = random_matrix(n, &seed, A);
        memcpy(LU, A, sizeof A);
        most = largest((size_t)n * n, A);
        assert_int_equal(dmb_dense_factor(n, LU, pivot), -1);
        dmb_dense_from_factors(n, LU, pivot, again);
        worst = fmax(worst, largest_difference((size_t)n * n, A, again) / most);
        assert_int_equal(dmb_dense_negative(n, A), want);
        assert_int_equal(dmb_dense_negative(n, again), want);
    }
    check_below("matrix from its factors, relative", worst, 1e-13);
}

static void pivots_of_two_rows(void **state)
{
    (void)state;
    double A[16] = {0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 2.0, 0.0}, none[9] = {0.0};
    assert_int_equal(dmb_dense_negative(4, A), 2);
    assert_int_equal(dmb_dense_negative(3, none), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(signs_of_random_matrices),
        cmocka_unit_test(pivots_of_two_rows),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
