/* Flexible elements: internal and inertia forces, stiffness and inertia tangent, element by element in chain order. */
#ifndef DMB_SYSTEM_ASSEMBLE_ELEMENTS_H
#define DMB_SYSTEM_ASSEMBLE_ELEMENTS_H

#include "system/assemble/evaluation.h"

/* Extrapolates element_stress over a correction of body-frame pose increments (Magisano, Leonetti, Garcea 2017). */
void dmb_system_extrapolate_stress(dmb_sim *sim, const double *correction);
/* Parts of dmb_system_evaluate, one a file. */
void dmb_gather_elements(dmb_evaluation *evaluation);

#endif
