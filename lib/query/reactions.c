/* Motion, forces and reactions of the parts between bodies: joints, supports, drives, springs. */
#include "query/query.h"

#include <math.h>

#include "base/sized_struct.h"
#include "drillmbd/analyse.h"
#include "drillmbd/scene.h"
#include "element/beam.h"
#include "math/mat6.h"
#include "math/vec3.h"
#include "sim/access.h"
#include "sim/node.h"
#include "system/assemble/actuators.h"
#include "system/assemble/assemble.h"
#include "system/assemble/drives.h"
#include "system/constrain/constrain.h"

/* ---- Joints and callers' constraints ----------------------------------------------------------------------------- */

DMB_DECLARE_STRUCT(dmb_joint_state)

/* Acceleration V' of frame b relative to frame a: L_b v_b' + L_a v_a' - ad(V) L_a v_a (below
 * eq:joints.relative-motion); the last term, which the velocities alone determine, is `convective`. */
static void relative_acceleration(const dmb_sim *sim, uint32_t j, const dmb_relative *relative, double out[6])
{
    const dmb_scene_joint *joint = sim->scene->joints + j;
    double a[6];
    dmb_vec6_copy(relative->convective, out);
    dmb_node_vector(sim->scene, &sim->now, joint->b.node, sim->now.acceleration, a);
    for (int i = 0; i < 6; i++) out[i] += dmb_vec6_dot(relative->to_b + 6 * i, a);
    if (joint->a.node == DMB_NONE) return;
    dmb_node_vector(sim->scene, &sim->now, joint->a.node, sim->now.acceleration, a);
    for (int i = 0; i < 6; i++) out[i] += dmb_vec6_dot(relative->to_a + 6 * i, a);
}

/* Position, speed J V and acceleration J V' + J' V of the joint's coordinates (eq:joints.coordinates). A quasi-static
 * state has no accelerations. */
static void coordinates(const dmb_sim *sim, uint32_t j, const dmb_relative *relative, const dmb_joint_coordinates *c,
                        dmb_joint_state *answer)
{
    double acceleration[6];
    relative_acceleration(sim, j, relative, acceleration);
    for (int i = 0; i < 6; i++) {
        answer->position[i] = c->value[i];
        answer->speed[i] = dmb_vec6_dot(c->J[i], relative->V);
        if (dmb_is_quasi_static(&sim->now)) continue;
        answer->acceleration[i] = dmb_vec6_dot(c->JV[i], relative->V) + dmb_vec6_dot(c->J[i], acceleration);
    }
}

/* Forces of the joint's laws along its coordinates, at the end of the step. (A step over the touch of a stop is solved
 * with their mean, eq:unilateral.mean.) None in an open joint. */
static void actions(const dmb_sim *sim, uint32_t j, dmb_joint_state *answer)
{
    const dmb_scene_joint *joint = sim->scene->joints + j;
    for (uint32_t i = 0; i < 6; i++) {
        dmb_joint_force law;
        if (joint->law == DMB_NONE || (joint->law_mask >> i & 1) == 0) continue;
        if (sim->joint_state[j] == DMB_JOINT_OPEN) continue;
        dmb_joint_force_at(sim->scene->laws + joint->law + i, answer->position[i], answer->speed[i], &law);
        answer->action[i] = law.force;
    }
}

/* Reaction -J^T f on body b: the residual, internal less external forces, contains +B^T lambda (eq:static.multipliers),
 * so that the force of the joint on its bodies is the negative. In frame b or rotated to the world. */
static void reaction(const dmb_sim *sim, uint32_t j, const dmb_joint_rows *rows, const double world[9],
                     dmb_joint_state *answer)
{
    const double *f = sim->now.multiplier + sim->scene->constraints[sim->scene->joints[j].constraint].row;
    for (uint32_t k = 0; k < rows->count; k++)
        for (int i = 0; i < 6; i++) answer->reaction[i] -= f[k] * rows->J[k][i];
    if (answer->frame == DMB_FRAME_BODY) return;
    dmb_mat3_vec(world, answer->reaction, answer->reaction);
    dmb_mat3_vec(world, answer->reaction + 3, answer->reaction + 3);
}

/* World axes of frame b of the joint, columns. */
static void frame_b(const dmb_sim *sim, uint32_t j, double world[9])
{
    double R[9], u[3];
    dmb_node_pose(sim->scene, &sim->now, sim->scene->joints[j].b.node, R, u);
    dmb_mat3_mul(R, sim->scene->joints[j].b.M, world);
}

