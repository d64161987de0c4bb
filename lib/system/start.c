/* State at time 0, and consistent accelerations for given poses and speeds.
 *
 *     dmb_system_start     close joints -> project speeds -> actuators, contacts, bits -> consistent accelerations
 *     dmb_system_restart   consistent accelerations, forces and contact state for the present pose and speeds
 *     dmb_system_jump      accelerations only, after a jump of a force or prescribed rate; contact memory is kept
 *
 * Consistent accelerations: M v' = forces on the constraints (eq:joints.accelerations), a0 = v' (eq:integration.carry).
 */
#include "system/system.h"

#include <math.h>
#include <string.h>

#include "math/so3.h"
#include "sim/layout.h"
#include "sim/node.h"
#include "system/assemble/assemble.h"
#include "system/assemble/bounces.h"
#include "system/assemble/caller_force.h"
#include "system/assemble/drives.h"
#include "system/assemble/energy.h"
#include "system/assemble/ledger.h"
#include "system/constrain/constrain.h"
#include "system/solve/solve.h"

/* Pose and velocity as described, at zero displacement: displacements are counted from the described pose, so that they
 * keep their digits far from the origin. The memory of contacts starts there too. */
static void described_pose(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    memcpy(sim->now.quaternion, scene->reference_quaternion, 4 * scene->node_count * sizeof(double));
    if (scene->velocity_count)
        memcpy(sim->now.velocity, scene->initial_velocity, scene->velocity_count * sizeof(double));
    else
        memset(sim->now.velocity, 0, scene->row_count * sizeof(double));
    dmb_contacts_start(sim);
}

/* Constrained rows move as prescribed by their drive, or not at all; the largest correction is recorded. Supports and
 * drives of nodes are rows of their own, not constraints: they are satisfied by assignment, before the projection onto
 * the joints (settle_speeds), which leaves such columns unchanged. */
static void project_speeds(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0; i < scene->constrained_count; i++) {
        const uint32_t size = scene->layout.size[scene->constrained_node[i]], c = scene->constrained_component[i];
        const uint32_t row = scene->layout.row[scene->constrained_node[i]] + c;
        const double target = sim->trial.velocity[row];
        double *most = sim->counters->projection + (2 * c < size ? 0 : 1);
        *most = fmax(*most, fabs(target - sim->now.velocity[row]));
        sim->now.velocity[row] = target;
    }
}

/* Prescribed speeds at the present time into trial.velocity, 0 in constrained rows without a drive. */
static int32_t constrained_speeds(dmb_sim *sim, dmb_evaluation *evaluation)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0; i < scene->constrained_count; i++) {
        const uint32_t row = scene->layout.row[scene->constrained_node[i]] + scene->constrained_component[i];
        sim->trial.velocity[row] = sim->trial.acceleration[row] = sim->trial.pseudo_acceleration[row] = 0.0;
    }
    return dmb_system_prescribe(evaluation);
}

static void set_up(dmb_sim *sim, dmb_evaluation *evaluation)
{
    memset(evaluation, 0, sizeof *evaluation);
    evaluation->sim = sim;
    evaluation->time = sim->clock->time;
    evaluation->load_factor = 1.0;
    evaluation->mass_factor = 1.0;
    evaluation->pseudo_factor = 1.0;
    evaluation->dynamic = 1;
    evaluation->tangent = 1;
    sim->reduced_mode->row = DMB_NONE;
    memset(sim->increment, 0, sim->scene->row_count * sizeof(double));
}

/* Solves M v' = sum of the other forces (eq:joints.accelerations). The mass matrix is the tangent of the residual by
 * v', and the residual is linear in it: one correction from any admissible v' is the solution. The last evaluation
 * computes forces, powers and multipliers with it. */
static int32_t solve_accelerations(dmb_sim *sim, dmb_evaluation *evaluation)
{
    const int32_t status = dmb_factor_mass(evaluation);
    if (status == DMB_ERR_SINGULAR) {
        const dmb_owner owner = dmb_owner_of_node(sim->scene, evaluation->element);
        dmb_message_set(&sim->message, "%s: mass matrix singular", owner.text.text);
    }
    if (status < 0) return status;
    dmb_solve_correction(sim);
    for (uint32_t i = 0; i < sim->scene->row_count; i++) {
        sim->trial.acceleration[i] += sim->correction[i];
        sim->trial.pseudo_acceleration[i] = sim->trial.acceleration[i];
    }
    evaluation->tangent = 0;
    return dmb_system_evaluate(evaluation);
}

