/* Creation and destruction of sensitivities: checks of the parameters, and initial rates (eq:sensitivity.step).
 *
 * A parameter is a pair of sims, low and high, whose models differ in numbers only. The difference quotient compares
 * the same entries of their states, and companion steps use the factors, breakpoints and partition of the sim.
 * Therefore a side is refused, with the first that applies, unless it has
 *
 *     same_make       equal nodes, elements, solved rows, drives, constraints, targets of inputs and laws
 *     same_corners    equal breakpoints of time functions: all sides end their steps there
 *     time            the time of the sim
 *     same_inputs     the same inputs and drives set, the same joints locked or open, the same points stuck
 *     arrived inputs  no input on its way to a set point
 *
 * After an error no handle exists and the sims are unchanged; afterwards only the models of the sides are kept, by
 * reference. */
#include <math.h>
#include <string.h>

#include "analysis/sensitivity/sensitivity.h"
#include "base/memory.h"
#include "base/value_check.h"
#include "force/reference.h"
#include "sim/access.h"
#include "sim/own_scene.h"
#include "system/system.h"

DMB_DEFINE_INIT(dmb_parameter, 56, {.step = 0.0})

enum { PARAMETERS_MAX = 4096 };

static int32_t refuse(dmb_sim *sim, uint32_t number, const dmb_parameter *p, int32_t status, const char *why)
{
    dmb_message_set(&sim->message, "sensitivity: parameter %u (%s): %s", number, p->name, why);
    return status;
}

static int same_arrays(const dmb_sim *a, const dmb_sim *b)
{
    dmb_state_fields first, second;
    dmb_state_fields_of(a, DMB_GROUP_NOW, &first);
    dmb_state_fields_of(b, DMB_GROUP_NOW, &second);
    for (size_t i = 0; i < first.count; i++)
        if (first.field[i].bytes != second.field[i].bytes) return 0;
    return first.count == second.count;
}

/* 1: equal targets of inputs, and equal numbers of the parts that inputs may change. */
static int same_settable(const dmb_scene *a, const dmb_scene *b)
{
    if (a->input_count != b->input_count) return 0;
    if (a->input_count == 0) return 1;
    for (uint32_t i = 0; i < a->input_count; i++)
        if (a->inputs[i].target != b->inputs[i].target || a->inputs[i].index != b->inputs[i].index) return 0;
    return a->load_count == b->load_count && a->bit_count == b->bit_count && a->type_count == b->type_count;
}

/* 1: joints of equal kinds, and equal parts that constrain the same nodes by equal numbers of rows. */
static int same_constraints(const dmb_scene *a, const dmb_scene *b)
{
    if (a->constraint_count != b->constraint_count || a->joint_count != b->joint_count) return 0;
    for (uint32_t i = 0; i < a->joint_count; i++)
        if (a->joints[i].kind != b->joints[i].kind) return 0;
    for (uint32_t i = 0; i < a->constraint_count; i++) {
        const dmb_constraint *first = a->constraints + i, *second = b->constraints + i;
        if (first->kind != second->kind || first->index != second->index || first->rows != second->rows ||
            first->node_count != second->node_count)
            return 0;
        if (memcmp(first->node, second->node, first->node_count * sizeof *first->node) != 0) return 0;
    }
    return 1;
}

static int same_drives(const dmb_scene *a, const dmb_scene *b)
{
    if (a->drive_count != b->drive_count) return 0;
    for (uint32_t i = 0; i < a->drive_count; i++)
        if (a->drives[i].kind != b->drives[i].kind || a->drives[i].row != b->drives[i].row ||
            a->drives[i].joint != b->drives[i].joint || a->drives[i].component != b->drives[i].component)
            return 0;
    return 1;
}

/* 1: equal structure of the scenes. Chains follow from nodes and elements. */
static int same_make(const dmb_sim *a, const dmb_sim *b)
{
    const dmb_scene *first = a->scene, *second = b->scene;
    if (first == second) return 1;
    if (first->node_count != second->node_count || first->row_count != second->row_count ||
        first->element_count != second->element_count)
        return 0;
    if (memcmp(first->layout.size, second->layout.size, first->node_count * sizeof *first->layout.size) != 0) return 0;
    if (memcmp(first->solved_row, second->solved_row, first->row_count * sizeof *first->solved_row) != 0) return 0;
    if (!same_drives(first, second) || !same_constraints(first, second) || !same_settable(first, second)) return 0;
    return first->normal_law.kind == second->normal_law.kind && first->friction_law.kind == second->friction_law.kind &&
           same_arrays(a, b);
}

/* 1: equal breakpoints of two segments. A step ends at breakpoints of time functions, which the companion steps
 * share. */
