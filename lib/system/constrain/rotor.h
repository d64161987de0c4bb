/* Rotors: bodies on joints that may spin fast, integrated in axes that do not spin with them (eq:motion.rotor,
 * eq:motion.rotor-step, eq:motion.rotor-tangent).
 *
 * In body axes, the motion of a body that spins at W and precesses slowly oscillates at W, which causes an error of (W
 * h)^2 in the precession per step. Let e be the twist of a unit of spin about the axis of a rotor (model/mesh_rotor),
 * W = e_w . w0 its spin at the start of the step, O = W e, and P(t) = exp(t O). The pose is H = N P(t): the axes N
 * move with the body except for the spin, and with v the velocity in body axes
 *
 *     V = Ad(P) v - O,   V' = Ad(P) (v' + ad(O) v)             velocity and acceleration of N, in axes of N
 *
 * vary as slowly as the body precesses. Generalized-alpha on the Lie group is applied to N, V and V' instead of H, v
 * and v'. In the axes reached by P(h), z = Ad(P(h))^-1 h Dq, so that
 *
 *     start        V0 = Ad(P(h))^-1 (v0 - O),   V0' = Ad(P(h))^-1 (v0' + ad(O) v0),   A0 likewise of a0
 *     step         z = h V0 + h^2 (1/2 - beta) A0 + h^2 beta A1,   V1 = V0 + h (1 - gamma) A0 + h gamma A1
 *     end          H1 = H0 P(h) exp(z),   v1 = V1 + O,   v1' = V1' - ad(O) v1,   a1 = A1 - ad(O) v1
 *     tangent      d v1' = (mass_factor I - velocity_factor ad(O)) dz,   d v1 = velocity_factor dz,   pose T6(z) dz
 *
 * The increments of these nodes are z. A rotor of revolution in steady precession at p is then integrated with an
 * error of (p h)^2, whatever its spin, and W does not change by a rotation about the axis that goes on. Constraints
 * change z, velocity and acceleration as for other nodes. */
#ifndef DMB_SYSTEM_CONSTRAIN_ROTOR_H
#define DMB_SYSTEM_CONSTRAIN_ROTOR_H

#include "system/assemble/evaluation.h"

/* Prediction of the rows of rotors; the coefficients are those of the other rows. */
void dmb_rotors_predict(dmb_sim *sim, const dmb_predict_args *args);
/* Corrects the rows of rotors after the correction of all rows. */
void dmb_rotors_correct(dmb_sim *sim, const dmb_correct_args *args);
/* Their poses in the trial, H0 P(h) exp(z). */
void dmb_rotors_place(dmb_sim *sim);
/* Their rotation angles in the trial, with revolutions, at the end of a step. */
void dmb_rotors_unwrap(dmb_sim *sim);
/* Changes their accelerations after the velocity of the trial has changed from `from`, row by row. */
void dmb_rotors_follow(dmb_sim *sim, const double *from);
/* Adds -velocity_factor M ad(O) to their inertia blocks. */
void dmb_rotors_matrix(const dmb_evaluation *evaluation);

/* The rotor on a node, or DMB_NONE. */
uint32_t dmb_rotor_on(const dmb_scene *scene, uint32_t node);
/* change = ad(O) dv, the decrease of the accelerations v1' and a1 of a rotor if its v1 grows by dv. */
void dmb_rotor_turning(const dmb_sim *sim, uint32_t rotor, const double dv[6], double change[6]);
/* Converts v' and a to V' and A: adds ad(O) v. */
void dmb_rotor_enter(const dmb_sim *sim, uint32_t rotor, const double v[6], double acceleration[6]);
/* Transforms a wrench on a rotor at the start of the step, or those in the rows of all rotors, to the axes reached by
 * P(h). */
void dmb_rotor_carry_wrench(const dmb_sim *sim, uint32_t rotor, double wrench[6]);
void dmb_rotors_carry_wrenches(const dmb_sim *sim, double *rows);
/* Converts V, V', A to v, v', a. */
void dmb_rotor_leave(const dmb_sim *sim, uint32_t rotor, double velocity[6], double acceleration[6],
                     double pseudo_acceleration[6]);
/* Adds the travel h O of the present step to the increment z of a node, if it is a rotor. */
void dmb_rotor_add_travel(const dmb_sim *sim, uint32_t node, double z[6]);
/* [m, rad] Travel of a component of a six-DOF node within the step, its spin included, in its axes. */
double dmb_node_travel(const dmb_evaluation *evaluation, uint32_t node, uint32_t component);

#endif
