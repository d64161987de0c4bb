/* Flexible elements: internal and inertia forces, stiffness and inertia tangent, element by element in the order of the
 * chain.
 *
 *     batch             elements between                  method
 *     ---------------   -------------------------------   ------------------------------------------------------------
 *     BEAM              two six-DOF nodes                 SE(3) element in lanes, long runs in chunks
 *     AXIAL_TORSIONAL   two axial-torsional nodes         stretch and twist along the hole's axis (eq:bar.force)
 *     mixed             one of each                       SE(3) element, one side projected on two columns
 *
 * The number of chunks depends on the number of elements alone, and their sums are added in their order: results do not
 * depend on the number of threads. */
#include "system/assemble/assemble.h"

#include <string.h>

#include "base/build.h"
#include "element/beam_element.h"
#include "kernel/kernels.h"
#include "sim/chunks.h"
#include "sim/node.h"
#include "system/assemble/evaluation.h"

/* Vector from node a to node b; returns the largest magnitude of its terms (for rounding). */
static double span_of(const dmb_scene *scene, uint32_t e, const double *ua, const double *ub, double span[3])
{
    double reach = 0.0;
    for (int i = 0; i < 3; i++) {
        span[i] = scene->element_span[3 * e + (uint32_t)i] + (ub[i] - ua[i]);
        reach = fmax(reach, fabs(ua[i]) + fabs(ub[i]) + fabs(span[i]));
    }
    return reach;
}

/* Inputs and outputs of the kernels for a batch, whose nodes, rows and blocks are consecutive. */
static dmb_beam_args args_of(const dmb_sim *sim, const dmb_batch *batch)
{
    const dmb_scene *scene = sim->scene;
    const uint32_t e = batch->first, a = scene->element_node[e], row = scene->layout.row[a];
    const uint32_t diag = scene->layout.diag[a], link = scene->layout.link[a];
    const dmb_beam_args args = {
        .count = batch->count,
        .types = scene->types,
        .type = scene->element_type + e,
        .span = scene->element_span + 3 * e,
        .displacement = sim->trial.displacement + 3 * a,
        .quaternion = sim->trial.quaternion + 4 * a,
        .velocity = sim->trial.velocity + row,
        .acceleration = sim->trial.acceleration + row,
        .increment = sim->increment + row,
        .damped = scene->damped,
        .arms = scene->arms,
        .curved = batch->curved,
        .residual = sim->residual + row,
        .scale = sim->scale_row + row,
        .strain = sim->element_strain + 6 * e,
        .stress = sim->element_stress + 6 * e,
        .stiffness_diagonal = sim->stiffness_diagonal + diag,
        .inertia_diagonal = sim->inertia_diagonal + diag,
        .upper = sim->stiffness_upper + link,
        .lower = sim->stiffness_lower + link,
    };
    return args;
}

/* 1: the strain of the elements is stored, because contact along elements or a correction with fresh factors needs it;
 * reused factors are followed by an evaluation with tangent first. */
static int strain_is_kept(const dmb_evaluation *evaluation)
{
    const dmb_sim *sim = evaluation->sim;
    return evaluation->tangent || *sim->factors != DMB_FACTORS_REUSED || sim->scene->inside_count > 0 ||
           sim->scene->axial_torsional_site_count > 0;
}

/* Forces and tangents of the SE(3) elements of a batch, or of a chunk of one, in lanes (element/beam_element.h). */
static dmb_beam_args task_of(const dmb_evaluation *evaluation, const dmb_batch *batch)
{
    dmb_beam_args args = args_of(evaluation->sim, batch);
    args.gravity = evaluation->gravity;
    if (!strain_is_kept(evaluation)) args.strain = NULL;
    args.mass_factor = evaluation->mass_factor;
    args.velocity_factor = evaluation->velocity_factor;
    args.dynamic = evaluation->dynamic;
    args.tangent = evaluation->tangent;
    args.extrapolated = evaluation->extrapolated;
    args.inertia_only = evaluation->inertia_only;
    args.ledger = evaluation->sim->options.energy_ledger;
    return args;
}

/* A batch computed in chunks. */
typedef struct beam_chunks {
    const dmb_evaluation *evaluation;
    const dmb_batch *batch;
    uint32_t pieces, reserved;
} beam_chunks;

