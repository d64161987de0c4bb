/* Complex block-sparse solver against LAPACK (zgesv): chains, arcs, stars, trees; blocks of all sizes, 0 too;
 * pivots off the diagonal; singular blocks; the same bits twice. */
#include "math_test.h"

#include <lapacke.h>
#include <stdlib.h>

#include "base/memory.h"
#include "math/complex_sparse.h"

enum { BLOCKS = 24, CAPACITY = 9, ROWS_MAX = BLOCKS * CAPACITY };

typedef struct sparse_system {
    uint32_t n, edges, rows;
    dmb_block_edge edge[4 * BLOCKS];
    uint32_t capacity[BLOCKS], size[BLOCKS], row[BLOCKS], pivot[ROWS_MAX];
    dmb_block_pattern pattern;
    dmb_complex_sparse matrix;
    double *re, *im;
} sparse_system;

static uint32_t below(random_stream *r, uint32_t bound)
{
    return (uint32_t)((0.5 * draw(r) + 0.5) * bound) % bound;
}

static void couple(sparse_system *s, uint32_t a, uint32_t b)
{
    s->edge[s->edges++] = (dmb_block_edge){a, b};
}

static void couple_all(sparse_system *s, int graph, random_stream *r)
{
    for (uint32_t i = 1; i < s->n; i++) {
        if (graph <= 1) couple(s, i - 1, i);
        if (graph == 2) couple(s, 0, i);
        if (graph == 3) couple(s, below(r, i), i);
    }
    for (uint32_t i = 0; graph == 1 && i < 6; i++) couple(s, below(r, s->n), below(r, s->n));
}

static void open(sparse_system *s, int graph, int sixes, random_stream *r)
{
    const dmb_allocator plain = dmb_allocator_default();
    memset(s, 0, sizeof *s);
    s->n = BLOCKS;
    couple_all(s, graph, r);
    for (uint32_t i = 0; i < s->n; i++) {
        s->capacity[i] = CAPACITY;
        s->size[i] = sixes ? 6 : below(r, CAPACITY + 1);
        s->row[i] = s->rows;
        s->rows += s->size[i];
    }
    assert_int_equal(dmb_block_pattern_make(&plain, s->n, s->capacity, s->edges, s->edge, &s->pattern), DMB_OK);
    s->re = calloc(s->pattern.values + 1, sizeof(double));
    s->im = calloc(s->pattern.values + 1, sizeof(double));
    assert_true(s->re != NULL && s->im != NULL);
    s->matrix = (dmb_complex_sparse){{s->re, s->im}, s->pivot, s->size};
}

static void shut(sparse_system *s)
{
    const dmb_allocator plain = dmb_allocator_default();
    dmb_block_pattern_release(&s->pattern, &plain);
    free(s->re);
    free(s->im);
}

/* Random numbers in block (i, j), and a weight `turn` rows off the diagonal, where only pivoting finds it. */
static void fill_block(sparse_system *s, random_stream *r, uint32_t i, uint32_t j, uint32_t turn,
                       lapack_complex_double *A)
{
    const size_t offset = dmb_block_pattern_offset(&s->pattern, i, j);
    for (uint32_t p = 0; p < s->size[i]; p++)
        for (uint32_t q = 0; q < s->size[j]; q++) {
            const size_t at = offset + (size_t)s->size[j] * p + q;
            s->re[at] = draw(r) + (i == j && p == (q + turn) % s->size[i] ? 12.0 : 0.0);
            s->im[at] = draw(r);
            A[s->rows * (s->row[i] + p) + s->row[j] + q] = lapack_make_complex_double(s->re[at], s->im[at]);
        }
}

static void fill(sparse_system *s, random_stream *r, uint32_t turn, lapack_complex_double *A)
{
    memset(A, 0, sizeof *A * s->rows * s->rows);
    memset(s->re, 0, s->pattern.values * sizeof(double));
    memset(s->im, 0, s->pattern.values * sizeof(double));
    for (uint32_t i = 0; i < s->n; i++) fill_block(s, r, i, i, turn, A);
    for (uint32_t e = 0; e < s->edges; e++) {
        if (s->edge[e].a == s->edge[e].b) continue;
        fill_block(s, r, s->edge[e].a, s->edge[e].b, 0, A);
        fill_block(s, r, s->edge[e].b, s->edge[e].a, 0, A);
    }
}

