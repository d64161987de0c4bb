/* A trial step and its fallbacks (diagram of the stages: integrator/trial_step.h).
 *
 *     stage          prediction                         factors
 *     ------------   --------------------------------   -----------------------------------------
 *     FIRST          linear if permitted, else constant reused ones if they fit, else its own
 *     CONSTANT       constant                           the same
 *     OWN,           constant                           its own
 *     CONSTANT_OWN
 *
 *     each stage: predict -> Newton -> contacts open? -> repeat without their force (at most 4 times)
 *
 * The release (eq:contact.release) follows each successful Newton iteration: contacts that open, and mean forces by
 * which the step gains energy (eq:contact.gain), leave the history of the step, which is repeated from the increments
 * found. Final checks, each of which fails the step: an equation dropped as redundant is violated, a joint is near its
 * gimbal singularity, the mass matrix for the accelerations after mean forces is singular, an element has rotated too
 * far. A failed step is divided by the caller (integrator/step). */
#include "integrator/trial_step.h"

#include <string.h>

#include "integrator/newton.h"
#include "integrator/prediction.h"
#include "integrator/step_motion.h"
#include "math/so3.h"
#include "sim/chunks.h"
#include "sim/node.h"
#include "system/assemble/assemble.h"
#include "system/assemble/bounces.h"
#include "system/assemble/caller_force.h"
#include "system/assemble/drives.h"
#include "system/assemble/ledger.h"
#include "system/constrain/constrain.h"
#include "system/constrain/rotor.h"
#include "system/system.h"

/* [-] Violation, over the length of the parts, at which an equation dropped as redundant has become independent. */
#define DMB_DROPPED_VIOLATION 1e-7

/* [m, rad] Tolerance of row k of a node with `size` rows: the first half are translations (u of six, the speed along
 * the hole of two), the second half rotations. */
static double tolerance_of(const dmb_sim *sim, uint32_t size, uint32_t k)
{
    return 2 * k < size ? sim->options.tolerance_translation : sim->options.tolerance_rotation;
}

/* Largest of all rows over their tolerances: |a1 - a0| [1/s2], acceleration, speed. */
typedef struct motion_norms {
    double jump, acceleration, speed;
} motion_norms;

static void add_row(motion_norms *most, double tolerance, double jump, double acceleration, double speed)
{
    most->jump = fmax(most->jump, fabs(jump) / tolerance);
    most->acceleration = fmax(most->acceleration, fabs(acceleration) / tolerance);
    most->speed = fmax(most->speed, fabs(speed) / tolerance);
}

/* Adds the rows of a free rigid body, at its centre of mass. */
static void add_rigid(const dmb_sim *sim, double ratio, uint32_t rigid, motion_norms *most)
{
    const double *motion = dmb_free_rigid_motion(sim, rigid);
    double start[18];
    dmb_free_rigid_start(sim, rigid, start);
    for (uint32_t k = 0; k < 6; k++) {
        const double a0 = start[6 + k] + ratio * (start[12 + k] - start[6 + k]);
        add_row(most, tolerance_of(sim, 6, k), motion[12 + k] - a0, motion[6 + k], motion[k]);
    }
}

/* Adds the rows of a rotor, in axes that do not spin with it. */
static void add_rotor(const dmb_sim *sim, double ratio, uint32_t rotor, motion_norms *most)
{
    const dmb_rotor_step *step = sim->rotor_step + rotor;
    const uint32_t row = sim->scene->layout.row[sim->scene->rotors[rotor].node];
    const double *start = step->start, *v = sim->trial.velocity + row;
    double acceleration[6], pseudo[6];
    dmb_vec6_copy(sim->trial.acceleration + row, acceleration);
    dmb_vec6_copy(sim->trial.pseudo_acceleration + row, pseudo);
    dmb_rotor_enter(sim, rotor, v, acceleration);
    dmb_rotor_enter(sim, rotor, v, pseudo);
    for (uint32_t k = 0; k < 6; k++) {
        const double a0 = start[6 + k] + ratio * (start[12 + k] - start[6 + k]);
        add_row(most, tolerance_of(sim, 6, k), pseudo[k] - a0, acceleration[k], v[k] - step->spin[k]);
    }
}

