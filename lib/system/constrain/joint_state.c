#include "system/constrain/joint_state.h"

#include "math/vec3.h"
#include "system/constrain/cluster.h"
#include "system/constrain/constraint_rows.h"

/* Unwrapped angles RX and RY, from which the next step counts its turns. */
void dmb_joint_take_turns(dmb_sim *sim, uint32_t j, const dmb_joint_coordinates *c)
{
    sim->trial.joint_turn[2 * j] = c->value[3];
    sim->trial.joint_turn[2 * j + 1] = c->value[4];
}

void dmb_joints_follow(dmb_evaluation *evaluation)
{
    dmb_sim *sim = evaluation->sim;
    for (uint32_t j = 0; j < sim->scene->joint_count; j++) {
        dmb_relative relative;
        dmb_joint_coordinates c;
        dmb_joint_motion_of(sim->scene, &sim->trial, j, &relative, NULL);
        dmb_joint_coordinates_in(evaluation, j, &relative, &c);
        dmb_joint_take_turns(sim, j, &c);
    }
}

/* -f . B v = f . rate is the power of what moves the callers' constraints. */
void dmb_joint_reactions(dmb_evaluation *evaluation)
{
    dmb_sim *sim = evaluation->sim;
    dmb_clusters_least_norm(sim);
    for (uint32_t i = 0; i < sim->scene->constraint_count; i++) {
        const dmb_constraint *c = sim->scene->constraints + i;
        for (uint32_t k = 0; k < c->rows && c->kind == DMB_OF_CALLBACK; k++)
            evaluation->power[DMB_POWER_LOADS] += sim->trial.multiplier[c->row + k] * sim->constraint_rate[c->row + k];
    }
}

void dmb_joints_accept(dmb_evaluation *evaluation)
{
    dmb_sim *sim = evaluation->sim;
    dmb_joints_follow(evaluation);
    dmb_joint_reactions(evaluation);
    dmb_clusters_watch(sim);
}

/* A locked joint stays at R0, p0: those it has now (constraint/joint.h). */
void dmb_joint_hold(dmb_sim *sim, uint32_t j)
{
    dmb_relative relative;
    dmb_joint_place_hold(sim, j, 0);
    dmb_joint_motion(sim->scene, &sim->now, j, &relative, NULL);
    dmb_mat3_copy(relative.R, sim->joint_lock + 12 * j);
    dmb_vec3_copy(relative.p, sim->joint_lock + 12 * j + 9);
    dmb_joint_place_hold(sim, j, sim->scene->joints[j].kind == DMB_JOINT_POINT_ON_HOLE);
}

void dmb_joint_take_state(dmb_sim *sim, uint32_t j, int32_t state)
{
    sim->joint_state[j] = state;
    if (state == DMB_JOINT_LOCKED)
        dmb_joint_hold(sim, j);
    else
        dmb_joint_place_hold(sim, j, 0);
}

/* Springs and stops: the integral of each law over its coordinate. */
double dmb_joint_energy(const dmb_sim *sim, const dmb_configuration *configuration)
{
    const dmb_scene *scene = sim->scene;
    double sum = 0.0;
    for (uint32_t j = 0; j < scene->joint_count; j++) {
        const dmb_scene_joint *joint = scene->joints + j;
        dmb_relative relative;
        dmb_joint_coordinates c;
        if (joint->law == DMB_NONE || sim->joint_state[j] == DMB_JOINT_OPEN) continue;
        dmb_joint_motion_of(scene, configuration, j, &relative, NULL);
        dmb_joint_coordinates_at(relative.R, relative.p, relative.V, configuration->joint_turn + 2 * j, &c);
        for (uint32_t i = 0; i < 6; i++)
            if (joint->law_mask >> i & 1) sum += dmb_joint_law_energy(scene->laws + joint->law + i, c.value[i]);
    }
    return sum;
}
