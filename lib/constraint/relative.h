/* Frame b seen from frame a, each fixed at a marker (x, M) on its body, and how it moves with the bodies:
 *
 *     H = H_a^-1 H_b = (R, p)      V = H^-1 H' = to_b v_b + to_a v_a
 *     to_b = Ad(marker_b^-1)       to_a = -Ad(H^-1) Ad(marker_a^-1)
 *
 * v_a, v_b are body-frame velocities (translation; rotation) of the bodies, V the twist of b relative to a in the axes
 * and at the origin of b. d Ad(H^-1)[xi] = -ad(xi) Ad(H^-1) gives rates and tangents. */
#ifndef DMB_CONSTRAINT_RELATIVE_H
#define DMB_CONSTRAINT_RELATIVE_H

typedef struct dmb_relative {
    double R[9];          /* [-] axes of b as columns, in a, row-major */
    double p[3];          /* [m] origin of b, in a */
    double to_a[36];      /* V by v_a; 0 for the ground */
    double to_b[36];      /* V by v_b */
    double V[6];          /* [m/s, rad/s] */
    double convective[6]; /* [m/s2, rad/s2] V' = to_b v_b' + to_a v_a' + convective */
} dmb_relative;

/* R and p from the rotations of the two frames to the world and the vector between their origins, world axes. */
void dmb_relative_place(const double Ra[9], const double Rb[9], const double from_a_to_b[3], dmb_relative *relative);
/* The maps from the bodies' velocities, after dmb_relative_place. xa, Ma: origin and axes of frame a in its body;
 * NULL, NULL: the ground. */
void dmb_relative_maps(const double *xa, const double *Ma, const double xb[3], const double Mb[9],
                       dmb_relative *relative);
/* V and convective, after dmb_relative_maps. va is NULL for the ground. */
void dmb_relative_motion(const double *va, const double vb[6], dmb_relative *relative);
/* Generalised forces to_a^T w and to_b^T w of a wrench w on b in the axes and at the origin of b; wa may be NULL. */
void dmb_relative_pull_back(const dmb_relative *relative, const double w[6], double *wa, double wb[6]);
/* K, shape (12, 12), row-major, a before b: derivative of (to_a^T w; to_b^T w) by body-frame displacements of the two
 * bodies, when w itself changes by W xi with the relative displacement xi = to_b xi_b + to_a xi_a. Overwrites K. */
void dmb_relative_tangent(const dmb_relative *relative, const double w[6], const double W[36], double K[144]);

#endif
