/* State-space analysis: options, linear system, inputs and outputs, memory, and queries of the result. Order of `run`:
 *
 *     linearise          M, C, K about the state, an equilibrium within the tolerance; the whole matrices and the
 *                        Jacobian by all rows, which are results of their own
 *     read_inputs        inputs as forces, motions or targets of controllers; each may add states (integrals)
 *     read_outputs       outputs as linear functions of the motion and the forces
 *     make_room          STATES_MAX is checked before memory is allocated
 *     make_basis, fill   X, then A, B, C, D (eq:response.state-space); not of DMB_STATE_MATRICES
 *
 * Coefficients that are not constant are neglected with DMB_NOTE_INCOMPLETE. After an error the result is released and
 * *space is NULL; the sim is never changed. */
#include "analysis/state_space/state_space.h"

#include <math.h>
#include <string.h>

#include "analysis/modes/modes.h"
#include "base/failure.h"
#include "base/memory.h"
#include "base/sized_struct.h"
#include "base/value_check.h"
#include "model/field_check.h"
#include "sim/access.h"
#include "sim/node.h"
#include "system/assemble/actuators.h"
#include "system/system.h"

DMB_DEFINE_INIT(dmb_state_space_info, 56, {.states = 0})

enum { STATES_MAX = 4096, INPUTS_MAX = 1024 };

/* ---- Options ----------------------------------------------------------------------------------------------------- */

static int32_t check_modes(dmb_sim *sim, const dmb_state_space_options *o)
{
    if (o->form != DMB_STATE_REDUCED) return DMB_OK;
    if (o->modes == NULL) {
        dmb_message_set(&sim->message, "state space options: modes = NULL, must be modes of this state to reduce to");
        return DMB_ERR_NULL;
    }
    if (dmb_handle_is(o->modes, DMB_HANDLE_MODES)) return DMB_OK;
    dmb_message_set(&sim->message, "state space options: modes is no live result of dmb_analysis_modes");
    return DMB_ERR_HANDLE;
}

static int32_t read_options(dmb_sim *sim, const dmb_state_space_options *given, uint32_t inputs, uint32_t outputs,
                            dmb_state_space_options *out)
{
    dmb_check check = dmb_check_of(&sim->message, "state space options", DMB_NONE);
    dmb_options_get(&check, DMB_OPTIONS_OF(dmb_state_space_options), given, out);
    const uint32_t most = out->form == DMB_STATE_MATRICES ? 0 : INPUTS_MAX;
    dmb_check_count(&check, "excitation_count", inputs, 0, most);
    dmb_check_count(&check, "output_count", outputs, 0, most);
    return check.status < 0 ? check.status : check_modes(sim, out);
}

/* ---- Preparation ------------------------------------------------------------------------------------------------- */

/* Forces that do not balance are absent from A: the linear system would describe motion about a state that does not
 * rest. Matrices alone are well defined at every state. */
static int32_t check_balance(const dmb_space_work *w)
{
    const dmb_linear *linear = w->linear;
    if (w->options.form == DMB_STATE_MATRICES || linear->balanced) return DMB_OK;
    if (linear->relative_residual <= w->options.equilibrium_tolerance) return DMB_OK;
    const dmb_owner owner = dmb_owner_of_node(&linear->scene, linear->largest_node);
    dmb_message_set(
        &w->sim->message,
        "state: not an equilibrium, %g of the forces that balance is left (up to %g N at %s), must be <= %g; "
        "begin with dmb_analysis_static, or ask for DMB_STATE_MATRICES",
        linear->relative_residual, linear->largest_force, owner.text.text, w->options.equilibrium_tolerance);
    return DMB_ERR_VALUE;
}

static dmb_linear_options how_to_linearise(const dmb_space_work *w)
{
    const dmb_linear_options options = {
        .contact = w->options.contact, .no_friction = !w->options.friction, .gap = w->options.contact_gap};
    return options;
}

static int32_t linearise(dmb_space_work *w)
{
    const dmb_linear_options options = how_to_linearise(w);
    int32_t status = dmb_linear_make(w->sim, &options, &w->linear);
    if (status >= 0) status = check_balance(w);
    if (status >= 0) status = dmb_whole_matrices(w->linear, &w->space->whole);
    if (status >= 0) status = dmb_whole_jacobian(w->linear, &w->space->jacobian);
    if (status < 0) return status;
    w->linear->work->magic = DMB_HANDLE_SIM; /* enables queries */
    return dmb_dynamic_stiffness_make(w->linear, 0.0, &w->stiffness);
}

