/* An input that replaces a time function which a segment per revolution follows: the segment goes on as described,
 * which compile says in its message and its log. Inputs of other parts, and segments that nothing uses, bring no
 * warning. */
#include "sim_test.h"

enum { FOLLOWED_MOTION, FOLLOWED_BY_LOAD, NOT_FOLLOWED, NOT_USED, LIMIT_ONLY, CONSTANT_DRIVE, CASES };

static int warnings;

static void count_warnings(void *context, int32_t level, const char *text)
{
    (void)context;
    if (level == DMB_LOG_WARNING && strstr(text, "per revolution as described") != NULL) warnings++;
}

static dmb_id add_input(dmb_model *model, dmb_id drive, int32_t target)
{
    dmb_input_def input = dmb_input_def_default();
    dmb_id id;
    strcpy(input.name, "speed");
    input.part = drive;
    input.target = target;
    if (target == DMB_TARGET_SET_POINT) input.rate_limit = 1.0;
    must(dmb_model_add_input(model, &input, &id));
    return id;
}

static void describe(dmb_model *model, int what)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_load_def load = dmb_load_def_default();
    dmb_segment worn = dmb_segment_default();
    dmb_id ramp, other, swing, id;
    must(dmb_model_add_string(model, &string, &pipe.string));
    must(dmb_model_add_pipes(model, &pipe, 2, NULL));
    must(dmb_model_add_ramp(model, 0.0, 10.0, 0.0, 1.0, &ramp));
    must(dmb_model_add_ramp(model, 0.0, 10.0, 0.0, 1.0, &other));
    worn.kind = DMB_SEGMENT_PER_REVOLUTION;
    worn.of = what == NOT_FOLLOWED ? other : ramp;
    worn.share = 0.02;
    must(dmb_model_add_time_function(model, &worn, 1, &swing));
    drive.part = pipe.string;
    drive.component = DMB_RX;
    drive.kind = what == LIMIT_ONLY ? DMB_DRIVE_CONTROL : DMB_DRIVE_MOTION;
    if (what != CONSTANT_DRIVE) drive.time_function = ramp;
    if (what != NOT_USED && what != FOLLOWED_BY_LOAD) drive.excitation = swing;
    must(dmb_model_add_drive(model, &drive, &id));
    load.place = dmb_station(pipe.string, 0, 1.0);
    load.force[0] = 1.0;
    if (what == FOLLOWED_BY_LOAD) load.time_function = swing;
    must(dmb_model_add_load(model, &load, NULL));
    (void)add_input(model, id, what == LIMIT_ONLY ? DMB_TARGET_LIMIT_HIGH : DMB_TARGET_SET_POINT);
}

static void told_by_compile(void **state)
{
    (void)state;
    for (int what = 0; what < CASES; what++) {
        const int expected = what == FOLLOWED_MOTION || what == FOLLOWED_BY_LOAD;
        dmb_model_options options = dmb_model_options_default();
        dmb_model *model;
        options.log = count_warnings;
        warnings = 0;
        must(dmb_model_create(&options, &model));
        describe(model, what);
        assert_int_equal(dmb_model_compile(model, NULL), DMB_OK);
        assert_int_equal(warnings, expected);
        const char *text = dmb_model_message(model);
        assert_int_equal(strstr(text, "warning: input 0 (speed): it replaces time function 0") != NULL, expected);
        dmb_model_destroy(&model);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(told_by_compile)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
