/* Lengths of pipe with mud flow inside and back outside: losses there, by the diameters at the described positions, and
 * force on the string (force/mud_flow.h). */
#include <math.h>

#include "force/hole.h"
#include "force/mud_flow.h"
#include "model/describe.h"
#include "model/mesh.h"
#include "model/model.h"
#include "model/section.h"

typedef struct flow_iterator {
    dmb_mesh *mesh;
    const dmb_pipe_def *pipe;
    double start;        /* [m] measured depth of the rig end */
    dmb_flow_piece last; /* zeros before the first */
    uint32_t number;     /* of the pipe */
} flow_iterator;

static int32_t refuse(const dmb_mesh *mesh, int32_t status, const char *text)
{
    dmb_message_set(&mesh->model->message, "environment: flow_rate = %g m3/s, must be 0 %s",
                    mesh->model->environment.flow_rate, text);
    return status;
}

/* Checks the range of diameters of the laws of eccentric annuli. */
static int32_t check_ratio(const flow_iterator *iterator, const char *part, double ratio, double from)
{
    if (!(iterator->mesh->flow.eccentricity > 0.0)) return DMB_OK;
    if (ratio >= DMB_FLOW_ECCENTRIC_RATIO_MIN && ratio <= DMB_FLOW_ECCENTRIC_RATIO_MAX) return DMB_OK;
    dmb_message_set(&iterator->mesh->model->message,
                    "%s: outer diameter over that of the hole = %g at %g m of the string, must be from %g to %g with a "
                    "flow_eccentricity of the environment, the range of its law; leave the eccentricity out",
                    part, ratio, from, DMB_FLOW_ECCENTRIC_RATIO_MIN, DMB_FLOW_ECCENTRIC_RATIO_MAX);
    return DMB_ERR_GEOMETRY;
}

static int32_t check_duct(const flow_iterator *iterator, const dmb_flow_piece *piece, double hole)
{
    dmb_message *message = &iterator->mesh->model->message, part;
    const double *d = piece->diameter;
    (void)dmb_model_pipe_text(iterator->mesh->model, 0, iterator->number, &part);
    if (!(d[1] > 0.0)) {
        dmb_message_set(message,
                        "%s: inner diameter = %g m at %g m, must be > 0 with a flow_rate of the environment; "
                        "give it a bore",
                        part.text, d[1], piece->from);
        return DMB_ERR_GEOMETRY;
    }
    if (hole - d[0] > 1e-4 * hole) return check_ratio(iterator, part.text, d[0] / hole, piece->from);
    dmb_message_set(message,
                    "%s: outer diameter = %g m at %g m of the string, must leave the mud an annulus in the hole "
                    "of %g m there, with a flow_rate of the environment; widen the hole",
                    part.text, d[0], piece->from, hole);
    return DMB_ERR_GEOMETRY;
}

static const dmb_input_def *input_of(const dmb_model *model)
{
    for (uint32_t i = 0; i < model->inputs.count; ++i) {
        const dmb_input_def *def = DMB_LIST_AT(const dmb_input_def, model->inputs, i);
        if (def->target == DMB_TARGET_FLOW_RATE) return def;
    }
    return NULL;
}

/* Smallest or largest flow rate: as described, or the bound of the input *by. An input that is not set at the start
 * leaves the described rate, which may lie outside its bounds. */
static double rate_at(const dmb_mesh *mesh, int largest, const dmb_input_def **by)
{
    const dmb_input_def *def = input_of(mesh->model);
    const double described = mesh->model->environment.flow_rate;
    *by = NULL;
    if (def == NULL) return described;
    const double bound = largest ? dmb_input_high(def) : dmb_input_low(def);
    if (isnan(def->initial) && (largest ? described > bound : described < bound)) return described;
    *by = def;
    return bound;
}

/* "environment: flow_rate", or the bound of an input. */
static const char *rate_text(const dmb_input_def *by, const char *bound, dmb_message *text)
{
    if (by == NULL) return "environment: flow_rate";
    dmb_message_set(text, "input (%s): %s", by->name, bound);
    return text->text;
}

