#include "query/ask.h"
#include "query/interpolation.h"

int32_t dmb_query_rotation(const dmb_sim *sim, dmb_place place, double *angle)
{
    int32_t status = dmb_ask(sim, angle);
    dmb_spot spot;
    if (status == DMB_OK) status = dmb_spot_of(sim, place, &spot);
    if (status < 0) return status;
    *angle = dmb_spot_turn(&sim->now, &spot);
    return DMB_OK;
}
