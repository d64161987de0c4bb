/* Behind a step at whose end forces or rates jump, accelerations are made anew. Where these come out as no numbers, the
 * call fails with what it was: a step leaves poses, speeds and time as they were, and made again it ends where one does
 * in which nothing has failed. No function of the caller's is in these scenes: the sum that tells whether forces are
 * numbers answers NaN once, at each question of the call. */
#include <math.h>
#include <string.h>

#include "kernel/kernels.h"
#include "rig.h"
#include "sim/sim.h"

static struct {
    double (*sum)(uint32_t count, const double *a);
    size_t asked, failing; /* questions so far; number of the one that fails, from 1, or 0 */
} fault;

static double faulty_sum(uint32_t count, const double *a)
{
    return ++fault.asked == fault.failing ? (double)NAN : fault.sum(count, a);
}

/* ---- Scenes ------------------------------------------------------------------------------------------------------ */

/* Rate that jumps at 2.4 ms, behind five steps of 0.4 ms and one to come. */
static dmb_id bent_time_function(rig *r)
{
    static const double times[] = {0.0, 2.4e-3, 1.0}, values[] = {0.0, 0.0, 40.0};
    dmb_segment term = dmb_segment_default();
    term.kind = DMB_SEGMENT_TABLE;
    term.table_time = times;
    term.table_value = values;
    term.table_count = 3;
    return add_time_function(r, &term, 1);
}

static void start(rig *r, dmb_kernels *kernels)
{
    dmb_sim_options options = dmb_sim_options_default();
    options.energy_ledger = 1;
    (void)rig_start(r, &options);
    *kernels = *r->sim->scene->kernels;
    fault.sum = kernels->magnitude;
    fault.asked = fault.failing = 0;
    kernels->magnitude = faulty_sum;
    ((dmb_scene *)(uintptr_t)r->sim->scene)->kernels = kernels;
}

/* Pipes that are turned at the rig from the corner on. */
static void open_turned(rig *r)
{
    const dmb_pipe_def pipe = s1_pipe();
    rig_open(r, 0.0, 0.0, -9.81);
    const dmb_id string = add_pipes(r, &pipe, 3);
    (void)add_simple_drive(r, DMB_DRIVE_MOTION, string, DMB_RX, bent_time_function(r));
}

/* The same by a joint, whose equations are settled anew. */
static void open_jointed(rig *r)
{
    dmb_body_def body = dmb_body_def_default();
    const dmb_id ground = {0, 0};
    rig_open(r, 0.0, 0.0, -9.81);
    for (int i = 0; i < 3; i++) body.inertia[i] = 0.02;
    const dmb_id arm = add_body(r, &body);
    dmb_joint_def joint = joint_between(DMB_JOINT_REVOLUTE, dmb_station(ground, 0, 0.0), dmb_station(arm, 0, 0.0));
    joint.origin_b[0] = -0.3;
    joint.match = 1;
    (void)add_simple_drive(r, DMB_DRIVE_MOTION, add_joint(r, &joint), DMB_RX, bent_time_function(r));
}

/* A string that is pulled until a place comes free. */
static void open_stuck(rig *r)
{
    const dmb_pipe_def pipe = s1_pipe();
    const dmb_wall_def hole = s1_hole();
    dmb_stuck_def stuck = dmb_stuck_def_default();
    rig_open(r, 0.0, 0.0, -9.81);
    (void)add_wall(r, &hole);
    const dmb_id string = add_pipes(r, &pipe, 2);
    (void)add_simple_drive(r, DMB_DRIVE_MOTION, string, DMB_X, add_constant(r, -0.02));
    stuck.place = dmb_station(string, 1, 0.5);
    stuck.overpull = 2000.0;
    must_model(r, dmb_model_add_stuck(r->model, &stuck, NULL));
}

/* ---- Each question fails ----------------------------------------------------------------------------------------- */

enum { NUMBERS_MAX = 400 };

typedef struct motion {
    double time, velocity[NUMBERS_MAX], acceleration[NUMBERS_MAX], displacement[NUMBERS_MAX], balance;
} motion;

static motion motion_of(const rig *r)
{
    const dmb_sim *sim = r->sim;
    motion m;
    memset(&m, 0, sizeof m);
    assert_true(sim->scene->row_count <= NUMBERS_MAX && 3 * sim->scene->node_count <= NUMBERS_MAX);
    m.time = sim->clock->time;
    memcpy(m.velocity, sim->now.velocity, sim->scene->row_count * sizeof(double));
    memcpy(m.acceleration, sim->now.acceleration, sim->scene->row_count * sizeof(double));
    memcpy(m.displacement, sim->now.displacement, 3 * sim->scene->node_count * sizeof(double));
    m.balance = energy_of(r).error;
    return m;
}

