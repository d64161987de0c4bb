/* Time functions, forces and constraints of the caller that fail: in every call that asks them, each of these questions
 * fails once. The status is DMB_ERR_CALLBACK, a message tells it, nothing is given out, the sim is as it was, and the
 * call works when it is made again. */
#include <stdlib.h>
#include <string.h>

#include "asked_analyses.h"
#include "rig.h"

enum { TRIED = 200 }; /* questions of a call that fail, spread over all of them */

typedef struct subject {
    rig r;
    dmb_sim *low, *high, *beside;
    dmb_id part, drive, turn, joint, load, input;
    dmb_place place;
    double home;           /* [m] x of the place where it is held */
    double found;          /* a derivative */
    size_t asked, failing; /* questions so far; number of the one that fails, from 1, or 0 */
} subject;

/* ---- What is asked ----------------------------------------------------------------------------------------------- */

static int32_t answer(subject *c)
{
    return ++c->asked == c->failing;
}

static int32_t still(void *context, double time, double out[3])
{
    (void)time;
    out[0] = out[1] = out[2] = 0.0;
    return answer(context);
}

static int32_t one(void *context, double time, double out[3])
{
    out[0] = 1.0;
    out[1] = 0.0;
    out[2] = time;
    return answer(context);
}

/* A spring, soft across. */
static int32_t hold(void *context, double time, uint32_t count, const double (*poses)[12],
                    const double (*velocities)[6], double (*forces)[6], double *tangent, double *potential,
                    const dmb_law_memory *memory)
{
    (void)memory;
    (void)time;
    const subject *c = context;
    const double away = poses[0][0] - c->home;
    *potential = 0.5 * (1e5 * away * away + 10.0 * (poses[0][1] * poses[0][1] + poses[0][2] * poses[0][2]));
    for (int i = 0; i < 3; i++) forces[0][i] = -10.0 * poses[0][i] - velocities[0][i];
    forces[0][0] = -1e5 * away;
    for (uint32_t i = 0; i < 3 * count && tangent != NULL; i++) { /* by displacements, then by velocities */
        tangent[7 * i] = i == 0 ? -1e5 : -10.0;
        tangent[36 * count * count + 7 * i] = i == 0 ? 0.0 : -1.0;
    }
    return answer(context);
}

static int32_t level(void *context, double time, uint32_t count, const double (*poses)[12], double *value,
                     double *jacobian)
{
    (void)time, (void)jacobian;
    value[0] = poses[count - 1][1];
    return answer(context);
}

/* ---- Scenes ------------------------------------------------------------------------------------------------------ */

static void add_hold(subject *c)
{
    dmb_force_def force = dmb_force_def_default();
    force.place[0] = c->place;
    force.callback = hold;
    force.provides = c->input.index != 0 ? DMB_PROVIDES_TANGENT : DMB_PROVIDES_POTENTIAL; /* of string, of mechanism */
    force.callback_context = c;
    must_model(&c->r, dmb_model_add_force(c->r.model, &force, NULL));
}

static void add_push(subject *c)
{
    dmb_load_def push = dmb_load_def_default();
    push.place = c->place;
    push.force[0] = -100.0;
    push.force[2] = -1.0;
    push.time_function = add_callback(&c->r, one, c);
    c->load = add_load(&c->r, &push);
}

static void add_drives(subject *c)
{
    dmb_drive_def drive = dmb_drive_def_default();
    drive.part = c->part;
    drive.time_function = add_callback(&c->r, still, c);
    drive.excitation = add_callback(&c->r, still, c);
    drive.kind = DMB_DRIVE_LOAD;
    c->drive = add_drive(&c->r, &drive);
    drive.kind = DMB_DRIVE_MOTION;
    drive.component = DMB_RX;
    c->turn = add_drive(&c->r, &drive);
}

static void open_model(subject *c)
{
    memset(c, 0, sizeof *c);
    rig_open(&c->r, 0.0, 0.0, -9.81);
}

static void start(subject *c)
{
    (void)rig_start(&c->r, NULL);
    must_model(&c->r, dmb_sim_create(c->r.model, NULL, &c->low));
    must_model(&c->r, dmb_sim_create(c->r.model, NULL, &c->high));
    must_model(&c->r, dmb_sim_create(c->r.model, NULL, &c->beside));
    (void)find_equilibrium(&c->r, NULL);
}

/* Takes the time function of the turning drive over and leaves its value at a limited rate. */
static void add_input(subject *c)
{
    dmb_input_def input = dmb_input_def_default();
    strcpy(input.name, "turn");
    input.part = c->turn;
    input.rate_limit = 5.0;
    must_model(&c->r, dmb_model_add_input(c->r.model, &input, &c->input));
}

