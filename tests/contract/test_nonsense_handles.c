/* Objects that are none: every public function refuses NULL, an object of the other kind, memory that never was one and
 * one that has been destroyed, and it refuses NULL for what it has to read or write. */
#include <stdlib.h>

#include "whole_scene.h"

/* ---- Every function of a sim, and every one of a model ----------------------------------------------------------- */

static struct {
    whole_parts parts;
    dmb_model *model;
    dmb_sim *sim;
    dmb_place place;
    uint64_t block[512];
} scene;

/* A call with all else in order, or with the pointer it needs missing: optional pointers count as not needed. */
typedef int32_t (*sim_call)(dmb_sim *sim, int missing);
typedef int32_t (*model_call)(dmb_model *model, int missing);

#define GIVEN(pointer) (missing ? NULL : (pointer))

static int32_t sim_step(dmb_sim *sim, int missing)
{
    return missing ? DMB_ERR_NULL : dmb_sim_step(sim, 1e-3, NULL); /* the report is optional */
}
static int32_t sim_advance(dmb_sim *sim, int missing)
{
    return missing ? DMB_ERR_NULL : dmb_sim_advance(sim, dmb_sim_time(scene.sim) + 1e-3, NULL);
}
static int32_t sim_set_drive(dmb_sim *sim, int missing)
{
    return missing ? DMB_ERR_NULL : dmb_sim_set_drive(sim, scene.parts.turning, 1.0);
}
static int32_t sim_set_joint(dmb_sim *sim, int missing)
{
    return missing ? DMB_ERR_NULL : dmb_sim_set_joint(sim, scene.parts.hinge, DMB_JOINT_LOCKED);
}
static int32_t sim_transfer_state(dmb_sim *sim, int missing)
{
    return dmb_sim_transfer_state(sim, GIVEN(scene.sim));
}
static int32_t sim_static(dmb_sim *sim, int missing)
{
    return missing ? DMB_ERR_NULL : dmb_analysis_static(sim, NULL, NULL);
}
static int32_t sim_snapshot_size(dmb_sim *sim, int missing)
{
    size_t size;
    return dmb_sim_snapshot_size(sim, GIVEN(&size));
}
static int32_t sim_snapshot(dmb_sim *sim, int missing)
{
    static unsigned char snapshot[1 << 18];
    return dmb_sim_snapshot(sim, GIVEN(snapshot), sizeof snapshot);
}
static int32_t sim_restore(dmb_sim *sim, int missing)
{
    return dmb_sim_restore(sim, GIVEN(scene.block), sizeof scene.block);
}
static int32_t sim_hash(dmb_sim *sim, int missing)
{
    uint64_t hash;
    return dmb_sim_hash(sim, GIVEN(&hash));
}
static int32_t query_pose(dmb_sim *sim, int missing)
{
    dmb_pose answer = dmb_pose_default();
    return dmb_query_pose(sim, scene.place, GIVEN(&answer));
}
static int32_t query_motion(dmb_sim *sim, int missing)
{
    dmb_motion answer = dmb_motion_default();
    return dmb_query_motion(sim, scene.place, GIVEN(&answer));
}
static int32_t query_rotation(dmb_sim *sim, int missing)
{
    double answer;
    return dmb_query_rotation(sim, scene.place, GIVEN(&answer));
}
static int32_t query_section(dmb_sim *sim, int missing)
{
    dmb_section answer = dmb_section_default();
    return dmb_query_section(sim, scene.place, GIVEN(&answer));
}
static int32_t query_contact(dmb_sim *sim, int missing)
{
    dmb_contact answer = dmb_contact_default();
    return dmb_query_contact(sim, 0, GIVEN(&answer));
}
static int32_t query_hole_now(dmb_sim *sim, int missing)
{
    dmb_hole_point answer = dmb_hole_point_default();
    return dmb_query_hole_now(sim, 1.0, GIVEN(&answer));
}
static int32_t query_contact_total(dmb_sim *sim, int missing)
{
    dmb_contact_total answer = dmb_contact_total_default();
    return dmb_query_contact_total(sim, GIVEN(&answer));
}
static int32_t query_kinetic_energy(dmb_sim *sim, int missing)
{
    double answer;
    return dmb_query_kinetic_energy(sim, scene.parts.string, 0, GIVEN(&answer));
}
static int32_t query_energy(dmb_sim *sim, int missing)
{
    dmb_energy answer = dmb_energy_default();
    return dmb_query_energy(sim, GIVEN(&answer));
}
static int32_t query_momentum(dmb_sim *sim, int missing)
{
    dmb_momentum answer = dmb_momentum_default();
    return dmb_query_momentum(sim, GIVEN(&answer));
}
static int32_t query_drive(dmb_sim *sim, int missing)
{
    dmb_drive_state answer = dmb_drive_state_default();
    return dmb_query_drive(sim, scene.parts.feed, GIVEN(&answer));
}
static int32_t query_reaction(dmb_sim *sim, int missing)
{
    double answer[6];
    return dmb_query_reaction(sim, scene.parts.string, GIVEN(answer));
}
static int32_t query_joint(dmb_sim *sim, int missing)
{
    dmb_joint_state answer = dmb_joint_state_default();
    return dmb_query_joint(sim, scene.parts.hinge, GIVEN(&answer));
}
static int32_t query_multipliers(dmb_sim *sim, int missing)
{
    double answer[6];
    uint32_t count;
    return dmb_query_multipliers(sim, scene.parts.hinge, GIVEN(answer), &count);
}
static int32_t query_multiplier_count(dmb_sim *sim, int missing)
{
    double answer[6];
    uint32_t count;
    return dmb_query_multipliers(sim, scene.parts.hinge, answer, GIVEN(&count));
}
static int32_t query_bit(dmb_sim *sim, int missing)
{
    dmb_bit_state answer = dmb_bit_state_default();
    return dmb_query_bit(sim, scene.parts.bit, GIVEN(&answer));
}
static int32_t query_statistics(dmb_sim *sim, int missing)
{
    dmb_statistics answer = dmb_statistics_default();
    return dmb_query_statistics(sim, GIVEN(&answer));
}
static int32_t recorder_take(dmb_sim *sim, int missing)
{
    static whole_answers answers;
    whole_answers_init(&answers, &scene.parts);
    return dmb_recorder_take(GIVEN(&answers.recorder), sim);
}
static int32_t write_vtk_strings(dmb_sim *sim, int missing)
{
    return dmb_write_vtk_strings(sim, 2, GIVEN("/dev/null"));
}

