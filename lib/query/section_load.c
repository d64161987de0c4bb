/* Section forces inside an element by Newton's law for the segment between its end A and the section
 * (eq:beam.section-force): the load at A, minus the concentrated loads on the segment, minus its part of the
 * distributed loads. Contributions, in their order:
 *
 *     host_of               loads at both ends by the element's own forces and inertia, by lanes or alone
 *     subtract_nodes        concentrated loads inside the element: taken from the nodes, where equations apply them
 *     add_eccentric         eccentric mass and external damping, half an element at each node: added to the ends,
 *     add_external_damping  and thereby part of the distributed loads
 *     total_of              distributed loads of the whole element: the difference of both ends
 *     distributed_to        their part up to the section */
#include <string.h>

#include "element/beam.h"
#include "element/rigid_mass.h"
#include "force/weight_and_damping.h"
#include "math/mat6.h"
#include "math/se3.h"
#include "math/vec3.h"
#include "model/section.h"
#include "query/query.h"
#include "sim/node.h"
#include "sim/own_scene.h"
#include "system/assemble/energy.h"

/* ---- The element ------------------------------------------------------------------------------------------------- */

/* A section: its axes and its position [m] in the frame of node A. */
typedef struct section_frame {
    double Q[9], r[3];
} section_frame;

typedef struct host {
    const dmb_sim *sim;
    const dmb_element_type *type;
    uint32_t element, node;
    int32_t bending;
    double d[6];
    section_frame a, b; /* ends */
    double growth[3];   /* [N] F1 */
    double load[12];    /* [N, N m] of the sections at both ends, each in its axes */
} host;

static void inner_frame(const host *h, double fraction, section_frame *frame)
{
    dmb_section_shape shape;
    dmb_section_shape_at(h->type, fraction, h->bending, &shape);
    dmb_section_pose(h->type, &shape, h->d, frame->Q, frame->r);
}

static void frame_at(const host *h, double fraction, section_frame *frame)
{
    if (fraction == 0.0)
        *frame = h->a;
    else if (fraction == 1.0)
        *frame = h->b;
    else
        inner_frame(h, fraction, frame);
}

/* Acceleration [m/s2] of the section at an end, in the frame of node A: the whole, and its part across the axis, which
 * alone moves mud. */
static void acceleration_of_end(const host *h, uint32_t end, double whole[3], double across[3])
{
    const dmb_configuration *c = &h->sim->now;
    const double *Q = end ? h->b.Q : h->a.Q;
    double v[6], a[6], turning[3];
    dmb_node_vector(h->sim->scene, c, h->node + end, c->velocity, v);
    dmb_node_vector(h->sim->scene, c, h->node + end, c->acceleration, a);
    dmb_arm_velocity(end ? -h->type->arm[1] : h->type->arm[0], v);
    dmb_arm_velocity(end ? -h->type->arm[1] : h->type->arm[0], a);
    dmb_vec3_cross(v + 3, v, turning);
    dmb_vec3_add(a, turning, a);
    dmb_mat3_vec(Q, a, whole);
    a[0] = 0.0;
    dmb_mat3_vec(Q, a, across);
}

/* F1 [N]: inertia force of a section at B minus that at A, times the length; frame of node A. */
static void growth_of_inertia(const host *h, double F1[3])
{
    double near[2][3], far[2][3];
    dmb_vec3_zero(F1);
    if (dmb_is_quasi_static(&h->sim->now)) return;
    acceleration_of_end(h, 0, near[0], near[1]);
    acceleration_of_end(h, 1, far[0], far[1]);
    dmb_vec3_sub(near[0], far[0], F1);
    dmb_vec3_sub(near[1], far[1], near[1]);
    dmb_vec3_scale(h->type->mass_per_metre * h->type->length, F1, F1);
    dmb_vec3_axpy(h->type->mud_per_metre * h->type->length, near[1], F1);
}

