/* Kept factors that are forged: frames that are none are refused; factors of another matrix are taken, and then the
 * step ends where it does without any, and what is held stays where it is. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "forging.h"

/* Frames of the nodes where the kept factors were made; there are none where none are kept. */
static void frames_of_factors_are_rotations(void **state)
{
    (void)state;
    subject s = open_subject(SAVED_SIDEWAYS);
    assert_true(s.sim->scene->site_count > 0 && got(&s, "reuse", 0) > 0.0);
    put(&s, "reused_quaternion", 5, 7.0);
    refused(&s, "reused_quaternion");
    put(&s, "reused_quaternion", 1, 1e300);
    refused(&s, "reused_quaternion");
    put(&s, "reused_quaternion", 0, 0.9);
    refused(&s, "reused_quaternion");
    for (size_t i = 0; i < 4 * s.sim->scene->node_count; i++) put(&s, "reused_quaternion", i, 0.0);
    assert_int_equal(harmless(&s, "reused_quaternion"), 3);
    for (size_t i = 0; i < s.sim->scene->node_count; i++) {
        for (size_t k = 0; k < 4; k++) put(&s, "reused_quaternion", 4 * i + k, (i + k) % 4 == 0);
    }
    assert_int_equal(harmless(&s, "reused_quaternion"), 3);
    close_subject(&s);
}

/* Factors of no matrix at all: the step ends where it does without any. */
static void factors_of_nothing(void **state)
{
    (void)state;
    static const double values[] = {0.0, 1.0, -1e-9, 1e12, 1e-300};
    subject s = open_subject(SAVED_SIDEWAYS);
    const double h = got(&s, "reuse", 0);
    double with[64], without[64];
    const uint32_t rows = s.sim->scene->row_count;
    assert_true(h > 0.0 && rows <= 64);
    put(&s, "reuse", 0, 0.0);
    assert_int_equal(restore(&s), DMB_OK);
    assert_int_equal(dmb_sim_step(s.sim, h, NULL), DMB_OK);
    memcpy(without, s.sim->now.velocity, rows * sizeof(double));
    for (size_t k = 0; k < sizeof values / sizeof values[0]; k++) {
        memcpy(s.forged, s.sound, s.size);
        for (uint32_t i = 0; i < s.sim->scene->layout.diag[s.sim->scene->node_count]; i++)
            put(&s, "reused_diagonal", i, values[k]);
        assert_int_equal(restore(&s), DMB_OK);
        const int32_t status = dmb_sim_step(s.sim, h, NULL);
        if (status < 0) fail_msg("factors %g: %s", values[k], dmb_sim_message(s.sim));
        memcpy(with, s.sim->now.velocity, rows * sizeof(double));
        for (uint32_t i = 0; i < rows; i++)
            if (fabs(with[i] - without[i]) > 1e-4 * (1e-3 + fabs(without[i])))
                fail_msg("factors %g: row %u: %g, not %g", values[k], i, with[i], without[i]);
    }
    close_subject(&s);
}

/* Factors that couple held rows with others: these stay where they are, and the step ends where it would. */
static void factors_that_pull_at_what_is_held(void **state)
{
    (void)state;
    static const char *const fields[] = {"reused_diagonal", "reused_lower", "reused_upper"};
    static const double values[] = {1e-9, 1e-3, -1.0, 1e6};
    subject s = open_cantilever(DMB_PIPE_FLEXIBLE);
    const dmb_scene *scene = s.sim->scene;
    const uint32_t n = scene->node_count;
    assert_true(scene->site_count == 0 && scene->constrained_count == 6 && got(&s, "reuse", 0) > 0.0);
    for (size_t which = 0; which < 3; which++)
        for (size_t k = 0; k < sizeof values / sizeof values[0]; k++) {
            const uint32_t count = which == 0 ? scene->layout.diag[n] : scene->layout.link[n - 1];
            memcpy(s.forged, s.sound, s.size);
            for (uint32_t i = 0; i < count; i++) put(&s, fields[which], i, got(&s, fields[which], i) + values[k]);
            if (restore(&s) < 0) continue; /* refused is as good */
            const dmb_configuration *now = &s.sim->now;
            for (int i = 0; i < 5; i++) assert_int_equal(dmb_sim_step(s.sim, 2e-4, NULL), DMB_OK);
            for (uint32_t i = 0; i < scene->constrained_count; i++)
                if (now->velocity[dmb_constrained_row(scene, i)] != 0.0 ||
                    now->acceleration[dmb_constrained_row(scene, i)] != 0.0)
                    fail_msg("%s + %g: held row %u moves", fields[which], values[k], dmb_constrained_row(scene, i));
            for (int i = 0; i < 3; i++)
                if (now->displacement[i] != 0.0)
                    fail_msg("%s + %g: what is held is displaced by %g", fields[which], values[k],
                             now->displacement[i]);
        }
    close_subject(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(frames_of_factors_are_rotations),
        cmocka_unit_test(factors_of_nothing),
        cmocka_unit_test(factors_that_pull_at_what_is_held),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
