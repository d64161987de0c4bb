/* SUNDIALS on the library's own equations. usage: peer_sundials CSV [C] [B]   (default: both)
 * IDA, backward differentiation of variable order and step, and ARKODE, diagonally implicit Runge-Kutta, against the
 * library's generalized-alpha in fixed and in error-controlled steps: the same scenes, the same residual, the same
 * question, the same reference. */
#define _POSIX_C_SOURCE 200809L

#include <arkode/arkode_arkstep.h>
#include <ida/ida.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_version.h>
#include <sunlinsol/sunlinsol_band.h>
#include <sunmatrix/sunmatrix_band.h>

#include <stdio.h>
#include <string.h>

#include "peer_equations.h" /* before the others: some names in the library's headers are types in theirs */

#include "peer_library.h"

enum { ELEMENTS = 100 };

static yardstick unit;
static result_table rows;
static int failures;

/* ---- SUNDIALS on the equations ----------------------------------------------------------------------------------- */

enum { BY_IDA = 0, BY_ARKODE = 1 };

typedef struct peer_method {
    int code;
    double tolerance;
    int order;      /* IDA: highest, 1..5; up to 2 the formulas damp every frequency (A-stable). ARKODE: 2..5, all do */
    int difference; /* 1: Jacobian by IDA's band difference quotients, 0: from the library's blocks */
} peer_method;

typedef struct peer_run {
    equations e;
    SUNContext context;
    void *ida, *arkode;
    N_Vector y, dy, tolerance;
    SUNMatrix matrix;
    SUNLinearSolver solver;
} peer_run;

/* Return values: 1, what failed may be done with a smaller step. */
static int residual_of(realtype t, N_Vector y, N_Vector dy, N_Vector F, void *data)
{
    return equations_residual(data, t, N_VGetArrayPointer(y), N_VGetArrayPointer(dy), N_VGetArrayPointer(F)) < 0;
}

static int rates_of(realtype t, N_Vector y, N_Vector f, void *data)
{
    return equations_rates(data, t, N_VGetArrayPointer(y), N_VGetArrayPointer(f)) < 0;
}

static int factor(realtype t, realtype rate, N_Vector y, N_Vector dy, N_Vector F, SUNMatrix J, void *data, N_Vector a,
                  N_Vector b, N_Vector c)
{
    (void)F, (void)J, (void)a, (void)b, (void)c;
    return equations_factor(data, t, rate, N_VGetArrayPointer(y), N_VGetArrayPointer(dy)) < 0;
}

/* I - gamma df/dy; the accelerations that stand in it are f's own. */
static int factor_stage(realtype t, N_Vector y, N_Vector f, SUNMatrix A, SUNMatrix M, booleantype keep,
                        booleantype *renewed, realtype gamma, void *data, N_Vector a, N_Vector b, N_Vector c)
{
    (void)A, (void)M, (void)keep, (void)a, (void)b, (void)c;
    *renewed = SUNTRUE;
    return equations_factor(data, t, 1.0 / gamma, N_VGetArrayPointer(y), N_VGetArrayPointer(f)) < 0;
}

static int solve(SUNLinearSolver solver, SUNMatrix J, N_Vector x, N_Vector b, realtype tolerance)
{
    (void)J, (void)tolerance;
    equations_solve(solver->content, N_VGetArrayPointer(b), N_VGetArrayPointer(x));
    return 0;
}

static int solve_stage(SUNLinearSolver solver, SUNMatrix A, N_Vector x, N_Vector b, realtype tolerance)
{
    (void)A, (void)tolerance;
    equations_solve_explicit(solver->content, N_VGetArrayPointer(b), N_VGetArrayPointer(x));
    return 0;
}

static SUNMatrix_ID matrix_id(SUNMatrix matrix)
{
    return (void)matrix, SUNMATRIX_CUSTOM;
}
static int matrix_zero(SUNMatrix matrix)
{
    return (void)matrix, 0;
}
static SUNLinearSolver_Type solver_type(SUNLinearSolver solver)
{
    return (void)solver, SUNLINEARSOLVER_DIRECT;
}
static int solver_setup(SUNLinearSolver solver, SUNMatrix matrix)
{
    return (void)solver, (void)matrix, 0;
}

