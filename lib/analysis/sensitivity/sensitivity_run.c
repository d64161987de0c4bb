/* Rates along steps (eq:sensitivity.step): companion steps on both sides of each parameter for every step of the sim.
 *
 *     dmb_sim_step, _advance        the sim steps
 *       dmb_sensitivity_companions  called before a converged step is accepted:
 *         jump_all                    accelerations of the sides, if those of the sim were recomputed (a breakpoint)
 *         follow_all                  worker to the sim's state; factors; for each parameter high, low -> rates
 *     dmb_sensitivity_settle        rates accepted, or restored if the step was not
 *
 * `seen` holds displacements, velocities and accelerations of the sim to which the rates belong: it detects calls that
 * moved the sim without its rates (an error) and recomputed accelerations (a jump). */
#include <string.h>

#include "analysis/sensitivity/sensitivity.h"
#include "system/assemble/actuators.h"
#include "system/assemble/drives.h"
#include "system/system.h"

/* ---- Side of breakpoints ----------------------------------------------------------------------------------------- */

/* One switch after the other by the FNV-1a hash: states with equal hashes are on the same side of all switches, but for
 * chance. */
static uint64_t mix(uint64_t hash, int flag)
{
    return (hash ^ (flag != 0 ? UINT64_C(1) : UINT64_C(0))) * UINT64_C(0x100000001B3);
}

/* Controllers: limits and the interval of the gain table. Actuators: rate limit, sign of speed where drag has two
 * values, torque-speed curve. */
static uint64_t sides_of_drives(const dmb_sim *sim, uint64_t hash)
{
    for (uint32_t i = 0; i < sim->scene->drive_count; i++) {
        const dmb_scene_drive *drive = sim->scene->drives + i;
        if (drive->kind != DMB_DRIVE_CONTROL) continue;
        hash = mix(hash, sim->trial.drives[i].force <= drive->limit_low);
        hash = mix(hash, sim->trial.drives[i].force >= drive->limit_high);
        if (drive->table == DMB_NONE) continue;
        const dmb_gain_table *table = sim->scene->gain_tables + drive->table;
        const double error = sim->trial.drives[i].target - dmb_drive_speed(sim->scene, &sim->trial, i);
        for (uint32_t k = 0; k < table->points; k++) hash = mix(hash, error > table->error[k]);
    }
    for (uint32_t i = 0; i < sim->scene->drive_count && sim->scene->actuator_count > 0; i++) {
        const dmb_scene_drive *drive = sim->scene->drives + i;
        if (drive->actuator == DMB_NONE) continue;
        const dmb_actuator_law *law = sim->scene->actuators + drive->actuator;
        const dmb_actuator_flow *flow = dmb_actuator_flow_of(&sim->trial, drive->actuator);
        const double speed = dmb_drive_speed(sim->scene, &sim->trial, i);
        double slope = 0.0;
        hash = mix(hash, flow->limited != flow->delayed);
        hash = mix(hash, speed < 0.0 && law->drag[0] != law->drag[1]);
        hash = mix(hash, dmb_actuator_within(law, flow->force, speed, &slope) != flow->force);
    }
    return hash;
}

/* Hash of all switches of a state: contact, sticking of bristles, limits of controllers, bits on the rock. */
static uint64_t sides_of(const dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    const uint32_t bristles = dmb_scene_has_bristles(scene) ? 1 : 0;
    uint64_t hash = sides_of_drives(sim, UINT64_C(0xCBF29CE484222325));
    for (uint32_t i = 0; i < scene->site_count; i++) hash = mix(hash, sim->trial.site_penetration[i] > 0.0);
    for (uint32_t i = 0; i < bristles * scene->site_count; i++) hash = mix(hash, sim->trial.site_sticks[i]);
    for (uint32_t i = 0; i < bristles * scene->axial_torsional_site_count; i++)
        hash = mix(hash, sim->trial.axial_torsional_sticks[i]);
    for (uint32_t i = 0; i < scene->bit_count; i++)
        hash = mix(hash, sim->trial.bit_advance[i] > sim->trial.bit_bottom[i]);
    return hash;
}

