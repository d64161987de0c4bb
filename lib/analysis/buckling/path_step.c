/* One point of a path: the tangent, the step along it, and Newton with the factor as one more unknown,
 *     [K  q; t^T D  0] [z; dfactor] = [-r; 0],   q = dr/dfactor,
 * by two solutions with K: z = z_r + dfactor z_q, dfactor = -(t.D z_r)/(t.D z_q) (Crisfield 1981, Riks 1979).
 * Cylindrical: the factor does not count in the arc, so that its unit does not matter. */
#include <string.h>

#include "analysis/buckling/path.h"
#include "analysis/static/stability.h"
#include "sim/access.h"
#include "sim/layout.h"
#include "system/assemble/elements.h"
#include "system/solve/solve.h"

double dmb_path_dot(const dmb_path *path, const double *a, const double *b)
{
    const dmb_scene *scene = path->work->scene;
    const double turning = scene->length_scale * scene->length_scale;
    double sum = 0.0;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        const uint32_t size = scene->layout.size[i], row = scene->layout.row[i];
        for (uint32_t c = 0; c < size; c++) sum += (2 * c < size ? 1.0 : turning) * a[row + c] * b[row + c];
    }
    return sum / scene->node_count;
}

static int32_t evaluate(dmb_path *path, int32_t tangent)
{
    path->search.evaluation.tangent = tangent;
    dmb_load_pattern_set(&path->pattern, &path->search.evaluation, path->next.factor);
    return dmb_system_evaluate(&path->search.evaluation);
}

int32_t dmb_path_evaluate(dmb_path *path, int32_t tangent)
{
    const int32_t status = dmb_progress_pulse(path->work);
    return status < 0 ? status : evaluate(path, tangent);
}

/* x <- -K^-1 x by the factors at hand; a motion drive moves its own row by 1 a unit of the factor. */
static void solve(dmb_path *path, double *x)
{
    dmb_solve_for(path->work, x, x);
}

/* Factors of the stiffness; `judged`: its stability too, for the next point. */
static int32_t factor(dmb_path *path, int judged, dmb_block_weakest *weakest, int64_t *bad)
{
    dmb_stability found = {0};
    if (!judged) {
        dmb_system_iteration_matrix(&path->search.evaluation);
        *bad = dmb_factor_stiffness(path->work, weakest);
        return DMB_OK;
    }
    const int32_t status = dmb_stability_judge(&path->search, 0, weakest, bad, &found);
    path->next.negative = found.negative;
    path->next.stiffness = found.stiffness;
    path->rounding = found.rounding;
    return status;
}

/* Motion by a unit of the factor, from the stiffness evaluated just now; path->move: the residual's correction. */
static int32_t solve_both(dmb_path *path, int judged)
{
    dmb_sim *work = path->work;
    dmb_block_weakest weakest;
    int64_t bad;
    int32_t status =
        dmb_load_pattern_derivative(&path->pattern, &path->search.evaluation, path->next.factor, path->loaded);
    if (status < 0) return status;
    memcpy(path->move, work->residual, work->scene->row_count * sizeof(double));
    status = factor(path, judged, &weakest, &bad);
    if (status < 0) return status;
    path->weakest = weakest.ratio;
    path->search.block = bad >= 0 ? (uint32_t)bad : weakest.block;
    if (bad >= 0) return DMB_ERR_SINGULAR;
    solve(path, path->move);
    solve(path, path->loaded);
    if (path->pattern.row != DMB_NONE) path->loaded[path->pattern.row] = 1.0;
    return DMB_OK;
}

static int32_t advance(dmb_path *path, double factor)
{
    path->next.factor += factor;
    dmb_system_extrapolate_stress(path->work, path->move);
    path->search.evaluation.extrapolated = 1;
    return dmb_static_move(&path->search, path->move, 1.0);
}

static int32_t predict(dmb_path *path, const double *direction, double rate, double arc)
{
    dmb_sim *work = path->work;
    dmb_configuration_copy(work, &work->now, &work->trial);
    memset(work->increment, 0, work->scene->row_count * sizeof(double));
    path->next.factor = path->last.factor;
    path->next.arc = path->last.arc + arc;
    path->search.evaluation.extrapolated = 0;
    const int32_t status = dmb_path_evaluate(path, 0); /* strains to extrapolate from */
    if (status < 0) return status;
    for (uint32_t i = 0; i < work->scene->row_count; i++) path->move[i] = arc * direction[i];
    return advance(path, arc * rate);
}

int32_t dmb_path_correct(dmb_path *path, const double *direction, double rate, double arc)
{
    int32_t status = predict(path, direction, rate, arc);
    path->iterations = 0;
    while (status >= 0) {
        status = dmb_path_evaluate(path, 1);
        if (status < 0) return status;
        const dmb_residual_norm norm = dmb_residual_norm_of(&path->search.evaluation, path->options->tolerance);
        path->search.residual = norm.relative;
        if (norm.converged) return DMB_OK;
        if (path->iterations >= path->options->max_iterations) return DMB_ERR_NO_CONVERGENCE;
        status = solve_both(path, 0);
        if (status < 0) return status;
        path->iterations++;
        path->report.iterations++;
        const double factor = -dmb_path_dot(path, direction, path->move) / dmb_path_dot(path, direction, path->loaded);
        if (!isfinite(factor)) return DMB_ERR_SINGULAR;
        for (uint32_t i = 0; i < path->work->scene->row_count; i++) path->move[i] += factor * path->loaded[i];
        status = advance(path, factor);
    }
    return status;
}

static double watched_of(const dmb_path *path)
{
    dmb_pose pose = dmb_pose_default();
    if (path->options->place.part.generation == 0) return 0.0;
    const dmb_configuration now = path->work->now; /* the query looks at `now` */
    path->work->now = path->work->trial;
    const int32_t status = dmb_query_pose(path->work, path->options->place, &pose);
    path->work->now = now;
    return status < 0 ? 0.0 : pose.displacement[path->options->component];
}

int32_t dmb_path_tangent(dmb_path *path, const double *towards)
{
    path->search.evaluation.extrapolated = 0;
    int32_t status = dmb_path_evaluate(path, 1);
    if (status >= 0) status = solve_both(path, 1);
    if (status < 0) return status;
    double length = sqrt(dmb_path_dot(path, path->loaded, path->loaded));
    if (!(length > 0.0) && path->weakest >= DMB_LOOSE_PIVOT)
        dmb_message_set(&path->sim->message, "path: the factor moves nothing");
    if (!(length > 0.0) || !isfinite(length)) return DMB_ERR_SINGULAR;
    if (dmb_path_dot(path, path->loaded, towards) < 0.0) length = -length;
    for (uint32_t i = 0; i < path->work->scene->row_count; i++) path->next.tangent[i] = path->loaded[i] / length;
    path->next.rate = 1.0 / length;
    path->next.watched = watched_of(path);
    return DMB_OK;
}

void dmb_path_accept(dmb_path *path)
{
    dmb_sim *work = path->work;
    const dmb_path_place place = path->last;
    path->search.evaluation.extrapolated = 0;
    (void)evaluate(path, 0); /* reactions; it has succeeded before */
    dmb_system_accept(&path->search.evaluation);
    memset(work->increment, 0, work->scene->row_count * sizeof(double));
    dmb_configuration_copy(work, &work->trial, &work->now);
    path->last = path->next;
    path->next = place;
}
