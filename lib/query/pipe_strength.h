/* Loads over limits of a pipe in its hole: stress at its surface, and the buckling of a long pipe that lies on the
 * wall. */
#ifndef DMB_QUERY_PIPE_STRENGTH_H
#define DMB_QUERY_PIPE_STRENGTH_H

#include "drillmbd/model.h"

/* [Pa] Largest von Mises stress at the outer surface of a tube under effective axial force [N], torque and bending
 * moment [N m]: s = |N_e|/A + M r/I, t = T r/J, sqrt(s^2 + 3 t^2). A fluid at rest of one density inside and outside
 * adds the same pressure in all directions to what N_e gives, which no yield criterion of shear sees. */
double dmb_tube_von_mises(double outer_diameter, double inner_diameter, double axial_force, double torque,
                          double bending_moment);

/* [Pa] Likewise where the pressure inside is higher by `pressure` [Pa], the largest of both surfaces. With s = N_e/A +
 * M rho/I at the radius rho the axial stress is s + (p_i A_i - p_o A_o)/A; radial and hoop stress of Lame lie by
 * +- h, h = pressure A_i A_o/(A pi rho^2), about the same mean, so that the von Mises stress is sqrt(s^2 + 3 h^2 + 3
 * t^2) (Sparks 1984). diameters: outer, inner [m]. */
double dmb_tube_pressed_von_mises(const double diameters[2], double axial_force, double torque, double bending_moment,
                                  double pressure);

/* A long pipe in contact with the wall of its hole. */
typedef struct dmb_confined_pipe {
    double EI;         /* [N m2] the smaller one */
    double clearance;  /* [m] of its contact ring, >= 0 */
    double weight[3];  /* [N/m] buoyant, world frame */
    double tangent[3]; /* [-] of the hole's axis */
    double bend[3];    /* [1/m] dt/ds of the hole's axis, world frame */
} dmb_confined_pipe;

/* [N/m] Wall force w_c per metre of the pipe without its bending stiffness, |w_across + N_e dt/ds|; and dw_c/dN_e [1/m]
 * in *by_force (may be NULL). */
double dmb_confined_wall_force(const dmb_confined_pipe *pipe, double axial_force, double *by_force);

/* [-] Compression -N_e over the load of sinusoidal buckling, sqrt(4 EI w_c/r) where w_c = |w_across + N_e dt/ds| is the
 * contact force per metre before buckling (Dawson, Paslay 1984; He, Kyllingstad 1995), but at least 2.55 (EI
 * w_along^2)^(1/3) (Wu, Juvkam-Wold 1995). 0 in tension, infinite where nothing holds the pipe straight. */
double dmb_sinusoidal_share(const dmb_confined_pipe *pipe, double axial_force);
/* [-] likewise of helical buckling: sqrt(8 EI w_c/r) (Chen, Lin, Cheatham 1990), at least 5.55 (EI w_along^2)^(1/3). */
double dmb_helical_share(const dmb_confined_pipe *pipe, double axial_force);

#endif