static int32_t profile_recorder_take(dmb_sim *sim, int missing)
{
    dmb_profile profile = dmb_profile_default();
    dmb_profile_recorder recorder = dmb_profile_recorder_default();
    int32_t quantity = DMB_PROFILE_AXIAL_FORCE;
    double table[64];
    profile.quantities = &quantity;
    profile.quantity_count = 1;
    profile.station_count = 2;
    recorder.profile = &profile;
    recorder.table = GIVEN(table);
    recorder.capacity = 8;
    return dmb_profile_recorder_take(&recorder, sim);
}
static int32_t fatigue_create(dmb_sim *sim, int missing)
{
    dmb_fatigue_options options = dmb_fatigue_options_default();
    dmb_fatigue *made = NULL;
    options.curve_stress = 1e8;
    options.slope = 5.0;
    const int32_t status = dmb_fatigue_create(sim, &options, GIVEN(&scene.place), 1, &made);
    assert_null(made);
    return status;
}
static int32_t window_create(dmb_sim *sim, int missing)
{
    const dmb_output output = {.place = scene.place, .quantity = DMB_OUTPUT_POSITION_Y};
    dmb_window *made = NULL;
    const int32_t status = dmb_window_create(sim, NULL, GIVEN(&output), 1, &made);
    assert_null(made);
    return status;
}
static int32_t sensitivity_create(dmb_sim *sim, int missing)
{
    const dmb_parameter parameter = dmb_parameter_default();
    dmb_sensitivity *made = NULL;
    const int32_t status = dmb_sensitivity_create(sim, GIVEN(&parameter), 1, &made);
    assert_null(made);
    return status;
}

