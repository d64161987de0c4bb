/* Statics leave what a support holds where it is described, whatever they lay on the wall, roll round it or pull into a
 * bend on the way: for every support there is, at rest, slipping and in motion, along the hole and across it. */
#include "sim_test.h"

enum { PIPES = 4 };
enum { AT_REST, SLIDING, TURNING, BOTH, FED, KINDS };

static const int32_t supports[] = {
    DMB_FREE_NONE,
    DMB_FREE_X,
    DMB_FREE_Y,
    DMB_FREE_Z,
    DMB_FREE_RX,
    DMB_FREE_RY,
    DMB_FREE_RZ,
    DMB_FREE_CYLINDRICAL,
    DMB_FREE_SPHERICAL,
    DMB_FREE_ALL,
    DMB_FREE_XY,
    DMB_FREE_XZ,
    DMB_FREE_YZ,
    DMB_FREE_TRANSLATIONS,
    DMB_FREE_CYLINDRICAL_Y,
    DMB_FREE_CYLINDRICAL_Z,
    DMB_FREE_PLANAR,
    DMB_FREE_PLANAR_Y,
    DMB_FREE_PLANAR_Z,
    DMB_FREE_SCHOENFLIES,
    DMB_FREE_SCHOENFLIES_Y,
    DMB_FREE_SCHOENFLIES_Z,
};

static void describe_hole(dmb_model *model)
{
    static const double survey[12] = {0.0, 1.2, 0.0, 2.0, 1.3, 0.1, 4.0, 1.5, 0.2, 9.0, 1.6, 0.2};
    dmb_wall_def wall = dmb_wall_def_default();
    wall.survey = survey;
    wall.survey_count = 4;
    must(dmb_model_add_wall(model, &wall, NULL));
}

/* A string that is guided at its rig end, along the hole or a little askew in it, held along by a spring where the
 * support does not. */
static dmb_id describe_string(dmb_model *model, int32_t support, int askew)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_spring_def spring = dmb_spring_def_default();
    string.start_free = support;
    string.offset[1] = -1e-3;
    if (askew) {
        string.follows_hole = 0;
        string.rotation[1] = 0.375; /* the hole begins at 0.371 below the horizontal */
    }
    must(dmb_model_add_string(model, &string, &pipe.string));
    must(dmb_model_add_pipes(model, &pipe, PIPES, NULL));
    spring.place_a = dmb_station(pipe.string, 0, 0.5);
    spring.offset_b[0] = -3.0;
    spring.stiffness = 1e5;
    if (support & DMB_FREE_X) must(dmb_model_add_spring(model, &spring, NULL));
    return pipe.string;
}

/* A motion drive along the string, where its rig end is free to be fed. */
static void describe_feed(dmb_model *model, dmb_id string, int32_t support)
{
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_segment term = dmb_segment_default();
    if ((support & DMB_FREE_X) == 0) return;
    term.h0 = 0.01;
    must(dmb_model_add_time_function(model, &term, 1, &drive.time_function));
    drive.part = string;
    must(dmb_model_add_drive(model, &drive, NULL));
}

/* The rig end's way and turn, in the axes that it is described in, where the support holds them. */
static void check_constrained(const dmb_sim *sim, dmb_id string, const dmb_pose *before, int32_t held)
{
    dmb_pose pose = dmb_pose_default();
    must(dmb_query_pose(sim, dmb_station(string, 0, 0.0), &pose));
    for (int c = 0; c < 3; c++) {
        double way = 0.0, turn = 0.0;
        for (int i = 0; i < 3; i++) {
            const int a = (c + 1) % 3, b = (c + 2) % 3;
            way += before->rotation[3 * i + c] * (pose.position[i] - before->position[i]);
            turn += 0.5 * (before->rotation[3 * i + b] * pose.rotation[3 * i + a] -
                           before->rotation[3 * i + a] * pose.rotation[3 * i + b]);
        }
        if (held & DMB_FREE_X << c) assert_true(fabs(way) <= 1e-13);
        if (held & DMB_FREE_RX << c) assert_true(fabs(turn) <= 1e-13);
    }
}

static int run(int32_t support, int askew, int kind)
{
    dmb_model *model;
    dmb_sim *sim = NULL;
    dmb_pose before = dmb_pose_default();
    dmb_static_options options = dmb_static_options_default();
    must(dmb_model_create(NULL, &model));
    describe_hole(model);
    const dmb_id string = describe_string(model, support, askew);
    if (kind == FED) describe_feed(model, string, support);
    must(dmb_model_compile(model, NULL));
    assert_true(dmb_sim_create(model, NULL, &sim) >= 0); /* a feed begins with its speed, which may be projected */
    must(dmb_query_pose(sim, dmb_station(string, 0, 0.0), &before));
    options.slip_axial = kind == SLIDING || kind == BOTH ? -0.1 : 0.0;
    options.slip_rotation = kind == TURNING || kind == BOTH ? 10.0 : 0.0;
    const int32_t status = dmb_analysis_static(sim, &options, NULL);
    if (status >= 0) check_constrained(sim, string, &before, ~support);
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
    return status >= 0;
}

static void what_supports_hold_stays(void **state)
{
    const int count = (int)(sizeof supports / sizeof supports[0]);
    (void)state;
    for (int askew = 0; askew < 2; askew++)
        for (int kind = 0; kind < KINDS; kind++) {
            int found = 0;
            for (int i = 0; i < count; i++) found += run(supports[i], askew, kind);
            assert_true(found >= 16); /* others begin out of reach of equilibrium, or slide beside their support */
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(what_supports_hold_stays)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
