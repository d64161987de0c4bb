/* A hole by sections: cased, open, washed out in soft coal, rock. It prints the constants of the hole by depth, the
 * position of the string in it, and the pull that its friction takes against that of one coefficient for all of it. */
#include <drillmbd/drillmbd.h>
#include <stdio.h>
#include <string.h>

#include "command_line.h"

static dmb_hole_section section(const char *name, double depth, double diameter, double mu, double strength)
{
    dmb_hole_section made = dmb_hole_section_default(); /* what is not said is that of the wall */
    made.depth = depth;
    made.transition = 0.5;
    made.diameter = diameter;
    made.mu_static = made.mu_dynamic = mu;
    made.strength = strength;
    (void)strncpy(made.name, name, sizeof made.name - 1);
    return made;
}

static int32_t describe(dmb_model *model)
{
    const dmb_hole_section sections[] = {section("open", 20.0, 0.096, 0.35, 40e6),
                                         section("soft coal, washed out", 40.0, 0.120, 0.45, 8e6),
                                         section("rock", 45.0, 0.094, 0.30, 90e6)};
    dmb_wall_def wall = dmb_wall_def_default(); /* above the first section: the casing */
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def rod = dmb_pipe_def_default();
    string.start_free = DMB_FREE_NONE;
    wall.diameter = 0.100;
    wall.mu_static = wall.mu_dynamic = 0.20;
    wall.direction[2] = -0.05;
    rod.length = 3.0;
    rod.elements = 3;
    int32_t status = dmb_model_add_wall(model, &wall, NULL);
    if (status >= 0) status = dmb_model_add_hole_sections(model, sections, 3);
    if (status >= 0) status = dmb_model_add_string(model, &string, NULL);
    if (status >= 0) status = dmb_model_add_pipes(model, &rod, 20, NULL);
    return status < 0 ? status : dmb_model_compile(model, NULL);
}

static void tell_hole(const dmb_model *model)
{
    dmb_hole_point at = dmb_hole_point_default();
    for (double depth = 10.0; depth < 60.0; depth += 11.0)
        if (dmb_query_hole(model, depth, &at) >= 0)
            printf("%4.0f m: %5.1f mm, friction %.2f, %3.0f MPa %s\n", depth, 1e3 * at.diameter, at.mu_dynamic,
                   1e-6 * at.strength, at.section == DMB_NONE ? "(casing)" : at.section_name);
}

static void tell_string(dmb_sim *sim)
{
    dmb_operation up = dmb_operation_default();
    dmb_torque_drag_options same = dmb_torque_drag_options_default();
    dmb_torque_drag_row by_depth = dmb_torque_drag_row_default(), one = dmb_torque_drag_row_default();
    dmb_contact contact = dmb_contact_default();
    if (dmb_analysis_static(sim, NULL, NULL) < 0) printf("%s\n", dmb_sim_message(sim));
    for (uint32_t number = 38; number < 50 && dmb_query_contact(sim, number, &contact) >= 0; number += 2)
        printf("ring %u: gap %8.3f mm, on the wall %7.2f N\n", number, 1e3 * contact.gap, contact.normal_force);
    (void)dmb_operation_usual(DMB_OPERATION_PICK_UP, &up);
    same.friction = 0.20;
    if (dmb_analysis_torque_drag(sim, NULL, &up, 1, &by_depth) < 0) printf("%s\n", dmb_sim_message(sim));
    if (dmb_analysis_torque_drag(sim, &same, &up, 1, &one) < 0) printf("%s\n", dmb_sim_message(sim));
    printf("pick-up: %.1f N by sections, %.1f N with the casing's friction everywhere\n", by_depth.hook_load,
           one.hook_load);
}

int main(int count, char **words)
{
    if (count > 1)
        return command_line(count, words, "A hole by sections: cased, open, washed out in soft coal, rock.", NULL, 0);
    dmb_model *model = NULL;
    dmb_sim *sim = NULL;
    int32_t status = dmb_model_create(NULL, &model);
    if (status >= 0) status = describe(model);
    if (status >= 0) tell_hole(model);
    if (status >= 0) status = dmb_sim_create(model, NULL, &sim);
    if (status >= 0) tell_string(sim);
    if (status < 0) fprintf(stderr, "%s\n", dmb_model_message(model));
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
    return status < 0;
}
