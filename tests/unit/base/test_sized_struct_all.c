/* Every struct of the public headers, as the library reads those of its callers and writes answers into them: a struct
 * of this header and of the first one are read whole and as far as they go, another size is refused and nothing is
 * written; an answer stops at the caller's size. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "base/sized_struct.h"
#include "drillmbd/drillmbd.h"

/* Name, and size in the first header that had it. */
#define STRUCTS(X)              \
    X(allocator, 32)            \
    X(bit_def, 136)             \
    X(bit_state, 56)            \
    X(body_def, 216)            \
    X(buckling_info, 56)        \
    X(buckling_options, 64)     \
    X(check_report, 192)        \
    X(compile_options, 16)      \
    X(constraint_def, 160)      \
    X(contact, 120)             \
    X(contact_total, 40)        \
    X(coupling_def, 64)         \
    X(drive_def, 80)            \
    X(drive_state, 56)          \
    X(energy, 128)              \
    X(environment_def, 64)      \
    X(event_def, 88)            \
    X(event_report, 40)         \
    X(fatigue_options, 72)      \
    X(fatigue_result, 80)       \
    X(flow_state, 96)           \
    X(force_def, 296)           \
    X(hole_point, 120)          \
    X(hole_section, 104)        \
    X(excitation, 56)           \
    X(input_def, 88)            \
    X(input_info, 96)           \
    X(input_state, 40)          \
    X(joint_def, 656)           \
    X(joint_state, 272)         \
    X(load_def, 88)             \
    X(mode, 128)                \
    X(mode_shape, 104)          \
    X(model_info, 72)           \
    X(model_options, 48)        \
    X(modes_info, 48)           \
    X(modes_options, 56)        \
    X(momentum, 88)             \
    X(motion, 104)              \
    X(motor, 32)                \
    X(operation, 40)            \
    X(order, 72)                \
    X(parameter, 56)            \
    X(path_options, 136)        \
    X(path_point, 56)           \
    X(path_report, 56)          \
    X(pipe_def, 264)            \
    X(pose, 136)                \
    X(profile, 64)              \
    X(profile_recorder, 48)     \
    X(recorder, 48)             \
    X(response_options, 72)     \
    X(stabiliser_def, 96)       \
    X(row, 32)                  \
    X(section, 104)             \
    X(sim_options, 96)          \
    X(speed_band, 56)           \
    X(speeds_options, 80)       \
    X(speeds_report, 24)        \
    X(spring_def, 184)          \
    X(spring_state, 136)        \
    X(state_space_info, 56)     \
    X(state_space_options, 72)  \
    X(static_options, 40)       \
    X(static_report, 40)        \
    X(statistics, 72)           \
    X(step_report, 48)          \
    X(stepped_sine_options, 40) \
    X(stepped_sine_report, 48)  \
    X(string_def, 136)          \
    X(stuck_def, 128)           \
    X(stuck_state, 88)          \
    X(sub, 64)                  \
    X(sub_def, 56)              \
    X(segment, 120)             \
    X(torque_drag_options, 40)  \
    X(torque_drag_row, 128)     \
    X(wall_def, 184)            \
    X(window_options, 24)       \
    X(window_result, 72)

#define DECLARE(name, oldest) DMB_DECLARE_STRUCT(dmb_##name)
STRUCTS(DECLARE)

enum { ROOM = 4096 };

/* Room for any of them. */
typedef union any {
    uint32_t struct_size;
    uint64_t numbers[ROOM / 8];
    unsigned char bytes[ROOM];
} any;

typedef struct entry {
    const char *name;
    size_t size, oldest;
    int32_t (*init)(any *out, uint32_t size);
    int32_t (*read)(any *out, const any *from);
    int32_t (*write)(any *to, const any *from);
} entry;

#define WRAP(name, oldest)                                                     \
    static int32_t init_##name(any *out, uint32_t size)                        \
    {                                                                          \
        return dmb_##name##_init((dmb_##name *)(void *)out, size);             \
    }                                                                          \
    static int32_t read_##name(any *out, const any *from)                      \
    {                                                                          \
        return dmb_##name##_read((dmb_##name *)(void *)out, from);             \
    }                                                                          \
    static int32_t write_##name(any *to, const any *from)                      \
    {                                                                          \
        return dmb_##name##_write(to, (const dmb_##name *)(const void *)from); \
    }
