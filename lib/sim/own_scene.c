/* Scene of one sim: compiled parts that inputs or cutters change are copied, all others are shared.
 *
 *     target of the input            part of the own scene
 *     ----------------------------   --------------------------------------------------------------
 *     set point, load, bit load      time function number time_function_count + input, which is the
 *                                    transition eq:drive.reference; NaN: the described function
 *     gains and limits of a drive    members of the drive
 *     friction                       factor on the coefficients of the law and on those by depth
 *     fluid density                  weights of element types and of nodes
 *     external damping               coefficients of the nodes
 *     flow rate                      pressures and forces of the mud (dmb_scene_set_flow)
 *     stuck place                    nothing: the state has stuck_held and stuck_anchor
 *
 * A compiled scene of sparse clusters has a dense twin for analyses; it shares the copied arrays, and its few numbers
 * are set along with those of the scene. */
#include "sim/own_scene.h"

#include <math.h>
#include <string.h>

#include "base/sized_struct.h"
#include "drillmbd/scene.h"
#include "force/time_segment.h"
#include "model/describe.h"
#include "sim/access.h"

#define DOUBLES(arena, count) DMB_ARENA_DOUBLES(arena, (size_t)(count))

dmb_own_scene *dmb_own_scene_allocate(dmb_arena *arena, const dmb_scene *scene)
{
    dmb_own_scene nowhere, *made = DMB_ARENA_ARRAY(arena, dmb_own_scene, 1), *to = made != NULL ? made : &nowhere;
    const size_t n = scene->node_count, inputs = scene->input_count;
    to->drives = DMB_ARENA_ARRAY(arena, dmb_scene_drive, scene->drive_count);
    to->loads = DMB_ARENA_ARRAY(arena, dmb_scene_load, scene->load_count);
    to->bits = DMB_ARENA_ARRAY(arena, dmb_scene_bit, scene->bit_count);
    to->time_functions = DMB_ARENA_ARRAY(arena, dmb_time_function, scene->time_function_count + inputs);
    to->segments = DMB_ARENA_ARRAY(arena, dmb_segment, inputs);
    to->references = DMB_ARENA_ARRAY(arena, dmb_reference, inputs);
    if (scene->has_density_input) {
        to->types = (dmb_element_type *)dmb_arena_allocate(arena, scene->type_count, sizeof *to->types, DMB_ALIGNMENT);
        to->weight_mass = DOUBLES(arena, n);
        to->weight_moment = DOUBLES(arena, 3 * n);
    }
    if (scene->has_damping_input) to->node_damping = DOUBLES(arena, 5 * n);
    if (scene->has_flow_input) {
        to->flow_pieces = DMB_ARENA_ARRAY(arena, dmb_flow_piece, scene->flow_count);
        to->flow_element = DOUBLES(arena, scene->element_count);
        to->flow_node = DOUBLES(arena, 2 * n);
    }
    return made;
}

/* ---- As described ------------------------------------------------------------------------------------------------ */

uint32_t dmb_described_time_function(const dmb_scene *scene, uint32_t input)
{
    const dmb_scene_input *i = scene->inputs + input;
    switch (i->target) {
    case DMB_TARGET_SET_POINT: return scene->drives[i->index].time_function;
    case DMB_TARGET_LOAD_FACTOR: return scene->loads[i->index].time_function;
    case DMB_TARGET_BIT_LOAD: return scene->bits[i->index].load;
    default: return DMB_NONE;
    }
}

/* A load without a time function has the factor 1, a bit without one no load. */
static double without_time_function(const dmb_scene_input *input)
{
    return input->target == DMB_TARGET_LOAD_FACTOR ? 1.0 : 0.0;
}

/* Described value. Only the sum of damping per length over a node is stored, so the description in sim->model is read.
 */
