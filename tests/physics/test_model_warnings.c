/* Warnings of the model check that tell of several parts, of joints that are locked, of rims that lie flat, and the
 * parts they must pass over. */
#include <string.h>

#include "rig.h"

static char sheet[8192];

static const char *text_of(const rig *s)
{
    must(s, dmb_analysis_check_text(s->sim, sheet, sizeof sheet, NULL));
    return sheet;
}

static uint32_t warnings_of(const rig *s)
{
    dmb_check_report report = dmb_check_report_default();
    must(s, dmb_analysis_check(s->sim, &report));
    return report.warnings;
}

static void expect_line(const rig *s, const char *part)
{
    if (strstr(text_of(s), part) == NULL) fail_msg("not in the sheet: %s\n%s", part, sheet);
}

static dmb_place at(dmb_id part)
{
    return dmb_station(part, 0, 0.0);
}

static dmb_id add_ball(rig *s, double x, double turn)
{
    dmb_body_def body = dmb_body_def_default();
    body.position[0] = x;
    body.rotation[1] = turn;
    return add_body(s, &body);
}

/* ---- Joints ------------------------------------------------------------------------------------------------------ */

/* Balls at RZ = 89 deg with friction about RX. */
static void joints_at_a_right_angle(void **state)
{
    rig s;
    (void)state;
    rig_open(&s, 0.0, 0.0, 0.0);
    for (int i = 0; i < 2; i++) {
        dmb_joint_def ball = joint_between(DMB_JOINT_SPHERICAL, at((dmb_id){0, 0}), at(add_ball(&s, 5.0 * i, 0.0)));
        const double angle = 89.0 * PI / 180.0;
        ball.origin_a[0] = 5.0 * i;
        ball.axis_b[0] = cos(angle);
        ball.axis_b[1] = sin(angle);
        ball.normal_b[0] = -sin(angle);
        ball.normal_b[1] = cos(angle);
        ball.friction[DMB_RX] = 1.0;
        (void)add_joint(&s, &ball);
    }
    (void)rig_start(&s, NULL);
    assert_int_equal(warnings_of(&s), 1);
    expect_line(&s, "joint 0 (and 1 more): nearly singular");
    rig_close(&s);
}

/* A rim whose axis is `lean` off that of the plane it rolls on. */
static uint32_t warnings_of_a_rim(double lean)
{
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    dmb_joint_def rim = joint_between(DMB_JOINT_ROLLING, at((dmb_id){0, 0}), at(add_ball(&s, 0.4 * sin(lean), lean)));
    rim.length = 0.4;
    (void)add_joint(&s, &rim);
    (void)rig_start(&s, NULL);
    const uint32_t warnings = warnings_of(&s);
    if (warnings > 0) expect_line(&s, "joint 0: nearly singular");
    rig_close(&s);
    return warnings;
}

static void rim_that_lies_flat(void **state)
{
    (void)state;
    assert_int_equal(warnings_of_a_rim(0.5 * PI), 0);
    assert_int_equal(warnings_of_a_rim(0.1), 0);
    assert_int_equal(warnings_of_a_rim(0.02), 1);
}

static void drive_of_a_locked_joint(void **state)
{
    rig s;
    dmb_drive_def drive = dmb_drive_def_default();
    (void)state;
    rig_open(&s, 0.0, 0.0, 0.0);
    drive.kind = DMB_DRIVE_CONTROL;
    drive.gain = 1.0;
    drive.component = DMB_RX;
    drive.part = add_joint_between(&s, DMB_JOINT_REVOLUTE, at((dmb_id){0, 0}), at(add_ball(&s, 0.0, 0.0)));
    drive.time_function = add_constant(&s, 0.0);
    (void)add_drive(&s, &drive);
    (void)rig_start(&s, NULL);
    assert_int_equal(warnings_of(&s), 0);
    must(&s, dmb_sim_set_joint(s.sim, drive.part, DMB_JOINT_LOCKED));
    assert_int_equal(warnings_of(&s), 1);
    expect_line(&s, "drive 0: joint 0 is locked");
    rig_close(&s);
}

