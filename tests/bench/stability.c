/* Robustness: 1000 random scenes out of a Latin hypercube (stability_draw.h), each with its static start and 0.2 s.
 * usage: stability [second] [statics] [SEED [NUMBER [STEP]]]   (default: the first set, seed 1, all scenes; statics:
 * the static starts alone; NUMBER: that scene alone, step by step; STEP [s] takes the place of the one drawn). Prints a
 * line for every failure, and one of counts. tests/bench/run calls it. In the second set each run is also taken up from
 * a snapshot by another sim, and has to come out with the same hash. */
#include "stability_scene.h"

#include <stdlib.h>
#include <time.h>

static const double end_time = 0.2; /* [s] */
enum {
    ADVANCES = 20,      /* pieces of an error-controlled run */
    MOST_HALVINGS = 12, /* as of dmb_sim_step's own */
};

/* ---- A trial -------------------------------------------------------------------------------------------------------
 */

typedef struct trial {
    random_scene scene;
    drawn *d; /* of the scene */
    dmb_sim *sim;
    unsigned char *snapshot; /* of piece `mark`; NULL before */
    size_t snapshot_size;
    unsigned char *undo; /* state before the present bounded step */
    size_t undo_size;
    uint32_t mark;
    uint64_t hash;     /* of the end */
    const char *stage; /* what was being done when `status` came */
    int32_t status;
    int verbose;
    double gravity; /* [J] of the start */
} trial;

static int32_t make_sim(trial *t)
{
    dmb_sim_options options = dmb_sim_options_default();
    options.spectral_radius = t->d->radius;
    if (t->d->walk == WALK_CONTROLLED) {
        options.tolerance_translation = t->d->tolerance;
        options.tolerance_rotation = 10.0 * t->d->tolerance;
    } else if (t->d->walk == WALK_BOUNDED) {
        options.bounded_work = 1;
        options.max_iterations = t->d->bound;
    }
    return dmb_sim_create(t->scene.model, &options, &t->sim);
}

/* ---- Counts --------------------------------------------------------------------------------------------------------
 */

static struct counts {
    uint32_t finished, retried, failed, not_finite, unequal;
    uint32_t unbalanced; /* finished with more than half of the energy unexplained */
    uint32_t newton, relaxed, static_failed, static_none;
    uint32_t worst, worst_static;
    uint64_t steps, iterations, rejected, cut, limited, halved, static_iterations;
    double worst_seconds, worst_balance;
    uint32_t slowest, worst_balanced; /* numbers of scenes */
    double balance[SCENES];           /* [-] of the first `finished` */
} counts;

static void print_failure(const trial *t, unsigned long long seed)
{
    const char *text = t->sim ? dmb_sim_message(t->sim) : t->scene.model ? dmb_model_message(t->scene.model) : "";
    printf("failed=%s seed=%llu number=%u status=%s t=%.6g message=\"%s\" ", t->stage, seed, (unsigned)t->d->number,
           dmb_status_name(t->status), t->sim ? dmb_sim_time(t->sim) : 0.0, text);
    print_drawn(t->d);
    fflush(stdout);
}

static int is_finite(const double *values, int count)
{
    for (int i = 0; i < count; ++i)
        if (!isfinite(values[i])) return 0;
    return 1;
}

/* Poses and speeds of all pipe ends. */
static int motion_is_finite(const trial *t)
{
    int finite = 1;
    for (uint32_t k = 0; k <= t->d->joints; ++k)
        for (uint32_t i = 0; i < t->scene.pipes[k] && finite; ++i) {
            const dmb_place place = dmb_station(t->scene.strings[k], i, 1.0);
            dmb_pose pose = dmb_pose_default();
            dmb_motion motion = dmb_motion_default();
            finite = dmb_query_pose(t->sim, place, &pose) >= 0 && dmb_query_motion(t->sim, place, &motion) >= 0 &&
                     is_finite(pose.position, 3) && is_finite(pose.rotation, 9) && is_finite(motion.velocity, 6) &&
                     is_finite(motion.acceleration, 6);
        }
    return finite;
}

/* ---- Start ----------------------------------------------------------------------------------------------------------
 */