static double described_value(const dmb_scene *scene, const dmb_environment_def *e, uint32_t input)
{
    const dmb_scene_input *i = scene->inputs + input;
    switch (i->target) {
    case DMB_TARGET_GAIN: return scene->drives[i->index].gain;
    case DMB_TARGET_INTEGRAL_GAIN: return scene->drives[i->index].integral_gain;
    case DMB_TARGET_LIMIT_LOW: return scene->drives[i->index].limit_low;
    case DMB_TARGET_LIMIT_HIGH: return scene->drives[i->index].limit_high;
    case DMB_TARGET_FRICTION: return 1.0;
    case DMB_TARGET_STUCK: return scene->stuck[i->index].initially;
    case DMB_TARGET_FLUID_DENSITY: return e->fluid_density;
    case DMB_TARGET_LATERAL_DAMPING: return e->lateral_damping;
    case DMB_TARGET_AXIAL_DAMPING: return e->axial_damping;
    case DMB_TARGET_TORSIONAL_DAMPING: return e->torsional_damping;
    case DMB_TARGET_FLOW_RATE: return e->flow_rate;
    default: return dmb_described_time_function(scene, input) == DMB_NONE ? without_time_function(i) : (double)NAN;
    }
}

double dmb_described_setting(const dmb_sim *sim, uint32_t input)
{
    return described_value(sim->model->scene, &sim->model->environment, input);
}

/* ---- As set ------------------------------------------------------------------------------------------------------ */

/* Replaces a time function by the value of an input. */
static void set_time_function(const dmb_sim *sim, uint32_t input)
{
    dmb_own_scene *own = sim->own;
    const dmb_scene_input *i = own->scene.inputs + input;
    const double value = sim->input_value[input], *begin = sim->input_begin + 3 * (size_t)input;
    uint32_t time_function = own->scene.time_function_count + input;
    if (isnan(value)) time_function = dmb_described_time_function(sim->model->scene, input);
    own->references[input] = (dmb_reference){.time = begin[0],
                                             .value = begin[1],
                                             .rate = begin[2],
                                             .target = value,
                                             .rate_limit = i->rate_limit,
                                             .slope_limit = i->slope_limit};
    if (i->target == DMB_TARGET_SET_POINT) own->drives[i->index].time_function = time_function;
    if (i->target == DMB_TARGET_LOAD_FACTOR) own->loads[i->index].time_function = time_function;
    if (i->target == DMB_TARGET_BIT_LOAD) own->bits[i->index].load = time_function;
}

static void set_drive(dmb_scene_drive *drive, int32_t target, double value)
{
    if (target == DMB_TARGET_GAIN) drive->gain = value;
    if (target == DMB_TARGET_INTEGRAL_GAIN) drive->integral_gain = value;
    if (target == DMB_TARGET_LIMIT_LOW) drive->limit_low = value;
    if (target == DMB_TARGET_LIMIT_HIGH) drive->limit_high = value;
}

static void set_friction(dmb_scene *own, const dmb_scene *described, double factor)
{
    own->friction_law.mu_static = factor * described->friction_law.mu_static;
    own->friction_law.mu_dynamic = factor * described->friction_law.mu_dynamic;
    own->hole.friction = factor;
}

/* Buoyancy is linear in the density (eq:motion.weight with the mass of the displaced mud taken off), so each weight is
 * the described one less the change of density times the displaced volume [m3], and moments likewise [m4]. */
static void set_density(dmb_own_scene *own, const dmb_scene *described, double density)
{
    const double more = density - described->fluid_density;
    own->scene.fluid_density = density;
    for (uint32_t i = 0; i < described->type_count; i++)
        own->types[i].weight_mass = described->types[i].weight_mass - more * described->types[i].displaced;
    for (uint32_t i = 0; i < described->node_count; i++) {
        own->weight_mass[i] = described->weight_mass[i] - more * described->displaced[2 * (size_t)i];
        own->weight_moment[3 * (size_t)i] =
            described->weight_moment[3 * (size_t)i] - more * described->displaced[2 * (size_t)i + 1];
    }
}

void dmb_external_damping(const dmb_sim *sim, double coefficients[3])
{
    const dmb_scene *scene = sim->scene;
    const dmb_environment_def *e = &sim->model->environment;
    coefficients[0] = e->lateral_damping, coefficients[1] = e->axial_damping, coefficients[2] = e->torsional_damping;
    for (uint32_t i = 0; i < scene->input_count; i++)
        if (scene->inputs[i].target >= DMB_TARGET_LATERAL_DAMPING &&
            scene->inputs[i].target <= DMB_TARGET_TORSIONAL_DAMPING)
            coefficients[scene->inputs[i].target - DMB_TARGET_LATERAL_DAMPING] = sim->input_value[i];
}

