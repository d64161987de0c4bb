/* QR with column pivoting by Householder reflections (Golub, Van Loan, Matrix Computations, 4th ed., 5.4.2), and
 * singular values by one-sided Jacobi rotations of the rows of R (8.6.3). */
#include <float.h>
#include <math.h>

#include "math/dense_eigen.h"

enum { SWEEPS = 60 };

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

/* Of columns from k on, the one that is longest below row k: lengths are computed anew, so that none is lost. */
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

/* Rows p and q become orthogonal; 0 where they are. */
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
