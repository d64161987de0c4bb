/* Energies of a configuration and section forces of elements. Every potential is the one whose derivative the assembly
 * applies, so that the ledger closes up to the error of the scheme.
 *
 *     energy        expression                                                   equation
 *     -----------   ----------------------------------------------------------   ----------------------------
 *     kinetic       v.Mv/2 of elements, rigid masses, added masses               eq:motion.euler-poincare
 *     strain        e.Ke/(2L); of bent elements K couples the components         eq:beam.force, eq:curved.flexibility
 *     gravity       -m g.x - g.R b, less its value in the described pose         eq:motion.weight
 *     wall          length times the integral of K d^n                           eq:contact.normal */
#include "system/assemble/energy.h"

#include <math.h>
#include <string.h>

#include "element/added_mass.h"
#include "element/beam.h"
#include "element/curved.h"
#include "element/rigid_mass.h"
#include "force/hole.h"
#include "sim/node.h"
#include "system/assemble/assemble.h"
#include "system/assemble/caller_force.h"
#include "system/constrain/constrain.h"

static const dmb_element_type *type_of(const dmb_scene *scene, uint32_t e)
{
    return scene->types + scene->element_type[e];
}

static int is_axial_torsional(const dmb_scene *scene, uint32_t node)
{
    return scene->layout.size[node] == DMB_NODE_AXIAL_TORSIONAL;
}

/* Velocities of an element's two ends. The flexible part begins behind a rigid arm along x (eq:kinematics.arm). */
static void end_velocities(const dmb_scene *scene, const dmb_configuration *c, uint32_t e, double va[6], double vb[6])
{
    const uint32_t a = scene->element_node[e];
    dmb_node_vector(scene, c, a, c->velocity, va);
    dmb_node_vector(scene, c, a + 1, c->velocity, vb);
    dmb_arm_velocity(type_of(scene, e)->arm[0], va);
    dmb_arm_velocity(-type_of(scene, e)->arm[1], vb);
}

/* Pose of a node as quaternion, rotation and displacement. */
static void pose_of(const dmb_scene *scene, const dmb_configuration *c, uint32_t node, double q[4], double R[9],
                    double u[3])
{
    dmb_node_pose(scene, c, node, R, u);
    if (is_axial_torsional(scene, node))
        dmb_quat_from_matrix(R, q);
    else
        memcpy(q, c->quaternion + 4 * node, 4 * sizeof(double));
}

/* Relative pose of an element's ends, d = log(H_A^-1 H_B), from displacements, because positions far from the origin
 * lose digits. */
static void shape_of(const dmb_scene *scene, const dmb_configuration *c, uint32_t e, dmb_beam_shape *shape)
{
    const uint32_t a = scene->element_node[e];
    double qa[4], qb[4], Ra[9], Rb[9], ua[3], ub[3], span[3];
    pose_of(scene, c, a, qa, Ra, ua);
    pose_of(scene, c, a + 1, qb, Rb, ub);
    for (uint32_t i = 0; i < 3; i++) span[i] = scene->element_span[3 * e + i] + (ub[i] - ua[i]);
    (void)dmb_beam_deform(type_of(scene, e), qa, Ra, qb, span, shape);
}

void dmb_element_relative_pose(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t element,
                               double d[6])
{
    dmb_beam_shape shape;
    memset(d, 0, 6 * sizeof *d);
    if (!dmb_element_is_curved(type_of(scene, element))) return;
    shape_of(scene, configuration, element, &shape);
    dmb_vec6_copy(shape.d, d);
}

typedef struct ends {
    double va[6], vb[6], pa[6], pb[6];
} ends;

/* Velocities and momenta p = M v of an element's ends; an axial-torsional element uses its two rows only. */
static void end_momenta(const dmb_scene *scene, const dmb_configuration *c, uint32_t e, ends *m)
{
    double *va = m->va, *vb = m->vb, d[6];
    const uint32_t a = scene->element_node[e];
    if (is_axial_torsional(scene, a) && is_axial_torsional(scene, a + 1)) {
        const double *v = c->velocity;
        const uint32_t ra = scene->layout.row[a], rb = scene->layout.row[a + 1];
        memset(va, 0, 6 * sizeof(double));
        memset(vb, 0, 6 * sizeof(double));
        va[0] = v[ra], va[3] = v[ra + 1], vb[0] = v[rb], vb[3] = v[rb + 1];
    } else {
        end_velocities(scene, c, e, va, vb);
    }
    dmb_element_relative_pose(scene, c, e, d);
    dmb_element_momentum(type_of(scene, e), d, va, vb, m->pa, m->pb);
}

