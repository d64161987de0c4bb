/* Joints: relative motion of two frames, and the constraint equations and coordinates of every kind of joint. */
#ifndef DMB_CONSTRAINT_JOINT_H
#define DMB_CONSTRAINT_JOINT_H

#include <stdint.h>

#include "drillmbd/scene.h"

/* Position and motion of frame b relative to frame a, each fixed at a marker (x, M) on its body
 * (eq:joints.relative-motion):
 *
 *     H = H_a^-1 H_b = (R, p)      V = H^-1 H' = to_b v_b + to_a v_a
 *     to_b = Ad(marker_b^-1)       to_a = -Ad(H^-1) Ad(marker_a^-1)
 *
 * v_a, v_b are body-frame velocities (translation; rotation) of the bodies, V the twist of b relative to a in the axes
 * and at the origin of b. d Ad(H^-1)[xi] = -ad(xi) Ad(H^-1) gives rates and tangents. */

typedef struct dmb_relative {
    double R[9];          /* [-] axes of b as columns, in a, row-major */
    double p[3];          /* [m] origin of b, in a */
    double to_a[36];      /* V by v_a; 0 for the ground */
    double to_b[36];      /* V by v_b */
    double V[6];          /* [m/s, rad/s] */
    double convective[6]; /* [m/s2, rad/s2] V' = to_b v_b' + to_a v_a' + convective */
} dmb_relative;

/* Computes R and p from the rotations of the two frames to the world and the vector between their origins [m], world
 * axes. */
void dmb_relative_place(const double Ra[9], const double Rb[9], const double from_a_to_b[3], dmb_relative *relative);
/* Computes the maps to_a and to_b from the velocities of the bodies; requires dmb_relative_place. xa, Ma: origin and
 * axes of frame a in its body; NULL, NULL: the ground. */
void dmb_relative_maps(const double *xa, const double *Ma, const double xb[3], const double Mb[9],
                       dmb_relative *relative);
/* Computes V and convective; requires dmb_relative_maps. va is NULL for the ground. */
void dmb_relative_motion(const double *va, const double vb[6], dmb_relative *relative);
/* Generalised forces to_a^T w and to_b^T w of a wrench w on b [N, N m], in the axes and at the origin of b; wa may be
 * NULL. */
void dmb_relative_pull_back(const dmb_relative *relative, const double w[6], double *wa, double wb[6]);
/* K, shape (12, 12), row-major, a before b: derivative of (to_a^T w; to_b^T w) by body-frame displacements of the two
 * bodies, if w itself changes by W xi with the relative displacement xi = to_b xi_b + to_a xi_a. Overwrites K. */
void dmb_relative_tangent(const dmb_relative *relative, const double w[6], const double W[36], double K[144]);

/* Joints as constraint equations of frame b relative to frame a (eq:joints.rows), and the six joint coordinates
 * (eq:joints.coordinates).
 *
 * Coordinates: c = (p; RX, RY, RZ), R = Ry(RY) Rz(RZ) Rx(RX), so that
 *     RX = atan2(-R_yz, R_yy)      RY = atan2(-R_zx, R_xx)      RZ = asin(R_yx)
 * Rows consist of p_i and R_ij (Haug 1989, dot-product constraints). With body-frame motion V = (u; w) of b, that is p'
 * = R u, R' = R w~:
 *     p_i' = r_i . u      R_ij' = w . (e_j x r_i)      r_i = R^T e_i,  r_i' = r_i x w gives the second derivatives
 *
 * Rows in their order:
 *     of position p_x, p_y, p_z, R_yx, R_zx, R_yz, as far as the kind constrains them
 *     DISTANCE      |p| - length
 *     KNIFE_EDGE    u_y (of speed)
 *     ROLLING       p_x - length sqrt(R_xy^2 + R_xz^2): the height of the rim's lowest point;
 *                   (of speed) the velocity of the rim there along t, the direction of travel for w_x > 0, and
 *                   along t2, the projection of the x axis of b on the plane. In axes of b: n = R^T e_x,
 *                   t = e_x x n/|e_x x n|, t2 = n x t. For a rim that lies flat (sine of the angle below 1e-12) t is
 *                   undefined: its rows of speed are 0. */

