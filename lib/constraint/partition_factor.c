/* Factoring is the Crout form of LU, P C_d = L U with U of unit diagonal: a factor of a row of C_d then stands in that
 * row of L alone, so that rows are scaled for the choice of exchanges and scaled back afterwards without a place to
 * keep the scales. Inner loops run along rows. Rows with a factor 0 are skipped. */
#include "constraint/partition_row.h"

/* Largest |x_j| weight_j. */
static double weighted_largest(size_t n, const double *x, const double *weight)
{
    double m[4] = {0.0, 0.0, 0.0, 0.0};
    size_t j = 0;
    for (; j + 4 <= n; j += 4)
        for (size_t i = 0; i < 4; i++) m[i] = larger(fabs(x[j + i] * weight[j + i]), m[i]);
    for (; j < n; j++) m[0] = larger(fabs(x[j] * weight[j]), m[0]);
    return larger(larger(m[0], m[1]), larger(m[2], m[3]));
}

/* C_d with rows of unit length as in choosing; a row that cannot be scaled becomes zero. Returns the largest entry of
 * the scaled pivot rows, independent columns included. */
static double gather_dependent(const double *B, uint32_t stride, const double *weight, const dmb_partition *p,
                               double *lu)
{
    const size_t n = p->rank;
    double most = 0.0;
    for (size_t k = 0; k < n; k++) {
        const double *b = B + (size_t)p->row_order[k] * stride;
        const double length = row_length(p->columns, b, weight);
        const double scale = usable(length) ? 1.0 / length : 0.0;
        most = larger(weighted_largest(p->columns, b, weight) * scale, most);
        for (size_t j = 0; j < n; j++) lu[n * k + j] = b[p->column_order[j]] * scale;
    }
    return most;
}

/* Where the choice is still a good one its own pivot is kept, as in find_pivot. */
static uint32_t pivot_of_column(uint32_t n, uint32_t k, const double *lu)
{
    uint32_t at = k;
    double best = fabs(lu[(size_t)n * k + k]);
    for (uint32_t i = k + 1; i < n; i++) {
        const double v = fabs(lu[(size_t)n * i + k]);
        if (!(v > best * DMB_CLEARLY)) continue;
        best = v;
        at = i;
    }
    return at;
}

/* The row before all exchanges of the one that stands at k after exchange k. */
static uint32_t origin(const uint32_t *pivot, uint32_t k)
{
    uint32_t at = k;
    for (uint32_t j = k + 1; j-- > 0;) at = at == pivot[j] ? j : at == j ? pivot[j] : at;
    return at;
}

/* Step k of Crout elimination: row k of U, and the rows below less what they have of it. */
static void factor_step(size_t n, size_t k, double reciprocal, double *lu)
{
    double *row = lu + n * k;
    const size_t behind = n - k - 1;
    uint32_t places[DMB_PLACES];
    row_multiply(behind, reciprocal, row + k + 1);
    const size_t count = find_places(behind, row + k + 1, places);
    for (size_t i = k + 1; i < n; i++) {
        double *below = lu + n * i;
        if (below[k] != 0.0) row_subtract_at(behind, count, places, below[k], row + k + 1, below + k + 1);
    }
}

/* Row k is final after step k: its part of L goes back to the length of the row of B, its pivot is kept as reciprocal.
 */
double dmb_partition_factor(const double *B, uint32_t stride, const double *weight, const dmb_partition *partition,
                            double *lu, uint32_t *pivot)
{
    const dmb_partition *p = partition;
    const size_t n = p->rank;
    if (n == 0) return 1.0;
    for (uint32_t k = 0; k < n; k++) pivot[k] = k; /* all within range, even where singular */
    double largest = gather_dependent(B, stride, weight, p, lu), smallest = DBL_MAX;
    for (uint32_t k = 0; k < n; k++) {
        double *row = lu + n * k;
        pivot[k] = pivot_of_column(p->rank, k, lu);
        if (pivot[k] != k) row_swap(n, row, lu + n * pivot[k]);
        const double size = fabs(row[k]) * weight[p->column_order[k]], reciprocal = 1.0 / row[k];
        const double length = row_length(p->columns, B + (size_t)p->row_order[origin(pivot, k)] * stride, weight);
        if (!(size > 0.0 && size <= DBL_MAX && fabs(reciprocal / length) <= DBL_MAX)) return 0.0;
        if (size < smallest) smallest = size;
        if (size > largest) largest = size;
        factor_step(n, k, reciprocal, lu);
        row_multiply(k, length, row);
        row[k] = reciprocal / length;
    }
    return smallest / largest;
}

/* C_d x = P^T L U x */
void dmb_partition_solve(const dmb_partition *partition, const double *lu, const uint32_t *pivot, double *x)
{
    const size_t n = partition->rank;
    for (size_t k = 0; k < n; k++)
        if (pivot[k] != k) row_swap(1, x + k, x + pivot[k]);
    for (size_t k = 0; k < n; k++) x[k] = (x[k] - dot(k, lu + n * k, x)) * lu[n * k + k];
    for (size_t k = n; k-- > 0;) x[k] -= dot(n - k - 1, lu + n * k + k + 1, x + k + 1);
}

/* C_d^T x = U^T L^T P x */
void dmb_partition_solve_transposed(const dmb_partition *partition, const double *lu, const uint32_t *pivot, double *x)
{
    const size_t n = partition->rank;
    for (size_t k = 0; k < n; k++) row_subtract(n - k - 1, x[k], lu + n * k + k + 1, x + k + 1);
    for (size_t k = n; k-- > 0;) {
        x[k] *= lu[n * k + k];
        row_subtract(k, x[k], lu + n * k, x);
    }
    for (size_t k = n; k-- > 0;)
        if (pivot[k] != k) row_swap(1, x + k, x + pivot[k]);
}

/* dmb_partition_solve of all columns of -C_i at once, a row of G at a time. */
void dmb_partition_null_space(const double *B, uint32_t stride, const dmb_partition *partition, const double *lu,
                              const uint32_t *pivot, double *G)
{
    const size_t n = partition->rank, m = partition->columns - n;
    const uint32_t *independent = partition->column_order + n;
    for (size_t k = 0; k < n; k++) {
        const double *b = B + (size_t)partition->row_order[k] * stride;
        for (size_t j = 0; j < m; j++) G[m * k + j] = -b[independent[j]];
    }
    for (size_t k = 0; k < n; k++)
        if (pivot[k] != k) row_swap(m, G + m * k, G + m * pivot[k]);
    for (size_t k = 0; k < n; k++) {
        for (size_t j = 0; j < k; j++)
            if (lu[n * k + j] != 0.0) row_subtract(m, lu[n * k + j], G + m * j, G + m * k);
        row_multiply(m, lu[n * k + k], G + m * k);
    }
    for (size_t k = n; k-- > 0;)
        for (size_t j = k + 1; j < n; j++)
            if (lu[n * k + j] != 0.0) row_subtract(m, lu[n * k + j], G + m * j, G + m * k);
}
