/* Laws of the eccentric annulus against the flow itself: a fluid of the power law, div(|grad w|^(n-1) grad w) = -1, by
 * finite volumes in bipolar coordinates, in which the annulus is a rectangle, iterated on its viscosity and
 * extrapolated from two meshes. Newtonian it is the exact law; below, deviations of the correlations are told.
 * Equations: eq:mud.eccentric, eq:mud.eccentric-power. */
#include <stdio.h>
#include <string.h>

#include "check.h"
#include "force/mud_flow.h"

enum { WIDE = 97, HIGH = 49 };

/* Half of the annulus: xi = 0 .. pi around, eta from wall to pipe; w is 0 on both. */
typedef struct annulus {
    int m, n; /* cells around, across */
    double a, eta[2], exponent;
    double w[WIDE][HIGH];
    double around[WIDE][HIGH], across[WIDE][HIGH]; /* viscosity on faces (i + 1/2, j), (i, j + 1/2) */
} annulus;

static annulus grid;
static double band[(size_t)WIDE * HIGH][HIGH], load[(size_t)WIDE * HIGH];

static double metric(const annulus *g, double i, double j)
{
    const double xi = PI * i / g->m, eta = g->eta[0] + (g->eta[1] - g->eta[0]) * j / g->n;
    return g->a / (cosh(eta) - cos(xi));
}

/* R = 1, the axes eps (1 - kappa) apart: radii a/sinh(eta), centres a coth(eta). */
static void lay_out(annulus *g, double kappa, double eps, double exponent, int m)
{
    const double e = eps * (1.0 - kappa), to_wall = (1.0 - kappa * kappa + e * e) / (2.0 * e);
    memset(g, 0, sizeof *g);
    g->m = m;
    g->n = m / 2;
    g->exponent = exponent;
    g->a = sqrt(to_wall * to_wall - 1.0);
    g->eta[0] = asinh(g->a);
    g->eta[1] = asinh(g->a / kappa);
    for (int i = 0; i <= g->m; i++)
        for (int j = 0; j <= g->n; j++) g->around[i][j] = g->across[i][j] = 1.0;
}

static double value(const annulus *g, int i, int j) /* even about xi = 0 and pi */
{
    const int k = i < 0 ? -i : i > g->m ? 2 * g->m - i : i;
    return j < 0 ? -g->w[k][1] : j > g->n ? -g->w[k][g->n - 1] : g->w[k][j];
}

static double viscosity(const annulus *g, double by_xi, double by_eta, double h)
{
    const double rate = sqrt(by_xi * by_xi + by_eta * by_eta) / h;
    return pow(rate + 1e-7, g->exponent - 1.0);
}

static void take_viscosities(annulus *g)
{
    const double dx = PI / g->m, de = (g->eta[1] - g->eta[0]) / g->n;
    for (int i = 0; i <= g->m; i++)
        for (int j = 0; j <= g->n; j++) {
            const double here = value(g, i, j), next = value(g, i + 1, j), up = value(g, i, j + 1);
            const double slope =
                (value(g, i, j + 1) - value(g, i, j - 1) + value(g, i + 1, j + 1) - value(g, i + 1, j - 1)) /
                (4.0 * de);
            const double turn =
                (value(g, i + 1, j) - value(g, i - 1, j) + value(g, i + 1, j + 1) - value(g, i - 1, j + 1)) /
                (4.0 * dx);
            g->around[i][j] = viscosity(g, (next - here) / dx, slope, metric(g, i + 0.5, j));
            g->across[i][j] = viscosity(g, turn, (up - here) / de, metric(g, i, j + 0.5));
        }
}

/* Unknowns column by column; band[r][k] couples r with r - k. Cells at xi = 0 and pi are halves. */
static void assemble(const annulus *g)
{
    const double dx = PI / g->m, de = (g->eta[1] - g->eta[0]) / g->n;
    const int rows = g->n - 1;
    memset(band, 0, sizeof band);
    for (int i = 0; i <= g->m; i++)
        for (int j = 1; j < g->n; j++) {
            const int r = i * rows + j - 1;
            const double wide = i == 0 || i == g->m ? 0.5 : 1.0, h = metric(g, i, j);
            const double down = wide * g->across[i][j - 1] * dx / de, up = wide * g->across[i][j] * dx / de;
            band[r][0] += down + up;
            if (j > 1) band[r][1] -= down;
            load[r] = wide * dx * de * h * h;
            if (i == 0) continue;
            const double side = g->around[i - 1][j] * de / dx;
            band[r][0] += side;
            band[r - rows][0] += side;
            band[r][rows] -= side;
        }
}

