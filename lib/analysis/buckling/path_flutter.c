/* Flutter along equilibria of non-symmetric stiffness: the largest real part of a root of det(s^2 M + s C + K) = 0
 * (eq:static.characteristic), by damped modes about each state.
 *
 *     along a path   dmb_flutter_look: at each point; growth is bracketed by bisection between it and the point before
 *     in one pose    dmb_flutter_of_pose: at 20 equal parts of the factor, then bisection in the first part that grows
 *
 * Growth that appears and vanishes between two such states is missed. A state whose modes cannot be computed is
 * skipped, and a result without flutter then becomes DMB_FLUTTER_NOT_JUDGED.
 * With assumed slip nothing is assessed (`off`). */
#include "analysis/buckling/buckling.h"

#include <math.h>
#include <string.h>

#include "analysis/modes/modes.h"
#include "sim/access.h"
#include "sim/layout.h"
#include "system/system.h"

/* [-] Growth below this fraction of a root is rounding: undamped modes lie on the imaginary axis. */
#define DMB_GROWTH_ROUNDING 1e-6
/* Accuracy of the factor of flutter, as a fraction of its interval. */
#define DMB_FLUTTER_LOCATED 1e-6
#define DMB_FLUTTER_TRIES 40
#define DMB_FLUTTER_PARTS 20

int dmb_flutter_goes_on(const dmb_flutter *flutter)
{
    return !flutter->off && flutter->info->flutter != DMB_FLUTTER_FOUND;
}

void dmb_flutter_close(dmb_flutter *flutter)
{
    dmb_state_discard(flutter->state);
    flutter->state = NULL;
}

void dmb_flutter_conclude(dmb_flutter *flutter)
{
    if (flutter->failed && flutter->info->flutter == DMB_FLUTTER_NONE) flutter->info->flutter = DMB_FLUTTER_NOT_JUDGED;
}

/* Skips a state whose modes cannot be computed; the analysis continues. */
static int32_t pass_by(dmb_flutter *flutter, int32_t status)
{
    flutter->failed = 1;
    flutter->growth = 0.0;
    return dmb_is_final(status) ? status : DMB_OK;
}

/* Largest real part of a damped mode about flutter->state; 0 if it is rounding of a mode without growth or decay. The
 * linearisation scales gravity, loads and bit loads by 1 + factor itself if all loads grow; single loads are already
 * part of the copied trial. The root with growth is stored with its factor: bisection overwrites it with the lowest
 * one found. */
static int32_t judge(dmb_flutter *flutter, double factor)
{
    const double growth = flutter->pattern->scale == DMB_SCALE_ALL ? factor : 0.0;
    double root[2];
    const int32_t status = dmb_modes_growth(flutter->state, growth, &flutter->message, root);
    if (status < 0) return pass_by(flutter, status);
    if (flutter->info->flutter == DMB_FLUTTER_NOT_JUDGED) flutter->info->flutter = DMB_FLUTTER_NONE;
    const int rounding = fabs(root[0]) <= DMB_GROWTH_ROUNDING * hypot(root[0], root[1]);
    flutter->growth = rounding ? 0.0 : root[0];
    if (rounding || !(root[0] > 0.0)) return DMB_OK;
    flutter->info->flutter = DMB_FLUTTER_FOUND;
    flutter->info->flutter_factor = factor;
    memcpy(flutter->info->flutter_root, root, sizeof root);
    return DMB_OK;
}

/* Sets flutter->state to the trial of `at`. */
static int32_t take(dmb_flutter *flutter, const dmb_sim *at)
{
    if (flutter->state == NULL) flutter->state = dmb_state_copy(at);
    if (flutter->state == NULL) return DMB_ERR_NO_MEMORY;
    flutter->state->progress = at->progress;
    dmb_configuration_copy(flutter->state, &at->trial, &flutter->state->now);
    dmb_configuration_copy(flutter->state, &at->trial, &flutter->state->trial);
    return DMB_OK;
}

int32_t dmb_flutter_begin(dmb_flutter *flutter, const dmb_path *path)
{
    if (path->search.evaluation.slipping) flutter->off = 1;
    if (flutter->off || path->last.stiffness != DMB_STIFFNESS_UNSYMMETRIC) return DMB_OK;
    const int32_t status = take(flutter, path->work);
    return status < 0 ? status : judge(flutter, path->last.factor);
}

/* Assesses growth at the point `arc` beyond the last one. */
static int32_t probe(dmb_flutter *flutter, dmb_path *path, double arc)
{
    int32_t status = dmb_path_correct(path, path->last.tangent, path->last.rate, arc);
    if (status >= 0) status = take(flutter, path->work);
    return status < 0 ? status : judge(flutter, path->next.factor);
}

/* Bisection, because the growing mode may change. */
static int32_t close_in(dmb_flutter *flutter, dmb_path *path, double arc)
{
    double low = 0.0, high = arc;
    for (int k = 0; k < DMB_FLUTTER_TRIES && high - low > DMB_FLUTTER_LOCATED * arc; k++) {
        const double middle = 0.5 * (low + high);
        const int32_t status = probe(flutter, path, middle);
        if (status < 0) { /* the assessed point may lie on another path */
            flutter->info->flutter = DMB_FLUTTER_NOT_JUDGED;
            return status;
        }
        if (flutter->growth > 0.0)
            high = middle;
        else
            low = middle;
    }
    return DMB_OK;
}

int32_t dmb_flutter_look(dmb_flutter *flutter, dmb_path *path, double arc)
{
    const int32_t status = probe(flutter, path, arc);
    return status < 0 || flutter->info->flutter != DMB_FLUTTER_FOUND ? status : close_in(flutter, path, arc);
}

static int32_t judge_pose(dmb_flutter *flutter, double factor)
{
    dmb_evaluation evaluation;
    memset(&evaluation, 0, sizeof evaluation);
    evaluation.sim = flutter->state;
    dmb_load_pattern_set(flutter->pattern, &evaluation, factor);
    dmb_configuration_copy(flutter->state, &flutter->state->trial, &flutter->state->now);
    return judge(flutter, factor);
}

/* The pose stays that of factor 0, therefore it applies to loads that move nothing, or to factor 0 alone (to = 0). At a
 * critical factor of divergence a root is 0: with `through` 0 the end itself is left out. */
int32_t dmb_flutter_of_pose(dmb_flutter *flutter, dmb_sim *at, double to, int through)
{
    double low = 0.0, high = 0.0;
    flutter->state = dmb_state_copy(at);
    int32_t status = flutter->state != NULL ? judge_pose(flutter, 0.0) : DMB_ERR_NO_MEMORY;
    const int last = to > 0.0 ? DMB_FLUTTER_PARTS - !through : 0;
    for (int k = 1; status >= 0 && k <= last && dmb_flutter_goes_on(flutter); k++) {
        low = high;
        high = to * k / DMB_FLUTTER_PARTS;
        status = judge_pose(flutter, high);
    }
    const double stretch = high - low;
    while (status >= 0 && !dmb_flutter_goes_on(flutter) && high - low > DMB_FLUTTER_LOCATED * stretch) {
        const double middle = 0.5 * (low + high);
        status = judge_pose(flutter, middle);
        if (flutter->growth > 0.0)
            high = middle;
        else
            low = middle;
    }
    return status;
}
