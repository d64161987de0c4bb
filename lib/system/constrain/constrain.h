/* Equations of joints at the trial: frames of joints, rows, and constraint components (sets of rows coupled by common
 * nodes, dmb_cluster). */
#ifndef DMB_SYSTEM_CONSTRAIN_CONSTRAIN_H
#define DMB_SYSTEM_CONSTRAIN_CONSTRAIN_H

#include "constraint/joint.h"
#include "constraint/partition.h"
#include "math/block_signed.h"
#include "sim/sim.h"
#include "system/assemble/evaluation.h"

/* ---- Frames of a joint ------------------------------------------------------------------------------------------- */

/* Added to joint_segment while a DMB_JOINT_POINT_ON_HOLE is locked: frame a stays at joint_depth. */
#define DMB_SEGMENT_HELD 0x80000000u

/* Geometry of the axis of the hole at a point on it: rotation rate of the hole frame, curvature, tangent. */
typedef struct dmb_hole_bend {
    double frame_rate[3], curvature[3], tangent[3]; /* [rad/m], [1/m], [-] world axes */
    double normal[2][3];                            /* [-] y and z axes of the frame, world */
    double M[9];                                    /* [-] axes of frame b in the world */
} dmb_hole_bend;

/* Pose, maps and motion of joint j; updates joint_depth and joint_segment of the configuration. bend (only of
 * DMB_JOINT_POINT_ON_HOLE) may be NULL. */
void dmb_joint_motion(const dmb_scene *scene, dmb_configuration *configuration, uint32_t j, dmb_relative *relative,
                      dmb_hole_bend *bend);
/* Resets the position of joint j on the hole's axis in trial to that of now, independent of earlier trials. */
void dmb_joint_place_begin(dmb_sim *sim, uint32_t j);
/* Position of joint j on the hole's axis in now, from the position of its part instead of the joint's earlier one: at
 * the start, and when it closes. */
void dmb_joint_place_find(dmb_sim *sim, uint32_t j);
/* Fixes joint j at its present position on the hole's axis, or releases it. */
void dmb_joint_place_hold(dmb_sim *sim, uint32_t j, int held);
/* The same motion without writing to the configuration. */
void dmb_joint_motion_of(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t j,
                         dmb_relative *relative, dmb_hole_bend *bend);

/* First column of a node in a constraint; the node must be one of its nodes. */
uint32_t dmb_constraint_column(const dmb_constraint *constraint, uint32_t node);
/* columns += components of a 6-vector that act on the rows of a node. */
void dmb_add_node_columns(const dmb_scene *scene, uint32_t node, const double vector[6], double *columns);
/* row (shape (columns)) += factor J [to_a, to_b] of joint j. */
void dmb_add_joint_row(const dmb_scene *scene, const dmb_constraint *constraint, uint32_t j,
                       const dmb_relative *relative, double factor, const double J[6], double *row);

/* ---- Edges ------------------------------------------------------------------------------------------------------- */

/* Poses in which a joint has no coordinates or no equations.
 *
 * RX and RY are angles about axes that coincide if RZ is a right angle (gimbal singularity): with n = R^T e_y, the y
 * axis of a in the axes of b, s = cos RZ = |(n_y, n_z)| is 0 there, and their gradients grow as 1/s. Beyond it both
 * jump by half a turn, with the forces of springs, drives and couplings, and a universal joint would report angles
 * other than its own. A rolling rim that lies flat has no lowest point: its equations of speed become rows of zeros. */

/* Fails if the trial of an active joint is at a pose where its angles or equations are undefined: RZ at a right angle
 * for a universal joint or one with springs, drives or couplings on its angles; a rim that lies flat. moving: the path
 * from now is checked too. DMB_ERR_GEOMETRY with a message. */
int32_t dmb_joints_refuse_gimbal_singularity(dmb_sim *sim, int moving, double time);
/* Fails if an active universal joint with loads on its angles has passed the right angle between now and trial: a
 * search for equilibrium of any length would have crossed the singularity. DMB_ERR_GEOMETRY with a message. */
