/* The whole residual of strings with everything on: its tangent by pose, velocity and acceleration against six-point
 * central differences of the residual itself, and its conservative part against the energies. Equations:
 * eq:contact.pendulum, eq:contact.wrench, eq:contact.inside, eq:hole.advance, eq:hole.section-force. Checks
 * eq:motion.euler-poincare, eq:motion.gyroscopic, eq:motion.weight and eq:integration.iteration-matrix. Equations:
 * eq:contact.directions. */
#include <stdio.h>
#include <string.h>

#include "sim/layout.h"
#include "stirred_rig.h"

#include "math/se3.h"
#include "sim/sim.h"
#include "system/assemble/energy.h"
#include "system/assemble/evaluation.h"

#define ROWS_MAX 80

static dmb_evaluation evaluation_of(dmb_sim *sim, int32_t dynamic)
{
    dmb_evaluation e;
    memset(&e, 0, sizeof e);
    e.sim = sim;
    e.load_factor = 1.0;
    e.dynamic = dynamic;
    e.step = dynamic ? 0.02 : 0.0;
    return e;
}

/* Residual of the trial moved by x along row `row`: kind 0 pose, 1 velocity, 2 acceleration. */
static void move_row(dmb_sim *sim, int kind, uint32_t node, uint32_t c, double x)
{
    const uint32_t row = sim->scene->layout.row[node] + c;
    double h[6] = {0.0};
    memcpy(sim->trial.displacement, sim->now.displacement, 3 * sim->scene->node_count * sizeof(double));
    memcpy(sim->trial.quaternion, sim->now.quaternion, 4 * sim->scene->node_count * sizeof(double));
    memcpy(sim->trial.turn, sim->now.turn, sim->scene->node_count * sizeof(double));
    memcpy(sim->trial.velocity, sim->now.velocity, sim->scene->row_count * sizeof(double));
    memcpy(sim->trial.acceleration, sim->now.acceleration, sim->scene->row_count * sizeof(double));
    memset(sim->increment, 0, sim->scene->row_count * sizeof(double));
    if (kind == 1) sim->trial.velocity[row] += x;
    if (kind == 2) sim->trial.acceleration[row] += x;
    if (kind != 0) return;
    sim->increment[row] = x;
    h[c] = x;
    if (sim->scene->layout.size[node] == DMB_NODE_SIX_DOF)
        dmb_se3_advance(sim->trial.quaternion + 4 * node, sim->trial.displacement + 3 * node, h);
    else if (c == 0)
        sim->trial.displacement[3 * node] += x;
    else
        sim->trial.turn[node] += x;
}

static void column_by_differences(dmb_sim *sim, int32_t dynamic, int kind, uint32_t node, uint32_t c,
                                  double out[ROWS_MAX])
{
    const uint32_t rows = sim->scene->row_count;
    const double step = kind == 0 ? 2e-4 : 1e-3;
    double f[6][ROWS_MAX];
    for (int p = 0; p < 6; p++) {
        dmb_evaluation e = evaluation_of(sim, dynamic);
        move_row(sim, kind, node, c, step * difference6_place[p]);
        assert_int_equal(dmb_system_evaluate(&e), DMB_OK);
        memcpy(f[p], sim->residual, rows * sizeof(double));
    }
    for (uint32_t i = 0; i < rows; i++) {
        const double v[6] = {f[0][i], f[1][i], f[2][i], f[3][i], f[4][i], f[5][i]};
        out[i] = difference6(v, step);
    }
}

/* Column of stiffness + inertia blocks, without increments. */
static void column_of_blocks(const dmb_sim *sim, uint32_t node, uint32_t c, double out[ROWS_MAX])
{
    const dmb_block_layout *l = &sim->scene->layout;
    const uint32_t size = l->size[node];
    memset(out, 0, sim->scene->row_count * sizeof(double));
    for (uint32_t i = 0; i < size; i++)
        out[l->row[node] + i] =
            sim->stiffness_diagonal[l->diag[node] + size * i + c] + sim->inertia_diagonal[l->diag[node] + size * i + c];
    if (node > 0 && sim->scene->node_element[node - 1] != DMB_NONE)
        for (uint32_t i = 0; i < l->size[node - 1]; i++)
            out[l->row[node - 1] + i] = sim->stiffness_upper[l->link[node - 1] + size * i + c];
    if (sim->scene->node_element[node] != DMB_NONE)
        for (uint32_t i = 0; i < l->size[node + 1]; i++)
            out[l->row[node + 1] + i] = sim->stiffness_lower[l->link[node] + size * i + c];
}

