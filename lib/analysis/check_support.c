/* Which parts would fall: chains of nodes that joints connect make groups, and something has to hold each. */
#include "analysis/model_check.h"
#include "base/allocator.h"

/* Union and find over nodes, the smallest of a group being its root; held: by root. */
typedef struct groups {
    const dmb_sim *sim;
    uint32_t *parent, *held;
} groups;

static uint32_t root_of(const groups *g, uint32_t node)
{
    while (g->parent[node] != node) {
        g->parent[node] = g->parent[g->parent[node]];
        node = g->parent[node];
    }
    return node;
}

static void hold(const groups *g, uint32_t node)
{
    g->held[root_of(g, node)] = 1;
}

static void join(const groups *g, uint32_t a, uint32_t b)
{
    const uint32_t from = root_of(g, a), to = root_of(g, b);
    const uint32_t low = from < to ? from : to, high = from < to ? to : from;
    g->parent[high] = low;
    g->held[low] |= g->held[high];
}

static void begin(const groups *g)
{
    const dmb_scene *scene = g->sim->scene;
    for (uint32_t c = 0; c < scene->chain_count; c++) {
        const dmb_chain *chain = scene->chains + c;
        for (uint32_t i = chain->first; i < chain->first + chain->count; i++) g->parent[i] = chain->first;
    }
}

/* A joint that is free holds by its springs and stops only. */
static void pass_joints(const groups *g)
{
    const dmb_scene *scene = g->sim->scene;
    for (uint32_t j = 0; j < scene->joint_count; j++) {
        const dmb_scene_joint *joint = scene->joints + j;
        if (g->sim->joint_state[j] == DMB_JOINT_OPEN) continue;
        if (joint->kind == DMB_JOINT_FREE && g->sim->joint_state[j] == DMB_JOINT_ACTIVE && joint->law == UINT32_MAX)
            continue;
        if (joint->a.node == UINT32_MAX)
            hold(g, joint->b.node);
        else
            join(g, joint->a.node, joint->b.node);
    }
}

/* The caller's equations may do anything. */
static void pass_callbacks(const groups *g)
{
    const dmb_scene *scene = g->sim->scene;
    for (uint32_t i = 0; i < scene->callback_count; i++)
        for (uint32_t k = 0; k < scene->callbacks[i].count; k++) hold(g, scene->callbacks[i].place[k].node);
}

/* Guides, drives, walls and rock. An axial-torsional node stands on its axis. */
static void pass_nodes(const groups *g)
{
    const dmb_scene *scene = g->sim->scene;
    for (uint32_t i = 0; i < scene->held_count; i++) hold(g, scene->held_node[i]);
    for (uint32_t i = 0; i < scene->node_count; i++)
        if (scene->layout.size[i] == DMB_NODE_PATH) hold(g, i);
    for (uint32_t i = 0; i < scene->drive_count; i++)
        if (scene->drives[i].node != UINT32_MAX) hold(g, scene->drives[i].node);
    for (uint32_t i = 0; i < scene->site_count; i++) hold(g, scene->sites[i].node);
    for (uint32_t i = 0; i < scene->bit_count; i++)
        if (scene->bits[i].law.kind != DMB_ROCK_NONE) hold(g, scene->bits[i].node);
}

static void count_loose(const groups *g, dmb_loose_parts *loose)
{
    for (uint32_t i = 0; i < g->sim->scene->node_count; i++) {
        if (g->parent[i] != i || g->held[i]) continue;
        if (loose->groups++ == 0) loose->node = i;
    }
}

int32_t dmb_find_loose_parts(const dmb_sim *sim, dmb_loose_parts *loose)
{
    const size_t n = sim->scene->node_count, bytes = 2 * n * sizeof(uint32_t);
    loose->groups = loose->node = 0;
    if ((sim->scene->features & DMB_FEATURE_GRAVITY) == 0) return DMB_OK;
    uint32_t *block = dmb_allocate(&sim->allocator, bytes);
    if (block == NULL) return DMB_ERR_NO_MEMORY;
    const groups g = {sim, block, block + n};
    begin(&g);
    pass_joints(&g);
    pass_callbacks(&g);
    pass_nodes(&g);
    count_loose(&g, loose);
    dmb_release(&sim->allocator, block, bytes);
    return DMB_OK;
}
