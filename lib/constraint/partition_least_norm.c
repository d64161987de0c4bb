/* Multipliers of least norm: what of them does nothing is taken off. */
#include "constraint/partition_row.h"

/* Row s of N = [X, -I], X = B_red(:, dep) C_d^-1: redundant row s as combination of the pivot rows, less itself. */
static void left_null_vector(const double *B, uint32_t stride, const dmb_partition *p, const double *lu,
                             const uint32_t *pivot, size_t s, double *v)
{
    const size_t n = p->rank;
    const double *b = B + (size_t)p->row_order[n + s] * stride;
    for (size_t k = 0; k < n; k++) v[k] = b[p->column_order[k]];
    dmb_partition_solve_transposed(p, lu, pivot, v);
    for (size_t k = n; k < p->rows; k++) v[k] = k == n + s ? -1.0 : 0.0;
}

/* The longest of the rows of N from s on, moved to s. */
static void longest_first(size_t n, size_t redundant, size_t s, double *N)
{
    size_t at = s;
    double most = 0.0;
    for (size_t t = s; t < redundant; t++) {
        const double square = dot(n, N + n * t, N + n * t);
        if (!(square > most)) continue;
        most = square;
        at = t;
    }
    if (at != s) row_swap(n, N + n * s, N + n * at);
}

/* Row s of N at unit length, once more orthogonal to the rows before it ("twice is enough": Giraud, Langou, Rozloznik,
 * Comput. Math. Appl. 50, 2005), and the rows behind orthogonal to it. Each row has its -1 where those before it have
 * zeros, so no length is below 1. */
static void orthonormalise(size_t n, size_t redundant, size_t s, double *N)
{
    double *v = N + n * s;
    for (size_t t = 0; t < s; t++) row_subtract(n, dot(n, N + n * t, v), N + n * t, v);
    row_multiply(n, 1.0 / sqrt(dot(n, v, v)), v);
    for (size_t t = s + 1; t < redundant; t++) row_subtract(n, dot(n, v, N + n * t), v, N + n * t);
}

/* f - N^T (N N^T)^-1 N f by modified Gram-Schmidt on the rows of N, the longest first (Golub and Van
 * Loan, 5.2, 5.4). Not by Cholesky of N N^T = X X^T + I, which has the square of the condition number of N: X holds
 * the ratios of lengths of rows, which differ by their units. Without "longest first" B^T f suffers when these span ten
 * decades. */
void dmb_partition_least_norm(const double *B, uint32_t stride, const dmb_partition *partition, const double *lu,
                              const uint32_t *pivot, double *work, double *f)
{
    const size_t n = partition->rows, redundant = n - partition->rank;
    const uint32_t *order = partition->row_order;
    for (size_t s = 0; s < redundant; s++) left_null_vector(B, stride, partition, lu, pivot, s, work + n * s);
    for (size_t s = 0; s < redundant; s++) {
        double *v = work + n * s, along = 0.0;
        longest_first(n, redundant, s, work);
        orthonormalise(n, redundant, s, work);
        for (size_t k = 0; k < n; k++) along += v[k] * f[order[k]];
        for (size_t k = 0; k < n; k++) f[order[k]] -= along * v[k];
    }
}