/* Where it fails, the run begins on the axis of the hole instead, as described. */
static int32_t settle(trial *t)
{
    dmb_static_report report = dmb_static_report_default();
    t->stage = "static";
    t->status = dmb_analysis_static(t->sim, NULL, &report);
    if (t->status < 0)
        ++counts.static_failed;
    else if (report.method == DMB_STATIC_NEWTON)
        ++counts.newton;
    else
        ++counts.relaxed;
    counts.static_iterations += report.iterations;
    if (report.iterations > counts.worst_static) counts.worst_static = report.iterations;
    if (t->verbose)
        printf("static=%s method=%d iterations=%u residual=%.2e move_mm=%.3g\n", dmb_status_name(t->status),
               (int)report.method, (unsigned)report.iterations, report.residual, 1e3 * report.lateral_move);
    return t->status;
}

static void print_step(const trial *t, const dmb_step_report *r)
{
    dmb_energy e = dmb_energy_default();
    dmb_contact_total sum = dmb_contact_total_default();
    (void)dmb_query_energy(t->sim, &e);
    (void)dmb_query_contact_total(t->sim, &sum);
    printf("t=%.6f status=%d steps=%u iterations=%u rejected=%u residual=%.1e kinetic=%.4g balance=%.2e closed=%u "
           "normal=%.4g deepest_mm=%.3g\n",
           dmb_sim_time(t->sim), (int)t->status, (unsigned)r->steps, (unsigned)r->iterations, (unsigned)r->rejected,
           r->residual, e.kinetic, e.balance, (unsigned)sum.closed, sum.normal_force, 1e3 * sum.deepest);
}

/* ---- Run ------------------------------------------------------------------------------------------------------------
 */

static uint32_t pieces_of(const trial *t)
{
    return t->d->walk == WALK_CONTROLLED ? ADVANCES : (uint32_t)ceil(end_time / t->d->step * (1.0 - 1e-12));
}

/* [-] A bounded step that ends above this residual is no step: accepted, such steps pump energy in. */
static const double useless = 0.03;

/* Snapshot of the state before a bounded step. */
static int32_t remember(trial *t)
{
    int32_t status = t->undo ? DMB_OK : dmb_sim_snapshot_size(t->sim, &t->undo_size);
    if (status >= 0 && !t->undo && !(t->undo = malloc(t->undo_size))) status = DMB_ERR_NO_MEMORY;
    return status < 0 ? status : dmb_sim_snapshot(t->sim, t->undo, t->undo_size);
}

/* A bounded step that is refused, or useless, is taken back and done in halves, as a control loop would. */
static int32_t step_to(trial *t, double time, uint32_t halvings, dmb_step_report *report)
{
    const double from = dmb_sim_time(t->sim);
    if (t->d->walk != WALK_BOUNDED) return dmb_sim_step(t->sim, time - from, report);
    int32_t status = remember(t);
    if (status < 0) return status;
    status = dmb_sim_step(t->sim, time - from, report);
    if (halvings == 0 || (status >= 0 && report->residual <= useless)) return status;
    ++counts.halved;
    status = dmb_sim_restore(t->sim, t->undo, t->undo_size);
    if (status >= 0) status = step_to(t, 0.5 * (from + time), halvings - 1, report);
    return status < 0 ? status : step_to(t, time, halvings - 1, report);
}

/* To the end of piece `k`, counted from 1. */
static void take_piece(trial *t, uint32_t k)
{
    dmb_step_report report = dmb_step_report_default();
    if (t->d->walk == WALK_CONTROLLED)
        t->status = dmb_sim_advance(t->sim, k * end_time / ADVANCES, &report);
    else
        t->status = step_to(t, fmin(k * t->d->step, end_time), MOST_HALVINGS, &report);
    if (t->status >= 0 && t->d->walk == WALK_FIXED && report.rejected > 0) ++counts.cut;
    if (t->verbose) print_step(t, &report);
    if (t->status >= 0 && !motion_is_finite(t)) t->status = DMB_ERR_NOT_FINITE, t->stage = "finite";
}

