/* The part or node that each row of the equations belongs to. */
#include "drillmbd/state_space.h"
#include "query/joint_query.h"
#include "sim/access.h"
#include "sim/node.h"

DMB_DEFINE_INIT(dmb_row, 32, {.component = DMB_X})

static int32_t is_driven(const dmb_scene *scene, uint32_t row)
{
    for (uint32_t i = 0; i < scene->drive_count; i++)
        if (scene->drives[i].kind == DMB_DRIVE_MOTION && scene->drives[i].row == row) return 1;
    return 0;
}

int32_t dmb_query_row(const dmb_sim *sim, uint32_t row, dmb_row *answer)
{
    static const int32_t path_component[2] = {DMB_X, DMB_RX};
    const int32_t status = dmb_ask(sim, answer);
    dmb_row found = {0};
    if (status < 0) return status;
    const dmb_scene *scene = sim->scene;
    if (row >= scene->row_count) return DMB_ERR_VALUE;
    found.node = dmb_node_of_row(scene, row);
    const uint32_t c = row - scene->layout.row[found.node];
    const dmb_owner owner = dmb_owner_of_node(scene, found.node);
    const uint32_t kind = owner.kind[0] == 's' ? DMB_PART_STRING : DMB_PART_BODY;
    found.component = scene->layout.size[found.node] == DMB_NODE_PATH ? path_component[c] : (int32_t)c;
    found.pipe = owner.pipe;
    found.state = scene->solved_row[row] ? DMB_ROW_FREE : is_driven(scene, row) ? DMB_ROW_DRIVEN : DMB_ROW_HELD;
    found.part = dmb_model_id(sim->model, kind, owner.index);
    return dmb_row_write(answer, &found);
}

int32_t dmb_query_constraint_rows(const dmb_sim *sim, dmb_id part, uint32_t *first, uint32_t *count)
{
    const int32_t status = dmb_ask(sim, first);
    uint32_t before = 0;
    if (status < 0) return status;
    if (count == NULL) return DMB_ERR_NULL;
    const uint32_t constraint = dmb_constraint_of_part(sim, part);
    if (constraint == DMB_NONE) return DMB_ERR_ID;
    for (uint32_t i = 0; i < sim->scene->constraint_count; i++)
        if (sim->scene->constraints[i].row < sim->scene->constraints[constraint].row)
            before += dmb_constraint_active(sim, i);
    *first = before;
    *count = dmb_constraint_active(sim, constraint);
    return DMB_OK;
}
