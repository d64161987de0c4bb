/* Equations of joints at the trial: frames of joints, rows, clusters of rows. */
#ifndef DMB_SYSTEM_CONSTRAIN_CONSTRAIN_H
#define DMB_SYSTEM_CONSTRAIN_CONSTRAIN_H

#include "constraint/joint.h"
#include "constraint/partition.h"
#include "math/block_signed.h"
#include "sim/sim.h"
#include "system/assemble/evaluation.h"

/* ---- Frames of a joint ------------------------------------------------------------------------------------------- */

/* Added to joint_segment while a DMB_JOINT_POINT_ON_HOLE is locked: frame a stands at joint_depth and does not ride. */
#define DMB_SEGMENT_HELD 0x80000000u

/* Motion of the axis of the hole at a point on it: frame_rate: turning of the hole frame per metre, curvature, tangent,
 * in frame a. */
typedef struct dmb_hole_bend {
    double frame_rate[3], curvature[3], tangent[3]; /* [rad/m], [1/m], [-] world axes */
    double normal[2][3];                            /* [-] y and z axes of the frame, world */
    double M[9];                                    /* [-] axes of frame b in the world */
} dmb_hole_bend;

/* Pose, maps and motion of joint j. In a configuration that may be written, joint_depth and joint_segment follow; bend
 * (only of DMB_JOINT_POINT_ON_HOLE) may be NULL. */
void dmb_joint_motion(const dmb_scene *scene, dmb_configuration *configuration, uint32_t j, dmb_relative *relative,
                      dmb_hole_bend *bend);
/* The place of joint j on the hole's axis in trial is that of now: what a trial before found does not count. */
void dmb_joint_place_begin(dmb_sim *sim, uint32_t j);
/* Place of joint j on the hole's axis in now, from its part's place along the hole and not from where the joint was
 * before: at the start, and when it closes. */
void dmb_joint_place_find(dmb_sim *sim, uint32_t j);
/* Joint j is held where it stands on the hole's axis in now, or rides along again. */
void dmb_joint_place_hold(dmb_sim *sim, uint32_t j, int held);
/* The same motion without a trace in the configuration. */
void dmb_joint_motion_of(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t j,
                         dmb_relative *relative, dmb_hole_bend *bend);

/* First column of a node in a constraint; the node must be one of its nodes. */
uint32_t dmb_constraint_column(const dmb_constraint *constraint, uint32_t node);
/* columns += the part of a 6-vector of a node that its rows feel. */
void dmb_add_node_columns(const dmb_scene *scene, uint32_t node, const double vector[6], double *columns);
/* row (shape (columns)) += factor J [to_a, to_b] of joint j. */
void dmb_add_joint_row(const dmb_scene *scene, const dmb_constraint *constraint, uint32_t j,
                       const dmb_relative *relative, double factor, const double J[6], double *row);

/* ---- Edges ------------------------------------------------------------------------------------------------------- */

/* Poses in which a joint has no coordinates or no equations.
 *
 * RX and RY turn about axes that fall together where RZ is a right angle: with n = R^T e_y, the y axis of a in the axes
 * of b, s = cos RZ = |(n_y, n_z)| is 0 there, and their gradients grow as 1/s. Beyond it both jump by half a turn.
 * Springs, drives and couplings would jump with them, and a universal joint would tell other angles than it stands at.
 * A rim that rolls has no lowest point where it lies flat: its equations of speed are rows of zeros there. */

/* Refuses active joints whose trial stands where their angles or equations are not defined: a universal joint, or one
 * with springs, drives or couplings on its angles, at a right angle of RZ; a rim that lies flat. moving: the way from
 * now counts too. DMB_ERR_GEOMETRY with a message. */
int32_t dmb_joints_refuse_gimbal_singularity(dmb_sim *sim, int moving, double time);
/* Refuses active universal joints with something on their angles whose trial stands beyond the right angle that `now`
 * is before: on the way of a search for equilibrium, however long, they would have passed it. DMB_ERR_GEOMETRY with a
 * message. */
