/* A step made in parts that are run one after the other in the thread of the call: the same bits as without parts, in
 * any order and number of them, with kernels of every width; pieces of elements and of the wall; and functions that do
 * not run the parts as they are told. By threads: test_parallel_threads.c. */
#include "kernel/kernels.h"
#include "parallel_scene.h"
#include "sim/chunks.h"
#include "sim/layout.h"

/* ---- Functions that do something else ---------------------------------------------------------------------------- */

enum { WELL, BACKWARDS, TWICE, BEYOND, LEFT_OUT, NONE, REFUSES, CALLS_BACK };

typedef struct worker {
    int how;
    uint32_t calls;
    dmb_sim *sim;
    int32_t answer; /* of the call back */
    dmb_part_fn part;
    void *work;
} worker;

static int32_t work_alone(void *context, uint32_t count, dmb_part_fn part, void *work)
{
    worker *w = context;
    w->calls++;
    w->part = part;
    w->work = work;
    if (w->how == CALLS_BACK) w->answer = dmb_sim_step(w->sim, 1e-3, NULL);
    if (w->how == BEYOND) part(work, count);
    for (uint32_t i = 0; i < count && w->how != NONE; i++) {
        if (w->how == LEFT_OUT && i == 1) continue;
        part(work, w->how == BACKWARDS ? count - 1 - i : i);
        if (w->how == TWICE) part(work, i);
    }
    return w->how == REFUSES ? 7 : 0;
}

static void open_worker(rig *s, worker *w, int kind)
{
    const dmb_sim_options options = in_parts(work_alone, w, 3);
    memset(w, 0, sizeof *w);
    describe(s, kind);
    begin(s, &options);
    w->sim = s->sim;
}

static uint64_t bits_of(int how)
{
    rig s = {NULL, NULL};
    worker w;
    open_worker(&s, &w, HOLE);
    w.how = how;
    take_divided_steps(&s, 1e-3, 3);
    assert_true(w.calls > 0);
    w.part(w.work, 0); /* after the step: there is nothing to do */
    take_divided_steps(&s, 1e-3, 1);
    if (how == CALLS_BACK) assert_int_equal(w.answer, DMB_ERR_ORDER);
    const uint64_t hash = rig_hash(&s);
    rig_close(&s);
    return hash;
}

static void test_harmless(void **state)
{
    const uint64_t well = bits_of(WELL);
    (void)state;
    assert_true(bits_of(BACKWARDS) == well);
    assert_true(bits_of(TWICE) == well);
    assert_true(bits_of(BEYOND) == well);
    assert_true(bits_of(CALLS_BACK) == well);
}

/* A step fails by what the function did, changes nothing, and may be made again. */
static void check_failure(int how, const char *told)
{
    rig s = {NULL, NULL}, alone = {NULL, NULL};
    worker w;
    dmb_step_report report = dmb_step_report_default();
    open_worker(&s, &w, HOLE);
    take_divided_steps(&s, 1e-3, 2);
    const uint64_t before = rig_hash(&s);
    w.how = how;
    w.calls = 0;
    assert_int_equal(dmb_sim_step(s.sim, 1e-3, &report), DMB_ERR_CALLBACK);
    assert_int_equal(w.calls, 1); /* and is not asked again */
    if (strstr(dmb_sim_message(s.sim), told) == NULL) fail_msg("%s", dmb_sim_message(s.sim));
    assert_true(rig_hash(&s) == before);
    w.how = WELL;
    take_divided_steps(&s, 1e-3, 1);
    describe(&alone, HOLE);
    begin(&alone, NULL);
    take_divided_steps(&alone, 1e-3, 3);
    assert_true(rig_hash(&s) == rig_hash(&alone));
    w.how = how;
    assert_int_equal(dmb_sim_advance(s.sim, 1.0, NULL), DMB_ERR_CALLBACK);
    assert_true(dmb_sim_time(s.sim) == dmb_sim_time(alone.sim));
    rig_close(&alone);
    rig_close(&s);
}

static void test_failures(void **state)
{
    (void)state;
    check_failure(LEFT_OUT, "parallel ran 2 of 3 parts in the step after time 0.002");
    check_failure(NONE, "parallel ran 0 of 3 parts");
    check_failure(REFUSES, "parallel returned 7 in the step after time 0.002");
}

static void test_bounds(void **state)
{
    rig s = {NULL, NULL};
    worker w = {0};
    dmb_sim_options options = in_parts(work_alone, &w, 65);
    (void)state;
    describe(&s, TUBE);
    assert_int_equal(dmb_sim_create(s.model, &options, &s.sim), DMB_ERR_VALUE);
    assert_non_null(strstr(dmb_model_message(s.model), "parallel_parts = 65, must be 1 .. 64"));
    options.parallel_parts = 0;
    assert_int_equal(dmb_sim_create(s.model, &options, &s.sim), DMB_ERR_VALUE);
    options.parallel_parts = 64;
    options.parallel_least = 2001;
    begin(&s, &options);
    take_steps(&s, 1e-3, 2);
    assert_int_equal(w.calls, 0);
    dmb_sim_destroy(&s.sim);
    options.parallel_least = 2000;
    begin(&s, &options);
    take_steps(&s, 1e-3, 2);
    assert_true(w.calls > 0);
    rig_close(&s);
}

/* ---- The same bits ----------------------------------------------------------------------------------------------- */

static void use_lanes(const rig *s, uint32_t lanes)
{
    ((dmb_scene *)(uintptr_t)s->sim->scene)->kernels = dmb_kernels_of(lanes);
}

