/* The contents of the scene (dmb_scene_fill), from the growing lists of the mesh into the arrays of one block.
 * Properties that a step would test for every part are determined once, here: elements with damping, bends or arms,
 * scenes of beams alone, free rigid bodies. Order: rows and chains first, because drives are found by rows and free
 * bodies by their chains; elements before the lengths of chains, which are means of theirs; joints and contact points
 * before the depths that nodes take over across them (fill_near_sites). */
#include "model/mesh.h"

#include <string.h>

#include "force/hole.h"
#include "kernel/kernels.h"
#include "math/mat6.h"
#include "math/so3.h"

/* ---- Nodes ------------------------------------------------------------------------------------------------------- */

static int32_t fill_layout(const dmb_mesh *mesh, dmb_scene *scene, dmb_scene_storage *w)
{
    dmb_block_totals totals;
    for (uint32_t i = 0; i < scene->node_count; ++i) w->size[i] = dmb_mesh_node_at(mesh, i)->size;
    if (dmb_block_count(scene->node_count, w->size, &totals) < 0) return DMB_ERR_TOO_LARGE;
    dmb_block_fill(scene->node_count, w->size, w->row, w->diag, w->link);
    scene->layout.n = scene->node_count;
    scene->layout.size = w->size;
    scene->layout.row = w->row;
    scene->layout.diag = w->diag;
    scene->layout.link = w->link;
    return DMB_OK;
}

static void fill_pose(const dmb_mesh *mesh, dmb_scene *scene, uint32_t i)
{
    const dmb_mesh_node *node = dmb_mesh_node_at(mesh, i);
    const dmb_environment_def *e = &mesh->model->environment;
    double *damping = scene->node_damping + 5 * (size_t)i;
    dmb_vec3_copy(node->position, scene->reference_position + 3 * (size_t)i);
    dmb_quat_copy(node->quaternion, scene->reference_quaternion + 4 * (size_t)i);
    scene->reference_depth[i] = node->depth;
    scene->weight_mass[i] = node->weight_mass;
    dmb_vec3_copy(node->weight_moment, scene->weight_moment + 3 * (size_t)i);
    if (scene->has_density_input) memcpy(scene->displaced + 2 * (size_t)i, node->displaced, sizeof node->displaced);
    if (scene->has_damping_input) memcpy(scene->damped_length + 3 * (size_t)i, node->damped, sizeof node->damped);
    if ((scene->features & DMB_FEATURE_DAMPING) == 0) return;
    dmb_node_damping_of(node->damped, e->axial_damping, e->torsional_damping, e->lateral_damping, damping);
}

/* Marks free, solved and constrained rows; `held` counts the constrained rows so far. */
static void fill_rows(const dmb_mesh *mesh, dmb_scene *scene, uint32_t i, uint32_t *held)
{
    const dmb_mesh_node *node = dmb_mesh_node_at(mesh, i);
    const uint8_t open = dmb_free_rows(node), moved = dmb_prescribed_rows(node);
    const uint32_t first = scene->layout.row[i];
    for (uint32_t k = 0; k < node->size; ++k) {
        scene->free_row[first + k] = (uint8_t)(open >> k & 1);
        scene->solved_row[first + k] = (uint8_t)((open & ~moved) >> k & 1);
        if (scene->solved_row[first + k]) continue;
        scene->constrained_node[*held] = i;
        scene->constrained_component[*held] = k;
        ++*held;
    }
}

/* Velocity of a string as a rigid body at a six-DOF node: Ad(H)^-1 of that of the rig end, H the node relative to it.
 * Axial-torsional nodes move along and about the axis as the rig end does, so that the string keeps its length on a
 * curved axis. */
static void string_velocity(const dmb_mesh *mesh, const dmb_mesh_node *node, double v[6])
{
    const dmb_string_map *map = dmb_mesh_string_at(mesh, node->string);
    const dmb_mesh_node *start = dmb_mesh_node_at(mesh, map->start_node);
    const double *given = dmb_mesh_string_def(mesh, node->string)->velocity;
    double q[4], R[9], x[3];
    dmb_vec6_copy(given, v);
    if (node->size == DMB_NODE_AXIAL_TORSIONAL) return;
    dmb_quat_between(start->quaternion, node->quaternion, q);
    dmb_quat_to_matrix(q, R);
    dmb_vec3_sub(node->position, start->position, x);
    dmb_quat_rotate_inverse(start->quaternion, x, x);
    x[0] -= map->start_arm; /* the rig end may be behind its node */
    dmb_adjoint_inverse_apply(R, x, given, v);
}

