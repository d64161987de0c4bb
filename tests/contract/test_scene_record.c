/* Scene records: a model that is read again has the same record and the same run to the bit, is open for changes, and
 * has its parts by name; damaged bytes are refused with a message and leave no memory behind. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "drillmbd/drillmbd.h"

#define must(call) assert_int_equal((call), DMB_OK)

/* ---- A scene with parts of all kinds that a record holds ----------------------------------------------------------
 */

static const double times[] = {0.0, 1.0, 3.0}, values[] = {1.0, 2.0, 0.5};
static const double survey[] = {0.0, 0.3, 0.0, 20.0, 0.32, 0.05, 60.0, 0.4, 0.1};
static const double elongations[] = {-0.1, 0.0, 0.2}, tensions[] = {-50.0, 0.0, 300.0};

static dmb_id add_time_function(dmb_model *model)
{
    dmb_segment segments[3] = {dmb_segment_default(), dmb_segment_default(), dmb_segment_default()};
    dmb_id id;
    segments[0].kind = DMB_SEGMENT_STEP;
    segments[0].h1 = 0.7;
    segments[1].kind = DMB_SEGMENT_TABLE;
    segments[1].table_time = times;
    segments[1].table_value = values;
    segments[1].table_count = 3;
    segments[2].kind = DMB_SEGMENT_HARMONIC;
    segments[2].h1 = 0.1;
    segments[2].omega = 7.0;
    must(dmb_model_add_time_function(model, segments, 3, &id));
    must(dmb_model_set_name(model, id, "speed"));
    return id;
}

static void add_hole(dmb_model *model)
{
    dmb_environment_def environment = dmb_environment_def_default();
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_hole_section sections[2] = {dmb_hole_section_default(), dmb_hole_section_default()};
    environment.fluid_density = 1100.0;
    environment.lateral_damping = 10.0;
    wall.survey_count = 3;
    wall.survey = survey;
    wall.friction_table_count = 2;
    wall.friction_table_speed[1] = 0.5;
    wall.friction_table_mu[0] = 0.4;
    wall.friction_table_mu[1] = 0.2;
    strcpy(wall.name, "hole");
    sections[0].diameter = 0.1;
    sections[0].depth = 5.0;
    sections[1].depth = 12.0;
    strcpy(sections[1].name, "open");
    must(dmb_model_set_environment(model, &environment));
    must(dmb_model_add_wall(model, &wall, NULL));
    must(dmb_model_add_hole_sections(model, sections, 2));
}

static dmb_sub add_strings(dmb_model *model)
{
    dmb_string_def string = dmb_string_def_default(), section = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_stabiliser_def stabiliser = dmb_stabiliser_def_default();
    dmb_sub_def def = dmb_sub_def_default();
    dmb_sub sub = dmb_sub_default();
    strcpy(string.name, "upper");
    strcpy(section.name, "lower");
    must(dmb_model_add_string(model, &string, &pipe.string));
    pipe.length = 2.0;
    pipe.joint_length = 0.2;
    pipe.eccentricity = 1e-3;
    strcpy(pipe.name, "rods");
    must(dmb_model_add_pipes(model, &pipe, 4, NULL));
    def.string = pipe.string;
    def.length = 0.5;
    def.section = &section;
    must(dmb_model_add_sub(model, &def, &sub));
    pipe.string = sub.section;
    strcpy(pipe.name, "collars");
    must(dmb_model_add_pipes(model, &pipe, 3, NULL));
    stabiliser.string = sub.section;
    stabiliser.pipe = 1;
    must(dmb_model_add_stabiliser(model, &stabiliser, NULL));
    return sub;
}

static void add_bodies(dmb_model *model)
{
    dmb_body_def body = dmb_body_def_default();
    dmb_joint_def joint = dmb_joint_def_default();
    dmb_coupling_def coupling = dmb_coupling_def_default();
    dmb_spring_def spring = dmb_spring_def_default();
    joint.kind = DMB_JOINT_REVOLUTE;
    joint.stiffness[DMB_RX] = 3.0;
    for (int i = 0; i < 2; ++i) {
        body.position[1] = joint.origin_a[1] = 5.0 + i;
        must(dmb_model_add_body(model, &body, &joint.place_b.part));
        must(dmb_model_add_joint(model, &joint, &coupling.joint[i]));
    }
    coupling.ratio = 2.0;
    must(dmb_model_add_coupling(model, &coupling, NULL));
    spring.place_b = joint.place_b;
    spring.offset_a[2] = 1.0;
    spring.table_count = 3;
    spring.table_kind = DMB_TABLE_CUBIC;
    spring.table_elongation = elongations;
    spring.table_force = tensions;
    must(dmb_model_add_spring(model, &spring, NULL));
}

