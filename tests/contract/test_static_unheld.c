/* Statics of strings that nothing holds along or about their axis, of every kind of pipe, lying and hanging: refused,
 * the part named, the state as it was; what a support, a drive or no force at all leaves at rest is found. */
#include "sim_test.h"

enum { LYING_IN_HOLE, HANGING, PLACES };
enum { UNLOADED, PUSHED, TWISTED, LOADS };

static dmb_sim *make(int32_t kind, int place, int load, int32_t start_free, dmb_model **model)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_load_def force = dmb_load_def_default();
    const dmb_wall_def wall = dmb_wall_def_default();
    dmb_sim *sim = NULL;
    must(dmb_model_create(NULL, model));
    if (place == LYING_IN_HOLE) must(dmb_model_add_wall(*model, &wall, NULL));
    string.start_free = start_free;
    if (place == HANGING) string.follows_hole = 0, string.rotation[1] = 1.5707963267948966;
    must(dmb_model_add_string(*model, &string, &pipe.string));
    pipe.kind = kind;
    must(dmb_model_add_pipes(*model, &pipe, 4, NULL));
    force.frame = DMB_FRAME_BODY;
    force.place = dmb_station(pipe.string, 3, 1.0);
    if (load == PUSHED) force.force[0] = 100.0;
    if (load == TWISTED) force.moment[0] = 100.0;
    if (load != UNLOADED) must(dmb_model_add_load(*model, &force, NULL));
    must(dmb_model_compile(*model, NULL));
    assert_true(dmb_sim_create(*model, NULL, &sim) >= 0);
    return sim;
}

static void check(int32_t kind, int place, int load, int32_t start_free)
{
    dmb_model *model;
    dmb_sim *sim = make(kind, place, load, start_free, &model);
    const uint64_t before = hash_of(sim);
    const int along = (start_free & DMB_FREE_X) != 0 && (place == HANGING || load == PUSHED);
    const int about = (start_free & DMB_FREE_RX) != 0 && load == TWISTED;
    const int32_t status = dmb_analysis_static(sim, NULL, NULL);
    if (!along && !about) {
        if (status < 0)
            fail_msg("kind %d, place %d, load %d, free %d: %s", kind, place, load, start_free, dmb_sim_message(sim));
    } else {
        if (status >= 0) fail_msg("kind %d, place %d, load %d, free %d: at rest", kind, place, load, start_free);
        if (strstr(dmb_sim_message(sim), "string 0") == NULL ||
            strstr(dmb_sim_message(sim), "nothing holds it") == NULL)
            fail_msg("kind %d, place %d, load %d, free %d: %s", kind, place, load, start_free, dmb_sim_message(sim));
        assert_int_equal(hash_of(sim), before);
    }
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
}

static void strings_that_nothing_holds(void **state)
{
    (void)state;
    static const int32_t masks[] = {DMB_FREE_NONE, DMB_FREE_X, DMB_FREE_RX, DMB_FREE_CYLINDRICAL};
    for (int32_t kind = DMB_PIPE_FLEXIBLE; kind <= DMB_PIPE_RIGID; kind++)
        for (int place = 0; place < PLACES; place++)
            for (int load = 0; load < LOADS; load++)
                for (int i = 0; i < 4; i++) check(kind, place, load, masks[i]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(strings_that_nothing_holds)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
