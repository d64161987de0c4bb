/* Nodes of both sizes seen alike: depth, pose and six-component motion of a node, whether it moves freely or on the
 * axis of the hole; and the part of the description that a node, element or row belongs to, for messages. */
#include "sim/node.h"

#include <math.h>

#include "element/rigid_mass.h"
#include "math/mat6.h"
#include "math/so3.h"
#include "model/model.h"
#include "model/scene.h"

double dmb_axial_torsional_depth(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t node)
{
    return scene->reference_depth[node] + configuration->displacement[3 * node];
}

#define DMB_DETOUR 2.0       /* [-] length along a bent axis over the distance */
#define DMB_DETOUR_LEAST 1.0 /* [-] in mean element lengths */

/* Without a contact point nearby the depth is searched around the described one. A node that moved by u may have slid
 * along a bent axis by more than u: twice the displacement is taken, and one mean element length for a node that did
 * not move. */
static uint32_t segment_without_site(const dmb_scene *scene, const dmb_configuration *known, uint32_t node, double arm,
                                     const double x[3])
{
    const double moved = dmb_vec3_norm(known->displacement + 3 * (size_t)node) + fabs(arm);
    double depth;
    return dmb_hole_search(&scene->hole, x, scene->reference_depth[node] + arm,
                           DMB_DETOUR * moved + DMB_DETOUR_LEAST * scene->length_scale, NULL, &depth);
}

/* In this order: a straight hole has one segment; an axial-torsional node knows its depth; else the nearest contact
 * point knows its own, tracked from step to step, and depths differ as described; else a search. A place on the contact
 * point itself takes the segment that was found for it, since at a station a depth alone can be of either side. */
uint32_t dmb_node_segment(const dmb_scene *scene, const dmb_configuration *known, uint32_t node, double arm,
                          const double x[3])
{
    if (dmb_hole_is_straight(&scene->hole)) return 0;
    if (scene->layout.size[node] == DMB_NODE_AXIAL_TORSIONAL)
        return dmb_hole_segment_at(&scene->hole, dmb_axial_torsional_depth(scene, known, node) + arm);
    const uint32_t s = scene->near_contact[node];
    if (s == DMB_NONE) return segment_without_site(scene, known, node, arm, x);
    const dmb_site *site = scene->sites + s;
    const double described = scene->reference_depth[node] + arm - scene->reference_depth[site->node] - site->offset;
    if (described == 0.0) return known->site_segment[s];
    return dmb_hole_segment_at(&scene->hole, known->site_depth[s] + described);
}

/* Pose of an axial-torsional node (eq:kinematics.path-velocity): the frame at time 0, carried along the hole's axis
 * without twist (eq:hole.carried) from depth s0 to s0 + u, then rotated by `turn` about its x axis. Without a hole, or
 * in a straight one, the axis is the line of its initial x axis. */
static void axial_torsional_pose(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t node,
                                 double rotation[9], double displacement[3])
{
    const double advance = configuration->displacement[3 * node];
    const double spin[3] = {configuration->turn[node], 0.0, 0.0};
    double frame[9], frame_now[9], torsion[9];
    dmb_so3_exp(spin, NULL, torsion);
    dmb_quat_to_matrix(scene->reference_quaternion + 4 * node, frame);
    if (scene->has_hole && !dmb_hole_is_straight(&scene->hole)) {
        const double from = scene->reference_depth[node], to = dmb_axial_torsional_depth(scene, configuration, node);
        double point[3], start[3], carried[9];
        dmb_hole_frame(&scene->hole, from, start, NULL, NULL);
        dmb_hole_frame(&scene->hole, to, point, NULL, NULL);
        dmb_hole_carry(&scene->hole, from, to, carried);
        dmb_mat3_mul(carried, frame, frame_now);
        dmb_mat3_copy(frame_now, frame);
        dmb_vec3_sub(point, start, displacement);
    } else {
        const double along[3] = {advance, 0.0, 0.0};
        dmb_mat3_vec(frame, along, displacement);
    }
    dmb_mat3_mul(frame, torsion, rotation);
}

void dmb_node_pose(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t node, double rotation[9],
                   double displacement[3])
{
    if (scene->layout.size[node] == DMB_NODE_AXIAL_TORSIONAL) {
        axial_torsional_pose(scene, configuration, node, rotation, displacement);
        return;
    }
    dmb_quat_to_matrix(configuration->quaternion + 4 * node, rotation);
    dmb_vec3_copy(configuration->displacement + 3 * node, displacement);
}

/* The two columns of eq:kinematics.path-velocity: per unit of advance e_x and, where the axis bends, the rotation of
 * the carried frame t x k in body axes; per unit of spin the rotation about x. */
void dmb_axial_torsional_columns(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t node,
                                 const double rotation[9], double columns[12])
{
    for (int i = 0; i < 12; i++) columns[i] = 0.0;
    columns[0] = columns[9] = 1.0;
    if (scene->has_hole && !dmb_hole_is_straight(&scene->hole)) {
        double point[3], tangent[3], curvature[3], frame_rate[3];
        dmb_hole_frame(&scene->hole, dmb_axial_torsional_depth(scene, configuration, node), point, tangent, curvature);
        dmb_vec3_cross(tangent, curvature, frame_rate);
        dmb_mat3_tvec(rotation, frame_rate, columns + 3);
    }
}

