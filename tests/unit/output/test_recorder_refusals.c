/* Recorders and windows: what they refuse, with nothing written; names of unknown quantities in tables; windows that a
 * sim cannot answer, and samples that come after a long time. */
#include <stdio.h>
#include <string.h>

#include "rig.h"

typedef struct subject {
    rig s;
    dmb_id string, body;
    dmb_output outputs[2];
    int32_t quantities[2];
    double table[64];
    dmb_recorder rows;
    dmb_profile profile;
    dmb_profile_recorder profiles;
} subject;

static void open_subject(subject *c)
{
    const dmb_pipe_def pipe = s1_pipe();
    const dmb_wall_def hole = s1_hole();
    dmb_body_def body = dmb_body_def_default();
    memset(c, 0, sizeof *c);
    rig_open(&c->s, 0.0, 0.0, -9.81);
    (void)add_wall(&c->s, &hole);
    c->string = add_pipes(&c->s, &pipe, 2);
    body.position[1] = 3.0;
    c->body = add_body(&c->s, &body);
    (void)rig_start(&c->s, NULL);
    c->outputs[0] = (dmb_output){dmb_station(c->string, 0, 0.5), DMB_OUTPUT_POSITION_X, 0};
    c->outputs[1] = (dmb_output){dmb_station(c->body, 0, 0.0), DMB_OUTPUT_VELOCITY_Z, 0};
    c->rows = dmb_recorder_default();
    c->rows.outputs = c->outputs;
    c->rows.output_count = 2;
    c->rows.table = c->table;
    c->rows.capacity = 4;
    c->quantities[0] = DMB_PROFILE_DISTANCE, c->quantities[1] = DMB_PROFILE_X;
    c->profile = dmb_profile_default();
    c->profile.station_count = 3;
    c->profile.quantities = c->quantities;
    c->profile.quantity_count = 2;
    c->profiles = dmb_profile_recorder_default();
    c->profiles.profile = &c->profile;
    c->profiles.table = c->table;
    c->profiles.capacity = 4;
    for (int i = 0; i < 64; i++) c->table[i] = 7.0;
}

static void check_untouched(const subject *c)
{
    for (int i = 0; i < 64; i++)
        if (c->table[i] != 7.0) fail_msg("number %d of the table is written", i);
    assert_int_equal(c->rows.row_count, 0);
    assert_int_equal(c->profiles.row_count, 0);
}

/* ---- Recorders --------------------------------------------------------------------------------------------------- */

enum {
    STRUCT,
    NO_LIST,
    NO_TABLE,
    NO_COUNT,
    MANY,
    NOT_FINITE,
    NEGATIVE,
    OVERFULL,
    TOO_LARGE,
    UNKNOWN,
    OTHER_PART,
    CASES
};
static const int32_t wanted[CASES] = {DMB_ERR_STRUCT_SIZE, DMB_ERR_NULL,       DMB_ERR_NULL,  DMB_ERR_VALUE,
                                      DMB_ERR_VALUE,       DMB_ERR_NOT_FINITE, DMB_ERR_VALUE, DMB_ERR_VALUE,
                                      DMB_ERR_VALUE,       DMB_ERR_VALUE,      DMB_ERR_ID};

static dmb_recorder bad_recorder(subject *c, int what)
{
    dmb_recorder r = c->rows;
    if (what == STRUCT) r.struct_size = 3;
    if (what == NO_LIST) r.outputs = NULL;
    if (what == NO_TABLE) r.table = NULL;
    if (what == NO_COUNT) r.output_count = 0;
    if (what == MANY) r.output_count = UINT32_MAX;
    if (what == NOT_FINITE) r.interval = (double)NAN;
    if (what == NEGATIVE) r.interval = -1.0;
    if (what == OVERFULL) r.row_count = 5;
    if (what == TOO_LARGE) r.capacity = UINT64_MAX;
    if (what == UNKNOWN) c->outputs[1].quantity = 99;
    if (what == OTHER_PART) c->outputs[1].place.part = (dmb_id){9u << 24, 1};
    return r;
}

static void recorders(void **state)
{
    (void)state;
    for (int what = 0; what < CASES; what++) {
        subject c;
        open_subject(&c);
        dmb_recorder r = bad_recorder(&c, what);
        const uint64_t rows = r.row_count;
        const int32_t status = dmb_recorder_take(&r, c.s.sim);
        if (status != wanted[what]) fail_msg("case %d: %s", what, dmb_status_name(status));
        assert_int_equal(r.row_count, rows);
        if (what < UNKNOWN) check_untouched(&c);
        if (what < UNKNOWN) assert_int_equal(dmb_recorder_write_csv(&r, NULL, "/dev/null"), wanted[what]);
        rig_close(&c.s);
    }
}

