/* How often does a hole fail that is known only roughly?
 *
 * usage: failure_probability [--samples N] [--threads N] [--seed N]
 *
 * Twenty eccentric pipes turn in a hole whose friction is lognormal; each pipe has an eccentricity of its own. Counted
 * are samples in which the rig's torque, and the wall's force, exceed their limits, each with the exact interval of 95
 * %. A sample is its number: neither threads nor processes change a digit. Built with MPI (failure_probability_mpi),
 * mpirun spreads the samples over processes. The Python package does the same from a scene file, with random fields,
 * rare failures and sensitivities: drillmbd probability. */
#include <drillmbd/drillmbd.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../command_line.h"
#include "../share_out.h"
#include "interval.h"
#include "stream.h"

#ifdef WITH_MPI
#include <mpi.h>
#endif

#define PIPES 20
#define STEPS 500
#define STEP 1e-3
#define SPEED 31.4159265358979 /* [rad/s] 300 rpm */

enum { LIMITS = 2, NUMBERS = LIMITS + 1, MOST_SAMPLES = 1000000 };

static const char *const names[LIMITS] = {"torque of the rig > 82 N m", "force of the wall > 4 kN"};
static const double limits[LIMITS] = {82.0, 4000.0};

/* ---- One sample -------------------------------------------------------------------------------------------------- */

static int32_t add_string(dmb_model *model, stream *s)
{
    dmb_pipe_def pipe = dmb_pipe_def_default();
    int32_t status = DMB_OK;
    for (int i = 0; i < PIPES && status >= 0; i++) {
        pipe.eccentricity = 1e-3 * exp(0.4 * stream_normal(s));
        pipe.eccentricity_angle = 6.283185307179586 * stream_uniform(s);
        status = dmb_model_add_pipes(model, &pipe, 1, NULL);
    }
    return status;
}

static int32_t describe(dmb_model *model, uint64_t seed, int number, dmb_id *head)
{
    stream s = stream_of(seed, (uint64_t)number);
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_drive_def feed = dmb_drive_def_default(), turn = dmb_drive_def_default();
    dmb_segment rest = dmb_segment_default(), up = dmb_segment_default();
    const double friction = exp(0.4 * stream_normal(&s));
    wall.mu_static *= friction;
    wall.mu_dynamic *= friction;
    up.kind = DMB_SEGMENT_STEP;
    up.x1 = 0.2;
    up.h1 = SPEED;
    turn.component = DMB_RX;
    int32_t status = dmb_model_add_wall(model, &wall, NULL);
    if (status >= 0) status = add_string(model, &s);
    if (status >= 0) status = dmb_model_add_time_function(model, &rest, 1, &feed.time_function);
    if (status >= 0) status = dmb_model_add_time_function(model, &up, 1, &turn.time_function);
    if (status >= 0) status = dmb_model_add_drive(model, &feed, NULL);
    if (status >= 0) status = dmb_model_add_drive(model, &turn, head);
    return status < 0 ? status : dmb_model_compile(model, NULL);
}

static int32_t drill(dmb_sim *sim, dmb_id head, double largest[LIMITS])
{
    dmb_static_options lying = dmb_static_options_default();
    lying.lay_on_wall = 1;
    int32_t status = dmb_analysis_static(sim, &lying, NULL);
    for (int i = 0; i < STEPS && status >= 0; i++) {
        dmb_drive_state rig = dmb_drive_state_default();
        dmb_contact_total wall = dmb_contact_total_default();
        status = dmb_sim_step(sim, STEP, NULL);
        if (status >= 0) status = dmb_query_drive(sim, head, &rig);
        if (status >= 0) status = dmb_query_contact_total(sim, &wall);
        largest[0] = fmax(largest[0], fabs(rig.force));
        largest[1] = fmax(largest[1], wall.normal_force);
    }
    return status;
}

