/* Snapshots with a byte, a word or a number of their content changed and the checksum made to fit: a restore refuses
 * them and changes nothing, or takes them, and then steps, analyses and queries end with a known status. The address
 * sanitizer tells reads and writes out of bounds (.ci/run). Scenes: every kind of part with pipes of all kinds,
 * bristles, a curved hole and a bit with its history, with and without joints; joints of all kinds.
 *
 * As a test it runs a fixed number of seeded changes, fewer under a sanitizer; arguments are the first seed and how
 * many of each scene. */
#include <stdlib.h>

#include "../contract/joint_scene.h"
#include "../contract/whole_scene.h"
#include "run/run.h"
#include "sim/layout.h"

#ifdef DMB_SOME_CASES
enum { CHANGES = 12 };
#else
enum { CHANGES = 80 };
#endif
enum { HEADER = 48, CONTENT_AT = 40 }; /* bytes of the header; where its checksum stands */

static unsigned long long first_seed = 1, changes = CHANGES;
static unsigned long long taken, refused, stepped;

/* splitmix64 */
static uint64_t next_random(uint64_t *state)
{
    uint64_t z = *state += UINT64_C(0x9E3779B97F4A7C15);
    z = (z ^ z >> 30) * UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ z >> 27) * UINT64_C(0x94D049BB133111EB);
    return z ^ z >> 31;
}

typedef struct snapshot {
    unsigned char *bytes;
    size_t size;
} snapshot;

static snapshot take(const dmb_sim *sim)
{
    snapshot s = {NULL, 0};
    assert_int_equal(dmb_sim_snapshot_size(sim, &s.size), DMB_OK);
    s.bytes = malloc(s.size);
    assert_non_null(s.bytes);
    assert_int_equal(dmb_sim_snapshot(sim, s.bytes, s.size), DMB_OK);
    return s;
}

static void fit_checksum(snapshot *s)
{
    const uint64_t content = dmb_fnv_block(DMB_FNV_START, s->bytes + HEADER, s->size - HEADER);
    memcpy(s->bytes + CONTENT_AT, &content, sizeof content);
}

/* ---- Changes ----------------------------------------------------------------------------------------------------- */

static void change_number(unsigned char *at, uint64_t *random)
{
    static const double values[] = {(double)NAN,
                                    (double)INFINITY,
                                    -(double)INFINITY,
                                    0.0,
                                    -0.0,
                                    1.0,
                                    -1.0,
                                    1e300,
                                    -1e300,
                                    4.9e-324,
                                    1e30,
                                    -1e9,
                                    1e9,
                                    1e17,
                                    1e-300,
                                    6.283};
    double value = values[next_random(random) % (sizeof values / sizeof values[0])];
    if (next_random(random) % 4 == 0) {
        memcpy(&value, at, sizeof value);
        value *= next_random(random) % 2 ? -1.0 : 1e6;
    }
    memcpy(at, &value, sizeof value);
}

static void change_word(unsigned char *at, uint64_t *random)
{
    static const uint32_t values[] = {0,   1,    2,     3,          7,           63,          64,          127,
                                      128, 1000, 65536, 0x7fffffff, 0x80000000u, 0x80000001u, 0xfffffffeu, 0xffffffffu};
    uint32_t value = values[next_random(random) % (sizeof values / sizeof values[0])];
    if (next_random(random) % 3 == 0) {
        memcpy(&value, at, sizeof value);
        value += next_random(random) % 2 ? 1u : 0xffffffffu;
    }
    memcpy(at, &value, sizeof value);
}

/* Half of them in a field drawn first, so that small fields are met as often as large ones. */
static size_t place_of(const dmb_sim *sim, const snapshot *s, uint64_t *random)
{
    dmb_field fields[DMB_FIELD_MAX];
    const size_t count = dmb_sim_fields(sim, DMB_GROUP_NOW, DMB_GROUP_FACTORS, fields);
    size_t wanted = next_random(random) % count, at = HEADER;
    if (next_random(random) % 4 == 0) return HEADER + next_random(random) % ((s->size - HEADER) / 4) * 4;
    while (fields[wanted].bytes == 0) wanted = (wanted + 1) % count;
    for (size_t i = 0; i < wanted; i++) at += fields[i].bytes;
    return at + next_random(random) % (fields[wanted].bytes / 4) * 4;
}

static void change(const dmb_sim *sim, snapshot *s, uint64_t *random)
{
    const uint64_t places = 1 + next_random(random) % 3;
    for (uint64_t i = 0; i < places; i++) {
        const size_t at = place_of(sim, s, random);
        const uint64_t how = next_random(random) % 3;
        if (how == 0) s->bytes[at] ^= (unsigned char)(1u << next_random(random) % 8);
        if (how == 1) change_word(s->bytes + at, random);
        if (how == 2) change_number(s->bytes + (at + 8 > s->size ? s->size - 8 : at / 8 * 8), random);
    }
    fit_checksum(s);
}

