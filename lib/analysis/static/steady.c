/* Velocities, residual and tangent of a steady state (static.h). One evaluation:
 *
 *     1. dmb_steady_move      V and V' of all nodes at the trial's poses (eq:sliding.motion), joints included
 *     2. read_damping         C = dr/dV, only if a tangent is requested
 *     3. dmb_system_evaluate  r(H, V, V') and dr/dH, as in a step, with friction, damping and rock cutting
 *     4. K += C ad(g)         because V follows the pose (eq:sliding.tangent) */
#include "analysis/static/static.h"

#include <string.h>

#include "analysis/linear/linear.h"
#include "math/mat6.h"
#include "math/so3.h"
#include "sim/layout.h"
#include "sim/node.h"
#include "system/assemble/assemble.h"
#include "system/assemble/drives.h"
#include "system/constrain/constrain.h"

/* ---- Velocities and accelerations -------------------------------------------------------------------------------- */

static void position_of(const dmb_sim *sim, uint32_t node, double R[9], double x[3])
{
    dmb_node_pose(sim->scene, &sim->trial, node, R, x);
    dmb_vec3_add(x, sim->scene->reference_position + 3 * (size_t)node, x);
}

/* V = Ad(H^-1) X (eq:kinematics.adjoint): all nodes share the world twist X, each in its own axes. The body-frame
 * velocities are constant, so that V' = 0. */
static void move_rigid(dmb_steady *steady, dmb_sim *sim, double factor)
{
    const dmb_scene *scene = sim->scene;
    double twist[6];
    for (int i = 0; i < 6; i++) twist[i] = factor * steady->twist[i];
    for (uint32_t i = 0; i < scene->node_count; i++) {
        double R[9], x[3];
        position_of(sim, i, R, x);
        dmb_adjoint_inverse_apply(R, x, twist, sim->trial.velocity + scene->layout.row[i]);
    }
    memcpy(steady->frame_velocity, sim->trial.velocity, scene->row_count * sizeof(double));
    memset(sim->trial.acceleration, 0, scene->row_count * sizeof(double));
}

/* g = (R^T v t; R^T (v t x k)), V = g + w, V' = -ad(w) g (eq:sliding.motion). */
static void slide_node(dmb_steady *steady, dmb_sim *sim, uint32_t node, double v, double spin)
{
    const dmb_scene *scene = sim->scene;
    const uint32_t row = scene->layout.row[node];
    double R[9], x[3], along[3], frame_rate[3] = {0.0, 0.0, 0.0};
    double *g = steady->frame_velocity + row, *V = sim->trial.velocity + row, *a = sim->trial.acceleration + row;
    position_of(sim, node, R, x);
    if (scene->has_hole) {
        double point[3], curvature[3], s;
        uint32_t segment = dmb_node_segment(scene, &sim->now, node, 0.0, x);
        dmb_hole_project(&scene->hole, x, &s, &segment, point, along);
        dmb_hole_frame(&scene->hole, s, point, NULL, curvature);
        dmb_vec3_cross(along, curvature, frame_rate);
        dmb_mat3_tvec(R, along, g);
        dmb_mat3_tvec(R, frame_rate, g + 3);
    } else {
        dmb_vec3_set(1.0, 0.0, 0.0, g);
        dmb_vec3_zero(g + 3);
    }
    for (int i = 0; i < 6; i++) V[i] = g[i] = v * g[i];
    V[3] += spin;
    const double w[6] = {0.0, 0.0, 0.0, spin, 0.0, 0.0};
    dmb_ad_apply(w, g, a);
    for (int i = 0; i < 6; i++) a[i] = -a[i];
}

/* Velocities of all string nodes. Each loop overwrites the one before: motion along the hole, then supports (0), then
 * motion drives, whose rows are constrained, too. The frame velocity g of a driven row follows along the hole only: the
 * rotation by a drive is the spin w, which the axes of g do not share. */
