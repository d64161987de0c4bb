/* Companion step of a perturbed simulation (the follower): from the increments of the nominal simulation (the leader)
 * at the same step, with a given number of corrections and no convergence test. The difference of two perturbed states
 * on either side of the nominal one gives the derivative of the state. With the tangent at the nominal solution as
 * iteration matrix, one correction leaves an error of second order in the perturbation, which is equal on both sides
 * and cancels in the difference. */
#ifndef DMB_INTEGRATOR_COMPANION_H
#define DMB_INTEGRATOR_COMPANION_H

#include "base/memory.h"
#include "integrator/trial_step.h"
#include "system/solve/solve.h"

/* Data shared by all followers of a step, computed by dmb_companion_prepare. */
typedef struct dmb_companion_workspace {
    double *opening;  /* [m, rad] increments of the leader before contacts opened, written by its owner; shape (row) */
    double *released; /* [m/s2, rad/s2] accelerations by the contacts that opened, shape (row) */
    double *product;  /* shape (row) */
    double *constrained_row; /* constrained rows of the iteration matrix: blocks of the node before, of the node and of
                                the node after; shape (constrained, 3, 6) */
    double *constrained_residual; /* [N, N m] shape (constrained) */
    dmb_block_matrix matrix;      /* iteration matrix at the end of the step, if `exact` */
    dmb_factor_set before, mass;  /* iteration matrix before contacts opened; mass matrix there */
    int32_t
        exact; /* 1: the iteration matrix is the exact derivative of the residual, so that one correction is enough */
    int32_t reserved;
} dmb_companion_workspace;

typedef struct dmb_nominal_step {
    const dmb_sim *sim;               /* the leader after its trial step, before acceptance */
    const dmb_trial_step *trial_step; /* its trial step */
    dmb_companion_workspace *workspace;
} dmb_nominal_step;

/* Arrays of the workspace; NULL pointers while counting. */
void dmb_companion_workspace_allocate(dmb_arena *arena, const dmb_scene *scene, dmb_companion_workspace *workspace);
/* Factorises the iteration matrix at the end of the leader's step in the follower, whose state equals that of the
 * leader; if contacts opened, also the matrices before the opening. DMB_ERR_SINGULAR, and errors of
 * dmb_system_evaluate. */
int32_t dmb_companion_prepare(dmb_sim *follower, const dmb_nominal_step *nominal);
/* Takes the step of the follower into its trial, memory fields included; its accepted state is unchanged. Errors as
 * above, DMB_ERR_CALLBACK. */
int32_t dmb_companion_step(dmb_sim *follower, const dmb_nominal_step *nominal);

#endif
