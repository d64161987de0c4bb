/* One point of a path: the tangent, the step along it, and Newton with the factor as additional unknown
 * (eq:buckling.arc),
 *     [K  q; t^T D  0] [z; dfactor] = [-r; 0],   q = dr/dfactor,
 * by two solutions with K: z = z_r + dfactor z_q, dfactor = -(t.D z_r)/(t.D z_q). Cylindrical: the arc excludes the
 * factor, so that its unit does not matter. */
#include <string.h>

#include "analysis/buckling/buckling.h"
#include "analysis/linear/linear.h"
#include "analysis/static/static.h"
#include "query/query.h"
#include "sim/access.h"
#include "sim/layout.h"
#include "system/assemble/assemble.h"
#include "system/solve/solve.h"

/* a . D b with the weights D of eq:buckling.arc, 1 and L0^2. The mean over the nodes makes the arc a root mean square
 * displacement, independent of the mesh. */
double dmb_path_dot(const dmb_path *path, const double *a, const double *b)
{
    const dmb_scene *scene = path->work->scene;
    const double of_rotations = scene->length_scale * scene->length_scale;
    double sum = 0.0;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        const uint32_t size = scene->layout.size[i], row = scene->layout.row[i];
        for (uint32_t c = 0; c < size; c++) sum += (2 * c < size ? 1.0 : of_rotations) * a[row + c] * b[row + c];
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

/* x <- -K^-1 x by the present factors. */
static void solve(dmb_path *path, double *x)
{
    dmb_solve_for(path->work, x, x);
}

/* Factors the stiffness; `judged`: assesses its stability too, for the next point. */
static int32_t factor(dmb_path *path, int judged, dmb_block_weakest *weakest, int64_t *bad)
{
    dmb_stability found = {.amount = path->amounts};
    if (!judged) {
        dmb_system_iteration_matrix(&path->search.evaluation);
        *bad = dmb_factor_stiffness(path->work, weakest);
        return DMB_OK;
    }
    const int32_t status = dmb_stability_judge(&path->search, 0, weakest, bad, &found);
    path->next.negative = found.negative;
    path->next.odd = found.odd;
    if (status >= 0 && found.negative < 0) path->unresolved = 1;
    path->next.stiffness = found.stiffness;
    return status;
}

/* path->loaded: displacements per unit of the factor, from the last evaluated stiffness; path->move: correction of the
 * residual. A motion drive moves its own row by 1 per unit of the factor. */
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

/* Moves by path->move and the factor with it. The stress of the next stiffness is extrapolated
 * (eq:static.extrapolated). */
static int32_t advance(dmb_path *path, double factor)
{
    path->next.factor += factor;
    dmb_system_extrapolate_stress(path->work, path->move);
    path->search.evaluation.extrapolated = 1;
    return dmb_static_move(&path->search, path->move, 1.0);
}

/* Predictor: from the last point along the tangent. Joints are closed again by the move. */
static int32_t predict(dmb_path *path, const double *direction, double rate, double arc)
{
    dmb_sim *work = path->work;
    dmb_configuration_copy(work, &work->now, &work->trial);
    memset(work->increment, 0, work->scene->row_count * sizeof(double));
    path->next.factor = path->last.factor;
    path->next.arc = path->last.arc + arc;
    path->search.evaluation.extrapolated = 0;
    const int32_t status = dmb_path_evaluate(path, 0); /* strains for the extrapolation */
    if (status < 0) return status;
    for (uint32_t i = 0; i < work->scene->row_count; i++) path->move[i] = arc * direction[i];
    return advance(path, arc * rate);
}

/* Corrector: Newton with one factorisation for both right-hand sides; stays in the plane t . D z = 0 normal to
 * `direction`. Convergence is that of statics. K itself is factored, so that a limit point cannot be computed exactly,
 * only points beside it. */
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
    const dmb_configuration now = path->work->now; /* the query reads `now` */
    path->work->now = path->work->trial;
    (void)dmb_answer_pose(path->work, path->options->place, &pose); /* the place was checked with the options */
    path->work->now = now;
    return pose.displacement[path->options->component];
}

/* Unit tangent -K^-1 q / |K^-1 q|, in the sense of `towards`: the sign of the factor's rate then changes at a limit
 * point. */
int32_t dmb_path_tangent(dmb_path *path, const double *towards)
{
    path->search.evaluation.extrapolated = 0;
    int32_t status = dmb_path_evaluate(path, 1);
    if (status >= 0) status = solve_both(path, 1);
    if (status < 0) return status;
    double length = sqrt(dmb_path_dot(path, path->loaded, path->loaded));
    if (!(length > 0.0) && path->weakest >= DMB_UNCONSTRAINED_PIVOT)
        dmb_message_set(&path->sim->message, "path: the factor moves nothing");
    if (!(length > 0.0) || !isfinite(length)) return DMB_ERR_SINGULAR;
    if (dmb_path_dot(path, path->loaded, towards) < 0.0) length = -length;
    for (uint32_t i = 0; i < path->work->scene->row_count; i++) path->next.tangent[i] = path->loaded[i] / length;
    path->next.rate = 1.0 / length;
    path->next.watched = watched_of(path);
    return DMB_OK;
}

