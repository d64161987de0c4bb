/* Points of forces at any place, springs between them, and callers' forces, converted from parts to nodes and elements.
 */
#include <math.h>
#include <string.h>

#include "element/beam.h"
#include "math/so3.h"
#include "model/field_check.h"
#include "model/mesh.h"

/* ---- Points ------------------------------------------------------------------------------------------------------ */

/* A point inside an element of an elastic pipe, not rigid with a node. */
static void point_in_element(const dmb_mesh *mesh, const dmb_place *place, dmb_scene_point *point)
{
    const uint32_t string = dmb_model_part_index(mesh->model, place->part, DMB_PART_STRING);
    const dmb_pipe_map *pipe = dmb_mesh_pipe_at(mesh, dmb_mesh_string_at(mesh, string)->first_pipe + place->pipe);
    const double position = place->fraction * pipe->length * pipe->elements / (pipe->length - pipe->joint);
    const uint32_t last = pipe->elements - 1, k = position < last ? (uint32_t)position : last;
    point->element = pipe->element + k;
    point->fraction = fmin(position - k, 1.0);
    if (pipe->divided)
        point->element = dmb_mesh_element_along(mesh, pipe, place->fraction * pipe->length, &point->fraction);
    point->node = dmb_mesh_element_at(mesh, point->element)->node;
}

/* A place on a part becomes a point of the scene:
 *
 *     no part given           ground: the offset is a point of the world
 *     body, bit, stabiliser,  rigid with a node: offset from its reference point, along x by the arm
 *     rigid pipe, joint, end
 *     else                    inside an element: its two nodes move the section */
dmb_scene_point dmb_mesh_point(dmb_check *check, const dmb_mesh *mesh, const char *field, const dmb_place *place,
                               const double offset[3])
{
    dmb_scene_point point = {{offset[0], offset[1], offset[2]}, 0.0, DMB_NONE, DMB_NONE};
    dmb_mesh_place rigid = {0, 0.0};
    if (dmb_id_is_none(place->part)) return point;
    dmb_mesh_check_pipe(check, mesh, field, place);
    if (check->status < 0) return point;
    if (dmb_mesh_place_of(mesh, place, &rigid)) {
        point.node = rigid.node;
        point.x[0] += rigid.arm;
    } else {
        point_in_element(mesh, place, &point);
        dmb_mesh_check_node(check, mesh, field, place, point.node + 1);
    }
    dmb_mesh_check_node(check, mesh, field, place, point.node);
    return point;
}

/* Derivatives of a callback are known by calls only, so a point inside an element is rigid with the nearer node
 * instead, at most a quarter of the pipe's diameter away (mesh_division.c). */
static void use_nearer_node(const dmb_mesh *mesh, dmb_scene_point *point)
{
    if (point->element == DMB_NONE) return;
    const dmb_mesh_element *element = dmb_mesh_element_at(mesh, point->element);
    const int far = point->fraction > 0.5;
    point->x[0] += far ? (point->fraction - 1.0) * element->length - element->arm[1]
                       : element->arm[0] + point->fraction * element->length;
    point->node += far ? 1 : 0;
    point->element = DMB_NONE;
    point->fraction = 0.0;
}

/* ---- Springs ----------------------------------------------------------------------------------------------------- */

static bool move_as_one(const dmb_scene_spring *spring)
{
    return spring->a.element == DMB_NONE && spring->b.element == DMB_NONE && spring->a.node == spring->b.node;
}

static void check_ends(dmb_check *check, const dmb_scene_spring *spring)
{
    if (check->status < 0 || !move_as_one(spring)) return;
    check->status = DMB_ERR_VALUE;
    dmb_message_set(check->message, "%s: place_b = one rigid body with place_a, must be on another part", check->part);
}

static int32_t append_table(dmb_mesh *mesh, const dmb_spring_plan *plan, dmb_scene_spring *spring)
{
    spring->law.first = (uint32_t)mesh->spring_points.count;
    if (spring->law.count > UINT32_MAX - spring->law.first) return DMB_ERR_TOO_LARGE;
    return dmb_vector_append(&mesh->spring_points, &mesh->model->allocator, plan->points, spring->law.count);
}

