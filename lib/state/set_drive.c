/* The caller's hand on a drive: a constant in the place of its programme. */
#include <math.h>

#include "state/handle.h"

static int32_t refuse(dmb_sim *sim, int32_t status, const char *why)
{
    dmb_message_set(&sim->message, "%s", why);
    return status;
}

int32_t dmb_sim_set_drive(dmb_sim *sim, dmb_id drive, double value)
{
    const int32_t status = dmb_sim_check(sim);
    uint32_t index;
    if (status < 0) return status;
    dmb_message_clear(&sim->message);
    index = dmb_model_part_index(sim->model, drive, DMB_PART_DRIVE);
    if (index >= sim->scene->drive_count) return refuse(sim, DMB_ERR_ID, "drive: the id names no drive of this model");
    if (sim->scene->drives[index].kind == DMB_DRIVE_MOTION) {
        dmb_message_set(&sim->message, "drive %u: its kind is DMB_DRIVE_MOTION, whose speed may not jump", index);
        return DMB_ERR_UNSUPPORTED;
    }
    if (isinf(value)) {
        dmb_message_field(&sim->message, "drive", index, "value", value, "finite, or NaN for the programme");
        return DMB_ERR_NOT_FINITE;
    }
    sim->drive_input[index] = isnan(value) ? (double)NAN : value; /* one NaN, so that equal states hash alike */
    return DMB_OK;
}
