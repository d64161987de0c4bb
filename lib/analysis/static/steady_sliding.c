/* Strings that slide and rotate, inertial axes: velocities from the drives, and conditions that exclude the motion. The
 * symmetry of this relative equilibrium is the rotation of each string about its own axis; a part whose force depends
 * on the rotation angle is refused:
 *
 *     part of a string that moves            condition                        checked by
 *     masses, rest shape                     axisymmetric, straight           check_round
 *     load or drive force in body axes       along or about the axis          check_turning_loads
 *     actuator                               not along a component that moves check_turning_loads
 *     support along or about the axis        the string does not move there   check_ends
 *     motion drive elsewhere                 speed 0                          set_speed */
#include <math.h>
#include <string.h>

#include "analysis/static/static.h"
#include "sim/node.h"

/* Refuses a string that rotates about its own axis if its masses are not axisymmetric (unbalance force g[1], g[2] and
 * couple g[4], g[5] of eq:motion.unbalance, transverse moments of inertia that differ) or its rest shape is bent
 * (components 4 and 5 of the rest strain). */
static int32_t check_round(dmb_sim *sim, const dmb_steady *steady)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0; i < scene->rigid_mass_count; i++) {
        const dmb_rigid_mass *rigid_mass = scene->rigid_masses + i;
        const uint32_t s = steady->string[rigid_mass->node];
        double g[6];
        if (s == DMB_NONE || steady->speed[2 * s + 1] == 0.0 ||
            scene->layout.size[rigid_mass->node] != DMB_NODE_SIX_DOF)
            continue;
        dmb_unbalance_of(scene, i, g);
        const int round =
            g[1] == 0.0 && g[2] == 0.0 && g[4] == 0.0 && g[5] == 0.0 &&
            fabs(rigid_mass->inertia[1] - rigid_mass->inertia[2]) <= DMB_STEADY_SAME * rigid_mass->inertia[1];
        const dmb_owner owner = dmb_owner_of_node(scene, rigid_mass->node);
        if (!round)
            return DMB_STEADY_REFUSE(
                sim,
                "%s: its mass is not round about its axis, so that turning about an axis at rest is "
                "not steady; leave the eccentricity out, or take DMB_STEADY_RIGID or _AT_REST",
                owner.text.text);
    }
    for (uint32_t e = 0; e < scene->element_count; e++) {
        const uint32_t s = steady->string[scene->element_node[e]];
        const double *rest = scene->types[scene->element_type[e]].rest;
        if (steady->speed[2 * s + 1] == 0.0 || (rest[4] == 0.0 && rest[5] == 0.0)) continue;
        const dmb_owner owner = dmb_owner_of_element(scene, e);
        return DMB_STEADY_REFUSE(sim,
                                 "%s: it is bent when unloaded, so that turning about an axis at rest is not steady; "
                                 "take DMB_STEADY_AT_REST",
                                 owner.text.text);
    }
    return DMB_OK;
}

static int across(const double f[3])
{
    return f[1] != 0.0 || f[2] != 0.0;
}

