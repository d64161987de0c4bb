/* Constraint rows of joints, couplings, joint drives and the caller's constraints, and the constraint components: sets
 * of nodes connected by them. Springs and forces between nodes that are not neighbours in a chain take part with an
 * idle row: they have no equation, but a tangent between nodes that only a component has room for.
 *
 *     add_all           constraints, kind by kind: nodes, columns, largest number of rows
 *     make_clusters     components by union-find, numbered by their smallest nodes
 *     sort_by_cluster   constraints of a component side by side
 *     number_rows       rows and storage in that order
 *     choose_storage    dense (eq:joints.partition) or sparse, by the number of nodes */
#include "base/memory.h"
#include "model/field_check.h"
#include "model/mesh.h"

static dmb_scene_joint *joint_at(const dmb_mesh *mesh, uint32_t i)
{
    return DMB_VECTOR_AT(dmb_scene_joint, &mesh->joints, i);
}
static dmb_scene_coupling *coupling_at(const dmb_mesh *mesh, uint32_t i)
{
    return DMB_VECTOR_AT(dmb_scene_coupling, &mesh->couplings, i);
}
static dmb_scene_callback *callback_at(const dmb_mesh *mesh, uint32_t i)
{
    return DMB_VECTOR_AT(dmb_scene_callback, &mesh->callbacks, i);
}
static dmb_scene_spring *spring_at(const dmb_mesh *mesh, uint32_t i)
{
    return DMB_VECTOR_AT(dmb_scene_spring, &mesh->springs, i);
}
static dmb_scene_force *force_at(const dmb_mesh *mesh, uint32_t i)
{
    return DMB_VECTOR_AT(dmb_scene_force, &mesh->forces, i);
}
static dmb_scene_drive *drive_at(const dmb_mesh *mesh, uint32_t i)
{
    return DMB_VECTOR_AT(dmb_scene_drive, &mesh->drives, i);
}
static dmb_constraint *constraint_at(const dmb_mesh *mesh, uint32_t i)
{
    return DMB_VECTOR_AT(dmb_constraint, &mesh->constraints, i);
}
static dmb_cluster *cluster_at(const dmb_mesh *mesh, uint32_t i)
{
    return DMB_VECTOR_AT(dmb_cluster, &mesh->clusters, i);
}

/* ---- Constraints, kind by kind ----------------------------------------------------------------------------------- */

/* Adds a node to a constraint, once; the ground has no columns. */
static void touch(const dmb_mesh *mesh, uint32_t node, dmb_constraint *constraint)
{
    if (node == DMB_NONE) return;
    for (uint32_t i = 0; i < constraint->node_count; ++i) {
        if (constraint->node[i] == node) return;
    }
    constraint->node[constraint->node_count] = node;
    constraint->column[constraint->node_count] = constraint->columns;
    ++constraint->node_count;
    constraint->columns += dmb_mesh_node_at(mesh, node)->size;
}

static void touch_joint(const dmb_mesh *mesh, uint32_t joint, dmb_constraint *constraint)
{
    touch(mesh, joint_at(mesh, joint)->a.node, constraint);
    touch(mesh, joint_at(mesh, joint)->b.node, constraint);
}

static int32_t push(dmb_mesh *mesh, const dmb_constraint *constraint)
{
    return dmb_vector_append(&mesh->constraints, &mesh->model->allocator, constraint, 1);
}

/* A joint has room for six rows: locked in a run it needs them all. */
static int32_t add_joint(dmb_mesh *mesh, uint32_t i)
{
    dmb_constraint constraint = {.kind = DMB_OF_JOINT, .index = i, .rows = DMB_CONSTRAINT_ROWS};
    touch_joint(mesh, i, &constraint);
    return push(mesh, &constraint);
}

/* A coupling has one equation between the coordinates of its joints; its columns are those of all their nodes. */
static int32_t add_coupling(dmb_mesh *mesh, uint32_t i)
{
    dmb_constraint constraint = {.kind = DMB_OF_COUPLING, .index = i, .rows = 1};
    const dmb_scene_coupling *coupling = coupling_at(mesh, i);
    for (uint32_t k = 0; k < coupling->count; ++k) touch_joint(mesh, coupling->joint[k], &constraint);
    return push(mesh, &constraint);
}

/* A motion drive of a joint is an equation of its own. Other drives are forces, and a motion drive at a node prescribes
 * a row instead. */
