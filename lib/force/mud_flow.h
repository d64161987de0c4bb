/* Steady flow of mud down through a pipe and back through the annulus between it and the wall: losses of pressure, and
 * the force on the pipe (eq:mud.pipe to eq:mud.eccentric-power). Herschel-Bulkley fluid: shear stress = tau_y + K
 * (shear rate)^n; tau_y = 0 is a power-law fluid, n = 1 a Bingham fluid, both together a Newtonian fluid.
 *
 * Laminar in a pipe of diameter d (Rabinowitsch 1929; Metzner, Reed 1955): G = (4 K/d) ((3 n + 1)/(4 n) 8 V/d)^n.
 * Laminar in a concentric annulus of radii r = kappa R and R (Fredrickson, Bird 1958; Hanks, Larsen 1979): with x =
 * lambda R the radius at which the shear stress is zero,
 *     int_kappa^lambda (lambda^2/x - x)^(1/n) dx = int_lambda^1 (x - lambda^2/x)^(1/n) dx,
 *     Q = n pi R^3/(3 n + 1) (G R/(2 K))^(1/n) [(1 - lambda^2)^(1 + 1/n) - kappa^(1 - 1/n) (lambda^2 - kappa^2)^(1 +
 * 1/n)]; n = 1: lambda^2 = (1 - kappa^2)/(2 ln(1/kappa)), which is Poiseuille's flow. Turbulent: the Reynolds number is
 * defined by the laminar Fanning friction factor 16/Re (Metzner, Reed 1955; for annuli Jones, Leung 1981), and (API RP
 * 13D 2010, 7.4; Schuh 1964)
 *     f = (f_i^12 + f_l^12)^(1/12), f_i = (f_t^-8 + f_b^-8)^(-1/8), f_l = 16/Re, f_t = 16 Re/(3470 - 1370 n)^2,
 *     f_b = a Re^-b, a = (log10 n + 3.93)/50, b = (1.75 - log10 n)/7   (Blasius' law where n = 1).
 * The surface of zero shear is then at (lambda - kappa)/(1 - lambda) = kappa^0.343 (Kays, Leung 1963). In transition it
 * is interpolated by the fraction of f_i^12 in f^12.
 * With a yield stress (Fredrickson, Bird 1958; API RP 13D 2010, 7.4), laminar, with the wall stress tau_w and phi =
 * tau_y/tau_w:
 *     pipe, exactly: V = (d/2) n (tau_w/K)^(1/n) (1 - phi)^(1 + 1/n) [(1 - phi)^2/(3 n + 1) + 2 phi (1 - phi)/(2 n + 1)
 *     + phi^2/(n + 1)], G = 4 tau_w/d;
 *     slot of gap H = R - r, exactly: V = (H/2) n/(2 n + 1) (tau_w/K)^(1/n) (1 - phi)^(1 + 1/n) (1 + phi n/(n +
 * 1)), G = 2 tau_w/H. The annulus is interpolated between the slot at the onset of yield and the annulus of the power
 * law: its G is that of the slot times 1 + (c - 1) (1 - phi)(1 + phi/2), where c is the ratio of the two without a
 * yield stress, and lambda^2 = kappa + (lambda_0^2 - kappa)(1 - phi)(1 + 0.35 phi). Compared with the integrated flow,
 * G is within 0.1 % and the pull within 0.8 % for kappa >= 0.3 (unit_force_mud_yield). The exponent in the turbulent
 * laws is the local one of Metzner and Reed, n' = d ln tau_w/d ln V: 1/n' = 4 gamma_w d/(8 V) - 3 in a pipe, gamma_w
 * H/(2 V) - 2 in a slot, with gamma_w = ((tau_w - tau_y)/K)^(1/n), not below the smallest n for which they were
 * measured. Without flow the pressure loss is 0 here, although mud at rest supports up to 4 tau_y/d. Eccentric, with
 * axes at the distance e = eps (R - r): laminar and n = 1 exactly (Piercy, Hooper, Winny 1933, as in White, Viscous
 * fluid flow), with P = (R^2 - r^2 + e^2)/2, S = sqrt(P^2 - e^2 R^2), E = R (P - e^2 + S)/(r (P + S)), delta = ln E, 8
 * mu Q/(pi G) = R^4 - r^4 - 4 S^2/delta - 16 S^2 sum_k k q^k/(E^k - E^-k),  q = e^2 R r/((P + S)(P - e^2 + S)). n < 1:
 * the concentric G times 1 - 0.072 (eps/n) kappa^0.8454 - 1.5 eps^2 sqrt(n) kappa^0.1852 + 0.96 eps^3 sqrt(n)
 * kappa^0.2527 (Haciislamoglu, Langlinais 1990); turbulent, times 1 - 0.048 (eps/n) kappa^0.8454 - 2/3 eps^2 sqrt(n)
 * kappa^0.1852 + 0.285 eps^3 sqrt(n) kappa^0.2527 (Haciislamoglu, Cartalos 1994); in transition interpolated by that
 * fraction.
 *
 * The flow in the annulus pulls the pipe towards the rig with pi lambda^2 R^2 G per metre: shear on its outer surface
 * and the pressure gradient balance the forces within the surface of zero shear. Shear on its inner surface and the
 * pressure loss inside cancel in the effective axial force. For an eccentric Newtonian flow the pull is pi G S/delta:
 * with phi harmonic, 1 on the pipe and 0 on the wall, shear on the pipe is G times the integral of phi (Green's
 * identity), which is pi S/delta - pi r^2. For other flows lambda^2 is changed by the same factor. In laminar flow this
 * is within 0.5 %, and G of its correlation within 2.6 %, of the computed flow (unit_force_mud_eccentric); in turbulent
 * flow it is an assumption. */
