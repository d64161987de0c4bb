/* Steady flow of mud down through a pipe and back through the annulus between it and the wall: losses of pressure, and
 * the force on the pipe. A fluid of the power law, shear stress = K (shear rate)^n, Newtonian where n = 1.
 *
 * Laminar in a pipe of diameter d (Rabinowitsch 1929; Metzner, Reed 1955): G = (4 K/d) ((3 n + 1)/(4 n) 8 V/d)^n.
 * Laminar in a concentric annulus of radii r = kappa R and R (Fredrickson, Bird 1958; Hanks, Larsen 1979): with x =
 * lambda R the radius at which the shear stress is zero,
 *     int_kappa^lambda (lambda^2/x - x)^(1/n) dx = int_lambda^1 (x - lambda^2/x)^(1/n) dx,
 *     Q = n pi R^3/(3 n + 1) (G R/(2 K))^(1/n) [(1 - lambda^2)^(1 + 1/n) - kappa^(1 - 1/n) (lambda^2 - kappa^2)^(1 +
 * 1/n)]; n = 1: lambda^2 = (1 - kappa^2)/(2 ln(1/kappa)), which is Poiseuille's flow. Beyond: the Reynolds number that
 * gives the laminar flow its Fanning friction factor 16/Re (Metzner, Reed 1955; of annuli Jones, Leung 1981), and by it
 * (API RP 13D 2010, 7.4; Schuh 1964)
 *     f = (f_i^12 + f_l^12)^(1/12), f_i = (f_t^-8 + f_b^-8)^(-1/8), f_l = 16/Re, f_t = 16 Re/(3470 - 1370 n)^2,
 *     f_b = a Re^-b, a = (log10 n + 3.93)/50, b = (1.75 - log10 n)/7   (Blasius' law where n = 1).
 * The surface without shear is then at (lambda - kappa)/(1 - lambda) = kappa^0.343 (Kays, Leung 1963), between the two
 * by the share of f_i^12 in f^12.
 *
 * Per metre of pipe the annulus pulls by pi lambda^2 R^2 G towards the rig: shear on its surface and the pressure that
 * falls along it hold all that is within the surface without shear. Shear on its inner surface and the pressure lost
 * inside cancel in the effective axial force. */
#ifndef DMB_FORCE_MUD_FLOW_H
#define DMB_FORCE_MUD_FLOW_H

#include <stdint.h>

/* Range of n, and of Re, up to which the laws above were measured, with some room. */
#define DMB_FLOW_EXPONENT_MIN 0.2
#define DMB_FLOW_EXPONENT_MAX 1.0
#define DMB_FLOW_REYNOLDS_MAX 1e6
/* [-] Discharge coefficient of nozzles (Eckel, Bielstein 1951). */
#define DMB_FLOW_DISCHARGE 0.95

typedef struct dmb_mud_flow {
    double rate;            /* [m3/s] >= 0; nothing is lost at 0 */
    double consistency;     /* [Pa s^n] K */
    double exponent;        /* [-] n */
    double nozzle_area;     /* [m2] of what it leaves by at the far end */
    double inside, outside; /* [kg/m3] density */
    int32_t open;           /* 1: the end of the last pipe, without a loss of pressure */
    int32_t reserved;
} dmb_mud_flow;

typedef struct dmb_flow_loss {
    double gradient; /* [Pa/m] by which the pressure falls along the flow */
    double pull;     /* [N/m] of an annulus, on the pipe towards the rig, in its effective axial force */
    double reynolds; /* [-] */
} dmb_flow_loss;

dmb_flow_loss dmb_bore_loss(const dmb_mud_flow *flow, double diameter);
dmb_flow_loss dmb_annulus_loss(const dmb_mud_flow *flow, double pipe_diameter, double hole_diameter);
/* The same for a lambda that is known: it goes with exponent and diameters, not with the rate. */
dmb_flow_loss dmb_annulus_loss_by(const dmb_mud_flow *flow, double pipe_diameter, double hole_diameter, double lambda);
/* [-] lambda: radius without shear stress over that of the hole, laminar. */
double dmb_annulus_zero_shear(double exponent, double ratio);
/* [Pa] rho Q^2/(2 C^2 A^2) through nozzles, and [N] their thrust rho Q V on the string's end, towards the rig, less
 * which the effective axial force there is 0. */
double dmb_nozzle_loss(const dmb_mud_flow *flow);
double dmb_nozzle_thrust(const dmb_mud_flow *flow);

#endif
