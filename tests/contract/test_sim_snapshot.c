/* Saving and restoring: a restored sim goes on bit for bit; what does not fit is refused and changes nothing. */
#include "sim_test.h"

typedef struct saved {
    unsigned char *block;
    size_t size;
} saved;

static saved save(const dmb_sim *sim)
{
    saved s = {NULL, 0};
    must(dmb_sim_snapshot_size(sim, &s.size));
    s.block = malloc(s.size);
    assert_non_null(s.block);
    must(dmb_sim_snapshot(sim, s.block, s.size));
    return s;
}

/* Restores, runs on and compares, in the same sim and in a fresh one of the same model. */
static void check_goes_on(const rig *r)
{
    dmb_sim *sim = rig_sim(r), *fresh = rig_sim(r);
    rig_run(sim, 30);
    const uint64_t middle = hash_of(sim);
    saved s = save(sim);
    assert_int_equal(hash_of(sim), middle);
    rig_run(sim, 30);
    const uint64_t end = hash_of(sim);
    assert_true(end != middle);
    must(dmb_sim_restore(sim, s.block, s.size));
    assert_int_equal(hash_of(sim), middle);
    rig_run(sim, 30);
    assert_int_equal(hash_of(sim), end);
    rig_run(fresh, 7);
    must(dmb_sim_restore(fresh, s.block, s.size));
    assert_int_equal(hash_of(fresh), middle);
    rig_run(fresh, 30);
    assert_int_equal(hash_of(fresh), end);
    free(s.block);
    dmb_sim_destroy(&sim);
    dmb_sim_destroy(&fresh);
}

static void restored_sims_go_on(void **state)
{
    (void)state;
    for (int32_t kind = DMB_PIPE_FLEXIBLE; kind <= DMB_PIPE_RIGID; kind++) {
        rig_options options = plain_rig;
        options.pipe_kind = kind;
        options.friction_law = DMB_FRICTION_BRISTLE;
        rig r = rig_of(&options);
        check_goes_on(&r);
        dmb_model_destroy(&r.model);
    }
}

static void advance_goes_on(void **state)
{
    (void)state;
    rig r = rig_of(&plain_rig);
    dmb_sim *sim = rig_sim(&r), *fresh = rig_sim(&r);
    assert_true(dmb_sim_advance(sim, 0.02, NULL) >= 0);
    saved s = save(sim);
    assert_true(dmb_sim_advance(sim, 0.03, NULL) >= 0);
    must(dmb_sim_restore(fresh, s.block, s.size));
    assert_true(dmb_sim_advance(fresh, 0.03, NULL) >= 0);
    assert_int_equal(hash_of(sim), hash_of(fresh));
    free(s.block);
    dmb_sim_destroy(&sim);
    dmb_sim_destroy(&fresh);
    dmb_model_destroy(&r.model);
}

/* The caller's hand on a drive is part of the state. */
static void drive_inputs_are_saved(void **state)
{
    (void)state;
    rig r = rig_of(&plain_rig);
    dmb_sim *sim = rig_sim(&r), *fresh = rig_sim(&r);
    const uint64_t start = hash_of(sim);
    must(dmb_sim_set_drive(sim, r.torque, 123.0));
    assert_true(hash_of(sim) != start);
    saved s = save(sim);
    rig_run(sim, 10);
    must(dmb_sim_restore(fresh, s.block, s.size));
    rig_run(fresh, 10);
    assert_int_equal(hash_of(sim), hash_of(fresh));
    must(dmb_sim_set_drive(sim, r.torque, (double)NAN));
    must(dmb_sim_set_drive(fresh, r.torque, -(double)NAN));
    assert_int_equal(hash_of(sim), hash_of(fresh));
    free(s.block);
    dmb_sim_destroy(&sim);
    dmb_sim_destroy(&fresh);
    dmb_model_destroy(&r.model);
}

static void check_refused(dmb_sim *sim, const saved *s, size_t size)
{
    const uint64_t before = hash_of(sim);
    assert_int_equal(dmb_sim_restore(sim, s->block, size), DMB_ERR_VALUE);
    assert_true(strlen(dmb_sim_message(sim)) > 0);
    assert_int_equal(hash_of(sim), before);
}

/* Any byte of it changed, any length short of it. */
static void damaged_snapshots(void **state)
{
    (void)state;
    rig r = rig_of(&plain_rig);
    dmb_sim *sim = rig_sim(&r);
    rig_run(sim, 10);
    saved s = save(sim);
    rig_run(sim, 10);
    for (size_t i = 0; i < s.size; i += i < 96 ? 1 : 97) {
        s.block[i] ^= 0x10;
        check_refused(sim, &s, s.size);
        s.block[i] ^= 0x10;
    }
    for (size_t size = 0; size < s.size; size += 1 + size / 3) check_refused(sim, &s, size);
    check_refused(sim, &s, s.size - 1);
    must(dmb_sim_restore(sim, s.block, s.size));
    assert_int_equal(dmb_sim_snapshot(sim, s.block, s.size - 1), DMB_ERR_VALUE);
    free(s.block);
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&r.model);
}

static void check_other_model(const saved *s, const rig_options *options, int32_t wanted)
{
    rig r = rig_of(options);
    dmb_sim *sim = rig_sim(&r);
    assert_int_equal(dmb_sim_restore(sim, s->block, s->size), wanted);
    rig_run(sim, 2);
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&r.model);
}

/* The same description compiled again fits; another one, or other options, do not. */
static void other_models_and_options(void **state)
{
    (void)state;
    rig r = rig_of(&plain_rig);
    dmb_sim *sim = rig_sim(&r), *other = NULL;
    rig_options options = plain_rig;
    dmb_sim_options sim_options = dmb_sim_options_default();
    rig_run(sim, 10);
    saved s = save(sim);
    check_other_model(&s, &options, DMB_OK);
    options.mu_dynamic = 0.29;
    check_other_model(&s, &options, DMB_ERR_VALUE);
    options = plain_rig, options.elements = 2;
    check_other_model(&s, &options, DMB_ERR_VALUE);
    options = plain_rig, options.joint_length = 0.2;
    check_other_model(&s, &options, DMB_ERR_VALUE);
    sim_options.spectral_radius = 0.9;
    assert_true(dmb_sim_create(r.model, &sim_options, &other) >= 0);
    check_refused(other, &s, s.size);
    dmb_sim_destroy(&other);
    free(s.block);
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&r.model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(restored_sims_go_on),      cmocka_unit_test(advance_goes_on),
        cmocka_unit_test(drive_inputs_are_saved),   cmocka_unit_test(damaged_snapshots),
        cmocka_unit_test(other_models_and_options),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