static void add_actions(dmb_model *model, dmb_id time_function, const dmb_sub *sub)
{
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_bit_def bit = dmb_bit_def_default();
    dmb_load_def load = dmb_load_def_default();
    dmb_stuck_def stuck = dmb_stuck_def_default();
    dmb_input_def input = dmb_input_def_default();
    dmb_event_def event = dmb_event_def_default();
    bit.string = sub->section;
    bit.rock_law = DMB_ROCK_REGENERATIVE;
    bit.bottom = 0.5;
    must(dmb_model_add_bit(model, &bit, NULL));
    drive.kind = DMB_DRIVE_CONTROL;
    drive.component = DMB_RX;
    drive.time_function = time_function;
    drive.gain_count = 2;
    drive.gain_error[1] = 1.0;
    drive.gain_force[1] = 500.0;
    drive.lag = 0.1;
    strcpy(drive.name, "table");
    must(dmb_model_add_drive(model, &drive, &input.part));
    load.place = dmb_station(sub->body, 0, 0.0);
    load.force[0] = 100.0;
    must(dmb_model_add_load(model, &load, NULL));
    stuck.place = dmb_station(sub->section, 1, 0.7);
    stuck.stuck = 0;
    must(dmb_model_add_stuck(model, &stuck, NULL));
    strcpy(input.name, "speed of the table");
    must(dmb_model_add_input(model, &input, NULL));
    strcpy(event.name, "slow");
    event.output.quantity = DMB_OUTPUT_SPIN;
    event.output.place = dmb_station(sub->body, 0, 0.0);
    event.level = 0.3;
    must(dmb_model_add_event(model, &event, NULL));
}

static dmb_model *describe(void)
{
    dmb_model *model = NULL;
    must(dmb_model_create(NULL, &model));
    const dmb_id time_function = add_time_function(model);
    add_hole(model);
    const dmb_sub sub = add_strings(model);
    add_bodies(model);
    add_actions(model, time_function, &sub);
    return model;
}

static unsigned char *record_of(const dmb_model *model, size_t *size)
{
    must(dmb_model_write(model, NULL, 0, size));
    unsigned char *bytes = malloc(*size);
    assert_non_null(bytes);
    must(dmb_model_write(model, bytes, *size, size));
    return bytes;
}

static dmb_model *read_back(const unsigned char *bytes, size_t size)
{
    dmb_model *model = NULL;
    const int32_t status = dmb_model_read(bytes, size, NULL, &model);
    dmb_error error = dmb_error_default();
    must(dmb_last_error(&error));
    if (status != DMB_OK) fail_msg("%s: %s", dmb_status_name(status), error.message);
    return model;
}

static uint64_t run(dmb_model *model)
{
    dmb_sim *sim = NULL;
    uint64_t hash = 0;
    if (dmb_model_compile(model, NULL) < 0) fail_msg("%s", dmb_model_message(model));
    if (dmb_sim_create(model, NULL, &sim) < 0) fail_msg("%s", dmb_model_message(model));
    for (int i = 0; i < 20; ++i) assert_true(dmb_sim_step(sim, 1e-3, NULL) >= 0);
    must(dmb_sim_hash(sim, &hash));
    dmb_sim_destroy(&sim);
    return hash;
}

/* ---- Round trips --------------------------------------------------------------------------------------------------
 */

static void same_record_and_run(void **state)
{
    dmb_model *model = describe();
    size_t size, again;
    (void)state;
    unsigned char *bytes = record_of(model, &size);
    dmb_model *copy = read_back(bytes, size);
    unsigned char *second = record_of(copy, &again);
    assert_int_equal(again, size);
    assert_memory_equal(bytes, second, size);
    assert_true(run(copy) == run(model));
    unsigned char *compiled = record_of(model, &again); /* of a compiled model too */
    assert_int_equal(again, size);
    assert_memory_equal(bytes, compiled, size);
    free(bytes);
    free(second);
    free(compiled);
    dmb_model_destroy(&copy);
    dmb_model_destroy(&model);
}

