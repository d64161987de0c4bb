#include "integrator/attempt.h"

#include <float.h>
#include <string.h>

#include "integrator/generalized_alpha.h"
#include "integrator/turning.h"
#include "system/cluster.h"
#include "system/constraint_rows.h"
#include "system/ledger.h"
#include "system/owner.h"
#include "system/release.h"
#include "system/solve.h"

/* Newton gives up when the residual has grown this much over its start. */
#define DMB_NEWTON_GROWTH 1e6
/* Largest ratio of a step to the one before over which the pseudo-acceleration is carried. */
#define DMB_STEP_RATIO_MAX 1e3
/* Kept factors converge linearly and end just below their tolerance, where fresh ones end far below: they aim lower. */
#define DMB_KEPT_TOLERANCE 0.2
/* Steps count as equally long that differ by this part: by the rounding of times, and what no rate of convergence
 * feels. */
#define DMB_KEPT_STEP 1e-6
/* Steps that begin with a residual above this part of their forces are those in which bodies meet: a correction by
 * kept factors would lead astray. */
#define DMB_KEPT_START 0.1
/* Longest pause in steps between tries of kept factors. */
#define DMB_PAUSE_MAX 31
/* New factors cost about as much as this many corrections with old ones. */
#define DMB_EXCESS_MAX 2
/* Misfit of an equation taken for redundant at which it is one no more, in lengths of the parts. */
#define DMB_DROPPED_MISFIT 1e-7

/* a0 carried over to a new step length, v0' + (h/h_old)(a0 - v0'), which keeps second order (THEORY 4). */
static double carried(const dmb_sim *sim, double ratio, uint32_t i)
{
    const double a = sim->now.acceleration[i];
    return a + ratio * (sim->now.pseudo_acceleration[i] - a);
}

/* After a sliver of a step a0 - v0' is lost in what Newton left over, and the ratio would blow that up: a0 starts anew
 * from the acceleration. */
static double step_ratio(const dmb_sim *sim, double step)
{
    if (!(sim->clock->step > 0.0)) return 1.0;
    return step > DMB_STEP_RATIO_MAX * sim->clock->step ? 0.0 : step / sim->clock->step;
}

/* What the step iterates on: the trial itself, or what is projected onto the constraints to become it. */
typedef struct motion {
    double *velocity, *acceleration, *pseudo_acceleration;
} motion;

static motion motion_of(const dmb_sim *sim)
{
    const motion trial = {sim->trial.velocity, sim->trial.acceleration, sim->trial.pseudo_acceleration};
    const motion raw = {sim->raw_velocity, sim->raw_acceleration, sim->raw_pseudo_acceleration};
    return sim->scene->cluster_count ? raw : trial;
}

/* Start of the iteration: v1' = v0'. */
static void predict(dmb_sim *sim, const dmb_generalized_alpha *c, double h)
{
    const double ratio = step_ratio(sim, h), am = c->am, beta = c->beta, whole = 1.0 - am;
    const double to_v0 = h * (1.0 - c->gamma), to_v1 = h * c->gamma;
    const motion to = motion_of(sim);
    const uint32_t rows = sim->scene->row_count;
    const double *restrict now_v = sim->now.velocity, *restrict now_dv = sim->now.acceleration,
                           *restrict now_a =
                               sim->now.pseudo_acceleration; /* nothing overlaps, so that this vectorises */
    double *restrict v = to.velocity, *restrict dv = to.acceleration, *restrict a = to.pseudo_acceleration,
                     *restrict increment = sim->increment;
    for (uint32_t i = 0; i < rows; i++) {
        const double a0 = now_dv[i] + ratio * (now_a[i] - now_dv[i]), a1 = (now_dv[i] - am * a0) / whole;
        dv[i] = now_dv[i];
        a[i] = a1;
        v[i] = now_v[i] + to_v0 * a0 + to_v1 * a1;
        increment[i] = h * now_v[i] + h * h * ((0.5 - beta) * a0 + beta * a1);
    }
}

/* Motion drives of nodes have written into the trial. */
static void keep_prescribed(dmb_sim *sim)
{
    const motion to = motion_of(sim);
    for (uint32_t i = 0; i < sim->scene->drive_count; i++) {
        const uint32_t row = sim->scene->drives[i].row;
        if (sim->scene->drives[i].kind != DMB_DRIVE_MOTION || row == UINT32_MAX) continue;
        to.velocity[row] = sim->trial.velocity[row];
        to.acceleration[row] = sim->trial.acceleration[row];
        to.pseudo_acceleration[row] = sim->trial.pseudo_acceleration[row];
    }
}

