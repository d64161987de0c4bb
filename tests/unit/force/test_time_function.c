/* Time functions: values, rates, integrals and breakpoints against closed forms, differences and quadrature. Equations:
 * eq:drive.step, eq:drive.per-revolution. */
#include "force/time_function.h"

#include "force_test.h"

static dmb_segment make(int32_t kind, double x0, double x1, double h0, double h1)
{
    dmb_segment term;

    memset(&term, 0, sizeof term);
    term.struct_size = (uint32_t)sizeof term;
    term.kind = kind;
    term.x0 = x0;
    term.x1 = x1;
    term.h0 = h0;
    term.h1 = h1;
    return term;
}

static dmb_segment harmonic(double h0, double h1, double omega, double phase)
{
    dmb_segment term = make(DMB_SEGMENT_HARMONIC, 0, 1, h0, h1);

    term.omega = omega;
    term.phase = phase;
    return term;
}

static const double knot_time[5] = {-1.0, 0.5, 0.75, 3.0, 7.5};
static const double knot_value[5] = {2.0, -1.0, 4.0, 4.0, 0.25};

static dmb_segment table(uint32_t count)
{
    dmb_segment term = make(DMB_SEGMENT_TABLE, 0, 1, 0, 0);

    term.table_time = knot_time;
    term.table_value = knot_value;
    term.table_count = count;
    return term;
}

static dmb_segment callback(dmb_time_fn fn, int32_t provides, void *context)
{
    dmb_segment term = make(DMB_SEGMENT_CALLBACK, 0, 1, 0, 0);

    term.callback = fn;
    term.provides = provides;
    term.callback_context = context;
    return term;
}

static double value_at(const dmb_time_function *p, double t)
{
    double value = (double)NAN;

    assert_int_equal(dmb_time_function_value(p, t, &value, NULL), DMB_OK);
    return value;
}

static double rate_at(const dmb_time_function *p, double t)
{
    double value, rate = (double)NAN;

    assert_int_equal(dmb_time_function_value(p, t, &value, &rate), DMB_OK);
    return rate;
}

static double integral_of(const dmb_time_function *p, double t0, double t1)
{
    double integral = (double)NAN;

    assert_int_equal(dmb_time_function_integral(p, t0, t1, &integral), DMB_OK);
    return integral;
}

/* Composite Simpson rule, breakpoint to breakpoint. */
static double quadrature(const dmb_time_function *p, double t0, double t1)
{
    double sum = 0.0;

    while (t0 < t1) {
        const double end = fmin(t1, dmb_time_function_next_breakpoint(p, t0));
        const double inside = end - 1e-13 * fabs(end); /* the value left of the breakpoint */
        const int n = 4000;
        const double h = (inside - t0) / n;
        for (int i = 0; i < n; ++i)
            sum += h / 6.0 *
                   (value_at(p, t0 + i * h) + 4.0 * value_at(p, t0 + (i + 0.5) * h) + value_at(p, t0 + (i + 1) * h));
        t0 = end;
    }
    return sum;
}

static void step_values(void **state)
{
    const dmb_segment cubic = make(DMB_SEGMENT_STEP, 2.0, 6.0, 1.0, 5.0);
    const dmb_segment quintic = make(DMB_SEGMENT_STEP5, 2.0, 6.0, 1.0, 5.0);
    const dmb_time_function p3 = {&cubic, 1}, p5 = {&quintic, 1};
    (void)state;

    assert_true(value_at(&p3, -1e30) == 1.0 && value_at(&p3, 2.0) == 1.0);
    assert_true(value_at(&p3, 6.0) == 5.0 && value_at(&p3, 1e30) == 5.0);
    CHECK_CLOSE(value_at(&p3, 3.0), 1.0 + 4.0 * 0.15625, 1e-15);
    CHECK_CLOSE(value_at(&p5, 3.0), 1.0 + 4.0 * 0.103515625, 1e-15);
    CHECK_CLOSE(value_at(&p3, 4.0), 3.0, 1e-15);
    CHECK_CLOSE(value_at(&p5, 4.0), 3.0, 1e-15);
    CHECK_CLOSE(rate_at(&p3, 4.0), 1.5, 1e-15);   /* 6 D (1-D) rise/width */
    CHECK_CLOSE(rate_at(&p5, 4.0), 1.875, 1e-15); /* 30 D^2 (1-D)^2 rise/width */
    assert_true(rate_at(&p3, 2.0) == 0.0 && rate_at(&p5, 6.0) == 0.0);
}

