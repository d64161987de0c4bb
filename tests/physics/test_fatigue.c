/* Fatigue of a pipe that turns while its weight bends it: each point of its surface goes through M r/I once a turn, so
 * that n turns do the damage n/N(S). And what refuses. Equations: eq:fatigue.stress, eq:fatigue.damage. */
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "drillmbd/drillmbd.h"

static void must(int32_t status, const char *message)
{
    if (status < 0) fail_msg("%d: %s", (int)status, message);
}

typedef struct scene {
    dmb_model *model;
    dmb_sim *sim;
    dmb_place root;
} scene;

/* Two pipes of 1 m stand out horizontally, turned at 1 revolution in 0.25 s, pulled by `pull` [N]. */
static scene turning(double pull)
{
    scene s = {NULL, NULL, {{0, 0}, 0, 0, 0.0}};
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_load_def load = dmb_load_def_default();
    dmb_segment speed = dmb_segment_default();
    string.start_free = DMB_FREE_RX;
    pipe.damping_time = 1e-3;
    pipe.elements = 4;
    speed.h0 = 8.0 * PI;
    drive.component = DMB_RX;
    load.force[0] = pull;
    must(dmb_model_create(NULL, &s.model), "create");
    must(dmb_model_add_string(s.model, &string, &pipe.string), dmb_model_message(s.model));
    must(dmb_model_add_pipes(s.model, &pipe, 2, NULL), dmb_model_message(s.model));
    must(dmb_model_add_time_function(s.model, &speed, 1, &drive.time_function), dmb_model_message(s.model));
    must(dmb_model_add_drive(s.model, &drive, NULL), dmb_model_message(s.model));
    load.place = dmb_station(pipe.string, 1, 1.0);
    must(dmb_model_add_load(s.model, &load, NULL), dmb_model_message(s.model));
    must(dmb_model_compile(s.model, NULL), dmb_model_message(s.model));
    must(dmb_sim_create(s.model, NULL, &s.sim), dmb_model_message(s.model));
    must(dmb_analysis_static(s.sim, NULL, NULL), dmb_sim_message(s.sim));
    s.root = dmb_station(pipe.string, 0, 0.0);
    return s;
}

static void destroy(scene *s)
{
    dmb_sim_destroy(&s->sim);
    dmb_model_destroy(&s->model);
}

static dmb_fatigue_options curve(void)
{
    dmb_fatigue_options options = dmb_fatigue_options_default();
    options.classes = 8192;
    options.stress_range = 5e7;
    options.curve_stress = 1e8;
    options.slope = 4.0;
    return options;
}

/* [Pa] */
static double bending_stress(void)
{
    const double A = PI / 4.0 * (0.073 * 0.073 - 0.061 * 0.061), I = PI / 64.0 * (pow(0.073, 4) - pow(0.061, 4));
    return 0.5 * 7850.0 * 9.81 * A * 2.0 * 2.0 * 0.0365 / I;
}

static dmb_fatigue_result after_turns(scene *s, const dmb_fatigue_options *options, int turns, double *histogram)
{
    dmb_fatigue *fatigue = NULL;
    dmb_fatigue_result result = dmb_fatigue_result_default();
    must(dmb_fatigue_create(s->sim, options, &s->root, 1, &fatigue), dmb_sim_message(s->sim));
    must(dmb_fatigue_take(fatigue, s->sim), "take");
    for (int i = 0; i < 100 * turns; i++) {
        must(dmb_sim_step(s->sim, 2.5e-3, NULL), dmb_sim_message(s->sim));
        must(dmb_fatigue_take(fatigue, s->sim), "take");
    }
    must(dmb_fatigue_get(fatigue, 0, &result), "get");
    if (histogram != NULL) must(dmb_fatigue_histogram(fatigue, 0, histogram), "histogram");
    dmb_fatigue_destroy(&fatigue);
    assert_null(fatigue);
    dmb_fatigue_destroy(&fatigue);
    return result;
}

