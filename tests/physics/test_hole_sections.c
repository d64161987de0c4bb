/* The hole by sections against closed forms (pipe on two diameters, block over a friction step, ball up a slope, torque
 * and drag with piecewise friction), against the hole without sections, and what is refused. Equations:
 * eq:hole.section, eq:hole.section-force. */
#include <stdlib.h>
#include <string.h>

#include "contact_scene.h"
#include "drillmbd/scene.h"

static const double g = 9.81;

static dmb_hole_section section(double depth)
{
    dmb_hole_section made = dmb_hole_section_default();
    made.depth = depth;
    return made;
}

static void add_sections(const rig *scene, const dmb_hole_section *sections, uint32_t count)
{
    scene_must(scene, dmb_model_add_hole_sections(scene->model, sections, count));
}

/* ---- Motion ------------------------------------------------------------------------------------------------------ */

/* A block on the floor of the wide hole, at rest in it, free to move and not to turn. */
static dmb_id block(rig *scene, const dmb_wall_def *wall, const dmb_hole_section *sections, uint32_t count, double v,
                    double tolerance)
{
    dmb_body_def body = scene_ball(1.0, -g / wall->stiffness, DMB_FREE_X | DMB_FREE_Y | DMB_FREE_Z);
    dmb_sim_options options = dmb_sim_options_default();
    options.tolerance_translation = tolerance;
    options.newton_tolerance = 1e-11;
    body.velocity[0] = v;
    scene_open(scene, g);
    add_wall(scene, wall);
    add_sections(scene, sections, count);
    const dmb_id id = add_body(scene, &body);
    rig_start_with(scene, NULL, &options);
    return id;
}

static dmb_wall_def floor_of(double stiffness)
{
    dmb_wall_def wall = scene_wide_wall(DMB_NORMAL_HUNT_CROSSLEY, stiffness, 1.0, 0.4);
    wall.friction_law = DMB_FRICTION_COULOMB;
    wall.smoothing_speed = 1e-7;
    return wall;
}

/* v0^2/(2 g) = mu_1 d + mu_2 (s - d): the transition is as good as a sharp step. */
static void block_stops_beyond_a_friction_step(void **state)
{
    dmb_wall_def wall = floor_of(1e8);
    dmb_hole_section rough = section(0.4);
    rig scene;
    (void)state;
    wall.mu_static = wall.mu_dynamic = 0.1;
    rough.mu_static = rough.mu_dynamic = 0.4;
    const dmb_id id = block(&scene, &wall, &rough, 1, 2.0, 1e-12);
    scene_advance(&scene, 2.0);
    const double want = 0.4 + (2.0 * 2.0 / (2.0 * g) - 0.1 * 0.4) / 0.4;
    CHECK_RELATIVE(scene_displacement(&scene, id, 0), want, 1e-5);
    CHECK_RELATIVE(energy_of(&scene).friction, 2.0, 1e-5);
    CHECK_BELOW(fabs(energy_of(&scene).unexplained), 1e-8);
    rig_close(&scene);
}

/* A friction input is a factor on the coefficients of every section: v0^2/(2 g) = f mu s. */
static void friction_input_acts_in_sections(void **state)
{
    dmb_wall_def wall = floor_of(1e8);
    dmb_hole_section rough = section(-1.0);
    dmb_input_def input = dmb_input_def_default();
    dmb_body_def body = scene_ball(1.0, -g / wall.stiffness, DMB_FREE_X | DMB_FREE_Y | DMB_FREE_Z);
    dmb_sim_options options = dmb_sim_options_default();
    dmb_id id = {0, 0};
    rig scene;
    (void)state;
    rough.mu_static = rough.mu_dynamic = 0.2;
    options.tolerance_translation = 1e-12;
    options.newton_tolerance = 1e-11;
    body.velocity[0] = 2.0;
    input.target = DMB_TARGET_FRICTION;
    (void)strcpy(input.name, "friction");
    scene_open(&scene, g);
    add_wall(&scene, &wall);
    add_sections(&scene, &rough, 1);
    scene_must(&scene, dmb_model_add_input(scene.model, &input, &id));
    const dmb_id block_id = add_body(&scene, &body);
    rig_start_with(&scene, NULL, &options);
    scene_must(&scene, dmb_sim_set_input(scene.sim, id, 1.5));
    scene_advance(&scene, 2.0);
    CHECK_RELATIVE(scene_displacement(&scene, block_id, 0), 2.0 * 2.0 / (2.0 * g * 0.3), 1e-5);
    rig_close(&scene);
}

