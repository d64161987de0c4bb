/* The rate of mud that flows, set as an input, crossed with bounded work, events, another model and buckling: each
 * against the scene compiled with that rate. Mud motors by a table crossed with actuators, against an integration of
 * their two equations. */
#include <stdlib.h>
#include <string.h>

#include "drillmbd/analyse.h"
#include "drillmbd/scene.h"
#include "mechanism.h"

static const double rate = 0.012;

/* ---- Flow ---------------------------------------------------------------------------------------------------------
 */

typedef struct flowing {
    rig s;
    dmb_id string, input, push;
    uint32_t pipes;
} flowing;

/* Clamped at its rig end, standing in mud; a push at its upper end of `push` N. */
static flowing describe(double described, uint32_t pipes, double start, double push)
{
    flowing f = {.pipes = pipes};
    dmb_environment_def e = dmb_environment_def_default();
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_load_def load = dmb_load_def_default();
    rig_open(&f.s, 0.0, 0.0, 0.0);
    e.gravity[0] = 9.81;
    e.gravity[2] = 0.0;
    e.fluid_density = 1200.0;
    e.flow_rate = described;
    e.consistency = 0.05;
    e.flow_exponent = 0.8;
    e.nozzle_area = 4e-4;
    e.axial_damping = 50.0;
    must_model(&f.s, dmb_model_set_environment(f.s.model, &e));
    wall.normal_law = DMB_NORMAL_NONE;
    wall.diameter = 0.12;
    (void)add_wall(&f.s, &wall);
    string.start_free = DMB_FREE_NONE;
    string.start_depth = start;
    f.string = pipe.string = add_string(&f.s, &string);
    pipe.length = 6.0;
    pipe.elements = 2;
    (void)add_pipes(&f.s, &pipe, pipes);
    load.place = dmb_station(f.string, pipes - 1, 1.0);
    load.force[0] = -push;
    load.frame = DMB_FRAME_HOLE;
    f.push = add_load(&f.s, &load);
    return f;
}

/* Described with another rate, and an input to set it by. */
static void add_pump(flowing *f)
{
    dmb_input_def input = dmb_input_def_default();
    input.target = DMB_TARGET_FLOW_RATE;
    input.high = 0.02;
    (void)strcpy(input.name, "pump");
    must_model(&f->s, dmb_model_add_input(f->s.model, &input, &f->input));
}

static void add_event(const flowing *f, double level)
{
    dmb_event_def event = dmb_event_def_default();
    event.output = (dmb_output){dmb_station(f->string, f->pipes - 1, 1.0), DMB_OUTPUT_DISPLACEMENT_X, 0};
    event.level = level;
    (void)strcpy(event.name, "stretched");
    must_model(&f->s, dmb_model_add_event(f->s.model, &event, NULL));
}

/* set[0]: by its input, from another rate; set[1]: compiled with it. */
static void begin_both(flowing set[2], const dmb_sim_options *options, double level)
{
    set[0] = describe(0.004, 5, 0.0, 0.0);
    set[1] = describe(rate, 5, 0.0, 0.0);
    add_pump(set);
    for (int i = 0; i < 2 && level > 0.0; i++) add_event(set + i, level);
    for (int i = 0; i < 2; i++) (void)mechanism_start(&set[i].s, options);
    must(&set[0].s, dmb_sim_set_input(set[0].s.sim, set[0].input, rate));
}

static double end_of(const flowing *f)
{
    return pose_at(&f->s, dmb_station(f->string, f->pipes - 1, 1.0)).displacement[0];
}

static dmb_flow_state flow_in(const flowing *f)
{
    dmb_flow_state flow = dmb_flow_state_default();
    must(&f->s, dmb_query_flow(f->s.sim, &flow));
    return flow;
}

static void bounded_work_has_the_same_run(void **state)
{
    flowing both[2];
    dmb_sim_options options = dmb_sim_options_default();
    (void)state;
    options.bounded_work = 1;
    options.max_iterations = 4;
    begin_both(both, &options, 0.0);
    for (int i = 0; i < 200; i++)
        for (int k = 0; k < 2; k++) assert_true(dmb_sim_step(both[k].s.sim, 1e-3, NULL) >= 0);
    check_relative("end of the string [m]", end_of(both), end_of(both + 1), 1e-9);
    check_relative("pressure of the pump [Pa]", flow_in(both).pump_pressure, flow_in(both + 1).pump_pressure, 1e-12);
    for (int k = 0; k < 2; k++) rig_close(&both[k].s);
}

