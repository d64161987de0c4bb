#include "integrator/follow.h"

#include <math.h>
#include <string.h>

#include "integrator/newton.h"
#include "system/assemble/drives.h"
#include "system/constrain/cluster.h"
#include "system/solve/solve.h"
#include "system/system.h"

/* The follower's own attempt at the leader's step. */
typedef struct course {
    dmb_sim *sim;
    const dmb_lead *lead;
    dmb_generalized_alpha c;
    dmb_attempt attempt;
} course;

static course course_of(dmb_sim *follower, const dmb_lead *lead)
{
    course to;
    memset(&to, 0, sizeof to);
    to.sim = follower;
    to.lead = lead;
    to.c = dmb_generalized_alpha_of(follower->options.spectral_radius);
    to.attempt.end = lead->attempt->end;
    to.attempt.block = DMB_NONE;
    return to;
}

static int32_t evaluate(course *of, int32_t tangent)
{
    dmb_evaluation *evaluation = &of->attempt.evaluation;
    evaluation->tangent = tangent;
    const int32_t status = of->sim->scene->cluster_count ? dmb_clusters_settle(evaluation, DMB_SETTLE_ALL, 1) : DMB_OK;
    return status < 0 ? status : dmb_system_evaluate(evaluation);
}

/* Prediction from the follower's own state. */
static int32_t predict(course *of)
{
    dmb_attempt_set_up(of->sim, &of->attempt.end, &of->attempt.evaluation);
    dmb_step_motion_predict(of->sim, &of->c, of->attempt.end.step);
    const int32_t status = dmb_system_prescribe(&of->attempt.evaluation);
    if (status < 0) return status;
    if (of->sim->scene->cluster_count) dmb_step_motion_keep_prescribed(of->sim);
    dmb_step_motion_place(of->sim);
    return DMB_OK;
}

/* Residual, tangent and factors at the trial. */
static int32_t factor(course *of)
{
    const int32_t status = evaluate(of, 1);
    if (status < 0) return status;
    dmb_system_iteration_matrix(&of->attempt.evaluation);
    return dmb_factor_matrix(of->sim, of->sim->options.constraint_method) >= 0 ? DMB_ERR_SINGULAR : DMB_OK;
}

static double size_of_correction(const dmb_sim *sim)
{
    double size = 0.0;
    for (uint32_t i = 0; i < sim->scene->row_count; i++) size = fmax(size, fabs(sim->correction[i]));
    return size;
}

/* A correction that is this part of the first, or this many metres or radians, need not be felt in the forces. */
#define DMB_SETTLED_PART 1e-8
#define DMB_SETTLED_SIZE 1e-15
enum { DMB_CORRECTIONS_MAX = 12 };

/* Corrections by the factors at hand. The second shows whether the first has done: tangents of contacts that close and
 * of bits that meet the rock are off by some 1e-5, and the iteration matrix of joints, which leaves out how the
 * projection turns with the pose, by some 1e-2. */
static int32_t correct(course *of)
{
    const int jointed = of->sim->scene->cluster_count > 0; /* what moves is put on the joints by the evaluation */
    double first = 0.0;
    for (uint32_t k = 0; k < DMB_CORRECTIONS_MAX; k++) {
        dmb_solve_correction(of->sim);
        const double size = size_of_correction(of->sim);
        dmb_step_motion_correct(of->sim, &of->c, of->attempt.end.step);
        if (k == 0) first = size;
        const int done = k > 0 && size <= fmax(DMB_SETTLED_PART * first, DMB_SETTLED_SIZE);
        const int32_t status = done && !jointed ? DMB_OK : evaluate(of, 0);
        if (status < 0) return status;
        if (done) break;
    }
    return DMB_OK;
}

/* Contacts that open are treated as in integrator/attempt, from the leader's increments before and after, each with
 * factors of its own. */
static int32_t follow_release(course *of)
{
    dmb_sim *sim = of->sim;
    dmb_step_motion_go_to(of->sim, &of->c, of->attempt.end.step, of->lead->opening);
    int32_t status = factor(of);
    if (status >= 0) status = correct(of);
    if (status < 0) return status;
    status = dmb_released_acceleration(&of->attempt.evaluation, sim->correction, sim->released_part);
    if (status < 0) return status;
    dmb_step_motion_take(sim, of->lead->sim->increment);
    dmb_attempt_refit(sim, &of->c, of->attempt.end.step);
    dmb_step_motion_place(sim);
    dmb_attempt_set_up(sim, &of->attempt.end, &of->attempt.evaluation);
    status = factor(of);
    if (status >= 0) status = correct(of);
    dmb_release_end(sim);
    return status;
}

static int32_t follow(course *of)
{
    int32_t status = predict(of);
    if (status < 0) return status;
    if (of->lead->attempt->released) return follow_release(of);
    dmb_step_motion_go_to(of->sim, &of->c, of->attempt.end.step, of->lead->sim->increment);
    status = evaluate(of, 0);
    return status < 0 ? status : correct(of);
}

int32_t dmb_follow_prepare(dmb_sim *follower, const dmb_lead *lead)
{
    course of = course_of(follower, lead);
    int32_t status = predict(&of);
    if (status < 0) return status;
    if (lead->attempt->released) {
        status = dmb_newton(follower, &of.c, &of.attempt);
        memcpy(lead->opening, follower->increment, follower->scene->row_count * sizeof(double));
        return status < 0 ? status : DMB_OK;
    }
    dmb_step_motion_go_to(of.sim, &of.c, of.attempt.end.step, lead->sim->increment);
    return factor(&of);
}

int32_t dmb_follow_step(dmb_sim *follower, const dmb_lead *lead)
{
    course of = course_of(follower, lead);
    const int32_t status = follow(&of);
    if (status < 0) return status;
    dmb_system_accept(&of.attempt.evaluation);
    return DMB_OK;
}
