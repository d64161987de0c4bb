/* A hydraulic rotation head: valves with a delay and a lag, a torque-speed curve, a rotor. It winds up a string that is
 * stuck at the bottom until it stalls; then its pressure is let down, and the string spins it back. */
#include <drillmbd/drillmbd.h>
#include <stdio.h>
#include <string.h>

#include "command_line.h"

static dmb_id number(dmb_model *model, double value)
{
    dmb_segment term = dmb_segment_default();
    dmb_id id = {0, 0};
    term.h0 = value;
    (void)dmb_model_add_time_function(model, &term, 1, &id);
    return id;
}

static dmb_drive_def rotation_head(void)
{
    dmb_drive_def head = dmb_drive_def_default();
    (void)strcpy(head.name, "rotation head");
    head.kind = DMB_DRIVE_CONTROL;
    head.component = DMB_RX;
    head.gain = 300.0;
    head.delay = 0.05;
    head.lag = 0.1;
    head.inertia = 12.0;
    head.drag = 5.0;
    head.back_drag = 60.0; /* back through the valves */
    head.curve_count = 3;  /* constant torque, constant power, no more */
    head.curve_speed[1] = 6.0;
    head.curve_force[0] = head.curve_force[1] = 4000.0;
    head.curve_speed[2] = 15.0;
    head.curve_force[2] = 0.0;
    return head;
}

static int32_t describe(dmb_model *model)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_drive_def head = rotation_head();
    dmb_input_def pressure = dmb_input_def_default();
    string.start_free = DMB_FREE_RX;
    string.end_free = DMB_FREE_NONE; /* stuck */
    (void)dmb_model_add_string(model, &string, &pipe.string);
    pipe.length = 9.0;
    (void)dmb_model_add_pipes(model, &pipe, 30, NULL);
    head.time_function = number(model, 8.0);
    head.limit_high = 3500.0;
    (void)dmb_model_add_drive(model, &head, &pressure.part);
    pressure.target = DMB_TARGET_LIMIT_HIGH;
    (void)strcpy(pressure.name, "torque limit");
    (void)dmb_model_add_input(model, &pressure, NULL);
    return dmb_model_compile(model, NULL);
}

int main(int count, char **words)
{
    if (count > 1)
        return command_line(count, words,
                            "A hydraulic rotation head: valves with a delay and a lag, a torque-speed curve, a rotor.",
                            NULL, 0);
    dmb_model *model = NULL;
    dmb_sim *sim = NULL;
    dmb_id head = {0, 0}, limit = {0, 0};
    int32_t status = dmb_model_create(NULL, &model);
    if (status >= 0) status = describe(model);
    if (status < 0) return (void)puts(dmb_model_message(model)), 1;
    (void)dmb_model_find(model, DMB_PART_ANY, "rotation head", &head);
    (void)dmb_model_find(model, DMB_PART_ANY, "torque limit", &limit);
    status = dmb_sim_create(model, NULL, &sim);
    for (int step = 1; step <= 3000 && status >= 0; step++) {
        dmb_drive_state state = dmb_drive_state_default();
        if (step == 1501) status = dmb_sim_set_input(sim, limit, 200.0);
        if (status >= 0) status = dmb_sim_step(sim, 2e-3, NULL);
        if (step % 250 != 0) continue;
        (void)dmb_query_drive(sim, head, &state);
        (void)printf("%4.1f s: %8.1f N m asked for, %8.1f given, %7.2f rad/s, %6.2f rad\n", dmb_sim_time(sim),
                     state.command, state.force, state.speed, state.position);
    }
    if (status < 0) (void)puts(sim != NULL ? dmb_sim_message(sim) : dmb_model_message(model));
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
    return status < 0;
}
