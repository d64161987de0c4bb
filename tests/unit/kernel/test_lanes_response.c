/* Kernel of responses: a frequency gets the bits of the scalar factors (math/complex_sparse, which is held against
 * LAPACK) alone, in a group of any number, in any width; pivots are exchanged where one frequency of a group needs it;
 * a frequency without a pivot is marked and leaves the others alone. */
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "kernel/kernels.h"
#include "math/complex_sparse.h"

enum { BLOCKS = 7, ROWS = 6 * BLOCKS, NUMBERS = 36 * BLOCKS, SIDES = 3, PARTS = 2 * DMB_FREQUENCIES };

static const double eta = 0.03;

typedef struct chain {
    uint8_t size[BLOCKS], solved[ROWS];
    uint32_t row[BLOCKS + 1], diag[BLOCKS + 1], link[BLOCKS];
    dmb_block_layout layout;
    double M[3][NUMBERS], C[3][NUMBERS], K[3][NUMBERS]; /* diagonal, lower, upper */
    double omega[DMB_FREQUENCIES];
    double b[2][SIDES][ROWS]; /* of all frequencies; frequency l has (l + 1) times as much */
} chain;

static void draw_all(uint64_t *seed, double size, size_t n, double *x)
{
    for (size_t i = 0; i < n; i++) x[i] = draw_between(seed, -size, size);
}

/* Random blocks: pivots are exchanged in most columns, and not in the same ones at all frequencies. */
static void draw_chain(uint64_t *seed, const uint8_t *sizes, uint32_t period, chain *c)
{
    dmb_block_totals totals;
    memset(c, 0, sizeof *c);
    for (uint32_t i = 0; i < BLOCKS; i++) c->size[i] = sizes[i % period];
    assert_int_equal(dmb_block_count(BLOCKS, c->size, &totals), 0);
    dmb_block_fill(BLOCKS, c->size, c->row, c->diag, c->link);
    c->layout = (dmb_block_layout){BLOCKS, c->size, c->row, c->diag, c->link};
    for (int part = 0; part < 3; part++) {
        draw_all(seed, 1.0, NUMBERS, c->M[part]);
        draw_all(seed, 0.2, NUMBERS, c->C[part]);
        draw_all(seed, 4.0, NUMBERS, c->K[part]);
    }
    draw_all(seed, 1.0, sizeof c->b / sizeof(double), c->b[0][0]);
    memset(c->solved, 1, sizeof c->solved);
    for (int l = 0; l < DMB_FREQUENCIES; l++) c->omega[l] = 0.3 + 0.4 * l;
}

/* Row `k` of block i, not the last one, is supported: it and its column are zero, its right-hand side too. */
static void support(chain *c, uint32_t i, uint32_t k)
{
    const uint32_t n = c->size[i];
    double *const all[3] = {c->M[0], c->C[0], c->K[0]};
    double *const lower[3] = {c->M[1], c->C[1], c->K[1]}, *const upper[3] = {c->M[2], c->C[2], c->K[2]};
    for (int m = 0; m < 3; m++) {
        for (uint32_t j = 0; j < n; j++) all[m][c->diag[i] + n * k + j] = all[m][c->diag[i] + n * j + k] = 0.0;
        for (uint32_t j = 0; j < c->size[i + 1]; j++)
            upper[m][c->link[i] + c->size[i + 1] * k + j] = lower[m][c->link[i] + n * j + k] = 0.0;
        for (uint32_t j = 0; i > 0 && j < c->size[i - 1]; j++)
            upper[m][c->link[i - 1] + n * j + k] = lower[m][c->link[i - 1] + c->size[i - 1] * k + j] = 0.0;
    }
    for (int s = 0; s < SIDES; s++) c->b[0][s][c->row[i] + k] = c->b[1][s][c->row[i] + k] = 0.0;
    c->solved[c->row[i] + k] = 0;
}

/* ---- Both ways --------------------------------------------------------------------------------------------------- */

/* By scalar factors. Returns 0 where there are none. */
static int solve_alone(const chain *c, int l, double x[2][SIDES][ROWS])
{
    static double A[3][2][NUMBERS];
    static uint32_t pivot[ROWS];
    const double w = c->omega[l], w2 = w * w;
    for (int part = 0; part < 3; part++)
        for (int e = 0; e < NUMBERS; e++) {
            A[part][0][e] = c->K[part][e] - w2 * c->M[part][e];
            A[part][1][e] = w * c->C[part][e] + eta * c->K[part][e];
        }
    for (uint32_t i = 0; i < BLOCKS; i++)
        for (uint32_t k = 0; k < c->size[i]; k++)
            if (!c->solved[c->row[i] + k]) A[0][0][c->diag[i] + (c->size[i] + 1u) * k] = 1.0;
    const dmb_complex_block_matrix matrix = {{A[0][0], A[0][1]}, {A[1][0], A[1][1]}, {A[2][0], A[2][1]}, pivot};
    if (dmb_complex_block_factor(&c->layout, &matrix, 0, BLOCKS) >= 0) return 0;
    for (int s = 0; s < SIDES; s++) {
        for (int part = 0; part < 2; part++)
            for (int r = 0; r < ROWS; r++) x[part][s][r] = (l + 1) * c->b[part][s][r];
        dmb_complex_block_solve(&c->layout, &matrix, 0, BLOCKS, (dmb_complex_array){x[0][s], x[1][s]});
    }
    return 1;
}

typedef struct solution {
    double sides[ROWS][SIDES + 1][2][DMB_FREQUENCIES];
} solution;