static void events_come_at_the_same_time(void **state)
{
    dmb_event_report report[2] = {dmb_event_report_default(), dmb_event_report_default()};
    flowing both[2];
    (void)state;
    begin_both(both, NULL, 2e-5);
    for (int k = 0; k < 2; k++) must(&both[k].s, dmb_sim_advance_to_event(both[k].s.sim, 1.0, report + k, NULL));
    assert_true(report[0].count == 1 && report[1].count == 1);
    check_relative("time of the event [s]", report[0].time, report[1].time, 1e-6);
    check_close("end of the string there [m]", end_of(both), 2e-5, 1e-9);
    for (int k = 0; k < 2; k++) rig_close(&both[k].s);
}

/* A pipe more at the rig end: the rate that was set goes on, over losses of the longer string. */
static void another_model_keeps_the_rate(void **state)
{
    flowing both[2];
    dmb_input_state input = dmb_input_state_default();
    (void)state;
    begin_both(both, NULL, 0.0);
    take_divided_steps(&both[0].s, 1e-3, 50);
    flowing longer = describe(0.004, 6, -6.0, 0.0), compiled = describe(rate, 6, -6.0, 0.0);
    add_pump(&longer);
    (void)mechanism_start(&longer.s, NULL);
    (void)mechanism_start(&compiled.s, NULL);
    must(&longer.s, dmb_sim_transfer_state(longer.s.sim, both[0].s.sim));
    must(&longer.s, dmb_sim_get_input(longer.s.sim, longer.input, &input));
    assert_true(input.is_set && input.value == rate && flow_in(&longer).rate == rate);
    check_relative("pressure of the pump [Pa]", flow_in(&longer).pump_pressure, flow_in(&compiled).pump_pressure,
                   1e-12);
    check_relative("drag [N]", flow_in(&longer).drag, flow_in(&compiled).drag, 1e-12);
    must(&longer.s, dmb_analysis_static(longer.s.sim, NULL, NULL));
    must(&compiled.s, dmb_analysis_static(compiled.s.sim, NULL, NULL));
    check_relative("end at rest [m]", end_of(&longer), end_of(&compiled), 1e-9);
    for (int k = 0; k < 2; k++) rig_close(&both[k].s);
    rig_close(&longer.s), rig_close(&compiled.s);
}

static double critical_push(const flowing *f)
{
    dmb_buckling *found = NULL;
    dmb_buckling_options options = dmb_buckling_options_default();
    double factor = 0.0;
    options.scale = DMB_SCALE_PART;
    options.part = f->push;
    must(&f->s, dmb_analysis_buckling(f->s.sim, &options, &found));
    assert_int_equal(dmb_buckling_factor(found, 0, &factor), DMB_OK);
    dmb_buckling_destroy(&found);
    return factor;
}

static void it_buckles_at_the_same_push(void **state)
{
    (void)state;
    flowing set = describe(0.004, 2, 0.0, 1000.0), compiled = describe(rate, 2, 0.0, 1000.0);
    flowing slow = describe(0.004, 2, 0.0, 1000.0);
    add_pump(&set);
    (void)mechanism_start(&set.s, NULL);
    (void)mechanism_start(&compiled.s, NULL);
    (void)mechanism_start(&slow.s, NULL);
    must(&set.s, dmb_sim_set_input(set.s.sim, set.input, rate));
    for (int k = 0; k < 3; k++) {
        const flowing *f = k == 0 ? &set : k == 1 ? &compiled : &slow;
        must(&f->s, dmb_analysis_static(f->s.sim, NULL, NULL));
    }
    const double by_input = critical_push(&set), by_compile = critical_push(&compiled), slowly = critical_push(&slow);
    print_message("    critical factor %.6g, at the described rate %.6g\n", by_input, slowly);
    check_relative("critical factor", by_input, by_compile, 1e-8);
    assert_true(fabs(by_input - slowly) > 1e-4 * slowly); /* the rate matters to it */
    rig_close(&set.s), rig_close(&compiled.s), rig_close(&slow.s);
}

/* ---- A motor's table behind an actuator ---------------------------------------------------------------------------
 */

static const double heavy = 4.0, against = 150.0, lag = 0.2, table_speed[3] = {0.0, 6.0, 10.0},
                    table_torque[3] = {800.0, 500.0, 0.0};

