/* Accelerations behind a step in which stops or springs touch or open: without the mean forces that the step had
 * (eq:unilateral.mean, eq:unilateral.resolved). */
#include "system/system.h"

#include <math.h>
#include <string.h>

#include "system/assemble/bounces.h"
#include "system/assemble/ledger.h"
#include "system/solve/solve.h"

/* [-] (k h^2 + c h)/m of a contact up to which steps resolve it. */
#define DMB_BOUNCE_RESOLVED 0.25

/* sim->correction = M^-1 J^T, by the factors at hand; returns J M^-1 J^T [1/kg, 1/(kg m2)]. */
static double mobility(dmb_evaluation *evaluation, uint32_t u)
{
    dmb_sim *sim = evaluation->sim;
    double sum = 0.0;
    memset(sim->residual, 0, sim->scene->row_count * sizeof(double));
    dmb_bounce_press(evaluation, u, -1.0);
    dmb_solve_for(sim, sim->residual, sim->correction);
    for (uint32_t i = 0; i < sim->scene->row_count; i++) sum -= sim->residual[i] * sim->correction[i];
    return sum;
}

/* 1: the law is stiff for the step, and has not been closed for long. */
static uint8_t stays(const dmb_evaluation *evaluation, uint32_t u, double inverse_mass, const dmb_unilateral_end *a,
                     const dmb_unilateral_end *b)
{
    const dmb_sim *sim = evaluation->sim;
    const double h = evaluation->step, age = fabs(sim->bounce_age[u]);
    if (!b->closed || (!dmb_unilateral_touches(a, b) && age + 1.0 >= DMB_BOUNCE_STEPS)) return 0;
    if (!dmb_unilateral_touches(a, b)) return sim->bounce_age[u] < 0.0;
    return (b->slope * h + dmb_bounce_damping(sim->scene, u)) * h * inverse_mass > DMB_BOUNCE_RESOLVED;
}

/* The step's own force goes, that of the law comes where the law is followed from here on. */
static void exchange(dmb_evaluation *evaluation, uint32_t u, const dmb_unilateral_end *a, const dmb_unilateral_end *b)
{
    dmb_sim *sim = evaluation->sim;
    const double inverse_mass = mobility(evaluation, u);
    sim->bounce_stays[u] = stays(evaluation, u, inverse_mass, a, b);
    const double own = sim->bounce_own[u], law = sim->bounce_stays[u] ? 0.0 : sim->trial.bounce_force[u];
    for (uint32_t i = 0; i < sim->scene->row_count; i++) {
        sim->bounce_taken[i] += own * sim->correction[i];
        sim->bounce_given[i] -= law * sim->correction[i];
    }
}

static int32_t factor_mass(const dmb_evaluation *evaluation, dmb_evaluation *mass)
{
    *mass = *evaluation;
    mass->mass_factor = 1.0;
    mass->velocity_factor = 0.0;
    mass->tangent = 1;
    mass->given = 0;
    return dmb_factor_mass_in_step(mass);
}

int32_t dmb_bounces_end(const dmb_evaluation *evaluation, int32_t *found)
{
    dmb_sim *sim = evaluation->sim;
    const uint32_t n = sim->scene->row_count;
    dmb_evaluation mass;
    dmb_unilateral_end a, b;
    *found = 0;
    for (uint32_t u = 0; u < sim->scene->unilateral_count; u++) {
        sim->bounce_stays[u] = 0;
        if (!dmb_bounce_can_open(sim->scene, u)) continue;
        dmb_bounce_ends(sim, u, &a, &b);
        if (sim->bounce_mode[u] == DMB_BOUNCE_LAW && !dmb_unilateral_touches(&a, &b)) continue;
        if (!*found) {
            const int32_t status = factor_mass(evaluation, &mass);
            if (status < 0) return status;
            memset(sim->bounce_taken, 0, n * sizeof(double));
            memset(sim->bounce_given, 0, n * sizeof(double));
            memcpy(sim->bounce_rows, sim->residual, n * sizeof(double));
            *found = 1;
        }
        exchange(&mass, u, &a, &b);
    }
    if (*found) memcpy(sim->residual, sim->bounce_rows, n * sizeof(double));
    return DMB_OK;
}