int32_t dmb_joints_refuse_gimbal_flip(dmb_sim *sim);
/* [-] smallest cos RZ of the joints of the trial with something on their angles, and which one it is; 1, DMB_NONE: of
 * none.
 */
double dmb_joints_nearest_gimbal_singularity(const dmb_sim *sim, uint32_t *joint);

/* ---- Memory from step to step ------------------------------------------------------------------------------------ */

/* Turns of the coordinates of the trial; in statics after every move. */
void dmb_joints_follow(dmb_evaluation *evaluation);
/* After the last evaluation of a state: multipliers of least norm where rows are redundant (iterations need only some
 * that balance: B^T f is the same), power of the callers' constraints. */
void dmb_joint_reactions(dmb_evaluation *evaluation);
/* End of an accepted step: turns of the coordinates, multipliers of least norm, partition where it has become poor. */
void dmb_joints_accept(dmb_evaluation *evaluation);
/* Turns of the trial by the coordinates of joint j. */
void dmb_joint_take_turns(dmb_sim *sim, uint32_t j, const dmb_joint_coordinates *c);
/* The pose in which joint j would hold frame b if it were locked in the pose of now. */
void dmb_joint_hold(dmb_sim *sim, uint32_t j);
/* The state of joint j from now on, DMB_JOINT_...; where that is LOCKED it holds frame b as it is in the pose of now.
 */
void dmb_joint_take_state(dmb_sim *sim, uint32_t j, int32_t state);
/* [J] in springs and stops of the joints. */
double dmb_joint_energy(const dmb_sim *sim, const dmb_configuration *configuration);

/* ---- Rows -------------------------------------------------------------------------------------------------------- */

/* All rows, from trial pose and trial velocity. DMB_OK, DMB_ERR_CALLBACK, DMB_ERR_NOT_FINITE. */
int32_t dmb_constraint_rows(dmb_evaluation *evaluation);
/* Derivative of B^T multiplier by body-frame displacements of a constraint's nodes, added to K, shape (columns,
 * columns). */
int32_t dmb_constraint_curvature(dmb_evaluation *evaluation, uint32_t constraint, double *K);

/* Coordinates of joint j in the trial, RX and RY on the turn that the step leads to. */
void dmb_joint_coordinates_in(const dmb_evaluation *evaluation, uint32_t j, const dmb_relative *relative,
                              dmb_joint_coordinates *coordinates);
/* Adds to K, shape (columns, columns) of the constraint: tangent of a wrench w on frame b of joint j that changes by
 * W. */
void dmb_add_joint_tangent(const dmb_scene *scene, const dmb_constraint *constraint, uint32_t j,
                           const dmb_relative *relative, const double w[6], const double W[36], double *K);
/* Rows of its kind or of its lock that joint j holds now. */
void dmb_joint_rows_now(const dmb_sim *sim, uint32_t j, const dmb_relative *relative, dmb_joint_rows *rows);
/* "joint 3 (crank)" and the like, the owner of a constraint. */
void dmb_constraint_text(const dmb_scene *scene, uint32_t constraint, dmb_message *text);
/* Constraint that a constraint row belongs to. */
uint32_t dmb_constraint_of_row(const dmb_scene *scene, uint32_t row);

/* ---- The caller's constraints: constraint_rows_callback.c -------------------------------------------------------- */

/* The caller's constraints. Derivatives that the callback does not give are built by central differences of fourth
 * order:
 *     J by places:  along each body-frame component;      rate: along time at fixed poses
 *     convective:   along the motion q exp(s v), t + s: of A v + b its first derivative, of C its second; where J is
 *                   given (J v)' + d(J v)/dt + d2C/dt2 instead, which rounding of large coordinates does not spoil
 * Steps are long: at 2 km from the origin rounding of a place is 2e-13 m, and Newton's iteration sees what it
 * becomes. */

/* Rows of a callback; and a comparison of its Jacobian with differences: DMB_ERR_CALLBACK with row and column in the
 * message of the sim. system/constrain/constraint_rows_callback */
int32_t dmb_callback_rows(dmb_evaluation *evaluation, uint32_t callback);
int32_t dmb_callback_curvature(dmb_evaluation *evaluation, uint32_t callback, double *K);
int32_t dmb_callback_check(dmb_sim *sim, uint32_t callback);