/* Pipes in a hole, driven and pushed. */
static void open_string(subject *c)
{
    open_model(c);
    const dmb_wall_def hole = s1_hole();
    const dmb_pipe_def pipe = s1_pipe();
    (void)add_wall(&c->r, &hole);
    c->part = add_pipes(&c->r, &pipe, 3);
    c->place = dmb_station(c->part, 2, 1.0);
    c->home = 4.5;
    add_drives(c);
    add_input(c);
    add_push(c);
    add_hold(c);
    start(c);
}

/* A beam, a bar that is hinged to it, and a rule for the bar. */
static void open_mechanism(subject *c)
{
    open_model(c);
    const dmb_pipe_def pipe = beam_pipe(1.0, 2, 1e7, 1e7, 1e4, 1e4);
    dmb_body_def body = dmb_body_def_default();
    dmb_constraint_def rule = dmb_constraint_def_default();
    c->part = add_beam(&c->r, &pipe, DMB_FREE_NONE);
    body.position[0] = 1.5;
    body.mass = 2.0;
    const dmb_id bar = add_body(&c->r, &body);
    dmb_joint_def joint = joint_between(DMB_JOINT_UNIVERSAL, dmb_station(c->part, 0, 1.0), dmb_station(bar, 0, 0.0));
    joint.match = 1;
    joint.stiffness[DMB_RY] = joint.stiffness[DMB_RZ] = 1e4;
    c->joint = add_joint(&c->r, &joint);
    rule.place[0] = dmb_station(bar, 0, 0.0);
    rule.callback = level;
    rule.callback_context = c;
    must_model(&c->r, dmb_model_add_constraint(c->r.model, &rule, NULL));
    c->place = dmb_station(bar, 0, 0.0);
    c->home = 1.5;
    add_push(c);
    add_hold(c);
    start(c);
}

static void close_subject(subject *c)
{
    dmb_sim_destroy(&c->low);
    dmb_sim_destroy(&c->high);
    dmb_sim_destroy(&c->beside);
    rig_close(&c->r);
}

/* ---- Calls ------------------------------------------------------------------------------------------------------- */

static int32_t step(subject *c)
{
    return dmb_sim_step(c->r.sim, 1e-3, NULL);
}

static int32_t advance(subject *c)
{
    return dmb_sim_advance(c->r.sim, dmb_sim_time(c->r.sim) + 1e-3, NULL);
}

static int32_t set_drive(subject *c)
{
    return dmb_sim_set_drive(c->r.sim, c->drive, 0.1);
}

static int32_t set_input(subject *c)
{
    return dmb_sim_set_input(c->r.sim, c->input, 0.1);
}

static int32_t lock_joint(subject *c)
{
    return dmb_sim_set_joint(c->r.sim, c->joint, DMB_JOINT_LOCKED);
}

static int32_t open_joint(subject *c)
{
    return dmb_sim_set_joint(c->r.sim, c->joint, DMB_JOINT_OPEN);
}

static int32_t create(subject *c)
{
    dmb_sim *made = NULL;
    const int32_t status = dmb_sim_create(c->r.model, NULL, &made);
    GIVES_NOTHING_OUT(made);
    dmb_sim_destroy(&made);
    return status;
}

/* Of a sim at time 0, as low and high are; a failing step ends it. */
static int32_t sensitivity(subject *c)
{
    dmb_parameter parameter = dmb_parameter_default();
    const dmb_output height = {.place = c->place, .quantity = DMB_OUTPUT_POSITION_Z};
    double value;
    dmb_sensitivity *made = NULL;
    dmb_sim *sim = NULL;
    int32_t status = dmb_sim_create(c->r.model, NULL, &sim);
    if (status < 0) return status;
    parameter.low = c->low;
    parameter.high = c->high;
    parameter.step = 1e-6;
    status = dmb_sensitivity_create(sim, &parameter, 1, &made);
    GIVES_NOTHING_OUT(made);
    if (status >= 0) status = dmb_sensitivity_step(made, 1e-4, NULL);
    if (status >= 0) status = dmb_sensitivity_advance(made, 1e-3, NULL);
    if (status >= 0) must(&c->r, dmb_sensitivity_outputs(made, &height, 1, &value, &c->found));
    dmb_sensitivity_destroy(&made);
    dmb_sim_destroy(&sim);
    return status;
}

static int32_t state_equation(subject *c)
{
    double y[256], rate[256];
    dmb_state_equation *made = NULL;
    int32_t status = dmb_state_equation_create(c->r.sim, &made);
    GIVES_NOTHING_OUT(made);
    assert_in_range(dmb_state_equation_count(made), 0, 128);
    if (status >= 0) must(&c->r, dmb_state_equation_origin(made, NULL, y));
    if (status >= 0) status = dmb_state_equation_rate(made, dmb_sim_time(c->r.sim), y, rate);
    if (status >= 0) status = dmb_state_equation_begin(made, dmb_sim_time(c->r.sim) + 1e-3, y);
    dmb_state_equation_destroy(&made);
    return status;
}

