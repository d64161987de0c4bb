/* Bit-rock laws: closed forms, exact derivatives, continuity, and the memory of the cut surface. Equations:
 * eq:bit.forces, eq:bit.rate, eq:bit.rate-limit, eq:bit.regenerative, eq:bit.no-work. */
#include "force/bit_rock.h"

#include "force_test.h"

#define OMEGA_200_RPM (200.0 * 2.0 * PI / 60.0)

static dmb_bit_rock_law coal(int32_t kind)
{
    dmb_bit_rock_law law;

    memset(&law, 0, sizeof law);
    law.kind = kind;
    law.blades = 4;
    law.radius = 0.047;
    law.intrinsic_energy = 10e6;
    law.cutting_ratio = 0.6;
    law.contact_strength = 10e6;
    law.wear_length = 1e-3;
    law.contact_friction = 0.5;
    law.intrusion_depth = 1e-4;
    return law;
}

typedef dmb_bit_rock_result result;

static void check_all_zero(const result *r)
{
    assert_true(r->weight_on_bit == 0.0 && r->torque_on_bit == 0.0 && r->depth_of_cut == 0.0);
    assert_true(r->dW_dU == 0.0 && r->dW_dV == 0.0 && r->dW_dPhi == 0.0 && r->dW_dOmega == 0.0);
    assert_true(r->dT_dU == 0.0 && r->dT_dV == 0.0 && r->dT_dPhi == 0.0 && r->dT_dOmega == 0.0);
    assert_int_equal(r->on_bottom, 0);
}

/* A ring that is cut is the disc less its core, derivatives included. */
static void ring_is_disc_less_core(void **state)
{
    dmb_bit_rock_law disc = coal(DMB_ROCK_RATE), core = disc, ring = disc;
    double apart[10], whole[10], inner[10];
    dmb_bit_rock_result r[3];
    core.radius = ring.inner_radius = 0.03;
    (void)state;
    dmb_bit_rock_force(&disc, NULL, 0.0, 5e-5, 1e-3, 0.3, 12.0, &r[0]);
    dmb_bit_rock_force(&core, NULL, 0.0, 5e-5, 1e-3, 0.3, 12.0, &r[1]);
    dmb_bit_rock_force(&ring, NULL, 0.0, 5e-5, 1e-3, 0.3, 12.0, &r[2]);
    for (int i = 0; i < 3; i++) {
        double *to = i == 0 ? whole : i == 1 ? inner : apart;
        const double numbers[10] = {r[i].weight_on_bit, r[i].torque_on_bit, r[i].dW_dU, r[i].dW_dV,   r[i].dW_dPhi,
                                    r[i].dW_dOmega,     r[i].dT_dU,         r[i].dT_dV, r[i].dT_dPhi, r[i].dT_dOmega};
        memcpy(to, numbers, sizeof numbers);
    }
    for (int i = 0; i < 10; i++) assert_true(fabs(apart[i] - (whole[i] - inner[i])) <= 1e-13 * fabs(whole[i]));
    assert_true(r[2].weight_on_bit > 0.0 && r[2].torque_on_bit > 0.0);
}

/* ---- rate law ---- */

/* CASES: d 6e-3 m, W 2162.0 N, T 71.7925 Nm. */
static void coal_values(void **state)
{
    const dmb_bit_rock_law law = coal(DMB_ROCK_RATE);
    result r;
    (void)state;

    dmb_bit_rock_force(&law, NULL, 0.1, 0.1 + 1e-4, 0.02, 0.0, OMEGA_200_RPM, &r);
    CHECK_RELATIVE(r.depth_of_cut, 6e-3, 1e-14);
    CHECK_RELATIVE(r.weight_on_bit, 2162.0, 1e-14);
    CHECK_RELATIVE(r.torque_on_bit, 71.7925, 1e-14);
    assert_int_equal(r.on_bottom, 1);
}

