/* Drives: prescribed motions, loads and speed controllers (PI, or a table of gains) on components of nodes and on
 * coordinates of joints.
 *
 *     kind       on a node                                           on a joint
 *     --------   -------------------------------------------------   ----------------------------------------------
 *     MOTION     prescribed row: increment, speed, acceleration      a constraint; position and rate are its targets
 *     LOAD       force on the row                                    force on the coordinate (joint_forces.c)
 *     CONTROL    force of the controller at the speed of the row     the same
 *
 * The force of a motion drive is a reaction: the residual of its row, or minus the multiplier of its constraint. A
 * controller commands clamp(kp e + ki z), e = v* - v, z' = e by the trapezoidal rule, at rest while a limit acts, the
 * torque-speed curve of an actuator included. A table G(e) may replace kp e, with G'(e) as kp. */
#include "system/assemble/drives.h"

#include <math.h>
#include <string.h>

#include "sim/node.h"
#include "system/assemble/actuators.h"
#include "system/constrain/rotor.h"

/* ---- Time functions, controllers and motion ---------------------------------------------------------------------- */

/* Present target: the caller's value, or time function plus excitation. */
static int32_t target_of(const dmb_sim *sim, uint32_t i, double time, double *value, double *rate)
{
    const dmb_scene *scene = sim->scene;
    const dmb_scene_drive *drive = scene->drives + i;
    double extra = 0.0, extra_rate = 0.0;
    *rate = 0.0;
    *value = sim->drive_input[i];
    if (!isnan(*value)) return DMB_OK;
    int32_t status = dmb_time_function_value(scene->time_functions + drive->time_function, time, value, rate);
    if (status >= 0 && drive->excitation != DMB_NONE)
        status = dmb_time_function_value(scene->time_functions + drive->excitation, time, &extra, &extra_rate);
    *value += extra;
    *rate += extra_rate;
    return status;
}

/* [m, rad] Exact integral of the target over the step (eq:drive.step): positions do not drift from the prescribed
 * function, whatever the step. */
static int32_t travel_of(const dmb_sim *sim, const dmb_scene_drive *drive, double t0, double t1, double *travel)
{
    double extra = 0.0;
    int32_t status = dmb_time_function_integral(sim->scene->time_functions + drive->time_function, t0, t1, travel);
    if (status >= 0 && drive->excitation != DMB_NONE)
        status = dmb_time_function_integral(sim->scene->time_functions + drive->excitation, t0, t1, &extra);
    *travel += extra;
    return status;
}

/* Slope of the target at the end of a step that ends at a breakpoint; the time function itself gives the slope after
 * it. */
static int32_t rate_before(const dmb_sim *sim, uint32_t i, double time, double *rate)
{
    const dmb_scene_drive *drive = sim->scene->drives + i;
    double extra = 0.0;
    int32_t status = dmb_time_function_rate_before(sim->scene->time_functions + drive->time_function, time, rate);
    if (status >= 0 && drive->excitation != DMB_NONE)
        status = dmb_time_function_rate_before(sim->scene->time_functions + drive->excitation, time, &extra);
    *rate += extra;
    return status;
}

/* Slope of the target after the present time, beyond the breakpoint reached even if that is an ulp later. */
static int32_t rate_to_come(const dmb_sim *sim, uint32_t i, double *rate)
{
    double value;
    return target_of(sim, i, fmax(sim->clock->time, sim->clock->breakpoint), &value, rate);
}

/* The acceleration at the end of the step is the slope of the target on the step's side of a breakpoint there; without
 * a step (start and jumps) it is the slope from now on. A jump between the two restarts the accelerations
 * (dmb_system_rate_jumps). */
static int32_t prescribe_drive(dmb_evaluation *evaluation, uint32_t i)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_scene_drive *drive = sim->scene->drives + i;
    double rate, travel;
    int32_t status = target_of(sim, i, evaluation->time, &sim->trial.drives[i].target, &rate);
    if (status < 0 || drive->kind != DMB_DRIVE_MOTION) return status;
    if (!(evaluation->step > 0.0))
        status = rate_to_come(sim, i, &rate);
    else if (evaluation->breakpoint > 0.0)
        status = rate_before(sim, i, fmin(evaluation->time, evaluation->breakpoint), &rate);
    if (status >= 0) status = travel_of(sim, drive, sim->clock->time, evaluation->time, &travel);
    if (status < 0) return status;
    if (drive->joint != DMB_NONE) { /* moved by its constraint */
        sim->trial.drives[i].position = sim->now.drives[i].position + travel;
        sim->trial.drives[i].rate = rate;
        return DMB_OK;
    }
    sim->increment[drive->row] = travel;
    sim->trial.velocity[drive->row] = sim->trial.drives[i].target;
    sim->trial.acceleration[drive->row] = rate;
    sim->trial.pseudo_acceleration[drive->row] = rate;
    return DMB_OK;
}

