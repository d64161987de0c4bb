/* Functions of the shape of a curved element (eq:curved.line, eq:curved.centre), for numbers that are doubles or lanes
 * of doubles. */
#ifndef DMB_ELEMENT_CURVED_SHAPE_H
#define DMB_ELEMENT_CURVED_SHAPE_H

#include "element/beam_math.h"

/* Constants of dmb_curved_mass that a step requires. */
typedef struct dmb_curved_constants {
    dmb_real mass, rotary[2], moving[6];  /* [kg], [kg m2], C */
    dmb_real turn[2], offset[2], tilt[2]; /* [1/m] Gamma, [-] k, [1/m] */
    dmb_real cross[15];                   /* [N/m, N, N m] of the stiffness */
    dmb_real sixth, weight;               /* [m] L/12 of the nodes' weight, [kg] mass on which gravity acts */
} dmb_curved_constants;

/* Functions of d only. */
typedef struct dmb_curved_shape {
    dmb_real d[6];
    dmb_so3_inverse_coefficients k;      /* at |O|^2 */
    dmb_so3_coefficients half;           /* at |O/2|^2 */
    dmb_real gamma[3];                   /* z = -O x (gamma U - k U), with two derivatives by |O|^2 */
    dmb_real odd[2], square[2], even[2]; /* [-] integrals of x^4 a2, x^6 a2^2, x^4 b^2 minus beta^2, with derivatives */
    dmb_real beta[2], sine[2];           /* [-] of x^2 b, x^2 a^2 */
    dmb_real G[3], z[3];                 /* [m] */
    dmb_real U[3], Z[3], W[3];           /* [m] U with the bending shapes, O x U, O x (O x U) */
    dmb_real e[3], f[3], g[3];           /* [-] axis of the sections, O x e, O x (O x e) */
} dmb_curved_shape;

static inline void dmb_curved_load(const dmb_element_type *type, int lane, dmb_curved_constants *c)
{
    const dmb_curved_mass *m = &type->curved;
    dmb_real_set_lane(&c->mass, lane, m->mass);
    dmb_real_set_lane(&c->sixth, lane, type->length / 12.0);
    dmb_real_set_lane(&c->weight, lane, type->weight_mass);
    for (int i = 0; i < 2; i++) {
        dmb_real_set_lane(&c->rotary[i], lane, m->rotary[i]);
        dmb_real_set_lane(&c->turn[i], lane, m->turn[i]);
        dmb_real_set_lane(&c->offset[i], lane, m->offset[i]);
        dmb_real_set_lane(&c->tilt[i], lane, m->tilt[i]);
    }
    for (int i = 0; i < 6; i++) dmb_real_set_lane(&c->moving[i], lane, m->moving[i]);
    for (int i = 0; i < 15; i++) dmb_real_set_lane(&c->cross[i], lane, m->cross[i]);
}

/* p(x) and p'(x) of a power series. */
static inline void dmb_series(const double *c, int terms, dmb_real x, dmb_real p[2])
{
    dmb_real u = dmb_real_of(c[terms - 1]), v = dmb_real_of(0.0);
    for (int i = terms - 2; i >= 0; i--) {
        v = v * x + u;
        u = u * x + c[i];
    }
    p[0] = u;
    p[1] = v;
}

/* The same with p''. */
static inline void dmb_series_twice(const double *c, int terms, dmb_real x, dmb_real p[3])
{
    dmb_real u = dmb_real_of(c[terms - 1]), v = dmb_real_of(0.0), w = dmb_real_of(0.0);
    for (int i = terms - 2; i >= 0; i--) {
        w = w * x + 2.0 * v;
        v = v * x + u;
        u = u * x + c[i];
    }
    p[0] = u;
    p[1] = v;
    p[2] = w;
}

