/* Nonlinear solution of statics. Methods, tried in the order given in static.c:
 *
 *   dmb_static_newton            full corrections with extrapolated stress; from the 13th iteration on, three of four
 *                                corrections are halved
 *   dmb_static_equal_steps       the method (Newton or relaxation) in equal load steps
 *   dmb_static_growing_steps     Newton in load steps: first 1/4, halved after failure, doubled after at most
 *                                12 iterations; the shortest steps use the line search
 *   dmb_static_growing_friction  the same with the friction of rings in place of the load
 *   dmb_static_relaxation        pseudo-transient continuation with limited corrections
 *
 * Extra steps: dmb_static_push_aside (perturbation of an unstable state), dmb_static_revert (axial position of
 * unconstrained strings), dmb_static_line_search. */
#include <string.h>

#include "analysis/linear/linear.h"
#include "analysis/static/static.h"
#include "math/so3.h"
#include "math/vec3.h"
#include "sim/access.h"
#include "sim/layout.h"
#include "system/assemble/assemble.h"
#include "system/solve/solve.h"

static void scale_correction(dmb_sim *sim, double factor)
{
    for (uint32_t i = 0; i < sim->scene->row_count; i++) sim->correction[i] *= factor;
}

/* Largest correction [m], rotations times the length scale. */
static double largest_move(const dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    double most = 0.0;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        const uint32_t size = scene->layout.size[i], row = scene->layout.row[i];
        for (uint32_t c = 0; c < size; c++)
            most = fmax(most, fabs(sim->correction[row + c]) * (2 * c < size ? 1.0 : scene->length_scale));
    }
    return most;
}

/* A residual at the rounding level is an equilibrium once corrections are below DMB_NO_MOVE [length scales]; next to
 * stiff elements it can hide a soft part that still moves. If a part is so soft that rounding moves it, the iteration
 * ends after DMB_MOVES_ENOUGH corrections at the rounding level. */
#define DMB_NO_MOVE 1e-9
#define DMB_MOVES_ENOUGH 20
/* Corrections may be ten times as large if they are small and converge so fast that the next one, their square over the
 * previous one, is below DMB_NO_MOVE_LEFT. */
#define DMB_NO_MOVE_LEFT 1e-12
#define DMB_SMALL_MOVE 1e-3

static int is_still(const dmb_static_search *search)
{
    const double now = search->moved, before = search->moved_before;
    if (now <= DMB_NO_MOVE) return 1;
    return now <= 10.0 * DMB_NO_MOVE && before <= DMB_SMALL_MOVE && now * now <= DMB_NO_MOVE_LEFT * before;
}

/* 0: in equilibrium, 1: not yet, < 0: failed. Along an unconstrained motion corrections never vanish at the rounding
 * level; therefore the number of iterations there is limited. */
static int32_t judge(dmb_static_search *search)
{
    const dmb_residual_norm norm = dmb_residual_norm_of(&search->evaluation, search->options->tolerance);
    search->residual = norm.relative;
    search->at_rounding = norm.converged ? search->at_rounding + 1 : 0;
    if (norm.converged && search->at_rounding > DMB_MOVES_ENOUGH) return 0;
    if (norm.converged == DMB_CONVERGED || (norm.converged && is_still(search))) return 0;
    return 1;
}

static int32_t evaluate(dmb_static_search *search)
{
    const int32_t status = dmb_static_evaluate(search);
    return status < 0 ? status : judge(search);
}

/* Records the block with the weakest pivot (unconstrained part) for the message, from the factors. */
static int32_t look_at_factors(dmb_static_search *search, int64_t bad, const dmb_block_weakest *weakest)
{
    if (search->iterations == 0 && weakest->ratio < DMB_UNCONSTRAINED_PIVOT) {
        search->unconstrained = 1;
        search->unconstrained_block = weakest->block;
    }
    search->block = (uint32_t)bad;
    return bad >= 0 ? DMB_ERR_SINGULAR : DMB_OK;
}

