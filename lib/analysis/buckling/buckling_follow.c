/* Path following from the present state along the equilibria to the loss of stability. A factor from one linearisation
 * is an extrapolation: forces rotate, contacts shift and open, sections rotate along the path. Strategies in their
 * order:
 *
 *   run_and_confirm  1. a run with steps of free length; with flutter or without an end, the result is that of this run
 *                    2. up to 2 runs with steps half as long as in the previous one, until two consecutive runs agree
 *                    3. without agreement and after a failure of the last run: a run with steps of free length again;
 *                       the factor is then not confirmed
 *   walk (one run)   steps by arc length, so that the path may end at a limit point, with the first that applies:
 *                    1. a failed step: the run ends with an error, after steps shortened by dmb_path_find_next
 *                    2. limit point or bifurcation: linearised just before it (at 0.98, 0.9, 0.5, 0 of the last step),
 *                       which gives the shape, further factors and, if K is smooth, more digits
 *                    3. symmetric K: a deep minimum of the lowest eigenvalue was passed (buckling_dip.c)
 *                    4. factor_max reached: stable up to there
 *                    5. target factor reached: linearised again, which sets the next target (look_ahead)
 *
 * For non-symmetric K two negative eigenvalues from a complex pair are ignored, and flutter is assessed between the
 * points (path_flutter.c). */
#include <math.h>
#include <string.h>

#include "analysis/buckling/buckling.h"
#include "sim/access.h"
#include "system/system.h"

/* Limits of points and linearisations after which a stable path is abandoned. */
#define DMB_FOLLOW_POINTS 2000
#define DMB_FOLLOW_LINEARISATIONS 400
/* Step lengths. FIRST: first step over the distance of the factor. APPROACH: fraction of the distance while it is
 * longer than the fraction NEAR of the factor, with a linearisation at its end. PAST: then slightly more than the
 * distance, so that a short unstable stretch is not missed. If the estimate moves away by more than the fraction MOVES
 * of the distance, it is too cautious, and the path advances by the fraction GROWTH of its factor at a time. */
#define DMB_FOLLOW_FIRST 0.25
#define DMB_FOLLOW_APPROACH 0.9
#define DMB_FOLLOW_NEAR 0.02
#define DMB_FOLLOW_PAST 1.05
#define DMB_FOLLOW_GROWTH 0.05
#define DMB_FOLLOW_MOVES 0.3
/* Longest step while flutter is assessed, over the factor. */
#define DMB_FOLLOW_FLUTTER 0.05

typedef struct follower {
    dmb_buckling *buckling;
    dmb_sim *sim;
    const dmb_buckling_options *options;
    dmb_path_options path_options;
    dmb_path path;
    dmb_flutter flutter;
    double estimate; /* [unit of the factor] loss of stability by the last linearisation */
    double target;   /* [unit of the factor] of the next linearisation */
    double arc;
    double longest; /* [m] longest step so far */
    dmb_dip dip;
    dmb_vector steps;         /* arc_step of this run */
    const dmb_vector *longer; /* steps of the run whose steps are halved; NULL: none */
} follower;

/* A step along the path. */
typedef struct arc_step {
    double end, length; /* [m] of arc */
} arc_step;

/* [m] Longest step from the last point: half of that of the previous run. */
static double longest_step(const follower *f)
{
    if (f->longer == NULL || f->longer->count == 0) return (double)INFINITY;
    size_t k = 0;
    while (k + 1 < f->longer->count && DMB_VECTOR_AT(arc_step, f->longer, k)->end <= f->path.last.arc) k++;
    return 0.5 * DMB_VECTOR_AT(arc_step, f->longer, k)->length;
}

static int32_t open_path(follower *f)
{
    const dmb_buckling_options *o = f->options;
    dmb_path *path = &f->path;
    (void)dmb_path_options_init(&f->path_options, (uint32_t)sizeof f->path_options);
    f->path_options.scale = o->scale;
    f->path_options.part = o->part;
    f->path_options.factor_end = o->factor_max;
    f->path_options.slip_axial = o->slip_axial;
    f->path_options.slip_rotation = o->slip_rotation;
    path->sim = f->sim;
    path->options = &f->path_options;
    path->pattern = f->buckling->pattern;
    return dmb_path_open(path);
}

/* K and G, factors and shapes about the last point of the path. */
static int32_t linearise_here(follower *f)
{
    f->buckling->at = f->path.last.factor;
    dmb_state_assign(f->path.work, f->buckling->work);
    const int32_t status = dmb_buckling_linearise(f->buckling, f->sim, f->options);
    return status < 0 ? status : dmb_buckling_find(f->buckling, f->options, &f->sim->message);
}

