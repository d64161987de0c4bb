/* Flexible elements: internal and inertia forces, stiffness and inertia tangent, element by element in chain order. */
#include <string.h>

#include "element/beam.h"
#include "system/evaluation.h"
#include "system/node.h"

/* One element's ends as its kernel sees them. */
typedef struct element_ends {
    double va[6], vb[6]; /* velocity at the ends */
    double fa[6], fb[6]; /* force on the residual side, at the ends, then at the nodes */
    double scale_a[6], scale_b[6];
    double reach; /* [m] size of the numbers that the span is the difference of */
} element_ends;

static void add_scaled(const double force[6], double scale[6])
{
    for (int i = 0; i < 6; i++) scale[i] += fabs(force[i]);
}

/* Elastic and damping stress, their power, and the stress for the geometric stiffness. */
static void internal_force(dmb_evaluation *evaluation, uint32_t e, const dmb_element_type *type,
                           const dmb_beam_shape *shape, element_ends *ends)
{
    dmb_sim *sim = evaluation->sim;
    double stress[6], rate[6];
    dmb_beam_stress(type, shape->d, stress);
    dmb_vec6_copy(shape->d, sim->element_strain + 6 * e);
    evaluation->rounding += type->stiffness[0] * type->stiffness[0] * ends->reach * ends->reach;
    if (evaluation->dynamic && (sim->options.energy_ledger || type->damping_time != 0.0)) {
        dmb_beam_strain_rate(shape, ends->va, ends->vb, rate);
        evaluation->power[DMB_POWER_POTENTIAL] -= dmb_vec6_dot(stress, rate);
        for (int i = 0; type->damping_time != 0.0 && i < 6; i++) {
            const double viscous = type->damping_time * type->stiffness[i] * rate[i];
            evaluation->power[DMB_POWER_DAMPING] -= viscous * rate[i];
            stress[i] += viscous;
        }
    }
    if (!evaluation->extrapolated) dmb_vec6_copy(stress, sim->element_stress + 6 * e); /* the viscous part too */
    dmb_beam_add_force(shape, stress, ends->fa, ends->fb);
    add_scaled(ends->fa, ends->scale_a);
    add_scaled(ends->fb, ends->scale_b);
}

/* f = M v' - v^^T p at both ends; the gyroscopic part does no work. */
static void inertia_force(dmb_evaluation *evaluation, const dmb_element_type *type, const double acc_a[6],
                          const double acc_b[6], const double pa[6], const double pb[6], element_ends *ends)
{
    double fa[6], fb[6], ga[6], gb[6];
    dmb_beam_mass_times(&type->mass, acc_a, acc_b, fa, fb);
    evaluation->power[DMB_POWER_INERTIA] -= dmb_vec6_dot(ends->va, fa) + dmb_vec6_dot(ends->vb, fb);
    dmb_ad_transpose(ends->va, pa, ga);
    dmb_ad_transpose(ends->vb, pb, gb);
    for (int i = 0; i < 6; i++) {
        fa[i] -= ga[i];
        fb[i] -= gb[i];
        ends->fa[i] += fa[i];
        ends->fb[i] += fb[i];
    }
    add_scaled(fa, ends->scale_a);
    add_scaled(fb, ends->scale_b);
}

/* Velocities and accelerations of the nodes, carried to the element's ends. */
static void end_motion(const dmb_element_type *type, const double *rows_a, const double *rows_b, double a[6],
                       double b[6])
{
    dmb_vec6_copy(rows_a, a);
    dmb_vec6_copy(rows_b, b);
    dmb_arm_velocity(type->arm[0], a);
    dmb_arm_velocity(-type->arm[1], b);
}

static void add_matrix(const double *restrict block, double *restrict out)
{
    for (int i = 0; i < 36; i++) out[i] += block[i];
}

typedef struct element_tangent {
    dmb_beam_blocks stiffness, inertia;
} element_tangent;

static void tangent(const dmb_evaluation *evaluation, uint32_t e, const dmb_element_type *type,
                    const dmb_beam_shape *shape, const element_ends *ends, const double pa[6], const double pb[6],
                    element_tangent *out)
{
    dmb_beam_stiffness(type, shape, evaluation->sim->element_stress + 6 * e, &out->stiffness);
    if (!evaluation->dynamic) return;
    if (type->damping_time != 0.0)
        dmb_beam_damping(type, shape, ends->va, ends->vb, evaluation->velocity_factor, &out->stiffness, &out->inertia);
    else
        memset(&out->inertia, 0, sizeof out->inertia);
    dmb_beam_add_inertia_tangent(&type->mass, ends->va, ends->vb, pa, pb, evaluation->mass_factor,
                                 evaluation->velocity_factor, &out->inertia);
}

