/* Forces of single nodes, in their own axes.
 *
 *     force                       residual                                 equation
 *     -------------------------   --------------------------------------   -------------------------------------
 *     rigid masses                M v' - ad_v^T M v                        eq:motion.rigid-mass, eq:motion.gyroscopic
 *     weight                      -(m R^T g; b x R^T g)                    eq:motion.weight
 *     external damping            C v, a constant matrix of the node
 *     added mass of rigid parts   M_a v' - ad_v^T M_a v                    eq:mud.kirchhoff
 *     flow of mud                 drag along the hole, thrust at the end   eq:mud.along, eq:mud.nozzle
 *     loads                       -w of the load, dead or follower
 *
 * Rigid masses and damping act in steps only, weight and loads times the load factor in statics as well. */
#include "system/assemble/assemble.h"

#include <string.h>

#include "element/added_mass.h"
#include "element/beam.h"
#include "kernel/kernels.h"
#include "math/mat6.h"
#include "sim/chunks.h"
#include "sim/node.h"
#include "system/assemble/evaluation.h"

/* ---- six-DOF nodes, by the kernels ----------------------------------------------------------------------------------
 */

/* Inputs and outputs of the kernels for `count` six-DOF nodes from `node` on; `rigid_mass` is the first candidate on
 * them. */
static dmb_node_force_args args_of(const dmb_evaluation *evaluation, uint32_t node, uint32_t count, uint32_t rigid_mass)
{
    const dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    const uint32_t row = scene->layout.row[node], diag = scene->layout.diag[node];
    const int32_t damped = evaluation->dynamic && scene->features & DMB_FEATURE_DAMPING;
    const dmb_node_force_args args = {
        .count = count,
        .first = node,
        .rigid_masses = scene->rigid_masses + rigid_mass,
        .rigid_mass_count = evaluation->dynamic ? scene->rigid_mass_count - rigid_mass : 0,
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
        .residual = sim->residual + row,
        .scale = sim->scale_row + row,
        .stiffness = sim->stiffness_diagonal + diag,
        .inertia = sim->inertia_diagonal + diag,
    };
    return args;
}

/* A run of six-DOF nodes, computed in chunks. */
typedef struct node_chunks {
    const dmb_evaluation *evaluation;
    uint32_t node, count, rigid_mass, pieces;
} node_chunks;

/* First rigid mass from `next` on at the node or after it; they are ordered by node. */
static uint32_t rigid_mass_from(const dmb_scene *scene, uint32_t next, uint32_t node)
{
    uint32_t end = scene->rigid_mass_count;
    while (next < end) {
        const uint32_t middle = next + (end - next) / 2;
        if (scene->rigid_masses[middle].node < node)
            next = middle + 1;
        else
            end = middle;
    }
    return next;
}

/* Chunks write rows of their own nodes only; their powers are added in order afterwards. */
static void make_pieces(void *work, uint32_t first, uint32_t end)
{
    const node_chunks *in = work;
    const dmb_sim *sim = in->evaluation->sim;
    for (uint32_t i = first; i < end; i++) {
        const uint32_t begin = dmb_chunk_begin(in->count, in->pieces, i), node = in->node + begin;
        const uint32_t count = dmb_chunk_begin(in->count, in->pieces, i + 1) - begin;
        dmb_node_force_args args =
            args_of(in->evaluation, node, count, rigid_mass_from(sim->scene, in->rigid_mass, node));
        sim->scene->kernels->node_forces(&args);
        const dmb_chunk_sums sums = {
            .potential = args.potential, .damping = args.damping_power, .inertia = args.inertia_power};
        sim->chunk_sums[i] = sums;
    }
}

static void assemble_chunks(dmb_evaluation *evaluation, uint32_t node, uint32_t count, uint32_t rigid_mass)
{
    const dmb_sim *sim = evaluation->sim;
    node_chunks in = {evaluation, node, count, rigid_mass, dmb_chunks_of(count)};
    dmb_chunks_run(sim, in.pieces, 1, make_pieces, &in);
    for (uint32_t i = 0; i < in.pieces; i++) {
        evaluation->power[DMB_POWER_INERTIA] += sim->chunk_sums[i].inertia;
        evaluation->power[DMB_POWER_POTENTIAL] += sim->chunk_sums[i].potential;
        evaluation->power[DMB_POWER_DAMPING] += sim->chunk_sums[i].damping;
    }
}

