/* Every long call, ended by its progress function at each k-th telling, against the same call of a sim that nobody has
 * disturbed: the status says so, nothing is changed or leaked, and made again it gives the same bits. */
#include "sim_test.h"

/* ---- Memory that is counted -------------------------------------------------------------------------------------- */

typedef struct ledger {
    long blocks;
} ledger;

static void *take(void *context, size_t size, size_t alignment)
{
    ((ledger *)context)->blocks++;
    return aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}

static void give(void *context, void *block, size_t size, size_t alignment)
{
    (void)size, (void)alignment;
    ((ledger *)context)->blocks--;
    free(block);
}

/* ---- Scenes ------------------------------------------------------------------------------------------------------ */

enum { HANGING, IN_HOLE, DRIVEN, JOINTED, PUSHED };

typedef struct scene {
    ledger ledger;
    dmb_allocator allocator;
    dmb_model *model;
    dmb_id string;
    int kind;
} scene;

/* Two bodies on hinges. */
static void add_bodies(scene *s)
{
    dmb_id body[2];
    for (int i = 0; i < 2; i++) {
        dmb_body_def def = dmb_body_def_default();
        dmb_joint_def joint = dmb_joint_def_default();
        def.mass = 2.0;
        def.inertia[0] = def.inertia[1] = def.inertia[2] = 0.1;
        def.position[0] = 1.0 + i;
        def.position[1] = 3.0;
        must(dmb_model_add_body(s->model, &def, &body[i]));
        joint.kind = DMB_JOINT_REVOLUTE;
        if (i > 0) joint.place_a = (dmb_place){body[0], 0, 0, 0.0};
        joint.place_b = (dmb_place){body[i], 0, 0, 0.0};
        joint.origin_a[0] = 0.5;
        joint.origin_a[1] = i > 0 ? 0.0 : 3.0;
        joint.match = 1;
        joint.axis_a[0] = 0.0;
        joint.axis_a[1] = 1.0;
        must(dmb_model_add_joint(s->model, &joint, NULL));
    }
}

static void add_string(scene *s)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    string.start_free = s->kind == DRIVEN ? DMB_FREE_X | DMB_FREE_RX : DMB_FREE_NONE;
    if (s->kind != IN_HOLE && s->kind != DRIVEN) string.rotation[1] = 1.5707963267948966;
    must(dmb_model_add_string(s->model, &string, &s->string));
    pipe.damping_time = 1e-3;
    must(dmb_model_add_pipes(s->model, &pipe, 12, NULL));
}

static void add_load(scene *s)
{
    dmb_load_def load = dmb_load_def_default();
    load.place = dmb_station(s->string, 11, 1.0);
    load.force[0] = -200.0; /* pushes: along the hole, up where it hangs */
    load.frame = DMB_FRAME_BODY;
    if (s->kind == PUSHED) { /* with a potential, so that factors are counted */
        load.frame = DMB_FRAME_WORLD;
        load.force[0] = 0.0;
        load.force[2] = 200.0;
    }
    must(dmb_model_add_load(s->model, &load, NULL));
    load.time_function = rig_step(s->model, 1.0); /* something for steps to do */
    load.force[1] = 100.0;
    must(dmb_model_add_load(s->model, &load, NULL));
}

static void add_drives(scene *s)
{
    dmb_drive_def drive = dmb_drive_def_default();
    drive.kind = DMB_DRIVE_MOTION;
    for (int i = 0; i < 2; i++) {
        drive.component = i == 0 ? DMB_X : DMB_RX;
        drive.time_function = rig_step(s->model, i == 0 ? 0.01 : 3.0);
        must(dmb_model_add_drive(s->model, &drive, NULL));
    }
}

static void open_scene(scene *s, int kind)
{
    memset(s, 0, sizeof *s);
    s->kind = kind;
    must(dmb_model_create(NULL, &s->model));
    if (kind == IN_HOLE || kind == DRIVEN) {
        dmb_wall_def wall = dmb_wall_def_default();
        wall.diameter = 0.1;
        must(dmb_model_add_wall(s->model, &wall, NULL));
    }
    add_string(s);
    if (kind == DRIVEN) add_drives(s);
    if (kind == JOINTED || kind == PUSHED) add_bodies(s);
    if (kind != DRIVEN) add_load(s);
    if (dmb_model_compile(s->model, NULL) < 0) fail_msg("%s", dmb_model_message(s->model));
    s->allocator = dmb_allocator_default();
    s->allocator.context = &s->ledger;
    s->allocator.allocate = take;
    s->allocator.release = give;
}

