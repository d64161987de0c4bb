/* Frame b of a joint relative to frame a in a configuration, and the mapping of rows and wrenches to the rows of its
 * nodes. Positions are differences: the vector between the described nodes (`span`) plus both displacements, so that
 * joints far from the origin keep their digits. Frame a of a joint on the hole is that of the hole at the point closest
 * to frame b; it moves along with b, which rows and curvature account for (bend). */
#include "system/constrain/constrain.h"

#include <math.h>

#include "constraint/joint.h"
#include "math/mat6.h"
#include "math/so3.h"
#include "math/vec3.h"
#include "sim/node.h"

/* ---- Motion ------------------------------------------------------------------------------------------------------ */

/* World rotation of a frame, and its origin relative to the position of its node at time 0 (of the ground: to the
 * world's origin). */
static void frame_pose(const dmb_scene *scene, const dmb_configuration *c, const dmb_scene_frame *frame, double R[9],
                       double x[3])
{
    double node[9], u[3];
    if (frame->node == DMB_NONE) {
        dmb_mat3_copy(frame->M, R);
        dmb_vec3_copy(frame->x, x);
        return;
    }
    dmb_node_pose(scene, c, frame->node, node, u);
    dmb_mat3_mul(node, frame->M, R);
    dmb_mat3_vec(node, frame->x, x);
    dmb_vec3_add(x, u, x);
}

/* Frame of the hole at the point closest to x (world); of a locked joint, at its depth. The segment found last begins
 * the search; the trial begins from that of now (dmb_joint_place_begin), so that it does not depend on earlier trials.
 */
static void hole_frame(const dmb_scene *scene, const double x[3], double *depth, uint32_t *segment, double R[9],
                       double point[3], dmb_hole_bend *bend)
{
    double tangent[3], unused[3], curvature[3];
    if (*segment & DMB_SEGMENT_HELD)
        dmb_hole_frame(&scene->hole, *depth, point, tangent, curvature);
    else
        dmb_hole_project(&scene->hole, x, depth, segment, point, tangent);
    dmb_hole_frame_rotation(&scene->hole, *depth, R);
    if (bend == NULL) return;
    dmb_hole_frame(&scene->hole, *depth, unused, tangent, curvature);
    dmb_hole_frame_rate(tangent, curvature, bend->frame_rate);
    dmb_vec3_copy(curvature, bend->curvature);
    for (int i = 0; i < 3; i++) {
        bend->tangent[i] = R[3 * i];
        bend->normal[0][i] = R[3 * i + 1];
        bend->normal[1][i] = R[3 * i + 2];
    }
}

/* Places and twist of frame b in axes of b, relative to a (eq:joints.relative-motion). */
static void motion(const dmb_scene *scene, const dmb_configuration *c, uint32_t j, double *depth, uint32_t *segment,
                   dmb_relative *relative, dmb_hole_bend *bend)
{
    const dmb_scene_joint *joint = scene->joints + j;
    const int ground = joint->a.node == DMB_NONE;
    double Ra[9], Rb[9], xa[3], xb[3], va[6], vb[6], d[3];
    frame_pose(scene, c, &joint->b, Rb, xb);
    dmb_vec3_add(joint->span, xb, xb);
    if (joint->kind == DMB_JOINT_POINT_ON_HOLE)
        hole_frame(scene, xb, depth, segment, Ra, xa, bend);
    else
        frame_pose(scene, c, &joint->a, Ra, xa);
    if (bend != NULL) dmb_mat3_copy(Rb, bend->M);
    dmb_vec3_sub(xb, xa, d);
    dmb_relative_place(Ra, Rb, d, relative);
    dmb_relative_maps(ground ? NULL : joint->a.x, ground ? NULL : joint->a.M, joint->b.x, joint->b.M, relative);
    dmb_node_vector(scene, c, joint->b.node, c->velocity, vb);
    if (!ground) dmb_node_vector(scene, c, joint->a.node, c->velocity, va);
    dmb_relative_motion(ground ? NULL : va, vb, relative);
}

void dmb_joint_motion(const dmb_scene *scene, dmb_configuration *configuration, uint32_t j, dmb_relative *relative,
                      dmb_hole_bend *bend)
{
    motion(scene, configuration, j, configuration->joint_depth + j, configuration->joint_segment + j, relative, bend);
}