static void add_node(const dmb_sim *sim, double ratio, uint32_t node, motion_norms *most)
{
    const uint32_t rotor = dmb_rotor_on(sim->scene, node);
    if (rotor != DMB_NONE) {
        add_rotor(sim, ratio, rotor, most);
        return;
    }
    const uint32_t size = sim->scene->layout.size[node], row = sim->scene->layout.row[node];
    for (uint32_t k = 0; k < size; k++) {
        const uint32_t i = row + k;
        if (!sim->scene->solved_row[i]) continue;
        const double jump = sim->trial.pseudo_acceleration[i] - dmb_step_motion_carried(sim, ratio, i);
        add_row(most, tolerance_of(sim, size, k), jump, sim->trial.acceleration[i], sim->trial.velocity[i]);
    }
}

/* a0 in the difference a1 - a0 is the one that the step began with, carried to its length (eq:integration.carry). */
static motion_norms norms_of(const dmb_sim *sim, double h)
{
    const dmb_scene *scene = sim->scene;
    const double ratio = dmb_step_motion_ratio(sim, h);
    motion_norms most = {0.0, 0.0, 0.0};
    for (uint32_t i = 0, rigid = 0; i < scene->node_count; i++)
        if (rigid < scene->free_rigid_count && scene->free_rigids[rigid].node == i)
            add_rigid(sim, ratio, rigid++, &most);
        else
            add_node(sim, ratio, i, &most);
    return most;
}

/* [-] Largest ratio of the error ahead to the present error: below it, the error of Newton and rounding define no
 * frequency. */
#define DMB_AHEAD_MAX 64.0

/* Local error (eq:integration.local-error), and its largest value within a quarter of a period
 * (eq:integration.error-ahead). If steps do not resolve the motion, h w > 1, the change of the acceleration is bounded
 * by the acceleration itself. */
dmb_step_error dmb_trial_step_error(const dmb_sim *sim, double h)
{
    const dmb_generalized_alpha c = dmb_generalized_alpha_of(sim->options.spectral_radius);
    const motion_norms most = norms_of(sim, h);
    const double squared = most.speed > 0.0 ? fmin(1.0, h * most.jump / most.speed) : 0.0; /* (h w)^2 */
    const double ahead = fmin(sqrt(squared) * most.acceleration, DMB_AHEAD_MAX * most.jump);
    const double factor = fabs(c.error) * h * h;
    const dmb_step_error error = {factor * most.jump, factor * fmax(most.jump, ahead)};
    return error;
}

void dmb_trial_step_set_up(dmb_sim *sim, const dmb_step_end *end, dmb_evaluation *evaluation)
{
    const dmb_generalized_alpha c = dmb_generalized_alpha_of(sim->options.spectral_radius);
    const double h = end->step;
    memset(evaluation, 0, sizeof *evaluation);
    evaluation->sim = sim;
    evaluation->time = end->time;
    evaluation->step = h;
    evaluation->breakpoint = end->breakpoint;
    evaluation->inside = end->inside;
    evaluation->mass_factor = (1.0 - c.am) / (h * h * c.beta * (1.0 - c.af));
    evaluation->velocity_factor = c.gamma / (h * c.beta);
    evaluation->pseudo_factor = (1.0 - c.af) / (1.0 - c.am);
    evaluation->own_factor = (1.0 - c.am) / (c.gamma * (1.0 - c.af));
    evaluation->load_factor = 1.0;
    evaluation->dynamic = 1;
    evaluation->tangent = 1;
    evaluation->given = sim->options.constraint_method == DMB_METHOD_MULTIPLIERS;
}

