/* Actuators of drives, on a body that turns about one axis, against closed forms (lag, delay, rate limit, speed curve,
 * delayed control by the method of steps), an integration of another kind (back-spin of a wound spring), and the energy
 * balance; snapshots, statics and what is refused. Equations: eq:drive.actuator. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "drillmbd/drillmbd.h"
#include "ode.h"

#define must(call) assert_int_equal((call), DMB_OK)
#define J 2.5 /* [kg m2] */

static void check_between(const char *what, double got, double low, double high)
{
    check_close(what, got, 0.5 * (low + high), 0.5 * (high - low));
}

typedef struct turner {
    dmb_model *model;
    dmb_sim *sim;
    dmb_id body, drive;
    double spring; /* [N m/rad] to the ground; 0: none */
    double wound;  /* [rad] at time 0 */
    int32_t bounded;
} turner;

static dmb_id constant(dmb_model *model, double value)
{
    dmb_segment term = dmb_segment_default();
    dmb_id id;
    term.h0 = value;
    must(dmb_model_add_time_function(model, &term, 1, &id));
    return id;
}

/* The body with what is left of J beside the rotor. */
static void describe(turner *t, dmb_drive_def *def)
{
    dmb_body_def body = dmb_body_def_default();
    must(dmb_model_create(NULL, &t->model));
    body.free_mask = DMB_FREE_RX;
    body.inertia[0] = J - def->inertia;
    body.inertia[1] = body.inertia[2] = J;
    must(dmb_model_add_body(t->model, &body, &t->body));
    if (t->spring > 0.0) {
        dmb_joint_def joint = dmb_joint_def_default();
        joint.kind = DMB_JOINT_REVOLUTE;
        joint.place_b = dmb_station(t->body, 0, 0.0);
        joint.stiffness[DMB_RX] = t->spring;
        joint.initial_mask = DMB_FREE_RX;
        joint.initial_position[DMB_RX] = t->wound;
        must(dmb_model_add_joint(t->model, &joint, NULL));
    }
    def->part = t->body;
    def->component = DMB_RX;
    if (def->time_function.generation == 0) def->time_function = constant(t->model, 0.0);
}

static void start(turner *t, const dmb_drive_def *def)
{
    dmb_sim_options options = dmb_sim_options_default();
    options.energy_ledger = 1;
    options.bounded_work = t->bounded;
    options.newton_tolerance = 1e-12;
    must(dmb_model_add_drive(t->model, def, &t->drive));
    must(dmb_model_compile(t->model, NULL));
    const int32_t status = dmb_sim_create(t->model, &options, &t->sim);
    if (status < 0) fail_msg("%s", dmb_model_message(t->model));
}

static turner open_turner(dmb_drive_def def)
{
    turner t = {0};
    describe(&t, &def);
    start(&t, &def);
    return t;
}

static void close_turner(turner *t)
{
    dmb_sim_destroy(&t->sim);
    dmb_model_destroy(&t->model);
}

static dmb_drive_state ask(const turner *t)
{
    dmb_drive_state state = dmb_drive_state_default();
    must(dmb_query_drive(t->sim, t->drive, &state));
    return state;
}

static void steps(turner *t, double h, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        const int32_t status = dmb_sim_step(t->sim, h, NULL);
        if (status < 0) fail_msg("%s", dmb_sim_message(t->sim));
    }
}

static void check_balance(const turner *t, double bound)
{
    dmb_energy energy = dmb_energy_default();
    must(dmb_query_energy(t->sim, &energy));
    check_below("unexplained energy over input", fabs(energy.unexplained) / energy.input, bound);
}

static dmb_drive_def load_drive(void)
{
    dmb_drive_def def = dmb_drive_def_default();
    def.kind = DMB_DRIVE_LOAD;
    return def;
}

