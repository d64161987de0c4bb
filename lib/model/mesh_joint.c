/* Places of the description as nodes with arms, and joints, couplings and the caller's constraints on them. */
#include "model/mesh.h"

#include <math.h>
#include <string.h>

#include "constraint/joint.h"
#include "math/mat6.h"
#include "math/so3.h"
#include "model/field_check.h"

#define DMB_WITHIN 1e-9 /* [-] tolerance of the caller's fraction of a pipe */

/* Ends of elements divided by stabilisers or forces. */
static bool place_on_divided(const dmb_mesh *mesh, const dmb_pipe_map *map, double along, dmb_mesh_place *found)
{
    double fraction;
    const uint32_t e = dmb_mesh_element_along(mesh, map, along, &fraction);
    const dmb_mesh_element *element = dmb_mesh_element_at(mesh, e);
    const double slack = DMB_WITHIN * map->length / element->length;
    if (fraction > slack && fraction < 1.0 - slack) return false;
    found->node = element->node + (fraction > slack);
    found->arm = fraction > slack ? -element->arm[1] : element->arm[0];
    return true;
}

/* Place on the tool joint, measured from the far end so that fraction 1 is exact; otherwise at the ends of the equal
 * elements. */
static bool place_on_elastic(const dmb_mesh *mesh, const dmb_pipe_map *map, double fraction, dmb_mesh_place *found)
{
    const dmb_mesh_element *first = dmb_mesh_element_at(mesh, map->element), *last = first + map->elements - 1;
    const double back = (1.0 - fraction) * map->length;
    const double position = fraction * map->length * map->elements / (map->length - map->joint);
    const double k = floor(position + 0.5);
    if (back <= map->joint) {
        found->node = last->node + 1;
        found->arm = map->joint - back - last->arm[1];
        return true;
    }
    if (map->divided) return place_on_divided(mesh, map, fraction * map->length, found);
    if (fabs(position - k) > DMB_WITHIN * map->elements) return false;
    if (k < 0.5) {
        found->node = first->node;
        found->arm = first->arm[0];
    } else {
        found->node = first->node + (uint32_t)k;
        found->arm = k < map->elements - 0.5 ? 0.0 : -last->arm[1];
    }
    return true;
}

/* A rigid pipe is a part of its node: any of its fractions is a place, at an arm. On a flexible one a joint needs a
 * node, because its equations are of one node on either side. */
static bool place_on_string(const dmb_mesh *mesh, uint32_t string, const dmb_place *place, dmb_mesh_place *found)
{
    const dmb_pipe_map *map = dmb_mesh_pipe_at(mesh, dmb_mesh_string_at(mesh, string)->first_pipe + place->pipe);
    if (map->elements > 0) return place_on_elastic(mesh, map, place->fraction, found);
    found->node = map->node;
    found->arm = map->start + place->fraction * map->length;
    return true;
}

bool dmb_mesh_place_of(const dmb_mesh *mesh, const dmb_place *place, dmb_mesh_place *found)
{
    const dmb_model *model = mesh->model;
    const uint32_t string = dmb_model_part_index(model, place->part, DMB_PART_STRING);
    const uint32_t bit = dmb_model_part_index(model, place->part, DMB_PART_BIT);
    const uint32_t ring = dmb_model_part_index(model, place->part, DMB_PART_STABILISER);
    uint32_t body = dmb_model_part_index(model, place->part, DMB_PART_BODY);
    if (bit != DMB_NONE) body = model->bodies.count + bit;
    if (ring != DMB_NONE) body = model->bodies.count + model->bits.count + ring;
    if (string != DMB_NONE) return place_on_string(mesh, string, place, found);
    found->node = DMB_VECTOR_AT(dmb_body_map, &mesh->bodies, body)->node;
    found->arm = DMB_VECTOR_AT(dmb_body_map, &mesh->bodies, body)->arm;
    return true;
}

_Static_assert((int)DMB_CONSTRAINT_ROWS == (int)DMB_ROWS_MAX, "rows of a joint");

/* ---- Joints, couplings and the caller's constraints, from the parts they are described on to frames on nodes ---- */

enum {
    SPAN_ELEMENTS_MAX = 1024
}; /* largest number of elements whose spans are summed; beyond it a difference is as accurate */

