/* Functions of the caller's (time function, constraint, allocator, path, log) that meddle with the object they are
 * called for: every call is refused with DMB_ERR_ORDER, destroying does nothing, and the call under way ends with the
 * status and the hash that it has undisturbed. */
#include "sim_test.h"

typedef struct agent {
    dmb_sim *sim;   /* to meddle with; NULL: it keeps still */
    dmb_sim *other; /* of another model of the same parts */
    dmb_id drive;
    void *snapshot;
    size_t snapshot_size;
    int active, may_ask; /* may_ask: queries are answered */
    int deep;            /* it is meddling already */
    int after;           /* a result is destroyed: the call is over */
    int calls;
} agent;

static int32_t path_point(void *context, const dmb_sim *at, const dmb_path_point *point)
{
    (void)context, (void)at, (void)point;
    return 0;
}

/* ---- Every call that changes a sim or runs functions of the caller's --------------------------------------------- */

static dmb_excitation tip_load(dmb_place place)
{
    dmb_excitation input = dmb_excitation_default();
    input.kind = DMB_EXCITATION_FORCE;
    input.place = place;
    return input;
}

typedef struct scene {
    agent agent;
    dmb_model *model;
    dmb_id string;
    dmb_allocator allocator;
} scene;

enum {
    STEP,
    ADVANCE,
    SET_DRIVE,
    STATIC,
    PATH,
    MODES,
    BUCKLING,
    RESPONSE,
    SINE,
    SPEEDS,
    CHECK,
    CHECK_TEXT,
    RESTORE,
    CARRY_OVER,
    CALLS
};

static int32_t call_response(dmb_sim *sim, scene *s)
{
    dmb_response_options options = dmb_response_options_default();
    const dmb_excitation input = tip_load(dmb_station(s->string, 1, 1.0));
    dmb_output output = {.quantity = DMB_OUTPUT_VIBRATION};
    dmb_response *response = NULL;
    options.points = 3;
    options.equilibrium_tolerance = 1.0;
    output.place = dmb_station(s->string, 0, 1.0);
    const int32_t status = dmb_analysis_response(sim, &options, &input, 1, &output, 1, &response);
    s->agent.after = 1;
    dmb_response_destroy(&response);
    s->agent.after = 0;
    return status;
}

static int32_t call_sine(dmb_sim *sim, scene *s)
{
    dmb_stepped_sine_options options = dmb_stepped_sine_options_default();
    dmb_output output = {.quantity = DMB_OUTPUT_VIBRATION};
    double amplitudes[64];
    options.windows = 3;
    options.harmonics = options.periods = 1;
    options.steps_per_period = 16;
    output.place = dmb_station(s->string, 0, 1.0);
    return dmb_analysis_stepped_sine(sim, 50.0, &options, &output, 1, amplitudes, NULL);
}

static int32_t call_speeds(dmb_sim *sim, scene *s)
{
    dmb_speeds_options options = dmb_speeds_options_default();
    dmb_order order = dmb_order_default();
    dmb_output output = {.quantity = DMB_OUTPUT_VIBRATION};
    const double limit = 1e-3;
    dmb_speed_band band = dmb_speed_band_default();
    uint32_t count = 1;
    options.points = 3;
    options.refinement = 0;
    options.equilibrium_tolerance = 1.0;
    order.excitation = tip_load(dmb_station(s->string, 1, 1.0));
    output.place = dmb_station(s->string, 0, 1.0);
    return dmb_analysis_speeds(sim, &options, &order, 1, &output, &limit, 1, &band, &count, NULL);
}

static int32_t call_path(dmb_sim *sim, scene *s)
{
    dmb_path_options options = dmb_path_options_default();
    options.place = dmb_station(s->string, 1, 1.0);
    options.max_points = 2;
    options.callback = path_point;
    return dmb_analysis_path(sim, &options, NULL);
}

static int32_t call_modes(dmb_sim *sim, scene *s)
{
    dmb_modes_options options = dmb_modes_options_default();
    dmb_modes *modes = NULL;
    options.count = 2;
    options.equilibrium_tolerance = 1.0;
    const int32_t status = dmb_analysis_modes(sim, &options, &modes);
    s->agent.after = 1;
    dmb_modes_destroy(&modes);
    s->agent.after = 0;
    return status;
}

