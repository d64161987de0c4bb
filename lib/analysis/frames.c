#include "analysis/frames.h"

#include <math.h>
#include <string.h>

#include "math/dense_lu.h"
#include "math/so3.h"
#include "system/linked.h"

/* ---- Turning of a node ---------------------------------------------------------------------------------------------
 */

/* The part of Q among the components that are free; a guide leaves all, a plane, a line or nothing. */
static void restrict_turn(const double Q[9], const uint8_t *solved, double out[9])
{
    uint32_t free[3], count = 0;
    for (uint32_t i = 0; i < 3; i++)
        if (solved[i]) free[count++] = i;
    for (uint32_t i = 0; i < 9; i++) out[i] = count == 3 ? Q[i] : i % 4 == 0;
    if (count != 2) return;
    /* polar factor of two rows and columns */
    const uint32_t a = free[0], b = free[1];
    const double angle = atan2(Q[3 * b + a] - Q[3 * a + b], Q[3 * a + a] + Q[3 * b + b]);
    out[3 * a + a] = out[3 * b + b] = cos(angle);
    out[3 * b + a] = sin(angle);
    out[3 * a + b] = -sin(angle);
}

/* T of a node, size x size; a PATH node has its axis and does not turn. */
static void turn_of_node(const dmb_sim *sim, uint32_t node, double *T)
{
    const uint32_t size = sim->scene->layout.size[node];
    const uint8_t *solved = sim->scene->solved_row + sim->scene->layout.row[node];
    double now[9], trial[9], Q[9], part[9];
    for (uint32_t i = 0; i < size * size; i++) T[i] = i % (size + 1) == 0;
    if (size != DMB_NODE_FULL) return;
    dmb_quat_to_matrix(sim->now.quaternion + 4 * (size_t)node, now);
    dmb_quat_to_matrix(sim->trial.quaternion + 4 * (size_t)node, trial);
    for (uint32_t i = 0; i < 3; i++)
        for (uint32_t j = 0; j < 3; j++)
            Q[3 * i + j] = now[i] * trial[j] + now[3 + i] * trial[3 + j] + now[6 + i] * trial[6 + j];
    for (uint32_t half = 0; half < 6; half += 3) {
        restrict_turn(Q, solved + half, part);
        for (uint32_t i = 0; i < 3; i++)
            for (uint32_t j = 0; j < 3; j++) T[6 * (half + i) + half + j] = part[3 * i + j];
    }
}

/* ---- Products ------------------------------------------------------------------------------------------------------
 */

/* A (n x m) <- X A Y^T, X (n x n), Y (m x m); transposed: X^T A Y. room: n m */
static void congruence(uint32_t n, uint32_t m, const double *X, const double *Y, int transposed, double *A,
                       double *room)
{
    for (uint32_t i = 0; i < n; i++)
        for (uint32_t j = 0; j < m; j++) {
            double sum = 0.0;
            for (uint32_t k = 0; k < n; k++)
                sum += (transposed ? X[(size_t)n * k + i] : X[(size_t)n * i + k]) * A[(size_t)m * k + j];
            room[(size_t)m * i + j] = sum;
        }
    for (uint32_t i = 0; i < n; i++)
        for (uint32_t j = 0; j < m; j++) {
            double sum = 0.0;
            for (uint32_t k = 0; k < m; k++)
                sum += room[(size_t)m * i + k] * (transposed ? Y[(size_t)m * k + j] : Y[(size_t)m * j + k]);
            A[(size_t)m * i + j] = sum;
        }
}

void dmb_frames_turn_chains(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    const dmb_block_layout *layout = &scene->layout;
    double T[2][36], room[36];
    for (uint32_t c = 0; c < scene->chain_count; c++) {
        const uint32_t first = scene->chains[c].first, end = first + scene->chains[c].count;
        if (scene->chains[c].linked) continue;
        turn_of_node(sim, first, T[first % 2]);
        for (uint32_t i = first; i < end; i++) {
            const double *X = T[i % 2], *Y = T[(i + 1) % 2];
            const uint32_t n = layout->size[i], m = i + 1 < end ? layout->size[i + 1] : 0;
            congruence(n, n, X, X, 0, sim->stiffness_diagonal + layout->diag[i], room);
            if (m == 0) continue;
            turn_of_node(sim, i + 1, T[(i + 1) % 2]);
            congruence(n, m, X, Y, 0, sim->stiffness_upper + layout->link[i], room);
            congruence(m, n, Y, X, 0, sim->stiffness_lower + layout->link[i], room);
        }
    }
}

