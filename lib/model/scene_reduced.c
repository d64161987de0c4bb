/* Blocks of the reduced system of scenes with joints (eq:joints.reduced-system), and the order of their elimination.
 *
 *     dense cluster            one block: its independent coordinates (and multipliers)
 *     node of a sparse one     one block each: all its rows, and multipliers of constraints that end there
 *     other node of a chain    one block each
 *       with joints
 *     chain without joints     no block: it is eliminated along the chain (math/block_tridiagonal.c)
 *
 * Elements between two blocks, and constraints of sparse clusters, are the edges of the graph whose elimination order
 * math/elimination_order.c computes. */
#include "model/scene.h"

#include <string.h>

#include "base/memory.h"

/* ---- Nodes of clusters ------------------------------------------------------------------------------------------- */

static void place_nodes(dmb_scene *scene, uint32_t c)
{
    const dmb_cluster *cluster = &scene->clusters[c];
    uint32_t *column = scene->cluster_columns + cluster->column, place = 0;
    for (uint32_t i = 0; i < cluster->node_count; ++i) {
        const uint32_t node = scene->cluster_nodes[cluster->node + i];
        scene->node_cluster[node] = c;
        if (!cluster->sparse) scene->node_block[node] = cluster->block;
        scene->node_place[node] = place;
        for (uint32_t k = 0; k < scene->layout.size[node]; ++k) column[place++] = scene->layout.row[node] + k;
    }
}

static int32_t has_cluster(const dmb_scene *scene, const dmb_chain *chain)
{
    for (uint32_t i = 0; i < chain->count; ++i) {
        if (scene->node_cluster[chain->first + i] != DMB_NONE) return 1;
    }
    return 0;
}

/* Blocks of dense components come first. */
static void number_clusters(dmb_scene *scene)
{
    scene->block_count = scene->sparse_count = scene->reduced_count = 0;
    for (uint32_t c = 0; c < scene->cluster_count; ++c) {
        dmb_cluster *cluster = &scene->clusters[c];
        cluster->block = cluster->sparse ? DMB_NONE : scene->block_count++;
        scene->sparse_count += cluster->sparse != 0;
    }
}

/* Each of the other nodes of jointed chains has a block. */
static void number_blocks(dmb_scene *scene)
{
    for (uint32_t c = 0; c < scene->chain_count; ++c) {
        dmb_chain *chain = &scene->chains[c];
        chain->jointed = has_cluster(scene, chain);
        if (!chain->jointed) continue;
        scene->reduced_count += chain->count;
        for (uint32_t i = chain->first; i < chain->first + chain->count; ++i) {
            if (scene->node_block[i] == DMB_NONE) scene->node_block[i] = scene->block_count++;
        }
    }
}

/* ---- Pattern ----------------------------------------------------------------------------------------------------- */

/* True if an element leads from node i to a node of another block. */
static int leads_on(const dmb_scene *scene, uint32_t i)
{
    if (scene->node_block[i] == DMB_NONE || scene->node_element[i] == DMB_NONE) return 0;
    return scene->node_block[i] != scene->node_block[i + 1];
}

static int is_sparse(const dmb_scene *scene, const dmb_constraint *constraint)
{
    return scene->clusters[constraint->cluster].sparse;
}

static int32_t add_edge(const dmb_allocator *allocator, uint32_t a, uint32_t b, dmb_vector *edges)
{
    const dmb_block_edge edge = {a, b};
    return dmb_vector_append(edges, allocator, &edge, 1);
}

/* Edges of the graph: elements, and constraints of sparse components. */
static int32_t list_edges(const dmb_scene *scene, const dmb_allocator *allocator, dmb_vector *edges)
{
    int32_t status = dmb_vector_reserve(edges, allocator, scene->reduced_count);
    for (uint32_t i = 0; i < scene->node_count && status >= 0; ++i) {
        if (leads_on(scene, i)) status = add_edge(allocator, scene->node_block[i], scene->node_block[i + 1], edges);
    }
    for (uint32_t i = 0; i < scene->constraint_count && status >= 0; ++i) {
        const dmb_constraint *c = scene->constraints + i;
        if (!is_sparse(scene, c)) continue;
        for (uint32_t a = 0; a < c->node_count; ++a)
            for (uint32_t b = 0; b < a && status >= 0; ++b)
                status = add_edge(allocator, scene->node_block[c->node[a]], scene->node_block[c->node[b]], edges);
    }
    return status;
}

