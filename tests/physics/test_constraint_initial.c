/* Coordinates of joints: given for time 0, counted over many turns, and what is told in which frame. */
#include <string.h>

#include "mechanism.h"

static const double g = 9.81, step = 1e-3;

/* ---- Four-bar from a crank angle --------------------------------------------------------------------------------- */

typedef struct four_bar {
    rig s;
    dmb_id bar[3], hinge[4];
} four_bar;

/* Described open: crank upright, rod level, rocker anyhow; the crank is to stand at `angle` and turn at `speed`. */
static four_bar four_bar_of(double angle, double speed, int32_t *status, const dmb_sim_options *options)
{
    four_bar m;
    const bar crank = {{0.0, 0.0}, {0.0, 0.4}, 1.0}, rod = {{0.1, 0.5}, {1.3, 0.5}, 2.0},
              rocker = {{1.2, 0.0}, {1.2, 0.8}, 1.5};
    rig_open(&m.s, 0.0, 0.0, -g);
    m.bar[0] = add_bar(&m.s, &crank);
    m.bar[1] = add_bar(&m.s, &rod);
    m.bar[2] = add_bar(&m.s, &rocker);
    dmb_joint_def def = hinge_of("crank", DMB_JOINT_REVOLUTE, pin_ground(0.0, 0.0), pin_on(m.bar[0], -0.2));
    def.initial_mask = DMB_FREE_RX;
    def.initial_position[DMB_RX] = angle;
    def.initial_speed[DMB_RX] = speed;
    m.hinge[0] = add_joint(&m.s, &def);
    m.hinge[1] = add_hinge(&m.s, "", DMB_JOINT_REVOLUTE, pin_on(m.bar[0], 0.2), pin_on(m.bar[1], -0.6));
    m.hinge[2] = add_hinge(&m.s, "", DMB_JOINT_REVOLUTE, pin_on(m.bar[1], 0.6), pin_on(m.bar[2], 0.4));
    m.hinge[3] = add_hinge(&m.s, "", DMB_JOINT_REVOLUTE, pin_ground(1.2, 0.0), pin_on(m.bar[2], -0.4));
    *status = mechanism_start(&m.s, options);
    return m;
}

/* Rocker angle and rate of a four-bar with its rocker pin above: by the circle of the rod about the crank pin. */
static void rocker_of(double angle, double speed, double *rocker, double *rate)
{
    const double x = 0.4 * cos(angle), z = 0.4 * sin(angle), dx = x - 1.2, dz = z, d2 = dx * dx + dz * dz;
    const double base = atan2(dz, dx), open = acos((d2 + 0.64 - 1.44) / (2.0 * sqrt(d2) * 0.8));
    *rocker = base - open;
    /* velocity of the rocker pin along the rod is that of the crank pin */
    const double ux = 1.2 + 0.8 * cos(*rocker) - x, uz = 0.8 * sin(*rocker) - z;
    const double crank = speed * 0.4 * (-sin(angle) * ux + cos(angle) * uz);
    *rate = crank / (0.8 * (-sin(*rocker) * ux + cos(*rocker) * uz));
}

static void check_four_bar(double angle, double speed)
{
    int32_t status;
    double rocker, rate;
    four_bar m = four_bar_of(angle, speed, &status, NULL);
    const dmb_joint_state first = joint_at(&m.s, m.hinge[0]), last = joint_at(&m.s, m.hinge[3]);
    const dmb_statistics statistics = statistics_of(&m.s);
    assert_int_equal(status, DMB_NOTE_PROJECTED);
    assert_true(strstr(dmb_sim_message(m.s.sim), "joints: closed by moving parts") != NULL);
    tell("crank angle asked for [rad]", angle);
    check_close("crank angle [rad]", first.position[DMB_RX], angle, 1e-14);
    check_close("crank speed [rad/s]", first.speed[DMB_RX], speed, 1e-13);
    rocker_of(angle, speed, &rocker, &rate);
    check_close("rocker angle, by geometry [rad]", last.position[DMB_RX], rocker, 1e-13);
    check_close("rocker speed [rad/s]", last.speed[DMB_RX], rate, 1e-12);
    check_below("violation", statistics.violation, 1e-14);
    tell("parts were moved by up to [m]", statistics.assembly[0]);
    tell("and turned by up to [rad]", statistics.assembly[1]);
    assert_true(statistics.assembly[1] >= fabs(angle - 0.5 * PI) - 1e-12);
    assert_int_equal(statistics.steps, 0);
    take_steps(&m.s, step, 100);
    check_below("violation later", statistics_of(&m.s).violation, 1e-14);
    rig_close(&m.s);
}

