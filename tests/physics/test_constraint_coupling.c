/* Couplings and drives on joint coordinates: gears, a screw, time functions followed to rounding, torques and
 * controllers, and what dmb_query_drive and dmb_query_multipliers tell of them. */
#include <string.h>

#include "mechanism.h"

static const double g = 9.81, step = 1e-3;

static dmb_id rigid_mass(rig *s, double y, double mass, double inertia)
{
    dmb_body_def body = dmb_body_def_default();
    body.mass = mass;
    body.position[1] = y;
    for (int i = 0; i < 3; i++) body.inertia[i] = inertia;
    return add_body(s, &body);
}

/* A joint on the ground at y along `axis`, body there. */
static dmb_id joint_on(rig *s, int32_t kind, double y, dmb_id body, const double axis[3])
{
    dmb_joint_def def = dmb_joint_def_default();
    def.kind = kind;
    def.place_b = dmb_station(body, 0, 0.0);
    def.origin_a[1] = y;
    def.match = 1;
    memcpy(def.axis_a, axis, sizeof def.axis_a);
    return add_joint(s, &def);
}

static dmb_id couple(rig *s, dmb_id a, int32_t component_a, dmb_id b, int32_t component_b, double ratio)
{
    dmb_coupling_def def = dmb_coupling_def_default();
    dmb_id id = {0, 0};
    def.joint[0] = a;
    def.joint[1] = b;
    def.component[0] = component_a;
    def.component[1] = component_b;
    def.ratio = ratio;
    must_model(s, dmb_model_add_coupling(s->model, &def, &id));
    return id;
}

static dmb_drive_state drive_at(const rig *s, dmb_id drive)
{
    dmb_drive_state state = dmb_drive_state_default();
    must(s, dmb_query_drive(s->sim, drive, &state));
    return state;
}

static const double along_x[3] = {1.0, 0.0, 0.0}, along_z[3] = {0.0, 0.0, 1.0};

/* ---- Gears ------------------------------------------------------------------------------------------------------- */

/* q1 = ratio q2: J1 + J2/ratio^2 seen by a torque on 1; the multiplier f is the tooth torque on coordinate 1:
 * J1 q1'' = T - f, J2 q2'' = ratio f. */
static void gear_pair(void **state)
{
    (void)state;
    const double J1 = 0.4, J2 = 1.5, ratio = -2.0, T = 3.0, a = T / (J1 + J2 / (ratio * ratio));
    rig s;
    double f[6];
    rig_open(&s, 0.0, 0.0, -g);
    const dmb_id one = joint_on(&s, DMB_JOINT_REVOLUTE, 0.0, rigid_mass(&s, 0.0, 1.0, J1), along_x);
    const dmb_id two = joint_on(&s, DMB_JOINT_REVOLUTE, 1.0, rigid_mass(&s, 1.0, 2.0, J2), along_x);
    const dmb_id gear = couple(&s, one, DMB_RX, two, DMB_RX, ratio);
    const dmb_id drive = add_simple_drive(&s, DMB_DRIVE_LOAD, one, DMB_RX, add_constant(&s, T));
    (void)mechanism_start(&s, NULL);
    take_steps(&s, step, 3000);
    const dmb_joint_state pinion = joint_at(&s, one), wheel = joint_at(&s, two);
    check_relative("acceleration: effective inertia", pinion.acceleration[DMB_RX], a, 1e-12);
    check_relative("speed after 3 s", pinion.speed[DMB_RX], 3.0 * a, 1e-11);
    check_relative("angle after 3 s, over two turns", pinion.position[DMB_RX], 4.5 * a, 1e-11);
    check_relative("ratio of the speeds", pinion.speed[DMB_RX] / wheel.speed[DMB_RX], ratio, 1e-14);
    check_close("angles stay together [rad]", pinion.position[DMB_RX], ratio * wheel.position[DMB_RX], 1e-12);
    assert_int_equal(multipliers_of(&s, gear, f), 1);
    check_relative("multiplier: tooth torque on the first", f[0], T - J1 * a, 1e-12);
    check_relative("and on the second, over the ratio", ratio * f[0], J2 * wheel.acceleration[DMB_RX], 1e-12);
    check_relative("work of the torque", drive_at(&s, drive).work, T * 4.5 * a, 1e-6);
    check_below("balance over input", energy_of(&s).error, 1e-12);
    rig_close(&s);
}

