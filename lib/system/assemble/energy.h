/* Energies of a configuration, exactly those whose derivatives the residual holds. */
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
/* Potential of the weights less that of the pose at time 0 as described. */
double dmb_gravity_energy(const dmb_scene *scene, const dmb_configuration *configuration);
/* Stored in the wall's normal stiffness. Energy stored in bristles counts as spent by friction until it comes back. */
double dmb_contact_energy(const dmb_scene *scene, const dmb_configuration *configuration);
/* d = log(H_A^-1 H_B) of the ends of a bent element, shape (6); 0 of others, of which nothing asks for it. */
void dmb_element_relative_pose(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t element,
                               double d[6]);
/* Strain of an element times its length, e of element/beam_math.h, shape (6). */
void dmb_element_strain(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t element, double e[6]);
/* Change of that by a small motion of the nodes, given as `velocity` of the configuration, shape (6). */
void dmb_element_strain_rate(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t element,
                             double rate[6]);
/* Parts of the kinetic energies that are motion along the axis, about it, and across it, shape (3). */
void dmb_element_kinetic_parts(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t element,
                               double parts[3]);
void dmb_rigid_mass_kinetic_parts(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t rigid_mass,
                                  double parts[3]);
void dmb_added_mass_kinetic_parts(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t added,
                                  double parts[3]);
/* Section forces at the element's two flexible ends in the frame of that end, as force on the near side from the far
 * side: (axial, shear, shear, torque, moment, moment); material damping included, shape (2, 6). */
void dmb_element_section_force(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t element,
                               double force[12]);
/* The same with the element's own weight and inertia, which its nodes carry in rigid_masses: the loads of the very
 * sections at its ends. Bars on the hole's axis: as above. Shape (2, 6). */
void dmb_element_end_loads(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t element,
                           double load[12]);
/* Axial force and torque of the section at the near end of a bar on the hole's axis, its own weight and inertia in
 * them, shape (2). */
void dmb_bar_start_loads(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t element,
                         double load[2]);

/* ---- Ledger ------------------------------------------------------------------------------------------------------ */

/* Energy ledger: work of each class of force by the trapezoidal rule over accepted steps. At every accepted instant the
 * powers of all forces sum to zero (residual times velocity), so what is missing between their integrals and the
 * energies is what the time integration took out; nothing is set by closing the balance. */

/* [J] kinetic energy and all that is stored. */
double dmb_energy_stored(const dmb_sim *sim, const dmb_configuration *configuration);
/* [J] what went in less what was spent and what is stored, of which there is `stored` now; 0 in continuous time. */
double dmb_ledger_balance(const dmb_ledger *ledger, double stored);
/* [J] the same at an earlier time, from the balances that are kept; 0 before the first of them. */
double dmb_ledger_balance_before(const dmb_ledger *ledger, double time);
/* Sets the ledger to zero at the present state (now) with the powers of the evaluation. */
void dmb_ledger_start(dmb_sim *sim, const dmb_evaluation *evaluation);
/* The powers of the evaluation hold from now on; nothing is added. */
void dmb_ledger_jump(dmb_sim *sim, const dmb_evaluation *evaluation);
/* Losses of an impact between two steps [J]: kinetic energy of bodies, and stored energy that is let go. */
void dmb_ledger_take_impact(dmb_sim *sim, double kinetic, double stored);
/* [J] that the wall stored where cutters have widened the hole: it goes with the rock. */
void dmb_ledger_take_rock(dmb_sim *sim, double stored);
/* The caller has changed what stores energy, and the poses store this much more [J]: work of loads. */
void dmb_ledger_take_change(dmb_sim *sim, double stored);
/* [J] of the powers in `kind` that the trapezoidal rule has beyond what the step did: work of potential forces. */
void dmb_ledger_move(dmb_sim *sim, int kind, double excess);
/* Adds the step from now to trial; before the swap. */
void dmb_ledger_add(dmb_sim *sim, const dmb_evaluation *evaluation);

#endif
