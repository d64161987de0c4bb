/* The value of an output for a motion x e^(i w t): its functional, the forces of guides and constraints that it takes,
 * and what a drive adds that is itself the input. */
#include "analysis/response/response.h"

/* (i w)^rate sum (pose + i w speed - w^2 acceleration) d */
static dmb_complex_number of_functional(const dmb_dynamic_stiffness *s, const dmb_response_output *output,
                                        dmb_complex_array x)
{
    const dmb_functional *f = &output->functional;
    const double omega = s->omega, eta = output->elastic ? s->structural_damping : 0.0;
    dmb_complex_number sum = {0.0, 0.0};
    for (uint32_t i = 0; i < f->count; i++) {
        const double dr = x.re[f->row[i]], di = x.im[f->row[i]];
        const double a = f->pose[i] - omega * omega * f->acceleration[i], b = omega * f->speed[i] + eta * f->pose[i];
        sum.re += a * dr - b * di;
        sum.im += a * di + b * dr;
    }
    for (int32_t k = 0; k < output->rate; k++) {
        const double kept = sum.re;
        sum.re = -omega * sum.im;
        sum.im = omega * kept;
    }
    return sum;
}

/* Reaction in a row that is held: (A x - f)_r + (B^T multiplier)_r. */
static dmb_complex_number of_held_row(const dmb_dynamic_stiffness *s, const dmb_response_output *output, uint32_t held,
                                      dmb_complex_array x, dmb_complex_array f)
{
    const dmb_scene *scene = &s->linear->scene;
    const uint32_t node = scene->held_node[held], c = scene->held_component[held], row = dmb_held_row(scene, held);
    dmb_complex_number sum = dmb_dynamic_row(s, node, c, x);
    sum.re -= f.re[row];
    sum.im -= f.im[row];
    if (output->cluster == DMB_NONE) return sum;
    const dmb_cluster *cluster = scene->clusters + output->cluster;
    const double *B = s->linear->work->cluster_matrix + cluster->dense + scene->node_place[node] + c;
    for (uint32_t k = 0; k < cluster->rows; k++) {
        sum.re += B[(size_t)k * cluster->columns] * s->links.multiplier.re[k];
        sum.im += B[(size_t)k * cluster->columns] * s->links.multiplier.im[k];
    }
    return sum;
}

dmb_complex_number dmb_response_output_value(const dmb_dynamic_stiffness *s, const dmb_response_output *output,
                                             const dmb_excitation *input, dmb_complex_array x, dmb_complex_array f)
{
    dmb_complex_number value = of_functional(s, output, x);
    if (output->cluster != DMB_NONE) dmb_dynamic_multipliers(s, output->cluster, x, f, s->links.multiplier);
    for (uint32_t k = 0; k < output->multiplier_count; k++) {
        value.re += output->multiplier_weight[k] * s->links.multiplier.re[output->multiplier + k];
        value.im += output->multiplier_weight[k] * s->links.multiplier.im[output->multiplier + k];
    }
    for (uint32_t k = 0; k < output->guide_count; k++) {
        const dmb_complex_number left = of_held_row(s, output, output->guide[k], x, f);
        value.re += output->guide_weight[k] * left.re;
        value.im += output->guide_weight[k] * left.im;
    }
    if (output->bit != DMB_NONE && output->bit == input->bit) value.re += 1.0;
    if (output->drive == DMB_NONE || output->drive != input->drive) return value;
    value.re += output->direct;
    value.im -= output->integral != 0.0 ? output->integral / s->omega : 0.0;
    return value;
}
