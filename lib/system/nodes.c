/* Forces of single nodes: rigid masses, gravity, external damping. */
#include "element/lump.h"
#include "system/evaluation.h"
#include "system/node.h"

static void gather_lump(dmb_evaluation *evaluation, const dmb_lump *lump)
{
    dmb_sim *sim = evaluation->sim;
    const double *v = sim->trial.velocity + sim->scene->layout.row[lump->node];
    double p[6], f[6], g[6];
    dmb_lump_mass_times(lump, sim->trial.acceleration + sim->scene->layout.row[lump->node], f);
    evaluation->power[DMB_POWER_INERTIA] -= dmb_vec6_dot(v, f);
    dmb_lump_mass_times(lump, v, p);
    dmb_ad_transpose(v, p, g);
    for (int i = 0; i < 6; i++) f[i] = -f[i];
    dmb_apply_wrench(sim, lump->node, f); /* one by one: on a free body these two are all that balances */
    dmb_apply_wrench(sim, lump->node, g);
    if (evaluation->tangent)
        dmb_lump_add_inertia_tangent(lump, v, p, evaluation->mass_factor, evaluation->velocity_factor,
                                     dmb_inertia_of(sim, lump->node));
}

/* On a PATH node only mass and the inertia about the axis are felt. */
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

/* Body-frame weight m R^T g and its moment b x R^T g; both turn with the body: d(R^T g) = (R^T g)~ dtheta. */
static void gather_weight(dmb_evaluation *evaluation, uint32_t node)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    const double m = evaluation->load_factor * scene->weight_mass[node];
    double g[3], b[3], f[6], v[6], skew[9], moment[9], product[9];
    dmb_mat3_tvec(sim->rotation + 9 * node, scene->gravity, g);
    dmb_vec3_scale(evaluation->load_factor, scene->weight_moment + 3 * node, b);
    dmb_vec3_scale(m, g, f);
    dmb_vec3_cross(b, g, f + 3);
    if (scene->layout.size[node] == DMB_NODE_PATH) dmb_vec3_zero(f + 3);
    dmb_apply_wrench(sim, node, f);
    if (evaluation->dynamic) {
        dmb_node_vector(scene, &sim->trial, node, sim->trial.velocity, v);
        evaluation->power[DMB_POWER_POTENTIAL] += dmb_vec6_dot(f, v);
    }
    if (!evaluation->tangent || scene->layout.size[node] == DMB_NODE_PATH) return;
    dmb_skew(g, skew);
    dmb_skew(b, moment);
    dmb_mat3_mul(moment, skew, product);
    dmb_mat6_add_skew(-m, g, 0, 1, dmb_stiffness_of(sim, node));
    dmb_mat6_add_block(-1.0, product, 1, 1, dmb_stiffness_of(sim, node));
}

static void gather_path_damping(dmb_evaluation *evaluation, uint32_t node, const double *c)
{
    dmb_sim *sim = evaluation->sim;
    const double *v = sim->trial.velocity + sim->scene->layout.row[node];
    const double f[6] = {-c[0] * v[0], 0.0, 0.0, -c[1] * v[1], 0.0, 0.0};
    dmb_apply_wrench(sim, node, f);
    evaluation->power[DMB_POWER_DAMPING] += f[0] * v[0] + f[3] * v[1];
    if (!evaluation->tangent) return;
    dmb_inertia_of(sim, node)[0] += evaluation->velocity_factor * c[0];
    dmb_inertia_of(sim, node)[3] += evaluation->velocity_factor * c[1];
}

/* Lateral damping of pipe along x: a slice at x moves sideways with v_y + x w_z and v_z - x w_y. c = axial, torsional,
 * and lateral times the integrals of 1, x, x^2. */
static void gather_damping(dmb_evaluation *evaluation, uint32_t node)
{
    dmb_sim *sim = evaluation->sim;
    const double *c = sim->scene->node_damping + 5 * node;
    const double *v = sim->trial.velocity + sim->scene->layout.row[node];
    if (sim->scene->layout.size[node] == DMB_NODE_PATH) {
        gather_path_damping(evaluation, node, c);
        return;
    }
    const double f[6] = {-c[0] * v[0], -c[2] * v[1] - c[3] * v[5], -c[2] * v[2] + c[3] * v[4],
                         -c[1] * v[3], c[3] * v[2] - c[4] * v[4],  -c[3] * v[1] - c[4] * v[5]};
    dmb_apply_wrench(sim, node, f);
    evaluation->power[DMB_POWER_DAMPING] += dmb_vec6_dot(f, v);
    if (!evaluation->tangent) return;
    double *C = dmb_inertia_of(sim, node);
    const double s = evaluation->velocity_factor;
    C[0] += s * c[0], C[21] += s * c[1];
    C[7] += s * c[2], C[14] += s * c[2];
    C[11] += s * c[3], C[31] += s * c[3];
    C[16] -= s * c[3], C[26] -= s * c[3];
    C[28] += s * c[4], C[35] += s * c[4];
}

void dmb_gather_nodes(dmb_evaluation *evaluation)
{
    const dmb_scene *scene = evaluation->sim->scene;
    for (uint32_t i = 0; evaluation->dynamic && i < scene->lump_count; i++) {
        if (scene->layout.size[scene->lumps[i].node] == DMB_NODE_FULL)
            gather_lump(evaluation, scene->lumps + i);
        else
            gather_path_lump(evaluation, scene->lumps + i);
    }
    if (scene->features & DMB_FEATURE_GRAVITY)
        for (uint32_t i = 0; i < scene->node_count; i++) gather_weight(evaluation, i);
    if (evaluation->dynamic && scene->features & DMB_FEATURE_DAMPING)
        for (uint32_t i = 0; i < scene->node_count; i++) gather_damping(evaluation, i);
}
