/* Axial-torsional nodes: rigid masses one by one; weight, damping and friction on the wall by the kernels
 * (kernel/lanes_axial_torsional_node.h), which compute the frame of the hole at each node once.
 *
 * The node follows the hole's axis, so that the wall balances all that acts across: weight and, in a bend, tension
 * times curvature (eq:drilling.wall-force). That normal force enters friction alone, whose tangent by the tension
 * couples the node with its two neighbours.
 *
 *                  before              after
 *     node - 1 ------------- node ------------- node + 1        tension: mean of both, or the only one */
#include <string.h>

#include "element/beam.h"
#include "kernel/kernels.h"
#include "math/mat6.h"
#include "math/se3.h"
#include "sim/node.h"
#include "system/assemble/assemble.h"
#include "system/assemble/evaluation.h"

/* Rigid mass on an axial-torsional node: only mass and inertia about the axis act. */
static void assemble_rigid_mass(dmb_evaluation *evaluation, const dmb_rigid_mass *rigid_mass)
{
    dmb_sim *sim = evaluation->sim;
    const uint32_t row = sim->scene->layout.row[rigid_mass->node];
    const double *v = sim->trial.velocity + row, *a = sim->trial.acceleration + row;
    const double f[6] = {-rigid_mass->mass * a[0], 0.0, 0.0, -rigid_mass->inertia[0] * a[1], 0.0, 0.0};
    evaluation->power[DMB_POWER_INERTIA] += v[0] * f[0] + v[1] * f[3];
    dmb_apply_wrench(sim, rigid_mass->node, f);
    if (!evaluation->tangent) return;
    dmb_inertia_of(sim, rigid_mass->node)[0] += evaluation->mass_factor * rigid_mass->mass;
    dmb_inertia_of(sim, rigid_mass->node)[3] += evaluation->mass_factor * rigid_mass->inertia[0];
}

/* ---- Tension --------------------------------------------------------------------------------------------------- */

/* [N] u: displacements of its nodes (eq:bar.force) */
static inline double stretch_force(const dmb_element_type *type, const double *u)
{
    return type->stiffness[0] * ((u[3] - u[0]) + (type->length - type->rest[0]));
}

/* [N] Tension of an element at the trial; the strain of a mixed element is stored. */
static double tension_of(const dmb_sim *sim, uint32_t element)
{
    const dmb_scene *scene = sim->scene;
    const dmb_element_type *type = scene->types + scene->element_type[element];
    const uint32_t a = scene->element_node[element];
    const double *u = sim->trial.displacement + 3 * (size_t)a;
    if (scene->layout.size[a] != DMB_NODE_AXIAL_TORSIONAL || scene->layout.size[a + 1] != DMB_NODE_AXIAL_TORSIONAL)
        return type->stiffness[0] * dmb_beam_stretch(type, sim->element_strain + 6 * (size_t)element);
    return stretch_force(type, u);
}

/* 1: tension of the element behind a node follows from the positions of axial-torsional nodes. */
static int is_stretched(const dmb_scene *scene, uint32_t node)
{
    return node + 1 < scene->node_count &&
           scene->layout.size[node] + scene->layout.size[node + 1] == 2 * DMB_NODE_AXIAL_TORSIONAL;
}

/* Mean tension of the elements on both sides of each node [N]. With mud it is the effective tension (eq:mud.effective),
 * by which elements are strained. */
static void find_tensions(const dmb_sim *sim, uint32_t first, uint32_t count, double *tension)
{
    const dmb_scene *scene = sim->scene;
    const double *u = sim->trial.displacement + 3 * (size_t)first;
    uint32_t element = dmb_element_between(scene, first, 0);
    double before = element != DMB_NONE ? tension_of(sim, element) : 0.0;
    for (uint32_t i = 0; i < count; i++, u += 3) {
        const uint32_t next = scene->node_element[first + i];
        double after = 0.0;
        if (next != DMB_NONE && is_stretched(scene, first + i))
            after = stretch_force(scene->types + scene->element_type[next], u);
        else if (next != DMB_NONE)
            after = tension_of(sim, next);
        const double both = element != DMB_NONE && next != DMB_NONE ? 2.0 : 1.0;
        tension[i] = (before + after) / both;
        element = next;
        before = after;
    }
}

/* [N/m, N] Derivative of the tension of an element by the rows of its two nodes: stretch between axial-torsional nodes;
 * the strain map of the beam, its axial-torsional side projected as its forces are, of a mixed one. In steps by pose
 * parameters. */
