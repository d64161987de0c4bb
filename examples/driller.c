/* The readings of a driller while a string is driven into rock: hook load, torque, weight on bit, rate of penetration,
 * bit speed and stick-slip index in a table of named outputs. */
#include <drillmbd/drillmbd.h>
#include <stdio.h>

#include "command_line.h"

enum { OUTPUTS = 8, ROWS = 7 };

static dmb_id ramp(dmb_model *model, double to)
{
    const dmb_segment term = {.struct_size = sizeof term, .kind = DMB_SEGMENT_STEP, .x1 = 0.5, .h1 = to};
    dmb_id made = {0, 0};
    (void)dmb_model_add_time_function(model, &term, 1, &made);
    return made;
}

/* A part that is refused is told by compile. */
static int32_t describe(dmb_model *model)
{
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def rod = dmb_pipe_def_default();
    dmb_bit_def bit = dmb_bit_def_default();
    dmb_drive_def feed = dmb_drive_def_default(), turn = dmb_drive_def_default();
    string.start_free = DMB_FREE_CYLINDRICAL;
    rod.kind = DMB_PIPE_AXIAL_TORSIONAL;
    rod.damping_time = 1e-3;
    bit.rock_law = DMB_ROCK_RATE;
    bit.bottom = 1e-3;
    feed.time_function = ramp(model, 0.01);
    turn.time_function = ramp(model, 8.0);
    turn.component = DMB_RX;
    (void)dmb_model_add_wall(model, &wall, NULL);
    (void)dmb_model_add_string(model, &string, NULL);
    (void)dmb_model_add_pipes(model, &rod, 100, NULL);
    (void)dmb_model_add_bit(model, &bit, NULL);
    (void)dmb_model_add_drive(model, &feed, NULL);
    (void)dmb_model_add_drive(model, &turn, NULL);
    return dmb_model_compile(model, NULL);
}

static int32_t drill(dmb_sim *sim)
{
    static const char *const names[OUTPUTS] = {"hook_load", "rotation_torque", "weight_on_bit", "rate_of_penetration",
                                               "bit_speed", "stretch",         "wind_up",       "stick_slip_index"};
    double table[ROWS * (1 + OUTPUTS)];
    dmb_output outputs[OUTPUTS] = {{{{0, 0}, 0, 0, 0.0}, 0, 0}}; /* place 0: the first string */
    dmb_recorder recorder = dmb_recorder_default();
    const dmb_window_options last_second = {.struct_size = sizeof last_second, .slots = 100, .length = 1.0};
    dmb_window *window = NULL;
    for (int i = 0; i < OUTPUTS; i++) (void)dmb_output_quantity(names[i], &outputs[i].quantity);
    int32_t status = dmb_window_create(sim, &last_second, &outputs[4], 1, &window);
    recorder.outputs = outputs, recorder.output_count = OUTPUTS, recorder.window = window;
    recorder.table = table, recorder.capacity = ROWS, recorder.interval = 0.5;
    for (int i = 0; i <= 3000 && status >= 0; i++) {
        if (i > 0) status = dmb_sim_step(sim, 1e-3, NULL);
        if (status >= 0) status = dmb_window_take(window, sim);
        if (status >= 0) status = dmb_recorder_take(&recorder, sim);
    }
    for (int i = 0; i < OUTPUTS; i++) {
        const char *unit, *name = dmb_output_name(outputs[i].quantity, &unit);
        printf("%-20s %-6s", name, unit);
        for (uint64_t k = 0; k < recorder.row_count; k++) printf(" %10.4f", table[k * (1 + OUTPUTS) + 1 + (size_t)i]);
        printf("\n");
    }
    dmb_window_destroy(&window);
    return status;
}

int main(int count, char **words)
{
    if (count > 1)
        return command_line(
            count, words,
            "Drives a string into rock and prints a table of the outputs that a driller reads: hook load, torque, "
            "weight on bit, rate of penetration, bit speed and stick-slip index.",
            NULL, 0);
    dmb_model *model = NULL;
    dmb_sim *sim = NULL;
    int32_t status = dmb_model_create(NULL, &model) < 0 ? DMB_ERR_NO_MEMORY : describe(model);
    if (status >= 0) status = dmb_sim_create(model, NULL, &sim);
    if (status >= 0) status = drill(sim);
    if (status < 0) fprintf(stderr, "%s\n", sim != NULL ? dmb_sim_message(sim) : dmb_model_message(model));
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
    return status < 0;
}
