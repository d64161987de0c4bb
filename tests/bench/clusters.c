/* The cost of bodies that joints connect directly. usage: clusters CSV K
 *
 * Scene K, bars of 1 m and 1 kg on revolute joints under gravity, in steps of 1 ms: a chain that swings, a tree of
 * which each bar carries two, and four-bars side by side, with their redundant equations (five each joint) and without
 * (the last joint of each loop a point on a line). The error is the largest violation of a joint. */
#define _POSIX_C_SOURCE 200809L

#include <drillmbd/drillmbd.h>

#include <stdio.h>

#include "row.h"

#define CLUSTERS_STEP 1e-3 /* [s] */

enum { CLUSTERS_REPEATS = 5, CLUSTERS_STEPS = 40, CLUSTERS_MOST = 1000 };
enum { KIND_CHAIN, KIND_TREE, KIND_LOOPS, KIND_LOOPS_REDUNDANT, CLUSTERS_KINDS };
static const char *const kind_names[CLUSTERS_KINDS] = {"chain", "tree", "loops", "loops_redundant"};

typedef struct machine {
    int kind;
    uint32_t size; /* bodies; of loops their number */
    dmb_model *model;
    dmb_id bars[2 * CLUSTERS_MOST];
    uint32_t count;
} machine;

typedef struct cost {
    double compile, create, step, spread, unit, iterations, violation;
    dmb_model_info info;
    uint32_t redundant, reserved;
} cost;

static yardstick unit;
static result_table results;

/* ---- Bars and hinges --------------------------------------------------------------------------------------------- */

/* From (x, z) at an angle from the world's x towards z. */
static int32_t add_bar(machine *m, double x, double z, double angle)
{
    dmb_body_def body = dmb_body_def_default();
    body.mass = 1.0;
    body.inertia[0] = 1e-3 / 12.0;
    body.inertia[1] = body.inertia[2] = 1.0 / 12.0;
    body.position[0] = x + 0.5 * cos(angle);
    body.position[2] = z + 0.5 * sin(angle);
    body.rotation[1] = -angle;
    return dmb_model_add_body(m->model, &body, &m->bars[m->count++]);
}

/* About -y, between ends of bars, 0.5 or -0.5 along them; of the ground: at (x, 0). */
static int32_t add_hinge(const machine *m, int32_t kind, uint32_t a, double along_a, uint32_t b, double along_b)
{
    const dmb_id ground = {0, 0};
    dmb_joint_def joint = dmb_joint_def_default();
    joint.kind = kind;
    joint.place_a = dmb_station(a == DMB_NONE ? ground : m->bars[a], 0, 0.0);
    joint.place_b = dmb_station(m->bars[b], 0, 0.0);
    joint.origin_a[0] = along_a;
    joint.origin_b[0] = along_b;
    joint.axis_a[0] = joint.axis_b[0] = 0.0;
    joint.axis_a[1] = joint.axis_b[1] = -1.0;
    joint.normal_a[0] = joint.normal_b[0] = 1.0;
    return dmb_model_add_joint(m->model, &joint, NULL);
}

static int32_t describe_chain(machine *m)
{
    int32_t status = DMB_OK;
    for (uint32_t i = 0; status >= 0 && i < m->size; ++i) {
        status = add_bar(m, i, 0.0, 0.0);
        if (status >= 0) status = add_hinge(m, DMB_JOINT_REVOLUTE, i ? i - 1 : DMB_NONE, i ? 0.5 : 0.0, i, -0.5);
    }
    return status;
}

/* Bar i hangs on bar (i - 1)/2, those of one level side by side. */
static int32_t describe_tree(machine *m)
{
    double x[CLUSTERS_MOST], z[CLUSTERS_MOST];
    int32_t status = DMB_OK;
    for (uint32_t i = 0; status >= 0 && i < m->size; ++i) {
        const uint32_t on = (i - 1) / 2;
        const double angle = i == 0 ? -1.4 : i % 2 ? -1.0 : -2.2, x0 = i ? x[on] : 0.0, z0 = i ? z[on] : 0.0;
        x[i] = x0 + cos(angle);
        z[i] = z0 + sin(angle);
        status = add_bar(m, x0, z0, angle);
        if (status >= 0) status = add_hinge(m, DMB_JOINT_REVOLUTE, i ? on : DMB_NONE, i ? 0.5 : 0.0, i, -0.5);
    }
    return status;
}

/* Cranks 0 .. size on the ground at x = 0 .. size, then the couplers between their tips. */
static int32_t describe_loops(machine *m)
{
    const int32_t last = m->kind == KIND_LOOPS ? DMB_JOINT_POINT_ON_LINE : DMB_JOINT_REVOLUTE;
    const double angle = 1.2, n = m->size;
    int32_t status = DMB_OK;
    for (double x = 0.0; status >= 0 && x <= n; x += 1.0) status = add_bar(m, x, 0.0, angle);
    for (double x = 0.0; status >= 0 && x < n; x += 1.0) status = add_bar(m, x + cos(angle), sin(angle), 0.0);
    for (uint32_t i = 0; status >= 0 && i <= m->size; ++i)
        status = add_hinge(m, DMB_JOINT_REVOLUTE, DMB_NONE, i, i, -0.5);
    for (uint32_t i = 0; status >= 0 && i < m->size; ++i) {
        status = add_hinge(m, DMB_JOINT_REVOLUTE, i, 0.5, m->size + 1 + i, -0.5);
        if (status >= 0) status = add_hinge(m, last, m->size + 1 + i, 0.5, i + 1, 0.5);
    }
    return status;
}

