/* Pulled, pushed and twisted strings with 1, 2, 4 and 8 elements a pipe. usage: loaded CSV N
 *
 * Scene N: ten pipes of 3 m, 50/39 mm, clamped at one end, under a dead axial force and torque and a side force at the
 * other, without weight. The errors are those of the deflection of the tip at rest and of the worst of the first six
 * frequencies about that state (two bending planes), against 16 elements a pipe; a torque that keeps its axis has no
 * potential, so frequencies are asked without one. In the steps of 1 ms the loads come on at once. */
#define _POSIX_C_SOURCE 200809L

#include <drillmbd/drillmbd.h>

#include <stdio.h>

#include "row.h"

#define LOADED_STEP 1e-3 /* [s] */

enum {
    LOADED_REPEATS = 5,
    LOADED_STEPS = 200,
    LOADED_PIPES = 10,
    LOADED_FINE = 16,
    LOADED_MODES = 6,
    LOADED_CASES = 6
};

typedef struct loaded {
    const char *name;
    double force, torque, side; /* [N, N m, N] */
} loaded;

/* pi^2 EI/(4 L^2) is 112 N. */
static const loaded cases[LOADED_CASES] = {
    {"none", 0.0, 0.0, 1.0},          {"pull_60_kN", 60e3, 0.0, 1e3},
    {"pull_180_kN", 180e3, 0.0, 3e3}, {"push_0.8_of_Euler", -90.0, 0.0, 1.0},
    {"twist_1_kNm", 0.0, 1e3, 1.0},   {"pull_60_kN_twist_1_kNm", 60e3, 1e3, 1e3}};

typedef struct answer {
    double tip[2], frequencies[LOADED_MODES]; /* [m, Hz] */
    double step, spread, unit, iterations;    /* [s] */
} answer;

static yardstick unit;
static result_table results;

static int32_t describe(dmb_model *model, const loaded *l, uint32_t per_pipe, dmb_place *tip)
{
    dmb_environment_def weightless = dmb_environment_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_load_def load = dmb_load_def_default();
    dmb_id id = {0, 0};
    weightless.gravity[2] = 0.0;
    string.start_free = DMB_FREE_NONE;
    pipe.outer_diameter = 0.050;
    pipe.inner_diameter = 0.039;
    pipe.length = 3.0;
    pipe.elements = per_pipe;
    int32_t status = dmb_model_set_environment(model, &weightless);
    if (status >= 0) status = dmb_model_add_string(model, &string, &pipe.string);
    if (status >= 0) status = dmb_model_add_pipes(model, &pipe, LOADED_PIPES, &id);
    *tip = load.place = dmb_station(id, LOADED_PIPES - 1, 1.0);
    load.force[0] = l->force;
    load.force[1] = l->side;
    load.moment[0] = l->torque;
    return status < 0 ? status : dmb_model_add_load(model, &load, NULL);
}

static int32_t take_frequencies(dmb_sim *sim, answer *a)
{
    dmb_modes_options options = dmb_modes_options_default();
    dmb_modes *modes = NULL;
    options.count = LOADED_MODES;
    options.kind = DMB_MODES_UNDAMPED;
    int32_t status = dmb_analysis_modes(sim, &options, &modes);
    for (uint32_t i = 0; status >= 0 && i < LOADED_MODES; ++i) {
        dmb_mode mode = dmb_mode_default();
        status = dmb_modes_get(modes, i, &mode);
        a->frequencies[i] = mode.frequency;
    }
    dmb_modes_destroy(&modes);
    return status;
}

static int32_t take_rest(dmb_model *model, const loaded *l, dmb_place tip, answer *a)
{
    dmb_static_options options = dmb_static_options_default();
    dmb_pose pose = dmb_pose_default();
    dmb_sim *sim = NULL;
    options.tolerance = 1e-12;
    int32_t status = dmb_sim_create(model, NULL, &sim);
    if (status >= 0) status = dmb_analysis_static(sim, &options, NULL);
    if (status >= 0) status = dmb_query_pose(sim, tip, &pose);
    a->tip[0] = pose.displacement[1];
    a->tip[1] = pose.displacement[2];
    if (status >= 0 && l->torque == 0.0) status = take_frequencies(sim, a);
    if (status < 0) fprintf(stderr, "bench: scene N: %s: %s\n", l->name, sim ? dmb_sim_message(sim) : "no sim");
    dmb_sim_destroy(&sim);
    return status;
}

