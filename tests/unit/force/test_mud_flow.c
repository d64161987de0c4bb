/* Losses of mud that flows and its pull on the pipe: Poiseuille's flow in closed form, the power law against an
 * integration of the speed across the annulus, turbulent friction against the formulas of API RP 13D. */
#include <math.h>

#include "check.h"
#include "force/mud_flow.h"
#include "ode.h"

#define PI 3.14159265358979323846

static dmb_mud_flow flow_of(double rate, double consistency, double exponent, double density)
{
    const dmb_mud_flow flow = {.rate = rate,
                               .consistency = consistency,
                               .exponent = exponent,
                               .nozzle_area = 3e-4,
                               .inside = density,
                               .outside = density};
    return flow;
}

static void poiseuille(void **state)
{
    const double mu = 0.05, r = 0.0365, R = 0.047, k = r / R, Q = 1e-4;
    const dmb_mud_flow flow = flow_of(Q, mu, 1.0, 1.0);
    const dmb_flow_loss annulus = dmb_annulus_loss(&flow, 2.0 * r, 2.0 * R), bore = dmb_bore_loss(&flow, 0.06);
    /* Bird, Stewart, Lightfoot 2002, eq. 2.4-16 and the slope of 2.4-14 at the inner wall */
    const double G = Q * 8.0 * mu / (PI * R * R * R * R * ((1.0 - pow(k, 4.0)) - pow(1.0 - k * k, 2.0) / log(1.0 / k)));
    const double shear = 0.25 * G * (R * R * (1.0 - k * k) / log(1.0 / k) / r - 2.0 * r);
    (void)state;
    check_relative("loss of Poiseuille's annulus [Pa/m]", annulus.gradient, G, 1e-12);
    check_relative("pull, shear on the pipe and pressure on what it displaces [N/m]", annulus.pull,
                   2.0 * PI * r * shear + PI * r * r * G, 1e-12);
    check_relative("loss of Poiseuille's pipe [Pa/m]", bore.gradient, 128.0 * mu * Q / (PI * pow(0.06, 4.0)), 1e-12);
    check_relative("its Reynolds number", bore.reynolds, 4.0 * Q / (PI * 0.06 * mu), 1e-12);
}

/* Speed and flux by the radius, with the shear stress G/2 (lambda^2/x - x). */
typedef struct profile {
    double G, K, n, zero;
} profile;

static void across(void *context, double x, const double *y, double *rate)
{
    const profile *p = context;
    const double stress = 0.5 * p->G * (p->zero * p->zero / x - x);
    rate[0] = (stress > 0.0 ? 1.0 : -1.0) * pow(fabs(stress) / p->K, 1.0 / p->n);
    rate[1] = 2.0 * PI * x * y[0];
}

static void check_power_law(double n, double k)
{
    const double R = 0.05, K = 0.4, Q = 1e-3;
    const dmb_mud_flow flow = flow_of(Q, K, n, 1e-6);
    const dmb_flow_loss loss = dmb_annulus_loss(&flow, 2.0 * k * R, 2.0 * R);
    profile p = {loss.gradient, K, n, R * dmb_annulus_zero_shear(n, k)};
    double y[2] = {0.0, 0.0};
    ode_solve(across, &p, k * R, p.zero, 2000, 2, y);
    const double fastest = y[0];
    ode_solve(across, &p, p.zero, R, 2000, 2, y);
    check_below("speed at the wall over the largest", fabs(y[0]) / fastest, 1e-8);
    check_relative("rate of flow across the annulus", y[1], Q, 1e-8);
    check_relative("pull", loss.pull, PI * p.zero * p.zero * loss.gradient, 1e-12);
}

static void power_law(void **state)
{
    (void)state;
    for (int i = 1; i <= 4; i++)
        for (int j = 1; j <= 3; j++) check_power_law(0.25 * i, 0.3 * j);
    const double n = 0.6, d = 0.06, Q = 1e-3, K = 0.5, V = 4.0 * Q / (PI * d * d);
    const dmb_mud_flow flow = flow_of(Q, K, n, 1e-6);
    check_relative("power law in a pipe [Pa/m]", dmb_bore_loss(&flow, d).gradient,
                   4.0 * K / d * pow((3.0 * n + 1.0) / (4.0 * n) * 8.0 * V / d, n), 1e-12);
}

static double api(double n, double re)
{
    const double a = (log10(n) + 3.93) / 50.0, b = (1.75 - log10(n)) / 7.0;
    const double transition = 16.0 * re / pow(3470.0 - 1370.0 * n, 2.0), turbulent = a * pow(re, -b);
    const double f = pow(pow(transition, -8.0) + pow(turbulent, -8.0), -0.125);
    return pow(pow(f, 12.0) + pow(16.0 / re, 12.0), 1.0 / 12.0);
}

static void turbulent(void **state)
{
    const double d = 0.06, D = 0.1, rho = 1200.0;
    double before = 0.0;
    (void)state;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 9; j++) {
            const double n = 0.4 + 0.3 * i, Q = 1e-4 * ldexp(1.0, j);
            const dmb_mud_flow flow = flow_of(Q, 0.01, n, rho);
            const dmb_flow_loss bore = dmb_bore_loss(&flow, d), annulus = dmb_annulus_loss(&flow, d, D);
            const double V = 4.0 * Q / (PI * d * d), W = 4.0 * Q / (PI * (D * D - d * d));
            check_relative("f of the pipe", bore.gradient * d / (2.0 * rho * V * V), api(n, bore.reynolds), 1e-11);
            check_relative("f of the annulus", annulus.gradient * (D - d) / (2.0 * rho * W * W),
                           api(n, annulus.reynolds), 1e-11);
            assert_true(j == 0 || annulus.pull > before); /* more flow, more pull */
            before = annulus.pull;
        }
    const dmb_mud_flow fast = flow_of(0.1, 0.01, 1.0, rho);
    const dmb_flow_loss bore = dmb_bore_loss(&fast, 0.2), annulus = dmb_annulus_loss(&fast, d, D);
    check_relative("Blasius' friction factor", bore.gradient * 0.2 / (2.0 * rho * pow(0.4 / (PI * 0.04), 2.0)),
                   0.0791 * pow(bore.reynolds, -0.25), 0.01);
    const double x = sqrt(annulus.pull / (PI * annulus.gradient)) / (0.5 * D), k = d / D;
    check_relative("zero shear of Kays and Leung", (x - k) / (1.0 - x), pow(k, 0.343), 1e-3);
}

static void nozzles(void **state)
{
    dmb_mud_flow flow = flow_of(0.01, 0.01, 1.0, 1100.0);
    (void)state;
    check_relative("loss [Pa]", dmb_nozzle_loss(&flow), 1100.0 * 1e-4 / (2.0 * 0.9025 * 9e-8), 1e-14);
    check_relative("thrust [N]", dmb_nozzle_thrust(&flow), 1100.0 * 1e-4 / 3e-4, 1e-14);
    flow.open = 1;
    assert_true(dmb_nozzle_loss(&flow) == 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(poiseuille),
        cmocka_unit_test(power_law),
        cmocka_unit_test(turbulent),
        cmocka_unit_test(nozzles),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