static dmb_batch piece_of(const beam_chunks *in, uint32_t piece)
{
    const uint32_t count = in->batch->count, begin = dmb_chunk_begin(count, in->pieces, piece);
    dmb_batch out = *in->batch;
    out.first += begin;
    out.count = dmb_chunk_begin(count, in->pieces, piece + 1) - begin;
    return out;
}

/* The node between two chunks: the second chunk writes its own contribution, the first stores its contribution in the
 * seam. A node between two chunks has contributions from both. They are added afterwards (add_seam), so that no two
 * threads write the same row. */
static void make_pieces(void *work, uint32_t first, uint32_t end)
{
    const beam_chunks *in = work;
    const dmb_sim *sim = in->evaluation->sim;
    for (uint32_t i = first; i < end; i++) {
        const dmb_batch piece = piece_of(in, i);
        dmb_beam_args args = task_of(in->evaluation, &piece);
        args.apart = i > 0;
        args.seam = i + 1 < in->pieces ? sim->seam + i : NULL;
        if (args.seam != NULL) memset(args.seam, 0, sizeof *args.seam);
        const int32_t bad = sim->scene->kernels->beams(&args);
        const dmb_chunk_sums sums = {.rounding = args.rounding,
                                     .potential = args.potential,
                                     .damping = args.damping,
                                     .inertia = args.inertia,
                                     .failed = bad < 0 ? piece.first + args.failed : DMB_NONE};
        sim->chunk_sums[i] = sums;
    }
}

static void add_numbers(uint32_t count, const double *from, double *to)
{
    for (uint32_t i = 0; i < count; i++) to[i] += from[i];
}

/* Adds the contribution of the element before a node from the seam. */
static void add_seam(const dmb_evaluation *evaluation, const dmb_seam *seam, uint32_t node)
{
    dmb_sim *sim = evaluation->sim;
    const uint32_t row = sim->scene->layout.row[node];
    add_numbers(6, seam->residual, sim->residual + row);
    add_numbers(6, seam->scale, sim->scale_row + row);
    if (!evaluation->tangent) return;
    if (!evaluation->inertia_only) add_numbers(36, seam->stiffness, dmb_stiffness_of(sim, node));
    if (evaluation->dynamic) add_numbers(36, seam->inertia, dmb_inertia_of(sim, node));
}

static int32_t assemble_chunks(dmb_evaluation *evaluation, const dmb_batch *batch)
{
    const dmb_sim *sim = evaluation->sim;
    beam_chunks in = {evaluation, batch, dmb_chunks_of(batch->count), 0};
    dmb_chunks_run(sim, in.pieces, 1, make_pieces, &in);
    for (uint32_t i = 0; i < in.pieces; i++) {
        const dmb_chunk_sums *sums = sim->chunk_sums + i;
        if (sums->failed != DMB_NONE) {
            evaluation->element = sums->failed;
            return DMB_ERR_ROTATION;
        }
        if (i > 0) add_seam(evaluation, sim->seam + i - 1, sim->scene->element_node[piece_of(&in, i).first]);
        evaluation->rounding += sums->rounding;
        evaluation->power[DMB_POWER_POTENTIAL] += sums->potential;
        evaluation->power[DMB_POWER_DAMPING] += sums->damping;
        evaluation->power[DMB_POWER_INERTIA] += sums->inertia;
    }
    return DMB_OK;
}

/* Powers are added to those of the evaluation. */
static int32_t assemble_beams(dmb_evaluation *evaluation, const dmb_batch *batch)
{
    if (dmb_chunks_of(batch->count) > 1) return assemble_chunks(evaluation, batch);
    dmb_beam_args args = task_of(evaluation, batch);
    args.rounding = evaluation->rounding;
    args.potential = evaluation->power[DMB_POWER_POTENTIAL];
    args.damping = evaluation->power[DMB_POWER_DAMPING];
    args.inertia = evaluation->power[DMB_POWER_INERTIA];
    if (evaluation->sim->scene->kernels->beams(&args) < 0) {
        evaluation->element = batch->first + args.failed;
        return DMB_ERR_ROTATION;
    }
    evaluation->rounding = args.rounding;
    evaluation->power[DMB_POWER_POTENTIAL] = args.potential;
    evaluation->power[DMB_POWER_DAMPING] = args.damping;
    evaluation->power[DMB_POWER_INERTIA] = args.inertia;
    return DMB_OK;
}