static void assemble_six_dof(dmb_evaluation *evaluation, uint32_t node, uint32_t count, uint32_t rigid_mass)
{
    dmb_node_force_args args = args_of(evaluation, node, count, rigid_mass);
    if (!args.gravity && !args.damping && !args.rigid_mass_count) return;
    if (dmb_chunks_of(count) > 1) {
        assemble_chunks(evaluation, node, count, rigid_mass);
        return;
    }
    args.inertia_power = evaluation->power[DMB_POWER_INERTIA];
    args.potential = evaluation->power[DMB_POWER_POTENTIAL];
    args.damping_power = evaluation->power[DMB_POWER_DAMPING];
    evaluation->sim->scene->kernels->node_forces(&args);
    evaluation->power[DMB_POWER_INERTIA] = args.inertia_power;
    evaluation->power[DMB_POWER_POTENTIAL] = args.potential;
    evaluation->power[DMB_POWER_DAMPING] = args.damping_power;
}

/* All nodes with their rigid masses and axial-torsional contact points in order. */
void dmb_assemble_nodes(dmb_evaluation *evaluation)
{
    const dmb_scene *scene = evaluation->sim->scene;
    const int32_t acting = scene->features & (DMB_FEATURE_GRAVITY | DMB_FEATURE_DAMPING);
    if (!acting && scene->rigid_mass_count == 0 && scene->axial_torsional_site_count == 0) return;
    for (uint32_t i = 0, rigid_mass = 0, site = 0, count; i < scene->node_count; i += count) {
        count = dmb_six_dof_nodes_at(scene, i);
        while (rigid_mass < scene->rigid_mass_count && scene->rigid_masses[rigid_mass].node < i) rigid_mass++;
        if (count > 0)
            assemble_six_dof(evaluation, i, count, rigid_mass);
        else
            count = dmb_assemble_axial_torsional_nodes(evaluation, i, rigid_mass, &site);
    }
}

/* ---- Mud --------------------------------------------------------------------------------------------------------- */

/* As a rigid mass whose translational mass depends on the direction: p is not parallel to u, and the cross product of
 * both is Munk's moment. */
static void assemble_added_mass(dmb_evaluation *evaluation, const dmb_added_mass *added)
{
    dmb_sim *sim = evaluation->sim;
    double v[6], a[6], p[6], f[6], turning[6];
    dmb_node_vector(sim->scene, &sim->trial, added->node, sim->trial.velocity, v);
    dmb_node_vector(sim->scene, &sim->trial, added->node, sim->trial.acceleration, a);
    dmb_added_mass_times(added, v, p);
    dmb_added_mass_times(added, a, f);
    dmb_ad_transpose(v, p, turning);
    for (int i = 0; i < 6; i++) f[i] = turning[i] - f[i];
    evaluation->power[DMB_POWER_INERTIA] += dmb_vec6_dot(v, f);
    dmb_apply_wrench(sim, added->node, f);
    if (evaluation->tangent)
        dmb_added_mass_add_tangent(added, v, p, evaluation->mass_factor, evaluation->velocity_factor,
                                   dmb_inertia_of(sim, added->node));
}

/* An axial-torsional node moves along its x axis. */
static void assemble_axial_torsional_added_mass(dmb_evaluation *evaluation, const dmb_added_mass *added)
{
    dmb_sim *sim = evaluation->sim;
    const uint32_t row = sim->scene->layout.row[added->node];
    const double f[6] = {-added->along * sim->trial.acceleration[row]};
    evaluation->power[DMB_POWER_INERTIA] += sim->trial.velocity[row] * f[0];
    dmb_apply_wrench(sim, added->node, f);
    if (evaluation->tangent) dmb_inertia_of(sim, added->node)[0] += evaluation->mass_factor * added->along;
}

