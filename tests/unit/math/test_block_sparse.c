/* Block-sparse solver against LAPACK and CHOLMOD on graphs of all kinds: sizes that change, singular blocks, growth of
 * fill and work with the length of a string, allocations that fail, repeatability. */
#include "math_test.h"

#include <cholmod.h>
#include <lapacke.h>
#include <stdlib.h>

#include "base/memory.h"
#include "math/block_sparse.h"
#include "math/inertia.h"

#define EDGES_MAX 4000

/* A graph, its matrix, and a copy of the values before factoring. */
/* A_ij, i != j, size_i x size_j, row-major without gaps; NULL where the pattern has no such pair. */
static double *entry_of(const dmb_block_pattern *pattern, const dmb_block_sparse *matrix, uint32_t i, uint32_t j)
{
    const size_t offset = dmb_block_pattern_offset(pattern, i, j);
    return offset == DMB_BLOCK_NO_OFFSET ? NULL : matrix->values + offset;
}

typedef struct block_system {
    uint32_t n, edges, rows;
    dmb_block_edge edge[EDGES_MAX];
    uint32_t *capacity, *size, *row;
    dmb_block_pattern pattern;
    dmb_block_sparse matrix;
    double *fresh;
} block_system;

static dmb_allocator plain;

static void *numbers(size_t count, size_t item)
{
    void *block = calloc(count + 1, item);
    assert_non_null(block);
    return block;
}

static uint32_t below(random_stream *r, uint32_t bound)
{
    return (uint32_t)((0.5 * draw(r) + 0.5) * bound) % bound;
}

static void couple(block_system *s, uint32_t a, uint32_t b)
{
    assert_true(s->edges < EDGES_MAX);
    s->edge[s->edges++] = (dmb_block_edge){a, b};
}

/* ---- Graphs on n blocks ------------------------------------------------------------------------------------------ */
typedef void graph_fn(block_system *s, random_stream *r);

static void chain(block_system *s, random_stream *r)
{
    (void)r;
    for (uint32_t i = 1; i < s->n; i++) couple(s, i - 1, i);
}

static void ring(block_system *s, random_stream *r)
{
    chain(s, r);
    if (s->n > 2) couple(s, s->n - 1, 0);
}

static void chain_with_arcs(block_system *s, random_stream *r)
{
    chain(s, r);
    for (uint32_t i = 0; i < s->n / 6; i++) couple(s, below(r, s->n), below(r, s->n));
}

static void tree(block_system *s, random_stream *r)
{
    for (uint32_t i = 1; i < s->n; i++) couple(s, i, below(r, i));
}

static void grid(block_system *s, random_stream *r)
{
    uint32_t width = 1;
    (void)r;
    while ((width + 1) * (width + 1) <= s->n) width++;
    for (uint32_t i = 0; i < s->n; i++) {
        if ((i + 1) % width != 0 && i + 1 < s->n) couple(s, i, i + 1);
        if (i + width < s->n) couple(s, i + width, i);
    }
}

/* any pairs, some twice, some of a block with itself, many blocks left alone */
static void scattered(block_system *s, random_stream *r)
{
    for (uint32_t i = 0; i < s->n; i++) couple(s, below(r, s->n), below(r, s->n));
    for (uint32_t i = 0; i < s->n / 3; i++) couple(s, s->edge[i].b, s->edge[i].a);
}

static void several_chains(block_system *s, random_stream *r)
{
    (void)r;
    for (uint32_t i = 1; i < s->n; i++)
        if (i % 7 != 0) couple(s, i, i - 1);
}

static void isolated(block_system *s, random_stream *r)
{
    (void)s;
    (void)r;
}

static void star(block_system *s, random_stream *r)
{
    (void)r;
    for (uint32_t i = 1; i < s->n; i++) couple(s, i, 0);
}

static void everything(block_system *s, random_stream *r)
{
    (void)r;
    for (uint32_t i = 0; i < s->n; i++)
        for (uint32_t j = 0; j < i; j++) couple(s, i, j);
}

static graph_fn *const graphs[] = {chain,     ring,           chain_with_arcs, tree, grid,
                                   scattered, several_chains, isolated,        star, everything};
#define GRAPH_COUNT (sizeof graphs / sizeof graphs[0])

/* Chains numbered in no order are still chains. */
static void shuffle_names(block_system *s, random_stream *r)
{
    uint32_t *name = numbers(s->n, sizeof *name);
    for (uint32_t i = 0; i < s->n; i++) name[i] = i;
    for (uint32_t i = s->n; i > 1; i--) {
        const uint32_t j = below(r, i), t = name[i - 1];
        name[i - 1] = name[j];
        name[j] = t;
    }
    for (uint32_t e = 0; e < s->edges; e++) s->edge[e] = (dmb_block_edge){name[s->edge[e].a], name[s->edge[e].b]};
    free(name);
}

