/* A, B, C and D from the basis, the inputs and the outputs (eq:response.state-space; head comment of state_space.h).
 * The states are q (r of them), w (r), then those of the inputs. Entries of the rows of w are multiplied by M_x^-1 X^T:
 *
 *     input                 states of its own   columns of A in w         columns of B
 *     force                 -                   -                         w: f
 *     controller's target   e' = u              k_i f of e                w: k_p f; e: 1
 *     motion, speed         xi' = u             -K p of xi                q: B_1; w: -C p - C_x B_1; xi: 1
 *     motion, acceleration  xi'' = u            -K p of xi, -C p of xi'   w: -M p; xi': 1
 *
 * and for the motion itself A has I in (q, w), -K_x in (w, q) and -C_x in (w, w). */
#include <math.h>
#include <string.h>

#include "analysis/state_space/state_space.h"
#include "math/dense.h"
#include "sim/access.h"
#include "sim/node.h"

/* [-] Coefficient of the rate of an input, relative to its terms, that counts as rounding. */
#define DMB_RATE_ROUNDING 1e-9

static uint32_t count(const dmb_space_work *w)
{
    return w->space->info.coordinates;
}

static const double *shape(const dmb_space_work *w, uint32_t i)
{
    return w->space->shapes + (size_t)w->linear->rows * i;
}

static double *A_row(const dmb_space_work *w, uint32_t state)
{
    return w->space->A + (size_t)w->space->info.states * state;
}

static double *B_at(const dmb_space_work *w, uint32_t state, uint32_t input)
{
    return w->space->B + (size_t)w->input_count * state + input;
}

/* g = M_x^-1 X^T f: by the factors of the mass in all coordinates, by scalar products in an orthonormal basis. f is
 * overwritten. */
static void reduce(dmb_space_work *w, double *f, double *g)
{
    const dmb_linear *linear = w->linear;
    for (uint32_t r = 0; r < linear->rows; r++)
        if (!linear->scene.solved_row[r]) f[r] = 0.0;
    if (w->options.form == DMB_STATE_FULL) {
        dmb_linear_solve(w->linear, f);
        for (uint32_t i = 0; i < count(w); i++) g[i] = f[linear->row_of[i]];
        return;
    }
    for (uint32_t i = 0; i < count(w); i++) g[i] = dmb_dot(linear->rows, shape(w, i), f);
}

/* ---- Motion ------------------------------------------------------------------------------------------------------ */

/* Column of A for the matrix `A` and the motion x: minus its accelerations. */
static void subtract_motion(dmb_space_work *w, const dmb_linear_matrix *A, const double *x, uint32_t column)
{
    const uint32_t rows = w->linear->rows, r = count(w);
    double *f = w->work, *g = w->work + rows;
    dmb_linear_multiply(w->linear, A, x, memset(f, 0, rows * sizeof(double)));
    reduce(w, f, g);
    for (uint32_t i = 0; i < r; i++) A_row(w, r + i)[column] = -g[i];
}

/* Column by column: one product with K and C and one reduction for each shape. The call can be cancelled between
 * columns. */
static int32_t fill_motion(dmb_space_work *w)
{
    const uint32_t r = count(w);
    int32_t status = DMB_OK;
    for (uint32_t j = 0; j < r && status >= 0; j++) {
        A_row(w, j)[r + j] = 1.0;
        subtract_motion(w, &w->linear->stiffness, shape(w, j), j);
        subtract_motion(w, &w->linear->damping, shape(w, j), r + j);
        status = dmb_progress_pulse(w->sim);
    }
    return status;
}

/* ---- Inputs ------------------------------------------------------------------------------------------------------ */

uint32_t dmb_space_states_of(const dmb_space_work *w, const dmb_linear_excitation *input)
{
    if (input->law == DMB_EXCITE_MOTION) return w->options.motion == DMB_MOTION_ACCELERATION ? 2 : 1;
    return input->law == DMB_EXCITE_CONTROL && input->integral_gain != 0.0;
}

