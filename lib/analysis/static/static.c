/* Static analysis: strategies in their order. A strategy is tried only if the previous one failed with an error that
 * is not final (no memory, callback, cancelled: the analysis ends at once).
 *
 *   find_state             1. the steady motion of the drives (steady_choice.c), or rest
 *                          2. AUTO only: at rest with DMB_NOTE_NOT_STEADY, if 1 proves not to be steady
 *   search_holding_spins   1. with unconstrained rotations constrained (static_spin.c)
 *                          2. without, if their torques do not sum to 0 and a spring, stop or force may resist
 *   search_equilibrium     1. search_by_newton
 *                          2. search_through_friction, with friction: 1 and 3 without it, then growing friction
 *                          3. search_further
 *   search_by_newton       1. soft-string initial guess on soft walls, if elements are long in a curved hole
 *                          2. Newton in the requested number of load steps (default 1)
 *                          3. soft-string initial guess, if not done in 1 and the matrix of 2 was not singular
 *   search_further         1. growing load steps with line search, unless the matrix was singular
 *                          2. relaxation, with corrections limited 1, 3, 9, 27, 81 times more strictly
 *   leave_unstable         up to 3 perturbed restarts of the relaxation, after an unstable state (of Newton: only if
 *                          a part has rotated far) and after any relaxation with non-symmetric stiffness */
#include "analysis/static/static.h"

#include <string.h>

#include "base/sized_struct.h"
#include "math/vec3.h"
#include "sim/access.h"
#include "sim/layout.h"
#include "system/assemble/assemble.h"
#include "system/constrain/constrain.h"
#include "system/solve/solve.h"
#include "system/system.h"

DMB_DECLARE_STRUCT(dmb_static_report)

static int may_try_again(int32_t status)
{
    return status < 0 && !dmb_is_final(status);
}

/* After divergence the relaxation restarts with corrections limited more strictly, but not for an unconstrained part.
 * Between walls the corrections are already short enough. */
#define DMB_CAUTION_MAX 100.0
#define DMB_CAUTION_ENOUGH 10.0 /* sufficient without joints and without excessive element rotation */

static int32_t relax(dmb_static_search *search, uint32_t steps, int singular)
{
    int32_t status = DMB_ERR_NO_CONVERGENCE;
    for (search->caution = 1.0; may_try_again(status) && search->caution < DMB_CAUTION_MAX; search->caution *= 3.0) {
        status = dmb_static_equal_steps(search, dmb_static_relaxation, steps);
        const int in_hole = search->sim->scene->site_count > 0;
        const int enough = search->caution > DMB_CAUTION_ENOUGH && search->sim->scene->cluster_count == 0;
        const int too_far = status == DMB_ERR_ROTATION || status == DMB_ERR_GEOMETRY;
        if (!too_far && (singular || search->unconstrained || in_hole || enough)) break;
    }
    return status;
}

/* Restores the starting state as `now`. The iteration may have changed the partition of joints, which is restored
 * too. */
static int32_t end_growing_steps(dmb_static_search *search, int32_t status)
{
    dmb_sim *sim = search->sim;
    dmb_state_restore(sim);
    if (status < 0 || sim->scene->cluster_count == 0) return status;
    status = dmb_static_settle(search);
    return status < 0 ? status : dmb_static_evaluate(search);
}

/* 1: tension in a curved hole with elements too long for Newton from the low side of the hole; < 0: error that ends the
 * analysis. */
static int32_t is_pulled_coarsely(dmb_static_search *search)
{
    dmb_static_pull pull;
    if (!search->options->lay_on_wall || search->options->load_steps > 0) return 0;
    const int32_t found = dmb_static_find_pull(search, &pull);
    return found > 0 ? pull.element > DMB_SHORT_ELEMENT * pull.bending : found;
}

/* Newton in the requested load steps, or in one step by default, and from the soft-string initial guess: before it if
 * elements are long for the tension, else after it. */
static int32_t search_by_newton(dmb_static_search *search)
{
    const uint32_t steps = search->options->load_steps > 0 ? search->options->load_steps : 1;
    const int32_t coarse = is_pulled_coarsely(search);
    int32_t status = coarse > 0 ? dmb_static_from_pull(search) : coarse < 0 ? coarse : DMB_ERR_NO_CONVERGENCE;
    if (may_try_again(status)) status = dmb_static_equal_steps(search, dmb_static_newton, steps);
    if (!may_try_again(status) || status == DMB_ERR_SINGULAR || coarse > 0 || !search->options->lay_on_wall)
        return status;
    const int32_t pulled = dmb_static_from_pull(search);
    return pulled >= 0 || dmb_is_final(pulled) ? pulled : status;
}

