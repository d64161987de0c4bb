/* Ledger of energy: works of the classes of force over accepted steps, and the error of their balance (eq:motion.work,
 * eq:motion.trapezoid-excess). Order of dmb_ledger_add:
 *
 *     1. trapezoidal rule of all powers, between the stored ones of the start and those of the evaluation
 *     2. its excess over the work of the step, of friction, dampers, rock and drives (ledger_work.c), is moved to the
 *        potential forces: the works of all classes still sum to that of the residual
 *     3. the powers become those of the next start; the balance is stored at growing intervals
 *
 * Balance: works of loads, drives, friction, impact, damping and rock less the growth of the stored energies. It is the
 * error of the time integration; no work is computed by closing it. */
#include "system/assemble/ledger.h"

#include <math.h>
#include <string.h>

#include "system/assemble/drives.h"
#include "system/assemble/energy.h"

/* [W] Of a drive in a configuration. */
static double drive_power(const dmb_sim *sim, const dmb_configuration *c, uint32_t i)
{
    return c->drives[i].force * dmb_drive_speed(sim->scene, c, i);
}

/* Powers of an evaluation, with those of motion drives through their constrained rows. */
static void powers(const dmb_sim *sim, const dmb_evaluation *evaluation, double power[8])
{
    memcpy(power, evaluation->power, sizeof evaluation->power);
    for (uint32_t i = 0; i < sim->scene->drive_count; i++)
        if (sim->scene->drives[i].kind == DMB_DRIVE_MOTION)
            power[DMB_POWER_DRIVES] += drive_power(sim, evaluation->step > 0.0 ? &sim->trial : &sim->now, i);
}

double dmb_ledger_balance(const dmb_ledger *ledger, double stored)
{
    double sum = 0.0;
    for (int k = DMB_POWER_LOADS; k < DMB_POWER_COUNT; k++) sum += ledger->work[k];
    return sum - (stored - ledger->start);
}

/* Stores the balance each time the elapsed time has grown by the fraction DMB_LEDGER_SPACING. */
static void mark_balance(dmb_sim *sim, double time)
{
    dmb_ledger *ledger = sim->ledger;
    double *mark = ledger->mark;
    if (time - ledger->since < (1.0 + DMB_LEDGER_SPACING) * (mark[0] - ledger->since)) return;
    memmove(mark + 2, mark, 2 * (DMB_LEDGER_MARKS - 1) * sizeof *mark);
    mark[0] = time;
    mark[1] = dmb_ledger_balance(ledger, dmb_energy_stored(sim, &sim->trial));
}

/* Interpolated between the stored marks; outside of them the value of the nearest one. */
double dmb_ledger_balance_before(const dmb_ledger *ledger, double time)
{
    const double *mark = ledger->mark;
    int k = 0;
    while (k < DMB_LEDGER_MARKS - 1 && mark[2 * k] > time) k++;
    if (mark[2 * k] > time) return mark[2 * k + 1];
    if (k == 0) return mark[1];
    const double part = (time - mark[2 * k]) / (mark[2 * k - 2] - mark[2 * k]);
    return mark[2 * k + 1] + part * (mark[2 * k - 1] - mark[2 * k + 1]);
}

/* Energies at the start; later kinetic + stored = start + sum of works + error of the scheme. */
void dmb_ledger_start(dmb_sim *sim, const dmb_evaluation *evaluation)
{
    memset(sim->ledger, 0, sizeof *sim->ledger);
    for (uint32_t i = 0; i < sim->scene->drive_count; i++) sim->drive_work[i] = 0.0;
    powers(sim, evaluation, sim->clock->power);
    sim->ledger->start = dmb_energy_stored(sim, &sim->now);
    sim->ledger->since = sim->clock->time;
    for (int k = 0; k < DMB_LEDGER_MARKS; k++) sim->ledger->mark[2 * k] = sim->clock->time;
}

void dmb_ledger_jump(dmb_sim *sim, const dmb_evaluation *evaluation)
{
    powers(sim, evaluation, sim->clock->power);
    dmb_ledger_copy_forces(sim);
}

