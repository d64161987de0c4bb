/* Momentum of the whole scene: the sum over the nodes of Ad^-T p, p = M v with the consistent mass, which the equations
 * conserve exactly, added mass of mud included (eq:mud.kirchhoff). Mass and centre are of the parts alone: half of an
 * element at each end and the first moments +-rho A L^2/12 of its cubic shapes. */
#include "query/query.h"

#include <string.h>

#include "element/added_mass.h"
#include "element/beam.h"
#include "element/curved.h"
#include "element/rigid_mass.h"
#include "sim/access.h"
#include "sim/node.h"
#include "system/assemble/energy.h"

DMB_DECLARE_STRUCT(dmb_momentum)

/* A frame with mass: its pose in the world frame and its velocity. */
typedef struct carrier {
    double rotation[9];
    double position[3];
    double velocity[6]; /* body frame */
} carrier;

static int is_axial_torsional(const dmb_scene *scene, uint32_t node)
{
    return scene->layout.size[node] == DMB_NODE_AXIAL_TORSIONAL;
}

/* Pose and velocity of the frame at the arm [m] along body x from a node: an element's own end, or the node itself (arm
 * 0). */
static void carrier_of(const dmb_scene *scene, const dmb_configuration *c, uint32_t node, double arm, carrier *out)
{
    double u[3];
    const double offset[3] = {arm, 0.0, 0.0};
    dmb_node_pose(scene, c, node, out->rotation, u);
    dmb_vec3_add(scene->reference_position + 3 * (size_t)node, u, out->position);
    dmb_mat3_vec(out->rotation, offset, u);
    dmb_vec3_add(out->position, u, out->position);
    dmb_node_vector(scene, c, node, c->velocity, out->velocity);
    dmb_arm_velocity(arm, out->velocity);
}

/* Axial-torsional elements and masses on the hole's axis contribute in their two rows only. */
static void keep_rows(double v[6])
{
    v[1] = v[2] = v[4] = v[5] = 0.0;
}

/* Adds a momentum p given in the carrier's frame: (R pu; R pw + x x R pu). */
static void add_momentum(const carrier *at, const double p[6], dmb_momentum *sum)
{
    double linear[3], angular[3], moment[3];
    dmb_mat3_vec(at->rotation, p, linear);
    dmb_mat3_vec(at->rotation, p + 3, angular);
    dmb_vec3_cross(at->position, linear, moment);
    dmb_vec3_add(sum->linear, linear, sum->linear);
    dmb_vec3_add(sum->angular, angular, sum->angular);
    dmb_vec3_add(sum->angular, moment, sum->angular);
}

/* Adds a mass and its first moment in the carrier's frame; `centre` is the sum of m x until the end. */
static void add_mass(const carrier *at, double mass, const double moment[3], dmb_momentum *sum)
{
    double b[3];
    dmb_mat3_vec(at->rotation, moment, b);
    sum->mass += mass;
    dmb_vec3_axpy(mass, at->position, sum->centre);
    dmb_vec3_add(sum->centre, b, sum->centre);
}

/* First moment of the element: +-rho A L^2/12 at its ends, not those of the mass matrix, which contains added mass of
 * mud; of a curved element at its actual centre. */
static void add_element_mass(const dmb_element_type *type, const double d[6], const carrier *A, const carrier *B,
                             dmb_momentum *sum)
{
    const double half = type->mass.axial[0] + type->mass.axial[1];
    double near_moment[3] = {type->mass_per_metre * type->length * type->length / 12.0, 0.0, 0.0}, weight[3];
    double far_moment[3] = {-near_moment[0], 0.0, 0.0};
    if (dmb_element_is_curved(type)) {
        dmb_element_bent_centre(type, d, near_moment, weight);
        dmb_vec3_scale(2.0 * half, near_moment, near_moment);
        dmb_vec3_zero(far_moment);
    }
    add_mass(A, half, near_moment, sum);
    add_mass(B, half, far_moment, sum);
}

/* Momenta of both ends by the 12 rows of the element's mass, each in the frame of its end. Between two axial-torsional
 * nodes only velocities along and about the axis have inertia in the equations, and so they have here. */
static void add_element(const dmb_scene *scene, const dmb_configuration *c, uint32_t element, dmb_momentum *sum)
{
    const dmb_element_type *type = &scene->types[scene->element_type[element]];
    const uint32_t a = scene->element_node[element], b = a + 1;
    double pa[6], pb[6], d[6];
    carrier A, B;
    carrier_of(scene, c, a, type->arm[0], &A);
    carrier_of(scene, c, b, -type->arm[1], &B);
    if (is_axial_torsional(scene, a) && is_axial_torsional(scene, b)) {
        keep_rows(A.velocity);
        keep_rows(B.velocity);
    }
    dmb_element_relative_pose(scene, c, element, d);
    dmb_element_momentum(type, d, A.velocity, B.velocity, pa, pb);
    add_momentum(&A, pa, sum);
    add_momentum(&B, pb, sum);
    add_element_mass(type, d, &A, &B, sum);
}

static void add_rigid_mass(const dmb_scene *scene, const dmb_configuration *c, const dmb_rigid_mass *rigid_mass,
                           dmb_momentum *sum)
{
    carrier at;
    double p[6];
    carrier_of(scene, c, rigid_mass->node, 0.0, &at);
    if (is_axial_torsional(scene, rigid_mass->node)) {
        memset(p, 0, sizeof p);
        p[0] = rigid_mass->mass * at.velocity[0];
        p[3] = rigid_mass->inertia[0] * at.velocity[3];
    } else {
        dmb_rigid_mass_times(rigid_mass, at.velocity, p);
    }
    add_momentum(&at, p, sum);
    add_mass(&at, rigid_mass->mass, rigid_mass->moment, sum);
}

/* Added mass of mud contributes to momentum, not to mass and centre. */
static void add_added_mass(const dmb_scene *scene, const dmb_configuration *c, const dmb_added_mass *added,
                           dmb_momentum *sum)
{
    carrier at;
    double p[6] = {0.0};
    carrier_of(scene, c, added->node, 0.0, &at);
    if (is_axial_torsional(scene, added->node))
        p[0] = added->along * at.velocity[0];
    else
        dmb_added_mass_times(added, at.velocity, p);
    add_momentum(&at, p, sum);
}

/* Everything with inertia in the equations: elements, rigid masses (bodies, bits, tool joints, rigid pipes) and added
 * mass of mud. */
int32_t dmb_answer_momentum(const dmb_sim *sim, dmb_momentum *momentum)
{
    const int32_t status = dmb_ask(sim, momentum);
    dmb_momentum answer = {0};
    if (status < 0) return status;
    for (uint32_t i = 0; i < sim->scene->element_count; i++) add_element(sim->scene, &sim->now, i, &answer);
    for (uint32_t i = 0; i < sim->scene->rigid_mass_count; i++) {
        add_rigid_mass(sim->scene, &sim->now, &sim->scene->rigid_masses[i], &answer);
    }
    for (uint32_t i = 0; i < sim->scene->added_mass_count; i++)
        add_added_mass(sim->scene, &sim->now, sim->scene->added_masses + i, &answer);
    if (answer.mass > 0.0) dmb_vec3_scale(1.0 / answer.mass, answer.centre, answer.centre);
    return dmb_momentum_write(momentum, &answer);
}
