/* Stops of joints and springs that may open: the steps in which they touch or let go (eq:unilateral.mean). */
#include "system/assemble/bounces.h"

#include <math.h>
#include <string.h>

#include "system/assemble/assemble.h"

/* ---- Laws -------------------------------------------------------------------------------------------------------- */

uint32_t dmb_bounce_of_spring(const dmb_scene *scene, uint32_t spring)
{
    return scene->law_count + spring;
}

static const dmb_scene_spring *spring_of(const dmb_scene *scene, uint32_t u)
{
    return u < scene->law_count ? NULL : scene->springs + (u - scene->law_count);
}

int dmb_bounce_can_open(const dmb_scene *scene, uint32_t u)
{
    const dmb_scene_spring *spring = spring_of(scene, u);
    return spring != NULL ? dmb_spring_can_open(&spring->law) : dmb_stop_acts(scene->laws + u);
}

static void end_at(const dmb_scene *scene, uint32_t u, double place, dmb_unilateral_end *end)
{
    const dmb_scene_spring *spring = spring_of(scene, u);
    if (spring != NULL)
        dmb_spring_end_at(&spring->law, scene->spring_points + spring->law.first, place, end);
    else
        dmb_stop_at(scene->laws + u, place, end);
}

double dmb_bounce_damping(const dmb_scene *scene, uint32_t u)
{
    const dmb_scene_spring *spring = spring_of(scene, u);
    if (spring == NULL) return scene->laws[u].stop_damping;
    return spring->law.acts != DMB_SPRING_BOTH ? spring->law.damping : 0.0;
}

void dmb_bounce_ends(const dmb_sim *sim, uint32_t u, dmb_unilateral_end *a, dmb_unilateral_end *b)
{
    end_at(sim->scene, u, sim->now.bounce_place[u], a);
    end_at(sim->scene, u, sim->trial.bounce_place[u], b);
}

/* ---- Force within a step ----------------------------------------------------------------------------------------- */

double dmb_bounce_heat(const dmb_sim *sim, const dmb_configuration *configuration, uint32_t u)
{
    dmb_unilateral_end end;
    end_at(sim->scene, u, configuration->bounce_place[u], &end);
    return -(configuration->bounce_force[u] - end.force) * configuration->bounce_speed[u];
}

static void note(dmb_sim *sim, uint32_t u, const dmb_bounce *law)
{
    sim->trial.bounce_place[u] = law->place;
    sim->trial.bounce_speed[u] = law->speed;
    sim->trial.bounce_force[u] = law->force;
    sim->bounce_own[u] = sim->bounce_warmth[u] = 0.0;
}

/* The trapezoidal rule takes half of the power at each end of the step: that at its start is what the law had, or none
 * where the force of the step before was the step's own. */
int dmb_bounce_at(dmb_evaluation *evaluation, uint32_t u, const dmb_bounce *law, dmb_bounce_force *own)
{
    dmb_sim *sim = evaluation->sim;
    dmb_unilateral_end a, b;
    dmb_unilateral_mean mean;
    note(sim, u, law);
    if (!(evaluation->own_factor > 0.0) || !dmb_bounce_can_open(sim->scene, u)) return 0;
    dmb_bounce_ends(sim, u, &a, &b);
    if (sim->bounce_mode[u] == DMB_BOUNCE_LAW && !dmb_unilateral_touches(&a, &b)) return 0;
    dmb_unilateral_mean_of(&a, &b, dmb_bounce_damping(sim->scene, u), evaluation->step, &mean);
    own->force = evaluation->own_factor * mean.force;
    own->by_place = evaluation->own_factor * mean.by_place;
    own->heat = -2.0 * mean.dissipated / evaluation->step;
    if (sim->bounce_mode[u] == DMB_BOUNCE_OPENS) own->heat -= dmb_bounce_heat(sim, &sim->now, u);
    sim->bounce_own[u] = own->force;
    sim->bounce_warmth[u] = own->heat;
    return 1;
}

void dmb_bounce_rest(dmb_sim *sim, uint32_t u)
{
    const dmb_joint_law *law = sim->scene->laws + u;
    sim->trial.bounce_place[u] = fmax(law->stop_low, fmin(law->stop_high, 0.0));
    sim->trial.bounce_force[u] = sim->trial.bounce_speed[u] = 0.0;
}

/* ---- Course of a step -------------------------------------------------------------------------------------------- */

void dmb_bounces_begin(dmb_sim *sim)
{
    for (uint32_t u = 0; u < sim->scene->unilateral_count; u++)
        sim->bounce_mode[u] = sim->bounce_age[u] < 0.0 ? DMB_BOUNCE_OWN : DMB_BOUNCE_LAW;
}

