/* Torque and drag of a planned hole: the pull, push and torque that the rig needs at each depth, and the friction that
 * a measured hook load tells. A gas-drainage hole starts 10 degrees below the horizontal and is steered up to 5 degrees
 * above it. */
#include <drillmbd/drillmbd.h>
#include <stdio.h>

#include "command_line.h"

#define DEGREE 0.017453292519943295

static const double survey[] = {0.0,   80.0 * DEGREE, 0.0, /* depth [m], inclination, azimuth [rad] */
                                100.0, 84.0 * DEGREE, 3.0 * DEGREE,  200.0, 90.0 * DEGREE, 9.0 * DEGREE,
                                300.0, 95.0 * DEGREE, 12.0 * DEGREE, 400.0, 95.0 * DEGREE, 12.0 * DEGREE};

static int32_t describe(dmb_model *model)
{
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_pipe_def rod = dmb_pipe_def_default();
    wall.survey = survey;
    wall.survey_count = 5;
    wall.diameter = 0.094;
    rod.outer_diameter = 0.0635;
    rod.inner_diameter = 0.0515;
    rod.length = 1.5;
    rod.yield_strength = 655e6;
    int32_t status = dmb_model_add_wall(model, &wall, NULL);
    if (status >= 0) status = dmb_model_add_pipes(model, &rod, 266, NULL);
    return status < 0 ? status : dmb_model_compile(model, NULL);
}

static void table(dmb_sim *sim)
{
    const double depths[4] = {99.0, 199.0, 299.0, 399.0};
    dmb_operation operations[(DMB_OPERATION_BACK_REAM + 1)];
    dmb_torque_drag_row rows[4 * (DMB_OPERATION_BACK_REAM + 1)] = {dmb_torque_drag_row_default()};
    dmb_torque_drag_options options = dmb_torque_drag_options_default();
    options.depths = depths;
    options.depth_count = 4;
    for (int32_t i = 0; i < (DMB_OPERATION_BACK_REAM + 1); i++) {
        operations[i] = dmb_operation_default();
        (void)dmb_operation_usual(i, &operations[i]);
    }
    operations[DMB_OPERATION_DRILL].weight_on_bit = operations[DMB_OPERATION_SLIDE].weight_on_bit = 15000.0;
    operations[DMB_OPERATION_DRILL].torque_on_bit = 600.0;
    if (dmb_analysis_torque_drag(sim, &options, operations, (DMB_OPERATION_BACK_REAM + 1), rows) < 0) return;
    printf("%-10s %9s %14s %13s %17s %15s\n", "operation", "depth [m]", "hook load [kN]", "torque [N m]",
           "helix, share [-]", "yield share [-]");
    for (int32_t i = 0; i < 4 * (DMB_OPERATION_BACK_REAM + 1); i++)
        printf("%-10s %9.0f %14.3f %13.1f %17.4f %15.4f\n", dmb_operation_name(i % (DMB_OPERATION_BACK_REAM + 1)),
               rows[i].depth, 1e-3 * rows[i].hook_load, rows[i].torque, rows[i].helical_share, rows[i].yield_share);
}

static void explain(dmb_sim *sim, double pull)
{
    dmb_operation up = dmb_operation_default();
    double friction = 0.0;
    (void)dmb_operation_usual(DMB_OPERATION_PICK_UP, &up);
    if (dmb_analysis_friction_factor(sim, NULL, &up, DMB_MEASURED_HOOK_LOAD, pull, &friction) < 0)
        printf("no friction explains %g N: %s\n", pull, dmb_sim_message(sim));
    else
        printf("a pull of %.1f kN at 399 m is that of a friction coefficient of %.4f\n", 1e-3 * pull, friction);
}

int main(int count, char **words)
{
    if (count > 1)
        return command_line(count, words,
                            "Torque and drag of a planned hole: the pull, push and torque that the rig needs at each "
                            "depth, and the friction that a measured hook load tells.",
                            NULL, 0);
    dmb_model *model = NULL;
    dmb_sim *sim = NULL;
    int32_t status = dmb_model_create(NULL, &model);
    if (status >= 0) status = describe(model);
    if (status >= 0) status = dmb_sim_create(model, NULL, &sim);
    if (status >= 0) table(sim);
    if (status >= 0) explain(sim, 14000.0);
    if (status < 0) fprintf(stderr, "%s\n", dmb_model_message(model));
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
    return status < 0;
}