static void lay_out_work(dmb_arena *arena, dmb_space_work *w)
{
    const size_t rows = w->linear->rows;
    w->inputs = DMB_ARENA_ARRAY(arena, dmb_linear_excitation, w->input_count);
    w->outputs = DMB_ARENA_ARRAY(arena, dmb_output_rows, w->output_count);
    w->input_state = DMB_ARENA_ARRAY(arena, uint32_t, w->input_count);
    w->work = DMB_ARENA_DOUBLES(arena, 8 * rows);
    for (uint32_t i = 0; i < w->input_count; i++) {
        double *re = DMB_ARENA_DOUBLES(arena, 2 * rows);
        if (re == NULL) continue;
        w->inputs[i].re = re;
        w->inputs[i].im = re + rows;
    }
    for (uint32_t i = 0; i < w->output_count; i++) {
        double *pose = DMB_ARENA_DOUBLES(arena, 4 * rows);
        if (pose == NULL) continue;
        w->outputs[i].pose = pose;
        w->outputs[i].speed = pose + rows;
        w->outputs[i].acceleration = pose + 2 * rows;
        w->outputs[i].force = pose + 3 * rows;
    }
}

static int32_t allocate_work(dmb_space_work *w)
{
    dmb_arena arena;
    dmb_arena_count(&arena);
    lay_out_work(&arena, w);
    w->block_size = dmb_arena_block_size(&arena);
    w->block = dmb_allocate(&w->sim->allocator, w->block_size);
    if (w->block == NULL) return DMB_ERR_NO_MEMORY;
    dmb_arena_place(&arena, w->block, w->block_size);
    lay_out_work(&arena, w);
    return DMB_OK;
}

/* An unbalance is refused, since its force grows with the square of the frequency: it is no constant column of B. */
static int32_t read_inputs(dmb_space_work *w, const dmb_excitation *inputs)
{
    for (uint32_t i = 0; i < w->input_count; i++) {
        dmb_excitation input;
        int32_t status = dmb_input_get(inputs, i, &w->sim->message, &input);
        if (status >= 0) status = dmb_excitation_of(w->linear, &input, i, &w->sim->message, w->inputs + i);
        if (status < 0) return status;
        if (w->inputs[i].law == DMB_EXCITE_INERTIA) {
            dmb_message_set(
                &w->sim->message,
                "excitation %u: kind = %d goes with the square of its frequency and is no excitation of a state space; "
                "ask dmb_analysis_response",
                i, (int)input.kind);
            return DMB_ERR_UNSUPPORTED;
        }
        w->space->info.input_states += dmb_space_states_of(w, w->inputs + i);
    }
    return DMB_OK;
}

/* ---- Memory of the result ---------------------------------------------------------------------------------------- */

static void lay_out_space(dmb_arena *arena, const dmb_space_work *w, size_t room, dmb_state_space *s)
{
    const dmb_linear *linear = w->linear;
    const size_t states = 2 * room + s->info.input_states, entries = linear->start[linear->rows];
    s->coordinate_start = DMB_ARENA_ARRAY(arena, uint32_t, linear->rows + 1);
    s->coordinate_column = DMB_ARENA_ARRAY(arena, uint32_t, entries);
    s->coordinate_value = DMB_ARENA_DOUBLES(arena, entries);
    s->shapes = DMB_ARENA_DOUBLES(arena, room * linear->rows);
    s->A = DMB_ARENA_DOUBLES(arena, states * states);
    s->B = DMB_ARENA_DOUBLES(arena, states * w->input_count);
    s->C = DMB_ARENA_DOUBLES(arena, states * w->output_count);
    s->D = DMB_ARENA_DOUBLES(arena, (size_t)w->output_count * w->input_count);
}

static int32_t allocate_space(dmb_space_work *w, size_t room)
{
    dmb_state_space *s = w->space;
    const dmb_linear *linear = w->linear;
    const size_t entries = linear->start[linear->rows];
    dmb_arena arena;
    dmb_arena_count(&arena);
    lay_out_space(&arena, w, room, s);
    s->block_size = dmb_arena_block_size(&arena);
    s->block = dmb_allocate(&s->allocator, s->block_size);
    if (s->block == NULL) return DMB_ERR_NO_MEMORY;
    dmb_arena_place(&arena, s->block, s->block_size);
    lay_out_space(&arena, w, room, s);
    memcpy(s->coordinate_start, linear->start, (linear->rows + 1) * sizeof(uint32_t));
    memcpy(s->coordinate_column, linear->column, entries * sizeof(uint32_t));
    memcpy(s->coordinate_value, linear->value, entries * sizeof(double));
    return DMB_OK;
}

static int32_t refuse_size(const dmb_space_work *w, uint64_t states)
{
    dmb_message_set(&w->sim->message,
                    "state space: %llu states, must be <= %d; reduce to modes (DMB_STATE_REDUCED), or take the sparse "
                    "matrices alone (DMB_STATE_MATRICES)",
                    (unsigned long long)states, (int)STATES_MAX);
    return DMB_ERR_TOO_LARGE;
}

