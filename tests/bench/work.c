/* Work against error: the same question asked with different steps and settings. usage: work CSV W
 *
 * The error is the root mean square over a few instants of what differs from a reference, over a scale:
 *   C   tip speed, against d'Alembert's solution, over its own root mean square
 *   T   place of the tip, over the length of the string; reference: 4 elements a pipe, two small steps extrapolated
 *   B   place of the tip up to 0.1 s, over the clearance; reference: 4 elements a pipe, a small step
 *   R   torque of the drive, over its own root mean square; reference as T, but on the same mesh
 * Beside each error stands that of the reference itself: what the last halving of its step and its mesh changed. */
#define _POSIX_C_SOURCE 200809L

#include "answers.h"
#include "method.h"
#include "row.h"

enum { WORK_INSTANTS = 10, WORK_VALUES = 3, WORK_REPEATS = 2, WORK_SETTINGS = 9, WORK_SCENES = 4 };

static yardstick unit;
static result_table results;
static int failures;

/* ---- What is asked ----------------------------------------------------------------------------------------------- */

typedef struct setting {
    const char *name;
    double radius; /* [-] spectral radius */
    uint32_t per_pipe;
    int32_t pipe_kind;
    int controlled;
} setting;

static const setting settings[WORK_SETTINGS] = {{"default", 0.8, 1, DMB_PIPE_FLEXIBLE, 0},
                                                {"controlled", 0.8, 1, DMB_PIPE_FLEXIBLE, 1},
                                                {"radius_1", 1.0, 1, DMB_PIPE_FLEXIBLE, 0},
                                                {"radius_0.9", 0.9, 1, DMB_PIPE_FLEXIBLE, 0},
                                                {"radius_0.5", 0.5, 1, DMB_PIPE_FLEXIBLE, 0},
                                                {"radius_0", 0.0, 1, DMB_PIPE_FLEXIBLE, 0},
                                                {"elements_2", 0.8, 2, DMB_PIPE_FLEXIBLE, 0},
                                                {"elements_4", 0.8, 4, DMB_PIPE_FLEXIBLE, 0},
                                                {"axial_torsional", 0.8, 1, DMB_PIPE_AXIAL_TORSIONAL, 0}};

typedef struct plan {
    int kind;
    uint32_t pipes;
    int instants;
    double interval;     /* [s] between two instants, a multiple of 4 ms */
    int settings;        /* of the list above, the first so many */
    double finest;       /* [s] step of the default setting */
    double finest_other; /* [s] of the others */
    double reference;    /* [s] its smaller step */
    uint32_t per_pipe;   /* elements of its mesh; of C none */
    int smooth;          /* its two steps are extrapolated */
    double scale;        /* of the error; 0: root mean square of the answer */
    const char *error_kind;
} plan;

static const plan plans[WORK_SCENES] = {
    {SCENE_C, 100, 10, 0.08, 9, 3.125e-5, 1.25e-4, 0.0, 0, 1, 0.0, "rms_tip_speed_vs_exact"},
    {SCENE_T, 20, 10, 0.08, 8, 3.125e-5, 6.25e-5, 1.5625e-5, 4, 1, 20.0, "rms_tip_place_vs_richardson"},
    {SCENE_B, 100, 5, 0.02, 8, 3.125e-5, 6.25e-5, 1.5625e-5, 4, 0, 0.0105, "rms_tip_place_vs_15.6us"},
    {SCENE_R, 100, 10, 0.04, 2, 1.25e-4, 1.25e-4, 3.125e-5, 1, 1, 0.0, "rms_torque_vs_richardson"}};

/* ---- One run ----------------------------------------------------------------------------------------------------- */

typedef struct course {
    int32_t status;
    double values[WORK_INSTANTS][WORK_VALUES];
    double seconds, spread, steps, iterations, rejected;
} course;

static int32_t ask(const scene *s, const dmb_sim *sim, double values[WORK_VALUES])
{
    dmb_pose pose = dmb_pose_default();
    values[1] = values[2] = 0.0;
    if (s->kind == SCENE_C || s->kind == SCENE_R) {
        double both[2];
        const int32_t status = scene_ask(s, sim, both);
        values[0] = both[0];
        return status;
    }
    const int32_t status = dmb_query_pose(sim, dmb_station(s->string, s->pipes - 1, 1.0), &pose);
    memcpy(values, pose.position, sizeof pose.position);
    return status;
}