/* A train of three: the middle wheel turns the other way and its size cancels. */
static void gear_train(void **state)
{
    (void)state;
    const double J[3] = {0.2, 0.5, 0.9}, r1 = -1.5, r2 = -0.4, T = 2.0;
    const double a = T / (J[0] + J[1] / (r1 * r1) + J[2] / (r1 * r1 * r2 * r2));
    dmb_id joint[3];
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    for (int i = 0; i < 3; i++) joint[i] = joint_on(&s, DMB_JOINT_REVOLUTE, i, rigid_mass(&s, i, 1.0, J[i]), along_z);
    (void)couple(&s, joint[0], DMB_RX, joint[1], DMB_RX, r1);
    (void)couple(&s, joint[1], DMB_RX, joint[2], DMB_RX, r2);
    (void)add_simple_drive(&s, DMB_DRIVE_LOAD, joint[0], DMB_RX, add_constant(&s, T));
    (void)mechanism_start(&s, NULL);
    take_steps(&s, step, 1000);
    check_relative("first wheel", joint_at(&s, joint[0]).speed[DMB_RX], a, 1e-12);
    check_relative("third wheel", joint_at(&s, joint[2]).speed[DMB_RX], a / (r1 * r2), 1e-12);
    rig_close(&s);
}

/* ---- Screw ------------------------------------------------------------------------------------------------------- */

static void falling_nut(void **state)
{
    (void)state;
    const double m = 1.5, J = 0.02, lead = 0.05, k = 2.0 * PI / lead, a = g / (1.0 + J * k * k / m),
                 down[3] = {0.0, 0.0, -1.0};
    double f[6];
    rig s;
    rig_open(&s, 0.0, 0.0, -g);
    const dmb_id joint = joint_on(&s, DMB_JOINT_CYLINDRICAL, 0.0, rigid_mass(&s, 0.0, m, J), down);
    const dmb_id screw = couple(&s, joint, DMB_X, joint, DMB_RX, lead / (2.0 * PI));
    (void)mechanism_start(&s, NULL);
    take_steps(&s, step, 10000);
    const dmb_joint_state nut = joint_at(&s, joint);
    check_relative("acceleration of a falling nut", nut.acceleration[DMB_X], a, 1e-11);
    check_relative("way after 10 s", nut.position[DMB_X], 50.0 * a, 1e-10);
    tell("turns after 10 s", nut.position[DMB_RX] / (2.0 * PI));
    check_relative("turns go with the way", nut.position[DMB_RX], nut.position[DMB_X] * k, 1e-13);
    assert_int_equal(multipliers_of(&s, screw, f), 1);
    check_relative("force on the thread", f[0], m * (g - a), 1e-11);
    const dmb_energy energy = energy_of(&s);
    check_below("energy over the kinetic", (energy.kinetic + energy.gravity) / energy.kinetic, 1e-11);
    rig_close(&s);
}

/* ---- Motion drives ----------------------------------------------------------------------------------------------- */

/* STEP from 0 to h between x0 and x1: integral and value. */
static double step_integral(double x0, double x1, double h, double t)
{
    const double D = (t - x0) / (x1 - x0), T = x1 - x0;
    if (t <= x0) return 0.0;
    return D < 1.0 ? h * T * D * D * D * (1.0 - 0.5 * D) : h * (0.5 * T + t - x1);
}

static double step_value(double x0, double x1, double h, double t)
{
    const double D = fmin(1.0, fmax(0.0, (t - x0) / (x1 - x0)));
    return h * D * D * (3.0 - 2.0 * D);
}