/* Tangent with the factors that single out one kind of column. Inertia and velocity come on top of the pose part, which
 * `without` holds. */
static void tangent_columns(dmb_sim *sim, int32_t dynamic, int kind, double out[ROWS_MAX][ROWS_MAX])
{
    const dmb_scene *scene = sim->scene;
    for (int pass = 0; pass < (kind == 0 ? 1 : 2); pass++) {
        dmb_evaluation e = evaluation_of(sim, dynamic);
        uint32_t column = 0;
        e.tangent = 1;
        e.velocity_factor = kind == 1 && pass == 0 ? 1.0 : 0.0;
        e.mass_factor = kind == 2 && pass == 0 ? 1.0 : 0.0;
        e.inertia_only = kind > 0;
        move_row(sim, 1, 0, 0, 0.0);
        assert_int_equal(dmb_system_evaluate(&e), DMB_OK);
        for (uint32_t i = 0; i < scene->node_count; i++)
            for (uint32_t c = 0; c < scene->layout.size[i]; c++, column++) {
                double got[ROWS_MAX];
                column_of_blocks(sim, i, c, got);
                for (uint32_t r = 0; r < scene->row_count; r++)
                    out[column][r] = pass == 0 ? got[r] : out[column][r] - got[r];
            }
    }
}

static double worst_column(rig *s, int32_t dynamic, int kind)
{
    static double tangent[ROWS_MAX][ROWS_MAX];
    dmb_sim *sim = s->sim;
    const dmb_scene *scene = sim->scene;
    double worst = 0.0;
    uint32_t column = 0;
    assert_true(scene->row_count <= ROWS_MAX);
    tangent_columns(sim, dynamic, kind, tangent);
    for (uint32_t i = 0; i < scene->node_count; i++)
        for (uint32_t c = 0; c < scene->layout.size[i]; c++, column++) {
            double want[ROWS_MAX];
            column_by_differences(sim, dynamic, kind, i, c, want);
            const double error = largest_difference(scene->row_count, tangent[column], want) /
                                 fmax(1.0, largest(scene->row_count, want));
            worst = fmax(worst, error);
        }
    return worst;
}

/* Differences do not cross the kink where a ring opens; with rings inside elements not all of them can be pushed in. */
static int near_opening(const rig *s, double distance)
{
    const dmb_sim *sim = s->sim;
    dmb_evaluation e = evaluation_of(s->sim, 0);
    dmb_configuration_copy(s->sim, &s->sim->now, &s->sim->trial);
    assert_int_equal(dmb_system_evaluate(&e), DMB_OK);
    for (uint32_t i = 0; sim->scene->inside_count > 0 && i < sim->scene->site_count; i++)
        if (fabs(sim->trial.site_penetration[i]) < distance) return 1;
    return 0;
}

/* By pose, velocity and acceleration, and by pose in statics; in three states. */
static void check_tangent(const char *name, const full_rig_choice *choice)
{
    static const char *const kinds[4] = {"pose", "velocity", "acceleration", "pose in statics"};
    for (int kind = 0; kind < 4; kind++) {
        char what[96];
        double worst = 0.0;
        for (uint64_t seed = 1, states = 0; states < 3; seed++) {
            rig s;
            full_rig_open(&s, choice);
            stir(&s, seed);
            if (near_opening(&s, 2e-3)) {
                rig_close(&s);
                continue;
            }
            states++;
            worst = fmax(worst, worst_column(&s, kind < 3, kind % 3));
            rig_close(&s);
        }
        (void)snprintf(what, sizeof what, "%s: residual by %s", name, kinds[kind]);
        check_below(what, worst, 1e-9);
    }
}

static void stribeck_and_rate_law(void **state)
{
    (void)state;
    const full_rig_choice choice = {DMB_FRICTION_STRIBECK, DMB_NORMAL_HUNT_CROSSLEY, DMB_ROCK_RATE, 0, 1, 0, 0};
    check_tangent("Stribeck, rate law", &choice);
}

static void bristle_and_regenerative_law(void **state)
{
    (void)state;
    const full_rig_choice choice = {DMB_FRICTION_BRISTLE, DMB_NORMAL_EXACT, DMB_ROCK_REGENERATIVE, 0, 1, 0, 0};
    check_tangent("bristles, regenerative law", &choice);
}

static void ambrosio_with_impact_law(void **state)
{
    (void)state;
    const full_rig_choice choice = {DMB_FRICTION_AMBROSIO, DMB_NORMAL_IMPACT, DMB_ROCK_NONE, 0, 0, 0, 0};
    check_tangent("Ambrosio, IMPACT", &choice);
}

