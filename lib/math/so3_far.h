/* Coefficients of rotations away from zero, where the short series of so3.h ends: out of line, doubles only. */
#ifndef DMB_MATH_SO3_FAR_H
#define DMB_MATH_SO3_FAR_H

/* a, b, a2, db, da2 of so3.h at x = |O|^2. */
void dmb_so3_far_coefficients(double x, double out[5]);
/* c, e, e2 of so3.h at x = |O|^2; singular at |O| = 2 pi, where the inverse is. */
void dmb_so3_far_inverse_coefficients(double x, double out[3]);
/* f with O = f v for the quaternion (q0; v), q0 >= 0, n = |v|^2. */
double dmb_quat_far_log_factor(double q0, double n);

#endif
