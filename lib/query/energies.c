/* The energy ledger. The powers in it are those of forces on the bodies; the forces of inertia and potential do the
 * negative of what the energies gain, exactly in continuous time. The part that is missing in discrete time, the time
 * integration has taken out (scheme). */
#include <float.h>
#include <math.h>

#include "query/mass.h"
#include "query/place.h"
#include "query/reactions.h"
#include "sim/access.h"
#include "sim/layout.h"
#include "system/assemble/caller_force.h"
#include "system/assemble/energy.h"
#include "system/assemble/springs.h"
#include "system/assemble/stuck.h"
#include "system/constrain/joint_motion.h"

DMB_DECLARE_STRUCT(dmb_energy)

static void energies_now(const dmb_sim *sim, dmb_energy *e)
{
    e->kinetic = dmb_kinetic_energy(sim->scene, &sim->now);
    e->strain = dmb_strain_energy(sim->scene, &sim->now) + dmb_joint_energy(sim, &sim->now) +
                dmb_springs_energy(sim->scene, &sim->now) + dmb_caller_forces_energy(sim->scene, &sim->now) +
                dmb_stuck_energy(sim, &sim->now);
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

/* Kinetic energy part by part: a pipe's own, eccentricity included, and half of what is fixed to its two ends: its tool
 * joint, that of the pipe before it, and the bodies and bits at the ends of the string. */

static double elastic_body(const dmb_sim *sim, const dmb_described_pipe *pipe)
{
    double sum = 0.0;
    dmb_rigid_mass share;
    for (uint32_t i = 0; i < pipe->map->elements; i++) {
        const uint32_t element = pipe->map->element + i;
        sum += dmb_element_kinetic_energy(sim->scene, &sim->now, element);
        for (uint32_t end = 0; pipe->eccentric && end < 2; end++) {
            dmb_eccentric_share(sim->scene, pipe, element, end, &share);
            sum += dmb_share_kinetic_energy(sim, &share);
        }
    }
    return sum;
}

static double rigid_body(const dmb_sim *sim, const dmb_described_pipe *pipe)
{
    dmb_rigid_mass share;
    dmb_rigid_pipe_share(pipe, &share);
    return dmb_share_kinetic_energy(sim, &share);
}

static double joint_energy(const dmb_sim *sim, const dmb_described_pipe *pipe)
{
    dmb_rigid_mass share;
    if (!(pipe->map->joint > 0.0)) return 0.0;
    dmb_joint_share(sim->scene, pipe, &share);
    return dmb_share_kinetic_energy(sim, &share);
}

static double body_energy(const dmb_sim *sim, uint32_t body)
{
    dmb_rigid_mass share;
    dmb_body_share(sim, body, &share);
    return dmb_share_kinetic_energy(sim, &share);
}

/* Bodies and bits fixed to one end of a string; an id that names nothing is the first string. */
static double end_bodies(const dmb_sim *sim, uint32_t string, int32_t attach)
{
    const dmb_model *model = sim->model;
    double sum = 0.0;
    for (uint32_t i = 0; i < sim->scene->body_count; i++)
        if (dmb_body_is_at_end(model, i, string, attach)) sum += body_energy(sim, i);
    return sum;
}

static double end_energy(const dmb_sim *sim, const dmb_described_pipe *pipe)
{
    double sum = joint_energy(sim, pipe);
    if (pipe->number > 0) {
        dmb_described_pipe before;
        dmb_describe_pipe(sim, pipe->string, pipe->number - 1, &before);
        sum += joint_energy(sim, &before);
    } else {
        sum += end_bodies(sim, pipe->string, DMB_ATTACH_START);
    }
    if (pipe->number + 1 == sim->scene->strings[pipe->string].pipe_count)
        sum += end_bodies(sim, pipe->string, DMB_ATTACH_END);
    return sum;
}

static int32_t pipe_energy(const dmb_sim *sim, dmb_id part, uint32_t number, double *energy)
{
    dmb_described_pipe pipe;
    int32_t status;
    if (dmb_pipe_of(sim, part, number, &status) == NULL) return status;
    dmb_describe_pipe(sim, dmb_model_part_index(sim->model, part, DMB_PART_STRING), number, &pipe);
    *energy = pipe.map->elements > 0 ? elastic_body(sim, &pipe) : rigid_body(sim, &pipe);
    *energy += 0.5 * end_energy(sim, &pipe);
    return DMB_OK;
}

int32_t dmb_query_kinetic_energy(const dmb_sim *sim, dmb_id part, uint32_t pipe, double *energy)
{
    const int32_t status = dmb_ask(sim, energy);
    uint32_t body;
    if (status < 0) return status;
    body = dmb_body_index(sim, part);
    if (body == DMB_NONE) return pipe_energy(sim, part, pipe, energy);
    if (pipe != 0) return DMB_ERR_VALUE;
    *energy = body_energy(sim, body);
    return DMB_OK;
}

DMB_DECLARE_STRUCT(dmb_statistics)

static void count_constraints(const dmb_sim *sim, dmb_statistics *answer)
{
    for (uint32_t k = 0; k < sim->scene->cluster_count; k++) answer->dependent += sim->partition_rank[k];
    for (uint32_t i = 0; i < sim->scene->constraint_count; i++) answer->redundant += dmb_constraint_active(sim, i);
    answer->redundant -= answer->dependent;
    for (uint32_t j = 0; j < sim->scene->joint_count; j++)
        answer->violation = fmax(answer->violation, dmb_joint_violation(sim, j));
}

int32_t dmb_query_statistics(const dmb_sim *sim, dmb_statistics *statistics)
{
    const int32_t status = dmb_ask(sim, statistics);
    dmb_statistics answer = {0};
    const dmb_counters *counters;
    if (status < 0) return status;
    counters = sim->counters;
    answer.most_iterations = (uint32_t)counters->most_iterations;
    answer.steps = counters->steps;
    answer.rejected = counters->rejected;
    answer.iterations = counters->iterations;
    answer.limited_steps = counters->limited;
    answer.bytes = dmb_sim_bytes(sim->scene);
    answer.largest_residual = counters->largest_residual;
    answer.projection[0] = counters->projection[0];
    answer.projection[1] = counters->projection[1];
    answer.assembly[0] = counters->assembly[0];
    answer.assembly[1] = counters->assembly[1];
    answer.switches = counters->switches;
    count_constraints(sim, &answer);
    return dmb_statistics_write(statistics, &answer);
}
