/* Forces of single nodes: rigid masses, gravity, external damping. */
#include "kernel/kernels.h"
#include "math/mat6.h"
#include "system/evaluation.h"
#include "system/node.h"

/* ---- FULL nodes, by the kernels ---------------------------------------------------------------------------------- */

/* Where the kernels find and leave what belongs to `count` FULL nodes from `node` on; `lump` is the first that may be
 * on them. */
static dmb_node_force_run run_of(const dmb_evaluation *evaluation, uint32_t node, uint32_t count, uint32_t lump)
{
    const dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    const uint32_t row = scene->layout.row[node], diag = scene->layout.diag[node];
    const int32_t damped = evaluation->dynamic && scene->features & DMB_FEATURE_DAMPING;
    const dmb_node_force_run run = {
        .count = count,
        .first = node,
        .lumps = scene->lumps + lump,
        .lump_count = evaluation->dynamic ? scene->lump_count - lump : 0,
        .dynamic = evaluation->dynamic,
        .tangent = evaluation->tangent,
        .mass_factor = evaluation->mass_factor,
        .velocity_factor = evaluation->velocity_factor,
        .load_factor = evaluation->load_factor,
        .gravity = scene->features & DMB_FEATURE_GRAVITY ? scene->gravity : NULL,
        .weight_mass = scene->weight_mass + node,
        .weight_moment = scene->weight_moment + 3 * node,
        .damping = damped ? scene->node_damping + 5 * node : NULL,
        .quaternion = sim->trial.quaternion + 4 * node,
        .velocity = sim->trial.velocity + row,
        .acceleration = sim->trial.acceleration + row,
        .residual = sim->correction + row,
        .scale = sim->scale_row + row,
        .stiffness = sim->stiffness_diagonal + diag,
        .inertia = sim->inertia_diagonal + diag,
    };
    return run;
}

static void gather_full(dmb_evaluation *evaluation, uint32_t node, uint32_t count, uint32_t lump)
{
    dmb_node_force_run run = run_of(evaluation, node, count, lump);
    if (!run.gravity && !run.damping && !run.lump_count) return;
    run.inertia_power = evaluation->power[DMB_POWER_INERTIA];
    run.potential = evaluation->power[DMB_POWER_POTENTIAL];
    run.damping_power = evaluation->power[DMB_POWER_DAMPING];
    evaluation->sim->scene->kernels->node_forces(&run);
    evaluation->power[DMB_POWER_INERTIA] = run.inertia_power;
    evaluation->power[DMB_POWER_POTENTIAL] = run.potential;
    evaluation->power[DMB_POWER_DAMPING] = run.damping_power;
}

/* ---- PATH nodes: along the axis and about it -----------------------------------------------------------------------
 */

/* Only mass and the inertia about the axis are felt. */
static void gather_path_lump(dmb_evaluation *evaluation, const dmb_lump *lump)
{
    dmb_sim *sim = evaluation->sim;
    const uint32_t row = sim->scene->layout.row[lump->node];
    const double *v = sim->trial.velocity + row, *a = sim->trial.acceleration + row;
    const double f[6] = {-lump->mass * a[0], 0.0, 0.0, -lump->inertia[0] * a[1], 0.0, 0.0};
    evaluation->power[DMB_POWER_INERTIA] += v[0] * f[0] + v[1] * f[3];
    dmb_apply_wrench(sim, lump->node, f);
    if (!evaluation->tangent) return;
    dmb_inertia_of(sim, lump->node)[0] += evaluation->mass_factor * lump->mass;
    dmb_inertia_of(sim, lump->node)[3] += evaluation->mass_factor * lump->inertia[0];
}

static void gather_path_weight(dmb_evaluation *evaluation, uint32_t node)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    double f[6] = {0.0}, v[6], R[9], unused[3];
    dmb_node_pose(scene, &sim->trial, node, R, unused);
    dmb_mat3_tvec(R, scene->gravity, f);
    dmb_vec3_scale(evaluation->load_factor * scene->weight_mass[node], f, f);
    dmb_apply_wrench(sim, node, f);
    if (!evaluation->dynamic) return;
    dmb_node_vector(scene, &sim->trial, node, sim->trial.velocity, v);
    evaluation->power[DMB_POWER_POTENTIAL] += dmb_vec6_dot(f, v);
}

static void gather_path_damping(dmb_evaluation *evaluation, uint32_t node)
{
    dmb_sim *sim = evaluation->sim;
    const double *c = sim->scene->node_damping + 5 * node;
    const double *v = sim->trial.velocity + sim->scene->layout.row[node];
    const double f[6] = {-c[0] * v[0], 0.0, 0.0, -c[1] * v[1], 0.0, 0.0};
    dmb_apply_wrench(sim, node, f);
    evaluation->power[DMB_POWER_DAMPING] += f[0] * v[0] + f[3] * v[1];
    if (!evaluation->tangent) return;
    dmb_inertia_of(sim, node)[0] += evaluation->velocity_factor * c[0];
    dmb_inertia_of(sim, node)[3] += evaluation->velocity_factor * c[1];
}

static void gather_path(dmb_evaluation *evaluation, uint32_t node, const dmb_lump *lump)
{
    const int32_t features = evaluation->sim->scene->features;
    if (lump && evaluation->dynamic) gather_path_lump(evaluation, lump);
    if (features & DMB_FEATURE_GRAVITY) gather_path_weight(evaluation, node);
    if (features & DMB_FEATURE_DAMPING && evaluation->dynamic) gather_path_damping(evaluation, node);
}

/* Node by node in their order, and so are the lumps on them. */
void dmb_gather_nodes(dmb_evaluation *evaluation)
{
    const dmb_scene *scene = evaluation->sim->scene;
    if (!(scene->features & (DMB_FEATURE_GRAVITY | DMB_FEATURE_DAMPING)) && scene->lump_count == 0) return;
    for (uint32_t i = 0, lump = 0, count; i < scene->node_count; i += count) {
        count = dmb_full_nodes_at(scene, i);
        while (lump < scene->lump_count && scene->lumps[lump].node < i) lump++;
        if (count > 0) {
            gather_full(evaluation, i, count, lump);
        } else {
            const int has = lump < scene->lump_count && scene->lumps[lump].node == i;
            gather_path(evaluation, i, has ? scene->lumps + lump : NULL);
            count = 1;
        }
    }
}