/* Moves the trial by the correction z of h Dq. */
static void correct(dmb_sim *sim, const dmb_generalized_alpha *c, double h)
{
    const double to_a = 1.0 / (h * h * c->beta), to_v = c->gamma / (h * c->beta);
    const double to_dv = to_a * (1.0 - c->am) / (1.0 - c->af);
    const motion to = motion_of(sim);
    const uint32_t rows = sim->scene->row_count;
    const double *restrict z = sim->correction;
    double *restrict v = to.velocity, *restrict dv = to.acceleration, *restrict a = to.pseudo_acceleration,
                     *restrict increment = sim->increment;
    for (uint32_t i = 0; i < rows; i++) {
        increment[i] += z[i];
        v[i] += to_v * z[i];
        dv[i] += to_dv * z[i];
        a[i] += to_a * z[i];
    }
    dmb_system_move(sim);
}

double dmb_attempt_error(const dmb_sim *sim, double h)
{
    const dmb_generalized_alpha c = dmb_generalized_alpha_of(sim->options.spectral_radius);
    const dmb_scene *scene = sim->scene;
    const double ratio = step_ratio(sim, h), factor = c.error * h * h;
    double worst = 0.0;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        const uint32_t size = scene->layout.size[i], row = scene->layout.row[i];
        for (uint32_t k = 0; k < size; k++) {
            if (!scene->solved_row[row + k]) continue;
            const double tolerance =
                2 * k < size ? sim->options.tolerance_translation : sim->options.tolerance_rotation;
            const double jump = sim->trial.pseudo_acceleration[row + k] - carried(sim, ratio, row + k);
            worst = fmax(worst, fabs(factor * jump) / tolerance);
        }
    }
    return worst;
}

static void set_up(dmb_sim *sim, const dmb_generalized_alpha *c, double h, dmb_evaluation *evaluation)
{
    memset(evaluation, 0, sizeof *evaluation);
    evaluation->sim = sim;
    evaluation->time = sim->clock->time + h;
    evaluation->step = h;
    evaluation->mass_factor = (1.0 - c->am) / (h * h * c->beta * (1.0 - c->af));
    evaluation->velocity_factor = c->gamma / (h * c->beta);
    evaluation->pseudo_factor = (1.0 - c->af) / (1.0 - c->am);
    evaluation->load_factor = 1.0;
    evaluation->dynamic = 1;
    evaluation->tangent = 1;
}

/* Course of one Newton iteration. */
typedef struct newton_course {
    double first, last; /* relative residual at the start, and before the last correction */
    double balance;     /* [N] norm of the terms that balanced at the start */
    uint32_t corrections;
    uint32_t reserved;
} newton_course;

/* Factors that are there do when two more corrections at the present rate reach the tolerance; kept ones also for a
 * first correction, which shows their rate. */
static int32_t factors_will_do(const dmb_sim *sim, const dmb_attempt *attempt, const newton_course *course,
                               double tolerance)
{
    const double rate = attempt->residual / course->last;
    if (attempt->factored == DMB_FACTORS_NONE) return 0;
    if (attempt->factored == DMB_FACTORS_KEPT && dmb_contact_changes(sim)) return 0;
    if (attempt->factored == DMB_FACTORS_KEPT && course->corrections == 0) return attempt->residual <= DMB_KEPT_START;
    return rate * rate * attempt->residual <= tolerance;
}

/* The rounding of stiff elements hides what kept factors leave in soft directions: they go on while it pays. */
static int32_t still_falls(const dmb_sim *sim, const dmb_attempt *attempt, const newton_course *course)
{
    if (attempt->factored != DMB_FACTORS_KEPT || dmb_contact_changes(sim)) return 0;
    return course->corrections == 0 || (course->corrections < 3 && attempt->residual < 0.25 * course->last);
}

/* True if what is left is the rounding of the forces at the start: in free flight after a contact nothing else is there
 * to compare it with. */
static int32_t is_rounding(const dmb_attempt *attempt, double balance, newton_course *course)
{
    if (course->balance > 0.0) return attempt->residual * balance <= 4.0 * DBL_EPSILON * course->balance;
    course->balance = balance;
    return 0;
}

/* Near a singular place of the joints: poses settled to 2e-15 leave the null space unsharp by as much over the quality
 * of the partition squared (measured: up to 4e-14/quality^2 of the forces). A residual that no longer falls is as good
 * as it gets there. */
