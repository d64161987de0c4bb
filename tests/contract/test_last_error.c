/* Every failing call is the last error of its thread: status, part, name, field, value and range as data, one message.
 * The error handler of the model sees each, once. */
#include "sim_test.h"

#include <pthread.h>

typedef struct seen {
    int calls;
    dmb_error last;
} seen;

static void see(void *context, const dmb_error *error)
{
    seen *s = context;
    s->calls++;
    s->last = *error;
}

typedef struct scene {
    seen seen;
    dmb_model *model;
    dmb_sim *sim;
    dmb_id string, drive;
} scene;

static void describe(scene *s)
{
    dmb_model_options options = dmb_model_options_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    memset(s, 0, sizeof *s);
    options.on_error = see;
    options.error_context = &s->seen;
    must(dmb_model_create(&options, &s->model));
    must(dmb_model_add_pipes(s->model, &pipe, 3, &s->string));
    drive.time_function = rig_step(s->model, 0.1);
    strcpy(drive.name, "feed");
    must(dmb_model_add_drive(s->model, &drive, &s->drive));
}

static void open_scene(scene *s)
{
    describe(s);
    must(dmb_model_compile(s->model, NULL));
    must(dmb_sim_create(s->model, NULL, &s->sim));
}

static void close_scene(scene *s)
{
    dmb_sim_destroy(&s->sim);
    dmb_model_destroy(&s->model);
}

static dmb_error last(void)
{
    dmb_error error = dmb_error_default();
    must(dmb_last_error(&error));
    return error;
}

/* The call has failed with that status; the handler has seen it, once, and the object has the same message. */
static dmb_error failed(scene *s, int32_t status, int32_t wanted, const char *message)
{
    const dmb_error error = last();
    assert_int_equal(status, wanted);
    assert_int_equal(error.status, wanted);
    assert_string_equal(message, error.message);
    assert_int_equal(s->seen.calls, 1);
    assert_memory_equal(&s->seen.last, &error, sizeof error);
    s->seen.calls = 0;
    return error;
}

static void parts_of_a_refusal(void **state)
{
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_body_def body = dmb_body_def_default();
    scene s;
    (void)state;
    describe(&s);
    pipe.inner_diameter = 0.08;
    pipe.outer_diameter = 0.0700000000000001;
    strcpy(pipe.name, "collars");
    int32_t status = dmb_model_add_pipes(s.model, &pipe, 2, NULL);
    dmb_error e = failed(&s, status, DMB_ERR_VALUE, dmb_model_message(s.model));
    assert_string_equal(e.kind, "pipes of string");
    assert_string_equal(e.name, "collars");
    assert_string_equal(e.field, "outer_diameter");
    assert_int_equal(e.number, 0);
    assert_int_equal(e.component, DMB_NONE);
    assert_true(e.value == pipe.outer_diameter && e.low == 0.08 && e.high == (double)INFINITY); /* all digits */
    assert_string_equal(e.given, "0.07");
    body.inertia[1] = -2.0;
    status = dmb_model_add_body(s.model, &body, NULL);
    e = failed(&s, status, DMB_ERR_VALUE, dmb_model_message(s.model));
    assert_string_equal(e.kind, "body");
    assert_string_equal(e.field, "inertia");
    assert_int_equal(e.component, 1);
    assert_true(e.value == -2.0);
    close_scene(&s);
}

static void parts_of_a_sentence(void **state)
{
    dmb_id id;
    scene s;
    (void)state;
    open_scene(&s);
    const int32_t status = dmb_model_find(s.model, DMB_PART_DRIVE, "fed", &id);
    const dmb_error e = failed(&s, status, DMB_ERR_ID, dmb_model_message(s.model));
    assert_string_equal(e.kind, "drive");
    assert_non_null(strstr(e.message, "no drive of this model has the name \"fed\""));
    assert_true(e.advice[0] != '\0' && isnan(e.value) && isnan(e.low) && isnan(e.high));
    close_scene(&s);
}

/* In this order: the message of a call comes after it. */
#define ASKED(call, wanted) (status_now = (call), failed(&s, status_now, wanted, dmb_sim_message(s.sim)))

