/* A string hangs in mud, full of the same mud, of a lighter one, or of air: hook load, and its
 * lowest bending frequency with the mud that goes along in the annulus, around a stabiliser and a bit too. */
#include <drillmbd/drillmbd.h>
#include <stdio.h>

#include "command_line.h"

static int32_t describe(dmb_model *model, double inside)
{
    dmb_environment_def mud = dmb_environment_def_default();
    dmb_wall_def hole = dmb_wall_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def rod = dmb_pipe_def_default();
    dmb_stabiliser_def collar = dmb_stabiliser_def_default();
    dmb_bit_def bit = dmb_bit_def_default();
    mud.fluid_density = 1400.0;
    mud.inner_density = inside;
    mud.added_mass = -1.0; /* of the annulus */
    hole.direction[0] = 0.0;
    hole.direction[2] = -1.0;
    hole.diameter = 0.12;
    string.start_free = DMB_FREE_NONE;
    rod.length = 9.0;
    rod.elements = 2;
    collar.pipe = 4; /* its mud is that of the annulus too */
    collar.outer_diameter = 0.11;
    bit.diameter = 0.0;
    bit.added_mass[1] = 1.2; /* kg */
    int32_t status = dmb_model_set_environment(model, &mud);
    if (status >= 0) status = dmb_model_add_wall(model, &hole, NULL);
    if (status >= 0) status = dmb_model_add_string(model, &string, NULL);
    if (status >= 0) status = dmb_model_add_pipes(model, &rod, 5, NULL);
    if (status >= 0) status = dmb_model_add_stabiliser(model, &collar, NULL);
    if (status >= 0) status = dmb_model_add_bit(model, &bit, NULL);
    return status < 0 ? status : dmb_model_compile(model, NULL);
}

static int32_t hang(const char *name, double inside)
{
    dmb_model *model = NULL;
    dmb_sim *sim = NULL;
    dmb_modes *modes = NULL;
    dmb_mode mode = dmb_mode_default();
    const dmb_output load = {.quantity = DMB_OUTPUT_HOOK_LOAD};
    double hook = 0.0;
    int32_t status = dmb_model_create(NULL, &model);
    if (status >= 0) status = describe(model, inside);
    if (status >= 0) status = dmb_sim_create(model, NULL, &sim);
    if (status >= 0) status = dmb_analysis_static(sim, NULL, NULL);
    if (status >= 0) status = dmb_query_output(sim, &load, &hook);
    if (status >= 0) status = dmb_analysis_modes(sim, NULL, &modes);
    if (status >= 0) status = dmb_modes_get(modes, 0, &mode);
    if (status >= 0) printf("%-12s hook load %7.1f N, lowest frequency %.4f Hz\n", name, hook, mode.frequency);
    if (status < 0) fprintf(stderr, "%s\n%s\n", dmb_model_message(model), dmb_sim_message(sim));
    dmb_modes_destroy(&modes);
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
    return status;
}

int main(int count, char **words)
{
    if (count > 1)
        return command_line(count, words,
                            "A string hangs in mud, full of the same mud, of a lighter one, or of air: hook load, and "
                            "its lowest bending frequency with the mud that goes along in the annulus.",
                            NULL, 0);
    return hang("same mud", -1.0) < 0 || hang("lighter mud", 1000.0) < 0 || hang("air", 1.2) < 0;
}