static void damage_of_turns(void **state)
{
    static double histogram[8192];
    const double S = bending_stress();
    dmb_fatigue_options options = curve();
    double counted = 0.0;
    scene s = turning(0.0);
    (void)state;
    const dmb_fatigue_result result = after_turns(&s, &options, 12, histogram);
    check_close("cycles", result.cycles, 12.0, 0.75);
    check_relative("largest range", result.largest_range, 2.0 * S, 2e-3);
    check_relative("highest", result.highest, S, 2e-3);
    check_relative("lowest", result.lowest, -S, 2e-3);
    check_relative("damage", result.damage, 12.0 * pow(S / 1e8, 4.0) / 1e6, 1e-5);
    check_relative("life", result.life, 3.0 / result.damage, 1e-9);
    for (int i = 0; i < 8192; i++) counted += histogram[i];
    check_close("histogram", counted, result.cycles, 1e-9);
    assert_int_equal(result.samples, 1201);
    assert_int_equal(result.clipped, 0);
    destroy(&s);
}

/* Levels tell turning points apart; how many there are does not count. */
static void damage_by_any_levels(void **state)
{
    static const uint32_t classes[] = {24, 64, 1024};
    const double S = bending_stress();
    (void)state;
    for (int k = 0; k < 3; k++) {
        scene s = turning(0.0);
        dmb_fatigue_options options = curve();
        options.classes = classes[k];
        const dmb_fatigue_result result = after_turns(&s, &options, 12, NULL);
        check_relative("damage", result.damage, 12.0 * pow(S / 1e8, 4.0) / 1e6, 1e-5);
        destroy(&s);
    }
}

/* A stress concentration k does k^slope times the damage; a mean stress that of Goodman; nothing below endurance. */
static void factors(void **state)
{
    scene s = turning(3000.0);
    dmb_fatigue_options options = curve();
    (void)state;
    const double plain = after_turns(&s, &options, 4, NULL).damage;
    options.concentration = 1.5;
    check_relative("concentration", after_turns(&s, &options, 4, NULL).damage / plain, pow(1.5, 4.0), 0.02);
    options.concentration = 1.0;
    options.tensile_strength = 2e7;
    const double mean = 3000.0 / (PI / 4.0 * (0.073 * 0.073 - 0.061 * 0.061));
    check_relative("Goodman", after_turns(&s, &options, 4, NULL).damage / plain, pow(1.0 - mean / 2e7, -4.0), 0.03);
    options.endurance = 1e9;
    assert_true(after_turns(&s, &options, 4, NULL).damage == 0.0);
    options.stress_range = 1e6;
    assert_true(after_turns(&s, &options, 1, NULL).clipped > 0);
    destroy(&s);
}

/* Beyond the tensile strength nothing is borne. */
static void mean_above_the_strength(void **state)
{
    scene s = turning(3000.0);
    dmb_fatigue_options options = curve();
    (void)state;
    options.tensile_strength = 2e6;
    const dmb_fatigue_result result = after_turns(&s, &options, 1, NULL);
    assert_true(isinf(result.damage) && result.life == 0.0);
    destroy(&s);
}

/* Over a quarter turn points go through unlike ranges, most of all those at 45 deg; where none of them is damaged the
 * largest range is the one that is told. */
static void largest_range_without_damage(void **state)
{
    scene s = turning(0.0);
    dmb_fatigue_options options = curve();
    dmb_fatigue *fatigue = NULL;
    dmb_fatigue_result result = dmb_fatigue_result_default();
    (void)state;
    options.endurance = 1e9;
    must(dmb_fatigue_create(s.sim, &options, &s.root, 1, &fatigue), dmb_sim_message(s.sim));
    must(dmb_fatigue_take(fatigue, s.sim), "take");
    for (int i = 0; i < 25; i++) {
        must(dmb_sim_step(s.sim, 2.5e-3, NULL), dmb_sim_message(s.sim));
        must(dmb_fatigue_take(fatigue, s.sim), "take");
    }
    must(dmb_fatigue_get(fatigue, 0, &result), "get");
    assert_true(result.damage == 0.0);
    check_relative("range over a quarter turn", result.largest_range, sqrt(2.0) * bending_stress(), 1e-2);
    dmb_fatigue_destroy(&fatigue);
    destroy(&s);
}

