/* Projection by B W^2 B^T = U^T U. A row of B couples with few others, and U of a chain stays sparse for any order of
 * its rows: the eliminated part is a section of the chain, which causes fill between its two ends only. gram contains U
 * from the diagonal on (the reciprocal of the diagonal) and notes below it: row n - 1 - k lists the nonzero places in
 * row k of U, the last row contains the blocks of columns in which rows 1 .. n - 1 of B are nonzero. There are no notes
 * of row 0. */
#include <string.h>

#include "constraint/partition_rows.h"

#define DMB_GRAM_PIVOT_MIN 1e-16 /* fraction of its diagonal that a pivot of B W^2 B^T must exceed */
#define DMB_ALL_PLACES \
    UINT32_MAX /* stored instead of the number of places: all places after the diagonal, not listed */

/* ---- Notes ------------------------------------------------------------------------------------------------------- */

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

static inline uint64_t blocks_of(size_t n, const double *gram, size_t k)
{
    uint64_t blocks = UINT64_MAX;
    if (k > 0) memcpy(&blocks, gram + n * (n - 1) + k - 1, sizeof blocks);
    return blocks;
}

/* Sets U to zero, stores the blocks of all rows and no lists, so that a projection is defined even if factorisation
 * fails. */
static void gram_clear(const double *B, uint32_t stride, const dmb_partition *p, double *gram)
{
    const size_t n = p->rank;
    for (size_t k = 0; k < n; k++)
        for (size_t r = k; r < n; r++) gram[n * k + r] = 0.0;
    for (size_t k = 1; k < n; k++) {
        const uint64_t blocks = find_blocks(p->columns, pivot_row_of(B, stride, p, k));
        memcpy(gram + n * (n - 1) + k - 1, &blocks, sizeof blocks);
        if (k + 1 < n) set_note(gram + n * (n - 1 - k), 0, DMB_ALL_PLACES);
    }
}

/* Number of places listed for row k of U; the places begin at note 1. */
static inline uint32_t place_count(size_t n, const double *gram, size_t k)
{
    return k == 0 || k + 1 == n ? DMB_ALL_PLACES : note(gram + n * (n - 1 - k), 0);
}

/* Lists the nonzero places of row k of U, unless most are nonzero. */
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

/* ---- Factors ----------------------------------------------------------------------------------------------------- */