/* A failure of before is not what a failing question tells. */
static void questions_have_messages(void **state)
{
    dmb_pose pose = dmb_pose_default();
    dmb_motion motion = dmb_motion_default();
    dmb_drive_state drive = dmb_drive_state_default();
    dmb_output output = {{{0, 0}, 0, 0, 0.0}, DMB_OUTPUT_DRIVE_FORCE, 0};
    dmb_id foreign;
    double value;
    int32_t status_now;
    scene s, other;
    (void)state;
    open_scene(&s);
    open_scene(&other);
    foreign = other.drive;
    assert_int_equal(dmb_sim_step(s.sim, -1.0, NULL), DMB_ERR_VALUE);
    dmb_error e = failed(&s, DMB_ERR_VALUE, DMB_ERR_VALUE, dmb_sim_message(s.sim));
    assert_string_equal(e.field, "duration");
    e = ASKED(dmb_query_pose(s.sim, dmb_station(s.string, 3, 0.0), &pose), DMB_ERR_VALUE);
    assert_string_equal(e.field, "pipe");
    assert_true(e.value == 3.0 && e.low == 0.0 && e.high == 2.0);
    e = ASKED(dmb_query_motion(s.sim, dmb_station(s.string, 0, 1.5), &motion), DMB_ERR_VALUE);
    assert_string_equal(e.field, "fraction");
    motion.frame = 7;
    e = ASKED(dmb_query_motion(s.sim, dmb_station(s.string, 0, 1.0), &motion), DMB_ERR_VALUE);
    assert_string_equal(e.field, "frame");
    e = ASKED(dmb_query_drive(s.sim, foreign, &drive), DMB_ERR_ID);
    assert_non_null(strstr(e.message, "another model"));
    e = ASKED(dmb_query_drive(s.sim, s.string, &drive), DMB_ERR_ID);
    assert_non_null(strstr(e.message, "string 0"));
    e = ASKED(dmb_query_output(s.sim, &output, &value), DMB_ERR_ID);
    assert_non_null(strstr(e.message, "place.part must be a drive"));
    e = ASKED(dmb_query_pose(s.sim, dmb_station(s.string, 0, 0.0), NULL), DMB_ERR_NULL);
    assert_non_null(strstr(e.message, "pose"));
    must(dmb_sim_step(s.sim, 1e-3, NULL));
    assert_string_equal(dmb_sim_message(s.sim), ""); /* a call that succeeds clears it */
    assert_int_equal(last().status, DMB_ERR_NULL);   /* and leaves the last error */
    close_scene(&other);
    close_scene(&s);
}

static void *no_memory(void *context, size_t size, size_t alignment)
{
    (void)context, (void)size, (void)alignment;
    return NULL;
}

/* Allocators without a function, names without an end and ids of another model have messages of their own. */
static void common_mistakes_have_messages(void **state)
{
    dmb_model_options options = dmb_model_options_default();
    dmb_allocator allocator = dmb_allocator_default();
    dmb_model *none = NULL;
    dmb_load_def load = dmb_load_def_default();
    dmb_bit_def bit = dmb_bit_def_default();
    scene s, other;
    (void)state;
    allocator.release = NULL;
    options.allocator = &allocator;
    assert_int_equal(dmb_model_create(&options, &none), DMB_ERR_NULL);
    assert_non_null(strstr(last().message, "allocator has no function allocate or release"));
    allocator = dmb_allocator_default();
    allocator.allocate = no_memory;
    assert_int_equal(dmb_model_create(&options, &none), DMB_ERR_NO_MEMORY);
    assert_null(none);
    describe(&s);
    open_scene(&other);
    bit.string = other.string;
    assert_int_equal(dmb_model_add_bit(s.model, &bit, NULL), DMB_ERR_ID);
    dmb_error e = failed(&s, DMB_ERR_ID, DMB_ERR_ID, dmb_model_message(s.model));
    assert_string_equal(e.field, "string");
    assert_non_null(strstr(e.message, "another model gave out this id: take one of this model"));
    memset(load.name, 'x', sizeof load.name);
    assert_int_equal(dmb_model_add_load(s.model, &load, NULL), DMB_ERR_VALUE);
    e = failed(&s, DMB_ERR_VALUE, DMB_ERR_VALUE, dmb_model_message(s.model));
    assert_non_null(strstr(e.message, "name = 24 characters without an end, must be at most 23"));
    close_scene(&other);
    close_scene(&s);
}

