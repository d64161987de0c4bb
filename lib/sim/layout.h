/* Memory layout of a sim in its block. Everything is derived from the lists of sim/sim.h: the size, the layout, and the
 * table of fields for snapshot, hash and tests. */
#ifndef DMB_SIM_LAYOUT_H
#define DMB_SIM_LAYOUT_H

#include "sim/sim.h"

/* Conditions on a saved field: the last word of its line in sim/sim.h. */
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
    DMB_CHECK_CLOCK = 10,
    DMB_CHECK_LEDGER = 11,
    DMB_CHECK_COUNTERS = 12,
    DMB_CHECK_REUSE = 13,       /* finite numbers in them */
    DMB_CHECK_SET_INPUTS = 14,  /* doubles within the bounds of their inputs; NaN where a time function may be */
    DMB_CHECK_EVENT_TIMES = 15, /* doubles that are finite, NaN or infinite and > 0 */
    DMB_CHECK_FRAMES = 16,      /* quaternions of length 1 or 0 */
    DMB_CHECK_PREDICTION = 17,  /* pauses as they are made */
    DMB_CHECK_AGES = 18         /* steps since touch, with the mark of sites with mean forces */
};

/* [byte] of a block of any alignment that holds a sim of the scene; SIZE_MAX if it does not fit into a size_t. O(1). */
size_t dmb_sim_bytes(const dmb_scene *scene);

/* A zeroed sim in the block, its arrays pointing into the block, each on a cache line; only scene, block and block_size
 * are set besides. NULL where the block is NULL or smaller than dmb_sim_bytes. */
dmb_sim *dmb_sim_carve(const dmb_scene *scene, void *block, size_t size);

/* Groups of fields. The first three make up the state: saved, restored and hashed. */
enum {
    DMB_GROUP_NOW = 0,
    DMB_GROUP_MEMORY = 1,
    DMB_GROUP_FACTORS = 2,
    DMB_GROUP_TRIAL = 3,
    DMB_GROUP_WORK = 4,
    DMB_GROUP_COUNT = 5
};

typedef struct dmb_field {
    const char *name;
    void *data;
    size_t bytes; /* without padding */
    int32_t group;
    int32_t check; /* DMB_CHECK_... of run/snapshot.c; -1 of work */
} dmb_field;

#define DMB_ONE_MORE(type, name, count, check) +1
#define DMB_ONE_WORK_MORE(type, name, count) +1
enum {
    DMB_FIELD_MAX = 0 DMB_CONFIGURATION_LIST(DMB_ONE_MORE) DMB_CONFIGURATION_LIST(DMB_ONE_MORE)
        DMB_MEMORY_LIST(DMB_ONE_MORE) DMB_FACTOR_LIST(DMB_ONE_MORE) DMB_WORK_LIST(DMB_ONE_WORK_MORE)
};
#undef DMB_ONE_MORE
#undef DMB_ONE_WORK_MORE

/* The fields of the groups first .. last in the order of their lists. Returns how many. The data may be written only if
 * the sim may. */
size_t dmb_sim_fields(const dmb_sim *sim, int32_t first_group, int32_t last_group, dmb_field fields[DMB_FIELD_MAX]);

/* to <- from, the whole configuration, both of the sim. sim/layout */
void dmb_configuration_copy(const dmb_sim *sim, const dmb_configuration *from, dmb_configuration *to);
/* Backup of the state while a call takes several steps, and its restoration, so that a failing call changes nothing.
 * sim/layout */
void dmb_state_back_up(dmb_sim *sim);
void dmb_state_restore(dmb_sim *sim);

#endif
