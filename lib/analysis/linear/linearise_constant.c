/* Test for constant coefficients in the axes of the linear system during the motion of the state: those of the wall,
 * and of the equations of joints.
 *
 * The normal of the wall is fixed in space and rotates in axes that rotate with a string. For joints,
 *
 *     d = R z,     B R = 0:     d' = R z' + R' z,     d'' = R z'' + 2 R' z' + R'' z
 *
 * The linear system has M R z'' + C R z' + K R z, so that R must be constant: R' = 0. In the body frames of two parts
 * that rotate against each other about a joint it is not (for a rotor on a carrier that may tilt, the tilt rotates in
 * the axes of the rotor), unless the axes omit this rotation. An equation of velocities J V = 0 between parts that move
 * against each other has terms J' V in d besides J d'. The test moves the state on by DMB_JOINTS_ANGLE and checks
 * whether random motions R z of before still satisfy the equations B there. */
#include <math.h>
#include <string.h>

#include "analysis/linear/linear.h"
#include "base/memory.h"
#include "math/vec3.h"
#include "sim/node.h"
#include "system/constrain/constrain.h"
#include "system/system.h"

/* [rad] rotation, or displacement over the length scale, of the fastest part for the test */
#define DMB_JOINTS_ANGLE 1e-3
/* [-] permitted change of B R z relative to its terms: rounding, and speeds projected to 1e-6 */
#define DMB_JOINTS_CHANGE 1e-8
/* [rad/s] largest spin of a string on the wall that counts as rest */
#define DMB_WALL_SPIN 1e-3

enum { DMB_JOINTS_DRAWS = 3 };

/* [1/s] of the fastest node. */
static double largest_rate(const dmb_linear *linear)
{
    const dmb_scene *scene = &linear->scene;
    double most = 0.0;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        double v[6];
        dmb_node_vector(scene, &linear->work->now, i, linear->work->now.velocity, v);
        most = fmax(most, dmb_vec3_norm(v) / scene->length_scale + dmb_vec3_norm(v + 3));
    }
    return most;
}

/* Rows of constraints at the state after a time h, in a separate copy. */
static int32_t move_on(const dmb_linear *linear, dmb_sim *copy, double h)
{
    const dmb_configuration *state = &linear->work->now;
    dmb_evaluation evaluation = dmb_linear_evaluation(linear);
    memcpy(copy->now.velocity, state->velocity, linear->rows * sizeof(double));
    for (uint32_t r = 0; r < linear->rows; r++)
        copy->increment[r] = h * (state->velocity[r] + 0.5 * h * state->acceleration[r]);
    dmb_system_move(copy);
    evaluation.sim = copy;
    evaluation.time += h;
    return dmb_constraint_rows(&evaluation);
}

/* d by body frames after the time h, of d in axes that do not spin: d <- exp(-w^ h) d. */
static void turn_back(const dmb_linear *linear, double h, double *d)
{
    const dmb_scene *scene = &linear->scene;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        double *x = d + scene->layout.row[i];
        if (scene->layout.size[i] != DMB_NODE_SIX_DOF) continue;
        const double angle = h * linear->spin[scene->layout.row[i] + 3], c = cos(angle), s = sin(angle);
        for (int k = 0; k < 6; k += 3) {
            const double y = x[k + 1], z = x[k + 2];
            x[k + 1] = c * y + s * z;
            x[k + 2] = c * z - s * y;
        }
    }
}

/* z: translations of the length scale, rotations of 1, each +-(1/2 .. 3/2). */
static void draw(const dmb_linear *linear, uint64_t *seed, double *z, double *d)
{
    const dmb_scene *scene = &linear->scene;
    for (uint32_t i = 0; i < linear->coordinates; i++) {
        const uint32_t row = linear->row_of[i], node = dmb_node_of_row(scene, row);
        const uint32_t c = row - scene->layout.row[node];
        *seed = *seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
        const double number = 0.5 + (double)(*seed >> 41) * 0x1p-23;
        z[i] = ((*seed >> 40 & 1) != 0 ? number : -number) *
               (2 * c < scene->layout.size[node] ? scene->length_scale : 1.0);
    }
    dmb_linear_expand(linear, z, d);
}

/* 1 if a row of the constraint is no longer satisfied by d. */
static int has_changed(const dmb_sim *copy, const dmb_constraint *constraint, const double *d)
{
    const dmb_block_layout *layout = &copy->scene->layout;
    for (uint32_t r = 0; r < constraint->rows; r++) {
        const double *J = copy->constraint_jacobian + constraint->jacobian + (size_t)r * constraint->columns;
        double sum = 0.0, terms = 0.0;
        for (uint32_t k = 0; k < constraint->node_count; k++)
            for (uint32_t c = 0; c < layout->size[constraint->node[k]]; c++) {
                const double term = J[constraint->column[k] + c] * d[layout->row[constraint->node[k]] + c];
                sum += term;
                terms += fabs(term);
            }
        if (fabs(sum) > DMB_JOINTS_CHANGE * terms) return 1;
    }
    return 0;
}

/* 1 if it has equations of velocities and its parts have relative motion; for a caller's constraint, if they move at
 * all. */
