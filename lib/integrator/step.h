/* Steps of fixed length and steps with error control, and the parts that both share: checks, the report, keeping and
 * bringing back the state. */
#ifndef DMB_INTEGRATOR_STEP_H
#define DMB_INTEGRATOR_STEP_H

#include "drillmbd/run.h"
#include "integrator/trial_step.h"

typedef struct dmb_stepping {
    dmb_step_report report;
    dmb_counters counters;         /* as before the call */
    uint32_t rejected, iterations; /* [-] of the report, up to the last accepted step */
    int32_t set_aside;             /* 1: the state before the call is in sim->backup */
    int32_t was_cut;
    int32_t limited;
    int32_t stopped;    /* max_steps used up */
    int32_t too_coarse; /* a step of step_min was taken above the error tolerance */
    int32_t arrived;    /* 1: the call's last step is done */
} dmb_stepping;

/* Checks the report. */
int32_t dmb_stepping_begin(dmb_sim *sim, const dmb_step_report *report, dmb_stepping *stepping);
/* DMB_ERR_NOT_FINITE or DMB_ERR_VALUE with a message unless value is finite and > bound. */
int32_t dmb_stepping_check(dmb_sim *sim, const char *field, double value, double bound);
/* DMB_ERR_VALUE with a message unless value is <= bound. */
int32_t dmb_stepping_check_at_most(dmb_sim *sim, const char *field, double value, double bound);
/* Accepts the step, unless the sim's follower refuses it, with accelerations anew where forces or a rate jump at the
 * time reached. Where a function of the caller's fails in that, the step is taken back: DMB_ERR_CALLBACK. */
int32_t dmb_stepping_commit(dmb_sim *sim, dmb_trial_step *trial_step, dmb_stepping *stepping);
/* DMB_ERR_VALUE: the clock cannot tell a step of this length, the value of `field`. */
int32_t dmb_stepping_stuck(dmb_sim *sim, const char *field, double step);
void dmb_stepping_reject(dmb_sim *sim, const dmb_trial_step *trial_step, dmb_stepping *stepping);
/* Writes the report and gives the status of the call; on failure with `restore` the state before the call is back. */
int32_t dmb_stepping_end(dmb_sim *sim, int32_t status, int32_t restore, dmb_step_report *report,
                         const dmb_stepping *stepping);

/* Error-controlled steps, one at a time, for calls that end elsewhere than dmb_sim_advance. */

/* [s] Step length that error-controlled steps begin with. */
double dmb_advance_first(const dmb_sim *sim);
/* The next one begins with this length [s]. */
void dmb_advance_propose(dmb_sim *sim, double wanted);
/* One accepted step within the error tolerances towards `time` [s], of about *wanted [s], which becomes the next one's
 * length. */
int32_t dmb_advance_once(dmb_sim *sim, double time, double *wanted, dmb_stepping *stepping);

#endif
