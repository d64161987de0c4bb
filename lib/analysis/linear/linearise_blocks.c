/* Blocks of a linearisation: the evaluation that makes them, their sums. */
#include "analysis/linear/linear.h"

#include <string.h>

/* Dynamic, because velocities and accelerations of the state act; pseudo_factor 1, so that derivatives by acceleration
 * are those of the equations of motion and not of generalized-alpha. */
dmb_evaluation dmb_linear_evaluation(const dmb_linear *linear)
{
    dmb_evaluation evaluation;
    memset(&evaluation, 0, sizeof evaluation);
    evaluation.sim = linear->work;
    evaluation.time = linear->work->clock->time;
    evaluation.pseudo_factor = 1.0;
    evaluation.load_factor = linear->load_factor;
    evaluation.dynamic = 1;
    return evaluation;
}

void dmb_linear_add(const dmb_scene *scene, double factor, const dmb_linear_matrix *from, dmb_linear_matrix *to)
{
    const dmb_block_layout *layout = &scene->layout;
    dmb_linear_add_array(factor, from->diagonal, layout->diag[layout->n], to->diagonal);
    dmb_linear_add_array(factor, from->lower, layout->link[layout->n - 1], to->lower);
    dmb_linear_add_array(factor, from->upper, layout->link[layout->n - 1], to->upper);
    dmb_linear_add_array(factor, from->joints, scene->tangent_count, to->joints);
}

dmb_linear_matrix dmb_linear_stiffness_of(const dmb_sim *work)
{
    const dmb_linear_matrix A = {work->stiffness_diagonal, work->stiffness_lower, work->stiffness_upper,
                                 work->constraint_tangent};
    return A;
}
