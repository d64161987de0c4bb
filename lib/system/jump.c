/* Jumps of the state between steps or inside one:
 *     contacts that open          their force leaves the history of the step (eq:contact.release)
 *     stuck places that release   their spring energy becomes loss, accelerations restart
 *     joints that switch          speeds jump by the impulse of least kinetic energy (eq:joints.impulse) */
#include "system/system.h"

#include <string.h>

#include "element/beam.h"
#include "math/so3.h"
#include "math/vec3.h"
#include "sim/layout.h"
#include "system/assemble/assemble.h"
#include "system/assemble/bounces.h"
#include "system/assemble/caller_force.h"
#include "system/assemble/drives.h"
#include "system/assemble/energy.h"
#include "system/assemble/ledger.h"
#include "system/constrain/constrain.h"
#include "system/constrain/rotor.h"
#include "system/solve/solve.h"

/* ---- Contacts that open ------------------------------------------------------------------------------------------ */

/* [N/m] Force of a contact whose law jumps at touch; < 0 if it would pull. */
static double force_of(const dmb_configuration *configuration, uint32_t s)
{
    return configuration->site_touch[DMB_TOUCH_SIZE * (size_t)s + DMB_TOUCH_FORCE];
}

/* 1: the contact opens. With damping, its force reaches 0 before the penetration does. */
static int opens(const dmb_sim *sim, uint32_t s)
{
    if (dmb_site_has_mean(sim, s) || sim->site_coarse[s]) return 0;
    if (!(sim->scene->sites[s].clearance > 0.0) || !(sim->now.site_penetration[s] > 0.0)) return 0;
    if (dmb_scene_has_touch(sim->scene)) return force_of(&sim->now, s) > 0.0 && !(force_of(&sim->trial, s) > 0.0);
    return !(sim->trial.site_penetration[s] > 0.0);
}

/* A contact point also changes if its normal turns by more than 26 degrees (cosine 0.9) within the step. */
int32_t dmb_contact_changes(const dmb_sim *sim)
{
    for (uint32_t s = 0; s < sim->scene->site_count; s++) {
        const int closed = sim->trial.site_penetration[s] > 0.0;
        if ((sim->now.site_penetration[s] > 0.0) != closed) return 1;
        if (closed && dmb_vec3_dot(sim->now.site_normal + 3 * s, sim->trial.site_normal + 3 * s) < 0.9) return 1;
    }
    return dmb_bounces_change(sim);
}

int32_t dmb_contact_opens(const dmb_sim *sim)
{
    for (uint32_t s = 0; s < sim->scene->site_count; s++)
        if (opens(sim, s)) return 1;
    return 0;
}

/* [-] Fraction of the step after the opening, if the penetration (or the force) is interpolated linearly between now
 * and trial. */
static double open_part(const dmb_sim *sim, uint32_t s)
{
    const int touch = dmb_scene_has_touch(sim->scene);
    const double d0 = touch ? force_of(&sim->now, s) : sim->now.site_penetration[s];
    const double d1 = touch ? force_of(&sim->trial, s) : sim->trial.site_penetration[s];
    return d1 / (d1 - d0);
}

/* Removes the force of a contact point at the start of the step from the history: the fraction after the opening if the
 * step resolves the contact, whose law acted until then, otherwise all of it. Returns that fraction. */
static double release(dmb_sim *sim, uint32_t s, double *rows)
{
    const int whole = (sim->site_mode[s] & DMB_SITE_MODE) == DMB_BOUNCE_OPENS;
    const double part = whole ? 1.0 : open_part(sim, s);
    dmb_site_force f;
    dmb_site_force_of(sim->scene, &sim->now, s, &f);
    dmb_site_weighted_force(sim, &sim->now, s, &f);
    sim->site_history[s] = fmax(-f.rate, 0.0);
    *sim->released_power += part * (f.friction[0] * f.slip[0] + f.friction[1] * f.slip[1]);
    dmb_site_add_force(sim->scene, &sim->now, s, -part, &f, rows);
    return part;
}

/* Forces removed from the history (opening contacts), and mean forces added to it. mass: evaluation of the mass matrix,
 * which may have no velocity factor; the step's own one weights mean forces. */
