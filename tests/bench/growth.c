/* This program tells how the cost of a step grows with the number of elements. usage: growth [SCENE ELEMENTS STEPS]
 *
 * Without words: C and B, 100 m in 100 to 10000 elements, 0.1 s in steps of 1 ms; thread time of a step and of an
 * iteration, and the exponent of both by least squares. The sizes take turns in stretches of ten steps, and each
 * stretch counts with the least of its repetitions: what else the machine does counts for little.
 * With words: that many steps of one scene and nothing printed, for the counts of tests/bench/growth. */
#define _POSIX_C_SOURCE 200809L

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "scenes.h"

enum { SIZES = 5, STRETCHES = 10, STRETCH_STEPS = 10, ROUNDS = 7, TUBE_PIPES = 100 };
#define GROWTH_STEP 1e-3 /* [s] */

static const uint32_t sizes[SIZES] = {100, 200, 400, 1000, 10000};

/* [s] of this thread */
static double processor_time(void)
{
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static int32_t open_scene(int kind, uint32_t elements, scene *s)
{
    memset(s, 0, sizeof *s);
    s->kind = kind;
    s->pipes = TUBE_PIPES;
    s->per_pipe = elements / TUBE_PIPES;
    s->length = 1.0;
    s->pipe_kind = DMB_PIPE_FLEXIBLE;
    return scene_open(s);
}

static int32_t go_on(dmb_sim *sim, int steps)
{
    int32_t status = DMB_OK;
    for (int k = 0; k < steps && status >= 0; k++) status = dmb_sim_step(sim, GROWTH_STEP, NULL);
    return status;
}

typedef struct growth {
    scene scenes[SIZES];
    dmb_sim *sims[SIZES];
    double least[SIZES][STRETCHES]; /* [s] */
    double iterations[SIZES];       /* [-] a step */
} growth;

static int32_t time_stretch(growth *g, int size, int stretch)
{
    const double begin = processor_time();
    const int32_t status = go_on(g->sims[size], STRETCH_STEPS);
    g->least[size][stretch] = fmin(g->least[size][stretch], processor_time() - begin);
    return status;
}

/* All sizes from time 0 to the end, in turns. */
static int32_t go_round(growth *g)
{
    const dmb_sim_options options = dmb_sim_options_default();
    int32_t status = DMB_OK;
    for (int i = 0; i < SIZES && status >= 0; i++) status = dmb_sim_create(g->scenes[i].model, &options, &g->sims[i]);
    for (int k = 0; k < STRETCHES; k++)
        for (int i = 0; i < SIZES && status >= 0; i++) status = time_stretch(g, i, k);
    for (int i = 0; i < SIZES; i++) {
        dmb_statistics statistics = dmb_statistics_default();
        if (status >= 0) status = dmb_query_statistics(g->sims[i], &statistics);
        g->iterations[i] = (double)statistics.iterations / (STRETCHES * STRETCH_STEPS);
        dmb_sim_destroy(&g->sims[i]);
    }
    return status;
}

/* Slope of log y over log x. */
static double exponent_of(const double *y)
{
    double mean_x = 0.0, mean_y = 0.0, xy = 0.0, xx = 0.0;
    for (int i = 0; i < SIZES; i++) {
        mean_x += log(sizes[i]) / SIZES;
        mean_y += log(y[i]) / SIZES;
    }
    for (int i = 0; i < SIZES; i++) {
        xy += (log(sizes[i]) - mean_x) * (log(y[i]) - mean_y);
        xx += (log(sizes[i]) - mean_x) * (log(sizes[i]) - mean_x);
    }
    return xy / xx;
}

static void tell(const growth *g, int kind)
{
    double step[SIZES], iteration[SIZES];
    for (int i = 0; i < SIZES; i++) {
        step[i] = 0.0;
        for (int k = 0; k < STRETCHES; k++) step[i] += 1e6 * g->least[i][k] / (STRETCHES * STRETCH_STEPS);
        iteration[i] = step[i] / g->iterations[i];
        printf("scene=%s elements=%u us_per_step=%.4g iterations=%.3g ns_per_element_iteration=%.4g\n",
               scene_names[kind], sizes[i], step[i], g->iterations[i], 1e3 * iteration[i] / sizes[i]);
    }
    printf("scene=%s exponent=%.3f exponent_iteration=%.3f\n", scene_names[kind], exponent_of(step),
           exponent_of(iteration));
}

static int32_t measure_growth(int kind)
{
    static growth g;
    int32_t status = DMB_OK;
    memset(&g, 0, sizeof g);
    for (int i = 0; i < SIZES && status >= 0; i++) {
        status = open_scene(kind, sizes[i], &g.scenes[i]);
        for (int k = 0; k < STRETCHES; k++) g.least[i][k] = (double)INFINITY;
    }
    for (int k = 0; k < ROUNDS && status >= 0; k++) status = go_round(&g);
    if (status >= 0) tell(&g, kind);
    for (int i = 0; i < SIZES; i++) dmb_model_destroy(&g.scenes[i].model);
    return status;
}

static int32_t run_alone(int kind, uint32_t elements, int steps)
{
    const dmb_sim_options options = dmb_sim_options_default();
    dmb_sim *sim = NULL;
    scene s;
    int32_t status = open_scene(kind, elements, &s);
    if (status >= 0) status = dmb_sim_create(s.model, &options, &sim);
    if (status >= 0) status = go_on(sim, steps);
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&s.model);
    return status;
}

static int report(const char *name, int32_t status)
{
    if (status < 0) fprintf(stderr, "growth: scene %s: %s\n", name, dmb_status_name(status));
    return status < 0;
}

int main(int count, char **words)
{
    if (count == 4) {
        const int kind = strcmp(words[1], "C") == 0 ? SCENE_C : strcmp(words[1], "B") == 0 ? SCENE_B : SCENE_R;
        const long elements = strtol(words[2], NULL, 10), steps = strtol(words[3], NULL, 10);
        if (elements >= TUBE_PIPES && elements <= 1000000 && steps >= 0 && steps <= 1000000)
            return report(words[1], run_alone(kind, (uint32_t)elements, (int)steps));
    }
    if (count != 1) return fputs("usage: growth [C|B|R ELEMENTS STEPS]\n", stderr), 2;
    return report("C", measure_growth(SCENE_C)) + report("B", measure_growth(SCENE_B));
}
