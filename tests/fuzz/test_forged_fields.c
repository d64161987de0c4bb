/* Every field of a snapshot of every kind of scene set to values that no state has, one at a time, with the checksum
 * made to fit: a restore refuses them, tells field, value and bound and changes nothing, or takes them, and then steps
 * and queries end with a known status. The address sanitizer tells reads and writes out of bounds (.ci/run). Against
 * the list of fields itself: each of them stands in one of the scenes. And each state of a run can be restored. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "forged.h"
#include "run/run.h"
#include "sim/layout.h"

#ifdef DMB_SOME_CASES
enum { PLACES = 2, SHARE = 2 }; /* values by turns at the first place and at the last one */
#else
enum { PLACES = 4, SHARE = 1 };
#endif

static unsigned long taken, refused;

static subject open_subject(int which)
{
    subject s = {.scene = saved_scene_open(which)};
    s.sim = saved_sim(&s.scene);
    saved_run(&s.scene, s.sim);
    assert_int_equal(dmb_sim_snapshot_size(s.sim, &s.size), DMB_OK);
    s.sound = malloc(s.size);
    s.forged = malloc(s.size);
    assert_true(s.sound != NULL && s.forged != NULL);
    assert_int_equal(dmb_sim_snapshot(s.sim, s.sound, s.size), DMB_OK);
    s.hash = hash_of(s.sim);
    return s;
}

static void close_subject(subject *s)
{
    free(s->sound);
    free(s->forged);
    dmb_sim_destroy(&s->sim);
    dmb_model_destroy(&s->scene.model);
}

/* ---- One change -------------------------------------------------------------------------------------------------- */

static void known(int32_t status)
{
    if (strcmp(dmb_status_name(status), "DMB_UNKNOWN") == 0) fail_msg("status %d", (int)status);
}

/* All outputs now and then: there are 200. */
static void use(subject *s)
{
    dmb_energy energy = dmb_energy_default();
    dmb_contact contact = dmb_contact_default();
    double value;
    for (int i = 0; i < 2; i++) known(dmb_sim_step(s->sim, 5e-4, NULL));
    known(dmb_sim_advance(s->sim, dmb_sim_time(s->sim) + 1e-4, NULL));
    known(dmb_query_energy(s->sim, &energy));
    for (uint32_t i = 0; dmb_query_contact(s->sim, i, &contact) == DMB_OK; i++) continue;
    for (int32_t q = 0; taken % 16 == 0 && (q = dmb_output_next(q)) > 0;) {
        dmb_output output = {.quantity = q, .place = dmb_station(s->scene.turning, 0, 0.0)};
        known(dmb_query_output(s->sim, &output, &value));
    }
    if (s->scene.event.generation != 0)
        known(dmb_sim_advance_to_event(s->sim, dmb_sim_time(s->sim) + 1e-4, NULL, NULL));
}

/* A clock, a state or a setting may be found at odds with another field, which is told then. */
static int may_tell_another(const dmb_field *field)
{
    return field->check == DMB_CHECK_CLOCK || field->check == DMB_CHECK_JOINT_STATES ||
           field->check == DMB_CHECK_SET_INPUTS || field->check == DMB_CHECK_HISTORY_HEADS;
}

static void check_message(const dmb_sim *sim, const dmb_field *checked)
{
    const char *message = dmb_sim_message(sim), *field = checked->name;
    if (strstr(message, "snapshot: ") == NULL || (strstr(message, field) == NULL && !may_tell_another(checked)) ||
        strstr(message, " = ") == NULL || strstr(message, "must be ") == NULL ||
        strstr(message, "take another") == NULL)
        fail_msg("%s: message: %s", field, message);
}

/* 1: the forged snapshot was taken. */
static int try_it(subject *s, const dmb_field *field)
{
    const uint64_t content = dmb_fnv_block(DMB_FNV_START, s->forged + HEADER, s->size - HEADER);
    memcpy(s->forged + CONTENT_AT, &content, sizeof content);
    const int32_t status = dmb_sim_restore(s->sim, s->forged, s->size);
    if (status < 0) {
        refused++;
        assert_int_equal(status, DMB_ERR_VALUE);
        check_message(s->sim, field);
    } else {
        taken++;
        use(s);
        assert_int_equal(dmb_sim_restore(s->sim, s->sound, s->size), DMB_OK);
    }
    assert_int_equal(hash_of(s->sim), s->hash);
    return status >= 0;
}

/* Place k of a few: the first, the last, the second, one in the middle. */
static size_t place_of(size_t count, int k)
{
    const size_t places[4] = {0, count - 1, 1, count / 2};
    return places[k] < count ? places[k] : 0;
}

/* Whether value i is tried at place k. */
static int is_tried(int k, size_t i)
{
    return ((size_t)k + i) % SHARE == 0;
}