static const struct {
    const char *name;
    sim_call call;
} sim_calls[] = {{"step", sim_step},
                 {"advance", sim_advance},
                 {"set_drive", sim_set_drive},
                 {"set_joint", sim_set_joint},
                 {"transfer_state", sim_transfer_state},
                 {"static", sim_static},
                 {"snapshot_size", sim_snapshot_size},
                 {"snapshot", sim_snapshot},
                 {"restore", sim_restore},
                 {"hash", sim_hash},
                 {"pose", query_pose},
                 {"motion", query_motion},
                 {"rotation", query_rotation},
                 {"section", query_section},
                 {"contact", query_contact},
                 {"contact_total", query_contact_total},
                 {"hole_now", query_hole_now},
                 {"kinetic_energy", query_kinetic_energy},
                 {"energy", query_energy},
                 {"momentum", query_momentum},
                 {"drive", query_drive},
                 {"reaction", query_reaction},
                 {"joint", query_joint},
                 {"multipliers", query_multipliers},
                 {"multiplier count", query_multiplier_count},
                 {"bit", query_bit},
                 {"statistics", query_statistics},
                 {"recorder_take", recorder_take},
                 {"profile_recorder_take", profile_recorder_take},
                 {"fatigue_create", fatigue_create},
                 {"window_create", window_create},
                 {"sensitivity_create", sensitivity_create},
                 {"write_vtk_strings", write_vtk_strings}};
enum { SIM_CALLS = sizeof sim_calls / sizeof sim_calls[0] };

#define ADD(name, type)                                        \
    static int32_t add_##name(dmb_model *model, int missing)   \
    {                                                          \
        const dmb_##type def = dmb_##type##_default();         \
        return dmb_model_add_##name(model, GIVEN(&def), NULL); \
    }
ADD(wall, wall_def)
ADD(string, string_def)
ADD(body, body_def)
ADD(bit, bit_def)
ADD(stabiliser, stabiliser_def)
ADD(drive, drive_def)
ADD(load, load_def)
ADD(joint, joint_def)
ADD(coupling, coupling_def)
ADD(constraint, constraint_def)

static int32_t set_environment(dmb_model *model, int missing)
{
    const dmb_environment_def def = dmb_environment_def_default();
    return dmb_model_set_environment(model, GIVEN(&def));
}
static int32_t add_time_function(dmb_model *model, int missing)
{
    const dmb_segment term = dmb_segment_default();
    return dmb_model_add_time_function(model, GIVEN(&term), 1, NULL);
}
static int32_t add_hole_sections(dmb_model *model, int missing)
{
    const dmb_hole_section section = dmb_hole_section_default();
    return dmb_model_add_hole_sections(model, GIVEN(&section), 1);
}
static int32_t add_pipes(dmb_model *model, int missing)
{
    const dmb_pipe_def def = dmb_pipe_def_default();
    return dmb_model_add_pipes(model, GIVEN(&def), 1, NULL);
}
static int32_t compile(dmb_model *model, int missing)
{
    return missing ? DMB_ERR_NULL : dmb_model_compile(model, NULL);
}
static int32_t get_info(dmb_model *model, int missing)
{
    dmb_model_info info = dmb_model_info_default();
    return dmb_model_get_info(model, GIVEN(&info));
}
static int32_t memory_size(dmb_model *model, int missing)
{
    size_t size;
    return dmb_sim_memory_size(model, NULL, GIVEN(&size));
}
static int32_t create_sim(dmb_model *model, int missing)
{
    dmb_sim *sim = scene.sim; /* must become NULL */
    const int32_t status = dmb_sim_create(model, NULL, GIVEN(&sim));
    if (!missing && status < 0) assert_null(sim);
    if (status >= 0) dmb_sim_destroy(&sim);
    return status;
}
static int32_t create_sim_in(dmb_model *model, int missing)
{
    dmb_sim *sim = scene.sim;
    const int32_t status = dmb_sim_create_in(model, NULL, GIVEN(scene.block), sizeof scene.block, &sim);
    if (status < 0) assert_null(sim);
    return status;
}
static int32_t write_vtk_hole(dmb_model *model, int missing)
{
    return dmb_write_vtk_hole(model, 0.0, 1.0, 0.5, 8, GIVEN("/dev/null"));
}

static const struct {
    const char *name;
    model_call call;
    int describes; /* refused with DMB_ERR_ORDER once the model is compiled */
} model_calls[] = {{"set_environment", set_environment, 1},
                   {"add_time_function", add_time_function, 1},
                   {"add_wall", add_wall, 1},
                   {"add_hole_sections", add_hole_sections, 1},
                   {"add_string", add_string, 1},
                   {"add_pipes", add_pipes, 1},
                   {"add_body", add_body, 1},
                   {"add_bit", add_bit, 1},
                   {"add_stabiliser", add_stabiliser, 1},
                   {"add_drive", add_drive, 1},
                   {"add_load", add_load, 1},
                   {"add_joint", add_joint, 1},
                   {"add_coupling", add_coupling, 1},
                   {"add_constraint", add_constraint, 1},
                   {"compile", compile, 1},
                   {"get_info", get_info, 0},
                   {"memory_size", memory_size, 0},
                   {"create", create_sim, 0},
                   {"create_in", create_sim_in, 0},
                   {"write_vtk_hole", write_vtk_hole, 0}};
