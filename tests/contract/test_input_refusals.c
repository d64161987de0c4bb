/* Calls that set inputs and drives: what they refuse changes nothing, what is there already is no change, and logs that
 * cannot be one are told. */
#include <stdlib.h>
#include <string.h>

#include "rig.h"

typedef struct subject {
    rig s;
    dmb_id drive, pull, slow, density;
} subject;

/* A body that is pulled by a drive, one whose pull follows an input by its slope alone, and mud of any density. */
static void open_subject(subject *c, int ledger)
{
    dmb_body_def body = dmb_body_def_default();
    dmb_input_def input = dmb_input_def_default();
    dmb_environment_def mud = dmb_environment_def_default();
    dmb_sim_options options = dmb_sim_options_default();
    memset(c, 0, sizeof *c);
    rig_open(&c->s, 0.0, 0.0, -9.81);
    mud.fluid_density = 1000.0;
    must_model(&c->s, dmb_model_set_environment(c->s.model, &mud));
    body.free_mask = DMB_FREE_X | DMB_FREE_Z;
    body.mass = 10.0;
    body.displaced_volume = 2e-3;
    const dmb_id first = add_body(&c->s, &body);
    body.position[1] = 1.0;
    const dmb_id second = add_body(&c->s, &body);
    body.position[1] = 2.0;
    const dmb_id third = add_body(&c->s, &body);
    const dmb_id none = add_constant(&c->s, 0.0);
    c->drive = add_simple_drive(&c->s, DMB_DRIVE_LOAD, third, DMB_X, none);
    strcpy(input.name, "pull");
    input.part = add_simple_drive(&c->s, DMB_DRIVE_LOAD, first, DMB_X, none);
    must_model(&c->s, dmb_model_add_input(c->s.model, &input, &c->pull));
    strcpy(input.name, "slow");
    input.part = add_simple_drive(&c->s, DMB_DRIVE_LOAD, second, DMB_X, none);
    input.slope_limit = 200.0;
    must_model(&c->s, dmb_model_add_input(c->s.model, &input, &c->slow));
    input = dmb_input_def_default();
    strcpy(input.name, "density");
    input.target = DMB_TARGET_FLUID_DENSITY;
    input.low = 0.0, input.high = 3000.0;
    must_model(&c->s, dmb_model_add_input(c->s.model, &input, &c->density));
    options.energy_ledger = ledger;
    (void)rig_start(&c->s, &options);
    take_steps(&c->s, 1e-3, 3);
}

static double present(const subject *c, dmb_id input)
{
    dmb_input_state state = dmb_input_state_default();
    must(&c->s, dmb_sim_get_input(c->s.sim, input, &state));
    return state.present;
}

static void lists(void **state)
{
    (void)state;
    subject c;
    open_subject(&c, 1);
    const dmb_id inputs[2] = {c.pull, c.slow}, wrong[2] = {c.pull, c.drive};
    const double values[2] = {3.0, 4.0}, infinite[2] = {3.0, (double)INFINITY};
    const uint64_t before = rig_hash(&c.s);
    assert_int_equal(dmb_sim_set_inputs(c.s.sim, NULL, values, 2), DMB_ERR_NULL);
    assert_int_equal(dmb_sim_set_inputs(c.s.sim, inputs, NULL, 2), DMB_ERR_NULL);
    assert_int_equal(dmb_sim_set_inputs(c.s.sim, NULL, NULL, 0), DMB_OK);
    assert_int_equal(dmb_sim_set_inputs(c.s.sim, wrong, values, 2), DMB_ERR_ID);
    assert_non_null(strstr(dmb_sim_message(c.s.sim), "number 1 of those to set names no input"));
    assert_int_equal(dmb_sim_set_inputs(c.s.sim, inputs, infinite, 2), DMB_ERR_NOT_FINITE);
    assert_int_equal(dmb_sim_set_input(c.s.sim, c.density, 3001.0), DMB_ERR_VALUE);
    assert_true(rig_hash(&c.s) == before);
    rig_close(&c.s);
}