int32_t dmb_system_rate_jumps(dmb_sim *sim, double time, double breakpoint)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0; i < scene->drive_count; i++) {
        double value, rate;
        if (scene->drives[i].kind != DMB_DRIVE_MOTION) continue;
        const int32_t status = target_of(sim, i, fmax(time, breakpoint), &value, &rate);
        if (status < 0) {
            dmb_message name;
            dmb_message_set(
                &sim->message,
                "%s: callback of its time function failed or gave a value beyond +-1e30 at time %g, where it "
                "has its rate from there on",
                dmb_drive_text(scene, i, &name), time);
            return status;
        }
        const int on_joint = scene->drives[i].joint != DMB_NONE;
        const double last = on_joint ? sim->trial.drives[i].rate : sim->trial.acceleration[scene->drives[i].row];
        if (fabs(rate - last) > 1e-6 * (fabs(rate) + fabs(last) + fabs(value)))
            return 1; /* more than differencing noise */
    }
    return 0;
}

static int32_t factor_of(const dmb_scene *scene, uint32_t time_function, double time, double *factor)
{
    *factor = 1.0;
    if (time_function == DMB_NONE) return DMB_OK;
    return dmb_time_function_value(scene->time_functions + time_function, time, factor, NULL);
}

int32_t dmb_system_prescribe(dmb_evaluation *evaluation)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    int32_t status = DMB_OK;
    for (uint32_t i = 0; i < scene->drive_count && status >= 0; i++) status = prescribe_drive(evaluation, i);
    for (uint32_t i = 0; i < scene->load_count && status >= 0; i++)
        status = factor_of(scene, scene->loads[i].time_function, evaluation->time, &sim->trial.load_factor[i]);
    for (uint32_t i = 0; i < scene->bit_count && status >= 0; i++) {
        sim->trial.bit_load[i] = 0.0;
        if (scene->bits[i].load != DMB_NONE)
            status = factor_of(scene, scene->bits[i].load, evaluation->time, &sim->trial.bit_load[i]);
    }
    return status;
}

double dmb_drive_speed(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t drive)
{
    const uint32_t row = scene->drives[drive].row;
    return row == DMB_NONE ? configuration->drives[drive].speed : configuration->velocity[row];
}

/* kp e or G(e), and its derivative by e. */
static double gain_force(const dmb_scene *scene, uint32_t i, double error, double *gain)
{
    const dmb_scene_drive *drive = scene->drives + i;
    if (drive->table != DMB_NONE) return dmb_gain_force(scene->gain_tables + drive->table, error, gain);
    *gain = drive->gain;
    return drive->gain * error;
}

double dmb_drive_gain(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t drive, double *room)
{
    const double error = configuration->drives[drive].target - dmb_drive_speed(scene, configuration, drive);
    double gain;
    (void)gain_force(scene, drive, error, &gain);
    *room = (double)INFINITY;
    if (scene->drives[drive].table == DMB_NONE) return gain;
    const dmb_gain_table *table = scene->gain_tables + scene->drives[drive].table;
    for (uint32_t k = 0; k < table->points && table->error[k] < error; k++) *room = error - table->error[k];
    return gain;
}

/* Force of a controlled drive and its derivative by the speed; stores the integral of the error in the trial. The
 * integral of the error is that of the trapezoidal rule, so that it belongs to the equations of the step. While the
 * force is at a limit of the drive or of its actuator, the integral is held at its accepted value (anti-windup). */
static double control_force(const dmb_evaluation *evaluation, uint32_t i, double speed, double *slope)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_scene_drive *drive = sim->scene->drives + i;
    const double h = evaluation->step;
    const double error = sim->trial.drives[i].target - speed;
    const double before = sim->now.drives[i].target - dmb_drive_speed(sim->scene, &sim->now, i);
    const double integral = sim->now.drives[i].integral + 0.5 * h * (before + error);
    double gain;
    const double force = gain_force(sim->scene, i, error, &gain) + drive->integral_gain * integral;
    *slope = -(gain + 0.5 * h * drive->integral_gain);
    sim->trial.drives[i].integral = integral;
    double within = fmin(fmax(force, drive->limit_low), drive->limit_high);
    if (within != force) *slope = 0.0;
    if (drive->actuator != DMB_NONE)
        within = dmb_actuator_within(sim->scene->actuators + drive->actuator, within, speed, slope);
    if (within != force) sim->trial.drives[i].integral = sim->now.drives[i].integral;
    return within;
}

double dmb_drive_force(dmb_evaluation *evaluation, uint32_t drive, double speed, double *slope)
{
    dmb_sim *sim = evaluation->sim;
    double force = sim->trial.drives[drive].target;
    *slope = 0.0;
    if (sim->scene->drives[drive].kind == DMB_DRIVE_CONTROL) force = control_force(evaluation, drive, speed, slope);
    if (sim->scene->drives[drive].actuator != DMB_NONE)
        force = dmb_actuator_force(evaluation, drive, force, speed, slope);
    sim->trial.drives[drive].force = force;
    return force;
}

