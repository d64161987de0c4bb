/* Selection of the steady state by the motion drives of a scene: its velocity, and the parts of the scene that exclude
 * it.
 *
 *     wanted              drives move   result
 *     AT_REST             any           rest
 *     AUTO, slip assumed  any           rest: friction of the assumed slip represents the motion
 *     any other           no            rest
 *     SLIDING, RIGID      yes           that motion, or DMB_ERR_UNSUPPORTED with the part that excludes it
 *     AUTO                yes           SLIDING, else RIGID, else rest with DMB_NOTE_NOT_STEADY
 *
 * AUTO that ends at rest keeps the message of RIGID, which was tried last. Any other error (callback, memory) ends the
 * selection at once. */
#include <math.h>
#include <string.h>

#include "analysis/static/static.h"
#include "base/memory.h"
#include "math/mat6.h"
#include "sim/layout.h"
#include "sim/node.h"
#include "system/assemble/drives.h"
#include "system/constrain/constrain.h"

static int moves(const dmb_sim *sim, uint32_t drive)
{
    return sim->scene->drives[drive].kind == DMB_DRIVE_MOTION && dmb_steady_target(sim, drive) != 0.0;
}

/* ---- RIGID ------------------------------------------------------------------------------------------------------- */

/* World twist that the drive of a part adds, H X = (R u; R w) at the node. */
static void twist_of_part(const dmb_sim *sim, const dmb_scene_drive *drive, double speed, double twist[6])
{
    const dmb_scene *scene = sim->scene;
    double R[9], x[3], v[6] = {0.0};
    dmb_node_pose(scene, &sim->now, drive->node, R, x);
    dmb_vec3_add(x, scene->reference_position + 3 * (size_t)drive->node, x);
    v[drive->component] = speed;
    dmb_adjoint_apply(R, x, v, twist);
}

/* World twist of the drive of a joint to the ground, by the order of its angles R = Ry(RY) Rz(RZ) Rx(RX). */
static void twist_of_joint(const dmb_sim *sim, const dmb_scene_drive *drive, double speed, double twist[6])
{
    const dmb_scene_joint *joint = sim->scene->joints + drive->joint;
    dmb_relative relative;
    double axis[3] = {0.0, 0.0, 0.0}, x[3], v[6] = {0.0};
    dmb_joint_motion_of(sim->scene, &sim->now, drive->joint, &relative, NULL);
    const double *R = relative.R;
    if (drive->component < 3)
        axis[drive->component] = 1.0;
    else if (drive->component == DMB_RX)
        dmb_vec3_set(R[0], R[3], R[6], axis);
    else if (drive->component == DMB_RY)
        axis[1] = 1.0;
    else { /* Ry(RY) e_z, R e_x being Ry Rz e_x */
        const double length = hypot(R[0], R[6]);
        dmb_vec3_set(-R[6] / length, 0.0, R[0] / length, axis);
    }
    dmb_vec3_scale(speed, axis, v + (drive->component < 3 ? 0 : 3));
    /* the axis runs through the origin of b */
    dmb_vec3_copy(relative.p, x);
    if (drive->component >= 3) dmb_vec3_cross(x, v + 3, v);
    dmb_adjoint_apply(joint->a.M, joint->a.x, v, twist);
}

static int32_t add_twist(dmb_sim *sim, uint32_t i, double twist[6])
{
    const dmb_scene_drive *drive = sim->scene->drives + i;
    double part[6];
    if (drive->joint == DMB_NONE) {
        twist_of_part(sim, drive, dmb_steady_target(sim, i), part);
    } else {
        if (sim->scene->joints[drive->joint].a.node != DMB_NONE)
            return DMB_STEADY_REFUSE(
                sim,
                "%s: it moves two parts against each other, so that the whole does not turn as one body; "
                "take DMB_STEADY_AT_REST",
                dmb_drive_text(sim->scene, i, &(dmb_message){""}));
        twist_of_joint(sim, drive, dmb_steady_target(sim, i), part);
    }
    for (int k = 0; k < 6; k++) twist[k] += part[k];
    return DMB_OK;
}

/* Drives of one node or of one joint act together: their twists are added before they are compared with others. */
static uint64_t group_of(const dmb_scene_drive *drive)
{
    return drive->joint == DMB_NONE ? drive->node : (uint64_t)1 << 32 | drive->joint;
}

/* [m/s] largest velocity of a twist within the scene, rotation times the size of the scene. */
static double size_of(const dmb_scene *scene, const double twist[6])
{
    return dmb_vec3_norm(twist) + dmb_vec3_norm(twist + 3) * fmax(scene->length, scene->length_scale);
}