/* ---- Along a step ------------------------------------------------------------------------------------------------ */

/* rates <- (high - low)/span. INPUTS are set by the caller and do not change; NaN: unset. */
static void add_difference(dmb_sensitivity *s, dmb_rated_parameter *p, const double *low, double span)
{
    size_t at = 0;
    dmb_state_fields of;
    dmb_state_fields_of(s->sim, DMB_GROUP_NOW, &of);
    for (size_t i = 0; i < of.count; i++) {
        if (!dmb_field_has_numbers(&of.field[i])) continue;
        const size_t end = at + of.field[i].bytes / sizeof(double);
        for (; at < end && of.field[i].check == DMB_CHECK_NUMBERS; at++) p->rates[at] = (s->high[at] - low[at]) / span;
        at = end;
    }
}

/* Operation on both sides of a parameter: a step, or recomputed accelerations. *sides is the hash of the switches at
 * its end. */
typedef int32_t (*move)(dmb_sensitivity *s, const dmb_nominal_step *nominal, double *to, uint64_t *sides);

static int32_t step_beside(dmb_sensitivity *s, const dmb_nominal_step *nominal, double *to, uint64_t *sides)
{
    const int32_t status = dmb_companion_step(s->worker, nominal);
    if (status < 0) return status;
    dmb_state_read(s->worker, DMB_GROUP_TRIAL, to);
    *sides = sides_of(s->worker);
    return DMB_OK;
}

static int32_t jump_beside(dmb_sensitivity *s, const dmb_nominal_step *nominal, double *to, uint64_t *sides)
{
    (void)nominal;
    const int32_t status = dmb_system_jump(s->worker);
    if (status < 0) return status;
    dmb_state_read(s->worker, DMB_GROUP_NOW, to);
    *sides = 0;
    return DMB_OK;
}

/* Both sides start from the present rates, which are replaced only after both have succeeded. A difference of their
 * switches, also from those of the sim for a one-sided parameter, is counted: the quotient is then a mean of two
 * one-sided derivatives. */
static int32_t move_parameter(dmb_sensitivity *s, const dmb_nominal_step *nominal, move move_beside,
                              dmb_rated_parameter *p, uint64_t middle_sides)
{
    uint64_t sides, low_sides = middle_sides;
    dmb_sensitivity_aside(s, p, DMB_SIDE_HIGH);
    int32_t status = move_beside(s, nominal, s->high, &sides);
    if (status >= 0 && !p->one_sided) {
        dmb_sensitivity_aside(s, p, DMB_SIDE_LOW);
        status = move_beside(s, nominal, s->low, &low_sides);
    }
    if (status < 0) return status;
    p->kinks += sides != low_sides;
    if (p->one_sided)
        add_difference(s, p, s->middle, p->step);
    else
        add_difference(s, p, s->low, 2.0 * p->step);
    return DMB_OK;
}

static int any_one_sided(const dmb_sensitivity *s)
{
    for (uint32_t i = 0; i < s->count; i++)
        if (s->parameters[i].one_sided) return 1;
    return 0;
}

void dmb_sensitivity_read_sight(dmb_sensitivity *s, const dmb_configuration *of)
{
    const size_t n = 3 * (size_t)s->sim->scene->node_count, r = s->sim->scene->row_count;
    memcpy(s->seen, of->displacement, n * sizeof(double));
    memcpy(s->seen + n, of->velocity, r * sizeof(double));
    memcpy(s->seen + n + r, of->acceleration, r * sizeof(double));
}

static int stands_as_seen(const dmb_sensitivity *s)
{
    const size_t n = 3 * (size_t)s->sim->scene->node_count, r = s->sim->scene->row_count;
    return memcmp(s->seen, s->sim->now.displacement, n * sizeof(double)) == 0 &&
           memcmp(s->seen + n, s->sim->now.velocity, r * sizeof(double)) == 0;
}

static int accelerates_as_seen(const dmb_sensitivity *s)
{
    const size_t n = 3 * (size_t)s->sim->scene->node_count, r = s->sim->scene->row_count;
    return memcmp(s->seen + n + r, s->sim->now.acceleration, r * sizeof(double)) == 0;
}