enum {
    DMB_JOINT_KINDS = DMB_JOINT_SCHOENFLIES + 1, /* kinds of joints, DMB_JOINT_... */
    DMB_ROWS_MAX = 6                             /* rows of one joint */
};

typedef struct dmb_joint_rows {
    uint32_t count;
    uint32_t holonomic;         /* bit k: row k is an equation of position; otherwise of speed only (value 0) */
    double value[DMB_ROWS_MAX]; /* [m, -] constraint violation, 0 if satisfied */
    double J[DMB_ROWS_MAX][6];  /* value' = J V (nonholonomic: J V = 0 is the equation) */
    double JV[DMB_ROWS_MAX][6]; /* derivative of J with the motion V */
} dmb_joint_rows;

/* Number of rows of a kind. POINT_ON_HOLE has those of POINT_ON_LINE: frame a is then the frame of the hole at the
 * point. */
uint32_t dmb_joint_row_count(int32_t kind);
/* Mask of the free coordinates of a kind, bits 1 << 0 (X) .. 1 << 5 (RZ). */
uint32_t dmb_joint_free_mask(int32_t kind);
/* Computes the rows of a kind at (R, p) with motion V; those from `count` on are not written. length [m]: of DISTANCE,
 * radius of ROLLING. For a distance of 0 the direction is undefined: J = 0. */
void dmb_joint_rows_at(int32_t kind, double length, const double R[9], const double p[3], const double V[6],
                       dmb_joint_rows *rows);
/* Computes W, shape (6, 6): the derivative of sum_k f_k J_k^T along xi is W xi. */
void dmb_joint_rows_tangent(int32_t kind, double length, const double R[9], const double p[3], const double *f,
                            double W[36]);
/* Rows of FIXED at a locked place: all six coordinates are constrained to those at (R0, p0), by p - p0 and R R0^T. Rows
 * and W as above. */
void dmb_joint_locked_at(const double R0[9], const double p0[3], const double R[9], const double p[3],
                         const double V[6], dmb_joint_rows *rows);
void dmb_joint_locked_tangent(const double R0[9], const double p0[3], const double R[9], const double p[3],
                              const double f[6], double W[36]);

/* [rad] Angle between those x axes, or otherwise y axes, that the kind keeps parallel but that are antiparallel in R.
 * There its dot-product rows are satisfied too. 0 if no axes are antiparallel. For a locked joint: that of FIXED for R
 * R0^T. */
double dmb_joint_flip(int32_t kind, const double R[9]);

/* The six joint coordinates. near[0], near[1]: RX and RY are returned in the turn nearest to these. J and JV as of
 * rows. At RZ = +-pi/2 (within 1e-12) RX and RY are undefined: they are set to near[0], near[1], and the gradients of
 * the angles to 0. */
typedef struct dmb_joint_coordinates {
    double value[6];
    double J[6][6];
    double JV[6][6];
} dmb_joint_coordinates;
void dmb_joint_coordinates_at(const double R[9], const double p[3], const double V[6], const double near[2],
                              dmb_joint_coordinates *c);
/* W: derivative of sum_k f_k J_k^T along xi, k = 0 .. 5. */
void dmb_joint_coordinates_tangent(const double R[9], const double p[3], const double f[6], double W[36]);
/* G, shape (6, 6): derivative of the speeds J_k V along xi is G xi, at constant body-frame velocities of both bodies
 * (eq:joints.speed-tangent). at: the coordinates there; vb: velocity of body b. */
void dmb_joint_speeds_tangent(const dmb_relative *relative, const dmb_joint_coordinates *at, const double vb[6],
                              double G[6][6]);

/* Names of joints and their equations, for reports. */

/* Returns "revolute" etc.; "joint" for an unknown kind. */
const char *dmb_joint_kind_name(int32_t kind);
/* Returns the name of the component that row `row` of a kind constrains, relative to frame a: "position y", "rotation
 * about z". A locked joint has the rows of DMB_JOINT_FIXED. "row" if the kind has no such row. */
const char *dmb_joint_row_name(int32_t kind, uint32_t row);

#endif
