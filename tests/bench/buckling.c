/* Scene E: the push at which a string on the low side of its hole buckles into a sine; EJ: the same of strings of one
 * pipe each, fixed to the one before by a described joint. usage: buckling CSV E
 *
 * Half of a pinned string, the middle free to move and not to turn, pipes of 1.5 m of four elements. The least of EI
 * k^2 + w/(r k^2) over whole numbers of half waves (Dawson, Paslay 1984) is given. A row tells processor time of one
 * dmb_analysis_buckling, one factor and shape, where others tell that of a step. */
#define _POSIX_C_SOURCE 200809L

#include <drillmbd/drillmbd.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "row.h"

enum { BUCKLING_REPEATS = 5, PER_PIPE = 4 };
#define BENDING 198411.2 /* [N m2], stiff in shear and stretch, which the closed form leaves out */
#define WEIGHT 139.3513  /* [N/m] */
#define CLEARANCE 0.0105 /* [m] */
#define WALL 1e9         /* [N/m2] */
#define PIPE 1.5         /* [m] */

static yardstick unit;
static result_table results;

typedef struct column {
    uint32_t pipes;
    int jointed;
    dmb_model *model;
    dmb_sim *sim;
    dmb_id last, push; /* string of the last pipe; load of 1 N that is off at present */
} column;

typedef struct cost {
    double seconds, spread, push; /* [s] [-] [N] */
} cost;

static double closed_form(const column *c)
{
    double least = (double)INFINITY;
    for (uint32_t n = 1; n < 4 * c->pipes; n += 2) { /* a crest in the middle */
        const double k = n * 3.14159265358979323846 / (2.0 * PIPE * c->pipes);
        least = fmin(least, BENDING * k * k + WEIGHT / (CLEARANCE * k * k));
    }
    return least;
}

/* ---- Scene --------------------------------------------------------------------------------------------------------
 */

static dmb_pipe_def pipe_of(void)
{
    dmb_pipe_def pipe = dmb_pipe_def_default();
    pipe.length = PIPE;
    pipe.elements = PER_PIPE;
    pipe.outer_diameter = 0.073;
    pipe.inner_diameter = 0.055;
    pipe.section_mass = WEIGHT / 9.81;
    for (int i = 0; i < 3; ++i) pipe.section_stiffness[i] = 1e6 * BENDING;
    for (int i = 3; i < 6; ++i) pipe.section_stiffness[i] = BENDING;
    return pipe;
}

/* All pipes in one string, or string `i` of one pipe behind another. */
static int32_t add_string(column *c, uint32_t i, uint32_t count)
{
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = pipe_of();
    dmb_joint_def joint = dmb_joint_def_default();
    def.offset[1] = -(CLEARANCE + WEIGHT / WALL); /* where the wall carries the weight */
    def.start_depth = i * PIPE;
    def.start_free = i == 0 ? DMB_FREE_SPHERICAL : DMB_FREE_ALL;
    if (i + count == c->pipes) def.end_free = DMB_FREE_TRANSLATIONS;
    joint.place_a = dmb_station(c->last, 0, 1.0);
    int32_t status = dmb_model_add_string(c->model, &def, &pipe.string);
    if (status >= 0) status = dmb_model_add_pipes(c->model, &pipe, count, NULL);
    c->last = pipe.string;
    joint.place_b = dmb_station(c->last, 0, 0.0);
    return status < 0 || i == 0 ? status : dmb_model_add_joint(c->model, &joint, NULL);
}

static int32_t add_push(column *c)
{
    dmb_load_def push = dmb_load_def_default();
    const dmb_segment off = dmb_segment_default();
    const int32_t status = dmb_model_add_time_function(c->model, &off, 1, &push.time_function);
    push.place = dmb_station(c->last, c->jointed ? 0 : c->pipes - 1, 1.0);
    push.force[0] = -1.0;
    return status < 0 ? status : dmb_model_add_load(c->model, &push, &c->push);
}