static void bottom_follows(void **state)
{
    const dmb_bit_rock_law law = coal(DMB_ROCK_RATE);
    double bottom = 0.0105;
    result r;
    (void)state;

    for (double U = 0.0; U < 0.05; U += 1e-3) {
        dmb_bit_rock_force(&law, NULL, bottom, U, 0.02, 0.0, OMEGA_200_RPM, &r);
        if (U < 0.0105)
            check_all_zero(&r);
        else
            CHECK_RELATIVE(r.weight_on_bit, 2162.0, 1e-12);
        bottom = dmb_bit_rock_bottom(&law, bottom, U);
        CHECK_CLOSE(bottom, fmax(0.0105, U - 1e-4), 1e-17);
    }
    const double deepest = bottom; /* withdrawn and back again: no rock until the old bottom is reached */
    bottom = dmb_bit_rock_bottom(&law, bottom, 0.02);
    assert_true(bottom == deepest);
    dmb_bit_rock_force(&law, NULL, bottom, 0.02, 0.02, 0.0, OMEGA_200_RPM, &r);
    check_all_zero(&r);
}

/* Taken up without a jump on touching, at the spin floor and at the reversal of spin. */
static void rate_law_is_continuous(void **state)
{
    const dmb_bit_rock_law law = coal(DMB_ROCK_RATE);
    result r, last;
    (void)state;

    memset(&last, 0, sizeof last);
    for (int i = 0; i <= 20000; ++i) {
        dmb_bit_rock_force(&law, NULL, 0.0, -1e-4 + 1.5e-8 * i, 0.02, 0.0, OMEGA_200_RPM, &r);
        assert_true(fabs(r.weight_on_bit - last.weight_on_bit) < 1.0 && fabs(r.dW_dU - last.dW_dU) < 2e4);
        last = r;
    }
    CHECK_RELATIVE(r.weight_on_bit, 2162.0, 1e-14);
    dmb_bit_rock_force(&law, NULL, 0.0, 1.0, 1e-6, 0.0, -0.1, &last);
    for (int i = 0; i <= 20000; ++i) {
        dmb_bit_rock_force(&law, NULL, 0.0, 1.0, 1e-6, 0.0, -0.1 + 1e-5 * i, &r);
        assert_true(fabs(r.weight_on_bit - last.weight_on_bit) < 0.05 &&
                    fabs(r.torque_on_bit - last.torque_on_bit) < 5e-3);
        last = r;
    }
    dmb_bit_rock_force(&law, NULL, 0.0, 1.0, 1e-6, 0.0, DMB_BIT_SPIN_FLOOR, &r);
    CHECK_RELATIVE(r.depth_of_cut, 2 * PI * 1e-6 / DMB_BIT_SPIN_FLOOR, 1e-14);
}

/* Reverse, standing and retreating: the wear flat alone, its torque against the spin. */
static void no_cutting(void **state)
{
    const dmb_bit_rock_law law = coal(DMB_ROCK_RATE);
    const double spin[3] = {-OMEGA_200_RPM, 0.0, OMEGA_200_RPM};
    const double speed[3] = {0.02, 0.02, -0.02};
    (void)state;

    for (int i = 0; i < 3; ++i) {
        result r;
        dmb_bit_rock_force(&law, NULL, 0.0, 1e-3, speed[i], 0.0, spin[i], &r);
        assert_true(r.depth_of_cut == 0.0);
        CHECK_RELATIVE(r.weight_on_bit, 470.0, 1e-14);
        CHECK_CLOSE(r.torque_on_bit, 5.5225 * (i - 1), 1e-14);
    }
}

static double component(const result *r, int which)
{
    return which == 0 ? r->weight_on_bit : r->torque_on_bit;
}

