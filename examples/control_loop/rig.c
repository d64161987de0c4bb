#include "rig.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define DISPLACEMENT 1.25e-3 /* [m3] of oil a revolution of the rotation head */
#define TURN 6.283185307179586

static dmb_id zero(dmb_model *model)
{
    const dmb_segment rest = dmb_segment_default();
    dmb_id time_function = {0, 0};
    (void)dmb_model_add_time_function(model, &rest, 1, &time_function);
    return time_function;
}

/* A speed controller behind valves with a delay and a lag. */
typedef struct controller {
    const char *name;
    int32_t component;
    double gain, integral_gain, limit_low, limit_high, delay, lag;
} controller;

static dmb_drive_def drive_of(rig *r, const controller *c)
{
    dmb_drive_def drive = dmb_drive_def_default();
    (void)strcpy(drive.name, c->name);
    drive.kind = DMB_DRIVE_CONTROL;
    drive.component = c->component;
    drive.time_function = zero(r->model);
    drive.gain = c->gain;
    drive.integral_gain = c->integral_gain;
    drive.limit_low = c->limit_low;
    drive.limit_high = c->limit_high;
    drive.delay = c->delay;
    drive.lag = c->lag;
    return drive;
}

/* Constant torque up to 12 rad/s, less beyond; the oil resists back-spin. */
static void add_head(rig *r)
{
    const controller speed = {"rotation head", DMB_RX, 80.0, 160.0, -3000.0, 3000.0, 0.02, 0.04};
    dmb_drive_def head = drive_of(r, &speed);
    head.inertia = 8.0;
    head.back_drag = 40.0;
    head.curve_count = 3;
    head.curve_speed[1] = 12.0;
    head.curve_force[0] = head.curve_force[1] = 3000.0;
    head.curve_speed[2] = 30.0;
    head.curve_force[2] = 1200.0;
    (void)dmb_model_add_drive(r->model, &head, &r->head);
}

static void add_carriage(rig *r)
{
    const controller speed = {"feed cylinder", DMB_X, 1.5e4, 2e5, -60e3, 30e3, 0.01, 0.02};
    const dmb_drive_def feed = drive_of(r, &speed);
    (void)dmb_model_add_drive(r->model, &feed, &r->carriage);
}

/* A set point that follows within the rate that the valves allow, or a limit. */
static dmb_id add_input(rig *r, const char *name, int32_t target, dmb_id part, const double limits[3])
{
    dmb_input_def input = dmb_input_def_default();
    dmb_id id = {0, 0};
    (void)snprintf(input.name, sizeof input.name, "%s", name);
    input.target = target;
    input.part = part;
    input.low = limits[0];
    input.high = limits[1];
    input.rate_limit = limits[2];
    input.outside = DMB_OUTSIDE_CLAMPED;
    (void)dmb_model_add_input(r->model, &input, &id);
    return id;
}

static void add_string(rig *r, uint32_t pipes)
{
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_bit_def bit = dmb_bit_def_default();
    dmb_stuck_def jam = dmb_stuck_def_default();
    dmb_id stuck = {0, 0};
    wall.stiffness = 1e7;
    string.start_free = DMB_FREE_CYLINDRICAL;
    (void)dmb_model_add_wall(r->model, &wall, NULL);
    (void)dmb_model_add_string(r->model, &string, &pipe.string);
    pipe.length = 1.5;
    pipe.damping_time = 1e-3;
    (void)dmb_model_add_pipes(r->model, &pipe, pipes, NULL);
    bit.rock_law = DMB_ROCK_RATE;
    bit.bottom = 2e-3;
    (void)dmb_model_add_bit(r->model, &bit, NULL);
    jam.place = dmb_station(pipe.string, pipes - 1, 1.0);
    jam.stuck = 0;
    jam.overpull = 30e3;
    (void)dmb_model_add_stuck(r->model, &jam, &stuck);
    r->jam = add_input(r, "jam", DMB_TARGET_STUCK, stuck, (double[]){0.0, 1.0, 0.0});
}

/* Parts that are refused are told by compile. Bounded work: a step takes no more than four iterations. */
int32_t rig_create(rig *r, uint32_t pipes)
{
    dmb_sim_options options = dmb_sim_options_default();
    int32_t status = dmb_model_create(NULL, &r->model);
    if (status < 0) return status;
    add_string(r, pipes);
    add_head(r);
    add_carriage(r);
    r->inputs[0] = add_input(r, "rotation", DMB_TARGET_SET_POINT, r->head, (double[]){-5.0, 25.0, 10.0});
    r->inputs[1] = add_input(r, "torque limit", DMB_TARGET_LIMIT_HIGH, r->head, (double[]){50.0, 3000.0, 0.0});
    r->inputs[2] = add_input(r, "feed", DMB_TARGET_SET_POINT, r->carriage, (double[]){-0.1, 0.05, 0.2});
    status = dmb_model_compile(r->model, NULL);
    options.bounded_work = 1;
    options.max_iterations = 4;
    if (status >= 0) status = dmb_sim_create(r->model, &options, &r->sim);
    return status < 0 ? status : dmb_analysis_static(r->sim, NULL, NULL);
}

void rig_destroy(rig *r)
{
    dmb_sim_destroy(&r->sim);
    dmb_model_destroy(&r->model);
}

int32_t rig_jam(rig *r)
{
    return dmb_sim_set_input(r->sim, r->jam, 1.0);
}

/* A number of mean 0 and variance 1 that belongs to one sensor in one cycle (splitmix64; sum of four uniform ones). */
static double noise(uint32_t cycle, uint32_t sensor)
{
    double sum = 0.0;
    for (uint64_t i = 0; i < 4; i++) {
        uint64_t x = (((uint64_t)cycle << 8) + 4 * sensor + i + 1) * 0x9e3779b97f4a7c15u;
        x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
        x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
        sum += (double)((x ^ (x >> 31)) >> 11) * 0x1p-53 - 0.5;
    }
    return sum * 1.7320508075688772;
}

int32_t rig_measure(rig *r, readings *seen)
{
    const dmb_output hook_load = {{{0, 0}, 0, 0, 0.0}, DMB_OUTPUT_HOOK_LOAD, 0};
    const uint32_t n = r->count++, slot = n % SENSOR_DELAY;
    dmb_drive_state head = dmb_drive_state_default(), carriage = dmb_drive_state_default();
    readings now = {0};
    int32_t status = dmb_query_drive(r->sim, r->head, &head);
    if (status >= 0) status = dmb_query_drive(r->sim, r->carriage, &carriage);
    if (status >= 0) status = dmb_query_output(r->sim, &hook_load, &now.hook);
    if (status < 0) return status;
    now.pressure = fmax(0.0, head.force * TURN / DISPLACEMENT + 2e5 * noise(n, 0));
    now.speed = head.speed + 0.05 * noise(n, 1);
    now.hook += 300.0 * noise(n, 2);
    now.feed = carriage.position + 2e-5 * noise(n, 3);
    now.torque = now.pressure * DISPLACEMENT / TURN;
    *seen = n < SENSOR_DELAY ? now : r->delayed[slot];
    r->delayed[slot] = now;
    return DMB_OK;
}

int32_t rig_command(rig *r, const commands *wanted)
{
    return dmb_sim_set_inputs(r->sim, r->inputs,
                              (const double[]){wanted->speed, wanted->torque_limit, wanted->feed_speed}, 3);
}
