/* A buckling analysis refuses bad arguments and leaves the sim as it was. */
#include <string.h>

#include "purse.h"
#include "pushed_column.h"

static pushed_column make(int32_t start_free, double push, double gravity)
{
    const column_choice choice = {start_free, push, 0.0, gravity, NULL};
    return column_open(&choice);
}

static void refused(const pushed_column *c, const dmb_buckling_options *options, int32_t status, const char *says)
{
    const uint64_t before = rig_hash(&c->s);
    dmb_buckling *found = (dmb_buckling *)(uintptr_t)16;
    assert_int_equal(dmb_analysis_buckling(c->s.sim, options, &found), status);
    assert_null(found);
    must_say(&c->s, says);
    assert_true(rig_hash(&c->s) == before);
}

static void states_that_cannot_buckle(void **state)
{
    (void)state;
    pushed_column c = make(DMB_FREE_NONE, 1.0, 9.81);
    refused(&c, NULL, DMB_ERR_ORDER, "no equilibrium");
    column_close(&c);
    c = make(DMB_FREE_RX, 0.0, 0.0);
    refused(&c, NULL, DMB_ERR_SINGULAR, "string 0");
    column_close(&c);
    c = make(DMB_FREE_NONE, 1e5, 0.0); /* straight, and far above its critical load of 4 kN */
    assert_int_equal(dmb_analysis_static(c.s.sim, NULL, NULL), DMB_NOTE_UNSTABLE);
    must_say(&c.s, "unstable");
    refused(&c, NULL, DMB_ERR_ORDER, "not stable");
    column_close(&c);
}

/* A body that nothing holds, beside the column. */
static void body_that_is_free(void **state)
{
    (void)state;
    pushed_column c = column_beside_a_free_body();
    dmb_buckling_options options = dmb_buckling_options_default();
    options.scale = DMB_SCALE_PART;
    options.part = c.load;
    refused(&c, &options, DMB_ERR_SINGULAR, "body 0");
    column_close(&c);
}

static void options_out_of_bounds(void **state)
{
    (void)state;
    pushed_column c = make(DMB_FREE_NONE, 1.0, 0.0);
    dmb_buckling_options options = dmb_buckling_options_default();
    options.count = 0;
    refused(&c, &options, DMB_ERR_VALUE, "count");
    options = dmb_buckling_options_default();
    options.scale = 3;
    refused(&c, &options, DMB_ERR_VALUE, "scale");
    options = dmb_buckling_options_default();
    options.scale = DMB_SCALE_PART;
    refused(&c, &options, DMB_ERR_ID, "part");
    options.part = c.string;
    refused(&c, &options, DMB_ERR_ID, "part");
    options = dmb_buckling_options_default();
    options.factor_max = 0.0;
    refused(&c, &options, DMB_ERR_VALUE, "factor_max");
    options = dmb_buckling_options_default();
    options.tolerance = 1.0;
    refused(&c, &options, DMB_ERR_VALUE, "tolerance");
    options = dmb_buckling_options_default();
    options.step = -1.0;
    refused(&c, &options, DMB_ERR_VALUE, "step");
    options = dmb_buckling_options_default();
    options.struct_size = 4;
    refused(&c, &options, DMB_ERR_STRUCT_SIZE, "struct_size");
    column_close(&c);
    c = make(DMB_FREE_CYLINDRICAL, 1.0, 0.0);
    options = dmb_buckling_options_default();
    options.scale = DMB_SCALE_PART;
    options.part = c.control;
    refused(&c, &options, DMB_ERR_VALUE, "speed controller");
    column_close(&c);
}