static void explain(dmb_sim *sim, const dmb_evaluation *evaluation, int32_t status)
{
    dmb_message owner_text;
    if (status == DMB_ERR_ROTATION) {
        const dmb_owner owner = dmb_owner_of_element(sim->scene, evaluation->element);
        dmb_message_set(&sim->message, "%s: relative rotation in one element above 2.5 rad", owner.text.text);
    } else if (status == DMB_ERR_CALLBACK && dmb_failed_force(sim, &owner_text)) {
        dmb_message_set(&sim->message, "%s: its callback failed or gave a value beyond +-1e30 at time %g",
                        owner_text.text, evaluation->time);
    } else if (status == DMB_ERR_CALLBACK && sim->reduced_mode->row != DMB_NONE) {
        dmb_message owner;
        dmb_constraint_text(sim->scene, dmb_constraint_of_row(sim->scene, sim->reduced_mode->row), &owner);
        dmb_message_set(&sim->message, "%s: its callback failed or gave a value beyond +-1e30 at time %g", owner.text,
                        evaluation->time);
    } else if (status == DMB_ERR_CALLBACK) {
        dmb_message_set(&sim->message, "time function: the callback failed or gave a value beyond +-1e30 at time %g",
                        evaluation->time);
    } else if (status == DMB_ERR_NOT_FINITE) {
        dmb_message_set(&sim->message, "forces: not finite at time %g", evaluation->time);
    } else if (status == DMB_ERR_SINGULAR) {
        dmb_clusters_explain(sim, "its equations are singular");
    }
}

/* Projects speeds and accelerations of the trial onto the constraints. */
static int32_t settle_speeds(dmb_sim *sim, dmb_evaluation *evaluation)
{
    if (sim->scene->cluster_count == 0) return DMB_OK;
    const int32_t status = dmb_clusters_settle(evaluation, DMB_SETTLE_SPEED | DMB_SETTLE_ACCELERATION, 0);
    return status < 0 ? status : dmb_assembled_speeds(evaluation);
}

/* Chooses a partition for the pose of the trial. */
static int32_t choose_partition(dmb_sim *sim, dmb_evaluation *evaluation)
{
    if (sim->scene->cluster_count == 0) return DMB_OK;
    const int32_t status = dmb_clusters_assemble(evaluation);
    if (status >= 0) dmb_clusters_choose(sim);
    return status;
}

/* Accelerations of the trial consistent with its pose and speeds, forces of motion drives, and powers of the
 * evaluation. Order: speeds and accelerations onto the constraints, which gives an admissible v'
 * (eq:joints.velocity-partition); the solution in the independent coordinates; multipliers from the forces that it
 * leaves. */
static int32_t make_consistent(dmb_sim *sim, dmb_evaluation *evaluation)
{
    int32_t status = settle_speeds(sim, evaluation);
    if (status >= 0) status = solve_accelerations(sim, evaluation);
    if (status < 0) return status;
    if (sim->scene->cluster_count) dmb_joint_reactions(evaluation);
    dmb_system_get_reactions(sim, &sim->trial);
    return DMB_OK;
}

/* Sets the trial to the accepted state without accelerations, and prescribes motions and loads at the present time. All
 * that follows writes trial and work fields, so that a failure leaves the accepted state as it was. */
static int32_t present(dmb_sim *sim, dmb_evaluation *evaluation)
{
    set_up(sim, evaluation);
    dmb_configuration_copy(sim, &sim->now, &sim->trial);
    memset(sim->trial.acceleration, 0, sim->scene->row_count * sizeof(double));
    return constrained_speeds(sim, evaluation);
}

/* Order: gimbal check, since angles are not defined at the singularity, prescribed speeds, a new partition for the
 * pose, accelerations. On success contacts count as lasting, the step control begins again (clock.step = 0: a0 = v',
 * eq:integration.carry), and the ledger starts at zero. */
int32_t dmb_system_restart(dmb_sim *sim)
{
    dmb_evaluation evaluation;
    int32_t status = present(sim, &evaluation);
    if (status >= 0 && sim->scene->joint_count) status = dmb_joints_refuse_gimbal_singularity(sim, 0, evaluation.time);
    if (status >= 0) {
        dmb_drives_copy_targets(sim);
        project_speeds(sim);
        status = choose_partition(sim, &evaluation);
    }
    if (status >= 0) status = make_consistent(sim, &evaluation);
    if (status < 0) {
        explain(sim, &evaluation, status);
        return status;
    }
    if (sim->scene->cluster_count) dmb_note_projection(sim);
    dmb_configuration_copy(sim, &sim->trial, &sim->now);
    dmb_bounces_start(sim);
    sim->clock->step = 0.0;
    sim->clock->next_step = 0.0;
    if (sim->options.energy_ledger) dmb_ledger_start(sim, &evaluation);
    return DMB_OK;
}

