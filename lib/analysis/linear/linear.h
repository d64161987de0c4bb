/* Linearisation of a scene about a state: matrices, outputs as linear functions of the motion, dynamic stiffness. */
#ifndef DMB_ANALYSIS_LINEAR_LINEAR_H
#define DMB_ANALYSIS_LINEAR_LINEAR_H

#include "base/memory.h"
#include "drillmbd/analyse.h"
#include "kernel/kernels.h"
#include "math/block_kernel.h"
#include "math/complex_sparse.h"
#include "sim/sim.h"
#include "system/assemble/evaluation.h"

/* ---- The linearised scene ---------------------------------------------------------------------------------------- */

typedef struct dmb_linear_options {
    int32_t contact;       /* DMB_CONTACT_... of analysis.h */
    int32_t no_friction;   /* 1: friction on the wall is constant (a dead load) */
    double gap;            /* [m] of DMB_CONTACT_CLOSED */
    int32_t inertial_axes; /* 1: d in axes that do not spin about the node's x axis */
    int32_t reserved;
    double spin;        /* [rad/s] spin of the strings in the state; 0: as in the state */
    double load_growth; /* [-] gravity, loads and bit loads are multiplied by 1 + load_growth */
} dmb_linear_options;

/* [-] Residual over its terms below which the state is an equilibrium. */
#define DMB_LINEAR_BALANCED 1e-6

/* Blocks in the layout of the scene, and contributions of joints between their nodes, as constraint_tangent of a sim.
 */
typedef struct dmb_linear_matrix {
    double *diagonal, *lower, *upper;
    double *joints; /* shape (scene.tangent_count) */
} dmb_linear_matrix;

typedef struct dmb_linear {
    dmb_scene scene; /* the sim's scene with the requested contact */
    dmb_sim *work;   /* a copy of the sim in the state; its factors are those of dmb_linear_factor */
    dmb_allocator allocator;
    dmb_linear_matrix mass, damping, stiffness;
    double *with_contacts;    /* [N, N m] residual of the state with contacts, shape (rows) */
    double *residual;         /* [N, N m] residual of the state without its accelerations, shape (rows) */
    double relative_residual; /* [-] relative residual (dmb_residual_norm_of); 0: a (relative) equilibrium */
    double largest_force;     /* [N, N m over the element length] its largest entry in a solved row */
    uint32_t largest_node;    /* where */
    int32_t balanced;         /* 1: it is rounding, or below DMB_LINEAR_BALANCED */
    int32_t slides;           /* 1: the balance is better with axes at rest than with constant body-frame velocities */
    int32_t inertial_axes;    /* from the options: axes of d do not spin */
    uint32_t rows;            /* of the scene */
    double *stiffness_size;   /* [N/m, N m] |K_ii| with the joints' parts, shape (rows) */
    uint32_t coordinates;     /* length of z */
    uint32_t *row_of;         /* row displaced by coordinate i, ascending, shape (coordinates) */
    uint32_t *start, *column; /* R by rows: entries start[row] .. start[row + 1] - 1 */
    double *value;
    uint32_t turning;      /* a constraint whose equations change with the motion of the state; DMB_NONE: none */
    int32_t rolls;         /* 1: they change in any axes, for example rolling */
    uint32_t turning_node; /* a node rotating on the wall in co-rotating axes; DMB_NONE: none */
    double load_factor;    /* [-] factor of gravity, loads and bit loads */
    double *spin, *rest;   /* velocities of the state: spin omitted by the axes of d, and the remainder, shape (rows) */
    double *change;        /* rate of the remainder in those axes: 0 in an equilibrium, shape (rows) */
    double *constrained_columns; /* columns of M, C_v and K_H of constrained rows, in the rows of the node before, of
                                    the node and of the node after, six each: the effect of prescribed motion on other
                                    rows; shape (scene.constrained_count, 3, 18) */
    /* their rows of M, C and K by solved rows, same shape: forces on constrained rows */
    double *constrained_rows;
    double *whole_joints; /* contributions of joints to M, C and K, including constrained rows and columns, shape (3,
                             scene.tangent_count) */
    void *block;
    size_t block_size;
} dmb_linear;