/* The matrix lives in the library's blocks; SUNDIALS only needs to think that there is one. */
static int use_blocks(peer_run *run)
{
    run->matrix = SUNMatNewEmpty(run->context);
    run->solver = SUNLinSolNewEmpty(run->context);
    if (!run->matrix || !run->solver) return 0;
    run->matrix->ops->getid = matrix_id;
    run->matrix->ops->zero = matrix_zero;
    run->solver->content = &run->e;
    run->solver->ops->gettype = solver_type;
    run->solver->ops->setup = solver_setup;
    run->solver->ops->solve = run->arkode ? solve_stage : solve;
    if (run->arkode)
        return ARKStepSetLinearSolver(run->arkode, run->solver, run->matrix) == 0 &&
               ARKStepSetLinSysFn(run->arkode, factor_stage) == 0;
    return IDASetLinearSolver(run->ida, run->solver, run->matrix) == 0 && IDASetJacFn(run->ida, factor) == 0;
}

/* A row of velocities depends on all unknowns of both neighbours. */
static int use_differences(peer_run *run)
{
    const sunindextype below = PEER_NODE + PEER_NODE - 1, above = PEER_NODE + PEER_NODE - 1 - PEER_V;
    run->matrix = SUNBandMatrix(N_VGetLength(run->y), above, below, run->context);
    if (!run->matrix) return 0;
    run->solver = SUNLinSol_Band(run->y, run->matrix, run->context);
    return run->solver && IDASetLinearSolver(run->ida, run->solver, run->matrix) == 0;
}

/* As the library's: metres a tenth of radians; speeds likewise, a second counted as one. */
static void fill_tolerances(N_Vector tolerances, double tolerance)
{
    double *a = N_VGetArrayPointer(tolerances);
    for (sunindextype i = 0; i < N_VGetLength(tolerances); i++) {
        const sunindextype k = i % PEER_NODE;
        a[i] = k < PEER_Q || (k >= PEER_V && k < PEER_V + 3) ? 0.1 * tolerance : tolerance;
    }
}

static int ida_open(peer_run *run, const peer_method *how)
{
    run->ida = IDACreate(run->context);
    if (!run->ida || IDAInit(run->ida, residual_of, 0.0, run->y, run->dy) != 0) return 0;
    return IDASetUserData(run->ida, &run->e) == 0 && IDASVtolerances(run->ida, how->tolerance, run->tolerance) == 0 &&
           IDASetMaxOrd(run->ida, how->order) == 0 && IDASetMaxNumSteps(run->ida, 100000000) == 0 &&
           (how->difference ? use_differences(run) : use_blocks(run));
}

static int arkode_open(peer_run *run, const peer_method *how)
{
    if (equations_mass(&run->e, N_VGetArrayPointer(run->y)) < 0) return 0;
    run->arkode = ARKStepCreate(NULL, rates_of, 0.0, run->y, run->context);
    if (!run->arkode || ARKStepSetUserData(run->arkode, &run->e) != 0) return 0;
    return ARKStepSVtolerances(run->arkode, how->tolerance, run->tolerance) == 0 &&
           ARKStepSetOrder(run->arkode, how->order) == 0 && ARKStepSetMaxNumSteps(run->arkode, 100000000) == 0 &&
           use_blocks(run);
}

static int peer_open(peer_run *run, dmb_sim *sim, const peer_method *how)
{
    memset(run, 0, sizeof *run);
    if (!equations_open(&run->e, sim) || SUNContext_Create(NULL, &run->context) != 0) return 0;
    const sunindextype count = (sunindextype)PEER_NODE * run->e.scene->node_count;
    run->y = N_VNew_Serial(count, run->context);
    run->dy = N_VNew_Serial(count, run->context);
    run->tolerance = N_VNew_Serial(count, run->context);
    if (!run->y || !run->dy || !run->tolerance) return 0;
    equations_start(&run->e, N_VGetArrayPointer(run->y), N_VGetArrayPointer(run->dy));
    fill_tolerances(run->tolerance, how->tolerance);
    return how->code == BY_ARKODE ? arkode_open(run, how) : ida_open(run, how);
}

