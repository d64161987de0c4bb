/* Block elimination from both ends of a chain towards its middle, with the inverse X_i of each eliminated block. From
 * the first block down, G_i = L_i X_i, D_{i+1} -= G_i U_i, W_i = X_i U_i; from the last block up the same with the two
 * off-diagonal blocks exchanged, G_i = U_{i-1} X_i, D_{i-1} -= G_i L_{i-1}, W_i = X_i L_{i-1}; the block in the middle
 * receives both updates and is inverted last (eq:integration.elimination). There is no fill, the work equals that of
 * elimination in one direction, and the processor executes both halves in parallel, because they are independent. A
 * solution requires one product per block towards the middle and one back.
 *
 * If the stiffnesses of a block differ by 15 decades, an inverse loses the soft ones, which LU factors keep. Therefore
 * this method is used for steps, whose Newton iterations evaluate the residual again, and block_tridiagonal for
 * statics.
 *
 * Compiled once for each vector width, see kernel/lanes.h. The functions correspond to dmb_block_factor and
 * dmb_block_solve. Factors are X in `diagonal`; above the middle W in `upper` and G in `lower`, below it exchanged; all
 * column-major. */
#ifndef DMB_MATH_BLOCK_INVERSE_H
#define DMB_MATH_BLOCK_INVERSE_H

#include "math/block_rows.h"
#include "math/block_six.h"

/* ---- Blocks of any size ------------------------------------------------------------------------------------------ */

typedef double block_rows[DMB_BLOCK_SIZE_MAX][DMB_BLOCK_SIZE_MAX];

/* Gauss-Jordan inversion in place, with row exchanges: step k subtracts row k from all other rows, also those above,
 * and stores column k of the inverse in place of the unit column. Returns 0, or 1 if there is no pivot. */
DMB_BLOCK_KERNEL int invert_rows(int n, block_rows a, int *exchanged)
{
    for (int k = 0; k < n; k++) {
        int p = k;
        for (int i = k + 1; i < n; i++)
            if (fabs(a[i][k]) > fabs(a[p][k])) p = i;
        if (!dmb_block_pivot_holds(a[p][k])) return 1;
        if (p != k) dmb_block_swap((size_t)n, a[k], a[p]);
        exchanged[k] = p;
        const double reciprocal = 1.0 / a[k][k];
        a[k][k] = 1.0;
        for (int j = 0; j < n; j++) a[k][j] = a[k][j] * reciprocal;
        for (int i = 0; i < n; i++) {
            const double f = a[i][k];
            if (i == k) continue;
            a[i][k] = 0.0;
            row_subtract(n, f, a[k], a[i]);
        }
    }
    return 0;
}

/* The inverse of P A is A^-1 P^T: its columns are exchanged in reverse order of the rows. */
DMB_BLOCK_KERNEL void exchange_columns(int n, const int *exchanged, double *columns)
{
    for (int k = n - 1; k >= 0; k--)
        if (exchanged[k] != k) dmb_block_swap((size_t)n, columns + n * k, columns + n * exchanged[k]);
}

/* C = A B, and C -= A B */
DMB_BLOCK_KERNEL void multiply(int rows, int inner, int columns, const double *restrict A, const double *restrict B,
                               double *restrict C)
{
    for (int i = 0; i < rows; i++) {
        double y[DMB_BLOCK_SIZE_MAX];
        for (int j = 0; j < columns; j++) y[j] = A[inner * i] * B[j];
        for (int k = 1; k < inner; k++)
            for (int j = 0; j < columns; j++) y[j] += A[inner * i + k] * B[columns * k + j];
        for (int j = 0; j < columns; j++) C[columns * i + j] = y[j];
    }
}

DMB_BLOCK_KERNEL void multiply_off(int rows, int inner, int columns, const double *restrict A, const double *restrict B,
                                   double *restrict C)
{
    for (int i = 0; i < rows; i++) {
        double y[DMB_BLOCK_SIZE_MAX];
        for (int j = 0; j < columns; j++) y[j] = C[columns * i + j];
        for (int k = 0; k < inner; k++) row_subtract(columns, A[inner * i + k], B + columns * k, y);
        for (int j = 0; j < columns; j++) C[columns * i + j] = y[j];
    }
}

