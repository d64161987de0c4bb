/* Joints where their angles or equations are not defined, against closed forms: a universal joint turned to a right
 * angle is refused there, at creation, in statics and in a run, and so are others that have something on their
 * angles. Checks eq:joints.coordinates. */
#include "hash.h"
#include "mechanism.h"

#include <stdio.h>
#include <string.h>

#define EDGE (0.5 * PI - 0.01)

/* A bar of 1 m, its middle at the joint with the ground, turned by RZ; in the air it turns at `speed` about z of b. */
typedef struct arm {
    rig s;
    dmb_id bar, joint;
} arm;

static dmb_joint_def arm_joint(const arm *a, int32_t kind)
{
    dmb_joint_def def = dmb_joint_def_default();
    (void)snprintf(def.name, sizeof def.name, "cross");
    def.kind = kind;
    def.place_b = dmb_station(a->bar, 0, 0.0);
    return def;
}

static arm describe_arm(double angle, double speed, double gravity)
{
    arm a;
    dmb_body_def body = dmb_body_def_default();
    rig_open(&a.s, 0.0, -gravity, 0.0);
    body.rotation[2] = angle;
    body.velocity[5] = speed;
    body.inertia[0] = 1e-3;
    body.inertia[1] = body.inertia[2] = 1.0 / 12.0;
    a.bar = add_body(&a.s, &body);
    return a;
}

static arm open_arm(const arm *described, const dmb_joint_def *def)
{
    const dmb_sim_options options = sharp_options(1.0, 1e-10);
    arm a = *described;
    a.joint = add_joint(&a.s, def);
    assert_int_equal(mechanism_start(&a.s, &options), DMB_OK);
    return a;
}

/* Steps until one is refused; the call leaves everything alone. Returns the time it stands at. */
static double run_until_refused(arm *a, double h)
{
    for (int k = 0; k < 100000; k++) {
        const uint64_t before = hash_of(a->s.sim);
        const double time = dmb_sim_time(a->s.sim);
        const int32_t status = dmb_sim_step(a->s.sim, h, NULL);
        if (status >= 0) continue;
        assert_int_equal(status, DMB_ERR_GEOMETRY);
        assert_true(hash_of(a->s.sim) == before);
        print_message("    %s\n", dmb_sim_message(a->s.sim));
        assert_non_null(strstr(dmb_sim_message(a->s.sim), "joint 0 (cross): |RZ| = 1.5"));
        assert_non_null(strstr(dmb_sim_message(a->s.sim), "must be < 1.5608"));
        return time;
    }
    fail();
    return 0.0;
}

/* RZ = speed t: the last step that stays below the bound is the last one taken, however long steps are. */
static void a_run_ends_at_the_right_angle(void **state)
{
    (void)state;
    for (double speed = -2.0; speed <= 2.0; speed += 4.0)
        for (double h = 1e-3; h < 0.2; h *= 5.0) {
            const arm described = describe_arm(0.0, speed, 0.0);
            const dmb_joint_def def = arm_joint(&described, DMB_JOINT_UNIVERSAL);
            arm a = open_arm(&described, &def);
            const double end = run_until_refused(&a, h);
            assert_true(2.0 * end < EDGE + 1e-9 && 2.0 * (end + h) > EDGE - 1e-9);
            check_below("RZ of the last state", fabs(joint_at(&a.s, a.joint).position[DMB_RZ] - speed * end), 1e-7);
            rig_close(&a.s);
        }
}

/* About y of a it may turn as often as it likes. */
static void the_other_axis_turns_on(void **state)
{
    (void)state;
    arm described = describe_arm(0.0, 0.0, 0.0);
    dmb_joint_def def = arm_joint(&described, DMB_JOINT_UNIVERSAL);
    def.initial_mask = DMB_FREE_RY;
    def.initial_speed[DMB_RY] = 3.0;
    const dmb_sim_options options = sharp_options(1.0, 1e-10);
    described.joint = add_joint(&described.s, &def);
    (void)mechanism_start(&described.s, &options);
    for (int k = 0; k < 1000; k++) must(&described.s, dmb_sim_step(described.s.sim, 5e-3, NULL));
    check_below("RY after 15 rad", fabs(joint_at(&described.s, described.joint).position[DMB_RY] - 15.0), 1e-6);
    rig_close(&described.s);
}

