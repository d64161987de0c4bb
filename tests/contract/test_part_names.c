/* Names of parts against the messages that tell of those parts, where they are described, compiled, run and analysed,
 * and against what look-ups by name find; without names the parts are told by number as before. */
#include "sim_test.h"

static void expect(const char *message, const char *text)
{
    if (strstr(message, text) == NULL) fail_msg("\"%s\" without \"%s\"", message, text);
}

static void told_where_described(void **state)
{
    dmb_model *model;
    dmb_body_def body = dmb_body_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_load_def load = dmb_load_def_default();
    dmb_id id;
    (void)state;
    must(dmb_model_create(NULL, &model));
    body.mass = -1.0;
    assert_int_equal(dmb_model_add_body(model, &body, NULL), DMB_ERR_VALUE);
    expect(dmb_model_message(model), "body 0: mass = -1");
    strcpy(body.name, "turbine");
    assert_int_equal(dmb_model_add_body(model, &body, NULL), DMB_ERR_VALUE);
    expect(dmb_model_message(model), "body 0 (turbine): mass = -1");
    body.mass = 1.0;
    body.inertia[0] = 0.3;
    assert_int_equal(dmb_model_add_body(model, &body, NULL), DMB_ERR_VALUE);
    expect(dmb_model_message(model), "body 0 (turbine): inertia gives the principal");
    body.inertia[0] = 1e-3;
    body.inertia[3] = 1.0;
    assert_int_equal(dmb_model_add_body(model, &body, NULL), DMB_ERR_VALUE);
    expect(dmb_model_message(model), "body 0 (turbine): inertia = (0.001");
    body.inertia[3] = 0.0;
    must(dmb_model_add_body(model, &body, &id));
    memset(body.name, 'x', sizeof body.name);
    assert_int_equal(dmb_model_add_body(model, &body, NULL), DMB_ERR_VALUE);
    expect(dmb_model_message(model), "body 1: name = 24 characters without an end, must be at most 23");
    strcpy(drive.name, "pump");
    drive.part = id;
    drive.time_function = id; /* a body */
    assert_int_equal(dmb_model_add_drive(model, &drive, NULL), DMB_ERR_ID);
    expect(dmb_model_message(model), "drive 0 (pump): time_function");
    memset(drive.name, 'x', sizeof drive.name);
    assert_int_equal(dmb_model_add_drive(model, &drive, NULL), DMB_ERR_VALUE);
    expect(dmb_model_message(model), "drive 0: name");
    strcpy(load.name, "hook");
    load.place = dmb_station(id, 0, 0.0);
    load.force[2] = (double)INFINITY;
    assert_int_equal(dmb_model_add_load(model, &load, NULL), DMB_ERR_NOT_FINITE);
    expect(dmb_model_message(model), "load 0 (hook): force[2] = inf");
    memset(load.name, 'x', sizeof load.name);
    assert_int_equal(dmb_model_add_load(model, &load, NULL), DMB_ERR_VALUE);
    expect(dmb_model_message(model), "load 0: name");
    dmb_model_destroy(&model);
}

static dmb_id constant(dmb_model *model, double value)
{
    dmb_segment term = dmb_segment_default();
    dmb_id id;
    term.h0 = value;
    must(dmb_model_add_time_function(model, &term, 1, &id));
    return id;
}

static void told_by_compile(void **state)
{
    dmb_model *model;
    dmb_body_def body = dmb_body_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_load_def load = dmb_load_def_default();
    (void)state;
    must(dmb_model_create(NULL, &model));
    body.free_mask = DMB_FREE_RX;
    must(dmb_model_add_body(model, &body, &drive.part));
    strcpy(drive.name, "pump");
    drive.time_function = constant(model, 1.0);
    drive.component = DMB_X;
    must(dmb_model_add_drive(model, &drive, NULL));
    assert_int_equal(dmb_model_compile(model, NULL), DMB_ERR_VALUE);
    expect(dmb_model_message(model), "drive 0 (pump): component = 0, must be free where the drive acts");
    dmb_model_destroy(&model);
    must(dmb_model_create(NULL, &model));
    must(dmb_model_add_body(model, &body, &load.place.part));
    strcpy(load.name, "hook");
    load.frame = DMB_FRAME_HOLE;
    must(dmb_model_add_load(model, &load, NULL));
    assert_int_equal(dmb_model_compile(model, NULL), DMB_ERR_GEOMETRY);
    expect(dmb_model_message(model), "load 0 (hook): frame = 2");
    dmb_model_destroy(&model);
}

