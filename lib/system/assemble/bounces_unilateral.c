/* Bounces of joint stops and one-sided springs: their ends, damping and mean force. */
#include "system/assemble/bounces.h"

#include <math.h>

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

void dmb_bounce_end_at(const dmb_scene *scene, uint32_t u, double place, dmb_unilateral_end *end)
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
    dmb_bounce_end_at(sim->scene, u, sim->now.bounce_place[u], a);
    dmb_bounce_end_at(sim->scene, u, sim->trial.bounce_place[u], b);
}

double dmb_bounce_heat(const dmb_sim *sim, const dmb_configuration *configuration, uint32_t u)
{
    dmb_unilateral_end end;
    dmb_bounce_end_at(sim->scene, u, configuration->bounce_place[u], &end);
    return -(configuration->bounce_force[u] - end.force) * configuration->bounce_speed[u];
}

int dmb_bounce_power(const dmb_sim *sim, uint32_t u)
{
    return u < sim->scene->law_count ? DMB_POWER_IMPACT : DMB_POWER_DAMPING;
}

static void note(dmb_sim *sim, uint32_t u, const dmb_bounce *law)
{
    sim->trial.bounce_place[u] = law->place;
    sim->trial.bounce_speed[u] = law->speed;
    sim->trial.bounce_force[u] = law->force;
    sim->bounce_own[u] = sim->bounce_warmth[u] = 0.0;
}

/* The trapezoidal rule of the ledger uses half of the power at each end of the step: at its start that of the law, or 0
 * if the force of the step before was a mean force. */
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
    *sim->laws_bounce = 1;
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
