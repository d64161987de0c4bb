/* Comparison of two models that may differ in pipes at the rig ends of their strings only.
 *
 * Compared is what the transferred numbers mean: kinds and order of parts (an array of one sim is copied to the other),
 * the pipes both have, the hole's axis (depths and segments along it), names and bounds of inputs. Not compared is what
 * the next evaluation reads from the new model anyway: numbers in laws of joints, drives and the wall, levels of
 * events, described places. Numbers of parts come first and features last, since differences in parts give clearer
 * messages.
 *
 * Pipes are counted from the far end, k = 0 being the last one:
 *
 *     to      [ added pipes ][ n-1 ... 1 0 ]
 *     from                   [ n-1 ... 1 0 ] */
#include <math.h>
#include <string.h>

#include "model/model.h"
#include "query/query.h"
#include "run/run.h"
#include "sim/node.h"

dmb_common_string dmb_common_string_of(const dmb_scene *scene, const dmb_scene *from, uint32_t string)
{
    const dmb_string_map *to = scene->strings + string, *old = from->strings + string;
    dmb_common_string common;
    common.pipes = to->pipe_count < old->pipe_count ? to->pipe_count : old->pipe_count;
    common.to = scene->pipes[to->first_pipe + to->pipe_count - common.pipes].node;
    common.from = from->pipes[old->first_pipe + old->pipe_count - common.pipes].node;
    common.nodes = to->first_node + to->node_count - common.to;
    return common;
}

static int32_t other(dmb_sim *sim, const char *part, uint32_t index, const char *what)
{
    dmb_message name;
    dmb_message_set(&sim->message, "state transfer: %s: %s, must be as in the sim it continues",
                    dmb_model_word_text(sim->model, part, index, &name), what);
    return DMB_ERR_VALUE;
}

/* ---- Numbers of parts -------------------------------------------------------------------------------------------- */

static int32_t check_counts(dmb_sim *sim, const dmb_sim *from)
{
    const dmb_scene *a = sim->scene, *b = from->scene;
    const struct {
        const char *what;
        uint32_t to, from;
    } counts[] = {{"strings", a->string_count, b->string_count},
                  {"bodies", sim->model->bodies.count, from->model->bodies.count},
                  {"bits", a->bit_count, b->bit_count},
                  {"drives", a->drive_count, b->drive_count},
                  {"loads", a->load_count, b->load_count},
                  {"inputs", a->input_count, b->input_count},
                  {"events", a->event_count, b->event_count},
                  {"time_functions", a->time_function_count, b->time_function_count},
                  {"walls", a->has_hole != 0, b->has_hole != 0},
                  {"joints", a->joint_count, b->joint_count},
                  {"couplings", a->coupling_count, b->coupling_count},
                  {"constraints", a->callback_count, b->callback_count},
                  {"springs", a->spring_count, b->spring_count},
                  {"forces", a->force_count, b->force_count},
                  {"stuck places", a->stuck_count, b->stuck_count}};
    for (size_t i = 0; i < sizeof counts / sizeof counts[0]; i++) {
        if (counts[i].to == counts[i].from) continue;
        dmb_message_set(&sim->message, "state transfer: %s = %u, must be %u as in the sim it continues", counts[i].what,
                        counts[i].to, counts[i].from);
        return DMB_ERR_VALUE;
    }
    return DMB_OK;
}

/* Last check, because differences in parts give clearer messages. */
static int32_t check_features(dmb_sim *sim, const dmb_sim *from)
{
    if (sim->scene->features == from->scene->features) return DMB_OK;
    dmb_message_set(&sim->message, "state transfer: features = %d in all, must be %d as in the sim it continues",
                    (int)sim->scene->features, (int)from->scene->features);
    return DMB_ERR_VALUE;
}

/* ---- Parts ------------------------------------------------------------------------------------------------------- */

/* The part of an id; the first string for an empty id. */
static uint32_t part_of(dmb_id id)
{
    return id.generation != 0 ? id.index : (uint32_t)DMB_PART_STRING << 24;
}

static int32_t check_bodies(dmb_sim *sim, const dmb_sim *from)
{
    const dmb_body_def *to = sim->model->bodies.items, *old = from->model->bodies.items;
    for (uint32_t i = 0; i < sim->model->bodies.count; i++) {
        if (to[i].attach != old[i].attach) return other(sim, "body", i, "attach");
        if (to[i].attach != DMB_ATTACH_NONE && part_of(to[i].string) != part_of(old[i].string))
            return other(sim, "body", i, "string");
    }
    return DMB_OK;
}