/* Up the floor of a hole that narrows, over a wall that gets softer: m v^2/2 goes into m g times the rise, of the floor
 * less that of the penetration, and into w^2/(2 K); nothing is lost. The wall pushes back along the hole on the way. */
static void ball_up_a_slope(void **state)
{
    dmb_wall_def wall = floor_of(1e6);
    dmb_hole_section slope[2] = {section(0.5), section(2.5)};
    rig scene;
    (void)state;
    wall.friction_law = DMB_FRICTION_NONE;
    wall.restitution = 1.0;
    slope[0].shape = DMB_HOLE_LINE;
    slope[0].transition = slope[1].transition = 0.8;
    slope[1].diameter = wall.diameter - 2.0 * 0.15;
    slope[1].stiffness = 2.5e5;
    const dmb_id id = block(&scene, &wall, slope, 2, 2.0, 1e-9);
    scene_advance(&scene, 0.8);
    const dmb_contact on_slope = scene_contact(&scene, 0);
    CHECK_RELATIVE(on_slope.along, -on_slope.normal_force * 0.15 / 2.0, 1e-3); /* rest: K' d^2/2 */
    scene_advance(&scene, 4.0);
    const double sunk = g * (1.0 / 2.5e5 - 1.0 / 1e6);
    const double v2 = 4.0 - 2.0 * g * (0.15 - sunk) - g * sunk; /* (w^2/(2 K)) differs by g sunk/2 */
    CHECK_RELATIVE(scene_speed(&scene, id, DMB_X), sqrt(v2), 1e-6);
    CHECK_CLOSE(scene_displacement(&scene, id, 2), 0.15 - sunk, 1e-6);
    CHECK_BELOW(fabs(energy_of(&scene).unexplained), 1e-6);
    rig_close(&scene);
}

/* A ring wider than what follows runs against the shoulder, comes back and never goes through. */
static void ring_wider_than_the_next_section_is_stopped(void **state)
{
    dmb_wall_def wall = floor_of(1e6);
    dmb_hole_section narrow = section(1.0);
    double furthest = 0.0;
    rig scene;
    (void)state;
    narrow.diameter = 3.9; /* R 1.95: the ring of the block is made of 3.94 m here */
    narrow.transition = 0.4;
    dmb_body_def body = scene_ball(1.0, 0.0, DMB_FREE_X | DMB_FREE_Y | DMB_FREE_Z);
    body.contact_diameter = 3.94;
    body.position[2] = -0.08;
    body.velocity[0] = 0.5;
    wall.friction_law = DMB_FRICTION_NONE;
    scene_open(&scene, g);
    add_wall(&scene, &wall);
    add_sections(&scene, &narrow, 1);
    const dmb_id id = add_body(&scene, &body);
    rig_start_with(&scene, NULL, NULL);
    for (int i = 1; i <= 100; i++) {
        scene_advance(&scene, 0.04 * i);
        furthest = fmax(furthest, scene_position(&scene, id, 0));
    }
    assert_true(furthest > 0.8 && furthest < 1.05);
    assert_true(scene_speed(&scene, id, DMB_X) < 0.0);
    rig_close(&scene);
}

/* ---- Rest -------------------------------------------------------------------------------------------------------- */

static dmb_id string_in(rig *scene, const dmb_hole_section *sections, uint32_t count, uint32_t elements)
{
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_string_def string = dmb_string_def_default();
    wall.friction_law = DMB_FRICTION_NONE;
    wall.stiffness = 1e6;
    string.start_free = DMB_FREE_CYLINDRICAL & ~DMB_FREE_X;
    pipe.length = 10.0;
    pipe.elements = elements;
    scene_open(scene, g);
    add_wall(scene, &wall);
    if (count > 0) add_sections(scene, sections, count);
    pipe.string = add_string(scene, &string);
    add_pipes(scene, &pipe, 8);
    rig_start_with(scene, NULL, NULL);
    return pipe.string;
}