void dmb_assemble_added_masses(dmb_evaluation *evaluation)
{
    const dmb_scene *scene = evaluation->sim->scene;
    for (uint32_t i = 0; i < scene->added_mass_count; i++) {
        const dmb_added_mass *added = scene->added_masses + i;
        if (scene->layout.size[added->node] == DMB_NODE_SIX_DOF)
            assemble_added_mass(evaluation, added);
        else
            assemble_axial_torsional_added_mass(evaluation, added);
    }
}

/* Flow of mud: its force on a node is along the hole's axis there, the direction of pressure gradient and shear in a
 * narrow annulus (tilted pipe: Taylor 1952; Paidoussis 2014). With the tangent t(s) at the depth s of the node, and b =
 * (lever, 0, 0), it is f = -pull R^T t, m = -b x R^T t, d(R^T t) = (R^T t)~ dtheta + R^T dt/ds J t.R dx, J = ds/dx of a
 * point beside the axis. */
static void pull_six_dof(dmb_evaluation *evaluation, uint32_t node, const double pull[2])
{
    dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    double R[9], u[3], x[3], point[3], t[3], bend[3], s, along[3], turn[3], K[36] = {0.0};
    dmb_node_pose(scene, &sim->trial, node, R, u);
    dmb_vec3_add(scene->reference_position + 3 * (size_t)node, u, x);
    uint32_t segment = dmb_node_segment(scene, &sim->now, node, 0.0, x);
    dmb_hole_project(&scene->hole, x, &s, &segment, point, t);
    dmb_mat3_tvec(R, t, along);
    const double w[6] = {-pull[0] * along[0], -pull[0] * along[1], -pull[0] * along[2], 0.0,
                         pull[1] * along[2],  -pull[1] * along[1]};
    dmb_apply_wrench(sim, node, w);
    if (evaluation->dynamic)
        evaluation->power[DMB_POWER_LOADS] += dmb_vec6_dot(w, sim->trial.velocity + scene->layout.row[node]);
    if (!evaluation->tangent) return;
    dmb_hole_frame(&scene->hole, s, u, NULL, bend);
    dmb_vec3_sub(x, point, x);
    dmb_mat3_tvec(R, bend, turn);
    const double J = 1.0 / (1.0 - dmb_vec3_dot(x, bend));
    dmb_mat6_add_skew(1.0, along, 0, 1, K); /* of R^T t, in the upper rows */
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) K[6 * r + c] = J * turn[r] * along[c];
    for (int c = 0; c < 6; c++) {
        K[24 + c] = pull[1] * K[12 + c];
        K[30 + c] = -pull[1] * K[6 + c];
        for (int r = 0; r < 3; r++) K[6 * r + c] *= -pull[0];
    }
    dmb_mat6_axpy(-1.0, K, dmb_stiffness_of(sim, node));
}

/* A force along the axis of an axial-torsional node rotates with it and has no tangent in its frame. */
static void pull_along(dmb_evaluation *evaluation, uint32_t node, double pull)
{
    dmb_sim *sim = evaluation->sim;
    const uint32_t row = sim->scene->layout.row[node];
    sim->residual[row] += pull;
    sim->scale_row[row] += fabs(pull);
    if (evaluation->dynamic) evaluation->power[DMB_POWER_LOADS] -= pull * sim->trial.velocity[row];
}

/* The drag acts on nodes; the thrust of the nozzle on the end of the first string, towards the rig. */
void dmb_assemble_flow(dmb_evaluation *evaluation)
{
    const dmb_scene *scene = evaluation->sim->scene;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        const double *node = scene->flow_node + 2 * (size_t)i, factor = evaluation->load_factor;
        const double pull[2] = {factor * node[0], factor * node[1]};
        if (!(node[0] > 0.0)) continue;
        if (scene->layout.size[i] == DMB_NODE_SIX_DOF)
            pull_six_dof(evaluation, i, pull);
        else
            pull_along(evaluation, i, pull[0]);
    }
    pull_along(evaluation, scene->strings[0].end_node, evaluation->load_factor * dmb_nozzle_thrust(&scene->flow));
}