static void rings_in_a_curved_hole(void **state)
{
    (void)state;
    const full_rig_choice choice = {DMB_FRICTION_COULOMB, DMB_NORMAL_KELVIN_VOIGT, DMB_ROCK_NONE, 1, 0, 1, 0};
    check_tangent("Coulomb, Kelvin-Voigt, curved hole", &choice);
}

/* Diameter, stiffness, restitution, damping and friction of the wall change along the hole. */
static void rings_in_sections(void **state)
{
    (void)state;
    const full_rig_choice choice[3] = {{DMB_FRICTION_STRIBECK, DMB_NORMAL_HUNT_CROSSLEY, DMB_ROCK_NONE, 0, 0, 1, 1},
                                       {DMB_FRICTION_AMBROSIO, DMB_NORMAL_EXACT, DMB_ROCK_NONE, 1, 0, 1, 1},
                                       {DMB_FRICTION_COULOMB, DMB_NORMAL_KELVIN_VOIGT, DMB_ROCK_NONE, 1, 0, 1, 1}};
    check_tangent("sections, Stribeck, Hunt-Crossley", choice);
    check_tangent("sections, Ambrosio, exact, curved", choice + 1);
    check_tangent("sections, Coulomb, Kelvin-Voigt, curved", choice + 2);
}

/* At integration points inside the elements too. */
static void rings_along_the_elements(void **state)
{
    (void)state;
    const full_rig_choice choice[4] = {{DMB_FRICTION_STRIBECK, DMB_NORMAL_HUNT_CROSSLEY, DMB_ROCK_RATE, 0, 1, 0, 2},
                                       {DMB_FRICTION_BRISTLE, DMB_NORMAL_EXACT, DMB_ROCK_NONE, 0, 0, 1, 2},
                                       {DMB_FRICTION_COULOMB, DMB_NORMAL_KELVIN_VOIGT, DMB_ROCK_NONE, 1, 0, 1, 2},
                                       {DMB_FRICTION_AMBROSIO, DMB_NORMAL_EXACT, DMB_ROCK_NONE, 1, 0, 1, 3}};
    check_tangent("along the elements, Stribeck, Hunt-Crossley", choice);
    check_tangent("along the elements, bristles, exact", choice + 1);
    check_tangent("along the elements, Coulomb, Kelvin-Voigt, curved", choice + 2);
    check_tangent("along the elements, sections, Ambrosio, exact, curved", choice + 3);
}

/* Its pull goes along the hole, also where that bends. */
static void mud_that_flows(void **state)
{
    (void)state;
    const full_rig_choice choice[3] = {{DMB_FRICTION_STRIBECK, DMB_NORMAL_HUNT_CROSSLEY, DMB_ROCK_RATE, 0, 1, 0, 4},
                                       {DMB_FRICTION_COULOMB, DMB_NORMAL_KELVIN_VOIGT, DMB_ROCK_NONE, 1, 0, 1, 4},
                                       {DMB_FRICTION_AMBROSIO, DMB_NORMAL_EXACT, DMB_ROCK_NONE, 1, 0, 1, 5}};
    check_tangent("flow, straight", choice);
    check_tangent("flow, curved", choice + 1);
    check_tangent("flow, sections, curved", choice + 2);
}

/* Around flexible and rigid pipes, rig head, bit and a body of its own. */
static void mud_that_goes_along(void **state)
{
    (void)state;
    const full_rig_choice choice[2] = {{DMB_FRICTION_STRIBECK, DMB_NORMAL_HUNT_CROSSLEY, DMB_ROCK_RATE, 0, 1, 0, 8},
                                       {DMB_FRICTION_COULOMB, DMB_NORMAL_KELVIN_VOIGT, DMB_ROCK_NONE, 1, 0, 1, 8}};
    check_tangent("added mass, straight", choice);
    check_tangent("added mass, curved", choice + 1);
}

/* Axial-torsional nodes that rotate but do not slide. */
static void hold_depths(dmb_sim *sim)
{
    for (uint32_t i = 0; i < sim->scene->node_count; i++) {
        const uint32_t row = sim->scene->layout.row[i];
        if (sim->scene->layout.size[i] == DMB_NODE_AXIAL_TORSIONAL)
            sim->now.velocity[row] = sim->now.acceleration[row] = 0.0;
    }
}

/* The weight, loads and bit load turn with the hole's axis, tension bends with it; 0.1 rad/m here. At a seam between
 * flexible and axial-torsional pipes the change of the node's velocity by its turn while it slides is left out of the
 * tangent: no relative equilibrium slides along a bend. */
