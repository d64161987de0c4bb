/* Loads that grow with the factor of a path or a buckling analysis, on top of the present loads. */
#ifndef DMB_ANALYSIS_BUCKLING_LOAD_PATTERN_H
#define DMB_ANALYSIS_BUCKLING_LOAD_PATTERN_H

#include "system/assemble/evaluation.h"

typedef struct dmb_load_pattern {
    int32_t scale;  /* DMB_SCALE_... */
    uint32_t load;  /* the one load; DMB_NONE: none */
    uint32_t drive; /* the one drive; DMB_NONE: none */
    uint32_t row;   /* global row that a motion drive moves; DMB_NONE: none */
    double *base;   /* present factors of loads, bit loads and targets of drives, shape (dmb_load_pattern_size) */
} dmb_load_pattern;

/* Numbers that `base` holds. */
size_t dmb_load_pattern_size(const dmb_scene *scene);
/* Finds what `part` is. Errors, with a message that begins with `who`: DMB_ERR_ID, DMB_ERR_VALUE, DMB_ERR_UNSUPPORTED
 * (motion drives of joints). base is the caller's to set. */
int32_t dmb_load_pattern_take(dmb_sim *sim, const char *who, int32_t scale, dmb_id part, dmb_load_pattern *pattern);
/* Present loads from the trial, as dmb_system_prescribe has left it. */
void dmb_load_pattern_begin(const dmb_load_pattern *pattern, const dmb_sim *sim);
/* Loads of the trial for a factor; what a motion drive moves is a matter of the pose. */
void dmb_load_pattern_set(const dmb_load_pattern *pattern, dmb_evaluation *evaluation, double factor);
/* d residual/d factor into `derivative` (rows), after an evaluation with tangent and before the iteration matrix is
 * made of it. `residual` is the same before and after. Errors as dmb_system_evaluate. */
int32_t dmb_load_pattern_derivative(const dmb_load_pattern *pattern, dmb_evaluation *evaluation, double factor,
                                    double *derivative);

#endif