/* Growing load steps, then the relaxation, after Newton ended with `status`. A part that is unconstrained in its
 * starting pose may still fall onto the wall; therefore the relaxation follows a singular matrix directly. If it fails
 * too, the part is unconstrained. */
static int32_t search_further(dmb_static_search *search, int32_t status, int32_t *method)
{
    const uint32_t steps = search->options->load_steps > 0 ? search->options->load_steps : 1;
    if (may_try_again(status) && status != DMB_ERR_SINGULAR)
        status = end_growing_steps(search, dmb_static_growing_steps(search));
    if (!may_try_again(status)) return status;
    const uint32_t singular_block = search->block;
    const int singular = status == DMB_ERR_SINGULAR;
    *method = DMB_STATIC_RELAXATION;
    status = relax(search, steps, singular);
    if (status >= 0) return dmb_static_revert(search);
    if (!(singular || search->unconstrained)) return status;
    search->block = singular ? singular_block : search->unconstrained_block;
    return DMB_ERR_SINGULAR;
}

static int has_friction(const dmb_static_search *search)
{
    const dmb_scene *scene = search->sim->scene;
    return scene->site_count > 0 && scene->friction_law.kind != DMB_FRICTION_NONE &&
           (search->steady != NULL || search->evaluation.slipping);
}

/* Equilibrium without friction, followed by growing friction. Friction moves rings around the hole by up to atan(mu);
 * applied at once, it opens and closes contacts of a stiff wall in turn. */
static int32_t search_through_friction(dmb_static_search *search, int32_t *method)
{
    dmb_steady *steady = search->steady;
    const int32_t rolling = search->rolling;
    search->evaluation.frictionless = 1.0;
    search->rolling = 0;
    search->steady = NULL;
    int32_t status = search_further(search, search_by_newton(search), method);
    search->rolling = rolling;
    search->steady = steady;
    if (status >= 0) status = end_growing_steps(search, dmb_static_growing_friction(search));
    search->evaluation.frictionless = 0.0;
    return status;
}

static int32_t search_equilibrium(dmb_static_search *search, int32_t *method)
{
    int32_t status = search_by_newton(search);
    *method = DMB_STATIC_NEWTON;
    if (may_try_again(status) && has_friction(search)) {
        const int32_t through = search_through_friction(search, method);
        if (!may_try_again(through)) return through;
        *method = DMB_STATIC_NEWTON;
    }
    return search_further(search, status, method);
}

/* Checks that the torques about constrained axes sum to 0, if necessary after one more correction: the omitted row adds
 * its rounding. */
static int32_t check_spins(dmb_static_search *search)
{
    int32_t status = dmb_static_check_spins(search);
    if (status != DMB_ERR_SINGULAR) return status;
    status = dmb_static_correct(search);
    return status < 0 ? status : dmb_static_check_spins(search);
}

/* Equilibrium with unconstrained rotations constrained. If their torques do not sum to 0, the string rotates until a
 * spring, stop or caller's force resists it; without one there is no equilibrium. */
static int32_t search_holding_spins(dmb_static_search *search, int32_t *method)
{
    int32_t status = dmb_static_begin(search);
    if (status >= 0) status = dmb_static_find_spins(search);
    if (dmb_is_final(status)) return status;
    if (status < 0) search->spin_count = 0;
    status = search_equilibrium(search, method);
    if (search->spin_count == 0 || dmb_is_final(status)) return status;
    if (status >= 0) status = check_spins(search);
    if (!may_try_again(status) || !dmb_static_may_be_caught(search->sim->scene)) return status;
    search->spin_count = 0;
    search->unbalanced = DMB_NONE;
    dmb_state_restore(search->sim);
    return search_equilibrium(search, method);
}

static double displacement_of(const dmb_sim *sim, uint32_t node)
{
    double d[3];
    dmb_vec3_sub(sim->trial.displacement + 3 * (size_t)node, sim->now.displacement + 3 * (size_t)node, d);
    return dmb_vec3_norm(d);
}

static double largest_displacement(const dmb_sim *sim)
{
    double most = 0.0;
    for (uint32_t i = 0; i < sim->scene->node_count; i++) most = fmax(most, displacement_of(sim, i));
    return most;
}

/* An unconstrained part moves so far that rounding of its poses hides the force on it, which then counts as 0. Relative
 * residuals above this bound are such forces, not rounding of other forces. */
#define DMB_UNBALANCED 1e-3
#define DMB_GONE_FAR 1e3   /* [-] multiples of the scene length or the length scale */
#define DMB_TURNED_FAR 1e4 /* [rad] */

