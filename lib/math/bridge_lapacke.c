/* LAPACK through LAPACKE, if it belongs to the build (DMB_WITH_LAPACK): linked, or loaded when an analysis requires it
 * (DMB_LAZY). If it is missing, bridge_eigen.c computes the same. */
#include "math/bridge.h"

#include <float.h>
#include <math.h>

#include "base/build.h"

/* ---- The functions of LAPACKE ------------------------------------------------------------------------------------ */

#if DMB_WITH_LAPACK
#include <fenv.h>
#include <lapacke.h>

_Static_assert(sizeof(lapack_int) == 4, "LAPACKE with 64-bit integers");
#else
typedef int32_t lapack_int;
enum { LAPACK_COL_MAJOR = 102 };
#endif

typedef lapack_int syevd(int, char, char, lapack_int, double *, lapack_int, double *, double *, lapack_int,
                         lapack_int *, lapack_int);
typedef lapack_int sygvd(int, lapack_int, char, char, lapack_int, double *, lapack_int, double *, lapack_int, double *,
                         double *, lapack_int, lapack_int *, lapack_int);
typedef lapack_int geev(int, char, char, lapack_int, double *, lapack_int, double *, double *, double *, lapack_int,
                        double *, lapack_int, double *, lapack_int);
typedef lapack_int geqp3(int, lapack_int, lapack_int, double *, lapack_int, lapack_int *, double *, double *,
                         lapack_int);
typedef lapack_int gesvd(int, char, char, lapack_int, lapack_int, double *, lapack_int, double *, double *, lapack_int,
                         double *, lapack_int, double *, lapack_int);

enum { SYEVD, SYGVD, GEEV, GEQP3, GESVD, FUNCTIONS };

typedef struct lapack {
    int present;
    dmb_foreign function[FUNCTIONS];
} lapack;

#if !DMB_WITH_LAPACK
static lapack lapack_of_build(void)
{
    const lapack none = {0, {0}};
    return none;
}
#elif DMB_LAZY
static lapack lapack_of_build(void)
{
    static const char *const names[FUNCTIONS] = {"LAPACKE_dsyevd_work", "LAPACKE_dsygvd_work", "LAPACKE_dgeev_work",
                                                 "LAPACKE_dgeqp3_work", "LAPACKE_dgesvd_work"};
    lapack found;
    found.present = dmb_foreign_load(DMB_LAPACK_SONAME, FUNCTIONS, names, found.function);
    return found;
}
#else
static lapack lapack_of_build(void)
{
    const lapack linked = {1,
                           {(dmb_foreign)LAPACKE_dsyevd_work, (dmb_foreign)LAPACKE_dsygvd_work,
                            (dmb_foreign)LAPACKE_dgeev_work, (dmb_foreign)LAPACKE_dgeqp3_work,
                            (dmb_foreign)LAPACKE_dgesvd_work}};
    return linked;
}
#endif

#if DMB_WITH_LAPACK /* functions called by pointer must have the declarations of LAPACKE */
#define SAME(name, type) _Static_assert(_Generic(&(name), type * : 1, default : 0), #name)
SAME(LAPACKE_dsyevd_work, syevd);
SAME(LAPACKE_dsygvd_work, sygvd);
SAME(LAPACKE_dgeev_work, geev);
SAME(LAPACKE_dgeqp3_work, geqp3);
SAME(LAPACKE_dgesvd_work, gesvd);
#endif

int dmb_has_lapack(void)
{
    return lapack_of_build().present;
}

/* ---- Floating-point environment ---------------------------------------------------------------------------------- */

/* LAPACK divides by zero on purpose to test the processor (ieeeck), which raises flags: a host that traps
 * floating-point exceptions would be terminated by SIGFPE. Traps are disabled during a call; flags and traps of the
 * host are restored after it. */
#if DMB_WITH_LAPACK
typedef fenv_t environment;

static void hold_exceptions(environment *host)
{
    (void)feholdexcept(host);
}

static void restore_environment(const environment *host)
{
    (void)fesetenv(host);
}
#else
typedef int32_t environment;

static void hold_exceptions(environment *host)
{
    *host = 0;
}

static void restore_environment(const environment *host)
{
    (void)host;
}
#endif

