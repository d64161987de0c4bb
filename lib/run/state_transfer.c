/* Transfer of the state to a sim of another model: pipes are added or removed at the rig end of a string. Poses and
 * speeds in the world are kept; what is stored relative to the description is converted.
 *
 *     compare       both models (state_transfer_check); nothing is changed by a refusal
 *     back up       from here on a failure restores the state and the own scene
 *     counters      clock, statistics
 *     drives        memory, inputs, events; own scene
 *     hole          widening by cutters, interpolated between stations
 *     nodes         from the far end (state_transfer_nodes)
 *     stuck         anchors; the same point of the string is required
 *     contacts      by place on the string (state_transfer_sites)
 *     joints        turns, states, locks, multipliers
 *     bits          rock relative to the new description; needs the poses
 *     check         closed joints at the new poses
 *     restart       velocities projected, accelerations and reactions (dmb_system_restart)
 *     contacts      once more: age and bristles, which the evaluation of the restart has overwritten
 *     bounces       mean forces under way
 *     ledger        energy at the start, by the energy now
 *
 * The second pass over contacts and the bounces come after the restart, which starts both anew. Kept factors are
 * dropped at the end. */
#include "run/run.h"

#include <math.h>
#include <string.h>

#include "sim/access.h"
#include "sim/layout.h"
#include "sim/node.h"
#include "sim/own_scene.h"
#include "system/assemble/assemble.h"
#include "system/assemble/caller_force.h"
#include "system/assemble/energy.h"
#include "system/constrain/constrain.h"
#include "system/solve/solve.h"
#include "system/system.h"

/* [m, -] violation of a joint at the transferred poses beyond rounding; as for dmb_sim_set_joint. */
#define DMB_TRANSFER_VIOLATION 1e-6

/* Arrays of equal length in both sims. */
#define DMB_COPY(field, count) memcpy(sim->field, from->field, (size_t)(count) * sizeof *sim->field)

/* ---- Memory ------------------------------------------------------------------------------------------------------ */

static void transfer_drives(dmb_sim *sim, const dmb_sim *from)
{
    const uint32_t d = sim->scene->drive_count;
    DMB_COPY(now.drives, d);
    DMB_COPY(now.actuator, 4 * (size_t)sim->scene->actuator_count);
    DMB_COPY(delay_line, 2 * (size_t)DMB_DELAY_SAMPLES * sim->scene->delay_count);
    DMB_COPY(drive_input, d);
    DMB_COPY(drive_offset, d);
    DMB_COPY(now.load_factor, sim->scene->load_count);
    DMB_COPY(now.force_potential, sim->scene->force_count);
    DMB_COPY(now.force_state, sim->scene->force_states);
    DMB_COPY(input_value, sim->scene->input_count);
    DMB_COPY(input_begin, 3 * (size_t)sim->scene->input_count);
    DMB_COPY(event_since, sim->scene->event_count);
    DMB_COPY(event_side, sim->scene->event_count);
    DMB_COPY(event_past, DMB_PAST_SIZE * (size_t)sim->scene->event_count);
    dmb_own_scene_update(sim);
}

static void transfer_counters(dmb_sim *sim, const dmb_sim *from)
{
    DMB_COPY(counters, 1);
    DMB_COPY(clock, 1);
    memset(sim->clock->power, 0, sizeof sim->clock->power);
    memset(sim->counters->projection, 0, sizeof sim->counters->projection); /* of this call; see keep_projection */
    memset(sim->site_history, 0, sim->scene->site_count * sizeof(double));
}

/* Constraints are sorted by component, and components may be numbered differently. */
static void transfer_rows(dmb_sim *sim, uint32_t to, const dmb_sim *from, uint32_t old)
{
    const dmb_constraint *a = sim->scene->constraints + to, *b = from->scene->constraints + old;
    memcpy(sim->now.multiplier + a->row, from->now.multiplier + b->row, a->rows * sizeof(double));
    memcpy(sim->constraint_offset + a->row, from->constraint_offset + b->row, a->rows * sizeof(double));
}

static void transfer_all_rows(dmb_sim *sim, const dmb_sim *from)
{
    const dmb_scene *a = sim->scene, *b = from->scene;
    for (uint32_t i = 0; i < a->joint_count; i++)
        transfer_rows(sim, a->joints[i].constraint, from, b->joints[i].constraint);
    for (uint32_t i = 0; i < a->coupling_count; i++)
        transfer_rows(sim, a->couplings[i].constraint, from, b->couplings[i].constraint);
    for (uint32_t i = 0; i < a->callback_count; i++)
        transfer_rows(sim, a->callbacks[i].constraint, from, b->callbacks[i].constraint);
    for (uint32_t i = 0; i < a->drive_count; i++)
        if (a->drives[i].constraint != DMB_NONE)
            transfer_rows(sim, a->drives[i].constraint, from, b->drives[i].constraint);
}

