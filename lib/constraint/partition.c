/* The choice of dependent coordinates is Gaussian elimination with complete pivoting (Golub and Van Loan, Matrix
 * Computations, 3.4) of rows scaled to unit length in weighted columns (Wehage, Haug, J. Mech. Design 104, 1982). */
#include "constraint/partition.h"

#include "constraint/partition_rows.h"

/* Largest |x_j|. */
static double row_largest(size_t n, const double *x)
{
    double m[4] = {0.0, 0.0, 0.0, 0.0};
    size_t j = 0;
    for (; j + 4 <= n; j += 4)
        for (size_t i = 0; i < 4; i++) m[i] = larger(fabs(x[j + i]), m[i]);
    for (; j < n; j++) m[0] = larger(fabs(x[j]), m[0]);
    return larger(larger(m[0], m[1]), larger(m[2], m[3]));
}

/* Writes the rows of B diag(weight), scaled to unit length, into a, and their largest entries into top; rows of length
 * zero and rows that are not finite become zero. Returns whether all are finite. */
static bool scale_rows(const double *B, uint32_t stride, const double *weight, const dmb_partition *p, double *a,
                       double *top)
{
    const size_t n = p->columns;
    bool finite = true;
    for (size_t i = 0; i < p->rows; i++) {
        const double *b = B + i * stride;
        const double length = row_length(n, b, weight);
        const double scale = usable(length) ? 1.0 / length : 0.0;
        double *row = a + i * n;
        for (size_t j = 0; j < n; j++) row[j] = scale > 0.0 ? b[j] * weight[j] * scale : 0.0;
        top[i] = row_largest(n, row);
        finite = finite && length <= DBL_MAX;
    }
    return finite;
}

/* Finds the largest entry of the remaining rows and its places in the two orders. Both orders are scanned ascending, so
 * that the first of equal entries is chosen. The tolerance for "equal" is wider than rounding, because symmetric
 * mechanisms have many equal candidates. */
static double find_pivot(const dmb_partition *p, const double *a, const double *top, uint32_t *row_place,
                         uint32_t *column_place)
{
    double best = 0.0;
    for (uint32_t s = p->rank; s < p->rows; s++) {
        const size_t i = p->row_order[s];
        if (!(top[i] > best * DMB_CLEARLY)) continue;
        for (uint32_t c = p->rank; c < p->columns; c++) {
            const double v = fabs(a[i * p->columns + p->column_order[c]]);
            if (!(v > best * DMB_CLEARLY)) continue;
            best = v;
            *row_place = s;
            *column_place = c;
        }
    }
    return best;
}

/* Moves order[from] down to `to`; the items between keep their order. */
static void move_item(uint32_t *order, uint32_t from, uint32_t to)
{
    const uint32_t item = order[from];
    for (uint32_t i = from; i > to; i--) order[i] = order[i - 1];
    order[to] = item;
}

/* Subtracts the last pivot row from the remaining rows. Its column becomes exactly zero there, as columns of weight 0
 * are: neither is found again, and operations can use whole rows. */
static void eliminate(const dmb_partition *p, double *a, double *top)
{
    const size_t n = p->columns, column = p->column_order[p->rank - 1];
    const double *pivot_row = a + n * p->row_order[p->rank - 1];
    uint32_t places[DMB_PLACES];
    const size_t count = find_places(n, pivot_row, places);
    for (uint32_t s = p->rank; s < p->rows; s++) {
        const size_t i = p->row_order[s];
        double *row = a + n * i;
        if (row[column] == 0.0) continue;
        row_subtract_at(n, count, places, row[column] / pivot_row[column], pivot_row, row);
        row[column] = 0.0;
        top[i] = row_largest(n, row);
    }
}

/* After k pivots the remaining rows are a Schur complement: a row that depends on the pivot rows has become rounding,
 * hence the end of the loop at DMB_RANK_TOLERANCE of its length. The pivot row and the dependent column move to place k
 * of their orders, the others keep their sequence (eq:joints.partition). */
