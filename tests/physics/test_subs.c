/* Subs, bodies in the middle of a string, and the sections that continue it: against the same scenes typed by hand in
 * runs and in every analysis, poses in closed form along arcs, and a string that is not interrupted; refusals that
 * leave nothing. Checks eq:kinematics.far-end. */
#include <stdlib.h>
#include <string.h>

#include "modal.h"

static const double tilt[3] = {0.0, 0.3, 0.0}; /* about y: x points to (cos, 0, -sin) */

static dmb_pipe_def pipe_of(dmb_id string)
{
    dmb_pipe_def pipe = s1_pipe();
    pipe.string = string;
    return pipe;
}

static dmb_string_def first_section(void)
{
    dmb_string_def def = dmb_string_def_default();
    def.follows_hole = 0;
    def.start_free = DMB_FREE_NONE;
    memcpy(def.rotation, tilt, sizeof tilt);
    return def;
}

static dmb_body_def collar(void)
{
    dmb_body_def body = dmb_body_def_default();
    body.mass = 30.0;
    body.inertia[0] = 0.05;
    body.inertia[1] = body.inertia[2] = 0.4;
    body.centre[0] = 0.2;
    return body;
}

static dmb_joint_def knuckle(void)
{
    dmb_joint_def joint = dmb_joint_def_default();
    joint.kind = DMB_JOINT_UNIVERSAL;
    for (int i = 4; i < 6; i++) joint.stiffness[i] = 2e4, joint.damping[i] = 20.0;
    return joint;
}

enum { PIPES = 3 };
static const double length = 0.4; /* [m] of the body */

typedef struct two_sections {
    rig s;
    dmb_id first, second, body;
} two_sections;

static void begin(two_sections *r)
{
    const dmb_string_def def = first_section();
    rig_open(&r->s, 0.0, 0.0, -9.81);
    r->first = add_string(&r->s, &def);
    const dmb_pipe_def pipe = pipe_of(r->first);
    add_pipes(&r->s, &pipe, PIPES);
}

static void go_on(two_sections *r)
{
    const dmb_pipe_def pipe = pipe_of(r->second);
    add_pipes(&r->s, &pipe, PIPES);
    rig_start(&r->s, NULL);
    take_steps(&r->s, 1e-3, 100);
}

static two_sections by_sub(void)
{
    two_sections r;
    dmb_sub_def def = dmb_sub_def_default();
    dmb_sub made = dmb_sub_default();
    const dmb_body_def body = collar();
    const dmb_joint_def joint = knuckle();
    begin(&r);
    def.length = length;
    def.body = &body;
    def.after = &joint;
    must_model(&r.s, dmb_model_add_sub(r.s.model, &def, &made));
    assert_int_equal(made.end.pipe, PIPES - 1);
    r.body = made.body;
    r.second = made.section;
    go_on(&r);
    return r;
}

static two_sections by_hand(void)
{
    two_sections r;
    dmb_body_def body = collar();
    dmb_string_def section = first_section();
    begin(&r);
    const double reach = PIPES * s1_pipe().length, along[3] = {cos(tilt[1]), 0.0, -sin(tilt[1])};
    for (int i = 0; i < 3; i++) {
        body.position[i] = reach * along[i];
        section.position[i] = (reach + length) * along[i];
    }
    memcpy(body.rotation, tilt, sizeof tilt);
    section.start_free = DMB_FREE_ALL;
    r.body = add_body(&r.s, &body);
    r.second = add_string(&r.s, &section);
    const dmb_place on_body = dmb_station(r.body, 0, 0.0);
    dmb_joint_def before = joint_between(DMB_JOINT_FIXED, dmb_station(r.first, PIPES - 1, 1.0), on_body);
    dmb_joint_def after = knuckle();
    add_joint(&r.s, &before);
    after.place_a = on_body;
    after.place_b = dmb_station(r.second, 0, 0.0);
    after.origin_a[0] = length;
    add_joint(&r.s, &after);
    go_on(&r);
    return r;
}

static void as_typed_by_hand(void **state)
{
    (void)state;
    two_sections a = by_sub(), b = by_hand();
    double worst = 0.0, moved = 0.0;
    for (uint32_t p = 0; p < PIPES; p++) {
        const dmb_pose x = pose_at(&a.s, dmb_station(a.second, p, 1.0)),
                       y = pose_at(&b.s, dmb_station(b.second, p, 1.0));
        for (int i = 0; i < 3; i++) {
            worst = fmax(worst, fabs(x.position[i] - y.position[i]));
            moved = fmax(moved, fabs(x.displacement[i]));
        }
    }
    tell("moved [m]", moved);
    assert_true(moved > 1e-2);
    check_below("by a sub or by hand [m]", worst, 1e-12);
    rig_close(&a.s);
    rig_close(&b.s);
}