static void fill_velocity(const dmb_mesh *mesh, dmb_scene *scene, uint32_t i)
{
    const dmb_mesh_node *node = dmb_mesh_node_at(mesh, i);
    double *row = scene->initial_velocity + scene->layout.row[i], v[6];
    if (node->string == DMB_NONE) {
        dmb_vec6_copy(DMB_LIST_AT(const dmb_body_def, mesh->model->bodies, node->body)->velocity, row);
        return;
    }
    string_velocity(mesh, node, v);
    if (node->size == DMB_NODE_SIX_DOF) {
        dmb_vec6_copy(v, row);
        return;
    }
    row[0] = v[DMB_X];
    row[1] = v[DMB_RX];
}

/* Rigid masses, created string by string, sorted by node. */
static void fill_rigid_masses(const dmb_mesh *mesh, dmb_scene *scene)
{
    dmb_rigid_mass *next = scene->rigid_masses;
    for (uint32_t i = 0; i < scene->node_count; ++i) {
        const uint32_t rigid_mass = dmb_mesh_node_at(mesh, i)->rigid_mass;
        if (rigid_mass != DMB_NONE) *next++ = *DMB_VECTOR_AT(dmb_rigid_mass, &mesh->rigid_masses, rigid_mass);
    }
}

static void fill_added_masses(const dmb_mesh *mesh, dmb_scene *scene)
{
    dmb_added_mass *next = scene->added_masses;
    for (uint32_t i = 0; i < scene->node_count && scene->added_mass_count > 0; ++i) {
        const uint32_t added = dmb_mesh_node_at(mesh, i)->added_mass;
        if (added != DMB_NONE) *next++ = *DMB_VECTOR_AT(dmb_added_mass, &mesh->added_masses, added);
    }
}

static uint32_t added_mass_on(const dmb_scene *scene, uint32_t node)
{
    for (uint32_t i = 0; i < scene->added_mass_count; ++i)
        if (scene->added_masses[i].node == node) return i;
    return DMB_NONE;
}

/* 1: a chain of one node; before elements are filled in. */
static int is_alone(const dmb_scene *scene, uint32_t node)
{
    for (uint32_t c = 0; c < scene->chain_count; ++c)
        if (scene->chains[c].first == node) return scene->chains[c].count == 1;
    return 0;
}

/* Free rigid bodies, as counted: single unconstrained nodes. */
static void fill_free_rigids(dmb_scene *scene)
{
    dmb_free_rigid *next = scene->free_rigids;
    for (uint32_t i = 0; i < scene->rigid_mass_count && scene->free_rigid_count > 0; ++i) {
        const dmb_rigid_mass *rigid_mass = scene->rigid_masses + i;
        const uint32_t row = scene->layout.row[rigid_mass->node];
        int is_free = scene->layout.size[rigid_mass->node] == DMB_NODE_SIX_DOF && is_alone(scene, rigid_mass->node);
        for (uint32_t k = 0; k < scene->layout.size[rigid_mass->node]; ++k)
            is_free = is_free && scene->solved_row[row + k];
        if (!is_free) continue;
        dmb_vec3_scale(1.0 / rigid_mass->mass, rigid_mass->moment, next->centre);
        next->node = rigid_mass->node;
        next->rigid_mass = i;
        next->added_mass = added_mass_on(scene, rigid_mass->node);
        ++next;
    }
}

static void fill_rotors(const dmb_mesh *mesh, dmb_scene *scene)
{
    uint32_t rigid_mass = 0;
    for (uint32_t i = 0; i < scene->rotor_count; ++i) {
        dmb_scene_rotor *rotor = scene->rotors + i;
        *rotor = DMB_VECTOR_AT(dmb_mesh_rotor, &mesh->rotors, i)->rotor;
        while (scene->rigid_masses[rigid_mass].node != rotor->node) ++rigid_mass; /* by node, as rotors are */
        rotor->rigid_mass = rigid_mass;
        rotor->added_mass = added_mass_on(scene, rotor->node);
    }
}