/* (v_A . p_A + v_B . p_B)/2 */
double dmb_element_kinetic_energy(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t element)
{
    ends m;
    end_momenta(scene, configuration, element, &m);
    return 0.5 * (dmb_vec6_dot(m.va, m.pa) + dmb_vec6_dot(m.vb, m.pb));
}

/* Axial, torsional and lateral part, each by the product of its components of velocity and momentum; the last is what
 * remains, rotary inertia of bending and the coupling of bent or eccentric elements included, so that the three add up.
 */
void dmb_element_kinetic_parts(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t element,
                               double parts[3])
{
    ends m;
    end_momenta(scene, configuration, element, &m);
    parts[0] = 0.5 * (m.va[0] * m.pa[0] + m.vb[0] * m.pb[0]);
    parts[1] = 0.5 * (m.va[3] * m.pa[3] + m.vb[3] * m.pb[3]);
    parts[2] = 0.5 * (dmb_vec6_dot(m.va, m.pa) + dmb_vec6_dot(m.vb, m.pb)) - parts[0] - parts[1];
}

/* v . M v/2; on the axis of the hole (m s'^2 + J w^2)/2 with the two speeds of an axial-torsional node. */
double dmb_rigid_mass_kinetic_energy(const dmb_scene *scene, const dmb_configuration *configuration,
                                     uint32_t rigid_mass)
{
    const dmb_rigid_mass *l = scene->rigid_masses + rigid_mass;
    const double *v = configuration->velocity + scene->layout.row[l->node];
    double p[6];
    if (is_axial_torsional(scene, l->node)) return 0.5 * (l->mass * v[0] * v[0] + l->inertia[0] * v[1] * v[1]);
    dmb_rigid_mass_times(l, v, p);
    return 0.5 * dmb_vec6_dot(v, p);
}

/* Coupling of the three motions by an eccentric mass counts as lateral. */
void dmb_rigid_mass_kinetic_parts(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t rigid_mass,
                                  double parts[3])
{
    const dmb_rigid_mass *l = scene->rigid_masses + rigid_mass;
    const double *v = configuration->velocity + scene->layout.row[l->node];
    const double spin = v[is_axial_torsional(scene, l->node) ? 1 : 3];
    parts[0] = 0.5 * l->mass * v[0] * v[0];
    parts[1] = 0.5 * l->inertia[0] * spin * spin;
    parts[2] = dmb_rigid_mass_kinetic_energy(scene, configuration, rigid_mass) - parts[0] - parts[1];
}

double dmb_added_mass_kinetic_energy(const dmb_scene *scene, const dmb_configuration *configuration,
                                     const dmb_added_mass *added)
{
    const double *v = configuration->velocity + scene->layout.row[added->node];
    double p[6];
    if (is_axial_torsional(scene, added->node)) return 0.5 * added->along * v[0] * v[0];
    dmb_added_mass_times(added, v, p);
    return 0.5 * dmb_vec6_dot(v, p);
}

void dmb_added_mass_kinetic_parts(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t added,
                                  double parts[3])
{
    const dmb_added_mass *a = scene->added_masses + added;
    const double along = configuration->velocity[scene->layout.row[a->node]];
    parts[0] = 0.5 * a->along * along * along;
    parts[1] = 0.0;
    parts[2] = dmb_added_mass_kinetic_energy(scene, configuration, a) - parts[0];
}

double dmb_kinetic_energy(const dmb_scene *scene, const dmb_configuration *configuration)
{
    double sum = 0.0;
    for (uint32_t e = 0; e < scene->element_count; e++) sum += dmb_element_kinetic_energy(scene, configuration, e);
    for (uint32_t i = 0; i < scene->rigid_mass_count; i++)
        sum += dmb_rigid_mass_kinetic_energy(scene, configuration, i);
    for (uint32_t i = 0; i < scene->added_mass_count; i++)
        sum += dmb_added_mass_kinetic_energy(scene, configuration, scene->added_masses + i);
    return sum;
}