static void peer_close(peer_run *run, const peer_method *how)
{
    if (run->ida) IDAFree(&run->ida);
    if (run->arkode) ARKStepFree(&run->arkode);
    if (run->solver && how->difference)
        SUNLinSolFree(run->solver);
    else if (run->solver)
        SUNLinSolFreeEmpty(run->solver);
    if (run->matrix && how->difference)
        SUNMatDestroy(run->matrix);
    else if (run->matrix)
        SUNMatFreeEmpty(run->matrix);
    if (run->y) N_VDestroy(run->y);
    if (run->dy) N_VDestroy(run->dy);
    if (run->tolerance) N_VDestroy(run->tolerance);
    if (run->context) SUNContext_Free(&run->context);
    equations_close(&run->e);
}

static int go_to_stop(peer_run *run, double stop, double *t)
{
    if (run->ida)
        return IDASetStopTime(run->ida, stop) == 0 && IDASolve(run->ida, stop, t, run->y, run->dy, IDA_NORMAL) >= 0;
    return ARKStepSetStopTime(run->arkode, stop) == 0 && ARKStepEvolve(run->arkode, stop, run->y, t, ARK_NORMAL) >= 0;
}

/* To `end`, stopping where the drive's time function has its corner, as the library does. */
static int peer_go(peer_run *run, double end)
{
    double t = 0.0;
    for (double stop = fmin(1.0, end); t < end; stop = end)
        if (!go_to_stop(run, stop, &t)) return fprintf(stderr, "peer_sundials: gives up at %g s\n", t), 0;
    return !run->arkode || equations_rates(&run->e, end, N_VGetArrayPointer(run->y), N_VGetArrayPointer(run->dy)) >= 0;
}

/* One timed run from time 0; creation left out, as with the library. */
static int peer_measure(const scene *s, const peer_method *how, double end, peer_row *found, double values[2])
{
    dmb_sim *sim = NULL;
    peer_run run;
    long steps = 0;
    memset(&run, 0, sizeof run);
    int good = dmb_sim_create(s->model, NULL, &sim) >= 0 && peer_open(&run, sim, how);
    residuals_evaluated = tangents_evaluated = 0.0;
    const double begin = processor_time();
    good = good && peer_go(&run, end);
    found->seconds = processor_time() - begin;
    found->residuals = residuals_evaluated;
    found->tangents = tangents_evaluated;
    if (good && run.ida) IDAGetNumSteps(run.ida, &steps);
    if (good && run.arkode) ARKStepGetNumSteps(run.arkode, &steps);
    found->steps = (double)steps;
    found->end = end;
    good = good &&
           equations_finish(&run.e, end, N_VGetArrayPointer(run.y), N_VGetArrayPointer(run.dy),
                            2.0 * BENCH_PI * fmax(0.0, end - 0.5)) >= 0 &&
           scene_ask(s, sim, values) >= 0;
    peer_close(&run, how);
    dmb_sim_destroy(&sim);
    yardstick_measure(&unit);
    found->yardstick = yardstick_value(&unit);
    return good;
}

/* ---- Rows -------------------------------------------------------------------------------------------------------- */

typedef struct question {
    const scene *s;
    double end, reference[2];
    const char *name;
} question;

/* [-] relative, but a position in its own unit: it may be near 0. */
static void fill_errors(const question *ask, const double values[2], peer_row *found)
{
    static char kinds[2][64];
    for (int i = 0; i < 2; i++) {
        const char *const quantity = quantity_names[ask->s->kind][i];
        const double difference = fabs(values[i] - ask->reference[i]);
        found->error[i] = strstr(quantity, "_mm") ? difference : difference / fabs(ask->reference[i]);
        snprintf(kinds[i], sizeof kinds[i], "%s_vs_%s", quantity, ask->name);
        found->error_kind[i] = kinds[i];
    }
    if (ask->s->kind != SCENE_C) return;
    const double exact =
        exact_tip_speed(ask->s->pipes * ask->s->length, ask->end); /* the mesh's error is in this one */
    found->error[1] = fabs(values[0] - exact) / exact;
    found->error_kind[1] = "tip_speed_vs_exact";
}

static void report_peer(const question *ask, const peer_method *how)
{
    char setting[96];
    double values[2];
    peer_row found;
    memset(&found, 0, sizeof found);
    snprintf(setting, sizeof setting, "tolerance=%g;order=%d;jacobian=%s", how->tolerance, how->order,
             how->difference ? "differences" : "blocks");
    found.code = how->code == BY_ARKODE ? "ARKODE" : "IDA";
    found.version = SUNDIALS_VERSION;
    found.scene = scene_names[ask->s->kind];
    found.setting = setting;
    found.elements = ELEMENTS;
    if (!peer_measure(ask->s, how, ask->end, &found, values)) {
        row_failed(found.scene, ELEMENTS, setting, "integrator", found.code);
        ++failures;
        return;
    }
    fill_errors(ask, values, &found);
    peer_row_report(&rows, &found);
}

