/* Normal laws: every law is integrated through a contact, m d'' = -F, with a fine Runge-Kutta step. Equations:
 * eq:contact.normal, eq:contact.factors, eq:contact.exact, eq:contact.kelvin-voigt, eq:touch.moments, eq:touch.weights,
 * eq:touch.time. */
#include "force/normal_law.h"

#include "force_test.h"
#include "restitution.h"

static double force_at(const dmb_normal_law *law, double depth, double rate, double approach)
{
    double force, d_depth, d_rate;

    dmb_normal_force(law, depth, rate, approach, &force, &d_depth, &d_rate);
    return force;
}

struct contact {
    double out;       /* [m/s] speed of leaving, > 0 */
    double deepest;   /* [m] */
    double strongest; /* [N] */
    double duration;  /* [s] */
};

/* One Runge-Kutta step of d' = v, v' = pull - F(d, v)/m; past the surface the law gives 0, as it should. */
static void advance(const dmb_normal_law *law, double m, double pull, double v0, double h, double *d, double *v)
{
    const double k1 = pull - force_at(law, *d, *v, v0) / m, v1 = *v;
    const double v2 = *v + 0.5 * h * k1, k2 = pull - force_at(law, *d + 0.5 * h * v1, v2, v0) / m;
    const double v3 = *v + 0.5 * h * k2, k3 = pull - force_at(law, *d + 0.5 * h * v2, v3, v0) / m;
    const double v4 = *v + h * k3, k4 = pull - force_at(law, *d + h * v3, v4, v0) / m;

    *d += h / 6 * (v1 + 2 * v2 + 2 * v3 + v4);
    *v += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
}

/* The same with d as the variable, to end exactly at the surface: dv/dd = v'/v, dt/dd = 1/v (Henon 1982). */
static void finish(const dmb_normal_law *law, double m, double pull, double v0, double d, double *v, double *t)
{
    const double h = -d;
    const double k1 = (pull - force_at(law, d, *v, v0) / m) / *v;
    const double v2 = *v + 0.5 * h * k1, k2 = (pull - force_at(law, d + 0.5 * h, v2, v0) / m) / v2;
    const double v3 = *v + 0.5 * h * k2, k3 = (pull - force_at(law, d + 0.5 * h, v3, v0) / m) / v3;
    const double v4 = *v + h * k3, k4 = (pull - force_at(law, 0.0, v4, v0) / m) / v4;

    *t += h / 6 * (1 / *v + 2 / v2 + 2 / v3 + 1 / v4);
    *v += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
}

static struct contact integrate(const dmb_normal_law *law, double m, double pull, double v0, double h)
{
    struct contact c = {0, 0, 0, 0};
    double d = 0.0, v = v0, t = 0.0;

    for (;;) {
        double next_d = d, next_v = v;
        advance(law, m, pull, v0, h, &next_d, &next_v);
        if (v > 0 && next_v <= 0) { /* deepest point: parabola through the step */
            const double a = (next_v - v) / h;
            c.deepest = d - 0.5 * v * v / a;
            c.strongest = force_at(law, c.deepest, 0.0, v0);
        }
        if (next_d <= 0) break;
        d = next_d;
        v = next_v;
        t += h;
    }
    finish(law, m, pull, v0, d, &v, &t);
    c.out = -v;
    c.duration = t;
    return c;
}

/* Step that resolves an undamped contact of m = 1 with about 3000 points. */
static double fine_step(const dmb_normal_law *law, double v0)
{
    const double n = law->exponent;
    const double deepest = pow(0.5 * (n + 1) * v0 * v0 / law->stiffness, 1 / (n + 1));

    return 1e-3 * deepest / v0;
}

static dmb_normal_law law_of(int32_t kind, double stiffness, double exponent, double restitution)
{
    dmb_normal_law law;

    law = dmb_normal_law_of((dmb_normal_law){.kind = kind,
                                             .stiffness = stiffness,
                                             .exponent = exponent,
                                             .damping = 0.0,
                                             .impact_depth = 1e-4,
                                             .impact_floor = 1e-6},
                            restitution);
    return law;
}