/* Twist of each driven node or joint; all moving drives must agree. */
static int32_t set_twist(dmb_sim *sim, dmb_steady *steady)
{
    const dmb_scene *scene = sim->scene;
    uint32_t first = DMB_NONE;
    for (uint32_t i = 0; i < scene->drive_count; i++) {
        double twist[6] = {0.0}, off[6];
        int32_t status = DMB_OK;
        if (!moves(sim, i)) continue;
        for (uint32_t k = 0; k < scene->drive_count && status >= 0; k++)
            if (moves(sim, k) && group_of(scene->drives + k) == group_of(scene->drives + i))
                status = add_twist(sim, k, twist);
        if (status < 0) return status;
        if (first == DMB_NONE) {
            first = i;
            dmb_vec6_copy(twist, steady->twist);
        }
        for (int k = 0; k < 6; k++) off[k] = twist[k] - steady->twist[k];
        if (size_of(scene, off) > DMB_STEADY_SAME * size_of(scene, twist))
            return DMB_STEADY_REFUSE(
                sim,
                "drives %u and %u: they turn the whole about different axes or at different speeds, which is "
                "not steady; take DMB_STEADY_AT_REST",
                first, i);
    }
    return DMB_OK;
}

/* 1: a world vector would have to rotate with the scene, because it is not along the axis. */
static int turns(const double axis[3], const double v[3])
{
    double c[3];
    dmb_vec3_cross(axis, v, c);
    return dmb_vec3_norm(c) > DMB_STEADY_SAME * dmb_vec3_norm(axis) * dmb_vec3_norm(v);
}

static int32_t check_steady_forces(dmb_sim *sim, const dmb_steady *steady)
{
    const dmb_scene *scene = sim->scene;
    const double *axis = steady->twist + 3;
    if (scene->features & DMB_FEATURE_GRAVITY && turns(axis, scene->gravity))
        return DMB_STEADY_REFUSE(
            sim, "gravity: it is not along the axis that the whole turns about, so that no state is steady; take an "
                 "axis along it, or DMB_STEADY_AT_REST");
    for (uint32_t i = 0; i < scene->load_count; i++) {
        const dmb_scene_load *load = scene->loads + i;
        double f[6], R[9];
        if (load->frame == DMB_FRAME_BODY || sim->trial.load_factor[i] == 0.0) continue;
        dmb_mat3_identity(R);
        if (load->frame == DMB_FRAME_HOLE) /* the scene has a hole then */
            dmb_hole_frame_rotation(&scene->hole, scene->reference_depth[load->node], R);
        dmb_mat3_vec(R, load->force, f);
        dmb_mat3_vec(R, load->moment, f + 3);
        if (turns(axis, f) || turns(axis, f + 3))
            return DMB_STEADY_REFUSE(
                sim,
                "%s: it does not turn with the whole and is not along its axis, so that no state is "
                "steady; take DMB_FRAME_BODY for it, or DMB_STEADY_AT_REST",
                dmb_load_text(sim->scene, i, &(dmb_message){""}));
    }
    return DMB_OK;
}

/* The wall does not change in the motion if the whole rotates about, and moves along, the axis of a straight hole:
 * that axis is parallel to the angular velocity, and so is the velocity of its points. */
static int32_t check_hole(dmb_sim *sim, const dmb_steady *steady)
{
    const dmb_scene *scene = sim->scene;
    double off[3];
    for (uint32_t i = 0; i < scene->node_count; i++)
        if (scene->layout.size[i] != DMB_NODE_SIX_DOF)
            return DMB_STEADY_REFUSE(
                sim, "axial-torsional pipes: they do not turn as a rigid body; take DMB_STEADY_SLIDING");
    if (!scene->has_hole || scene->site_count == 0) return DMB_OK;
    dmb_vec3_cross(steady->twist + 3, scene->hole.origin, off); /* velocity of a point on the hole axis */
    dmb_vec3_add(off, steady->twist, off);
    if (!dmb_hole_is_straight(&scene->hole) || turns(scene->hole.direction, steady->twist + 3) ||
        turns(scene->hole.direction, off))
        return DMB_STEADY_REFUSE(
            sim, "wall: the whole does not turn about the axis of a straight hole; take DMB_STEADY_SLIDING or "
                 "_AT_REST");
    return DMB_OK;
}

/* Springs between the ground and moving parts are not steady. */
static int32_t check_ground(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t j = 0; j < scene->joint_count; j++) {
        const dmb_scene_joint *joint = scene->joints + j;
        if (joint->a.node != DMB_NONE || joint->law == DMB_NONE || sim->joint_state[j] == DMB_JOINT_OPEN) continue;
        return DMB_STEADY_REFUSE(
            sim,
            "joint %u: it has a law about the ground, which is not steady where the whole turns; take "
            "DMB_STEADY_AT_REST",
            j);
    }
    return DMB_OK;
}

