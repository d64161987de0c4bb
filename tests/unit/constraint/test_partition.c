/* Partition of coordinates against LAPACK: rank, null space, solves, projection, least multipliers; when the quality
 * falls; equal candidates; what is not a number; what is empty; clusters of many bodies. Checks eq:joints.partition,
 * eq:joints.multipliers, eq:joints.least-norm and eq:joints.projection. */
#include "check.h"

#include <float.h>
#include <lapacke.h>
#include <string.h>

#include "constraint/partition.h"

enum { MAX = 40, STRIDE = MAX + 3, DRAWS = 400 };

/* A matrix, its choice and its factors, big enough for every test. */
typedef struct cluster {
    double B[MAX * STRIDE], weight[MAX];
    dmb_partition p;
    uint32_t row_order[MAX], column_order[MAX], pivot[MAX];
    double work[MAX * MAX + MAX], lu[MAX * MAX], G[MAX * MAX], gram[MAX * MAX];
} cluster;

/* The parameters of a random cluster. */
typedef struct kind {
    double row_decades;    /* rows are multiplied by 10^-this .. 10^this */
    double weight_decades; /* columns likewise */
    double zero_weight;    /* part of the columns */
} kind;

static const kind harsh = {6.0, 1.0, 0.15}, plain = {0.0, 0.0, 0.0}, mild = {1.0, 1.0, 0.15};

static uint32_t draw_integer(uint64_t *seed, uint32_t low, uint32_t high)
{
    return low + (uint32_t)draw_between(seed, 0.0, (double)(high - low) + 0.999999);
}

/* An empty matrix with unit weights. Numbers between the rows must never be used. */
static void clear(cluster *c, uint32_t rows, uint32_t columns)
{
    memset(c, 0, sizeof *c);
    c->p = (dmb_partition){rows, columns, 0, 0, c->row_order, c->column_order};
    for (uint32_t i = 0; i < MAX * STRIDE; i++) c->B[i] = i % STRIDE < columns ? 0.0 : (double)NAN;
    for (uint32_t j = 0; j < MAX; j++) c->weight[j] = 1.0;
}

static void set(cluster *c, uint32_t rows, uint32_t columns, const double *B)
{
    clear(c, rows, columns);
    for (uint32_t i = 0; i < rows; i++)
        for (uint32_t j = 0; j < columns; j++) c->B[STRIDE * i + j] = B[columns * i + j];
}

/* Product of rows x rank and rank x columns. Some rows are zero, some multiples of the row before. */
static void draw_cluster(cluster *c, uint64_t *seed, kind k)
{
    clear(c, draw_integer(seed, 1, MAX), draw_integer(seed, 1, MAX));
    const uint32_t least = c->p.rows < c->p.columns ? c->p.rows : c->p.columns, rank = draw_integer(seed, 0, least);
    static double right[MAX * MAX];
    for (uint32_t i = 0; i < MAX * MAX; i++) right[i] = draw_between(seed, -1.0, 1.0);
    for (uint32_t i = 0; i < c->p.rows; i++) {
        double *row = c->B + STRIDE * i;
        const double lot = draw_between(seed, 0.0, 1.0);
        const double scale = pow(10.0, draw_between(seed, -k.row_decades, k.row_decades));
        for (uint32_t r = 0; r < rank && lot > 0.1; r++) {
            const double left = draw_between(seed, -1.0, 1.0) * scale;
            for (uint32_t j = 0; j < c->p.columns; j++) row[j] += left * right[MAX * r + j];
        }
        if (i > 0 && lot > 0.9)
            for (uint32_t j = 0; j < c->p.columns; j++) row[j] = -scale * row[(ptrdiff_t)j - STRIDE];
    }
    for (uint32_t j = 0; j < c->p.columns; j++) {
        c->weight[j] = pow(10.0, draw_between(seed, -k.weight_decades, k.weight_decades));
        if (draw_between(seed, 0.0, 1.0) < k.zero_weight) c->weight[j] = 0.0;
    }
}

static double choose(cluster *c)
{
    return dmb_partition_choose(c->B, STRIDE, c->weight, c->work, &c->p);
}

static double factor(cluster *c)
{
    return dmb_partition_factor(c->B, STRIDE, c->weight, &c->p, c->lu, c->pivot);
}

/* Draws until the choice is one that normal equations and LAPACK can follow. */
static void draw_sound(cluster *c, uint64_t *seed, kind k)
{
    do {
        draw_cluster(c, seed, k);
    } while (choose(c) < 1e-3 || c->p.rank == 0);
    assert_true(factor(c) >= 0.999e-3);
}

/* B_ik by place in the two orders */
static double entry(const cluster *c, uint32_t row_place, uint32_t column_place)
{
    return c->B[STRIDE * c->row_order[row_place] + c->column_order[column_place]];
}

/* Rows of unit length in weighted columns, row-major without gaps. */
static void scaled_rows(const cluster *c, const double *weight, double *A, double *length)
{
    for (uint32_t i = 0; i < c->p.rows; i++) {
        length[i] = 0.0;
        for (uint32_t j = 0; j < c->p.columns; j++) length[i] = hypot(length[i], c->B[STRIDE * i + j] * weight[j]);
        for (uint32_t j = 0; j < c->p.columns; j++)
            A[c->p.columns * i + j] = length[i] > 0.0 ? c->B[STRIDE * i + j] * weight[j] / length[i] : 0.0;
    }
}

/* Number of singular values above those of rounding. */
static uint32_t lapack_rank(const cluster *c, const double *weight)
{
    static double A[MAX * MAX], length[MAX], value[MAX], superdiagonal[MAX], none[1];
    const lapack_int m = (lapack_int)c->p.rows, n = (lapack_int)c->p.columns;
    scaled_rows(c, weight, A, length);
    assert_int_equal(LAPACKE_dgesvd(LAPACK_ROW_MAJOR, 'N', 'N', m, n, A, n, value, none, 1, none, 1, superdiagonal), 0);
    uint32_t rank = 0;
    for (lapack_int i = 0; i < (m < n ? m : n); i++) rank += value[i] > 1e-11;
    return rank;
}

