/* Every public call that takes memory beyond the description of parts and the making of a sim (test_allocation_failure
 * has those): each of its allocations fails once. It says DMB_ERR_NO_MEMORY, gives nothing out, gives all back, leaves
 * sim and model as they were, and works when it is called again. A table of them, on a string in a hole and on a
 * mechanism of joints, by dense and by sparse matrices. */
#include <stdlib.h>
#include <string.h>

#include "asked_analyses.h"
#include "model/model.h"
#include "rig.h"
#include "scarce.h"

/* Allocations of a call that fail, spread over all of them; of long calls, of short calls each. */
#ifdef DMB_SOME_CASES
enum { TRIED = 10, OF_LONG = 5, EACH = 10 };
#else
enum { TRIED = 40, OF_LONG = 17, EACH = 1000 };
#endif

typedef struct subject {
    rig s;
    scarce memory;
    dmb_allocator allocator;
    dmb_sim *low, *high; /* beside s.sim, by the ordinary allocator */
    dmb_id part, drive;
    dmb_place place;
} subject;

/* ---- Scenes ------------------------------------------------------------------------------------------------------ */

/* A sim with the counting allocator in equilibrium, and two more beside it. */
static void start(subject *c)
{
    dmb_sim_options options = dmb_sim_options_default();
    must_model(&c->s, dmb_model_compile(c->s.model, NULL));
    options.allocator = &c->allocator;
    must_model(&c->s, dmb_sim_create(c->s.model, &options, &c->s.sim));
    must_model(&c->s, dmb_sim_create(c->s.model, NULL, &c->low));
    must_model(&c->s, dmb_sim_create(c->s.model, NULL, &c->high));
    must(&c->s, dmb_analysis_static(c->s.sim, NULL, NULL));
}

static void open_model(subject *c)
{
    dmb_model_options options = dmb_model_options_default();
    memset(c, 0, sizeof *c);
    c->allocator = scarce_allocator(&c->memory);
    options.allocator = &c->allocator;
    assert_int_equal(dmb_model_create(&options, &c->s.model), DMB_OK);
}

static void describe_string(subject *c)
{
    dmb_pipe_def pipe = s1_pipe();
    open_model(c);
    dmb_wall_def hole = s1_hole();
    hole.normal_law = DMB_NORMAL_IMPACT; /* without a memory, for the state equation */
    (void)add_wall(&c->s, &hole);
    c->part = add_pipes(&c->s, &pipe, 4);
    c->drive = add_simple_drive(&c->s, DMB_DRIVE_MOTION, c->part, DMB_X, add_constant(&c->s, 0.0));
    (void)add_simple_drive(&c->s, DMB_DRIVE_MOTION, c->part, DMB_RX, add_constant(&c->s, 0.0));
    c->place = dmb_station(c->part, 2, 0.5);
}

static void open_string(subject *c)
{
    dmb_load_def push = dmb_load_def_default();
    describe_string(c);
    push.place = dmb_station(c->part, 3, 1.0);
    push.force[0] = -100.0;
    (void)add_load(&c->s, &push);
    start(c);
}

static void open_unloaded_string(subject *c)
{
    describe_string(c);
    start(c);
}

/* A column of a beam and a bar, hinged to the ground and to each other, that is pressed; its hinges have springs. */
static void describe_mechanism(subject *c)
{
    dmb_pipe_def pipe = beam_pipe(1.0, 2, 1e7, 1e7, 1e4, 1e4);
    dmb_string_def string = dmb_string_def_default();
    dmb_body_def body = dmb_body_def_default();
    dmb_load_def push = dmb_load_def_default();
    string.start_free = DMB_FREE_ALL;
    pipe.string = c->part = add_string(&c->s, &string);
    (void)add_pipes(&c->s, &pipe, 1);
    body.position[0] = 1.0;
    body.mass = 5.0;
    const dmb_id bar = add_body(&c->s, &body), ground = {0, 0};
    dmb_joint_def joint = dmb_joint_def_default();
    for (int i = 0; i < 2; i++) {
        joint.kind = DMB_JOINT_UNIVERSAL;
        joint.place_a = i == 0 ? dmb_station(ground, 0, 0.0) : dmb_station(c->part, 0, 1.0);
        joint.place_b = i == 0 ? dmb_station(c->part, 0, 0.0) : dmb_station(bar, 0, 0.0);
        joint.match = 1;
        joint.stiffness[DMB_RY] = joint.stiffness[DMB_RZ] = 1e3;
        c->drive = add_joint(&c->s, &joint);
    }
    push.place = dmb_station(bar, 0, 0.0);
    push.force[0] = -10.0;
    (void)add_load(&c->s, &push);
    c->place = dmb_station(c->part, 0, 0.5);
}

