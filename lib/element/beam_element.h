/* Everything of one flexible element (or of lanes of them): from the poses and motion of its two nodes to forces,
 * power and tangent blocks at those nodes. The order of operations here is that of every kernel. */
#ifndef DMB_ELEMENT_BEAM_ELEMENT_H
#define DMB_ELEMENT_BEAM_ELEMENT_H

#include "element/beam_inertia.h"
#include "element/beam_math.h"

/* Quantities wanted of elements, the same for all lanes. */
typedef struct dmb_beam_task {
    double mass_factor, velocity_factor; /* d v'/d pose parameters, d v/d pose parameters */
    int32_t dynamic;                     /* 0: no inertia, damping, nor rates */
    int32_t tangent;                     /* 1: blocks too */
    int32_t extrapolated; /* 1: geometric stiffness with the stress given, 0: with the true one, which is given back */
    int32_t rates;        /* 1: strain rates are needed, for the energy ledger or for damping */
    int32_t damped;       /* 1: damping_time is not 0 everywhere */
    int32_t inertia_only; /* 1: blocks without the stiffness */
    int32_t arms;         /* 1: some ends stand off their nodes */
} dmb_beam_task;

typedef struct dmb_beam_input {
    dmb_real qa[4], qb[4]; /* orientations of the nodes */
    dmb_real Ra[9];        /* the first one's rotation matrix */
    dmb_real span[3];      /* [m] from node A to node B, world */
    dmb_real reach;        /* [m] size of the numbers that the span is the difference of */
    dmb_real va[6], vb[6]; /* velocities of the nodes, body frame */
    dmb_real aa[6], ab[6]; /* their rates */
    dmb_real za[6], zb[6]; /* [m, rad] increments of pose h Dq over the step */
} dmb_beam_input;

typedef struct dmb_beam_output {
    dmb_real strain[6];                   /* d */
    dmb_real stress[6];                   /* in: if extrapolated; out: if not; for the geometric stiffness */
    dmb_real fa[6], fb[6];                /* forces on the residual side, at the nodes */
    dmb_real scale_a[6], scale_b[6];      /* sums of magnitudes of their terms */
    dmb_real rounding;                    /* [N2] */
    dmb_real potential, damping, inertia; /* [W] */
    dmb_beam_blocks K, C; /* stiffness by pose; inertia and damping by motion. When dynamic, K.ab and K.ba are
                             blocks of the iteration matrix already: K T6(h Dq) + C */
} dmb_beam_output;

static inline void dmb_beam_add_magnitudes(const dmb_real force[6], dmb_real scale[6])
{
    for (int i = 0; i < 6; i++) scale[i] += dmb_real_abs(force[i]);
}

/* Elastic and damping stress, their power, and the stress for the geometric stiffness. */
static inline void dmb_beam_internal_force(const dmb_beam_task *task, const dmb_beam_constants *c,
                                           const dmb_beam_shape *shape, const dmb_real va[6], const dmb_real vb[6],
                                           dmb_beam_output *out)
{
    dmb_real stress[6], rate[6];
    dmb_beam_elastic_stress(c, shape, stress);
    dmb_vec6_copy(shape->d, out->strain);
    if (task->rates) {
        dmb_beam_strain_rate(shape, va, vb, rate);
        out->potential = dmb_vec6_dot(stress, rate);
        for (int i = 0; task->damped && i < 6; i++) {
            const dmb_real viscous = c->damping_time * c->stiffness[i] * rate[i];
            out->damping += viscous * rate[i];
            stress[i] += viscous;
        }
    }
    if (!task->extrapolated) dmb_vec6_copy(stress, out->stress); /* the viscous part too */
    dmb_beam_add_force(shape, stress, out->fa, out->fb);
    dmb_beam_add_magnitudes(out->fa, out->scale_a);
    dmb_beam_add_magnitudes(out->fb, out->scale_b);
}

/* f = M v' - v^^T p at both ends; the gyroscopic part does no work. */
static inline void dmb_beam_inertia_force(const dmb_beam_constants *c, const dmb_beam_input *in, const dmb_real pa[6],
                                          const dmb_real pb[6], dmb_beam_output *out)
{
    const dmb_real *va = in->va, *vb = in->vb;
    dmb_real fa[6], fb[6], ga[6], gb[6];
    dmb_beam_momentum(c, in->aa, in->ab, fa, fb);
    out->inertia = dmb_vec6_dot(va, fa) + dmb_vec6_dot(vb, fb);
    dmb_ad_transpose(va, pa, ga);
    dmb_ad_transpose(vb, pb, gb);
    for (int i = 0; i < 6; i++) {
        fa[i] -= ga[i];
        fb[i] -= gb[i];
        out->fa[i] += fa[i];
        out->fb[i] += fb[i];
    }
    dmb_beam_add_magnitudes(fa, out->scale_a);
    dmb_beam_add_magnitudes(fb, out->scale_b);
}

