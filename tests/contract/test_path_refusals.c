/* A path refuses bad arguments, leaves the sim as it was, and tells the memory it needs. */
#include <stdlib.h>
#include <string.h>

#include "purse.h"
#include "pushed_column.h"

static pushed_column make(int32_t start_free, double push, const dmb_allocator *allocator)
{
    const column_choice choice = {start_free, push, 0.1 * push, 0.0, allocator};
    return column_open(&choice);
}

static void refused(const pushed_column *c, const dmb_path_options *options, int32_t status, const char *says)
{
    const uint64_t before = rig_hash(&c->s);
    dmb_path_report report = dmb_path_report_default(), same = report;
    assert_int_equal(dmb_analysis_path(c->s.sim, options, &report), status);
    assert_memory_equal(&report, &same, sizeof report);
    must_say(&c->s, says);
    assert_true(rig_hash(&c->s) == before);
}

static void states_without_a_path(void **state)
{
    (void)state;
    pushed_column c = make(DMB_FREE_NONE, 100.0, NULL);
    refused(&c, NULL, DMB_ERR_ORDER, "no equilibrium");
    column_close(&c);
    c = make(DMB_FREE_RX, 0.0, NULL);
    dmb_path_options options = dmb_path_options_default();
    options.scale = DMB_SCALE_PART;
    options.part = c.load;
    refused(&c, &options, DMB_ERR_SINGULAR, "string 0");
    column_close(&c);
    c = make(DMB_FREE_NONE, 0.0, NULL);
    refused(&c, &options, DMB_ERR_ID, "part"); /* the id of another model */
    options.part = c.load;
    refused(&c, &options, DMB_ERR_SINGULAR, "moves nothing");
    column_close(&c);
}

/* A body that nothing holds, beside the column. */
static void body_that_is_free(void **state)
{
    (void)state;
    pushed_column c = column_beside_a_free_body();
    dmb_path_options options = dmb_path_options_default();
    options.scale = DMB_SCALE_PART;
    options.part = c.load;
    refused(&c, &options, DMB_ERR_SINGULAR, "body 0");
    column_close(&c);
}

static void options_out_of_bounds(void **state)
{
    (void)state;
    pushed_column c = make(DMB_FREE_NONE, 100.0, NULL);
    assert_int_equal(dmb_analysis_static(c.s.sim, NULL, NULL), DMB_OK);
    const struct {
        const char *field;
        size_t offset;
        double value;
    } numbers[] = {{"factor_end", offsetof(dmb_path_options, factor_end), 0.0},
                   {"factor_end", offsetof(dmb_path_options, factor_end), 1e31},
                   {"displacement_end", offsetof(dmb_path_options, displacement_end), -1e31},
                   {"first_step", offsetof(dmb_path_options, first_step), -1.0},
                   {"step_max", offsetof(dmb_path_options, step_max), 0.0},
                   {"branch_size", offsetof(dmb_path_options, branch_size), -1.0},
                   {"tolerance", offsetof(dmb_path_options, tolerance), 0.0},
                   {"slip_axial", offsetof(dmb_path_options, slip_axial), 1e7},
                   {"slip_rotation", offsetof(dmb_path_options, slip_rotation), -1e7}};
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
        dmb_path_options options = dmb_path_options_default();
        memcpy((char *)&options + numbers[i].offset, &numbers[i].value, sizeof(double));
        refused(&c, &options, DMB_ERR_VALUE, numbers[i].field);
    }
    const struct {
        const char *field;
        size_t offset;
        int32_t value;
    } counts[] = {{"max_points", offsetof(dmb_path_options, max_points), 0},
                  {"max_iterations", offsetof(dmb_path_options, max_iterations), 1},
                  {"scale", offsetof(dmb_path_options, scale), -1},
                  {"component", offsetof(dmb_path_options, component), 3},
                  {"branch", offsetof(dmb_path_options, branch), 2}};
    for (size_t i = 0; i < sizeof counts / sizeof counts[0]; i++) {
        dmb_path_options options = dmb_path_options_default();
        memcpy((char *)&options + counts[i].offset, &counts[i].value, sizeof(int32_t));
        refused(&c, &options, DMB_ERR_VALUE, counts[i].field);
    }
    dmb_path_options options = dmb_path_options_default();
    options.place = dmb_station(c.string, 10, 0.0);
    refused(&c, &options, DMB_ERR_VALUE, "place");
    options = dmb_path_options_default();
    options.scale = DMB_SCALE_PART;
    refused(&c, &options, DMB_ERR_ID, "part");
    options.struct_size = 8;
    refused(&c, &options, DMB_ERR_STRUCT_SIZE, "struct_size");
    assert_int_equal(dmb_analysis_path(NULL, NULL, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_analysis_path((dmb_sim *)(void *)c.s.model, NULL, NULL), DMB_ERR_HANDLE);
    column_close(&c);
}