/* Derivatives in U, V, Phi, Omega against central differences of steps h[]. */
static void check_derivatives(const dmb_bit_rock_law *law, const dmb_bit_history *history, const double q[4],
                              const double h[4], double tolerance)
{
    result r;

    dmb_bit_rock_force(law, history, 0.0, q[0], q[1], q[2], q[3], &r);
    const double exact[2][4] = {{r.dW_dU, r.dW_dV, r.dW_dPhi, r.dW_dOmega}, {r.dT_dU, r.dT_dV, r.dT_dPhi, r.dT_dOmega}};
    for (int j = 0; j < 4; ++j) {
        double a[4], b[4];
        result above, below;
        memcpy(a, q, sizeof a);
        memcpy(b, q, sizeof b);
        a[j] += h[j];
        b[j] -= h[j];
        dmb_bit_rock_force(law, history, 0.0, a[0], a[1], a[2], a[3], &above);
        dmb_bit_rock_force(law, history, 0.0, b[0], b[1], b[2], b[3], &below);
        for (int i = 0; i < 2; ++i) {
            const double difference = (component(&above, i) - component(&below, i)) / (a[j] - b[j]);
            CHECK_CLOSE(exact[i][j], difference, tolerance * (fabs(difference) + fabs(component(&r, i)) / h[j] * 1e-3));
        }
    }
}

static void rate_law_derivatives(void **state)
{
    const dmb_bit_rock_law law = coal(DMB_ROCK_RATE);
    const double h[4] = {1e-9, 1e-7, 1e-6, 1e-6};
    uint64_t seed = 8;
    (void)state;

    for (int i = 0; i < 4000; ++i) {
        const double spin = i % 2 == 0 ? draw(&seed, -0.07, 0.07) : draw(&seed, -30, 30);
        const double q[4] = {draw(&seed, 1e-8, 1.2e-4), draw(&seed, -0.02, 0.03), draw(&seed, -9, 9), spin};
        if (fabs(q[1]) < h[1] || fabs(q[0] - law.intrusion_depth) < h[0] ||
            fabs(fabs(spin) - DMB_BIT_SPIN_FLOOR) < h[3] || fabs(spin) < h[3])
            continue;
        check_derivatives(&law, NULL, q, h, 2e-5);
    }
}

/* A bit that only the rock brakes, by a backward Euler step of length h: J (Omega1 - Omega) + h T(Omega1) = 0 has a
 * solution up to h = J Omega/(4 T) and none beyond (eq:bit.rate-limit). */
static void steps_of_the_rate_law_have_a_limit(void **state)
{
    dmb_bit_rock_law law = coal(DMB_ROCK_RATE);
    const double inertia = 2.0, spin = OMEGA_200_RPM;
    result r;
    (void)state;
    law.wear_length = 0.0; /* the cutting part alone */
    dmb_bit_rock_force(&law, NULL, 0.1, 0.2, 0.02, 0.0, spin, &r);
    const double limit = inertia * spin / (4.0 * r.torque_on_bit);
    for (int beyond = 0; beyond < 2; ++beyond) {
        const double h = limit * (beyond ? 1.001 : 0.999);
        double least = spin;
        for (double part = 0.1; part < 1.0; part += 1e-3) {
            dmb_bit_rock_force(&law, NULL, 0.1, 0.2, 0.02, 0.0, part * spin, &r);
            least = fmin(least, inertia * (part - 1.0) * spin + h * r.torque_on_bit);
        }
        assert_true(beyond ? least > 0.0 : least < 0.0);
    }
}