static void set_damping(const dmb_sim *sim)
{
    const dmb_scene *scene = &sim->own->scene;
    double c[3];
    dmb_external_damping(sim, c);
    for (uint32_t i = 0; i < scene->node_count; i++)
        dmb_node_damping_of(scene->damped_length + 3 * (size_t)i, c[1], c[2], c[0],
                            sim->own->node_damping + 5 * (size_t)i);
}

/* Density and flow cost O(nodes); they are computed when they change only. */
static void set_input(const dmb_sim *sim, uint32_t input)
{
    dmb_own_scene *own = sim->own;
    const dmb_scene *described = sim->model->scene;
    const dmb_scene_input *i = described->inputs + input;
    const double value = sim->input_value[input];
    if (dmb_input_is_time_function(i->target))
        set_time_function(sim, input);
    else if (i->target <= DMB_TARGET_LIMIT_HIGH)
        set_drive(own->drives + i->index, i->target, value);
    else if (i->target == DMB_TARGET_FRICTION)
        set_friction(&own->scene, described, value);
    else if (i->target == DMB_TARGET_FLUID_DENSITY && value != own->scene.fluid_density)
        set_density(own, described, value);
    else if (i->target == DMB_TARGET_FLOW_RATE && value != own->scene.flow.rate)
        dmb_scene_set_flow(&own->scene, value);
}

void dmb_own_scene_update(dmb_sim *sim)
{
    if (sim->own == NULL) return;
    for (uint32_t i = 0; i < sim->own->scene.input_count; i++) set_input(sim, i);
    if (sim->own->scene.has_damping_input && sim->own->scene.features & DMB_FEATURE_DAMPING) set_damping(sim);
    sim->own->dense.friction_law = sim->own->scene.friction_law;
    sim->own->dense.hole.friction = sim->own->scene.hole.friction;
    sim->own->dense.fluid_density = sim->own->scene.fluid_density;
    sim->own->dense.flow = sim->own->scene.flow;
}

/* ---- A new sim --------------------------------------------------------------------------------------------------- */

static void copy_parts(dmb_own_scene *own, const dmb_scene *scene)
{
    const size_t n = scene->node_count;
    memcpy(own->drives, scene->drives, scene->drive_count * sizeof *own->drives);
    memcpy(own->loads, scene->loads, scene->load_count * sizeof *own->loads);
    memcpy(own->bits, scene->bits, scene->bit_count * sizeof *own->bits);
    if (scene->time_function_count > 0)
        memcpy(own->time_functions, scene->time_functions, scene->time_function_count * sizeof *own->time_functions);
    if (scene->has_density_input) {
        memcpy(own->types, scene->types, scene->type_count * sizeof *own->types);
        memcpy(own->weight_mass, scene->weight_mass, n * sizeof(double));
        memcpy(own->weight_moment, scene->weight_moment, 3 * n * sizeof(double));
    }
    if (scene->has_damping_input) memcpy(own->node_damping, scene->node_damping, 5 * n * sizeof(double));
    if (!scene->has_flow_input) return;
    memcpy(own->flow_pieces, scene->flow_pieces, scene->flow_count * sizeof *own->flow_pieces);
    if (scene->element_count > 0) memcpy(own->flow_element, scene->flow_element, scene->element_count * sizeof(double));
    memcpy(own->flow_node, scene->flow_node, 2 * n * sizeof(double));
}

/* Replaces parts of the compiled scene by the sim's own. */
static void place_parts(dmb_own_scene *own, const dmb_scene *compiled, dmb_scene *to)
{
    *to = *compiled;
    to->drives = own->drives;
    to->loads = own->loads;
    to->bits = own->bits;
    to->time_functions = own->time_functions;
    if (compiled->has_density_input) {
        to->types = own->types;
        to->weight_mass = own->weight_mass;
        to->weight_moment = own->weight_moment;
    }
    if (compiled->has_damping_input) to->node_damping = own->node_damping;
    if (!compiled->has_flow_input) return;
    to->flow_pieces = own->flow_pieces;
    to->flow_element = own->flow_element;
    to->flow_node = own->flow_node;
}

