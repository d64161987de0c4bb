/* Paths of equilibrium and buckling that follows them, past bifurcations, limit points and flutter: a force of the
 * caller's fails at each of its questions once. The status is DMB_ERR_CALLBACK, nothing is given out, the sim is as it
 * was, and the call works when it is made again. */
#include "rig.h"

/* Questions of a call that fail, spread over all of them. */
#ifdef DMB_SOME_CASES
enum { TRIED = 40 };
#else
enum { TRIED = 150 };
#endif

typedef struct subject {
    rig r;
    dmb_id string, push;
    dmb_place place;
    size_t asked, failing; /* questions so far; number of the one that fails, from 1, or 0 */
} subject;

/* It exerts nothing. */
static int32_t answer(void *context, double time, uint32_t count, const double (*poses)[12],
                      const double (*velocities)[6], double (*forces)[6], double *tangent, double *potential,
                      const dmb_law_memory *memory)
{
    (void)memory;
    subject *c = context;
    (void)time, (void)poses, (void)velocities, (void)potential;
    for (uint32_t i = 0; i < 6; i++) forces[0][i] = 0.0;
    for (uint32_t i = 0; tangent != NULL && i < 72 * count * count; i++) tangent[i] = 0.0;
    return ++c->asked == c->failing;
}

/* ---- Scenes ------------------------------------------------------------------------------------------------------ */

static void lay(subject *c, dmb_string_def string, dmb_pipe_def pipe)
{
    const subject nothing = {.asked = 0};
    *c = nothing;
    rig_open(&c->r, 0.0, 0.0, 0.0);
    string.follows_hole = 0;
    pipe.string = c->string = add_string(&c->r, &string);
    (void)add_pipes(&c->r, &pipe, 1);
    c->place = dmb_station(c->string, 0, 1.0);
}

static void load_and_start(subject *c, dmb_load_def load, double time_function)
{
    dmb_force_def force = dmb_force_def_default();
    force.place[0] = load.place = c->place;
    force.callback = answer;
    force.provides = DMB_PROVIDES_TANGENT;
    force.callback_context = c;
    must_model(&c->r, dmb_model_add_force(c->r.model, &force, NULL));
    load.time_function = add_constant(&c->r, time_function);
    c->push = add_load(&c->r, &load);
    (void)rig_start(&c->r, NULL);
    (void)find_equilibrium(&c->r, NULL);
}

/* Half of a pinned column, its end in the middle moves and does not turn. time function: of its push, over Euler's
 * load. */
static void open_column(subject *c, double time_function)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_load_def load = dmb_load_def_default();
    string.start_free = DMB_FREE_SPHERICAL;
    string.end_free = DMB_FREE_TRANSLATIONS;
    lay(c, string, beam_pipe(5.0, 6, 1e7, 1e7, 1e4, 1e4));
    load.force[0] = -PI * PI * 1e4 / 100.0;
    load_and_start(c, load, time_function);
}

static void open_unloaded_column(subject *c)
{
    open_column(c, 0.0);
}

static void open_pushed_column(subject *c)
{
    open_column(c, 0.5);
}

/* One bar of a truss that snaps through, its top guided upright. */
static void open_truss(subject *c)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_joint_def support = dmb_joint_def_default();
    dmb_load_def load = dmb_load_def_default();
    string.rotation[1] = -atan2(2.0, 10.0);
    string.start_free = DMB_FREE_RY;
    lay(c, string, beam_pipe(hypot(10.0, 2.0), 1, 1e6, 1e8, 1e8, 1e8));
    support.kind = DMB_JOINT_POINT_ON_LINE;
    support.place_b = c->place;
    support.origin_a[0] = 10.0;
    support.axis_a[0] = 0.0;
    support.axis_a[2] = 1.0;
    must_model(&c->r, dmb_model_add_joint(c->r.model, &support, NULL));
    load.force[2] = -1.0;
    load_and_start(c, load, 0.0);
}

/* Pushed along its own axis: it flutters. */
static void open_becks_column(subject *c)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_load_def load = dmb_load_def_default();
    string.start_free = DMB_FREE_NONE;
    lay(c, string, beam_pipe(10.0, 6, 1e8, 1e8, 1e5, 1e5));
    load.frame = DMB_FRAME_BODY;
    load.force[0] = -5e3;
    load_and_start(c, load, 1.0);
}

/* ---- Calls ------------------------------------------------------------------------------------------------------- */

static int32_t follow_path(subject *c, double end, double step, int32_t branch)
{
    dmb_path_options options = dmb_path_options_default();
    options.scale = DMB_SCALE_PART;
    options.part = c->push;
    options.place = c->place;
    options.factor_end = end;
    options.first_step = step;
    options.branch = branch;
    options.branch_size = 0.05;
    options.max_points = 24;
    return dmb_analysis_path(c->r.sim, &options, NULL);
}

static int32_t onto_branch(subject *c)
{
    return follow_path(c, 1.1, 0.0, 1);
}

static int32_t past_bifurcation(subject *c)
{
    return follow_path(c, 1.5, 0.0, 0);
}

static int32_t past_limit(subject *c)
{
    return follow_path(c, 1e4, 500.0, 0);
}

static int32_t buckle(subject *c, double factor_max)
{
    dmb_buckling_options options = dmb_buckling_options_default();
    dmb_buckling *found = NULL;
    options.follow = 1;
    options.factor_max = factor_max;
    options.count = 1;
    const int32_t status = dmb_analysis_buckling(c->r.sim, &options, &found);
    assert_true(status >= 0 || found == NULL);
    dmb_buckling_destroy(&found);
    return status;
}

static int32_t buckling_followed(subject *c)
{
    return buckle(c, 1e12);
}

static int32_t flutter_followed(subject *c)
{
    return buckle(c, 8.0);
}

/* ---- Each question ----------------------------------------------------------------------------------------------- */

static void fail_one(subject *c, int32_t (*call)(subject *c), size_t k)
{
    const uint64_t before = rig_hash(&c->r);
    c->asked = 0;
    c->failing = k;
    const int32_t status = call(c);
    c->failing = 0;
    if (status != DMB_ERR_CALLBACK)
        fail_msg("question %zu failed: %s: %s", k, dmb_status_name(status), dmb_sim_message(c->r.sim));
    assert_true(dmb_sim_message(c->r.sim)[0] != '\0');
    assert_true(rig_hash(&c->r) == before);
}

static void fail_each(void (*open)(subject *c), int32_t (*call)(subject *c), int32_t ends)
{
    subject c;
    open(&c);
    c.asked = 0;
    assert_int_equal(call(&c), ends);
    const size_t asked = c.asked, stride = asked / TRIED + 1;
    for (size_t k = 1; k <= asked; k += stride) fail_one(&c, call, k);
    assert_int_equal(call(&c), ends);
    print_message("    %zu questions, every %zu.\n", asked, stride);
    rig_close(&c.r);
}

static void paths(void **state)
{
    (void)state;
    fail_each(open_unloaded_column, onto_branch, DMB_OK);
    fail_each(open_unloaded_column, past_bifurcation, DMB_OK);
    fail_each(open_truss, past_limit, DMB_OK);
}

static void buckling(void **state)
{
    (void)state;
    fail_each(open_pushed_column, buckling_followed, DMB_OK);
    fail_each(open_becks_column, flutter_followed, DMB_NOTE_FLUTTER);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(paths), cmocka_unit_test(buckling)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
