/* Actuators crossed with joints and analyses: a drive on a joint's coordinate against the same on a body, events on its
 * force at their closed-form times, damped modes against the slope of a torque-speed curve and a run in time, steady
 * states that refuse them, all through snapshots to the same hash. */
#include <stdlib.h>
#include <string.h>

#include "modal.h"

#define J 2.5 /* [kg m2] */

typedef struct turner {
    rig s;
    dmb_id body, joint, drive, event;
} turner;

typedef struct wish {
    int jointed; /* the body is held by a revolute whose coordinate is driven, not its own RX */
    double spring;
    double level; /* [N m] at which an event is told; 0: none */
    dmb_drive_def drive;
} wish;

static turner open_turner(const wish *w)
{
    turner t;
    dmb_body_def body = dmb_body_def_default();
    dmb_drive_def drive = w->drive;
    memset(&t, 0, sizeof t);
    rig_open(&t.s, 0.0, 0.0, 0.0);
    for (int i = 0; i < 3; i++) body.inertia[i] = J;
    body.free_mask = w->jointed ? DMB_FREE_ALL : DMB_FREE_RX;
    t.body = add_body(&t.s, &body);
    if (w->jointed || w->spring > 0.0) {
        dmb_joint_def joint = dmb_joint_def_default();
        joint.kind = DMB_JOINT_REVOLUTE;
        joint.place_b = dmb_station(t.body, 0, 0.0);
        joint.stiffness[DMB_RX] = w->spring;
        t.joint = add_joint(&t.s, &joint);
    }
    drive.part = w->jointed ? t.joint : t.body;
    drive.component = DMB_RX;
    if (drive.time_function.generation == 0) drive.time_function = add_constant(&t.s, 0.0);
    t.drive = add_drive(&t.s, &drive);
    if (w->level > 0.0) {
        dmb_event_def event = dmb_event_def_default();
        memcpy(event.name, "torque", sizeof "torque");
        event.output = (dmb_output){.place = dmb_station(t.drive, 0, 0.0), .quantity = DMB_OUTPUT_DRIVE_FORCE};
        event.level = w->level;
        must_model(&t.s, dmb_model_add_event(t.s.model, &event, &t.event));
    }
    (void)rig_start(&t.s, NULL);
    return t;
}

/* Delay, rate limit, lag, curve and drag at once. */
static dmb_drive_def with_everything(void)
{
    dmb_drive_def def = dmb_drive_def_default();
    def.kind = DMB_DRIVE_CONTROL;
    def.gain = 60.0;
    def.integral_gain = 40.0;
    def.delay = 0.013;
    def.force_rate = 2000.0;
    def.lag = 0.05;
    def.drag = 1.5;
    def.back_drag = 4.0;
    def.curve_count = 2;
    def.curve_speed[1] = 10.0;
    def.curve_force[0] = 80.0;
    return def;
}

static double speed_of(const turner *t)
{
    dmb_drive_state state = dmb_drive_state_default();
    must(&t->s, dmb_query_drive(t->s.sim, t->drive, &state));
    return state.speed;
}

static double force_of(const turner *t)
{
    dmb_drive_state state = dmb_drive_state_default();
    must(&t->s, dmb_query_drive(t->s.sim, t->drive, &state));
    return state.force;
}

static void go_on_from_a_snapshot(const turner *t, double h, uint32_t steps)
{
    dmb_sim *again = NULL;
    size_t size = 0;
    must(&t->s, dmb_sim_snapshot_size(t->s.sim, &size));
    void *bytes = malloc(size);
    must(&t->s, dmb_sim_snapshot(t->s.sim, bytes, size));
    must_model(&t->s, dmb_sim_create(t->s.model, NULL, &again));
    must(&t->s, dmb_sim_restore(again, bytes, size));
    const rig other = {t->s.model, again};
    take_steps(&t->s, h, steps);
    take_steps(&other, h, steps);
    assert_true(rig_hash(&other) == rig_hash(&t->s));
    free(bytes);
    dmb_sim_destroy(&again);
}

/* A joint's coordinate is driven as the body's own component is. */
static void on_a_joint_as_on_a_body(void **state)
{
    (void)state;
    turner t[2];
    double worst = 0.0, largest = 0.0;
    for (int k = 0; k < 2; k++) {
        const wish w = {.jointed = k, .drive = with_everything()};
        t[k] = open_turner(&w);
        must(&t[k].s, dmb_sim_set_drive(t[k].s.sim, t[k].drive, 6.0));
    }
    for (int i = 0; i < 800; i++) {
        for (int k = 0; k < 2; k++) {
            if (i == 400) must(&t[k].s, dmb_sim_set_drive(t[k].s.sim, t[k].drive, -3.0));
            take_steps(&t[k].s, 2e-3, 1);
        }
        worst = fmax(worst, fabs(speed_of(&t[0]) - speed_of(&t[1])));
        worst = fmax(worst, fabs(force_of(&t[0]) - force_of(&t[1])) / 80.0);
        largest = fmax(largest, fabs(speed_of(&t[0])));
    }
    assert_true(largest > 4.0);
    check_below("speed and force on a joint, on a body", worst, 1e-8);
    for (int k = 0; k < 2; k++) {
        must(&t[k].s, dmb_sim_set_drive(t[k].s.sim, t[k].drive, 2.0));
        go_on_from_a_snapshot(&t[k], 2e-3, 50);
        rig_close(&t[k].s);
    }
}

