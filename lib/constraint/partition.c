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
#include <string.h>

#define ROW_MIN 1e-300       /* shorter rows count as zero */
#define CLEARLY (1.0 + 1e-6) /* a later candidate for pivot must be larger by this factor */
#define PLACES 96            /* listed of a row at a time */
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

/* Places of what is not zero in a row, for row_subtract_at: none are listed, and n returned, where they are more than
 * PLACES or more than a third. */
static size_t find_places(size_t n, const double *x, uint32_t *places)
{
    const size_t most = n / 3 < PLACES ? n / 3 : PLACES;
    size_t count = 0;
    for (size_t j = 0; j < n; j++) {
        if (x[j] == 0.0) continue;
        if (count == most) return n;
        places[count++] = (uint32_t)j;
    }
    return count;
}

/* row_subtract, only at the places of x if they are listed. */
static inline void row_subtract_at(size_t n, size_t count, const uint32_t *places, double f, const double *restrict x,
                                   double *restrict y)
{
    if (count == n) {
        row_subtract(n, f, x, y);
        return;
    }
    for (size_t i = 0; i < count; i++) y[places[i]] -= f * x[places[i]];
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

/* Largest |x_j| weight_j, as row_largest. */
static double weighted_largest(size_t n, const double *x, const double *weight)
{
    double m[4] = {0.0, 0.0, 0.0, 0.0};
    size_t j = 0;
    for (; j + 4 <= n; j += 4)
        for (size_t i = 0; i < 4; i++) m[i] = larger(fabs(x[j + i] * weight[j + i]), m[i]);
    for (; j < n; j++) m[0] = larger(fabs(x[j] * weight[j]), m[0]);
    return larger(larger(m[0], m[1]), larger(m[2], m[3]));
}

static inline double square(double a)
{
    return a * a;
}

/* As dot. */
static inline double sum_of_squares(size_t n, const double *b, const double *weight, double scale)
{
    double sum[4] = {0.0, 0.0, 0.0, 0.0};
    size_t j = 0;
    for (; j + 4 <= n; j += 4)
        for (size_t i = 0; i < 4; i++) sum[i] += square(b[j + i] * weight[j + i] * scale);
    for (; j < n; j++) sum[0] += square(b[j] * weight[j] * scale);
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
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
    uint32_t places[PLACES];
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
    const size_t behind = n - k - 1;
    uint32_t places[PLACES];
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

/* Projection ----------------------------------------------------------------------------------------------------- */

/* B W^2 B^T = U^T U. A row of B meets few others, and U of a chain stays sparse in any order of its rows: what is
 * eliminated is a stretch of the chain, which fills between its two ends only. gram holds U from the diagonal on (of
 * which it has the reciprocal) and notes below it: in row n - 1 - k the places in row k of U that are not zero, in the
 * last row the blocks of columns in which rows 1 .. n - 1 of B are not zero. Nothing is noted of row 0. */
#define BLOCKS 64             /* of columns; a set of them is a uint64_t */
#define BLOCK_MIN 8           /* columns */
#define DENSE 32              /* so many columns, or fewer, are one block and one run, whatever is zero */
#define RUNS 8                /* of a row of B; what lies between further ones counts as not zero */
#define GAP 3                 /* zeros within a run */
#define ALL_PLACES UINT32_MAX /* in place of their number: those behind the diagonal, not listed */

/* Stretch from .. to - 1 of columns. */
typedef struct run {
    size_t from, to;
} run;

static uint32_t note(const double *notes, size_t i)
{
    uint32_t value;
    memcpy(&value, (const char *)notes + i * sizeof value, sizeof value);
    return value;
}

static void set_note(double *notes, size_t i, uint32_t value)
{
    memcpy((char *)notes + i * sizeof value, &value, sizeof value);
}

static inline size_t block_size(size_t columns)
{
    if (columns <= DENSE) return DENSE;
    const size_t size = (columns + BLOCKS - 1) / BLOCKS;
    return size > BLOCK_MIN ? size : BLOCK_MIN;
}

static inline size_t smaller(size_t a, size_t b)
{
    return a < b ? a : b;
}

/* Blocks in which a row is not zero. */
static uint64_t find_blocks(size_t n, const double *b)
{
    const size_t size = block_size(n);
    uint64_t blocks = n <= DENSE, bit = 1;
    for (size_t from = 0; from < n && n > DENSE; from += size, bit <<= 1) {
        const size_t to = smaller(from + size, n);
        for (size_t j = from; j < to; j++)
            if (b[j] != 0.0) {
                blocks |= bit;
                break;
            }
    }
    return blocks;
}

static inline uint64_t blocks_of(size_t n, const double *gram, size_t k)
{
    uint64_t blocks = UINT64_MAX;
    if (k > 0) memcpy(&blocks, gram + n * (n - 1) + k - 1, sizeof blocks);
    return blocks;
}

/* Runs of what is not zero in a row, at most RUNS; returns their number. */
static size_t find_runs(size_t n, const double *b, uint64_t blocks, run *runs)
{
    const size_t size = block_size(n);
    size_t count = 0;
    if (n <= DENSE) {
        runs[0] = (run){0, n};
        return 1;
    }
    for (size_t from = 0; from < n && blocks != 0; from += size, blocks >>= 1) {
        const size_t to = blocks & 1 ? smaller(from + size, n) : from;
        for (size_t j = from; j < to; j++) {
            if (b[j] == 0.0) continue;
            if (count == 0 || (count < RUNS && j > runs[count - 1].to + GAP)) runs[count++].from = j;
            runs[count - 1].to = j + 1;
        }
    }
    return count;
}

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

static double dot_in_runs(size_t count, const run *runs, const double *a, const double *b, const double *weight)
{
    double sum = 0.0;
    for (size_t i = 0; i < count; i++) {
        const size_t from = runs[i].from;
        sum += weighted_dot(runs[i].to - from, a + from, b + from, weight + from);
    }
    return sum;
}

static inline const double *pivot_row_of(const double *B, uint32_t stride, const dmb_partition *p, size_t k)
{
    return B + (size_t)p->row_order[k] * stride;
}

/* Zeros for U, the blocks of all rows, and no lists yet: project may follow whatever becomes of the factors. */
static void gram_clear(const double *B, uint32_t stride, const dmb_partition *p, double *gram)
{
    const size_t n = p->rank;
    for (size_t k = 0; k < n; k++)
        for (size_t r = k; r < n; r++) gram[n * k + r] = 0.0;
    for (size_t k = 1; k < n; k++) {
        const uint64_t blocks = find_blocks(p->columns, pivot_row_of(B, stride, p, k));
        memcpy(gram + n * (n - 1) + k - 1, &blocks, sizeof blocks);
        if (k + 1 < n) set_note(gram + n * (n - 1 - k), 0, ALL_PLACES);
    }
}

/* Number of the places listed for row k of U, from note 1 on. */
static inline uint32_t place_count(size_t n, const double *gram, size_t k)
{
    return k == 0 || k + 1 == n ? ALL_PLACES : note(gram + n * (n - 1 - k), 0);
}

/* Lists the places of row k of U, unless most are taken. */
static void list_places(size_t n, size_t k, double *gram)
{
    if (k == 0 || k + 1 == n) return;
    double *notes = gram + n * (n - 1 - k);
    uint32_t count = 0;
    for (size_t r = k + 1; r < n; r++) {
        if (gram[n * k + r] == 0.0) continue;
        if (2 * ((size_t)count + 1) > n - 1 - k) return;
        set_note(notes, ++count, (uint32_t)r);
    }
    set_note(notes, 0, count);
}

/* Subtracts from the rows below what row k of U has of them. */
static void gram_eliminate(size_t n, size_t k, double *gram)
{
    const double *row = gram + n * k, *notes = gram + n * (n - 1 - k);
    const uint32_t count = place_count(n, gram, k);
    if (count == ALL_PLACES) {
        for (size_t r = k + 1; r < n; r++)
            if (row[r] != 0.0) row_subtract(n - r, row[r], row + r, gram + n * r + r);
        return;
    }
    for (size_t i = 1; i <= count; i++) {
        const size_t r = note(notes, i);
        const double f = row[r];
        for (size_t j = i; j <= count; j++) {
            const size_t s = note(notes, j);
            gram[n * r + s] -= f * row[s];
        }
    }
}

/* Row k of U; false where its pivot is none. One at most `weak` of its diagonal is left out: its row of U is zero. */
static bool gram_step(const double *B, uint32_t stride, const double *weight, const dmb_partition *p, size_t k,
                      double weak, double *gram)
{
    const size_t n = p->rank;
    const double *b = pivot_row_of(B, stride, p, k);
    const uint64_t blocks = blocks_of(n, gram, k);
    double *row = gram + n * k;
    run runs[RUNS];
    const size_t count = find_runs(p->columns, b, blocks, runs);
    const double m = dot_in_runs(count, runs, b, b, weight), pivot = m + row[k];
    const bool kept = !(weak > 0.0 && pivot < weak * m);
    if (kept && !(pivot > GRAM_PIVOT_MIN * m && pivot <= DBL_MAX)) return false;
    for (size_t r = k + 1; r < n && kept; r++)
        if (blocks & blocks_of(n, gram, r))
            row[r] += dot_in_runs(count, runs, b, pivot_row_of(B, stride, p, r), weight);
    row[k] = kept ? 1.0 / sqrt(pivot) : 0.0;
    row_multiply(n - k - 1, row[k], row + k + 1);
    list_places(n, k, gram);
    gram_eliminate(n, k, gram);
    return true;
}

static int32_t gram_factor(const double *B, uint32_t stride, const double *weight, const dmb_partition *p, double weak,
                           double *gram)
{
    gram_clear(B, stride, p, gram);
    for (size_t k = 0; k < p->rank; k++)
        if (!gram_step(B, stride, weight, p, k, weak, gram)) return -1;
    return 0;
}

/* Golub and Van Loan, 4.2, by outer products. */
int32_t dmb_partition_gram(const double *B, uint32_t stride, const double *weight, const dmb_partition *partition,
                           double *gram)
{
    return gram_factor(B, stride, weight, partition, 0.0, gram);
}

/* Factors anew without the weak rows, if there are any: those behind must not lean on them. */
void dmb_partition_leave_weak(const double *B, uint32_t stride, const double *weight, const dmb_partition *partition,
                              double *gram)
{
    const size_t n = partition->rank;
    bool weak = false;
    for (size_t k = 0; k < n && !weak; k++) {
        const double *b = pivot_row_of(B, stride, partition, k);
        const double root = gram[n * k + k];
        run runs[RUNS];
        const size_t count = find_runs(partition->columns, b, blocks_of(n, gram, k), runs);
        weak = root * root * dot_in_runs(count, runs, b, b, weight) * DMB_WEAK_PIVOT > 1.0;
    }
    if (weak) (void)gram_factor(B, stride, weight, partition, DMB_WEAK_PIVOT, gram);
}

/* U^T y = d, a row of U at a time. */
static void gram_forward(size_t n, const double *gram, double *d)
{
    for (size_t k = 0; k < n; k++) {
        const double *row = gram + n * k, *notes = gram + n * (n - 1 - k);
        const uint32_t count = place_count(n, gram, k);
        d[k] *= row[k];
        if (count == ALL_PLACES) row_subtract(n - k - 1, d[k], row + k + 1, d + k + 1);
        for (size_t i = 1; i <= count && count != ALL_PLACES; i++) {
            const size_t r = note(notes, i);
            d[r] -= row[r] * d[k];
        }
    }
}

/* U d = y */
static void gram_backward(size_t n, const double *gram, double *d)
{
    for (size_t k = n; k-- > 0;) {
        const double *row = gram + n * k, *notes = gram + n * (n - 1 - k);
        const uint32_t count = place_count(n, gram, k);
        double sum = 0.0;
        if (count == ALL_PLACES) sum = dot(n - k - 1, row + k + 1, d + k + 1);
        for (size_t i = 1; i <= count && count != ALL_PLACES; i++) {
            const size_t r = note(notes, i);
            sum += row[r] * d[r];
        }
        d[k] = (d[k] - sum) * row[k];
    }
}

/* x += f b in the blocks given */
static void add_row(size_t n, uint64_t blocks, double f, const double *b, double *x)
{
    const size_t size = block_size(n);
    for (size_t from = 0; from < n && blocks != 0; from += size, blocks >>= 1)
        if (blocks & 1) row_subtract(smaller(size, n - from), -f, b + from, x + from);
}

void dmb_partition_project(const double *B, uint32_t stride, const double *weight, const dmb_partition *partition,
                           const double *gram, double *d, double *x)
{
    const size_t n = partition->rank, columns = partition->columns;
    gram_forward(n, gram, d);
    gram_backward(n, gram, d);
    for (size_t j = 0; j < columns; j++) x[j] = 0.0;
    for (size_t k = 0; k < n; k++)
        add_row(columns, blocks_of(n, gram, k), d[k], pivot_row_of(B, stride, partition, k), x);
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
