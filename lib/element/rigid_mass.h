/* Mathematics of a rigid mass on a node, for numbers that are doubles or lanes of doubles (math/real.h): spatial
 * inertia [m I, -b~; b~, J] at the node, body frame, constant (eq:motion.rigid-mass). */
#ifndef DMB_ELEMENT_RIGID_MASS_H
#define DMB_ELEMENT_RIGID_MASS_H

#include "element/element_type.h"
#include "math/mat6.h"

typedef struct dmb_rigid_mass_constants {
    dmb_real mass;       /* [kg] */
    dmb_real moment[3];  /* [kg m] b */
    dmb_real inertia[6]; /* [kg m2] xx, yy, zz, xy, xz, yz elements of J */
} dmb_rigid_mass_constants;

/* Copies the constants of a rigid mass into one lane. */
static inline void dmb_rigid_mass_load(const dmb_rigid_mass *rigid_mass, int lane, dmb_rigid_mass_constants *c)
{
    dmb_real_set_lane(&c->mass, lane, rigid_mass->mass);
    for (int i = 0; i < 3; i++) dmb_real_set_lane(&c->moment[i], lane, rigid_mass->moment[i]);
    for (int i = 0; i < 6; i++) dmb_real_set_lane(&c->inertia[i], lane, rigid_mass->inertia[i]);
}

static inline void dmb_rigid_mass_inertia_times(const dmb_real J[6], const dmb_real w[3], dmb_real out[3])
{
    dmb_vec3_set(J[0] * w[0] + J[3] * w[1] + J[4] * w[2], J[3] * w[0] + J[1] * w[1] + J[5] * w[2],
                 J[4] * w[0] + J[5] * w[1] + J[2] * w[2], out);
}

/* p = (m u - b x w; b x u + J w) [kg m/s, kg m2/s]; the same product gives M times accelerations. */
static inline void dmb_rigid_mass_momentum(const dmb_rigid_mass_constants *rigid_mass, const dmb_real v[6],
                                           dmb_real p[6])
{
    dmb_real c[3], j[3];
    dmb_vec3_cross(v + 3, rigid_mass->moment, c);
    dmb_vec3_scale(rigid_mass->mass, v, p);
    dmb_vec3_add(p, c, p);
    dmb_vec3_cross(rigid_mass->moment, v, c);
    dmb_rigid_mass_inertia_times(rigid_mass->inertia, v + 3, j);
    dmb_vec3_add(c, j, p + 3);
}

/* out = mass_factor J + s (w~ J - u~ b~), v = (u; w) */
static inline void dmb_rigid_mass_rotation_tangent(const dmb_rigid_mass_constants *rigid_mass, const dmb_real v[6],
                                                   double mass_factor, double s, dmb_real out[9])
{
    const dmb_real *J = rigid_mass->inertia;
    const dmb_real column[3][3] = {{J[0], J[3], J[4]}, {J[3], J[1], J[5]}, {J[4], J[5], J[2]}};
    dmb_real ub[9];
    dmb_skew_product(v, rigid_mass->moment, ub);
    for (int j = 0; j < 3; j++) {
        dmb_real wJ[3];
        dmb_vec3_cross(v + 3, column[j], wJ);
        for (int i = 0; i < 3; i++) out[3 * i + j] = mass_factor * column[j][i] + s * (wJ[i] - ub[3 * i + j]);
    }
}

/* Adds mass_factor M + velocity_factor C_t (eq:motion.gyroscopic), p = M v, v = (u; w):
 * -v^^T M = [m w~, -w~ b~; m u~ + w~ b~, -u~ b~ + w~ J] */
static inline void dmb_rigid_mass_add_tangent(const dmb_rigid_mass_constants *rigid_mass, const dmb_real v[6],
                                              const dmb_real p[6], double mass_factor, double velocity_factor,
                                              dmb_real out[36])
{
    const dmb_real mass = dmb_real_of(mass_factor), s = dmb_real_of(velocity_factor);
    const dmb_real m = mass_factor * rigid_mass->mass, sm = velocity_factor * rigid_mass->mass;
    dmb_real wb[9], rotation[9];
    dmb_skew_product(v + 3, rigid_mass->moment, wb);
    dmb_rigid_mass_rotation_tangent(rigid_mass, v, mass_factor, velocity_factor, rotation);
    for (int i = 0; i < 21; i += 7) out[i] += m;
    dmb_mat6_add_skew(sm, v + 3, 0, 0, out);
    dmb_mat6_add_skew(-mass, rigid_mass->moment, 0, 1, out);
    dmb_mat6_add_block(-s, wb, 0, 1, out);
    dmb_mat6_add_skew(mass, rigid_mass->moment, 1, 0, out);
    dmb_mat6_add_skew(sm, v, 1, 0, out);
    dmb_mat6_add_block(s, wb, 1, 0, out);
    dmb_mat6_add_block(dmb_real_of(1.0), rotation, 1, 1, out);
    dmb_mat6_add_skew(-s, p, 0, 1, out);
    dmb_mat6_add_skew(-s, p, 1, 0, out);
    dmb_mat6_add_skew(-s, p + 3, 1, 1, out);
}

#ifndef DMB_LANES

/* p = M v [kg m/s, kg m2/s] of one rigid mass. */
static inline void dmb_rigid_mass_times(const dmb_rigid_mass *rigid_mass, const double v[6], double p[6])
{
    dmb_rigid_mass_constants c;
    dmb_rigid_mass_load(rigid_mass, 0, &c);
    dmb_rigid_mass_momentum(&c, v, p);
}

#endif

#endif