/* Capacity of blocks; that of a dense component includes its multipliers. */
static void fill_capacity(const dmb_scene *scene, uint32_t *capacity)
{
    for (uint32_t c = 0; c < scene->cluster_count; ++c) {
        const dmb_cluster *cluster = &scene->clusters[c];
        if (!cluster->sparse) capacity[cluster->block] = cluster->columns + cluster->rows;
    }
    for (uint32_t i = 0; i < scene->node_count; ++i) {
        const uint32_t k = scene->node_cluster[i];
        if (scene->node_block[i] == DMB_NONE || (k != DMB_NONE && !scene->clusters[k].sparse)) continue;
        capacity[scene->node_block[i]] = scene->layout.size[i];
    }
}

static uint32_t last_block(const dmb_scene *scene, const dmb_block_pattern *pattern, const dmb_constraint *c)
{
    uint32_t block = scene->node_block[c->node[0]];
    for (uint32_t k = 1; k < c->node_count; ++k) {
        const uint32_t other = scene->node_block[c->node[k]];
        if (pattern->position[other] > pattern->position[block]) block = other;
    }
    return block;
}

/* Multipliers are eliminated with a node before which all other nodes of their constraint are, so that their pivots are
 * those of -B S^-1 B^T; of bridges, and of the drives of such joints, already with the node beyond: what is there moves
 * as one with the bridge open, so that no earlier equation can constrain the motion that the bridge constrains. */
static void place_multipliers(const dmb_scene *scene, const dmb_block_pattern *pattern, const uint32_t *beyond,
                              uint32_t *capacity)
{
    for (uint32_t i = 0; i < scene->constraint_count; ++i) {
        dmb_constraint *c = scene->constraints + i;
        if (!is_sparse(scene, c)) continue;
        const uint32_t joint = c->kind == DMB_OF_DRIVE ? scene->joints[scene->drives[c->index].joint].constraint : i;
        const uint32_t node = beyond[joint];
        c->block = node != DMB_NONE ? scene->node_block[node] : last_block(scene, pattern, c);
        capacity[c->block] += c->rows;
    }
}

/* The order of elimination does not depend on capacities: it is computed first, then storage for the multipliers. */
static int32_t make_room(dmb_scene *scene, const dmb_allocator *allocator, uint32_t *capacity, const dmb_vector *edges)
{
    dmb_vector beyond = dmb_vector_of(sizeof(uint32_t));
    dmb_block_pattern first;
    int32_t status = dmb_vector_append(&beyond, allocator, NULL, scene->constraint_count);
    if (status >= 0) status = dmb_scene_bridges(scene, allocator, beyond.items);
    if (status >= 0)
        status = dmb_block_pattern_make(allocator, scene->block_count, capacity, (uint32_t)edges->count, edges->items,
                                        &first);
    if (status >= 0) {
        place_multipliers(scene, &first, beyond.items, capacity);
        dmb_block_pattern_release(&first, allocator);
    }
    dmb_vector_release(&beyond, allocator);
    return status;
}

/* The pattern is computed twice if there are sparse clusters: multipliers are placed by the order of elimination, and
 * offsets of the blocks follow from the capacities with them. */
static int32_t make_pattern(dmb_scene *scene, const dmb_allocator *allocator)
{
    dmb_vector capacity = dmb_vector_of(sizeof(uint32_t)), edges = dmb_vector_of(sizeof(dmb_block_edge));
    int32_t status = dmb_vector_append(&capacity, allocator, NULL, scene->block_count);
    if (status >= 0) status = list_edges(scene, allocator, &edges);
    if (status >= 0) fill_capacity(scene, capacity.items);
    if (status >= 0 && scene->sparse_count) status = make_room(scene, allocator, capacity.items, &edges);
    if (status >= 0)
        status = dmb_block_pattern_make(allocator, scene->block_count, capacity.items, (uint32_t)edges.count,
                                        edges.items, &scene->pattern);
    for (uint32_t b = 0; b < scene->block_count && status >= 0 && scene->sparse_count; ++b) {
        const size_t rows =
            *DMB_VECTOR_AT(uint32_t, &capacity, b); /* for signs of eigenvalues: analysis/linear/stiffness_signs */
        if (rows * rows > scene->six_dof_count) scene->six_dof_count = rows * rows;
    }
    dmb_vector_release(&capacity, allocator);
    dmb_vector_release(&edges, allocator);
    return status;
}

