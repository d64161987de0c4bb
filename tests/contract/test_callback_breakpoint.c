/* Behind a step that ends where the rate of a time function jumps, accelerations are made anew, for which functions of
 * the caller's are asked. One that fails there fails the call: a step leaves the sim as it was, its kept factors
 * included, and an advance leaves it before the step that ends there, so that the next call makes the accelerations
 * anew and goes on with the bits of a run in which nothing has failed. */
#include <string.h>

#include "rig.h"
#include "sim/sim.h"

static const double breakpoint_time = 2.4e-3; /* [s] */

typedef struct subject {
    rig r;
    size_t asked, failing; /* questions so far; number of the one that fails, from 1, or 0 */
    int bends;             /* 1: the motion time function is a function of the caller's too */
} subject;

static int32_t answer(subject *c)
{
    return ++c->asked == c->failing;
}

/* Speed that rises from the breakpoint on. */
static int32_t bent(void *context, double time, double out[3])
{
    const double beyond = time - breakpoint_time, rise = 40.0;
    out[0] = beyond < 0.0 ? 0.0 : rise * beyond;
    out[1] = beyond < 0.0 ? 0.0 : rise;
    out[2] = beyond < 0.0 ? 0.0 : 0.5 * rise * beyond * beyond;
    return answer(context);
}

/* A weak spring to where it is. */
static int32_t hold(void *context, double time, uint32_t count, const double (*poses)[12],
                    const double (*velocities)[6], double (*forces)[6], double *tangent, double *potential,
                    const dmb_law_memory *memory)
{
    (void)memory;
    (void)time, (void)tangent, (void)potential, (void)count;
    for (int i = 0; i < 3; i++) forces[0][i] = -10.0 * poses[0][i] - velocities[0][i];
    return answer(context);
}

static dmb_id bent_time_function(subject *c)
{
    static const double times[] = {0.0, 2.4e-3, 1.0}, values[] = {0.0, 0.0, 40.0};
    dmb_segment term = dmb_segment_default();
    if (c->bends) return add_callback(&c->r, bent, c);
    term.kind = DMB_SEGMENT_TABLE;
    term.table_time = times;
    term.table_value = values;
    term.table_count = 3;
    return add_time_function(&c->r, &term, 1);
}

static void add_event(subject *c, dmb_id string)
{
    dmb_event_def event = dmb_event_def_default();
    strcpy(event.name, "never");
    event.output.place = dmb_station(string, 2, 1.0);
    event.output.quantity = DMB_OUTPUT_POSITION_X;
    event.level = 1e6;
    must_model(&c->r, dmb_model_add_event(c->r.model, &event, NULL));
}

/* Pipes on the low side of a hole, turned at the rig from the breakpoint on. */
static void open_subject(subject *c, int bends)
{
    const dmb_wall_def hole = s1_hole();
    const dmb_pipe_def pipe = s1_pipe();
    dmb_sim_options options = dmb_sim_options_default();
    dmb_force_def force = dmb_force_def_default();
    memset(c, 0, sizeof *c);
    c->bends = bends;
    rig_open(&c->r, 0.0, 0.0, -9.81);
    (void)add_wall(&c->r, &hole);
    const dmb_id string = add_pipes(&c->r, &pipe, 3);
    (void)add_simple_drive(&c->r, DMB_DRIVE_MOTION, string, DMB_RX, bent_time_function(c));
    force.place[0] = dmb_station(string, 2, 1.0);
    force.callback = hold;
    force.callback_context = c;
    must_model(&c->r, dmb_model_add_force(c->r.model, &force, NULL));
    add_event(c, string);
    options.energy_ledger = 1;
    (void)rig_start(&c->r, &options);
    (void)find_equilibrium(&c->r, NULL);
    take_steps(&c->r, 4e-4, 5); /* 2 ms; factors are kept by now */
}

/* ---- Calls ------------------------------------------------------------------------------------------------------- */

/* Its second substep begins at the breakpoint. */
static int32_t step_over(subject *c)
{
    return dmb_sim_step(c->r.sim, 8e-4, NULL);
}