/* f = c (1 - exp(-t/tau)) at any step, J w = c (t - tau (1 - exp(-t/tau))) to second order. */
static void lag_is_the_closed_form(void **state)
{
    const double tau = 0.3, c = 40.0, end = 1.8;
    double error[3];
    (void)state;
    for (uint32_t k = 0; k < 3; k++) {
        const uint32_t count = 6u << (2 * k);
        dmb_drive_def def = load_drive();
        def.lag = tau;
        turner t = open_turner(def);
        must(dmb_sim_set_drive(t.sim, t.drive, c));
        steps(&t, end / count, count);
        const dmb_drive_state s = ask(&t);
        check_below("lag: force", fabs(s.force / (c * (1.0 - exp(-end / tau))) - 1.0), 1e-13);
        assert_true(s.command == c && s.made == s.force);
        error[k] = fabs(s.speed * J / (c * (end - tau * (1.0 - exp(-end / tau)))) - 1.0);
        close_turner(&t);
    }
    check_between("lag: order of the speed", log2(error[0] / error[1]) / 2.0, 1.9, 2.2);
    check_between("lag: order of the speed, finer", log2(error[1] / error[2]) / 2.0, 1.95, 2.05);
}

/* A command set at t0 acts from t0 + T on, whatever the step: J w = c (t - t0 - T). */
static void delay_is_the_time_told(void **state)
{
    static const double lengths[] = {0.5, 0.2, 0.037, 0.01, 0.0007};
    const double T = 0.1234, c = 40.0;
    (void)state;
    for (uint32_t k = 0; k < 5; k++) {
        dmb_drive_def def = load_drive();
        def.delay = T;
        turner t = open_turner(def);
        steps(&t, lengths[k], 1);
        const double set = dmb_sim_time(t.sim);
        must(dmb_sim_set_drive(t.sim, t.drive, c));
        assert_true(ask(&t).force == 0.0 && ask(&t).command == c);
        while (dmb_sim_time(t.sim) + lengths[k] < set + T) {
            steps(&t, lengths[k], 1);
            assert_true(ask(&t).force == 0.0);
        }
        while (dmb_sim_time(t.sim) < set + 0.7) steps(&t, lengths[k], 1);
        check_below("delay: speed", fabs(ask(&t).speed * J / (c * (dmb_sim_time(t.sim) - set - T)) - 1.0), 1e-12);
        const double second = dmb_sim_time(t.sim), speed = ask(&t).speed;
        must(dmb_sim_set_drive(t.sim, t.drive, -c)); /* and back */
        while (dmb_sim_time(t.sim) < second + 0.7) steps(&t, lengths[k], 1);
        const double gone = dmb_sim_time(t.sim) - second;
        check_below("delay: speed after a second jump",
                    fabs((ask(&t).speed - speed) * J / (c * (T - (gone - T))) - 1.0), 1e-12);
        close_turner(&t);
    }
}

/* Edges of a table, far steeper than T/256, arrive as they were: J w is the integral of the table up to t - T. Steep
 * rise at time 0, a fall and a rise in the middle, two corners within T/256. */
static void edges_of_a_table_pass_a_delay(void **state)
{
    static const double time[9] = {0.0, 1e-9, 0.05, 0.05 + 1e-9, 0.11, 0.11 + 1e-9, 0.1105, 0.1105 + 1e-9, 9.0};
    static const double share[9] = {0.0, 1.0, 1.0, -0.5, -0.5, 2.0, 2.0, 0.5, 0.5};
    static const double lengths[] = {1e-2, 1e-3, 2e-4};
    const double T = 0.3, c = 40.0, exact = c * (0.05 - 0.5 * 0.06 + 2.0 * 5e-4 + 0.5 * (0.2 - 0.1105));
    (void)state;
    for (uint32_t k = 0; k < 3; k++) {
        dmb_drive_def def = load_drive();
        dmb_segment term = dmb_segment_default();
        double value[9];
        turner t = {0};
        for (int i = 0; i < 9; i++) value[i] = c * share[i];
        term.kind = DMB_SEGMENT_TABLE;
        term.table_count = 9;
        term.table_time = time;
        term.table_value = value;
        def.delay = T;
        describe(&t, &def);
        must(dmb_model_add_time_function(t.model, &term, 1, &def.time_function));
        start(&t, &def);
        while (dmb_sim_time(t.sim) < 0.5 - 1e-9) steps(&t, lengths[k], 1);
        check_below("delay: speed after edges of a table", fabs(ask(&t).speed * J / exact - 1.0), 1e-8);
        close_turner(&t);
    }
}

