/* Every function that takes a sim: NULL, another object and a destroyed sim are refused, and the answers stay as they
 * were. */
#include "sim_test.h"

enum { ANSWER_BYTES = 256 };

/* One call of each function with a given sim and answers of `size` bytes that begin with struct_size. */
typedef int32_t call_fn(const dmb_sim *sim, void *answer);

#define SIMPLE_QUERY(type, name, ...)                            \
    static int32_t call_##name(const dmb_sim *sim, void *answer) \
    {                                                            \
        return dmb_query_##name(__VA_ARGS__, (type *)answer);    \
    }

static dmb_place somewhere;
static dmb_id something;

SIMPLE_QUERY(dmb_pose, pose, sim, somewhere)
SIMPLE_QUERY(dmb_motion, motion, sim, somewhere)
SIMPLE_QUERY(double, rotation, sim, somewhere)
SIMPLE_QUERY(dmb_section, section, sim, somewhere)
SIMPLE_QUERY(dmb_contact, contact, sim, 0)
SIMPLE_QUERY(dmb_contact_total, contact_total, sim)
SIMPLE_QUERY(double, kinetic_energy, sim, something, 0)
SIMPLE_QUERY(dmb_energy, energy, sim)
SIMPLE_QUERY(dmb_momentum, momentum, sim)
SIMPLE_QUERY(dmb_drive_state, drive, sim, something)
SIMPLE_QUERY(double, reaction, sim, something)
SIMPLE_QUERY(dmb_bit_state, bit, sim, something)
SIMPLE_QUERY(dmb_statistics, statistics, sim)

static int32_t call_hash(const dmb_sim *sim, void *answer)
{
    return dmb_sim_hash(sim, answer);
}

static int32_t call_snapshot_size(const dmb_sim *sim, void *answer)
{
    return dmb_sim_snapshot_size(sim, answer);
}

static int32_t call_snapshot(const dmb_sim *sim, void *answer)
{
    return dmb_sim_snapshot(sim, answer, ANSWER_BYTES);
}

typedef struct named_call {
    const char *name;
    call_fn *call;
    uint32_t struct_size; /* 0: a plain number or block */
} named_call;

#define QUERY(name, size)                     \
    {                                         \
        "dmb_query_" #name, call_##name, size \
    }

static const named_call calls[] = {
    QUERY(pose, sizeof(dmb_pose)),
    QUERY(motion, sizeof(dmb_motion)),
    QUERY(rotation, 0),
    QUERY(section, sizeof(dmb_section)),
    QUERY(contact, sizeof(dmb_contact)),
    QUERY(contact_total, sizeof(dmb_contact_total)),
    QUERY(kinetic_energy, 0),
    QUERY(energy, sizeof(dmb_energy)),
    QUERY(momentum, sizeof(dmb_momentum)),
    QUERY(drive, sizeof(dmb_drive_state)),
    QUERY(reaction, 0),
    QUERY(bit, sizeof(dmb_bit_state)),
    QUERY(statistics, sizeof(dmb_statistics)),
    {"dmb_sim_hash", call_hash, 0},
    {"dmb_sim_snapshot_size", call_snapshot_size, 0},
    {"dmb_sim_snapshot", call_snapshot, 0},
};
enum { CALLS = sizeof calls / sizeof calls[0] };

static void blank(unsigned char *answer, uint32_t struct_size)
{
    memset(answer, 0xEE, ANSWER_BYTES);
    if (struct_size > 0) memcpy(answer, &struct_size, sizeof struct_size);
}

static void check_refused(const dmb_sim *sim, int32_t wanted)
{
    union {
        double align;
        unsigned char bytes[ANSWER_BYTES];
    } answer, before;
    for (size_t i = 0; i < CALLS; i++) {
        blank(answer.bytes, calls[i].struct_size);
        blank(before.bytes, calls[i].struct_size);
        const int32_t status = calls[i].call(sim, answer.bytes);
        if (status != wanted) fail_msg("%s: %d, wanted %d", calls[i].name, (int)status, (int)wanted);
        if (memcmp(answer.bytes, before.bytes, ANSWER_BYTES) != 0) fail_msg("%s wrote an answer", calls[i].name);
    }
}