/* Checks the Reynolds number, which grows with the rate. */
static int32_t check_reynolds(const flow_iterator *iterator, const dmb_flow_piece *piece)
{
    const dmb_input_def *by;
    dmb_mud_flow flow = iterator->mesh->flow;
    dmb_message text;
    flow.rate = rate_at(iterator->mesh, 1, &by);
    const double bore = dmb_bore_loss(&flow, piece->diameter[1]).reynolds;
    const double annulus = dmb_annulus_loss_by(&flow, piece->diameter[0], piece->hole, &piece->shape).reynolds;
    const double most = bore > annulus ? bore : annulus;
    if (most <= DMB_FLOW_REYNOLDS_MAX) return DMB_OK;
    dmb_message_set(&iterator->mesh->model->message,
                    "%s = %g m3/s: the Reynolds number at %g m of the string is %g, must be <= %g, up to "
                    "which the law of friction was measured; lower the rate, or raise the consistency",
                    rate_text(by, "high", &text), flow.rate, piece->from, most, DMB_FLOW_REYNOLDS_MAX);
    return DMB_ERR_VALUE;
}

/* Losses of a piece; for equal diameters the shape, the expensive part, is that of the piece before. */
static void set_losses(flow_iterator *iterator, double hole, dmb_flow_piece *piece)
{
    const dmb_mud_flow *flow = &iterator->mesh->flow;
    const dmb_flow_piece *last = &iterator->last;
    const bool same = dmb_same_numbers(piece->diameter, last->diameter, 2);
    piece->hole = hole;
    piece->shape = same && dmb_same_numbers(&hole, &last->hole, 1)
                       ? last->shape
                       : dmb_annulus_shape_of(flow, piece->diameter[0] / hole);
    piece->before[0] = last->before[0] + last->length * last->bore.gradient;
    piece->before[1] = last->before[1] + last->length * last->annulus.gradient;
    piece->bore = dmb_bore_loss(flow, piece->diameter[1]);
    piece->annulus = dmb_annulus_loss_by(flow, piece->diameter[0], hole, &piece->shape);
}

/* Levers of the force on an element as of a uniform load q on the cubic shape (dmb_scene_fill_pulls): q L/2 and q
 * L^2/12 at each end are a force at the distance L/6 from it. A rigid length acts at its middle. */
static void set_levers(const dmb_mesh *mesh, dmb_flow_piece *piece)
{
    const double L = piece->length;
    piece->lever[0] = piece->from + 0.5 * L - dmb_mesh_node_at(mesh, piece->node)->at;
    if (piece->element == DMB_NONE) return;
    const uint32_t node = dmb_mesh_element_at(mesh, piece->element)->node;
    piece->lever[0] = piece->from + L / 6.0 - dmb_mesh_node_at(mesh, node)->at;
    piece->lever[1] = piece->from + L - L / 6.0 - dmb_mesh_node_at(mesh, node + 1)->at;
}

static int32_t add_piece(flow_iterator *iterator, dmb_flow_piece *piece, int in_tool_joint)
{
    const double middle = iterator->start + piece->from + 0.5 * piece->length;
    set_levers(iterator->mesh, piece);
    const double hole = 2.0 * dmb_hole_radius(&iterator->mesh->hole, middle);
    dmb_pipe_diameters(iterator->pipe, in_tool_joint, piece->diameter);
    int32_t status = check_duct(iterator, piece, hole);
    if (status < 0) return status;
    set_losses(iterator, hole, piece);
    status = check_reynolds(iterator, piece);
    iterator->last = *piece;
    return status < 0 ? status
                      : dmb_vector_append(&iterator->mesh->flow_pieces, &iterator->mesh->model->allocator, piece, 1);
}

static int32_t add_pipe(flow_iterator *iterator, const dmb_pipe_map *pipe, double from)
{
    const dmb_mesh *mesh = iterator->mesh;
    dmb_pipe_section section;
    dmb_flow_piece piece = {.from = from, .poisson = iterator->pipe->poisson_ratio, .element = DMB_NONE};
    int32_t status = DMB_OK;
    dmb_section_of(iterator->pipe, &section);
    piece.node = pipe->node;
    piece.length = dmb_pipe_body_length(iterator->pipe);
    if (pipe->elements == 0) status = add_piece(iterator, &piece, 0);
    for (uint32_t e = pipe->element; e < pipe->element + pipe->elements && status >= 0; ++e) {
        piece.element = e;
        piece.length = dmb_mesh_element_at(mesh, e)->length;
        piece.steel = section.stiffness[0];
        status = add_piece(iterator, &piece, 0);
        piece.from += piece.length;
        piece.node = dmb_mesh_element_at(mesh, e)->node + 1;
    }
    if (status < 0 || !(iterator->pipe->joint_length > 0.0)) return status;
    piece.from = from + dmb_pipe_body_length(iterator->pipe);
    piece.length = iterator->pipe->joint_length;
    piece.steel = 0.0;
    piece.element = DMB_NONE;
    return add_piece(iterator, &piece, 1);
}