/* ---- Systems ----------------------------------------------------------------------------------------------------- */
static void set_graph(block_system *s, uint32_t n, graph_fn *graph, random_stream *r)
{
    s->n = n;
    s->edges = 0;
    graph(s, r);
    s->capacity = numbers(n, sizeof *s->capacity);
    s->size = numbers(n, sizeof *s->size);
    s->row = numbers(n, sizeof *s->row);
}

static void make_system(block_system *s)
{
    assert_int_equal(dmb_block_pattern_make(&plain, s->n, s->capacity, s->edges, s->edge, &s->pattern), DMB_OK);
    s->fresh = numbers(s->pattern.values, sizeof(double));
    s->matrix.values = numbers(s->pattern.values, sizeof(double));
    s->matrix.pivot = numbers(s->pattern.rows, sizeof(uint32_t));
    s->matrix.size = s->size;
}

static void free_system(block_system *s)
{
    dmb_block_pattern_release(&s->pattern, &plain);
    free(s->fresh);
    free(s->matrix.values);
    free(s->matrix.pivot);
    free(s->capacity);
    free(s->size);
    free(s->row);
}

static uint32_t frequent_size(random_stream *r)
{
    static const uint32_t size[] = {6, 6, 6, 6, 2, 1, 3, 5, 7, 12};
    return size[below(r, 10)];
}

/* kind 0: all 6 rows; 1: mixed, at their capacities; 2: anything from 0 to the capacity */
static void draw_sizes(block_system *s, int kind, random_stream *r)
{
    s->rows = 0;
    for (uint32_t i = 0; i < s->n; i++) {
        s->size[i] = kind == 2 ? below(r, s->capacity[i] + 1) : s->capacity[i];
        s->row[i] = s->rows;
        s->rows += s->size[i];
    }
}

static void draw_capacities(block_system *s, int kind, random_stream *r)
{
    for (uint32_t i = 0; i < s->n; i++) s->capacity[i] = kind == 0 ? 6 : frequent_size(r);
}

/* Random blocks at the edges; a diagonal heavier than everything beside it. Symmetric: A_ji = A_ij^T as well. */
static void draw_values(block_system *s, bool symmetric, random_stream *r)
{
    dmb_block_sparse_clear(&s->pattern, &s->matrix);
    double *weight = numbers(s->n, sizeof(double));
    for (uint32_t e = 0; e < s->edges; e++) {
        const uint32_t a = s->edge[e].a, b = s->edge[e].b, p = s->size[a], q = s->size[b];
        double *A = entry_of(&s->pattern, &s->matrix, a, b);
        double *B = entry_of(&s->pattern, &s->matrix, b, a);
        if (a == b) continue;
        assert_non_null(A);
        assert_non_null(B);
        weight[a] += q;
        weight[b] += p;
        for (uint32_t i = 0; i < p; i++)
            for (uint32_t j = 0; j < q; j++) {
                A[q * i + j] = draw(r);
                B[p * j + i] = symmetric ? A[q * i + j] : draw(r);
            }
    }
    for (uint32_t i = 0; i < s->n; i++) {
        const uint32_t n = s->size[i];
        double *D = dmb_block_sparse_diagonal(&s->pattern, &s->matrix, i);
        for (uint32_t k = 0; k < n; k++) {
            for (uint32_t l = 0; l < n; l++) D[n * k + l] = symmetric && l < k ? D[n * l + k] : draw(r);
            D[n * k + k] += weight[i] + n;
        }
    }
    free(weight);
    memcpy(s->fresh, s->matrix.values, sizeof(double) * s->pattern.values);
}

/* Calls put(context, row, column, value) for each number of the matrix before factoring, fill left out. */
typedef void put_fn(void *context, uint32_t row, uint32_t column, double value);

static void for_each_value(const block_system *s, put_fn *put, void *context)
{
    for (uint32_t a = 0; a < s->n; a++)
        for (uint32_t b = 0; b < s->n; b++) {
            const size_t offset = dmb_block_pattern_offset(&s->pattern, a, b);
            if (offset == DMB_BLOCK_NO_OFFSET) continue;
            for (uint32_t i = 0; i < s->size[a]; i++)
                for (uint32_t j = 0; j < s->size[b]; j++)
                    put(context, s->row[a] + i, s->row[b] + j, s->fresh[offset + s->size[b] * i + j]);
        }
}

typedef struct dense_matrix {
    uint32_t rows;
    double *A;
} dense_matrix;

static void put_dense(void *context, uint32_t row, uint32_t column, double value)
{
    const dense_matrix *dense = context;
    dense->A[(size_t)dense->rows * row + column] = value;
}

