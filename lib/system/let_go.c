#include "system/let_go.h"

#include "system/assemble/stuck.h"
#include "system/ledger.h"

#define DMB_STUCK_REACHED (1.0 - 1e-12) /* [-] share from which on it lets go */

void dmb_stuck_lose(dmb_sim *sim, double before)
{
    if (sim->options.energy_ledger) dmb_ledger_take_impact(sim, 0.0, before - dmb_stuck_energy(sim, &sim->now));
}

uint32_t dmb_stuck_let_go(dmb_sim *sim)
{
    const double stored = dmb_stuck_energy(sim, &sim->now);
    uint32_t count = 0;
    for (uint32_t i = 0; i < sim->scene->stuck_count; i++) {
        if (!(dmb_stuck_share(sim, &sim->now, i, 1) >= DMB_STUCK_REACHED)) continue;
        dmb_stuck_set(sim, i, 0);
        if (sim->scene->stuck[i].input != DMB_NONE) sim->input_value[sim->scene->stuck[i].input] = 0.0;
        count++;
    }
    if (count > 0) dmb_stuck_lose(sim, stored);
    return count;
}