/* v' = k (1 - v(t - T)) with k (1 - v) as it was at time 0 before: v = k t up to T, then k T + k (s - k s^2/2). */
static void delayed_control_is_of_second_order(void **state)
{
    const double T = 0.25, k = 1.6, s = 0.25, exact = k * T + k * (s - 0.5 * k * s * s);
    double error[4];
    (void)state;
    for (uint32_t i = 0; i < 4; i++) {
        const uint32_t count = 14u << i;
        dmb_drive_def def = dmb_drive_def_default();
        turner t = {0};
        def.kind = DMB_DRIVE_CONTROL;
        def.gain = k * J;
        def.delay = T;
        describe(&t, &def);
        def.time_function = constant(t.model, 1.0);
        start(&t, &def);
        steps(&t, (T + s) / count, count);
        error[i] = fabs(ask(&t).speed / exact - 1.0);
        close_turner(&t);
    }
    for (uint32_t i = 0; i < 3; i++) print_message("delayed control: %u steps, error %.3g\n", 14u << i, error[i]);
    check_below("delayed control: error", error[3], 1e-3);
    check_between("delayed control: order over three halvings", log2(error[0] / error[3]) / 3.0, 1.9, 2.1);
}

static void rate_limit_ramps(void **state)
{
    const double R = 80.0, c = 40.0;
    (void)state;
    dmb_drive_def def = load_drive();
    def.force_rate = R;
    turner t = open_turner(def);
    must(dmb_sim_set_drive(t.sim, t.drive, c));
    for (uint32_t i = 1; i <= 80; i++) {
        steps(&t, 0.01, 1);
        check_below("rate: force", fabs(ask(&t).force - fmin(R * 0.01 * i, c)), 1e-11);
    }
    check_below("rate: speed", fabs(ask(&t).speed * J / (c * (0.8 - 0.25)) - 1.0), 1e-4);
    must(dmb_sim_set_drive(t.sim, t.drive, -c));
    steps(&t, 0.01, 50);
    check_below("rate: force on the way back", fabs(ask(&t).force - (c - R * 0.5)), 1e-11);
    check_balance(&t, 1e-10);
    close_turner(&t);
}

/* m(w) = 100 - 10 w meets the drag 5 w at w = 20/3; towards < 0 the back drag 15 w at w = -4. */
static void curve_meets_its_load(void **state)
{
    (void)state;
    for (int sign = -1; sign <= 1; sign += 2) {
        dmb_drive_def def = load_drive();
        def.curve_count = 2;
        def.curve_speed[1] = 10.0;
        def.curve_force[0] = 100.0;
        def.drag = 5.0;
        def.back_drag = 15.0;
        turner t = open_turner(def);
        must(dmb_sim_set_drive(t.sim, t.drive, sign * 1000.0));
        steps(&t, 0.02, 600);
        check_below("curve: speed", fabs(ask(&t).speed - (sign > 0 ? 20.0 / 3.0 : -4.0)), 1e-10);
        check_below("curve: force", fabs(ask(&t).force), 1e-9);
        assert_true(ask(&t).made == sign * 1000.0);
        check_balance(&t, 1e-3);
        close_turner(&t);
    }
}

/* ---- Back-spin --------------------------------------------------------------------------------------------------- */

typedef struct back_spin {
    double spring, lag, drag[2], held;
} back_spin;

/* The command falls from `held` to 0 between 0.1 and 0.3 s. */
static double release(const back_spin *b, double time)
{
    const double x = fmin(fmax((time - 0.1) / 0.2, 0.0), 1.0);
    return b->held * (1.0 - x * x * (3.0 - 2.0 * x));
}

static void back_spin_rate(void *context, double time, const double *y, double *rate)
{
    const back_spin *b = context;
    rate[0] = y[1];
    rate[1] = (-b->spring * y[0] + y[2] - b->drag[y[1] < 0.0] * y[1]) / J;
    rate[2] = (release(b, time) - y[2]) / b->lag;
}

