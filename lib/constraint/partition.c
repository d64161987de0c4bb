/* Choice, factors and solves of a partition of coordinates.
 *
 * Choosing is Gaussian elimination with complete pivoting (Golub and Van Loan, Matrix Computations, 3.4) of rows
 * scaled to unit length in weighted columns (Wehage, Haug, J. Mech. Design 104, 1982). Factoring is the Crout form of
 * LU, P C_d = L U with U of unit diagonal: a factor of a row of C_d then stands in that row of L alone, so that rows
 * are scaled for the choice of exchanges and scaled back afterwards without a place to keep the scales. Inner loops run
 * along rows. Rows with a factor 0 are skipped: a cluster of many joints is sparse. */
#include "constraint/partition.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>

#define ROW_MIN 1e-300       /* shorter rows count as zero */
#define CLEARLY (1.0 + 1e-6) /* a later candidate for pivot must be larger by this factor */
#define GRAM_PIVOT_MIN 1e-16 /* part of its diagonal that a pivot of B W^2 B^T must exceed */

/* y[j] -= f x[j] */
static inline void row_subtract(size_t n, double f, const double *restrict x, double *restrict y)
{
    for (size_t j = 0; j < n; j++) y[j] -= f * x[j];
}

static inline void row_multiply(size_t n, double f, double *x)
{
    for (size_t j = 0; j < n; j++) x[j] *= f;
}

static inline void row_swap(size_t n, double *restrict x, double *restrict y)
{
    for (size_t j = 0; j < n; j++) {
        const double t = x[j];
        x[j] = y[j];
        y[j] = t;
    }
}