int32_t dmb_path_accept(dmb_path *path)
{
    dmb_sim *work = path->work;
    const dmb_path_place place = path->last;
    path->search.evaluation.extrapolated = 0;
    const int32_t status = evaluate(path, 0); /* reactions */
    if (status < 0) return status;
    dmb_system_unwrap(work);
    dmb_system_accept(&path->search.evaluation);
    memset(work->increment, 0, work->scene->row_count * sizeof(double));
    dmb_configuration_copy(work, &work->trial, &work->now);
    path->last = path->next;
    path->next = place;
    return DMB_OK;
}

/* ---- Events ------------------------------------------------------------------------------------------------------ */

/* Events between two points of a path, and branches. */

static int passes(double end, double last, double next)
{
    return (last < end && next >= end) || (last > end && next <= end);
}

int32_t dmb_path_end(const dmb_path *path, int32_t but)
{
    const dmb_path_options *o = path->options;
    if (but != DMB_EVENT_FACTOR && passes(o->factor_end, path->last.factor, path->next.factor)) return DMB_EVENT_FACTOR;
    if (but != DMB_EVENT_DISPLACEMENT && o->place.part.generation != 0 &&
        passes(o->displacement_end, path->last.watched, path->next.watched))
        return DMB_EVENT_DISPLACEMENT;
    return DMB_EVENT_NONE;
}

/* Change of the count; of an unresolved one its parity, which is the sign of det K. */
static int32_t change_of_count(const dmb_path *path)
{
    const dmb_path_place *last = &path->last, *next = &path->next;
    const int resolved = last->negative >= 0 && next->negative >= 0;
    return resolved ? next->negative - last->negative : next->odd - last->odd;
}

int dmb_path_count_changes(const dmb_path *path)
{
    return change_of_count(path) != 0;
}

/* The limit point comes first: there an eigenvalue changes sign, too, and the count alone would name it a bifurcation.
 * `side` is the rate of the last point, or at a limit point the rate beyond. */
int32_t dmb_path_event(const dmb_path *path)
{
    if (path->side * path->next.rate < 0.0) return DMB_EVENT_LIMIT;
    if (dmb_path_count_changes(path)) return DMB_EVENT_BIFURCATION;
    return dmb_path_end(path, DMB_EVENT_NONE);
}

/* ---- Softest shape ----------------------------------------------------------------------------------------------- */

#define DMB_MODE_ITERATIONS 12

static void weigh(const dmb_path *path, const double *x, double *out)
{
    const dmb_scene *scene = path->work->scene;
    const double of_rotations = scene->length_scale * scene->length_scale;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        const uint32_t size = scene->layout.size[i], row = scene->layout.row[i];
        for (uint32_t c = 0; c < size; c++) out[row + c] = (2 * c < size ? 1.0 : of_rotations) * x[row + c];
    }
}

static double normalise(const dmb_path *path, double *x)
{
    const double length = sqrt(dmb_path_dot(path, x, x));
    for (uint32_t i = 0; i < path->work->scene->row_count && length > 0.0; i++) x[i] /= length;
    return length;
}

/* Start of the inverse iteration: the last mode plus a small reproducible random vector. A shape orthogonal to the last
 * mode would not be found from that mode alone. */
#define DMB_MODE_SEED 0.01

static void begin_mode(const dmb_path *path)
{
    const dmb_scene *scene = path->work->scene;
    uint64_t seed = 88172645463325252u;
    (void)normalise(path, path->mode);
    for (uint32_t i = 0; i < scene->row_count; i++) {
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        const double any = (double)(seed >> 11) / 9007199254740992.0 - 0.5;
        path->mode[i] = scene->solved_row[i] ? path->mode[i] + DMB_MODE_SEED * any : 0.0;
    }
    (void)normalise(path, path->mode);
}

/* Eigenvalue of K x = mu D x of smallest magnitude [N/m], by inverse iteration with the present factors, which give
 * -K^-1 D x. */
static double softness(dmb_path *path)
{
    const uint32_t rows = path->work->scene->row_count;
    double *x = path->iterate, grown = 1.0;
    begin_mode(path);
    for (int k = 0; k < DMB_MODE_ITERATIONS; k++) {
        weigh(path, path->mode, x);
        dmb_solve_for(path->work, x, x);
        const double along = dmb_path_dot(path, path->mode, x);
        grown = normalise(path, x) * (along > 0.0 ? -1.0 : 1.0);
        memcpy(path->mode, x, rows * sizeof(double));
    }
    path->rounding = dmb_stiffness_rounding_of(path->work, path->amounts, path->mode);
    return 1.0 / grown;
}

