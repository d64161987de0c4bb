/* Pose, twist and map of the point of action of a force.
 *
 *     place           nodes   axes R, position x                        map from node velocities to the twist V
 *     -------------   -----   ---------------------------------------   --------------------------------------------
 *     ground          0       world, as described                       none
 *     on a node       1       those of the node, offset in them         (I, -x~; 0, I), constant
 *     in an element   2       section (eq:beam.section-pose)            Phi(d) (eq:motion.section-map), shifted
 *
 * A wrench w on the point is map^T w on the nodes: equal power for every motion. The tangent of map^T w has two parts,
 * of w by the displacement of the point and of the map (dmb_point_map_tangent); forces add the first themselves. */
#include "system/assemble/point_motion.h"

#include <string.h>

#include "element/beam.h"
#include "math/mat6.h"
#include "math/se3.h"
#include "sim/node.h"

/* ---- Motion ------------------------------------------------------------------------------------------------------ */

static const dmb_element_type *type_of(const dmb_scene *scene, const dmb_scene_point *point)
{
    return scene->types + scene->element_type[point->element];
}

/* On axial-torsional nodes the section stays on the straight line between them, without the cubic correction. */
static void shape_of(const dmb_scene *scene, const dmb_scene_point *point, dmb_section_shape *shape)
{
    const int path = scene->layout.size[point->node] == DMB_NODE_AXIAL_TORSIONAL &&
                     scene->layout.size[point->node + 1] == DMB_NODE_AXIAL_TORSIONAL;
    dmb_section_shape_at(type_of(scene, point), point->fraction, !path, shape);
}

/* v at an offset: v + w x offset, in each column. */
static void shift_map(const double offset[3], uint32_t columns, double map[72])
{
    for (uint32_t k = 0; k < columns; k++) {
        const double w[3] = {map[36 + k], map[48 + k], map[60 + k]};
        double v[3];
        dmb_vec3_cross(w, offset, v);
        for (int i = 0; i < 3; i++) map[12 * i + (int)k] += v[i];
    }
}

static void rigid_motion(const dmb_scene *scene, const dmb_configuration *c, dmb_point_motion *m)
{
    double u[3];
    m->nodes = 1;
    m->node[0] = m->point->node;
    dmb_node_pose(scene, c, m->node[0], m->R, u);
    dmb_mat3_vec(m->R, m->point->x, m->x);
    dmb_vec3_add(m->x, u, m->x);
    for (int i = 0; i < 6; i++) m->map[13 * i] = 1.0;
    shift_map(m->point->x, 6, m->map);
}

static void section_motion(const dmb_scene *scene, const dmb_configuration *c, dmb_point_motion *m)
{
    const dmb_scene_point *point = m->point;
    dmb_section_shape shape;
    double Ra[9], Rb[9], Q[9], ua[3], ub[3], span[3], r[3], x[3];
    m->nodes = 2;
    m->node[0] = point->node;
    m->node[1] = point->node + 1;
    dmb_node_pose(scene, c, m->node[0], Ra, ua);
    dmb_node_pose(scene, c, m->node[1], Rb, ub);
    dmb_vec3_sub(ub, ua, span);
    dmb_vec3_add(span, scene->element_span + 3 * (size_t)point->element, span);
    shape_of(scene, point, &shape);
    dmb_section_ends(type_of(scene, point), Ra, Rb, span, m->d);
    dmb_section_pose(type_of(scene, point), &shape, m->d, Q, r);
    dmb_mat3_mul(Ra, Q, m->R);
    dmb_mat3_vec(Ra, r, m->x);
    dmb_mat3_vec(m->R, point->x, x);
    dmb_vec3_add(m->x, x, m->x);
    dmb_vec3_add(m->x, ua, m->x);
    dmb_section_map(type_of(scene, point), &shape, m->d, m->map);
    shift_map(point->x, 12, m->map);
}

void dmb_point_motion_of(const dmb_scene *scene, const dmb_configuration *configuration, const dmb_scene_point *point,
                         dmb_point_motion *motion)
{
    memset(motion, 0, sizeof *motion);
    motion->point = point;
    if (point->node == DMB_NONE) {
        dmb_mat3_identity(motion->R);
        dmb_vec3_copy(point->x, motion->x);
    } else if (point->element == DMB_NONE) {
        rigid_motion(scene, configuration, motion);
    } else {
        section_motion(scene, configuration, motion);
    }
    for (uint32_t n = 0; n < motion->nodes; n++) {
        double *v = motion->v + 6 * n;
        dmb_node_vector(scene, configuration, motion->node[n], configuration->velocity, v);
        for (uint32_t i = 0; i < 6; i++) motion->V[i] += dmb_vec6_dot(motion->map + 12 * i + 6 * n, v);
    }
}

