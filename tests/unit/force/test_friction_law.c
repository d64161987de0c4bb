/* Friction laws: formulas, exact tangents, and small simulations with an implicit trapezoidal step. Equations:
 * eq:friction.smooth, eq:friction.stribeck, eq:friction.ambrosio, eq:friction.bristle, eq:friction.projection. */
#include "force/friction_law.h"

#include "force_test.h"

/* The bristles of a law whose coefficients are those of the whole hole. */
static int32_t bristle_of(const dmb_friction_law *law, double N, const double v[2], const double z_old[2],
                          const double v_old[2], int stuck, double h, double z[2], double F[2], double *dF_dv,
                          double dF_dN[2])
{
    const dmb_local_friction local = dmb_local_friction_of(law);
    return dmb_friction_bristle(&local, N, v, z_old, v_old, stuck, h, z, F, dF_dv, dF_dN);
}

static dmb_friction_law law_of(int32_t kind, double mu_static, double mu_dynamic)
{
    dmb_friction_law law;

    memset(&law, 0, sizeof law);
    law.kind = kind;
    law.mu_static = mu_static;
    law.mu_dynamic = mu_dynamic;
    law.stribeck_speed = 1e-2;
    law.smoothing_speed = 1e-3;
    law.full_speed = 1e-2;
    law.bristle_stiffness = 1e4;
    return dmb_friction_law_of(law);
}

static void smooth_force(const dmb_friction_law *law, double N, const double v[2], double F[2])
{
    double dF_dv[4], dF_dN[2];

    dmb_friction_smooth(law, N, v, F, dF_dv, dF_dN);
}

/* ---- smooth laws ---- */

/* Friction over normal force at speed v > 0 by eq:friction.peak, in two parts that are 1 at the peak, whose kappa is
 * found by trying all speeds. */
static double peaked(const dmb_friction_law *law, double v)
{
    const double eps = law->smoothing_speed, r = v / hypot(v, eps), y = r * exp(-hypot(v, eps) / law->stribeck_speed);
    double most = 0.0;
    for (double x = 1e-3 * eps; x < 1e3 * eps; x *= 1.0001)
        most = fmax(most, x / hypot(x, eps) * exp(-hypot(x, eps) / law->stribeck_speed));
    const double level = 1.0 - (1.0 - r) * (1.0 - pow(y / most, 4)), bump = y + (1.0 - most) * pow(y / most, 4);
    return law->mu_dynamic * level + (law->mu_static - law->mu_dynamic) * bump;
}

static void smooth_formulas(void **state)
{
    const double v[2] = {3e-3, -4e-3}; /* |v| = 5e-3 */
    const double s = sqrt(26e-6);
    double F[2];
    (void)state;

    const dmb_friction_law coulomb = law_of(DMB_FRICTION_COULOMB, 0.35, 0.3);
    smooth_force(&coulomb, 100, v, F);
    CHECK_RELATIVE(F[0], -0.3 * 100 * 3e-3 / s, 1e-15);
    CHECK_RELATIVE(F[1], 0.3 * 100 * 4e-3 / s, 1e-15);
    const dmb_friction_law stribeck = law_of(DMB_FRICTION_STRIBECK, 0.35, 0.3);
    smooth_force(&stribeck, 100, v, F);
    CHECK_RELATIVE(F[0], -peaked(&stribeck, 5e-3) * 100 * 0.6, 1e-7);
    CHECK_RELATIVE(F[1], peaked(&stribeck, 5e-3) * 100 * 0.8, 1e-7);
    dmb_friction_law as_smoothed = stribeck;
    as_smoothed.peak_bump = as_smoothed.peak_level = 0.0;
    smooth_force(&as_smoothed, 100, v, F);
    CHECK_RELATIVE(F[0], -(0.3 + 0.05 * exp(-s / 1e-2)) * 100 * 3e-3 / s, 1e-15);
    const dmb_friction_law bristle = law_of(DMB_FRICTION_BRISTLE, 0.35, 0.3);
    double G[2]; /* slides on the curve itself */
    smooth_force(&bristle, 100, v, G);
    assert_true(G[0] == F[0] && G[1] == F[1]);
    const dmb_friction_law ambrosio = law_of(DMB_FRICTION_AMBROSIO, 0.35, 0.3);
    smooth_force(&ambrosio, 100, v, F); /* (5e-3 - 1e-3)/(1e-2 - 1e-3) of the way */
    CHECK_RELATIVE(F[0], -0.3 * 100 * 4.0 / 9.0 * 0.6, 1e-14);
    const double slow[2] = {0, 1e-3}, fast[2] = {0, 2};
    smooth_force(&ambrosio, 100, slow, F);
    assert_true(F[0] == 0.0 && F[1] == 0.0);
    smooth_force(&ambrosio, 100, fast, F);
    CHECK_RELATIVE(F[1], -30, 1e-15);
}

