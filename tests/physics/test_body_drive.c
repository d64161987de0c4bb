/* Drives on single bodies: motion by every kind of time function, corners, speed control with limits, what does not fit
 * at the start, and a thousand revolutions. */
#include <stdio.h>
#include <string.h>

#include "rig.h"

/* A body of 2 kg, 0.3 kg m2 about each axis, that slides and turns along x without gravity. */
static dmb_id add_slider(rig *s)
{
    dmb_body_def body = dmb_body_def_default();
    body.mass = 2.0;
    for (int i = 0; i < 3; i++) body.inertia[i] = 0.3;
    body.free_mask = DMB_FREE_CYLINDRICAL;
    return add_body(s, &body);
}

static dmb_drive_state drive_of(const rig *s, dmb_id drive)
{
    dmb_drive_state state = dmb_drive_state_default();
    must(s, dmb_query_drive(s->sim, drive, &state));
    return state;
}

/* ---- Motion by every kind of time function
 * --------------------------------------------------------------------------- */

/* STEP term: integral h0 t and h0 s + (h1-h0)(x1-x0)(D^3 - D^4/2), then h1 (eq:drive.step). */
static double step_integral(double x0, double h0, double x1, double h1, double t)
{
    const double D = t <= x0 ? 0.0 : t >= x1 ? 1.0 : (t - x0) / (x1 - x0);
    const double ramp = (h1 - h0) * (x1 - x0) * (D * D * D - 0.5 * D * D * D * D);
    return h0 * t + ramp + (t > x1 ? (h1 - h0) * (t - x1) : 0.0);
}

/* D^3 (10 - 15 D + 6 D^2) has the integral D^4 (2.5 - 3 D + D^2). */
static double step5_integral(double x0, double h0, double x1, double h1, double t)
{
    const double D = t <= x0 ? 0.0 : t >= x1 ? 1.0 : (t - x0) / (x1 - x0);
    const double ramp = (h1 - h0) * (x1 - x0) * (D * D * D * D * (2.5 - 3.0 * D + D * D));
    return h0 * t + ramp + (t > x1 ? (h1 - h0) * (t - x1) : 0.0);
}

static int32_t bell(void *context, double t, double out[3])
{
    const double c = *(const double *)context;
    out[0] = c * t * exp(-t);
    out[1] = c * (1.0 - t) * exp(-t);
    out[2] = c * (1.0 - (1.0 + t) * exp(-t));
    return 0;
}

static double bell_size = 0.7;
static const double table_time[4] = {0.0, 0.5, 1.25, 2.0}, table_value[4] = {0.0, 0.4, -0.2, 0.3};

static double table_integral(double t)
{
    double sum = 0.0;
    for (int i = 0; i < 3; i++) {
        const double end = fmin(t, table_time[i + 1]), width = end - table_time[i];
        if (!(width > 0.0)) return sum;
        const double slope = (table_value[i + 1] - table_value[i]) / (table_time[i + 1] - table_time[i]);
        sum += width * (table_value[i] + 0.5 * slope * width);
    }
    return sum + fmax(0.0, t - table_time[3]) * table_value[3];
}

static double speed_integral(int32_t kind, double t)
{
    switch (kind) {
    case DMB_SEGMENT_CONSTANT: return 0.25 * t;
    case DMB_SEGMENT_STEP: return step_integral(0.3, 0.0, 1.4, -0.5, t);
    case DMB_SEGMENT_STEP5: return step5_integral(0.3, 0.1, 1.4, -0.5, t);
    case DMB_SEGMENT_HARMONIC: return 0.1 * t + 0.4 / 5.0 * (cos(0.6) - cos(5.0 * t + 0.6));
    case DMB_SEGMENT_TABLE: return table_integral(t);
    default: return bell_size * (1.0 - (1.0 + t) * exp(-t));
    }
}

static dmb_segment speed_segment(int32_t kind)
{
    dmb_segment term = dmb_segment_default();
    term.kind = kind;
    term.x0 = 0.3, term.x1 = 1.4;
    term.h0 = 0.25;
    if (kind == DMB_SEGMENT_STEP) term.h0 = 0.0, term.h1 = -0.5;
    if (kind == DMB_SEGMENT_STEP5) term.h0 = 0.1, term.h1 = -0.5;
    if (kind == DMB_SEGMENT_HARMONIC) term.h0 = 0.1, term.h1 = 0.4, term.omega = 5.0, term.phase = 0.6;
    if (kind == DMB_SEGMENT_TABLE) {
        term.table_time = table_time;
        term.table_value = table_value;
        term.table_count = 4;
    }
    if (kind == DMB_SEGMENT_CALLBACK) {
        term.callback = bell;
        term.callback_context = &bell_size;
        term.provides = DMB_PROVIDES_RATE | DMB_PROVIDES_INTEGRAL;
    }
    return term;
}

