/* A sequence of forces at the ends of steps, as generalized-alpha answers it on a unit mass (eq:touch.scheme): its
 * impulse and its way against those of the straight lines through its values (eq:touch.half, eq:touch.linear), the
 * weights at touch against a force that begins within a step (eq:touch.weights, eq:touch.moments), and the release
 * (eq:contact.release). Then what single steps do: with an error left in the increment (eq:integration.left-impulse),
 * against a wall that they hardly resolve (eq:contact.turned), and with a mean force and a weight (eq:contact.gain). */
#include <math.h>

#include "check.h"
#include "force/normal_law.h"
#include "integrator/step_motion.h"

enum { STEPS = 100 };
static const double radii[5] = {0.0, 0.3, 0.5, 0.8, 1.0};

typedef struct motion {
    double v, q;
} motion;

/* From rest, force[k] at the end of step k, steps of length 1. */
static motion answer(const dmb_generalized_alpha *c, const double *force, int steps)
{
    double a = force[0];
    motion m = {0.0, 0.0};
    for (int k = 0; k < steps; k++) {
        const double next = ((1.0 - c->af) * force[k + 1] + c->af * force[k] - c->am * a) / (1.0 - c->am);
        m.q += m.v + (0.5 - c->beta) * a + c->beta * next;
        m.v += (1.0 - c->gamma) * a + c->gamma * next;
        a = next;
    }
    return m;
}

static motion of_straight_lines(const double *force, int steps)
{
    motion m = {0.0, 0.0};
    for (int k = 0; k < steps; k++) {
        m.v += 0.5 * (force[k] + force[k + 1]);
        m.q += (steps - k - 1) * 0.5 * (force[k] + force[k + 1]) + force[k] / 3.0 + force[k + 1] / 6.0;
    }
    return m;
}

static double kappa(const dmb_generalized_alpha *c)
{
    return c->beta - (c->af - c->am) * c->af - 1.0 / 6.0;
}

/* Values at the first ends of steps, then 0.7. */
static void take_sequence(double *force)
{
    static const double first[8] = {0.0, 1.0, -0.4, 2.5, 0.1, -1.7, 0.9, 0.3};
    for (int k = 0; k <= STEPS; k++) force[k] = k < 8 ? first[k] : 0.7;
}

static void sequences_act_as_straight_lines(void **state)
{
    double force[STEPS + 1];
    (void)state;
    take_sequence(force);
    for (int i = 0; i < 5; i++) {
        const dmb_generalized_alpha c = dmb_generalized_alpha_of(radii[i]);
        const motion found = answer(&c, force, STEPS), lines = of_straight_lines(force, STEPS);
        tell("spectral radius", radii[i]);
        check_close("    impulse", found.v, lines.v, 1e-12);
        check_relative("    way", found.q, lines.q + kappa(&c) * (force[STEPS] - force[0]), 1e-14);
    }
}

/* A force that is there from the end of a step on acts as from the middle of that step. */
static void a_step_begins_half_a_step_early(void **state)
{
    double force[STEPS + 1];
    (void)state;
    for (int k = 0; k <= STEPS; k++) force[k] = k > 0 ? 1.0 : 0.0;
    for (int i = 0; i < 5; i++) {
        const dmb_generalized_alpha c = dmb_generalized_alpha_of(radii[i]);
        check_close("impulse", answer(&c, force, STEPS).v, STEPS - 0.5, 1e-12);
    }
}

/* Weights of the library as the force: impulse and way are those of a force 1 since touch, but for the kappa that every
 * force has. */
static void weights_give_the_force_since_touch(void **state)
{
    double force[STEPS + 1], was[DMB_TOUCH_SIZE] = {0.0}, is[DMB_TOUCH_SIZE];
    (void)state;
    for (double part = 0.05; part < 1.0; part += 0.1) {
        for (int j = 0; j < DMB_TOUCH_SIZE; j++) was[j] = 0.0;
        force[0] = 0.0;
        for (int k = 1; k <= STEPS; k++) {
            dmb_normal_touch touch;
            dmb_normal_touch_at(k == 1 ? part - 1.0 : 1.0, k == 1 ? part : 1.0, 1.0, was, &touch, is);
            for (int j = 0; j < DMB_TOUCH_SIZE; j++) was[j] = is[j];
            force[k] = touch.weight;
        }
        for (int i = 0; i < 5; i++) {
            const dmb_generalized_alpha c = dmb_generalized_alpha_of(radii[i]);
            const motion found = answer(&c, force, STEPS);
            const double since = STEPS - 1.0 + part;
            check_close("impulse since touch", found.v, since, 1e-12);
            check_relative("way since touch", found.q, 0.5 * since * since + kappa(&c), 1e-14);
        }
    }
}

/* A force that falls to 0 within a step, p of which is left: of a history with (1 - p) of it the impulse is the right
 * one. */