static int32_t call_buckling(dmb_sim *sim, scene *s)
{
    dmb_buckling *buckling = NULL;
    const int32_t status = dmb_analysis_buckling(sim, NULL, &buckling);
    s->agent.after = 1;
    dmb_buckling_destroy(&buckling);
    s->agent.after = 0;
    return status;
}

static int32_t make_call(int call, dmb_sim *sim, scene *s)
{
    dmb_check_report report = dmb_check_report_default();
    char text[64];
    switch (call) {
    case STEP: return dmb_sim_step(sim, 1e-3, NULL);
    case ADVANCE: return dmb_sim_advance(sim, dmb_sim_time(sim) + 2e-3, NULL);
    case SET_DRIVE: return dmb_sim_set_drive(sim, s->agent.drive, 3.0 + dmb_sim_time(sim));
    case STATIC: return dmb_analysis_static(sim, NULL, NULL);
    case PATH: return call_path(sim, s);
    case MODES: return call_modes(sim, s);
    case BUCKLING: return call_buckling(sim, s);
    case RESPONSE: return call_response(sim, s);
    case SINE: return call_sine(sim, s);
    case SPEEDS: return call_speeds(sim, s);
    case CHECK: return dmb_analysis_check(sim, &report);
    case CHECK_TEXT: return dmb_analysis_check_text(sim, text, sizeof text, NULL);
    case RESTORE: return dmb_sim_restore(sim, s->agent.snapshot, s->agent.snapshot_size);
    case CARRY_OVER: return dmb_sim_transfer_state(sim, s->agent.other);
    default: return 1000;
    }
}

/* ---- The agent --------------------------------------------------------------------------------------------------- */

static void meddle(agent *a)
{
    scene *s = (scene *)(void *)a; /* its first member */
    dmb_sim *handle = a->sim;
    double angle = 0.0;
    if (!a->active || a->deep || a->after || a->sim == NULL) return;
    a->deep = 1;
    a->calls++;
    for (int call = 0; call < CALLS; call++) {
        const int32_t status = make_call(call, a->sim, s);
        if (status != DMB_ERR_ORDER) fail_msg("call %d from within: %d", call, (int)status);
        assert_non_null(strstr(dmb_sim_message(a->sim), "call of its own"));
    }
    dmb_sim_destroy(&handle);
    assert_ptr_equal(handle, a->sim);
    assert_true(isfinite(dmb_sim_time(a->sim)));
    assert_int_equal(dmb_query_rotation(a->sim, dmb_station(s->string, 1, 1.0), &angle),
                     a->may_ask ? DMB_OK : DMB_ERR_ORDER);
    a->deep = 0;
}

static int32_t time_function(void *context, double time, double out[3])
{
    meddle(context);
    out[0] = 1.0 + 0.1 * time;
    return 0;
}

/* The end of the second pipe stays in the plane of y = 0. */
static int32_t plane(void *context, double time, uint32_t count, const double (*poses)[12], double *value,
                     double *jacobian)
{
    (void)time, (void)count, (void)jacobian;
    meddle(context);
    value[0] = poses[0][1];
    return 0;
}

static void *allocate(void *context, size_t size, size_t alignment)
{
    meddle(context);
    return aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}

static void release(void *context, void *block, size_t size, size_t alignment)
{
    (void)size, (void)alignment;
    meddle(context);
    free(block);
}

enum { PLAIN, CONSTRAINED, KINDS, HELD };