/* ---- Places ------------------------------------------------------------------------------------------------------ */

static dmb_check check_of(dmb_mesh *mesh, dmb_message *part, const char *kind, uint32_t index, const char name[24])
{
    return dmb_check_of(&mesh->model->message, dmb_part_text(part, kind, index, name, 24), DMB_NONE);
}

void dmb_mesh_check_pipe(dmb_check *check, const dmb_mesh *mesh, const char *field, const dmb_place *place)
{
    const uint32_t string = dmb_model_part_index(mesh->model, place->part, DMB_PART_STRING);
    dmb_message name;
    if (string == DMB_NONE) return;
    dmb_message_set(&name, "%s.pipe", field);
    dmb_check_count(check, name.text, place->pipe, 0, dmb_mesh_string_at(mesh, string)->pipe_count - 1);
}

/* Fails the check for axial-torsional nodes on a curved axis: they rotate with the axis, which a joint would resist;
 * not supported. */
void dmb_mesh_check_node(dmb_check *check, const dmb_mesh *mesh, const char *field, const dmb_place *place,
                         uint32_t node)
{
    dmb_message name;
    if (dmb_mesh_node_at(mesh, node)->size == DMB_NODE_SIX_DOF || !mesh->has_hole || dmb_hole_is_straight(&mesh->hole))
        return;
    dmb_message_set(&name, "%s.pipe", field);
    dmb_check_fail(check, DMB_ERR_UNSUPPORTED, name.text, place->pipe,
                   "flexible or rigid, or not axial-torsional in a curved hole");
}

/* The node of a place and the arm to it; false with the check failed. */
static bool find_place(dmb_check *check, const dmb_mesh *mesh, const char *field, const dmb_place *place,
                       dmb_mesh_place *found)
{
    dmb_message name;
    dmb_mesh_check_pipe(check, mesh, field, place);
    if (check->status < 0) return false;
    if (!dmb_mesh_place_of(mesh, place, found)) {
        dmb_message_set(&name, "%s.fraction", field);
        dmb_check_fail(check, DMB_ERR_VALUE, name.text, place->fraction, "a node: 0, 1 or k/elements");
        return false;
    }
    dmb_mesh_check_node(check, mesh, field, place, found->node);
    return check->status >= 0;
}

/* ---- Frames ------------------------------------------------------------------------------------------------------ */

static dmb_scene_frame ground_frame(void)
{
    dmb_scene_frame frame = {.node = DMB_NONE};
    dmb_mat3_identity(frame.M);
    return frame;
}

static dmb_scene_frame frame_at(const dmb_mesh_place *place)
{
    dmb_scene_frame frame = ground_frame();
    frame.node = place->node;
    frame.x[0] = place->arm;
    return frame;
}

/* Frame rotated and displaced from its place as described; its axes were checked at the description. */
static void set_frame(const double origin[3], const double axis[3], const double normal[3], dmb_scene_frame *frame)
{
    dmb_vec3_add(frame->x, origin, frame->x);
    (void)dmb_frame_axes(axis, normal, frame->M);
}

static bool on_one_string(const dmb_mesh_node *a, const dmb_mesh_node *b)
{
    return a->string == b->string && a->string != DMB_NONE;
}

/* Sum of the spans of the elements from node `from` to node `to` of one string. Strings precede bodies, and each has
 * one element less than nodes. */
static void sum_spans(const dmb_mesh *mesh, uint32_t from, uint32_t to, double sum[3])
{
    const uint32_t string = dmb_mesh_node_at(mesh, from)->string;
    dmb_vec3_zero(sum);
    for (uint32_t i = from; i < to; ++i) dmb_vec3_add(sum, dmb_mesh_element_at(mesh, i - string)->span, sum);
}

/* Vector from node a to node b at time 0, world axes. Within a string it is the sum of the elements' spans: a
 * difference of positions far from the origin would lose the digits that joints are closed to. */
