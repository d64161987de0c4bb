/* CASES: J .5 kg m2 behind a spring k 73 N m/rad whose other end turns at 5 rad/s, friction torque 300 N m at rest and
 * 200 N m in motion: slip .3085574216 s, stick .5479452055 s, period .8565026271 s, peak 22.2908242354 rad/s; 1 % with
 * a smoothed law, 1e-4 with one that sticks.
 *
 * Twice: a block of .5 kg on the floor of the hole, pressed on it with 1000 N and drawn by a controlled drive whose
 * integral gain is the spring (a FULL node); and a rotor of .5 kg m2 at the end of an axial-torsional bar of 73 N m/rad
 * whose weight, 1000 N on a radius of 1 m in terms of torque, rubs on the wall (a PATH node). Equations:
 * eq:friction.smooth, eq:friction.bristle. */
#include "contact_scene.h"

static const double inertia = 0.5, spring = 73.0, speed = 5.0, held = 300.0, sliding = 200.0;

typedef struct rotor {
    rig scene;
    dmb_place place;
    int component; /* of velocity in the world frame */
} rotor;

/* ---- Closed form ------------------------------------------------------------------------------------------------- */

typedef struct cycle {
    double slip, stick, period, peak;
} cycle;

/* From break-away, torque excess y = A cos wt + B sin wt, A = (Ts - Tk)/k, B = Om/w; it sticks again when the speed is
 * 0. */
static cycle closed_form(double Ts, double Tk)
{
    const double w = sqrt(spring / inertia), a = (Ts - Tk) / spring, b = speed / w;
    cycle c;
    c.slip = 2.0 * (PI - atan2(a, b)) / w;
    c.stick = 2.0 * a / speed;
    c.period = c.slip + c.stick;
    c.peak = speed + w * sqrt(a * a + b * b);
    return c;
}

/* ---- Scenes ------------------------------------------------------------------------------------------------------ */

static dmb_wall_def friction_of(int32_t law, double mu_s, double mu_d, double stribeck_speed, double smoothing_speed)
{
    dmb_wall_def wall = scene_wide_wall(DMB_NORMAL_HUNT_CROSSLEY, 1e9, 1.0, 0.5);
    wall.friction_law = law;
    wall.mu_static = mu_s;
    wall.mu_dynamic = mu_d;
    wall.stribeck_speed = stribeck_speed;
    wall.smoothing_speed = smoothing_speed;
    wall.bristle_stiffness = 1e6;
    wall.bristle_damping = 500.0;
    return wall;
}

static dmb_wall_def friction(int32_t law, double stribeck_speed, double smoothing_speed)
{
    return friction_of(law, 0.3, 0.2, stribeck_speed, smoothing_speed);
}

static dmb_sim_options fine_options(double tolerance)
{
    dmb_sim_options options = dmb_sim_options_default();
    options.tolerance_translation = options.tolerance_rotation = tolerance;
    options.step_max = 2e-3;
    options.step_min = 1e-12;
    return options;
}

/* A block under 1000 N drawn by k integral(Om - v). */
static void build_block(rotor *r, const dmb_wall_def *wall, const dmb_sim_options *options)
{
    const double press = sliding / wall->mu_dynamic;
    dmb_body_def body = scene_ball(inertia, -press / wall->stiffness, DMB_FREE_X | DMB_FREE_Y | DMB_FREE_Z);
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_load_def load = dmb_load_def_default();
    scene_open(&r->scene, 0.0);
    add_wall(&r->scene, wall);
    const dmb_id id = add_body(&r->scene, &body);
    r->place = dmb_station(id, 0, 0.0);
    r->component = DMB_X;
    load.place = r->place;
    load.force[2] = -press;
    add_load(&r->scene, &load);
    drive.kind = DMB_DRIVE_CONTROL;
    drive.part = id;
    drive.integral_gain = spring;
    drive.time_function = add_constant(&r->scene, speed);
    add_drive(&r->scene, &drive);
    rig_start_with(&r->scene, NULL, options);
}

