/* Nodes of both kinds: pose and speed (of an axial-torsional node from its position on the hole's axis), and the
 * described part of a node, an element, a row or a constraint. */
#ifndef DMB_SIM_NODE_H
#define DMB_SIM_NODE_H

#include "model/scene.h"
#include "sim/sim.h"

/* Rotation (body to world, row-major) and displacement [m] (world, from reference_position) of a node. */
void dmb_node_pose(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t node, double rotation[9],
                   double displacement[3]);
/* Body-frame 6-vector from an array over rows (velocity or acceleration): axial-torsional rows become components x and
 * rx, on a curved hole with the rotation of the tangent. */
void dmb_node_vector(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t node, const double *rows,
                     double vector[6]);
/* 1: a quasi-static state, in equilibrium with friction at an assumed slip (dmb_static_options). Without inertia and
 * damping; `acceleration` of the configuration belongs to the motion that starts with the next step, when friction
 * depends on the velocities again. */
int dmb_is_quasi_static(const dmb_configuration *configuration);
/* Columns of the body-frame motion of an axial-torsional node per unit of its two rows (eq:kinematics.path-velocity),
 * shape (2, 6); rotation is its present one. */
void dmb_axial_torsional_columns(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t node,
                                 const double rotation[9], double columns[12]);
/* [m] measured depth of an axial-torsional node. */
double dmb_axial_torsional_depth(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t node);
/* Arc of the hole's axis at which the search for the point of it nearest to x starts (dmb_hole_project); x [m] is on or
 * beside the section of a node that is `arm` [m] along body x from it. `known`: configuration with known contact
 * points, whose depths are tracked from step to step: the distance of a section to the nearest one is as described.
 * Without contact points: the nearest place within twice the node's displacement of its described depth. 0 for a
 * straight hole. */
uint32_t dmb_node_segment(const dmb_scene *scene, const dmb_configuration *known, uint32_t node, double arm,
                          const double x[3]);

/* Number of consecutive six-DOF nodes from this one on; 0: it is an axial-torsional node. */
uint32_t dmb_count_six_dof_nodes(const dmb_scene *scene, uint32_t node);
static inline uint32_t dmb_six_dof_nodes_at(const dmb_scene *scene, uint32_t node)
{
    return scene->layout.size[node] == DMB_NODE_SIX_DOF ? dmb_count_six_dof_nodes(scene, node) : 0;
}
/* The same, counting nodes before `end` only. */
static inline uint32_t dmb_six_dof_nodes_before(const dmb_scene *scene, uint32_t node, uint32_t end)
{
    const uint32_t count = dmb_six_dof_nodes_at(scene, node);
    return count < end - node ? count : end - node;
}
/* Element before (side 0) or after (side 1) a node; DMB_NONE at the ends of its chain. */
uint32_t dmb_element_between(const dmb_scene *scene, uint32_t node, uint32_t side);

/* Owners: described parts of nodes and elements (for messages), nodes of rows, and constraints of parts. */

typedef struct dmb_owner {
    const char *kind; /* "string" or "body" */
    uint32_t index;
    uint32_t pipe;    /* 0 for a body */
    dmb_message text; /* "string 0, pipe 3", "body 2 (turbine)" */
} dmb_owner;

dmb_owner dmb_owner_of_node(const dmb_scene *scene, uint32_t node);
dmb_owner dmb_owner_of_element(const dmb_scene *scene, uint32_t element);
/* Next body or bit whose contact point never touches the wall, and the text about it (dmb_supported_site). */
uint32_t dmb_owner_of_supported_site(const dmb_scene *scene, uint32_t from, dmb_message *text);
/* "drive 1 (pump)", "load 0". Returns text->text. */
const char *dmb_string_text(const dmb_scene *scene, uint32_t string, dmb_message *text);
/* 1 unless one of its joints is open. */
int dmb_coupling_holds(const dmb_sim *sim, const dmb_scene_coupling *coupling);
const char *dmb_drive_text(const dmb_scene *scene, uint32_t drive, dmb_message *text);
const char *dmb_load_text(const dmb_scene *scene, uint32_t load, dmb_message *text);
/* Node that a row belongs to. O(log nodes) */
uint32_t dmb_node_of_row(const dmb_scene *scene, uint32_t row);
/* Constraint of a joint, coupling, drive or callback; DMB_NONE where the part has none. */
uint32_t dmb_constraint_of_part(const dmb_sim *sim, dmb_id part);

/* Unbalance of the rigid masses on the nodes. */

/* Body-frame wrench [N s2, N m s2] of rigid_mass number i on its six-DOF node for unit spin about the node's axis, per
 * square of the spin: the centrifugal force of an eccentric centre of mass and the couple of its products of
 * inertia. */
void dmb_unbalance_of(const dmb_scene *scene, uint32_t i, double wrench[6]);

#endif
