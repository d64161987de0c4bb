/* The law of an actuator: its derivative against differences, the lag against the exponential, the delay line against
 * the function that was put into it, at jumps and with far more samples than it holds. Equations: eq:drive.actuator,
 * eq:drive.lag. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>

#include "check.h"
#include "force/actuator_law.h"

/* d force/d delayed against differences, for each regime. */
static void derivative_is_the_difference(void **state)
{
    const dmb_actuator_law laws[] = {{.lag = 0.1},
                                     {.lag = 40.0},
                                     {.rate_limit = 1e3},
                                     {.lag = 0.1, .rate_limit = 1e3},
                                     {.rate_limit = 1.0, .lag = 0.3}};
    const dmb_actuator_flow from = {10.0, 10.0, 10.0, 7.0};
    (void)state;
    for (uint32_t k = 0; k < 5; k++)
        for (int i = 0; i < 5; i++) {
            const double h = 1e-4 * pow(7.0, i);
            dmb_actuator_flow at = {0.0, 12.0, 0.0, 0.0}, up = at, down = at;
            up.delayed += 1e-4;
            down.delayed -= 1e-4;
            const double slope = dmb_actuator_follow(laws + k, h, 10.0, &from, &at);
            (void)dmb_actuator_follow(laws + k, h, 10.0, &from, &up);
            (void)dmb_actuator_follow(laws + k, h, 10.0, &from, &down);
            check_below("derivative", fabs(slope - (up.force - down.force) / 2e-4), 1e-9);
        }
}

/* h/tau from where its series is taken to where it is the exponential itself. */
static void lag_is_the_exponential(void **state)
{
    const dmb_actuator_flow from = {0.0, 0.0, 0.0, 3.0};
    (void)state;
    for (int i = 0; i < 41; i++) {
        const double x = 1e-7 * pow(1.7, i);
        const dmb_actuator_law law = {.lag = 0.4};
        dmb_actuator_flow flow = {0.0, 5.0, 0.0, 0.0};
        const double slope = dmb_actuator_follow(&law, 0.4 * x, 2.0, &from, &flow), w = 1.0 + expm1(-x) / x;
        check_below("force", fabs(flow.force - (3.0 * exp(-x) + 2.0 * -expm1(-x) + 3.0 * w)),
                    1e-9 * fmin(1.0, x) + 1e-15);
        check_below("weight", fabs(slope - w), 1e-9 * fmin(1.0, x) + 1e-15);
    }
}

/* Of a controller's table, inside its pieces and beyond them; at a corner that of the piece that ends there. */
static void slope_of_a_gain_table_is_the_difference(void **state)
{
    const dmb_gain_table table = {{-3.0, 0.0, 2.0, 3.0}, {-1.0, 0.0, 60.0, 50.0}, 4, 0};
    (void)state;
    for (int i = 0; i < 33; i++) {
        const double e = -4.05 + 0.25 * i;
        double slope, other;
        const double force = dmb_gain_force(&table, e, &slope);
        const double more = dmb_gain_force(&table, e + 1e-3, &other), less = dmb_gain_force(&table, e - 1e-3, &other);
        check_below("slope", fabs(slope - (more - less) / 2e-3), 1e-10);
        check_below("straight", fabs(force - 0.5 * (more + less)), 1e-12);
    }
    double slope;
    check_below("at a corner", fabs(dmb_gain_force(&table, 2.0, &slope) - 60.0) + fabs(slope - 30.0), 1e-14);
}

static double time_of[DMB_DELAY_SAMPLES], value_of[DMB_DELAY_SAMPLES];

static double wave(double t)
{
    return sin(3.0 * t) + (t >= 2.0 ? 5.0 : 0.0);
}