/* A disc of J = .5 behind a light bar; the weight of the disc times the pipe's radius is 1000 N m of torque. */
static void build_bar(rotor *r, const dmb_wall_def *wall, const dmb_sim_options *options)
{
    const double press = sliding / wall->mu_dynamic;
    dmb_wall_def hole = *wall;
    dmb_body_def disc = dmb_body_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    hole.stribeck_speed *= 0.5 * pipe.outer_diameter;
    hole.smoothing_speed *= 0.5 * pipe.outer_diameter;
    hole.bristle_stiffness /= 0.5 * pipe.outer_diameter; /* the same in terms of angles */
    hole.bristle_damping /= 0.5 * pipe.outer_diameter;
    pipe.kind = DMB_PIPE_AXIAL_TORSIONAL;
    pipe.section_stiffness[3] = spring * pipe.length;
    pipe.section_mass = 1e-3;
    pipe.section_inertia[0] = 1e-9;
    disc.mass = press / (9.81 * 0.5 * pipe.outer_diameter);
    disc.attach = DMB_ATTACH_END;
    disc.inertia[0] = inertia;
    disc.inertia[1] = disc.inertia[2] = 1.0;
    string.start_free = DMB_FREE_RX;
    string.end_free = DMB_FREE_RX;
    scene_open(&r->scene, 9.81);
    add_wall(&r->scene, &hole);
    add_string(&r->scene, &string);
    const dmb_id id = add_pipes(&r->scene, &pipe, 1);
    add_body(&r->scene, &disc);
    drive.component = DMB_RX;
    drive.time_function = add_constant(&r->scene, speed);
    add_drive(&r->scene, &drive);
    rig_start_with(&r->scene, NULL, options);
    r->place = dmb_station(id, 0, 1.0);
    r->component = DMB_RX;
}

static double speed_of(const rotor *r)
{
    dmb_motion motion = dmb_motion_default();
    assert_int_equal(dmb_query_motion(r->scene.sim, r->place, &motion), DMB_OK);
    return motion.velocity[r->component];
}

/* ---- Measurement ------------------------------------------------------------------------------------------------- */

/* Times at which the speed passes a small threshold upwards and downwards, over the last of `cycles` cycles. Just after
 * break-away and just before sticking the acceleration is +-(Ts - Tk)/J, which leads from the threshold to 0. */
static cycle measure(rotor *r, int cycles, double sample)
{
    const double threshold = 0.02, lead = threshold * inertia / (held - sliding);
    double up[8] = {0.0}, down[8] = {0.0}, peak = 0.0, v0 = speed_of(r);
    int ups = 0, downs = 0;
    for (int k = 1; ups < cycles + 1 && k < 1000000; k++) {
        const double t = sample * k;
        scene_advance(&r->scene, t);
        const double v1 = speed_of(r), at = t - sample * (v1 - threshold) / (v1 - v0);
        if (ups == cycles) peak = fmax(peak, v1);
        if (v0 < threshold && v1 >= threshold) up[ups++] = at;
        if (v0 >= threshold && v1 < threshold) down[downs++] = at;
        if (ups == cycles) peak = fmax(peak, v1);
        v0 = v1;
    }
    assert_int_equal(ups, cycles + 1);
    cycle c;
    c.slip = down[cycles - 1] - up[cycles - 1] + 2.0 * lead;
    c.stick = up[cycles] - down[cycles - 1] - 2.0 * lead;
    c.period = up[cycles] - up[cycles - 1];
    c.peak = peak;
    return c;
}

static void tell_cycle(const char *what, const rotor *r, cycle c)
{
    const dmb_statistics s = statistics_of(&r->scene);
    print_message("%s: slip %.7f stick %.7f period %.7f peak %.6f (%llu steps, %llu rejected)\n", what, c.slip, c.stick,
                  c.period, c.peak, (unsigned long long)s.steps, (unsigned long long)s.rejected);
}

static void check_cycle(cycle got, cycle want, double tolerance)
{
    CHECK_RELATIVE(got.period, want.period, tolerance);
    CHECK_RELATIVE(got.slip, want.slip, tolerance);
    CHECK_RELATIVE(got.stick, want.stick, tolerance);
    CHECK_RELATIVE(got.peak, want.peak, tolerance);
}

static void reference(void **state)
{
    const cycle c = closed_form(held, sliding);
    (void)state;
    CHECK_RELATIVE(c.slip, 0.3085574216, 1e-9);
    CHECK_RELATIVE(c.stick, 0.5479452055, 1e-9);
    CHECK_RELATIVE(c.period, 0.8565026271, 1e-9);
    CHECK_RELATIVE(c.peak, 22.2908242354, 1e-11);
}

static void bristle(void (*build)(rotor *, const dmb_wall_def *, const dmb_sim_options *), const char *what)
{
    const dmb_wall_def wall = friction(DMB_FRICTION_BRISTLE, 1e-4, 1e-6);
    const dmb_sim_options options = fine_options(1e-12);
    rotor r;
    build(&r, &wall, &options);
    const cycle c = measure(&r, 2, 1e-4);
    tell_cycle(what, &r, c);
    check_cycle(c, closed_form(held, sliding), 1e-4);
    rig_close(&r.scene);
}

static void bristle_block(void **state)
{
    (void)state;
    bristle(build_block, "bristles, block");
}

static void bristle_bar(void **state)
{
    (void)state;
    bristle(build_bar, "bristles, bar");
}

/* ---- Smoothed law ------------------------------------------------------------------------------------------------ */

