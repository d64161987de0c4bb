#include "state/options.h"

#include <math.h>

#include "base/check.h"
#include "base/sized_struct.h"

DMB_DECLARE_STRUCT(dmb_sim_options)

static void check_iteration(dmb_check *check, const dmb_sim_options *o)
{
    dmb_check_count(check, "max_iterations", o->max_iterations, 1, 1000);
    dmb_check_within(check, "spectral_radius", o->spectral_radius, 0.0, 1.0);
    dmb_check_within(check, "newton_tolerance", o->newton_tolerance, 1e-14, 1e-1);
    dmb_check_choice(check, "bounded_work", o->bounded_work, 0, 1);
    dmb_check_choice(check, "energy_ledger", o->energy_ledger, 0, 1);
    dmb_check_choice(check, "constraint_method", o->constraint_method, DMB_METHOD_INDEPENDENT, DMB_METHOD_MULTIPLIERS);
}

static void check_step_control(dmb_check *check, const dmb_sim_options *o)
{
    dmb_check_above(check, "tolerance_translation", o->tolerance_translation, 0.0);
    dmb_check_above(check, "tolerance_rotation", o->tolerance_rotation, 0.0);
    dmb_check_above(check, "step_min", o->step_min, 0.0);
    dmb_check_above_field(check, "step_max", o->step_max, "step_min", o->step_min);
    dmb_check_count(check, "max_cuts", o->max_cuts, 0, 30);
}

int32_t dmb_sim_options_take(dmb_sim_options *out, const dmb_sim_options *given, dmb_message *message)
{
    dmb_check check = dmb_check_of(message, "sim options", DMB_NO_INDEX);
    dmb_sim_options read = dmb_sim_options_default();
    if (given != NULL) {
        const int32_t status = dmb_sim_options_read(&read, given);
        if (status < 0) {
            dmb_message_set(message,
                            "sim options: struct_size = %u, must be that of this library's header or an older one",
                            given->struct_size);
            return status;
        }
    }
    check_iteration(&check, &read);
    check_step_control(&check, &read);
    if (check.status == DMB_OK) *out = read;
    return check.status;
}