/* ---- Axial-torsional elements ------------------------------------------------------------------------------------ */

/* Axial-torsional elements: K/L (e + tau e') and M v' along and about the axis, e = u_b - u_a + (L - L0), by lanes
 * (kernel/lanes_axial_torsional.h). */
static void axial_torsional_forces(dmb_evaluation *evaluation, const dmb_batch *batch)
{
    const dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    const uint32_t e = batch->first, a = scene->element_node[e], row = scene->layout.row[a];
    dmb_axial_torsional_args args = {
        .count = batch->count,
        .dynamic = evaluation->dynamic,
        .types = scene->types,
        .type = scene->element_type + e,
        .displacement = sim->trial.displacement + 3 * a,
        .turn = sim->trial.turn + a,
        .velocity = sim->trial.velocity + row,
        .acceleration = sim->trial.acceleration + row,
        .per_length = 1.0 / scene->length_scale,
        .residual = sim->residual + row,
        .scale = sim->scale_row + row,
        .rounding = evaluation->rounding,
        .potential = evaluation->power[DMB_POWER_POTENTIAL],
        .damping = evaluation->power[DMB_POWER_DAMPING],
        .inertia = evaluation->power[DMB_POWER_INERTIA],
    };
    scene->kernels->axial_torsional_elements(&args);
    evaluation->rounding = args.rounding;
    evaluation->power[DMB_POWER_POTENTIAL] = args.potential;
    evaluation->power[DMB_POWER_DAMPING] = args.damping;
    evaluation->power[DMB_POWER_INERTIA] = args.inertia;
}

/* Tangent of one coordinate, 0 stretch or 1 twist, between the nodes a and a + 1. Mass, stiffness and damping are 2 x 2
 * matrices of each coordinate. Blocks off the diagonal hold their sum, blocks on the diagonal stiffness and the other
 * two apart, as all blocks of nodes do until the iteration matrix is made. */
static void axial_torsional_tangent(const dmb_evaluation *evaluation, const dmb_element_type *type, uint32_t a,
                                    uint32_t c)
{
    dmb_sim *sim = evaluation->sim;
    const uint32_t link = sim->scene->layout.link[a] + 3 * c;
    const double *mass = c == 0 ? type->mass.axial : type->mass.torsion;
    const double elastic = evaluation->inertia_only ? 0.0 : type->stiffness[3 * c];
    const double damped =
        evaluation->dynamic ? evaluation->velocity_factor * type->damping_time * type->stiffness[3 * c] : 0.0;
    const double heavy = evaluation->dynamic ? evaluation->mass_factor : 0.0;
    const double between = heavy * mass[1] - (elastic + damped);
    dmb_stiffness_of(sim, a)[3 * c] += elastic;
    dmb_stiffness_of(sim, a + 1)[3 * c] += elastic;
    sim->stiffness_upper[link] += between;
    sim->stiffness_lower[link] += between;
    if (!evaluation->dynamic) return;
    dmb_inertia_of(sim, a)[3 * c] += heavy * mass[0] + damped;
    dmb_inertia_of(sim, a + 1)[3 * c] += heavy * mass[0] + damped;
}

static void assemble_axial_torsional_elements(dmb_evaluation *evaluation, const dmb_batch *batch)
{
    const dmb_scene *scene = evaluation->sim->scene;
    axial_torsional_forces(evaluation, batch);
    if (!evaluation->tangent) return;
    for (uint32_t e = batch->first; e < batch->first + batch->count; e++)
        for (uint32_t c = 0; c < 2; c++)
            axial_torsional_tangent(evaluation, scene->types + scene->element_type[e], scene->element_node[e], c);
}

/* ---- Mixed elements ---------------------------------------------------------------------------------------------- */

