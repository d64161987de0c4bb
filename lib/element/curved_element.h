/* Inertia and weight of a curved element as used by steps: forces and their contributions to the tangent. */
#ifndef DMB_ELEMENT_CURVED_ELEMENT_H
#define DMB_ELEMENT_CURVED_ELEMENT_H

#include "element/curved_mass.h"
#include "element/curved_stiffness.h"

/* Motion of the ends and weight of an element. */
typedef struct dmb_curved_state {
    int32_t dynamic;       /* 0: statics, v and a are not read */
    dmb_real v[12], a[12]; /* of both ends */
    dmb_real weight[3];    /* [N] minus the weight, axes of the middle */
} dmb_curved_state;

/* -m R_m^T g; Ra: axes of the first node, g [m/s2] world. */
static inline void dmb_curved_weight(const dmb_curved_constants *c, const dmb_curved_shape *shape, const dmb_real Ra[9],
                                     const double gravity[3], dmb_real out[3])
{
    dmb_real g[3], y[3];
    for (int i = 0; i < 3; i++) g[i] = dmb_real_of(gravity[i]);
    dmb_mat3_tvec(Ra, g, y);
    dmb_curved_to_middle(shape, 1.0, y, out);
    dmb_vec3_scale(-c->weight, out, out);
}

/* All forces on both ends at d. */
static inline void dmb_curved_forces(const dmb_curved_constants *c, const dmb_real d[6], const dmb_curved_state *state,
                                     dmb_real f[12])
{
    dmb_curved_shape shape;
    dmb_curved_shape_at(c, d, &shape);
    for (int i = 0; i < 12; i++) f[i] = dmb_real_of(0.0);
    if (state->dynamic) dmb_curved_add_inertia(c, &shape, state->v, state->a, f);
    dmb_curved_add_weight(c, &shape, state->weight, f);
}

static inline void dmb_curved_add_column(dmb_real factor, const dmb_real f[12], int k, dmb_beam_blocks *blocks)
{
    for (int r = 0; r < 12; r++) *dmb_curved_entry(blocks, r, k) += factor * f[r];
}

/* Adds the derivative by d at constant motion and weight, times d' of the ends; central differences. */
static inline void dmb_curved_add_shape_tangent(const dmb_curved_constants *c, const dmb_curved_shape *shape,
                                                const dmb_curved_state *state, dmb_beam_blocks *K)
{
    dmb_real by_d[6][12];
    for (int i = 0; i < 6; i++) {
        const dmb_real step = i < 3 ? (12.0 * DMB_CURVED_STEP) * c->sixth : dmb_real_of(DMB_CURVED_STEP);
        dmb_real d[6], back[12];
        dmb_vec6_copy(shape->d, d);
        d[i] = shape->d[i] - step;
        dmb_curved_forces(c, d, state, back);
        d[i] = shape->d[i] + step;
        dmb_curved_forces(c, d, state, by_d[i]);
        for (int r = 0; r < 12; r++) by_d[i][r] = (by_d[i][r] - back[r]) / (2.0 * step);
    }
    for (int k = 0; k < 12; k++) {
        dmb_real v[12], rate[6];
        for (int i = 0; i < 12; i++) v[i] = dmb_real_of(i == k ? 1.0 : 0.0);
        dmb_se3_inverse_tangents_apply(shape->d, &shape->k, v, v + 6, rate);
        for (int i = 0; i < 6; i++) dmb_curved_add_column(rate[i], by_d[i], k, K);
    }
}

/* Adds the derivative by the motion of the ends: for each of its components the mass, the effect of rotation of the
 * ends on the weight, and the derivative of the inertia forces by velocity. The inertia forces are a quadratic form in
 * the velocity, so that differences over any step are exact. */
static inline void dmb_curved_add_motion_tangent(const dmb_curved_constants *c, const dmb_curved_shape *shape,
                                                 const dmb_curved_state *state, const double factor[2],
                                                 dmb_beam_blocks *C)
{
    dmb_real v[12], none[12];
    for (int i = 0; i < 12; i++) {
        none[i] = dmb_real_of(0.0);
        v[i] = state->v[i];
    }
    for (int k = 0; k < 12; k++) {
        const dmb_real speed = v[k];
        dmb_real unit[12], f[12], back[12];
        dmb_curved_motion motion;
        for (int i = 0; i < 12; i++) {
            unit[i] = dmb_real_of(i == k ? 1.0 : 0.0);
            f[i] = back[i] = dmb_real_of(0.0);
        }
        dmb_curved_velocity(c, shape, unit, &motion);
        dmb_curved_add_momentum(c, shape, &motion, f);
        dmb_curved_add_column(dmb_real_of(factor[0]), f, k, C);
        for (int i = 0; i < 12; i++) f[i] = dmb_real_of(0.0);
        v[k] = speed + 1.0;
        dmb_curved_add_inertia(c, shape, v, none, f);
        v[k] = speed - 1.0;
        dmb_curved_add_inertia(c, shape, v, none, back);
        v[k] = speed;
        for (int i = 0; i < 12; i++) f[i] -= back[i];
        dmb_curved_add_column(dmb_real_of(0.5 * factor[1]), f, k, C);
    }
}

/* Adds the tangent of the weight by a rotation dphi of the middle: F changes by -dphi x F. */
static inline void dmb_curved_add_weight_tangent(const dmb_curved_constants *c, const dmb_curved_shape *shape,
                                                 const dmb_curved_state *state, dmb_beam_blocks *K)
{
    for (int k = 0; k < 12; k++) {
        dmb_real unit[12], f[12], F[3];
        dmb_curved_motion motion;
        for (int i = 0; i < 12; i++) {
            unit[i] = dmb_real_of(i == k ? 1.0 : 0.0);
            f[i] = dmb_real_of(0.0);
        }
        dmb_curved_velocity(c, shape, unit, &motion);
        dmb_vec3_cross(state->weight, motion.w, F);
        dmb_curved_add_weight(c, shape, F, f);
        dmb_curved_add_column(dmb_real_of(1.0), f, k, K);
    }
}

#endif