int32_t dmb_answer_joint(const dmb_sim *sim, dmb_id joint, dmb_joint_state *state)
{
    int32_t status = dmb_ask(sim, state);
    dmb_joint_state asked, answer = {0};
    dmb_relative relative;
    dmb_joint_coordinates c;
    dmb_joint_rows rows;
    double world[9];
    if (status == DMB_OK) status = dmb_joint_state_read(&asked, state);
    if (status < 0) return status;
    if (asked.frame != DMB_FRAME_WORLD && asked.frame != DMB_FRAME_BODY) return DMB_ERR_VALUE;
    const uint32_t j = dmb_model_part_index(sim->model, joint, DMB_PART_JOINT);
    if (j >= sim->scene->joint_count) return DMB_ERR_ID;
    answer.frame = asked.frame;
    answer.state = sim->joint_state[j];
    dmb_joint_motion_of(sim->scene, &sim->now, j, &relative, NULL);
    dmb_joint_coordinates_at(relative.R, relative.p, relative.V, sim->now.joint_turn + 2 * j, &c);
    dmb_joint_rows_now(sim, j, &relative, &rows);
    coordinates(sim, j, &relative, &c, &answer);
    actions(sim, j, &answer);
    frame_b(sim, j, world);
    reaction(sim, j, &rows, world, &answer);
    answer.constraint_rows = rows.count;
    answer.redundant = dmb_constraint_redundant(sim, sim->scene->joints[j].constraint);
    answer.violation = dmb_joint_violation(sim, j);
    return dmb_joint_state_write(state, &answer);
}

/* Active rows come first in the rows of a constraint, so that their number is all that is needed. */
int32_t dmb_answer_multipliers(const dmb_sim *sim, dmb_id part, double multipliers[6], uint32_t *count)
{
    const int32_t status = dmb_ask(sim, multipliers);
    if (status < 0) return status;
    if (count == NULL) return DMB_ERR_NULL;
    const uint32_t i = dmb_constraint_of_part(sim, part);
    if (i == DMB_NONE) return DMB_ERR_ID;
    *count = dmb_constraint_active(sim, i);
    for (uint32_t k = 0; k < *count; k++) multipliers[k] = sim->now.multiplier[sim->scene->constraints[i].row + k];
    return DMB_OK;
}

/* Equations of a joint by its state: none open, all six locked, else those of its kind. */
static uint32_t joint_rows(const dmb_sim *sim, uint32_t j)
{
    if (sim->joint_state[j] == DMB_JOINT_OPEN) return 0;
    if (sim->joint_state[j] == DMB_JOINT_LOCKED) return DMB_ROWS_MAX;
    return dmb_joint_row_count(sim->scene->joints[j].kind);
}

uint32_t dmb_constraint_active(const dmb_sim *sim, uint32_t constraint)
{
    const dmb_scene *scene = sim->scene;
    const dmb_constraint *c = scene->constraints + constraint;
    const dmb_scene_coupling *coupling = scene->couplings + c->index;
    switch (c->kind) {
    case DMB_OF_JOINT: return joint_rows(sim, c->index);
    case DMB_OF_COUPLING: return (uint32_t)dmb_coupling_holds(sim, coupling);
    case DMB_OF_DRIVE: return sim->joint_state[scene->drives[c->index].joint] != DMB_JOINT_OPEN;
    case DMB_OF_SPRING:
    case DMB_OF_FORCE: return 0;
    default: return scene->callbacks[c->index].rows;
    }
}

/* Redundant rows are those behind the rank in the row order of the partition (eq:joints.partition). */
uint32_t dmb_constraint_redundant(const dmb_sim *sim, uint32_t constraint)
{
    const dmb_constraint *c = sim->scene->constraints + constraint;
    const dmb_cluster *cluster = sim->scene->clusters + c->cluster;
    const uint32_t *order = sim->partition_row + cluster->row, first = c->row - cluster->row;
    const uint32_t active = dmb_constraint_active(sim, constraint);
    uint32_t count = 0;
    for (uint32_t i = sim->partition_rank[c->cluster]; i < cluster->rows; i++)
        count += order[i] >= first && order[i] < first + active;
    return count;
}