/* ---- Calls ------------------------------------------------------------------------------------------------------- */

typedef struct answer {
    int32_t status;
    uint32_t count;
    double number[64];
} answer;

static void say(answer *a, double number)
{
    if (a->count < 64) a->number[a->count++] = number;
}

static dmb_excitation tip_force(const scene *s)
{
    dmb_excitation input = dmb_excitation_default();
    input.kind = DMB_EXCITATION_FORCE;
    input.place = dmb_station(s->string, 11, 1.0);
    return input;
}

static dmb_output middle(const scene *s)
{
    dmb_output output = {.quantity = DMB_OUTPUT_VIBRATION};
    output.place = dmb_station(s->string, 5, 1.0);
    output.quantity += DMB_Z;
    return output;
}

static void call_static(dmb_sim *sim, int32_t steady, double slip, answer *a)
{
    dmb_static_options options = dmb_static_options_default();
    dmb_static_report report = dmb_static_report_default();
    options.steady = steady;
    options.slip_axial = slip;
    a->status = dmb_analysis_static(sim, &options, &report);
    say(a, report.residual);
    say(a, report.lateral_move);
}

static int32_t visit(void *context, const dmb_sim *at, const dmb_path_point *point)
{
    say(context, point->factor);
    (void)at;
    return 0;
}

static void call_path(dmb_sim *sim, const scene *s, answer *a)
{
    dmb_path_options options = dmb_path_options_default();
    dmb_path_report report = dmb_path_report_default();
    options.place = dmb_station(s->string, 5, 1.0);
    options.component = DMB_Z;
    options.max_points = 12;
    options.factor_end = 40.0;
    options.callback = visit;
    options.callback_context = a;
    a->status = dmb_analysis_path(sim, &options, &report);
    say(a, report.factor);
    say(a, report.displacement);
}

static void call_buckling(dmb_sim *sim, int32_t follow, double slip, answer *a)
{
    dmb_buckling_options options = dmb_buckling_options_default();
    dmb_buckling *buckling = NULL;
    options.count = 3;
    options.slip_axial = slip;
    options.follow = follow;
    a->status = dmb_analysis_buckling(sim, &options, &buckling);
    for (uint32_t k = 0; k < dmb_buckling_count(buckling); k++) {
        double factor = 0.0;
        must(dmb_buckling_factor(buckling, k, &factor));
        say(a, factor);
    }
    if (a->status < 0) assert_null(buckling);
    dmb_buckling_destroy(&buckling);
}

static void call_modes(dmb_sim *sim, int32_t kind, int32_t select, answer *a)
{
    dmb_modes_options options = dmb_modes_options_default();
    dmb_modes *modes = NULL;
    dmb_modes_info info = dmb_modes_info_default();
    options.kind = kind;
    options.select = select;
    options.count = 4;
    options.band[0] = 1.0;
    options.band[1] = 200.0;
    options.equilibrium_tolerance = 1.0;
    a->status = dmb_analysis_modes(sim, &options, &modes);
    if (modes != NULL) must(dmb_modes_get_info(modes, &info));
    for (uint32_t k = 0; k < info.count; k++) {
        dmb_mode mode = dmb_mode_default();
        must(dmb_modes_get(modes, k, &mode));
        say(a, mode.frequency);
    }
    if (a->status < 0) assert_null(modes);
    dmb_modes_destroy(&modes);
}

static void call_response(dmb_sim *sim, const scene *s, answer *a)
{
    dmb_response_options options = dmb_response_options_default();
    const dmb_excitation input = tip_force(s);
    const dmb_output output = middle(s);
    dmb_response *response = NULL;
    uint32_t shape[3] = {0, 0, 0};
    double values[1024] = {0.0};
    options.points = 12;
    options.refinement = 2;
    options.equilibrium_tolerance = 1.0;
    a->status = dmb_analysis_response(sim, &options, &input, 1, &output, 1, &response);
    if (a->status < 0) assert_null(response);
    if (response == NULL) return;
    must(dmb_response_dimensions(response, shape));
    must(dmb_response_transfer(response, 0, 0, values));
    say(a, shape[0]);
    for (int i = 0; i < 20; i++) say(a, values[i]);
    dmb_response_destroy(&response);
}