int32_t dmb_joints_refuse_gimbal_flip(dmb_sim *sim);
/* [-] smallest cos RZ of the joints of the trial with loads on their angles, and its joint; 1, DMB_NONE if there is
 * none. */
double dmb_joints_nearest_gimbal_singularity(const dmb_sim *sim, uint32_t *joint);

/* ---- Memory from step to step ------------------------------------------------------------------------------------ */

/* Updates the revolutions of the coordinates of the trial; in statics after every move. */
void dmb_joints_follow(dmb_evaluation *evaluation);
/* After the last evaluation of a state: multipliers of least norm for redundant rows (iterations need any that balance,
 * since B^T f is the same), and power of the callers' constraints. */
void dmb_joint_reactions(dmb_evaluation *evaluation);
/* End of an accepted step: revolutions of coordinates, multipliers of least norm, renewal of a poor partition. */
void dmb_joints_accept(dmb_evaluation *evaluation);
/* Sets the revolutions of the trial from the coordinates of joint j. */
void dmb_joint_set_turns(dmb_sim *sim, uint32_t j, const dmb_joint_coordinates *c);
/* Stores the present pose of frame b as the locked pose of joint j. */
void dmb_joint_hold(dmb_sim *sim, uint32_t j);
/* Sets the state of joint j, DMB_JOINT_...; LOCKED keeps frame b in the present pose. */
void dmb_joint_set_state(dmb_sim *sim, uint32_t j, int32_t state);
/* [J] in springs and stops of the joints. */
double dmb_joint_energy(const dmb_sim *sim, const dmb_configuration *configuration);

/* ---- Rows -------------------------------------------------------------------------------------------------------- */

/* All rows, from trial pose and trial velocity. DMB_OK, DMB_ERR_CALLBACK, DMB_ERR_NOT_FINITE. */
int32_t dmb_constraint_rows(dmb_evaluation *evaluation);
/* Derivative of B^T multiplier by body-frame displacements of a constraint's nodes, added to K, shape (columns,
 * columns). */
int32_t dmb_constraint_curvature(dmb_evaluation *evaluation, uint32_t constraint, double *K);

/* Coordinates of joint j in the trial, RX and RY on the revolution reached in the step. */
void dmb_joint_coordinates_in(const dmb_evaluation *evaluation, uint32_t j, const dmb_relative *relative,
                              dmb_joint_coordinates *coordinates);
/* Adds to K, shape (columns, columns) of the constraint: tangent of a wrench w on frame b of joint j that changes by
 * W. */
void dmb_add_joint_tangent(const dmb_scene *scene, const dmb_constraint *constraint, uint32_t j,
                           const dmb_relative *relative, const double w[6], const double W[36], double *K);
/* Active rows of joint j: of its kind, or of its lock. */
void dmb_joint_rows_now(const dmb_sim *sim, uint32_t j, const dmb_relative *relative, dmb_joint_rows *rows);
/* "joint 3 (crank)" and the like, the owner of a constraint. */
void dmb_constraint_text(const dmb_scene *scene, uint32_t constraint, dmb_message *text);
/* Constraint that a constraint row belongs to. */
uint32_t dmb_constraint_of_row(const dmb_scene *scene, uint32_t row);

/* ---- The caller's constraints: constraint_rows_callback.c -------------------------------------------------------- */

/* The caller's constraints. Derivatives that the callback does not give are built by central differences of fourth
 * order:
 *
 *     J by places:  along each body-frame component
 *     rate:         along time at fixed poses
 *     convective:   along the motion q exp(s v), t + s: of A v + b its first derivative, of C its second; if J is
 *                   given, (J v)' + d(J v)/dt + d2C/dt2 instead, which the rounding of large coordinates does not
 *                   degrade
 *
 * Difference steps are long: 2 km from the origin, positions round to 2e-13 m, which divided by a short step would
 * disturb Newton's iteration. */

/* Rows of a callback; and a comparison of its Jacobian with differences: DMB_ERR_CALLBACK with row and column in the
 * message of the sim. system/constrain/constraint_rows_callback */
