/* A step made in parts by threads of the caller's: the same bits as alone for any number of parts, in strings that are
 * divided into pieces, with contact, branches, joints, bodies, pipes on the hole's axis, error control and snapshots;
 * and functions that do not run the parts as they are told. Under the thread sanitizer without races. */
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "../../examples/two_cores/pool.h"
#include "mechanism.h"
#include "sim/layout.h"

enum { TUBE, HOLE, BRANCHES, JOINTED, MIXED, SCENES, STEPS = 6 };
static const char *const names[SCENES] = {"tube", "hole", "branches", "jointed", "mixed"};
static pool threads;
static int32_t laws[2] = {DMB_NORMAL_KELVIN_VOIGT, DMB_FRICTION_BRISTLE}; /* of the hole, normal and friction */

/* ---- Scenes ------------------------------------------------------------------------------------------------------ */

static dmb_id ramp(rig *s, double to)
{
    dmb_term term = dmb_term_default();
    term.kind = DMB_TERM_STEP;
    term.x1 = 0.05;
    term.h1 = to;
    return add_programme(s, &term, 1);
}

static dmb_id long_string(rig *s, uint32_t pipes, double y, int32_t free)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    string.start_free = free;
    string.position[1] = y; /* where there is no hole */
    string.offset[1] = y;
    pipe.string = add_string(s, &string);
    pipe.damping_time = 1e-5;
    (void)add_pipes(s, &pipe, pipes);
    return pipe.string;
}

static void describe_tube(rig *s)
{
    const dmb_id string = long_string(s, 2000, 0.0, DMB_FREE_RX);
    (void)add_simple_drive(s, DMB_DRIVE_MOTION, string, DMB_RX, ramp(s, 6.0));
}

/* Rigid masses, a bit and a head; bristles; pipes that begin on the wall. */
static void describe_hole(rig *s)
{
    dmb_wall_def wall = s1_hole();
    dmb_bit_def bit = dmb_bit_def_default();
    dmb_body_def head = dmb_body_def_default();
    wall.normal_law = laws[0];
    wall.friction_law = laws[1];
    (void)add_wall(s, &wall);
    const dmb_id string = long_string(s, 2000, -0.0104, DMB_FREE_X | DMB_FREE_RX);
    bit.string = string;
    must_model(s, dmb_model_add_bit(s->model, &bit, NULL));
    head.attach = DMB_ATTACH_START;
    head.string = string;
    (void)add_body(s, &head);
    (void)add_simple_drive(s, DMB_DRIVE_LOAD, string, DMB_X, ramp(s, 2e4));
    (void)add_simple_drive(s, DMB_DRIVE_MOTION, string, DMB_RX, ramp(s, 6.0));
}

/* Strings of a thousand pipes, of so few that they are not divided, and bodies beside them, which hit the wall. */
static void describe_branches(rig *s)
{
    static const double survey[9] = {0.0, 0.5 * PI, 0.0, 500.0, 0.5 * PI, 0.0, 3000.0, 0.5 * PI + 0.5, 0.3};
    dmb_wall_def wall = s1_hole();
    dmb_body_def body = dmb_body_def_default();
    wall.survey = survey;
    wall.survey_count = 3;
    wall.diameter = 0.2;
    (void)add_wall(s, &wall);
    (void)long_string(s, 1000, -0.05, DMB_FREE_NONE);
    (void)long_string(s, 700, 0.02, DMB_FREE_ALL);
    (void)long_string(s, 90, 0.05, DMB_FREE_ALL);
    body.mass = 2.0;
    body.contact_diameter = 0.1;
    for (int i = 0; i < 3; i++) body.inertia[i] = 0.02 + 0.01 * i;
    body.velocity[2] = -1.0;
    for (int i = 0; i < 3; i++) {
        body.position[0] = 10.0 * i;
        (void)add_body(s, &body);
    }
}

