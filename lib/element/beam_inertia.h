/* Inertia of the flexible element (THEORY 3), in a number that is a double or lanes of doubles: the consistent mass of
 * the Timoshenko cubic, constant in the body frames of both ends, its momentum p = M v, the wrench p' + v^ p it takes,
 * and the derivatives of that for the iteration matrix. */
#ifndef DMB_ELEMENT_BEAM_INERTIA_H
#define DMB_ELEMENT_BEAM_INERTIA_H

#include "element/beam_math.h"

/* One bending plane: u and t of both ends; the second plane enters with t = -theta_y. */
static inline void dmb_beam_bending_times(const dmb_real m[6], dmb_real ua, dmb_real ta, dmb_real ub, dmb_real tb,
                                          dmb_real out[4])
{
    out[0] = m[0] * ua + m[1] * ta + m[2] * ub + m[3] * tb;
    out[1] = m[1] * ua + m[4] * ta - m[3] * ub + m[5] * tb;
    out[2] = m[2] * ua - m[3] * ta + m[0] * ub - m[1] * tb;
    out[3] = m[3] * ua + m[5] * ta - m[1] * ub + m[4] * tb;
}

/* Momentum p = M v of both ends [kg m/s, kg m2/s]; the same product gives M times accelerations. */
static inline void dmb_beam_momentum(const dmb_beam_constants *mass, const dmb_real va[6], const dmb_real vb[6],
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

/* The ten numbers of one 6x6 block of M: axial, torsion and per plane uu, ut, tu, tt. */
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

/* out += L M_block, or = where it is fresh; M_block has entries (0,0) (3,3), (1,1) (1,5) (5,1) (5,5), (2,2) (2,4) (4,2)
 * (4,4) */
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

/* Adds mass_factor M + velocity_factor C_t to blocks, or writes it to fresh ones;
 * C_t = -blkdiag(v^^T) M - blkdiag(A(p)) (gyroscopic). */
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

#endif
