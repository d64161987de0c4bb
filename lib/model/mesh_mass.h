/* Rigid masses of nodes: bodies added to a spatial inertia, and pipes whose centre of mass is off their axis. */
#ifndef DMB_MODEL_MESH_MASS_H
#define DMB_MODEL_MESH_MASS_H

#include <stdbool.h>

#include "drillmbd/model.h"
#include "element/element_type.h"

/* Adds a body of that mass [kg], centre [m] from the node and inertia [kg m2] xx, yy, zz, xy, xz, yz at its centre. */
void dmb_rigid_mass_add(dmb_rigid_mass *rigid_mass, double mass, const double centre[3], const double inertia[6]);

/* Moves a mass [kg] that is already counted at (x, 0, 0) [m] to (x, e_y, e_z): the node gains a first moment and
 * inertia, but no mass. */
void dmb_rigid_mass_shift(dmb_rigid_mass *rigid_mass, double mass, double x, const double e[2]);

/* Eccentric pipes: where the centre of mass of each pipe of a run is. */

bool dmb_pipe_is_eccentric(const dmb_pipe_def *def);

/* Offset (e_y, e_z) [m] of the centre of mass of a pipe from its axis, section frame. `pipe` is its number along the
 * string: the random parts depend on it and on the seed only, so they are the same whatever the order of description.
 */
void dmb_pipe_offset(const dmb_pipe_def *def, uint32_t pipe, double e[2]);

#endif