/* Repeats the step from the increments found so far with the effect of opening contacts removed from its history: v0'
 * and a0 less M^-1 times their forces, and a0 - v0' = 0 at their nodes from then on, because it would oscillate in free
 * flight (eq:contact.release). Newton starts from the increments of the step with the contact: they are closer to the
 * solution than the prediction. The companion stores them, because it repeats both iterations (integrator/companion).
 */
static int32_t step_released(dmb_sim *sim, const dmb_generalized_alpha *c, dmb_trial_step *trial_step)
{
    if (sim->follower != NULL) sim->follower->open(sim->follower->context);
    int32_t status = dmb_released_acceleration(&trial_step->evaluation, sim->correction, sim->released_part);
    if (status < 0) return status;
    dmb_trial_step_refit(sim, c, trial_step->end.step);
    dmb_free_rigids_place(sim);
    dmb_trial_step_set_up(sim, &trial_step->end, &trial_step->evaluation);
    trial_step->released = 1;
    return dmb_newton(sim, c, trial_step);
}

/* An equation dropped as redundant must be satisfied by the others; if it is violated, the constraints have become
 * singular. */
static int32_t check_dropped(dmb_sim *sim)
{
    uint32_t row;
    const double violation = dmb_clusters_violation(sim, 1, &row);
    if (!(violation > DMB_DROPPED_VIOLATION * sim->reduced_mode->length)) return DMB_OK;
    sim->reduced_mode->row = row;
    sim->reduced_mode->violation = fabs(sim->constraint_value[row]);
    return DMB_ERR_SINGULAR;
}

/* Internal status: contacts close or open in a step with linear prediction. Such a step may have more than one
 * solution; the one reached from the constant prediction is used. */
enum { DMB_CHANGES = 1000 };

/* Largest number of repetitions without opening forces, each of which may open further contacts. */
enum { DMB_RELEASES_MAX = 4 };

/* [-] Energy gained over the energy exchanged with the wall (eq:contact.gain): above the first, the step is repeated
 * with the mean forces in its history; above the second, it is divided if no iteration is left for that. */
#define DMB_GAIN_CARRIED 0.002
#define DMB_GAIN_DIVIDED 0.1

/* Checks the energy gained at the wall. 1: the step is to be repeated with mean forces in its history, < 0: divided. */
static int32_t carry(dmb_sim *sim, const dmb_trial_step *trial_step)
{
    const double gain = dmb_bounces_gain(&trial_step->evaluation);
    if (trial_step->iterations >= sim->options.max_iterations)
        return gain > DMB_GAIN_DIVIDED && !sim->options.bounded_work ? DMB_ERR_NO_CONVERGENCE : 0;
    if (!(gain > DMB_GAIN_CARRIED)) return 0;
    dmb_bounces_carry(sim);
    return 1;
}

/* Repeats the step without the forces of contacts that open, and again for those that open by that. Repetitions end
 * with the fourth even if a further contact opens in it; its force is then left to the scheme. */
static int32_t release(dmb_sim *sim, const dmb_generalized_alpha *c, dmb_trial_step *trial_step)
{
    int32_t status = DMB_OK, opens = dmb_contact_opens(sim);
    opens |= dmb_bounces_open(sim, dmb_step_end_asked(&trial_step->end));
    const int32_t carries = carry(sim, trial_step);
    if (carries < 0) return carries;
    opens |= carries;
    for (int k = 0; k < DMB_RELEASES_MAX && opens && status == DMB_OK; k++) {
        status = step_released(sim, c, trial_step);
        opens = dmb_bounces_open(sim, dmb_step_end_asked(&trial_step->end));
    }
    return status;
}