/* Linear in the rows. For accelerations the part from the change of the columns along the path is not in it. */
void dmb_node_vector(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t node, const double *rows,
                     double vector[6])
{
    const double *row = rows + scene->layout.row[node];
    if (scene->layout.size[node] == DMB_NODE_SIX_DOF) {
        dmb_vec6_copy(row, vector);
        return;
    }
    double rotation[9], displacement[3], columns[12];
    dmb_node_pose(scene, configuration, node, rotation, displacement);
    dmb_axial_torsional_columns(scene, configuration, node, rotation, columns);
    for (int i = 0; i < 6; i++) vector[i] = columns[i] * row[0] + columns[6 + i] * row[1];
}

int dmb_is_quasi_static(const dmb_configuration *configuration)
{
    return configuration->friction_slip[0] != 0.0 || configuration->friction_slip[1] != 0.0;
}

uint32_t dmb_count_six_dof_nodes(const dmb_scene *scene, uint32_t node)
{
    uint32_t end = node;
    if (scene->row_count == DMB_NODE_SIX_DOF * scene->node_count) return scene->node_count - node;
    while (end < scene->node_count && scene->layout.size[end] == DMB_NODE_SIX_DOF) end++;
    return end - node;
}

uint32_t dmb_element_between(const dmb_scene *scene, uint32_t node, uint32_t side)
{
    if (side == 1) return scene->node_element[node];
    return node > 0 ? scene->node_element[node - 1] : DMB_NONE;
}

static uint32_t pipe_at(const dmb_scene *scene, const dmb_string_map *string, uint32_t node)
{
    uint32_t found = 0;
    for (uint32_t i = 0; i < string->pipe_count; i++)
        if (scene->pipes[string->first_pipe + i].node <= node) found = i;
    return found;
}

static void set_text(const dmb_scene *scene, dmb_owner *owner, const char *name, size_t size)
{
    if (owner->kind[0] == 's')
        (void)dmb_model_pipe_text(scene->model, owner->index, owner->pipe, &owner->text);
    else
        dmb_part_text(&owner->text, owner->kind, owner->index, name, size);
}

dmb_owner dmb_owner_of_node(const dmb_scene *scene, uint32_t node)
{
    dmb_owner owner = {"string", 0, 0, {""}};
    for (uint32_t i = 0; i < scene->string_count; i++) {
        const dmb_string_map *string = scene->strings + i;
        if (node < string->first_node || node >= string->first_node + string->node_count) continue;
        owner.index = i;
        owner.pipe = pipe_at(scene, string, node);
        set_text(scene, &owner, NULL, 0);
        return owner;
    }
    owner.kind = "body";
    for (uint32_t i = 0; i < scene->body_count; i++)
        if (scene->bodies[i].node == node) owner.index = i;
    set_text(scene, &owner, scene->body_count > 0 ? scene->bodies[owner.index].name : NULL,
             scene->body_count > 0 ? sizeof scene->bodies[0].name : 0);
    return owner;
}

dmb_owner dmb_owner_of_element(const dmb_scene *scene, uint32_t element)
{
    return dmb_owner_of_node(scene, scene->element_node[element]);
}

uint32_t dmb_node_of_row(const dmb_scene *scene, uint32_t row)
{
    uint32_t low = 0, high = scene->node_count;
    while (high - low > 1) {
        const uint32_t middle = low + (high - low) / 2;
        if (scene->layout.row[middle] <= row)
            low = middle;
        else
            high = middle;
    }
    return low;
}

uint32_t dmb_constraint_of_part(const dmb_sim *sim, dmb_id part)
{
    const dmb_scene *scene = sim->scene;
    const uint32_t joint = dmb_model_part_index(sim->model, part, DMB_PART_JOINT);
    const uint32_t coupling = dmb_model_part_index(sim->model, part, DMB_PART_COUPLING);
    const uint32_t drive = dmb_model_part_index(sim->model, part, DMB_PART_DRIVE);
    const uint32_t callback = dmb_model_part_index(sim->model, part, DMB_PART_CONSTRAINT);
    if (joint < scene->joint_count) return scene->joints[joint].constraint;
    if (coupling < scene->coupling_count) return scene->couplings[coupling].constraint;
    if (drive < scene->drive_count) return scene->drives[drive].constraint;
    return callback < scene->callback_count ? scene->callbacks[callback].constraint : DMB_NONE;
}

uint32_t dmb_owner_of_supported_site(const dmb_scene *scene, uint32_t from, dmb_message *text)
{
    return dmb_supported_site(scene, from, text);
}

int dmb_coupling_holds(const dmb_sim *sim, const dmb_scene_coupling *coupling)
{
    for (uint32_t k = 0; k < coupling->count; k++)
        if (sim->joint_state[coupling->joint[k]] == DMB_JOINT_OPEN) return 0;
    return 1;
}

const char *dmb_drive_text(const dmb_scene *scene, uint32_t drive, dmb_message *text)
{
    return dmb_part_text(text, "drive", drive, scene->drives[drive].name, sizeof scene->drives[drive].name);
}

const char *dmb_string_text(const dmb_scene *scene, uint32_t string, dmb_message *text)
{
    return dmb_model_part_text(scene->model, DMB_PART_STRING, string, text);
}

const char *dmb_load_text(const dmb_scene *scene, uint32_t load, dmb_message *text)
{
    return dmb_part_text(text, "load", load, scene->loads[load].name, sizeof scene->loads[load].name);
}

/* ad(v)^T M v of unit spin v = (0; e_x): minus the left side of eq:motion.unbalance. */
void dmb_unbalance_of(const dmb_scene *scene, uint32_t i, double wrench[6])
{
    const double spin[6] = {0.0, 0.0, 0.0, 1.0, 0.0, 0.0};
    double p[6];
    dmb_rigid_mass_times(scene->rigid_masses + i, spin, p);
    dmb_ad_transpose(spin, p, wrench);
}