/* Away from the step a string lies w/K below its clearance in each diameter, on a wall twice as stiff in the wide part;
 * the step pushes it towards where the hole is wider, against what holds its rig end. */
static void pipe_on_two_diameters(void **state)
{
    dmb_hole_section wide = section(40.0);
    dmb_section held = dmb_section_default();
    double along = 0.0;
    rig scene;
    (void)state;
    wide.diameter = 0.110;
    wide.stiffness = 2e6;
    wide.transition = 4.0;
    const dmb_id string = string_in(&scene, &wide, 1, 20);
    (void)find_equilibrium(&scene, NULL);
    const dmb_pipe_def pipe = dmb_pipe_def_default();
    const double weight = g * pipe.density * 0.25 * PI * (pow(pipe.outer_diameter, 2) - pow(pipe.inner_diameter, 2));
    const dmb_contact near = scene_contact(&scene, 2 * 20), far = scene_contact(&scene, 2 * 60);
    CHECK_RELATIVE(near.gap, -weight / 1e6, 1e-5);
    CHECK_RELATIVE(far.gap, -weight / 2e6, 1e-5);
    CHECK_RELATIVE(far.normal_force, weight * far.length, 1e-5);
    for (uint32_t s = 0; s < scene_info(&scene).contact_points; s++) along += scene_contact(&scene, s).along;
    assert_true(along > 0.1);
    scene_must(&scene, dmb_query_section(scene.sim, dmb_station(string, 0, 0.0), &held));
    CHECK_RELATIVE(held.force[0], along, 1e-6);
    rig_close(&scene);
}

/* ---- The same wall everywhere ------------------------------------------------------------------------------------ */

static void run_with(rig *scene, const dmb_hole_section *sections, uint32_t count, dmb_pose *end)
{
    static const double survey[9] = {0.0, 1.5, 0.0, 300.0, 1.4, 0.1, 900.0, 1.5, 0.3};
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    wall.survey = survey;
    wall.survey_count = 3;
    wall.friction_law = DMB_FRICTION_BRISTLE;
    scene_open(scene, g);
    add_wall(scene, &wall);
    if (count > 0) add_sections(scene, sections, count);
    const dmb_id string = add_pipes(scene, &pipe, 12);
    drive.part = string;
    drive.kind = DMB_DRIVE_MOTION;
    drive.component = DMB_RX;
    drive.time_function = add_constant(scene, 6.0);
    add_drive(scene, &drive);
    rig_start_with(scene, NULL, NULL);
    take_steps(scene, 1e-3, 200);
    *end = pose_at(scene, dmb_station(string, 11, 1.0));
}

/* 2e4 sections with the constants of the wall: the same bits as without. */
static void equal_sections_change_nothing(void **state)
{
    enum { COUNT = 20000 };
    const dmb_wall_def wall = dmb_wall_def_default();
    dmb_hole_section *many = malloc(COUNT * sizeof *many);
    rig with, without;
    dmb_pose a, b;
    (void)state;
    assert_non_null(many);
    for (uint32_t i = 0; i < COUNT; i++) {
        many[i] = section(0.05 * i);
        many[i].transition = 0.02;
        many[i].shape = i % 3 == 0 || i + 1 == COUNT ? DMB_HOLE_STEP : DMB_HOLE_LINE;
        if (i % 2 == 0) many[i].diameter = wall.diameter;
        if (i % 2 == 0) many[i].mu_static = wall.mu_static;
    }
    run_with(&without, NULL, 0, &a);
    run_with(&with, many, COUNT, &b);
    assert_memory_equal(a.position, b.position, sizeof a.position);
    CHECK_RELATIVE(energy_of(&with).contact, energy_of(&without).contact, 1e-12);
    rig_close(&with);
    rig_close(&without);
    free(many);
}