static void set_numbers(subject *s, const dmb_field *field, size_t at)
{
    static const double values[] = {
        (double)NAN, (double)INFINITY, -(double)INFINITY, 1e300, -1e300, -1e30, 1e17, -1e9, 0.0, -1.0, 4.9e-324};
    for (int k = 0; k < PLACES; k++)
        for (size_t i = 0; i < sizeof values / sizeof values[0]; i++) {
            if (!is_tried(k, i)) continue;
            memcpy(s->forged, s->sound, s->size);
            memcpy(s->forged + at + 8 * place_of(field->bytes / 8, k), &values[i], 8);
            const int was_taken = try_it(s, field);
            const int marks = field->check == DMB_CHECK_INPUTS || field->check == DMB_CHECK_SET_INPUTS ||
                              field->check == DMB_CHECK_EVENT_TIMES || field->check == DMB_CHECK_COUNTERS ||
                              field->check == DMB_CHECK_REUSE; /* of which not every double is one */
            if (was_taken && !marks && !isfinite(values[i])) fail_msg("%s: %g was taken", field->name, values[i]);
        }
}

static void set_words(subject *s, const dmb_field *field, size_t at)
{
    static const uint32_t values[] = {0, 1, 2, 3, 4, 5, 63, 64, 65, 127, 65535, 0x7fffffff, 0x80000001u, 0xffffffffu};
    for (int k = 0; k < PLACES; k++)
        for (size_t i = 0; i < sizeof values / sizeof values[0]; i++) {
            if (!is_tried(k, i)) continue;
            memcpy(s->forged, s->sound, s->size);
            memcpy(s->forged + at + 4 * place_of(field->bytes / 4, k), &values[i], 4);
            (void)try_it(s, field);
        }
}

/* Ages of contacts, one byte each, with the mark of those that have mean forces. */
static void set_bytes(subject *s, const dmb_field *field, size_t at)
{
    static const unsigned char values[] = {0, 1, 9, 10, 11, 16, 26, 31, 32, 128, 255};
    for (int k = 0; k < PLACES; k++)
        for (size_t i = 0; i < sizeof values; i++) {
            if (!is_tried(k, i)) continue;
            memcpy(s->forged, s->sound, s->size);
            s->forged[at + place_of(field->bytes, k)] = values[i];
            if (try_it(s, field) != (values[i] < 32)) fail_msg("%s: %u", field->name, values[i]);
        }
}

/* All numbers of a field at once: orders that searches rely on are gone. */
static void set_all(subject *s, const dmb_field *field, size_t at, double factor, double offset)
{
    memcpy(s->forged, s->sound, s->size);
    for (size_t i = 0; i < field->bytes / 8; i++) {
        const double value = factor * (double)(i % 7) + offset;
        memcpy(s->forged + at + 8 * i, &value, 8);
    }
    (void)try_it(s, field);
}

static void forge_field(subject *s, const dmb_field *field, size_t at)
{
    const int of_words = (field->check >= DMB_CHECK_FLAGS && field->check <= DMB_CHECK_HISTORY_HEADS) ||
                         field->check == DMB_CHECK_COUNTERS || field->check == DMB_CHECK_REUSE;
    const int of_bytes = field->check == DMB_CHECK_AGES;
    const int of_doubles = !of_bytes && (field->check < DMB_CHECK_FLAGS || field->check > DMB_CHECK_COLUMN_ORDER);
    if (of_bytes) set_bytes(s, field, at);
    if (of_words) set_words(s, field, at);
    if (of_doubles) set_numbers(s, field, at);
    if (of_doubles && !of_words) {
        static const double factors[] = {-1.0, 0.0, 1e300, 1e-9};
        for (size_t i = 0; i < sizeof factors / sizeof factors[0]; i++)
            for (int offset = -1; offset <= 1; offset++) set_all(s, field, at, factors[i], 1e3 * offset);
    }
}

/* ---- The header -------------------------------------------------------------------------------------------------- */

static void header_is_checked(void **state)
{
    (void)state;
    static const char *const fields[] = {"mark",    "version", "its size", "mark of the model", "mark of the options",
                                         "checksum"};
    subject s = open_subject(SAVED_SIDEWAYS);
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; i++) {
        memcpy(s.forged, s.sound, s.size);
        s.forged[8 * i] ^= 1;
        assert_int_equal(dmb_sim_restore(s.sim, s.forged, s.size), DMB_ERR_VALUE);
        const char *message = dmb_sim_message(s.sim);
        if (strstr(message, fields[i]) == NULL || strstr(message, "must be ") == NULL || strchr(message, ';') == NULL)
            fail_msg("%s: message: %s", fields[i], message);
        assert_int_equal(hash_of(s.sim), s.hash);
    }
    for (size_t size = 0; size < s.size; size += 1 + size / 3) {
        assert_int_equal(dmb_sim_restore(s.sim, s.sound, size), DMB_ERR_VALUE);
        assert_non_null(strstr(dmb_sim_message(s.sim), "size [byte] = "));
    }
    close_subject(&s);
}