static void gather_released(const dmb_evaluation *evaluation, dmb_evaluation *mass, double *rows, double *part)
{
    dmb_sim *sim = evaluation->sim;
    memset(rows, 0, sim->scene->row_count * sizeof(double));
    memset(part, 0, sim->scene->node_count * sizeof(double));
    *sim->released_power = 0.0;
    for (uint32_t s = 0; s < sim->scene->site_count; s++) {
        double *of_node = part + sim->scene->sites[s].node;
        if ((sim->site_mode[s] & DMB_SITE_MODE) != DMB_BOUNCE_OPENS && !opens(sim, s)) continue;
        const double released = release(sim, s, rows);
        *of_node = fmax(*of_node, released);
        if (dmb_is_inside(sim->scene, s)) of_node[1] = fmax(of_node[1], released);
    }
    dmb_bounces_release(mass, rows, part);
    dmb_rotors_carry_wrenches(sim, rows);
    dmb_bounces_add_carried(evaluation, rows);
}

/* a = M^-1 sum of part times force over the opening contact points: the acceleration that the history of
 * generalized-alpha would carry as if the contact still pressed (eq:contact.release). The evaluation of the mass matrix
 * has mass factor 1 and velocity factor 0: its iteration matrix is M. With joints the solution is in the independent
 * coordinates, so that the removed accelerations satisfy B a = 0. */
int32_t dmb_released_acceleration(const dmb_evaluation *evaluation, double *acceleration, double *part)
{
    dmb_sim *sim = evaluation->sim;
    dmb_evaluation mass = *evaluation;
    mass.mass_factor = 1.0;
    mass.velocity_factor = 0.0;
    mass.tangent = 1;
    mass.given = 0;
    const int32_t status = dmb_factor_mass_in_step(&mass);
    if (status < 0) return status;
    gather_released(evaluation, &mass, acceleration, part);
    dmb_solve_for(sim, acceleration, acceleration);
    return DMB_OK;
}

/* -M a in the independent rows, from a difference of residuals. */
static int32_t minus_mass_times(dmb_evaluation *evaluation, const double *a, double *product)
{
    dmb_sim *sim = evaluation->sim;
    const uint32_t n = sim->scene->row_count;
    evaluation->tangent = 0;
    memset(sim->trial.acceleration, 0, n * sizeof(double));
    int32_t status = dmb_system_evaluate(evaluation);
    memcpy(product, sim->residual, n * sizeof(double));
    memcpy(sim->trial.acceleration, a, n * sizeof(double));
    if (status >= 0) status = dmb_system_evaluate(evaluation);
    for (uint32_t i = 0; i < n; i++) product[i] -= sim->residual[i];
    return status;
}

/* a = near + M0^-1 (f - M near), M0 the mass matrix of `near`: M - M0 and a - near are both of first order, so the
 * error is of second order. */
int32_t dmb_released_beside(dmb_evaluation *evaluation, const double *near, double *acceleration, double *part,
                            double *product)
{
    dmb_sim *sim = evaluation->sim;
    const uint32_t n = sim->scene->row_count;
    memcpy(acceleration, sim->trial.acceleration, n * sizeof(double));
    const int32_t status = minus_mass_times(evaluation, near, product);
    memcpy(sim->trial.acceleration, acceleration, n * sizeof(double));
    if (status < 0) return status;
    gather_released(evaluation, evaluation, acceleration, part);
    for (uint32_t i = 0; i < n; i++) acceleration[i] -= product[i];
    dmb_solve_for(sim, acceleration, acceleration);
    for (uint32_t i = 0; i < n; i++) acceleration[i] += near[i];
    return DMB_OK;
}

/* ---- Stuck places that come free --------------------------------------------------------------------------------- */

void dmb_stuck_lose(dmb_sim *sim, double before)
{
    if (sim->options.energy_ledger) dmb_ledger_add_impact(sim, 0.0, before - dmb_stuck_energy(sim, &sim->now));
}

/* Several places may reach their limit in one step. Their springs are removed together, and the energy stored in them
 * is counted once. */
uint32_t dmb_stuck_let_go(dmb_sim *sim)
{
    const double stored = dmb_stuck_energy(sim, &sim->now);
    uint32_t count = 0;
    for (uint32_t i = 0; i < sim->scene->stuck_count; i++) {
        if (!(dmb_stuck_ratio(sim, &sim->now, i, 1) >= DMB_STUCK_REACHED)) continue;
        dmb_stuck_set(sim, i, 0);
        if (sim->scene->stuck[i].input != DMB_NONE) sim->input_value[sim->scene->stuck[i].input] = 0.0;
        count++;
    }
    if (count > 0) dmb_stuck_lose(sim, stored);
    return count;
}