void dmb_point_apply(dmb_sim *sim, const dmb_point_motion *motion, const double w[6])
{
    for (uint32_t n = 0; n < motion->nodes; n++) {
        double f[6] = {0.0};
        for (int i = 0; i < 6; i++)
            for (uint32_t k = 0; k < 6; k++) f[k] += motion->map[12 * (uint32_t)i + 6 * n + k] * w[i];
        dmb_apply_wrench(sim, motion->node[n], f);
    }
}

/* The map of a point on a node is constant. That of a point fixed to a section is shifted by a constant offset, so the
 * wrench at the section is (f; m + offset x f), constant in its axes too. */
void dmb_point_map_tangent(const dmb_scene *scene, const dmb_point_motion *motion, const double w[6], double K[144])
{
    dmb_section_shape shape;
    double at[6], moment[3];
    memset(K, 0, 144 * sizeof(double));
    if (motion->nodes < 2) return;
    dmb_vec6_copy(w, at);
    dmb_vec3_cross(motion->point->x, w, moment);
    dmb_vec3_add(at + 3, moment, at + 3);
    shape_of(scene, motion->point, &shape);
    dmb_section_map_tangent(type_of(scene, motion->point), &shape, motion->d, at, K);
}

/* ---- Tangents ---------------------------------------------------------------------------------------------------- */

void dmb_force_tangent_begin(dmb_force_tangent *tangent)
{
    tangent->nodes = tangent->columns = 0;
}

/* Two points of one force may share nodes: each node gets its columns once. */
void dmb_force_tangent_touch(const dmb_scene *scene, const dmb_point_motion *motion, dmb_force_tangent *tangent)
{
    for (uint32_t n = 0; n < motion->nodes; n++) {
        uint32_t i = 0;
        while (i < tangent->nodes && tangent->node[i] != motion->node[n]) i++;
        if (i < tangent->nodes) continue;
        tangent->node[i] = motion->node[n];
        tangent->column[i] = tangent->columns;
        tangent->columns += scene->layout.size[motion->node[n]];
        tangent->nodes++;
    }
}

void dmb_force_tangent_clear(dmb_force_tangent *tangent)
{
    const size_t bytes = (size_t)tangent->columns * tangent->columns * sizeof(double);
    memset(tangent->K, 0, bytes);
}

/* Column of component k (0 .. 11) of the point's nodes; DMB_NONE: for components that an axial-torsional node does not
 * have. */
static uint32_t column_of(const dmb_scene *scene, const dmb_force_tangent *tangent, const dmb_point_motion *motion,
                          uint32_t k)
{
    const uint32_t node = motion->node[k / 6], c = k % 6;
    uint32_t i = 0;
    while (tangent->node[i] != node) i++;
    if (scene->layout.size[node] == DMB_NODE_SIX_DOF) return tangent->column[i] + c;
    return c % 3 != 0 ? DMB_NONE : tangent->column[i] + c / 3;
}

/* Values by the components of both nodes of a point, into the columns of the force; an axial-torsional node has x and
 * rx alone. */
void dmb_force_tangent_columns(const dmb_scene *scene, const dmb_force_tangent *tangent, const dmb_point_motion *motion,
                               const double values[12], double *row)
{
    for (uint32_t k = 0; k < 6 * motion->nodes; k++) {
        const uint32_t column = column_of(scene, tangent, motion, k);
        if (column != DMB_NONE) row[column] += values[k];
    }
}

void dmb_force_tangent_row(const dmb_scene *scene, const dmb_force_tangent *tangent, const dmb_point_motion *motion,
                           const double w[6], double *row)
{
    double values[DMB_POINT_COLUMNS] = {0.0};
    for (uint32_t i = 0; i < 6; i++)
        for (uint32_t k = 0; k < 12; k++) values[k] += w[i] * motion->map[12 * i + k];
    dmb_force_tangent_columns(scene, tangent, motion, values, row);
}