static int32_t say_lost(follower *f, int32_t status)
{
    if (dmb_is_final(status)) return status;
    dmb_message_set(
        &f->sim->message,
        "buckling: the equilibria are stable up to factor = %g and could not be followed to the critical factor "
        "that the last of them predicts, %g; use finer elements or a softer wall, or follow = 0 for the extrapolation "
        "from the present state, %g",
        f->path.last.factor, f->estimate, f->buckling->first[0]);
    return DMB_ERR_NO_CONVERGENCE;
}

static int32_t say_stable(follower *f)
{
    if (isfinite(f->buckling->first[0]))
        dmb_message_set(
            &f->sim->message,
            "buckling: the equilibria are stable up to factor = %g, beyond the critical factor %g that the present "
            "state predicts; follow = 0 gives that one",
            f->path.last.factor, f->buckling->first[0]);
    else
        dmb_message_set(&f->sim->message, "buckling: no eigenvalue of the stiffness passes 0 up to factor = %g",
                        f->path.last.factor);
    f->buckling->count = 0;
    f->buckling->info.end = DMB_BUCKLING_STABLE;
    return DMB_NOTE_STOPPED;
}

/* ---- End of the path --------------------------------------------------------------------------------------------- */

/* Fractions of the last step before its end at which the state is linearised. */
static const double step_back[] = {0.98, 0.9, 0.5, 0.0};

static int32_t linearise_before(follower *f, double arc)
{
    dmb_path *path = &f->path;
    int32_t status = DMB_ERR_NO_CONVERGENCE;
    for (int k = 0; k < 4 && status < 0 && !dmb_is_final(status); k++) {
        dmb_message_clear(&f->sim->message);
        status = DMB_OK;
        if (step_back[k] > 0.0) {
            status = dmb_path_correct(path, path->last.tangent, path->last.rate, step_back[k] * arc);
            if (status >= 0) status = dmb_path_tangent(path, path->last.tangent);
            if (status >= 0 && dmb_path_count_changes(path)) status = DMB_ERR_ORDER;
            if (status >= 0) status = dmb_path_accept(path);
        }
        if (status >= 0) status = linearise_here(f);
    }
    return status;
}

/* [-] Relative difference below which factors agree, or are equal. */
#define DMB_FOLLOW_AGREES 1e-5
#define DMB_FOLLOW_SAME 1e-6

static int same(double a, double b, double part)
{
    return fabs(a - b) <= part * fabs(b);
}

/* Confirms the factors: the first factor is that of the event; others are confirmed if the first linearisation gave the
 * same value, or if they equal the first. */
static void confirm(dmb_buckling *b, double event)
{
    uint32_t k = 1;
    if (!same(b->factor[0], event, DMB_FOLLOW_AGREES)) b->factor[0] = event;
    while (k < b->count &&
           (same(b->factor[k], b->factor[0], DMB_FOLLOW_SAME) || same(b->factor[k], b->first[k], DMB_FOLLOW_SAME)))
        k++;
    b->info.confirmed = k;
}

static int32_t end_at_event(follower *f, int32_t event)
{
    dmb_buckling *b = f->buckling;
    const double factor = f->path.next.factor, arc = f->path.next.arc - f->path.last.arc;
    int32_t status = linearise_before(f, arc);
    if (status < 0) return status;
    if (b->count == 0) return say_lost(f, DMB_ERR_NO_CONVERGENCE);
    b->info.end = event == DMB_EVENT_LIMIT ? DMB_BUCKLING_LIMIT : DMB_BUCKLING_BIFURCATION;
    /* beyond a limit point, or a corner with a contact change, this linearisation is not valid */
    if (event == DMB_EVENT_LIMIT || !same(b->factor[0], factor, DMB_FOLLOW_AGREES)) b->count = 1;
    confirm(b, factor);
    return b->count < f->options->count ? DMB_NOTE_STOPPED : DMB_OK;
}

/* Result at the deep minimum of the lowest eigenvalue that was passed. */
static int32_t end_at_dip(follower *f)
{
    dmb_buckling *b = f->buckling;
    dmb_state_assign(f->dip.state, b->work);
    b->at = b->factor[0] = f->dip.least.factor;
    b->count = b->info.confirmed = 1;
    b->info.end = DMB_BUCKLING_DIP;
    b->info.dip = f->dip.depth;
    b->info.reached = b->at;
    memcpy(b->shape, f->dip.least_shape, b->work->scene->row_count * sizeof(double));
    dmb_buckling_normalise(b->work->scene, b->shape);
    return f->options->count > 1 ? DMB_NOTE_STOPPED : DMB_OK;
}