static dmb_profile_recorder bad_profiles(subject *c, int what)
{
    dmb_profile_recorder r = c->profiles;
    if (what == STRUCT) r.struct_size = 3;
    if (what == NO_LIST) c->profile.quantities = NULL;
    if (what == NO_TABLE) r.table = NULL;
    if (what == NO_COUNT) c->profile.quantity_count = 0;
    if (what == MANY) c->profile.quantity_count = (DMB_PROFILE_GAP + 1) + 1;
    if (what == NOT_FINITE) r.interval = (double)INFINITY;
    if (what == NEGATIVE) r.interval = -1.0;
    if (what == OVERFULL) r.row_count = 5;
    if (what == TOO_LARGE) r.capacity = UINT64_MAX;
    if (what == UNKNOWN) c->quantities[1] = 99;
    if (what == OTHER_PART) c->profile.string = c->body;
    return r;
}

static void profile_recorders(void **state)
{
    (void)state;
    for (int what = 0; what < CASES; what++) {
        subject c;
        open_subject(&c);
        dmb_profile_recorder r = bad_profiles(&c, what);
        const uint64_t rows = r.row_count;
        const int32_t status = dmb_profile_recorder_take(&r, c.s.sim);
        if (status != wanted[what]) fail_msg("case %d: %s", what, dmb_status_name(status));
        assert_int_equal(r.row_count, rows);
        check_untouched(&c);
        if (what < UNKNOWN) assert_int_equal(dmb_profile_recorder_write_csv(&r, "/dev/null"), wanted[what]);
        rig_close(&c.s);
    }
    subject c;
    open_subject(&c);
    dmb_profile_recorder r = c.profiles;
    r.profile = NULL;
    assert_int_equal(dmb_profile_recorder_take(&r, c.s.sim), DMB_ERR_NULL);
    r = c.profiles;
    c.profile.struct_size = 5;
    assert_int_equal(dmb_profile_recorder_take(&r, c.s.sim), DMB_ERR_STRUCT_SIZE);
    c.profile.struct_size = sizeof c.profile;
    for (uint32_t stations = 0; stations < 2; stations++) {
        c.profile.station_count = stations ? UINT32_MAX : 0;
        assert_int_equal(dmb_profile_recorder_take(&r, c.s.sim), DMB_ERR_VALUE);
    }
    check_untouched(&c);
    rig_close(&c.s);
}

