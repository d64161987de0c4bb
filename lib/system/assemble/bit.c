/* Bits: bottom-hole load and rock law, along and about the axis of the hole (eq:bit.forces), and cutting sideways
 * (eq:bit.side).
 *
 *     motion      U [m] advance of the reference point along the axis since time 0, V its rate, Phi [rad] angle of the
 *                 node, Omega [rad/s] its spin
 *     force       -(load + W) along the axis at the reference point, -T about the x axis of the node
 *
 *     state of the evaluation                           law
 *     -----------------------------------------------   ---------------------------------------------------------
 *     a step                                            rock law with the surface of the accepted state
 *     steady, bit marked in `drilling`                  rock law on the surface of steady drilling
 *     statics, or steady and not marked                 the load alone */
#include "system/assemble/assemble.h"

#include <string.h>

#include "element/beam.h"
#include "sim/node.h"
#include "system/assemble/evaluation.h"
#include "system/constrain/rotor.h"

/* Motion of a bit along and about the axis of the hole. */
typedef struct bit_motion {
    double advance, speed, angle, spin;
    double along[6], about[6]; /* body-frame directions of both at the node: speed = along . v, spin = about . v */
    double axis[3];            /* the axis in the body frame */
    double bend[3];            /* [1/m] its change with the depth, body frame; 0 on axial-torsional nodes */
    double depth_by;           /* [-] J: depth of the closest point of the axis by advance of a point beside it */
} bit_motion;

/* Axis of the hole at the bit into m->axis, still in the world frame; without a hole the axis of its initial pose. Its
 * bend and J in a bent hole. Returns the advance [m] since time 0. In a straight hole, or without one, the advance is a
 * scalar product of the displacement, without the digits that the difference of two positions would lose. */
static double locate(const dmb_scene *scene, const dmb_configuration *c, const dmb_scene_bit *bit, const double R[9],
                     uint32_t *segment, bit_motion *m)
{
    double *tangent = m->axis;
    const uint32_t node = bit->node;
    double start[9], arm[3], moved[3], x[3], point[3], bend[3], unused[3], s = scene->reference_depth[node];
    dmb_quat_to_matrix(scene->reference_quaternion + 4 * node, start);
    dmb_vec3_set(start[0], start[3], start[6], tangent);
    dmb_vec3_set(R[0], R[3], R[6], arm);
    if (!scene->has_hole || dmb_hole_is_straight(&scene->hole)) {
        if (scene->has_hole) dmb_hole_frame(&scene->hole, s, point, tangent, NULL);
        dmb_vec3_copy(c->displacement + 3 * node, moved);
        dmb_vec3_axpy(bit->arm, arm, moved);
        return dmb_vec3_dot(tangent, moved) -
               bit->arm * (tangent[0] * start[0] + tangent[1] * start[3] + tangent[2] * start[6]);
    }
    dmb_vec3_add(scene->reference_position + 3 * node, c->displacement + 3 * node, x);
    dmb_vec3_axpy(bit->arm, arm, x);
    dmb_hole_project(&scene->hole, x, &s, segment, point, tangent);
    dmb_hole_frame(&scene->hole, s, unused, NULL, bend);
    dmb_vec3_sub(x, point, x);
    m->depth_by = 1.0 / (1.0 - dmb_vec3_dot(x, bend));
    dmb_mat3_tvec(R, bend, m->bend);
    return s - scene->reference_depth[node] - bit->arm;
}

/* Advance U and speed V = along . v of the bit's reference point, angle and speed about the axis of the hole; `along`
 * includes the arm to the node. */
