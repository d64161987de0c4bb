/* The flexible element, one at a time: functions of beam_math.h with the constants of a type. */
#ifndef DMB_ELEMENT_BEAM_H
#define DMB_ELEMENT_BEAM_H

#include "element/beam_math.h"
#include "element/element_type.h"
#include "element/section_math.h"

/* Computes the shape from the orientations of the nodes, node A's rotation matrix and the vector from node A to node B
 * [m], world frame. Returns 0, or -1 if the relative rotation is above DMB_BEAM_ROTATION_MAX or not a number. */
int32_t dmb_beam_deform(const dmb_element_type *type, const double quaternion_a[4], const double rotation_a[9],
                        const double quaternion_b[4], const double span[3], dmb_beam_shape *shape);
/* Strain e and elastic stress (K/L) e [m, rad], [N, N m]. */
void dmb_beam_strain_of(const dmb_element_type *type, const dmb_beam_shape *shape, double e[6]);
void dmb_beam_stress(const dmb_element_type *type, const dmb_beam_shape *shape, double stress[6]);
/* e.X e with X the off-diagonal entries of K/L; 0 for elements with a straight unstressed shape. */
double dmb_beam_cross_energy(const dmb_element_type *type, const double e[6]);
/* (K/L) e for a strain or its rate. */
void dmb_beam_stiffness_times(const dmb_element_type *type, const double e[6], double stress[6]);
/* e_x [m] from d alone. */
double dmb_beam_stretch(const dmb_element_type *type, const double d[6]);
/* Momentum p = M v of both ends [kg m/s, kg m2/s]; the same product gives M times accelerations. */
void dmb_beam_mass_times(const dmb_beam_mass *mass, const double va[6], const double vb[6], double pa[6], double pb[6]);

/* Sections inside the element (element/section_math.h). */

/* Computes the shape at fraction x; bending 0 omits c (axial-torsional elements). */
void dmb_section_shape_at(const dmb_element_type *type, double x, int bending, dmb_section_shape *shape);

/* Pose of a section relative to the element's nodes, and its twist as a function of theirs, for forces that act inside
 * an element. R_a, R_b: axes of the nodes in the world; span: from node a to node b, world. */

/* d = log(H_A^-1 H_B) of the flexible ends. */
void dmb_section_ends(const dmb_element_type *type, const double Ra[9], const double Rb[9], const double span[3],
                      double d[6]);
/* Rotation Q of the section and its position r [m] in the frame of node a. */
void dmb_section_pose(const dmb_element_type *type, const dmb_section_shape *shape, const double d[6], double Q[9],
                      double r[3]);
/* Exact map from the body-frame velocities of the nodes to d' of the ends, shape (6, 12). */
void dmb_section_strain_map(const dmb_element_type *type, const double d[6], double map[72]);
/* Exact map from the body-frame velocities of the nodes to that of the section, shape (6, 12). */
void dmb_section_map(const dmb_element_type *type, const dmb_section_shape *shape, const double d[6], double map[72]);
/* K, shape (12, 12): change of map^T w by body-frame displacements of the nodes, for a wrench w that is constant in the
 * axes of the section. */
void dmb_section_map_tangent(const dmb_element_type *type, const dmb_section_shape *shape, const double d[6],
                             const double w[6], double K[144]);

#endif