/* Elements from this one on that are side by side between six-DOF nodes and straight, at most `most`. */
static uint32_t straight_elements(const dmb_scene *scene, uint32_t first, uint32_t most)
{
    const uint32_t node = scene->element_node[first];
    uint32_t n = 0;
    for (; n < most && first + n < scene->element_count; n++)
        if (scene->element_node[first + n] != node + n || scene->layout.size[node + n] != DMB_NODE_SIX_DOF ||
            scene->layout.size[node + n + 1] != DMB_NODE_SIX_DOF ||
            dmb_element_is_curved(scene->types + scene->element_type[first + n]))
            break;
    return n;
}

static int32_t compute_kept(const dmb_sim *sim, dmb_kept_loads *kept)
{
    const dmb_scene *scene = sim->scene;
    const uint32_t e = kept->first, a = scene->element_node[e], row = scene->layout.row[a];
    const int32_t dynamic = !dmb_is_quasi_static(&sim->now);
    dmb_beam_args args = {.count = kept->count,
                          .types = scene->types,
                          .type = scene->element_type + e,
                          .span = scene->element_span + 3 * (size_t)e,
                          .displacement = sim->now.displacement + 3 * (size_t)a,
                          .quaternion = sim->now.quaternion + 4 * (size_t)a,
                          .velocity = sim->now.velocity + row,
                          .acceleration = sim->now.acceleration + row,
                          .dynamic = dynamic,
                          .damped = dynamic && scene->damped,
                          .arms = scene->arms,
                          .gravity = scene->gravity};
    return scene->kernels->end_loads(&args, kept->loads);
}

/* Loads of an element, computed in lanes for the elements that follow; NULL for elements that are evaluated alone:
 * curved or axial-torsional ones, and all with flowing mud. Stations in decreasing order compute one element at a
 * time. */
static const dmb_end_loads *find_kept(const dmb_sim *sim, uint32_t element, dmb_kept_loads *kept)
{
    if (element - kept->first < kept->count) return kept->loads + (element - kept->first);
    if (sim->scene->flow_count > 0) return NULL;
    kept->count = straight_elements(sim->scene, element, element < kept->first ? 1 : kept->most);
    kept->first = element;
    if (kept->count > 0 && compute_kept(sim, kept) < 0) kept->count = 0;
    return kept->count > 0 ? kept->loads : NULL;
}

static void compute_loads(host *h)
{
    const dmb_scene *scene = h->sim->scene;
    dmb_end_pose a, b;
    dmb_element_end_loads(scene, &h->sim->now, h->element, h->load);
    if (!h->bending) return;
    dmb_end_pose_now(scene, &h->sim->now, h->node, &a);
    dmb_end_pose_now(scene, &h->sim->now, h->node + 1, &b);
    dmb_relative_pose(scene, h->element, &a, &b, h->d);
    inner_frame(h, 1.0, &h->b);
    growth_of_inertia(h, h->growth);
}

static void take_loads(const dmb_end_loads *from, host *h)
{
    dmb_vec6_copy(from->strain, h->d);
    dmb_mat3_copy(from->far_rotation, h->b.Q);
    dmb_vec3_copy(from->far_at, h->b.r);
    dmb_vec3_copy(from->growth, h->growth);
    memcpy(h->load, from->load, sizeof h->load);
}

static void host_of(const dmb_sim *sim, uint32_t element, dmb_kept_loads *kept, host *h)
{
    const dmb_scene *scene = sim->scene;
    const dmb_end_loads *found = find_kept(sim, element, kept);
    h->sim = sim;
    h->element = element;
    h->node = scene->element_node[element];
    h->type = scene->types + scene->element_type[element];
    h->bending = scene->layout.size[h->node] != DMB_NODE_AXIAL_TORSIONAL ||
                 scene->layout.size[h->node + 1] != DMB_NODE_AXIAL_TORSIONAL;
    dmb_mat3_identity(h->a.Q);
    dmb_vec3_zero(h->a.r);
    h->a.r[0] = h->type->arm[0];
    if (found != NULL)
        take_loads(found, h);
    else
        compute_loads(h);
}