/* ---- Torque and drag --------------------------------------------------------------------------------------------- */

static void drag_scene(rig *scene, const double *survey, uint32_t stations, const double gravity[3])
{
    dmb_environment_def environment = dmb_environment_def_default();
    dmb_hole_section sections[2] = {section(300.0), section(650.0)};
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    memcpy(environment.gravity, gravity, sizeof environment.gravity);
    wall.survey = survey;
    wall.survey_count = stations;
    wall.mu_dynamic = 0.15;
    sections[0].mu_dynamic = 0.3;
    sections[1].mu_dynamic = 0.5;
    sections[1].mu_static = 0.5;
    string.start_free = DMB_FREE_NONE;
    pipe.length = 10.0;
    assert_int_equal(dmb_model_create(NULL, &scene->model), DMB_OK);
    scene_must(scene, dmb_model_set_environment(scene->model, &environment));
    add_wall(scene, &wall);
    add_sections(scene, sections, 2);
    pipe.string = add_string(scene, &string);
    add_pipes(scene, &pipe, 100);
    rig_start_with(scene, NULL, NULL);
}

static dmb_torque_drag_row drag_row(const rig *scene, const dmb_operation *operation)
{
    dmb_torque_drag_row row = dmb_torque_drag_row_default();
    scene_must(scene, dmb_analysis_torque_drag(scene->sim, NULL, operation, 1, &row));
    return row;
}

/* Straight and inclined: w L cos(a) + w sin(a) sum mu_i L_i. Round an arc without weight: T exp(sum mu_i angle_i). */
static void drag_with_piecewise_friction(void **state)
{
    static const double none[3] = {0.0, 0.0, 0.0}, down[3] = {0.0, 0.0, -9.81};
    const double a = 1.0;
    const double straight[6] = {0.0, a, 0.0, 1000.0, a, 0.0}, arc[6] = {0.0, 0.3, 0.2, 1000.0, 1.5, 0.2};
    dmb_operation pull = dmb_operation_default();
    dmb_torque_drag_options options = dmb_torque_drag_options_default();
    double factor;
    rig scene;
    (void)state;
    pull.axial_speed = -0.1;
    drag_scene(&scene, straight, 2, down);
    const dmb_pipe_def pipe = dmb_pipe_def_default();
    const double w = g * pipe.density * 0.25 * PI * (pow(pipe.outer_diameter, 2) - pow(pipe.inner_diameter, 2));
    const double rubbing = 0.15 * 300.0 + 0.3 * 350.0 + 0.5 * 350.0;
    CHECK_RELATIVE(drag_row(&scene, &pull).hook_load, w * (1000.0 * cos(a) + rubbing * sin(a)), 1e-12);
    options.friction_by_depth = 1;
    scene_must(&scene, dmb_analysis_friction_factor(scene.sim, &options, &pull, DMB_MEASURED_HOOK_LOAD,
                                                    w * (1000.0 * cos(a) + 0.8 * rubbing * sin(a)), &factor));
    CHECK_RELATIVE(factor, 0.8, 1e-9);
    rig_close(&scene);
    drag_scene(&scene, arc, 2, none);
    pull.weight_on_bit = -5e4;
    CHECK_RELATIVE(drag_row(&scene, &pull).hook_load, 5e4 * exp(1.2e-3 * rubbing), 1e-9);
    rig_close(&scene);
}

/* ---- Questions --------------------------------------------------------------------------------------------------- */