static void create_refuses_it(void **state)
{
    (void)state;
    for (double angle = -1.0; angle <= 1.0; angle += 2.0) {
        arm a = describe_arm(angle * (0.5 * PI - 0.005), 0.0, 0.0);
        const dmb_joint_def def = arm_joint(&a, DMB_JOINT_UNIVERSAL);
        a.joint = add_joint(&a.s, &def);
        const refusal r = refused_start(&a.s);
        print_message("    %s\n", r.text);
        assert_int_equal(r.status, DMB_ERR_GEOMETRY);
        assert_non_null(strstr(r.text, "cross"));
        assert_non_null(strstr(r.text, "|RZ| = 1.56"));
        rig_close(&a.s);
    }
    arm below = describe_arm(EDGE - 1e-3, 0.0, 0.0);
    const dmb_joint_def def = arm_joint(&below, DMB_JOINT_UNIVERSAL);
    arm a = open_arm(&below, &def);
    rig_close(&a.s);
}

/* The part on the joint hangs along y of a. */
static void statics_refuse_it(void **state)
{
    (void)state;
    arm described = describe_arm(1.0, 0.0, 9.81);
    dmb_joint_def def = arm_joint(&described, DMB_JOINT_UNIVERSAL);
    def.origin_b[0] = -0.5;
    def.origin_a[0] = -0.5 * cos(1.0);
    def.origin_a[1] = -0.5 * sin(1.0);
    arm a = open_arm(&described, &def);
    const uint64_t before = hash_of(a.s.sim);
    assert_int_equal(dmb_analysis_static(a.s.sim, NULL, NULL), DMB_ERR_GEOMETRY);
    print_message("    %s\n", dmb_sim_message(a.s.sim));
    assert_non_null(strstr(dmb_sim_message(a.s.sim), "joint 0 (cross): |RZ|"));
    assert_true(hash_of(a.s.sim) == before);
    rig_close(&a.s);
}

/* A ball turns through, unless a spring, damper, stop, friction, drive or coupling needs its angles. */
static void balls_only_with_something_on_their_angles(void **state)
{
    (void)state;
    for (int with = 0; with < 3; with++) {
        const arm described = describe_arm(0.0, 2.0, 0.0);
        dmb_joint_def def = arm_joint(&described, DMB_JOINT_SPHERICAL);
        if (with == 1) def.stiffness[DMB_RX] = 1e-6;
        if (with == 2) def.damping[DMB_RY] = 1e-9;
        arm a = open_arm(&described, &def);
        if (with > 0) {
            (void)run_until_refused(&a, 1e-2);
        } else {
            for (int k = 0; k < 200; k++) must(&a.s, dmb_sim_step(a.s.sim, 1e-2, NULL));
            check_below("turn of 4 rad", fabs(sin(joint_at(&a.s, a.joint).position[DMB_RZ]) - sin(4.0)), 1e-6);
        }
        rig_close(&a.s);
    }
}

static int32_t no_torque(void *context, double time, double out[3])
{
    (void)context, (void)time;
    out[0] = out[1] = out[2] = 0.0;
    return 0;
}

/* A drive about an axis of a ball needs its angles; one along an axis of a cylinder's joint, none of them. */
static void a_ball_with_a_drive_on_its_angles(void **state)
{
    (void)state;
    arm a = describe_arm(0.0, 2.0, 0.0);
    const dmb_joint_def def = arm_joint(&a, DMB_JOINT_SPHERICAL);
    a.joint = add_joint(&a.s, &def);
    (void)add_simple_drive(&a.s, DMB_DRIVE_LOAD, a.joint, DMB_RX, add_callback(&a.s, no_torque, NULL));
    (void)mechanism_start(&a.s, NULL);
    (void)run_until_refused(&a, 1e-2);
    rig_close(&a.s);
}