static void recorders_and_files_have_messages(void **state)
{
    dmb_output output;
    double table[8];
    int32_t status_now;
    dmb_recorder r = dmb_recorder_default();
    scene s;
    (void)state;
    open_scene(&s);
    output = (dmb_output){dmb_station(s.string, 0, 0.0), DMB_OUTPUT_DRIVE_FORCE, 0};
    r.outputs = &output;
    r.output_count = 1;
    r.table = table;
    r.capacity = 4;
    dmb_error e = ASKED(dmb_recorder_take(&r, s.sim), DMB_ERR_ID);
    assert_non_null(strstr(e.message, "drive_force"));
    r.interval = -1.0;
    e = ASKED(dmb_recorder_take(&r, s.sim), DMB_ERR_VALUE);
    assert_string_equal(e.field, "interval");
    r.interval = 0.0;
    assert_int_equal(dmb_recorder_write_csv(&r, NULL, "/no/such/folder/x.csv"), DMB_ERR_IO);
    assert_non_null(strstr(last().message, "/no/such/folder/x.csv"));
    close_scene(&s);
}

static void calls_without_an_object(void **state)
{
    dmb_model *model = NULL;
    dmb_error error = dmb_error_default();
    (void)state;
    assert_int_equal(dmb_model_create(NULL, NULL), DMB_ERR_NULL);
    assert_int_equal(last().status, DMB_ERR_NULL);
    assert_int_equal(dmb_model_compile(NULL, NULL), DMB_ERR_NULL);
    assert_non_null(strstr(last().message, "compile"));
    assert_int_equal(dmb_sim_step(NULL, 1.0, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_last_error(NULL), DMB_ERR_NULL);
    error.struct_size = 3;
    assert_int_equal(dmb_last_error(&error), DMB_ERR_STRUCT_SIZE);
    must(dmb_model_create(NULL, &model));
    dmb_model_destroy(&model);
}

/* ---- Threads ----------------------------------------------------------------------------------------------------- */

typedef struct asker {
    const scene *s;
    uint32_t pipe;
    int wrong;
} asker;

/* Asks for a pipe that is not there, and reads its own refusal however the other thread asks. */
static void *ask(void *context)
{
    asker *a = context;
    for (int i = 0; i < 2000; i++) {
        dmb_pose pose = dmb_pose_default();
        dmb_error error = dmb_error_default();
        const int32_t status = dmb_query_pose(a->s->sim, dmb_station(a->s->string, a->pipe, 0.0), &pose);
        (void)dmb_last_error(&error);
        a->wrong += status != DMB_ERR_VALUE || error.value != a->pipe;
        a->wrong += strcmp(error.message, dmb_sim_message(a->s->sim)) != 0;
    }
    return NULL;
}

static void threads_have_their_own(void **state)
{
    scene s;
    pthread_t threads[2];
    (void)state;
    describe(&s);
    dmb_model_destroy(&s.model);
    must(dmb_model_create(NULL, &s.model)); /* without a handler, which would be the caller's to guard */
    dmb_pipe_def pipe = dmb_pipe_def_default();
    must(dmb_model_add_pipes(s.model, &pipe, 3, &s.string));
    must(dmb_model_compile(s.model, NULL));
    must(dmb_sim_create(s.model, NULL, &s.sim));
    asker askers[2] = {{&s, 5, 0}, {&s, 9, 0}};
    for (int i = 0; i < 2; i++) assert_int_equal(pthread_create(threads + i, NULL, ask, askers + i), 0);
    for (int i = 0; i < 2; i++) assert_int_equal(pthread_join(threads[i], NULL), 0);
    assert_int_equal(askers[0].wrong + askers[1].wrong, 0);
    close_scene(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(parts_of_a_refusal),
        cmocka_unit_test(parts_of_a_sentence),
        cmocka_unit_test(questions_have_messages),
        cmocka_unit_test(recorders_and_files_have_messages),
        cmocka_unit_test(common_mistakes_have_messages),
        cmocka_unit_test(calls_without_an_object),
        cmocka_unit_test(threads_have_their_own),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