static void open_mechanism(subject *c)
{
    open_model(c);
    describe_mechanism(c);
    start(c);
}

/* The same by sparse matrices, as large mechanisms are. */
static void open_sparse(subject *c)
{
    open_model(c);
    c->s.model->sparse_nodes = 2;
    describe_mechanism(c);
    start(c);
    assert_true(c->s.model->scene->sparse_count > 0);
}

static void open_bare_string(subject *c, int32_t start_free, double damping_time, uint32_t pipes)
{
    dmb_pipe_def pipe = s1_pipe();
    dmb_string_def string = dmb_string_def_default();
    dmb_environment_def none = dmb_environment_def_default();
    open_model(c);
    none.gravity[2] = 0.0;
    must_model(&c->s, dmb_model_set_environment(c->s.model, &none));
    string.start_free = start_free;
    pipe.string = c->part = add_string(&c->s, &string);
    pipe.damping_time = damping_time;
    (void)add_pipes(&c->s, &pipe, pipes);
    c->place = dmb_station(c->part, pipes - 1, 1.0);
    start(c);
}

/* A cantilever of many pipes with material damping. */
static void open_long_string(subject *c)
{
    open_bare_string(c, DMB_FREE_NONE, 1e-4, 40);
}

/* Free at both ends, so that its rigid-body motions are taken apart. */
static void open_free_string(subject *c)
{
    open_bare_string(c, DMB_FREE_ALL, 0.0, 20);
}

/* A string that turns on the low side of its hole. */
static void open_turning_string(subject *c)
{
    const dmb_wall_def hole = s1_hole();
    const dmb_pipe_def pipe = s1_pipe();
    dmb_static_options steady = dmb_static_options_default();
    open_model(c);
    (void)add_wall(&c->s, &hole);
    c->part = add_pipes(&c->s, &pipe, 4);
    c->place = dmb_station(c->part, 2, 0.5);
    c->drive = add_simple_drive(&c->s, DMB_DRIVE_MOTION, c->part, DMB_X, add_constant(&c->s, 0.0));
    (void)add_simple_drive(&c->s, DMB_DRIVE_MOTION, c->part, DMB_RX, add_constant(&c->s, 3.0));
    start(c);
    steady.steady = DMB_STEADY_AUTO;
    must(&c->s, dmb_analysis_static(c->s.sim, &steady, NULL));
    must(&c->s, dmb_analysis_static(c->low, &steady, NULL));
}

/* A rotor that spins on a carrier, which springs hold. */
static void open_rotor_on_joints(subject *c)
{
    dmb_body_def carrier = dmb_body_def_default(), rotor = dmb_body_def_default();
    open_model(c);
    rotor.velocity[3] = 20.0;
    c->part = add_body(&c->s, &carrier);
    const dmb_id wheel = add_body(&c->s, &rotor), ground = {0, 0};
    c->place = dmb_station(c->part, 0, 0.0);
    dmb_joint_def ball = joint_between(DMB_JOINT_SPHERICAL, dmb_station(ground, 0, 0.0), c->place);
    for (int k = 3; k < 6; k++) ball.stiffness[k] = 100.0;
    (void)add_joint(&c->s, &ball);
    (void)add_joint_between(&c->s, DMB_JOINT_REVOLUTE, c->place, dmb_station(wheel, 0, 0.0));
    dmb_sim_options options = dmb_sim_options_default();
    must_model(&c->s, dmb_model_compile(c->s.model, NULL));
    options.allocator = &c->allocator;
    must_model(&c->s, dmb_sim_create(c->s.model, &options, &c->s.sim));
}