/* A gear between RX of a ball and a hinge needs the angles of the ball; a drive and a belt along the line that it is on
 * need none of them. */
static void a_ball_that_is_coupled_in_its_angles(void **state)
{
    (void)state;
    arm a = describe_arm(0.0, 2.0, 0.0);
    dmb_body_def other = dmb_body_def_default();
    dmb_coupling_def gear = dmb_coupling_def_default();
    const dmb_joint_def def = arm_joint(&a, DMB_JOINT_SPHERICAL);
    gear.joint[0] = a.joint = add_joint(&a.s, &def);
    other.position[1] = 3.0;
    dmb_joint_def hinge = dmb_joint_def_default();
    hinge.kind = DMB_JOINT_REVOLUTE;
    hinge.match = 1;
    hinge.place_b = dmb_station(add_body(&a.s, &other), 0, 0.0);
    gear.joint[1] = add_joint(&a.s, &hinge);
    must_model(&a.s, dmb_model_add_coupling(a.s.model, &gear, NULL));
    (void)mechanism_start(&a.s, NULL);
    (void)run_until_refused(&a, 1e-2);
    rig_close(&a.s);
}

static void on_a_line_it_is_led_and_coupled_along(void **state)
{
    (void)state;
    arm a = describe_arm(0.0, 2.0, 0.0);
    dmb_body_def other = dmb_body_def_default();
    dmb_coupling_def belt = dmb_coupling_def_default();
    const dmb_joint_def def = arm_joint(&a, DMB_JOINT_POINT_ON_LINE);
    belt.joint[0] = a.joint = add_joint(&a.s, &def);
    other.position[1] = 3.0;
    dmb_joint_def slider = dmb_joint_def_default();
    slider.kind = DMB_JOINT_PRISMATIC;
    slider.match = 1;
    slider.place_b = dmb_station(add_body(&a.s, &other), 0, 0.0);
    belt.joint[1] = add_joint(&a.s, &slider);
    belt.component[0] = belt.component[1] = DMB_X;
    must_model(&a.s, dmb_model_add_coupling(a.s.model, &belt, NULL));
    (void)add_simple_drive(&a.s, DMB_DRIVE_LOAD, a.joint, DMB_X, add_constant(&a.s, 1.0));
    const dmb_sim_options options = sharp_options(1.0, 1e-10);
    (void)mechanism_start(&a.s, &options);
    for (int k = 0; k < 200; k++) must(&a.s, dmb_sim_step(a.s.sim, 1e-2, NULL));
    const dmb_joint_state end = joint_at(&a.s, a.joint), beside = joint_at(&a.s, belt.joint[1]);
    check_below("a turn of 4 rad on the line", fabs(sin(end.position[DMB_RZ]) - sin(4.0)), 1e-4);
    check_close("both go along alike [m]", end.position[DMB_X] - beside.position[DMB_X], 0.0, 1e-9);
    check_close("pushed by 1 N for 2 s, 2 kg [m]", fabs(end.position[DMB_X]), 1.0,
                1e-4); /* it turns by 0.02 rad a step */
    rig_close(&a.s);
}

static void a_locked_joint_may_stand_there(void **state)
{
    (void)state;
    arm described = describe_arm(0.5 * PI, 0.0, 0.0);
    dmb_joint_def def = arm_joint(&described, DMB_JOINT_UNIVERSAL);
    def.state = DMB_JOINT_LOCKED;
    arm a = open_arm(&described, &def);
    must(&a.s, dmb_sim_step(a.s.sim, 1e-3, NULL));
    assert_int_equal(dmb_sim_set_joint(a.s.sim, a.joint, DMB_JOINT_OPEN), DMB_OK);
    assert_int_equal(dmb_sim_set_joint(a.s.sim, a.joint, DMB_JOINT_ACTIVE), DMB_ERR_GEOMETRY);
    print_message("    %s\n", dmb_sim_message(a.s.sim));
    must(&a.s, dmb_sim_step(a.s.sim, 1e-3, NULL));
    rig_close(&a.s);
}

