/* The Newton iteration of a step, from the predicted trial to one that satisfies the equations of motion, and the
 * factors that it is done with. */
#ifndef DMB_INTEGRATOR_NEWTON_H
#define DMB_INTEGRATOR_NEWTON_H

#include "integrator/step_motion.h"
#include "integrator/trial_step.h"

/* Course of one Newton iteration. */
typedef struct dmb_convergence_history {
    double first, last;     /* relative residual at the start, and before the last correction */
    double earlier;         /* relative residual before the last correction but one */
    double balance;         /* [N] norm of the terms that balanced at the start */
    double most_work, work; /* [J] |z . residual| of the largest correction z, of the last */
    double along;           /* [J] z . residual of the last correction z, where contacts have mean forces; else 0 */
    uint32_t corrections;
    int32_t linear; /* 1: it began from a linear prediction, whose correction is the first */
    int32_t hidden; /* 1: all that shows is rounding, but reused factors still find something below it */
} dmb_convergence_history;

/* Iterates on the trial, trial step->evaluation being set up for it. 0 or DMB_NOTE_WORK_LIMITED: done, < 0: failed. */
int32_t dmb_newton(dmb_sim *sim, const dmb_generalized_alpha *c, dmb_trial_step *trial_step);

/* Factors of the iteration matrix that go on serving: for further corrections of a step, and for the steps after it.
 * Kept ones converge linearly; they are tried as long as that costs less than making new ones. */

/* Kept factors converge linearly and end just below their tolerance, where fresh ones end far below: they aim lower. */
#define DMB_REUSE_TOLERANCE 0.2

/* Start of an iteration: with the reused factors where there are any for this step, else with none. */
void dmb_factor_reuse_begin(dmb_sim *sim, dmb_trial_step *trial_step);
/* The rounding of stiff elements hides what reused factors leave in soft directions: they go on while it pays. */
int32_t dmb_factor_reuse_still_pay(const dmb_sim *sim, const dmb_trial_step *trial_step,
                                   const dmb_convergence_history *history);
/* Factors that are there do when two more corrections at the present rate reach what they aim at; kept ones also for a
 * first correction, which shows their rate. */
int32_t dmb_factor_reuse_will_do(const dmb_sim *sim, const dmb_trial_step *trial_step,
                                 const dmb_convergence_history *history);
/* After a successful step that reached this configuration: its factors are kept for the steps to come, until the
 * corrections that these have taken beyond the fewest, less one for each step that took these, have cost as much as new
 * ones. Where reused factors did
 * not do within a step, the next try waits, longer each time. */
void dmb_factor_reuse_end(dmb_sim *sim, const dmb_trial_step *trial_step, const dmb_configuration *reached);
/* Of a committed step that is taken back; `kept`: sim->reuse before. Factors that the step has kept are lost with it.
 */
void dmb_factor_reuse_take_back(dmb_sim *sim, const dmb_trial_step *trial_step, const dmb_factor_reuse *kept);

#endif