static int32_t check_bits(dmb_sim *sim, const dmb_sim *from)
{
    const dmb_bit_def *def = sim->model->bits.items, *old_def = from->model->bits.items;
    for (uint32_t k = 0; k < sim->scene->bit_count; k++) {
        const dmb_scene_bit *to = sim->scene->bits + k, *old = from->scene->bits + k;
        if (part_of(def[k].string) != part_of(old_def[k].string)) return other(sim, "bit", k, "string");
        if (part_of(def[k].stabiliser) != part_of(old_def[k].stabiliser)) return other(sim, "bit", k, "stabiliser");
        if (to->law.kind != old->law.kind) return other(sim, "bit", k, "rock_law");
        if (to->law.blades != old->law.blades) return other(sim, "bit", k, "blades");
        if (to->history_capacity != old->history_capacity) return other(sim, "bit", k, "history");
    }
    return DMB_OK;
}

static int32_t check_drives(dmb_sim *sim, const dmb_sim *from)
{
    const dmb_drive_def *def = sim->model->drives.items, *old_def = from->model->drives.items;
    for (uint32_t i = 0; i < sim->scene->drive_count; i++) {
        const dmb_scene_drive *to = sim->scene->drives + i, *old = from->scene->drives + i;
        if (to->kind != old->kind) return other(sim, "drive", i, "kind");
        if (to->component != old->component) return other(sim, "drive", i, "component");
        if (part_of(def[i].part) != part_of(old_def[i].part)) return other(sim, "drive", i, "part");
        if ((to->actuator == DMB_NONE) != (old->actuator == DMB_NONE)) return other(sim, "drive", i, "actuator");
        if (def[i].delay != old_def[i].delay) return other(sim, "drive", i, "delay");
    }
    return DMB_OK;
}

static int32_t check_loads(dmb_sim *sim, const dmb_sim *from)
{
    const dmb_load_def *to = sim->model->loads.items, *old = from->model->loads.items;
    for (uint32_t i = 0; i < sim->scene->load_count; i++) {
        if (to[i].frame != old[i].frame) return other(sim, "load", i, "frame");
        if (part_of(to[i].place.part) != part_of(old[i].place.part)) return other(sim, "load", i, "part");
    }
    return DMB_OK;
}

static int32_t check_forces(dmb_sim *sim, const dmb_sim *from)
{
    for (uint32_t i = 0; i < sim->scene->force_count; i++)
        if (sim->scene->forces[i].states != from->scene->forces[i].states) return other(sim, "force", i, "state_count");
    return DMB_OK;
}

/* A transferred value must be within the bounds of the other model's input. */
static int32_t check_inputs(dmb_sim *sim, const dmb_sim *from)
{
    for (uint32_t i = 0; i < sim->scene->input_count; i++) {
        const dmb_scene_input *to = sim->scene->inputs + i, *old = from->scene->inputs + i;
        if (strcmp(to->name, old->name) != 0) return other(sim, "input", i, "name");
        if (to->target != old->target) return other(sim, "input", i, "target");
        if (to->index != old->index) return other(sim, "input", i, "part");
        if (to->low != old->low || to->high != old->high) return other(sim, "input", i, "low or high");
        if (isnan(to->initial) != isnan(old->initial)) return other(sim, "input", i, "initial (given or not)");
    }
    return DMB_OK;
}

/* Levels and times may differ: crossings are evaluated again. */
static int32_t check_events(dmb_sim *sim, const dmb_sim *from)
{
    for (uint32_t i = 0; i < sim->scene->event_count; i++) {
        const dmb_scene_event *to = sim->scene->events + i, *old = from->scene->events + i;
        if (strcmp(to->name, old->name) != 0) return other(sim, "event", i, "name");
        if (to->direction != old->direction) return other(sim, "event", i, "direction");
        if (to->output.quantity != old->output.quantity) return other(sim, "event", i, "output");
    }
    return DMB_OK;
}

/* 1: the same side of a joint; the ground is a part of its own. */
static int same_side(dmb_id a, dmb_id b)
{
    return a.index == b.index && (a.generation == 0) == (b.generation == 0);
}

/* Joints must connect the same parts, because angles count revolutions between them. */
static int32_t check_joints(dmb_sim *sim, const dmb_sim *from)
{
    const dmb_joint_def *to = sim->model->joints.items, *old = from->model->joints.items;
    for (uint32_t j = 0; j < sim->scene->joint_count; j++) {
        if (to[j].kind != old[j].kind) return other(sim, "joint", j, "kind");
        if (!same_side(to[j].place_a.part, old[j].place_a.part)) return other(sim, "joint", j, "part of place_a");
        if (!same_side(to[j].place_b.part, old[j].place_b.part)) return other(sim, "joint", j, "part of place_b");
    }
    return DMB_OK;
}

