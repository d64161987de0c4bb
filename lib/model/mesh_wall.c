/* The axis of the hole, and contact points along it. */
#include "force/hole.h"
#include "math/quadrature.h"
#include "model/field_check.h"
#include "model/mesh.h"
#include "model/section.h"

static int32_t refuse_station(dmb_message *message, const dmb_wall_def *wall, uint32_t station)
{
    const double *row = wall->survey + 3 * (size_t)station;
    dmb_message_set(
        message,
        "wall: station %u at measured depth %g m, inclination %g and azimuth %g rad, must turn by <= %g rad "
        "from the station before",
        station, row[0], row[1], row[2], DMB_HOLE_DOGLEG_MAX);
    return DMB_ERR_GEOMETRY;
}

static int32_t make_axis(dmb_mesh *mesh)
{
    const dmb_wall_def *wall = &mesh->model->wall;
    const double radius = 0.5 * wall->diameter;
    if (wall->survey_count == 0) return dmb_hole_setup_straight(&mesh->hole, wall->origin, wall->direction, radius);
    const int32_t status = dmb_vector_append(&mesh->stations, &mesh->model->allocator, NULL, wall->survey_count);
    if (status < 0) return status;
    const int64_t bad = dmb_hole_setup_survey(&mesh->hole, wall->survey_count, wall->survey, wall->origin, radius,
                                              mesh->stations.items);
    return bad < 0 ? DMB_OK : refuse_station(&mesh->model->message, wall, (uint32_t)bad);
}

int32_t dmb_mesh_hole(dmb_mesh *mesh)
{
    if (mesh->model->wall_count > 0) {
        const int32_t status = make_axis(mesh);
        if (status < 0) return status;
        mesh->has_hole = 1;
    }
    const int32_t status = dmb_mesh_sections(mesh);
    return status < 0 ? status : dmb_mesh_cuts(mesh);
}

/* Contact points along strings. They lie between the stretches from node to node (for rigid pipes: from pipe end to
 * pipe end), and each represents half of its two stretches, so that refining the mesh does not change the contact force
 * per metre. */

/* The contact point between the last stretch and the next one. */
typedef struct site_iterator {
    dmb_mesh *mesh;
    dmb_id part;
    uint32_t node;
    uint32_t pipe;   /* whose far end it is */
    double offset;   /* [m] from the node */
    double diameter; /* [m] largest diameter of the adjacent stretches */
    double rubbing;  /* [m] the same with the tool joints of their pipes */
    double length;   /* [m] half of the adjacent stretches known so far */
    uint32_t string; /* index */
    uint32_t ring;   /* next one in rings */
    double inside;   /* [m] part of the next stretch represented by points inside its element */
    double joint;    /* [m] part of it represented by its far end alone */
} site_iterator;

/* A contact point can move sideways if its node can, or if its node can tilt and the point is at an arm. */
static bool moves_sideways(const dmb_mesh_node *node, double offset)
{
    if ((node->free & DMB_SET_SIDEWAYS) != 0) return true;
    return (node->free & DMB_SET_TILTING) != 0 && fabs(offset) > 0.0;
}

/* Described clearance; in a hole of sections it changes with the depth (dmb_site_clearance). */
static double clearance_of(const dmb_mesh *mesh, const dmb_site *site)
{
    const double depth = dmb_mesh_node_at(mesh, site->node)->depth + site->offset;
    return fmax(0.0, dmb_hole_radius(&mesh->hole, depth) - site->radius);
}

static int32_t push_site(dmb_mesh *mesh, const dmb_site *site)
{
    dmb_site added = *site;
    added.clearance = clearance_of(mesh, site);
    return dmb_vector_append(&mesh->sites, &mesh->model->allocator, &added, 1);
}

/* A node on the hole's axis represents its pipes, which touch the wall with their tool joints: its radius does not
 * depend on the mesh (R_p of eq:drilling.soft-string). */
static int32_t push_axial_torsional_site(const site_iterator *iterator)
{
    const dmb_axial_torsional_site site = {.radius = 0.5 * fmax(iterator->diameter, iterator->rubbing),
                                           .length = iterator->length,
                                           .part = iterator->part,
                                           .pipe = iterator->pipe,
                                           .node = iterator->node};
    if ((iterator->mesh->features & DMB_FEATURE_FRICTION) == 0) return DMB_OK;
    return dmb_vector_append(&iterator->mesh->axial_torsional_sites, &iterator->mesh->model->allocator, &site, 1);
}

static int32_t add_stabiliser(dmb_mesh *mesh, uint32_t map_index, double diameter, double offset, double length,
                              dmb_id part)
{
    dmb_body_map *map = DMB_VECTOR_AT(dmb_body_map, &mesh->bodies, map_index);
    const dmb_mesh_node *node = dmb_mesh_node_at(mesh, map->node);
    const dmb_site site = {
        .offset = map->arm + offset, .radius = 0.5 * diameter, .length = length, .part = part, .node = map->node};
    if (!(diameter > 0.0) || node->size == DMB_NODE_AXIAL_TORSIONAL) return DMB_OK;
    map->supported_site = !moves_sideways(node, site.offset);
    if (map->supported_site) return DMB_OK;
    map->site = (uint32_t)mesh->sites.count;
    return push_site(mesh, &site);
}

