/* One step of generalized-alpha: tried on `trial`, then committed to `now` or forgotten. */
#ifndef DMB_INTEGRATOR_TRIAL_STEP_H
#define DMB_INTEGRATOR_TRIAL_STEP_H

#include "integrator/breakpoint.h"
#include "integrator/step_motion.h"
#include "sim/sim.h"
#include "system/assemble/evaluation.h"

typedef struct dmb_trial_step {
    dmb_evaluation evaluation; /* the last one */
    dmb_step_end end;
    double residual; /* [-] relative, at the end */
    double bound;    /* [-] what it had to come down to */
    uint32_t iterations;
    int32_t status;   /* DMB_OK, DMB_NOTE_WORK_LIMITED, or why the step failed */
    uint32_t block;   /* block found singular, with DMB_ERR_SINGULAR */
    int32_t whole;    /* 1: the step stands by itself, so it may use and leave reused factors */
    int32_t factored; /* DMB_FACTORS_...: what the last iteration was done with */
    int32_t tried;    /* 1: reused factors were tried */
    int32_t diverged; /* 1: they or a linear prediction led to nothing, and the step began again without both */
    int32_t released; /* 1: contacts opened, and the step was taken again without their force */
    int32_t deferred; /* 1: commit leaves the reused factors alone, for the step may still be taken back */
    int32_t constant; /* 1: accelerations that stay are to begin with, since contacts change in the step */
    int32_t bounced;  /* 1: stops or springs touch or open, or were treated as if they did */
    int32_t linear;   /* 1: it began from accelerations that go on as they did */
} dmb_trial_step;

/* [-] Local error of the pose of a step over its tolerance, largest row, and what it may become within a quarter of a
 * period: it goes with the rate of the acceleration, which is 0 twice in each. */
typedef struct dmb_step_error {
    double here, ahead;
} dmb_step_error;

/* Tries a step from now to `end`; returns trial step->status. now and the memory fields are not touched. whole: 1
 * unless the call would have to take this step back if a later one fails. */
int32_t dmb_trial_step_run(dmb_sim *sim, const dmb_step_end *end, int32_t whole, dmb_trial_step *trial_step);
/* After a successful trial step: where a stuck place lets go on the way, the step is tried again to the time at which
 * it does, on the far side of it. The status of that. */
int32_t dmb_trial_step_to_release(dmb_sim *sim, dmb_trial_step *trial_step);
/* Of a successful trial step of length `step` [s]. */
dmb_step_error dmb_trial_step_error(const dmb_sim *sim, double step);
/* Makes the trial of a successful trial step the accepted state. */
void dmb_trial_step_commit(dmb_sim *sim, dmb_trial_step *trial_step);
/* Parts of an trial step, for those who take one step by step (integrator/companion). The evaluation of a step to
 * `end`. */
void dmb_trial_step_set_up(dmb_sim *sim, const dmb_step_end *end, dmb_evaluation *evaluation);
/* Motion of the trial from the increments at hand, with the accelerations sim->correction taken off the start of the
 * step, and their carried part off the nodes of sim->released_part. */
void dmb_trial_step_refit(dmb_sim *sim, const dmb_generalized_alpha *c, double h);
/* Message for a failed trial step: which part, at what time. */
void dmb_trial_step_explain(dmb_sim *sim, const dmb_trial_step *trial_step);

/* Elements that may have lost a revolution within one step. */

/* Element whose ends turned against each other by more than 2 (pi - 2.5) rad in the step from now to trial; DMB_NONE
 * if there is none. Less than that cannot lead from below 2.5 rad past pi to below 2.5 rad, where the logarithm would
 * be a revolution short. O(number of elements). */
uint32_t dmb_element_turned_too_far(const dmb_sim *sim);

#endif
