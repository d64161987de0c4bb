/* Unbalance of the rigid masses on the nodes. */
#ifndef DMB_SYSTEM_UNBALANCE_H
#define DMB_SYSTEM_UNBALANCE_H

#include "model/scene.h"

/* Body-frame wrench [N s2, N m s2] of lump number i on its FULL node for unit spin about the node's axis, per square of
 * the spin: the centrifugal force of an eccentric centre of mass and the couple of its products of inertia. */
void dmb_unbalance_of_lump(const dmb_scene *scene, uint32_t i, double wrench[6]);

#endif
