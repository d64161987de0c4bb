/* Complex block-tridiagonal solver against LAPACK (zgesv), pivoting, singular systems, ranges. */
#include "math_test.h"

#include <lapacke.h>

#include "math/complex_sparse.h"

#define BLOCKS_MAX 40
#define ROWS_MAX (BLOCKS_MAX * DMB_BLOCK_SIZE_MAX)
#define STORAGE (36 * BLOCKS_MAX)

typedef struct complex_system {
    uint8_t size[BLOCKS_MAX];
    uint32_t pivot[ROWS_MAX], row[BLOCKS_MAX + 1], diag[BLOCKS_MAX + 1], link[BLOCKS_MAX];
    double diagonal[2][STORAGE], lower[2][STORAGE], upper[2][STORAGE];
    dmb_block_layout layout;
} complex_system;

static dmb_complex_array both(double (*parts)[STORAGE])
{
    const dmb_complex_array array = {parts[0], parts[1]};
    return array;
}

static dmb_complex_block_matrix matrix_of(complex_system *s)
{
    const dmb_complex_block_matrix matrix = {both(s->diagonal), both(s->lower), both(s->upper), s->pivot};
    return matrix;
}

static void lay_out(complex_system *s, uint32_t n, const uint8_t *sizes, uint32_t period)
{
    dmb_block_totals totals;
    for (uint32_t i = 0; i < n; i++) s->size[i] = sizes[i % period];
    assert_int_equal(dmb_block_count(n, s->size, &totals), 0);
    dmb_block_fill(n, s->size, s->row, s->diag, s->link);
    s->layout = (dmb_block_layout){n, s->size, s->row, s->diag, s->link};
}

/* Random blocks; `weight` shifted off the diagonal by `turn` rows, so that only pivoting finds it. */
static void fill(complex_system *s, random_stream *r, double weight, uint32_t turn)
{
    for (int part = 0; part < 2; part++) {
        draw_vector(r, STORAGE, s->diagonal[part]);
        draw_vector(r, STORAGE, s->lower[part]);
        draw_vector(r, STORAGE, s->upper[part]);
    }
    for (uint32_t i = 0; i < s->layout.n; i++) {
        const uint32_t n = s->size[i];
        for (uint32_t k = 0; k < n; k++) s->diagonal[k % 2][s->diag[i] + n * ((k + turn) % n) + k] += weight;
    }
}

static lapack_complex_double number(double (*parts)[STORAGE], uint32_t at)
{
    return lapack_make_complex_double(parts[0][at], parts[1][at]);
}

static void to_dense(complex_system *s, uint32_t first, uint32_t count, uint32_t N, lapack_complex_double *A)
{
    memset(A, 0, sizeof *A * N * N);
    for (uint32_t i = first; i < first + count; i++) {
        const uint32_t n = s->size[i], at = s->row[i] - s->row[first];
        for (uint32_t p = 0; p < n; p++)
            for (uint32_t q = 0; q < n; q++) A[N * (at + p) + at + q] = number(s->diagonal, s->diag[i] + n * p + q);
        if (i + 1 == first + count) break;
        const uint32_t m = s->size[i + 1], next = at + n;
        for (uint32_t p = 0; p < n; p++)
            for (uint32_t q = 0; q < m; q++) {
                A[N * (at + p) + next + q] = number(s->upper, s->link[i] + m * p + q);
                A[N * (next + q) + at + p] = number(s->lower, s->link[i] + n * q + p);
            }
    }
}

/* Largest difference from LAPACK's solution over its largest entry, in the rows of the range; others must stay. */
static double compare(complex_system *s, uint32_t first, uint32_t count, random_stream *r)
{
    static lapack_complex_double A[ROWS_MAX * ROWS_MAX], z[ROWS_MAX];
    static lapack_int exchanged[ROWS_MAX];
    static double x[2][ROWS_MAX], b[2][ROWS_MAX];
    const uint32_t begin = s->row[first], N = s->row[first + count] - begin, all = s->row[s->layout.n];
    const dmb_complex_block_matrix matrix = matrix_of(s);
    const dmb_complex_array rhs = {x[0], x[1]};
    double worst = 0.0, largest = 0.0;
    for (int part = 0; part < 2; part++) draw_vector(r, (int)all, b[part]);
    memcpy(x, b, sizeof x);
    for (uint32_t i = 0; i < N; i++) z[i] = lapack_make_complex_double(b[0][begin + i], b[1][begin + i]);
    to_dense(s, first, count, N, A);
    assert_int_equal(LAPACKE_zgesv(LAPACK_ROW_MAJOR, (lapack_int)N, 1, A, (lapack_int)N, exchanged, z, 1), 0);
    assert_int_equal(dmb_complex_block_factor(&s->layout, &matrix, first, count), -1);
    dmb_complex_block_solve(&s->layout, &matrix, first, count, rhs);
    for (uint32_t i = 0; i < N; i++) {
        const double re = lapack_complex_double_real(z[i]), im = lapack_complex_double_imag(z[i]);
        worst = fmax(worst, hypot(x[0][begin + i] - re, x[1][begin + i] - im));
        largest = fmax(largest, hypot(re, im));
    }
    for (uint32_t i = 0; i < all; i++)
        if (i < begin || i >= begin + N) assert_true(x[0][i] == b[0][i] && x[1][i] == b[1][i]);
    return worst / largest;
}

