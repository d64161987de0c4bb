/* One trial step of generalized-alpha: computed in `trial`, then committed to `now` or discarded. */
#ifndef DMB_INTEGRATOR_TRIAL_STEP_H
#define DMB_INTEGRATOR_TRIAL_STEP_H

#include "integrator/breakpoint.h"
#include "integrator/step_motion.h"
#include "sim/sim.h"
#include "system/assemble/evaluation.h"

/* Stage of a trial step: which solve its result comes from. Each stage is a complete solve from the accepted state.
 *
 *                contacts change, after
 *                a linear prediction
 *     +-------+ ------------------------> +----------+
 *     | FIRST |                           | CONSTANT |
 *     +-------+                           +----------+
 *         | does not converge *                | does not converge *
 *         v                                    v
 *     +-------+                           +--------------+
 *     |  OWN  |                           | CONSTANT_OWN |
 *     +-------+                           +--------------+
 *
 * Any stage that succeeds goes on to the checks of the step; OWN and CONSTANT_OWN fail if they do not converge.
 * (*) If reused factors or a linear prediction were tried, otherwise the step fails at once. */
enum {
    DMB_STAGE_FIRST = 0,       /* linear prediction and reused factors, if permitted */
    DMB_STAGE_CONSTANT = 1,    /* constant prediction */
    DMB_STAGE_OWN = 2,         /* constant prediction and factors of its own */
    DMB_STAGE_CONSTANT_OWN = 3 /* the same, because contacts change too */
};

/* Use of the factors of a trial step in later steps. AFTER_JUMP: a later callback may still revert the step. */
enum { DMB_KEEP_NOTHING = 0, DMB_KEEP_AT_COMMIT = 1, DMB_KEEP_AFTER_JUMP = 2 };

typedef struct dmb_trial_step {
    dmb_evaluation evaluation; /* the most recent one */
    dmb_step_end end;
    double residual; /* [-] relative residual at the end */
    double bound;    /* [-] bound of the residual */
    uint32_t iterations;
    int32_t status;   /* DMB_OK, DMB_NOTE_WORK_LIMITED, or the error of a failed step */
    uint32_t block;   /* block found singular, with DMB_ERR_SINGULAR */
    uint32_t over;    /* node that a converged step turned too far (dmb_bounces_overturn), or DMB_NONE */
    int32_t stage;    /* DMB_STAGE_... */
    int32_t keep;     /* DMB_KEEP_...; NOTHING: reused factors are not used either */
    int32_t factored; /* DMB_FACTORS_...: factors of the last iteration */
    int32_t tried;    /* 1: reused factors were tried */
    int32_t released; /* 1: contacts opened, and the step was repeated without their force (eq:contact.release) */
    int32_t bounced;  /* 1: contacts, stops or springs had mean forces (eq:unilateral.mean) */
    int32_t linear;   /* 1: linear prediction (eq:integration.prediction) */
} dmb_trial_step;

/* [-] Local error of the pose of a step over its tolerance, largest row, and its largest value within a quarter of a
 * period (eq:integration.error-ahead): the error is proportional to the rate of the acceleration, which vanishes twice
 * in each period. */
typedef struct dmb_step_error {
    double here, ahead;
} dmb_step_error;

/* Computes a trial step from now to `end`; returns trial_step->status. `now` and the memory fields are unchanged.
 * sole: 1 if the call consists of this step, so that it never has to revert it after a later failure. */
int32_t dmb_trial_step_run(dmb_sim *sim, const dmb_step_end *end, int32_t sole, dmb_trial_step *trial_step);
/* After a successful trial step in which a stuck place releases: repeats it with its end just after the release.
 * Returns the status of the repeated step. */
int32_t dmb_trial_step_to_release(dmb_sim *sim, dmb_trial_step *trial_step);
/* Local error of a successful trial step of length `step` [s]. */
dmb_step_error dmb_trial_step_error(const dmb_sim *sim, double step);
/* Makes the trial the accepted state. */
void dmb_trial_step_commit(dmb_sim *sim, dmb_trial_step *trial_step);
/* Stages of a trial step, also used by integrator/companion. Sets up the evaluation of a step to `end`. */
void dmb_trial_step_set_up(dmb_sim *sim, const dmb_step_end *end, dmb_evaluation *evaluation);
/* Recomputes the motion of the trial from the present increments, after subtracting the accelerations sim->correction
 * from the start of the step and the carried fraction sim->released_part of a0 - v0' at each node (eq:contact.release).
 */
void dmb_trial_step_refit(dmb_sim *sim, const dmb_generalized_alpha *c, double h);
/* Writes the message of a failed trial step: part, time and step length. */
void dmb_trial_step_explain(dmb_sim *sim, const dmb_trial_step *trial_step);

/* Elements whose logarithm may have lost a revolution within one step. */

/* Element whose relative rotation changed by more than 2 (pi - 2.5) rad in the trial step; DMB_NONE if there is none. A
 * smaller change cannot lead from below 2.5 rad past pi to below 2.5 rad, where the logarithm would be a revolution
 * short. O(number of elements). */
uint32_t dmb_element_turned_too_far(const dmb_sim *sim);

#endif