static int same_times(const dmb_segment *a, const dmb_segment *b)
{
    if (a->kind != b->kind) return 0;
    if (a->kind == DMB_SEGMENT_STEP || a->kind == DMB_SEGMENT_STEP5) return a->x0 == b->x0 && a->x1 == b->x1;
    if (a->kind == DMB_SEGMENT_PER_REVOLUTION) return a->of.index == b->of.index;
    if (a->kind != DMB_SEGMENT_TABLE && a->kind != DMB_SEGMENT_PERIODIC) return 1;
    return a->table_count == b->table_count &&
           memcmp(a->table_time, b->table_time, a->table_count * sizeof *a->table_time) == 0;
}

static int same_corners(const dmb_scene *a, const dmb_scene *b)
{
    if (a->time_function_count != b->time_function_count) return 0;
    for (uint32_t i = 0; i < a->time_function_count; i++) {
        if (a->time_functions[i].count != b->time_functions[i].count) return 0;
        for (uint32_t k = 0; k < a->time_functions[i].count; k++)
            if (!same_times(a->time_functions[i].segments + k, b->time_functions[i].segments + k)) return 0;
    }
    return 1;
}

/* NaN is the input that was not set: it must be so in both. A stuck point is on or off: its value must be equal. */
static int same_inputs(const dmb_sim *a, const dmb_sim *b)
{
    for (uint32_t i = 0; i < a->scene->drive_count; i++)
        if (isnan(a->drive_input[i]) != isnan(b->drive_input[i])) return 0;
    for (uint32_t i = 0; i < a->scene->input_count; i++) {
        if (isnan(a->input_value[i]) != isnan(b->input_value[i])) return 0;
        if (a->scene->inputs[i].target == DMB_TARGET_STUCK && a->input_value[i] != b->input_value[i]) return 0;
    }
    for (uint32_t i = 0; i < a->scene->stuck_count; i++)
        if (a->stuck_held[i] != b->stuck_held[i]) return 0;
    return a->scene->joint_count == 0 ||
           memcmp(a->joint_state, b->joint_state, a->scene->joint_count * sizeof *a->joint_state) == 0;
}

/* Index of the first input that has not reached its setting; DMB_NONE: none. */
static uint32_t input_on_its_way(const dmb_sim *sim)
{
    for (uint32_t i = 0; i < sim->scene->input_count; i++)
        if (!isnan(sim->input_value[i]) && dmb_reference_arrival(&sim->own->references[i]) > sim->clock->time) return i;
    return DMB_NONE;
}

static int32_t check_side(dmb_sim *sim, uint32_t number, const dmb_parameter *p, const dmb_sim *side, const char *name)
{
    dmb_message text;
    if (side == NULL || !dmb_handle_is(side, DMB_HANDLE_SIM)) {
        dmb_message_set(&text, "%s is no live sim", name);
        return refuse(sim, number, p, side == NULL ? DMB_ERR_NULL : DMB_ERR_HANDLE, text.text);
    }
    if (!same_make(sim, side)) {
        dmb_message_set(&text, "%s is a scene of other parts, supports, meshes or laws; only numbers may differ", name);
        return refuse(sim, number, p, DMB_ERR_VALUE, text.text);
    }
    if (!same_corners(sim->scene, side->scene)) {
        dmb_message_set(
            &text, "%s has time functions with other terms or times: steps end there; only values may differ", name);
        return refuse(sim, number, p, DMB_ERR_UNSUPPORTED, text.text);
    }
    if (side->clock->time != sim->clock->time) {
        dmb_message_set(&text, "%s stands at time %g s, must be %g s as the sim", name, side->clock->time,
                        sim->clock->time);
        return refuse(sim, number, p, DMB_ERR_VALUE, text.text);
    }
    if (!same_inputs(sim, side)) {
        dmb_message_set(&text,
                        "%s has other joints locked or open, other places stuck, or other drives or inputs set by the "
                        "caller",
                        name);
        return refuse(sim, number, p, DMB_ERR_VALUE, text.text);
    }
    const uint32_t input = input_on_its_way(side);
    if (input == DMB_NONE) return DMB_OK;
    dmb_message_set(&text, "%s has input %u (%s) still changing towards its set point; run until it arrives", name,
                    input, side->scene->inputs[input].name);
    return refuse(sim, number, p, DMB_ERR_VALUE, text.text);
}

static int32_t check_parameters(dmb_sim *sim, const dmb_parameter *given, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        dmb_parameter p;
        const void *at = (const unsigned char *)given + (size_t)i * given->struct_size;
        int32_t status = dmb_parameter_read(&p, at);
        if (status < 0) {
            dmb_message_set(&sim->message, "sensitivity: parameter %u: struct_size is not one of this library", i);
            return status;
        }
        p.name[sizeof p.name - 1] = '\0';
        dmb_check check = dmb_check_of(&sim->message, "sensitivity parameter", i);
        dmb_check_choice(&check, "one_sided", p.one_sided, 0, 1);
        dmb_check_between(&check, "step", p.step, 0.0, 1e30);
        status = check.status;
        if (status >= 0) status = check_side(sim, i, &p, p.low, "low");
        if (status >= 0) status = check_side(sim, i, &p, p.high, "high");
        if (status < 0) return status;
    }
    return DMB_OK;
}

