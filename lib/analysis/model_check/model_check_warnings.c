/* Warnings about a scene, one line per kind: the first or worst case by name, and the number of others. They are for
 * values that compile accepts but that a user has rarely meant:
 *
 *     equations   redundant, rank in dispute, nearly redundant, violated in the present pose
 *     joints      near a gimbal singularity that their forces or couplings feel; drives of open or locked ones
 *     support     groups of parts that fall; a load on a bit that only friction bears
 *     mass        nodes with nearly none; bent elements with the mass of straight ones (eq:curved.kinetic-energy)
 *     values      unusual for drill pipe, holes and mud (unusual_values.c)
 *     hole        parts outside it, sideways or lengthwise; no contact; contact points on supports; coarse mesh */
#include <float.h>
#include <math.h>

#include "analysis/model_check/model_check.h"
#include "math/vec3.h"
#include "model/model.h"
#include "sim/node.h"
#include "system/constrain/constrain.h"

#define DMB_POOR_CONDITION 1e-4  /* smallest over largest singular value of the equations */
#define DMB_LARGE_VIOLATION 1e-8 /* [m, -] largest residual of a position equation */
#define DMB_SMALL_MASS 1e-9      /* relative to the largest one */
#define DMB_NEARLY_SQUARE 0.05   /* [rad] distance to the singularity of coordinates or equations */
#define DMB_SUNK 0.01            /* of the hole's radius: deeper than a part lying on the wall */
#define DMB_TOUCHES 1e-4         /* of the hole's radius: rounding of described diameters, 5 um in a hole of 94 mm */
#define DMB_DEPTH_ROUNDING 1e-6  /* [m] */

/* Receiver of the lines. */
typedef struct sink {
    const dmb_model_check *findings;
    const dmb_sim *sim;
    const dmb_scene *scene;
    dmb_model_check_line_fn line;
    void *context;
} sink;

static void say(const sink *to, const dmb_message *text)
{
    to->line(to->context, text->text);
}

/* " (and 3 more)", or an empty text. */
static const char *more(uint32_t count, dmb_message *text)
{
    dmb_message_clear(text);
    if (count > 1) dmb_message_set(text, " (and %u more)", count - 1);
    return text->text;
}

static const char *node_name(const dmb_scene *scene, uint32_t node, dmb_message *text)
{
    *text = dmb_owner_of_node(scene, node).text;
    return text->text;
}

static const char *joint_name(const dmb_scene *scene, uint32_t j, dmb_message *text)
{
    dmb_constraint_text(scene, scene->joints[j].constraint, text);
    return text->text;
}

/* ---- Equations --------------------------------------------------------------------------------------------------- */

static void redundancy(const sink *to)
{
    dmb_message text;
    const uint32_t count = to->findings->report.redundant;
    if (count == 0) return;
    dmb_message_set(
        &text, "redundant: %u equation(s) that others imply; their joints' reactions are those of least norm", count);
    say(to, &text);
}

/* Two decisions on rank: singular values by LAPACK, pivots of the partition. They differ if a singular value is near
 * the tolerance of both. */
static void disagreement(const sink *to)
{
    dmb_message text;
    if (to->findings->rank.differing == 0) return;
    dmb_message_set(&text,
                    "rank: LAPACK and the partition differ in %u cluster(s): equations there are all but redundant",
                    to->findings->rank.differing);
    say(to, &text);
}

static void conditioning(const sink *to)
{
    const dmb_cluster_rank *rank = &to->findings->rank;
    dmb_message text, owner;
    if (!(rank->condition < DMB_POOR_CONDITION)) return;
    dmb_constraint_text(to->scene, to->scene->clusters[rank->poorest].constraint, &owner);
    dmb_message_set(&text,
                    "conditioning: equations around %s are nearly redundant, smallest singular value %g of the largest",
                    owner.text, rank->condition);
    say(to, &text);
}

static void violation(const sink *to)
{
    const dmb_cluster_rank *rank = &to->findings->rank;
    dmb_message text, row;
    if (!(rank->violation > DMB_LARGE_VIOLATION)) return;
    dmb_constraint_row_text(to->sim, rank->violation_row, &row);
    dmb_message_set(&text, "violation: %s is off by %g", row.text, rank->violation);
    say(to, &text);
}

