/* State of joints: gimbal singularities, revolutions counted, reactions, locks, energy of their laws.
 *
 *     check                 when                         fails if
 *     -------------------   --------------------------   ----------------------------------------------------------
 *     gimbal singularity    start, end of each step      |RZ| within 0.01 rad of a right angle, of universal joints
 *                                                        and of joints with anything that acts on an angle
 *     rim that lies flat    the same                     sine of its angle with the plane <= 1e-3
 *     gimbal flip           equilibrium found            a universal joint has passed the right angle
 *
 * At RZ = 90 degrees RX and RY turn about one axis (eq:joints.coordinates); their gradients grow as 1/cos RZ. */
#include "system/constrain/constrain.h"

#include <math.h>

#include "constraint/joint.h"
#include "math/elementary.h"
#include "math/mat6.h"
#include "math/so3.h"
#include "math/vec3.h"

#define DMB_RIM_EDGE 1e-3

/* [rad] smallest permitted distance of the angle from a right angle; [-] of a rim, sine of the angle to its plane */
#define DMB_RIGHT_ANGLE_EDGE 0.01

/* [rad] Largest rotation in one step for which the chord approximates the arc. */
#define DMB_SHORT_TURN 1.0

static int coupled(const dmb_scene *scene, uint32_t j)
{
    for (uint32_t i = 0; i < scene->coupling_count; i++)
        for (uint32_t k = 0; k < scene->couplings[i].count; k++)
            if (scene->couplings[i].joint[k] == j && scene->couplings[i].component[k] >= DMB_RX) return 1;
    return 0;
}

static int forced(const dmb_scene *scene, uint32_t j)
{
    for (uint32_t i = 0; i < scene->force_count; i++)
        for (uint32_t k = 0; k < scene->forces[i].count; k++)
            if (scene->forces[i].joint[k] == j && scene->forces[i].component[k] >= DMB_RX) return 1;
    return 0;
}

/* 1: a spring, drive or coupling acts on an angle of the joint. */
static int acts_on_angles(const dmb_scene *scene, uint32_t j)
{
    const dmb_scene_joint *joint = scene->joints + j;
    if (joint->law != DMB_NONE && joint->law_mask >> DMB_RX) return 1;
    for (uint32_t i = joint->first_drive; i < joint->first_drive + joint->drive_count; i++)
        if (scene->drives[scene->joint_drives[i]].component >= DMB_RX) return 1;
    return coupled(scene, j) || forced(scene, j);
}

/* 1: the same, or the equations of its kind use the angles. */
static int needs_angles(const dmb_scene *scene, uint32_t j)
{
    const int32_t kind = scene->joints[j].kind;
    if ((dmb_joint_free_mask(kind) >> DMB_RZ & 1) == 0) return 0; /* RZ stays 0 */
    return kind == DMB_JOINT_UNIVERSAL || acts_on_angles(scene, j);
}

/* Distance from 0 of the chord from a to b. */
static double chord_distance(const double a[2], const double b[2])
{
    const double d[2] = {b[0] - a[0], b[1] - a[1]}, square = d[0] * d[0] + d[1] * d[1];
    double t = square > 0.0 ? -(a[0] * d[0] + a[1] * d[1]) / square : 0.0;
    t = fmin(fmax(t, 0.0), 1.0);
    const double x = a[0] + t * d[0], y = a[1] + t * d[1];
    return sqrt(x * x + y * y);
}

/* cos RZ of the trial, or its smallest value on the path from now, estimated from the ends of the step. n = (R_yy,
 * R_yz) runs along an arc, whose distance from 0 is cos RZ. For short rotations the chord replaces the arc; of a
 * rotation above DMB_SHORT_TURN the end alone is checked. */
static double smallest_cosine(const dmb_sim *sim, uint32_t j, const double R[9], int moving)
{
    const double here[2] = {R[4], R[5]};
    const double s = sqrt(here[0] * here[0] + here[1] * here[1]);
    dmb_relative before;
    double turned[9];
    if (!moving) return s;
    dmb_joint_motion_of(sim->scene, &sim->now, j, &before, NULL);
    dmb_mat3_mul_nt(R, before.R, turned);
    if (turned[0] + turned[4] + turned[8] < 1.0 + 2.0 * dmb_cos(DMB_SHORT_TURN)) return s;
    const double from[2] = {before.R[4], before.R[5]};
    return fmin(s, chord_distance(from, here));
}

