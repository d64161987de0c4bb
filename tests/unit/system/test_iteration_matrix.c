/* The iteration matrix of a step against differences of the residual by the increments h Dq, which move pose, velocity
 * and acceleration together; and the extrapolated stress of the elements against their true one. */
#include "sim/layout.h"
#include "stirred_rig.h"

#include "element/beam.h"
#include "system/assemble/elements.h"
#include "system/assemble/energy.h"
#include "system/assemble/evaluation.h"
#include "system/assemble/free_rigid.h"

#define ROWS_MAX 80
#define TO_VELOCITY 2.0     /* [1/s] gamma/(h beta); of a size that lets every term be seen */
#define TO_ACCELERATION 3.0 /* [1/s2] (1-am)/(h^2 beta (1-af)) */

/* Free rigid bodies move at their centres of mass. */
static void move_rigids(dmb_sim *sim, uint32_t row, double z)
{
    for (uint32_t i = 0; i < sim->scene->free_rigid_count; i++) {
        const uint32_t first = sim->scene->layout.row[sim->scene->free_rigids[i].node];
        double *motion = dmb_free_rigid_motion(sim, i);
        dmb_free_rigid_start(sim, i, motion);
        if (row < first || row >= first + 6) continue;
        motion[row - first] += TO_VELOCITY * z;
        motion[6 + row - first] += TO_ACCELERATION * z;
    }
    dmb_free_rigids_place(sim);
}

/* Trial of the increments `base` plus z in one row. */
static void move_to(dmb_sim *sim, const double *base, uint32_t row, double z)
{
    const dmb_scene *at = sim->scene;
    dmb_configuration_copy(sim, &sim->now, &sim->trial);
    for (uint32_t i = 0; i < at->row_count; i++) {
        const double change = i == row ? z : 0.0;
        sim->increment[i] = base[i] + change;
        sim->trial.velocity[i] += TO_VELOCITY * change;
        sim->trial.acceleration[i] += TO_ACCELERATION * change;
    }
    for (uint32_t i = 0; i < at->node_count; i++) {
        const double *h = sim->increment + at->layout.row[i];
        if (at->layout.size[i] == DMB_NODE_FULL) {
            dmb_se3_advance(sim->trial.quaternion + 4 * i, sim->trial.displacement + 3 * i, h);
        } else {
            sim->trial.displacement[3 * i] += h[0];
            sim->trial.turn[i] += h[1];
        }
    }
    move_rigids(sim, row, z);
}

static void evaluate(dmb_sim *sim, int32_t tangent, dmb_evaluation *e)
{
    memset(e, 0, sizeof *e);
    e->sim = sim;
    e->load_factor = 1.0;
    e->dynamic = 1;
    e->tangent = tangent;
    e->step = 0.02;
    e->velocity_factor = TO_VELOCITY;
    e->mass_factor = TO_ACCELERATION;
    assert_int_equal(dmb_system_evaluate(e), DMB_OK);
}

/* Entry (row, column) of the blocks; 0 outside of them. */
static double entry(const dmb_sim *sim, uint32_t a, uint32_t r, uint32_t b, uint32_t c)
{
    const dmb_block_layout *l = &sim->scene->layout;
    const uint32_t *between = sim->scene->node_element;
    if (a == b) return sim->stiffness_diagonal[l->diag[a] + l->size[a] * r + c];
    if (a + 1 == b && between[a] != DMB_NONE) return sim->stiffness_upper[l->link[a] + l->size[b] * r + c];
    if (b + 1 == a && between[b] != DMB_NONE) return sim->stiffness_lower[l->link[b] + l->size[b] * r + c];
    return 0.0;
}

static void node_of_row(const dmb_sim *sim, uint32_t row, uint32_t *node, uint32_t *component)
{
    const dmb_block_layout *l = &sim->scene->layout;
    *node = 0;
    while (l->row[*node + 1] <= row) ++*node;
    *component = row - l->row[*node];
}