/* ---- Stepping ---------------------------------------------------------------------------------------------------- */

static void choose_target(follower *f, int careful)
{
    const double factor = f->path.last.factor, distance = f->estimate - factor;
    const double part = distance > DMB_FOLLOW_NEAR * f->estimate ? DMB_FOLLOW_APPROACH : DMB_FOLLOW_PAST;
    f->target = factor + (careful ? fmax(DMB_FOLLOW_PAST * distance, DMB_FOLLOW_GROWTH * factor) : part * distance);
}

static void limit_arc(follower *f)
{
    const dmb_path_place *last = &f->path.last;
    f->arc = fmin(f->arc, longest_step(f));
    if (last->stiffness == DMB_STIFFNESS_UNSYMMETRIC && dmb_flutter_goes_on(&f->flutter))
        f->arc = fmin(f->arc, DMB_FOLLOW_FLUTTER * f->estimate / fabs(last->rate));
}

/* Steps grow as those of a path do, but not beyond the target. */
static void choose_arc(follower *f)
{
    const dmb_path_place *last = &f->path.last;
    const double growth = fmin(fmax(sqrt(5.0 / (f->path.iterations + 1.0)), 0.5), 2.0);
    f->arc = fmin(f->arc * growth, (f->target - last->factor) / fabs(last->rate));
    limit_arc(f);
}

#define DMB_FOLLOW_THERE 0.999

/* Linearises at the target. 1: continue; else the final status. */
static int32_t look_ahead(follower *f)
{
    const double before = f->estimate, distance = before - f->buckling->at;
    const int32_t status = linearise_here(f);
    if (status < 0) return status;
    const int none = f->buckling->count == 0, bounded = f->options->factor_max < DMB_FACTOR_MAX;
    if ((none && !bounded) || f->buckling->info.linearisations >= DMB_FOLLOW_LINEARISATIONS) return say_stable(f);
    f->estimate = none ? f->options->factor_max : f->buckling->factor[0];
    choose_target(f, fabs(f->estimate - before) > DMB_FOLLOW_MOVES * distance);
    return 1;
}

/* A step past a bifurcation may end on the crossing path, which is stable, and one past a limit point on another path:
 * the direction has changed. The step is repeated with shorter lengths, unless it is a corner with a contact change:
 * after TRIES repetitions, or if steps are below the fraction BREAKPOINT of the longest one, as near a corner. A point
 * whose negative eigenvalues could not be counted is replaced by a nearer one in the same way. */
#define DMB_FOLLOW_STRAIGHT 0.9
#define DMB_FOLLOW_SHORTER 0.25
#define DMB_FOLLOW_TRIES 8
#define DMB_FOLLOW_BREAKPOINT 1e-5

static int32_t find_next(follower *f, int32_t *event)
{
    dmb_path *path = &f->path;
    for (int k = 0;; k++, f->arc *= DMB_FOLLOW_SHORTER) {
        const int32_t status = dmb_path_find_next(path, &f->arc, event);
        if (status < 0 || *event != DMB_EVENT_NONE || path->next.negative > 0 || k >= DMB_FOLLOW_TRIES) return status;
        const int resolved = path->next.negative == 0;
        const int straight =
            resolved && dmb_path_dot(path, path->last.tangent, path->next.tangent) >= DMB_FOLLOW_STRAIGHT;
        if (straight) f->longest = fmax(f->longest, f->arc);
        if (straight || f->arc < DMB_FOLLOW_BREAKPOINT * f->longest) return status;
    }
}

/* Fraction of the step just before an event: at the event a root of the motion is 0. */
#define DMB_FOLLOW_BEFORE 0.98

/* Assesses flutter up to the next point, which is then computed again. */
static int32_t look_for_flutter(follower *f, int32_t event)
{
    dmb_path *path = &f->path;
    const double arc = path->next.arc - path->last.arc;
    const int singular = event == DMB_EVENT_BIFURCATION || event == DMB_EVENT_LIMIT;
    if (path->next.stiffness != DMB_STIFFNESS_UNSYMMETRIC || !dmb_flutter_goes_on(&f->flutter)) return DMB_OK;
    const dmb_path_place next = path->next;
    int32_t status = dmb_flutter_look(&f->flutter, path, singular ? DMB_FOLLOW_BEFORE * arc : arc);
    path->next = next;
    if (status < 0 || singular) return status;
    status = dmb_path_correct(path, path->last.tangent, path->last.rate, arc);
    return status < 0 ? status : dmb_path_tangent(path, path->last.tangent);
}

