/* Steady states beside parts that have no part in the motion: drives of joints, of bodies and across the axis, places
 * that are stuck; and what of them is refused by name. */
#include <string.h>

#include "drillmbd/scene.h"
#include "rig.h"

#define SPIN 3.0 /* [rad/s] */

static dmb_id add_shaft(rig *s, int32_t start_free)
{
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    rig_open(s, 0.0, 0.0, 0.0);
    def.follows_hole = 0;
    def.start_free = start_free;
    pipe.string = add_string(s, &def);
    (void)add_pipes(s, &pipe, 3);
    (void)add_simple_drive(s, DMB_DRIVE_MOTION, pipe.string, DMB_RX, add_constant(s, SPIN));
    return pipe.string;
}

static dmb_id add_wheel(rig *s, int32_t free_mask)
{
    dmb_body_def def = dmb_body_def_default();
    def.position[1] = 2.0;
    def.free_mask = free_mask;
    return add_body(s, &def);
}

static dmb_id add_bearing(rig *s, dmb_id body, int axis)
{
    dmb_joint_def joint =
        joint_between(DMB_JOINT_REVOLUTE, dmb_station((dmb_id){0, 0}, 0, 0.0), dmb_station(body, 0, 0.0));
    joint.origin_a[1] = 2.0;
    for (int k = 0; k < 3; k++) {
        joint.axis_a[k] = joint.axis_b[k] = k == axis;
        joint.normal_a[k] = joint.normal_b[k] = k == (axis + 1) % 3;
    }
    return add_joint(s, &joint);
}

static void accepted(rig *s, int32_t steady, dmb_id shaft, dmb_id still)
{
    dmb_static_options options = dmb_static_options_default();
    options.steady = steady;
    (void)rig_start(s, NULL);
    assert_int_equal(find_equilibrium(s, &options).steady, steady);
    check_close("shaft", motion_at(s, dmb_station(shaft, 2, 1.0), DMB_FRAME_BODY).velocity[3], SPIN, 1e-12);
    if (still.generation != 0)
        for (int k = 0; k < 6; k++)
            assert_true(motion_at(s, dmb_station(still, 0, 0.0), DMB_FRAME_BODY).velocity[k] == 0.0);
    rig_close(s);
}

static void refused(rig *s, int32_t steady, const char *words)
{
    dmb_static_options options = dmb_static_options_default();
    (void)rig_start(s, NULL);
    const uint64_t before = rig_hash(s);
    options.steady = steady;
    assert_int_equal(dmb_analysis_static(s->sim, &options, NULL), DMB_ERR_UNSUPPORTED);
    if (strstr(dmb_sim_message(s->sim), words) == NULL) fail_msg("no \"%s\" in: %s", words, dmb_sim_message(s->sim));
    assert_true(rig_hash(s) == before);
    rig_close(s);
}

static void drives_of_joints(void **state)
{
    (void)state;
    for (int controlled = 0; controlled < 2; controlled++) {
        rig s;
        dmb_drive_def drive = dmb_drive_def_default();
        const dmb_id shaft = add_shaft(&s, DMB_FREE_RX), wheel = add_wheel(&s, DMB_FREE_ALL);
        drive.part = add_bearing(&s, wheel, 0);
        drive.kind = controlled ? DMB_DRIVE_CONTROL : DMB_DRIVE_MOTION;
        drive.component = DMB_RX;
        drive.gain = drive.integral_gain = controlled ? 10.0 : 0.0;
        drive.time_function = add_constant(&s, 0.0);
        (void)add_drive(&s, &drive);
        accepted(&s, DMB_STEADY_SLIDING, shaft, wheel);
    }
}

