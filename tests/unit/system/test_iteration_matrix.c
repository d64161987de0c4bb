/* The iteration matrix of a step against differences of the residual by the increments h Dq, which move pose, velocity
 * and acceleration together; and the extrapolated stress of the elements against their true one. */
#include "moved_rig.h"
#include "stirred_rig.h"

#include "element/beam.h"
#include "system/assemble/assemble.h"
#include "system/assemble/energy.h"
#include "system/solve/solve.h"

static double worst_entry(dmb_sim *sim, const double *base)
{
    static double want[ROWS_MAX][ROWS_MAX];
    const uint32_t rows = sim->scene->row_count;
    double worst = 0.0;
    matrix_by_differences(sim, 1, base, want);
    make_matrix(sim, 1, base);
    const double size = largest((size_t)ROWS_MAX * ROWS_MAX, want[0]);
    for (uint32_t i = 0; i < rows; i++)
        for (uint32_t j = 0; j < rows; j++) {
            const int held = !sim->scene->solved_row[i] || !sim->scene->solved_row[j];
            const double right = held ? (i == j ? 1.0 : 0.0) : want[i][j];
            worst = fmax(worst, fabs(block_entry(sim, i, j) - right));
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
    full_rig_choice choice = {DMB_FRICTION_STRIBECK, DMB_NORMAL_HUNT_CROSSLEY, DMB_ROCK_NONE, 0, 1, 0, 0};
    double base[ROWS_MAX], worst = 0.0;
    for (uint64_t seed = 1; seed <= 6; seed++) {
        rig s;
        choice.sections = seed > 3 ? 8 : 0; /* mud with inertia: also around the free body */
        full_rig_open(&s, &choice);
        stir(&s, seed);
        assert_true(s.sim->scene->row_count <= ROWS_MAX);
        draw_increments(s.sim, seed + 100, base);
        worst = fmax(worst, worst_entry(s.sim, base));
        rig_close(&s);
    }
    check_below("iteration matrix against differences", worst, 1e-9);
}

/* After a correction of size z the extrapolated stress is that of the moved element up to z^2 (eq:beam.extrapolation,
 * eq:static.extrapolated). */
static double extrapolation_error(double size)
{
    const full_rig_choice choice = {DMB_FRICTION_NONE, DMB_NORMAL_HUNT_CROSSLEY, DMB_ROCK_NONE, 0, 1, 1, 0};
    rig s;
    double base[ROWS_MAX], worst = 0.0;
    full_rig_open(&s, &choice);
    stir(&s, 4);
    dmb_sim *sim = s.sim;
    memset(base, 0, sizeof base);
    dmb_evaluation e;
    move_to(sim, 1, base, 0, 0.0);
    evaluate(sim, 1, 1, &e);
    draw_increments(sim, 9, base);
    for (uint32_t i = 0; i < sim->scene->row_count; i++) base[i] *= size;
    dmb_system_extrapolate_stress(sim, base);
    move_to(sim, 1, base, 0, 0.0);
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

/* Accelerations by the mass matrix as a step factors it, by inverses from both ends, and by LU factors. */
static void mass_of_a_step_is_that_of_the_start(void **state)
{
    (void)state;
    static double force[ROWS_MAX], by_lu[ROWS_MAX], in_step[ROWS_MAX];
    const full_rig_choice choice = {DMB_FRICTION_STRIBECK, DMB_NORMAL_HUNT_CROSSLEY, DMB_ROCK_NONE, 0, 1, 0, 0};
    double base[ROWS_MAX], worst = 0.0;
    for (uint64_t seed = 1; seed <= 6; seed++) {
        rig s;
        dmb_evaluation e;
        full_rig_open(&s, &choice);
        stir(&s, seed);
        dmb_sim *sim = s.sim;
        const uint32_t rows = sim->scene->row_count;
        draw_increments(sim, seed + 100, base);
        move_to(sim, 1, base, 0, 0.0);
        evaluate(sim, 1, 1, &e);
        e.mass_factor = 1.0;
        e.velocity_factor = 0.0;
        draw_increments(sim, seed + 200, force);
        assert_int_equal(dmb_factor_mass(&e), DMB_OK);
        assert_int_equal(*sim->factors, DMB_FACTORS_LU);
        dmb_solve_for(sim, force, by_lu);
        assert_int_equal(dmb_factor_mass_in_step(&e), DMB_OK);
        assert_int_equal(*sim->factors, DMB_FACTORS_FRESH);
        dmb_solve_for(sim, force, in_step);
        assert_true(largest(rows, by_lu) > 1e-3);
        worst = fmax(worst, largest_difference(rows, by_lu, in_step) / largest(rows, by_lu));
        rig_close(&s);
    }
    check_below("accelerations by two factorisations of the mass", worst, 1e-12);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(matrix_is_the_derivative_by_the_increments),
        cmocka_unit_test(extrapolated_stress_is_right_to_first_order),
        cmocka_unit_test(mass_of_a_step_is_that_of_the_start),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
