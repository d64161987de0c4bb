/* The cost of derivatives along a run. usage: sensitivity CSV G [PARAMETERS SIDES [STEPS]]
 *
 * Scene G: scene B, the string that falls on its wall and turns, with the derivatives by its friction factor, taken as
 * 0, 1, 2 and 4 parameters at once, on both sides (2) or on the high side only (1). With PARAMETERS and SIDES one case
 * alone, after the given STEPS (200: the string bounces; 1000: it lies), so that its instructions can be counted:
 *     valgrind --tool=callgrind --toggle-collect=timed_steps build/release/tests/bench_sensitivity /dev/null G 1 2
 * less the same with 0 parameters, over the latter, are the steps a parameter costs. */
#define _POSIX_C_SOURCE 200809L

#include <stdio.h>

#include <drillmbd/analyse.h>

#include "scenes.h"

#include "row.h"

enum { MOST_PARAMETERS = 4, STEPS_BEFORE = 200, STEPS_TIMED = 100, REPEATS = 3, CASES = 7 };
#define SENSITIVITY_STEP 1e-3 /* [s] */
#define FRICTION_BESIDE 1e-4  /* [-] */

typedef struct ways {
    uint32_t parameters;
    int32_t sides;
} ways;

typedef struct three {
    scene at[3]; /* as it is, with less and with more friction */
    dmb_sim *sim[3];
    dmb_sensitivity *sensitivity;
} three;

static yardstick unit;
static result_table results;

static void close_three(three *t)
{
    dmb_sensitivity_destroy(&t->sensitivity);
    for (int i = 0; i < 3; i++) {
        dmb_sim_destroy(&t->sim[i]);
        dmb_model_destroy(&t->at[i].model);
    }
}

static int32_t open_three(three *t, const ways *w)
{
    dmb_parameter parameters[MOST_PARAMETERS];
    int32_t status = DMB_OK;
    memset(t, 0, sizeof *t);
    for (int i = 0; i < 3 && status >= 0; i++) {
        scene *s = &t->at[i];
        s->kind = SCENE_B;
        s->pipes = 100;
        s->per_pipe = 1;
        s->length = 1.0;
        s->friction = i == 0 ? 0.0 : i == 1 ? -FRICTION_BESIDE : FRICTION_BESIDE;
        status = scene_open(s);
        if (status >= 0) status = dmb_sim_create(s->model, NULL, &t->sim[i]);
    }
    for (uint32_t k = 0; k < w->parameters; k++) {
        parameters[k] = dmb_parameter_default();
        parameters[k].step = FRICTION_BESIDE;
        parameters[k].one_sided = w->sides == 1;
        parameters[k].low = t->sim[1];
        parameters[k].high = t->sim[2];
    }
    if (status < 0 || w->parameters == 0) return status;
    return dmb_sensitivity_create(t->sim[0], parameters, w->parameters, &t->sensitivity);
}

static int32_t go(three *t, int steps)
{
    int32_t status = DMB_OK;
    for (int k = 0; k < steps && status >= 0; k++)
        status = t->sensitivity != NULL ? dmb_sensitivity_step(t->sensitivity, SENSITIVITY_STEP, NULL)
                                        : dmb_sim_step(t->sim[0], SENSITIVITY_STEP, NULL);
    return status;
}

/* Not inline, so that callgrind finds it. */
__attribute__((noinline)) static int32_t timed_steps(three *t, double *seconds)
{
    const double begin = processor_time();
    const int32_t status = go(t, STEPS_TIMED);
    *seconds = (processor_time() - begin) / STEPS_TIMED;
    return status;
}

/* [s] a step, the median of some runs; < 0 after saying what failed. */
static double measure_case(const ways *w, int repeats, int before)
{
    double seconds[REPEATS];
    for (int i = 0; i < repeats; i++) {
        three t;
        int32_t status = open_three(&t, w);
        if (status >= 0) status = go(&t, before);
        if (status >= 0) status = timed_steps(&t, &seconds[i]);
        if (status < 0) row_failed("G", 100.0, "derivatives", dmb_status_name(status), dmb_sim_message(t.sim[0]));
        close_three(&t);
        if (status < 0) return -1.0;
    }
    return median(seconds, repeats);
}

static void put_row(const ways *w, double seconds, double plain)
{
    const head h = {
        "G",         100.0, SENSITIVITY_STEP, seconds, yardstick_value(&unit), SENSITIVITY_STEP / seconds, (double)NAN,
        (double)NAN, ""};
    result_row r;
    row_begin(&r, &h);
    row_number(&r, "parameters", w->parameters, 3);
    row_number(&r, "sides", w->sides, 1);
    row_number(&r, "steps_per_parameter", w->parameters ? (seconds / plain - 1.0) / w->parameters : (double)NAN, 3);
    row_put(&r, &results);
}

static int run_cases(void)
{
    static const ways cases[CASES] = {{0, 2}, {1, 2}, {2, 2}, {4, 2}, {1, 1}, {2, 1}, {4, 1}};
    double plain = 0.0;
    for (int i = 0; i < CASES; i++) {
        const double seconds = measure_case(&cases[i], REPEATS, STEPS_BEFORE);
        if (seconds < 0.0) return 1;
        if (i == 0) plain = seconds;
        put_row(&cases[i], seconds, plain);
    }
    return 0;
}

int main(int count, char **words)
{
    if (count < 3 || count == 4 || count > 6)
        return fputs("usage: sensitivity CSV G [PARAMETERS SIDES [STEPS]]\n", stderr), 2;
    if (count > 4) {
        const ways w = {(uint32_t)strtoul(words[3], NULL, 10), strcmp(words[4], "1") == 0 ? 1 : 2};
        if (w.parameters > MOST_PARAMETERS) return fputs("sensitivity: at most 4 parameters\n", stderr), 2;
        return measure_case(&w, 1, count > 5 ? atoi(words[5]) : STEPS_BEFORE) < 0.0;
    }
    if (table_open(&results, &unit, words[1]) != 0) return 2;
    const int failed = run_cases();
    return table_close(&results, words[1]) != 0 ? 2 : failed;
}