static double torque_of(double w)
{
    const int k = w > table_speed[1];
    const double s = (table_torque[k + 1] - table_torque[k]) / (table_speed[k + 1] - table_speed[k]);
    return fmin(fmax(table_torque[k] + s * (w - table_speed[k]), 0.0), 800.0);
}

/* J w' = f - M, lag f' = T(w) - f by Runge and Kutta. */
static void integrate(double time, double y[2])
{
    const int steps = 20000;
    const double h = time / steps;
    for (int i = 0; i < steps; i++) {
        double k[4][2], at[2] = {y[0], y[1]};
        for (int stage = 0; stage < 4; stage++) {
            k[stage][0] = (at[1] - against) / heavy;
            k[stage][1] = (torque_of(at[0]) - at[1]) / lag;
            const double next = stage == 2 ? h : 0.5 * h;
            for (int c = 0; c < 2; c++) at[c] = y[c] + next * k[stage][c];
        }
        for (int c = 0; c < 2; c++) y[c] += h * (k[0][c] + 2.0 * k[1][c] + 2.0 * k[2][c] + k[3][c]) / 6.0;
    }
}

typedef struct turner {
    rig s;
    dmb_id body, drive;
} turner;

static turner turned_by_a_table(void)
{
    turner t;
    dmb_motor motor = dmb_motor_default();
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_body_def body = dmb_body_def_default();
    dmb_load_def load = dmb_load_def_default();
    double w0;
    rig_open(&t.s, 0.0, 0.0, 0.0);
    for (int i = 0; i < 3; i++) body.inertia[i] = heavy;
    body.free_mask = DMB_FREE_RX;
    t.body = add_body(&t.s, &body);
    motor.flow = 0.03;
    motor.table_count = 3;
    memcpy(motor.table_speed, table_speed, sizeof table_speed);
    memcpy(motor.table_torque, table_torque, sizeof table_torque);
    assert_int_equal(dmb_motor_drive(&motor, &drive, &w0), DMB_OK);
    drive.mud_pressure = 0.0; /* no mud goes through a body */
    drive.part = t.body;
    drive.component = DMB_RX;
    drive.lag = lag;
    drive.time_function = add_constant(&t.s, w0);
    t.drive = add_drive(&t.s, &drive);
    load.place = dmb_station(t.body, 0, 0.0);
    load.moment[0] = -against;
    (void)add_load(&t.s, &load);
    (void)mechanism_start(&t.s, NULL);
    return t;
}

static void a_table_acts_through_a_lag(void **state)
{
    const double steps[2] = {2e-3, 5e-4},
                 bounds[2] = {5e-5, 5e-6}; /* of second order, with a corner of the table in it */
    size_t size = 0;
    (void)state;
    for (uint32_t i = 0; i < 2; i++) {
        double y[2] = {0.0, 800.0}; /* at the start the force has come to its command */
        turner t = turned_by_a_table(), again = turned_by_a_table();
        dmb_drive_state drive = dmb_drive_state_default();
        take_steps(&t.s, steps[i], i == 0 ? 50 : 200);
        must(&t.s, dmb_sim_snapshot_size(t.s.sim, &size));
        void *block = malloc(size);
        must(&t.s, dmb_sim_snapshot(t.s.sim, block, size));
        must(&again.s, dmb_sim_restore(again.s.sim, block, size));
        free(block);
        take_steps(&t.s, steps[i], i == 0 ? 50 : 200);
        take_steps(&again.s, steps[i], i == 0 ? 50 : 200);
        assert_true(rig_hash(&t.s) == rig_hash(&again.s));
        must(&t.s, dmb_query_drive(t.s.sim, t.drive, &drive));
        integrate(0.2, y);
        check_relative("force of the motor [N m]", drive.force, y[1], bounds[i]);
        check_relative("its speed [rad/s]", drive.speed, y[0], bounds[i]);
        const dmb_energy energy = energy_of(&t.s);
        check_below("energy balance over what went in", fabs(energy.balance) / energy.input, 1e-4);
        rig_close(&t.s), rig_close(&again.s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bounded_work_has_the_same_run), cmocka_unit_test(events_come_at_the_same_time),
        cmocka_unit_test(another_model_keeps_the_rate),  cmocka_unit_test(it_buckles_at_the_same_push),
        cmocka_unit_test(a_table_acts_through_a_lag),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