/* result: largest torque [N m] and wall force [N]; then 1 where the sample could not be computed. */
static void compute(uint64_t seed, int number, double result[NUMBERS])
{
    dmb_model *model = NULL;
    dmb_sim *sim = NULL;
    dmb_id head = {0, 0};
    int32_t status = dmb_model_create(NULL, &model);
    if (status >= 0) status = describe(model, seed, number, &head);
    if (status >= 0) status = dmb_sim_create(model, NULL, &sim);
    if (status >= 0) status = drill(sim, head, result);
    if (status < 0) {
        const char *told = sim != NULL ? dmb_sim_message(sim) : dmb_model_message(model);
        fprintf(stderr, "sample %d, seed %llu: %s\n", number, (unsigned long long)seed, told);
        result[LIMITS] = 1.0;
    }
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
}

/* ---- All of them ------------------------------------------------------------------------------------------------- */

typedef struct study {
    uint64_t seed;
    int samples, first, stride; /* samples first, first + stride, ... */
    double (*results)[NUMBERS];
} study;

static void compute_number(void *context, int number)
{
    const study *s = context;
    const int i = s->first + number * s->stride;
    compute(s->seed, i, s->results[i]);
}

static void run_all(study *s, int threads)
{
    const int count = s->first < s->samples ? (s->samples - s->first - 1) / s->stride + 1 : 0;
    share_out(compute_number, s, count, threads);
}

static void tell(const char *name, int failures, int lost, int samples)
{
    double safe[2], failing[2];
    interval_of(failures, samples, 0.95, safe); /* a lost sample may be either */
    interval_of(failures + lost, samples, 0.95, failing);
    const int known = samples - lost;
    printf("%-28s %5d %9.4f   %.4f .. %.4f\n", name, failures, known > 0 ? (double)failures / known : 0.0, safe[0],
           failing[1]);
}

static int print(const study *s)
{
    int failures[LIMITS] = {0}, any = 0, lost = 0;
    for (int i = 0; i < s->samples; i++) {
        int fails = 0;
        const int known = s->results[i][LIMITS] < 0.5;
        for (int k = 0; k < LIMITS && known; k++) {
            const int over = s->results[i][k] >= limits[k];
            failures[k] += over;
            fails |= over;
        }
        any += fails;
        lost += !known;
    }
    stream first = stream_of(s->seed, 0); /* numpy.random.Generator(numpy.random.Philox(key=[seed, 0])).random() */
    printf("%d samples, seed %llu, %d lost; the stream of sample 0 begins with %.15f\n", s->samples,
           (unsigned long long)s->seed, lost, stream_uniform(&first));
    puts("failure                      count probability   95 % interval");
    for (int k = 0; k < LIMITS; k++) tell(names[k], failures[k], lost, s->samples);
    tell("any of them", any, lost, s->samples);
    return lost == s->samples;
}

/* The samples of all processes come together in the first, whose rank is 0. */
static int gather(const study *s, int rank)
{
#ifdef WITH_MPI
    double *all = s->results[0];
    const int count = s->samples * NUMBERS;
    (void)MPI_Reduce(rank == 0 ? MPI_IN_PLACE : all, all, count, MPI_DOUBLE, MPI_SUM, 0, MPI_COMM_WORLD);
#endif
    return rank == 0 ? print(s) : 0;
}

int main(int count, char **words)
{
    uint32_t samples = 64, threads = 2, seed = 1;
    int rank = 0, size = 1;
    const command_option options[] = {
        {.name = "samples", .value = "N", .help = "samples (64)", .low = 1.0, .high = MOST_SAMPLES, .whole = &samples},
        {.name = "threads",
         .value = "N",
         .help = "samples at a time (2), which changes no digit",
         .low = 1.0,
         .high = THREADS,
         .whole = &threads},
        {.name = "seed", .value = "N", .help = "of the random numbers (1)", .low = 0.0, .high = 1e6, .whole = &seed}};
    const int stop = command_line(
        count, words, "How often does a hole fail? Samples shared out to threads and processes.", options, 3);
    if (stop >= 0) return stop;
#ifdef WITH_MPI
    (void)MPI_Init(&count, &words);
    (void)MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    (void)MPI_Comm_size(MPI_COMM_WORLD, &size);
#endif
    study s = {seed, (int)samples, rank, size, calloc(samples, sizeof *s.results)};
    int status = 3;
    if (s.results != NULL) {
        run_all(&s, (int)threads);
        status = gather(&s, rank);
    }
    free(s.results);
#ifdef WITH_MPI
    (void)MPI_Finalize();
#endif
    return status;
}
