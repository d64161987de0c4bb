/* The cost of a frequency response. usage: response CSV H
 *
 * Scene H: the tube of scene C, 100 m, 100 to 10000 elements, the speed of its drive the input and the rotation of its
 * tip the output, structural damping 0.02, 0.1 to 50 Hz. The same blocks are solved whatever input and output are.
 * Error: root mean square over the band of what differs from 1/(i w cos k L), k = w sqrt(rho/(G (1 + i eta))), over
 * that of the exact response. With W, in the hole under gravity, resting on the wall. With J, each pipe is a string of
 * its own, fixed to the one before by a described joint: as many joints as pipes less one. A row tells processor time
 * of a point where others tell that of a step. */
#define _POSIX_C_SOURCE 200809L

#include <drillmbd/drillmbd.h>

#include <complex.h>
#include <stdio.h>

#include "row.h"

#define TUBE_PI 3.14159265358979323846
#define TUBE_LENGTH 100.0
#define TUBE_LOSS 0.02

enum { RESPONSE_REPEATS = 5, RESPONSE_SIZES = 5 };

typedef struct tube {
    uint32_t elements, points;
    int walled, jointed;
    dmb_model *model;
    dmb_sim *sim;
    dmb_id string, drive;
    dmb_place tip;
} tube;

typedef struct cost {
    double make, point, spread, error; /* [s], [s], [-], [-] */
} cost;

static yardstick unit;
static result_table results;

static const char *name_of(const tube *t)
{
    return t->walled ? "HW" : t->jointed ? "HJ" : "H";
}

/* ---- The tube -----------------------------------------------------------------------------------------------------
 */

/* String `i` of `pipes` pipes each, held by the rig or by the one before. */
static int32_t add_part(tube *t, uint32_t i, uint32_t pipes, dmb_place *end)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_joint_def joint = dmb_joint_def_default();
    string.start_free = i == 0 ? DMB_FREE_RX : DMB_FREE_ALL;
    string.follows_hole = i == 0;
    pipe.length = TUBE_LENGTH / t->elements;
    pipe.outer_diameter = 0.073;
    pipe.inner_diameter = 0.059;
    pipe.young_modulus = 206e9;
    string.position[0] = i * pipes * pipe.length;
    int32_t status = dmb_model_add_string(t->model, &string, &pipe.string);
    if (status >= 0) status = dmb_model_add_pipes(t->model, &pipe, pipes, NULL);
    joint.place_a = *end;
    joint.place_b = dmb_station(pipe.string, 0, 0.0);
    if (i == 0) t->string = pipe.string;
    *end = dmb_station(pipe.string, pipes - 1, 1.0);
    return status < 0 || i == 0 ? status : dmb_model_add_joint(t->model, &joint, NULL);
}

static int32_t add_tube(tube *t)
{
    const uint32_t parts = t->jointed ? t->elements : 1;
    int32_t status = DMB_OK;
    for (uint32_t i = 0; i < parts && status >= 0; ++i) status = add_part(t, i, t->elements / parts, &t->tip);
    return status;
}

static int32_t add_surroundings(tube *t)
{
    dmb_environment_def weightless = dmb_environment_def_default();
    dmb_wall_def wall = dmb_wall_def_default();
    weightless.gravity[2] = 0.0;
    if (t->walled) return dmb_model_add_wall(t->model, &wall, NULL);
    return dmb_model_set_environment(t->model, &weightless);
}

static int32_t add_turning(tube *t)
{
    const dmb_segment still = dmb_segment_default();
    dmb_drive_def drive = dmb_drive_def_default();
    const int32_t status = dmb_model_add_time_function(t->model, &still, 1, &drive.time_function);
    drive.part = t->string;
    drive.component = DMB_RX;
    return status < 0 ? status : dmb_model_add_drive(t->model, &drive, &t->drive);
}

static int32_t tube_open(tube *t)
{
    int32_t status = dmb_model_create(NULL, &t->model);
    if (status >= 0) status = add_surroundings(t);
    if (status >= 0) status = add_tube(t);
    if (status >= 0) status = add_turning(t);
    if (status >= 0) status = dmb_model_compile(t->model, NULL);
    if (status >= 0) status = dmb_sim_create(t->model, NULL, &t->sim);
    if (status >= 0 && (t->walled || t->jointed)) status = dmb_analysis_static(t->sim, NULL, NULL);
    return status;
}

/* ---- Measures -----------------------------------------------------------------------------------------------------
 */

static double complex exact(double frequency)
{
    const double w = 2.0 * TUBE_PI * frequency, G = 206e9 / 2.6;
    const double complex k = w * csqrt(7850.0 / (G * (1.0 + TUBE_LOSS * (double complex)_Complex_I)));
    return 1.0 / ((double complex)_Complex_I * w * ccos(k * TUBE_LENGTH));
}