static int32_t run_once(const plan *p, const scene *s, dmb_sim *sim, const method *how, course *c, double *seconds)
{
    dmb_statistics before = dmb_statistics_default(), after = dmb_statistics_default();
    int32_t status = s->kind == SCENE_R ? dmb_analysis_static(sim, NULL, NULL) : DMB_OK;
    if (status >= 0) status = dmb_query_statistics(sim, &before);
    *seconds = 0.0;
    for (int i = 0; status >= 0 && i < p->instants; ++i) {
        const double begin = processor_time();
        status = go_to(sim, how, (i + 1) * p->interval);
        *seconds += processor_time() - begin;
        if (status >= 0) status = ask(s, sim, c->values[i]);
    }
    if (status >= 0) status = dmb_query_statistics(sim, &after);
    c->steps = (double)(after.steps - before.steps);
    c->iterations = (double)(after.iterations - before.iterations) / fmax(1.0, c->steps);
    c->rejected = (double)(after.rejected - before.rejected);
    return status;
}

static void run_repeats(const plan *p, const scene *s, const method *how, course *c)
{
    const dmb_sim_options options = options_of(how);
    double seconds[WORK_REPEATS];
    for (int i = 0; c->status >= 0 && i < how->repeats; ++i) {
        dmb_sim *sim = NULL;
        c->status = dmb_sim_create(s->model, &options, &sim);
        if (c->status >= 0) c->status = run_once(p, s, sim, how, c, &seconds[i]);
        if (c->status < 0) {
            char what[64];
            snprintf(what, sizeof what, "dt=%g tolerance=%g radius=%g", how->step, how->tolerance, how->radius);
            row_failed(scene_names[s->kind], s->pipes * s->per_pipe, what, dmb_status_name(c->status),
                       sim ? dmb_sim_message(sim) : dmb_model_message(s->model));
        }
        dmb_sim_destroy(&sim);
        for (int k = 0; k < 3; ++k) yardstick_measure(&unit);
    }
    if (c->status < 0) return;
    c->seconds = median(seconds, how->repeats);
    c->spread = (seconds[how->repeats - 1] - seconds[0]) / c->seconds;
}

static course run(const plan *p, const setting *x, const method *how)
{
    scene s = {.kind = p->kind, .pipes = p->pipes, .per_pipe = x->per_pipe, .length = 1.0, .pipe_kind = x->pipe_kind};
    course c;
    memset(&c, 0, sizeof c);
    yardstick_anew(&unit);
    c.status = scene_open(&s);
    if (c.status < 0)
        row_failed(scene_names[p->kind], s.pipes * s.per_pipe, x->name, dmb_status_name(c.status),
                   s.model ? dmb_model_message(s.model) : "no model");
    run_repeats(p, &s, how, &c);
    failures += c.status < 0;
    dmb_model_destroy(&s.model);
    return c;
}

/* ---- References and errors --------------------------------------------------------------------------------------- */

typedef struct reference {
    course course;
    double scale, error; /* the error in parts of the scale, as those held against it */
} reference;

static double difference(const plan *p, const course *a, const course *b)
{
    double sum = 0.0;
    for (int i = 0; i < p->instants; ++i)
        for (int k = 0; k < WORK_VALUES; ++k) sum += pow(a->values[i][k] - b->values[i][k], 2.0);
    return sqrt(sum / p->instants);
}

static double size_of(const plan *p, const course *a)
{
    course nothing;
    memset(&nothing, 0, sizeof nothing);
    return p->scale > 0.0 ? p->scale : difference(p, a, &nothing);
}

static course exact(const plan *p)
{
    course c;
    memset(&c, 0, sizeof c);
    for (int i = 0; i < p->instants; ++i) c.values[i][0] = exact_tip_speed(p->pipes, (i + 1) * p->interval);
    return c;
}

