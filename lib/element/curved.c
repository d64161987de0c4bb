/* Bent elements one at a time: the constant mass of the straight element plus the terms that follow its bend
 * (element/curved_mass.h, eq:curved.kinetic-energy). */
#include "element/curved.h"

#include <string.h>

#include "element/beam.h"
#include "element/curved_element.h"
#include "math/mat6.h"

static dmb_curved_constants constants_of(const dmb_element_type *type)
{
    dmb_curved_constants c;
    dmb_curved_load(type, 0, &c);
    return c;
}

/* (pa, pb) = M (va, vb) in the frames of the two ends; of a bent element with the part that follows its bend. */
void dmb_element_momentum(const dmb_element_type *type, const double d[6], const double va[6], const double vb[6],
                          double pa[6], double pb[6])
{
    dmb_curved_shape shape;
    dmb_curved_motion motion;
    double v[12], p[12];
    dmb_beam_mass_times(dmb_element_constant_mass(type), va, vb, pa, pb);
    if (!dmb_element_is_curved(type)) return;
    const dmb_curved_constants c = constants_of(type);
    dmb_curved_shape_at(&c, d, &shape);
    dmb_vec6_copy(va, v);
    dmb_vec6_copy(vb, v + 6);
    dmb_vec6_copy(pa, p);
    dmb_vec6_copy(pb, p + 6);
    dmb_curved_velocity(&c, &shape, v, &motion);
    dmb_curved_add_momentum(&c, &shape, &motion, p);
    dmb_vec6_copy(p, pa);
    dmb_vec6_copy(p + 6, pb);
}

/* Inertial forces M a - v^^T M v of both ends: of the constant part here, of the bent part with the change of its mass
 * as it bends (eq:curved.forces). */
void dmb_element_inertia(const dmb_element_type *type, const double d[6], const double v[12], const double a[12],
                         double f[12])
{
    dmb_curved_shape shape;
    double p[12], turned[12];
    dmb_beam_mass_times(dmb_element_constant_mass(type), v, v + 6, p, p + 6);
    dmb_beam_mass_times(dmb_element_constant_mass(type), a, a + 6, f, f + 6);
    dmb_ad_transpose(v, p, turned);
    dmb_ad_transpose(v + 6, p + 6, turned + 6);
    for (int i = 0; i < 12; i++) f[i] -= turned[i];
    if (!dmb_element_is_curved(type)) return;
    const dmb_curved_constants c = constants_of(type);
    dmb_curved_shape_at(&c, d, &shape);
    dmb_curved_add_inertia(&c, &shape, v, a, f);
}

/* The weight at the centre of the bent element less that where the nodes carry it (eq:curved.weight), as forces on both
 * ends in their frames. A straight element has no difference. */
void dmb_element_bent_weight(const dmb_element_type *type, const double d[6], const double Ra[9],
                             const double gravity[3], double f[12])
{
    dmb_curved_shape shape;
    double weight[3];
    memset(f, 0, 12 * sizeof *f);
    if (!dmb_element_is_curved(type)) return;
    const dmb_curved_constants c = constants_of(type);
    dmb_curved_shape_at(&c, d, &shape);
    dmb_curved_weight(&c, &shape, Ra, gravity, weight);
    dmb_vec3_scale(-1.0, weight, weight);
    dmb_curved_add_weight(&c, &shape, weight, f);
}

void dmb_element_bent_centre(const dmb_element_type *type, const double d[6], double mass[3], double weight[3])
{
    const dmb_curved_constants c = constants_of(type);
    dmb_curved_shape shape;
    double G[3];
    dmb_curved_shape_at(&c, d, &shape);
    dmb_curved_weight_offset(&c, &shape, weight, G);
    dmb_curved_from_middle(&shape, 1.0, weight, weight);
    dmb_curved_from_middle(&shape, 1.0, shape.z, mass);
}