/* Integrals over -1/2 .. 1/2 of the coefficients a, b, a2 of x O, as series of |O|^2 up to 2.5^2: to 2e-16. */
static inline void dmb_curved_integrals(dmb_real x, dmb_curved_shape *shape)
{
    static const double gamma[9] = {8.3333333333333329e-02,  -2.0833333333333333e-03, 1.8601190476190478e-05,
                                    -8.6116622574955910e-08, 2.4464949595157927e-10,  -4.7047979990688320e-13,
                                    6.5344416653733780e-16,  -6.8639093123669940e-19, 5.6446622634596990e-22};
    static const double beta[9] = {4.1666666666666664e-02,  -5.2083333333333333e-04, 3.1001984126984127e-06,
                                   -1.0764577821869490e-08, 2.4464949595157930e-11,  -3.9206649992240270e-14,
                                   4.6674583324095560e-17,  -4.2899433202293710e-20, 3.1359234796998330e-23};
    static const double odd[9] = {2.0833333333333333e-03,  -1.8601190476190478e-05, 8.6116622574955910e-08,
                                  -2.4464949595157927e-10, 4.7047979990688320e-13,  -6.5344416653733780e-16,
                                  6.8639093123669940e-19,  -5.6446622634596990e-22, 3.7332422377378962e-25};
    static const double square[10] = {6.2003968253968250e-05,  -1.2056327160493827e-06, 1.2036755200817701e-08,
                                      -7.9354259584294300e-11, 3.8105129825791615e-13,  -1.4043558453102870e-15,
                                      4.1091886908594730e-18,  -9.7857238832480830e-21, 1.9340445065953665e-23,
                                      -3.2234566973195203e-26};
    static const double even[11] = {1.3888888888888889e-03,  -4.9603174603174600e-05, 8.2671957671957680e-07,
                                    -8.3507027951472400e-09, 5.7353727988648620e-11,  -2.8676863994324310e-13,
                                    1.0933444878010360e-15,  -3.2882540986497320e-18, 8.0071122532055160e-21,
                                    -1.6117375710961184e-23, 2.7275558895472774e-26};
    static const double sine[12] = {8.3333333333333329e-02,  -4.1666666666666670e-03, 9.9206349206349200e-05,
                                    -1.3778659611992946e-06, 1.2526054192720860e-08,  -8.0295219184108070e-11,
                                    3.8235818659099080e-13,  -1.4057286271727603e-15, 4.1103176233121650e-18,
                                    -9.7864705316956310e-21, 1.9340850853153420e-23,  -3.2234751421922370e-26};
    dmb_series_twice(gamma, 9, x, shape->gamma);
    dmb_series(beta, 9, x, shape->beta);
    dmb_series(odd, 9, x, shape->odd);
    dmb_series(square, 10, x, shape->square);
    dmb_series(even, 11, x, shape->even);
    dmb_series(sine, 12, x, shape->sine);
}

/* out = (f - k) y, k for the lateral components */
static inline void dmb_curved_scale(const dmb_curved_constants *c, dmb_real f, const dmb_real y[3], dmb_real out[3])
{
    dmb_vec3_set(f * y[0], (f - c->offset[0]) * y[1], (f - c->offset[1]) * y[2], out);
}

/* U with the first moment of the bending shapes, and the axis of the sections with their rotation. */
static inline void dmb_curved_spread(const dmb_curved_constants *c, const dmb_real y[3], dmb_real out[3])
{
    dmb_vec3_set(y[0], (1.0 + 12.0 * c->offset[0]) * y[1], (1.0 + 12.0 * c->offset[1]) * y[2], out);
}
static inline void dmb_curved_tilt(const dmb_curved_constants *c, const dmb_real y[3], dmb_real along, dmb_real out[3])
{
    dmb_vec3_set(along, c->tilt[0] * y[1], c->tilt[1] * y[2], out);
}

static inline void dmb_curved_shape_at(const dmb_curved_constants *c, const dmb_real d[6], dmb_curved_shape *shape)
{
    const dmb_real *O = d + 3, x = dmb_vec3_norm_squared(O);
    dmb_vec6_copy(d, shape->d);
    dmb_so3_inverse_coefficients_at(x, &shape->k);
    dmb_so3_coefficients_at(0.25 * x, &shape->half);
    dmb_curved_integrals(x, shape);
    dmb_curved_scale(c, shape->gamma[0], d, shape->G);
    dmb_vec3_cross(shape->G, O, shape->z);
    dmb_curved_spread(c, d, shape->U);
    dmb_vec3_cross(O, shape->U, shape->Z);
    dmb_vec3_cross(O, shape->Z, shape->W);
    dmb_curved_tilt(c, d, dmb_real_of(1.0), shape->e);
    dmb_vec3_cross(O, shape->e, shape->f);
    dmb_vec3_cross(O, shape->f, shape->g);
}

/* Rotates from the axes of end A (side 1) or B (side -1) to those of the middle, and back: exp(-+O/2). */
static inline void dmb_curved_to_middle(const dmb_curved_shape *shape, double side, const dmb_real y[3],
                                        dmb_real out[3])
{
    dmb_so3_polynomial_apply(shape->d + 3, (-0.5 * side) * shape->half.a, 0.25 * shape->half.b, y, out);
}
static inline void dmb_curved_from_middle(const dmb_curved_shape *shape, double side, const dmb_real y[3],
                                          dmb_real out[3])
{
    dmb_curved_to_middle(shape, -side, y, out);
}

#endif