static void open_for_changes(void **state)
{
    dmb_model *model = describe(), *copy;
    dmb_pipe_def pipe = dmb_pipe_def_default();
    size_t size;
    uint32_t first, count;
    (void)state;
    unsigned char *bytes = record_of(model, &size);
    copy = read_back(bytes, size);
    must(dmb_model_find(copy, DMB_PART_STRING, "lower", &pipe.string));
    must(dmb_model_find_pipes(copy, "collars", NULL, &first, &count));
    assert_int_equal(first, 0);
    assert_int_equal(count, 3);
    dmb_id id, same;
    must(dmb_model_find(copy, DMB_PART_TIME_FUNCTION, "speed", &id));
    must(dmb_model_find(copy, DMB_PART_ANY, "table", &id));
    must(dmb_model_part(copy, id.index, &same));
    assert_true(dmb_id_equal(id, same));
    assert_int_equal(dmb_model_part(copy, id.index + 1, &same), DMB_ERR_ID);
    assert_int_equal(dmb_model_part(copy, 0, &same), DMB_ERR_ID);
    assert_true(dmb_id_equal(id, same));
    must(dmb_model_find(copy, DMB_PART_STRING, "upper", &pipe.string));
    assert_int_equal(dmb_model_add_pipes(copy, &pipe, 1, NULL), DMB_ERR_ORDER); /* a sub continues it */
    must(dmb_model_clear_refused(copy));
    must(dmb_model_set_name(copy, id, "top drive"));
    must(dmb_model_compile(copy, NULL));
    free(bytes);
    dmb_model_destroy(&copy);
    dmb_model_destroy(&model);
}

static int32_t plain(void *context, double time, double out[3])
{
    (void)context;
    out[0] = time;
    return 0;
}

static void refused_models(void **state)
{
    dmb_model *model = describe();
    dmb_segment segment = dmb_segment_default();
    dmb_body_def body = dmb_body_def_default();
    size_t size = 7;
    unsigned char bytes[100] = {5, 5};
    (void)state;
    assert_int_equal(dmb_model_write(model, bytes, sizeof bytes, &size), DMB_ERR_TOO_LARGE);
    assert_non_null(strstr(dmb_model_message(model), "room = 100 bytes, must be >= "));
    assert_true(size == 7 && bytes[0] == 5 && bytes[1] == 5 && bytes[99] == 0); /* a failing call changes nothing */
    body.mass = -1.0;
    assert_int_equal(dmb_model_add_body(model, &body, NULL), DMB_ERR_VALUE);
    assert_int_equal(dmb_model_write(model, NULL, 0, &size), DMB_ERR_VALUE);
    assert_non_null(strstr(dmb_model_message(model), "mass = -1"));
    must(dmb_model_clear_refused(model));
    segment.kind = DMB_SEGMENT_CALLBACK;
    segment.callback = plain;
    must(dmb_model_add_time_function(model, &segment, 1, NULL));
    assert_int_equal(dmb_model_write(model, bytes, sizeof bytes, &size), DMB_ERR_UNSUPPORTED);
    assert_true(size == 7 && bytes[50] == 0);
    assert_non_null(strstr(dmb_model_message(model), "segment 0 of time function 1 is a function of the caller"));
    assert_int_equal(dmb_model_write(NULL, NULL, 0, &size), DMB_ERR_NULL);
    assert_int_equal(dmb_model_write(model, NULL, 0, NULL), DMB_ERR_NULL);
    dmb_model_destroy(&model);
}

/* ---- Damage -------------------------------------------------------------------------------------------------------
 */

static size_t held; /* [byte] by the allocator below */

static void *take(void *context, size_t size, size_t alignment)
{
    (void)context;
    held += size;
    return aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}

static void give(void *context, void *block, size_t size, size_t alignment)
{
    (void)context, (void)alignment;
    held -= size;
    free(block);
}

/* The checksum by a table of bytes, where the library has it bit by bit. */
static uint32_t checksum(const unsigned char *bytes, size_t size)
{
    static uint32_t table[256];
    uint32_t rest = UINT32_MAX;
    for (uint32_t i = 0; i < 256 && table[255] == 0; ++i) {
        uint32_t c = i;
        for (int k = 0; k < 8; ++k) c = c & 1 ? UINT32_C(0xEDB88320) ^ (c >> 1) : c >> 1;
        table[i] = c;
    }
    for (size_t i = 0; i < size; ++i)
        if (i < 24 || i >= 28) rest = table[(rest ^ bytes[i]) & 255] ^ (rest >> 8);
    return ~rest;
}

