/* The cost of a single step, and of a scene with its features. usage: features CSV D|F
 *
 * Scene D: step times of a control loop: every step of scene B* timed by itself, as many iterations as it takes and
 * with bounded work. Scene F: one rig described once, compiled with less and with more of it: what is left out is to
 * cost nothing. */
#define _POSIX_C_SOURCE 200809L

#include <stdio.h>
#include <string.h>

#include "measure.h"

#define FEATURES_STEP 1e-3    /* [s] */
#define GIVEN_ROTATION 9.3755 /* [rad] of the tip of B*, 2 s, from elsewhere */
#define BIT_AS_PIPE 0.5       /* [m] of pipe with the polar moment of inertia of the bit of scene F */

enum { LOOP_STEPS = 4000, LOOP_ASK = 2000, LOOP_REPEATS = 5, LOOP_WAYS = 5, RIG_PIPES = 100, RIG_REPEATS = 3 };

static yardstick unit;
static result_table results;

/* ---- D: a control loop ----------------------------------------------------------------------------------------- */

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
        row_failed("D", s->pipes * s->per_pipe, w->name, dmb_status_name(status),
                   sim ? dmb_sim_message(sim) : dmb_model_message(s->model));
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

static void put_times(result_row *r, const double *cpu, const double *wall)
{
    static const char *const names[4][5] = {{"us_median", "us_99", "us_99.9", "us_largest", "us_smallest"},
                                            {"U_median", "U_99", "U_99.9", "U_largest", "U_smallest"},
                                            {"of_step_median", "of_step_99", "of_step_99.9", "of_step_largest", ""},
                                            {"wall_us_median", "wall_us_99", "wall_us_99.9", "wall_us_largest", ""}};
    static const double shares[5] = {0.5, 0.99, 0.999, 1.0, 0.0};
    const double scales[3] = {1e6, 1.0 / yardstick_value(&unit), 1.0 / FEATURES_STEP};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < (i < 2 ? 5 : 4); ++j)
            row_number(r, names[i][j], scales[i] * quantile(cpu, LOOP_STEPS, shares[j]), 4);
    for (int j = 0; j < 4; ++j)
        row_number(r, names[3][j], 1e6 * quantile(wall, LOOP_REPEATS * LOOP_STEPS, shares[j]), 4);
    row_number(r, "wall_late", count_late(wall, LOOP_REPEATS * LOOP_STEPS), 6);
    row_number(r, "wall_steps", LOOP_REPEATS * LOOP_STEPS, 6);
}

static void put_work(result_row *r, const loop *l, int worst)
{
    const dmb_step_report *const report = &l->reports[worst];
    row_number(r, "worst_at", (worst + 1) * FEATURES_STEP, 6);
    row_number(r, "most_iterations", report->iterations, 6);
    row_number(r, "worst_steps", report->steps, 6);
    row_number(r, "worst_rejected", report->rejected, 6);
    row_number(r, "rejected", (double)l->statistics.rejected, 6);
    row_number(r, "limited", (double)l->statistics.limited_steps, 6);
}

/* Sorts the residuals. plain: without a bound on the work. */
static void put_errors(result_row *r, loop *l, const loop *plain)
{
    qsort(l->residual, LOOP_STEPS, sizeof *l->residual, compare_doubles);
    row_number(r, "residual_median", quantile(l->residual, LOOP_STEPS, 0.5), 3);
    row_number(r, "residual_99", quantile(l->residual, LOOP_STEPS, 0.99), 3);
    row_number(r, "residual_largest", l->statistics.largest_residual, 3);
    row_number(r, "rotation", l->answers[0], 10);
    row_number(r, "wall_force", l->answers[1], 6);
    row_number(r, "rotation_to_plain", l->answers[0] - plain->answers[0], 3);
    row_number(r, "wall_force_to_plain", l->answers[1] / plain->answers[1] - 1.0, 3);
    row_number(r, "end_rotation_to_plain", l->end_rotation - plain->end_rotation, 3);
    row_number(r, "balance", l->balance, 3);
}

