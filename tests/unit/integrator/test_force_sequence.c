/* A sequence of forces at the ends of steps, as generalized-alpha answers it on a unit mass (eq:touch.scheme): its
 * impulse and its way against those of the straight lines through its values (eq:touch.half, eq:touch.linear), the
 * weights at touch against a force that begins within a step (eq:touch.weights, eq:touch.moments), and the release
 * (eq:contact.release). */
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sequences_act_as_straight_lines),
        cmocka_unit_test(a_step_begins_half_a_step_early),
        cmocka_unit_test(weights_give_the_force_since_touch),
        cmocka_unit_test(release_has_the_impulse_of_the_closed_part),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