/* Shortest solution of A x = b of the rank known; A: m x n without gaps, overwritten; x on return in b. */
static void lapack_shortest(uint32_t m, uint32_t n, double *A, double *b)
{
    static double value[MAX];
    lapack_int rank = 0;
    assert_int_equal(
        LAPACKE_dgelsd(LAPACK_ROW_MAJOR, (lapack_int)m, (lapack_int)n, 1, A, (lapack_int)n, b, 1, value, 1e-11, &rank),
        0);
}

/* Each index once; ascending behind the rank; dependent columns have weights. */
static void check_orders(const cluster *c)
{
    uint32_t row_seen[MAX] = {0}, column_seen[MAX] = {0};
    for (uint32_t i = 0; i < c->p.rows; i++) {
        assert_true(c->row_order[i] < c->p.rows && row_seen[c->row_order[i]]++ == 0);
        assert_true(i <= c->p.rank || c->row_order[i] > c->row_order[i - 1]);
    }
    for (uint32_t j = 0; j < c->p.columns; j++) {
        assert_true(c->column_order[j] < c->p.columns && column_seen[c->column_order[j]]++ == 0);
        assert_true(j <= c->p.rank || c->column_order[j] > c->column_order[j - 1]);
        assert_true(j >= c->p.rank || c->weight[c->column_order[j]] > 0.0);
    }
}

static void rank_agrees_with_singular_values(void **state)
{
    (void)state;
    static cluster c;
    static double copy[MAX * STRIDE];
    uint64_t seed = 71;
    double worst = 0.0, redundant = 0.0;
    for (int i = 0; i < 5 * DRAWS; i++) {
        draw_cluster(&c, &seed, harsh);
        memcpy(copy, c.B, sizeof copy);
        const double quality = choose(&c);
        assert_memory_equal(copy, c.B, sizeof copy);
        assert_int_equal(c.p.rank, lapack_rank(&c, c.weight));
        check_orders(&c);
        assert_true(quality > 0.0 && quality <= 1.0);
        worst = fmax(worst, fabs(factor(&c) / quality - 1.0));
        redundant += c.p.rows - c.p.rank;
    }
    check_below("quality in factoring against quality in choosing", worst, 2e-6);
    tell("redundant rows on average", redundant / (5 * DRAWS));
}

/* Largest |B R| as part of the sum of its terms. In redundant rows a column without weight may count only where such
 * columns have no rank of their own. */
static double null_space_error(const cluster *c)
{
    const uint32_t rank = c->p.rank, m = c->p.columns - rank;
    double one[MAX];
    for (uint32_t j = 0; j < MAX; j++) one[j] = 1.0;
    const int all = lapack_rank(c, one) == rank;
    double worst = 0.0;
    for (uint32_t i = 0; i < c->p.rows; i++)
        for (uint32_t j = 0; j < m; j++) {
            if (i >= rank && !all && !(c->weight[c->column_order[rank + j]] > 0.0)) continue;
            double sum = entry(c, i, rank + j), size = fabs(sum) + DBL_MIN;
            for (uint32_t k = 0; k < rank; k++) {
                sum += entry(c, i, k) * c->G[m * k + j];
                size += fabs(entry(c, i, k) * c->G[m * k + j]);
            }
            worst = fmax(worst, fabs(sum) / size);
        }
    return worst;
}

/* G by LAPACK: -C_d^-1 C_i. Rows go in at unit length, which changes nothing but the exchanges. */
static void lapack_null_space(const cluster *c, double *G)
{
    static double A[MAX * MAX], C[MAX * MAX], length[MAX];
    static lapack_int exchanged[MAX];
    const uint32_t rank = c->p.rank, n = c->p.columns, m = n - rank;
    scaled_rows(c, c->weight, A, length);
    for (uint32_t k = 0; k < rank; k++) {
        for (uint32_t j = 0; j < rank; j++) C[rank * k + j] = entry(c, k, j) / length[c->row_order[k]];
        for (uint32_t j = 0; j < m; j++) G[m * k + j] = -entry(c, k, rank + j) / length[c->row_order[k]];
    }
    assert_int_equal(LAPACKE_dgesv(LAPACK_ROW_MAJOR, (lapack_int)rank, (lapack_int)m, C, (lapack_int)rank, exchanged, G,
                                   (lapack_int)m),
                     0);
}

static void null_space_is_annihilated(void **state)
{
    (void)state;
    static cluster c;
    uint64_t seed = 72;
    double worst = 0.0;
    for (int i = 0; i < 2 * DRAWS; i++) {
        draw_cluster(&c, &seed, harsh);
        choose(&c);
        assert_true(factor(&c) > 0.0);
        dmb_partition_null_space(c.B, STRIDE, &c.p, c.lu, c.pivot, c.G);
        worst = fmax(worst, null_space_error(&c));
    }
    check_below("B R, of the sum of its terms", worst, 1e-12);
}

static void null_space_agrees_with_lapack(void **state)
{
    (void)state;
    static cluster c;
    static double G[MAX * MAX];
    uint64_t seed = 73;
    double worst = 0.0;
    for (int i = 0; i < DRAWS; i++) {
        draw_sound(&c, &seed, harsh);
        if (c.p.rank == c.p.columns) continue;
        dmb_partition_null_space(c.B, STRIDE, &c.p, c.lu, c.pivot, c.G);
        lapack_null_space(&c, G);
        const size_t n = (size_t)c.p.rank * (c.p.columns - c.p.rank);
        worst = fmax(worst, largest_difference(n, c.G, G) / largest(n, G));
    }
    check_below("G against LAPACK, of its largest", worst, 1e-11);
}

/* Largest |C_d x - b|, or |C_d^T x - b|, as part of the sum of its terms. */
static double solve_error(const cluster *c, int transposed, const double *x, const double *b)
{
    double worst = 0.0;
    for (uint32_t i = 0; i < c->p.rank; i++) {
        double sum = -b[i], size = fabs(b[i]) + DBL_MIN;
        for (uint32_t j = 0; j < c->p.rank; j++) {
            const double term = (transposed ? entry(c, j, i) : entry(c, i, j)) * x[j];
            sum += term;
            size += fabs(term);
        }
        worst = fmax(worst, fabs(sum) / size);
    }
    return worst;
}