/* ---- Clusters ---------------------------------------------------------------------------------------------------- */

/* Clusters of constraint rows: their partition into dependent and independent coordinates, and the projection of a
 * trial onto its constraints.
 *
 * A trial satisfies its constraints at all three levels before its residual is formed (settle): poses, speeds and
 * accelerations move by the least change, in the metric of cluster_weight, that makes C = 0, B v + rate = 0 and
 * B v' + convective = 0. This does not depend on the partition, so the partition may change between any two steps. R^T
 * residual = 0 remains to be solved in the independent coordinates, R = [G; I] (constraint/partition.h). */

enum { DMB_SETTLE_POSE = 1, DMB_SETTLE_SPEED = 2, DMB_SETTLE_ACCELERATION = 4, DMB_SETTLE_ALL = 7 };

/* Units of the columns and the first partition, from the rows at the trial. Once a sim, when its memory is new. */
void dmb_clusters_prepare(dmb_sim *sim);
/* Rows and matrices at the trial. DMB_OK, DMB_ERR_CALLBACK, DMB_ERR_NOT_FINITE. */
int32_t dmb_clusters_assemble(dmb_evaluation *evaluation);
/* One step of Gauss-Newton towards C = 0 with a partition of its own, at most DMB_CORRECTION_MOST long.
 * DMB_NOTE_STOPPED: it no longer moves. Errors as dmb_clusters_settle. */
int32_t dmb_clusters_correct(dmb_evaluation *evaluation);
/* Weights of the columns of all clusters; bodies_only: 0 for nodes that elements connect. */
void dmb_clusters_weigh(dmb_sim *sim, int bodies_only);
/* Pose of a node of trial moved by x in its axes [m, rad]. */
void dmb_trial_move_node(dmb_sim *sim, uint32_t node, const double *x);
/* Chooses the partition of every cluster from the matrices at hand. */
void dmb_clusters_choose(dmb_sim *sim);
/* Chooses anew where the conditioning has fallen or rows are dropped; counts the changes. */
void dmb_clusters_watch(dmb_sim *sim);
/* The same, and factors what was chosen: for searches that move far. */
int32_t dmb_clusters_refresh(dmb_evaluation *evaluation);

/* Projects the trial, levels being a sum of DMB_SETTLE_..., and leaves rows and factored matrices there. Speeds and
 * accelerations start from raw_ fields if from_raw, else from what the trial has. DMB_OK, DMB_ERR_CALLBACK,
 * _NOT_FINITE, DMB_ERR_SINGULAR (reduced_mode->row tells which row), DMB_ERR_NO_CONVERGENCE (likewise). */
int32_t dmb_clusters_settle(dmb_evaluation *evaluation, int32_t levels, int32_t from_raw);

/* Multipliers that balance the residual in the dependent rows, into trial.multiplier; and B^T multiplier into the
 * residual. Those of the trial are taken as they are where evaluation->given says so. */
void dmb_clusters_balance(dmb_evaluation *evaluation);
/* Multipliers of the trial: those of least norm where rows are redundant. Once a state, not in iterations. */
void dmb_clusters_least_norm(dmb_sim *sim);
/* Multipliers of the trial become 0, for residuals without forces of constraint. */
void dmb_clusters_clear_multipliers(dmb_sim *sim);
/* A multiplier of the trial is moved by what an iteration has found for it. */
void dmb_cluster_move_multiplier(dmb_sim *sim, uint32_t row, double change);
/* Multipliers of trial into now. */
void dmb_clusters_take_multipliers(dmb_sim *sim);

/* Largest violation of an equation of position at the rows at hand, *row telling which; dropped: of dropped rows
 * only. */
double dmb_clusters_violation(const dmb_sim *sim, int32_t dropped, uint32_t *row);

/* The partition of cluster k, its storage in the sim. */
dmb_partition dmb_cluster_partition(const dmb_sim *sim, uint32_t k);
/* Message for a row that could not be satisfied: `what` follows its owner's name. */
void dmb_clusters_explain(dmb_sim *sim, const char *what);