/* Axial speed 0.05 m/s, 200 rpm on a 73 mm pipe: the axial share of the friction. */
static void direction(void **state)
{
    const double v[2] = {0.05, 200 * 2 * PI / 60 * 0.0365};
    const dmb_friction_law smooth = law_of(DMB_FRICTION_COULOMB, 0.3, 0.3);
    dmb_friction_law law = law_of(DMB_FRICTION_BRISTLE, 0.35, 0.3);
    double F[2], dF_dv[4], dF_dN[2], z[2] = {1e-5, -2e-5};
    int32_t sticks = 0;
    (void)state;

    smooth_force(&smooth, 100, v, F);
    CHECK_CLOSE(-F[0] / sqrt(F[0] * F[0] + F[1] * F[1]), 0.06526669, 5e-9);
    CHECK_RELATIVE(sqrt(F[0] * F[0] + F[1] * F[1]), 30, 1e-6);
    for (int i = 0; i < 200; ++i) {
        const double z_old[2] = {z[0], z[1]};
        sticks = bristle_of(&law, 100, v, z_old, v, sticks != 0, 1e-4, z, F, dF_dv, dF_dN);
    }
    CHECK_CLOSE(-F[0] / sqrt(F[0] * F[0] + F[1] * F[1]), 0.06526669, 5e-9);
    CHECK_RELATIVE(sqrt(F[0] * F[0] + F[1] * F[1]), 30, 1e-14);
    assert_int_equal(sticks, 0);
    law.bristle_damping = 2.0; /* no part of it is left in steady sliding */
    sticks = bristle_of(&law, 100, v, z, v, 0, 1e-4, z, F, dF_dv, dF_dN);
    CHECK_CLOSE(-F[0] / sqrt(F[0] * F[0] + F[1] * F[1]), 0.06526669, 5e-9);
    CHECK_RELATIVE(sqrt(F[0] * F[0] + F[1] * F[1]), 30, 1e-14);
}

static void smooth_tangents(void **state)
{
    uint64_t seed = 4242;
    (void)state;

    for (int i = 0; i < 4000; ++i) {
        const dmb_friction_law law = law_of(i % 4, 0.4, 0.25);
        const double scale = pow(10, draw(&seed, -4, 0));
        const double v[2] = {draw(&seed, -scale, scale), draw(&seed, -scale, scale)};
        const double N = draw(&seed, 1, 500), h = 1e-6 * fmax(scale, 1e-3);
        const double speed = hypot(v[0], v[1]);
        double F[2], above[2], below[2], dF_dv[4], dF_dN[2];
        dmb_friction_smooth(&law, N, v, F, dF_dv, dF_dN);
        if (law.kind == DMB_FRICTION_AMBROSIO && (fabs(speed - 1e-3) < 2 * h || fabs(speed - 1e-2) < 2 * h))
            continue; /* corners of the law */
        for (int j = 0; j < 2; ++j) {
            const double w[2] = {v[0] + (j == 0 ? h : 0), v[1] + (j == 1 ? h : 0)};
            const double u[2] = {v[0] - (j == 0 ? h : 0), v[1] - (j == 1 ? h : 0)};
            smooth_force(&law, N, w, above);
            smooth_force(&law, N, u, below);
            for (int k = 0; k < 2; ++k) CHECK_CLOSE(dF_dv[2 * k + j], (above[k] - below[k]) / (2 * h), 1e-5 * N);
        }
        for (int k = 0; k < 2; ++k) CHECK_CLOSE(dF_dN[k] * N, F[k], 1e-13 * N);
    }
}

/* ---- table (eq:friction.table) ---- */

static const double table_speed[] = {0.0, 0.07, 0.08, 0.5}, table_mu[] = {0.5, 0.5, 0.24, 0.3};

static dmb_friction_law table_law(int32_t kind, double mu_dynamic)
{
    dmb_friction_law law = law_of(kind, mu_dynamic * 0.5 / 0.3, mu_dynamic);
    law.points = 4;
    law.table_speed = table_speed;
    law.table_mu = table_mu;
    return dmb_friction_law_of(law);
}

/* Static until 0.07 m/s; halves of all coefficients where mu_dynamic is half the last one; the bristle law slides on
 * the same curve and breaks away at the static coefficient. */