static int32_t step_onto(subject *c)
{
    return dmb_sim_step(c->r.sim, 4e-4, NULL);
}

static int32_t advance(subject *c)
{
    return dmb_sim_advance(c->r.sim, 2.8e-3, NULL);
}

static int32_t advance_to_event(subject *c)
{
    return dmb_sim_advance_to_event(c->r.sim, 2.8e-3, NULL, NULL);
}

/* ---- Each question fails ----------------------------------------------------------------------------------------- */

enum { ROWS_MAX = 400 };

typedef struct motion {
    double time, velocity[ROWS_MAX], acceleration[ROWS_MAX], displacement[ROWS_MAX];
} motion;

static motion motion_of(const subject *c)
{
    const dmb_sim *sim = c->r.sim;
    motion m;
    memset(&m, 0, sizeof m);
    assert_true(sim->scene->row_count <= ROWS_MAX);
    m.time = sim->clock->time;
    memcpy(m.velocity, sim->now.velocity, sim->scene->row_count * sizeof(double));
    memcpy(m.acceleration, sim->now.acceleration, sim->scene->row_count * sizeof(double));
    memcpy(m.displacement, sim->now.displacement, 3 * sim->scene->node_count * sizeof(double));
    return m;
}

/* It fails with its message; a step changes nothing. Returns whether it stopped before the step that ends on the
 * breakpoint, rather than within it. */
static void fails(subject *c, int32_t (*call)(subject *c), int goes)
{
    const uint64_t before = rig_hash(&c->r);
    const size_t failing = c->failing;
    const int32_t status = call(c);
    c->failing = 0;
    if (status != DMB_ERR_CALLBACK) fail_msg("question %zu failed: %s", failing, dmb_status_name(status));
    if (strstr(dmb_sim_message(c->r.sim), "callback") == NULL)
        fail_msg("question %zu failed: message: %s", failing, dmb_sim_message(c->r.sim));
    if (!goes && rig_hash(&c->r) != before) fail_msg("question %zu failed: the sim has changed", failing);
}

static void each_fails(int bends, int32_t (*call)(subject *c), int goes)
{
    subject c;
    static unsigned char start[1 << 20];
    size_t size = 0;
    open_subject(&c, bends);
    must(&c.r, dmb_sim_snapshot_size(c.r.sim, &size));
    assert_true(size <= sizeof start && c.r.sim->reuse->step > 0.0);
    must(&c.r, dmb_sim_snapshot(c.r.sim, start, size));
    c.asked = 0;
    must(&c.r, call(&c));
    const motion whole = motion_of(&c);
    const uint64_t hash = rig_hash(&c.r);
    const size_t asked = c.asked;
    assert_true(asked > 4);
    for (size_t k = 1; k <= asked; k++) {
        must(&c.r, dmb_sim_restore(c.r.sim, start, size));
        c.asked = 0;
        c.failing = k;
        fails(&c, call, goes);
        must(&c.r, call(&c));
        const motion again = motion_of(&c);
        if (!goes && rig_hash(&c.r) != hash) fail_msg("question %zu failed: the call made again has other bits", k);
        if (memcmp(&again, &whole, sizeof whole) != 0) fail_msg("question %zu failed: the run goes on elsewhere", k);
    }
    print_message("    %zu questions\n", asked);
    rig_close(&c.r);
}

static void of_a_step_over_it(void **state)
{
    (void)state;
    each_fails(0, step_over, 0);
    each_fails(1, step_over, 0);
}

static void of_a_step_onto_it(void **state)
{
    (void)state;
    each_fails(0, step_onto, 0);
    each_fails(1, step_onto, 0);
}

static void of_an_advance(void **state)
{
    (void)state;
    each_fails(0, advance, 1);
    each_fails(1, advance, 1);
}

static void of_an_advance_to_an_event(void **state)
{
    (void)state;
    each_fails(0, advance_to_event, 1);
    each_fails(1, advance_to_event, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(of_a_step_over_it),
        cmocka_unit_test(of_a_step_onto_it),
        cmocka_unit_test(of_an_advance),
        cmocka_unit_test(of_an_advance_to_an_event),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