/* Nodes of a string follow each other and are one chain; every body that is no part of a string is a chain of one
 * node. */
static void fill_chains(const dmb_mesh *mesh, dmb_scene *scene)
{
    uint32_t chain = 0;
    for (uint32_t i = 0; i < scene->node_count; i += scene->chains[chain++].count) {
        const dmb_mesh_node *node = dmb_mesh_node_at(mesh, i);
        scene->chains[chain].first = i;
        scene->chains[chain].count = node->string == DMB_NONE ? 1 : dmb_mesh_string_at(mesh, node->string)->node_count;
    }
}

static void fill_nodes(const dmb_mesh *mesh, dmb_scene *scene)
{
    uint32_t held = 0;
    for (uint32_t i = 0; i < scene->node_count; ++i) {
        fill_pose(mesh, scene, i);
        fill_rows(mesh, scene, i, &held);
        if (scene->velocity_count) fill_velocity(mesh, scene, i);
        scene->node_element[i] = DMB_NONE;
    }
    fill_chains(mesh, scene);
    fill_rigid_masses(mesh, scene);
    fill_added_masses(mesh, scene);
    fill_free_rigids(scene);
    fill_rotors(mesh, scene);
}

/* ---- Elements and the rest --------------------------------------------------------------------------------------- */

static void copy_items(const dmb_vector *from, void *to)
{
    if (from->count > 0) memcpy(to, from->items, from->count * from->item_size);
}

/* The length scale L0 is the mean length of the elements: a rotation of 1 rad then counts as the displacement that it
 * gives to the far end of an element (weights D of lib/theory/statics.md, limits of corrections). Without elements
 * it is 1 m. */
static void fill_elements(const dmb_mesh *mesh, dmb_scene *scene)
{
    double length = 0.0;
    for (uint32_t e = 0; e < scene->element_count; ++e) {
        const dmb_mesh_element *element = dmb_mesh_element_at(mesh, e);
        scene->element_type[e] = element->type;
        scene->element_node[e] = element->node;
        scene->node_element[element->node] = e;
        dmb_vec3_copy(element->span, scene->element_span + 3 * (size_t)e);
        length += DMB_VECTOR_AT(dmb_element_type, &mesh->types, element->type)->length;
    }
    scene->length_scale = scene->element_count > 0 ? length / scene->element_count : 1.0;
    copy_items(&mesh->types, scene->types);
    for (uint32_t i = 0; i < scene->type_count; ++i) {
        const dmb_element_type *type = scene->types + i;
        if (type->damping_time != 0.0) scene->damped = 1;
        if (dmb_element_is_curved(type)) scene->curved = 1;
        if (type->arm[0] != 0.0 || type->arm[1] != 0.0) scene->arms = 1;
    }
    scene->kernels = dmb_kernels_widest();
    copy_items(&mesh->batches, scene->batches);
    scene->beams_only = 1;
    for (uint32_t i = 0; i < scene->batch_count; ++i)
        if (scene->batches[i].kernel != DMB_KERNEL_BEAM) scene->beams_only = 0;
}

static void fill_drives(const dmb_mesh *mesh, dmb_scene *scene)
{
    copy_items(&mesh->drives, scene->drives);
    for (uint32_t i = 0; i < scene->drive_count; ++i) {
        dmb_scene_drive *drive = scene->drives + i;
        if (drive->node == DMB_NONE) continue; /* it drives a joint */
        const bool path = scene->layout.size[drive->node] == DMB_NODE_AXIAL_TORSIONAL;
        const uint32_t component = (uint32_t)drive->component;
        /* an axial-torsional node has the rows X and RX alone: components 0 and 3 are its rows 0 and 1 */
        drive->row = scene->layout.row[drive->node] + (path ? component / (uint32_t)DMB_RX : component);
    }
}

/* A joint's drives in the order in which they were added, which is that of its rows. Counting sort: numbers, then first
 * places, then the numbers once more as the next place of each joint. */