static void assemble_drive(dmb_evaluation *evaluation, uint32_t i)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_scene_drive *drive = sim->scene->drives + i;
    double slope;
    const double force =
        dmb_drive_force(evaluation, i, evaluation->dynamic ? sim->trial.velocity[drive->row] : 0.0, &slope);
    sim->residual[drive->row] -= force;
    sim->scale_row[drive->row] += fabs(force);
    evaluation->power[DMB_POWER_DRIVES] += force * sim->trial.velocity[drive->row];
    if (!evaluation->tangent || !evaluation->dynamic || slope == 0.0) return;
    const uint32_t size = sim->scene->layout.size[drive->node];
    const uint32_t c = drive->row - sim->scene->layout.row[drive->node];
    dmb_inertia_of(sim, drive->node)[(size + 1) * c] -= evaluation->velocity_factor * slope;
}

/* Drives of nodes; those of joints are added with the joints. */
void dmb_assemble_drives(dmb_evaluation *evaluation)
{
    const dmb_scene *scene = evaluation->sim->scene;
    for (uint32_t i = 0; i < scene->drive_count; i++)
        if (scene->drives[i].kind != DMB_DRIVE_MOTION && scene->drives[i].joint == DMB_NONE)
            assemble_drive(evaluation, i);
}

/* ---- Results ----------------------------------------------------------------------------------------------------- */

/* The position of a motion drive is prescribed; that of others, and of any drive of an open joint, is the coordinate
 * less its value at time 0 (drive_offset). */
void dmb_drive_on_joint(dmb_sim *sim, uint32_t drive, double value, double speed, int open)
{
    sim->trial.drives[drive].speed = speed;
    if (open) {
        sim->trial.drives[drive].force = 0.0;
        sim->trial.drives[drive].integral = sim->now.drives[drive].integral;
        dmb_actuator_idle(sim, drive);
    }
    if (open || sim->scene->drives[drive].kind != DMB_DRIVE_MOTION)
        sim->trial.drives[drive].position = value - sim->drive_offset[drive];
}

/* [m, rad] Travel of a driven row in the step, or in a move of statics. */
static double travel_in(const dmb_evaluation *evaluation, const dmb_scene_drive *drive)
{
    const dmb_sim *sim = evaluation->sim;
    const uint32_t row = sim->scene->layout.row[drive->node];
    if (sim->scene->layout.size[drive->node] == DMB_NODE_AXIAL_TORSIONAL) return sim->increment[drive->row];
    return dmb_node_travel(evaluation, drive->node, drive->row - row);
}

void dmb_drives_accept(const dmb_evaluation *evaluation)
{
    dmb_sim *sim = evaluation->sim;
    for (uint32_t i = 0; i < sim->scene->drive_count; i++) {
        const dmb_scene_drive *drive = sim->scene->drives + i;
        if (drive->joint == DMB_NONE)
            sim->trial.drives[i].position = sim->now.drives[i].position + travel_in(evaluation, drive);
        else if (drive->kind == DMB_DRIVE_MOTION && sim->joint_state[drive->joint] != DMB_JOINT_OPEN)
            sim->trial.drives[i].speed = sim->trial.drives[i].target;
    }
}

void dmb_drives_read_reactions(dmb_sim *sim, dmb_configuration *to)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0; i < scene->drive_count; i++) {
        const dmb_scene_drive *drive = scene->drives + i;
        if (drive->kind != DMB_DRIVE_MOTION) continue;
        to->drives[i].force = drive->joint == DMB_NONE
                                  ? sim->residual[drive->row]
                                  : -sim->trial.multiplier[scene->constraints[drive->constraint].row];
    }
}

void dmb_drives_copy_targets(dmb_sim *sim)
{
    for (uint32_t i = 0; i < sim->scene->drive_count; i++) sim->now.drives[i].target = sim->trial.drives[i].target;
}

static void copy_joint_rates(dmb_drive_variables *to, const dmb_drive_variables *from)
{
    to->speed = from->speed;
    to->rate = from->rate;
}

void dmb_drives_copy_motion(dmb_sim *sim)
{
    for (uint32_t i = 0; i < sim->scene->drive_count; i++) {
        sim->now.drives[i].position = sim->trial.drives[i].position;
        copy_joint_rates(sim->now.drives + i, sim->trial.drives + i);
    }
}

void dmb_drives_copy_forces(dmb_sim *sim)
{
    dmb_drives_copy_targets(sim);
    for (uint32_t i = 0; i < sim->scene->drive_count; i++) {
        sim->now.drives[i].force = sim->trial.drives[i].force;
        copy_joint_rates(sim->now.drives + i, sim->trial.drives + i);
    }
    dmb_actuators_copy_flow(sim);
}