/* Offsets of the two blocks of the element behind each node, so that assembly does not search the pattern. SIZE_MAX:
 * both ends are in the same block, or there is no element. */
static void find_links(dmb_scene *scene)
{
    for (uint32_t i = 0; i < scene->node_count; ++i) {
        size_t *link = scene->off_diagonal_offset + 2 * (size_t)i;
        link[0] = link[1] = SIZE_MAX;
        if (!leads_on(scene, i)) continue;
        link[0] = dmb_block_pattern_offset(&scene->pattern, scene->node_block[i], scene->node_block[i + 1]);
        link[1] = dmb_block_pattern_offset(&scene->pattern, scene->node_block[i + 1], scene->node_block[i]);
    }
}

int32_t dmb_scene_number_blocks(dmb_scene *scene, const dmb_allocator *allocator)
{
    if (scene->cluster_count == 0) return DMB_OK;
    for (uint32_t i = 0; i < scene->node_count; ++i) scene->node_cluster[i] = scene->node_block[i] = DMB_NONE;
    number_clusters(scene);
    for (uint32_t c = 0; c < scene->cluster_count; ++c) place_nodes(scene, c);
    number_blocks(scene);
    const int32_t status = make_pattern(scene, allocator);
    if (status >= 0) find_links(scene);
    return status;
}

/* Bridges: joints without which the graph would fall apart. Vertices are the nodes and the ground, edges the
 * constraints between them; elements are none, as they are no equations. One walk through the graph, depth first,
 * numbers the vertices; `low` is the lowest number that is reached from a vertex or those beyond it by an edge that the
 * walk did not take. An edge is a bridge if nothing beyond it
 * reaches back to its near end or further (Tarjan 1974). */
typedef struct graph {
    const dmb_scene *scene;
    uint32_t *start, *edge; /* constraints of each vertex; shape (n + 2), (2 (ends)) */
    uint32_t *next;         /* (n + 1) edge to be visited next */
    uint32_t *number, *low; /* (n + 1) in the order of the walk, 0: not yet; lowest that is reached from beyond */
    uint32_t *path, *by;    /* (n + 1) vertices from the root to here; constraint that led to a vertex */
} graph;

enum { LISTS = 6 };

static uint32_t ground_of(const dmb_scene *scene)
{
    return scene->node_count;
}

static int is_joint(const dmb_constraint *c)
{
    return c->kind == DMB_OF_JOINT;
}

/* True if all six rows of a node are unknowns; other nodes are connected to the ground. */
static int moves_freely(const dmb_scene *scene, uint32_t node)
{
    if (scene->layout.size[node] != DMB_NODE_SIX_DOF) return 0;
    for (uint32_t k = 0; k < DMB_NODE_SIX_DOF; k++)
        if (!scene->solved_row[scene->layout.row[node] + k]) return 0;
    return 1;
}

/* True if the ground is part of a constraint: beside a single node, in equations that may change when all their nodes
 * move as one, and at a supported node. */
static int on_ground(const dmb_scene *scene, const dmb_constraint *c)
{
    if (c->node_count < 2 || !is_joint(c)) return 1;
    for (uint32_t k = 0; k < c->node_count; k++)
        if (!moves_freely(scene, c->node[k])) return 1;
    return 0;
}

static uint32_t vertices_of(const dmb_scene *scene, const dmb_constraint *c, uint32_t vertex[DMB_CONSTRAINT_NODES + 1])
{
    uint32_t count = 0;
    if (c->kind == DMB_OF_DRIVE || c->kind == DMB_OF_SPRING || c->kind == DMB_OF_FORCE) return 0; /* no equations */
    for (; count < c->node_count; count++) vertex[count] = c->node[count];
    if (on_ground(scene, c)) vertex[count++] = ground_of(scene);
    return count;
}

