/* Stiffness of a state nearby in the frames of the present one. Body frames turn with the response of the state to its
 * loads: two matrices may only be subtracted in frames that do not, or the difference holds q' (W K - K W), W the
 * turning, which is as large as the stiffest entries: 12 EI/L^3 of short elements twisted by torque.
 *
 *     d_now = T d_trial,  T = blkdiag(Q, Q),  Q = R_now^T R_trial,      K_now = T K_trial T^T
 *
 * Rows that guides hold are held in body axes; T leaves them alone and turns those that are free among themselves. With
 * joints the reduced coordinates are rows: d = R z, z_now = W z_trial, W the independent rows of T R, and
 * A_now = W^-T A_trial W^-1. */
#ifndef DMB_ANALYSIS_BUCKLING_BUCKLING_STATE_H
#define DMB_ANALYSIS_BUCKLING_BUCKLING_STATE_H

#include "base/memory.h"
#include "sim/sim.h"

typedef struct dmb_frames {
    double *turn;    /* (values of the pattern) W^-1 of each block, where its diagonal is in the pattern */
    double *room;    /* (2, square of the largest block) */
    uint32_t *pivot; /* (rows of the largest block) */
} dmb_frames;

void dmb_frames_lay_out(dmb_arena *arena, const dmb_scene *scene, dmb_frames *frames);
/* The iteration matrix of the trial, not factored, in the chains that no joint connects. */
void dmb_frames_turn_chains(dmb_sim *sim);
/* The reduced system of the trial, just assembled. 0 where coordinates are no longer independent. */
int dmb_frames_turn_reduced(dmb_sim *sim, const dmb_frames *frames);

#endif
