/* Where the iteration of a step begins (eq:integration.prediction): from accelerations that stay, or from such as go on
 * as they did. */
#ifndef DMB_INTEGRATOR_PREDICTION_H
#define DMB_INTEGRATOR_PREDICTION_H

#include "integrator/step_motion.h"
#include "integrator/trial_step.h"

/* Motion of the trial to begin with; trial step->linear tells which of the two it is. */
void dmb_prediction_make(dmb_sim *sim, const dmb_generalized_alpha *c, dmb_trial_step *trial_step);
/* [J] |z . residual| that a linear prediction has saved, z being what its increments are more by
 * (eq:integration.prediction-increment); sim->chain_start
 * becomes the residual that it would have begun with. By lumped masses: of motion that the step resolves it is that,
 * of stiffer motion less. */
double dmb_prediction_saved(dmb_sim *sim, const dmb_trial_step *trial_step);
/* After an accepted step: which one the next begins with. */
void dmb_prediction_note(dmb_sim *sim, const dmb_trial_step *trial_step);

#endif