static void nonsense(void **state)
{
    dmb_bit_rock_law law = coal(DMB_ROCK_RATE);
    double angle[16], surface[16];
    dmb_bit_history history;
    result r;
    (void)state;

    dmb_bit_rock_force(&law, NULL, 0.0, 0.0, 0.0, 0.0, 0.0, &r);
    check_all_zero(&r);
    dmb_bit_rock_force(&law, NULL, 0.0, 1e-5, 0.02, 0.0, 1e-300, &r);
    assert_true(isfinite(r.weight_on_bit) && isfinite(r.dW_dOmega) && isfinite(r.dT_dOmega));
    dmb_bit_rock_force(&law, NULL, 0.0, (double)NAN, 0.02, 0.0, 20, &r);
    assert_true(isnan(r.weight_on_bit));
    law.kind = DMB_ROCK_NONE;
    dmb_bit_rock_force(&law, NULL, 0.0, 1.0, 0.02, 0.0, 20, &r);
    check_all_zero(&r);
    law.kind = DMB_ROCK_REGENERATIVE; /* without history: the rate law */
    dmb_bit_rock_force(&law, NULL, 0.0, 1.0, 0.02, 0.0, OMEGA_200_RPM, &r);
    CHECK_RELATIVE(r.weight_on_bit, 2162.0, 1e-14);
    history = (dmb_bit_history){.angle = NULL, .surface = surface, .capacity = 16};
    assert_int_equal(dmb_bit_history_init(&history, &law, 0, 0), DMB_ERR_NULL);
    history = (dmb_bit_history){.angle = angle, .surface = NULL, .capacity = 16};
    assert_int_equal(dmb_bit_history_init(&history, &law, 0, 0), DMB_ERR_NULL);
    history = (dmb_bit_history){.angle = angle, .surface = surface, .capacity = 15};
    assert_int_equal(dmb_bit_history_init(&history, &law, 0, 0), DMB_ERR_VALUE);
    law.blades = 0;
    history.capacity = 16;
    assert_int_equal(dmb_bit_history_init(&history, &law, 0, 0), DMB_ERR_VALUE);
}

/* ---- regenerative law ---- */

/* A ring between guards; every place not yet written is NaN, so a look outside the history shows. */
enum { GUARD = 16, CAPACITY_MAX = 1024 };
struct ring {
    double angle[CAPACITY_MAX + 2 * GUARD], surface[CAPACITY_MAX + 2 * GUARD];
    dmb_bit_history history;
};

static void start(struct ring *ring, const dmb_bit_rock_law *law, uint32_t capacity, double phi, double bottom)
{
    for (int i = 0; i < CAPACITY_MAX + 2 * GUARD; ++i) ring->angle[i] = ring->surface[i] = (double)NAN;
    ring->history = (dmb_bit_history){ring->angle + GUARD, ring->surface + GUARD, .capacity = capacity};
    assert_int_equal(dmb_bit_history_init(&ring->history, law, phi, bottom), DMB_OK);
}

static void check_guards(const struct ring *ring)
{
    for (uint32_t i = 0; i < GUARD; ++i) {
        assert_true(isnan(ring->angle[i]) && isnan(ring->surface[i]));
        assert_true(isnan(ring->angle[GUARD + ring->history.capacity + i]));
        assert_true(isnan(ring->surface[GUARD + ring->history.capacity + i]));
    }
}

/* Steady drilling: nothing above the stand-off, then within one blade spacing d = 2 pi V/Omega to round-off. */
static void steady_state(void **state)
{
    static struct ring ring;
    const uint32_t blades[3] = {1, 4, 7};
    const uint32_t capacities[3] = {64, 256, 1024};
    (void)state;

    for (int i = 0; i < 9; ++i) {
        dmb_bit_rock_law law = coal(DMB_ROCK_REGENERATIVE);
        law.blades = blades[i % 3];
        start(&ring, &law, capacities[i / 3], 3.0, 5e-3);
        const double V = 0.02, Omega = OMEGA_200_RPM, h = 1e-3;
        const double touch = 5e-3 / V,
                     settled = touch + 2 * PI / Omega / law.blades + 4 * ring.history.angle_step / Omega;
        for (int k = 0; k * h < 3.0; ++k) {
            const double t = k * h;
            result r;
            dmb_bit_rock_force(&law, &ring.history, 99.0, V * t, V, 3.0 + Omega * t, Omega, &r);
            if (t <= touch) {
                check_all_zero(&r);
            } else if (t > settled + h) {
                CHECK_RELATIVE(r.depth_of_cut, 6e-3, 1e-10);
                CHECK_RELATIVE(r.weight_on_bit, 2162.0, 1e-10);
                CHECK_RELATIVE(r.torque_on_bit, 71.7925, 1e-10);
            } else { /* first pass over flat rock */
                CHECK_CLOSE(r.depth_of_cut, fmin(6e-3, law.blades * (V * t - 5e-3)),
                            law.blades * V * (2 * ring.history.angle_step / Omega + 2 * h));
            }
            dmb_bit_history_record(&ring.history, 3.0 + Omega * t, V * t);
        }
        check_guards(&ring);
    }
}