/* The size is known before anything is computed: coordinates at most (dependent shapes leave room unused), and the
 * states of the inputs. */
static int32_t make_room(dmb_space_work *w)
{
    const uint64_t room = w->options.form == DMB_STATE_MATRICES ? 0 : dmb_space_basis_workspace(w);
    const uint64_t states = 2 * room + w->space->info.input_states;
    return states > STATES_MAX ? refuse_size(w, states) : allocate_space(w, (size_t)room);
}

/* ---- The analysis ------------------------------------------------------------------------------------------------ */

/* Order of the states: q, w, then the additional states of each input in the order of the inputs. */
static void number_states(dmb_space_work *w)
{
    dmb_state_space_info *info = &w->space->info;
    uint32_t state = 2 * info->coordinates;
    for (uint32_t i = 0; i < w->input_count; i++) {
        const uint32_t states = dmb_space_states_of(w, w->inputs + i);
        w->input_state[i] = states > 0 ? state : DMB_NONE;
        state += states;
    }
    info->states = state;
}

static void write_info(dmb_space_work *w)
{
    dmb_state_space_info *info = &w->space->info;
    info->inputs = w->input_count;
    info->outputs = w->output_count;
    info->rows = w->linear->rows;
    info->independent = w->linear->coordinates;
    info->constraint_rows = w->space->jacobian.rows;
    info->residual_of_state = w->linear->relative_residual;
    info->largest_force = w->linear->largest_force;
}

static int32_t run(dmb_space_work *w, const dmb_excitation *inputs, const dmb_output *outputs)
{
    int32_t status = linearise(w);
    if (status >= 0) status = allocate_work(w);
    if (status >= 0) status = read_inputs(w, inputs);
    if (status >= 0) status = dmb_space_read_outputs(w, outputs);
    if (status >= 0) status = make_room(w);
    if (status < 0) return status;
    write_info(w);
    if (w->options.form == DMB_STATE_MATRICES) return DMB_OK;
    status = dmb_space_make_basis(w);
    if (status < 0) return status;
    number_states(w);
    return dmb_space_fill(w);
}

/* Notes effects that the matrices neglect. */
static int32_t note_coefficients(dmb_space_work *w)
{
    const dmb_linear_options options = how_to_linearise(w);
    if (w->options.form == DMB_STATE_MATRICES) return DMB_OK;
    const int32_t status = dmb_linear_note_coefficients(w->linear, "state space", &w->sim->message);
    return status != DMB_OK ? status : dmb_space_note_turning(w, &options);
}

static void release(dmb_space_work *w)
{
    dmb_dynamic_stiffness_release(&w->stiffness);
    dmb_linear_release(&w->linear);
    if (w->block != NULL) dmb_release(&w->sim->allocator, w->block, w->block_size);
}

static int32_t analyse(dmb_space_work *w, const dmb_state_space_options *options, const dmb_excitation *inputs,
                       const dmb_output *outputs, dmb_state_space **space)
{
    dmb_sim *sim = w->sim;
    int32_t status = read_options(sim, options, w->input_count, w->output_count, &w->options);
    if (status >= 0) status = dmb_state_copy_check(sim, "state space");
    if (status >= 0) status = dmb_actuators_check_linear(sim, "state space", 1, &sim->message);
    if (status < 0) return status;
    w->space = dmb_allocate(&sim->allocator, sizeof *w->space);
    status = w->space != NULL ? DMB_OK : DMB_ERR_NO_MEMORY;
    if (status >= 0) {
        w->space->magic = DMB_HANDLE_STATE_SPACE;
        w->space->allocator = sim->allocator;
        status = run(w, inputs, outputs);
    }
    if (status >= 0) status = note_coefficients(w);
    release(w);
    if (status == DMB_ERR_NO_MEMORY) dmb_message_set(&sim->message, "state space: no memory");
    if (status < 0)
        dmb_state_space_destroy(&w->space);
    else
        *space = w->space;
    return status;
}

int32_t dmb_analysis_state_space(dmb_sim *sim, const dmb_state_space_options *options, const dmb_excitation *inputs,
                                 uint32_t input_count, const dmb_output *outputs, uint32_t output_count,
                                 dmb_state_space **space)
{
    if (space == NULL) return dmb_sim_failed(sim, "state space", DMB_ERR_NULL);
    *space = NULL;
    if (sim == NULL || (inputs == NULL && input_count > 0) || (outputs == NULL && output_count > 0))
        return dmb_sim_failed(sim, "state space", DMB_ERR_NULL);
    const int32_t status = dmb_sim_enter(sim, DMB_BUSY_READABLE);
    if (status < 0) return status;
    dmb_space_work w = {.sim = sim, .input_count = input_count, .output_count = output_count};
    return dmb_sim_leave(sim, analyse(&w, options, inputs, outputs, space));
}