void dmb_element_strain(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t element, double e[6])
{
    const uint32_t a = scene->element_node[element];
    if (is_axial_torsional(scene, a) && is_axial_torsional(scene, a + 1)) {
        const dmb_element_type *type = type_of(scene, element);
        const double *u = configuration->displacement + 3 * (size_t)a, *turn = configuration->turn + a;
        memset(e, 0, 6 * sizeof(double));
        e[0] = (u[3] - u[0]) + (type->length - type->rest[0]);
        e[3] = (turn[1] - turn[0]) - type->rest[3];
        return;
    }
    dmb_beam_shape shape;
    shape_of(scene, configuration, element, &shape);
    dmb_beam_strain_of(type_of(scene, element), &shape, e);
}

void dmb_element_strain_rate(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t element,
                             double rate[6])
{
    const uint32_t a = scene->element_node[element];
    if (is_axial_torsional(scene, a) && is_axial_torsional(scene, a + 1)) {
        const double *va = configuration->velocity + scene->layout.row[a],
                     *vb = configuration->velocity + scene->layout.row[a + 1];
        memset(rate, 0, 6 * sizeof(double));
        rate[0] = vb[0] - va[0];
        rate[3] = vb[1] - va[1];
        return;
    }
    dmb_beam_shape shape;
    double va[6], vb[6];
    shape_of(scene, configuration, element, &shape);
    end_velocities(scene, configuration, element, va, vb);
    dmb_beam_strain_rate(&shape, va, vb, rate);
}

/* Adds e^T K e / (2 L) to sum. */
static double add_strain_energy(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t e, double sum)
{
    const dmb_element_type *type = type_of(scene, e);
    double x[6];
    dmb_element_strain(scene, configuration, e, x);
    for (int i = 0; i < 6; i++) sum += 0.5 * type->stiffness[i] * x[i] * x[i];
    return sum + 0.5 * dmb_beam_cross_energy(type, x);
}

double dmb_strain_energy(const dmb_scene *scene, const dmb_configuration *configuration)
{
    double sum = 0.0;
    for (uint32_t e = 0; e < scene->element_count; e++) sum = add_strain_energy(scene, configuration, e, sum);
    return sum;
}

/* DMB_NONE without strain. */
uint32_t dmb_most_strained(const dmb_scene *scene, const dmb_configuration *configuration)
{
    double most = 0.0;
    uint32_t element = DMB_NONE;
    for (uint32_t e = 0; e < scene->element_count; e++) {
        const double here = add_strain_energy(scene, configuration, e, 0.0);
        if (!(here > most)) continue;
        most = here;
        element = e;
    }
    return element;
}

/* Offset of the weight of a bent element from the point of action of its lumped weights, world frame, now and at time
 * 0. */
static void bent_centre(const dmb_scene *scene, const dmb_configuration *c, uint32_t e, double now[3], double start[3])
{
    const uint32_t a = scene->element_node[e];
    const double *q = scene->reference_quaternion + 4 * (size_t)a;
    dmb_beam_shape shape;
    double R[9], mass[3], x[3];
    shape_of(scene, c, e, &shape);
    dmb_node_pose(scene, c, a, R, x);
    dmb_element_bent_centre(type_of(scene, e), shape.d, mass, x);
    dmb_mat3_vec(R, x, now);
    dmb_quat_to_matrix(q, R);
    (void)dmb_beam_deform(type_of(scene, e), q, R, q + 4, scene->element_span + 3 * (size_t)e, &shape);
    dmb_element_bent_centre(type_of(scene, e), shape.d, mass, x);
    dmb_mat3_vec(R, x, start);
}

/* [J] of what the weight of bent elements adds to that lumped at their nodes (eq:curved.weight), less its value in the
 * described pose. */
static double bent_energy(const dmb_scene *scene, const dmb_configuration *configuration)
{
    double sum = 0.0, now[3], start[3];
    for (uint32_t e = 0; scene->curved && e < scene->element_count; e++) {
        if (!dmb_element_is_curved(type_of(scene, e))) continue;
        bent_centre(scene, configuration, e, now, start);
        dmb_vec3_sub(now, start, now);
        sum -= type_of(scene, e)->weight_mass * dmb_vec3_dot(scene->gravity, now);
    }
    return sum;
}

/* -m g.u - g.((R - R0) b). Zero in the described pose, so that the sum keeps its digits in a deep hole. The
 * weight of an axial-torsional node acts on its axis. */