/* A string on a body that a revolute joint holds, one beside it that turns, and a pendulum. */
static void describe_jointed(rig *s)
{
    dmb_body_def body = dmb_body_def_default();
    const dmb_id string = long_string(s, 1100, 0.0, DMB_FREE_ALL), other = long_string(s, 1100, 1.0, DMB_FREE_RX);
    body.mass = 5.0;
    for (int i = 0; i < 3; i++) body.inertia[i] = 0.1;
    const dmb_id head = add_body(s, &body);
    dmb_joint_def joint = joint_between(DMB_JOINT_REVOLUTE, dmb_station(ground_id, 0, 0.0), dmb_station(head, 0, 0.0));
    (void)add_joint(s, &joint);
    joint = joint_between(DMB_JOINT_FIXED, dmb_station(head, 0, 0.0), dmb_station(string, 0, 0.0));
    (void)add_joint(s, &joint);
    (void)add_simple_drive(s, DMB_DRIVE_MOTION, other, DMB_RX, ramp(s, 6.0));
}

/* Pipes that bend, pipes that stay on the axis of the hole, and pipes that bend again. */
static void describe_mixed(rig *s)
{
    dmb_wall_def wall = s1_hole();
    dmb_pipe_def pipe = s1_pipe();
    (void)add_wall(s, &wall);
    pipe.string = long_string(s, 700, 0.0, DMB_FREE_X | DMB_FREE_RX);
    pipe.kind = DMB_PIPE_AXIAL_TORSIONAL;
    (void)add_pipes(s, &pipe, 300);
    pipe.kind = DMB_PIPE_FLEXIBLE;
    (void)add_pipes(s, &pipe, 600);
    (void)add_simple_drive(s, DMB_DRIVE_LOAD, pipe.string, DMB_X, ramp(s, 2e4));
    (void)add_simple_drive(s, DMB_DRIVE_LOAD, pipe.string, DMB_RX, ramp(s, 2e3));
}

static void describe(rig *s, int kind)
{
    static void (*const how[SCENES])(rig *) = {describe_tube, describe_hole, describe_branches, describe_jointed,
                                               describe_mixed};
    rig_open(s, 0.0, 0.0, -9.81);
    how[kind](s);
    must_model(s, dmb_model_compile(s->model, NULL));
}

/* ---- The same bits ----------------------------------------------------------------------------------------------- */

static dmb_sim_options in_parts(dmb_parallel_fn parallel, void *context, uint32_t parts)
{
    dmb_sim_options options = dmb_sim_options_default();
    options.parallel = parallel;
    options.parallel_context = context;
    options.parallel_parts = parts;
    return options;
}

static void begin(rig *s, const dmb_sim_options *options)
{
    must_model(s, dmb_sim_create(s->model, options, &s->sim));
}

/* Steps, some of them chosen by their error, with a snapshot on the way that another sim goes on from. */
static uint64_t walk(rig *s, const dmb_sim_options *options, const dmb_sim_options *further)
{
    size_t size = 0;
    begin(s, options);
    take_divided_steps(s, 1e-3, STEPS);
    must(s, dmb_sim_advance(s->sim, 1e-3 * (STEPS + 1), NULL));
    must(s, dmb_sim_snapshot_size(s->sim, &size));
    void *bytes = malloc(size);
    assert_non_null(bytes);
    must(s, dmb_sim_snapshot(s->sim, bytes, size));
    dmb_sim_destroy(&s->sim);
    begin(s, further);
    must(s, dmb_sim_restore(s->sim, bytes, size));
    free(bytes);
    take_divided_steps(s, 2e-3, 2);
    const uint64_t hash = rig_hash(s);
    dmb_sim_destroy(&s->sim);
    return hash;
}

