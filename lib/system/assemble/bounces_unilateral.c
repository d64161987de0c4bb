/* Stops of joints and springs as unilateral laws: their numbering, their ends, damping and mean force.
 *
 *     index u                             law                            can open           holds
 *     ---------------------------------   ----------------------------   ----------------   ----------------
 *     0 .. law_count - 1                  stop of a joint coordinate     if it has bounds   never
 *     law_count .. + spring_count - 1     spring between two points      one-sided, or      two-sided, without a
 *                                                                        with a table       table, with a stiffness
 *     behind, + law_count                 spring of a joint coordinate   never              with a stiffness
 *
 * Laws that can open have mean forces where they touch or open (eq:unilateral.mean), laws that hold where their
 * gradient turns in a step that does not resolve them (eq:unilateral.holding). */
#include "system/assemble/bounces.h"

#include <math.h>

uint32_t dmb_bounce_of_spring(const dmb_scene *scene, uint32_t spring)
{
    return scene->law_count + spring;
}

uint32_t dmb_bounce_of_law(const dmb_scene *scene, uint32_t law)
{
    return scene->law_count + scene->spring_count + law;
}

uint32_t dmb_bounce_law_of(const dmb_scene *scene, uint32_t u)
{
    if (u < scene->law_count) return u;
    return u < scene->law_count + scene->spring_count ? DMB_NONE : u - scene->law_count - scene->spring_count;
}

uint32_t dmb_bounce_joint_of(const dmb_scene *scene, uint32_t law)
{
    for (uint32_t j = 0; j < scene->joint_count; j++)
        if (scene->joints[j].law != DMB_NONE && law - scene->joints[j].law < 6) return j;
    return DMB_NONE;
}

static int is_stop(const dmb_scene *scene, uint32_t u)
{
    return u < scene->law_count;
}

static const dmb_scene_spring *spring_of(const dmb_scene *scene, uint32_t u)
{
    return dmb_bounce_law_of(scene, u) != DMB_NONE ? NULL : scene->springs + (u - scene->law_count);
}

int dmb_bounce_can_open(const dmb_scene *scene, uint32_t u)
{
    const dmb_scene_spring *spring = spring_of(scene, u);
    return spring != NULL ? dmb_spring_can_open(&spring->law) : is_stop(scene, u) && dmb_stop_acts(scene->laws + u);
}

int dmb_bounce_holds(const dmb_scene *scene, uint32_t u)
{
    const dmb_scene_spring *spring = spring_of(scene, u);
    if (spring != NULL) return !dmb_spring_can_open(&spring->law) && spring->law.stiffness > 0.0;
    return !is_stop(scene, u) && scene->laws[dmb_bounce_law_of(scene, u)].stiffness > 0.0;
}

int dmb_bounce_acts(const dmb_scene *scene, uint32_t u)
{
    return dmb_bounce_can_open(scene, u) || dmb_bounce_holds(scene, u);
}

void dmb_bounce_end_at(const dmb_scene *scene, uint32_t u, double place, dmb_unilateral_end *end)
{
    const dmb_scene_spring *spring = spring_of(scene, u);
    if (spring != NULL)
        dmb_spring_end_at(&spring->law, scene->spring_points + spring->law.first, place, end);
    else if (is_stop(scene, u))
        dmb_stop_at(scene->laws + u, place, end);
    else
        dmb_joint_spring_end_at(scene->laws + dmb_bounce_law_of(scene, u), place, end);
}

/* Only of dampers that act one-sided, together with their spring. The damper of a two-sided spring acts always and is
 * not part of the bounce. */
double dmb_bounce_damping(const dmb_scene *scene, uint32_t u)
{
    const dmb_scene_spring *spring = spring_of(scene, u);
    if (spring == NULL) return is_stop(scene, u) ? scene->laws[u].stop_damping : 0.0;
    return spring->law.acts != DMB_SPRING_BOTH ? spring->law.damping : 0.0;
}

