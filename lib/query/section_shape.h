/* The pose of a section inside an element, seen from the element's end A:
 *
 *     H(x) = exp(x d) exp(c(x) d),   x = 0 at A .. 1 at B,   d = log(H_A^-1 H_B)
 *
 * exp(x d) is the element's own helix, exact for any uniform strain (Sonneville, Cardona, Bruls 2014). It spreads the
 * sideways part of d evenly; c puts it onto the S of the Timoshenko cubic shapes N3, G3 (THEORY 3), which is where the
 * shear force of the corrected stiffness 1/GA* = 1/GA + L^2/(12 EI) belongs. To first order in the bending of the
 * element the two together are the shapes N1 .. N4, G1 .. G4 about the frame in the middle, so that a beam loaded at
 * its nodes is exact in between. c is 0 at both ends: nodes are reproduced. */
#ifndef DMB_QUERY_SECTION_SHAPE_H
#define DMB_QUERY_SECTION_SHAPE_H

#include "element/element_type.h"

typedef struct dmb_section_shape {
    double x;       /* [-] fraction of the flexible length */
    double move[2]; /* [-] sideways displacement per unit of d_y, d_z: N3 - x */
    double turn[2]; /* [rad/m] turning of the section per unit of d_y, d_z: G3 */
} dmb_section_shape;

/* The shape at fraction x; bending 0 leaves c out (axial-torsional bars). */
void dmb_section_shape_at(const dmb_element_type *type, double x, int bending, dmb_section_shape *shape);

/* out = c(x) d. Linear in d: rates map alike. */
void dmb_section_shape_correct(const dmb_section_shape *shape, const double d[6], double out[6]);

#endif