/* ---- What is done with a sim that took one ----------------------------------------------------------------------- */

static void must_be_known(int32_t status)
{
    if (strcmp(dmb_status_name(status), "DMB_UNKNOWN") == 0) fail_msg("status %d", (int)status);
}

static void use(dmb_sim *sim, dmb_id string)
{
    dmb_check_report report = dmb_check_report_default();
    dmb_static_options statics = dmb_static_options_default();
    dmb_energy energy = dmb_energy_default();
    dmb_statistics statistics = dmb_statistics_default();
    dmb_contact contact = dmb_contact_default();
    dmb_pose pose = dmb_pose_default();
    statics.max_iterations = 3;
    for (int i = 0; i < 3; i++) {
        const int32_t status = dmb_sim_step(sim, 5e-4, NULL);
        must_be_known(status);
        stepped += status >= 0;
    }
    must_be_known(dmb_query_energy(sim, &energy));
    must_be_known(dmb_query_statistics(sim, &statistics));
    for (uint32_t i = 0; dmb_query_contact(sim, i, &contact) == DMB_OK; i++) continue;
    must_be_known(dmb_query_pose(sim, dmb_station(string, 1, 0.3), &pose));
    must_be_known(dmb_sim_advance(sim, dmb_sim_time(sim) + 2e-4, NULL));
    must_be_known(dmb_analysis_check(sim, &report));
    must_be_known(dmb_analysis_static(sim, &statics, NULL));
}

static void forge(dmb_sim *sim, dmb_sim *victim, dmb_id string, unsigned long long seed)
{
    uint64_t random = seed, before = whole_hash(victim);
    snapshot s = take(sim);
    change(sim, &s, &random);
    const int32_t status = dmb_sim_restore(victim, s.bytes, s.size);
    if (status < 0) {
        assert_int_equal(status, DMB_ERR_VALUE);
        assert_non_null(strstr(dmb_sim_message(victim), "must be"));
        assert_int_equal(whole_hash(victim), before);
        refused++;
    } else {
        taken++;
        use(victim, string);
        fit_checksum(&s); /* and back to something sound, for the next */
    }
    free(s.bytes);
}

static dmb_sim_options quick(void)
{
    dmb_sim_options options = dmb_sim_options_default();
    options.max_steps = 20;
    return options;
}

static void forge_many(dmb_model *model, dmb_id string, uint32_t steps)
{
    const dmb_sim_options options = quick();
    dmb_sim *sim = whole_sim(model, &options), *victim = whole_sim(model, &options);
    whole_run(sim, steps, 5e-4);
    snapshot sound = take(sim);
    for (unsigned long long i = 0; i < changes; i++) {
        assert_int_equal(dmb_sim_restore(victim, sound.bytes, sound.size), DMB_OK);
        forge(sim, victim, string, first_seed + i);
    }
    free(sound.bytes);
    dmb_sim_destroy(&sim);
    dmb_sim_destroy(&victim);
}

/* ---- Scenes ------------------------------------------------------------------------------------------------------ */

/* Without joints: factors are kept from step to step, and saved. */
static void parts_of_all_kinds(void **state)
{
    (void)state;
    whole_parts parts;
    size_t before_joints = 0;
    while (whole_calls[before_joints] != whole_add_arm) before_joints++;
    dmb_model *model = whole_model_until(&parts, before_joints);
    whole_must(model, dmb_model_compile(model, NULL));
    forge_many(model, parts.string, 60);
    dmb_model_destroy(&model);
}

static void parts_with_joints(void **state)
{
    (void)state;
    whole_parts parts;
    dmb_model *model = whole_model(&parts);
    forge_many(model, parts.string, 20);
    dmb_model_destroy(&model);
}

static void joints_of_all_kinds(void **state)
{
    (void)state;
    joint_scene scene;
    joint_scene_open(&scene, NULL);
    forge_many(scene.s.model, scene.string, 10);
    dmb_model_destroy(&scene.s.model);
}

/* ---- Each field by itself ---------------------------------------------------------------------------------------- */

/* Every word of every field that is no plain number, set to what no scene has: refused. */
static void check_field(dmb_sim *sim, const snapshot *sound, const dmb_field *field, size_t at)
{
    snapshot s = {malloc(sound->size), sound->size};
    const size_t words = field->bytes / 4;
    assert_non_null(s.bytes);
    for (size_t i = 0; i < words; i += 1 + words / 16) {
        memcpy(s.bytes, sound->bytes, s.size);
        memset(s.bytes + at + 4 * i, 0x7f, 4); /* 2139062143 */
        fit_checksum(&s);
        if (dmb_sim_restore(sim, s.bytes, s.size) != DMB_ERR_VALUE) fail_msg("%s, word %zu was taken", field->name, i);
        assert_non_null(strstr(dmb_sim_message(sim), field->name));
    }
    free(s.bytes);
}