/* ---- Eigenproblems ----------------------------------------------------------------------------------------------- */

/* dsyevd and dsygvd require 1 + 6n + 2n^2 doubles and 3 + 5n integers, and count both in integers of 32 bits, in which
 * 1 + 6n + 2n^2 fits up to n = 32766. */
_Static_assert(1 + 6 * (int64_t)DMB_EIGEN_MAX + 2 * (int64_t)DMB_EIGEN_MAX * DMB_EIGEN_MAX <= INT32_MAX,
               "work of dsyevd and dsygvd");

size_t dmb_eigen_work(size_t n)
{
    if (n > DMB_EIGEN_MAX) return SIZE_MAX;
    const uint64_t m = n, count = 1 + 6 * m + 2 * m * m + (3 + 5 * m);
    return count <= SIZE_MAX / sizeof(double) ? (size_t)count : SIZE_MAX;
}

/* dgeev requires 4n; its blocked algorithms use some tens of n. */
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
    const lapack found = lapack_of_build();
    if (!found.present) return dmb_dense_symmetric(n, A, values, work);
    environment host;
    hold_exceptions(&host);
    const lapack_int failed = ((syevd *)found.function[SYEVD])(LAPACK_COL_MAJOR, 'V', 'L', m, A, m, values, work,
                                                               doubles(n), integer_work(n, work), integers(n));
    restore_environment(&host);
    return failed;
}

int32_t dmb_eigen_pair(size_t n, double *K, double *M, double *values, double *work)
{
    const lapack_int m = (lapack_int)n;
    const lapack found = lapack_of_build();
    if (!found.present) return dmb_dense_pair(n, K, M, values, work);
    environment host;
    hold_exceptions(&host);
    const lapack_int failed = ((sygvd *)found.function[SYGVD])(LAPACK_COL_MAJOR, 1, 'V', 'L', m, K, m, M, m, values,
                                                               work, doubles(n), integer_work(n, work), integers(n));
    restore_environment(&host);
    return failed;
}

int32_t dmb_eigen_general(size_t n, double *A, double *re, double *im, double *V, double *work)
{
    const lapack_int m = (lapack_int)n;
    const lapack found = lapack_of_build();
    double none;
    if (!found.present) return dmb_dense_general(n, A, re, im, V, work);
    environment host;
    hold_exceptions(&host);
    const lapack_int failed =
        ((geev *)found.function[GEEV])(LAPACK_COL_MAJOR, 'N', 'V', m, A, m, re, im, &none, 1, V, m, work, 40 * m);
    restore_environment(&host);
    return failed;
}

/* ---- Rank -------------------------------------------------------------------------------------------------------- */

#define DMB_ROW_MIN 1e-300
enum { PANEL = 32 }; /* largest number of columns that dgeqp3 processes at a time */
/* LAPACK counts its workspace, 34 rows + 32 or 3 min + 2 (rows + columns), in integers of 32 bits. */
_Static_assert(34 * (int64_t)DMB_RANK_SIDE_MAX + PANEL <= INT32_MAX, "work of dgeqp3");

