#include <lapacke.h>

#include "math/eigen.h"

_Static_assert(sizeof(lapack_int) == sizeof(int32_t), "LAPACKE with 64-bit integers");

/* What dsyevd and dsygvd ask for with vectors: 1 + 6n + 2n^2 doubles and 3 + 5n integers; dgeev does with 4n and likes
 * some tens of n. */
size_t dmb_eigen_work(size_t n)
{
    if (n > 46000) return SIZE_MAX; /* 2n^2 is to fit LAPACK's integers */
    return 1 + 6 * n + 2 * n * n + (3 + 5 * n) + 40 * n;
}

static lapack_int doubles(size_t n)
{
    return (lapack_int)(1 + 6 * n + 2 * n * n);
}

static lapack_int integers(size_t n)
{
    return (lapack_int)(3 + 5 * n);
}

static lapack_int *integer_work(size_t n, double *work)
{
    return (lapack_int *)(work + doubles(n));
}

int32_t dmb_eigen_symmetric(size_t n, double *A, double *values, double *work)
{
    const lapack_int m = (lapack_int)n;
    return LAPACKE_dsyevd_work(LAPACK_COL_MAJOR, 'V', 'L', m, A, m, values, work, doubles(n), integer_work(n, work),
                               integers(n));
}

int32_t dmb_eigen_pair(size_t n, double *K, double *M, double *values, double *work)
{
    const lapack_int m = (lapack_int)n;
    return LAPACKE_dsygvd_work(LAPACK_COL_MAJOR, 1, 'V', 'L', m, K, m, M, m, values, work, doubles(n),
                               integer_work(n, work), integers(n));
}

int32_t dmb_eigen_general(size_t n, double *A, double *re, double *im, double *V, double *work)
{
    const lapack_int m = (lapack_int)n;
    double none;
    return LAPACKE_dgeev_work(LAPACK_COL_MAJOR, 'N', 'V', m, A, m, re, im, &none, 1, V, m, work, 40 * m);
}