static int32_t machine_open(machine *m)
{
    m->count = 0;
    const int32_t status = dmb_model_create(NULL, &m->model);
    if (status < 0) return status;
    return m->kind == KIND_CHAIN ? describe_chain(m) : m->kind == KIND_TREE ? describe_tree(m) : describe_loops(m);
}

/* ---- Measures ---------------------------------------------------------------------------------------------------- */

static int32_t run_machine(const machine *m, cost *c, double *create, double *step)
{
    dmb_statistics statistics = dmb_statistics_default();
    dmb_sim *sim = NULL;
    double begin = processor_time();
    int32_t status = dmb_sim_create(m->model, NULL, &sim);
    *create = processor_time() - begin;
    begin = processor_time();
    for (int k = 0; status >= 0 && k < CLUSTERS_STEPS; ++k) status = dmb_sim_step(sim, CLUSTERS_STEP, NULL);
    *step = (processor_time() - begin) / CLUSTERS_STEPS;
    if (status >= 0) status = dmb_query_statistics(sim, &statistics);
    c->iterations = (double)statistics.iterations / CLUSTERS_STEPS;
    c->violation = statistics.violation;
    c->redundant = statistics.redundant;
    if (status < 0)
        row_failed("K", m->count, kind_names[m->kind], dmb_status_name(status),
                   sim ? dmb_sim_message(sim) : dmb_model_message(m->model));
    dmb_sim_destroy(&sim);
    return status;
}

static int32_t measure(machine *m, cost *c)
{
    double compile[CLUSTERS_REPEATS], create[CLUSTERS_REPEATS], step[CLUSTERS_REPEATS];
    int32_t status = DMB_OK;
    memset(c, 0, sizeof *c);
    yardstick_anew(&unit);
    c->info = dmb_model_info_default();
    for (int i = 0; status >= 0 && i < CLUSTERS_REPEATS; ++i) {
        status = machine_open(m);
        const double begin = processor_time();
        if (status >= 0) status = dmb_model_compile(m->model, NULL);
        compile[i] = processor_time() - begin;
        if (status >= 0) status = dmb_model_get_info(m->model, &c->info);
        if (status < 0)
            row_failed("K", m->count, kind_names[m->kind], dmb_status_name(status), dmb_model_message(m->model));
        if (status >= 0) status = run_machine(m, c, create + i, step + i);
        dmb_model_destroy(&m->model);
        yardstick_measure(&unit);
    }
    if (status < 0) return status;
    c->unit = yardstick_value(&unit);
    c->compile = median(compile, CLUSTERS_REPEATS);
    c->create = median(create, CLUSTERS_REPEATS);
    c->step = median(step, CLUSTERS_REPEATS);
    c->spread = (step[CLUSTERS_REPEATS - 1] - step[0]) / c->step;
    return status;
}

/* ---- Report ------------------------------------------------------------------------------------------------------ */

/* plain: [U] of loops with redundant equations the cost of those without; else NaN. */
static void report(const machine *m, const cost *c, double plain)
{
    const head h = {"K",           m->count,     CLUSTERS_STEP,        c->step, c->unit, CLUSTERS_STEP / c->step,
                    c->iterations, c->violation, "violation_of_joints"};
    result_row r;
    row_begin(&r, &h);
    row_number(&r, "spread", c->spread, 3);
    row_number(&r, "U_us", 1e6 * c->unit, 4);
    row_number(&r, "repeats", CLUSTERS_REPEATS, 3);
    row_word(&r, "kind", kind_names[m->kind]);
    row_number(&r, "rows", c->info.constraint_rows, 9);
    row_number(&r, "redundant", c->redundant, 9);
    row_number(&r, "us_compile", 1e6 * c->compile, 4);
    row_number(&r, "us_create", 1e6 * c->create, 4);
    row_number(&r, "us_per_step_per_body", 1e6 * c->step / m->count, 4);
    row_number(&r, "to_plain", c->step / c->unit / plain, 3);
    row_number(&r, "bytes_per_body", (double)(c->info.model_bytes + c->info.sim_bytes) / m->count, 6);
    row_put(&r, &results);
}

static int run_kind(int kind, const uint32_t *sizes, int count, double *steps)
{
    static machine m;
    for (int i = 0; i < count; ++i) {
        cost c;
        m.kind = kind;
        m.size = sizes[i];
        if (measure(&m, &c) < 0) return 1;
        report(&m, &c, kind == KIND_LOOPS_REDUNDANT ? steps[i] : (double)NAN);
        steps[i] = c.step / c.unit;
    }
    return 0;
}

int main(int count, char **words)
{
    static const uint32_t bodies[] = {10, 30, 100, 200, 300, CLUSTERS_MOST}, loops[] = {1, 2, 3, 5, 10, 40, 160};
    double steps[7];
    if (count != 3 || strcmp(words[2], "K") != 0) return fputs("usage: clusters CSV K\n", stderr), 2;
    if (table_open(&results, &unit, words[1]) != 0) return 2;
    int failed = run_kind(KIND_CHAIN, bodies, 6, steps);
    failed |= run_kind(KIND_TREE, bodies, 6, steps);
    failed |= run_kind(KIND_LOOPS, loops, 7, steps);
    failed |= run_kind(KIND_LOOPS_REDUNDANT, loops, 7, steps);
    return table_close(&results, words[1]) != 0 ? 2 : failed;
}
