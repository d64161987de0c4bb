/* Elements that may have lost a revolution within one step. */
#ifndef DMB_INTEGRATOR_TURNING_H
#define DMB_INTEGRATOR_TURNING_H

#include "state.h"

/* Element whose ends turned against each other by more than 2 (pi - 2.5) rad in the step from now to trial; UINT32_MAX if
 * there is none. Less than that cannot lead from below 2.5 rad past pi to below 2.5 rad, where the logarithm would be a
 * revolution short. O(number of elements). */
uint32_t dmb_element_turned_too_far(const dmb_sim *sim);

#endif
