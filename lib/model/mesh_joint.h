/* Places of parts that move rigidly with a node. */
#ifndef DMB_MODEL_MESH_JOINT_H
#define DMB_MODEL_MESH_JOINT_H

#include "model/mesh.h"

typedef struct dmb_mesh_place {
    uint32_t node;
    double arm; /* [m] along body x from the node */
} dmb_mesh_place;

/* A body, a bit, any place of a rigid pipe, and of an elastic one its ends, its tool joint and the ends of its elements
 * (within 1e-9 of the pipe). False elsewhere. The pipe has to be there. */
bool dmb_mesh_place_of(const dmb_mesh *mesh, const dmb_place *place, dmb_mesh_place *found);

#endif