double dmb_gravity_energy(const dmb_scene *scene, const dmb_configuration *configuration)
{
    double sum = 0.0;
    if (!(scene->features & DMB_FEATURE_GRAVITY)) return 0.0;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        double R[9], u[3], R0[9], now[3], start[3];
        dmb_node_pose(scene, configuration, i, R, u);
        sum -= scene->weight_mass[i] * dmb_vec3_dot(scene->gravity, u);
        if (is_axial_torsional(scene, i)) continue;
        dmb_quat_to_matrix(scene->reference_quaternion + 4 * i, R0);
        dmb_mat3_vec(R, scene->weight_moment + 3 * i, now);
        dmb_mat3_vec(R0, scene->weight_moment + 3 * i, start);
        dmb_vec3_sub(now, start, now);
        sum -= dmb_vec3_dot(scene->gravity, now);
    }
    return sum + bent_energy(scene, configuration);
}

/* Sum over the contact points of length times the integral of K d^n (eq:contact.normal); dampers store nothing. */
double dmb_contact_energy(const dmb_scene *scene, const dmb_configuration *configuration)
{
    const int by_depth = scene->hole.pieces > 0;
    double sum = 0.0;
    for (uint32_t s = 0; s < scene->site_count; s++) {
        dmb_normal_law local;
        if (by_depth) local = dmb_normal_law_at(&scene->hole, &scene->normal_law, configuration->site_depth[s]);
        sum += scene->sites[s].length *
               dmb_normal_energy(by_depth ? &local : &scene->normal_law, configuration->site_penetration[s]);
    }
    return sum;
}

/* Beam: g = P^T (s + tau K/L e') at both ends, the element's contribution to the residual of its nodes; axial-torsional
 * element: K/L (e + tau e') along and about the axis. */
void dmb_element_section_force(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t element,
                               double force[12])
{
    const dmb_element_type *type = type_of(scene, element);
    const uint32_t a = scene->element_node[element], ra = scene->layout.row[a], rb = scene->layout.row[a + 1];
    const double tau = dmb_is_quasi_static(configuration) ? 0.0 : type->damping_time;
    double va[6], vb[6], stress[6], rate[6], viscous[6];
    memset(force, 0, 12 * sizeof(double));
    if (is_axial_torsional(scene, a) && is_axial_torsional(scene, a + 1)) {
        double e[6];
        dmb_element_strain(scene, configuration, element, e);
        for (uint32_t c = 0; c < 2; c++) {
            const double speed = configuration->velocity[rb + c] - configuration->velocity[ra + c];
            const uint32_t i = 3 * c;
            force[i] = type->stiffness[i] * (e[i] + tau * speed);
            force[6 + i] = force[i];
        }
        return;
    }
    dmb_beam_shape shape;
    shape_of(scene, configuration, element, &shape);
    end_velocities(scene, configuration, element, va, vb);
    dmb_beam_strain_rate(&shape, va, vb, rate);
    dmb_beam_stress(type, &shape, stress);
    dmb_beam_stiffness_times(type, rate, viscous);
    for (int i = 0; i < 6; i++) stress[i] += tau * viscous[i];
    dmb_beam_add_force(&shape, stress, force, force + 6);
    for (int i = 0; i < 6; i++) force[i] = -force[i]; /* at A the far side is the element itself */
}

/* Half the weight and the moment +- w L^2/12 of one end (side 1: A, -1: B), in its frame. */
static void end_weight(const dmb_scene *scene, const dmb_element_type *type, const double R[9], double side,
                       double w[6])
{
    double g[3];
    dmb_mat3_tvec(R, scene->gravity, g);
    dmb_vec3_scale(0.5 * type->weight_mass, g, w);
    const double moment[3] = {side * type->weight_mass * type->length / 12.0, 0.0, 0.0};
    dmb_vec3_cross(moment, g, w + 3);
}

/* [N] Half of the drag of flowing mud on an element, towards A. */
static double end_flow(const dmb_scene *scene, uint32_t element)
{
    return scene->flow_count > 0 ? 0.5 * scene->flow_element[element] : 0.0;
}

/* Adds it at an end (0: A), along the hole there (dmb_assemble_flow), as a uniform load on the cubic shape. */
static void add_end_flow(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t element, uint32_t end,
                         double w[6])
{
    const uint32_t node = scene->element_node[element] + end;
    const double half = end_flow(scene, element), L = type_of(scene, element)->length;
    const double arm[3] = {end ? -L / 6.0 : L / 6.0, 0.0, 0.0};
    double R[9], u[3], x[3], point[3], t[3], pull[3], moment[3], s;
    if (!(half > 0.0)) return;
    dmb_node_pose(scene, configuration, node, R, u);
    dmb_vec3_add(scene->reference_position + 3 * (size_t)node, u, x);
    uint32_t segment = dmb_node_segment(scene, configuration, node, 0.0, x);
    dmb_hole_project(&scene->hole, x, &s, &segment, point, t);
    dmb_mat3_tvec(R, t, pull);
    dmb_vec3_scale(-half, pull, pull);
    dmb_vec3_cross(arm, pull, moment);
    dmb_vec3_add(w, pull, w);
    dmb_vec3_add(w + 3, moment, w + 3);
}

