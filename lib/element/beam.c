#include "element/beam.h"

#include "element/beam_inertia.h"

static dmb_beam_constants constants_of(const dmb_element_type *type)
{
    dmb_beam_constants c;
    dmb_beam_load_constants(type, 0, &c);
    return c;
}

int32_t dmb_beam_deform(const dmb_element_type *type, const double quaternion_a[4], const double rotation_a[9],
                        const double quaternion_b[4], const double span[3], dmb_beam_shape *shape)
{
    const dmb_beam_constants c = constants_of(type);
    const int arms = type->arm[0] != 0.0 || type->arm[1] != 0.0;
    dmb_beam_shape_at(&c, arms, quaternion_a, rotation_a, quaternion_b, span, shape);
    return dmb_beam_rotation_holds(shape) ? 0 : -1;
}

void dmb_beam_strain_of(const dmb_element_type *type, const dmb_beam_shape *shape, double e[6])
{
    const dmb_beam_constants c = constants_of(type);
    dmb_beam_strain(&c, shape, e);
}

void dmb_beam_stress(const dmb_element_type *type, const dmb_beam_shape *shape, double stress[6])
{
    const dmb_beam_constants c = constants_of(type);
    dmb_beam_elastic_stress(&c, shape, stress);
}

double dmb_beam_stretch(const dmb_element_type *type, const double d[6])
{
    double x[3];
    dmb_vec3_sub(d, type->rest, x);
    return x[0] + 0.5 * (type->coupling[0] * x[1] * x[1] + type->coupling[1] * x[2] * x[2]);
}

void dmb_beam_mass_times(const dmb_beam_mass *mass, const double va[6], const double vb[6], double pa[6], double pb[6])
{
    dmb_beam_constants c;
    dmb_beam_load_mass(mass, 0, &c);
    dmb_beam_momentum(&c, va, vb, pa, pb);
}