static void table_values(void **state)
{
    static const double at[][2] = {{0.03, 0.5}, {0.075, 0.37}, {0.29, 0.27}, {0.5, 0.3}, {9.0, 0.3}};
    (void)state;

    for (int i = 0; i < 5; i++) {
        const double v[2] = {0.6 * at[i][0], -0.8 * at[i][0]}, far[2] = {1, 1};
        dmb_friction_law law = table_law(DMB_FRICTION_STRIBECK, 0.3);
        double F[2], dF_dv[4], dF_dN[2], z[2];
        law.smoothing_speed = 0.0;
        law = dmb_friction_law_of(law);
        smooth_force(&law, 100, v, F);
        CHECK_RELATIVE(hypot(F[0], F[1]), 100 * at[i][1], 1e-14);
        assert_true(F[0] * v[0] + F[1] * v[1] < 0.0);
        law = table_law(DMB_FRICTION_STRIBECK, 0.15);
        law.smoothing_speed = 0.0;
        law = dmb_friction_law_of(law);
        smooth_force(&law, 100, v, F);
        CHECK_RELATIVE(hypot(F[0], F[1]), 50 * at[i][1], 1e-14);
        law = table_law(DMB_FRICTION_BRISTLE, 0.3);
        (void)bristle_of(&law, 100, v, far, v, 0, 1e-3, z, F, dF_dv, dF_dN);
        CHECK_RELATIVE(hypot(F[0], F[1]), 100 * at[i][1], 1e-14);
        (void)bristle_of(&law, 100, v, far, v, 1, 1e-3, z, F, dF_dv, dF_dN);
        CHECK_RELATIVE(hypot(F[0], F[1]), 50, 1e-14);
    }
}

/* Against differences, but at the corners; the power is never positive. */
static void table_tangents(void **state)
{
    uint64_t seed = 77;
    int checked = 0;
    (void)state;

    for (int i = 0; i < 4000; ++i) {
        const dmb_friction_law law = table_law(DMB_FRICTION_STRIBECK, 0.3);
        const double scale = pow(10, draw(&seed, -4, 0)), h = 1e-6 * fmax(scale, 1e-3);
        const double v[2] = {draw(&seed, -scale, scale), draw(&seed, -scale, scale)},
                     s = hypot(hypot(v[0], v[1]), 1e-3);
        double F[2], above[2], below[2], dF_dv[4], dF_dN[2];
        dmb_friction_smooth(&law, 10, v, F, dF_dv, dF_dN);
        assert_true(F[0] * v[0] + F[1] * v[1] <= 0.0);
        if (fabs(s - 0.07) < 2 * h || fabs(s - 0.08) < 2 * h || fabs(s - 0.5) < 2 * h) continue;
        for (int j = 0; j < 2; ++j, ++checked) {
            const double w[2] = {v[0] + (j == 0 ? h : 0), v[1] + (j == 1 ? h : 0)};
            const double u[2] = {v[0] - (j == 0 ? h : 0), v[1] - (j == 1 ? h : 0)};
            smooth_force(&law, 10, w, above);
            smooth_force(&law, 10, u, below);
            for (int k = 0; k < 2; ++k) CHECK_CLOSE(dF_dv[2 * k + j], (above[k] - below[k]) / (2 * h), 1e-4);
        }
    }
    assert_true(checked > 7900);
}

/* The falling branch is negative damping and stays in the tangent. */
static void falling_branch(void **state)
{
    const dmb_friction_law smooth = law_of(DMB_FRICTION_STRIBECK, 0.35, 0.3);
    const dmb_friction_law bristle = law_of(DMB_FRICTION_BRISTLE, 0.35, 0.3);
    const double v[2] = {1e-2, 0}, z_old[2] = {1, 0};
    const double expected = 100 * 0.05 / 1e-2 * exp(-1.0);
    double F[2], dF_dv[4], dF_dN[2], z[2];
    (void)state;

    dmb_friction_smooth(&smooth, 100, v, F, dF_dv, dF_dN);
    const double curve = 0.3 + 0.05 * exp(-hypot(1e-2, 1e-3) / 1e-2), f0 = curve / hypot(1.0, 0.1);
    CHECK_CLOSE(F[0], -100.0 * (f0 + 0.00115), 100.0 * 2e-4);
    assert_true(dF_dv[0] > 0.8 * expected && dF_dv[0] < 1.15 * expected);
    (void)bristle_of(&bristle, 100, v, z_old, v, 0, 1e-3, z, F, dF_dv, dF_dN);
    CHECK_RELATIVE(dF_dv[0], expected, 1e-14);
    CHECK_RELATIVE(F[0], -100 * (0.3 + 0.05 * exp(-1.0)), 1e-14);
}

