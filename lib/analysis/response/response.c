/* Frequency response (eq:response.direct): d(w) = (K (1 + i eta) + i w C - w^2 M)^-1 f(w) for each excitation of unit
 * amplitude. Order:
 *
 *     linearise                  once about the state, an equilibrium within the tolerance
 *     read_inputs, read_outputs  f(w) by its law of w, outputs as linear functions of d
 *     solve_grid                 DMB_FREQUENCIES points at a time in lanes, SIDES excitations on shared factors
 *     refine                     up to `refinement` times: intervals beside peaks are halved, new points solved
 *
 * Refinement ends early if no interval is divided (DMB_NOTE_STOPPED). Effects that the response neglects are noted,
 * also those found while it was computed (note_left_out). After an error no response exists; the sim is never
 * changed. */
#include <math.h>
#include <string.h>

#include "analysis/linear/linear.h"
#include "analysis/response/response.h"
#include "base/memory.h"
#include "base/sized_struct.h"
#include "base/value_check.h"
#include "drillmbd/analyse.h"
#include "sim/access.h"
#include "sim/node.h"
#include "system/assemble/actuators.h"
#include "system/system.h"

/* Largest number of right-hand sides solved together, which share the cost of factors. */
enum { SIDES = 16 };

/* ---- Preparation ------------------------------------------------------------------------------------------------- */

static void lay_out(dmb_arena *arena, dmb_response_work *w)
{
    const uint32_t rows = w->sim->scene->row_count;
    w->excitations = DMB_ARENA_ARRAY(arena, dmb_linear_excitation, w->excitation_count);
    w->outputs = DMB_ARENA_ARRAY(arena, dmb_linear_output, w->output_count);
    double *numbers = DMB_ARENA_DOUBLES(arena, 2 * (size_t)rows * (w->excitation_count + 2u));
    if (numbers == NULL) return;
    w->x.re = numbers;
    w->x.im = numbers + rows;
    w->f.re = numbers + 2 * (size_t)rows;
    w->f.im = numbers + 3 * (size_t)rows;
    for (uint32_t i = 0; i < w->excitation_count; i++) {
        w->excitations[i].re = numbers + 2 * (size_t)rows * (i + 2u);
        w->excitations[i].im = w->excitations[i].re + rows;
    }
}

static int32_t allocate_memory(dmb_response_work *w)
{
    dmb_arena arena;
    dmb_arena_count(&arena);
    lay_out(&arena, w);
    w->block_size = dmb_arena_block_size(&arena);
    w->block = dmb_allocate(&w->sim->allocator, w->block_size);
    if (w->block == NULL) return DMB_ERR_NO_MEMORY;
    dmb_arena_place(&arena, w->block, w->block_size);
    lay_out(&arena, w);
    return DMB_OK;
}

/* A response superposes small motions on a state at rest; forces that do not balance would be missing from it. */
static int32_t check_balance(const dmb_response_work *w)
{
    const dmb_linear *linear = w->linear;
    if (linear->balanced || linear->relative_residual <= w->options.equilibrium_tolerance) return DMB_OK;
    const dmb_owner owner = dmb_owner_of_node(&linear->scene, linear->largest_node);
    dmb_message_set(
        &w->sim->message,
        "state: not an equilibrium, %g of the forces that balance is left (up to %g N at %s), "
        "must be <= %g; begin with dmb_analysis_static, after one with a slip with friction = 1, or allow a "
        "larger equilibrium_tolerance",
        linear->relative_residual, linear->largest_force, owner.text.text, w->options.equilibrium_tolerance);
    return DMB_ERR_VALUE;
}

