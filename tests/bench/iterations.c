/* Iterations of the steps of a long run. usage: iterations SCENE [STEP END [TOLERANCE [LEAST]]]
 *     SCENE: B, B*, C, R or T; D: B* for 4 s
 *
 * One line for the run: the answers at its end, steps by their iterations, those of rejected attempts counted; before
 * it the longest, with where they are. Counts repeat exactly, times do not: the work of a run by
 * `valgrind --tool=callgrind`, in the function counted_step. With LEAST those steps alone are made there that take so
 * many iterations at least, which a run before tells. tests/bench/counts calls it. */
#include <stdio.h>
#include <stdlib.h>

#include "scenes.h"

#include "answers.h"

enum { MOST_COUNTED = 60, LONG_STEP = 7 };

typedef struct tally {
    unsigned steps[MOST_COUNTED + 1], iterations, rejected, count;
} tally;

/* The place where callgrind counts; calls through it are not inlined. */
__attribute__((noinline)) static int32_t counted_step(dmb_sim *sim, double step, dmb_step_report *report)
{
    return dmb_sim_step(sim, step, report);
}

typedef struct course {
    double step, end, tolerance;
    unsigned least;  /* [-] iterations of a step that is counted */
    unsigned *known; /* [-] iterations of each step, where a run before has told */
} course;

static unsigned count_steps(const course *c)
{
    return (unsigned)(c->end / c->step + 0.5);
}

static int32_t make_step(const course *c, unsigned i, dmb_sim *sim, dmb_step_report *report)
{
    const double duration = i * c->step - dmb_sim_time(sim);
    if (c->known && c->known[i - 1] < c->least) return dmb_sim_step(sim, duration, report);
    if (c->known) printf("counted at %.4g s: %u iterations\n", i * c->step, c->known[i - 1]);
    return counted_step(sim, duration, report);
}

static int32_t walk(dmb_sim *sim, const course *c, tally *t)
{
    const double step = c->step;
    int32_t status = DMB_OK;
    for (unsigned i = 1; i <= count_steps(c) && status >= 0; ++i) {
        dmb_step_report report = dmb_step_report_default();
        status = make_step(c, i, sim, &report);
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

/* Iterations of every step, without a count of instructions. */
static int32_t look_ahead(const scene *s, const dmb_sim_options *options, course *c)
{
    const unsigned steps = count_steps(c);
    dmb_sim *sim = NULL;
    c->known = malloc((steps > 0 ? steps : 1) * sizeof *c->known);
    int32_t status = c->known ? dmb_sim_create(s->model, options, &sim) : DMB_ERR_NO_MEMORY;
    if (status >= 0 && s->kind == SCENE_R) status = dmb_analysis_static(sim, NULL, NULL);
    for (unsigned i = 1; i <= steps && status >= 0; ++i) {
        dmb_step_report report = dmb_step_report_default();
        status = dmb_sim_step(sim, i * c->step - dmb_sim_time(sim), &report);
        c->known[i - 1] = report.iterations;
    }
    dmb_sim_destroy(&sim);
    return status;
}

static int32_t run(scene *s, course *c, const char *name)
{
    static tally t;
    dmb_sim_options options = dmb_sim_options_default();
    dmb_sim *sim = NULL;
    double answers[2] = {0.0, 0.0};
    options.newton_tolerance = c->tolerance;
    int32_t status = scene_open(s);
    if (status >= 0 && c->least > 0) status = look_ahead(s, &options, c);
    if (status >= 0) status = dmb_sim_create(s->model, &options, &sim);
    if (status >= 0 && s->kind == SCENE_R) status = dmb_analysis_static(sim, NULL, NULL);
    if (status >= 0) status = walk(sim, c, &t);
    if (status >= 0) status = scene_ask(s, sim, answers);
    if (status < 0) fprintf(stderr, "iterations: %s\n", sim ? dmb_sim_message(sim) : dmb_status_text(status));
    printf("scene=%s dt=%g tolerance=%g answer=%.15g answer_2=%.15g steps=%u iterations=%.4g rejected=%u", name,
           c->step, c->tolerance, answers[0], answers[1], t.count, (double)t.iterations / (t.count ? t.count : 1),
           t.rejected);
    for (int i = 0; i <= MOST_COUNTED; ++i)
        if (t.steps[i] > 0) printf(" %d:%u", i, t.steps[i]);
    if (s->kind == SCENE_C)
        printf(" error=%.2e", fabs(answers[0] / exact_tip_speed(s->pipes * s->length, c->end) - 1.0));
    printf("\n");
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&s->model);
    free(c->known);
    return status;
}

int main(int count, char **words)
{
    const int kind = count > 1 ? kind_of(words[1]) : SCENE_COUNT;
    if (kind == SCENE_COUNT)
        return fputs("usage: iterations B | B* | C | D | R | T [STEP END [TOLERANCE [LEAST]]]\n", stderr), 2;
    scene s = {.kind = kind, .pipes = kind == SCENE_T ? 20 : 100, .per_pipe = 1, .length = 1.0};
    course c = {1e-3, strcmp(words[1], "D") == 0 ? 4.0 : 2.0, 0.0, 0, NULL};
    if (count > 2) c.step = atof(words[2]);
    if (count > 3) c.end = atof(words[3]);
    if (count > 4) c.tolerance = atof(words[4]);
    if (count > 5) c.least = (unsigned)strtoul(words[5], NULL, 10);
    return run(&s, &c, words[1]) < 0;
}
