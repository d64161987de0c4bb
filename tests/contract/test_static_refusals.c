/* The static start refuses bad arguments, and refusing changes nothing. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "drillmbd/drillmbd.h"
#include "hash.h"

typedef struct scene {
    dmb_model *model;
    dmb_sim *sim;
    dmb_id string;
} scene;

/* Ten pipes without a wall or gravity, rig end free in `free_mask`, turned by a constant torque. */
static scene turned_string(int32_t free_mask)
{
    scene s = {NULL, NULL, {0, 0}};
    dmb_environment_def nowhere = dmb_environment_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_segment torque = dmb_segment_default();
    nowhere.gravity[2] = 0.0;
    string.start_free = free_mask;
    torque.h0 = 100.0;
    drive.kind = DMB_DRIVE_LOAD;
    drive.component = DMB_RX;
    assert_int_equal(dmb_model_create(NULL, &s.model), DMB_OK);
    assert_int_equal(dmb_model_set_environment(s.model, &nowhere), DMB_OK);
    assert_int_equal(dmb_model_add_string(s.model, &string, &s.string), DMB_OK);
    assert_int_equal(dmb_model_add_pipes(s.model, &pipe, 10, NULL), DMB_OK);
    assert_int_equal(dmb_model_add_time_function(s.model, &torque, 1, &drive.time_function), DMB_OK);
    if (free_mask & DMB_FREE_RX) assert_int_equal(dmb_model_add_drive(s.model, &drive, NULL), DMB_OK);
    assert_int_equal(dmb_model_compile(s.model, NULL), DMB_OK);
    assert_int_equal(dmb_sim_create(s.model, NULL, &s.sim), DMB_OK);
    return s;
}

static void end(scene *s)
{
    dmb_sim_destroy(&s->sim);
    dmb_model_destroy(&s->model);
}

static void part_that_nothing_holds_is_named(void **state)
{
    (void)state;
    scene s = turned_string(DMB_FREE_RX);
    const uint64_t before = hash_of(s.sim);
    assert_int_equal(dmb_analysis_static(s.sim, NULL, NULL), DMB_ERR_SINGULAR);
    assert_non_null(strstr(dmb_sim_message(s.sim), "string 0"));
    assert_true(hash_of(s.sim) == before);
    end(&s);
}

static void held_string_is_found(void **state)
{
    (void)state;
    scene s = turned_string(DMB_FREE_NONE);
    dmb_static_report report = dmb_static_report_default();
    assert_int_equal(dmb_analysis_static(s.sim, NULL, &report), DMB_OK);
    assert_int_equal(report.method, DMB_STATIC_NEWTON);
    end(&s);
}

static void expect_refusal(dmb_sim *sim, const dmb_static_options *options, int32_t status, const char *field)
{
    const uint64_t before = hash_of(sim);
    assert_int_equal(dmb_analysis_static(sim, options, NULL), status);
    assert_non_null(strstr(dmb_sim_message(sim), field));
    assert_true(hash_of(sim) == before);
}

static void options_out_of_bounds_are_named(void **state)
{
    (void)state;
    scene s = turned_string(DMB_FREE_NONE);
    dmb_static_options options = dmb_static_options_default();
    options.tolerance = -1.0;
    expect_refusal(s.sim, &options, DMB_ERR_VALUE, "tolerance");
    options = dmb_static_options_default();
    memset(&options.slip_axial, 0xff, sizeof options.slip_axial); /* NaN on every compiler */
    expect_refusal(s.sim, &options, DMB_ERR_NOT_FINITE, "slip_axial");
    options = dmb_static_options_default();
    options.load_steps = 10001;
    expect_refusal(s.sim, &options, DMB_ERR_VALUE, "load_steps");
    options = dmb_static_options_default();
    options.lay_on_wall = 7;
    expect_refusal(s.sim, &options, DMB_ERR_VALUE, "lay_on_wall");
    options.struct_size = 4;
    expect_refusal(s.sim, &options, DMB_ERR_STRUCT_SIZE, "struct_size");
    assert_int_equal(dmb_analysis_static(NULL, NULL, NULL), DMB_ERR_NULL);
    end(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(part_that_nothing_holds_is_named),
        cmocka_unit_test(held_string_is_found),
        cmocka_unit_test(options_out_of_bounds_are_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