/* Restitution given by every law at every asked one, n = 1 and 1.5 (and 2.2 through pow), speeds .01 .. 10. */
static void restitution_curves(void **state)
{
    static const double asked[] = {0.1, 0.3, 0.5, 0.7, 0.9, 1.0};
    static const double exponents[] = {1.0, 1.5, 2.2};
    static const double speeds[] = {0.01, 0.1, 1.0, 10.0};
    (void)state;

    for (int32_t kind = DMB_NORMAL_HUNT_CROSSLEY; kind <= DMB_NORMAL_EXACT; ++kind)
        for (int i = 0; i < 6; ++i)
            for (int j = 0; j < 12; ++j) {
                const dmb_normal_law law = law_of(kind, 1e7, exponents[j / 4], asked[i]);
                const double v0 = speeds[j % 4];
                const struct contact c = integrate(&law, 1.0, 0.0, v0, fine_step(&law, v0));
                CHECK_CLOSE(c.out / v0, restitution_of(law.mu), 1e-6);
                if (kind == DMB_NORMAL_EXACT) CHECK_CLOSE(c.out / v0, asked[i], 1e-6);
            }
}

/* Restitution by the factor of Lankarani and Nikravesh, and the exact factors. */
static void restitution_table(void **state)
{
    static const double e[5] = {0.1, 0.3, 0.5, 0.7, 0.9};
    static const double mu[5] = {9.99815940, 3.08708198, 1.43275053, 0.63482828, 0.16648195};
    (void)state;

    CHECK_CLOSE(restitution_of(law_of(DMB_NORMAL_LANKARANI_NIKRAVESH, 1, 1, 0.5).mu), 0.725, 5e-4);
    CHECK_CLOSE(restitution_of(law_of(DMB_NORMAL_LANKARANI_NIKRAVESH, 1, 1, 0.1).mu), 0.665, 5e-4);
    for (int i = 0; i < 5; ++i) {
        CHECK_CLOSE(dmb_exact_restitution_factor(e[i]), mu[i], 5.1e-9);
        CHECK_CLOSE(restitution_of(mu[i]), e[i], 1e-8);
        CHECK_CLOSE(law_of(DMB_NORMAL_HUNT_CROSSLEY, 1, 1, e[i]).mu, 1.5 * (1 - e[i]), 1e-15);
        CHECK_CLOSE(law_of(DMB_NORMAL_LANKARANI_NIKRAVESH, 1, 1, e[i]).mu, 0.75 * (1 - e[i] * e[i]), 1e-15);
        CHECK_CLOSE(law_of(DMB_NORMAL_FLORES, 1, 1, e[i]).mu, 1.6 * (1 - e[i]) / e[i], 2e-15);
    }
}

/* Root of (1) in extended precision, polished from a double. */
static double factor_reference(double e, double start)
{
    const long double el = (long double)e;
    long double mu = (long double)start;

    for (int i = 0; i < 8; ++i) {
        const long double f = log1pl(mu) - log1pl(-mu * el) - mu * (1 + el);
        const long double slope = 1 / (1 + mu) + el / (1 - mu * el) - (1 + el);
        mu -= f / slope;
    }
    return (double)mu;
}

static void exact_factor_accuracy(void **state)
{
    (void)state;
    for (double e = 0.03; e < 0.985; e += 0.0037) {
        const double mu = dmb_exact_restitution_factor(e);
        CHECK_RELATIVE(mu, factor_reference(e, mu), 1.5e-15);
        CHECK_RELATIVE(restitution_of(mu), e, 1e-15);
    }
    for (double gap = 1e-1; gap > 1e-14; gap *= 0.31) { /* e = 1 - gap: mu = 3/2 gap (1 + gap + ...) */
        const double e = 1.0 - gap;
        const double mu = dmb_exact_restitution_factor(e);
        CHECK_RELATIVE(mu, 1.5 * (1.0 - e) * (2.0 - e), 2.0 * gap * gap + 1e-15);
        CHECK_RELATIVE(1.0 - restitution_of(mu), 1.0 - e, 1e-15 / gap + 1e-15);
    }
    for (double e = 0.03; e > 1e-6; e *= 0.5) { /* 1 - mu e is below round-off */
        CHECK_RELATIVE(dmb_exact_restitution_factor(e), 1.0 / e, 2e-13);
        CHECK_RELATIVE(restitution_of(dmb_exact_restitution_factor(e)), e, 1e-15);
    }
    assert_true(dmb_exact_restitution_factor(1.0) == 0.0 && dmb_exact_restitution_factor(2.0) == 0.0);
    assert_true(restitution_of(0.0) == 1.0 && restitution_of(-1.0) == 1.0);
    CHECK_RELATIVE(dmb_exact_restitution_factor(0.0), 1e6, 1e-12);
    CHECK_RELATIVE(dmb_exact_restitution_factor(-1.0), 1e6, 1e-12);
    CHECK_RELATIVE(dmb_exact_restitution_factor((double)NAN), 1e6, 1e-12);
}