static void no_number(dmb_sim *sim, const snapshot *sound, const dmb_field *field, size_t at)
{
    static const double bad[] = {(double)NAN, (double)INFINITY, -(double)INFINITY};
    snapshot s = {malloc(sound->size), sound->size};
    const size_t numbers = field->bytes / 8;
    assert_non_null(s.bytes);
    for (size_t i = 0; i < numbers; i += 1 + numbers / 8) {
        memcpy(s.bytes, sound->bytes, s.size);
        memcpy(s.bytes + at + 8 * i, &bad[field->check == DMB_CHECK_INPUTS ? 1 + i % 2 : i % 3], 8);
        fit_checksum(&s);
        if (dmb_sim_restore(sim, s.bytes, s.size) != DMB_ERR_VALUE)
            fail_msg("%s, number %zu was taken", field->name, i);
    }
    free(s.bytes);
}

static void every_field_is_checked(void **state)
{
    (void)state;
    joint_scene scene;
    whole_parts parts;
    joint_scene_open(&scene, NULL);
    dmb_model *models[2] = {whole_model(&parts), scene.s.model};
    for (int m = 0; m < 2; m++) {
        dmb_field fields[DMB_FIELD_MAX];
        dmb_sim *sim = whole_sim(models[m], NULL);
        whole_run(sim, 10, 5e-4);
        const uint64_t hash = whole_hash(sim);
        snapshot sound = take(sim);
        const size_t count = dmb_sim_fields(sim, DMB_GROUP_NOW, DMB_GROUP_FACTORS, fields);
        size_t at = HEADER;
        for (size_t i = 0; i < count; at += fields[i++].bytes) {
            const int32_t check = fields[i].check;
            if (check == DMB_CHECK_NUMBERS || check == DMB_CHECK_INPUTS) no_number(sim, &sound, fields + i, at);
            if (check > DMB_CHECK_INPUTS && check < DMB_CHECK_HISTORY_HEADS) check_field(sim, &sound, fields + i, at);
        }
        assert_int_equal(at, sound.size);
        assert_int_equal(whole_hash(sim), hash);
        assert_int_equal(dmb_sim_restore(sim, sound.bytes, sound.size), DMB_OK);
        free(sound.bytes);
        dmb_sim_destroy(&sim);
        dmb_model_destroy(&models[m]);
    }
}

/* Two columns of a cluster that are one; a history head beyond its ring: as in the finding. */
static void forge_word(dmb_sim *sim, const char *name, size_t word, uint32_t value)
{
    dmb_field fields[DMB_FIELD_MAX];
    snapshot s = take(sim);
    const size_t count = dmb_sim_fields(sim, DMB_GROUP_NOW, DMB_GROUP_FACTORS, fields);
    size_t at = HEADER, i = 0;
    while (i < count && strcmp(fields[i].name, name) != 0) at += fields[i++].bytes;
    assert_true(i < count && fields[i].bytes > 4 * word);
    memcpy(s.bytes + at + 4 * word, &value, sizeof value);
    fit_checksum(&s);
    if (dmb_sim_restore(sim, s.bytes, s.size) != DMB_ERR_VALUE) fail_msg("%s[%zu] = %u was taken", name, word, value);
    free(s.bytes);
}

static void findings(void **state)
{
    (void)state;
    whole_parts parts;
    dmb_model *model = whole_model(&parts);
    dmb_sim *sim = whole_sim(model, NULL);
    whole_run(sim, 2, 5e-4);
    forge_word(sim, "partition_column", 0, sim->partition_column[1]);
    forge_word(sim, "partition_row", 0, 100000);
    forge_word(sim, "partition_rank", 0, sim->scene->clusters[0].rows + 1);
    forge_word(sim, "history_head", 0, sim->scene->bits[0].history_capacity);
    forge_word(sim, "history_head", 1, 0);
    forge_word(sim, "history_head", 1, sim->scene->bits[0].history_capacity + 1);
    forge_word(sim, "site_segment", 0, sim->scene->hole.stations);
    forge_word(sim, "site_sticks", 0, 2);
    forge_word(sim, "joint_state", 0, 3);
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(findings),
        cmocka_unit_test(every_field_is_checked),
        cmocka_unit_test(parts_of_all_kinds),
        cmocka_unit_test(parts_with_joints),
        cmocka_unit_test(joints_of_all_kinds),
    };
    if (argc > 1) first_seed = strtoull(argv[1], NULL, 10);
    if (argc > 2) changes = strtoull(argv[2], NULL, 10);
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    printf("%llu forged snapshots taken, %llu refused; %llu steps accepted\n", taken, refused, stepped);
    return failed;
}
