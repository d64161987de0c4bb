/* Dense products against sums written out, at sizes around the four columns that are taken at a time. */
#include <math.h>
#include <stdlib.h>

#include "check.h"
#include "math/dense.h"

enum { LARGEST = 9 };

static double entry(size_t i, size_t j)
{
    return sin(1.0 + 3.0 * (double)i + 7.0 * (double)j);
}

static double congruence_entry(size_t n, const double *X, const double *A, size_t i, size_t j)
{
    double sum = 0.0;
    for (size_t k = 0; k < n; k++)
        for (size_t l = 0; l < n; l++) sum += X[n * i + k] * A[n * l + k] * X[n * j + l];
    return sum;
}

static void products_are_the_sums(void **state)
{
    (void)state;
    double X[LARGEST * LARGEST], A[LARGEST * LARGEST], B[LARGEST * LARGEST], work[LARGEST * (LARGEST + 1)], y[LARGEST];
    double worst = 0.0;
    for (size_t n = 1; n <= LARGEST; n++) {
        for (size_t j = 0; j < n; j++)
            for (size_t i = 0; i < n; i++) {
                X[n * j + i] = entry(i, j);
                A[n * j + i] = B[n * j + i] = entry(j, i + 2);
            }
        dmb_dense_congruence(n, X, B, work);
        dmb_dense_times(n, A, X, y);
        for (size_t i = 0; i < n; i++) {
            double sum = 0.0;
            for (size_t j = 0; j < n; j++) {
                worst = fmax(worst, fabs(B[n * j + i] - congruence_entry(n, X, A, i, j)));
                sum += A[n * j + i] * X[j];
            }
            worst = fmax(worst, fabs(y[i] - sum));
        }
    }
    check_below("products of 1 to 9 rows", worst, 1e-13);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(products_are_the_sums),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
