#include <math.h>
#include <string.h>

#include "analysis/linear/linear.h"
#include "analysis/response/response.h"
#include "base/memory.h"
#include "base/sized_struct.h"
#include "base/value_check.h"
#include "drillmbd/response.h"
#include "math/so3.h"
#include "sim/access.h"
#include "sim/node.h"
#include "system/assemble/actuators.h"
#include "system/system.h"

dmb_response *dmb_response_new(const dmb_allocator *allocator, uint32_t excitations, uint32_t outputs)
{
    dmb_response *response = dmb_allocate(allocator, sizeof *response);
    if (response == NULL) return NULL;
    response->magic = DMB_HANDLE_RESPONSE;
    response->excitations = excitations;
    response->outputs = outputs;
    response->allocator = *allocator;
    response->block_size = 2 * (size_t)excitations * sizeof(double);
    response->block = dmb_allocate(allocator, response->block_size);
    if (response->block == NULL) dmb_response_destroy(&response);
    if (response == NULL) return NULL;
    response->amplitude = response->block;
    response->phase = response->amplitude + excitations;
    return response;
}

/* At most 1e6 points and what refinement adds, 1024 excitations and outputs: below 2^63 bytes. */
int32_t dmb_response_resize(dmb_response *response, uint32_t points)
{
    const uint64_t numbers = (uint64_t)points * (1 + 2 * (uint64_t)response->excitations * response->outputs);
    if (numbers > SIZE_MAX / sizeof(double)) return DMB_ERR_NO_MEMORY;
    const size_t size = (size_t)numbers * sizeof(double);
    double *table = dmb_allocate(&response->allocator, size);
    if (table == NULL) return DMB_ERR_NO_MEMORY;
    response->table = table;
    response->table_size = size;
    response->points = points;
    response->frequency = table;
    response->value = table + points;
    return DMB_OK;
}

void dmb_response_destroy(dmb_response **response)
{
    if (response == NULL) return;
    dmb_response *found = *response;
    *response = NULL;
    if (!dmb_handle_is(found, DMB_HANDLE_RESPONSE)) return;
    const dmb_allocator allocator = found->allocator;
    found->magic = DMB_HANDLE_DEAD;
    if (found->table != NULL) dmb_release(&allocator, found->table, found->table_size);
    if (found->block != NULL) dmb_release(&allocator, found->block, found->block_size);
    dmb_release(&allocator, found, sizeof *found);
}

/* ---- Questions --------------------------------------------------------------------------------------------------- */

static int32_t ask(const dmb_response *response, const void *answer)
{
    if (response == NULL) return DMB_ERR_NULL;
    if (!dmb_handle_is(response, DMB_HANDLE_RESPONSE)) return DMB_ERR_HANDLE;
    return answer != NULL ? DMB_OK : DMB_ERR_NULL;
}

int32_t dmb_response_dimensions(const dmb_response *response, uint32_t dimensions[3])
{
    const int32_t status = ask(response, dimensions);
    if (status < 0) return status;
    dimensions[0] = response->points;
    dimensions[1] = response->excitations;
    dimensions[2] = response->outputs;
    return DMB_OK;
}

int32_t dmb_response_frequencies(const dmb_response *response, double *frequencies)
{
    const int32_t status = ask(response, frequencies);
    if (status == DMB_OK) memcpy(frequencies, response->frequency, response->points * sizeof(double));
    return status;
}

/* to += amplitude e^(i phase) value */
static void add_input(const dmb_response *response, size_t point, uint32_t input, uint32_t output, double to[2])
{
    const double *value = dmb_response_value(response, point, input) + 2 * (size_t)output;
    const double re = response->amplitude[input] * cos(response->phase[input]);
    const double im = response->amplitude[input] * sin(response->phase[input]);
    to[0] += re * value[0] - im * value[1];
    to[1] += re * value[1] + im * value[0];
}

void dmb_response_combined(const dmb_response *response, size_t point, uint32_t output, double value[2])
{
    value[0] = value[1] = 0.0;
    for (uint32_t i = 0; i < response->excitations; i++) add_input(response, point, i, output, value);
}

int32_t dmb_response_transfer(const dmb_response *response, uint32_t input, uint32_t output, double *values)
{
    const int32_t status = ask(response, values);
    if (status < 0) return status;
    if (output >= response->outputs || (input >= response->excitations && input != DMB_COMBINED)) return DMB_ERR_VALUE;
    for (size_t point = 0; point < response->points; point++) {
        double *to = values + 2 * point;
        if (input != DMB_COMBINED)
            memcpy(to, dmb_response_value(response, point, input) + 2 * (size_t)output, 2 * sizeof(double));
        else
            dmb_response_combined(response, point, output, to);
    }
    return DMB_OK;
}

/* Frequency response: prepares what shakes and what is asked, solves at each frequency, refines at peaks. */

