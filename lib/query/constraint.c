#include "query/constraint.h"

#include "system/constraint_rows.h"

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
    case DMB_OF_COUPLING:
        return sim->joint_state[coupling->joint[0]] != DMB_JOINT_OPEN &&
               sim->joint_state[coupling->joint[1]] != DMB_JOINT_OPEN;
    case DMB_OF_DRIVE: return sim->joint_state[scene->drives[c->index].joint] != DMB_JOINT_OPEN;
    default: return scene->callbacks[c->index].rows;
    }
}

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

double dmb_joint_misfit(const dmb_sim *sim, uint32_t j)
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
