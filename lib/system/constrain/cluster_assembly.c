#include "system/constrain/cluster.h"

#include <string.h>

#include "math/se3.h"
#include "sim/layout.h"
#include "system/constrain/constraint_rows.h"
#include "system/constrain/joint_state.h"

enum { DMB_ASSEMBLY_MAX = 200 };
/* [m, -] what may be left of an equation that is not needed, or at the end. */
#define DMB_ASSEMBLY_VIOLATION 1e-8

static void set_up(dmb_sim *sim, dmb_evaluation *evaluation)
{
    memset(evaluation, 0, sizeof *evaluation);
    evaluation->sim = sim;
    evaluation->time = sim->clock->time;
    evaluation->load_factor = evaluation->pseudo_factor = 1.0;
}

/* States as described; a joint locked from the start is locked where it is described. */
static void described_states(dmb_sim *sim)
{
    for (uint32_t j = 0; j < sim->scene->joint_count; j++) {
        const int32_t state = sim->scene->joints[j].state;
        if (state != DMB_JOINT_LOCKED) dmb_joint_hold(sim, j); /* until it is locked */
        dmb_joint_take_state(sim, j, state);
    }
}

static int32_t check_callbacks(dmb_sim *sim)
{
    int32_t status = DMB_OK;
    for (uint32_t i = 0; i < sim->scene->callback_count && status >= 0; i++) status = dmb_callback_check(sim, i);
    return status;
}

static int32_t refuse(dmb_sim *sim, uint32_t row, double violation, const char *what)
{
    sim->reduced_mode->row = row;
    sim->reduced_mode->violation = violation;
    dmb_clusters_explain(sim, what);
    return DMB_ERR_GEOMETRY;
}

/* All positions by Newton with a choice of its own each time: the rank may change on the way. */
static int32_t close_positions(dmb_evaluation *evaluation)
{
    dmb_sim *sim = evaluation->sim;
    uint32_t row = DMB_NONE;
    double violation = 0.0;
    int32_t status = DMB_OK;
    for (uint32_t k = 0; k < DMB_ASSEMBLY_MAX && status >= 0; k++) {
        status = dmb_clusters_correct(evaluation);
        violation = dmb_clusters_violation(sim, 0, &row);
        if (status == DMB_NOTE_STOPPED) break; /* nothing moves any more */
    }
    if (status == DMB_ERR_CALLBACK) {
        dmb_message owner;
        dmb_constraint_text(sim->scene, dmb_constraint_of_row(sim->scene, sim->reduced_mode->row), &owner);
        dmb_message_set(&sim->message, "%s: the callback failed or gave a value beyond +-1e30 at time %g", owner.text,
                        sim->clock->time);
        return status;
    }
    if (violation <= DMB_ASSEMBLY_VIOLATION * sim->reduced_mode->length && status >= 0) return DMB_OK;
    if (row == DMB_NONE) row = 0;
    return refuse(sim, row, fabs(sim->constraint_value[row]), "its parts cannot be brought together");
}

int32_t dmb_joint_refuse_flip(dmb_sim *sim, uint32_t joint)
{
    const dmb_scene_joint *of = sim->scene->joints + joint;
    const int locked = sim->joint_state[joint] == DMB_JOINT_LOCKED;
    dmb_relative relative;
    dmb_message owner;
    double R[9];
    if (sim->joint_state[joint] == DMB_JOINT_OPEN) return DMB_OK;
    dmb_joint_motion_of(sim->scene, &sim->trial, joint, &relative, NULL);
    dmb_mat3_copy(relative.R, R);
    if (locked) dmb_mat3_mul_nt(relative.R, sim->joint_lock + 12 * (size_t)joint, R);
    const double angle = dmb_joint_flip(locked ? DMB_JOINT_FIXED : of->kind, R);
    if (angle == 0.0) return DMB_OK;
    dmb_constraint_text(sim->scene, of->constraint, &owner);
    dmb_message_set(&sim->message, "%s: turned over: axes that it keeps parallel are %g rad apart at time %g",
                    owner.text, angle, sim->clock->time);
    return DMB_ERR_GEOMETRY;
}

static int32_t refuse_flips(dmb_sim *sim)
{
    int32_t status = DMB_OK;
    for (uint32_t j = 0; j < sim->scene->joint_count && status >= 0; j++) status = dmb_joint_refuse_flip(sim, j);
    return status;
}

