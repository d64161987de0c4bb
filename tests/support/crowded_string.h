/* A string with rings, contact points along its elements, a stuck place and mud at once. */
#ifndef DMB_TESTS_CROWDED_STRING_H
#define DMB_TESTS_CROWDED_STRING_H

#include "rig.h"

typedef struct crowded_string {
    double mu, stiffness, ring_diameter, inner_density; /* [-, N/m, m, kg/m3] its parameters */
    dmb_id string, ring, stuck, drive;                  /* made by add_crowded_string */
} crowded_string;

crowded_string crowded_string_default(void);
/* Into an empty model; its rig end turns under a controller and is held along the hole, its far end is stuck. */
void add_crowded_string(rig *s, crowded_string *c);

#endif
