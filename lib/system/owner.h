/* Which described part a node or element belongs to, for messages. */
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

#endif
