/* The modal analysis refuses bad arguments and leaves the sim alone, also when memory runs out. */
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "hash.h"
#include "scarce.h"

typedef struct scene {
    dmb_model *model;
    dmb_sim *sim;
    dmb_id string;
    scarce memory;
} scene;

/* Twelve pipes without a wall, rig end free in `free_mask`. */
static void open_scene(scene *s, int32_t free_mask, double gravity)
{
    dmb_environment_def environment = dmb_environment_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_sim_options options = dmb_sim_options_default();
    memset(s, 0, sizeof *s);
    environment.gravity[2] = -gravity;
    string.start_free = free_mask;
    const dmb_allocator allocator = scarce_allocator(&s->memory);
    options.allocator = &allocator;
    assert_int_equal(dmb_model_create(NULL, &s->model), DMB_OK);
    assert_int_equal(dmb_model_set_environment(s->model, &environment), DMB_OK);
    assert_int_equal(dmb_model_add_string(s->model, &string, &s->string), DMB_OK);
    assert_int_equal(dmb_model_add_pipes(s->model, &pipe, 12, NULL), DMB_OK);
    assert_int_equal(dmb_model_compile(s->model, NULL), DMB_OK);
    assert_int_equal(dmb_sim_create(s->model, &options, &s->sim), DMB_OK);
}

static void close_scene(scene *s)
{
    dmb_sim_destroy(&s->sim);
    dmb_model_destroy(&s->model);
    assert_int_equal(s->memory.live, 0);
}

/* ---- Nothing to move --------------------------------------------------------------------------------------------- */

/* A body that its support holds altogether, and one that a drive moves. */
static void nothing_is_free(void **state)
{
    (void)state;
    for (int driven = 0; driven < 2; driven++) {
        dmb_model *model = NULL;
        dmb_sim *sim = NULL;
        dmb_modes *modes = NULL;
        dmb_body_def body = dmb_body_def_default();
        dmb_drive_def drive = dmb_drive_def_default();
        const dmb_segment zero = dmb_segment_default();
        assert_int_equal(dmb_model_create(NULL, &model), DMB_OK);
        body.free_mask = driven ? DMB_FREE_RX : DMB_FREE_NONE;
        assert_int_equal(dmb_model_add_body(model, &body, &drive.part), DMB_OK);
        drive.component = DMB_RX;
        assert_int_equal(dmb_model_add_time_function(model, &zero, 1, &drive.time_function), DMB_OK);
        if (driven) assert_int_equal(dmb_model_add_drive(model, &drive, NULL), DMB_OK);
        assert_int_equal(dmb_model_compile(model, NULL), DMB_OK);
        assert_int_equal(dmb_sim_create(model, NULL, &sim), DMB_OK);
        const uint64_t before = hash_of(sim);
        assert_int_equal(dmb_analysis_modes(sim, NULL, &modes), DMB_ERR_VALUE);
        assert_null(modes);
        assert_non_null(strstr(dmb_sim_message(sim), "no coordinates that are free to move"));
        assert_true(hash_of(sim) == before);
        dmb_sim_destroy(&sim);
        dmb_model_destroy(&model);
    }
}

/* ---- Memory that runs out ---------------------------------------------------------------------------------------- */

static void memory_that_runs_out(void **state)
{
    (void)state;
    for (int32_t way = 0; way < 5; way++) {
        scene s;
        dmb_modes *modes = NULL;
        dmb_modes_options options = dmb_modes_options_default();
        open_scene(&s, way % 2 ? DMB_FREE_CYLINDRICAL : DMB_FREE_NONE, 0.0);
        options.kind = way < 2 ? DMB_MODES_UNDAMPED : DMB_MODES_DAMPED;
        options.select = way < 4 ? DMB_MODES_LOWEST : DMB_MODES_ALL;
        options.count = 4;
        const uint64_t hash = hash_of(s.sim);
        const size_t live = s.memory.live;
        s.memory.calls = 0;
        assert_int_equal(dmb_analysis_modes(s.sim, &options, &modes), DMB_OK);
        dmb_modes_destroy(&modes);
        const size_t calls = s.memory.calls;
        assert_true(calls > 5);
        for (s.memory.refused = 1; s.memory.refused <= calls; s.memory.refused++) {
            s.memory.calls = 0;
            assert_int_equal(dmb_analysis_modes(s.sim, &options, &modes), DMB_ERR_NO_MEMORY);
            assert_null(modes);
            assert_int_equal(s.memory.live, live);
        }
        assert_true(hash_of(s.sim) == hash);
        close_scene(&s);
    }
}

