/* A reamer behind a pilot bit: how the weight and the torque of the rig split between the two when the rock at one of
 * them is harder, and the rate of penetration that is left. */
#include <drillmbd/drillmbd.h>
#include <stdio.h>

#include "command_line.h"

/* From 0 to the value over the first second. */
static int32_t add_drive(dmb_model *model, int32_t kind, int32_t component, double value)
{
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_segment term = dmb_segment_default();
    term.kind = DMB_SEGMENT_STEP;
    term.h1 = value;
    drive.kind = kind;
    drive.component = component;
    const int32_t status = dmb_model_add_time_function(model, &term, 1, &drive.time_function);
    return status < 0 ? status : dmb_model_add_drive(model, &drive, NULL);
}

static int32_t describe(dmb_model *model, double rock_at_bit, double rock_at_reamer, dmb_id *bit, dmb_id *reamer)
{
    dmb_wall_def hole = dmb_wall_def_default();
    dmb_pipe_def rod = dmb_pipe_def_default();
    dmb_stabiliser_def body = dmb_stabiliser_def_default();
    dmb_bit_def pilot = dmb_bit_def_default(), wings = dmb_bit_def_default();
    hole.diameter = 0.153;
    hole.normal_law = DMB_NORMAL_NONE;
    rod.kind = DMB_PIPE_AXIAL_TORSIONAL;
    rod.length = 3.0;
    rod.damping_time = 1e-3;
    body.pipe = 9; /* of ten: 1.5 m behind the bit */
    body.outer_diameter = 0.152;
    pilot.rock_law = wings.rock_law = DMB_ROCK_RATE;
    pilot.intrinsic_energy = rock_at_bit;
    wings.intrinsic_energy = rock_at_reamer;
    wings.inner_radius = pilot.radius;
    wings.radius = 0.076;
    int32_t status = dmb_model_add_wall(model, &hole, NULL);
    if (status >= 0) status = dmb_model_add_pipes(model, &rod, 10, NULL);
    if (status >= 0) status = dmb_model_add_stabiliser(model, &body, &wings.stabiliser);
    if (status >= 0) status = dmb_model_add_bit(model, &pilot, bit);
    if (status >= 0) status = dmb_model_add_bit(model, &wings, reamer);
    if (status >= 0) status = add_drive(model, DMB_DRIVE_LOAD, DMB_X, 10e3);
    if (status >= 0) status = add_drive(model, DMB_DRIVE_MOTION, DMB_RX, 10.0);
    return status < 0 ? status : dmb_model_compile(model, NULL);
}

static int32_t drill(const char *where, double rock_at_bit, double rock_at_reamer)
{
    dmb_model *model = NULL;
    dmb_sim *sim = NULL;
    dmb_id bit, reamer;
    dmb_bit_state front = dmb_bit_state_default(), behind = dmb_bit_state_default();
    int32_t status = dmb_model_create(NULL, &model);
    if (status >= 0) status = describe(model, rock_at_bit, rock_at_reamer, &bit, &reamer);
    if (status >= 0) status = dmb_sim_create(model, NULL, &sim);
    for (int i = 0; i < 3000 && status >= 0; i++) status = dmb_sim_step(sim, 1e-3, NULL);
    if (status >= 0) status = dmb_query_bit(sim, bit, &front);
    if (status >= 0) status = dmb_query_bit(sim, reamer, &behind);
    if (status >= 0)
        printf("%-20s bit %5.0f N, %4.0f N m; reamer %5.0f N, %4.0f N m; %.2f mm a revolution\n", where, front.weight,
               front.torque, behind.weight, behind.torque, 1e3 * front.depth_of_cut);
    if (status < 0) fprintf(stderr, "%s\n%s\n", dmb_model_message(model), dmb_sim_message(sim));
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
    return status;
}

int main(int count, char **words)
{
    if (count > 1)
        return command_line(count, words, "How weight and torque split between a bit and a reamer.", NULL, 0);
    return drill("coal", 10e6, 10e6) < 0 || drill("rock at the bit", 40e6, 10e6) < 0 ||
           drill("rock at the reamer", 10e6, 40e6) < 0;
}
