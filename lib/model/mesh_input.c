/* Inputs and events, converted from described parts to parts of the scene. */
#include <math.h>
#include <string.h>

#include "model/describe.h"
#include "model/field_check.h"
#include "model/mesh.h"

static uint32_t index_of(const dmb_model *model, dmb_id part)
{
    static const uint32_t kinds[] = {DMB_PART_DRIVE, DMB_PART_LOAD, DMB_PART_BIT, DMB_PART_STUCK};
    for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; ++k) {
        const uint32_t index = dmb_model_part_index(model, part, kinds[k]);
        if (index != DMB_NONE) return index;
    }
    return DMB_NONE;
}

static bool any(const double mass[2])
{
    return mass[0] > 0.0 || mass[1] > 0.0;
}

/* Requirements of an input on other parts, checked here because the order of description is free. */
static int32_t check_density(const dmb_mesh *mesh, const dmb_input_def *def)
{
    const dmb_model *model = mesh->model;
    const char *why = NULL;
    if (model->environment.added_mass > 0.0 || model->environment.added_mass < 0.0) why = "added_mass is 0";
    for (uint32_t i = 0; i < model->bodies.count; ++i)
        if (any(DMB_LIST_AT(const dmb_body_def, model->bodies, i)->added_mass)) why = "the added_mass of bodies is 0";
    for (uint32_t i = 0; i < model->bits.count; ++i)
        if (any(DMB_LIST_AT(const dmb_bit_def, model->bits, i)->added_mass)) why = "the added_mass of bits is 0";
    for (uint32_t i = 0; i < model->rings.count; ++i)
        if (any(DMB_LIST_AT(const dmb_stabiliser_def, model->rings, i)->added_mass))
            why = "the added_mass of rings is 0";
    if (model->environment.flow_rate > 0.0) why = "flow_rate is 0";
    for (uint32_t i = 0; i < model->inputs.count; ++i)
        if (DMB_LIST_AT(const dmb_input_def, model->inputs, i)->target == DMB_TARGET_FLOW_RATE)
            why = "no input has the target DMB_TARGET_FLOW_RATE";
    for (uint32_t i = 0; i < model->bodies.count; ++i) {
        const dmb_body_def *body = DMB_LIST_AT(const dmb_body_def, model->bodies, i);
        if (body->displaced_volume > 0.0 && fabs(body->centre[1]) + fabs(body->centre[2]) > 0.0)
            why = "bodies with a displaced_volume have their centre on the x axis";
    }
    if (why == NULL) return DMB_OK;
    dmb_message_set(&mesh->model->message,
                    "input (%s): target = DMB_TARGET_FLUID_DENSITY, must be in a scene where %s; leave one of both out",
                    def->name, why);
    return DMB_ERR_UNSUPPORTED;
}

static int32_t check_scene(const dmb_mesh *mesh, const dmb_input_def *def)
{
    const dmb_model *model = mesh->model;
    if (def->target == DMB_TARGET_FLUID_DENSITY) return check_density(mesh, def);
    if (def->target != DMB_TARGET_FRICTION) return DMB_OK;
    if (model->wall_count > 0 && model->wall.friction_law != DMB_FRICTION_NONE) return DMB_OK;
    dmb_message_set(&mesh->model->message,
                    "input (%s): target = DMB_TARGET_FRICTION, but the model has no wall with a "
                    "friction_law; add one, or leave the input out",
                    def->name);
    return DMB_ERR_UNSUPPORTED;
}

/* An input by the number of its part in the scene, which has the number of the description for all kinds with
 * inputs. */
static int32_t add_input(dmb_mesh *mesh, uint32_t i)
{
    const dmb_input_def *def = DMB_LIST_AT(const dmb_input_def, mesh->model->inputs, i);
    dmb_scene_input input = {.initial = def->initial,
                             .low = dmb_input_low(def),
                             .high = dmb_input_high(def),
                             .rate_limit = def->rate_limit,
                             .slope_limit = def->slope_limit,
                             .target = def->target,
                             .outside = def->outside,
                             .index = index_of(mesh->model, def->part)};
    const int32_t status = check_scene(mesh, def);
    if (def->target == DMB_TARGET_STUCK) DMB_VECTOR_AT(dmb_scene_stuck, &mesh->stuck, input.index)->input = i;
    memcpy(input.name, def->name, sizeof input.name);
    return status < 0 ? status : dmb_vector_append(&mesh->inputs, &mesh->model->allocator, &input, 1);
}

/* Limit of a drive at time 0, by the input of that target or as described. */
static double first_limit(const dmb_mesh *mesh, uint32_t drive, int32_t target)
{
    const dmb_scene_drive *d = DMB_VECTOR_AT(dmb_scene_drive, &mesh->drives, drive);
    for (uint32_t i = 0; i < mesh->inputs.count; ++i) {
        const dmb_scene_input *input = DMB_VECTOR_AT(dmb_scene_input, &mesh->inputs, i);
        if (input->target == target && input->index == drive && !isnan(input->initial)) return input->initial;
    }
    return target == DMB_TARGET_LIMIT_LOW ? d->limit_low : d->limit_high;
}