static void told_by_runs_and_analyses(void **state)
{
    dmb_model *model;
    dmb_sim *sim;
    dmb_id id;
    dmb_body_def body = dmb_body_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    char text[8192];
    (void)state;
    must(dmb_model_create(NULL, &model));
    strcpy(body.name, "weight");
    must(dmb_model_add_body(model, &body, &drive.part));
    strcpy(body.name, "stone");
    must(dmb_model_add_body(model, &body, NULL));
    strcpy(drive.name, "pump");
    drive.component = DMB_RX;
    drive.time_function = constant(model, 1.0);
    must(dmb_model_add_drive(model, &drive, &id));
    must(dmb_model_compile(model, NULL));
    assert_true(dmb_sim_create(model, NULL, &sim) >= 0);
    assert_int_equal(dmb_sim_set_drive(sim, id, 1.0), DMB_ERR_UNSUPPORTED);
    expect(dmb_sim_message(sim), "drive 0 (pump): its kind is DMB_DRIVE_MOTION");
    assert_true(dmb_analysis_static(sim, NULL, NULL) < 0);
    expect(dmb_sim_message(sim), "): nothing holds it");
    must(dmb_analysis_check_text(sim, text, sizeof text, NULL));
    expect(text, "body 1 (stone): no support");
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
}

/* Strings, runs of pipes, bits, walls and time functions have names too; a mistake in a definition tells them. */
static void told_of_every_kind(void **state)
{
    dmb_model *model;
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_bit_def bit = dmb_bit_def_default();
    dmb_wall_def wall = dmb_wall_def_default();
    (void)state;
    must(dmb_model_create(NULL, &model));
    strcpy(string.name, "main");
    string.start_free = 1 << 15;
    assert_int_equal(dmb_model_add_string(model, &string, NULL), DMB_ERR_VALUE);
    expect(dmb_model_message(model), "string 0 (main): start_free");
    string.start_free = DMB_FREE_CYLINDRICAL;
    must(dmb_model_add_string(model, &string, &pipe.string));
    strcpy(pipe.name, "collars");
    pipe.length = -1.0;
    assert_int_equal(dmb_model_add_pipes(model, &pipe, 3, NULL), DMB_ERR_VALUE);
    expect(dmb_model_message(model), "pipes of string 0 (collars): length = -1");
    pipe.length = 9.0;
    must(dmb_model_add_pipes(model, &pipe, 3, NULL));
    strcpy(bit.name, "pdc");
    bit.mass = 0.0;
    assert_int_equal(dmb_model_add_bit(model, &bit, NULL), DMB_ERR_VALUE);
    expect(dmb_model_message(model), "bit 0 (pdc): mass = 0");
    bit.mass = 5.0;
    bit.diameter = 0.2;
    must(dmb_model_add_bit(model, &bit, NULL));
    strcpy(wall.name, "\xff");
    assert_int_equal(dmb_model_add_wall(model, &wall, NULL), DMB_ERR_VALUE);
    expect(dmb_model_message(model), "wall: name is no text, must be UTF-8");
    strcpy(wall.name, "pilot hole");
    must(dmb_model_add_wall(model, &wall, NULL));
    assert_int_equal(dmb_model_compile(model, NULL), DMB_ERR_GEOMETRY);
    expect(dmb_model_message(model), "bit 0 (pdc): diameter = 0.2, must be <= 0.094 m, the diameter of the hole");
    dmb_model_destroy(&model);
}