static int32_t solve(dmb_static_search *search)
{
    if (search->winding) dmb_static_fix_axes(search->sim);
    dmb_system_iteration_matrix(&search->evaluation);
    dmb_block_weakest weakest;
    const int64_t bad = dmb_factor_stiffness(search->sim, &weakest);
    const int32_t status = look_at_factors(search, bad, &weakest);
    if (status < 0) return status;
    dmb_solve_correction(search->sim);
    dmb_static_correct_spins(search);
    search->iterations++;
    return DMB_OK;
}

/* Factor of a correction. If nodes open and close wall contacts in turn, halved corrections break the cycle. */
static double damping(uint32_t iteration)
{
    if (iteration < 12) return 1.0;
    return iteration % 4 == 3 ? 1.0 : 0.5;
}

static int32_t correct(dmb_static_search *search, uint32_t iteration)
{
    dmb_sim *sim = search->sim;
    int32_t status = solve(search);
    if (status < 0) return status;
    search->moved_before = search->moved;
    search->moved = iteration + 1 < DMB_MOVES_ENOUGH ? largest_move(sim) / sim->scene->length_scale : 0.0;
    scale_correction(sim, damping(iteration));
    const double work = dmb_static_work(search, sim->correction, 0.0);
    dmb_system_extrapolate_stress(sim, sim->correction);
    search->evaluation.extrapolated = 1;
    status = dmb_static_move(search, sim->correction, 1.0);
    if (status >= 0) status = dmb_static_evaluate(search);
    if (status >= 0 && search->searching) status = dmb_static_line_search(search, sim->correction, work);
    return status;
}

int32_t dmb_static_newton(dmb_static_search *search)
{
    search->evaluation.extrapolated = 0;
    search->moved = search->moved_before = (double)INFINITY;
    search->at_rounding = 0;
    int32_t status = dmb_static_evaluate(search);
    for (uint32_t k = 0; status >= 0; k++) {
        status = judge(search);
        if (status <= 0) return status;
        if (k >= search->options->max_iterations) return DMB_ERR_NO_CONVERGENCE;
        status = correct(search, k);
    }
    return status;
}

int32_t dmb_static_correct(dmb_static_search *search)
{
    search->evaluation.extrapolated = 0;
    const int32_t status = dmb_static_evaluate(search);
    return status < 0 ? status : correct(search, 0);
}

/* Adds the pseudo mass of each row over tau^2: the mean node mass; for rotations the inertia of a rod of the length
 * scale. */
static void add_pseudo_mass(dmb_sim *sim, double rate)
{
    const dmb_scene *scene = sim->scene;
    const double mean = scene->mass / scene->node_count;
    const double arm = scene->length_scale * scene->length_scale / 12.0;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        const uint32_t size = scene->layout.size[i];
        for (uint32_t c = 0; c < size; c++)
            if (scene->solved_row[scene->layout.row[i] + c])
                dmb_stiffness_of(sim, i)[(size + 1) * c] += rate * mean * (2 * c < size ? 1.0 : arm);
    }
}

/* Far from equilibrium a large rotation leaves elements compressed, and an inverted pendulum is unstable anyway: K +
 * D/tau^2 is then indefinite, and its correction leads uphill or, near a singularity, in an arbitrary direction. Pseudo
 * mass is added for this correction alone until no eigenvalue is negative; the next correction begins with at most
 * DMB_HEAVIER_KEPT times the rate. */
#define DMB_HEAVIER 4.0
#define DMB_HEAVIER_TRIES 12
#define DMB_HEAVIER_KEPT 2.0

