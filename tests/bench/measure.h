/* Runs a scene, times it, and keeps what it answered. */
#ifndef BENCH_MEASURE_H
#define BENCH_MEASURE_H

#include "answers.h"
#include "method.h"
#include "row.h"

enum { MEASURE_MOST_REPEATS = 5 };

typedef struct outcome {
    int32_t status;    /* DMB_... */
    double seconds;    /* [s] of processor time, median */
    double spread;     /* [-] largest less smallest time over the median */
    double yardstick;  /* [s] U */
    double steps;      /* [-] */
    double iterations; /* [-] a step, those of rejected steps included */
    double rejected;   /* [-] */
    double values[2];  /* at the horizon */
    double balance; /* [-] what the energy ledger leaves open at the end, over what drives, loads and gravity put in */
} outcome;

/* The gap in the ledger over the energy that went in. Scene B falls on its wall: the work of gravity counts too. */
static int32_t check_ledger(const dmb_sim *sim, const dmb_energy *start, outcome *out)
{
    dmb_energy energy = dmb_energy_default();
    const int32_t status = dmb_query_energy(sim, &energy);
    out->balance = fabs(energy.balance) / (energy.input + fabs(energy.gravity - start->gravity));
    return status;
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
    if (status < 0) {
        char what[64];
        snprintf(what, sizeof what, "dt=%g tolerance=%g time=%g", how->step, how->tolerance, dmb_sim_time(sim));
        row_failed(scene_names[s->kind], s->pipes * s->per_pipe, what, dmb_status_name(status), dmb_sim_message(sim));
    }
    return status;
}

/* All repeats of a scene that scene_open has made. */
static outcome measure(const scene *s, const method *how, yardstick *y)
{
    double seconds[MEASURE_MOST_REPEATS];
    const dmb_sim_options options = options_of(how);
    outcome out;
    memset(&out, 0, sizeof out);
    yardstick_anew(y);
    for (int i = 0; i < how->repeats && out.status >= 0; ++i) {
        dmb_sim *sim = NULL;
        out.status = dmb_sim_create(s->model, &options, &sim);
        if (out.status >= 0) out.status = run_once(s, sim, how, &out, &seconds[i]);
        dmb_sim_destroy(&sim);
        for (int k = 0; k < 3; ++k) yardstick_measure(y);
    }
    if (out.status < 0) return out;
    out.seconds = median(seconds, how->repeats);
    out.spread = (seconds[how->repeats - 1] - seconds[0]) / out.seconds;
    out.yardstick = yardstick_value(y);
    return out;
}

/* The part of a row that every outcome has. */
static inline void begin_outcome(result_row *r, const char *name, double elements, const method *how,
                                 const outcome *out, double error, const char *error_kind)
{
    const head h = {name,
                    elements,
                    how->step > 0.0 ? how->step : how->end / out->steps,
                    out->seconds / out->steps,
                    out->yardstick,
                    how->end / out->seconds,
                    out->iterations,
                    error,
                    error_kind};
    row_begin(r, &h);
    row_number(r, "spread", out->spread, 3);
    row_number(r, "U_us", 1e6 * out->yardstick, 4);
    row_number(r, "end", how->end, 4);
    row_number(r, "steps", out->steps, 9);
    row_number(r, "rejected", out->rejected, 6);
    row_number(r, "balance", how->ledger ? out->balance : (double)NAN, 3);
}

#endif
