/* Constants of flexible elements and rigid masses, made once by the compile step. */
#ifndef DMB_ELEMENT_ELEMENT_TYPE_H
#define DMB_ELEMENT_ELEMENT_TYPE_H

#include <stdint.h>

/* Mass of an axisymmetric beam, constant in the body frame: sideways consistent (Timoshenko cubic, eq:beam.mass),
 * along and around half way to a lumped one (model/section.c). bending[plane]: plane 0 is (u_y, theta_z), plane 1 is
 * (u_z, -theta_y); six numbers each:
 *   [0] u_A u_A = u_B u_B   [1] u_A t_A = -u_B t_B   [2] u_A u_B   [3] u_A t_B = -u_B t_A   [4] t_A t_A = t_B t_B   [5]
 *   t_A
 * t_B */
typedef struct dmb_beam_mass {
    double axial[2];   /* [kg] AA = BB, AB */
    double torsion[2]; /* [kg m2] AA = BB, AB */
    double bending[2][6];
} dmb_beam_mass;

/* Mass of an element that is bent (element/curved_mass.h): what J, the mean axes and C need. mass = 0: the element
 * keeps the constant one. */
typedef struct dmb_curved_mass {
    double mass;      /* [kg] */
    double rotary[2]; /* [kg m2] of all sections about the axis, across it */
    double moving[6]; /* [kg, kg m2] C: what d' moves against the mean axes and the centre */
    double turn[2];   /* [1/m] Gamma: speed of the mean axes by d'_y about z, by d'_z about -y */
    double offset[2]; /* [-] k = q/60: first moment of the bending shapes, planes y and z, q = 1/(1 + P) */
    double tilt[2];   /* [1/m] q/L: mean turn of the sections by d_y, d_z */
    double cross[15]; /* [N/m, N, N m] K above its diagonal, row by row, where the unstressed shape is bent; else 0 */
    dmb_beam_mass apart; /* of mud that goes along sideways, constant in the frames of the ends */
} dmb_curved_mass;

/* Constants that equal elements share. */
typedef struct dmb_element_type {
    double length;              /* [m] between its two ends, rigid arms not counted */
    double stiffness[6];        /* [N/m, N m/rad] K/L, shear stiffness corrected: 1/GA* = 1/GA + L^2/(12 EI) */
    double coupling[2];         /* [1/m] b of the planes y and z (eq:beam.axial-shear) */
    double bend[2];             /* [-] h (eq:beam.curvature-softening) */
    double strain_stiffness[6]; /* [N, N m2] K itself, uncorrected shear (for queries) */
    double damping_time;        /* [s] tau; 0 when damping is left out */
    double rest[6];             /* [m, rad] d0 = L (1, 0, 0, curvature) */
    double arm[2];              /* [m] along x from node a to the element's end A, and from its end B to node b */
    dmb_beam_mass mass;         /* all of it where the element is straight */
    dmb_curved_mass curved;
    double mass_per_metre; /* [kg/m] */
    double weight_mass;    /* [kg] of the element that gravity acts on, buoyancy taken off */
    double displaced;      /* [m3] that a fluid of density 1 takes off it */
} dmb_element_type;

static inline int dmb_element_is_curved(const dmb_element_type *type)
{
    return type->curved.mass > 0.0;
}

/* The part of the mass that stays as it is while the element bends. */
static inline const dmb_beam_mass *dmb_element_constant_mass(const dmb_element_type *type)
{
    return dmb_element_is_curved(type) ? &type->curved.apart : &type->mass;
}

/* Rigid mass fixed to a node: tool joint, bit, rig head, rigid pipes, free body, eccentric part of pipes. Symmetric
 * spatial inertia at the node's reference point, body frame: [m I, -b~; b~, J]. `mass` is 0 where only an eccentric
 * part was added. */
typedef struct dmb_rigid_mass {
    double mass;       /* [kg] */
    double moment[3];  /* [kg m] b = mass times centre */
    double inertia[6]; /* [kg m2] xx, yy, zz, xy, xz, yz elements of J at the reference point */
    uint32_t node;
    uint32_t reserved;
} dmb_rigid_mass;

/* Mud that goes along with what is rigid on a node, along its x axis and sideways (element/added_mass.h). */
typedef struct dmb_added_mass {
    double along;     /* [kg] */
    double across[3]; /* [kg, kg m, kg m2] integrals of 1, x, x^2 over slices, x from the node */
    uint32_t node;
    uint32_t reserved;
} dmb_added_mass;

#endif
