/* Mass, damping and stiffness from the tangents that steps solve with. */
#include <string.h>

#include "analysis/linearise_parts.h"

/* [s] What is integrated over a step is told from the rest by two steps this short and twice as long: a power of two,
 * over which nothing slips far. */
#define DMB_LINEAR_STEP 0x1p-24

static void copy_blocks(const dmb_block_layout *layout, const double *diagonal, const double *lower,
                        const double *upper, dmb_linear_matrix *to)
{
    memcpy(to->diagonal, diagonal, layout->diag[layout->n] * sizeof(double));
    memcpy(to->lower, lower, layout->link[layout->n - 1] * sizeof(double));
    memcpy(to->upper, upper, layout->link[layout->n - 1] * sizeof(double));
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

/* At increments of 0 the links hold stiffness plus inertia, or inertia alone. */
static int32_t evaluate_tangent(dmb_linear *linear, double mass_factor, double velocity_factor, double step,
                                int32_t inertia_only)
{
    dmb_evaluation evaluation = dmb_linear_evaluation(linear->work);
    memset(linear->work->increment, 0, linear->rows * sizeof(double));
    evaluation.tangent = 1;
    evaluation.inertia_only = inertia_only;
    evaluation.mass_factor = mass_factor;
    evaluation.velocity_factor = velocity_factor;
    evaluation.step = step;
    return dmb_system_evaluate(&evaluation);
}

int32_t dmb_linear_take_stiffness_and_mass(dmb_linear *linear)
{
    dmb_sim *work = linear->work;
    int32_t status = evaluate_tangent(linear, 0.0, 0.0, 0.0, 0);
    const dmb_linear_matrix K = dmb_linear_stiffness_of(work);
    const dmb_block_layout *layout = &linear->scene.layout;
    if (status < 0) return status;
    copy_blocks(layout, K.diagonal, K.lower, K.upper, &linear->stiffness);
    memcpy(linear->stiffness.joints, K.joints, linear->scene.tangent_count * sizeof(double));
    status = evaluate_tangent(linear, 1.0, 0.0, 0.0, 1);
    if (status < 0) return status;
    copy_blocks(layout, work->inertia_diagonal, K.lower, K.upper, &linear->mass);
    return DMB_OK;
}

/* The tangent by velocity: nodes and elements keep it with the inertia, joints with their stiffness. */
static int32_t add_velocity_tangent(dmb_linear *linear, double factor, double step, dmb_linear_matrix *to)
{
    dmb_sim *work = linear->work;
    const int32_t status = evaluate_tangent(linear, 0.0, 1.0, step, 1);
    dmb_linear_matrix C = dmb_linear_stiffness_of(work);
    if (status < 0) return status;
    C.diagonal = work->inertia_diagonal;
    dmb_linear_add(&linear->scene, factor, &C, to);
    return DMB_OK;
}

static int has_integrals(const dmb_scene *scene)
{
    if (scene->friction_law.kind == DMB_FRICTION_BRISTLE) return 1;
    for (uint32_t i = 0; i < scene->drive_count; i++)
        if (scene->drives[i].kind == DMB_DRIVE_CONTROL && scene->drives[i].integral_gain != 0.0) return 1;
    return 0;
}

/* Over a step h the tangent by velocity is C + h/2 S, S being the stiffness of what the trapezoidal rule integrates. */
int32_t dmb_linear_take_damping(dmb_linear *linear)
{
    const double h = DMB_LINEAR_STEP;
    dmb_linear_matrix *C = &linear->damping, *K = &linear->stiffness;
    int32_t status;
    if (!has_integrals(&linear->scene)) {
        status = add_velocity_tangent(linear, 1.0, 0.0, C);
        dmb_linear_add_array(-1.0, K->joints, linear->scene.tangent_count, C->joints);
        return status;
    }
    /* C = 2 C(h) - C(2h) - K,   S = (C(2h) - C(h)) 2/h */
    status = add_velocity_tangent(linear, 2.0, h, C);
    if (status >= 0) status = add_velocity_tangent(linear, -1.0, 2.0 * h, C);
    dmb_linear_add_array(-1.0, K->joints, linear->scene.tangent_count, C->joints);
    if (status >= 0) status = add_velocity_tangent(linear, 2.0 / h, 2.0 * h, K);
    return status < 0 ? status : add_velocity_tangent(linear, -2.0 / h, h, K);
}
