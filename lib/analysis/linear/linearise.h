/* The linear system about the accepted state of a sim:
 *
 *     M d'' + C d' + K d = f,     d: small body-frame displacements of the nodes, shape (rows)
 *
 * Six rows (translation; rotation) of a FULL node, H = H0 exp(d), two (along the hole; about its axis) of a PATH node.
 * Rows that guides and motion drives hold are out: their rows and columns are zero. With joints d = R z, z being the
 * independent coordinates of the partition, else z are the rows that are left:
 *
 *     R^T M R z'' + R^T C R z' + R^T K R z = R^T f
 *
 * Velocities of the perturbed motion in the body frame are v + d' + v^ d and accelerations a + d'' + v^ d' + a^ d, with
 * v^ = ad(v): exp(-d) H0^-1 (H0 exp(d))' to first order. With M, C_v = dr/dv and K_H = dr/dH of the residual r that
 * steps solve, at given body-frame v and a,
 *
 *     C = C_v + M v^,     K = K_H + C_v v^ + M a^
 *
 * so that gyroscopic and centrifugal terms of a steadily spinning string are in C and K, whose entries are constant
 * there: it is a relative equilibrium. Elsewhere in a run the coefficients are those of the moment. In axes that do not
 * take part in the spin w about a node's x axis, d is turned back by it, d <- exp(w^ t) d: with g = v - w velocities of
 * the perturbed motion are v + d' + g^ d, accelerations a + d'' + g^ d' - w^ (d' + g^ d) + a^ d, and
 *
 *     C = C_v - M w^ + M g^,     K = K_H + (C_v - M w^) g^ + M a^,
 *
 * constant for what is round, even where a turning string lies on the wall. States that are integrated along with the
 * motion, bristles that stick and the integral part of speed controllers, are stiffness here (the part that v^ d has in
 * it, left out, is none for drives along and about the axis). The memory of a regenerative rock law is not: its past is
 * taken as given. A nonholonomic equation holds d as it holds d'. Friction has the derivative of its law; one that is
 * smooth at rest is a damper there. */
#ifndef DMB_ANALYSIS_LINEAR_LINEARISE_H
#define DMB_ANALYSIS_LINEAR_LINEARISE_H

#include "drillmbd/analysis.h"
#include "sim/sim.h"
#include "system/assemble/evaluation.h"

typedef struct dmb_linear_options {
    int32_t contact;     /* DMB_CONTACT_... of analysis.h */
    int32_t no_friction; /* 1: friction on the wall does not change: it is a dead load */
    double gap;          /* [m] of DMB_CONTACT_CLOSED */
    int32_t still;       /* 1: d in axes that do not spin about the node's x axis */
    int32_t reserved;
    double spin;        /* [rad/s] of the nodes of strings in the state, 0: as they do */
    double load_growth; /* [-] gravity, loads and bit loads act 1 + load_growth times */
} dmb_linear_options;

/* A residual below this part of the forces that balance in it is equilibrium. */
#define DMB_LINEAR_BALANCED 1e-6

/* Blocks in the layout of the scene, and what joints add between their nodes, as constraint_tangent of a sim. */
typedef struct dmb_linear_matrix {
    double *diagonal, *lower, *upper;
    double *joints; /* shape (scene.tangent_count) */
} dmb_linear_matrix;

typedef struct dmb_linear {
    dmb_scene scene; /* that of the sim, contact as asked for */
    dmb_sim *work;   /* a copy of the sim in the state, its factors those of dmb_linear_factor */
    dmb_allocator allocator;
    dmb_linear_matrix mass, damping, stiffness;
    double *with_contacts;    /* [N, N m] residual of the state before contacts are left out, shape (rows) */
    double *residual;         /* [N, N m] residual of the state without its accelerations, shape (rows) */
    double relative_residual; /* [-] the same relative, as of dmb_residual_norm_of; 0: a (relative) equilibrium */
    double largest_force;     /* [N, N m over the element length] largest entry of it that a node feels */
    uint32_t largest_node;    /* where */
    int32_t balanced;         /* 1: what is left is rounding, or below DMB_LINEAR_BALANCED */
    int32_t slides;           /* 1: axes at rest balance it better than body-frame velocities that stay as they are */
    uint32_t rows;            /* of the scene */
    double *stiffness_size;   /* [N/m, N m] |K_ii| with the joints' parts, shape (rows) */
    uint32_t coordinates;     /* length of z */
    uint32_t *row_of;         /* row that coordinate i is the displacement of, ascending, shape (coordinates) */
    uint32_t *start, *column; /* R by rows: entries start[row] .. start[row + 1] - 1 */
    double *value;
    double load_factor;   /* [-] of gravity, loads and bit loads */
    double *spin, *rest;  /* velocities of the state: what the axes of d leave out, and the others, shape (rows) */
    double *held_columns; /* columns of M, C_v and K_H of the rows that are held, in the rows of the node before, the
                             node and the node after, six each: what a drive that moves them exerts on the others;
                             shape (scene.held_count, 3, 18) */
    double *held_rows;    /* their rows of M, C and K by what is not held, likewise: what the others exert on them */
    double *whole_joints; /* the joints' parts of M, C and K, rows and columns that are held included, shape
                             (3, scene.tangent_count) */
    void *block;
    size_t block_size;
} dmb_linear;

