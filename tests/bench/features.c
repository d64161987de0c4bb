/* What a single step costs, and what a scene costs. usage: features CSV D|F
 *
 * Scene D: step times of a control loop: every step of scene B* timed by itself, as many iterations as it takes and
 * with bounded work. Scene F: one rig described once, compiled with less and with more of it: what is left out is to
 * cost nothing. tests/bench/run calls it. */
#define _POSIX_C_SOURCE 200809L

#include <stdio.h>
#include <string.h>

#include "measure.h"

#define FEATURES_STEP 1e-3    /* [s] */
#define GIVEN_ROTATION 9.3755 /* [rad] of the tip of B*, 2 s, from elsewhere */
#define BIT_AS_PIPE 0.5       /* [m] of pipe with the polar moment of inertia of the bit of scene F */

enum { LOOP_STEPS = 4000, LOOP_ASK = 2000, LOOP_REPEATS = 5, LOOP_WAYS = 5, RIG_PIPES = 100, RIG_REPEATS = 3 };

static yardstick unit;
static FILE *table;

/* U of now: the machine's clock may change within the process. */
static void yardstick_anew(void)
{
    unit.measures = 0;
    for (int i = 0; i < 5; ++i) yardstick_measure(&unit);
}

/* ---- One result ----------------------------------------------------------------------------------------------------
 */

typedef struct field {
    const char *name, *text; /* text NULL: the value */
    double value;            /* NaN: not there */
    int digits;
} field;

static field number(const char *name, double value, int digits)
{
    const field f = {name, NULL, value, digits};
    return f;
}

static field word(const char *name, const char *text)
{
    const field f = {name, text, 0.0, 0};
    return f;
}

/* A line "name=value ...", and the same as a row of the table. */
static void put_row(const field *fields, int count)
{
    static int rows;
    for (int i = 0; rows == 0 && i < count; ++i) fprintf(table, "%s%c", fields[i].name, i + 1 < count ? ',' : '\n');
    ++rows;
    for (int i = 0; i < count; ++i) {
        const field *const f = fields + i;
        if (f->text)
            printf("%s=%s ", f->name, f->text), fputs(f->text, table);
        else if (!isnan(f->value))
            printf("%s=%.*g ", f->name, f->digits, f->value), fprintf(table, "%.*g", f->digits, f->value);
        fputc(i + 1 < count ? ',' : '\n', table);
    }
    putchar('\n');
    fflush(stdout);
    fflush(table);
}

/* ---- D: a control loop ---------------------------------------------------------------------------------------------
 */

typedef struct way {
    const char *name;
    int32_t bounded;
    uint32_t most; /* [-] iterations */
} way;

/* Every repeat does the same steps. */
typedef struct loop {
    double cpu[LOOP_STEPS][LOOP_REPEATS];   /* [s] */
    double wall[LOOP_REPEATS * LOOP_STEPS]; /* [s] */
    dmb_step_report reports[LOOP_STEPS];
    double residual[LOOP_STEPS]; /* [-] */
    double answers[2];           /* rotation and wall force after LOOP_ASK steps */
    double end_rotation;         /* [rad] */
    double balance;              /* [-] */
    dmb_statistics statistics;
} loop;

