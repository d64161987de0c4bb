/* Equilibrium paths r(H, f) = 0 (dmb_analysis_path): options, start, path following, events. One turn of `follow`:
 *
 *     dmb_path_find_next   predictor and corrector (path_step.c); after a failure half the length, 40 times at most
 *     event in the step     the point is moved to it, the first that applies (dmb_path_event):
 *       limit               df/ds changes sign: the path goes on beyond it
 *       bifurcation         the number of negative eigenvalues changes, or the sign of det K where that number is not
 *                           resolved: straight on, or once onto the branch (options)
 *       factor_end,         end of the path
 *       displacement_end
 *     dmb_path_accept       the point becomes `last` and is reported
 *
 * Failure is: no convergence after 40 halvings, 50 steps that creep, or an error that is final. The points reported
 * before remain valid; the sim is never changed, because the path works on a copy. */
#include "analysis/buckling/buckling.h"

#include <string.h>

#include "analysis/linear/linear.h"
#include "base/memory.h"
#include "base/sized_struct.h"
#include "base/value_check.h"
#include "model/field_check.h"
#include "query/query.h"
#include "sim/access.h"
#include "sim/layout.h"
#include "sim/node.h"
#include "system/assemble/drives.h"
#include "system/system.h"

DMB_DECLARE_STRUCT(dmb_path_report)

static int32_t read_options(dmb_sim *sim, const dmb_path_options *given, dmb_path_options *out)
{
    dmb_check check = dmb_check_of(&sim->message, "path options", DMB_NONE);
    dmb_options_get(&check, DMB_OPTIONS_OF(dmb_path_options), given, out);
    if (check.status >= 0 && out->factor_end == 0.0) dmb_check_fail(&check, DMB_ERR_VALUE, "factor_end", 0.0, "not 0");
    return check.status;
}

static int32_t check_place(dmb_sim *sim, const dmb_path_options *options)
{
    dmb_pose pose = dmb_pose_default();
    if (options->place.part.generation == 0) return DMB_OK;
    const int32_t status = dmb_answer_pose(sim, options->place, &pose);
    if (status < 0) dmb_message_set(&sim->message, "path options: place is no place of this model");
    return status;
}

/* ---- Memory ------------------------------------------------------------------------------------------------------ */

static void lay_out(dmb_arena *arena, const dmb_scene *scene, dmb_path *to)
{
    to->last.tangent = DMB_ARENA_DOUBLES(arena, scene->row_count);
    to->next.tangent = DMB_ARENA_DOUBLES(arena, scene->row_count);
    to->loaded = DMB_ARENA_DOUBLES(arena, scene->row_count);
    to->move = DMB_ARENA_DOUBLES(arena, scene->row_count);
    to->iterate = DMB_ARENA_DOUBLES(arena, scene->row_count);
    to->mode = DMB_ARENA_DOUBLES(arena, scene->row_count);
    to->amounts = DMB_ARENA_DOUBLES(arena, scene->row_count);
    to->pattern.base = DMB_ARENA_DOUBLES(arena, dmb_load_pattern_size(scene));
}

/* ---- Start ------------------------------------------------------------------------------------------------------- */

static void explain(dmb_path *path, int32_t status)
{
    if (path->sim->message.text[0] != '\0') return;
    if (status == DMB_ERR_SINGULAR) {
        (void)dmb_stiffness_explain(path->sim, "path", path->search.block);
    } else if (status == DMB_ERR_ROTATION) {
        const dmb_owner owner = dmb_owner_of_element(path->work->scene, path->turned);
        dmb_message_set(&path->sim->message,
                        "path: ends at factor = %g, %s: relative rotation in one element above 2.5 rad; use "
                        "more elements",
                        path->last.factor, owner.text.text);
    } else {
        dmb_message_set(&path->sim->message, "path: lost at factor = %g after %u points, relative residual = %g",
                        path->last.factor, path->report.points, path->search.residual);
    }
}

/* First point: the present state, at rest and settled on its joints. It must be an equilibrium, and its stiffness
 * regular: the tangent is -K^-1 q. The direction is that of a factor which moves towards factor_end. */