int32_t dmb_callback_rows(dmb_evaluation *evaluation, uint32_t callback);
int32_t dmb_callback_curvature(dmb_evaluation *evaluation, uint32_t callback, double *K);
int32_t dmb_callback_check(dmb_sim *sim, uint32_t callback);

/* ---- Clusters ---------------------------------------------------------------------------------------------------- */

/* Constraint components: partition into dependent and independent coordinates, and projection of a trial.
 *
 * A trial satisfies its constraints at all three levels before its residual is formed (settle): poses, speeds and
 * accelerations change by the shortest change, in the metric of cluster_weight, that makes C = 0, B v + rate = 0 and
 * B v' + convective = 0. This does not depend on the partition, so the partition may change between any two steps.
 * R^T residual = 0 remains to be solved in the independent coordinates, R = [G; I] (constraint/partition.h). */

enum { DMB_SETTLE_POSE = 1, DMB_SETTLE_SPEED = 2, DMB_SETTLE_ACCELERATION = 4, DMB_SETTLE_ALL = 7 };

/* Units of the columns and the first partition, from the rows at the trial. Once per sim, when its memory is new. */
void dmb_clusters_prepare(dmb_sim *sim);
/* Rows and matrices at the trial. DMB_OK, DMB_ERR_CALLBACK, DMB_ERR_NOT_FINITE. */
int32_t dmb_clusters_assemble(dmb_evaluation *evaluation);
/* One step of Gauss-Newton towards C = 0 with a new partition, at most DMB_CORRECTION_MOST long. DMB_NOTE_STOPPED: it
 * no longer moves. Errors as dmb_clusters_settle. */
int32_t dmb_clusters_correct(dmb_evaluation *evaluation);
/* Weights of the columns of all components; bodies_only: 0 for nodes connected by elements. */
void dmb_clusters_weigh(dmb_sim *sim, int bodies_only);
/* Pose of a node of trial moved by x in its axes [m, rad]. */
void dmb_trial_move_node(dmb_sim *sim, uint32_t node, const double *x);
/* Chooses the partition of every component from the present matrices. */
void dmb_clusters_choose(dmb_sim *sim);
/* Renews choices whose conditioning has deteriorated or whose dropped rows have changed; counts the changes. */
void dmb_clusters_watch(dmb_sim *sim);
/* The same, with factorisation: for searches with large moves. */
int32_t dmb_clusters_refresh(dmb_evaluation *evaluation);

/* Projects the trial at the levels DMB_SETTLE_... (sum), and evaluates rows and factors there. Speeds and accelerations
 * start from the raw_ fields if from_raw, otherwise from the trial. DMB_OK, DMB_ERR_CALLBACK, _NOT_FINITE,
 * DMB_ERR_SINGULAR (row in reduced_mode->row), DMB_ERR_NO_CONVERGENCE (row as before). */
int32_t dmb_clusters_settle(dmb_evaluation *evaluation, int32_t levels, int32_t from_raw);

/* Multipliers that balance the residual in the dependent rows, into trial.multiplier; and B^T multiplier into the
 * residual. With evaluation->given, the multipliers of the trial are used unchanged. */
void dmb_clusters_balance(dmb_evaluation *evaluation);
/* Multipliers of least norm of the trial, for redundant rows. Once per state, not in iterations. */
void dmb_clusters_least_norm(dmb_sim *sim);
/* Sets the multipliers of the trial to 0, for residuals without constraint forces. */
void dmb_clusters_clear_multipliers(dmb_sim *sim);
/* Adds the correction of an iteration to a multiplier of the trial. */
void dmb_cluster_move_multiplier(dmb_sim *sim, uint32_t row, double change);
/* Copies the multipliers of trial into now. */
void dmb_clusters_copy_multipliers(dmb_sim *sim);

/* Largest violation of an equation of position at the present rows, and its *row; dropped: of dropped rows only. */
double dmb_clusters_violation(const dmb_sim *sim, int32_t dropped, uint32_t *row);

/* The partition of component k, stored in the sim. */
dmb_partition dmb_cluster_partition(const dmb_sim *sim, uint32_t k);
/* Message for a row that could not be satisfied: `what` follows its owner's name. */
void dmb_clusters_explain(dmb_sim *sim, const char *what);

