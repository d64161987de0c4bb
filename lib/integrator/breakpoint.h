/* Ends of steps: where the clock will stand, and breakpoints of time functions, which no step goes over. */
#ifndef DMB_INTEGRATOR_BREAKPOINT_H
#define DMB_INTEGRATOR_BREAKPOINT_H

#include "sim/sim.h"

/* The end of a step. */
typedef struct dmb_step_end {
    double step;       /* [s] its length */
    double begin;      /* [s] of the clock where it begins */
    double time, rest; /* [s] of the clock there, and what its rounding leaves for the next sum */
    double breakpoint; /* [s] breakpoint that it ends at, to within rounding or a sliver; 0: none */
    double inside;     /* [s] the one breakpoint inside, of a step that is not divided there; 0: none */
    double asked;      /* [s] length of the step that the caller asked for, of which this is a part; 0: it is whole */
    int32_t arrives;   /* 1: this is where the call is to end */
    int32_t reserved;
} dmb_step_end;

/* [s] Length that decides whether a contact is resolved, the same in all parts of a divided step. */
static inline double dmb_step_end_asked(const dmb_step_end *end)
{
    return end->asked > 0.0 ? end->asked : end->step;
}

/* A step of exactly `step` [s] from the present time. */
dmb_step_end dmb_step_end_after(const dmb_sim *sim, double step);
/* One to the time `time` [s], exactly. */
dmb_step_end dmb_step_end_at(const dmb_sim *sim, double time);
/* The step to `goal` or, if that comes first, to the next breakpoint. A single breakpoint no farther from the goal
 * than a sliver of steps of length `h` [s] is met with it: a step of next to nothing is not worth its noise. */
dmb_step_end dmb_step_end_before_breakpoint(const dmb_sim *sim, const dmb_step_end *goal, double h);
/* The goal with the breakpoints that the step meets, not divided there. */
dmb_step_end dmb_step_end_over_breakpoints(const dmb_sim *sim, const dmb_step_end *goal);
/* The same end, on the breakpoint itself where only the rounding of sums of steps lies between them. */
dmb_step_end dmb_step_end_on_breakpoint(dmb_step_end end);

#endif
