/* Checks of the whole scene that a single description could not make. */
#include "model/field_check.h"
#include "model/mesh.h"
#include "model/model.h"
#include "model/section.h"

/* ---- Parts and their strings ------------------------------------------------------------------------------------- */

static int32_t check_something_there(const dmb_model *model, dmb_message *message)
{
    if (model->strings.count > 0 || model->bodies.count > 0) return DMB_OK;
    dmb_message_set(message, "model: strings + bodies = 0, must be > 0; add a string with pipes, or a body");
    return DMB_ERR_VALUE;
}

/* The empty id is the first string, which must exist. */
static int32_t check_string_there(const dmb_model *model, dmb_message *message, const char *part, uint32_t index,
                                  const char *name, dmb_id id)
{
    dmb_message text;
    if (!dmb_id_is_none(id) || model->strings.count > 0) return DMB_OK;
    dmb_message_set(message, "%s: belongs to the model's first string, and there is none; name a part, or add pipes",
                    dmb_part_text(&text, part, index, name, 24));
    return DMB_ERR_ID;
}

static int32_t check_belonging(const dmb_model *model, dmb_message *message)
{
    int32_t status = DMB_OK;
    for (uint32_t i = 0; i < model->bodies.count && status >= 0; ++i) {
        const dmb_body_def *body = DMB_LIST_AT(const dmb_body_def, model->bodies, i);
        if (body->attach == DMB_ATTACH_NONE) continue;
        status = check_string_there(model, message, "body", i, body->name, body->string);
    }
    for (uint32_t i = 0; i < model->bits.count && status >= 0; ++i) {
        const dmb_bit_def *bit = DMB_LIST_AT(const dmb_bit_def, model->bits, i);
        if (dmb_id_is_none(bit->stabiliser))
            status = check_string_there(model, message, "bit", i, bit->name, bit->string);
    }
    for (uint32_t i = 0; i < model->drives.count && status >= 0; ++i) {
        const dmb_drive_def *drive = DMB_LIST_AT(const dmb_drive_def, model->drives, i);
        status = check_string_there(model, message, "drive", i, drive->name, drive->part);
    }
    return status;
}

static int32_t check_one_bit_a_string(const dmb_mesh *mesh, dmb_message *message)
{
    const dmb_model *model = mesh->model;
    dmb_message text, other;
    dmb_vector taken = dmb_vector_of(sizeof(uint32_t)); /* bit of each string, from 1 */
    int32_t status = dmb_vector_append(&taken, &model->allocator, NULL, model->strings.count);
    for (uint32_t i = 0; i < model->bits.count && status >= 0; ++i) {
        const dmb_bit_def *bit = DMB_LIST_AT(const dmb_bit_def, model->bits, i);
        if (!dmb_id_is_none(bit->stabiliser)) continue;
        const uint32_t string = dmb_mesh_string_of(mesh, bit->string);
        uint32_t *holder = DMB_VECTOR_AT(uint32_t, &taken, string);
        if (*holder != 0) {
            dmb_message_set(message, "%s: string = %u, must be one without a bit (it has %s)",
                            dmb_model_part_text(model, DMB_PART_BIT, i, &text), string,
                            dmb_model_part_text(model, DMB_PART_BIT, *holder - 1, &other));
            status = DMB_ERR_GEOMETRY;
        }
        *holder = i + 1;
    }
    dmb_vector_release(&taken, &model->allocator);
    return status;
}

/* ---- Strings ----------------------------------------------------------------------------------------------------- */

/* [rad/m] largest component of the unstressed curvature, without the twist and with it. */
static double bend_of(const dmb_pipe_def *def)
{
    return fmax(fabs(def->curvature[1]), fabs(def->curvature[2]));
}
static double curvature_of(const dmb_pipe_def *def)
{
    return fmax(fabs(def->curvature[0]), bend_of(def));
}

