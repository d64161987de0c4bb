/* The equations of joints, couplings, joint drives and callbacks at the trial (eq:motion.constraints):
 *
 *     C(q, t) = 0,   B v + rate = 0,   B v' + convective = 0,   B = dC by body-frame motion of the nodes
 *
 * into the constraint_ fields of the sim. Inactive rows are zero, of type DMB_ROW_IDLE.
 *
 *     owner       rows                                    value              rate            convective
 *     ---------   -------------------------------------   ----------------   -------------   ----------------------
 *     joint       of its kind, or six of its lock         eq:joints.rows     0               JV V + J (ad terms)
 *     coupling    sum of factor times coordinate          less its value     0               sum of the coordinates'
 *                                                         when closed
 *     drive       coordinate                              less its target    -target         less the target's rate
 *     callback    constraint_rows_callback.c */
#include "system/constrain/constrain.h"

#include <string.h>

#include "math/mat6.h"
#include "sim/node.h"
#include "system/constrain/rotor.h"

/* [rad] largest rotation in a step for which the gradients at its end are accurate enough */
#define DMB_SMALL_TURN 1.0

static double *jacobian_row(const dmb_sim *sim, const dmb_constraint *constraint, uint32_t k)
{
    return sim->constraint_jacobian + constraint->jacobian + (size_t)k * constraint->columns;
}

/* Rows that do not act keep their place in the memory, so that switching a joint moves no other row. */
static void idle(dmb_sim *sim, const dmb_constraint *constraint)
{
    memset(sim->constraint_type + constraint->row, DMB_ROW_IDLE, constraint->rows);
    memset(sim->constraint_value + constraint->row, 0, constraint->rows * sizeof(double));
    memset(sim->constraint_rate + constraint->row, 0, constraint->rows * sizeof(double));
    memset(sim->constraint_convective + constraint->row, 0, constraint->rows * sizeof(double));
    memset(jacobian_row(sim, constraint, 0), 0, (size_t)constraint->rows * constraint->columns * sizeof(double));
}

/* ---- Joints ------------------------------------------------------------------------------------------------------ */

void dmb_joint_rows_now(const dmb_sim *sim, uint32_t j, const dmb_relative *relative, dmb_joint_rows *rows)
{
    const dmb_scene_joint *joint = sim->scene->joints + j;
    const double *lock = sim->joint_lock + 12 * j;
    rows->count = 0;
    rows->holonomic = 0;
    if (sim->joint_state[j] == DMB_JOINT_OPEN) return;
    if (sim->joint_state[j] == DMB_JOINT_LOCKED)
        dmb_joint_locked_at(lock, lock + 9, relative->R, relative->p, relative->V, rows);
    else
        dmb_joint_rows_at(joint->kind, joint->length, relative->R, relative->p, relative->V, rows);
}

/* B v' + (JV V + J convective) = 0. Lambda_a changes with the motion (eq:joints.relative-motion): `convective` of the
 * relative motion is -ad_V Lambda_a v_a. */
static double convective_of(const double J[6], const double JV[6], const dmb_relative *relative)
{
    return dmb_vec6_dot(JV, relative->V) + dmb_vec6_dot(J, relative->convective);
}

/* Additional convective term because frame a moves along the hole with s' = t . v: n' . v = -s'^2 (n . dt/ds). */
static double bend_convective(const dmb_hole_bend *bend, const dmb_relative *relative, const double normal[3])
{
    double v[3];
    dmb_mat3_vec(bend->M, relative->V, v);
    const double rate = dmb_vec3_dot(bend->tangent, v);
    return -rate * rate * dmb_vec3_dot(normal, bend->curvature);
}

static void joint_row(dmb_sim *sim, const dmb_constraint *constraint, uint32_t k, uint8_t type, double value,
                      const dmb_relative *relative, const double J[6], const double JV[6])
{
    const uint32_t row = constraint->row + k;
    sim->constraint_type[row] = type;
    sim->constraint_value[row] = value;
    sim->constraint_convective[row] = convective_of(J, JV, relative);
    dmb_add_joint_row(sim->scene, constraint, constraint->index, relative, 1.0, J, jacobian_row(sim, constraint, k));
}