static void take_snapshot(trial *t)
{
    t->status = dmb_sim_snapshot_size(t->sim, &t->snapshot_size);
    if (t->status >= 0 && !(t->snapshot = malloc(t->snapshot_size))) t->status = DMB_ERR_NO_MEMORY;
    if (t->status >= 0) t->status = dmb_sim_snapshot(t->sim, t->snapshot, t->snapshot_size);
}

static void run(trial *t)
{
    dmb_energy start = dmb_energy_default();
    const uint32_t pieces = pieces_of(t);
    t->stage = "run";
    t->status = dmb_query_energy(t->sim, &start);
    t->gravity = start.gravity;
    t->mark = (uint32_t)(t->d->restart * pieces);
    for (uint32_t k = 1; t->status >= 0 && k <= pieces; ++k) {
        take_piece(t, k);
        if (t->status >= 0 && k == t->mark) take_snapshot(t);
    }
    if (t->status >= 0) t->status = dmb_sim_hash(t->sim, &t->hash);
}

/* Another sim goes on from the snapshot. Its steps are not counted again. */
static void run_again(trial *t)
{
    const struct counts before = counts;
    const uint32_t pieces = pieces_of(t);
    uint64_t hash = 0;
    dmb_sim_destroy(&t->sim);
    t->stage = "again";
    t->verbose = 0;
    t->status = make_sim(t);
    if (t->status >= 0) t->status = dmb_sim_restore(t->sim, t->snapshot, t->snapshot_size);
    for (uint32_t k = t->mark + 1; t->status >= 0 && k <= pieces; ++k) take_piece(t, k);
    if (t->status >= 0) t->status = dmb_sim_hash(t->sim, &hash);
    counts = before;
    if (t->status >= 0 && hash != t->hash) t->status = DMB_ERR_VALUE, t->stage = "unequal";
}

static void count_finished(const trial *t)
{
    dmb_statistics s = dmb_statistics_default();
    dmb_energy e = dmb_energy_default();
    (void)dmb_query_statistics(t->sim, &s);
    (void)dmb_query_energy(t->sim, &e);
    const double balance = fabs(e.balance) / fmax(e.input + fabs(e.gravity - t->gravity), 1e-30);
    if (balance > counts.worst_balance) counts.worst_balance = balance, counts.worst_balanced = t->d->number;
    counts.balance[counts.finished++] = balance;
    counts.retried += s.rejected > 0;
    counts.unbalanced += !(balance <= 0.5);
    if (!(balance <= 0.5))
        printf("unbalanced=%u balance=%.2g walk=%s bound=%u dt=%.3g limited=%llu of %llu steps\n",
               (unsigned)t->d->number, balance, walk_names[t->d->walk], (unsigned)t->d->bound, t->d->step,
               (unsigned long long)s.limited_steps, (unsigned long long)s.steps);
    counts.steps += s.steps;
    counts.iterations += s.iterations;
    counts.rejected += s.rejected;
    counts.limited += s.limited_steps;
    if (s.most_iterations > counts.worst) counts.worst = s.most_iterations;
    if (t->verbose)
        printf("steps=%llu iterations=%llu rejected=%llu worst=%u balance=%.2e\n", (unsigned long long)s.steps,
               (unsigned long long)s.iterations, (unsigned long long)s.rejected, (unsigned)s.most_iterations, balance);
}

/* Speed controllers hold nothing at rest: such strings start as described, on the axis of the hole. */
static void start(trial *t, unsigned long long seed)
{
    t->stage = "compile";
    t->status = random_scene_make(&t->scene);
    if (t->status >= 0) t->stage = "create", t->status = make_sim(t);
    if (t->status >= 0 && t->d->control)
        ++counts.static_none;
    else if (t->status >= 0 && settle(t) < 0)
        print_failure(t, seed);
}

typedef struct choice {
    int second, statics; /* set; static starts alone */
    unsigned long long seed;
    int verbose;
    double step; /* [s] in place of the one drawn; 0: as drawn */
} choice;

static void go(trial *t, const choice *c)
{
    start(t, c->seed);
    if (t->sim && c->statics) return;
    if (t->sim) run(t);
    if (t->sim && t->status >= 0) count_finished(t);
    if (t->snapshot && t->status >= 0) run_again(t);
    if (t->status >= 0) return;
    ++counts.failed;
    counts.not_finite += strcmp(t->stage, "finite") == 0;
    counts.unequal += strcmp(t->stage, "unequal") == 0;
    print_failure(t, c->seed);
}

