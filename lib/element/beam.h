/* The flexible element, one at a time: beam_math.h with the constants of a type. */
#ifndef DMB_ELEMENT_BEAM_H
#define DMB_ELEMENT_BEAM_H

#include "element/beam_math.h"

/* Shape from the nodes' orientations, node A's rotation matrix and the vector from node A to node B [m], world frame.
 * Returns 0, or -1 when the relative rotation is above DMB_BEAM_ROTATION_MAX or not a number. */
int32_t dmb_beam_deform(const dmb_element_type *type, const double quaternion_a[4], const double rotation_a[9],
                        const double quaternion_b[4], const double span[3], dmb_beam_shape *shape);
/* Elastic stress K (d - d0)/L [N, N m]. */
void dmb_beam_stress(const dmb_element_type *type, const double d[6], double stress[6]);
/* d g/d pose (body-frame increments of both ends) = P^T (K/L) P + geometric part with `stress`; written to blocks. */
void dmb_beam_stiffness(const dmb_element_type *type, const dmb_beam_shape *shape, const double stress[6],
                        dmb_beam_blocks *blocks);
/* Material damping: adds the part that d' brings to the stiffness, and writes d g/d velocity times `factor`. */
void dmb_beam_damping(const dmb_element_type *type, const dmb_beam_shape *shape, const double velocity_a[6],
                      const double velocity_b[6], double factor, dmb_beam_blocks *stiffness, dmb_beam_blocks *damping);
/* Momentum p = M v of both ends [kg m/s, kg m2/s]; the same product gives M times accelerations. */
void dmb_beam_mass_times(const dmb_beam_mass *mass, const double va[6], const double vb[6], double pa[6],
                         double pb[6]);
/* Adds mass_factor M + velocity_factor C_t to blocks, C_t = -blkdiag(v^^T) M - blkdiag(A(p)) (gyroscopic). */
void dmb_beam_add_inertia_tangent(const dmb_beam_mass *mass, const double va[6], const double vb[6],
                                  const double pa[6], const double pb[6], double mass_factor, double velocity_factor,
                                  dmb_beam_blocks *blocks);

#endif