static void add_parts(scene *s, int kind)
{
    dmb_segment term = dmb_segment_default();
    dmb_load_def load = dmb_load_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_constraint_def constraint = dmb_constraint_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    pipe.damping_time = 1e-3;
    must(dmb_model_add_pipes(s->model, &pipe, 2, &s->string));
    term.kind = DMB_SEGMENT_CALLBACK;
    term.callback = time_function;
    term.callback_context = s;
    must(dmb_model_add_time_function(s->model, &term, 1, &load.time_function));
    load.place = dmb_station(s->string, 1, 1.0);
    load.force[0] = -10.0;
    must(dmb_model_add_load(s->model, &load, NULL));
    drive.kind = DMB_DRIVE_LOAD;
    drive.component = DMB_RX;
    drive.time_function = rig_step(s->model, 5.0);
    if (kind != HELD) must(dmb_model_add_drive(s->model, &drive, &s->agent.drive));
    constraint.place[0] = load.place;
    constraint.callback = plane;
    constraint.callback_context = s;
    if (kind == CONSTRAINED) must(dmb_model_add_constraint(s->model, &constraint, NULL));
}

static void open_scene(scene *s, int kind)
{
    dmb_string_def string = dmb_string_def_default();
    memset(s, 0, sizeof *s);
    must(dmb_model_create(NULL, &s->model));
    string.start_free = kind == HELD ? DMB_FREE_NONE : DMB_FREE_RX;
    string.rotation[1] = 1.5707963267948966; /* it hangs */
    must(dmb_model_add_string(s->model, &string, &s->string));
    add_parts(s, kind);
    if (dmb_model_compile(s->model, NULL) < 0) fail_msg("%s", dmb_model_message(s->model));
    s->allocator = dmb_allocator_default();
    s->allocator.context = s;
    s->allocator.allocate = allocate;
    s->allocator.release = release;
}

static dmb_sim *new_sim(const scene *s)
{
    dmb_sim_options options = dmb_sim_options_default();
    dmb_sim *sim = NULL;
    options.allocator = &s->allocator;
    assert_true(dmb_sim_create(s->model, &options, &sim) >= 0);
    assert_true(dmb_analysis_static(sim, NULL, NULL) >= 0);
    return sim;
}

static void take_snapshot(scene *s, const dmb_sim *sim)
{
    must(dmb_sim_snapshot_size(sim, &s->agent.snapshot_size));
    s->agent.snapshot = malloc(s->agent.snapshot_size);
    must(dmb_sim_snapshot(sim, s->agent.snapshot, s->agent.snapshot_size));
}

static void check_call(scene *s, int call)
{
    dmb_sim *quiet = new_sim(s), *sim = new_sim(s);
    take_snapshot(s, sim);
    const int32_t wanted = make_call(call, quiet, s);
    if (wanted < 0 && wanted != DMB_ERR_SINGULAR) fail_msg("call %d: %d %s", call, (int)wanted, dmb_sim_message(quiet));
    s->agent.sim = sim;
    s->agent.active = 1;
    s->agent.may_ask = call != STATIC && call != SET_DRIVE && call != CARRY_OVER;
    const int32_t status = make_call(call, sim, s);
    s->agent.active = 0;
    if (status != wanted || hash_of(sim) != hash_of(quiet)) {
        fail_msg("call %d: %d, undisturbed %d %s, same hash: %d", call, (int)status, (int)wanted,
                 dmb_sim_message(quiet), hash_of(sim) == hash_of(quiet));
    }
    free(s->agent.snapshot);
    dmb_sim_destroy(&sim);
    dmb_sim_destroy(&quiet);
    assert_null(sim);
}

static void callbacks_are_kept_out(void **state)
{
    (void)state;
    for (int kind = 0; kind < KINDS; kind++) {
        for (int call = 0; call < CALLS; call++) {
            scene s, other;
            open_scene(&s, kind);
            open_scene(&other, kind);
            s.agent.other = new_sim(&other);
            check_call(&s, call);
            const int silent = call == RESTORE || (kind == PLAIN && (call == CHECK || call == CHECK_TEXT));
            if (!silent && s.agent.calls == 0) fail_msg("call %d asked nobody", call);
            dmb_sim_destroy(&s.agent.other);
            dmb_model_destroy(&s.model);
            dmb_model_destroy(&other.model);
        }
    }
}