static double difference(sparse_system *s, random_stream *r, uint32_t turn)
{
    static lapack_complex_double A[ROWS_MAX * ROWS_MAX], z[ROWS_MAX];
    static lapack_int exchanged[ROWS_MAX];
    double x[2][ROWS_MAX], worst = 0.0, largest = 0.0;
    const lapack_int n = (lapack_int)s->rows;
    fill(s, r, turn, A);
    for (int k = 0; k < 2; k++) draw_vector(r, (int)s->rows, x[k]);
    for (uint32_t i = 0; i < s->rows; i++) z[i] = lapack_make_complex_double(x[0][i], x[1][i]);
    assert_int_equal(LAPACKE_zgesv(LAPACK_ROW_MAJOR, n, 1, A, n, exchanged, z, 1), 0);
    assert_int_equal(dmb_complex_sparse_factor(&s->pattern, &s->matrix), -1);
    dmb_complex_sparse_solve(&s->pattern, &s->matrix, s->row, (dmb_complex_array){x[0], x[1]});
    for (uint32_t i = 0; i < s->rows; i++) {
        const double re = lapack_complex_double_real(z[i]), im = lapack_complex_double_imag(z[i]);
        worst = fmax(worst, hypot(x[0][i] - re, x[1][i] - im));
        largest = fmax(largest, hypot(re, im));
    }
    return worst / largest;
}

static void agrees_with_lapack(void **state)
{
    (void)state;
    static sparse_system s;
    random_stream r = {71};
    for (int graph = 0; graph < 4; graph++) {
        static const char *const names[4] = {"chain", "chain with arcs", "star", "tree"};
        double worst = 0.0;
        for (int sixes = 0; sixes < 2; sixes++)
            for (uint32_t turn = 0; turn < 3; turn++) {
                open(&s, graph, sixes, &r);
                worst = fmax(worst, difference(&s, &r, turn));
                shut(&s);
            }
        print_message("%s: largest difference from zgesv %.2e of the solution\n", names[graph], worst);
        CHECK_BELOW(worst, 2e-14);
    }
}

static void singular_blocks_are_named(void **state)
{
    (void)state;
    static sparse_system s;
    static lapack_complex_double A[ROWS_MAX * ROWS_MAX];
    random_stream r = {72};
    open(&s, 0, 1, &r);
    fill(&s, &r, 0, A);
    const uint32_t first = s.pattern.order[0];
    for (uint32_t p = 0; p < 6; p++) {
        const size_t at = dmb_block_pattern_offset(&s.pattern, first, first) + 6 * (size_t)p + 4;
        s.re[at] = s.im[at] = 0.0;
    }
    assert_int_equal(dmb_complex_sparse_factor(&s.pattern, &s.matrix), first);
    fill(&s, &r, 0, A);
    s.im[dmb_block_pattern_offset(&s.pattern, 7, 7)] = (double)NAN;
    assert_true(dmb_complex_sparse_factor(&s.pattern, &s.matrix) >= 0);
    shut(&s);
}

static void same_bits_twice(void **state)
{
    (void)state;
    static sparse_system s, t;
    random_stream r = {73}, same = {73};
    open(&s, 1, 0, &r);
    open(&t, 1, 0, &same);
    assert_true(difference(&s, &r, 1) == difference(&t, &same, 1));
    assert_memory_equal(s.re, t.re, s.pattern.values * sizeof(double));
    assert_memory_equal(s.im, t.im, s.pattern.values * sizeof(double));
    shut(&s);
    shut(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(agrees_with_lapack),
        cmocka_unit_test(singular_blocks_are_named),
        cmocka_unit_test(same_bits_twice),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
