/* Energies of a configuration, whose derivatives are exactly the forces of the residual. */
#ifndef DMB_SYSTEM_ASSEMBLE_ENERGY_H
#define DMB_SYSTEM_ASSEMBLE_ENERGY_H

#include "sim/sim.h"
#include "system/assemble/evaluation.h"

double dmb_element_kinetic_energy(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t element);
double dmb_rigid_mass_kinetic_energy(const dmb_scene *scene, const dmb_configuration *configuration,
                                     uint32_t rigid_mass);
double dmb_added_mass_kinetic_energy(const dmb_scene *scene, const dmb_configuration *configuration,
                                     const dmb_added_mass *added);
double dmb_kinetic_energy(const dmb_scene *scene, const dmb_configuration *configuration);
double dmb_strain_energy(const dmb_scene *scene, const dmb_configuration *configuration);
/* Element with the largest strain energy; DMB_NONE: there is none. */
uint32_t dmb_most_strained(const dmb_scene *scene, const dmb_configuration *configuration);
/* Potential of the weights, relative to the described pose at time 0. */
double dmb_gravity_energy(const dmb_scene *scene, const dmb_configuration *configuration);
/* Energy stored in the wall's normal stiffness. Energy in bristles counts as dissipated by friction until it is
 * returned. */
double dmb_contact_energy(const dmb_scene *scene, const dmb_configuration *configuration);
/* d = log(H_A^-1 H_B) of the ends of a bent element, shape (6); 0 of other elements, for which it is not used. */
void dmb_element_relative_pose(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t element,
                               double d[6]);
/* Strain of an element times its length, e of element/beam_math.h, shape (6). */
void dmb_element_strain(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t element, double e[6]);
/* Change of that by a small motion of the nodes, given as `velocity` of the configuration, shape (6). */
void dmb_element_strain_rate(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t element,
                             double rate[6]);
/* Kinetic energies of motion along the axis, about it, and across it, shape (3). */
void dmb_element_kinetic_parts(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t element,
                               double parts[3]);
void dmb_rigid_mass_kinetic_parts(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t rigid_mass,
                                  double parts[3]);
void dmb_added_mass_kinetic_parts(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t added,
                                  double parts[3]);
/* Section forces at the element's two flexible ends in the frame of that end, as force of the far side on the near
 * side: (axial, shear, shear, torque, moment, moment); material damping included, shape (2, 6). */
void dmb_element_section_force(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t element,
                               double force[12]);
/* The same including the element's own weight and inertia, which are lumped at its nodes in rigid_masses: the loads of
 * the sections at its very ends. Axial-torsional elements: as above. Shape (2, 6). */
void dmb_element_end_loads(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t element,
                           double load[12]);
/* Axial force and torque of the section at the near end of an axial-torsional element, with its own weight and inertia,
 * shape (2). */
void dmb_axial_torsional_start_loads(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t element,
                                     double load[2]);

/* [J] Kinetic and all stored energy. */
double dmb_energy_stored(const dmb_sim *sim, const dmb_configuration *configuration);

#endif
