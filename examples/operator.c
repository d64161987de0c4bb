/* The driller's hands on a running scene: rotation and feed follow new set points within the rig's limits; what was
 * done is played back to the same state. */
#include <drillmbd/drillmbd.h>
#include <stdio.h>

#include "command_line.h"

static dmb_id set_point(dmb_model *model, const char *name, int32_t component, double acceleration, double jerk)
{
    const dmb_segment rest = dmb_segment_default();
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_input_def input = dmb_input_def_default();
    dmb_id id = {0, 0};
    drive.component = component;
    (void)dmb_model_add_time_function(model, &rest, 1, &drive.time_function);
    (void)dmb_model_add_drive(model, &drive, &input.part);
    (void)snprintf(input.name, sizeof input.name, "%s", name);
    input.rate_limit = acceleration;
    input.slope_limit = jerk;
    (void)dmb_model_add_input(model, &input, &id);
    return id;
}

/* Parts that are refused make the compile step fail with their message. */
static int32_t describe(dmb_model *model)
{
    const dmb_pipe_def pipe = dmb_pipe_def_default();
    (void)dmb_model_add_pipes(model, &pipe, 20, NULL);
    (void)set_point(model, "rotation", DMB_RX, 10.0, 50.0);
    (void)set_point(model, "feed", DMB_X, 0.05, 0.5);
    return dmb_model_compile(model, NULL);
}

static int32_t operate(dmb_model *model, dmb_sim *sim, int step)
{
    dmb_id input;
    const double value = step == 1000 ? 0.02 : step == 2000 ? 6.0 : 12.0;
    if (step % 1000 != 0) return DMB_OK;
    const int32_t status = dmb_model_find(model, DMB_PART_INPUT, step == 1000 ? "feed" : "rotation", &input);
    return status < 0 ? status : dmb_sim_set_input(sim, input, value);
}

static void show(const dmb_model *model, const dmb_sim *sim)
{
    for (uint32_t i = 0; i < dmb_model_input_count(model); i++) {
        dmb_input_info info = dmb_input_info_default();
        dmb_input_state state = dmb_input_state_default();
        (void)dmb_model_get_input(model, i, &info);
        (void)dmb_sim_get_input(sim, info.input, &state);
        (void)printf("%-8s %8.3f %s, there at %.4f s\n", info.name, state.present, info.unit, state.arrives);
    }
}

int main(int count, char **words)
{
    if (count > 1)
        return command_line(count, words,
                            "The driller's hands on a running scene: rotation and feed follow new set points within "
                            "the rig's limits; what was done is played back to the same state.",
                            NULL, 0);
    dmb_model *model = NULL;
    dmb_sim *sim = NULL, *again = NULL;
    dmb_input_record log[16];
    uint64_t hash[2] = {0, 1};
    uint32_t next = 0;
    int32_t status = dmb_model_create(NULL, &model);
    if (status >= 0) status = describe(model);
    if (status >= 0) status = dmb_sim_create(model, NULL, &sim);
    if (status >= 0) status = dmb_sim_create(model, NULL, &again);
    if (status >= 0) status = dmb_sim_record_inputs(sim, log, 16);
    for (int i = 0; i < 3000 && status >= 0; i++) {
        status = operate(model, sim, i);
        if (status >= 0) status = dmb_sim_step(sim, 1e-3, NULL);
        if (status >= 0) status = dmb_sim_replay_inputs(again, log, dmb_sim_recorded_inputs(sim), &next);
        if (status >= 0) status = dmb_sim_step(again, 1e-3, NULL);
    }
    if (status < 0) (void)fprintf(stderr, "%s %s\n", dmb_model_message(model), dmb_sim_message(sim));
    show(model, sim);
    (void)dmb_sim_hash(sim, &hash[0]);
    (void)dmb_sim_hash(again, &hash[1]);
    (void)printf("played back: %s\n", hash[0] == hash[1] ? "the same state" : "another state");
    dmb_sim_destroy(&again);
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
    return status < 0;
}
