/* Accelerations at the end of a step in which contacts, stops or springs had mean forces (eq:unilateral.mean,
 * eq:unilateral.resolved, eq:contact.mean). The mean force belongs to the step, not to its end, so the accelerations
 * are corrected before the next step starts from them: v1' += M^-1 J^T (own - law),   own: force of the step's own
 * integration,   law: force of the law at the end
 *
 *     state of the contact at the end of the step             treatment in the next step
 *     -----------------------------------------------------   ------------------------------------------------------
 *     open                                                    by its law, force 0
 *     touched in this step, (k h + c) h J M^-1 J^T <= 1/4     by its law (the step resolves the contact)
 *     touched in this step, stiffer                           by its mean force (law = 0 above)
 *     closed, younger than 10 steps                           as in the step before
 *     closed for 10 steps (contact points: damper settled)    by its law (lasting contact) */
#include "system/system.h"

#include <math.h>
#include <string.h>

#include "math/vec3.h"
#include "system/assemble/assemble.h"
#include "system/assemble/bounces.h"
#include "system/assemble/ledger.h"
#include "system/solve/solve.h"

/* [-] Largest (k h^2 + c h)/m of a contact that steps resolve (eq:unilateral.resolved). */
#define DMB_BOUNCE_RESOLVED 0.25

/* Accelerations [m/s2, rad/s2], shape (row): M^-1 times the removed forces of the step's own integration, and M^-1
 * times the added forces of the laws that act from here on. Without stops and springs, in work arrays that are unused
 * after a trial step. */
static double *taken_of(const dmb_sim *sim)
{
    return sim->scene->unilateral_count > 0 ? sim->bounce_taken : sim->scale_row;
}
static double *given_of(const dmb_sim *sim)
{
    return sim->scene->unilateral_count > 0 ? sim->bounce_given : sim->correction;
}

/* Residual -force J^T of law u alone. */
static void press_alone(dmb_evaluation *evaluation, uint32_t u, double force)
{
    dmb_sim *sim = evaluation->sim;
    memset(sim->residual, 0, sim->scene->row_count * sizeof(double));
    dmb_bounce_press(evaluation, &sim->trial, u, force);
}

/* Rate [m/s, rad/s] of the coordinate of law u by a velocity; with an acceleration, its second rate. */
static double rate_by(dmb_evaluation *evaluation, uint32_t u, const double *velocity)
{
    const dmb_sim *sim = evaluation->sim;
    double sum = 0.0;
    press_alone(evaluation, u, -1.0);
    for (uint32_t i = 0; i < sim->scene->row_count; i++) sum -= sim->residual[i] * velocity[i];
    return sum;
}

/* sim->correction = M^-1 J^T with the present factors; returns the mobility J M^-1 J^T [1/kg, 1/(kg m2)]. */
static double mobility(dmb_evaluation *evaluation, uint32_t u)
{
    dmb_sim *sim = evaluation->sim;
    press_alone(evaluation, u, -1.0);
    dmb_solve_for(sim, sim->residual, sim->correction);
    return rate_by(evaluation, u, sim->correction);
}

/* 1: the law keeps its mean force in the next step (table at the head of this file). */
static uint8_t stays(const dmb_evaluation *evaluation, uint32_t u, double inverse_mass, const dmb_unilateral_end *a,
                     const dmb_unilateral_end *b)
{
    const dmb_sim *sim = evaluation->sim;
    const double h = evaluation->step, age = fabs(sim->bounce_age[u]);
    if (sim->bounce_turns[u]) return b->closed && dmb_bounce_is_unresolved(sim, u, h);
    if (!dmb_bounce_can_open(sim->scene, u)) return 0;
    if (!b->closed || (!dmb_unilateral_touches(a, b) && age + 1.0 >= DMB_BOUNCE_STEPS)) return 0;
    if (!dmb_unilateral_touches(a, b)) return sim->bounce_age[u] < 0.0;
    return (b->slope * h + dmb_bounce_damping(sim->scene, u)) * h * inverse_mass > DMB_BOUNCE_RESOLVED;
}