/* d_n(t) = U(t) - U(t - t_n) with both speeds varying (Richard, Germay, Detournay 2007). */
static void varying_speed(void **state)
{
    static struct ring ring;
    const dmb_bit_rock_law law = coal(DMB_ROCK_REGENERATIVE);
    (void)state;

    start(&ring, &law, 1024, 0.0, 0.0);
    for (int k = 0; k < 40000; ++k) {
        const double t = 5e-5 * k;
        const double Phi = 20 * t + 0.05 * sin(30 * t), Omega = 20 + 1.5 * cos(30 * t);
        result r;
        double before = t;
        if (Phi > 1.7) { /* delay by Newton: Phi(before) = Phi(t) - pi/2 */
            for (int i = 0; i < 20; ++i)
                before -= (20 * before + 0.05 * sin(30 * before) - Phi + PI / 2) / (20 + 1.5 * cos(30 * before));
            const double U = 0.02 * t + 2e-4 * sin(47 * t), U_before = 0.02 * before + 2e-4 * sin(47 * before);
            dmb_bit_rock_force(&law, &ring.history, 0.0, U, 0.0, Phi, Omega, &r);
            CHECK_CLOSE(r.depth_of_cut, 4 * (U - U_before), 2e-8);
        }
        dmb_bit_history_record(&ring.history, Phi, 0.02 * t + 2e-4 * sin(47 * t));
    }
    check_guards(&ring);
}

/* Bouncing: against the surface from all passes, kept without end. */
static void rock_does_not_grow_back(void **state)
{
    enum { SAMPLES = 6000, PER_BLADE = 56 };
    static double U[SAMPLES];
    static struct ring ring;
    const dmb_bit_rock_law law = coal(DMB_ROCK_REGENERATIVE);
    uint64_t seed = 17;
    (void)state;

    start(&ring, &law, PER_BLADE + 8, 0.0, 0.0);
    const double step = ring.history.spacing / PER_BLADE * (1 + 1e-9);
    for (int k = 0; k < SAMPLES; ++k) {
        U[k] = k == 0 ? 0.0 : 1e-6 * k + 1e-3 * sin(0.01 * k) + draw(&seed, -2e-4, 2e-4);
        if (k > 0) {
            double highest = 0.0, slope;
            for (int j = k - PER_BLADE; j >= 0; j -= PER_BLADE) highest = fmax(highest, U[j]);
            CHECK_CLOSE(dmb_bit_history_surface(&ring.history, step * k, &slope), highest, 1e-8);
        }
        dmb_bit_history_record(&ring.history, step * k, U[k]);
    }
    check_guards(&ring);
}

/* Hard case 15: off bottom, reverse and back again. 12.3 turns are unwound above the bottom, the bit returns, and
 * drilling goes on as if it had never left; no sample is ever looked up outside the history. */
static void reverse_rotation(void **state)
{
    static struct ring ring;
    const dmb_bit_rock_law law = coal(DMB_ROCK_REGENERATIVE);
    const double V = 0.02, Omega = OMEGA_200_RPM, h = 1e-3;
    double U = 0.0, Phi = 0.0;
    result r;
    (void)state;

    start(&ring, &law, 64, 0.0, 0.0);
    for (int k = 0; k < 2000; ++k) {
        dmb_bit_history_record(&ring.history, Phi, U);
        U += V * h;
        Phi += Omega * h;
    }
    const double deepest = U;
    for (int k = 0; k < 3690; ++k) { /* unwinds; stays on bottom for the first part */
        dmb_bit_rock_force(&law, &ring.history, 0.0, U, 0.0, Phi, -Omega, &r);
        assert_true(isfinite(r.weight_on_bit) && r.depth_of_cut == 0.0 && r.torque_on_bit <= 0.0);
        assert_true(r.weight_on_bit <= 470.0 * (1 + 1e-12));
        dmb_bit_history_record(&ring.history, Phi, U);
        Phi -= Omega * h;
        if (k > 1000) U = deepest - 0.3;
        if (k > 1001) check_all_zero(&r);
    }
    double largest = 0.0;
    U = deepest - 2e-3;
    for (int k = 0; k < 4000; ++k) {
        dmb_bit_rock_force(&law, &ring.history, 0.0, U, V, Phi, Omega, &r);
        assert_true(isfinite(r.weight_on_bit) && isfinite(r.dW_dPhi) && r.depth_of_cut >= 0.0);
        largest = fmax(largest, r.depth_of_cut);
        if (k > 500) CHECK_RELATIVE(r.depth_of_cut, 6e-3, 1e-9);
        dmb_bit_history_record(&ring.history, Phi, U);
        U += V * h;
        Phi += Omega * h;
    }
    assert_true(largest < 1.3e-2);
    check_guards(&ring);
}