/* Sphere on a half space, K = 4/3 E* sqrt(R), 1/E* = 2 (1 - nu^2)/E (Hertz 1882; Johnson 1985, ch. 11) */
static void hertz_sphere(void **state)
{
    const double stiffness = 4.0 / 3.0 * 210e9 / (2 * (1 - 0.09)) * sqrt(0.05);
    const dmb_normal_law law = law_of(DMB_NORMAL_HUNT_CROSSLEY, stiffness, 1.5, 1.0);
    const struct contact c = integrate(&law, 1.0, 0.0, 1.0, 2e-8);
    (void)state;

    CHECK_RELATIVE(c.deepest, 6.67014611e-5, 1e-7);
    CHECK_RELATIVE(c.strongest, 18740.2192, 1e-7);
    CHECK_RELATIVE(c.duration, 1.96320755e-4, 1e-6);
    CHECK_CLOSE(c.out, 1.0, 1e-7);
    CHECK_RELATIVE(dmb_normal_energy(&law, c.deepest), 0.5, 1e-7);
}

static void impact_function(void **state)
{
    dmb_normal_law law;
    (void)state;

    law = dmb_normal_law_of((dmb_normal_law){.kind = DMB_NORMAL_IMPACT,
                                             .stiffness = 1e8,
                                             .exponent = 1.5,
                                             .damping = 1e4,
                                             .impact_depth = 1e-4,
                                             .impact_floor = 0.01},
                            0.0);
    const struct contact c = integrate(&law, 1.0, 0.0, 1.0, 1e-8);
    CHECK_RELATIVE(c.out, 0.016359349, 1e-4);
    CHECK_RELATIVE(c.deepest, 1.44118e-4, 1e-4);
    /* STEP(d; 0, 0, impact_depth, c): half the damping at half the depth, all of it beyond */
    CHECK_RELATIVE(force_at(&law, 5e-5, 0.1, 1), 1e8 * pow(5e-5, 1.5) + 0.5e4 * 0.1, 1e-14);
    CHECK_RELATIVE(force_at(&law, 2e-4, 0.1, 1), 1e8 * pow(2e-4, 1.5) + 1e4 * 0.1, 1e-14);
}

/* Kelvin-Voigt, K d + c d', is a damped oscillator until the force would pull: with w = sqrt(K/m), z = c/(2 m w) that
 * is at w_d t = pi - 2 acos(z)... = atan2(2 z sqrt(1-z^2), 2 z^2 - 1), where the speed is v0 exp(-z w t). */
static void kelvin_voigt(void **state)
{
    const double zeta = 0.2, omega = 1e3;
    dmb_normal_law law;
    (void)state;

    law = dmb_normal_law_of((dmb_normal_law){.kind = DMB_NORMAL_KELVIN_VOIGT,
                                             .stiffness = omega * omega,
                                             .exponent = 1.0,
                                             .damping = 2 * zeta * omega,
                                             .impact_depth = 1e-4,
                                             .impact_floor = 0.01},
                            0.0);
    const struct contact c = integrate(&law, 1.0, 0.0, 1.0, 1e-7);
    const double angle = atan2(2 * zeta * sqrt(1 - zeta * zeta), 2 * zeta * zeta - 1);
    CHECK_CLOSE(c.out, exp(-zeta / sqrt(1 - zeta * zeta) * angle), 1e-5);
    assert_true(force_at(&law, 1e-9, -1.0, 1.0) == 0.0);
}

/* ---- Touch within a step ------------------------------------------------------------------------------------------
 */

/* Steps of these lengths, the contact closing in the first, before which part of it; weights w of the damping at their
 * ends. */