/* [Pa] Excess of inside over outside pressure at the rig end, as described, at a rate: losses of nozzle, bore and
 * annulus along the way of the mud, and the difference of the two columns, (rho_o - rho_i) g . (bottom - top), of which
 * the path between both ends does not matter. */
static double pump_pressure(const dmb_mesh *mesh, double rate)
{
    const dmb_environment_def *e = &mesh->model->environment;
    const dmb_string_map *string = dmb_mesh_string_at(mesh, 0);
    const double *top = dmb_mesh_node_at(mesh, string->start_node)->position;
    const double *bottom = dmb_mesh_node_at(mesh, string->end_node)->position;
    dmb_mud_flow flow = mesh->flow;
    flow.rate = rate;
    double pressure = dmb_nozzle_loss(&flow);
    for (uint32_t i = 0; i < mesh->flow_pieces.count; ++i) {
        const dmb_flow_piece *piece = DMB_VECTOR_AT(dmb_flow_piece, &mesh->flow_pieces, i);
        pressure +=
            piece->length * (dmb_bore_loss(&flow, piece->diameter[1]).gradient +
                             dmb_annulus_loss_by(&flow, piece->diameter[0], piece->hole, &piece->shape).gradient);
    }
    for (int k = 0; k < 3 && (mesh->features & DMB_FEATURE_GRAVITY) != 0; ++k)
        pressure += (mesh->flow.outside - mesh->flow.inside) * e->gravity[k] * (bottom[k] - top[k]);
    return pressure;
}

#define DMB_PUMP_PRESSURE_MAX 1e12 /* [Pa] */

/* The bound keeps forces by pressure (times an area) and their sums far from overflow; no pump comes near it. */
static int32_t check_largest_pressure(const dmb_mesh *mesh)
{
    const dmb_input_def *by;
    dmb_message text;
    const double rate = rate_at(mesh, 1, &by), pressure = pump_pressure(mesh, rate);
    if (pressure <= DMB_PUMP_PRESSURE_MAX) return DMB_OK;
    dmb_message_set(
        &mesh->model->message,
        "%s = %g m3/s: the pressure of the pump would be %g Pa, at most %g Pa is permitted; lower the rate, or "
        "enlarge inner_diameter of the pipes or nozzle_area",
        rate_text(by, "high", &text), rate, pressure, DMB_PUMP_PRESSURE_MAX);
    return DMB_ERR_VALUE;
}

/* Checks the pump pressure. Losses grow with the rate: the smallest rate decides its sign, the largest its size. */
static int32_t check_pump(const dmb_mesh *mesh)
{
    const dmb_input_def *by;
    dmb_message text;
    const double rate = rate_at(mesh, 0, &by), pressure = pump_pressure(mesh, rate);
    if (pressure >= 0.0) return check_largest_pressure(mesh);
    dmb_message_set(&mesh->model->message,
                    "%s = %g m3/s, too small: the pump's pressure would be %g Pa, must be >= 0: the heavier mud inside "
                    "falls by itself; raise the rate, or lower inner_density",
                    rate_text(by, "low", &text), rate, pressure);
    return DMB_ERR_VALUE;
}

static void allocate_flow(dmb_mesh *mesh)
{
    const dmb_environment_def *e = &mesh->model->environment;
    mesh->flow = (dmb_mud_flow){.rate = e->flow_rate,
                                .consistency = e->consistency,
                                .exponent = e->flow_exponent,
                                .yield_stress = e->yield_stress,
                                .eccentricity = e->flow_eccentricity,
                                .nozzle_area = e->nozzle_area,
                                .open = !(e->nozzle_area > 0.0),
                                .inside = e->inner_density < 0.0 ? e->fluid_density : e->inner_density,
                                .outside = e->fluid_density};
}

/* Open end of the string: no loss, but the thrust of the outflow. */
static int32_t add_end(flow_iterator *iterator)
{
    dmb_mud_flow *flow = &iterator->mesh->flow;
    if (flow->open) flow->nozzle_area = dmb_ring_area(iterator->last.diameter[1], 0.0);
    return check_pump(iterator->mesh);
}