double dmb_partition_choose(const double *B, uint32_t stride, const double *weight, double *work,
                            dmb_partition *partition)
{
    dmb_partition *p = partition;
    double *a = work, *top = work + (size_t)p->rows * p->columns;
    for (uint32_t i = 0; i < p->rows; i++) p->row_order[i] = i;
    for (uint32_t j = 0; j < p->columns; j++) p->column_order[j] = j;
    p->rank = 0;
    const bool finite = scale_rows(B, stride, weight, p, a, top);
    double smallest = DBL_MAX, largest = 0.0;
    for (;;) {
        uint32_t row_place = 0, column_place = 0;
        const double size = find_pivot(p, a, top, &row_place, &column_place);
        if (!(size > DMB_RANK_TOLERANCE)) break;
        move_item(p->row_order, row_place, p->rank);
        move_item(p->column_order, column_place, p->rank);
        p->rank++;
        if (size < smallest) smallest = size;
        if (size > largest) largest = size;
        eliminate(p, a, top);
    }
    if (!finite) return 0.0;
    return p->rank == 0 ? 1.0 : smallest / largest;
}

/* Factorisation in the Crout form of LU, P C_d = L U with U of unit diagonal: a scale factor of a row of C_d then
 * appears in that row of L only. Therefore rows are scaled for the choice of exchanges and scaled back afterwards,
 * without storage for the scales. Inner loops run along rows. Rows with a factor 0 are skipped. */

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

/* Copies C_d with rows scaled to unit length as in choosing; a row that cannot be scaled becomes zero. Returns the
 * largest entry of the scaled pivot rows, independent columns included. */
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

/* Keeps the pivot of the choice unless another entry is clearly larger, as in find_pivot. */
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

/* Index, before all exchanges, of the row that is at k after exchange k. */
static uint32_t origin(const uint32_t *pivot, uint32_t k)
{
    uint32_t at = k;
    for (uint32_t j = k + 1; j-- > 0;) at = at == pivot[j] ? j : at == j ? pivot[j] : at;
    return at;
}

/* Step k of Crout elimination: computes row k of U and subtracts its multiples from the rows below. */
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

/* Row k is final after step k: its part of L is scaled back to the length of the row of B, its pivot is stored as
 * reciprocal. */
double dmb_partition_factor(const double *B, uint32_t stride, const double *weight, const dmb_partition *partition,
                            double *lu, uint32_t *pivot)
{
    const dmb_partition *p = partition;
    const size_t n = p->rank;
    if (n == 0) return 1.0;
    for (uint32_t k = 0; k < n; k++) pivot[k] = k; /* all within range, even if singular */
    double largest = gather_dependent(B, stride, weight, p, lu), smallest = DBL_MAX;
    for (uint32_t k = 0; k < n; k++) {
        double *row = lu + n * k;
        pivot[k] = pivot_of_column(p->rank, k, lu);
        if (pivot[k] != k) dmb_block_swap(n, row, lu + n * pivot[k]);
        const double size = fabs(row[k]) * weight[p->column_order[k]];
        if (!(size > 0.0 && size <= DBL_MAX)) return 0.0;
        const double reciprocal = 1.0 / row[k];
        const double length = row_length(p->columns, B + (size_t)p->row_order[origin(pivot, k)] * stride, weight);
        if (!(fabs(reciprocal / length) <= DBL_MAX)) return 0.0;
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
        if (pivot[k] != k) dmb_block_swap(1, x + k, x + pivot[k]);
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
        if (pivot[k] != k) dmb_block_swap(1, x + k, x + pivot[k]);
}

/* dmb_partition_solve of all columns of -C_i at once, one row of G at a time. */
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
        if (pivot[k] != k) dmb_block_swap(m, G + m * k, G + m * pivot[k]);
    for (size_t k = 0; k < n; k++) {
        for (size_t j = 0; j < k; j++)
            if (lu[n * k + j] != 0.0) row_subtract(m, lu[n * k + j], G + m * j, G + m * k);
        row_multiply(m, lu[n * k + k], G + m * k);
    }
    for (size_t k = n; k-- > 0;)
        for (size_t j = k + 1; j < n; j++)
            if (lu[n * k + j] != 0.0) row_subtract(m, lu[n * k + j], G + m * j, G + m * k);
}