/* A controller whose target is the input has the additional state e' = u of its integral gain. */
static void fill_force(dmb_space_work *w, uint32_t i)
{
    const dmb_linear_excitation *e = w->inputs + i;
    const uint32_t r = count(w), rows = w->linear->rows, state = w->input_state[i];
    const double gain = e->law == DMB_EXCITE_CONTROL ? e->gain : 1.0;
    double *g = w->work + rows;
    memcpy(w->work, e->re, rows * sizeof(double));
    reduce(w, w->work, g);
    for (uint32_t k = 0; k < r; k++) *B_at(w, r + k, i) = gain * g[k];
    if (state == DMB_NONE) return;
    *B_at(w, state, i) = 1.0;
    for (uint32_t k = 0; k < r; k++) A_row(w, r + k)[state] = e->integral_gain * g[k];
}

/* g = M_x^-1 X^T (A p) for M, C or K by all rows. */
static void forces_of_motion(dmb_space_work *w, int kind, uint32_t i, double *g)
{
    dmb_sparse_times(&w->space->whole, kind, w->inputs[i].re, w->work);
    reduce(w, w->work, g);
}

/* Columns of a speed input: B_1 in the rows of q, and the damping forces. */
static void fill_speed(dmb_space_work *w, uint32_t i, const double *by_mass, const double *by_speed)
{
    const uint32_t r = count(w);
    *B_at(w, w->input_state[i], i) = 1.0;
    for (uint32_t k = 0; k < r; k++) *B_at(w, k, i) = -by_mass[k];
    for (uint32_t k = 0; k < r; k++) {
        double sum = -by_speed[k];
        for (uint32_t j = 0; j < r; j++) sum -= A_row(w, r + k)[r + j] * by_mass[j];
        *B_at(w, r + k, i) = sum;
    }
}

/* xi'' = u: xi and its rate are states, so that no derivative of the input occurs and B_1 is not needed. */
static void fill_acceleration(dmb_space_work *w, uint32_t i, const double *by_mass, const double *by_speed)
{
    const uint32_t r = count(w), state = w->input_state[i];
    A_row(w, state)[state + 1] = 1.0;
    *B_at(w, state + 1, i) = 1.0;
    for (uint32_t k = 0; k < r; k++) {
        A_row(w, r + k)[state + 1] = -by_speed[k];
        *B_at(w, r + k, i) = -by_mass[k];
    }
}

static void fill_prescribed(dmb_space_work *w, uint32_t i)
{
    const uint32_t r = count(w), rows = w->linear->rows;
    double *by_mass = w->work + rows, *by_speed = by_mass + rows, *by_pose = by_speed + rows;
    forces_of_motion(w, DMB_WHOLE_MASS, i, by_mass);
    forces_of_motion(w, DMB_WHOLE_DAMPING, i, by_speed);
    forces_of_motion(w, DMB_WHOLE_STIFFNESS, i, by_pose);
    for (uint32_t k = 0; k < r; k++) A_row(w, r + k)[w->input_state[i]] = -by_pose[k];
    (w->options.motion == DMB_MOTION_SPEED ? fill_speed : fill_acceleration)(w, i, by_mass, by_speed);
}

/* ---- Outputs ----------------------------------------------------------------------------------------------------- */

static double product(const dmb_space_work *w, const double *a, const double *b)
{
    return dmb_dot(w->linear->rows, a, b);
}

/* y = ... + T.X w' + ..., w' by A and B. */
static void add_accelerations(dmb_space_work *w, const double *by_shape, double *C, double *D)
{
    const uint32_t r = count(w), states = w->space->info.states;
    for (uint32_t j = 0; j < r; j++) {
        if (by_shape[j] == 0.0) continue;
        for (uint32_t k = 0; k < states; k++) C[k] += by_shape[j] * A_row(w, r + j)[k];
        for (uint32_t i = 0; i < w->input_count; i++) D[i] += by_shape[j] * *B_at(w, r + j, i);
    }
}

/* 1: the coefficient of the rate of speed i in the output is at the rounding level. An output with T d'' contains T
 * (p + X B_1) u' for a speed input u. It is acceptable only if the drive's motion and the motion of the free parts
 * that its inertia causes cancel in the output. */
static int feels_no_rate(const dmb_space_work *w, const dmb_output_rows *o, const double *by_shape, uint32_t i)
{
    const double *p = w->inputs[i].re;
    double sum = product(w, o->acceleration, p), size = 0.0;
    for (uint32_t r = 0; r < w->linear->rows; r++) size += fabs(o->acceleration[r] * p[r]);
    for (uint32_t j = 0; j < count(w); j++) {
        const double term = by_shape[j] * *B_at(w, j, i);
        sum += term;
        size += fabs(term);
    }
    return fabs(sum) <= DMB_RATE_ROUNDING * size;
}