/* Linearises; the sim is unchanged. Memory from the sim's allocator; dmb_linear_release frees it, *linear is NULL on
 * error. Callbacks of constraints are called. Errors: DMB_ERR_NO_MEMORY, _CALLBACK, _NOT_FINITE, _ROTATION, _SINGULAR.
 */
int32_t dmb_linear_make(const dmb_sim *sim, const dmb_linear_options *options, dmb_linear **linear);
void dmb_linear_release(dmb_linear **linear);
/* Finds a constraint whose equations change in the axes of d with the motion of the state of `sim`, and a node rotating
 * on the wall: then coefficients of R^T M R z'' + .. = 0 are not constant. dmb_linear_check_coefficients fails for both
 * with a message of `who`: DMB_ERR_UNSUPPORTED; dmb_linear_note_coefficients reports that such terms are neglected:
 * DMB_NOTE_INCOMPLETE. */
int32_t dmb_linear_find_turning(dmb_linear *linear, const dmb_sim *sim);
void dmb_linear_find_turning_on_wall(dmb_linear *linear, const dmb_linear_options *options);
int32_t dmb_linear_check_coefficients(const dmb_linear *linear, const char *who, dmb_message *message);
int32_t dmb_linear_note_coefficients(const dmb_linear *linear, const char *who, dmb_message *message);

/* The scene linearised again after further rotation of its rotating parts; NULL without rotating parts. */
typedef struct dmb_linear_turned {
    dmb_linear *linear;
    double *angle; /* [rad] further rotation of nodes relative to the axes of d, shape (node_count), and workspace */
    size_t bytes;
    double spin;   /* [rad/s] of the fastest rotating part */
    double change; /* [-] largest change so far, and its node */
    uint32_t node;
    uint32_t reserved;
} dmb_linear_turned;

/* sim, options: as of `linear`. Errors as dmb_linear_make; `out` is released by the caller in any case. */
int32_t dmb_linear_turn_on(const dmb_linear *linear, const dmb_sim *sim, const dmb_linear_options *options,
                           dmb_linear_turned *out);
void dmb_linear_turned_release(dmb_linear_turned *turned, const dmb_allocator *allocator);
/* [-] Relative change of the forces of a motion d e^(s t) while parts rotate, d = re + i im by rows, im may be NULL. */
double dmb_linear_change_of(dmb_linear_turned *turned, const dmb_linear *linear, const double s[2], const double *re,
                            const double *im);
/* DMB_ERR_UNSUPPORTED with a message of `who` and `then` the remedy, if the largest change exceeds 1e-4. */
int32_t dmb_linear_check_change(const dmb_linear_turned *turned, const char *who, const char *then,
                                dmb_message *message);

/* Entry of component c of a node on the diagonal of A. */
static inline double dmb_linear_diagonal(const dmb_linear *linear, const dmb_linear_matrix *A, uint32_t node,
                                         uint32_t c)
{
    const dmb_block_layout *layout = &linear->scene.layout;
    return A->diagonal[layout->diag[node] + (size_t)(layout->size[node] + 1) * c];
}
/* Weight of a row: 1 of a displacement, the squared length scale of a rotation. */
static inline double dmb_linear_weight(const dmb_linear *linear, uint32_t node, uint32_t c)
{
    return 2 * c < linear->scene.layout.size[node] ? 1.0 : linear->scene.length_scale * linear->scene.length_scale;
}
/* [N/m] Smallest resolved stiffness per weight: a smaller one may be rounding of others. */
double dmb_linear_stiffness_at_least(const dmb_linear *linear);
/* [N/m] Stiffness added by DMB_CONTACT_CLOSED at the open contact point `site`; 0: none. */
double dmb_linear_wall_stiffness(const dmb_linear *linear, uint32_t site, double gap);

