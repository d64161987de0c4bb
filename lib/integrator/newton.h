/* Newton iteration of a step, from the predicted trial to a solution of the equations of motion, and reuse of its
 * factors. */
#ifndef DMB_INTEGRATOR_NEWTON_H
#define DMB_INTEGRATOR_NEWTON_H

#include "integrator/step_motion.h"
#include "integrator/trial_step.h"

/* Convergence history of one Newton iteration. */
typedef struct dmb_convergence_history {
    double first, last;     /* relative residual at the start, and before the last correction */
    double earlier;         /* relative residual before the last correction but one */
    double balance;         /* [N] norm of the terms that balanced at the start */
    double most_work, work; /* [J] |z . residual| of the largest correction z, of the last */
    double along;           /* [J] z . residual of the last correction z, where contacts have mean forces; else 0 */
    uint32_t corrections;
    int32_t linear; /* 1: it starts from a linear prediction, whose change counts as the first correction */
    int32_t hidden; /* 1: the residual is at the rounding level of stiff elements, but corrections by reused factors
                       still reduce the error */
} dmb_convergence_history;

/* Iterates on the trial, for which trial_step->evaluation has been set up. DMB_OK or DMB_NOTE_WORK_LIMITED: done, < 0:
 * failed. */
int32_t dmb_newton(dmb_sim *sim, const dmb_generalized_alpha *c, dmb_trial_step *trial_step);

/* Reuse of factors of the iteration matrix, for further corrections of a step and for later steps. Reused factors
 * converge linearly; they are used while that costs less than a new factorisation. */

/* [-] Tolerance of iterations with reused factors, relative to the bound: they converge linearly and stop just below
 * it, whereas fresh factors stop far below. */
#define DMB_REUSE_TOLERANCE 0.2

/* Start of an iteration: uses the kept factors if they fit this step, otherwise none. */
void dmb_factor_reuse_begin(dmb_sim *sim, dmb_trial_step *trial_step);
/* 1: corrections by reused factors continue although the residual is at rounding level, because the rounding of stiff
 * elements hides the error left in soft directions. */
int32_t dmb_factor_reuse_still_pay(const dmb_sim *sim, const dmb_trial_step *trial_step,
                                   const dmb_convergence_history *history);
/* 1: the present factors are sufficient, i.e. two more corrections at the observed rate reach the bound. Reused factors
 * also make a first correction, which shows their rate. */
int32_t dmb_factor_reuse_will_do(const dmb_sim *sim, const dmb_trial_step *trial_step,
                                 const dmb_convergence_history *history);
/* After an accepted step to the configuration `reached`: keeps its factors for later steps. They are discarded once the
 * corrections beyond the smallest number, less one for each step with that number, have cost as much as new factors. If
 * reused factors failed within a step, the next try waits with exponential back-off. */
void dmb_factor_reuse_end(dmb_sim *sim, const dmb_trial_step *trial_step, const dmb_configuration *reached);
/* A committed step is reverted; `kept`: sim->reuse before it. Factors kept from this step are discarded. */
void dmb_factor_reuse_revert(dmb_sim *sim, const dmb_trial_step *trial_step, const dmb_factor_reuse *kept);

#endif