/* From the straight string at rest: the loads come on at once. */
static int32_t take_steps(dmb_model *model, answer *a)
{
    double seconds[LOADED_REPEATS];
    int32_t status = DMB_OK;
    yardstick_anew(&unit);
    for (int i = 0; status >= 0 && i < LOADED_REPEATS; ++i) {
        dmb_statistics statistics = dmb_statistics_default();
        dmb_sim *sim = NULL;
        status = dmb_sim_create(model, NULL, &sim);
        const double begin = processor_time();
        for (int k = 0; status >= 0 && k < LOADED_STEPS; ++k) status = dmb_sim_step(sim, LOADED_STEP, NULL);
        seconds[i] = (processor_time() - begin) / LOADED_STEPS;
        if (status >= 0) status = dmb_query_statistics(sim, &statistics);
        a->iterations = (double)statistics.iterations / LOADED_STEPS;
        if (status < 0) fprintf(stderr, "bench: scene N: %s\n", sim ? dmb_sim_message(sim) : dmb_model_message(model));
        dmb_sim_destroy(&sim);
        yardstick_measure(&unit);
    }
    if (status < 0) return status;
    a->unit = yardstick_value(&unit);
    a->step = median(seconds, LOADED_REPEATS);
    a->spread = (seconds[LOADED_REPEATS - 1] - seconds[0]) / a->step;
    return status;
}

static int32_t measure(const loaded *l, uint32_t per_pipe, answer *a)
{
    dmb_model *model = NULL;
    dmb_place tip;
    memset(a, 0, sizeof *a);
    int32_t status = dmb_model_create(NULL, &model);
    if (status >= 0) status = describe(model, l, per_pipe, &tip);
    if (status >= 0) status = dmb_model_compile(model, NULL);
    if (status >= 0) status = take_rest(model, l, tip, a);
    if (status >= 0 && per_pipe < LOADED_FINE) status = take_steps(model, a);
    if (status < 0)
        row_failed("N", LOADED_PIPES * per_pipe, l->name, dmb_status_name(status),
                   model ? dmb_model_message(model) : "no model");
    dmb_model_destroy(&model);
    return status;
}

static void report(const loaded *l, uint32_t per_pipe, const answer *a, const answer *fine)
{
    const double off = hypot(a->tip[0] - fine->tip[0], a->tip[1] - fine->tip[1]) / hypot(fine->tip[0], fine->tip[1]);
    double worst = l->torque == 0.0 ? 0.0 : (double)NAN;
    for (int i = 0; i < LOADED_MODES && l->torque == 0.0; ++i)
        worst = fmax(worst, fabs(a->frequencies[i] / fine->frequencies[i] - 1.0));
    const head h = {
        "N", LOADED_PIPES * per_pipe,      LOADED_STEP, a->step, a->unit, LOADED_STEP / a->step, a->iterations,
        off, "tip_deflection_vs_16_a_pipe"};
    result_row r;
    row_begin(&r, &h);
    row_number(&r, "spread", a->spread, 3);
    row_number(&r, "U_us", 1e6 * a->unit, 4);
    row_number(&r, "repeats", LOADED_REPEATS, 3);
    row_word(&r, "load", l->name);
    row_number(&r, "elements_per_pipe", per_pipe, 3);
    row_number(&r, "force", l->force, 6);
    row_number(&r, "torque", l->torque, 6);
    row_number(&r, "error_2", worst, 3);
    row_word(&r, "error_2_kind", "worst_of_6_frequencies_vs_16_a_pipe");
    row_put(&r, &results);
}

static int run_case(const loaded *l)
{
    answer fine, a;
    if (measure(l, LOADED_FINE, &fine) < 0) return 1;
    for (uint32_t per_pipe = 1; per_pipe <= 8; per_pipe *= 2) {
        if (measure(l, per_pipe, &a) < 0) return 1;
        report(l, per_pipe, &a, &fine);
    }
    return 0;
}

int main(int count, char **words)
{
    int failed = 0;
    if (count != 3 || strcmp(words[2], "N") != 0) return fputs("usage: loaded CSV N\n", stderr), 2;
    if (table_open(&results, &unit, words[1]) != 0) return 2;
    for (int i = 0; i < LOADED_CASES; ++i) failed |= run_case(&cases[i]);
    return table_close(&results, words[1]) != 0 ? 2 : failed;
}
