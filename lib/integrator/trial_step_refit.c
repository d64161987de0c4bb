/* Motion at the end of a repeated step, from the increments found so far and a history without the contacts that open
 * (eq:contact.release): a1 from eq:integration.newmark solved for it, v1' from eq:integration.recursion, v1 from both.
 * The increment z is kept and determines a1, which determines v1' and v1. At the start, v' has lost M^-1 times the
 * removed forces and a - v' the fraction of the step after the opening:
 *
 *     body                     rows that the formulas act on              state at the start
 *     ----------------------   ----------------------------------------   ----------------------------------------
 *     node                     its own, without prescribed ones           now
 *     free rigid body          of its centre of mass                      eq:integration.free-rigid
 *     rotor                    in axes that do not spin with it           eq:motion.rotor-step */
#include "integrator/step_motion.h"
#include "integrator/trial_step.h"
#include "sim/chunks.h"
#include "system/assemble/assemble.h"
#include "system/constrain/rotor.h"

/* Increment z over a step, and velocity v, acceleration dv and pseudo-acceleration a0 at its start. */
typedef struct start {
    double z, v, dv, a0;
} start;

/* Motion of row i at the end of the step, from eq:integration.newmark and eq:integration.recursion:
 *     a1  = ((z - h v0)/h^2 - (1/2 - beta) a0)/beta
 *     v1' = ((1 - am) a1 + am a0 - af v0')/(1 - af) */
static void refit(const dmb_generalized_alpha *c, double h, const start *s, const dmb_step_motion *to, uint32_t i)
{
    const double z = s->z, v = s->v, dv = s->dv, a0 = s->a0;
    const double a1 = ((z - h * v) / (h * h) - (0.5 - c->beta) * a0) / c->beta;
    to->pseudo_acceleration[i] = a1;
    to->acceleration[i] = ((1.0 - c->am) * a1 + c->am * a0 - c->af * dv) / (1.0 - c->af);
    to->velocity[i] = v + h * ((1.0 - c->gamma) * a0 + c->gamma * a1);
}

/* A free rigid body, at its centre of mass. */
static void refit_rigid(dmb_sim *sim, const dmb_generalized_alpha *c, double h, uint32_t rigid)
{
    const uint32_t node = sim->scene->free_rigids[rigid].node, row = sim->scene->layout.row[node];
    const double ratio = dmb_step_motion_ratio(sim, h);
    double from[18], gone[6], *motion = dmb_free_rigid_motion(sim, rigid);
    const dmb_step_motion to = {motion, motion + 6, motion + 12};
    dmb_free_rigid_start(sim, rigid, from);
    for (uint32_t k = 0; k < 6; k++) gone[k] = sim->correction[row + k];
    dmb_free_rigid_added(sim->scene, rigid, gone);
    for (uint32_t k = 0; k < 6; k++) {
        const double dv = from[6 + k] - gone[k];
        const double a0 = dv + (1.0 - sim->released_part[node]) * ratio * (from[12 + k] - from[6 + k]);
        const start s = {sim->increment[row + k], from[k], dv, a0};
        refit(c, h, &s, &to, k);
    }
}

/* A rotor, in axes that do not spin with it. */
static void refit_rotor(const dmb_sim *sim, const dmb_generalized_alpha *c, double h, uint32_t rotor)
{
    const uint32_t node = sim->scene->rotors[rotor].node, row = sim->scene->layout.row[node];
    const double ratio = dmb_step_motion_ratio(sim, h), kept = 1.0 - sim->released_part[node];
    const double *from = sim->rotor_step[rotor].start;
    dmb_step_motion to = dmb_step_motion_of(sim);
    const double *gone = sim->correction + row; /* already in axes at the end of the step */
    to.velocity += row, to.acceleration += row, to.pseudo_acceleration += row;
    for (uint32_t k = 0; k < 6; k++) {
        const double dv = from[6 + k] - gone[k], a0 = dv + kept * ratio * (from[12 + k] - from[6 + k]);
        const start s = {sim->increment[row + k], from[k], dv, a0};
        refit(c, h, &s, &to, k);
    }
    dmb_rotor_leave(sim, rotor, to.velocity, to.acceleration, to.pseudo_acceleration);
}

static void refit_node(const dmb_sim *sim, const dmb_generalized_alpha *c, double h, uint32_t node)
{
    const uint32_t first = sim->scene->layout.row[node], end = sim->scene->layout.row[node + 1];
    const double ratio = dmb_step_motion_ratio(sim, h), kept = 1.0 - sim->released_part[node];
    const dmb_step_motion to = dmb_step_motion_of(sim);
    for (uint32_t i = first; i < end; i++) {
        if (!sim->scene->solved_row[i]) continue;
        const double dv = sim->now.acceleration[i] - sim->correction[i];
        const double a0 = dv + kept * (dmb_step_motion_carried(sim, ratio, i) - sim->now.acceleration[i]);
        const start s = {sim->increment[i], sim->now.velocity[i], dv, a0};
        refit(c, h, &s, &to, i);
    }
}

typedef struct refit_work {
    const dmb_sim *sim;
    const dmb_generalized_alpha *c;
    double step;
} refit_work;

static void refit_nodes(void *work, uint32_t first, uint32_t end)
{
    const refit_work *in = work;
    for (uint32_t i = first; i < end; i++) refit_node(in->sim, in->c, in->step, i);
}

void dmb_trial_step_refit(dmb_sim *sim, const dmb_generalized_alpha *c, double h)
{
    refit_work work = {sim, c, h};
    dmb_chunks_run(sim, sim->scene->node_count, DMB_GRAIN, refit_nodes, &work);
    for (uint32_t i = 0; i < sim->scene->free_rigid_count; i++) refit_rigid(sim, c, h, i);
    for (uint32_t i = 0; i < sim->scene->rotor_count; i++) refit_rotor(sim, c, h, i);
}
