/* The state at a start and at jumps, and copies of it for analyses. */
#ifndef DMB_SYSTEM_SYSTEM_H
#define DMB_SYSTEM_SYSTEM_H

#include "sim/sim.h"
#include "system/assemble/evaluation.h"
#include "system/constrain/constrain.h"

/* ---- Start ------------------------------------------------------------------------------------------------------- */

/* Described poses and speeds, speeds projected onto the allowed motion, consistent accelerations, ledger at zero.
 * Returns DMB_OK, DMB_NOTE_PROJECTED with a message, or why there is no start. */
int32_t dmb_system_start(dmb_sim *sim);
/* After a jump of a force or of a prescribed acceleration at the present time: a0 = v' = what fits the state now
 * (eq:integration.carry). On failure nothing has changed but trial and work. */
int32_t dmb_system_jump(dmb_sim *sim);
/* Consistent accelerations, drive forces, contact state and ledger for the pose and speeds of now. */
int32_t dmb_system_restart(dmb_sim *sim);

/* ---- Jumps ------------------------------------------------------------------------------------------------------- */

/* Contacts, stops and springs that open within a step. Their force is gone at once, while generalized-alpha would carry
 * about half of it into the step from the accelerations it keeps: a wall that is stiff for the step would throw back
 * faster than it was met. The step is therefore taken from accelerations without that force (eq:contact.release), with
 * the mean force of the step in its place where the step does not resolve the contact. Where it does, the last force
 * before opening is O(h), so second order is kept. */
/* 1 if a ring meets or leaves the wall between now and trial, or another side of it. O(number of sites). */
int32_t dmb_contact_changes(const dmb_sim *sim);
/* 1 if a ring whose contact the step resolves touches the wall in now and is off it in trial. O(number of sites). */
int32_t dmb_contact_opens(const dmb_sim *sim);
/* Part that is taken out of the history: accelerations M^-1 f [m/s2, rad/s2] by the forces f that those have in now,
 * times the part of the step after the opening where it resolves the contact, shape (row); and that part of each node
 * [-], 0 of those where nothing opens, shape (node). Fills site_history. Residual, iteration matrix and
 * factors are overwritten. Errors as dmb_factor_mass_in_step. */
int32_t dmb_released_acceleration(const dmb_evaluation *evaluation, double *acceleration, double *part);
/* The same for a state close to one that has `near`, with the factors of the mass matrix there: off by the square of
 * the distance of both. product: room, shape (row). */
int32_t dmb_released_beside(dmb_evaluation *evaluation, const double *near, double *acceleration, double *part,
                            double *product);

/* Contacts, stops and springs that touch or open (system/assemble/bounces). */

/* After a successful trial: the accelerations that mean forces leave behind, for dmb_bounces_accept; *found: there are
 * any. Residual as it was; iteration matrix and factors are overwritten where *found. Errors as
 * dmb_factor_mass_in_step.
 */
int32_t dmb_bounces_end(const dmb_evaluation *evaluation, int32_t *found);
/* Adds these accelerations to those of the trial, shape (rows), as dmb_bounces_accept will do. */
void dmb_bounces_add_accelerations(const dmb_sim *sim, double *acceleration);
/* The trial is accepted: its accelerations become those of the laws that are followed from here on; ages, counters. */
void dmb_bounces_accept(const dmb_evaluation *evaluation, int32_t found);

/* Stuck places that let go, and the energy that is lost then. */

/* The ledger takes the energy `before` [J] less that which is stored now for lost. */
void dmb_stuck_lose(dmb_sim *sim, double before);
/* Those of the accepted state whose share has come to 1 let go; returns how many. */
uint32_t dmb_stuck_let_go(dmb_sim *sim);

/* Joints that lock, open and close in a run. Speeds that the new equations do not allow change by the impulse of least
 * kinetic energy, M (v+ - v-) + B^T impulse = 0, B v+ + rate = 0. */

/* dmb_sim_set_joint for a joint that exists */
int32_t dmb_joint_switch(dmb_sim *sim, uint32_t joint, int32_t state);

/* ---- Copies ------------------------------------------------------------------------------------------------------ */

/* A sim of its own in the accepted state of `sim`, its trial too, for analyses that leave the sim alone; memory from
 * the sim's allocator, NULL if there is none. It is no handle for callers (no stamp, no hold on the model) and must not
 * outlive the sim. system/copy */
dmb_sim *dmb_state_copy(const dmb_sim *sim);
/* DMB_ERR_TOO_LARGE, with a message that begins with `who`, where such a copy cannot be: it has dense matrices of
 * clusters. */
int32_t dmb_state_copy_check(dmb_sim *sim, const char *who);
/* The accepted state of a sim of the same model into a copy, its trial too. */
void dmb_state_take(const dmb_sim *sim, dmb_sim *copy);
/* NULL is fine. */
void dmb_state_discard(dmb_sim *copy);

#endif