/* X and RX of one cylindrical joint, driven by time functions of their own. */
static void time_functions_are_followed(void **state)
{
    (void)state;
    const double m = 2.0, J = 0.3, up[3] = {0.0, 0.0, 1.0};
    dmb_segment term = dmb_segment_default();
    double worst[4] = {0.0, 0.0, 0.0, 0.0}, force = 0.0, angle = 0.0;
    rig s;
    rig_open(&s, 0.0, 0.0, -g);
    const dmb_id joint = joint_on(&s, DMB_JOINT_CYLINDRICAL, 0.0, rigid_mass(&s, 0.0, m, J), up);
    term.kind = DMB_SEGMENT_STEP;
    term.x0 = 0.1037;
    term.x1 = 0.7;
    term.h1 = 0.4;
    const dmb_id lift = add_simple_drive(&s, DMB_DRIVE_MOTION, joint, DMB_X, add_time_function(&s, &term, 1));
    term.x0 = 0.0;
    term.x1 = 1.3;
    term.h1 = 40.0;
    const dmb_id turn = add_simple_drive(&s, DMB_DRIVE_MOTION, joint, DMB_RX, add_time_function(&s, &term, 1));
    (void)mechanism_start(&s, NULL);
    for (int i = 0; i < 2000; i++) {
        take_steps(&s, step, 1);
        const double t = dmb_sim_time(s.sim), x = step_integral(0.1037, 0.7, 0.4, t),
                     r = step_integral(0.0, 1.3, 40.0, t);
        const double v = step_value(0.1037, 0.7, 0.4, t), w = step_value(0.0, 1.3, 40.0, t);
        const dmb_joint_state at = joint_at(&s, joint);
        const dmb_drive_state a = drive_at(&s, lift), b = drive_at(&s, turn);
        worst[0] = fmax(worst[0], fabs(at.position[DMB_X] - x));
        angle = fmax(angle, fabs(at.position[DMB_RX] - r));
        worst[1] = fmax(worst[1], fmax(fabs(at.speed[DMB_X] - v), fabs(at.speed[DMB_RX] - w)));
        worst[2] = fmax(worst[2], fmax(fabs(a.position - at.position[DMB_X]), fabs(b.position - at.position[DMB_RX])));
        worst[2] = fmax(worst[2], fmax(fabs(a.speed - v), fabs(b.speed - w)));
        force = fmax(fabs(a.force - m * (g + at.acceleration[DMB_X])), fabs(b.force - J * at.acceleration[DMB_RX]));
        worst[3] = fmax(worst[3], fmax(force, fabs(a.power - a.force * v)));
    }
    const dmb_drive_state a = drive_at(&s, lift), b = drive_at(&s, turn);
    check_below("place against the integral of its time function [m]", worst[0], 1e-12);
    check_below("angle over 54 rad against the integral of its time function [rad]", angle,
                5e-12); /* a sum of 2000 steps */
    check_below("speeds against the time functions", worst[1], 1e-11);
    check_below("positions and speeds that dmb_query_drive tells", worst[2], 1e-12);
    check_below("forces against m (g + a) and J a, power", worst[3], 1e-9);
    check_relative("work of lifting", a.work, m * (g * a.position + 0.5 * 0.16), 1e-6);
    check_relative("work of turning", b.work, 0.5 * J * 1600.0, 1e-6);
    check_below("balance over input", energy_of(&s).error, 1e-6);
    double f[6];
    assert_int_equal(multipliers_of(&s, lift, f), 1);
    check_close("multiplier of the drive is its force on the bodies, reversed", f[0], -a.force, 1e-12);
    rig_close(&s);
}

/* A crank that a drive turns at constant speed through many turns of a four-bar: the crank is where it should be. */
static void driven_four_bar(void **state)
{
    (void)state;
    const bar crank = {{0.0, 0.0}, {0.0, 0.4}, 1.0}, rod = {{0.0, 0.4}, {1.5, 1.0}, 2.0},
              rocker = {{1.5, 0.0}, {1.5, 1.0}, 1.5};
    const double half = 0.5 * sqrt(1.5 * 1.5 + 0.36);
    double worst = 0.0;
    rig s;
    rig_open(&s, 0.0, 0.0, -g);
    const dmb_id a = add_bar(&s, &crank), b = add_bar(&s, &rod), c = add_bar(&s, &rocker);
    const dmb_id axle = add_hinge(&s, "crank", DMB_JOINT_REVOLUTE, pin_ground(0.0, 0.0), pin_on(a, -0.2));
    (void)add_hinge(&s, "", DMB_JOINT_REVOLUTE, pin_on(a, 0.2), pin_on(b, -half));
    (void)add_hinge(&s, "", DMB_JOINT_REVOLUTE, pin_on(b, half), pin_on(c, 0.5));
    (void)add_hinge(&s, "", DMB_JOINT_REVOLUTE, pin_ground(1.5, 0.0), pin_on(c, -0.5));
    const dmb_id drive = add_simple_drive(&s, DMB_DRIVE_MOTION, axle, DMB_RX, add_constant(&s, 5.0));
    (void)mechanism_start(&s, NULL);
    for (int i = 0; i < 5000; i++) {
        take_steps(&s, step, 1);
        worst = fmax(worst, fabs(drive_at(&s, drive).position - 5.0 * dmb_sim_time(s.sim)));
        worst = fmax(worst, fabs(joint_at(&s, axle).position[DMB_RX] - 0.5 * PI - 5.0 * dmb_sim_time(s.sim)));
    }
    const dmb_energy energy = energy_of(&s);
    check_below("crank angle over four turns [rad]", worst, 1e-11);
    check_below("largest violation", statistics_of(&s).violation, 1e-14);
    tell("redundant rows", statistics_of(&s).redundant);
    tell("work of the drive [J]", energy.drives);
    check_below("balance over input", energy.error, 1e-5);
    check_below("unexplained over input", energy.unexplained / energy.input, 1e-8);
    rig_close(&s);
}