/* ---- Refusals ---------------------------------------------------------------------------------------------------- */

static void expect_refusal(dmb_sim *sim, const dmb_modes_options *options, int32_t status, const char *said)
{
    const uint64_t before = hash_of(sim);
    dmb_modes *modes = (dmb_modes *)sim;
    assert_int_equal(dmb_analysis_modes(sim, options, &modes), status);
    assert_null(modes);
    if (strstr(dmb_sim_message(sim), said) == NULL) fail_msg("%s lacks %s", dmb_sim_message(sim), said);
    assert_true(hash_of(sim) == before);
}

static void options_out_of_bounds_are_named(void **state)
{
    (void)state;
    scene s;
    open_scene(&s, DMB_FREE_NONE, 0.0);
    static const struct {
        size_t at;
        int32_t value;
        const char *field;
    } whole[] = {{offsetof(dmb_modes_options, kind), 2, "kind"},
                 {offsetof(dmb_modes_options, select), -1, "select"},
                 {offsetof(dmb_modes_options, count), 0, "count"},
                 {offsetof(dmb_modes_options, contact), 3, "contact"},
                 {offsetof(dmb_modes_options, friction), 2, "friction"},
                 {offsetof(dmb_modes_options, axes), 2, "axes"},
                 {offsetof(dmb_modes_options, struct_size), 12, "struct_size"}};
    for (size_t i = 0; i < sizeof whole / sizeof whole[0]; i++) {
        dmb_modes_options options = dmb_modes_options_default();
        memcpy((char *)&options + whole[i].at, &whole[i].value, sizeof whole[i].value);
        expect_refusal(s.sim, &options, whole[i].at == 0 ? DMB_ERR_STRUCT_SIZE : DMB_ERR_VALUE, whole[i].field);
    }
    static const struct {
        size_t at;
        const char *field;
    } numbers[] = {{offsetof(dmb_modes_options, band), "band[0]"},
                   {offsetof(dmb_modes_options, band) + 8, "band[1]"},
                   {offsetof(dmb_modes_options, spin), "spin"},
                   {offsetof(dmb_modes_options, contact_gap), "contact_gap"},
                   {offsetof(dmb_modes_options, equilibrium_tolerance), "equilibrium_tolerance"}};
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
        dmb_modes_options options = dmb_modes_options_default();
        const double below = -1e7;
        memcpy((char *)&options + numbers[i].at, &below, sizeof below);
        expect_refusal(s.sim, &options, DMB_ERR_VALUE, numbers[i].field);
        memset((char *)&options + numbers[i].at, 0xff, sizeof below); /* NaN on every compiler */
        expect_refusal(s.sim, &options, DMB_ERR_NOT_FINITE, numbers[i].field);
    }
    close_scene(&s);
}

static void what_cannot_be_had_is_said(void **state)
{
    (void)state;
    scene s;
    dmb_modes_options options = dmb_modes_options_default();
    open_scene(&s, DMB_FREE_NONE, 0.0);
    options.count = 73;
    expect_refusal(s.sim, &options, DMB_ERR_VALUE, "must be <= 72, the number of coordinates");
    options.select = DMB_MODES_BAND;
    options.band[0] = 1e-3;
    options.band[1] = 2e-3;
    expect_refusal(s.sim, &options, DMB_ERR_VALUE, "no mode in band = 0.001 .. 0.002 Hz");
    close_scene(&s);
    open_scene(&s, DMB_FREE_NONE, 9.81);
    options = dmb_modes_options_default();
    expect_refusal(s.sim, &options, DMB_ERR_VALUE, "no equilibrium: residual = 1 of the forces");
    dmb_modes *modes = NULL;
    options.equilibrium_tolerance = 2.0;
    assert_int_equal(dmb_analysis_modes(s.sim, &options, &modes), DMB_OK);
    dmb_modes_destroy(&modes);
    close_scene(&s);
}

/* ---- Handles ----------------------------------------------------------------------------------------------------- */

