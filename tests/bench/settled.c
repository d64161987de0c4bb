/* The mean motion of a string on the wall. usage: settled CSV M
 *
 * Scene B beyond the time in which its motion follows from its start. A few starts, a hundredth of a millimetre apart
 * sideways, and two stretches of a second each: while it chatters, and after it has come to its speed. Means of the sum
 * of wall forces, of the torque of the drive, and how far to the side the pipes' ends are, root mean square of all of
 * them; the scatter over the starts gives the standard error. Sampled every 4 ms. */
#define _POSIX_C_SOURCE 200809L

#include "method.h"
#include "row.h"

#define SAMPLE_INTERVAL 4e-3 /* [s] */
#define START_OFFSET 1e-5    /* [m] between two starts */
#define SETTLED_END 3.0      /* [s] */

enum { STARTS = 4, SPANS = 2, SPAN_SAMPLES = 250, SETTLED_PIPES = 100, SETTLED_WAYS = 14, MEANS = 3 };

/* [s] beginnings of the two stretches. */
static const double span_starts[SPANS] = {0.1, 2.0};

static yardstick unit;
static result_table results;

typedef struct way {
    double step, tolerance, radius;
    uint32_t per_pipe;
} way;

/* The first is the reference. */
static const way ways[SETTLED_WAYS] = {
    {1.25e-4, 0.0, 0.8, 1}, {2.5e-4, 0.0, 0.8, 1}, {5e-4, 0.0, 0.8, 1}, {1e-3, 0.0, 0.8, 1}, {2e-3, 0.0, 0.8, 1},
    {4e-3, 0.0, 0.8, 1},    {1e-3, 0.0, 1.0, 1},   {1e-3, 0.0, 0.9, 1}, {1e-3, 0.0, 0.5, 1}, {1e-3, 0.0, 0.0, 1},
    {1e-3, 0.0, 0.8, 2},    {1e-3, 0.0, 0.8, 4},   {0.0, 1e-4, 0.8, 1}, {0.0, 1e-5, 0.8, 1}};

typedef struct settled {
    double seconds[STARTS];              /* [s] of processor time */
    double values[SPANS][MEANS][STARTS]; /* [N, N m, m] */
    double steps, iterations, rejected;  /* of all starts; iterations in all */
} settled;

/* ---- One stretch --------------------------------------------------------------------------------------------------
 */

/* [m2] mean over the pipes' ends of the square of their sideways displacement. */
static int32_t sideways(const scene *s, const dmb_sim *sim, double *square)
{
    int32_t status = DMB_OK;
    *square = 0.0;
    for (uint32_t i = 0; status >= 0 && i < s->pipes; ++i) {
        dmb_pose pose = dmb_pose_default();
        status = dmb_query_pose(sim, dmb_station(s->string, i, 1.0), &pose);
        *square += pose.position[1] * pose.position[1] / s->pipes;
    }
    return status;
}

static int32_t take_sample(const scene *s, const dmb_sim *sim, double sums[MEANS])
{
    dmb_contact_total contact = dmb_contact_total_default();
    dmb_drive_state drive = dmb_drive_state_default();
    double square = 0.0;
    int32_t status = dmb_query_contact_total(sim, &contact);
    if (status >= 0) status = dmb_query_drive(sim, s->turn, &drive);
    if (status >= 0) status = sideways(s, sim, &square);
    sums[0] += contact.normal_force;
    sums[1] += drive.force;
    sums[2] += square;
    return status;
}

/* Goes through a stretch and takes its means. */
static int32_t run_span(const scene *s, dmb_sim *sim, const method *how, int span, int start, settled *x)
{
    double sums[MEANS] = {0.0, 0.0, 0.0}, begin = processor_time();
    int32_t status = go_to(sim, how, span_starts[span]);
    x->seconds[start] += processor_time() - begin;
    for (int i = 1; status >= 0 && i <= SPAN_SAMPLES; ++i) {
        begin = processor_time();
        status = go_to(sim, how, span_starts[span] + i * SAMPLE_INTERVAL);
        x->seconds[start] += processor_time() - begin;
        if (status >= 0) status = take_sample(s, sim, sums);
    }
    x->values[span][0][start] = sums[0] / SPAN_SAMPLES;
    x->values[span][1][start] = sums[1] / SPAN_SAMPLES;
    x->values[span][2][start] = sqrt(sums[2] / SPAN_SAMPLES);
    return status;
}

/* ---- One start --------------------------------------------------------------------------------------------------- */

static int32_t run_spans(const scene *s, dmb_sim *sim, const method *how, int start, settled *x)
{
    dmb_statistics statistics = dmb_statistics_default();
    int32_t status = DMB_OK;
    for (int span = 0; status >= 0 && span < SPANS; ++span) status = run_span(s, sim, how, span, start, x);
    if (status >= 0) status = dmb_query_statistics(sim, &statistics);
    x->steps += (double)statistics.steps;
    x->iterations += (double)statistics.iterations;
    x->rejected += (double)statistics.rejected;
    return status;
}

