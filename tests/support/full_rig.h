/* Strings with everything on, stiffnesses and forces of one size so that no term of a tangent hides behind another, and
 * put into a state in the middle of a motion. For the tests of lib/system. */
#ifndef DMB_TESTS_FULL_RIG_H
#define DMB_TESTS_FULL_RIG_H

#include "rig.h"

typedef struct full_rig_choice {
    int32_t friction_law; /* DMB_FRICTION_... */
    int32_t normal_law;   /* DMB_NORMAL_... */
    int32_t rock_law;     /* DMB_ROCK_... */
    int32_t curved;       /* 1: the hole bends */
    int32_t ledger;       /* 1: with the energy ledger */
    int32_t rings_only;   /* 1: no axial-torsional pipes, no loads in the frame of the hole, no bottom-hole load */
    int32_t sections; /* bit 0: every constant of the wall changes along the hole; bit 1: contact along the pipes; bit
                         2: mud flows; bit 3: mud has inertia */
} full_rig_choice;

/* Rig head - flexible pipe in 2 elements with tool joint - 2 axial-torsional pipes - flexible pipe - rigid pipe -
 * flexible pipe - bit, in a hole; loads in all frames on several parts, control and load drives, damping, eccentric
 * pipes; and a free body of its own that touches the wall. */
void full_rig_open(rig *s, const full_rig_choice *choice);

#endif