static int32_t is_unsharp(const dmb_sim *sim, const dmb_attempt *attempt, const newton_course *course)
{
    double quality = 1.0;
    for (uint32_t k = 0; k < sim->scene->cluster_count; k++) quality = fmin(quality, sim->cluster_quality[k]);
    if (!(quality < 0.1) || !(course->last > 0.0) || attempt->residual <= 0.5 * course->last) return 0;
    return attempt->residual <= fmin(1e-4, 4e-14 / (quality * quality));
}

static int32_t check_course(const dmb_sim *sim, const dmb_attempt *attempt, newton_course *course)
{
    if (course->first == 0.0) course->first = course->last = attempt->residual;
    if (!(attempt->residual <= DMB_NEWTON_GROWTH * course->first)) return DMB_ERR_NO_CONVERGENCE; /* NaN, too */
    if (attempt->residual > DBL_MAX) return DMB_ERR_NO_CONVERGENCE;
    if (attempt->iterations < sim->options.max_iterations) return 1;
    return sim->options.bounded_work ? DMB_NOTE_WORK_LIMITED : DMB_ERR_NO_CONVERGENCE;
}

/* Fresh factors at the present trial. */
static int32_t refactor(dmb_sim *sim, dmb_attempt *attempt)
{
    if (!attempt->evaluation.tangent) {
        attempt->evaluation.tangent = 1;
        const int32_t status = dmb_system_evaluate(&attempt->evaluation);
        if (status < 0) return status;
    }
    dmb_system_iteration_matrix(&attempt->evaluation);
    const int64_t bad = dmb_factor_matrix(sim);
    attempt->factored = DMB_FACTORS_FRESH;
    if (bad < 0) return DMB_OK;
    attempt->block = (uint32_t)bad;
    return DMB_ERR_SINGULAR;
}

/* What is asked for is reached: kept factors only aimed lower. */
static int32_t is_met(const dmb_attempt *attempt, double own)
{
    return attempt->factored == DMB_FACTORS_KEPT && dmb_residual_norm_of(&attempt->evaluation, own).converged != 0;
}

/* One Newton iteration; 1: go on, 0 or DMB_NOTE_WORK_LIMITED: done, < 0: failed. */
static int32_t iterate(dmb_sim *sim, const dmb_generalized_alpha *c, dmb_attempt *attempt, newton_course *course)
{
    dmb_evaluation *evaluation = &attempt->evaluation;
    const double own = sim->options.newton_tolerance;
    const double tolerance = attempt->factored == DMB_FACTORS_KEPT ? DMB_KEPT_TOLERANCE * own : own;
    evaluation->tangent = attempt->factored == DMB_FACTORS_NONE;
    int32_t status = sim->scene->cluster_count ? dmb_clusters_settle(evaluation, DMB_SETTLE_ALL, 1) : DMB_OK;
    if (status >= 0) status = dmb_system_evaluate(evaluation);
    if (status < 0) return status;
    const dmb_residual_norm norm = dmb_residual_norm_of(evaluation, tolerance);
    attempt->residual = norm.relative;
    const int32_t hidden = norm.converged == DMB_AT_ROUNDING && still_falls(sim, attempt, course);
    if (norm.converged && !hidden) return 0;
    if (is_rounding(attempt, norm.balance, course) || is_unsharp(sim, attempt, course)) return 0;
    status = check_course(sim, attempt, course);
    if (status != 1) return is_met(attempt, own) ? 0 : status;
    if (!hidden && !factors_will_do(sim, attempt, course, tolerance)) {
        if (course->corrections > 0 && is_met(attempt, own)) return 0;
        status = refactor(sim, attempt);
        if (status < 0) return status;
    }
    course->last = attempt->residual;
    dmb_solve_correction(sim);
    attempt->iterations++;
    course->corrections++;
    if (attempt->factored == DMB_FACTORS_FRESH) { /* kept ones give way to a tangent at the true stress */
        dmb_system_extrapolate_stress(sim, sim->correction);
        evaluation->extrapolated = 1;
    }
    correct(sim, c, attempt->step);
    return 1;
}

static void begin_factors(dmb_sim *sim, dmb_attempt *attempt)
{
    const int usable = attempt->whole && !attempt->astray &&
                       fabs(sim->kept->step - attempt->step) <= DMB_KEPT_STEP * attempt->step && sim->kept->pause == 0;
    attempt->factored = usable ? DMB_FACTORS_KEPT : DMB_FACTORS_NONE;
    attempt->tried |= usable;
    *sim->factors = attempt->factored;
}

static int32_t newton(dmb_sim *sim, const dmb_generalized_alpha *c, dmb_attempt *attempt)
{
    newton_course course;
    int32_t status;
    memset(&course, 0, sizeof course);
    begin_factors(sim, attempt);
    do status = iterate(sim, c, attempt, &course);
    while (status == 1);
    return status;
}