/* It pressed at the start of the step and does so no more, or on the other side. */
static int opens(const dmb_sim *sim, uint32_t u)
{
    dmb_unilateral_end a, b;
    if (sim->bounce_mode[u] != DMB_BOUNCE_LAW || !dmb_bounce_can_open(sim->scene, u)) return 0;
    dmb_bounce_ends(sim, u, &a, &b);
    if (!a.closed || sim->now.bounce_force[u] == 0.0) return 0;
    return !b.closed || a.depth * b.depth < 0.0 || (b.depth != 0.0 && sim->trial.bounce_force[u] == 0.0);
}

int32_t dmb_bounces_open(dmb_sim *sim)
{
    int32_t found = 0;
    for (uint32_t u = 0; u < sim->scene->unilateral_count; u++) {
        if (!opens(sim, u)) continue;
        sim->bounce_mode[u] = DMB_BOUNCE_OPENS;
        found = 1;
    }
    return found;
}

int32_t dmb_bounces_change(const dmb_sim *sim)
{
    for (uint32_t u = 0; u < sim->scene->unilateral_count; u++) {
        dmb_unilateral_end a, b;
        if (!dmb_bounce_can_open(sim->scene, u)) continue;
        dmb_bounce_ends(sim, u, &a, &b);
        if (a.closed != b.closed || a.depth * b.depth < 0.0) return 1;
    }
    return 0;
}

/* Joint of a law, and which of its six it is. */
static uint32_t joint_of(const dmb_scene *scene, uint32_t u)
{
    for (uint32_t j = 0; j < scene->joint_count; j++)
        if (scene->joints[j].law != DMB_NONE && u - scene->joints[j].law < 6) return j;
    return DMB_NONE;
}

void dmb_bounce_press(dmb_evaluation *evaluation, uint32_t u, double force)
{
    dmb_sim *sim = evaluation->sim;
    if (u < sim->scene->law_count)
        dmb_joint_press(evaluation, joint_of(sim->scene, u), u % 6, force);
    else
        dmb_spring_press(sim, u - sim->scene->law_count, force);
}

static void mark_nodes(dmb_sim *sim, double *part)
{
    const dmb_block_layout *layout = &sim->scene->layout;
    for (uint32_t i = 0; i < sim->scene->node_count; i++)
        for (uint32_t r = layout->row[i]; r < layout->row[i + 1]; r++)
            if (sim->residual[r] != 0.0) part[i] = 1.0;
}

void dmb_bounces_release(dmb_evaluation *evaluation, double *rows, double *part)
{
    dmb_sim *sim = evaluation->sim;
    const uint32_t n = sim->scene->row_count;
    if (sim->scene->unilateral_count == 0) return;
    memcpy(sim->bounce_rows, sim->residual, n * sizeof(double));
    memset(sim->residual, 0, n * sizeof(double));
    for (uint32_t u = 0; u < sim->scene->unilateral_count; u++)
        if (sim->bounce_mode[u] == DMB_BOUNCE_OPENS) dmb_bounce_press(evaluation, u, sim->now.bounce_force[u]);
    mark_nodes(sim, part);
    for (uint32_t i = 0; i < n; i++) rows[i] += sim->residual[i];
    memcpy(sim->residual, sim->bounce_rows, n * sizeof(double));
}

/* ---- Starts and jumps -------------------------------------------------------------------------------------------- */

void dmb_bounces_jump(dmb_sim *sim)
{
    for (uint32_t u = 0; u < sim->scene->unilateral_count; u++) {
        sim->bounce_age[u] = fabs(sim->bounce_age[u]);
        sim->now.bounce_place[u] = sim->trial.bounce_place[u];
        sim->now.bounce_force[u] = sim->trial.bounce_force[u];
        sim->now.bounce_speed[u] = sim->trial.bounce_speed[u];
    }
}

void dmb_bounces_start(dmb_sim *sim)
{
    for (uint32_t s = 0; s < sim->scene->site_count; s++)
        sim->site_age[s] = sim->now.site_penetration[s] > 0.0 ? (uint32_t)DMB_BOUNCE_STEPS : 0;
    for (uint32_t u = 0; u < sim->scene->unilateral_count; u++) {
        dmb_unilateral_end end;
        end_at(sim->scene, u, sim->now.bounce_place[u], &end);
        sim->bounce_age[u] = dmb_bounce_can_open(sim->scene, u) && end.closed ? DMB_BOUNCE_STEPS : 0.0;
    }
}
