/* Constants of flexible elements and rigid masses, computed once by the compile step. */
#ifndef DMB_ELEMENT_ELEMENT_TYPE_H
#define DMB_ELEMENT_ELEMENT_TYPE_H

#include <stdint.h>

/* Mass of an axisymmetric beam, constant in the body frame: laterally consistent (Timoshenko cubic, eq:beam.mass);
 * axially and in torsion a blend of consistent and lumped mass (model/section.c). bending[plane]: plane 0 is (u_y,
 * theta_z), plane 1 is (u_z, -theta_y); six numbers each:
 *   [0] u_A u_A = u_B u_B   [1] u_A t_A = -u_B t_B   [2] u_A u_B   [3] u_A t_B = -u_B t_A   [4] t_A t_A = t_B t_B   [5]
 *   t_A
 * t_B */
typedef struct dmb_beam_mass {
    double axial[2];   /* [kg] AA = BB, AB */
    double torsion[2]; /* [kg m2] AA = BB, AB */
    double bending[2][6];
} dmb_beam_mass;

/* Mass of a curved element (element/curved_mass.h): constants of J, the mean axes and C. mass = 0: the element has the
 * constant mass. */
typedef struct dmb_curved_mass {
    double mass;      /* [kg] */
    double rotary[2]; /* [kg m2] of all sections about the axis and about a diameter */
    double moving[6]; /* [kg, kg m2] C: inertia of d' relative to the mean axes and the centre */
    double turn[2];   /* [1/m] Gamma: angular velocity of the mean axes per unit of d'_y about z, of d'_z about -y */
    double offset[2]; /* [-] k = q/60: first moment of the bending shapes, planes y and z, q = 1/(1 + P) */
    double tilt[2];   /* [1/m] q/L: mean rotation of the sections per unit of d_y, d_z */
    /* [N/m, N, N m] K above its diagonal, row by row, if the unstressed shape is curved; otherwise 0 */
    double cross[15];
    dmb_beam_mass apart; /* lateral added mass of mud, constant in the frames of the ends */
} dmb_curved_mass;

/* Constants that equal elements share. */
typedef struct dmb_element_type {
    double length;              /* [m] between its two ends, without rigid arms */
    double stiffness[6];        /* [N/m, N m/rad] K/L, shear stiffness corrected: 1/GA* = 1/GA + L^2/(12 EI) */
    double coupling[2];         /* [1/m] b of the planes y and z (eq:beam.axial-shear) */
    double bend[2];             /* [-] h (eq:beam.curvature-softening) */
    double strain_stiffness[6]; /* [N, N m2] K itself, uncorrected shear (for queries) */
    double damping_time;        /* [s] tau; 0 if damping is neglected */
    double rest[6];             /* [m, rad] d0 = L (1, 0, 0, curvature) */
    double arm[2];              /* [m] along x from node a to the element's end A, and from its end B to node b */
    dmb_beam_mass mass;         /* the whole mass if the element is straight */
    dmb_curved_mass curved;
    double mass_per_metre; /* [kg/m] of steel */
    double mud_per_metre;  /* [kg/m] added mass of mud, across the axis only */
    double weight_mass;    /* [kg] mass of the element on which gravity acts, minus buoyancy */
    double displaced;      /* [m3] volume of fluid displaced */
} dmb_element_type;

static inline int dmb_element_is_curved(const dmb_element_type *type)
{
    return type->curved.mass > 0.0;
}

/* The part of the mass that does not change when the element bends. */
static inline const dmb_beam_mass *dmb_element_constant_mass(const dmb_element_type *type)
{
    return dmb_element_is_curved(type) ? &type->curved.apart : &type->mass;
}

/* Rigid mass fixed to a node: tool joint, bit, rig head, rigid pipes, free body, eccentric part of pipes. Symmetric
 * spatial inertia at the node's reference point, body frame: [m I, -b~; b~, J]. `mass` is 0 if only an eccentric part
 * was added. */
typedef struct dmb_rigid_mass {
    double mass;       /* [kg] */
    double moment[3];  /* [kg m] b = mass times centre */
    double inertia[6]; /* [kg m2] xx, yy, zz, xy, xz, yz elements of J at the reference point */
    uint32_t node;
    uint32_t reserved;
} dmb_rigid_mass;

/* Added mass of mud on the rigid parts of a node, along its x axis and laterally (element/added_mass.h). */
typedef struct dmb_added_mass {
    double along;     /* [kg] */
    double across[3]; /* [kg, kg m, kg m2] integrals of 1, x, x^2 over slices, x from the node */
    uint32_t node;
    uint32_t reserved;
} dmb_added_mass;

#endif