static int is_set_as_made(const dmb_sensitivity *s)
{
    const size_t bytes = s->sim->scene->input_count * sizeof *s->settings;
    return bytes == 0 || memcmp(s->settings, s->sim->input_value, bytes) == 0;
}

static int32_t explain(const dmb_sensitivity *s, const dmb_rated_parameter *p, int32_t status, const char *what)
{
    const uint32_t number = p != NULL ? (uint32_t)(p - s->parameters) : 0;
    if (p == NULL)
        dmb_message_set(&s->sim->message, "sensitivity: %s at time %g: %s; a shorter step may help", what,
                        s->sim->clock->time, dmb_status_text(status));
    else
        dmb_message_set(&s->sim->message,
                        "sensitivity: parameter %u (%s): %s at time %g: %s; a shorter step, or a smaller difference of "
                        "its sims, may help",
                        number, p->name, what, s->sim->clock->time, dmb_status_text(status));
    return status;
}

/* Operates on the sim's own companion, for one-sided parameters, then on each parameter. */
static int32_t move_all(dmb_sensitivity *s, const dmb_nominal_step *nominal, move move_beside, const char *what)
{
    uint64_t sides = 0;
    int32_t status = any_one_sided(s) ? move_beside(s, nominal, s->middle, &sides) : DMB_OK;
    if (status < 0) return explain(s, NULL, status, what);
    for (uint32_t i = 0; i < s->count; i++) {
        status = move_parameter(s, nominal, move_beside, &s->parameters[i], sides);
        if (status < 0) return explain(s, &s->parameters[i], status, what);
    }
    return DMB_OK;
}

/* The factors of the sim's tangent are prepared once for all companion steps. A one-sided parameter needs a companion
 * step of the sim itself, so that the error of the correction is equal on both ends of the difference and cancels. */
static int32_t follow_all(dmb_sensitivity *s, const dmb_nominal_step *nominal)
{
    dmb_sensitivity_stand(s);
    int32_t status = dmb_companion_prepare(s->worker, nominal);
    if (status < 0) return explain(s, NULL, status, "tangent of the step");
    if (any_one_sided(s)) dmb_sensitivity_stand(s);
    return move_all(s, nominal, step_beside, "step beside the step");
}

static int32_t jump_all(dmb_sensitivity *s)
{
    dmb_sensitivity_stand(s);
    return move_all(s, NULL, jump_beside, "accelerations after a jump");
}

void dmb_sensitivity_note_opening(void *context)
{
    dmb_sensitivity *s = context;
    memcpy(s->workspace.opening, s->sim->increment, s->sim->scene->row_count * sizeof(double));
}

int32_t dmb_sensitivity_companions(void *context, const dmb_trial_step *trial_step)
{
    dmb_sensitivity *s = context;
    const dmb_nominal_step nominal = {s->sim, trial_step, &s->workspace};
    if (s->advances) dmb_sensitivity_settle(s, 0); /* completed steps are kept, whatever the result of this one */
    s->followed = 0;
    s->followed_from = s->sim->clock->time;
    const int32_t status = accelerates_as_seen(s) ? DMB_OK : jump_all(s);
    if (status < 0) return status;
    const int32_t followed = follow_all(s, &nominal);
    if (followed < 0) return followed;
    dmb_sensitivity_read_sight(s, &s->sim->trial);
    /* with the accelerations that bounces leave when the step is accepted: no jump of theirs is to be followed */
    if (trial_step->bounced)
        dmb_bounces_add_accelerations(s->sim,
                                      s->seen + 3 * (size_t)s->sim->scene->node_count + s->sim->scene->row_count);
    s->followed = 1;
    return followed;
}

/* ---- Calls ------------------------------------------------------------------------------------------------------- */

static uint64_t kinks_of(const dmb_sensitivity *s)
{
    uint64_t kinks = 0;
    for (uint32_t i = 0; i < s->count; i++) kinks += s->parameters[i].kinks;
    return kinks;
}