/* ---- Loads and controllers --------------------------------------------------------------------------------------- */

static void force_between_two_bodies(void **state)
{
    (void)state;
    const double F = 4.0, m1 = 1.0, m2 = 3.0;
    dmb_joint_def def = dmb_joint_def_default();
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    const dmb_id a = rigid_mass(&s, 0.0, m1, 1.0), b = rigid_mass(&s, 0.0, m2, 1.0);
    def.kind = DMB_JOINT_PRISMATIC;
    def.place_a = dmb_station(a, 0, 0.0);
    def.place_b = dmb_station(b, 0, 0.0);
    def.match = 1;
    const dmb_id joint = add_joint(&s, &def);
    const dmb_id drive = add_simple_drive(&s, DMB_DRIVE_LOAD, joint, DMB_X, add_constant(&s, F));
    (void)mechanism_start(&s, NULL);
    take_steps(&s, step, 1000);
    const double v1 = motion_at(&s, dmb_station(a, 0, 0.0), DMB_FRAME_WORLD).velocity[0];
    const double v2 = motion_at(&s, dmb_station(b, 0, 0.0), DMB_FRAME_WORLD).velocity[0];
    check_relative("speed of a", v1, -F / m1, 1e-12);
    check_relative("speed of b", v2, F / m2, 1e-12);
    check_below("momentum", m1 * v1 + m2 * v2, 1e-13);
    check_relative("speed that the drive tells", drive_at(&s, drive).speed, v2 - v1, 1e-14);
    check_relative("work", drive_at(&s, drive).work, 0.5 * (m1 * v1 * v1 + m2 * v2 * v2), 1e-9);
    must(&s, dmb_sim_set_drive(s.sim, drive, 0.0));
    check_below("acceleration without the force", joint_at(&s, joint).acceleration[DMB_X], 1e-13);
    rig_close(&s);
}

/* m v' = kp (v* - v) + ki integral: two roots, s^2 m + s kp + ki = 0. */
static double controlled_speed(double m, double kp, double ki, double target, double t)
{
    const double d = kp / (2.0 * m), w = sqrt(ki / m - d * d);
    return target * (1.0 - exp(-d * t) * (cos(w * t) - d / w * sin(w * t)));
}

static void check_controller(const char *what, int32_t kind, int32_t component, double m)
{
    const double kp = 3.0, ki = 40.0, target = 2.0;
    dmb_drive_def drive = dmb_drive_def_default();
    double worst = 0.0;
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    drive.kind = DMB_DRIVE_CONTROL;
    drive.part = joint_on(&s, kind, 0.0,
                          rigid_mass(&s, 0.0, component == DMB_X ? m : 1.0, component == DMB_X ? 1.0 : m), along_x);
    drive.component = component;
    drive.time_function = add_constant(&s, target);
    drive.gain = kp;
    drive.integral_gain = ki;
    const dmb_id id = add_drive(&s, &drive);
    (void)mechanism_start(&s, NULL);
    for (int i = 0; i < 4000; i++) {
        take_steps(&s, 5e-4, 1);
        const double want = controlled_speed(m, kp, ki, target, dmb_sim_time(s.sim));
        worst = fmax(worst, fabs(drive_at(&s, id).speed - want));
    }
    check_below(what, worst / target, 1e-4);
    check_below("balance over input", energy_of(&s).error, 1e-5);
    rig_close(&s);
}