static void motion_of(const dmb_scene *scene, const dmb_configuration *c, const double R[9], uint32_t k,
                      uint32_t *segment, bit_motion *m)
{
    const dmb_scene_bit *bit = scene->bits + k;
    double v[6], tangent[3];
    memset(m, 0, sizeof *m);
    dmb_node_vector(scene, c, bit->node, c->velocity, v);
    m->depth_by = 1.0;
    m->about[3] = 1.0;
    m->spin = v[3];
    m->angle = c->turn[bit->node];
    if (scene->layout.size[bit->node] == DMB_NODE_AXIAL_TORSIONAL) {
        m->advance = c->displacement[3 * bit->node];
        m->along[0] = m->axis[0] = 1.0;
        m->speed = v[0];
        return;
    }
    m->advance = locate(scene, c, bit, R, segment, m);
    dmb_vec3_copy(m->axis, tangent);
    dmb_mat3_tvec(R, tangent, m->axis);
    dmb_vec3_copy(m->axis, m->along);
    dmb_arm_wrench(bit->arm, m->along);
    m->speed = dmb_vec6_dot(m->along, v);
}

/* A view of the ring buffer of the rock surface over the angle (eq:bit.regenerative); keep_history stores its head. */
dmb_bit_history dmb_bit_history_of(const dmb_sim *sim, uint32_t k)
{
    const dmb_scene_bit *bit = sim->scene->bits + k;
    dmb_bit_history h;
    memset(&h, 0, sizeof h);
    h.angle = sim->history_angle + bit->history_first;
    h.surface = sim->history_surface + bit->history_first;
    h.capacity = bit->history_capacity;
    h.head = sim->history_head[k].head;
    h.count = sim->history_head[k].count;
    h.offset = sim->history_head[k].offset;
    dmb_bit_history_pace(&h, bit->law.blades);
    return h;
}

static void keep_history(dmb_sim *sim, uint32_t k, const dmb_bit_history *h)
{
    sim->history_head[k].head = h->head;
    sim->history_head[k].count = h->count;
    sim->history_head[k].offset = h->offset;
}

/* The history is that of the accepted state: within a step no blade meets what it cuts in the same step. */
static void rock(const dmb_sim *sim, uint32_t k, double bottom, const bit_motion *m, dmb_bit_rock_result *out)
{
    const dmb_scene_bit *bit = sim->scene->bits + k;
    const dmb_bit_history history = dmb_bit_history_of(sim, k);
    memset(out, 0, sizeof *out);
    if (bit->law.kind == DMB_ROCK_NONE) return;
    dmb_bit_rock_force(&bit->law, bit->history_capacity ? &history : NULL, bottom, m->advance, m->speed, m->angle,
                       m->spin, out);
}

/* [rad/s] Spin below which the message of a failed step names the limit of the rate law; [m] distance off bottom at
 * which the bit may touch. */
#define DMB_BIT_SLOW 1.0
#define DMB_BIT_NEAR 1e-3

uint32_t dmb_bit_near_rest(const dmb_sim *sim, double *spin)
{
    for (uint32_t k = 0; k < sim->scene->bit_count; k++) {
        const dmb_scene_bit *bit = sim->scene->bits + k;
        double before[6], tried[6];
        if (bit->law.kind != DMB_ROCK_RATE || sim->now.bit_bottom[k] - sim->now.bit_advance[k] > DMB_BIT_NEAR) continue;
        dmb_node_vector(sim->scene, &sim->now, bit->node, sim->now.velocity, before);
        dmb_node_vector(sim->scene, &sim->trial, bit->node, sim->trial.velocity, tried);
        *spin = fabs(tried[3]) < fabs(before[3]) ? tried[3] : before[3];
        if (fabs(*spin) < DMB_BIT_SLOW) return k;
    }
    return DMB_NONE;
}

int dmb_bit_on_bottom(const dmb_sim *sim, uint32_t k)
{
    if (sim->clock->time == 0.0) return sim->scene->bits[k].bottom <= 0.0;
    return sim->now.bit_advance[k] >= sim->now.bit_bottom[k];
}

/* [m] Depth of cut of a blade at a steady speed and spin; 0: no blade cuts. */
static double steady_cut(const dmb_scene_bit *bit, double speed, double spin)
{
    return speed > 0.0 && spin > 0.0 ? DMB_TWO_PI * speed / (spin * bit->law.blades) : 0.0;
}

/* In steady drilling the force depends on speeds alone: places the rock surface one steady cut ahead of the bit. Two
 * samples are enough for a surface that is linear in the angle. Its derivatives by U and Phi are 0, because in steady
 * drilling the surface moves with the bit. */
