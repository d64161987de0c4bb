/* Contact sites, made once by the compile step. */
#ifndef DMB_FORCE_SITE_H
#define DMB_FORCE_SITE_H

#include <stdint.h>

#include "drillmbd/model.h"

/* A ring on a FULL node that can meet the wall. */
typedef struct dmb_site {
    double offset;    /* [m] along body x from the node */
    double radius;    /* [m] of the ring */
    double clearance; /* [m] hole radius less ring radius, >= 0 */
    double length;    /* [m] of wall it stands for */
    dmb_id part;      /* string or body */
    uint32_t pipe;    /* pipe whose far end it is; UINT32_MAX: rig end; 0 for a body */
    uint32_t node;
} dmb_site;

#endif
