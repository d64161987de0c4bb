/* A step beside a step: a sim that differs a little from a leader takes the step that the leader has tried, from the
 * leader's increments, with as many corrections as are asked for and no judgement of convergence. Both states on two
 * sides of the leader's give its derivative by their difference: with the tangent of the leader's own solution as
 * iteration matrix, one correction is off by second order, the same on both sides. */
#ifndef DMB_INTEGRATOR_COMPANION_H
#define DMB_INTEGRATOR_COMPANION_H

#include "base/memory.h"
#include "integrator/trial_step.h"
#include "system/solve/solve.h"

/* Data that all followers of a step share, made by dmb_companion_prepare. */
typedef struct dmb_companion_workspace {
    double *opening;              /* [m, rad] of the leader before contacts opened, written by its owner; shape (row) */
    double *released;             /* [m/s2, rad/s2] what the contacts that opened did there, shape (row) */
    double *product;              /* shape (row) */
    double *constrained_row;      /* rows of the iteration matrix that are held: of the node before, its own, after;
                              shape (held, 3, 6) */
    double *constrained_residual; /* [N, N m] shape (held) */
    dmb_block_matrix matrix;      /* iteration matrix at the end of the step, where it is exact */
    dmb_factor_set before, mass;  /* iteration matrix before contacts opened; mass matrix there */
    int32_t exact;                /* 1: the iteration matrix is the derivative of the residual, one correction does */
    int32_t reserved;
} dmb_companion_workspace;

typedef struct dmb_nominal_step {
    const dmb_sim *sim;               /* the leader, its step tried and not accepted */
    const dmb_trial_step *trial_step; /* that step */
    dmb_companion_workspace *workspace;
} dmb_nominal_step;

/* Arrays of the room; NULL pointers while counting. */
void dmb_companion_workspace_allocate(dmb_arena *arena, const dmb_scene *scene, dmb_companion_workspace *workspace);
/* Factors of the iteration matrix at the end of the leader's step into the follower, which stands where the leader
 * stands; where contacts opened, those before that too. DMB_ERR_SINGULAR, and as dmb_system_evaluate. */
int32_t dmb_companion_prepare(dmb_sim *follower, const dmb_nominal_step *nominal);
/* The step of the follower, with its memory, into its trial; its state now stays. Errors as above, DMB_ERR_CALLBACK. */
int32_t dmb_companion_step(dmb_sim *follower, const dmb_nominal_step *nominal);

#endif