void dmb_mesh_span(const dmb_mesh *mesh, uint32_t a, uint32_t b, double span[3])
{
    const dmb_mesh_node *to = dmb_mesh_node_at(mesh, b);
    if (a == DMB_NONE) {
        dmb_vec3_copy(to->position, span);
        return;
    }
    const dmb_mesh_node *from = dmb_mesh_node_at(mesh, a);
    if (on_one_string(from, to) && (a < b ? b - a : a - b) <= SPAN_ELEMENTS_MAX) {
        sum_spans(mesh, a < b ? a : b, a < b ? b : a, span);
        if (a > b) dmb_vec3_scale(-1.0, span, span);
        return;
    }
    dmb_vec3_sub(to->position, from->position, span);
}

/* Places frame b at frame a: R_b M_b = R_a M_a, R_b x_b = R_a x_a - span, so that C = 0 as described and closing the
 * joints moves nothing, whatever the angle between the parts. */
static void match_frame(const dmb_mesh *mesh, dmb_scene_joint *joint)
{
    double Ra[9], Rb[9], Ma[9], x[3];
    dmb_mat3_identity(Ra);
    if (joint->a.node != DMB_NONE) dmb_quat_to_matrix(dmb_mesh_node_at(mesh, joint->a.node)->quaternion, Ra);
    dmb_quat_to_matrix(dmb_mesh_node_at(mesh, joint->b.node)->quaternion, Rb);
    dmb_mat3_mul(Ra, joint->a.M, Ma);
    dmb_mat3_mul_tn(Rb, Ma, joint->b.M);
    dmb_mat3_vec(Ra, joint->a.x, x);
    dmb_vec3_sub(x, joint->span, x);
    dmb_mat3_tvec(Rb, x, joint->b.x);
}

/* ---- Joints ------------------------------------------------------------------------------------------------------ */

/* Without the feature there is no damper and no friction either. */
static dmb_joint_law law_of(const dmb_mesh *mesh, const dmb_joint_def *def, int k)
{
    const bool damped = (mesh->options.features & DMB_FEATURE_DAMPING) != 0;
    const bool rubs = (mesh->options.features & DMB_FEATURE_FRICTION) != 0;
    const dmb_joint_law law = {.stiffness = def->stiffness[k],
                               .damping = damped ? def->damping[k] : 0.0,
                               .rest = def->rest[k],
                               .friction = rubs ? def->friction[k] : 0.0,
                               .friction_speed = def->friction_speed,
                               .stop_low = def->stop_low[k],
                               .stop_high = def->stop_high[k],
                               .stop_stiffness = def->stop_stiffness,
                               .stop_damping = damped ? def->stop_damping : 0.0};
    return law;
}

/* Six laws, or none if none of them acts: a scene of ideal joints has no laws and no arrays for their touches. */
static int32_t add_laws(dmb_mesh *mesh, const dmb_joint_def *def, dmb_scene_joint *joint)
{
    dmb_joint_law laws[6];
    joint->law = DMB_NONE;
    for (int k = 0; k < 6; ++k) {
        laws[k] = law_of(mesh, def, k);
        if (dmb_joint_law_acts(&laws[k])) joint->law_mask |= 1 << k;
    }
    if (joint->law_mask == 0) return DMB_OK;
    joint->law = (uint32_t)mesh->laws.count; /* 6 * 2^24 at most */
    return dmb_vector_append(&mesh->laws, &mesh->model->allocator, laws, 6);
}

static dmb_scene_joint joint_of(const dmb_joint_def *def)
{
    dmb_scene_joint joint = {.a = ground_frame(),
                             .length = def->length,
                             .kind = def->kind,
                             .state = def->state,
                             .initial_mask = dmb_free_set(def->initial_mask)};
    dmb_vec6_copy(def->initial_position, joint.initial_position);
    dmb_vec6_copy(def->initial_speed, joint.initial_speed);
    memcpy(joint.name, def->name, sizeof joint.name);
    return joint;
}

/* Nodes of both places, which must not be the same one. */
static void place_frames(dmb_check *check, const dmb_mesh *mesh, const dmb_joint_def *def, dmb_scene_joint *joint)
{
    dmb_mesh_place a, b;
    if (!dmb_id_is_none(def->place_a.part)) {
        if (!find_place(check, mesh, "place_a", &def->place_a, &a)) return;
        joint->a = frame_at(&a);
    }
    if (!find_place(check, mesh, "place_b", &def->place_b, &b)) return;
    joint->b = frame_at(&b);
    if (joint->a.node == joint->b.node) {
        check->status = DMB_ERR_VALUE;
        dmb_message_set(check->message, "%s: place_b = node %u as place_a, must not be one rigid body with it",
                        check->part, joint->b.node);
    }
}

