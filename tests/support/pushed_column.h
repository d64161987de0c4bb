/* Ten pipes without gravity or wall, clamped at the rig end or free there, pushed at the far end: what linear buckling
 * and paths of equilibrium are asked about. */
#ifndef DMB_TESTS_PUSHED_COLUMN_H
#define DMB_TESTS_PUSHED_COLUMN_H

#include "rig.h"

typedef struct pushed_column {
    rig s;
    dmb_id string, load;
    dmb_id control; /* speed controller about the axis, where the rig end is DMB_FREE_CYLINDRICAL */
} pushed_column;

typedef struct column_choice {
    int32_t start_free;             /* DMB_FREE_... */
    double push, aside;             /* [N] against the axis, and along y */
    double gravity;                 /* [m/s2] along -z */
    const dmb_allocator *allocator; /* of the sim; NULL: the default one */
} column_choice;

pushed_column column_open(const column_choice *choice);
/* Four pipes, whose load is not yet there, beside a body that nothing holds. */
pushed_column column_beside_a_free_body(void);
void column_close(pushed_column *c);
/* Fails unless the sim's last message has these words in it. */
void must_say(const rig *s, const char *words);

#endif