/* 1: the path ends here. A non-symmetric stiffness may have pairs of negative eigenvalues although det K has not passed
 * 0: only events count. */
static int ends(const dmb_path *path, int32_t event)
{
    if (event == DMB_EVENT_LIMIT || event == DMB_EVENT_BIFURCATION) return 1;
    return path->next.negative > 0 && path->next.stiffness != DMB_STIFFNESS_UNSYMMETRIC;
}

/* 1: continue; else the final status. */
static int32_t step(follower *f)
{
    dmb_path *path = &f->path;
    int32_t event = DMB_EVENT_NONE;
    dmb_progress_at(f->sim, 0.5 + 0.5 * path->last.factor / f->estimate);
    int32_t status = find_next(f, &event);
    if (status < 0) return say_lost(f, status);
    f->buckling->info.points++;
    status = look_for_flutter(f, event);
    if (status < 0) return say_lost(f, status);
    if (ends(path, event)) return end_at_event(f, event);
    if (path->next.negative < 0) return say_lost(f, DMB_ERR_NO_CONVERGENCE);
    const arc_step taken = {path->next.arc, path->next.arc - path->last.arc};
    status = dmb_vector_append(&f->steps, &f->sim->allocator, &taken, 1);
    if (status >= 0 && path->next.stiffness == DMB_STIFFNESS_SYMMETRIC)
        status = dmb_dip_look(&f->dip, path, taken.length, f->buckling->work);
    if (status < 0) return say_lost(f, status);
    if (status > 0) return end_at_dip(f);
    status = dmb_path_accept(path);
    if (status < 0) return say_lost(f, status);
    if (event == DMB_EVENT_FACTOR) return say_stable(f);
    return path->last.factor < DMB_FOLLOW_THERE * f->target ? 1 : look_ahead(f);
}

static int32_t walk(follower *f)
{
    int32_t status = open_path(f);
    if (status < 0) return status;
    status = dmb_flutter_begin(&f->flutter, &f->path);
    if (status < 0) return status;
    if (f->path.last.stiffness == DMB_STIFFNESS_SYMMETRIC) status = dmb_dip_begin(&f->dip, &f->path);
    if (status < 0) return say_lost(f, status);
    choose_target(f, 0);
    f->arc = DMB_FOLLOW_FIRST * f->target / fabs(f->path.last.rate);
    limit_arc(f);
    for (int k = 0; k < DMB_FOLLOW_POINTS; k++) {
        status = step(f);
        if (status != 1) return status;
        choose_arc(f);
    }
    return say_lost(f, DMB_ERR_NO_CONVERGENCE);
}

int32_t dmb_buckling_report_flutter(const dmb_buckling *buckling, dmb_sim *sim, const dmb_message *why, int32_t status)
{
    const dmb_buckling_info *info = &buckling->info;
    if (info->stiffness != DMB_STIFFNESS_UNSYMMETRIC || info->flutter == DMB_FLUTTER_NONE) return status;
    if (info->flutter == DMB_FLUTTER_FOUND) {
        dmb_message_set(
            &sim->message,
            "buckling: flutter from factor = %g on, before det K = 0: a damped mode grows there, its root is "
            "%g + %g i 1/s; more damping may hold it, see dmb_analysis_modes with DMB_MODES_DAMPED",
            info->flutter_factor, info->flutter_root[0], info->flutter_root[1]);
        return DMB_NOTE_FLUTTER;
    }
    if (status != DMB_OK) return status;
    dmb_message_set(&sim->message,
                    "buckling: the factors are those of divergence, det K = 0; whether an unsymmetric stiffness lets a "
                    "mode grow before was not assessed: %s",
                    why->text[0] != '\0' ? why->text : "friction is assumed to slip; use a run in time");
    return DMB_NOTE_INCOMPLETE;
}

/* ---- Runs with steps of half the length -------------------------------------------------------------------------- */

#define DMB_FOLLOW_RUNS 3
#define DMB_FOLLOW_DIP_AGREES 1e-3

/* Result of a run. */
typedef struct outcome {
    int32_t status, end;
    double factor;
} outcome;

