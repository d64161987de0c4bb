#include "system/ledger.h"
#include "system/assemble/caller_force.h"
#include "system/assemble/springs.h"
#include "system/assemble/stuck.h"

#include <math.h>
#include <string.h>

#include "system/assemble/drives.h"
#include "system/assemble/energy.h"
#include "system/constrain/joint_motion.h"

static double drive_power(const dmb_sim *sim, const dmb_configuration *c, uint32_t i)
{
    return c->drive_force[i] * dmb_drive_speed(sim->scene, c, i);
}

/* Powers of an evaluation, with what the motion drives do through the rows they hold. */
static void powers(const dmb_sim *sim, const dmb_evaluation *evaluation, double power[8])
{
    memcpy(power, evaluation->power, sizeof evaluation->power);
    for (uint32_t i = 0; i < sim->scene->drive_count; i++)
        if (sim->scene->drives[i].kind == DMB_DRIVE_MOTION)
            power[DMB_POWER_DRIVES] += drive_power(sim, evaluation->step > 0.0 ? &sim->trial : &sim->now, i);
}

/* Energies at the start; from there on kinetic + stored = start + sum of works, but for the error of the scheme. */
void dmb_ledger_start(dmb_sim *sim, const dmb_evaluation *evaluation)
{
    memset(sim->ledger, 0, sizeof *sim->ledger);
    for (uint32_t i = 0; i < sim->scene->drive_count; i++) sim->drive_work[i] = 0.0;
    powers(sim, evaluation, sim->clock->power);
    sim->ledger->start = dmb_kinetic_energy(sim->scene, &sim->now) + dmb_strain_energy(sim->scene, &sim->now) +
                         dmb_gravity_energy(sim->scene, &sim->now) + dmb_contact_energy(sim->scene, &sim->now) +
                         dmb_joint_energy(sim, &sim->now) + dmb_springs_energy(sim->scene, &sim->now) +
                         dmb_caller_forces_energy(sim->scene, &sim->now) + dmb_stuck_energy(sim, &sim->now);
}

void dmb_ledger_jump(dmb_sim *sim, const dmb_evaluation *evaluation)
{
    powers(sim, evaluation, sim->clock->power);
}

/* [s] Share of the step that the powers at its start and end stand for: half and half, or up to a corner inside, at
 * which powers jump, and from there on. */
static void shares_of(const dmb_evaluation *evaluation, double *first, double *second)
{
    *first = *second = 0.5 * evaluation->step;
    if (!(evaluation->inside > 0.0)) return;
    *first = evaluation->inside - evaluation->sim->clock->time;
    *second = evaluation->step - *first;
}

/* Work of each kind by the trapezoidal rule over the step, h (P0 + P1)/2, which is of the order of the scheme. `input`
 * sums magnitudes: what an error of the balance is measured by. */
void dmb_ledger_add(dmb_sim *sim, const dmb_evaluation *evaluation)
{
    double power[8], *last = sim->clock->power, first, second;
    shares_of(evaluation, &first, &second);
    powers(sim, evaluation, power);
    for (int k = 0; k < DMB_POWER_COUNT; k++) sim->ledger->work[k] += first * last[k] + second * power[k];
    sim->ledger->input += first * fabs(last[DMB_POWER_LOADS]) + second * fabs(power[DMB_POWER_LOADS]);
    for (uint32_t i = 0; i < sim->scene->drive_count; i++) {
        const double before = drive_power(sim, &sim->now, i), after = drive_power(sim, &sim->trial, i);
        sim->drive_work[i] += first * before + second * after;
        sim->ledger->input += first * fabs(before) + second * fabs(after);
    }
    memcpy(last, power, sizeof power);
}

/* Energy that changes at once (a joint closes): kinetic and stored energy that are lost are work of the impact. */
void dmb_ledger_take_impact(dmb_sim *sim, double kinetic, double stored)
{
    sim->ledger->work[DMB_POWER_IMPACT] -= kinetic + stored;
    sim->ledger->work[DMB_POWER_INERTIA] += kinetic;
    sim->ledger->work[DMB_POWER_POTENTIAL] += stored;
}

void dmb_ledger_take_change(dmb_sim *sim, double stored)
{
    sim->ledger->work[DMB_POWER_LOADS] += stored;
    sim->ledger->work[DMB_POWER_POTENTIAL] -= stored;
    sim->ledger->input += fabs(stored);
}