/* [s] */
static double wall_time(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static int32_t timed_step(dmb_sim *sim, loop *l, int repeat, int k)
{
    const double duration = (k + 1) * FEATURES_STEP - dmb_sim_time(sim);
    l->reports[k] = dmb_step_report_default();
    const double wall = wall_time(), cpu = processor_time();
    const int32_t status = dmb_sim_step(sim, duration, &l->reports[k]);
    l->cpu[k][repeat] = processor_time() - cpu;
    l->wall[repeat * LOOP_STEPS + k] = wall_time() - wall;
    l->residual[k] = l->reports[k].residual;
    return status;
}

static int32_t ask_at_end(const scene *s, const dmb_sim *sim, loop *l)
{
    const dmb_energy start = dmb_energy_default(); /* gravity 0 at time 0 as described */
    double answers[2];
    outcome out;
    l->statistics = dmb_statistics_default();
    int32_t status = scene_ask(s, sim, answers);
    l->end_rotation = answers[0];
    if (status >= 0) status = check_ledger(sim, &start, &out);
    l->balance = status < 0 ? (double)NAN : out.balance;
    return status < 0 ? status : dmb_query_statistics(sim, &l->statistics);
}

static int32_t run_loop(const scene *s, const way *w, int repeat, loop *l)
{
    dmb_sim_options options = dmb_sim_options_default();
    dmb_sim *sim = NULL;
    options.bounded_work = w->bounded;
    options.max_iterations = w->most;
    int32_t status = dmb_sim_create(s->model, &options, &sim);
    for (int k = 0; status >= 0 && k < LOOP_STEPS; ++k) {
        status = timed_step(sim, l, repeat, k);
        if (status >= 0 && k + 1 == LOOP_ASK) status = scene_ask(s, sim, l->answers);
    }
    if (status >= 0) status = ask_at_end(s, sim, l);
    if (status < 0) {
        const double reached = sim ? dmb_sim_time(sim) : 0.0;
        printf("scene=D variant=%s time=%g failed=%s\n", w->name, reached, dmb_status_name(status));
        fprintf(stderr, "features: %s\n", sim ? dmb_sim_message(sim) : dmb_model_message(s->model));
    }
    dmb_sim_destroy(&sim);
    return status;
}

/* Of sorted values the smallest that at least the given share does not exceed. */
static double quantile(const double *sorted, int count, double share)
{
    const int i = (int)ceil(share * count - 1e-9) - 1;
    return sorted[i < 0 ? 0 : i];
}

/* Processor time of each step: the median of its repeats, so that what else the machine does counts for less. */
static int take_medians(loop *l, double *cpu)
{
    int worst = 0;
    for (int k = 0; k < LOOP_STEPS; ++k) {
        cpu[k] = median(l->cpu[k], LOOP_REPEATS);
        if (cpu[k] > cpu[worst]) worst = k;
    }
    return worst;
}

/* [-] of sorted times those longer than the step. */
static int count_late(const double *sorted, int count)
{
    int late = 0;
    while (late < count && sorted[count - 1 - late] > FEATURES_STEP) ++late;
    return late;
}

static int put_times(field *f, const double *cpu, const double *wall)
{
    static const char *const names[4][5] = {{"us_median", "us_99", "us_99.9", "us_largest", "us_smallest"},
                                            {"U_median", "U_99", "U_99.9", "U_largest", "U_smallest"},
                                            {"of_step_median", "of_step_99", "of_step_99.9", "of_step_largest", ""},
                                            {"wall_us_median", "wall_us_99", "wall_us_99.9", "wall_us_largest", ""}};
    static const double shares[5] = {0.5, 0.99, 0.999, 1.0, 0.0};
    const double scales[3] = {1e6, 1.0 / yardstick_value(&unit), 1.0 / FEATURES_STEP};
    int n = 0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < (i < 2 ? 5 : 4); ++j)
            f[n++] = number(names[i][j], scales[i] * quantile(cpu, LOOP_STEPS, shares[j]), 4);
    for (int j = 0; j < 4; ++j)
        f[n++] = number(names[3][j], 1e6 * quantile(wall, LOOP_REPEATS * LOOP_STEPS, shares[j]), 4);
    f[n++] = number("wall_late", count_late(wall, LOOP_REPEATS * LOOP_STEPS), 6);
    f[n++] = number("wall_steps", LOOP_REPEATS * LOOP_STEPS, 6);
    return n;
}

static int put_work(field *f, const loop *l, int worst)
{
    const dmb_step_report *const r = &l->reports[worst];
    int n = 0;
    f[n++] = number("worst_at", (worst + 1) * FEATURES_STEP, 6);
    f[n++] = number("worst_iterations", r->iterations, 6);
    f[n++] = number("worst_steps", r->steps, 6);
    f[n++] = number("worst_rejected", r->rejected, 6);
    f[n++] = number("iterations", (double)l->statistics.iterations / LOOP_STEPS, 4);
    f[n++] = number("rejected", (double)l->statistics.rejected, 6);
    f[n++] = number("limited", (double)l->statistics.limited, 6);
    return n;
}