/* Described loads: dead (world or hole frame) and follower (body frame), each times its time function. */

/* Axes of the components of a dead load, world: those of the hole at the closest point of its axis, or the world's own.
 */
static void frame_of_load(const dmb_sim *sim, const dmb_configuration *c, const dmb_scene_load *load, double R[9])
{
    const dmb_scene *scene = sim->scene;
    if (load->frame == DMB_FRAME_HOLE) { /* compile requires a hole for it */
        double x[3], u[3], unused[9], point[3], tangent[3], s;
        dmb_node_pose(scene, c, load->node, unused, u);
        dmb_vec3_add(scene->reference_position + 3 * (size_t)load->node, u, x);
        uint32_t segment = dmb_node_segment(scene, &sim->now, load->node, 0.0, x);
        dmb_hole_project(&scene->hole, x, &s, &segment, point, tangent);
        dmb_hole_frame_rotation(&scene->hole, s, R);
    } else {
        dmb_mat3_identity(R);
    }
}

/* Body-frame wrench at the point of a load. */
static void wrench_of(const dmb_sim *sim, const dmb_scene_load *load, double factor, double w[6])
{
    double R[9], body[9], f[3], unused[3];
    dmb_vec3_scale(factor, load->force, w);
    dmb_vec3_scale(factor, load->moment, w + 3);
    if (load->frame == DMB_FRAME_BODY) return;
    frame_of_load(sim, &sim->trial, load, R);
    dmb_node_pose(sim->scene, &sim->trial, load->node, body, unused);
    for (int k = 0; k < 6; k += 3) {
        dmb_mat3_vec(R, w + k, f);
        dmb_mat3_tvec(body, f, w + k);
    }
}

/* A load in the axes of a bent hole turns with the depth of its node: the derivative of its wrench by the depth, in
 * body axes of the load's point, R^T (rate x F), and of the depth by displacements of the node, J R^T t as in
 * pull_six_dof (eq:motion.turn). 0: it does not turn. */
static int turn_with_depth(const dmb_sim *sim, const dmb_scene_load *load, const double point_axes[9], double factor,
                           double by_depth[6], double depth_by[3])
{
    const dmb_scene *scene = sim->scene;
    double R[9], body[9], u[3], x[3], point[3], t[3], bend[3], rate[3], s;
    if (load->frame != DMB_FRAME_HOLE || dmb_hole_is_straight(&scene->hole)) return 0;
    dmb_node_pose(scene, &sim->trial, load->node, body, u);
    dmb_vec3_add(scene->reference_position + 3 * (size_t)load->node, u, x);
    uint32_t segment = dmb_node_segment(scene, &sim->now, load->node, 0.0, x);
    dmb_hole_project(&scene->hole, x, &s, &segment, point, t);
    dmb_hole_frame_rotation(&scene->hole, s, R);
    dmb_hole_frame(&scene->hole, s, u, NULL, bend);
    dmb_hole_frame_rate(t, bend, rate);
    for (int k = 0; k < 6; k += 3) {
        double f[3], turned[3];
        dmb_mat3_vec(R, k == 0 ? load->force : load->moment, f);
        dmb_vec3_scale(factor, f, f);
        dmb_vec3_cross(rate, f, turned);
        dmb_mat3_tvec(point_axes, turned, by_depth + k);
    }
    dmb_vec3_sub(x, point, x);
    dmb_mat3_tvec(body, t, depth_by);
    dmb_vec3_scale(1.0 / (1.0 - dmb_vec3_dot(x, bend)), depth_by, depth_by);
    return 1;
}

void dmb_add_turn(const dmb_evaluation *evaluation, double factor, const double by_depth[6], const double depth_by[6],
                  double K[36])
{
    const double part = evaluation->turn_halves ? 0.5 * factor : factor;
    dmb_mat6_add_outer(part, by_depth, depth_by, K);
    if (evaluation->turn_halves) dmb_mat6_add_outer(part, depth_by, by_depth, K);
}