/* ---- Joints ------------------------------------------------------------------------------------------------------ */

static int in_coupling(const dmb_scene *scene, uint32_t j)
{
    for (uint32_t i = 0; i < scene->coupling_count; i++)
        for (uint32_t k = 0; k < scene->couplings[i].count; k++)
            if (scene->couplings[i].joint[k] == j && scene->couplings[i].component[k] >= DMB_RX) return 1;
    return 0;
}

static int in_drive(const dmb_scene *scene, uint32_t j)
{
    for (uint32_t i = 0; i < scene->drive_count; i++)
        if (scene->drives[i].joint == j && scene->drives[i].component >= DMB_RX) return 1;
    return 0;
}

/* 1: an angle RX or RY is used while RZ is near a right angle (constraint/joint.h), or a rim lies nearly flat. */
static int nearly_singular(const dmb_sim *sim, uint32_t j)
{
    const dmb_scene_joint *joint = sim->scene->joints + j;
    const int uses_angles = joint->law_mask >> DMB_RX != 0 || in_drive(sim->scene, j) || in_coupling(sim->scene, j);
    dmb_relative relative;
    if (sim->joint_state[j] == DMB_JOINT_OPEN) return 0;
    if (!uses_angles && joint->kind != DMB_JOINT_ROLLING) return 0;
    dmb_joint_motion_of(sim->scene, &sim->now, j, &relative, NULL);
    if (joint->kind == DMB_JOINT_ROLLING && fabs(relative.R[0]) > cos(DMB_NEARLY_SQUARE)) return 1;
    return uses_angles && fabs(relative.R[3]) > cos(DMB_NEARLY_SQUARE);
}

static void singular_joints(const sink *to)
{
    dmb_message text, name, rest;
    uint32_t count = 0, first = 0;
    for (uint32_t j = 0; j < to->scene->joint_count; j++) {
        if (!nearly_singular(to->sim, j)) continue;
        if (count++ == 0) first = j;
    }
    if (count == 0) return;
    dmb_message_set(&text, "%s%s: nearly singular, its angles are all but undefined here",
                    joint_name(to->scene, first, &name), more(count, &rest));
    say(to, &text);
}

static void idle_drives(const sink *to)
{
    for (uint32_t i = 0; i < to->scene->drive_count; i++) {
        const uint32_t j = to->scene->drives[i].joint;
        dmb_message text, name, drive;
        if (j == DMB_NONE || to->sim->joint_state[j] == DMB_JOINT_ACTIVE) continue;
        dmb_message_set(&text, "%s: %s is %s", dmb_drive_text(to->scene, i, &drive), joint_name(to->scene, j, &name),
                        to->sim->joint_state[j] == DMB_JOINT_OPEN ? "open, the drive does nothing" : "locked");
        say(to, &text);
    }
}

/* ---- Support and mass -------------------------------------------------------------------------------------------- */

static void unconstrained_parts(const sink *to)
{
    dmb_message text, name, rest;
    const dmb_unconstrained_parts *unconstrained = &to->findings->unconstrained;
    if (unconstrained->groups == 0) return;
    dmb_message_set(&text, "%s%s: no support, drive, joint, spring or wall holds it against gravity, it will fall",
                    node_name(to->scene, unconstrained->node, &name), more(unconstrained->groups, &rest));
    say(to, &text);
}

/* 1: parts whose force along a string is not looked into may bear a load on its bit. */
static int other_parts(const dmb_scene *scene)
{
    return scene->joint_count + scene->callback_count + scene->spring_count + scene->force_count + scene->stuck_count +
               scene->load_count >
           0;
}

/* 1: a support or a drive holds the string along its axis. */
static int is_held_along(const dmb_scene *scene, const dmb_string_map *string)
{
    const uint32_t start = scene->layout.row[string->start_node] + DMB_X,
                   end = scene->layout.row[string->end_node] + DMB_X;
    if (!scene->free_row[start] || !scene->free_row[end]) return 1;
    for (uint32_t i = 0; i < scene->drive_count; i++)
        if (scene->drives[i].node == string->start_node && scene->drives[i].component == DMB_X) return 1;
    return 0;
}