/* `rate` [1/s^2]: in: first value; out: first value of the next correction. */
static int32_t solve_downhill(dmb_static_search *search, double *rate)
{
    dmb_block_weakest weakest;
    double taken = *rate;
    int32_t negative = 1;
    int singular = 0;
    for (int k = 0; k < DMB_HEAVIER_TRIES; k++, taken *= DMB_HEAVIER) {
        int32_t status = k > 0 ? dmb_static_evaluate(search) : DMB_OK; /* the factors have overwritten the matrix */
        if (status < 0) return status;
        add_pseudo_mass(search->sim, taken);
        dmb_system_iteration_matrix(&search->evaluation);
        status = look_at_factors(search, dmb_stiffness_factor(search->sim, &weakest, &negative), &weakest);
        singular = status == DMB_ERR_SINGULAR;
        if (status < 0 && !singular) return status;
        if (negative == 0 && !singular) break;
    }
    if (singular) return DMB_ERR_SINGULAR;
    dmb_solve_correction(search->sim);
    dmb_static_correct_spins(search);
    search->iterations++;
    *rate = fmin(taken, DMB_HEAVIER_KEPT * *rate);
    return DMB_OK;
}

/* [m] largest correction of a node towards the wall: half the smallest clearance; infinite without a wall. */
static double longest_move(const dmb_scene *scene)
{
    double limit = (double)INFINITY;
    for (uint32_t s = 0; s < scene->site_count; s++)
        if (scene->sites[s].clearance > 0.0) limit = fmin(limit, 0.5 * scene->sites[s].clearance);
    return limit;
}

/* [-] largest correction along the hole, where the wall distance is constant, in length scales */
#define DMB_LONGEST_SLIDE 0.2
/* [rad] Largest rotation per correction. An unconstrained hanging part moves far before equilibrium, but its sections
 * only rotate. */
#define DMB_LONGEST_TURN 0.3

/* Largest components of a correction. */
typedef struct correction_size {
    double along, across; /* [m] in the axes of the nodes; all motion of axial-torsional nodes is along */
    double turn;          /* [rad] */
    double bend; /* [rad] across the axes of chains in wall contact, which moves their nodes towards the wall */
} correction_size;

static void add_chain(const dmb_sim *sim, const dmb_chain *chain, int meets_wall, correction_size *size)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = chain->first; i < chain->first + chain->count; i++) {
        const double *z = sim->correction + scene->layout.row[i];
        if (meets_wall) size->along = fmax(size->along, fabs(z[0]));
        if (scene->layout.size[i] != DMB_NODE_SIX_DOF) continue;
        const double bend = fmax(fabs(z[4]), fabs(z[5]));
        size->turn = fmax(size->turn, fmax(fabs(z[3]), bend));
        if (!meets_wall) continue;
        size->across = fmax(size->across, fmax(fabs(z[1]), fabs(z[2])));
        size->bend = fmax(size->bend, bend);
    }
}

/* Of chains without a ring only rotations count: no wall limits their displacements. */
static correction_size size_of_correction(const dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    const uint32_t sites = dmb_node_sites(scene); /* in the order of their nodes */
    correction_size size = {0.0, 0.0, 0.0, 0.0};
    for (uint32_t c = 0, s = 0; c < scene->chain_count; c++) {
        const dmb_chain *chain = scene->chains + c;
        while (s < sites && scene->sites[s].node < chain->first) s++;
        add_chain(sim, chain, s < sites && scene->sites[s].node < chain->first + chain->count, &size);
    }
    return size;
}

/* [-] The two ends of a joint follow different screws and separate by half the product of displacement and rotation,
 * which the adjacent elements must compensate: largest separation, as a fraction of the length scale. */
#define DMB_LONGEST_GAP 0.15

/* [-] largest component of the correction over its limit */
static double reach(const dmb_static_search *search, double limit)
{
    const dmb_scene *scene = search->sim->scene;
    const correction_size size = size_of_correction(search->sim);
    const double apart = scene->cluster_count ? sqrt(0.5 * search->moved * size.turn / DMB_LONGEST_GAP) : 0.0;
    const double turn = fmax(size.turn / DMB_LONGEST_TURN, apart);
    if (!isfinite(limit)) return search->caution * turn;
    const double across = fmax(size.across, size.bend * scene->length_scale) / limit;
    const double along = size.along / (DMB_LONGEST_SLIDE * scene->length_scale);
    return search->caution * fmax(turn, fmax(across, along));
}