/* The feed of the reference system: advances 10 mm/s from 1 to 19 s, withdraws from 22 to 40 s. */
static void six_stage_feed(void **state)
{
    const dmb_segment term[3] = {make(DMB_SEGMENT_STEP, 0, 1, 0, -0.01), make(DMB_SEGMENT_STEP, 19, 20, 0, 0.01),
                                 make(DMB_SEGMENT_STEP, 21, 22, 0, 0.01)};
    const dmb_time_function feed = {term, 3};
    const double breakpoint[6] = {0, 1, 19, 20, 21, 22};
    double t = -5.0;
    (void)state;

    assert_true(value_at(&feed, 10.0) == -0.01);
    CHECK_CLOSE(value_at(&feed, 20.5), 0.0, 1e-18);
    CHECK_CLOSE(value_at(&feed, 30.0), 0.01, 1e-18);
    CHECK_CLOSE(integral_of(&feed, 0.0, 20.0), -0.01 * (0.5 + 18.0 + 0.5), 1e-15);
    CHECK_CLOSE(integral_of(&feed, 0.0, 40.0), -0.19 + 0.01 * 18.5, 1e-15);
    for (int i = 0; i < 6; ++i) {
        t = dmb_time_function_next_breakpoint(&feed, t);
        assert_true(t == breakpoint[i]);
    }
    assert_true(isinf(dmb_time_function_next_breakpoint(&feed, t)));
}

static void rates_against_differences(void **state)
{
    uint64_t seed = 12345;
    dmb_segment term[5] = {make(DMB_SEGMENT_CONSTANT, 0, 1, 3.5, 9), make(DMB_SEGMENT_STEP, 0.2, 5, -2, 3),
                           make(DMB_SEGMENT_STEP5, -1, 4.5, 7, -1), harmonic(0.5, 2, 3.7, 0.4), table(5)};
    (void)state;

    for (uint32_t k = 0; k < 5; ++k) {
        const dmb_time_function p = {&term[k], 1};
        for (int i = 0; i < 200; ++i) {
            const double t = draw(&seed, -2, 9);
            const double h = 1e-5;
            if (dmb_time_function_next_breakpoint(&p, t - 2 * h) <= t + 2 * h) continue;
            CHECK_CLOSE(rate_at(&p, t), (value_at(&p, t + h) - value_at(&p, t - h)) / (2 * h), 5e-9);
        }
    }
}

static void integrals_against_quadrature(void **state)
{
    uint64_t seed = 777;
    dmb_segment term[6] = {make(DMB_SEGMENT_CONSTANT, 0, 1, 3.5, 9),
                           make(DMB_SEGMENT_STEP, 0.2, 5, -2, 3),
                           make(DMB_SEGMENT_STEP5, -1, 4.5, 7, -1),
                           harmonic(0.5, 2, 3.7, 0.4),
                           table(5),
                           table(1)};
    const dmb_time_function all = {term, 6};
    (void)state;

    for (uint32_t k = 0; k < 6; ++k) {
        const dmb_time_function p = {&term[k], 1};
        for (int i = 0; i < 12; ++i) {
            const double a = draw(&seed, -3, 9), b = draw(&seed, a, 10);
            CHECK_CLOSE(integral_of(&p, a, b), quadrature(&p, a, b), 1e-10);
        }
    }
    CHECK_CLOSE(integral_of(&all, -3, 10), quadrature(&all, -3, 10), 1e-10);
    CHECK_CLOSE(integral_of(&all, 10, -3), -integral_of(&all, -3, 10), 0.0);
    CHECK_CLOSE(integral_of(&all, -3, 1.7) + integral_of(&all, 1.7, 10), integral_of(&all, -3, 10), 1e-13);
    assert_true(integral_of(&all, 2.0, 2.0) == 0.0);
}

