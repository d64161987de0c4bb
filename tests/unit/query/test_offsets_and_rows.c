/* Poses and motions off a place against rigid bodies and differences, rows of the equations by whose they are;
 * redundant equations of drives by name; analyses that drives with actuators are refused in. */
#include <string.h>

#include "close.h"
#include "rig.h"

static const double offset[3] = {0.3, -0.2, 0.5};

static rig tumbling(dmb_id *id)
{
    dmb_body_def body = dmb_body_def_default();
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    for (int i = 0; i < 3; i++) body.inertia[i] = 0.3 + 0.1 * i, body.rotation[i] = 0.4 - 0.3 * i;
    for (int i = 0; i < 6; i++) body.velocity[i] = 1.5 - 0.6 * i;
    *id = add_body(&s, &body);
    rig_start(&s, NULL);
    return s;
}

static dmb_motion off(const rig *s, dmb_place place, int32_t frame)
{
    dmb_motion motion = dmb_motion_default();
    motion.frame = frame;
    must(s, dmb_query_motion_at(s->sim, place, offset, &motion));
    return motion;
}

/* In the world the derivative of the position; in the body's axes the world's velocity turned into them, and its
 * components' derivatives. */
static void motions_off_a_place(void **state)
{
    (void)state;
    enum { BEFORE, NOW, AFTER };
    const double h = 1e-4;
    dmb_id id;
    rig s = tumbling(&id);
    const dmb_place place = dmb_station(id, 0, 0.0);
    dmb_motion body[3], world[3];
    dmb_pose pose[3];
    for (int k = 0; k < 3; k++) {
        take_steps(&s, h, 1);
        body[k] = off(&s, place, DMB_FRAME_BODY);
        world[k] = off(&s, place, DMB_FRAME_WORLD);
        pose[k] = dmb_pose_default();
        must(&s, dmb_query_pose_at(s.sim, place, offset, &pose[k]));
    }
    for (int i = 0; i < 3; i++) {
        double turned = 0.0;
        for (int k = 0; k < 3; k++) turned += pose[NOW].rotation[3 * i + k] * body[NOW].velocity[k];
        CHECK_CLOSE(world[NOW].velocity[i], turned, 1e-13);
        CHECK_CLOSE((pose[AFTER].position[i] - pose[BEFORE].position[i]) / (2.0 * h), world[NOW].velocity[i], 1e-6);
        CHECK_CLOSE((world[AFTER].velocity[i] - world[BEFORE].velocity[i]) / (2.0 * h), world[NOW].acceleration[i],
                    1e-5);
        CHECK_CLOSE((body[AFTER].velocity[i] - body[BEFORE].velocity[i]) / (2.0 * h), body[NOW].acceleration[i], 1e-5);
    }
    rig_close(&s);
}

static void offsets_are_refused(void **state)
{
    (void)state;
    dmb_id id;
    rig s = tumbling(&id);
    const dmb_place place = dmb_station(id, 0, 0.0), wrong = dmb_station(id, 1, 0.0);
    dmb_pose pose = dmb_pose_default();
    dmb_motion motion = dmb_motion_default();
    pose.depth = motion.velocity[0] = 7.0;
    for (int k = 0; k < 3; k++) {
        double bad[3] = {0.0, 0.0, 0.0};
        bad[k] = k ? (double)NAN : (double)INFINITY;
        assert_int_equal(dmb_query_pose_at(s.sim, place, bad, &pose), DMB_ERR_NOT_FINITE);
        assert_int_equal(dmb_query_motion_at(s.sim, place, bad, &motion), DMB_ERR_NOT_FINITE);
    }
    const double far[3] = {1.7e308, 1.7e308,
                           -1.7e308}; /* its motion is beyond what numbers hold, and so is its place */
    assert_int_equal(dmb_query_pose_at(s.sim, place, far, &pose), DMB_ERR_NOT_FINITE);
    assert_int_equal(dmb_query_motion_at(s.sim, place, far, &motion), DMB_ERR_NOT_FINITE);
    assert_int_equal(dmb_query_pose_at(s.sim, place, NULL, &pose), DMB_ERR_NULL);
    assert_int_equal(dmb_query_motion_at(s.sim, place, NULL, &motion), DMB_ERR_NULL);
    assert_int_equal(dmb_query_pose_at(s.sim, wrong, offset, &pose), DMB_ERR_VALUE);
    assert_int_equal(dmb_query_motion_at(s.sim, wrong, offset, &motion), DMB_ERR_VALUE);
    motion.frame = 7;
    assert_int_equal(dmb_query_motion_at(s.sim, place, offset, &motion), DMB_ERR_VALUE);
    motion.struct_size = 3;
    assert_int_equal(dmb_query_motion_at(s.sim, place, offset, &motion), DMB_ERR_STRUCT_SIZE);
    CHECK_CLOSE(pose.depth, 7.0, 0.0);
    CHECK_CLOSE(motion.velocity[0], 7.0, 0.0);
    rig_close(&s);
}

