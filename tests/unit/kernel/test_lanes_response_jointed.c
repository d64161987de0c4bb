/* Kernel of responses of jointed chains: a frequency gets the bits of the scalar factors (math/complex_sparse, which is
 * held against LAPACK) alone, in a group of any number, in any width, for chains, arcs, stars and trees of blocks of
 * all sizes, 0 too; pivots are exchanged where one frequency of a group needs it; a frequency without a pivot is marked
 * and leaves the others alone. */
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "kernel/kernels.h"
#include "math/complex_sparse.h"

enum { BLOCKS = 9, CAPACITY = 14, ROWS_MAX = BLOCKS * CAPACITY, SIDES = 3, PARTS = 2 * DMB_FREQUENCIES };
enum { CHAIN, ARCS, STAR, TREE, GRAPHS };

static const double eta = 0.03;

typedef struct jointed {
    uint32_t rows, edges, capacity[BLOCKS], size[BLOCKS], row[BLOCKS], pivot[ROWS_MAX];
    dmb_block_edge edge[2 * BLOCKS];
    dmb_block_pattern pattern;
    double *M, *C, *K, *re, *im, *work;
    double stiffness[ROWS_MAX], mass[ROWS_MAX], omega[DMB_FREQUENCIES], b[2][SIDES][ROWS_MAX];
} jointed;

static uint32_t below(uint64_t *seed, uint32_t bound)
{
    return (uint32_t)draw_between(seed, 0.0, bound) % bound;
}

static void couple_all(jointed *c, uint64_t *seed, int graph)
{
    for (uint32_t i = 1; i < BLOCKS; i++)
        c->edge[c->edges++] = (dmb_block_edge){graph == STAR ? 0 : graph == TREE ? below(seed, i) : i - 1, i};
    if (graph == ARCS)
        for (uint32_t i = 2; i < BLOCKS; i += 3) c->edge[c->edges++] = (dmb_block_edge){0, i};
}

static double *numbers(size_t count)
{
    double *made = aligned_alloc(64, (count * sizeof(double) + 63) / 64 * 64);
    assert_non_null(made);
    memset(made, 0, count * sizeof(double));
    return made;
}

/* Random values in the blocks that are coupled: pivots are exchanged in most columns, and not in the same ones at all
 * frequencies. */
static void fill_block(jointed *c, uint64_t *seed, uint32_t i, uint32_t j)
{
    const size_t offset = dmb_block_pattern_offset(&c->pattern, i, j);
    for (size_t e = offset; e < offset + (size_t)c->size[i] * c->size[j]; e++) {
        c->M[e] = draw_between(seed, -1.0, 1.0);
        c->C[e] = draw_between(seed, -0.2, 0.2);
        c->K[e] = draw_between(seed, -4.0, 4.0);
    }
}

static void fill_all(jointed *c, uint64_t *seed)
{
    for (uint32_t i = 0; i < BLOCKS; i++) fill_block(c, seed, i, i);
    for (uint32_t e = 0; e < c->edges; e++) {
        fill_block(c, seed, c->edge[e].a, c->edge[e].b);
        fill_block(c, seed, c->edge[e].b, c->edge[e].a);
    }
    for (uint32_t r = 0; r < ROWS_MAX; r++) c->stiffness[r] = c->mass[r] = 1.0;
    for (int part = 0; part < 2; part++)
        for (int s = 0; s < SIDES; s++)
            for (int r = 0; r < ROWS_MAX; r++) c->b[part][s][r] = draw_between(seed, -1.0, 1.0);
    for (int l = 0; l < DMB_FREQUENCIES; l++) c->omega[l] = 0.3 + 0.4 * l;
}

static void open(jointed *c, uint64_t *seed, int graph, int sixes)
{
    const dmb_allocator plain = dmb_allocator_default();
    memset(c, 0, sizeof *c);
    couple_all(c, seed, graph);
    for (uint32_t i = 0; i < BLOCKS; i++) {
        c->capacity[i] = CAPACITY;
        c->size[i] = sixes ? 6 : below(seed, CAPACITY + 1);
        c->row[i] = c->rows;
        c->rows += c->size[i];
    }
    assert_int_equal(dmb_block_pattern_make(&plain, BLOCKS, c->capacity, c->edges, c->edge, &c->pattern), DMB_OK);
    double **const all[5] = {&c->M, &c->C, &c->K, &c->re, &c->im};
    for (int i = 0; i < 5; i++) *all[i] = numbers(c->pattern.values);
    c->work = numbers((c->pattern.values + CAPACITY) * PARTS);
    fill_all(c, seed);
}

static void shut(jointed *c)
{
    const dmb_allocator plain = dmb_allocator_default();
    dmb_block_pattern_release(&c->pattern, &plain);
    double *const all[6] = {c->M, c->C, c->K, c->re, c->im, c->work};
    for (int i = 0; i < 6; i++) free(all[i]);
}

/* ---- Both ways --------------------------------------------------------------------------------------------------- */