static void test_same_bits(void **state)
{
    static const uint32_t parts[3] = {2, 3, 64};
    (void)state;
    for (int kind = 0; kind < SCENES; kind++) {
        rig s = {NULL, NULL};
        describe(&s, kind);
        const uint64_t alone = walk(&s, NULL, NULL);
        for (int i = 0; i < 3; i++) {
            worker w = {.how = i % 2 ? BACKWARDS : WELL};
            const dmb_sim_options options = in_parts(work_alone, &w, parts[i]);
            const uint64_t hash = walk(&s, &options, i % 2 ? &options : NULL);
            if (hash != alone) fail_msg("%s in %u parts: other bits", names[kind], (unsigned)parts[i]);
            assert_true(w.calls > 0);
        }
        rig_close(&s);
    }
}

static uint64_t bits_of_width(rig *s, const dmb_sim_options *options, uint32_t lanes)
{
    begin(s, options);
    use_lanes(s, lanes);
    take_divided_steps(s, 1e-3, STEPS);
    const uint64_t hash = rig_hash(s);
    dmb_sim_destroy(&s->sim);
    return hash;
}

static void test_every_width(void **state)
{
    (void)state;
    for (int kind = 0; kind < SCENES; kind++) {
        rig s = {NULL, NULL};
        describe(&s, kind);
        const uint64_t alone = bits_of_width(&s, NULL, 1);
        for (uint32_t lanes = 1; lanes <= 8; lanes *= 2)
            for (uint32_t parts = 1; parts <= 4; parts++) { /* 1: without parts */
                worker w = {.how = BACKWARDS};
                const dmb_sim_options options = in_parts(work_alone, &w, parts);
                if (!dmb_kernels_of(lanes)) continue;
                if (bits_of_width(&s, &options, lanes) != alone)
                    fail_msg("%s in %u parts, %u lanes: other bits", names[kind], (unsigned)parts, (unsigned)lanes);
                assert_true((w.calls > 0) == (parts > 1));
            }
        rig_close(&s);
    }
}

/* ---- Pieces ------------------------------------------------------------------------------------------------------ */

static void press_rings_at_once(dmb_scene *scene)
{
    assert_true(scene->sites_in_order >= 2000);
    scene->sites_in_order = 0;
}

/* Runs so short that each is made at once. */
static void shorten_runs(dmb_scene *scene)
{
    enum { RUNS = 8 };
    static dmb_batch runs[RUNS];
    const dmb_batch whole = scene->batches[0];
    assert_true(scene->batch_count == 1 && whole.count >= 2000 && whole.count / RUNS < DMB_CHUNKS_FROM / 2);
    for (uint32_t i = 0; i < RUNS; i++) {
        runs[i] = whole;
        runs[i].first = whole.first + whole.count * i / RUNS;
        runs[i].count = whole.first + whole.count * (i + 1) / RUNS - runs[i].first;
    }
    scene->batches = runs;
    scene->batch_count = RUNS;
}

/* The accepted state after steps in pieces, and with what `alter` makes otherwise: what is kept for each ring stays at
 * its place, elements of two pieces add up at the node between them. Powers are summed otherwise, and the ledger is not
 * compared. */
static void check_pieces(int32_t normal_law, int32_t friction_law, void (*alter)(dmb_scene *scene))
{
    rig s = {NULL, NULL}, whole = {NULL, NULL};
    dmb_field in_pieces[DMB_FIELD_MAX], at_once[DMB_FIELD_MAX];
    laws[0] = normal_law;
    laws[1] = friction_law;
    describe(&s, HOLE);
    describe(&whole, HOLE);
    begin(&s, NULL);
    begin(&whole, NULL);
    dmb_scene *scene = (dmb_scene *)(uintptr_t)whole.sim->scene;
    const dmb_scene before = *scene;
    alter(scene);
    take_divided_steps(&s, 1e-3, 7);
    take_divided_steps(&whole, 1e-3, 7);
    assert_true(contacts_of(&s).closed > 100);
    const size_t count = dmb_sim_fields(s.sim, DMB_GROUP_NOW, DMB_GROUP_NOW, in_pieces);
    assert_true(dmb_sim_fields(whole.sim, DMB_GROUP_NOW, DMB_GROUP_NOW, at_once) == count);
    for (size_t i = 0; i < count; i++)
        if (memcmp(in_pieces[i].data, at_once[i].data, in_pieces[i].bytes) != 0) fail_msg("%s", in_pieces[i].name);
    *scene = before;
    rig_close(&s);
    rig_close(&whole);
}

static void test_pieces_of_elements(void **state)
{
    (void)state;
    check_pieces(DMB_NORMAL_KELVIN_VOIGT, DMB_FRICTION_COULOMB, shorten_runs);
    check_pieces(DMB_NORMAL_HUNT_CROSSLEY, DMB_FRICTION_BRISTLE, shorten_runs);
}

static void test_pieces_of_the_wall(void **state)
{
    (void)state;
    check_pieces(DMB_NORMAL_KELVIN_VOIGT, DMB_FRICTION_COULOMB, press_rings_at_once);
    check_pieces(DMB_NORMAL_KELVIN_VOIGT, DMB_FRICTION_BRISTLE, press_rings_at_once);
    check_pieces(DMB_NORMAL_HUNT_CROSSLEY, DMB_FRICTION_BRISTLE, press_rings_at_once);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_same_bits),
                                       cmocka_unit_test(test_every_width),
                                       cmocka_unit_test(test_pieces_of_elements),
                                       cmocka_unit_test(test_pieces_of_the_wall),
                                       cmocka_unit_test(test_harmless),
                                       cmocka_unit_test(test_failures),
                                       cmocka_unit_test(test_bounds)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
