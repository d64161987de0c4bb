/* Snapshots: a run that is saved, left, taken up again or handed from sim to sim goes on bit for bit; what does not fit
 * or is damaged is refused and changes nothing. */
#include <stdlib.h>

#include "whole_scene.h"

enum { STEPS = 60, CUT = 23 };
static const double step = 1e-3;

typedef struct scene {
    whole_parts parts;
    dmb_model *model;
    dmb_sim *sim;
    unsigned char *snapshot;
    size_t size;
} scene;

static int set_up(void **state)
{
    scene *s = calloc(1, sizeof *s);
    s->model = whole_model(&s->parts);
    s->sim = whole_sim(s->model, NULL);
    assert_int_equal(dmb_sim_snapshot_size(s->sim, &s->size), DMB_OK);
    s->snapshot = malloc(s->size);
    *state = s;
    return 0;
}

static int tear_down(void **state)
{
    scene *s = *state;
    dmb_sim_destroy(&s->sim);
    dmb_model_destroy(&s->model);
    free(s->snapshot);
    free(s);
    return 0;
}

static void save(const dmb_sim *sim, scene *s)
{
    assert_int_equal(dmb_sim_snapshot(sim, s->snapshot, s->size), DMB_OK);
}

static void restore(dmb_sim *sim, const scene *s)
{
    const int32_t status = dmb_sim_restore(sim, s->snapshot, s->size);
    if (status < 0) fail_msg("%s: %s", dmb_status_name(status), dmb_sim_message(sim));
}

/* The hash after all steps without interruption. */
static uint64_t straight(const scene *s)
{
    dmb_sim *sim = whole_sim(s->model, NULL);
    whole_run(sim, STEPS, step);
    const uint64_t hash = whole_hash(sim);
    dmb_sim_destroy(&sim);
    return hash;
}

/* ---- Going on ---------------------------------------------------------------------------------------------------- */

static void run_taken_up_again_is_the_same(void **state)
{
    scene *s = *state;
    whole_run(s->sim, CUT, step);
    const uint64_t middle = whole_hash(s->sim);
    save(s->sim, s);
    assert_true(whole_hash(s->sim) == middle);
    whole_run(s->sim, STEPS - CUT, step);
    const uint64_t end = whole_hash(s->sim);
    assert_true(end == straight(s));
    restore(s->sim, s);
    assert_true(whole_hash(s->sim) == middle);
    whole_run(s->sim, STEPS - CUT, step);
    assert_true(whole_hash(s->sim) == end);
}

static void another_sim_takes_over(void **state)
{
    scene *s = *state;
    dmb_sim *other = whole_sim(s->model, NULL);
    whole_run(s->sim, CUT, step);
    whole_run(other, 7, 2.1e-3); /* somewhere else entirely */
    save(s->sim, s);
    restore(other, s);
    assert_true(whole_hash(other) == whole_hash(s->sim));
    dmb_sim_destroy(&s->sim);
    whole_run(other, STEPS - CUT, step);
    assert_true(whole_hash(other) == straight(s));
    dmb_sim_destroy(&other);
}

/* A run that changes hands after every step, between sims in blocks of different alignment. */
static void run_handed_around_is_the_same(void **state)
{
    enum { HANDS = 3 };
    scene *s = *state;
    size_t size = 0;
    unsigned char *block[HANDS];
    dmb_sim *sim[HANDS];
    assert_int_equal(dmb_sim_memory_size(s->model, NULL, &size), DMB_OK);
    for (size_t i = 0; i < HANDS; i++) {
        block[i] = malloc(size + 16 * HANDS);
        assert_true(dmb_sim_create_in(s->model, NULL, block[i] + 11 * i, size, &sim[i]) >= 0);
    }
    for (size_t i = 0; i < STEPS; i++) {
        dmb_sim *next = sim[(i + 1) % HANDS];
        whole_run(sim[i % HANDS], 1, step);
        save(sim[i % HANDS], s);
        restore(next, s);
    }
    assert_true(whole_hash(sim[STEPS % HANDS]) == straight(s));
    for (size_t i = 0; i < HANDS; i++) {
        dmb_sim_destroy(&sim[i]);
        free(block[i]);
    }
}