/* A spring that the drive holds wound up, and that turns the drive back when that gives way. */
static void back_spin_is_the_integration(void **state)
{
    back_spin b = {300.0, 0.07, {2.0, 11.0}, 600.0};
    double y[3] = {b.held / b.spring, 0.0, b.held}, error[3];
    const double end = 0.55;
    (void)state;
    ode_solve(back_spin_rate, &b, 0.0, 0.1, 40, 3, y);
    ode_solve(back_spin_rate, &b, 0.1, 0.3, 80, 3, y);
    ode_solve(back_spin_rate, &b, 0.3, end, 100, 3, y);
    for (uint32_t k = 0; k < 3; k++) {
        const uint32_t count = 110u << k;
        dmb_drive_def def = load_drive();
        dmb_segment fall = dmb_segment_default();
        turner t = {.spring = b.spring, .wound = b.held / b.spring};
        fall.kind = DMB_SEGMENT_STEP;
        fall.x0 = 0.1;
        fall.x1 = 0.3;
        fall.h0 = b.held;
        def.inertia = 0.8;
        def.lag = b.lag;
        def.drag = b.drag[0];
        def.back_drag = b.drag[1];
        describe(&t, &def);
        must(dmb_model_add_time_function(t.model, &fall, 1, &def.time_function));
        start(&t, &def);
        steps(&t, end / count, count);
        const dmb_drive_state s = ask(&t);
        error[k] = fabs(s.speed / y[1] - 1.0);
        print_message("back-spin: %u steps: speed %.9g of %.9g, angle off by %.3g\n", count, s.speed, y[1],
                      s.position + b.held / b.spring - y[0]);
        assert_true(s.speed < -1.0);
        check_balance(&t, 1e-3);
        close_turner(&t);
    }
    check_below("back-spin: error of the speed", error[2], 1e-3);
    check_between("back-spin: order", log2(error[0] / error[2]) / 2.0, 1.9, 2.1);
}

/* ---- Life -------------------------------------------------------------------------------------------------------- */

/* Delay, rate, lag and curve at once, under control. */
static dmb_drive_def whole_drive(void)
{
    dmb_drive_def def = dmb_drive_def_default();
    def.kind = DMB_DRIVE_CONTROL;
    def.gain = 30.0;
    def.integral_gain = 20.0;
    def.limit_low = -80.0;
    def.limit_high = 80.0;
    def.delay = 0.02;
    def.force_rate = 900.0;
    def.lag = 0.03;
    def.drag = def.back_drag = 1.0;
    def.inertia = 0.5;
    def.curve_count = 3;
    def.curve_speed[1] = 5.0;
    def.curve_speed[2] = 20.0;
    def.curve_force[0] = def.curve_force[1] = 60.0;
    return def;
}

static void snapshots_go_on(void **state)
{
    size_t size = 0;
    uint64_t hash = 0, again = 1;
    (void)state;
    for (int32_t bounded = 0; bounded < 2; bounded++) {
        dmb_drive_def def = whole_drive();
        turner t = {.bounded = bounded};
        describe(&t, &def);
        start(&t, &def);
        must(dmb_sim_set_drive(t.sim, t.drive, 3.0));
        steps(&t, 0.007, 30);
        must(dmb_sim_snapshot_size(t.sim, &size));
        void *saved = malloc(size);
        assert_non_null(saved);
        must(dmb_sim_snapshot(t.sim, saved, size));
        steps(&t, 0.007, 30);
        must(dmb_sim_hash(t.sim, &hash));
        const double speed = ask(&t).speed;
        must(dmb_sim_restore(t.sim, saved, size));
        steps(&t, 0.007, 30);
        must(dmb_sim_hash(t.sim, &again));
        assert_true(hash == again && ask(&t).speed == speed);
        free(saved);
        steps(&t, 0.007, 3000);
        check_below("the set point is reached", fabs(ask(&t).speed - 3.0), 1e-6);
        close_turner(&t);
    }
}

/* Fixed and error-controlled steps come to the same. */
static void error_control_agrees(void **state)
{
    double speed[2];
    (void)state;
    for (int k = 0; k < 2; k++) {
        turner t = open_turner(whole_drive());
        must(dmb_sim_set_drive(t.sim, t.drive, 3.0));
        if (k == 0) {
            steps(&t, 1e-4, 5000);
        } else {
            const int32_t status = dmb_sim_advance(t.sim, 0.5, NULL);
            if (status < 0) fail_msg("%s", dmb_sim_message(t.sim));
        }
        speed[k] = ask(&t).speed;
        close_turner(&t);
    }
    check_below("advance against fixed steps", fabs(speed[1] / speed[0] - 1.0), 1e-3);
}