/* Subtracts the multiples of row k of U from the rows below. */
static void gram_eliminate(size_t n, size_t k, double *gram)
{
    const double *row = gram + n * k, *notes = gram + n * (n - 1 - k);
    const uint32_t count = place_count(n, gram, k);
    if (count == DMB_ALL_PLACES) {
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

/* Computes row k of U; returns false if its pivot is invalid. A pivot below the fraction `weak` of its diagonal is
 * excluded: its row of U is zero. */
static bool gram_step(const dmb_jacobian *jacobian, const dmb_partition *p, size_t k, double near_redundant,
                      double *gram)
{
    const double *B = jacobian->rows, *weight = jacobian->weight;
    const uint32_t stride = jacobian->stride;
    const size_t n = p->rank;
    const double *b = pivot_row_of(B, stride, p, k);
    const uint64_t blocks = blocks_of(n, gram, k);
    double *row = gram + n * k;
    column_range stretches[DMB_STRETCHES];
    const size_t count = find_stretches(p->columns, b, blocks, stretches);
    const double m = dot_in_stretches(count, stretches, b, b, weight), pivot = m + row[k];
    const bool kept = !(near_redundant > 0.0 && pivot < near_redundant * m);
    if (kept && !(pivot > DMB_GRAM_PIVOT_MIN * m && pivot <= DBL_MAX)) return false;
    for (size_t r = k + 1; r < n && kept; r++)
        if (blocks & blocks_of(n, gram, r))
            row[r] += dot_in_stretches(count, stretches, b, pivot_row_of(B, stride, p, r), weight);
    row[k] = kept ? 1.0 / sqrt(pivot) : 0.0;
    row_multiply(n - k - 1, row[k], row + k + 1);
    list_places(n, k, gram);
    gram_eliminate(n, k, gram);
    return true;
}

static int32_t gram_factor(const dmb_jacobian *jacobian, const dmb_partition *p, double near_redundant, double *gram)
{
    gram_clear(jacobian->rows, jacobian->stride, p, gram);
    for (size_t k = 0; k < p->rank; k++)
        if (!gram_step(jacobian, p, k, near_redundant, gram)) return -1;
    return 0;
}

/* Cholesky factorisation by outer products (Golub and Van Loan, 4.2). */
int32_t dmb_partition_gram(const dmb_jacobian *jacobian, const dmb_partition *partition, double *gram)
{
    return gram_factor(jacobian, partition, 0.0, gram);
}

/* Repeats the factorisation without the near-redundant rows, if there are any, because later rows must not depend on
 * them. */
void dmb_partition_drop_near_redundant(const dmb_jacobian *jacobian, const dmb_partition *partition, double *gram)
{
    const size_t n = partition->rank;
    bool near_redundant = false;
    for (size_t k = 0; k < n && !near_redundant; k++) {
        const double *b = pivot_row_of(jacobian->rows, jacobian->stride, partition, k);
        const double root = gram[n * k + k];
        column_range stretches[DMB_STRETCHES];
        const size_t count = find_stretches(partition->columns, b, blocks_of(n, gram, k), stretches);
        near_redundant =
            root * root * dot_in_stretches(count, stretches, b, b, jacobian->weight) * DMB_NEAR_REDUNDANT_PIVOT > 1.0;
    }
    if (near_redundant) (void)gram_factor(jacobian, partition, DMB_NEAR_REDUNDANT_PIVOT, gram);
}

/* ---- Solves ------------------------------------------------------------------------------------------------------ */

/* U^T y = d, one row of U at a time. */
static void gram_forward(size_t n, const double *gram, double *d)
{
    for (size_t k = 0; k < n; k++) {
        const double *row = gram + n * k, *notes = gram + n * (n - 1 - k);
        const uint32_t count = place_count(n, gram, k);
        d[k] *= row[k];
        if (count == DMB_ALL_PLACES) row_subtract(n - k - 1, d[k], row + k + 1, d + k + 1);
        for (size_t i = 1; i <= count && count != DMB_ALL_PLACES; i++) {
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
        if (count == DMB_ALL_PLACES) sum = dot(n - k - 1, row + k + 1, d + k + 1);
        for (size_t i = 1; i <= count && count != DMB_ALL_PLACES; i++) {
            const size_t r = note(notes, i);
            sum += row[r] * d[r];
        }
        d[k] = (d[k] - sum) * row[k];
    }
}

/* x += f b in the given blocks */
static void add_row(size_t n, uint64_t blocks, double f, const double *b, double *x)
{
    const size_t size = block_size(n);
    for (size_t from = 0; from < n && blocks != 0; from += size, blocks >>= 1)
        if (blocks & 1) row_subtract(smaller(size, n - from), -f, b + from, x + from);
}

void dmb_partition_project(const dmb_jacobian *jacobian, const dmb_partition *partition, const double *gram, double *d,
                           double *x)
{
    const size_t n = partition->rank, columns = partition->columns;
    gram_forward(n, gram, d);
    gram_backward(n, gram, d);
    for (size_t j = 0; j < columns; j++) x[j] = 0.0;
    for (size_t k = 0; k < n; k++)
        add_row(columns, blocks_of(n, gram, k), d[k], pivot_row_of(jacobian->rows, jacobian->stride, partition, k), x);
    for (size_t j = 0; j < columns; j++) x[j] *= jacobian->weight[j] * jacobian->weight[j];
}

/* Multipliers of least norm: the part in the left null space, which has no effect, is removed. */

/* Row s of N = [X, -I], X = B_red(:, dep) C_d^-1: redundant row s as combination of the pivot rows, minus itself. */
static void left_null_vector(const dmb_jacobian *jacobian, const dmb_partition *p, const double *lu,
                             const uint32_t *pivot, size_t s, double *v)
{
    const size_t n = p->rank;
    const double *b = jacobian->rows + (size_t)p->row_order[n + s] * jacobian->stride;
    for (size_t k = 0; k < n; k++) v[k] = b[p->column_order[k]];
    dmb_partition_solve_transposed(p, lu, pivot, v);
    for (size_t k = n; k < p->rows; k++) v[k] = k == n + s ? -1.0 : 0.0;
}

/* Moves the longest of the rows of N from s on to s. */
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
    if (at != s) dmb_block_swap(n, N + n * s, N + n * at);
}

/* Normalises row s of N after a second orthogonalisation to the rows before it ("twice is enough": Giraud, Langou,
 * Rozloznik, Comput. Math. Appl. 50, 2005), and makes the later rows orthogonal to it. Each row has its -1 where
 * earlier rows have zeros, so that no length is below 1. */
static void orthonormalise(size_t n, size_t redundant, size_t s, double *N)
{
    double *v = N + n * s;
    for (size_t t = 0; t < s; t++) row_subtract(n, dot(n, N + n * t, v), N + n * t, v);
    row_multiply(n, 1.0 / sqrt(dot(n, v, v)), v);
    for (size_t t = s + 1; t < redundant; t++) row_subtract(n, dot(n, v, N + n * t), v, N + n * t);
}

/* f - N^T (N N^T)^-1 N f by modified Gram-Schmidt on the rows of N, the longest first (Golub and Van
 * Loan, 5.2, 5.4). Cholesky of N N^T = X X^T + I is not used, because its condition number is the square of that of N:
 * X contains the ratios of row lengths, which differ by their units. Without "longest first" B^T f loses accuracy if
 * these span ten decades. */
void dmb_partition_least_norm(const dmb_jacobian *jacobian, const dmb_partition *partition, const double *lu,
                              const uint32_t *pivot, double *work, double *f)
{
    const size_t n = partition->rows, redundant = n - partition->rank;
    const uint32_t *order = partition->row_order;
    for (size_t s = 0; s < redundant; s++) left_null_vector(jacobian, partition, lu, pivot, s, work + n * s);
    for (size_t s = 0; s < redundant; s++) {
        double *v = work + n * s, along = 0.0;
        longest_first(n, redundant, s, work);
        orthonormalise(n, redundant, s, work);
        for (size_t k = 0; k < n; k++) along += v[k] * f[order[k]];
        for (size_t k = 0; k < n; k++) f[order[k]] -= along * v[k];
    }
}