/* Section of the element that the point is in: rotation and place in the frame of node a, at time 0. */
static void section_of(const dmb_mesh *mesh, const dmb_scene_point *point, const double Ra[9], double Q[9], double r[3])
{
    const dmb_mesh_element *element = dmb_mesh_element_at(mesh, point->element);
    const dmb_element_type *type = DMB_VECTOR_AT(dmb_element_type, &mesh->types, element->type);
    dmb_section_shape shape;
    double Rb[9], d[6];
    dmb_quat_to_matrix(dmb_mesh_node_at(mesh, point->node + 1)->quaternion, Rb);
    dmb_section_shape_at(type, point->fraction, element->kernel != DMB_KERNEL_AXIAL_TORSIONAL, &shape);
    dmb_section_ends(type, Ra, Rb, element->span, d);
    dmb_section_pose(type, &shape, d, Q, r);
}

/* From the origin of the point's node, world axes, at time 0. */
static void from_node(const dmb_mesh *mesh, const dmb_scene_point *point, double x[3])
{
    double R[9], Q[9], r[3];
    dmb_vec3_copy(point->x, x);
    if (point->node == DMB_NONE) return;
    dmb_quat_to_matrix(dmb_mesh_node_at(mesh, point->node)->quaternion, R);
    if (point->element != DMB_NONE) {
        section_of(mesh, point, R, Q, r);
        dmb_mat3_vec(Q, x, x);
        dmb_vec3_add(r, x, x);
    }
    dmb_mat3_vec(R, x, x);
}

/* [m] between the points at time 0; fills the span. */
static double length_of(const dmb_mesh *mesh, dmb_scene_spring *spring)
{
    double a[3], b[3];
    if (spring->b.node != DMB_NONE) dmb_mesh_span(mesh, spring->a.node, spring->b.node, spring->span);
    if (spring->b.node == DMB_NONE) { /* ground: points relative to the world's origin */
        dmb_mesh_span(mesh, DMB_NONE, spring->a.node, spring->span);
        dmb_vec3_scale(-1.0, spring->span, spring->span);
    }
    from_node(mesh, &spring->a, a);
    from_node(mesh, &spring->b, b);
    dmb_vec3_sub(b, a, b);
    dmb_vec3_add(b, spring->span, b);
    return dmb_vec3_norm(b);
}

/* Length at time 0 of a force between two points; coincident points have no direction and fail the check. */
static void set_length(dmb_check *check, const dmb_spring_plan *plan, double length, dmb_scene_spring *spring)
{
    dmb_spring_force force;
    if (plan->def.free_length < 0.0) spring->free_length = length;
    if (!(length < DMB_LENGTH_MIN)) return;
    dmb_spring_force_at(&plan->law, plan->points, length - spring->free_length, 0.0, &force);
    if (plan->def.free_length >= 0.0 && !(fabs(force.elastic) > DMB_STIFFNESS_MIN)) return;
    check->status = DMB_ERR_GEOMETRY;
    dmb_message_set(check->message,
                    "%s: its points are %g m apart at time 0, must be >= %g m where a force acts between them, which "
                    "else has no direction: move a point, or give a free_length without force there",
                    check->part, length, DMB_LENGTH_MIN);
}

static int32_t add_spring(dmb_mesh *mesh, uint32_t i)
{
    const dmb_spring_plan *plan = DMB_LIST_AT(const dmb_spring_plan, mesh->model->springs, i);
    const dmb_spring_def *def = &plan->def;
    dmb_message part;
    dmb_check check =
        dmb_check_of(&mesh->model->message, dmb_part_text(&part, "spring", i, def->name, sizeof def->name), DMB_NONE);
    dmb_scene_spring spring = {.law = plan->law, .free_length = def->free_length, .constraint = DMB_NONE};
    memcpy(spring.name, def->name, sizeof spring.name);
    spring.a = dmb_mesh_point(&check, mesh, "place_a", &def->place_a, def->offset_a);
    if (check.status >= 0) spring.b = dmb_mesh_point(&check, mesh, "place_b", &def->place_b, def->offset_b);
    check_ends(&check, &spring);
    if (check.status >= 0) set_length(&check, plan, length_of(mesh, &spring), &spring);
    if (check.status < 0) return check.status;
    if ((mesh->options.features & DMB_FEATURE_DAMPING) == 0) spring.law.damping = 0.0;
    const int32_t status = append_table(mesh, plan, &spring);
    return status < 0 ? status : dmb_vector_append(&mesh->springs, &mesh->model->allocator, &spring, 1);
}

/* ---- Forces by the caller's functions ---------------------------------------------------------------------------- */

enum { STATES_MAX = 1 << 24 };