static void rest_and_nonsense(void **state)
{
    const double zero[2] = {0, 0};
    (void)state;

    for (int32_t kind = DMB_FRICTION_NONE; kind <= DMB_FRICTION_BRISTLE; ++kind)
        for (int i = 0; i < 4; ++i) {
            dmb_friction_law law = law_of(kind, 0.35, 0.3);
            double F[2], dF_dv[4], dF_dN[2], z[2];
            int32_t sticks;
            if (i == 1) law.smoothing_speed = 0.0;
            if (i == 2) law.mu_static = law.mu_dynamic = 0.0;
            law = dmb_friction_law_of(law);
            dmb_friction_smooth(&law, i == 3 ? 0.0 : 50.0, zero, F, dF_dv, dF_dN);
            assert_true(F[0] == 0.0 && F[1] == 0.0 && dF_dN[0] == 0.0 && dF_dN[1] == 0.0);
            assert_true(isfinite(dF_dv[0]) && isfinite(dF_dv[1]) && isfinite(dF_dv[2]) && isfinite(dF_dv[3]));
            sticks = bristle_of(&law, i == 3 ? 0.0 : 50.0, zero, zero, zero, i % 2 != 0, 1e-3, z, F, dF_dv, dF_dN);
            assert_true(F[0] == 0.0 && F[1] == 0.0 && z[0] == 0.0 && z[1] == 0.0 && sticks == 1);
            assert_true(isfinite(dF_dv[0]) && isfinite(dF_dv[1]) && isfinite(dF_dv[2]) && isfinite(dF_dv[3]));
            const double far[2] = {1e-3, -1e-3}; /* beyond the limit, at rest */
            sticks = bristle_of(&law, 50.0, zero, far, zero, i % 2 != 0, 0.0, z, F, dF_dv, dF_dN);
            CHECK_CLOSE(hypot(F[0], F[1]), 50.0 * law.mu_static, 1e-13);
            const double fast[2] = {7.2, 1e-300};
            dmb_friction_smooth(&law, 50.0, fast, F, dF_dv, dF_dN);
            assert_true(isfinite(F[0]) && isfinite(F[1]) && isfinite(dF_dv[0]));
        }
    const dmb_friction_law none = law_of(DMB_FRICTION_NONE, 0.35, 0.3);
    const double v[2] = {1, 1}, bad[2] = {(double)NAN, 0};
    double F[2];
    smooth_force(&none, 50, v, F);
    assert_true(F[0] == 0.0 && F[1] == 0.0);
    const dmb_friction_law coulomb = law_of(DMB_FRICTION_COULOMB, 0.35, 0.3);
    smooth_force(&coulomb, 50, bad, F);
    assert_true(isnan(F[0]));
}

/* ---- bristle ---- */

struct bristle_case {
    dmb_friction_law law;
    double N, h, z_old[2], v_old[2];
    int32_t stuck;
};

static int32_t bristle_force(const struct bristle_case *c, double N, const double v[2], double F[2])
{
    double z[2], dF_dv[4], dF_dN[2];
    int32_t sticks;

    sticks = bristle_of(&c->law, N, v, c->z_old, c->v_old, c->stuck, c->h, z, F, dF_dv, dF_dN);
    return sticks;
}

/* Consistent tangents in sticking, sliding and between, with and without damping. */
static void bristle_tangents(void **state)
{
    uint64_t seed = 31;
    int stuck = 0, checked = 0;
    (void)state;

    for (int i = 0; i < 8000; ++i) {
        struct bristle_case c = {law_of(DMB_FRICTION_BRISTLE, 0.4, i % 3 == 0 ? 0.4 : 0.25),
                                 draw(&seed, 1, 500),
                                 1e-3,
                                 {draw(&seed, -5e-5, 5e-5), draw(&seed, -5e-5, 5e-5)},
                                 {draw(&seed, -0.02, 0.02), draw(&seed, -0.02, 0.02)},
                                 i % 4 == 0};
        const double v[2] = {draw(&seed, -0.03, 0.03), draw(&seed, -0.03, 0.03)}, k = 1e-8;
        double z[2], F[2], dF_dv[4], dF_dN[2], above[2], below[2];
        int32_t sticks;
        c.law.bristle_damping = i % 2 == 0 ? 0.0 : 8.0;
        c.h = i % 5 == 0 ? 0.0 : 1e-3;
        sticks = bristle_of(&c.law, c.N, v, c.z_old, c.v_old, c.stuck != 0, c.h, z, F, dF_dv, dF_dN);
        stuck += sticks;
        assert_true(hypot(F[0], F[1]) <= c.N * 0.4 * (1 + 1e-14));
        for (int j = 0; j < 2; ++j) {
            const double w[2] = {v[0] + (j == 0 ? k : 0), v[1] + (j == 1 ? k : 0)};
            const double u[2] = {v[0] - (j == 0 ? k : 0), v[1] - (j == 1 ? k : 0)};
            if (bristle_force(&c, c.N, w, above) != bristle_force(&c, c.N, u, below))
                continue; /* a circle in between */
            ++checked;
            for (int m = 0; m < 2; ++m) CHECK_CLOSE(dF_dv[2 * m + j], (above[m] - below[m]) / (2 * k), 2e-5 * c.N);
        }
        (void)bristle_force(&c, c.N + 1.0, v, above);
        for (int m = 0; m < 2; ++m) CHECK_CLOSE(dF_dN[m], above[m] - F[m], 1e-12);
    }
    assert_in_range(stuck, 800, 7200);
    assert_true(checked > 15000);
}

