/* What a message says of a row that could not be satisfied. */
#include "system/cluster.h"
#include "system/constraint_rows.h"

/* Drives that a message names. */
enum { DMB_NAMED_DRIVES = 4 };

/* "; drive 0, drive 2 move it": the motion drives that a constraint hangs together with, but for itself. */
static void name_drives(const dmb_scene *scene, uint32_t constraint, dmb_message *text)
{
    const dmb_cluster *cluster = scene->clusters + scene->constraints[constraint].cluster;
    dmb_message before;
    uint32_t count = 0;
    dmb_message_clear(text);
    for (uint32_t i = cluster->constraint; i < cluster->constraint + cluster->constraint_count; i++) {
        if (scene->constraints[i].kind != DMB_OF_DRIVE || i == constraint || count == DMB_NAMED_DRIVES) continue;
        before = *text;
        dmb_message_set(text, "%s%s drive %u", before.text, count++ ? "," : ";", scene->constraints[i].index);
    }
    if (count == 0) return;
    before = *text;
    dmb_message_set(text, "%s %s it", before.text, count > 1 ? "move" : "moves");
}

void dmb_clusters_explain(dmb_sim *sim, const char *what)
{
    dmb_message owner, drives;
    const uint32_t row = sim->linked_mode->row;
    if (row == UINT32_MAX) return;
    const uint32_t constraint = dmb_constraint_of_row(sim->scene, row);
    dmb_constraint_text(sim->scene, constraint, &owner);
    name_drives(sim->scene, constraint, &drives);
    dmb_message_set(&sim->message, "%s: %s at time %g, misfit = %g%s", owner.text, what, sim->clock->time,
                    sim->linked_mode->misfit, drives.text);
}