static int rolls(const dmb_linear *linear, const dmb_sim *copy, const dmb_constraint *constraint, double rate)
{
    double motion = 0.0;
    int speeds = 0;
    for (uint32_t r = 0; r < constraint->rows; r++)
        speeds |= copy->constraint_type[constraint->row + r] == DMB_ROW_SPEED;
    if (!speeds) return 0;
    if (constraint->kind == DMB_OF_JOINT) {
        dmb_relative relative;
        dmb_joint_motion_of(&linear->scene, &linear->work->now, constraint->index, &relative, NULL);
        motion = dmb_vec3_norm(relative.V) / linear->scene.length_scale + dmb_vec3_norm(relative.V + 3);
    } else {
        for (uint32_t k = 0; k < constraint->node_count; k++) {
            double v[6];
            dmb_node_vector(&linear->scene, &linear->work->now, constraint->node[k], linear->work->now.velocity, v);
            motion = fmax(motion, dmb_vec3_norm(v) / linear->scene.length_scale + dmb_vec3_norm(v + 3));
        }
    }
    return motion > DMB_LINEAR_BALANCED * rate;
}

static uint32_t find_turning(dmb_linear *linear, const dmb_sim *copy, double rate, double *z, double *d)
{
    uint64_t seed = 1;
    for (uint32_t i = 0; i < linear->scene.constraint_count; i++)
        if (rolls(linear, copy, linear->scene.constraints + i, rate)) {
            linear->rolls = 1;
            return i;
        }
    for (int k = 0; k < DMB_JOINTS_DRAWS; k++) {
        draw(linear, &seed, z, d);
        turn_back(linear, DMB_JOINTS_ANGLE / rate, d);
        for (uint32_t i = 0; i < linear->scene.constraint_count; i++)
            if (has_changed(copy, linear->scene.constraints + i, d)) return i;
    }
    return DMB_NONE;
}

int32_t dmb_linear_find_turning(dmb_linear *linear, const dmb_sim *sim)
{
    const double rate = linear->scene.cluster_count > 0 ? largest_rate(linear) : 0.0;
    const size_t bytes = ((size_t)linear->coordinates + linear->rows) * sizeof(double);
    int32_t status = DMB_ERR_NO_MEMORY;
    linear->turning = DMB_NONE;
    if (!(rate > 0.0) || linear->coordinates == 0) return DMB_OK;
    dmb_sim *copy = dmb_state_copy(sim);
    double *z = copy != NULL ? dmb_allocate(&linear->allocator, bytes) : NULL;
    if (z != NULL) status = move_on(linear, copy, DMB_JOINTS_ANGLE / rate);
    if (status >= 0) linear->turning = find_turning(linear, copy, rate, z, z + linear->coordinates);
    dmb_release(&linear->allocator, z, bytes);
    dmb_state_discard(copy);
    return status;
}

/* [rad/s] Spin about its own axis if the axes of d spin with it, otherwise 0. */
static double spin_of(const dmb_linear *linear, uint32_t node)
{
    const dmb_block_layout *layout = &linear->scene.layout;
    return layout->size[node] == DMB_NODE_SIX_DOF ? fabs(linear->rest[layout->row[node] + 3]) : 0.0;
}

void dmb_linear_find_turning_on_wall(dmb_linear *linear, const dmb_linear_options *options)
{
    linear->turning_node = DMB_NONE;
    for (uint32_t s = 0; s < linear->scene.site_count && linear->turning_node == DMB_NONE; s++) {
        const uint32_t node = linear->scene.sites[s].node;
        const int touches =
            linear->work->trial.site_penetration[s] > 0.0 ||
            (options->contact == DMB_CONTACT_CLOSED && dmb_linear_wall_stiffness(linear, s, options->gap) > 0.0);
        if (touches && spin_of(linear, node) > DMB_WALL_SPIN) linear->turning_node = node;
    }
}

/* 1 with a message of `who`, why and `then` what, if coefficients change. */
static int report_change(const dmb_linear *linear, const char *who, const char *then, dmb_message *message)
{
    if (linear->turning_node != DMB_NONE) {
        const dmb_owner owner = dmb_owner_of_node(&linear->scene, linear->turning_node);
        dmb_message_set(message, "%s: %s turns on the wall at %g rad/s, which goes round in axes that turn with it: %s",
                        who, owner.text.text, spin_of(linear, linear->turning_node), then);
    } else if (linear->turning != DMB_NONE) {
        dmb_message owner;
        dmb_constraint_text(&linear->scene, linear->turning, &owner);
        const char *const axes = linear->rolls           ? "axes that turn and in axes at rest"
                                 : linear->inertial_axes ? "axes at rest"
                                                         : "axes that turn with them";
        dmb_message_set(message, "%s: %s: its parts move against each other, so that its equations change in %s: %s",
                        who, owner.text, axes, then);
    }
    return linear->turning_node != DMB_NONE || linear->turning != DMB_NONE;
}

int32_t dmb_linear_check_coefficients(const dmb_linear *linear, const char *who, dmb_message *message)
{
    const char *const then = linear->inertial_axes || linear->rolls
                                 ? "choose a state in which they do not move, or a run in time"
                                 : "choose axes at rest, or a state that does not turn";
    return report_change(linear, who, then, message) ? DMB_ERR_UNSUPPORTED : DMB_OK;
}

int32_t dmb_linear_note_coefficients(const dmb_linear *linear, const char *who, dmb_message *message)
{
    const char *const then = "what that changes is left out; answers hold along and about the axes of straight parts";
    return report_change(linear, who, then, message) ? DMB_NOTE_INCOMPLETE : DMB_OK;
}
