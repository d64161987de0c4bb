/* Findings of the model check, before output as a struct or as text. */
#ifndef DMB_ANALYSIS_MODEL_CHECK_MODEL_CHECK_H
#define DMB_ANALYSIS_MODEL_CHECK_MODEL_CHECK_H

#include "drillmbd/analyse.h"
#include "sim/sim.h"
#include "system/constrain/constrain.h"

/* Groups of jointly connected parts without support. */
typedef struct dmb_unconstrained_parts {
    uint32_t groups;
    uint32_t node; /* first node of the first group */
} dmb_unconstrained_parts;

typedef struct dmb_model_check {
    const dmb_sim *sim;
    dmb_cluster_rank rank; /* owns memory */
    dmb_unconstrained_parts unconstrained;
    dmb_check_report report;
} dmb_model_check;

/* Computes the findings of a sim with its report; the sim is busy until they are closed. Errors: as dmb_analysis_check;
 * no memory is kept after an error. */
int32_t dmb_model_check_open(const dmb_sim *sim, dmb_model_check *findings);
void dmb_model_check_close(dmb_model_check *findings);

/* Parts under gravity without support, drive, joint with the ground, spring, wall or rock. DMB_ERR_NO_MEMORY. */
int32_t dmb_find_unconstrained_parts(const dmb_sim *sim, dmb_unconstrained_parts *unconstrained);

/* Elements of the state by their mass, without axial-torsional elements. */
typedef struct dmb_bent_elements {
    uint32_t following, constant; /* with the mass of bent elements, with that of straight ones */
    uint32_t beyond;              /* number of the latter with a bend above DMB_CURVED_BEND */
    uint32_t node;                /* first node of the element of constant mass with the largest bend */
    double bend, error;           /* [rad] its bend, [-] bound of the error of its momentum */
} dmb_bent_elements;
dmb_bent_elements dmb_find_bent(const dmb_sim *sim);

/* Receives each warning, without end of line. */
typedef void (*dmb_model_check_line_fn)(void *context, const char *text);
void dmb_model_check_warnings(const dmb_model_check *findings, dmb_model_check_line_fn line, void *context);
/* Warnings of values that are usual in another unit, or that no pipe, hole and mud has. */
void dmb_unusual_values(const dmb_sim *sim, dmb_model_check_line_fn line, void *context);
/* Warnings of pipes whose elements are too long for the bending stress of a string that lies on the wall. */
void dmb_mesh_warnings(const dmb_model *model, dmb_model_check_line_fn line, void *context);

#endif