static void rock_in_steady_drilling(const dmb_sim *sim, uint32_t k, const bit_motion *m, dmb_bit_rock_result *out)
{
    const dmb_scene_bit *bit = sim->scene->bits + k;
    memset(out, 0, sizeof *out);
    if (bit->law.kind == DMB_ROCK_NONE) return;
    const double cut = steady_cut(bit, m->speed, m->spin), spacing = DMB_TWO_PI / bit->law.blades;
    double angle[2] = {m->angle - 2.0 * spacing, m->angle - 0.5 * spacing};
    double surface[2] = {m->advance - 2.0 * cut, m->advance - 0.5 * cut};
    dmb_bit_history h;
    memset(&h, 0, sizeof h);
    h.angle = angle;
    h.surface = surface;
    h.capacity = h.count = 2;
    h.head = 1;
    h.spacing = spacing;
    h.angle_step = 0.1 * spacing;
    dmb_bit_rock_force(&bit->law, bit->history_capacity ? &h : NULL, m->advance - bit->law.intrusion_depth, m->advance,
                       m->speed, m->angle, m->spin, out);
    out->dW_dU = out->dW_dPhi = out->dT_dU = out->dT_dPhi = 0.0;
}

/* K -= -(along dW + about dT) x (dU J along + dPhi about), C by V and Omega in the same way; the axial force rotates
 * with the body and, in a bent hole, with the depth (eq:motion.turn). J = ds/dx of a point beside the axis. */
static void add_tangent(dmb_evaluation *evaluation, uint32_t k, const bit_motion *m, const dmb_bit_rock_result *r,
                        double axial)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_scene_bit *bit = sim->scene->bits + k;
    double K[36], C[36], force[3], skew[9], w[6];
    dmb_mat6_zero(K);
    dmb_mat6_zero(C);
    dmb_mat6_add_outer(m->depth_by * r->dW_dU, m->along, m->along, K);
    dmb_mat6_add_outer(r->dW_dPhi, m->along, m->about, K);
    dmb_mat6_add_outer(m->depth_by * r->dT_dU, m->about, m->along, K);
    dmb_mat6_add_outer(r->dT_dPhi, m->about, m->about, K);
    dmb_mat6_add_outer(evaluation->velocity_factor * r->dW_dV, m->along, m->along, C);
    dmb_mat6_add_outer(evaluation->velocity_factor * r->dW_dOmega, m->along, m->about, C);
    dmb_mat6_add_outer(evaluation->velocity_factor * r->dT_dV, m->about, m->along, C);
    dmb_mat6_add_outer(evaluation->velocity_factor * r->dT_dOmega, m->about, m->about, C);
    if (sim->scene->layout.size[bit->node] == DMB_NODE_AXIAL_TORSIONAL) {
        double *Kp = dmb_stiffness_of(sim, bit->node), *Cp = dmb_inertia_of(sim, bit->node);
        for (int i = 0; i < 2; i++)
            for (int j = 0; j < 2; j++) {
                Kp[2 * i + j] += K[18 * i + 3 * j];
                Cp[2 * i + j] += C[18 * i + 3 * j];
            }
        return;
    }
    dmb_vec3_scale(axial, m->axis, force);
    dmb_skew(force, skew); /* axial force in body axes: d(R^T f) = (R^T f)~ dtheta, also at the arm */
    dmb_mat6_add_block(-1.0, skew, 0, 1, K);
    for (int j = 0; j < 3; j++) {
        dmb_vec6_copy((const double[6]){skew[j], skew[3 + j], skew[6 + j], 0.0, 0.0, 0.0}, w);
        dmb_arm_wrench(bit->arm, w);
        K[24 + 3 + j] -= w[4];
        K[30 + 3 + j] -= w[5];
    }
    dmb_vec6_copy((const double[6]){m->bend[0], m->bend[1], m->bend[2], 0.0, 0.0, 0.0}, w);
    dmb_arm_wrench(bit->arm, w);
    dmb_add_turn(evaluation, -axial * m->depth_by, w, m->along, K);
    dmb_mat6_axpy(1.0, K, dmb_stiffness_of(sim, bit->node));
    if (evaluation->dynamic) dmb_mat6_axpy(1.0, C, dmb_inertia_of(sim, bit->node));
}

