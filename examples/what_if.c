/* What would a harder controller have done?
 *
 * A torque drive is the actuator, the controller is the user's, here a PI law with its limits. Before the load on the
 * bit rises the state is saved; later the run goes back to it and tries another gain on the same past. (The controller
 * of a whole rig at 1 kHz is control_loop.) */
#include <drillmbd/drillmbd.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "command_line.h"

#define CYCLE 1e-3          /* [s] of the control unit */
#define WANTED 20.0         /* [rad/s] */
#define TORQUE_LIMIT 1250.0 /* [N m] of the rig */

typedef struct controller {
    double gain;          /* [N m s] */
    double integral_gain; /* [N m] */
    double integral;      /* [N m] */
} controller;

typedef struct rig {
    dmb_model *model;
    dmb_sim *sim;
    dmb_id string, motor;
} rig;

/* The speed asked for rises over 1 s; the integral waits while the motor is at its limit. */
static double torque_of(controller *c, double time, double speed)
{
    const double error = WANTED * fmin(time, 1.0) - speed;
    const double torque = c->gain * error + c->integral;
    if (fabs(torque) < TORQUE_LIMIT) c->integral += c->integral_gain * error * CYCLE;
    return fmax(-TORQUE_LIMIT, fmin(torque, TORQUE_LIMIT));
}

/* Motor and gears turn with the rig end of the string. */
static int32_t add_head(dmb_model *model)
{
    dmb_body_def head = dmb_body_def_default();
    head.attach = DMB_ATTACH_START;
    head.mass = 200.0;
    head.inertia[0] = 4.0;
    head.inertia[1] = head.inertia[2] = 10.0;
    return dmb_model_add_body(model, &head, NULL);
}

/* A torque against the rotation at the bit, as hard rock gives from 2 s on. */
static int32_t add_rock(dmb_model *model, dmb_id string)
{
    dmb_segment rise = dmb_segment_default();
    dmb_load_def load = dmb_load_def_default();
    rise.kind = DMB_SEGMENT_STEP;
    rise.x0 = 2.0;
    rise.x1 = 2.1;
    rise.h1 = 1.0;
    const int32_t status = dmb_model_add_time_function(model, &rise, 1, &load.time_function);
    load.place = dmb_station(string, 49, 1.0);
    load.moment[0] = -200.0;
    return status < 0 ? status : dmb_model_add_load(model, &load, NULL);
}

static int32_t describe(rig *r)
{
    const dmb_segment rest = dmb_segment_default();
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_drive_def feed = dmb_drive_def_default(), motor = dmb_drive_def_default();
    int32_t status = dmb_model_create(NULL, &r->model);
    if (status >= 0) status = dmb_model_add_wall(r->model, &wall, NULL);
    if (status >= 0) status = dmb_model_add_pipes(r->model, &pipe, 50, &r->string);
    if (status >= 0) status = add_head(r->model);
    if (status >= 0) status = dmb_model_add_time_function(r->model, &rest, 1, &feed.time_function);
    if (status >= 0) status = dmb_model_add_drive(r->model, &feed, NULL);
    motor.kind = DMB_DRIVE_LOAD;
    motor.component = DMB_RX;
    motor.time_function = feed.time_function; /* a constant 0, until the controller speaks */
    if (status >= 0) status = dmb_model_add_drive(r->model, &motor, &r->motor);
    if (status >= 0) status = add_rock(r->model, r->string);
    return status < 0 ? status : dmb_model_compile(r->model, NULL);
}

static int32_t start(rig *r)
{
    dmb_sim_options options = dmb_sim_options_default();
    options.bounded_work = 1;
    options.max_iterations = 4;
    const int32_t status = dmb_sim_create(r->model, &options, &r->sim);
    return status < 0 ? status : dmb_analysis_static(r->sim, NULL, NULL);
}

/* The loop of the control unit: measure, decide, act. Tells the slowest speed after 2 s. */
static int32_t control(rig *r, controller *c, double until, double *slowest)
{
    dmb_drive_state motor = dmb_drive_state_default();
    int32_t status = DMB_OK;
    *slowest = WANTED;
    while (status >= 0 && dmb_sim_time(r->sim) < until - 0.5 * CYCLE) {
        const double time = dmb_sim_time(r->sim);
        status = dmb_query_drive(r->sim, r->motor, &motor);
        if (status >= 0) status = dmb_sim_set_drive(r->sim, r->motor, torque_of(c, time, motor.speed));
        if (status >= 0) status = dmb_sim_step(r->sim, CYCLE, NULL);
        if (time > 2.0) *slowest = fmin(*slowest, motor.speed);
    }
    return status;
}

/* From the saved state on with another gain. */
static int32_t try_gain(rig *r, const controller *saved, const void *state, size_t size, double gain)
{
    dmb_drive_state motor = dmb_drive_state_default();
    controller c = *saved;
    double slowest = 0.0;
    int32_t status = dmb_sim_restore(r->sim, state, size);
    c.gain = gain;
    if (status >= 0) status = control(r, &c, 4.0, &slowest);
    if (status >= 0) status = dmb_query_drive(r->sim, r->motor, &motor);
    if (status >= 0)
        printf("gain %5.0f N m s: slowest %8.4f rad/s, at 4 s %8.4f rad/s with %8.3f N m\n", gain, slowest, motor.speed,
               motor.force);
    return status;
}

/* Saves at 1.9 s, before the rock, then tries two controllers on the same past. */
static int32_t experiment(rig *r)
{
    controller c = {50.0, 200.0, 0.0};
    double slowest;
    size_t size = 0;
    uint64_t first = 0, again = 1;
    int32_t status = control(r, &c, 1.9, &slowest);
    if (status >= 0) status = dmb_sim_snapshot_size(r->sim, &size);
    void *state = malloc(size > 0 ? size : 1);
    if (status >= 0) status = state == NULL ? DMB_ERR_NO_MEMORY : dmb_sim_snapshot(r->sim, state, size);
    if (status >= 0) status = try_gain(r, &c, state, size, 50.0);
    if (status >= 0) status = dmb_sim_hash(r->sim, &first);
    if (status >= 0) status = try_gain(r, &c, state, size, 400.0);
    if (status >= 0) status = try_gain(r, &c, state, size, 50.0);
    if (status >= 0) status = dmb_sim_hash(r->sim, &again);
    if (status >= 0) printf("the first and the last try agree to the last bit: %s\n", first == again ? "yes" : "no");
    free(state);
    return status;
}

int main(int count, char **words)
{
    if (count > 1)
        return command_line(count, words,
                            "What would a harder controller have done? A saved state is gone on from with two gains.",
                            NULL, 0);
    rig r = {0};
    dmb_statistics statistics = dmb_statistics_default();
    int32_t status = describe(&r);
    if (status >= 0) status = start(&r);
    if (status >= 0) status = experiment(&r);
    if (status >= 0) status = dmb_query_statistics(r.sim, &statistics);
    if (status >= 0)
        printf("worst step: %u iterations\n", statistics.most_iterations);
    else
        fprintf(stderr, "%s: %s%s\n", dmb_status_text(status), dmb_model_message(r.model), dmb_sim_message(r.sim));
    dmb_sim_destroy(&r.sim);
    dmb_model_destroy(&r.model);
    return status < 0;
}
