/* The Newton iteration of a step: from the predicted trial to one that satisfies the equations of motion. */
#ifndef DMB_INTEGRATOR_NEWTON_H
#define DMB_INTEGRATOR_NEWTON_H

#include "integrator/attempt.h"
#include "integrator/generalized_alpha.h"

/* Course of one Newton iteration. */
typedef struct dmb_newton_course {
    double first, last; /* relative residual at the start, and before the last correction */
    double balance;     /* [N] norm of the terms that balanced at the start */
    uint32_t corrections;
    int32_t hidden;     /* 1: all that shows is rounding, but kept factors still find something below it */
} dmb_newton_course;

/* Iterates on the trial, attempt->evaluation being set up for it. 0 or DMB_NOTE_WORK_LIMITED: done, < 0: failed. */
int32_t dmb_newton(dmb_sim *sim, const dmb_generalized_alpha *c, dmb_attempt *attempt);

#endif
