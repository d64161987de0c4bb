/* The reason of a failed create, read from the model: that of the caller's own last create while other threads fail at
 * the same model with reasons of their own; gone after a create that succeeds. Under the thread sanitizer without
 * races. */
#include <pthread.h>

#include "sim_test.h"

enum { THREADS = 4, ROUNDS = 50 };

typedef struct worker {
    dmb_model *model;
    int number, wrong;
} worker;

static void *fail_often(void *context)
{
    worker *w = context;
    for (int i = 0; i < ROUNDS; i++) {
        dmb_sim_options options = dmb_sim_options_default();
        dmb_sim *sim = NULL;
        char expected[40];
        options.spectral_radius = 2.0 + w->number + 10.0 * i;
        snprintf(expected, sizeof expected, "spectral_radius = %d,", 2 + w->number + 10 * i);
        w->wrong += dmb_sim_create(w->model, &options, &sim) != DMB_ERR_VALUE;
        w->wrong += strstr(dmb_model_message(w->model), expected) == NULL;
        if (i % 7 != 0) continue;
        w->wrong += dmb_sim_create(w->model, NULL, &sim) != DMB_OK;
        w->wrong += strstr(dmb_model_message(w->model), "compiled: ") == NULL;
        dmb_sim_destroy(&sim);
    }
    return NULL;
}

static void each_thread_reads_its_own(void **state)
{
    rig r = rig_of(&plain_rig);
    pthread_t thread[THREADS];
    worker workers[THREADS];
    (void)state;
    for (int i = 0; i < THREADS; i++) {
        workers[i] = (worker){r.model, i, 0};
        assert_int_equal(pthread_create(&thread[i], NULL, fail_often, &workers[i]), 0);
    }
    for (int i = 0; i < THREADS; i++) {
        pthread_join(thread[i], NULL);
        assert_int_equal(workers[i].wrong, 0);
    }
    assert_non_null(strstr(dmb_model_message(r.model), "compiled: ")); /* here nothing failed */
    dmb_model_destroy(&r.model);
}

static void expect(const dmb_model *model, const char *text)
{
    if (strstr(dmb_model_message(model), text) == NULL)
        fail_msg("\"%s\" without \"%s\"", dmb_model_message(model), text);
}

/* Every way to fail: before compile, options, block, joints that do not close; and models do not mix. */
static void every_reason(void **state)
{
    rig r = rig_of(&plain_rig), other = rig_of(&plain_rig);
    dmb_sim_options options = dmb_sim_options_default();
    dmb_joint_def joint = dmb_joint_def_default();
    dmb_body_def body = dmb_body_def_default();
    dmb_model *model;
    dmb_sim *sim = NULL;
    char block[64];
    size_t size;
    (void)state;
    assert_int_equal(dmb_sim_create_in(r.model, NULL, block, sizeof block, &sim), DMB_ERR_VALUE);
    expect(r.model, "size of the block = 64, must be >= ");
    expect(other.model, "compiled: ");
    options.max_iterations = 0;
    assert_int_equal(dmb_sim_memory_size(r.model, &options, &size), DMB_ERR_VALUE);
    expect(r.model, "max_iterations = 0");
    must(dmb_model_create(NULL, &model));
    assert_int_equal(dmb_sim_create(model, NULL, &sim), DMB_ERR_ORDER);
    expect(model, "call dmb_model_compile first");
    joint.place_b = dmb_station((dmb_id){0, 0}, 0, 0.0);
    must(dmb_model_add_body(model, &body, &joint.place_b.part));
    joint.origin_a[0] = 1.0; /* fixed at x = 1 and at x = 2 */
    must(dmb_model_add_joint(model, &joint, NULL));
    joint.origin_a[0] = 2.0;
    must(dmb_model_add_joint(model, &joint, NULL));
    must(dmb_model_compile(model, NULL));
    expect(model, "compiled: ");
    assert_int_equal(dmb_sim_create(model, NULL, &sim), DMB_ERR_GEOMETRY);
    expect(model, "joint");
    assert_null(sim);
    dmb_model_destroy(&model);
    dmb_model_destroy(&r.model);
    dmb_model_destroy(&other.model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(each_thread_reads_its_own), cmocka_unit_test(every_reason)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
