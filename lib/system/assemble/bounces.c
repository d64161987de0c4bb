/* Contact points, stops of joints and one-sided springs in the steps in which they touch or open (eq:unilateral.mean,
 * eq:contact.mean). */
#include "system/assemble/bounces.h"

#include <math.h>
#include <string.h>

#include "math/vec3.h"
#include "system/assemble/assemble.h"

/* ---- Contact sites ----------------------------------------------------------------------------------------------- */

static int turns_over(const dmb_sim *sim, uint32_t s)
{
    return dmb_vec3_dot(sim->now.site_normal + 3 * (size_t)s, sim->trial.site_normal + 3 * (size_t)s) < 0.0;
}

int dmb_site_touches(const dmb_sim *sim, uint32_t s)
{
    if (!(sim->trial.site_penetration[s] > 0.0) || !(sim->scene->sites[s].clearance > 0.0)) return 0;
    return !(sim->now.site_penetration[s] > 0.0) || turns_over(sim, s);
}

int dmb_site_has_mean(const dmb_sim *sim, uint32_t s)
{
    const int marked = (sim->site_mode[s] & (DMB_SITE_MODE | DMB_SITE_CARRIED)) != DMB_BOUNCE_LAW;
    return marked || (sim->site_coarse[s] && dmb_site_touches(sim, s));
}

int dmb_sites_have_mean(const dmb_sim *sim)
{
    for (uint32_t s = 0; *sim->sites_bounce && s < sim->scene->site_count; s++)
        if (dmb_site_has_mean(sim, s)) return 1;
    return 0;
}

/* [-] Largest (k h + c) h/m of a contact point whose touch and release a step resolves; m: mass of the adjacent
 * elements; k and c of the law at the penetration of half a step. It is half the limit of a single body: following the
 * law to the end of the step of touch dissipates energy only while the body still moves inwards there
 * (eq:contact.turned), which for a restitution law depends on its force at rest, whatever its damping. */
#define DMB_SITE_RESOLVED 2.0
/* [-] Largest value with a mean force: beyond, Newton's iteration does not converge for a body thrown off by the wall.
 */
#define DMB_SITE_FAR 1e6

/* [kg/m] Left side of eq:contact.coarse per metre of wall and without 1/m: (k h + c) h with k = K (v h/2)^(n-1), for a
 * normal speed v [m/s] at touch. */
static double coarseness(const dmb_normal_law *law, double speed, double h)
{
    const int by_rate = law->kind == DMB_NORMAL_KELVIN_VOIGT || law->kind == DMB_NORMAL_IMPACT;
    const double k = law->stiffness * dmb_normal_reduced_power(law->exponent, 0.5 * h * speed);
    return k * h * h + (by_rate ? law->damping * h : 0.0);
}

/* Marks the contact points whose touch and release the step does not resolve, by the speed of the present or next
 * contact. 1: there are any. */
static int mark_coarse(dmb_sim *sim, double h)
{
    const dmb_scene *scene = sim->scene;
    int found = 0;
    if (scene->hole.pieces == 0 && scene->normal_law.exponent == 1.0 &&
        coarseness(&scene->normal_law, 0.0, h) * scene->site_mobility <= DMB_SITE_RESOLVED) {
        memset(sim->site_coarse, 0, scene->site_count);
        return 0;
    }
    const double fallen = h * dmb_vec3_norm(scene->gravity);
    for (uint32_t s = 0; s < scene->site_count; s++) {
        const dmb_normal_law law = dmb_normal_law_at(&scene->hole, &scene->normal_law, sim->now.site_depth[s]);
        const double speed = fabs(sim->now.site_impact_speed[s]), most = coarseness(&law, speed, h);
        const double ratio = most * scene->sites[s].length * dmb_site_mobility(scene, s);
        const int coarse = ratio > DMB_SITE_RESOLVED && ratio < DMB_SITE_FAR;
        sim->site_coarse[s] = (uint8_t)(!coarse ? 0 : speed > fallen ? DMB_SITE_COARSE : DMB_SITE_PLASTIC);
        found |= coarse;
    }
    return found;
}