/* [-] Of h G: position minus mean velocity of a step with the mean force G (eq:unilateral.bias). */
static double drift(const dmb_evaluation *evaluation)
{
    const double gamma = 1.0 / (evaluation->own_factor * evaluation->pseudo_factor);
    return 0.25 * (gamma + 0.5) * (gamma + 0.5) / gamma - 0.5;
}

/* [N s, N m s] Impulse that the velocity lacks behind a mean force. */
static double lacking(const dmb_evaluation *evaluation, uint32_t u)
{
    return -evaluation->step * drift(evaluation) * evaluation->sim->bounce_own[u] / evaluation->own_factor;
}

/* 1: a law of a spring that turns has had a mean force in the step before, too. */
static int turns_on(const dmb_sim *sim, uint32_t u)
{
    return sim->bounce_turns[u] && sim->bounce_mode[u] == DMB_BOUNCE_OWN;
}

/* Biases by the mean forces of all laws: they move each other's nodes, also by joints and by the inertia of elements.
 */
static void find_biases(dmb_evaluation *evaluation)
{
    dmb_sim *sim = evaluation->sim;
    int any = 0;
    for (uint32_t u = 0; u < sim->scene->unilateral_count; u++) any |= turns_on(sim, u);
    if (!any) return;
    memset(sim->residual, 0, sim->scene->row_count * sizeof(double));
    for (uint32_t u = 0; u < sim->scene->unilateral_count; u++)
        if (sim->bounce_own[u] != 0.0) dmb_bounce_press(evaluation, &sim->trial, u, -lacking(evaluation, u));
    dmb_solve_for(sim, sim->residual, sim->bounce_kick);
    for (uint32_t u = 0; u < sim->scene->unilateral_count; u++)
        if (turns_on(sim, u)) sim->bounce_bias[u] = rate_by(evaluation, u, sim->bounce_kick);
}

/* 1: a law that turns is followed from here on, behind steps with a mean force: the velocity gets its part. Not behind
 * one that has opened: its mean force was in balance with nothing. */
static int takes_over(const dmb_sim *sim, uint32_t u)
{
    return turns_on(sim, u) && !sim->bounce_stays[u] && sim->trial.bounce_force[u] != 0.0;
}

/* Adds the force of law u if it acts from here on. */
static void exchange(dmb_evaluation *evaluation, uint32_t u, const dmb_unilateral_end *a, const dmb_unilateral_end *b)
{
    dmb_sim *sim = evaluation->sim;
    const double inverse_mass = mobility(evaluation, u);
    sim->bounce_stays[u] = stays(evaluation, u, inverse_mass, a, b);
    const double law = sim->bounce_stays[u] ? 0.0 : sim->trial.bounce_force[u];
    for (uint32_t i = 0; i < sim->scene->row_count; i++) given_of(sim)[i] -= law * sim->correction[i];
    if (!takes_over(sim, u)) return;
    const double impulse = lacking(evaluation, u);
    for (uint32_t i = 0; i < sim->scene->row_count; i++) sim->bounce_kick[i] += impulse * sim->correction[i];
}

/* Factors of the mass matrix at the trial (mass factor 1, velocity factor 0), with which the exchanged forces become
 * accelerations. */
static int32_t factor_mass(const dmb_evaluation *evaluation, dmb_evaluation *mass)
{
    *mass = *evaluation;
    mass->mass_factor = 1.0;
    mass->velocity_factor = 0.0;
    mass->tangent = 1;
    mass->given = 0;
    return dmb_factor_mass_in_step(mass);
}

/* ---- Contact sites ----------------------------------------------------------------------------------------------- */

static int site_stays(const dmb_sim *sim, uint32_t s)
{
    return (sim->site_mode[s] & DMB_SITE_STAYS) != 0;
}

/* Force of a contact point at the end of a step by its law, and the equivalent of its mean force there; mean force [N],
 * and energy [J] dissipated in the wall. */
typedef struct site_step {
    dmb_site_force law, own;
    double mean, taken;
} site_step;

/* own is the force at the end of the step by which the step has its mean force: own_factor G = G/g', with friction of
 * the law under it (eq:contact.mean). With a mean force G* in the history the end has G* + (G - G*)/g'
 * (eq:contact.gain); `carried` is -G*. */
