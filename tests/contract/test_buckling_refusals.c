/* What a buckling analysis refuses, with the sim as it was. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "drillmbd/drillmbd.h"

typedef struct column {
    dmb_model *model;
    dmb_sim *sim;
    dmb_id string, load, motion, control;
} column;

/* Ten pipes clamped at the rig end, or free along and about the axis, under a push at the far end. */
static column make(int32_t start_free, double push, double gravity)
{
    column c;
    memset(&c, 0, sizeof c);
    dmb_environment_def nowhere = dmb_environment_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_load_def load = dmb_load_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    const dmb_term zero = dmb_term_default();
    nowhere.gravity[2] = -gravity;
    string.start_free = start_free;
    assert_int_equal(dmb_model_create(NULL, &c.model), DMB_OK);
    assert_int_equal(dmb_model_set_environment(c.model, &nowhere), DMB_OK);
    assert_int_equal(dmb_model_add_string(c.model, &string, &c.string), DMB_OK);
    assert_int_equal(dmb_model_add_pipes(c.model, &pipe, 10, NULL), DMB_OK);
    load.place = dmb_station(c.string, 9, 1.0);
    load.force[0] = -push;
    assert_int_equal(dmb_model_add_load(c.model, &load, &c.load), DMB_OK);
    assert_int_equal(dmb_model_add_programme(c.model, &zero, 1, &drive.programme), DMB_OK);
    if (start_free == DMB_FREE_CYLINDRICAL) {
        drive.kind = DMB_DRIVE_CONTROL;
        drive.component = DMB_RX;
        assert_int_equal(dmb_model_add_drive(c.model, &drive, &c.control), DMB_OK);
    }
    assert_int_equal(dmb_model_compile(c.model, NULL), DMB_OK);
    assert_int_equal(dmb_sim_create(c.model, NULL, &c.sim), DMB_OK);
    return c;
}

static void end(column *c)
{
    dmb_sim_destroy(&c->sim);
    dmb_model_destroy(&c->model);
}

static uint64_t hash_of(const dmb_sim *sim)
{
    uint64_t hash = 0;
    assert_int_equal(dmb_sim_hash(sim, &hash), DMB_OK);
    return hash;
}

static void refused(const column *c, const dmb_buckling_options *options, int32_t status, const char *says)
{
    const uint64_t before = hash_of(c->sim);
    dmb_buckling *found = (dmb_buckling *)(uintptr_t)16;
    assert_int_equal(dmb_analysis_buckling(c->sim, options, &found), status);
    assert_null(found);
    if (strstr(dmb_sim_message(c->sim), says) == NULL) fail_msg("'%s' does not say %s", dmb_sim_message(c->sim), says);
    assert_true(hash_of(c->sim) == before);
}

static void states_that_cannot_buckle(void **state)
{
    (void)state;
    column c = make(DMB_FREE_NONE, 1.0, 9.81);
    refused(&c, NULL, DMB_ERR_ORDER, "no equilibrium");
    end(&c);
    c = make(DMB_FREE_RX, 0.0, 0.0);
    refused(&c, NULL, DMB_ERR_SINGULAR, "string 0");
    end(&c);
    c = make(DMB_FREE_NONE, 1e5, 0.0); /* straight, and far above its critical load of 4 kN */
    assert_int_equal(dmb_analysis_static(c.sim, NULL, NULL), DMB_OK);
    refused(&c, NULL, DMB_ERR_ORDER, "not stable");
    end(&c);
}

static void options_out_of_bounds(void **state)
{
    (void)state;
    column c = make(DMB_FREE_NONE, 1.0, 0.0);
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
    end(&c);
    c = make(DMB_FREE_CYLINDRICAL, 1.0, 0.0);
    options = dmb_buckling_options_default();
    options.scale = DMB_SCALE_PART;
    options.part = c.control;
    refused(&c, &options, DMB_ERR_VALUE, "speed controller");
    end(&c);
}

