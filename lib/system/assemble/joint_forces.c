/* Forces of joints: springs, dampers, stops, friction and drives of their coordinates, forces of constraint.
 *
 * A force f on a coordinate with gradient J (by the relative twist V) is the wrench J^T f on frame b; the bodies get
 * Lambda_b^T and Lambda_a^T of it (eq:joints.relative-motion). Order of dmb_assemble_joints:
 *
 *     1. laws and drives of each joint       forces, powers, tangents (eq:joints.relative-tangent)
 *     2. gyroscopic part of mean forces      eq:unilateral.gyroscopic
 *     3. multipliers                         they balance all forces so far (eq:joints.multipliers)
 *     4. curvature of the equations          d(B^T f)/dq with these multipliers
 *
 * Open joints have no forces: their drives follow the coordinate, their laws are at rest. */
#include "system/assemble/assemble.h"

#include <math.h>
#include <string.h>

#include "math/mat6.h"
#include "math/se3.h"
#include "math/vec3.h"
#include "sim/node.h"
#include "system/assemble/bounces.h"
#include "system/assemble/drives.h"
#include "system/constrain/constrain.h"

/* Forces on the six coordinates, their derivatives, and their points of action. */
typedef struct coordinate_forces {
    dmb_relative relative;
    dmb_joint_coordinates c;
    double speed[6];
    double force[6], by_position[6], by_speed[6];
    double mean[6],
        mean_slope[6]; /* along the mean gradient of both ends of the step: negative force, and by position */
    int has_mean;
} coordinate_forces;

static int has_forces(const dmb_sim *sim, const dmb_scene_joint *joint, uint32_t j)
{
    return (joint->law != DMB_NONE || joint->drive_count > 0) && sim->joint_state[j] != DMB_JOINT_OPEN;
}

static void begin_at(const dmb_evaluation *evaluation, const dmb_configuration *at, uint32_t j, coordinate_forces *f)
{
    memset(f, 0, sizeof *f);
    dmb_joint_motion_of(evaluation->sim->scene, at, j, &f->relative, NULL);
    dmb_joint_coordinates_in(evaluation, j, &f->relative, &f->c);
    for (int i = 0; i < 6; i++) f->speed[i] = evaluation->dynamic ? dmb_vec6_dot(f->c.J[i], f->relative.V) : 0.0;
}

static void begin(const dmb_evaluation *evaluation, uint32_t j, coordinate_forces *f)
{
    begin_at(evaluation, &evaluation->sim->trial, j, f);
}

static double largest_place(const dmb_sim *sim, const dmb_scene_frame *frame)
{
    const double *u = sim->trial.displacement;
    return frame->node == DMB_NONE ? dmb_vec3_norm(frame->x)
                                   : dmb_vec3_norm(frame->x) + dmb_vec3_norm(u + 3 * (size_t)frame->node);
}

/* [N] Change of the force on coordinate i if the numbers whose difference is the coordinate change by their own size;
 * moments as forces at the length scale. */
static double stiffness_times_reach(const dmb_sim *sim, const dmb_scene_joint *joint, int i, double by_position)
{
    if (i >= 3) return by_position / sim->scene->length_scale;
    return by_position * (dmb_vec3_norm(joint->span) + largest_place(sim, &joint->a) + largest_place(sim, &joint->b));
}

/* Adds a mean force on coordinate i. */
static void add_mean(coordinate_forces *f, int i, const dmb_bounce_force *own)
{
    f->mean[i] -= own->force;
    f->mean_slope[i] -= own->by_place;
    f->has_mean = 1;
}

/* Mean forces of stop and spring of coordinate i. The mean force takes the place of that part of the law alone: `bare`
 * is the law without it. The heat of a stop is its damper's; it is moved from the potential forces to the impact. */
