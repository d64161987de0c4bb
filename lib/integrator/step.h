/* Steps of fixed length and steps with error control, and their common parts: checks, report, backup and restoration of
 * the state. */
#ifndef DMB_INTEGRATOR_STEP_H
#define DMB_INTEGRATOR_STEP_H

#include "drillmbd/run.h"
#include "integrator/trial_step.h"

typedef struct dmb_stepping {
    dmb_step_report report;
    dmb_counters counters;         /* before the call */
    uint32_t rejected, iterations; /* [-] values of the report at the last accepted step */
    int32_t backed_up;             /* 1: the state before the call is in sim->backup */
    int32_t was_cut;
    int32_t limited;
    int32_t stopped;    /* 1: max_steps used up; 2: ended by the caller's function of accepted steps */
    int32_t too_coarse; /* a step of length step_min was accepted above the error tolerance */
    int32_t arrived;    /* 1: the call's last step is done */
} dmb_stepping;

/* Checks the report. */
int32_t dmb_stepping_begin(dmb_sim *sim, const dmb_step_report *report, dmb_stepping *stepping);
/* DMB_ERR_NOT_FINITE or DMB_ERR_VALUE with a message unless value is finite and > bound. */
int32_t dmb_stepping_check(dmb_sim *sim, const char *field, double value, double bound);
/* DMB_ERR_VALUE with a message unless value is <= bound. */
int32_t dmb_stepping_check_at_most(dmb_sim *sim, const char *field, double value, double bound);
/* Accepts the step unless the sim's companion (sim->follower) refuses it, and recomputes the accelerations if forces or
 * a prescribed rate jump at the time reached. If a callback fails there, the step is reverted: DMB_ERR_CALLBACK. */
int32_t dmb_stepping_commit(dmb_sim *sim, dmb_trial_step *trial_step, dmb_stepping *stepping);
/* DMB_ERR_VALUE with a message: the length of the step, the value of `field`, is below the resolution of the clock. */
int32_t dmb_stepping_stuck(dmb_sim *sim, const char *field, double step);
void dmb_stepping_reject(dmb_sim *sim, const dmb_trial_step *trial_step, dmb_stepping *stepping);
/* Writes the report and returns the status of the call; with `restore`, a failure restores the state before the call.
 */
int32_t dmb_stepping_end(dmb_sim *sim, int32_t status, int32_t restore, dmb_step_report *report,
                         const dmb_stepping *stepping);

/* After an accepted step: calls the accept functions of the callers' laws and the caller's function of accepted steps.
 * 1: it ends the call. */
int dmb_stepping_ends(dmb_sim *sim);
/* The same within a call that goes on to `time` [s]: the reason to stop before it, or 0. */
int32_t dmb_stepping_stops(dmb_sim *sim, double time, const dmb_stepping *stepping);
/* Message of a call that the function of accepted steps ended. */
void dmb_stepping_tell_end(dmb_sim *sim, uint32_t steps);

/* Looks at the sim after each accepted call of equal steps: 0, 1 to end the call, or a negative status, which ends it.
 */
typedef struct dmb_step_watch {
    int32_t (*look)(void *context);
    void *context;
} dmb_step_watch;
/* dmb_sim_steps with a watch (NULL: none). */
int32_t dmb_steps_watched(dmb_sim *sim, double duration, uint32_t count, uint32_t *done, dmb_step_report *report,
                          const dmb_step_watch *watch);

/* Single error-controlled steps, for calls that stop elsewhere than dmb_sim_advance. */

/* [s] Length of the first error-controlled step. */
double dmb_advance_first(const dmb_sim *sim);
/* Sets the length [s] of the next error-controlled step. */
void dmb_advance_propose(dmb_sim *sim, double wanted);
/* One accepted step within the error tolerances towards `time` [s]. *wanted [s]: its proposed length, replaced by that
 * of the next step. */
int32_t dmb_advance_once(dmb_sim *sim, double time, double *wanted, dmb_stepping *stepping);

#endif
