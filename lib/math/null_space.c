/* Null space of a square matrix by QR factors: rows are accumulated by Givens rotations (dmb_rotate_in), and the
 * triangle is made rank-revealing by Householder reflections with column pivoting. With R = [R1 R2] after the pivoting,
 * null vectors are (-R1^-1 R2 e_i; e_i), in the order of the pivoting. */
#include "math/null_space.h"

#include <math.h>
#include <string.h>

/* Rotates a new row into the triangle R, so that R^T R grows by row^T row; entries before `from` are 0. */
void dmb_rotate_in(size_t n, size_t from, double *R, double *row)
{
    for (size_t k = from; k < n; k++) {
        double *pivot = R + n * k;
        if (row[k] == 0.0) continue;
        const double size = hypot(pivot[k], row[k]), c = pivot[k] / size, s = row[k] / size;
        for (size_t j = k; j < n; j++) {
            const double above = pivot[j], here = row[j];
            pivot[j] = c * above + s * here;
            row[j] = c * here - s * above;
        }
        row[k] = 0.0;
    }
}

static double tail_square(size_t n, size_t k, const double *A, size_t column)
{
    double sum = 0.0;
    for (size_t i = k; i < n; i++) sum += A[n * i + column] * A[n * i + column];
    return sum;
}

static void exchange_columns(size_t n, double *A, uint32_t *order, size_t a, size_t b)
{
    const uint32_t kept = order[a];
    order[a] = order[b];
    order[b] = kept;
    for (size_t i = 0; a != b && i < n; i++) {
        const double value = A[n * i + a];
        A[n * i + a] = A[n * i + b];
        A[n * i + b] = value;
    }
}

/* Applies the reflection that makes column k of A zero below its diagonal, to all later columns; v: shape (2n). */
static void reflect(size_t n, size_t k, double norm, double *A, double *v)
{
    double *products = v + n, square = 0.0;
    const double alpha = A[n * k + k] > 0.0 ? -norm : norm;
    for (size_t i = k; i < n; i++) v[i] = A[n * i + k];
    v[k] -= alpha;
    for (size_t i = k; i < n; i++) square += v[i] * v[i];
    memset(products, 0, n * sizeof(double));
    for (size_t i = k; i < n; i++)
        for (size_t j = k; j < n; j++) products[j] += v[i] * A[n * i + j];
    for (size_t i = k; i < n; i++)
        for (size_t j = k; j < n; j++) A[n * i + j] -= 2.0 / square * v[i] * products[j];
}

/* Returns the rank: the number of columns whose remainder exceeds the tolerance. */
size_t dmb_triangulate(size_t n, double tolerance, double *A, uint32_t *order, double *v)
{
    for (size_t k = 0; k < n; k++) order[k] = (uint32_t)k;
    for (size_t k = 0; k < n; k++) {
        size_t most = k;
        double square = -1.0;
        for (size_t j = k; j < n; j++) {
            const double here = tail_square(n, k, A, j);
            if (here > square) square = here, most = j;
        }
        if (!(sqrt(square) > tolerance)) return k;
        exchange_columns(n, A, order, k, most);
        reflect(n, k, sqrt(square), A, v);
    }
    return n;
}

void dmb_null_vector(const dmb_triangle *triangle, size_t i, double *work, double *q)
{
    const size_t n = triangle->n, rank = triangle->rank;
    const double *A = triangle->A;
    const uint32_t *order = triangle->order;
    for (size_t k = rank; k-- > 0;) {
        double sum = -A[n * k + rank + i];
        for (size_t j = k + 1; j < rank; j++) sum -= A[n * k + j] * work[j];
        work[k] = sum / A[n * k + k];
    }
    memset(q, 0, n * sizeof(double));
    for (size_t k = 0; k < rank; k++) q[order[k]] = work[k];
    q[order[rank + i]] = 1.0;
}
