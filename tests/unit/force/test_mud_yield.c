/* Muds with a yield stress: Buckingham and Reiner's pipe in closed form, Herschel and Bulkley's fluid against the
 * integrated flow in pipe and annulus, limits of no yield stress and of no flow, local exponent, turbulence. Equations:
 * eq:mud.pipe-yield, eq:mud.slot, eq:mud.annulus-yield. */
#include <math.h>

#include "check.h"
#include "force/mud_flow.h"

#define PI 3.14159265358979323846

static dmb_mud_flow mud_of(double rate, double consistency, double exponent, double yield_stress)
{
    const dmb_mud_flow flow = {.rate = rate,
                               .consistency = consistency,
                               .exponent = exponent,
                               .yield_stress = yield_stress,
                               .nozzle_area = 3e-4,
                               .inside = 1e-9,
                               .outside = 1e-9};
    return flow;
}

/* Q = pi R^4 G/(8 mu) (1 - 4/3 phi + phi^4/3), phi = tau_y/tau_w (Buckingham 1921; Reiner 1926). */
static void buckingham_and_reiner(void **state)
{
    const double d = 0.06, R = 0.5 * d, mu = 0.02;
    double worst = 0.0;
    (void)state;
    for (int i = 1; i < 100; i++) {
        const double phi = 0.01 * i, yield = 4.0, wall = yield / phi, G = 2.0 * wall / R;
        const double Q = PI * R * R * R * R * G / (8.0 * mu) * (1.0 - 4.0 / 3.0 * phi + pow(phi, 4.0) / 3.0);
        const dmb_mud_flow flow = mud_of(Q, mu, 1.0, yield);
        worst = fmax(worst, fabs(dmb_bore_loss(&flow, d).gradient / G - 1.0));
    }
    check_below("Bingham's fluid in a pipe", worst, 1e-9);
}

/* Integral of f over x from a to b by Simpson's rule in x = b + (a - b) t^2, smooth where f ends as a power at b. */
enum { PANELS = 4000 };
typedef struct shear {
    double zero, yield, n; /* stress |zero/x - x| of G R/2 = 1, R = K = 1 */
    int squared;           /* 1: x^2 times the rate of shear */
} shear;

static double rate_of(const shear *s, double x)
{
    const double over = fabs(s->zero / x - x) - s->yield;
    return (over > 0.0 ? pow(over, 1.0 / s->n) : 0.0) * (s->squared ? x * x : 1.0);
}

static double integral(const shear *s, double a, double b)
{
    double sum = 0.0;
    for (int i = 0; i <= PANELS; i++) {
        const double t = (double)i / PANELS, w = i == 0 || i == PANELS ? 1.0 : i % 2 ? 4.0 : 2.0;
        sum += w * t * rate_of(s, b + (a - b) * t * t);
    }
    return 2.0 * fabs(a - b) * sum / (3.0 * PANELS);
}

/* The plug lies between low and low + yield; the speed there is that from either wall. Returns the rate of flow. */
static double by_integration(double kappa, double n, double yield, double *zero)
{
    double low = kappa, high = 1.0 - yield;
    shear s = {.yield = yield, .n = n};
    for (int i = 0; i < 100; i++) {
        const double middle = 0.5 * (low + high);
        s.zero = middle * (middle + yield);
        if (integral(&s, kappa, middle) > integral(&s, 1.0, middle + yield))
            high = middle;
        else
            low = middle;
    }
    s.squared = 1;
    *zero = s.zero;
    return PI * (integral(&s, 1.0, low + yield) - integral(&s, kappa, low));
}

static void annulus(void **state)
{
    const double kappas[] = {0.3, 0.5, 0.7, 0.9}, exponents[] = {0.2, 0.4, 0.7, 1.0};
    double gradient = 0.0, pull = 0.0;
    (void)state;
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            for (int k = 0; k < 8; k++) {
                const double phis[] = {0.01, 0.05, 0.2, 0.4, 0.6, 0.8, 0.95, 0.99}, kappa = kappas[i];
                double zero;
                const double yield = phis[k] * (1.0 - kappa), Q = by_integration(kappa, exponents[j], yield, &zero);
                const dmb_mud_flow flow = mud_of(Q, 1.0, exponents[j], yield);
                const dmb_flow_loss loss = dmb_annulus_loss(&flow, 2.0 * kappa, 2.0);
                gradient = fmax(gradient, fabs(loss.gradient / 2.0 - 1.0));
                pull = fmax(pull, fabs(loss.pull / (2.0 * PI * zero) - 1.0));
            }
    check_below("loss of an annulus", gradient, 1.1e-3);
    check_below("pull on the pipe", pull, 8e-3);
}

