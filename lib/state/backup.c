#include <string.h>

#include "state/layout.h"

void dmb_state_keep(dmb_sim *sim)
{
    dmb_field fields[DMB_FIELD_MAX];
    const size_t count = dmb_sim_fields(sim, DMB_GROUP_NOW, DMB_GROUP_MEMORY, fields);
    uint8_t *to = sim->backup;
    for (size_t i = 0; i < count; to += fields[i].bytes, i++) memcpy(to, fields[i].data, fields[i].bytes);
}

void dmb_state_bring_back(dmb_sim *sim)
{
    dmb_field fields[DMB_FIELD_MAX];
    const size_t count = dmb_sim_fields(sim, DMB_GROUP_NOW, DMB_GROUP_MEMORY, fields);
    const uint8_t *from = sim->backup;
    for (size_t i = 0; i < count; from += fields[i].bytes, i++) memcpy(fields[i].data, from, fields[i].bytes);
}