static int32_t add_joint(dmb_mesh *mesh, uint32_t i)
{
    const dmb_joint_def *def = DMB_LIST_AT(const dmb_joint_def, mesh->model->joints, i);
    const bool on_hole = def->kind == DMB_JOINT_POINT_ON_HOLE;
    dmb_scene_joint joint = joint_of(def);
    dmb_message part;
    dmb_check check = check_of(mesh, &part, "joint", i, def->name);
    if (on_hole && !mesh->has_hole) {
        dmb_check_fail(&check, DMB_ERR_GEOMETRY, "kind", def->kind, "another one: there is no hole");
    }
    if (check.status >= 0) place_frames(&check, mesh, def, &joint);
    if (check.status < 0) return check.status;
    dmb_mesh_span(mesh, joint.a.node, joint.b.node, joint.span);
    if (!on_hole) set_frame(def->origin_a, def->axis_a, def->normal_a, &joint.a);
    if (def->match) {
        match_frame(mesh, &joint);
    } else {
        set_frame(def->origin_b, def->axis_b, def->normal_b, &joint.b);
    }
    const int32_t status = add_laws(mesh, def, &joint);
    return status < 0 ? status : dmb_vector_append(&mesh->joints, &mesh->model->allocator, &joint, 1);
}

/* ---- Couplings and constraints ----------------------------------------------------------------------------------- */

/* q_0 - sum ratio_k q_k = 0: factor 1 for the first coordinate, minus the ratio for the others; places without a joint
 * are left out. */
static int32_t add_coupling(dmb_mesh *mesh, uint32_t i)
{
    const dmb_model *model = mesh->model;
    const dmb_coupling_def *def = DMB_LIST_AT(const dmb_coupling_def, model->couplings, i);
    dmb_scene_coupling coupling = {.count = 0};
    for (uint32_t k = 0; k < DMB_COUPLED; ++k) {
        const dmb_coupled_coordinate c = dmb_coupled_coordinate_of(def, k);
        if (dmb_id_is_none(c.joint)) continue;
        coupling.joint[coupling.count] = dmb_model_part_index(model, c.joint, DMB_PART_JOINT);
        coupling.component[coupling.count] = c.component;
        coupling.factor[coupling.count++] = k == 0 ? 1.0 : -c.ratio;
    }
    memcpy(coupling.name, def->name, sizeof coupling.name);
    return dmb_vector_append(&mesh->couplings, &model->allocator, &coupling, 1);
}

static int32_t add_callback(dmb_mesh *mesh, uint32_t i)
{
    const dmb_constraint_def *def = DMB_LIST_AT(const dmb_constraint_def, mesh->model->constraints, i);
    dmb_scene_callback callback = {.callback = def->callback,
                                   .context = def->callback_context,
                                   .rows = def->row_count,
                                   .count = def->place_count,
                                   .kind = def->kind,
                                   .provides = def->provides};
    dmb_message part, field;
    dmb_check check = check_of(mesh, &part, "constraint", i, def->name);
    dmb_mesh_place place;
    for (uint32_t k = 0; k < def->place_count; ++k) {
        dmb_message_set(&field, "place[%u]", k);
        if (!find_place(&check, mesh, field.text, &def->place[k], &place)) return check.status;
        callback.place[k] = frame_at(&place);
    }
    for (uint32_t k = def->place_count; k < DMB_CONSTRAINT_PLACES; ++k) callback.place[k] = ground_frame();
    memcpy(callback.name, def->name, sizeof callback.name);
    return dmb_vector_append(&mesh->callbacks, &mesh->model->allocator, &callback, 1);
}

int32_t dmb_mesh_joints(dmb_mesh *mesh)
{
    const dmb_model *model = mesh->model;
    int32_t status = DMB_OK;
    for (uint32_t i = 0; i < model->joints.count && status >= 0; ++i) status = add_joint(mesh, i);
    for (uint32_t i = 0; i < model->couplings.count && status >= 0; ++i) status = add_coupling(mesh, i);
    for (uint32_t i = 0; i < model->constraints.count && status >= 0; ++i) status = add_callback(mesh, i);
    return status;
}