/* 1: a node has moved far beyond the length of the scene, or rotated without bound. */
static int has_gone(const dmb_sim *sim, uint32_t *node)
{
    const double far = DMB_GONE_FAR * fmax(sim->scene->length, sim->scene->length_scale);
    for (*node = 0; *node < sim->scene->node_count; ++*node) {
        if (displacement_of(sim, *node) > far) return 1;
        const uint32_t size = sim->scene->layout.size[*node]; /* rotations: second half of its rows */
        const double *turned = sim->increment + sim->scene->layout.row[*node] + size / 2;
        for (uint32_t c = 0; c < size / 2; c++)
            if (fabs(turned[c]) > DMB_TURNED_FAR) return 1;
    }
    return 0;
}

static int32_t refuse_unconstrained(dmb_static_search *search, int32_t status)
{
    uint32_t node = 0;
    if (status < 0 || search->residual <= DMB_UNBALANCED) return status;
    if (!has_gone(search->sim, &node)) return status;
    search->block = node;
    return DMB_ERR_SINGULAR;
}

static double largest_residual(const dmb_sim *sim)
{
    double most = 0.0;
    for (uint32_t i = 0; i < sim->scene->row_count; i++)
        if (sim->scene->solved_row[i]) most = fmax(most, fabs(sim->residual[i]));
    return most;
}

/* Keeps reactions, drive forces and friction of the static state until the first step: friction of an assumed slip
 * vanishes with the velocities, therefore other forces balance the state at rest. */
static int32_t keep_static_reactions(dmb_static_search *search)
{
    dmb_sim *sim = search->sim;
    const dmb_scene *scene = sim->scene;
    search->evaluation.tangent = 0;
    const int32_t status = dmb_static_evaluate(search);
    if (status < 0) return status;
    if (scene->cluster_count) dmb_joint_reactions(&search->evaluation);
    dmb_contacts_copy_slip(sim);
    dmb_clusters_copy_multipliers(sim);
    dmb_system_get_reactions(sim, &sim->now);
    return DMB_OK;
}

/* Velocities of the state: 0, or those of the steady motion, with the contact history of that motion. */
static int32_t set_motion(dmb_static_search *search)
{
    dmb_sim *sim = search->sim;
    const dmb_scene *scene = sim->scene;
    const int32_t tangent = search->evaluation.tangent;
    int32_t status = DMB_OK;
    if (search->steady == NULL) {
        memset(sim->trial.velocity, 0, scene->row_count * sizeof(double));
    } else {
        search->evaluation.tangent = 0;
        search->evaluation.load_factor = 1.0;
        status = dmb_static_evaluate(search);
        search->evaluation.tangent = tangent;
        if (status >= 0) status = dmb_steady_check_springs(&search->evaluation);
    }
    dmb_contacts_forget(sim);
    dmb_configuration_copy(sim, &sim->trial, &sim->now);
    if (status < 0 || search->steady == NULL) return status;
    return dmb_contacts_slide(sim);
}

/* Sets the rock ahead of the bit: at time 0 as the description defines it, because the forces of the restart require
 * it. Bits that drill keep the rock they have cut. */
static void guess_rock(dmb_static_search *search)
{
    dmb_sim *sim = search->sim;
    for (uint32_t k = 0; k < sim->scene->bit_count; k++) {
        if (sim->clock->time == 0.0) dmb_bit_start(sim, k);
        if (search->steady != NULL && k < DMB_STEADY_BITS && search->evaluation.drilling >> k & 1)
            dmb_bit_start_steady(sim, k);
    }
}

/* Refuses an equilibrium in which a stuck point carries more than its release force or torque. */
static int32_t refuse_torn(const dmb_static_search *search)
{
    dmb_sim *sim = search->sim;
    dmb_message name;
    for (uint32_t i = 0; i < sim->scene->stuck_count; i++) {
        const double share = dmb_stuck_ratio(sim, &sim->trial, i, 0);
        if (!(share > 1.0)) continue;
        dmb_message_set(&sim->message,
                        "static: %s: force or torque = %g times the one at which it is released, must be <= 1; pull "
                        "less, set it free "
                        "(input of DMB_TARGET_STUCK), or run in time over the release",
                        dmb_part_text(&name, "stuck", i, sim->scene->stuck[i].name, sizeof sim->scene->stuck[i].name),
                        share);
        return DMB_ERR_UNSUPPORTED;
    }
    return DMB_OK;
}

