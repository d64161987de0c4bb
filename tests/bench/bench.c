/* How fast, at what error. usage: bench CSV [C] [B] [R]   (default: all scenes)
 * Prints one line a result and writes the same, with more columns, into the file CSV. tests/bench/run calls it. */
#define _POSIX_C_SOURCE 200809L

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "measure.h"

static yardstick unit;
static FILE *table;
static int failures;

/* ---- One result ---------------------------------------------------------------------------------------------------- */

/* What an answer is held against. */
typedef struct reference {
    double values[2];
    const char *name; /* "exact", "dt/8" ... */
} reference;

/* [-] relative; but a position in its own unit: it may be near 0. */
static double error_of(const scene *s, const outcome *out, const reference *ref, int i)
{
    const double difference = fabs(out->values[i] - ref->values[i]);
    return strstr(quantity_names[s->kind][i], "_mm") ? difference : difference / fabs(ref->values[i]);
}

static const char *const columns =
    "group,scene,pipes,elements,method,dt,tolerance,ledger,end,steps,us_per_step,spread,U_us,U_per_step,"
    "us_per_simulated_second,U_per_simulated_second,rtf,iterations,rejected,error,error_kind,error_2,error_2_kind,balance,"
    "bytes_per_element";

static void write_row(const char *group, const scene *s, const method *how, const outcome *out, const reference *ref)
{
    const double us = 1e6 * out->seconds, u = 1e6 * out->yardstick;
    const char *const second = quantity_names[s->kind][1];
    fprintf(table, "%s,%s,%u,%u,%s,%g,%g,%d,%g,%.0f,", group, scene_names[s->kind], (unsigned)s->pipes,
            (unsigned)(s->pipes * s->per_pipe), how->step > 0.0 ? "fixed" : "controlled", how->step, how->tolerance,
            how->ledger, how->end, out->steps);
    fprintf(table, "%.5g,%.3g,%.4g,%.5g,%.6g,%.6g,%.5g,%.4g,%.0f,", us / out->steps, out->spread, u, us / out->steps / u,
            us / how->end, us / how->end / u, how->end / out->seconds, out->iterations, out->rejected);
    fprintf(table, "%.4g,%s_vs_%s,", error_of(s, out, ref, 0), quantity_names[s->kind][0], ref->name);
    if (*second) fprintf(table, "%.4g,%s_vs_%s,", error_of(s, out, ref, 1), second, ref->name);
    else fputs(",,", table);
    if (how->ledger) fprintf(table, "%.4g", out->balance);
    fprintf(table, ",%.0f\n", s->bytes);
    fflush(table);
}

static void print_line(const scene *s, const method *how, const outcome *out, const reference *ref)
{
    const double us = 1e6 * out->seconds;
    const char *const second = quantity_names[s->kind][1];
    printf("scene=%s elements=%u ", scene_names[s->kind], (unsigned)(s->pipes * s->per_pipe));
    if (how->step > 0.0) printf("dt=%g ", how->step);
    else printf("tolerance=%g ", how->tolerance);
    printf("us_per_step=%.4g spread=%.2g U_per_step=%.3g rtf=%.4g iterations=%.3g ", us / out->steps, out->spread,
           out->seconds / out->steps / out->yardstick, how->end / out->seconds, out->iterations);
    printf("error=%.2e error_kind=%s_vs_%s ", error_of(s, out, ref, 0), quantity_names[s->kind][0], ref->name);
    if (*second) printf("error_2=%.2e error_2_kind=%s_vs_%s ", error_of(s, out, ref, 1), second, ref->name);
    if (how->ledger) printf("balance=%.1e ", out->balance);
    else printf("balance=off ");
    printf("steps=%.0f rejected=%.0f end=%g bytes_per_element=%.0f\n", out->steps, out->rejected, how->end, s->bytes);
    fflush(stdout);
}

static void report(const char *group, const scene *s, const method *how, const reference *ref)
{
    const outcome out = measure(s, how, &unit);
    if (out.status < 0) {
        printf("scene=%s elements=%u dt=%g tolerance=%g failed=%s\n", scene_names[s->kind],
               (unsigned)(s->pipes * s->per_pipe), how->step, how->tolerance, dmb_status_name(out.status));
        ++failures;
        return;
    }
    print_line(s, how, &out, ref);
    write_row(group, s, how, &out, ref);
}

/* ---- References ---------------------------------------------------------------------------------------------------- */

/* The same scene on the same mesh with a step of `step`. */
static reference fine_steps(const scene *s, double step, double horizon, const char *name)
{
    const method how = {step, 0.0, horizon, horizon, 0, 1};
    const outcome out = measure(s, &how, &unit);
    reference ref = {{out.values[0], out.values[1]}, name};
    if (out.status < 0) ref.values[0] = ref.values[1] = (double)NAN;
    return ref;
}

/* Two small steps, extrapolated for a method of second order. */
static reference richardson(const scene *s, double step, double horizon)
{
    const reference coarse = fine_steps(s, 2.0 * step, horizon, ""), fine = fine_steps(s, step, horizon, "");
    reference ref = {{0.0, 0.0}, "richardson"};
    for (int i = 0; i < 2; ++i) ref.values[i] = (4.0 * fine.values[i] - coarse.values[i]) / 3.0;
    return ref;
}

static reference exact(const scene *s, double horizon)
{
    const reference ref = {{exact_tip_speed(s->pipes * s->length, horizon), 0.0}, "exact"};
    return ref;
}

/* ---- The plan ------------------------------------------------------------------------------------------------------ */