static void report_loop(const scene *s, const way *w, loop *l, const loop *plain)
{
    static double cpu[LOOP_STEPS];
    const int worst = take_medians(l, cpu);
    result_row r;
    qsort(cpu, LOOP_STEPS, sizeof *cpu, compare_doubles);
    qsort(l->wall, LOOP_REPEATS * LOOP_STEPS, sizeof *l->wall, compare_doubles);
    const double typical = quantile(cpu, LOOP_STEPS, 0.5);
    const head h = {"D",
                    s->pipes * s->per_pipe,
                    FEATURES_STEP,
                    typical,
                    yardstick_value(&unit),
                    FEATURES_STEP / typical,
                    (double)l->statistics.iterations / LOOP_STEPS,
                    fabs(l->answers[0] / GIVEN_ROTATION - 1.0),
                    "tip_rotation_vs_given"};
    row_begin(&r, &h);
    row_word(&r, "variant", w->name);
    row_number(&r, "bounded_work", w->bounded, 2);
    row_number(&r, "max_iterations", w->most, 6);
    row_number(&r, "steps", LOOP_STEPS, 9);
    row_number(&r, "repeats", LOOP_REPEATS, 3);
    row_number(&r, "U_us", 1e6 * yardstick_value(&unit), 4);
    put_times(&r, cpu, l->wall);
    put_work(&r, l, worst);
    put_errors(&r, l, plain);
    row_put(&r, &results);
}

static int measure_loop(const scene *s, const way *w, loop *l, const loop *plain)
{
    yardstick_anew(&unit);
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
        row_failed("D", 0.0, "compile", "-", s.model ? dmb_model_message(s.model) : "no model");
        failures = 1;
    }
    for (int i = 0; failures == 0 && i < LOOP_WAYS; ++i) failures = measure_loop(&s, &ways[i], &loops[i], &loops[0]);
    dmb_model_destroy(&s.model);
    return failures;
}

/* ---- F: the rig ------------------------------------------------------------------------------------------------ */

typedef struct variant {
    const char *name;
    int32_t pipe_kind, features;
    int bare; /* wall, eccentricity, excitation, rock law and gravity are not even described */
    uint32_t contact_points;
    double cut_spacing; /* [m] of the hole that the bit widens */
} variant;

static int32_t add_rig_surroundings(scene *s, const variant *v)
{
    dmb_environment_def environment = dmb_environment_def_default();
    dmb_wall_def wall = dmb_wall_def_default();
    wall.cut_spacing = v->cut_spacing;
    wall.cut_end = v->cut_spacing > 0.0 ? 2.0 * s->pipes * s->length : 0.0;
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
    pipe.contact_points = v->contact_points;
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
    if (v->cut_spacing > 0.0) bit.radius = 0.049;
    return dmb_model_add_bit(s->model, &bit, NULL);
}

static int32_t add_rig_drive(scene *s, int32_t component, double rise, double speed, double shake)
{
    dmb_segment term = dmb_segment_default(), swing = dmb_segment_default();
    dmb_drive_def drive = dmb_drive_def_default();
    term.kind = DMB_SEGMENT_STEP;
    term.x1 = rise;
    term.h1 = speed;
    swing.kind = DMB_SEGMENT_HARMONIC;
    swing.h1 = shake;
    swing.omega = 10.0 * BENCH_PI;
    int32_t status = dmb_model_add_time_function(s->model, &term, 1, &drive.time_function);
    if (status >= 0 && shake > 0.0) status = dmb_model_add_time_function(s->model, &swing, 1, &drive.excitation);
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
    method fine = method_fixed(FEATURES_STEP / 8.0, 0.5);
    fine.ledger = 0;
    fine.repeats = 1;
    if (v->pipe_kind == DMB_PIPE_RIGID) return 2.0 * BENCH_PI;
    if (s->kind == SCENE_C) return exact_tip_speed(s->pipes * s->length + BIT_AS_PIPE, 2.0);
    const outcome out = measure(s, &fine, &unit);
    return out.status < 0 ? (double)NAN : out.values[0];
}

