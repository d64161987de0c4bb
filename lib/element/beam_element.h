/* The flexible element as used by steps: inertia, and all of its terms together. */
#ifndef DMB_ELEMENT_BEAM_ELEMENT_H
#define DMB_ELEMENT_BEAM_ELEMENT_H

#include "element/beam_math.h"
#include "element/curved_element.h"

/* Inertia of the flexible element (eq:beam.mass, eq:motion.euler-poincare), for numbers that are doubles or lanes of
 * doubles: the consistent mass of the Timoshenko cubic, constant in the body frames of both ends, its momentum p = M v,
 * the inertia wrench p' + v^ p, and its derivatives for the iteration matrix. */

/* One bending plane: u and t of both ends; for the second plane t = -theta_y. */
DMB_REAL_INLINE void dmb_beam_bending_times(const dmb_real m[6], dmb_real ua, dmb_real ta, dmb_real ub, dmb_real tb,
                                            dmb_real out[4])
{
    out[0] = m[0] * ua + m[1] * ta + m[2] * ub + m[3] * tb;
    out[1] = m[1] * ua + m[4] * ta - m[3] * ub + m[5] * tb;
    out[2] = m[2] * ua - m[3] * ta + m[0] * ub - m[1] * tb;
    out[3] = m[3] * ua + m[5] * ta - m[1] * ub + m[4] * tb;
}

/* Momentum p = M v of both ends [kg m/s, kg m2/s]; the same product gives M times accelerations. */
DMB_REAL_INLINE void dmb_beam_momentum(const dmb_beam_constants *mass, const dmb_real va[6], const dmb_real vb[6],
                                       dmb_real pa[6], dmb_real pb[6])
{
    dmb_real y[4], z[4];
    dmb_beam_bending_times(mass->bending[0], va[1], va[5], vb[1], vb[5], y);
    dmb_beam_bending_times(mass->bending[1], va[2], -va[4], vb[2], -vb[4], z);
    pa[0] = mass->axial[0] * va[0] + mass->axial[1] * vb[0];
    pb[0] = mass->axial[1] * va[0] + mass->axial[0] * vb[0];
    pa[3] = mass->torsion[0] * va[3] + mass->torsion[1] * vb[3];
    pb[3] = mass->torsion[1] * va[3] + mass->torsion[0] * vb[3];
    pa[1] = y[0], pa[5] = y[1], pb[1] = y[2], pb[5] = y[3];
    pa[2] = z[0], pa[4] = -z[1], pb[2] = z[2], pb[4] = -z[3];
}

/* The ten coefficients of one 6x6 block of M: axial, torsion and per plane uu, ut, tu, tt. */
typedef struct dmb_beam_mass_block {
    dmb_real axial, torsion, uu[2], ut[2], tu[2], tt[2];
} dmb_beam_mass_block;

static inline void dmb_beam_block_aa(const dmb_beam_constants *m, double side, dmb_beam_mass_block *out)
{
    out->axial = m->axial[0];
    out->torsion = m->torsion[0];
    for (int p = 0; p < 2; p++) {
        out->uu[p] = m->bending[p][0];
        out->ut[p] = out->tu[p] = dmb_real_of(side) * m->bending[p][1];
        out->tt[p] = m->bending[p][4];
    }
}

static inline void dmb_beam_block_ab(const dmb_beam_constants *m, double side, dmb_beam_mass_block *out)
{
    out->axial = m->axial[1];
    out->torsion = m->torsion[1];
    for (int p = 0; p < 2; p++) {
        out->uu[p] = m->bending[p][2];
        out->ut[p] = dmb_real_of(side) * m->bending[p][3];
        out->tu[p] = -out->ut[p];
        out->tt[p] = m->bending[p][5];
    }
}

/* out += L M_block, or out = L M_block if `fresh`; M_block has entries (0,0) (3,3), (1,1) (1,5) (5,1) (5,5), (2,2)
 * (2,4) (4,2) (4,4) */
static inline void dmb_beam_add_times_block(const dmb_real L[36], const dmb_beam_mass_block *m, int fresh,
                                            dmb_real out[36])
{
    for (int i = 0; i < 36; i += 6) {
        const dmb_real row[6] = {L[i] * m->axial,
                                 L[i + 1] * m->uu[0] + L[i + 5] * m->tu[0],
                                 L[i + 2] * m->uu[1] - L[i + 4] * m->tu[1],
                                 L[i + 3] * m->torsion,
                                 L[i + 4] * m->tt[1] - L[i + 2] * m->ut[1],
                                 L[i + 1] * m->ut[0] + L[i + 5] * m->tt[0]};
        for (int j = 0; j < 6; j++) out[i + j] = fresh ? row[j] : out[i + j] + row[j];
    }
}