static void call_sine(dmb_sim *sim, const scene *s, answer *a)
{
    dmb_stepped_sine_options options = dmb_stepped_sine_options_default();
    const dmb_output output = middle(s);
    double amplitudes[64] = {0.0};
    options.windows = 3;
    options.harmonics = options.periods = 1;
    options.steps_per_period = 16;
    a->status = dmb_analysis_stepped_sine(sim, 50.0, &options, &output, 1, amplitudes, NULL);
    for (int i = 0; i < 4; i++) say(a, amplitudes[i]);
}

static void call_speeds(dmb_sim *sim, const scene *s, answer *a)
{
    dmb_speeds_options options = dmb_speeds_options_default();
    dmb_order orders[2] = {dmb_order_default(), dmb_order_default()};
    const dmb_output output = middle(s);
    const double limit = 1e-5;
    dmb_speed_band bands[4];
    uint32_t count = 4;
    double severity[8] = {0.0};
    for (int i = 0; i < 4; i++) bands[i] = dmb_speed_band_default();
    options.points = 8;
    options.refinement = 1;
    options.equilibrium_tolerance = 1.0;
    orders[0].excitation = orders[1].excitation = tip_force(s);
    orders[1].order = 2.0;
    a->status = dmb_analysis_speeds(sim, &options, orders, 2, &output, &limit, 1, bands, &count, severity);
    for (int i = 0; i < 8; i++) say(a, severity[i]);
}

static void call_check(dmb_sim *sim, answer *a)
{
    dmb_check_report report = dmb_check_report_default();
    char text[4096] = "";
    a->status = dmb_analysis_check(sim, &report);
    say(a, report.degrees_of_freedom);
    say(a, report.rank);
    if (a->status >= 0) a->status = dmb_analysis_check_text(sim, text, sizeof text, NULL);
    say(a, (double)strlen(text));
}

enum {
    STEP,
    ADVANCE,
    STATIC,
    STATIC_SLIPPING,
    STATIC_STEADY,
    PATH,
    BUCKLING,
    BUCKLING_SLIPPING,
    MODES,
    MODES_DAMPED,
    MODES_BAND,
    MODES_BAND_DAMPED,
    MODES_ALL,
    MODES_ALL_DAMPED,
    RESPONSE,
    SINE,
    SPEEDS,
    CHECK,
    CALLS
};

static answer make_call(int call, dmb_sim *sim, const scene *s)
{
    answer a = {DMB_OK, 0, {0.0}};
    switch (call) {
    case STEP: a.status = dmb_sim_step(sim, 5e-3, NULL); break;
    case ADVANCE: a.status = dmb_sim_advance(sim, 0.02, NULL); break;
    case STATIC: call_static(sim, DMB_STEADY_AT_REST, 0.0, &a); break;
    case STATIC_SLIPPING: call_static(sim, DMB_STEADY_AT_REST, 0.1, &a); break;
    case STATIC_STEADY: call_static(sim, DMB_STEADY_AUTO, 0.0, &a); break;
    case PATH: call_path(sim, s, &a); break;
    case BUCKLING: call_buckling(sim, s->kind != IN_HOLE, 0.0, &a); break;
    case BUCKLING_SLIPPING: call_buckling(sim, 0, 0.1, &a); break;
    case MODES: call_modes(sim, DMB_MODES_UNDAMPED, DMB_MODES_LOWEST, &a); break;
    case MODES_DAMPED: call_modes(sim, DMB_MODES_DAMPED, DMB_MODES_LOWEST, &a); break;
    case MODES_BAND: call_modes(sim, DMB_MODES_UNDAMPED, DMB_MODES_BAND, &a); break;
    case MODES_BAND_DAMPED: call_modes(sim, DMB_MODES_DAMPED, DMB_MODES_BAND, &a); break;
    case MODES_ALL: call_modes(sim, DMB_MODES_UNDAMPED, DMB_MODES_ALL, &a); break;
    case MODES_ALL_DAMPED: call_modes(sim, DMB_MODES_DAMPED, DMB_MODES_ALL, &a); break;
    case RESPONSE: call_response(sim, s, &a); break;
    case SINE: call_sine(sim, s, &a); break;
    case SPEEDS: call_speeds(sim, s, &a); break;
    default: call_check(sim, &a); break;
    }
    return a;
}

