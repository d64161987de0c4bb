/* Measured depths at time 0 of parts that are not described on the hole's axis: strings at a position of their own, and
 * free bodies. */
#include <math.h>

#include "math/so3.h"
#include "math/vec3.h"
#include "model/field_check.h"
#include "model/mesh.h"

/* [-] Range of the search along the axis over the distance of two places, because the axis bends between them. */
#define DMB_DETOUR 2.0

static void direction_of(const dmb_mesh_node *node, double direction[3])
{
    const double ex[3] = {1.0, 0.0, 0.0};
    dmb_quat_rotate(node->quaternion, ex, direction);
}

/* ---- Strings ----------------------------------------------------------------------------------------------------- */

/* Depths of the nodes of a string whose first one is at that arc: each is searched from the one before, within twice
 * their distance. Returns the sum of the squared distances from the axis [m2]. */
static double follow_from(const dmb_mesh *mesh, const dmb_string_map *map, uint32_t arc)
{
    double sum = 0.0, point[3], tangent[3], direction[3];
    for (uint32_t i = 0; i < map->node_count; ++i) {
        dmb_mesh_node *node = dmb_mesh_node_at(mesh, map->first_node + i);
        if (i > 0) {
            double apart[3];
            dmb_vec3_sub(node->position, node[-1].position, apart);
            direction_of(node, direction);
            arc = dmb_hole_search(&mesh->hole, node->position, node[-1].depth, DMB_DETOUR * dmb_vec3_norm(apart),
                                  direction, &node->depth);
        }
        dmb_hole_project(&mesh->hole, node->position, &node->depth, &arc, point, tangent);
        dmb_vec3_sub(node->position, point, point);
        sum += dmb_vec3_dot(point, point);
    }
    return sum;
}

/* Places a string: the axis may pass its first node several times, and the passage nearest over the length of the
 * string is chosen. */
static void place_string(const dmb_mesh *mesh, const dmb_string_map *map)
{
    const double *x = dmb_mesh_node_at(mesh, map->first_node)->position;
    const uint32_t count = mesh->hole.stations;
    double least = (double)INFINITY;
    uint32_t best = 0;
    for (uint32_t arc = dmb_hole_next_foot(&mesh->hole, x, 0); arc < count;
         arc = dmb_hole_next_foot(&mesh->hole, x, arc + 1)) {
        const double sum = follow_from(mesh, map, arc);
        if (!(sum < least)) continue;
        least = sum;
        best = arc;
    }
    (void)follow_from(mesh, map, best);
}

/* ---- Bodies ------------------------------------------------------------------------------------------------------ */

/* Node of one place of a joint; false if it does not exist, which the joints report later. */
static bool node_of(const dmb_mesh *mesh, const dmb_place *place, uint32_t *node)
{
    const uint32_t string = dmb_model_part_index(mesh->model, place->part, DMB_PART_STRING);
    dmb_mesh_place found;
    if (dmb_id_is_none(place->part)) return false;
    if (string != DMB_NONE && place->pipe >= dmb_mesh_string_at(mesh, string)->pipe_count) return false;
    if (!dmb_mesh_place_of(mesh, place, &found)) return false;
    *node = found.node;
    return true;
}

static void place_body(const dmb_mesh *mesh, dmb_mesh_node *node, double middle, double reach)
{
    double direction[3];
    direction_of(node, direction);
    (void)dmb_hole_search(&mesh->hole, node->position, middle, reach, direction, &node->depth);
}

/* The depth of a jointed body is that of the part at the other end of the joint, if known. */
static bool place_joined(const dmb_mesh *mesh, uint32_t known, uint32_t body, uint8_t *is_known)
{
    const dmb_mesh_node *from = dmb_mesh_node_at(mesh, known);
    dmb_mesh_node *to = dmb_mesh_node_at(mesh, body);
    double apart[3];
    if (!is_known[known] || is_known[body]) return false;
    dmb_vec3_sub(to->position, from->position, apart);
    place_body(mesh, to, from->depth, DMB_DETOUR * dmb_vec3_norm(apart));
    is_known[body] = 1;
    return true;
}

static void place_all_joined(const dmb_mesh *mesh, uint8_t *is_known)
{
    const dmb_list *joints = &mesh->model->joints;
    for (bool more = true; more;) {
        more = false;
        for (uint32_t j = 0; j < joints->count; ++j) {
            const dmb_joint_def *def = DMB_LIST_AT(const dmb_joint_def, *joints, j);
            uint32_t a, b;
            if (!node_of(mesh, &def->place_a, &a) || !node_of(mesh, &def->place_b, &b)) continue;
            more = place_joined(mesh, a, b, is_known) || place_joined(mesh, b, a, is_known) || more;
        }
    }
}

static int32_t place_bodies(dmb_mesh *mesh)
{
    const dmb_allocator *allocator = &mesh->model->allocator;
    const uint32_t count = (uint32_t)mesh->nodes.count;
    uint8_t *is_known = dmb_allocate(allocator, count);
    if (is_known == NULL) return DMB_ERR_NO_MEMORY;
    for (uint32_t i = 0; i < count; ++i) is_known[i] = dmb_mesh_node_at(mesh, i)->string != DMB_NONE;
    place_all_joined(mesh, is_known);
    for (uint32_t i = 0; i < count; ++i)
        if (!is_known[i]) place_body(mesh, dmb_mesh_node_at(mesh, i), 0.0, (double)INFINITY);
    dmb_release(allocator, is_known, count);
    return DMB_OK;
}

/* ---- All --------------------------------------------------------------------------------------------------------- */

/* On a straight axis every place is the only one near. */
static void place_on_line(const dmb_mesh *mesh, dmb_mesh_node *node)
{
    double point[3];
    dmb_line_project(mesh->hole.origin, mesh->hole.direction, node->position, &node->depth, point);
}

int32_t dmb_mesh_depths(dmb_mesh *mesh)
{
    const bool straight = !mesh->has_hole || dmb_hole_is_straight(&mesh->hole);
    if (!mesh->has_hole) return DMB_OK;
    for (uint32_t i = 0; i < mesh->nodes.count && straight; ++i) {
        dmb_mesh_node *node = dmb_mesh_node_at(mesh, i);
        if (node->string == DMB_NONE || !dmb_mesh_follows_hole(mesh, node->string)) place_on_line(mesh, node);
    }
    if (straight) return DMB_OK;
    for (uint32_t s = 0; s < mesh->strings.count; ++s)
        if (!dmb_mesh_follows_hole(mesh, s)) place_string(mesh, dmb_mesh_string_at(mesh, s));
    return place_bodies(mesh);
}