static void controllers(void **state)
{
    (void)state;
    check_controller("controlled slide: speed against its closed form", DMB_JOINT_PRISMATIC, DMB_X, 1.5);
    check_controller("controlled shaft: speed against its closed form", DMB_JOINT_REVOLUTE, DMB_RX, 0.8);
}

/* Drives of several joints and one without, described in no order: each acts where it belongs. */
static void drives_find_their_joints(void **state)
{
    (void)state;
    static const int on[7] = {2, 0, 2, 3, 0, 2, 3};
    static const int32_t component[7] = {DMB_RX, DMB_X, DMB_X, DMB_RX, DMB_RX, DMB_RX, DMB_X};
    dmb_id joint[4], drive[7];
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    for (int i = 0; i < 4; i++) joint[i] = joint_on(&s, DMB_JOINT_CYLINDRICAL, i, rigid_mass(&s, i, 2.0, 0.5), along_x);
    for (int i = 0; i < 7; i++)
        drive[i] = add_simple_drive(&s, DMB_DRIVE_LOAD, joint[on[i]], component[i], add_constant(&s, 1.0 + i));
    (void)mechanism_start(&s, NULL);
    take_steps(&s, step, 100);
    double force[4][2] = {{0.0}};
    for (int i = 0; i < 7; i++) force[on[i]][component[i] == DMB_RX] += 1.0 + i;
    for (int i = 0; i < 4; i++) {
        check_close("acceleration along [m/s2]", joint_at(&s, joint[i]).acceleration[DMB_X], force[i][0] / 2.0, 1e-11);
        check_close("and about [rad/s2]", joint_at(&s, joint[i]).acceleration[DMB_RX], force[i][1] / 0.5, 1e-11);
    }
    for (int i = 0; i < 7; i++) {
        const dmb_joint_state now = joint_at(&s, joint[on[i]]);
        check_close("force of the drive", drive_at(&s, drive[i]).force, 1.0 + i, 0.0);
        check_close("speed of the drive", drive_at(&s, drive[i]).speed, now.speed[component[i]], 1e-14);
        check_close("position of the drive", drive_at(&s, drive[i]).position, now.position[component[i]], 1e-14);
    }
    rig_close(&s);
}

/* At its limit the controller is a constant force. */
static void limits_hold(void **state)
{
    (void)state;
    dmb_drive_def drive = dmb_drive_def_default();
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    drive.kind = DMB_DRIVE_CONTROL;
    drive.part = joint_on(&s, DMB_JOINT_REVOLUTE, 0.0, rigid_mass(&s, 0.0, 1.0, 0.5), along_x);
    drive.component = DMB_RX;
    drive.time_function = add_constant(&s, 10.0);
    drive.gain = 20.0;
    drive.integral_gain = 0.0;
    drive.limit_low = -1.0;
    drive.limit_high = 2.0;
    const dmb_id id = add_drive(&s, &drive);
    (void)mechanism_start(&s, NULL);
    take_steps(&s, step, 1000);
    check_close("force at the limit [N m]", drive_at(&s, id).force, 2.0, 0.0);
    check_relative("speed under the limit", drive_at(&s, id).speed, 4.0, 1e-12);
    must(&s, dmb_sim_set_drive(s.sim, id, 0.0));
    check_close("other way, at the lower limit [N m]", drive_at(&s, id).force, -1.0, 0.0);
    take_steps(&s, step, 1000);
    check_relative("speed under the lower limit", drive_at(&s, id).speed, 2.0, 1e-12);
    must(&s, dmb_sim_set_drive(s.sim, id, (double)NAN));
    take_steps(&s, step, 5000);
    check_relative("speed reached", drive_at(&s, id).speed, 10.0, 1e-9);
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gear_pair),
        cmocka_unit_test(gear_train),
        cmocka_unit_test(falling_nut),
        cmocka_unit_test(time_functions_are_followed),
        cmocka_unit_test(driven_four_bar),
        cmocka_unit_test(force_between_two_bodies),
        cmocka_unit_test(controllers),
        cmocka_unit_test(limits_hold),
        cmocka_unit_test(drives_find_their_joints),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