static void blocks_to_nodes(const dmb_evaluation *evaluation, const dmb_element_type *type, element_tangent *t)
{
    if (type->arm[0] == 0.0 && type->arm[1] == 0.0) return;
    dmb_beam_blocks_to_nodes(type->arm, &t->stiffness);
    if (evaluation->dynamic) dmb_beam_blocks_to_nodes(type->arm, &t->inertia);
}

/* Everything of one beam, its ends' poses and motion given: forces at the nodes in ends, tangent blocks in out. */
static int32_t beam(dmb_evaluation *evaluation, uint32_t e, const double *qa, const double *Ra, const double *qb,
                    const double span[3], double reach, const double *velocity_a, const double *velocity_b,
                    const double *acc_a, const double *acc_b, element_ends *ends, element_tangent *out)
{
    const dmb_element_type *type = evaluation->sim->scene->types + evaluation->sim->scene->element_type[e];
    dmb_beam_shape shape;
    double aa[6], ab[6], pa[6], pb[6];
    memset(ends, 0, sizeof *ends);
    ends->reach = reach;
    if (dmb_beam_deform(type, qa, Ra, qb, span, &shape) < 0) return DMB_ERR_ROTATION;
    if (evaluation->dynamic) end_motion(type, velocity_a, velocity_b, ends->va, ends->vb);
    internal_force(evaluation, e, type, &shape, ends);
    if (evaluation->dynamic) {
        end_motion(type, acc_a, acc_b, aa, ab);
        dmb_beam_mass_times(&type->mass, ends->va, ends->vb, pa, pb);
        inertia_force(evaluation, type, aa, ab, pa, pb, ends);
    }
    if (evaluation->tangent) {
        tangent(evaluation, e, type, &shape, ends, pa, pb, out);
        blocks_to_nodes(evaluation, type, out);
    }
    dmb_arm_wrench(type->arm[0], ends->fa);
    dmb_arm_wrench(-type->arm[1], ends->fb);
    return DMB_OK;
}

/* Vector from node a to node b; returns the largest magnitude that entered it. */
static double span_of(const dmb_scene *scene, uint32_t e, const double *ua, const double *ub, double span[3])
{
    double reach = 0.0;
    for (int i = 0; i < 3; i++) {
        span[i] = scene->element_span[3 * e + (uint32_t)i] + (ub[i] - ua[i]);
        reach = fmax(reach, fabs(ua[i]) + fabs(ub[i]) + fabs(span[i]));
    }
    return reach;
}

static int32_t gather_beam(dmb_evaluation *evaluation, uint32_t e)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    const dmb_configuration *trial = &sim->trial;
    const uint32_t a = scene->element_node[e], b = a + 1, ra = scene->layout.row[a], rb = scene->layout.row[b];
    element_ends ends;
    element_tangent t;
    double span[3];
    const double reach = span_of(scene, e, trial->displacement + 3 * a, trial->displacement + 3 * b, span);
    const int32_t status =
        beam(evaluation, e, trial->quaternion + 4 * a, sim->rotation + 9 * a, trial->quaternion + 4 * b, span, reach,
             trial->velocity + ra, trial->velocity + rb, trial->acceleration + ra, trial->acceleration + rb, &ends, &t);
    if (status < 0) return status;
    for (uint32_t i = 0; i < 6; i++) {
        sim->correction[ra + i] += ends.fa[i];
        sim->correction[rb + i] += ends.fb[i];
        sim->scale_row[ra + i] += ends.scale_a[i];
        sim->scale_row[rb + i] += ends.scale_b[i];
    }
    if (!evaluation->tangent) return DMB_OK;
    add_matrix(t.stiffness.aa, dmb_stiffness_of(sim, a));
    add_matrix(t.stiffness.bb, dmb_stiffness_of(sim, b));
    memcpy(sim->stiffness_upper + scene->layout.link[a], t.stiffness.ab, sizeof t.stiffness.ab);
    memcpy(sim->stiffness_lower + scene->layout.link[a], t.stiffness.ba, sizeof t.stiffness.ba);
    if (!evaluation->dynamic) return DMB_OK;
    add_matrix(t.inertia.aa, dmb_inertia_of(sim, a));
    add_matrix(t.inertia.bb, dmb_inertia_of(sim, b));
    memcpy(sim->inertia_upper + scene->layout.link[a], t.inertia.ab, sizeof t.inertia.ab);
    memcpy(sim->inertia_lower + scene->layout.link[a], t.inertia.ba, sizeof t.inertia.ba);
    return DMB_OK;
}

/* ---- Axial-torsional bar on the hole's axis: two PATH nodes ---------------------------------------------------- */