static void try_scene(uint32_t number, const choice *c)
{
    trial t;
    const clock_t begin = clock();
    memset(&t, 0, sizeof t);
    t.scene.d = c->second ? draw_second(number) : draw_first(number);
    t.d = &t.scene.d;
    t.verbose = c->verbose;
    if (c->step > 0.0) t.d->step = c->step;
    if (c->verbose) print_drawn(t.d);
    go(&t, c);
    free(t.snapshot);
    free(t.undo);
    dmb_sim_destroy(&t.sim);
    dmb_model_destroy(&t.scene.model);
    const double seconds = (double)(clock() - begin) / CLOCKS_PER_SEC;
    if (seconds > counts.worst_seconds) counts.worst_seconds = seconds, counts.slowest = number;
}

/* ---- Summary -------------------------------------------------------------------------------------------------------
 */

static int compare_doubles(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* NaN if nothing finished. */
static double balance_quantile(double fraction)
{
    return counts.finished ? counts.balance[(uint32_t)(fraction * (counts.finished - 1) + 0.5)] : (double)NAN;
}

static void print_summary(const choice *c)
{
    qsort(counts.balance, counts.finished, sizeof *counts.balance, compare_doubles);
    printf(
        "scene=S set=%d seed=%llu scenes=%d finished=%u retried=%u failed=%u not_finite=%u unequal=%u unbalanced=%u ",
        c->second ? 2 : 1, c->seed, SCENES, (unsigned)counts.finished, (unsigned)counts.retried,
        (unsigned)counts.failed, (unsigned)counts.not_finite, (unsigned)counts.unequal, (unsigned)counts.unbalanced);
    printf("static_newton=%u static_relaxed=%u static_failed=%u static_none=%u static_iterations=%llu "
           "static_most_iterations=%u ",
           (unsigned)counts.newton, (unsigned)counts.relaxed, (unsigned)counts.static_failed,
           (unsigned)counts.static_none, (unsigned long long)counts.static_iterations, (unsigned)counts.worst_static);
    printf("steps=%llu cut=%llu rejected=%llu limited=%llu halved=%llu iterations=%.3g most_iterations=%u ",
           (unsigned long long)counts.steps, (unsigned long long)counts.cut, (unsigned long long)counts.rejected,
           (unsigned long long)counts.limited, (unsigned long long)counts.halved,
           (double)counts.iterations / fmax(1.0, (double)counts.steps), (unsigned)counts.worst);
    printf("balance_median=%.1e balance_99=%.1e balance_worst=%.1e balance_worst_number=%u ", balance_quantile(0.5),
           balance_quantile(0.99), counts.worst_balance, (unsigned)counts.worst_balanced);
    printf("seconds=%.4g slowest=%.3g slowest_number=%u\n", (double)clock() / CLOCKS_PER_SEC, counts.worst_seconds,
           (unsigned)counts.slowest);
}

int main(int count, char **words)
{
    choice c = {.seed = 1};
    if (count > 1 && strcmp(words[1], "second") == 0) c.second = 1, --count, ++words;
    if (count > 1 && strcmp(words[1], "statics") == 0) c.statics = 1, --count, ++words;
    if (count > 1) c.seed = strtoull(words[1], NULL, 10);
    if (count > 3) c.step = strtod(words[3], NULL);
    draw_samples(c.seed);
    if (count > 2) {
        const unsigned long number = strtoul(words[2], NULL, 10);
        if (number >= SCENES)
            return fputs("usage: stability [second] [statics] [SEED [NUMBER [STEP]]], NUMBER 0 .. 999\n", stderr), 2;
        c.verbose = 1;
        try_scene((uint32_t)number, &c);
        return counts.failed > 0 || counts.static_failed > 0;
    }
    for (uint32_t i = 0; i < SCENES; ++i) try_scene(i, &c);
    print_summary(&c);
    return counts.failed > 0 || counts.static_failed > 0;
}