static void transfer_joints(dmb_sim *sim, const dmb_sim *from)
{
    const dmb_scene *a = sim->scene;
    DMB_COPY(now.joint_turn, 2 * (size_t)a->joint_count);
    DMB_COPY(now.joint_depth, a->joint_count);
    DMB_COPY(now.joint_segment, a->joint_count);
    DMB_COPY(joint_state, a->joint_count);
    DMB_COPY(joint_lock, 12 * (size_t)a->joint_count);
    transfer_all_rows(sim, from);
}

/* 1: the rig ends and supports of both scenes have the same rows. */
static int same_supports(const dmb_scene *a, const dmb_scene *b)
{
    const size_t size = a->constrained_count * sizeof *a->constrained_node;
    return a->node_count == b->node_count && a->constrained_count == b->constrained_count &&
           (size == 0 || (memcmp(a->constrained_node, b->constrained_node, size) == 0 &&
                          memcmp(a->constrained_component, b->constrained_component, size) == 0));
}

/* Reactions at joints, and of supports if these are the same. */
static void transfer_reactions(dmb_sim *sim, const dmb_sim *from)
{
    const dmb_scene *scene = sim->scene;
    const int same = same_supports(scene, from->scene);
    if (scene->cluster_count) transfer_all_rows(sim, from);
    if (same) DMB_COPY(support_reaction, scene->constrained_count);
    for (uint32_t i = 0; i < scene->drive_count; i++)
        if (scene->drives[i].kind == DMB_DRIVE_MOTION && (same || scene->drives[i].joint != DMB_NONE))
            sim->now.drives[i].force = from->now.drives[i].force;
}

/* Bounces under way. Reactions remain those of the step before, which had their mean forces. A contact that opened in
 * that step is no longer in the state: the reactions are then those of the state. */
static int32_t transfer_bounces(dmb_sim *sim, const dmb_sim *from)
{
    int32_t found;
    dmb_state_transfer_sites(sim, from, DMB_TRANSFER_AGAIN);
    const int32_t status = dmb_bounces_go_on(sim, from, &found);
    if (status < 0 || !found) return status;
    transfer_reactions(sim, from);
    return DMB_OK;
}

/* ---- Bits -------------------------------------------------------------------------------------------------------- */

/* The rock does not move: advances are relative to the described pose, and the angle of the cut surface follows the
 * rotation of the bit. */
static void transfer_bit(dmb_sim *sim, uint32_t k, const dmb_sim *from)
{
    const dmb_scene_bit *bit = sim->scene->bits + k, *was = from->scene->bits + k;
    const double moved = sim->trial.bit_advance[k] - from->now.bit_advance[k];
    sim->now.bit_advance[k] = sim->trial.bit_advance[k];
    sim->now.bit_segment[k] = sim->trial.bit_segment[k];
    sim->now.bit_load[k] = from->now.bit_load[k];
    sim->now.bit_bottom[k] = from->now.bit_bottom[k] + moved;
    sim->history_head[k] = from->history_head[k];
    sim->history_head[k].offset -= sim->now.turn[bit->node] - from->now.turn[was->node];
    memcpy(sim->history_angle + bit->history_first, from->history_angle + was->history_first,
           bit->history_capacity * sizeof(double));
    memcpy(sim->history_surface + bit->history_first, from->history_surface + was->history_first,
           bit->history_capacity * sizeof(double));
    for (uint32_t i = 0; i < sim->history_head[k].count; i++) /* none where there is no room for any */
        sim->history_surface[bit->history_first + i] += moved;
}

/* Positions of bits on the axis are found by the evaluation of their forces. */
static void transfer_bits(dmb_sim *sim, const dmb_sim *from, dmb_evaluation *evaluation)
{
    const dmb_scene *scene = sim->scene;
    memcpy(sim->now.bit_segment, from->now.bit_segment, scene->bit_count * sizeof *sim->now.bit_segment);
    memcpy(sim->trial.bit_segment, from->now.bit_segment, scene->bit_count * sizeof *sim->now.bit_segment);
    dmb_assemble_bits(evaluation);
    for (uint32_t k = 0; k < scene->bit_count; k++) {
        transfer_bit(sim, k, from);
        dmb_hole_make_room(sim, k, sim->now.bit_bottom[k]); /* of a sim whose cutters did not widen it */
    }
}

/* ---- The hole ---------------------------------------------------------------------------------------------------- */

/* [m] Increase of the radius over the described one at a depth. */
static double widening_at(const dmb_sim *sim, double depth)
{
    double widening[3] = {0.0, 0.0, 0.0};
    if (sim->scene->hole.cuts > 0) dmb_hole_widening_at(&sim->scene->hole, depth, widening);
    return widening[0];
}