static void solve_dense(const block_system *s, double *b)
{
    const lapack_int N = (lapack_int)s->rows;
    dense_matrix dense = {s->rows, numbers((size_t)s->rows * s->rows, sizeof(double))};
    lapack_int *exchanged = numbers(s->rows, sizeof *exchanged);
    for_each_value(s, put_dense, &dense);
    if (N > 0) assert_int_equal(LAPACKE_dgesv(LAPACK_ROW_MAJOR, N, 1, dense.A, N, exchanged, b, 1), 0);
    free(dense.A);
    free(exchanged);
}

/* Factor and solve against LAPACK; the residual by LAPACK's matrix follows. */
static void compare(block_system *s, random_stream *r)
{
    double *x = numbers(s->rows, sizeof(double)), *z = numbers(s->rows, sizeof(double));
    const int N = (int)s->rows;
    draw_vector(r, N, x);
    memcpy(z, x, sizeof(double) * s->rows);
    assert_int_equal(dmb_block_sparse_factor(&s->pattern, &s->matrix), -1);
    dmb_block_sparse_solve(&s->pattern, &s->matrix, s->row, x);
    solve_dense(s, z);
    CHECK_BELOW(max_difference(N, x, z), 1e-12 * max_abs(N, z));
    free(x);
    free(z);
}

/* ---- Tests ------------------------------------------------------------------------------------------------------- */
static void agrees_with_lapack(void **state)
{
    (void)state;
    static block_system s;
    static const uint32_t counts[] = {1, 2, 3, 5, 9, 16, 40, 61};
    random_stream r = {61};
    for (size_t g = 0; g < GRAPH_COUNT; g++)
        for (size_t c = 0; c < sizeof counts / sizeof counts[0]; c++)
            for (int kind = 0; kind < 3; kind++) {
                set_graph(&s, counts[c], graphs[g], &r);
                shuffle_names(&s, &r);
                draw_capacities(&s, kind, &r);
                make_system(&s);
                draw_sizes(&s, kind, &r);
                draw_values(&s, false, &r);
                compare(&s, &r);
                free_system(&s);
            }
}

/* One pattern, many matrices: the sizes of the blocks come and go, offsets stay. */
static void sizes_change_on_one_pattern(void **state)
{
    (void)state;
    static block_system s;
    random_stream r = {62};
    set_graph(&s, 40, chain_with_arcs, &r);
    draw_capacities(&s, 1, &r);
    make_system(&s);
    const size_t offset = dmb_block_pattern_offset(&s.pattern, 7, 8);
    for (int i = 0; i < 60; i++) {
        draw_sizes(&s, i % 2 ? 2 : 1, &r);
        draw_values(&s, false, &r);
        compare(&s, &r);
        assert_true(entry_of(&s.pattern, &s.matrix, 7, 8) == s.matrix.values + offset);
    }
    memset(s.size, 0, sizeof(uint32_t) * s.n); /* nothing at all */
    s.rows = 0;
    draw_values(&s, false, &r);
    compare(&s, &r);
    free_system(&s);
}

/* Blocks of hundreds of rows beside blocks of 6: sizes around the panel of the dense kernels, and far beyond. */
static void large_blocks(void **state)
{
    (void)state;
    static block_system s;
    static const uint32_t large[] = {8, 31, 32, 33, 63, 64, 65, 100, 257, 600};
    random_stream r = {63};
    for (size_t c = 0; c < sizeof large / sizeof large[0]; c++)
        for (int both = 0; both < 2; both++) {
            set_graph(&s, 12, both ? ring : star, &r);
            draw_capacities(&s, 0, &r);
            s.capacity[0] = large[c];
            if (both) s.capacity[1] = large[c] / 2;
            make_system(&s);
            draw_sizes(&s, 0, &r);
            draw_values(&s, false, &r);
            compare(&s, &r);
            free_system(&s);
        }
}

/* Rows of each diagonal block turned round: only pivoting finds the weight, in small kernels and large. */
static void pivots_inside_blocks(void **state)
{
    (void)state;
    static block_system s;
    random_stream r = {64};
    for (uint32_t n = 2; n <= 70; n += n < 8 ? 1 : 31) {
        set_graph(&s, 9, ring, &r);
        for (uint32_t i = 0; i < s.n; i++) s.capacity[i] = n;
        make_system(&s);
        draw_sizes(&s, 1, &r);
        draw_values(&s, false, &r);
        for (uint32_t i = 0; i < s.n; i++) {
            double *D = dmb_block_sparse_diagonal(&s.pattern, &s.matrix, i), first[70];
            memcpy(first, D, sizeof(double) * n);
            memmove(D, D + n, sizeof(double) * n * (n - 1));
            memcpy(D + n * (n - 1), first, sizeof(double) * n);
            D[0] = 0.0;
        }
        memcpy(s.fresh, s.matrix.values, sizeof(double) * s.pattern.values);
        compare(&s, &r);
        free_system(&s);
    }
}

