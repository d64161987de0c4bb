/* Symmetric: cyclic Jacobi rotations (Golub, Van Loan, Matrix Computations, 4th ed., 8.5). Pair: reduced by the
 * Cholesky factor of M (8.7). */
#include "math/bridge.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum { SWEEPS = 60 };

/* ---- Symmetric --------------------------------------------------------------------------------------------------- */

static void turn(size_t n, double *x, double *y, size_t step, double c, double s)
{
    for (size_t i = 0; i < n; i++) {
        const double p = x[i * step], q = y[i * step];
        x[i * step] = c * p - s * q;
        y[i * step] = s * p + c * q;
    }
}

/* Makes A_pq zero: tan 2 phi = 2 A_pq / (A_qq - A_pp), the smaller angle. */
static void rotate(size_t n, double *A, double *V, size_t p, size_t q)
{
    const double off = A[p + n * q], theta = 0.5 * (A[q + n * q] - A[p + n * p]) / off;
    const double t = copysign(1.0, theta) / (fabs(theta) + sqrt(1.0 + theta * theta));
    const double c = 1.0 / sqrt(1.0 + t * t), s = t * c;
    const double low = A[p + n * p] - t * off, high = A[q + n * q] + t * off; /* less rounding than by rotation */
    turn(n, A + p, A + q, n, c, s);
    turn(n, A + n * p, A + n * q, 1, c, s);
    turn(n, V + n * p, V + n * q, 1, c, s);
    A[p + n * p] = low;
    A[q + n * q] = high;
    A[p + n * q] = A[q + n * p] = 0.0;
}

/* Scaled by the largest entry: squares do not overflow. */
static double frobenius(size_t count, const double *A)
{
    double most = 0.0, sum = 0.0;
    for (size_t i = 0; i < count; i++) most = fmax(most, fabs(A[i]));
    if (!(most > 0.0)) return 0.0;
    for (size_t i = 0; i < count; i++) sum += (A[i] / most) * (A[i] / most);
    return most * sqrt(sum);
}

/* Rotations of one sweep. An entry below the rounding of its own diagonal, or far below that of the matrix, is not
 * rotated. */
static size_t sweep(size_t n, double *A, double *V, double norm)
{
    size_t turned = 0;
    for (size_t p = 0; p + 1 < n; p++) {
        for (size_t q = p + 1; q < n; q++) {
            const double off = fabs(A[p + n * q]);
            const double own = 0.25 * DBL_EPSILON * sqrt(fabs(A[p + n * p])) * sqrt(fabs(A[q + n * q]));
            if (off <= own || off <= 1e-3 * DBL_EPSILON / (double)n * norm) continue;
            rotate(n, A, V, p, q);
            turned++;
        }
    }
    return turned;
}

static void exchange(size_t n, double *x, double *y)
{
    for (size_t i = 0; i < n; i++) {
        const double kept = x[i];
        x[i] = y[i];
        y[i] = kept;
    }
}

static void sort_ascending(size_t n, double *values, double *V)
{
    for (size_t k = 0; k + 1 < n; k++) {
        size_t least = k;
        for (size_t i = k + 1; i < n; i++)
            if (values[i] < values[least]) least = i;
        if (least == k) continue;
        exchange(1, values + k, values + least);
        exchange(n, V + n * k, V + n * least);
    }
}

/* Sweeps until one has nothing to rotate. The lower triangle is taken; the columns of A become the eigenvectors in the
 * order of ascending values. */
int32_t dmb_dense_symmetric(size_t n, double *A, double *values, double *work)
{
    double *V = work;
    int tries = 0;
    for (size_t j = 0; j < n; j++)
        for (size_t i = j + 1; i < n; i++) A[j + n * i] = A[i + n * j];
    memset(V, 0, n * n * sizeof(double));
    for (size_t k = 0; k < n; k++) V[k + n * k] = 1.0;
    const double norm = frobenius(n * n, A);
    if (!(norm <= DBL_MAX)) return 1;
    while (sweep(n, A, V, norm) > 0)
        if (++tries == SWEEPS) return 1;
    for (size_t k = 0; k < n; k++) values[k] = A[k + n * k];
    memcpy(A, V, n * n * sizeof(double));
    sort_ascending(n, values, A);
    return 0;
}

/* ---- Pair -------------------------------------------------------------------------------------------------------- */

/* M = L L^T, L in the lower triangle; 0, or 1 + the row whose pivot is not positive. */
static size_t cholesky(size_t n, double *M)
{
    for (size_t j = 0; j < n; j++) {
        for (size_t k = 0; k < j; k++)
            for (size_t i = j; i < n; i++) M[i + n * j] -= M[i + n * k] * M[j + n * k];
        const double pivot = M[j + n * j];
        if (!(pivot > 0.0 && pivot <= DBL_MAX)) return j + 1;
        for (size_t i = j; i < n; i++) M[i + n * j] /= sqrt(pivot);
    }
    return 0;
}

/* x = L^-1 x, elements of x `step` apart */
static void solve_lower(size_t n, const double *L, double *x, size_t step)
{
    for (size_t k = 0; k < n; k++) {
        x[k * step] /= L[k + n * k];
        for (size_t i = k + 1; i < n; i++) x[i * step] -= L[i + n * k] * x[k * step];
    }
}

/* x = L^-T x */
static void solve_upper(size_t n, const double *L, double *x)
{
    for (size_t k = n; k-- > 0;) {
        for (size_t i = k + 1; i < n; i++) x[k] -= L[i + n * k] * x[i];
        x[k] /= L[k + n * k];
    }
}

