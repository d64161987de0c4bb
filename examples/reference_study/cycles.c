#include <math.h>
#include <stdio.h>

#include "study.h"

#define WINDOW (4.0 * 60.0 / RIG_ROTATION_RPM)    /* [s] four revolutions */
#define HALF_TURN (0.5 * 60.0 / RIG_ROTATION_RPM) /* [s] */
#define SLACK 1e-9                                /* [s] */
#define DROP_END 1.0                              /* [s] */
#define BIT_END 6.0                               /* [s] */

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
    const double end = run->options.end, bound = STUDY_JUMP / rig_samples_a_second(&run->options);
    run->height[0] = mean(take(recorder, RIG_DISPLACEMENT_Z + 6 * RIG_FIRST, 0.0, end));
    run->height[1] = mean(take(recorder, RIG_DISPLACEMENT_Z + 6 * RIG_BIT, 0.0, end));
    for (int p = 0; p < RIG_PIPES; ++p) {
        const span speed = take(recorder, RIG_VELOCITY_Z + 6 * p, 0.0, end);
        run->speed[p] = swing(speed, 0.0);
        run->jumps[p] = (double)jumps(speed, bound) / end;
    }
}

/* Swings are the differences of Z between each highest or lowest place and the next one. */
static double scatter(span z)
{
    double last = z.value[0], sum = 0.0, squares = 0.0, count = 0.0;
    for (uint64_t k = 1; k + 1 < z.count; ++k) {
        const double here = z.value[k * RIG_COLUMNS];
        const double before = here - z.value[(k - 1) * RIG_COLUMNS], after = z.value[(k + 1) * RIG_COLUMNS] - here;
        if (before * after >= 0.0) continue;
        const double swung = fabs(here - last);
        last = here;
        sum += swung;
        squares += swung * swung;
        count += 1.0;
    }
    const double centre = sum / count;
    return count < 2.0 ? (double)NAN : sqrt(fmax(squares / count - centre * centre, 0.0)) / centre;
}

static void watch_place(study_motion *m, const dmb_recorder *recorder, int place, double from, double to)
{
    for (int axis = 0; axis < STUDY_AXES; ++axis) {
        const span speed = take(recorder, RIG_VELOCITY_Z - 2 + axis + 6 * place, from, to);
        m->mean[axis] = mean(take(recorder, RIG_DISPLACEMENT_Z - 2 + axis + 6 * place, from, to));
        m->speed[axis] = swing(speed, mean(speed));
    }
    const span z = take(recorder, RIG_DISPLACEMENT_Z + 6 * place, from, to);
    double low = z.value[0], high = z.value[0];
    for (uint64_t k = 1; k < z.count; ++k) {
        low = fmin(low, z.value[k * RIG_COLUMNS]);
        high = fmax(high, z.value[k * RIG_COLUMNS]);
    }
    m->highest = high;
    m->above = high - m->mean[2];
    m->below = m->mean[2] - low;
    m->scatter = scatter(z);
}

/* Motion of each place in each driven stage. */
static void watch_stages(study_run *run, const dmb_recorder *recorder)
{
    const double bound = STUDY_JUMP / rig_samples_a_second(&run->options), *time = run->options.cycle.time;
    for (int stage = 0; stage < STUDY_DRIVEN; ++stage) {
        const double from = time[driven[stage]], to = time[driven[stage] + 1];
        for (int place = 0; place < RIG_PLACES; ++place) {
            study_motion *m = &run->motion[stage][place];
            watch_place(m, recorder, place, from, to);
            m->jumps = (double)jumps(take(recorder, RIG_VELOCITY_Z + 6 * place, from, to), bound) / (to - from);
        }
        for (int k = 0; k < STUDY_HALF_TURNS; ++k) {
            const double begin = from + k * HALF_TURN;
            const span energy = take(recorder, RIG_KINETIC_ENERGY, begin, begin + HALF_TURN);
            run->half_turn[stage][k] = swing(energy, mean(energy));
        }
    }
}

/* The first pipe follows the feed that the drive is given. */
static void watch_feed(study_run *run, const dmb_recorder *recorder)
{
    const double *row = recorder->table;
    double sum = 0.0;
    for (uint64_t k = 0; k < recorder->row_count; ++k, row += RIG_COLUMNS)
        sum += pow(row[RIG_VELOCITY_Z - 2 + 6 * RIG_FIRST] - row[RIG_FEED_SPEED], 2.0);
    run->feed_error = sqrt(sum / (double)recorder->row_count);
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
        watch_stages(run, recorder);
        watch_feed(run, recorder);
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

static void print_stage(const study_run *run, const char *name)
{
    static const char *const stages[STUDY_DRIVEN] = {"drilling", "pulling out"};
    static const char *const places[RIG_PLACES] = {"pipe 1", "middle pipe", "last pipe", "bit"};
    printf("  %s\n"
           "                              mean, mm            speed, mm/s          Z, mm            swings   jumps\n"
           "                               Y       Z       X       Y       Z   above   below  highest  scatter   1/s\n",
           name);
    for (int stage = 0; stage < STUDY_DRIVEN; ++stage)
        for (int place = 0; place < RIG_PLACES; ++place) {
            const study_motion *m = &run->motion[stage][place];
            printf("    %-11s %-12s %7.3f %7.3f %7.3f %7.3f %7.3f %7.3f %7.3f %8.3f %8.3f %5.1f\n", stages[stage],
                   places[place], 1e3 * m->mean[1], 1e3 * m->mean[2], 1e3 * m->speed[0], 1e3 * m->speed[1],
                   1e3 * m->speed[2], 1e3 * m->above, 1e3 * m->below, 1e3 * m->highest, m->scatter, m->jumps);
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
    for (int i = STUDY_RIGID; i <= STUDY_FULL; ++i) print_stage(runs + i, names[i]);
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
