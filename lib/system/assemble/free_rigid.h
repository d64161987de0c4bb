/* Free rigid bodies and strings: their translation is integrated at the centre of mass, in axes that do not turn.
 *
 * In body axes m (u' + w x u) = f couples translation and rotation, and the integration of the one takes part in the
 * errors of the other: a reference point 10 m from the centre of mass drifted by 1.7 m in 100 s at 20 rad/s. With c the
 * centre of mass from the node and the axes of the node at the start of the step (E = exp(theta) turns those of the end
 * into them),
 *     W = E (u + w x c),   W' = E (u' + w' x c + w x (u + w x c)),   x1 = x0 + R0 (z + c - E c),
 * generalized-alpha is applied to (W, w) and its increments (z, theta) instead of (u, w). Then m W' = f, so that linear
 * momentum is kept to rounding, and a parabola is one. The rotation is integrated as before: angular momentum to second
 * order. Only in scenes without joints, where nothing holds or leads the part. */
#ifndef DMB_SYSTEM_ASSEMBLE_FREE_RIGID_H
#define DMB_SYSTEM_ASSEMBLE_FREE_RIGID_H

#include "kernel/kernels.h"
#include "system/assemble/evaluation.h"

/* Their rows of the prediction; the coefficients are those of the run. */
void dmb_free_rigids_predict(dmb_sim *sim, const dmb_predict_job *job);
/* Their rows of a correction. */
void dmb_free_rigids_correct(dmb_sim *sim, const dmb_correct_job *job);
/* Pose, speeds and accelerations of the trial from what was predicted and corrected. */
void dmb_free_rigids_place(dmb_sim *sim);
/* Their blocks of the iteration matrix. */
void dmb_free_rigids_matrix(const dmb_evaluation *evaluation);
/* From the 6-vectors of a body: velocity, acceleration, pseudo-acceleration of now to those of its centre of mass,
 * shape (3, 6) each; and an acceleration that is added to those, shape (6). */
void dmb_free_rigid_start(const dmb_sim *sim, uint32_t rigid, double start[18]);
void dmb_free_rigid_added(const dmb_scene *scene, uint32_t rigid, double acceleration[6]);
/* Unknowns of the iteration: velocity, acceleration, pseudo-acceleration, shape (3, 6). */
static inline double *dmb_free_rigid_motion(const dmb_sim *sim, uint32_t rigid)
{
    return sim->rigid_motion + 18 * (size_t)rigid;
}

#endif
