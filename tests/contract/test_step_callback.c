/* Time functions of the caller's own functions: whatever such a function does wrong, the call that needed it fails with
 * DMB_ERR_CALLBACK and changes nothing; what it did not announce is not asked of it. */
#include "whole_scene.h"

/* The behaviour of the function from `from` on. */
enum {
    WELL,
    REFUSES,
    REFUSES_WITH_MINUS_ONE,
    GIVES_NAN,
    GIVES_INFINITY,
    GIVES_MINUS_INFINITY,
    GIVES_TOO_MUCH,
    GIVES_FAR_TOO_MUCH,
    WRITES_NOTHING,
    NO_RATE,
    NAN_RATE,
    NO_INTEGRAL,
    INFINITE_INTEGRAL,
    MISDEEDS
};

typedef struct source {
    int misdeed;
    double from; /* [s] */
    uint32_t calls;
    double first, last; /* [s] times it was asked for */
} source;

/* 1 + sin(t)/2 */
static int32_t value_of_time(void *context, double time, double out[3])
{
    source *s = context;
    const int misdeed = time >= s->from ? s->misdeed : WELL;
    s->first = s->calls == 0 ? time : fmin(s->first, time);
    s->last = s->calls == 0 ? time : fmax(s->last, time);
    ++s->calls;
    if (misdeed == WRITES_NOTHING) return 0;
    out[0] = 1.0 + 0.5 * sin(time);
    if (misdeed != NO_RATE) out[1] = misdeed == NAN_RATE ? (double)NAN : 0.5 * cos(time);
    if (misdeed != NO_INTEGRAL)
        out[2] = misdeed == INFINITE_INTEGRAL ? (double)INFINITY : time + 0.5 * (1.0 - cos(time));
    if (misdeed == GIVES_NAN) out[0] = (double)NAN;
    if (misdeed == GIVES_INFINITY) out[0] = (double)INFINITY;
    if (misdeed == GIVES_TOO_MUCH) out[0] = 1.0001e30;
    if (misdeed == GIVES_FAR_TOO_MUCH) out[0] = -1e308;
    if (misdeed == GIVES_MINUS_INFINITY) out[0] = -(double)INFINITY;
    return misdeed == REFUSES ? 7 : misdeed == REFUSES_WITH_MINUS_ONE ? -1 : 0;
}

/* The use of the time function. */
enum { MOTION, MOTION_EXCITATION, CONTROL, LOAD_DRIVE, LOAD_EXCITATION, LOAD_FACTOR, BIT_LOAD, USES };

typedef struct scene {
    source source;
    dmb_model *model;
    dmb_sim *sim;
} scene;

static dmb_id add_source(scene *s, int32_t provides)
{
    dmb_segment term = dmb_segment_default();
    dmb_id id = {0, 0};
    term.kind = DMB_SEGMENT_CALLBACK;
    term.provides = provides;
    term.callback = value_of_time;
    term.callback_context = &s->source;
    whole_must(s->model, dmb_model_add_time_function(s->model, &term, 1, &id));
    return id;
}

static dmb_id add_constant(scene *s)
{
    dmb_segment term = dmb_segment_default();
    dmb_id id = {0, 0};
    term.h0 = 0.5;
    whole_must(s->model, dmb_model_add_time_function(s->model, &term, 1, &id));
    return id;
}

static void add_drive(scene *s, int use, dmb_id time_function)
{
    dmb_drive_def drive = dmb_drive_def_default();
    const int excites = use == MOTION_EXCITATION || use == LOAD_EXCITATION;
    drive.time_function = excites ? add_constant(s) : time_function;
    if (excites) drive.excitation = time_function;
    if (use == LOAD_DRIVE || use == LOAD_EXCITATION) drive.kind = DMB_DRIVE_LOAD;
    if (use == CONTROL) {
        drive.kind = DMB_DRIVE_CONTROL;
        drive.gain = 100.0;
        drive.integral_gain = 10.0;
    }
    whole_must(s->model, dmb_model_add_drive(s->model, &drive, NULL));
}

static void add_load(scene *s, dmb_id string, dmb_id time_function)
{
    dmb_load_def load = dmb_load_def_default();
    load.place = dmb_station(string, 1, 1.0);
    load.force[0] = 100.0;
    load.time_function = time_function;
    whole_must(s->model, dmb_model_add_load(s->model, &load, NULL));
}