static cycle run_smoothed(void (*build)(rotor *, const dmb_wall_def *, const dmb_sim_options *),
                          const dmb_wall_def *wall)
{
    const dmb_sim_options options = fine_options(1e-9);
    rotor r;
    build(&r, wall, &options);
    const cycle c = measure(&r, 2, 1e-4);
    tell_cycle("smoothed", &r, c);
    rig_close(&r.scene);
    return c;
}

/* The case's 1 % with v_s 1e-3 and v_eps 1e-7 m/s, whose maximum is 300 N m. */
static void smoothed(void **state)
{
    const dmb_wall_def wall = friction(DMB_FRICTION_STRIBECK, 1e-3, 1e-7);
    (void)state;
    check_cycle(run_smoothed(build_block, &wall), closed_form(held, sliding), 1e-2);
    check_cycle(run_smoothed(build_bar, &wall), closed_form(held, sliding), 1e-2);
}

/* The law holds mu_static N whatever its smoothing is: at v_s 1e-3 and v_eps 1e-4 a period of 0.857 s as by the closed
 * form of 300 and 200 N m, where smoothing alone would hold 257.9 N m and the period would be 0.663 s. */
static void smoothed_peak(void **state)
{
    static const double smoothing[] = {1e-4, 5e-5, 1e-5};
    const cycle want = closed_form(held, sliding);
    (void)state;
    for (int i = 0; i < 3; i++) {
        const dmb_wall_def wall = friction(DMB_FRICTION_STRIBECK, 1e-3, smoothing[i]);
        const cycle got = run_smoothed(build_block, &wall);
        CHECK_RELATIVE(got.period, want.period, 1e-3);
        CHECK_RELATIVE(got.peak, want.peak, 1e-3);
    }
}

/* Hard case 2: v_s 1e-3, v_eps 1e-4, period within 2 % when v_eps halves. With the coefficients of
 * lib/theory/limits.md, mu_s .35 and mu_d .30, it changes by 0.002 %; by 1.6 % if the maximum of the law fell with it.
 */
static void halved_smoothing(void **state)
{
    const dmb_wall_def coarse = friction_of(DMB_FRICTION_STRIBECK, 0.35, 0.30, 1e-3, 1e-4);
    const dmb_wall_def fine = friction_of(DMB_FRICTION_STRIBECK, 0.35, 0.30, 1e-3, 5e-5);
    (void)state;
    const cycle a = run_smoothed(build_block, &coarse), b = run_smoothed(build_block, &fine);
    print_message("period changes by %.3f %%\n", 100.0 * (b.period / a.period - 1.0));
    CHECK_RELATIVE(a.period, b.period, 1e-3);
}

/* The falling branch is negative damping. A block of mass m drawn at V = 2 v_s through a spring: a disturbance of its
 * speed grows as e^{s t}(cos w t + s/w sin w t), s = -N mu'(V)/(2m), w^2 = k/m - s^2. Disturbance 1e-6 of V, so that
 * the law is linear; 1e-4. */
static void falling_branch(void **state)
{
    const double V = 0.02, v_s = 0.01, N = 4.0, s = N * 0.1 / v_s * exp(-V / v_s) / (2.0 * inertia);
    const double w = sqrt(spring / inertia - s * s), t = 0.6, disturbance = 1e-6 * V;
    dmb_wall_def wall = friction(DMB_FRICTION_STRIBECK, v_s, 1e-12);
    dmb_body_def body = scene_ball(inertia, -N / wall.stiffness, DMB_FREE_X | DMB_FREE_Y | DMB_FREE_Z);
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_load_def load = dmb_load_def_default();
    dmb_sim_options options = fine_options(1e-13);
    rig scene;
    (void)state;
    options.newton_tolerance = 1e-13;
    body.velocity[0] = V + disturbance;
    scene_open(&scene, 0.0);
    add_wall(&scene, &wall);
    drive.part = add_body(&scene, &body);
    load.place = dmb_station(drive.part, 0, 0.0);
    load.force[0] = N * (0.2 + 0.1 * exp(-V / v_s));
    load.force[2] = -N;
    add_load(&scene, &load);
    drive.kind = DMB_DRIVE_CONTROL;
    drive.integral_gain = spring;
    drive.time_function = add_constant(&scene, V);
    add_drive(&scene, &drive);
    rig_start_with(&scene, NULL, &options);
    scene_advance(&scene, t);
    const double growth = (scene_speed(&scene, drive.part, DMB_X) - V) / disturbance;
    print_message("disturbance grows to %.6f, s %.4f\n", growth, s);
    CHECK_CLOSE(growth, exp(s * t) * (cos(w * t) + s / w * sin(w * t)), 1e-4 * exp(s * t));
    rig_close(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reference),      cmocka_unit_test(bristle_block), cmocka_unit_test(bristle_bar),
        cmocka_unit_test(smoothed),       cmocka_unit_test(smoothed_peak), cmocka_unit_test(halved_smoothing),
        cmocka_unit_test(falling_branch),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