static int32_t check_limits(const dmb_mesh *mesh, uint32_t i)
{
    const dmb_scene_input *input = DMB_VECTOR_AT(dmb_scene_input, &mesh->inputs, i);
    if (input->target != DMB_TARGET_LIMIT_LOW && input->target != DMB_TARGET_LIMIT_HIGH) return DMB_OK;
    const double low = first_limit(mesh, input->index, DMB_TARGET_LIMIT_LOW);
    const double high = first_limit(mesh, input->index, DMB_TARGET_LIMIT_HIGH);
    if (low < high) return DMB_OK;
    dmb_message_set(&mesh->model->message,
                    "input (%s): initial: limit_low = %g of its drive at time 0, must be < "
                    "limit_high = %g",
                    input->name, low, high);
    return DMB_ERR_VALUE;
}

static int32_t add_event(dmb_mesh *mesh, uint32_t i)
{
    const dmb_event_def *def = DMB_LIST_AT(const dmb_event_def, mesh->model->events, i);
    dmb_scene_event event = {.output = def->output,
                             .level = def->level,
                             .hold = def->hold,
                             .tolerance = def->tolerance,
                             .direction = def->direction};
    memcpy(event.name, def->name, sizeof event.name);
    return dmb_vector_append(&mesh->events, &mesh->model->allocator, &event, 1);
}

int32_t dmb_mesh_inputs(dmb_mesh *mesh)
{
    const uint32_t count = mesh->model->inputs.count;
    int32_t status = DMB_OK;
    for (uint32_t i = 0; i < count && status >= 0; ++i) status = add_input(mesh, i);
    for (uint32_t i = 0; i < count && status >= 0; ++i) status = check_limits(mesh, i);
    for (uint32_t i = 0; i < mesh->model->events.count && status >= 0; ++i) status = add_event(mesh, i);
    return status;
}

/* ---- Inputs beside segments per revolution ----------------------------------------------------------------------- */

/* Time function that an input replaces; DMB_NONE: none. */
static uint32_t replaced(const dmb_scene *scene, const dmb_scene_input *input)
{
    switch (input->target) {
    case DMB_TARGET_SET_POINT: return scene->drives[input->index].time_function;
    case DMB_TARGET_LOAD_FACTOR: return scene->loads[input->index].time_function;
    case DMB_TARGET_BIT_LOAD: return scene->bits[input->index].load;
    default: return DMB_NONE;
    }
}

/* 1: a segment of time function `by` follows time function `of`. */
static int follows(const dmb_scene *scene, uint32_t by, uint32_t of)
{
    if (by == DMB_NONE) return 0;
    const dmb_time_function *f = scene->time_functions + by;
    for (uint32_t k = 0; k < f->count; ++k) {
        if (f->segments[k].kind != DMB_SEGMENT_PER_REVOLUTION) continue;
        const dmb_time_function *turning = f->segments[k].callback_context;
        if (turning->segments == scene->time_functions[of].segments) return 1;
    }
    return 0;
}

/* First time function in use that follows `of`; DMB_NONE: none. */
static uint32_t follower_of(const dmb_scene *scene, uint32_t of)
{
    for (uint32_t i = 0; i < scene->drive_count; ++i) {
        if (follows(scene, scene->drives[i].time_function, of)) return scene->drives[i].time_function;
        if (follows(scene, scene->drives[i].excitation, of)) return scene->drives[i].excitation;
    }
    for (uint32_t i = 0; i < scene->load_count; ++i)
        if (follows(scene, scene->loads[i].time_function, of)) return scene->loads[i].time_function;
    for (uint32_t i = 0; i < scene->bit_count; ++i)
        if (follows(scene, scene->bits[i].load, of)) return scene->bits[i].load;
    return DMB_NONE;
}

/* Segments per revolution follow a time function as described. An input that replaces it at run time is not followed: a
 * warning. */
uint32_t dmb_followed_input(const dmb_scene *scene, uint32_t from, dmb_message *text)
{
    for (uint32_t i = from; i < scene->input_count; ++i) {
        const dmb_scene_input *input = scene->inputs + i;
        const uint32_t of = replaced(scene, input), by = of == DMB_NONE ? DMB_NONE : follower_of(scene, of);
        dmb_message name;
        if (by == DMB_NONE) continue;
        dmb_message_set(text,
                        "%s: it replaces time function %u, but a segment of time function %u follows that per "
                        "revolution as described: once the input is set, angle and amplitude of the segment are no "
                        "longer those of the driven part",
                        dmb_part_text(&name, "input", i, input->name, sizeof input->name), of, by);
        return i;
    }
    return DMB_NONE;
}