/* Statics begin in the described pose, the others where statics have ended. */
static dmb_sim *sim_for(scene *s, int call)
{
    dmb_sim_options options = dmb_sim_options_default();
    dmb_sim *sim = NULL;
    options.allocator = &s->allocator;
    assert_true(dmb_sim_create(s->model, &options, &sim) >= 0);
    dmb_static_options statics = dmb_static_options_default();
    if (call == BUCKLING_SLIPPING) statics.slip_axial = 0.1;
    if (call < STATIC || call > STATIC_STEADY)
        if (dmb_analysis_static(sim, &statics, NULL) < 0) fail_msg("scene %d: %s", s->kind, dmb_sim_message(sim));
    return sim;
}

/* ---- The function ------------------------------------------------------------------------------------------------ */

typedef struct teller {
    dmb_sim *sim;
    uint32_t calls, stop_at; /* 0: never */
    double last;
} teller;

static int32_t tell(void *context, double fraction)
{
    teller *t = context;
    dmb_sim *handle = t->sim;
    if (!(fraction >= t->last && fraction <= 1.0)) fail_msg("told %.17g after %.17g", fraction, t->last);
    t->last = fraction;
    assert_int_equal(dmb_sim_set_progress(t->sim, NULL, NULL), DMB_ERR_ORDER);
    assert_int_equal(dmb_sim_step(t->sim, 1e-3, NULL), DMB_ERR_ORDER);
    dmb_sim_destroy(&handle);
    assert_ptr_equal(handle, t->sim);
    return ++t->calls == t->stop_at;
}

static void begin(teller *t, dmb_sim *sim, uint32_t stop_at)
{
    *t = (teller){sim, 0, stop_at, 0.0};
    must(dmb_sim_set_progress(sim, tell, t));
}

static void same(const scene *s, int call, uint32_t k, const answer *a, const answer *b)
{
    if (a->status != b->status || a->count != b->count || memcmp(a->number, b->number, sizeof a->number) != 0)
        fail_msg("scene %d, call %d, cancelled at %u: %d, undisturbed %d, or other numbers", s->kind, call, k,
                 (int)a->status, (int)b->status);
}

/* Ended at telling k, then made again. */
static void cancel_at(scene *s, int call, uint32_t k, const answer *wanted, uint64_t wanted_hash)
{
    dmb_sim *sim = sim_for(s, call), *before = sim_for(s, call);
    const uint64_t hash = hash_of(sim);
    const long blocks = s->ledger.blocks;
    teller t;
    begin(&t, sim, k);
    answer a = make_call(call, sim, s);
    const int32_t status = call == ADVANCE ? DMB_NOTE_CANCELLED : DMB_ERR_CANCELLED;
    if (a.status != status || t.calls != k || s->ledger.blocks != blocks)
        fail_msg("scene %d, call %d, at %u: status %d, told %u times, blocks %ld: %s", s->kind, call, k, (int)a.status,
                 t.calls, s->ledger.blocks - blocks, dmb_sim_message(sim));
    assert_non_null(strstr(dmb_sim_message(sim), "progress function"));
    if (call != ADVANCE) assert_non_null(strstr(dmb_sim_message(sim), " % of it done; repeat it for its result"));
    if (call == SINE) { /* in its last accepted state: back to the one before */
        size_t size = 0;
        must(dmb_sim_snapshot_size(before, &size));
        void *block = malloc(size);
        must(dmb_sim_snapshot(before, block, size));
        must(dmb_sim_restore(sim, block, size));
        free(block);
    }
    if (call != ADVANCE) assert_true(hash_of(sim) == hash);
    must(dmb_sim_set_progress(sim, NULL, NULL));
    a = make_call(call, sim, s);
    same(s, call, k, &a, wanted);
    if (hash_of(sim) != wanted_hash) fail_msg("scene %d, call %d, cancelled at %u: another state", s->kind, call, k);
    dmb_sim_destroy(&sim);
    dmb_sim_destroy(&before);
}