/* Work of the residual along the last correction at its end over the work at its start: -1 to 0 if the correction
 * descended all the way. Below DOWNHILL the pseudo time step grows, beyond OVERSHOT it shrinks. */
#define DMB_DOWNHILL 0.2
#define DMB_OVERSHOT 0.8
#define DMB_OVERSHOT_FAR 2.0

/* Ratio of the next rate 1/tau^2 to the last one: the ratio of residuals (switched evolution relaxation), limited to
 * 0.1 .. 0.3, because residual ratios mean little while parts still travel. */
static double change_of_rate(double work_ratio, double residual_ratio)
{
    if (work_ratio > DMB_OVERSHOT_FAR) return 8.0;
    if (work_ratio > DMB_OVERSHOT) return 3.0;
    return work_ratio < DMB_DOWNHILL ? fmin(fmax(residual_ratio, 0.1), 0.3) : 1.0;
}

int32_t dmb_static_relaxation(dmb_static_search *search)
{
    dmb_sim *sim = search->sim;
    const double limit = longest_move(sim->scene);
    double rate = 1e4, last = 1.0, work = 0.0;
    search->evaluation.extrapolated = 0;
    search->moved = search->moved_before = (double)INFINITY;
    search->at_rounding = 0;
    for (uint32_t k = 0;; k++) {
        int32_t status = evaluate(search);
        if (status <= 0) return status;
        if (k >= 20 * search->options->max_iterations) return DMB_ERR_NO_CONVERGENCE;
        if (k > 0)
            rate *= change_of_rate(dmb_static_work(search, sim->correction, 1.0) / fabs(work), search->residual / last);
        last = search->residual;
        status = solve_downhill(search, &rate);
        if (status < 0) return status;
        search->moved_before = search->moved;
        search->moved = largest_move(sim) / sim->scene->length_scale;
        const double part = reach(search, limit);
        if (part > 1.0) scale_correction(sim, 1.0 / part);
        work = dmb_static_work(search, sim->correction, 0.0);
        dmb_system_extrapolate_stress(sim, sim->correction);
        search->evaluation.extrapolated = 1;
        status = dmb_static_move(search, sim->correction, 1.0);
        if (status < 0) return status;
    }
}

/* [-] length scales and [rad] of a random perturbation */
#define DMB_PUSH 1e-3

int32_t dmb_static_push_aside(dmb_static_search *search, uint32_t number)
{
    dmb_sim *sim = search->sim;
    const dmb_scene *scene = sim->scene;
    uint64_t seed = UINT64_C(0x9E3779B97F4A7C15) * (number + 1);
    for (uint32_t i = 0; i < scene->node_count; i++)
        for (uint32_t c = 0; c < scene->layout.size[i]; c++) {
            const uint32_t row = scene->layout.row[i] + c;
            seed = seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
            const double random = (double)(seed >> 11) * 0x1p-52 - 1.0;
            const double size = DMB_PUSH * (2 * c < scene->layout.size[i] ? scene->length_scale : 1.0);
            sim->correction[row] = scene->solved_row[row] ? random * size : 0.0;
        }
    return dmb_static_move(search, sim->correction, 1.0);
}

/* ---- Along a straight hole ------------------------------------------------------------------------------------------
 * Only pseudo mass constrains a string there, and corrections far from equilibrium leave it slightly displaced. Every
 * axial position is an equilibrium, so the string returns to the initial position of its rig end if that is an
 * equilibrium too. */