static void report_library(const question *ask, double step, double tolerance)
{
    method how = method_fixed(step, ask->end);
    char setting[96], version[32];
    double values[2];
    peer_row found;
    how.tolerance = tolerance;
    how.ledger = 0;
    memset(&found, 0, sizeof found);
    snprintf(version, sizeof version, "%d.%d.%d", DMB_VERSION_MAJOR, DMB_VERSION_MINOR, DMB_VERSION_PATCH);
    snprintf(setting, sizeof setting, step > 0.0 ? "dt=%g" : "tolerance=%g", step > 0.0 ? step : tolerance);
    found.code = "drillmbd";
    found.version = version;
    found.scene = scene_names[ask->s->kind];
    found.setting = setting;
    found.elements = ELEMENTS;
    residuals_evaluated = tangents_evaluated = 0.0;
    if (!library_measure(ask->s, &how, &unit, &found, values)) {
        ++failures;
        return;
    }
    found.residuals = residuals_evaluated;
    found.tangents = tangents_evaluated;
    fill_errors(ask, values, &found);
    peer_row_report(&rows, &found);
}

/* ---- The plan ---------------------------------------------------------------------------------------------------- */

/* C is asked at its end, B early, where its motion still follows from its start (as in bench.c). Both against IDA at a
 * tolerance of 1e-10: it converges further than small fixed steps do, and the library's answers have to converge to
 * what another integrator found. */
static int question_of(const scene *s, question *ask)
{
    const peer_method how = {BY_IDA, 1e-10, 5, 0};
    peer_row unused;
    memset(&unused, 0, sizeof unused);
    ask->s = s;
    ask->end = s->kind == SCENE_C ? 2.0 : 0.1;
    ask->name = "IDA_1e-10";
    return peer_measure(s, &how, ask->end, &unused, ask->reference);
}

static void compare(const question *ask)
{
    for (double step = 4e-3; step > 1.5e-5; step *= 0.5) report_library(ask, step, 0.0);
    for (int power = 4; power <= 9; ++power) report_library(ask, 0.0, pow(10.0, -power));
    for (int power = 3; power <= 9; ++power) {
        const peer_method how = {BY_IDA, pow(10.0, -power), 5, 0};
        report_peer(ask, &how);
    }
    for (int power = 2; power <= 7; ++power) {
        const peer_method how = {BY_IDA, pow(10.0, -power), 2, 0};
        report_peer(ask, &how);
    }
    for (int power = 3; power <= 7; power += 4) {
        const peer_method how = {BY_IDA, pow(10.0, -power), 5, 1};
        report_peer(ask, &how);
    }
    for (int order = 3; order <= 5; order += 2)
        for (int power = 3; power <= 8; ++power) {
            const peer_method how = {BY_ARKODE, pow(10.0, -power), order, 0};
            report_peer(ask, &how);
        }
}

static void run_scene(int kind)
{
    scene s;
    memset(&s, 0, sizeof s);
    s.kind = kind;
    s.pipes = ELEMENTS;
    s.per_pipe = 1;
    s.length = 1.0;
    question ask;
    if (scene_open(&s) >= 0 && question_of(&s, &ask)) {
        compare(&ask);
    } else {
        fprintf(stderr, "peer_sundials: scene %s: no reference\n", scene_names[kind]);
        ++failures;
    }
    dmb_model_destroy(&s.model);
}

static int is_wanted(const char *name, int count, char **words)
{
    for (int i = 2; i < count; ++i)
        if (strcmp(words[i], name) == 0) return 1;
    return count <= 2;
}

int main(int count, char **words)
{
    static const int kinds[] = {SCENE_C, SCENE_B};
    if (count < 2) return fputs("usage: peer_sundials CSV [C] [B]\n", stderr), 2;
    if (table_open(&rows, &unit, words[1]) != 0) return 2;
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; ++i)
        if (is_wanted(scene_names[kinds[i]], count, words)) run_scene(kinds[i]);
    return table_close(&rows, words[1]) != 0 ? 2 : failures > 0;
}