static void describe(scene *s, int use, int32_t provides)
{
    const dmb_wall_def wall = dmb_wall_def_default();
    const dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_bit_def bit = dmb_bit_def_default();
    dmb_id string = {0, 0};
    memset(s, 0, sizeof *s);
    s->source.from = (double)INFINITY;
    assert_int_equal(dmb_model_create(NULL, &s->model), DMB_OK);
    whole_must(s->model, dmb_model_add_wall(s->model, &wall, NULL));
    whole_must(s->model, dmb_model_add_pipes(s->model, &pipe, 3, &string));
    const dmb_id time_function = add_source(s, provides);
    if (use == BIT_LOAD) bit.load = time_function;
    whole_must(s->model, dmb_model_add_bit(s->model, &bit, NULL));
    if (use == LOAD_FACTOR) add_load(s, string, time_function);
    if (use < LOAD_FACTOR) add_drive(s, use, time_function);
    whole_must(s->model, dmb_model_compile(s->model, NULL));
}

static void open_scene(scene *s, int use, int32_t provides)
{
    describe(s, use, provides);
    s->sim = whole_sim(s->model, NULL);
    whole_run(s->sim, 3, 1e-3);
    assert_true(s->source.calls > 0);
}

static void close_scene(scene *s)
{
    dmb_sim_destroy(&s->sim);
    dmb_model_destroy(&s->model);
}

static void misbehave(scene *s, int misdeed, double from)
{
    s->source.misdeed = misdeed;
    s->source.from = from;
}

static uint64_t undisturbed(int use, int32_t provides)
{
    scene s;
    open_scene(&s, use, provides);
    whole_run(s.sim, 10, 1e-3);
    const uint64_t hash = whole_hash(s.sim);
    close_scene(&s);
    return hash;
}

static void must_fail(scene *s, int use, int misdeed)
{
    const uint64_t before = whole_hash(s->sim);
    const int32_t status = dmb_sim_step(s->sim, 1e-3, NULL);
    if (status != DMB_ERR_CALLBACK) fail_msg("use %d, misdeed %d: %s", use, misdeed, dmb_status_name(status));
    assert_true(dmb_sim_message(s->sim)[0] != '\0');
    if (whole_hash(s->sim) != before) fail_msg("use %d, misdeed %d: the state changed", use, misdeed);
    assert_int_equal(dmb_sim_advance(s->sim, dmb_sim_time(s->sim) + 1e-3, NULL), DMB_ERR_CALLBACK);
}

/* ---- Tests ------------------------------------------------------------------------------------------------------- */

/* Wrong values, in every place where a time function can be used; afterwards the run goes on as if it had not been. */
static void misdeeds_stop_the_step(void **state)
{
    (void)state;
    for (int use = 0; use < USES; use++) {
        const uint64_t wanted = undisturbed(use, 0);
        for (int misdeed = REFUSES; misdeed <= WRITES_NOTHING; misdeed++) {
            scene s;
            unsigned char snapshot[1 << 16];
            size_t size = 0;
            open_scene(&s, use, 0);
            assert_int_equal(dmb_sim_snapshot_size(s.sim, &size), DMB_OK);
            assert_true(size <= sizeof snapshot);
            assert_int_equal(dmb_sim_snapshot(s.sim, snapshot, size), DMB_OK);
            misbehave(&s, misdeed, 0.0);
            must_fail(&s, use, misdeed);
            misbehave(&s, WELL, 0.0);
            assert_int_equal(dmb_sim_restore(s.sim, snapshot, size), DMB_OK); /* advance counts its failures */
            whole_run(s.sim, 10, 1e-3);
            if (whole_hash(s.sim) != wanted) fail_msg("use %d, misdeed %d: the run differs", use, misdeed);
            close_scene(&s);
        }
    }
}

/* Only from some time within the step on. */
static void misdeeds_late_in_the_step_stop_it_too(void **state)
{
    (void)state;
    for (int use = 0; use < USES; use++) {
        scene s;
        open_scene(&s, use, 0);
        misbehave(&s, GIVES_NAN, dmb_sim_time(s.sim) + 0.9e-3);
        must_fail(&s, use, GIVES_NAN);
        close_scene(&s);
    }
}