static void fill_joint_drives(dmb_scene *scene)
{
    uint32_t first = 0;
    for (uint32_t i = 0; i < scene->drive_count; ++i)
        if (scene->drives[i].joint != DMB_NONE) scene->joints[scene->drives[i].joint].drive_count++;
    for (uint32_t j = 0; j < scene->joint_count; first += scene->joints[j++].drive_count)
        scene->joints[j].first_drive = first;
    for (uint32_t j = 0; j < scene->joint_count; ++j) scene->joints[j].drive_count = 0;
    for (uint32_t i = 0; i < scene->drive_count; ++i) {
        if (scene->drives[i].joint == DMB_NONE) continue;
        dmb_scene_joint *joint = scene->joints + scene->drives[i].joint;
        scene->joint_drives[joint->first_drive + joint->drive_count++] = i;
    }
}

static void fill_flow(const dmb_mesh *mesh, dmb_scene *scene)
{
    if (scene->flow_count == 0) return;
    scene->flow = mesh->flow;
    copy_items(&mesh->flow_pieces, scene->flow_pieces);
    dmb_scene_fill_pulls(scene);
}

/* Contact points of strings come in the order of their nodes, those of bodies behind them in that of their description.
 * Only the first are divided into chunks: two chunks must not add to the same node. */
static uint32_t sites_in_order(const dmb_scene *scene)
{
    const uint32_t count = dmb_node_sites(scene);
    uint32_t s = count > 0;
    while (s < count && scene->sites[s].node >= scene->sites[s - 1].node) s++;
    return s;
}

static void fill_parts(const dmb_mesh *mesh, dmb_scene *scene)
{
    copy_items(&mesh->sites, scene->sites);
    scene->sites_in_order = sites_in_order(scene);
    copy_items(&mesh->axial_torsional_sites, scene->axial_torsional_sites);
    copy_items(&mesh->inside, scene->inside);
    copy_items(&mesh->actuators, scene->actuators);
    copy_items(&mesh->gain_tables, scene->gain_tables);
    copy_items(&mesh->loads, scene->loads);
    copy_items(&mesh->bits, scene->bits);
    copy_items(&mesh->inputs, scene->inputs);
    copy_items(&mesh->load_points, scene->load_points);
    copy_items(&mesh->springs, scene->springs);
    copy_items(&mesh->forces, scene->forces);
    copy_items(&mesh->stuck, scene->stuck);
    copy_items(&mesh->spring_points, scene->spring_points);
    copy_items(&mesh->events, scene->events);
    copy_items(&mesh->strings, scene->strings);
    copy_items(&mesh->pipes, scene->pipes);
    copy_items(&mesh->bodies, scene->bodies);
    copy_items(&mesh->rings, scene->rings);
    copy_items(&mesh->joints, scene->joints);
    copy_items(&mesh->couplings, scene->couplings);
    copy_items(&mesh->callbacks, scene->callbacks);
    copy_items(&mesh->laws, scene->laws);
    copy_items(&mesh->constraints, scene->constraints);
    copy_items(&mesh->clusters, scene->clusters);
    copy_items(&mesh->cluster_nodes, scene->cluster_nodes);
    scene->time_functions = mesh->model->time_functions.items; /* owned by the model, which outlives the scene */
    for (uint32_t s = 0; s < scene->string_count; ++s) scene->length += scene->strings[s].length;
}

/* ---- Wall -------------------------------------------------------------------------------------------------------- */

/* Constants that laws derive from the description (damping factor from the restitution, eq:contact.exact; correction of
 * the peak, eq:friction.peak) are computed here, once. A feature that is switched off becomes the kind NONE, which the
 * kernels skip. */
