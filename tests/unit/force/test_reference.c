/* A value on its way to a target within limits: against closed forms of the least time (rest to rest, and from any rate
 * without a bound on it), against integrals by Simpson's rule, and within its limits from random starts. Equations:
 * eq:drive.reference. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "force/reference.h"

static uint64_t seed = 1;
static double draw(double low, double high)
{
    seed = seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return low + (high - low) * (double)(seed >> 11) * 0x1p-53;
}

static double value_at(const dmb_reference *r, double t)
{
    double value;
    dmb_reference_value(r, t, &value, NULL);
    return value;
}

static double rate_at(const dmb_reference *r, double t)
{
    double value, rate;
    dmb_reference_value(r, t, &value, &rate);
    return rate;
}

/* 2 sqrt(dv/J) where the peak stays below A, else dv/A + A/J. */
static void rest_to_rest(void **state)
{
    (void)state;
    for (int i = 0; i < 1000; i++) {
        const double A = draw(0.1, 10.0), J = draw(0.1, 100.0), rise = draw(-20.0, 20.0), size = fabs(rise);
        const dmb_reference r = {draw(0.0, 100.0), draw(-5.0, 5.0), 0.0, 0.0, A, J};
        dmb_reference to = r;
        to.target = r.value + rise;
        const double least = size <= A * A / J ? 2.0 * sqrt(size / J) : size / A + A / J;
        assert_true(fabs(dmb_reference_arrival(&to) - r.time - least) < 1e-12 * (100.0 + least));
        const double peak = fmin(A, sqrt(J * size));
        assert_true(fabs(rate_at(&to, r.time + peak / J)) <= A * (1.0 + 1e-12));
        assert_true(fabs(fabs(rate_at(&to, r.time + peak / J)) - peak) < 1e-9 * peak + 1e-9);
    }
}

/* From a rate a0 without a bound on it: T = (2 sqrt(a^2/2 + J d rise) - a)/J with d the side of the switching curve and
 * a = d a0 (Bryson, Ho 1975, 3.9). */
static void from_any_rate(void **state)
{
    (void)state;
    for (int i = 0; i < 1000; i++) {
        const double J = draw(0.1, 50.0), a0 = draw(-5.0, 5.0), rise = draw(-10.0, 10.0);
        const dmb_reference r = {1.0, 2.0, a0, 2.0 + rise, 0.0, J};
        const double d = rise >= a0 * fabs(a0) / (2.0 * J) ? 1.0 : -1.0;
        const double least = (2.0 * sqrt(0.5 * a0 * a0 + J * d * rise) - d * a0) / J;
        assert_true(fabs(dmb_reference_arrival(&r) - 1.0 - least) < 1e-12 * (1.0 + least));
    }
}

/* Without a bound on the slope a straight line; without any it is there at once. */
static void ramp_and_jump(void **state)
{
    (void)state;
    const dmb_reference ramp = {3.0, 1.0, 7.0, -1.0, 4.0, 0.0}, jump = {3.0, 1.0, 7.0, -1.0, 0.0, 0.0};
    assert_true(fabs(dmb_reference_arrival(&ramp) - 3.5) < 1e-15);
    assert_true(value_at(&ramp, 3.25) == 0.0 && rate_at(&ramp, 3.0) == -4.0 && rate_at(&ramp, 3.5) == 0.0);
    assert_true(dmb_reference_rate_before(&ramp, 3.5) == -4.0 && dmb_reference_rate_before(&ramp, 3.0) == 0.0);
    assert_true(dmb_reference_next_breakpoint(&ramp, 3.0) == 3.5 && isinf(dmb_reference_next_breakpoint(&ramp, 3.5)));
    assert_true(value_at(&jump, 3.0) == -1.0 && rate_at(&jump, 3.0) == 0.0);
    assert_true(isinf(dmb_reference_next_breakpoint(&jump, 0.0)));
    assert_true(value_at(&jump, 2.9) == 1.0);
}

/* Simpson between breakpoints is exact for the cubics and parabolas at hand. */
static double simpson(const dmb_reference *r, double a, double b)
{
    double sum = 0.0;
    while (a < b) {
        const double end = fmin(b, fmax(dmb_reference_next_breakpoint(r, a), a + 1e-9)), h = end - a;
        sum += h / 6.0 * (value_at(r, a) + 4.0 * value_at(r, a + 0.5 * h) + value_at(r, end));
        a = end;
    }
    return sum;
}

/* Within both limits but where it began beyond them, continuous in value and rate, at rest on the target. */
static void random_starts(void **state)
{
    (void)state;
    for (int i = 0; i < 400; i++) {
        const double A = draw(0.5, 4.0), J = draw(0.5, 40.0);
        const dmb_reference r = {draw(0.0, 10.0), draw(-5.0, 5.0), draw(-6.0, 6.0), draw(-5.0, 5.0), A, J};
        const double end = dmb_reference_arrival(&r), whole = end - r.time;
        double value = r.value, rate = r.rate;
        assert_true(value_at(&r, end) == r.target && rate_at(&r, end) == 0.0);
        for (int k = 1; k <= 400; k++) {
            const double t = r.time + whole * k / 400.0, h = whole / 400.0;
            const double next = value_at(&r, t), slope = rate_at(&r, t);
            assert_true(fabs(slope) <= fmax(A, fabs(r.rate)) + 1e-9);
            assert_true(fabs(slope - rate) <= J * h * (1.0 + 1e-6) + 1e-9);
            assert_true(fabs(next - value - 0.5 * h * (rate + slope)) <= J * h * h);
            value = next;
            rate = slope;
        }
        const double a = r.time + draw(-1.0, 1.0) * whole, b = a + draw(0.0, 2.0) * whole;
        double exact = simpson(&r, fmax(a, r.time), fmax(b, r.time)) + r.value * fmax(0.0, fmin(b, r.time) - a);
        assert_true(fabs(dmb_reference_integral(&r, a, b) - exact) < 1e-11 * (1.0 + fabs(exact)));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(rest_to_rest), cmocka_unit_test(from_any_rate),
                                       cmocka_unit_test(ramp_and_jump), cmocka_unit_test(random_starts)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