static int32_t refuse_angle(dmb_sim *sim, uint32_t j, double s, double time)
{
    static const char *const universal = "an axis of its cross lies along a shaft: turn its frames so that it works "
                                         "about 0, or use a spherical joint";
    static const char *const other = "its angles RX and RY are not defined there: turn its frames (axis_a, normal_a, "
                                     "axis_b, normal_b), or put nothing on its angles";
    dmb_message owner;
    dmb_constraint_text(sim->scene, sim->scene->joints[j].constraint, &owner);
    const double angle = dmb_atan2(sqrt(fmax(1.0 - s * s, 0.0)), s);
    dmb_message_set(&sim->message, "%s: |RZ| = %g rad at time %g, must be < %g; %s", owner.text, angle, time,
                    0.5 * DMB_PI - DMB_RIGHT_ANGLE_EDGE,
                    sim->scene->joints[j].kind == DMB_JOINT_UNIVERSAL ? universal : other);
    return DMB_ERR_GEOMETRY;
}

static int32_t refuse_flat(dmb_sim *sim, uint32_t j, double sine, double time)
{
    dmb_message owner;
    dmb_constraint_text(sim->scene, sim->scene->joints[j].constraint, &owner);
    dmb_message_set(&sim->message,
                    "%s: its rim lies flat, sine of its angle with the plane = %g at time %g, must be > %g; "
                    "open the joint before the rim falls over",
                    owner.text, sine, time, DMB_RIM_EDGE);
    return DMB_ERR_GEOMETRY;
}

/* Locked and open joints are not checked: they do not use angles. */
static int32_t check_joint(dmb_sim *sim, uint32_t j, int moving, double time)
{
    const dmb_scene_joint *joint = sim->scene->joints + j;
    const int rolls = joint->kind == DMB_JOINT_ROLLING, angles = needs_angles(sim->scene, j);
    dmb_relative relative;
    if (sim->joint_state[j] != DMB_JOINT_ACTIVE || !(rolls || angles)) return DMB_OK;
    dmb_joint_motion_of(sim->scene, &sim->trial, j, &relative, NULL);
    const double sine =
        sqrt(relative.R[1] * relative.R[1] + relative.R[2] * relative.R[2]); /* of the x axes of a and b */
    if (rolls && !(sine > DMB_RIM_EDGE)) return refuse_flat(sim, j, sine, time);
    const double s = angles ? smallest_cosine(sim, j, relative.R, moving) : 1.0;
    return s > dmb_sin(DMB_RIGHT_ANGLE_EDGE) ? DMB_OK : refuse_angle(sim, j, s, time);
}

/* 1: the joint is beyond the singularity. With RX = 0 of a universal joint n = (cos RZ, 0), whose sign is the side. A
 * joint with free angles reaches the same pose about its other axis. */
static int is_beyond_gimbal_singularity(const dmb_sim *sim, uint32_t j)
{
    dmb_relative before, here;
    if (sim->joint_state[j] != DMB_JOINT_ACTIVE || sim->scene->joints[j].kind != DMB_JOINT_UNIVERSAL) return 0;
    if (!acts_on_angles(sim->scene, j)) return 0;
    dmb_joint_motion_of(sim->scene, &sim->now, j, &before, NULL);
    dmb_joint_motion_of(sim->scene, &sim->trial, j, &here, NULL);
    return before.R[4] * here.R[4] + before.R[5] * here.R[5] < 0.0;
}

int32_t dmb_joints_refuse_gimbal_flip(dmb_sim *sim)
{
    dmb_message owner;
    for (uint32_t j = 0; j < sim->scene->joint_count; j++) {
        if (!is_beyond_gimbal_singularity(sim, j)) continue;
        dmb_constraint_text(sim->scene, sim->scene->joints[j].constraint, &owner);
        dmb_message_set(
            &sim->message,
            "static: %s: before the equilibrium |RZ| passes %g rad, where an axis of its cross lies along a "
            "shaft: use a spherical joint, stiffer springs or a stop, or start nearer to the equilibrium",
            owner.text, 0.5 * DMB_PI);
        return DMB_ERR_GEOMETRY;
    }
    return DMB_OK;
}

double dmb_joints_nearest_gimbal_singularity(const dmb_sim *sim, uint32_t *joint)
{
    double nearest = 1.0;
    *joint = DMB_NONE;
    for (uint32_t j = 0; j < sim->scene->joint_count; j++) {
        dmb_relative here;
        if (sim->joint_state[j] != DMB_JOINT_ACTIVE || !needs_angles(sim->scene, j)) continue;
        if (!acts_on_angles(sim->scene, j)) continue;
        dmb_joint_motion_of(sim->scene, &sim->trial, j, &here, NULL);
        const double s = smallest_cosine(sim, j, here.R, 0);
        if (!(s < nearest)) continue;
        nearest = s;
        *joint = j;
    }
    return nearest;
}