static void gather_path(dmb_evaluation *evaluation, uint32_t e)
{
    static const int component[2] = {0, 3};
    dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    const dmb_configuration *trial = &sim->trial;
    const dmb_element_type *type = scene->types + scene->element_type[e];
    const uint32_t a = scene->element_node[e], b = a + 1, ra = scene->layout.row[a], rb = scene->layout.row[b];
    const double change[2] = {trial->displacement[3 * b] - trial->displacement[3 * a], trial->turn[b] - trial->turn[a]};
    const double start[2] = {type->length, 0.0}; /* the length is left out of differences, which keeps their digits */
    const double reach[2] = {fabs(trial->displacement[3 * a]) + fabs(trial->displacement[3 * b]),
                             (fabs(trial->turn[a]) + fabs(trial->turn[b])) / scene->length_scale};
    const double *mass[2] = {type->mass.axial, type->mass.torsion};
    for (uint32_t c = 0; c < 2; c++) {
        const int k = component[c];
        evaluation->rounding += type->stiffness[k] * reach[c] * (type->stiffness[k] * reach[c]);
        const double stiffness = type->stiffness[k], elastic = stiffness * (change[c] + (start[c] - type->rest[k]));
        const double *v = trial->velocity, *dv = trial->acceleration;
        const double rate = evaluation->dynamic ? v[rb + c] - v[ra + c] : 0.0;
        const double viscous = stiffness * type->damping_time * rate, force = elastic + viscous;
        double fa = -force, fb = force, mass_a = 0.0, mass_b = 0.0;
        sim->element_strain[6 * e + (uint32_t)k] = start[c] + change[c];
        evaluation->power[DMB_POWER_POTENTIAL] -= elastic * rate;
        evaluation->power[DMB_POWER_DAMPING] -= viscous * rate;
        if (evaluation->dynamic) {
            mass_a = mass[c][0] * dv[ra + c] + mass[c][1] * dv[rb + c];
            mass_b = mass[c][1] * dv[ra + c] + mass[c][0] * dv[rb + c];
            evaluation->power[DMB_POWER_INERTIA] -= v[ra + c] * mass_a + v[rb + c] * mass_b;
        }
        sim->correction[ra + c] += fa + mass_a;
        sim->correction[rb + c] += fb + mass_b;
        sim->scale_row[ra + c] += fabs(force) + fabs(mass_a);
        sim->scale_row[rb + c] += fabs(force) + fabs(mass_b);
        if (!evaluation->tangent) continue;
        const double damped = stiffness * (1.0 + evaluation->velocity_factor * type->damping_time);
        const double k_dyn = evaluation->dynamic ? damped : stiffness;
        dmb_stiffness_of(sim, a)[3 * c] += k_dyn;
        dmb_stiffness_of(sim, b)[3 * c] += k_dyn;
        sim->stiffness_upper[scene->layout.link[a] + 3 * c] -= k_dyn;
        sim->stiffness_lower[scene->layout.link[a] + 3 * c] -= k_dyn;
        if (!evaluation->dynamic) continue;
        dmb_inertia_of(sim, a)[3 * c] += evaluation->mass_factor * mass[c][0];
        dmb_inertia_of(sim, b)[3 * c] += evaluation->mass_factor * mass[c][0];
        sim->inertia_upper[scene->layout.link[a] + 3 * c] += evaluation->mass_factor * mass[c][1];
        sim->inertia_lower[scene->layout.link[a] + 3 * c] += evaluation->mass_factor * mass[c][1];
    }
}

/* ---- A beam with one FULL and one PATH node: the PATH side is seen through its two columns ---------------------- */

typedef struct mixed_side {
    double q[4], R[9], u[3], v[6], a[6];
    double J[36]; /* (6, rows) row-major with `rows` columns used */
    uint32_t rows;
} mixed_side;

static void mixed_side_of(const dmb_evaluation *evaluation, uint32_t node, mixed_side *side)
{
    const dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    side->rows = scene->layout.size[node];
    dmb_node_pose(scene, &sim->trial, node, side->R, side->u);
    dmb_node_vector(scene, &sim->trial, node, sim->trial.velocity, side->v);
    dmb_node_vector(scene, &sim->trial, node, sim->trial.acceleration, side->a);
    memset(side->J, 0, sizeof side->J);
    if (side->rows == DMB_NODE_FULL) {
        dmb_vec3_copy(side->u, side->u);
        memcpy(side->q, sim->trial.quaternion + 4 * node, sizeof side->q);
        for (int i = 0; i < 36; i += 7) side->J[i] = 1.0;
        return;
    }
    double columns[12];
    dmb_quat_from_matrix(side->R, side->q);
    dmb_path_columns(scene, &sim->trial, node, side->R, columns);
    for (uint32_t i = 0; i < 6; i++) {
        side->J[2 * i] = columns[i];
        side->J[2 * i + 1] = columns[6 + i];
    }
}

