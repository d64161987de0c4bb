/* Inputs in snapshots: what is described may lie outside the bounds of what is set, and is taken back; all else beyond
 * them is refused, as are NaN where something was given and limits of one drive that cross. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "forging.h"

enum { LOW_OF_FIRST, HIGH_OF_SECOND, GAIN_OF_FIRST, GIVEN, FACTOR, INPUTS };

static dmb_id add_drive(subject *s, dmb_id body, int32_t component)
{
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_segment zero = dmb_segment_default();
    dmb_id id;
    SAVED_MUST(&s->scene, dmb_model_add_time_function(s->scene.model, &zero, 1, &drive.time_function));
    drive.kind = DMB_DRIVE_CONTROL;
    drive.part = body;
    drive.component = component;
    drive.gain = 20.0;
    drive.limit_low = -3000.0;
    drive.limit_high = 2000.0;
    SAVED_MUST(&s->scene, dmb_model_add_drive(s->scene.model, &drive, &id));
    return id;
}

static dmb_input_def of(const char *name, int32_t target, dmb_id part)
{
    dmb_input_def input = dmb_input_def_default();
    (void)snprintf(input.name, sizeof input.name, "%s", name);
    input.target = target;
    input.part = part;
    return input;
}

/* Two drives of one body, each with one limit as input; a gain below the bounds of its input; one that is given; and
 * the factor of a load without a time function. */
static subject open_drives(void)
{
    subject s = {.sim = NULL};
    dmb_body_def body = dmb_body_def_default();
    dmb_load_def load = dmb_load_def_default();
    dmb_id id, drive[2], push;
    SAVED_MUST(&s.scene, dmb_model_create(NULL, &s.scene.model));
    SAVED_MUST(&s.scene, dmb_model_add_body(s.scene.model, &body, &id));
    for (int i = 0; i < 2; i++) drive[i] = add_drive(&s, id, i == 0 ? DMB_X : DMB_Y);
    load.place = dmb_station(id, 0, 0.0);
    load.force[2] = 3.0;
    SAVED_MUST(&s.scene, dmb_model_add_load(s.scene.model, &load, &push));
    dmb_input_def inputs[INPUTS] = {of("low", DMB_TARGET_LIMIT_LOW, drive[0]),
                                    of("high", DMB_TARGET_LIMIT_HIGH, drive[1]), of("gain", DMB_TARGET_GAIN, drive[0]),
                                    of("given", DMB_TARGET_GAIN, drive[1]), of("factor", DMB_TARGET_LOAD_FACTOR, push)};
    inputs[GAIN_OF_FIRST].low = 50.0; /* it is 20 */
    inputs[GIVEN].initial = 30.0;
    for (int i = 0; i < INPUTS; i++) SAVED_MUST(&s.scene, dmb_model_add_input(s.scene.model, inputs + i, NULL));
    SAVED_MUST(&s.scene, dmb_model_compile(s.scene.model, NULL));
    s.sim = saved_sim(&s.scene);
    for (int i = 0; i < 5; i++) assert_int_equal(dmb_sim_step(s.sim, 1e-3, NULL), DMB_OK);
    take(&s);
    return s;
}

static void own_are_taken(void **state)
{
    (void)state;
    subject s = open_drives();
    assert_true(got(&s, "input_value", GAIN_OF_FIRST) == 20.0);
    put(&s, "input_value", FACTOR, (double)NAN);
    assert_true(harmless(&s, "the factor without a time function") == 3);
    assert_true(harmless(&s, "inputs as described") == 3);
    put(&s, "input_value", GAIN_OF_FIRST, 50.0);
    put(&s, "input_value", HIGH_OF_SECOND, 1000.0);
    assert_true(harmless(&s, "inputs within their bounds") == 3);
    close_subject(&s);
}

static void others_are_refused(void **state)
{
    static const double beyond[] = {20.5, 49.9, -20.0};
    (void)state;
    subject s = open_drives();
    for (size_t i = 0; i < sizeof beyond / sizeof *beyond; i++) {
        put(&s, "input_value", GAIN_OF_FIRST, beyond[i]);
        refused(&s, "input_value");
    }
    for (uint32_t i = 0; i < INPUTS; i++) {
        if (i == FACTOR) continue;
        put(&s, "input_value", i, (double)NAN);
        refused(&s, "input_value");
    }
    close_subject(&s);
}

/* Each against the other limit of the same drive, which is as described. */
static void limits_that_cross_are_refused(void **state)
{
    (void)state;
    subject s = open_drives();
    put(&s, "input_value", LOW_OF_FIRST, 2000.5);
    refused(&s, "input_value");
    put(&s, "input_value", LOW_OF_FIRST, 1999.5);
    assert_true(harmless(&s, "low") == 3);
    put(&s, "input_value", HIGH_OF_SECOND, -3000.5);
    refused(&s, "input_value");
    put(&s, "input_value", HIGH_OF_SECOND, -2999.5);
    assert_true(harmless(&s, "high") == 3);
    close_subject(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(own_are_taken), cmocka_unit_test(others_are_refused),
                                       cmocka_unit_test(limits_that_cross_are_refused)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
