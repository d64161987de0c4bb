/* How does a string whip at the speeds it is turned at, where the linear response does not hold?
 *
 * usage: turning_string [--threads N]
 *
 * Ten pipes of 1 m lie in their hole and its mud, 2 mm eccentric. At each speed a sim is put at rest and its linear
 * response to the eccentric masses is taken there; then it is turned up to speed and runs on until the Fourier
 * amplitudes of its motion have settled. The faster it turns the further the pipes climb the wall, which the linear
 * response takes for a plane. Speeds are shared out to threads, each a model and a sim of its own: the number of
 * threads changes no digit. */
#include <drillmbd/drillmbd.h>
#include <math.h>
#include <stdio.h>

#include "command_line.h"
#include "share_out.h"

#define PIPES 10
#define SPEEDS 8
#define TURN 6.283185307179586477

enum { OUTPUTS = 3 };

typedef struct turning {
    double frequency; /* [Hz] turns a second */
    dmb_model *model;
    dmb_sim *sim;
    dmb_id string, drive;
    dmb_output outputs[OUTPUTS];
    double linear[OUTPUTS];           /* amplitude at the frequency */
    double amplitudes[OUTPUTS][4][2]; /* mean, 1x, 2x, 3x */
    dmb_stepped_sine_report report;
    int32_t status;
} turning;

/* ---- One speed --------------------------------------------------------------------------------------------------- */

static int32_t describe(turning *t)
{
    dmb_environment_def mud = dmb_environment_def_default();
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_string_def rig = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_segment up = dmb_segment_default();
    int32_t status = dmb_model_create(NULL, &t->model);
    mud.lateral_damping = 40.0;
    wall.friction_law = DMB_FRICTION_COULOMB;
    if (status >= 0) status = dmb_model_set_environment(t->model, &mud);
    if (status >= 0) status = dmb_model_add_wall(t->model, &wall, NULL);
    rig.start_free = DMB_FREE_RX;
    if (status >= 0) status = dmb_model_add_string(t->model, &rig, &t->string);
    pipe.string = t->string;
    pipe.length = 1.0;
    pipe.eccentricity = 2e-3;
    pipe.damping_time = 1e-3;
    if (status >= 0) status = dmb_model_add_pipes(t->model, &pipe, PIPES, NULL);
    up.kind = DMB_SEGMENT_STEP5;
    up.h1 = TURN * t->frequency;
    up.x1 = 1.0;
    if (status >= 0) status = dmb_model_add_time_function(t->model, &up, 1, &drive.time_function);
    drive.component = DMB_RX;
    if (status >= 0) status = dmb_model_add_drive(t->model, &drive, &t->drive);
    if (status >= 0) status = dmb_model_compile(t->model, NULL);
    return status < 0 ? status : dmb_sim_create(t->model, NULL, &t->sim);
}

static void ask(turning *t)
{
    for (int k = 0; k < OUTPUTS; k++) t->outputs[k] = (dmb_output){.quantity = DMB_OUTPUT_VIBRATION};
    t->outputs[0].place = dmb_station(t->string, PIPES / 2, 0.0);
    t->outputs[0].quantity += DMB_Y;
    t->outputs[1].place = t->outputs[0].place;
    t->outputs[1].quantity += DMB_Z;
    t->outputs[2].quantity = DMB_OUTPUT_CONTACT_NORMAL_FORCE;
    t->outputs[2].place.pipe = PIPES / 2;
}

static int32_t find_linear(turning *t)
{
    dmb_response_options options = dmb_response_options_default();
    dmb_excitation own = dmb_excitation_default();
    dmb_response *response = NULL;
    own.kind = DMB_EXCITATION_ECCENTRICITY;
    options.frequencies = &t->frequency;
    options.points = 1;
    options.friction = 0; /* a string that turns slides */
    int32_t status = dmb_analysis_response(t->sim, &options, &own, 1, t->outputs, OUTPUTS, &response);
    for (uint32_t k = 0; k < OUTPUTS && status >= 0; k++) {
        double value[2];
        status = dmb_response_transfer(response, 0, k, value);
        t->linear[k] = hypot(value[0], value[1]);
    }
    dmb_response_destroy(&response);
    return status;
}

static void run(turning *t)
{
    dmb_stepped_sine_options options = dmb_stepped_sine_options_default();
    options.steps_per_period = 200;
    options.windows = 60;
    options.tolerance = 0.01;
    t->report = dmb_stepped_sine_report_default();
    t->status = describe(t);
    if (t->status >= 0) t->status = dmb_analysis_static(t->sim, NULL, NULL);
    ask(t);
    if (t->status >= 0) t->status = find_linear(t);
    if (t->status >= 0) t->status = dmb_sim_advance(t->sim, 1.0, NULL);
    if (t->status >= 0)
        t->status = dmb_analysis_stepped_sine(t->sim, t->frequency, &options, t->outputs, OUTPUTS,
                                              &t->amplitudes[0][0][0], &t->report);
    if (t->status < 0)
        fprintf(stderr, "%g Hz: %s%s\n", t->frequency, dmb_model_message(t->model), dmb_sim_message(t->sim));
    dmb_sim_destroy(&t->sim);
    dmb_model_destroy(&t->model);
}

/* ---- All of them ------------------------------------------------------------------------------------------------- */

static void run_number(void *context, int number)
{
    run((turning *)context + number);
}

static double amplitude(const turning *t, int output, int harmonic)
{
    return hypot(t->amplitudes[output][harmonic][0], t->amplitudes[output][harmonic][1]);
}

static void print(const turning *t)
{
    printf("%5.0f  %-9s  %8.4f %8.4f  %8.4f %8.4f   %7.2f %7.2f %7.2f %7.2f\n", 60.0 * t->frequency,
           t->report.settled ? "settled" : "unsettled", 1e3 * t->linear[0], 1e3 * amplitude(t, 0, 1),
           1e3 * t->linear[1], 1e3 * amplitude(t, 1, 1), t->linear[2], amplitude(t, 2, 1), amplitude(t, 2, 2),
           t->amplitudes[2][0][0]);
}

int main(int count, char **words)
{
    static turning all[SPEEDS];
    int failed = 0;
    uint32_t threads = 2;
    const command_option options[] = {{.name = "threads",
                                       .value = "N",
                                       .help = "speeds at a time (2), which changes no digit",
                                       .low = 1.0,
                                       .high = THREADS,
                                       .whole = &threads}};
    const int stop =
        command_line(count, words, "How does a string whip where the linear response does not hold?", options, 1);
    if (stop >= 0) return stop;
    for (int i = 0; i < SPEEDS; i++) all[i].frequency = 2.5 + 0.25 * i;
    share_out(run_number, all, SPEEDS, (int)threads);
    puts("Middle of the string: sideways and up and down [mm], force of its ring on the wall [N]");
    puts("  rpm               y linear       1x  z linear       1x    linear      1x      2x    mean");
    for (int i = 0; i < SPEEDS; i++) {
        if (all[i].status >= 0) print(all + i);
        failed |= all[i].status < 0;
    }
    return failed;
}
