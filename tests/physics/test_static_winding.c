/* Strings that slip round their hole wind up by radians and climb its wall. Statics find them in a few iterations, held
 * against: the slope of friction (tan of the climb = mu), the torque of all contacts, and the same state found in load
 * steps. Equations: eq:static.move, eq:static.fixed-axes. */
#include <math.h>

#include "rig.h"

#define RADIUS 0.0365
#define SPEED 10.0 /* [rad/s] */
#define MOST 20    /* iterations; moves by one exponential of each correction took 5663, or failed */

typedef struct winding {
    uint32_t pipes;
    double mu, speed, slip_axial, inclination, azimuth_rate; /* [rad, rad/m] */
    double eccentricity;
    int joint; /* a torsional spring in the middle of the string */
} winding;

static dmb_id open_winding(rig *s, const winding *w)
{
    const double length = 1.5 * w->pipes + 20.0;
    const double survey[6] = {0.0, w->inclination, 0.0, length, w->inclination, w->azimuth_rate * length};
    dmb_wall_def wall = s1_hole();
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    const uint32_t first = w->joint ? w->pipes / 2 : w->pipes;
    rig_open(s, 0.0, 0.0, -9.81);
    wall.survey = survey;
    wall.survey_count = 2;
    wall.mu_static = wall.mu_dynamic = w->mu;
    (void)add_wall(s, &wall);
    pipe.elements = 1;
    pipe.eccentricity = w->eccentricity;
    pipe.angle_spread = PI;
    pipe.string = add_string(s, &def);
    (void)add_pipes(s, &pipe, first);
    const dmb_id still = add_constant(s, 0.0), a = pipe.string;
    (void)add_simple_drive(s, DMB_DRIVE_MOTION, a, DMB_X, still);
    const dmb_id drive = add_simple_drive(s, DMB_DRIVE_MOTION, a, DMB_RX, still);
    if (w->joint) {
        def.start_depth = 1.5 * first;
        def.start_free = DMB_FREE_ALL;
        pipe.string = add_string(s, &def);
        (void)add_pipes(s, &pipe, w->pipes - first);
        dmb_joint_def joint =
            joint_between(DMB_JOINT_REVOLUTE, dmb_station(a, first - 1, 1.0), dmb_station(pipe.string, 0, 0.0));
        joint.stiffness[DMB_RX] = 2e4;
        (void)add_joint(s, &joint);
    }
    (void)rig_start(s, NULL);
    return drive;
}

static dmb_static_report find(const rig *s, const winding *w, uint32_t load_steps)
{
    dmb_static_options options = dmb_static_options_default();
    options.slip_rotation = w->speed;
    options.slip_axial = w->slip_axial;
    options.load_steps = load_steps;
    options.tolerance = 1e-12;
    return find_equilibrium(s, &options);
}

static double torque_of(const rig *s, dmb_id drive)
{
    dmb_drive_state state = dmb_drive_state_default();
    must(s, dmb_query_drive(s->sim, drive, &state));
    return state.force;
}

/* Torque of friction about the hole's axis, from the forces between the rings and the wall. */
static double torque_of_contacts(const rig *s)
{
    double sum = 0.0;
    for (uint32_t i = 0;; i++) {
        dmb_contact c = dmb_contact_default();
        if (dmb_query_contact(s->sim, i, &c) < 0) return sum;
        sum += RADIUS * c.friction[1];
    }
}

/* Far from the ends a pipe in a straight hole rests where mu is the tangent of its climb: N = w l cos(climb). */
static void check_climb(const rig *s, const winding *w)
{
    const double v[2] = {w->slip_axial, RADIUS * w->speed}, smooth = dmb_wall_def_default().smoothing_speed;
    const double f = w->mu * v[1] / sqrt(v[0] * v[0] + v[1] * v[1] + smooth * smooth);
    const double weight = 1.5 * s1_values().weight * sin(w->inclination);
    dmb_contact c = dmb_contact_default();
    must(s, dmb_query_contact(s->sim, w->pipes / 2, &c));
    const double climb = atan2(c.normal[1], hypot(c.normal[0], c.normal[2]));
    assert_true(climb * w->speed < 0.0); /* turning from y to z it is pushed to -y */
    check_relative("climb", fabs(tan(climb)), fabs(f), 1e-6);
    check_relative("normal force", c.normal_force, weight / sqrt(1.0 + f * f), 1e-6);
}

static void hold(const winding *w)
{
    rig s, stepped;
    const dmb_id drive = open_winding(&s, w), drive_stepped = open_winding(&stepped, w);
    const dmb_static_report report = find(&s, w, 0);
    print_message("    %4u pipes, mu %.1f, %3.0f rad/s, %3.1f m/s, inclined %.2f, %g rad/m: %u iterations, %g N m\n",
                  w->pipes, w->mu, w->speed, w->slip_axial, w->inclination, w->azimuth_rate, report.iterations,
                  torque_of(&s, drive));
    assert_true(report.iterations <= MOST);
    assert_int_equal(report.method, DMB_STATIC_NEWTON);
    assert_int_equal(report.load_steps, 1);
    if (w->azimuth_rate == 0.0 && !w->joint) check_climb(&s, w);
    /* pipes that are pushed tilt in the hole, and friction along it then has a lever about the axis */
    if (w->eccentricity == 0.0 && !w->joint && w->azimuth_rate == 0.0)
        check_relative("torque of the drive", torque_of(&s, drive), -torque_of_contacts(&s),
                       w->slip_axial != 0.0 ? 1e-5 : 1e-6);
    (void)find(&stepped, w, 10);
    check_relative("torque, found in load steps", torque_of(&stepped, drive_stepped), torque_of(&s, drive), 1e-8);
    rig_close(&s);
    rig_close(&stepped);
}

static void winding_strings(void **state)
{
    const double level = 0.5 * PI;
    const winding all[] = {
        {200, 0.3, SPEED, 0.0, level, 0.0, 0.0, 0},         {800, 0.3, SPEED, 0.0, level, 0.0, 0.0, 0},
        {800, 0.3, -SPEED, 0.0, level, 0.0, 0.0, 0},        {800, 0.6, SPEED, 0.0, level, 0.0, 0.0, 0},
        {400, 0.3, SPEED, 0.5, level, 0.0, 0.0, 0},         {800, 0.3, 1.0, 0.0, level - 0.5, 0.0, 0.0, 0},
        {400, 0.3, SPEED, 0.0, level, 1.0 / 500.0, 0.0, 0}, {400, 0.3, -SPEED, 0.0, level, 1.0 / 500.0, 0.0, 0},
        {400, 0.3, SPEED, 0.0, level, 0.0, 1e-3, 0},        {400, 0.3, SPEED, 0.0, level, 0.0, 0.0, 1},
    };
    (void)state;
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) hold(all + i);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(winding_strings)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