/* ---- Locating ---------------------------------------------------------------------------------------------------- */

/* Event between the last point and `arc`. counted 1: bisection by the number of negative eigenvalues, which finds the
 * first change, because the softest shape does not change sign, or two do. */
typedef struct quest {
    int32_t event, counted;
} quest;

/* Function that vanishes at the event, at `arc` from the last point. */
static int32_t probe(dmb_path *path, const quest *q, double arc, double *value)
{
    int32_t status = dmb_path_correct(path, path->last.tangent, path->last.rate, arc);
    if (status >= 0) status = dmb_path_tangent(path, path->last.tangent);
    if (status < 0) return status;
    if (q->event == DMB_EVENT_LIMIT) *value = path->next.rate;
    if (q->event == DMB_EVENT_BIFURCATION) path->softest = *value = softness(path);
    if (q->event == DMB_EVENT_BIFURCATION && q->counted) *value = dmb_path_count_changes(path) ? -1.0 : 1.0;
    if (q->event == DMB_EVENT_FACTOR) *value = path->next.factor - path->options->factor_end;
    if (q->event == DMB_EVENT_DISPLACEMENT) *value = path->next.watched - path->options->displacement_end;
    return DMB_OK;
}

#define DMB_LOCATE_ITERATIONS 60
#define DMB_LOCATED 1e-8

/* An interval of the arc, and the function at its ends. */
typedef struct bracket {
    double low, high, at_low, at_high;
} bracket;

static int32_t probe_ends(dmb_path *path, const quest *q, bracket *b)
{
    const int32_t status = probe(path, q, b->high, &b->at_high);
    return status < 0 ? status : probe(path, q, b->low, &b->at_low);
}

/* Regula falsi with the Illinois modification: a retained end value is halved. Bisection if only signs are known. */
static int32_t close_in(dmb_path *path, const quest *q, bracket *b, double within)
{
    const double unit = fmax(fabs(b->at_low), fabs(b->at_high));
    double value = 0.0;
    for (int k = 0, kept = 0; k < DMB_LOCATE_ITERATIONS && b->high - b->low > within; k++) {
        const double secant = b->high - b->at_high * (b->high - b->low) / (b->at_high - b->at_low);
        const double middle = q->counted ? 0.5 * (b->low + b->high) : secant;
        const int32_t status = probe(path, q, middle, &value);
        if (status < 0) return status;
        if (!q->counted && fabs(value) <= DMB_LOCATED * unit) break;
        if (value * b->at_high > 0.0) {
            b->high = middle;
            b->at_high = value;
            b->at_low *= kept > 0 ? 0.5 : 1.0;
            kept = 1;
        } else {
            b->low = middle;
            b->at_low = value;
            b->at_high *= kept < 0 ? 0.5 : 1.0;
            kept = -1;
        }
    }
    return DMB_OK;
}

/* If a contact opens or closes the stiffness jumps, and its determinant may change sign without singularity. The path
 * then has a corner, and continues so that det K times the sense of (-K^-1 q, 1) is unchanged: the factor reverses. */
#define DMB_CORNER 1e-4
#define DMB_ROUNDINGS 3.0

/* Reverses the path at a corner where det K changes its sign; next is just beyond it. */
static void turn_corner(dmb_path *path, int32_t *event)
{
    *event = DMB_EVENT_NONE;
    if (change_of_count(path) % 2 == 0) return;
    *event = DMB_EVENT_LIMIT;
    path->next.rate = -path->next.rate;
    for (uint32_t i = 0; i < path->work->scene->row_count; i++) path->next.tangent[i] = -path->next.tangent[i];
    path->side = path->next.rate;
}

static void take_count(dmb_path *path, const dmb_path_place *from)
{
    path->next.negative = from->negative;
    path->next.odd = from->odd;
}

/* First change of the count: by the count to a thousandth of the step, and then by the eigenvalue that changes sign
 * there. The count is shifted by its rounding level: therefore the second interval begins further back. */
#define DMB_ISOLATED 1e-3
#define DMB_STEP_BACK 0.1

/* Steps, all on the arc between the last point (0) and the next one (`arc`):
 *
 *     1. probe_ends     softest eigenvalue at both ends: the scale `size` of its values
 *     2. by count       bisection to the first change of the count, within DMB_ISOLATED
 *     3. by eigenvalue  regula falsi of the softest eigenvalue around it; by count if it does not change sign there
 *     4. result         eigenvalue 0 to rounding at the point: bifurcation
 *                       not 0: a contact opened or closed there, a corner (turn_corner)
 *                       0 along the whole step: a neutral motion, no event */
