/* Speed and error of steps. usage: bench CSV C|B|R Over elements, over pipes, over longer steps, growth, without the
 * ledger, the axial-torsional string, a long string on its wall, the whole rig cycle. */
#define _POSIX_C_SOURCE 200809L

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "measure.h"

enum { GROWTH_SIZES = 5, GROWTH_ROUNDS = 5 };

static yardstick unit;
static result_table results;
static int failures;

/* ---- One result ------------------------------------------------------------------------------------------------ */

/* The reference of an answer. */
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

static void put_outcome(const char *group, const scene *s, const method *how, const outcome *out, const reference *ref)
{
    char kinds[2][64] = {"", ""};
    result_row r;
    const int second = *quantity_names[s->kind][1] != 0;
    for (int i = 0; i <= second; ++i)
        snprintf(kinds[i], sizeof kinds[i], "%s_vs_%s", quantity_names[s->kind][i], ref->name);
    begin_outcome(&r, scene_names[s->kind], s->pipes * s->per_pipe, how, out, error_of(s, out, ref, 0), kinds[0]);
    row_number(&r, "error_2", second ? error_of(s, out, ref, 1) : (double)NAN, 3);
    row_word(&r, "error_2_kind", second ? kinds[1] : "-");
    row_word(&r, "group", group);
    row_number(&r, "pipes", s->pipes, 9);
    row_number(&r, "repeats", how->repeats, 3);
    row_number(&r, "bytes_per_element", s->bytes, 6);
    row_put(&r, &results);
}

static void report(const char *group, const scene *s, const method *how, const reference *ref)
{
    const outcome out = measure(s, how, &unit);
    failures += out.status < 0;
    if (out.status >= 0) put_outcome(group, s, how, &out, ref);
}

/* ---- References ------------------------------------------------------------------------------------------------ */

/* The same scene on the same mesh with a step of `step`. */
static reference fine_steps(const scene *s, double step, double horizon, const char *name)
{
    method how = method_fixed(step, horizon);
    how.ledger = 0;
    how.repeats = 1;
    const outcome out = measure(s, &how, &unit);
    reference ref = {{out.values[0], out.values[1]}, name};
    if (out.status < 0) ref.values[0] = ref.values[1] = (double)NAN;
    return ref;
}

static reference exact(const scene *s, double horizon)
{
    const reference ref = {{exact_tip_speed(s->pipes * s->length, horizon), 0.0}, "exact"};
    return ref;
}

static reference answer_of(const scene *s, double horizon, double step, const char *name)
{
    return s->kind == SCENE_C ? exact(s, horizon) : fine_steps(s, step, horizon, name);
}

/* ---- The plan -------------------------------------------------------------------------------------------------- */

static int open_or_say(scene *s, int kind, uint32_t pipes, uint32_t per_pipe)
{
    const scene described = {.kind = kind, .pipes = pipes, .per_pipe = per_pipe, .length = 1.0};
    *s = described;
    const int32_t status = scene_open(s);
    if (status >= 0) return 1;
    row_failed(scene_names[kind], pipes * per_pipe, "compile", dmb_status_name(status), dmb_model_message(s->model));
    dmb_model_destroy(&s->model);
    ++failures;
    return 0;
}

/* 100 m in more and more elements, at 1 ms. C is asked at its end. B and R are asked early, where their motion still
 * follows from their start: chatter on the wall makes later states differ from step size to step size. */
static void over_elements(int kind)
{
    static const uint32_t per_pipe[] = {1, 2, 4, 10};
    for (size_t i = 0; i < sizeof per_pipe / sizeof *per_pipe; ++i) {
        method how = method_fixed(1e-3, kind == SCENE_C ? 2.0 : kind == SCENE_B ? 0.1 : 0.5);
        scene s;
        how.end = kind == SCENE_R ? 0.5 : 2.0;
        if (per_pipe[i] <= 2) how.repeats = 5;
        if (!open_or_say(&s, kind, 100, per_pipe[i])) continue;
        const reference ref = answer_of(&s, how.horizon, 0.125e-3, "dt/8");
        report("elements", &s, &how, &ref);
        if (per_pipe[i] == 1) {
            how.ledger = 0;
            report("ledger", &s, &how, &ref);
        }
        dmb_model_destroy(&s.model);
    }
}

/* 100 m again with longer steps, each beside its error: what a second costs at the error that shorter ones had. */
static void over_steps(int kind)
{
    static const double steps[] = {0.1 / 71, 2e-3};
    const double horizon = kind == SCENE_R ? 0.5 : 0.1;
    scene s;
    if (!open_or_say(&s, kind, 100, 1)) return;
    const reference ref = answer_of(&s, horizon, 0.125e-3, "dt/8_of_1_ms");
    for (size_t i = 0; i < sizeof steps / sizeof *steps; ++i) {
        method how = method_fixed(steps[i], horizon);
        how.end = kind == SCENE_R ? 0.5 : 2.0;
        report("steps", &s, &how, &ref);
    }
    dmb_model_destroy(&s.model);
}