static size_t least(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

/* Matrix, tau and singular values, and the workspace of LAPACK: 3n + 1 and more for QR, max(3 min + max, 5 min) for
 * values. */
static size_t lapack_work(uint32_t rows, uint32_t columns)
{
    const size_t qr = 2 * (size_t)rows + ((size_t)rows + 1) * PANEL;
    const size_t values = 3 * least(rows, columns) + 2 * ((size_t)rows + columns);
    return qr > values ? qr : values;
}

size_t dmb_rank_work(uint32_t rows, uint32_t columns)
{
    if (rows > DMB_RANK_SIDE_MAX || columns > DMB_RANK_SIDE_MAX) return SIZE_MAX;
    const size_t rest = 2 * least(rows, columns) + lapack_work(rows, columns);
    if (columns != 0 && rows > (SIZE_MAX / sizeof(double) - rest) / columns) return SIZE_MAX;
    return (size_t)rows * columns + rest;
}

/* Scales a row to unit length without overflow or underflow of squares; a row without length or with values that are
 * not finite becomes zero. */
static void scale_row(const double *b, uint32_t columns, const double *weight, double *row)
{
    double most = 0.0, sum = 0.0;
    int finite = 1;
    for (uint32_t j = 0; j < columns; j++) {
        row[j] = b[j] * weight[j];
        finite = finite && fabs(row[j]) <= DBL_MAX;
        most = fmax(most, fabs(row[j]));
    }
    const int usable = finite && most >= DMB_ROW_MIN;
    for (uint32_t j = 0; j < columns; j++) {
        row[j] = usable ? row[j] / most : 0.0;
        sum += row[j] * row[j];
    }
    for (uint32_t j = 0; j < columns && usable; j++) row[j] /= sqrt(sum);
}

/* Diagonal of R in the upper part of the matrix with columns `height` apart. */
static double diagonal(const double *a, uint32_t height, uint32_t k)
{
    return fabs(a[(size_t)k * height + k]);
}

/* Data of a rank computation, in the caller's memory. */
typedef struct rank_work {
    lapack found;
    uint32_t rows, columns;
    double *a, *tau, *s, *rest; /* (rows, columns) (least) (least) (size) */
    lapack_int size;
} rank_work;

/* Singular values of R into s; 0 if the computation fails. */
static int singular_values(const rank_work *w)
{
    const uint32_t rows = w->rows, columns = w->columns;
    const lapack_int n = (lapack_int)least(rows, columns);
    if (n > DMB_RANK_SINGULAR_MAX) return 0;
    for (uint32_t j = 0; j < rows; j++)
        for (uint32_t i = j + 1; i < (uint32_t)n; i++) w->a[(size_t)j * columns + i] = 0.0;
    if (!w->found.present) {
        dmb_dense_singular((size_t)n, rows, columns, w->a, w->s);
        return 1;
    }
    environment host;
    hold_exceptions(&host);
    const lapack_int failed =
        ((gesvd *)w->found.function[GESVD])(LAPACK_COL_MAJOR, 'N', 'N', n, (lapack_int)rows, w->a, (lapack_int)columns,
                                            w->s, NULL, 1, NULL, 1, w->rest, w->size);
    restore_environment(&host);
    return failed == 0;
}

/* The row-major matrix is, read column-major, its transpose: the columns are the equations. LAPACK counts them from 1.
 */
static void order_rows(const rank_work *w, int32_t *order)
{
    for (uint32_t i = 0; i < w->rows; i++) order[i] = 0; /* 0: LAPACK may exchange it */
    if (!w->found.present) {
        dmb_dense_pivoted_qr(w->columns, w->rows, w->a, order, w->rest);
        return;
    }
    environment host;
    hold_exceptions(&host);
    (void)((geqp3 *)w->found.function[GEQP3])(LAPACK_COL_MAJOR, (lapack_int)w->columns, (lapack_int)w->rows, w->a,
                                              (lapack_int)w->columns, order, w->tau, w->rest, w->size);
    restore_environment(&host);
    for (uint32_t i = 0; i < w->rows; i++) order[i]--;
}

void dmb_rank_of_rows(const dmb_weighted_rows *of, double tolerance, double *work, int32_t *order, dmb_rank *out)
{
    const uint32_t rows = of->rows, columns = of->columns;
    const size_t n = least(rows, columns);
    const lapack_int work_size = (lapack_int)lapack_work(rows, columns);
    double *a = work, *tau = a + (size_t)rows * columns, *s = tau + n, *rest = s + n;
    out->rank = 0;
    out->exact = 1;
    out->largest = out->smallest = 1.0;
    for (uint32_t i = 0; i < rows; i++) order[i] = (int32_t)i;
    if (n == 0) return;
    const rank_work w = {lapack_of_build(), rows, columns, a, tau, s, rest, work_size};
    for (uint32_t i = 0; i < rows; i++)
        scale_row(of->values + (size_t)i * columns, columns, of->weight, a + (size_t)i * columns);
    order_rows(&w, order);
    while (out->rank < n && diagonal(a, columns, out->rank) > tolerance) out->rank++;
    if (out->rank == 0) return;
    out->largest = diagonal(a, columns, 0);
    out->smallest = diagonal(a, columns, out->rank - 1);
    out->exact = singular_values(&w);
    if (!out->exact) return;
    out->largest = s[0];
    out->smallest = s[out->rank - 1];
}