static int32_t locate_bifurcation(dmb_path *path, quest *q, double arc, int32_t *event)
{
    bracket whole = {0.0, arc, 0.0, 0.0}, counted = {0.0, arc, 1.0, -1.0}, soft;
    int32_t status = probe_ends(path, q, &whole);
    const double size = fmax(fabs(whole.at_low), fabs(whole.at_high));
    path->side = path->last.rate;
    q->counted = 1;
    if (status >= 0) status = close_in(path, q, &counted, DMB_ISOLATED * arc);
    soft.low = fmax(counted.low - DMB_STEP_BACK * arc, 0.0);
    soft.high = counted.high;
    q->counted = 0;
    if (status >= 0) status = probe(path, q, soft.low, &soft.at_low);
    if (status >= 0) status = probe(path, q, soft.high, &soft.at_high);
    if (status < 0) return status;
    const dmb_path_place beyond = path->next;
    q->counted = soft.at_low * soft.at_high >= 0.0 || fabs(soft.at_low) <= DMB_CORNER * size;
    if (q->counted) soft = counted;
    status = close_in(path, q, &soft, DMB_LOCATED * arc);
    if (status < 0) return status;
    const double rounding = DMB_ROUNDINGS * path->rounding;
    if (size <= rounding) *event = DMB_EVENT_NONE; /* neutral along the whole step: the sign does not matter */
    const int corner = fabs(path->softest) > fmax(DMB_CORNER * size, rounding);
    if (corner) status = probe(path, q, soft.high, &soft.at_high);
    take_count(path, &beyond); /* at the bifurcation itself the sign is rounding */
    if (corner && status >= 0) turn_corner(path, event);
    return status;
}

/* From a singular stiffness a step may reach another, distant path: no end exists between the two. */
#define DMB_AT_END 1e-6

static int is_at_end(const dmb_path *path, int32_t event, double before)
{
    const dmb_path_options *o = path->options;
    const double end = event == DMB_EVENT_FACTOR ? o->factor_end : o->displacement_end;
    const double at = event == DMB_EVENT_FACTOR ? path->next.factor : path->next.watched;
    return fabs(at - end) <= DMB_AT_END * (fabs(before) + 1e-3 * fabs(end));
}

int32_t dmb_path_locate(dmb_path *path, int32_t *event, double arc)
{
    quest q = {*event, 0};
    bracket b = {0.0, arc, 0.0, 0.0};
    const double side = path->next.rate;
    const dmb_path_place beyond = path->next;
    if (*event == DMB_EVENT_BIFURCATION) return locate_bifurcation(path, &q, arc, event);
    int32_t status = probe_ends(path, &q, &b);
    const double before = b.at_low;
    if (status >= 0) status = close_in(path, &q, &b, DMB_LOCATED * arc);
    if (status < 0) return status;
    if (*event != DMB_EVENT_LIMIT) return is_at_end(path, *event, before) ? DMB_OK : DMB_ERR_NO_CONVERGENCE;
    take_count(path, &beyond); /* at the limit point itself the sign is rounding */
    path->side = side;
    return DMB_OK;
}

/* ---- Branches ---------------------------------------------------------------------------------------------------- */

#define DMB_LEAVE_TRIES 12

/* Component of the mode orthogonal to the path, with its largest entry positive (options.branch >= 0). */
static void straighten_mode(dmb_path *path)
{
    const uint32_t rows = path->work->scene->row_count;
    const double along = dmb_path_dot(path, path->mode, path->last.tangent);
    double most = 0.0;
    for (uint32_t i = 0; i < rows; i++) {
        path->mode[i] -= along * path->last.tangent[i];
        if (fabs(path->mode[i]) > fabs(most)) most = path->mode[i];
    }
    (void)normalise(path, path->mode);
    const double side = most * path->options->branch < 0.0 ? -1.0 : 1.0;
    for (uint32_t i = 0; i < rows; i++) path->mode[i] *= side;
}

/* Starts along the mode with the factor fixed (rate 0), since the branch leaves the path across it; the corrector then
 * stays in the plane normal to the mode and cannot return to the path. */
int32_t dmb_path_leave(dmb_path *path, double *arc)
{
    int32_t status = DMB_ERR_NO_CONVERGENCE;
    straighten_mode(path);
    for (int k = 0; k < DMB_LEAVE_TRIES; k++, *arc *= 0.5) {
        status = dmb_path_correct(path, path->mode, 0.0, *arc);
        if (status >= 0) status = dmb_path_tangent(path, path->mode);
        if (status >= 0 || dmb_is_final(status)) break;
        path->report.cuts++;
    }
    path->side = path->next.rate;
    return status;
}