/* ---- Joints that lock, open and close ---------------------------------------------------------------------------- */

/* [m, -] largest violation at which a joint may still close */
#define DMB_CLOSING_VIOLATION 1e-6

static void set_up(dmb_sim *sim, dmb_evaluation *evaluation)
{
    memset(evaluation, 0, sizeof *evaluation);
    evaluation->sim = sim;
    evaluation->time = sim->clock->time;
    evaluation->load_factor = evaluation->mass_factor = evaluation->pseudo_factor = 1.0;
    evaluation->dynamic = evaluation->tangent = 1;
    memset(sim->increment, 0, sim->scene->row_count * sizeof(double));
}

/* 1: the constraint becomes active when joint j changes: that of the joint, and those of its coordinates if it was
 * open. */
static int holds_anew(const dmb_scene *scene, const dmb_constraint *c, uint32_t j, int32_t was)
{
    if (c->kind == DMB_OF_JOINT) return c->index == j;
    if (was != DMB_JOINT_OPEN) return 0;
    if (c->kind == DMB_OF_DRIVE) return scene->drives[c->index].joint == j;
    if (c->kind != DMB_OF_COUPLING) return 0;
    const dmb_scene_coupling *coupling = scene->couplings + c->index;
    for (uint32_t k = 0; k < coupling->count; k++)
        if (coupling->joint[k] == j) return 1;
    return 0;
}

static int32_t check_rows(dmb_sim *sim, const dmb_constraint *c)
{
    for (uint32_t r = c->row; r < c->row + c->rows; r++) {
        const double violation = fabs(sim->constraint_value[r]);
        if (violation <= DMB_CLOSING_VIOLATION) continue;
        sim->reduced_mode->row = r;
        sim->reduced_mode->violation = violation;
        dmb_clusters_explain(sim, "its parts are apart, so it cannot close");
        return DMB_ERR_GEOMETRY;
    }
    return DMB_OK;
}

/* Evaluates the rows at now; equations that become active must be nearly satisfied, and frames must not be flipped. A
 * joint whose parts are apart is refused, not pulled together. */
static int32_t check_fit(dmb_evaluation *evaluation, uint32_t j, int32_t was)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    int32_t status = dmb_clusters_assemble(evaluation);
    for (uint32_t i = 0; i < scene->constraint_count && status >= 0; i++)
        if (holds_anew(scene, scene->constraints + i, j, was)) status = check_rows(sim, scene->constraints + i);
    if (status >= 0) status = dmb_joint_refuse_flip(sim, j);
    return status < 0 ? status : dmb_joints_refuse_gimbal_singularity(sim, 0, evaluation->time);
}

/* The velocity of the trial satisfies the constraints by the shortest change; y = (R^T M R)^-1 R^T M (v- - v) turns it
 * into the change of least kinetic energy (eq:joints.impulse). */
static int32_t least_energy(dmb_evaluation *evaluation)
{
    dmb_sim *sim = evaluation->sim;
    const uint32_t n = sim->scene->row_count;
    double *change = sim->switch_change, *momentum = sim->switch_momentum;
    for (uint32_t i = 0; i < n; i++) change[i] = sim->now.velocity[i] - sim->trial.velocity[i];
    int32_t status = dmb_factor_mass(evaluation);
    if (status >= 0) status = minus_mass_times(evaluation, change, momentum);
    if (status < 0) return status;
    dmb_solve_for(sim, momentum, change);
    for (uint32_t i = 0; i < n; i++) sim->trial.velocity[i] += change[i];
    return DMB_OK;
}

/* [m/s, rad/s] */
static void largest_change(const dmb_sim *sim, double most[2])
{
    const dmb_block_layout *layout = &sim->scene->layout;
    most[0] = most[1] = 0.0;
    for (uint32_t i = 0; i < sim->scene->node_count; i++)
        for (uint32_t c = 0; c < layout->size[i]; c++) {
            const uint32_t row = layout->row[i] + c, turns = 2 * c >= layout->size[i];
            most[turns] = fmax(most[turns], fabs(sim->trial.velocity[row] - sim->now.velocity[row]));
        }
}

