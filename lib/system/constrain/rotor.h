/* Rotors: bodies on joints that may spin fast, integrated in axes that do not spin with them (eq:motion.rotor,
 * eq:motion.rotor-step, eq:motion.rotor-tangent).
 *
 * In its own axes the motion of a body that spins at W and precesses slowly goes round at W, so that a step makes an
 * error of (W h)^2 in the precession. Let e be the twist of a unit of spin about the axis of a rotor
 * (model/mesh_rotor), W = e_w . w0 its spin at the start of the step, O = W e, and P(t) = exp(t O). The pose is H = N
 * P(t): the axes N turn and move with the body but for the spin, and with v the velocity in the axes of the body
 *
 *     V = Ad(P) v - O,   V' = Ad(P) (v' + ad(O) v)             velocity and acceleration of N, in axes of N
 *
 * vary as slowly as the body precesses. Generalized-alpha on the Lie group acts on N, V and V' in the place of H, v and
 * v'. In the axes that P(h) leads to, z = Ad(P(h))^-1 h Dq, so that
 *
 *     start        V0 = Ad(P(h))^-1 (v0 - O),   V0' = Ad(P(h))^-1 (v0' + ad(O) v0),   A0 likewise of a0
 *     step         z = h V0 + h^2 (1/2 - beta) A0 + h^2 beta A1,   V1 = V0 + h (1 - gamma) A0 + h gamma A1
 *     end          H1 = H0 P(h) exp(z),   v1 = V1 + O,   v1' = V1' - ad(O) v1,   a1 = A1 - ad(O) v1
 *     tangent      d v1' = (mass_factor I - velocity_factor ad(O)) dz,   d v1 = velocity_factor dz,   pose T6(z) dz
 *
 * The increments of these nodes are z. A rotor of revolution in steady precession at p is then integrated with an error
 * of (p h)^2, whatever its spin, and W does not change by a rotation about the axis that goes on. Other than that all
 * is as for other nodes: constraints move z, velocity and acceleration by the same rules. */
#ifndef DMB_SYSTEM_CONSTRAIN_ROTOR_H
#define DMB_SYSTEM_CONSTRAIN_ROTOR_H

#include "system/assemble/evaluation.h"

/* Rows of rotors of the prediction; the coefficients are those of the run. */
void dmb_rotors_predict(dmb_sim *sim, const dmb_predict_args *args);
/* Their rows of a correction, which all rows have taken. */
void dmb_rotors_correct(dmb_sim *sim, const dmb_correct_args *args);
/* Their poses in the trial, H0 P(h) exp(z). */
void dmb_rotors_place(dmb_sim *sim);
/* Their turns in the trial, revolutions counted, at the end of a step. */
void dmb_rotors_unwrap(dmb_sim *sim);
/* Their accelerations where the velocity of the trial has been moved from that of `from`, row by row. */
void dmb_rotors_follow(dmb_sim *sim, const double *from);
/* Adds -velocity_factor M ad(O) to their inertia blocks. */
void dmb_rotors_matrix(const dmb_evaluation *evaluation);

/* The rotor on a node, or DMB_NONE. */
uint32_t dmb_rotor_on(const dmb_scene *scene, uint32_t node);
/* change = ad(O) dv: the accelerations v1' and a1 of a rotor become less by it when its v1 grows by dv. */
void dmb_rotor_turning(const dmb_sim *sim, uint32_t rotor, const double dv[6], double change[6]);
/* V' and A in the place of v' and a: adds ad(O) v. */
void dmb_rotor_enter(const dmb_sim *sim, uint32_t rotor, const double v[6], double acceleration[6]);
/* Wrenches on rotors at the start of the step, in the rows of their nodes, in the axes that P(h) leads to. */
void dmb_rotors_carry_wrenches(const dmb_sim *sim, double *rows);
/* The motion of V, V', A becomes that of v, v', a. */
void dmb_rotor_leave(const dmb_sim *sim, uint32_t rotor, double velocity[6], double acceleration[6],
                     double pseudo_acceleration[6]);
/* Adds the travel h O of the step under way to the increment z of a node, if it is a rotor. */
void dmb_rotor_add_travel(const dmb_sim *sim, uint32_t node, double z[6]);
/* [m, rad] Travel of a component of a six-DOF node within the step, its spin included, in its axes. */
double dmb_node_travel(const dmb_evaluation *evaluation, uint32_t node, uint32_t component);

#endif