/* L = mass_factor I - velocity_factor v^^T */
static inline void dmb_beam_inertia_rows(const dmb_real v[6], dmb_real mass_factor, dmb_real velocity_factor,
                                         dmb_real L[36])
{
    dmb_mat6_zero(L);
    dmb_mat6_add_skew(velocity_factor, v + 3, 0, 0, L);
    dmb_mat6_add_skew(velocity_factor, v + 3, 1, 1, L);
    dmb_mat6_add_skew(velocity_factor, v, 1, 0, L);
    for (int i = 0; i < 36; i += 7) L[i] += mass_factor;
}

/* out -= factor A(p), A(p) = [0, pu~; pu~, pw~] */
static inline void dmb_beam_subtract_momentum(const dmb_real p[6], dmb_real factor, dmb_real out[36])
{
    dmb_mat6_add_skew(-factor, p, 0, 1, out);
    dmb_mat6_add_skew(-factor, p, 1, 0, out);
    dmb_mat6_add_skew(-factor, p + 3, 1, 1, out);
}

/* Adds mass_factor M + velocity_factor C_t to blocks, or overwrites them if `fresh`;
 *     C_t = -blkdiag(v^^T) M - blkdiag(A(p)) (eq:motion.gyroscopic). */
static inline void dmb_beam_add_inertia_blocks(const dmb_beam_constants *mass, const dmb_real va[6],
                                               const dmb_real vb[6], const dmb_real pa[6], const dmb_real pb[6],
                                               dmb_real mass_factor, dmb_real velocity_factor, int fresh,
                                               dmb_beam_blocks *blocks)
{
    dmb_real L[36];
    dmb_beam_mass_block m;
    dmb_beam_inertia_rows(va, mass_factor, velocity_factor, L);
    dmb_beam_block_aa(mass, 1.0, &m);
    dmb_beam_add_times_block(L, &m, fresh, blocks->aa);
    dmb_beam_block_ab(mass, 1.0, &m);
    dmb_beam_add_times_block(L, &m, fresh, blocks->ab);
    dmb_beam_subtract_momentum(pa, velocity_factor, blocks->aa);
    dmb_beam_inertia_rows(vb, mass_factor, velocity_factor, L);
    dmb_beam_block_aa(mass, -1.0, &m);
    dmb_beam_add_times_block(L, &m, fresh, blocks->bb);
    dmb_beam_block_ab(mass, -1.0, &m);
    dmb_beam_add_times_block(L, &m, fresh, blocks->ba);
    dmb_beam_subtract_momentum(pb, velocity_factor, blocks->bb);
}

/* All terms of one flexible element (or of lanes of elements): from the poses and motion of its two nodes to forces,
 * power and tangent blocks at those nodes. Every kernel uses this order of operations. */

/* Requested quantities of elements, the same for all lanes. */
typedef struct dmb_beam_task {
    double mass_factor, velocity_factor; /* d v'/d pose parameters, d v/d pose parameters */
    int32_t dynamic;                     /* 0: no inertia, damping, nor rates */
    int32_t tangent;                     /* 1: tangent blocks are computed */
    /* 1: geometric stiffness from the given stress, 0: from the actual stress, which is returned */
    int32_t extrapolated;
    int32_t rates;         /* 1: strain rates are required, for the energy ledger or for damping */
    int32_t damped;        /* 1: damping_time is not 0 for all elements */
    int32_t inertia_only;  /* 1: blocks without the stiffness */
    int32_t arms;          /* 1: some ends have arms to their nodes */
    int32_t curved;        /* 1: elements that are curved, with their own mass and weight (element/curved_mass.h) */
    const double *gravity; /* [m/s2] times the load factor, world, shape (3); NULL: no gravity. Used if curved. */
} dmb_beam_task;

typedef struct dmb_beam_input {
    dmb_real qa[4], qb[4]; /* orientations of the nodes */
    dmb_real Ra[9];        /* rotation matrix of the first node */
    dmb_real span[3];      /* [m] from node A to node B, world */
    dmb_real reach;        /* [m] magnitude of the positions whose difference is the span */
    dmb_real va[6], vb[6]; /* velocities of the nodes, body frame */
    dmb_real aa[6], ab[6]; /* their rates */
    dmb_real za[6], zb[6]; /* [m, rad] increments of pose h Dq over the step */
} dmb_beam_input;

