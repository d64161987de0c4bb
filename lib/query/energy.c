/* The energy ledger. The powers in it are those of forces on the bodies; the forces of inertia and potential do the
 * negative of what the energies gain, exactly in continuous time. What is missing in discrete time, the time
 * integration has taken out (scheme). */
#include "system/energy.h"

#include <float.h>
#include <math.h>

#include "query/ask.h"
#include "system/joint_state.h"

DMB_DECLARE_STRUCT(dmb_energy)

static void energies_now(const dmb_sim *sim, dmb_energy *e)
{
    e->kinetic = dmb_kinetic_energy(sim->scene, &sim->now);
    e->strain = dmb_strain_energy(sim->scene, &sim->now) + dmb_joint_energy(sim, &sim->now);
    e->gravity = dmb_gravity_energy(sim->scene, &sim->now);
    e->contact = dmb_contact_energy(sim->scene, &sim->now);
}

/* balance = what went in less what was spent and what is stored; 0 in continuous time.
 *   scheme = -(work of inertia + work of potential) - (E - E_start)
 *   unexplained = balance - scheme = sum of all works: the residual's own, from iterations that stopped early */
static void balance(const dmb_ledger *ledger, dmb_energy *e)
{
    const double *work = ledger->work;
    const double gained = e->kinetic + e->strain + e->gravity + e->contact - ledger->start;
    e->drives = work[DMB_POWER_DRIVES];
    e->loads = work[DMB_POWER_LOADS];
    e->friction = -work[DMB_POWER_FRICTION];
    e->impact = -work[DMB_POWER_IMPACT];
    e->damping = -work[DMB_POWER_DAMPING];
    e->rock = -work[DMB_POWER_ROCK];
    e->input = ledger->input;
    e->scheme = -(work[DMB_POWER_INERTIA] + work[DMB_POWER_POTENTIAL]) - gained;
    e->balance = e->drives + e->loads - e->friction - e->impact - e->damping - e->rock - gained;
    e->unexplained = e->balance - e->scheme;
    e->error = e->input > 0.0 ? fmin(fabs(e->balance) / e->input, DBL_MAX) : 0.0; /* a breath of input is no infinity */
}

int32_t dmb_query_energy(const dmb_sim *sim, dmb_energy *energy)
{
    const int32_t status = dmb_ask(sim, energy);
    dmb_energy answer = {0};
    if (status < 0) return status;
    if (!sim->options.energy_ledger) return DMB_ERR_UNSUPPORTED;
    energies_now(sim, &answer);
    balance(sim->ledger, &answer);
    return dmb_energy_write(energy, &answer);
}