static void solves_both_ways(void **state)
{
    (void)state;
    static cluster c;
    uint64_t seed = 74;
    double straight = 0.0, transposed = 0.0, b[MAX], x[MAX];
    for (int i = 0; i < 2 * DRAWS; i++) {
        draw_cluster(&c, &seed, harsh);
        choose(&c);
        assert_true(factor(&c) > 0.0);
        for (uint32_t k = 0; k < MAX; k++) b[k] = draw_between(&seed, -1.0, 1.0);
        memcpy(x, b, sizeof b);
        dmb_partition_solve(&c.p, c.lu, c.pivot, x);
        straight = fmax(straight, solve_error(&c, 0, x, b));
        memcpy(x, b, sizeof b);
        dmb_partition_solve_transposed(&c.p, c.lu, c.pivot, x);
        transposed = fmax(transposed, solve_error(&c, 1, x, b));
        for (uint32_t k = c.p.rank; k < MAX; k++) assert_true(x[k] == b[k]);
    }
    check_below("C_d x = b, of the sum of its terms", straight, 1e-12);
    check_below("C_d^T x = b, of the sum of its terms", transposed, 1e-12);
}

/* The factors of a matrix of other entries than those of the choice, so that rows are exchanged. */
static void exchanges_of_rows(void **state)
{
    (void)state;
    static cluster c;
    uint64_t seed = 75;
    double worst = 0.0, exchanged = 0.0, b[MAX], x[MAX], y[MAX];
    for (int i = 0; i < DRAWS; i++) {
        draw_sound(&c, &seed, plain);
        for (uint32_t k = 0; k < c.p.rows; k++) {
            const double scale = pow(10.0, draw_between(&seed, -6.0, 6.0));
            for (uint32_t j = 0; j < c.p.columns; j++) c.B[STRIDE * k + j] = scale * draw_between(&seed, -1.0, 1.0);
        }
        if (factor(&c) < 1e-4) continue;
        for (uint32_t k = 0; k < c.p.rank; k++) exchanged += c.pivot[k] != k;
        for (uint32_t k = 0; k < MAX; k++) b[k] = draw_between(&seed, -1.0, 1.0);
        memcpy(x, b, sizeof b);
        memcpy(y, b, sizeof b);
        dmb_partition_solve(&c.p, c.lu, c.pivot, x);
        dmb_partition_solve_transposed(&c.p, c.lu, c.pivot, y);
        worst = fmax(worst, fmax(solve_error(&c, 0, x, b), solve_error(&c, 1, y, b)));
    }
    assert_true(exchanged > DRAWS);
    check_below("C_d x = b and C_d^T x = b after exchanges", worst, 1e-12);
}

/* Shortest x by LAPACK from all rows, the redundant ones included: y = W^-1 x is the shortest with (B W) y = d. */
static void lapack_projection(const cluster *c, const double *d, double *x)
{
    static double A[MAX * MAX], length[MAX];
    scaled_rows(c, c->weight, A, length);
    for (uint32_t i = 0; i < MAX; i++) x[i] = i < c->p.rows && length[i] > 0.0 ? d[i] / length[i] : 0.0;
    lapack_shortest(c->p.rows, c->p.columns, A, x);
    for (uint32_t j = 0; j < c->p.columns; j++) x[j] *= c->weight[j];
}

/* d = B x of a random x that moves the columns with a weight only, all rows; size: the sum of its terms. */
static void draw_right_side(const cluster *c, uint64_t *seed, double *d, double *size)
{
    double x[MAX];
    for (uint32_t j = 0; j < c->p.columns; j++) x[j] = c->weight[j] * draw_between(seed, -1.0, 1.0);
    for (uint32_t i = 0; i < c->p.rows; i++) {
        d[i] = size[i] = 0.0;
        for (uint32_t j = 0; j < c->p.columns; j++) {
            d[i] += c->B[STRIDE * i + j] * x[j];
            size[i] += fabs(c->B[STRIDE * i + j] * x[j]);
        }
    }
}

/* Largest cosine, in the metric 1/weight^2, between x and a vector of the null space that moves no column of weight 0.
 */
static double largest_cosine(const cluster *c, const double *x)
{
    const uint32_t rank = c->p.rank, m = c->p.columns - rank;
    double worst = 0.0;
    for (uint32_t j = 0; j < m; j++) {
        double sum = 0.0, xx = DBL_MIN, rr = DBL_MIN;
        for (uint32_t k = 0; k <= rank; k++) { /* dependent columns, and independent column j */
            const uint32_t column = c->column_order[k < rank ? k : rank + j];
            if (!(c->weight[column] > 0.0)) continue;
            const double r = (k < rank ? c->G[m * k + j] : 1.0) / c->weight[column], u = x[column] / c->weight[column];
            sum += u * r;
            xx += u * u;
            rr += r * r;
        }
        if (c->weight[c->column_order[rank + j]] > 0.0) worst = fmax(worst, fabs(sum) / sqrt(xx * rr));
    }
    return worst;
}

