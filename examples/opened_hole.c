/* A reamer opens a pilot hole of 96 mm for a stabiliser of 115 mm that follows it. Each half metre: how far the wide
 * hole has come, and the force of its wall on the stabiliser, the mean of the last second; with new wings and with worn
 * ones. */
#include <drillmbd/drillmbd.h>
#include <stdio.h>

#include "command_line.h"

static int32_t describe(dmb_model *model, double diameter, dmb_id *stabiliser)
{
    dmb_wall_def hole = dmb_wall_def_default();
    dmb_hole_section pilot = dmb_hole_section_default();
    dmb_pipe_def rod = dmb_pipe_def_default();
    dmb_stabiliser_def follows = dmb_stabiliser_def_default(), wings = dmb_stabiliser_def_default();
    dmb_bit_def bit = dmb_bit_def_default(), reamer = dmb_bit_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_segment term = dmb_segment_default();
    hole.diameter = 0.120; /* as it was reamed before the run */
    hole.cut_spacing = pilot.transition = 0.25;
    hole.cut_end = 20.0;
    pilot.depth = 7.625; /* the reamer stands at 7.5 m */
    pilot.diameter = 0.096;
    rod.length = 3.0;
    rod.damping_time = 1e-3;
    follows.pipe = wings.pipe = 2;
    follows.fraction = 0.2;
    follows.outer_diameter = 0.115;
    wings.outer_diameter = diameter - 0.002;
    bit.rock_law = reamer.rock_law = DMB_ROCK_RATE;
    reamer.inner_radius = 0.048;
    reamer.radius = 0.5 * diameter;
    int32_t status = dmb_model_add_wall(model, &hole, NULL);
    if (status >= 0) status = dmb_model_add_hole_sections(model, &pilot, 1);
    if (status >= 0) status = dmb_model_add_pipes(model, &rod, 4, NULL);
    if (status >= 0) status = dmb_model_add_stabiliser(model, &follows, stabiliser);
    if (status >= 0) status = dmb_model_add_stabiliser(model, &wings, &reamer.stabiliser);
    for (int i = 0; i < 2 && status >= 0; i++) {
        status = dmb_model_add_bit(model, i == 0 ? &bit : &reamer, NULL);
        term.kind = DMB_SEGMENT_STEP;
        term.h1 = i == 0 ? 0.1 : 20.0; /* [m/s, rad/s] */
        drive.component = i == 0 ? DMB_X : DMB_RX;
        if (status >= 0) status = dmb_model_add_time_function(model, &term, 1, &drive.time_function);
        if (status >= 0) status = dmb_model_add_drive(model, &drive, NULL);
    }
    return status < 0 ? status : dmb_model_compile(model, NULL);
}

static double force_on(dmb_sim *sim, dmb_id stabiliser)
{
    dmb_contact wall = dmb_contact_default();
    for (uint32_t number = 0; dmb_query_contact(sim, number, &wall) >= 0 && wall.part.index != stabiliser.index;)
        number++;
    return wall.normal_force;
}

static void tell(dmb_sim *sim, double force, double diameter)
{
    dmb_hole_point at = dmb_hole_point_default();
    double end = 7.5; /* [m] */
    while (dmb_query_hole_now(sim, end + 0.25, &at) >= 0 && at.diameter > diameter - 1e-9) end += 0.25;
    printf("%4.0f s: %.0f mm up to %.2f m, on the stabiliser %.2f N\n", dmb_sim_time(sim), 1e3 * diameter, end, force);
}

static int32_t ream(double diameter)
{
    dmb_model *model = NULL;
    dmb_sim *sim = NULL;
    dmb_id stabiliser;
    double force = 0.0; /* [N] mean */
    int32_t status = dmb_model_create(NULL, &model);
    if (status >= 0) status = describe(model, diameter, &stabiliser);
    if (status >= 0) status = dmb_sim_create(model, NULL, &sim);
    for (int i = 1; i <= 10000 && status >= 0; i++) {
        status = dmb_sim_step(sim, 2e-3, NULL);
        if ((i - 1) % 2500 >= 2000) force += force_on(sim, stabiliser) / 500.0;
        if (i % 2500 == 0) tell(sim, force, diameter), force = 0.0;
    }
    if (status < 0) fprintf(stderr, "%s%s\n", dmb_model_message(model), dmb_sim_message(sim));
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
    return status;
}

int main(int count, char **words)
{
    if (count > 1) return command_line(count, words, "A reamer opens a pilot hole for a stabiliser.", NULL, 0);
    return ream(0.120) < 0 || ream(0.117) < 0;
}