/* Accepts the solution as the state. */
static int32_t settle(dmb_static_search *search)
{
    dmb_sim *sim = search->sim;
    dmb_system_unwrap(sim);
    search->slides = dmb_static_note_slide(sim);
    dmb_system_accept(&search->evaluation);
    int32_t status = set_motion(search);
    guess_rock(search);
    const dmb_counters counters = *sim->counters;
    if (status >= 0) status = dmb_system_restart(sim);
    *sim->counters = counters;
    if (status >= 0 && search->evaluation.slipping) status = keep_static_reactions(search);
    if (status < 0) {
        dmb_state_restore(sim);
        return status;
    }
    dmb_forget_factors(sim);
    return DMB_OK;
}

static void tell(const dmb_static_search *search, dmb_static_report *out)
{
    out->iterations = search->iterations;
    out->load_steps = search->load_steps;
    out->residual = search->residual;
    out->largest_force = largest_residual(search->sim);
    out->cuts = search->cuts;
    out->line_searches = search->line_searches;
    out->steady = search->steady != NULL ? search->steady->kind : DMB_STEADY_AT_REST;
    out->lateral_move = largest_displacement(search->sim);
}

/* Stability of the equilibrium, by its true tangent. */
static int32_t judge_stability(dmb_static_search *search, dmb_static_report *out)
{
    dmb_block_weakest weakest;
    dmb_stability found = {0};
    int64_t bad = -1;
    search->evaluation.extrapolated = 0;
    int32_t status = dmb_static_find_spins(search);
    if (status >= 0) status = dmb_static_evaluate(search);
    if (status >= 0) status = dmb_stability_judge(search, 1, &weakest, &bad, &found);
    out->free_spins = (int32_t)search->spin_count;
    search->spin_count = 0;
    out->unresolved = found.unresolved;
    out->resolution = found.bound;
    out->negative = bad >= 0 || (found.negative == 0 && found.unresolved > 0) ? -1 : found.negative;
    out->stiffness = found.stiffness;
    return status;
}

/* The relaxation descends, but from a symmetric start it ends on a saddle, and next to a stiff compressed string the
 * remaining residual is rounding. It restarts from a slightly perturbed unstable state, which it then leaves; the
 * unstable state is reported if no other is found. */
#define DMB_LEAVING_TRIES 3

/* A Newton solution that rotates a part by more than this from its start to an unstable state has missed the intended
 * equilibrium. */
#define DMB_TURNED_TOO_FAR 0.3 /* [rad] */

static int has_turned(const dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0; i < scene->node_count; i++)
        for (uint32_t c = scene->layout.size[i] / 2; c < scene->layout.size[i]; c++)
            if (fabs(sim->increment[scene->layout.row[i] + c]) > DMB_TURNED_TOO_FAR) return 1;
    return 0;
}

/* 1: a perturbed restart is useful. For a non-symmetric stiffness only the eigenvalues nearest 0 are counted, therefore
 * it is always tried. */
static int may_leave(const dmb_static_search *search, const dmb_static_report *out)
{
    if (search->steady != NULL || search->evaluation.slipping) return 0;
    if (out->method != DMB_STATIC_RELAXATION) return out->negative > 0 && has_turned(search->sim);
    return out->negative > 0 || out->stiffness == DMB_STIFFNESS_UNSYMMETRIC;
}

static int32_t leave(dmb_static_search *search, uint32_t number, dmb_static_report *out)
{
    out->method = DMB_STATIC_RELAXATION;
    int32_t status = dmb_static_push_aside(search, number);
    if (status >= 0) status = dmb_static_relaxation(search);
    return status < 0 ? status : judge_stability(search, out);
}

static int32_t leave_unstable(dmb_static_search *search, dmb_static_report *out)
{
    const dmb_static_report found = *out;
    int32_t status = DMB_OK;
    search->caution = 1.0;
    for (uint32_t k = 0; k < DMB_LEAVING_TRIES && status >= 0 && (k == 0 || out->negative > 0); k++) {
        status = leave(search, k, out);
        if (!may_try_again(status)) continue;
        search->caution *= 3.0;
        dmb_state_restore(search->sim);
        *out = found;
        const double caution = search->caution;
        status = search_holding_spins(search, &out->method);
        search->caution = caution;
        if (status >= 0) status = judge_stability(search, out);
    }
    return status;
}

