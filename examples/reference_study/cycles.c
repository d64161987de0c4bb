#include <math.h>
#include <stdio.h>

#include "study.h"

#define WINDOW (4.0 * 60.0 / RIG_ROTATION_RPM) /* [s] four revolutions */
#define SLACK 1e-9                             /* [s] */
#define DROP_END 1.0                           /* [s] */
#define BIT_END 6.0                            /* [s] */

/* Stages in which head and string move steadily: drill, pull out. */
static const int driven[STUDY_DRIVEN] = {1, 5};

void study_runs_describe(study_run runs[STUDY_RUNS], double step)
{
    static const rig_variant variants[STUDY_RUNS] = {
        [STUDY_RIGID] = {DMB_PIPE_RIGID, RIG_VIBRATION},
        [STUDY_CONTACT] = {DMB_PIPE_FLEXIBLE, RIG_CONTACT},
        [STUDY_RUBBING] = {DMB_PIPE_FLEXIBLE, RIG_FRICTION},
        [STUDY_FULL] = {DMB_PIPE_FLEXIBLE, RIG_VIBRATION},
        [STUDY_RIGID_DROPPED] = {DMB_PIPE_RIGID, RIG_VIBRATION},
        [STUDY_FULL_DROPPED] = {DMB_PIPE_FLEXIBLE, RIG_VIBRATION},
        [STUDY_RIGID_BIT] = {DMB_PIPE_RIGID, RIG_VIBRATION},
        [STUDY_FULL_BIT] = {DMB_PIPE_FLEXIBLE, RIG_VIBRATION},
    };
    for (int i = 0; i < STUDY_RUNS; ++i) {
        runs[i].options = rig_options_default();
        runs[i].options.quiet = 1;
        runs[i].options.step = step;
        runs[i].variant = variants[i];
        runs[i].whole = i < STUDY_RIGID_DROPPED;
    }
    for (int i = STUDY_RIGID_DROPPED; i <= STUDY_FULL_DROPPED; ++i) {
        runs[i].options.dropped = 1;
        runs[i].options.end = DROP_END;
    }
    for (int i = STUDY_RIGID_BIT; i <= STUDY_FULL_BIT; ++i) {
        runs[i].options.bit = STUDY_BIT;
        runs[i].options.end = BIT_END;
    }
}

/* ---- Reading the samples ----------------------------------------------------------------------------------------- */

/* Samples of one column from one time to before another. */
typedef struct span {
    const double *value; /* every RIG_COLUMNS-th */
    uint64_t count;
} span;

static span take(const dmb_recorder *recorder, int column, double from, double to)
{
    const double *rows = recorder->table;
    uint64_t first = 0, last;
    while (first < recorder->row_count && rows[first * RIG_COLUMNS] < from - SLACK) first++;
    for (last = first; last < recorder->row_count && rows[last * RIG_COLUMNS] < to - SLACK;) last++;
    const span taken = {rows + first * RIG_COLUMNS + column, last - first};
    return taken;
}

static double mean(span s)
{
    double sum = 0.0;
    for (uint64_t k = 0; k < s.count; ++k) sum += s.value[k * RIG_COLUMNS];
    return sum / (double)s.count;
}

/* Root of the mean square of what is off `centre`. */
static double swing(span s, double centre)
{
    double sum = 0.0;
    for (uint64_t k = 0; k < s.count; ++k) sum += pow(s.value[k * RIG_COLUMNS] - centre, 2.0);
    return sqrt(sum / (double)s.count);
}

/* Changes from one sample to the next by more than a bound. */
static uint64_t jumps(span s, double bound)
{
    uint64_t found = 0;
    for (uint64_t k = 1; k < s.count; ++k)
        found += fabs(s.value[k * RIG_COLUMNS] - s.value[(k - 1) * RIG_COLUMNS]) > bound;
    return found;
}

/* ---- One run ----------------------------------------------------------------------------------------------------- */

/* When the end of the last pipe lets go of the wall. A string that is dropped does so after its first contact. */
static void watch_wall(study_run *run, const dmb_recorder *recorder)
{
    const double *row = recorder->table;
    run->last_left = (double)NAN;
    for (uint64_t k = 1; k < recorder->row_count; ++k, row += RIG_COLUMNS) {
        if (row[RIG_NORMAL_FORCE] <= 0.0 || row[RIG_COLUMNS + RIG_NORMAL_FORCE] > 0.0) continue;
        run->left++;
        run->last_left = row[RIG_COLUMNS];
    }
}

static void watch_bit(study_run *run, const dmb_recorder *recorder)
{
    const double *time = run->options.cycle.time, end = fmin(time[driven[0] + 1], run->options.end);
    run->bit_speed = swing(take(recorder, RIG_VELOCITY_Z + 6 * RIG_BIT, time[driven[0]], end), 0.0);
}

static void watch_motion(study_run *run, const dmb_recorder *recorder)
{
    const double end = run->options.end, bound = STUDY_JUMP / run->options.rate;
    run->height[0] = mean(take(recorder, RIG_DISPLACEMENT_Z + 6 * RIG_FIRST, 0.0, end));
    run->height[1] = mean(take(recorder, RIG_DISPLACEMENT_Z + 6 * RIG_BIT, 0.0, end));
    for (int p = 0; p < RIG_PIPES; ++p) {
        const span speed = take(recorder, RIG_VELOCITY_Z + 6 * p, 0.0, end);
        run->speed[p] = swing(speed, 0.0);
        run->jumps[p] = (double)jumps(speed, bound) / end;
    }
}

