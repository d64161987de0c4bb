/* Stiffness of an element with a curved unstressed shape (eq:curved.flexibility): K has off-diagonal entries, which
 * couple the components of e. The diagonal entries are those of its type. */
#ifndef DMB_ELEMENT_CURVED_STIFFNESS_H
#define DMB_ELEMENT_CURVED_STIFFNESS_H

#include "element/curved_shape.h"

/* s += X e, X symmetric with zero diagonal; `cross`: its rows above the diagonal. */
static inline void dmb_curved_add_cross(const dmb_real cross[15], const dmb_real e[6], dmb_real s[6])
{
    int at = 0;
    for (int i = 0; i < 6; i++)
        for (int j = i + 1; j < 6; j++, at++) {
            s[i] += cross[at] * e[j];
            s[j] += cross[at] * e[i];
        }
}

/* Adds its part of the elastic stress. */
static inline void dmb_curved_add_cross_stress(const dmb_curved_constants *curved, const dmb_beam_constants *c,
                                               const dmb_beam_shape *shape, dmb_real stress[6])
{
    dmb_real e[6];
    dmb_beam_strain(c, shape, e);
    dmb_curved_add_cross(curved->cross, e, stress);
}

/* Derivatives of e' by each component of the velocities of both ends. */
static inline void dmb_curved_strain_columns(const dmb_beam_shape *shape, dmb_real columns[12][6])
{
    for (int k = 0; k < 12; k++) {
        dmb_real v[12];
        for (int i = 0; i < 12; i++) v[i] = dmb_real_of(i == k ? 1.0 : 0.0);
        dmb_beam_strain_rate(shape, v, v + 6, columns[k]);
    }
}

/* Entry (r, k) of a matrix for the ends, 12 by 12. */
static inline dmb_real *dmb_curved_entry(dmb_beam_blocks *blocks, int r, int k)
{
    dmb_real *block = r < 6 ? (k < 6 ? blocks->aa : blocks->ab) : (k < 6 ? blocks->ba : blocks->bb);
    return block + 6 * (r % 6) + k % 6;
}

/* blocks += factor B^T X Y, B the columns of the strain, Y columns of a change of e or e'. */
static inline void dmb_curved_add_cross_product(const dmb_real cross[15], dmb_real factor, dmb_real B[12][6],
                                                dmb_real Y[12][6], dmb_beam_blocks *blocks)
{
    for (int k = 0; k < 12; k++) {
        dmb_real s[6];
        for (int i = 0; i < 6; i++) s[i] = dmb_real_of(0.0);
        dmb_curved_add_cross(cross, Y[k], s);
        for (int r = 0; r < 12; r++) *dmb_curved_entry(blocks, r, k) += factor * dmb_vec6_dot(B[r], s);
    }
}

#define DMB_CURVED_STEP 1e-5 /* [rad; element lengths] step of differences: errors of 1e-11 of the forces */

/* e' at d displaced by `by` along its component i, for velocities v of the ends. */
static inline void dmb_curved_rate_beside(const dmb_beam_constants *c, const dmb_real d[6], int i, dmb_real by,
                                          const dmb_real v[12], dmb_real rate[6])
{
    dmb_beam_shape beside;
    dmb_vec6_copy(d, beside.d);
    beside.d[i] = d[i] + by;
    dmb_so3_inverse_coefficients_at(dmb_vec3_norm_squared(beside.d + 3), &beside.k);
    dmb_beam_map_at(c, beside.d, &beside.E);
    dmb_beam_strain_rate(&beside, v, v + 6, rate);
}

/* Change of e' with the poses of the ends, by central differences over d. */
static inline void dmb_curved_rate_columns(const dmb_curved_constants *curved, const dmb_beam_constants *c,
                                           const dmb_beam_shape *shape, const dmb_real v[12], dmb_real columns[12][6])
{
    dmb_real by_d[6][6];
    for (int i = 0; i < 6; i++) {
        const dmb_real step = i < 3 ? (12.0 * DMB_CURVED_STEP) * curved->sixth : dmb_real_of(DMB_CURVED_STEP);
        dmb_real back[6];
        dmb_curved_rate_beside(c, shape->d, i, -step, v, back);
        dmb_curved_rate_beside(c, shape->d, i, step, v, by_d[i]);
        for (int r = 0; r < 6; r++) by_d[i][r] = (by_d[i][r] - back[r]) / (2.0 * step);
    }
    for (int k = 0; k < 12; k++) {
        dmb_real unit[12], rate[6];
        for (int i = 0; i < 12; i++) unit[i] = dmb_real_of(i == k ? 1.0 : 0.0);
        dmb_beam_shape_rate(shape, unit, unit + 6, rate);
        for (int r = 0; r < 6; r++) {
            columns[k][r] = dmb_real_of(0.0);
            for (int i = 0; i < 6; i++) columns[k][r] += by_d[i][r] * rate[i];
        }
    }
}

#endif