static void site_step_of(const dmb_evaluation *evaluation, uint32_t s, site_step *to)
{
    const dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    const double length = scene->sites[s].length, carried = fmin(sim->site_history[s], 0.0);
    dmb_normal_mean mean;
    dmb_site_force_of(scene, &sim->trial, s, &to->law);
    dmb_site_mean_of(sim, s, evaluation->step, &mean);
    to->own = to->law;
    to->own.normal_force = evaluation->own_factor * length * mean.force;
    to->own.along += to->own.rho * (to->own.normal_force - to->law.normal_force);
    dmb_site_rub(scene, &sim->trial, s, &to->own);
    to->own.normal_force += (evaluation->own_factor - 1.0) * carried;
    to->mean = length * mean.force;
    to->taken = length * mean.taken;
}

/* [kg] (k h + c) h of a contact point that touches, with k and c of the law at the penetration reached in a step. */
static double resistance(const dmb_sim *sim, uint32_t s, double h)
{
    const dmb_scene *scene = sim->scene;
    const dmb_normal_law law = dmb_normal_law_at(&scene->hole, &scene->normal_law, sim->trial.site_depth[s]);
    const double speed = sim->trial.site_impact_speed[s];
    double force, by_depth, by_rate;
    const double depth = fmax(sim->trial.site_penetration[s], h * fabs(speed));
    dmb_normal_force(&law, depth, 0.0, speed, &force, &by_depth, &by_rate);
    return scene->sites[s].length * (by_depth * h + by_rate) * h;
}

/* Unit normal force of a contact point. */
static dmb_site_force unit_force(const dmb_sim *sim, uint32_t s)
{
    dmb_site_force f;
    memset(&f, 0, sizeof f);
    dmb_vec3_copy(sim->trial.site_normal + 3 * (size_t)s, f.normal);
    f.normal_force = 1.0;
    return f;
}

/* y . J^T e of a unit normal force e at the contact point; room (row) is 0 before and after. */
static double along_site(const dmb_sim *sim, uint32_t s, const double *y, double *room)
{
    const dmb_scene *scene = sim->scene;
    const uint32_t node = scene->sites[s].node, last = node + (dmb_is_inside(scene, s) ? 2 : 1);
    const dmb_site_force f = unit_force(sim, s);
    double sum = 0.0;
    dmb_site_add_force(scene, &sim->trial, s, 1.0, &f, room);
    for (uint32_t i = scene->layout.row[node]; i < scene->layout.row[last]; i++) {
        sum += room[i] * y[i];
        room[i] = 0.0;
    }
    return sum;
}

/* [-] Largest force of the damper over the mean force in a contact that counts as settled. */
#define DMB_BOUNCE_SETTLED 0.1

/* 1: the contact is old enough and its damper has settled. Otherwise the damper force at the end of the step would
 * throw the body off when the law takes over. */
static int is_lasting(const dmb_evaluation *evaluation, uint32_t s)
{
    const dmb_sim *sim = evaluation->sim;
    site_step of;
    if ((sim->site_age[s] & (DMB_SITE_OWN - 1)) + 1 < (int)DMB_BOUNCE_STEPS) return 0;
    site_step_of(evaluation, s, &of);
    const double damper = of.law.normal_force - dmb_site_elastic_force(sim->scene, &sim->trial, s, &of.law);
    return fabs(damper) <= DMB_BOUNCE_SETTLED * of.mean;
}

static int touches_coarsely(const dmb_sim *sim, uint32_t s)
{
    return dmb_site_has_mean(sim, s) && dmb_site_touches(sim, s);
}

static void mark_stay(dmb_sim *sim, uint32_t s, int stays)
{
    sim->site_mode[s] =
        (uint8_t)((sim->site_mode[s] & (DMB_SITE_MODE | DMB_SITE_CARRIED)) | (stays ? DMB_SITE_STAYS : 0));
}

/* Chooses the treatment of contact points in the next step. All touching points act together: J M^-1 sum of J^T (k h +
 * c) h replaces the value of each alone. */