static void release_has_the_impulse_of_the_closed_part(void **state)
{
    double force[STEPS + 1] = {0.0};
    (void)state;
    for (double open = 0.0; open < 1.0; open += 0.25) {
        force[0] = 1.0 - open;
        for (int i = 0; i < 5; i++) {
            const dmb_generalized_alpha c = dmb_generalized_alpha_of(radii[i]);
            check_close("impulse to the release", answer(&c, force, STEPS).v, 0.5 * (1.0 - open), 1e-12);
        }
    }
}

/* ---- Single steps ------------------------------------------------------------------------------------------------ */

/* An error e of the increment of one step moves speed, acceleration and a by Newmark's formulas; no force follows. */
static void an_error_left_is_an_impulse(void **state)
{
    (void)state;
    for (int i = 0; i < 5; i++) {
        const dmb_generalized_alpha c = dmb_generalized_alpha_of(radii[i]);
        const double to_acceleration = (1.0 - c.am) / (c.beta * (1.0 - c.af));
        double a = 1.0 / c.beta, v = c.gamma / c.beta, x = 1.0, f = to_acceleration;
        for (int k = 0; k < STEPS; k++) {
            const double next = (c.af * f - c.am * a) / (1.0 - c.am);
            x += v + (0.5 - c.beta) * a + c.beta * next;
            v += (1.0 - c.gamma) * a + c.gamma * next;
            a = next;
            f = 0.0;
        }
        tell("spectral radius", radii[i]);
        check_relative("    speed in the end", v, to_acceleration, 1e-12);
        check_relative("    way, of the speed times the steps", x, to_acceleration * STEPS, 1.0 / STEPS);
        if (i == 3) check_close("    speed over e/h", v, 3.9, 0.05);
        if (i == 4) check_close("    speed over e/h", v, 4.0, 1e-12);
    }
}

/* From the wall at speed 1 into it, with the force at the end of the step that the depth there gives. */
static double speed_after(const dmb_generalized_alpha *c, double stiffness, double exponent)
{
    double low = 0.0, high = (1.0 - c->am) / (c->beta * (1.0 - c->af)); /* which would keep it at the wall */
    motion m = {0.0, 0.0};
    for (int k = 0; k < 200; k++) {
        const double force[2] = {0.0, -0.5 * (low + high)};
        m = answer(c, force, 1);
        if (stiffness * pow(fmax(1.0 + m.q, 0.0), exponent) > -force[1])
            low = -force[1];
        else
            high = -force[1];
    }
    return 1.0 + m.v;
}

static void a_step_turns_the_body_from_a_stiffness_on(void **state)
{
    static const double exponents[3] = {1.0, 1.5, 3.0};
    (void)state;
    for (int i = 0; i < 5; i++) {
        const dmb_generalized_alpha c = dmb_generalized_alpha_of(radii[i]);
        const double b = c.beta * (1.0 - c.af) / (1.0 - c.am), g = c.gamma * (1.0 - c.af) / (1.0 - c.am);
        tell("spectral radius", radii[i]);
        for (int k = 0; k < 3; k++) {
            const double limit = 1.0 / (g * pow(1.0 - b / g, exponents[k]));
            tell("    limit of K l h^2/m (h v0)^(n-1)", limit);
            assert_true(speed_after(&c, 0.999 * limit, exponents[k]) > 0.0);
            assert_true(speed_after(&c, 1.001 * limit, exponents[k]) < 0.0);
        }
        check_close("    the first, of 3.80 to 4", 1.0 / (g - b), 3.9, 0.1001);
    }
}

/* A constant force c, and the mean force G of a potential against it at the end of the step: the energy of both and of
 * the body. The work that the potential does not store is heat. */
static void weight_wins_energy_against_a_mean_force(void **state)
{
    uint64_t seed = 5;
    (void)state;
    for (int i = 0; i < 5; i++) {
        const dmb_generalized_alpha c = dmb_generalized_alpha_of(radii[i]);
        const double b = c.beta * (1.0 - c.af) / (1.0 - c.am), g = c.gamma * (1.0 - c.af) / (1.0 - c.am);
        for (int k = 0; k < 20; k++) {
            const double weight = draw_between(&seed, -1.0, 1.0), G = draw_between(&seed, 0.0, 1.0);
            const double v0 = draw_between(&seed, -1.0, 1.0), heat = draw_between(&seed, 0.0, 1.0);
            const double force[2] = {weight, weight - G / g};
            const motion m = answer(&c, force, 1);
            const double way = v0 + m.q, stored = G * way - heat;
            const double gained = 0.5 * (pow(v0 + m.v, 2.0) - v0 * v0) - weight * way + stored;
            assert_true(fabs(gained - ((b / g - 0.5) * G * m.v - heat)) < 1e-14);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sequences_act_as_straight_lines),
        cmocka_unit_test(a_step_begins_half_a_step_early),
        cmocka_unit_test(weights_give_the_force_since_touch),
        cmocka_unit_test(release_has_the_impulse_of_the_closed_part),
        cmocka_unit_test(an_error_left_is_an_impulse),
        cmocka_unit_test(a_step_turns_the_body_from_a_stiffness_on),
        cmocka_unit_test(weight_wins_energy_against_a_mean_force),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