/* Warns of a load on a bit that nothing but friction bears. */
static void pushed_strings(const sink *to)
{
    dmb_message text, name;
    const dmb_scene *scene = to->scene;
    if (other_parts(scene)) return;
    for (uint32_t i = 0; i < scene->string_count; i++) {
        const dmb_string_map *string = scene->strings + i;
        for (uint32_t k = 0; k < scene->bit_count; k++) {
            if (scene->bits[k].node != string->end_node || scene->bits[k].load == DMB_NONE) continue;
            if (is_held_along(scene, string)) continue;
            dmb_message_set(&text,
                            "%s: no drive along it bears the load on its bit, which pushes it out of the hole; add a "
                            "drive with component = x",
                            dmb_string_text(scene, i, &name));
            say(to, &text);
        }
    }
}

/* Mass of a node [kg], and its smallest moment of inertia [kg m2], from rigid_mass and neighbouring elements. */
static void mass_of(const dmb_scene *scene, uint32_t node, const dmb_rigid_mass **rigid_mass, double out[2])
{
    double inertia[3] = {0.0, 0.0, 0.0};
    out[0] = 0.0;
    if (*rigid_mass != scene->rigid_masses + scene->rigid_mass_count && (*rigid_mass)->node == node) {
        out[0] += (*rigid_mass)->mass;
        dmb_vec3_add(inertia, (*rigid_mass)->inertia, inertia);
        ++*rigid_mass;
    }
    for (uint32_t side = 0; side < 2; side++) {
        const uint32_t e = dmb_element_between(scene, node, side);
        if (e == DMB_NONE) continue;
        const dmb_beam_mass *mass = &scene->types[scene->element_type[e]].mass;
        out[0] += mass->axial[0] + mass->axial[1];
        inertia[0] += mass->torsion[0] + mass->torsion[1];
        inertia[1] += mass->bending[1][4];
        inertia[2] += mass->bending[0][4];
    }
    out[1] = scene->layout.size[node] == DMB_NODE_AXIAL_TORSIONAL ? inertia[0]
                                                                  : fmin(inertia[0], fmin(inertia[1], inertia[2]));
}

static void small_masses(const sink *to)
{
    static const char *const what[2] = {"mass", "moment of inertia"}, *const unit[2] = {"kg", "kg m2"};
    const dmb_rigid_mass *rigid_mass = to->scene->rigid_masses;
    double low[2] = {DBL_MAX, DBL_MAX}, high[2] = {0.0, 0.0}, here[2];
    uint32_t where[2] = {0, 0};
    dmb_message text, name;
    for (uint32_t i = 0; i < to->scene->node_count; i++) {
        mass_of(to->scene, i, &rigid_mass, here);
        for (int k = 0; k < 2; k++) {
            high[k] = fmax(high[k], here[k]);
            if (!(here[k] < low[k])) continue;
            low[k] = here[k];
            where[k] = i;
        }
    }
    for (int k = 0; k < 2; k++) {
        if (low[k] >= DMB_SMALL_MASS * high[k]) continue;
        dmb_message_set(&text, "%s: %s of %g %s is next to nothing beside the largest, %g %s",
                        node_name(to->scene, where[k], &name), what[k], low[k], unit[k], high[k], unit[k]);
        say(to, &text);
    }
}

/* Warns of bent elements with constant mass, which is that of straight elements. */
static void bent_elements(const sink *to)
{
    const dmb_bent_elements bent = dmb_find_bent(to->sim);
    dmb_message text, name, rest;
    if (bent.beyond == 0) return;
    dmb_message_set(&text,
                    "%s%s: an element with the mass of a straight one is bent by %g rad, above 0.01 rad: its momentum "
                    "and inertia are wrong by up to %g %%; divide the pipe into more elements",
                    node_name(to->scene, bent.node, &name), more(bent.beyond, &rest), bent.bend, 100.0 * bent.error);
    say(to, &text);
}

/* ---- Hole -------------------------------------------------------------------------------------------------------- */

/* [m] Largest penetration without a warning. In the described pose it is the precision of the description plus the
 * rounding of positions; later it allows for the deflection of the wall under parts that lie on it. */
static double allowed_penetration(const dmb_sim *sim, uint32_t node)
{
    const double *u = sim->now.displacement + 3 * (size_t)node;
    const double radius = dmb_hole_radius(&sim->scene->hole, sim->scene->reference_depth[node]);
    if (dmb_vec3_norm(u) > 0.0) return DMB_SUNK * radius;
    return DMB_TOUCHES * radius + 1e-12 * (1.0 + dmb_vec3_norm(sim->scene->reference_position + 3 * (size_t)node));
}