static int32_t linearise(dmb_response_work *w)
{
    const dmb_linear_options options = {.contact = w->options.contact,
                                        .no_friction = !w->options.friction,
                                        .gap = w->options.contact_gap,
                                        .inertial_axes = w->options.axes == DMB_RESPONSE_AXES_AT_REST,
                                        .spin = w->options.spin};
    int32_t status = dmb_linear_make(w->sim, &options, &w->linear);
    if (status >= 0) status = check_balance(w);
    if (status >= 0) status = dmb_linear_turn_on(w->linear, w->sim, &options, &w->turned);
    if (status < 0) return status;
    w->linear->work->magic = DMB_HANDLE_SIM; /* permits queries on the copy */
    status = dmb_dynamic_stiffness_make(w->linear, w->options.structural_damping, &w->stiffness);
    if (status < 0) return status;
    return dmb_dynamic_group_make(&w->stiffness, w->excitation_count < SIDES ? w->excitation_count : SIDES, &w->group);
}

static int32_t read_inputs(dmb_response_work *w, const dmb_excitation *excitations, dmb_response *response)
{
    int32_t status = DMB_OK;
    for (uint32_t i = 0; i < w->excitation_count && status >= 0; i++) {
        dmb_excitation input;
        status = dmb_input_get(excitations, i, &w->sim->message, &input);
        if (status < 0) return status;
        response->amplitude[i] = input.amplitude;
        response->phase[i] = input.phase;
        status = dmb_excitation_of(w->linear, &input, i, &w->sim->message, w->excitations + i);
    }
    return status;
}

static int32_t read_outputs(dmb_response_work *w, const dmb_output *outputs)
{
    for (uint32_t i = 0; i < w->output_count; i++) {
        const int32_t status =
            dmb_linear_output_of(w->linear, &w->options, outputs + i, i, &w->sim->message, w->outputs + i);
        if (status < 0) return status;
        w->needs_forces |= w->outputs[i].support_count > 0 || w->outputs[i].cluster != DMB_NONE;
    }
    return DMB_OK;
}

/* ---- All of them ------------------------------------------------------------------------------------------------- */

static int32_t solve_grid(dmb_response_work *w, dmb_response *response)
{
    int32_t status = dmb_response_resize(response, w->options.points);
    for (uint32_t i = 0; i < w->options.points && status >= 0; i++)
        response->frequency[i] = dmb_response_grid(&w->options, i);
    for (uint32_t i = 0; i < w->options.points && status >= 0; i += DMB_FREQUENCIES) {
        dmb_response_points points = {.count = 0};
        for (uint32_t k = i; k < i + DMB_FREQUENCIES && k < w->options.points; k++) points.point[points.count++] = k;
        dmb_progress_at(w->sim, (double)i / w->options.points / (1.0 + w->options.refinement));
        status = dmb_response_solve(w, response, &points);
    }
    return status;
}

/* Halves the intervals beside each peak; new points have a frequency only until they are solved. */
static int32_t refine(dmb_response_work *w, dmb_response *response)
{
    uint8_t *fresh = NULL;
    uint32_t before = response->points;
    int32_t status = dmb_response_split_peaks(response, &fresh);
    const uint32_t all = response->points;
    dmb_response_points points = {.count = 0};
    for (uint32_t i = 0; fresh != NULL && i < all && status >= 0; i++) {
        if (fresh[i]) points.point[points.count++] = i;
        if (points.count < DMB_FREQUENCIES && i + 1 < all) continue;
        status = dmb_response_solve(w, response, &points);
        points.count = 0;
    }
    if (fresh != NULL) dmb_release(&response->allocator, fresh, all);
    return status >= 0 && all == before ? DMB_NOTE_STOPPED : status;
}

