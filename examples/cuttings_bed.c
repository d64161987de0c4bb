/* Cuttings lie on the low side of a hole that turns level: the bed raises the string's friction and takes room off the
 * hole. Pick-up, slack-off and torque of the clean hole, of a short bed and of a long one (slack-off < 0: the rig
 * pushes). */
#include <drillmbd/drillmbd.h>
#include <stdio.h>
#include <string.h>

#include "command_line.h"

/* The bed begins where the hole is at 45 degrees, there steepest to slide down, and ends where it is clean again. */
static int32_t add_bed(dmb_model *model, double from, double to, double height)
{
    dmb_hole_section bed = dmb_hole_section_default(), clean = dmb_hole_section_default();
    bed.depth = from;
    bed.transition = clean.transition = 10.0;
    bed.diameter = 0.152 - height; /* what is left between the bed and the high side */
    bed.mu_static = bed.mu_dynamic = 0.50;
    (void)strcpy(bed.name, "cuttings bed");
    clean.depth = to;
    const dmb_hole_section sections[2] = {bed, clean};
    return dmb_model_add_hole_sections(model, sections, 2);
}

static int32_t describe(dmb_model *model, double bed_end)
{
    const double turn = 1.5707963267948966,
                 survey[4][3] = {{0.0, 0.0, 0.0}, {100.0, 0.0, 0.0}, {300.0, turn, 0.0}, {600.0, turn, 0.0}};
    dmb_environment_def mud = dmb_environment_def_default();
    dmb_wall_def hole = dmb_wall_def_default();
    dmb_pipe_def rod = dmb_pipe_def_default();
    mud.fluid_density = 1100.0;
    hole.survey = &survey[0][0];
    hole.survey_count = 4;
    hole.diameter = 0.152;
    hole.mu_static = hole.mu_dynamic = 0.25;
    rod.outer_diameter = 0.089;
    rod.inner_diameter = 0.070;
    rod.length = 6.0;
    int32_t status = dmb_model_set_environment(model, &mud);
    if (status >= 0) status = dmb_model_add_wall(model, &hole, NULL);
    if (status >= 0 && bed_end > 0.0) status = add_bed(model, 200.0, bed_end, 0.03);
    if (status >= 0) status = dmb_model_add_pipes(model, &rod, 100, NULL);
    return status < 0 ? status : dmb_model_compile(model, NULL);
}

static int32_t tell(const char *name, double bed_end)
{
    const int32_t kinds[3] = {DMB_OPERATION_PICK_UP, DMB_OPERATION_SLACK_OFF, DMB_OPERATION_ROTATE};
    dmb_operation operations[3] = {dmb_operation_default(), dmb_operation_default(), dmb_operation_default()};
    dmb_torque_drag_row rows[3] = {dmb_torque_drag_row_default(), dmb_torque_drag_row_default(),
                                   dmb_torque_drag_row_default()};
    dmb_model *model = NULL;
    dmb_sim *sim = NULL;
    int32_t status = dmb_model_create(NULL, &model);
    for (int i = 0; i < 3; i++) (void)dmb_operation_usual(kinds[i], &operations[i]);
    if (status >= 0) status = describe(model, bed_end);
    if (status >= 0) status = dmb_sim_create(model, NULL, &sim);
    if (status >= 0) status = dmb_analysis_torque_drag(sim, NULL, operations, 3, rows);
    if (status >= 0)
        printf("%-20s pick-up %6.0f N, slack-off %6.0f N, turning %5.0f N m\n", name, rows[0].hook_load,
               rows[1].hook_load, rows[2].torque);
    if (status < 0) fprintf(stderr, "%s\n%s\n", dmb_model_message(model), dmb_sim_message(sim));
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
    return status;
}

int main(int count, char **words)
{
    if (count > 1) return command_line(count, words, "A bed of cuttings as friction and diameter by depth.", NULL, 0);
    return tell("clean hole", 0.0) < 0 || tell("bed 200 .. 300 m", 300.0) < 0 || tell("bed 200 .. 580 m", 580.0) < 0;
}