/* Step control, too, is part of the state. */
static void advance_goes_on_the_same(void **state)
{
    scene *s = *state;
    assert_true(dmb_sim_advance(s->sim, 0.004, NULL) >= 0);
    save(s->sim, s);
    assert_true(dmb_sim_advance(s->sim, 0.008, NULL) >= 0);
    const uint64_t end = whole_hash(s->sim);
    restore(s->sim, s);
    assert_true(dmb_sim_advance(s->sim, 0.008, NULL) >= 0);
    assert_true(whole_hash(s->sim) == end);
}

/* So is what the caller has set. */
static void set_drive_is_saved(void **state)
{
    scene *s = *state;
    assert_int_equal(dmb_sim_set_drive(s->sim, s->parts.turning, 6.5), DMB_OK);
    whole_run(s->sim, 5, step);
    save(s->sim, s);
    whole_run(s->sim, 5, step);
    const uint64_t end = whole_hash(s->sim);
    assert_int_equal(dmb_sim_set_drive(s->sim, s->parts.turning, (double)NAN), DMB_OK);
    restore(s->sim, s);
    whole_run(s->sim, 5, step);
    assert_true(whole_hash(s->sim) == end);
}

/* A model described once more in the same way fits: the parts decide, not the object. */
static void equal_model_fits(void **state)
{
    scene *s = *state;
    whole_parts parts;
    dmb_model *model = whole_model(&parts);
    dmb_sim *sim = whole_sim(model, NULL);
    whole_run(s->sim, CUT, step);
    save(s->sim, s);
    restore(sim, s);
    whole_run(sim, STEPS - CUT, step);
    assert_true(whole_hash(sim) == straight(s));
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
}

/* Equal states give equal snapshots; time 0 can be had back. */
static void snapshot_is_a_function_of_the_state(void **state)
{
    scene *s = *state;
    unsigned char *second = malloc(s->size);
    save(s->sim, s);
    const uint64_t start = whole_hash(s->sim);
    whole_run(s->sim, CUT, step);
    restore(s->sim, s);
    assert_true(whole_hash(s->sim) == start);
    assert_true(dmb_sim_time(s->sim) == 0.0);
    assert_int_equal(dmb_sim_snapshot(s->sim, second, s->size), DMB_OK);
    assert_memory_equal(second, s->snapshot, s->size);
    free(second);
}

/* ---- Refusals ---------------------------------------------------------------------------------------------------- */

static void refuses(dmb_sim *sim, const void *block, size_t size, int32_t wanted)
{
    const uint64_t before = whole_hash(sim);
    const double time = dmb_sim_time(sim);
    const int32_t status = dmb_sim_restore(sim, block, size);
    if (status != wanted) fail_msg("%s, wanted %s", dmb_status_name(status), dmb_status_name(wanted));
    assert_true(whole_hash(sim) == before);
    assert_true(dmb_sim_time(sim) == time);
    if (block != NULL) assert_true(dmb_sim_message(sim)[0] != '\0');
}

static void truncated_snapshot_is_refused(void **state)
{
    scene *s = *state;
    whole_run(s->sim, 5, step);
    save(s->sim, s);
    whole_run(s->sim, 5, step);
    for (size_t size = 0; size < s->size; size += size < 100 ? 1 : 97) {
        unsigned char *part = malloc(size + 1); /* of this size, so that a checker sees any byte read beyond it */
        unsigned char *exact = realloc(part, size > 0 ? size : 1);
        memcpy(exact, s->snapshot, size);
        refuses(s->sim, exact, size, DMB_ERR_VALUE);
        free(exact);
    }
    refuses(s->sim, s->snapshot, s->size - 1, DMB_ERR_VALUE);
    refuses(s->sim, NULL, s->size, DMB_ERR_NULL);
    restore(s->sim, s);
}

static void damaged_snapshot_is_refused(void **state)
{
    scene *s = *state;
    whole_run(s->sim, 5, step);
    save(s->sim, s);
    whole_run(s->sim, 5, step);
    for (size_t i = 0; i < s->size; i += i < 64 ? 1 : 61) {
        for (unsigned bit = 0; bit < 8; bit += 7) {
            s->snapshot[i] ^= (unsigned char)(1u << bit);
            refuses(s->sim, s->snapshot, s->size, DMB_ERR_VALUE);
            s->snapshot[i] ^= (unsigned char)(1u << bit);
        }
    }
    restore(s->sim, s);
}