/* Closed forms: integral of STEP h0 s + rise width (D^3 - D^4/2) */
static void step_antiderivative(void **state)
{
    const dmb_segment cubic = make(DMB_SEGMENT_STEP, 1.0, 4.0, 0.5, 2.5);
    const dmb_segment quintic = make(DMB_SEGMENT_STEP5, 1.0, 4.0, 0.5, 2.5);
    const dmb_time_function p3 = {&cubic, 1}, p5 = {&quintic, 1};
    (void)state;

    for (double t = 1.0; t <= 4.0; t += 0.125) {
        const double d = (t - 1.0) / 3.0;
        CHECK_CLOSE(integral_of(&p3, 1.0, t), 0.5 * (t - 1) + 6 * (d * d * d - 0.5 * d * d * d * d), 4e-15);
        CHECK_CLOSE(integral_of(&p5, 1.0, t), 0.5 * (t - 1) + 6 * d * d * d * d * (2.5 - 3 * d + d * d), 4e-15);
    }
}

/* A step of 1 ms a day after the start keeps all its digits. */
static void small_intervals_far_out(void **state)
{
    const double t0 = 86400.0, t1 = t0 + 1e-3, h = t1 - t0;
    const dmb_segment term[3] = {make(DMB_SEGMENT_STEP, 0, 1, 0, 0.3), harmonic(0, 2, 12.5, 0.25),
                                 make(DMB_SEGMENT_STEP, 0, 172800, 0, 1)};
    const dmb_time_function step = {&term[0], 1}, wave = {&term[1], 1}, slow = {&term[2], 1};
    const long double middle = 12.5L * ((long double)t0 + 0.5L * (long double)h) + 0.25L;
    const long double half = 0.5L * 12.5L * (long double)h;
    (void)state;

    CHECK_RELATIVE(integral_of(&step, t0, t1), 0.3 * h, 1e-15);
    CHECK_RELATIVE(integral_of(&wave, t0, t1), (double)(4.0L / 12.5L * sinl(middle) * sinl(half)), 1e-9);
    const double simpson = h / 6 * (value_at(&wave, t0) + 4 * value_at(&wave, t0 + 0.5 * h) + value_at(&wave, t1));
    CHECK_RELATIVE(integral_of(&wave, t0, t1), simpson, 1e-9);
    CHECK_RELATIVE(integral_of(&slow, t0, t1), 0.5 * h * (1.0 + 0.75 * 1e-3 / 86400.0), 1e-12);
    const dmb_segment still = harmonic(0, 2, 0, PI / 6);
    const dmb_time_function zero = {&still, 1};
    CHECK_RELATIVE(integral_of(&zero, t0, t1), h, 1e-15);
}

static void table_values_and_breakpoints(void **state)
{
    const dmb_segment full = table(5), single = table(1);
    const dmb_time_function p = {&full, 1}, one = {&single, 1};
    double t = -10.0;
    (void)state;

    assert_true(value_at(&p, -10) == 2.0 && value_at(&p, 100) == 0.25 && value_at(&one, 3) == 2.0);
    CHECK_CLOSE(value_at(&p, 0.625), 1.5, 1e-15);
    CHECK_CLOSE(rate_at(&p, 0.625), 20.0, 1e-13);
    CHECK_CLOSE(rate_at(&p, 0.5), 20.0, 1e-13); /* from the right */
    assert_true(rate_at(&p, 7.5) == 0.0 && rate_at(&p, -1.5) == 0.0 && rate_at(&one, -1.0) == 0.0);
    for (int i = 0; i < 5; ++i) {
        assert_true(value_at(&p, knot_time[i]) == knot_value[i]);
        t = dmb_time_function_next_breakpoint(&p, t);
        assert_true(t == knot_time[i]);
    }
    assert_true(isinf(dmb_time_function_next_breakpoint(&p, t)));
    assert_true(dmb_time_function_next_breakpoint(&p, 0.6) == 0.75);
}