typedef struct response_work {
    dmb_sim *sim; /* for its message */
    dmb_response_options options;
    dmb_linear *linear;
    dmb_linear_turned turned;
    dmb_dynamic_stiffness stiffness;
    dmb_linear_excitation *excitations;
    dmb_linear_output *outputs;
    uint32_t excitation_count, output_count;
    dmb_complex_array x, f; /* displacements, and the forces that lead to them, shape (rows) */
    void *block;
    size_t block_size;
} response_work;

/* ---- Preparation ------------------------------------------------------------------------------------------------- */

static void lay_out(dmb_arena *arena, response_work *w)
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

static int32_t take_memory(response_work *w)
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

static int32_t check_balance(const response_work *w)
{
    const dmb_linear *linear = w->linear;
    if (linear->balanced || linear->relative_residual <= w->options.equilibrium_tolerance) return DMB_OK;
    const dmb_owner owner = dmb_owner_of_node(&linear->scene, linear->largest_node);
    dmb_message_set(&w->sim->message,
                    "state: not an equilibrium, %g of the forces that balance is left (up to %g N at %s), "
                    "must be <= %g",
                    linear->relative_residual, linear->largest_force, owner.text.text,
                    w->options.equilibrium_tolerance);
    return DMB_ERR_VALUE;
}

static int32_t linearise(response_work *w)
{
    const dmb_linear_options options = {.contact = w->options.contact,
                                        .no_friction = !w->options.friction,
                                        .gap = w->options.contact_gap,
                                        .still = w->options.axes == DMB_RESPONSE_AXES_AT_REST,
                                        .spin = w->options.spin};
    int32_t status = dmb_linear_make(w->sim, &options, &w->linear);
    if (status == DMB_OK) status = check_balance(w);
    if (status >= 0) status = dmb_linear_turn_on(w->linear, w->sim, &options, &w->turned);
    if (status < 0) return status;
    w->linear->work->magic = DMB_HANDLE_SIM; /* so that it answers queries */
    return dmb_dynamic_stiffness_make(w->linear, w->options.structural_damping, &w->stiffness);
}

static int32_t take_inputs(response_work *w, const dmb_excitation *excitations, dmb_response *response)
{
    int32_t status = DMB_OK;
    for (uint32_t i = 0; i < w->excitation_count && status >= 0; i++) {
        dmb_excitation input;
        status = dmb_input_take(excitations, i, &w->sim->message, &input);
        if (status < 0) return status;
        response->amplitude[i] = input.amplitude;
        response->phase[i] = input.phase;
        status = dmb_excitation_of(w->linear, &input, i, &w->sim->message, w->excitations + i);
    }
    return status;
}

static int32_t take_outputs(response_work *w, const dmb_response_output *outputs)
{
    for (uint32_t i = 0; i < w->output_count; i++) {
        dmb_response_output output;
        int32_t status = dmb_output_take(outputs, i, &w->sim->message, &output);
        if (status < 0) return status;
        status = dmb_linear_output_of(w->linear, &w->options, &output, i, &w->sim->message, w->outputs + i);
        if (status < 0) return status;
    }
    return DMB_OK;
}

/* ---- One frequency ----------------------------------------------------------------------------------------------- */

static int32_t no_displacement(const response_work *w, uint32_t input)
{
    dmb_message_set(&w->sim->message, "excitation %u: at frequency 0 a speed has no displacement to respond to", input);
    return DMB_ERR_SINGULAR;
}

/* Right-hand side of an input into x: forces, which are f too, or displacements that a drive asks for. */
static int32_t load(response_work *w, uint32_t input, double omega)
{
    const dmb_linear_excitation *e = w->excitations + input;
    const uint32_t rows = w->linear->rows;
    double re = 1.0, im = 0.0;
    if (e->law == DMB_EXCITE_INERTIA) re = omega * omega;
    if (e->law == DMB_EXCITE_CONTROL) re = e->gain, im = e->integral_gain == 0.0 ? 0.0 : -e->integral_gain / omega;
    if (e->law == DMB_EXCITE_MOTION) re = 0.0, im = -1.0 / omega;
    if (!isfinite(im)) return no_displacement(w, input);
    for (uint32_t r = 0; r < rows; r++) {
        w->x.re[r] = re * e->re[r] - im * e->im[r];
        w->x.im[r] = re * e->im[r] + im * e->re[r];
        w->f.re[r] = e->law == DMB_EXCITE_MOTION ? 0.0 : w->x.re[r];
        w->f.im[r] = e->law == DMB_EXCITE_MOTION ? 0.0 : w->x.im[r];
    }
    return DMB_OK;
}

static int32_t nothing_holds(const response_work *w, double frequency, uint32_t node)
{
    const dmb_owner owner = dmb_owner_of_node(&w->linear->scene, node);
    dmb_message_set(&w->sim->message,
                    "frequency %g Hz: %s: nothing holds it there, the dynamic stiffness is "
                    "singular",
                    frequency, owner.text.text);
    return DMB_ERR_SINGULAR;
}

