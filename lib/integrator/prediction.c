/* Choice between the constant prediction, v1' = v0', and the linear one, which continues the acceleration
 * (eq:integration.prediction), as a0 - v0' remembers it (eq:integration.memory). The linear one is tried under the
 * conditions of may_be_linear; after each accepted step:
 *
 *     the step                                             next steps
 *     --------------------------------------------------   ----------------------------------------------------------
 *     linear, fewer iterations than the last constant one  linear
 *     linear, not fewer                                    constant for 1, 3, 7, ... 31 steps, then linear again
 *     contacts changed, repeated from the constant one     the same
 *     constant, also after a linear one that did not       its iterations are the measure for the linear one; the wait
 *     converge                                             shortens by one step */
#include "integrator/prediction.h"

#include "kernel/kernels.h"
#include "system/assemble/assemble.h"
#include "system/solve/solve.h"

/* [-] Smallest |a0 - v0'| over the change of acceleration in a step. Near spectral radius 1 it vanishes, and the
 * extrapolated slope would be dominated by the error of the Newton iteration. */
#define DMB_APART_MIN 0.02
/* [-] Most iterations of a constant prediction after which the linear one is tried: more indicate contacts. */
#define DMB_SMOOTH_MOST 3

/* Linear prediction requires the error-based bound of Newton, no joints and no free rigid bodies (which move their
 * trial by projection or about their centre of mass), and no failed or contact-changing try in this step. */
static int32_t may_be_linear(const dmb_sim *sim, const dmb_generalized_alpha *c, const dmb_trial_step *trial_step)
{
    const dmb_scene *scene = sim->scene;
    if (sim->options.newton_tolerance > 0.0) return 0;
    if (scene->cluster_count > 0 || scene->free_rigid_count > 0 || trial_step->stage != DMB_STAGE_FIRST) return 0;
    return c->af - c->am >= DMB_APART_MIN && sim->prediction->constant > 0 &&
           sim->prediction->constant <= DMB_SMOOTH_MOST && sim->prediction->pause == 0;
}

void dmb_prediction_make(dmb_sim *sim, const dmb_generalized_alpha *c, dmb_trial_step *trial_step)
{
    trial_step->linear = may_be_linear(sim, c, trial_step);
    dmb_step_motion_predict(sim, c, trial_step->end.step, trial_step->linear ? 1.0 / (c->am - c->af) : 0.0);
}

/* dmb_prediction_make has left the difference of the increments to those of the constant prediction in sim->correction.
 * Its inertia beta' M dz is the residual that the constant prediction would begin with where inertia dominates. */
double dmb_prediction_saved(dmb_sim *sim, const dmb_trial_step *trial_step)
{
    const dmb_scene *scene = sim->scene;
    dmb_inertia_of_change(scene, sim->correction, trial_step->evaluation.mass_factor, sim->residual);
    dmb_residual_begins_at(sim);
    return scene->kernels->product(scene->row_count, sim->correction, sim->residual);
}

/* A step that needed more than three iterations from the constant prediction suspends the linear one without a wait:
 * the condition is on the most recent constant step alone. */
void dmb_prediction_note(dmb_sim *sim, const dmb_trial_step *trial_step)
{
    dmb_prediction *p = sim->prediction;
    if (!trial_step->linear) p->constant = trial_step->iterations;
    const int changed = trial_step->stage == DMB_STAGE_CONSTANT || trial_step->stage == DMB_STAGE_CONSTANT_OWN;
    if (!trial_step->linear && !changed) {
        if (p->pause > 0) p->pause--;
        return;
    }
    const int saves = trial_step->linear && trial_step->iterations < p->constant;
    p->back_off = saves ? 0 : 2 * p->back_off + 1;
    if (p->back_off > DMB_PAUSE_MAX) p->back_off = DMB_PAUSE_MAX;
    p->pause = p->back_off;
}
