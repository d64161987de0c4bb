/* A model as a handle: its life, dead and foreign ids, and copies against what the caller changes later. */
#include "model_test.h"

#include "base/sized_struct.h"

static void create_and_destroy(void **state)
{
    dmb_model *model = (dmb_model *)1;
    dmb_model_options options = dmb_model_options_default();
    (void)state;
    assert_int_equal(dmb_model_create(NULL, NULL), DMB_ERR_NULL);
    options.struct_size = 3;
    assert_int_equal(dmb_model_create(&options, &model), DMB_ERR_STRUCT_SIZE);
    assert_null(model);
    assert_ok(dmb_model_create(NULL, &model));
    assert_string_equal(dmb_model_message(model), "");
    dmb_model_destroy(&model);
    assert_null(model);
    dmb_model_destroy(&model);
    dmb_model_destroy(NULL);
    assert_string_equal(dmb_model_message(NULL), dmb_status_text(DMB_ERR_NULL));
}

static void allocator_must_be_whole(void **state)
{
    dmb_model *model = NULL;
    dmb_model_options options = dmb_model_options_default();
    dmb_allocator allocator = dmb_allocator_default();
    (void)state;
    options.allocator = &allocator;
    allocator.release = NULL;
    assert_int_equal(dmb_model_create(&options, &model), DMB_ERR_NULL);
    allocator = dmb_allocator_default();
    allocator.struct_size = 8;
    assert_int_equal(dmb_model_create(&options, &model), DMB_ERR_STRUCT_SIZE);
    assert_null(model);
}

