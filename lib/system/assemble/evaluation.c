/* Evaluation of the equations of motion (eq:motion.euler-poincare) at a trial. The order of dmb_system_evaluate fixes
 * the rounding of the sums, and with it the bits of every result:
 *
 *     term                       file                     needs before it
 *     ------------------------   ----------------------   ----------------------------------------------------------
 *     elements                   elements.c               nothing: beams write their rows and blocks, others add
 *     rigid masses, weight,      nodes.c,                 tension of the elements (friction on the hole's axis)
 *       damping, friction of     nodes_axial_torsional.c
 *       axial-torsional nodes
 *     added mass of mud          nodes.c
 *     contact at the wall        wall_contact.c           strain of the elements (contact points inside them)
 *     loads, mud flow            nodes.c
 *     drives of nodes, bits      drives.c, bit.c
 *     springs, stuck places,     springs.c, stuck.c,      cleared tangents of constraints
 *       callers' forces          caller_force.c
 *     joints                     joint_forces.c           all other forces: multipliers balance them
 *                                                         (eq:joints.multipliers)
 *
 * Signs: forces enter the residual with a minus sign. Powers are those of the forces on the bodies. Rows and blocks are
 * in the axes of their node. Also here: motion of the nodes, the iteration matrix, and results at acceptance. */
#include "system/assemble/evaluation.h"

#include <string.h>

#include "kernel/kernels.h"
#include "sim/chunks.h"
#include "sim/node.h"
#include "system/assemble/actuators.h"
#include "system/assemble/assemble.h"
#include "system/assemble/bounces.h"
#include "system/assemble/caller_force.h"
#include "system/assemble/drives.h"
#include "system/constrain/constrain.h"
#include "system/constrain/rotor.h"

/* Clears rows and, for a tangent, blocks of the nodes from `first` to before `end`. */
static void clear_nodes(void *work, uint32_t first, uint32_t end)
{
    const dmb_evaluation *evaluation = work;
    dmb_sim *sim = evaluation->sim;
    const dmb_block_layout *layout = &sim->scene->layout;
    const uint32_t row = layout->row[first], diag = layout->diag[first];
    const size_t rows = (layout->row[end] - row) * sizeof(double);
    const size_t blocks = (layout->diag[end] - diag) * sizeof(double);
    memset(sim->residual + row, 0, rows);
    memset(sim->scale_row + row, 0, rows);
    if (!evaluation->tangent) return;
    memset(sim->stiffness_diagonal + diag, 0, blocks);
    memset(sim->inertia_diagonal + diag, 0, blocks);
}

/* Clears rows and blocks; beams write, and need not clear, the blocks between the ends of their runs. */
static void clear(dmb_evaluation *evaluation)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    const dmb_block_layout *layout = &scene->layout;
    const uint32_t n = scene->node_count;
    const size_t link = layout->link[n - 1] * sizeof(double);
    const int whole = evaluation->tangent && (!evaluation->dynamic || evaluation->inertia_only); /* not both blocks */
    uint32_t next = 0;
    for (uint32_t i = 0; i < scene->batch_count && !whole; i++) {
        const dmb_batch *batch = scene->batches + i;
        if (batch->kernel != DMB_KERNEL_BEAM) continue;
        const uint32_t a = scene->element_node[batch->first];
        clear_nodes(evaluation, next, a + 1);
        next = a + batch->count;
    }
    if (next == 0)
        dmb_chunks_run(sim, n, DMB_GRAIN, clear_nodes, evaluation);
    else
        clear_nodes(evaluation, next, n);
    if (!evaluation->tangent || scene->beams_only) return; /* beams write their off-diagonal blocks */
    memset(sim->stiffness_lower, 0, link);
    memset(sim->stiffness_upper, 0, link);
}

/* Moves axial-torsional nodes along and about the axis, from node `first` on while there are such nodes before `end`;
 * other pose components stay. Returns their number; *turned is raised to the square of the largest rotation. */
static uint32_t move_axial_torsional_nodes(dmb_sim *sim, uint32_t first, uint32_t end, double *turned)
{
    const dmb_scene *scene = sim->scene;
    const double *z = sim->increment + scene->layout.row[first];
    const double *now_displacement = sim->now.displacement, *now_turn = sim->now.turn;
    double *displacement = sim->trial.displacement, *turn = sim->trial.turn, largest = *turned;
    uint32_t i = first;
    for (; i < end && scene->layout.size[i] == DMB_NODE_AXIAL_TORSIONAL; i++, z += DMB_NODE_AXIAL_TORSIONAL) {
        const double square = z[1] * z[1];
        displacement[3 * i] = now_displacement[3 * i] + z[0];
        turn[i] = now_turn[i] + z[1];
        if (square > largest) largest = square;
    }
    *turned = largest;
    return i - first;
}

