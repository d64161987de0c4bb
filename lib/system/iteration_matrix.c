/* Iteration matrix of a Newton step in the pose parameters z of the increment h Dq:
 *     [K T6(h Dq) + mass_factor M + velocity_factor C] z = -residual
 * K is with respect to body-frame pose changes, which are T6(h Dq) z. */
#include "math/se3.h"
#include "system/evaluation.h"

/* rows x 6 block: K <- K T6 = [a S, a B + b S] row by row */
static void times_tangent(double *K, uint32_t rows, const dmb_se3_tangent *T)
{
    for (uint32_t r = 0; r < rows; r++) {
        double *a = K + 6 * r, b[3], c[3];
        dmb_mat3_tvec(T->B, a, b);
        dmb_mat3_tvec(T->S, a + 3, c);
        dmb_vec3_add(b, c, a + 3);
        dmb_mat3_tvec(T->S, a, a);
    }
}

static void tangent_columns(dmb_sim *sim, uint32_t node)
{
    const dmb_scene *scene = sim->scene;
    const dmb_block_layout *layout = &scene->layout;
    dmb_se3_tangent T;
    if (layout->size[node] != DMB_NODE_FULL) return;
    dmb_se3_tangent_at(sim->increment + layout->row[node], NULL, &T);
    times_tangent(dmb_stiffness_of(sim, node), DMB_NODE_FULL, &T);
    if (node > 0 && scene->node_element[node - 1] != UINT32_MAX)
        times_tangent(sim->stiffness_upper + layout->link[node - 1], layout->size[node - 1], &T);
    if (scene->node_element[node] != UINT32_MAX)
        times_tangent(sim->stiffness_lower + layout->link[node], layout->size[node + 1], &T);
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
        for (uint32_t i = 0; i < n; i++) tangent_columns(sim, i);
        add(sim->inertia_diagonal, sim->stiffness_diagonal, layout->diag[n]);
        add(sim->inertia_upper, sim->stiffness_upper, layout->link[n - 1]);
        add(sim->inertia_lower, sim->stiffness_lower, layout->link[n - 1]);
    }
    for (uint32_t i = 0; i < scene->held_count; i++) hold_row(sim, scene->held_node[i], scene->held_component[i]);
}
