/* Going on in a sim of another model. */
#include "state/handle.h"

int32_t dmb_sim_carry_over(dmb_sim *sim, const dmb_sim *from)
{
    (void)from;
    return dmb_sim_check(sim);
}