void dmb_bounce_ends(const dmb_sim *sim, uint32_t u, dmb_unilateral_end *a, dmb_unilateral_end *b)
{
    dmb_bounce_end_at(sim->scene, u, sim->now.bounce_place[u], a);
    dmb_bounce_end_at(sim->scene, u, sim->trial.bounce_place[u], b);
}

/* The force beyond the elastic one is the damper's. */
double dmb_bounce_heat(const dmb_sim *sim, const dmb_configuration *configuration, uint32_t u)
{
    dmb_unilateral_end end;
    dmb_bounce_end_at(sim->scene, u, configuration->bounce_place[u], &end);
    return -(configuration->bounce_force[u] - end.force) * configuration->bounce_speed[u];
}

int dmb_bounce_power(const dmb_sim *sim, uint32_t u)
{
    return is_stop(sim->scene, u) ? DMB_POWER_IMPACT : DMB_POWER_DAMPING;
}

static void note(dmb_sim *sim, uint32_t u, const dmb_bounce *law)
{
    sim->trial.bounce_place[u] = law->place;
    sim->trial.bounce_speed[u] = law->speed;
    sim->trial.bounce_force[u] = law->force;
    sim->bounce_own[u] = sim->bounce_warmth[u] = 0.0;
}

/* Numerical damping e (f1 - f0), e = (1 - r)/(2 (1 + r)): a motion that steps do not resolve at all then goes by x1 =
 * -r x0, as with the law, r being the spectral radius (eq:unilateral.holding). */
static void add_numerical_damping(const dmb_sim *sim, const dmb_unilateral_end *a, const dmb_unilateral_end *b,
                                  dmb_unilateral_mean *mean)
{
    const double r = sim->options.spectral_radius, share = 0.5 * (1.0 - r) / (1.0 + r);
    mean->force += share * (b->force - a->force);
    mean->by_place += share * b->slope;
}

/* 1: never open, or a lasting contact. */
static int lasts(const dmb_sim *sim, uint32_t u)
{
    return dmb_bounce_holds(sim->scene, u) || fabs(sim->bounce_age[u]) >= DMB_BOUNCE_STEPS;
}

/* 1: the step has the force of the law at its end. A law that is followed but touches in the step has a mean force in
 * it already, since the force at the end alone would be that of a contact which lasted the whole step. */
static int follows_law(const dmb_sim *sim, uint32_t u, const dmb_unilateral_end *a, const dmb_unilateral_end *b)
{
    if (sim->bounce_mode[u] != DMB_BOUNCE_LAW) return 0;
    return !dmb_bounce_can_open(sim->scene, u) || !dmb_unilateral_touches(a, b);
}

/* The trapezoidal rule of the ledger uses half of the power at each end of the step: at its start that of the law, or 0
 * if the force of the step before was a mean force. An evaluation outside of a step (own_factor 0) follows the law.
 * own_factor turns the mean force G into the force G/g' at the end that has its impulse (eq:unilateral.mean). */
int dmb_bounce_at(dmb_evaluation *evaluation, uint32_t u, const dmb_bounce *law, dmb_bounce_force *own)
{
    dmb_sim *sim = evaluation->sim;
    dmb_unilateral_end a, b;
    dmb_unilateral_mean mean;
    note(sim, u, law);
    if (!(evaluation->own_factor > 0.0)) return 0;
    dmb_bounce_ends(sim, u, &a, &b);
    if (follows_law(sim, u, &a, &b)) return 0;
    dmb_unilateral_mean_of(&a, &b, dmb_bounce_damping(sim->scene, u), evaluation->step, &mean);
    if (sim->bounce_turns[u] && lasts(sim, u)) add_numerical_damping(sim, &a, &b, &mean);
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
    const uint32_t spring = dmb_bounce_of_law(sim->scene, u);
    sim->trial.bounce_place[u] = fmax(law->stop_low, fmin(law->stop_high, 0.0));
    sim->trial.bounce_place[spring] = law->rest;
    sim->trial.bounce_force[u] = sim->trial.bounce_speed[u] = 0.0;
    sim->trial.bounce_force[spring] = sim->trial.bounce_speed[spring] = 0.0;
}