/* A = 0. */
void dmb_linear_clear(const dmb_linear *linear, dmb_linear_matrix *A);
/* y = A x by rows, x and y apart. */
void dmb_linear_multiply(const dmb_linear *linear, const dmb_linear_matrix *A, const double *x, double *y);
/* y = |A| |x|: the size of the terms of A x. */
void dmb_linear_terms(const dmb_linear *linear, const dmb_linear_matrix *A, const double *x, double *y);
/* d = R z, shape (rows) from (coordinates); constrained rows become 0. */
void dmb_linear_expand(const dmb_linear *linear, const double *z, double *d);
/* g = R^T f, shape (coordinates) from (rows). */
void dmb_linear_restrict(const dmb_linear *linear, const double *f, double *g);
/* g = |R|^T |f|. */
void dmb_linear_restrict_terms(const dmb_linear *linear, const double *f, double *g);
/* R^T A R, shape (coordinates, coordinates), column by column; work: shape (2 rows + coordinates). */
void dmb_linear_dense(const dmb_linear *linear, const dmb_linear_matrix *A, double *work, double *out);
/* [-] |x.Ky - y.Kx| for x, y of random numbers over the square roots of the stiffness: of rounding size if K is
 * symmetric. */
double dmb_linear_asymmetry(const dmb_linear *linear, double *work);
/* 1 if the scene has stiffness and no motion has a damping (or negative damping) force; work: shape (3 rows +
 * coordinates). */
int32_t dmb_linear_is_undamped(const dmb_linear *linear, double *work);

/* Factorises k K + c C + m M in `work`: block-tridiagonal, block-sparse with joints. Node of a singular block, or -1;
 * weakest may be NULL. */
int64_t dmb_linear_factor(dmb_linear *linear, double k, double c, double m, dmb_block_weakest *weakest);
/* Eigenvalues of K d = square M d below `square`, by the signs of the factors of K - square M (Sylvester); without
 * joints only. Overwrites the factors of dmb_linear_factor. */
uint32_t dmb_linear_count_below(dmb_linear *linear, double square);
/* The same, also with joints; -1 if a block is singular there. */
int64_t dmb_linear_count(dmb_linear *linear, double square);
/* Negative eigenvalues of the symmetric part of k K + c C + m M, without joints only. Overwrites the factors. */
uint32_t dmb_linear_negative(dmb_linear *linear, double k, double c, double m);
/* x <- R (R^T A R)^-1 R^T x by rows, A as factored last. */
void dmb_linear_solve(dmb_linear *linear, double *x);

/* Functions shared by the files of dmb_linear_make. */

/* Memory for the matrices, and a copy of the state of the sim for evaluations; NULL without memory. */
dmb_linear *dmb_linear_allocate(const dmb_sim *sim);

/* An evaluation of the state with its accelerations. */
dmb_evaluation dmb_linear_evaluation(const dmb_linear *linear);
/* Residual of the forces at constant body-frame velocities. */
int32_t dmb_linear_evaluate_balance(dmb_linear *linear);
/* Steady accelerations of an equilibrium. */
void dmb_linear_set_steady_accelerations(dmb_linear *linear);
/* The residual counts as balanced if it is at most the rounding of the poses; requires K. */
void dmb_linear_judge_rounding(dmb_linear *linear);

static inline void dmb_linear_add_array(double factor, const double *from, size_t count, double *to)
{
    for (size_t i = 0; i < count; i++) to[i] += factor * from[i];
}
/* to += factor from, all of their blocks. */
void dmb_linear_add(const dmb_scene *scene, double factor, const dmb_linear_matrix *from, dmb_linear_matrix *to);
/* to += factor A blkdiag(v^), v by rows; an axial-torsional node rotates about its own axis only and has none. */
void dmb_linear_add_products(const dmb_scene *scene, double factor, const dmb_linear_matrix *A, const double *rows,
                             dmb_linear_matrix *to);
/* Sets stiffness_size from the present stiffness. */
void dmb_linear_set_stiffness_size(dmb_linear *linear);
/* The blocks of stiffness of a sim. */
dmb_linear_matrix dmb_linear_stiffness_of(const dmb_sim *work);
/* The tangents by pose and acceleration, and after them that by velocity. */
int32_t dmb_linear_read_stiffness_and_mass(dmb_linear *linear);
int32_t dmb_linear_read_damping(dmb_linear *linear);

/* C and K for the velocities of the axes of d (inertial_axes: axes that do not spin); clears constrained rows and
 * columns. */
void dmb_linear_turn_frames(dmb_linear *linear, int32_t inertial_axes);

/* The scene without inactive terms: the wall, or the change of its friction. */
void dmb_linear_finalise(dmb_linear *linear, const dmb_linear_options *options);
/* Forces missing in the finalised scene act as dead loads. `before`: residual with them, shape (rows). */
void dmb_linear_add_dead_loads(dmb_linear *linear, const double *before);
/* Adds the stiffness of the wall at contact points within `gap` [m] of it. */
void dmb_linear_close_contacts(dmb_linear *linear, double gap);