static void add_prescribed(const dmb_space_work *w, const dmb_output_rows *o, uint32_t i, double *C, double *D)
{
    const uint32_t state = w->input_state[i];
    const double *p = w->inputs[i].re;
    C[state] += product(w, o->pose, p);
    if (w->options.motion == DMB_MOTION_ACCELERATION) {
        C[state + 1] += product(w, o->speed, p);
        D[i] += product(w, o->acceleration, p);
        return;
    }
    D[i] += product(w, o->speed, p);
    for (uint32_t j = 0; j < count(w); j++) D[i] += product(w, o->speed, shape(w, j)) * *B_at(w, j, i);
}

/* Adds the force of an input that acts on the output directly, and the force of a drive that is both input and
 * output. */
static void add_direct(const dmb_space_work *w, const dmb_output_rows *o, uint32_t i, double *C, double *D)
{
    const dmb_linear_excitation *e = w->inputs + i;
    const uint32_t state = w->input_state[i];
    const int controls = e->law == DMB_EXCITE_CONTROL;
    if (e->law != DMB_EXCITE_MOTION) {
        const double force = product(w, o->force, e->re);
        D[i] += (controls ? e->gain : 1.0) * force;
        if (controls && state != DMB_NONE) C[state] += e->integral_gain * force;
    }
    if (o->bit != DMB_NONE && o->bit == e->bit) D[i] += 1.0;
    if (o->drive == DMB_NONE || o->drive != e->drive) return;
    D[i] += o->direct;
    if (state != DMB_NONE && controls) C[state] += o->integral;
}

static int32_t refuse_rate(const dmb_space_work *w, uint32_t output, uint32_t input)
{
    dmb_message_set(
        &w->sim->message,
        "state space: output %u feels the acceleration of the motion drive of excitation %u at once, which is the "
        "rate of its speed; set motion to DMB_MOTION_ACCELERATION, or ask for another output",
        output, input);
    return DMB_ERR_UNSUPPORTED;
}

static int32_t fill_output(dmb_space_work *w, uint32_t k)
{
    const uint32_t r = count(w);
    const dmb_output_rows *o = w->outputs + k;
    double *C = w->space->C + (size_t)w->space->info.states * k, *D = w->space->D + (size_t)w->input_count * k;
    double *by_shape = w->work;
    for (uint32_t j = 0; j < r; j++) {
        C[j] = product(w, o->pose, shape(w, j));
        C[r + j] = product(w, o->speed, shape(w, j));
        by_shape[j] = o->accelerates ? product(w, o->acceleration, shape(w, j)) : 0.0;
    }
    if (o->accelerates) add_accelerations(w, by_shape, C, D);
    for (uint32_t i = 0; i < w->input_count; i++) {
        if (w->inputs[i].law == DMB_EXCITE_MOTION) {
            const int speed = w->options.motion == DMB_MOTION_SPEED;
            if (o->accelerates && speed && !feels_no_rate(w, o, by_shape, i)) return refuse_rate(w, k, i);
            add_prescribed(w, o, i, C, D);
        }
        add_direct(w, o, i, C, D);
    }
    return DMB_OK;
}

/* ---- All matrices ------------------------------------------------------------------------------------------------ */

static int32_t factor_mass(dmb_space_work *w)
{
    if (w->options.form != DMB_STATE_FULL || count(w) == 0) return DMB_OK;
    const int64_t bad = dmb_linear_factor(w->linear, 0.0, 0.0, 1.0, NULL);
    if (bad < 0) return DMB_OK;
    const dmb_owner owner = dmb_owner_of_node(&w->linear->scene, (uint32_t)bad);
    dmb_message_set(&w->sim->message, "state space: %s: it moves and has no mass or inertia; give it some",
                    owner.text.text);
    return DMB_ERR_SINGULAR;
}

/* Outputs last: those with accelerations need the rows of w in A and B. */
int32_t dmb_space_fill(dmb_space_work *w)
{
    int32_t status = factor_mass(w);
    if (status >= 0) status = fill_motion(w);
    for (uint32_t i = 0; i < w->input_count && status >= 0; i++)
        (w->inputs[i].law == DMB_EXCITE_MOTION ? fill_prescribed : fill_force)(w, i);
    for (uint32_t k = 0; k < w->output_count && status >= 0; k++) status = fill_output(w, k);
    return status;
}