static void weights_of(const double *h, int count, double closed, double *w)
{
    double kept[DMB_TOUCH_SIZE] = {0.0}, before = closed - 1.0, depth = closed;
    for (int i = 0; i < count; ++i) {
        double next[DMB_TOUCH_SIZE] = {0.0};
        dmb_normal_touch touch;
        dmb_normal_touch_at(before, depth, h[i], kept, &touch, next);
        memcpy(kept, next, sizeof kept);
        w[i] = touch.weight;
        before = depth;
    }
}

/* The trapezoidal rule over the weights takes as long as the contact was closed, and a step more counts from its
 * beginning; in equal steps so does the time about which it acts. */
static void touch_keeps_the_impulse(void **state)
{
    static const double equal[6] = {1.0, 1.0, 1.0, 1.0, 1.0, 1.0}, unequal[6] = {1.0, 0.4, 0.7, 1.3, 0.9, 0.9};
    (void)state;
    for (int k = 0; k < 2; ++k)
        for (double closed = 0.01; closed < 1.0; closed += 0.07) {
            const double *h = k ? unequal : equal;
            double w[6], sum = 0.0, time = 0.0, moment = 0.0, end = 0.0, last = 0.0;
            weights_of(h, 6, closed, w);
            for (int i = 0; i < 6; ++i) {
                sum += 0.5 * h[i] * (last + w[i]);
                /* centre of what is straight between two ends */
                moment += 0.5 * h[i] * (last * (end + h[i] / 3.0) + w[i] * (end + 2.0 * h[i] / 3.0));
                end += h[i];
                last = w[i];
                time += h[i];
            }
            CHECK_CLOSE(w[5], 1.0, 1e-14);
            CHECK_CLOSE(sum, time - (1.0 - closed), 1e-14);
            if (k == 0) CHECK_CLOSE(moment, 0.5 * (time * time - (1.0 - closed) * (1.0 - closed)), 1e-13);
        }
}

/* A touch at the very end of a step and one at the very beginning of the next have the same weights. */
static void touch_does_not_jump(void **state)
{
    static const double h[6] = {1.0, 1.0, 1.0, 1.0, 1.0, 1.0};
    double early[6], late[6];
    (void)state;
    weights_of(h, 6, 1e-12, early);
    weights_of(h, 6, 1.0 - 1e-12, late);
    CHECK_CLOSE(early[0], 0.0, 1e-11);
    for (int i = 0; i < 5; ++i) CHECK_CLOSE(early[i + 1], late[i], 1e-11);
}

/* Behind a step that is a thousand times longer the weight has its bound, and what is missing comes later. */
static void touch_before_short_steps(void **state)
{
    double h[4000], w[4000], sum = 0.0, last = 0.0;
    (void)state;
    for (int i = 0; i < 4000; ++i) h[i] = i == 0 ? 1.0 : 1e-3;
    weights_of(h, 4000, 0.9, w);
    for (int i = 0; i < 4000; ++i) {
        assert_true(w[i] >= 0.0 && w[i] <= DMB_TOUCH_MOST);
        sum += 0.5 * h[i] * (last + w[i]);
        last = w[i];
    }
    CHECK_CLOSE(sum, 0.9 + 3.999, 1e-12);
}

static void touch_derivative(void **state)
{
    const double kept[DMB_TOUCH_SIZE] = {0.0}, d = 1e-6;
    (void)state;
    for (double depth = 0.05; depth < 2.0; depth += 0.1) {
        double next[DMB_TOUCH_SIZE];
        dmb_normal_touch low, at, high;
        dmb_normal_touch_at(-0.7, depth - d, 0.1, kept, &low, next);
        dmb_normal_touch_at(-0.7, depth, 0.1, kept, &at, next);
        dmb_normal_touch_at(-0.7, depth + d, 0.1, kept, &high, next);
        CHECK_RELATIVE(at.by_depth, (high.weight - low.weight) / (2.0 * d), 1e-8);
    }
}