/* -dw/dq of a load at a six-DOF node: d(R^T f) = (R^T f)~ dtheta, and the turn of the hole's axes with the depth. w:
 * wrench at the load's point. */
static void add_load_tangent(dmb_evaluation *evaluation, const dmb_scene_load *load, double factor, const double w[6])
{
    const dmb_sim *sim = evaluation->sim;
    double K[36] = {0.0}, by_depth[6], depth_by[6] = {0.0}, body[9], unused[3];
    dmb_mat6_add_skew(1.0, w, 0, 1, K);
    dmb_mat6_add_skew(1.0, w + 3, 1, 1, K);
    dmb_beam_block_to_nodes(load->arm, 0.0, K);
    dmb_node_pose(sim->scene, &sim->trial, load->node, body, unused);
    if (turn_with_depth(sim, load, body, factor, by_depth, depth_by)) {
        dmb_arm_wrench(load->arm, by_depth);
        dmb_add_turn(evaluation, 1.0, by_depth, depth_by, K);
    }
    dmb_mat6_axpy(-1.0, K, dmb_stiffness_of(sim, load->node));
}

/* An axial-torsional node in a bend advances along a tangent that turns by the curvature: the components of a load in
 * world axes along and about it change with the depth (eq:motion.weight-along). Those in hole axes do not. */
static void add_axial_torsional_load_tangent(dmb_evaluation *evaluation, const dmb_scene_load *load, double factor)
{
    const dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    double point[3], bend[3], *K = dmb_stiffness_of(sim, load->node);
    if (load->frame != DMB_FRAME_WORLD || !scene->has_hole || dmb_hole_is_straight(&scene->hole)) return;
    dmb_hole_frame(&scene->hole, dmb_axial_torsional_depth(scene, &sim->trial, load->node), point, NULL, bend);
    K[0] -= factor * dmb_vec3_dot(load->force, bend);
    K[2] -= factor * dmb_vec3_dot(load->moment, bend);
}

static void assemble_load(dmb_evaluation *evaluation, const dmb_scene_load *load, double factor)
{
    dmb_sim *sim = evaluation->sim;
    double w[6], v[6], frame[9];
    factor *= evaluation->load_factor;
    if (load->point != DMB_NONE) {
        frame_of_load(sim, &sim->trial, load, frame);
        dmb_assemble_point_load(evaluation, load, factor, frame);
        return;
    }
    wrench_of(sim, load, factor, w);
    if (evaluation->tangent && load->frame != DMB_FRAME_BODY) {
        if (sim->scene->layout.size[load->node] == DMB_NODE_SIX_DOF)
            add_load_tangent(evaluation, load, factor, w);
        else
            add_axial_torsional_load_tangent(evaluation, load, factor);
    }
    dmb_arm_wrench(load->arm, w);
    dmb_apply_wrench(sim, load->node, w);
    if (!evaluation->dynamic) return;
    dmb_node_vector(sim->scene, &sim->trial, load->node, sim->trial.velocity, v);
    evaluation->power[DMB_POWER_LOADS] += dmb_vec6_dot(w, v);
}

void dmb_assemble_loads(dmb_evaluation *evaluation)
{
    const dmb_sim *sim = evaluation->sim;
    for (uint32_t i = 0; i < sim->scene->load_count; i++)
        assemble_load(evaluation, sim->scene->loads + i, sim->trial.load_factor[i]);
}

/* ---- Loads at points --------------------------------------------------------------------------------------------- */

/* The turn of the hole's axes with the depth of the load's node, a node of the point. */
static void add_turn(const dmb_evaluation *evaluation, const dmb_scene_load *load, double factor,
                     const dmb_point_motion *m, dmb_force_tangent *t)
{
    const dmb_scene *scene = evaluation->sim->scene;
    double by_depth[6], depth_by[3], values[DMB_POINT_COLUMNS] = {0.0};
    double row[DMB_CONSTRAINT_COLUMNS] = {0.0}, column[DMB_CONSTRAINT_COLUMNS] = {0.0};
    if (!turn_with_depth(evaluation->sim, load, m->R, factor, by_depth, depth_by)) return;
    for (uint32_t n = 0; n < m->nodes; n++)
        if (m->node[n] == load->node) dmb_vec3_copy(depth_by, values + 6 * n);
    dmb_force_tangent_row(scene, t, m, by_depth, row);
    dmb_force_tangent_columns(scene, t, m, values, column);
    const double other = evaluation->turn_halves ? 0.5 : 0.0;
    for (uint32_t r = 0; r < t->columns; r++)
        for (uint32_t c = 0; c < t->columns; c++)
            t->K[(size_t)r * t->columns + c] -= (1.0 - other) * row[r] * column[c] + other * column[r] * row[c];
}