static void tension_by_rows(const dmb_evaluation *evaluation, uint32_t element, double by[2][6])
{
    const dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    const dmb_element_type *type = scene->types + scene->element_type[element];
    const uint32_t a = scene->element_node[element];
    const double *d = sim->element_strain + 6 * (size_t)element;
    double map[72];
    memset(by, 0, 12 * sizeof(double));
    by[0][0] = -type->stiffness[0];
    by[1][0] = type->stiffness[0];
    if (is_stretched(scene, a)) return;
    const double x[3] = {1.0, type->coupling[0] * (d[1] - type->rest[1]), type->coupling[1] * (d[2] - type->rest[2])};
    dmb_section_strain_map(type, d, map);
    for (uint32_t side = 0; side < 2; side++) {
        double row[6], columns[12], R[9], unused[3];
        dmb_se3_tangent T;
        for (uint32_t k = 0; k < 6; k++) {
            row[k] = 0.0;
            for (uint32_t i = 0; i < 3; i++) row[k] += type->stiffness[0] * x[i] * map[12 * i + 6 * side + k];
        }
        if (scene->layout.size[a + side] == DMB_NODE_SIX_DOF) {
            dmb_se3_tangent_at(sim->increment + scene->layout.row[a + side], NULL, &T);
            if (evaluation->dynamic) dmb_se3_tangent_apply_transpose(&T, row, row);
            dmb_vec6_copy(row, by[side]);
            continue;
        }
        dmb_node_pose(scene, &sim->trial, a + side, R, unused);
        dmb_axial_torsional_columns(scene, &sim->trial, a + side, R, columns);
        by[side][0] = dmb_vec6_dot(row, columns);
        by[side][1] = dmb_vec6_dot(row, columns + 6);
    }
}

/* Adds dF/dT dT/dq of one element to the rows of a node; `side`: the node is end 0 or 1 of the element. */
static void add_tension_of(const dmb_evaluation *evaluation, uint32_t node, uint32_t element, uint32_t side,
                           const double d[2])
{
    dmb_sim *sim = evaluation->sim;
    const dmb_block_layout *layout = &sim->scene->layout;
    const uint32_t other = side == 0 ? node + 1 : node - 1, columns = layout->size[other];
    double *beside = side == 0 ? sim->stiffness_upper + layout->link[node] : sim->stiffness_lower + layout->link[other];
    double by[2][6];
    tension_by_rows(evaluation, element, by);
    for (uint32_t k = 0; k < 2; k++) {
        for (uint32_t c = 0; c < 2; c++) dmb_stiffness_of(sim, node)[2 * k + c] += d[k] * by[side][c];
        for (uint32_t c = 0; c < columns; c++) beside[columns * k + c] += d[k] * by[1 - side][c];
    }
}

/* Adds dF/dT dT/dq of the elements on both sides to the rows of the node. */
static void add_tension_tangent(const dmb_evaluation *evaluation, uint32_t node, const double dF_dT[2])
{
    const dmb_scene *scene = evaluation->sim->scene;
    const uint32_t before = dmb_element_between(scene, node, 0), after = dmb_element_between(scene, node, 1);
    const double share = before != DMB_NONE && after != DMB_NONE ? 0.5 : 1.0;
    const double d[2] = {-share * dF_dT[0], -share * dF_dT[1]}; /* of the residual */
    if (before != DMB_NONE) add_tension_of(evaluation, node, before, 1, d);
    if (after != DMB_NONE) add_tension_of(evaluation, node, after, 0, d);
}

/* ---- Runs ------------------------------------------------------------------------------------------------------ */

/* [-] most nodes in one call of the kernels */
enum { CHUNK_NODES = 64 };

/* Nodes in a row that all have a contact point, the first one `site`, or none (DMB_NONE). */
typedef struct node_chunk {
    uint32_t node, count, site, reserved;
    double tension[CHUNK_NODES], by_tension[2 * CHUNK_NODES];
    dmb_friction_law sliding;
} node_chunk;

/* Chunk of nodes from `node` on, before `end`; `site` is the first contact point at or after it. */
static void next_chunk(const dmb_scene *scene, uint32_t node, uint32_t end, uint32_t site, node_chunk *chunk)
{
    const dmb_axial_torsional_site *sites = scene->axial_torsional_sites;
    const uint32_t most = end - node < CHUNK_NODES ? end - node : CHUNK_NODES;
    const uint32_t count = scene->axial_torsional_site_count;
    const int has = site < count && sites[site].node == node;
    /* contact points are in the order of their nodes, one at most on each */
    const int all = has && count - site >= most && sites[site + most - 1].node == node + most - 1;
    uint32_t n = all ? most : 1;
    while (n < most) {
        const uint32_t next = has ? site + n : site;
        if ((next < count && sites[next].node == node + n) != has) break;
        n++;
    }
    chunk->node = node;
    chunk->count = n;
    chunk->site = has ? site : DMB_NONE;
}

