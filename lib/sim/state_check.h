/* Is this a state of the scene? A snapshot is somebody's bytes, and its checksum can be made to fit: every index, count and
 * enumeration in it is held against the scene, and every number must be finite, before anything is restored. */
#ifndef DMB_SIM_STATE_CHECK_H
#define DMB_SIM_STATE_CHECK_H

#include "sim/layout.h"

/* What a saved field must be, the last word of its line in sim/sim.h. */
enum {
    DMB_CHECK_NUMBERS = 0,        /* finite doubles; all others are not of doubles alone, but for INPUTS */
    DMB_CHECK_INPUTS = 1,         /* doubles within what dmb_sim_set_drive takes, or NaN */
    DMB_CHECK_FLAGS = 2,          /* 0 or 1 */
    DMB_CHECK_SEGMENTS = 3,       /* below the number of stations of the hole; 0 where it is straight */
    DMB_CHECK_JOINT_SEGMENTS = 4, /* the same, with the mark of joints that are held on the axis */
    DMB_CHECK_JOINT_STATES = 5,   /* DMB_JOINT_... */
    DMB_CHECK_RANKS = 6,          /* at most the rows and columns of the cluster */
    DMB_CHECK_ROW_ORDER = 7,      /* each row of a cluster once */
    DMB_CHECK_COLUMN_ORDER = 8,   /* each column of a cluster once */
    DMB_CHECK_HISTORY_HEADS = 9,  /* within the samples of the bit */
    DMB_CHECK_CLOCK = 10, DMB_CHECK_LEDGER = 11, DMB_CHECK_COUNTERS = 12, DMB_CHECK_KEPT = 13 /* finite numbers in them */
};

/* Checks the fields as they stand in a snapshot, from `from` on, one after the other. The sim lends scratch memory and
 * takes the message. DMB_OK or DMB_ERR_VALUE. O(bytes). */
int32_t dmb_snapshot_check(dmb_sim *sim, const dmb_field *fields, size_t count, const unsigned char *from);

#endif