static void agrees_with_lapack(void **state)
{
    (void)state;
    static complex_system s;
    static const uint8_t six[1] = {6}, two[1] = {2}, mixed[5] = {6, 6, 2, 2, 3};
    const uint8_t *const sizes[3] = {six, two, mixed};
    const uint32_t periods[3] = {1, 1, 5};
    random_stream r = {61};
    for (int kind = 0; kind < 3; kind++) {
        double worst = 0.0;
        for (uint32_t n = 1; n <= BLOCKS_MAX; n += 13)
            for (uint32_t turn = 0; turn < 3; turn++) {
                lay_out(&s, n, sizes[kind], periods[kind]);
                fill(&s, &r, 8.0, turn);
                worst = fmax(worst, compare(&s, 0, n, &r));
            }
        print_message("blocks of kind %d: largest difference from zgesv %.2e of the solution\n", kind, worst);
        CHECK_BELOW(worst, 2e-14);
    }
}

static void chains_in_one_layout(void **state)
{
    (void)state;
    static complex_system s;
    static const uint8_t mixed[3] = {6, 6, 2};
    random_stream r = {62};
    lay_out(&s, 20, mixed, 3);
    fill(&s, &r, 8.0, 1);
    CHECK_BELOW(compare(&s, 0, 7, &r), 2e-14);
    CHECK_BELOW(compare(&s, 7, 1, &r), 2e-14);
    CHECK_BELOW(compare(&s, 8, 12, &r), 2e-14);
}

/* A column without a pivot, and what is not a number, are found in their block. */
static void singular_blocks_are_named(void **state)
{
    (void)state;
    static complex_system s;
    static const uint8_t six[1] = {6};
    random_stream r = {63};
    for (int kind = 0; kind < 3; kind++) {
        lay_out(&s, 9, six, 1);
        fill(&s, &r, 8.0, 0);
        for (int part = 0; part < 2; part++) {
            memset(s.lower[part] + s.link[4], 0, 36 * sizeof(double));
            for (uint32_t p = 0; p < 6; p++) s.diagonal[part][s.diag[5] + 6 * p + 4] = 0.0;
        }
        if (kind > 0) s.diagonal[kind - 1][s.diag[5] + 6 * 2 + 4] = (double)NAN;
        const dmb_complex_block_matrix matrix = matrix_of(&s);
        assert_int_equal(dmb_complex_block_factor(&s.layout, &matrix, 0, 9), 5);
    }
}

/* Squares of these numbers overflow and underflow; their quotients do not. */
static void extreme_pivots(void **state)
{
    (void)state;
    static complex_system s;
    static const uint8_t one[1] = {1};
    const double sizes[2] = {1e-200, 1e200};
    for (int i = 0; i < 2; i++) {
        double x[2] = {3.0 * sizes[i], -1.0 * sizes[i]};
        lay_out(&s, 1, one, 1);
        s.diagonal[0][0] = 1.0 * sizes[i];
        s.diagonal[1][0] = 2.0 * sizes[i];
        const dmb_complex_block_matrix matrix = matrix_of(&s);
        assert_int_equal(dmb_complex_block_factor(&s.layout, &matrix, 0, 1), -1);
        dmb_complex_block_solve(&s.layout, &matrix, 0, 1, (dmb_complex_array){x, x + 1});
        CHECK_CLOSE(x[0], 0.2, 1e-15); /* (3 - i)/(1 + 2i) = (1 - 7i)/5 */
        CHECK_CLOSE(x[1], -1.4, 1e-15);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(agrees_with_lapack),
        cmocka_unit_test(chains_in_one_layout),
        cmocka_unit_test(singular_blocks_are_named),
        cmocka_unit_test(extreme_pivots),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
