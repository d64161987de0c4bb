/* Joints as equations of frame b seen from frame a (constraint/relative.h), and the six joint coordinates.
 *
 * Coordinates: c = (p; RX, RY, RZ), R = Ry(RY) Rz(RZ) Rx(RX), so that
 *     RX = atan2(-R_yz, R_yy)      RY = atan2(-R_zx, R_xx)      RZ = asin(R_yx)
 * Rows are built of p_i and R_ij (Haug 1989, dot-product constraints). With body-frame motion V = (u; w) of b, that is
 * p' = R u, R' = R w~:
 *     p_i' = r_i . u      R_ij' = w . (e_j x r_i)      r_i = R^T e_i,  r_i' = r_i x w gives the second derivatives
 *
 * Rows in their order:
 *     of position   p_x, p_y, p_z, R_yx, R_zx, R_yz, those of them that the kind holds
 *     DISTANCE      |p| - length
 *     KNIFE_EDGE    u_y (of speed)
 *     ROLLING       p_x - length sqrt(R_xy^2 + R_xz^2): the height of the rim's lowest point;
 *                   (of speed) the rim's velocity there along t, the way it goes where w_x > 0, and along t2, the
 *                   shadow of the x axis of b on the plane. In axes of b: n = R^T e_x, t = e_x x n/|e_x x n|,
 *                   t2 = n x t. A rim lying flat (sine of the angle below 1e-12) has no t: its rows of speed are 0. */
#ifndef DMB_CONSTRAINT_JOINT_H
#define DMB_CONSTRAINT_JOINT_H

#include <stdint.h>

/* Kinds are numbered as DMB_JOINT_... in model.h (model/mesh_joint.c asserts it). */
enum {
    DMB_ROWS_FIXED = 0,
    DMB_ROWS_REVOLUTE = 1,
    DMB_ROWS_PRISMATIC = 2,
    DMB_ROWS_CYLINDRICAL = 3,
    DMB_ROWS_UNIVERSAL = 4,
    DMB_ROWS_SPHERICAL = 5,
    DMB_ROWS_PLANAR = 6,
    DMB_ROWS_POINT_ON_LINE = 7,
    DMB_ROWS_POINT_ON_HOLE = 8,
    DMB_ROWS_DISTANCE = 9,
    DMB_ROWS_FREE = 10,
    DMB_ROWS_KNIFE_EDGE = 11,
    DMB_ROWS_ROLLING = 12,
    DMB_ROWS_TRANSLATIONAL = 13,
    DMB_ROWS_CROSS_SLIDE = 14,
    DMB_ROWS_SCHOENFLIES = 15,
    DMB_ROWS_KINDS = 16,
    DMB_ROWS_MAX = 6
};

typedef struct dmb_joint_rows {
    uint32_t count;
    uint32_t holonomic;         /* bit k: row k is an equation of position; else of speed only (value 0) */
    double value[DMB_ROWS_MAX]; /* [m, -] what must be 0 */
    double J[DMB_ROWS_MAX][6];  /* value' = J V (nonholonomic: J V = 0 is the equation) */
    double JV[DMB_ROWS_MAX][6]; /* derivative of J along the motion V */
} dmb_joint_rows;

/* Number of rows of a kind. POINT_ON_HOLE has those of POINT_ON_LINE: frame a is then the hole's at the point. */
uint32_t dmb_joint_row_count(int32_t kind);
/* Free coordinates of a kind, bits 1 << 0 (X) .. 1 << 5 (RZ). */
uint32_t dmb_joint_free_mask(int32_t kind);
/* Rows of a kind at (R, p) in motion V; those from `count` on are not written. length: of DISTANCE, radius of ROLLING.
 * A distance of 0 has no direction: J = 0. */
void dmb_joint_rows_at(int32_t kind, double length, const double R[9], const double p[3], const double V[6],
                       dmb_joint_rows *rows);
/* W, shape (6, 6): derivative of sum_k f_k J_k^T along xi is W xi. */
void dmb_joint_rows_tangent(int32_t kind, double length, const double R[9], const double p[3], const double *f,
                            double W[36]);
/* Rows of FIXED at a locked place: all six coordinates as at (R0, p0), by p - p0 and R R0^T. Rows, W as above. */
void dmb_joint_locked_at(const double R0[9], const double p0[3], const double R[9], const double p[3],
                         const double V[6], dmb_joint_rows *rows);
void dmb_joint_locked_tangent(const double R0[9], const double p0[3], const double R[9], const double p[3],
                              const double f[6], double W[36]);

/* [rad] Angle between x axes, or else y axes, that the kind keeps parallel and that point against each other in R,
 * where its dot-product rows are satisfied too; 0 where none do. Of a locked joint: that of FIXED for R R0^T. */
double dmb_joint_flip(int32_t kind, const double R[9]);

/* The six coordinates; near[0], near[1]: RX and RY are given on the turn next to these. J and JV as of rows. At RZ =
 * +-pi/2 (within 1e-12) RX and RY are not defined: they are near[0], near[1], and the gradients of the angles 0. */
typedef struct dmb_joint_coordinates {
    double value[6];
    double J[6][6];
    double JV[6][6];
} dmb_joint_coordinates;
void dmb_joint_coordinates_at(const double R[9], const double p[3], const double V[6], const double near[2],
                              dmb_joint_coordinates *c);
/* W: derivative of sum_k f_k J_k^T along xi, k = 0 .. 5. */
void dmb_joint_coordinates_tangent(const double R[9], const double p[3], const double f[6], double W[36]);

/* Names of joints and their equations, for reports. */

/* "revolute" and the like; "joint" for a kind that is none. */
const char *dmb_joint_kind_name(int32_t kind);
/* Name of the component that row `row` of a kind holds, seen from frame a: "position y", "rotation about z". A locked
 * joint has the rows of DMB_ROWS_FIXED. "row" where the kind has no such row. */
const char *dmb_joint_row_name(int32_t kind, uint32_t row);

#endif