/* Stores the largest squared rotation in the entry of the first grain of the range. */
static void note_turned(dmb_sim *sim, uint32_t first, uint32_t end, double turned)
{
    double *to = sim->turned_squared + first / DMB_GRAIN;
    *to++ = turned;
    for (; to <= sim->turned_squared + (end - 1) / DMB_GRAIN; to++) *to = 0.0;
}

/* H1 = H0 exp z in six-DOF nodes (eq:integration.newmark), additions along and about the axis in axial-torsional ones
 * (eq:kinematics.path-velocity). */
void dmb_system_move_nodes(dmb_sim *sim, uint32_t first, uint32_t end)
{
    const dmb_scene *scene = sim->scene;
    double turned = 0.0;
    for (uint32_t i = first, count; i < end; i += count) {
        const double *z = sim->increment + scene->layout.row[i];
        count = dmb_six_dof_nodes_before(scene, i, end);
        if (count > 0) {
            dmb_node_args args = {count,
                                  0,
                                  z,
                                  sim->now.displacement + 3 * i,
                                  sim->now.quaternion + 4 * i,
                                  sim->trial.displacement + 3 * i,
                                  sim->trial.quaternion + 4 * i,
                                  turned};
            scene->kernels->advance(&args);
            turned = args.turned;
            continue;
        }
        count = move_axial_torsional_nodes(sim, i, end, &turned);
    }
    note_turned(sim, first, end, turned);
}

static void move_nodes(void *work, uint32_t first, uint32_t end)
{
    dmb_system_move_nodes(work, first, end);
}

void dmb_system_move(dmb_sim *sim)
{
    dmb_chunks_run(sim, sim->scene->node_count, DMB_GRAIN, move_nodes, sim);
}

/* One sum of magnitudes instead of a test of each row: it is not finite if any of them is not. */
static int32_t finite_status(const dmb_sim *sim)
{
    const double sum = sim->scene->kernels->magnitude(sim->scene->row_count, sim->residual);
    return isfinite(sum) ? DMB_OK : DMB_ERR_NOT_FINITE;
}

int32_t dmb_system_evaluate(dmb_evaluation *evaluation)
{
    const dmb_scene *scene = evaluation->sim->scene;
    evaluation->status = DMB_OK;
    evaluation->rounding = 0.0;
    memset(evaluation->power, 0, sizeof evaluation->power);
    clear(evaluation);
    dmb_contacts_assume_slip(evaluation);
    dmb_assemble_elements(evaluation);
    if (evaluation->status < 0) return evaluation->status;
    dmb_assemble_nodes(evaluation);
    if (scene->added_mass_count && evaluation->dynamic) dmb_assemble_added_masses(evaluation);
    if (scene->site_count) dmb_assemble_contacts(evaluation);
    if (evaluation->status < 0) return evaluation->status; /* of the caller's law of friction */
    if (scene->load_count) dmb_assemble_loads(evaluation);
    if (scene->flow_count) dmb_assemble_flow(evaluation);
    if (scene->drive_count) dmb_assemble_drives(evaluation);
    if (scene->bit_count) dmb_assemble_bits(evaluation);
    if (scene->cluster_count && evaluation->tangent)
        memset(evaluation->sim->constraint_tangent, 0, scene->tangent_count * sizeof(double));
    if (scene->spring_count) dmb_assemble_springs(evaluation);
    if (scene->stuck_count) dmb_assemble_stuck(evaluation);
    if (scene->force_count && dmb_assemble_caller_forces(evaluation) < 0) return evaluation->status = DMB_ERR_CALLBACK;
    if (scene->cluster_count)
        evaluation->status = dmb_assemble_joints(evaluation);
    else if (scene->unilateral_count)
        dmb_bounces_turn(evaluation);
    if (evaluation->status >= 0) evaluation->status = finite_status(evaluation->sim);
    return evaluation->status;
}

void dmb_system_remember(dmb_evaluation *evaluation, const double *held)
{
    const dmb_scene *scene = evaluation->sim->scene;
    evaluation->tangent = 0;
    if (scene->site_count) dmb_assemble_contacts(evaluation);
    if (scene->drive_count) dmb_assemble_drives(evaluation);
    if (scene->bit_count) dmb_assemble_bits(evaluation);
    for (uint32_t i = 0; i < scene->constrained_count; i++)
        evaluation->sim->residual[scene->layout.row[scene->constrained_node[i]] + scene->constrained_component[i]] =
            held[i];
}

