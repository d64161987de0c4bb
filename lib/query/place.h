/* Places of the user in the mesh: rigid with a node or inside an element; pipes, bodies and contact sites by number. */
#ifndef DMB_QUERY_PLACE_H
#define DMB_QUERY_PLACE_H

#include "model/model.h"
#include "sim/sim.h"

typedef struct dmb_material_point {
    uint32_t node;    /* the node it is rigid with; near node of the element otherwise */
    uint32_t element; /* element of a flexible or axial-torsional pipe; DMB_NONE on rigid pipes and bodies */
    double arm;       /* [m] along body x from the node, where `fixed` */
    double fraction;  /* [-] along the element's flexible length, 0 .. 1 */
    double beyond;    /* [m] behind the element's far end, inside the tool joint; 0 elsewhere */
    int32_t fixed;    /* 1: rigid with the node (body, rigid pipe, tool joint, end of an element) */
    int32_t reserved;
} dmb_material_point;

/* Errors: DMB_ERR_ID, DMB_ERR_NOT_FINITE, DMB_ERR_VALUE (pipe or fraction outside the part). O(1). */
int32_t dmb_material_point_of(const dmb_sim *sim, dmb_place place, dmb_material_point *point);

/* A string's pipe, or NULL where there is none: DMB_ERR_ID or DMB_ERR_VALUE in *status. */
const dmb_pipe_map *dmb_pipe_of(const dmb_sim *sim, dmb_id string, uint32_t pipe, int32_t *status);

/* Number of a body or bit in scene->bodies; DMB_NONE if the id names neither. */
uint32_t dmb_body_index(const dmb_sim *sim, dmb_id id);

/* The description behind a pipe of a compiled string. */

/* The call of dmb_model_add_pipes that made a pipe; NULL if there is none. O(number of such calls). */
const dmb_pipe_run *dmb_pipe_run_of(const dmb_model *model, uint32_t string, uint32_t pipe);

/* Contact sites by the part they belong to. */

/* Site, as dmb_query_contact counts them, at the far end of a string's pipe, or of a body (pipe 0); DMB_NONE where
 * nothing meets the wall. part and pipe must be valid. O(log sites), on rigid stretches O(their pipes). */
uint32_t dmb_site_of(const dmb_sim *sim, dmb_id part, uint32_t pipe);

/* Site behind the first `elements` elements of a pipe; 0: at its near end. A rigid pipe has one element here. */
uint32_t dmb_site_after(const dmb_sim *sim, dmb_id string, uint32_t pipe, uint32_t elements);

/* [N] normal force of a site in the accepted state; 0 for DMB_NONE. */
double dmb_site_normal_force(const dmb_sim *sim, uint32_t site);

/* [N] the same by part; 0 without a site. Errors: DMB_ERR_ID, DMB_ERR_VALUE (no such pipe). */
int32_t dmb_normal_force_at(const dmb_sim *sim, dmb_id part, uint32_t pipe, double *force);

#endif