/* 1000 pipes of 1 m on the wall of their hole, with steps of 1 and 2 ms; asked when the turning has reached the tip. */
static void long_string(void)
{
    static const double steps[] = {1e-3, 2e-3};
    scene s;
    if (!open_or_say(&s, SCENE_B, 1000, 1)) return;
    const reference ref = answer_of(&s, 0.5, 0.125e-3, "dt/8_of_1_ms");
    for (size_t i = 0; i < sizeof steps / sizeof *steps; ++i) {
        method how = method_fixed(steps[i], 0.5);
        how.end = 1.0;
        report("long", &s, &how, &ref);
    }
    dmb_model_destroy(&s.model);
}

/* More and more pipes of 1 m, at 1 ms. */
static void over_pipes(int kind)
{
    static const uint32_t pipes[] = {25, 50, 100, 200, 400};
    for (size_t i = 0; i < sizeof pipes / sizeof *pipes; ++i) {
        method how = method_fixed(1e-3, kind == SCENE_R ? 0.5 : 2.0);
        scene s;
        if (kind == SCENE_R) how.end = 3.0;
        if (!open_or_say(&s, kind, pipes[i], 1)) continue;
        const reference ref = answer_of(&s, how.horizon, 0.125e-3, "dt/8");
        report("pipes", &s, &how, &ref);
        dmb_model_destroy(&s.model);
    }
}

/* The medians over the rounds of one size. */
static outcome median_of_rounds(const outcome *rounds)
{
    double seconds[GROWTH_ROUNDS], units[GROWTH_ROUNDS];
    outcome out = rounds[0];
    for (int i = 0; i < GROWTH_ROUNDS; ++i) {
        seconds[i] = rounds[i].seconds;
        units[i] = rounds[i].yardstick;
    }
    out.seconds = median(seconds, GROWTH_ROUNDS);
    out.spread = (seconds[GROWTH_ROUNDS - 1] - seconds[0]) / out.seconds;
    out.yardstick = median(units, GROWTH_ROUNDS);
    return out;
}

/* The same stretch of the same scene in more and more elements. The sizes take turns, so that what slows the machine
 * down for a while does so for all of them. */
static void over_sizes(int kind)
{
    static const uint32_t per_pipe[GROWTH_SIZES] = {1, 2, 4, 10, 100};
    static const int repeats[GROWTH_SIZES] = {5, 5, 3, 2, 1};
    static scene scenes[GROWTH_SIZES];
    static outcome outcomes[GROWTH_SIZES][GROWTH_ROUNDS];
    int32_t status = DMB_OK;
    method how = method_fixed(1e-3, kind == SCENE_R ? 0.02 : 0.1);
    for (int i = 0; i < GROWTH_SIZES; ++i)
        if (!open_or_say(&scenes[i], kind, 100, per_pipe[i])) status = DMB_ERR_VALUE;
    for (int k = 0; k < GROWTH_ROUNDS; ++k)
        for (int i = 0; i < GROWTH_SIZES && status >= 0; ++i) {
            how.repeats = repeats[i];
            outcomes[i][k] = measure(&scenes[i], &how, &unit);
            status = outcomes[i][k].status;
            failures += status < 0;
        }
    for (int i = 0; i < GROWTH_SIZES; ++i) {
        const reference ref = answer_of(&scenes[i], how.horizon, 0.5e-3, "dt/2");
        const outcome out = median_of_rounds(outcomes[i]);
        how.repeats = repeats[i] * GROWTH_ROUNDS;
        if (status >= 0) put_outcome("growth", &scenes[i], &how, &out, &ref);
        dmb_model_destroy(&scenes[i].model);
    }
}

/* C with pipes that stretch and twist only: the same answer. */
static void axial_torsional(void)
{
    const method how = {1e-3, 0.0, 0.8, 2.0, 2.0, 1, 5};
    scene s = {.kind = SCENE_C, .pipes = 100, .per_pipe = 1, .length = 1.0, .pipe_kind = DMB_PIPE_AXIAL_TORSIONAL};
    if (scene_open(&s) >= 0) {
        const reference ref = exact(&s, how.horizon);
        report("axial_torsional", &s, &how, &ref);
    } else
        ++failures;
    dmb_model_destroy(&s.model);
}

/* R to its end. */
static void whole_cycle(void)
{
    method how = method_fixed(1e-3, 0.5);
    scene s;
    how.end = 40.0;
    if (!open_or_say(&s, SCENE_R, 100, 1)) return;
    const reference ref = fine_steps(&s, 0.125e-3, how.horizon, "dt/8");
    report("cycle", &s, &how, &ref);
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
        const method how = method_fixed(steps[i], 2.0);
        report("given", &s, &how, &ref);
    }
    dmb_model_destroy(&s.model);
}

int main(int count, char **words)
{
    const char *const name = count == 3 ? words[2] : "";
    const int kind = strcmp(name, "C") == 0 ? SCENE_C : strcmp(name, "B") == 0 ? SCENE_B : SCENE_R;
    if (kind == SCENE_R && strcmp(name, "R") != 0) return fputs("usage: bench CSV C|B|R\n", stderr), 2;
    if (table_open(&results, &unit, words[1]) != 0) return 2;
    over_elements(kind);
    over_sizes(kind);
    if (kind == SCENE_C) axial_torsional();
    if (kind != SCENE_C) over_steps(kind);
    if (kind == SCENE_B) {
        against_given_figures();
        long_string();
    } else {
        over_pipes(kind);
    }
    if (kind == SCENE_R) whole_cycle();
    if (table_close(&results, words[1]) != 0) return 2;
    return failures > 0;
}