/* Beck's column, pushed along its own axis: its stiffness is unsymmetric, and it flutters on the way. */
static void open_fluttering_column(subject *c)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = beam_pipe(10.0, 6, 2e11, 2e11, 1e5, 2e5);
    dmb_environment_def none = dmb_environment_def_default();
    dmb_load_def push = dmb_load_def_default();
    open_model(c);
    none.gravity[2] = 0.0;
    must_model(&c->s, dmb_model_set_environment(c->s.model, &none));
    string.start_free = DMB_FREE_NONE;
    pipe.string = c->part = add_string(&c->s, &string);
    (void)add_pipes(&c->s, &pipe, 1);
    push.place = c->place = dmb_station(c->part, 0, 1.0);
    push.frame = DMB_FRAME_BODY;
    push.force[0] = -1e4;
    (void)add_load(&c->s, &push);
    start(c);
}

static void close_subject(subject *c)
{
    dmb_sim_destroy(&c->low);
    dmb_sim_destroy(&c->high);
    dmb_sim_destroy(&c->s.sim);
    dmb_model_destroy(&c->s.model);
    assert_int_equal(c->memory.live, 0);
}

/* ---- The calls --------------------------------------------------------------------------------------------------- */

static int32_t place_rows(subject *c)
{
    uint32_t rows[24], count;
    double values[24];
    return dmb_analysis_place_rows(c->s.sim, c->place, DMB_FRAME_WORLD, DMB_Y, rows, values, &count);
}

static int32_t torque_drag(subject *c)
{
    dmb_operation operation = dmb_operation_default();
    dmb_torque_drag_row row = dmb_torque_drag_row_default();
    assert_int_equal(dmb_operation_usual(0, &operation), DMB_OK);
    return dmb_analysis_torque_drag(c->s.sim, NULL, &operation, 1, &row);
}

static int32_t torque_drag_profile(subject *c)
{
    dmb_operation operation = dmb_operation_default();
    double depth[8];
    assert_int_equal(dmb_operation_usual(0, &operation), DMB_OK);
    return dmb_analysis_torque_drag_profile(c->s.sim, NULL, &operation, 8, depth, NULL, NULL, NULL);
}

static int32_t friction_factor(subject *c)
{
    dmb_operation operation = dmb_operation_default();
    dmb_torque_drag_row row = dmb_torque_drag_row_default();
    dmb_torque_drag_options options = dmb_torque_drag_options_default();
    double friction;
    assert_int_equal(dmb_operation_usual(0, &operation), DMB_OK);
    const int32_t status = dmb_analysis_torque_drag(c->s.sim, &options, &operation, 1, &row);
    if (status < 0) return status;
    return dmb_analysis_friction_factor(c->s.sim, &options, &operation, DMB_MEASURED_HOOK_LOAD, row.hook_load,
                                        &friction);
}

static int32_t fatigue(subject *c)
{
    dmb_fatigue_options options = dmb_fatigue_options_default();
    dmb_fatigue *made = NULL;
    options.classes = 32;
    options.curve_stress = 1e8;
    options.slope = 5.0;
    const int32_t status = dmb_fatigue_create(c->s.sim, &options, &c->place, 1, &made);
    GIVES_NOTHING_OUT(made);
    if (made != NULL) assert_int_equal(dmb_fatigue_take(made, c->s.sim), DMB_OK);
    dmb_fatigue_destroy(&made);
    return status;
}

static int32_t window(subject *c)
{
    const dmb_output output = {.place = c->place, .quantity = DMB_OUTPUT_POSITION_Y};
    dmb_window *made = NULL;
    const int32_t status = dmb_window_create(c->s.sim, NULL, &output, 1, &made);
    GIVES_NOTHING_OUT(made);
    dmb_window_destroy(&made);
    return status;
}

/* Of a sim at time 0, as low and high are. */
static int32_t sensitivity(subject *c)
{
    dmb_parameter parameter = dmb_parameter_default();
    dmb_sensitivity *made = NULL;
    dmb_sim_options options = dmb_sim_options_default();
    dmb_sim *sim = NULL;
    options.allocator = &c->allocator;
    int32_t status = dmb_sim_create(c->s.model, &options, &sim);
    if (status < 0) return status;
    parameter.low = c->low;
    parameter.high = c->high;
    parameter.step = 1e-6;
    status = dmb_sensitivity_create(sim, &parameter, 1, &made);
    GIVES_NOTHING_OUT(made);
    if (made != NULL) status = dmb_sensitivity_step(made, 1e-4, NULL);
    dmb_sensitivity_destroy(&made);
    dmb_sim_destroy(&sim);
    return status;
}