/* f = c (1 - exp(-t/tau)) reaches its level at -tau ln(1 - level/c), at any step. */
static void its_force_is_an_event(void **state)
{
    const double tau = 0.3, c = 40.0, level = 25.0;
    (void)state;
    for (int jointed = 0; jointed < 2; jointed++) {
        wish w = {.jointed = jointed, .level = level, .drive = dmb_drive_def_default()};
        dmb_event_report report = dmb_event_report_default();
        w.drive.kind = DMB_DRIVE_LOAD;
        w.drive.lag = tau;
        turner t = open_turner(&w);
        must(&t.s, dmb_sim_set_drive(t.s.sim, t.drive, c));
        take_steps(&t.s, 5e-3, 3);
        assert_int_equal(dmb_sim_advance_to_event(t.s.sim, 2.0, &report, NULL), DMB_NOTE_EVENT);
        assert_true(report.count == 1 && report.events == 1);
        check_close("time at which the torque is reached [s]", report.time, -tau * log(1.0 - level / c), 2e-9);
        check_relative("    the torque [N m]", force_of(&t), level, 1e-8);
        go_on_from_a_snapshot(&t, 5e-3, 20);
        rig_close(&t.s);
    }
}

/* A spring, and a motor whose force falls by `slope` [N m s] where it asks for more than it can: J s^2 + (slope + drag)
 * s + k = 0; below its curve the gain damps instead. */
static void modes_know_the_curve(void **state)
{
    const double k = 900.0, drag = 2.0, slope = 8.0;
    (void)state;
    for (int jointed = 0; jointed < 2; jointed++)
        for (int limited = 0; limited < 2; limited++) {
            wish w = {.jointed = jointed, .spring = k, .drive = dmb_drive_def_default()};
            w.drive.kind = limited ? DMB_DRIVE_LOAD : DMB_DRIVE_CONTROL;
            w.drive.gain = limited ? 0.0 : 5.0;
            w.drive.drag = w.drive.back_drag = drag;
            w.drive.curve_count = 2;
            w.drive.curve_speed[0] = -10.0;
            w.drive.curve_speed[1] = 10.0;
            w.drive.curve_force[0] = 20.0 * slope; /* 10 slope at rest */
            turner t = open_turner(&w);
            if (limited) must(&t.s, dmb_sim_set_drive(t.s.sim, t.drive, 1000.0));
            find_equilibrium(&t.s, NULL);
            dmb_modes *modes = lowest_modes(&t.s, DMB_MODES_DAMPED, 1);
            const dmb_mode mode = mode_at(modes, 0);
            const double c = drag + (limited ? slope : 5.0);
            check_relative("real part [1/s]", mode.eigenvalue[0], -0.5 * c / J, 1e-9);
            check_relative("imaginary part [1/s]", mode.eigenvalue[1], sqrt(k / J - 0.25 * c * c / (J * J)), 1e-9);
            dmb_modes_destroy(&modes);
            rig_close(&t.s);
        }
}

/* A string that a drive with an actuator turns has no steady state by statics: it says so. */
static void steady_states_refuse(void **state)
{
    (void)state;
    for (int with = 0; with < 2; with++) {
        rig s;
        dmb_wall_def wall = s1_hole();
        dmb_string_def string = dmb_string_def_default();
        dmb_pipe_def pipe = s1_pipe();
        dmb_drive_def drive = dmb_drive_def_default(), brake = dmb_drive_def_default();
        dmb_static_options options = dmb_static_options_default();
        rig_open(&s, 0.0, 0.0, -9.81);
        add_wall(&s, &wall);
        string.start_free = DMB_FREE_RX;
        drive.part = brake.part = pipe.string = add_string(&s, &string);
        add_pipes(&s, &pipe, 3);
        drive.component = brake.component = DMB_RX;
        drive.time_function = add_constant(&s, 5.0);
        add_drive(&s, &drive);
        brake.kind = DMB_DRIVE_LOAD;
        brake.time_function = add_constant(&s, 10.0);
        brake.lag = with ? 0.1 : 0.0;
        const int32_t added = dmb_model_add_drive(s.model, &brake, NULL);
        if (added >= 0) {
            rig_start(&s, NULL);
            options.steady = DMB_STEADY_SLIDING;
            const uint64_t hash = rig_hash(&s);
            const int32_t status = dmb_analysis_static(s.sim, &options, NULL);
            if (with) {
                assert_int_equal(status, DMB_ERR_UNSUPPORTED);
                assert_non_null(strstr(dmb_sim_message(s.sim), "actuator"));
                assert_true(rig_hash(&s) == hash);
            } else {
                must(&s, status);
            }
        } else {
            print_message("    refused: %s\n", dmb_model_message(s.model));
        }
        rig_close(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(on_a_joint_as_on_a_body),
        cmocka_unit_test(its_force_is_an_event),
        cmocka_unit_test(modes_know_the_curve),
        cmocka_unit_test(steady_states_refuse),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