/* By scalar factors. Returns 0 where there are none. */
static int solve_alone(jointed *c, int l, double x[2][SIDES][ROWS_MAX])
{
    const dmb_complex_sparse matrix = {{c->re, c->im}, c->pivot, c->size};
    const double w = c->omega[l], w2 = w * w;
    for (size_t e = 0; e < c->pattern.values; e++) {
        c->re[e] = c->K[e] - w2 * c->M[e];
        c->im[e] = w * c->C[e] + eta * c->K[e];
    }
    if (dmb_complex_sparse_factor(&c->pattern, &matrix) >= 0) return 0;
    for (int s = 0; s < SIDES; s++) {
        for (int part = 0; part < 2; part++)
            for (uint32_t r = 0; r < c->rows; r++) x[part][s][r] = (l + 1) * c->b[part][s][r];
        dmb_complex_sparse_solve(&c->pattern, &matrix, c->row, (dmb_complex_array){x[0][s], x[1][s]});
    }
    return 1;
}

typedef struct solution {
    double sides[ROWS_MAX][SIDES + 1][2][DMB_FREQUENCIES];
} solution;

/* Frequencies from .. from + used - 1 as a group; room for one more right-hand side, which must stay. */
static uint32_t solve_group(uint32_t lanes, jointed *c, uint32_t from, uint32_t used, solution *out)
{
    dmb_jointed_response_args args = {.used = used,
                                      .columns = SIDES,
                                      .stride = SIDES + 1,
                                      .pattern = &c->pattern,
                                      .size = c->size,
                                      .row = c->row,
                                      .blocks = {c->M, c->C, c->K},
                                      .stiffness = c->stiffness,
                                      .mass = c->mass,
                                      .structural_damping = eta,
                                      .sides = out->sides[0][0][0],
                                      .work = c->work};
    memset(out, 0, sizeof *out);
    for (uint32_t l = 0; l < DMB_FREQUENCIES; l++) {
        const uint32_t at = from + (l < used ? l : used - 1);
        args.omega[l] = c->omega[at];
        for (uint32_t r = 0; r < c->rows; r++)
            for (int s = 0; s <= SIDES; s++)
                for (int part = 0; part < 2; part++)
                    out->sides[r][s][part][l] = s == SIDES ? 77.0 : (at + 1) * c->b[part][s][r];
    }
    dmb_kernels_of(lanes)->jointed_responses(&args);
    return args.bad;
}

/* Entries of frequency `l` in place `lane` that differ from scalar ones, or of the free room that changed. */
static int differences(jointed *c, const solution *group, uint32_t lane, int l)
{
    static double x[2][SIDES][ROWS_MAX];
    int count = 0;
    if (!solve_alone(c, l, x)) return ROWS_MAX;
    for (uint32_t r = 0; r < c->rows; r++)
        for (int part = 0; part < 2; part++) {
            count += group->sides[r][SIDES][part][lane] != 77.0;
            for (int s = 0; s < SIDES; s++)
                count += memcmp(&group->sides[r][s][part][lane], &x[part][s][r], sizeof(double)) != 0;
        }
    return count;
}

static void same_bits(jointed *c)
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
    static jointed c;
    uint64_t seed = 5;
    for (int i = 0; i < 3; i++)
        for (int graph = 0; graph < GRAPHS; graph++)
            for (int sixes = 0; sixes < 2; sixes++) {
                open(&c, &seed, graph, sixes);
                same_bits(&c);
                shut(&c);
            }
}

/* An uncoupled row and column of a block with K - w^2 M = 0 at one frequency, exactly or but for rounding. */
static void uncouple(jointed *c, uint32_t block, uint32_t k, uint32_t frequency, double off)
{
    const uint32_t n = c->size[block];
    const double w = c->omega[frequency];
    for (uint32_t j = 0; j < BLOCKS; j++) {
        const size_t row = dmb_block_pattern_offset(&c->pattern, block, j), m = c->size[j];
        const size_t column = dmb_block_pattern_offset(&c->pattern, j, block);
        if (row == DMB_BLOCK_NO_OFFSET) continue;
        for (size_t q = 0; q < m; q++) {
            c->M[row + m * k + q] = c->C[row + m * k + q] = c->K[row + m * k + q] = 0.0;
            c->M[column + n * q + k] = c->C[column + n * q + k] = c->K[column + n * q + k] = 0.0;
        }
    }
    const size_t at = dmb_block_pattern_offset(&c->pattern, block, block) + (n + (size_t)1) * k;
    c->M[at] = 1.0;
    c->K[at] = w * w * (1.0 + off);
    c->C[at] = -eta * c->K[at] / w;
}

static void marks_frequencies_without_pivots(void **state)
{
    (void)state;
    static jointed c;
    static solution out;
    uint64_t seed = 11;
    open(&c, &seed, ARCS, 1);
    uncouple(&c, 2, 4, 3, 0.0);
    uncouple(&c, 1, 2, 5, 1e-15);
    for (uint32_t lanes = 1; lanes <= 8; lanes *= 2) {
        if (!dmb_kernels_of(lanes)) continue;
        assert_int_equal(solve_group(lanes, &c, 0, DMB_FREQUENCIES, &out), 1u << 3 | 1u << 5);
        for (int l = 0; l < DMB_FREQUENCIES; l++)
            if (l != 3 && l != 5) assert_int_equal(differences(&c, &out, (uint32_t)l, l), 0);
        assert_int_equal(solve_group(lanes, &c, 0, 3, &out), 0);
        assert_int_equal(solve_group(lanes, &c, 3, 1, &out), 1);
    }
    shut(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_group_gives_the_bits_of_one),
                                       cmocka_unit_test(marks_frequencies_without_pivots)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