/* The refused number of a clock is named by its place in the field. */
static void numbers_of_the_clock_are_named(void **state)
{
    (void)state;
    static const size_t places[] = {offsetof(dmb_clock, time), offsetof(dmb_clock, step),
                                    offsetof(dmb_clock, next_step), offsetof(dmb_clock, power)};
    static const double values[] = {-1.0, -1.0, -1.0, (double)INFINITY};
    dmb_field fields[DMB_FIELD_MAX];
    subject s = open_subject(SAVED_STRING);
    const size_t count = dmb_sim_fields(s.sim, DMB_GROUP_NOW, DMB_GROUP_FACTORS, fields);
    size_t at = HEADER, i = 0;
    for (; i < count && fields[i].check != DMB_CHECK_CLOCK; i++) at += fields[i].bytes;
    assert_true(i < count);
    for (size_t k = 0; k < sizeof places / sizeof places[0]; k++) {
        char wanted[32];
        (void)snprintf(wanted, sizeof wanted, "number %zu = ", places[k] / sizeof(double));
        memcpy(s.forged, s.sound, s.size);
        memcpy(s.forged + at + places[k], &values[k], sizeof values[k]);
        assert_int_equal(try_it(&s, fields + i), 0);
        if (strstr(dmb_sim_message(s.sim), wanted) == NULL) fail_msg("%s: message: %s", wanted, dmb_sim_message(s.sim));
    }
    close_subject(&s);
}

/* ---- Tests ------------------------------------------------------------------------------------------------------- */

static void forge_scene(int which)
{
    dmb_field fields[DMB_FIELD_MAX];
    subject s = open_subject(which);
    const size_t count = dmb_sim_fields(s.sim, DMB_GROUP_NOW, DMB_GROUP_FACTORS, fields);
    size_t at = HEADER;
    for (size_t i = 0; i < count; at += fields[i++].bytes)
        if (fields[i].bytes > 0) forge_field(&s, fields + i, at);
    assert_int_equal(at, s.size);
    print_message("    %lu refused, %lu taken\n", refused, taken);
    close_subject(&s);
}

static void string_and_all_it_meets(void **state)
{
    (void)state;
    forge_scene(SAVED_STRING);
}

static void joints(void **state)
{
    (void)state;
    forge_scene(SAVED_JOINTS);
}

static void joints_of_sparse_clusters(void **state)
{
    (void)state;
    forge_scene(SAVED_SPARSE);
}

static void sideways(void **state)
{
    (void)state;
    forge_scene(SAVED_SIDEWAYS);
}

static void each_field_is_in_one_of_the_scenes(void **state)
{
    (void)state;
    int found[DMB_FIELD_MAX] = {0};
    dmb_field fields[DMB_FIELD_MAX];
    size_t count = 0;
    for (int which = 0; which < SAVED_SCENES; which++) {
        subject s = open_subject(which);
        count = dmb_sim_fields(s.sim, DMB_GROUP_NOW, DMB_GROUP_FACTORS, fields);
        for (size_t i = 0; i < count; i++) found[i] |= fields[i].bytes > 0;
        close_subject(&s);
    }
    for (size_t i = 0; i < count; i++)
        if (!found[i]) fail_msg("no scene has %s: give one what needs it", fields[i].name);
}

/* At time 0, after each step, after statics. */
static void check_own(subject *s)
{
    const uint64_t hash = hash_of(s->sim);
    assert_int_equal(dmb_sim_snapshot(s->sim, s->forged, s->size), DMB_OK);
    if (dmb_sim_restore(s->sim, s->forged, s->size) < 0) fail_msg("%s", dmb_sim_message(s->sim));
    assert_int_equal(hash_of(s->sim), hash);
}

static void own_snapshots_are_taken(void **state)
{
    (void)state;
    for (int which = 0; which < SAVED_SCENES; which++) {
        subject s = open_subject(which);
        dmb_sim_destroy(&s.sim);
        s.sim = saved_sim(&s.scene);
        check_own(&s);
        for (int i = 0; i < 10; i++) {
            assert_true(dmb_sim_step(s.sim, 5e-4, NULL) >= 0);
            check_own(&s);
        }
        if (SHARE == 1) {
            (void)dmb_analysis_static(s.sim, NULL, NULL);
            check_own(&s);
        }
        close_subject(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_field_is_in_one_of_the_scenes),
        cmocka_unit_test(own_snapshots_are_taken),
        cmocka_unit_test(header_is_checked),
        cmocka_unit_test(numbers_of_the_clock_are_named),
        cmocka_unit_test(string_and_all_it_meets),
        cmocka_unit_test(joints),
        cmocka_unit_test(joints_of_sparse_clusters),
        cmocka_unit_test(sideways),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