/* A sub without length and nearly without mass is a string that is not interrupted. */
static void as_not_interrupted(void **state)
{
    (void)state;
    double z[2];
    for (int whole = 0; whole < 2; whole++) {
        two_sections r;
        begin(&r);
        r.second = r.first;
        if (!whole) {
            dmb_sub_def def = dmb_sub_def_default();
            dmb_sub made = dmb_sub_default();
            dmb_body_def body = dmb_body_def_default();
            body.mass = 1e-6;
            for (int i = 0; i < 3; i++) body.inertia[i] = 1e-9;
            def.body = &body;
            must_model(&r.s, dmb_model_add_sub(r.s.model, &def, &made));
            r.second = made.section;
        }
        go_on(&r);
        z[whole] = pose_at(&r.s, dmb_station(r.second, whole ? 2 * PIPES - 1 : PIPES - 1, 1.0)).displacement[2];
        rig_close(&r.s);
    }
    assert_true(fabs(z[1]) > 1e-3);
    check_relative("a string with a light sub or none", z[0], z[1], 1e-6);
}

/* ---- Analyses ---------------------------------------------------------------------------------------------------- */

/* Both scenes at rest, the load of a sagging cantilever on a knuckle: statics, modes and a response of joints. */
static void at_rest(void **state)
{
    (void)state;
    two_sections both[2] = {by_sub(), by_hand()};
    double z[2], frequency[2][6];
    for (int k = 0; k < 2; k++) {
        find_equilibrium(&both[k].s, NULL);
        z[k] = pose_at(&both[k].s, dmb_station(both[k].second, PIPES - 1, 1.0)).displacement[2];
        dmb_modes *modes = lowest_modes(&both[k].s, DMB_MODES_UNDAMPED, 6);
        for (uint32_t i = 0; i < 6; i++) frequency[k][i] = frequency_at(modes, i);
        dmb_modes_destroy(&modes);
    }
    assert_true(fabs(z[0]) > 1e-3);
    check_relative("sag by a sub or by hand", z[0], z[1], 1e-9);
    for (int i = 0; i < 6; i++) check_relative("    frequency", frequency[0][i], frequency[1][i], 1e-8);
    for (int k = 0; k < 2; k++) rig_close(&both[k].s);
}

/* A snapshot of the one goes on in a sim of its own, and the state of the scene by hand in the scene by subs. */
static void taken_over(void **state)
{
    (void)state;
    two_sections a = by_sub(), b = by_hand();
    dmb_sim *again = NULL;
    size_t size;
    must(&a.s, dmb_sim_snapshot_size(a.s.sim, &size));
    void *bytes = malloc(size);
    must(&a.s, dmb_sim_snapshot(a.s.sim, bytes, size));
    must_model(&a.s, dmb_sim_create(a.s.model, NULL, &again));
    must(&a.s, dmb_sim_restore(again, bytes, size));
    rig other = {a.s.model, again};
    assert_int_equal(rig_hash(&other), rig_hash(&a.s));
    take_steps(&other, 1e-3, 20);
    take_steps(&a.s, 1e-3, 20);
    assert_int_equal(rig_hash(&other), rig_hash(&a.s));
    must(&other, dmb_sim_transfer_state(again, b.s.sim));
    const dmb_pose x = pose_at(&other, dmb_station(a.second, PIPES - 1, 1.0)),
                   y = pose_at(&b.s, dmb_station(b.second, PIPES - 1, 1.0));
    for (int i = 0; i < 3; i++) check_close("state transfer [m]", x.position[i], y.position[i], 1e-12);
    free(bytes);
    dmb_sim_destroy(&again);
    rig_close(&a.s);
    rig_close(&b.s);
}

static two_sections with_mass(double mass)
{
    two_sections r;
    dmb_sub_def def = dmb_sub_def_default();
    dmb_sub made = dmb_sub_default();
    dmb_body_def body = collar();
    const dmb_joint_def joint = knuckle();
    begin(&r);
    body.mass = mass;
    def.length = length;
    def.body = &body;
    def.after = &joint;
    must_model(&r.s, dmb_model_add_sub(r.s.model, &def, &made));
    r.second = made.section;
    const dmb_pipe_def pipe = pipe_of(r.second);
    add_pipes(&r.s, &pipe, PIPES);
    rig_start(&r.s, NULL);
    return r;
}

