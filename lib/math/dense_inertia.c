/* Symmetric elimination with pivots of one or two rows (Bunch, Parlett 1971); each tells its signs. */
#include "math/dense_inertia.h"

#include <math.h>
#include <stddef.h>

static void exchange(size_t n, double *A, size_t i, size_t j)
{
    if (i == j) return;
    for (size_t k = 0; k < n; k++) {
        const double t = A[n * i + k];
        A[n * i + k] = A[n * j + k];
        A[n * j + k] = t;
    }
    for (size_t k = 0; k < n; k++) {
        const double t = A[n * k + i];
        A[n * k + i] = A[n * k + j];
        A[n * k + j] = t;
    }
}

/* Largest diagonal entry p, and off-diagonal entry (r, s), r > s, of what is left. */
static void look_for_pivot(size_t n, const double *A, size_t k, size_t *p, size_t *r, size_t *s)
{
    double off = 0.0;
    *p = *r = *s = k;
    for (size_t i = k; i < n; i++) {
        if (fabs(A[n * i + i]) > fabs(A[n * *p + *p])) *p = i;
        for (size_t j = k; j < i; j++) {
            if (!(fabs(A[n * i + j]) > off)) continue;
            off = fabs(A[n * i + j]);
            *r = i;
            *s = j;
        }
    }
}

static uint32_t eliminate_one(size_t n, double *A, size_t k)
{
    const double pivot = A[n * k + k];
    if (pivot == 0.0) return 0; /* nothing but zeros is left */
    for (size_t i = k + 1; i < n; i++) {
        const double factor = A[n * i + k] / pivot;
        for (size_t j = k + 1; j < n; j++) A[n * i + j] -= factor * A[n * k + j];
    }
    return pivot < 0.0;
}

/* A pivot of two rows has one eigenvalue of each sign. */
static uint32_t eliminate_two(size_t n, double *A, size_t k)
{
    const double a = A[n * k + k], b = A[n * k + k + 1], c = A[n * (k + 1) + k + 1], determinant = a * c - b * b;
    for (size_t i = k + 2; i < n; i++) {
        const double x = (c * A[n * i + k] - b * A[n * i + k + 1]) / determinant;
        const double y = (a * A[n * i + k + 1] - b * A[n * i + k]) / determinant;
        for (size_t j = k + 2; j < n; j++) A[n * i + j] -= x * A[n * k + j] + y * A[n * (k + 1) + j];
    }
    return 1;
}

/* Bunch and Parlett's bound on the growth of the entries: (1 + sqrt 17)/8 */
#define DMB_PIVOT_RATIO 0.6403882032022076

uint32_t dmb_dense_negative(uint32_t n, double *A)
{
    const size_t rows = n;
    uint32_t negative = 0;
    for (size_t i = 0; i < rows; i++)
        for (size_t j = 0; j < i; j++) A[rows * i + j] = A[rows * j + i] = 0.5 * (A[rows * i + j] + A[rows * j + i]);
    for (size_t k = 0; k < rows;) {
        size_t p, r, s;
        look_for_pivot(rows, A, k, &p, &r, &s);
        if (r != s && fabs(A[rows * p + p]) < DMB_PIVOT_RATIO * fabs(A[rows * r + s])) {
            exchange(rows, A, k, s);
            exchange(rows, A, k + 1, r);
            negative += eliminate_two(rows, A, k);
            k += 2;
        } else {
            exchange(rows, A, k, p);
            negative += eliminate_one(rows, A, k);
            k += 1;
        }
    }
    return negative;
}

/* L U, and the exchanges taken back from the last to the first. */
void dmb_dense_from_factors(uint32_t n, const double *LU, const uint32_t *pivot, double *A)
{
    const size_t rows = n;
    for (size_t i = 0; i < rows; i++)
        for (size_t j = 0; j < rows; j++) {
            double sum = 0.0;
            for (size_t k = 0; k <= i && k <= j; k++)
                sum += (k == i ? 1.0 : LU[rows * i + k]) * (k == j ? 1.0 / LU[rows * k + k] : LU[rows * k + j]);
            A[rows * i + j] = sum;
        }
    for (size_t k = rows; k-- > 0;)
        for (size_t j = 0; j < rows && pivot[k] != k; j++) {
            const double t = A[rows * k + j];
            A[rows * k + j] = A[rows * pivot[k] + j];
            A[rows * pivot[k] + j] = t;
        }
}