/* Stages of one solve: prescribe, predict, Newton, release. DMB_CHANGES: to be repeated with constant prediction. */
static int32_t solve_step(dmb_sim *sim, const dmb_generalized_alpha *c, dmb_trial_step *trial_step)
{
    dmb_trial_step_set_up(sim, &trial_step->end, &trial_step->evaluation);
    trial_step->released = 0;
    trial_step->over = DMB_NONE;
    dmb_bounces_begin(sim, dmb_step_end_asked(&trial_step->end));
    dmb_prediction_make(sim, c, trial_step);
    int32_t status = dmb_system_prescribe(&trial_step->evaluation);
    if (status < 0) return status;
    if (sim->scene->cluster_count) dmb_step_motion_keep_prescribed(sim);
    dmb_step_motion_place(sim);
    status = dmb_newton(sim, c, trial_step);
    if (status >= 0 && trial_step->linear && dmb_contact_changes(sim)) return DMB_CHANGES;
    if (status == DMB_OK) status = release(sim, c, trial_step);
    if (status == DMB_OK) trial_step->over = dmb_bounces_overturn(sim, trial_step->end.step);
    return trial_step->over != DMB_NONE ? DMB_ERR_NO_CONVERGENCE : status;
}

static int32_t run_stage(dmb_sim *sim, const dmb_generalized_alpha *c, int32_t stage, dmb_trial_step *trial_step)
{
    trial_step->stage = stage;
    trial_step->iterations = 0;
    return solve_step(sim, c, trial_step);
}

/* The stages of a trial step in the order of their diagram (integrator/trial_step.h). */
static int32_t run_stages(dmb_sim *sim, const dmb_generalized_alpha *c, dmb_trial_step *trial_step)
{
    int32_t status = run_stage(sim, c, DMB_STAGE_FIRST, trial_step);
    if (status == DMB_CHANGES) status = run_stage(sim, c, DMB_STAGE_CONSTANT, trial_step);
    if (status >= 0 || dmb_is_final(status) || !(trial_step->tried || trial_step->linear)) return status;
    const int32_t own = trial_step->stage == DMB_STAGE_FIRST ? DMB_STAGE_OWN : DMB_STAGE_CONSTANT_OWN;
    return run_stage(sim, c, own, trial_step);
}

/* The stages, then the final checks of the head comment in its order. Factors are kept only from a step that is the
 * whole call (`sole`) and has no joints: after a later failure of the call they would belong to a state that does not
 * exist. Revolutions are counted at last, from the increments of the step (dmb_system_unwrap), which a failed element
 * check makes meaningless. */
static int32_t try_step(dmb_sim *sim, const dmb_step_end *end, int32_t sole, dmb_trial_step *trial_step)
{
    const dmb_generalized_alpha c = dmb_generalized_alpha_of(sim->options.spectral_radius);
    int32_t status;
    memset(trial_step, 0, sizeof *trial_step);
    trial_step->end = *end;
    if (sole && sim->scene->cluster_count == 0 && !sim->options.bounded_work) trial_step->keep = DMB_KEEP_AT_COMMIT;
    trial_step->block = DMB_NONE;
    sim->reduced_mode->row = DMB_NONE;
    status = run_stages(sim, &c, trial_step);
    if (status >= 0 && sim->scene->cluster_count && check_dropped(sim) < 0) status = DMB_ERR_SINGULAR;
    if (status >= 0 && sim->scene->joint_count) {
        const int32_t refused = dmb_joints_refuse_gimbal_singularity(sim, 1, trial_step->evaluation.time);
        if (refused < 0) status = refused;
    }
    if (status >= 0) {
        const int32_t refused = dmb_bounces_end(&trial_step->evaluation, &trial_step->bounced);
        if (trial_step->bounced) trial_step->keep = DMB_KEEP_NOTHING;
        if (refused < 0) status = refused;
    }
    *sim->factors = DMB_FACTORS_NONE;
    if (status >= 0) {
        trial_step->evaluation.element = dmb_element_turned_too_far(sim);
        if (trial_step->evaluation.element != DMB_NONE) status = DMB_ERR_ROTATION;
        dmb_system_unwrap(sim);
        dmb_rotors_unwrap(sim);
    }
    trial_step->status = status == DMB_NOTE_WORK_LIMITED ? status : status < 0 ? status : DMB_OK;
    return trial_step->status;
}