static void slide_strings(dmb_steady *steady, dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        const uint32_t s = steady->string[i], row = scene->layout.row[i];
        if (s == DMB_NONE) continue;
        const double v = steady->speed[2 * s], spin = steady->speed[2 * s + 1];
        if (scene->layout.size[i] == DMB_NODE_SIX_DOF) {
            slide_node(steady, sim, i, v, spin);
        } else {
            sim->trial.velocity[row] = v;
            sim->trial.velocity[row + 1] = spin;
            sim->trial.acceleration[row] = sim->trial.acceleration[row + 1] = 0.0;
        }
    }
    for (uint32_t i = 0; i < scene->constrained_count; i++) { /* a constrained end does not follow the curved hole */
        const uint32_t node = scene->constrained_node[i],
                       row = scene->layout.row[node] + scene->constrained_component[i];
        sim->trial.velocity[row] = sim->trial.acceleration[row] = steady->frame_velocity[row] = 0.0;
    }
    for (uint32_t i = 0; i < scene->drive_count; i++) {
        const dmb_scene_drive *drive = scene->drives + i;
        if (drive->kind != DMB_DRIVE_MOTION || drive->row == DMB_NONE) continue;
        sim->trial.velocity[drive->row] = sim->trial.drives[i].target;
        if (drive->component == 0) steady->frame_velocity[drive->row] = sim->trial.drives[i].target;
    }
}

/* [-] largest change of velocity in rows of strings (all: in all rows), relative to the largest velocity before. */
static double change_of(const dmb_steady *steady, const dmb_sim *sim, const double *before, int all)
{
    const dmb_scene *scene = sim->scene;
    double most = 0.0, change = 0.0;
    for (uint32_t i = 0; i < scene->node_count; i++)
        for (uint32_t r = scene->layout.row[i]; r < scene->layout.row[i] + scene->layout.size[i]; r++) {
            most = fmax(most, fabs(before[r]));
            if (all || steady->string[i] != DMB_NONE) change = fmax(change, fabs(sim->trial.velocity[r] - before[r]));
        }
    return most > 0.0 ? change / most : 0.0;
}

/* [-] Largest change that joints may make to the prescribed speeds, relative to the largest speed, and number of
 * projections of slide_bodies. The projections go on to a thousandth of that bound: their own error does not decide the
 * check. */
#define DMB_STEADY_JOINTS 1e-9
#define DMB_STEADY_TRIES 300

/* Velocities of bodies that joints connect to strings of given motion: alternating projections onto the velocities that
 * the joints permit and onto the given ones of the strings. They converge to a common point if one exists; otherwise
 * `violation` remains, and dmb_steady_check_joints refuses the motion. The strings come last and keep their speeds
 * exactly. */
static int32_t slide_bodies(dmb_steady *steady, dmb_evaluation *evaluation)
{
    dmb_sim *sim = evaluation->sim;
    const size_t bytes = sim->scene->row_count * sizeof(double);
    int32_t status = DMB_OK;
    for (int k = 0; k < DMB_STEADY_TRIES && status >= 0; k++) {
        memcpy(steady->before, sim->trial.velocity, bytes);
        status = dmb_clusters_settle(evaluation, DMB_SETTLE_SPEED | DMB_SETTLE_ACCELERATION, 0);
        steady->violation = change_of(steady, sim, steady->before, 0);
        slide_strings(steady, sim);
        if (steady->violation <= 1e-3 * DMB_STEADY_JOINTS) break;
    }
    return status;
}

int32_t dmb_steady_move(dmb_steady *steady, dmb_evaluation *evaluation, double factor)
{
    dmb_sim *sim = evaluation->sim;
    if (steady->kind == DMB_STEADY_RIGID) {
        move_rigid(steady, sim, factor);
        return DMB_OK;
    }
    slide_strings(steady, sim);
    return sim->scene->cluster_count ? slide_bodies(steady, evaluation) : DMB_OK;
}