/* ---- Rows -------------------------------------------------------------------------------------------------------- */

/* A string that is fed by a motion drive and turned by a torque: its first node's rows, and those of its support. */
static void rows_of_the_equations(void **state)
{
    static const int32_t wanted[6] = {DMB_ROW_DRIVEN, DMB_ROW_HELD, DMB_ROW_HELD,
                                      DMB_ROW_FREE,   DMB_ROW_HELD, DMB_ROW_HELD};
    (void)state;
    const dmb_pipe_def pipe = beam_pipe(1.0, 2, 1e7, 1e7, 1e4, 1e4);
    dmb_row row = dmb_row_default();
    uint32_t first, count;
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    const dmb_id string = add_beam(&s, &pipe, DMB_FREE_CYLINDRICAL), none = add_constant(&s, 0.0);
    (void)add_simple_drive(&s, DMB_DRIVE_LOAD, string, DMB_RX, none);
    (void)add_simple_drive(&s, DMB_DRIVE_MOTION, string, DMB_X, none);
    rig_start(&s, NULL);
    for (uint32_t i = 0; i < 18; i++) {
        must(&s, dmb_query_row(s.sim, i, &row));
        assert_int_equal(row.component, i % 6);
        assert_int_equal(row.part.index, string.index);
        assert_int_equal(row.state, i < 6 ? wanted[i] : DMB_ROW_FREE);
    }
    assert_int_equal(dmb_query_row(s.sim, 18, &row), DMB_ERR_VALUE);
    assert_int_equal(dmb_query_constraint_rows(s.sim, string, &first, &count), DMB_ERR_ID);
    assert_int_equal(dmb_query_constraint_rows(s.sim, string, &first, NULL), DMB_ERR_NULL);
    rig_close(&s);
}

/* A body on two hinges of one axis, both turned by drives: six of the twelve equations are redundant, and the text of
 * the model check tells drives as such. */
static void redundant_drives_by_name(void **state)
{
    (void)state;
    static char text[8192];
    rig s;
    dmb_body_def body = dmb_body_def_default();
    dmb_check_report report = dmb_check_report_default();
    rig_open(&s, 0.0, 0.0, 0.0);
    const dmb_id id = add_body(&s, &body), none = add_constant(&s, 0.0);
    for (int i = 0; i < 2; i++) {
        const dmb_id hinge =
            add_joint_between(&s, DMB_JOINT_REVOLUTE, dmb_station((dmb_id){0, 0}, 0, 0.0), dmb_station(id, 0, 0.0));
        (void)add_simple_drive(&s, DMB_DRIVE_MOTION, hinge, DMB_RX, none);
    }
    rig_start(&s, NULL);
    must(&s, dmb_analysis_check(s.sim, &report));
    assert_int_equal(report.constraint_rows, 12);
    assert_int_equal(report.redundant, 6);
    assert_int_equal(report.degrees_of_freedom, 0);
    must(&s, dmb_analysis_check_text(s.sim, text, sizeof text, NULL));
    if (strstr(text, ": rotation x of joint ") == NULL) fail_msg("%s", text);
    rig_close(&s);
}

/* ---- Actuators in linear analyses -------------------------------------------------------------------------------- */

/* Of two drives the second answers late, slowly, or by a curve: modes take the last, and a load's drive without a
 * control counts for none of them. */
static void actuators_in_modes(void **state)
{
    (void)state;
    for (int what = 0; what < 4; what++) {
        dmb_body_def body = dmb_body_def_default();
        dmb_drive_def drive = dmb_drive_def_default();
        dmb_modes *modes = NULL;
        dmb_modes_options options = dmb_modes_options_default();
        rig s;
        rig_open(&s, 0.0, 0.0, 0.0);
        body.free_mask = DMB_FREE_RX | DMB_FREE_X;
        drive.part = add_body(&s, &body);
        const dmb_id none = add_constant(&s, 0.0);
        (void)add_simple_drive(&s, DMB_DRIVE_LOAD, drive.part, DMB_X, none);
        drive.kind = DMB_DRIVE_CONTROL;
        drive.component = DMB_RX;
        drive.gain = 2.0, drive.integral_gain = 50.0;
        drive.time_function = none;
        if (what == 0) drive.delay = 0.01;
        if (what == 1) drive.force_rate = 100.0;
        if (what == 2) drive.lag = 0.01;
        if (what == 3) drive.drag = 0.5;
        (void)add_drive(&s, &drive);
        rig_start(&s, NULL);
        options.count = 2;
        const int32_t status = dmb_analysis_modes(s.sim, &options, &modes);
        if (what < 3) {
            assert_int_equal(status, DMB_ERR_UNSUPPORTED);
            assert_null(modes);
            assert_non_null(strstr(dmb_sim_message(s.sim), "drive 1 has an actuator (delay, force_rate or lag)"));
        } else {
            must(&s, status);
        }
        dmb_modes_destroy(&modes);
        rig_close(&s);
    }
}