/* M a - ad_v^T p of a beam on its two ends, in the frame of each; 0 in a quasi-static state. */
static void end_inertia(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t element,
                        const double d[6], double f[12])
{
    const dmb_element_type *type = type_of(scene, element);
    const uint32_t a = scene->element_node[element];
    double v[12], acceleration[12];
    memset(f, 0, 12 * sizeof *f);
    if (dmb_is_quasi_static(configuration)) return;
    end_velocities(scene, configuration, element, v, v + 6);
    dmb_node_vector(scene, configuration, a, configuration->acceleration, acceleration);
    dmb_node_vector(scene, configuration, a + 1, configuration->acceleration, acceleration + 6);
    dmb_arm_velocity(type->arm[0], acceleration);
    dmb_arm_velocity(-type->arm[1], acceleration + 6);
    dmb_element_inertia(type, d, v, acceleration, f);
}

/* Equilibrium of an end with its part of the element: section force -+ (M a - ad_v^T p - weight), minus at A, plus at
 * B. Mass, weight and mud drag of an element act at its ends in the equations of motion; the loads of its very ends are
 * the section forces with the shares of these ends. */
void dmb_element_end_loads(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t element,
                           double load[12])
{
    const dmb_element_type *type = type_of(scene, element);
    const uint32_t a = scene->element_node[element];
    double f[12], bent[12], w[12], d[6], R[9], u[3];
    dmb_element_section_force(scene, configuration, element, load);
    if (is_axial_torsional(scene, a) && is_axial_torsional(scene, a + 1)) return;
    dmb_element_relative_pose(scene, configuration, element, d);
    end_inertia(scene, configuration, element, d, f);
    dmb_node_pose(scene, configuration, a, R, u);
    dmb_element_bent_weight(type, d, R, scene->gravity, bent);
    for (uint32_t end = 0; end < 2; end++) {
        dmb_node_pose(scene, configuration, a + end, R, u);
        end_weight(scene, type, R, end ? -1.0 : 1.0, w + 6 * end);
        add_end_flow(scene, configuration, element, end, w + 6 * end);
    }
    for (int i = 0; i < 6; i++) {
        load[i] -= f[i] - w[i] - bent[i];
        load[6 + i] += f[6 + i] - w[6 + i] - bent[6 + i];
    }
}

/* The same of an axial-torsional element, axial force and torque at its end A: N - (M a)_A + half its weight along the
 * axis (eq:drilling.rig-end). */
void dmb_axial_torsional_start_loads(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t element,
                                     double load[2])
{
    const dmb_element_type *type = type_of(scene, element);
    const uint32_t a = scene->element_node[element];
    const double *at_a = configuration->acceleration + scene->layout.row[a];
    const double *at_b = configuration->acceleration + scene->layout.row[a + 1];
    double force[12], R[9], u[3], weight[6];
    dmb_element_section_force(scene, configuration, element, force);
    dmb_node_pose(scene, configuration, a, R, u);
    end_weight(scene, type, R, 1.0, weight);
    load[0] = force[0] + weight[0] - end_flow(scene, element);
    load[1] = force[3];
    if (dmb_is_quasi_static(configuration)) return;
    load[0] -= type->mass.axial[0] * at_a[0] + type->mass.axial[1] * at_b[0];
    load[1] -= type->mass.torsion[0] * at_a[1] + type->mass.torsion[1] * at_b[1];
}

double dmb_energy_stored(const dmb_sim *sim, const dmb_configuration *c)
{
    return dmb_kinetic_energy(sim->scene, c) + dmb_strain_energy(sim->scene, c) + dmb_gravity_energy(sim->scene, c) +
           dmb_contact_energy(sim->scene, c) + dmb_joint_energy(sim, c) + dmb_springs_energy(sim->scene, c) +
           dmb_caller_forces_energy(sim->scene, c) + dmb_stuck_energy(sim, c);
}