static void projection_is_shortest(void **state)
{
    (void)state;
    static cluster c;
    uint64_t seed = 76;
    double kept = 0.0, cosine = 0.0, lapack = 0.0, d[MAX], size[MAX], pivots[MAX], x[MAX], y[MAX];
    for (int i = 0; i < DRAWS; i++) {
        draw_sound(&c, &seed, harsh);
        assert_int_equal(dmb_partition_gram(&(dmb_jacobian){c.B, STRIDE, c.weight}, &c.p, c.gram), 0);
        draw_right_side(&c, &seed, d, size);
        for (uint32_t k = 0; k < c.p.rank; k++) pivots[k] = d[c.row_order[k]];
        dmb_partition_project(&(dmb_jacobian){c.B, STRIDE, c.weight}, &c.p, c.gram, pivots, x);
        for (uint32_t k = 0; k < c.p.rows; k++) {
            double rest = -d[k];
            for (uint32_t j = 0; j < c.p.columns; j++) rest += c.B[STRIDE * k + j] * x[j];
            kept = fmax(kept, fabs(rest) / (size[k] + DBL_MIN));
        }
        for (uint32_t j = 0; j < c.p.columns; j++) assert_true(c.weight[j] > 0.0 || x[j] == 0.0);
        dmb_partition_null_space(c.B, STRIDE, &c.p, c.lu, c.pivot, c.G);
        cosine = fmax(cosine, largest_cosine(&c, x));
        lapack_projection(&c, d, y);
        lapack = fmax(lapack, largest_difference(c.p.columns, x, y) / largest(c.p.columns, y));
    }
    check_below("B x = d in all rows, of the sum of its terms", kept, 1e-10);
    check_below("cosine between x and the null space", cosine, 1e-10);
    check_below("x against the shortest by LAPACK, of its largest", lapack, 1e-9);
}

/* Rows that are parallel now, under a choice made when they were not. */
static void projection_refuses_parallel_rows(void **state)
{
    (void)state;
    static cluster c;
    set(&c, 2, 3, (const double[]){1.0, 2.0, 3.0, 3.0, 1.0, -1.0});
    choose(&c);
    assert_int_equal(c.p.rank, 2);
    assert_int_equal(dmb_partition_gram(&(dmb_jacobian){c.B, STRIDE, c.weight}, &c.p, c.gram), 0);
    for (uint32_t j = 0; j < 3; j++) c.B[STRIDE + j] = -4.0 * c.B[j];
    assert_int_equal(dmb_partition_gram(&(dmb_jacobian){c.B, STRIDE, c.weight}, &c.p, c.gram), -1);
    assert_true(factor(&c) < 1e-15);
    for (uint32_t j = 0; j < 3; j++) c.B[STRIDE + j] = 0.0;
    assert_int_equal(dmb_partition_gram(&(dmb_jacobian){c.B, STRIDE, c.weight}, &c.p, c.gram), -1);
    assert_true(factor(&c) == 0.0);
}

/* Random multipliers of the pivot rows, zero in the redundant ones; g = B^T f. */
static void draw_multipliers(const cluster *c, uint64_t *seed, double *f, double *g)
{
    for (uint32_t i = 0; i < c->p.rows; i++) f[c->row_order[i]] = i < c->p.rank ? draw_between(seed, -1.0, 1.0) : 0.0;
    for (uint32_t j = 0; j < MAX; j++) g[j] = 0.0;
    for (uint32_t i = 0; i < c->p.rows; i++)
        for (uint32_t j = 0; j < c->p.columns; j++) g[j] += c->B[STRIDE * i + j] * f[i];
}

/* Largest |B^T f - g| in columns with a weight, as part of the sum of the terms of both sides. */
static double force_error(const cluster *c, const double *before, const double *f, const double *g)
{
    double worst = 0.0;
    for (uint32_t j = 0; j < c->p.columns; j++) {
        double sum = -g[j], size = DBL_MIN;
        for (uint32_t i = 0; i < c->p.rows; i++) {
            sum += c->B[STRIDE * i + j] * f[i];
            size += fabs(c->B[STRIDE * i + j]) * (fabs(before[i]) + fabs(f[i]));
        }
        if (c->weight[j] > 0.0) worst = fmax(worst, fabs(sum) / size);
    }
    return worst;
}

static double length_of(uint32_t n, const double *f)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < n; i++) sum = hypot(sum, f[i]);
    return sum;
}

static void least_norm_agrees_with_lapack(void **state)
{
    (void)state;
    static cluster c;
    static double A[MAX * MAX];
    uint64_t seed = 77;
    double kept = 0.0, lapack = 0.0, before[MAX], f[MAX], g[MAX];
    for (int i = 0; i < DRAWS; i++) {
        draw_sound(&c, &seed, (kind){1.0, 0.0, 0.0});
        draw_multipliers(&c, &seed, f, g);
        memcpy(before, f, sizeof f);
        dmb_partition_least_norm(&(dmb_jacobian){c.B, STRIDE, NULL}, &c.p, c.lu, c.pivot, c.work, f);
        kept = fmax(kept, force_error(&c, before, f, g));
        for (uint32_t j = 0; j < c.p.columns; j++)
            for (uint32_t k = 0; k < c.p.rows; k++) A[c.p.rows * j + k] = c.B[STRIDE * k + j];
        lapack_shortest(c.p.columns, c.p.rows, A, g);
        lapack = fmax(lapack, largest_difference(c.p.rows, f, g) / largest(c.p.rows, g));
    }
    check_below("B^T f unchanged, of the sum of its terms", kept, 1e-12);
    check_below("f against the shortest by LAPACK, of its largest", lapack, 1e-10);
}

/* Rows of all lengths: the same force, no longer than before, and nothing left to gain in a second pass, though that
 * begins with other values in the redundant rows. */
static void least_norm_of_rows_of_all_lengths(void **state)
{
    (void)state;
    static cluster c;
    uint64_t seed = 78;
    double kept = 0.0, longer = 0.0, again = 0.0, before[MAX], f[MAX], g[MAX], second[MAX];
    for (int i = 0; i < DRAWS; i++) {
        draw_sound(&c, &seed, harsh);
        draw_multipliers(&c, &seed, f, g);
        memcpy(before, f, sizeof f);
        const uint32_t used = (c.p.rows - c.p.rank) * c.p.rows; /* of work */
        c.work[used] = 12345.0;
        dmb_partition_least_norm(&(dmb_jacobian){c.B, STRIDE, NULL}, &c.p, c.lu, c.pivot, c.work, f);
        assert_true(c.work[used] == 12345.0);
        memcpy(second, f, sizeof f);
        dmb_partition_least_norm(&(dmb_jacobian){c.B, STRIDE, NULL}, &c.p, c.lu, c.pivot, c.work, second);
        const double length = length_of(c.p.rows, before);
        kept = fmax(kept, force_error(&c, before, f, g));
        longer = fmax(longer, length_of(c.p.rows, f) / length - 1.0);
        again = fmax(again, largest_difference(c.p.rows, f, second) / length);
    }
    check_below("B^T f unchanged, of the sum of its terms", kept, 1e-12);
    check_below("longer than before", longer, 1e-14);
    check_below("change in a second pass", again, 1e-13);
}