static void breakpoints_of_a_sum(void **state)
{
    const dmb_segment term[4] = {make(DMB_SEGMENT_STEP, 1, 5, 0, 1), table(5), make(DMB_SEGMENT_STEP5, 0.25, 0.6, 0, 1),
                                 harmonic(1, 1, 1, 1)};
    const dmb_time_function p = {term, 4}, quiet = {&term[3], 1}, empty = {NULL, 0};
    const double expected[9] = {-1, 0.25, 0.5, 0.6, 0.75, 1, 3, 5, 7.5};
    double t = -(double)INFINITY;
    (void)state;

    for (int i = 0; i < 9; ++i) {
        t = dmb_time_function_next_breakpoint(&p, t);
        assert_true(t == expected[i]);
    }
    assert_true(isinf(dmb_time_function_next_breakpoint(&p, t)));
    assert_true(isinf(dmb_time_function_next_breakpoint(&quiet, 0)) &&
                isinf(dmb_time_function_next_breakpoint(&empty, 0)));
    assert_true(value_at(&empty, 1) == 0.0 && integral_of(&empty, 0, 1) == 0.0);
}

/* ---- tables that repeat ---- */

static const double pulse_time[4] = {0.3, 0.42, 0.5, 1.0};
static const double pulse_value[4] = {-1.0, 3.0, 0.5, -1.0};

static dmb_segment pulses(void)
{
    dmb_segment term = make(DMB_SEGMENT_PERIODIC, 0, 1, 0, 0);

    term.table_time = pulse_time;
    term.table_value = pulse_value;
    term.table_count = 4;
    return term;
}

/* Value, rates and integrals of a table that repeats are those of the table at the time less whole periods; at knots,
 * which are found as breakpoints in their order, the rates from both sides are the slopes of the neighbours. */
static void repeated_table(void **state)
{
    dmb_segment again = pulses(), once = pulses();
    const dmb_time_function p = {&again, 1}, one = {&once, 1};
    uint64_t seed = 99;
    (void)state;

    once.kind = DMB_SEGMENT_TABLE;
    for (int i = 0; i < 40; ++i) {
        const double n = floor(draw(&seed, -40, 40)), t = draw(&seed, 0.3, 1.0);
        const double at = t + 0.7 * n;
        CHECK_CLOSE(value_at(&p, at), value_at(&one, at - 0.7 * n), 1e-11);
        const double later = draw(&seed, at, at + 3);
        CHECK_CLOSE(integral_of(&p, at, later), quadrature(&p, at, later), 1e-10);
    }
    const double whole = integral_of(&one, 0.3, 1.0);
    CHECK_RELATIVE(integral_of(&p, -6.7, 7000.3), whole * 7007.0 / 0.7, 1e-13);
}

/* Far from 0 the knots of a short period are rounded to the spacing of times, but an integral over some periods keeps
 * its digits: that of a constant is exact. */
static void short_periods_far_out(void **state)
{
    const double time[2] = {-4.0973267750784519, -4.0967682663167119}, value[2] = {2.25, 2.25};
    dmb_segment again = pulses();
    const dmb_time_function p = {&again, 1};
    uint64_t seed = 100;
    (void)state;

    again.table_time = time;
    again.table_value = value;
    again.table_count = 2;
    for (int i = 0; i < 200; ++i) {
        const double t0 = draw(&seed, -1e6, 1e6), t1 = t0 + draw(&seed, 0, 5e-3);
        CHECK_RELATIVE(integral_of(&p, t0, t1), 2.25 * (t1 - t0), 1e-13);
    }
}