/* Pulled instead of pushed nothing buckles: none found, which is an answer. */
static void nothing_below_the_bound(void **state)
{
    (void)state;
    column c = make(DMB_FREE_NONE, -1.0, 0.0);
    dmb_buckling *found = NULL;
    assert_int_equal(dmb_analysis_static(c.sim, NULL, NULL), DMB_OK);
    dmb_buckling_options options = dmb_buckling_options_default();
    options.factor_max = 1e6;
    assert_int_equal(dmb_analysis_buckling(c.sim, &options, &found), DMB_NOTE_STOPPED);
    assert_int_equal(dmb_buckling_count(found), 0);
    double factor = 7.0, shape[6];
    assert_int_equal(dmb_buckling_factor(found, 0, &factor), DMB_ERR_VALUE);
    assert_true(factor == 7.0);
    assert_int_equal(dmb_buckling_shape(found, 0, dmb_station(c.string, 0, 0.0), shape), DMB_ERR_VALUE);
    dmb_buckling_destroy(&found);
    end(&c);
}

static void nonsense_handles(void **state)
{
    (void)state;
    column c = make(DMB_FREE_NONE, 1.0, 0.0);
    dmb_buckling *found = NULL;
    double factor, shape[6];
    assert_int_equal(dmb_analysis_buckling(NULL, NULL, &found), DMB_ERR_NULL);
    assert_int_equal(dmb_analysis_buckling(c.sim, NULL, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_analysis_buckling((dmb_sim *)(void *)c.model, NULL, &found), DMB_ERR_HANDLE);
    assert_int_equal(dmb_buckling_count(NULL), 0);
    assert_int_equal(dmb_analysis_static(c.sim, NULL, NULL), DMB_OK);
    assert_int_equal(dmb_buckling_factor(NULL, 0, &factor), DMB_ERR_NULL);
    assert_int_equal(dmb_analysis_buckling(c.sim, NULL, &found), DMB_OK);
    assert_int_equal(dmb_buckling_factor(found, 0, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_buckling_factor((const dmb_buckling *)(const void *)c.sim, 0, &factor), DMB_ERR_HANDLE);
    assert_int_equal(dmb_buckling_shape(found, 0, dmb_station(c.load, 0, 0.0), shape), DMB_ERR_ID);
    assert_int_equal(dmb_buckling_shape(found, 0, dmb_station(c.string, 10, 0.0), shape), DMB_ERR_VALUE);
    end(&c); /* a result outlives its sim and its model's owner */
    assert_int_equal(dmb_buckling_shape(found, 0, dmb_station(c.string, 9, 1.0), shape), DMB_OK);
    dmb_buckling_destroy(&found);
    dmb_buckling_destroy(&found);
    dmb_buckling_destroy(NULL);
}

/* ---- Memory that is not there ------------------------------------------------------------------------------------ */

typedef struct purse {
    int left, held;
} purse;

static void *take(void *context, size_t size, size_t alignment)
{
    purse *p = context;
    if (p->left-- <= 0) return NULL;
    p->held++;
    return aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}

static void give(void *context, void *block, size_t size, size_t alignment)
{
    purse *p = context;
    (void)size;
    (void)alignment;
    p->held--;
    free(block);
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    column c = make(DMB_FREE_NONE, 1.0, 0.0);
    purse p = {1000, 0};
    dmb_allocator allocator = dmb_allocator_default();
    dmb_sim_options options = dmb_sim_options_default();
    dmb_sim *sim = NULL;
    dmb_buckling *found = NULL;
    allocator.context = &p;
    allocator.allocate = take;
    allocator.release = give;
    options.allocator = &allocator;
    assert_int_equal(dmb_sim_create(c.model, &options, &sim), DMB_OK);
    assert_int_equal(dmb_analysis_static(sim, NULL, NULL), DMB_OK);
    const uint64_t before = hash_of(sim);
    const int held = p.held;
    int failures = 0;
    for (int n = 0; found == NULL; n++) {
        p.left = n;
        const int32_t status = dmb_analysis_buckling(sim, NULL, &found);
        if (status == DMB_OK) break;
        assert_int_equal(status, DMB_ERR_NO_MEMORY);
        assert_int_equal(p.held, held);
        assert_true(hash_of(sim) == before);
        failures++;
    }
    assert_true(failures >= 3);
    dmb_buckling_destroy(&found);
    assert_int_equal(p.held, held);
    dmb_sim_destroy(&sim);
    end(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(states_that_cannot_buckle), cmocka_unit_test(options_out_of_bounds),
        cmocka_unit_test(nothing_below_the_bound),   cmocka_unit_test(nonsense_handles),
        cmocka_unit_test(every_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