/* Copies the columns (1), or rows (0), of constrained rows. */
void dmb_linear_keep_constrained(dmb_linear *linear, int columns);
/* Clears them. */
void dmb_linear_hold(dmb_linear *linear, int columns);
/* whole_joints += factor times the present contributions of joints. */
void dmb_linear_add_whole_joints(dmb_linear *linear, double factor);

/* R and the rows of its coordinates. DMB_ERR_NO_MEMORY. */
int32_t dmb_linear_make_coordinates(dmb_linear *linear);

/* ---- The stiffness of a static state (stiffness_signs.c) --------------------------------------------------------- */

/* Stiffness as left by the static iteration in the stiffness_ blocks, with constrained rows as identity. */

/* Factorises it as dmb_factor_stiffness, and counts its negative eigenvalues in the independent coordinates, of its
 * symmetric part if friction makes it non-symmetric; those of rounding size are not counted in chains without joints: a
 * buckled column may rotate about its load. */
int64_t dmb_stiffness_factor(dmb_sim *sim, dmb_block_weakest *weakest, int32_t *negative);

typedef struct dmb_signs {
    int32_t negative;   /* [-] number of negative eigenvalues beyond rounding; -1: not determined */
    int32_t unresolved; /* [-] number of eigenvalues of rounding size, whose signs are unknown */
    double bound;       /* [N/m] largest size of those */
} dmb_signs;

/* Signs of the eigenvalues of K, symmetric, before factorisation and unchanged, with the residual of its state. both 0:
 * `unresolved` is not determined, at half the cost. amount (rows; may be NULL): amount added to and subtracted from the
 * diagonal (eq:signs.amount). Overwrites the reduced system. DMB_ERR_NO_MEMORY. */
int32_t dmb_stiffness_signs_of(dmb_sim *sim, int both, double *amount, dmb_signs *out);
void dmb_stiffness_amounts(const dmb_sim *sim, double *amount);
/* [N/m] Rounding of the Rayleigh quotient of a shape x (rows) in K x = mu D x, D the weights 1 of displacements and
 * length_scale^2 of rotations. */
double dmb_stiffness_rounding_of(const dmb_sim *sim, const double *amount, const double *x);
/* [N/m] Largest diagonal entry, rotations over the square of the length scale. */
double dmb_stiffness_largest(const dmb_sim *sim);
/* DMB_ERR_ORDER, with a message of `who` in sim, unless the residual just evaluated is that of an equilibrium. */
int32_t dmb_stiffness_balanced(dmb_sim *sim, const char *who, const dmb_evaluation *evaluation);
/* Reports the unconstrained part. DMB_ERR_SINGULAR. */
int32_t dmb_stiffness_explain(dmb_sim *sim, const char *who, uint32_t node);

/* ---- Functionals of the motion ----------------------------------------------------------------------------------- */

/* Output as a linear function of the motion about a state: the result of a query for a small motion q, q', q'' of the
 * rows. */

/* Four neighbouring nodes: the two of an element and one on either side. */
enum { DMB_FUNCTIONAL_ROWS = 24 };

/* value = sum over the rows of pose q + speed q' + acceleration q'' */
typedef struct dmb_functional {
    uint32_t count;
    uint32_t row[DMB_FUNCTIONAL_ROWS];
    double pose[DMB_FUNCTIONAL_ROWS];
    double speed[DMB_FUNCTIONAL_ROWS];
    double acceleration[DMB_FUNCTIONAL_ROWS];
} dmb_functional;

/* Displacement or rotation of a place in its axes (DMB_FRAME_BODY) or those of the world; by duality also the rows of a
 * unit force or moment there. copy: a sim of the state; its trial is written. Errors: those of dmb_query_motion.
 * O(rows). */
int32_t dmb_functional_of_motion(dmb_sim *copy, dmb_place place, int32_t frame, int32_t component, dmb_functional *out);

/* Rows of the nodes around a place: its node or two nodes, and one more on either side, with coefficients 0. copy and
 * errors as above. */