static int32_t check_count(dmb_sim *sim, uint32_t count)
{
    dmb_check check = dmb_check_of(&sim->message, "sensitivity", DMB_NONE);
    dmb_check_count(&check, "count", count, 1, PARAMETERS_MAX);
    return check.status;
}

static int32_t check_scene(dmb_sim *sim)
{
    if (sim->scene->cluster_count && sim->options.constraint_method == DMB_METHOD_MULTIPLIERS) {
        dmb_message_set(&sim->message, "sensitivity: constraint_method = DMB_METHOD_MULTIPLIERS in a scene with "
                                       "joints, must be DMB_METHOD_INDEPENDENT");
        return DMB_ERR_UNSUPPORTED;
    }
    const uint32_t input = input_on_its_way(sim);
    if (input != DMB_NONE) {
        dmb_message_set(&sim->message,
                        "sensitivity: input %u (%s) is still changing towards its set point; run until it arrives",
                        input, sim->scene->inputs[input].name);
        return DMB_ERR_VALUE;
    }
    if (sim->scene->delay_count) {
        dmb_message_set(&sim->message, "sensitivity: %u drives have an actuator with a delay, must be none; take a lag",
                        sim->scene->delay_count);
        return DMB_ERR_UNSUPPORTED;
    }
    if (sim->scene->hole.cuts > 0) {
        dmb_message_set(&sim->message,
                        "sensitivity: cutters widen the hole at %u stations, must be none: a derivative does not exist "
                        "where a cutter passes one; describe the wider hole by sections, with cut_spacing = 0",
                        sim->scene->hole.cuts);
        return DMB_ERR_UNSUPPORTED;
    }
    if (sim->scene->sparse_count) {
        dmb_message_set(&sim->message, "sensitivity: a cluster of joints is solved by sparse matrices; flexible pipes "
                                       "between joints divide a cluster");
        return DMB_ERR_TOO_LARGE;
    }
    return DMB_OK;
}

/* One block for the handle and all arrays; the first call, on a counting arena, has no memory and measures only. */
static dmb_sensitivity *lay_out(dmb_arena *arena, const dmb_sim *sim, uint32_t count, size_t numbers)
{
    dmb_sensitivity nothing, *made = dmb_arena_allocate(arena, 1, sizeof nothing, DMB_ALIGNMENT);
    dmb_sensitivity *s = made != NULL ? made : &nothing;
    s->parameters = DMB_ARENA_ARRAY(arena, dmb_rated_parameter, count);
    s->high = DMB_ARENA_DOUBLES(arena, numbers);
    s->low = DMB_ARENA_DOUBLES(arena, numbers);
    s->middle = DMB_ARENA_DOUBLES(arena, numbers);
    s->seen = DMB_ARENA_DOUBLES(arena, 3 * (size_t)sim->scene->node_count + 2 * (size_t)sim->scene->row_count);
    dmb_companion_workspace_allocate(arena, sim->scene, &s->workspace);
    s->settings = DMB_ARENA_DOUBLES(arena, sim->scene->input_count);
    for (uint32_t i = 0; i < count; i++) {
        double *rates = DMB_ARENA_DOUBLES(arena, numbers), *accepted = DMB_ARENA_DOUBLES(arena, numbers);
        if (made == NULL) continue;
        s->parameters[i].rates = rates;
        s->parameters[i].accepted = accepted;
    }
    return made;
}

static dmb_sensitivity *allocate(const dmb_sim *sim, uint32_t count)
{
    const size_t numbers = dmb_state_count(sim);
    dmb_arena arena;
    dmb_arena_count(&arena);
    (void)lay_out(&arena, sim, count, numbers);
    const size_t bytes = dmb_arena_block_size(&arena);
    void *block = dmb_allocate(&sim->allocator, bytes);
    if (block == NULL) return NULL;
    dmb_arena_place(&arena, block, bytes);
    dmb_sensitivity *made = lay_out(&arena, sim, count, numbers);
    made->numbers = numbers;
    made->count = count;
    made->bytes = bytes;
    made->allocator = sim->allocator;
    return made;
}

/* Changes signs of quaternions to match `as`: q and -q are the same rotation, but the rate between two sims that have
 * reached them in different ways would be q/step. */
static void align(const dmb_sim *sim, const double *as, double *quaternion)
{
    for (size_t i = 0; i < 4 * (size_t)sim->scene->node_count; i += 4) {
        double dot = 0.0;
        for (size_t k = 0; k < 4; k++) dot += as[i + k] * quaternion[i + k];
        for (size_t k = 0; k < 4 && dot < 0.0; k++) quaternion[i + k] = -quaternion[i + k];
    }
}