static int differ(const motion *a, const motion *b, double tolerance)
{
    for (int i = 0; i < NUMBERS_MAX; i++)
        if (!(fabs(a->velocity[i] - b->velocity[i]) <= tolerance * (1.0 + fabs(b->velocity[i]))) ||
            !(fabs(a->displacement[i] - b->displacement[i]) <= tolerance) ||
            !(fabs(a->acceleration[i] - b->acceleration[i]) <= 1e3 * tolerance * (1.0 + fabs(b->acceleration[i]))))
            return 1;
    return a->time != b->time;
}

/* exact: kept factors serve, so nothing at all may change; those that the failing step made are lost with it. */
static void each_fails(void (*open)(rig *r), double h, int steps, int exact)
{
    static unsigned char start_of[1 << 20];
    dmb_kernels kernels;
    size_t size = 0, failed = 0, behind = 0;
    rig r;
    open(&r);
    start(&r, &kernels);
    for (int i = 0; i < steps; i++) must(&r, dmb_sim_step(r.sim, h, NULL));
    must(&r, dmb_sim_snapshot_size(r.sim, &size));
    assert_true(size <= sizeof start_of);
    must(&r, dmb_sim_snapshot(r.sim, start_of, size));
    const motion before = motion_of(&r);
    const uint64_t was = rig_hash(&r);
    fault.asked = 0;
    must(&r, dmb_sim_step(r.sim, h, NULL));
    const motion whole = motion_of(&r);
    const uint64_t end = rig_hash(&r);
    const size_t asked = fault.asked;
    const uint32_t cuts = r.sim->options.max_cuts;
    for (size_t k = 1; k <= asked; k++) {
        must(&r, dmb_sim_restore(r.sim, start_of, size));
        r.sim->options.max_cuts = 0;
        fault.asked = 0;
        fault.failing = k;
        const int32_t status = dmb_sim_step(r.sim, h, NULL);
        const motion after = motion_of(&r);
        const uint64_t hash = rig_hash(&r);
        fault.failing = 0;
        r.sim->options.max_cuts = cuts;
        if (status >= 0) continue; /* it was asked for another reason */
        failed++;
        if (status != DMB_ERR_NOT_FINITE) fail_msg("question %zu: %s", k, dmb_status_name(status));
        const char *message = dmb_sim_message(r.sim);
        if (strstr(message, "forces: not finite at time") != NULL)
            behind++;
        else if (strstr(message, "forces not finite") == NULL)
            fail_msg("question %zu: %s", k, message);
        if (exact && hash != was) fail_msg("question %zu: bits have changed", k);
        if (memcmp(&after, &before, sizeof after) != 0) fail_msg("question %zu: the state has changed", k);
        must(&r, dmb_sim_step(r.sim, h, NULL));
        const motion again = motion_of(&r);
        if (exact && rig_hash(&r) != end) fail_msg("question %zu: made again it ends with other bits", k);
        if (differ(&again, &whole, 1e-9)) fail_msg("question %zu: made again it ends elsewhere", k);
    }
    print_message("    %zu questions, %zu fail, %zu behind a step\n", asked, failed, behind);
    assert_true(behind > 0);
    rig_close(&r);
}

static void of_a_step_onto_a_corner(void **state)
{
    (void)state;
    each_fails(open_turned, 4e-4, 5, 1);
    each_fails(open_turned, 2.4e-3, 0, 0);
}

static void of_a_joint_at_a_corner(void **state)
{
    (void)state;
    each_fails(open_jointed, 4e-4, 5, 1);
}

static void of_a_place_that_comes_free(void **state)
{
    (void)state;
    rig r;
    open_stuck(&r);
    dmb_kernels kernels;
    start(&r, &kernels);
    int steps = 0;
    while (r.sim->stuck_held[0] && steps < 1000) {
        must(&r, dmb_sim_step(r.sim, 5e-4, NULL));
        steps++;
    }
    assert_true(steps > 1 && steps < 1000);
    rig_close(&r);
    each_fails(open_stuck, 5e-4, steps - 1, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(of_a_step_onto_a_corner),
        cmocka_unit_test(of_a_joint_at_a_corner),
        cmocka_unit_test(of_a_place_that_comes_free),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