int32_t dmb_functional_around(dmb_sim *copy, dmb_place place, dmb_functional *out);
/* Adds the rows of a node unless they are included. */
void dmb_functional_add_node(const dmb_scene *scene, uint32_t node, dmb_functional *out);
/* A result that depends on the nodes in `out` alone, smooth in their poses, linear in their accelerations and at most
 * of second degree in their speeds. copy: linear->work, as before on return. */
typedef double dmb_answer(const dmb_sim *copy, const void *what);
void dmb_functional_of_answer(dmb_linear *linear, dmb_answer *answer, const void *what, dmb_functional *out);
/* Converts speeds and accelerations from the body frames of the moved nodes to the rotating axes of d. */
void dmb_functional_turn_frames(const dmb_linear *linear, dmb_functional *out);
/* to += factor from, of the same rows. */
void dmb_functional_add(double factor, const dmb_functional *from, dmb_functional *to);
/* Adds its rate: coefficients of the pose become those of the speed. */
void dmb_functional_add_rate(double factor, const dmb_functional *from, dmb_functional *to);

/* Present results of queries, for outputs of a response. */

/* Kinds of motions and forces that outputs of linear analyses are. */
enum {
    DMB_ASKED_DISPLACEMENT = 0, /* of `place`, components along the axes of `frame` */
    DMB_ASKED_VELOCITY = 1,
    DMB_ASKED_ACCELERATION = 2,
    DMB_ASKED_SECTION_FORCE = 3,
    DMB_ASKED_SECTION_STRAIN = 4,
    DMB_ASKED_CONTACT = 5, /* contact point place.pipe: DMB_X, DMB_Y friction, DMB_Z normal force */
    DMB_ASKED_DRIVE = 6,
    DMB_ASKED_REACTION = 7,
    DMB_ASKED_JOINT_POSITION = 8,
    DMB_ASKED_JOINT_SPEED = 9,
    DMB_ASKED_JOINT_ACCELERATION = 10,
    DMB_ASKED_JOINT_REACTION = 11,
    DMB_ASKED_JOINT_ACTION = 12,
    DMB_ASKED_MULTIPLIER = 13, /* number `component` */
    DMB_ASKED_BIT = 14,        /* DMB_X weight, DMB_RX torque by the rock law */
    DMB_ASKED_OUTPUT = 15      /* `component` is its DMB_OUTPUT_...: a smooth function about its place */
};

/* An output by the motion or force that it is. */
typedef struct dmb_asked_output {
    int32_t kind; /* DMB_ASKED_... */
    int32_t component;
    int32_t frame; /* DMB_FRAME_... */
    int32_t reserved;
    dmb_place place;
} dmb_asked_output;

/* The value of an output of any kind but DMB_ASKED_DISPLACEMENT, which depends on its reference. *status: errors of
 * the query. */
double dmb_answer_of(const dmb_sim *sim, const dmb_asked_output *output, int32_t *status);

/* ---- Dynamic stiffness ------------------------------------------------------------------------------------------- */

typedef struct dmb_complex_number {
    double re, im;
} dmb_complex_number;

/* The system R^T A R of chains that joints connect, in the blocks of the scene's pattern. */
typedef struct dmb_jointed_chains {
    uint32_t count;            /* number of coordinates; also 0 if joints leave none */
    uint32_t widest;           /* the most coordinates of a block */
    uint32_t *size, *row;      /* of each block: coordinates, and the first of them, shape (blocks of the scene) */
    uint32_t *place;           /* of coordinate i of the linear system among them; DMB_NONE: none */
    dmb_block_pattern pattern; /* the scene's, with offsets of blocks of these sizes, without gaps */
    double *blocks[3];         /* R^T M R, R^T C R and R^T K R, shape (values of the pattern) */
    dmb_complex_sparse matrix;
    dmb_complex_array solution;   /* shape (count) */
    double *half;                 /* A_ij R_j, shape (6, the widest block) */
    dmb_complex_array multiplier; /* of one cluster, shape (the most rows of a cluster) */
    double *rest;                 /* forces that constraints balance, shape (2, the most rows of a cluster) */
    double *stiffness, *mass;     /* scales of pivots: diagonals of R^T |K| R and R^T |M| R, shape (count) */
} dmb_jointed_chains;