static int32_t state_equation(subject *c)
{
    dmb_state_equation *made = NULL;
    const int32_t status = dmb_state_equation_create(c->s.sim, &made);
    GIVES_NOTHING_OUT(made);
    dmb_state_equation_destroy(&made);
    return status;
}

static int32_t transfer(subject *c)
{
    return dmb_sim_transfer_state(c->s.sim, c->low);
}

typedef struct row {
    const char *name;
    int32_t (*call)(subject *c);       /* own, or */
    int32_t (*ask)(const asked_of *a); /* of the common ones */
    int32_t moves;                     /* 1: the sim is moved where it works */
    int32_t refused; /* scenes that it is not for: bit 0 the string, bit 1 the mechanism, bit 2 sparse */
} row;

static const row rows[] = {
    {"statics", NULL, ask_statics, 1, 0},
    {"steady states", NULL, ask_steady, 1, 0},
    {"check", NULL, ask_check_model, 0, 0},
    {"check as text", NULL, ask_check_as_text, 0, 0},
    {"buckling", NULL, ask_buckling, 0, 0},
    {"buckling, followed", NULL, ask_followed_buckling, 0, 6},
    {"path", NULL, ask_path, 0, 6},
    {"lowest modes", NULL, ask_lowest_modes, 0, 0},
    {"all modes", NULL, ask_all_modes, 0, 0},
    {"modes of a band", NULL, ask_modes_of_a_band, 0, 0},
    {"damped modes", NULL, ask_damped_modes, 0, 0},
    {"all damped modes", NULL, ask_all_damped_modes, 0, 0},
    {"response", NULL, ask_response, 0, 0},
    {"speeds", NULL, ask_speeds, 0, 0},
    {"stepped sine", NULL, ask_stepped_sine, 1, 0},
    {"state space", NULL, ask_state_space, 0, 0},
    {"reduced state space", NULL, ask_reduced_state_space, 0, 0},
    {"array of the residual", NULL, ask_residual_array, 0, 0},
    {"rows of a place", place_rows, NULL, 0, 0},
    {"torque and drag", torque_drag, NULL, 0, 7},
    {"profile of torque and drag", torque_drag_profile, NULL, 0, 7},
    {"friction factor", friction_factor, NULL, 0, 7},
    {"fatigue", fatigue, NULL, 0, 0},
    {"window", window, NULL, 0, 0},
    {"sensitivity", sensitivity, NULL, 0, 4},
    {"state equation", state_equation, NULL, 0, 0},
    {"transfer", transfer, NULL, 1, 0},
};

static int32_t run(subject *c, const row *r)
{
    const asked_of all = {c->s.sim, c->place, DMB_Y, 20, 20.0, dmb_buckling_options_default().factor_max};
    return r->ask != NULL ? r->ask(&all) : r->call(c);
}

/* ---- Each of them, each allocation ------------------------------------------------------------------------------- */

static void fail_one(subject *c, const row *r, size_t k)
{
    const size_t live = c->memory.live;
    const uint64_t hash = rig_hash(&c->s);
    c->memory.calls = 0;
    c->memory.refused = k;
    const int32_t status = run(c, r);
    const size_t calls = c->memory.calls;
    c->memory.refused = 0;
    if (calls < k) fail_msg("%s: %zu allocations, fewer than before", r->name, calls);
    if (status != DMB_ERR_NO_MEMORY) fail_msg("%s: allocation %zu failed: %s", r->name, k, dmb_status_name(status));
    if (c->memory.live != live) fail_msg("%s: allocation %zu failed: %zu live", r->name, k, c->memory.live - live);
    if (rig_hash(&c->s) != hash) fail_msg("%s: allocation %zu failed: the sim has changed", r->name, k);
}

