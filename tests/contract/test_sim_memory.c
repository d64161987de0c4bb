/* Memory of a sim: what is taken is given back, with the sizes it was asked for; the caller's block may begin anywhere;
 * a failing allocation leaves nothing behind. */
#include "sim_test.h"

typedef struct ledger {
    long live, blocks;      /* bytes and blocks out */
    long calls, fail_after; /* -1: never */
} ledger;

static void *count_allocate(void *context, size_t size, size_t alignment)
{
    ledger *l = context;
    if (l->fail_after >= 0 && l->calls >= l->fail_after) return NULL;
    l->calls++;
    void *block = aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
    if (block == NULL) return NULL;
    l->live += (long)size;
    l->blocks++;
    return block;
}

static void count_release(void *context, void *block, size_t size, size_t alignment)
{
    ledger *l = context;
    (void)alignment;
    l->live -= (long)size;
    l->blocks--;
    free(block);
}

static dmb_allocator counting(ledger *l)
{
    dmb_allocator allocator = dmb_allocator_default();
    memset(l, 0, sizeof *l);
    l->fail_after = -1;
    allocator.context = l;
    allocator.allocate = count_allocate;
    allocator.release = count_release;
    return allocator;
}

/* The model's allocator unless the options bring one; all of it comes back. */
static void everything_comes_back(void **state)
{
    (void)state;
    ledger model_ledger, sim_ledger;
    dmb_allocator for_model = counting(&model_ledger), for_sim = counting(&sim_ledger);
    rig_options options = plain_rig;
    dmb_sim_options sim_options = dmb_sim_options_default();
    dmb_sim *sim = NULL;
    size_t size;
    options.allocator = &for_model;
    rig r = rig_of(&options);
    const long before = model_ledger.blocks;
    sim = rig_sim(&r);
    assert_int_equal(model_ledger.blocks, before + 1);
    dmb_sim_destroy(&sim);
    assert_int_equal(model_ledger.blocks, before);
    sim_options.allocator = &for_sim;
    assert_true(dmb_sim_create(r.model, &sim_options, &sim) >= 0);
    memset(&for_sim, 0, sizeof for_sim); /* it was copied */
    must(dmb_sim_memory_size(r.model, NULL, &size));
    assert_int_equal(sim_ledger.blocks, 1);
    assert_int_equal(sim_ledger.live, size);
    assert_int_equal(model_ledger.blocks, before);
    rig_run(sim, 5);
    dmb_sim_destroy(&sim);
    assert_int_equal(sim_ledger.blocks + sim_ledger.live, 0);
    dmb_model_destroy(&r.model);
    assert_int_equal(model_ledger.blocks + model_ledger.live, 0);
}

/* After create a sim asks for nothing, failing calls included. */
static void no_allocation_after_create(void **state)
{
    (void)state;
    ledger l;
    dmb_allocator allocator = counting(&l);
    rig_options options = plain_rig;
    size_t size;
    options.allocator = &allocator;
    rig r = rig_of(&options);
    dmb_sim *sim = rig_sim(&r);
    must(dmb_sim_snapshot_size(sim, &size));
    void *block = malloc(size);
    assert_non_null(block);
    const long calls = l.calls;
    rig_run(sim, 20);
    must(dmb_sim_snapshot(sim, block, size));
    must(dmb_sim_restore(sim, block, size));
    assert_true(dmb_sim_step(sim, (double)NAN, NULL) < 0);
    assert_true(dmb_sim_restore(sim, block, size - 1) < 0);
    assert_int_equal(l.calls, calls);
    free(block);
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&r.model);
}

static void a_failing_allocation(void **state)
{
    (void)state;
    ledger l;
    log_text log = {{0}, 0};
    dmb_allocator allocator = counting(&l);
    rig r = rig_of(&plain_rig);
    dmb_sim_options options = dmb_sim_options_default();
    dmb_sim *sim = (dmb_sim *)(void *)&r;
    options.allocator = &allocator;
    options.log = log_line;
    options.log_context = &log;
    l.fail_after = 0;
    assert_int_equal(dmb_sim_create(r.model, &options, &sim), DMB_ERR_NO_MEMORY);
    assert_null(sim);
    assert_int_equal(l.blocks, 0);
    assert_int_equal(log.lines, 1);
    l.fail_after = -1;
    assert_true(dmb_sim_create(r.model, &options, &sim) >= 0);
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&r.model);
}

/* The model lives as long as the last sim made of it. */
static void sims_hold_the_model(void **state)
{
    (void)state;
    ledger l;
    dmb_allocator allocator = counting(&l);
    rig_options options = plain_rig;
    options.allocator = &allocator;
    rig r = rig_of(&options);
    dmb_sim *first = rig_sim(&r), *second = rig_sim(&r);
    dmb_model_destroy(&r.model);
    assert_null(r.model);
    rig_run(first, 5);
    dmb_sim_destroy(&first);
    rig_run(second, 5);
    dmb_sim_destroy(&second);
    assert_int_equal(l.blocks + l.live, 0);
}

/* Wherever the block begins, the sim does the same, and nothing beyond the block is touched. */
static void any_alignment(void **state)
{
    (void)state;
    enum { GUARD = 64 };
    rig r = rig_of(&plain_rig);
    size_t size;
    uint64_t wanted = 0;
    must(dmb_sim_memory_size(r.model, NULL, &size));
    unsigned char *memory = malloc(size + 2 * GUARD);
    assert_non_null(memory);
    for (size_t shift = 0; shift <= GUARD; shift++) {
        dmb_sim *sim = NULL;
        memset(memory, 0xC3, size + 2 * GUARD);
        assert_true(dmb_sim_create_in(r.model, NULL, memory + shift, size, &sim) >= 0);
        rig_run(sim, 3);
        if (shift == 0) wanted = hash_of(sim);
        assert_int_equal(hash_of(sim), wanted);
        dmb_sim_destroy(&sim);
        for (size_t i = 0; i < shift; i++) assert_int_equal(memory[i], 0xC3);
        for (size_t i = shift + size; i < size + 2 * GUARD; i++) assert_int_equal(memory[i], 0xC3);
    }
    free(memory);
    dmb_model_destroy(&r.model);
}

static void too_small_a_block(void **state)
{
    (void)state;
    rig r = rig_of(&plain_rig);
    size_t size;
    dmb_sim *sim = (dmb_sim *)(void *)&r;
    must(dmb_sim_memory_size(r.model, NULL, &size));
    void *block = malloc(size);
    assert_non_null(block);
    assert_int_equal(dmb_sim_create_in(r.model, NULL, block, size - 1, &sim), DMB_ERR_VALUE);
    assert_null(sim);
    assert_int_equal(dmb_sim_create_in(r.model, NULL, block, 0, &sim), DMB_ERR_VALUE);
    assert_int_equal(dmb_sim_create_in(r.model, NULL, NULL, size, &sim), DMB_ERR_NULL);
    assert_int_equal(dmb_sim_create_in(r.model, NULL, block, size, NULL), DMB_ERR_NULL);
    free(block);
    dmb_model_destroy(&r.model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(everything_comes_back), cmocka_unit_test(no_allocation_after_create),
        cmocka_unit_test(a_failing_allocation),  cmocka_unit_test(sims_hold_the_model),
        cmocka_unit_test(any_alignment),         cmocka_unit_test(too_small_a_block),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
