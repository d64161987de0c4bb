/* Turns of the coordinates RX and RY in steps that turn a joint by more than half a revolution: by torques, by what was
 * there, by motion drives, through gears, about axes that lean and on bodies that turn themselves. */
#include <string.h>

#include "mechanism.h"

static dmb_id rigid_mass(rig *s, double y, double mass, double inertia)
{
    dmb_body_def body = dmb_body_def_default();
    body.mass = mass;
    body.position[1] = y;
    for (int i = 0; i < 3; i++) body.inertia[i] = inertia;
    return add_body(s, &body);
}

/* A joint on part `a` along world x and turned about z by `lean`, at y; the body is at y too. */
static dmb_joint_def joint_on(int32_t kind, dmb_id a, double y, dmb_id body, double lean)
{
    dmb_joint_def def = dmb_joint_def_default();
    def.kind = kind;
    def.place_a = dmb_station(a, 0, 0.0);
    def.place_b = dmb_station(body, 0, 0.0);
    def.origin_a[1] = y;
    def.match = 1;
    def.axis_a[0] = cos(lean);
    def.axis_a[1] = sin(lean);
    def.normal_a[0] = -sin(lean);
    def.normal_a[1] = cos(lean);
    return def;
}

static dmb_id axle_on(rig *s, double y, dmb_id body)
{
    const dmb_joint_def def = joint_on(DMB_JOINT_REVOLUTE, ground_id, y, body, 0.0);
    return add_joint(s, &def);
}

static double angle(const rig *s, dmb_id joint)
{
    return joint_at(s, joint).position[DMB_RX];
}

static dmb_drive_state drive_at(const rig *s, dmb_id drive)
{
    dmb_drive_state state = dmb_drive_state_default();
    must(s, dmb_query_drive(s->sim, drive, &state));
    return state;
}

/* Whole steps, none divided. */
static void whole_steps(const rig *s, double h, uint32_t n)
{
    for (uint32_t i = 0; i < n; i++) {
        const int32_t status = dmb_sim_step(s->sim, h, NULL);
        if (status != DMB_OK) fail_msg("step: %s: %s", dmb_status_name(status), dmb_sim_message(s->sim));
    }
}

/* ---- Torques ----------------------------------------------------------------------------------------------------- */

static void torque_from_rest(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        const double T = 1000.0 * (k & 1 ? -1.0 : 1.0), h = k & 2 ? 0.3 : 0.1;
        rig s;
        rig_open(&s, 0.0, 0.0, 0.0);
        const dmb_id joint = axle_on(&s, 0.0, rigid_mass(&s, 0.0, 1.0, 1.0));
        const dmb_id drive = add_simple_drive(&s, DMB_DRIVE_LOAD, joint, DMB_RX, add_constant(&s, T));
        (void)mechanism_start(&s, NULL);
        for (int i = 1; i <= 5; i++) {
            whole_steps(&s, h, 1);
            check_relative("angle [rad]", angle(&s, joint), 0.5 * T * (h * i) * (h * i), 1e-12);
            check_relative("way that the drive tells", drive_at(&s, drive).position, angle(&s, joint), 1e-13);
        }
        rig_close(&s);
    }
}

/* The torque comes of a spring: the turn must not be the one that the end speed of the step alone would say. */
static void torque_that_reverses(void **state)
{
    (void)state;
    const double T = 400.0, h = 0.2;
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    const dmb_id joint = axle_on(&s, 0.0, rigid_mass(&s, 0.0, 1.0, 1.0));
    const dmb_id drive = add_simple_drive(&s, DMB_DRIVE_LOAD, joint, DMB_RX, add_constant(&s, T));
    (void)mechanism_start(&s, NULL);
    whole_steps(&s, h, 3);
    const double there = 0.5 * T * 0.36, speed = T * 0.6;
    check_relative("angle before [rad]", angle(&s, joint), there, 1e-12);
    must(&s, dmb_sim_set_drive(s.sim, drive, -T));
    for (int i = 1; i <= 6; i++) {
        whole_steps(&s, h, 1);
        const double t = h * i;
        check_close("angle on the way back [rad]", angle(&s, joint), there + speed * t - 0.5 * T * t * t, 1e-10);
    }
    rig_close(&s);
}

/* ---- Motion ------------------------------------------------------------------------------------------------------ */

/* Rising to `speed` over `time`, in steps as long as half of that. */
static void follow(double speed, double time, double h)
{
    dmb_segment term = dmb_segment_default();
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    const dmb_id joint = axle_on(&s, 0.0, rigid_mass(&s, 0.0, 1.0, 1.0));
    term.kind = DMB_SEGMENT_STEP;
    term.x1 = time;
    term.h1 = speed;
    const dmb_id drive = add_simple_drive(&s, DMB_DRIVE_MOTION, joint, DMB_RX, add_time_function(&s, &term, 1));
    (void)mechanism_start(&s, NULL);
    while (dmb_sim_time(s.sim) < 3.0 * time - 0.5 * h) {
        whole_steps(&s, h, 1);
        check_close("angle and drive [rad]", angle(&s, joint), drive_at(&s, drive).position, 1e-11);
    }
    check_relative("angle at the end [rad]", angle(&s, joint), speed * (dmb_sim_time(s.sim) - 0.5 * time), 1e-12);
    rig_close(&s);
}

static void motion_drives(void **state)
{
    (void)state;
    follow(30.0, 1.0, 0.5);
    follow(30.0, 2.0, 0.5);
    follow(-30.0, 2.0, 0.25);
    follow(300.0, 1.0, 0.5);
}