/* Dropped from 1 m with e = .8: flight in closed form, contact integrated with gravity. */
static void bouncing_ball(void **state)
{
    const double g = 9.81, e = 0.8;
    const dmb_normal_law law = law_of(DMB_NORMAL_EXACT, 1e12, 1.0, e);
    double t = sqrt(2 / g), v = sqrt(2 * g);
    (void)state;

    CHECK_CLOSE(t, 0.451523640986, 1e-12);
    for (int n = 1; v > 2e-3; ++n) {
        const struct contact c = integrate(&law, 1.0, g, v, fine_step(&law, v));
        v = c.out;
        if (n <= 20) CHECK_RELATIVE(v * v / (2 * g), pow(e, 2.0 * n), 1e-3);
        t += c.duration + 2 * v / g;
    }
    t += 2 * v / g * e / (1 - e); /* the rest of the geometric series */
    CHECK_RELATIVE(t, 4.063712768872, 1e-3);
}

static void derivatives(void **state)
{
    uint64_t seed = 99;
    (void)state;

    for (int i = 0; i < 6000; ++i) {
        dmb_normal_law law;
        const double exponents[4] = {1.0, 1.5, 2.0, 2.7};
        law = dmb_normal_law_of((dmb_normal_law){.kind = i % 6,
                                                 .stiffness = 1e7,
                                                 .exponent = exponents[i / 6 % 4],
                                                 .damping = 2e3,
                                                 .impact_depth = 1e-4,
                                                 .impact_floor = 0.01},
                                draw(&seed, 0.1, 1));
        const double d = draw(&seed, 2e-6, 2.5e-4), rate = draw(&seed, -0.5, 0.5), v0 = draw(&seed, 0, 1);
        double force, d_depth, d_rate;
        dmb_normal_force(&law, d, rate, v0, &force, &d_depth, &d_rate);
        if (force == 0.0) {
            assert_true(d_depth == 0.0 && d_rate == 0.0);
            continue;
        }
        const double h = 1e-10, k = 1e-6;
        if (fabs(d - law.impact_depth) < h || force < fabs(d_rate) * k + fabs(d_depth) * h) continue;
        const double by_depth = (force_at(&law, d + h, rate, v0) - force_at(&law, d - h, rate, v0)) / (2 * h);
        const double by_rate = (force_at(&law, d, rate + k, v0) - force_at(&law, d, rate - k, v0)) / (2 * k);
        CHECK_CLOSE(d_depth, by_depth, 1e-6 * fabs(by_depth) + 1e-5 * force / d);
        CHECK_CLOSE(d_rate, by_rate, 1e-6 * fabs(by_rate) + 1e-8 * force);
    }
}

static void energy_is_the_work(void **state)
{
    const double exponents[3] = {1.0, 1.5, 2.2};
    (void)state;

    for (int i = 0; i < 3; ++i) {
        const dmb_normal_law law = law_of(DMB_NORMAL_HUNT_CROSSLEY, 3e7, exponents[i], 1.0);
        const double d = 2e-4, h = 1e-8;
        const double slope = (dmb_normal_energy(&law, d + h) - dmb_normal_energy(&law, d - h)) / (2 * h);
        CHECK_RELATIVE(slope, force_at(&law, d, 0.0, 1.0), 1e-7);
        assert_true(dmb_normal_energy(&law, 0.0) == 0.0 && dmb_normal_energy(&law, -1.0) == 0.0);
    }
}

/* ---- Mean force of a step ---------------------------------------------------------------------------------------- */

static const int32_t kinds[] = {DMB_NORMAL_KELVIN_VOIGT, DMB_NORMAL_HUNT_CROSSLEY, DMB_NORMAL_EXACT, DMB_NORMAL_IMPACT};
static const double places[] = {-3e-4, -1e-5,  0.0, 2e-5,
                                9e-5,  1.1e-4, 4e-4}; /* [m] from and to, on both sides of touch */
enum { KINDS = sizeof kinds / sizeof kinds[0], PLACES = sizeof places / sizeof places[0] };

static dmb_normal_law mean_law(int32_t kind, double exponent, double damping)
{
    const dmb_normal_law law = {.kind = kind,
                                .stiffness = 1e7,
                                .exponent = exponent,
                                .damping = damping,
                                .impact_depth = 1e-4,
                                .impact_floor = 1e-3};
    return dmb_normal_law_of(law, 0.4);
}