static void what_the_hole_tells(void **state)
{
    dmb_hole_section sections[3] = {section(5.0), section(20.0), section(25.0)};
    dmb_hole_point at = dmb_hole_point_default();
    rig scene;
    (void)state;
    (void)strcpy(sections[0].name, "open hole");
    sections[0].diameter = 0.12;
    sections[0].strength = 5e7;
    sections[1].shape = DMB_HOLE_LINE;
    sections[1].mu_dynamic = 0.2;
    sections[2].diameter = 0.14;
    (void)string_in(&scene, sections, 3, 1);
    static const struct {
        double depth, diameter, mu;
        uint32_t section;
    } cases[] = {{-3.0, 0.094, 0.3, DMB_NONE}, {4.95, 0.094, 0.3, DMB_NONE}, {5.0, 0.107, 0.3, 0}, {5.05, 0.12, 0.3, 0},
                 {15.0, 0.12, 0.3, 0},         {22.5, 0.117, 0.25, 1},       {26.0, 0.14, 0.3, 2}, {1e4, 0.14, 0.3, 2}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        assert_int_equal(dmb_query_hole(scene.model, cases[i].depth, &at), DMB_OK);
        CHECK_RELATIVE(at.diameter, cases[i].diameter, 1e-12);
        CHECK_RELATIVE(at.mu_dynamic, cases[i].mu, 1e-12);
        assert_int_equal(at.section, cases[i].section);
    }
    assert_int_equal(dmb_query_hole(scene.model, 10.0, &at), DMB_OK);
    assert_string_equal(at.section_name, "open hole");
    CHECK_RELATIVE(at.strength, 5e7, 1e-15);
    CHECK_RELATIVE(at.stiffness, 1e6, 1e-15);
    rig_close(&scene);
}

/* ---- What is refused --------------------------------------------------------------------------------------------- */

enum { AT_ONCE, BY_COMPILE };

static void expect_refusal(const dmb_hole_section *sections, uint32_t count, int when, int32_t status, const char *text)
{
    const dmb_wall_def wall = dmb_wall_def_default();
    const dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_pipe_def jointed = pipe;
    rig scene;
    jointed.joint_length = 0.2;
    jointed.joint_outer_diameter = 0.09;
    scene_open(&scene, g);
    add_wall(&scene, &wall);
    const int32_t added = dmb_model_add_hole_sections(scene.model, sections, count);
    if (added >= 0) add_pipes(&scene, &jointed, 10);
    const int32_t got = added < 0 ? added : dmb_model_compile(scene.model, NULL);
    if ((added < 0) != (when == AT_ONCE) || got != status || strstr(dmb_model_message(scene.model), text) == NULL)
        fail_msg("\"%s\": %d, %d: %s", text, (int)added, (int)got, dmb_model_message(scene.model));
    dmb_model_destroy(&scene.model);
}

static void bad_tables_are_refused(void **state)
{
    dmb_hole_section two[2] = {section(3.0), section(3.0)};
    (void)state;
    expect_refusal(two, 2, AT_ONCE, DMB_ERR_VALUE, "hole section 1: depth"); /* not sorted */
    expect_refusal(two, 0, AT_ONCE, DMB_ERR_VALUE, "count");
    two[0].shape = DMB_HOLE_LINE;
    expect_refusal(two, 1, BY_COMPILE, DMB_ERR_GEOMETRY, "must be DMB_HOLE_STEP"); /* a line from one point */
    two[0].shape = 2;
    expect_refusal(two, 1, AT_ONCE, DMB_ERR_VALUE, "shape");
    two[0].shape = DMB_HOLE_STEP;
    two[1].depth = 3.09;
    expect_refusal(two, 2, BY_COMPILE, DMB_ERR_GEOMETRY, "shorter transitions");
    two[0].diameter = 0.4;
    two[0].transition = 0.01;
    expect_refusal(two, 1, BY_COMPILE, DMB_ERR_GEOMETRY, "longer transition");
    two[0] = section(3.0);
    two[0].mu_static = 0.1;
    expect_refusal(two, 1, BY_COMPILE, DMB_ERR_VALUE, "mu_static");
    two[0] = section(3.0);
    two[0].diameter = 0.0899;
    expect_refusal(two, 1, BY_COMPILE, DMB_ERR_GEOMETRY, "joint_outer_diameter = 0.09, must be <= 0.0899 m");
    two[1] = section(4.0);
    two[1].diameter = 0.072;
    expect_refusal(two + 1, 1, BY_COMPILE, DMB_ERR_GEOMETRY, "joint_outer_diameter = 0.09, must be <= 0.083 m");
}