/* Pulled instead of pushed nothing buckles: none found, which is an answer. */
static void nothing_below_the_bound(void **state)
{
    (void)state;
    pushed_column c = make(DMB_FREE_NONE, -1.0, 0.0);
    dmb_buckling *found = NULL;
    assert_int_equal(dmb_analysis_static(c.s.sim, NULL, NULL), DMB_OK);
    dmb_buckling_options options = dmb_buckling_options_default();
    options.factor_max = 1e6;
    assert_int_equal(dmb_analysis_buckling(c.s.sim, &options, &found), DMB_NOTE_STOPPED);
    assert_int_equal(dmb_buckling_count(found), 0);
    double factor = 7.0, shape[6];
    assert_int_equal(dmb_buckling_factor(found, 0, &factor), DMB_ERR_VALUE);
    assert_true(factor == 7.0);
    assert_int_equal(dmb_buckling_shape(found, 0, dmb_station(c.string, 0, 0.0), shape), DMB_ERR_VALUE);
    dmb_buckling_destroy(&found);
    column_close(&c);
}

static void nonsense_handles(void **state)
{
    (void)state;
    pushed_column c = make(DMB_FREE_NONE, 1.0, 0.0);
    dmb_buckling *found = NULL;
    double factor, shape[6];
    assert_int_equal(dmb_analysis_buckling(NULL, NULL, &found), DMB_ERR_NULL);
    assert_int_equal(dmb_analysis_buckling(c.s.sim, NULL, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_analysis_buckling((dmb_sim *)(void *)c.s.model, NULL, &found), DMB_ERR_HANDLE);
    assert_int_equal(dmb_buckling_count(NULL), 0);
    assert_int_equal(dmb_analysis_static(c.s.sim, NULL, NULL), DMB_OK);
    assert_int_equal(dmb_buckling_factor(NULL, 0, &factor), DMB_ERR_NULL);
    assert_int_equal(dmb_analysis_buckling(c.s.sim, NULL, &found), DMB_OK);
    assert_int_equal(dmb_buckling_factor(found, 0, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_buckling_factor((const dmb_buckling *)(const void *)c.s.sim, 0, &factor), DMB_ERR_HANDLE);
    assert_int_equal(dmb_buckling_shape(found, 0, dmb_station(c.load, 0, 0.0), shape), DMB_ERR_ID);
    assert_int_equal(dmb_buckling_shape(found, 0, dmb_station(c.string, 10, 0.0), shape), DMB_ERR_VALUE);
    column_close(&c); /* a result outlives its sim and its model's owner */
    assert_int_equal(dmb_buckling_shape(found, 0, dmb_station(c.string, 9, 1.0), shape), DMB_OK);
    dmb_buckling_destroy(&found);
    dmb_buckling_destroy(&found);
    dmb_buckling_destroy(NULL);
}

/* ---- Memory that is not there ------------------------------------------------------------------------------------ */

static void every_allocation_may_fail(void **state)
{
    (void)state;
    pushed_column c = make(DMB_FREE_NONE, 1.0, 0.0);
    purse p = {1000, 0};
    const dmb_allocator allocator = purse_allocator(&p);
    dmb_sim_options options = dmb_sim_options_default();
    rig own = {c.s.model, NULL};
    dmb_buckling *found = NULL;
    options.allocator = &allocator;
    assert_int_equal(dmb_sim_create(own.model, &options, &own.sim), DMB_OK);
    assert_int_equal(dmb_analysis_static(own.sim, NULL, NULL), DMB_OK);
    const uint64_t before = rig_hash(&own);
    const int held = p.held;
    int failures = 0;
    for (int n = 0; found == NULL; n++) {
        p.left = n;
        const int32_t status = dmb_analysis_buckling(own.sim, NULL, &found);
        if (status == DMB_OK) break;
        assert_int_equal(status, DMB_ERR_NO_MEMORY);
        assert_int_equal(p.held, held);
        assert_true(rig_hash(&own) == before);
        failures++;
    }
    assert_true(failures >= 3);
    dmb_buckling_destroy(&found);
    assert_int_equal(p.held, held);
    dmb_sim_destroy(&own.sim);
    column_close(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(states_that_cannot_buckle), cmocka_unit_test(body_that_is_free),
        cmocka_unit_test(options_out_of_bounds),     cmocka_unit_test(nothing_below_the_bound),
        cmocka_unit_test(nonsense_handles),          cmocka_unit_test(every_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