static int32_t solve_point(response_work *w, dmb_response *response, uint32_t point)
{
    const double frequency = response->frequency[point], omega = DMB_TWO_PI * frequency, s[2] = {0.0, omega};
    const int32_t told = dmb_progress_pulse(w->sim);
    if (told < 0) return told;
    const int64_t bad = dmb_dynamic_stiffness_factor(&w->stiffness, omega);
    if (bad >= 0) return nothing_holds(w, frequency, (uint32_t)bad);
    for (uint32_t i = 0; i < w->excitation_count; i++) {
        const int32_t status = load(w, i, omega);
        if (status < 0) return status;
        dmb_dynamic_stiffness_solve(&w->stiffness, w->excitations[i].law == DMB_EXCITE_MOTION, w->x);
        (void)dmb_linear_change_of(&w->turned, w->linear, s, w->x.re, w->x.im);
        double *value = dmb_response_value(response, point, i);
        for (uint32_t k = 0; k < w->output_count; k++) {
            const dmb_complex_number found =
                dmb_response_output_value(&w->stiffness, w->outputs + k, w->excitations + i, w->x, w->f);
            value[2 * (size_t)k] = found.re;
            value[2 * (size_t)k + 1] = found.im;
        }
    }
    return DMB_OK;
}

/* ---- All of them ------------------------------------------------------------------------------------------------- */

static int32_t solve_grid(response_work *w, dmb_response *response)
{
    int32_t status = dmb_response_resize(response, w->options.points);
    for (uint32_t i = 0; i < w->options.points && status >= 0; i++) {
        dmb_progress_at(w->sim, (double)i / w->options.points / (1.0 + w->options.refinement));
        response->frequency[i] = dmb_response_grid(&w->options, i);
        status = solve_point(w, response, i);
    }
    return status;
}

/* Halves the intervals beside each peak; new points are marked by the frequencies alone until they are solved. */
static int32_t refine(response_work *w, dmb_response *response)
{
    uint8_t *fresh = NULL;
    uint32_t before = response->points;
    int32_t status = dmb_response_split_peaks(response, &fresh);
    const uint32_t points = response->points;
    for (uint32_t i = 0; fresh != NULL && i < points && status >= 0; i++)
        if (fresh[i]) status = solve_point(w, response, i);
    if (fresh != NULL) dmb_release(&response->allocator, fresh, points);
    return status >= 0 && points == before ? DMB_NOTE_STOPPED : status;
}

static int32_t respond(response_work *w, const dmb_excitation *excitations, const dmb_response_output *outputs,
                       dmb_response *response)
{
    int32_t status = take_memory(w);
    if (status >= 0) status = linearise(w);
    if (status >= 0)
        response->undamped = !(w->options.structural_damping > 0.0) && dmb_linear_is_undamped(w->linear, w->x.re);
    if (status >= 0) status = take_inputs(w, excitations, response);
    if (status >= 0) status = take_outputs(w, outputs);
    if (status >= 0) status = solve_grid(w, response);
    for (uint32_t k = 0; k < w->options.refinement && status == DMB_OK; k++) {
        dmb_progress_at(w->sim, (1.0 + k) / (1.0 + w->options.refinement));
        status = refine(w, response);
    }
    return status;
}

/* Tells what the answers leave out. */
static int32_t note_left_out(const response_work *w)
{
    const int32_t status = dmb_linear_note_coefficients(w->linear, "response", &w->sim->message);
    if (status != DMB_OK) return status;
    const char *const then = "what that changes is left out; take the other axes, or a stepped sine";
    return dmb_linear_check_change(&w->turned, "response", then, &w->sim->message) < 0 ? DMB_NOTE_INCOMPLETE : DMB_OK;
}

static void release(response_work *w)
{
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

static int32_t analyse(response_work *w, const dmb_response_options *options, const dmb_excitation *excitations,
                       const dmb_response_output *outputs, dmb_response **response)
{
    dmb_sim *sim = w->sim;
    int32_t status = dmb_response_options_take(options, &sim->message, &w->options);
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
                              uint32_t excitation_count, const dmb_response_output *outputs, uint32_t output_count,
                              dmb_response **response)
{
    if (response == NULL) return DMB_ERR_NULL;
    *response = NULL;
    if (sim == NULL || excitations == NULL || outputs == NULL) return DMB_ERR_NULL;
    const int32_t status = dmb_sim_enter(sim, DMB_BUSY_READABLE);
    if (status < 0) return status;
    response_work w;
    memset(&w, 0, sizeof w);
    w.sim = sim;
    w.excitation_count = excitation_count;
    w.output_count = output_count;
    return dmb_sim_leave(sim, analyse(&w, options, excitations, outputs, response));
}