static void put(unsigned char *at, uint64_t value, int width)
{
    for (int i = 0; i < width; ++i) at[i] = (unsigned char)(value >> 8 * i);
}

static uint32_t random_word(void)
{
    static uint64_t s = 88172645463325252u; /* xorshift, Marsaglia 2003 */
    s ^= s << 13;
    s ^= s >> 7;
    s ^= s << 17;
    return (uint32_t)(s >> 16);
}

/* 1: read all the same; 0: refused, with a reason. Nothing is left behind either way. */
static int try_to_read(const unsigned char *bytes, size_t size)
{
    dmb_allocator allocator = dmb_allocator_default();
    dmb_model_options options = dmb_model_options_default();
    dmb_model *model = (dmb_model *)(void *)&allocator; /* no model: it is written */
    allocator.allocate = take;
    allocator.release = give;
    options.allocator = &allocator;
    const int32_t status = dmb_model_read(bytes, size, &options, &model);
    dmb_error error = dmb_error_default();
    assert_true((status >= 0) == (model != NULL));
    if (status < 0) {
        must(dmb_last_error(&error));
        assert_int_equal(error.status, status);
        assert_non_null(strstr(error.message, "scene record: "));
    }
    dmb_model_destroy(&model);
    assert_int_equal(held, 0);
    return status >= 0;
}

static void damage_is_found(void **state)
{
    dmb_model *model = describe();
    size_t size;
    (void)state;
    unsigned char *bytes = record_of(model, &size);
    assert_true(try_to_read(bytes, size));
    for (size_t cut = 0; cut < size; cut += 1 + random_word() % 97) {
        unsigned char *part = malloc(cut + 1); /* a checker sees a read beyond it */
        memcpy(part, bytes, cut);
        assert_false(try_to_read(part, cut));
        free(part);
    }
    for (int i = 0; i < 2000; ++i) { /* one bit: the checksum finds each */
        const size_t at = random_word() % size;
        const unsigned char bit = (unsigned char)(1u << random_word() % 8);
        bytes[at] ^= bit;
        assert_false(try_to_read(bytes, size));
        bytes[at] ^= bit;
    }
    free(bytes);
    dmb_model_destroy(&model);
    assert_int_equal(dmb_model_read(NULL, 0, NULL, &model), DMB_ERR_NULL);
}

/* Bytes with a right checksum and nonsense in them. Some are another scene, which is read. */
static void nonsense_is_refused(void **state)
{
    static const uint32_t words[] = {0, 1, 2, 21, 22, 64, 65, 1000, 1001, 1u << 20, 0x7fffffff, 0x80000000, UINT32_MAX};
    dmb_model *model = describe();
    size_t size;
    int read = 0, tries = 6000;
    (void)state;
    unsigned char *bytes = record_of(model, &size), *other = malloc(size);
    dmb_model_destroy(&model);
    for (int i = 0; i < tries; ++i) {
        const size_t cut = random_word() % 4 == 0 ? 32 + random_word() % (size - 32) : size;
        memcpy(other, bytes, cut);
        for (uint32_t k = random_word() % 3; k > 0 || cut == size; --k) {
            const size_t at = 32 + random_word() % (cut - 31);
            const int width = random_word() % 2 == 0 ? 1 : 4;
            const uint32_t value = random_word() % 2 ? words[random_word() % 13] : random_word();
            if (at + 4 <= cut) put(other + at, value, width);
            if (k == 0) break;
        }
        put(other + 16, cut, 8);
        put(other + 24, checksum(other, cut), 4);
        read += try_to_read(other, cut);
    }
    assert_in_range(read, 1, tries / 2); /* both happen */
    put(other + 8, 2, 4);
    put(other + 16, size, 8);
    memcpy(other + 32, bytes + 32, size - 32);
    put(other + 24, checksum(other, size), 4);
    assert_int_equal(dmb_model_read(other, size, NULL, &model), DMB_ERR_UNSUPPORTED); /* a newer version */
    free(bytes);
    free(other);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(same_record_and_run), cmocka_unit_test(open_for_changes),    cmocka_unit_test(refused_models),
        cmocka_unit_test(damage_is_found),     cmocka_unit_test(nonsense_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
