/* Factors kept from step to step: they are part of the state that a snapshot saves and a hash tells, a failing call
 * leaves them alone, and what does not go on from the steps that made them forgets them. */
#include "rig.h"

#include "sim/sim.h"

/* A string of five pipes turned at the rig, falling onto its wall. */
static void open_string(rig *s, const dmb_sim_options *options)
{
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_drive_def turn = dmb_drive_def_default();
    dmb_segment term = dmb_segment_default();
    rig_open(s, 0.0, 0.0, -9.81);
    add_wall(s, &wall);
    add_pipes(s, &pipe, 5);
    term.kind = DMB_SEGMENT_STEP;
    term.h1 = 6.0;
    turn.component = DMB_RX;
    turn.time_function = add_time_function(s, &term, 1);
    add_drive(s, &turn);
    rig_start(s, options);
}

static void run(const rig *s, int steps)
{
    for (int i = 0; i < steps; i++) must(s, dmb_sim_step(s->sim, 1e-4, NULL));
}

/* Before the string meets the wall: factors of the first steps serve. */
static void snapshots_hold_them(void **state)
{
    static unsigned char block[1 << 16];
    size_t size = 0;
    rig a, b;
    (void)state;
    open_string(&a, NULL);
    open_string(&b, NULL);
    run(&a, 20);
    assert_true(a.sim->reuse->step > 0.0);
    must(&a, dmb_sim_snapshot_size(a.sim, &size));
    assert_true(size <= sizeof block);
    must(&a, dmb_sim_snapshot(a.sim, block, size));
    run(&b, 3); /* other factors, or other counts of them */
    must(&b, dmb_sim_restore(b.sim, block, size));
    assert_true(rig_hash(&a) == rig_hash(&b));
    run(&a, 200);
    run(&b, 200);
    assert_true(rig_hash(&a) == rig_hash(&b));
    rig_close(&a);
    rig_close(&b);
}

static int refused;
static int32_t refuse(void *context, double time, double out[3])
{
    (void)context;
    out[0] = refused ? (double)NAN : 2.0 * time;
    out[1] = 2.0;
    out[2] = time * time;
    return 0;
}

static void failing_calls_leave_them(void **state)
{
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_drive_def turn = dmb_drive_def_default();
    rig s;
    (void)state;
    refused = 0;
    rig_open(&s, 0.0, 0.0, -9.81);
    add_pipes(&s, &pipe, 5);
    turn.component = DMB_RX;
    turn.time_function = add_callback(&s, refuse, NULL);
    add_drive(&s, &turn);
    rig_start(&s, NULL);
    run(&s, 20);
    assert_true(s.sim->reuse->step > 0.0);
    const uint64_t before = rig_hash(&s);
    refused = 1;
    assert_true(dmb_sim_step(s.sim, 1e-4, NULL) < 0);
    assert_true(rig_hash(&s) == before);
    assert_true(dmb_sim_step(s.sim, 1.0, NULL) < 0); /* divided */
    assert_true(rig_hash(&s) == before);
    refused = 0;
    run(&s, 1);
    rig_close(&s);
}

static void statics_forget_them(void **state)
{
    rig s;
    (void)state;
    open_string(&s, NULL);
    run(&s, 20);
    assert_true(s.sim->reuse->step > 0.0);
    find_equilibrium(&s, NULL);
    assert_true(s.sim->reuse->step == 0.0);
    for (uint32_t i = 0; i < s.sim->scene->layout.diag[s.sim->scene->node_count]; i++)
        assert_true(s.sim->reused_diagonal[i] == 0.0);
    run(&s, 20);
    rig_close(&s);
}

/* Few iterations: what meets the tolerance is accepted, whatever reused factors aim at; control loops keep none. */
static void short_of_iterations(void **state)
{
    (void)state;
    for (uint32_t most = 2; most <= 4; most++) {
        dmb_sim_options options = dmb_sim_options_default();
        rig s;
        options.max_iterations = most;
        options.newton_tolerance = 1e-8;
        open_string(&s, &options);
        for (int i = 0; i < 100; i++) {
            dmb_step_report report = dmb_step_report_default();
            must(&s, dmb_sim_step(s.sim, 1e-4, &report));
            assert_true(report.residual <= options.newton_tolerance);
        }
        assert_int_equal(statistics_of(&s).rejected, 0);
        rig_close(&s);
        options.bounded_work = 1;
        open_string(&s, &options);
        run(&s, 20);
        assert_true(s.sim->reuse->step == 0.0);
        rig_close(&s);
    }
}

/* Times that add up with rounding make steps of nearly one length; a longer one takes factors of its own. */
static void lengths_of_steps(void **state)
{
    rig s;
    (void)state;
    open_string(&s, NULL);
    run(&s, 20);
    const double length = s.sim->reuse->step;
    must(&s, dmb_sim_step(s.sim, 1e-4 * (1.0 + 1e-12), NULL));
    assert_true(s.sim->reuse->step == length);
    must(&s, dmb_sim_step(s.sim, 1.1e-4, NULL));
    check_close("length of the reused factors", s.sim->reuse->step, 1.1e-4, 1e-12);
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(snapshots_hold_them),
                                       cmocka_unit_test(failing_calls_leave_them),
                                       cmocka_unit_test(statics_forget_them), cmocka_unit_test(short_of_iterations),
                                       cmocka_unit_test(lengths_of_steps)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