static void outside_sideways(const sink *to)
{
    dmb_message text, name, rest;
    double most = 0.0;
    uint32_t count = 0, worst = 0;
    for (uint32_t s = 0; s < to->scene->site_count; s++) {
        const double here = to->sim->now.site_penetration[s];
        const uint32_t node = to->scene->sites[s].node;
        if (!(here > allowed_penetration(to->sim, node))) continue;
        count++;
        if (!(here > most)) continue;
        most = here;
        worst = node;
    }
    if (count == 0) return;
    dmb_message_set(&text, "%s%s: outside the hole, %g m deep in its wall", node_name(to->scene, worst, &name),
                    more(count, &rest), most);
    say(to, &text);
}

static void outside_lengthwise(const sink *to, int past_end)
{
    const dmb_hole *hole = &to->scene->hole;
    const double end = hole->stations > 0 ? hole->station[hole->stations - 1].depth : DBL_MAX;
    const double start = hole->stations > 0 ? hole->station[0].depth : 0.0;
    uint32_t count = 0, first = 0;
    double by = 0.0;
    dmb_message text, rest, name;
    for (uint32_t i = 0; i < to->scene->string_count; i++) {
        const dmb_string_map *string = to->scene->strings + i;
        const double near = to->scene->reference_depth[string->start_node] + string->start_arm;
        const double far = to->scene->reference_depth[string->end_node] + string->end_arm;
        const double out = past_end ? far - end : start - near;
        if (!(out > DMB_DEPTH_ROUNDING)) continue;
        if (count++ != 0) continue;
        first = i;
        by = out;
    }
    if (count == 0) return;
    dmb_message_set(&text, "%s%s: described %g m %s; the hole continues straight there",
                    dmb_string_text(to->scene, first, &name), more(count, &rest), by,
                    past_end ? "beyond the end of the survey" : "before the start of the hole");
    say(to, &text);
}

/* 1 if a node of the string can leave the axis. */
static int moves_sideways(const dmb_scene *scene, const dmb_string_map *string)
{
    for (uint32_t i = string->first_node; i < string->first_node + string->node_count; i++) {
        const uint8_t *open = scene->free_row + scene->layout.row[i];
        if (scene->layout.size[i] == DMB_NODE_SIX_DOF && (open[DMB_Y] || open[DMB_Z])) return 1;
    }
    return 0;
}

/* Warns of a hole without contact. Contact is a feature of the scene: with it every string that moves laterally has
 * sites, without it none. */
static void no_contact(const sink *to)
{
    dmb_message text, name;
    if (to->scene->features & DMB_FEATURE_CONTACT) return;
    for (uint32_t i = 0; i < to->scene->string_count; i++) {
        const dmb_string_map *string = to->scene->strings + i;
        if (!moves_sideways(to->scene, string)) continue;
        dmb_message_set(&text, "%s: a hole is described, but its wall is not met: no normal law, or contact left out",
                        dmb_string_text(to->scene, i, &name));
        say(to, &text);
        return;
    }
}

static void supported_sites(const sink *to)
{
    dmb_message text;
    for (uint32_t i = dmb_owner_of_supported_site(to->scene, 0, &text); i != DMB_NONE;
         i = dmb_owner_of_supported_site(to->scene, i + 1, &text))
        say(to, &text);
}

void dmb_model_check_warnings(const dmb_model_check *findings, dmb_model_check_line_fn line, void *context)
{
    const sink to = {findings, findings->sim, findings->sim->scene, line, context};
    redundancy(&to);
    disagreement(&to);
    conditioning(&to);
    violation(&to);
    singular_joints(&to);
    idle_drives(&to);
    unconstrained_parts(&to);
    pushed_strings(&to);
    small_masses(&to);
    bent_elements(&to);
    dmb_unusual_values(findings->sim, line, context);
    if (!to.scene->has_hole) return;
    outside_sideways(&to);
    outside_lengthwise(&to, 0);
    outside_lengthwise(&to, 1);
    no_contact(&to);
    supported_sites(&to);
    dmb_mesh_warnings(to.sim->model, line, context);
}