typedef struct dmb_beam_output {
    dmb_real strain[6];                   /* d */
    dmb_real stress[6];                   /* in: if extrapolated; out: otherwise; used for the geometric stiffness */
    dmb_real fa[6], fb[6];                /* forces on the residual side, at the nodes */
    dmb_real scale_a[6], scale_b[6];      /* sums of magnitudes of their terms */
    dmb_real rounding;                    /* [N2] square of the rounding error */
    dmb_real potential, damping, inertia; /* [W] */
    dmb_beam_blocks K, C; /* stiffness by pose; inertia and damping by motion. If dynamic, K.ab and K.ba are already
                             blocks of the iteration matrix: K T6(h Dq) + C */
} dmb_beam_output;

static inline void dmb_beam_add_magnitudes(const dmb_real force[6], dmb_real scale[6])
{
    for (int i = 0; i < 6; i++) scale[i] += dmb_real_abs(force[i]);
}

static inline void dmb_beam_add_cross_damping(const dmb_beam_constants *c, const dmb_curved_constants *curved,
                                              const dmb_real rate[6], dmb_real stress[6], dmb_beam_output *out)
{
    dmb_real viscous[6];
    for (int i = 0; i < 6; i++) viscous[i] = dmb_real_of(0.0);
    dmb_curved_add_cross(curved->cross, rate, viscous);
    for (int i = 0; i < 6; i++) {
        out->damping += c->damping_time * viscous[i] * rate[i];
        stress[i] += c->damping_time * viscous[i];
    }
}

/* Elastic and damping stress, their power, and the stress for the geometric stiffness. */
DMB_REAL_INLINE void dmb_beam_internal_force(const dmb_beam_task *task, const dmb_beam_constants *c,
                                             const dmb_curved_constants *curved, const dmb_beam_shape *shape,
                                             const dmb_beam_input *in, dmb_beam_output *out)
{
    const dmb_real *va = in->va, *vb = in->vb;
    dmb_real stress[6], rate[6];
    dmb_beam_elastic_stress(c, shape, stress);
    if (task->curved) dmb_curved_add_cross_stress(curved, c, shape, stress);
    dmb_vec6_copy(shape->d, out->strain);
    if (task->damped && task->rates) {
        dmb_beam_strain_rate(shape, va, vb, rate);
        out->potential = dmb_vec6_dot(stress, rate);
        for (int i = 0; i < 6; i++) {
            const dmb_real viscous = c->damping_time * c->stiffness[i] * rate[i];
            out->damping += viscous * rate[i];
            stress[i] += viscous;
        }
        if (task->curved) dmb_beam_add_cross_damping(c, curved, rate, stress, out);
    }
    if (!task->extrapolated) dmb_vec6_copy(stress, out->stress); /* viscous part included */
    dmb_beam_add_force(shape, stress, out->fa, out->fb);
    if (task->rates && !task->damped) out->potential = dmb_vec6_dot(out->fa, va) + dmb_vec6_dot(out->fb, vb); /* S.e' */
    dmb_beam_add_magnitudes(out->fa, out->scale_a);
    dmb_beam_add_magnitudes(out->fb, out->scale_b);
}

/* f = M v' - v^^T p at both ends; the gyroscopic part does no work. */
DMB_REAL_INLINE void dmb_beam_inertia_force(const dmb_beam_constants *c, const dmb_beam_input *in, const dmb_real pa[6],
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

/* K <- K T6(z) + C, or C only */
static inline void dmb_beam_off_diagonal(const dmb_real z[6], const dmb_real C[36], int stiff, dmb_real K[36])
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
}

static inline void dmb_beam_to_nodes(const dmb_beam_task *task, const dmb_beam_constants *c, dmb_beam_output *out)
{
    dmb_beam_blocks_to_nodes(c->arm, &out->K);
    if (task->dynamic) dmb_beam_blocks_to_nodes(c->arm, &out->C);
}

/* Off-diagonal blocks in the form required by the iteration matrix. */
static inline void dmb_beam_off_diagonals(const dmb_beam_task *task, const dmb_beam_input *in, dmb_beam_output *out)
{
    dmb_beam_off_diagonal(in->zb, out->C.ab, !task->inertia_only, out->K.ab);
    dmb_beam_off_diagonal(in->za, out->C.ba, !task->inertia_only, out->K.ba);
}

static inline void dmb_beam_clear(dmb_beam_output *out)
{
    for (int i = 0; i < 6; i++) out->fa[i] = out->fb[i] = out->scale_a[i] = out->scale_b[i] = dmb_real_of(0.0);
    out->rounding = out->potential = out->damping = out->inertia = dmb_real_of(0.0);
}

/* Tangent of the part of the stiffness that couples components of e: B^T X B, and tau times the same with the change of
 * e'. */