/* The derivative of the far end's height by the mass of the sub, along a run, against differences of runs. */
static void by_its_mass(void **state)
{
    (void)state;
    enum { STEPS = 60 };
    const double mass = 30.0, step = 0.01, far = 0.2;
    two_sections r = with_mass(mass), low = with_mass(mass - step), high = with_mass(mass + step);
    dmb_parameter parameter = dmb_parameter_default();
    dmb_sensitivity *sensitivity;
    double derivative = 0.0, ends[2];
    parameter.step = step;
    parameter.low = low.s.sim;
    parameter.high = high.s.sim;
    must(&r.s, dmb_sensitivity_create(r.s.sim, &parameter, 1, &sensitivity));
    const dmb_output output = {dmb_station(r.second, PIPES - 1, 1.0), DMB_OUTPUT_POSITION_Z, 0};
    for (int i = 0; i < STEPS; i++) must(&r.s, dmb_sensitivity_step(sensitivity, 1e-3, NULL));
    must(&r.s, dmb_sensitivity_outputs(sensitivity, &output, 1, NULL, &derivative));
    for (int k = 0; k < 2; k++) {
        two_sections one = with_mass(mass + (k ? far : -far));
        take_steps(&one.s, 1e-3, STEPS);
        ends[k] = pose_at(&one.s, dmb_station(one.second, PIPES - 1, 1.0)).position[2];
        rig_close(&one.s);
    }
    check_relative("dz/dm by sensitivity", derivative, (ends[1] - ends[0]) / (2.0 * far), 1e-4);
    dmb_sensitivity_destroy(&sensitivity);
    rig_close(&r.s);
    rig_close(&low.s);
    rig_close(&high.s);
}

/* Three subs one after the other with pipes between, along a hole that bends: each body is on the hole's axis at its
 * depth, and the drive of the first section turns all of them. */
static void several_in_a_hole(void **state)
{
    (void)state;
    const double survey[3][3] = {{0.0, 0.5 * PI, 0.0}, {10.0, 0.5 * PI, 0.0}, {40.0, 0.5 * PI - 0.3, 0.0}};
    rig s;
    dmb_wall_def wall = s1_hole();
    dmb_string_def string = dmb_string_def_default();
    dmb_sub made = dmb_sub_default();
    dmb_id bodies[3];
    rig_open(&s, 0.0, 0.0, -9.81);
    wall.survey = survey[0];
    wall.survey_count = 3;
    add_wall(&s, &wall);
    string.start_free = DMB_FREE_RX;
    const dmb_id first = add_string(&s, &string);
    dmb_pipe_def pipe = pipe_of(first);
    const double along = 4.0 * pipe.length;
    for (int i = 0; i < 3; i++) {
        dmb_sub_def def = dmb_sub_def_default();
        dmb_body_def body = collar();
        add_pipes(&s, &pipe, 4);
        def.string = pipe.string;
        def.length = length;
        def.body = &body;
        must_model(&s, dmb_model_add_sub(s.model, &def, &made));
        bodies[i] = made.body;
        pipe.string = made.section;
    }
    add_pipes(&s, &pipe, 4);
    add_simple_drive(&s, DMB_DRIVE_MOTION, first, DMB_RX, add_constant(&s, 5.0));
    rig_start(&s, NULL);
    for (int i = 0; i < 3; i++) {
        const double depth = along * (i + 1) + length * i, bend = fmax(depth - 10.0, 0.0) * 0.01;
        const dmb_pose pose = pose_at(&s, dmb_station(bodies[i], 0, 0.0));
        check_close("body on the axis, x", pose.position[0], fmin(depth, 10.0) + sin(bend) / 0.01, 1e-9);
        check_close("    z", pose.position[2], -(1.0 - cos(bend)) / 0.01, 1e-9);
    }
    dmb_operation operation = dmb_operation_default();
    dmb_torque_drag_row row = dmb_torque_drag_row_default();
    must(&s, dmb_operation_usual(DMB_OPERATION_ROTATE, &operation));
    assert_int_equal(dmb_analysis_torque_drag(s.sim, NULL, &operation, 1, &row), DMB_ERR_UNSUPPORTED);
    assert_non_null(strstr(dmb_sim_message(s.sim), "a sub continues the string"));
    must(&s, dmb_sim_advance(s.sim, 0.4, NULL));
    check_relative("the last one turns with the first", rotation_at(&s, dmb_station(bodies[2], 0, 0.0)),
                   rotation_at(&s, dmb_station(first, 0, 0.0)), 0.05);
    rig_close(&s);
}

/* ---- Poses ------------------------------------------------------------------------------------------------------- */