static void take_own(dmb_evaluation *evaluation, uint32_t l, coordinate_forces *f, int i, dmb_joint_force *law)
{
    const double x = f->c.value[i], speed = f->speed[i];
    const dmb_bounce stop = {x, speed, -(law->stop + law->stop_damper)}, spring = {x, speed, -law->spring};
    dmb_joint_law bare = evaluation->sim->scene->laws[l];
    dmb_bounce_force of_stop, of_spring;
    const int stops = dmb_bounce_at(evaluation, l, &stop, &of_stop);
    const int holds = dmb_bounce_at(evaluation, dmb_bounce_of_law(evaluation->sim->scene, l), &spring, &of_spring);
    if (!stops && !holds) return;
    if (stops) bare.stop_stiffness = 0.0;
    if (holds) bare.stiffness = 0.0;
    dmb_joint_force_at(&bare, x, speed, law);
    if (holds) {
        law->spring = -of_spring.force;
        add_mean(f, i, &of_spring);
    }
    if (!stops) return;
    law->stop = -of_stop.force;
    add_mean(f, i, &of_stop);
    evaluation->power[DMB_POWER_POTENTIAL] -= of_stop.heat;
    evaluation->power[DMB_POWER_IMPACT] += of_stop.heat;
}

/* Springs, dampers, stops and friction of each coordinate c: f(c, c'), its two derivatives and the powers f c'. Forces
 * are positive along growing coordinates.
 *
 *     part of the law     power goes to
 *     -----------------   --------------------------------------
 *     spring, stop        potential (mean forces less their heat)
 *     damper              damping
 *     friction            friction
 *     damper of a stop    impact */
static void add_laws(dmb_evaluation *evaluation, const dmb_scene_joint *joint, coordinate_forces *f)
{
    for (int i = 0; i < 6; i++) {
        dmb_joint_force law;
        if (joint->law == DMB_NONE || (joint->law_mask >> i & 1) == 0) continue;
        dmb_joint_force_at(evaluation->sim->scene->laws + joint->law + i, f->c.value[i], f->speed[i], &law);
        if (evaluation->sim->scene->unilateral_count > 0) take_own(evaluation, joint->law + (uint32_t)i, f, i, &law);
        f->force[i] += law.force;
        f->by_position[i] += law.by_position;
        f->by_speed[i] += law.by_speed;
        const double k = stiffness_times_reach(evaluation->sim, joint, i, law.by_position + f->mean_slope[i]);
        if (dmb_rounding_counts(evaluation)) evaluation->rounding += k * k;
        evaluation->power[DMB_POWER_POTENTIAL] += (law.spring + law.stop) * f->speed[i];
        evaluation->power[DMB_POWER_DAMPING] += law.damper * f->speed[i];
        evaluation->power[DMB_POWER_FRICTION] += law.friction * f->speed[i];
        evaluation->power[DMB_POWER_IMPACT] += law.stop_damper * f->speed[i];
        evaluation->sim->trial.law_speed[joint->law + (uint32_t)i] = f->speed[i];
    }
}

/* Forces of drives in load or speed control; motion drives are equations (system/constrain). */
static void add_drives(dmb_evaluation *evaluation, uint32_t j, coordinate_forces *f)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_scene_joint *joint = sim->scene->joints + j;
    for (uint32_t i = joint->first_drive; i < joint->first_drive + joint->drive_count; i++) {
        const uint32_t d = sim->scene->joint_drives[i];
        const dmb_scene_drive *drive = sim->scene->drives + d;
        double slope;
        dmb_drive_on_joint(sim, d, f->c.value[drive->component], f->speed[drive->component], 0);
        if (drive->kind == DMB_DRIVE_MOTION) continue;
        const double force = dmb_drive_force(evaluation, d, f->speed[drive->component], &slope);
        f->force[drive->component] += force;
        f->by_speed[drive->component] += evaluation->dynamic ? slope : 0.0;
        evaluation->power[DMB_POWER_DRIVES] += force * f->speed[drive->component];
    }
}

/* Drives of an open joint have no force, and track its coordinate. */
static void rest_drives(dmb_evaluation *evaluation, uint32_t j)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_scene_joint *joint = sim->scene->joints + j;
    coordinate_forces f;
    if (joint->drive_count == 0) return;
    begin(evaluation, j, &f);
    for (uint32_t i = joint->first_drive; i < joint->first_drive + joint->drive_count; i++) {
        const uint32_t d = sim->scene->joint_drives[i];
        const dmb_scene_drive *drive = sim->scene->drives + d;
        dmb_drive_on_joint(sim, d, f.c.value[drive->component], f.speed[drive->component], 1);
    }
}

