/* Stepped sine: the same bits whatever thread a frequency is run in, how it ends, what it refuses. */
#include <math.h>
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "drillmbd/drillmbd.h"

enum { FREQUENCIES = 7, NUMBERS = 2 * 4 };

/* One frequency: five pipes on the wall of their hole, shaken along it. */
typedef struct job {
    double frequency;
    dmb_model *model;
    dmb_sim *sim;
    dmb_output output;
    dmb_stepped_sine_options options;
    int32_t status;
    double amplitudes[NUMBERS];
    dmb_stepped_sine_report report;
    uint64_t hash;
} job;

static void begin(job *j, double frequency)
{
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_segment sine = dmb_segment_default();
    dmb_drive_def drive = dmb_drive_def_default();
    memset(j, 0, sizeof *j);
    j->frequency = frequency;
    sine.kind = DMB_SEGMENT_HARMONIC;
    sine.h1 = 0.05;
    sine.omega = 2.0 * 3.14159265358979323846 * frequency;
    pipe.damping_time = 1e-3;
    assert_int_equal(dmb_model_create(NULL, &j->model), DMB_OK);
    assert_int_equal(dmb_model_add_wall(j->model, &wall, NULL), DMB_OK);
    assert_int_equal(dmb_model_add_pipes(j->model, &pipe, 5, &drive.part), DMB_OK);
    assert_int_equal(dmb_model_add_time_function(j->model, &sine, 1, &drive.time_function), DMB_OK);
    assert_int_equal(dmb_model_add_drive(j->model, &drive, NULL), DMB_OK);
    assert_int_equal(dmb_model_compile(j->model, NULL), DMB_OK);
    assert_int_equal(dmb_sim_create(j->model, NULL, &j->sim), DMB_OK);
    assert_int_equal(dmb_analysis_static(j->sim, NULL, NULL), DMB_OK);
    j->output = (dmb_output){.quantity = DMB_OUTPUT_VIBRATION};
    j->output.quantity = DMB_OUTPUT_SECTION_FORCE;
    j->output.place = dmb_station(drive.part, 0, 0.0);
    j->options = dmb_stepped_sine_options_default();
    j->options.steps_per_period = 32;
    j->options.windows = 40;
    j->report = dmb_stepped_sine_report_default();
}

static void run(job *j)
{
    j->status = dmb_analysis_stepped_sine(j->sim, j->frequency, &j->options, &j->output, 1, j->amplitudes, &j->report);
    (void)dmb_sim_hash(j->sim, &j->hash);
}

static void end(job *j)
{
    dmb_sim_destroy(&j->sim);
    dmb_model_destroy(&j->model);
}

/* ---- Threads ----------------------------------------------------------------------------------------------------- */

typedef struct worker {
    job *jobs;
    int first, step;
} worker;

static void *work(void *context)
{
    const worker *w = context;
    for (int i = w->first; i < FREQUENCIES; i += w->step) run(w->jobs + i);
    return NULL;
}

static void run_in(job *jobs, int threads)
{
    pthread_t thread[FREQUENCIES];
    worker workers[FREQUENCIES];
    for (int i = 0; i < FREQUENCIES; i++) begin(jobs + i, 3.0 + 2.0 * i);
    for (int i = 0; i < threads; i++) {
        workers[i] = (worker){jobs, i, threads};
        assert_int_equal(pthread_create(thread + i, NULL, work, workers + i), 0);
    }
    for (int i = 0; i < threads; i++) assert_int_equal(pthread_join(thread[i], NULL), 0);
    for (int i = 0; i < FREQUENCIES; i++) end(jobs + i);
}

static void same_bits_in_any_number_of_threads(void **state)
{
    (void)state;
    static job one[FREQUENCIES], many[FREQUENCIES];
    run_in(one, 1);
    for (int threads = 2; threads <= FREQUENCIES; threads += 2) {
        run_in(many, threads);
        for (int i = 0; i < FREQUENCIES; i++) {
            assert_int_equal(one[i].status, many[i].status);
            assert_true(one[i].status >= 0);
            assert_memory_equal(one[i].amplitudes, many[i].amplitudes, sizeof one[i].amplitudes);
            assert_memory_equal(&one[i].report, &many[i].report, sizeof one[i].report);
            assert_true(one[i].hash == many[i].hash);
        }
    }
}

