/* Options and workspace of a static search, its first state and the evaluation of its residual. */
#include "analysis/static/static.h"

#include <string.h>

#include "base/sized_struct.h"
#include "base/value_check.h"
#include "sim/access.h"

DMB_DECLARE_STRUCT(dmb_static_options)

int32_t dmb_static_options_get(dmb_sim *sim, const dmb_static_options *given, dmb_static_options *out)
{
    dmb_check check = dmb_check_of(&sim->message, "static options", DMB_NONE);
    (void)dmb_static_options_init(out, (uint32_t)sizeof *out);
    if (given != NULL) {
        const int32_t status = dmb_static_options_read(out, given);
        if (status < 0) {
            dmb_message_set(&sim->message, "static options: struct_size is not one of this library");
            return status;
        }
    }
    dmb_check_count(&check, "max_iterations", out->max_iterations, 1, 10000);
    dmb_check_within(&check, "tolerance", out->tolerance, 1e-15, 0.1);
    dmb_check_within(&check, "slip_axial", out->slip_axial, -1e6, 1e6);
    dmb_check_within(&check, "slip_rotation", out->slip_rotation, -1e6, 1e6);
    dmb_check_count(&check, "load_steps", out->load_steps, 0, 10000);
    dmb_check_choice(&check, "lay_on_wall", out->lay_on_wall, 0, 1);
    dmb_check_choice(&check, "steady", out->steady, DMB_STEADY_AUTO, DMB_STEADY_RIGID);
    if (check.status >= 0 && out->steady >= DMB_STEADY_SLIDING &&
        (out->slip_axial != 0.0 || out->slip_rotation != 0.0)) {
        dmb_message_set(&sim->message,
                        "static options: a slip is assumed of a state at rest, and steady asks for a moving "
                        "one; set slip_axial and slip_rotation to 0");
        return DMB_ERR_VALUE;
    }
    return check.status;
}

void dmb_static_set_up(dmb_static_search *search, dmb_sim *sim, const dmb_static_options *options)
{
    memset(search, 0, sizeof *search);
    search->sim = sim;
    search->options = options;
    search->evaluation.sim = sim;
    search->evaluation.time = sim->clock->time;
    search->evaluation.load_factor = 1.0;
    search->evaluation.tangent = 1;
    search->unbalanced = DMB_NONE;
}

void dmb_static_slip(dmb_static_search *search, double axial, double rotation)
{
    search->evaluation.slipping = axial != 0.0 || rotation != 0.0;
    search->evaluation.slip[0] = axial;
    search->evaluation.slip[1] = rotation;
}

int32_t dmb_static_evaluate(dmb_static_search *search)
{
    int32_t status = dmb_progress_pulse(search->sim);
    if (status < 0) return status;
    status = search->steady != NULL ? dmb_steady_evaluate(search->steady, &search->evaluation)
                                    : dmb_system_evaluate(&search->evaluation);
    if (status >= 0) dmb_static_apply_spins(search);
    return status;
}