/* At rest the actuator has come to its command; a run from there begins without a jump. */
static void statics_settle(void **state)
{
    (void)state;
    dmb_drive_def def = load_drive();
    turner t = {.spring = 300.0, .wound = 0.2};
    def.lag = 0.1;
    def.delay = 0.05;
    describe(&t, &def);
    def.time_function = constant(t.model, 30.0);
    start(&t, &def);
    must(dmb_sim_set_drive(t.sim, t.drive, 60.0));
    assert_true(ask(&t).made == 30.0);
    must(dmb_analysis_static(t.sim, NULL, NULL));
    assert_true(ask(&t).made == 60.0);
    check_below("statics: angle", fabs(ask(&t).position + 0.2 - 60.0 / 300.0), 1e-9);
    steps(&t, 0.01, 50);
    check_below("statics: it stays", fabs(ask(&t).speed), 1e-9);
    assert_true(ask(&t).made == 60.0);
    close_turner(&t);
}

/* The body on a joint to the ground that is open at first, its drive on the joint. */
static turner open_joint(dmb_drive_def def)
{
    turner t = {0};
    dmb_joint_def joint = dmb_joint_def_default();
    describe(&t, &def);
    joint.kind = DMB_JOINT_REVOLUTE;
    joint.place_b = dmb_station(t.body, 0, 0.0);
    joint.state = DMB_JOINT_OPEN;
    must(dmb_model_add_joint(t.model, &joint, &def.part));
    def.time_function = constant(t.model, 30.0);
    t.body = def.part; /* what the test closes */
    start(&t, &def);
    return t;
}

/* On a joint that is open at the start nothing was commanded: the state is one that is saved and restored, and the
 * force grows from 0 when the joint closes: by J w = c (t - d - tau (1 - exp(-(t - d)/tau))). */
static void open_joints_begin_from_nothing(void **state)
{
    const double c = 30.0, tau = 0.05, delay = 0.03, end = 0.4, late = end - delay;
    (void)state;
    for (int statics = 0; statics < 2; statics++) {
        dmb_drive_def def = load_drive();
        def.lag = tau;
        def.delay = delay;
        turner t = open_joint(def);
        size_t size = 0;
        must(dmb_sim_snapshot_size(t.sim, &size));
        void *saved = malloc(size);
        assert_non_null(saved);
        if (statics)
            assert_int_equal(dmb_analysis_static(t.sim, NULL, NULL), DMB_NOTE_INCOMPLETE); /* nothing resists it */
        assert_true(ask(&t).command == 0.0 && ask(&t).made == 0.0 && ask(&t).force == 0.0);
        steps(&t, 0.01, 3);
        assert_true(ask(&t).command == 0.0 && ask(&t).made == 0.0 && ask(&t).speed == 0.0);
        must(dmb_sim_snapshot(t.sim, saved, size));
        must(dmb_sim_restore(t.sim, saved, size));
        free(saved);
        must(dmb_sim_set_joint(t.sim, t.body, DMB_JOINT_ACTIVE));
        steps(&t, 1e-4, 4000);
        check_close("made", ask(&t).made, c * (1.0 - exp(-late / tau)), 1e-6 * c);
        check_close("speed", ask(&t).speed, c / J * (late - tau * (1.0 - exp(-late / tau))), 1e-5 * c / J * late);
        close_turner(&t);
    }
}

static void expect_refused(const char *field, void (*change)(dmb_drive_def *), int32_t wanted)
{
    dmb_drive_def def = whole_drive();
    turner t = {0};
    describe(&t, &def);
    change(&def);
    const int32_t status = dmb_model_add_drive(t.model, &def, &t.drive);
    if (status != wanted || strstr(dmb_model_message(t.model), field) == NULL)
        fail_msg("%s: %d, %s", field, status, dmb_model_message(t.model));
    dmb_model_destroy(&t.model);
}

/* clang-format off */
static void as_motion(dmb_drive_def *d) { d->kind = DMB_DRIVE_MOTION; }
static void minus_delay(dmb_drive_def *d) { d->delay = -1.0; }
static void nan_lag(dmb_drive_def *d) { d->lag = (double)NAN; }
static void infinite_rate(dmb_drive_def *d) { d->force_rate = (double)INFINITY; }
static void minus_drag(dmb_drive_def *d) { d->drag = -1.0; }
static void minus_back_drag(dmb_drive_def *d) { d->back_drag = -1e-9; }
static void across(dmb_drive_def *d) { d->component = DMB_X; }
static void minus_inertia(dmb_drive_def *d) { d->inertia = -1.0; }
static void one_point(dmb_drive_def *d) { d->curve_count = 1; }
static void nine_points(dmb_drive_def *d) { d->curve_count = 9; }
static void unsorted(dmb_drive_def *d) { d->curve_speed[2] = 5.0; }
static void pulling(dmb_drive_def *d) { d->curve_force[2] = -1.0; }
static void long_delay(dmb_drive_def *d) { d->delay = 1e5; }
/* clang-format on */