/* A force across on a body that stands still is one; on the string, by an actuator too, it turns. */
static void forces_across(void **state)
{
    (void)state;
    rig s;
    dmb_spring_def spring = dmb_spring_def_default();
    dmb_id shaft = add_shaft(&s, DMB_FREE_RX);
    const dmb_id wheel = add_wheel(&s, DMB_FREE_Y);
    spring.place_b = dmb_station(wheel, 0, 0.0);
    spring.stiffness = 100.0;
    must_model(&s, dmb_model_add_spring(s.model, &spring, NULL));
    (void)add_simple_drive(&s, DMB_DRIVE_LOAD, wheel, DMB_Y, add_constant(&s, 7.0));
    accepted(&s, DMB_STEADY_SLIDING, shaft, wheel);
    for (int actuated = 0; actuated < 2; actuated++) {
        dmb_drive_def drive = dmb_drive_def_default();
        drive.part = add_shaft(&s, DMB_FREE_SCHOENFLIES);
        drive.kind = DMB_DRIVE_LOAD;
        drive.component = DMB_Y;
        drive.lag = actuated ? 0.1 : 0.0;
        drive.time_function = add_constant(&s, 0.0);
        (void)add_drive(&s, &drive);
        refused(&s, DMB_STEADY_SLIDING, "its force turns with its string, across the axis");
    }
}

/* All turns about the axis of the shaft; a drive pushes it along against a load, by a force that is in all of it. */
static void loads_on_what_turns_as_one_body(void **state)
{
    (void)state;
    rig s;
    const dmb_id shaft = add_shaft(&s, DMB_FREE_CYLINDRICAL);
    dmb_load_def hold = dmb_load_def_default();
    dmb_static_options options = dmb_static_options_default();
    dmb_section section = dmb_section_default();
    (void)add_simple_drive(&s, DMB_DRIVE_LOAD, shaft, DMB_X, add_constant(&s, 5.0));
    hold.place = dmb_station(shaft, 2, 1.0);
    hold.force[0] = -5.0;
    (void)add_load(&s, &hold);
    (void)rig_start(&s, NULL);
    options.steady = DMB_STEADY_RIGID;
    assert_int_equal(find_equilibrium(&s, &options).steady, DMB_STEADY_RIGID);
    for (uint32_t pipe = 0; pipe < 3; pipe++) {
        must(&s, dmb_query_section(s.sim, dmb_station(shaft, pipe, 0.5), &section));
        check_close("axial force", section.force[0], -5.0, 1e-6);
        check_close("turning", motion_at(&s, dmb_station(shaft, pipe, 0.5), DMB_FRAME_BODY).velocity[3], SPIN, 1e-12);
    }
    rig_close(&s);
}

static void bearing_across_what_turns_as_one_body(void **state)
{
    (void)state;
    rig s;
    (void)add_shaft(&s, DMB_FREE_RX);
    (void)add_bearing(&s, add_wheel(&s, DMB_FREE_ALL), 2);
    refused(&s, DMB_STEADY_RIGID, "joints do not allow the whole to turn as one body");
}

static void add_stuck(rig *s, dmb_place place)
{
    dmb_stuck_def stuck = dmb_stuck_def_default();
    stuck.place = place;
    must_model(s, dmb_model_add_stuck(s->model, &stuck, NULL));
}

/* A body that is held stands still; of two places that are, the first one on the shaft is told. */
static void places_that_are_stuck(void **state)
{
    (void)state;
    rig s;
    dmb_id shaft = add_shaft(&s, DMB_FREE_RX);
    const dmb_id wheel = add_wheel(&s, DMB_FREE_CYLINDRICAL);
    add_stuck(&s, dmb_station(wheel, 0, 0.0));
    accepted(&s, DMB_STEADY_SLIDING, shaft, wheel);
    shaft = add_shaft(&s, DMB_FREE_RX);
    add_stuck(&s, dmb_station(shaft, 1, 1.0));
    add_stuck(&s, dmb_station(shaft, 2, 1.0));
    refused(&s, DMB_STEADY_SLIDING, "stuck 0 moves at 3");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(drives_of_joints),
        cmocka_unit_test(forces_across),
        cmocka_unit_test(loads_on_what_turns_as_one_body),
        cmocka_unit_test(bearing_across_what_turns_as_one_body),
        cmocka_unit_test(places_that_are_stuck),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