static int32_t run(const way *w, const method *how, int start, settled *x)
{
    const dmb_sim_options options = options_of(how);
    scene s = {.kind = SCENE_B, .pipes = SETTLED_PIPES, .per_pipe = w->per_pipe, .length = 1.0};
    dmb_sim *sim = NULL;
    s.offset = start * START_OFFSET;
    int32_t status = scene_open(&s);
    if (status >= 0) status = dmb_sim_create(s.model, &options, &sim);
    if (status >= 0) status = run_spans(&s, sim, how, start, x);
    if (status < 0) {
        char what[64];
        snprintf(what, sizeof what, "dt=%g tolerance=%g radius=%g", w->step, w->tolerance, w->radius);
        row_failed("B", s.pipes * s.per_pipe, what, dmb_status_name(status),
                   sim       ? dmb_sim_message(sim)
                   : s.model ? dmb_model_message(s.model)
                             : "no model");
    }
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&s.model);
    return status;
}

/* All starts; 1 if one of them failed. */
static int run_starts(const way *w, const method *how, settled *x)
{
    int failed = 0;
    memset(x, 0, sizeof *x);
    yardstick_anew(&unit);
    for (int i = 0; i < STARTS && !failed; ++i) {
        failed = run(w, how, i, x) < 0;
        for (int k = 0; k < 3; ++k) yardstick_measure(&unit);
    }
    return failed;
}

/* ---- Report ------------------------------------------------------------------------------------------------------ */

/* Mean over the starts, and its standard error. */
static double mean_of(const double *values, double *standard_error)
{
    double mean = 0.0, square = 0.0;
    for (int i = 0; i < STARTS; ++i) mean += values[i] / STARTS;
    for (int i = 0; i < STARTS; ++i) square += pow(values[i] - mean, 2.0);
    *standard_error = sqrt(square / (STARTS * (STARTS - 1.0)));
    return mean;
}

static void put_means(result_row *r, const settled *x)
{
    static const char *const names[SPANS][MEANS][2] = {
        {{"chatter_force", "chatter_force_error"},
         {"chatter_torque", "chatter_torque_error"},
         {"chatter_sideways_mm", "chatter_sideways_mm_error"}},
        {{"force", "force_error"}, {"torque", "torque_error"}, {"sideways_mm", "sideways_mm_error"}}};
    static const double scales[MEANS] = {1.0, 1.0, 1e3};
    for (int span = 0; span < SPANS; ++span)
        for (int i = 0; i < MEANS; ++i) {
            double standard_error;
            const double mean = mean_of(x->values[span][i], &standard_error);
            row_number(r, names[span][i][0], scales[i] * mean, 6);
            row_number(r, names[span][i][1], scales[i] * standard_error, 2);
        }
}

/* force: settled, of the reference */
static void report(const way *w, settled *x, double force)
{
    double unused;
    const double mean = mean_of(x->values[1][0], &unused), u = yardstick_value(&unit),
                 seconds = median(x->seconds, STARTS), simulated = SETTLED_END * STARTS;
    const head h = {"B",
                    SETTLED_PIPES * w->per_pipe,
                    w->step > 0.0 ? w->step : simulated / x->steps,
                    seconds * STARTS / x->steps,
                    u,
                    SETTLED_END / seconds,
                    x->iterations / x->steps,
                    fabs(mean / force - 1.0),
                    "mean_wall_force_vs_125us"};
    result_row r;
    row_begin(&r, &h);
    row_number(&r, "spread", (x->seconds[STARTS - 1] - x->seconds[0]) / seconds, 3);
    row_number(&r, "U_us", 1e6 * u, 4);
    row_number(&r, "repeats", STARTS, 3);
    row_number(&r, "steps", x->steps, 9);
    row_number(&r, "rejected", x->rejected, 6);
    row_number(&r, "radius", w->radius, 3);
    row_number(&r, "elements_per_pipe", w->per_pipe, 3);
    row_number(&r, "tolerance", w->step > 0.0 ? (double)NAN : w->tolerance, 3);
    row_number(&r, "U_per_simulated_second", seconds / SETTLED_END / u, 5);
    put_means(&r, x);
    row_put(&r, &results);
}

static int run_all(void)
{
    int failures = 0;
    double force = (double)NAN;
    for (int i = 0; i < SETTLED_WAYS; ++i) {
        static settled x;
        double unused;
        method how = method_fixed(ways[i].step, 0.0);
        how.tolerance = ways[i].tolerance;
        how.radius = ways[i].radius;
        const int failed = run_starts(&ways[i], &how, &x);
        failures += failed;
        if (i == 0 && !failed) force = mean_of(x.values[1][0], &unused);
        if (!failed) report(&ways[i], &x, force);
    }
    return failures > 0;
}

int main(int count, char **words)
{
    if (count != 3 || strcmp(words[2], "M") != 0) return fputs("usage: settled CSV M\n", stderr), 2;
    if (table_open(&results, &unit, words[1]) != 0) return 2;
    const int failed = run_all();
    return table_close(&results, words[1]) != 0 ? 2 : failed;
}
