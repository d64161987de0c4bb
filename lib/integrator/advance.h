/* Error-controlled steps, one at a time, for calls that end elsewhere than dmb_sim_advance. */
#ifndef DMB_INTEGRATOR_ADVANCE_H
#define DMB_INTEGRATOR_ADVANCE_H

#include "integrator/step.h"

/* [s] Step length that error-controlled steps begin with. */
double dmb_advance_first(const dmb_sim *sim);
/* The next one begins with this length [s]. */
void dmb_advance_propose(dmb_sim *sim, double wanted);
/* One accepted step within the error tolerances towards `time` [s], of about *wanted [s], which becomes the next one's
 * length. */
int32_t dmb_advance_once(dmb_sim *sim, double time, double *wanted, dmb_walk *walk);

#endif
