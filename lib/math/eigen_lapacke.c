#include <lapacke.h>

#include "math/eigen.h"

_Static_assert(sizeof(lapack_int) == sizeof(int32_t), "LAPACKE with 64-bit integers");

/* dsyevd and dsygvd ask for 1 + 6n + 2n^2 doubles and 3 + 5n integers, and count both in integers of 32 bits, which
 * 1 + 6n + 2n^2 fits up to n = 32766. */
_Static_assert(1 + 6 * (int64_t)DMB_EIGEN_MAX + 2 * (int64_t)DMB_EIGEN_MAX * DMB_EIGEN_MAX <= INT32_MAX,
               "work of dsyevd and dsygvd");

size_t dmb_eigen_work(size_t n)
{
    if (n > DMB_EIGEN_MAX) return SIZE_MAX;
    const uint64_t m = n, count = 1 + 6 * m + 2 * m * m + (3 + 5 * m);
    return count <= SIZE_MAX / sizeof(double) ? (size_t)count : SIZE_MAX;
}

/* dgeev needs 4n; its blocked parts take some tens of n. */
size_t dmb_eigen_general_work(size_t n)
{
    return n > DMB_EIGEN_MAX ? SIZE_MAX : 40 * n;
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
