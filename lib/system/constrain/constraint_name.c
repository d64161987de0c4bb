/* Names of constraints for messages, and the constraint that a row belongs to. */
#include "system/constrain/constrain.h"

void dmb_constraint_text(const dmb_scene *scene, uint32_t constraint, dmb_message *text)
{
    static const char *const kinds[] = {"joint", "coupling", "drive", "constraint", "spring", "force"};
    const dmb_constraint *c = scene->constraints + constraint;
    const char *name = "";
    if (c->kind == DMB_OF_JOINT) name = scene->joints[c->index].name;
    if (c->kind == DMB_OF_COUPLING) name = scene->couplings[c->index].name;
    if (c->kind == DMB_OF_DRIVE) name = scene->drives[c->index].name;
    if (c->kind == DMB_OF_CALLBACK) name = scene->callbacks[c->index].name;
    if (c->kind == DMB_OF_FORCE) name = scene->forces[c->index].name;
    if (c->kind == DMB_OF_SPRING) name = scene->springs[c->index].name;
    if (name[0] != '\0')
        dmb_message_set(text, "%s %u (%s)", kinds[c->kind], c->index, name);
    else
        dmb_message_set(text, "%s %u", kinds[c->kind], c->index);
}

uint32_t dmb_constraint_of_row(const dmb_scene *scene, uint32_t row)
{
    uint32_t found = 0;
    while (found + 1 < scene->constraint_count && scene->constraints[found + 1].row <= row) found++;
    return found;
}

int32_t dmb_cluster_singular(dmb_sim *sim, uint32_t row, double violation)
{
    sim->reduced_mode->row = row;
    sim->reduced_mode->violation = violation;
    return DMB_ERR_SINGULAR;
}