static double worst_entry(dmb_sim *sim, const double *base)
{
    static double want[ROWS_MAX][ROWS_MAX];
    const uint32_t rows = sim->scene->row_count;
    const double step = 2e-4;
    dmb_evaluation e;
    double worst = 0.0;
    for (uint32_t column = 0; column < rows; column++) {
        double f[6][ROWS_MAX];
        for (int p = 0; p < 6; p++) {
            move_to(sim, base, column, step * difference6_place[p]);
            evaluate(sim, 0, &e);
            memcpy(f[p], sim->residual, rows * sizeof(double));
        }
        for (uint32_t i = 0; i < rows; i++) {
            const double v[6] = {f[0][i], f[1][i], f[2][i], f[3][i], f[4][i], f[5][i]};
            want[i][column] = difference6(v, step);
        }
    }
    move_to(sim, base, 0, 0.0);
    evaluate(sim, 1, &e);
    dmb_system_iteration_matrix(&e);
    const double size = largest((size_t)ROWS_MAX * ROWS_MAX, want[0]);
    for (uint32_t i = 0; i < rows; i++)
        for (uint32_t j = 0; j < rows; j++) {
            uint32_t a, r, b, c;
            node_of_row(sim, i, &a, &r);
            node_of_row(sim, j, &b, &c);
            const double got = entry(sim, a, r, b, c);
            const int held = !sim->scene->solved_row[i] || !sim->scene->solved_row[j];
            const double right = held ? (i == j ? 1.0 : 0.0) : want[i][j];
            worst = fmax(worst, fabs(got - right));
        }
    return worst / size;
}

/* Increments of a large step, up to half a radian. */
static void draw_increments(const dmb_sim *sim, uint64_t seed, double *base)
{
    for (uint32_t i = 0; i < sim->scene->row_count; i++) base[i] = draw_between(&seed, -0.15, 0.15);
}

static void matrix_is_the_derivative_by_the_increments(void **state)
{
    (void)state;
    const full_rig_choice choice = {DMB_FRICTION_STRIBECK, DMB_NORMAL_HUNT_CROSSLEY, DMB_ROCK_NONE, 0, 1, 0, 0};
    double base[ROWS_MAX], worst = 0.0;
    for (uint64_t seed = 1; seed <= 3; seed++) {
        rig s;
        full_rig_open(&s, &choice);
        stir(&s, seed);
        assert_true(s.sim->scene->row_count <= ROWS_MAX);
        draw_increments(s.sim, seed + 100, base);
        worst = fmax(worst, worst_entry(s.sim, base));
        rig_close(&s);
    }
    check_below("iteration matrix against differences", worst, 1e-9);
}

/* After a correction of size z the extrapolated stress is that of the moved element up to z^2. */
static double extrapolation_error(double size)
{
    const full_rig_choice choice = {DMB_FRICTION_NONE, DMB_NORMAL_HUNT_CROSSLEY, DMB_ROCK_NONE, 0, 1, 1, 0};
    rig s;
    double base[ROWS_MAX], worst = 0.0;
    dmb_evaluation e;
    full_rig_open(&s, &choice);
    stir(&s, 4);
    dmb_sim *sim = s.sim;
    memset(base, 0, sizeof base);
    move_to(sim, base, 0, 0.0);
    evaluate(sim, 1, &e);
    draw_increments(sim, 9, base);
    for (uint32_t i = 0; i < sim->scene->row_count; i++) base[i] *= size;
    dmb_system_extrapolate_stress(sim, base);
    move_to(sim, base, 0, 0.0);
    for (uint32_t k = 0; k < sim->scene->element_count; k++) {
        double d[6], stress[6];
        dmb_element_strain(sim->scene, &sim->trial, k, d);
        for (int i = 0; i < 6; i++) stress[i] = sim->scene->types[sim->scene->element_type[k]].stiffness[i] * d[i];
        worst = fmax(worst, largest_difference(6, stress, sim->element_stress + 6 * k));
    }
    rig_close(&s);
    return worst;
}

static void extrapolated_stress_is_right_to_first_order(void **state)
{
    (void)state;
    const double coarse = extrapolation_error(1e-2), fine = extrapolation_error(5e-3);
    check_order("error of the extrapolated stress", coarse, fine, 2.0, 0.05);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(matrix_is_the_derivative_by_the_increments),
        cmocka_unit_test(extrapolated_stress_is_right_to_first_order),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