/* V of tau_w by the rule of Rabinowitsch: V = d/(2 tau_w^3) int_0^tau_w tau^2 (rate of shear) dtau. */
static void herschel_bulkley_pipe(void **state)
{
    const double d = 0.05, K = 0.7, yield = 3.0;
    double worst = 0.0;
    (void)state;
    for (int j = 0; j < 4; j++)
        for (int k = 1; k < 10; k++) {
            const double n = 0.2 + 0.25 * j, wall = yield / (0.1 * k);
            double sum = 0.0;
            for (int i = 0; i <= PANELS; i++) {
                const double t = (double)i / PANELS, tau = yield + (wall - yield) * t;
                const double w = i == 0 || i == PANELS ? 1.0 : i % 2 ? 4.0 : 2.0;
                sum += w * tau * tau * pow((tau - yield) / K, 1.0 / n);
            }
            const double V = d / (2.0 * wall * wall * wall) * sum * (wall - yield) / (3.0 * PANELS);
            const dmb_mud_flow flow = mud_of(0.25 * PI * d * d * V, K, n, yield);
            worst = fmax(worst, fabs(dmb_bore_loss(&flow, d).gradient * d / (4.0 * wall) - 1.0));
        }
    check_below("Herschel and Bulkley's fluid in a pipe", worst, 1e-6);
}

static void limits(void **state)
{
    const double d = 0.06, D = 0.1;
    (void)state;
    for (int j = 0; j < 3; j++) {
        const double n = 0.4 + 0.3 * j;
        dmb_mud_flow flow = mud_of(1e-3, 0.4, n, 0.0), yields = mud_of(1e-3, 0.4, n, 1e-9);
        check_relative("pipe as tau_y -> 0", dmb_bore_loss(&yields, d).gradient, dmb_bore_loss(&flow, d).gradient,
                       1e-8);
        check_relative("annulus as tau_y -> 0", dmb_annulus_loss(&yields, d, D).gradient,
                       dmb_annulus_loss(&flow, d, D).gradient, 1e-8);
        flow = mud_of(1e-15, 0.4, n, 5.0);
        check_relative("pipe as Q -> 0", dmb_bore_loss(&flow, d).gradient, 4.0 * 5.0 / d, 2e-2);
        check_relative("annulus as Q -> 0", dmb_annulus_loss(&flow, d, D).gradient, 4.0 * 5.0 / (D - d), 2e-2);
        flow.rate = 0.0;
        assert_true(dmb_bore_loss(&flow, d).gradient <= 0.0 && dmb_annulus_loss(&flow, d, D).gradient <= 0.0);
    }
}

/* The loss grows with the rate through laminar, transitional and turbulent flow, without a jump; in turbulent flow the
 * yield stress matters less than in laminar flow (Metzner, Reed 1955). */
static void turbulent(void **state)
{
    const double d = 0.06, D = 0.1;
    dmb_mud_flow flow = mud_of(0.0, 0.02, 0.9, 5.0), plain = mud_of(0.0, 0.02, 0.9, 0.0);
    double last[2] = {0.0, 0.0};
    (void)state;
    flow.inside = flow.outside = plain.inside = plain.outside = 1200.0;
    for (int i = 0; i < 2000; i++) {
        flow.rate = 1e-5 * pow(10.0, 0.002 * i);
        const double now[2] = {dmb_bore_loss(&flow, d).gradient, dmb_annulus_loss(&flow, d, D).gradient};
        for (int k = 0; k < 2; k++) {
            assert_true(now[k] > last[k]);
            if (i > 0) check_below("growth of the loss over 0.46 % of the rate", now[k] / last[k] - 1.0, 0.03);
            last[k] = now[k];
        }
    }
    plain.rate = flow.rate;
    check_relative("turbulent loss without the yield stress", dmb_bore_loss(&plain, d).gradient,
                   dmb_bore_loss(&flow, d).gradient, 0.1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(buckingham_and_reiner),
        cmocka_unit_test(annulus),
        cmocka_unit_test(herschel_bulkley_pipe),
        cmocka_unit_test(limits),
        cmocka_unit_test(turbulent),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
