/* Mass and weight of one element, bent or not: curved_mass.h with the constants of a type. d = log(H_A^-1 H_B) of the
 * element's ends is read where the element is bent. */
#ifndef DMB_ELEMENT_CURVED_H
#define DMB_ELEMENT_CURVED_H

#include "element/element_type.h"

/* Momentum p = dT/dv of both ends [kg m/s, kg m2/s]; T = (v_A.p_A + v_B.p_B)/2. */
void dmb_element_momentum(const dmb_element_type *type, const double d[6], const double va[6], const double vb[6],
                          double pa[6], double pb[6]);
/* Forces of inertia on both ends [N, N m], residual side, by speeds v and their rates a. */
void dmb_element_inertia(const dmb_element_type *type, const double d[6], const double v[12], const double a[12],
                         double f[12]);
/* Weight of a bent element less that of its straight form, which its nodes carry: external forces on the ends; Ra: axes
 * of end A, world; gravity [m/s2]. 0 of a straight one. */
void dmb_element_bent_weight(const dmb_element_type *type, const double d[6], const double Ra[9],
                             const double gravity[3], double f[12]);
/* Where the centres of mass and of weight are off (x_A + x_B)/2 and off the point that the nodes' weight acts at, axes
 * of end A [m]. Of a bent element. */
void dmb_element_bent_centre(const dmb_element_type *type, const double d[6], double mass[3], double weight[3]);

#endif