static inline void dmb_beam_clear_blocks(dmb_beam_blocks *blocks)
{
    dmb_mat6_zero(blocks->aa);
    dmb_mat6_zero(blocks->ab);
    dmb_mat6_zero(blocks->ba);
    dmb_mat6_zero(blocks->bb);
}

/* K <- K T6(z) + C, or C alone */
static inline void dmb_beam_link(const dmb_real z[6], const dmb_real C[36], int stiff, dmb_real K[36])
{
    dmb_se3_tangent T;
    if (!stiff) {
        dmb_mat6_copy(C, K);
        return;
    }
    dmb_se3_tangent_at(z, NULL, &T);
    dmb_se3_times_tangent(K, 6, &T);
    dmb_mat6_add(K, C, K);
}

static inline void dmb_beam_tangent(const dmb_beam_task *task, const dmb_beam_constants *c, const dmb_beam_shape *shape,
                                    const dmb_real va[6], const dmb_real vb[6], const dmb_real pa[6],
                                    const dmb_real pb[6], dmb_beam_output *out)
{
    const dmb_real factor = dmb_real_of(task->velocity_factor);
    if (task->dynamic && task->damped)
        dmb_beam_damped_blocks(c, shape, out->stress, va, vb, factor, &out->K, &out->C);
    else if (!task->inertia_only)
        dmb_beam_stiffness_blocks(c, shape, out->stress, &out->K);
    if (task->inertia_only) dmb_beam_clear_blocks(&out->K);
    if (task->dynamic) {
        dmb_beam_add_inertia_blocks(c, va, vb, pa, pb, dmb_real_of(task->mass_factor), factor, !task->damped, &out->C);
    }
    if (!task->arms) return;
    dmb_beam_blocks_to_nodes(c->arm, &out->K);
    if (task->dynamic) dmb_beam_blocks_to_nodes(c->arm, &out->C);
}

/* The blocks of the link, as the iteration matrix takes them. */
static inline void dmb_beam_links(const dmb_beam_task *task, const dmb_beam_input *in, dmb_beam_output *out)
{
    dmb_beam_link(in->zb, out->C.ab, !task->inertia_only, out->K.ab);
    dmb_beam_link(in->za, out->C.ba, !task->inertia_only, out->K.ba);
}

static inline void dmb_beam_clear(dmb_beam_output *out)
{
    for (int i = 0; i < 6; i++) out->fa[i] = out->fb[i] = out->scale_a[i] = out->scale_b[i] = dmb_real_of(0.0);
    out->rounding = out->potential = out->damping = out->inertia = dmb_real_of(0.0);
}

/* Returns 0, or -1 where the relative rotation of a lane is above DMB_BEAM_ROTATION_MAX. */
static inline int dmb_beam_element(const dmb_beam_task *task, const dmb_beam_constants *c, dmb_beam_input *in,
                                   dmb_beam_output *out)
{
    dmb_beam_shape shape;
    dmb_real pa[6], pb[6];
    dmb_beam_clear(out);
    dmb_beam_shape_at(c, task->arms, in->qa, in->Ra, in->qb, in->span, &shape);
    if (!dmb_beam_rotation_holds(&shape)) return -1;
    if (task->dynamic && task->arms) {
        dmb_arm_velocity(c->arm[0], in->va);
        dmb_arm_velocity(-c->arm[1], in->vb);
        dmb_arm_velocity(c->arm[0], in->aa);
        dmb_arm_velocity(-c->arm[1], in->ab);
    }
    out->rounding = c->stiffness[0] * c->stiffness[0] * in->reach * in->reach;
    dmb_beam_internal_force(task, c, &shape, in->va, in->vb, out);
    for (int i = 0; i < 6; i++) pa[i] = pb[i] = dmb_real_of(0.0);
    if (task->dynamic) {
        dmb_beam_momentum(c, in->va, in->vb, pa, pb);
        dmb_beam_inertia_force(c, in, pa, pb, out);
    }
    if (task->tangent) dmb_beam_tangent(task, c, &shape, in->va, in->vb, pa, pb, out);
    if (task->tangent && task->dynamic) dmb_beam_links(task, in, out);
    if (!task->arms) return 0;
    dmb_arm_wrench(c->arm[0], out->fa);
    dmb_arm_wrench(-c->arm[1], out->fb);
    return 0;
}

#endif