/* Place and turn follow the integral of the time function exactly, whatever the step. */
static void motion_follows_every_kind_of_time_function(void **state)
{
    (void)state;
    for (int32_t kind = DMB_SEGMENT_CONSTANT; kind <= DMB_SEGMENT_CALLBACK; kind++) {
        rig s;
        dmb_segment term = speed_segment(kind);
        double worst = 0.0, turned = 0.0, driven = 0.0;
        char what[64];
        rig_open(&s, 0.0, 0.0, 0.0);
        const dmb_id body = add_slider(&s), time_function = add_time_function(&s, &term, 1);
        const dmb_id feed = add_simple_drive(&s, DMB_DRIVE_MOTION, body, DMB_X, time_function);
        (void)add_simple_drive(&s, DMB_DRIVE_MOTION, body, DMB_RX, time_function);
        (void)rig_start(&s, NULL);
        for (int i = 0; i < 250; i++) {
            take_steps(&s, 0.01, 1);
            const double want = speed_integral(kind, dmb_sim_time(s.sim));
            worst = fmax(worst, fabs(pose_at(&s, dmb_station(body, 0, 0.0)).displacement[0] - want));
            turned = fmax(turned, fabs(rotation_at(&s, dmb_station(body, 0, 0.0)) - want));
            driven = fmax(driven, fabs(drive_of(&s, feed).position - want));
        }
        (void)snprintf(what, sizeof what, "time function kind %d: place off its integral", kind);
        check_below(what, worst, 1e-12);
        check_below("    turn", turned, 1e-12);
        check_below("    position that the drive tells", driven, 1e-12);
        rig_close(&s);
    }
}

/* Force m dv/dt of a prescribed motion, at the end of each step. */
static void force_of_a_prescribed_motion(void **state)
{
    (void)state;
    rig s;
    dmb_segment term = speed_segment(DMB_SEGMENT_HARMONIC);
    double worst = 0.0;
    rig_open(&s, 0.0, 0.0, 0.0);
    const dmb_id body = add_slider(&s);
    const dmb_id feed = add_simple_drive(&s, DMB_DRIVE_MOTION, body, DMB_X, add_time_function(&s, &term, 1));
    (void)rig_start(&s, NULL);
    for (int i = 0; i < 200; i++) {
        take_steps(&s, 0.01, 1);
        const double t = dmb_sim_time(s.sim), want = 2.0 * 0.4 * 5.0 * cos(5.0 * t + 0.6);
        const dmb_drive_state state_now = drive_of(&s, feed);
        worst = fmax(worst, fabs(state_now.force - want));
        worst = fmax(worst, fabs(state_now.power - want * (0.1 + 0.4 * sin(5.0 * t + 0.6))));
    }
    check_below("force and power of a prescribed motion", worst, 1e-12);
    rig_close(&s);
}

/* ---- Corners ----------------------------------------------------------------------------------------------------- */

/* A force along straight lines between the corners of a table: a step over the corners is divided there, and nowhere
 * else. In each part the force is linear in time, so the scheme's speed is off by terms of the kinks' size only. */
static void corners_are_ends_of_steps(void **state)
{
    (void)state;
    rig s;
    const double time[4] = {0.1, 0.25, 0.333, 0.777}, value[4] = {0.0, 1.0, 1.0, -1.0};
    dmb_segment term = dmb_segment_default();
    dmb_step_report report = dmb_step_report_default();
    dmb_sim_options options = dmb_sim_options_default();
    options.spectral_radius = 1.0;
    term.kind = DMB_SEGMENT_TABLE;
    term.table_time = time;
    term.table_value = value;
    term.table_count = 4;
    rig_open(&s, 0.0, 0.0, 0.0);
    const dmb_id body = add_slider(&s);
    (void)add_simple_drive(&s, DMB_DRIVE_LOAD, body, DMB_X, add_time_function(&s, &term, 1));
    (void)rig_start(&s, &options);
    assert_int_equal(dmb_sim_step(s.sim, 1.0, &report), DMB_OK);
    assert_int_equal(report.steps, 5);
    check_close("time after a divided step", report.time, 1.0, 0.0);
    const double impulse = 0.5 * 0.15 + 0.083 - 0.223;
    check_close("impulse, trapezoids between the corners",
                2.0 * motion_at(&s, dmb_station(body, 0, 0.0), DMB_FRAME_WORLD).velocity[0], impulse, 1e-12);
    assert_int_equal(dmb_sim_step(s.sim, 1.0, &report), DMB_OK);
    assert_int_equal(report.steps, 1);
    rig_close(&s);
}