/* Factors one block of n rows; its neighbour towards the middle has m rows, or 0 if there is none. U couples its rows
 * to the neighbour, L the neighbour's to it. Returns 0, or 1 without a pivot. */
DMB_BLOCK_KERNEL int factor_block(int n, int m, const block_parts *p)
{
    block_rows a;
    double *D = p->D, *U = p->U, *L = p->L;
    int exchanged[DMB_BLOCK_SIZE_MAX];
    double X[DMB_BLOCK_SIZE_MAX * DMB_BLOCK_SIZE_MAX], G[DMB_BLOCK_SIZE_MAX * DMB_BLOCK_SIZE_MAX],
        W[DMB_BLOCK_SIZE_MAX * DMB_BLOCK_SIZE_MAX];
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) a[i][j] = D[n * i + j];
    if (invert_rows(n, a, exchanged)) return 1;
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) D[n * j + i] = a[i][j];
    exchange_columns(n, exchanged, D);
    if (m == 0) return 0;
    turn_round(n, n, D, X);
    multiply(m, n, n, L, X, G);
    multiply_off(m, n, m, G, U, p->next);
    multiply(n, n, m, X, U, W);
    turn_round(m, n, G, L);
    turn_round(n, m, W, U);
    return 0;
}

/* y = A x with two independent sums, of even and of odd columns */
DMB_BLOCK_KERNEL void product_of_columns(int rows, int columns, const double *restrict A, const double *restrict x,
                                         double *restrict y)
{
    double even[DMB_BLOCK_SIZE_MAX], odd[DMB_BLOCK_SIZE_MAX] = {0.0};
    for (int i = 0; i < rows; i++) even[i] = x[0] * A[i];
    for (int j = 2; j < columns; j += 2)
        for (int i = 0; i < rows; i++) even[i] += x[j] * A[rows * j + i];
    for (int j = 1; j < columns; j += 2)
        for (int i = 0; i < rows; i++) odd[i] += x[j] * A[rows * j + i];
    for (int i = 0; i < rows; i++) y[i] = even[i] + odd[i];
}

/* The neighbour's b -= G b, then b <- X b: only the first is on the critical path to the middle. */
DMB_BLOCK_KERNEL void solve_towards(int n, int m, const double *restrict X, const double *restrict G,
                                    double *restrict b, double *restrict next)
{
    double y[DMB_BLOCK_SIZE_MAX];
    if (m > 0) {
        product_of_columns(m, n, G, b, y);
        for (int i = 0; i < m; i++) next[i] -= y[i];
    }
    product_of_columns(n, n, X, b, y);
    for (int i = 0; i < n; i++) b[i] = y[i];
}

/* b -= W x, x of the neighbour towards the middle */
DMB_BLOCK_KERNEL void solve_away(int n, int m, const double *restrict W, const double *restrict x, double *restrict b)
{
    double y[DMB_BLOCK_SIZE_MAX];
    product_of_columns(n, m, W, x, y);
    for (int i = 0; i < n; i++) b[i] -= y[i];
}

/* ---- Chains ------------------------------------------------------------------------------------------------------ */

/* A block with its coupling towards the middle, to a neighbour of m rows; for the middle block m = 0. */
typedef struct block_place {
    int n, m;
    uint32_t row, next_row;
    block_parts parts;
} block_place;

static inline block_place place_of(const dmb_block_layout *layout, const dmb_block_matrix *matrix, uint32_t middle,
                                   uint32_t i)
{
    const uint32_t to = i < middle ? i + 1 : i - 1, link = i < middle ? i : to;
    block_place p = {layout->size[i], 0, layout->row[i], 0, {matrix->diagonal + layout->diag[i], NULL, NULL, NULL}};
    if (i == middle) return p;
    double *upper = matrix->upper + layout->link[link], *lower = matrix->lower + layout->link[link];
    p.m = layout->size[to];
    p.next_row = layout->row[to];
    p.parts.U = i < middle ? upper : lower;
    p.parts.L = i < middle ? lower : upper;
    p.parts.next = matrix->diagonal + layout->diag[to];
    return p;
}

static inline int factor_place(const dmb_block_layout *layout, const dmb_block_matrix *matrix, uint32_t middle,
                               uint32_t i)
{
    const block_place p = place_of(layout, matrix, middle, i);
    if (p.n == 6 && (p.m == 6 || p.m == 0)) return six_factor(&p.parts);
    if (p.n == 2 && p.m == 2) return factor_block(2, 2, &p.parts);
    return factor_block(p.n, p.m, &p.parts);
}