static void put_triplet(void *context, uint32_t row, uint32_t column, double value)
{
    cholmod_triplet *T = context;
    if (row > column) return;
    ((int *)T->i)[T->nnz] = (int)row;
    ((int *)T->j)[T->nnz] = (int)column;
    ((double *)T->x)[T->nnz++] = value;
}

/* b <- A^-1 b by CHOLMOD from A's upper triangle */
static void solve_cholmod(const block_system *s, double *b)
{
    cholmod_common c;
    assert_true(cholmod_start(&c));
    c.print = 0;
    c.supernodal = CHOLMOD_SIMPLICIAL; /* starts no threads */
    cholmod_triplet *T = cholmod_allocate_triplet(s->rows, s->rows, s->pattern.values, 1, CHOLMOD_REAL, &c);
    for_each_value(s, put_triplet, T);
    cholmod_sparse *A = cholmod_triplet_to_sparse(T, T->nnz, &c);
    cholmod_factor *L = cholmod_analyze(A, &c);
    assert_true(cholmod_factorize(A, L, &c) && c.status == CHOLMOD_OK);
    cholmod_dense *y = cholmod_allocate_dense(s->rows, 1, s->rows, CHOLMOD_REAL, &c);
    memcpy(y->x, b, sizeof(double) * s->rows);
    cholmod_dense *x = cholmod_solve(CHOLMOD_A, L, y, &c);
    memcpy(b, x->x, sizeof(double) * s->rows);
    cholmod_free_dense(&x, &c);
    cholmod_free_dense(&y, &c);
    cholmod_free_factor(&L, &c);
    cholmod_free_sparse(&A, &c);
    cholmod_free_triplet(&T, &c);
    cholmod_finish(&c);
}

static void agrees_with_cholmod(void **state)
{
    (void)state;
    static block_system s;
    random_stream r = {65};
    for (size_t g = 0; g < GRAPH_COUNT; g++)
        for (int kind = 0; kind < 2; kind++) {
            set_graph(&s, 50, graphs[g], &r);
            shuffle_names(&s, &r);
            draw_capacities(&s, kind, &r);
            make_system(&s);
            draw_sizes(&s, kind, &r);
            draw_values(&s, true, &r);
            double *x = numbers(s.rows, sizeof(double)), *z = numbers(s.rows, sizeof(double));
            draw_vector(&r, (int)s.rows, x);
            memcpy(z, x, sizeof(double) * s.rows);
            solve_cholmod(&s, z);
            assert_int_equal(dmb_block_sparse_factor(&s.pattern, &s.matrix), -1);
            dmb_block_sparse_solve(&s.pattern, &s.matrix, s.row, x);
            CHECK_BELOW(max_difference((int)s.rows, x, z), 1e-12 * max_abs((int)s.rows, z));
            free(x);
            free(z);
            free_system(&s);
        }
}

/* Rows of rhs stand where the caller wants; what lies between is left alone. */
static void scattered_right_hand_side(void **state)
{
    (void)state;
    static block_system s;
    random_stream r = {66};
    double x[2 * 6 * 20], z[6 * 20];
    set_graph(&s, 20, chain_with_arcs, &r);
    draw_capacities(&s, 0, &r);
    make_system(&s);
    draw_sizes(&s, 0, &r);
    draw_values(&s, false, &r);
    draw_vector(&r, 240, x);
    for (uint32_t i = 0; i < 20; i++) {
        s.row[i] = 12 * (19 - i) + 3;
        memcpy(z + 6 * i, x + s.row[i], sizeof(double) * 6);
        for (uint32_t k = 0; k < 12; k++)
            if (k < 3 || k >= 9) x[12 * i + k] = 77.0;
    }
    assert_int_equal(dmb_block_sparse_factor(&s.pattern, &s.matrix), -1);
    dmb_block_sparse_solve(&s.pattern, &s.matrix, s.row, x);
    for (uint32_t i = 0; i < 20; i++) s.row[i] = 6 * i;
    dmb_block_sparse_solve(&s.pattern, &s.matrix, s.row, z);
    for (uint32_t i = 0; i < 20; i++) {
        assert_memory_equal(x + 12 * (19 - i) + 3, z + 6 * i, sizeof(double) * 6);
        for (uint32_t k = 0; k < 12; k++)
            if (k < 3 || k >= 9) assert_true(x[12 * i + k] == 77.0);
    }
    free_system(&s);
}