/* Curved pipes, and a curved hole: both bend down on an arc about y. The string turns about its start. */
static void along_arcs(void **state)
{
    (void)state;
    const double bend = 0.01;
    for (int hole = 0; hole < 2; hole++) {
        rig s;
        dmb_string_def def = dmb_string_def_default();
        dmb_body_def body = dmb_body_def_default();
        dmb_string_def section = dmb_string_def_default();
        rig_open(&s, 0.0, 0.0, 0.0);
        if (hole) {
            const double survey[2][3] = {{0.0, 0.5 * PI, 0.0}, {60.0, 0.5 * PI - 60.0 * bend, 0.0}};
            dmb_wall_def wall = s1_hole();
            wall.survey = survey[0];
            wall.survey_count = 2;
            add_wall(&s, &wall);
        }
        def.follows_hole = hole;
        def.velocity[0] = 0.5;
        def.velocity[4] = 0.2;
        dmb_pipe_def pipe = pipe_of(add_string(&s, &def));
        if (!hole) pipe.curvature[1] = bend;
        add_pipes(&s, &pipe, 10);
        const double reach = 10.0 * pipe.length, angle = bend * reach;
        must_model(&s, dmb_model_place_at_end(s.model, pipe.string, 0.0, &body, NULL));
        must_model(&s, dmb_model_place_at_end(s.model, pipe.string, 1.0, NULL, &section));
        const double x = sin(angle) / bend, z = -(1.0 - cos(angle)) / bend;
        check_close("x", body.position[0], x, 1e-11);
        check_close("z", body.position[2], z, 1e-11);
        check_close("turned", body.rotation[1], angle, 1e-12);
        const double u = 0.5 + 0.2 * z, w = -0.2 * x; /* world */
        check_close("velocity along", body.velocity[0], u * cos(angle) - w * sin(angle), 1e-11);
        check_close("velocity across", body.velocity[2], u * sin(angle) + w * cos(angle), 1e-11);
        check_close("rate", body.velocity[4], 0.2, 1e-15);
        assert_int_equal(section.follows_hole, hole);
        assert_int_equal(section.start_free, DMB_FREE_ALL);
        if (hole) check_close("depth", section.start_depth, reach + 1.0, 1e-12);
        if (!hole) check_close("section", section.position[0], x + cos(angle), 1e-11);
        rig_start(&s, NULL);
        const dmb_pose end = pose_at(&s, dmb_station(pipe.string, 9, 1.0));
        for (int i = 0; i < 3; i++) check_close("compiled", end.position[i], body.position[i], 1e-10);
        rig_close(&s);
    }
}

/* ---- Refusals ---------------------------------------------------------------------------------------------------- */

static void refused(rig *s, const dmb_sub_def *def, int32_t status, const char *says)
{
    dmb_sub made = dmb_sub_default();
    assert_int_equal(dmb_model_add_sub(s->model, def, &made), status);
    assert_int_equal(made.body.index, 0);
    if (strstr(dmb_model_message(s->model), says) == NULL) fail_msg("says: %s", dmb_model_message(s->model));
}

/* The place at the end of a string beside the axis of a straight hole: its origin, its direction times the depth, the
 * offset across. One that a survey bends too sharply for compile is refused here too. */
static void straight_and_broken_holes(void **state)
{
    (void)state;
    static const double broken[3][3] = {{0.0, 0.1, 0.0}, {1.0, 3.1, 0.0}, {2.0, 0.1, 3.0}};
    rig s;
    dmb_wall_def wall = s1_hole();
    dmb_string_def string = dmb_string_def_default(), section = string;
    dmb_body_def body = dmb_body_def_default();
    const double d[3] = {2.0 / 3.0, 2.0 / 3.0, -1.0 / 3.0};
    rig_open(&s, 0.0, 0.0, 0.0);
    for (int i = 0; i < 3; i++) {
        wall.origin[i] = 1.0 + i;
        wall.direction[i] = 3.0 * d[i];
    }
    add_wall(&s, &wall);
    string.start_depth = 4.0;
    dmb_pipe_def pipe = pipe_of(add_string(&s, &string));
    add_pipes(&s, &pipe, 3);
    must_model(&s, dmb_model_place_at_end(s.model, pipe.string, 0.5, &body, &section));
    const double depth = 4.0 + 3.0 * pipe.length + 0.5;
    for (int i = 0; i < 3; i++)
        check_close("end in a straight hole", body.position[i], wall.origin[i] + depth * d[i], 1e-12);
    assert_true(section.start_depth == depth);
    rig_close(&s);
    rig_open(&s, 0.0, 0.0, 0.0);
    wall = s1_hole();
    wall.survey = broken[0];
    wall.survey_count = 3;
    add_wall(&s, &wall);
    pipe.string = add_string(&s, &string);
    add_pipes(&s, &pipe, 3);
    assert_int_equal(dmb_model_place_at_end(s.model, pipe.string, 0.5, &body, &section), DMB_ERR_GEOMETRY);
    assert_non_null(strstr(dmb_model_message(s.model), "turns too much between two stations"));
    assert_true(section.start_depth == depth);
    dmb_model_destroy(&s.model);
}