/* ---- Axes and arrays --------------------------------------------------------------------------------------------- */

/* Rows of a body are in its own axes: gravity turned into them. */
static void accelerations_as_an_array(void **state)
{
    (void)state;
    dmb_body_def body = dmb_body_def_default();
    rig s;
    double rows[6];
    uint64_t count = 6;
    rig_open(&s, 0.0, 0.0, -9.81);
    for (int i = 0; i < 3; i++) body.rotation[i] = 0.4 - 0.3 * i;
    const dmb_place place = dmb_station(add_body(&s, &body), 0, 0.0);
    rig_start(&s, NULL);
    must(&s, dmb_analysis_array(s.sim, DMB_ARRAY_ACCELERATION, rows, &count));
    const dmb_pose pose = pose_at(&s, place);
    assert_int_equal(count, 6);
    for (int i = 0; i < 3; i++) {
        CHECK_CLOSE(rows[i], -9.81 * pose.rotation[6 + i], 1e-12);
        CHECK_CLOSE(rows[3 + i], 0.0, 1e-12);
    }
    rig_close(&s);
}

/* The same motion in axes of the world and of the place, which is tilted. */
static void shapes_in_axes_of_the_place(void **state)
{
    (void)state;
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    dmb_modes_options options = dmb_modes_options_default();
    dmb_modes *modes = NULL;
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    string.follows_hole = 0;
    string.start_free = DMB_FREE_NONE;
    for (int i = 0; i < 3; i++) string.rotation[i] = 0.5 - 0.2 * i;
    pipe.string = add_string(&s, &string);
    (void)add_pipes(&s, &pipe, 2);
    rig_start(&s, NULL);
    options.count = 3;
    must(&s, dmb_analysis_modes(s.sim, &options, &modes));
    const dmb_place end = dmb_station(pipe.string, 1, 1.0);
    const dmb_pose pose = pose_at(&s, end);
    for (uint32_t k = 0; k < 3; k++) {
        dmb_mode_shape world = dmb_mode_shape_default(), own = dmb_mode_shape_default();
        own.frame = DMB_FRAME_BODY;
        assert_int_equal(dmb_modes_shape(modes, k, end, &world), DMB_OK);
        assert_int_equal(dmb_modes_shape(modes, k, end, &own), DMB_OK);
        for (int i = 0; i < 6; i++) {
            const double *of_part = own.re + i / 3 * 3, *row = pose.rotation + 3 * (i % 3);
            CHECK_CLOSE(world.re[i], row[0] * of_part[0] + row[1] * of_part[1] + row[2] * of_part[2], 1e-12);
        }
        CHECK_CLOSE(own.re[0], 0.0, 1e-6); /* it bends, and does not stretch */
    }
    dmb_modes_destroy(&modes);
    rig_close(&s);
}

/* Down a vertical hole, and where there is none. */
static void the_hole_now(void **state)
{
    (void)state;
    for (int with = 0; with < 2; with++) {
        dmb_wall_def wall = s1_hole();
        dmb_hole_point point = dmb_hole_point_default(), now = dmb_hole_point_default();
        dmb_pipe_def pipe = s1_pipe();
        rig s;
        rig_open(&s, 0.0, 0.0, 0.0);
        wall.direction[0] = 0.0;
        wall.direction[2] = -1.0;
        if (with) (void)add_wall(&s, &wall);
        (void)add_pipes(&s, &pipe, 1);
        rig_start(&s, NULL);
        assert_int_equal(dmb_query_hole_now(s.sim, 7.0, &now), with ? DMB_OK : DMB_ERR_UNSUPPORTED);
        assert_int_equal(dmb_query_hole(s.model, 7.0, &point), with ? DMB_OK : DMB_ERR_UNSUPPORTED);
        CHECK_CLOSE(now.azimuth, 0.0, 0.0);
        CHECK_CLOSE(now.inclination, 0.0, 0.0);
        CHECK_CLOSE(now.position[2], with ? -7.0 : 0.0, 1e-14);
        CHECK_CLOSE(now.diameter, with ? 0.094 : 0.0, 1e-16);
        rig_close(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(accelerations_as_an_array),
        cmocka_unit_test(shapes_in_axes_of_the_place),
        cmocka_unit_test(the_hole_now),
        cmocka_unit_test(motions_off_a_place),
        cmocka_unit_test(offsets_are_refused),
        cmocka_unit_test(rows_of_the_equations),
        cmocka_unit_test(redundant_drives_by_name),
        cmocka_unit_test(actuators_in_modes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
