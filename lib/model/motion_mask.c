#include "model/motion_mask.h"

void dmb_check_motion_mask(dmb_check *check, const char *field, int32_t mask)
{
    dmb_check_mask(check, field, mask, DMB_FREE_ALL);
    if (dmb_mask_is_closed(mask)) return;
    dmb_check_fail(check, DMB_ERR_UNSUPPORTED, field, mask,
                   "closed under motion: none, all, one, axial and spin, spherical, translations or planar");
}
