/* Ends of steps: time of the clock there, and breakpoints of time functions, at which steps are divided. */
#ifndef DMB_INTEGRATOR_BREAKPOINT_H
#define DMB_INTEGRATOR_BREAKPOINT_H

#include "sim/sim.h"

/* The end of a step. */
typedef struct dmb_step_end {
    double step;       /* [s] its length */
    double begin;      /* [s] time of the clock at its start */
    double time, rest; /* [s] time of the clock at its end, and the rounding error that enters the next sum */
    double breakpoint; /* [s] breakpoint at its end, to within rounding or a sliver; 0: none */
    double inside;     /* [s] the only breakpoint inside a step that is not divided there; 0: none */
    double
        asked; /* [s] length of the step that the caller requested, if this is a part of it; 0: it is the whole step */
    int32_t arrives; /* 1: the call ends here */
    int32_t reserved;
} dmb_step_end;

/* [s] Step length that decides whether a contact is resolved: the same in all parts of a divided step. */
static inline double dmb_step_end_asked(const dmb_step_end *end)
{
    return end->asked > 0.0 ? end->asked : end->step;
}

/* A step of exactly `step` [s] from the present time. */
dmb_step_end dmb_step_end_after(const dmb_sim *sim, double step);
/* A step that ends exactly at `time` [s]. */
dmb_step_end dmb_step_end_at(const dmb_sim *sim, double time);
/* The step to `goal` or, if that comes first, to the next breakpoint. A single breakpoint within a sliver (of steps of
 * length `h` [s]) of the goal counts as reached at the goal, because a very short step adds more noise than it removes
 * error. */
dmb_step_end dmb_step_end_before_breakpoint(const dmb_sim *sim, const dmb_step_end *goal, double h);
/* The goal with the breakpoints at its end or inside the step, which is not divided there. */
dmb_step_end dmb_step_end_over_breakpoints(const dmb_sim *sim, const dmb_step_end *goal);
/* The same end, moved onto the breakpoint if the two differ only by the rounding of sums of steps. */
dmb_step_end dmb_step_end_on_breakpoint(dmb_step_end end);

#endif