/* Linearises; the sim is untouched. Memory from the sim's allocator; dmb_linear_release gives it back, *linear is NULL
 * on error. Callbacks of constraints are called. Errors: DMB_ERR_NO_MEMORY, _CALLBACK, _NOT_FINITE, _ROTATION,
 * _SINGULAR. */
int32_t dmb_linear_make(const dmb_sim *sim, const dmb_linear_options *options, dmb_linear **linear);
void dmb_linear_release(dmb_linear **linear);

/* Entry of component c of a node on the diagonal of A. */
static inline double dmb_linear_diagonal(const dmb_linear *linear, const dmb_linear_matrix *A, uint32_t node,
                                         uint32_t c)
{
    const dmb_block_layout *layout = &linear->scene.layout;
    return A->diagonal[layout->diag[node] + (size_t)(layout->size[node] + 1) * c];
}
/* Of a displacement 1, of a rotation the square of the length scale. */
static inline double dmb_linear_weight(const dmb_linear *linear, uint32_t node, uint32_t c)
{
    return 2 * c < linear->scene.layout.size[node] ? 1.0 : linear->scene.length_scale * linear->scene.length_scale;
}
/* [N/m] per weight, what a stiffness is measured by that is less: such a one may be rounding of others. */
double dmb_linear_stiffness_at_least(const dmb_linear *linear);
/* [N/m] that DMB_CONTACT_CLOSED has put behind ring number `site`, which does not touch; 0: nothing. */
double dmb_linear_wall_stiffness(const dmb_linear *linear, uint32_t site, double gap);

/* A = 0. */
void dmb_linear_clear(const dmb_linear *linear, dmb_linear_matrix *A);
/* y = A x by rows, x and y apart. */
void dmb_linear_multiply(const dmb_linear *linear, const dmb_linear_matrix *A, const double *x, double *y);
/* y = |A| |x|: the size of the terms that add up to A x. */
void dmb_linear_terms(const dmb_linear *linear, const dmb_linear_matrix *A, const double *x, double *y);
/* d = R z, shape (rows) from (coordinates); rows that are held become 0. */
void dmb_linear_expand(const dmb_linear *linear, const double *z, double *d);
/* g = R^T f, shape (coordinates) from (rows). */
void dmb_linear_restrict(const dmb_linear *linear, const double *f, double *g);
/* g = |R|^T |f|. */
void dmb_linear_restrict_terms(const dmb_linear *linear, const double *f, double *g);
/* R^T A R, shape (coordinates, coordinates), column by column; work: shape (2 rows + coordinates). */
void dmb_linear_dense(const dmb_linear *linear, const dmb_linear_matrix *A, double *work, double *out);
/* [-] |x.Ky - y.Kx| for x, y of random numbers over the roots of the stiffness: of rounding size where K is symmetric.
 */
double dmb_linear_asymmetry(const dmb_linear *linear, double *work);
/* 1 if something is elastic and no motion meets a damping force, or one that drives it; work: shape (3 rows +
 * coordinates). */
int32_t dmb_linear_is_undamped(const dmb_linear *linear, double *work);

/* Factors k K + c C + m M in `work`: block-tridiagonal, block-sparse where joints connect. Node of a singular block, or
 * -1; weakest may be NULL. */
int64_t dmb_linear_factor(dmb_linear *linear, double k, double c, double m, dmb_block_weakest *weakest);
/* Eigenvalues of K d = square M d below `square`, by the signs of the factors of K - square M (Sylvester); without
 * joints only. The factors of dmb_linear_factor are gone then. */
