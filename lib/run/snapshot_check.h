/* Is this a state of the scene? A snapshot is somebody's bytes, and its checksum can be made to fit: every index, count
 * and enumeration in it is held against the scene, and every number must be finite, before anything is restored. */
#ifndef DMB_RUN_SNAPSHOT_CHECK_H
#define DMB_RUN_SNAPSHOT_CHECK_H

#include "sim/layout.h"

/* Checks the fields as they stand in a snapshot, from `from` on, one after the other. The sim lends scratch memory and
 * takes the message. DMB_OK or DMB_ERR_VALUE. O(bytes). */
int32_t dmb_snapshot_check(dmb_sim *sim, const dmb_field *fields, size_t count, const unsigned char *from);

#endif