static int32_t add_force(dmb_mesh *mesh, uint32_t i)
{
    const dmb_force_def *def = DMB_LIST_AT(const dmb_force_def, mesh->model->forces, i);
    dmb_scene_force force = {.callback = def->callback,
                             .accept = def->accept,
                             .context = def->callback_context,
                             .state = mesh->force_states,
                             .states = def->state_count,
                             .pose_step = def->pose_step,
                             .speed_step = def->speed_step,
                             .count = def->place_count,
                             .frame = def->frame,
                             .provides = def->provides,
                             .constraint = DMB_NONE};
    dmb_message part, field;
    dmb_check check =
        dmb_check_of(&mesh->model->message, dmb_part_text(&part, "force", i, def->name, sizeof def->name), DMB_NONE);
    memcpy(force.name, def->name, sizeof force.name);
    for (uint32_t k = 0; k < DMB_CONSTRAINT_PLACES; ++k) {
        const dmb_scene_point none = {{0.0, 0.0, 0.0}, 0.0, DMB_NONE, DMB_NONE};
        force.point[k] = none;
        force.joint[k] = DMB_NONE;
        if (k >= def->place_count || check.status < 0) continue;
        force.joint[k] = dmb_model_part_index(mesh->model, def->place[k].part, DMB_PART_JOINT);
        force.component[k] = def->component[k];
        dmb_message_set(&field, "place[%u]", k);
        if (force.joint[k] == DMB_NONE)
            force.point[k] = dmb_mesh_point(&check, mesh, field.text, &def->place[k], def->offset + 3 * k);
        use_nearer_node(mesh, &force.point[k]);
    }
    if (check.status >= 0 && def->state_count > STATES_MAX - mesh->force_states)
        dmb_check_fail(&check, DMB_ERR_TOO_LARGE, "state_count", def->state_count, "<= 2^24 in all forces together");
    mesh->force_states += def->state_count;
    return check.status < 0 ? check.status : dmb_vector_append(&mesh->forces, &mesh->model->allocator, &force, 1);
}

/* ---- Places that can be stuck ------------------------------------------------------------------------------------ */

/* Fails the check if a force acts sideways on an axial-torsional node, which cannot move sideways. */
static void check_sideways(dmb_check *check, const dmb_mesh *mesh, const dmb_stuck_def *def,
                           const dmb_scene_point *point)
{
    if (check->status < 0 || (def->holds & DMB_STUCK_LATERAL) == 0) return;
    if (dmb_mesh_node_at(mesh, point->node)->size == DMB_NODE_SIX_DOF) return;
    check->status = DMB_ERR_UNSUPPORTED;
    dmb_message_set(check->message,
                    "%s: holds = %d, must be without DMB_STUCK_LATERAL (4) on axial-torsional pipes, which do not move "
                    "sideways; take it out, or describe flexible pipes",
                    check->part, (int)def->holds);
}

static int32_t add_stuck(dmb_mesh *mesh, uint32_t i)
{
    static const double nowhere[3] = {0.0, 0.0, 0.0};
    const dmb_stuck_def *def = DMB_LIST_AT(const dmb_stuck_def, mesh->model->stuck, i);
    const double unit[2] = {(double)INFINITY, def->stiffness[1]}; /* 1 rad */
    dmb_scene_stuck stuck = {.initially = def->stuck, .input = DMB_NONE};
    dmb_message part;
    dmb_check check =
        dmb_check_of(&mesh->model->message, dmb_part_text(&part, "stuck", i, def->name, sizeof def->name), DMB_NONE);
    memcpy(stuck.name, def->name, sizeof stuck.name);
    stuck.point = dmb_mesh_point(&check, mesh, "place", &def->place, nowhere);
    check_sideways(&check, mesh, def, &stuck.point);
    if (check.status < 0) return check.status;
    for (int k = 0; k < 3; ++k) {
        const bool damped = (mesh->options.features & DMB_FEATURE_DAMPING) != 0;
        if ((def->holds >> k & 1) == 0) continue;
        stuck.stiffness[k] = def->stiffness[k];
        stuck.damping[k] = damped ? def->damping[k] : 0.0;
    }
    stuck.release[0] = def->overpull > 0.0 ? def->overpull : unit[0];
    stuck.release[1] = def->overtorque > 0.0 ? def->overtorque : unit[1];
    return dmb_vector_append(&mesh->stuck, &mesh->model->allocator, &stuck, 1);
}

int32_t dmb_mesh_forces(dmb_mesh *mesh)
{
    int32_t status = DMB_OK;
    for (uint32_t i = 0; i < mesh->model->springs.count && status >= 0; ++i) status = add_spring(mesh, i);
    for (uint32_t i = 0; i < mesh->model->forces.count && status >= 0; ++i) status = add_force(mesh, i);
    for (uint32_t i = 0; i < mesh->model->stuck.count && status >= 0; ++i) status = add_stuck(mesh, i);
    return status;
}
