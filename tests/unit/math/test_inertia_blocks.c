/* Signs of the eigenvalues of symmetric block-tridiagonal matrices, against matrices whose signs are known. Equations:
 * eq:signs.inertia, eq:signs.size. */
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "math/inertia.h"

#define BLOCKS 9
#define MAX_ROWS (6 * BLOCKS)

typedef struct chain {
    uint8_t size[BLOCKS];
    uint32_t row[BLOCKS + 1], diag[BLOCKS + 1], link[BLOCKS];
    double diagonal[36 * BLOCKS], lower[36 * BLOCKS], upper[36 * BLOCKS];
    dmb_block_layout layout;
} chain;

static void lay_out(chain *c, const uint8_t *size)
{
    memset(c, 0, sizeof *c);
    memcpy(c->size, size, BLOCKS);
    dmb_block_fill(BLOCKS, c->size, c->row, c->diag, c->link);
    c->layout = (dmb_block_layout){BLOCKS, c->size, c->row, c->diag, c->link};
}

/* A = L S L^T with a unit lower block-bidiagonal L (dense random in each block below) and S block-diagonal, each block
 * Q diag(sign) Q^T by Householder's Q: by Sylvester's law the signs of A are those of S. */
static uint32_t random_matrix(chain *c, uint64_t *seed)
{
    uint32_t negative = 0;
    double S[36], B[36], BS[36];
    for (uint32_t k = 0; k < BLOCKS; k++) {
        const uint32_t n = c->size[k];
        double v[6], sign[6], norm = 0.0;
        for (uint32_t i = 0; i < n; i++) {
            v[i] = draw_between(seed, -1.0, 1.0);
            sign[i] = draw_between(seed, -1.0, 1.0) < 0.0 ? -1.0 : draw_between(seed, 0.5, 1e6);
            negative += sign[i] < 0.0;
            norm += v[i] * v[i];
        }
        for (uint32_t i = 0; i < n; i++)
            for (uint32_t j = 0; j < n; j++) {
                double sum = 0.0;
                for (uint32_t m = 0; m < n; m++)
                    sum += sign[m] * ((i == m) - 2.0 * v[i] * v[m] / norm) * ((j == m) - 2.0 * v[j] * v[m] / norm);
                S[n * i + j] = sum;
                c->diagonal[c->diag[k] + n * i + j] += sum;
            }
        if (k + 1 == BLOCKS) break;
        const uint32_t m = c->size[k + 1];
        for (uint32_t i = 0; i < m * n; i++) B[i] = draw_between(seed, -1.0, 1.0);
        for (uint32_t i = 0; i < m; i++)
            for (uint32_t j = 0; j < n; j++) {
                BS[n * i + j] = 0.0;
                for (uint32_t l = 0; l < n; l++) BS[n * i + j] += B[n * i + l] * S[n * l + j];
                c->lower[c->link[k] + n * i + j] = c->upper[c->link[k] + m * j + i] = BS[n * i + j];
            }
        for (uint32_t i = 0; i < m; i++)
            for (uint32_t j = 0; j < m; j++)
                for (uint32_t l = 0; l < n; l++)
                    c->diagonal[c->diag[k + 1] + m * i + j] += BS[n * i + l] * B[n * j + l];
    }
    return negative;
}

static void signs_of_random_matrices(void **state)
{
    (void)state;
    static const uint8_t sizes[3][BLOCKS] = {
        {6, 6, 6, 6, 6, 6, 6, 6, 6}, {2, 2, 2, 2, 2, 2, 2, 2, 2}, {1, 6, 2, 6, 6, 3, 1, 4, 2}};
    uint64_t seed = 77;
    uint32_t right = 0;
    for (int t = 0; t < 3000; t++) {
        chain c;
        lay_out(&c, sizes[t % 3]);
        const uint32_t want = random_matrix(&c, &seed);
        right += dmb_block_negative(&c.layout, c.diagonal, c.lower, c.upper, NULL, 0, BLOCKS) == want;
    }
    tell("matrices whose signs are counted right, of 3000", right);
    assert_int_equal(right, 3000);
}

/* Chain of masses 2 - mu on the diagonal, -1 beside it: mu is above as many of 2 - 2 cos(k pi/(n+1)) as are negative.
 */
static void sturm_count_of_the_laplacian(void **state)
{
    (void)state;
    static const uint8_t ones[BLOCKS] = {1, 1, 1, 1, 1, 1, 1, 1, 1};
    for (uint32_t k = 0; k <= BLOCKS; k++) {
        chain c;
        lay_out(&c, ones);
        const double mu = 2.0 - 2.0 * cos((k + 0.5) * PI / (BLOCKS + 1));
        for (uint32_t i = 0; i < BLOCKS; i++) c.diagonal[i] = 2.0 - mu;
        for (uint32_t i = 0; i + 1 < BLOCKS; i++) c.lower[i] = c.upper[i] = -1.0;
        assert_int_equal(dmb_block_negative(&c.layout, c.diagonal, c.lower, c.upper, NULL, 0, BLOCKS), k);
        const dmb_block_raise raise = {.part = mu / fabs(2.0 - mu), .arm_square = 1.0};
        assert_int_equal(dmb_block_negative(&c.layout, c.diagonal, c.lower, c.upper, &raise, 0, BLOCKS), 0);
    }
}

/* [0 1; 1 0] has one of each sign and no diagonal to pivot on. */
static void pivots_of_two_rows(void **state)
{
    (void)state;
    static const uint8_t twos[BLOCKS] = {2, 2, 2, 2, 2, 2, 2, 2, 2};
    chain c;
    lay_out(&c, twos);
    for (uint32_t k = 0; k < BLOCKS; k++) c.diagonal[c.diag[k] + 1] = c.diagonal[c.diag[k] + 2] = 1.0;
    assert_int_equal(dmb_block_negative(&c.layout, c.diagonal, c.lower, c.upper, NULL, 0, BLOCKS), BLOCKS);
    assert_int_equal(dmb_block_negative(&c.layout, c.diagonal, c.lower, c.upper, NULL, 3, 2), 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(signs_of_random_matrices),
        cmocka_unit_test(sturm_count_of_the_laplacian),
        cmocka_unit_test(pivots_of_two_rows),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
