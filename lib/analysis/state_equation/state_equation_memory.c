/* Parts of a scene whose forces depend on more than pose, velocity and time, so that no f(t, y) of
 * eq:joints.state-equation exists. Two kinds are refused:
 *
 *     memory of forces    wall that is cut, bristle friction and the caller's friction, restitution by the impact
 *                         speed, rock, stuck points, integral gains, actuators with dynamics, states of forces
 *     path of positions   motion drives about axes that turn, nonholonomic constraints: rows of y would not suffice
 *
 * A part that is refused names the setting without memory, if one exists. */
#include "analysis/state_equation/state_equation.h"
#include "sim/node.h"
#include "system/assemble/actuators.h"
#include "system/constrain/constrain.h"

static int32_t refuse(dmb_sim *sim, const char *part, const char *why)
{
    dmb_message_set(&sim->message, "state equation: %s: %s", part, why);
    return DMB_ERR_UNSUPPORTED;
}

/* Restitution laws damp by the speed at which the contact began. */
static int depends_on_impact(const dmb_scene *scene)
{
    const dmb_normal_law *law = &scene->normal_law;
    if (scene->site_count == 0 || law->kind == DMB_NORMAL_NONE) return 0;
    if (law->kind == DMB_NORMAL_KELVIN_VOIGT || law->kind == DMB_NORMAL_IMPACT) return 0;
    return law->mu != 0.0 || scene->hole.pieces > 0;
}

static int32_t check_wall(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    if (scene->hole.cuts > 0)
        return refuse(sim, "wall", "bits cut it, so that it depends on the path; take cut_spacing = 0");
    if (scene->site_count + scene->axial_torsional_site_count > 0 && dmb_scene_has_bristles(scene))
        return refuse(sim, "wall",
                      scene->friction_law.kind == DMB_FRICTION_CALLBACK
                          ? "friction_law = DMB_FRICTION_CALLBACK depends on the last accepted state; take another law"
                          : "friction_law = DMB_FRICTION_BRISTLE has a memory, its bristles; take another law");
    if (depends_on_impact(scene))
        return refuse(sim, "wall",
                      "normal_law depends on the speed at which a contact began; take DMB_NORMAL_KELVIN_VOIGT or "
                      "_IMPACT, or restitution = 1 without sections of the hole");
    return DMB_OK;
}

static int32_t check_bits_and_places(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t k = 0; k < scene->bit_count; k++)
        if (scene->bits[k].law.kind != DMB_ROCK_NONE)
            return refuse(sim, dmb_owner_of_node(scene, scene->bits[k].node).text.text,
                          "its rock_law depends on the rock cut so far; take DMB_ROCK_NONE and a load");
    for (uint32_t i = 0; i < scene->stuck_count; i++)
        if (sim->stuck_held[i])
            return refuse(sim, "stuck place",
                          "it is stuck until its force has been too large once, which is a memory; hold it by springs");
    return DMB_OK;
}

/* 1: another component of rotation of the driven node is free, across the axis of the drive, so that the integral of a
 * body-frame velocity depends on the path. */
static int depends_on_path(const dmb_scene *scene, const dmb_scene_drive *drive)
{
    const dmb_block_layout *layout = &scene->layout;
    if (drive->kind != DMB_DRIVE_MOTION || drive->joint != DMB_NONE) return 0;
    if (layout->size[drive->node] != DMB_NODE_SIX_DOF) return 0;
    for (uint32_t c = DMB_RX; c <= DMB_RZ; c++) {
        int moves = scene->solved_row[layout->row[drive->node] + c] != 0;
        for (uint32_t i = 0; i < scene->drive_count; i++)
            moves |= scene->drives[i].kind == DMB_DRIVE_MOTION && scene->drives[i].row == layout->row[drive->node] + c;
        if (moves && c != (uint32_t)drive->component % 3 + DMB_RX) return 1;
    }
    return 0;
}

static int32_t check_drives(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0; i < scene->drive_count; i++) {
        const dmb_scene_drive *drive = scene->drives + i;
        dmb_message name;
        (void)dmb_drive_text(scene, i, &name);
        if (drive->kind == DMB_DRIVE_CONTROL && drive->integral_gain != 0.0)
            return refuse(sim, name.text, "integral_gain > 0 integrates its error, which is a memory; take 0");
        if (!dmb_actuator_is_direct(scene, i))
            return refuse(sim, name.text, "its actuator has a memory; take delay, force_rate and lag = 0");
        if (depends_on_path(scene, drive))
            return refuse(sim, name.text,
                          "it moves a part along or about an axis that turns, so that its position depends on the "
                          "path; drive a joint instead");
    }
    return DMB_OK;
}

static int is_nonholonomic(const dmb_scene *scene, const dmb_constraint *c)
{
    if (c->kind == DMB_OF_CALLBACK) return scene->callbacks[c->index].kind == DMB_CONSTRAINT_NONHOLONOMIC;
    if (c->kind != DMB_OF_JOINT) return 0;
    return scene->joints[c->index].kind == DMB_JOINT_KNIFE_EDGE || scene->joints[c->index].kind == DMB_JOINT_ROLLING;
}

static int32_t check_constraints(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0; i < scene->constraint_count; i++) {
        dmb_message name;
        if (!is_nonholonomic(scene, scene->constraints + i)) continue;
        dmb_constraint_text(scene, i, &name);
        return refuse(sim, name.text,
                      "it is an equation of velocities (nonholonomic), so that positions depend on the path");
    }
    return DMB_OK;
}

static int32_t check_forces(dmb_sim *sim)
{
    for (uint32_t i = 0; i < sim->scene->force_count; i++) {
        const dmb_scene_force *force = sim->scene->forces + i;
        dmb_message name;
        if (force->states == 0) continue;
        (void)dmb_part_text(&name, "force", i, force->name, sizeof force->name);
        return refuse(sim, name.text, "its law has a state (state_count > 0), which is a memory; take a law without");
    }
    return DMB_OK;
}

int32_t dmb_state_check_memory(dmb_sim *sim)
{
    int32_t status = check_wall(sim);
    if (status >= 0) status = check_forces(sim);
    if (status >= 0) status = check_bits_and_places(sim);
    if (status >= 0) status = check_drives(sim);
    return status < 0 ? status : check_constraints(sim);
}