/* The other model must have stations where the hole was cut. */
static int32_t check_cut(dmb_sim *sim, const dmb_sim *from)
{
    const dmb_hole *to = &sim->scene->hole, *old = &from->scene->hole;
    for (uint32_t j = 0; j < old->cuts; j++) {
        const double depth = dmb_hole_cut_depth(old, j), slack = 1e-9 * old->cut_spacing;
        if (!(from->hole_widening[j] > 0.0)) continue;
        const double first = dmb_hole_cut_depth(to, 1) - slack, last = dmb_hole_cut_depth(to, to->cuts - 2) + slack;
        if (to->cuts > 0 && depth >= first && depth <= last) continue;
        dmb_message_set(&sim->message,
                        "state transfer: wall: the hole is widened by %g m at measured depth %g m, must be within the "
                        "stations of the other model that may be cut; give its wall cut_spacing, cut_start and cut_end "
                        "that hold it, and a bit with a rock law",
                        from->hole_widening[j], depth);
        return DMB_ERR_GEOMETRY;
    }
    return DMB_OK;
}

/* Between stations of other places by depth. */
static int32_t transfer_hole(dmb_sim *sim, const dmb_sim *from)
{
    const dmb_hole *to = &sim->scene->hole, *old = &from->scene->hole;
    const int32_t status = check_cut(sim, from);
    if (status < 0) return status;
    for (uint32_t j = 1; j + 1 < to->cuts; j++) {
        const double depth = dmb_hole_cut_depth(to, j), widening = widening_at(from, depth);
        const double wider = dmb_hole_described_radius(old, depth) - dmb_hole_described_radius(to, depth);
        sim->hole_widening[j] = widening > 0.0 ? fmax(widening + wider, 0.0) : 0.0;
    }
    for (uint32_t j = 1; j < to->cuts; j++) {
        const double slope = 2.0 * fabs(sim->hole_widening[j] - sim->hole_widening[j - 1]) / to->cut_spacing;
        if (slope <= DMB_HOLE_SLOPE_MAX * (1.0 + 1e-9)) continue;
        dmb_message_set(
            &sim->message,
            "state transfer: wall: the radius would change by %g m/m at measured depth %g m, must be <= %g; "
            "give the other model a larger cut_spacing",
            slope, dmb_hole_cut_depth(to, j), DMB_HOLE_SLOPE_MAX);
        return DMB_ERR_GEOMETRY;
    }
    return DMB_OK;
}

/* ---- Whole ------------------------------------------------------------------------------------------------------- */

static void set_up(dmb_sim *sim, dmb_evaluation *evaluation)
{
    memset(evaluation, 0, sizeof *evaluation); /* no forces of inertia, friction or rock: poses are all that is asked */
    evaluation->sim = sim;
    evaluation->time = sim->clock->time;
    evaluation->load_factor = evaluation->mass_factor = evaluation->pseudo_factor = 1.0;
    memset(sim->increment, 0, sim->scene->row_count * sizeof(double));
    dmb_configuration_copy(sim, &sim->now, &sim->trial);
}

/* Closed joints must satisfy the transferred poses; the partition is chosen by the restart. */
static int32_t check_joints(dmb_sim *sim, dmb_evaluation *evaluation)
{
    uint32_t row;
    if (sim->scene->cluster_count == 0) return DMB_OK;
    sim->reduced_mode->row = DMB_NONE;
    const int32_t status = dmb_clusters_assemble(evaluation);
    if (status == DMB_ERR_CALLBACK)
        dmb_message_set(&sim->message, "state transfer: the callback of a constraint failed at time %g",
                        evaluation->time);
    if (status < 0) return status;
    const double violation = dmb_clusters_violation(sim, 0, &row);
    for (uint32_t j = 0; j < sim->scene->joint_count && violation <= DMB_TRANSFER_VIOLATION; j++)
        if (dmb_joint_refuse_flip(sim, j) < 0) return DMB_ERR_GEOMETRY;
    if (violation <= DMB_TRANSFER_VIOLATION) return DMB_OK;
    sim->reduced_mode->row = row;
    sim->reduced_mode->violation = violation;
    dmb_clusters_explain(sim, "its parts are apart where they are carried to, so it must be open");
    return DMB_ERR_GEOMETRY;
}