static void begin_sites(dmb_sim *sim, double h)
{
    const uint32_t sites = sim->scene->site_count;
    int bounces = sites > 0 && mark_coarse(sim, h);
    memset(sim->site_history, 0, sites * sizeof(double));
    for (uint32_t s = 0; s < sites; s++) {
        sim->site_mode[s] = (sim->site_age[s] & DMB_SITE_OWN) != 0 ? DMB_BOUNCE_OWN : DMB_BOUNCE_LAW;
        bounces |= sim->site_mode[s];
    }
    *sim->sites_bounce = bounces;
}

/* 1: the contact opens. With damping, its force reaches 0 before the penetration does. */
static int site_opens(const dmb_sim *sim, uint32_t s)
{
    dmb_site_force f;
    if (!sim->site_coarse[s] || dmb_site_has_mean(sim, s)) return 0;
    if (!(sim->now.site_penetration[s] > 0.0) || !(sim->scene->sites[s].clearance > 0.0)) return 0;
    if (sim->site_presses[s] && sim->trial.site_penetration[s] > 0.0 && !turns_over(sim, s)) return 0;
    dmb_site_force_of(sim->scene, &sim->now, s, &f);
    return f.normal_force > 0.0;
}

void dmb_site_mean_of(const dmb_sim *sim, uint32_t s, double step, dmb_normal_mean *mean)
{
    const dmb_scene *scene = sim->scene;
    const dmb_normal_law law = dmb_normal_law_at(&scene->hole, &scene->normal_law, sim->trial.site_depth[s]);
    const dmb_local_normal local = dmb_local_normal_of(&law);
    dmb_normal_mean_at(&local, sim->now.site_penetration[s], sim->trial.site_penetration[s],
                       sim->trial.site_impact_speed[s], sim->site_coarse[s] == DMB_SITE_PLASTIC, step, mean);
}

/* ---- Mean forces in the history of a step ------------------------------------------------------------------------
 *
 * A force G that the end of a step stands for changes the speed by h G/m and the place by b h^2 G/m, b = beta/gamma,
 * where a constant force, as weight is, changes it by h^2/2 of its acceleration. Over the step the energy changes by
 *     (1/2 - b) h sum of G dv
 * beyond the works of the forces, dv the change of the speed along G. That is a gain where the other forces win against
 * the wall in the step. G* = 2 b G of such a step, put into the history and into the end of it alike, acts as a
 * constant force, and leaves (1/2 - b) h sum of (G' - G*) dv of the step that is taken again: G' <= G* since the depth
 * that it comes to is between that of before and that of b = 1/2.
 */

/* Adds the energy [J] gained by the step at a contact point, and the energy exchanged with the wall. */
static void add_gain(const dmb_evaluation *evaluation, uint32_t s, double *gain, double *exchanged)
{
    const dmb_sim *sim = evaluation->sim;
    const double way = sim->trial.site_penetration[s] - sim->now.site_penetration[s];
    const double more = 1.0 / evaluation->velocity_factor - 0.5 * evaluation->step; /* (b - 1/2) h */
    dmb_site_force a, b;
    dmb_normal_mean mean;
    if (!dmb_site_has_mean(sim, s)) return;
    dmb_site_mean_of(sim, s, evaluation->step, &mean);
    dmb_site_force_of(sim->scene, &sim->now, s, &a);
    dmb_site_force_of(sim->scene, &sim->trial, s, &b);
    const double force = sim->scene->sites[s].length * mean.force;
    *gain += more * force * (b.rate - a.rate);
    *exchanged += force * fabs(way);
}

/* Above DMB_GAIN_CARRIED (integrator/trial_step) the step is repeated with the mean forces in its history. */
double dmb_bounces_gain(const dmb_evaluation *evaluation)
{
    const dmb_sim *sim = evaluation->sim;
    double gain = 0.0, exchanged = 0.0;
    for (uint32_t s = 0; *sim->sites_bounce && s < sim->scene->site_count; s++)
        add_gain(evaluation, s, &gain, &exchanged);
    return gain > 0.0 ? gain / exchanged : 0.0;
}

void dmb_bounces_carry(dmb_sim *sim)
{
    for (uint32_t s = 0; s < sim->scene->site_count; s++)
        if (dmb_site_has_mean(sim, s)) sim->site_mode[s] |= DMB_SITE_CARRIED;
}