/* Functions that the files cluster_*.c share. */

/* B of a cluster at the rows at hand, shape (rows, columns). */
static inline double *dmb_cluster_matrix(const dmb_sim *sim, const dmb_cluster *cluster)
{
    return sim->cluster_matrix + cluster->dense;
}

/* Rows of a cluster that count at present. */
uint32_t dmb_cluster_active_rows(const dmb_sim *sim, const dmb_cluster *cluster);
/* cluster_place: where each column stands in the order of the choice. */
void dmb_cluster_note_places(dmb_sim *sim, uint32_t k);
/* DMB_ERR_SINGULAR, with the row and its violation for the message. */
int32_t dmb_cluster_singular(dmb_sim *sim, uint32_t row, double violation);
/* Factors the dependent part of every matrix, and tells its quality. DMB_OK, DMB_ERR_SINGULAR. */
int32_t dmb_clusters_factor(dmb_sim *sim);
/* Largest violation of the pivot rows; *row stays where there is none. */
double dmb_clusters_pivot_violation(const dmb_sim *sim, uint32_t *row);

/* ---- Rank for the model check: cluster_rank.c -------------------------------------------------------------------- */

/* Rank of the equations of a scene at the accepted state, by LAPACK, for the model check. Nothing of the sim is
 * written: rows and matrices are evaluated in memory of their own. */

typedef struct dmb_cluster_rank {
    uint32_t rows;          /* that act */
    uint32_t rank;          /* by LAPACK, sum of the clusters */
    uint32_t differing;     /* clusters of which the partition has another rank */
    uint32_t poorest;       /* cluster of the condition below */
    double condition;       /* smallest over largest singular value, worst cluster; 1 without equations */
    double violation;       /* [m, -] largest of an equation of position */
    uint32_t violation_row; /* where; DMB_NONE: none */
    uint32_t reserved;
    uint8_t *redundant; /* 1 of rows that are redundant: those the partition drops, or LAPACK's where the two differ;
                           shape (constraint_row_count) */
    void *block;        /* the memory of it */
    size_t block_size;
} dmb_cluster_rank;

/* Fills *rank; its memory is given back by dmb_cluster_rank_release, on error it holds none. Errors: DMB_ERR_NO_MEMORY,
 * DMB_ERR_CALLBACK, DMB_ERR_NOT_FINITE. */
int32_t dmb_cluster_rank_make(const dmb_sim *sim, dmb_cluster_rank *rank);
/* NULL memory and a struct of zeros are fine. */
void dmb_cluster_rank_release(const dmb_sim *sim, dmb_cluster_rank *rank);

/* "joint 3 (crank): rotation about y": a constraint row by name. */
void dmb_constraint_row_text(const dmb_sim *sim, uint32_t row, dmb_message *text);

/* ---- Assembly: cluster_assembly.c -------------------------------------------------------------------------------- */

/* Putting a scene together: shortest moves that satisfy all equations of position (Wehage, Haug 1982), of rigid bodies
 * first, then of strings as rigid bodies, from the described poses or from where joints place them, then of all nodes.
 */

/* Closes the joints from the described poses of now: poses move until every equation holds and joints stand where their
 * initial coordinates say, speeds likewise. Fills counters->assembly. Errors with a message: DMB_ERR_GEOMETRY (the
 * joint that does not fit, and by how much), DMB_ERR_CALLBACK. system/constrain/cluster_assembly */
int32_t dmb_assemble(dmb_sim *sim);
/* Node of a chain from which it is moved; DMB_NONE: it stays, as more than one of its nodes are held, or it is on the
 * axis of the hole. Held components of the node are 0 in `open`. system/constrain/cluster_placement */
uint32_t dmb_chain_base(const dmb_scene *scene, const dmb_chain *chain, double open[6]);
/* Motion of a rigid body, world axes. */
typedef struct dmb_rigid_motion {
    double Q[9];                /* [-] rotation */
    double before[3], after[3]; /* [m] displacement of the node */
    uint32_t node;
    uint32_t reserved;
} dmb_rigid_motion;
/* The other nodes of a chain follow a node that has moved so. */
void dmb_chain_follow(dmb_sim *sim, const dmb_chain *chain, const dmb_rigid_motion *motion);
/* Moves chains of the trial as rigid bodies, one after the other, to where joints hold them at those that were placed
 * before. Joints that close loops may stay open. */