STRUCTS(WRAP)

#define ENTRY(name, oldest) {#name, sizeof(dmb_##name), oldest, init_##name, read_##name, write_##name},
static const entry entries[] = {STRUCTS(ENTRY)};
enum { ENTRIES = sizeof entries / sizeof entries[0] };

/* Its defaults with another byte behind its size and its length. */
static any filled(const entry *e, uint32_t size, unsigned char fill)
{
    any made;
    memset(&made, 0, sizeof made);
    assert_int_equal(e->init(&made, size), DMB_OK);
    memset(made.bytes + size, fill, 64);
    return made;
}

static void same_size_is_read_whole(void **state)
{
    (void)state;
    for (size_t i = 0; i < ENTRIES; i++) {
        any from = filled(&entries[i], (uint32_t)entries[i].size, 0xA5),
            out = filled(&entries[i], (uint32_t)entries[i].size, 0);
        memset(from.bytes + 8, 0x11, entries[i].size - 8);
        assert_int_equal(entries[i].read(&out, &from), DMB_OK);
        if (memcmp(&out, &from, entries[i].size) != 0) fail_msg("%s", entries[i].name);
        assert_int_equal(out.bytes[entries[i].size], 0); /* no further */
    }
}

static void older_one_keeps_defaults_behind_it(void **state)
{
    (void)state;
    for (size_t i = 0; i < ENTRIES; i++) {
        const entry *e = &entries[i];
        const any whole = filled(e, (uint32_t)e->size, 0);
        any from = filled(e, (uint32_t)e->oldest, 0xA5), out = whole;
        memset(out.bytes + 8, 0x22, e->size - 8);
        memset(from.bytes + 8, 0x11, e->oldest - 8);
        assert_int_equal(e->read(&out, &from), DMB_OK);
        assert_int_equal(out.struct_size, e->size);
        assert_memory_equal(out.bytes + 8, from.bytes + 8, e->oldest - 8);
        assert_memory_equal(out.bytes + e->oldest, whole.bytes + e->oldest, e->size - e->oldest);
    }
}

static void other_sizes_are_refused(void **state)
{
    (void)state;
    for (size_t i = 0; i < ENTRIES; i++) {
        const entry *e = &entries[i];
        const uint32_t wrong[] = {0, (uint32_t)e->oldest - 8, (uint32_t)e->size + 4, (uint32_t)e->size + 2048};
        for (size_t k = 0; k < sizeof wrong / sizeof wrong[0]; k++) {
            any from = filled(e, (uint32_t)e->size, 0), out = filled(e, (uint32_t)e->size, 0x5A), before;
            from.struct_size = wrong[k];
            before = out;
            if (e->read(&out, &from) != DMB_ERR_STRUCT_SIZE) fail_msg("%s of %u is read", e->name, wrong[k]);
            assert_memory_equal(&out, &before, sizeof out);
            out.struct_size = wrong[k];
            before = out;
            if (e->write(&out, &from) != DMB_ERR_STRUCT_SIZE) fail_msg("%s of %u is written", e->name, wrong[k]);
            assert_memory_equal(&out, &before, sizeof out);
        }
        assert_int_equal(e->read(NULL, NULL), DMB_ERR_NULL);
        assert_int_equal(e->write(NULL, NULL), DMB_ERR_NULL);
    }
}

static void answers_stop_at_the_size_of_the_caller(void **state)
{
    (void)state;
    for (size_t i = 0; i < ENTRIES; i++) {
        const entry *e = &entries[i];
        any answer = filled(e, (uint32_t)e->size, 0), old = filled(e, (uint32_t)e->oldest, 0x5A);
        memset(answer.bytes + 8, 0x11, e->size - 8);
        assert_int_equal(e->write(&old, &answer), DMB_OK);
        assert_int_equal(old.struct_size, e->oldest);
        assert_memory_equal(old.bytes + 8, answer.bytes + 8, e->oldest - 8);
        assert_int_equal(old.bytes[e->oldest], 0x5A);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(same_size_is_read_whole),
        cmocka_unit_test(older_one_keeps_defaults_behind_it),
        cmocka_unit_test(other_sizes_are_refused),
        cmocka_unit_test(answers_stop_at_the_size_of_the_caller),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
