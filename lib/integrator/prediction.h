/* Initial guess of a step (eq:integration.prediction): constant accelerations, or accelerations extrapolated linearly.
 */
#ifndef DMB_INTEGRATOR_PREDICTION_H
#define DMB_INTEGRATOR_PREDICTION_H

#include "integrator/step_motion.h"
#include "integrator/trial_step.h"

/* Predicts the motion of the trial; trial_step->linear reports which of the two predictions was used. */
void dmb_prediction_make(dmb_sim *sim, const dmb_generalized_alpha *c, dmb_trial_step *trial_step);
/* [J] |z . residual| that a linear prediction has saved, z being its increments less those of the constant prediction
 * (eq:integration.prediction-increment); sim->chain_start becomes the residual at the constant prediction. Computed
 * with lumped masses: correct for motion that the step resolves, an underestimate for stiffer motion. */
double dmb_prediction_saved(dmb_sim *sim, const dmb_trial_step *trial_step);
/* After an accepted step: chooses the prediction of the next one. */
void dmb_prediction_note(dmb_sim *sim, const dmb_trial_step *trial_step);

#endif