/* Runs the step with the caller's threads; their failure fails the step, whatever its result. */
int32_t dmb_trial_step_run(dmb_sim *sim, const dmb_step_end *end, int32_t sole, dmb_trial_step *trial_step)
{
    dmb_chunks_open(sim);
    const int32_t status = try_step(sim, end, sole, trial_step), failed = dmb_chunks_close(sim);
    if (failed < 0) trial_step->status = failed;
    return failed < 0 ? failed : status;
}

/* ---- Step to the release of a stuck place -------------------------------------------------------------------------
 */

#define DMB_RELEASE_TOLERANCE 1e-11 /* [-] excess of the force over the release force */
enum { DMB_RELEASE_TRIALS = 60 };

/* [-] Force over its release force, less 1; the largest of all stuck places. */
static double beyond(const dmb_sim *sim, const dmb_configuration *configuration)
{
    return dmb_stuck_largest_ratio(sim, configuration, 1) - 1.0;
}

/* Regula falsi with halved ends (Illinois; Dowell, Jarratt 1971) for the length of the step at which the largest force
 * equals its release force. Each evaluation is a trial step, so that the result does not depend on interpolation.
 * Bracket: force below its release force at the length `low`, above at `high`; a place that is at its limit at the
 * start does not shorten the step. Trial lengths keep a thousandth of the bracket from its ends. The step returned ends
 * at `high`, at or beyond the release: if the last trial was the lower end, it is repeated.
 *
 *     f/F - 1
 *         |              . high
 *         |          .
 *       0 +------x----------------> length of the step
 *         | .
 *         |low */
int32_t dmb_trial_step_to_release(dmb_sim *sim, dmb_trial_step *trial_step)
{
    double low = 0.0, high = trial_step->end.step, f_low = beyond(sim, &sim->now), f_high = beyond(sim, &sim->trial);
    const double asked = trial_step->end.asked;
    int32_t last_side = 0, status = trial_step->status;
    if (!(f_high > DMB_RELEASE_TOLERANCE) || !(f_low < 0.0)) return status;
    double weight_low = f_low, weight_high = f_high;
    for (int i = 0; i < DMB_RELEASE_TRIALS && f_high > DMB_RELEASE_TOLERANCE; i++) {
        const double length = low + (high - low) * fmin(fmax(-weight_low / (weight_high - weight_low), 1e-3), 0.999);
        dmb_step_end end = dmb_step_end_after(sim, length);
        end.asked = asked;
        if (!(end.time > sim->clock->time) || !(length > low) || !(length < high)) break;
        status = dmb_trial_step_run(sim, &end, 0, trial_step);
        if (status < 0) return status;
        const double f = beyond(sim, &sim->trial);
        const int32_t side = f > 0.0 ? 1 : -1;
        if (side > 0) {
            high = length;
            f_high = weight_high = f;
            if (last_side > 0) weight_low *= 0.5;
        } else {
            low = length;
            weight_low = f;
            if (last_side < 0) weight_high *= 0.5;
        }
        last_side = side;
    }
    if (last_side > 0) return status;
    dmb_step_end end = dmb_step_end_after(sim, high);
    end.asked = asked;
    return dmb_trial_step_run(sim, &end, 0, trial_step);
}

/* Results that depend on both ends of the step (drives, factors, ledger) are stored before the exchange of now and
 * trial. The ledger reads the powers of the step's own forces; dmb_bounces_accept then replaces them and the
 * accelerations by those from which the next step starts. */