static void test_same_bits(void **state)
{
    static const uint32_t parts[4] = {1, 2, 3, 8};
    (void)state;
    for (int kind = 0; kind < SCENES; kind++) {
        rig s = {NULL, NULL};
        describe(&s, kind);
        const uint64_t alone = walk(&s, NULL, NULL);
        for (int i = 0; i < 4; i++) {
            const dmb_sim_options options = in_parts(pool_run, &threads, parts[i]);
            const uint64_t hash = walk(&s, &options, i % 2 ? &options : NULL);
            if (hash != alone) fail_msg("%s in %u parts: other bits", names[kind], (unsigned)parts[i]);
        }
        rig_close(&s);
    }
}

/* ---- Pieces ------------------------------------------------------------------------------------------------------ */

/* The accepted state after steps with the rings in pieces, and with all of them at once: what is kept for each ring
 * stays at its place. Their powers are summed otherwise, and the ledger is not compared. */
static void check_pieces(int32_t normal_law, int32_t friction_law)
{
    rig s = {NULL, NULL}, whole = {NULL, NULL};
    dmb_field in_pieces[DMB_FIELD_MAX], at_once[DMB_FIELD_MAX];
    laws[0] = normal_law;
    laws[1] = friction_law;
    describe(&s, HOLE);
    describe(&whole, HOLE);
    begin(&s, NULL);
    begin(&whole, NULL);
    assert_true(s.sim->scene->sites_in_order >= 2000);
    ((dmb_scene *)(uintptr_t)whole.sim->scene)->sites_in_order = 0;
    take_divided_steps(&s, 1e-3, 7);
    take_divided_steps(&whole, 1e-3, 7);
    assert_true(contacts_of(&s).closed > 100);
    const size_t count = dmb_sim_fields(s.sim, DMB_GROUP_NOW, DMB_GROUP_NOW, in_pieces);
    assert_true(dmb_sim_fields(whole.sim, DMB_GROUP_NOW, DMB_GROUP_NOW, at_once) == count);
    for (size_t i = 0; i < count; i++)
        if (memcmp(in_pieces[i].data, at_once[i].data, in_pieces[i].bytes) != 0) fail_msg("%s", in_pieces[i].name);
    rig_close(&s);
    rig_close(&whole);
}

static void test_pieces_of_the_wall(void **state)
{
    (void)state;
    check_pieces(DMB_NORMAL_KELVIN_VOIGT, DMB_FRICTION_COULOMB);
    check_pieces(DMB_NORMAL_KELVIN_VOIGT, DMB_FRICTION_BRISTLE);
    check_pieces(DMB_NORMAL_HUNT_CROSSLEY, DMB_FRICTION_BRISTLE);
}

/* ---- Functions that do something else ---------------------------------------------------------------------------- */

enum { WELL, BACKWARDS, TWICE, BEYOND, LEFT_OUT, NONE, REFUSES, CALLS_BACK };

typedef struct worker {
    int how;
    uint32_t calls;
    dmb_sim *sim;
    int32_t answer; /* of the call back */
    dmb_part_fn part;
    void *work;
} worker;

static int32_t work_alone(void *context, uint32_t count, dmb_part_fn part, void *work)
{
    worker *w = context;
    w->calls++;
    w->part = part;
    w->work = work;
    if (w->how == CALLS_BACK) w->answer = dmb_sim_step(w->sim, 1e-3, NULL);
    if (w->how == BEYOND) part(work, count);
    for (uint32_t i = 0; i < count && w->how != NONE; i++) {
        if (w->how == LEFT_OUT && i == 1) continue;
        part(work, w->how == BACKWARDS ? count - 1 - i : i);
        if (w->how == TWICE) part(work, i);
    }
    return w->how == REFUSES ? 7 : 0;
}

static void open_worker(rig *s, worker *w, int kind)
{
    const dmb_sim_options options = in_parts(work_alone, w, 3);
    memset(w, 0, sizeof *w);
    describe(s, kind);
    begin(s, &options);
    w->sim = s->sim;
}