static int32_t begin(dmb_path *path)
{
    dmb_sim *work = path->work;
    const dmb_scene *scene = work->scene;
    int32_t status = dmb_steady_refuse_moving(path->sim, work, "path");
    if (status < 0) return status;
    memset(work->increment, 0, scene->row_count * sizeof(double));
    memset(work->now.velocity, 0, scene->row_count * sizeof(double));
    memset(work->now.acceleration, 0, scene->row_count * sizeof(double));
    memset(work->now.pseudo_acceleration, 0, scene->row_count * sizeof(double));
    dmb_configuration_copy(work, &work->now, &work->trial);
    work->reduced_mode->row = DMB_NONE;
    status = dmb_system_prescribe(&path->search.evaluation);
    if (status >= 0 && scene->cluster_count) status = dmb_static_settle(&path->search);
    if (status < 0) return status;
    memset(work->trial.velocity, 0, scene->row_count * sizeof(double));
    dmb_load_pattern_begin(&path->pattern, work);
    status = dmb_path_evaluate(path, 1);
    if (status >= 0) status = dmb_stiffness_balanced(path->sim, "path", &path->search.evaluation);
    if (status >= 0) status = dmb_path_tangent(path, path->next.tangent); /* 0: along an increasing factor */
    if (status >= 0 && path->weakest < DMB_UNCONSTRAINED_PIVOT) status = DMB_ERR_SINGULAR;
    if (status < 0) return status;
    const double sense = path->options->factor_end < 0.0 ? -1.0 : 1.0;
    path->next.rate *= sense;
    for (uint32_t i = 0; i < scene->row_count; i++) path->next.tangent[i] *= sense;
    path->side = path->next.rate;
    status = dmb_path_accept(path);
    if (status < 0) return status;
    path->begun = 1;
    path->turned = DMB_NONE;
    return DMB_OK;
}

/* ---- Path following ---------------------------------------------------------------------------------------------- */

/* Reports a point. 0, or DMB_NOTE_STOPPED if the caller requests it. */
static int32_t tell(dmb_path *path, int32_t kind)
{
    dmb_path_point point = dmb_path_point_default();
    point.number = path->report.points;
    point.kind = kind;
    point.negative = path->last.negative;
    point.stiffness = path->last.stiffness;
    point.iterations = path->iterations;
    point.factor = path->last.factor;
    point.rate = path->last.rate;
    point.arc = path->last.arc;
    point.displacement = path->last.watched;
    path->report.factor = path->last.factor;
    path->report.displacement = path->last.watched;
    if (kind == DMB_PATH_LIMIT && path->report.limits++ == 0) path->report.first_limit = point.factor;
    if (kind == DMB_PATH_BIFURCATION && path->report.bifurcations++ == 0) path->report.first_bifurcation = point.factor;
    if (path->options->callback == NULL) return DMB_OK;
    return path->options->callback(path->options->callback_context, path->work, &point) ? DMB_NOTE_STOPPED : DMB_OK;
}

#define DMB_CUTS_IN_A_ROW 40
/* Newton iterations at which the step length stays the same. */
#define DMB_GOOD_ITERATIONS 5.0

/* Locates the event, or an end before it. */
static int32_t locate(dmb_path *path, int32_t *event, double arc)
{
    const int32_t status = dmb_path_locate(path, event, arc);
    const int32_t end = dmb_path_end(path, *event);
    if (status < 0 || end == DMB_EVENT_NONE) return status;
    *event = end;
    return dmb_path_locate(path, event, path->next.arc - path->last.arc);
}

/* Locates the event, and before an end a bifurcation that the longer step has passed: an eigenvalue has changed sign
 * twice. */
static int32_t locate_first(dmb_path *path, int32_t *event, double arc)
{
    const int32_t status = locate(path, event, arc);
    const int ends = *event == DMB_EVENT_FACTOR || *event == DMB_EVENT_DISPLACEMENT;
    if (status < 0 || !ends || !dmb_path_count_changes(path)) return status;
    *event = DMB_EVENT_BIFURCATION;
    return dmb_path_locate(path, event, path->next.arc - path->last.arc);
}

/* Relative distance of the factor within which excessive rotation is the reason of failure. */
#define DMB_TURNED_NEAR 1e-3

static int32_t lost(const dmb_path *path)
{
    const int near = fabs(path->last.factor - path->turned_at) <= DMB_TURNED_NEAR * fabs(path->last.factor);
    return path->turned != DMB_NONE && near ? DMB_ERR_ROTATION : DMB_ERR_NO_CONVERGENCE;
}