/* Checks the mud for flow. The environment was checked for its own rate; an input may add a flow later. */
static int32_t check_mud(const dmb_mesh *mesh)
{
    const dmb_environment_def *e = &mesh->model->environment;
    const dmb_input_def *by = input_of(mesh->model);
    const char *field = NULL;
    if (!(e->consistency > 0.0)) field = "consistency";
    if (!(e->fluid_density > 0.0)) field = "fluid_density";
    if (e->inner_density >= 0.0 && !(e->inner_density > 0.0)) field = "inner_density";
    if (field == NULL || by == NULL) return DMB_OK;
    dmb_message_set(
        &mesh->model->message,
        "input (%s): target = DMB_TARGET_FLOW_RATE, but %s of the environment is 0, must be > 0; set it, or "
        "leave the input out",
        by->name, field);
    return DMB_ERR_VALUE;
}

static bool is_far_end(const dmb_mesh *mesh, const dmb_place *place)
{
    const uint32_t pipes = DMB_LIST_AT(const dmb_string_plan, mesh->model->strings, 0)->pipes;
    return dmb_model_part_index(mesh->model, place->part, DMB_PART_STRING) == 0 && place->pipe + 1 == pipes &&
           place->fraction >= 1.0;
}

/* Checks motors: the mud of the string must pass through its motors at its end. */
static int32_t check_motors(const dmb_mesh *mesh)
{
    const dmb_model *model = mesh->model;
    for (uint32_t i = 0; i < model->drives.count; ++i) {
        const dmb_drive_def *def = DMB_LIST_AT(const dmb_drive_def, model->drives, i);
        const uint32_t index = dmb_model_part_index(model, def->part, DMB_PART_JOINT);
        dmb_message text;
        if (!(def->mud_pressure > 0.0) || index == DMB_NONE) continue;
        const dmb_joint_def *joint = DMB_LIST_AT(const dmb_joint_def, model->joints, index);
        if (is_far_end(mesh, &joint->place_a) || is_far_end(mesh, &joint->place_b)) continue;
        dmb_message_set(
            &mesh->model->message,
            "%s: mud_pressure = %g Pa/(N m), must be on a joint at the far end of the string in a scene with "
            "a flow_rate; move the joint, or set it to 0",
            dmb_model_part_text(model, DMB_PART_DRIVE, i, &text), def->mud_pressure);
        return DMB_ERR_UNSUPPORTED;
    }
    return DMB_OK;
}

/* Pieces from the rig end down. The losses of a piece need those of the piece before, and the check of the pump those
 * of all. With an input for the flow rate the range is checked at its bounds: the laws hold for every rate in between,
 * since Reynolds numbers and losses grow with the rate. */
int32_t dmb_mesh_flow(dmb_mesh *mesh)
{
    flow_iterator iterator = {.mesh = mesh};
    int32_t status = DMB_OK;
    double from = 0.0;
    if (!(mesh->model->environment.flow_rate > 0.0) && input_of(mesh->model) == NULL) return DMB_OK;
    status = check_mud(mesh);
    if (status < 0) return status;
    if (mesh->strings.count != 1) return refuse(mesh, DMB_ERR_UNSUPPORTED, "in a model with other than one string");
    if (!mesh->has_hole || !dmb_mesh_follows_hole(mesh, 0))
        return refuse(mesh, DMB_ERR_UNSUPPORTED, "without a string that follows its hole; add a wall");
    if (mesh->hole.cuts > 0)
        return refuse(mesh, DMB_ERR_UNSUPPORTED,
                      "in a hole that cutters widen, whose losses would go by the described diameter; leave out the "
                      "flow, or cut_spacing of the wall");
    status = check_motors(mesh);
    allocate_flow(mesh);
    iterator.start = dmb_mesh_string_def(mesh, 0)->start_depth;
    dmb_pipe_iterator pipes = dmb_pipe_iterator_of(mesh, 0);
    while (status >= 0 && dmb_pipe_iterator_next(&pipes)) {
        iterator.pipe = &pipes.run->def;
        iterator.number = pipes.number;
        status =
            add_pipe(&iterator, dmb_mesh_pipe_at(mesh, dmb_mesh_string_at(mesh, 0)->first_pipe + pipes.number), from);
        from += iterator.pipe->length;
    }
    return status < 0 ? status : add_end(&iterator);
}