/* Rows with supports or motion drives must have the velocity of the rigid motion. */
static int32_t check_supports(dmb_evaluation *evaluation, dmb_steady *steady)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    (void)dmb_steady_move(steady, evaluation, 1.0); /* rigid motion does not fail */
    for (uint32_t i = 0; i < scene->constrained_count; i++) {
        const uint32_t node = scene->constrained_node[i], c = scene->constrained_component[i];
        const double speed = sim->trial.velocity[scene->layout.row[node] + c];
        double held = 0.0;
        for (uint32_t k = 0; k < scene->drive_count; k++)
            if (scene->drives[k].kind == DMB_DRIVE_MOTION && scene->drives[k].row == scene->layout.row[node] + c)
                held = dmb_steady_target(sim, k);
        if (fabs(speed - held) * (c < 3 ? 1.0 : scene->length_scale) <= DMB_STEADY_SAME * size_of(scene, steady->twist))
            continue;
        const dmb_owner owner = dmb_owner_of_node(scene, node);
        return DMB_STEADY_REFUSE(
            sim,
            "%s: its support or drive holds body-frame component %u at a speed of %g, must be %g for "
            "the whole to turn as one body; take DMB_STEADY_AT_REST",
            owner.text.text, c, held, speed);
    }
    return DMB_OK;
}

/* The twist comes first, because the other checks compare with it. Supports and joints follow in try_kind: they need
 * the velocities of the nodes. */
static int32_t choose_rigid(dmb_sim *sim, dmb_steady *steady)
{
    steady->kind = DMB_STEADY_RIGID;
    int32_t status = set_twist(sim, steady);
    if (status >= 0) status = check_steady_forces(sim, steady);
    if (status >= 0) status = check_hole(sim, steady);
    if (status >= 0) status = check_ground(sim);
    return status;
}

/* ---- Both kinds -------------------------------------------------------------------------------------------------- */

static void find_strings(const dmb_scene *scene, uint32_t *string)
{
    for (uint32_t i = 0; i < scene->node_count; i++) string[i] = DMB_NONE;
    for (uint32_t s = 0; s < scene->string_count; s++)
        for (uint32_t i = 0; i < scene->strings[s].node_count; i++) string[scene->strings[s].first_node + i] = s;
}

static void lay_out(dmb_arena *arena, const dmb_scene *scene, dmb_steady *to)
{
    const dmb_block_layout *layout = &scene->layout;
    to->speed = DMB_ARENA_DOUBLES(arena, 2 * (size_t)scene->string_count);
    to->string = DMB_ARENA_ARRAY(arena, uint32_t, scene->node_count);
    to->frame_velocity = DMB_ARENA_DOUBLES(arena, scene->row_count);
    to->before = DMB_ARENA_DOUBLES(arena, scene->row_count);
    to->increment = DMB_ARENA_DOUBLES(arena, scene->row_count);
    to->damping.diagonal = DMB_ARENA_DOUBLES(arena, layout->diag[layout->n]);
    to->damping.lower = DMB_ARENA_DOUBLES(arena, layout->link[layout->n - 1]);
    to->damping.upper = DMB_ARENA_DOUBLES(arena, layout->link[layout->n - 1]);
    to->damping.joints = DMB_ARENA_DOUBLES(arena, scene->tangent_count);
}

static int32_t allocate(const dmb_sim *sim, dmb_steady *out)
{
    dmb_arena arena;
    dmb_steady nowhere;
    out->allocator = sim->allocator;
    dmb_arena_count(&arena);
    lay_out(&arena, sim->scene, &nowhere);
    out->block_size = dmb_arena_block_size(&arena);
    out->block = dmb_allocate(&sim->allocator, out->block_size);
    if (out->block == NULL) return DMB_ERR_NO_MEMORY;
    dmb_arena_place(&arena, out->block, out->block_size);
    lay_out(&arena, sim->scene, out);
    find_strings(sim->scene, out->string);
    return DMB_OK;
}

void dmb_steady_release(dmb_steady *steady)
{
    dmb_release(&steady->allocator, steady->block, steady->block_size);
    steady->block = NULL;
}

/* The trial is workspace; the caller restores it. */
static int32_t try_kind(dmb_sim *sim, int32_t kind, dmb_steady *out)
{
    dmb_evaluation evaluation;
    memset(&evaluation, 0, sizeof evaluation);
    evaluation.sim = sim;
    evaluation.time = sim->clock->time;
    evaluation.load_factor = 1.0;
    int32_t status = kind == DMB_STEADY_SLIDING ? dmb_steady_choose_sliding(sim, out) : choose_rigid(sim, out);
    if (status >= 0 && kind == DMB_STEADY_RIGID) status = check_supports(&evaluation, out);
    return status < 0 ? status : dmb_steady_check_joints(out, &evaluation);
}

