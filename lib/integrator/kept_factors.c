#include "integrator/kept_factors.h"

#include "system/kept.h"
#include "system/release.h"

/* Steps count as equally long that differ by this part: by the rounding of times, and what no rate of convergence
 * feels. */
#define DMB_KEPT_STEP 1e-6
/* Steps that begin with a residual above this part of their forces are those in which bodies meet: a correction by
 * kept factors would lead astray. */
#define DMB_KEPT_START 0.1
/* Longest pause in steps between tries of kept factors. */
#define DMB_PAUSE_MAX 31
/* New factors cost about as much as this many corrections with old ones. */
#define DMB_EXCESS_MAX 2

void dmb_kept_factors_begin(dmb_sim *sim, dmb_attempt *attempt)
{
    const double step = attempt->end.step;
    const int usable = attempt->whole && !attempt->astray && fabs(sim->kept->step - step) <= DMB_KEPT_STEP * step &&
                       sim->kept->pause == 0;
    attempt->factored = usable ? DMB_FACTORS_KEPT : DMB_FACTORS_NONE;
    attempt->tried |= usable;
    *sim->factors = attempt->factored;
}

int32_t dmb_kept_factors_still_pay(const dmb_sim *sim, const dmb_attempt *attempt, const dmb_newton_course *course)
{
    if (attempt->factored != DMB_FACTORS_KEPT || dmb_contact_changes(sim)) return 0;
    return course->corrections == 0 || (course->corrections < 3 && attempt->residual < 0.25 * course->last);
}

int32_t dmb_kept_factors_will_do(const dmb_sim *sim, const dmb_attempt *attempt, const dmb_newton_course *course)
{
    if (attempt->factored == DMB_FACTORS_NONE) return 0;
    if (attempt->factored == DMB_FACTORS_KEPT && dmb_contact_changes(sim)) return 0;
    if (attempt->factored == DMB_FACTORS_KEPT && course->corrections == 0) return attempt->residual <= DMB_KEPT_START;
    const double rate = attempt->residual / course->last;
    return rate * rate * attempt->residual <= dmb_kept_factors_aim(sim, attempt);
}

/* Kept factors have done for a whole step. */
static void count_success(dmb_kept *kept, uint32_t corrections)
{
    if (kept->corrections == 0 || corrections < kept->corrections) kept->corrections = corrections;
    kept->excess += corrections - kept->corrections;
    kept->penalty = 0;
    if (kept->excess >= DMB_EXCESS_MAX) kept->step = 0.0;
}

/* Fresh factors were needed, after kept ones had been tried or without a try. */
static void count_pause(dmb_kept *kept, int32_t tried)
{
    if (tried) {
        kept->penalty = 2 * kept->penalty + 1 < DMB_PAUSE_MAX ? 2 * kept->penalty + 1 : DMB_PAUSE_MAX;
        kept->pause = kept->penalty - 1;
    } else if (kept->pause > 0) {
        kept->pause--;
    }
}

void dmb_kept_factors_end(dmb_sim *sim, const dmb_attempt *attempt)
{
    if (!attempt->whole) return;
    if (attempt->factored == DMB_FACTORS_KEPT) {
        count_success(sim->kept, attempt->iterations);
    } else if (attempt->factored == DMB_FACTORS_FRESH) {
        count_pause(sim->kept, attempt->tried);
        dmb_keep_factors(sim);
        sim->kept->step = attempt->end.step;
        sim->kept->corrections = sim->kept->excess = 0;
    }
}