/* Changes only accelerations and quantities that depend on them; contacts keep their memory. Uses the partition at the
 * end of the last step. A failure changes nothing. */
int32_t dmb_system_jump(dmb_sim *sim)
{
    dmb_evaluation evaluation;
    int32_t status = present(sim, &evaluation);
    if (status >= 0) status = make_consistent(sim, &evaluation);
    if (status < 0) {
        explain(sim, &evaluation, status);
        return status;
    }
    const dmb_scene *scene = sim->scene;
    memcpy(sim->now.acceleration, sim->trial.acceleration, scene->row_count * sizeof(double));
    memcpy(sim->now.pseudo_acceleration, sim->trial.acceleration, scene->row_count * sizeof(double));
    dmb_contacts_copy_slip(sim);
    dmb_contacts_copy_touch(sim);
    dmb_bounces_jump(sim);
    dmb_drives_copy_forces(sim);
    dmb_clusters_copy_multipliers(sim);
    if (sim->options.energy_ledger) dmb_ledger_jump(sim, &evaluation);
    return DMB_OK;
}

/* Closes the joints; fails if that strains elements beyond rounding, unless the caller permits it. Rigid moves come
 * first in the assembly (system/constrain/cluster_assembly): energy is stored only if the described parts do not fit
 * without strain. */
static int32_t close_joints(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    const double before = dmb_strain_energy(scene, &sim->now), allowed = sim->options.assembly_energy;
    const int32_t status = dmb_assemble(sim);
    if (status < 0) return status;
    const double *moved = sim->counters->assembly, stored = dmb_strain_energy(scene, &sim->now) - before;
    const uint32_t element = dmb_most_strained(scene, &sim->now);
    if (!(stored > allowed) || element == DMB_NONE) return status;
    dmb_message_set(
        &sim->message,
        "%s: closing joints strains it and others by %g J, must be <= %g J (assembly_energy), and moves parts "
        "by %g m and %g rad; describe joined parts at one place, or free to move",
        dmb_owner_of_element(scene, element).text.text, stored, allowed, moved[0], moved[1]);
    return DMB_ERR_GEOMETRY;
}

/* Order:
 *
 *     1. described pose, contacts, rock surfaces     contacts search the hole's axis from their described depths
 *     2. joints are closed                           moves nodes, so that contacts search again
 *     3. stuck places                                their anchors are the closed pose
 *     4. consistent accelerations (restart)
 *     5. tangents of the caller's forces are         needs a complete state
 *        compared with differences
 *
 * DMB_NOTE_PROJECTED reports moved parts and, if none moved, changed speeds; 1e-12 m or m/s is rounding. */
int32_t dmb_system_start(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    described_pose(sim);
    for (uint32_t k = 0; k < scene->bit_count; k++) dmb_bit_start(sim, k);
    int32_t status = scene->cluster_count ? close_joints(sim) : DMB_OK;
    if (status >= 0 && scene->cluster_count) dmb_contacts_follow_assembly(sim);
    for (uint32_t i = 0; i < scene->stuck_count; i++) dmb_stuck_start(sim, i);
    if (status >= 0) status = dmb_system_restart(sim);
    for (uint32_t i = 0; i < scene->force_count && status >= 0; i++) status = dmb_caller_force_check(sim, i);
    if (status < 0) return status;
    const double *most = sim->counters->projection, *moved = sim->counters->assembly;
    if (moved[0] > 1e-12 || moved[1] > 1e-12) {
        dmb_message_set(&sim->message,
                        "joints: closed by moving parts by up to %g m and %g rad, speeds by %g m/s and %g rad/s",
                        moved[0], moved[1], most[0], most[1]);
        return DMB_NOTE_PROJECTED;
    }
    if (most[0] <= 1e-12 && most[1] <= 1e-12) return DMB_OK;
    dmb_message_set(&sim->message, "initial velocities: projected onto the allowed motion, by %g m/s and %g rad/s",
                    most[0], most[1]);
    return DMB_NOTE_PROJECTED;
}