/* Adds J^T f of the forces to the wrenches at both parts. */
static void add_wrenches(const dmb_relative *relative, const dmb_joint_coordinates *c, double factor,
                         const double force[6], double wa[6], double wb[6])
{
    double w[6] = {0.0}, of_a[6], of_b[6];
    for (int i = 0; i < 6; i++)
        for (int k = 0; k < 6; k++) w[k] += factor * force[i] * c->J[i][k];
    dmb_relative_pull_back(relative, w, of_a, of_b);
    for (int k = 0; k < 6; k++) wa[k] += of_a[k], wb[k] += of_b[k];
}

/* A unit of mean force on coordinate i: half along the gradient of the start of the step, in nodes that turn. The other
 * half is the gradient of the end (eq:unilateral.turning). The gradient of the start is carried into the axes reached;
 * nodes that do not turn have J0 = J1. */
static void unit_mean(const dmb_sim *sim, const dmb_scene_joint *joint, const coordinate_forces *before,
                      const coordinate_forces *end, int i, double w[2][6])
{
    const uint32_t node[2] = {joint->a.node, joint->b.node};
    double start[2][6] = {{0.0}}, unit[6] = {0.0};
    unit[i] = 0.5;
    memset(w, 0, 12 * sizeof(double));
    add_wrenches(&end->relative, &end->c, 1.0, unit, w[0], w[1]);
    add_wrenches(&before->relative, &before->c, 1.0, unit, start[0], start[1]);
    for (int k = 0; k < 2; k++) {
        const int turns = dmb_bounce_turns(sim, node[k]);
        if (turns) dmb_bounce_carry(sim, node[k], start[k], NULL);
        for (int m = 0; m < 6; m++) w[k][m] += turns ? start[k][m] : w[k][m];
    }
}

/* Couples about the rotation of the step close the gap between the mean of both gradients and the exact mean gradient
 * (dmb_bounce_close_gap), so that the work of the mean force is G (x1 - x0). */
static void add_mean_wrenches(dmb_evaluation *evaluation, const dmb_scene_joint *joint, uint32_t j,
                              const coordinate_forces *f, double wa[6], double wb[6])
{
    const dmb_sim *sim = evaluation->sim;
    coordinate_forces before;
    begin_at(evaluation, &sim->now, j, &before);
    for (int i = 0; i < 6; i++) {
        double w[2][6];
        if (f->mean[i] == 0.0) continue;
        unit_mean(sim, joint, &before, f, i, w);
        dmb_bounce_close_gap(sim, joint->law + (uint32_t)i, joint->a.node, w[0], joint->b.node, w[1]);
        for (int k = 0; k < 6; k++) {
            wa[k] += f->mean[i] * w[0][k];
            wb[k] += f->mean[i] * w[1][k];
        }
    }
}

static void apply(dmb_evaluation *evaluation, const dmb_scene_joint *joint, uint32_t j, const coordinate_forces *f)
{
    double wa[6] = {0.0}, wb[6] = {0.0};
    add_wrenches(&f->relative, &f->c, 1.0, f->force, wa, wb);
    if (f->has_mean) add_mean_wrenches(evaluation, joint, j, f, wa, wb);
    dmb_apply_wrench(evaluation->sim, joint->b.node, wb);
    if (joint->a.node != DMB_NONE) dmb_apply_wrench(evaluation->sim, joint->a.node, wa);
}

/* -d(J^T f)/dq: W of the gradients and J^T f' J, at constant speeds. */
static void add_position_tangent(const dmb_scene *scene, const dmb_constraint *constraint, uint32_t j,
                                 const coordinate_forces *f, double *K)
{
    double w[6] = {0.0}, W[36], minus[6];
    for (int i = 0; i < 6; i++) minus[i] = -f->force[i] - 0.5 * f->mean[i];
    dmb_joint_coordinates_tangent(f->relative.R, f->relative.p, minus, W);
    for (int i = 0; i < 6; i++) {
        for (int k = 0; k < 6; k++) w[k] += minus[i] * f->c.J[i][k];
        dmb_mat6_add_outer(-f->by_position[i], f->c.J[i], f->c.J[i], W);
    }
    dmb_add_joint_tangent(scene, constraint, j, &f->relative, w, W, K);
}

/* -J^T df/d(speed) d(speed)/dq: the speeds of coordinates change with the pose at constant velocities of the bodies,
 * for instance of a damper across a rotating body that tilts (eq:joints.speed-tangent). */