/* Correction that returns a chain along the axis of its first node, in sim->correction; result: its length [m]. */
static double way_back(dmb_sim *sim, const dmb_chain *chain)
{
    const dmb_scene *scene = sim->scene;
    const double *u = sim->trial.displacement + 3 * (size_t)chain->first;
    const double along[3] = {1.0, 0.0, 0.0};
    double axis[3], moved[3], z[3];
    memset(sim->correction, 0, scene->row_count * sizeof(double));
    if (scene->layout.size[chain->first] != DMB_NODE_SIX_DOF) return 0.0;
    dmb_quat_rotate(sim->trial.quaternion + 4 * (size_t)chain->first, along, axis);
    dmb_vec3_sub(u, sim->now.displacement + 3 * (size_t)chain->first, moved);
    const double way = dmb_vec3_dot(moved, axis);
    for (uint32_t i = chain->first; i < chain->first + chain->count; i++) {
        if (scene->layout.size[i] != DMB_NODE_SIX_DOF) return 0.0;
        dmb_quat_rotate_inverse(sim->trial.quaternion + 4 * (size_t)i, axis, z);
        for (uint32_t c = 0; c < 3; c++)
            if (scene->solved_row[scene->layout.row[i] + c]) sim->correction[scene->layout.row[i] + c] = -way * z[c];
    }
    return fabs(way);
}

static int32_t evaluate_again(dmb_static_search *search, double *relative)
{
    search->evaluation.extrapolated = 0;
    const int32_t status = dmb_static_evaluate(search);
    *relative = dmb_residual_norm_of(&search->evaluation, search->options->tolerance).relative;
    return status;
}

static int32_t revert(dmb_static_search *search, const dmb_chain *chain)
{
    double before, after;
    int32_t status = evaluate_again(search, &before);
    if (status < 0 || !(way_back(search->sim, chain) > 0.0)) return status;
    status = dmb_static_move(search, search->sim->correction, 1.0);
    if (status >= 0) status = evaluate_again(search, &after);
    if (status < 0 || after <= fmax(search->options->tolerance, 2.0 * before)) return status;
    dmb_static_move_back(search, search->sim->correction, 1.0);
    return evaluate_again(search, &after);
}

int32_t dmb_static_revert(dmb_static_search *search)
{
    const dmb_scene *scene = search->sim->scene;
    int32_t status = DMB_OK;
    if (!search->winding || scene->cluster_count) return DMB_OK;
    for (uint32_t c = 0; c < scene->chain_count && status >= 0; c++) status = revert(search, scene->chains + c);
    return status;
}

/* ---- Load steps -------------------------------------------------------------------------------------------------- */

/* Load steps of statics: the whole load at once if that converges, otherwise steps that are halved after a failure of
 * Newton and doubled after easy convergence. */

/* Shortest load step, which uses the line search: with the extrapolated stress Newton overshoots in its first iteration
 * and usually converges faster for it. If the first step fails, shorter ones rarely help. A step of at most
 * DMB_EASY_ITERATIONS iterations doubles the next one. */
#define DMB_SHORTEST_LOAD_STEP (1.0 / 64.0)
#define DMB_SHORTEST_FIRST_STEP (1.0 / 16.0)
#define DMB_EASY_ITERATIONS 12

/* Stores the trial and its increments as the step reached, and restores them. pseudo_acceleration stores the
 * increments: statics require no accelerations, and the restart computes them from the equilibrium. */
static void keep(dmb_sim *sim)
{
    dmb_configuration_copy(sim, &sim->trial, &sim->now);
    memcpy(sim->now.pseudo_acceleration, sim->increment, sim->scene->row_count * sizeof(double));
}

static void go_back(dmb_sim *sim)
{
    dmb_configuration_copy(sim, &sim->now, &sim->trial);
    memcpy(sim->increment, sim->now.pseudo_acceleration, sim->scene->row_count * sizeof(double));
}

int32_t dmb_static_equal_steps(dmb_static_search *search, dmb_static_method method, uint32_t steps)
{
    int32_t status = dmb_static_begin(search);
    search->load_steps = steps;
    for (uint32_t k = 1; k <= steps && status >= 0; k++) {
        dmb_progress_at(search->sim, (k - 1.0) / steps);
        search->evaluation.load_factor = (double)k / steps;
        status = method(search);
    }
    return status;
}

