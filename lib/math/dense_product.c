#include "math/dense_product.h"

#include <string.h>

/* y += A(:, k .. k+3) x(k .. k+3) */
static void add_four(size_t n, const double *restrict A, const double *x, double *restrict y)
{
    const double *b = A + n, *c = b + n, *d = c + n;
    for (size_t i = 0; i < n; i++) y[i] += A[i] * x[0] + b[i] * x[1] + c[i] * x[2] + d[i] * x[3];
}

void dmb_dense_times(size_t n, const double *A, const double *x, double *y)
{
    size_t k = 0;
    memset(y, 0, n * sizeof(double));
    for (; k + 4 <= n; k += 4) add_four(n, A + n * k, x + k, y);
    for (; k < n; k++)
        for (size_t i = 0; i < n; i++) y[i] += A[n * k + i] * x[k];
}

/* out = (A X)^T */
static void times_transposed(size_t n, const double *A, const double *X, double *column, double *out)
{
    for (size_t j = 0; j < n; j++) {
        dmb_dense_times(n, A, X + n * j, column);
        for (size_t i = 0; i < n; i++) out[n * i + j] = column[i];
    }
}

/* (A X)^T X is the transpose of what is wanted. */
void dmb_dense_congruence(size_t n, const double *X, double *A, double *work)
{
    double *column = work + n * n;
    times_transposed(n, A, X, column, work);
    times_transposed(n, work, X, column, A);
}
