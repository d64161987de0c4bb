/* Model check as a struct: counts of parts, joints, actions, degrees of freedom and of the solver, and the number of
 * warnings. The sim is occupied, not changed: it stays open for the text (model_check_text.c) until
 * dmb_model_check_close. */
#include "analysis/model_check/model_check.h"

#include <string.h>

#include "base/memory.h"
#include "base/sized_struct.h"
#include "sim/access.h"

DMB_DECLARE_STRUCT(dmb_check_report)

/* ---- Counts ------------------------------------------------------------------------------------------------------ */

/* Counts parts as on a drawing: a body attached to a string is a part, although it has no unknowns of its own. */
static void count_parts(const dmb_scene *scene, dmb_check_report *report)
{
    report->rigid_parts = scene->body_count; /* including bits */
    for (uint32_t i = 0; i < scene->pipe_count; i++) {
        const dmb_pipe_map *pipe = scene->pipes + i;
        report->flexible_parts += pipe->elements > 0;
        report->rigid_parts += pipe->elements == 0;
        report->rigid_parts += pipe->joint > 0.0;
    }
    report->elements = scene->element_count;
    report->structural_joints = scene->structural_joint_count;
}

_Static_assert(DMB_JOINT_KINDS <= sizeof(((dmb_check_report *)0)->joints) / sizeof(uint32_t),
               "every kind of joint has its count in the report");

static void count_joints(const dmb_sim *sim, dmb_check_report *report)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t j = 0; j < scene->joint_count; j++) {
        const int open = sim->joint_state[j] == DMB_JOINT_OPEN;
        report->open_joints += (uint32_t)open;
        report->locked_joints += sim->joint_state[j] == DMB_JOINT_LOCKED;
        report->joints[scene->joints[j].kind] += !open;
    }
    report->couplings = scene->coupling_count;
    report->constraints = scene->callback_count;
}

static void count_actions(const dmb_scene *scene, dmb_check_report *report)
{
    for (uint32_t i = 0; i < scene->drive_count; i++)
        report->motion_drives += scene->drives[i].kind == DMB_DRIVE_MOTION;
    report->other_drives = scene->drive_count - report->motion_drives;
    report->loads = scene->load_count;
}

/* Coordinates less supports, drives and independent equations. `gruebler` counts all equations as independent and is
 * smaller by the redundant ones; it may be negative. */
static void count_degrees_of_freedom(const dmb_scene *scene, const dmb_cluster_rank *rank, dmb_check_report *report)
{
    report->coordinates = scene->row_count;
    report->prescribed = scene->prescribed_count;
    report->held = scene->row_count - scene->free_count - scene->prescribed_count;
    report->constraint_rows = rank->rows;
    report->rank = rank->rank;
    report->redundant = rank->rows - rank->rank;
    report->gruebler = (int64_t)scene->free_count - (int64_t)rank->rows;
    report->degrees_of_freedom = scene->free_count - rank->rank;
    report->largest_violation = rank->violation;
    report->condition = rank->condition;
}

static void count_solver(const dmb_scene *scene, dmb_check_report *report)
{
    report->sparse_nodes = scene->reduced_count;
    report->tridiagonal_nodes = scene->node_count - scene->reduced_count;
    report->blocks = scene->block_count;
    report->fill = scene->pattern.fill;
    report->clusters = scene->cluster_count;
    for (uint32_t k = 0; k < scene->cluster_count; k++)
        if (scene->clusters[k].columns > report->largest_cluster) report->largest_cluster = scene->clusters[k].columns;
}

/* ---- Check ------------------------------------------------------------------------------------------------------- */

static void count_line(void *context, const char *text)
{
    uint32_t *lines = context;
    (void)text;
    ++*lines;
}

/* Warnings are counted by running them with a receiver that counts lines: number and text cannot differ. */
static int32_t make(const dmb_sim *sim, dmb_model_check *findings)
{
    dmb_check_report *report = &findings->report;
    uint32_t lines = 0;
    memset(findings, 0, sizeof *findings);
    findings->sim = sim;
    int32_t status = dmb_cluster_rank_make(sim, &findings->rank);
    if (status >= 0) status = dmb_find_unconstrained_parts(sim, &findings->unconstrained);
    if (status < 0) {
        dmb_cluster_rank_release(sim, &findings->rank);
        return status;
    }
    count_parts(sim->scene, report);
    count_joints(sim, report);
    count_actions(sim->scene, report);
    count_degrees_of_freedom(sim->scene, &findings->rank, report);
    count_solver(sim->scene, report);
    dmb_model_check_warnings(findings, count_line, &lines);
    report->warnings = lines;
    return DMB_OK;
}

int32_t dmb_model_check_open(const dmb_sim *sim, dmb_model_check *findings)
{
    int32_t status = dmb_sim_occupy(sim);
    if (status < 0) return status;
    status = make(sim, findings);
    if (status >= 0) return DMB_OK;
    dmb_message_clear(&((dmb_sim *)sim)->message); /* that of an earlier call, which an answer would leave */
    return dmb_sim_leave((dmb_sim *)sim, status);
}

void dmb_model_check_close(dmb_model_check *findings)
{
    dmb_cluster_rank_release(findings->sim, &findings->rank);
    (void)dmb_sim_leave((dmb_sim *)findings->sim, DMB_OK);
}