static int32_t add_drive(dmb_mesh *mesh, uint32_t i)
{
    const dmb_scene_drive *drive = drive_at(mesh, i);
    dmb_constraint constraint = {.kind = DMB_OF_DRIVE, .index = i, .rows = 1};
    if (drive->joint == DMB_NONE || drive->kind != DMB_DRIVE_MOTION) return DMB_OK;
    touch_joint(mesh, drive->joint, &constraint);
    return push(mesh, &constraint);
}

static int32_t add_callback(dmb_mesh *mesh, uint32_t i)
{
    const dmb_scene_callback *callback = callback_at(mesh, i);
    dmb_constraint constraint = {.kind = DMB_OF_CALLBACK, .index = i, .rows = callback->rows};
    for (uint32_t k = 0; k < callback->count; ++k) touch(mesh, callback->place[k].node, &constraint);
    return push(mesh, &constraint);
}

static void touch_point(const dmb_mesh *mesh, const dmb_scene_point *point, dmb_constraint *constraint)
{
    touch(mesh, point->node, constraint);
    if (point->element != DMB_NONE) touch(mesh, point->node + 1, constraint);
}

/* True if the tangent of a force has storage in the chain: forces within one node, or the two nodes of an element. */
static bool is_local(const dmb_mesh *mesh, const dmb_constraint *constraint)
{
    if (constraint->node_count < 2) return true;
    const uint32_t a = constraint->node[0], b = constraint->node[1], first = a < b ? a : b;
    if (constraint->node_count > 2 || (a < b ? b - a : a - b) != 1) return false;
    return dmb_mesh_node_at(mesh, a)->string != DMB_NONE &&
           dmb_mesh_node_at(mesh, first)->string == dmb_mesh_node_at(mesh, first + 1)->string;
}

/* A constraint with one idle row, for the tangent of a spring. */
static int32_t add_spring(dmb_mesh *mesh, uint32_t i)
{
    dmb_constraint constraint = {.kind = DMB_OF_SPRING, .index = i, .rows = 1};
    touch_point(mesh, &spring_at(mesh, i)->a, &constraint);
    touch_point(mesh, &spring_at(mesh, i)->b, &constraint);
    return is_local(mesh, &constraint) ? DMB_OK : push(mesh, &constraint);
}

/* Four places inside elements, or four joints, have eight nodes at most. */
static int32_t add_force(dmb_mesh *mesh, uint32_t i)
{
    const dmb_scene_force *force = force_at(mesh, i);
    dmb_constraint constraint = {.kind = DMB_OF_FORCE, .index = i, .rows = 1};
    bool on_joint = false;
    for (uint32_t k = 0; k < force->count; ++k) {
        on_joint = on_joint || force->joint[k] != DMB_NONE;
        if (force->joint[k] != DMB_NONE)
            touch_joint(mesh, force->joint[k], &constraint);
        else
            touch_point(mesh, &force->point[k], &constraint);
    }
    return is_local(mesh, &constraint) && !on_joint ? DMB_OK : push(mesh, &constraint);
}

static int32_t add_all(dmb_mesh *mesh)
{
    int32_t status = DMB_OK;
    for (uint32_t i = 0; i < mesh->joints.count && status >= 0; ++i) status = add_joint(mesh, i);
    for (uint32_t i = 0; i < mesh->couplings.count && status >= 0; ++i) status = add_coupling(mesh, i);
    for (uint32_t i = 0; i < mesh->drives.count && status >= 0; ++i) status = add_drive(mesh, i);
    for (uint32_t i = 0; i < mesh->callbacks.count && status >= 0; ++i) status = add_callback(mesh, i);
    for (uint32_t i = 0; i < mesh->springs.count && status >= 0; ++i) status = add_spring(mesh, i);
    for (uint32_t i = 0; i < mesh->forces.count && status >= 0; ++i) status = add_force(mesh, i);
    return status;
}

/* ---- Clusters ---------------------------------------------------------------------------------------------------- */

/* Union-find with the smallest node of each set as its root; DMB_NONE: in no constraint. */
static uint32_t root_of(uint32_t *parent, uint32_t i)
{
    while (parent[i] != i) {
        parent[i] = parent[parent[i]];
        i = parent[i];
    }
    return i;
}

static void join(uint32_t *parent, const dmb_constraint *constraint)
{
    for (uint32_t k = 0; k < constraint->node_count; ++k) {
        if (parent[constraint->node[k]] == DMB_NONE) parent[constraint->node[k]] = constraint->node[k];
        const uint32_t a = root_of(parent, constraint->node[0]), b = root_of(parent, constraint->node[k]);
        parent[a < b ? b : a] = a < b ? a : b;
    }
}

