/* Messages of failed static analyses: the part, the value with its bound, and the remedy. */
#include <math.h>

#include "analysis/static/static.h"
#include "math/vec3.h"
#include "sim/node.h"
#include "system/assemble/caller_force.h"
#include "system/constrain/constrain.h"

static int is_constrained(const dmb_scene *scene, const dmb_string_map *string, uint32_t component)
{
    for (uint32_t i = 0; i < scene->constrained_count; i++)
        if (scene->constrained_component[i] == component &&
            scene->constrained_node[i] - string->first_node < string->node_count)
            return 1;
    for (uint32_t k = 0; k < scene->bit_count; k++)
        if (scene->bits[k].law.kind != DMB_ROCK_NONE && scene->bits[k].node - string->first_node < string->node_count)
            return 1;
    return scene->chains[scene->node_chain[string->first_node]].jointed; /* joints may constrain it */
}

/* Names a string without axial constraint: it moves along without bound, which appears as poses that do not converge or
 * as excessive element rotation. */
static void name_free_string(dmb_sim *sim, int32_t status)
{
    const dmb_scene *scene = sim->scene;
    if (status != DMB_ERR_NO_CONVERGENCE && status != DMB_ERR_ROTATION) return;
    for (uint32_t i = 0; i < scene->string_count; i++) {
        const dmb_message said = sim->message;
        dmb_message string;
        if (is_constrained(scene, scene->strings + i, DMB_X)) continue;
        dmb_message_set(&sim->message,
                        "static: %s: nothing holds it along its axis, give it a drive, a support or a "
                        "joint; %s",
                        dmb_string_text(scene, i, &string), said.text);
        return;
    }
}

/* A string that slides further than this part of its length does not rest where it was. */
#define DMB_SLID 0.1

/* [m] by which the rig end of a string that nothing holds along its hole slid there. */
static double slide(const dmb_sim *sim, const dmb_string_map *string)
{
    const size_t at = 3 * (size_t)string->start_node;
    double way[3];
    if (is_constrained(sim->scene, string, DMB_X)) return 0.0;
    dmb_vec3_sub(sim->trial.displacement + at, sim->now.displacement + at, way);
    return dmb_vec3_norm(way);
}

int dmb_static_note_slide(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0; i < scene->string_count && scene->has_hole; i++) {
        const double slid = slide(sim, scene->strings + i);
        dmb_message string;
        if (!(slid > DMB_SLID * scene->strings[i].length)) continue;
        dmb_message_set(&sim->message,
                        "static: %s: it slid %g m along its hole to where weight and loads balance, because no support "
                        "or motion drive holds it and drives of a force hold nothing at rest; give it a drive of "
                        "component x that prescribes its motion",
                        dmb_string_text(scene, i, &string), slid);
        return 1;
    }
    return 0;
}

/* Possible motion of the part of a node, as text. */
static const char *way_out(const dmb_scene *scene, uint32_t node)
{
    for (uint32_t i = 0; i < scene->string_count; i++) {
        const dmb_string_map *string = scene->strings + i;
        if (node - string->first_node >= string->node_count) continue;
        const int along = is_constrained(scene, string, DMB_X), about = is_constrained(scene, string, DMB_RX);
        if (!along && !about) return "it may slide along and spin about its axis";
        if (!along) return "it may slide along its axis";
        return about ? "it may move" : "it may spin about its axis";
    }
    return "it may move";
}

/* Advice on a force controller: at rest it returns its present force, constrains no position, and cannot exceed its
 * limit. */
static const char *controller(const dmb_sim *sim, int limited_only, dmb_message *text)
{
    dmb_message name;
    for (uint32_t i = 0; i < sim->scene->drive_count; i++) {
        const dmb_scene_drive *drive = sim->scene->drives + i;
        const double force = sim->trial.drives[i].force;
        const int high = force >= drive->limit_high, low = force <= drive->limit_low;
        if (drive->kind != DMB_DRIVE_CONTROL || (limited_only && !high && !low)) continue;
        dmb_drive_text(sim->scene, i, &name);
        if (high || low)
            dmb_message_set(text, "; %s is at its limit_%s = %g: widen it, or lower the load", name.text,
                            high ? "high" : "low", force);
        else
            dmb_message_set(text, "; %s is a controller: at rest it gives %g and holds nothing, a motion drive would",
                            name.text, force);
        return text->text;
    }
    return NULL;
}

/* Advice on joints near a gimbal singularity: springs, drives and couplings of angles that are undefined at a right
 * angle of RZ jump there, and no equilibrium exists near it. */
#define DMB_NEAR_GIMBAL_SINGULARITY 0.9 /* of 1 - cos RZ: 84 degrees */