/* B v + rate of the rows that were dropped must vanish with the others. */
int32_t dmb_assembled_speeds(dmb_evaluation *evaluation)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0; i < scene->constraint_count; i++) {
        const dmb_constraint *c = scene->constraints + i;
        for (uint32_t k = 0; k < c->rows; k++) {
            const double *B = sim->constraint_jacobian + c->jacobian + (size_t)k * c->columns;
            double sum = sim->constraint_rate[c->row + k], size = 1.0 + fabs(sum);
            for (uint32_t n = 0; n < c->node_count; n++)
                for (uint32_t s = 0; s < scene->layout.size[c->node[n]]; s++) {
                    const double part = B[c->column[n] + s] * sim->trial.velocity[scene->layout.row[c->node[n]] + s];
                    sum += part;
                    size += fabs(part); /* rounding goes with it, whatever the unit of the row */
                }
            if (fabs(sum) > DMB_ASSEMBLY_VIOLATION * size)
                return refuse(sim, c->row + k, sum, "its speed cannot be had");
        }
    }
    return DMB_OK;
}

static void measure(dmb_sim *sim)
{
    double *most = sim->counters->assembly;
    most[0] = most[1] = 0.0;
    for (uint32_t i = 0; i < sim->scene->node_count; i++) {
        double move[3], q[4], turn[3];
        dmb_vec3_sub(sim->trial.displacement + 3 * (size_t)i, sim->now.displacement + 3 * (size_t)i, move);
        dmb_quat_between(sim->now.quaternion + 4 * (size_t)i, sim->trial.quaternion + 4 * (size_t)i, q);
        dmb_quat_log(q, turn);
        most[0] = fmax(most[0], dmb_vec3_norm(move));
        most[1] = fmax(most[1], fmax(dmb_vec3_norm(turn), fabs(sim->trial.turn[i] - sim->now.turn[i])));
    }
}

void dmb_note_projection(dmb_sim *sim)
{
    const dmb_block_layout *layout = &sim->scene->layout;
    double *most = sim->counters->projection;
    for (uint32_t i = 0; i < sim->scene->node_count; i++)
        for (uint32_t c = 0; c < layout->size[i]; c++) {
            const uint32_t row = layout->row[i] + c, kind = 2 * c < layout->size[i] ? 0 : 1;
            most[kind] = fmax(most[kind], fabs(sim->trial.velocity[row] - sim->now.velocity[row]));
        }
}

static double coordinate_of(dmb_sim *sim, uint32_t j, int32_t component)
{
    dmb_relative relative;
    dmb_joint_coordinates c;
    dmb_joint_motion(sim->scene, &sim->trial, j, &relative, NULL);
    dmb_joint_coordinates_at(relative.R, relative.p, relative.V, sim->trial.joint_turn + 2 * (size_t)j, &c);
    return c.value[component];
}

/* Turns of the coordinates, what couplings keep and where drives begin, for the closed scene. */
static void keep_coordinates(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t j = 0; j < scene->joint_count; j++) {
        const dmb_scene_joint *joint = scene->joints + j;
        dmb_relative relative;
        dmb_joint_coordinates c;
        dmb_joint_motion(scene, &sim->trial, j, &relative, NULL);
        dmb_joint_coordinates_at(relative.R, relative.p, relative.V, joint->initial_position + 3, &c);
        dmb_joint_take_turns(sim, j, &c);
        for (uint32_t i = joint->first_drive; i < joint->first_drive + joint->drive_count; i++)
            sim->drive_offset[scene->joint_drives[i]] = c.value[scene->drives[scene->joint_drives[i]].component];
    }
    for (uint32_t i = 0; i < scene->coupling_count; i++) {
        const dmb_scene_coupling *coupling = scene->couplings + i;
        double sum = 0.0;
        for (uint32_t k = 0; k < coupling->count; k++)
            sum += coupling->factor[k] * coordinate_of(sim, coupling->joint[k], coupling->component[k]);
        sim->constraint_offset[scene->constraints[coupling->constraint].row] = sum;
    }
}

int32_t dmb_assemble(dmb_sim *sim)
{
    dmb_evaluation evaluation;
    int32_t status = check_callbacks(sim);
    if (status < 0) return status;
    set_up(sim, &evaluation);
    dmb_clusters_prepare(sim);
    described_states(sim);
    dmb_configuration_copy(sim, &sim->now, &sim->trial);
    evaluation.assembling = 1;
    status = close_positions(&evaluation);
    if (status >= 0) status = dmb_clusters_settle(&evaluation, DMB_SETTLE_POSE | DMB_SETTLE_SPEED, 0);
    if (status >= 0) status = refuse_flips(sim);
    if (status >= 0) status = dmb_assembled_speeds(&evaluation);
    if (status < 0) return status;
    measure(sim);
    dmb_note_projection(sim);
    keep_coordinates(sim);
    dmb_configuration_copy(sim, &sim->trial, &sim->now);
    return DMB_OK;
}
