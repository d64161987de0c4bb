/* Factors of an iteration matrix that serve in later steps (when: integrator/kept_factors).
 *
 * The wall stays where it is while pipes turn in it, and pipes are round: the iteration matrix of a pipe that has turned
 * about its axis is the old one in the old frame. So with a wall, kept factors are taken in the frames in which they
 * were made. (Where only one of two directions across is held this mixes it with the other: an approximate inverse
 * may.) */
#ifndef DMB_SYSTEM_KEPT_H
#define DMB_SYSTEM_KEPT_H

#include "state.h"

/* The factors of this step at hand, by inverses, become the kept ones, in the frames of the trial. */
void dmb_keep_factors(dmb_sim *sim);
/* Nothing is left of kept factors: the state does not go on from the steps that made them. */
void dmb_forget_factors(dmb_sim *sim);
/* Right-hand side in, solution by the kept factors out, both in `correction`; no joints. */
void dmb_solve_kept(dmb_sim *sim);

#endif
