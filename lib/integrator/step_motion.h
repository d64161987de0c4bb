/* Generalized-alpha on the Lie group: eq:integration.recursion, eq:integration.newmark. */
#ifndef DMB_INTEGRATOR_STEP_MOTION_H
#define DMB_INTEGRATOR_STEP_MOTION_H

#include "sim/sim.h"

typedef struct dmb_generalized_alpha {
    double am, af, gamma, beta;
    double error; /* local error of the pose is error h^2 (a1 - a0) (eq:integration.local-error) */
} dmb_generalized_alpha;

/* Parameters for the spectral radius r at infinite frequency, 0 .. 1 (eq:integration.parameters,
 * eq:integration.modified). */
static inline dmb_generalized_alpha dmb_generalized_alpha_of(double r)
{
    dmb_generalized_alpha c;
    c.am = (2.0 * r - 1.0) / (r + 1.0);
    c.af = r / (r + 1.0);
    c.gamma = 0.5 + c.af - c.am;
    c.beta = 0.25 * (c.gamma + 0.5) * (c.gamma + 0.5);
    c.error = c.beta + 0.5 * (c.am - c.af) - 1.0 / 6.0;
    return c;
}

/* Motion of the trial: predicted from the accepted state, then corrected by Newton. */

/* [-] Largest ratio of a step to the one before for which the pseudo-acceleration is carried. */
#define DMB_STEP_RATIO_MAX 1e3

/* The trial itself or, in scenes with joints, the motion before its projection onto the constraints. Increments h Dq:
 * sim->increment. */
typedef struct dmb_step_motion {
    double *velocity, *acceleration, *pseudo_acceleration;
} dmb_step_motion;

static inline dmb_step_motion dmb_step_motion_of(const dmb_sim *sim)
{
    const dmb_step_motion trial = {sim->trial.velocity, sim->trial.acceleration, sim->trial.pseudo_acceleration};
    const dmb_step_motion raw = {sim->raw_velocity, sim->raw_acceleration, sim->raw_pseudo_acceleration};
    return sim->scene->cluster_count ? raw : trial;
}

/* [-] Ratio of this step to the one before. After a very short step a0 - v0' is lost in the error of Newton, which a
 * large ratio would amplify: ratio 0 then restarts a0 from the acceleration. */
static inline double dmb_step_motion_ratio(const dmb_sim *sim, double step)
{
    if (!(sim->clock->step > 0.0)) return 1.0;
    return step > DMB_STEP_RATIO_MAX * sim->clock->step ? 0.0 : step / sim->clock->step;
}

/* a0 of row i carried over to a new step length, v0' + (h/h_old)(a0 - v0'), which keeps second order
 * (eq:integration.carry). */
static inline double dmb_step_motion_carried(const dmb_sim *sim, double ratio, uint32_t i)
{
    const double a = sim->now.acceleration[i];
    return a + ratio * (sim->now.pseudo_acceleration[i] - a);
}

/* Prediction of a step of length h [s]: v1' = v0' + slope (a0 - v0') (eq:integration.prediction). With slope [-] != 0,
 * sim->correction becomes the increments less those for slope 0; requires a scene without joints and free rigid bodies.
 */
void dmb_step_motion_predict(dmb_sim *sim, const dmb_generalized_alpha *c, double h, double slope);
/* Copies the motion prescribed by drives of nodes from the trial. */
void dmb_step_motion_keep_prescribed(dmb_sim *sim);
/* Pose of the trial: the accepted pose moved by the increments. */
void dmb_step_motion_place(dmb_sim *sim);
/* Moves motion and trial to the given increments, except in prescribed rows. */
void dmb_step_motion_go_to(dmb_sim *sim, const dmb_generalized_alpha *c, double h, const double *increment);
/* Sets the increments alone. */
void dmb_step_motion_set(dmb_sim *sim, const double *increment);
/* Moves motion and trial by sim->correction, a change of h Dq (eq:integration.factors). */
void dmb_step_motion_correct(dmb_sim *sim, const dmb_generalized_alpha *c, double h);

#endif