static void choose_sites(const dmb_evaluation *evaluation)
{
    dmb_sim *sim = evaluation->sim;
    double *y = taken_of(sim), *room = given_of(sim);
    int touched = 0;
    for (uint32_t s = 0; s < sim->scene->site_count; s++) {
        const int own = sim->trial.site_penetration[s] > 0.0 && (sim->site_age[s] & DMB_SITE_OWN) != 0;
        mark_stay(sim, s, own && !is_lasting(evaluation, s));
        if (!touches_coarsely(sim, s)) continue;
        const dmb_site_force f = unit_force(sim, s);
        dmb_site_add_force(sim->scene, &sim->trial, s, -resistance(sim, s, evaluation->step), &f, y);
        touched = 1;
    }
    if (!touched) return;
    dmb_solve_for(sim, y, y);
    for (uint32_t s = 0; s < sim->scene->site_count; s++)
        if (touches_coarsely(sim, s)) mark_stay(sim, s, along_site(sim, s, y, room) > DMB_BOUNCE_RESOLVED);
    memset(y, 0, sim->scene->row_count * sizeof(double));
}

/* Exchanges the forces of contact points as `exchange` does for stops and springs. */
static void exchange_sites(const dmb_evaluation *evaluation)
{
    dmb_sim *sim = evaluation->sim;
    choose_sites(evaluation);
    for (uint32_t s = 0; s < sim->scene->site_count; s++) {
        site_step of;
        if (!dmb_site_has_mean(sim, s)) continue;
        site_step_of(evaluation, s, &of);
        dmb_site_add_force(sim->scene, &sim->trial, s, 1.0, &of.own, taken_of(sim));
        if (!site_stays(sim, s)) dmb_site_add_force(sim->scene, &sim->trial, s, -1.0, &of.law, given_of(sim));
    }
    dmb_solve_for(sim, taken_of(sim), taken_of(sim));
    dmb_solve_for(sim, given_of(sim), given_of(sim));
}

/* ---- All --------------------------------------------------------------------------------------------------------- */

static int law_bounces(const dmb_sim *sim, uint32_t u)
{
    dmb_unilateral_end a, b;
    if (sim->bounce_mode[u] != DMB_BOUNCE_LAW) return 1;
    if (!dmb_bounce_can_open(sim->scene, u)) return 0;
    dmb_bounce_ends(sim, u, &a, &b);
    return dmb_unilateral_touches(&a, &b);
}

static int laws_bounce(const dmb_sim *sim)
{
    for (uint32_t u = 0; u < sim->scene->unilateral_count; u++)
        if (law_bounces(sim, u)) return 1;
    return *sim->laws_bounce;
}

/* Removes the step's own forces; the residual serves as workspace. */
static void take_own(dmb_evaluation *evaluation)
{
    dmb_sim *sim = evaluation->sim;
    memset(sim->residual, 0, sim->scene->row_count * sizeof(double));
    for (uint32_t u = 0; u < sim->scene->unilateral_count; u++)
        if (sim->bounce_own[u] != 0.0) dmb_bounce_press_mean(evaluation, u, -sim->bounce_own[u]);
    evaluation->tangent = 0;
    dmb_bounces_add_gyroscopic(evaluation, -1.0);
    dmb_solve_for(sim, sim->residual, sim->correction);
    for (uint32_t i = 0; i < sim->scene->row_count; i++) taken_of(sim)[i] += sim->correction[i];
}

/* Exchanges the forces of stops and springs; the residual serves as workspace and is restored. */
static void exchange_laws(dmb_evaluation *evaluation)
{
    dmb_sim *sim = evaluation->sim;
    const uint32_t n = sim->scene->row_count;
    memcpy(sim->bounce_rows, sim->residual, n * sizeof(double));
    find_biases(evaluation);
    memset(sim->bounce_kick, 0, n * sizeof(double));
    for (uint32_t u = 0; u < sim->scene->unilateral_count; u++) {
        dmb_unilateral_end a, b;
        sim->bounce_stays[u] = 0;
        if (!law_bounces(sim, u)) continue;
        dmb_bounce_ends(sim, u, &a, &b);
        exchange(evaluation, u, &a, &b);
    }
    take_own(evaluation);
    memcpy(sim->residual, sim->bounce_rows, n * sizeof(double));
}