/* ---- Ends and refusals ------------------------------------------------------------------------------------------- */

static void what_does_not_settle_is_told(void **state)
{
    (void)state;
    job j;
    begin(&j, 5.0);
    j.options.windows = 3;
    j.options.tolerance = 1e-12;
    run(&j);
    assert_int_equal(j.status, DMB_NOTE_STOPPED);
    assert_int_equal(j.report.settled, 0);
    assert_int_equal(j.report.windows, 3);
    assert_true(j.report.remaining > 1e-12);
    assert_true(fabs(j.report.time - 3.0 * 4.0 / 5.0) < 1e-12);
    assert_true(j.amplitudes[2] != 0.0);
    end(&j);
}

static void expect(job *j, int32_t status, const char *field)
{
    uint64_t before;
    assert_int_equal(dmb_sim_hash(j->sim, &before), DMB_OK);
    memset(j->amplitudes, 0x5A, sizeof j->amplitudes);
    const job kept = *j;
    run(j);
    assert_int_equal(j->status, status);
    assert_true(j->hash == before);
    assert_memory_equal(kept.amplitudes, j->amplitudes, sizeof kept.amplitudes);
    if (strstr(dmb_sim_message(j->sim), field) == NULL) fail_msg("%s: %s", field, dmb_sim_message(j->sim));
}

static void refusals(void **state)
{
    (void)state;
    job j;
    begin(&j, 5.0);
    const job good = j;
#define REFUSED(status, change, field) (j = good, (void)(change), expect(&j, status, field))
    REFUSED(DMB_ERR_VALUE, j.frequency = 0.0, "frequency = 0");
    REFUSED(DMB_ERR_NOT_FINITE, j.frequency = (double)NAN, "frequency = nan");
    REFUSED(DMB_ERR_VALUE, j.options.steps_per_period = 15, "steps_per_period");
    REFUSED(DMB_ERR_VALUE, j.options.periods = 0, "periods");
    REFUSED(DMB_ERR_VALUE, j.options.windows = 2, "windows");
    REFUSED(DMB_ERR_VALUE, j.options.harmonics = 17, "harmonics");
    REFUSED(DMB_ERR_VALUE, j.options.harmonics = 5, "harmonics = 5, must be <= steps_per_period/8");
    REFUSED(DMB_ERR_VALUE, j.options.tolerance = 0.0, "tolerance");
    REFUSED(DMB_ERR_VALUE, j.options.floor = 0.0, "floor");
    REFUSED(DMB_ERR_STRUCT_SIZE, j.options.struct_size = 1, "struct_size");
    REFUSED(DMB_ERR_VALUE, j.output.quantity = 99, "output 0: quantity = 99");
    REFUSED(DMB_ERR_VALUE, j.output.place.pipe = 5, "output 0, section_force_x of string 0 pipe 5 at 0: ");
#undef REFUSED
    j = good;
    assert_int_equal(dmb_analysis_stepped_sine(NULL, 1.0, NULL, &j.output, 1, j.amplitudes, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_analysis_stepped_sine(j.sim, 1.0, NULL, NULL, 1, j.amplitudes, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_analysis_stepped_sine(j.sim, 1.0, NULL, &j.output, 1, NULL, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_analysis_stepped_sine(j.sim, 1.0, NULL, &j.output, 0, j.amplitudes, NULL), DMB_ERR_VALUE);
    assert_int_equal(dmb_analysis_stepped_sine((dmb_sim *)(void *)j.model, 1.0, NULL, &j.output, 1, j.amplitudes, NULL),
                     DMB_ERR_HANDLE);
    end(&j);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(same_bits_in_any_number_of_threads),
        cmocka_unit_test(what_does_not_settle_is_told),
        cmocka_unit_test(refusals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
