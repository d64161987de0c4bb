/* What belongs to what: nodes and elements to described parts (for messages), rows to nodes, constraints to parts. */
#ifndef DMB_SYSTEM_OWNER_H
#define DMB_SYSTEM_OWNER_H

#include "state.h"

typedef struct dmb_owner {
    const char *kind; /* "string" or "body" */
    uint32_t index;
    uint32_t pipe;    /* 0 for a body */
} dmb_owner;

dmb_owner dmb_owner_of_node(const dmb_scene *scene, uint32_t node);
dmb_owner dmb_owner_of_element(const dmb_scene *scene, uint32_t element);
/* Node that a row belongs to. O(log nodes) */
uint32_t dmb_node_of_row(const dmb_scene *scene, uint32_t row);
/* Constraint of a joint, coupling, drive or callback; UINT32_MAX where the part has none. */
uint32_t dmb_constraint_of_part(const dmb_sim *sim, dmb_id part);

#endif