/* Knots closer than the spacing of times there: integrals remain within the bounds of the values. */
static void close_knots_far_out(void **state)
{
    const double time[5] = {0.0, 1e-10, 2e-6, 5.3999e-6, 5.4e-6}, value[5] = {-2.0, 2.0, 2.0, 2.0, -2.0};
    dmb_segment again = pulses();
    const dmb_time_function p = {&again, 1};
    uint64_t seed = 101;
    (void)state;

    again.table_time = time;
    again.table_value = value;
    again.table_count = 5;
    for (int i = 0; i < 4000; ++i) {
        const double t0 = draw(&seed, -1e9, 1e9), t1 = t0 + draw(&seed, 2e-7, 1e-5);
        const double start = dmb_time_function_next_breakpoint(&p, t0),
                     mean[2] = {integral_of(&p, t0, t1) / (t1 - t0),
                                start < t1 ? integral_of(&p, start, t1) / (t1 - start) : 0.0};
        for (int k = 0; k < 2; ++k) assert_true(mean[k] >= -2.0 - 1e-12 && mean[k] <= 2.0 + 1e-12);
    }
}

static void breakpoints_of_a_repeated_table(void **state)
{
    const dmb_segment again = pulses();
    const dmb_time_function p = {&again, 1};
    const double slope[3] = {4.0 / 0.12, -2.5 / 0.08, -1.5 / 0.5};
    double t = 1e4;
    int at = -1;
    (void)state;

    for (int i = 0; i < 3000; ++i) {
        const double next = dmb_time_function_next_breakpoint(&p, t);
        double before = (double)NAN;
        assert_true(next > t && next < t + 0.51);
        assert_int_equal(dmb_time_function_rate_before(&p, next, &before), DMB_OK);
        const double after = rate_at(&p, next), middle = rate_at(&p, 0.5 * (t + next));
        if (at < 0)
            for (int k = 0; k < 3; ++k)
                if (fabs(after - slope[k]) < 1e-9) at = k;
        assert_true(at >= 0);
        CHECK_RELATIVE(after, slope[at], 1e-13);
        CHECK_RELATIVE(before, slope[(at + 2) % 3], 1e-13);
        if (i > 0) CHECK_RELATIVE(middle, before, 0.0);
        at = (at + 1) % 3;
        t = next;
    }
    CHECK_CLOSE(t, 1e4 + 700.0, 0.5);
}

/* ---- per revolution ---- */

/* 0: the speed of a rig that starts and stops; 1: with a harmonic; 2: tables. */
static dmb_time_function turning(int kind, dmb_segment term[3])
{
    term[0] = make(DMB_SEGMENT_STEP, 0, 1, 0, 21);
    term[1] = make(DMB_SEGMENT_STEP5, 1.5, 2.25, 0, -30);
    if (kind == 1) term[1] = harmonic(4, 9, 13, 0.5);
    if (kind == 2) {
        term[0] = table(5);
        term[1] = pulses();
    }
    const dmb_time_function made = {term, 2};
    return made;
}

static dmb_segment per_revolution(dmb_time_function *of, double h0, double h1, double share, double order)
{
    dmb_segment term = make(DMB_SEGMENT_PER_REVOLUTION, 0, 1, h0, h1);

    term.share = share;
    term.order = order;
    term.phase = 0.3;
    term.callback_context = of;
    return term;
}

