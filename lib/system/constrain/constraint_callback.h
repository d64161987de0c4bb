/* The caller's constraints. Derivatives that the callback does not give are built by central differences of fourth
 * order:
 *     J by places:  along each body-frame component;      rate: along time at fixed poses
 *     convective:   along the motion q exp(s v), t + s: of A v + b its first derivative, of C its second; where J is
 *                   given (J v)' + d(J v)/dt + d2C/dt2 instead, which rounding of large coordinates does not spoil
 * Steps are long: at 2 km from the origin rounding of a place is 2e-13 m, and Newton's iteration sees what it
 * becomes. */
#ifndef DMB_SYSTEM_CONSTRAIN_CONSTRAINT_CALLBACK_H
#define DMB_SYSTEM_CONSTRAIN_CONSTRAINT_CALLBACK_H

#include "system/constrain/constraint_rows.h"

/* Rows of a callback; and a comparison of its Jacobian with differences: DMB_ERR_CALLBACK with row and column in the
 * message of the sim. system/constrain/constraint_callback */
int32_t dmb_callback_rows(dmb_evaluation *evaluation, uint32_t callback);
int32_t dmb_callback_curvature(dmb_evaluation *evaluation, uint32_t callback, double *K);
int32_t dmb_callback_check(dmb_sim *sim, uint32_t callback);

#endif