static course at_step(const plan *p, uint32_t per_pipe, double step)
{
    const setting x = {"reference", 0.8, per_pipe, DMB_PIPE_FLEXIBLE, 0};
    method how = method_fixed(step, 0.0);
    how.ledger = 0;
    how.repeats = 1;
    return run(p, &x, &how);
}

/* The change by twice the elements, at a step at which both are cheap. */
static double error_of_mesh(const plan *p)
{
    const double step = 16.0 * p->reference;
    const course coarse = at_step(p, p->per_pipe, step), fine = at_step(p, 2 * p->per_pipe, step);
    return difference(p, &coarse, &fine);
}

static reference find_reference(const plan *p)
{
    reference r;
    memset(&r, 0, sizeof r);
    if (p->kind == SCENE_C) {
        r.course = exact(p);
        r.scale = size_of(p, &r.course);
        return r;
    }
    const course coarse = at_step(p, p->per_pipe, 2.0 * p->reference), fine = at_step(p, p->per_pipe, p->reference);
    r.course = fine;
    for (int i = 0; p->smooth && i < p->instants; ++i)
        for (int k = 0; k < WORK_VALUES; ++k)
            r.course.values[i][k] = (4.0 * fine.values[i][k] - coarse.values[i][k]) / 3.0;
    r.scale = size_of(p, &r.course);
    r.error = difference(p, &fine, p->smooth ? &r.course : &coarse);
    if (p->per_pipe > 1) r.error += error_of_mesh(p);
    r.error /= r.scale;
    return r;
}

/* ---- The sweep --------------------------------------------------------------------------------------------------- */

static void report(const plan *p, const setting *x, method *how, const reference *ref)
{
    const double end = p->instants * p->interval;
    how->radius = x->radius;
    how->repeats = WORK_REPEATS;
    const course c = run(p, x, how);
    if (c.status < 0) return;
    const double u = yardstick_value(&unit);
    const head h = {scene_names[p->kind],
                    p->pipes * x->per_pipe,
                    how->step > 0.0 ? how->step : end / c.steps,
                    c.seconds / c.steps,
                    u,
                    end / c.seconds,
                    c.iterations,
                    difference(p, &c, &ref->course) / ref->scale,
                    p->error_kind};
    result_row r;
    row_begin(&r, &h);
    row_number(&r, "spread", c.spread, 3);
    row_number(&r, "U_us", 1e6 * u, 4);
    row_number(&r, "repeats", how->repeats, 3);
    row_number(&r, "end", end, 4);
    row_number(&r, "steps", c.steps, 9);
    row_number(&r, "rejected", c.rejected, 6);
    row_word(&r, "setting", x->name);
    row_number(&r, "radius", x->radius, 3);
    row_number(&r, "elements_per_pipe", x->per_pipe, 3);
    row_number(&r, "tolerance", how->step > 0.0 ? (double)NAN : how->tolerance, 3);
    row_number(&r, "U_per_simulated_second", c.seconds / end / u, 5);
    row_number(&r, "reference_error", ref->error, 2);
    row_put(&r, &results);
}

static void sweep(const plan *p)
{
    const reference ref = find_reference(p);
    if (ref.course.status < 0) return;
    for (int i = 0; i < p->settings; ++i) {
        const double finest = i == 0 ? p->finest : p->finest_other;
        if (settings[i].controlled)
            for (int power = 3; power <= 8; ++power) {
                method how = method_fixed(0.0, 0.0);
                how.tolerance = pow(10.0, -power);
                report(p, &settings[i], &how, &ref);
            }
        else
            for (double step = 4e-3; step > 0.99 * finest; step *= 0.5) {
                method how = method_fixed(step, 0.0);
                report(p, &settings[i], &how, &ref);
            }
    }
}

int main(int count, char **words)
{
    if (count != 3 || strcmp(words[2], "W") != 0) return fputs("usage: work CSV W\n", stderr), 2;
    if (table_open(&results, &unit, words[1]) != 0) return 2;
    for (int i = 0; i < WORK_SCENES; ++i) sweep(&plans[i]);
    if (table_close(&results, words[1]) != 0) return 2;
    return failures > 0;
}