/* Iteration matrix of a Newton step in the pose parameters z of the increment h Dq (eq:integration.iteration-matrix):
 *     [K T6(h Dq) + mass_factor M + velocity_factor C] z = -residual
 * K is with respect to body-frame pose changes, which are T6(h Dq) z. The elements have applied T6 to their
 * off-diagonal blocks; the blocks of the nodes, to which all forces add, are transformed here. */

/* Number of six-DOF nodes from `node` on, before `end` and before the next free rigid body, whose block only lacks its
 * inertia; `rigid` is the first candidate. */
static uint32_t nodes_to_turn(const dmb_scene *scene, uint32_t node, uint32_t end, uint32_t rigid)
{
    const uint32_t count = dmb_six_dof_nodes_before(scene, node, end);
    if (rigid == scene->free_rigid_count || scene->free_rigids[rigid].node >= node + count) return count;
    return scene->free_rigids[rigid].node - node;
}

/* rigid: index of the first free rigid body to treat as such. */
typedef struct block_work {
    dmb_sim *sim;
    uint32_t rigid, reserved;
} block_work;

static void make_diagonal_blocks(void *work, uint32_t first, uint32_t end)
{
    const block_work *in = work;
    const dmb_sim *sim = in->sim;
    const dmb_scene *scene = sim->scene;
    const dmb_block_layout *layout = &scene->layout;
    uint32_t rigid = in->rigid;
    while (rigid < scene->free_rigid_count && scene->free_rigids[rigid].node < first) rigid++;
    for (uint32_t i = first, count; i < end; i += count) {
        count = nodes_to_turn(scene, i, end, rigid);
        const dmb_matrix_args args = {count, 0, sim->increment + layout->row[i], dmb_inertia_of(sim, i),
                                      dmb_stiffness_of(sim, i)};
        if (count > 0) {
            scene->kernels->matrices(&args);
            continue;
        }
        count = 1;
        if (layout->size[i] == DMB_NODE_SIX_DOF) rigid++;
        for (uint32_t k = 0; k < layout->diag[i + 1] - layout->diag[i]; k++) args.stiffness[k] += args.inertia[k];
    }
}

/* Free rigid bodies from number `rigid` on: dmb_free_rigids_matrix has made their whole block, which is not multiplied
 * by T6 again. */
static void diagonal_blocks(dmb_sim *sim, uint32_t rigid)
{
    block_work work = {sim, rigid, 0};
    dmb_chunks_run(sim, sim->scene->node_count, DMB_GRAIN, make_diagonal_blocks, &work);
}

/* Makes row and column of a constrained unknown identity. The row becomes z = 0 and its column 0 in the other rows. Its
 * residual is not solved for: it is the reaction of the support (dmb_system_get_reactions). */
static void hold_row(dmb_sim *sim, uint32_t node, uint32_t c)
{
    const dmb_scene *scene = sim->scene;
    const dmb_block_layout *layout = &scene->layout;
    const uint32_t size = layout->size[node];
    double *D = dmb_stiffness_of(sim, node);
    for (uint32_t i = 0; i < size; i++) D[size * c + i] = D[size * i + c] = 0.0;
    D[(size + 1) * c] = 1.0;
    if (node > 0 && scene->node_element[node - 1] != DMB_NONE) {
        const uint32_t before = layout->size[node - 1];
        for (uint32_t i = 0; i < before; i++) {
            sim->stiffness_lower[layout->link[node - 1] + before * c + i] = 0.0;
            sim->stiffness_upper[layout->link[node - 1] + size * i + c] = 0.0;
        }
    }
    if (scene->node_element[node] != DMB_NONE) {
        const uint32_t after = layout->size[node + 1];
        for (uint32_t i = 0; i < after; i++) {
            sim->stiffness_upper[layout->link[node] + after * c + i] = 0.0;
            sim->stiffness_lower[layout->link[node] + size * i + c] = 0.0;
        }
    }
}