static int32_t check_links(dmb_sim *sim, const dmb_sim *from)
{
    const dmb_scene *a = sim->scene, *b = from->scene;
    for (uint32_t j = 0; j < a->coupling_count; j++)
        if (a->couplings[j].count != b->couplings[j].count ||
            memcmp(a->couplings[j].joint, b->couplings[j].joint, sizeof a->couplings->joint) != 0 ||
            memcmp(a->couplings[j].component, b->couplings[j].component, sizeof a->couplings->component) != 0)
            return other(sim, "coupling", j, "joint or component");
    for (uint32_t j = 0; j < a->callback_count; j++) {
        if (a->callbacks[j].kind != b->callbacks[j].kind) return other(sim, "constraint", j, "kind");
        if (a->callbacks[j].rows != b->callbacks[j].rows) return other(sim, "constraint", j, "rows");
        if (a->callbacks[j].count != b->callbacks[j].count) return other(sim, "constraint", j, "count");
    }
    return DMB_OK;
}

/* Depths and segments stored by contacts belong to the axis. */
static int32_t check_wall(dmb_sim *sim, const dmb_sim *from)
{
    const dmb_scene *a = sim->scene, *b = from->scene;
    const dmb_hole *to = &a->hole, *old = &b->hole;
    if (!a->has_hole) return DMB_OK;
    if (a->normal_law.kind != b->normal_law.kind) return other(sim, "wall", 0, "normal_law");
    if (a->friction_law.kind != b->friction_law.kind) return other(sim, "wall", 0, "friction_law");
    if (a->friction_law.states != b->friction_law.states) return other(sim, "wall", 0, "friction_state_count");
    if (memcmp(to->origin, old->origin, sizeof to->origin) != 0 ||
        memcmp(to->direction, old->direction, sizeof to->direction) != 0 || to->stations != old->stations)
        return other(sim, "wall", 0, "axis");
    for (uint32_t i = 0; i < to->stations; i++)
        if (to->station[i].depth != old->station[i].depth ||
            memcmp(to->station[i].tangent, old->station[i].tangent, sizeof to->station[i].tangent) != 0)
            return other(sim, "wall", 0, "axis");
    return DMB_OK;
}

/* ---- Pipes ------------------------------------------------------------------------------------------------------- */

/* Description of a pipe without its position and the random draw of its eccentricity. */
static dmb_pipe_def material_of(const dmb_sim *sim, uint32_t string, uint32_t pipe)
{
    const dmb_pipe_run *run = dmb_pipe_run_of(sim->model, string, pipe);
    dmb_pipe_def def;
    memset(&def, 0, sizeof def);
    if (run == NULL) return def; /* not reached: every pipe comes from a run */
    memcpy(&def, &run->def, sizeof def);
    def.struct_size = 0;
    def.kind = sim->scene->pipes[sim->scene->strings[string].first_pipe + pipe].kind; /* as compiled */
    def.seed = 0;
    memset(def.name, 0, sizeof def.name);
    def.string.index = def.string.generation = 0;
    return def;
}

static int32_t other_pipe(dmb_sim *sim, uint32_t string, uint32_t to, uint32_t old, const char *what)
{
    dmb_message name;
    dmb_message_set(&sim->message, "state transfer: %s: %s, must be as of pipe %u of the sim it continues",
                    dmb_model_pipe_text(sim->model, string, to, &name), what, old);
    return DMB_ERR_VALUE;
}

static uint32_t elements_of(const dmb_sim *sim, uint32_t string, uint32_t pipe)
{
    return sim->scene->pipes[sim->scene->strings[string].first_pipe + pipe].elements;
}

/* Pipe k from the far end of both strings. */
static int32_t check_pipe(dmb_sim *sim, const dmb_sim *from, uint32_t string, uint32_t k)
{
    const uint32_t to = sim->scene->strings[string].pipe_count - 1 - k;
    const uint32_t old = from->scene->strings[string].pipe_count - 1 - k;
    const dmb_pipe_def a = material_of(sim, string, to), b = material_of(from, string, old);
    if (memcmp(&a, &b, sizeof a) == 0) {
        if (elements_of(sim, string, to) == elements_of(from, string, old)) return DMB_OK;
        return other_pipe(sim, string, to, old, "places of its rings");
    }
    if (a.kind != b.kind) return other_pipe(sim, string, to, old, "kind");
    if (a.elements != b.elements) return other_pipe(sim, string, to, old, "elements");
    if (a.length != b.length) return other_pipe(sim, string, to, old, "length");
    if (a.joint_length != b.joint_length) return other_pipe(sim, string, to, old, "joint_length");
    return other_pipe(sim, string, to, old, "section");
}

