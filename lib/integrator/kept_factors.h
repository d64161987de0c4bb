/* Factors of the iteration matrix that go on serving: for further corrections of a step, and for the steps after it.
 * Kept ones converge linearly; they are tried as long as that costs less than making new ones. */
#ifndef DMB_INTEGRATOR_KEPT_FACTORS_H
#define DMB_INTEGRATOR_KEPT_FACTORS_H

#include "integrator/newton.h"

/* Kept factors converge linearly and end just below their tolerance, where fresh ones end far below: they aim lower. */
#define DMB_KEPT_TOLERANCE 0.2

/* Start of an iteration: with the kept factors where there are any for this step, else with none. */
void dmb_kept_factors_begin(dmb_sim *sim, dmb_attempt *attempt);
/* [-] Relative residual that the factors in use aim at. */
static inline double dmb_kept_factors_aim(const dmb_sim *sim, const dmb_attempt *attempt)
{
    const double own = sim->options.newton_tolerance;
    return attempt->factored == DMB_FACTORS_KEPT ? DMB_KEPT_TOLERANCE * own : own;
}

/* The rounding of stiff elements hides what kept factors leave in soft directions: they go on while it pays. */
int32_t dmb_kept_factors_still_pay(const dmb_sim *sim, const dmb_attempt *attempt, const dmb_newton_course *course);
/* Factors that are there do when two more corrections at the present rate reach what they aim at; kept ones also for a
 * first correction, which shows their rate. */
int32_t dmb_kept_factors_will_do(const dmb_sim *sim, const dmb_attempt *attempt, const dmb_newton_course *course);
/* After a successful step: its factors are kept for the steps to come, until the corrections that these have taken
 * beyond the first such step have cost as much as new ones. Where kept factors did not do within a step, the next try
 * waits, longer each time. */
void dmb_kept_factors_end(dmb_sim *sim, const dmb_attempt *attempt);

#endif