void dmb_place_by_joints(dmb_sim *sim);
/* Refuses a joint whose frames, in the trial, point against each other where it keeps them parallel: its equations hold
 * there too. DMB_ERR_GEOMETRY with a message. */
int32_t dmb_joint_refuse_flip(dmb_sim *sim, uint32_t joint);
/* Largest changes of the speeds from now to trial into counters->projection. */
void dmb_note_projection(dmb_sim *sim);
/* Refuses speeds of the trial that do not satisfy an equation, one that was dropped included: DMB_ERR_GEOMETRY. */
int32_t dmb_assembled_speeds(dmb_evaluation *evaluation);

/* ---- Large clusters ---------------------------------------------------------------------------------------------- */

/* A row of which elimination leaves less than this square of the sine to those before it is redundant. The rows that
 * close a ring of n bodies have 13/n^3, and leave up to 1e-16 n^3 of rounding to redundant ones behind them: measured
 * up to n = 800, where the least is 2.6e-8. */
#define DMB_SPARSE_RANK 1e-9

static inline int32_t dmb_is_sparse(const dmb_scene *scene, uint32_t constraint)
{
    return scene->clusters[scene->constraints[constraint].cluster].sparse;
}

/* Chooses the rows of every sparse cluster from the rows at hand, and tells the quality of the choice. */
void dmb_sparse_choose(dmb_sim *sim);
/* Sizes of blocks and places of the rows that are chosen: the choice may have come back with an older state. */
void dmb_sparse_note(dmb_sim *sim);
/* Factors of the rows at hand in the metric of projections. drop_near_redundant: without rows that those before nearly
 * hold. DMB_OK, or DMB_ERR_SINGULAR with the row for the message. */
int32_t dmb_sparse_factor(dmb_sim *sim, int drop_near_redundant);
/* The same where the factors are not those of the rows at hand. */
int32_t dmb_sparse_refresh(dmb_sim *sim);

/* Least move with B x = d of the chosen rows; d by constraint row. */
void dmb_sparse_project(dmb_sim *sim, const double *d);
/* Result of dmb_sparse_project for cluster k, in its columns. */
void dmb_sparse_get(const dmb_sim *sim, uint32_t k, double *x);
/* d = -(level + B v) in the rows of sparse clusters. */
void dmb_sparse_deficit(const dmb_sim *sim, const double *level, const double *v, double *d);
/* As dmb_clusters_balance, of sparse clusters. */
void dmb_sparse_balance(dmb_sim *sim, int given);
/* As dmb_clusters_least_norm, of sparse clusters. system/constrain/sparse_cluster_least_norm */
void dmb_sparse_least_norm(dmb_sim *sim);
/* As dmb_clusters_violation, of the chosen rows or of the dropped ones; *row stays where there is none. */
double dmb_sparse_violation(const dmb_sim *sim, int32_t dropped, uint32_t *row);

/* Rows of sparse clusters, also for the reduced system: */

/* Row k of a constraint, its columns. */
static inline const double *dmb_sparse_row(const dmb_sim *sim, const dmb_constraint *c, uint32_t k)
{
    return sim->constraint_jacobian + c->jacobian + (size_t)k * c->columns;
}

/* First column of a node in the arrays by columns of clusters. */
static inline uint32_t dmb_sparse_column(const dmb_scene *scene, uint32_t node)
{
    return scene->clusters[scene->node_cluster[node]].column + scene->node_place[node];
}

/* Square of the length of row k of a constraint in weighted columns. */
double dmb_sparse_length(const dmb_sim *sim, const dmb_constraint *c, uint32_t k, const double *weight);
/* sparse_row from sparse_size; returns their sum. */
uint32_t dmb_sparse_number(dmb_sim *sim);
/* The matrix in the sim's memory. */
dmb_block_signed dmb_sparse_matrix(const dmb_sim *sim);

#endif
