/* The advice of failed statics against the result of following it: elements for a pulled, very flexible string on a
 * stiff wall; the limit of a controlled drive; which way a string may go. */
#include "sim_test.h"

static void expect(const dmb_sim *sim, const char *text)
{
    if (strstr(dmb_sim_message(sim), text) == NULL) fail_msg("\"%s\" without \"%s\"", dmb_sim_message(sim), text);
}

/* EI 1e3 N m2, 50 um of clearance, wall 1e9 N/m2, 20 kN round a bend of R 300 m, 100 m long. */
static dmb_sim *pulled(uint32_t pipes, uint32_t elements, dmb_model **model)
{
    static double survey[12][3];
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_load_def pull = dmb_load_def_default();
    dmb_sim *sim;
    for (int i = 0; i < 12; i++) {
        survey[i][0] = 10.0 * i;
        survey[i][1] = 1.5707963267948966;
        survey[i][2] = 10.0 * i / 300.0;
    }
    must(dmb_model_create(NULL, model));
    wall.survey = &survey[0][0];
    wall.survey_count = 12;
    wall.diameter = pipe.outer_diameter + 1e-4;
    wall.stiffness = 1e9;
    must(dmb_model_add_wall(*model, &wall, NULL));
    string.start_free = DMB_FREE_NONE;
    must(dmb_model_add_string(*model, &string, &pipe.string));
    pipe.length = 100.0 / pipes;
    pipe.elements = elements;
    pipe.section_stiffness[4] = pipe.section_stiffness[5] = 1e3;
    must(dmb_model_add_pipes(*model, &pipe, pipes, NULL));
    pull.frame = DMB_FRAME_BODY;
    pull.place = dmb_station(pipe.string, pipes - 1, 1.0);
    pull.force[0] = 2e4;
    must(dmb_model_add_load(*model, &pull, NULL));
    must(dmb_model_compile(*model, NULL));
    assert_true(dmb_sim_create(*model, NULL, &sim) >= 0);
    return sim;
}

static void elements_for_a_pulled_string(void **state)
{
    dmb_model *model;
    dmb_static_options options = dmb_static_options_default();
    dmb_sim *sim = pulled(10, 1, &model);
    (void)state;
    const uint64_t before = hash_of(sim);
    options.max_iterations = 2;
    assert_int_equal(dmb_analysis_static(sim, &options, NULL), DMB_ERR_NO_CONVERGENCE);
    expect(sim, "string 0 is pulled by T = 20000 N round a bend");
    expect(sim, "sqrt(EI/T) = 0.223607 m take elements of 0.894427 m, not 10 m");
    assert_int_equal(hash_of(sim), before);
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
}

/* A turning string of 200 m that its own weight presses into a wall of 1e10 N/m2 by nanometres, 5 mm of clearance. */
static void wall_that_is_stiff(void **state)
{
    dmb_model *model;
    dmb_sim *sim;
    dmb_static_options options = dmb_static_options_default();
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    (void)state;
    for (int soft = 0; soft < 3; soft++) { /* then with a controller that gives all it may, which is told first */
        dmb_drive_def turn = dmb_drive_def_default();
        dmb_joint_def spring = dmb_joint_def_default();
        dmb_segment term = dmb_segment_default();
        must(dmb_model_create(NULL, &model));
        wall.diameter = pipe.outer_diameter + 0.01;
        wall.stiffness = soft == 1 ? 1e6 : 1e10;
        must(dmb_model_add_wall(model, &wall, NULL));
        dmb_string_def string = dmb_string_def_default();
        string.start_free = soft == 2 ? DMB_FREE_RX : DMB_FREE_NONE;
        must(dmb_model_add_string(model, &string, &pipe.string));
        pipe.length = 2.0;
        pipe.elements = 1;
        must(dmb_model_add_pipes(model, &pipe, 100, NULL));
        term.h0 = 1.0;
        must(dmb_model_add_time_function(model, &term, 1, &turn.time_function));
        turn.kind = DMB_DRIVE_CONTROL;
        turn.component = DMB_RX;
        turn.gain = 100.0;
        turn.limit_high = 2.0;
        spring.kind = DMB_JOINT_FREE;
        spring.place_b = dmb_station(pipe.string, 0, 0.0);
        spring.stiffness[DMB_RX] = 1e3;
        if (soft == 2) {
            must(dmb_model_add_drive(model, &turn, NULL));
            must(dmb_model_add_joint(model, &spring, NULL));
        }
        must(dmb_model_compile(model, NULL));
        assert_true(dmb_sim_create(model, NULL, &sim) >= 0);
        options.slip_rotation = 10.0;
        options.max_iterations = 1;
        assert_int_equal(dmb_analysis_static(sim, &options, NULL), DMB_ERR_NO_CONVERGENCE);
        if (soft == 2) {
            expect(sim, "drive 0 is at its limit_high = 2: widen it");
        } else if (soft) {
            expect(sim, "more load_steps");
        } else {
            expect(sim, "the wall is stiff: the weight presses it in by");
            expect(sim, "the clearance is 0.005 m: elements of 0.5 m, not 2 m, or a stiffness of");
        }
        dmb_sim_destroy(&sim);
        dmb_model_destroy(&model);
    }
}

/* 20 N of weight and a controller that asks for 100 N/(m/s) of 0.1 m/s, with limits of 50 N and 5 N; downwards too. */
static void limit_of_a_drive(void **state)
{
    (void)state;
    for (int weak = 0; weak < 3; weak++) {
        dmb_model *model;
        dmb_sim *sim;
        dmb_body_def body = dmb_body_def_default();
        dmb_drive_def drive = dmb_drive_def_default();
        dmb_segment term = dmb_segment_default();
        must(dmb_model_create(NULL, &model));
        body.mass = 2.0;
        body.free_mask = DMB_FREE_Z;
        must(dmb_model_add_body(model, &body, &drive.part));
        term.h0 = weak == 2 ? -0.1 : 0.1;
        must(dmb_model_add_time_function(model, &term, 1, &drive.time_function));
        strcpy(drive.name, "winch");
        drive.kind = DMB_DRIVE_CONTROL;
        drive.component = DMB_Z;
        drive.gain = 100.0;
        drive.integral_gain = 1e4;
        drive.limit_high = weak ? 5.0 : 50.0;
        drive.limit_low = -drive.limit_high;
        must(dmb_model_add_drive(model, &drive, NULL));
        must(dmb_model_compile(model, NULL));
        assert_true(dmb_sim_create(model, NULL, &sim) >= 0);
        const int32_t status = dmb_analysis_static(sim, NULL, NULL);
        assert_true(status < 0);
        expect(sim, weak == 0   ? "drive 0 (winch) is a controller: at rest it gives 10 and holds nothing"
                    : weak == 1 ? "drive 0 (winch) is at its limit_high = 5: widen it"
                                : "drive 0 (winch) is at its limit_low = -5: widen it");
        dmb_sim_destroy(&sim);
        dmb_model_destroy(&model);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(elements_for_a_pulled_string),
                                       cmocka_unit_test(wall_that_is_stiff), cmocka_unit_test(limit_of_a_drive)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
