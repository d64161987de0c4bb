/* What the strain energy of a mode tells of its eigenvalue. */
#include <float.h>
#include <math.h>

#include "analysis/modes.h"
#include "system/energy.h"

/* Rounding of d^H K d in units of its terms: their number is in the hundreds of thousands at most. */
#define DMB_SHARPEN_UNITS 64.0

double dmb_modes_twice_strain_energy(const dmb_modes *modes, double *rows)
{
    dmb_configuration moved = modes->state->now;
    double sum = 0.0;
    moved.velocity = rows;
    for (uint32_t e = 0; e < modes->state->scene->element_count; e++) {
        const dmb_element_type *type = modes->state->scene->types + modes->state->scene->element_type[e];
        double rate[6];
        dmb_element_strain_rate(modes->state->scene, &moved, e, rate);
        for (int i = 0; i < 6; i++) sum += type->stiffness[i] * rate[i] * rate[i];
    }
    return sum;
}

/* d^H K d is the strain energy twice where there is neither preload nor wall nor spring, and then the energy is the
 * sharper of the two: its terms are squares of small differences, those of K d cancel. With n elements to a bending
 * wave K d keeps eps n^4 of it, the energy eps n^2. It is taken where the two differ by the rounding of K d alone. */
double dmb_modes_sharpen(const dmb_mode_search *search, double square, double *x)
{
    const dmb_linear *linear = search->linear;
    double terms = 0.0;
    for (uint32_t i = 0; i < linear->scene.node_count; i++)
        for (uint32_t c = 0; c < linear->scene.layout.size[i]; c++) {
            const double z = x[linear->scene.layout.row[i] + c];
            terms += linear->stiffness_size[linear->scene.layout.row[i] + c] * z * z;
        }
    const double twice = dmb_modes_twice_strain_energy(search->modes, x);
    return fabs(square - twice) <= DMB_SHARPEN_UNITS * DBL_EPSILON * terms ? twice : square;
}