/* Only equations of positions have a violation; those of velocities hold as rates. */
double dmb_joint_violation(const dmb_sim *sim, uint32_t j)
{
    dmb_relative relative;
    dmb_joint_rows rows;
    double most = 0.0;
    dmb_joint_motion_of(sim->scene, &sim->now, j, &relative, NULL);
    dmb_joint_rows_now(sim, j, &relative, &rows);
    for (uint32_t k = 0; k < rows.count; k++)
        if (rows.holonomic >> k & 1) most = fmax(most, fabs(rows.value[k]));
    return most;
}

/* ---- Supported ends: the residual in the rows that are not solved for -------------------------------------------- */

/* The equations of a supported row are not solved: what forces and inertia leave over in it is the reaction. It is kept
 * with the accepted state, since a later evaluation, for example of an analysis, overwrites the residual. */

/* Residual of the constrained rows of the node as a wrench; components of free rows are 0. */
static void support_wrench(const dmb_sim *sim, uint32_t node, double wrench[6])
{
    static const uint32_t axial_torsional_component[2] = {DMB_X, DMB_RX};
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0; i < 6; i++) wrench[i] = 0.0;
    for (uint32_t i = 0; i < scene->constrained_count; i++) {
        const uint32_t c = scene->constrained_component[i];
        if (scene->constrained_node[i] != node) continue;
        wrench[scene->layout.size[node] == DMB_NODE_AXIAL_TORSIONAL ? axial_torsional_component[c] : c] =
            sim->support_reaction[i];
    }
}

int32_t dmb_answer_reaction(const dmb_sim *sim, dmb_id part, double reaction[6])
{
    const int32_t status = dmb_ask(sim, reaction);
    uint32_t string, body, node;
    double arm;
    if (status < 0) return status;
    string = dmb_model_part_index(sim->model, part, DMB_PART_STRING);
    body = dmb_body_index(sim, part);
    if (string < sim->scene->string_count) {
        node = sim->scene->strings[string].start_node;
        arm = sim->scene->strings[string].start_arm;
    } else if (body != DMB_NONE) {
        node = sim->scene->bodies[body].node;
        arm = sim->scene->bodies[body].arm;
    } else {
        return DMB_ERR_ID;
    }
    support_wrench(sim, node, reaction);
    dmb_arm_wrench(-arm, reaction); /* from the node to the part's reference point */
    return DMB_OK;
}

/* ---- Drives and bits --------------------------------------------------------------------------------------------- */

DMB_DECLARE_STRUCT(dmb_drive_state)

int32_t dmb_answer_drive(const dmb_sim *sim, dmb_id drive, dmb_drive_state *state)
{
    const int32_t status = dmb_ask(sim, state);
    dmb_drive_state answer = {0};
    uint32_t i;
    if (status < 0) return status;
    i = dmb_model_part_index(sim->model, drive, DMB_PART_DRIVE);
    if (i >= sim->scene->drive_count) return DMB_ERR_ID;
    answer.target = sim->now.drives[i].target;
    answer.position = sim->now.drives[i].position;
    answer.speed = dmb_drive_speed(sim->scene, &sim->now, i);
    answer.force = sim->now.drives[i].force;
    answer.power = answer.force * answer.speed;
    answer.work = sim->drive_work[i];
    answer.command = answer.made = answer.force;
    if (sim->scene->drives[i].actuator != DMB_NONE) {
        answer.command = dmb_actuator_flow_of(&sim->now, sim->scene->drives[i].actuator)->command;
        answer.made = dmb_actuator_flow_of(&sim->now, sim->scene->drives[i].actuator)->force;
    }
    return dmb_drive_state_write(state, &answer);
}

DMB_DECLARE_STRUCT(dmb_bit_state)

int32_t dmb_answer_bit(const dmb_sim *sim, dmb_id bit, dmb_bit_state *state)
{
    const int32_t status = dmb_ask(sim, state);
    dmb_bit_state answer = {0};
    dmb_bit_rock_result rock;
    uint32_t i;
    if (status < 0) return status;
    i = dmb_model_part_index(sim->model, bit, DMB_PART_BIT);
    if (i >= sim->scene->bit_count) return DMB_ERR_ID;
    dmb_bit_force_of(sim, i, &rock, &answer.load);
    answer.on_bottom = rock.on_bottom;
    answer.advance = sim->now.bit_advance[i];
    answer.bottom = sim->now.bit_bottom[i];
    answer.depth_of_cut = rock.depth_of_cut;
    answer.weight = rock.weight_on_bit;
    answer.torque = rock.torque_on_bit;
    answer.side_speed = dmb_bit_side_of(sim, i, answer.side_force);
    return dmb_bit_state_write(state, &answer);
}

