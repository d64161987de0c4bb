/* Severity over speed: one curve an order, their sum, and the bands in which it is above a threshold. */
#ifndef DMB_ANALYSIS_RESPONSE_SPEEDS_H
#define DMB_ANALYSIS_RESPONSE_SPEEDS_H

#include "drillmbd/response.h"

/* Of one order; straight between its points. */
typedef struct dmb_speeds_curve {
    double order; /* [-] */
    uint32_t count;
    uint32_t taken;   /* points that have been merged with those of other curves */
    double *speed;    /* [rad/s] ascending, shape (count) */
    double *severity; /* shape (count) */
    uint32_t *output; /* which is worst, shape (count) */
} dmb_speeds_curve;

/* Sum of the curves at a speed; *order: which of them is largest there, *output: its worst output. */
double dmb_speeds_sum(const dmb_speeds_curve *curves, uint32_t count, double speed, uint32_t *order, uint32_t *output);

/* The curves of all orders. */
typedef struct dmb_speeds_curves {
    const dmb_speeds_curve *curve; /* shape (count) */
    uint32_t count, points;
    const double *speed; /* [rad/s] points of all curves, ascending, shape (points) */
} dmb_speeds_curves;

/* The bands above the threshold, widened by the margin and joined where they meet. bands: room of them; returns how
 * many there are, more than room if they do not fit. *truncated: 1 if a band goes on below the first speed, 2 above the
 * last one, 3 both, 0 neither. */
uint32_t dmb_speeds_bands(const dmb_speeds_curves *all, const dmb_speeds_options *options, dmb_speed_band *bands,
                          uint32_t room, int32_t *truncated);

#endif