/* ---- Outputs ----------------------------------------------------------------------------------------------------- */

/* Outputs by all rows, from the response analysis: their functionals directly; forces of supports and constraints by
 * the coefficient of each row's force, a_r = -(output for a unit force on row r without motion). */

/* a_r of one row. By evaluation of the response's own output with a unit force alone: its sign and fractions are
 * defined in one place. */
static double fraction_of_row(dmb_space_work *w, const dmb_linear_output *output, dmb_complex_array zeros,
                              dmb_complex_array force, uint32_t row)
{
    const dmb_linear_excitation none = {.drive = DMB_NONE, .bit = DMB_NONE};
    force.re[row] = -1.0;
    const double value = dmb_linear_output_value(&w->stiffness, output, &none, zeros, force).re;
    force.re[row] = 0.0;
    return value;
}

static void read_fractions(dmb_space_work *w, const dmb_linear_output *output, double *fractions)
{
    const dmb_scene *scene = &w->linear->scene;
    const size_t rows = w->linear->rows;
    const dmb_complex_array zeros = {w->work, w->work + rows};
    const dmb_complex_array force = {w->work + 2 * rows, w->work + 3 * rows};
    memset(w->work, 0, 4 * rows * sizeof(double));
    for (uint32_t k = 0; k < output->support_count; k++) {
        const uint32_t row = dmb_constrained_row(scene, output->support[k]);
        fractions[row] = fraction_of_row(w, output, zeros, force, row);
    }
    if (output->cluster == DMB_NONE) return;
    const dmb_cluster *cluster = scene->clusters + output->cluster;
    for (uint32_t i = cluster->column; i < cluster->column + cluster->columns; i++) {
        const uint32_t row = scene->cluster_columns[i];
        fractions[row] = fraction_of_row(w, output, zeros, force, row);
    }
}

/* Adds the functional and its time derivatives: at most two, of outputs that depend on the pose alone. */
static void read_functional(const dmb_linear_output *output, dmb_output_rows *out)
{
    double *rates[5] = {out->pose, out->speed, out->acceleration, NULL, NULL};
    const dmb_functional *f = &output->functional;
    for (uint32_t i = 0; i < f->count; i++) {
        rates[output->rate][f->row[i]] += f->pose[i];
        if (output->rate < 2) rates[output->rate + 1][f->row[i]] += f->speed[i];
        if (output->rate < 1) rates[2][f->row[i]] += f->acceleration[i];
    }
}

static void read_output(dmb_space_work *w, const dmb_linear_output *output, dmb_output_rows *out)
{
    const dmb_sparse_rows *whole = &w->space->whole;
    const uint32_t rows = w->linear->rows;
    double *fractions = w->work + 4 * (size_t)rows;
    out->drive = output->drive;
    out->bit = output->bit;
    out->direct = output->direct;
    out->integral = output->integral;
    read_functional(output, out);
    if (output->support_count > 0 || output->cluster != DMB_NONE) {
        memset(fractions, 0, rows * sizeof(double));
        read_fractions(w, output, fractions);
        dmb_sparse_add_transposed(whole, DMB_WHOLE_STIFFNESS, fractions, out->pose);
        dmb_sparse_add_transposed(whole, DMB_WHOLE_DAMPING, fractions, out->speed);
        dmb_sparse_add_transposed(whole, DMB_WHOLE_MASS, fractions, out->acceleration);
        for (uint32_t r = 0; r < rows; r++) out->force[r] = -fractions[r];
    }
    for (uint32_t r = 0; r < rows; r++) out->accelerates |= out->acceleration[r] != 0.0;
}

int32_t dmb_space_read_outputs(dmb_space_work *w, const dmb_output *outputs)
{
    dmb_response_options options = dmb_response_options_default();
    options.contact = w->options.contact;
    options.friction = w->options.friction;
    options.contact_gap = w->options.contact_gap;
    for (uint32_t i = 0; i < w->output_count; i++) {
        dmb_linear_output taken;
        const int32_t status = dmb_linear_output_of(w->linear, &options, outputs + i, i, &w->sim->message, &taken);
        if (status < 0) return status;
        read_output(w, &taken, w->outputs + i);
    }
    return DMB_OK;
}