static void fail_each(subject *c, const row *r, size_t tried)
{
    size_t size;
    assert_int_equal(dmb_sim_snapshot_size(c->s.sim, &size), DMB_OK);
    void *before = malloc(size);
    assert_non_null(before);
    assert_int_equal(dmb_sim_snapshot(c->s.sim, before, size), DMB_OK);
    const size_t live = c->memory.live;
    c->memory.calls = 0;
    int32_t status = run(c, r);
    if (status < 0) fail_msg("%s: %s: %s", r->name, dmb_status_name(status), dmb_sim_message(c->s.sim));
    const size_t calls = c->memory.calls, stride = calls / tried + 1;
    assert_int_equal(c->memory.live, live);
    must(&c->s, dmb_sim_restore(c->s.sim, before, size));
    for (size_t k = 1; k <= calls; k += stride) fail_one(c, r, k);
    status = run(c, r);
    if (status < 0) fail_msg("%s, again: %s", r->name, dmb_status_name(status));
    must(&c->s, dmb_sim_restore(c->s.sim, before, size));
    print_message("    %4zu allocations of %s\n", calls, r->name);
    free(before);
}

static void one_call(void (*open)(subject *c), const row *r, size_t tried)
{
    subject c;
    open(&c);
    fail_each(&c, r, tried);
    close_subject(&c);
}

static void all_calls(void (*open)(subject *c), int scene)
{
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
        if (!(rows[i].refused >> scene & 1)) one_call(open, &rows[i], TRIED);
}

static void on_a_string(void **state)
{
    (void)state;
    all_calls(open_string, 0);
}

/* The calls that the string with a load refuses. */
static void on_an_unloaded_string(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
        if (rows[i].refused & 1) one_call(open_unloaded_string, &rows[i], TRIED);
}

static void on_a_mechanism(void **state)
{
    (void)state;
    all_calls(open_mechanism, 1);
}

static void by_sparse_matrices(void **state)
{
    (void)state;
    all_calls(open_sparse, 2);
}

static void on_a_long_string(void **state)
{
    static const row wide[2] = {{"modes of a wide band", NULL, ask_wide_band, 0, 0},
                                {"damped modes of a wide band", NULL, ask_wide_damped_band, 0, 0}};
    (void)state;
    for (int i = 0; i < 2; i++) one_call(open_long_string, &wide[i], OF_LONG);
}

static void on_what_is_free(void **state)
{
    static const row calls[] = {{"lowest modes", NULL, ask_lowest_modes, 0, 0},
                                {"all modes", NULL, ask_all_modes, 0, 0},
                                {"damped modes", NULL, ask_damped_modes, 0, 0},
                                {"all damped modes", NULL, ask_all_damped_modes, 0, 0}};
    (void)state;
    for (size_t i = 0; i < sizeof calls / sizeof calls[0]; i++) one_call(open_free_string, &calls[i], EACH);
}

static int32_t flutter(const asked_of *a)
{
    const asked_of bounded = {a->sim, a->place, DMB_Y, a->points, a->frequency, 5.0};
    return ask_followed_buckling(&bounded);
}

static void on_what_flutters(void **state)
{
    static const row followed = {"buckling, followed to flutter", NULL, flutter, 0, 0};
    (void)state;
    one_call(open_fluttering_column, &followed, TRIED);
}

static int32_t response_that_turns(const asked_of *a)
{
    const asked_of across = {a->sim, a->place, DMB_RY, a->points, a->frequency, a->factor_max};
    return ask_response(&across);
}

static int32_t state_space_that_turns(const asked_of *a)
{
    const asked_of across = {a->sim, a->place, DMB_RY, a->points, a->frequency, a->factor_max};
    return ask_state_space(&across);
}

static int32_t modes_in_axes_at_rest(const asked_of *a)
{
    dmb_modes_options options = dmb_modes_options_default();
    dmb_modes *found = NULL;
    options.kind = DMB_MODES_DAMPED;
    options.axes = DMB_MODES_AXES_AT_REST;
    options.count = 3;
    const int32_t status = dmb_analysis_modes(a->sim, &options, &found);
    GIVES_NOTHING_OUT(found);
    dmb_modes_destroy(&found);
    return status;
}