/* Prescribes the motion drives at the present time, in the trial. */
static int32_t prescribe(dmb_sim *sim)
{
    dmb_evaluation evaluation;
    memset(&evaluation, 0, sizeof evaluation);
    evaluation.sim = sim;
    evaluation.time = sim->clock->time;
    dmb_configuration_copy(sim, &sim->now, &sim->trial);
    return dmb_system_prescribe(&evaluation);
}

/* The second attempt of AUTO prescribes the drives again, because the first one has used the trial. */
static int32_t choose(dmb_sim *sim, int32_t wanted, dmb_steady *out)
{
    int32_t status = allocate(sim, out);
    if (status < 0) return status;
    if (wanted != DMB_STEADY_AUTO) return try_kind(sim, wanted, out);
    status = try_kind(sim, DMB_STEADY_SLIDING, out);
    if (status != DMB_ERR_UNSUPPORTED) return status;
    status = prescribe(sim);
    if (status >= 0) status = try_kind(sim, DMB_STEADY_RIGID, out);
    if (status != DMB_ERR_UNSUPPORTED) {
        if (status >= 0) dmb_message_clear(&sim->message);
        return status;
    }
    dmb_steady_release(out);
    out->kind = DMB_STEADY_AT_REST;
    return DMB_NOTE_NOT_STEADY;
}

/* [-] Largest deviation of velocities from the steady motion, as a fraction of the largest velocity, at which a state
 * counts as steady. */
#define DMB_STEADY_LIKE 1e-2

/* 1: the nodes of the accepted state have the velocities of the trial, rotations times the length scale. */
static int is_moving_so(const dmb_sim *work)
{
    const dmb_scene *scene = work->scene;
    double most = 0.0, off = 0.0;
    for (uint32_t i = 0; i < scene->node_count; i++)
        for (uint32_t c = 0; c < scene->layout.size[i]; c++) {
            const uint32_t row = scene->layout.row[i] + c;
            const double arm = 2 * c < scene->layout.size[i] ? 1.0 : scene->length_scale;
            most = fmax(most, arm * fabs(work->trial.velocity[row]));
            off = fmax(off, arm * fabs(work->trial.velocity[row] - work->now.velocity[row]));
        }
    return off <= DMB_STEADY_LIKE * most;
}

/* Refused only if the nodes of the state have the velocities of the steady motion: a state that statics found at rest
 * is assessed although its drives move. The message of the selection is dropped and `work` restored. */
int32_t dmb_steady_refuse_moving(dmb_sim *sim, dmb_sim *work, const char *who)
{
    dmb_steady steady;
    dmb_evaluation evaluation;
    memset(&evaluation, 0, sizeof evaluation);
    evaluation.sim = work;
    evaluation.time = work->clock->time;
    evaluation.load_factor = 1.0;
    dmb_state_back_up(work);
    int32_t status = dmb_steady_choose(work, DMB_STEADY_AUTO, 0, &steady);
    int like = 0;
    if (status >= 0 && steady.kind != DMB_STEADY_AT_REST) {
        status = dmb_steady_move(&steady, &evaluation, 1.0);
        like = status >= 0 && is_moving_so(work);
    }
    const char *const kind = steady.kind == DMB_STEADY_RIGID ? "turns as a whole" : "slides or turns in itself";
    dmb_steady_release(&steady);
    dmb_state_restore(work);
    dmb_message_clear(&work->message);
    if (!like) return dmb_is_final(status) ? status : DMB_OK;
    dmb_message_set(
        &sim->message,
        "%s: the state %s by its motion drives, and is assessed at rest only; call dmb_analysis_static with "
        "DMB_STEADY_AT_REST first, for the friction of sliding with slip_axial and slip_rotation here too",
        who, kind);
    return DMB_ERR_UNSUPPORTED;
}

int32_t dmb_steady_choose(dmb_sim *sim, int32_t wanted, int assumed, dmb_steady *out)
{
    int moving = 0;
    memset(out, 0, sizeof *out);
    out->kind = DMB_STEADY_AT_REST;
    if (wanted == DMB_STEADY_AT_REST || (wanted == DMB_STEADY_AUTO && assumed)) return DMB_OK;
    const int32_t status = prescribe(sim);
    if (status < 0) return status;
    for (uint32_t i = 0; i < sim->scene->drive_count; i++) moving = moving || moves(sim, i);
    return moving ? choose(sim, wanted, out) : DMB_OK;
}