/* Of all the turnings, against closed forms with sin of the C library, central differences and quadrature. */
static void swings(void **state)
{
    uint64_t seed = 4;
    (void)state;

    for (int kind = 0; kind < 3; ++kind) {
        dmb_segment terms[3];
        dmb_time_function of = turning(kind, terms);
        const dmb_segment worn = per_revolution(&of, 0.2, 1.5, 0.02, 3.0);
        const dmb_time_function p = {&worn, 1};
        for (int i = 0; i < 100; ++i) {
            const double t = draw(&seed, -1, 9), h = 1e-6;
            const double angle = 3.0 * integral_of(&of, 0.0, t) + 0.3;
            CHECK_CLOSE(value_at(&p, t), 0.2 + (1.5 + 0.02 * value_at(&of, t)) * sin(angle), 1e-13);
            if (dmb_time_function_next_breakpoint(&p, t - 2 * h) <= t + 2 * h) continue;
            CHECK_CLOSE(rate_at(&p, t), (value_at(&p, t + h) - value_at(&p, t - h)) / (2 * h), 1e-6); /* of 200 */
        }
        for (int i = 0; i < 4; ++i) {
            const double a = draw(&seed, -1, 4), b = draw(&seed, a, a + 0.7);
            CHECK_CLOSE(integral_of(&p, a, b), quadrature(&p, a, b), 1e-10);
        }
    }
}

/* The worn gear alone, as functions of the caller had it: share w sin, share (1 - cos)/order; short steps keep their
 * digits. */
static void swing_of_a_speed(void **state)
{
    dmb_segment terms[3];
    dmb_time_function of = turning(0, terms);
    dmb_segment worn = per_revolution(&of, 0.0, 0.0, 0.02, 1.0);
    const dmb_time_function p = {&worn, 1};
    uint64_t seed = 5;
    (void)state;

    worn.phase = 0.0;
    for (int i = 0; i < 200; ++i) {
        const double t = draw(&seed, 0, 4), theta = integral_of(&of, 0.0, t), w = value_at(&of, t);
        CHECK_CLOSE(value_at(&p, t), 0.02 * w * sin(theta), 1e-14);
        CHECK_CLOSE(rate_at(&p, t), 0.02 * (rate_at(&of, t) * sin(theta) + w * w * cos(theta)), 1e-12);
        CHECK_CLOSE(integral_of(&p, 0.0, t), 0.02 * (1.0 - cos(theta)), 1e-15);
    }
    const double t0 = 1000.0, t1 = t0 + 1e-4; /* it turns backwards by 9 rad/s */
    const double middle = integral_of(&of, 0.0, 0.5 * t0 + 0.5 * t1);
    CHECK_RELATIVE(integral_of(&p, t0, t1), 0.02 * -9.0 * (t1 - t0) * sin(middle), 1e-6);
}

/* At a kink of the speed that it follows the rate has two sides; the kink is a breakpoint. */
static void swing_at_breakpoints(void **state)
{
    dmb_segment terms[3];
    dmb_time_function of = turning(2, terms);
    const dmb_segment worn = per_revolution(&of, 0.0, 0.0, 0.02, 1.0);
    const dmb_time_function p = {&worn, 1};
    double before = (double)NAN;
    (void)state;

    const double kink = dmb_time_function_next_breakpoint(&p, 0.43);
    assert_true(kink == dmb_time_function_next_breakpoint(&of, 0.43) && kink == 0.5);
    assert_int_equal(dmb_time_function_rate_before(&p, kink, &before), DMB_OK);
    CHECK_CLOSE(before, (3 * value_at(&p, kink) - 4 * value_at(&p, kink - 1e-5) + value_at(&p, kink - 2e-5)) / 2e-5,
                1e-6);
    CHECK_CLOSE(rate_at(&p, kink),
                (4 * value_at(&p, kink + 1e-5) - 3 * value_at(&p, kink) - value_at(&p, kink + 2e-5)) / 2e-5, 1e-6);
    assert_true(fabs(before - rate_at(&p, kink)) > 0.1);
}

/* An integral of h1 over more revolutions than can be summed is refused. */
static void endless_swing(void **state)
{
    dmb_segment terms[3];
    dmb_time_function of = turning(0, terms);
    const dmb_segment worn = per_revolution(&of, 0.0, 1.0, 0.0, 1e6);
    const dmb_time_function p = {&worn, 1};
    double integral = 13;
    (void)state;

    assert_int_equal(dmb_time_function_integral(&p, 0.0, 1.0, &integral), DMB_ERR_TOO_LARGE);
    assert_true(integral == 13);
}

