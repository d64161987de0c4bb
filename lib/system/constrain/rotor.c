/* Steps of rotors in axes that do not spin with them (eq:motion.rotor; symbols and derivation: rotor.h).
 *
 *     call                     in terms of rotor.h
 *     ----------------------   ---------------------------------------------------------------------
 *     begin                    O, P(h); V0, V0', A0 in the axes reached by P(h); H0 P(h)
 *     dmb_rotors_predict       generalized-alpha on (V, V', A), then back to v1, v1', a1 (eq:motion.rotor-step)
 *     dmb_rotors_correct       all rows got beta' dz and gamma' dz: subtracts gamma' ad(O) dz (eq:motion.rotor-tangent)
 *     dmb_rotors_follow        the same after the projection of the speeds
 *     dmb_rotors_place         H1 = H0 P(h) exp z
 *     dmb_rotors_matrix        -gamma' M ad(O), its part of the iteration matrix */
#include "system/constrain/rotor.h"

#include "element/added_mass.h"
#include "element/rigid_mass.h"
#include "kernel/kernels.h"
#include "math/se3.h"

/* Rotors are sorted by node: bisection. */
uint32_t dmb_rotor_on(const dmb_scene *scene, uint32_t node)
{
    uint32_t first = 0, end = scene->rotor_count;
    while (first < end) {
        const uint32_t middle = first + (end - first) / 2;
        if (scene->rotors[middle].node < node)
            first = middle + 1;
        else
            end = middle;
    }
    return first < scene->rotor_count && scene->rotors[first].node == node ? first : DMB_NONE;
}

static uint32_t row_of(const dmb_sim *sim, uint32_t rotor)
{
    return sim->scene->layout.row[sim->scene->rotors[rotor].node];
}

/* ---- One rotor --------------------------------------------------------------------------------------------------- */

void dmb_rotor_turning(const dmb_sim *sim, uint32_t rotor, const double dv[6], double change[6])
{
    dmb_ad_apply(sim->rotor_step[rotor].spin, dv, change);
}

void dmb_rotor_enter(const dmb_sim *sim, uint32_t rotor, const double v[6], double acceleration[6])
{
    double turning[6];
    dmb_rotor_turning(sim, rotor, v, turning);
    for (int i = 0; i < 6; i++) acceleration[i] += turning[i];
}

/* Velocity or acceleration at the start of the step in the axes reached by P(h); out may be v. */
static void carry(const dmb_sim *sim, uint32_t rotor, const double v[6], double out[6])
{
    const dmb_rotor_step *step = sim->rotor_step + rotor;
    double copy[6];
    dmb_vec6_copy(v, copy);
    dmb_adjoint_inverse_apply(step->R, step->x, copy, out);
}

/* (f; m) <- Ad(P)^T (f; m) = (R^T f; R^T (m - x x f)) */
void dmb_rotor_carry_wrench(const dmb_sim *sim, uint32_t rotor, double f[6])
{
    const dmb_rotor_step *step = sim->rotor_step + rotor;
    double m[3];
    dmb_vec3_cross(step->x, f, m);
    dmb_vec3_sub(f + 3, m, m);
    dmb_mat3_tvec(step->R, m, f + 3);
    dmb_vec3_copy(f, m);
    dmb_mat3_tvec(step->R, m, f);
}

void dmb_rotors_carry_wrenches(const dmb_sim *sim, double *rows)
{
    for (uint32_t i = 0; i < sim->scene->rotor_count; i++) dmb_rotor_carry_wrench(sim, i, rows + row_of(sim, i));
}

/* V + O first: v' = V' - ad(O) v needs the full velocity. */
void dmb_rotor_leave(const dmb_sim *sim, uint32_t rotor, double velocity[6], double acceleration[6],
                     double pseudo_acceleration[6])
{
    double turning[6];
    for (int i = 0; i < 6; i++) velocity[i] += sim->rotor_step[rotor].spin[i];
    dmb_rotor_turning(sim, rotor, velocity, turning);
    for (int i = 0; i < 6; i++) {
        acceleration[i] -= turning[i];
        pseudo_acceleration[i] -= turning[i];
    }
}

void dmb_rotor_add_travel(const dmb_sim *sim, uint32_t node, double z[6])
{
    const uint32_t rotor = dmb_rotor_on(sim->scene, node);
    if (rotor == DMB_NONE) return;
    for (int i = 0; i < 6; i++) z[i] += sim->rotor_step[rotor].length * sim->rotor_step[rotor].spin[i];
}

/* Of a node without a rotor the increment itself. */
double dmb_node_travel(const dmb_evaluation *evaluation, uint32_t node, uint32_t component)
{
    const dmb_sim *sim = evaluation->sim;
    double z[6];
    dmb_vec6_copy(sim->increment + sim->scene->layout.row[node], z);
    if (evaluation->step > 0.0) dmb_rotor_add_travel(sim, node, z);
    return z[component];
}

/* ---- A step ------------------------------------------------------------------------------------------------------ */

/* Computes O, P(h), and pose and motion of the start in the axes reached by P(h). W is the part of the spin along the
 * axis of the rotor; the rest of v is the slow precession. The order matters: V0' and A0 need ad(O) v of the full
 * velocity before it is carried, and pose and motion are carried by the same P(h). */