static void begin_run(follower *f, const dmb_vector *longer, int first)
{
    dmb_buckling *b = f->buckling;
    const dmb_flutter flutter = f->flutter;
    dmb_sim *sim = f->sim;
    const dmb_buckling_options *options = f->options;
    memset(f, 0, sizeof *f);
    f->buckling = b;
    f->sim = sim;
    f->options = options;
    f->longer = longer;
    f->steps = dmb_vector_of(sizeof(arc_step));
    f->estimate = isfinite(b->first[0]) ? b->first[0] : options->factor_max;
    f->flutter.pattern = &f->path.pattern;
    f->flutter.info = &b->info;
    if (first) return;
    f->flutter = flutter;
    f->flutter.off = 1; /* assessed by the first run */
    b->at = 0.0;
    b->info.linearisations = 1;
    b->info.points = 0;
    b->info.confirmed = 0;
    b->info.dip = 0.0;
    b->info.end = DMB_BUCKLING_EXTRAPOLATED;
}

/* Follows the path from the present state to its end; the steps are kept. */
static outcome run(follower *f, const dmb_vector *longer, int first)
{
    outcome out;
    begin_run(f, longer, first);
    out.status = walk(f);
    if (f->buckling->info.end != DMB_BUCKLING_DIP) f->buckling->info.reached = f->path.last.factor;
    if (first) dmb_flutter_conclude(&f->flutter);
    out.end = f->buckling->info.end;
    out.factor = f->buckling->count > 0 ? f->buckling->factor[0] : f->path.last.factor;
    dmb_dip_close(&f->dip, f->sim);
    dmb_path_close(&f->path);
    return out;
}

static int agree(const outcome *a, const outcome *b)
{
    if (a->end != b->end || (a->status < 0) != (b->status < 0)) return 0;
    if (a->end == DMB_BUCKLING_STABLE) return 1;
    return same(a->factor, b->factor, a->end == DMB_BUCKLING_DIP ? DMB_FOLLOW_DIP_AGREES : DMB_FOLLOW_AGREES);
}

static void say_not_confirmed(follower *f, const outcome *coarse, const outcome *fine)
{
    dmb_message_set(&f->sim->message,
                    "buckling: the first factor is not confirmed: steps of half the length along the equilibria end at "
                    "factor = %g, the others at %g; contacts open and close in between, use more elements or a softer "
                    "wall",
                    fine->factor, coarse->factor);
}

/* Runs until two consecutive ones agree. The result is the last successful run; at a limit point the factor is that of
 * the previous run if they agree, because longer steps accumulate less of Newton's tolerance. */
static int32_t run_and_confirm(follower *f)
{
    dmb_vector longer = dmb_vector_of(sizeof(arc_step));
    outcome coarse = run(f, NULL, 1), fine = coarse;
    const int found = coarse.status >= 0 && f->buckling->info.flutter != DMB_FLUTTER_FOUND;
    int agreed = !found;
    for (int k = 1; k < DMB_FOLLOW_RUNS && !agreed && !dmb_is_final(fine.status); k++) {
        dmb_vector_release(&longer, &f->sim->allocator);
        longer = f->steps;
        coarse = fine;
        fine = run(f, &longer, 0);
        agreed = agree(&coarse, &fine);
    }
    if (!agreed && fine.status < 0 && !dmb_is_final(fine.status)) {
        const outcome lost = fine;
        dmb_vector_release(&f->steps, &f->sim->allocator);
        fine = run(f, NULL, 0);
        coarse = lost;
    }
    dmb_vector_release(&longer, &f->sim->allocator);
    dmb_vector_release(&f->steps, &f->sim->allocator);
    if (fine.status < 0) return fine.status;
    if (agreed && fine.end == DMB_BUCKLING_LIMIT) f->buckling->factor[0] = coarse.factor;
    if (agreed) return fine.status;
    f->buckling->info.confirmed = 0;
    say_not_confirmed(f, &coarse, &fine);
    return fine.status;
}

int32_t dmb_buckling_follow(dmb_buckling *buckling, dmb_sim *sim, const dmb_buckling_options *options)
{
    follower f;
    memset(&f, 0, sizeof f);
    f.buckling = buckling;
    f.sim = sim;
    f.options = options;
    int32_t status = run_and_confirm(&f);
    if (status == DMB_ERR_NO_CONVERGENCE && buckling->info.flutter == DMB_FLUTTER_FOUND) {
        buckling->count = 0;
        buckling->info.end = DMB_BUCKLING_STABLE;
        status = DMB_NOTE_STOPPED;
    }
    if (status >= 0 && buckling->count > 0) buckling->info.sinusoidal_share = dmb_dip_sinusoidal_ratio(buckling->work);
    dmb_flutter_close(&f.flutter);
    return status < 0 ? status : dmb_buckling_report_flutter(buckling, sim, &f.flutter.message, status);
}