/* No jump anywhere as v sweeps through breakaway, damping included. */
static void bristle_is_continuous(void **state)
{
    struct bristle_case c = {law_of(DMB_FRICTION_BRISTLE, 0.4, 0.25), 100, 1e-3, {3.5e-5, 1e-5}, {0, 0}, 0};
    double last[2] = {0, 0};
    (void)state;

    for (int i = 0; i < 4; ++i) {
        c.law.bristle_damping = i % 2 != 0 ? 5.0 : 0.0;
        c.stuck = i / 2;
        for (int k = 0; k <= 400000; ++k) {
            const double v[2] = {-0.1 + 5e-7 * k, 1e-3};
            double F[2];
            (void)bristle_force(&c, c.N, v, F);
            if (k > 0) assert_true(hypot(F[0] - last[0], F[1] - last[1]) < 0.02);
            last[0] = F[0];
            last[1] = F[1];
        }
    }
}

/* From sticking the limit is mu_static, at any speed of loading; sliding obeys the Stribeck curve. */
static void breaks_away_at_static(void **state)
{
    const dmb_friction_law law = law_of(DMB_FRICTION_BRISTLE, 0.35, 0.3);
    double z[2], F[2], dF_dv[4], dF_dN[2];
    int32_t sticks = 1;
    (void)state;

    for (double speed = 1e-6; speed < 0.05; speed *= 10.0) {
        const double v[2] = {speed, 0}, h = 1.0001e-8 / speed;
        z[0] = z[1] = 0.0;
        sticks = 1;
        for (int i = 0; i < 3600; ++i) {
            const double z_old[2] = {z[0], z[1]};
            sticks = bristle_of(&law, 1, v, z_old, v, sticks != 0, h, z, F, dF_dv, dF_dN);
            const double limit = i == 3499 ? 0.35 : 0.3 + 0.05 * exp(-speed / 1e-2);
            CHECK_CLOSE(-F[0], i < 3499 ? (i + 1) * 1.0001e-4 : limit, 1e-12);
            assert_int_equal(sticks, i < 3499);
        }
    }
    for (double speed = 1e-3; speed < 0.2; speed *= 1.5) {
        const double v[2] = {speed, 0}, z_old[2] = {z[0], z[1]};
        sticks = bristle_of(&law, 1, v, z_old, v, sticks != 0, 1.0, z, F, dF_dv, dF_dN);
        CHECK_CLOSE(-F[0], 0.3 + 0.05 * exp(-speed / 1e-2), 1e-15);
        assert_int_equal(sticks, 0);
    }
}

/* Over a closed path the work done on friction is never negative: elastic energy comes back, no more. */
static void bristle_dissipates(void **state)
{
    uint64_t seed = 5;
    (void)state;

    for (int damped = 0; damped < 2; ++damped) {
        dmb_friction_law law = law_of(DMB_FRICTION_BRISTLE, 0.35, 0.35);
        law.bristle_damping = damped != 0 ? 1.0 : 0.0;
        double v_old[2] = {0, 0}, F_old[2] = {0, 0}, z[2] = {0, 0}, F[2], dF_dv[4], dF_dN[2], work = 0.0;
        int32_t sticks = 0;
        for (int i = 0; i < 20000; ++i) {
            const double h = 1e-4, z_old[2] = {z[0], z[1]};
            const double v[2] = {v_old[0] + draw(&seed, -0.02, 0.02), 0.99 * v_old[1] + draw(&seed, -0.02, 0.02)};
            sticks = bristle_of(&law, 10, v, z_old, v_old, sticks != 0, h, z, F, dF_dv, dF_dN);
            const double mean_F[2] = {0.5 * (F[0] + F_old[0]), 0.5 * (F[1] + F_old[1])};
            const double mean_v[2] = {0.5 * (v[0] + v_old[0]), 0.5 * (v[1] + v_old[1])};
            const double stored = 0.5 * 10 * law.bristle_stiffness * (z[0] * z[0] + z[1] * z[1]);
            work -= h * (mean_F[0] * mean_v[0] + mean_F[1] * mean_v[1]);
            assert_true(work >= stored - 1e-9 - 1e-3 * stored);
            for (int k = 0; k < 2; ++k) {
                v_old[k] = v[k];
                F_old[k] = F[k];
            }
        }
        assert_true(work > 0.0);
    }
}

/* ---- one degree of freedom ---- */

struct slider {
    double mass, spring, belt_speed, push; /* m x'' = push + spring (belt_speed t - x) + friction */
    double N;
    dmb_friction_law law;
    double x, v, z, F, t;
    int32_t sticks;
};