/* ---- Springs ----------------------------------------------------------------------------------------------------- */

DMB_DEFINE_INIT(dmb_spring_state, 136, {.length = 0.0})

static void world_point(const dmb_scene *scene, const dmb_point_motion *point, double x[3])
{
    dmb_vec3_copy(point->x, x);
    if (point->nodes > 0) dmb_vec3_add(x, scene->reference_position + 3 * (size_t)point->node[0], x);
}

int32_t dmb_answer_spring(const dmb_sim *sim, dmb_id spring, dmb_spring_state *state)
{
    const int32_t status = dmb_ask(sim, state);
    dmb_spring_state answer = {0};
    dmb_spring_motion m;
    if (status < 0) return status;
    const uint32_t i = dmb_model_part_index(sim->model, spring, DMB_PART_SPRING);
    if (i >= sim->scene->spring_count) return DMB_ERR_ID;
    const dmb_scene_spring *s = sim->scene->springs + i;
    dmb_spring_motion_of(sim->scene, &sim->now, i, 1, &m);
    answer.length = m.length;
    answer.elongation = m.length - s->free_length;
    answer.speed = m.rate;
    answer.elastic = m.force.elastic;
    answer.damper = m.force.damper;
    answer.force = m.force.elastic + m.force.damper;
    answer.energy = dmb_spring_energy_at(&s->law, sim->scene->spring_points + s->law.first, answer.elongation);
    dmb_vec3_copy(m.n, answer.direction);
    world_point(sim->scene, &m.a, answer.point_a);
    world_point(sim->scene, &m.b, answer.point_b);
    return dmb_spring_state_write(state, &answer);
}

/* ---- Owners of the rows of the equations ------------------------------------------------------------------------- */

DMB_DEFINE_INIT(dmb_row, 32, {.component = DMB_X})

static int32_t is_driven(const dmb_scene *scene, uint32_t row)
{
    for (uint32_t i = 0; i < scene->drive_count; i++)
        if (scene->drives[i].kind == DMB_DRIVE_MOTION && scene->drives[i].row == row) return 1;
    return 0;
}

int32_t dmb_answer_row(const dmb_sim *sim, uint32_t row, dmb_row *answer)
{
    static const int32_t axial_torsional_component[2] = {DMB_X, DMB_RX};
    const int32_t status = dmb_ask(sim, answer);
    dmb_row found = {0};
    if (status < 0) return status;
    const dmb_scene *scene = sim->scene;
    if (row >= scene->row_count) return DMB_ERR_VALUE;
    found.node = dmb_node_of_row(scene, row);
    const uint32_t c = row - scene->layout.row[found.node];
    const dmb_owner owner = dmb_owner_of_node(scene, found.node);
    const uint32_t kind = owner.kind[0] == 's' ? DMB_PART_STRING : DMB_PART_BODY;
    found.component =
        scene->layout.size[found.node] == DMB_NODE_AXIAL_TORSIONAL ? axial_torsional_component[c] : (int32_t)c;
    found.pipe = owner.pipe;
    found.state = scene->solved_row[row] ? DMB_ROW_FREE : is_driven(scene, row) ? DMB_ROW_DRIVEN : DMB_ROW_HELD;
    found.part = dmb_model_id(sim->model, kind, owner.index);
    return dmb_row_write(answer, &found);
}

/* Numbers of the part's equations among those of dmb_analysis_array and the Jacobian, which leave out inactive rows:
 * rows of all constraints before it are counted as far as they are active. */
int32_t dmb_answer_constraint_rows(const dmb_sim *sim, dmb_id part, uint32_t *first, uint32_t *count)
{
    const int32_t status = dmb_ask(sim, first);
    uint32_t before = 0;
    if (status < 0) return status;
    if (count == NULL) return DMB_ERR_NULL;
    const uint32_t constraint = dmb_constraint_of_part(sim, part);
    if (constraint == DMB_NONE) return DMB_ERR_ID;
    for (uint32_t i = 0; i < sim->scene->constraint_count; i++)
        if (sim->scene->constraints[i].row < sim->scene->constraints[constraint].row)
            before += dmb_constraint_active(sim, i);
    *first = before;
    *count = dmb_constraint_active(sim, constraint);
    return DMB_OK;
}