/* Sets the fraction, 0 to 1, of the loads, or of the friction of rings that are assumed to slip. */
typedef void (*set_part)(dmb_static_search *search, double part);

static void set_load(dmb_static_search *search, double part)
{
    search->evaluation.load_factor = part;
}

static void set_friction(dmb_static_search *search, double part)
{
    search->evaluation.frictionless = 1.0 - part;
}

/* One load step from `reached`; a failure restores the state and halves the step. DMB_OK, or the reason if no shorter
 * step is left. */
static int32_t step(dmb_static_search *search, set_part set, double *reached, double *length)
{
    const uint32_t before = search->iterations;
    const double target = fmin(1.0, *reached + *length);
    const double shortest = *reached > 0.0 ? DMB_SHORTEST_LOAD_STEP : DMB_SHORTEST_FIRST_STEP;
    search->searching = *length <= shortest;
    set(search, target);
    dmb_progress_at(search->sim, *reached);
    const int32_t status = dmb_static_newton(search);
    if (status >= 0) {
        *reached = target;
        search->load_steps++;
        if (search->iterations - before <= DMB_EASY_ITERATIONS) *length *= 2.0;
        if (target < 1.0) keep(search->sim);
        return DMB_OK;
    }
    *length *= 0.5;
    search->cuts++;
    go_back(search->sim);
    return dmb_is_final(status) || *length < shortest ? status : DMB_OK;
}

static int32_t grow(dmb_static_search *search, set_part set)
{
    double reached = 0.0, length = 0.25;
    int32_t status = DMB_OK;
    search->load_steps = 0;
    keep(search->sim);
    while (status >= 0 && reached < 1.0) status = step(search, set, &reached, &length);
    search->searching = 0;
    return status;
}

int32_t dmb_static_growing_steps(dmb_static_search *search)
{
    const int32_t status = dmb_static_begin(search);
    return status < 0 ? status : grow(search, set_load);
}

int32_t dmb_static_growing_friction(dmb_static_search *search)
{
    const int32_t status = grow(search, set_friction);
    search->evaluation.frictionless = 0.0;
    return status;
}

/* ---- Line search ------------------------------------------------------------------------------------------------- */

/* Largest fraction of the initial work that may remain after a correction, and shortest fraction of the correction. */
#define DMB_WORK_LEFT 0.8
#define DMB_SHORTEST_MOVE 0.1
#define DMB_SEARCHES 4

/* Regula falsi on the work g(s) of the residual along the move (eq:static.line-search). */
int32_t dmb_static_line_search(dmb_static_search *search, const double *direction, double before)
{
    double low = 0.0, high = 1.0, at_low = before, at_high = dmb_static_work(search, direction, 1.0), s = 1.0;
    if (!(before < 0.0) || !(fabs(at_high) > DMB_WORK_LEFT * fabs(before))) return DMB_OK;
    search->line_searches++;
    for (int k = 0; k < DMB_SEARCHES; k++) {
        const double guess = at_high > 0.0 ? low + (high - low) * at_low / (at_low - at_high) : 0.5 * s;
        const double next = fmax(guess, DMB_SHORTEST_MOVE);
        if (next >= s && at_high <= 0.0) return DMB_OK;
        dmb_static_move_back(search, direction, s);
        int32_t status = dmb_static_move(search, direction, next);
        if (status < 0) return status;
        s = next;
        search->evaluation.extrapolated = 0;
        status = dmb_static_evaluate(search);
        if (status < 0) return status;
        const double work = dmb_static_work(search, direction, s);
        if (fabs(work) <= DMB_WORK_LEFT * fabs(before) || s <= DMB_SHORTEST_MOVE) return DMB_OK;
        if (work > 0.0) {
            high = s;
            at_high = work;
        } else {
            low = s;
            at_low = work;
        }
    }
    return DMB_OK;
}