/* A disc of radius 0.1 falls over. */
static void a_rim_that_lies_flat(void **state)
{
    (void)state;
    arm a = describe_arm(0.0, 0.0, 0.0);
    dmb_joint_def def = arm_joint(&a, DMB_JOINT_ROLLING);
    def.length = 0.1;
    a.joint = add_joint(&a.s, &def);
    const refusal r = refused_start(&a.s);
    print_message("    %s\n", r.text);
    assert_int_equal(r.status, DMB_ERR_GEOMETRY);
    assert_non_null(strstr(r.text, "lies flat"));
    rig_close(&a.s);
}

/* A moment M about z of b against a spring k on RZ rests at M/k: 1 rad, or 2 rad, which the joint can only come to over
 * its right angle. */
static int32_t rest_under(int32_t kind, double moment, double *angle, char message[256])
{
    arm a = describe_arm(0.0, 0.0, 0.0);
    dmb_joint_def def = arm_joint(&a, kind);
    dmb_load_def load = dmb_load_def_default();
    dmb_joint_state state = dmb_joint_state_default();
    def.stiffness[DMB_RY] = def.stiffness[DMB_RZ] = 10.0;
    if (kind == DMB_JOINT_SPHERICAL) def.stiffness[DMB_RX] = 10.0;
    load.place = dmb_station(a.bar, 0, 0.0);
    load.frame = DMB_FRAME_BODY;
    load.moment[2] = moment;
    (void)add_load(&a.s, &load);
    a = open_arm(&a, &def);
    const uint64_t before = hash_of(a.s.sim);
    const int32_t status = dmb_analysis_static(a.s.sim, NULL, NULL);
    if (status < 0) assert_true(hash_of(a.s.sim) == before);
    (void)snprintf(message, 256, "%s", dmb_sim_message(a.s.sim));
    assert_int_equal(dmb_query_joint(a.s.sim, a.joint, &state), DMB_OK);
    *angle = state.position[DMB_RZ];
    rig_close(&a.s);
    return status;
}

static void statics_do_not_fold_it(void **state)
{
    (void)state;
    const int32_t kinds[2] = {DMB_JOINT_UNIVERSAL, DMB_JOINT_SPHERICAL};
    for (int i = 0; i < 2; i++) {
        double angle;
        char message[256];
        assert_int_equal(rest_under(kinds[i], 10.0, &angle, message), DMB_OK);
        check_close("RZ = M/k [rad]", angle, 1.0, 1e-8);
        const int32_t status = rest_under(kinds[i], 20.0, &angle, message);
        print_message("    %s\n", message);
        assert_int_equal(status, i == 0 ? DMB_ERR_GEOMETRY : DMB_ERR_NO_CONVERGENCE);
        assert_non_null(
            strstr(message, i == 0 ? "joint 0 (cross): before the equilibrium" : "joint 0 (cross) came to |RZ| = 1.5"));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_run_ends_at_the_right_angle),
        cmocka_unit_test(the_other_axis_turns_on),
        cmocka_unit_test(create_refuses_it),
        cmocka_unit_test(statics_refuse_it),
        cmocka_unit_test(statics_do_not_fold_it),
        cmocka_unit_test(balls_only_with_something_on_their_angles),
        cmocka_unit_test(a_ball_with_a_drive_on_its_angles),
        cmocka_unit_test(a_ball_that_is_coupled_in_its_angles),
        cmocka_unit_test(on_a_line_it_is_led_and_coupled_along),
        cmocka_unit_test(a_locked_joint_may_stand_there),
        cmocka_unit_test(a_rim_that_lies_flat),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