static void least_norm_of_twin_rows(void **state)
{
    (void)state;
    static cluster c;
    set(&c, 4, 2, (const double[]){0.0, 0.0, 2.0, 0.0, 2.0, 0.0, 2.0, 0.0}); /* one zero row, and three alike */
    choose(&c);
    assert_int_equal(c.p.rank, 1);
    assert_true(factor(&c) == 1.0);
    double f[4] = {0.0, 6.0, 0.0, 0.0};
    dmb_partition_least_norm(&(dmb_jacobian){c.B, STRIDE, NULL}, &c.p, c.lu, c.pivot, c.work, f);
    check_below("three twins share a load", largest_difference(4, f, (const double[]){0.0, 2.0, 2.0, 2.0}), 1e-15);
}

/* A slider on a line that turns, and one more row that does not: B = [cos, sin, 0; 0, 0, 1], or the first row alone. */
static void turn_slider(cluster *c, uint32_t rows, double angle)
{
    const double B[6] = {cos(angle), sin(angle), 0.0, 0.0, 0.0, 1.0};
    for (uint32_t i = 0; i < rows; i++) memcpy(c->B + STRIDE * i, B + 3 * i, 3 * sizeof(double));
}

static void quality_follows_a_turning_slider(void **state)
{
    (void)state;
    static cluster c;
    for (uint32_t rows = 1; rows <= 2; rows++) {
        clear(&c, rows, 3);
        turn_slider(&c, rows, 0.0);
        check_close("quality as chosen", choose(&c), 1.0, 1e-15);
        assert_true(c.column_order[0] == 0);
        double before = 2.0;
        for (int step = 0; step <= 15; step++) { /* to a tenth of a degree before the dead point */
            turn_slider(&c, rows, (double)step / 15.0 * 89.9 * PI / 180.0);
            const double quality = factor(&c);
            assert_true(quality <= before && quality > 0.0);
            before = quality;
        }
        check_below("quality near the dead point", before, 2e-3);
        check_close("quality of the new choice", choose(&c), 1.0, 1e-5);
        check_close("and of its factors", factor(&c), 1.0, 1e-5);
        assert_true(c.p.rank == rows && c.column_order[0] + c.column_order[rows - 1] >= 1);
        turn_slider(&c, rows, 0.0); /* now the old column would have been right */
        assert_true(factor(&c) == 0.0);
    }
}

/* Slider-crank: both coordinates of the crank pin and the place of the slider by two angles and the slider itself. */
static void slider_crank(cluster *c, double crank)
{
    const double rod = asin(0.5 * sin(crank)); /* crank 0.5, rod 1 */
    const double B[6] = {-0.5 * sin(crank), -sin(rod), -1.0, 0.5 * cos(crank), -cos(rod), 0.0};
    for (uint32_t i = 0; i < 2; i++) memcpy(c->B + STRIDE * i, B + 3 * i, 3 * sizeof(double));
}

/* With the slider independent and both angles dependent the mechanism is singular at the dead points. */
static void quality_falls_at_a_dead_point(void **state)
{
    (void)state;
    static cluster c;
    clear(&c, 2, 3);
    c.weight[2] = 0.0; /* the slider is wanted as independent */
    slider_crank(&c, 0.5 * PI);
    tell("quality with the slider independent, crank upright", choose(&c));
    assert_true(c.p.rank == 2 && c.column_order[2] == 2);
    c.weight[2] = 1.0;
    const double upright = factor(&c);
    slider_crank(&c, 1e-4);
    const double dead = factor(&c);
    check_below("quality near the dead point, of that with the crank upright", dead / upright, 1e-3);
    assert_true(choose(&c) > 0.1 && factor(&c) > 0.1);
    assert_true(c.column_order[2] != 2);
}

static void near_dependence(void **state)
{
    (void)state;
    static cluster c;
    const double scale[] = {1e-6, 1.0, 1e6};
    for (int i = 0; i < 3; i++) {
        for (uint32_t part = 0; part < 2; part++) {
            const double s = scale[i], off = part == 0 ? 1e-10 : 1e-6;
            set(&c, 2, 3, (const double[]){1.0, 2.0, 3.0, s, (2.0 + off) * s, 3.0 * s});
            const double quality = choose(&c);
            assert_int_equal(c.p.rank, part == 0 ? 1 : 2);
            assert_true(part == 0 ? quality == 1.0 : quality < 1e-5 && quality > 1e-8);
            check_relative("the same in factoring", factor(&c), quality, 1e-5);
        }
    }
}

/* Very short and very long rows keep their rank; those that count as zero do not. */
static void length_of_rows_does_not_matter(void **state)
{
    (void)state;
    static cluster c;
    const double scale[] = {1e-290, 1e-160, 1.0, 1e160, 1e290};
    const double want = 0.8 / (1.75 * sqrt(0.5)); /* the entry 4 is the first pivot */
    for (int i = 0; i < 5; i++) {
        const double s = scale[i];
        set(&c, 2, 2, (const double[]){3.0 * s, 4.0 * s, 1.0, -1.0});
        check_relative("quality", choose(&c), want, 1e-12);
        assert_int_equal(c.p.rank, 2);
        check_relative("quality in factoring", factor(&c), want, 1e-12);
        double x[2] = {7.0 * s, 0.0};
        if (c.row_order[0] != 0) x[1] = x[0], x[0] = 0.0;
        dmb_partition_solve(&c.p, c.lu, c.pivot, x);
        check_below("solution", largest_difference(2, x, (const double[]){1.0, 1.0}), 1e-14);
    }
    set(&c, 2, 2, (const double[]){3e-301, 4e-301, 1.0, -1.0});
    assert_true(choose(&c) == 1.0 && c.p.rank == 1 && c.row_order[0] == 1);
}