/* out += J_left^T K J_right */
static void add_projected(const double K[36], const mixed_side *left, const mixed_side *right, double *out)
{
    for (uint32_t r = 0; r < left->rows; r++)
        for (uint32_t c = 0; c < right->rows; c++) {
            double sum = 0.0;
            for (uint32_t i = 0; i < 6; i++)
                for (uint32_t j = 0; j < 6; j++)
                    sum += left->J[left->rows * i + r] * K[6 * i + j] * right->J[right->rows * j + c];
            out[right->rows * r + c] += sum;
        }
}

static void add_projected_force(dmb_sim *sim, uint32_t node, const mixed_side *side, const double f[6],
                                const double scale[6])
{
    const uint32_t row = sim->scene->layout.row[node];
    for (uint32_t r = 0; r < side->rows; r++)
        for (uint32_t i = 0; i < 6; i++) {
            sim->correction[row + r] += side->J[side->rows * i + r] * f[i];
            sim->scale_row[row + r] += fabs(side->J[side->rows * i + r]) * scale[i];
        }
}

static int32_t gather_mixed(dmb_evaluation *evaluation, uint32_t e)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    const uint32_t a = scene->element_node[e], b = a + 1, link = scene->layout.link[a];
    mixed_side A, B;
    element_ends ends;
    element_tangent t;
    double span[3];
    mixed_side_of(evaluation, a, &A);
    mixed_side_of(evaluation, b, &B);
    const double reach = span_of(scene, e, A.u, B.u, span);
    const int32_t status = beam(evaluation, e, A.q, A.R, B.q, span, reach, A.v, B.v, A.a, B.a, &ends, &t);
    if (status < 0) return status;
    add_projected_force(sim, a, &A, ends.fa, ends.scale_a);
    add_projected_force(sim, b, &B, ends.fb, ends.scale_b);
    if (!evaluation->tangent) return DMB_OK;
    add_projected(t.stiffness.aa, &A, &A, dmb_stiffness_of(sim, a));
    add_projected(t.stiffness.bb, &B, &B, dmb_stiffness_of(sim, b));
    add_projected(t.stiffness.ab, &A, &B, sim->stiffness_upper + link);
    add_projected(t.stiffness.ba, &B, &A, sim->stiffness_lower + link);
    if (!evaluation->dynamic) return DMB_OK;
    add_projected(t.inertia.aa, &A, &A, dmb_inertia_of(sim, a));
    add_projected(t.inertia.bb, &B, &B, dmb_inertia_of(sim, b));
    add_projected(t.inertia.ab, &A, &B, sim->inertia_upper + link);
    add_projected(t.inertia.ba, &B, &A, sim->inertia_lower + link);
    return DMB_OK;
}

static int32_t gather_batch(dmb_evaluation *evaluation, const dmb_batch *batch)
{
    for (uint32_t e = batch->first; e < batch->first + batch->count; e++) {
        int32_t status = DMB_OK;
        if (batch->kernel == DMB_KERNEL_BEAM)
            status = gather_beam(evaluation, e);
        else if (batch->kernel == DMB_KERNEL_PATH)
            gather_path(evaluation, e);
        else
            status = gather_mixed(evaluation, e);
        if (status < 0) {
            evaluation->element = e;
            return status;
        }
    }
    return DMB_OK;
}

void dmb_gather_elements(dmb_evaluation *evaluation)
{
    const dmb_scene *scene = evaluation->sim->scene;
    for (uint32_t i = 0; i < scene->batch_count && evaluation->status >= 0; i++)
        evaluation->status = gather_batch(evaluation, scene->batches + i);
}

/* s <- s + (K/L) P z over the correction z of both nodes, at the strain of the last evaluation. */
void dmb_system_extrapolate_stress(dmb_sim *sim, const double *correction)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t e = 0; e < scene->element_count; e++) {
        const uint32_t a = scene->element_node[e];
        if (scene->layout.size[a] != DMB_NODE_FULL || scene->layout.size[a + 1] != DMB_NODE_FULL) continue;
        const dmb_element_type *type = scene->types + scene->element_type[e];
        dmb_beam_shape shape;
        double za[6], zb[6], dd[6], stress[6];
        dmb_vec6_copy(sim->element_strain + 6 * e, shape.d);
        dmb_so3_inverse_coefficients_at(dmb_vec3_norm_squared(shape.d + 3), &shape.k);
        dmb_se3_inverse_tangent_at(shape.d, &shape.k, &shape.T);
        end_motion(type, correction + scene->layout.row[a], correction + scene->layout.row[a + 1], za, zb);
        dmb_beam_strain_rate(&shape, za, zb, dd);
        dmb_beam_stress(type, shape.d, stress);
        for (uint32_t i = 0; i < 6; i++) sim->element_stress[6 * e + i] = stress[i] + type->stiffness[i] * dd[i];
    }
}