/* Force -(load + W) along the axis and moment -T about it, with W and T of the rock law at (U, Phi, V, Omega)
 * (eq:bit.forces). */
static void assemble_bit(dmb_evaluation *evaluation, uint32_t k)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    const uint32_t node = scene->bits[k].node;
    const double load = evaluation->load_factor * sim->trial.bit_load[k];
    dmb_bit_rock_result r;
    bit_motion m;
    double R[9], unused[3], wrench[6];
    sim->trial.bit_segment[k] = sim->now.bit_segment[k];
    dmb_node_pose(scene, &sim->trial, node, R, unused);
    motion_of(scene, &sim->trial, R, k, &sim->trial.bit_segment[k], &m);
    if (scene->layout.size[node] == DMB_NODE_SIX_DOF) /* its rotation angle is computed when the step is accepted */
        m.angle = sim->now.turn[node] + dmb_node_travel(evaluation, node, 3);
    memset(&r, 0, sizeof r);
    const int drills = evaluation->steady && k < DMB_STEADY_BITS && evaluation->drilling >> k & 1;
    if (drills)
        rock_in_steady_drilling(sim, k, &m, &r);
    else if (evaluation->dynamic && !evaluation->steady)
        rock(sim, k, sim->now.bit_bottom[k], &m, &r);
    sim->trial.bit_advance[k] = m.advance;
    const double axial = -(load + r.weight_on_bit);
    for (int i = 0; i < 6; i++) wrench[i] = axial * m.along[i] - r.torque_on_bit * m.about[i];
    dmb_apply_wrench(sim, node, wrench);
    evaluation->power[DMB_POWER_LOADS] -= load * m.speed;
    evaluation->power[DMB_POWER_ROCK] -= r.weight_on_bit * m.speed + r.torque_on_bit * m.spin;
    const double force[4] = {-r.weight_on_bit, -r.torque_on_bit, 0.0, 0.0}, speed[4] = {m.speed, m.spin, 0.0, 0.0};
    memcpy(sim->trial.bit_force + 4 * (size_t)k, force, sizeof force);
    memcpy(sim->trial.bit_speed + 4 * (size_t)k, speed, sizeof speed);
    if (evaluation->tangent) add_tangent(evaluation, k, &m, &r, axial);
}

/* ---- Cutting sideways -------------------------------------------------------------------------------------------- */

/* Velocity of the bit across its axis, y and z of the body: rows (0, 1, 0, 0, 0, arm) and (0, 0, 1, 0, -arm, 0). */
static void side_of(const dmb_scene *scene, const dmb_configuration *c, uint32_t k, double v[2], dmb_side_force *side)
{
    const dmb_scene_bit *bit = scene->bits + k;
    double at[6];
    dmb_node_vector(scene, c, bit->node, c->velocity, at);
    v[0] = at[1] + bit->arm * at[5];
    v[1] = at[2] - bit->arm * at[4];
    dmb_side_force_at(&bit->side, v, at[3], side);
}

/* C = D/w (Jy (cos Jy + sin Jz) + Jz (cos Jz - sin Jy)), less the force by the spin. J_y, J_z: rows of the velocity
 * across the axis (side_of), D/w the coefficient of eq:bit.side. */
static void add_side_tangent(dmb_evaluation *evaluation, uint32_t k, const dmb_side_force *side)
{
    const dmb_scene_bit *bit = evaluation->sim->scene->bits + k;
    const double J[2][6] = {{0.0, 1.0, 0.0, 0.0, 0.0, bit->arm}, {0.0, 0.0, 1.0, 0.0, -bit->arm, 0.0}};
    const double about[6] = {0.0, 0.0, 0.0, 1.0, 0.0, 0.0}, c = evaluation->velocity_factor * side->eta;
    double C[36];
    dmb_mat6_zero(C);
    for (int i = 0; i < 2; i++) {
        dmb_mat6_add_outer(c * bit->side.cosine, J[i], J[i], C);
        dmb_mat6_add_outer((i == 0 ? c : -c) * bit->side.sine, J[i], J[1 - i], C);
        dmb_mat6_add_outer(-evaluation->velocity_factor * side->by_spin[i], J[i], about, C);
    }
    dmb_mat6_axpy(1.0, C, dmb_inertia_of(evaluation->sim, bit->node));
}