static void four_bar_from_its_crank(void **state)
{
    (void)state;
    check_four_bar(0.5 * PI, 3.0);
    check_four_bar(0.9, -2.0);
    check_four_bar(2.4, 5.0);
}

/* Parts that fit as described are not moved at all. */
static void nothing_to_do(void **state)
{
    (void)state;
    rig s;
    const bar only = {{0.0, 0.0}, {1.0, 0.0}, 1.0};
    rig_open(&s, 0.0, 0.0, -g);
    const dmb_id body = add_bar(&s, &only);
    (void)add_hinge(&s, "", DMB_JOINT_REVOLUTE, pin_ground(0.0, 0.0), pin_on(body, -0.5));
    assert_int_equal(mechanism_start(&s, NULL), DMB_OK);
    const dmb_statistics statistics = statistics_of(&s);
    check_below("moved [m]", statistics.assembly[0], 0.0);
    check_below("turned [rad]", statistics.assembly[1], 0.0);
    check_below("speeds changed", statistics.projection[0] + statistics.projection[1], 0.0);
    rig_close(&s);
}

/* ---- Coordinates ------------------------------------------------------------------------------------------------- */

static rig single_of(dmb_joint_def *def, const double velocity[6], dmb_id *body, dmb_id *joint)
{
    rig s;
    dmb_body_def b = dmb_body_def_default();
    rig_open(&s, 0.0, 0.0, 0.0);
    b.mass = 2.0;
    if (velocity != NULL) memcpy(b.velocity, velocity, sizeof b.velocity);
    *body = add_body(&s, &b);
    def->place_b = dmb_station(*body, 0, 0.0);
    *joint = add_joint(&s, def);
    (void)mechanism_start(&s, NULL);
    return s;
}

/* 1000 revolutions by steps of far less and of more than a turn. */
static void check_turns(double h)
{
    const double w = 40.0 * PI, velocity[6] = {0.0, 0.0, 0.0, w, 0.0, 0.0};
    dmb_joint_def def = dmb_joint_def_default();
    dmb_id body, joint;
    def.kind = DMB_JOINT_REVOLUTE;
    rig s = single_of(&def, velocity, &body, &joint);
    const uint32_t n = (uint32_t)lround(50.0 / h);
    take_steps(&s, h, n);
    const double angle = joint_at(&s, joint).position[DMB_RX];
    tell("turning in a step [rad]", w * h);
    check_relative("angle of 1000 revolutions", angle, 2000.0 * PI, 1e-11);
    check_close("and its turns are counted", round(angle / (2.0 * PI)), 1000.0, 0.0);
    rig_close(&s);
}

static void turns_are_counted(void **state)
{
    (void)state;
    check_turns(1e-3);
    check_turns(2e-2);    /* 2.5 rad */
    check_turns(6.25e-2); /* more than a turn */
}