/* Steps of 1e-5 s, a delay of 0.5 s: 50000 steps in what the line remembers. */
static void line_remembers(void **state)
{
    const dmb_delay_line line = {time_of, value_of};
    const double delay = 0.5, h = 1e-5;
    double worst = 0.0;
    (void)state;
    dmb_delay_fill(&line, 0.0, 0.0);
    for (int i = 0; i < 300000; i++) {
        const double begin = i * h, end = (i + 1) * h;
        const double before = i == 199999 ? wave(end) - 5.0 : wave(end);
        dmb_delay_push(&line, delay, begin, wave(begin), end, before);
        if (i % 97 != 0 || end <= delay) continue;
        const double t = end - delay;
        worst = fmax(worst, fabs(dmb_delay_after(&line, t) - wave(t)));
        if (i > 200000 && i < 249000) assert_true(fabs(dmb_delay_next_jump(&line, t) - 2.0) < 1e-9);
    }
    check_below("line against its function", worst, 1e-4);
    assert_true(isinf(dmb_delay_next_jump(&line, 2.5)));
}

static void jumps_have_two_sides(void **state)
{
    const dmb_delay_line line = {time_of, value_of};
    (void)state;
    dmb_delay_fill(&line, 1.0, 7.0);
    dmb_delay_push(&line, 0.1, 1.0, 7.0, 1.5, 7.0);
    dmb_delay_push(&line, 0.1, 1.5, 9.0, 2.0, 11.0);
    assert_true(dmb_delay_before(&line, 0.3) == 7.0 && dmb_delay_after(&line, 0.3) == 7.0);
    assert_true(dmb_delay_before(&line, 1.5) == 7.0 && dmb_delay_after(&line, 1.5) == 9.0);
    assert_true(dmb_delay_before(&line, 1.5 * (1.0 + 4e-16)) == 7.0);
    assert_true(dmb_delay_after(&line, 1.75) == 10.0 && dmb_delay_before(&line, 5.0) == 11.0);
    assert_true(dmb_delay_next_jump(&line, 1.0) == 1.5 && isinf(dmb_delay_next_jump(&line, 1.5)));
}

/* A second jump within a part of the delay takes the place of the first one's later side: what comes out is what went
 * in but for a part of the delay. */
static void jumps_close_together(void **state)
{
    const dmb_delay_line line = {time_of, value_of};
    const double delay = 0.5, part = delay / DMB_DELAY_PARTS;
    (void)state;
    dmb_delay_fill(&line, 0.0, 1.0);
    for (int i = 1; i <= 10; i++) dmb_delay_push(&line, delay, 0.1 * (i - 1), 1.0, 0.1 * i, 1.0);
    dmb_delay_push(&line, delay, 1.0, 4.0, 1.0 + 0.1 * part, 4.0);
    dmb_delay_push(&line, delay, 1.0 + 0.1 * part, 6.0, 1.0 + 0.2 * part, 6.0);
    dmb_delay_push(&line, delay, 1.0 + 0.2 * part, -2.0, 1.0 + 0.3 * part, -2.0);
    for (int i = 4; i <= 10; i++)
        dmb_delay_push(&line, delay, 1.0 + 0.1 * (i - 1) * part, -2.0, 1.0 + 0.1 * i * part, -2.0);
    assert_true(dmb_delay_before(&line, 1.0) == 1.0 && dmb_delay_after(&line, 0.95) == 1.0);
    assert_true(dmb_delay_after(&line, 1.0 + part) == -2.0 && dmb_delay_before(&line, 1.0 + part) == -2.0);
    for (int i = 0; i <= 20; i++) {
        const double between = dmb_delay_after(&line, 1.0 + 0.05 * i * part);
        assert_true(between >= -2.0 && between <= 6.0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(derivative_is_the_difference),
        cmocka_unit_test(lag_is_the_exponential),
        cmocka_unit_test(slope_of_a_gain_table_is_the_difference),
        cmocka_unit_test(line_remembers),
        cmocka_unit_test(jumps_have_two_sides),
        cmocka_unit_test(jumps_close_together),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