/* Joint violation of rigid motion: joints must permit the velocity of the whole scene as one body. */
static int32_t violation_of_rigid(dmb_steady *steady, dmb_evaluation *evaluation)
{
    dmb_sim *sim = evaluation->sim;
    memcpy(steady->before, sim->trial.velocity, sim->scene->row_count * sizeof(double));
    const int32_t status = dmb_clusters_settle(evaluation, DMB_SETTLE_SPEED, 0);
    steady->violation = change_of(steady, sim, steady->before, 1);
    return status;
}

/* Velocities 0 of nodes outside strings: start of the projections of slide_bodies. */
static void rest_bodies(const dmb_steady *steady, dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0; i < scene->node_count; i++)
        for (uint32_t r = scene->layout.row[i]; r < scene->layout.row[i] + scene->layout.size[i]; r++)
            if (steady->string[i] == DMB_NONE) sim->trial.velocity[r] = sim->trial.acceleration[r] = 0.0;
}

int32_t dmb_steady_check_joints(dmb_steady *steady, dmb_evaluation *evaluation)
{
    dmb_sim *sim = evaluation->sim;
    if (sim->scene->cluster_count == 0) return DMB_OK;
    dmb_configuration_copy(sim, &sim->now, &sim->trial);
    memset(sim->increment, 0, sim->scene->row_count * sizeof(double));
    sim->reduced_mode->row = DMB_NONE;
    int32_t status = dmb_system_prescribe(evaluation);
    rest_bodies(steady, sim);
    if (status >= 0) status = dmb_steady_move(steady, evaluation, 1.0);
    if (status >= 0 && steady->kind == DMB_STEADY_RIGID) status = violation_of_rigid(steady, evaluation);
    if (status == DMB_ERR_CALLBACK) return status;
    if (status >= 0 && steady->violation <= DMB_STEADY_JOINTS) return DMB_OK;
    dmb_message_set(
        &sim->message,
        "static: joints do not allow %s at the speeds of the drives, which they change by %g of the largest, must "
        "be <= %g; take DMB_STEADY_AT_REST",
        steady->kind == DMB_STEADY_RIGID ? "the whole to turn as one body" : "strings to slide and turn",
        steady->violation, DMB_STEADY_JOINTS);
    return DMB_ERR_UNSUPPORTED;
}

/* [-] Largest velocity of a coordinate with a spring, as a fraction of the largest velocity. */
#define DMB_STEADY_SPRING 1e-6

/* World velocity [m/s] of a point, and angular velocity [rad/s] of its axes. */
static void world_motion(const dmb_point_motion *point, double v[3], double w[3])
{
    dmb_mat3_vec(point->R, point->V, v);
    dmb_mat3_vec(point->R, point->V + 3, w);
}

/* The force of a spring between points is steady if both are at rest, or move as one rigid body: its length is then
 * constant, and it rotates with the parts it connects. */
static int32_t check_line(dmb_sim *sim, uint32_t i, double bound)
{
    const dmb_scene *scene = sim->scene;
    dmb_spring_motion m;
    double va[3], vb[3], wa[3], wb[3], along[3], off[3], turn[3];
    dmb_spring_motion_of(scene, &sim->trial, i, 1, &m);
    world_motion(&m.a, va, wa);
    world_motion(&m.b, vb, wb);
    if (dmb_vec3_norm(va) <= bound && dmb_vec3_norm(vb) <= bound) return DMB_OK;
    dmb_vec3_scale(m.length, m.n, along);
    dmb_vec3_cross(wa, along, off);
    dmb_vec3_add(off, va, off);
    dmb_vec3_sub(vb, off, off);
    dmb_vec3_sub(wb, wa, turn);
    if (dmb_vec3_norm(off) <= bound && dmb_vec3_norm(turn) * m.length <= bound && m.a.nodes > 0 && m.b.nodes > 0)
        return DMB_OK;
    dmb_message_set(
        &sim->message,
        "static: spring %u: its points move at %g and %g m/s, must stand still or move as one rigid body in "
        "a steady state; take DMB_STEADY_AT_REST",
        i, dmb_vec3_norm(va), dmb_vec3_norm(vb));
    return DMB_ERR_UNSUPPORTED;
}

