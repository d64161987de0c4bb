/* A host that traps floating-point exceptions (feenableexcept, -ffpe-trap, Delphi) is not ended by a call with ordinary
 * values: scenes with and without joints, statics, steps, analyses, queries. Its traps stay on. Not for clang, which by
 * default computes ahead of conditions what they exclude (-ffp-exception-behavior=ignore). */
#define _GNU_SOURCE 1 /* feenableexcept */
#include <fenv.h>

#include "asked_analyses.h"
#include "joint_scene.h"
#include "whole_scene.h"

#if defined(__GLIBC__) && !defined(__clang__)

enum { TRAPS = FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW };

/* Processors without traps (most of ARM) leave the test out. */
static void trap(void)
{
    (void)feclearexcept(FE_ALL_EXCEPT);
    if (feenableexcept(TRAPS) < 0) skip();
}

static void release(void)
{
    assert_int_equal(fegetexcept() & TRAPS, TRAPS);
    (void)fedisableexcept(TRAPS);
    assert_int_equal(fetestexcept(TRAPS), 0);
}

/* A string that lies in its hole, guided or clamped, and is pushed; without a yield strength. */
static void open_string(rig *s, asked_of *asked, int32_t support, uint32_t pipes, double force)
{
    const dmb_wall_def hole = s1_hole();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    dmb_load_def push = dmb_load_def_default();
    rig_open(s, 0.0, 0.0, -9.81);
    (void)add_wall(s, &hole);
    string.start_free = support;
    pipe.string = add_string(s, &string);
    pipe.damping_time = 1e-4;
    (void)add_pipes(s, &pipe, pipes);
    if (support == DMB_FREE_ALL) {
        (void)add_simple_drive(s, DMB_DRIVE_MOTION, pipe.string, DMB_X, add_constant(s, 0.0));
        (void)add_simple_drive(s, DMB_DRIVE_MOTION, pipe.string, DMB_RX, add_constant(s, 0.0));
    }
    push.place = dmb_station(pipe.string, pipes - 1, 1.0);
    push.force[0] = -force;
    if (force > 0.0) (void)add_load(s, &push);
    (void)rig_start(s, NULL);
    *asked = (asked_of){s->sim, dmb_station(pipe.string, pipes / 2, 0.5), DMB_Y, 5, 3.0, 10.0};
}

static int32_t ask_torque_and_drag(const asked_of *a)
{
    dmb_operation operation = dmb_operation_default();
    dmb_torque_drag_options options = dmb_torque_drag_options_default();
    dmb_torque_drag_row row = dmb_torque_drag_row_default();
    operation.rotary_speed = 10.0;
    operation.weight_on_bit = 1e3;
    return dmb_analysis_torque_drag(a->sim, &options, &operation, 1, &row);
}

static int32_t ask_steps(const asked_of *a)
{
    return dmb_sim_steps(a->sim, 1e-3, 50, NULL, NULL);
}

static int32_t ask_advance(const asked_of *a)
{
    return dmb_sim_advance(a->sim, dmb_sim_time(a->sim) + 0.05, NULL);
}

static int32_t ask_slip(const asked_of *a)
{
    dmb_static_options options = dmb_static_options_default();
    options.slip_axial = 0.1;
    options.slip_rotation = 10.0;
    return dmb_analysis_static(a->sim, &options, NULL);
}

static const struct {
    const char *name;
    int32_t (*ask)(const asked_of *a);
} questions[] = {
    {"statics", ask_statics},
    {"statics, laid on the wall", ask_statics_laid},
    {"statics in steps", ask_statics_in_steps},
    {"statics with a slip", ask_slip},
    {"statics again", ask_statics},
    {"check", ask_check_model},
    {"check as text", ask_check_as_text},
    {"buckling", ask_buckling},
    {"buckling, followed", ask_followed_buckling},
    {"path", ask_path},
    {"lowest modes", ask_lowest_modes},
    {"all modes", ask_all_modes},
    {"modes of a band", ask_modes_of_a_band},
    {"damped modes", ask_damped_modes},
    {"all damped modes", ask_all_damped_modes},
    {"response", ask_response},
    {"speeds", ask_speeds},
    {"state space", ask_state_space},
    {"reduced state space", ask_reduced_state_space},
    {"torque and drag", ask_torque_and_drag},
    {"stepped sine", ask_stepped_sine},
    {"steps", ask_steps},
    {"advance", ask_advance},
};

/* A SIGFPE fails the test. A question may be refused. */
static void ask_all(const asked_of *asked)
{
    for (size_t i = 0; i < sizeof questions / sizeof questions[0]; i++) {
        trap();
        const int32_t status = questions[i].ask(asked);
        release();
        print_message("    %s: %s\n", questions[i].name, dmb_status_name(status));
        assert_true(status != DMB_ERR_NOT_FINITE);
    }
}

static void strings_in_holes(void **state)
{
    static const int32_t supports[2] = {DMB_FREE_NONE, DMB_FREE_ALL};
    (void)state;
    for (int i = 0; i < 3; i++) {
        rig s;
        asked_of asked;
        trap();
        open_string(&s, &asked, supports[i % 2], i < 2 ? 4 : 10, i < 2 ? 100.0 : 0.0);
        release();
        ask_all(&asked);
        rig_close(&s);
    }
}

/* Steps, then all queries. */
static void every_part(void **state)
{
    whole_parts parts;
    whole_answers answers;
    (void)state;
    trap();
    dmb_model *model = whole_model(&parts);
    dmb_sim *sim = whole_sim(model, NULL);
    whole_run(sim, 30, 1e-3);
    whole_answers_init(&answers, &parts);
    assert_int_equal(whole_ask(sim, &parts, &answers), DMB_OK);
    release();
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
}

static void every_joint(void **state)
{
    static joint_scene scene;
    (void)state;
    trap();
    joint_scene_open(&scene, NULL);
    must_model(&scene.s, dmb_sim_create(scene.s.model, NULL, &scene.s.sim));
    for (int i = 0; i < 30; i++) must(&scene.s, dmb_sim_step(scene.s.sim, 1e-3, NULL));
    must(&scene.s, dmb_sim_set_joint(scene.s.sim, scene.elbow, DMB_JOINT_OPEN));
    must(&scene.s, dmb_sim_steps(scene.s.sim, 1e-3, 10, NULL, NULL));
    release();
    rig_close(&scene.s);
}

/* A value of NaN is in the interface: the drive follows its time function again. */
static void drives_follow_again(void **state)
{
    rig s;
    (void)state;
    trap();
    rig_open(&s, 0.0, 0.0, -9.81);
    dmb_body_def body = dmb_body_def_default();
    body.mass = 1.0;
    body.free_mask = DMB_FREE_X;
    const dmb_id drive = add_simple_drive(&s, DMB_DRIVE_LOAD, add_body(&s, &body), DMB_X, add_constant(&s, 2.0));
    (void)rig_start(&s, NULL);
    must(&s, dmb_sim_set_drive(s.sim, drive, 1.0));
    must(&s, dmb_sim_steps(s.sim, 1e-3, 10, NULL, NULL));
    must(&s, dmb_sim_set_drive(s.sim, drive, (double)NAN));
    must(&s, dmb_sim_steps(s.sim, 1e-3, 10, NULL, NULL));
    release();
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(strings_in_holes), cmocka_unit_test(every_part),
                                       cmocka_unit_test(every_joint), cmocka_unit_test(drives_follow_again)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#else
int main(void)
{
    return 0;
}
#endif
