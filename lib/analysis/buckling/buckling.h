/* A buckling analysis while it runs. */
#ifndef DMB_ANALYSIS_BUCKLING_BUCKLING_H
#define DMB_ANALYSIS_BUCKLING_BUCKLING_H

#include "analysis/buckling/path.h"
#include "analysis/buckling/pencil.h"
#include "analysis/static/static.h"
#include "base/memory.h"
#include "sim/sim.h"

/* Stiffness of a state nearby in the frames of the present one. Body frames turn with the response of the state to its
 * loads: two matrices may only be subtracted in frames that do not, or the difference holds q' (W K - K W), W the
 * turning, which is as large as the stiffest entries: 12 EI/L^3 of short elements twisted by torque.
 *
 *     d_now = T d_trial,  T = blkdiag(Q, Q),  Q = R_now^T R_trial,      K_now = T K_trial T^T
 *
 * Rows that guides hold are held in body axes; T leaves them alone and turns those that are free among themselves. With
 * joints the reduced coordinates are rows: d = R z, z_now = W z_trial, W the independent rows of T R, and
 * A_now = W^-T A_trial W^-1. */

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

/* options.factor_max as it is by default: far beyond all loads. */
#define DMB_FACTOR_MAX 1e12

struct dmb_buckling {
    uint32_t magic;
    uint32_t count; /* factors found */
    dmb_allocator allocator;
    dmb_sim *work; /* a copy of the sim in the state that is linearised, for shapes as its velocities */
    double at;     /* [unit of the factor] where on the path of equilibria that state is */
    dmb_buckling_info info;
    void *block;
    size_t block_size;
    double *factor;   /* (count) */
    double *first;    /* (count) the factors that the present state alone told; infinite: not told */
    double *vector;   /* (count, unknowns of the pencil) */
    double *shape;    /* (count, rows) body-frame displacements of the nodes; without joints it is the vector */
    double *response; /* (rows) of the state to the pattern */
    dmb_load_pattern pattern;
    dmb_pencil pencil;
    dmb_frames frames;
};

/* Body-frame displacements of the nodes, shape (rows), that a vector of the pencil stands for. */
void dmb_buckling_expand(dmb_buckling *buckling, const double *vector, double *shape);
/* K and G of the state in `work`, at the factor `at`. Errors, with a message in sim: DMB_ERR_ORDER (no stable
 * equilibrium), _SINGULAR. */
int32_t dmb_buckling_linearise(dmb_buckling *buckling, dmb_sim *sim, const dmb_buckling_options *options);
/* Factors and shapes of K and G, rising; DMB_NOTE_STOPPED where there are fewer than asked for. */
int32_t dmb_buckling_find(dmb_buckling *buckling, const dmb_buckling_options *options, dmb_message *message);
/* Status of the whole, with a message in sim, where a mode grows on the way (DMB_NOTE_FLUTTER) or that was not judged
 * (DMB_NOTE_INCOMPLETE); else `status`. `why`: of modes that could not be found. */
int32_t dmb_buckling_tell_flutter(const dmb_buckling *buckling, dmb_sim *sim, const dmb_message *why, int32_t status);
/* Along the equilibria from the present state to the first factor at which they lose their stability, and the factors
 * once more from there. Status as of dmb_analysis_buckling. */
int32_t dmb_buckling_follow(dmb_buckling *buckling, dmb_sim *sim, const dmb_buckling_options *options);

#endif