/* During assembly, given initial coordinates are equations too. They follow the joint's own rows; their rate makes the
 * speeds of the coordinates those given. */
static void initial_rows(dmb_evaluation *evaluation, const dmb_constraint *constraint, const dmb_relative *relative,
                         uint32_t k)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_scene_joint *joint = sim->scene->joints + constraint->index;
    dmb_joint_coordinates c;
    if (joint->initial_mask == 0) return;
    dmb_joint_coordinates_at(relative->R, relative->p, relative->V, joint->initial_position + 3, &c);
    for (uint32_t i = 0; i < 6 && k < constraint->rows; i++) {
        if ((joint->initial_mask >> i & 1) == 0) continue;
        joint_row(sim, constraint, k, DMB_ROW_POSITION, c.value[i] - joint->initial_position[i], relative, c.J[i],
                  c.JV[i]);
        sim->constraint_rate[constraint->row + k++] = -joint->initial_speed[i];
    }
}

static void joint_rows(dmb_evaluation *evaluation, const dmb_constraint *constraint)
{
    dmb_sim *sim = evaluation->sim;
    const uint32_t j = constraint->index;
    const int on_hole = sim->scene->joints[j].kind == DMB_JOINT_POINT_ON_HOLE;
    dmb_relative relative;
    dmb_hole_bend bend;
    dmb_joint_rows rows;
    dmb_joint_place_begin(sim, j);
    dmb_joint_motion(sim->scene, &sim->trial, j, &relative, on_hole ? &bend : NULL);
    dmb_joint_rows_now(sim, j, &relative, &rows);
    for (uint32_t k = 0; k < rows.count; k++) {
        const uint8_t type = rows.holonomic >> k & 1 ? DMB_ROW_POSITION : DMB_ROW_SPEED;
        joint_row(sim, constraint, k, type, rows.value[k], &relative, rows.J[k], rows.JV[k]);
        if (on_hole && sim->joint_state[j] == DMB_JOINT_ACTIVE)
            sim->constraint_convective[constraint->row + k] += bend_convective(&bend, &relative, bend.normal[k]);
    }
    if (evaluation->assembling) initial_rows(evaluation, constraint, &relative, rows.count);
}

/* ---- Coordinates ------------------------------------------------------------------------------------------------- */

/* Motion of frame b relative to a by the increments of the step, with the maps at one end of the step. */
static void moved_by(const dmb_sim *sim, const dmb_configuration *c, uint32_t j, const dmb_relative *relative,
                     double moved[6])
{
    const dmb_scene_joint *joint = sim->scene->joints + j;
    double z[6], a[6] = {0.0};
    dmb_node_vector(sim->scene, c, joint->b.node, sim->increment, z);
    dmb_rotor_add_travel(sim, joint->b.node, z);
    dmb_mat6_vec(relative->to_b, z, moved);
    if (joint->a.node == DMB_NONE) return;
    dmb_node_vector(sim->scene, c, joint->a.node, sim->increment, z);
    dmb_rotor_add_travel(sim, joint->a.node, z);
    dmb_mat6_vec(relative->to_a, z, a);
    for (int i = 0; i < 6; i++) moved[i] += a[i];
}

/* [rad] Change of RX and RY in the step, with the gradients at its end; for large rotations with those at its start
 * too. They choose the revolution of the angles that the pose gives, for which the estimate has to be right within half
 * a turn. */