/* By displacements of the nodes, the body rotating under a dead load, d(R^T f) = (R^T f) x theta, and by the change of
 * the map: -map^T (w_f x theta; w_m x theta) - d(map^T) w. */
static void add_tangent(dmb_evaluation *evaluation, const dmb_scene_load *load, double factor,
                        const dmb_point_motion *m, const double w[6])
{
    const dmb_scene *scene = evaluation->sim->scene;
    dmb_force_tangent t;
    double A[144];
    dmb_force_tangent_begin(&t);
    dmb_force_tangent_touch(scene, m, &t);
    dmb_force_tangent_clear(&t);
    dmb_point_map_tangent(scene, m, w, A);
    dmb_force_tangent_block(scene, &t, m, -1.0, A);
    for (int i = 0; i < 6 && load->frame != DMB_FRAME_BODY; i++) {
        double e[3] = {0.0}, unit[6] = {0.0}, turn[6] = {0.0};
        double move[DMB_CONSTRAINT_COLUMNS] = {0.0}, change[DMB_CONSTRAINT_COLUMNS] = {0.0};
        e[i % 3] = unit[i] = 1.0;
        dmb_vec3_cross(e, i < 3 ? w : w + 3, turn + 3); /* e . (w x theta) = (e x w) . theta */
        dmb_force_tangent_row(scene, &t, m, unit, move);
        dmb_force_tangent_row(scene, &t, m, turn, change);
        for (uint32_t r = 0; r < t.columns; r++)
            for (uint32_t c = 0; c < t.columns; c++) t.K[(size_t)r * t.columns + c] -= move[r] * change[c];
    }
    add_turn(evaluation, load, factor, m, &t);
    dmb_force_tangent_add(evaluation, DMB_NONE, DMB_BY_DISPLACEMENT, &t);
}

/* Wrench in the axes of the point; frame: of a dead load. */
static void point_wrench(const dmb_scene_load *load, double factor, const double frame[9], const double R[9],
                         double w[6])
{
    double f[3];
    dmb_vec3_scale(factor, load->force, w);
    dmb_vec3_scale(factor, load->moment, w + 3);
    for (int k = 0; k < 6 && load->frame != DMB_FRAME_BODY; k += 3) {
        dmb_mat3_vec(frame, w + k, f);
        dmb_mat3_tvec(R, f, w + k);
    }
}

void dmb_point_load_of(const dmb_sim *sim, const dmb_configuration *configuration, uint32_t load, double w[6])
{
    const dmb_scene_load *of = sim->scene->loads + load;
    dmb_point_motion m;
    double frame[9];
    dmb_point_motion_of(sim->scene, configuration, sim->scene->load_points + of->point, &m);
    frame_of_load(sim, configuration, of, frame);
    point_wrench(of, configuration->load_factor[load], frame, m.R, w);
}

void dmb_assemble_point_load(dmb_evaluation *evaluation, const dmb_scene_load *load, double factor,
                             const double frame[9])
{
    dmb_sim *sim = evaluation->sim;
    dmb_point_motion m;
    double w[6];
    dmb_point_motion_of(sim->scene, &sim->trial, sim->scene->load_points + load->point, &m);
    point_wrench(load, factor, frame, m.R, w);
    dmb_point_apply(sim, &m, w);
    if (evaluation->tangent) add_tangent(evaluation, load, factor, &m, w);
    if (evaluation->dynamic) evaluation->power[DMB_POWER_LOADS] += dmb_vec6_dot(w, m.V);
}