static void watch_energy(study_run *run, const dmb_recorder *recorder)
{
    for (int stage = 0; stage < STUDY_DRIVEN; ++stage) {
        const double begin = run->options.cycle.time[driven[stage]];
        for (int k = 0; k < STUDY_WINDOWS; ++k) {
            const span energy = take(recorder, RIG_KINETIC_ENERGY, begin + k * WINDOW, begin + (k + 1) * WINDOW);
            run->energy[stage][k] = mean(energy);
            run->swing[stage][k] = swing(energy, run->energy[stage][k]);
        }
    }
    const double *time = run->options.cycle.time;
    const span wall = take(recorder, RIG_NORMAL_FORCE, time[driven[0]], time[driven[0] + 1]);
    run->wall_swing = swing(wall, mean(wall)) / mean(wall);
}

void study_run_work(void *context)
{
    study_run *run = context;
    rig_result result;
    run->status = rig_run(&run->options, &run->variant, &result);
    const dmb_recorder *recorder = &result.recording.recorder;
    if (run->status >= 0) watch_wall(run, recorder);
    if (run->status >= 0 && !run->options.dropped) watch_bit(run, recorder);
    if (run->status >= 0 && run->whole) {
        watch_motion(run, recorder);
        watch_energy(run, recorder);
    }
    rig_result_close(&result);
}

/* ---- Report ------------------------------------------------------------------------------------------------------ */

double study_window_begin(const study_run *run, int stage, int window)
{
    return run->options.cycle.time[driven[stage]] + window * WINDOW;
}

double study_window_end(const study_run *run, int stage, int window)
{
    return study_window_begin(run, stage, window + 1);
}

double study_energy(const study_run *run, int stage)
{
    double sum = 0.0;
    for (int k = 0; k < STUDY_WINDOWS; ++k) sum += run->energy[stage][k];
    return sum / STUDY_WINDOWS;
}

static void print_energy(const study_run runs[STUDY_RUNS])
{
    printf("  kinetic energy of pipe %u, over four revolutions each\n"
           "              contact only               with friction              with vibration too\n"
           "      from       mean        swing          mean        swing          mean        swing   J\n",
           runs[STUDY_FULL].options.pipes);
    for (int stage = 0; stage < STUDY_DRIVEN; ++stage)
        for (int k = 0; k < STUDY_WINDOWS; ++k) {
            printf("  %6.1f s", study_window_begin(runs, stage, k));
            for (int i = STUDY_CONTACT; i <= STUDY_FULL; ++i)
                printf("%s  %11.5f %11.5f", i > STUDY_CONTACT ? "  " : "", runs[i].energy[stage][k],
                       runs[i].swing[stage][k]);
            printf("\n");
        }
}

void study_runs_print(const study_run runs[STUDY_RUNS])
{
    static const char *const names[STUDY_RUNS] = {"rigid, friction and vibration",
                                                  "flexible, contact only",
                                                  "flexible, friction",
                                                  "flexible, friction and vibration",
                                                  "rigid, dropped from the axis",
                                                  "flexible, dropped from the axis",
                                                  "rigid, a bit that meets the wall",
                                                  "flexible, a bit that meets the wall"};
    const uint32_t pipes = runs->options.pipes;
    printf("The drilling cycle of %g s in time, with steps of %g ms\n", runs->options.end, 1e3 * runs->options.step);
    printf(
        "                                       mean height, mm    Z speed, mm/s               jumps a second\n"
        "                                      pipe 1      bit   pipe 1  pipe %-3u pipe %-3u  pipe 1  pipe %-3u pipe "
        "%u\n",
        pipes / 2, pipes, pipes / 2, pipes);
    for (int i = 0; i < STUDY_RIGID_DROPPED; ++i) {
        const study_run *run = runs + i;
        printf("  %-35s %7.3f %8.3f ", names[i], 1e3 * run->height[0], 1e3 * run->height[1]);
        for (int p = 0; p < RIG_PIPES; ++p) printf(" %8.3f", 1e3 * run->speed[p]);
        for (int p = 0; p < RIG_PIPES; ++p) printf(" %8.2f", run->jumps[p]);
        printf("\n");
    }
    for (int i = 0; i < STUDY_RUNS; ++i) {
        printf("  %-35s pipe %u leaves the wall %d times", names[i], pipes, runs[i].left);
        if (runs[i].left > 0) printf(", the last time at %.2f s", runs[i].last_left);
        if (!runs[i].options.dropped) printf("; Z speed of the bit while drilling %.3f mm/s", 1e3 * runs[i].bit_speed);
        printf("\n");
    }
    print_energy(runs);
    printf("\n");
}

int study_runs_write(const char *folder, const study_run runs[STUDY_RUNS])
{
    FILE *file = study_table(folder, "kinetic_energy.csv",
                             "time [s],contact mean [J],contact swing [J],friction mean [J],friction swing [J],"
                             "vibration mean [J],vibration swing [J]");
    if (file == NULL) return 1;
    for (int stage = 0; stage < STUDY_DRIVEN; ++stage)
        for (int k = 0; k < STUDY_WINDOWS; ++k) {
            fprintf(file, "%.17g", study_window_begin(runs, stage, k) + 0.5 * WINDOW);
            for (int i = STUDY_CONTACT; i <= STUDY_FULL; ++i)
                fprintf(file, ",%.17g,%.17g", runs[i].energy[stage][k], runs[i].swing[stage][k]);
            fprintf(file, "\n");
        }
    return fclose(file) != 0;
}