static void bad_values_are_refused(void **state)
{
    static const double values[] = {(double)NAN, (double)INFINITY, -(double)INFINITY, -2.0, 0.0};
    static const size_t fields[] = {offsetof(dmb_hole_section, diameter), offsetof(dmb_hole_section, stiffness),
                                    offsetof(dmb_hole_section, transition)};
    (void)state;
    for (size_t f = 0; f < 3; f++)
        for (size_t v = 0; v < 5; v++) {
            dmb_hole_section one = section(3.0);
            memcpy((char *)&one + fields[f], values + v, sizeof(double));
            expect_refusal(&one, 1, AT_ONCE, isfinite(values[v]) ? DMB_ERR_VALUE : DMB_ERR_NOT_FINITE, "must be");
        }
    dmb_hole_section one = section(3.0);
    one.transition = -1.0;
    expect_refusal(&one, 1, AT_ONCE, DMB_ERR_VALUE, "transition");
    one = section(3.0);
    one.restitution = 1.5;
    expect_refusal(&one, 1, AT_ONCE, DMB_ERR_VALUE, "restitution");
    one = section((double)NAN);
    expect_refusal(&one, 1, AT_ONCE, DMB_ERR_NOT_FINITE, "depth");
}

/* A ring, a body, a pipe that does not follow the hole, in front of a narrow section; each is wider than it. */
enum { RING, BODY, PIPE };

static int32_t compile_wide(int part, int32_t normal_law, char message[256])
{
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_hole_section narrow = section(3.0);
    dmb_body_def body = dmb_body_def_default();
    dmb_stabiliser_def ring = dmb_stabiliser_def_default();
    rig scene;
    scene_open(&scene, g);
    wall.diameter = 0.1;
    wall.normal_law = normal_law;
    wall.friction_law = DMB_FRICTION_NONE;
    add_wall(&scene, &wall);
    narrow.diameter = part == PIPE ? 0.07 : 0.08;
    add_sections(&scene, &narrow, 1);
    string.follows_hole = part != PIPE;
    ring.string = body.string = pipe.string = add_string(&scene, &string);
    add_pipes(&scene, &pipe, 6);
    body.attach = DMB_ATTACH_END;
    body.contact_diameter = body.contact_length = 0.09;
    if (part == BODY) (void)add_body(&scene, &body);
    ring.pipe = 5;
    ring.outer_diameter = 0.09;
    if (part == RING) scene_must(&scene, dmb_model_add_stabiliser(scene.model, &ring, NULL));
    const int32_t status = dmb_model_compile(scene.model, NULL);
    strncpy(message, dmb_model_message(scene.model), 255)[255] = '\0';
    dmb_model_destroy(&scene.model);
    return status;
}

/* Without a wall that presses anything fits. */
static void what_is_too_wide_is_refused(void **state)
{
    static const char *const told[3] = {"stabiliser 0: outer_diameter = 0.09, must be <= 0.08 m",
                                        "body 0: contact_diameter = 0.09, must be <= 0.08 m",
                                        "outer_diameter = 0.073, must be <= 0.07 m"};
    char message[256];
    (void)state;
    for (int part = RING; part <= PIPE; part++) {
        const int32_t status = compile_wide(part, DMB_NORMAL_HUNT_CROSSLEY, message);
        print_message("    %s\n", message);
        assert_int_equal(status, DMB_ERR_GEOMETRY);
        assert_non_null(strstr(message, told[part]));
        assert_int_equal(compile_wide(part, DMB_NORMAL_NONE, message), DMB_OK);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(block_stops_beyond_a_friction_step),
        cmocka_unit_test(friction_input_acts_in_sections),
        cmocka_unit_test(ball_up_a_slope),
        cmocka_unit_test(ring_wider_than_the_next_section_is_stopped),
        cmocka_unit_test(pipe_on_two_diameters),
        cmocka_unit_test(equal_sections_change_nothing),
        cmocka_unit_test(drag_with_piecewise_friction),
        cmocka_unit_test(what_the_hole_tells),
        cmocka_unit_test(bad_tables_are_refused),
        cmocka_unit_test(bad_values_are_refused),
        cmocka_unit_test(what_is_too_wide_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