/* Turning back by a little and by many turns, all within one step, moves the rock continuously. */
static void surface_is_continuous(void **state)
{
    static struct ring ring;
    const dmb_bit_rock_law law = coal(DMB_ROCK_REGENERATIVE);
    double slope;
    (void)state;

    start(&ring, &law, 128, 0.0, 0.0);
    for (int k = 0; k < 1000; ++k) dmb_bit_history_record(&ring.history, 0.02 * k, 2e-5 * k);
    const double newest = 0.02 * 999, top = 2e-5 * 999;
    double last = dmb_bit_history_surface(&ring.history, newest + 1.0, &slope);
    for (double Phi = newest + 1.0; Phi > newest - 40.0; Phi -= 1e-4) {
        const double surface = dmb_bit_history_surface(&ring.history, Phi, &slope);
        assert_true(fabs(surface - last) < 5e-6);
        assert_true(surface <= top && surface >= top - 1.6e-3);
        last = surface;
    }
    CHECK_CLOSE(dmb_bit_history_surface(&ring.history, newest + 9.0, &slope), top, 0.0); /* a leap ahead */
    assert_true(slope == 0.0);
}

static void regenerative_derivatives(void **state)
{
    static struct ring ring;
    const dmb_bit_rock_law law = coal(DMB_ROCK_REGENERATIVE);
    const double h[4] = {1e-9, 1e-7, 1e-9, 1e-6};
    uint64_t seed = 3;
    int checked = 0;
    (void)state;

    start(&ring, &law, 128, 0.0, 0.0);
    for (int k = 0; k < 1000; ++k) dmb_bit_history_record(&ring.history, 0.02 * k, 2e-5 * k + 5e-5 * sin(0.7 * k));
    const double newest = 0.02 * 999;
    for (int i = 0; i < 4000; ++i) {
        double slope;
        const double Phi = newest + (i % 2 == 0 ? draw(&seed, -0.06, 0.06) : draw(&seed, -20, 1.4));
        const double U = dmb_bit_history_surface(&ring.history, Phi, &slope) + draw(&seed, -1e-4, 3e-4);
        const double q[4] = {U, 0.0, Phi, i % 3 == 0 ? draw(&seed, -0.07, 0.07) : draw(&seed, -20, 20)};
        double later, earlier;
        (void)dmb_bit_history_surface(&ring.history, Phi + 2e-9, &later);
        (void)dmb_bit_history_surface(&ring.history, Phi - 2e-9, &earlier);
        if (fabs(later - earlier) > 1e-6) continue; /* a sample in between */
        const double intrusion = U - dmb_bit_history_surface(&ring.history, Phi, &slope);
        if (fabs(intrusion) < 2e-9 || fabs(intrusion - law.intrusion_depth) < 2e-9) continue;
        check_derivatives(&law, &ring.history, q, h, 1e-4);
        ++checked;
    }
    assert_true(checked > 3500);
}

/* Drawn back, the bit gets no more from the rock than rotation puts in, but for the rebound that is allowed; below that
 * the law is the published one; derivatives of what is limited by differences. */