static double friction_at(const struct slider *s, double v, double h, double *z, double *slope, int32_t *sticks)
{
    const double v2[2] = {v, 0}, z_old[2] = {s->z, 0}, v_old[2] = {s->v, 0};
    double z2[2] = {0, 0}, F[2], dF_dv[4], dF_dN[2];

    *sticks = 0;
    if (s->law.kind == DMB_FRICTION_BRISTLE)
        *sticks = bristle_of(&s->law, s->N, v2, z_old, v_old, s->sticks, h, z2, F, dF_dv, dF_dN);
    else
        dmb_friction_smooth(&s->law, s->N, v2, F, dF_dv, dF_dN);
    *z = z2[0];
    *slope = dF_dv[0];
    return F[0];
}

/* Trapezoidal rule, Newton for the speed at the end. */
static void step(struct slider *s, double h)
{
    const double pull0 = s->push + s->spring * (s->belt_speed * s->t - s->x);
    double v = s->v, x = s->x, z = s->z, F = s->F, slope;
    int32_t sticks = 0;

    for (int i = 0; i < 50; ++i) {
        F = friction_at(s, v, h, &z, &slope, &sticks);
        x = s->x + 0.5 * h * (s->v + v);
        const double pull = s->push + s->spring * (s->belt_speed * (s->t + h) - x);
        const double residual = s->mass * (v - s->v) - 0.5 * h * (pull0 + s->F + pull + F);
        const double dv = -residual / (s->mass + 0.25 * h * h * s->spring - 0.5 * h * slope);
        v += dv;
        if (fabs(dv) <= 1e-15 * (1.0 + fabs(v))) break;
    }
    s->F = friction_at(s, v, h, &z, &slope, &sticks);
    s->x += 0.5 * h * (s->v + v);
    s->v = v;
    s->z = z;
    s->sticks = sticks;
    s->t += h;
}

/* mu .3, v0 2: stops after v0/(mu g) = .679578661 s and m. */
static void slider_stops(void **state)
{
    (void)state;
    for (int bristle = 0; bristle < 2; ++bristle) {
        struct slider s = {
            1, 0, 0, 0, 9.81, law_of(bristle != 0 ? DMB_FRICTION_BRISTLE : DMB_FRICTION_COULOMB, 0.3, 0.3),
            0, 2, 0, 0, 0,    0};
        s.law.smoothing_speed = 1e-6;
        s.law.bristle_stiffness = 1e6;
        s.law.bristle_damping = 600.0;
        s.z = 0.3 / s.law.bristle_stiffness; /* sliding already */
        s.F = -0.3 * 9.81;
        while (s.v > 1e-2) step(&s, 1e-5);
        CHECK_CLOSE(s.t + s.v / (0.3 * 9.81), 0.679578661, 1e-8);
        CHECK_CLOSE(s.x + s.v * s.v / (2 * 0.3 * 9.81), 0.679578661, 1e-8);
        double stop = 0.0;
        while (s.t < 1.0) {
            step(&s, 1e-5);
            stop = fabs(s.v) > 1e-5 ? s.t : stop;
        }
        CHECK_CLOSE(s.x, 0.679578661, 1e-5);
        if (bristle != 0) {
            assert_int_equal(s.sticks, 1);
            CHECK_CLOSE(stop, 0.679578661, 4e-3); /* settles elastically */
            CHECK_CLOSE(s.v, 0.0, 1e-15);
        }
    }
}

/* 20-degree incline, mu .4: slides to a stop and then does not creep; the smoothed law does. */
static void incline_sticks(void **state)
{
    const double slope = 20 * PI / 180;
    struct slider s = {1, 0, 0, 9.81 * sin(slope), 9.81 * cos(slope), law_of(DMB_FRICTION_BRISTLE, 0.4, 0.4), 0, 0.1, 0,
                       0, 0, 0};
    (void)state;

    s.law.bristle_damping = 20.0;
    while (s.t < 5.0) step(&s, 1e-3);
    const double resting = s.x;
    assert_int_equal(s.sticks, 1);
    while (s.t < 105.0) step(&s, 1e-3);
    assert_int_equal(s.sticks, 1);
    CHECK_CLOSE(s.x, resting, 1e-15);
    CHECK_CLOSE(-s.F, 9.81 * sin(slope), 1e-12);

    struct slider creeping = s;
    creeping.law.kind = DMB_FRICTION_COULOMB;
    step(&creeping, 1e-3);
    const double from = creeping.x;
    while (creeping.t < 106.0) step(&creeping, 1e-3);
    assert_true(creeping.x - from > 1e-3);
}