/* Sorts the residuals. plain: without a bound on the work. */
static int put_errors(field *f, loop *l, const loop *plain)
{
    qsort(l->residual, LOOP_STEPS, sizeof *l->residual, compare_doubles);
    int n = 0;
    f[n++] = number("residual_median", quantile(l->residual, LOOP_STEPS, 0.5), 3);
    f[n++] = number("residual_99", quantile(l->residual, LOOP_STEPS, 0.99), 3);
    f[n++] = number("residual_largest", l->statistics.worst_residual, 3);
    f[n++] = number("rotation", l->answers[0], 10);
    f[n++] = number("error", fabs(l->answers[0] / GIVEN_ROTATION - 1.0), 3);
    f[n++] = word("error_kind", "tip_rotation_vs_given");
    f[n++] = number("wall_force", l->answers[1], 6);
    f[n++] = number("rotation_to_plain", l->answers[0] - plain->answers[0], 3);
    f[n++] = number("wall_force_to_plain", l->answers[1] / plain->answers[1] - 1.0, 3);
    f[n++] = number("end_rotation_to_plain", l->end_rotation - plain->end_rotation, 3);
    f[n++] = number("balance", l->balance, 3);
    return n;
}

static void report_loop(const scene *s, const way *w, loop *l, const loop *plain)
{
    static double cpu[LOOP_STEPS];
    const int worst = take_medians(l, cpu);
    field f[64];
    int n = 0;
    qsort(cpu, LOOP_STEPS, sizeof *cpu, compare_doubles);
    qsort(l->wall, LOOP_REPEATS * LOOP_STEPS, sizeof *l->wall, compare_doubles);
    f[n++] = word("scene", "D");
    f[n++] = word("variant", w->name);
    f[n++] = number("elements", s->pipes * s->per_pipe, 9);
    f[n++] = number("dt", FEATURES_STEP, 4);
    f[n++] = number("bounded_work", w->bounded, 2);
    f[n++] = number("max_iterations", w->most, 6);
    f[n++] = number("steps", LOOP_STEPS, 9);
    f[n++] = number("U_us", 1e6 * yardstick_value(&unit), 4);
    n += put_times(f + n, cpu, l->wall);
    n += put_work(f + n, l, worst);
    n += put_errors(f + n, l, plain);
    put_row(f, n);
}

static int measure_loop(const scene *s, const way *w, loop *l, const loop *plain)
{
    yardstick_anew();
    for (int i = 0; i < LOOP_REPEATS; ++i) {
        if (run_loop(s, w, i, l) < 0) return 1;
        for (int k = 0; k < 3; ++k) yardstick_measure(&unit);
    }
    report_loop(s, w, l, plain);
    return 0;
}

static int run_d(void)
{
    static const way ways[LOOP_WAYS] = {
        {"plain", 0, 12}, {"bounded_12", 1, 12}, {"bounded_4", 1, 4}, {"bounded_3", 1, 3}, {"bounded_2", 1, 2}};
    static loop loops[LOOP_WAYS];
    scene s = {.kind = SCENE_B_COSINE, .pipes = 100, .per_pipe = 1, .length = 1.0};
    int failures = 0;
    if (scene_open(&s) < 0) {
        fprintf(stderr, "features: %s\n", s.model ? dmb_model_message(s.model) : "no model");
        failures = 1;
    }
    for (int i = 0; failures == 0 && i < LOOP_WAYS; ++i) failures = measure_loop(&s, &ways[i], &loops[i], &loops[0]);
    dmb_model_destroy(&s.model);
    return failures;
}

/* ---- F: the rig ----------------------------------------------------------------------------------------------------
 */

typedef struct variant {
    const char *name;
    int32_t pipe_kind, features;
    int bare; /* wall, eccentricity, excitation, rock law and gravity are not even described */
} variant;

static int32_t add_rig_surroundings(scene *s, const variant *v)
{
    dmb_environment_def environment = dmb_environment_def_default();
    dmb_wall_def wall = dmb_wall_def_default();
    if (!v->bare) return dmb_model_add_wall(s->model, &wall, NULL);
    environment.gravity[2] = 0.0;
    return dmb_model_set_environment(s->model, &environment);
}