static void on_what_turns(void **state)
{
    static const row of_string[] = {{"steady states", NULL, ask_statics, 1, 0},
                                    {"modes in axes at rest", NULL, modes_in_axes_at_rest, 0, 0},
                                    {"response", NULL, ask_response, 0, 0},
                                    {"state space", NULL, ask_state_space, 0, 0}};
    static const row of_rotor[] = {{"modes in axes at rest", NULL, modes_in_axes_at_rest, 0, 0},
                                   {"response", NULL, response_that_turns, 0, 0},
                                   {"state space", NULL, state_space_that_turns, 0, 0}};
    (void)state;
    for (size_t i = 0; i < sizeof of_string / sizeof of_string[0]; i++)
        one_call(open_turning_string, &of_string[i], EACH);
    for (size_t i = 0; i < sizeof of_rotor / sizeof of_rotor[0]; i++)
        one_call(open_rotor_on_joints, &of_rotor[i], EACH);
}

/* ---- Descriptions that the whole scene does not have ------------------------------------------------------------- */

enum { DESCRIPTIONS = 7 };

static int32_t describe(subject *c, int i)
{
    dmb_input_def input = dmb_input_def_default();
    dmb_event_def event = dmb_event_def_default();
    dmb_hole_section sections[2] = {dmb_hole_section_default(), dmb_hole_section_default()};
    const dmb_wall_def hole = s1_hole();
    const dmb_pipe_def pipe = s1_pipe();
    const double wrong = -1.0;
    dmb_pipe_def refused = s1_pipe();
    switch (i) {
    case 0: return dmb_model_add_wall(c->s.model, &hole, NULL);
    case 1: return dmb_model_add_pipes(c->s.model, &pipe, 3, &c->part);
    case 2:
        sections[0].depth = 1.0, sections[1].depth = 2.0;
        sections[0].diameter = 0.1;
        return dmb_model_add_hole_sections(c->s.model, sections, 2);
    case 3:
        strcpy(input.name, "mud");
        input.target = DMB_TARGET_FLUID_DENSITY;
        return dmb_model_add_input(c->s.model, &input, NULL);
    case 4:
        strcpy(event.name, "far");
        event.output.place = dmb_station(c->part, 1, 0.5);
        event.output.quantity = DMB_OUTPUT_POSITION_Y;
        event.level = 1.0;
        return dmb_model_add_event(c->s.model, &event, NULL);
    case 5: /* refused parts are remembered */
        refused.length = wrong;
        return dmb_model_add_pipes(c->s.model, &refused, 1, NULL) == DMB_ERR_NO_MEMORY
                   ? DMB_ERR_NO_MEMORY
                   : dmb_model_clear_refused(c->s.model);
    default: return dmb_model_set_name(c->s.model, c->part, "string");
    }
}

/* Hash of a run afterwards; *there: allocation k was one of them. */
static uint64_t describe_short_of(size_t k, int *there)
{
    subject c;
    open_model(&c);
    c.memory.calls = 0;
    c.memory.refused = k;
    for (int i = 0; i < DESCRIPTIONS; i++) {
        const size_t before = c.memory.calls;
        const int32_t status = describe(&c, i);
        const int failed = k != 0 && before < k && c.memory.calls >= k;
        if (failed && status == DMB_ERR_NO_MEMORY)
            must_model(&c.s, describe(&c, i));
        else if (status < 0 || (failed && i != 5))
            fail_msg("description %d, allocation %zu: %s", i, k, dmb_status_name(status));
    }
    *there = k != 0 && c.memory.calls >= k;
    c.memory.refused = 0;
    must_model(&c.s, dmb_model_compile(c.s.model, NULL));
    must_model(&c.s, dmb_sim_create(c.s.model, NULL, &c.s.sim));
    take_steps(&c.s, 1e-3, 2);
    const uint64_t hash = rig_hash(&c.s);
    close_subject(&c);
    return hash;
}

static void descriptions(void **state)
{
    (void)state;
    int there = 0;
    const uint64_t hash = describe_short_of(0, &there);
    for (size_t k = 1;; k++) {
        if (describe_short_of(k, &there) != hash) fail_msg("allocation %zu: another run", k);
        if (!there) break;
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(on_a_string),      cmocka_unit_test(on_an_unloaded_string),
        cmocka_unit_test(on_a_mechanism),   cmocka_unit_test(by_sparse_matrices),
        cmocka_unit_test(on_a_long_string), cmocka_unit_test(on_what_is_free),
        cmocka_unit_test(on_what_turns),    cmocka_unit_test(on_what_flutters),
        cmocka_unit_test(descriptions),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