/* Functions shared by the files cluster_*.c. */

/* B of a component at the present rows, shape (rows, columns). */
static inline double *dmb_cluster_matrix(const dmb_sim *sim, const dmb_cluster *cluster)
{
    return sim->cluster_matrix + cluster->dense;
}

/* Number of active rows of a component. */
uint32_t dmb_cluster_active_rows(const dmb_sim *sim, const dmb_cluster *cluster);
/* Updates cluster_place, the position of each column in the order of the choice. */
void dmb_cluster_note_places(dmb_sim *sim, uint32_t k);
/* DMB_ERR_SINGULAR, with the row and its violation for the message. */
int32_t dmb_cluster_singular(dmb_sim *sim, uint32_t row, double violation);
/* Factorises the dependent part of every matrix and computes its quality. DMB_OK, DMB_ERR_SINGULAR. */
int32_t dmb_clusters_factor(dmb_sim *sim);
/* Largest violation of the pivot rows; *row stays where there is none. */
double dmb_clusters_pivot_violation(const dmb_sim *sim, uint32_t *row);

/* ---- Rank for the model check: cluster_rank.c -------------------------------------------------------------------- */

/* Rank of the equations of a scene at the accepted state, by LAPACK, for the model check. The sim is not written: rows
 * and matrices are evaluated in separate memory. */

typedef struct dmb_cluster_rank {
    uint32_t rows;          /* that act */
    uint32_t rank;          /* by LAPACK, sum of all components */
    uint32_t differing;     /* number of components whose partition has another rank */
    uint32_t poorest;       /* component of the condition below */
    double condition;       /* smallest over largest singular value, worst component; 1 without equations */
    double violation;       /* [m, -] largest of an equation of position */
    uint32_t violation_row; /* its row; DMB_NONE: none */
    uint32_t reserved;
    uint8_t *redundant; /* 1 for redundant rows: those dropped by the partition, or found by LAPACK if the two differ;
                           shape (constraint_row_count) */
    void *block;        /* its memory */
    size_t block_size;
} dmb_cluster_rank;

/* Fills *rank; its memory is released by dmb_cluster_rank_release, on error it holds none. Errors: DMB_ERR_NO_MEMORY,
 * DMB_ERR_CALLBACK, DMB_ERR_NOT_FINITE. */
int32_t dmb_cluster_rank_make(const dmb_sim *sim, dmb_cluster_rank *rank);
/* NULL memory and a struct of zeros are permitted. */
void dmb_cluster_rank_release(const dmb_sim *sim, dmb_cluster_rank *rank);

/* "joint 3 (crank): rotation about y": a constraint row by name. */
void dmb_constraint_row_text(const dmb_sim *sim, uint32_t row, dmb_message *text);

/* ---- Assembly: cluster_assembly.c -------------------------------------------------------------------------------- */

/* Assembly of a scene: shortest moves that satisfy all equations of position (Wehage, Haug 1982). Order of strategies:
 * system/constrain/cluster_assembly. */

/* Closes the joints from the described poses of now: poses move until every equation and every given initial coordinate
 * is satisfied; speeds are projected. Fills counters->assembly. Errors with a message: DMB_ERR_GEOMETRY (the joint that
 * does not fit, and by how much), DMB_ERR_CALLBACK. system/constrain/cluster_assembly */
int32_t dmb_assemble(dmb_sim *sim);
/* Base node of a chain for rigid motions; DMB_NONE: the chain does not move, because more than one of its nodes are
 * constrained or it is on the axis of the hole. Constrained components of the node are 0 in `open`.
 * system/constrain/cluster_placement */
uint32_t dmb_chain_base(const dmb_scene *scene, const dmb_chain *chain, double open[6]);
/* Motion of a rigid body, world axes. */
typedef struct dmb_rigid_motion {
    double Q[9];                /* [-] rotation */
    double before[3], after[3]; /* [m] displacement of the node */
    uint32_t node;
    uint32_t reserved;
} dmb_rigid_motion;
/* Moves the other nodes of a chain with the rigid motion of one of its nodes. */
void dmb_chain_follow(dmb_sim *sim, const dmb_chain *chain, const dmb_rigid_motion *motion);
/* Moves chains of the trial as rigid bodies, one after the other, to close the joints to chains placed before. Joints
 * that close loops may stay open. */