/* Four running sums, because one would wait for itself; their order is fixed. */
static inline double dot(size_t n, const double *x, const double *y)
{
    double sum[4] = {0.0, 0.0, 0.0, 0.0};
    size_t j = 0;
    for (; j + 4 <= n; j += 4)
        for (size_t i = 0; i < 4; i++) sum[i] += x[j + i] * y[j + i];
    for (; j < n; j++) sum[0] += x[j] * y[j];
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

static inline double larger(double a, double b)
{
    return a > b ? a : b;
}

/* Largest |x_j|. Four running values, as in dot. */
static double row_largest(size_t n, const double *x)
{
    double m[4] = {0.0, 0.0, 0.0, 0.0};
    size_t j = 0;
    for (; j + 4 <= n; j += 4)
        for (size_t i = 0; i < 4; i++) m[i] = larger(fabs(x[j + i]), m[i]);
    for (; j < n; j++) m[0] = larger(fabs(x[j]), m[0]);
    return larger(larger(m[0], m[1]), larger(m[2], m[3]));
}

static inline double sum_of_squares(size_t n, const double *b, const double *weight, double scale)
{
    double sum = 0.0;
    for (size_t j = 0; j < n; j++) {
        const double v = b[j] * weight[j] * scale;
        sum += v * v;
    }
    return sum;
}

/* 2-norm of a row in weighted columns. A second pass, only where squares leave the range of doubles. */
static double row_length(size_t n, const double *b, const double *weight)
{
    const double sum = sum_of_squares(n, b, weight, 1.0);
    if (sum > 1e-280 && sum < 1e280) return sqrt(sum);
    const double scale = sum < 1.0 ? 0x1p600 : 0x1p-600;
    return sqrt(sum_of_squares(n, b, weight, scale)) / scale;
}

static inline bool usable(double length)
{
    return length >= ROW_MIN && length <= DBL_MAX;
}

/* Choosing ------------------------------------------------------------------------------------------------------- */

/* The rows of B diag(weight) at unit length into a, their largest entries into top; zeros for a row of length zero and
 * for one that is not finite. Returns whether all are finite. */
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

/* The largest entry of the remaining rows and its places in the two orders. Both are walked ascending, so that the
 * first of equals is taken, and "equal" is wider than rounding: symmetric mechanisms have many equal candidates. */
static double find_pivot(const dmb_partition *p, const double *a, const double *top, uint32_t *row_place,
                         uint32_t *column_place)
{
    double best = 0.0;
    for (uint32_t s = p->rank; s < p->rows; s++) {
        const size_t i = p->row_order[s];
        if (!(top[i] > best * CLEARLY)) continue;
        for (uint32_t c = p->rank; c < p->columns; c++) {
            const double v = fabs(a[i * p->columns + p->column_order[c]]);
            if (!(v > best * CLEARLY)) continue;
            best = v;
            *row_place = s;
            *column_place = c;
        }
    }
    return best;
}

/* Moves order[from] down to `to`; those it passes keep their order. */
static void move_item(uint32_t *order, uint32_t from, uint32_t to)
{
    const uint32_t item = order[from];
    for (uint32_t i = from; i > to; i--) order[i] = order[i - 1];
    order[to] = item;
}

/* Subtracts the last pivot row from those that remain. Its column becomes exactly zero there, as columns of weight 0
 * are: neither is found again, and whole rows can be worked on. */
static void eliminate(const dmb_partition *p, double *a, double *top)
{
    const size_t n = p->columns, column = p->column_order[p->rank - 1];
    const double *pivot_row = a + n * p->row_order[p->rank - 1];
    for (uint32_t s = p->rank; s < p->rows; s++) {
        const size_t i = p->row_order[s];
        double *row = a + n * i;
        if (row[column] == 0.0) continue;
        row_subtract(n, row[column] / pivot_row[column], pivot_row, row);
        row[column] = 0.0;
        top[i] = row_largest(n, row);
    }
}

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

/* Factors -------------------------------------------------------------------------------------------------------- */

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
        for (size_t j = 0; j < p->columns; j++) most = larger(fabs(b[j] * weight[j]) * scale, most);
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
        if (!(v > best * CLEARLY)) continue;
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
    row_multiply(n - k - 1, reciprocal, row + k + 1);
    for (size_t i = k + 1; i < n; i++) {
        double *below = lu + n * i;
        if (below[k] != 0.0) row_subtract(n - k - 1, below[k], row + k + 1, below + k + 1);
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

/* Projection ----------------------------------------------------------------------------------------------------- */

/* Sum of a_j b_j weight_j^2, as dot. */
static double weighted_dot(size_t n, const double *a, const double *b, const double *weight)
{
    double sum[4] = {0.0, 0.0, 0.0, 0.0};
    size_t j = 0;
    for (; j + 4 <= n; j += 4)
        for (size_t i = 0; i < 4; i++) sum[i] += a[j + i] * weight[j + i] * (b[j + i] * weight[j + i]);
    for (; j < n; j++) sum[0] += a[j] * weight[j] * (b[j] * weight[j]);
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

/* Row by row: L_ik = (M_ik - L_i . L_k) / L_kk (Golub and Van Loan, 4.2). Reciprocals on the diagonal. */
int32_t dmb_partition_gram(const double *B, uint32_t stride, const double *weight, const dmb_partition *partition,
                           double *gram)
{
    const size_t n = partition->rank;
    for (size_t i = 0; i < n; i++) {
        const double *b = B + (size_t)partition->row_order[i] * stride;
        double *row = gram + n * i;
        for (size_t k = 0; k < i; k++) {
            const double *other = B + (size_t)partition->row_order[k] * stride;
            const double m = weighted_dot(partition->columns, b, other, weight);
            row[k] = (m - dot(k, row, gram + n * k)) * gram[n * k + k];
        }
        const double m = weighted_dot(partition->columns, b, b, weight), pivot = m - dot(i, row, row);
        if (!(pivot > GRAM_PIVOT_MIN * m && pivot <= DBL_MAX)) return -1;
        row[i] = 1.0 / sqrt(pivot);
    }
    return 0;
}

/* The diagonal holds reciprocal roots of the pivots; with 0 there a row neither asks for anything nor moves anything.
 */
void dmb_partition_leave_weak(const double *B, uint32_t stride, const double *weight, const dmb_partition *partition,
                              double *gram)
{
    const size_t n = partition->rank;
    for (size_t i = 0; i < n; i++) {
        const double *b = B + (size_t)partition->row_order[i] * stride;
        double *root = gram + n * i + i;
        if (*root * *root * weighted_dot(partition->columns, b, b, weight) * DMB_WEAK_PIVOT > 1.0) *root = 0.0;
    }
}

void dmb_partition_project(const double *B, uint32_t stride, const double *weight, const dmb_partition *partition,
                           const double *gram, double *d, double *x)
{
    const size_t n = partition->rank, columns = partition->columns;
    for (size_t k = 0; k < n; k++) d[k] = (d[k] - dot(k, gram + n * k, d)) * gram[n * k + k];
    for (size_t k = n; k-- > 0;) {
        d[k] *= gram[n * k + k];
        row_subtract(k, d[k], gram + n * k, d);
    }
    for (size_t j = 0; j < columns; j++) x[j] = 0.0;
    for (size_t k = 0; k < n; k++) row_subtract(columns, -d[k], B + (size_t)partition->row_order[k] * stride, x);
    for (size_t j = 0; j < columns; j++) x[j] *= weight[j] * weight[j];
}

/* Multipliers of least norm -------------------------------------------------------------------------------------- */

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
