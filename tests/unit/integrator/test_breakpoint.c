/* Lengths of steps against the lengths asked for, bit by bit: where no breakpoint cuts them, however long the run, and
 * in full again behind a breakpoint that did. */
#include "rig.h"

#include "sim/sim.h"

/* A free body, pushed by a table with a breakpoint at `breakpoint` [s]. */
static void open_scene(rig *s, double breakpoint)
{
    const double time[3] = {0.0, breakpoint, 1e6}, value[3] = {0.0, 1.0, 1.0};
    dmb_body_def body = dmb_body_def_default();
    dmb_segment term = dmb_segment_default();
    rig_open(s, 0.0, 0.0, 0.0);
    body.free_mask = DMB_FREE_X;
    const dmb_id id = add_body(s, &body);
    term.kind = DMB_SEGMENT_TABLE;
    term.table_time = time;
    term.table_value = value;
    term.table_count = 3;
    (void)add_simple_drive(s, DMB_DRIVE_LOAD, id, DMB_X, add_time_function(s, &term, 1));
    (void)rig_start(s, NULL);
}

static void equal_steps_are_equal(void **state)
{
    static const double lengths[] = {1e-3, 0.0037, 1.0 / 3.0, 0.3};
    rig s;
    (void)state;
    open_scene(&s, 9e5);
    for (int k = 0; k < 4; k++)
        for (int i = 0; i < 2000; i++) {
            must(&s, dmb_sim_step(s.sim, lengths[k], NULL));
            assert_true(s.sim->clock->step == lengths[k]);
        }
    rig_close(&s);
}

/* 0.01 s over a breakpoint at 0.305 s: the step that it cuts ends there, the one after it is what is left of 0.01 s. */
static void steps_are_whole_again_behind_a_breakpoint(void **state)
{
    rig s;
    (void)state;
    open_scene(&s, 0.305);
    for (int i = 0; i < 100; i++) {
        must(&s, dmb_sim_step(s.sim, 0.01, NULL));
        if (i == 30)
            check_close("what is left behind the breakpoint", s.sim->clock->step, 0.005, 1e-15);
        else
            assert_true(s.sim->clock->step == 0.01);
    }
    check_close("time", dmb_sim_time(s.sim), 1.0, 2e-16);
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(equal_steps_are_equal),
        cmocka_unit_test(steps_are_whole_again_behind_a_breakpoint),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