/* Handles that are no model are refused by everything. */
static void wrong_handles(void **state)
{
    struct dmb_model other;
    const dmb_pipe_def pipe = dmb_pipe_def_default();
    const dmb_wall_def wall = dmb_wall_def_default();
    const dmb_segment term = dmb_segment_default();
    dmb_model_info info = dmb_model_info_default();
    dmb_model *pointer = &other;
    (void)state;
    memset(&other, 0, sizeof other);
    other.magic = DMB_HANDLE_DEAD;
    assert_int_equal(dmb_model_add_pipes(pointer, &pipe, 1, NULL), DMB_ERR_HANDLE);
    assert_int_equal(dmb_model_add_wall(pointer, &wall, NULL), DMB_ERR_HANDLE);
    assert_int_equal(dmb_model_add_time_function(pointer, &term, 1, NULL), DMB_ERR_HANDLE);
    assert_int_equal(dmb_model_compile(pointer, NULL), DMB_ERR_HANDLE);
    assert_int_equal(dmb_model_get_info(pointer, &info), DMB_ERR_HANDLE);
    assert_string_equal(dmb_model_message(pointer), dmb_status_text(DMB_ERR_HANDLE));
    dmb_model_destroy(&pointer);
    assert_null(pointer);
    assert_int_equal(dmb_model_add_pipes(NULL, &pipe, 1, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_model_compile(NULL, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_model_get_info(NULL, &info), DMB_ERR_NULL);
}

static void null_definitions(void **state)
{
    dmb_model *model = new_model();
    (void)state;
    assert_int_equal(dmb_model_set_environment(model, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_model_add_time_function(model, NULL, 1, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_model_add_wall(model, NULL, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_model_add_string(model, NULL, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_model_add_pipes(model, NULL, 1, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_model_add_body(model, NULL, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_model_add_bit(model, NULL, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_model_add_drive(model, NULL, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_model_add_load(model, NULL, NULL), DMB_ERR_NULL);
    assert_true(strlen(dmb_model_message(model)) > 0);
    dmb_model_destroy(&model);
}

static void ids_name_parts_of_their_model(void **state)
{
    dmb_model *a = new_model(), *b = new_model();
    const dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_id first, second, none = {0, 0};
    (void)state;
    assert_ok(dmb_model_add_string(a, &string, &first));
    assert_ok(dmb_model_add_string(a, &string, &second));
    assert_int_equal(first.index, (uint32_t)DMB_PART_STRING << 24);
    assert_int_equal(second.index, (uint32_t)DMB_PART_STRING << 24 | 1);
    assert_true(first.generation != 0);
    assert_int_equal(dmb_model_part_index(a, second, DMB_PART_STRING), 1);
    assert_int_equal(dmb_model_part_index(a, second, DMB_PART_BODY), DMB_NONE);
    assert_int_equal(dmb_model_part_index(b, first, DMB_PART_STRING), DMB_NONE);
    assert_int_equal(dmb_model_part_index(a, none, DMB_PART_STRING), DMB_NONE);
    second.index += 1;
    assert_int_equal(dmb_model_part_index(a, second, DMB_PART_STRING), DMB_NONE);
    pipe.string = first;
    assert_int_equal(dmb_model_add_pipes(b, &pipe, 1, NULL), DMB_ERR_ID);
    assert_non_null(strstr(dmb_model_message(b), "string"));
    assert_int_equal(b->strings.count, 0);
    dmb_model_destroy(&a);
    dmb_model_destroy(&b);
}

/* The first pipes make a string; refused ones do not. */
static void pipes_make_the_first_string(void **state)
{
    dmb_model *model = new_model();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_id id = {0, 0};
    (void)state;
    pipe.outer_diameter = -1.0;
    assert_int_equal(dmb_model_add_pipes(model, &pipe, 1, &id), DMB_ERR_VALUE);
    assert_string_equal(dmb_model_message(model),
                        "pipes of string 0: outer_diameter = -1, must be finite, >= 1e-06 and <= 1000000");
    assert_int_equal(id.generation, 0);
    assert_int_equal(model->strings.count, 0);
    pipe.outer_diameter = 0.073;
    assert_ok(dmb_model_add_pipes(model, &pipe, 3, &id));
    assert_ok(dmb_model_add_pipes(model, &pipe, 2, &id));
    assert_int_equal(id.index, (uint32_t)DMB_PART_STRING << 24);
    assert_int_equal(model->strings.count, 1);
    assert_int_equal(dmb_mesh_run_at(&(dmb_mesh){.model = model}, 1)->first, 3);
    dmb_model_destroy(&model);
}

static void compiled_is_frozen(void **state)
{
    dmb_model *model = new_model();
    const dmb_pipe_def pipe = dmb_pipe_def_default();
    const dmb_wall_def wall = dmb_wall_def_default();
    const dmb_segment term = dmb_segment_default();
    const dmb_environment_def environment = dmb_environment_def_default();
    dmb_model_info info = dmb_model_info_default();
    const dmb_scene *scene;
    char said[256];
    (void)state;
    add_pipes(model, &pipe, 1);
    assert_int_equal(dmb_model_get_info(model, &info), DMB_ERR_ORDER);
    scene = compiled(model);
    memcpy(said, dmb_model_message(model), sizeof said);
    assert_non_null(strstr(said, "compiled: 2 nodes, 1 elements"));
    assert_int_equal(dmb_model_add_pipes(model, &pipe, 1, NULL), DMB_ERR_ORDER);
    assert_int_equal(dmb_model_add_wall(model, &wall, NULL), DMB_ERR_ORDER);
    assert_int_equal(dmb_model_add_time_function(model, &term, 1, NULL), DMB_ERR_ORDER);
    assert_int_equal(dmb_model_set_environment(model, &environment), DMB_ERR_ORDER);
    assert_int_equal(dmb_model_compile(model, NULL), DMB_ERR_ORDER);
    assert_ptr_equal(model->scene, scene);
    assert_string_equal(model->message.text, said);                                /* other threads may be reading it */
    assert_non_null(strstr(dmb_model_message(model), "does not change any more")); /* of this thread */
    assert_ok(dmb_model_get_info(model, &info));
    assert_int_equal(dmb_model_get_info(model, NULL), DMB_ERR_NULL);
    info.struct_size = 5;
    assert_int_equal(dmb_model_get_info(model, &info), DMB_ERR_STRUCT_SIZE);
    dmb_model_destroy(&model);
}

/* A holder keeps the model alive after its maker has let go, though it is no handle from then on. */
static void holders(void **state)
{
    dmb_model *model = new_model(), *kept = model;
    const dmb_pipe_def pipe = dmb_pipe_def_default();
    (void)state;
    add_pipes(model, &pipe, 1);
    (void)compiled(model);
    dmb_model_hold(model);
    dmb_model_destroy(&model);
    assert_int_equal(kept->magic, DMB_HANDLE_DEAD);
    assert_int_equal(kept->holders, 1);
    assert_int_equal(kept->scene->node_count, 2);
    dmb_model_release(kept);
}

static void one_hole_a_model(void **state)
{
    dmb_model *model = new_model();
    const dmb_wall_def wall = dmb_wall_def_default();
    (void)state;
    add_wall(model);
    assert_int_equal(dmb_model_add_wall(model, &wall, NULL), DMB_ERR_ORDER);
    assert_non_null(strstr(dmb_model_message(model), "one hole"));
    dmb_model_destroy(&model);
}

/* Later changes of the caller's arrays do not matter. */
static void arrays_are_copied(void **state)
{
    dmb_model *model = new_model();
    const dmb_pipe_def pipe = dmb_pipe_def_default();
    double survey[] = {0.0, 1.5, 0.0, 50.0, 1.2, 0.1}, times[] = {0.0, 1.0, 2.0}, values[] = {5.0, 6.0, 7.0};
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_segment terms[2];
    const dmb_scene *scene;
    (void)state;
    wall.survey = survey;
    wall.survey_count = 2;
    assert_ok(dmb_model_add_wall(model, &wall, NULL));
    terms[0] = dmb_segment_default();
    terms[0].h0 = 100.0;
    terms[1] = dmb_segment_default();
    terms[1].kind = DMB_SEGMENT_TABLE;
    terms[1].table_time = times;
    terms[1].table_value = values;
    terms[1].table_count = 3;
    assert_ok(dmb_model_add_time_function(model, terms, 2, NULL));
    memset(survey, 0xFF, sizeof survey);
    memset(times, 0xFF, sizeof times);
    memset(values, 0xFF, sizeof values);
    memset(terms, 0xFF, sizeof terms);
    add_pipes(model, &pipe, 20);
    scene = compiled(model);
    double value = 0.0;
    assert_ok(dmb_time_function_value(&scene->time_functions[0], 1.5, &value, NULL));
    assert_near(value, 106.5, 1e-15);
    assert_int_equal(scene->time_function_count, 1);
    assert_int_equal(scene->hole.stations, 2);
    assert_near(scene->hole.station[1].depth, 50.0, 0.0);
    dmb_model_destroy(&model);
}

/* Terms of a caller with a longer struct stand further apart. */
static void terms_of_another_size(void **state)
{
    dmb_model *model = new_model();
    struct {
        dmb_segment term;
        double more;
    } terms[2];
    dmb_id id = {0, 0};
    double value = 0.0;
    (void)state;
    for (int i = 0; i < 2; ++i) {
        assert_ok(dmb_segment_init(&terms[i].term, (uint32_t)sizeof terms[i]));
        terms[i].term.h0 = 1.0 + i;
    }
    assert_ok(dmb_model_add_time_function(model, &terms[0].term, 2, &id));
    assert_ok(dmb_time_function_value(DMB_LIST_AT(dmb_time_function, model->time_functions, 0), 0.0, &value, NULL));
    assert_near(value, 3.0, 0.0);
    terms[1].more = 4.0; /* something this library does not know */
    assert_int_equal(dmb_model_add_time_function(model, &terms[0].term, 2, &id), DMB_ERR_STRUCT_SIZE);
    terms[1].more = 0.0;
    terms[1].term.struct_size = sizeof(dmb_segment);
    assert_int_equal(dmb_model_add_time_function(model, &terms[0].term, 2, &id), DMB_ERR_STRUCT_SIZE);
    assert_true(strlen(dmb_model_message(model)) > 0);
    assert_int_equal(model->time_functions.count, 1);
    dmb_model_destroy(&model);
}

/* Fields that a term does not use are not kept, whatever their value. */
static void unused_fields_are_forgotten(void **state)
{
    dmb_model *model = new_model();
    dmb_segment term = dmb_segment_default();
    const dmb_segment *kept;
    const double number = 1.0;
    (void)state;
    term.table_time = term.table_value = &number;
    term.table_count = 1000;
    term.callback_context = &term;
    assert_ok(dmb_model_add_time_function(model, &term, 1, NULL));
    kept = DMB_LIST_AT(dmb_time_function, model->time_functions, 0)->segments;
    assert_null(kept->table_time);
    assert_null(kept->table_value);
    assert_null(kept->callback_context);
    assert_int_equal(kept->table_count, 0);
    dmb_model_destroy(&model);
}

typedef struct log_book {
    int lines, level;
    char last[256];
} log_book;

static void write_down(void *context, int32_t level, const char *text)
{
    log_book *book = context;
    ++book->lines;
    book->level = level;
    strncpy(book->last, text, sizeof book->last - 1);
}

static void log_is_told(void **state)
{
    log_book book = {0};
    dmb_model_options options = dmb_model_options_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_model *model;
    (void)state;
    options.log = write_down;
    options.log_context = &book;
    assert_ok(dmb_model_create(&options, &model));
    pipe.length = (double)NAN;
    assert_int_equal(dmb_model_add_pipes(model, &pipe, 1, NULL), DMB_ERR_NOT_FINITE);
    assert_int_equal(book.lines, 1);
    assert_int_equal(book.level, DMB_LOG_ERROR);
    assert_string_equal(book.last, dmb_model_message(model));
    pipe.length = 1.0;
    add_pipes(model, &pipe, 1);
    (void)compiled(model);
    assert_int_equal(book.lines, 2);
    assert_int_equal(book.level, DMB_LOG_INFO);
    dmb_model_destroy(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(create_and_destroy),
        TEST(allocator_must_be_whole),
        TEST(wrong_handles),
        TEST(null_definitions),
        TEST(ids_name_parts_of_their_model),
        TEST(pipes_make_the_first_string),
        TEST(compiled_is_frozen),
        TEST(holders),
        TEST(one_hole_a_model),
        TEST(arrays_are_copied),
        TEST(terms_of_another_size),
        TEST(unused_fields_are_forgotten),
        TEST(log_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