/* The value that a drive or an input has already, and a drive that is let go twice. */
static void what_is_there_already(void **state)
{
    (void)state;
    subject c;
    open_subject(&c, 1);
    must(&c.s, dmb_sim_set_drive(c.s.sim, c.drive, 50.0));
    must(&c.s, dmb_sim_set_input(c.s.sim, c.pull, 20.0));
    uint64_t before = rig_hash(&c.s);
    must(&c.s, dmb_sim_set_drive(c.s.sim, c.drive, 50.0));
    must(&c.s, dmb_sim_set_input(c.s.sim, c.pull, 20.0));
    assert_true(rig_hash(&c.s) == before);
    must(&c.s, dmb_sim_set_drive(c.s.sim, c.drive, (double)NAN));
    before = rig_hash(&c.s);
    must(&c.s, dmb_sim_set_drive(c.s.sim, c.drive, (double)NAN));
    assert_true(rig_hash(&c.s) == before);
    rig_close(&c.s);
}

/* By a slope of 200 N/s2 from rest to rest: d after 2 sqrt(d/200) s, half of it at half the time. */
static void by_its_slope_alone(void **state)
{
    (void)state;
    subject c;
    open_subject(&c, 1);
    const double d = 2.0, way = 2.0 * sqrt(d / 200.0);
    must(&c.s, dmb_sim_set_input(c.s.sim, c.slow, d));
    take_steps(&c.s, 0.01 * way, 50);
    check_relative("half way", present(&c, c.slow), 0.5 * d, 1e-9);
    take_steps(&c.s, 0.01 * way, 51);
    check_relative("there", present(&c, c.slow), d, 1e-12);
    rig_close(&c.s);
}

/* Heavier mud carries more at once: a = -g (1 - rho V/m), with the ledger and without. */
static void density_without_a_ledger(void **state)
{
    (void)state;
    double height[2];
    for (int ledger = 0; ledger < 2; ledger++) {
        subject c;
        open_subject(&c, ledger);
        must(&c.s, dmb_sim_set_input(c.s.sim, c.density, 2500.0));
        const double before = momentum_of(&c.s).linear[2];
        take_steps(&c.s, 1e-3, 100);
        height[ledger] = momentum_of(&c.s).linear[2];
        check_relative("momentum gained in mud [kg m/s]", height[ledger] - before,
                       -3.0 * 9.81 * (10.0 - 2500.0 * 2e-3) * 0.1, 1e-9);
        rig_close(&c.s);
    }
    check_close("with a ledger and without [kg m/s]", height[0], height[1], 0.0);
}