/* Frequencies from .. from + used - 1 as a group; room for one more right-hand side, which must stay. */
static uint32_t solve_group(uint32_t lanes, const chain *c, uint32_t from, uint32_t used, solution *out)
{
    static double work[NUMBERS * PARTS];
    dmb_response_args args = {.count = BLOCKS,
                              .used = used,
                              .columns = SIDES,
                              .stride = SIDES + 1,
                              .layout = &c->layout,
                              .diagonal = {c->M[0], c->C[0], c->K[0]},
                              .lower = {c->M[1], c->C[1], c->K[1]},
                              .upper = {c->M[2], c->C[2], c->K[2]},
                              .solved = c->solved,
                              .structural_damping = eta,
                              .sides = out->sides[0][0][0],
                              .work = work};
    memset(out, 0, sizeof *out);
    for (uint32_t l = 0; l < DMB_FREQUENCIES; l++) {
        const uint32_t at = from + (l < used ? l : used - 1);
        args.omega[l] = c->omega[at];
        for (int r = 0; r < ROWS; r++)
            for (int s = 0; s <= SIDES; s++)
                for (int part = 0; part < 2; part++)
                    out->sides[r][s][part][l] = s == SIDES ? 77.0 : (at + 1) * c->b[part][s][r];
    }
    dmb_kernels_of(lanes)->responses(&args);
    return args.bad;
}

/* Entries of frequency `l` in place `lane` that differ from scalar ones, or of the free room that changed. */
static int differences(const chain *c, const solution *group, uint32_t lane, int l)
{
    static double x[2][SIDES][ROWS];
    int count = 0;
    if (!solve_alone(c, l, x)) return ROWS;
    for (uint32_t r = 0; r < c->row[BLOCKS]; r++)
        for (int part = 0; part < 2; part++) {
            count += group->sides[r][SIDES][part][lane] != 77.0;
            for (int s = 0; s < SIDES; s++)
                count += memcmp(&group->sides[r][s][part][lane], &x[part][s][r], sizeof(double)) != 0;
        }
    return count;
}

static void same_bits(const chain *c)
{
    static solution out;
    for (uint32_t lanes = 1; lanes <= 8; lanes *= 2) {
        if (!dmb_kernels_of(lanes)) continue;
        for (uint32_t used = 1; used <= DMB_FREQUENCIES; used++)
            for (uint32_t from = 0; from + used <= DMB_FREQUENCIES; from += 3) {
                assert_int_equal(solve_group(lanes, c, from, used, &out), 0);
                for (uint32_t l = 0; l < used; l++) assert_int_equal(differences(c, &out, l, (int)(from + l)), 0);
            }
    }
}

/* ---- Tests ------------------------------------------------------------------------------------------------------- */

static void a_group_gives_the_bits_of_one(void **state)
{
    (void)state;
    static chain c;
    static const uint8_t six[1] = {6}, two[1] = {2}, mixed[5] = {6, 6, 2, 2, 3};
    uint64_t seed = 5;
    for (int i = 0; i < 8; i++) {
        draw_chain(&seed, six, 1, &c);
        same_bits(&c);
        support(&c, 0, 3);
        support(&c, 4, 0);
        same_bits(&c);
        draw_chain(&seed, two, 1, &c);
        same_bits(&c);
        draw_chain(&seed, mixed, 5, &c);
        same_bits(&c);
    }
}

/* Rows 0 and 1 of a block: at low frequency the first has the pivot, at high frequency the second, and equal ones at
 * w = 1.5 take the first. */
static void exchanges_rows_of_some_frequencies(void **state)
{
    (void)state;
    static chain c;
    static const uint8_t six[1] = {6};
    uint64_t seed = 9;
    draw_chain(&seed, six, 1, &c);
    double *M = c.M[0], *C = c.C[0], *K = c.K[0];
    for (int k = 0; k < 6; k++) M[6 * k] = C[6 * k] = K[6 * k] = 0.0;
    K[0] = 2.25 * 3.0;
    M[6] = 3.0 * (1.0 + eta); /* w^2 M_10 = (1 + eta) K_00 */
    c.omega[3] = 1.5;
    same_bits(&c);
}

/* K - w^2 M = 0 in an uncoupled row at the fourth frequency; nearly so at the sixth: of rounding size. */
static void marks_frequencies_without_pivots(void **state)
{
    (void)state;
    static chain c;
    static solution out;
    static const uint8_t six[1] = {6};
    uint64_t seed = 11;
    draw_chain(&seed, six, 1, &c);
    support(&c, 2, 4);
    support(&c, 1, 2);
    c.solved[c.row[2] + 4] = c.solved[c.row[1] + 2] = 1;
    const uint32_t a = c.diag[2] + 7u * 4u, b = c.diag[1] + 7u * 2u;
    c.M[0][a] = c.M[0][b] = 1.0;
    c.K[0][a] = c.omega[3] * c.omega[3];
    c.K[0][b] = c.omega[5] * c.omega[5] * (1.0 + 1e-15);
    c.C[0][a] = -eta * c.K[0][a] / c.omega[3];
    c.C[0][b] = -eta * c.K[0][b] / c.omega[5];
    for (uint32_t lanes = 1; lanes <= 8; lanes *= 2) {
        if (!dmb_kernels_of(lanes)) continue;
        assert_int_equal(solve_group(lanes, &c, 0, DMB_FREQUENCIES, &out), 1u << 3 | 1u << 5);
        for (int l = 0; l < DMB_FREQUENCIES; l++)
            if (l != 3 && l != 5) assert_int_equal(differences(&c, &out, (uint32_t)l, l), 0);
        assert_int_equal(solve_group(lanes, &c, 0, 3, &out), 0);
        assert_int_equal(solve_group(lanes, &c, 3, 1, &out), 1);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_group_gives_the_bits_of_one),
                                       cmocka_unit_test(exchanges_rows_of_some_frequencies),
                                       cmocka_unit_test(marks_frequencies_without_pivots)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
