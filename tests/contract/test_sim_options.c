/* Options of a sim: each field at its bounds, beyond them and not a number; the log names the field. */
#include "sim_test.h"

typedef struct number_field {
    const char *name;
    size_t offset;
    double good[2], bad[3];
} number_field;

typedef struct count_field {
    const char *name;
    size_t offset;
    uint32_t good[2], bad[2];
} count_field;

#define AT(field) #field, offsetof(dmb_sim_options, field)

static const number_field numbers[] = {
    {AT(spectral_radius), {0.0, 1.0}, {-1e-9, 1.0 + 1e-9, 7.0}},
    {AT(newton_tolerance), {1e-14, 1e-1}, {-1e-14, 0.11, 1e-15}},
    {AT(tolerance_translation), {1e-30, 1e3}, {0.0, -1.0, -1e-300}},
    {AT(tolerance_rotation), {1e-30, 1e3}, {0.0, -1.0, -1e-300}},
    {AT(step_min), {1e-15, 0.09}, {0.0, -1e-9, 0.1}},
    {AT(step_max), {1e-8, 1e6}, {1e-9, 0.0, -1.0}},
};

static const count_field counts[] = {
    {AT(max_iterations), {1, 1000}, {0, 1001}},
    {AT(max_cuts), {0, 30}, {31, UINT32_MAX}},
    {AT(bounded_work), {0, 1}, {2, UINT32_MAX}},
    {AT(energy_ledger), {0, 1}, {2, UINT32_MAX}},
};

static dmb_sim_options told_to(log_text *log)
{
    dmb_sim_options options = dmb_sim_options_default();
    memset(log, 0, sizeof *log);
    options.log = log_line;
    options.log_context = log;
    return options;
}

static void check_good(const rig *r, const dmb_sim_options *options)
{
    dmb_sim *sim = NULL;
    assert_true(dmb_sim_create(r->model, options, &sim) >= 0);
    assert_non_null(sim);
    dmb_sim_destroy(&sim);
}

static void check_bad(const rig *r, const dmb_sim_options *options, const log_text *log, const char *name,
                      int32_t wanted)
{
    dmb_sim *sim = (dmb_sim *)(uintptr_t)8;
    size_t size = 5;
    assert_int_equal(dmb_sim_create(r->model, options, &sim), wanted);
    assert_null(sim);
    assert_int_equal(log->lines, 1);
    if (strstr(log->text, name) == NULL) fail_msg("the log says '%s', not a word of %s", log->text, name);
    assert_int_equal(dmb_sim_memory_size(r->model, options, &size), wanted);
    assert_int_equal(size, 5);
}

static void numbers_are_checked(void **state)
{
    (void)state;
    rig r = rig_of(&plain_rig);
    log_text log;
    const double never[3] = {(double)NAN, (double)INFINITY, -(double)INFINITY};
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
        const number_field *f = &numbers[i];
        for (int k = 0; k < 6; k++) {
            dmb_sim_options options = told_to(&log);
            const double value = k < 3 ? f->bad[k] : never[k - 3];
            memcpy((char *)&options + f->offset, &value, sizeof value);
            check_bad(&r, &options, &log, f->name, k < 3 ? DMB_ERR_VALUE : DMB_ERR_NOT_FINITE);
            if (k > 1) continue;
            options = told_to(&log);
            memcpy((char *)&options + f->offset, &f->good[k], sizeof f->good[k]);
            check_good(&r, &options);
        }
    }
    dmb_model_destroy(&r.model);
}

static void counts_are_checked(void **state)
{
    (void)state;
    rig r = rig_of(&plain_rig);
    log_text log;
    for (size_t i = 0; i < sizeof counts / sizeof counts[0]; i++) {
        const count_field *f = &counts[i];
        for (int k = 0; k < 2; k++) {
            dmb_sim_options options = told_to(&log);
            memcpy((char *)&options + f->offset, &f->bad[k], sizeof f->bad[k]);
            check_bad(&r, &options, &log, f->name, DMB_ERR_VALUE);
            options = told_to(&log);
            memcpy((char *)&options + f->offset, &f->good[k], sizeof f->good[k]);
            check_good(&r, &options);
        }
    }
    dmb_model_destroy(&r.model);
}

/* A header from the future is fine while it asks for nothing new; a size that is none is refused without looking. */
static void struct_sizes(void **state)
{
    (void)state;
    rig r = rig_of(&plain_rig);
    struct {
        dmb_sim_options options;
        double more[2];
    } longer;
    dmb_sim *sim = NULL;
    memset(&longer, 0, sizeof longer);
    longer.options = dmb_sim_options_default();
    longer.options.struct_size = sizeof longer;
    check_good(&r, &longer.options);
    longer.more[1] = 1.0;
    assert_int_equal(dmb_sim_create(r.model, &longer.options, &sim), DMB_ERR_STRUCT_SIZE);
    for (uint32_t size = 0; size < 12; size++) {
        memset(&longer, 0xFF, sizeof longer);
        longer.options.struct_size = size;
        assert_int_equal(dmb_sim_create(r.model, &longer.options, &sim), DMB_ERR_STRUCT_SIZE);
    }
    dmb_model_destroy(&r.model);
}

static void half_an_allocator(void **state)
{
    (void)state;
    rig r = rig_of(&plain_rig);
    log_text log;
    dmb_sim_options options = told_to(&log);
    dmb_allocator allocator = dmb_allocator_default();
    dmb_sim *sim = NULL;
    options.allocator = &allocator;
    check_good(&r, &options);
    allocator.release = NULL;
    assert_int_equal(dmb_sim_create(r.model, &options, &sim), DMB_ERR_NULL);
    allocator = dmb_allocator_default();
    allocator.struct_size = 9;
    assert_int_equal(dmb_sim_create(r.model, &options, &sim), DMB_ERR_STRUCT_SIZE);
    assert_null(sim);
    dmb_model_destroy(&r.model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_are_checked),
        cmocka_unit_test(counts_are_checked),
        cmocka_unit_test(struct_sizes),
        cmocka_unit_test(half_an_allocator),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