/* A caller's force on moving parts is refused, because its dependence on the motion is unknown. */
static int32_t check_caller_force(dmb_sim *sim, uint32_t i, double bound)
{
    const dmb_scene_force *force = sim->scene->forces + i;
    for (uint32_t k = 0; k < force->count; k++) {
        dmb_point_motion point;
        double speed;
        if (force->joint[k] == DMB_NONE) {
            dmb_point_motion_of(sim->scene, &sim->trial, force->point + k, &point);
            speed = dmb_vec3_norm(point.V) + dmb_vec3_norm(point.V + 3);
        } else {
            dmb_relative relative;
            dmb_joint_motion_of(sim->scene, &sim->trial, force->joint[k], &relative, NULL);
            speed = dmb_vec3_norm(relative.V) + dmb_vec3_norm(relative.V + 3);
        }
        if (speed <= bound) continue;
        dmb_message_set(&sim->message,
                        "static: force %u: place %u moves at %g, must stand still in a steady state, since a caller's "
                        "force may change with it; take DMB_STEADY_AT_REST",
                        i, k, speed);
        return DMB_ERR_UNSUPPORTED;
    }
    return DMB_OK;
}

/* A stuck point must be at rest in a steady state. */
static int32_t check_stuck(dmb_sim *sim, uint32_t i, double bound)
{
    dmb_point_motion point;
    dmb_message name;
    if (!sim->stuck_held[i]) return DMB_OK;
    dmb_point_motion_of(sim->scene, &sim->trial, &sim->scene->stuck[i].point, &point);
    const double speed = dmb_vec3_norm(point.V) + dmb_vec3_norm(point.V + 3);
    if (speed <= bound) return DMB_OK;
    dmb_message_set(
        &sim->message, "static: %s moves at %g, must stand still, since it is held; take DMB_STEADY_AT_REST",
        dmb_part_text(&name, "stuck", i, sim->scene->stuck[i].name, sizeof sim->scene->stuck[i].name), speed);
    return DMB_ERR_UNSUPPORTED;
}

static int32_t check_lines(dmb_sim *sim, double most)
{
    int32_t status = DMB_OK;
    for (uint32_t i = 0; i < sim->scene->stuck_count && status >= 0; i++)
        status = check_stuck(sim, i, DMB_STEADY_SPRING * most);
    for (uint32_t i = 0; i < sim->scene->force_count && status >= 0; i++)
        status = check_caller_force(sim, i, DMB_STEADY_SPRING * most);
    for (uint32_t i = 0; i < sim->scene->spring_count && status >= 0; i++)
        status = check_line(sim, i, DMB_STEADY_SPRING * most);
    return status;
}

/* A joint coordinate with a spring must rest: J V = 0, with the row J of the coordinate (eq:joints.coordinates).
 * Coordinates with a damper alone may move, because their force is constant at a constant rate. */
int32_t dmb_steady_check_springs(const dmb_evaluation *evaluation)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    double most = 0.0;
    for (uint32_t i = 0; i < scene->row_count; i++) most = fmax(most, fabs(sim->trial.velocity[i]));
    for (uint32_t j = 0; j < scene->joint_count; j++) {
        const dmb_scene_joint *joint = scene->joints + j;
        dmb_relative relative;
        dmb_joint_coordinates c;
        if (joint->law == DMB_NONE || sim->joint_state[j] == DMB_JOINT_OPEN) continue;
        dmb_joint_motion_of(scene, &sim->trial, j, &relative, NULL);
        dmb_joint_coordinates_in(evaluation, j, &relative, &c);
        for (int i = 0; i < 6; i++) {
            const double speed = dmb_vec6_dot(c.J[i], relative.V);
            if ((joint->law_mask >> i & 1) == 0 || scene->laws[joint->law + (uint32_t)i].stiffness == 0.0) continue;
            if (fabs(speed) <= DMB_STEADY_SPRING * most) continue;
            dmb_message_set(
                &sim->message,
                "static: joint %u: its spring along coordinate %d changes at a speed of %g, must be 0 in a steady "
                "state; take DMB_STEADY_AT_REST",
                j, i, speed);
            return DMB_ERR_UNSUPPORTED;
        }
    }
    return check_lines(sim, most);
}