typedef struct mixed_side {
    double q[4], R[9], u[3], v[6], a[6];
    /* increment of the step; 0 on the axial-torsional side, whose two columns are pose parameters already */
    double z[6];
    double J[36]; /* (6, rows) row-major with `rows` columns used */
    uint32_t rows;
} mixed_side;

/* Both kinds of node as a side of a beam: pose, twist and acceleration in body axes, and the columns J (6, rows) that
 * take rows to twists; of a six-DOF node the identity. */
static void mixed_side_of(const dmb_evaluation *evaluation, uint32_t node, mixed_side *side)
{
    const dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    side->rows = scene->layout.size[node];
    dmb_node_pose(scene, &sim->trial, node, side->R, side->u);
    dmb_node_vector(scene, &sim->trial, node, sim->trial.velocity, side->v);
    dmb_node_vector(scene, &sim->trial, node, sim->trial.acceleration, side->a);
    memset(side->J, 0, sizeof side->J);
    memset(side->z, 0, sizeof side->z);
    if (side->rows == DMB_NODE_SIX_DOF) {
        memcpy(side->q, sim->trial.quaternion + 4 * node, sizeof side->q);
        dmb_vec6_copy(sim->increment + scene->layout.row[node], side->z);
        for (int i = 0; i < 36; i += 7) side->J[i] = 1.0;
        return;
    }
    double columns[12];
    dmb_quat_from_matrix(side->R, side->q);
    dmb_axial_torsional_columns(scene, &sim->trial, node, side->R, columns);
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
            sim->residual[row + r] += side->J[side->rows * i + r] * f[i];
            sim->scale_row[row + r] += fabs(side->J[side->rows * i + r]) * scale[i];
        }
}

/* Tangent of J^T f by the change of J: along an arc J is constant in the axes of the node; their rotation about the
 * axis turns its bend c back, dc = -e_x x c. */
static void add_turning_bend(dmb_sim *sim, uint32_t node, const mixed_side *side, const double f[6])
{
    if (side->rows == DMB_NODE_SIX_DOF) return;
    dmb_stiffness_of(sim, node)[1] += side->J[2 * 5] * f[4] - side->J[2 * 4] * f[5];
}

static void mixed_input(const dmb_scene *scene, uint32_t e, const mixed_side *A, const mixed_side *B,
                        dmb_beam_input *in)
{
    dmb_quat_copy(A->q, in->qa);
    dmb_quat_copy(B->q, in->qb);
    dmb_mat3_copy(A->R, in->Ra);
    in->reach = span_of(scene, e, A->u, B->u, in->span);
    dmb_vec6_copy(A->v, in->va);
    dmb_vec6_copy(B->v, in->vb);
    dmb_vec6_copy(A->a, in->aa);
    dmb_vec6_copy(B->a, in->ab);
    dmb_vec6_copy(A->z, in->za);
    dmb_vec6_copy(B->z, in->zb);
}

/* Mixed element (one six-DOF and one axial-torsional node): a beam between two poses; its forces and tangents are
 * projected to the axial-torsional side as J^T f and J^T K J, J its two columns. J (6, 2) maps the speeds along and
 * about the hole's axis to the body-frame velocity of the node (eq:kinematics.path-velocity). */