static int32_t find_error(const dmb_response *response, uint32_t points, double *error)
{
    double *f = malloc(points * sizeof *f), off = 0.0, all = 0.0;
    double complex *h = malloc(points * sizeof *h);
    int32_t status = f && h ? dmb_response_frequencies(response, f) : DMB_ERR_NO_MEMORY;
    if (status >= 0) status = dmb_response_transfer(response, 0, 0, (double *)h);
    for (uint32_t i = 0; status >= 0 && i < points; ++i) {
        const double complex want = exact(f[i]);
        off += pow(cabs(h[i] - want) * f[i], 2.0); /* speeds, so that low frequencies do not outweigh the rest */
        all += pow(cabs(want) * f[i], 2.0);
    }
    *error = sqrt(off / all);
    free(f);
    free(h);
    return status;
}

static int32_t respond(const tube *t, uint32_t points, double *seconds, double *error)
{
    dmb_response_options options = dmb_response_options_default();
    dmb_excitation input = dmb_excitation_default();
    dmb_output output = {.quantity = DMB_OUTPUT_VIBRATION};
    dmb_response *response = NULL;
    options.points = points;
    options.frequency_low = 0.1;
    options.frequency_high = 50.0;
    options.structural_damping = TUBE_LOSS;
    input.kind = DMB_EXCITATION_DRIVE;
    input.place.part = t->drive;
    output.place = t->tip;
    output.quantity += DMB_RX;
    const double begin = processor_time();
    int32_t status = dmb_analysis_response(t->sim, &options, &input, 1, &output, 1, &response);
    *seconds = processor_time() - begin;
    if (status < 0) row_failed(name_of(t), t->elements, "response", dmb_status_name(status), dmb_sim_message(t->sim));
    if (status >= 0 && error) status = find_error(response, points, error);
    dmb_response_destroy(&response);
    return status;
}

/* A point: all of them less what two points cost. */
static int32_t measure_tube(tube *t, cost *c)
{
    double make[RESPONSE_REPEATS], point[RESPONSE_REPEATS];
    int32_t status = tube_open(t);
    if (status < 0)
        row_failed(name_of(t), t->elements, "describe", dmb_status_name(status), dmb_model_message(t->model));
    yardstick_anew(&unit);
    for (int i = 0; i < RESPONSE_REPEATS && status >= 0; ++i) {
        double all = 0.0;
        status = respond(t, 2, &make[i], NULL);
        if (status >= 0) status = respond(t, t->points, &all, &c->error);
        point[i] = (all - make[i]) / (t->points - 2);
        for (int k = 0; k < 3; ++k) yardstick_measure(&unit);
    }
    dmb_sim_destroy(&t->sim);
    dmb_model_destroy(&t->model);
    if (status < 0) return status;
    c->make = median(make, RESPONSE_REPEATS);
    c->point = median(point, RESPONSE_REPEATS);
    c->spread = (point[RESPONSE_REPEATS - 1] - point[0]) / c->point;
    return DMB_OK;
}

/* ---- Report -------------------------------------------------------------------------------------------------------
 */

/* On the wall friction of the state at rest turns the tube too: there is no closed form to be wrong by. */
static void report(const tube *t, const cost *c)
{
    const double u = yardstick_value(&unit), none = (double)NAN;
    const head h = {name_of(t),
                    t->elements,
                    none,
                    c->point,
                    u,
                    none,
                    none,
                    t->walled ? none : c->error,
                    t->walled ? "-" : "rms_of_tip_speed_vs_closed_form"};
    result_row r;
    row_begin(&r, &h);
    row_number(&r, "spread", c->spread, 3);
    row_number(&r, "U_us", 1e6 * u, 4);
    row_number(&r, "repeats", RESPONSE_REPEATS, 3);
    row_number(&r, "points", t->points, 9);
    row_number(&r, "us_two_points", 1e6 * c->make, 4);
    row_put(&r, &results);
}

static int run_all(void)
{
    static const uint32_t elements[RESPONSE_SIZES] = {100, 200, 400, 1000, 10000};
    for (int kind = 0; kind < 3; ++kind) {
        for (int i = 0; i < RESPONSE_SIZES; ++i) {
            tube t = {
                .elements = elements[i], .points = 1000000u / elements[i], .walled = kind == 1, .jointed = kind == 2};
            cost c = {0.0, 0.0, 0.0, 0.0};
            if (t.jointed && t.elements > 1000) continue;
            if (measure_tube(&t, &c) < 0) return 1;
            report(&t, &c);
        }
    }
    return 0;
}

int main(int count, char **words)
{
    if (count != 3 || strcmp(words[2], "H") != 0) return fputs("usage: response CSV H\n", stderr), 2;
    if (table_open(&results, &unit, words[1]) != 0) return 2;
    const int failed = run_all();
    return table_close(&results, words[1]) != 0 ? 2 : failed;
}