static const char *gimbal_singularity_of_joint(const dmb_static_search *search, dmb_message *text)
{
    dmb_message name;
    const dmb_scene *scene = search->sim->scene;
    if (!(search->gimbal_margin > DMB_NEAR_GIMBAL_SINGULARITY)) return NULL;
    dmb_constraint_text(scene, scene->joints[search->gimbal_joint].constraint, &name);
    dmb_message_set(
        text,
        "; %s came to |RZ| = %g rad: at a right angle its RX and RY jump, and their springs: turn its frames, "
        "or use stiffer springs",
        name.text, acos(1.0 - search->gimbal_margin));
    return text->text;
}

/* Remedy after no convergence, the first that applies: drive at its limit, joint near its gimbal singularity, tension
 * in a bend with long elements, stiff wall, general advice. dmb_static_find_pull overwrites the trial; the remedies
 * that read it come before. */
static const char *remedy(dmb_static_search *search, dmb_message *text)
{
    dmb_static_pull pull;
    dmb_static_stiff_wall wall;
    dmb_message string;
    const char *drive = controller(search->sim, 1, text), *gimbal_margin = gimbal_singularity_of_joint(search, text);
    if (drive != NULL) return controller(search->sim, 1, text);
    if (gimbal_margin != NULL) return gimbal_margin;
    if (dmb_static_find_pull(search, &pull) > 0 && pull.element > DMB_SHORT_ELEMENT * pull.bending) {
        dmb_message_set(text,
                        "; %s is pulled by T = %g N round a bend: with sqrt(EI/T) = %g m take elements of %g m, "
                        "not %g m, or a softer wall",
                        dmb_string_text(search->sim->scene, pull.string, &string), pull.tension, pull.bending,
                        DMB_SHORT_ELEMENT * pull.bending, pull.element);
        return text->text;
    }
    if (dmb_static_find_stiff_wall(search->sim->scene, &wall)) {
        dmb_message_set(
            text,
            "; the wall is stiff: the weight presses it in by %g m, the clearance is %g m: elements of %g m, not "
            "%g m, or a stiffness of %g, not %g, may get there",
            wall.depth, wall.clearance, 0.25 * wall.element, wall.element, wall.softer,
            search->sim->scene->normal_law.stiffness);
        return text->text;
    }
    return search->sim->scene->site_count > 0
               ? "; shorter elements, a softer wall, more load_steps or a run in time with damping may get there"
               : "; more load_steps, shorter elements or a run in time with damping may get there";
}

/* The first cause that applies: a callback, a gimbal flip, constraints that cannot be satisfied, a spin without
 * balance, a singular block, excessive rotation of an element, no convergence. If a string has no axial constraint, the
 * last two are its consequences, therefore it is named in front of them. */
void dmb_static_explain(dmb_static_search *search, int32_t status)
{
    dmb_sim *sim = search->sim;
    dmb_owner owner;
    dmb_message text;
    if (status == DMB_ERR_CALLBACK && dmb_failed_force(sim, &text)) {
        dmb_message owner_text = text;
        dmb_message_set(&sim->message, "static: %s: its callback failed or gave a value beyond +-1e30 at time %g",
                        owner_text.text, search->evaluation.time);
    } else if (status == DMB_ERR_GEOMETRY) {
        (void)dmb_joints_refuse_gimbal_flip(sim); /* the trial still contains that pose */
    } else if (sim->scene->cluster_count && sim->reduced_mode->row != DMB_NONE) {
        dmb_clusters_explain(sim, "its equations cannot be satisfied");
    } else if (status == DMB_ERR_SINGULAR && search->unbalanced != DMB_NONE) {
        owner = dmb_owner_of_node(sim->scene, search->block);
        dmb_message_set(&sim->message,
                        "static: %s: nothing holds it about its axis, and the torques on it sum to %g N m, must be 0: "
                        "balance them, or give its RX a motion drive, support, joint or spring",
                        owner.text.text, search->spins[search->unbalanced].torque);
    } else if (status == DMB_ERR_SINGULAR) {
        owner = dmb_owner_of_node(sim->scene, search->block);
        const char *drive = controller(sim, 0, &text);
        dmb_message_set(
            &sim->message,
            "static: %s: nothing holds it, the stiffness is singular: %s; give it a support, drive, joint or "
            "spring%s",
            owner.text.text, way_out(sim->scene, search->block), drive != NULL ? drive : "");
    } else if (status == DMB_ERR_ROTATION) {
        owner = dmb_owner_of_element(sim->scene, search->evaluation.element);
        const char *drive = controller(sim, 1, &text);
        dmb_message_set(&sim->message,
                        "static: %s: relative rotation in one element above 2.5 rad: take more elements%s",
                        owner.text.text, drive != NULL ? drive : "");
    } else if (status == DMB_ERR_CALLBACK) {
        dmb_message_set(&sim->message, "static: the callback of a time function or constraint failed at time %g",
                        search->evaluation.time);
    } else {
        dmb_message_set(&sim->message, "static: %u iterations, relative residual = %g, must be <= %g%s",
                        search->iterations, search->residual, search->options->tolerance, remedy(search, &text));
    }
    name_free_string(sim, status);
}