void dmb_place_by_joints(dmb_sim *sim);
/* Fails if frames of a joint that are to be kept parallel oppose each other in the trial: the equations are satisfied
 * there too. DMB_ERR_GEOMETRY with a message. */
int32_t dmb_joint_refuse_flip(dmb_sim *sim, uint32_t joint);
/* Largest changes of the speeds from now to trial into counters->projection. */
void dmb_note_projection(dmb_sim *sim);
/* Fails if the speeds of the trial violate an equation, including dropped ones: DMB_ERR_GEOMETRY. */
int32_t dmb_assembled_speeds(dmb_evaluation *evaluation);

/* ---- Large clusters ---------------------------------------------------------------------------------------------- */

/* Squared sine between a row and the rows before it below which the row is redundant. The rows that close a loop of n
 * bodies have 13/n^3, and leave up to 1e-16 n^3 of rounding to later redundant ones: measured up to n = 800, where the
 * smallest is 2.6e-8. */
#define DMB_SPARSE_RANK 1e-9

static inline int32_t dmb_is_sparse(const dmb_scene *scene, uint32_t constraint)
{
    return scene->clusters[scene->constraints[constraint].cluster].sparse;
}

/* Chooses the rows of every sparse component at the present trial, and computes the quality of the choice. */
void dmb_sparse_choose(dmb_sim *sim);
/* Sizes of blocks and positions of the chosen rows, recomputed because the choice may be one restored with an older
 * state. */
void dmb_sparse_note(dmb_sim *sim);
/* Factorises the present rows in the metric of projections. drop_near_redundant: without rows that nearly depend on
 * earlier ones. DMB_OK, or DMB_ERR_SINGULAR with the row for the message. */
int32_t dmb_sparse_factor(dmb_sim *sim, int drop_near_redundant);
/* The same, only if the factors are not those of the present rows. */
int32_t dmb_sparse_refresh(dmb_sim *sim);

/* Shortest move with B x = d in the chosen rows; d by constraint row. */
void dmb_sparse_project(dmb_sim *sim, const double *d);
/* Result of dmb_sparse_project for component k, in its columns. */
void dmb_sparse_get(const dmb_sim *sim, uint32_t k, double *x);
/* d = -(level + B v) in the rows of sparse components. */
void dmb_sparse_deficit(const dmb_sim *sim, const double *level, const double *v, double *d);
/* dmb_clusters_balance for sparse components. */
void dmb_sparse_balance(dmb_sim *sim, int given);
/* dmb_clusters_least_norm for sparse components. system/constrain/sparse_cluster_least_norm */
void dmb_sparse_least_norm(dmb_sim *sim);
/* dmb_clusters_violation for sparse components, of the chosen or the dropped rows; *row is unchanged if there is none.
 */
double dmb_sparse_violation(const dmb_sim *sim, int32_t dropped, uint32_t *row);

/* Rows of sparse components, also for the reduced system: */

/* Row k of a constraint, its columns. */
static inline const double *dmb_sparse_row(const dmb_sim *sim, const dmb_constraint *c, uint32_t k)
{
    return sim->constraint_jacobian + c->jacobian + (size_t)k * c->columns;
}

/* First column of a node in arrays over the columns of components. */
static inline uint32_t dmb_sparse_column(const dmb_scene *scene, uint32_t node)
{
    return scene->clusters[scene->node_cluster[node]].column + scene->node_place[node];
}

/* Squared length of row k of a constraint in weighted columns. */
double dmb_sparse_length(const dmb_sim *sim, const dmb_constraint *c, uint32_t k, const double *weight);
/* sparse_row from sparse_size; returns their sum. */
uint32_t dmb_sparse_number(dmb_sim *sim);
/* The matrix in the sim's memory. */
dmb_block_signed dmb_sparse_matrix(const dmb_sim *sim);

#endif
