/* A quantity at a place as a linear function of the motion of the nodes about a state: what a query would answer to a
 * small motion q, q', q'' of the rows. */
#ifndef DMB_ANALYSIS_FUNCTIONAL_H
#define DMB_ANALYSIS_FUNCTIONAL_H

#include "drillmbd/response.h"
#include "state.h"

/* Four neighbouring nodes: the two of an element and one on either side. */
enum { DMB_FUNCTIONAL_ROWS = 24 };

/* value = sum over rows [first, first + count) of pose q + speed q' + acceleration q'' */
typedef struct dmb_functional {
    uint32_t first, count;
    double pose[DMB_FUNCTIONAL_ROWS];
    double speed[DMB_FUNCTIONAL_ROWS];
    double acceleration[DMB_FUNCTIONAL_ROWS];
} dmb_functional;

/* Displacement or rotation of a place in the axes that it has (DMB_FRAME_BODY) or of the world; by duality also the
 * rows of a unit force or moment there. copy: a sim of the state; its trial and `correction` are written.
 * Errors: those of dmb_query_motion. O(rows). */
int32_t dmb_functional_of_motion(dmb_sim *copy, dmb_place place, int32_t frame, int32_t component,
                                 dmb_functional *out);
/* A section force. copy as above. Errors: those of dmb_query_section. O(rows). */
int32_t dmb_functional_of_section(dmb_sim *copy, dmb_place place, int32_t component, dmb_functional *out);

#endif