static inline void dmb_beam_add_cross_tangent(const dmb_beam_task *task, const dmb_beam_constants *c,
                                              const dmb_curved_constants *curved, const dmb_beam_shape *shape,
                                              const dmb_beam_input *in, dmb_beam_output *out)
{
    dmb_real B[12][6], Y[12][6], v[12];
    dmb_curved_strain_columns(shape, B);
    if (!task->inertia_only) dmb_curved_add_cross_product(curved->cross, dmb_real_of(1.0), B, B, &out->K);
    if (!task->dynamic || !task->damped) return;
    dmb_curved_add_cross_product(curved->cross, task->velocity_factor * c->damping_time, B, B, &out->C);
    if (task->inertia_only) return;
    dmb_vec6_copy(in->va, v);
    dmb_vec6_copy(in->vb, v + 6);
    dmb_curved_rate_columns(curved, c, shape, v, Y);
    dmb_curved_add_cross_product(curved->cross, c->damping_time, B, Y, &out->K);
}

/* Adds the forces of a curved element and their tangent to the contributions of the constant part of its mass. */
static inline void dmb_beam_add_curved(const dmb_beam_task *task, const dmb_curved_constants *c,
                                       const dmb_beam_shape *at, const dmb_beam_input *in, dmb_beam_output *out)
{
    const double factor[2] = {task->mass_factor, task->velocity_factor}, none[3] = {0.0, 0.0, 0.0};
    dmb_curved_shape shape;
    dmb_curved_state state = {.dynamic = task->dynamic};
    dmb_real f[12], w[12];
    for (int i = 0; i < 12; i++) f[i] = w[i] = dmb_real_of(0.0);
    dmb_curved_shape_at(c, at->d, &shape);
    dmb_curved_weight(c, &shape, in->Ra, task->gravity ? task->gravity : none, state.weight);
    dmb_curved_add_weight(c, &shape, state.weight, w);
    if (task->rates) out->potential += dmb_vec6_dot(w, in->va) + dmb_vec6_dot(w + 6, in->vb);
    if (task->dynamic) {
        dmb_vec6_copy(in->va, state.v);
        dmb_vec6_copy(in->vb, state.v + 6);
        dmb_vec6_copy(in->aa, state.a);
        dmb_vec6_copy(in->ab, state.a + 6);
        dmb_curved_add_inertia(c, &shape, state.v, state.a, f);
        out->inertia += dmb_vec6_dot(f, in->va) + dmb_vec6_dot(f + 6, in->vb);
    }
    for (int i = 0; i < 6; i++) {
        out->fa[i] += f[i] + w[i];
        out->fb[i] += f[6 + i] + w[6 + i];
        out->scale_a[i] += dmb_real_abs(f[i]) + dmb_real_abs(w[i]);
        out->scale_b[i] += dmb_real_abs(f[6 + i]) + dmb_real_abs(w[6 + i]);
    }
    if (!task->tangent) return;
    if (!task->inertia_only) dmb_curved_add_shape_tangent(c, &shape, &state, &out->K);
    if (!task->inertia_only) dmb_curved_add_weight_tangent(c, &shape, &state, &out->K);
    if (task->dynamic) dmb_curved_add_motion_tangent(c, &shape, &state, factor, &out->C);
}

/* Computes one element. Returns 0, or -1 if the relative rotation of a lane is above DMB_BEAM_ROTATION_MAX. `curved` is
 * used if task->curved is set. */
DMB_REAL_INLINE int dmb_beam_element(const dmb_beam_task *task, const dmb_beam_constants *c,
                                     const dmb_curved_constants *curved, dmb_beam_input *in, dmb_beam_output *out)
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
    dmb_beam_internal_force(task, c, curved, &shape, in, out);
    for (int i = 0; i < 6; i++) pa[i] = pb[i] = dmb_real_of(0.0);
    if (task->dynamic) {
        dmb_beam_momentum(c, in->va, in->vb, pa, pb);
        dmb_beam_inertia_force(c, in, pa, pb, out);
    }
    if (task->tangent) dmb_beam_tangent(task, c, &shape, in->va, in->vb, pa, pb, out);
    if (task->curved) dmb_beam_add_curved(task, curved, &shape, in, out);
    if (task->curved && task->tangent) dmb_beam_add_cross_tangent(task, c, curved, &shape, in, out);
    if (task->tangent && task->arms) dmb_beam_to_nodes(task, c, out);
    if (task->tangent && task->dynamic) dmb_beam_off_diagonals(task, in, out);
    if (!task->arms) return 0;
    dmb_arm_wrench(c->arm[0], out->fa);
    dmb_arm_wrench(-c->arm[1], out->fb);
    return 0;
}

#endif