/* Without rows to write there need be no table. */
static void without_room(void **state)
{
    (void)state;
    subject c;
    open_subject(&c);
    c.rows.table = c.profiles.table = NULL;
    c.rows.capacity = c.profiles.capacity = 0;
    assert_int_equal(dmb_recorder_take(&c.rows, c.s.sim), DMB_NOTE_FULL);
    assert_int_equal(dmb_profile_recorder_take(&c.profiles, c.s.sim), DMB_NOTE_FULL);
    check_untouched(&c);
    assert_int_equal(dmb_profile_recorder_write_csv(&c.profiles, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_recorder_write_csv(&c.rows, NULL, NULL), DMB_ERR_NULL);
    rig_close(&c.s);
}

static const char *text_of(const char *path)
{
    static char text[4096];
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    text[fread(text, 1, sizeof text - 1, file)] = '\0';
    fclose(file);
    remove(path);
    return text;
}

static void unknown_names(void **state)
{
    static const char *const path = "recorder_refusals.csv";
    (void)state;
    subject c;
    open_subject(&c);
    c.outputs[0].quantity = 99;
    c.outputs[1].place.part = (dmb_id){200u << 24 | 4u, 1};
    assert_int_equal(dmb_recorder_write_csv(&c.rows, NULL, path), DMB_OK);
    assert_string_equal(text_of(path), "time [s],unknown of string 0 pipe 0 at 0.5 [-],velocity_z of part 4 [m/s]\n");
    c.quantities[0] = -1;
    assert_int_equal(dmb_profile_recorder_write_csv(&c.profiles, path), DMB_OK);
    assert_string_equal(text_of(path), "time [s],station,unknown [-],x [m]\n");
    rig_close(&c.s);
}

/* ---- Windows ----------------------------------------------------------------------------------------------------- */

static dmb_window *window_of(subject *c, double length)
{
    dmb_window_options options = dmb_window_options_default();
    dmb_window *window = NULL;
    options.length = length;
    must(&c->s, dmb_window_create(c->s.sim, &options, c->outputs, 2, &window));
    return window;
}

static dmb_window_result result_of(const dmb_window *window, uint32_t output)
{
    dmb_window_result result = dmb_window_result_default();
    assert_int_equal(dmb_window_get(window, output, &result), DMB_OK);
    return result;
}

/* Of what is older than the window nothing counts, however long no sample came. */
static void a_long_time_between_samples(void **state)
{
    (void)state;
    subject c;
    open_subject(&c);
    dmb_window *window = window_of(&c, 0.01);
    for (int i = 0; i < 5; i++) {
        take_steps(&c.s, 1e-3, 1);
        assert_int_equal(dmb_window_take(window, c.s.sim), DMB_OK);
    }
    assert_int_equal(result_of(window, 1).samples, 5);
    take_divided_steps(&c.s, 1e-3, 200); /* the string rattles, the body falls freely */
    assert_int_equal(dmb_window_take(window, c.s.sim), DMB_OK);
    const dmb_window_result now = result_of(window, 1);
    assert_int_equal(now.samples, 1);
    check_close("free fall [m/s]", now.maximum, -9.81 * 0.205, 1e-9);
    check_close("    and nothing before it", now.minimum, now.maximum, 0.0);
    dmb_window_destroy(&window);
    rig_close(&c.s);
}

/* A sim without what is watched, or a number that is none: nothing of the sample counts. */
static void samples_that_are_refused(void **state)
{
    (void)state;
    subject c, other;
    open_subject(&c);
    open_subject(&other);
    dmb_window *window = window_of(&c, 1.0);
    assert_int_equal(dmb_window_take(window, c.s.sim), DMB_OK);
    take_steps(&other.s, 1e-3, 1);
    assert_int_equal(dmb_window_take(window, other.s.sim), DMB_ERR_ID);
    assert_int_equal(result_of(window, 0).samples, 1);
    assert_int_equal(result_of(window, 1).samples, 1);
    dmb_window_destroy(&window);
    c.outputs[1] = (dmb_output){dmb_station(c.string, 0, 0.0), DMB_OUTPUT_PROFILE + DMB_PROFILE_GAP, 0};
    window = window_of(&c, 1.0); /* a guided rig end has no place at the wall */
    assert_int_equal(dmb_window_take(window, c.s.sim), DMB_ERR_NOT_FINITE);
    assert_int_equal(result_of(window, 0).samples, 0);
    dmb_window_destroy(&window);
    rig_close(&other.s);
    rig_close(&c.s);
}

static void levels_of_windows(void **state)
{
    (void)state;
    subject c;
    open_subject(&c);
    const double levels[3][2] = {{-1.0, 0.0}, {0.0, -1.0}, {1.0, (double)NAN}};
    for (int i = 0; i < 3; i++) {
        dmb_window_options options = dmb_window_options_default();
        dmb_window *window = NULL;
        options.levels = levels[i];
        assert_true(dmb_window_create(c.s.sim, &options, c.outputs, 2, &window) < 0);
        assert_null(window);
        assert_non_null(strstr(dmb_sim_message(c.s.sim), "window: levels = "));
    }
    rig_close(&c.s);
}

/* A recorder of a window asks it for the numbers of windows alone. */
static void numbers_of_windows(void **state)
{
    (void)state;
    subject c;
    open_subject(&c);
    dmb_window *window = window_of(&c, 1.0);
    take_steps(&c.s, 1e-3, 1);
    assert_int_equal(dmb_window_take(window, c.s.sim), DMB_OK);
    const dmb_place watch = dmb_station((dmb_id){0, 0}, 1, 0.0);
    c.outputs[0] = (dmb_output){watch, DMB_OUTPUT_WINDOW_LOW_SHARE, 0};
    c.outputs[1] = (dmb_output){watch, DMB_OUTPUT_WINDOW_LOW_SHARE + 1, 0};
    c.rows.window = window;
    assert_int_equal(dmb_recorder_take(&c.rows, c.s.sim), DMB_ERR_VALUE);
    c.outputs[1].quantity = DMB_OUTPUT_WINDOW_MINIMUM;
    assert_int_equal(dmb_recorder_take(&c.rows, c.s.sim), DMB_OK);
    check_close("least of the window [m/s]", c.table[2], -9.81e-3, 1e-12);
    c.outputs[1].place.pipe = 2;
    assert_int_equal(dmb_recorder_take(&c.rows, c.s.sim), DMB_ERR_VALUE);
    dmb_window_destroy(&window);
    rig_close(&c.s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(recorders),
        cmocka_unit_test(profile_recorders),
        cmocka_unit_test(without_room),
        cmocka_unit_test(unknown_names),
        cmocka_unit_test(a_long_time_between_samples),
        cmocka_unit_test(samples_that_are_refused),
        cmocka_unit_test(levels_of_windows),
        cmocka_unit_test(numbers_of_windows),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
