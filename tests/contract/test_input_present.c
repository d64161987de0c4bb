/* Before an input is set its time function is in force, and the input tells it by value and rate; where that is a
 * function of the caller's that fails, the question fails and nothing is written. */
#include <math.h>
#include <string.h>

#include "rig.h"

static int failing;

static int32_t wave(void *context, double time, double out[3])
{
    (void)context;
    out[0] = sin(3.0 * time);
    out[1] = 3.0 * cos(3.0 * time);
    out[2] = (1.0 - cos(3.0 * time)) / 3.0;
    return failing;
}

static dmb_id open_driven(rig *r)
{
    dmb_body_def body = dmb_body_def_default();
    dmb_input_def input = dmb_input_def_default();
    dmb_id id;
    failing = 0;
    rig_open(r, 0.0, 0.0, 0.0);
    for (int i = 0; i < 3; i++) body.inertia[i] = 0.02;
    input.part = add_simple_drive(r, DMB_DRIVE_LOAD, add_body(r, &body), DMB_X, add_callback(r, wave, NULL));
    strcpy(input.name, "push");
    must_model(r, dmb_model_add_input(r->model, &input, &id));
    (void)rig_start(r, NULL);
    return id;
}

static void a_time_function_is_in_force(void **state)
{
    (void)state;
    rig r;
    dmb_input_state told = dmb_input_state_default();
    const dmb_id id = open_driven(&r);
    for (int i = 1; i <= 5; i++) {
        take_steps(&r, 0.01, 1);
        must(&r, dmb_sim_get_input(r.sim, id, &told));
        assert_int_equal(told.is_set, 0);
        assert_true(fabs(told.present - sin(0.03 * i)) < 1e-15 && told.value == told.present);
        assert_true(fabs(told.rate - 3.0 * cos(0.03 * i)) < 1e-14 && told.arrives == 0.0);
    }
    must(&r, dmb_sim_set_input(r.sim, id, 2.0));
    must(&r, dmb_sim_get_input(r.sim, id, &told));
    assert_true(told.is_set == 1 && told.value == 2.0 && told.present == 2.0 && told.rate == 0.0);
    assert_true(fabs(told.arrives - 0.05) < 1e-15);
    rig_close(&r);
}

static void a_time_function_that_fails(void **state)
{
    (void)state;
    rig r;
    dmb_input_state told = dmb_input_state_default();
    const dmb_id id = open_driven(&r);
    told.value = 7.0;
    const uint64_t before = rig_hash(&r);
    failing = 1;
    assert_int_equal(dmb_sim_get_input(r.sim, id, &told), DMB_ERR_CALLBACK);
    assert_true(told.value == 7.0 && rig_hash(&r) == before);
    failing = 0;
    must(&r, dmb_sim_get_input(r.sim, id, &told));
    assert_true(told.value == 0.0);
    rig_close(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_time_function_is_in_force),
        cmocka_unit_test(a_time_function_that_fails),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