static uint64_t bits_of(int how)
{
    rig s = {NULL, NULL};
    worker w;
    open_worker(&s, &w, HOLE);
    w.how = how;
    take_divided_steps(&s, 1e-3, 3);
    assert_true(w.calls > 0);
    w.part(w.work, 0); /* after the step: there is nothing to do */
    take_divided_steps(&s, 1e-3, 1);
    if (how == CALLS_BACK) assert_int_equal(w.answer, DMB_ERR_ORDER);
    const uint64_t hash = rig_hash(&s);
    rig_close(&s);
    return hash;
}

static void test_harmless(void **state)
{
    const uint64_t well = bits_of(WELL);
    (void)state;
    assert_true(bits_of(BACKWARDS) == well);
    assert_true(bits_of(TWICE) == well);
    assert_true(bits_of(BEYOND) == well);
    assert_true(bits_of(CALLS_BACK) == well);
}

/* A step fails by what the function did, changes nothing, and may be made again. */
static void check_failure(int how, const char *told)
{
    rig s = {NULL, NULL}, alone = {NULL, NULL};
    worker w;
    dmb_step_report report = dmb_step_report_default();
    open_worker(&s, &w, HOLE);
    take_divided_steps(&s, 1e-3, 2);
    const uint64_t before = rig_hash(&s);
    w.how = how;
    w.calls = 0;
    assert_int_equal(dmb_sim_step(s.sim, 1e-3, &report), DMB_ERR_CALLBACK);
    assert_int_equal(w.calls, 1); /* and is not asked again */
    if (strstr(dmb_sim_message(s.sim), told) == NULL) fail_msg("%s", dmb_sim_message(s.sim));
    assert_true(rig_hash(&s) == before);
    w.how = WELL;
    take_divided_steps(&s, 1e-3, 1);
    describe(&alone, HOLE);
    begin(&alone, NULL);
    take_divided_steps(&alone, 1e-3, 3);
    assert_true(rig_hash(&s) == rig_hash(&alone));
    w.how = how;
    assert_int_equal(dmb_sim_advance(s.sim, 1.0, NULL), DMB_ERR_CALLBACK);
    assert_true(dmb_sim_time(s.sim) == dmb_sim_time(alone.sim));
    rig_close(&alone);
    rig_close(&s);
}

static void test_failures(void **state)
{
    (void)state;
    check_failure(LEFT_OUT, "parallel ran 2 of 3 parts in the step after time 0.002");
    check_failure(NONE, "parallel ran 0 of 3 parts");
    check_failure(REFUSES, "parallel returned 7 in the step after time 0.002");
}

static void test_bounds(void **state)
{
    rig s = {NULL, NULL};
    worker w = {0};
    dmb_sim_options options = in_parts(work_alone, &w, 65);
    (void)state;
    describe(&s, TUBE);
    assert_int_equal(dmb_sim_create(s.model, &options, &s.sim), DMB_ERR_VALUE);
    assert_non_null(strstr(dmb_model_message(s.model), "parallel_parts = 65, must be 1 .. 64"));
    options.parallel_parts = 0;
    assert_int_equal(dmb_sim_create(s.model, &options, &s.sim), DMB_ERR_VALUE);
    options.parallel_parts = 64;
    options.parallel_least = 2001;
    begin(&s, &options);
    take_steps(&s, 1e-3, 2);
    assert_int_equal(w.calls, 0);
    dmb_sim_destroy(&s.sim);
    options.parallel_least = 2000;
    begin(&s, &options);
    take_steps(&s, 1e-3, 2);
    assert_true(w.calls > 0);
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_same_bits), cmocka_unit_test(test_pieces_of_the_wall),
                                       cmocka_unit_test(test_harmless), cmocka_unit_test(test_failures),
                                       cmocka_unit_test(test_bounds)};
    (void)pool_start(&threads, 3);
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    pool_stop(&threads);
    return failed;
}