static int32_t transfer(subject *c)
{
    return dmb_sim_transfer_state(c->r.sim, c->beside);
}

typedef struct row {
    const char *name;
    int32_t (*call)(subject *c);       /* own, or */
    int32_t (*ask)(const asked_of *a); /* of the common ones */
    int32_t scenes;                    /* that it is for: 1 the string, 2 the mechanism */
    int32_t goes;                      /* 1: the sim stays where the steps before led */
} row;

static const row rows[] = {
    {"step", step, NULL, 3, 0},
    {"advance", advance, NULL, 3, 1},
    {"set drive", set_drive, NULL, 1, 0},
    {"set input", set_input, NULL, 1, 0},
    {"lock a joint", lock_joint, NULL, 2, 0},
    {"open a joint", open_joint, NULL, 2, 0},
    {"statics", NULL, ask_statics, 3, 0},
    {"statics, laid on the wall", NULL, ask_statics_laid, 1, 0},
    {"statics in load steps", NULL, ask_statics_in_steps, 3, 0},
    {"steady states", NULL, ask_steady, 3, 0},
    {"check", NULL, ask_check_model, 3, 0},
    {"buckling", NULL, ask_buckling, 3, 0},
    {"buckling, followed", NULL, ask_followed_buckling, 1, 0},
    {"path", NULL, ask_path, 1, 0},
    {"modes", NULL, ask_lowest_modes, 3, 0},
    {"damped modes", NULL, ask_damped_modes, 3, 0},
    {"response", NULL, ask_response, 3, 0},
    {"speeds", NULL, ask_speeds, 3, 0},
    {"stepped sine", NULL, ask_stepped_sine, 3, 1},
    {"state space", NULL, ask_state_space, 3, 0},
    {"array of the residual", NULL, ask_residual_array, 3, 0},
    {"create", create, NULL, 3, 0},
    {"sensitivity", sensitivity, NULL, 3, 1},
    {"state equation", state_equation, NULL, 2, 0},
    {"transfer", transfer, NULL, 3, 0},
};

static int32_t run(subject *c, const row *r)
{
    const asked_of all = {c->r.sim, c->place, DMB_Z, 3, 50.0, 1e4};
    return r->ask != NULL ? r->ask(&all) : r->call(c);
}

/* ---- Each of them, each question --------------------------------------------------------------------------------- */

static void fail_one(subject *c, const row *r, size_t k)
{
    const uint64_t before = rig_hash(&c->r);
    c->asked = 0;
    c->failing = k;
    const int32_t status = run(c, r);
    c->failing = 0;
    if (c->asked < k) fail_msg("%s: %zu questions, fewer than before", r->name, c->asked);
    if (status != DMB_ERR_CALLBACK)
        fail_msg("%s: question %zu failed: %s: %s", r->name, k, dmb_status_name(status), dmb_sim_message(c->r.sim));
    if (r->call != create && r->call != sensitivity && r->call != state_equation &&
        dmb_sim_message(c->r.sim)[0] == '\0')
        fail_msg("%s: question %zu failed: no message", r->name, k);
    if (!r->goes && rig_hash(&c->r) != before) fail_msg("%s: question %zu failed: the sim has changed", r->name, k);
}

static void fail_each(subject *c, const row *r)
{
    size_t size;
    assert_int_equal(dmb_sim_snapshot_size(c->r.sim, &size), DMB_OK);
    void *before = malloc(size);
    assert_non_null(before);
    assert_int_equal(dmb_sim_snapshot(c->r.sim, before, size), DMB_OK);
    c->asked = 0;
    int32_t status = run(c, r);
    if (status < 0) fail_msg("%s: %s: %s", r->name, dmb_status_name(status), dmb_sim_message(c->r.sim));
    const size_t asked = c->asked, stride = asked / TRIED + 1;
    const uint64_t after = rig_hash(&c->r);
    must(&c->r, dmb_sim_restore(c->r.sim, before, size));
    for (size_t k = 1; k <= asked; k += stride) {
        fail_one(c, r, k);
        must(&c->r, dmb_sim_restore(c->r.sim, before, size));
    }
    status = run(c, r);
    if (status < 0) fail_msg("%s, again: %s", r->name, dmb_status_name(status));
    assert_true(rig_hash(&c->r) == after);
    print_message("    %4zu questions of %s\n", asked, r->name);
    free(before);
}

static void all_calls(void (*open)(subject *c), int scene)
{
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        subject c;
        if (!(rows[i].scenes & scene)) continue;
        open(&c);
        fail_each(&c, &rows[i]);
        close_subject(&c);
    }
}

static void on_a_string(void **state)
{
    (void)state;
    all_calls(open_string, 1);
}

static void on_a_mechanism(void **state)
{
    (void)state;
    all_calls(open_mechanism, 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(on_a_string), cmocka_unit_test(on_a_mechanism)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