static void take_accelerations(dmb_sim *sim, double pseudo_factor)
{
    for (uint32_t i = 0; i < sim->scene->row_count; i++) {
        sim->trial.acceleration[i] += sim->bounce_taken[i] + sim->bounce_given[i];
        sim->trial.pseudo_acceleration[i] += pseudo_factor * sim->bounce_taken[i] + sim->bounce_given[i];
    }
}

static int kind_of(const dmb_sim *sim, uint32_t u)
{
    return u < sim->scene->law_count ? DMB_POWER_IMPACT : DMB_POWER_DAMPING;
}

/* A damper c takes c h ((s0 + s1)/2)^2 in a step in which its law is followed, the trapezoidal rule c h (s0^2 +
 * s1^2)/2: from touch on, where its power jumps, the difference would not come back. */
static void take_mean_speed(const dmb_evaluation *evaluation, uint32_t u)
{
    dmb_sim *sim = evaluation->sim;
    const double change = sim->trial.bounce_speed[u] - sim->now.bounce_speed[u];
    const double c = dmb_bounce_damping(sim->scene, u);
    if (sim->now.bounce_force[u] == 0.0 || sim->trial.bounce_force[u] == 0.0) return;
    dmb_ledger_move(sim, kind_of(sim, u), -0.25 * c * evaluation->step * change * change);
}

/* From here on the powers are those of the laws that are followed: what the dampers took over the step is in the
 * ledger. */
static void exchange_power(dmb_sim *sim, uint32_t u)
{
    const double law = sim->bounce_stays[u] ? 0.0 : sim->trial.bounce_force[u];
    const double heat = (sim->bounce_stays[u] ? 0.0 : dmb_bounce_heat(sim, &sim->trial, u)) - sim->bounce_warmth[u];
    const double all = (sim->bounce_own[u] - law) * sim->trial.bounce_speed[u];
    sim->clock->power[kind_of(sim, u)] += heat;
    sim->clock->power[DMB_POWER_POTENTIAL] += all - heat;
    sim->clock->power[DMB_POWER_INERTIA] -= all;
}

/* Age after a step; a contact that opens having been closed for a few steps counts. */
static double aged(dmb_sim *sim, double age, int touches, int closed)
{
    const int ends = touches || !closed;
    if (ends && age > 0.0 && age < DMB_BOUNCE_STEPS) sim->counters->bounces++;
    if (!closed) return 0.0;
    return touches ? 1.0 : fmin(age + 1.0, DMB_BOUNCE_STEPS);
}

static void age_sites(dmb_sim *sim)
{
    for (uint32_t s = 0; s < sim->scene->site_count; s++) {
        const int closed = sim->trial.site_penetration[s] > 0.0, was = sim->site_age[s] > 0;
        if (closed || was) sim->site_age[s] = (uint32_t)aged(sim, sim->site_age[s], closed && !was, closed);
    }
}

void dmb_bounces_accept(const dmb_evaluation *evaluation, int32_t found)
{
    dmb_sim *sim = evaluation->sim;
    if (found) take_accelerations(sim, evaluation->pseudo_factor);
    age_sites(sim);
    for (uint32_t u = 0; u < sim->scene->unilateral_count; u++) {
        dmb_unilateral_end a, b;
        if (!dmb_bounce_can_open(sim->scene, u)) continue;
        dmb_bounce_ends(sim, u, &a, &b);
        if (sim->bounce_mode[u] != DMB_BOUNCE_LAW || dmb_unilateral_touches(&a, &b))
            exchange_power(sim, u);
        else
            take_mean_speed(evaluation, u);
        const double age = aged(sim, fabs(sim->bounce_age[u]), dmb_unilateral_touches(&a, &b), b.closed);
        sim->bounce_age[u] = found && sim->bounce_stays[u] ? -age : age;
    }
}