static void fill_laws(const dmb_model *model, dmb_scene *scene)
{
    const dmb_wall_def *w = &model->wall;
    const bool contact = (scene->features & DMB_FEATURE_CONTACT) != 0;
    const bool friction = (scene->features & DMB_FEATURE_FRICTION) != 0;
    const dmb_friction_law law = {.kind = friction ? w->friction_law : DMB_FRICTION_NONE,
                                  .mu_static = w->mu_static,
                                  .mu_dynamic = w->mu_dynamic,
                                  .stribeck_speed = w->stribeck_speed,
                                  .smoothing_speed = w->smoothing_speed,
                                  .full_speed = w->full_speed,
                                  .bristle_stiffness = w->bristle_stiffness,
                                  .bristle_damping = w->bristle_damping,
                                  .points = (int32_t)w->friction_table_count,
                                  .table_speed =
                                      w->friction_table_speed, /* owned by the model, which outlives the scene */
                                  .table_mu = w->friction_table_mu,
                                  .callback = w->friction_callback,
                                  .accept = w->friction_accept,
                                  .context = w->friction_context,
                                  .states = w->friction_law == DMB_FRICTION_BRISTLE ? 2 : w->friction_state_count};
    scene->normal_law = dmb_normal_law_of((dmb_normal_law){.kind = contact ? w->normal_law : DMB_NORMAL_NONE,
                                                           .stiffness = w->stiffness,
                                                           .exponent = w->exponent,
                                                           .damping = w->damping,
                                                           .impact_depth = w->impact_depth,
                                                           .impact_floor = w->approach_speed},
                                          w->restitution);
    scene->friction_law = dmb_friction_law_of(law);
}

/* Points the hole to the scene's own stations and pieces. */
static void fill_hole(const dmb_mesh *mesh, dmb_scene *scene, dmb_scene_storage *w)
{
    scene->has_hole = mesh->has_hole;
    scene->hole = mesh->hole;
    if (mesh->hole.pieces > 0) {
        copy_items(&mesh->pieces, w->pieces);
        scene->hole.piece = w->pieces;
    }
    if (mesh->hole.stations == 0) return;
    copy_items(&mesh->stations, w->stations);
    scene->hole.station = w->stations;
}

/* ---- Sites near nodes -------------------------------------------------------------------------------------------- */

static int copy_near(uint32_t *near_contact, uint32_t from, uint32_t to)
{
    if (near_contact[to] != DMB_NONE || near_contact[from] == DMB_NONE) return 0;
    near_contact[to] = near_contact[from];
    return 1;
}

/* Copies values from neighbours along the chain, towards the rig end first. */
static void spread_along(dmb_scene *scene)
{
    for (uint32_t i = scene->node_count; i-- > 1;)
        if (scene->node_element[i - 1] != DMB_NONE) (void)copy_near(scene->near_contact, i, i - 1);
    for (uint32_t i = 1; i < scene->node_count; ++i)
        if (scene->node_element[i - 1] != DMB_NONE) (void)copy_near(scene->near_contact, i - 1, i);
}

/* Across joints: for bodies and strings without a contact point of their own. */
static int spread_across(dmb_scene *scene)
{
    int more = 0;
    for (uint32_t j = 0; j < scene->joint_count; ++j) {
        const uint32_t a = scene->joints[j].a.node, b = scene->joints[j].b.node;
        if (a == DMB_NONE) continue;
        more |= copy_near(scene->near_contact, a, b);
        more |= copy_near(scene->near_contact, b, a);
    }
    return more;
}

/* The search for the place of a node along the hole needs a start (eq:hole.foot has several roots in a hole that turns
 * back): the depth of the nearest contact point, which each step finds anew. From last to first, so that of several
 * points on a node the first counts; then alternately along chains and across joints until nothing changes. */
static void fill_near_sites(dmb_scene *scene)
{
    if (scene->near_contact == NULL) return;
    for (uint32_t i = 0; i < scene->node_count; ++i) scene->near_contact[i] = DMB_NONE;
    for (uint32_t s = scene->site_count; s-- > 0;) scene->near_contact[scene->sites[s].node] = s;
    do spread_along(scene);
    while (spread_across(scene));
}

/* ---- Lengths ----------------------------------------------------------------------------------------------------- */

/* [m] Smallest length of a body used as a length scale. */
#define DMB_BODY_LENGTH_MIN 1e-9

static double mean_element(const dmb_scene *scene, const dmb_chain *chain)
{
    double sum = 0.0;
    for (uint32_t i = chain->first; i + 1 < chain->first + chain->count; ++i)
        sum += scene->types[scene->element_type[scene->node_element[i]]].length;
    return sum / (chain->count - 1);
}

