/* State at the start and at jumps, and copies of it for analyses. */
#ifndef DMB_SYSTEM_SYSTEM_H
#define DMB_SYSTEM_SYSTEM_H

#include "sim/sim.h"
#include "system/assemble/evaluation.h"
#include "system/constrain/constrain.h"

/* ---- Start ------------------------------------------------------------------------------------------------------- */

/* Start: poses and speeds as described, speeds projected onto the constraints, consistent accelerations, ledger at
 * zero. Returns DMB_OK, DMB_NOTE_PROJECTED with a message, or the reason of the failure. */
int32_t dmb_system_start(dmb_sim *sim);
/* Consistent accelerations after a jump of a force or of a prescribed acceleration at the present time: a0 = v'
 * (eq:integration.carry). A failure changes only trial and work fields. */
int32_t dmb_system_jump(dmb_sim *sim);
/* Consistent accelerations, drive forces, contact state and ledger for the pose and speeds of now. */
int32_t dmb_system_restart(dmb_sim *sim);

/* ---- Jumps ------------------------------------------------------------------------------------------------------- */

/* Contacts, stops and springs that open within a step. Their force ends at once, whereas generalized-alpha carries
 * about half of it into the step through its accelerations: a wall that is stiff for the step would return a body
 * faster than it arrived. The step is therefore repeated from accelerations without that force (eq:contact.release),
 * with the mean force of the step instead if the step does not resolve the contact. If it does, the last force before
 * opening is O(h), so second order is kept. */
/* 1 if a contact point touches or leaves the wall between now and trial, or changes to another side of the wall.
 * O(number of contact points). */
int32_t dmb_contact_changes(const dmb_sim *sim);
/* 1 if a contact point whose contact is resolved by the step touches the wall in now and is off it in trial. O(number
 * of contact points). */
int32_t dmb_contact_opens(const dmb_sim *sim);
/* Accelerations removed from the history of the step: M^-1 f [m/s2, rad/s2], f the opening forces in now, times the
 * fraction of the step after the opening if the step resolves the contact; shape (row). part: that fraction for each
 * node [-], 0 of nodes without an opening contact; shape (node). Fills site_history. Overwrites residual, iteration
 * matrix and factors. Errors as dmb_factor_mass_in_step. */
int32_t dmb_released_acceleration(const dmb_evaluation *evaluation, double *acceleration, double *part);
/* The same for a state close to one for which the result is `near`, with the factors of the mass matrix there. The
 * error is of second order in the distance of the two states. product: workspace, shape (row). */
int32_t dmb_released_beside(dmb_evaluation *evaluation, const double *near, double *acceleration, double *part,
                            double *product);

/* Contacts, stops and springs that touch or open (system/assemble/bounces). */

/* After a successful trial step: accelerations without the mean forces of the step, for dmb_bounces_accept; *found:
 * mean forces acted. Keeps the residual; overwrites iteration matrix and factors if *found. Errors as
 * dmb_factor_mass_in_step. */
int32_t dmb_bounces_end(const dmb_evaluation *evaluation, int32_t *found);
/* Adds these accelerations to those of the trial, shape (rows), as dmb_bounces_accept does. */
void dmb_bounces_add_accelerations(const dmb_sim *sim, double *acceleration);
/* Acceptance of a trial step: its accelerations become those of the laws that act from here on; updates ages, powers
 * and counters. */
void dmb_bounces_accept(const dmb_evaluation *evaluation, int32_t found);

/* After a restart with the state of another sim, whose contact points have their ages (run/state_transfer_sites):
 * stops and springs get theirs, and those contacts of all kinds that have mean forces in the next step leave the
 * accelerations and powers of now. *found: the last step may have had mean forces. Errors as dmb_factor_mass. */
int32_t dmb_bounces_go_on(dmb_sim *sim, const dmb_sim *from, int32_t *found);

/* Stuck places that release, and the energy dissipated by it. */

/* Adds the energy `before` [J] less the energy stored now to the losses in the ledger. */
void dmb_stuck_lose(dmb_sim *sim, double before);
/* Releases the stuck places of the accepted state whose force has reached the release force; returns their number. */
uint32_t dmb_stuck_let_go(dmb_sim *sim);

/* Joints that lock, open and close in a run. Speeds that violate the new equations change by the impulse of least
 * kinetic energy (eq:joints.impulse): M (v+ - v-) + B^T impulse = 0, B v+ + rate = 0. */

/* dmb_sim_set_joint for a valid joint. */
int32_t dmb_joint_switch(dmb_sim *sim, uint32_t joint, int32_t state);

/* ---- Copies ------------------------------------------------------------------------------------------------------ */

/* A copy of the accepted state and trial of `sim` for analyses, which leave `sim` unchanged; memory from the sim's
 * allocator, NULL if there is none. It is no handle for callers (no stamp, no reference to the model) and must not
 * outlive the sim. system/copy */
dmb_sim *dmb_state_copy(const dmb_sim *sim);
/* DMB_ERR_TOO_LARGE, with a message that begins with `who`, if such a copy is impossible because its dense matrices of
 * constraint components are too large. */
int32_t dmb_state_copy_check(dmb_sim *sim, const char *who);
/* Copies the accepted state and trial of a sim of the same model into a copy. */
void dmb_state_assign(const dmb_sim *sim, dmb_sim *copy);
/* NULL is permitted. */
void dmb_state_discard(dmb_sim *copy);

#endif
