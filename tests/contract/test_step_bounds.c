/* Work that is bounded: a bound on the steps of one advance, and steps too long for the tolerance, are told and leave a
 * state to go on from. */
#include "whole_scene.h"

static const double end = 0.02;

static dmb_sim_options loose(void)
{
    dmb_sim_options options = dmb_sim_options_default();
    options.tolerance_translation = 1e-4;
    options.tolerance_rotation = 1e-3;
    return options;
}

/* In pieces of a few steps the run is the same, bit for bit. */
static void advance_in_pieces_is_the_same(void **state)
{
    whole_parts parts;
    dmb_model *model = whole_model(&parts);
    dmb_sim_options options = loose();
    dmb_sim *whole = whole_sim(model, &options), *pieces;
    dmb_step_report report = dmb_step_report_default();
    int32_t status = DMB_NOTE_STOPPED;
    (void)state;
    options.max_steps = 7;
    pieces = whole_sim(model, &options);
    assert_true(dmb_sim_advance(whole, end, NULL) >= 0);
    while (status == DMB_NOTE_STOPPED) {
        const double before = dmb_sim_time(pieces);
        status = dmb_sim_advance(pieces, end, &report);
        assert_true(report.steps <= 7);
        assert_true(dmb_sim_time(pieces) > before);
        if (status == DMB_NOTE_STOPPED) assert_int_equal(report.steps, 7);
        if (status == DMB_NOTE_STOPPED) assert_true(dmb_sim_message(pieces)[0] != '\0');
    }
    assert_true(status >= 0 && dmb_sim_time(pieces) == end);
    assert_true(whole_hash(pieces) == whole_hash(whole));
    dmb_sim_destroy(&whole);
    dmb_sim_destroy(&pieces);
    dmb_model_destroy(&model);
}

/* The bound is one on accepted steps: it is reached exactly, and not passed by arriving with the last one. */
static void bound_is_exact(void **state)
{
    whole_parts parts;
    dmb_model *model = whole_model(&parts);
    dmb_sim_options options = loose();
    dmb_step_report report = dmb_step_report_default();
    dmb_sim *sim = whole_sim(model, &options);
    (void)state;
    assert_true(dmb_sim_advance(sim, 0.002, &report) >= 0);
    const uint32_t needed = report.steps;
    dmb_sim_destroy(&sim);
    options.max_steps = needed;
    sim = whole_sim(model, &options);
    assert_true(dmb_sim_advance(sim, 0.002, &report) != DMB_NOTE_STOPPED);
    dmb_sim_destroy(&sim);
    options.max_steps = needed - 1;
    sim = whole_sim(model, &options);
    assert_int_equal(dmb_sim_advance(sim, 0.002, &report), needed > 1 ? DMB_NOTE_STOPPED : DMB_OK);
    assert_int_equal(report.steps, needed > 1 ? needed - 1 : 1);
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
}

/* The smallest step is a floor: reached and told. */
static void floor_of_steps_is_told(void **state)
{
    whole_parts parts;
    dmb_model *model = whole_model(&parts);
    dmb_sim_options options = dmb_sim_options_default();
    dmb_step_report report = dmb_step_report_default();
    dmb_sim *sim;
    (void)state;
    options.step_min = 1e-3;
    options.tolerance_translation = options.tolerance_rotation = 1e-12;
    sim = whole_sim(model, &options);
    assert_int_equal(dmb_sim_advance(sim, 0.005, &report), DMB_NOTE_TOLERANCE);
    assert_true(dmb_sim_time(sim) == 0.005);
    assert_true(dmb_sim_message(sim)[0] != '\0');
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
}

/* A step takes at most its iterations, whatever happens; the result is finite. */
static void bounded_work_is_bounded(void **state)
{
    whole_parts parts;
    dmb_model *model = whole_model(&parts);
    dmb_sim_options options = dmb_sim_options_default();
    dmb_step_report report = dmb_step_report_default();
    static whole_answers answers;
    dmb_sim *sim;
    int limited = 0;
    (void)state;
    options.bounded_work = 1;
    options.max_iterations = 2;
    options.newton_tolerance = 1e-12;
    sim = whole_sim(model, &options);
    for (int i = 0; i < 100; i++) {
        const int32_t status = dmb_sim_step(sim, 1e-3, &report);
        assert_true(status == DMB_OK || status == DMB_NOTE_WORK_LIMITED);
        assert_true(report.steps == 1 && report.iterations <= 2);
        limited += status == DMB_NOTE_WORK_LIMITED;
    }
    whole_answers_init(&answers, &parts);
    assert_int_equal(whole_ask(sim, &parts, &answers), DMB_OK);
    assert_true(isfinite(answers.energy.kinetic) && isfinite(answers.pose[4].position[0]));
    assert_true(limited > 0 && answers.statistics.limited_steps == (uint64_t)limited);
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(advance_in_pieces_is_the_same),
        cmocka_unit_test(bound_is_exact),
        cmocka_unit_test(floor_of_steps_is_told),
        cmocka_unit_test(bounded_work_is_bounded),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