uint32_t dmb_linear_count_below(dmb_linear *linear, double square);
/* The same with joints too; -1 where a block is singular there. */
int64_t dmb_linear_count(dmb_linear *linear, double square);
/* Negative eigenvalues of the symmetric part of k K + c C + m M, without joints only. The factors are gone then. */
uint32_t dmb_linear_negative(dmb_linear *linear, double k, double c, double m);
/* x <- R (R^T A R)^-1 R^T x by rows, A as factored last. */
void dmb_linear_solve(dmb_linear *linear, double *x);

/* Functions shared by the files of dmb_linear_make. */

/* Memory for the matrices about the state of a sim, and a copy of it to work on; NULL without memory. */
dmb_linear *dmb_linear_allocate(const dmb_sim *sim);

/* An evaluation of the state with its accelerations. */
dmb_evaluation dmb_linear_evaluation(const dmb_linear *linear);
/* Residual of the forces where body-frame velocities stay as they are. */
int32_t dmb_linear_take_balance(dmb_linear *linear);
/* Of a state that is balanced. */
void dmb_linear_take_steady_accelerations(dmb_linear *linear);
/* The residual counts as balanced where it is no more than rounding of the poses; K is there. */
void dmb_linear_judge_rounding(dmb_linear *linear);

static inline void dmb_linear_add_array(double factor, const double *from, size_t count, double *to)
{
    for (size_t i = 0; i < count; i++) to[i] += factor * from[i];
}
/* to += factor from, all of their blocks. */
void dmb_linear_add(const dmb_scene *scene, double factor, const dmb_linear_matrix *from, dmb_linear_matrix *to);
/* to += factor A blkdiag(v^), v by rows; a PATH node turns about its own axis alone and has none. */
void dmb_linear_add_products(const dmb_scene *scene, double factor, const dmb_linear_matrix *A, const double *rows,
                             dmb_linear_matrix *to);
/* stiffness_size of the stiffness as it is. */
void dmb_linear_take_stiffness_size(dmb_linear *linear);
/* The blocks of stiffness of a sim. */
dmb_linear_matrix dmb_linear_stiffness_of(const dmb_sim *work);
/* The tangents by pose and acceleration, and after them that by velocity. */
int32_t dmb_linear_take_stiffness_and_mass(dmb_linear *linear);
int32_t dmb_linear_take_damping(dmb_linear *linear);

/* C and K with the velocities of the axes of d (still: those that do not spin), and what is held is cleared. */
void dmb_linear_turn_frames(dmb_linear *linear, int32_t still);

/* The scene without what is not to act: the wall, or the change of its friction. */
void dmb_linear_freeze(dmb_linear *linear, const dmb_linear_options *options);
/* Forces that the frozen scene lacks stay as dead loads. `before`: residual with them, shape (rows). */
void dmb_linear_add_dead_loads(dmb_linear *linear, const double *before);
/* Stiffness of the wall under rings up to `gap` [m] from it. */
void dmb_linear_close_contacts(dmb_linear *linear, double gap);

/* Keeps the columns (1), or rows (0), of what is held. */
void dmb_linear_keep_held(dmb_linear *linear, int columns);
/* Clears them. */
void dmb_linear_hold(dmb_linear *linear, int columns);
/* whole_joints += factor times the joints' parts as they are. */
void dmb_linear_add_whole_joints(dmb_linear *linear, double factor);

/* R and the rows of its coordinates. DMB_ERR_NO_MEMORY. */
int32_t dmb_linear_make_coordinates(dmb_linear *linear);

/* The stiffness of a static state, as the static iteration leaves it, and what its signs tell. */

/* Factors the iteration matrix in the stiffness_ blocks (held rows identity) as dmb_factor_stiffness, and counts its
 * negative eigenvalues in the independent coordinates, of its symmetric part where friction makes it unsymmetric. A
 * pivot that is 0 but for rounding does not count in chains without joints: a buckled column may turn about its load.
 */
int64_t dmb_stiffness_factor(dmb_sim *sim, dmb_block_weakest *weakest, int32_t *negative);
/* Of the chains that no joint connects, from the iteration matrix as it is formed; raised by rounding: *rounding [N/m]
 * of displacements, below which an eigenvalue counts as 0. */
uint32_t dmb_stiffness_negative_of_chains(const dmb_sim *sim, double *rounding);
/* DMB_ERR_ORDER, with a message of `who` in sim, unless the residual just evaluated is that of an equilibrium. */
int32_t dmb_stiffness_balanced(dmb_sim *sim, const char *who, const dmb_evaluation *evaluation);
/* Tells which part nothing holds. DMB_ERR_SINGULAR. */
int32_t dmb_stiffness_explain(dmb_sim *sim, const char *who, uint32_t node);

#endif