/* Adds the rounding of the velocities whose sum is the speed across the axis (system/assemble/springs). */
static void count_side_rounding(dmb_evaluation *evaluation, uint32_t k, const dmb_side_force *side)
{
    const dmb_sim *sim = evaluation->sim;
    const dmb_scene_bit *bit = sim->scene->bits + k;
    double v[6];
    if (!evaluation->extrapolated && evaluation->step != 0.0) return;
    dmb_node_vector(sim->scene, &sim->trial, bit->node, sim->trial.velocity, v);
    const double force = side->eta * (dmb_vec3_norm(v) + fabs(bit->arm) * dmb_vec3_norm(v + 3));
    evaluation->rounding += force * force;
}

/* Linear in the velocities: the force has no tangent by displacements in the axes of the body. */
static void assemble_side(dmb_evaluation *evaluation, uint32_t k)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_scene_bit *bit = sim->scene->bits + k;
    dmb_side_force side;
    double v[2];
    if (!evaluation->dynamic || !(bit->side.resistance > 0.0)) return;
    side_of(sim->scene, &sim->trial, k, v, &side);
    const double wrench[6] = {
        0.0, side.force[0], side.force[1], 0.0, -bit->arm * side.force[1], bit->arm * side.force[0]};
    dmb_apply_wrench(sim, bit->node, wrench);
    evaluation->power[DMB_POWER_ROCK] += side.force[0] * v[0] + side.force[1] * v[1];
    memcpy(sim->trial.bit_force + 4 * (size_t)k + 2, side.force, 2 * sizeof(double));
    memcpy(sim->trial.bit_speed + 4 * (size_t)k + 2, v, sizeof v);
    count_side_rounding(evaluation, k, &side);
    if (evaluation->tangent) add_side_tangent(evaluation, k, &side);
}

double dmb_bit_side_of(const dmb_sim *sim, uint32_t k, double force[3])
{
    double R[9], u[3], v[2];
    dmb_side_force side;
    dmb_vec3_zero(force);
    if (!(sim->scene->bits[k].side.resistance > 0.0)) return 0.0;
    side_of(sim->scene, &sim->now, k, v, &side);
    dmb_node_pose(sim->scene, &sim->now, sim->scene->bits[k].node, R, u);
    const double across[3] = {0.0, side.force[0], side.force[1]};
    dmb_mat3_vec(R, across, force);
    return sqrt(v[0] * v[0] + v[1] * v[1]);
}

void dmb_assemble_bits(dmb_evaluation *evaluation)
{
    for (uint32_t k = 0; k < evaluation->sim->scene->bit_count; k++) {
        assemble_bit(evaluation, k);
        assemble_side(evaluation, k);
    }
}

static void motion_now(const dmb_sim *sim, uint32_t k, bit_motion *m)
{
    double R[9], displacement[3];
    uint32_t segment = sim->now.bit_segment[k];
    dmb_node_pose(sim->scene, &sim->now, sim->scene->bits[k].node, R, displacement);
    motion_of(sim->scene, &sim->now, R, k, &segment, m);
}

void dmb_bit_force_of(const dmb_sim *sim, uint32_t k, dmb_bit_rock_result *out, double *load)
{
    bit_motion m;
    motion_now(sim, k, &m);
    rock(sim, k, sim->now.bit_bottom[k], &m, out);
    *load = sim->now.bit_load[k];
}

double dmb_bit_speed_of(const dmb_sim *sim, uint32_t k)
{
    bit_motion m;
    motion_now(sim, k, &m);
    return m.speed;
}