/* Number of rows of every block of a range if all have the same number, otherwise 0. The mean of the squares equals the
 * square of the mean only for equal numbers. */
static inline int even_size(const dmb_block_layout *layout, uint32_t first, uint32_t count)
{
    const uint32_t n = layout->size[first], end = first + count;
    const int even =
        layout->row[end] - layout->row[first] == n * count && layout->diag[end] - layout->diag[first] == n * n * count;
    return even ? (int)n : 0;
}

/* Factors two blocks of six rows, one on each side of the middle. Returns 0, or 1 or 2: number of the block without a
 * pivot. */
static inline int factor_two(const dmb_block_layout *layout, const dmb_block_matrix *matrix, uint32_t middle,
                             uint32_t i, uint32_t j)
{
    const block_place p = place_of(layout, matrix, middle, i), q = place_of(layout, matrix, middle, j);
    return six_factor_two(&p.parts, &q.parts);
}

/* Parts of the elimination of a chain: its two ends up to the neighbours of the middle, which two threads may process
 * concurrently; then these and the middle. Together they do the same as factor_blocks and solve_blocks, with the same
 * operations per block in the same order. */
enum { BLOCK_UPPER_END = 0, BLOCK_LOWER_END = 1, BLOCK_MIDDLE = 2 };

static inline int64_t factor_part(const dmb_block_layout *layout, dmb_block_matrix *matrix, uint32_t first,
                                  uint32_t count, int32_t part)
{
    const uint32_t middle = first + count / 2, end = first + count;
    if (part == BLOCK_UPPER_END) {
        for (uint32_t i = first; i + 1 < middle; i++)
            if (factor_place(layout, matrix, middle, i)) return (int64_t)i;
        return -1;
    }
    if (part == BLOCK_LOWER_END) {
        for (uint32_t i = end - 1; i > middle + 1; i--)
            if (factor_place(layout, matrix, middle, i)) return (int64_t)i;
        return -1;
    }
    if (middle > first && factor_place(layout, matrix, middle, middle - 1)) return (int64_t)middle - 1;
    if (middle + 1 < end && factor_place(layout, matrix, middle, middle + 1)) return (int64_t)middle + 1;
    return factor_place(layout, matrix, middle, middle) ? (int64_t)middle : -1;
}

/* The upper half has as many blocks as the lower one, or one more, which is eliminated first. Therefore both reach the
 * middle in the same pass, the upper half first. */
static inline int64_t factor_blocks(const dmb_block_layout *layout, dmb_block_matrix *matrix, uint32_t first,
                                    uint32_t count)
{
    const uint32_t middle = first + count / 2, below = (count - 1) / 2, six = even_size(layout, first, count) == 6;
    uint32_t i = first, j = first + count - 1;
    if (count / 2 > below && factor_place(layout, matrix, middle, i++) >= 1) return (int64_t)first;
    for (; j > middle; i++, j--) {
        const int bad = six ? factor_two(layout, matrix, middle, i, j) : factor_place(layout, matrix, middle, i);
        if (bad) return (int64_t)(bad == 1 ? i : j);
        if (!six && factor_place(layout, matrix, middle, j)) return (int64_t)j;
    }
    return factor_place(layout, matrix, middle, middle) ? (int64_t)middle : -1;
}

static inline void towards(const dmb_block_layout *layout, const dmb_block_matrix *matrix, uint32_t middle, uint32_t i,
                           double *rhs)
{
    const block_place p = place_of(layout, matrix, middle, i);
    double *b = rhs + p.row, *next = rhs + p.next_row;
    if (p.n == 2 && p.m == 2)
        solve_towards(2, 2, p.parts.D, p.parts.L, b, next);
    else
        solve_towards(p.n, p.m, p.parts.D, p.parts.L, b, next);
}

static inline void away(const dmb_block_layout *layout, const dmb_block_matrix *matrix, uint32_t middle, uint32_t i,
                        double *rhs)
{
    const block_place p = place_of(layout, matrix, middle, i);
    if (p.n == 2 && p.m == 2)
        solve_away(2, 2, p.parts.U, rhs + p.next_row, rhs + p.row);
    else
        solve_away(p.n, p.m, p.parts.U, rhs + p.next_row, rhs + p.row);
}

