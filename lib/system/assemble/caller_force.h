/* Forces that the caller's functions give by poses, speeds and time (dmb_model_add_force).
 *
 * With V the twists of the places in their axes and the speeds of the joint coordinates, V = L v by the velocities v of
 * the nodes, and w the wrenches there:
 *
 *     residual -L^T w,   K = -L^T (A L + B dV/dq) - d(L^T) w,   C = -L^T B L,   A = dw/dz, B = dw/dV
 *
 * z the displacements in the same axes. Derivatives given in the axes of the world, f = R w by dx = R z, v = R V, are
 * turned: A = R^T A_w R + R^T B_w R (z_r x V) + w x z_r, B = R^T B_w R. */
#ifndef DMB_SYSTEM_ASSEMBLE_CALLER_FORCE_H
#define DMB_SYSTEM_ASSEMBLE_CALLER_FORCE_H

#include "system/assemble/point_motion.h"

/* DMB_OK, DMB_ERR_CALLBACK: dmb_failed_force tells which. */
int32_t dmb_gather_caller_forces(dmb_evaluation *evaluation);
/* A tangent that the caller gives against differences in the state now. DMB_OK, DMB_ERR_CALLBACK with the message. */
int32_t dmb_caller_force_check(dmb_sim *sim, uint32_t force);
/* "force 2 (magnet)" of the force whose callback failed in the last evaluation, which is forgotten then; 0: none did.
 */
int dmb_failed_force(dmb_sim *sim, dmb_message *text);
/* [J] sum of the potentials that the callbacks have given. */
double dmb_caller_forces_energy(const dmb_scene *scene, const dmb_configuration *configuration);

#endif