static int32_t open_column(column *c)
{
    dmb_wall_def wall = dmb_wall_def_default();
    int32_t status = dmb_model_create(NULL, &c->model);
    wall.diameter = 0.073 + 2.0 * CLEARANCE;
    wall.stiffness = WALL;
    wall.friction_law = DMB_FRICTION_NONE;
    if (status >= 0) status = dmb_model_add_wall(c->model, &wall, NULL);
    const uint32_t each = c->jointed ? 1 : c->pipes;
    for (uint32_t i = 0; status >= 0 && i < c->pipes; i += each) status = add_string(c, i, each);
    if (status >= 0) status = add_push(c);
    if (status >= 0) status = dmb_model_compile(c->model, NULL);
    if (status >= 0) status = dmb_sim_create(c->model, NULL, &c->sim);
    return status < 0 ? status : dmb_analysis_static(c->sim, NULL, NULL);
}

/* ---- Measurement --------------------------------------------------------------------------------------------------
 */

static int32_t measure(const column *c, cost *out)
{
    dmb_buckling_options options = dmb_buckling_options_default();
    double seconds[BUCKLING_REPEATS];
    int32_t status = DMB_OK;
    options.scale = DMB_SCALE_PART;
    options.part = c->push;
    yardstick_anew(&unit);
    for (int i = 0; status >= 0 && i < BUCKLING_REPEATS; ++i) {
        dmb_buckling *found = NULL;
        const double begin = processor_time();
        status = dmb_analysis_buckling(c->sim, &options, &found);
        seconds[i] = processor_time() - begin;
        if (status >= 0) status = dmb_buckling_factor(found, 0, &out->push);
        dmb_buckling_destroy(&found);
        for (int k = 0; k < 3; ++k) yardstick_measure(&unit);
    }
    if (status < 0) return status;
    out->seconds = median(seconds, BUCKLING_REPEATS);
    out->spread = (seconds[BUCKLING_REPEATS - 1] - seconds[0]) / out->seconds;
    return status;
}

static void report(const column *c, const cost *k)
{
    const double u = yardstick_value(&unit), none = (double)NAN;
    const head h = {c->jointed ? "EJ" : "E",
                    (double)c->pipes * PER_PIPE,
                    none,
                    k->seconds,
                    u,
                    none,
                    none,
                    fabs(k->push / closed_form(c) - 1.0),
                    "critical_push_vs_closed_form"};
    result_row r;
    row_begin(&r, &h);
    row_number(&r, "spread", k->spread, 3);
    row_number(&r, "U_us", 1e6 * u, 4);
    row_number(&r, "repeats", BUCKLING_REPEATS, 3);
    row_number(&r, "push", k->push, 9);
    row_put(&r, &results);
}

static int measure_column(uint32_t pipes, int jointed)
{
    column c = {.pipes = pipes, .jointed = jointed};
    cost k = {0.0, 0.0, 0.0};
    int32_t status = open_column(&c);
    if (status >= 0) status = measure(&c, &k);
    if (status >= 0) report(&c, &k);
    if (status < 0)
        row_failed(jointed ? "EJ" : "E", pipes * PER_PIPE, "buckling", dmb_status_name(status),
                   c.sim ? dmb_sim_message(c.sim) : dmb_model_message(c.model));
    dmb_sim_destroy(&c.sim);
    dmb_model_destroy(&c.model);
    return status < 0;
}

int main(int count, char **words)
{
    static const uint32_t pipes[] = {25, 50, 100, 250, 2500};
    int failures = 0;
    if (count != 3 || strcmp(words[2], "E") != 0) return fputs("usage: buckling CSV E\n", stderr), 2;
    if (table_open(&results, &unit, words[1]) != 0) return 2;
    for (int i = 0; i < 5; ++i) failures += measure_column(pipes[i], 0);
    for (int i = 0; i < 4; ++i) failures += measure_column(pipes[i], 1);
    return table_close(&results, words[1]) != 0 ? 2 : failures > 0;
}
