/* Constants of elements that are bent: mass (element/curved_mass.h) and, where the unstressed shape is, stiffness. */
#include <math.h>

#include "math/dense.h"
#include "math/mat6.h"
#include "math/se3.h"
#include "model/section.h"

/* ---- Mass -------------------------------------------------------------------------------------------------------- */

/* One bending plane of the ratio P = 12 EI/(GA L^2): eq:curved.mean-axes, and the first moment and mean turn of the
 * bending shapes (eq:curved.line). */
static void mass_of_plane(double length, double ratio, int plane, dmb_curved_mass *curved)
{
    const double q = 1.0 / (1.0 + ratio), m = curved->mass, rotary = curved->rotary[1];
    const double moment = m * length * (1.0 / 12.0 + q / 60.0) + rotary * q / length;
    const double inertia = m * length * length / 12.0 + rotary;
    const double own = m * (1.0 / 12.0 + q / 30.0 + q * q / 210.0) + 1.2 * rotary * q * q / (length * length);
    curved->turn[plane] = moment / inertia;
    curved->moving[1 + plane] = own - moment * moment / inertia;
    curved->offset[plane] = q / 60.0;
    curved->tilt[plane] = q / length;
}

/* Along and around, half the difference of the ends' speeds meets the difference of both entries of the mass. */
static void make_mass(const dmb_pipe_section *section, dmb_element_type *type)
{
    static const double whole[2] = {1.0, 1.0};
    const double L = type->length, *K = section->stiffness;
    dmb_curved_mass *curved = &type->curved;
    dmb_beam_mass steel;
    dmb_beam_mass_of(section, L, whole, &steel);
    curved->mass = section->mass * L;
    curved->rotary[0] = section->inertia[0] * L;
    curved->rotary[1] = section->inertia[1] * L;
    curved->moving[0] = 0.5 * (type->mass.axial[0] - type->mass.axial[1]);
    curved->moving[3] = 0.5 * (type->mass.torsion[0] - type->mass.torsion[1]);
    curved->moving[4] = curved->moving[5] = curved->mass * L * L / 720.0 + curved->rotary[1] / 12.0;
    for (int p = 0; p < 2; ++p) {
        mass_of_plane(L, dmb_shear_ratio(K[5 - p], K[1 + p], L), p, curved);
        for (int k = 0; k < 6; ++k) curved->apart.bending[p][k] = type->mass.bending[p][k] - steel.bending[p][k];
    }
}

/* ---- Stiffness --------------------------------------------------------------------------------------------------- */

/* A (6, 6) with A v = ad(d) v = (O x u + U x w; O x w) of v = (u; w). */
static void adjoint_of(const double d[6], double A[36])
{
    for (int k = 0; k < 6; ++k) {
        double v[6] = {0.0}, out[6];
        v[k] = 1.0;
        dmb_ad_apply(d, v, out);
        for (int i = 0; i < 6; ++i) A[6 * i + k] = out[i];
    }
}

/* F of eq:curved.flexibility with the part across the plane of the bend, eq:curved.sideways. */
static void flexibility_of(const dmb_pipe_section *section, const dmb_element_type *type, double F[36])
{
    const double *d = type->rest, *K = section->stiffness, L = type->length;
    const double bend = d[4] * d[4] + d[5] * d[5], cube = L * L * L;
    double A[36];
    adjoint_of(d, A);
    for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j) {
            double sum = 0.0;
            for (int k = 0; k < 6; ++k) sum += A[6 * i + k] * A[6 * j + k] / K[k];
            F[6 * i + j] = L * (sum / 12.0 + (i == j ? 1.0 / K[i] : 0.0));
        }
    const double EI = bend > 0.0 ? bend / (d[5] * d[5] / K[4] + d[4] * d[4] / K[5]) : K[4]; /* out of the plane */
    for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j)
            F[6 * (1 + i) + 1 + j] += cube * d[4 + i] * d[4 + j] * (1.0 / (360.0 * EI) + 1.0 / (720.0 * K[3]));
}

/* K = 1/F; false, with the straight stiffness kept, where that does not exist in numbers. */
static bool make_stiffness(const dmb_pipe_section *section, dmb_element_type *type)
{
    double F[36], K[36] = {0.0};
    uint32_t pivot[6];
    int at = 0;
    flexibility_of(section, type, F);
    for (int i = 0; i < 36; i += 7) K[i] = 1.0;
    if (dmb_dense_factor(6, F, pivot) >= 0) return false;
    dmb_dense_solve(6, 6, F, pivot, K);
    for (int i = 0; i < 6; ++i) {
        type->stiffness[i] = K[7 * i];
        for (int j = i + 1; j < 6; ++j) type->curved.cross[at++] = 0.5 * (K[6 * i + j] + K[6 * j + i]);
    }
    return true;
}

void dmb_element_make_curved(const dmb_pipe_def *def, dmb_element_type *type)
{
    dmb_pipe_section section;
    dmb_section_of(def, &section);
    make_mass(&section, type);
    if (fabs(def->curvature[1]) > 0.0 || fabs(def->curvature[2]) > 0.0) (void)make_stiffness(&section, type);
}
