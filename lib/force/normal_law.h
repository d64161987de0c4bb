/* Normal contact laws: force over penetration depth and its rate, per metre of pipe.
 * THEORY: K d^n (1 + mu d'/v0) with the damping factor mu of Hunt-Crossley, Lankarani-Nikravesh, Flores or the exact
 * one; Kelvin-Voigt and IMPACT with a damping constant. Pure functions. */
#ifndef DMB_FORCE_NORMAL_LAW_H
#define DMB_FORCE_NORMAL_LAW_H

#include <stdint.h>

#include "drillmbd/model.h"

typedef struct dmb_normal_law {
    int32_t kind; /* DMB_NORMAL_... */
    int32_t reserved;
    double stiffness;      /* [N/m^(n+1)] K per metre of pipe */
    double exponent;       /* [-] n >= 1 */
    double damping;        /* [N s/m2] c per metre of pipe, of KELVIN_VOIGT and IMPACT */
    double impact_depth;   /* [m] full damping from here on, of IMPACT */
    double mu;             /* [-] damping factor of the restitution laws, 0 for the others */
    double approach_floor; /* [m/s] smallest v0 */
} dmb_normal_law;

/* Fills the law. restitution e in 0 .. 1 fixes mu; for FLORES and EXACT, whose mu grows like 1/e, e below 1e-6 counts
 * as 1e-6. An unknown kind becomes DMB_NORMAL_NONE. Other values are taken as they are (the model has checked them). */
void dmb_normal_law_setup(dmb_normal_law *law, int32_t kind, double stiffness, double exponent, double restitution,
                          double damping, double impact_depth, double approach_floor);

/* [-] Damping factor mu that makes K d^n (1 + mu d'/v0) give back the restitution e, for any n and v0:
 * mu (1 + e) = ln((1 + mu)/(1 - mu e)). To 1e-15 relative. e >= 1 gives 0; e below 1e-6 (or NaN) counts as 1e-6. */
double dmb_exact_restitution_factor(double e);

/* Force [N/m, >= 0, pushing the bodies apart] at penetration depth [m] growing at rate [m/s], and its derivatives
 * [N/m2] and [N s/m2]. approach_speed [m/s]: d' at first touch, kept by the caller. 0 with zero derivatives for depth
 * <= 0 and where the law would pull. NaN in, NaN out. */
void dmb_normal_force(const dmb_normal_law *law, double depth, double rate, double approach_speed, double *force,
                      double *d_depth, double *d_rate);

/* [J/m] Elastic energy K d^(n+1)/(n+1) stored at penetration depth [m]; 0 for depth <= 0. */
double dmb_normal_energy(const dmb_normal_law *law, double depth);

#endif