/* Error-controlled advance ends steps there too: with a huge tolerance the steps are those between the corners. */
static void advance_stops_at_corners(void **state)
{
    (void)state;
    rig s;
    dmb_segment term = dmb_segment_default();
    dmb_sim_options options = dmb_sim_options_default();
    dmb_step_report report = dmb_step_report_default();
    term.kind = DMB_SEGMENT_STEP;
    term.x0 = 0.3, term.x1 = 1.1, term.h1 = 0.5;
    options.tolerance_translation = options.tolerance_rotation = 1e3;
    options.step_max = 100.0;
    rig_open(&s, 0.0, 0.0, 0.0);
    const dmb_id body = add_slider(&s);
    (void)add_simple_drive(&s, DMB_DRIVE_MOTION, body, DMB_X, add_time_function(&s, &term, 1));
    (void)rig_start(&s, &options);
    const double corner[3] = {0.3, 1.1, 3.0};
    for (int i = 0; i < 3; i++) {
        must(&s, dmb_sim_advance(s.sim, corner[i], &report));
        check_close("time reached", dmb_sim_time(s.sim), corner[i], 0.0);
        check_close("    place", pose_at(&s, dmb_station(body, 0, 0.0)).displacement[0],
                    step_integral(0.3, 0.0, 1.1, 0.5, corner[i]), 1e-13);
    }
    must(&s, dmb_sim_advance(s.sim, 5.0, &report));
    rig_close(&s);
}

/* ---- Speed control ----------------------------------------------------------------------------------------------- */

/* m v' = clamp(kp e + ki z), e = v* - v, z' = e held while the limit acts. Limited until e = F/kp; then
 * m e'' + kp e' + ki e = 0 with e = F/kp and e' = -F/m (z still 0). */
static double controlled_speed(double m, double kp, double ki, double limit, double target, double t)
{
    const double free = m * (target - limit / kp) / limit;
    if (t <= free) return limit * t / m;
    const double s = t - free, a = 0.5 * kp / m, w = sqrt(ki / m - a * a), e0 = limit / kp;
    const double e = exp(-a * s) * (e0 * cos(w * s) + (a * e0 - limit / m) / w * sin(w * s));
    return target - e;
}

/* 2 kg to 3 m/s, kp 8 N s/m, ki 20 N/m, at most 6 N: limited for 0.75 s. Errors fall by four as the step halves. */
static void control_error(double h, double *speed, double *force)
{
    rig s;
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_sim_options options = dmb_sim_options_default();
    options.newton_tolerance = 1e-13;
    rig_open(&s, 0.0, 0.0, 0.0);
    drive.kind = DMB_DRIVE_CONTROL;
    drive.part = add_slider(&s);
    drive.component = DMB_X;
    drive.time_function = add_constant(&s, 3.0);
    drive.gain = 8.0;
    drive.integral_gain = 20.0;
    drive.limit_low = -6.0;
    drive.limit_high = 6.0;
    const dmb_id id = add_drive(&s, &drive);
    (void)rig_start(&s, &options);
    *speed = *force = 0.0;
    for (int i = 1; i <= lround(3.0 / h); i++) {
        take_steps(&s, h, 1);
        const double t = i * h, v = controlled_speed(2.0, 8.0, 20.0, 6.0, 3.0, t);
        const double d = 1e-6, slope = (controlled_speed(2.0, 8.0, 20.0, 6.0, 3.0, t + d) - v) / d;
        const dmb_drive_state got = drive_of(&s, id);
        *speed = fmax(*speed, fabs(got.speed - v));
        if (fabs(t - 0.75) > 2.5 * h) *force = fmax(*force, fabs(got.force - 2.0 * slope));
    }
    rig_close(&s);
}

static void speed_control_with_limits(void **state)
{
    (void)state;
    const double free = 2.0 * (3.0 - 6.0 / 8.0) / 6.0;
    check_close("end of the limit [s]", free, 0.75, 1e-15);
    double speed[2], force[2];
    control_error(0.01, speed, force);
    control_error(0.005, speed + 1, force + 1);
    check_below("speed at h 5e-3", speed[1], 2e-4);
    check_order("speed", speed[0], speed[1], 2.0, 0.15);
    tell("    force at h 5e-3", force[1]);
}

/* ---- Hard case 11: speeds that do not fit ------------------------------------------------------------------------ */

