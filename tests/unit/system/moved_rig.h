/* Trials beside a state, for tests of the iteration matrix: increments that move poses, velocities and accelerations
 * together, differences of the residual by them, and entries of the matrix by row and column. */
#ifndef DMB_TESTS_MOVED_RIG_H
#define DMB_TESTS_MOVED_RIG_H

#include <string.h>

#include "check.h"

#include "math/se3.h"
#include "sim/layout.h"
#include "sim/sim.h"
#include "system/assemble/assemble.h"
#include "system/assemble/evaluation.h"

enum { ROWS_MAX = 120 };
#define TO_VELOCITY 2.0     /* [1/s] gamma/(h beta); of a size that lets every term be seen */
#define TO_ACCELERATION 3.0 /* [1/s2] (1-am)/(h^2 beta (1-af)) */

/* In a step, free rigid bodies move at their centres of mass. */
static inline void move_rigids(dmb_sim *sim, uint32_t row, double z)
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

/* Moves `trial` by the increments `base` from `now`, plus z in one row; `dynamic` as in a step, otherwise in statics.
 */
static inline void move_to(dmb_sim *sim, int32_t dynamic, const double *base, uint32_t row, double z)
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
        if (at->layout.size[i] == DMB_NODE_SIX_DOF) {
            dmb_se3_advance(sim->trial.quaternion + 4 * i, sim->trial.displacement + 3 * i, h);
        } else {
            sim->trial.displacement[3 * i] += h[0];
            sim->trial.turn[i] += h[1];
        }
    }
    if (dynamic) move_rigids(sim, row, z);
}

static inline void evaluate(dmb_sim *sim, int32_t dynamic, int32_t tangent, dmb_evaluation *e)
{
    memset(e, 0, sizeof *e);
    e->sim = sim;
    e->load_factor = 1.0;
    e->dynamic = dynamic;
    e->tangent = tangent;
    e->step = dynamic ? 0.02 : 0.0;
    e->velocity_factor = dynamic ? TO_VELOCITY : 0.0;
    e->mass_factor = dynamic ? TO_ACCELERATION : 0.0;
    assert_int_equal(dmb_system_evaluate(e), DMB_OK);
}

/* Derivative of the residual by the increments. */
static inline void matrix_by_differences(dmb_sim *sim, int32_t dynamic, const double *base, double out[][ROWS_MAX])
{
    const uint32_t rows = sim->scene->row_count;
    const double step = 2e-4;
    dmb_evaluation e;
    for (uint32_t column = 0; column < rows; column++) {
        double f[6][ROWS_MAX];
        for (int p = 0; p < 6; p++) {
            move_to(sim, dynamic, base, column, step * difference6_place[p]);
            evaluate(sim, dynamic, 0, &e);
            memcpy(f[p], sim->residual, rows * sizeof(double));
        }
        for (uint32_t i = 0; i < rows; i++) {
            const double v[6] = {f[0][i], f[1][i], f[2][i], f[3][i], f[4][i], f[5][i]};
            out[i][column] = difference6(v, step);
        }
    }
}

/* The iteration matrix of the library, which stays in the blocks of the sim. */
static inline void make_matrix(dmb_sim *sim, int32_t dynamic, const double *base)
{
    dmb_evaluation e;
    move_to(sim, dynamic, base, 0, 0.0);
    evaluate(sim, dynamic, 1, &e);
    dmb_system_iteration_matrix(&e);
}

static inline uint32_t node_of_row(const dmb_sim *sim, uint32_t row)
{
    uint32_t node = 0;
    while (sim->scene->layout.row[node + 1] <= row) node++;
    return node;
}

/* Its entry (i, j); 0 outside of the blocks. */
static inline double block_entry(const dmb_sim *sim, uint32_t i, uint32_t j)
{
    const dmb_block_layout *l = &sim->scene->layout;
    const uint32_t *between = sim->scene->node_element, a = node_of_row(sim, i), b = node_of_row(sim, j);
    const uint32_t r = i - l->row[a], c = j - l->row[b];
    if (a == b) return sim->stiffness_diagonal[l->diag[a] + l->size[a] * r + c];
    if (a + 1 == b && between[a] != DMB_NONE) return sim->stiffness_upper[l->link[a] + l->size[b] * r + c];
    if (b + 1 == a && between[b] != DMB_NONE) return sim->stiffness_lower[l->link[b] + l->size[b] * r + c];
    return 0.0;
}

#endif
