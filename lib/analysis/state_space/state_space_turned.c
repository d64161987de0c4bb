/* Check that the coefficients of a state space are constant while parts rotate: by responses to random forces on all
 * rows, below and above the frequency of rotation. */
#include "analysis/state_space/state_space.h"

enum { FORCES = 2, FREQUENCIES = 2 };

/* [-] Frequencies over the speed of rotation, away from 1, where unconstrained motions have their roots in rotating
 * axes. */
static const double ratios[FREQUENCIES] = {0.6, 1.7};

static void draw(uint64_t *seed, uint32_t rows, dmb_complex_array x)
{
    for (uint32_t r = 0; r < rows; r++) {
        *seed = *seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
        x.re[r] = (double)(*seed >> 11) * 0x1p-52 - 1.0;
        x.im[r] = 0.0;
    }
}

static void look(dmb_space_work *w, dmb_linear_turned *turned, double omega)
{
    const uint32_t rows = w->linear->rows;
    const dmb_complex_array x = {w->work, w->work + rows};
    const double s[2] = {0.0, omega};
    uint64_t seed = 1;
    if (dmb_dynamic_stiffness_factor(&w->stiffness, omega) >= 0) return; /* an unconstrained motion */
    for (int i = 0; i < FORCES; i++) {
        draw(&seed, rows, x);
        dmb_dynamic_stiffness_solve(&w->stiffness, 0, x);
        (void)dmb_linear_change_of(turned, w->linear, s, x.re, x.im);
    }
}

/* M, C and K are computed again after further rotation of the rotating parts; the forces of the responses must not
 * change by more than dmb_linear_check_change permits. */
int32_t dmb_space_note_turning(dmb_space_work *w, const dmb_linear_options *how)
{
    dmb_linear_turned turned;
    int32_t status = dmb_linear_turn_on(w->linear, w->sim, how, &turned);
    for (int i = 0; i < FREQUENCIES && turned.linear != NULL; i++) look(w, &turned, ratios[i] * turned.spin);
    if (status >= 0 &&
        dmb_linear_check_change(&turned, "state space", "what that changes is left out", &w->sim->message) < 0)
        status = DMB_NOTE_INCOMPLETE;
    dmb_linear_turned_release(&turned, &w->linear->allocator);
    return status;
}