static void check_curved(const full_rig_choice *choice, uint64_t seed)
{
    rig s;
    full_rig_open(&s, choice);
    stir(&s, seed);
    tell("all parts in a curved hole: residual by pose, sliding", worst_column(&s, 1, 0));
    check_below("all parts in a curved hole: residual by velocity", worst_column(&s, 1, 1), 1e-9);
    check_below("all parts in a curved hole: residual by acceleration", worst_column(&s, 1, 2), 1e-9);
    check_below("all parts in a curved hole: residual by pose in statics", worst_column(&s, 0, 0), 1e-9);
    hold_depths(s.sim);
    check_below("all parts in a curved hole: residual by pose", worst_column(&s, 1, 0), 1e-9);
    rig_close(&s);
}

/* Searches for equilibria take the symmetric part of the turn with the depth: the difference is skew. */
static void symmetric_part_in_a_curved_hole(void **state)
{
    static double tangent[2][ROWS_MAX][ROWS_MAX];
    (void)state;
    const full_rig_choice choice = {DMB_FRICTION_STRIBECK, DMB_NORMAL_EXACT, DMB_ROCK_NONE, 1, 0, 0, 0};
    rig s;
    double skew = 0.0, symmetric = 0.0;
    full_rig_open(&s, &choice);
    stir(&s, 2);
    const uint32_t rows = s.sim->scene->row_count;
    for (int halves = 0; halves < 2; halves++) {
        uint32_t column = 0;
        dmb_evaluation e = evaluation_of(s.sim, 0);
        e.tangent = 1;
        e.turn_halves = halves;
        move_row(s.sim, 1, 0, 0, 0.0);
        assert_int_equal(dmb_system_evaluate(&e), DMB_OK);
        for (uint32_t i = 0; i < s.sim->scene->node_count; i++)
            for (uint32_t c = 0; c < s.sim->scene->layout.size[i]; c++, column++)
                column_of_blocks(s.sim, i, c, tangent[halves][column]);
    }
    for (uint32_t i = 0; i < rows; i++)
        for (uint32_t j = 0; j < rows; j++) {
            const double here = tangent[1][i][j] - tangent[0][i][j], other = tangent[1][j][i] - tangent[0][j][i];
            skew = fmax(skew, fabs(here - other));
            symmetric = fmax(symmetric, fabs(here + other));
        }
    tell("skew part that statics omit: largest entry", skew);
    assert_true(skew > 0.1);
    check_below("symmetric part of the difference", symmetric / skew, 1e-6);
    rig_close(&s);
}

static void everything_in_a_curved_hole(void **state)
{
    (void)state;
    const full_rig_choice choice[3] = {
        {DMB_FRICTION_STRIBECK, DMB_NORMAL_HUNT_CROSSLEY, DMB_ROCK_RATE, 1, 0, 0, 0},
        {DMB_FRICTION_COULOMB, DMB_NORMAL_KELVIN_VOIGT, DMB_ROCK_REGENERATIVE, 1, 0, 0, 0},
        {DMB_FRICTION_STRIBECK, DMB_NORMAL_EXACT, DMB_ROCK_NONE, 1, 0, 0, 4}};
    for (int i = 0; i < 3; i++)
        for (uint64_t seed = 2; seed < 4; seed++) check_curved(choice + i, seed);
}

/* ---- Energies ---------------------------------------------------------------------------------------------------- */

static double potential(dmb_sim *sim)
{
    dmb_evaluation e = evaluation_of(sim, 0);
    assert_int_equal(dmb_system_evaluate(&e), DMB_OK); /* writes the penetrations of the trial */
    return dmb_strain_energy(sim->scene, &sim->trial) + dmb_gravity_energy(sim->scene, &sim->trial) +
           dmb_contact_energy(sim->scene, &sim->trial);
}

