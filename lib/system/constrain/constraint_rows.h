/* The equations of joints, couplings, joint drives and callbacks at the trial:
 *
 *     C(q, t) = 0,   B v + rate = 0,   B v' + convective = 0,   B = dC by body-frame motion of the nodes
 *
 * into the constraint_ fields of the sim. Rows that do not act are of type DMB_ROW_IDLE and zero. */
#ifndef DMB_SYSTEM_CONSTRAIN_CONSTRAINT_ROWS_H
#define DMB_SYSTEM_CONSTRAIN_CONSTRAINT_ROWS_H

#include "system/assemble/evaluation.h"
#include "system/constrain/joint_motion.h"

/* All rows, from trial pose and trial velocity. DMB_OK, DMB_ERR_CALLBACK, DMB_ERR_NOT_FINITE. */
int32_t dmb_constraint_rows(dmb_evaluation *evaluation);
/* Derivative of B^T multiplier by body-frame displacements of a constraint's nodes, added to K, shape (columns,
 * columns). */
int32_t dmb_constraint_curvature(dmb_evaluation *evaluation, uint32_t constraint, double *K);

/* Coordinates of joint j in the trial, RX and RY on the turn that the step leads to. */
void dmb_joint_coordinates_in(const dmb_evaluation *evaluation, uint32_t j, const dmb_relative *relative,
                              dmb_joint_coordinates *coordinates);
/* Adds to K, shape (columns, columns) of the constraint: tangent of a wrench w on frame b of joint j that changes by
 * W. */
void dmb_add_joint_tangent(const dmb_scene *scene, const dmb_constraint *constraint, uint32_t j,
                           const dmb_relative *relative, const double w[6], const double W[36], double *K);
/* Rows of its kind or of its lock that joint j holds now. */
void dmb_joint_rows_now(const dmb_sim *sim, uint32_t j, const dmb_relative *relative, dmb_joint_rows *rows);
/* "joint 3 (crank)" and the like, the owner of a constraint. */
void dmb_constraint_text(const dmb_scene *scene, uint32_t constraint, dmb_message *text);
/* Constraint that a constraint row belongs to. */
uint32_t dmb_constraint_of_row(const dmb_scene *scene, uint32_t row);

/* ---- The caller's constraints: constraint_rows_callback.c -------------------------------------------------------- */

/* The caller's constraints. Derivatives that the callback does not give are built by central differences of fourth
 * order:
 *     J by places:  along each body-frame component;      rate: along time at fixed poses
 *     convective:   along the motion q exp(s v), t + s: of A v + b its first derivative, of C its second; where J is
 *                   given (J v)' + d(J v)/dt + d2C/dt2 instead, which rounding of large coordinates does not spoil
 * Steps are long: at 2 km from the origin rounding of a place is 2e-13 m, and Newton's iteration sees what it
 * becomes. */

/* Rows of a callback; and a comparison of its Jacobian with differences: DMB_ERR_CALLBACK with row and column in the
 * message of the sim. system/constrain/constraint_rows_callback */
int32_t dmb_callback_rows(dmb_evaluation *evaluation, uint32_t callback);
int32_t dmb_callback_curvature(dmb_evaluation *evaluation, uint32_t callback, double *K);
int32_t dmb_callback_check(dmb_sim *sim, uint32_t callback);

#endif
