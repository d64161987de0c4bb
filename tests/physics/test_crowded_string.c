/* Rings, contact points along elements, a stuck place and mud in one scene: derivatives along a run against differences
 * of whole runs, statics against a run that settles, snapshots with bounded work against the run that went on. (The
 * state space of the scene: test_state_space.c.) */
#include <stdlib.h>
#include <string.h>

#include "crowded_string.h"

typedef struct scene {
    rig s;
    crowded_string c;
} scene;

static scene open_with(const crowded_string *c, const dmb_sim_options *options)
{
    scene r = {.c = *c};
    rig_open(&r.s, 0.0, 0.0, -9.81);
    add_crowded_string(&r.s, &r.c);
    rig_start(&r.s, options);
    return r;
}

static dmb_sim_options sharp(void)
{
    dmb_sim_options options = dmb_sim_options_default();
    options.newton_tolerance = 1e-13;
    options.max_iterations = 40;
    return options;
}

enum { OUTPUTS = 4, STEPS = 40 };

static void outputs_of(const scene *r, dmb_output *out)
{
    const dmb_output all[OUTPUTS] = {{dmb_station(r->c.string, 2, 0.5), DMB_OUTPUT_POSITION_Z, 0},
                                     {dmb_station(r->c.string, 1, 0.35), DMB_OUTPUT_VELOCITY_Z, 0},
                                     {dmb_station(r->c.stuck, 0, 0.0), DMB_OUTPUT_STUCK_FORCE, 0},
                                     {dmb_station(r->c.string, 1, 0.8), DMB_OUTPUT_TORQUE, 0}};
    memcpy(out, all, sizeof all);
}

/* The string turns and slips while it falls onto the wall. */
static void turn(const scene *r)
{
    must(&r->s, dmb_sim_set_drive(r->s.sim, r->c.drive, 2.0));
}

static void values_at_end(const crowded_string *c, double *values)
{
    const dmb_sim_options options = sharp();
    scene r = open_with(c, &options);
    dmb_output outputs[OUTPUTS];
    turn(&r);
    take_steps(&r.s, 1e-3, STEPS);
    outputs_of(&r, outputs);
    for (int i = 0; i < OUTPUTS; i++) must(&r.s, dmb_query_output(r.s.sim, outputs + i, values + i));
    rig_close(&r.s);
}

/* (4 D(d) - D(2 d))/3 */
static void differences(const crowded_string *c, double *parameter, double d, double *out)
{
    const double value = *parameter, at[4] = {-2.0 * d, -d, d, 2.0 * d};
    double values[4][OUTPUTS];
    for (int k = 0; k < 4; k++) {
        *parameter = value + at[k];
        values_at_end(c, values[k]);
    }
    *parameter = value;
    for (int i = 0; i < OUTPUTS; i++)
        out[i] = (8.0 * (values[2][i] - values[1][i]) - (values[3][i] - values[0][i])) / (12.0 * d);
}

static void derivatives(const crowded_string *c, double *parameter, double step, double *out, double *largest)
{
    const dmb_sim_options options = sharp();
    const double value = *parameter;
    dmb_parameter p = dmb_parameter_default();
    dmb_sensitivity *sensitivity;
    dmb_output outputs[OUTPUTS];
    scene sides[3];
    for (int k = 0; k < 3; k++) {
        *parameter = value + step * (k - 1);
        sides[k] = open_with(c, &options);
        turn(&sides[k]);
    }
    *parameter = value;
    p.step = step;
    p.low = sides[0].s.sim;
    p.high = sides[2].s.sim;
    scene *r = &sides[1];
    outputs_of(r, outputs);
    must(&r->s, dmb_sensitivity_create(r->s.sim, &p, 1, &sensitivity));
    for (int i = 0; i < STEPS; i++) {
        must(&r->s, dmb_sensitivity_step(sensitivity, 1e-3, NULL));
        must(&r->s, dmb_sensitivity_outputs(sensitivity, outputs, OUTPUTS, NULL, out));
        for (int k = 0; k < OUTPUTS; k++) largest[k] = fmax(largest[k], fabs(out[k]));
    }
    dmb_sensitivity_destroy(&sensitivity);
    for (int k = 0; k < 3; k++) rig_close(&sides[k].s);
}

/* Rounding of the steps, divided by those of the parameters, is 1e-5 with half of these and 1e-4 with a tenth. */
static void sensitivities(void **state)
{
    (void)state;
    crowded_string c = crowded_string_default();
    double *const parameters[4] = {&c.mu, &c.stiffness, &c.ring_diameter, &c.inner_density};
    const double sizes[4] = {0.3, 4e6, 2e-3, 1000.0};
    const char *const names[4] = {"friction", "stiffness of the wall", "diameter of the ring", "mud inside"};
    for (int k = 0; k < 4; k++) {
        double found[OUTPUTS], want[OUTPUTS], largest[OUTPUTS] = {0.0}, worst = 0.0;
        derivatives(&c, parameters[k], 2e-3 * sizes[k], found, largest);
        differences(&c, parameters[k], 6e-3 * sizes[k], want);
        for (int i = 0; i < OUTPUTS; i++) worst = fmax(worst, fabs(found[i] - want[i]) / largest[i]);
        check_below(names[k], worst, 1e-5);
    }
}

/* Statics against a run from the same start that comes to rest: friction holds nothing sideways here that moves. */
static void settled(void **state)
{
    (void)state;
    crowded_string c = crowded_string_default();
    c.mu = 0.0;
    scene run = open_with(&c, NULL), still = open_with(&c, NULL);
    find_equilibrium(&still.s, NULL);
    must(&run.s, dmb_sim_advance(run.s.sim, 6.0, NULL));
    for (uint32_t p = 0; p < 4; p++) {
        const dmb_place at = dmb_station(c.string, p, 0.5);
        dmb_place a = at, b = at;
        a.part = run.c.string;
        b.part = still.c.string;
        check_close("statics against the settled run [m]", pose_at(&run.s, a).position[2],
                    pose_at(&still.s, b).position[2], 1e-7);
    }
    rig_close(&run.s);
    rig_close(&still.s);
}

/* Every step of at most four iterations, from a snapshot as in the run that it was taken of. */
static void goes_on(void **state)
{
    (void)state;
    const crowded_string c = crowded_string_default();
    dmb_sim_options options = dmb_sim_options_default();
    dmb_sim *again = NULL;
    size_t size;
    options.bounded_work = 1;
    options.max_iterations = 4;
    scene r = open_with(&c, &options);
    turn(&r);
    for (int i = 0; i < 50; i++) must(&r.s, dmb_sim_step(r.s.sim, 1e-3, NULL));
    must(&r.s, dmb_sim_snapshot_size(r.s.sim, &size));
    void *bytes = malloc(size);
    must(&r.s, dmb_sim_snapshot(r.s.sim, bytes, size));
    must_model(&r.s, dmb_sim_create(r.s.model, &options, &again));
    must(&r.s, dmb_sim_restore(again, bytes, size));
    rig other = {r.s.model, again};
    for (int i = 0; i < 50; i++) {
        must(&r.s, dmb_sim_step(r.s.sim, 1e-3, NULL));
        must(&other, dmb_sim_step(again, 1e-3, NULL));
    }
    assert_true(rig_hash(&other) == rig_hash(&r.s));
    free(bytes);
    dmb_sim_destroy(&again);
    rig_close(&r.s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sensitivities),
        cmocka_unit_test(settled),
        cmocka_unit_test(goes_on),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
