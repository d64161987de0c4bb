#include "query/section_shape.h"

/* One bending plane. P = 12 EI/(GA L^2), q = 1/(1+P): N3 - x = (3x^2 - 2x^3 - x) q, G3 = 6 (x - x^2) q/L */
static void plane(double x, double bending_stiffness, double shear_stiffness, double length, double *move, double *turn)
{
    const double P = 12.0 * bending_stiffness / (shear_stiffness * length * length), q = 1.0 / (1.0 + P);
    *move = x * ((3.0 - 2.0 * x) * x - 1.0) * q;
    *turn = 6.0 * x * (1.0 - x) * q / length;
}

void dmb_section_shape_at(const dmb_element_type *type, double x, int bending, dmb_section_shape *shape)
{
    const double *K = type->strain_stiffness;
    shape->x = x;
    shape->move[0] = shape->move[1] = shape->turn[0] = shape->turn[1] = 0.0;
    if (!bending) return;
    plane(x, K[5], K[1], type->length, &shape->move[0], &shape->turn[0]);
    plane(x, K[4], K[2], type->length, &shape->move[1], &shape->turn[1]);
}

/* A slope dz/dx is a turn -theta_y. */
void dmb_section_shape_correct(const dmb_section_shape *shape, const double d[6], double out[6])
{
    out[0] = out[3] = 0.0;
    out[1] = shape->move[0] * d[1];
    out[2] = shape->move[1] * d[2];
    out[4] = -shape->turn[1] * d[2];
    out[5] = shape->turn[0] * d[1];
}