/* Stabilisers on nodes up to the present contact point, which touch the wall first; an axial-torsional node has contact
 * at their diameter. */
static int32_t pass_stabilisers(site_iterator *iterator)
{
    const dmb_mesh *mesh = iterator->mesh;
    int32_t status = DMB_OK;
    for (; iterator->ring < mesh->rings.count && status >= 0; iterator->ring++) {
        const dmb_ring_map *ring = DMB_VECTOR_AT(const dmb_ring_map, &mesh->rings, iterator->ring);
        const uint32_t index = ring->body - mesh->model->bodies.count - mesh->model->bits.count;
        const dmb_stabiliser_def *def = DMB_LIST_AT(const dmb_stabiliser_def, mesh->model->rings, index);
        const uint32_t node = DMB_VECTOR_AT(dmb_body_map, &mesh->bodies, ring->body)->node;
        if (ring->string != iterator->string || node > iterator->node) break;
        if (dmb_mesh_node_at(mesh, node)->size == DMB_NODE_AXIAL_TORSIONAL)
            iterator->diameter = fmax(iterator->diameter, def->outer_diameter);
        else
            status = add_stabiliser(iterator->mesh, ring->body, def->outer_diameter, 0.0, def->length,
                                    dmb_model_id(mesh->model, DMB_PART_STABILISER, index));
    }
    return status;
}

/* Completes the present contact point. */
static int32_t finish_place(site_iterator *iterator)
{
    const dmb_mesh_node *node = dmb_mesh_node_at(iterator->mesh, iterator->node);
    const int32_t status = pass_stabilisers(iterator);
    if (status < 0) return status;
    const dmb_site site = {.offset = iterator->offset,
                           .radius = 0.5 * iterator->diameter,
                           .length = iterator->length,
                           .part = iterator->part,
                           .pipe = iterator->pipe,
                           .node = iterator->node};
    if (node->size == DMB_NODE_AXIAL_TORSIONAL) return push_axial_torsional_site(iterator);
    return moves_sideways(node, iterator->offset) ? push_site(iterator->mesh, &site) : DMB_OK;
}

/* Adds a stretch of the given length; the next contact point starts at its far end. */
static int32_t pass_stretch(site_iterator *iterator, double length, const dmb_pipe_def *def, uint32_t node,
                            double offset, uint32_t pipe)
{
    const double rubbing = fmax(def->outer_diameter, dmb_joint_diameter(def));
    const double half = 0.5 * (length - iterator->inside - iterator->joint);
    int32_t status;
    iterator->length += half;
    iterator->diameter = fmax(iterator->diameter, def->outer_diameter);
    iterator->rubbing = fmax(iterator->rubbing, rubbing);
    status = finish_place(iterator);
    iterator->node = node;
    iterator->offset = offset;
    iterator->pipe = pipe;
    iterator->diameter = def->outer_diameter;
    iterator->rubbing = rubbing;
    iterator->length = half + iterator->joint;
    iterator->inside = iterator->joint = 0.0;
    return status;
}

/* [-] Fraction of an element's length represented by the points inside. */
static double fraction_inside(const dmb_pipe_def *def)
{
    const dmb_lobatto_rule *rule = dmb_lobatto(def->contact_points);
    return rule == NULL ? 0.0 : 1.0 - 2.0 * rule->weight[0];
}

/* The far node of a pipe may be behind rigid pipes, beyond the end of the pipe. */
static int32_t pass_elastic_pipe(site_iterator *iterator, const dmb_pipe_map *pipe, const dmb_pipe_def *def,
                                 uint32_t number)
{
    const dmb_mesh_element *element = dmb_mesh_element_at(iterator->mesh, pipe->element);
    const dmb_mesh_element *last = element + pipe->elements - 1;
    int32_t status = DMB_OK;
    for (uint32_t e = 0; e + 1 < pipe->elements && status >= 0; ++e) {
        iterator->inside = fraction_inside(def) * element[e].length;
        status = pass_stretch(iterator, element[e].length, def, pipe->node + e + 1, 0.0, number);
    }
    if (status < 0) return status;
    iterator->inside = fraction_inside(def) * last->length;
    iterator->joint = iterator->inside > 0.0 ? pipe->joint : 0.0;
    return pass_stretch(iterator, last->length + pipe->joint, def, last->node + 1, pipe->joint - last->arm[1], number);
}

/* The first contact point is the rig end. Each stretch ends the point before it and begins the next one, which is
 * finished when its other half is known; the last one has one half only. */