static void refusals(void **state)
{
    (void)state;
    rig s;
    dmb_sub_def def = dmb_sub_def_default();
    dmb_sub made = dmb_sub_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_wall_def wall = s1_hole();
    rig_open(&s, 0.0, 0.0, 0.0);
    refused(&s, &def, DMB_ERR_ORDER, "0 strings");
    dmb_pipe_def pipe = pipe_of(add_string(&s, &string));
    refused(&s, &def, DMB_ERR_ORDER, "0 pipes");
    add_pipes(&s, &pipe, 2);
    def.length = -1.0;
    refused(&s, &def, DMB_ERR_VALUE, "length = -1");
    def.length = (double)NAN;
    refused(&s, &def, DMB_ERR_NOT_FINITE, "length");
    def.length = 0.1;
    dmb_joint_def joint = dmb_joint_def_default();
    dmb_body_def body = dmb_body_def_default();
    dmb_string_def section = dmb_string_def_default();
    joint.struct_size = body.struct_size = section.struct_size = 3;
    def.section = &section;
    refused(&s, &def, DMB_ERR_STRUCT_SIZE, "");
    def.body = &body;
    refused(&s, &def, DMB_ERR_STRUCT_SIZE, "");
    def.section = NULL;
    def.body = NULL;
    def.before = &joint;
    refused(&s, &def, DMB_ERR_STRUCT_SIZE, "");
    def.before = NULL;
    def.after = &joint;
    refused(&s, &def, DMB_ERR_STRUCT_SIZE, "");
    joint = dmb_joint_def_default();
    joint.kind = 99;
    refused(&s, &def, DMB_ERR_VALUE, "kind = 99");
    must_model(&s, dmb_model_clear_refused(s.model));
    def.after = NULL;
    must_model(&s, dmb_model_add_sub(s.model, &def, &made));
    assert_int_equal(made.body.index & 0xFFFFFF, 0); /* what was refused left nothing behind */
    assert_int_equal(made.after.index & 0xFFFFFF, 1);
    assert_int_equal(dmb_model_add_pipes(s.model, &pipe, 1, NULL), DMB_ERR_ORDER);
    assert_non_null(strstr(dmb_model_message(s.model), "string 0 ends at a sub, must be one that nothing continues"));
    refused(&s, &def, DMB_ERR_ORDER, "take string 1, which continues it");
    dmb_bit_def bit = dmb_bit_def_default();
    bit.string = pipe.string;
    assert_int_equal(dmb_model_add_bit(s.model, &bit, NULL), DMB_ERR_ORDER);
    assert_int_equal(dmb_model_add_wall(s.model, &wall, NULL), DMB_ERR_ORDER);
    assert_non_null(strstr(dmb_model_message(s.model), "add the wall first"));
    string.end_free = DMB_FREE_NONE;
    pipe.string = def.string = add_string(&s, &string);
    add_pipes(&s, &pipe, 1);
    refused(&s, &def, DMB_ERR_VALUE, "end_free of string 2");
    string.end_free = DMB_FREE_ALL;
    bit.string = pipe.string = def.string = add_string(&s, &string);
    add_pipes(&s, &pipe, 1);
    must_model(&s, dmb_model_add_bit(s.model, &bit, NULL));
    refused(&s, &def, DMB_ERR_ORDER, "string 3 ends with bit 0, must end with a pipe");
    assert_int_equal(dmb_model_place_at_end(s.model, pipe.string, 0.0, NULL, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_model_add_sub(s.model, NULL, &made), DMB_ERR_NULL);
    assert_int_equal(dmb_model_compile(s.model, NULL), DMB_ERR_ORDER); /* what was refused is missing */
    assert_non_null(strstr(dmb_model_message(s.model), "refused parts missing"));
    dmb_model_destroy(&s.model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(as_typed_by_hand),
        cmocka_unit_test(as_not_interrupted),
        cmocka_unit_test(at_rest),
        cmocka_unit_test(taken_over),
        cmocka_unit_test(by_its_mass),
        cmocka_unit_test(several_in_a_hole),
        cmocka_unit_test(along_arcs),
        cmocka_unit_test(refusals),
        cmocka_unit_test(straight_and_broken_holes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