static void driven_turns(void **state)
{
    (void)state;
    const double w = -40.0 * PI;
    rig s;
    dmb_joint_def def = dmb_joint_def_default();
    const dmb_body_def body = dmb_body_def_default();
    rig_open(&s, 0.0, 0.0, 0.0);
    def.kind = DMB_JOINT_REVOLUTE;
    def.place_b = dmb_station(add_body(&s, &body), 0, 0.0);
    const dmb_id joint = add_joint(&s, &def);
    (void)add_simple_drive(&s, DMB_DRIVE_MOTION, joint, DMB_RX, add_constant(&s, w));
    (void)mechanism_start(&s, NULL);
    take_steps(&s, 1e-2, 5000);
    check_relative("angle of -1000 driven revolutions", joint_at(&s, joint).position[DMB_RX], -2000.0 * PI, 1e-12);
    rig_close(&s);
}

/* Three turns ahead at time 0. */
static void turns_at_the_start(void **state)
{
    (void)state;
    dmb_joint_def def = dmb_joint_def_default();
    dmb_id body, joint;
    def.kind = DMB_JOINT_REVOLUTE;
    def.initial_mask = DMB_FREE_RX;
    def.initial_position[DMB_RX] = 20.0;
    def.stiffness[DMB_RX] = 1.0;
    def.rest[DMB_RX] = 20.5;
    rig s = single_of(&def, NULL, &body, &joint);
    check_close("angle at time 0 [rad]", joint_at(&s, joint).position[DMB_RX], 20.0, 1e-13);
    check_close("spring counts the turns: torque [N m]", joint_at(&s, joint).action[DMB_RX], 0.5, 1e-13);
    take_steps(&s, 1e-4, 10);
    check_close("the same a little later", joint_at(&s, joint).action[DMB_RX], 0.5, 1e-2);
    rig_close(&s);
}

/* R = Ry(RY) Rz(RZ) for the two coordinates of a universal joint, and their rates. */
static void universal_coordinates(void **state)
{
    (void)state;
    const double a = 0.3, b = -0.4, da = 1.5, db = 0.8;
    dmb_joint_def def = dmb_joint_def_default();
    dmb_id body, joint;
    def.kind = DMB_JOINT_UNIVERSAL;
    def.initial_mask = DMB_FREE_RY | DMB_FREE_RZ;
    def.initial_position[DMB_RY] = a;
    def.initial_position[DMB_RZ] = b;
    def.initial_speed[DMB_RY] = da;
    def.initial_speed[DMB_RZ] = db;
    rig s = single_of(&def, NULL, &body, &joint);
    const dmb_joint_state at = joint_at(&s, joint);
    const dmb_pose pose = pose_at(&s, dmb_station(body, 0, 0.0));
    const double ca = cos(a), sa = sin(a), cb = cos(b), sb = sin(b);
    const double R[9] = {ca * cb, -ca * sb, sa, sb, cb, 0.0, -sa * cb, sa * sb, ca};
    check_close("RY [rad]", at.position[DMB_RY], a, 1e-14);
    check_close("RZ [rad]", at.position[DMB_RZ], b, 1e-14);
    check_below("RX is held", at.position[DMB_RX], 1e-14);
    check_below("rotation against Ry(RY) Rz(RZ)", largest_difference(9, pose.rotation, R), 1e-14);
    const double w[3] = {db * sa, da, db * ca}; /* da e_y + db Ry e_z */
    const dmb_motion motion = motion_at(&s, dmb_station(body, 0, 0.0), DMB_FRAME_WORLD);
    check_below("angular velocity from the two rates", largest_difference(3, motion.velocity + 3, w), 1e-13);
    check_close("rate of RY [rad/s]", at.speed[DMB_RY], da, 1e-13);
    check_close("rate of RZ [rad/s]", at.speed[DMB_RZ], db, 1e-13);
    double before[2] = {at.position[DMB_RY], at.position[DMB_RZ]}, worst = 0.0;
    for (int k = 0; k < 200; k++) { /* rates are those of the coordinates */
        take_steps(&s, 1e-4, 1);
        const dmb_joint_state now = joint_at(&s, joint);
        take_steps(&s, 1e-4, 1);
        const dmb_joint_state next = joint_at(&s, joint);
        worst = fmax(worst, fabs((next.position[DMB_RY] - before[0]) / 2e-4 - now.speed[DMB_RY]));
        worst = fmax(worst, fabs((next.position[DMB_RZ] - before[1]) / 2e-4 - now.speed[DMB_RZ]));
        before[0] = next.position[DMB_RY], before[1] = next.position[DMB_RZ];
    }
    check_below("rates against differences of the coordinates", worst, 1e-6);
    rig_close(&s);
}