enum { MODEL_CALLS = sizeof model_calls / sizeof model_calls[0] };

/* ---- Fixture ----------------------------------------------------------------------------------------------------- */

static int set_up(void **state)
{
    (void)state;
    memset(&scene, 0, sizeof scene);
    scene.model = whole_model(&scene.parts);
    scene.sim = whole_sim(scene.model, NULL);
    scene.place = dmb_station(scene.parts.string, 3, 0.5);
    whole_run(scene.sim, 5, 1e-3);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    dmb_sim_destroy(&scene.sim);
    dmb_model_destroy(&scene.model);
    return 0;
}

static void all_sim_calls_say(dmb_sim *sim, int32_t wanted)
{
    for (size_t i = 0; i < SIM_CALLS; i++) {
        const int32_t status = sim_calls[i].call(sim, 0);
        if (status != wanted)
            fail_msg("%s: %s, wanted %s", sim_calls[i].name, dmb_status_name(status), dmb_status_name(wanted));
    }
    assert_true(isnan(dmb_sim_time(sim)));
    assert_string_equal(dmb_sim_message(sim), dmb_status_text(wanted));
}

static void all_model_calls_say(dmb_model *model, int32_t wanted)
{
    for (size_t i = 0; i < MODEL_CALLS; i++) {
        const int32_t status = model_calls[i].call(model, 0);
        if (status != wanted)
            fail_msg("%s: %s, wanted %s", model_calls[i].name, dmb_status_name(status), dmb_status_name(wanted));
    }
    assert_string_equal(dmb_model_message(model), dmb_status_text(wanted));
}

/* An object of one kind where another belongs, without the compiler's warning. */
static dmb_sim *as_sim(void *object)
{
    return object;
}

static dmb_model *as_model(void *object)
{
    return object;
}

/* ---- Tests ------------------------------------------------------------------------------------------------------- */

static void null_is_refused(void **state)
{
    (void)state;
    all_sim_calls_say(NULL, DMB_ERR_NULL);
    all_model_calls_say(NULL, DMB_ERR_NULL);
}

static void other_kind_is_refused(void **state)
{
    (void)state;
    const uint64_t before = whole_hash(scene.sim);
    all_sim_calls_say(as_sim(scene.model), DMB_ERR_HANDLE);
    all_model_calls_say(as_model(scene.sim), DMB_ERR_HANDLE);
    assert_true(whole_hash(scene.sim) == before);
}

static void any_memory_is_refused(void **state)
{
    static uint64_t memory[64];
    (void)state;
    for (int fill = 0; fill < 256; fill += 51) {
        memset(memory, fill, sizeof memory);
        all_sim_calls_say(as_sim(memory), DMB_ERR_HANDLE);
        all_model_calls_say(as_model(memory), DMB_ERR_HANDLE);
    }
}

/* A sim in the caller's block leaves its stamp there when it goes. */
static void destroyed_sim_is_refused(void **state)
{
    size_t size = 0;
    dmb_sim *sim = NULL, *stale;
    (void)state;
    assert_int_equal(dmb_sim_memory_size(scene.model, NULL, &size), DMB_OK);
    void *block = malloc(size);
    assert_true(dmb_sim_create_in(scene.model, NULL, block, size, &sim) >= 0);
    stale = sim;
    dmb_sim_destroy(&sim);
    assert_null(sim);
    all_sim_calls_say(stale, DMB_ERR_HANDLE);
    dmb_sim_destroy(&stale); /* once more does nothing */
    assert_null(stale);
    free(block);
}

static void missing_pointer_is_refused(void **state)
{
    (void)state;
    const uint64_t before = whole_hash(scene.sim);
    for (size_t i = 0; i < SIM_CALLS; i++) {
        const int32_t status = sim_calls[i].call(scene.sim, 1);
        if (status != DMB_ERR_NULL) fail_msg("%s: %s", sim_calls[i].name, dmb_status_name(status));
    }
    assert_true(whole_hash(scene.sim) == before);
}