/* ---- callbacks ---- */

struct wave {
    int calls, fail_at;
    double bad; /* written instead of the value at that call */
};

/* exp(-t/4) sin 3t with whatever it can give; fails at call fail_at (from 1) */
static int32_t wave_fn(void *context, double t, double out[3])
{
    struct wave *w = context;

    w->calls += 1;
    out[0] = exp(-0.25 * t) * sin(3 * t);
    out[1] = exp(-0.25 * t) * (3 * cos(3 * t) - 0.25 * sin(3 * t));
    out[2] = (3 - exp(-0.25 * t) * (3 * cos(3 * t) + 0.25 * sin(3 * t))) / 9.0625;
    if (w->calls == w->fail_at) out[0] = out[1] = out[2] = w->bad;
    return 0;
}

static int32_t value_only(void *context, double t, double out[3])
{
    (void)context;
    out[0] = exp(-0.25 * t) * sin(3 * t);
    return 0;
}

static int32_t refuses(void *context, double t, double out[3])
{
    (void)context;
    out[0] = t;
    return 7;
}

static int32_t writes_nothing(void *context, double t, double out[3])
{
    (void)context;
    (void)t;
    (void)out;
    return 0;
}

static void callbacks_agree(void **state)
{
    struct wave w = {0, 0, 0};
    const dmb_segment rich = callback(wave_fn, DMB_PROVIDES_RATE | DMB_PROVIDES_INTEGRAL, &w);
    const dmb_segment poor = callback(value_only, 0, NULL);
    const dmb_time_function a = {&rich, 1}, b = {&poor, 1};
    (void)state;

    for (double t = 0.0; t < 5.0; t += 0.37) {
        assert_true(value_at(&a, t) == value_at(&b, t));
        CHECK_CLOSE(rate_at(&a, t), rate_at(&b, t), 1e-9);
        CHECK_CLOSE(integral_of(&a, 0.0, t), integral_of(&b, 0.0, t), 1e-14);
        CHECK_CLOSE(integral_of(&a, t, t + 1e-3), integral_of(&b, t, t + 1e-3), 1e-15);
    }
    CHECK_CLOSE(integral_of(&b, 0.0, 300.0), integral_of(&a, 0.0, 300.0), 1e-9); /* parts of 0.3 s */
    w.calls = 0;
    (void)value_at(&a, 1.0);
    assert_int_equal(w.calls, 1);
}

static void expect_failure(const dmb_segment *term, int32_t expected)
{
    const dmb_time_function p = {term, 1};
    double value = 11, rate = 12, integral = 13;

    assert_int_equal(dmb_time_function_value(&p, 1.0, &value, &rate), expected);
    assert_int_equal(dmb_time_function_integral(&p, 1.0, 2.0, &integral), expected);
    assert_true(value == 11 && rate == 12 && integral == 13);
}

static void callbacks_that_fail(void **state)
{
    const dmb_segment no = callback(refuses, 0, NULL), silent = callback(writes_nothing, 0, NULL);
    const dmb_segment none = callback(NULL, 0, NULL);
    const dmb_segment short_of = callback(value_only, DMB_PROVIDES_RATE | DMB_PROVIDES_INTEGRAL, NULL);
    const double bad[3] = {(double)NAN, (double)INFINITY, -(double)INFINITY};
    (void)state;

    expect_failure(&no, DMB_ERR_CALLBACK);
    expect_failure(&silent, DMB_ERR_CALLBACK);
    expect_failure(&none, DMB_ERR_CALLBACK);
    expect_failure(&short_of, DMB_ERR_CALLBACK);
    for (int i = 0; i < 3; ++i)
        for (int at = 1; at <= 3; ++at) {
            struct wave w = {0, at, bad[i]};
            const dmb_segment term = callback(wave_fn, 0, &w);
            const dmb_time_function p = {&term, 1};
            double value = 11, rate = 12, integral = 13;
            assert_int_equal(dmb_time_function_value(&p, 1.0, &value, &rate), DMB_ERR_CALLBACK);
            w.calls = 0;
            assert_int_equal(dmb_time_function_integral(&p, 1.0, 2.0, &integral), DMB_ERR_CALLBACK);
            assert_true(value == 11 && rate == 12 && integral == 13);
        }
}