static void equal_candidates_are_taken_in_order(void **state)
{
    (void)state;
    static cluster c, noisy;
    uint64_t seed = 79;
    for (int i = 0; i < DRAWS; i++) {
        clear(&c, draw_integer(&seed, 1, 12), draw_integer(&seed, 1, 12));
        for (uint32_t k = 0; k < c.p.rows; k++)
            for (uint32_t j = 0; j < c.p.columns; j++)
                c.B[STRIDE * k + j] = draw_between(&seed, -1.0, 1.0) < 0.0 ? -1.0 : 1.0;
        choose(&c);
        assert_true(c.p.rank > 0 && c.row_order[0] == 0 && c.column_order[0] == 0);
        for (int trial = 0; trial < 5; trial++) {
            noisy = c;
            noisy.p.row_order = noisy.row_order;
            noisy.p.column_order = noisy.column_order;
            for (uint32_t k = 0; k < MAX * STRIDE; k++) noisy.B[k] += 1e-13 * draw_between(&seed, -1.0, 1.0);
            choose(&noisy);
            assert_int_equal(noisy.p.rank, c.p.rank);
            assert_memory_equal(noisy.row_order, c.row_order, sizeof c.row_order);
            assert_memory_equal(noisy.column_order, c.column_order, sizeof c.column_order);
            assert_true(factor(&noisy) > 0.0);
            for (uint32_t k = 0; k < c.p.rank; k++) assert_int_equal(noisy.pivot[k], k);
        }
    }
}

/* Three rows, of which the last is the sum of the others. */
static void small_cluster(cluster *c)
{
    set(c, 3, 4, (const double[]){1.0, 2.0, 3.0, 0.0, 3.0, 1.0, -1.0, 0.5, 4.0, 3.0, 2.0, 0.5});
}

/* All calls behind a choice, whose results are then of no account. */
static void run_all(cluster *c)
{
    double d[4] = {1.0, 1.0, 1.0, 1.0}, x[4], f[4] = {1.0, 1.0, 1.0, 1.0};
    dmb_partition_null_space(c->B, STRIDE, &c->p, c->lu, c->pivot, c->G);
    dmb_partition_solve(&c->p, c->lu, c->pivot, d);
    dmb_partition_solve_transposed(&c->p, c->lu, c->pivot, d);
    dmb_partition_gram(&(dmb_jacobian){c->B, STRIDE, c->weight}, &c->p, c->gram);
    dmb_partition_project(&(dmb_jacobian){c->B, STRIDE, c->weight}, &c->p, c->gram, d, x);
    dmb_partition_least_norm(&(dmb_jacobian){c->B, STRIDE, NULL}, &c->p, c->lu, c->pivot, c->work, f);
}

static void what_is_not_a_number_gives_no_quality(void **state)
{
    (void)state;
    static cluster c;
    const double bad[] = {(double)NAN, (double)INFINITY, -(double)INFINITY};
    for (int i = 0; i < 3; i++)
        for (uint32_t at = 0; at < 12; at++) {
            small_cluster(&c);
            choose(&c);
            assert_int_equal(c.p.rank, 2);
            c.B[STRIDE * (at / 4) + at % 4] = bad[i];
            const int redundant = c.row_order[2] == at / 4;
            assert_true(redundant ? factor(&c) > 0.0 : factor(&c) == 0.0);
            assert_int_equal(dmb_partition_gram(&(dmb_jacobian){c.B, STRIDE, c.weight}, &c.p, c.gram),
                             redundant ? 0 : -1);
            run_all(&c);
            assert_true(choose(&c) == 0.0);
            check_orders(&c);
            factor(&c);
            run_all(&c);
        }
    small_cluster(&c);
    c.weight[1] = (double)NAN;
    assert_true(choose(&c) == 0.0);
    check_orders(&c);
}

/* A dependent column that has lost its weight. */
static void weight_lost_gives_no_quality(void **state)
{
    (void)state;
    static cluster c;
    small_cluster(&c);
    choose(&c);
    c.weight[c.column_order[1]] = 0.0;
    assert_true(factor(&c) == 0.0);
    assert_true(choose(&c) > 0.0 && c.p.rank == 2 && factor(&c) > 0.0);
}

static void empty_clusters(void **state)
{
    (void)state;
    static cluster c;
    const uint32_t size[][2] = {{0, 0}, {0, 3}, {3, 0}, {3, 3}};
    for (int i = 0; i < 4; i++) {
        clear(&c, size[i][0], size[i][1]); /* the last one is all zeros */
        assert_true(choose(&c) == 1.0);
        assert_int_equal(c.p.rank, 0);
        check_orders(&c);
        assert_true(factor(&c) == 1.0);
        assert_int_equal(dmb_partition_gram(&(dmb_jacobian){c.B, STRIDE, c.weight}, &c.p, c.gram), 0);
        run_all(&c);
    }
    double x[3] = {1.0, 1.0, 1.0}, f[3] = {1.0, 2.0, 3.0};
    dmb_partition_project(&(dmb_jacobian){c.B, STRIDE, c.weight}, &c.p, c.gram, NULL, x);
    dmb_partition_least_norm(&(dmb_jacobian){c.B, STRIDE, NULL}, &c.p, c.lu, c.pivot, c.work, f);
    assert_true(largest(3, x) == 0.0 && largest(3, f) == 0.0);
    set(&c, 1, 2, (const double[]){1.0, 2.0});
    c.weight[0] = c.weight[1] = 0.0;
    assert_true(choose(&c) == 1.0 && c.p.rank == 0);
}