/* cluster[i] := number of the component of node i, in the order of their smallest nodes; DMB_NONE: none. Counts nodes
 * and columns. */
static int32_t number_clusters(dmb_mesh *mesh, uint32_t *parent, uint32_t *cluster)
{
    for (uint32_t i = 0; i < mesh->nodes.count; ++i) {
        cluster[i] = DMB_NONE;
        if (parent[i] == DMB_NONE) continue;
        const uint32_t root = root_of(parent, i);
        if (root == i) {
            const int32_t status = dmb_vector_append(&mesh->clusters, &mesh->model->allocator, NULL, 1);
            if (status < 0) return status;
        }
        cluster[i] = root == i ? (uint32_t)mesh->clusters.count - 1 : cluster[root];
        dmb_cluster *of = cluster_at(mesh, cluster[i]);
        ++of->node_count;
        of->columns += dmb_mesh_node_at(mesh, i)->size; /* 6 * 2^24 at most */
    }
    return DMB_OK;
}

/* Nodes of the clusters side by side, ascending in each; columns in the same order. */
static int32_t list_nodes(dmb_mesh *mesh, const uint32_t *cluster)
{
    uint32_t first = 0, column = 0;
    for (uint32_t c = 0; c < mesh->clusters.count; ++c) {
        dmb_cluster *of = cluster_at(mesh, c);
        of->node = first;
        of->column = column;
        of->block = c;
        first += of->node_count;
        column += of->columns;
        of->node_count = 0;
    }
    const int32_t status = dmb_vector_append(&mesh->cluster_nodes, &mesh->model->allocator, NULL, first);
    if (status < 0) return status;
    for (uint32_t i = 0; i < mesh->nodes.count; ++i) {
        if (cluster[i] == DMB_NONE) continue;
        dmb_cluster *of = cluster_at(mesh, cluster[i]);
        *DMB_VECTOR_AT(uint32_t, &mesh->cluster_nodes, of->node + of->node_count++) = i;
    }
    return DMB_OK;
}

static int32_t make_clusters(dmb_mesh *mesh)
{
    const dmb_allocator *allocator = &mesh->model->allocator;
    const size_t n = mesh->nodes.count;
    dmb_vector both = dmb_vector_of(sizeof(uint32_t)); /* first parents, then components */
    int32_t status = dmb_vector_append(&both, allocator, NULL, 2 * n);
    if (status >= 0) {
        uint32_t *parent = both.items, *cluster = parent + n;
        for (size_t i = 0; i < n; ++i) parent[i] = DMB_NONE;
        for (uint32_t i = 0; i < mesh->constraints.count; ++i) join(parent, constraint_at(mesh, i));
        status = number_clusters(mesh, parent, cluster);
        if (status >= 0) status = list_nodes(mesh, cluster);
        for (uint32_t i = 0; i < mesh->constraints.count; ++i) {
            constraint_at(mesh, i)->cluster = cluster[constraint_at(mesh, i)->node[0]];
        }
    }
    dmb_vector_release(&both, allocator);
    return status;
}

/* ---- Order, numbers, limits -------------------------------------------------------------------------------------- */

/* Sorts constraints by component, keeping their order within each. */
static int32_t sort_by_cluster(dmb_mesh *mesh)
{
    const dmb_allocator *allocator = &mesh->model->allocator;
    dmb_vector sorted = dmb_vector_of(sizeof(dmb_constraint));
    uint32_t first = 0;
    const int32_t status = dmb_vector_append(&sorted, allocator, NULL, mesh->constraints.count);
    if (status < 0) return status;
    for (uint32_t i = 0; i < mesh->constraints.count; ++i) {
        ++cluster_at(mesh, constraint_at(mesh, i)->cluster)->constraint_count;
    }
    for (uint32_t c = 0; c < mesh->clusters.count; ++c) {
        dmb_cluster *cluster = cluster_at(mesh, c);
        cluster->constraint = first;
        first += cluster->constraint_count;
        cluster->constraint_count = 0;
    }
    for (uint32_t i = 0; i < mesh->constraints.count; ++i) {
        dmb_cluster *cluster = cluster_at(mesh, constraint_at(mesh, i)->cluster);
        *DMB_VECTOR_AT(dmb_constraint, &sorted, cluster->constraint + cluster->constraint_count++) =
            *constraint_at(mesh, i);
    }
    dmb_vector_release(&mesh->constraints, allocator);
    mesh->constraints = sorted;
    return DMB_OK;
}