/* The step once more, from the increments found so far, with what opening contacts did taken off the history: v0' and
 * a0 less M^-1 of their forces, and no a0 - v0' at their nodes from there on, which would ring in free flight. */
static int32_t step_released(dmb_sim *sim, const dmb_generalized_alpha *c, dmb_attempt *attempt)
{
    const double h = attempt->step, ratio = step_ratio(sim, h);
    const motion to = motion_of(sim);
    int32_t status = dmb_released_acceleration(&attempt->evaluation);
    if (status < 0) return status;
    for (uint32_t i = 0; i < sim->scene->row_count; i++) {
        if (!sim->scene->solved_row[i]) continue;
        const double v = sim->now.velocity[i], gone = sim->correction[i];
        const double dv = sim->now.acceleration[i] - gone;
        const double a0 = dv + (1.0 - sim->scale_row[i]) * (carried(sim, ratio, i) - sim->now.acceleration[i]);
        const double a1 = ((sim->increment[i] - h * v) / (h * h) - (0.5 - c->beta) * a0) / c->beta;
        to.pseudo_acceleration[i] = a1;
        to.acceleration[i] = ((1.0 - c->am) * a1 + c->am * a0 - c->af * dv) / (1.0 - c->af);
        to.velocity[i] = v + h * ((1.0 - c->gamma) * a0 + c->gamma * a1);
    }
    set_up(sim, c, h, &attempt->evaluation);
    status = newton(sim, c, attempt);
    dmb_release_end(sim);
    return status;
}

/* A row that was found redundant has to hold with the others; where it does not, the constraints have become singular.
 */
static int32_t check_dropped(dmb_sim *sim)
{
    uint32_t row;
    const double misfit = dmb_clusters_misfit(sim, 1, &row);
    if (!(misfit > DMB_DROPPED_MISFIT * sim->linked_mode->length)) return DMB_OK;
    sim->linked_mode->row = row;
    sim->linked_mode->misfit = fabs(sim->constraint_value[row]);
    return DMB_ERR_SINGULAR;
}

/* From the prediction to the end of the iteration, and over again where contacts open. */
static int32_t run(dmb_sim *sim, const dmb_generalized_alpha *c, dmb_attempt *attempt)
{
    set_up(sim, c, attempt->step, &attempt->evaluation);
    predict(sim, c, attempt->step);
    int32_t status = dmb_system_prescribe(&attempt->evaluation);
    if (status < 0) return status;
    if (sim->scene->cluster_count) keep_prescribed(sim);
    dmb_system_move(sim);
    status = newton(sim, c, attempt);
    return status == DMB_OK && dmb_contact_opens(sim) ? step_released(sim, c, attempt) : status;
}

int32_t dmb_attempt_step(dmb_sim *sim, double step, int32_t whole, dmb_attempt *attempt)
{
    const dmb_generalized_alpha c = dmb_generalized_alpha_of(sim->options.spectral_radius);
    int32_t status;
    memset(attempt, 0, sizeof *attempt);
    attempt->step = step;
    attempt->whole = whole && sim->scene->cluster_count == 0 && !sim->options.bounded_work;
    attempt->block = UINT32_MAX;
    sim->linked_mode->row = UINT32_MAX;
    sim->linked_mode->multipliers = sim->options.constraint_method == DMB_METHOD_MULTIPLIERS;
    status = run(sim, &c, attempt);
    if (attempt->tried && status < 0 && status != DMB_ERR_CALLBACK) { /* once more, with factors of its own */
        attempt->astray = 1;
        attempt->iterations = 0;
        status = run(sim, &c, attempt);
    }
    if (status >= 0 && sim->scene->cluster_count && check_dropped(sim) < 0) status = DMB_ERR_SINGULAR;
    *sim->factors = DMB_FACTORS_NONE;
    sim->linked_mode->multipliers = 0;
    if (status >= 0) {
        attempt->evaluation.element = dmb_element_turned_too_far(sim);
        if (attempt->evaluation.element != UINT32_MAX) status = DMB_ERR_ROTATION;
    }
    attempt->status = status == DMB_NOTE_WORK_LIMITED ? status : status < 0 ? status : DMB_OK;
    return attempt->status;
}

/* Fresh factors are kept for the steps to come, until the corrections that these have taken beyond the first such step
 * have cost as much as new ones. Where kept factors did not do within a step, the next try waits, longer each time. */