/* In a model that may still be described, and in a compiled one, where describing comes first in saying no. */
static void missing_pointer_is_refused_by_models(void **state)
{
    whole_parts parts;
    dmb_model *open = whole_model_until(&parts, 0);
    (void)state;
    for (size_t i = 0; i < MODEL_CALLS; i++) {
        const int32_t described = model_calls[i].call(scene.model, 1);
        const int described_wanted = model_calls[i].describes ? DMB_ERR_ORDER : DMB_ERR_NULL;
        if (model_calls[i].call == compile) continue; /* its options are optional */
        if (described != described_wanted) fail_msg("%s: %s", model_calls[i].name, dmb_status_name(described));
        if (!model_calls[i].describes) continue;
        if (model_calls[i].call(open, 1) != DMB_ERR_NULL) fail_msg("%s", model_calls[i].name);
        assert_true(dmb_model_message(open)[0] != '\0');
    }
    dmb_model_destroy(&open);
}

/* The refusal is that of the calling thread; the model, which others may be reading, stays as it is. */
static void compiled_model_is_frozen(void **state)
{
    (void)state;
    for (size_t i = 0; i < MODEL_CALLS; i++) {
        if (!model_calls[i].describes) continue;
        assert_int_equal(model_calls[i].call(scene.model, 0), DMB_ERR_ORDER);
        assert_non_null(strstr(dmb_model_message(scene.model), "the model is compiled"));
    }
}

static void model_that_is_not_compiled_makes_no_sim(void **state)
{
    whole_parts parts;
    dmb_model *open = whole_model_until(&parts, WHOLE_CALLS - 1);
    (void)state;
    for (size_t i = 0; i < MODEL_CALLS; i++) {
        if (model_calls[i].describes) continue;
        const int32_t status = model_calls[i].call(open, 0);
        if (status != DMB_ERR_ORDER) fail_msg("%s: %s", model_calls[i].name, dmb_status_name(status));
    }
    dmb_model_destroy(&open);
}

static void destroying_nothing_does_nothing(void **state)
{
    dmb_model *model = NULL;
    dmb_sim *sim = NULL;
    (void)state;
    dmb_model_destroy(NULL);
    dmb_sim_destroy(NULL);
    dmb_model_destroy(&model);
    dmb_sim_destroy(&sim);
    model = as_model(scene.sim); /* not a model: left alone, but no longer pointed at */
    dmb_model_destroy(&model);
    assert_null(model);
    sim = as_sim(scene.model);
    dmb_sim_destroy(&sim);
    assert_null(sim);
    whole_run(scene.sim, 1, 1e-3);
}

static void create_needs_somewhere_to_put_it(void **state)
{
    (void)state;
    assert_int_equal(dmb_model_create(NULL, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_sim_create(scene.model, NULL, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_sim_create_in(scene.model, NULL, scene.block, sizeof scene.block, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_recorder_write_csv(NULL, NULL, "/dev/null"), DMB_ERR_NULL);
}

/* Names of statuses, known and not. */
static void every_status_has_a_name(void **state)
{
    static const int32_t unknown[] = {100, 1000, -100, -999, -1000, INT32_MAX, INT32_MIN};
    (void)state;
#define CHECK_NAME(name, value, text)                   \
    assert_string_equal(dmb_status_name(value), #name); \
    assert_string_equal(dmb_status_text(value), text);
    DMB_STATUS_LIST(CHECK_NAME)
#undef CHECK_NAME
    for (size_t i = 0; i < sizeof unknown / sizeof unknown[0]; i++) {
        assert_string_equal(dmb_status_name(unknown[i]), "DMB_UNKNOWN");
        assert_true(dmb_status_text(unknown[i])[0] != '\0');
    }
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(null_is_refused),
        TEST(other_kind_is_refused),
        TEST(any_memory_is_refused),
        TEST(destroyed_sim_is_refused),
        TEST(missing_pointer_is_refused),
        TEST(missing_pointer_is_refused_by_models),
        TEST(compiled_model_is_frozen),
        TEST(model_that_is_not_compiled_makes_no_sim),
        TEST(destroying_nothing_does_nothing),
        TEST(create_needs_somewhere_to_put_it),
        TEST(every_status_has_a_name),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
