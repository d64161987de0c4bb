/* The same scene gives the same bits: twice over, in the caller's memory of any alignment and content, with other sims
 * run in between, with questions asked, calls refused and the state of the floating-point flags as it may be. */
#include <fenv.h>
#include <stdlib.h>

#include "whole_scene.h"

enum { STEPS = 50 };
static const double step = 1e-3;

static uint64_t reference(void)
{
    whole_parts parts;
    dmb_model *model = whole_model(&parts);
    dmb_sim *sim = whole_sim(model, NULL);
    whole_run(sim, STEPS, step);
    const uint64_t hash = whole_hash(sim);
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
    return hash;
}

static void same_scene_twice_is_the_same(void **state)
{
    (void)state;
    assert_true(reference() == reference());
}

/* Blocks at every offset from a cache line, filled with rubbish. */
static void block_does_not_matter(void **state)
{
    const uint64_t wanted = reference();
    whole_parts parts;
    dmb_model *model = whole_model(&parts);
    size_t size = 0;
    (void)state;
    assert_int_equal(dmb_sim_memory_size(model, NULL, &size), DMB_OK);
    unsigned char *memory = malloc(size + 64);
    for (size_t offset = 0; offset < 64; offset += offset < 9 ? 1 : 11) {
        dmb_sim *sim = NULL;
        memset(memory, (int)(0xFF - offset), size + 64);
        assert_true(dmb_sim_create_in(model, NULL, memory + offset, size, &sim) >= 0);
        whole_run(sim, STEPS, step);
        assert_true(whole_hash(sim) == wanted);
        dmb_sim_destroy(&sim);
        for (size_t i = 0; i < offset; i++) assert_int_equal(memory[i], (unsigned char)(0xFF - offset));
        for (size_t i = offset + size; i < size + 64; i++) assert_int_equal(memory[i], (unsigned char)(0xFF - offset));
    }
    free(memory);
    dmb_model_destroy(&model);
}

static void small_block_is_refused(void **state)
{
    whole_parts parts;
    dmb_model *model = whole_model(&parts);
    dmb_sim *sim = NULL;
    size_t size = 0;
    (void)state;
    assert_int_equal(dmb_sim_memory_size(model, NULL, &size), DMB_OK);
    void *memory = malloc(size);
    assert_int_equal(dmb_sim_create_in(model, NULL, memory, size - 1, &sim), DMB_ERR_VALUE);
    assert_null(sim);
    assert_int_equal(dmb_sim_create_in(model, NULL, NULL, size, &sim), DMB_ERR_NULL);
    assert_null(sim);
    free(memory);
    dmb_model_destroy(&model);
}

/* Two sims of one model and one of another, in turns. */
static void other_sims_do_not_matter(void **state)
{
    const uint64_t wanted = reference();
    whole_parts parts[2];
    dmb_model *model[2] = {whole_model(&parts[0]), whole_model(&parts[1])};
    dmb_sim *sim[3] = {whole_sim(model[0], NULL), whole_sim(model[0], NULL), whole_sim(model[1], NULL)};
    (void)state;
    for (uint32_t i = 0; i < STEPS; i++) {
        whole_run(sim[0], 1, step);
        whole_run(sim[1], 2, 0.7 * step);
        if (i % 3 != 0) whole_run(sim[2], 1, step);
    }
    assert_true(whole_hash(sim[0]) == wanted);
    while (dmb_sim_time(sim[2]) < (STEPS - 0.5) * step) whole_run(sim[2], 1, step);
    assert_true(whole_hash(sim[2]) == wanted);
    for (int i = 0; i < 3; i++) dmb_sim_destroy(&sim[i]);
    for (int i = 0; i < 2; i++) dmb_model_destroy(&model[i]);
}

/* Questions and refused calls leave no trace. */
static void questions_do_not_matter(void **state)
{
    const uint64_t wanted = reference();
    static whole_answers answers;
    whole_parts parts;
    dmb_model *model = whole_model(&parts);
    dmb_sim *sim = whole_sim(model, NULL);
    (void)state;
    whole_answers_init(&answers, &parts);
    for (uint32_t i = 0; i < STEPS; i++) {
        whole_run(sim, 1, step);
        assert_true(whole_ask(sim, &parts, &answers) >= 0);
        assert_true(dmb_sim_step(sim, -step, NULL) < 0);
        assert_true(dmb_sim_set_drive(sim, parts.feed, 1.0) < 0);
        parts.callback_status = 1;
        assert_int_equal(dmb_sim_step(sim, step, NULL), DMB_ERR_CALLBACK);
        parts.callback_status = 0;
    }
    assert_true(whole_hash(sim) == wanted);
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
}

/* Flags that were raised by the host. */
static void floating_point_flags_do_not_matter(void **state)
{
    const uint64_t wanted = reference();
    (void)state;
    (void)feraiseexcept(FE_ALL_EXCEPT);
    assert_true(reference() == wanted);
    (void)feclearexcept(FE_ALL_EXCEPT);
}

/* A drive that is let go and was not held. */
static void drive_let_go_does_not_matter(void **state)
{
    const uint64_t wanted = reference();
    whole_parts parts;
    dmb_model *model = whole_model(&parts);
    dmb_sim *sim = whole_sim(model, NULL);
    (void)state;
    for (uint32_t i = 0; i < STEPS; i++) {
        assert_int_equal(dmb_sim_set_drive(sim, parts.turning, (double)NAN), DMB_OK);
        assert_int_equal(dmb_sim_set_drive(sim, parts.pushing, -(double)NAN), DMB_OK);
        whole_run(sim, 1, step);
    }
    assert_true(whole_hash(sim) == wanted);
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(same_scene_twice_is_the_same), cmocka_unit_test(block_does_not_matter),
        cmocka_unit_test(small_block_is_refused),       cmocka_unit_test(other_sims_do_not_matter),
        cmocka_unit_test(questions_do_not_matter),      cmocka_unit_test(floating_point_flags_do_not_matter),
        cmocka_unit_test(drive_let_go_does_not_matter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
