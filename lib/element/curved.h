/* Mass and weight of one element, curved or straight: functions of curved_mass.h with the constants of a type. d =
 * log(H_A^-1 H_B) of the element's ends is used if the element is curved. */
#ifndef DMB_ELEMENT_CURVED_H
#define DMB_ELEMENT_CURVED_H

#include "element/element_type.h"

/* Momentum p = dT/dv of both ends [kg m/s, kg m2/s]; T = (v_A.p_A + v_B.p_B)/2. */
void dmb_element_momentum(const dmb_element_type *type, const double d[6], const double va[6], const double vb[6],
                          double pa[6], double pb[6]);
/* Inertia forces on both ends [N, N m], residual side, from velocities v and their rates a. */
void dmb_element_inertia(const dmb_element_type *type, const double d[6], const double v[12], const double a[12],
                         double f[12]);
/* Weight of a curved element minus that of its straight form, which its nodes carry, as external forces on the ends [N,
 * N m]. Ra: axes of end A, world; gravity [m/s2]. 0 for a straight element. */
void dmb_element_bent_weight(const dmb_element_type *type, const double d[6], const double Ra[9],
                             const double gravity[3], double f[12]);
/* Offsets of the centre of mass from (x_A + x_B)/2, and of the centre of weight from the point at which the weight of
 * the nodes acts, axes of end A [m]. For a curved element. */
void dmb_element_bent_centre(const dmb_element_type *type, const double d[6], double mass[3], double weight[3]);

#endif
