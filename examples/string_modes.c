/* Where are the natural frequencies of my string? 100 pipes of 1.5 m lie in a horizontal hole, held at the rig head.
 *
 * Lying on the wall the pipes swing from side to side in the hole, all at nearly the frequency of a pendulum as long as
 * the clearance, sqrt(g/c)/(2 pi) = 4.865 Hz, with hardly any strain. Were there no wall, the same string would bend
 * freely, a thousand times slower. Friction is left out: what vibrates while the string turns and moves slides already.
 */
#include <drillmbd/drillmbd.h>
#include <stdio.h>

#include "command_line.h"

#define PIPES 100
#define MODES 10

static int32_t describe(dmb_model **model, dmb_id *string)
{
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_string_def held = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    int32_t status = dmb_model_create(NULL, model);
    held.start_free = DMB_FREE_NONE;
    pipe.length = 1.5;
    pipe.inner_diameter = 0.055;
    if (status >= 0) status = dmb_model_add_wall(*model, &wall, NULL);
    if (status >= 0) status = dmb_model_add_string(*model, &held, string);
    pipe.string = *string;
    if (status >= 0) status = dmb_model_add_pipes(*model, &pipe, PIPES, NULL);
    return status < 0 ? status : dmb_model_compile(*model, NULL);
}

static const char *kind_of(const dmb_mode *mode)
{
    if (mode->share[0] > 0.5) return "axial";
    return mode->share[1] > 0.5 ? "torsional" : "lateral";
}

static int32_t show(dmb_sim *sim, dmb_id string, int32_t contact, const char *title)
{
    dmb_modes_options options = dmb_modes_options_default();
    dmb_modes *modes = NULL;
    options.count = MODES;
    options.contact = contact;
    options.friction = 0;
    int32_t status = dmb_analysis_modes(sim, &options, &modes);
    printf("%s\n", title);
    for (uint32_t i = 0; i < MODES && status >= 0; ++i) {
        dmb_mode mode = dmb_mode_default();
        double kinetic, strain;
        status = dmb_modes_get(modes, i, &mode);
        if (status >= 0) status = dmb_modes_part(modes, i, string, PIPES - 1, &kinetic, &strain);
        if (status >= 0)
            printf("%2u  %12.6f Hz  %-9s  strain energy %5.1f %%, last pipe moves with %6.3f %%\n", i + 1,
                   mode.frequency, kind_of(&mode), 100.0 * mode.strain / mode.kinetic, 100.0 * kinetic / mode.kinetic);
    }
    dmb_modes_destroy(&modes);
    return status;
}

int main(int count, char **words)
{
    if (count > 1) return command_line(count, words, "Where are the natural frequencies of my string?", NULL, 0);
    dmb_model *model = NULL;
    dmb_sim *sim = NULL;
    dmb_id string;
    int32_t status = describe(&model, &string);
    if (status >= 0) status = dmb_sim_create(model, NULL, &sim);
    if (status >= 0) status = dmb_analysis_static(sim, NULL, NULL);
    if (status >= 0) status = show(sim, string, DMB_CONTACT_AS_IS, "lying on the wall");
    if (status >= 0) status = show(sim, string, DMB_CONTACT_OPEN, "as if there were no wall");
    if (status < 0) fprintf(stderr, "%s\n%s\n", dmb_model_message(model), dmb_sim_message(sim));
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
    return status < 0;
}
