/* Sums over rows and the largest turn of a run: every width gives the same bits, and these are the sums in long
 * double to rounding, rows that are not solved for left out. */
#include <float.h>
#include <string.h>

#include "check.h"
#include "kernel/kernels.h"
#include "math/vec3.h"

enum { ROWS = 150, NODES = 25 };

typedef struct rows {
    double a[ROWS], b[ROWS], v[ROWS];
    uint8_t solved[ROWS];
} rows;

static void draw_rows(uint64_t *seed, int held, rows *x)
{
    for (int i = 0; i < ROWS; i++) {
        x->a[i] = draw_between(seed, -1.0, 1.0);
        x->b[i] = draw_between(seed, 0.0, 1.0);
        x->v[i] = draw_between(seed, -1.0, 1.0);
        x->solved[i] = !held || draw_between(seed, 0.0, 1.0) < 0.9;
    }
}

/* product of a and v, powers left and exchanged, magnitude of a */
static void exact_sums(const rows *x, uint32_t count, long double sums[4])
{
    sums[0] = sums[1] = sums[2] = sums[3] = 0.0L;
    for (uint32_t i = 0; i < count; i++) {
        sums[0] += (long double)x->a[i] * (long double)x->v[i];
        sums[3] += fabsl((long double)x->a[i]);
        if (!x->solved[i]) continue;
        sums[1] += (long double)x->a[i] * (long double)x->v[i];
        sums[2] += fabsl((long double)x->b[i] * (long double)x->v[i]);
    }
}

static void sums_by(const dmb_kernels *kernels, const rows *x, uint32_t count, double sums[4])
{
    sums[0] = kernels->product(count, x->a, x->v);
    dmb_power_args args = {.count = count, .residual = x->a, .scale = x->b, .velocity = x->v, .solved = x->solved};
    kernels->powers(&args);
    sums[1] = args.left;
    sums[2] = args.exchanged;
    sums[3] = kernels->magnitude(count, x->a);
}

static void sums_have_the_same_bits_and_are_right(void **state)
{
    uint64_t seed = 3;
    double worst = 0.0;
    rows x;
    (void)state;
    for (uint32_t count = 0; count <= ROWS; count++) {
        long double exact[4];
        double alone[4], sums[4];
        draw_rows(&seed, count % 2, &x);
        exact_sums(&x, count, exact);
        sums_by(dmb_kernels_of(1), &x, count, alone);
        for (int k = 0; k < 3; k++)
            worst = fmax(worst, fabs((double)((long double)alone[k] - exact[k])) / (1.0 + count));
        for (uint32_t lanes = 2; lanes <= 8; lanes *= 2) {
            if (!dmb_kernels_of(lanes)) continue;
            sums_by(dmb_kernels_of(lanes), &x, count, sums);
            assert_memory_equal(sums, alone, sizeof sums);
        }
    }
    check_below("sums of up to 150 products below 1, error a product", worst, 1e-16);
}

/* To another place and in place. */
static void numbers_are_negated(void **state)
{
    uint64_t seed = 4;
    double from[ROWS], to[ROWS];
    (void)state;
    for (uint32_t lanes = 1; lanes <= 8; lanes *= 2) {
        const dmb_kernels *kernels = dmb_kernels_of(lanes);
        for (uint32_t count = 0; kernels && count <= ROWS; count++) {
            for (int i = 0; i < ROWS; i++) from[i] = to[i] = draw_between(&seed, -1.0, 1.0);
            kernels->negate(count, from, to);
            for (uint32_t i = 0; i < count; i++) assert_true(to[i] == -from[i]);
            for (uint32_t i = count; i < ROWS; i++) assert_true(to[i] == from[i]);
            kernels->negate(count, to, to);
            assert_memory_equal(to, from, sizeof to);
        }
    }
}

/* Numbers that are none or too large end in the sum of magnitudes. */
static void what_is_not_finite_shows(void **state)
{
    static const double bad[] = {(double)NAN, (double)INFINITY, -(double)INFINITY};
    (void)state;
    for (uint32_t lanes = 1; lanes <= 8; lanes *= 2)
        for (uint32_t i = 0; dmb_kernels_of(lanes) && i < ROWS; i++)
            for (uint32_t k = 0; k < 3; k++) {
                double a[ROWS] = {0.0};
                a[i] = bad[k];
                const double sum = dmb_kernels_of(lanes)->magnitude(ROWS, a);
                assert_true(!(sum <= DBL_MAX));
                assert_true(dmb_kernels_of(lanes)->magnitude(i, a) == 0.0);
            }
}

/* Nodes that stand still at the origin, moved by increments. */
static double turned_by(const dmb_kernels *kernels, const double *z, uint32_t count, double before)
{
    static double displacement[3 * NODES], quaternion[4 * NODES], u[3 * NODES], q[4 * NODES];
    memset(displacement, 0, sizeof displacement);
    memset(quaternion, 0, sizeof quaternion);
    for (int i = 0; i < NODES; i++) quaternion[4 * i] = 1.0;
    dmb_node_args args = {count, 0, z, displacement, quaternion, u, q, before};
    kernels->advance(&args);
    return args.turned;
}

static void the_largest_turn_is_told(void **state)
{
    uint64_t seed = 8;
    double z[6 * NODES];
    (void)state;
    for (uint32_t count = 1; count <= NODES; count++) {
        double most = 0.0;
        for (int i = 0; i < 6 * NODES; i++) z[i] = draw_between(&seed, -0.5, 0.5);
        for (uint32_t i = 0; i < count; i++) most = fmax(most, dmb_vec3_norm_squared(z + 6 * i + 3));
        for (uint32_t lanes = 1; lanes <= 8; lanes *= 2) {
            if (!dmb_kernels_of(lanes)) continue;
            assert_true(turned_by(dmb_kernels_of(lanes), z, count, 0.0) == most);
            assert_true(turned_by(dmb_kernels_of(lanes), z, count, 2.0) == 2.0);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sums_have_the_same_bits_and_are_right), cmocka_unit_test(numbers_are_negated),
        cmocka_unit_test(what_is_not_finite_shows), cmocka_unit_test(the_largest_turn_is_told)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
