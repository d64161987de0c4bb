/* The flexible element, one at a time: beam_math.h with the constants of a type. */
#ifndef DMB_ELEMENT_BEAM_H
#define DMB_ELEMENT_BEAM_H

#include "element/beam_math.h"

/* Shape from the nodes' orientations, node A's rotation matrix and the vector from node A to node B [m], world frame.
 * Returns 0, or -1 when the relative rotation is above DMB_BEAM_ROTATION_MAX or not a number. */
int32_t dmb_beam_deform(const dmb_element_type *type, const double quaternion_a[4], const double rotation_a[9],
                        const double quaternion_b[4], const double span[3], dmb_beam_shape *shape);
/* Strain e and elastic stress (K/L) e [m, rad], [N, N m]. */
void dmb_beam_strain_of(const dmb_element_type *type, const dmb_beam_shape *shape, double e[6]);
void dmb_beam_stress(const dmb_element_type *type, const dmb_beam_shape *shape, double stress[6]);
/* e_x [m] from d alone. */
double dmb_beam_stretch(const dmb_element_type *type, const double d[6]);
/* Momentum p = M v of both ends [kg m/s, kg m2/s]; the same product gives M times accelerations. */
void dmb_beam_mass_times(const dmb_beam_mass *mass, const double va[6], const double vb[6], double pa[6], double pb[6]);

#endif