/* An event that cannot be located counts as a failed step, too: the shorter step may contain only the nearer of two
 * events. The element that rotates too far is remembered: halving goes on to the factor at which its limit is reached,
 * and the message then names it. */
int32_t dmb_path_find_next(dmb_path *path, double *arc, int32_t *event)
{
    for (int cuts = 0;; cuts++, path->report.cuts++) {
        *arc = fmin(*arc, path->options->step_max);
        int32_t status = dmb_path_correct(path, path->last.tangent, path->last.rate, *arc);
        if (status >= 0) status = dmb_path_tangent(path, path->last.tangent);
        if (status >= 0) {
            *event = dmb_path_event(path);
            if (*event == DMB_EVENT_NONE) return DMB_OK;
            status = locate_first(path, event, *arc);
        }
        if (status >= 0 || dmb_is_final(status)) return status;
        if (status == DMB_ERR_ROTATION) {
            path->turned = path->search.evaluation.element;
            path->turned_at = path->last.factor;
        }
        if (cuts >= DMB_CUTS_IN_A_ROW) return lost(path);
        *arc *= 0.5;
    }
}

/* At a crossing of paths the stiffness is singular and the computed tangent is mostly the shape of the other path, by
 * rounding. Both paths continue in their previous directions: that of the point before. */
static void go_straight_on(dmb_path *path)
{
    memcpy(path->next.tangent, path->last.tangent, path->work->scene->row_count * sizeof(double));
    path->next.rate = path->last.rate;
}

/* First point of the branch, at branch_size or at the present step length; the path continues from there. */
static int32_t leave(dmb_path *path, double *arc)
{
    if (path->options->branch_size > 0.0) *arc = path->options->branch_size;
    int32_t status = dmb_path_leave(path, arc);
    if (status >= 0) status = dmb_path_accept(path);
    if (status < 0) return status;
    path->report.points++;
    return tell(path, DMB_PATH_BRANCH);
}

/* A path is lost after DMB_CREEPS consecutive steps below the fraction DMB_CREEP of its longest step. */
#define DMB_CREEP 1e-5
#define DMB_CREEPS 50

static int creeps(double arc, double *longest, uint32_t *points)
{
    *longest = fmax(*longest, arc);
    *points = arc < DMB_CREEP * *longest ? *points + 1 : 0;
    return *points > DMB_CREEPS;
}

/* Eigenvalues of a non-symmetric stiffness pass 0 in both directions, and a step in which one leaves and one returns
 * would show no change: steps are limited to this fraction of the distance to factor_end. */
#define DMB_UNSYMMETRIC_STEP 0.05

static double shorten(const dmb_path *path, double arc)
{
    if (path->last.stiffness != DMB_STIFFNESS_UNSYMMETRIC) return arc;
    return fmin(arc, DMB_UNSYMMETRIC_STEP * fabs(path->options->factor_end / path->last.rate));
}

/* The factor's rate makes an arc of the first step, a tenth of factor_end by default. The length then changes with the
 * root of 5 iterations over those needed, by at most a factor of 2, and stays as it is after an event. */
static int32_t follow(dmb_path *path)
{
    const dmb_path_options *o = path->options;
    double arc = (o->first_step > 0.0 ? o->first_step : 0.1 * fabs(o->factor_end)) / fabs(path->last.rate);
    double longest = 0.0;
    uint32_t crept = 0;
    int may_leave = o->branch != 0;
    int32_t status = tell(path, DMB_PATH_REGULAR);
    while (status == DMB_OK) {
        int32_t event = DMB_EVENT_NONE;
        if (path->report.points >= o->max_points) return DMB_NOTE_STOPPED;
        dmb_progress_at(path->sim,
                        fmax((double)path->report.points / o->max_points, path->last.factor / o->factor_end));
        arc = shorten(path, arc);
        status = dmb_path_find_next(path, &arc, &event);
        if (status < 0) return status;
        if (creeps(arc, &longest, &crept)) return lost(path);
        if (event == DMB_EVENT_BIFURCATION) go_straight_on(path);
        status = dmb_path_accept(path);
        if (status < 0) return status;
        path->report.points++;
        status = tell(path, event == DMB_EVENT_LIMIT         ? DMB_PATH_LIMIT
                            : event == DMB_EVENT_BIFURCATION ? DMB_PATH_BIFURCATION
                                                             : DMB_PATH_REGULAR);
        if (event == DMB_EVENT_FACTOR || event == DMB_EVENT_DISPLACEMENT) return status;
        if (status == DMB_OK && event == DMB_EVENT_BIFURCATION && may_leave) {
            may_leave = 0;
            status = leave(path, &arc);
        } else if (event == DMB_EVENT_NONE) {
            arc *= fmin(fmax(sqrt(DMB_GOOD_ITERATIONS / (path->iterations + 1.0)), 0.5), 2.0);
        }
    }
    return status;
}

