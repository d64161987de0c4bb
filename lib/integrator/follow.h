/* A step beside a step: a sim that differs a little from a leader takes the step that the leader has tried, from the
 * leader's increments, with as many corrections as are asked for and no judgement of convergence. Both states on two
 * sides of the leader's give its derivative by their difference: with the tangent of the leader's own solution as
 * iteration matrix, one correction is off by second order, the same on both sides. */
#ifndef DMB_INTEGRATOR_FOLLOW_H
#define DMB_INTEGRATOR_FOLLOW_H

#include "integrator/attempt.h"

/* Data that all followers of a step share. */
typedef struct dmb_lead {
    const dmb_sim *sim;         /* the leader, its step tried and not accepted */
    const dmb_attempt *attempt; /* that step */
    double *opening; /* [m, rad] increments before contacts opened, of a step that was taken again, shape (row) */
} dmb_lead;

/* Factors of the iteration matrix at the end of the leader's step into the follower, which stands where the leader
 * stands; where contacts opened, the increments before that. DMB_ERR_SINGULAR, and as dmb_system_evaluate. */
int32_t dmb_follow_prepare(dmb_sim *follower, const dmb_lead *lead);
/* The step of the follower, with its memory, into its trial; its state now stays. Errors as above, DMB_ERR_CALLBACK. */
int32_t dmb_follow_step(dmb_sim *follower, const dmb_lead *lead);

#endif