/* Row c of a node in the matrix: blocks of the node before, of the node and of the node after, shape (3, 6). */
static void read_row(const dmb_sim *sim, uint32_t node, uint32_t c, double row[18])
{
    const dmb_scene *scene = sim->scene;
    const dmb_block_layout *layout = &scene->layout;
    const uint32_t size = layout->size[node];
    memset(row, 0, 18 * sizeof *row);
    memcpy(row + 6, dmb_stiffness_of(sim, node) + size * c, size * sizeof *row);
    if (node > 0 && scene->node_element[node - 1] != DMB_NONE) {
        const uint32_t before = layout->size[node - 1];
        memcpy(row, sim->stiffness_lower + layout->link[node - 1] + before * c, before * sizeof *row);
    }
    if (scene->node_element[node] != DMB_NONE) {
        const uint32_t after = layout->size[node + 1];
        memcpy(row + 12, sim->stiffness_upper + layout->link[node] + after * c, after * sizeof *row);
    }
}

static double row_times(const dmb_block_layout *layout, uint32_t node, const double row[18], const double *z)
{
    double sum = 0.0;
    for (uint32_t k = 0; k < 3; k++) {
        if ((k == 0 && node == 0) || (k == 2 && node + 1 == layout->n)) continue;
        const uint32_t at = node + k - 1;
        for (uint32_t i = 0; i < layout->size[at]; i++) sum += row[6 * k + i] * z[layout->row[at] + i];
    }
    return sum;
}

void dmb_system_constrained_times(const dmb_sim *sim, const double *rows, const double *z, double *product)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0; i < scene->constrained_count; i++)
        product[i] = row_times(&scene->layout, scene->constrained_node[i], rows + 18 * (size_t)i, z);
}

/* In a step (velocity_factor > 0) bodies with axes of their own come first: they replace the factors 1, gamma', beta'
 * of pose, velocity and acceleration by matrices (eq:integration.free-rigid, eq:motion.rotor-tangent). A mass matrix
 * has no pose parameters and is taken at the nodes. */
void dmb_system_iteration_matrix_constrained(const dmb_evaluation *evaluation, double *constrained_rows)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    if (evaluation->dynamic) {
        const int stepping = evaluation->velocity_factor > 0.0;
        if (stepping && scene->free_rigid_count) dmb_free_rigids_matrix(evaluation);
        if (stepping && scene->rotor_count) dmb_rotors_matrix(evaluation);
        diagonal_blocks(sim, stepping ? 0 : scene->free_rigid_count);
    }
    for (uint32_t i = 0; i < scene->constrained_count && constrained_rows != NULL; i++)
        read_row(sim, scene->constrained_node[i], scene->constrained_component[i], constrained_rows + 18 * (size_t)i);
    for (uint32_t i = 0; i < scene->constrained_count; i++)
        hold_row(sim, scene->constrained_node[i], scene->constrained_component[i]);
}

void dmb_system_iteration_matrix(const dmb_evaluation *evaluation)
{
    dmb_system_iteration_matrix_constrained(evaluation, NULL);
}

/* Rotation about the node's own x axis since time 0, on the revolution reached by the increment of the step. */
static void unwrap_nodes(void *work, uint32_t first, uint32_t end)
{
    const dmb_sim *sim = work;
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = first, count; i < end; i += count) {
        count = dmb_six_dof_nodes_before(scene, i, end);
        if (count > 0) {
            const dmb_turn_args args = {.count = count,
                                        .reference = scene->reference_quaternion + 4 * i,
                                        .quaternion = sim->trial.quaternion + 4 * i,
                                        .increment = sim->increment + scene->layout.row[i],
                                        .start = sim->now.turn + i,
                                        .turn = sim->trial.turn + i};
            scene->kernels->turns(&args);
        } else {
            count = 1;
        }
    }
}

void dmb_system_unwrap(dmb_sim *sim)
{
    dmb_chunks_run(sim, sim->scene->node_count, DMB_GRAIN, unwrap_nodes, sim);
}

void dmb_system_get_reactions(dmb_sim *sim, dmb_configuration *to)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0; i < scene->constrained_count; i++)
        sim->support_reaction[i] =
            sim->residual[scene->layout.row[scene->constrained_node[i]] + scene->constrained_component[i]];
    dmb_drives_read_reactions(sim, to);
}

/* Memory that depends on the accepted motion, each part from the trial: positions of drives, delay lines, revolutions
 * and partition of joints, reactions, rock surfaces. Contact points inside elements whose evaluation was deferred get
 * their penetration first. */
void dmb_system_accept(dmb_evaluation *evaluation)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    if (scene->inside_count) dmb_contacts_accept(evaluation);
    dmb_drives_accept(evaluation);
    if (scene->actuator_count) dmb_actuators_accept(evaluation);
    if (scene->cluster_count) dmb_joints_accept(evaluation);
    dmb_system_get_reactions(sim, &sim->trial);
    for (uint32_t k = 0; k < scene->bit_count; k++) dmb_bit_accept(evaluation, k);
}