/* ---- Reactions --------------------------------------------------------------------------------------------------- */

/* A tilted body fixed to the ground: its weight, in the world and in frame b. */
static void frames_of_the_reaction(void **state)
{
    (void)state;
    const double mass = 3.0, tilt = 0.6, arm = 0.2;
    dmb_body_def body = dmb_body_def_default();
    dmb_joint_def def = dmb_joint_def_default();
    rig s;
    rig_open(&s, 0.0, 0.0, -g);
    body.mass = mass;
    body.rotation[1] = tilt;
    body.centre[0] = arm;
    def.place_b = dmb_station(add_body(&s, &body), 0, 0.0);
    def.match = 1;
    def.axis_a[0] = 0.0, def.axis_a[2] = 1.0; /* frame b: x up, y along the world's y */
    const dmb_id joint = add_joint(&s, &def);
    (void)mechanism_start(&s, NULL);
    const double lever = arm * cos(tilt), world[6] = {0.0, 0.0, mass * g, 0.0, -mass * g * lever, 0.0};
    const double in_b[6] = {mass * g, 0.0, 0.0, 0.0, -mass * g * lever, 0.0};
    dmb_joint_state state_b = dmb_joint_state_default();
    state_b.frame = DMB_FRAME_BODY;
    must(&s, dmb_query_joint(s.sim, joint, &state_b));
    check_below("reaction in the world", largest_difference(6, joint_at(&s, joint).reaction, world), 1e-12);
    check_below("reaction in frame b", largest_difference(6, state_b.reaction, in_b), 1e-12);
    state_b.frame = DMB_FRAME_HOLE;
    assert_int_equal(dmb_query_joint(s.sim, joint, &state_b), DMB_ERR_VALUE);
    rig_close(&s);
}

/* ---- Order ------------------------------------------------------------------------------------------------------- */

/* Pin force and multipliers of the four-bar after 0.5 s. */
static void multipliers_after(double h, double out[7])
{
    int32_t status;
    const dmb_sim_options options = sharp_options(0.8, 1e-12);
    four_bar m = four_bar_of(0.9, 6.0, &status, &options);
    double f[6];
    take_steps(&m.s, h, (uint32_t)lround(0.5 / h));
    memcpy(out, joint_at(&m.s, m.hinge[1]).reaction, 3 * sizeof(double));
    (void)multipliers_of(&m.s, m.hinge[3], f);
    for (int i = 0; i < 3; i++) out[3 + i] = f[i];
    out[6] = joint_at(&m.s, m.hinge[0]).acceleration[DMB_RX];
    rig_close(&m.s);
}

static void multipliers_are_of_second_order(void **state)
{
    (void)state;
    double finest[7], fine[7], coarse[7];
    multipliers_after(2.5e-5, finest);
    multipliers_after(5e-4, fine);
    multipliers_after(1e-3, coarse);
    tell("pin force [N]", largest(3, finest));
    check_order("reaction and multipliers", largest_difference(6, coarse, finest), largest_difference(6, fine, finest),
                2.0, 0.1);
    check_order("acceleration of the crank", fabs(coarse[6] - finest[6]), fabs(fine[6] - finest[6]), 2.0, 0.1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(four_bar_from_its_crank), cmocka_unit_test(nothing_to_do),
        cmocka_unit_test(turns_are_counted),       cmocka_unit_test(driven_turns),
        cmocka_unit_test(turns_at_the_start),      cmocka_unit_test(universal_coordinates),
        cmocka_unit_test(frames_of_the_reaction),  cmocka_unit_test(multipliers_are_of_second_order),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