/* Bytes that never were a snapshot. */
static void snapshot_of_zeros_is_refused(void **state)
{
    scene *s = *state;
    memset(s->snapshot, 0, s->size);
    refuses(s->sim, s->snapshot, s->size, DMB_ERR_VALUE);
    memset(s->snapshot, 0xFF, s->size);
    refuses(s->sim, s->snapshot, s->size, DMB_ERR_VALUE);
}

static void refused_by(dmb_sim *sim, const scene *s)
{
    whole_run(sim, 3, step);
    refuses(sim, s->snapshot, s->size, DMB_ERR_VALUE);
}

/* One thing is different, numbered from 0; returns the features to compile with. */
enum { DIFFERENCES = 6 };
static int32_t make_different(dmb_model *model, whole_parts *parts, int which)
{
    dmb_environment_def environment = dmb_environment_def_default();
    environment.fluid_density = which == 0 ? 1001.0 : 1000.0; /* the others as in the scene */
    environment.lateral_damping = which == 1 ? 6.0 : 5.0;
    environment.axial_damping = 2.0;
    environment.torsional_damping = which == 2 ? 0.2 : 0.1;
    if (which == 3) environment.gravity[2] = -9.80;
    whole_must(model, dmb_model_set_environment(model, &environment));
    if (which == 4) whole_must(model, whole_add_follower(model, parts));
    return which == 5 ? DMB_FEATURE_ALL & ~DMB_FEATURE_ECCENTRICITY : DMB_FEATURE_ALL;
}

static void other_model_is_refused(void **state)
{
    scene *s = *state;
    save(s->sim, s);
    for (int which = 0; which <= DIFFERENCES; which++) {
        whole_parts parts;
        dmb_model *model = whole_model_until(&parts, WHOLE_CALLS - 1);
        dmb_compile_options compile = dmb_compile_options_default();
        dmb_sim *sim;
        compile.features = make_different(model, &parts, which);
        whole_must(model, dmb_model_compile(model, &compile));
        sim = whole_sim(model, NULL);
        if (which < DIFFERENCES)
            refused_by(sim, s);
        else
            restore(sim, s); /* no difference */
        dmb_sim_destroy(&sim);
        dmb_model_destroy(&model);
    }
}

static void other_options_are_refused(void **state)
{
    scene *s = *state;
    dmb_sim_options options[4] = {dmb_sim_options_default(), dmb_sim_options_default(), dmb_sim_options_default(),
                                  dmb_sim_options_default()};
    options[0].spectral_radius = 0.5;
    options[1].newton_tolerance = 1e-9;
    options[2].energy_ledger = 0;
    options[3].bounded_work = 1;
    save(s->sim, s);
    for (size_t i = 0; i < 4; i++) {
        dmb_sim *sim = whole_sim(s->model, &options[i]);
        refused_by(sim, s);
        dmb_sim_destroy(&sim);
    }
}

static void small_block_is_refused(void **state)
{
    scene *s = *state;
    memset(s->snapshot, 0x5A, s->size);
    assert_int_equal(dmb_sim_snapshot(s->sim, s->snapshot, s->size - 1), DMB_ERR_VALUE);
    for (size_t i = 0; i < s->size; i++) assert_int_equal(s->snapshot[i], 0x5A);
    assert_int_equal(dmb_sim_snapshot(s->sim, NULL, s->size), DMB_ERR_NULL);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(run_taken_up_again_is_the_same),
        TEST(another_sim_takes_over),
        TEST(run_handed_around_is_the_same),
        TEST(advance_goes_on_the_same),
        TEST(set_drive_is_saved),
        TEST(equal_model_fits),
        TEST(snapshot_is_a_function_of_the_state),
        TEST(truncated_snapshot_is_refused),
        TEST(damaged_snapshot_is_refused),
        TEST(snapshot_of_zeros_is_refused),
        TEST(other_model_is_refused),
        TEST(other_options_are_refused),
        TEST(small_block_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
