/* Properties of a pipe and of its tool joint from diameters and material. */
#ifndef DMB_MODEL_SECTION_H
#define DMB_MODEL_SECTION_H

#include "drillmbd/scene.h"
#include "element/element_type.h"

typedef struct dmb_pipe_section {
    double stiffness[6]; /* [N, N, N, N m2, N m2, N m2] EA, GA_y, GA_z, GJ, EI_y, EI_z */
    double mass;         /* [kg/m] */
    double inertia[2];   /* [kg m] rotary inertia per metre about x and across */
} dmb_pipe_section;

/* A rigid solid of revolution about its own centre. */
typedef struct dmb_rigid_part {
    double mass;       /* [kg] */
    double inertia[2]; /* [kg m2] about the axis and across, at the centre */
} dmb_rigid_part;

/* [m2], [m4] of a ring with these diameters [m]. */
double dmb_ring_area(double outer, double inner);
double dmb_ring_second_moment(double outer, double inner);

/* Tube: A = pi (D^2 - d^2)/4, I = pi (D^4 - d^4)/64, J = 2 I, G = E/(2 (1 + nu)), GA = kappa G A; values given in the
 * definition take precedence. */
void dmb_section_of(const dmb_pipe_def *def, dmb_pipe_section *section);

/* [m] of a pipe without its rigid tool joint. */
double dmb_pipe_body_length(const dmb_pipe_def *def);
/* [1/m] Curvature of the pipe without its tool joint in a hole of the curvature `hole`: the rigid tool joint does not
 * bend (eq:drilling.bending). */
double dmb_body_curvature(const dmb_pipe_def *def, double hole);
/* [m] outer diameter of the tool joint, 0 where there is none. */
double dmb_joint_diameter(const dmb_pipe_def *def);

/* [m] outer and inner diameter of the pipe's body, or of its tool joint. */
void dmb_pipe_diameters(const dmb_pipe_def *def, int in_tool_joint, double diameters[2]);

/* The pipe without its joint as a rigid body, and the tool joint (mass 0 where there is none). */
void dmb_rigid_pipe_of(const dmb_pipe_def *def, dmb_rigid_part *part);
void dmb_joint_of(const dmb_pipe_def *def, dmb_rigid_part *part);
/* A ring on a pipe (or tool joint) of that outer diameter [m]. */
void dmb_ring_body_of(const dmb_stabiliser_def *def, double pipe_diameter, dmb_rigid_part *part);
/* The bit: a solid cylinder unless inertias are given. */
void dmb_bit_body_of(const dmb_bit_def *def, dmb_rigid_part *part);

/* Mud outside and inside of pipes. */
typedef struct dmb_mud {
    double outside, inside; /* [kg/m3] inside < 0: the same */
} dmb_mud;

/* [-] fraction of the weight of a pipe's body, or of its tool joint, in mud including the mud inside: 1 - rho_o/rho +
 * (rho_i - rho_o) A_i/m, m the mass per metre; 1 - rho_o/rho where both are the same. */
double dmb_buoyancy_factor(const dmb_pipe_def *def, int in_tool_joint, const dmb_mud *mud);
/* [kg] Mass of a pipe and its tool joint after buoyancy. */
double dmb_weighing_mass(const dmb_pipe_def *def, const dmb_mud *mud);
/* [m3] inside of the pipe's body or tool joint, per metre. */
double dmb_inner_area(const dmb_pipe_def *def, int in_tool_joint);
/* [kg/m] Transverse added mass of a pipe's body: mud inside, and `added` times the mud displaced by pipe and tool
 * joint; added < 0: that of the annulus to a hole of this diameter [m]. */
double dmb_mud_inertia(const dmb_pipe_def *def, const dmb_mud *mud, double added, double hole);
/* Added mass of mud on a rigid pipe (tool joint spread over it), on a stabiliser (displacement beyond the pipe or tool
 * joint of that outer diameter), and of masses given along and across at a place; x [m] of the middle from the node,
 * hole [m]: diameter, for added_mass < 0. */
void dmb_rigid_pipe_mud(const dmb_pipe_def *def, const dmb_environment_def *e, double hole, double x,
                        dmb_added_mass *sum);
void dmb_ring_mud(const dmb_stabiliser_def *def, double pipe_diameter, const dmb_environment_def *e, double hole,
                  double x, dmb_added_mass *sum);
void dmb_given_mud(const double mass[2], double x, dmb_added_mass *sum);
/* Adds a transverse mass [kg/m] to the mass of an element. */
void dmb_element_add_sideways(const dmb_pipe_def *def, double mass, dmb_element_type *type);

/* Constants of a flexible element: stiffness and mass. */

/* 12 EI/(GA L^2): shear over bending flexibility of an element. */
double dmb_shear_ratio(double EI, double GA, double length);

/* GA* [N] of 1/GA* = 1/GA + L^2/(12 EI), which makes linear statics exact at the nodes (eq:beam.shear-correction). */
double dmb_corrected_shear(double EI, double GA, double length);

/* Sideways: consistent mass with the cubic shapes of a Timoshenko beam (eq:beam.mass), rotary inertia included. Along
 * and around: half way from the consistent mass of straight shapes to a lumped one at share 1 (eq:beam.axial-mass);
 * share [-]: of the pipe alone in the mass and in the inertia about the axis that move with it, tool joints included,
 * shape (2). */
void dmb_beam_mass_of(const dmb_pipe_section *section, double length, const double share[2], dmb_beam_mass *mass);

/* [m] of the elements of a pipe that no ring divides. */
double dmb_element_length(const dmb_pipe_def *def);

/* The type of an element of a pipe of that length [m] between rigid arms [m]. damping_time [s] is that of the pipe, or
 * 0. The other: of one that no ring divides. */
void dmb_element_type_along(const dmb_pipe_def *def, double length, const double arm[2], double damping_time,
                            dmb_element_type *type);
void dmb_element_type_of(const dmb_pipe_def *def, const double arm[2], double damping_time, dmb_element_type *type);
/* An element that is bent by the angle a has with the straight mass a momentum that is wrong by up to (1/8 + r^2/L^2)
 * a^2 of itself, r the radius of gyration of its sections: 2.2e-5 at most where neither of these is exceeded. */
#define DMB_CURVED_BEND 0.01 /* [rad] as described */
#define DMB_CURVED_THICK 0.3 /* [-] r/L */

/* Gives a complete type the mass of elements that are bent (element/curved_mass.h) and, where its unstressed shape is,
 * the stiffness (eq:curved.flexibility). */
void dmb_element_make_curved(const dmb_pipe_def *def, dmb_element_type *type);

#endif