/* A load that never reaches the limit, back and forth thousands of times, does not move the stuck slider. */
static void no_ratchet(void **state)
{
    struct slider s = {1, 0, 0, 0, 100, law_of(DMB_FRICTION_BRISTLE, 0.35, 0.3), 0, 0, 0, 0, 0, 0};
    (void)state;

    s.law.bristle_damping = 5.0;
    for (int i = 0; i < 200000; ++i) {
        s.push = 20 + 10 * sin(0.05 * i);
        step(&s, 1e-3);
    }
    s.push = 20;
    for (int i = 0; i < 20000; ++i) step(&s, 1e-3);
    CHECK_CLOSE(s.x, 20.0 / (100 * 1e4), 1e-15);
}

struct cycle {
    double slip, stick, period, peak;
};

/* Last full stick-slip cycle of a wheel of inertia .5 dragged through a torsion spring of 73 at 5 rad/s. A cycle begins
 * when the speed rises through `threshold`. */
static struct cycle stick_slip(const dmb_friction_law *law, double h, double threshold)
{
    struct slider s = {0.5, 73, 5, 0, 1, *law, 0, 0, 0, 0, 0, 0};
    struct cycle c = {0, 0, 0, 0};
    double start = 0.0, end = 0.0, peak = 0.0;
    int cycles = 0;

    while (cycles < 4 && s.t < 6.0) {
        const double before = s.v;
        step(&s, h);
        const double at = s.t - h * (s.v - threshold) / (s.v - before);
        peak = fmax(peak, s.v);
        if (before < threshold && s.v >= threshold) {
            c.stick = at - end;
            c.period = at - start;
            c.slip = end - start;
            c.peak = peak;
            start = at;
            peak = 0.0;
            ++cycles;
        } else if (before >= threshold && s.v < threshold) {
            end = at;
        }
    }
    return c;
}

/* J .5, k 73, Om 5, Ts 300, Tk 200 (exact: torque jumps from Ts to Tk at breakaway) */
static void stick_slip_cycle(void **state)
{
    dmb_friction_law law = law_of(DMB_FRICTION_BRISTLE, 300, 200);
    (void)state;

    law.stribeck_speed = 3e-4;
    law.bristle_stiffness = 3e7;
    law.bristle_damping = 6e3;
    const struct cycle bristle = stick_slip(&law, 2e-6, 1e-2);
    CHECK_RELATIVE(bristle.period, 0.8565026271, 5e-5);
    CHECK_RELATIVE(bristle.slip, 0.3085574216, 5e-4); /* counted above 1e-2 rad/s */
    CHECK_RELATIVE(bristle.stick, 0.5479452055, 5e-4);
    CHECK_RELATIVE(bristle.peak, 22.2908242354, 5e-5);

    dmb_friction_law smooth = law_of(DMB_FRICTION_STRIBECK, 300, 200);
    smooth.stribeck_speed = 3e-2;
    smooth.smoothing_speed = 2e-5;
    smooth = dmb_friction_law_of(smooth);
    const struct cycle once = stick_slip(&smooth, 3e-6, 0.1);
    smooth.smoothing_speed = 1e-5;
    smooth = dmb_friction_law_of(smooth);
    const struct cycle twice = stick_slip(&smooth, 3e-6, 0.1);
    CHECK_RELATIVE(twice.period, 0.8565026271, 1e-2);
    CHECK_RELATIVE(twice.peak, 22.2908242354, 1e-2);
    CHECK_RELATIVE(twice.period, once.period, 1e-2);
}

/* The largest force of a smoothed law over N = 1, at speeds up to 10 v_eps and from 0.001 to 1000 v_eps, and its
 * speed. */
static double largest_friction(const dmb_friction_law *law, double *speed)
{
    double most = 0.0;
    *speed = 0.0;
    for (int i = 1; i <= 20000; i++) {
        const double near = law->smoothing_speed * 5e-4 * i, far = law->smoothing_speed * pow(10, 3e-4 * (i - 10000));
        for (int j = 0; j < 2; j++) {
            const double v[2] = {0.6 * (j == 0 ? near : far), -0.8 * (j == 0 ? near : far)};
            double F[2];
            smooth_force(law, 1.0, v, F);
            if (hypot(F[0], F[1]) <= most) continue;
            most = hypot(F[0], F[1]);
            *speed = hypot(v[0], v[1]);
        }
    }
    return most;
}

/* Something that pulls with up to mu_static N is held: the maximum of the smoothed law is mu_static, at any ratio of
 * its speeds and of its coefficients; of a table its first coefficient, or what the table itself rises to. */