/* A free joint holds once it is locked. */
static void locked_free_joint_holds(void **state)
{
    rig s;
    dmb_joint_def joint;
    (void)state;
    rig_open(&s, 0.0, 0.0, -9.81);
    joint = joint_between(DMB_JOINT_FREE, at((dmb_id){0, 0}), at(add_ball(&s, 0.0, 0.0)));
    const dmb_id lock = add_joint(&s, &joint);
    (void)rig_start(&s, NULL);
    expect_line(&s, "body 0: no support, drive, joint");
    must(&s, dmb_sim_set_joint(s.sim, lock, DMB_JOINT_LOCKED));
    assert_int_equal(warnings_of(&s), 0);
    rig_close(&s);
}

/* ---- Holes ------------------------------------------------------------------------------------------------------- */

static void open_strings(rig *s, int32_t kind, int32_t law, double start_depth)
{
    dmb_wall_def wall = s1_hole();
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    rig_open(s, 0.0, 0.0, -9.81);
    wall.normal_law = law;
    (void)add_wall(s, &wall);
    for (int i = 0; i < 2; i++) {
        def.start_depth = start_depth + 20.0 * i * (start_depth < 0.0 ? -1.0 : 1.0);
        pipe.kind = kind;
        pipe.string = add_string(s, &def);
        (void)add_pipes(s, &pipe, 4);
    }
    (void)rig_start(s, NULL);
}

static void strings_past_the_start(void **state)
{
    rig s;
    (void)state;
    open_strings(&s, DMB_PIPE_FLEXIBLE, s1_hole().normal_law, -2.0);
    assert_int_equal(warnings_of(&s), 1);
    expect_line(&s, "string 0 (and 1 more): described 2 m before the start");
    rig_close(&s);
}

/* Pipes on the axis meet no wall, and miss none. */
static void strings_on_the_axis_miss_no_wall(void **state)
{
    rig s;
    (void)state;
    open_strings(&s, DMB_PIPE_AXIAL_TORSIONAL, DMB_NORMAL_NONE, 0.0);
    assert_int_equal(warnings_of(&s), 0);
    rig_close(&s);
    open_strings(&s, DMB_PIPE_FLEXIBLE, DMB_NORMAL_NONE, 0.0);
    assert_int_equal(warnings_of(&s), 1);
    expect_line(&s, "string 0: a hole is described, but its wall is not met");
    rig_close(&s);
}

/* ---- Units ------------------------------------------------------------------------------------------------------- */

/* Millimetres, GPa and g/cm3 where m, Pa and kg/m3 belong are told; what is right is not. */
static void values_in_other_units(void **state)
{
    rig s;
    dmb_wall_def wall = s1_hole();
    dmb_pipe_def pipe = s1_pipe();
    (void)state;
    rig_open(&s, 0.0, 0.0, -9.81);
    wall.diameter *= 1e3;
    (void)add_wall(&s, &wall);
    (void)add_pipes(&s, &pipe, 1);
    pipe.outer_diameter *= 1e3;
    pipe.inner_diameter *= 1e3;
    (void)add_pipes(&s, &pipe, 1);
    pipe = s1_pipe();
    pipe.young_modulus *= 1e-9;
    pipe.density *= 1e-3;
    (void)add_pipes(&s, &pipe, 1);
    (void)rig_start(&s, NULL);
    expect_line(&s, "wall: diameter = 94 m, which is unusual; fields are in SI units, was mm meant?");
    expect_line(&s, "outer_diameter = 73 m, which is unusual");
    expect_line(&s, "young_modulus = 210 Pa, which is unusual; fields are in SI units, was GPa meant?");
    expect_line(&s, "density = 7.85 kg/m3, which is unusual; fields are in SI units, was g/cm3 meant?");
    int told = 0;
    for (const char *at = text_of(&s); (at = strstr(at, "which is unusual")) != NULL; at++) told++;
    assert_int_equal(told, 4);
    rig_close(&s);
}