static dmb_normal_mean mean_of(const dmb_normal_law *law, double from, double to, double h)
{
    dmb_normal_mean mean;
    const dmb_local_normal local = dmb_local_normal_of(law);
    dmb_normal_mean_at(&local, from, to, 0.5, 0, h, &mean);
    return mean;
}

/* Without damping it takes from the bodies what the wall stores; with damping never less. It never pulls. */
static void mean_force_is_that_of_the_energy(void **state)
{
    (void)state;
    for (int n = 0; n < 3; n++)
        for (int a = 0; a < PLACES; a++)
            for (int b = 0; b < PLACES; b++) {
                const dmb_normal_law bare = mean_law(DMB_NORMAL_KELVIN_VOIGT, 1.0 + 0.5 * n, 0.0);
                const double rise = dmb_normal_energy(&bare, places[b]) - dmb_normal_energy(&bare, places[a]);
                const dmb_normal_mean elastic = mean_of(&bare, places[a], places[b], 1e-3);
                CHECK_CLOSE(elastic.force * (places[b] - places[a]), rise, 1e-12 * (fabs(rise) + 1e-12));
                for (int k = 0; k < KINDS; k++) {
                    const dmb_normal_law law = mean_law(kinds[k], 1.0 + 0.5 * n, 200.0);
                    const dmb_normal_mean mean = mean_of(&law, places[a], places[b], 1e-3);
                    assert_true(mean.force >= 0.0);
                    assert_true(mean.taken >= -1e-12 * fabs(rise));
                    CHECK_CLOSE(mean.taken, mean.force * (places[b] - places[a]) - rise, 1e-12 * fabs(rise) + 1e-20);
                }
            }
}

/* Over a way that is slow for the step it is the force of the law in the middle: to the square of the way. */
static void mean_force_of_a_short_way(void **state)
{
    const double d = 2e-4, h = 1e-3;
    (void)state;
    for (int k = 0; k < KINDS; k++)
        for (double way = 1e-6; way > 1e-15; way *= 1e-3) {
            const dmb_normal_law law = mean_law(kinds[k], 1.5, 200.0);
            const double middle = force_at(&law, d + 0.5 * way, way / h, 0.5);
            CHECK_CLOSE(mean_of(&law, d, d + way, h).force, middle, middle * (way / d * way / d + 1e-6));
        }
}

static void mean_force_derivative(void **state)
{
    (void)state;
    for (int k = 0; k < KINDS; k++)
        for (int n = 0; n < 3; n++)
            for (int a = 0; a < PLACES; a++)
                for (int b = 0; b < PLACES; b++) {
                    const double to = places[b] + 3e-6, e = 1e-9;
                    const dmb_normal_law law = mean_law(kinds[k], 1.0 + 0.5 * n, 200.0);
                    const dmb_normal_mean at = mean_of(&law, places[a], to, 1e-3);
                    const double low = mean_of(&law, places[a], to - e, 1e-3).force;
                    const double slope = (mean_of(&law, places[a], to + e, 1e-3).force - low) / (2.0 * e);
                    CHECK_CLOSE(at.d_depth, slope, 1e-5 * fabs(slope) + 1e-3);
                }
}

static void no_contact_and_nonsense(void **state)
{
    (void)state;
    for (int32_t kind = DMB_NORMAL_NONE; kind <= DMB_NORMAL_IMPACT + 1; ++kind) {
        dmb_normal_law law;
        double force, d_depth, d_rate;
        law = dmb_normal_law_of((dmb_normal_law){.kind = kind,
                                                 .stiffness = 1e7,
                                                 .exponent = 1.5,
                                                 .damping = 1e3,
                                                 .impact_depth = 1e-4,
                                                 .impact_floor = 0.0},
                                0.5);
        for (int i = 0; i < 2; ++i) {
            dmb_normal_force(&law, i == 0 ? 0.0 : -1e-3, 5.0, 1.0, &force, &d_depth, &d_rate);
            assert_true(force == 0.0 && d_depth == 0.0 && d_rate == 0.0);
        }
        dmb_normal_force(&law, 1e-5, -1e9, 1.0, &force, &d_depth, &d_rate);
        assert_true(force == 0.0 && d_depth == 0.0 && d_rate == 0.0);
        dmb_normal_force(&law, 1e-5, 0.0, 0.0, &force, &d_depth, &d_rate); /* v0 = 0 */
        assert_true(isfinite(force) && isfinite(d_depth) && isfinite(d_rate));
        dmb_normal_force(&law, (double)NAN, 0.0, 1.0, &force, &d_depth, &d_rate);
        assert_true(law.kind == DMB_NORMAL_NONE ? force == 0.0 : isnan(force));
        law = dmb_normal_law_of((dmb_normal_law){.kind = kind,
                                                 .stiffness = 1e7,
                                                 .exponent = 1.5,
                                                 .damping = 1e3,
                                                 .impact_depth = 0.0,
                                                 .impact_floor = 0.01},
                                0.0); /* e = 0, impact depth 0 */
        dmb_normal_force(&law, 1e-5, 0.1, 0.0, &force, &d_depth, &d_rate);
        assert_true(isfinite(force) && isfinite(d_depth) && isfinite(d_rate));
    }
}