static void repeats_bit_for_bit(void **state)
{
    (void)state;
    static cluster c, again;
    uint64_t seed = 80;
    for (int i = 0; i < 50; i++) {
        draw_cluster(&c, &seed, mild);
        again = c;
        again.p.row_order = again.row_order;
        again.p.column_order = again.column_order;
        assert_true(choose(&c) == choose(&again) && factor(&c) == factor(&again));
        dmb_partition_null_space(c.B, STRIDE, &c.p, c.lu, c.pivot, c.G);
        dmb_partition_null_space(again.B, STRIDE, &again.p, again.lu, again.pivot, again.G);
        assert_memory_equal(c.lu, again.lu, sizeof c.lu);
        assert_memory_equal(c.G, again.G, sizeof c.G);
    }
}

/* Clusters of many bodies, whose rows have few entries each. */
enum { BODIES = 30, DOF = 6, WIDE = BODIES * DOF, TALL = 160 };

typedef struct graph {
    double B[TALL * (WIDE + 1)], weight[WIDE];
    dmb_partition p;
    uint32_t row_order[TALL], column_order[WIDE], pivot[TALL];
    double work[TALL * WIDE + TALL], lu[TALL * TALL], G[TALL * WIDE], gram[TALL * TALL + 1];
} graph;

enum shape { CHAIN, RING, STAR, TREE, ANY, SHAPES };

static void shuffle(uint32_t n, uint32_t *order, uint64_t *seed)
{
    for (uint32_t i = n; i-- > 1;) {
        const uint32_t at = draw_integer(seed, 0, i), item = order[i];
        order[i] = order[at];
        order[at] = item;
    }
}

static uint32_t other_body(enum shape shape, uint32_t joint, uint32_t bodies, uint64_t *seed)
{
    if (shape == STAR || joint == 0) return 0;
    if (shape == TREE) return (joint - 1) / 2;
    if (shape == ANY) return draw_integer(seed, 0, bodies - 1);
    return joint - 1;
}

/* Joint i holds body i to another one, the first to nothing; a ring has one more, from last to first. Bodies and joints
 * stand in any order. */
static void draw_graph(graph *g, enum shape shape, uint32_t bodies, uint64_t *seed)
{
    uint32_t place[BODIES], joint[BODIES + 1], rows = 0;
    const uint32_t joints = bodies + (shape == RING);
    memset(g, 0, sizeof *g);
    for (uint32_t i = 0; i < bodies; i++) place[i] = i;
    for (uint32_t i = 0; i < joints; i++) joint[i] = i;
    if (draw_between(seed, 0.0, 1.0) < 0.7) shuffle(bodies, place, seed), shuffle(joints, joint, seed);
    for (uint32_t i = 0; i < joints; i++) {
        const uint32_t count = draw_integer(seed, 1, 5), a = joint[i] % bodies;
        const uint32_t b = joint[i] == bodies ? bodies - 1 : other_body(shape, joint[i], bodies, seed);
        for (uint32_t r = 0; r < count; r++, rows++)
            for (uint32_t c = 0; c < DOF; c++) {
                double *row = g->B + (size_t)rows * (WIDE + 1);
                row[DOF * place[a] + c] = draw_between(seed, -1.0, 1.0);
                if (draw_between(seed, 0.0, 1.0) < 0.7) row[DOF * place[b] + c] = draw_between(seed, -1.0, 1.0);
            }
    }
    g->p = (dmb_partition){rows, DOF * bodies, 0, 0, g->row_order, g->column_order};
    for (uint32_t j = 0; j < WIDE; j++)
        g->weight[j] = draw_between(seed, 0.0, 1.0) < 0.05 ? 0.0 : draw_between(seed, 0.3, 3.0);
    for (uint32_t i = 0; i < TALL * (WIDE + 1); i++)
        if (i % (WIDE + 1) >= g->p.columns) g->B[i] = (double)NAN;
}

static double choose_graph(graph *g)
{
    return dmb_partition_choose(g->B, WIDE + 1, g->weight, g->work, &g->p);
}

static void draw_sound_graph(graph *g, enum shape shape, uint32_t bodies, uint64_t *seed)
{
    do draw_graph(g, shape, bodies, seed);
    while (choose_graph(g) < 1e-3);
    assert_true(dmb_partition_factor(g->B, WIDE + 1, g->weight, &g->p, g->lu, g->pivot) > 0.0);
}

static double graph_entry(const graph *g, uint32_t row_place, uint32_t column)
{
    return g->B[(size_t)g->row_order[row_place] * (WIDE + 1) + column];
}

/* The projection of d (by pivot row) into x, and the notes beside the factors within bounds. */
static void project_graph(graph *g, const double *d, double *x)
{
    double copy[TALL];
    const size_t end = (size_t)g->p.rank * g->p.rank;
    for (size_t i = 0; i < end; i++) g->gram[i] = (double)NAN; /* of what was there nothing must be used */
    g->gram[end] = 12345.0;
    assert_int_equal(dmb_partition_gram(&(dmb_jacobian){g->B, WIDE + 1, g->weight}, &g->p, g->gram), 0);
    dmb_partition_drop_near_redundant(&(dmb_jacobian){g->B, WIDE + 1, g->weight}, &g->p, g->gram);
    assert_true(g->gram[end] == 12345.0);
    memcpy(copy, d, sizeof copy);
    dmb_partition_project(&(dmb_jacobian){g->B, WIDE + 1, g->weight}, &g->p, g->gram, copy, x);
}

static void lapack_graph_projection(const graph *g, const double *d, double *x)
{
    static double A[TALL * WIDE], value[TALL];
    const uint32_t m = g->p.rank, n = g->p.columns;
    lapack_int rank = 0;
    for (uint32_t k = 0; k < m; k++)
        for (uint32_t j = 0; j < n; j++) A[n * k + j] = graph_entry(g, k, j) * g->weight[j];
    for (uint32_t k = 0; k < WIDE; k++) x[k] = k < m ? d[k] : 0.0;
    assert_int_equal(
        LAPACKE_dgelsd(LAPACK_ROW_MAJOR, (lapack_int)m, (lapack_int)n, 1, A, (lapack_int)n, x, 1, value, 1e-13, &rank),
        0);
    assert_int_equal(rank, m);
    for (uint32_t j = 0; j < n; j++) x[j] *= g->weight[j];
}