static void add_speed_by_position(const dmb_evaluation *evaluation, const dmb_constraint *constraint, uint32_t j,
                                  const coordinate_forces *f, double *K)
{
    const dmb_sim *sim = evaluation->sim;
    const uint32_t n = constraint->columns;
    double vb[6], G[6][6];
    int acts = 0;
    for (int i = 0; i < 6; i++) acts |= f->by_speed[i] != 0.0;
    if (!evaluation->dynamic || !acts) return;
    dmb_node_vector(sim->scene, &sim->trial, sim->scene->joints[j].b.node, sim->trial.velocity, vb);
    dmb_joint_speeds_tangent(&f->relative, &f->c, vb, G);
    for (int i = 0; i < 6; i++) {
        double row[DMB_CONSTRAINT_COLUMNS] = {0.0}, change[DMB_CONSTRAINT_COLUMNS] = {0.0};
        if (f->by_speed[i] == 0.0) continue;
        dmb_add_joint_row(sim->scene, constraint, j, &f->relative, 1.0, f->c.J[i], row);
        dmb_add_joint_row(sim->scene, constraint, j, &f->relative, 1.0, G[i], change);
        for (uint32_t r = 0; r < n; r++)
            for (uint32_t s = 0; s < n; s++) K[(size_t)r * n + s] -= f->by_speed[i] * row[r] * change[s];
    }
}

/* -d(mean gradient^T f)/dq: half of the gradient is constant in nodes that turn, J0; J0 = J1 in others. */
static void add_mean_tangent(const dmb_evaluation *evaluation, const dmb_constraint *constraint, uint32_t j,
                             const coordinate_forces *f, double *K)
{
    const dmb_sim *sim = evaluation->sim;
    const uint32_t n = constraint->columns;
    coordinate_forces before;
    begin_at(evaluation, &sim->now, j, &before);
    for (int i = 0; i < 6; i++) {
        double start[DMB_CONSTRAINT_COLUMNS] = {0.0}, end[DMB_CONSTRAINT_COLUMNS] = {0.0};
        if (f->mean_slope[i] == 0.0) continue;
        dmb_add_joint_row(sim->scene, constraint, j, &before.relative, 1.0, before.c.J[i], start);
        dmb_add_joint_row(sim->scene, constraint, j, &f->relative, 1.0, f->c.J[i], end);
        for (uint32_t k = 0; k < constraint->node_count; k++) {
            const uint32_t node = constraint->node[k], first = constraint->column[k];
            if (dmb_bounce_turns(sim, node)) {
                dmb_bounce_carry(sim, node, start + first, NULL);
                continue;
            }
            memcpy(start + first, end + first, sim->scene->layout.size[node] * sizeof(double));
        }
        for (uint32_t r = 0; r < n; r++)
            for (uint32_t s = 0; s < n; s++)
                K[(size_t)r * n + s] -= 0.5 * f->mean_slope[i] * (start[r] + end[r]) * end[s];
    }
}

/* -d(J^T f)/dv in pose parameters: gamma' times the slope of each law and drive by its speed, J^T J. */
static void add_speed_tangent(dmb_evaluation *evaluation, const dmb_constraint *constraint, uint32_t j,
                              const coordinate_forces *f, double *K)
{
    const uint32_t n = constraint->columns;
    for (int i = 0; i < 6; i++) {
        double row[DMB_CONSTRAINT_COLUMNS] = {0.0};
        const double factor = -evaluation->velocity_factor * f->by_speed[i];
        if (factor == 0.0) continue;
        dmb_add_joint_row(evaluation->sim->scene, constraint, j, &f->relative, 1.0, f->c.J[i], row);
        for (uint32_t r = 0; r < n; r++)
            for (uint32_t s = 0; s < n; s++) K[(size_t)r * n + s] += factor * row[r] * row[s];
    }
}

/* K <- K T6 in the columns of six-DOF nodes, as for the blocks of the nodes. T6 turns increments z into body-frame
 * displacements (eq:kinematics.tangent-pose, eq:integration.iteration-matrix). */