static void smoothed_law_reaches_static(void **state)
{
    static const double smoothing[] = {1e-7, 1e-4, 1e-3, 5e-3, 1e-2, 0.03, 0.3}, dynamic[] = {0.0, 0.1, 0.3, 0.349};
    const dmb_wall_def wall = dmb_wall_def_default();
    double speed;
    (void)state;
    for (int i = 0; i < 7; i++)
        for (int k = 0; k < 4; k++) {
            dmb_friction_law law = law_of(DMB_FRICTION_STRIBECK, wall.mu_static, dynamic[k]);
            law.smoothing_speed = smoothing[i];
            law.stribeck_speed = wall.stribeck_speed;
            law = dmb_friction_law_of(law);
            CHECK_RELATIVE(largest_friction(&law, &speed), 0.35, 1e-6); /* as near as the speeds that are tried */
            assert_true(largest_friction(&law, &speed) <= 0.35 * (1.0 + 1e-13));
        }
    dmb_friction_law law = table_law(DMB_FRICTION_STRIBECK, 0.3);
    CHECK_RELATIVE(largest_friction(&law, &speed), 0.5, 3e-4);
    law.smoothing_speed = 0.04;
    law = dmb_friction_law_of(law);
    CHECK_RELATIVE(largest_friction(&law, &speed), 0.5, 3e-4);
    static const double rises[] = {0.1, 0.1, 0.4, 0.4}, hump[] = {0.4, 0.45, 0.35, 0.3};
    law.table_mu = rises;
    law.mu_dynamic = 0.4;
    law.smoothing_speed = 1e-3;
    law = dmb_friction_law_of(law);
    CHECK_RELATIVE(largest_friction(&law, &speed), 0.4, 1e-6);
    law.table_mu = hump;
    law.mu_dynamic = 0.3;
    law = dmb_friction_law_of(law);
    CHECK_RELATIVE(largest_friction(&law, &speed), 0.45, 1e-3); /* smoothed at 0.07 m/s */
}

/* Without smoothing the curve is as it is given, and the raised one tends to it. */
static void raised_law_tends_to_the_curve(void **state)
{
    double before = 1.0;
    (void)state;
    for (double smoothing = 1e-3; smoothing > 1e-8; smoothing *= 0.1) {
        dmb_friction_law law = law_of(DMB_FRICTION_STRIBECK, 0.35, 0.3);
        double most = 0.0;
        law.smoothing_speed = smoothing;
        law = dmb_friction_law_of(law);
        for (double v = 3e-3; v < 1.0; v *= 1.1) {
            const double at[2] = {v, 0.0};
            double F[2];
            smooth_force(&law, 1.0, at, F);
            most = fmax(most, fabs(-F[0] - (0.3 + 0.05 * exp(-v / 1e-2))));
        }
        assert_true(most < 0.4 * before);
        before = most;
    }
    assert_true(before < 1e-5);
}

/* Change of the coefficients along the hole: the force is linear in them, also of tables and where they fall. */
static void smooth_laws_are_linear_in_the_coefficients(void **state)
{
    uint64_t seed = 91;
    (void)state;
    for (int i = 0; i < 400; i++) {
        const double a = draw(&seed, 0.1, 0.5), b = draw(&seed, -0.5, 0.5), c = draw(&seed, -0.2, 0.2);
        const double v[2] = {draw(&seed, -1e-2, 1e-2), draw(&seed, -1e-2, 1e-2)};
        dmb_friction_law law =
            i % 2 == 0 ? law_of(DMB_FRICTION_STRIBECK, a + 0.3, a) : table_law(DMB_FRICTION_STRIBECK, a);
        dmb_friction_law change = law, sum = law;
        double F[2], dF[2], G[2];
        change.mu_dynamic = b;
        change.mu_static = i % 2 == 0 ? c : b * 0.5 / 0.3;
        sum.mu_dynamic += 0.1 * b;
        sum.mu_static += 0.1 * change.mu_static;
        smooth_force(&law, 10, v, F);
        smooth_force(&change, 10, v, dF);
        smooth_force(&sum, 10, v, G);
        for (int k = 0; k < 2; k++) CHECK_CLOSE(G[k], F[k] + 0.1 * dF[k], 1e-12);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(smooth_formulas),
        cmocka_unit_test(direction),
        cmocka_unit_test(smooth_tangents),
        cmocka_unit_test(table_values),
        cmocka_unit_test(table_tangents),
        cmocka_unit_test(falling_branch),
        cmocka_unit_test(rest_and_nonsense),
        cmocka_unit_test(bristle_tangents),
        cmocka_unit_test(bristle_is_continuous),
        cmocka_unit_test(breaks_away_at_static),
        cmocka_unit_test(bristle_dissipates),
        cmocka_unit_test(slider_stops),
        cmocka_unit_test(incline_sticks),
        cmocka_unit_test(no_ratchet),
        cmocka_unit_test(stick_slip_cycle),
        cmocka_unit_test(smoothed_law_reaches_static),
        cmocka_unit_test(raised_law_tends_to_the_curve),
        cmocka_unit_test(smooth_laws_are_linear_in_the_coefficients),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