void dmb_trial_step_commit(dmb_sim *sim, dmb_trial_step *trial_step)
{
    dmb_counters *counters = sim->counters;
    dmb_system_accept(&trial_step->evaluation);
    if (trial_step->keep == DMB_KEEP_AT_COMMIT) dmb_factor_reuse_end(sim, trial_step, &sim->trial);
    dmb_prediction_note(sim, trial_step);
    if (sim->options.energy_ledger) dmb_ledger_add(sim, &trial_step->evaluation, trial_step->released);
    dmb_bounces_accept(&trial_step->evaluation, trial_step->bounced);
    const dmb_configuration old = sim->now;
    sim->now = sim->trial;
    sim->trial = old;
    sim->clock->time = trial_step->end.time;
    sim->clock->rest = trial_step->end.rest;
    sim->clock->step = trial_step->end.step;
    if (trial_step->end.breakpoint > 0.0) sim->clock->breakpoint = trial_step->end.breakpoint;
    counters->steps++;
    counters->iterations += trial_step->iterations;
    if (trial_step->status == DMB_NOTE_WORK_LIMITED) counters->limited++;
    if (trial_step->iterations > counters->most_iterations) counters->most_iterations = trial_step->iterations;
    counters->largest_residual = fmax(counters->largest_residual, trial_step->residual);
}

#define DMB_TURNING_MAX (2.0 * (DMB_PI - 2.5)) /* [rad] */

/* [rad2] Squared rotation of a node about its own axes in the step. */
static double turned_squared(const dmb_sim *sim, uint32_t node)
{
    const double *z = sim->increment + sim->scene->layout.row[node];
    return sim->scene->layout.size[node] == DMB_NODE_SIX_DOF ? dmb_vec3_norm_squared(z + 3) : z[1] * z[1];
}

/* [rad] Norm of z_B - R^T z_A (rotations), R the orientation of B seen from A. */
static double turned_apart(const dmb_sim *sim, uint32_t a)
{
    double Ra[9], Rb[9], u[3], za[6], zb[6], world[3], apart[3];
    dmb_node_pose(sim->scene, &sim->now, a, Ra, u);
    dmb_node_pose(sim->scene, &sim->now, a + 1, Rb, u);
    dmb_node_vector(sim->scene, &sim->now, a, sim->increment, za);
    dmb_node_vector(sim->scene, &sim->now, a + 1, sim->increment, zb);
    dmb_mat3_vec(Ra, za + 3, world);
    dmb_mat3_tvec(Rb, world, apart);
    dmb_vec3_sub(zb + 3, apart, apart);
    return dmb_vec3_norm(apart);
}

/* Bounds in the order of their cost: with the largest rotation of each chunk (only without joints, whose projection
 * moves nodes after it was stored), with the rotations of both nodes, with their relative rotation. */
uint32_t dmb_element_turned_too_far(const dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    double most = 0.0;
    for (uint32_t i = 0; i <= scene->node_count / DMB_GRAIN; i++) most = fmax(most, sim->turned_squared[i]);
    if (scene->cluster_count == 0 && 4.0 * most <= DMB_TURNING_MAX * DMB_TURNING_MAX) return DMB_NONE; /* as below */
    for (uint32_t e = 0; e < scene->element_count; e++) {
        const uint32_t a = scene->element_node[e];
        if (scene->layout.size[a] == DMB_NODE_AXIAL_TORSIONAL && scene->layout.size[a + 1] == DMB_NODE_AXIAL_TORSIONAL)
            continue;
        const double squares = turned_squared(sim, a) + turned_squared(sim, a + 1); /* (x + y)^2 <= 2 (x^2 + y^2) */
        if (2.0 * squares <= DMB_TURNING_MAX * DMB_TURNING_MAX) continue;           /* nearly always */
        if (!(turned_apart(sim, a) <= DMB_TURNING_MAX)) return e;
    }
    return DMB_NONE;
}

/* Message of a failed trial step: which part, at what time. */

/* Appends advice on a step that does not converge, if a cause is known. */
static void advise(const dmb_sim *sim, dmb_message *text)
{
    double spin = 0.0;
    const uint32_t bit = dmb_bit_near_rest(sim, &spin);
    dmb_message_clear(text);
    if (bit == DMB_NONE) return;
    dmb_message_set(text,
                    "; bit %u comes to %g rad/s, where DMB_ROCK_RATE has no sticking: damp its string, or take "
                    "DMB_ROCK_REGENERATIVE",
                    bit, spin);
}