/* A block without couplings in one column, and nothing on its diagonal there. */
static void singular_block_is_reported(void **state)
{
    (void)state;
    static block_system s;
    random_stream r = {67};
    for (size_t g = 0; g < GRAPH_COUNT; g++)
        for (int kind = 0; kind < 2; kind++)
            for (uint32_t bad = 0; bad < 16; bad++) {
                dmb_block_weakest weakest;
                set_graph(&s, 16, graphs[g], &r);
                draw_capacities(&s, kind, &r);
                make_system(&s);
                draw_sizes(&s, kind, &r);
                draw_values(&s, false, &r);
                const uint32_t n = s.size[bad], k = below(&r, n);
                for (uint32_t i = 0; i < 16; i++) {
                    double *A = entry_of(&s.pattern, &s.matrix, i, bad);
                    for (uint32_t p = 0; A != NULL && p < s.size[i]; p++) A[n * p + k] = 0.0;
                }
                memcpy(s.fresh, s.matrix.values, sizeof(double) * s.pattern.values);
                assert_int_equal(dmb_block_sparse_factor(&s.pattern, &s.matrix), bad);
                memcpy(s.matrix.values, s.fresh, sizeof(double) * s.pattern.values);
                assert_int_equal(dmb_block_sparse_factor_watched(&s.pattern, &s.matrix, &weakest), bad);
                assert_int_equal(weakest.block, bad);
                assert_int_equal(weakest.unknown, k);
                assert_true(weakest.ratio == 0.0);
                free_system(&s);
            }
}

/* NaN and infinity anywhere in the matrix are found, in a block that they reach. */
static void what_is_not_a_number_is_reported(void **state)
{
    (void)state;
    static block_system s;
    random_stream r = {68};
    const double bad[] = {(double)NAN, (double)INFINITY, -(double)INFINITY};
    set_graph(&s, 6, ring, &r);
    draw_capacities(&s, 0, &r);
    s.capacity[2] = s.capacity[3] = 5;
    make_system(&s);
    draw_sizes(&s, 1, &r);
    draw_values(&s, false, &r);
    for (size_t at = 0; at < s.pattern.values; at++) {
        memcpy(s.matrix.values, s.fresh, sizeof(double) * s.pattern.values);
        s.matrix.values[at] = bad[at % 3];
        assert_true(dmb_block_sparse_factor(&s.pattern, &s.matrix) >= 0);
    }
    free_system(&s);
}

static void weakest_pivot_is_found(void **state)
{
    (void)state;
    static block_system s;
    random_stream r = {69};
    dmb_block_weakest weakest;
    for (uint32_t weak = 0; weak < 20; weak++) {
        set_graph(&s, 20, chain_with_arcs, &r);
        draw_capacities(&s, 0, &r);
        s.capacity[weak] = weak % 2 ? 6 : 40;
        make_system(&s);
        draw_sizes(&s, 1, &r);
        draw_values(&s, false, &r);
        const uint32_t n = s.size[weak];
        for (uint32_t i = 0; i < s.n; i++) { /* the column hardly holds anything, and no one else does */
            double *A = entry_of(&s.pattern, &s.matrix, i, weak);
            for (uint32_t p = 0; A != NULL && p < s.size[i]; p++) A[n * p + 4] *= i == weak ? 1e-9 : 0.0;
        }
        memcpy(s.fresh, s.matrix.values, sizeof(double) * s.pattern.values);
        assert_int_equal(dmb_block_sparse_factor_watched(&s.pattern, &s.matrix, &weakest), -1);
        assert_int_equal(weakest.block, weak);
        assert_int_equal(weakest.unknown, 4);
        assert_true(weakest.ratio > 1e-11 && weakest.ratio < 2e-9);
        double *watched = numbers(s.pattern.values, sizeof(double));
        memcpy(watched, s.matrix.values, sizeof(double) * s.pattern.values);
        memcpy(s.matrix.values, s.fresh, sizeof(double) * s.pattern.values);
        assert_int_equal(dmb_block_sparse_factor(&s.pattern, &s.matrix), -1);
        assert_memory_equal(watched, s.matrix.values, sizeof(double) * s.pattern.values); /* same bits */
        free(watched);
        memset(s.size, 0, sizeof(uint32_t) * s.n);
        assert_int_equal(dmb_block_sparse_factor_watched(&s.pattern, &s.matrix, &weakest), -1);
        assert_true(isinf(weakest.ratio));
        free_system(&s);
    }
}

/* ---- Growth: entries, fill and work by count, not by clock ------------------------------------------------------- */
static dmb_block_pattern pattern_of(uint32_t n, uint32_t edge_count, const dmb_block_edge *edge)
{
    dmb_block_pattern pattern;
    uint32_t *capacity = numbers(n, sizeof *capacity);
    for (uint32_t i = 0; i < n; i++) capacity[i] = 6;
    assert_int_equal(dmb_block_pattern_make(&plain, n, capacity, edge_count, edge, &pattern), DMB_OK);
    free(capacity);
    return pattern;
}

/* kind 0: a chain; 1: two chains that meet at one end, as a branch does; 2: a ring; 3: a chain with an arc of twelve
 * blocks at every tenth. */