static void report_rig(const scene *s, const variant *v, const method *how, const dmb_model_info *info,
                       const outcome *out)
{
    const double answer = answer_of(s, v), bytes = (double)info->sim_bytes;
    const char *const kind = s->kind == SCENE_R               ? "torque_vs_dt/8"
                             : v->pipe_kind == DMB_PIPE_RIGID ? "tip_speed_vs_drive"
                                                              : "tip_speed_vs_exact";
    result_row r;
    begin_outcome(&r, "F", info->elements, how, out, fabs(out->values[0] / answer - 1.0), kind);
    row_word(&r, "variant", v->name);
    row_number(&r, "repeats", how->repeats, 3);
    row_number(&r, "pipes", s->pipes, 9);
    row_number(&r, "sites", info->contact_points, 9);
    row_number(&r, "degrees_of_freedom", info->degrees_of_freedom, 9);
    row_number(&r, "sim_bytes", bytes, 12);
    row_number(&r, "model_bytes", (double)info->model_bytes, 12);
    row_number(&r, "sim_bytes_per_pipe", bytes / s->pipes, 5);
    row_number(&r, "value", out->values[0], 15);
    row_put(&r, &results);
}

/* With contact from rest on the wall, as scene R; otherwise from the axis, as scene C. */
static int measure_rig(const variant *v)
{
    const int lies = !v->bare && (v->features & DMB_FEATURE_CONTACT);
    const method how = {FEATURES_STEP, 0.0, 0.8, lies ? 0.5 : 2.0, 2.0, 1, RIG_REPEATS};
    dmb_model_info info;
    scene s = {.kind = lies ? SCENE_R : SCENE_C, .pipes = RIG_PIPES, .per_pipe = 1, .length = 1.0};
    int32_t status = open_rig(&s, v, &info);
    if (status < 0)
        row_failed("F", 0.0, v->name, dmb_status_name(status), s.model ? dmb_model_message(s.model) : "no model");
    if (status >= 0) {
        const outcome out = measure(&s, &how, &unit);
        status = out.status;
        if (status >= 0) report_rig(&s, v, &how, &info, &out);
    }
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
    static const variant variants[] = {{"rigid", DMB_PIPE_RIGID, 0, 0, 0, 0.0},
                                       {"axial_torsional", DMB_PIPE_AXIAL_TORSIONAL, 0, 0, 0, 0.0},
                                       {"flexible_bare", DMB_PIPE_FLEXIBLE, DMB_FEATURE_ALL, 1, 0, 0.0},
                                       {"flexible", DMB_PIPE_FLEXIBLE, 0, 0, 0, 0.0},
                                       {"+gravity+contact", DMB_PIPE_FLEXIBLE, LIES, 0, 0, 0.0},
                                       {"+friction", DMB_PIPE_FLEXIBLE, RUBS, 0, 0, 0.0},
                                       {"+vibration", DMB_PIPE_FLEXIBLE, SHAKES, 0, 0, 0.0},
                                       {"+bit", DMB_PIPE_FLEXIBLE, CUTS, 0, 0, 0.0},
                                       {"+damping", DMB_PIPE_FLEXIBLE, DMB_FEATURE_ALL, 0, 0, 0.0},
                                       {"+widened hole", DMB_PIPE_FLEXIBLE, DMB_FEATURE_ALL, 0, 0, 0.01},
                                       {"lying_along_3", DMB_PIPE_FLEXIBLE, LIES, 0, 3, 0.0},
                                       {"lying_along_5", DMB_PIPE_FLEXIBLE, LIES, 0, 5, 0.0},
                                       {"open", DMB_PIPE_FLEXIBLE, DMB_FEATURE_CONTACT, 0, 0, 0.0},
                                       {"open_along_3", DMB_PIPE_FLEXIBLE, DMB_FEATURE_CONTACT, 0, 3, 0.0}};
    int failures = 0;
    for (size_t i = 0; i < sizeof variants / sizeof *variants; ++i) failures += measure_rig(&variants[i]);
    return failures > 0;
}

int main(int count, char **words)
{
    const int is_d = count == 3 && strcmp(words[2], "D") == 0, is_f = count == 3 && strcmp(words[2], "F") == 0;
    if (!is_d && !is_f) return fputs("usage: features CSV D|F\n", stderr), 2;
    if (table_open(&results, &unit, words[1]) != 0) return 2;
    const int failed = is_d ? run_d() : run_f();
    return table_close(&results, words[1]) != 0 ? 2 : failed;
}