static int32_t add_rig_pipes(scene *s, const variant *v)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    int32_t status = dmb_model_add_string(s->model, &string, &s->string);
    pipe.string = s->string;
    pipe.elements = s->per_pipe;
    pipe.length = s->length;
    pipe.outer_diameter = 0.073;
    pipe.inner_diameter = 0.059;
    pipe.young_modulus = BENCH_YOUNG;
    pipe.poisson_ratio = BENCH_POISSON;
    pipe.density = BENCH_DENSITY;
    if (!v->bare) {
        pipe.damping_time = 1e-4;
        pipe.eccentricity = 1e-3;
        pipe.angle_spread = BENCH_PI;
    }
    return status < 0 ? status : dmb_model_add_pipes(s->model, &pipe, s->pipes, NULL);
}

static int32_t add_rig_bit(scene *s, const variant *v)
{
    const double polar = BENCH_PI / 32.0 * (pow(0.073, 4.0) - pow(0.059, 4.0));
    dmb_bit_def bit = dmb_bit_def_default();
    bit.string = s->string;
    bit.inertia[0] = BIT_AS_PIPE * BENCH_DENSITY * polar;
    bit.inertia[1] = bit.inertia[0];
    bit.diameter = 0.0;
    if (!v->bare) bit.rock_law = DMB_ROCK_REGENERATIVE;
    return dmb_model_add_bit(s->model, &bit, NULL);
}

static int32_t add_rig_drive(scene *s, int32_t component, double rise, double speed, double shake)
{
    dmb_term term = dmb_term_default(), swing = dmb_term_default();
    dmb_drive_def drive = dmb_drive_def_default();
    term.kind = DMB_TERM_STEP;
    term.x1 = rise;
    term.h1 = speed;
    swing.kind = DMB_TERM_HARMONIC;
    swing.h1 = shake;
    swing.omega = 10.0 * BENCH_PI;
    int32_t status = dmb_model_add_programme(s->model, &term, 1, &drive.programme);
    if (status >= 0 && shake > 0.0) status = dmb_model_add_programme(s->model, &swing, 1, &drive.excitation);
    drive.part = s->string;
    drive.component = component;
    return status < 0 ? status : dmb_model_add_drive(s->model, &drive, &s->turn);
}

static int32_t open_rig(scene *s, const variant *v, dmb_model_info *info)
{
    dmb_compile_options compile = dmb_compile_options_default();
    compile.features = v->features;
    compile.pipe_kind = v->pipe_kind;
    int32_t status = dmb_model_create(NULL, &s->model);
    if (status >= 0) status = add_rig_surroundings(s, v);
    if (status >= 0) status = add_rig_pipes(s, v);
    if (status >= 0) status = add_rig_bit(s, v);
    if (status >= 0) status = add_rig_drive(s, DMB_X, 0.25, 5e-3, 0.0);
    if (status >= 0) status = add_rig_drive(s, DMB_RX, 1.0, 2.0 * BENCH_PI, v->bare ? 0.0 : 0.1);
    if (status >= 0) status = dmb_model_compile(s->model, &compile);
    *info = dmb_model_info_default();
    return status < 0 ? status : dmb_model_get_info(s->model, info);
}

/* Tip speed where the exact one is known, torque of the drive where not. */
static double answer_of(const scene *s, const variant *v)
{
    const method fine = {FEATURES_STEP / 8.0, 0.0, 0.5, 0.5, 0, 1};
    if (v->pipe_kind == DMB_PIPE_RIGID) return 2.0 * BENCH_PI;
    if (s->kind == SCENE_C) return exact_tip_speed(s->pipes * s->length + BIT_AS_PIPE, 2.0);
    const outcome out = measure(s, &fine, &unit);
    return out.status < 0 ? (double)NAN : out.values[0];
}