static void refused(void **state)
{
    scene s = turning(0.0), other = turning(0.0);
    const dmb_fatigue_options good = curve();
    dmb_fatigue_options bad;
    dmb_fatigue_result result = dmb_fatigue_result_default();
    dmb_fatigue *fatigue = NULL;
    dmb_place place = s.root;
    double histogram[8];
    (void)state;
#define REFUSED(field, value, status)                                               \
    bad = good, bad.field = value;                                                  \
    fatigue = (dmb_fatigue *)&s;                                                    \
    assert_int_equal(dmb_fatigue_create(s.sim, &bad, &place, 1, &fatigue), status); \
    assert_null(fatigue);                                                           \
    assert_true(dmb_sim_message(s.sim)[0] != 0)
    REFUSED(classes, 7, DMB_ERR_VALUE);
    REFUSED(classes, UINT32_MAX, DMB_ERR_VALUE);
    REFUSED(points, 1, DMB_ERR_VALUE);
    REFUSED(stress_range, 0.0, DMB_ERR_VALUE);
    REFUSED(stress_range, (double)NAN, DMB_ERR_NOT_FINITE);
    REFUSED(concentration, 0.9, DMB_ERR_VALUE);
    REFUSED(curve_stress, 0.0, DMB_ERR_VALUE);
    REFUSED(curve_cycles, -1.0, DMB_ERR_VALUE);
    REFUSED(slope, 0.0, DMB_ERR_VALUE);
    REFUSED(slope, (double)INFINITY, DMB_ERR_NOT_FINITE);
    REFUSED(endurance, -1.0, DMB_ERR_VALUE);
    REFUSED(tensile_strength, -1.0, DMB_ERR_VALUE);
    REFUSED(struct_size, 12, DMB_ERR_STRUCT_SIZE);
    place.pipe = 2;
    REFUSED(points, 8, DMB_ERR_VALUE);
    assert_non_null(strstr(dmb_sim_message(s.sim), "place 0"));
    place = s.root;
    assert_int_equal(dmb_fatigue_create(s.sim, &good, &place, 0, &fatigue), DMB_ERR_VALUE);
    assert_int_equal(dmb_fatigue_create(s.sim, &good, NULL, 1, &fatigue), DMB_ERR_NULL);
    assert_int_equal(dmb_fatigue_create(s.sim, NULL, &place, 1, &fatigue), DMB_ERR_NULL);
    assert_int_equal(dmb_fatigue_create(s.sim, &good, &place, 1, NULL), DMB_ERR_NULL);
    must(dmb_fatigue_create(s.sim, &good, &place, 1, &fatigue), dmb_sim_message(s.sim));
    must(dmb_fatigue_get(fatigue, 0, &result), "before the first sample");
    assert_true(result.damage == 0.0 && isinf(result.life) && result.highest == 0.0);
    assert_int_equal(dmb_fatigue_take(fatigue, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_fatigue_take(NULL, s.sim), DMB_ERR_NULL);
    assert_int_equal(dmb_fatigue_take((dmb_fatigue *)s.sim, s.sim), DMB_ERR_HANDLE);
    assert_int_equal(dmb_fatigue_take(fatigue, other.sim), DMB_ERR_ID); /* has no such part */
    const dmb_place two[2] = {s.root, s.root};
    dmb_fatigue *both = NULL;
    must(dmb_fatigue_create(s.sim, &good, two, 2, &both), dmb_sim_message(s.sim));
    assert_int_equal(dmb_fatigue_take(both, other.sim), DMB_ERR_ID);
    dmb_fatigue_destroy(&both);
    assert_int_equal(dmb_fatigue_get(fatigue, 1, &result), DMB_ERR_VALUE);
    assert_int_equal(dmb_fatigue_get(fatigue, 0, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_fatigue_histogram(fatigue, 1, histogram), DMB_ERR_VALUE);
    must(dmb_fatigue_get(fatigue, 0, &result), "get");
    assert_int_equal(result.samples, 0);
    dmb_fatigue_destroy(&fatigue);
    dmb_fatigue_destroy(NULL);
    destroy(&s);
    destroy(&other);
}

/* Bent as it turns in a hole that bends, of which an axial-torsional pipe knows nothing: refused; a flexible one not,
 * nor an axial-torsional one in a straight hole. */
static void bending_that_is_not_seen(void **state)
{
    const double survey[3][3] = {{0.0, 1.5707963, 0.0}, {1.0, 1.5707963, 0.0}, {41.0, 1.1707963, 0.0}};
    (void)state;
    for (int k = 0; k < 4; k++) {
        const int bends = k / 2, flexible = k % 2;
        dmb_model *model = NULL;
        dmb_sim *sim = NULL;
        dmb_wall_def wall = dmb_wall_def_default();
        dmb_pipe_def pipe = dmb_pipe_def_default();
        dmb_fatigue_options options = dmb_fatigue_options_default();
        dmb_fatigue *fatigue = NULL;
        dmb_id string;
        dmb_string_def def = dmb_string_def_default();
        assert_int_equal(dmb_model_create(NULL, &model), DMB_OK);
        if (bends) {
            wall.survey = survey[0];
            wall.survey_count = 3;
        }
        assert_int_equal(dmb_model_add_wall(model, &wall, NULL), DMB_OK);
        def.start_free = DMB_FREE_NONE;
        assert_int_equal(dmb_model_add_string(model, &def, &string), DMB_OK);
        pipe.string = string;
        pipe.kind = flexible ? DMB_PIPE_FLEXIBLE : DMB_PIPE_AXIAL_TORSIONAL;
        assert_int_equal(dmb_model_add_pipes(model, &pipe, 10, NULL), DMB_OK);
        assert_int_equal(dmb_model_compile(model, NULL), DMB_OK);
        assert_true(dmb_sim_create(model, NULL, &sim) >= 0);
        options.curve_stress = 2e8;
        options.slope = 5.0;
        const dmb_place place = dmb_station(string, 5, 0.5);
        const int32_t status = dmb_fatigue_create(sim, &options, &place, 1, &fatigue);
        assert_int_equal(status, bends && !flexible ? DMB_ERR_UNSUPPORTED : DMB_OK);
        assert_true((fatigue == NULL) == (status < 0));
        if (status < 0) assert_non_null(strstr(dmb_sim_message(sim), "hole that bends"));
        dmb_fatigue_destroy(&fatigue);
        dmb_sim_destroy(&sim);
        dmb_model_destroy(&model);
    }
}

/* ---- Snapshots --------------------------------------------------------------------------------------------------- */

static void count_on(scene *s, dmb_fatigue *fatigue, int steps)
{
    for (int i = 0; i < steps; i++) {
        must(dmb_sim_step(s->sim, 0.25 / 40.0, NULL), dmb_sim_message(s->sim));
        must(dmb_fatigue_take(fatigue, s->sim), "take");
    }
}

static dmb_fatigue *counter(scene *s)
{
    const dmb_fatigue_options options = curve();
    const dmb_place places[2] = {s->root, {s->root.part, 1, 0, 0.5}};
    dmb_fatigue *made = NULL;
    must(dmb_fatigue_create(s->sim, &options, places, 2, &made), dmb_sim_message(s->sim));
    return made;
}

static unsigned char *saved(const dmb_fatigue *fatigue, size_t *size)
{
    must(dmb_fatigue_snapshot_size(fatigue, size), "size");
    unsigned char *block = malloc(*size);
    assert_non_null(block);
    must(dmb_fatigue_snapshot(fatigue, block, *size), "snapshot");
    return block;
}

static void assert_same_counts(const dmb_fatigue *a, const dmb_fatigue *b)
{
    size_t size, other;
    unsigned char *first = saved(a, &size), *second = saved(b, &other);
    assert_int_equal(size, other);
    assert_memory_equal(first, second, size);
    free(first);
    free(second);
}

/* Counts that are restored in the middle of a run, over other counts, go on to the same bits. */
static void counts_on_after_a_restore(void **state)
{
    scene s = turning(1e4);
    dmb_fatigue *whole = counter(&s), *rest = counter(&s);
    dmb_fatigue_result a = dmb_fatigue_result_default(), b = dmb_fatigue_result_default();
    size_t size;
    (void)state;
    count_on(&s, rest, 17);
    count_on(&s, whole, 90);
    unsigned char *block = saved(whole, &size);
    must(dmb_fatigue_restore(rest, block, size), "restore");
    assert_same_counts(whole, rest);
    for (int i = 0; i < 110; i++) {
        must(dmb_sim_step(s.sim, 0.25 / 40.0, NULL), dmb_sim_message(s.sim));
        must(dmb_fatigue_take(whole, s.sim), "take");
        must(dmb_fatigue_take(rest, s.sim), "take");
    }
    assert_same_counts(whole, rest);
    must(dmb_fatigue_get(whole, 0, &a), "get");
    must(dmb_fatigue_get(rest, 0, &b), "get");
    assert_true(a.damage > 0.0 && a.cycles > 4.0 && a.samples == 200);
    assert_memory_equal(&a, &b, sizeof a);
    free(block);
    dmb_fatigue_destroy(&whole);
    dmb_fatigue_destroy(&rest);
    destroy(&s);
}

/* Bytes that are no counts of these options are refused and change nothing; those that are taken, forged or not, count
 * on. */
static void forged_counts(void **state)
{
    scene s = turning(1e4);
    dmb_fatigue *fatigue = counter(&s), *kept = counter(&s);
    dmb_fatigue_options coarse = curve();
    dmb_fatigue *other = NULL;
    uint64_t random = 1;
    size_t size;
    int refused_ones = 0;
    (void)state;
    count_on(&s, fatigue, 60);
    unsigned char *block = saved(fatigue, &size);
    must(dmb_fatigue_restore(kept, block, size), "restore");
    assert_int_equal(dmb_fatigue_restore(fatigue, block, size - 1), DMB_ERR_VALUE);
    assert_int_equal(dmb_fatigue_snapshot(fatigue, block, size + 8), DMB_ERR_VALUE);
    coarse.slope = 5.0;
    must(dmb_fatigue_create(s.sim, &coarse, &s.root, 1, &other), dmb_sim_message(s.sim));
    assert_int_equal(dmb_fatigue_restore(other, block, size), DMB_ERR_VALUE);
    for (int i = 0; i < 400; i++) {
        random = random * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
        const size_t at = (size_t)((random >> 33) % (i % 2 ? 2000 : size));
        const unsigned char before = block[at];
        block[at] = (unsigned char)(random >> 20);
        if (dmb_fatigue_restore(fatigue, block, size) < 0) {
            refused_ones++;
            assert_same_counts(fatigue, kept);
        } else {
            const int32_t status = dmb_fatigue_take(fatigue, s.sim);
            if (status != DMB_ERR_ORDER) must(status, "take"); /* a last sample that was forged to be later */
            block[at] = before;
            must(dmb_fatigue_restore(fatigue, block, size), "restore");
        }
        block[at] = before;
    }
    assert_in_range(refused_ones, 20, 390);
    free(block);
    dmb_fatigue_destroy(&fatigue);
    dmb_fatigue_destroy(&kept);
    dmb_fatigue_destroy(&other);
    destroy(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(damage_of_turns),
                                       cmocka_unit_test(damage_by_any_levels),
                                       cmocka_unit_test(factors),
                                       cmocka_unit_test(mean_above_the_strength),
                                       cmocka_unit_test(largest_range_without_damage),
                                       cmocka_unit_test(refused),
                                       cmocka_unit_test(counts_on_after_a_restore),
                                       cmocka_unit_test(forged_counts),
                                       cmocka_unit_test(bending_that_is_not_seen)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