int32_t dmb_analysis_check(const dmb_sim *sim, dmb_check_report *report)
{
    dmb_model_check findings;
    if (sim == NULL || report == NULL) return dmb_sim_failed(sim, "model check", DMB_ERR_NULL);
    int32_t status = dmb_model_check_open(sim, &findings);
    if (status < 0) return status;
    status = dmb_check_report_write(report, &findings.report);
    dmb_model_check_close(&findings);
    return status;
}

/* ---- Parts that would fall under gravity: chains of nodes connected by joints form groups, each of which needs a
 * support. The check is topological: a support of any component counts, so that no warning is not a proof of support
 * ---- */

/* Union-find over nodes, the root of a group being its smallest node; held: by root, 1 if supported. */
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

/* The smaller root stays the root, and inherits the support of the other group. */
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

/* Connects groups by joints. A free joint supports by its springs and stops only. */
static void pass_joints(const groups *g)
{
    const dmb_scene *scene = g->sim->scene;
    for (uint32_t j = 0; j < scene->joint_count; j++) {
        const dmb_scene_joint *joint = scene->joints + j;
        if (g->sim->joint_state[j] == DMB_JOINT_OPEN) continue;
        if (joint->kind == DMB_JOINT_FREE && g->sim->joint_state[j] == DMB_JOINT_ACTIVE && joint->law == DMB_NONE)
            continue;
        if (joint->a.node == DMB_NONE)
            hold(g, joint->b.node);
        else
            join(g, joint->a.node, joint->b.node);
    }
}

/* Connects groups by springs between points; node DMB_NONE: the ground. */
static void pass_springs(const groups *g)
{
    const dmb_scene *scene = g->sim->scene;
    for (uint32_t i = 0; i < scene->spring_count; i++) {
        const uint32_t a = scene->springs[i].a.node, b = scene->springs[i].b.node;
        if (a == DMB_NONE || b == DMB_NONE)
            hold(g, a == DMB_NONE ? b : a);
        else
            join(g, a, b);
    }
}

/* Nodes of the caller's equations and forces count as supported, because their effect is unknown. */
static void pass_callbacks(const groups *g)
{
    const dmb_scene *scene = g->sim->scene;
    for (uint32_t i = 0; i < scene->callback_count; i++)
        for (uint32_t k = 0; k < scene->callbacks[i].count; k++) hold(g, scene->callbacks[i].place[k].node);
    for (uint32_t i = 0; i < scene->force_count; i++)
        for (uint32_t k = 0; k < scene->forces[i].count; k++)
            if (scene->forces[i].joint[k] == DMB_NONE) hold(g, scene->forces[i].point[k].node);
}

static void pass_stuck(const groups *g)
{
    for (uint32_t i = 0; i < g->sim->scene->stuck_count; i++)
        if (g->sim->stuck_held[i]) hold(g, g->sim->scene->stuck[i].point.node);
}

/* Support by supports, drives, walls and rock. An axial-torsional node is supported by its axis. */
static void pass_nodes(const groups *g)
{
    const dmb_scene *scene = g->sim->scene;
    for (uint32_t i = 0; i < scene->constrained_count; i++) hold(g, scene->constrained_node[i]);
    for (uint32_t i = 0; i < scene->node_count; i++)
        if (scene->layout.size[i] == DMB_NODE_AXIAL_TORSIONAL) hold(g, i);
    for (uint32_t i = 0; i < scene->drive_count; i++)
        if (scene->drives[i].node != DMB_NONE) hold(g, scene->drives[i].node);
    for (uint32_t i = 0; i < scene->site_count; i++) hold(g, scene->sites[i].node);
    for (uint32_t i = 0; i < scene->bit_count; i++)
        if (scene->bits[i].law.kind != DMB_ROCK_NONE) hold(g, scene->bits[i].node);
}

static void count_unconstrained(const groups *g, dmb_unconstrained_parts *unconstrained)
{
    for (uint32_t i = 0; i < g->sim->scene->node_count; i++) {
        if (g->parent[i] != i || g->held[i]) continue;
        if (unconstrained->groups++ == 0) unconstrained->node = i;
    }
}

/* Connections first, then supports: hold() marks the root of the group as it is at that time, and join() carries marks
 * over, so that the order does not matter for the result. Without gravity nothing falls. */
int32_t dmb_find_unconstrained_parts(const dmb_sim *sim, dmb_unconstrained_parts *unconstrained)
{
    const size_t n = sim->scene->node_count, bytes = 2 * n * sizeof(uint32_t);
    unconstrained->groups = unconstrained->node = 0;
    if ((sim->scene->features & DMB_FEATURE_GRAVITY) == 0) return DMB_OK;
    uint32_t *block = dmb_allocate(&sim->allocator, bytes);
    if (block == NULL) return DMB_ERR_NO_MEMORY;
    const groups g = {sim, block, block + n};
    begin(&g);
    pass_joints(&g);
    pass_callbacks(&g);
    pass_springs(&g);
    pass_stuck(&g);
    pass_nodes(&g);
    count_unconstrained(&g, unconstrained);
    dmb_release(&sim->allocator, block, bytes);
    return DMB_OK;
}