/* An undamped scene without structural damping has no finite height at a resonance: `undamped` reports it. */
static int32_t respond(dmb_response_work *w, const dmb_excitation *excitations, const dmb_output *outputs,
                       dmb_response *response)
{
    int32_t status = allocate_memory(w);
    if (status >= 0) status = linearise(w);
    if (status >= 0)
        response->undamped = !(w->options.structural_damping > 0.0) && dmb_linear_is_undamped(w->linear, w->x.re);
    if (status >= 0) status = read_inputs(w, excitations, response);
    if (status >= 0) status = read_outputs(w, outputs);
    if (status >= 0) memcpy(response->output, outputs, w->output_count * sizeof *outputs);
    if (status >= 0) status = solve_grid(w, response);
    for (uint32_t k = 0; k < w->options.refinement && status == DMB_OK; k++) {
        dmb_progress_at(w->sim, (1.0 + k) / (1.0 + w->options.refinement));
        status = refine(w, response);
    }
    return status;
}

/* Reports the effects that the response neglects. */
static int32_t note_left_out(const dmb_response_work *w)
{
    const int32_t status = dmb_linear_note_coefficients(w->linear, "response", &w->sim->message);
    if (status != DMB_OK) return status;
    const char *const then = "what that changes is left out; take the other axes, or a stepped sine";
    return dmb_linear_check_change(&w->turned, "response", then, &w->sim->message) < 0 ? DMB_NOTE_INCOMPLETE : DMB_OK;
}

static void release(dmb_response_work *w)
{
    dmb_dynamic_group_release(&w->group);
    if (w->linear != NULL) dmb_linear_turned_release(&w->turned, &w->linear->allocator);
    dmb_dynamic_stiffness_release(&w->stiffness);
    dmb_linear_release(&w->linear);
    if (w->block != NULL) dmb_release(&w->sim->allocator, w->block, w->block_size);
}

static int32_t check_counts(dmb_sim *sim, uint32_t excitations, uint32_t outputs)
{
    dmb_check check = dmb_check_of(&sim->message, "response", DMB_NONE);
    dmb_check_count(&check, "excitation_count", excitations, 1, DMB_RESPONSE_INPUTS_MAX);
    dmb_check_count(&check, "output_count", outputs, 1, DMB_RESPONSE_INPUTS_MAX);
    return check.status;
}

static int32_t analyse(dmb_response_work *w, const dmb_response_options *options, const dmb_excitation *excitations,
                       const dmb_output *outputs, dmb_response **response)
{
    dmb_sim *sim = w->sim;
    int32_t status = dmb_response_options_get(options, &sim->message, &w->options);
    if (status >= 0) status = check_counts(sim, w->excitation_count, w->output_count);
    if (status >= 0) status = dmb_state_copy_check(sim, "response");
    if (status >= 0) status = dmb_actuators_check_linear(sim, "response", 1, &sim->message);
    if (status < 0) return status;
    dmb_response *made = dmb_response_new(&sim->allocator, w->excitation_count, w->output_count);
    status = made != NULL ? respond(w, excitations, outputs, made) : DMB_ERR_NO_MEMORY;
    if (status >= 0) status = note_left_out(w);
    release(w);
    if (status == DMB_ERR_NO_MEMORY) dmb_message_set(&sim->message, "response: no memory");
    if (status < 0)
        dmb_response_destroy(&made);
    else
        *response = made;
    return status;
}

int32_t dmb_analysis_response(dmb_sim *sim, const dmb_response_options *options, const dmb_excitation *excitations,
                              uint32_t excitation_count, const dmb_output *outputs, uint32_t output_count,
                              dmb_response **response)
{
    if (response == NULL) return dmb_sim_failed(sim, "response", DMB_ERR_NULL);
    *response = NULL;
    if (sim == NULL || excitations == NULL || outputs == NULL) return dmb_sim_failed(sim, "response", DMB_ERR_NULL);
    const int32_t status = dmb_sim_enter(sim, DMB_BUSY_READABLE);
    if (status < 0) return status;
    dmb_response_work w;
    memset(&w, 0, sizeof w);
    w.sim = sim;
    w.excitation_count = excitation_count;
    w.output_count = output_count;
    return dmb_sim_leave(sim, analyse(&w, options, excitations, outputs, response));
}