static void place_inputs(dmb_own_scene *own, const dmb_scene *scene)
{
    for (uint32_t i = 0; i < scene->input_count; i++) {
        own->segments[i].kind = DMB_SEGMENT_REFERENCE;
        own->segments[i].callback_context = &own->references[i];
        own->time_functions[scene->time_function_count + i] = (dmb_time_function){&own->segments[i], 1};
    }
}

/* Copies the parts, before any value of an input is set in them. */
static void make(dmb_sim *sim, const dmb_scene *scene)
{
    dmb_own_scene *own = sim->own;
    const double *widening = scene->hole.cuts > 0 ? sim->hole_widening : NULL;
    copy_parts(own, scene);
    place_parts(own, scene, &own->scene);
    place_inputs(own, scene);
    own->scene.hole.widening = widening;
    if (scene->dense == NULL) return;
    place_parts(own, scene->dense, &own->dense);
    own->dense.hole.widening = widening;
    own->scene.dense = &own->dense;
}

void dmb_own_scene_copy(dmb_sim *copy, const dmb_sim *sim)
{
    const dmb_scene *described = sim->model->scene;
    if (copy->own == NULL) return;
    const int is_dense = copy->scene->sparse_count != described->sparse_count; /* as in its layout */
    make(copy, described);
    copy->scene = is_dense ? &copy->own->dense : &copy->own->scene;
}

void dmb_own_scene_enter(dmb_sim *copy, const dmb_model *model)
{
    copy->model = (dmb_model *)model;
    copy->scene = model->scene;
    if (copy->own == NULL) return;
    make(copy, model->scene);
    copy->scene = &copy->own->scene;
    dmb_own_scene_update(copy);
}

/* An input without `initial` starts as described; a time function then has the value NaN and stays in effect until the
 * first set. The transition begins at the initial value, at rest. */
void dmb_own_scene_begin(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    if (sim->own == NULL) return;
    make(sim, scene);
    for (uint32_t i = 0; i < scene->input_count; i++) {
        const double initial = scene->inputs[i].initial;
        sim->input_value[i] = isnan(initial) ? dmb_described_setting(sim, i) : initial;
        sim->input_begin[3 * (size_t)i + 1] = isnan(sim->input_value[i]) ? 0.0 : sim->input_value[i];
    }
    sim->scene = &sim->own->scene;
    dmb_own_scene_update(sim);
}

/* ---- The inputs of an accepted state ----------------------------------------------------------------------------- */

DMB_DEFINE_INIT(dmb_input_state, 40, {.value = 0.0})

int32_t dmb_input_present(const dmb_sim *sim, uint32_t i, double *value, double *rate)
{
    const uint32_t time_function = dmb_described_time_function(sim->scene, i);
    *rate = 0.0;
    *value = sim->input_value[i];
    if (time_function == DMB_NONE) return DMB_OK;
    return dmb_time_function_value(sim->scene->time_functions + time_function, sim->clock->time, value, rate);
}

int32_t dmb_sim_get_input(const dmb_sim *sim, dmb_id input, dmb_input_state *state)
{
    dmb_input_state answer = dmb_input_state_default();
    int32_t status = dmb_ask(sim, state);
    if (status < 0) return dmb_sim_failed(sim, "input", status);
    const uint32_t i = dmb_model_part_index(sim->model, input, DMB_PART_INPUT);
    if (i >= sim->scene->input_count) return dmb_sim_failed(sim, "input", DMB_ERR_ID);
    status = dmb_input_present(sim, i, &answer.present, &answer.rate);
    if (status < 0) return dmb_sim_failed(sim, "input", status);
    answer.is_set = !isnan(sim->input_value[i]);
    answer.value = answer.is_set ? sim->input_value[i] : answer.present;
    if (answer.is_set) answer.arrives = dmb_reference_arrival(&sim->own->references[i]);
    return dmb_sim_failed(sim, "input", dmb_input_state_write(state, &answer));
}