static void keep_factors(dmb_sim *sim, const dmb_attempt *attempt)
{
    dmb_kept *kept = sim->kept;
    if (!attempt->whole) return;
    if (attempt->factored == DMB_FACTORS_KEPT) {
        if (kept->corrections == 0 || attempt->iterations < kept->corrections) kept->corrections = attempt->iterations;
        kept->excess += attempt->iterations - kept->corrections;
        kept->penalty = 0;
        if (kept->excess >= DMB_EXCESS_MAX) kept->step = 0.0;
    } else if (attempt->factored == DMB_FACTORS_FRESH) {
        if (attempt->tried) {
            kept->penalty = 2 * kept->penalty + 1 < DMB_PAUSE_MAX ? 2 * kept->penalty + 1 : DMB_PAUSE_MAX;
            kept->pause = kept->penalty - 1;
        } else if (kept->pause > 0) {
            kept->pause--;
        }
        dmb_keep_factors(sim);
        kept->step = attempt->step;
        kept->corrections = kept->excess = 0;
    }
}

void dmb_attempt_commit(dmb_sim *sim, dmb_attempt *attempt)
{
    dmb_counters *counters = sim->counters;
    dmb_system_accept(&attempt->evaluation);
    keep_factors(sim, attempt);
    if (sim->options.energy_ledger) dmb_ledger_add(sim, &attempt->evaluation);
    const dmb_configuration old = sim->now;
    sim->now = sim->trial;
    sim->trial = old;
    sim->clock->time = attempt->evaluation.time;
    sim->clock->step = attempt->step;
    counters->steps++;
    counters->iterations += attempt->iterations;
    if (attempt->status == DMB_NOTE_WORK_LIMITED) counters->limited++;
    if (attempt->iterations > counters->worst_iterations) counters->worst_iterations = attempt->iterations;
    counters->worst_residual = fmax(counters->worst_residual, attempt->residual);
}

void dmb_attempt_explain(dmb_sim *sim, const dmb_attempt *attempt)
{
    dmb_owner owner;
    switch (attempt->status) {
    case DMB_ERR_ROTATION:
        owner = dmb_owner_of_element(sim->scene, attempt->evaluation.element);
        dmb_message_set(&sim->message,
                        "%s %u, pipe %u: relative rotation in one element above 2.5 rad at time %g, step %g",
                        owner.kind, owner.index, owner.pipe, attempt->evaluation.time, attempt->step);
        break;
    case DMB_ERR_SINGULAR:
        if (attempt->block == UINT32_MAX) {
            dmb_clusters_explain(sim, "its equations are singular");
            break;
        }
        owner = dmb_owner_of_node(sim->scene, attempt->block);
        dmb_message_set(&sim->message, "%s %u, pipe %u: iteration matrix singular at time %g, step %g", owner.kind,
                        owner.index, owner.pipe, attempt->evaluation.time, attempt->step);
        break;
    case DMB_ERR_CALLBACK:
        if (sim->linked_mode->row != UINT32_MAX) {
            dmb_message name;
            dmb_constraint_text(sim->scene, dmb_constraint_of_row(sim->scene, sim->linked_mode->row), &name);
            dmb_message_set(&sim->message, "%s: its callback failed or gave a value that is not finite at time %g",
                            name.text, attempt->evaluation.time);
            break;
        }
        dmb_message_set(
            &sim->message,
            "callback of a programme or constraint: it failed or gave a value that is not finite at time %g",
            attempt->evaluation.time);
        break;
    default:
        if (sim->linked_mode->row != UINT32_MAX) {
            dmb_clusters_explain(sim, "its equations cannot be satisfied");
            break;
        }
        dmb_message_set(&sim->message,
                        "step to time %g of length %g: %u iterations, relative residual = %g, must be <= %g",
                        attempt->evaluation.time, attempt->step, attempt->iterations, attempt->residual,
                        sim->options.newton_tolerance);
    }
}

static double corner_of(const dmb_scene *scene, uint32_t programme, double t)
{
    return programme == UINT32_MAX ? (double)INFINITY : dmb_programme_next_corner(scene->programmes + programme, t);
}

double dmb_next_corner(const dmb_sim *sim, double t)
{
    const dmb_scene *scene = sim->scene;
    double next = (double)INFINITY;
    for (uint32_t i = 0; i < scene->drive_count; i++) {
        if (!isnan(sim->drive_input[i])) continue;
        next = fmin(next, corner_of(scene, scene->drives[i].programme, t));
        next = fmin(next, corner_of(scene, scene->drives[i].excitation, t));
    }
    for (uint32_t i = 0; i < scene->load_count; i++) next = fmin(next, corner_of(scene, scene->loads[i].programme, t));
    for (uint32_t i = 0; i < scene->bit_count; i++) next = fmin(next, corner_of(scene, scene->bits[i].load, t));
    return next;
}