/* Blocks of two rows without gaps: the same, both ends in turn, since each waits for its neighbour. Of an even number
 * of blocks the first goes ahead, so that the middle receives the upper update first. */
static inline void two_solve(uint32_t count, const double *D, const double *U, const double *L, double *b)
{
    const size_t middle = count / 2, ahead = 1 - count % 2;
    if (ahead) solve_towards(2, 2, D, L, b, b + 2);
    for (size_t i = ahead, j = count - 1; j > middle; i++, j--) {
        solve_towards(2, 2, D + 4 * i, L + 4 * i, b + 2 * i, b + 2 * i + 2);
        solve_towards(2, 2, D + 4 * j, U + 4 * j - 4, b + 2 * j, b + 2 * j - 2);
    }
    solve_towards(2, 0, D + 4 * middle, NULL, b + 2 * middle, NULL);
    for (size_t i = middle, j = middle + 1; j < count; i--, j++) {
        solve_away(2, 2, U + 4 * i - 4, b + 2 * i, b + 2 * i - 2);
        solve_away(2, 2, L + 4 * j - 4, b + 2 * j - 2, b + 2 * j);
    }
    if (ahead) solve_away(2, 2, U, b + 2, b);
}

/* Substitution towards the middle: parts as in factor_part. */
static inline void towards_part(const dmb_block_layout *layout, const dmb_block_matrix *matrix, uint32_t first,
                                uint32_t count, int32_t part, double *rhs)
{
    const uint32_t middle = first + count / 2, end = first + count;
    if (even_size(layout, first, count) == 6) {
        six_towards_part(count, matrix->diagonal + layout->diag[first], matrix->upper + layout->link[first],
                         matrix->lower + layout->link[first], part, rhs + layout->row[first]);
        return;
    }
    for (uint32_t i = first; part == BLOCK_UPPER_END && i + 1 < middle; i++) towards(layout, matrix, middle, i, rhs);
    for (uint32_t i = end - 1; part == BLOCK_LOWER_END && i > middle + 1; i--) towards(layout, matrix, middle, i, rhs);
    if (part != BLOCK_MIDDLE) return;
    if (middle > first) towards(layout, matrix, middle, middle - 1, rhs);
    if (middle + 1 < end) towards(layout, matrix, middle, middle + 1, rhs);
    towards(layout, matrix, middle, middle, rhs);
}

/* Substitution from the middle to one of the ends. */
static inline void away_part(const dmb_block_layout *layout, const dmb_block_matrix *matrix, uint32_t first,
                             uint32_t count, int32_t part, double *rhs)
{
    const uint32_t middle = first + count / 2, end = first + count;
    if (even_size(layout, first, count) == 6) {
        six_away_part(count, matrix->upper + layout->link[first], matrix->lower + layout->link[first], part,
                      rhs + layout->row[first]);
        return;
    }
    for (uint32_t i = middle; part == BLOCK_UPPER_END && i-- > first;) away(layout, matrix, middle, i, rhs);
    for (uint32_t i = middle + 1; part == BLOCK_LOWER_END && i < end; i++) away(layout, matrix, middle, i, rhs);
}

static inline void solve_blocks(const dmb_block_layout *layout, const dmb_block_matrix *matrix, uint32_t first,
                                uint32_t count, double *rhs)
{
    const uint32_t middle = first + count / 2, end = first + count;
    const int size = even_size(layout, first, count);
    if (size == 2) {
        two_solve(count, matrix->diagonal + layout->diag[first], matrix->upper + layout->link[first],
                  matrix->lower + layout->link[first], rhs + layout->row[first]);
        return;
    }
    if (size == 6) {
        six_solve(count, matrix->diagonal + layout->diag[first], matrix->upper + layout->link[first],
                  matrix->lower + layout->link[first], rhs + layout->row[first]);
        return;
    }
    for (uint32_t i = first; i < middle; i++) towards(layout, matrix, middle, i, rhs);
    for (uint32_t i = end - 1; i >= middle && i < end; i--) towards(layout, matrix, middle, i, rhs);
    for (uint32_t i = middle; i-- > first;) away(layout, matrix, middle, i, rhs);
    for (uint32_t i = middle + 1; i < end; i++) away(layout, matrix, middle, i, rhs);
}

#endif
