/* Friction laws: two components of tangential force at the contact point (axial, circumferential).
 * N is the normal force [N >= 0, or N/m; the result has its unit], v the sliding velocity of the pipe's contact point
 * over the wall [m/s]. All derivatives are exact; the falling Stribeck branch is kept in them. Pure functions. */
#ifndef DMB_FORCE_FRICTION_LAW_H
#define DMB_FORCE_FRICTION_LAW_H

#include <stdint.h>

#include "drillmbd/model.h"

typedef struct dmb_friction_law {
    int32_t kind; /* DMB_FRICTION_... */
    int32_t reserved;
    double mu_static;         /* [-] */
    double mu_dynamic;        /* [-] */
    double stribeck_speed;    /* [m/s] v_s > 0 */
    double smoothing_speed;   /* [m/s] v_eps of COULOMB and STRIBECK, v0 of AMBROSIO; > 0 */
    double full_speed;        /* [m/s] v1 of AMBROSIO, > v0 */
    double bristle_stiffness; /* [1/m] sigma0 > 0, tangential stiffness over normal force */
    double bristle_damping;   /* [s/m] sigma1 >= 0, tangential damping over normal force */
} dmb_friction_law;

/* Friction as a function of velocity alone. F [as N] is the force on the pipe, dF_dv its tangent (2,2) row by row,
 * dF_dN its derivative with respect to N (2).
 *   COULOMB, STRIBECK: F = -mu(s) N v/s, s = sqrt(|v|^2 + v_eps^2), mu constant (mu_dynamic) or the Stribeck curve
 *   mu_d + (mu_s - mu_d) exp(-s/v_s). BRISTLE gives the STRIBECK result: what the law is once it slides.
 *   AMBROSIO: mu_d N opposite to v times 0 up to v0, (|v| - v0)/(v1 - v0) up to v1, 1 beyond.
 * Zero where v = 0; a law smoothed like this creeps under load, BRISTLE does not. */
void dmb_friction_smooth(const dmb_friction_law *law, double N, const double v[2], double F[2], double dF_dv[4],
                         double dF_dN[2]);

/* Friction with memory: elastic bristles of deflection z [m] that truly stick. One step of length h [s] (>= 0) from
 * deflection z_old and sliding velocity v_old, ends at v:
 *   z* = z_old + h (v_old + v)/2
 *   z  = z* brought back onto the circle |z| <= mu/sigma0
 *   q  = sigma0 z + sigma1 v brought back onto the circle |q| <= mu,   F = -N q
 * with mu = mu_static where the accepted step before stuck (stuck != 0), else mu_d + (mu_s - mu_d) exp(-|v|/v_s).
 * So it breaks away at mu_static however fast it is loaded or vibrates in sticking, and slides on the Stribeck curve
 * from the step after. (With the curve in sticking too, as in LuGre, the bristles' own speed lowers the limit.)
 * The damping counts in sticking and fades out at the limit: |F| <= mu N always, F = -mu N v/|v| in steady sliding.
 * Both projections are continuous in v. *sticks is 1 where neither acts; the caller hands it back as `stuck` of the
 * next step, never between iterations of one step. The tangent has kinks at the circles and, with mu_s > mu_d, at v = 0
 * while sliding (the derivative of |v| there counts as 0). h = 0 keeps z_old, cut back to the limit.
 * The caller keeps z, v and sticks of accepted steps, and starts a contact, or one regained, at z = 0 and stuck = 0.
 * F, dF_dv, dF_dN as above. */
void dmb_friction_bristle(const dmb_friction_law *law, double N, const double v[2], const double z_old[2],
                          const double v_old[2], int32_t stuck, double h, double z[2], double F[2], double dF_dv[4],
                          double dF_dN[2], int32_t *sticks);

#endif