int32_t dmb_bounces_end(const dmb_evaluation *evaluation, int32_t *found)
{
    dmb_sim *sim = evaluation->sim;
    const int sites = dmb_sites_have_mean(sim), laws = laws_bounce(sim);
    const uint32_t n = sim->scene->row_count;
    dmb_evaluation mass;
    *found = sites || laws;
    if (!*found) return DMB_OK;
    const int32_t status = factor_mass(evaluation, &mass);
    if (status < 0) return status;
    memset(taken_of(sim), 0, n * sizeof(double));
    memset(given_of(sim), 0, n * sizeof(double));
    if (sites) exchange_sites(&mass);
    if (laws) exchange_laws(&mass);
    return DMB_OK;
}

void dmb_bounces_add_accelerations(const dmb_sim *sim, double *acceleration)
{
    for (uint32_t i = 0; i < sim->scene->row_count; i++) acceleration[i] += taken_of(sim)[i] + given_of(sim)[i];
}

/* By eq:integration.recursion the removed forces of the step entered a with pseudo_factor of what they added to v'. The
 * added forces of the law are in both alike, as at a restart with a = v'. */
static void take_accelerations(dmb_sim *sim, double pseudo_factor)
{
    dmb_bounces_add_accelerations(sim, sim->trial.acceleration);
    for (uint32_t u = 0; u < sim->scene->unilateral_count; u++)
        if (takes_over(sim, u)) sim->trial.bounce_speed[u] += sim->bounce_bias[u];
    if (laws_bounce(sim))
        for (uint32_t i = 0; i < sim->scene->row_count; i++) sim->trial.velocity[i] += sim->bounce_kick[i];
    for (uint32_t i = 0; i < sim->scene->row_count; i++) {
        sim->trial.pseudo_acceleration[i] += pseudo_factor * taken_of(sim)[i] + given_of(sim)[i];
    }
}

/* Energy of a damper c in a step by its law: c h ((s0 + s1)/2)^2, whereas the trapezoidal rule of the ledger gives c h
 * (s0^2 + s1^2)/2. At touch, where the power jumps, the difference would stay in the balance, so it is moved. */
static void take_mean_speed(const dmb_evaluation *evaluation, uint32_t u)
{
    dmb_sim *sim = evaluation->sim;
    const double change = sim->trial.bounce_speed[u] - sim->now.bounce_speed[u];
    const double c = dmb_bounce_damping(sim->scene, u);
    if (sim->now.bounce_force[u] == 0.0 || sim->trial.bounce_force[u] == 0.0) return;
    dmb_ledger_move(sim, dmb_bounce_power(sim, u), -0.25 * c * evaluation->step * change * change);
}

/* Replaces the powers of the step's own force by those of the law that acts from here on; the energy dissipated in the
 * step is already in the ledger. */
static void exchange_power(dmb_sim *sim, uint32_t u)
{
    const double law = sim->bounce_stays[u] ? 0.0 : sim->trial.bounce_force[u];
    const double heat = (sim->bounce_stays[u] ? 0.0 : dmb_bounce_heat(sim, &sim->trial, u)) - sim->bounce_warmth[u];
    const double all = (sim->bounce_own[u] - law) * sim->trial.bounce_speed[u];
    sim->clock->power[dmb_bounce_power(sim, u)] += heat;
    sim->clock->power[DMB_POWER_POTENTIAL] += all - heat;
    sim->clock->power[DMB_POWER_INERTIA] -= all;
}

/* Age after a step; counts a bounce if a contact opens after a few steps. */
static double aged(dmb_sim *sim, double age, int touches, int closed)
{
    const int ends = touches || !closed;
    if (ends && age > 0.0 && age < DMB_BOUNCE_STEPS) sim->counters->bounces++;
    if (!closed) return 0.0;
    return touches ? 1.0 : fmin(age + 1.0, DMB_BOUNCE_STEPS);
}

/* The dissipation of an opening law at the start of the step is contained in that of its mean force: removes it from
 * the trapezoidal rule. */
