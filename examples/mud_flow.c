/* Mud is pumped down a string and back: the pressure that the pump has to give, and what the flow takes off the hook
 * load, over the rate of flow, an input of one simulation. */
#include <drillmbd/drillmbd.h>
#include <stdio.h>
#include <string.h>

#include "command_line.h"

static int32_t describe(dmb_model *model, dmb_id *pump)
{
    dmb_environment_def mud = dmb_environment_def_default();
    dmb_wall_def hole = dmb_wall_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def rod = dmb_pipe_def_default();
    dmb_input_def rate = dmb_input_def_default();
    mud.fluid_density = 1100.0;
    mud.consistency = 0.3; /* a polymer mud: it thins where it is sheared */
    mud.flow_exponent = 0.55;
    mud.nozzle_area = 1.5e-4;
    hole.direction[0] = 0.0;
    hole.direction[2] = -1.0;
    hole.diameter = 0.096;
    string.start_free = DMB_FREE_NONE;
    rod.length = 6.0;
    rod.joint_length = 0.3;
    rod.joint_outer_diameter = 0.076;
    rod.joint_inner_diameter = 0.050;
    rate.target = DMB_TARGET_FLOW_RATE;
    rate.high = 0.02;
    (void)strcpy(rate.name, "pump");
    int32_t status = dmb_model_set_environment(model, &mud);
    if (status >= 0) status = dmb_model_add_wall(model, &hole, NULL);
    if (status >= 0) status = dmb_model_add_string(model, &string, NULL);
    if (status >= 0) status = dmb_model_add_pipes(model, &rod, 50, NULL);
    if (status >= 0) status = dmb_model_add_input(model, &rate, pump);
    return status < 0 ? status : dmb_model_compile(model, NULL);
}

static int32_t pump_at(dmb_sim *sim, dmb_id pump, double litres_per_minute)
{
    dmb_flow_state flow = dmb_flow_state_default();
    const dmb_output load = {.quantity = DMB_OUTPUT_HOOK_LOAD};
    double hook = 0.0;
    int32_t status = dmb_sim_set_input(sim, pump, litres_per_minute / 60e3);
    if (status >= 0) status = dmb_analysis_static(sim, NULL, NULL);
    if (status >= 0) status = dmb_query_output(sim, &load, &hook);
    if (status >= 0) status = dmb_query_flow(sim, &flow);
    if (status < 0) return status;
    printf("%4.0f l/min: pump %6.2f bar (bore %5.2f, bit %5.2f, annulus %5.2f), hook load %.1f N (drag %.1f N, "
           "thrust %.1f N)\n",
           litres_per_minute, 1e-5 * flow.pump_pressure, 1e-5 * flow.bore_loss, 1e-5 * flow.bit_loss,
           1e-5 * flow.annulus_loss, hook, flow.drag, flow.thrust);
    return status;
}

int main(int count, char **words)
{
    if (count > 1)
        return command_line(count, words,
                            "Mud is pumped down a string and back: pressure of the pump and hook load over the rate "
                            "of flow.",
                            NULL, 0);
    dmb_model *model = NULL;
    dmb_sim *sim = NULL;
    dmb_id pump = {0, 0};
    int32_t status = dmb_model_create(NULL, &model);
    if (status >= 0) status = describe(model, &pump);
    if (status >= 0) status = dmb_sim_create(model, NULL, &sim);
    for (int i = 0; i < 4 && status >= 0; i++) status = pump_at(sim, pump, 200.0 * i);
    if (status < 0) fprintf(stderr, "%s\n%s\n", dmb_model_message(model), dmb_sim_message(sim));
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
    return status < 0;
}
