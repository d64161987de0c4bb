/* Opening laws in the history of a step (eq:contact.release) and forces of single laws in the residual. */
#include "system/assemble/bounces.h"

#include <math.h>
#include <string.h>

#include "system/assemble/assemble.h"

void dmb_bounce_press(dmb_evaluation *evaluation, const dmb_configuration *at, uint32_t u, double force)
{
    dmb_sim *sim = evaluation->sim;
    const uint32_t law = dmb_bounce_law_of(sim->scene, u);
    if (law != DMB_NONE)
        dmb_joint_press(evaluation, at, dmb_bounce_joint_of(sim->scene, law), law % 6, force);
    else
        dmb_spring_press(sim, at, u - sim->scene->law_count, force);
}

void dmb_bounce_press_mean(dmb_evaluation *evaluation, uint32_t u, double force)
{
    dmb_sim *sim = evaluation->sim;
    const uint32_t law = dmb_bounce_law_of(sim->scene, u);
    if (law != DMB_NONE)
        dmb_joint_press_mean(evaluation, dmb_bounce_joint_of(sim->scene, law), law % 6, force);
    else
        dmb_spring_press_mean(sim, u - sim->scene->law_count, force);
}

/* part = 1 at all nodes on which a removed force acts: the whole difference a0 - v0' is dropped there. Stops and
 * springs that open have mean forces in the step, so that no part of it is left to their law. */
static void mark_nodes(dmb_sim *sim, double *part)
{
    const dmb_block_layout *layout = &sim->scene->layout;
    for (uint32_t i = 0; i < sim->scene->node_count; i++)
        for (uint32_t r = layout->row[i]; r < layout->row[i + 1]; r++)
            if (sim->residual[r] != 0.0) part[i] = 1.0;
}

/* The forces are computed as a residual at the pose of now, with the mapping of the assembly; the residual of the step
 * is put aside meanwhile. */
void dmb_bounces_release(dmb_evaluation *evaluation, double *rows, double *part)
{
    dmb_sim *sim = evaluation->sim;
    const uint32_t n = sim->scene->row_count;
    if (sim->scene->unilateral_count == 0) return;
    memcpy(sim->bounce_rows, sim->residual, n * sizeof(double));
    memset(sim->residual, 0, n * sizeof(double));
    for (uint32_t u = 0; u < sim->scene->unilateral_count; u++)
        if (sim->bounce_mode[u] == DMB_BOUNCE_OPENS)
            dmb_bounce_press(evaluation, &sim->now, u, sim->now.bounce_force[u]);
    mark_nodes(sim, part);
    for (uint32_t i = 0; i < n; i++) rows[i] += sim->residual[i];
    memcpy(sim->residual, sim->bounce_rows, n * sizeof(double));
}

/* The accelerations contain the forces of all laws, so that no mean force continues; ages stay. */
void dmb_bounces_jump(dmb_sim *sim)
{
    for (uint32_t s = 0; s < sim->scene->site_count; s++) sim->site_age[s] &= DMB_SITE_OWN - 1;
    for (uint32_t u = 0; u < sim->scene->unilateral_count; u++) {
        sim->bounce_age[u] = fabs(sim->bounce_age[u]);
        sim->now.bounce_place[u] = sim->trial.bounce_place[u];
        sim->now.bounce_force[u] = sim->trial.bounce_force[u];
        sim->now.bounce_speed[u] = sim->trial.bounce_speed[u];
    }
}