/* d mu/d e against differences; at the floor of e, below which mu goes on with e alone, on both sides; nothing for the
 * laws without a factor, nor for EXACT where it is held. */
static void slopes_of_the_factor(void **state)
{
    static const double e[6] = {0.05, 0.2, 0.5, 0.6, 0.8, 0.99};
    (void)state;
    for (int32_t kind = DMB_NORMAL_HUNT_CROSSLEY; kind <= DMB_NORMAL_EXACT; ++kind)
        for (int i = 0; i < 6; ++i) {
            const double h = 1e-5 * e[i],
                         mid = dmb_normal_factor_slope(&(dmb_normal_law){.kind = DMB_NORMAL_NONE}, e[i]);
            const dmb_normal_law at = law_of(kind, 1, 1, e[i]);
            const double slope = (law_of(kind, 1, 1, e[i] + h).mu - law_of(kind, 1, 1, e[i] - h).mu) / (2.0 * h);
            CHECK_CLOSE(dmb_normal_factor_slope(&at, e[i]), slope, 1e-8 * fabs(slope));
            CHECK_CLOSE(mid, 0.0, 0.0);
        }
    const double below = 4e-7, h = 1e-8; /* the floor is 1e-6 */
    const dmb_normal_law flores = law_of(DMB_NORMAL_FLORES, 1, 1, below), exact = law_of(DMB_NORMAL_EXACT, 1, 1, below);
    const double slope =
        (law_of(DMB_NORMAL_FLORES, 1, 1, below + h).mu - law_of(DMB_NORMAL_FLORES, 1, 1, below - h).mu) / (2.0 * h);
    CHECK_CLOSE(dmb_normal_factor_slope(&flores, below), slope, 1e-3 * fabs(slope));
    CHECK_CLOSE(dmb_normal_factor_slope(&exact, below), 0.0, 0.0);
    CHECK_CLOSE(law_of(DMB_NORMAL_EXACT, 1, 1, below).mu, law_of(DMB_NORMAL_EXACT, 1, 1, 0.5 * below).mu, 0.0);
    const dmb_normal_law full = law_of(DMB_NORMAL_EXACT, 1, 1, 1.0);
    CHECK_CLOSE(full.mu, 0.0, 0.0);
    CHECK_CLOSE(dmb_normal_factor_slope(&full, 1.0), 0.0, 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(restitution_curves),
        cmocka_unit_test(restitution_table),
        cmocka_unit_test(slopes_of_the_factor),
        cmocka_unit_test(exact_factor_accuracy),
        cmocka_unit_test(hertz_sphere),
        cmocka_unit_test(impact_function),
        cmocka_unit_test(kelvin_voigt),
        cmocka_unit_test(touch_keeps_the_impulse),
        cmocka_unit_test(touch_does_not_jump),
        cmocka_unit_test(touch_before_short_steps),
        cmocka_unit_test(touch_derivative),
        cmocka_unit_test(mean_force_is_that_of_the_energy),
        cmocka_unit_test(mean_force_of_a_short_way),
        cmocka_unit_test(mean_force_derivative),
        cmocka_unit_test(bouncing_ball),
        cmocka_unit_test(derivatives),
        cmocka_unit_test(energy_is_the_work),
        cmocka_unit_test(no_contact_and_nonsense),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