static void list_bridge_edges(graph *g)
{
    const dmb_scene *scene = g->scene;
    uint32_t vertex[DMB_CONSTRAINT_NODES + 1];
    for (uint32_t i = 0; i < scene->constraint_count; i++)
        for (uint32_t k = vertices_of(scene, scene->constraints + i, vertex); k-- > 0;) g->start[vertex[k] + 1]++;
    for (uint32_t v = 0; v <= scene->node_count; v++) g->start[v + 1] += g->start[v];
    memcpy(g->next, g->start, ((size_t)scene->node_count + 1) * sizeof(uint32_t));
    for (uint32_t i = 0; i < scene->constraint_count; i++)
        for (uint32_t k = vertices_of(scene, scene->constraints + i, vertex); k-- > 0;)
            g->edge[g->next[vertex[k]]++] = i;
    memcpy(g->next, g->start, ((size_t)scene->node_count + 1) * sizeof(uint32_t));
}

/* A vertex next to v by constraint c that was not met yet, or DMB_NONE; those met lower what v reaches. */
static uint32_t step_on(graph *g, uint32_t v, uint32_t c)
{
    uint32_t vertex[DMB_CONSTRAINT_NODES + 1];
    const uint32_t count = vertices_of(g->scene, g->scene->constraints + c, vertex);
    for (uint32_t k = 0; k < count; k++) {
        if (vertex[k] == v) continue;
        if (g->number[vertex[k]] == 0) return vertex[k];
        if (c != g->by[v] && g->number[vertex[k]] < g->low[v]) g->low[v] = g->number[vertex[k]];
    }
    return DMB_NONE;
}

/* A joint between two vertices. */
static int is_bridge_kind(const dmb_scene *scene, uint32_t c)
{
    uint32_t vertex[DMB_CONSTRAINT_NODES + 1];
    return is_joint(scene->constraints + c) && vertices_of(scene, scene->constraints + c, vertex) == 2 &&
           moves_freely(scene, scene->constraints[c].node[0]);
}

/* Leaves v: vertices reached from it are reached from the vertex before it; if nothing further back is, the edge to v
 * is a bridge. */
static void leave(graph *g, uint32_t before, uint32_t v, uint32_t *beyond)
{
    if (g->low[v] < g->low[before]) g->low[before] = g->low[v];
    if (g->low[v] > g->number[before] && is_bridge_kind(g->scene, g->by[v])) beyond[g->by[v]] = v;
}

/* The walk without recursion, whose depth could be the number of nodes. From the root on: the next edge of the last
 * vertex on the path, or back by one vertex if all of its edges were visited. */
static void iterator(graph *g, uint32_t root, uint32_t *count, uint32_t *beyond)
{
    uint32_t depth = 0, v = root;
    g->by[root] = DMB_NONE;
    g->number[root] = g->low[root] = ++*count;
    g->path[0] = root;
    for (;;) {
        v = g->path[depth];
        if (g->next[v] == g->start[v + 1]) {
            if (depth == 0) return;
            leave(g, g->path[--depth], v, beyond);
            continue;
        }
        const uint32_t c = g->edge[g->next[v]], other = step_on(g, v, c);
        if (other == DMB_NONE) {
            g->next[v]++;
            continue;
        }
        g->by[other] = c;
        g->number[other] = g->low[other] = ++*count;
        g->path[++depth] = other;
    }
}

/* The ground is the first root, so that the side `beyond` a bridge is the one that it connects to the ground. Parts
 * without connection to the ground have roots of their own. */
int32_t dmb_scene_bridges(const dmb_scene *scene, const dmb_allocator *allocator, uint32_t *beyond)
{
    const size_t n = (size_t)scene->node_count + 2, ends = (size_t)scene->constraint_count * (DMB_CONSTRAINT_NODES + 1);
    const size_t bytes = (LISTS * n + ends) * sizeof(uint32_t);
    uint32_t *room = dmb_allocate(allocator, bytes), count = 0;
    if (room == NULL) return DMB_ERR_NO_MEMORY;
    memset(room, 0, bytes);
    graph g = {scene, room, room + LISTS * n, room + n, room + 2 * n, room + 3 * n, room + 4 * n, room + 5 * n};
    for (uint32_t i = 0; i < scene->constraint_count; i++) beyond[i] = DMB_NONE;
    list_bridge_edges(&g);
    iterator(&g, ground_of(scene), &count, beyond);
    for (uint32_t v = 0; v < scene->node_count; v++)
        if (g.number[v] == 0 && g.start[v] < g.start[v + 1]) iterator(&g, v, &count, beyond);
    dmb_release(allocator, room, bytes);
    return DMB_OK;
}
