/* Strings whose rotation about their own axis nothing resists: every angle is an equilibrium. Statics keep the starting
 * one and report the rotation as free; the equilibrium is that of a motion drive which holds the rotation. A torque
 * that is balanced by friction does the same; one that is not has no equilibrium. Equations: eq:static.spin. */
#include <string.h>

#include "rig.h"

enum { MOTION, CONTROL, LOAD, NOTHING };

/* A hole that turns, and a string in it. */
typedef struct scene_of {
    double length, inclination, build, turn; /* [m, rad, rad, rad] of the hole */
    double torque;                           /* [N m] at the rig end */
    uint32_t pipes, elements;
    int32_t kind;   /* of the drive of the rotation */
    int32_t joined; /* 0: one string; 1: a sub in its middle */
} scene_of;

typedef struct subject {
    rig s;
    dmb_id string;
} subject;

static void add_hole(rig *s, const scene_of *c)
{
    dmb_wall_def wall = dmb_wall_def_default();
    const double survey[9] = {
        0.0,
        c->inclination,
        0.2,
        0.4 * c->length,
        c->inclination + c->build,
        0.2 + c->turn,
        1.2 * c->length,
        c->inclination + 0.5 * c->build,
        0.2 - c->turn,
    };
    wall.diameter = 0.1;
    wall.mu_dynamic = wall.mu_static = 0.2;
    wall.survey = survey;
    wall.survey_count = 3;
    (void)add_wall(s, &wall);
}

static dmb_body_def collar(void)
{
    dmb_body_def body = dmb_body_def_default();
    body.mass = 30.0;
    body.inertia[0] = 0.05;
    body.inertia[1] = body.inertia[2] = 0.4;
    return body;
}

/* A body `length` long: where the hole bends, it is bent as well, and is no longer round. */
static void add_sub(rig *s, const dmb_pipe_def *pipe, uint32_t count, double length)
{
    dmb_sub_def def = dmb_sub_def_default();
    dmb_sub made = dmb_sub_default();
    const dmb_body_def body = collar();
    dmb_pipe_def second = *pipe;
    def.string = pipe->string;
    def.length = length;
    def.body = &body;
    must_model(s, dmb_model_add_sub(s->model, &def, &made));
    second.string = made.section;
    (void)add_pipes(s, &second, count);
}

static subject make(const scene_of *c)
{
    subject made;
    rig s;
    const dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    rig_open(&s, 0.0, 0.0, -9.81);
    add_hole(&s, c);
    made.string = pipe.string = add_string(&s, &def);
    pipe.length = c->length / c->pipes;
    pipe.elements = c->elements;
    (void)add_pipes(&s, &pipe, c->joined == 1 ? c->pipes / 2 : c->pipes);
    if (c->joined == 1) add_sub(&s, &pipe, c->pipes - c->pipes / 2, c->turn == 0.0 ? 0.4 : 0.0);
    (void)add_simple_drive(&s, DMB_DRIVE_MOTION, made.string, DMB_X, add_constant(&s, 0.0));
    if (c->kind == MOTION) (void)add_simple_drive(&s, DMB_DRIVE_MOTION, made.string, DMB_RX, add_constant(&s, 0.0));
    if (c->kind == LOAD) (void)add_simple_drive(&s, DMB_DRIVE_LOAD, made.string, DMB_RX, add_constant(&s, c->torque));
    if (c->kind == CONTROL) {
        dmb_drive_def drive = dmb_drive_def_default();
        drive.kind = DMB_DRIVE_CONTROL, drive.part = made.string, drive.component = DMB_RX, drive.gain = 100.0;
        drive.time_function = add_constant(&s, c->torque / 100.0);
        (void)add_drive(&s, &drive);
    }
    (void)rig_start(&s, NULL);
    made.s = s;
    return made;
}

static void same_place(const char *name, const subject *a, const subject *b, const scene_of *c, double bound)
{
    for (int i = 0; i < 4; i++) {
        const uint32_t pipes = c->joined == 1 ? c->pipes / 2 : c->pipes;
        const uint32_t pipe = (pipes - 1) * (uint32_t)i / 3;
        const dmb_place at_a = dmb_station(a->string, pipe, 0.5), at_b = dmb_station(b->string, pipe, 0.5);
        const dmb_pose p = pose_at(&a->s, at_a), q = pose_at(&b->s, at_b);
        for (int k = 0; k < 3; k++) check_below(name, fabs(p.position[k] - q.position[k]), bound);
        check_below(name, fabs(rotation_at(&a->s, at_a) - rotation_at(&b->s, at_b)), bound);
    }
}

static void agrees(scene_of c, int32_t kind, double slip)
{
    dmb_static_options options = dmb_static_options_default();
    options.slip_rotation = slip;
    c.kind = MOTION;
    subject driven = make(&c);
    dmb_static_report report = find_equilibrium(&driven.s, &options);
    assert_int_equal(report.free_spins, 0);
    double reaction[6];
    must(&driven.s, dmb_query_reaction(driven.s.sim, driven.string, reaction));
    c.kind = kind;
    c.torque = reaction[3];
    subject s = make(&c);
    report = find_equilibrium(&s.s, &options);
    assert_int_equal(report.free_spins, 1);
    assert_int_equal(report.negative, 0);
    same_place("    apart [m, rad]", &driven, &s, &c, 1e-7);
    check_below("    rotation [rad]", fabs(rotation_at(&s.s, dmb_station(s.string, 0, 0.0))), 1e-7);
    rig_close(&driven.s);
    rig_close(&s.s);
}