/* K x = value M x as the symmetric problem L^-1 K L^-T y = value y, x = L^-T y, so that x . M x = 1. Both sides are
 * applied to the full matrix. */
int32_t dmb_dense_pair(size_t n, double *K, double *M, double *values, double *work)
{
    const size_t wrong = cholesky(n, M);
    if (wrong > 0) return (int32_t)(n + wrong);
    for (size_t j = 0; j < n; j++)
        for (size_t i = j + 1; i < n; i++) K[j + n * i] = K[i + n * j];
    for (size_t j = 0; j < n; j++) solve_lower(n, M, K + n * j, 1);
    for (size_t i = 0; i < n; i++) solve_lower(n, M, K + i, n);
    const int32_t status = dmb_dense_symmetric(n, K, values, work);
    for (size_t j = 0; j < n; j++) solve_upper(n, M, K + n * j);
    return status;
}

/* ---- Rank -------------------------------------------------------------------------------------------------------- */

/* QR with column pivoting by Householder reflections (Golub, Van Loan, Matrix Computations, 4th ed., 5.4.2), and
 * singular values by one-sided Jacobi rotations of the rows of R (8.6.3). */

static double length_of(size_t n, const double *x, size_t step)
{
    double most = 0.0, sum = 0.0;
    for (size_t i = 0; i < n; i++) most = fmax(most, fabs(x[i * step]));
    if (!(most > 0.0)) return 0.0;
    for (size_t i = 0; i < n; i++) sum += (x[i * step] / most) * (x[i * step] / most);
    return most * sqrt(sum);
}

static void exchange_columns(size_t height, double *a, int32_t *order, size_t p, size_t q)
{
    const int32_t kept = order[p];
    order[p] = order[q];
    order[q] = kept;
    for (size_t i = 0; i < height; i++) {
        const double value = a[i + height * p];
        a[i + height * p] = a[i + height * q];
        a[i + height * q] = value;
    }
}

/* Of columns from k on, the one with the greatest length below row k: lengths are recomputed, so that they do not lose
 * accuracy. */
static size_t longest(size_t height, size_t width, const double *a, size_t k)
{
    size_t found = k;
    double most = -1.0;
    for (size_t j = k; j < width; j++) {
        const double here = length_of(height - k, a + k + height * j, 1);
        if (here > most) found = j;
        most = fmax(most, here);
    }
    return found;
}

/* Column k becomes (..., -+length, 0, ...), the later ones (I - beta v v^T) of theirs. */
static void reflect(size_t height, size_t width, double *a, size_t k, double *v)
{
    double *x = a + k + height * k;
    const size_t m = height - k;
    const double length = length_of(m, x, 1);
    if (!(length > 0.0)) return;
    for (size_t i = 0; i < m; i++) v[i] = x[i] / length;
    v[0] += copysign(1.0, v[0]);
    const double beta = 1.0 / fabs(v[0]); /* 2 / v^T v */
    for (size_t j = k + 1; j < width; j++) {
        double *y = a + k + height * j, sum = 0.0;
        for (size_t i = 0; i < m; i++) sum += v[i] * y[i];
        for (size_t i = 0; i < m; i++) y[i] -= beta * sum * v[i];
    }
    x[0] = -copysign(length, x[0]);
    for (size_t i = 1; i < m; i++) x[i] = 0.0;
}

void dmb_dense_pivoted_qr(size_t height, size_t width, double *a, int32_t *order, double *work)
{
    const size_t n = height < width ? height : width;
    for (size_t j = 0; j < width; j++) order[j] = (int32_t)j;
    for (size_t k = 0; k < n; k++) {
        exchange_columns(height, a, order, k, longest(height, width, a, k));
        reflect(height, width, a, k, work);
    }
}

/* Makes rows p and q orthogonal; returns 0 if they are orthogonal already. */
static int make_orthogonal(size_t width, size_t height, double *p, double *q)
{
    double pp = 0.0, qq = 0.0, pq = 0.0;
    for (size_t j = 0; j < width; j++) {
        const double x = p[j * height], y = q[j * height];
        pp += x * x;
        qq += y * y;
        pq += x * y;
    }
    if (fabs(pq) <= DBL_EPSILON * sqrt(pp) * sqrt(qq)) return 0;
    const double theta = 0.5 * (qq - pp) / pq;
    const double t = copysign(1.0, theta) / (fabs(theta) + sqrt(1.0 + theta * theta));
    const double c = 1.0 / sqrt(1.0 + t * t), s = t * c;
    for (size_t j = 0; j < width; j++) {
        const double x = p[j * height], y = q[j * height];
        p[j * height] = c * x - s * y;
        q[j * height] = s * x + c * y;
    }
    return 1;
}

static int turn_all(size_t n, size_t width, size_t height, double *a)
{
    int turned = 0;
    for (size_t p = 0; p + 1 < n; p++)
        for (size_t q = p + 1; q < n; q++) turned |= make_orthogonal(width, height, a + p, a + q);
    return turned;
}

/* Singular values of the first n rows: rotated until they are orthogonal in pairs, their lengths are the values, sorted
 * in descending order. */
void dmb_dense_singular(size_t n, size_t width, size_t height, double *a, double *values)
{
    for (int i = 0; i < SWEEPS && turn_all(n, width, height, a); i++) continue;
    for (size_t k = 0; k < n; k++) {
        const double value = length_of(width, a + k, height);
        size_t at = k;
        for (; at > 0 && values[at - 1] < value; at--) values[at] = values[at - 1];
        values[at] = value;
    }
}