/* A stuck place must be the same point of the string. */
static int32_t transfer_stuck(dmb_sim *sim, const dmb_sim *from)
{
    dmb_message name;
    for (uint32_t i = 0; i < sim->scene->stuck_count; i++) {
        dmb_stuck_hold here, there;
        double apart = 0.0;
        dmb_stuck_transfer(sim, from, i);
        if (!sim->stuck_held[i]) continue;
        dmb_stuck_hold_of(sim, &sim->now, i, 0, &here);
        dmb_stuck_hold_of(from, &from->now, i, 0, &there);
        for (int k = 0; k < DMB_STUCK_COORDINATES; k++) apart = fmax(apart, fabs(here.s[k] - there.s[k]));
        if (apart <= DMB_TRANSFER_VIOLATION) continue;
        dmb_message_set(&sim->message,
                        "state transfer: %s is held %g m or rad from where it got stuck, must be the same point of the "
                        "string as in the sim it continues; its pipe counts from the rig end",
                        dmb_part_text(&name, "stuck", i, sim->scene->stuck[i].name, sizeof sim->scene->stuck[i].name),
                        apart);
        return DMB_ERR_GEOMETRY;
    }
    return DMB_OK;
}

/* [J] summed as dmb_query_energy does. */
static double stored(const dmb_sim *sim)
{
    const double strain = dmb_strain_energy(sim->scene, &sim->now) + dmb_joint_energy(sim, &sim->now) +
                          dmb_springs_energy(sim->scene, &sim->now) + dmb_caller_forces_energy(sim->scene, &sim->now) +
                          dmb_stuck_energy(sim, &sim->now);
    return dmb_kinetic_energy(sim->scene, &sim->now) + strain + dmb_gravity_energy(sim->scene, &sim->now) +
           dmb_contact_energy(sim->scene, &sim->now);
}

/* The energy error since the start is preserved: the energy at the start is changed by that of added or removed pipes.
 */
static void transfer_ledger(dmb_sim *sim, const dmb_sim *from)
{
    if (!sim->options.energy_ledger || !from->options.energy_ledger) return; /* the ledger starts now */
    const double gained = stored(from) - from->ledger->start;
    DMB_COPY(ledger, 1);
    DMB_COPY(drive_work, sim->scene->drive_count);
    sim->ledger->start = stored(sim) - gained;
}

/* The order is that of the table above. */
static int32_t go_on(dmb_sim *sim, const dmb_sim *from)
{
    dmb_evaluation evaluation;
    transfer_counters(sim, from);
    transfer_drives(sim, from);
    int32_t status = transfer_hole(sim, from);
    if (status >= 0) status = dmb_state_transfer_nodes(sim, from);
    if (status < 0) return status;
    sim->counters->carried = dmb_is_off_supports(sim) != 0;
    status = transfer_stuck(sim, from);
    if (status < 0) return status;
    dmb_state_transfer_sites(sim, from, DMB_TRANSFER_ALL);
    if (sim->scene->cluster_count) transfer_joints(sim, from);
    set_up(sim, &evaluation);
    if (sim->scene->bit_count) transfer_bits(sim, from, &evaluation);
    status = check_joints(sim, &evaluation);
    if (status >= 0) status = dmb_system_restart(sim);
    if (status < 0) return status;
    status = transfer_bounces(sim, from);
    if (status < 0) return status;
    transfer_ledger(sim, from);
    return status;
}

/* The statistics keep the largest value of all calls; this call's value is reported. */
static int32_t keep_projection(dmb_sim *sim, const dmb_sim *from)
{
    double *most = sim->counters->projection;
    const double here[2] = {most[0], most[1]};
    for (int i = 0; i < 2; i++) most[i] = fmax(here[i], from->counters->projection[i]);
    if (here[0] <= 1e-12 && here[1] <= 1e-12) return DMB_OK;
    dmb_message_set(&sim->message, "state transfer: speeds projected onto the allowed motion, by %g m/s and %g rad/s",
                    here[0], here[1]);
    return DMB_NOTE_PROJECTED;
}

static int32_t transfer_state(dmb_sim *sim, const dmb_sim *from)
{
    int32_t status = dmb_state_transfer_check(sim, from);
    if (status < 0) return status;
    dmb_state_back_up(sim);
    status = go_on(sim, from);
    if (status < 0) {
        dmb_state_restore(sim);
        dmb_own_scene_update(sim);
        return status;
    }
    dmb_forget_factors(sim);
    return keep_projection(sim, from);
}

/* Callbacks of the model of `sim` may not change `from` either. */
static int32_t with_both(dmb_sim *sim, dmb_sim *from)
{
    if (sim == from) {
        dmb_message_set(&sim->message, "state transfer: sim and from are one, must be two");
        return DMB_ERR_VALUE;
    }
    int32_t status = dmb_sim_check(from);
    if (status < 0) return status;
    const int32_t busy = from->busy; /* busy if this is called from one of its callbacks */
    from->busy = DMB_BUSY_READABLE;
    status = transfer_state(sim, from);
    from->busy = busy;
    return status;
}

int32_t dmb_sim_transfer_state(dmb_sim *sim, const dmb_sim *from)
{
    const int32_t status = dmb_sim_enter(sim, DMB_BUSY_CHANGING);
    return status < 0 ? status : dmb_sim_leave(sim, with_both(sim, (dmb_sim *)from));
}