/* Half of the step each, or the parts before and after a breakpoint inside, at which powers jump. */
static dmb_ledger_parts parts_of(const dmb_evaluation *evaluation)
{
    dmb_ledger_parts parts = {0.5 * evaluation->step, 0.5 * evaluation->step};
    if (!(evaluation->inside > 0.0)) return parts;
    parts.first = evaluation->inside - evaluation->sim->clock->time;
    parts.second = evaluation->step - parts.first;
    return parts;
}

/* Work of each drive, and the excess of the trapezoidal rule over it. `input`: sum of magnitudes, the scale for errors
 * of the balance. */
static double add_drives(dmb_sim *sim, const dmb_ledger_parts *parts)
{
    const dmb_scene *scene = sim->scene;
    double sum = 0.0;
    for (uint32_t i = 0; i < scene->drive_count; i++) {
        const double before = drive_power(sim, &sim->now, i), after = drive_power(sim, &sim->trial, i);
        const double excess = dmb_ledger_excess(parts, sim->now.drives[i].force, dmb_drive_speed(scene, &sim->now, i),
                                                sim->trial.drives[i].force, dmb_drive_speed(scene, &sim->trial, i));
        sim->drive_work[i] += parts->first * before + parts->second * after - excess;
        sim->ledger->input += parts->first * fabs(before) + parts->second * fabs(after) + fabs(excess);
        sum += excess;
    }
    return sum;
}

/* Work of each kind over the step: by the trapezoidal rule, less its excess over the step's own work if forces and
 * speeds both change fast (eq:motion.work, eq:motion.trapezoid-excess). */
void dmb_ledger_add(dmb_sim *sim, const dmb_evaluation *evaluation, int released)
{
    double power[8], *last = sim->clock->power, friction = 0.0, damping = 0.0;
    const dmb_ledger_parts parts = parts_of(evaluation);
    powers(sim, evaluation, power);
    for (int k = 0; k < DMB_POWER_COUNT; k++) sim->ledger->work[k] += parts.first * last[k] + parts.second * power[k];
    sim->ledger->input += parts.first * fabs(last[DMB_POWER_LOADS]) + parts.second * fabs(power[DMB_POWER_LOADS]);
    dmb_ledger_joint_excess(sim, &parts, &friction, &damping);
    friction += dmb_ledger_friction_excess(sim, &parts) + dmb_ledger_wall_excess(sim, &parts, released);
    dmb_ledger_move(sim, DMB_POWER_FRICTION, friction);
    damping += dmb_ledger_damping_excess(sim, &parts) + dmb_ledger_spring_excess(sim, &parts);
    dmb_ledger_move(sim, DMB_POWER_DAMPING, damping);
    dmb_ledger_move(sim, DMB_POWER_ROCK, dmb_ledger_rock_excess(sim, &parts));
    dmb_ledger_move(sim, DMB_POWER_DRIVES, add_drives(sim, &parts));
    memcpy(last, power, sizeof power);
    mark_balance(sim, evaluation->time);
}

/* Both classes change by the same amount, so that their sum stays. */
void dmb_ledger_move(dmb_sim *sim, int kind, double excess)
{
    sim->ledger->work[kind] -= excess;
    sim->ledger->work[DMB_POWER_POTENTIAL] += excess;
}

/* Instantaneous change of energy (a joint closes): lost kinetic and stored energy are work of the impact. */
void dmb_ledger_add_impact(dmb_sim *sim, double kinetic, double stored)
{
    sim->ledger->work[DMB_POWER_IMPACT] -= kinetic + stored;
    sim->ledger->work[DMB_POWER_INERTIA] += kinetic;
    sim->ledger->work[DMB_POWER_POTENTIAL] += stored;
}

void dmb_ledger_add_rock(dmb_sim *sim, double stored)
{
    sim->ledger->work[DMB_POWER_ROCK] -= stored;
    sim->ledger->work[DMB_POWER_POTENTIAL] += stored;
}

/* Parameters that the caller changes give the poses another energy without a motion: it is work of the loads. */
void dmb_ledger_add_change(dmb_sim *sim, double stored)
{
    sim->ledger->work[DMB_POWER_LOADS] += stored;
    sim->ledger->work[DMB_POWER_POTENTIAL] -= stored;
    sim->ledger->input += fabs(stored);
}