/* A state of a string in a run is told by the names of string and pipes. */
static void told_by_owners(void **state)
{
    dmb_model *model;
    dmb_sim *sim;
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_environment_def environment = dmb_environment_def_default();
    (void)state;
    must(dmb_model_create(NULL, &model));
    environment.gravity[0] = 9.81;
    must(dmb_model_set_environment(model, &environment));
    strcpy(string.name, "main");
    must(dmb_model_add_string(model, &string, &pipe.string));
    must(dmb_model_add_pipes(model, &pipe, 2, NULL));
    strcpy(pipe.name, "heavy");
    must(dmb_model_add_pipes(model, &pipe, 2, NULL));
    must(dmb_model_compile(model, NULL));
    assert_true(dmb_sim_create(model, NULL, &sim) >= 0);
    assert_true(dmb_analysis_static(sim, NULL, NULL) < 0);
    expect(dmb_sim_message(sim), "string 0 (main)");
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
}

static void must_be(const dmb_model *model, int32_t kind, const char *name, dmb_id part)
{
    dmb_id found = {0, 0};
    char text[DMB_NAME_SIZE];
    must(dmb_model_find(model, kind, name, &found));
    assert_memory_equal(&found, &part, sizeof part);
    must(dmb_model_get_name(model, part, text, sizeof text));
    assert_string_equal(text, name);
}