static int32_t pass_string(dmb_mesh *mesh, uint32_t string, uint32_t *ring)
{
    const dmb_string_map *map = dmb_mesh_string_at(mesh, string);
    dmb_pipe_iterator pipes = dmb_pipe_iterator_of(mesh, string);
    site_iterator iterator = {.mesh = mesh,
                              .part = dmb_model_id(mesh->model, DMB_PART_STRING, string),
                              .node = map->start_node,
                              .pipe = DMB_NONE,
                              .offset = map->start_arm,
                              .string = string,
                              .ring = *ring};
    int32_t status = DMB_OK;
    while (status >= 0 && dmb_pipe_iterator_next(&pipes)) {
        const dmb_pipe_map *pipe = dmb_mesh_pipe_at(mesh, map->first_pipe + pipes.number);
        const dmb_pipe_def *def = &pipes.run->def;
        if (pipe->elements > 0) {
            status = pass_elastic_pipe(&iterator, pipe, def, pipes.number);
        } else {
            status = pass_stretch(&iterator, pipe->length, def, pipe->node, pipe->start + pipe->length, pipes.number);
        }
        iterator.diameter = fmax(iterator.diameter, dmb_joint_diameter(def));
    }
    if (status >= 0) status = finish_place(&iterator);
    *ring = iterator.ring;
    return status;
}

/* ---- Bodies and bits --------------------------------------------------------------------------------------------- */

static int32_t add_stabilisers(dmb_mesh *mesh)
{
    const dmb_model *model = mesh->model;
    int32_t status = DMB_OK;
    for (uint32_t i = 0; i < model->bodies.count && status >= 0; ++i) {
        const dmb_body_def *def = DMB_LIST_AT(const dmb_body_def, model->bodies, i);
        status = add_stabiliser(mesh, i, def->contact_diameter, 0.0, def->contact_length,
                                dmb_model_id(model, DMB_PART_BODY, i));
    }
    for (uint32_t i = 0; i < model->bits.count && status >= 0; ++i) {
        const dmb_bit_def *def = DMB_LIST_AT(const dmb_bit_def, model->bits, i);
        status = add_stabiliser(mesh, model->bodies.count + i, def->diameter, 0.5 * def->length, def->length,
                                dmb_model_id(model, DMB_PART_BIT, i));
    }
    return status;
}

/* ---- Inside elements --------------------------------------------------------------------------------------------- */

/* Lobatto points inside an element with their weights as lengths; the end points are those of the nodes. Only between
 * six-DOF nodes of which one at least moves sideways. */
static int32_t add_inside(dmb_mesh *mesh, const dmb_pipe_def *def, uint32_t e, dmb_site site)
{
    const dmb_lobatto_rule *rule = dmb_lobatto(def->contact_points);
    const dmb_mesh_element *element = dmb_mesh_element_at(mesh, e);
    const dmb_mesh_node *a = dmb_mesh_node_at(mesh, element->node), *b = a + 1;
    if (a->size != DMB_NODE_SIX_DOF || b->size != DMB_NODE_SIX_DOF) return DMB_OK;
    if (!moves_sideways(a, 1.0) && !moves_sideways(b, 1.0)) return DMB_OK;
    site.node = element->node;
    for (int i = 1; i + 1 < rule->count; ++i) {
        const dmb_scene_point point = {.fraction = rule->node[i], .node = element->node, .element = e};
        site.offset = element->arm[0] + rule->node[i] * element->length;
        site.length = rule->weight[i] * element->length;
        int32_t status = push_site(mesh, &site);
        if (status >= 0) status = dmb_vector_append(&mesh->inside, &mesh->model->allocator, &point, 1);
        if (status < 0) return status;
    }
    return DMB_OK;
}

static int32_t add_string_inside(dmb_mesh *mesh, uint32_t string)
{
    dmb_pipe_iterator pipes = dmb_pipe_iterator_of(mesh, string);
    const dmb_string_map *map = dmb_mesh_string_at(mesh, string);
    int32_t status = DMB_OK;
    while (status >= 0 && dmb_pipe_iterator_next(&pipes)) {
        const dmb_pipe_map *pipe = dmb_mesh_pipe_at(mesh, map->first_pipe + pipes.number);
        const dmb_pipe_def *def = &pipes.run->def;
        const dmb_site site = {.radius = 0.5 * def->outer_diameter,
                               .part = dmb_model_id(mesh->model, DMB_PART_STRING, string),
                               .pipe = pipes.number};
        for (uint32_t e = 0; e < pipe->elements && def->contact_points > 0 && status >= 0; ++e)
            status = add_inside(mesh, def, pipe->element + e, site);
    }
    return status;
}

/* Order of the contact points: strings with their rings in the order of nodes, then bodies and bits, then points inside
 * elements. Queries search them in that order. */
int32_t dmb_mesh_sites(dmb_mesh *mesh)
{
    uint32_t ring = 0;
    int32_t status = dmb_mesh_fits(mesh);
    if ((mesh->features & DMB_FEATURE_CONTACT) == 0) return status;
    for (uint32_t s = 0; s < mesh->strings.count && status >= 0; ++s) status = pass_string(mesh, s, &ring);
    if (status >= 0) status = add_stabilisers(mesh);
    for (uint32_t s = 0; s < mesh->strings.count && status >= 0; ++s) status = add_string_inside(mesh, s);
    return status;
}
