/* The cost of explicit joints. usage: joints CSV J
 *
 * Scene J: the tube of scene C, cut into strings of one pipe and one element that explicit fixed joints put together,
 * turned from 0 to 60 rpm through a revolute joint; beside it the same tube as one string. Both methods of constraints,
 * 10 to 10000 joints. */
#define _POSIX_C_SOURCE 200809L

#include <drillmbd/drillmbd.h>

#include <stdio.h>

#include "row.h"

#define TUBE_PI 3.14159265358979323846
#define JOINTS_STEP 1e-3 /* [s] */

enum { JOINTS_REPEATS = 5, JOINTS_SIZES = 4, JOINTS_WAYS = 3, JOINTS_STEPS = 50 };

/* The joints of the tube. */
enum { WAY_INDEPENDENT = 0, WAY_MULTIPLIERS = 1, WAY_STRING = 2 };
static const char *const way_names[JOINTS_WAYS] = {"independent", "multipliers", "structural"};

typedef struct tube {
    uint32_t joints;
    int way;
    dmb_model *model;
    dmb_id first; /* string, or the first one */
} tube;

/* All times in seconds, medians. */
typedef struct cost {
    double describe, compile, create, step, unit, spread, iterations, bytes, rotation;
    int repeats;
    dmb_model_info info;
} cost;

static yardstick unit;
static result_table results;

/* ---- The tube -------------------------------------------------------------------------------------------------- */

static int32_t add_tube_string(tube *t, uint32_t start, uint32_t pipes, int32_t start_free, dmb_id *id)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    string.position[0] = start;
    string.start_free = start_free;
    const int32_t status = dmb_model_add_string(t->model, &string, &pipe.string);
    pipe.outer_diameter = 0.073;
    pipe.inner_diameter = 0.059;
    pipe.young_modulus = 206e9;
    return status < 0 ? status : dmb_model_add_pipes(t->model, &pipe, pipes, id);
}

static int32_t add_turning(tube *t, dmb_id part)
{
    dmb_segment rise = dmb_segment_default();
    dmb_drive_def drive = dmb_drive_def_default();
    rise.kind = DMB_SEGMENT_STEP;
    rise.h1 = 2.0 * TUBE_PI;
    const int32_t status = dmb_model_add_time_function(t->model, &rise, 1, &drive.time_function);
    drive.part = part;
    drive.component = DMB_RX;
    return status < 0 ? status : dmb_model_add_drive(t->model, &drive, NULL);
}

static int32_t add_bearing(tube *t)
{
    dmb_joint_def bearing = dmb_joint_def_default();
    dmb_id id = {0, 0};
    bearing.kind = DMB_JOINT_REVOLUTE;
    bearing.place_b = dmb_station(t->first, 0, 0.0);
    const int32_t status = dmb_model_add_joint(t->model, &bearing, &id);
    return status < 0 ? status : add_turning(t, id);
}

static int32_t describe_pieces(tube *t)
{
    int32_t status = add_tube_string(t, 0, 1, DMB_FREE_ALL, &t->first);
    dmb_id before = t->first;
    if (status >= 0) status = add_bearing(t);
    for (uint32_t i = 1; status >= 0 && i <= t->joints; ++i) {
        dmb_joint_def joint = dmb_joint_def_default();
        joint.place_a = dmb_station(before, 0, 1.0);
        status = add_tube_string(t, i, 1, DMB_FREE_ALL, &before);
        joint.place_b = dmb_station(before, 0, 0.0);
        if (status >= 0) status = dmb_model_add_joint(t->model, &joint, NULL);
    }
    return status;
}

static int32_t describe_string(tube *t)
{
    const int32_t status = add_tube_string(t, 0, t->joints + 1, DMB_FREE_RX, &t->first);
    return status < 0 ? status : add_turning(t, t->first);
}

static int32_t tube_open(tube *t)
{
    dmb_environment_def weightless = dmb_environment_def_default();
    weightless.gravity[2] = 0.0;
    int32_t status = dmb_model_create(NULL, &t->model);
    if (status >= 0) status = dmb_model_set_environment(t->model, &weightless);
    if (status < 0) return status;
    return t->way == WAY_STRING ? describe_string(t) : describe_pieces(t);
}

/* ---- Measures -------------------------------------------------------------------------------------------------- */

/* [rad] at the far end of the first pipe: in the few steps of the longest tube the turning does not get much further.
 */
static int32_t rotation_of(const tube *t, const dmb_sim *sim, double *angle)
{
    return dmb_query_rotation(sim, dmb_station(t->first, 0, 1.0), angle);
}