static void angle_increments(const dmb_sim *sim, uint32_t j, const dmb_relative *relative,
                             const dmb_joint_coordinates *c, double increment[2])
{
    const double *last = sim->now.joint_turn + 2 * (size_t)j;
    dmb_relative start;
    dmb_joint_coordinates first;
    double moved[6];
    moved_by(sim, &sim->trial, j, relative, moved);
    for (int i = 0; i < 2; i++) increment[i] = dmb_vec6_dot(c->J[3 + i], moved);
    if (fabs(increment[0]) <= DMB_SMALL_TURN && fabs(increment[1]) <= DMB_SMALL_TURN) return;
    dmb_joint_motion_of(sim->scene, &sim->now, j, &start, NULL);
    dmb_joint_coordinates_at(start.R, start.p, start.V, last, &first);
    moved_by(sim, &sim->now, j, &start, moved);
    for (int i = 0; i < 2; i++) increment[i] = 0.5 * (increment[i] + dmb_vec6_dot(first.J[3 + i], moved));
}

/* Expected coordinate of a joint moved by a motion drive: that of the drive, to choose the revolution. */
static void expect_driven(const dmb_sim *sim, uint32_t j, double expected[2])
{
    const dmb_scene *scene = sim->scene;
    const dmb_scene_joint *joint = scene->joints + j;
    if (sim->joint_state[j] == DMB_JOINT_OPEN) return;
    for (uint32_t i = joint->first_drive; i < joint->first_drive + joint->drive_count; i++) {
        const uint32_t d = scene->joint_drives[i];
        const int32_t component = scene->drives[d].component;
        if (scene->drives[d].kind == DMB_DRIVE_MOTION && (component == DMB_RX || component == DMB_RY))
            expected[component - DMB_RX] = sim->drive_offset[d] + sim->trial.drives[d].position;
    }
}

/* RX and RY: the angle of the pose on the revolution nearest to the last one plus the increment of the step. */
void dmb_joint_coordinates_in(const dmb_evaluation *evaluation, uint32_t j, const dmb_relative *relative,
                              dmb_joint_coordinates *coordinates)
{
    const dmb_sim *sim = evaluation->sim;
    const double *last = sim->now.joint_turn + 2 * (size_t)j;
    double expected[2];
    if (!evaluation->dynamic || evaluation->steady)
        last = sim->trial.joint_turn + 2 * (size_t)j; /* in statics it is updated after every move */
    dmb_joint_coordinates_at(relative->R, relative->p, relative->V, last, coordinates);
    if (!(evaluation->step > 0.0)) return;
    angle_increments(sim, j, relative, coordinates, expected);
    for (int i = 0; i < 2; i++) expected[i] += last[i];
    expect_driven(sim, j, expected);
    for (int i = 0; i < 2; i++)
        coordinates->value[3 + i] += DMB_TWO_PI * round((expected[i] - coordinates->value[3 + i]) / DMB_TWO_PI);
}

/* Row 0 of the constraint += factor times a coordinate of joint j. */
static void add_coordinate(dmb_evaluation *evaluation, const dmb_constraint *constraint, uint32_t j, int32_t component,
                           double factor)
{
    dmb_sim *sim = evaluation->sim;
    dmb_relative relative;
    dmb_joint_coordinates c;
    dmb_joint_motion(sim->scene, &sim->trial, j, &relative, NULL);
    dmb_joint_coordinates_in(evaluation, j, &relative, &c);
    sim->constraint_type[constraint->row] = DMB_ROW_POSITION;
    sim->constraint_value[constraint->row] += factor * c.value[component];
    sim->constraint_convective[constraint->row] += factor * convective_of(c.J[component], c.JV[component], &relative);
    dmb_add_joint_row(sim->scene, constraint, j, &relative, factor, c.J[component], jacobian_row(sim, constraint, 0));
}

static int is_open(const dmb_sim *sim, uint32_t j)
{
    return sim->joint_state[j] == DMB_JOINT_OPEN;
}

/* Not during assembly: its constant is the sum in the closed pose (keep_coordinates). */
static void coupling_row(dmb_evaluation *evaluation, const dmb_constraint *constraint)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_scene_coupling *coupling = sim->scene->couplings + constraint->index;
    if (evaluation->assembling || !dmb_coupling_holds(sim, coupling)) return;
    for (uint32_t k = 0; k < coupling->count; k++)
        add_coordinate(evaluation, constraint, coupling->joint[k], coupling->component[k], coupling->factor[k]);
    sim->constraint_value[constraint->row] -= sim->constraint_offset[constraint->row];
}

