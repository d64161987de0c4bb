/* The tangent of the equations of a steady state, K = dr/dH + (dr/dV) ad(g), against six-point central differences of
 * their residual along random displacements: of strings that turn as a whole, exact; of strings that slide and turn,
 * without the change of V' and of the axis of a hole that bends, 2e-6 of the largest entry here. */
#include <string.h>

#include "rig.h"

#include "analysis/static/static.h"
#include "math/block_tridiagonal.h"
#include "sim/layout.h"
#include "sim/sim.h"
#include "system/assemble/drives.h"

enum { ROWS_MAX = 400, DIRECTIONS = 4 };

typedef struct choice {
    const char *name;
    int32_t steady;
    double speed, spin, swing; /* of drives in X, RX, RZ */
    double eccentricity, curvature, damping, external;
    double bend; /* [rad/m] of the hole; < 0: no hole */
    int32_t law;
} choice;

static void describe(rig *s, const choice *c)
{
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    const double survey[6] = {0.0, 1.4, 0.0, 60.0, 1.4 + 60.0 * c->bend, 0.0};
    const int hole = c->bend >= 0.0;
    rig_open(s, 0.0, 0.0, c->steady == DMB_STEADY_RIGID ? 0.0 : -9.81);
    if (hole) {
        dmb_wall_def wall = s1_hole();
        wall.survey = survey;
        wall.survey_count = 2;
        wall.friction_law = c->law;
        wall.stiffness = 1e7;
        wall.mu_static = wall.mu_dynamic = 0.3;
        (void)add_wall(s, &wall);
        def.start_depth = 5.0;
    } else {
        def.follows_hole = 0;
    }
    def.start_free = c->swing != 0.0 ? DMB_FREE_RZ : DMB_FREE_X | DMB_FREE_RX;
    pipe.elements = 2;
    pipe.eccentricity = c->eccentricity;
    pipe.curvature[1] = c->curvature;
    pipe.damping_time = c->damping;
    pipe.string = add_string(s, &def);
    (void)add_pipes(s, &pipe, 4);
    if (c->swing != 0.0) {
        (void)add_simple_drive(s, DMB_DRIVE_MOTION, pipe.string, DMB_RZ, add_constant(s, c->swing));
    } else {
        (void)add_simple_drive(s, DMB_DRIVE_MOTION, pipe.string, DMB_X, add_constant(s, c->speed));
        (void)add_simple_drive(s, DMB_DRIVE_MOTION, pipe.string, DMB_RX, add_constant(s, c->spin));
    }
    (void)rig_start(s, NULL);
}

/* The trial where the state is, moved a little so that it is no equilibrium. */
static void begin(dmb_sim *sim, dmb_static_search *search, dmb_steady *steady, const choice *c,
                  const dmb_static_options *options, uint64_t *seed)
{
    double off[ROWS_MAX];
    assert_int_equal(dmb_steady_choose(sim, c->steady, 0, steady), DMB_OK);
    dmb_static_set_up(search, sim, options);
    search->steady = steady;
    dmb_configuration_copy(sim, &sim->now, &sim->trial);
    memset(sim->increment, 0, sim->scene->row_count * sizeof(double));
    assert_int_equal(dmb_system_prescribe(&search->evaluation), DMB_OK);
    for (uint32_t i = 0; i < sim->scene->row_count; i++)
        off[i] = sim->scene->solved_row[i] ? (c->bend >= 0.0 ? 1e-7 : 1e-5) * draw_between(seed, -1.0, 1.0) : 0.0;
    dmb_static_displace(sim, off, 1.0);
}

static void residual_at(dmb_static_search *search, const double *direction, double x, double *out)
{
    dmb_sim *sim = search->sim;
    dmb_static_displace(sim, direction, x);
    search->evaluation.tangent = 0;
    assert_int_equal(dmb_static_evaluate(search), DMB_OK);
    memcpy(out, sim->residual, sim->scene->row_count * sizeof(double));
    dmb_static_displace(sim, direction, -x);
}

/* y = K d by the blocks of the last evaluation. */
static void multiply(const dmb_sim *sim, const double *d, double *y)
{
    const dmb_scene *scene = sim->scene;
    static uint8_t pivot[ROWS_MAX];
    const dmb_block_matrix K = {sim->stiffness_diagonal, sim->stiffness_lower, sim->stiffness_upper, pivot};
    memset(y, 0, scene->row_count * sizeof(double));
    for (uint32_t k = 0; k < scene->chain_count; k++)
        dmb_block_multiply(&scene->layout, &K, scene->chains[k].first, scene->chains[k].count, d, y);
}