static void to_parameters(const dmb_evaluation *evaluation, const dmb_constraint *constraint, double *K)
{
    const dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    if (!evaluation->dynamic) return;
    for (uint32_t i = 0; i < constraint->node_count; i++) {
        const uint32_t node = constraint->node[i];
        dmb_se3_tangent T;
        if (scene->layout.size[node] != DMB_NODE_SIX_DOF) continue;
        dmb_se3_tangent_at(sim->increment + scene->layout.row[node], NULL, &T);
        for (uint32_t r = 0; r < constraint->columns; r++) {
            double *row = K + (size_t)r * constraint->columns + constraint->column[i];
            dmb_se3_tangent_apply_transpose(&T, row, row);
        }
    }
}

/* The tangent by speeds already is with respect to parameters. */
static void add_joint_tangent(dmb_evaluation *evaluation, uint32_t j, const coordinate_forces *f)
{
    const dmb_scene *scene = evaluation->sim->scene;
    const dmb_constraint *constraint = scene->constraints + scene->joints[j].constraint;
    double *K = evaluation->sim->constraint_tangent + constraint->tangent;
    add_position_tangent(scene, constraint, j, f, K);
    add_speed_by_position(evaluation, constraint, j, f, K);
    if (f->has_mean) add_mean_tangent(evaluation, constraint, j, f, K);
    to_parameters(evaluation, constraint, K);
    if (evaluation->dynamic) add_speed_tangent(evaluation, constraint, j, f, K);
}

void dmb_joint_press(dmb_evaluation *evaluation, const dmb_configuration *at, uint32_t j, uint32_t component,
                     double force)
{
    coordinate_forces f;
    begin_at(evaluation, at, j, &f);
    f.force[component] = -force;
    apply(evaluation, evaluation->sim->scene->joints + j, j, &f);
}

void dmb_joint_press_mean(dmb_evaluation *evaluation, uint32_t j, uint32_t component, double force)
{
    coordinate_forces f;
    begin(evaluation, j, &f);
    f.mean[component] = -force;
    f.has_mean = 1;
    apply(evaluation, evaluation->sim->scene->joints + j, j, &f);
}

/* Laws of an open joint have no force and no speed: a speed kept from before the opening would belong to an earlier
 * step, and would differ after a restored state. */
static void rest_laws(dmb_sim *sim, const dmb_scene_joint *joint)
{
    if (joint->law == DMB_NONE) return;
    for (uint32_t i = 0; i < 6; i++) {
        sim->trial.law_speed[joint->law + i] = 0.0;
        if (sim->scene->unilateral_count > 0) dmb_bounce_rest(sim, joint->law + i);
    }
}

static void assemble_forces(dmb_evaluation *evaluation)
{
    const dmb_scene *scene = evaluation->sim->scene;
    for (uint32_t j = 0; j < scene->joint_count; j++) {
        const dmb_scene_joint *joint = scene->joints + j;
        coordinate_forces f;
        if (evaluation->sim->joint_state[j] == DMB_JOINT_OPEN) {
            rest_drives(evaluation, j);
            rest_laws(evaluation->sim, joint);
        }
        if (!has_forces(evaluation->sim, joint, j)) continue;
        begin(evaluation, j, &f);
        add_laws(evaluation, joint, &f);
        add_drives(evaluation, j, &f);
        apply(evaluation, joint, j, &f);
        if (evaluation->tangent) add_joint_tangent(evaluation, j, &f);
    }
}

/* Adds the curvature of the equations to the tangents of the forces. */
static int32_t gather_curvatures(dmb_evaluation *evaluation)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    int32_t status = DMB_OK;
    for (uint32_t i = 0; i < scene->constraint_count && status >= 0; i++) {
        const dmb_constraint *constraint = scene->constraints + i;
        const size_t size = (size_t)constraint->columns * constraint->columns;
        double K[DMB_CONSTRAINT_COLUMNS * DMB_CONSTRAINT_COLUMNS];
        memset(K, 0, size * sizeof(double));
        status = dmb_constraint_curvature(evaluation, i, K);
        to_parameters(evaluation, constraint, K);
        for (size_t k = 0; k < size; k++) sim->constraint_tangent[constraint->tangent + k] += K[k];
    }
    return status;
}

int32_t dmb_assemble_joints(dmb_evaluation *evaluation)
{
    assemble_forces(evaluation);
    dmb_bounces_turn(evaluation);
    dmb_clusters_balance(evaluation);
    return evaluation->tangent ? gather_curvatures(evaluation) : DMB_OK;
}
