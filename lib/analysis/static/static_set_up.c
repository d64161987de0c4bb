/* Options and workspace of a static search, its first state and the evaluation of its residual. */
#include "analysis/static/static.h"

#include <string.h>

#include "base/value_check.h"
#include "model/field_check.h"
#include "sim/access.h"

int32_t dmb_static_options_get(dmb_sim *sim, const dmb_static_options *given, dmb_static_options *out)
{
    dmb_check check = dmb_check_of(&sim->message, "static options", DMB_NONE);
    dmb_options_get(&check, DMB_OPTIONS_OF(dmb_static_options), given, out);
    if (check.status >= 0 && out->steady >= DMB_STEADY_SLIDING &&
        (out->slip_axial != 0.0 || out->slip_rotation != 0.0)) {
        dmb_message_set(&sim->message,
                        "static options: a slip is assumed of a state at rest, and steady asks for a moving "
                        "one; set slip_axial and slip_rotation to 0");
        return DMB_ERR_VALUE;
    }
    return check.status;
}

/* A search without load steps, slip or spins: full loads, tangent with every residual. Strategies change these fields
 * afterwards. Of the stiffness of forces that turn with the depth of a bent hole they use the symmetric part, which
 * has the same eigenvalues but for second order (eq:modes.skew); flutter by such forces is not examined. */
void dmb_static_set_up(dmb_static_search *search, dmb_sim *sim, const dmb_static_options *options)
{
    memset(search, 0, sizeof *search);
    search->sim = sim;
    search->options = options;
    search->evaluation.sim = sim;
    search->evaluation.time = sim->clock->time;
    search->evaluation.load_factor = 1.0;
    search->evaluation.tangent = 1;
    search->evaluation.turn_halves = 1;
    search->unbalanced = DMB_NONE;
}

/* Friction of a state at rest has no direction of its own: an assumed slip [m/s, rad/s] of all contact points gives it
 * one. Both 0: no friction. */
void dmb_static_slip(dmb_static_search *search, double axial, double rotation)
{
    search->evaluation.slipping = axial != 0.0 || rotation != 0.0;
    search->evaluation.slip[0] = axial;
    search->evaluation.slip[1] = rotation;
}

/* Every residual of every strategy passes here, so that a search can be cancelled after each one, and torques of
 * spinning strings are added to each. */
int32_t dmb_static_evaluate(dmb_static_search *search)
{
    int32_t status = dmb_progress_pulse(search->sim);
    if (status < 0) return status;
    status = search->steady != NULL ? dmb_steady_evaluate(search->steady, &search->evaluation)
                                    : dmb_system_evaluate(&search->evaluation);
    if (status >= 0) dmb_static_apply_spins(search);
    return status;
}