static void bad_input_is_refused(void **state)
{
    (void)state;
    expect_refused("kind = 0", as_motion, DMB_ERR_UNSUPPORTED);
    expect_refused("delay = -1", minus_delay, DMB_ERR_VALUE);
    expect_refused("delay = 100000", long_delay, DMB_ERR_VALUE);
    expect_refused("lag = nan", nan_lag, DMB_ERR_NOT_FINITE);
    expect_refused("force_rate = inf", infinite_rate, DMB_ERR_NOT_FINITE);
    expect_refused("drag = -1", minus_drag, DMB_ERR_VALUE);
    expect_refused("back_drag = -1e-09", minus_back_drag, DMB_ERR_VALUE);
    expect_refused("inertia = 0.5", across, DMB_ERR_UNSUPPORTED);
    expect_refused("inertia = -1", minus_inertia, DMB_ERR_VALUE);
    expect_refused("curve_count = 1", one_point, DMB_ERR_VALUE);
    expect_refused("curve_count = 9", nine_points, DMB_ERR_VALUE);
    expect_refused("curve_speed[2] = 5", unsorted, DMB_ERR_VALUE);
    expect_refused("curve_force[2] = -1", pulling, DMB_ERR_VALUE);
}

/* Damped modes know a curve and a drag, and none of a delay, rate or lag; responses ask for forces and know neither. */
static void analyses_know_or_refuse(void **state)
{
    (void)state;
    dmb_drive_def def = whole_drive();
    turner t = open_turner(def);
    dmb_modes *modes = NULL;
    dmb_response *response = NULL;
    dmb_response_options frequencies = dmb_response_options_default();
    dmb_excitation input = dmb_excitation_default();
    dmb_output output = {.quantity = DMB_OUTPUT_VIBRATION};
    assert_int_equal(dmb_analysis_modes(t.sim, NULL, &modes), DMB_ERR_UNSUPPORTED);
    assert_non_null(strstr(dmb_sim_message(t.sim), "modes: drive 0 has an actuator (delay, force_rate or lag)"));
    input.place = output.place = dmb_station(t.body, 0, 0.0);
    input.component = DMB_RX;
    output.quantity += DMB_RX;
    assert_int_equal(dmb_analysis_response(t.sim, &frequencies, &input, 1, &output, 1, &response), DMB_ERR_UNSUPPORTED);
    assert_non_null(strstr(dmb_sim_message(t.sim), "response: drive 0 has an actuator"));
    dmb_state_space *space = NULL;
    assert_int_equal(dmb_analysis_state_space(t.sim, NULL, &input, 1, &output, 1, &space), DMB_ERR_UNSUPPORTED);
    assert_null(space);
    assert_non_null(strstr(dmb_sim_message(t.sim), "drive 0 has an actuator"));
    dmb_parameter parameter = dmb_parameter_default();
    dmb_sensitivity *sensitivity = NULL;
    parameter.step = 1.0;
    parameter.low = parameter.high = t.sim;
    assert_int_equal(dmb_sensitivity_create(t.sim, &parameter, 1, &sensitivity), DMB_ERR_UNSUPPORTED);
    assert_null(sensitivity);
    assert_non_null(strstr(dmb_sim_message(t.sim), "1 drives have an actuator with a delay"));
    close_turner(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lag_is_the_closed_form),
        cmocka_unit_test(delay_is_the_time_told),
        cmocka_unit_test(edges_of_a_table_pass_a_delay),
        cmocka_unit_test(delayed_control_is_of_second_order),
        cmocka_unit_test(rate_limit_ramps),
        cmocka_unit_test(curve_meets_its_load),
        cmocka_unit_test(back_spin_is_the_integration),
        cmocka_unit_test(snapshots_go_on),
        cmocka_unit_test(error_control_agrees),
        cmocka_unit_test(statics_settle),
        cmocka_unit_test(open_joints_begin_from_nothing),
        cmocka_unit_test(bad_input_is_refused),
        cmocka_unit_test(analyses_know_or_refuse),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
