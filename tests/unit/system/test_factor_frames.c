/* Kept factors of a string against its wall: the wall stays where it is while the pipes turn about their axes, so they
 * hold in the frames in which they were made, by any angle. */
#include "rig.h"

#include <string.h>

#include "check.h"
#include "math/so3.h"
#include "sim/layout.h"
#include "sim/sim.h"
#include "system/assemble/evaluation.h"
#include "system/solve/solve.h"

enum { PIPES = 5, ROWS = 6 * (PIPES + 1) };

/* Lies on the wall, held at neither end but across the rig. */
static void open_string(rig *s)
{
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    rig_open(s, 0.0, 0.0, -9.81);
    add_wall(s, &wall);
    add_pipes(s, &pipe, PIPES);
    rig_start(s, NULL);
    find_equilibrium(s, NULL);
}

/* The pipes of the trial turned about their own axes, at the speed `spin` [rad/s]. */
static void turn_to(dmb_sim *sim, double angle, double spin)
{
    const double q[4] = {cos(0.5 * angle), sin(0.5 * angle), 0.0, 0.0};
    dmb_configuration_copy(sim, &sim->now, &sim->trial);
    memset(sim->increment, 0, sim->scene->row_count * sizeof(double));
    for (uint32_t i = 0; i < sim->scene->node_count; i++) {
        dmb_quat_mul(sim->now.quaternion + 4 * i, q, sim->trial.quaternion + 4 * i);
        sim->trial.velocity[6 * i + 3] = spin;
    }
}

static void factor(dmb_sim *sim)
{
    dmb_evaluation e;
    memset(&e, 0, sizeof e);
    e.sim = sim;
    e.step = 1e-3;
    e.load_factor = 1.0;
    e.dynamic = e.tangent = 1;
    e.mass_factor = 4e6;
    e.velocity_factor = 2e3;
    assert_int_equal(dmb_system_evaluate(&e), DMB_OK);
    dmb_system_iteration_matrix(&e);
    assert_int_equal(dmb_factor_matrix(sim, DMB_METHOD_INDEPENDENT), -1);
}

static void solve(dmb_sim *sim, int32_t factors, const double *residual, double *z)
{
    *sim->factors = factors;
    dmb_solve_for(sim, residual, z);
}

static double difference(size_t n, const double *a, const double *b)
{
    double d[ROWS];
    for (size_t i = 0; i < n; i++) d[i] = a[i] - b[i];
    return largest(n, d) / largest(n, b);
}

static void they_hold_at_any_angle(void **state)
{
    const double angles[4] = {0.02, 1.0, 3.0, 300.0};
    double residual[ROWS], kept[ROWS], fresh[ROWS], first[ROWS];
    uint64_t seed = 3;
    rig s;
    (void)state;
    open_string(&s);
    dmb_sim *sim = s.sim;
    assert_int_equal(sim->scene->row_count, ROWS);
    for (int i = 0; i < ROWS; i++) residual[i] = draw_between(&seed, -1.0, 1.0);
    turn_to(sim, 0.0, 20.0);
    factor(sim);
    solve(sim, DMB_FACTORS_FRESH, residual, first);
    dmb_keep_factors(sim, sim->trial.quaternion);
    for (int k = 0; k < 4; k++) {
        turn_to(sim, angles[k], 20.0);
        factor(sim);
        solve(sim, DMB_FACTORS_FRESH, residual, fresh);
        solve(sim, DMB_FACTORS_REUSED, residual, kept);
        tell("angle [rad]", angles[k]);
        check_below("kept against fresh factors, of the correction", difference(ROWS, kept, fresh), 1e-9);
        tell("the same without the turn", difference(ROWS, first, fresh));
        if (angles[k] > 0.5) assert_true(difference(ROWS, first, fresh) > 1e-2); /* the wall is in it */
    }
    *sim->factors = DMB_FACTORS_NONE;
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(they_hold_at_any_angle)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