static int open_or_say(scene *s, int kind, uint32_t pipes, uint32_t per_pipe)
{
    s->kind = kind;
    s->pipes = pipes;
    s->per_pipe = per_pipe;
    s->length = 1.0;
    const int32_t status = scene_open(s);
    if (status >= 0) return 1;
    fprintf(stderr, "bench: scene %s: %s: %s\n", scene_names[kind], dmb_status_text(status), dmb_model_message(s->model));
    dmb_model_destroy(&s->model);
    ++failures;
    return 0;
}

/* 100 m in more and more elements, at 1 ms. C is asked at its end. B and R are asked early, where their motion still
 * follows from their start: chatter on the wall makes later states differ from step size to step size. */
static void over_elements(int kind)
{
    static const uint32_t per_pipe[] = {1, 2, 4, 10, 100};
    for (size_t i = 0; i < sizeof per_pipe / sizeof *per_pipe; ++i) {
        const int huge = per_pipe[i] >= 100;
        method how = {1e-3, 0.0, 2.0, 2.0, 1, per_pipe[i] <= 2 ? 5 : 2};
        scene s;
        if (kind == SCENE_B) how.horizon = 0.1;
        if (kind == SCENE_R) how.horizon = 0.5, how.end = per_pipe[i] == 1 ? 3.0 : 0.5;
        if (huge) how.horizon = how.end = kind == SCENE_R ? 0.02 : 0.06;
        if (!open_or_say(&s, kind, 100, per_pipe[i])) continue;
        const reference ref = kind == SCENE_C ? exact(&s, how.horizon)
                              : huge          ? fine_steps(&s, 0.5e-3, how.horizon, "dt/2")
                                              : fine_steps(&s, 0.125e-3, how.horizon, "dt/8");
        report("elements", &s, &how, &ref);
        if (per_pipe[i] == 1) {
            how.ledger = 0;
            report("ledger", &s, &how, &ref);
        }
        dmb_model_destroy(&s.model);
    }
}

/* More and more pipes of 1 m, at 1 ms. */
static void over_pipes(int kind)
{
    static const uint32_t pipes[] = {25, 50, 100, 200, 400};
    for (size_t i = 0; i < sizeof pipes / sizeof *pipes; ++i) {
        method how = {1e-3, 0.0, 2.0, 2.0, 1, pipes[i] <= 100 ? 3 : 2};
        scene s;
        if (kind == SCENE_R) how.horizon = 0.5, how.end = 3.0;
        if (!open_or_say(&s, kind, pipes[i], 1)) continue;
        const reference ref = kind == SCENE_C ? exact(&s, how.horizon) : fine_steps(&s, 0.125e-3, how.horizon, "dt/8");
        report("pipes", &s, &how, &ref);
        dmb_model_destroy(&s.model);
    }
}

/* Work against error: fixed steps 4 ms .. 0.125 ms and error control, on 100 elements. */
static void over_accuracy(int kind)
{
    const double horizon = kind == SCENE_C ? 2.0 : kind == SCENE_B ? 0.1 : 0.5;
    scene s;
    if (!open_or_say(&s, kind, 100, 1)) return;
    const reference ref = kind == SCENE_C ? richardson(&s, 3.125e-5, horizon)
                                          : fine_steps(&s, 1.5625e-5, horizon, "15.625us");
    for (double step = 4e-3; step > 1.2e-4; step *= 0.5) {
        const method how = {step, 0.0, horizon, horizon, 1, step > 4e-4 ? 5 : 2};
        report("work", &s, &how, &ref);
    }
    for (int power = 4; power <= 8; ++power) {
        const method how = {0.0, pow(10.0, -power), horizon, horizon, 1, 2};
        report("work", &s, &how, &ref);
    }
    dmb_model_destroy(&s.model);
}

/* B against figures found elsewhere with small steps of other programs. */
static void against_given_figures(void)
{
    static const double steps[] = {1e-3, 2.5e-4};
    const reference ref = {{9.3755, 10.115e3}, "given"};
    scene s;
    if (!open_or_say(&s, SCENE_B_COSINE, 100, 1)) return;
    for (size_t i = 0; i < sizeof steps / sizeof *steps; ++i) {
        const method how = {steps[i], 0.0, 2.0, 2.0, 1, 2};
        report("given", &s, &how, &ref);
    }
    dmb_model_destroy(&s.model);
}

static void run_scene(int kind)
{
    over_elements(kind);
    over_accuracy(kind);
    if (kind == SCENE_B) against_given_figures();
    else over_pipes(kind);
}

static int is_wanted(const char *name, int count, char **words)
{
    for (int i = 2; i < count; ++i)
        if (strcmp(words[i], name) == 0) return 1;
    return count <= 2;
}

static int are_known(int count, char **words)
{
    for (int i = 2; i < count; ++i)
        if (strlen(words[i]) != 1 || !strchr("CBR", words[i][0])) return 0;
    return 1;
}

int main(int count, char **words)
{
    static const int kinds[] = {SCENE_C, SCENE_B, SCENE_R};
    if (count < 2 || !are_known(count, words)) return fputs("usage: bench CSV [C] [B] [R]\n", stderr), 2;
    table = fopen(words[1], "w");
    if (!table) return perror(words[1]), 2;
    fprintf(table, "%s\n", columns);
    yardstick_open(&unit);
    for (int i = 0; i < 25; ++i) yardstick_measure(&unit);
    printf("U=%.4g us: dpbtrf + dpbtrs, n = %d, half band %d, one thread\n", 1e6 * yardstick_value(&unit), YARDSTICK_N,
           YARDSTICK_BAND);
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; ++i)
        if (is_wanted(scene_names[kinds[i]], count, words)) run_scene(kinds[i]);
    if (fclose(table) != 0) return perror(words[1]), 2;
    return failures > 0;
}