static void nonsense_times(void **state)
{
    const dmb_segment term[2] = {make(DMB_SEGMENT_STEP, 0, 1, 0, 1), table(5)};
    const dmb_time_function p = {term, 2};
    const dmb_segment huge[2] = {make(DMB_SEGMENT_CONSTANT, 0, 1, 1e308, 0),
                                 make(DMB_SEGMENT_CONSTANT, 0, 1, 1e308, 0)};
    const dmb_time_function overflow = {huge, 2};
    double out = 11, rate = 12;
    (void)state;

    assert_int_equal(dmb_time_function_value(&p, (double)NAN, &out, &rate), DMB_ERR_NOT_FINITE);
    assert_int_equal(dmb_time_function_value(&p, (double)INFINITY, &out, &rate), DMB_ERR_NOT_FINITE);
    assert_int_equal(dmb_time_function_integral(&p, 0, (double)NAN, &out), DMB_ERR_NOT_FINITE);
    assert_int_equal(dmb_time_function_value(&overflow, 0, &out, &rate), DMB_ERR_NOT_FINITE);
    assert_int_equal(dmb_time_function_integral(&overflow, 0, 1, &out), DMB_ERR_NOT_FINITE);
    assert_int_equal(dmb_time_function_integral(&p, (double)NAN, 0, &out), DMB_ERR_NOT_FINITE);
    assert_int_equal(dmb_time_function_rate_before(&p, (double)NAN, &rate), DMB_ERR_NOT_FINITE);
    const dmb_segment steep[2] = {make(DMB_SEGMENT_HARMONIC, 0, 1, 0, 1e308),
                                  make(DMB_SEGMENT_HARMONIC, 0, 1, 0, 1e308)};
    dmb_segment fast[2] = {steep[0], steep[1]};
    fast[0].omega = fast[1].omega = 1.5; /* each finite, their sum is not */
    const dmb_time_function rates = {fast, 2};
    assert_int_equal(dmb_time_function_value(&rates, 0, &out, &rate), DMB_ERR_NOT_FINITE);
    assert_int_equal(dmb_time_function_rate_before(&rates, 0, &rate), DMB_ERR_NOT_FINITE);
    const dmb_segment failing = callback(refuses, 0, NULL);
    const dmb_time_function broken = {&failing, 1};
    assert_int_equal(dmb_time_function_rate_before(&broken, 1.0, &rate), DMB_ERR_CALLBACK);
    assert_true(out == 11 && rate == 12);
    assert_true(isinf(dmb_time_function_next_breakpoint(&p, (double)NAN)) ||
                dmb_time_function_next_breakpoint(&p, (double)NAN) == -1.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(step_values),
        cmocka_unit_test(six_stage_feed),
        cmocka_unit_test(rates_against_differences),
        cmocka_unit_test(integrals_against_quadrature),
        cmocka_unit_test(step_antiderivative),
        cmocka_unit_test(small_intervals_far_out),
        cmocka_unit_test(table_values_and_breakpoints),
        cmocka_unit_test(breakpoints_of_a_sum),
        cmocka_unit_test(repeated_table),
        cmocka_unit_test(short_periods_far_out),
        cmocka_unit_test(close_knots_far_out),
        cmocka_unit_test(breakpoints_of_a_repeated_table),
        cmocka_unit_test(swings),
        cmocka_unit_test(swing_of_a_speed),
        cmocka_unit_test(swing_at_breakpoints),
        cmocka_unit_test(endless_swing),
        cmocka_unit_test(callbacks_agree),
        cmocka_unit_test(callbacks_that_fail),
        cmocka_unit_test(nonsense_times),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
