/* What the pieces of dmb_linear_make are to each other. */
#ifndef DMB_ANALYSIS_LINEARISE_PARTS_H
#define DMB_ANALYSIS_LINEARISE_PARTS_H

#include "analysis/linearise.h"
#include "system/evaluation.h"

/* Memory for the matrices about the state of a sim, and a copy of it to work on; NULL without memory. */
dmb_linear *dmb_linear_allocate(const dmb_sim *sim);

/* An evaluation of the state with its accelerations. */
dmb_evaluation dmb_linear_evaluation(dmb_sim *work);
/* What forces leave over where body-frame velocities stay as they are. */
int32_t dmb_linear_take_balance(dmb_linear *linear);
/* Of a state that is balanced. */
void dmb_linear_take_steady_accelerations(dmb_linear *linear);
/* What is left is balanced where it is no more than rounding of the poses; K is there. */
void dmb_linear_judge_rounding(dmb_linear *linear);

static inline void dmb_linear_add_array(double factor, const double *from, size_t count, double *to)
{
    for (size_t i = 0; i < count; i++) to[i] += factor * from[i];
}
/* to += factor from, all of their blocks. */
void dmb_linear_add(const dmb_scene *scene, double factor, const dmb_linear_matrix *from, dmb_linear_matrix *to);
/* to += factor A blkdiag(v^), v by rows; a PATH node turns about its own axis alone and has none. */
void dmb_linear_add_products(const dmb_scene *scene, double factor, const dmb_linear_matrix *A, const double *rows,
                             dmb_linear_matrix *to);
/* stiffness_size of the stiffness as it is. */
void dmb_linear_take_stiffness_size(dmb_linear *linear);
/* The blocks of stiffness of a sim. */
dmb_linear_matrix dmb_linear_stiffness_of(const dmb_sim *work);
/* The tangents by pose and acceleration, and after them that by velocity. */
int32_t dmb_linear_take_stiffness_and_mass(dmb_linear *linear);
int32_t dmb_linear_take_damping(dmb_linear *linear);

/* C and K with the velocities of the axes of d (still: those that do not spin), and what is held is cleared. */
void dmb_linear_turn_frames(dmb_linear *linear, int32_t still);

/* The scene without what is not to act: the wall, or the change of its friction. */
void dmb_linear_freeze(dmb_linear *linear, const dmb_linear_options *options);
/* Forces that the frozen scene lacks stay as dead loads. `before`: residual with them, shape (rows). */
void dmb_linear_add_dead_loads(dmb_linear *linear, const double *before);
/* Stiffness of the wall under rings up to `gap` [m] from it. */
void dmb_linear_close_contacts(dmb_linear *linear, double gap);

/* Keeps the columns (1), or rows (0), of what is held. */
void dmb_linear_keep_held(dmb_linear *linear, int columns);
/* Clears them. */
void dmb_linear_hold(dmb_linear *linear, int columns);
/* whole_joints += factor times the joints' parts as they are. */
void dmb_linear_add_whole_joints(dmb_linear *linear, double factor);

/* R and the rows of its coordinates. DMB_ERR_NO_MEMORY. */
int32_t dmb_linear_make_coordinates(dmb_linear *linear);

#endif