static void check_changing(dmb_sim *sim, int32_t wanted)
{
    dmb_recorder recorder = dmb_recorder_default();
    dmb_output output = {{{0, 0}, 0, 0, 0.0}, DMB_OUTPUT_ENERGY_ERROR, 0};
    double table[4];
    char block[64] = {0};
    recorder.output_count = 1;
    recorder.outputs = &output;
    recorder.table = table;
    recorder.capacity = 2;
    assert_int_equal(dmb_sim_step(sim, 1e-3, NULL), wanted);
    assert_int_equal(dmb_sim_advance(sim, 1e-3, NULL), wanted);
    assert_int_equal(dmb_sim_set_drive(sim, something, 1.0), wanted);
    assert_int_equal(dmb_sim_restore(sim, block, sizeof block), wanted);
    assert_int_equal(dmb_analysis_static(sim, NULL, NULL), wanted);
    assert_int_equal(dmb_recorder_take(&recorder, sim), wanted);
    assert_int_equal(recorder.row_count, 0);
    assert_int_equal(dmb_write_vtk_strings(sim, 1, "/nonexistent/x.vtp"), wanted);
    assert_true(isnan(dmb_sim_time(sim)));
    assert_non_null(dmb_sim_message(sim));
    assert_true(strlen(dmb_sim_message(sim)) > 0);
}

static void null_sim(void **state)
{
    (void)state;
    dmb_sim *sim = NULL;
    check_refused(NULL, DMB_ERR_NULL);
    check_changing(NULL, DMB_ERR_NULL);
    dmb_sim_destroy(NULL);
    dmb_sim_destroy(&sim);
}

static void another_object(void **state)
{
    (void)state;
    rig r = rig_of(&plain_rig);
    dmb_sim *wrong = (dmb_sim *)(void *)r.model;
    dmb_model_info info = dmb_model_info_default();
    check_refused(wrong, DMB_ERR_HANDLE);
    check_changing(wrong, DMB_ERR_HANDLE);
    dmb_sim_destroy(&wrong);
    assert_null(wrong);
    must(dmb_model_get_info(r.model, &info)); /* the model has lived through it */
    dmb_model_destroy(&r.model);
}

/* In the caller's block the memory outlives the sim. */
static void destroyed_sim(void **state)
{
    (void)state;
    rig r = rig_of(&plain_rig);
    dmb_sim *sim = NULL, *again;
    size_t size = 0;
    must(dmb_sim_memory_size(r.model, NULL, &size));
    void *block = malloc(size);
    assert_non_null(block);
    assert_true(dmb_sim_create_in(r.model, NULL, block, size, &sim) >= 0);
    again = sim;
    dmb_sim_destroy(&sim);
    assert_null(sim);
    check_refused(again, DMB_ERR_HANDLE);
    check_changing(again, DMB_ERR_HANDLE);
    dmb_sim_destroy(&again);
    assert_null(again);
    free(block);
    dmb_model_destroy(&r.model);
}

