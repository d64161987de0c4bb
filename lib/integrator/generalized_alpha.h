/* Generalized-alpha on the Lie group (Chung, Hulbert 1993; Arnold, Bruls 2007; Bruls, Cardona, Arnold 2012):
 *     (1-am) a1 + am a0 = (1-af) v1' + af v0'
 *     h Dq = h v0 + h^2 (1/2-beta) a0 + h^2 beta a1,   q1 = q0 exp(h Dq),   v1 = v0 + h (1-gamma) a0 + h gamma a1 */
#ifndef DMB_INTEGRATOR_GENERALIZED_ALPHA_H
#define DMB_INTEGRATOR_GENERALIZED_ALPHA_H

typedef struct dmb_generalized_alpha {
    double am, af, gamma, beta;
    double error; /* local error of the pose is error h^2 (a1 - a0) */
} dmb_generalized_alpha;

/* r: spectral radius at infinite frequency, 0 .. 1 */
static inline dmb_generalized_alpha dmb_generalized_alpha_of(double r)
{
    dmb_generalized_alpha c;
    c.am = (2.0 * r - 1.0) / (r + 1.0);
    c.af = r / (r + 1.0);
    c.gamma = 0.5 + c.af - c.am;
    c.beta = 0.25 * (c.gamma + 0.5) * (c.gamma + 0.5);
    c.error = c.beta + 0.5 * (c.am - c.af) - 1.0 / 6.0;
    return c;
}

#endif