static void refer_back(const dmb_mesh *mesh, const dmb_constraint *constraint, uint32_t number)
{
    switch (constraint->kind) {
    case DMB_OF_JOINT: joint_at(mesh, constraint->index)->constraint = number; break;
    case DMB_OF_COUPLING: coupling_at(mesh, constraint->index)->constraint = number; break;
    case DMB_OF_DRIVE: drive_at(mesh, constraint->index)->constraint = number; break;
    case DMB_OF_SPRING: spring_at(mesh, constraint->index)->constraint = number; break;
    case DMB_OF_FORCE: force_at(mesh, constraint->index)->constraint = number; break;
    default: callback_at(mesh, constraint->index)->constraint = number; break;
    }
}

/* Numbers rows and storage; false if 32 bits are not enough. */
static bool number_rows(const dmb_mesh *mesh)
{
    uint64_t row = 0, jacobian = 0, tangent = 0;
    for (uint32_t i = 0; i < mesh->constraints.count; ++i) {
        dmb_constraint *constraint = constraint_at(mesh, i);
        dmb_cluster *cluster = cluster_at(mesh, constraint->cluster);
        if (i == cluster->constraint) cluster->row = (uint32_t)row;
        constraint->row = (uint32_t)row;
        constraint->jacobian = (uint32_t)jacobian;
        constraint->tangent = (uint32_t)tangent;
        cluster->rows += constraint->rows;
        refer_back(mesh, constraint, i);
        row += constraint->rows;
        jacobian += (uint64_t)constraint->rows * constraint->columns;
        tangent += (uint64_t)constraint->columns * constraint->columns;
        if ((row | jacobian | tangent) > UINT32_MAX) return false;
    }
    return true;
}

/* Name of a component: its first constraint. */
static const char *name_of(const dmb_mesh *mesh, const dmb_cluster *cluster, dmb_message *text)
{
    const dmb_constraint *first = constraint_at(mesh, cluster->constraint);
    const uint32_t i = first->index;
    if (first->kind == DMB_OF_JOINT) return dmb_part_text(text, "cluster of joint", i, joint_at(mesh, i)->name, 24);
    if (first->kind == DMB_OF_SPRING) return dmb_part_text(text, "cluster of spring", i, spring_at(mesh, i)->name, 24);
    if (first->kind == DMB_OF_FORCE) return dmb_part_text(text, "cluster of force", i, force_at(mesh, i)->name, 24);
    return dmb_part_text(text, "cluster of constraint", i, callback_at(mesh, i)->name, 24);
}

static int32_t check_size(const dmb_mesh *mesh, const dmb_cluster *cluster)
{
    dmb_message part;
    dmb_check check = dmb_check_of(&mesh->model->message, name_of(mesh, cluster, &part), DMB_NONE);
    dmb_message bound;
    if (cluster->columns > DMB_CLUSTER_COLUMNS_MAX) {
        dmb_message_set(&bound, "<= %d", DMB_CLUSTER_COLUMNS_MAX);
        dmb_check_fail(&check, DMB_ERR_TOO_LARGE, "coordinates", cluster->columns, bound.text);
    }
    if (cluster->rows > DMB_CLUSTER_ROWS_MAX) {
        dmb_message_set(&bound, "<= %d", DMB_CLUSTER_ROWS_MAX);
        dmb_check_fail(&check, DMB_ERR_TOO_LARGE, "equations", cluster->rows, bound.text);
    }
    return check.status;
}

/* Chooses dense or sparse storage of a component, whichever is faster. */
static int32_t choose_storage(const dmb_mesh *mesh)
{
    for (uint32_t c = 0; c < mesh->clusters.count; ++c) {
        dmb_cluster *cluster = cluster_at(mesh, c);
        cluster->sparse = cluster->node_count >= mesh->model->sparse_nodes;
        const int32_t status = cluster->sparse ? DMB_OK : check_size(mesh, cluster);
        if (status < 0) return status;
    }
    return DMB_OK;
}

int32_t dmb_mesh_constraints(dmb_mesh *mesh)
{
    int32_t status = add_all(mesh);
    if (status < 0 || mesh->constraints.count == 0) return status;
    status = make_clusters(mesh);
    if (status >= 0) status = sort_by_cluster(mesh);
    if (status >= 0 && !number_rows(mesh)) status = DMB_ERR_TOO_LARGE;
    return status < 0 ? status : choose_storage(mesh);
}
