/* A bottom-hole assembly with stabilisers at places of its own: how they carry its weight and steer the bit (building
 * with one near the bit, dropping without), and how they move the lowest natural frequencies. */
#include <drillmbd/drillmbd.h>
#include <stdio.h>

#include "command_line.h"

static int32_t add_stabiliser(dmb_model *model, const char *name, uint32_t pipe, double fraction)
{
    dmb_stabiliser_def ring = dmb_stabiliser_def_default();
    ring.pipe = pipe;
    ring.fraction = fraction;
    ring.outer_diameter = 0.150;
    (void)snprintf(ring.name, sizeof ring.name, "%s", name);
    return dmb_model_add_stabiliser(model, &ring, NULL);
}

/* Four collars of 9 m; stabilisers at a fulcrum behind the bit and twice farther up, or the upper two alone. */
static int32_t describe(dmb_model *model, int fulcrum, dmb_id *bit)
{
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_pipe_def collar = dmb_pipe_def_default();
    dmb_bit_def crown = dmb_bit_def_default();
    dmb_string_def string = dmb_string_def_default();
    string.start_free = DMB_FREE_NONE;
    wall.diameter = 0.152;
    wall.direction[2] = -0.2;
    collar.length = 9.0;
    collar.elements = 4;
    collar.outer_diameter = 0.121;
    collar.inner_diameter = 0.057;
    crown.diameter = 0.1519;
    int32_t status = dmb_model_add_wall(model, &wall, NULL);
    if (status >= 0) status = dmb_model_add_string(model, &string, NULL);
    if (status >= 0) status = dmb_model_add_pipes(model, &collar, 4, NULL);
    if (status >= 0) status = dmb_model_add_bit(model, &crown, bit);
    if (status >= 0) status = add_stabiliser(model, "upper", 1, 0.55);
    if (status >= 0) status = add_stabiliser(model, "middle", 2, 0.90);
    if (status >= 0 && fulcrum) status = add_stabiliser(model, "near bit", 3, 0.88);
    return status;
}

static void tell(dmb_sim *sim, dmb_id bit)
{
    dmb_contact contact = dmb_contact_default();
    dmb_modes *modes = NULL;
    dmb_mode mode = dmb_mode_default();
    for (uint32_t number = 0; dmb_query_contact(sim, number, &contact) >= 0; number++)
        if (contact.closed)
            printf("  %s at contact point %u: %8.2f N %s\n", contact.part.index == bit.index ? "bit" : "string or ring",
                   number, contact.normal_force, contact.normal[2] > 0.0 ? "on the high side" : "on the low side");
    if (dmb_analysis_modes(sim, NULL, &modes) < 0) printf("%s\n", dmb_sim_message(sim));
    for (uint32_t i = 0; i < 3 && dmb_modes_get(modes, i, &mode) >= 0; i++) printf("  %.4f Hz\n", mode.frequency);
    dmb_modes_destroy(&modes);
}

static int32_t ask(int fulcrum)
{
    dmb_model *model = NULL;
    dmb_sim *sim = NULL;
    dmb_id bit;
    int32_t status = dmb_model_create(NULL, &model);
    printf("%s\n", fulcrum ? "a stabiliser near the bit (builds)" : "none near the bit (drops)");
    if (status >= 0) status = describe(model, fulcrum, &bit);
    if (status >= 0) status = dmb_model_compile(model, NULL);
    if (status >= 0) status = dmb_sim_create(model, NULL, &sim);
    if (status >= 0) status = dmb_analysis_static(sim, NULL, NULL);
    if (status >= 0) tell(sim, bit);
    if (status < 0) fprintf(stderr, "%s\n", sim != NULL ? dmb_sim_message(sim) : dmb_model_message(model));
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
    return status;
}

int main(int count, char **words)
{
    if (count > 1) return command_line(count, words, "Collars with and without a stabiliser near the bit.", NULL, 0);
    return ask(1) < 0 || ask(0) < 0;
}
