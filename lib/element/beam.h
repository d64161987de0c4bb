/* Flexible element in relative nodal coordinates: d = log(H_A^-1 H_B), strain (d - d0)/L, diagonal stiffness
 * (Sonneville, Cardona, Bruls 2014). Blind to rigid motion and to the number of revolutions. */
#ifndef DMB_ELEMENT_BEAM_H
#define DMB_ELEMENT_BEAM_H

#include "element/element_type.h"
#include "math/se3.h"

/* [rad] above this relative rotation in one element the logarithm is refused, well below its branch at pi. */
#define DMB_BEAM_ROTATION_MAX 2.5

/* Relative pose of the two ends and the operator that goes with it. */
typedef struct dmb_beam_shape {
    double d[6];                      /* [m, rad] log(H_A^-1 H_B) */
    dmb_so3_inverse_coefficients k;   /* of d's rotation */
    dmb_se3_inverse_tangent T;        /* T6(d)^-1; its reverse is T6(-d)^-1 */
} dmb_beam_shape;

/* Tangent blocks of an element, rows (A, B) by columns (A, B), each shape (6, 6). */
typedef struct dmb_beam_blocks {
    double aa[36], ab[36], ba[36], bb[36];
} dmb_beam_blocks;

/* Shape from the nodes' orientations, node A's rotation matrix and the vector from node A to node B [m], world frame.
 * Returns 0, or -1 when the relative rotation is above DMB_BEAM_ROTATION_MAX or not a number. */
int32_t dmb_beam_deform(const dmb_element_type *type, const double quaternion_a[4], const double rotation_a[9],
                        const double quaternion_b[4], const double span[3], dmb_beam_shape *shape);
/* Velocity of an element's end from that of its node, arm [m] along x from the node to the end; in place. */
static inline void dmb_arm_velocity(double arm, double v[6])
{
    v[1] += arm * v[5];
    v[2] -= arm * v[4];
}
/* Wrench on the node from that on the element's end; the transpose of the above. */
static inline void dmb_arm_wrench(double arm, double f[6])
{
    f[4] -= arm * f[2];
    f[5] += arm * f[1];
}
/* d' = P V [m/s, rad/s] from the velocities of the element's ends. */
void dmb_beam_strain_rate(const dmb_beam_shape *shape, const double velocity_a[6], const double velocity_b[6],
                          double rate[6]);
/* Elastic stress K (d - d0)/L [N, N m]. */
void dmb_beam_stress(const dmb_element_type *type, const double d[6], double stress[6]);
/* Internal forces g = P^T s on the element's ends (residual side), added to force_a and force_b. */
void dmb_beam_add_force(const dmb_beam_shape *shape, const double stress[6], double force_a[6], double force_b[6]);
/* d g/d pose (body-frame increments of both ends) = P^T (K/L) P + geometric part with `stress`; written to blocks. */
void dmb_beam_stiffness(const dmb_element_type *type, const dmb_beam_shape *shape, const double stress[6],
                        dmb_beam_blocks *blocks);
/* Material damping: adds the part that d' brings to the stiffness, and writes d g/d velocity times `factor`. */
void dmb_beam_damping(const dmb_element_type *type, const dmb_beam_shape *shape, const double velocity_a[6],
                      const double velocity_b[6], double factor, dmb_beam_blocks *stiffness, dmb_beam_blocks *damping);
/* Momentum p = M v of both ends [kg m/s, kg m2/s]; the same product gives M times accelerations. */
void dmb_beam_mass_times(const dmb_beam_mass *mass, const double va[6], const double vb[6], double pa[6], double pb[6]);
/* Adds mass_factor M + velocity_factor C_t to blocks, C_t = -blkdiag(v^^T) M - blkdiag(A(p)) (gyroscopic). */
void dmb_beam_add_inertia_tangent(const dmb_beam_mass *mass, const double va[6], const double vb[6], const double pa[6],
                                  const double pb[6], double mass_factor, double velocity_factor,
                                  dmb_beam_blocks *blocks);
/* One tangent block from ends to nodes: rows by the arm `left`, columns by the arm `right` [m], node to end along x. */
void dmb_beam_block_to_nodes(double left, double right, double K[36]);
/* Moves tangent blocks from the element's ends to its nodes, arms [m] along x. */
void dmb_beam_blocks_to_nodes(const double arm[2], dmb_beam_blocks *blocks);

#endif