/* Derivatives that a use needs have to be announced: the rate of a motion. */
static void announced_rate_has_to_come(void **state)
{
    static const int misdeeds[] = {NO_RATE, NAN_RATE};
    (void)state;
    for (size_t i = 0; i < 2; i++) {
        scene s;
        open_scene(&s, MOTION, DMB_PROVIDES_RATE);
        misbehave(&s, misdeeds[i], 0.0);
        must_fail(&s, MOTION, misdeeds[i]);
        close_scene(&s);
    }
}

/* And the integral, the way of a motion drive. */
static void announced_integral_has_to_come(void **state)
{
    static const int misdeeds[] = {NO_INTEGRAL, INFINITE_INTEGRAL};
    (void)state;
    for (size_t i = 0; i < 2; i++) {
        scene s;
        open_scene(&s, MOTION, DMB_PROVIDES_RATE | DMB_PROVIDES_INTEGRAL);
        misbehave(&s, misdeeds[i], 0.0);
        must_fail(&s, MOTION, misdeeds[i]);
        close_scene(&s);
    }
}

/* Values that are not announced are not read. */
static void rest_of_the_answer_is_not_looked_at(void **state)
{
    (void)state;
    for (int use = 0; use < USES; use++) {
        const uint64_t wanted = undisturbed(use, 0);
        for (int misdeed = NO_RATE; misdeed < MISDEEDS; misdeed++) {
            scene s;
            open_scene(&s, use, 0);
            misbehave(&s, misdeed, 0.0);
            whole_run(s.sim, 10, 1e-3);
            assert_true(whole_hash(s.sim) == wanted);
            close_scene(&s);
        }
    }
}

/* There is no start without a value at time 0. */
static void create_fails_without_a_value(void **state)
{
    (void)state;
    for (int use = 0; use < USES; use++) {
        for (int misdeed = REFUSES; misdeed <= WRITES_NOTHING; misdeed++) {
            scene s;
            describe(&s, use, 0);
            misbehave(&s, misdeed, -1.0);
            const int32_t status = dmb_sim_create(s.model, NULL, &s.sim);
            if (status != DMB_ERR_CALLBACK) fail_msg("use %d, misdeed %d: %s", use, misdeed, dmb_status_name(status));
            assert_null(s.sim);
            misbehave(&s, WELL, 0.0);
            assert_true(dmb_sim_create(s.model, NULL, &s.sim) >= 0);
            whole_run(s.sim, 13, 1e-3);
            close_scene(&s);
        }
    }
}

/* The static start needs it as well. */
static void static_start_fails_without_a_value(void **state)
{
    scene s;
    (void)state;
    open_scene(&s, LOAD_FACTOR, 0);
    const uint64_t before = whole_hash(s.sim);
    misbehave(&s, GIVES_NAN, 0.0);
    assert_int_equal(dmb_analysis_static(s.sim, NULL, NULL), DMB_ERR_CALLBACK);
    assert_true(whole_hash(s.sim) == before);
    close_scene(&s);
}

/* Describing and compiling do not call; a run asks for times in and near its steps only. */
static void calls_come_when_they_are_due(void **state)
{
    (void)state;
    for (int use = 0; use < USES; use++) {
        scene s;
        describe(&s, use, 0);
        assert_int_equal(s.source.calls, 0);
        s.sim = whole_sim(s.model, NULL);
        whole_run(s.sim, 100, 1e-3);
        assert_true(s.source.first >= -1e-3 && s.source.last <= 0.1 + 1e-3);
        close_scene(&s);
    }
}

/* A step that is not a number does not reach the caller's function. */
static void nonsense_does_not_reach_the_callback(void **state)
{
    scene s;
    (void)state;
    open_scene(&s, LOAD_DRIVE, 0);
    const uint32_t calls = s.source.calls;
    assert_true(dmb_sim_step(s.sim, (double)NAN, NULL) < 0);
    assert_true(dmb_sim_advance(s.sim, (double)INFINITY, NULL) < 0);
    assert_int_equal(s.source.calls, calls);
    close_scene(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(misdeeds_stop_the_step),
        cmocka_unit_test(misdeeds_late_in_the_step_stop_it_too),
        cmocka_unit_test(announced_rate_has_to_come),
        cmocka_unit_test(announced_integral_has_to_come),
        cmocka_unit_test(rest_of_the_answer_is_not_looked_at),
        cmocka_unit_test(create_fails_without_a_value),
        cmocka_unit_test(static_start_fails_without_a_value),
        cmocka_unit_test(calls_come_when_they_are_due),
        cmocka_unit_test(nonsense_does_not_reach_the_callback),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
