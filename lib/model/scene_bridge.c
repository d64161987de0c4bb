#include "model/scene_bridge.h"

#include <string.h>

#include "base/allocator.h"
#include "base/checked_size.h"

/* The graph of nodes, the ground behind them, and of constraints; and the walk through it, depth first. */
typedef struct graph {
    const dmb_scene *scene;
    uint32_t *start, *edge; /* constraints of each vertex; shape (n + 2), (2 (ends)) */
    uint32_t *next;         /* (n + 1) edge to be looked at next */
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

/* All six of its rows are solved for; others are held by the ground. */
static int moves_freely(const dmb_scene *scene, uint32_t node)
{
    if (scene->layout.size[node] != DMB_NODE_FULL) return 0;
    for (uint32_t k = 0; k < DMB_NODE_FULL; k++)
        if (!scene->solved_row[scene->layout.row[node] + k]) return 0;
    return 1;
}

/* Whether the ground has a part in it: beside a single node, in equations that need not stay the same when all their nodes
 * move as one, and by a node that it holds. */
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
    if (c->kind == DMB_OF_DRIVE) return 0;
    for (; count < c->node_count; count++) vertex[count] = c->node[count];
    if (on_ground(scene, c)) vertex[count++] = ground_of(scene);
    return count;
}

static void list_edges(graph *g)
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

/* A vertex next to v by constraint c that was not met yet, or UINT32_MAX; those met lower what v reaches. */
static uint32_t step_on(graph *g, uint32_t v, uint32_t c)
{
    uint32_t vertex[DMB_CONSTRAINT_NODES + 1];
    const uint32_t count = vertices_of(g->scene, g->scene->constraints + c, vertex);
    for (uint32_t k = 0; k < count; k++) {
        if (vertex[k] == v) continue;
        if (g->number[vertex[k]] == 0) return vertex[k];
        if (c != g->by[v] && g->number[vertex[k]] < g->low[v]) g->low[v] = g->number[vertex[k]];
    }
    return UINT32_MAX;
}

/* A joint between two vertices. */
static int is_bridge_kind(const dmb_scene *scene, uint32_t c)
{
    uint32_t vertex[DMB_CONSTRAINT_NODES + 1];
    return is_joint(scene->constraints + c) && vertices_of(scene, scene->constraints + c, vertex) == 2 &&
           moves_freely(scene, scene->constraints[c].node[0]);
}

/* v is done with: what it reaches is reached from the vertex before it; nothing else is, so what led here is a bridge. */
static void leave(graph *g, uint32_t before, uint32_t v, uint32_t *beyond)
{
    if (g->low[v] < g->low[before]) g->low[before] = g->low[v];
    if (g->low[v] > g->number[before] && is_bridge_kind(g->scene, g->by[v])) beyond[g->by[v]] = v;
}

static void walk(graph *g, uint32_t root, uint32_t *count, uint32_t *beyond)
{
    uint32_t depth = 0, v = root;
    g->by[root] = UINT32_MAX;
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
        if (other == UINT32_MAX) {
            g->next[v]++;
            continue;
        }
        g->by[other] = c;
        g->number[other] = g->low[other] = ++*count;
        g->path[++depth] = other;
    }
}

int32_t dmb_scene_bridges(const dmb_scene *scene, const dmb_allocator *allocator, uint32_t *beyond)
{
    const size_t n = (size_t)scene->node_count + 2, ends = (size_t)scene->constraint_count * (DMB_CONSTRAINT_NODES + 1);
    const size_t bytes = (LISTS * n + ends) * sizeof(uint32_t);
    uint32_t *room = dmb_allocate(allocator, bytes), count = 0;
    if (room == NULL) return DMB_ERR_NO_MEMORY;
    memset(room, 0, bytes);
    graph g = {scene, room, room + LISTS * n, room + n, room + 2 * n, room + 3 * n, room + 4 * n, room + 5 * n};
    for (uint32_t i = 0; i < scene->constraint_count; i++) beyond[i] = UINT32_MAX;
    list_edges(&g);
    walk(&g, ground_of(scene), &count, beyond);
    for (uint32_t v = 0; v < scene->node_count; v++)
        if (g.number[v] == 0 && g.start[v] < g.start[v + 1]) walk(&g, v, &count, beyond);
    dmb_release(allocator, room, bytes);
    return DMB_OK;
}