static uint32_t long_graph(int kind, uint32_t n, dmb_block_edge *edge)
{
    uint32_t count = 0;
    for (uint32_t i = 1; i < n; i++) edge[count++] = (dmb_block_edge){i, i - 1};
    if (kind == 1) edge[n / 2] = (dmb_block_edge){n / 2 + 1, 0};
    if (kind == 2) edge[count++] = (dmb_block_edge){0, n - 1};
    for (uint32_t i = 0; kind == 3 && i + 12 < n; i += 10) edge[count++] = (dmb_block_edge){i, i + 12};
    return count;
}

/* A chain costs 2 (6^3/3 + 6^3 + 6^3) = 1008 a block; with one further entry to carry along 2 (6^3/3 + 2 6^3 + 4 6^3).
 */
static void grows_linearly(void **state)
{
    (void)state;
    static const uint32_t lengths[] = {10, 100, 1000, 20000};
    static const double fill_per_block[] = {0.0, 0.0, 1.0, 1.0}, flops_per_block[] = {1008.0, 1008.0, 2736.0, 2736.0};
    dmb_block_edge *edge = numbers(2 * (size_t)20000, sizeof *edge);
    for (int l = 0; l < 4; l++)
        for (int kind = 0; kind < 4; kind++) {
            const uint32_t n = lengths[l], count = long_graph(kind, n, edge);
            dmb_block_pattern p = pattern_of(n, count, edge);
            assert_true(p.entries == count + p.fill);
            assert_true(p.fill <= fill_per_block[kind] * n);
            assert_true(p.flops <= flops_per_block[kind] * n);
            assert_true(p.values == 36 * ((size_t)n + 2 * (size_t)p.entries));
            assert_true(p.rows == 6 * (size_t)n);
            dmb_block_pattern_release(&p, &plain);
        }
    free(edge);
}

/* ---- The pattern itself ------------------------------------------------------------------------------------------ */
static void entries_and_offsets(void **state)
{
    (void)state;
    static block_system s;
    random_stream r = {70};
    for (size_t g = 0; g < GRAPH_COUNT; g++) {
        set_graph(&s, 30, graphs[g], &r);
        draw_capacities(&s, 1, &r);
        make_system(&s);
        unsigned char *taken = numbers(s.pattern.values, 1);
        uint32_t pairs = 0, coupled = 0;
        for (uint32_t a = 0; a < s.n; a++)
            for (uint32_t b = 0; b < s.n; b++) {
                const size_t offset = dmb_block_pattern_offset(&s.pattern, a, b),
                             length = s.capacity[a] * s.capacity[b];
                bool edge = false;
                for (uint32_t e = 0; e < s.edges; e++)
                    edge |= (s.edge[e].a == a && s.edge[e].b == b) || (s.edge[e].a == b && s.edge[e].b == a);
                assert_true(!edge || offset != DMB_BLOCK_NO_OFFSET);
                if (a == b)
                    assert_true(s.matrix.values + offset == dmb_block_sparse_diagonal(&s.pattern, &s.matrix, a));
                if (offset == DMB_BLOCK_NO_OFFSET) {
                    assert_null(entry_of(&s.pattern, &s.matrix, a, b));
                    continue;
                }
                assert_true(offset + length <= s.pattern.values);
                for (size_t k = 0; k < length; k++) assert_int_equal(taken[offset + k]++, 0); /* no overlap */
                pairs += a < b;
                coupled += a < b && edge;
            }
        assert_null(memchr(taken, 0, s.pattern.values)); /* no gaps */
        assert_int_equal(pairs, s.pattern.entries);
        assert_int_equal(pairs - coupled, s.pattern.fill);
        free(taken);
        free_system(&s);
    }
}

/* The order of elimination follows from the graph, however its edges are put. */
static void order_of_edges_plays_no_part(void **state)
{
    (void)state;
    static block_system s;
    random_stream r = {71};
    for (size_t g = 0; g < GRAPH_COUNT; g++) {
        set_graph(&s, 60, graphs[g], &r);
        dmb_block_pattern p = pattern_of(s.n, s.edges, s.edge);
        for (uint32_t e = s.edges; e > 1; e--) {
            const uint32_t f = below(&r, e);
            const dmb_block_edge t = s.edge[e - 1];
            s.edge[e - 1] = (dmb_block_edge){s.edge[f].b, s.edge[f].a};
            s.edge[f] = t;
        }
        const uint32_t once = s.edges;
        for (uint32_t e = 0; e < once; e += 3) couple(&s, s.edge[e].b, s.edge[e].a);
        dmb_block_pattern q = pattern_of(s.n, s.edges, s.edge);
        assert_int_equal(p.entries, q.entries);
        assert_memory_equal(p.order, q.order, sizeof(uint32_t) * s.n);
        assert_memory_equal(p.later, q.later, sizeof(uint32_t) * p.entries);
        dmb_block_pattern_release(&p, &plain);
        dmb_block_pattern_release(&q, &plain);
        free(s.capacity);
        free(s.size);
        free(s.row);
    }
}

