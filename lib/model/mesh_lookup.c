/* Look-ups in the description of which the mesh is made: kinds of pipes, strings, the pipes of a string. */
#include "model/mesh.h"

#include "base/memory.h"
#include "model/field_check.h"

bool dmb_same_numbers(const double *a, const double *b, size_t count)
{
    for (size_t i = 0; i < count; ++i) {
        if (a[i] < b[i] || a[i] > b[i]) return false;
    }
    return true;
}

int32_t dmb_mesh_kind(const dmb_mesh *mesh, const dmb_pipe_run *run)
{
    return mesh->options.pipe_kind >= 0 ? mesh->options.pipe_kind : run->def.kind;
}

bool dmb_mesh_follows_hole(const dmb_mesh *mesh, uint32_t string)
{
    return mesh->model->wall_count > 0 && dmb_mesh_string_def(mesh, string)->follows_hole != 0;
}

uint32_t dmb_mesh_string_of(const dmb_mesh *mesh, dmb_id id)
{
    return dmb_id_is_none(id) ? 0 : dmb_model_part_index(mesh->model, id, DMB_PART_STRING);
}

dmb_pipe_iterator dmb_pipe_iterator_of(const dmb_mesh *mesh, uint32_t string)
{
    dmb_pipe_iterator iterator = {.mesh = mesh, .string = string, .number = DMB_NONE};
    iterator.place = *DMB_VECTOR_AT(uint32_t, &mesh->run_start, string);
    iterator.end = *DMB_VECTOR_AT(uint32_t, &mesh->run_start, string + 1u);
    return iterator;
}

bool dmb_pipe_iterator_next(dmb_pipe_iterator *iterator)
{
    if (iterator->run != NULL && iterator->within == iterator->run->count) {
        ++iterator->place;
        iterator->within = 0;
    }
    if (iterator->place == iterator->end) return false;
    iterator->run =
        dmb_mesh_run_at(iterator->mesh, *DMB_VECTOR_AT(uint32_t, &iterator->mesh->run_order, iterator->place));
    ++iterator->within;
    ++iterator->number; /* the first one becomes 0 */
    return true;
}