/* A live sim without a place for the answer. */
static void no_answer(void **state)
{
    (void)state;
    rig r = rig_of(&plain_rig);
    dmb_sim *sim = rig_sim(&r);
    for (size_t i = 0; i < CALLS; i++) assert_int_equal(calls[i].call(sim, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_sim_restore(sim, NULL, 100), DMB_ERR_NULL);
    assert_int_equal(dmb_recorder_take(NULL, sim), DMB_ERR_NULL);
    assert_int_equal(dmb_write_vtk_strings(sim, 1, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_sim_create(r.model, NULL, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_sim_memory_size(r.model, NULL, NULL), DMB_ERR_NULL);
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&r.model);
}

/* Size in the first release: structs that have grown since take callers of then. */
static uint32_t first_size_of(const named_call *of)
{
    static const struct {
        const char *name;
        uint32_t size;
    } grown[] = {{"dmb_query_contact", 120},
                 {"dmb_query_statistics", 72},
                 {"dmb_query_bit", 56},
                 {"dmb_query_drive", 56},
                 {"dmb_query_energy", 128}};
    for (size_t i = 0; i < sizeof grown / sizeof *grown; i++)
        if (strcmp(of->name, grown[i].name) == 0) return grown[i].size;
    return of->struct_size;
}

/* struct_size too short, odd or absurd. */
static void wrong_struct_sizes(void **state)
{
    (void)state;
    rig r = rig_of(&plain_rig);
    dmb_sim *sim = rig_sim(&r);
    union {
        double align;
        unsigned char bytes[ANSWER_BYTES];
    } answer, before;
    const dmb_id parts[] = {r.string, r.torque, r.bit};
    somewhere = dmb_station(r.string, 1, 0.5);
    for (size_t i = 0; i < CALLS; i++) {
        const uint32_t good = calls[i].struct_size, first = first_size_of(calls + i);
        const uint32_t sizes[] = {0, 4, first - 8, good + 4, good + 100000, UINT32_MAX};
        if (good == 0) continue;
        for (size_t k = 0; k < sizeof sizes / sizeof sizes[0]; k++) {
            int32_t status = DMB_ERR_ID;
            for (size_t p = 0; p < 3 && status == DMB_ERR_ID; p++) { /* the kind of part that the query is about */
                something = parts[p];
                blank(answer.bytes, sizes[k]);
                memcpy(answer.bytes, &sizes[k], sizeof sizes[k]);
                memcpy(before.bytes, answer.bytes, sizeof before.bytes);
                status = calls[i].call(sim, answer.bytes);
            }
            if (status != DMB_ERR_STRUCT_SIZE) fail_msg("%s, size %u: %d", calls[i].name, sizes[k], (int)status);
            assert_memory_equal(answer.bytes, before.bytes, sizeof before.bytes);
        }
    }
    something.index = something.generation = 0;
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&r.model);
}

static void wrong_models(void **state)
{
    (void)state;
    rig r;
    dmb_sim *sim = (dmb_sim *)(void *)&r;
    size_t size = 77;
    rig_describe(&r, &plain_rig);
    assert_int_equal(dmb_sim_memory_size(NULL, NULL, &size), DMB_ERR_NULL);
    assert_int_equal(dmb_sim_memory_size(r.model, NULL, &size), DMB_ERR_ORDER);
    assert_int_equal(size, 77);
    assert_int_equal(dmb_sim_create(NULL, NULL, &sim), DMB_ERR_NULL);
    assert_null(sim);
    sim = (dmb_sim *)(void *)&r;
    assert_int_equal(dmb_sim_create(r.model, NULL, &sim), DMB_ERR_ORDER);
    assert_null(sim);
    must(dmb_model_compile(r.model, NULL));
    sim = rig_sim(&r);
    dmb_sim *second = sim;
    assert_int_equal(dmb_sim_create((dmb_model *)(void *)sim, NULL, &second), DMB_ERR_HANDLE);
    assert_null(second);
    assert_int_equal(dmb_write_vtk_hole(NULL, 0.0, 1.0, 0.1, 8, "x"), DMB_ERR_NULL);
    assert_int_equal(dmb_write_vtk_hole((dmb_model *)(void *)sim, 0.0, 1.0, 0.1, 8, "x"), DMB_ERR_HANDLE);
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&r.model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(null_sim),  cmocka_unit_test(another_object),     cmocka_unit_test(destroyed_sim),
        cmocka_unit_test(no_answer), cmocka_unit_test(wrong_struct_sizes), cmocka_unit_test(wrong_models),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