enum { TYPE_NUMBERS = 31 };

/* Numbers that identify an element type, including effects of environment and compile options. Arms may differ next to
 * rigid pipes. */
static void numbers_of(const dmb_element_type *type, double numbers[TYPE_NUMBERS])
{
    numbers[0] = type->length;
    numbers[1] = type->damping_time;
    numbers[2] = type->weight_mass;
    memcpy(numbers + 3, type->stiffness, 6 * sizeof *numbers);
    memcpy(numbers + 9, type->rest, 6 * sizeof *numbers);
    memcpy(numbers + 15, type->mass.axial, 2 * sizeof *numbers);
    memcpy(numbers + 17, type->mass.torsion, 2 * sizeof *numbers);
    memcpy(numbers + 19, type->mass.bending[0], 6 * sizeof *numbers);
    memcpy(numbers + 25, type->mass.bending[1], 6 * sizeof *numbers);
}

static int same_type(const dmb_element_type *a, const dmb_element_type *b)
{
    double of_a[TYPE_NUMBERS], of_b[TYPE_NUMBERS];
    numbers_of(a, of_a);
    numbers_of(b, of_b);
    return memcmp(of_a, of_b, sizeof of_a) == 0;
}

/* Compares types as described, without changes by density inputs. */
static int32_t check_elements(dmb_sim *sim, const dmb_scene *from, uint32_t string, const dmb_common_string *common)
{
    const dmb_scene *scene = sim->model->scene;
    for (uint32_t i = 0; i + 1 < common->nodes; i++) {
        const uint32_t a = scene->node_element[common->to + i], b = from->node_element[common->from + i];
        if (same_type(scene->types + scene->element_type[a], from->types + from->element_type[b])) continue;
        return other(sim, "string", string, "elements of its pipes (surroundings, options of the compile step)");
    }
    return DMB_OK;
}

/* Nodes must keep their kind (six-DOF or axial-torsional), and axial-torsional pipes their axis. */
static int32_t check_nodes(dmb_sim *sim, const dmb_scene *from, uint32_t string, const dmb_common_string *common)
{
    const uint8_t *size = sim->scene->layout.size, *old = from->layout.size;
    int same = memcmp(size + common->to, old + common->from, common->nodes) == 0;
    for (uint32_t i = sim->scene->strings[string].first_node; i < common->to; i++)
        same = same && size[i] == size[common->to];
    if (same) return DMB_OK;
    dmb_message name;
    dmb_message_set(&sim->message,
                    "state transfer: %s: axial-torsional pipes at the rig end are added to and taken "
                    "from such pipes only",
                    dmb_string_text(sim->scene, string, &name));
    return DMB_ERR_VALUE;
}

static int32_t check_string(dmb_sim *sim, const dmb_sim *from, uint32_t string)
{
    const dmb_common_string common = dmb_common_string_of(sim->scene, from->scene, string);
    int32_t status = DMB_OK;
    for (uint32_t k = 0; k < common.pipes && status >= 0; k++) status = check_pipe(sim, from, string, k);
    if (status >= 0) status = check_nodes(sim, from->scene, string, &common);
    return status >= 0 ? check_elements(sim, from->model->scene, string, &common) : status;
}

int32_t dmb_state_transfer_check(dmb_sim *sim, const dmb_sim *from)
{
    int32_t status = check_counts(sim, from);
    if (status >= 0) status = check_bodies(sim, from);
    if (status >= 0) status = check_bits(sim, from);
    if (status >= 0) status = check_drives(sim, from);
    if (status >= 0) status = check_loads(sim, from);
    if (status >= 0) status = check_forces(sim, from);
    if (status >= 0) status = check_inputs(sim, from);
    if (status >= 0) status = check_events(sim, from);
    if (status >= 0) status = check_joints(sim, from);
    if (status >= 0) status = check_links(sim, from);
    if (status >= 0) status = check_wall(sim, from);
    for (uint32_t s = 0; s < sim->scene->string_count && status >= 0; s++) status = check_string(sim, from, s);
    return status >= 0 ? check_features(sim, from) : status;
}