/* Initial rates dy0/dp = (high - low)/(2 step) of all numbers of the state: the two sims may be in different states,
 * for example the static equilibrium of each. */
static void read_parameter(dmb_sensitivity *s, const dmb_parameter *given, dmb_rated_parameter *p)
{
    const size_t quaternions = (size_t)(dmb_rates_of(s, p, s->sim->now.quaternion) - p->rates);
    double *low = s->low, *high = s->high;
    p->step = given->step;
    p->one_sided = given->one_sided;
    memcpy(p->name, given->name, sizeof p->name);
    p->name[sizeof p->name - 1] = '\0';
    p->model[DMB_SIDE_LOW] = given->low->model;
    p->model[DMB_SIDE_HIGH] = given->high->model;
    for (int side = DMB_SIDE_LOW; side <= DMB_SIDE_HIGH; side++) dmb_model_hold(p->model[side]);
    dmb_state_read(given->low, DMB_GROUP_NOW, low);
    dmb_state_read(given->high, DMB_GROUP_NOW, high);
    align(s->sim, low + quaternions, high + quaternions);
    for (size_t i = 0; i < s->numbers; i++) p->rates[i] = (high[i] - low[i]) / (2.0 * p->step);
    for (size_t i = 0; i < s->numbers; i++)
        if (isnan(p->rates[i])) p->rates[i] = 0.0; /* an unset input: all other numbers are finite */
}

/* All checks come before memory is reserved, and nothing fails after the worker exists. The worker keeps no ledger of
 * energy: companion steps are no part of a run. */
static int32_t create(dmb_sim *sim, const dmb_parameter *given, uint32_t count, dmb_sensitivity **out)
{
    int32_t status = check_count(sim, count);
    if (status >= 0) status = check_parameters(sim, given, count);
    if (status >= 0) status = check_scene(sim);
    if (status < 0) return status;
    dmb_sensitivity *made = allocate(sim, count);
    dmb_sim *worker = made != NULL ? dmb_state_copy(sim) : NULL;
    if (worker == NULL) {
        if (made != NULL) dmb_release(&sim->allocator, made, made->bytes);
        dmb_message_set(&sim->message, "sensitivity: no memory for %u parameters; ask for fewer", count);
        return DMB_ERR_NO_MEMORY;
    }
    made->sim = sim;
    made->worker = worker;
    if (sim->scene->input_count > 0)
        memcpy(made->settings, sim->input_value, sim->scene->input_count * sizeof *made->settings);
    worker->options.energy_ledger = 0;
    worker->progress = &worker->own_progress;
    for (uint32_t i = 0; i < count; i++) {
        dmb_parameter p = dmb_parameter_default();
        (void)dmb_parameter_read(&p, (const unsigned char *)given + (size_t)i * given->struct_size);
        read_parameter(made, &p, &made->parameters[i]);
    }
    made->follower.follow = dmb_sensitivity_companions;
    made->follower.open = dmb_sensitivity_note_opening;
    made->follower.context = made;
    made->magic = DMB_HANDLE_SENSITIVITY;
    dmb_sensitivity_settle(made, 0);
    dmb_sensitivity_read_sight(made, &sim->now);
    *out = made;
    return DMB_OK;
}

int32_t dmb_sensitivity_create(dmb_sim *sim, const dmb_parameter *parameters, uint32_t count,
                               dmb_sensitivity **sensitivity)
{
    if (sensitivity == NULL) return dmb_sim_failed(sim, "sensitivity", DMB_ERR_NULL);
    *sensitivity = NULL;
    if (sim == NULL || parameters == NULL) return dmb_sim_failed(sim, "sensitivity", DMB_ERR_NULL);
    const int32_t status = dmb_sim_enter(sim, DMB_BUSY_READABLE);
    return status < 0 ? status : dmb_sim_leave(sim, create(sim, parameters, count, sensitivity));
}

void dmb_sensitivity_destroy(dmb_sensitivity **sensitivity)
{
    if (sensitivity == NULL) return;
    dmb_sensitivity *found = *sensitivity;
    if (dmb_handle_is(found, DMB_HANDLE_SENSITIVITY)) {
        if (found->busy) return;
        const dmb_allocator allocator = found->allocator;
        found->magic = DMB_HANDLE_DEAD;
        for (uint32_t i = 0; i < found->count; i++)
            for (int side = DMB_SIDE_LOW; side <= DMB_SIDE_HIGH; side++)
                dmb_model_release(found->parameters[i].model[side]);
        dmb_state_discard(found->worker);
        dmb_release(&allocator, found, found->bytes);
    }
    *sensitivity = NULL;
}