static void looked_up(void **state)
{
    dmb_model *model, *other;
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_body_def body = dmb_body_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_input_def input = dmb_input_def_default();
    dmb_id string, head, moved, set, time_function, found = {7, 7};
    uint32_t first, count;
    char text[DMB_NAME_SIZE], longer[64];
    (void)state;
    must(dmb_model_create(NULL, &model));
    must(dmb_model_add_pipes(model, &pipe, 5, &string));
    strcpy(pipe.name, "Schwerstangen \xc3\xa4");
    must(dmb_model_add_pipes(model, &pipe, 3, NULL));
    assert_int_equal(dmb_model_add_pipes(model, &pipe, 1, NULL), DMB_ERR_VALUE);
    expect(dmb_model_message(model), "must be of its own, and pipes of string 0 has it");
    must(dmb_model_clear_refused(model));
    strcpy(body.name, "head");
    must(dmb_model_add_body(model, &body, &head));
    assert_int_equal(dmb_model_add_body(model, &body, NULL), DMB_ERR_VALUE);
    expect(dmb_model_message(model), "body 1 (head): name = head, must be of its own, and body 0 has it; give another");
    must(dmb_model_clear_refused(model));
    time_function = constant(model, 1.0);
    drive.time_function = time_function;
    drive.component = DMB_RX;
    strcpy(drive.name, "rotation");
    must(dmb_model_add_drive(model, &drive, &moved));
    strcpy(input.name, "rotation");
    input.part = moved;
    input.rate_limit = 1.0;
    must(dmb_model_add_input(model, &input, &set));
    must_be(model, DMB_PART_ANY, "head", head);
    must_be(model, DMB_PART_DRIVE, "rotation", moved);
    must_be(model, DMB_PART_INPUT, "rotation", set);
    assert_int_equal(dmb_model_find(model, DMB_PART_ANY, "rotation", &found), DMB_ERR_VALUE);
    assert_int_equal(dmb_model_find(model, DMB_PART_ANY, "nobody", &found), DMB_ERR_ID);
    assert_int_equal(dmb_model_find(model, DMB_PART_ANY, "", &found), DMB_ERR_ID);
    assert_int_equal(dmb_model_find(model, 19, "head", &found), DMB_ERR_VALUE);
    assert_int_equal(dmb_model_find(model, -1, "head", &found), DMB_ERR_VALUE);
    assert_int_equal(dmb_model_find(model, 99, "head", &found), DMB_ERR_VALUE);
    assert_int_equal(found.index, 7);
    must(dmb_model_find_pipes(model, "Schwerstangen \xc3\xa4", &found, &first, &count));
    assert_memory_equal(&found, &string, sizeof found);
    assert_int_equal(first, 5);
    assert_int_equal(count, 3);
    assert_int_equal(dmb_model_find_pipes(model, "", &found, &first, &count), DMB_ERR_ID);
    must(dmb_model_find_pipes(model, "Schwerstangen \xc3\xa4", NULL, NULL, NULL)); /* they are there */
    strcpy(pipe.name, "two\nlines");
    assert_int_equal(dmb_model_add_pipes(model, &pipe, 1, NULL), DMB_ERR_VALUE);
    expect(dmb_model_message(model), "name is no text");
    must(dmb_model_clear_refused(model));
    must(dmb_model_set_name(model, time_function, "120 rpm"));
    must_be(model, DMB_PART_ANY, "120 rpm", time_function);
    must(dmb_model_set_name(model, time_function, "60 rpm"));
    assert_int_equal(dmb_model_find(model, DMB_PART_ANY, "120 rpm", &found), DMB_ERR_ID);
    const dmb_id second = constant(model, 2.0);
    must(dmb_model_set_name(model, second, "90 rpm"));
    must_be(model, DMB_PART_TIME_FUNCTION, "90 rpm", second);
    must_be(model, DMB_PART_TIME_FUNCTION, "60 rpm", time_function);
    assert_int_equal(dmb_model_set_name(model, second, "60 rpm"), DMB_ERR_VALUE);
    const dmb_id odd[3] = {
        {0, head.generation}, {UINT32_C(60) << 24, head.generation}, {UINT32_C(18) << 24, head.generation}};
    for (int i = 0; i < 3; i++) assert_int_equal(dmb_model_get_name(model, odd[i], text, sizeof text), DMB_ERR_ID);
    must(dmb_model_set_name(model, string, "main"));
    must(dmb_model_set_name(model, string, "main")); /* its own */
    must_be(model, DMB_PART_STRING, "main", string);
    must(dmb_model_set_name(model, string, ""));
    must(dmb_model_get_name(model, string, text, sizeof text));
    assert_string_equal(text, "");
    assert_int_equal(dmb_model_get_name(model, string, text, 8), DMB_ERR_VALUE);
    assert_int_equal(dmb_model_set_name(model, set, ""), DMB_ERR_VALUE);
    expect(dmb_model_message(model), "input 0 (rotation): name is empty");
    memset(longer, 'x', sizeof longer);
    longer[24] = '\0';
    assert_int_equal(dmb_model_set_name(model, head, longer), DMB_ERR_VALUE);
    expect(dmb_model_message(model), "at most 23");
    assert_int_equal(dmb_model_set_name(model, head, "two\nlines"), DMB_ERR_VALUE);
    assert_int_equal(dmb_model_set_name(model, head, "\xc0\x80"), DMB_ERR_VALUE);     /* not the shortest */
    assert_int_equal(dmb_model_set_name(model, head, "\xed\xa0\x80"), DMB_ERR_VALUE); /* a surrogate */
    assert_int_equal(dmb_model_set_name(model, head, "\xe2\x82"), DMB_ERR_VALUE);     /* cut */
    assert_int_equal(dmb_model_set_name(model, head, NULL), DMB_ERR_NULL);
    must_be(model, DMB_PART_ANY, "head", head);
    must(dmb_model_create(NULL, &other));
    assert_int_equal(dmb_model_set_name(other, head, "x"), DMB_ERR_ID);
    assert_int_equal(dmb_model_get_name(other, head, text, sizeof text), DMB_ERR_ID);
    dmb_model_destroy(&other);
    must(dmb_model_compile(model, NULL)); /* no call that was refused here is a part that is missing */
    assert_int_equal(dmb_model_set_name(model, head, "late"), DMB_ERR_ORDER);
    must_be(model, DMB_PART_ANY, "head", head);
    dmb_model_destroy(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(told_where_described),
        cmocka_unit_test(told_by_compile),
        cmocka_unit_test(told_by_runs_and_analyses),
        cmocka_unit_test(told_of_every_kind),
        cmocka_unit_test(told_by_owners),
        cmocka_unit_test(looked_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
