/* Scene A: the first ten clamped-free frequencies of scene C's tube; A-all: all 600 of its 100 pipes, by LAPACK;
 * A-all-damped: the same with damping and gyroscopic terms, which there are none of in it, so that the frequencies are
 * those. usage: modes CSV A
 *
 * Its bending pairs are given from elsewhere in six digits (Timoshenko's beam). A row tells processor time of one
 * dmb_analysis_modes where others tell that of a step, its solves instead of iterations, and each frequency with its
 * error; modes come in pairs of equal frequency. */
#define _POSIX_C_SOURCE 200809L

#include "row.h"
#include "scenes.h"

enum { MODES = 10, MODES_REPEATS = 5, MODES_SIZES = 5 };

static yardstick unit;
static result_table results;

/* [Hz] of each pair. */
static const double given[MODES / 2] = {0.00672663, 0.0421551, 0.118035, 0.231302, 0.382359};

typedef struct answer {
    double seconds, spread, solves, frequencies[MODES];
} answer;

static int32_t take_frequencies(const dmb_modes *modes, answer *a)
{
    dmb_modes_info info = dmb_modes_info_default();
    int32_t status = dmb_modes_get_info(modes, &info);
    a->solves = info.solves;
    for (uint32_t i = 0; status >= 0 && i < MODES; ++i) {
        dmb_mode mode = dmb_mode_default();
        status = dmb_modes_get(modes, i, &mode);
        a->frequencies[i] = mode.frequency;
    }
    return status;
}

/* select: the lowest ten, or all that there are. */
static int32_t find_modes(dmb_sim *sim, int32_t kind, int32_t select, answer *a)
{
    dmb_modes_options options = dmb_modes_options_default();
    double seconds[MODES_REPEATS];
    int32_t status = DMB_OK;
    options.count = MODES;
    options.kind = kind;
    options.select = select;
    yardstick_anew(&unit);
    for (int i = 0; status >= 0 && i < MODES_REPEATS; ++i) {
        dmb_modes *modes = NULL;
        const double begin = processor_time();
        status = dmb_analysis_modes(sim, &options, &modes);
        seconds[i] = processor_time() - begin;
        if (status >= 0) status = take_frequencies(modes, a);
        dmb_modes_destroy(&modes);
        for (int k = 0; k < 3; ++k) yardstick_measure(&unit);
    }
    if (status < 0) return status;
    a->seconds = median(seconds, MODES_REPEATS);
    a->spread = (seconds[MODES_REPEATS - 1] - seconds[0]) / a->seconds;
    return status;
}

static void report(const char *name, uint32_t elements, const answer *a)
{
    static const char *const names[MODES][2] = {{"hertz_1", "error_1"},  {"hertz_2", "error_2"}, {"hertz_3", "error_3"},
                                                {"hertz_4", "error_4"},  {"hertz_5", "error_5"}, {"hertz_6", "error_6"},
                                                {"hertz_7", "error_7"},  {"hertz_8", "error_8"}, {"hertz_9", "error_9"},
                                                {"hertz_10", "error_10"}};
    double errors[MODES], worst = 0.0;
    for (int i = 0; i < MODES; ++i) {
        errors[i] = fabs(a->frequencies[i] / given[i / 2] - 1.0);
        worst = fmax(worst, errors[i]);
    }
    const double u = yardstick_value(&unit);
    const head h = {
        name, elements, (double)NAN, a->seconds, u, (double)NAN, a->solves, worst, "largest_frequency_vs_given"};
    result_row r;
    row_begin(&r, &h);
    row_number(&r, "spread", a->spread, 3);
    row_number(&r, "U_us", 1e6 * u, 4);
    row_number(&r, "repeats", MODES_REPEATS, 3);
    for (int i = 0; i < MODES; ++i) {
        row_number(&r, names[i][0], a->frequencies[i], 8);
        row_number(&r, names[i][1], errors[i], 2);
    }
    row_put(&r, &results);
}

static int measure_modes(const char *name, uint32_t per_pipe, int32_t kind, int32_t select)
{
    scene s = {.kind = SCENE_C, .pipes = 100, .per_pipe = per_pipe, .length = 1.0};
    answer a = {0.0, 0.0, 0.0, {0.0}};
    dmb_sim *sim = NULL;
    int32_t status = scene_open(&s);
    if (status >= 0) status = dmb_sim_create(s.model, NULL, &sim);
    if (status >= 0) status = find_modes(sim, kind, select, &a);
    if (status >= 0) report(name, s.pipes * per_pipe, &a);
    if (status < 0)
        row_failed(name, s.pipes * per_pipe, "modes", dmb_status_name(status),
                   sim       ? dmb_sim_message(sim)
                   : s.model ? dmb_model_message(s.model)
                             : "no model");
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&s.model);
    return status < 0;
}

int main(int count, char **words)
{
    static const uint32_t per_pipe[MODES_SIZES] = {1, 2, 4, 10, 100};
    int failures = 0;
    if (count != 3 || strcmp(words[2], "A") != 0) return fputs("usage: modes CSV A\n", stderr), 2;
    if (table_open(&results, &unit, words[1]) != 0) return 2;
    for (int i = 0; i < MODES_SIZES; ++i)
        failures += measure_modes("A", per_pipe[i], DMB_MODES_UNDAMPED, DMB_MODES_LOWEST);
    failures += measure_modes("A-all", 1, DMB_MODES_UNDAMPED, DMB_MODES_ALL);
    failures += measure_modes("A-all-damped", 1, DMB_MODES_DAMPED, DMB_MODES_ALL);
    if (table_close(&results, words[1]) != 0) return 2;
    return failures > 0;
}
