/* Whether a mass distribution with the inertia that the caller gives exists. */
#ifndef DMB_MODEL_INERTIA_CHECK_H
#define DMB_MODEL_INERTIA_CHECK_H

#include "base/value_check.h"
#include "drillmbd/model.h"

/* xx, yy, zz, xy, xz, yz elements at the centre of mass: positive definite, and no principal moment larger than the sum
 * of the two others. Thin rods and discs lie on that bound and pass. */
void dmb_check_inertia_matrix(dmb_check *check, const char *field, const double J[6]);
/* The same of a solid of revolution: about its axis, and across. */
void dmb_check_inertia_of_revolution(dmb_check *check, const char *field, const double J[2]);
/* A pipe as one rigid body. The rotary inertia of a flexible section belongs to beam theory and is not judged: Euler
 * and Bernoulli leave it out across and keep it about the axis. */
void dmb_check_rigid_pipe_inertia(dmb_check *check, const dmb_pipe_def *def);

#endif