static void refusals(void **state)
{
    (void)state;
    const dmb_block_edge edge[1] = {{0, 1}};
    uint32_t capacity[2] = {6, DMB_BLOCK_CAPACITY_MAX + 1};
    dmb_block_pattern p = {.n = 99}, none = {0};
    assert_int_equal(dmb_block_pattern_make(&plain, 2, capacity, 1, edge, &p), DMB_ERR_TOO_LARGE);
    assert_int_equal(dmb_block_pattern_make(&plain, UINT32_MAX, capacity, 1, edge, &p), DMB_ERR_TOO_LARGE);
    assert_int_equal(dmb_block_pattern_make(&plain, 2, capacity, UINT32_MAX, edge, &p), DMB_ERR_TOO_LARGE);
    assert_int_equal(p.n, 99);
    capacity[1] = DMB_BLOCK_CAPACITY_MAX;
    assert_int_equal(dmb_block_pattern_make(&plain, 2, capacity, 1, edge, &p), DMB_OK);
    assert_true(p.values == 36 + (size_t)DMB_BLOCK_CAPACITY_MAX * (DMB_BLOCK_CAPACITY_MAX + 12));
    dmb_block_pattern_release(&p, &plain);
    assert_null(p.block);
    dmb_block_pattern_release(&p, &plain);
    dmb_block_pattern_release(&none, &plain);
    assert_int_equal(dmb_block_pattern_make(&plain, 0, NULL, 0, NULL, &p), DMB_OK); /* nothing to solve */
    assert_true(p.values == 0 && p.rows == 0 && p.entries == 0);
    dmb_block_sparse empty = {NULL, NULL, NULL};
    assert_int_equal(dmb_block_sparse_factor(&p, &empty), -1);
    dmb_block_sparse_solve(&p, &empty, NULL, NULL);
    dmb_block_pattern_release(&p, &plain);
}

/* ---- Allocations that fail --------------------------------------------------------------------------------------- */
typedef struct meter {
    long until_failure, blocks, bytes; /* until_failure < 0: none fails */
} meter;

static void *take(void *context, size_t size, size_t alignment)
{
    meter *m = context;
    if (m->until_failure == 0) return NULL;
    m->until_failure--;
    m->blocks++;
    m->bytes += (long)size;
    return aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}

static void give(void *context, void *block, size_t size, size_t alignment)
{
    meter *m = context;
    (void)alignment;
    m->blocks--;
    m->bytes -= (long)size;
    free(block);
}

static void every_allocation_fails_once(void **state)
{
    (void)state;
    static block_system s;
    random_stream r = {72};
    meter m = {-1, 0, 0};
    dmb_allocator counting = dmb_allocator_default();
    counting.context = &m;
    counting.allocate = take;
    counting.release = give;
    set_graph(&s, 40, chain_with_arcs, &r);
    draw_capacities(&s, 1, &r);
    int32_t status = DMB_ERR_NO_MEMORY;
    long failures = 0;
    dmb_block_pattern pattern = {.n = 99};
    for (; status != DMB_OK; failures++) {
        m.until_failure = failures;
        assert_int_equal(pattern.n, 99);
        status = dmb_block_pattern_make(&counting, s.n, s.capacity, s.edges, s.edge, &pattern);
        assert_true(status == DMB_OK || status == DMB_ERR_NO_MEMORY);
        assert_int_equal(m.blocks, status == DMB_OK);
    }
    assert_true(failures > 3); /* both blocks and those of the order */
    dmb_block_pattern_release(&pattern, &counting);
    assert_int_equal(m.blocks, 0);
    assert_int_equal(m.bytes, 0);
    free(s.capacity);
    free(s.size);
    free(s.row);
}

/* Same bits: from run to run, wherever the arrays stand, and with a pattern made anew. */
static void repeats_bit_for_bit(void **state)
{
    (void)state;
    static block_system s;
    random_stream r = {74};
    for (size_t g = 0; g < GRAPH_COUNT; g++) {
        set_graph(&s, 40, graphs[g], &r);
        draw_capacities(&s, 1, &r);
        s.capacity[3] = 90;
        make_system(&s);
        draw_sizes(&s, 1, &r);
        draw_values(&s, false, &r);
        const size_t bytes = sizeof(double) * s.pattern.values;
        double *x = numbers(s.rows, sizeof(double)), *y = numbers(s.rows + 1, sizeof(double));
        double *moved = numbers(s.pattern.values + 1, sizeof(double)); /* off by half an SSE register */
        draw_vector(&r, (int)s.rows, x);
        memcpy(y + 1, x, sizeof(double) * s.rows);
        memcpy(moved + 1, s.fresh, bytes);
        assert_int_equal(dmb_block_sparse_factor(&s.pattern, &s.matrix), -1);
        dmb_block_sparse_solve(&s.pattern, &s.matrix, s.row, x);
        dmb_block_pattern_release(&s.pattern, &plain);
        assert_int_equal(dmb_block_pattern_make(&plain, s.n, s.capacity, s.edges, s.edge, &s.pattern), DMB_OK);
        dmb_block_sparse other = {moved + 1, s.matrix.pivot, s.size};
        assert_int_equal(dmb_block_sparse_factor(&s.pattern, &other), -1);
        dmb_block_sparse_solve(&s.pattern, &other, s.row, y + 1);
        assert_memory_equal(moved + 1, s.matrix.values, bytes);
        assert_memory_equal(y + 1, x, sizeof(double) * s.rows);
        free(x);
        free(y);
        free(moved);
        free_system(&s);
    }
}