static void nonsense_is_refused(void **state)
{
    (void)state;
    scene s;
    dmb_modes *modes = NULL;
    dmb_mode mode = dmb_mode_default();
    dmb_modes_info info = dmb_modes_info_default();
    dmb_mode_shape shape = dmb_mode_shape_default();
    double kinetic = 0.0, strain = 0.0;
    open_scene(&s, DMB_FREE_NONE, 0.0);
    const dmb_place tip = dmb_station(s.string, 11, 1.0), beyond = dmb_station(s.string, 12, 1.0);
    const dmb_id wrong = {s.string.index, s.string.generation + 1};
    assert_int_equal(dmb_analysis_modes(NULL, NULL, &modes), DMB_ERR_NULL);
    assert_int_equal(dmb_analysis_modes(s.sim, NULL, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_analysis_modes((dmb_sim *)s.model, NULL, &modes), DMB_ERR_HANDLE);
    assert_int_equal(dmb_modes_get_info(NULL, &info), DMB_ERR_NULL);
    assert_int_equal(dmb_modes_get((dmb_modes *)s.sim, 0, &mode), DMB_ERR_HANDLE);
    assert_int_equal(dmb_analysis_modes(s.sim, NULL, &modes), DMB_OK);
    assert_int_equal(dmb_modes_get_info(modes, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_modes_get(modes, 10, &mode), DMB_ERR_VALUE);
    assert_int_equal(dmb_modes_get(modes, 0, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_modes_shape(modes, 0, beyond, &shape), DMB_ERR_VALUE);
    assert_int_equal(dmb_modes_shape(modes, 10, tip, &shape), DMB_ERR_VALUE);
    shape.frame = DMB_FRAME_HOLE;
    assert_int_equal(dmb_modes_shape(modes, 0, tip, &shape), DMB_ERR_VALUE);
    shape.struct_size = 4;
    assert_int_equal(dmb_modes_shape(modes, 0, tip, &shape), DMB_ERR_STRUCT_SIZE);
    assert_int_equal(dmb_modes_part(modes, 0, wrong, 0, &kinetic, &strain), DMB_ERR_ID);
    assert_int_equal(dmb_modes_part(modes, 0, s.string, 12, &kinetic, &strain), DMB_ERR_VALUE);
    assert_int_equal(dmb_modes_part(modes, 0, s.string, 0, &kinetic, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_write_vtk_mode(modes, 0, 1.0, 0.0, 0, "x"), DMB_ERR_VALUE);
    assert_int_equal(dmb_write_vtk_mode(modes, 0, (double)INFINITY, 0.0, 1, "x"), DMB_ERR_NOT_FINITE);
    assert_int_equal(dmb_write_vtk_mode(modes, 0, 1.0, (double)NAN, 1, "x"), DMB_ERR_NOT_FINITE);
    assert_int_equal(dmb_write_vtk_mode(modes, 0, 1.0, 0.0, 1, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_write_vtk_mode(modes, 10, 1.0, 0.0, 1, "x"), DMB_ERR_VALUE);
    assert_int_equal(dmb_write_vtk_mode(modes, 0, 1.0, 0.0, 1, "/no such folder/x"), DMB_ERR_IO);
    dmb_modes_destroy(&modes);
    assert_null(modes);
    dmb_modes_destroy(&modes);
    dmb_modes_destroy(NULL);
    close_scene(&s);
}

/* The result holds the model, and needs the sim no longer. */
static void modes_outlive_their_sim(void **state)
{
    (void)state;
    scene s;
    dmb_modes *modes = NULL;
    dmb_mode mode = dmb_mode_default();
    dmb_mode_shape shape = dmb_mode_shape_default();
    open_scene(&s, DMB_FREE_NONE, 0.0);
    assert_int_equal(dmb_analysis_modes(s.sim, NULL, &modes), DMB_OK);
    dmb_sim_destroy(&s.sim);
    dmb_model_destroy(&s.model);
    assert_int_equal(dmb_modes_get(modes, 0, &mode), DMB_OK);
    assert_int_equal(dmb_modes_shape(modes, 0, dmb_station(s.string, 5, 0.5), &shape), DMB_OK);
    assert_true(mode.frequency > 0.0);
    dmb_modes_destroy(&modes);
    close_scene(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_is_free),
        cmocka_unit_test(memory_that_runs_out),
        cmocka_unit_test(options_out_of_bounds_are_named),
        cmocka_unit_test(what_cannot_be_had_is_said),
        cmocka_unit_test(nonsense_is_refused),
        cmocka_unit_test(modes_outlive_their_sim),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