/* [-] largest difference over the largest entry. */
static double error_along(dmb_static_search *search, const double *direction)
{
    dmb_sim *sim = search->sim;
    const uint32_t rows = sim->scene->row_count;
    double f[6][ROWS_MAX], by_blocks[ROWS_MAX], most = 0.0, off = 0.0;
    const double step = sim->scene->site_count > 0 ? 1e-8 : 1e-6; /* within which no contact opens */
    search->evaluation.tangent = 1;
    assert_int_equal(dmb_static_evaluate(search), DMB_OK);
    multiply(sim, direction, by_blocks);
    for (int p = 0; p < 6; p++) residual_at(search, direction, step * difference6_place[p], f[p]);
    for (uint32_t i = 0; i < rows; i++) {
        const double v[6] = {f[0][i], f[1][i], f[2][i], f[3][i], f[4][i], f[5][i]};
        if (!sim->scene->solved_row[i]) continue;
        most = fmax(most, fabs(by_blocks[i]));
        off = fmax(off, fabs(by_blocks[i] - difference6(v, step)));
    }
    return off / most;
}

static double worst_error(const choice *c)
{
    rig s;
    dmb_static_options options = dmb_static_options_default();
    dmb_static_search search;
    dmb_steady steady;
    uint64_t seed = 7;
    double worst = 0.0;
    describe(&s, c);
    options.steady = c->steady;
    assert_int_equal(find_equilibrium(&s, &options).steady, c->steady);
    assert_true(s.sim->scene->row_count <= ROWS_MAX);
    for (int k = 0; k < DIRECTIONS; k++) {
        double direction[ROWS_MAX];
        begin(s.sim, &search, &steady, c, &options, &seed);
        for (uint32_t i = 0; i < s.sim->scene->row_count; i++)
            direction[i] = s.sim->scene->solved_row[i] ? draw_between(&seed, -1.0, 1.0) : 0.0;
        worst = fmax(worst, error_along(&search, direction));
        dmb_steady_release(&steady);
    }
    rig_close(&s);
    return worst;
}

static void strings_that_turn_as_a_whole(void **state)
{
    static const choice choices[] = {
        {"swings", DMB_STEADY_RIGID, 0, 0, 20.0, 0, 0, 0, 0, -1.0, 0},
        {"swings, damped", DMB_STEADY_RIGID, 0, 0, 20.0, 0, 0, 1e-3, 0, -1.0, 0},
        {"swings, eccentric and bent", DMB_STEADY_RIGID, 0, 0, 5.0, 5e-3, 1e-2, 1e-3, 0, -1.0, 0},
        {"turns about its axis, eccentric", DMB_STEADY_RIGID, 0, 10.0, 0, 5e-3, 0, 1e-3, 0, -1.0, 0},
        {"turns about its axis, bent", DMB_STEADY_RIGID, 0, 10.0, 0, 0, 1e-2, 1e-3, 0, -1.0, 0},
    };
    (void)state;
    for (size_t i = 0; i < sizeof choices / sizeof choices[0]; i++)
        check_below(choices[i].name, worst_error(choices + i), 2e-9);
}

static void strings_that_slide(void **state)
{
    static const choice choices[] = {
        {"slides", DMB_STEADY_SLIDING, 0.3, 0, 0, 0, 0, 1e-3, 0, 0.0, DMB_FRICTION_COULOMB},
        {"slides in a bend", DMB_STEADY_SLIDING, 0.3, 0, 0, 0, 0, 1e-3, 0, 3e-3, DMB_FRICTION_COULOMB},
        {"turns", DMB_STEADY_SLIDING, 0, 10.0, 0, 0, 0, 1e-3, 0, 0.0, DMB_FRICTION_COULOMB},
        {"turns in a bend", DMB_STEADY_SLIDING, 0, 10.0, 0, 0, 0, 1e-3, 0, 3e-3, DMB_FRICTION_STRIBECK},
        {"slides and turns", DMB_STEADY_SLIDING, 0.3, 10.0, 0, 0, 0, 1e-3, 0, 0.0, DMB_FRICTION_STRIBECK},
        {"slides and turns in a bend", DMB_STEADY_SLIDING, 0.3, 10.0, 0, 0, 0, 1e-3, 0, 3e-3, DMB_FRICTION_COULOMB},
    };
    (void)state;
    for (size_t i = 0; i < sizeof choices / sizeof choices[0]; i++)
        check_below(choices[i].name, worst_error(choices + i), choices[i].bend * choices[i].speed > 0.0 ? 1e-5 : 2e-7);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(strings_that_turn_as_a_whole),
        cmocka_unit_test(strings_that_slide),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