/* Axial-torsional pipes require an axis: that of the hole, or a straight line of their own. */
static void check_axis(dmb_check *check, const dmb_mesh *mesh, const dmb_pipe_run *run)
{
    const dmb_string_def *string = dmb_mesh_string_def(mesh, run->string);
    const double shift = fmax(fabs(string->offset[0]), fabs(string->offset[1]));
    if (bend_of(&run->def) > 0.0) {
        dmb_check_fail(check, DMB_ERR_UNSUPPORTED, "curvature", bend_of(&run->def),
                       "0 about y and z for axial-torsional pipes");
    }
    if (!mesh->has_hole || dmb_hole_is_straight(&mesh->hole)) return;
    if (!dmb_mesh_follows_hole(mesh, run->string)) {
        dmb_check_fail(check, DMB_ERR_GEOMETRY, "follows_hole", string->follows_hole,
                       "1 for axial-torsional pipes beside a curved hole");
    }
    if (shift > 0.0) {
        dmb_check_fail(check, DMB_ERR_GEOMETRY, "offset", shift, "0 for axial-torsional pipes in a curved hole");
    }
}

static int32_t check_run(const dmb_mesh *mesh, dmb_message *message, const dmb_pipe_run *run)
{
    dmb_message part;
    dmb_check check = dmb_check_of(message, dmb_pipes_text(&part, run->string, &run->def), DMB_NONE);
    const int32_t kind = dmb_mesh_kind(mesh, run);
    if (kind == DMB_PIPE_AXIAL_TORSIONAL) check_axis(&check, mesh, run);
    if (kind == DMB_PIPE_RIGID && curvature_of(&run->def) > 0.0) {
        dmb_check_fail(&check, DMB_ERR_UNSUPPORTED, "curvature", curvature_of(&run->def), "0 for rigid pipes");
    }
    if (kind == DMB_PIPE_RIGID) dmb_check_rigid_pipe_inertia(&check, &run->def);
    return check.status;
}

static int32_t check_strings(const dmb_mesh *mesh, dmb_message *message)
{
    const uint32_t *start = mesh->run_start.items;
    int32_t status = DMB_OK;
    dmb_message part;
    for (uint32_t s = 0; s < mesh->model->strings.count; ++s) {
        if (start[s + 1] > start[s]) continue;
        dmb_check check = dmb_check_of(message, dmb_model_part_text(mesh->model, DMB_PART_STRING, s, &part), DMB_NONE);
        dmb_check_fail(&check, DMB_ERR_VALUE, "pipes", 0.0, "> 0");
        return check.status;
    }
    for (uint32_t i = 0; i < mesh->model->runs.count && status >= 0; ++i) {
        status = check_run(mesh, message, dmb_mesh_run_at(mesh, i));
    }
    return status;
}

/* ---- Loads ------------------------------------------------------------------------------------------------------- */

static uint32_t pipes_of_string(const dmb_mesh *mesh, uint32_t string)
{
    const uint32_t *start = mesh->run_start.items, *order = mesh->run_order.items;
    const dmb_pipe_run *last = dmb_mesh_run_at(mesh, order[start[string + 1] - 1]); /* no string is empty by now */
    return last->first + last->count;
}

static int32_t check_load(const dmb_mesh *mesh, dmb_message *message, uint32_t i)
{
    const dmb_load_def *load = DMB_LIST_AT(const dmb_load_def, mesh->model->loads, i);
    const uint32_t string = dmb_model_part_index(mesh->model, load->place.part, DMB_PART_STRING);
    dmb_message part;
    dmb_check check = dmb_check_of(message, dmb_part_text(&part, "load", i, load->name, sizeof load->name), DMB_NONE);
    if (load->frame == DMB_FRAME_HOLE && !mesh->has_hole) {
        dmb_check_fail(&check, DMB_ERR_GEOMETRY, "frame", load->frame, "0 or 1: there is no hole");
    }
    if (string != DMB_NONE) {
        dmb_check_count(&check, "place.pipe", load->place.pipe, 0, pipes_of_string(mesh, string) - 1);
    }
    return check.status;
}

int32_t dmb_mesh_check(dmb_mesh *mesh)
{
    const dmb_model *model = mesh->model;
    dmb_message *message = &mesh->model->message;
    int32_t status = check_something_there(model, message);
    if (status >= 0) status = check_belonging(model, message);
    if (status >= 0) status = check_one_bit_a_string(mesh, message);
    if (status >= 0) status = check_strings(mesh, message);
    for (uint32_t i = 0; i < model->loads.count && status >= 0; ++i) status = check_load(mesh, message, i);
    return status;
}
