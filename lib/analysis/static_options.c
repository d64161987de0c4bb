#include "analysis/static_options.h"

#include "base/check.h"
#include "base/sized_struct.h"

DMB_DECLARE_STRUCT(dmb_static_options)

int32_t dmb_static_options_take(dmb_sim *sim, const dmb_static_options *given, dmb_static_options *out)
{
    dmb_check check = dmb_check_of(&sim->message, "static options", DMB_NO_INDEX);
    (void)dmb_static_options_init(out, (uint32_t)sizeof *out);
    if (given != NULL) {
        const int32_t status = dmb_static_options_read(out, given);
        if (status < 0) {
            dmb_message_set(&sim->message, "static options: struct_size is not one this library knows");
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
    if (check.status >= 0 && out->steady >= DMB_STEADY_SLIDING && (out->slip_axial != 0.0 || out->slip_rotation != 0.0)) {
        dmb_message_set(&sim->message, "static options: a slip is assumed of a state at rest, and steady asks for a moving "
                                       "one; set slip_axial and slip_rotation to 0");
        return DMB_ERR_VALUE;
    }
    return check.status;
}