void dmb_joint_place_begin(dmb_sim *sim, uint32_t j)
{
    sim->trial.joint_depth[j] = sim->now.joint_depth[j];
    sim->trial.joint_segment[j] = sim->now.joint_segment[j];
}

void dmb_joint_place_find(dmb_sim *sim, uint32_t j)
{
    const dmb_scene *scene = sim->scene;
    const dmb_scene_joint *joint = scene->joints + j;
    double R[9], x[3], point[3], tangent[3];
    if (joint->kind != DMB_JOINT_POINT_ON_HOLE) return;
    frame_pose(scene, &sim->now, &joint->b, R, x);
    dmb_vec3_add(joint->span, x, x);
    sim->now.joint_segment[j] = dmb_node_segment(scene, &sim->now, joint->b.node, joint->b.x[0], x);
    dmb_hole_project(&scene->hole, x, sim->now.joint_depth + j, sim->now.joint_segment + j, point, tangent);
}

void dmb_joint_place_hold(dmb_sim *sim, uint32_t j, int held)
{
    sim->now.joint_segment[j] &= ~DMB_SEGMENT_HELD;
    if (held) sim->now.joint_segment[j] |= DMB_SEGMENT_HELD;
}

void dmb_joint_motion_of(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t j,
                         dmb_relative *relative, dmb_hole_bend *bend)
{
    double depth = configuration->joint_depth[j];
    uint32_t segment = configuration->joint_segment[j];
    motion(scene, configuration, j, &depth, &segment, relative, bend);
}

uint32_t dmb_constraint_column(const dmb_constraint *constraint, uint32_t node)
{
    uint32_t i = 0;
    while (i + 1 < constraint->node_count && constraint->node[i] != node) i++;
    return constraint->column[i];
}

void dmb_add_node_columns(const dmb_scene *scene, uint32_t node, const double vector[6], double *columns)
{
    if (scene->layout.size[node] == DMB_NODE_AXIAL_TORSIONAL) { /* on a straight axis only: see the compile step */
        columns[0] += vector[0];
        columns[1] += vector[3];
        return;
    }
    for (int i = 0; i < 6; i++) columns[i] += vector[i];
}

/* [-] Relative rounding of a row. A row that acts on a node only across its axis has entries of rounding size along and
 * about it; scaled to unit length in the choice of the partition, these would be an equation, so they are set to 0. */
#define DMB_ROW_ROUNDING 1e-14
#define DMB_ARM_ROUNDING 1e-12 /* in length scales */

static void clear_rounding(const dmb_scene *scene, double part[6])
{
    const double along = dmb_vec3_norm(part), about = dmb_vec3_norm(part + 3);
    if (fabs(part[0]) < DMB_ROW_ROUNDING * along) part[0] = 0.0;
    if (fabs(part[3]) < DMB_ROW_ROUNDING * about + DMB_ARM_ROUNDING * scene->length_scale * along) part[3] = 0.0;
}

static void row_times(const double J[6], const double map[36], double factor, double out[6])
{
    dmb_mat6_row(J, 1, map, out);
    for (int i = 0; i < 6; i++) out[i] *= factor;
}

static void add_part(const dmb_scene *scene, const dmb_constraint *constraint, uint32_t node, double part[6],
                     double *row)
{
    if (scene->layout.size[node] == DMB_NODE_AXIAL_TORSIONAL) clear_rounding(scene, part);
    dmb_add_node_columns(scene, node, part, row + dmb_constraint_column(constraint, node));
}

/* J of the relative twist times the maps of both bodies: the row in their body-frame velocities. */
void dmb_add_joint_row(const dmb_scene *scene, const dmb_constraint *constraint, uint32_t j,
                       const dmb_relative *relative, double factor, const double J[6], double *row)
{
    const dmb_scene_joint *joint = scene->joints + j;
    double part[6];
    row_times(J, relative->to_b, factor, part);
    add_part(scene, constraint, joint->b.node, part, row);
    if (joint->a.node == DMB_NONE) return;
    row_times(J, relative->to_a, factor, part);
    add_part(scene, constraint, joint->a.node, part, row);
}