typedef struct dmb_dynamic_stiffness {
    const dmb_linear *linear;
    double structural_damping;        /* [-] eta */
    double omega;                     /* [rad/s] of the present factors */
    double growth;                    /* [1/s] of the present factors; 0 of a response */
    dmb_complex_block_matrix factors; /* of chains without joints */
    dmb_complex_array prescribed;     /* p, shape (rows) */
    dmb_jointed_chains links;
    void *block;
    size_t block_size;
} dmb_dynamic_stiffness;

/* DMB_OK or DMB_ERR_NO_MEMORY; release gives the memory back and takes a struct of zeros too. */
int32_t dmb_dynamic_stiffness_make(const dmb_linear *linear, double structural_damping, dmb_dynamic_stiffness *out);
void dmb_dynamic_stiffness_release(dmb_dynamic_stiffness *stiffness);

/* Factorises at w. Returns an unconstrained node, or -1. */
int64_t dmb_dynamic_stiffness_factor(dmb_dynamic_stiffness *stiffness, double omega);
/* The same at growth + i omega. */
int64_t dmb_dynamic_stiffness_factor_at(dmb_dynamic_stiffness *stiffness, double growth, double omega);
/* x, shape (rows): forces on entry (ignored in constrained rows), displacements of all rows on return. moves 1:
 * prescribed displacements p on entry. */
void dmb_dynamic_stiffness_solve(dmb_dynamic_stiffness *stiffness, int32_t moves, dmb_complex_array x);

/* Stores displacements p prescribed by drives, and replaces x by the forces -A p, at growth and omega of `stiffness`.
 */
void dmb_dynamic_set_prescribed(dmb_dynamic_stiffness *stiffness, dmb_complex_array x);
/* x += p as stored last. */
void dmb_dynamic_add_prescribed(const dmb_dynamic_stiffness *stiffness, dmb_complex_array x);
/* Entries of A at the present frequency from those of M, C and K. */
static inline void dmb_dynamic_assemble(const dmb_dynamic_stiffness *s, size_t count, const double *restrict M,
                                        const double *restrict C, const double *restrict K, dmb_complex_array A)
{
    double *restrict re = A.re, *restrict im = A.im;
    const double w = s->omega, w2 = w * w, eta = s->structural_damping, g = s->growth;
    for (size_t i = 0; i < count; i++) re[i] = K[i] - w2 * M[i];
    for (size_t i = 0; i < count; i++) im[i] = w * C[i] + eta * K[i];
    if (g == 0.0) return;
    for (size_t i = 0; i < count; i++) re[i] += g * (C[i] + g * M[i]);
    for (size_t i = 0; i < count; i++) im[i] += 2.0 * g * w * M[i];
}

/* Responses at up to DMB_FREQUENCIES frequencies in lanes (eq:response.direct); same bits as one frequency at a time.
 * Right-hand sides of jointed chains are in independent coordinates, behind those of all rows. */
typedef struct dmb_dynamic_group {
    dmb_dynamic_stiffness *stiffness;
    uint32_t columns;              /* capacity for right-hand sides of each frequency */
    uint32_t used;                 /* frequencies */
    double omega[DMB_FREQUENCIES]; /* [rad/s] */
    double *sides, *work;          /* as in dmb_response_args; work also of dmb_jointed_response_args */
    void *block;
    size_t block_size;
} dmb_dynamic_group;

/* DMB_OK or DMB_ERR_NO_MEMORY; release gives the memory back and takes a struct of zeros too. */
int32_t dmb_dynamic_group_make(dmb_dynamic_stiffness *stiffness, uint32_t columns, dmb_dynamic_group *out);
void dmb_dynamic_group_release(dmb_dynamic_group *group);
/* Right-hand side of a frequency, x and moves as in dmb_dynamic_stiffness_solve; x is written. */
void dmb_dynamic_group_put(dmb_dynamic_group *group, uint32_t frequency, uint32_t column, int32_t moves,
                           dmb_complex_array x);
/* Solves for the first `columns` right-hand sides. One bit for each frequency without a solution because of an
 * unconstrained motion; dmb_dynamic_stiffness_factor finds its node. */
uint32_t dmb_dynamic_group_solve(dmb_dynamic_group *group, uint32_t columns);
/* Displacements; moves 1: x holds the displacements p on entry. Sets the frequency of the stiffness, for
 * dmb_dynamic_row. */