static void report_rig(const scene *s, const variant *v, const dmb_model_info *info, const outcome *out)
{
    const double us = 1e6 * out->seconds / out->steps, answer = answer_of(s, v), bytes = (double)info->sim_bytes;
    const char *const kind = s->kind == SCENE_R               ? "torque_vs_dt/8"
                             : v->pipe_kind == DMB_PIPE_RIGID ? "tip_speed_vs_drive"
                                                              : "tip_speed_vs_exact";
    const field f[] = {word("scene", "F"),
                       word("variant", v->name),
                       number("pipes", s->pipes, 9),
                       number("elements", info->elements, 9),
                       number("sites", info->contact_sites, 9),
                       number("freedoms", info->freedoms, 9),
                       number("dt", FEATURES_STEP, 4),
                       number("steps", out->steps, 9),
                       number("us_per_step", us, 4),
                       number("spread", out->spread, 2),
                       number("U_us", 1e6 * out->yardstick, 4),
                       number("U_per_step", 1e-6 * us / out->yardstick, 3),
                       number("iterations", out->iterations, 4),
                       number("rejected", out->rejected, 6),
                       number("us_per_iteration", out->iterations > 0.0 ? us / out->iterations : (double)NAN, 4),
                       number("sim_bytes", bytes, 12),
                       number("model_bytes", (double)info->model_bytes, 12),
                       number("sim_bytes_per_pipe", bytes / s->pipes, 5),
                       number("value", out->values[0], 15),
                       number("error", fabs(out->values[0] / answer - 1.0), 3),
                       word("error_kind", kind),
                       number("balance", out->balance, 3),
                       word("balance_kind", "ledger")};
    put_row(f, (int)(sizeof f / sizeof *f));
}

/* With contact from rest on the wall, as scene R; otherwise from the axis, as scene C. */
static int measure_rig(const variant *v)
{
    const int lies = !v->bare && (v->features & DMB_FEATURE_CONTACT);
    const method how = {FEATURES_STEP, 0.0, lies ? 0.5 : 2.0, 2.0, 1, RIG_REPEATS};
    dmb_model_info info;
    scene s = {.kind = lies ? SCENE_R : SCENE_C, .pipes = RIG_PIPES, .per_pipe = 1, .length = 1.0};
    int32_t status = open_rig(&s, v, &info);
    if (status < 0 && s.model) fprintf(stderr, "features: %s: %s\n", v->name, dmb_model_message(s.model));
    if (status >= 0) {
        yardstick_anew();
        const outcome out = measure(&s, &how, &unit);
        status = out.status;
        if (status >= 0) report_rig(&s, v, &info, &out);
    }
    if (status < 0) printf("scene=F variant=%s failed=%s\n", v->name, dmb_status_name(status));
    dmb_model_destroy(&s.model);
    return status < 0;
}

static int run_f(void)
{
    enum {
        LIES = DMB_FEATURE_GRAVITY | DMB_FEATURE_CONTACT,
        RUBS = LIES | DMB_FEATURE_FRICTION,
        SHAKES = RUBS | DMB_FEATURE_VIBRATION,
        CUTS = SHAKES | DMB_FEATURE_ROCK
    };
    static const variant variants[] = {{"rigid", DMB_PIPE_RIGID, 0, 0},
                                       {"axial_torsional", DMB_PIPE_AXIAL_TORSIONAL, 0, 0},
                                       {"flexible_bare", DMB_PIPE_FLEXIBLE, DMB_FEATURE_ALL, 1},
                                       {"flexible", DMB_PIPE_FLEXIBLE, 0, 0},
                                       {"+gravity+contact", DMB_PIPE_FLEXIBLE, LIES, 0},
                                       {"+friction", DMB_PIPE_FLEXIBLE, RUBS, 0},
                                       {"+vibration", DMB_PIPE_FLEXIBLE, SHAKES, 0},
                                       {"+bit", DMB_PIPE_FLEXIBLE, CUTS, 0},
                                       {"+damping", DMB_PIPE_FLEXIBLE, DMB_FEATURE_ALL, 0}};
    int failures = 0;
    for (size_t i = 0; i < sizeof variants / sizeof *variants; ++i) failures += measure_rig(&variants[i]);
    return failures > 0;
}

int main(int count, char **words)
{
    const int is_d = count == 3 && strcmp(words[2], "D") == 0, is_f = count == 3 && strcmp(words[2], "F") == 0;
    if (!is_d && !is_f) return fputs("usage: features CSV D|F\n", stderr), 2;
    table = fopen(words[1], "w");
    if (!table) return perror(words[1]), 2;
    yardstick_open(&unit);
    for (int i = 0; i < 25; ++i) yardstick_measure(&unit);
    printf("U=%.4g us\n", 1e6 * yardstick_value(&unit));
    const int failed = is_d ? run_d() : run_f();
    if (fclose(table) != 0) return perror(words[1]), 2;
    return failed;
}