static void speeds_that_do_not_fit_are_projected(void **state)
{
    (void)state;
    rig s;
    dmb_body_def body = dmb_body_def_default();
    rig_open(&s, 0.0, 0.0, 0.0);
    body.free_mask = DMB_FREE_CYLINDRICAL;
    body.velocity[0] = 1.0;  /* the drive wants 0.25 */
    body.velocity[1] = 0.2;  /* held */
    body.velocity[3] = 5.0;  /* free */
    body.velocity[5] = -0.4; /* held */
    const dmb_id id = add_body(&s, &body);
    (void)add_simple_drive(&s, DMB_DRIVE_MOTION, id, DMB_X, add_constant(&s, 0.25));
    assert_int_equal(rig_start(&s, NULL), DMB_NOTE_PROJECTED);
    assert_true(strlen(dmb_sim_message(s.sim)) > 0);
    const dmb_statistics statistics = statistics_of(&s);
    check_close("projection of speeds [m/s]", statistics.projection[0], 0.75, 1e-15);
    check_close("projection of turning [rad/s]", statistics.projection[1], 0.4, 1e-15);
    const double want[6] = {0.25, 0.0, 0.0, 5.0, 0.0, 0.0};
    const dmb_motion motion = motion_at(&s, dmb_station(id, 0, 0.0), DMB_FRAME_BODY);
    check_below("speeds after it", largest_difference(6, motion.velocity, want), 0.0);
    rig_close(&s);
}

/* ---- Hard case 5: a thousand revolutions ------------------------------------------------------------------------- */

static double off_orthonormal(const double R[9])
{
    double worst = 0.0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            const double dot = R[i] * R[j] + R[3 + i] * R[3 + j] + R[6 + i] * R[6 + j];
            worst = fmax(worst, fabs(dot - (i == j ? 1.0 : 0.0)));
        }
    return worst;
}

/* Two flexible pipes turned at 200 rpm for 300 s against viscous torque: the torque of the last second is that of the
 * first settled one, angles count every turn, rotations stay rotations. The rounding of a pose, times EA/L, is 6e-7 N,
 * and a step takes that for zero: 5e-9 of the torque. */
static void thousand_revolutions(void **state)
{
    (void)state;
    rig s;
    dmb_environment_def environment = dmb_environment_def_default();
    dmb_sim_options options = dmb_sim_options_default();
    dmb_pipe_def pipe = s1_pipe();
    dmb_segment term = dmb_segment_default();
    const double speed = 200.0 / 60.0 * 2.0 * PI, turned = speed * (300.0 - 0.5);
    rig_open(&s, 0.0, 0.0, 0.0);
    for (int i = 0; i < 3; i++) environment.gravity[i] = 0.0;
    environment.torsional_damping = 2.0;
    must_model(&s, dmb_model_set_environment(s.model, &environment));
    term.kind = DMB_SEGMENT_STEP;
    term.h1 = speed;
    const dmb_id string = add_pipes(&s, &pipe, 2);
    const dmb_id drive = add_simple_drive(&s, DMB_DRIVE_MOTION, string, DMB_RX, add_time_function(&s, &term, 1));
    options.energy_ledger = 0;
    options.newton_tolerance = 1e-13;
    (void)rig_start(&s, &options);
    take_steps(&s, 5e-3, 4000);
    const double early = drive_of(&s, drive).force,
                 twist = rotation_at(&s, dmb_station(string, 0, 0.0)) - rotation_at(&s, dmb_station(string, 1, 1.0));
    take_steps(&s, 5e-3, 56000);
    check_close("rig end turned by [rad]", rotation_at(&s, dmb_station(string, 0, 0.0)), turned, 1e-10 * turned);
    check_relative("torque after 1000 revolutions over that after 65", drive_of(&s, drive).force, early, 5e-9);
    check_relative("    against 2 N s on 3 m", early, 2.0 * 3.0 * speed, 5e-9);
    check_relative("twist likewise",
                   rotation_at(&s, dmb_station(string, 0, 0.0)) - rotation_at(&s, dmb_station(string, 1, 1.0)), twist,
                   1e-7);
    for (uint32_t i = 0; i < 2; i++)
        check_below("rotation off orthonormal", off_orthonormal(pose_at(&s, dmb_station(string, i, 1.0)).rotation),
                    1e-14);
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(motion_follows_every_kind_of_time_function),
        cmocka_unit_test(force_of_a_prescribed_motion),
        cmocka_unit_test(corners_are_ends_of_steps),
        cmocka_unit_test(advance_stops_at_corners),
        cmocka_unit_test(speed_control_with_limits),
        cmocka_unit_test(speeds_that_do_not_fit_are_projected),
        cmocka_unit_test(thousand_revolutions),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