/* Cholesky of the band, then both substitutions. */
static void solve(annulus *g)
{
    const int rows = g->n - 1, count = (g->m + 1) * rows;
    for (int r = 0; r < count; r++)
        for (int k = r < rows ? r : rows; k >= 0; k--) {
            double sum = band[r][k];
            for (int q = k + 1; q <= rows && q <= r; q++) sum -= band[r][q] * band[r - k][q - k];
            band[r][k] = k > 0 ? sum / band[r - k][0] : sqrt(sum);
        }
    for (int r = 0; r < count; r++) {
        for (int k = 1; k <= rows && k <= r; k++) load[r] -= band[r][k] * load[r - k];
        load[r] /= band[r][0];
    }
    for (int r = count - 1; r >= 0; r--) {
        load[r] /= band[r][0];
        for (int k = 1; k <= rows && k <= r; k++) load[r - k] -= band[r][k] * load[r];
    }
    for (int r = 0; r < count; r++) g->w[r / rows][r % rows + 1] = load[r];
}

/* [-] of R = K = G = 1: rate Q, and pull of the mud on the pipe, pi times the gap less the drag of the wall. */
static void flow_of(double kappa, double eps, double n, int m, double out[2])
{
    annulus *g = &grid;
    double last = 0.0;
    lay_out(g, kappa, eps, n, m);
    const double dx = PI / g->m, de = (g->eta[1] - g->eta[0]) / g->n;
    for (int pass = 0; pass < 200; pass++) {
        assemble(g);
        solve(g);
        take_viscosities(g);
        out[0] = out[1] = 0.0;
        for (int i = 0; i <= g->m; i++)
            for (int j = 1; j < g->n; j++) {
                const double h = metric(g, i, j);
                out[0] += (i == 0 || i == g->m ? 1.0 : 2.0) * g->w[i][j] * h * h * dx * de;
            }
        if (fabs(out[0] - last) < 1e-9 * out[0]) break;
        last = out[0];
    }
    /* wall: what flows out of the first row of faces, and the mud between it and the wall */
    double drag = 0.0;
    for (int i = 0; i <= g->m; i++) {
        const double wide = i == 0 || i == g->m ? 1.0 : 2.0, h = metric(g, i, 0.25);
        drag += wide * dx * (g->across[i][0] * g->w[i][1] / de + 0.5 * de * h * h);
    }
    out[1] = PI - drag; /* shear on the pipe and G pi kappa^2 */
}

/* Deviations of the library's G at that rate, and of its pull over G, from the flow's. */
static void deviations(double kappa, double eps, double n, double out[2])
{
    double coarse[2], fine[2];
    flow_of(kappa, eps, n, 48, coarse);
    flow_of(kappa, eps, n, 96, fine);
    for (int i = 0; i < 2; i++) fine[i] += (fine[i] - coarse[i]) / 3.0;
    const dmb_mud_flow flow = {
        .rate = fine[0], .consistency = 1.0, .exponent = n, .eccentricity = eps, .outside = 1e-9, .inside = 1e-9};
    const dmb_flow_loss loss = dmb_annulus_loss(&flow, 2.0 * kappa, 2.0);
    out[0] = loss.gradient - 1.0;
    out[1] = loss.pull / loss.gradient / fine[1] - 1.0;
}

static void newtonian_is_exact(void **state)
{
    static const double at[3][2] = {{0.5, 0.3}, {0.5, 0.8}, {0.8, 0.6}};
    (void)state;
    for (int i = 0; i < 3; i++) {
        double off[2];
        deviations(at[i][0], at[i][1], 1.0, off);
        check_below("gradient, Newtonian", fabs(off[0]), 1e-5);
        check_below("    pull", fabs(off[1]), 1e-5);
    }
}

static void correlations_are_near(void **state)
{
    static const double kappas[3] = {0.3, 0.5, 0.8}, exponents[3] = {0.4, 0.6, 0.8}, eccentric[3] = {0.3, 0.6, 0.9};
    double worst[2] = {0.0, 0.0};
    (void)state;
    for (int k = 0; k < 3; k++)
        for (int p = 0; p < 3; p++)
            for (int q = 0; q < 3; q++) {
                char name[80];
                double off[2];
                deviations(kappas[k], eccentric[q], exponents[p], off);
                (void)snprintf(name, sizeof name, "kappa %g, n %g, eps %g: gradient", kappas[k], exponents[p],
                               eccentric[q]);
                tell(name, off[0]);
                tell("    pull over gradient", off[1]);
                for (int i = 0; i < 2; i++) worst[i] = fmax(worst[i], fabs(off[i]));
            }
    check_below("largest deviation of the gradient", worst[0], 0.026);
    check_below("largest deviation of the pull over the gradient", worst[1], 0.005);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(newtonian_is_exact),
        cmocka_unit_test(correlations_are_near),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