/* ---- Residual and tangent ---------------------------------------------------------------------------------------- */

static void copy(const double *from, size_t count, double *to)
{
    memcpy(to, from, count * sizeof(double));
}

/* Damping matrix C = dr/dV at increments of 0: nodes and elements store it with the inertia; joints add it to their
 * stiffness, which evaluate() subtracts. */
static int32_t read_damping(dmb_steady *steady, dmb_evaluation *at)
{
    const dmb_sim *sim = at->sim;
    const dmb_block_layout *layout = &sim->scene->layout;
    dmb_linear_matrix *C = &steady->damping;
    at->velocity_factor = 1.0;
    at->inertia_only = 1;
    const int32_t status = dmb_system_evaluate(at);
    at->velocity_factor = 0.0;
    at->inertia_only = 0;
    copy(sim->inertia_diagonal, layout->diag[layout->n], C->diagonal);
    copy(sim->stiffness_lower, layout->link[layout->n - 1], C->lower);
    copy(sim->stiffness_upper, layout->link[layout->n - 1], C->upper);
    copy(sim->constraint_tangent, sim->scene->tangent_count, C->joints);
    return status;
}

/* The joints' part of read_damping is K + C. After the second evaluation, whose velocity_factor is 0, K is subtracted
 * from it, and the product with the frame velocity g completes the tangent (eq:sliding.tangent). */
static int32_t evaluate(dmb_steady *steady, dmb_evaluation *at)
{
    dmb_sim *sim = at->sim;
    int32_t status = at->tangent ? read_damping(steady, at) : DMB_OK;
    if (status >= 0) status = dmb_system_evaluate(at);
    if (status < 0 || !at->tangent) return status;
    dmb_linear_matrix K = dmb_linear_stiffness_of(sim);
    dmb_linear_add_array(-1.0, K.joints, sim->scene->tangent_count, steady->damping.joints);
    dmb_linear_add_products(sim->scene, 1.0, &steady->damping, steady->frame_velocity, &K);
    return DMB_OK;
}

/* Load steps of RIGID scale the speeds by the root of the load factor: centrifugal forces, quadratic in the speeds,
 * then grow in proportion to the other loads. Speeds of SLIDING do not change with it. The evaluation is a dynamic one,
 * which differentiates by the increment of a step (eq:integration.iteration-matrix); the moves accumulated by the
 * search are not such an increment and are set to 0 meanwhile. */
int32_t dmb_steady_evaluate(dmb_steady *steady, dmb_evaluation *evaluation)
{
    dmb_sim *sim = evaluation->sim;
    const size_t bytes = sim->scene->row_count * sizeof(double);
    dmb_evaluation at = *evaluation;
    int32_t status = dmb_steady_move(steady, evaluation, sqrt(evaluation->load_factor));
    if (status < 0) return status;
    at.dynamic = at.steady = 1;
    at.pseudo_factor = 1.0;
    memcpy(steady->increment, sim->increment, bytes);
    memset(sim->increment, 0, bytes);
    status = evaluate(steady, &at);
    memcpy(sim->increment, steady->increment, bytes);
    at.dynamic = evaluation->dynamic;
    at.steady = evaluation->steady;
    at.pseudo_factor = evaluation->pseudo_factor;
    *evaluation = at;
    return status;
}
