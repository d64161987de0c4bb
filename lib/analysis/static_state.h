/* Iterations towards equilibrium, on the trial configuration. */
#ifndef DMB_ANALYSIS_STATIC_STATE_H
#define DMB_ANALYSIS_STATIC_STATE_H

#include "drillmbd/analysis.h"
#include "system/evaluation.h"

typedef struct dmb_static_search {
    dmb_sim *sim;
    const dmb_static_options *options;
    dmb_evaluation evaluation;
    uint32_t iterations; /* in all */
    uint32_t load_steps; /* of the last try */
    uint32_t block;      /* block found singular */
    int32_t loose;       /* 1: nothing seems to hold loose_block in the starting pose */
    uint32_t loose_block;
    double residual;     /* [-] relative, last */
    double moved;        /* [-] largest correction before it, in length scales */
    double caution;      /* [-] the relaxation's corrections are this much shorter */
} dmb_static_search;

/* Poses of the trial onto the joints, with a partition that suits the place. */
int32_t dmb_static_settle(dmb_static_search *search);
/* Displaces the trial to the low side of the hole, where there is gravity and a wall. */
void dmb_static_lay_on_wall(dmb_sim *sim);
/* Newton with the extrapolated element stress at the search's load factor. DMB_OK, or why it failed. */
int32_t dmb_static_newton(dmb_static_search *search);
/* Pseudo-transient continuation: (K + D/tau^2) z = -residual with growing tau and limited corrections (Kelley, Keyes
 * 1998); slower and surer. */
int32_t dmb_static_relaxation(dmb_static_search *search);

#endif
