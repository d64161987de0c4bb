/* An answer as a linear function of the motion of the nodes about a state: what a query would answer to a small motion
 * q, q', q'' of the rows. */
#ifndef DMB_ANALYSIS_LINEAR_FUNCTIONAL_H
#define DMB_ANALYSIS_LINEAR_FUNCTIONAL_H

#include "drillmbd/response.h"
#include "sim/sim.h"

/* Four neighbouring nodes: the two of an element and one on either side. */
enum { DMB_FUNCTIONAL_ROWS = 24 };

/* value = sum over the rows of pose q + speed q' + acceleration q'' */
typedef struct dmb_functional {
    uint32_t count;
    uint32_t row[DMB_FUNCTIONAL_ROWS];
    double pose[DMB_FUNCTIONAL_ROWS];
    double speed[DMB_FUNCTIONAL_ROWS];
    double acceleration[DMB_FUNCTIONAL_ROWS];
} dmb_functional;

/* Displacement or rotation of a place in the axes that it has (DMB_FRAME_BODY) or of the world; by duality also the
 * rows of a unit force or moment there. copy: a sim of the state; its trial is written.
 * Errors: those of dmb_query_motion. O(rows). */
int32_t dmb_functional_of_motion(dmb_sim *copy, dmb_place place, int32_t frame, int32_t component, dmb_functional *out);

/* Rows of the nodes around a place: the node or the two nodes it follows, and one more on either side, and no numbers.
 * copy and errors as above. */
int32_t dmb_functional_around(dmb_sim *copy, dmb_place place, dmb_functional *out);
/* Takes the rows of one more node in; DMB_NONE is none. */
void dmb_functional_take_node(const dmb_scene *scene, uint32_t node, dmb_functional *out);
/* An answer that depends on the nodes in `out` alone, smooth in their poses, linear in their accelerations and at most
 * of second degree in their speeds. copy: a sim of the state, as before on return. */
typedef double dmb_answer(const dmb_sim *copy, const void *what);
void dmb_functional_of_answer(dmb_sim *copy, dmb_answer *answer, const void *what, dmb_functional *out);
/* Speeds and accelerations taken so far are those in the body frame of the moved nodes: what turning them adds. */
void dmb_functional_turn_frames(const dmb_sim *copy, dmb_functional *out);
/* to += factor from, of the same rows. */
void dmb_functional_add(double factor, const dmb_functional *from, dmb_functional *to);
/* Its rate: what was by pose is by speed. */
void dmb_functional_add_rate(double factor, const dmb_functional *from, dmb_functional *to);

/* Answers of the queries now, for outputs of a response. */

/* The value of an output of any kind but DMB_OUTPUT_DISPLACEMENT, which depends on where it is counted from. *status:
 * errors of the query. */
double dmb_answer_of(const dmb_sim *sim, const dmb_output *output, int32_t *status);

#endif