static dmb_axial_torsional_node_args args_of(const dmb_evaluation *evaluation, const node_chunk *chunk)
{
    const dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    const uint32_t row = scene->layout.row[chunk->node];
    const size_t node = chunk->node;
    const int32_t damped = evaluation->dynamic && scene->features & DMB_FEATURE_DAMPING;
    const dmb_axial_torsional_node_args args = {
        .count = chunk->count,
        .dynamic = evaluation->dynamic,
        .tangent = evaluation->tangent,
        .weighs = scene->features & DMB_FEATURE_GRAVITY,
        .step = evaluation->step,
        .velocity_factor = evaluation->velocity_factor,
        .load_factor = evaluation->load_factor,
        .gravity = scene->gravity,
        .hole = scene->has_hole ? &scene->hole : NULL,
        .depth = scene->reference_depth + node,
        .displacement = sim->trial.displacement + 3 * node,
        .quaternion = scene->reference_quaternion + 4 * node,
        .weight_mass = scene->weight_mass + node,
        .damping = damped ? scene->node_damping + 5 * node : NULL,
        .velocity = sim->trial.velocity + row,
        .residual = sim->residual + row,
        .scale = sim->scale_row + row,
        .inertia = sim->inertia_diagonal + scene->layout.diag[chunk->node],
        .stiffness = sim->stiffness_diagonal + scene->layout.diag[chunk->node],
        .potential = evaluation->power[DMB_POWER_POTENTIAL],
        .damping_power = evaluation->power[DMB_POWER_DAMPING],
        .friction_power = evaluation->power[DMB_POWER_FRICTION],
    };
    return args;
}

/* Steady sliding has no memory. In statics without an assumed slip there is no friction. */
static const dmb_friction_law *law_for(const dmb_evaluation *evaluation, node_chunk *chunk)
{
    const dmb_friction_law *law = &evaluation->sim->scene->friction_law;
    if (!evaluation->dynamic && !evaluation->slipping) return NULL;
    if (!dmb_friction_has_memory(law) || !evaluation->steady) return law;
    chunk->sliding = dmb_sliding_law(law);
    return &chunk->sliding;
}

/* In a straight hole the normal force is that of the weight, without tensions and their tangents. */
static void set_contact(const dmb_evaluation *evaluation, node_chunk *chunk, dmb_axial_torsional_node_args *args)
{
    const dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    const size_t site = chunk->site;
    const int curved = !dmb_hole_is_straight(&scene->hole);
    args->sites = scene->axial_torsional_sites + site;
    args->friction_law = law_for(evaluation, chunk);
    memcpy(args->slip, evaluation->slip, sizeof args->slip);
    args->now_slip = sim->now.axial_torsional_slip + 2 * site;
    args->trial_slip = sim->trial.axial_torsional_slip + 2 * site;
    args->friction = sim->trial.axial_torsional_friction + 2 * site;
    if (dmb_scene_has_bristles(scene)) {
        args->now_bristle = sim->now.axial_torsional_bristle + scene->friction_law.states * site;
        args->now_sticks = sim->now.axial_torsional_sticks + site;
        args->bristle = sim->trial.axial_torsional_bristle + scene->friction_law.states * site;
        args->sticks = sim->trial.axial_torsional_sticks + site;
    }
    if (!curved || args->friction_law == NULL) return;
    find_tensions(sim, chunk->node, chunk->count, chunk->tension);
    args->tension = chunk->tension;
    if (evaluation->tangent && !evaluation->inertia_only) args->by_tension = chunk->by_tension;
}

static void assemble_chunk(dmb_evaluation *evaluation, node_chunk *chunk)
{
    int32_t failed = 0;
    dmb_axial_torsional_node_args args = args_of(evaluation, chunk);
    args.failed = &failed;
    if (chunk->site != DMB_NONE) set_contact(evaluation, chunk, &args);
    const uint32_t tangents = args.by_tension != NULL ? chunk->count : 0;
    evaluation->sim->scene->kernels->axial_torsional_nodes(&args);
    if (failed) dmb_friction_failed(evaluation);
    evaluation->power[DMB_POWER_POTENTIAL] = args.potential;
    evaluation->power[DMB_POWER_DAMPING] = args.damping_power;
    evaluation->power[DMB_POWER_FRICTION] = args.friction_power;
    for (uint32_t i = 0; i < tangents; i++) {
        const double *by_tension = chunk->by_tension + 2 * (size_t)i;
        if (by_tension[0] != 0.0 || by_tension[1] != 0.0) add_tension_tangent(evaluation, chunk->node + i, by_tension);
    }
}

uint32_t dmb_assemble_axial_torsional_nodes(dmb_evaluation *evaluation, uint32_t first, uint32_t rigid_mass,
                                            uint32_t *site)
{
    const dmb_scene *scene = evaluation->sim->scene;
    node_chunk chunk;
    uint32_t end = first + 1;
    while (end < scene->node_count && scene->layout.size[end] == DMB_NODE_AXIAL_TORSIONAL) end++;
    for (; evaluation->dynamic && rigid_mass < scene->rigid_mass_count; rigid_mass++) {
        if (scene->rigid_masses[rigid_mass].node >= end) break;
        assemble_rigid_mass(evaluation, scene->rigid_masses + rigid_mass);
    }
    for (uint32_t i = first; i < end; i += chunk.count) {
        next_chunk(scene, i, end, *site, &chunk);
        assemble_chunk(evaluation, &chunk);
        if (chunk.site != DMB_NONE) *site += chunk.count;
    }
    return end - first;
}