/* The source of a state transfer is kept as well: callbacks of the target may ask it and no more. */
static int32_t of_the_source(void *context, double time, double out[3])
{
    scene *s = context;
    if (s->agent.other != NULL) {
        dmb_sim *from = s->agent.other;
        double angle;
        s->agent.calls++;
        assert_int_equal(dmb_sim_step(from, 1e-3, NULL), DMB_ERR_ORDER);
        dmb_sim_destroy(&from);
        assert_ptr_equal(from, s->agent.other);
        must(dmb_query_rotation(from, dmb_station(s->string, 1, 1.0), &angle));
    }
    out[0] = time;
    return 0;
}

static void source_of_a_transfer(void **state)
{
    (void)state;
    scene s[2];
    dmb_sim *sim[2] = {NULL, NULL};
    for (int i = 0; i < 2; i++) {
        dmb_segment term = dmb_segment_default();
        dmb_load_def load = dmb_load_def_default();
        const dmb_pipe_def pipe = dmb_pipe_def_default();
        memset(&s[i], 0, sizeof s[i]);
        must(dmb_model_create(NULL, &s[i].model));
        must(dmb_model_add_pipes(s[i].model, &pipe, 2, &s[i].string));
        term.kind = DMB_SEGMENT_CALLBACK;
        term.callback = of_the_source;
        term.callback_context = &s[i];
        must(dmb_model_add_time_function(s[i].model, &term, 1, &load.time_function));
        load.place = dmb_station(s[i].string, 1, 1.0);
        load.force[0] = 1.0;
        must(dmb_model_add_load(s[i].model, &load, NULL));
        must(dmb_model_compile(s[i].model, NULL));
        assert_true(dmb_sim_create(s[i].model, NULL, &sim[i]) >= 0);
    }
    s[0].agent.other = sim[1];
    s[0].string = s[1].string; /* whose it asks */
    assert_true(dmb_sim_transfer_state(sim[0], sim[1]) >= 0);
    assert_true(s[0].agent.calls > 0);
    assert_true(dmb_sim_step(sim[1], 1e-3, NULL) >= 0);
    for (int i = 0; i < 2; i++) dmb_sim_destroy(&sim[i]), dmb_model_destroy(&s[i].model);
}

/* The sim that a path shows its function answers queries and refuses changes, also with its const cast away. */
static int32_t meddle_with_point(void *context, const dmb_sim *at, const dmb_path_point *point)
{
    dmb_sim *sim = (dmb_sim *)at, *handle = sim;
    dmb_pose pose = dmb_pose_default();
    int *calls = context;
    (void)point;
    ++*calls;
    assert_int_equal(dmb_sim_step(sim, 1e-3, NULL), DMB_ERR_ORDER);
    assert_int_equal(dmb_analysis_static(sim, NULL, NULL), DMB_ERR_ORDER);
    dmb_sim_destroy(&handle);
    assert_ptr_equal(handle, sim);
    (void)dmb_query_pose(at, dmb_station((dmb_id){0, 0}, 0, 0.0), &pose);
    return 0;
}

static void points_of_a_path(void **state)
{
    (void)state;
    dmb_path_options options = dmb_path_options_default();
    int calls = 0;
    scene s;
    open_scene(&s, HELD);
    dmb_sim *sim = new_sim(&s);
    options.place = dmb_station(s.string, 1, 1.0);
    options.max_points = 3;
    options.callback = meddle_with_point;
    options.callback_context = &calls;
    if (dmb_analysis_path(sim, &options, NULL) < 0) fail_msg("%s", dmb_sim_message(sim));
    assert_true(calls > 0);
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&s.model);
}

/* ---- A model while it is described and compiled ------------------------------------------------------------------ */

typedef struct describer {
    dmb_model *model;
    int calls;
} describer;

static void meddle_with_model(describer *d)
{
    const dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_model *handle = d->model;
    if (handle == NULL) return;
    d->calls++;
    assert_int_equal(dmb_model_add_pipes(handle, &pipe, 1, NULL), DMB_ERR_ORDER);
    assert_int_equal(dmb_model_compile(handle, NULL), DMB_ERR_ORDER);
    assert_int_equal(dmb_model_clear_refused(handle), DMB_ERR_ORDER);
    dmb_model_destroy(&handle);
    assert_ptr_equal(handle, d->model);
}

