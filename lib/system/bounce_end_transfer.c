/* Bounces under way when the state goes to another sim. Between two steps with a mean force the accelerations contain
 * none of it, nor the force of the law (system/bounce_end); in the steps after touch they contain the weighted damping
 * (eq:touch.weights). A restart has made them with all laws. */
#include "system/system.h"

#include <string.h>

#include "sim/layout.h"
#include "system/assemble/assemble.h"
#include "system/assemble/bounces.h"
#include "system/solve/solve.h"

/* 1: the contact is in the middle of a bounce: closed, with a mean force in the next step or weights of touch that are
 * still short of time (DMB_TOUCH_EXCESS, eq:touch.time). */
static int site_goes_on(const dmb_sim *sim, uint32_t s)
{
    if (!(sim->now.site_penetration[s] > 0.0)) return 0;
    if ((sim->site_age[s] & DMB_SITE_OWN) != 0) return 1;
    return dmb_scene_has_touch(sim->scene) && sim->now.site_touch[DMB_TOUCH_SIZE * (size_t)s + DMB_TOUCH_EXCESS] != 0.0;
}

static int any_goes_on(const dmb_sim *sim)
{
    for (uint32_t s = 0; s < sim->scene->site_count; s++)
        if (site_goes_on(sim, s)) return 1;
    for (uint32_t u = 0; u < sim->scene->unilateral_count; u++)
        if (sim->bounce_age[u] < 0.0) return 1;
    return 0;
}

/* 1: some contact has touched in the last step. Such a contact may have had a mean force in that step. */
static int any_touched(const dmb_sim *sim)
{
    for (uint32_t s = 0; s < sim->scene->site_count; s++)
        if (sim->site_age[s] == 1) return 1;
    for (uint32_t u = 0; u < sim->scene->unilateral_count; u++)
        if (sim->bounce_age[u] == 1.0) return 1;
    return 0;
}

/* A law closed in the new sim only has lasted. */
static void take_age(dmb_sim *sim, uint32_t u, const dmb_sim *from, uint32_t old)
{
    if (sim->bounce_age[u] != 0.0 && from->bounce_age[old] != 0.0) sim->bounce_age[u] = from->bounce_age[old];
}

/* Ages of stops and springs by joint, and of springs between points: laws are numbered differently if a joint has them
 * in one of the scenes only, and a scene where nothing may have a mean force has none. */
static void take_ages(dmb_sim *sim, const dmb_sim *from)
{
    const dmb_scene *scene = sim->scene, *was = from->scene;
    if (scene->unilateral_count == 0 || was->unilateral_count == 0) return;
    for (uint32_t j = 0; j < scene->joint_count; j++) {
        const uint32_t law = scene->joints[j].law, old = was->joints[j].law;
        for (uint32_t k = 0; k < 6 && law != DMB_NONE && old != DMB_NONE; k++) {
            take_age(sim, law + k, from, old + k);
            take_age(sim, dmb_bounce_of_law(scene, law + k), from, dmb_bounce_of_law(was, old + k));
        }
    }
    for (uint32_t i = 0; i < scene->spring_count; i++)
        take_age(sim, dmb_bounce_of_spring(scene, i), from, dmb_bounce_of_spring(was, i));
}

/* Removes the powers of a force: dissipated, and of all of it. */
static void remove_power(dmb_sim *sim, int kind, double heat, double all)
{
    sim->clock->power[kind] -= heat;
    sim->clock->power[DMB_POWER_POTENTIAL] -= all - heat;
    sim->clock->power[DMB_POWER_INERTIA] += all;
}

/* Force of a contact point into the residual, and out of the powers; factor -1: the opposite. */
static void press(dmb_sim *sim, uint32_t s, double factor, const dmb_site_force *f)
{
    const double heat = dmb_site_heat(sim, &sim->now, s, f), friction = dmb_site_rubbed(f);
    dmb_site_add_force(sim->scene, &sim->now, s, -factor, f, sim->residual);
    if (!sim->options.energy_ledger) return;
    remove_power(sim, DMB_POWER_IMPACT, factor * heat, -factor * f->normal_force * f->rate);
    remove_power(sim, DMB_POWER_FRICTION, factor * friction, factor * friction);
}

/* Removes the force of the law; the force with the weights of touch takes its place. */
static void press_site(dmb_sim *sim, uint32_t s)
{
    dmb_site_force f;
    dmb_site_force_of(sim->scene, &sim->now, s, &f);
    press(sim, s, 1.0, &f);
    if ((sim->site_age[s] & DMB_SITE_OWN) != 0) return;
    dmb_site_weighted_force(sim, &sim->now, s, &f);
    press(sim, s, -1.0, &f);
}

static void press_law(dmb_evaluation *evaluation, uint32_t u)
{
    dmb_sim *sim = evaluation->sim;
    const double force = sim->now.bounce_force[u];
    dmb_bounce_press(evaluation, &sim->now, u, force);
    if (sim->options.energy_ledger)
        remove_power(sim, dmb_bounce_power(sim, u), dmb_bounce_heat(sim, &sim->now, u),
                     -force * sim->now.bounce_speed[u]);
}

static void press_all(dmb_evaluation *evaluation)
{
    dmb_sim *sim = evaluation->sim;
    memset(sim->residual, 0, sim->scene->row_count * sizeof(double));
    for (uint32_t s = 0; s < sim->scene->site_count; s++)
        if (site_goes_on(sim, s)) press_site(sim, s);
    for (uint32_t u = 0; u < sim->scene->unilateral_count; u++)
        if (sim->bounce_age[u] < 0.0) press_law(evaluation, u);
}

/* v' of the restart contains the forces of all laws: M^-1 of those that the next step applies as mean forces, and of
 * the damping that touch still withholds, is subtracted from v' and a alike. Reactions stay those of the last step. */
int32_t dmb_bounces_go_on(dmb_sim *sim, const dmb_sim *from, int32_t *found)
{
    dmb_evaluation mass;
    take_ages(sim, from);
    const int goes_on = any_goes_on(sim);
    *found = goes_on || any_touched(sim);
    if (!goes_on) return DMB_OK;
    memset(&mass, 0, sizeof mass);
    mass.sim = sim;
    mass.time = sim->clock->time;
    mass.load_factor = mass.mass_factor = mass.pseudo_factor = 1.0;
    mass.dynamic = mass.tangent = 1;
    dmb_configuration_copy(sim, &sim->now, &sim->trial);
    const int32_t status = dmb_factor_mass(&mass);
    if (status < 0) return status;
    press_all(&mass);
    dmb_solve_for(sim, sim->residual, sim->correction);
    for (uint32_t i = 0; i < sim->scene->row_count; i++) {
        sim->now.acceleration[i] -= sim->correction[i];
        sim->now.pseudo_acceleration[i] -= sim->correction[i];
    }
    return DMB_OK;
}
