/* Iterations of the steps of a long run. usage: iterations SCENE [STEP END]   SCENE: B, B*, C, R or T; D: B* for 4 s
 *
 * One line for the run: steps by their iterations, those of rejected attempts counted; then the longest, with where
 * they are. Counts repeat exactly, times do not: the work of a run by `valgrind --tool=callgrind`. */
#include <stdio.h>
#include <stdlib.h>

#include "scenes.h"

enum { MOST_COUNTED = 60, LONG_STEP = 7 };

typedef struct tally {
    unsigned steps[MOST_COUNTED + 1], iterations, rejected, count;
} tally;

static int32_t walk(dmb_sim *sim, double step, double end, tally *t)
{
    const unsigned steps = (unsigned)(end / step + 0.5);
    int32_t status = DMB_OK;
    for (unsigned i = 1; i <= steps && status >= 0; ++i) {
        dmb_step_report report = dmb_step_report_default();
        status = dmb_sim_step(sim, i * step - dmb_sim_time(sim), &report);
        t->steps[report.iterations < MOST_COUNTED ? report.iterations : MOST_COUNTED]++;
        t->iterations += report.iterations;
        t->rejected += report.rejected;
        t->count++;
        if (report.iterations >= LONG_STEP)
            printf("at %.4g s: %u iterations, %u parts, %u rejected\n", i * step, report.iterations, report.steps,
                   report.rejected);
    }
    return status;
}

static int kind_of(const char *name)
{
    if (strcmp(name, "D") == 0) return SCENE_B_COSINE;
    for (int i = 0; i < SCENE_COUNT; ++i)
        if (strcmp(name, scene_names[i]) == 0) return i;
    return SCENE_COUNT;
}

int main(int count, char **words)
{
    const int kind = count > 1 ? kind_of(words[1]) : SCENE_COUNT;
    if (kind == SCENE_COUNT) return fputs("usage: iterations B | B* | C | D | R | T [STEP END]\n", stderr), 2;
    const double step = count > 2 ? atof(words[2]) : 1e-3;
    const double end = count > 3 ? atof(words[3]) : strcmp(words[1], "D") == 0 ? 4.0 : 2.0;
    scene s = {.kind = kind, .pipes = kind == SCENE_T ? 20 : 100, .per_pipe = 1, .length = 1.0};
    dmb_sim *sim = NULL;
    static tally t;
    int32_t status = scene_open(&s);
    if (status >= 0) status = dmb_sim_create(s.model, NULL, &sim);
    if (status >= 0 && kind == SCENE_R) status = dmb_analysis_static(sim, NULL, NULL);
    if (status >= 0) status = walk(sim, step, end, &t);
    if (status < 0) fprintf(stderr, "iterations: %s\n", sim ? dmb_sim_message(sim) : dmb_status_text(status));
    printf("scene=%s dt=%g steps=%u iterations=%.4g rejected=%u", words[1], step, t.count,
           (double)t.iterations / (t.count ? t.count : 1), t.rejected);
    for (int i = 0; i <= MOST_COUNTED; ++i)
        if (t.steps[i] > 0) printf(" %d:%u", i, t.steps[i]);
    printf("\n");
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&s.model);
    return status < 0;
}
