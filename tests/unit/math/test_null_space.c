/* Null spaces of matrices of known rank, held against the product of the matrix with each null vector. */
#include <math.h>

#include "check.h"
#include "math/null_space.h"

enum { LARGEST = 9 };

/* Rows are sums of `rank` rows: the triangle has that rank, and the rows times each null vector are 0. */
static void null_vectors_are_null(void **state)
{
    enum { ROWS = 2 * LARGEST };
    (void)state;
    uint64_t seed = 12;
    double worst = 0.0;
    for (size_t n = 2; n <= LARGEST; n++)
        for (size_t rank = 0; rank < n; rank++) {
            double A[ROWS][LARGEST] = {{0.0}}, R[LARGEST * LARGEST] = {0.0}, row[LARGEST], v[2 * LARGEST];
            double work[LARGEST], q[LARGEST];
            uint32_t order[LARGEST];
            for (size_t i = 0; i < ROWS; i++)
                for (size_t k = 0; k < rank; k++) {
                    const double part = draw_between(&seed, -1.0, 1.0);
                    for (size_t j = 0; j < n; j++) A[i][j] += part * sin((double)((k + 1) * (j + 3)));
                }
            for (size_t i = 0; i < ROWS; i++) {
                for (size_t j = 0; j < n; j++) row[j] = A[i][j];
                dmb_rotate_in(n, 0, R, row);
            }
            assert_int_equal(dmb_triangulate(n, 1e-9, R, order, v), rank);
            for (size_t i = 0; i < n - rank; i++) {
                double largest_of_q = 0.0;
                const dmb_triangle triangle = {n, rank, R, order};
                dmb_null_vector(&triangle, i, work, q);
                for (size_t j = 0; j < n; j++) largest_of_q = fmax(largest_of_q, fabs(q[j]));
                assert_true(largest_of_q >= 1.0);
                for (size_t k = 0; k < ROWS; k++) {
                    double sum = 0.0;
                    for (size_t j = 0; j < n; j++) sum += A[k][j] * q[j];
                    worst = fmax(worst, fabs(sum) / largest_of_q);
                }
            }
        }
    check_below("rows times null vectors, 2 to 9 columns", worst, 1e-12);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(null_vectors_are_null),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
