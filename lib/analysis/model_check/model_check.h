/* Findings of the model check, before they are answered as a struct or as text. */
#ifndef DMB_ANALYSIS_MODEL_CHECK_MODEL_CHECK_H
#define DMB_ANALYSIS_MODEL_CHECK_MODEL_CHECK_H

#include "drillmbd/analysis.h"
#include "sim/sim.h"
#include "system/constrain/constrain.h"

/* Groups of parts that joints connect and nothing holds. */
typedef struct dmb_loose_parts {
    uint32_t groups;
    uint32_t node; /* first node of the first group */
} dmb_loose_parts;

typedef struct dmb_model_check {
    const dmb_sim *sim;
    dmb_cluster_rank rank; /* holds memory */
    dmb_loose_parts loose;
    dmb_check_report report;
} dmb_model_check;

/* Takes the findings of a sim, report and all; the sim is busy until they are closed. Errors: as dmb_analysis_check;
 * nothing is held then. */
int32_t dmb_model_check_open(const dmb_sim *sim, dmb_model_check *findings);
void dmb_model_check_close(dmb_model_check *findings);

/* Parts on which gravity acts and no support, drive, joint with the ground, spring, wall or rock. DMB_ERR_NO_MEMORY. */
int32_t dmb_find_loose_parts(const dmb_sim *sim, dmb_loose_parts *loose);

/* Elements of the state by their mass, bars on the hole's axis left out. */
typedef struct dmb_bent_elements {
    uint32_t following, constant; /* elements with the mass of bent ones, with that of straight ones */
    uint32_t beyond;              /* of the latter, bent by more than DMB_CURVED_BEND */
    uint32_t node;                /* the first one of the element with the constant mass that is bent most */
    double bend, error;           /* [rad] of it, [-] bound of the error of its momentum */
} dmb_bent_elements;
dmb_bent_elements dmb_find_bent(const dmb_sim *sim);

/* Calls `line` with each warning, without end of line. */
typedef void (*dmb_model_check_line_fn)(void *context, const char *text);
void dmb_model_check_warnings(const dmb_model_check *findings, dmb_model_check_line_fn line, void *context);
/* Those of pipes whose elements are too long for the bending stress of a string that lies on the wall. */
void dmb_mesh_warnings(const dmb_model *model, dmb_model_check_line_fn line, void *context);

#endif
