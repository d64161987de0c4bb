/* Contact sites by the part they belong to. */
#ifndef DMB_QUERY_SITE_H
#define DMB_QUERY_SITE_H

#include "state.h"

#define DMB_NO_SITE UINT32_MAX

/* Site, as dmb_query_contact counts them, at the far end of a string's pipe, or of a body (pipe 0); DMB_NO_SITE where
 * nothing meets the wall. part and pipe must be valid. O(log sites), on rigid stretches O(their pipes). */
uint32_t dmb_site_of(const dmb_sim *sim, dmb_id part, uint32_t pipe);

/* Site behind the first `elements` elements of a pipe; 0: at its near end. A rigid pipe has one element here. */
uint32_t dmb_site_after(const dmb_sim *sim, dmb_id string, uint32_t pipe, uint32_t elements);

/* [N] normal force of a site in the accepted state; 0 for DMB_NO_SITE. */
double dmb_site_normal_force(const dmb_sim *sim, uint32_t site);

/* [N] the same by part; 0 without a site. Errors: DMB_ERR_ID, DMB_ERR_VALUE (no such pipe). */
int32_t dmb_normal_force_at(const dmb_sim *sim, dmb_id part, uint32_t pipe, double *force);

#endif