void dmb_bit_slope_of(const dmb_sim *sim, uint32_t k, dmb_bit_slope *out)
{
    bit_motion m;
    dmb_bit_rock_result r;
    motion_now(sim, k, &m);
    rock(sim, k, sim->now.bit_bottom[k], &m, &r);
    const dmb_bit_slope slope = {.weight = {r.dW_dU, r.dW_dPhi, r.dW_dV, r.dW_dOmega},
                                 .torque = {r.dT_dU, r.dT_dPhi, r.dT_dV, r.dT_dOmega}};
    *out = slope;
    dmb_vec6_copy(m.along, out->along);
    dmb_vec6_copy(m.about, out->about);
}

void dmb_bit_start(dmb_sim *sim, uint32_t k)
{
    const dmb_scene_bit *bit = sim->scene->bits + k;
    const dmb_hole *hole = &sim->scene->hole;
    dmb_bit_history h = dmb_bit_history_of(sim, k);
    if (sim->scene->has_hole && !dmb_hole_is_straight(hole))
        sim->now.bit_segment[k] = dmb_hole_segment_at(hole, sim->scene->reference_depth[bit->node] + bit->arm);
    sim->now.bit_bottom[k] = sim->trial.bit_bottom[k] = sim->now.bit_advance[k] + bit->bottom;
    dmb_hole_make_room(sim, k, sim->now.bit_bottom[k]);
    if (!bit->history_capacity) return;
    (void)dmb_bit_history_init(&h, &bit->law, sim->now.turn[bit->node], sim->now.bit_bottom[k]);
    keep_history(sim, k, &h);
}

/* Fills the history with the steady surface, one cut per blade spacing, sampled as in a run. */
static void guess_helix(dmb_sim *sim, uint32_t k, double cut, double angle, double advance)
{
    const dmb_scene_bit *bit = sim->scene->bits + k;
    dmb_bit_history h = dmb_bit_history_of(sim, k);
    const double reach = h.spacing + 2.0 * h.angle_step;
    const uint32_t samples = (uint32_t)floor(reach / (1.000001 * h.angle_step));
    const double slope = cut / h.spacing;
    (void)dmb_bit_history_init(&h, &bit->law, angle - reach, advance - slope * reach);
    for (uint32_t i = 1; i <= samples; i++) {
        const double behind = reach * (double)(samples - i) / samples;
        dmb_bit_history_record(&h, angle - behind, advance - slope * behind);
    }
    keep_history(sim, k, &h);
}

/* Rock surface as after steady drilling at the present speed and spin, so that a run which begins there has no
 * transient of first contact: the bottom follows the bit at the intrusion depth (eq:bit.rate), the surface is the helix
 * of one cut per blade. */
void dmb_bit_start_steady(dmb_sim *sim, uint32_t k)
{
    const dmb_scene_bit *bit = sim->scene->bits + k;
    bit_motion m;
    motion_now(sim, k, &m);
    sim->now.bit_advance[k] = sim->trial.bit_advance[k] = m.advance;
    if (bit->law.kind == DMB_ROCK_NONE) return;
    const double cut = steady_cut(bit, m.speed, m.spin), before = sim->now.bit_bottom[k];
    sim->now.bit_bottom[k] = sim->trial.bit_bottom[k] = m.advance - bit->law.intrusion_depth;
    dmb_hole_make_room(sim, k, before);
    if (bit->history_capacity) guess_helix(sim, k, cut, m.angle, m.advance);
}

/* The bottom only advances (dmb_bit_rock_bottom), and the surface gets a sample at the accepted angle. Nothing is cut
 * by a step that is rejected. */
void dmb_bit_accept(const dmb_evaluation *evaluation, uint32_t k)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_scene_bit *bit = sim->scene->bits + k;
    const double advance = sim->trial.bit_advance[k];
    if (!evaluation->dynamic) { /* moves to equilibrium cut nothing */
        sim->trial.bit_bottom[k] = sim->now.bit_bottom[k];
        return;
    }
    sim->trial.bit_bottom[k] = dmb_bit_rock_bottom(&bit->law, sim->now.bit_bottom[k], advance);
    if (bit->law.kind == DMB_ROCK_NONE || !bit->history_capacity) return;
    dmb_bit_history h = dmb_bit_history_of(sim, k);
    dmb_bit_history_record(&h, sim->trial.turn[bit->node], advance);
    keep_history(sim, k, &h);
}
