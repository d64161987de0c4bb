/* Eccentric pipes: where the centre of mass of each pipe of a run is. */
#ifndef DMB_MODEL_ECCENTRICITY_H
#define DMB_MODEL_ECCENTRICITY_H

#include <stdbool.h>

#include "drillmbd/model.h"

bool dmb_pipe_is_eccentric(const dmb_pipe_def *def);

/* Offset (e_y, e_z) [m] of the centre of mass of a pipe from its axis, section frame. `pipe` is its number along the
 * string: the random parts depend on it and on the seed only, so they are the same whatever the order of description.
 */
void dmb_pipe_offset(const dmb_pipe_def *def, uint32_t pipe, double e[2]);

#endif