static const scene_of scenes[] = {
    {.length = 30.0, .inclination = 1.2, .build = 0.3, .turn = 0.3, .pipes = 10, .elements = 1},
    {.length = 30.0, .inclination = 1.2, .build = 0.3, .turn = 0.3, .pipes = 20, .elements = 1},
    {.length = 30.0, .inclination = 1.2, .build = 0.3, .turn = 0.3, .pipes = 30, .elements = 1},
    {.length = 60.0, .inclination = 0.7, .build = 0.2, .turn = -0.4, .pipes = 20, .elements = 2},
    {.length = 60.0, .inclination = 0.3, .build = 0.5, .turn = 0.2, .pipes = 10, .elements = 4},
    {.length = 40.0, .inclination = 1.5, .build = 0.0, .turn = 0.0, .pipes = 20, .elements = 1},
    {.length = 30.0, .inclination = 1.2, .build = 0.2, .turn = 0.2, .pipes = 20, .elements = 1, .joined = 1},
    {.length = 60.0, .inclination = 0.8, .build = 0.2, .turn = -0.2, .pipes = 20, .elements = 2, .joined = 1},
    {.length = 30.0, .inclination = 1.4, .build = 0.0, .turn = 0.0, .pipes = 10, .elements = 4, .joined = 1},
};

static void free_rotation_is_kept(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++)
        for (int32_t kind = CONTROL; kind <= NOTHING; kind++) {
            print_message("scene %zu, drive %d\n", i, kind);
            agrees(scenes[i], kind, 0.0);
        }
}

static void friction_is_balanced(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++)
        for (int32_t kind = CONTROL; kind <= LOAD; kind++) {
            print_message("scene %zu, drive %d, slip\n", i, kind);
            agrees(scenes[i], kind, 10.0);
        }
}

static void unbalanced_torque_is_refused(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++)
        for (int32_t kind = CONTROL; kind <= LOAD; kind++) {
            scene_of c = scenes[i];
            c.kind = kind;
            c.torque = 25.0;
            subject s = make(&c);
            const uint64_t before = rig_hash(&s.s);
            assert_int_equal(dmb_analysis_static(s.s.sim, NULL, NULL), DMB_ERR_SINGULAR);
            assert_non_null(strstr(dmb_sim_message(s.s.sim), "about its axis"));
            assert_non_null(strstr(dmb_sim_message(s.s.sim), "25 N m"));
            assert_true(rig_hash(&s.s) == before);
            rig_close(&s.s);
        }
}

/* d(displacement, rotation)/d(inclination) along a run that starts there, against differences of whole runs. */
static void runs_have_derivatives(void **state)
{
    (void)state;
    enum { COUNT = 3 };
    const double step = 1.0, bound = 1e-12;
    scene_of c = scenes[0];
    c.kind = CONTROL;
    c.torque = 0.0;
    double rate[COUNT], value[3][COUNT];
    subject side[3];
    for (int k = 0; k < 3; k++) {
        scene_of moved = c;
        moved.inclination += (k - 1) * 1e-6;
        side[k] = make(&moved);
        (void)find_equilibrium(&side[k].s, NULL);
    }
    dmb_parameter parameter = dmb_parameter_default();
    dmb_sensitivity *sensitivity;
    parameter.step = step, parameter.low = side[0].s.sim, parameter.high = side[2].s.sim;
    const dmb_place end = dmb_station(side[1].string, c.pipes - 1, 1.0);
    const dmb_output outputs[COUNT] = {{end, DMB_OUTPUT_DISPLACEMENT_X, 0},
                                       {end, DMB_OUTPUT_DISPLACEMENT_Z, 0},
                                       {dmb_station(side[1].string, 0, 0.0), DMB_OUTPUT_ROTATION, 0}};
    must(&side[1].s, dmb_sensitivity_create(side[1].s.sim, &parameter, 1, &sensitivity));
    for (int i = 0; i < 10; i++) {
        must(&side[1].s, dmb_sensitivity_step(sensitivity, 1e-3, NULL));
        for (int k = 0; k < 3; k += 2) must(&side[k].s, dmb_sim_step(side[k].s.sim, 1e-3, NULL));
    }
    must(&side[1].s, dmb_sensitivity_outputs(sensitivity, outputs, COUNT, NULL, rate));
    for (int k = 0; k < 3; k += 2) {
        dmb_output own[COUNT];
        double row[COUNT + 1];
        dmb_recorder recorder = dmb_recorder_default();
        for (int i = 0; i < COUNT; i++) own[i] = outputs[i], own[i].place.part = side[k].string;
        recorder.outputs = own, recorder.output_count = COUNT, recorder.table = row, recorder.capacity = 1;
        must(&side[k].s, dmb_recorder_take(&recorder, side[k].s.sim));
        memcpy(value[k], row + 1, sizeof value[k]);
    }
    for (int i = 0; i < COUNT; i++) {
        print_message("    %d: %.6g, by runs %.6g\n", i, rate[i], (value[2][i] - value[0][i]) / 2.0 / step);
        check_below("    error [m, rad]", fabs(rate[i] - (value[2][i] - value[0][i]) / 2.0 / step), bound);
    }
    dmb_sensitivity_destroy(&sensitivity);
    for (int k = 0; k < 3; k++) rig_close(&side[k].s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(free_rotation_is_kept),
        cmocka_unit_test(friction_is_balanced),
        cmocka_unit_test(unbalanced_torque_is_refused),
        cmocka_unit_test(runs_have_derivatives),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
