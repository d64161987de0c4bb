/* How far a state is from an equilibrium. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "analysis/linearise_parts.h"
#include "math/mat6.h"
#include "math/vec3.h"
#include "system/node.h"
#include "system/solve.h"

/* Units of rounding of a pose that count. */
#define DMB_LINEAR_ROUNDING (16.0 * DBL_EPSILON)

dmb_evaluation dmb_linear_evaluation(dmb_sim *work)
{
    dmb_evaluation evaluation;
    memset(&evaluation, 0, sizeof evaluation);
    evaluation.sim = work;
    evaluation.time = work->clock->time;
    evaluation.pseudo_factor = 1.0;
    evaluation.load_factor = 1.0;
    evaluation.dynamic = 1;
    return evaluation;
}

/* Largest force on a solved row; moments over the length of the chain. */
static void find_largest(dmb_linear *linear)
{
    const dmb_scene *scene = &linear->scene;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        const uint32_t size = scene->layout.size[i], row = scene->layout.row[i];
        const double arm = 1.0 / scene->chains[scene->node_chain[i]].length;
        for (uint32_t c = 0; c < size; c++) {
            const double force = fabs(linear->unbalanced[row + c]) * (2 * c < size ? 1.0 : arm);
            if (!scene->solved_row[row + c] || !(force > linear->largest_force)) continue;
            linear->largest_force = force;
            linear->largest_node = i;
        }
    }
}

/* Accelerations of the trial in a relative equilibrium: none where body-frame velocities stay as they are; -ad(w) g
 * where strings slide and turn with their axes at rest, V = g + w, w the spin about the node's x axis
 * (analysis/steady.h). */
static void steady_accelerations(dmb_linear *linear, int sliding)
{
    const dmb_scene *scene = &linear->scene;
    dmb_configuration *trial = &linear->work->trial;
    memset(trial->acceleration, 0, linear->rows * sizeof(double));
    for (uint32_t i = 0; sliding && i < scene->node_count; i++) {
        const uint32_t row = scene->layout.row[i];
        double w[6] = {0.0}, g[6], *a = trial->acceleration + row;
        if (scene->layout.size[i] != DMB_NODE_FULL) continue;
        dmb_vec6_copy(trial->velocity + row, g);
        w[3] = g[3];
        g[3] = 0.0;
        dmb_ad_apply(w, g, a);
        for (int k = 0; k < 6; k++) a[k] = -a[k];
    }
}

/* What forces leave over with those accelerations is out of balance. */
static int32_t balance_of(dmb_linear *linear, int sliding, dmb_residual_norm *norm)
{
    dmb_sim *work = linear->work;
    dmb_evaluation evaluation = dmb_linear_evaluation(work);
    steady_accelerations(linear, sliding);
    const int32_t status = dmb_system_evaluate(&evaluation);
    memcpy(work->trial.acceleration, work->now.acceleration, linear->rows * sizeof(double));
    if (status >= 0) *norm = dmb_residual_norm_of(&evaluation, DMB_LINEAR_BALANCED);
    return status;
}

/* The better of both. */
int32_t dmb_linear_take_balance(dmb_linear *linear)
{
    dmb_residual_norm rigid = {0}, sliding = {0}, best;
    int32_t status = balance_of(linear, 1, &sliding);
    if (status >= 0) status = balance_of(linear, 0, &rigid);
    if (status < 0) return status;
    best = rigid;
    linear->slides = !rigid.converged && sliding.relative < rigid.relative;
    if (linear->slides) {
        status = balance_of(linear, 1, &sliding);
        best = sliding;
    }
    if (status < 0) return status;
    linear->unbalance = best.relative;
    linear->balanced = best.converged != 0;
    memcpy(linear->unbalanced, linear->work->correction, linear->rows * sizeof(double));
    find_largest(linear);
    return DMB_OK;
}

/* The accelerations of an equilibrium are those of its kind. The ones in the sim are what the residual makes of them:
 * rounding over the masses, and through M a^ and the multipliers a stiffness where there is none. */
void dmb_linear_take_steady_accelerations(dmb_linear *linear)
{
    if (!linear->balanced) return;
    steady_accelerations(linear, linear->slides);
    memcpy(linear->work->now.acceleration, linear->work->trial.acceleration, linear->rows * sizeof(double));
}

/* Poses are rounded where they are: eps |x| of a displacement, and through the stiffness between them sqrt(K_ii K_tt)
 * eps |x| of a force or moment, K_tt the largest of the node's translations; angles to eps. A string that nothing loads
 * leaves no more. */
void dmb_linear_judge_rounding(dmb_linear *linear)
{
    const dmb_scene *scene = &linear->scene;
    dmb_linear_take_stiffness_size(linear);
    for (uint32_t i = 0; i < scene->node_count; i++) {
        const uint32_t size = scene->layout.size[i], row = scene->layout.row[i];
        double rotation[9], place[3], most = 0.0;
        dmb_node_pose(scene, &linear->work->now, i, rotation, place);
        dmb_vec3_add(place, scene->reference_position + 3 * (size_t)i, place);
        for (uint32_t c = 0; 2 * c < size; c++) most = fmax(most, linear->stiffness_size[row + c]);
        for (uint32_t c = 0; c < size; c++) {
            const double own = linear->stiffness_size[row + c], angle = 2 * c < size ? 0.0 : own;
            const double rounding = DMB_LINEAR_ROUNDING * (dmb_vec3_norm(place) * sqrt(own * most) + angle);
            if (scene->solved_row[row + c] && !(fabs(linear->unbalanced[row + c]) <= rounding)) return;
        }
    }
    linear->balanced = 1;
}