/* ---- Stopping, and going on from a point ------------------------------------------------------------------------- */

typedef struct saved {
    const pushed_column *c;
    void *snapshot;
    size_t size;
    double tip;
} saved;

static int32_t save_third(void *context, const dmb_sim *at, const dmb_path_point *point)
{
    saved *s = context;
    dmb_pose pose = dmb_pose_default();
    if (point->number < 3) return 0;
    assert_int_equal(dmb_sim_snapshot_size(at, &s->size), DMB_OK);
    s->snapshot = malloc(s->size);
    assert_int_equal(dmb_sim_snapshot(at, s->snapshot, s->size), DMB_OK);
    assert_int_equal(dmb_query_pose(at, dmb_station(s->c->string, 9, 1.0), &pose), DMB_OK);
    s->tip = pose.displacement[1];
    return 1;
}

static void stopped_and_gone_on_from(void **state)
{
    (void)state;
    pushed_column c = make(DMB_FREE_NONE, 100.0, NULL);
    saved s = {&c, NULL, 0, 0.0};
    dmb_pose pose = dmb_pose_default();
    dmb_path_options options = dmb_path_options_default();
    dmb_path_report report = dmb_path_report_default();
    assert_int_equal(dmb_analysis_static(c.s.sim, NULL, NULL), DMB_OK);
    options.factor_end = 10.0;
    options.callback = save_third;
    options.callback_context = &s;
    assert_int_equal(dmb_analysis_path(c.s.sim, &options, &report), DMB_NOTE_STOPPED);
    assert_int_equal(report.points, 3);
    assert_int_equal(dmb_sim_restore(c.s.sim, s.snapshot, s.size), DMB_OK);
    assert_int_equal(dmb_query_pose(c.s.sim, dmb_station(c.string, 9, 1.0), &pose), DMB_OK);
    assert_true(pose.displacement[1] == s.tip);
    options.callback = NULL;
    options.max_points = 2;
    assert_int_equal(dmb_analysis_static(c.s.sim, NULL, NULL), DMB_OK);
    assert_int_equal(dmb_analysis_path(c.s.sim, &options, &report), DMB_NOTE_STOPPED);
    assert_int_equal(report.points, 2);
    free(s.snapshot);
    column_close(&c);
}

/* ---- Memory that is not there ------------------------------------------------------------------------------------ */

static void every_allocation_may_fail(void **state)
{
    (void)state;
    purse p = {1000, 0};
    const dmb_allocator allocator = purse_allocator(&p);
    pushed_column c = make(DMB_FREE_NONE, 100.0, &allocator);
    assert_int_equal(dmb_analysis_static(c.s.sim, NULL, NULL), DMB_OK);
    const uint64_t before = rig_hash(&c.s);
    const int held = p.held;
    int failures = 0;
    for (int n = 0; n < 100; n++, failures++) {
        p.left = n;
        const int32_t status = dmb_analysis_path(c.s.sim, NULL, NULL);
        assert_int_equal(p.held, held);
        assert_true(rig_hash(&c.s) == before);
        if (status == DMB_OK) break;
        assert_int_equal(status, DMB_ERR_NO_MEMORY);
    }
    assert_int_equal(failures, 14); /* path, and signs of the stiffness of each point */
    column_close(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(states_without_a_path),     cmocka_unit_test(body_that_is_free),
        cmocka_unit_test(options_out_of_bounds),     cmocka_unit_test(stopped_and_gone_on_from),
        cmocka_unit_test(every_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