void dmb_state_space_destroy(dmb_state_space **space)
{
    if (space == NULL) return;
    dmb_state_space *found = *space;
    *space = NULL;
    if (!dmb_handle_is(found, DMB_HANDLE_STATE_SPACE)) return;
    const dmb_allocator allocator = found->allocator;
    found->magic = DMB_HANDLE_DEAD;
    dmb_sparse_rows_release(&allocator, &found->whole);
    dmb_sparse_rows_release(&allocator, &found->jacobian);
    if (found->block != NULL) dmb_release(&allocator, found->block, found->block_size);
    dmb_release(&allocator, found, sizeof *found);
}

/* ---- Queries ----------------------------------------------------------------------------------------------------- */

static int32_t ask(const dmb_state_space *space, const void *answer)
{
    if (space == NULL) return DMB_ERR_NULL;
    if (!dmb_handle_is(space, DMB_HANDLE_STATE_SPACE)) return DMB_ERR_HANDLE;
    return answer != NULL ? DMB_OK : DMB_ERR_NULL;
}

int32_t dmb_state_space_get_info(const dmb_state_space *space, dmb_state_space_info *info)
{
    const int32_t status = ask(space, info);
    return dmb_failed("state space", status < 0 ? status : dmb_state_space_info_write(info, &space->info));
}

int32_t dmb_state_space_dense(const dmb_state_space *space, int32_t matrix, double *values)
{
    const int32_t status = ask(space, values);
    if (status < 0) return dmb_failed("state space", status);
    const size_t states = space->info.states, inputs = space->info.inputs, outputs = space->info.outputs;
    const double *all[4] = {space->A, space->B, space->C, space->D};
    const size_t counts[4] = {states * states, states * inputs, outputs * states, outputs * inputs};
    if (matrix < DMB_MATRIX_A || matrix > DMB_MATRIX_D) return dmb_failed("state space", DMB_ERR_VALUE);
    if (counts[matrix] > 0) memcpy(values, all[matrix], counts[matrix] * sizeof(double));
    return DMB_OK;
}

int32_t dmb_state_space_shapes(const dmb_state_space *space, double *shapes)
{
    const int32_t status = ask(space, shapes);
    if (status < 0) return dmb_failed("state space", status);
    const size_t numbers = (size_t)space->info.coordinates * space->info.rows;
    if (numbers > 0) memcpy(shapes, space->shapes, numbers * sizeof(double));
    return DMB_OK;
}

/* A sparse matrix by rows. */
typedef struct sparse_view {
    uint32_t rows;
    const uint32_t *start, *column;
    const double *value;
} sparse_view;

static sparse_view view_of(const dmb_state_space *s, int32_t matrix)
{
    const dmb_sparse_rows *of = matrix == DMB_MATRIX_JACOBIAN ? &s->jacobian : &s->whole;
    const int kind = matrix == DMB_MATRIX_JACOBIAN ? 0 : matrix - DMB_MATRIX_MASS;
    if (matrix == DMB_MATRIX_COORDINATES) {
        const sparse_view R = {s->info.rows, s->coordinate_start, s->coordinate_column, s->coordinate_value};
        return R;
    }
    const sparse_view A = {of->rows, of->start, of->column, of->value[kind]};
    return A;
}

/* Writes the nonzero entries; the arrays may be NULL. Result: their number. */
static uint64_t put_entries(const sparse_view *A, uint32_t *rows, uint32_t *columns, double *values)
{
    uint64_t used = 0;
    for (uint32_t r = 0; r < A->rows; r++)
        for (uint32_t i = A->start[r]; i < A->start[r + 1]; i++) {
            if (A->value[i] == 0.0) continue;
            if (values != NULL) {
                rows[used] = r;
                columns[used] = A->column[i];
                values[used] = A->value[i];
            }
            used++;
        }
    return used;
}

int32_t dmb_state_space_sparse(const dmb_state_space *space, int32_t matrix, uint32_t *rows, uint32_t *columns,
                               double *values, uint64_t *count)
{
    const int32_t status = ask(space, count);
    if (status < 0) return dmb_failed("state space", status);
    if (matrix < DMB_MATRIX_MASS || matrix > DMB_MATRIX_COORDINATES) return dmb_failed("state space", DMB_ERR_VALUE);
    const int given = (rows != NULL) + (columns != NULL) + (values != NULL);
    if (given != 0 && given != 3) return dmb_failed("state space", DMB_ERR_NULL);
    const sparse_view A = view_of(space, matrix);
    const uint64_t needed = put_entries(&A, NULL, NULL, NULL);
    if (given == 3 && *count < needed) return dmb_failed("state space", DMB_ERR_VALUE);
    *count = given == 3 ? put_entries(&A, rows, columns, values) : needed;
    return DMB_OK;
}