void dmb_force_tangent_block(const dmb_scene *scene, dmb_force_tangent *tangent, const dmb_point_motion *motion,
                             double factor, const double A[144])
{
    uint32_t column[DMB_POINT_COLUMNS];
    const uint32_t count = 6 * motion->nodes;
    for (uint32_t k = 0; k < count; k++) column[k] = column_of(scene, tangent, motion, k);
    for (uint32_t r = 0; r < count; r++)
        for (uint32_t c = 0; c < count; c++)
            if (column[r] != DMB_NONE && column[c] != DMB_NONE)
                tangent->K[(size_t)column[r] * tangent->columns + column[c]] += factor * A[12 * r + c];
}

/* K <- K T6 in the columns of six-DOF nodes: by pose parameters, as for the blocks of the nodes. */
static void to_parameters(const dmb_sim *sim, const dmb_force_tangent *tangent, uint32_t node, double *K)
{
    const uint32_t at = tangent->node[node];
    dmb_se3_tangent T;
    if (sim->scene->layout.size[at] != DMB_NODE_SIX_DOF) return;
    dmb_se3_tangent_at(sim->increment + sim->scene->layout.row[at], NULL, &T);
    for (uint32_t r = 0; r < tangent->columns; r++) {
        double *row = K + (size_t)r * tangent->columns + tangent->column[node];
        dmb_se3_tangent_apply_transpose(&T, row, row);
    }
}

/* Adds the block of nodes i, k to storage with as many columns as node k has rows. */
static void add_block(const dmb_block_layout *layout, const dmb_force_tangent *tangent, double factor, uint32_t i,
                      uint32_t k, double *to)
{
    const uint32_t rows = layout->size[tangent->node[i]], columns = layout->size[tangent->node[k]];
    for (uint32_t r = 0; r < rows; r++)
        for (uint32_t c = 0; c < columns; c++)
            to[(size_t)columns * r + c] +=
                factor * tangent->K[(size_t)(tangent->column[i] + r) * tangent->columns + tangent->column[k] + c];
}

/* Adds K to the blocks of the chain. Diagonal blocks by displacements are multiplied by T6 later, with the others of
 * their node; off-diagonal blocks are complete here, and without stiffness for tangents of inertia alone. */
static void add_to_chain(const dmb_evaluation *evaluation, int by, double factor, dmb_force_tangent *tangent)
{
    const dmb_sim *sim = evaluation->sim;
    const dmb_block_layout *layout = &sim->scene->layout;
    for (uint32_t i = 0; i < tangent->nodes; i++) {
        const uint32_t node = tangent->node[i];
        double *to = by == DMB_BY_VELOCITY ? dmb_inertia_of(sim, node) : dmb_stiffness_of(sim, node);
        add_block(layout, tangent, factor, i, i, to);
    }
    if (tangent->nodes < 2 || (by == DMB_BY_DISPLACEMENT && evaluation->inertia_only)) return;
    const uint32_t low = tangent->node[0] < tangent->node[1] ? 0 : 1, high = 1 - low;
    const uint32_t a = tangent->node[low];
    double *upper = sim->stiffness_upper + layout->link[a], *lower = sim->stiffness_lower + layout->link[a];
    for (uint32_t i = 0; i < 2 && by == DMB_BY_DISPLACEMENT && evaluation->dynamic; i++)
        to_parameters(sim, tangent, i, tangent->K);
    add_block(layout, tangent, factor, low, high, upper);
    add_block(layout, tangent, factor, high, low, lower);
}

/* Requires that the constraint has the same nodes in the same order.
 *
 *     constraint     storage                    displacement parameters (T6 of eq:kinematics.tangent-pose)
 *     ------------   ------------------------   ---------------------------------------------------------
 *     DMB_NONE       blocks of the chain        diagonal blocks later with their node, others here
 *     a constraint   constraint_tangent         here */
void dmb_force_tangent_add(const dmb_evaluation *evaluation, uint32_t constraint, int by, dmb_force_tangent *tangent)
{
    dmb_sim *sim = evaluation->sim;
    const size_t size = (size_t)tangent->columns * tangent->columns;
    const double factor = by == DMB_BY_VELOCITY ? evaluation->velocity_factor : 1.0;
    if (by == DMB_BY_VELOCITY && !evaluation->dynamic) return;
    if (constraint == DMB_NONE) {
        add_to_chain(evaluation, by, factor, tangent);
        return;
    }
    double *to = sim->constraint_tangent + sim->scene->constraints[constraint].tangent;
    for (uint32_t i = 0; i < tangent->nodes && by == DMB_BY_DISPLACEMENT && evaluation->dynamic; i++)
        to_parameters(sim, tangent, i, tangent->K);
    for (size_t k = 0; k < size; k++) to[k] += factor * tangent->K[k];
}
