/* Sets of free components of motion. */
#ifndef DMB_MODEL_MOTION_MASK_H
#define DMB_MODEL_MOTION_MASK_H

#include <stdbool.h>

#include "base/check.h"
#include "drillmbd/model.h"

enum {
    DMB_FREE_TRANSLATIONS = 1 << DMB_X | 1 << DMB_Y | 1 << DMB_Z,
    DMB_FREE_SIDEWAYS = 1 << DMB_Y | 1 << DMB_Z,
    DMB_FREE_TILTING = 1 << DMB_RY | 1 << DMB_RZ
};

/* True if the set is closed under motion (a group of displacements), so that it means the same at every instant: none,
 * all, one component, cylindrical pair, three rotations, three translations, planar motion. Herve 1978. */
static inline bool dmb_mask_is_closed(int32_t mask)
{
    switch (mask) {
    case DMB_FREE_NONE:
    case DMB_FREE_ALL:
    case DMB_FREE_CYLINDRICAL:
    case DMB_FREE_SPHERICAL:
    case DMB_FREE_TRANSLATIONS:
    case 1 << DMB_Y | 1 << DMB_Z | 1 << DMB_RX:
    case 1 << DMB_X | 1 << DMB_Z | 1 << DMB_RY:
    case 1 << DMB_X | 1 << DMB_Y | 1 << DMB_RZ: return true;
    default: return mask > 0 && mask < 64 && (mask & (mask - 1)) == 0;
    }
}

/* True if the set means the same at any point of the body's x axis, so that a node anywhere on it will do. */
static inline bool dmb_mask_is_axial(int32_t mask)
{
    return mask == DMB_FREE_ALL || (mask & ~DMB_FREE_CYLINDRICAL) == 0;
}

/* DMB_ERR_VALUE for a mask with other bits than the six components, DMB_ERR_UNSUPPORTED for one that is not closed. */
void dmb_check_motion_mask(dmb_check *check, const char *field, int32_t mask);

#endif