void dmb_dynamic_group_get(dmb_dynamic_group *group, uint32_t frequency, uint32_t column, int32_t moves,
                           dmb_complex_array x);

/* 1 if the reciprocal of a pivot is so large that its row is unconstrained except for rounding at this frequency. */
static inline int32_t dmb_dynamic_is_unconstrained(const dmb_dynamic_stiffness *s, double re, double im,
                                                   double stiffness, double mass)
{
    const double a = re < 0.0 ? -re : re, b = im < 0.0 ? -im : im;
    const double square = s->omega * s->omega + s->growth * s->growth;
    return (a > b ? a : b) * (stiffness + square * mass) * DMB_UNCONSTRAINED_PIVOT > 1.0;
}

/* An entry of A at the present frequency from those of M, C and K. */
static inline dmb_complex_number dmb_dynamic_entry(const dmb_dynamic_stiffness *s, double mass, double damping,
                                                   double stiffness)
{
    const double w = s->omega, g = s->growth;
    dmb_complex_number a = {stiffness - w * w * mass, w * damping + s->structural_damping * stiffness};
    if (g == 0.0) return a;
    a.re += g * (damping + g * mass);
    a.im += 2.0 * g * w * mass;
    return a;
}

/* Dynamic stiffness of jointed chains: R^T A R in complex blocks, one per constraint component and one per other node,
 * factored in the order of the scene's pattern. Its cost grows with the number of blocks, and with the cube of the
 * coordinates of one cluster. */

static inline dmb_complex_array dmb_complex_lay_out(dmb_arena *arena, size_t count)
{
    dmb_complex_array array;
    array.re = DMB_ARENA_DOUBLES(arena, count);
    array.im = DMB_ARENA_DOUBLES(arena, count);
    return array;
}

/* Sizes to begin with: `count`, the widest block, the most rows of constraint of a cluster. */
typedef struct dmb_jointed_chains_size {
    uint32_t count, widest, rows;
} dmb_jointed_chains_size;

dmb_jointed_chains_size dmb_jointed_chains_sizes(const dmb_linear *linear);
void dmb_jointed_chains_lay_out(dmb_arena *arena, const dmb_linear *linear, dmb_jointed_chains_size size,
                                dmb_jointed_chains *out);
/* Numbers the coordinates and computes the blocks; `size` as laid out with. */
void dmb_jointed_chains_number(const dmb_linear *linear, dmb_jointed_chains_size size, dmb_jointed_chains *out);
/* Factorises at the present frequency. Returns an unconstrained node, or -1. */
int64_t dmb_jointed_chains_factor(dmb_dynamic_stiffness *stiffness);
/* Rows of jointed chains: solution = R^T x, and x = R solution. */
void dmb_jointed_chains_restrict(const dmb_dynamic_stiffness *stiffness, dmb_complex_array x);
void dmb_jointed_chains_expand(const dmb_dynamic_stiffness *stiffness, dmb_complex_array x);
/* Rows of jointed chains of x: forces in, displacements out. */
void dmb_jointed_chains_solve(dmb_dynamic_stiffness *stiffness, dmb_complex_array x);

/* Forces of a motion at one frequency: products with the full dynamic stiffness A, including constrained rows, and the
 * constraint forces that balance them,
 *
 *     A x + B^T multiplier = f
 *
 * in the dependent rows of each cluster of joints. The residual in rows that are held is the force of their supports.
 */

/* y -= A p in the rows that are solved. */
void dmb_dynamic_subtract(const dmb_dynamic_stiffness *stiffness, dmb_complex_array p, dmb_complex_array y);
/* Row of component c of a node of A x. */
dmb_complex_number dmb_dynamic_row(const dmb_dynamic_stiffness *stiffness, uint32_t node, uint32_t c,
                                   dmb_complex_array x);
/* Multipliers of the rows of cluster k, of least norm where some are redundant, shape (rows of the cluster). x, f:
 * shape (rows). */
void dmb_dynamic_multipliers(const dmb_dynamic_stiffness *stiffness, uint32_t k, dmb_complex_array x,
                             dmb_complex_array f, dmb_complex_array multipliers);

#endif