#ifndef DMB_FORCE_MUD_FLOW_H
#define DMB_FORCE_MUD_FLOW_H

#include <stdint.h>

/* Range of n and largest Re for which the laws above were measured, slightly extended. */
#define DMB_FLOW_EXPONENT_MIN 0.2
#define DMB_FLOW_EXPONENT_MAX 1.0
#define DMB_FLOW_REYNOLDS_MAX 1e6
/* [-] Discharge coefficient of nozzles (Eckel, Bielstein 1951). */
#define DMB_FLOW_DISCHARGE 0.95
/* [-] Validity range of the laws of eccentric annuli. */
#define DMB_FLOW_ECCENTRICITY_MAX 0.95
#define DMB_FLOW_ECCENTRIC_EXPONENT 0.4
#define DMB_FLOW_ECCENTRIC_RATIO_MIN 0.3
#define DMB_FLOW_ECCENTRIC_RATIO_MAX 0.9

typedef struct dmb_mud_flow {
    double rate;            /* [m3/s] >= 0; no losses at 0 */
    double consistency;     /* [Pa s^n] K */
    double exponent;        /* [-] n */
    double yield_stress;    /* [Pa] tau_y >= 0 */
    double eccentricity;    /* [-] of the annulus */
    double nozzle_area;     /* [m2] flow area at the outlet, at the far end */
    double inside, outside; /* [kg/m3] density */
    int32_t open;           /* 1: the last pipe has an open end without pressure loss */
    int32_t reserved;
} dmb_mud_flow;

typedef struct dmb_flow_loss {
    double gradient; /* [Pa/m] pressure loss along the flow */
    double pull;     /* [N/m] of an annulus: force on the pipe towards the rig, in its effective axial force */
    double reynolds; /* [-] */
} dmb_flow_loss;

dmb_flow_loss dmb_bore_loss(const dmb_mud_flow *flow, double diameter);
dmb_flow_loss dmb_annulus_loss(const dmb_mud_flow *flow, double pipe_diameter, double hole_diameter);

/* Quantities of an annulus that depend on exponent, eccentricity and diameters, not on the rate. */
typedef struct dmb_annulus_shape {
    double lambda;             /* [-] laminar, concentric */
    double laminar, turbulent; /* [-] G over that of the concentric annulus */
    double pull;               /* [-] lambda^2 over that of the concentric annulus */
} dmb_annulus_shape;

dmb_annulus_shape dmb_annulus_shape_of(const dmb_mud_flow *flow, double ratio);
/* As dmb_annulus_loss, for a given shape. */
dmb_flow_loss dmb_annulus_loss_by(const dmb_mud_flow *flow, double pipe_diameter, double hole_diameter,
                                  const dmb_annulus_shape *shape);
/* [-] lambda: radius of zero shear stress over the hole radius, laminar (eq:mud.zero-shear). */
double dmb_annulus_zero_shear(double exponent, double ratio);
/* eq:mud.nozzle: pressure loss [Pa] rho Q^2/(2 C^2 A^2) of the nozzles, and their thrust [N] rho Q V on the end of the
 * string, towards the rig. Without other loads the effective axial force at the end is minus this thrust. */
double dmb_nozzle_loss(const dmb_mud_flow *flow);
double dmb_nozzle_thrust(const dmb_mud_flow *flow);

#endif