/* Adds a wrench at a section, given in its axes, in the frame of node A about the point x. */
static void add_moved(const section_frame *at, const double w[6], double sign, const double x[3], double sum[6])
{
    double f[6], arm[3], moment[3];
    dmb_mat3_vec(at->Q, w, f);
    dmb_mat3_vec(at->Q, w + 3, f + 3);
    dmb_vec3_sub(at->r, x, arm);
    dmb_vec3_cross(arm, f, moment);
    dmb_vec3_add(f + 3, moment, f + 3);
    for (int i = 0; i < 6; i++) sum[i] += sign * f[i];
}

/* ---- Concentrated loads ------------------------------------------------------------------------------------------ */

/* All loads on the element: their sum about end B, the sum of those up to the fraction x about the section there, and
 * the equivalent loads on the nodes. */
typedef struct point_loads {
    double x, at[3];        /* the section, and its position in the frame of node A */
    double all[6], part[6]; /* in the frame of node A */
    double nodes[12];       /* each in the frame of its node */
    uint32_t count, reserved;
} point_loads;

/* w: wrench at the section, in its axes. */
static void add_point(const host *h, double fraction, const double w[6], point_loads *loads)
{
    dmb_section_shape shape;
    dmb_section_frame frame;
    section_frame at;
    double f[12];
    dmb_section_shape_at(h->type, fraction, h->bending, &shape);
    dmb_section_frame_at(&shape, h->d, &frame);
    dmb_section_wrench(h->type->arm, &shape, &frame, w, f);
    loads->count++;
    for (int i = 0; i < 12; i++) loads->nodes[i] += f[i];
    frame_at(h, fraction, &at);
    add_moved(&at, w, 1.0, h->b.r, loads->all);
    if (fraction <= loads->x) add_moved(&at, w, 1.0, loads->at, loads->part);
}

/* Wall force -N n + along t + friction, world frame; friction acts on the surface, at r n from the centre. */
static void site_wrench(const dmb_sim *sim, uint32_t site, double w[6])
{
    const double radius = sim->scene->sites[site].radius;
    dmb_site_force force;
    double R[9], b[3], friction[3], moment[3];
    dmb_contact_force_of(sim, site, &force);
    dmb_vec3_cross(force.tangent, force.normal, b);
    for (int i = 0; i < 3; i++) {
        friction[i] = force.friction[0] * force.tangent[i] + force.friction[1] * b[i];
        w[i] = friction[i] + force.along * force.tangent[i] - force.normal_force * force.normal[i];
    }
    dmb_vec3_cross(force.normal, friction, moment);
    dmb_vec3_scale(radius, moment, w + 3);
    dmb_site_axes(sim->scene, &sim->now, site, R);
    dmb_mat3_tvec(R, w, w);
    dmb_mat3_tvec(R, w + 3, w + 3);
}