/* ---- Gears ------------------------------------------------------------------------------------------------------- */

static void gears_by_torque(void **state)
{
    (void)state;
    const double J[2] = {0.4, 1.5}, ratio = -0.5, T = 900.0, a = T / (J[0] + J[1] / (ratio * ratio)), h = 0.2;
    dmb_coupling_def gear = dmb_coupling_def_default();
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    for (int i = 0; i < 2; i++) gear.joint[i] = axle_on(&s, i, rigid_mass(&s, i, 1.0, J[i]));
    gear.ratio = ratio;
    must_model(&s, dmb_model_add_coupling(s.model, &gear, NULL));
    (void)add_simple_drive(&s, DMB_DRIVE_LOAD, gear.joint[0], DMB_RX, add_constant(&s, T));
    (void)mechanism_start(&s, NULL);
    for (int i = 1; i <= 8; i++) {
        const double t = h * i;
        whole_steps(&s, h, 1);
        check_relative("first wheel [rad]", angle(&s, gear.joint[0]), 0.5 * a * t * t, 1e-11);
        check_relative("second wheel [rad]", angle(&s, gear.joint[1]), 0.5 * a * t * t / ratio, 1e-11);
    }
    check_below("violation", statistics_of(&s).violation, 1e-11);
    rig_close(&s);
}

/* ---- Leaning and carried ----------------------------------------------------------------------------------------- */

/* A free body that turns about its own x, leaning by RZ from the frame its angles are measured in. */
static void leaning_axis(void **state)
{
    (void)state;
    const double w = 40.0, h = 0.1;
    dmb_body_def body = dmb_body_def_default();
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    for (int i = 0; i < 3; i++) body.inertia[i] = 0.3 + 0.1 * i;
    body.velocity[3] = w;
    const dmb_id part = add_body(&s, &body);
    dmb_joint_def def = joint_on(DMB_JOINT_SPHERICAL, ground_id, 0.0, part, -0.8);
    def.match = 0;
    const dmb_id joint = add_joint(&s, &def);
    (void)mechanism_start(&s, NULL);
    const double from = angle(&s, joint);
    for (int i = 1; i <= 10; i++) {
        whole_steps(&s, h, 1);
        const dmb_joint_state now = joint_at(&s, joint);
        check_close("angle [rad]", now.position[DMB_RX], from + w * h * i, 1e-9);
        check_close("lean [rad]", now.position[DMB_RZ], 0.8, 1e-9);
        check_close("the other angle [rad]", now.position[DMB_RY], 0.0, 1e-9);
    }
    rig_close(&s);
}

/* A wheel on a turning table, each driven by a torque against the ground or the table. */
static void wheel_on_a_table(void **state)
{
    (void)state;
    const double J[2] = {2.0, 0.5}, T = 300.0, h = 0.2;
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    const dmb_id table = rigid_mass(&s, 0.0, 1.0, J[0]), wheel = rigid_mass(&s, 0.0, 1.0, J[1]);
    const dmb_id first = axle_on(&s, 0.0, table);
    const dmb_joint_def def = joint_on(DMB_JOINT_REVOLUTE, table, 0.0, wheel, 0.0);
    const dmb_id second = add_joint(&s, &def);
    (void)add_simple_drive(&s, DMB_DRIVE_LOAD, second, DMB_RX, add_constant(&s, T));
    (void)mechanism_start(&s, NULL);
    for (int i = 1; i <= 5; i++) {
        const double t = h * i;
        whole_steps(&s, h, 1);
        check_relative("table [rad]", angle(&s, first), -0.5 * T / J[0] * t * t, 1e-11);
        check_relative("wheel on the table [rad]", angle(&s, second), 0.5 * T * (1.0 / J[0] + 1.0 / J[1]) * t * t,
                       1e-11);
    }
    rig_close(&s);
}

/* A torsion spring wound up by a torque over several turns: the static search follows the turns on its way. */
static void spring_wound_in_statics(void **state)
{
    (void)state;
    const double torque[] = {0.2, -0.7, 1.2, 4.0};
    for (size_t i = 0; i < sizeof torque / sizeof torque[0]; i++) {
        rig s;
        rig_open(&s, 0.0, 0.0, 0.0);
        const dmb_id body = rigid_mass(&s, 0.0, 1.0, 1.0);
        dmb_joint_def def = joint_on(DMB_JOINT_REVOLUTE, ground_id, 0.0, body, 0.0);
        dmb_load_def load = dmb_load_def_default();
        def.stiffness[DMB_RX] = 0.1;
        const dmb_id joint = add_joint(&s, &def);
        load.place = dmb_station(body, 0, 0.0);
        load.moment[0] = torque[i];
        assert_int_equal(dmb_model_add_load(s.model, &load, NULL), DMB_OK);
        (void)mechanism_start(&s, NULL);
        must(&s, dmb_analysis_static(s.sim, NULL, NULL));
        check_close("angle of the spring [rad]", angle(&s, joint), torque[i] / 0.1, 1e-9);
        rig_close(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(torque_from_rest),
        cmocka_unit_test(torque_that_reverses),
        cmocka_unit_test(motion_drives),
        cmocka_unit_test(gears_by_torque),
        cmocka_unit_test(leaning_axis),
        cmocka_unit_test(wheel_on_a_table),
        cmocka_unit_test(spring_wound_in_statics),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