static void *allocate_for_model(void *context, size_t size, size_t alignment)
{
    meddle_with_model(context);
    return aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}

static void release_for_model(void *context, void *block, size_t size, size_t alignment)
{
    (void)size, (void)alignment;
    meddle_with_model(context);
    free(block);
}

static void log_for_model(void *context, int32_t level, const char *text)
{
    (void)level, (void)text;
    meddle_with_model(context);
}

static void models_are_kept_too(void **state)
{
    (void)state;
    describer d = {NULL, 0};
    dmb_allocator allocator = dmb_allocator_default();
    dmb_model_options options = dmb_model_options_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_model *model = NULL;
    dmb_sim *sim = NULL;
    allocator.context = &d;
    allocator.allocate = allocate_for_model;
    allocator.release = release_for_model;
    options.allocator = &allocator;
    options.log = log_for_model;
    options.log_context = &d;
    must(dmb_model_create(&options, &model));
    d.model = model;
    for (int i = 0; i < 20; i++) must(dmb_model_add_pipes(model, &pipe, 1, NULL));
    pipe.outer_diameter = -1.0;
    assert_int_equal(dmb_model_add_pipes(model, &pipe, 1, NULL), DMB_ERR_VALUE);
    assert_non_null(strstr(dmb_model_message(model), "outer_diameter"));
    assert_int_equal(dmb_model_add_pipes(model, NULL, 1, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_model_compile(model, NULL), DMB_ERR_VALUE);
    must(dmb_model_clear_refused(model));
    must(dmb_model_compile(model, NULL));
    assert_true(d.calls > 4);
    d.model = NULL;
    must(dmb_sim_create(model, NULL, &sim));
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
    assert_null(model);
}

/* ---- Copied handles of a model ----------------------------------------------------------------------------------- */

/* The caller's hold is one, however many copies of the handle there are: sims keep theirs. */
static void copied_handles_destroy_once(void **state)
{
    (void)state;
    rig r = rig_of(&plain_rig);
    dmb_sim *sim = rig_sim(&r), *second = rig_sim(&r), *none = NULL;
    dmb_model *copies[3] = {r.model, r.model, r.model}, *last = r.model;
    dmb_model_info info = dmb_model_info_default();
    for (int i = 0; i < 3; i++) {
        dmb_model_destroy(&copies[i]);
        assert_null(copies[i]);
        rig_run(sim, 3);
    }
    assert_int_equal(dmb_sim_create(last, NULL, &none), DMB_ERR_HANDLE); /* given up is no handle, though it lives */
    assert_int_equal(dmb_model_get_info(last, &info), DMB_ERR_HANDLE);
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&last);
    rig_run(second, 3);
    dmb_sim_destroy(&second);
}

/* The allocator of a sim may destroy the model it is about to be made of. */
static void *allocate_and_destroy(void *context, size_t size, size_t alignment)
{
    dmb_model *handle = *(dmb_model **)context;
    dmb_model_destroy(&handle);
    return aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}

static void release_plainly(void *context, void *block, size_t size, size_t alignment)
{
    (void)context, (void)size, (void)alignment;
    free(block);
}

static void models_destroyed_on_the_way(void **state)
{
    (void)state;
    rig r = rig_of(&plain_rig);
    dmb_allocator allocator = dmb_allocator_default();
    dmb_sim_options options = dmb_sim_options_default();
    dmb_sim *sim = NULL;
    allocator.context = &r.model;
    allocator.allocate = allocate_and_destroy;
    allocator.release = release_plainly;
    options.allocator = &allocator;
    assert_true(dmb_sim_create(r.model, &options, &sim) >= 0);
    rig_run(sim, 3);
    dmb_sim_destroy(&sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(callbacks_are_kept_out),
        cmocka_unit_test(source_of_a_transfer),
        cmocka_unit_test(points_of_a_path),
        cmocka_unit_test(models_are_kept_too),
        cmocka_unit_test(copied_handles_destroy_once),
        cmocka_unit_test(models_destroyed_on_the_way),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