static void begin(const dmb_sim *sim, uint32_t rotor, double h)
{
    const dmb_scene_rotor *of = sim->scene->rotors + rotor;
    const uint32_t row = row_of(sim, rotor);
    const double *v = sim->now.velocity + row, spin = dmb_vec3_dot(of->twist + 3, v + 3);
    dmb_rotor_step *step = sim->rotor_step + rotor;
    double travel[6];
    step->length = h;
    for (int i = 0; i < 6; i++) {
        step->spin[i] = spin * of->twist[i];
        step->start[i] = v[i] - step->spin[i];
        travel[i] = h * step->spin[i];
    }
    dmb_vec6_copy(sim->now.acceleration + row, step->start + 6);
    dmb_vec6_copy(sim->now.pseudo_acceleration + row, step->start + 12);
    dmb_rotor_enter(sim, rotor, v, step->start + 6);
    dmb_rotor_enter(sim, rotor, v, step->start + 12);
    dmb_se3_exp(travel, NULL, step->R, step->x);
    for (int k = 0; k < 18; k += 6) carry(sim, rotor, step->start + k, step->start + k);
    dmb_vec3_copy(sim->now.displacement + 3 * (size_t)of->node, step->displacement);
    dmb_quat_copy(sim->now.quaternion + 4 * (size_t)of->node, step->quaternion);
    dmb_se3_advance(step->quaternion, step->displacement, travel);
}

void dmb_rotors_predict(dmb_sim *sim, const dmb_predict_args *args)
{
    for (uint32_t i = 0; i < sim->scene->rotor_count; i++) {
        const uint32_t row = row_of(sim, i);
        const double *start = sim->rotor_step[i].start;
        dmb_predict_args rows = *args;
        begin(sim, i, args->step);
        rows.count = 6;
        rows.now_velocity = start;
        rows.now_acceleration = start + 6;
        rows.now_pseudo_acceleration = start + 12;
        rows.velocity += row;
        rows.acceleration += row;
        rows.pseudo_acceleration += row;
        rows.increment += row;
        rows.change += row;
        sim->scene->kernels->predict(&rows);
        dmb_rotor_leave(sim, i, rows.velocity, rows.acceleration, rows.pseudo_acceleration);
    }
}

/* d v1' = (mass_factor I - velocity_factor ad(O)) dz: the first part is in the corrections of all rows already. */
void dmb_rotors_correct(dmb_sim *sim, const dmb_correct_args *args)
{
    for (uint32_t i = 0; i < sim->scene->rotor_count; i++) {
        const uint32_t row = row_of(sim, i);
        double turning[6];
        dmb_rotor_turning(sim, i, args->correction + row, turning);
        for (uint32_t k = 0; k < 6; k++) {
            args->acceleration[row + k] -= args->to_velocity * turning[k];
            args->pseudo_acceleration[row + k] -= args->to_velocity * turning[k];
        }
    }
}

/* Not H0 exp z as of other nodes: the travel h O has been applied to the start of the step. */
void dmb_rotors_place(dmb_sim *sim)
{
    for (uint32_t i = 0; i < sim->scene->rotor_count; i++) {
        const size_t node = sim->scene->rotors[i].node;
        double *x = sim->trial.displacement + 3 * node, *q = sim->trial.quaternion + 4 * node;
        dmb_vec3_copy(sim->rotor_step[i].displacement, x);
        dmb_quat_copy(sim->rotor_step[i].quaternion, q);
        dmb_se3_advance(q, x, sim->increment + row_of(sim, i));
    }
}

/* The revolution of the angle is that of the increment and the travel h O of the spin. */
void dmb_rotors_unwrap(dmb_sim *sim)
{
    for (uint32_t i = 0; i < sim->scene->rotor_count; i++) {
        const uint32_t node = sim->scene->rotors[i].node;
        const double *reference = sim->scene->reference_quaternion + 4 * (size_t)node;
        double q[4], z[6];
        dmb_vec6_copy(sim->increment + row_of(sim, i), z);
        dmb_rotor_add_travel(sim, node, z);
        dmb_quat_between(reference, sim->trial.quaternion + 4 * (size_t)node, q);
        sim->trial.turn[node] = dmb_quat_twist(q, sim->now.turn[node] + z[3]);
    }
}

void dmb_rotors_follow(dmb_sim *sim, const double *from)
{
    for (uint32_t i = 0; i < sim->scene->rotor_count; i++) {
        const uint32_t row = row_of(sim, i);
        double moved[6], turning[6];
        for (uint32_t k = 0; k < 6; k++) moved[k] = sim->trial.velocity[row + k] - from[row + k];
        dmb_rotor_turning(sim, i, moved, turning);
        for (uint32_t k = 0; k < 6; k++) {
            sim->trial.acceleration[row + k] -= turning[k];
            sim->trial.pseudo_acceleration[row + k] -= turning[k];
        }
    }
}

/* ---- Tangent ----------------------------------------------------------------------------------------------------- */

/* Column k of -factor M ad(O) is -factor M times ad(O) of the unit vector k. */
void dmb_rotors_matrix(const dmb_evaluation *evaluation)
{
    const dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0; i < scene->rotor_count; i++) {
        const dmb_scene_rotor *rotor = scene->rotors + i;
        double *block = sim->inertia_diagonal + scene->layout.diag[rotor->node];
        for (int k = 0; k < 6; k++) {
            double unit[6] = {0.0}, turning[6], p[6], added[6] = {0.0};
            unit[k] = 1.0;
            dmb_rotor_turning(sim, i, unit, turning);
            dmb_rigid_mass_times(scene->rigid_masses + rotor->rigid_mass, turning, p);
            if (rotor->added_mass != DMB_NONE)
                dmb_added_mass_times(scene->added_masses + rotor->added_mass, turning, added);
            for (int r = 0; r < 6; r++) block[6 * r + k] -= evaluation->velocity_factor * (p[r] + added[r]);
        }
    }
}