/* Creation and steps of 1 ms. */
static int32_t run_tube(const tube *t, cost *c, double *create, double *step)
{
    dmb_sim_options options = dmb_sim_options_default();
    dmb_statistics statistics = dmb_statistics_default();
    dmb_sim *sim = NULL;
    options.constraint_method = t->way == WAY_MULTIPLIERS ? DMB_METHOD_MULTIPLIERS : DMB_METHOD_INDEPENDENT;
    double begin = processor_time();
    int32_t status = dmb_sim_create(t->model, &options, &sim);
    *create = processor_time() - begin;
    begin = processor_time();
    for (uint32_t k = 0; status >= 0 && k < JOINTS_STEPS; ++k) status = dmb_sim_step(sim, JOINTS_STEP, NULL);
    *step = (processor_time() - begin) / JOINTS_STEPS;
    if (status >= 0) status = dmb_query_statistics(sim, &statistics);
    if (status >= 0) status = rotation_of(t, sim, &c->rotation);
    c->iterations = (double)statistics.iterations / JOINTS_STEPS;
    if (status < 0)
        row_failed("J", t->joints + 1.0, way_names[t->way], dmb_status_name(status),
                   sim ? dmb_sim_message(sim) : dmb_model_message(t->model));
    dmb_sim_destroy(&sim);
    return status;
}

static int32_t measure_tube(tube *t, cost *c)
{
    double describe[JOINTS_REPEATS], compile[JOINTS_REPEATS], create[JOINTS_REPEATS], step[JOINTS_REPEATS];
    const int repeats = t->joints < 5000 ? JOINTS_REPEATS : 3;
    int32_t status = DMB_OK;
    memset(c, 0, sizeof *c);
    yardstick_anew(&unit);
    c->info = dmb_model_info_default();
    for (int i = 0; i < repeats && status >= 0; ++i) {
        double begin = processor_time();
        status = tube_open(t);
        describe[i] = processor_time() - begin;
        begin = processor_time();
        if (status >= 0) status = dmb_model_compile(t->model, NULL);
        compile[i] = processor_time() - begin;
        if (status >= 0) status = dmb_model_get_info(t->model, &c->info);
        if (status < 0)
            row_failed("J", t->joints + 1.0, way_names[t->way], dmb_status_name(status), dmb_model_message(t->model));
        if (status >= 0) status = run_tube(t, c, create + i, step + i);
        dmb_model_destroy(&t->model);
        yardstick_measure(&unit);
    }
    if (status < 0) return status;
    c->repeats = repeats;
    c->unit = yardstick_value(&unit);
    c->describe = median(describe, repeats);
    c->compile = median(compile, repeats);
    c->create = median(create, repeats);
    c->step = median(step, repeats);
    c->spread = (step[repeats - 1] - step[0]) / c->step;
    c->bytes = (double)c->info.model_bytes + (double)c->info.sim_bytes;
    return status;
}

/* ---- Report ---------------------------------------------------------------------------------------------------- */

static void report(uint32_t joints, int way, const cost *c, const cost *string)
{
    const double n = joints;
    const head h = {"J",
                    n + 1.0,
                    JOINTS_STEP,
                    c->step,
                    c->unit,
                    JOINTS_STEP / c->step,
                    c->iterations,
                    fabs(c->rotation / string->rotation - 1.0),
                    "rotation_vs_structural"};
    result_row r;
    row_begin(&r, &h);
    row_number(&r, "spread", c->spread, 3);
    row_number(&r, "U_us", 1e6 * c->unit, 4);
    row_number(&r, "repeats", c->repeats, 3);
    row_number(&r, "joints", n, 9);
    row_word(&r, "method", way_names[way]);
    row_number(&r, "rows", c->info.constraint_rows, 9);
    row_number(&r, "clusters", c->info.clusters, 9);
    row_number(&r, "us_describe", 1e6 * c->describe, 4);
    row_number(&r, "us_compile", 1e6 * c->compile, 4);
    row_number(&r, "us_create", 1e6 * c->create, 4);
    row_number(&r, "us_create_per_joint", 1e6 * c->create / n, 4);
    row_number(&r, "us_per_step_per_joint", 1e6 * c->step / n, 4);
    row_number(&r, "to_structural", c->step / string->step, 3);
    row_number(&r, "bytes_per_joint", c->bytes / n, 6);
    row_put(&r, &results);
}

static int run_all(void)
{
    static cost costs[JOINTS_WAYS][JOINTS_SIZES];
    static const uint32_t joints[JOINTS_SIZES] = {10, 100, 1000, 10000};
    for (int i = 0; i < JOINTS_SIZES; ++i)
        for (int way = JOINTS_WAYS - 1; way >= 0; --way) {
            tube t = {.joints = joints[i], .way = way};
            if (measure_tube(&t, &costs[way][i]) < 0) return 1;
            report(t.joints, way, &costs[way][i], &costs[WAY_STRING][i]);
        }
    return 0;
}

int main(int count, char **words)
{
    if (count != 3 || strcmp(words[2], "J") != 0) return fputs("usage: joints CSV J\n", stderr), 2;
    if (table_open(&results, &unit, words[1]) != 0) return 2;
    const int failed = run_all();
    return table_close(&results, words[1]) != 0 ? 2 : failed;
}
