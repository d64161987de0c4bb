/* Runs a scene, times it, and keeps what it answered. */
#ifndef BENCH_MEASURE_H
#define BENCH_MEASURE_H

#include <stdio.h>

#include "scenes.h"
#include "yardstick.h"

enum { MEASURE_MOST_REPEATS = 5 };

typedef struct method {
    double step;      /* [s] fixed; 0: error-controlled */
    double tolerance; /* [rad] of a step, a tenth of it in metres; error-controlled only */
    double horizon;   /* [s] where the answers are taken */
    double end;       /* [s] of the timed run, >= horizon */
    int ledger;
    int repeats;
} method;

typedef struct outcome {
    int32_t status;    /* DMB_... */
    double seconds;    /* [s] of processor time, median */
    double spread;     /* [-] largest less smallest time over the median */
    double yardstick;  /* [s] U */
    double steps;      /* [-] */
    double iterations; /* [-] a step, those of rejected steps included */
    double rejected;   /* [-] */
    double values[2];  /* at the horizon */
    double balance;    /* [-] what the energy ledger leaves open at the end, over what drives, loads and gravity put in */
} outcome;

static int32_t go_to(dmb_sim *sim, const method *how, double time)
{
    int32_t status = DMB_OK;
    if (how->step <= 0.0) return dmb_sim_advance(sim, time, NULL);
    const double first = floor(dmb_sim_time(sim) / how->step + 0.5), last = floor(time / how->step + 0.5);
    for (double k = first + 1.0; status >= 0 && k <= last; k += 1.0)
        status = dmb_sim_step(sim, k * how->step - dmb_sim_time(sim), NULL);
    return status;
}

/* What the ledger leaves open over the energy that went in. Scene B falls on its wall: what gravity gave counts too. */
static int32_t check_ledger(const dmb_sim *sim, const dmb_energy *start, outcome *out)
{
    dmb_energy energy = dmb_energy_default();
    const int32_t status = dmb_query_energy(sim, &energy);
    out->balance = fabs(energy.balance) / (energy.input + fabs(energy.gravity - start->gravity));
    return status;
}

static dmb_sim_options options_of(const method *how)
{
    dmb_sim_options options = dmb_sim_options_default();
    options.energy_ledger = how->ledger;
    if (how->step <= 0.0) {
        options.tolerance_rotation = how->tolerance;
        options.tolerance_translation = 0.1 * how->tolerance;
    }
    return options;
}

/* One timed run from time 0, statics and creation left out. */
static int32_t run_once(const scene *s, dmb_sim *sim, const method *how, outcome *out, double *seconds)
{
    dmb_statistics before = dmb_statistics_default(), after = dmb_statistics_default();
    dmb_energy start = dmb_energy_default();
    int32_t status = s->kind == SCENE_R ? dmb_analysis_static(sim, NULL, NULL) : DMB_OK;
    if (status >= 0) status = dmb_query_statistics(sim, &before);
    if (status >= 0 && how->ledger) status = dmb_query_energy(sim, &start);
    double begin = processor_time();
    if (status >= 0) status = go_to(sim, how, how->horizon);
    *seconds = processor_time() - begin;
    if (status >= 0) status = scene_ask(s, sim, out->values);
    begin = processor_time();
    if (status >= 0 && how->end > how->horizon) status = go_to(sim, how, how->end);
    *seconds += processor_time() - begin;
    if (status >= 0) status = dmb_query_statistics(sim, &after);
    if (status >= 0 && how->ledger) status = check_ledger(sim, &start, out);
    out->steps = (double)(after.steps - before.steps);
    out->rejected = (double)(after.rejected - before.rejected);
    out->iterations = (double)(after.iterations - before.iterations) / fmax(1.0, out->steps);
    if (status < 0)
        fprintf(stderr, "bench: scene %s, %g s: %s: %s\n", scene_names[s->kind], dmb_sim_time(sim),
                dmb_status_text(status), dmb_sim_message(sim));
    return status;
}

/* All repeats of a scene that scene_open has made. */
static outcome measure(const scene *s, const method *how, yardstick *y)
{
    double seconds[MEASURE_MOST_REPEATS];
    const dmb_sim_options options = options_of(how);
    outcome out;
    memset(&out, 0, sizeof out);
    for (int i = 0; i < how->repeats && out.status >= 0; ++i) {
        dmb_sim *sim = NULL;
        out.status = dmb_sim_create(s->model, &options, &sim);
        if (out.status >= 0) out.status = run_once(s, sim, how, &out, &seconds[i]);
        dmb_sim_destroy(&sim);
        yardstick_measure(y);
    }
    if (out.status < 0) return out;
    out.seconds = median(seconds, how->repeats);
    out.spread = (seconds[how->repeats - 1] - seconds[0]) / out.seconds;
    out.yardstick = yardstick_value(y);
    return out;
}

#endif