static int32_t find(dmb_static_search *search, dmb_static_report *out)
{
    dmb_sim *sim = search->sim;
    search->winding = sim->scene->site_count > 0;
    search->rolling = search->winding && (search->steady != NULL || search->evaluation.slip[1] != 0.0);
    int32_t status = refuse_unconstrained(search, search_holding_spins(search, &out->method));
    if (status < 0) {
        dmb_static_explain(search, status);
        dmb_state_restore(sim); /* the partition of joints may have changed */
        return status;
    }
    status = judge_stability(search, out);
    if (status >= 0 && may_leave(search, out)) status = leave_unstable(search, out);
    tell(search, out);
    if (status >= 0) status = refuse_torn(search);
    if (status < 0) {
        dmb_state_restore(sim);
        return status;
    }
    return settle(search);
}

/* Solution in the steady state selected by drives and options. */
static int32_t find_state(dmb_static_search *search, dmb_static_report *out)
{
    dmb_sim *sim = search->sim;
    const dmb_static_options *options = search->options;
    dmb_steady steady;
    dmb_state_back_up(sim);
    int32_t chosen = dmb_steady_choose(sim, options->steady, search->evaluation.slipping, &steady);
    dmb_state_restore(sim);
    int32_t status = chosen;
    if (chosen >= 0) {
        search->steady = steady.kind != DMB_STEADY_AT_REST ? &steady : NULL;
        for (uint32_t k = 0; k < sim->scene->bit_count && k < DMB_STEADY_BITS; k++)
            search->evaluation.drilling |= (uint32_t)dmb_bit_on_bottom(sim, k) << k;
        status = find(search, out);
    }
    if (status == DMB_ERR_UNSUPPORTED && options->steady == DMB_STEADY_AUTO && search->steady != NULL) {
        dmb_static_set_up(search, sim, options); /* the motion proved not to be steady */
        status = find(search, out);
        chosen = DMB_NOTE_NOT_STEADY;
    }
    dmb_steady_release(&steady);
    return status == DMB_OK ? chosen : status;
}

static int32_t report_unstable(dmb_sim *sim, const dmb_static_report *out)
{
    dmb_message_set(
        &sim->message,
        "static: the equilibrium is unstable, its %s stiffness has %snegative eigenvalues = %d, 0 of a stable "
        "one; start nearer to the one wanted, push aside for a moment, or damp a run in time until it rests",
        out->stiffness == DMB_STIFFNESS_SYMMETRIC ? "symmetric" : "unsymmetric",
        out->stiffness == DMB_STIFFNESS_SYMMETRIC ? "" : "real ", out->negative);
    return DMB_NOTE_UNSTABLE;
}

static int32_t report_unresolved(dmb_sim *sim, const dmb_static_report *out)
{
    if (out->unresolved > 0)
        dmb_message_set(&sim->message,
                        "static: the stability of the equilibrium is not resolved: %d eigenvalue(s) of the stiffness "
                        "are smaller than its rounding, at most %g N/m; constrain the motion that nothing resists, or "
                        "use fewer elements",
                        out->unresolved, out->resolution);
    else
        dmb_message_set(&sim->message,
                        "static: the stability of the equilibrium is not resolved: the negative eigenvalues of the "
                        "stiffness could not be counted; run in time from a small disturbance");
    return DMB_NOTE_INCOMPLETE;
}

/* Status and message of a solution by its stability. */
static int32_t report_stability(dmb_sim *sim, const dmb_static_report *out)
{
    if (out->steady != DMB_STEADY_AT_REST || out->negative == 0) return DMB_OK;
    return out->negative > 0 ? report_unstable(sim, out) : report_unresolved(sim, out);
}

static int32_t analyse(dmb_sim *sim, const dmb_static_options *options, dmb_static_report *report)
{
    dmb_static_options taken;
    dmb_static_search search;
    dmb_static_report out;
    (void)dmb_static_report_init(&out, (uint32_t)sizeof out);
    if (report != NULL && dmb_static_report_read(&out, report) < 0) return DMB_ERR_STRUCT_SIZE;
    int32_t status = dmb_static_options_get(sim, options, &taken);
    if (status < 0) return status;
    dmb_static_set_up(&search, sim, &taken);
    dmb_static_slip(&search, taken.slip_axial, taken.slip_rotation);
    status = find_state(&search, &out);
    if (status >= 0 && report != NULL) (void)dmb_static_report_write(report, &out);
    if (status == DMB_OK) status = report_stability(sim, &out);
    return status == DMB_OK && search.slides ? DMB_NOTE_INCOMPLETE : status;
}

int32_t dmb_analysis_static(dmb_sim *sim, const dmb_static_options *options, dmb_static_report *report)
{
    const int32_t status = dmb_sim_enter(sim, DMB_BUSY_CHANGING);
    return status < 0 ? status : dmb_sim_leave(sim, analyse(sim, options, report));
}
