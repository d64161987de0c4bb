#include <string.h>

#include "kernel/kernels.h"
#include "system/bit.h"
#include "system/evaluation.h"
#include "system/joint_state.h"
#include "system/node.h"

/* Rotation about the node's own x axis since time 0, on the turn the increment of the step leads to. */
static void unwrap_turns(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0, count; i < scene->node_count; i += count) {
        count = dmb_full_nodes_at(scene, i);
        if (count > 0) {
            const dmb_turn_run run = {.count = count,
                                      .reference = scene->reference_quaternion + 4 * i,
                                      .quaternion = sim->trial.quaternion + 4 * i,
                                      .increment = sim->increment + scene->layout.row[i],
                                      .start = sim->now.turn + i,
                                      .turn = sim->trial.turn + i};
            scene->kernels->turns(&run);
        } else {
            count = 1;
        }
    }
}

void dmb_system_accept(dmb_evaluation *evaluation)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    unwrap_turns(sim);
    memcpy(sim->residual_row, sim->correction, scene->row_count * sizeof(double));
    for (uint32_t i = 0; i < scene->drive_count; i++) {
        const dmb_scene_drive *drive = scene->drives + i;
        if (drive->joint != UINT32_MAX) continue; /* done with the joint */
        sim->trial.drive_position[i] = sim->now.drive_position[i] + sim->increment[drive->row];
        if (drive->kind == DMB_DRIVE_MOTION) sim->trial.drive_force[i] = sim->correction[drive->row];
    }
    if (scene->cluster_count) dmb_joints_accept(evaluation);
    for (uint32_t k = 0; k < scene->bit_count; k++) {
        if (evaluation->dynamic)
            dmb_bit_accept(sim, k);
        else
            sim->trial.bit_bottom[k] = sim->now.bit_bottom[k]; /* moving to equilibrium cuts nothing */
    }
}