/* Refuses lateral loads and drive forces that rotate with a rotating string. */
static int32_t check_turning_loads(dmb_sim *sim, const dmb_steady *steady)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0; i < scene->load_count; i++) {
        const dmb_scene_load *load = scene->loads + i;
        const uint32_t s = steady->string[load->node];
        if (s == DMB_NONE || steady->speed[2 * s + 1] == 0.0 || load->frame != DMB_FRAME_BODY) continue;
        if (across(load->force) || across(load->moment))
            return DMB_STEADY_REFUSE(
                sim,
                "%s: it turns with its string, across the axis; take DMB_STEADY_AT_REST, or another "
                "frame for it",
                dmb_load_text(sim->scene, i, &(dmb_message){""}));
    }
    for (uint32_t i = 0; i < scene->drive_count; i++) {
        const dmb_scene_drive *drive = scene->drives + i;
        if (drive->kind == DMB_DRIVE_MOTION || drive->node == DMB_NONE) continue;
        const uint32_t s = steady->string[drive->node];
        if (s != DMB_NONE && drive->actuator != DMB_NONE && drive->component % 3 == 0 &&
            steady->speed[2 * s + (uint32_t)drive->component / 3] != 0.0)
            return DMB_STEADY_REFUSE(
                sim, "%s: its actuator has a force by speed that statics do not know; take DMB_STEADY_AT_REST",
                dmb_drive_text(sim->scene, i, &(dmb_message){""}));
        if (drive->component % 3 == 0) continue;
        if (s != DMB_NONE && steady->speed[2 * s + 1] != 0.0)
            return DMB_STEADY_REFUSE(sim,
                                     "%s: its force turns with its string, across the axis; take DMB_STEADY_AT_REST",
                                     dmb_drive_text(sim->scene, i, &(dmb_message){""}));
    }
    return DMB_OK;
}

/* Speeds of the strings [m/s, rad/s]. At most one drive moves a component of a rig end. */
static int32_t set_speed(dmb_sim *sim, dmb_steady *steady, uint32_t i)
{
    const dmb_scene_drive *drive = sim->scene->drives + i;
    if (drive->kind != DMB_DRIVE_MOTION) return DMB_OK;
    const uint32_t s = drive->node == DMB_NONE ? DMB_NONE : steady->string[drive->node];
    const double speed = dmb_steady_target(sim, i);
    if (s == DMB_NONE || drive->component % 3 != 0)
        return speed == 0.0
                   ? DMB_OK
                   : DMB_STEADY_REFUSE(sim,
                                       "%s: it does not move a string along or about its axis, so that strings do "
                                       "not slide at rest; take DMB_STEADY_RIGID or _AT_REST",
                                       dmb_drive_text(sim->scene, i, &(dmb_message){""}));
    steady->speed[2 * s + (uint32_t)drive->component / 3] = speed;
    return DMB_OK;
}

static int is_driven(const dmb_scene *scene, uint32_t row)
{
    for (uint32_t k = 0; k < scene->drive_count; k++)
        if (scene->drives[k].kind == DMB_DRIVE_MOTION && scene->drives[k].row == row) return 1;
    return 0;
}

/* Refuses a support that constrains a string in its direction of motion: it would compress the string or wind it up. */
static int32_t check_ends(dmb_sim *sim, const dmb_steady *steady)
{
    dmb_message string;
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0; i < scene->constrained_count; i++) {
        const uint32_t node = scene->constrained_node[i], s = steady->string[node], c = scene->constrained_component[i];
        const uint32_t half = scene->layout.size[node] / 2;
        if (s == DMB_NONE || c % half != 0 || is_driven(scene, scene->layout.row[node] + c)) continue;
        const double speed = steady->speed[2 * s + c / half];
        if (speed == 0.0) continue;
        return DMB_STEADY_REFUSE(
            sim,
            "%s: a support keeps it from %s, a drive moves it at %g, which is not steady; free the support, "
            "or take DMB_STEADY_AT_REST",
            dmb_string_text(scene, s, &string), c == 0 ? "sliding" : "turning", speed);
    }
    return DMB_OK;
}

int32_t dmb_steady_choose_sliding(dmb_sim *sim, dmb_steady *steady)
{
    const dmb_scene *scene = sim->scene;
    int32_t status = DMB_OK;
    steady->kind = DMB_STEADY_SLIDING;
    memset(steady->speed, 0, 2 * (size_t)scene->string_count * sizeof(double));
    for (uint32_t i = 0; i < scene->drive_count && status >= 0; i++) status = set_speed(sim, steady, i);
    if (status >= 0) status = check_ends(sim, steady);
    if (status >= 0) status = check_round(sim, steady);
    return status < 0 ? status : check_turning_loads(sim, steady);
}
