/* Iteration matrix of a Newton step in the pose parameters z of the increment h Dq:
 *     [K T6(h Dq) + mass_factor M + velocity_factor C] z = -residual
 * K is with respect to body-frame pose changes, which are T6(h Dq) z. The elements have done so to the blocks of their
 * links; what is left are the blocks of the nodes, to which all forces add. */
#include "math/se3.h"
#include "system/evaluation.h"
#include "system/free_rigid.h"

/* next: the first free rigid body that may be on the node */
static void tangent_columns(dmb_sim *sim, uint32_t node, uint32_t *next)
{
    const dmb_scene *scene = sim->scene;
    const dmb_block_layout *layout = &scene->layout;
    dmb_se3_tangent T;
    if (layout->size[node] != DMB_NODE_FULL) return;
    if (*next < scene->free_rigid_count && scene->free_rigids[*next].node == node) { /* done */
        ++*next;
        return;
    }
    dmb_se3_tangent_at(sim->increment + layout->row[node], NULL, &T);
    dmb_se3_times_tangent(dmb_stiffness_of(sim, node), DMB_NODE_FULL, &T);
}

static void add(const double *restrict from, double *restrict to, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) to[i] += from[i];
}

/* Row and column of an unknown that is not solved for: identity. */
static void hold_row(dmb_sim *sim, uint32_t node, uint32_t c)
{
    const dmb_scene *scene = sim->scene;
    const dmb_block_layout *layout = &scene->layout;
    const uint32_t size = layout->size[node];
    double *D = dmb_stiffness_of(sim, node);
    for (uint32_t i = 0; i < size; i++) D[size * c + i] = D[size * i + c] = 0.0;
    D[(size + 1) * c] = 1.0;
    if (node > 0 && scene->node_element[node - 1] != UINT32_MAX) {
        const uint32_t before = layout->size[node - 1];
        for (uint32_t i = 0; i < before; i++) {
            sim->stiffness_lower[layout->link[node - 1] + before * c + i] = 0.0;
            sim->stiffness_upper[layout->link[node - 1] + size * i + c] = 0.0;
        }
    }
    if (scene->node_element[node] != UINT32_MAX) {
        const uint32_t after = layout->size[node + 1];
        for (uint32_t i = 0; i < after; i++) {
            sim->stiffness_upper[layout->link[node] + after * c + i] = 0.0;
            sim->stiffness_lower[layout->link[node] + size * i + c] = 0.0;
        }
    }
}

void dmb_system_iteration_matrix(const dmb_evaluation *evaluation)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    const dmb_block_layout *layout = &scene->layout;
    const uint32_t n = scene->node_count;
    if (evaluation->dynamic) {
        const int stepping = evaluation->velocity_factor > 0.0;
        uint32_t next = stepping ? 0 : scene->free_rigid_count;
        if (stepping && scene->free_rigid_count) dmb_free_rigids_matrix(evaluation);
        for (uint32_t i = 0; i < n; i++) tangent_columns(sim, i, &next);
        add(sim->inertia_diagonal, sim->stiffness_diagonal, layout->diag[n]);
    }
    for (uint32_t i = 0; i < scene->held_count; i++) hold_row(sim, scene->held_node[i], scene->held_component[i]);
}
