/* Bands of hundreds of damped modes, which searches all over the half plane of their roots cover, held against a closed
 * form: damping proportional to the stiffness, C = tau K, makes s^2 + tau w^2 s + w^2 = 0 of each undamped mode, a pair
 * s = -tau w^2/2 +- i w sqrt(1 - (tau w/2)^2) or two real roots. And what is more than such searches take is refused.
 * Equations: eq:modes.strip, eq:modes.general. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "modal.h"

enum { MOST = 1200 };

static void open_string(rig *s, uint32_t pipes, double tau)
{
    dmb_pipe_def pipe = s1_pipe();
    pipe.damping_time = tau;
    (void)lay_string(s, &pipe, pipes, DMB_FREE_NONE, DMB_FREE_ALL);
    (void)rig_start(s, NULL);
}

typedef struct root {
    double re, im;
} root;

static int by_size(const void *a, const void *b)
{
    const root *p = a, *q = b;
    const double x = hypot(p->re, p->im), y = hypot(q->re, q->im);
    return fabs(x - y) > 1e-9 * y ? (x > y) - (x < y) : 0;
}

/* The roots that undamped modes make, of |s| from low to high [1/s]. */
static uint32_t expected_roots(const dmb_modes *undamped, double tau, double low, double high, root *out)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < info_of(undamped).count; i++) {
        const double w = 2.0 * PI * frequency_at(undamped, i), half = 0.5 * tau * w * w, left = w * w - half * half;
        root both[2] = {{-half, sqrt(fmax(left, 0.0))}, {0.0, 0.0}};
        if (left < 0.0) {
            both[1].re = -half - sqrt(-left);
            both[0].re = w * w / both[1].re;
        }
        for (int k = 0; k < (left < 0.0 ? 2 : 1); k++) {
            const double size = hypot(both[k].re, both[k].im);
            if (size >= low && size <= high && count < MOST) out[count++] = both[k];
        }
    }
    qsort(out, count, sizeof *out, by_size);
    return count;
}

static void check_band(const rig *s, double tau, double low, double high, double reach, uint32_t least)
{
    static root want[MOST];
    dmb_modes *undamped = modes_in_band(s, DMB_MODES_UNDAMPED, 0.0, reach);
    dmb_modes *band = modes_in_band(s, DMB_MODES_DAMPED, low, high);
    const uint32_t count = expected_roots(undamped, tau, 2.0 * PI * low, 2.0 * PI * high, want);
    const dmb_modes_info info = info_of(band);
    double worst = 0.0;
    print_message("  tau %g s, %g to %g Hz: %u modes, %u wanted, dense %d, %u solves\n", tau, low, high, info.count,
                  count, (int)info.dense, info.solves);
    assert_int_equal(info.dense, 0);
    assert_int_equal(info.count, count);
    assert_true(count >= least);
    for (uint32_t i = 0; i < count; i++) {
        const double *s_i = mode_at(band, i).eigenvalue;
        worst = fmax(worst, hypot(s_i[0] - want[i].re, fabs(s_i[1]) - want[i].im) / hypot(want[i].re, want[i].im));
    }
    check_below("  roots against those of the undamped modes", worst, 1e-7);
    dmb_modes_destroy(&undamped);
    dmb_modes_destroy(&band);
}

/* Hundreds at once, and a part of them from above 0. */
static void bands_of_little_damping(void **state)
{
    (void)state;
    rig s;
    open_string(&s, 160, 2e-5);
    check_band(&s, 2e-5, 0.0, 60.0, 61.0, 257);
    check_band(&s, 2e-5, 50.0, 55.0, 56.0, 10);
    rig_close(&s);
}

/* A fifth of the critical damping at the upper edge: the roots bend away from the imaginary axis. */
static void band_of_strong_damping(void **state)
{
    (void)state;
    rig s;
    open_string(&s, 60, 1.5e-3);
    check_band(&s, 1.5e-3, 0.0, 40.0, 45.0, 80);
    rig_close(&s);
}

/* Beyond the critical damping real roots stand among the others; so many are refused, with the bound. */
static void band_beyond_the_critical_damping(void **state)
{
    (void)state;
    dmb_modes_options options = dmb_modes_options_default();
    rig s;
    open_string(&s, 160, 2e-2);
    options.kind = DMB_MODES_DAMPED;
    options.select = DMB_MODES_BAND;
    options.band[1] = 60.0;
    const modes_refusal refusal = refused_modes(&s, &options);
    print_message("  %s\n", refusal.text);
    assert_int_equal(refusal.status, DMB_ERR_TOO_LARGE);
    assert_non_null(strstr(refusal.text, "must be <= 256"));
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bands_of_little_damping),
        cmocka_unit_test(band_of_strong_damping),
        cmocka_unit_test(band_beyond_the_critical_damping),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