void dmb_sensitivity_settle(dmb_sensitivity *s, int back)
{
    for (uint32_t i = 0; i < s->count; i++) {
        dmb_rated_parameter *p = &s->parameters[i];
        double *from = back ? p->accepted : p->rates, *to = back ? p->rates : p->accepted;
        memcpy(to, from, s->numbers * sizeof(double));
        if (back) p->kinks = p->accepted_kinks;
        p->accepted_kinks = p->kinks;
    }
    if (back) dmb_sensitivity_read_sight(s, &s->sim->now);
}

int32_t dmb_sensitivity_stands(const dmb_sensitivity *s)
{
    if (stands_as_seen(s)) return DMB_OK;
    dmb_message_set(
        &s->sim->message,
        "sensitivity: the sim was moved by other calls than dmb_sensitivity_step and _advance; make a new one "
        "from here");
    return DMB_ERR_ORDER;
}

int32_t dmb_sensitivity_catch_up(dmb_sensitivity *s)
{
    if (accelerates_as_seen(s)) return DMB_OK;
    const int32_t status = jump_all(s);
    if (status >= 0) {
        dmb_sensitivity_read_sight(s, &s->sim->now);
        dmb_sensitivity_settle(s, 0);
        return status;
    }
    for (uint32_t i = 0; i < s->count; i++)
        memcpy(s->parameters[i].rates, s->parameters[i].accepted, s->numbers * sizeof(double));
    return status;
}

/* 1: the sim has accepted the step of the last companion steps; 0: these were not completed, or the step was undone. */
static int has_seen_the_last(const dmb_sensitivity *s)
{
    return s->followed && s->sim->clock->time > s->followed_from;
}

/* Fails before the step: sets the message of the sim, or the text of the status if that is empty. */
static int32_t refuse(const dmb_sensitivity *s, int32_t status)
{
    return dmb_sim_fail(s->sim, status, "sensitivity", s->sim->message.text);
}

/* A step or an advance of the sim with the rates. A failed step restores all of it; a failed advance keeps its
 * completed steps. Order of the checks before the step: live handle, sim not moved otherwise, inputs as at creation,
 * accelerations. The follower is attached only during the call. After a failed step, and after a failed advance whose
 * last companion steps were not accepted, the rates are those of the last accepted state. */
static int32_t run(dmb_sensitivity *s, double to, dmb_step_report *report, int step)
{
    int32_t status = dmb_sensitivity_alive(s);
    if (status < 0) return dmb_failed("sensitivity", status);
    status = dmb_sensitivity_stands(s);
    if (status < 0) return refuse(s, status);
    if (!is_set_as_made(s)) {
        dmb_message_set(&s->sim->message,
                        "sensitivity: inputs were set since it was made, must stay; make a new one from here");
        return refuse(s, DMB_ERR_ORDER);
    }
    dmb_message_clear(&s->sim->message);
    status = dmb_sensitivity_catch_up(s);
    if (status < 0) return refuse(s, status);
    const uint64_t kinks = kinks_of(s);
    s->busy = 1;
    s->advances = !step;
    s->followed = 0;
    s->sim->follower = &s->follower;
    status = step ? dmb_sim_step(s->sim, to, report) : dmb_sim_advance(s->sim, to, report);
    s->sim->follower = NULL;
    dmb_sensitivity_settle(s, status < 0 && (step || !has_seen_the_last(s)));
    s->busy = 0;
    (void)dmb_sensitivity_catch_up(s); /* at a new breakpoint; if it fails, the next call reports it */
    if (status != DMB_OK || kinks_of(s) == kinks) return status;
    dmb_message_set(&s->sim->message,
                    "sensitivity: up to %g s contact, sticking, limit or bit differed between the sides of a parameter "
                    "in %u steps: a mean of two derivatives",
                    s->sim->clock->time, (uint32_t)(kinks_of(s) - kinks));
    return DMB_NOTE_NOT_SMOOTH;
}

int32_t dmb_sensitivity_step(dmb_sensitivity *sensitivity, double duration, dmb_step_report *report)
{
    return run(sensitivity, duration, report, 1);
}

int32_t dmb_sensitivity_advance(dmb_sensitivity *sensitivity, double time, dmb_step_report *report)
{
    return run(sensitivity, time, report, 0);
}