static int set_up(void **state)
{
    (void)state;
    plain = dmb_allocator_default();
    return 0;
}

/* A x, and what solving with A makes of it again. */
static void multiplies(void **state)
{
    (void)state;
    static block_system s;
    random_stream r = {71};
    for (size_t g = 0; g < GRAPH_COUNT; g++)
        for (int kind = 0; kind < 3; kind++) {
            set_graph(&s, 30, graphs[g], &r);
            draw_capacities(&s, kind, &r);
            make_system(&s);
            draw_sizes(&s, kind, &r);
            draw_values(&s, false, &r);
            double *x = numbers(s.rows, sizeof(double)), *y = numbers(s.rows, sizeof(double));
            draw_vector(&r, (int)s.rows, x);
            memset(y, 1, s.rows * sizeof(double));
            dmb_block_sparse_multiply(&s.pattern, &s.matrix, s.row, x, y);
            assert_int_equal(dmb_block_sparse_factor(&s.pattern, &s.matrix), -1);
            dmb_block_sparse_solve(&s.pattern, &s.matrix, s.row, y);
            CHECK_BELOW(max_difference((int)s.rows, x, y), 1e-12);
            free(x);
            free(y);
            free_system(&s);
        }
}

static uint32_t negative_by_lapack(const block_system *s)
{
    const lapack_int N = (lapack_int)s->rows;
    dense_matrix dense = {s->rows, numbers((size_t)s->rows * s->rows, sizeof(double))};
    double *values = numbers(s->rows, sizeof(double));
    uint32_t negative = 0;
    for_each_value(s, put_dense, &dense);
    if (N > 0) assert_int_equal(LAPACKE_dsyev(LAPACK_ROW_MAJOR, 'N', 'U', N, dense.A, N, values), 0);
    for (uint32_t i = 0; i < s->rows; i++) negative += values[i] < 0.0;
    free(dense.A);
    free(values);
    return negative;
}

/* Symmetric matrices whose diagonal blocks have any sign: as many negative eigenvalues as LAPACK finds. */
static void counts_negative_eigenvalues(void **state)
{
    (void)state;
    static block_system s;
    static double room[12 * 12];
    random_stream r = {72};
    for (size_t g = 0; g < GRAPH_COUNT; g++)
        for (int t = 0; t < 30; t++) {
            set_graph(&s, 12, graphs[g], &r);
            shuffle_names(&s, &r);
            draw_capacities(&s, t % 3, &r);
            make_system(&s);
            draw_sizes(&s, t % 3, &r);
            draw_values(&s, true, &r);
            for (uint32_t i = 0; i < s.n; i++) {
                double *D = dmb_block_sparse_diagonal(&s.pattern, &s.matrix, i);
                const double factor = draw(&r) < 0.0 ? -0.3 : 0.3;
                for (uint32_t k = 0; k < s.size[i] * s.size[i]; k++) D[k] *= factor;
            }
            memcpy(s.fresh, s.matrix.values, sizeof(double) * s.pattern.values);
            assert_int_equal(dmb_block_sparse_factor(&s.pattern, &s.matrix), -1);
            assert_int_equal(dmb_block_sparse_negative(&s.pattern, &s.matrix, room), negative_by_lapack(&s));
            free_system(&s);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(agrees_with_lapack),
        cmocka_unit_test(multiplies),
        cmocka_unit_test(counts_negative_eigenvalues),
        cmocka_unit_test(agrees_with_cholmod),
        cmocka_unit_test(sizes_change_on_one_pattern),
        cmocka_unit_test(large_blocks),
        cmocka_unit_test(pivots_inside_blocks),
        cmocka_unit_test(scattered_right_hand_side),
        cmocka_unit_test(singular_block_is_reported),
        cmocka_unit_test(what_is_not_a_number_is_reported),
        cmocka_unit_test(weakest_pivot_is_found),
        cmocka_unit_test(grows_linearly),
        cmocka_unit_test(entries_and_offsets),
        cmocka_unit_test(order_of_edges_plays_no_part),
        cmocka_unit_test(refusals),
        cmocka_unit_test(every_allocation_fails_once),
        cmocka_unit_test(repeats_bit_for_bit),
    };
    return cmocka_run_group_tests(tests, set_up, NULL);
}