/* A motion drive: coordinate = its value at time 0 + position of the drive, which is the exact integral of its target.
 */
static void drive_row(dmb_evaluation *evaluation, const dmb_constraint *constraint)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_scene_drive *drive = sim->scene->drives + constraint->index;
    if (evaluation->assembling || is_open(sim, drive->joint)) return;
    add_coordinate(evaluation, constraint, drive->joint, drive->component, 1.0);
    sim->constraint_value[constraint->row] -=
        sim->drive_offset[constraint->index] + sim->trial.drives[constraint->index].position;
    sim->constraint_rate[constraint->row] = -sim->trial.drives[constraint->index].target;
    sim->constraint_convective[constraint->row] -= sim->trial.drives[constraint->index].rate;
}

/* ---- All --------------------------------------------------------------------------------------------------------- */

int32_t dmb_constraint_rows(dmb_evaluation *evaluation)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    int32_t status = DMB_OK;
    double sum = 0.0;
    for (uint32_t i = 0; i < scene->constraint_count && status >= 0; i++) {
        const dmb_constraint *constraint = scene->constraints + i;
        idle(sim, constraint);
        if (constraint->kind == DMB_OF_JOINT) joint_rows(evaluation, constraint);
        if (constraint->kind == DMB_OF_COUPLING) coupling_row(evaluation, constraint);
        if (constraint->kind == DMB_OF_DRIVE) drive_row(evaluation, constraint);
        if (constraint->kind == DMB_OF_CALLBACK) status = dmb_callback_rows(evaluation, constraint->index);
    }
    for (uint32_t r = 0; r < scene->constraint_row_count; r++)
        sum += fabs(sim->constraint_value[r]) + fabs(sim->constraint_convective[r]);
    return status < 0 ? status : isfinite(sum) ? DMB_OK : DMB_ERR_NOT_FINITE;
}

/* ---- Curvature of the rows --------------------------------------------------------------------------------------- */

/* Columns of a node affected by a block of 6 columns: all, or x and rx of an axial-torsional node. */
static void add_block(const dmb_scene *scene, const dmb_constraint *constraint, const double K[144], int i, int k,
                      const uint32_t node[2], double *out)
{
    static const uint32_t path[2] = {0, 3};
    const uint32_t rows = scene->layout.size[node[i]], columns = scene->layout.size[node[k]];
    const uint32_t first = dmb_constraint_column(constraint, node[i]), at = dmb_constraint_column(constraint, node[k]);
    for (uint32_t r = 0; r < rows; r++)
        for (uint32_t s = 0; s < columns; s++) {
            const uint32_t from = rows == DMB_NODE_AXIAL_TORSIONAL ? path[r] : r,
                           to = columns == DMB_NODE_AXIAL_TORSIONAL ? path[s] : s;
            out[(size_t)(first + r) * constraint->columns + at + s] +=
                K[12 * (6 * (uint32_t)i + from) + 6 * (uint32_t)k + to];
        }
}

void dmb_add_joint_tangent(const dmb_scene *scene, const dmb_constraint *constraint, uint32_t j,
                           const dmb_relative *relative, const double w[6], const double W[36], double *K)
{
    const uint32_t node[2] = {scene->joints[j].a.node, scene->joints[j].b.node};
    double both[144];
    dmb_relative_tangent(relative, w, W, both);
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 2; k++)
            if (node[i] != DMB_NONE && node[k] != DMB_NONE) add_block(scene, constraint, both, i, k, node, K);
}

static void wrench_of(uint32_t count, double J[][6], const double *f, double w[6])
{
    for (int i = 0; i < 6; i++) w[i] = 0.0;
    for (uint32_t k = 0; k < count; k++)
        for (int i = 0; i < 6; i++) w[i] += f[k] * J[k][i];
}

