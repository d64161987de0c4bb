/* Equilibrium of a string that is pulled into the bends of its hole: from a soft wall that is hardened. The guess by
 * tension (static_guess.c) has closed the contacts of its bends.
 *
 * Order: softest wall 10 clearances deep, then 1 clearance. Failure at any softness ends that attempt; a search that
 * cannot be continued at all (dmb_is_final) ends both. */
#include "analysis/linear/linear.h"
#include "analysis/static/static.h"

#define DMB_HARDER 10.0

/* The wall is first so soft that the tension presses rings into it by this multiple of their clearance: moves of that
 * size then open and close no contacts. Each solution is the start of the next one on a wall stiffer by DMB_HARDER. */
static const double pressed_in[] = {10.0, 1.0};

static int32_t harden(dmb_static_search *search, double softness)
{
    int32_t status = DMB_OK;
    for (; status >= 0 && softness > 1.0; softness /= DMB_HARDER) {
        search->evaluation.wall_softness = softness;
        status = dmb_static_newton(search);
    }
    search->evaluation.wall_softness = 0.0;
    return status < 0 ? status : dmb_static_newton(search);
}

int32_t dmb_static_from_pull(dmb_static_search *search)
{
    int32_t status = DMB_ERR_NO_CONVERGENCE;
    for (size_t k = 0; k < sizeof pressed_in / sizeof *pressed_in; k++) {
        dmb_static_pull pull;
        const int32_t found = dmb_static_find_pull(search, &pull);
        if (found <= 0) return found < 0 ? found : status;
        search->load_steps = 1;
        dmb_static_guess_by_pull(search);
        status = harden(search, dmb_static_softness(search, &pull, pressed_in[k]));
        if (status >= 0 || dmb_is_final(status)) return status;
    }
    return status;
}