static void lengthen(dmb_scene *scene, const uint32_t *chain_of, const dmb_scene_frame *frame)
{
    if (frame->node == DMB_NONE) return;
    dmb_chain *chain = scene->chains + chain_of[frame->node];
    if (chain->count == 1) chain->length = fmax(chain->length, dmb_vec3_norm(frame->x));
}

static void lengthen_to(dmb_scene *scene, const uint32_t *chain_of, const dmb_scene_point *point)
{
    if (point->node == DMB_NONE) return;
    dmb_chain *chain = scene->chains + chain_of[point->node];
    if (chain->count == 1) chain->length = fmax(chain->length, dmb_vec3_norm(point->x));
}

/* Length of a chain, by which its moments are divided where they are compared with forces (norms of the residual,
 * weights of eq:joints.partition): of a string its mean element; of a body, with trace J = 2 integral of r^2 dm, the
 * root mean square distance sqrt(trace J/(2 m)) of its mass from the reference point, or the longest arm of a joint,
 * spring or force if that is longer. A point mass has none: 1 m. */
static void fill_lengths(dmb_scene *scene)
{
    uint32_t *chain_of = scene->node_chain;
    for (uint32_t c = 0; c < scene->chain_count; ++c) {
        dmb_chain *chain = scene->chains + c;
        for (uint32_t i = 0; i < chain->count; ++i) chain_of[chain->first + i] = c;
        chain->length = chain->count > 1 ? mean_element(scene, chain) : 0.0;
    }
    for (uint32_t i = 0; i < scene->rigid_mass_count; ++i) {
        const dmb_rigid_mass *rigid_mass = scene->rigid_masses + i;
        dmb_chain *chain = scene->chains + chain_of[rigid_mass->node];
        const double trace = rigid_mass->inertia[0] + rigid_mass->inertia[1] + rigid_mass->inertia[2];
        if (chain->count == 1 && rigid_mass->mass > 0.0) chain->length = sqrt(0.5 * trace / rigid_mass->mass);
    }
    for (uint32_t j = 0; j < scene->joint_count; ++j) {
        lengthen(scene, chain_of, &scene->joints[j].a);
        lengthen(scene, chain_of, &scene->joints[j].b);
    }
    for (uint32_t i = 0; i < scene->spring_count; ++i) {
        lengthen_to(scene, chain_of, &scene->springs[i].a);
        lengthen_to(scene, chain_of, &scene->springs[i].b);
    }
    for (uint32_t i = 0; i < scene->force_count; ++i)
        for (uint32_t k = 0; k < scene->forces[i].count; ++k) lengthen_to(scene, chain_of, &scene->forces[i].point[k]);
    for (uint32_t i = 0; i < scene->stuck_count; ++i) lengthen_to(scene, chain_of, &scene->stuck[i].point);
    for (uint32_t c = 0; c < scene->chain_count; ++c)
        if (!(scene->chains[c].length > DMB_BODY_LENGTH_MIN)) scene->chains[c].length = 1.0;
}

/* An upper bound of l/m over all contact points: times the stiffness of the wall per metre it bounds the square of the
 * frequency at which any of them can bounce, without a look at each. */
static void fill_mobility(dmb_scene *scene)
{
    scene->site_mobility = 0.0;
    for (uint32_t s = 0; s < scene->site_count; ++s)
        scene->site_mobility = fmax(scene->site_mobility, scene->sites[s].length * dmb_site_mobility(scene, s));
}

int32_t dmb_scene_fill(const dmb_mesh *mesh, dmb_scene *scene, dmb_scene_storage *storage)
{
    const int32_t status = fill_layout(mesh, scene, storage);
    if (status < 0) return status;
    fill_nodes(mesh, scene);
    fill_elements(mesh, scene);
    fill_parts(mesh, scene);
    fill_drives(mesh, scene);
    fill_joint_drives(scene);
    fill_laws(mesh->model, scene);
    fill_hole(mesh, scene, storage);
    fill_near_sites(scene);
    fill_flow(mesh, scene);
    fill_lengths(scene);
    fill_mobility(scene);
    return DMB_OK;
}