/* The workspace is measured with an empty arena first, then placed. dmb_path_close releases whatever exists after an
 * error. */
int32_t dmb_path_open(dmb_path *path)
{
    dmb_sim *sim = path->sim;
    dmb_arena arena;
    const dmb_scene *scene = dmb_dense_scene(sim->scene);
    dmb_arena_count(&arena);
    lay_out(&arena, scene, path);
    path->block_size = dmb_arena_block_size(&arena);
    path->block = dmb_allocate(&sim->allocator, path->block_size);
    path->work = path->block != NULL ? dmb_state_copy(sim) : NULL;
    if (path->work == NULL) return DMB_ERR_NO_MEMORY;
    path->work->magic = DMB_HANDLE_SIM; /* only so that a callback can query it */
    path->work->busy = DMB_BUSY_READABLE;
    dmb_arena_place(&arena, path->block, path->block_size);
    lay_out(&arena, scene, path);
    path->statics.tolerance = path->options->tolerance;
    dmb_static_set_up(&path->search, path->work, &path->statics);
    dmb_static_slip(&path->search, path->options->slip_axial, path->options->slip_rotation);
    return begin(path);
}

void dmb_path_close(dmb_path *path)
{
    if (path->work != NULL) path->work->magic = DMB_HANDLE_DEAD;
    dmb_state_discard(path->work);
    if (path->block != NULL) dmb_release(&path->sim->allocator, path->block, path->block_size);
    path->work = NULL;
    path->block = NULL;
}

/* The sign of det K is always known, and with it each odd number of eigenvalues that change sign. */
static int32_t note_unresolved(dmb_path *path)
{
    dmb_message_set(
        &path->sim->message,
        "path: the negative eigenvalues of the unsymmetric stiffness could not be counted at some points; "
        "bifurcations at which two change sign together may be missing; use smaller steps or fewer elements");
    return DMB_NOTE_INCOMPLETE;
}

static int32_t trace(dmb_path *path)
{
    int32_t status = dmb_path_open(path);
    if (status >= 0) status = follow(path);
    if (status == DMB_OK && path->unresolved) status = note_unresolved(path);
    if (status < 0 && status != DMB_ERR_NO_MEMORY) explain(path, status);
    dmb_path_close(path);
    return status;
}

static int32_t analyse(dmb_sim *sim, const dmb_path_options *options, dmb_path_report *report)
{
    dmb_path_options taken;
    dmb_path path;
    memset(&path, 0, sizeof path);
    path.sim = sim;
    path.options = &taken;
    (void)dmb_path_report_init(&path.report, (uint32_t)sizeof path.report);
    if (report != NULL && dmb_path_report_read(&path.report, report) < 0) return DMB_ERR_STRUCT_SIZE;
    (void)dmb_path_report_init(&path.report, (uint32_t)sizeof path.report);
    path.report.first_limit = path.report.first_bifurcation = (double)NAN;
    int32_t status = read_options(sim, options, &taken);
    if (status >= 0) status = check_place(sim, &taken);
    if (status >= 0) status = dmb_state_copy_check(sim, "path");
    if (status >= 0) status = dmb_load_pattern_allocate(sim, "path options", taken.scale, taken.part, &path.pattern);
    if (status >= 0) status = trace(&path);
    status = dmb_progress_end(sim, status);
    if (path.begun && report != NULL) (void)dmb_path_report_write(report, &path.report);
    return status;
}

int32_t dmb_analysis_path(dmb_sim *sim, const dmb_path_options *options, dmb_path_report *report)
{
    const int32_t status = dmb_sim_enter(sim, DMB_BUSY_READABLE);
    return status < 0 ? status : dmb_sim_leave(sim, analyse(sim, options, report));
}