void dmb_bounces_add_carried(const dmb_evaluation *evaluation, double *rows)
{
    dmb_sim *sim = evaluation->sim;
    for (uint32_t s = 0; *sim->sites_bounce && s < sim->scene->site_count; s++) {
        dmb_site_force f;
        dmb_normal_mean mean;
        if (!(sim->site_mode[s] & DMB_SITE_CARRIED) || (sim->site_mode[s] & DMB_SITE_MODE) == DMB_BOUNCE_OPENS)
            continue;
        const double b = 1.0 / (evaluation->step * evaluation->velocity_factor);
        dmb_site_mean_of(sim, s, evaluation->step, &mean);
        memset(&f, 0, sizeof f);
        dmb_vec3_copy(sim->trial.site_normal + 3 * (size_t)s, f.normal);
        f.normal_force = 2.0 * b * sim->scene->sites[s].length * mean.force;
        dmb_site_add_force(sim->scene, &sim->trial, s, 1.0, &f, rows);
        sim->site_history[s] = -f.normal_force;
    }
}

/* ---- Course of a step -------------------------------------------------------------------------------------------- */

/* 1: mean forces of a two-sided spring begin where it has no force, which then is not in the history. */
static int begins(const dmb_sim *sim, uint32_t u)
{
    return sim->bounce_turns[u] && dmb_bounce_holds(sim->scene, u) && sim->now.bounce_force[u] == 0.0;
}

void dmb_bounces_begin(dmb_sim *sim, double step)
{
    begin_sites(sim, step);
    *sim->laws_bounce = 0;
    dmb_bounces_mark_turning(sim, step, 0);
    for (uint32_t u = 0; u < sim->scene->unilateral_count; u++) {
        sim->bounce_mode[u] = sim->bounce_age[u] < 0.0 || begins(sim, u) ? DMB_BOUNCE_OWN : DMB_BOUNCE_LAW;
    }
}

/* 1: the law pressed at the start of the step and is open, or on its other side, at the end; or its mean forces begin
 * with this step. */
static int opens(const dmb_sim *sim, uint32_t u)
{
    dmb_unilateral_end a, b;
    if (sim->bounce_mode[u] != DMB_BOUNCE_LAW) return 0;
    if (sim->bounce_turns[u]) return sim->now.bounce_force[u] != 0.0 || dmb_bounce_holds(sim->scene, u);
    if (!dmb_bounce_can_open(sim->scene, u)) return 0;
    dmb_bounce_ends(sim, u, &a, &b);
    if (!a.closed || sim->now.bounce_force[u] == 0.0) return 0;
    return !b.closed || a.depth * b.depth < 0.0 || (b.depth != 0.0 && sim->trial.bounce_force[u] == 0.0);
}

int32_t dmb_bounces_open(dmb_sim *sim, double step)
{
    int32_t found = 0;
    dmb_bounces_mark_turning(sim, step, 1);
    for (uint32_t s = 0; *sim->sites_bounce && s < sim->scene->site_count; s++) {
        if (!site_opens(sim, s)) continue;
        sim->site_mode[s] = DMB_BOUNCE_OPENS;
        found = 1;
    }
    for (uint32_t u = 0; u < sim->scene->unilateral_count; u++) {
        if (!opens(sim, u)) continue;
        sim->bounce_mode[u] = begins(sim, u) ? DMB_BOUNCE_OWN : DMB_BOUNCE_OPENS;
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

/* ---- Starts and jumps -------------------------------------------------------------------------------------------- */

void dmb_bounces_start(dmb_sim *sim)
{
    for (uint32_t s = 0; s < sim->scene->site_count; s++)
        sim->site_age[s] = sim->now.site_penetration[s] > 0.0 ? (uint8_t)DMB_BOUNCE_STEPS : 0;
    for (uint32_t u = 0; u < sim->scene->unilateral_count; u++) {
        dmb_unilateral_end end;
        dmb_bounce_end_at(sim->scene, u, sim->now.bounce_place[u], &end);
        sim->bounce_age[u] = dmb_bounce_acts(sim->scene, u) && end.closed ? DMB_BOUNCE_STEPS : 0.0;
    }
}