static void explain_turn(dmb_sim *sim, const dmb_trial_step *trial_step)
{
    const dmb_owner owner = dmb_owner_of_node(sim->scene, trial_step->over);
    dmb_message_set(&sim->message,
                    "%s: the step to time %g of length %g turns it by more than 1 rad beyond twice its rotation at the "
                    "speed before, while stops or one-sided springs act: take shorter steps%s",
                    owner.text.text, trial_step->end.time, trial_step->end.step,
                    sim->options.bounded_work ? ", or bounded_work 0, which divides such steps" : "");
}

void dmb_trial_step_explain(dmb_sim *sim, const dmb_trial_step *trial_step)
{
    dmb_owner owner;
    switch (trial_step->status) {
    case DMB_ERR_ROTATION:
        owner = dmb_owner_of_element(sim->scene, trial_step->evaluation.element);
        dmb_message_set(
            &sim->message,
            "%s: relative rotation in one element above 2.5 rad at time %g, step %g; take shorter steps or more "
            "elements",
            owner.text.text, trial_step->evaluation.time, trial_step->end.step);
        break;
    case DMB_ERR_SINGULAR:
        if (trial_step->block == DMB_NONE) {
            dmb_clusters_explain(sim, "its equations are singular");
            break;
        }
        owner = dmb_owner_of_node(sim->scene, trial_step->block);
        dmb_message_set(&sim->message, "%s: iteration matrix singular at time %g, step %g", owner.text.text,
                        trial_step->evaluation.time, trial_step->end.step);
        break;
    case DMB_ERR_GEOMETRY: /* reported where it was detected */ break;
    case DMB_ERR_NOT_FINITE:
        dmb_message_set(&sim->message, "step to time %g of length %g: forces not finite", trial_step->end.time,
                        trial_step->end.step);
        break;
    case DMB_ERR_TOO_LARGE: /* dmb_time_function_integral */
        dmb_message_set(&sim->message,
                        "step to time %g of length %g: the angle of a segment per revolution in a motion drive changes "
                        "by more than the 5e4 rad that one step can integrate; take shorter steps, or a smaller order",
                        trial_step->end.time, trial_step->end.step);
        break;
    case DMB_ERR_CALLBACK:
        if (dmb_chunks_explain(sim)) break;
        if (dmb_failed_force(sim, &owner.text)) {
            dmb_message_set(&sim->message, "%s: its callback failed or gave a value beyond +-1e30 at time %g",
                            owner.text.text, trial_step->evaluation.time);
            break;
        }
        if (sim->reduced_mode->row != DMB_NONE) {
            dmb_message name;
            dmb_constraint_text(sim->scene, dmb_constraint_of_row(sim->scene, sim->reduced_mode->row), &name);
            dmb_message_set(&sim->message, "%s: its callback failed or gave a value beyond +-1e30 at time %g",
                            name.text, trial_step->evaluation.time);
            break;
        }
        dmb_message_set(&sim->message,
                        "callback of a time function or constraint: it failed or gave a value beyond +-1e30 at time %g",
                        trial_step->evaluation.time);
        break;
    default:
        if (sim->reduced_mode->row != DMB_NONE) {
            dmb_clusters_explain(sim, "its equations cannot be satisfied");
            break;
        }
        if (trial_step->over != DMB_NONE) {
            explain_turn(sim, trial_step);
            break;
        }
        advise(sim, &owner.text);
        dmb_message_set(&sim->message,
                        "step to time %g of length %g: %u iterations, relative residual = %g, must be <= %g%s",
                        trial_step->evaluation.time, trial_step->end.step, trial_step->iterations, trial_step->residual,
                        trial_step->bound, owner.text.text);
    }
}