int32_t dmb_joints_refuse_gimbal_singularity(dmb_sim *sim, int moving, double time)
{
    for (uint32_t j = 0; j < sim->scene->joint_count; j++) {
        const int32_t status = check_joint(sim, j, moving, time);
        if (status < 0) return status;
    }
    return DMB_OK;
}

/* Stores the unwrapped angles RX and RY, from which the next step counts revolutions. */
void dmb_joint_set_turns(dmb_sim *sim, uint32_t j, const dmb_joint_coordinates *c)
{
    sim->trial.joint_turn[2 * j] = c->value[3];
    sim->trial.joint_turn[2 * j + 1] = c->value[4];
}

/* Revolutions of RX and RY are memory: the next step continues from the angles stored here. */
void dmb_joints_follow(dmb_evaluation *evaluation)
{
    dmb_sim *sim = evaluation->sim;
    for (uint32_t j = 0; j < sim->scene->joint_count; j++) {
        dmb_relative relative;
        dmb_joint_coordinates c;
        dmb_joint_motion_of(sim->scene, &sim->trial, j, &relative, NULL);
        dmb_joint_coordinates_in(evaluation, j, &relative, &c);
        dmb_joint_set_turns(sim, j, &c);
    }
}

/* Power of the callers' constraints: -f . B v = f . rate. */
void dmb_joint_reactions(dmb_evaluation *evaluation)
{
    dmb_sim *sim = evaluation->sim;
    dmb_clusters_least_norm(sim);
    for (uint32_t i = 0; i < sim->scene->constraint_count; i++) {
        const dmb_constraint *c = sim->scene->constraints + i;
        for (uint32_t k = 0; k < c->rows && c->kind == DMB_OF_CALLBACK; k++)
            evaluation->power[DMB_POWER_LOADS] += sim->trial.multiplier[c->row + k] * sim->constraint_rate[c->row + k];
    }
}

/* The renewal of the partition is last: multipliers of least norm use the factors of the old one. */
void dmb_joints_accept(dmb_evaluation *evaluation)
{
    dmb_sim *sim = evaluation->sim;
    dmb_joints_follow(evaluation);
    dmb_joint_reactions(evaluation);
    dmb_clusters_watch(sim);
}

/* Stores the locked pose R0, p0 (constraint/joint.h). */
void dmb_joint_hold(dmb_sim *sim, uint32_t j)
{
    dmb_relative relative;
    dmb_joint_place_hold(sim, j, 0);
    dmb_joint_motion(sim->scene, &sim->now, j, &relative, NULL);
    dmb_mat3_copy(relative.R, sim->joint_lock + 12 * j);
    dmb_vec3_copy(relative.p, sim->joint_lock + 12 * j + 9);
    dmb_joint_place_hold(sim, j, sim->scene->joints[j].kind == DMB_JOINT_POINT_ON_HOLE);
}

/* A joint that opens or is released from its lock leaves its place on the hole free again. */
void dmb_joint_set_state(dmb_sim *sim, uint32_t j, int32_t state)
{
    sim->joint_state[j] = state;
    if (state == DMB_JOINT_LOCKED)
        dmb_joint_hold(sim, j);
    else
        dmb_joint_place_hold(sim, j, 0);
}

/* Springs and stops: the integral of each law over its coordinate. */
double dmb_joint_energy(const dmb_sim *sim, const dmb_configuration *configuration)
{
    const dmb_scene *scene = sim->scene;
    double sum = 0.0;
    for (uint32_t j = 0; j < scene->joint_count; j++) {
        const dmb_scene_joint *joint = scene->joints + j;
        dmb_relative relative;
        dmb_joint_coordinates c;
        if (joint->law == DMB_NONE || sim->joint_state[j] == DMB_JOINT_OPEN) continue;
        dmb_joint_motion_of(scene, configuration, j, &relative, NULL);
        dmb_joint_coordinates_at(relative.R, relative.p, relative.V, configuration->joint_turn + 2 * j, &c);
        for (uint32_t i = 0; i < 6; i++)
            if (joint->law_mask >> i & 1) sum += dmb_joint_law_energy(scene->laws + joint->law + i, c.value[i]);
    }
    return sum;
}