/* The fields of a pipe, wall and environment beyond the usual, each named with its range; the ends are not. */
static void unusual_values(void **state)
{
    static const struct {
        size_t offset;
        double inside[2], outside[2];
        const char *field;
    } cases[] = {{offsetof(dmb_pipe_def, young_modulus), {1e9, 1e12}, {2.1e8, 2.1e14}, "young_modulus"},
                 {offsetof(dmb_pipe_def, density), {500.0, 25e3}, {78.5, 78500.0}, "density"},
                 {offsetof(dmb_pipe_def, damping_time), {0.0, 0.01}, {0.1, 10.0}, "damping_time"},
                 {offsetof(dmb_pipe_def, yield_strength), {0.0, 3e9}, {750.0, 750e9}, "yield_strength"},
                 {offsetof(dmb_pipe_def, eccentricity), {0.0, 0.0073}, {0.02, 0.03}, "eccentricity"}};
    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++)
        for (int side = 0; side < 4; side++) {
            rig s;
            dmb_pipe_def pipe = s1_pipe();
            const double value = side < 2 ? cases[k].inside[side] : cases[k].outside[side - 2];
            memcpy((char *)&pipe + cases[k].offset, &value, sizeof value);
            rig_open(&s, 0.0, 0.0, -9.81);
            (void)add_pipes(&s, &pipe, 2);
            (void)rig_start(&s, NULL);
            const char *found = strstr(text_of(&s), "which is unusual; usual are");
            assert_int_equal(found != NULL, side >= 2);
            if (side >= 2) expect_line(&s, cases[k].field);
            rig_close(&s);
        }
}

static void unusual_wall_and_mud(void **state)
{
    rig s;
    dmb_wall_def wall = s1_hole();
    dmb_environment_def mud = dmb_environment_def_default();
    const dmb_pipe_def pipe = s1_pipe();
    (void)state;
    for (int beyond = 0; beyond < 2; beyond++) {
        rig_open(&s, 0.0, 0.0, -9.81);
        wall.mu_static = wall.mu_dynamic = beyond ? 30.0 : 1.0;
        mud.fluid_density = beyond ? 12e3 : 2400.0;
        mud.inner_density = beyond ? 9e3 : DMB_NOT_GIVEN;
        (void)add_wall(&s, &wall);
        (void)add_pipes(&s, &pipe, 2);
        assert_int_equal(dmb_model_set_environment(s.model, &mud), DMB_OK);
        (void)rig_start(&s, NULL);
        if (!beyond) assert_null(strstr(text_of(&s), "unusual"));
        if (beyond) {
            expect_line(&s, "wall: mu_static = 30, which is unusual; usual are 0 .. 1.5; check value and unit");
            expect_line(&s, "wall: mu_dynamic = 30");
            expect_line(&s, "environment: fluid_density = 12000 kg/m3, which is unusual; usual are 0 .. 3000");
            expect_line(&s, "environment: inner_density = 9000 kg/m3");
        }
        rig_close(&s);
    }
}

/* ---- Mass of bent elements --------------------------------------------------------------------------------------- */

/* A pipe described straight that a load bends, and the same described bent. */
static void bent_elements_are_told(void **state)
{
    (void)state;
    for (int curved = 0; curved < 2; curved++) {
        rig s;
        dmb_pipe_def pipe = s1_pipe();
        dmb_load_def load = dmb_load_def_default();
        rig_open(&s, 0.0, 0.0, 0.0);
        if (curved) pipe.curvature[1] = 0.01;
        const dmb_id string = add_beam(&s, &pipe, DMB_FREE_NONE);
        load.place = dmb_station(string, 0, 1.0);
        load.force[2] = 2e4;
        (void)add_load(&s, &load);
        (void)rig_start(&s, NULL);
        assert_int_equal(warnings_of(&s), 0);
        expect_line(&s, curved ? "mass matrix: curved for 1 elements, straight for 0,"
                               : "mass matrix: curved for 0 elements, straight for 1, which turn by at most 0 rad");
        (void)find_equilibrium(&s, NULL);
        assert_int_equal(warnings_of(&s), curved ? 0 : 1);
        if (!curved) expect_line(&s, "an element with the mass of a straight one is bent by");
        rig_close(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(joints_at_a_right_angle), cmocka_unit_test(rim_that_lies_flat),
        cmocka_unit_test(drive_of_a_locked_joint), cmocka_unit_test(locked_free_joint_holds),
        cmocka_unit_test(strings_past_the_start),  cmocka_unit_test(strings_on_the_axis_miss_no_wall),
        cmocka_unit_test(values_in_other_units),   cmocka_unit_test(unusual_values),
        cmocka_unit_test(unusual_wall_and_mud),    cmocka_unit_test(bent_elements_are_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