/* Rotation of n_k with the depth of the point: M^T (frame_rate x n_k) (M^T t)^T */
static void add_bend(const dmb_hole_bend *bend, const double *f, double W[36])
{
    double t[3];
    dmb_mat3_tvec(bend->M, bend->tangent, t);
    for (int k = 0; k < 2; k++) {
        double n[3];
        dmb_vec3_cross(bend->frame_rate, bend->normal[k], n);
        dmb_mat3_tvec(bend->M, n, n);
        for (int r = 0; r < 3; r++)
            for (int s = 0; s < 3; s++) W[6 * r + s] += f[k] * n[r] * t[s];
    }
}

/* W = sum f_k dJ_k by relative displacements, from the closed forms of the rows of each kind; the maps of both bodies
 * add the other terms (eq:joints.relative-tangent). */
static void joint_curvature(const dmb_sim *sim, const dmb_constraint *constraint, const double *f, double *K)
{
    const uint32_t j = constraint->index;
    const dmb_scene_joint *joint = sim->scene->joints + j;
    const double *lock = sim->joint_lock + 12 * j;
    const int on_hole = joint->kind == DMB_JOINT_POINT_ON_HOLE && sim->joint_state[j] == DMB_JOINT_ACTIVE;
    dmb_relative relative;
    dmb_hole_bend bend;
    dmb_joint_rows rows;
    double w[6], W[36];
    dmb_joint_motion_of(sim->scene, &sim->trial, j, &relative, on_hole ? &bend : NULL);
    dmb_joint_rows_now(sim, j, &relative, &rows);
    if (rows.count == 0) return;
    wrench_of(rows.count, rows.J, f, w);
    if (sim->joint_state[j] == DMB_JOINT_LOCKED)
        dmb_joint_locked_tangent(lock, lock + 9, relative.R, relative.p, f, W);
    else
        dmb_joint_rows_tangent(joint->kind, joint->length, relative.R, relative.p, f, W);
    if (on_hole) add_bend(&bend, f, W);
    dmb_add_joint_tangent(sim->scene, constraint, j, &relative, w, W, K);
}

static void coordinate_curvature(const dmb_sim *sim, const dmb_constraint *constraint, uint32_t j, int32_t component,
                                 double factor, double *K)
{
    dmb_relative relative;
    dmb_joint_coordinates c;
    double f[6] = {0.0}, w[6], W[36];
    f[component] = factor;
    dmb_joint_motion_of(sim->scene, &sim->trial, j, &relative, NULL);
    dmb_joint_coordinates_at(relative.R, relative.p, relative.V, sim->now.joint_turn + 2 * j, &c);
    wrench_of(6, c.J, f, w);
    dmb_joint_coordinates_tangent(relative.R, relative.p, f, W);
    dmb_add_joint_tangent(sim->scene, constraint, j, &relative, w, W, K);
}

int32_t dmb_constraint_curvature(dmb_evaluation *evaluation, uint32_t constraint, double *K)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    const dmb_constraint *c = scene->constraints + constraint;
    const double *f = sim->trial.multiplier + c->row;
    if (c->kind == DMB_OF_JOINT) joint_curvature(sim, c, f, K);
    if (c->kind == DMB_OF_CALLBACK) return dmb_callback_curvature(evaluation, c->index, K);
    if (c->kind == DMB_OF_DRIVE)
        coordinate_curvature(sim, c, scene->drives[c->index].joint, scene->drives[c->index].component, f[0], K);
    if (c->kind != DMB_OF_COUPLING) return DMB_OK;
    const dmb_scene_coupling *coupling = scene->couplings + c->index;
    for (uint32_t k = 0; k < coupling->count; k++)
        coordinate_curvature(sim, c, coupling->joint[k], coupling->component[k], coupling->factor[k] * f[0], K);
    return DMB_OK;
}