/* Without loads, bit load and drives the static residual is the gradient of strain, gravity and contact energy. */
static void check_gradient(const char *what, int32_t curved, int32_t sections)
{
    const full_rig_choice choice = {
        DMB_FRICTION_STRIBECK, DMB_NORMAL_HUNT_CROSSLEY, DMB_ROCK_RATE, curved, 1, 0, sections};
    rig s;
    double worst = 0.0, residual[ROWS_MAX];
    full_rig_open(&s, &choice);
    for (uint64_t seed = 43; seed == 43 || near_opening(&s, 8e-3); seed++) {
        rig_close(&s);
        full_rig_open(&s, &choice);
        stir(&s, seed);
    }
    dmb_sim *sim = s.sim;
    memset(sim->now.load_factor, 0, sim->scene->load_count * sizeof(double));
    memset(sim->now.bit_load, 0, sim->scene->bit_count * sizeof(double));
    for (uint32_t i = 0; i < sim->scene->drive_count; i++) sim->now.drives[i].target = 0.0;
    dmb_configuration_copy(sim, &sim->now, &sim->trial);
    dmb_evaluation e = evaluation_of(sim, 0);
    assert_int_equal(dmb_system_evaluate(&e), DMB_OK);
    memcpy(residual, sim->residual, sim->scene->row_count * sizeof(double));
    for (uint32_t i = 0; i < sim->scene->node_count; i++)
        for (uint32_t c = 0; c < sim->scene->layout.size[i]; c++) {
            double E[6];
            for (int p = 0; p < 6; p++) {
                move_row(sim, 0, i, c, 1e-3 * difference6_place[p]);
                E[p] = potential(sim);
            }
            worst = fmax(worst, fabs(difference6(E, 1e-3) - residual[sim->scene->layout.row[i] + c]));
        }
    check_below(what, worst / largest(sim->scene->row_count, residual), 1e-10);
    rig_close(&s);
}

static void static_residual_is_the_gradient_of_the_energies(void **state)
{
    (void)state;
    check_gradient("static residual against the gradient of the energies", 0, 0);
    check_gradient("the same in a curved hole", 1, 0);
    check_gradient("the same in a hole of sections", 0, 1);
    check_gradient("the same in a curved hole of sections", 1, 1);
    check_gradient("the same with contact along the elements", 0, 2);
    check_gradient("the same with contact along the elements in a curved hole of sections", 1, 3);
}

/* ---- Power ------------------------------------------------------------------------------------------------------- */

/* v . residual = 0 at a converged state: the powers of all classes of force cancel, inertia included. */
static void check_power(const full_rig_choice *choice)
{
    rig s;
    double sum = 0.0, most = 0.0;
    full_rig_open(&s, choice);
    s.sim->options.newton_tolerance = 1e-8;
    for (int i = 0; i < 20; i++) must(&s, dmb_sim_step(s.sim, 0.005, NULL));
    for (int k = 0; k < DMB_POWER_COUNT; k++) {
        sum += s.sim->clock->power[k];
        most = fmax(most, fabs(s.sim->clock->power[k]));
    }
    check_below("sum of all powers over the largest", sum / most, 1e-7);
    rig_close(&s);
}

static void powers_cancel_at_an_accepted_state(void **state)
{
    (void)state;
    const full_rig_choice choice[7] = {{DMB_FRICTION_STRIBECK, DMB_NORMAL_HUNT_CROSSLEY, DMB_ROCK_RATE, 0, 1, 0, 0},
                                       {DMB_FRICTION_STRIBECK, DMB_NORMAL_HUNT_CROSSLEY, DMB_ROCK_RATE, 1, 1, 0, 4},
                                       {DMB_FRICTION_BRISTLE, DMB_NORMAL_EXACT, DMB_ROCK_RATE, 1, 1, 0, 2},
                                       {DMB_FRICTION_BRISTLE, DMB_NORMAL_EXACT, DMB_ROCK_REGENERATIVE, 0, 1, 0, 0},
                                       {DMB_FRICTION_COULOMB, DMB_NORMAL_KELVIN_VOIGT, DMB_ROCK_RATE, 1, 1, 0, 0},
                                       {DMB_FRICTION_STRIBECK, DMB_NORMAL_EXACT, DMB_ROCK_RATE, 1, 1, 0, 1},
                                       {DMB_FRICTION_STRIBECK, DMB_NORMAL_EXACT, DMB_ROCK_RATE, 1, 1, 0, 8}};
    for (int i = 0; i < 7; i++) check_power(choice + i);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stribeck_and_rate_law),
        cmocka_unit_test(bristle_and_regenerative_law),
        cmocka_unit_test(ambrosio_with_impact_law),
        cmocka_unit_test(rings_in_a_curved_hole),
        cmocka_unit_test(rings_in_sections),
        cmocka_unit_test(rings_along_the_elements),
        cmocka_unit_test(mud_that_flows),
        cmocka_unit_test(mud_that_goes_along),
        cmocka_unit_test(everything_in_a_curved_hole),
        cmocka_unit_test(symmetric_part_in_a_curved_hole),
        cmocka_unit_test(static_residual_is_the_gradient_of_the_energies),
        cmocka_unit_test(powers_cancel_at_an_accepted_state),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
