/* Where a place of the user is in the mesh: rigid with a node, or inside an element. */
#ifndef DMB_QUERY_SPOT_H
#define DMB_QUERY_SPOT_H

#include "state.h"

#define DMB_SPOT_RIGID UINT32_MAX

typedef struct dmb_spot {
    uint32_t node;    /* the node it is rigid with; near node of the element otherwise */
    uint32_t element; /* element of a flexible or axial-torsional pipe; DMB_SPOT_RIGID on rigid pipes and bodies */
    double arm;       /* [m] along body x from the node, where `fixed` */
    double fraction;  /* [-] along the element's flexible length, 0 .. 1 */
    double beyond;    /* [m] behind the element's far end, inside the tool joint; 0 elsewhere */
    int32_t fixed;    /* 1: rigid with the node (body, rigid pipe, tool joint, end of an element) */
    int32_t reserved;
} dmb_spot;

/* Errors: DMB_ERR_ID, DMB_ERR_NOT_FINITE, DMB_ERR_VALUE (pipe or fraction outside the part). O(1). */
int32_t dmb_spot_of(const dmb_sim *sim, dmb_place place, dmb_spot *spot);

/* A string's pipe, or NULL where there is none: DMB_ERR_ID or DMB_ERR_VALUE in *status. */
const dmb_pipe_map *dmb_pipe_of(const dmb_sim *sim, dmb_id string, uint32_t pipe, int32_t *status);

/* Number of a body or bit in scene->bodies; UINT32_MAX if the id names neither. */
uint32_t dmb_body_index(const dmb_sim *sim, dmb_id id);

#endif