/* Tellings of a long call at which it is ended, its first and last ones among them; all of a short one. The first
 * argument of the program, 1000000: each. */
static uint32_t cancels = 5;

static uint32_t check_call(scene *s, int call)
{
    dmb_sim *quiet = sim_for(s, call), *told = sim_for(s, call);
    teller t;
    const answer wanted = make_call(call, quiet, s);
    const uint64_t hash = hash_of(quiet);
    begin(&t, told, 0);
    const answer a = make_call(call, told, s);
    if (wanted.status < 0)
        fail_msg("scene %d, call %d: %d %s", s->kind, call, (int)wanted.status, dmb_sim_message(quiet));
    same(s, call, 0, &a, &wanted);
    assert_true(hash_of(told) == hash);
    dmb_sim_destroy(&quiet);
    dmb_sim_destroy(&told);
    const uint32_t stride = t.calls / cancels + 1;
    for (uint32_t k = 1; k <= t.calls; k += stride) cancel_at(s, call, k, &wanted, hash);
    if (t.calls > 0 && (t.calls - 1) % stride != 0) cancel_at(s, call, t.calls, &wanted, hash);
    return t.calls;
}

static void check_scene(int kind, const int *calls, int count)
{
    scene s;
    open_scene(&s, kind);
    for (int i = 0; i < count; i++) {
        const uint32_t told = check_call(&s, calls[i]);
        print_message("scene %d, call %d: told %u times\n", kind, calls[i], told);
        if (told == 0 && !(calls[i] == CHECK && kind != JOINTED)) fail_msg("call %d tells nobody", calls[i]);
    }
    assert_int_equal(s.ledger.blocks, 0);
    dmb_model_destroy(&s.model);
}

static void hanging(void **state)
{
    static const int calls[] = {
        STEP,      ADVANCE,          STATIC,   PATH, BUCKLING, MODES, MODES_DAMPED, MODES_BAND, MODES_BAND_DAMPED,
        MODES_ALL, MODES_ALL_DAMPED, RESPONSE, SINE, SPEEDS,   CHECK};
    (void)state;
    check_scene(HANGING, calls, sizeof calls / sizeof *calls);
}

static void in_a_hole(void **state)
{
    static const int calls[] = {STEP,     ADVANCE,           STATIC, STATIC_SLIPPING, PATH,
                                BUCKLING, BUCKLING_SLIPPING, MODES,  RESPONSE,        SINE};
    (void)state;
    check_scene(IN_HOLE, calls, sizeof calls / sizeof *calls);
}

static void with_drives(void **state)
{
    static const int calls[] = {STEP, ADVANCE, STATIC_STEADY, MODES_DAMPED, SINE};
    (void)state;
    check_scene(DRIVEN, calls, sizeof calls / sizeof *calls);
}

static void with_joints(void **state)
{
    static const int calls[] = {STEP,  ADVANCE,          STATIC,   PATH,   BUCKLING,
                                MODES, MODES_ALL_DAMPED, RESPONSE, SPEEDS, CHECK};
    (void)state;
    check_scene(JOINTED, calls, sizeof calls / sizeof *calls);
}

static void pushed(void **state)
{
    static const int calls[] = {PATH, BUCKLING};
    const uint32_t before = cancels;
    (void)state;
    cancels = before > 25 ? before : 25;
    check_scene(PUSHED, calls, 2);
    cancels = before;
}

static void handles(void **state)
{
    (void)state;
    teller t = {NULL, 0, 0, 0.0};
    assert_int_equal(dmb_sim_set_progress(NULL, tell, &t), DMB_ERR_NULL);
    assert_string_equal(dmb_status_name(DMB_ERR_CANCELLED), "DMB_ERR_CANCELLED");
}

int main(int argc, char **argv)
{
    if (argc > 1) cancels = (uint32_t)strtoul(argv[1], NULL, 10);
    const struct CMUnitTest tests[] = {cmocka_unit_test(hanging),     cmocka_unit_test(in_a_hole),
                                       cmocka_unit_test(with_drives), cmocka_unit_test(with_joints),
                                       cmocka_unit_test(pushed),      cmocka_unit_test(handles)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
