#include "query/pipe_strength.h"

#include <math.h>

#include "math/vec3.h"
#include "model/section.h"

double dmb_tube_von_mises(double outer_diameter, double inner_diameter, double axial_force, double torque,
                          double bending_moment)
{
    const double A = dmb_ring_area(outer_diameter, inner_diameter);
    const double I = dmb_ring_second_moment(outer_diameter, inner_diameter);
    const double r = 0.5 * outer_diameter;
    const double normal = fabs(axial_force) / A + fabs(bending_moment) * r / I;
    const double shear = torque * r / (2.0 * I);
    return sqrt(normal * normal + 3.0 * shear * shear);
}

double dmb_tube_pressed_von_mises(const double diameters[2], double axial_force, double torque, double bending_moment,
                                  double pressure)
{
    const double A = dmb_ring_area(diameters[0], diameters[1]);
    const double I = dmb_ring_second_moment(diameters[0], diameters[1]);
    double largest = 0.0;
    for (int surface = 0; surface < 2; surface++) {
        const double r = 0.5 * diameters[surface];
        const double normal = fabs(axial_force) / A + fabs(bending_moment) * r / I, shear = torque * r / (2.0 * I);
        const double hoop = pressure * dmb_ring_area(diameters[1 - surface], 0.0) / A;
        largest = fmax(largest, sqrt(normal * normal + 3.0 * (hoop * hoop + shear * shear)));
    }
    return largest;
}

double dmb_confined_wall_force(const dmb_confined_pipe *pipe, double axial_force, double *by_force)
{
    double across[3], force;
    dmb_vec3_copy(pipe->weight, across);
    dmb_vec3_axpy(-dmb_vec3_dot(pipe->weight, pipe->tangent), pipe->tangent, across);
    dmb_vec3_axpy(axial_force, pipe->bend, across);
    force = dmb_vec3_norm(across);
    if (by_force != NULL)
        *by_force = force > 0.0 ? dmb_vec3_dot(across, pipe->bend) / force : dmb_vec3_norm(pipe->bend);
    return force;
}

/* `on_wall` of EI w_c/r under the root, `upright` times the length scale of a heavy vertical column. */
static double share(const dmb_confined_pipe *pipe, double axial_force, double on_wall, double upright)
{
    const double along = dmb_vec3_dot(pipe->weight, pipe->tangent);
    const double held = sqrt(on_wall * pipe->EI * dmb_confined_wall_force(pipe, axial_force, NULL) / pipe->clearance);
    const double limit = fmax(held, upright * cbrt(pipe->EI * along * along));
    return axial_force < 0.0 ? -axial_force / limit : 0.0;
}

double dmb_sinusoidal_share(const dmb_confined_pipe *pipe, double axial_force)
{
    return share(pipe, axial_force, 4.0, 2.55);
}

double dmb_helical_share(const dmb_confined_pipe *pipe, double axial_force)
{
    return share(pipe, axial_force, 8.0, 5.55);
}