/* ---- Reduced system ------------------------------------------------------------------------------------------------
 */

static uint32_t largest_block(const dmb_scene *scene)
{
    uint32_t largest = DMB_NODE_FULL;
    for (uint32_t k = 0; k < scene->cluster_count; k++)
        if (scene->clusters[k].columns > largest) largest = scene->clusters[k].columns;
    return largest;
}

void dmb_frames_lay_out(dmb_arena *arena, const dmb_scene *scene, dmb_frames *frames)
{
    const size_t largest = scene->cluster_count ? largest_block(scene) : 0;
    frames->turn = DMB_ARENA_DOUBLES(arena, scene->cluster_count ? scene->pattern.values : 0);
    frames->room = DMB_ARENA_DOUBLES(arena, 2 * largest * largest);
    frames->pivot = DMB_ARENA_ARRAY(arena, uint32_t, largest);
}

/* Rows of T R of a node of cluster k that are independent coordinates, into W (width x width). */
static void put_rows(const dmb_sim *sim, uint32_t k, uint32_t node, uint32_t width, double *W)
{
    const dmb_scene *scene = sim->scene;
    const uint32_t size = scene->layout.size[node], rank = sim->partition_rank[k];
    double T[36];
    turn_of_node(sim, node, T);
    for (uint32_t c = 0; c < size; c++) {
        const uint32_t place = sim->cluster_place[scene->clusters[k].column + scene->node_place[node] + c];
        if (place < rank) continue;
        double *row = W + (size_t)width * (place - rank);
        for (uint32_t j = 0; j < size; j++) {
            uint32_t one;
            const double *G = dmb_linked_null_space_row(sim, k, scene->node_place[node] + j, &one);
            if (T[size * c + j] == 0.0) continue;
            if (G == NULL) row[one] += T[size * c + j];
            for (uint32_t m = 0; G != NULL && m < width; m++) row[m] += T[size * c + j] * G[m];
        }
    }
}

static uint32_t node_of_block(const dmb_scene *scene, uint32_t block)
{
    uint32_t node = 0;
    while (scene->node_block[node] != block) node++;
    return node;
}

/* W of a block, n x n. */
static void rows_of_block(const dmb_sim *sim, uint32_t block, uint32_t n, double *W)
{
    const dmb_scene *scene = sim->scene;
    memset(W, 0, (size_t)n * n * sizeof(double));
    for (uint32_t k = 0; k < scene->cluster_count; k++) {
        const dmb_cluster *cluster = scene->clusters + k;
        if (cluster->block != block) continue;
        for (uint32_t i = cluster->node; i < cluster->node + cluster->node_count; i++)
            put_rows(sim, k, scene->cluster_nodes[i], n, W);
        return;
    }
    turn_of_node(sim, node_of_block(scene, block), W);
}

int dmb_frames_turn_linked(dmb_sim *sim, const dmb_frames *frames)
{
    const dmb_block_pattern *pattern = &sim->scene->pattern;
    const uint32_t largest = largest_block(sim->scene);
    double *values = sim->linked_value, *W = frames->room, *room = frames->room + (size_t)largest * largest;
    for (uint32_t k = 0; k < pattern->n; k++) {
        const uint32_t n = sim->linked_size[pattern->order[k]];
        double *V = frames->turn + pattern->diagonal[k];
        rows_of_block(sim, pattern->order[k], n, W);
        for (size_t i = 0; i < (size_t)n * n; i++) V[i] = i % (n + 1) == 0;
        if (n > 0 && dmb_dense_factor(n, W, frames->pivot) >= 0) return 0;
        dmb_dense_solve(n, n, W, frames->pivot, V);
    }
    for (uint32_t k = 0; k < pattern->n; k++) {
        const uint32_t n = sim->linked_size[pattern->order[k]];
        const double *V = frames->turn + pattern->diagonal[k];
        congruence(n, n, V, V, 1, values + pattern->diagonal[k], room);
        for (uint32_t e = pattern->column[k]; e < pattern->column[k + 1]; e++) {
            const uint32_t later = pattern->later[e], m = sim->linked_size[pattern->order[later]];
            const double *Z = frames->turn + pattern->diagonal[later];
            congruence(n, m, V, Z, 1, values + pattern->upper[e], room);
            congruence(m, n, Z, V, 1, values + pattern->lower[e], room);
        }
    }
    return 1;
}