/* [J] Energy stored in the pose of now. */
static double potential(const dmb_sim *sim)
{
    return dmb_strain_energy(sim->scene, &sim->now) + dmb_gravity_energy(sim->scene, &sim->now) +
           dmb_contact_energy(sim->scene, &sim->now) + dmb_joint_energy(sim, &sim->now) +
           dmb_springs_energy(sim->scene, &sim->now) + dmb_caller_forces_energy(sim->scene, &sim->now) +
           dmb_stuck_energy(sim, &sim->now);
}

/* The energy lost counts as impact: kinetic energy and that of springs which no longer act; the works of inertia and
 * potential forces are reduced with it. `stored`: energy stored before the joint changed. */
static void add_motion_loss(dmb_sim *sim, double stored)
{
    const double before = dmb_kinetic_energy(sim->scene, &sim->now);
    memcpy(sim->now.displacement, sim->trial.displacement, 3 * (size_t)sim->scene->node_count * sizeof(double));
    memcpy(sim->now.quaternion, sim->trial.quaternion, 4 * (size_t)sim->scene->node_count * sizeof(double));
    memcpy(sim->now.turn, sim->trial.turn, sim->scene->node_count * sizeof(double));
    memcpy(sim->now.velocity, sim->trial.velocity, sim->scene->row_count * sizeof(double));
    dmb_drives_copy_motion(sim);
    const double lost = before - dmb_kinetic_energy(sim->scene, &sim->now), let_go = stored - potential(sim);
    dmb_ledger_add_impact(sim, lost, let_go);
}

/* Forces of joints and joint drives for the new accelerations. */
static void copy_forces(dmb_sim *sim)
{
    dmb_clusters_copy_multipliers(sim);
    dmb_drives_copy_motion(sim);
}

/* Order, each on the result of the one before:
 *
 *     1. new state of the joint; equations that become active must be satisfied to DMB_CLOSING_VIOLATION (check_fit)
 *     2. new partition, since the set of rows is another
 *     3. poses by the shortest move (at most that violation), speeds by the shortest change (eq:joints.projection)
 *     4. speeds by the change of least kinetic energy (eq:joints.impulse)
 *     5. the energy lost is booked as impact
 *     6. consistent accelerations, multipliers and drive forces
 *
 * The state is backed up by dmb_joint_switch and restored if any of them fails. */
static int32_t change(dmb_sim *sim, uint32_t j, int32_t state, double jump[2])
{
    const double stored = potential(sim);
    const int32_t was = sim->joint_state[j];
    dmb_evaluation evaluation;
    set_up(sim, &evaluation);
    if (was == DMB_JOINT_OPEN) dmb_joint_place_find(sim, j);
    dmb_joint_set_state(sim, j, state);
    dmb_configuration_copy(sim, &sim->now, &sim->trial);
    int32_t status = dmb_system_prescribe(&evaluation);
    if (status >= 0) status = check_fit(&evaluation, j, was);
    if (status < 0) return status;
    dmb_clusters_choose(sim);
    status = dmb_clusters_settle(&evaluation, DMB_SETTLE_POSE | DMB_SETTLE_SPEED, 0);
    if (status >= 0) status = least_energy(&evaluation);
    if (status < 0) return status;
    largest_change(sim, jump);
    add_motion_loss(sim, stored);
    status = dmb_system_jump(sim);
    if (status >= 0) copy_forces(sim);
    return status;
}

int32_t dmb_joint_switch(dmb_sim *sim, uint32_t joint, int32_t state)
{
    double jump[2] = {0.0, 0.0};
    dmb_message name;
    if (sim->joint_state[joint] == state) return DMB_OK;
    dmb_state_back_up(sim);
    sim->reduced_mode->row = DMB_NONE;
    const int32_t status = change(sim, joint, state, jump);
    if (status < 0) {
        dmb_state_restore(sim);
        if (sim->message.text[0] == '\0') dmb_clusters_explain(sim, "its equations cannot be satisfied");
        return status;
    }
    if (jump[0] <= 1e-12 && jump[1] <= 1e-12) return DMB_OK;
    dmb_constraint_text(sim->scene, sim->scene->joints[joint].constraint, &name);
    dmb_message_set(&sim->message, "%s: speeds jumped by up to %g m/s and %g rad/s", name.text, jump[0], jump[1]);
    return DMB_NOTE_PROJECTED;
}