DMB_OWN_FRAME static int32_t assemble_mixed(dmb_evaluation *evaluation, uint32_t e)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    const uint32_t a = scene->element_node[e], b = a + 1, link = scene->layout.link[a];
    mixed_side A, B;
    const dmb_element_type *type = scene->types + scene->element_type[e];
    const dmb_beam_task task = {evaluation->mass_factor,
                                evaluation->velocity_factor,
                                evaluation->dynamic,
                                evaluation->tangent,
                                evaluation->extrapolated,
                                evaluation->dynamic && (sim->options.energy_ledger || scene->damped),
                                scene->damped,
                                evaluation->inertia_only,
                                scene->arms,
                                dmb_element_is_curved(type),
                                evaluation->gravity};
    dmb_beam_constants constants;
    dmb_curved_constants curved = {.mass = 0.0};
    dmb_beam_input in;
    dmb_beam_output out;
    mixed_side_of(evaluation, a, &A);
    mixed_side_of(evaluation, b, &B);
    mixed_input(scene, e, &A, &B, &in);
    dmb_beam_load_constants(type, 0, &constants);
    if (task.curved) dmb_curved_load(type, 0, &curved);
    if (task.extrapolated) dmb_vec6_copy(sim->element_stress + 6 * e, out.stress);
    if (dmb_beam_element(&task, &constants, &curved, &in, &out) < 0) {
        evaluation->element = e;
        return DMB_ERR_ROTATION;
    }
    dmb_vec6_copy(out.strain, sim->element_strain + 6 * e);
    if (!task.extrapolated) dmb_vec6_copy(out.stress, sim->element_stress + 6 * e);
    evaluation->rounding += out.rounding;
    evaluation->power[DMB_POWER_POTENTIAL] -= out.potential;
    evaluation->power[DMB_POWER_DAMPING] -= out.damping;
    evaluation->power[DMB_POWER_INERTIA] -= out.inertia;
    add_projected_force(sim, a, &A, out.fa, out.scale_a);
    add_projected_force(sim, b, &B, out.fb, out.scale_b);
    if (!evaluation->tangent) return DMB_OK;
    add_projected(out.K.aa, &A, &A, dmb_stiffness_of(sim, a));
    add_projected(out.K.bb, &B, &B, dmb_stiffness_of(sim, b));
    add_turning_bend(sim, a, &A, out.fa);
    add_turning_bend(sim, b, &B, out.fb);
    add_projected(out.K.ab, &A, &B, sim->stiffness_upper + link);
    add_projected(out.K.ba, &B, &A, sim->stiffness_lower + link);
    if (!evaluation->dynamic) return DMB_OK;
    add_projected(out.C.aa, &A, &A, dmb_inertia_of(sim, a));
    add_projected(out.C.bb, &B, &B, dmb_inertia_of(sim, b));
    return DMB_OK;
}

/* Elements are in batches of one kind (model/mesh). Elements fail by too large a relative rotation of their ends only
 * (DMB_ERR_ROTATION, with the number of the element): eq:kinematics.log-rotation ends at pi. */
static int32_t assemble_batch(dmb_evaluation *evaluation, const dmb_batch *batch)
{
    int32_t status = DMB_OK;
    if (batch->kernel == DMB_KERNEL_BEAM) return assemble_beams(evaluation, batch);
    if (batch->kernel == DMB_KERNEL_AXIAL_TORSIONAL) {
        assemble_axial_torsional_elements(evaluation, batch);
        return DMB_OK;
    }
    for (uint32_t e = batch->first; e < batch->first + batch->count && status >= 0; e++)
        status = assemble_mixed(evaluation, e);
    return status;
}

void dmb_assemble_elements(dmb_evaluation *evaluation)
{
    const dmb_scene *scene = evaluation->sim->scene;
    const int heavy = scene->curved && scene->features & DMB_FEATURE_GRAVITY;
    if (heavy) dmb_vec3_scale(evaluation->load_factor, scene->gravity, evaluation->gravity);
    if (!heavy) dmb_vec3_zero(evaluation->gravity);
    for (uint32_t i = 0; i < scene->batch_count && evaluation->status >= 0; i++)
        evaluation->status = assemble_batch(evaluation, scene->batches + i);
}

typedef struct stress_work {
    const dmb_sim *sim;
    const dmb_batch *batch;
    const double *correction;
} stress_work;

static void extrapolate(void *work, uint32_t first, uint32_t end)
{
    const stress_work *in = work;
    const dmb_scene *scene = in->sim->scene;
    dmb_batch part = *in->batch;
    part.first += first;
    part.count = end - first;
    dmb_beam_args args = args_of(in->sim, &part);
    args.velocity = in->correction + scene->layout.row[scene->element_node[part.first]];
    scene->kernels->extrapolate(&args);
}

/* s <- s + (K/L) P z over the correction z of both nodes, at the strain of the last evaluation. */
void dmb_system_extrapolate_stress(dmb_sim *sim, const double *correction)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0; i < scene->batch_count; i++) {
        stress_work work = {sim, scene->batches + i, correction};
        if (work.batch->kernel == DMB_KERNEL_BEAM)
            dmb_chunks_run(sim, work.batch->count, DMB_GRAIN, extrapolate, &work);
    }
}