static void lapack_graph_null_space(const graph *g, double *G)
{
    static double C[TALL * TALL];
    static lapack_int exchanged[TALL];
    const uint32_t rank = g->p.rank, m = g->p.columns - rank;
    for (uint32_t k = 0; k < rank; k++) {
        for (uint32_t j = 0; j < rank; j++) C[rank * k + j] = graph_entry(g, k, g->column_order[j]);
        for (uint32_t j = 0; j < m; j++) G[m * k + j] = -graph_entry(g, k, g->column_order[rank + j]);
    }
    assert_int_equal(LAPACKE_dgesv(LAPACK_ROW_MAJOR, (lapack_int)rank, (lapack_int)m, C, (lapack_int)rank, exchanged, G,
                                   (lapack_int)m),
                     0);
}

static void sparse_rows_agree_with_lapack(void **state)
{
    (void)state;
    static graph g;
    static double G[TALL * WIDE];
    uint64_t seed = 81;
    double projection = 0.0, null_space = 0.0, d[TALL], x[WIDE], y[WIDE];
    for (int i = 0; i < 100; i++) {
        const uint32_t bodies = i < 50 ? draw_integer(&seed, 1, 8) : draw_integer(&seed, 9, BODIES);
        draw_sound_graph(&g, (enum shape)(i % SHAPES), bodies, &seed);
        for (uint32_t k = 0; k < TALL; k++) d[k] = draw_between(&seed, -1.0, 1.0);
        project_graph(&g, d, x);
        lapack_graph_projection(&g, d, y);
        projection = fmax(projection, largest_difference(g.p.columns, x, y) / largest(g.p.columns, y));
        dmb_partition_null_space(g.B, WIDE + 1, &g.p, g.lu, g.pivot, g.G);
        lapack_graph_null_space(&g, G);
        const size_t n = (size_t)g.p.rank * (g.p.columns - g.p.rank);
        null_space = fmax(null_space, largest_difference(n, g.G, G) / largest(n, G));
    }
    check_below("x against the shortest by LAPACK, of its largest", projection, 1e-9);
    check_below("G against LAPACK, of its largest", null_space, 1e-11);
}

/* The projection is the same whatever the order of the pivot rows. */
static void order_of_sparse_rows_does_not_matter(void **state)
{
    (void)state;
    static graph g;
    uint64_t seed = 82;
    double worst = 0.0, by_row[TALL], d[TALL], x[WIDE], y[WIDE];
    for (int i = 0; i < 50; i++) {
        draw_sound_graph(&g, (enum shape)(i % SHAPES), draw_integer(&seed, 6, BODIES), &seed);
        for (uint32_t k = 0; k < TALL; k++) by_row[k] = draw_between(&seed, -1.0, 1.0);
        for (uint32_t k = 0; k < g.p.rank; k++) d[k] = by_row[g.row_order[k]];
        project_graph(&g, d, x);
        shuffle(g.p.rank, g.row_order, &seed);
        for (uint32_t k = 0; k < g.p.rank; k++) d[k] = by_row[g.row_order[k]];
        project_graph(&g, d, y);
        worst = fmax(worst, largest_difference(g.p.columns, x, y) / largest(g.p.columns, y));
    }
    check_below("x in another order of rows, of its largest", worst, 1e-9);
}

/* A joint's row that has come to say what those before it say is left out; those before it are held. */
static void weak_row_is_left_out(void **state)
{
    (void)state;
    static graph g;
    uint64_t seed = 83;
    double worst = 0.0, d[TALL], x[WIDE];
    for (int i = 0; i < 50; i++) {
        draw_sound_graph(&g, (enum shape)(i % SHAPES), draw_integer(&seed, 2, BODIES), &seed);
        const uint32_t n = g.p.rank, last = draw_integer(&seed, 1, n - 1), first = draw_integer(&seed, 0, last - 1);
        double *weak = g.B + (size_t)g.row_order[last] * (WIDE + 1);
        const double *strong = g.B + (size_t)g.row_order[first] * (WIDE + 1);
        for (uint32_t j = 0; j < g.p.columns; j++) weak[j] = strong[j] + 2e-6 * weak[j];
        for (uint32_t k = 0; k < TALL; k++) d[k] = draw_between(&seed, -1.0, 1.0);
        project_graph(&g, d, x);
        assert_true(g.gram[(size_t)n * last + last] == 0.0);
        for (uint32_t k = 0; k < n; k++) {
            if (k == last) continue;
            double rest = -d[k];
            for (uint32_t j = 0; j < g.p.columns; j++) rest += graph_entry(&g, k, j) * x[j];
            worst = fmax(worst, fabs(rest) / largest(g.p.columns, x));
        }
    }
    check_below("B x - d of the rows before it, of the largest x", worst, 1e-9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rank_agrees_with_singular_values),
        cmocka_unit_test(null_space_is_annihilated),
        cmocka_unit_test(null_space_agrees_with_lapack),
        cmocka_unit_test(solves_both_ways),
        cmocka_unit_test(exchanges_of_rows),
        cmocka_unit_test(projection_is_shortest),
        cmocka_unit_test(projection_refuses_parallel_rows),
        cmocka_unit_test(least_norm_agrees_with_lapack),
        cmocka_unit_test(least_norm_of_rows_of_all_lengths),
        cmocka_unit_test(least_norm_of_twin_rows),
        cmocka_unit_test(quality_follows_a_turning_slider),
        cmocka_unit_test(quality_falls_at_a_dead_point),
        cmocka_unit_test(near_dependence),
        cmocka_unit_test(length_of_rows_does_not_matter),
        cmocka_unit_test(equal_candidates_are_taken_in_order),
        cmocka_unit_test(what_is_not_a_number_gives_no_quality),
        cmocka_unit_test(weight_lost_gives_no_quality),
        cmocka_unit_test(empty_clusters),
        cmocka_unit_test(repeats_bit_for_bit),
        cmocka_unit_test(sparse_rows_agree_with_lapack),
        cmocka_unit_test(order_of_sparse_rows_does_not_matter),
        cmocka_unit_test(weak_row_is_left_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