static void forget_heat(const dmb_evaluation *evaluation, uint32_t s)
{
    dmb_sim *sim = evaluation->sim;
    dmb_site_force f;
    dmb_site_force_of(sim->scene, &sim->now, s, &f);
    dmb_ledger_move(sim, DMB_POWER_IMPACT, 0.5 * evaluation->step * dmb_site_heat(sim, &sim->now, s, &f));
}

/* Adds the powers of the law if it acts from here on, less those of the step's own force as counted by the kernel. */
static void exchange_site_power(const dmb_evaluation *evaluation, uint32_t s)
{
    dmb_sim *sim = evaluation->sim;
    site_step of;
    site_step_of(evaluation, s, &of);
    double impact = 2.0 * of.taken / evaluation->step,
           friction = -(2.0 / evaluation->own_factor) * dmb_site_rubbed(&of.own);
    double all = of.own.normal_force * of.law.rate - dmb_site_rubbed(&of.own);
    if (!site_stays(sim, s)) {
        impact += dmb_site_heat(sim, &sim->trial, s, &of.law);
        friction += dmb_site_rubbed(&of.law);
        all += dmb_site_rubbed(&of.law) - of.law.normal_force * of.law.rate;
    }
    sim->clock->power[DMB_POWER_IMPACT] += impact;
    sim->clock->power[DMB_POWER_FRICTION] += friction;
    sim->clock->power[DMB_POWER_POTENTIAL] += all - impact - friction;
    sim->clock->power[DMB_POWER_INERTIA] -= all;
    if ((sim->site_mode[s] & DMB_SITE_MODE) == DMB_BOUNCE_OPENS) forget_heat(evaluation, s);
}

/* Sets a = v'. The memory a - v' = O(h) of generalized-alpha would oscillate after the jump, more so in steps of
 * another length; without it positions have one additional error of O(h^3). */
static void forget_memory(dmb_sim *sim)
{
    memcpy(sim->trial.pseudo_acceleration, sim->trial.acceleration, sim->scene->row_count * sizeof(double));
}

static void accept_sites(const dmb_evaluation *evaluation, int32_t found)
{
    dmb_sim *sim = evaluation->sim;
    if (found && dmb_sites_have_mean(sim)) forget_memory(sim);
    for (uint32_t s = 0; s < sim->scene->site_count; s++) {
        const int closed = sim->trial.site_penetration[s] > 0.0, mean = found && dmb_site_has_mean(sim, s);
        if (!closed && sim->site_age[s] == 0 && !mean) continue;
        if (mean) exchange_site_power(evaluation, s);
        const double was = (double)(sim->site_age[s] & (DMB_SITE_OWN - 1));
        const int age = (int)aged(sim, was, closed && (was == 0.0 || dmb_site_touches(sim, s)), closed);
        sim->site_age[s] = (uint8_t)(mean && site_stays(sim, s) ? age | DMB_SITE_OWN : age);
    }
}

/* A negative age marks a law whose mean force continues in the next step (dmb_bounces_begin). */
static void accept_laws(const dmb_evaluation *evaluation, int32_t found)
{
    dmb_sim *sim = evaluation->sim;
    for (uint32_t u = 0; u < sim->scene->unilateral_count; u++) {
        dmb_unilateral_end a, b;
        if (!dmb_bounce_acts(sim->scene, u)) continue;
        dmb_bounce_ends(sim, u, &a, &b);
        if (law_bounces(sim, u))
            exchange_power(sim, u);
        else
            take_mean_speed(evaluation, u);
        const double age = aged(sim, fabs(sim->bounce_age[u]), dmb_unilateral_touches(&a, &b), b.closed);
        sim->bounce_age[u] = found && sim->bounce_stays[u] ? -age : age;
    }
}

/* Accelerations first: powers and ages are those of the state from which the next step starts. */
void dmb_bounces_accept(const dmb_evaluation *evaluation, int32_t found)
{
    if (found) take_accelerations(evaluation->sim, evaluation->pseudo_factor);
    accept_sites(evaluation, found);
    accept_laws(evaluation, found);
}