/* First contact point inside an element whose number is not below this one. */
static uint32_t first_inside(const dmb_scene *scene, uint32_t element)
{
    uint32_t low = 0, high = scene->inside_count;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (scene->inside[middle].element < element)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static void add_sites(const host *h, point_loads *loads)
{
    const dmb_scene *scene = h->sim->scene;
    for (uint32_t i = first_inside(scene, h->element); i < scene->inside_count; i++) {
        double w[6];
        if (scene->inside[i].element != h->element) return;
        site_wrench(h->sim, dmb_node_sites(scene) + i, w);
        add_point(h, scene->inside[i].fraction, w, loads);
    }
}

/* Adds a wrench at a point offset from its section, in the axes of both. */
static void add_force(const host *h, const dmb_scene_point *point, const double at_point[6], point_loads *loads)
{
    double w[6], moment[3];
    dmb_vec6_copy(at_point, w);
    dmb_vec3_cross(point->x, w, moment);
    dmb_vec3_add(w + 3, moment, w + 3);
    add_point(h, point->fraction, w, loads);
}

static void add_loads(const host *h, point_loads *loads)
{
    const dmb_scene *scene = h->sim->scene;
    for (uint32_t i = 0; i < scene->load_count; i++) {
        const dmb_scene_load *load = scene->loads + i;
        double w[6];
        if (load->point == DMB_NONE || scene->load_points[load->point].element != h->element) continue;
        dmb_point_load_of(h->sim, &h->sim->now, i, w);
        add_force(h, scene->load_points + load->point, w, loads);
    }
}

static void add_spring(const host *h, const dmb_point_motion *point, const double n[3], double tension,
                       point_loads *loads)
{
    double w[6] = {0.0};
    if (point->point->element != h->element) return;
    dmb_mat3_tvec(point->R, n, w);
    dmb_vec3_scale(tension, w, w);
    add_force(h, point->point, w, loads);
}

static void add_springs(const host *h, point_loads *loads)
{
    const dmb_scene *scene = h->sim->scene;
    for (uint32_t i = 0; i < scene->spring_count; i++) {
        const dmb_scene_spring *spring = scene->springs + i;
        dmb_spring_motion m;
        if (spring->a.element != h->element && spring->b.element != h->element) continue;
        dmb_spring_motion_of(scene, &h->sim->now, i, !dmb_is_quasi_static(&h->sim->now), &m);
        add_spring(h, &m.a, m.n, m.force.elastic + m.force.damper, loads);
        add_spring(h, &m.b, m.n, -(m.force.elastic + m.force.damper), loads);
    }
}

static void add_stuck(const host *h, point_loads *loads)
{
    const dmb_scene *scene = h->sim->scene;
    for (uint32_t i = 0; i < scene->stuck_count; i++) {
        double w[6];
        if (!h->sim->stuck_held[i] || scene->stuck[i].point.element != h->element) continue;
        dmb_stuck_wrench_of(h->sim, &h->sim->now, i, !dmb_is_quasi_static(&h->sim->now), w);
        add_force(h, &scene->stuck[i].point, w, loads);
    }
}

static void point_loads_of(const host *h, double x, const section_frame *at, point_loads *loads)
{
    memset(loads, 0, sizeof *loads);
    loads->x = x;
    dmb_vec3_copy(at->r, loads->at);
    add_sites(h, loads);
    add_loads(h, loads);
    add_springs(h, loads);
    add_stuck(h, loads);
}

/* Removes the equivalent loads from the nodes of the element, because the loads act on the segment. */
static void subtract_nodes(host *h, const point_loads *loads)
{
    double f[12];
    memcpy(f, loads->nodes, sizeof f);
    dmb_arm_wrench(-h->type->arm[0], f);
    dmb_arm_wrench(h->type->arm[1], f + 6);
    for (int i = 0; i < 6; i++) {
        h->load[i] += f[i];
        h->load[6 + i] -= f[6 + i];
    }
}

/* ---- Eccentric mass ---------------------------------------------------------------------------------------------- */

/* M a - ad_v^T M v - weight of a rigid mass on its node, in the frame of the node; the parts `lifted` [kg, kg m] of its
 * mass and first moment along the axis are carried by the buoyancy of the mud. */
static void share_wrench(const dmb_sim *sim, const dmb_rigid_mass *share, const double lifted[2], double f[6])
{
    const dmb_scene *scene = sim->scene;
    const double centre[3] = {share->moment[0] - lifted[1], share->moment[1], share->moment[2]};
    double v[6], a[6], p[6], turning[6], R[9], u[3], g[3], moment[3];
    dmb_node_vector(scene, &sim->now, share->node, sim->now.velocity, v);
    dmb_node_vector(scene, &sim->now, share->node, sim->now.acceleration, a);
    dmb_rigid_mass_times(share, v, p);
    dmb_rigid_mass_times(share, a, f);
    dmb_ad_transpose(v, p, turning);
    for (int i = 0; i < 6; i++) f[i] = dmb_is_quasi_static(&sim->now) ? 0.0 : f[i] - turning[i];
    dmb_node_pose(scene, &sim->now, share->node, R, u);
    dmb_mat3_tvec(R, scene->gravity, g);
    dmb_vec3_cross(centre, g, moment);
    dmb_vec3_axpy(lifted[0] - share->mass, g, f);
    dmb_vec3_sub(f + 3, moment, f + 3);
}

/* Each node has half of the eccentric mass, which acts along the whole element. */
static void add_eccentric(host *h, const dmb_described_pipe *pipe)
{
    if (!pipe->eccentric) return;
    for (uint32_t end = 0; end < 2; end++) {
        const double lifted[2] = {0.0, 0.0}; /* buoyancy acts on the axis */
        dmb_rigid_mass share;
        double f[6];
        dmb_eccentric_fraction(h->sim->scene, pipe, h->element, end, &share);
        share_wrench(h->sim, &share, lifted, f);
        dmb_arm_wrench(end ? h->type->arm[1] : -h->type->arm[0], f);
        for (int i = 0; i < 6; i++) h->load[6 * end + (uint32_t)i] += end ? f[i] : -f[i];
    }
}

/* ---- External damping -------------------------------------------------------------------------------------------- */

int dmb_external_damping_at(const dmb_sim *sim, const double damped[3], const double v[6], double f[6])
{
    double c[3], of_length[5];
    if ((sim->scene->features & DMB_FEATURE_DAMPING) == 0 || dmb_is_quasi_static(&sim->now)) return 0;
    dmb_external_damping(sim, c);
    dmb_node_damping_of(damped, c[1], c[2], c[0], of_length);
    dmb_damping_force(of_length, v, f);
    return 1;
}

/* Each node has the damping of half of the element, which acts along all of it, as the velocities there. */
static void add_external_damping(host *h)
{
    const double half[3] = {0.5 * h->type->length, 0.0, 0.0};
    for (uint32_t end = 0; end < 2; end++) {
        const double sign = end ? -1.0 : 1.0;
        double v[6], f[6], across[3];
        dmb_node_vector(h->sim->scene, &h->sim->now, h->node + end, h->sim->now.velocity, v);
        dmb_arm_velocity(sign * h->type->arm[end], v);
        if (!dmb_external_damping_at(h->sim, half, v, f)) return;
        for (uint32_t i = 0; i < 6; i++) h->load[6 * end + i] += sign * f[i];
        dmb_mat3_vec(end ? h->b.Q : h->a.Q, f, across);
        dmb_vec3_axpy(-2.0 * sign, across, h->growth);
    }
}

/* ---- Distributed loads ------------------------------------------------------------------------------------------- */

/* x (r_A - r)/2 + x^2 L (t_A - t)/12: integral of the vector from the section to the points of the segment, over their
 * fraction (trapezoidal rule with end correction; exact for cubic curves). */
static void way_to(const host *h, double x, const section_frame *at, double way[3])
{
    for (int i = 0; i < 3; i++)
        way[i] = 0.5 * x * (h->a.r[i] - at->r[i]) + x * x * h->type->length / 12.0 * (h->a.Q[3 * i] - at->Q[3 * i]);
}

/* Total of the distributed loads, about end B. */
static void total_of(const host *h, const point_loads *loads, double T[6])
{
    for (int i = 0; i < 6; i++) T[i] = -loads->all[i];
    add_moved(&h->a, h->load, 1.0, h->b.r, T);
    add_moved(&h->b, h->load + 6, -1.0, h->b.r, T);
}

/* D of the segment up to x, about its section, for a uniform density plus inertia and damping, which increase by F1;
 * the remaining moment of the whole element is distributed uniformly. */
static void distributed_to(const host *h, double x, const section_frame *at, const double T[6], double D[6])
{
    const double *F1 = h->growth;
    double way[3], moment[3], left[3], span[3], grown[3];
    dmb_vec3_sub(h->b.r, h->a.r, span);
    dmb_vec3_cross(span, F1, grown);
    way_to(h, 1.0, &h->b, way);
    dmb_vec3_cross(way, T, moment);
    for (int i = 0; i < 3; i++) left[i] = T[3 + i] - moment[i] - grown[i] / 12.0;
    way_to(h, x, at, way);
    dmb_vec3_cross(way, T, moment);
    for (int i = 0; i < 3; i++) {
        D[i] = x * T[i] - 0.5 * x * (1.0 - x) * F1[i];
        D[3 + i] = moment[i] + (0.25 - x / 6.0) * x * x * grown[i] + x * left[i];
    }
}

/* ---- The section ------------------------------------------------------------------------------------------------- */

void dmb_section_load_of(const dmb_sim *sim, const dmb_described_pipe *pipe, const dmb_material_point *point,
                         dmb_kept_loads *kept, double load[6])
{
    const double x = point->fraction;
    double sum[6] = {0.0}, T[6], D[6];
    host h;
    section_frame at;
    point_loads loads;
    host_of(sim, point->element, kept, &h);
    if (!h.bending) {
        dmb_vec6_copy(h.load, load); /* mean of an axial-torsional element */
        return;
    }
    frame_at(&h, x, &at);
    point_loads_of(&h, x, &at, &loads);
    if (loads.count > 0) subtract_nodes(&h, &loads);
    add_eccentric(&h, pipe);
    add_external_damping(&h);
    if (loads.count == 0 && (x == 0.0 || x == 1.0)) {
        dmb_vec6_copy(h.load + (x > 0.0 ? 6 : 0), load);
        return;
    }
    total_of(&h, &loads, T);
    distributed_to(&h, x, &at, T, D);
    add_moved(&h.a, h.load, 1.0, at.r, sum);
    for (int i = 0; i < 6; i++) sum[i] -= loads.part[i] + D[i];
    dmb_mat3_tvec(at.Q, sum, load);
    dmb_mat3_tvec(at.Q, sum + 3, load + 3);
}

/* ---- In a tool joint --------------------------------------------------------------------------------------------- */

/* External damping of the tool joint between the element and a point in it. */
static void damp_joint(const dmb_sim *sim, const dmb_element_type *type, const dmb_material_point *point,
                       double load[6])
{
    const double b = point->beyond, damped[3] = {b, -0.5 * b * b, b * b * b / 3.0};
    double v[6], f[6];
    dmb_node_vector(sim->scene, &sim->now, sim->scene->element_node[point->element] + 1, sim->now.velocity, v);
    dmb_arm_velocity(b - type->arm[1], v);
    if (dmb_external_damping_at(sim, damped, v, f))
        for (int i = 0; i < 6; i++) load[i] -= f[i];
}

/* Section load in a tool joint: that at its near end, moved to the section `beyond` [m] further, with inertia, weight
 * and damping of the part between. */
void dmb_section_load_in_joint(const dmb_sim *sim, const dmb_described_pipe *pipe, const dmb_material_point *point,
                               double load[6])
{
    const dmb_element_type *type = sim->scene->types + sim->scene->element_type[point->element];
    const dmb_mud mud = dmb_mud_of(sim->scene);
    dmb_rigid_mass share;
    double f[6];
    const double mass = dmb_joint_part_fraction(sim->scene, pipe, point->beyond, &share);
    const double lifted = mass > 0.0 ? (1.0 - dmb_buoyancy_factor(pipe->def, 1, &mud)) * mass : 0.0;
    const double carried[2] = {lifted, lifted * (0.5 * point->beyond - type->arm[1])};
    share_wrench(sim, &share, carried, f);
    dmb_arm_wrench(type->arm[1] - point->beyond, f);
    dmb_arm_wrench(-point->beyond, load);
    for (int i = 0; i < 6; i++) load[i] += f[i];
    damp_joint(sim, type, point, load);
}