static void logs(void **state)
{
    (void)state;
    subject c;
    open_subject(&c, 1);
    const double now = dmb_sim_time(c.s.sim);
    const dmb_input_record torn[2] = {{now, 1.0, 0, 0}, {now + 1e-3, 2.0, 1, 0}}; /* one call at two times */
    const dmb_input_record back[2] = {{now, 1.0, 0, 0}, {now - 1e-3, 2.0, 1, 1}};
    const dmb_input_record nowhere[1] = {{(double)NAN, 1.0, 0, 0}}, wrong[1] = {{now, 1.0, 9, 0}};
    dmb_input_record log[2];
    uint32_t next = 0;
    const uint64_t before = rig_hash(&c.s);
    assert_int_equal(dmb_sim_record_inputs(c.s.sim, NULL, 2), DMB_ERR_NULL);
    assert_int_equal(dmb_sim_record_inputs(c.s.sim, log, 0), DMB_ERR_VALUE);
    assert_non_null(strstr(dmb_sim_message(c.s.sim), "capacity = 0 must be both given"));
    assert_int_equal(dmb_sim_replay_inputs(c.s.sim, torn, 2, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_sim_replay_inputs(c.s.sim, NULL, 2, &next), DMB_ERR_NULL);
    assert_int_equal(dmb_sim_replay_inputs(c.s.sim, NULL, 0, &next), DMB_OK);
    assert_int_equal(dmb_sim_replay_inputs(c.s.sim, torn, 2, &next), DMB_ERR_VALUE);
    assert_non_null(strstr(dmb_sim_message(c.s.sim), "input log: time[1] = "));
    assert_int_equal(dmb_sim_replay_inputs(c.s.sim, nowhere, 1, &next), DMB_ERR_NOT_FINITE);
    assert_int_equal(dmb_sim_replay_inputs(c.s.sim, wrong, 1, &next), DMB_ERR_ID);
    assert_int_equal(next, 0);
    assert_true(rig_hash(&c.s) == before);
    assert_int_equal(dmb_sim_replay_inputs(c.s.sim, back, 2, &next), DMB_ERR_VALUE);
    assert_int_equal(next, 1); /* the call before it is made */
    check_close("pull of the first call [N]", present(&c, c.pull), 1.0, 0.0);
    rig_close(&c.s);
}

/* A place that gets stuck in a call that is refused for another of its values is not stuck. */
static void stuck_and_refused(void **state)
{
    (void)state;
    rig s;
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_input_def input = dmb_input_def_default();
    dmb_stuck_def stuck = dmb_stuck_def_default();
    dmb_body_def body = dmb_body_def_default();
    dmb_id inputs[2], place[2];
    rig_open(&s, 0.0, 0.0, -9.81);
    const dmb_pipe_def pipe = beam_pipe(1.0, 2, 1e7, 1e7, 1e4, 1e4);
    const dmb_id string = add_beam(&s, &pipe, DMB_FREE_RX);
    body.free_mask = DMB_FREE_RX;
    drive.kind = DMB_DRIVE_CONTROL;
    drive.part = add_body(&s, &body);
    drive.component = DMB_RX;
    drive.gain = 2.0;
    drive.limit_low = -10.0, drive.limit_high = 10.0;
    drive.time_function = add_constant(&s, 1.0);
    strcpy(input.name, "least");
    input.target = DMB_TARGET_LIMIT_LOW;
    input.part = add_drive(&s, &drive);
    must_model(&s, dmb_model_add_input(s.model, &input, &inputs[0]));
    for (int i = 0; i < 2; i++) {
        stuck.place = dmb_station(string, 0, 0.5 + 0.5 * i);
        stuck.stuck = 0;
        must_model(&s, dmb_model_add_stuck(s.model, &stuck, &place[i]));
    }
    strcpy(input.name, "stuck");
    input.target = DMB_TARGET_STUCK;
    input.part = place[0];
    input.initial = 0.0;
    must_model(&s, dmb_model_add_input(s.model, &input, &inputs[1]));
    (void)rig_start(&s, NULL);
    take_steps(&s, 1e-3, 3);
    const uint64_t before = rig_hash(&s);
    const double beyond[2] = {10.0, 1.0}, within[2] = {-5.0, 1.0};
    assert_int_equal(dmb_sim_set_inputs(s.sim, inputs, beyond, 2), DMB_ERR_VALUE);
    assert_non_null(strstr(dmb_sim_message(s.sim), "limit_low = 10 of its drive, must be < limit_high = 10"));
    dmb_stuck_state told = dmb_stuck_state_default();
    must(&s, dmb_query_stuck(s.sim, place[0], &told));
    assert_int_equal(told.stuck, 0);
    assert_true(rig_hash(&s) == before);
    must(&s, dmb_sim_set_inputs(s.sim, inputs, within, 2));
    must(&s, dmb_query_stuck(s.sim, place[0], &told));
    assert_int_equal(told.stuck, 1);
    size_t size = 0; /* of two limits one has an input: the other is as described */
    must(&s, dmb_sim_snapshot_size(s.sim, &size));
    void *bytes = malloc(size);
    assert_non_null(bytes);
    must(&s, dmb_sim_snapshot(s.sim, bytes, size));
    const uint64_t saved = rig_hash(&s);
    take_divided_steps(&s, 1e-3, 3);
    must(&s, dmb_sim_restore(s.sim, bytes, size));
    assert_true(rig_hash(&s) == saved);
    free(bytes);
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lists),
        cmocka_unit_test(what_is_there_already),
        cmocka_unit_test(by_its_slope_alone),
        cmocka_unit_test(density_without_a_ledger),
        cmocka_unit_test(logs),
        cmocka_unit_test(stuck_and_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