static void rock_gives_no_work(void **state)
{
    static struct ring ring;
    const dmb_bit_rock_law law = coal(DMB_ROCK_REGENERATIVE);
    const double h[4] = {1e-9, 1e-7, 1e-9, 1e-6};
    uint64_t seed = 5;
    int limited = 0;
    (void)state;

    start(&ring, &law, 128, 0.0, 0.0);
    for (int k = 0; k < 1000; ++k) dmb_bit_history_record(&ring.history, 0.02 * k, 2e-5 * k);
    for (int i = 0; i < 4000; ++i) {
        result r, still;
        double slope;
        const double Phi = 0.02 * 999 + draw(&seed, 0.001, 0.019), Omega = draw(&seed, -2, 20);
        const double U = dmb_bit_history_surface(&ring.history, Phi, &slope) + draw(&seed, 2e-8, 5e-3);
        const double V = -pow(10.0, draw(&seed, -4, 1.5)), q[4] = {U, V, Phi, Omega};
        dmb_bit_rock_force(&law, &ring.history, 0.0, U, V, Phi, Omega, &r);
        dmb_bit_rock_force(&law, &ring.history, 0.0, U, 0.0, Phi, Omega, &still);
        const double power = r.torque_on_bit * Omega + r.weight_on_bit * V;
        assert_true(power >= -still.weight_on_bit * DMB_BIT_REBOUND * (1.0 + 1e-12));
        const double most = DMB_BIT_REBOUND + still.torque_on_bit * Omega / still.weight_on_bit;
        assert_true(r.torque_on_bit == still.torque_on_bit);
        if (-V < 0.999 * most) assert_true(r.weight_on_bit == still.weight_on_bit);
        if (-V < 1.001 * most || fabs(Omega) < 0.06) continue;
        CHECK_RELATIVE(r.weight_on_bit * -V, still.weight_on_bit * most, 1e-12);
        check_derivatives(&law, &ring.history, q, h, 1e-4);
        ++limited;
    }
    assert_true(limited > 1000);
}

/* The struct and its arrays are all there is: a copy goes on bit by bit alike. */
static void snapshot(void **state)
{
    static struct ring ring, copy;
    const dmb_bit_rock_law law = coal(DMB_ROCK_REGENERATIVE);
    result a, b;
    (void)state;

    start(&ring, &law, 64, 0.0, 0.0);
    for (int k = 0; k < 500; ++k)
        dmb_bit_history_record(&ring.history, 0.03 * k - 0.5 * (k > 300) * (k - 300) * 0.03, 1e-5 * k);
    copy = ring;
    copy.history.angle = copy.angle + GUARD;
    copy.history.surface = copy.surface + GUARD;
    for (int k = 500; k < 900; ++k) {
        dmb_bit_rock_force(&law, &ring.history, 0, 1e-5 * k, 0, 0.03 * k, 20, &a);
        dmb_bit_rock_force(&law, &copy.history, 0, 1e-5 * k, 0, 0.03 * k, 20, &b);
        assert_memory_equal(&a, &b, sizeof a);
        dmb_bit_history_record(&ring.history, 0.03 * k, 1e-5 * k);
        dmb_bit_history_record(&copy.history, 0.03 * k, 1e-5 * k);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(coal_values),
        cmocka_unit_test(ring_is_disc_less_core),
        cmocka_unit_test(bottom_follows),
        cmocka_unit_test(rate_law_is_continuous),
        cmocka_unit_test(no_cutting),
        cmocka_unit_test(rate_law_derivatives),
        cmocka_unit_test(steps_of_the_rate_law_have_a_limit),
        cmocka_unit_test(nonsense),
        cmocka_unit_test(steady_state),
        cmocka_unit_test(varying_speed),
        cmocka_unit_test(rock_does_not_grow_back),
        cmocka_unit_test(reverse_rotation),
        cmocka_unit_test(surface_is_continuous),
        cmocka_unit_test(regenerative_derivatives),
        cmocka_unit_test(rock_gives_no_work),
        cmocka_unit_test(snapshot),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
