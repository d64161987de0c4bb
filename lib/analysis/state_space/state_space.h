/* State space of a linear system: the matrices returned to callers, and their computation.
 *
 * d = X q + p s: X a basis of the unprescribed motions (all coordinates, or shapes), p the displacement by a motion
 * drive, s its magnitude. With M_x = X^T M X and so on
 *
 *     M_x q'' + C_x q' + K_x q = X^T f - X^T (M p s'' + C p s' + K p s)
 *
 * If the input of the drive is its speed, s' = u, the rate of u is eliminated by w = q' - B_1 u, B_1 = -M_x^-1 X^T M p:
 *
 *     q' = w + B_1 u,     w' = M_x^-1 (X^T f - C_x (w + B_1 u) - K_x q - X^T C p u - X^T K p s),     s' = u
 *                                                                                        (eq:response.state-space)
 *
 * A controller whose target is the input has the force (k_p u + k_i e) f, e' = u. An output is P d + S d' + T d'' +
 * F.f; forces of supports and constraints are linear in the force required by the motion, r = M d'' + C d' + K d - f:
 * a.r gives P += K^T a, S += C^T a, T += M^T a, F = -a. */
#ifndef DMB_ANALYSIS_STATE_SPACE_STATE_SPACE_H
#define DMB_ANALYSIS_STATE_SPACE_STATE_SPACE_H

#include "analysis/linear/linear.h"
#include "analysis/response/response.h"
#include "drillmbd/analyse.h"

/* ---- Sparse matrices --------------------------------------------------------------------------------------------- */

/* Matrices of one pattern by rows, entries start[row] .. start[row + 1] - 1. */
typedef struct dmb_sparse_rows {
    uint32_t rows, kinds;
    uint32_t *start, *column;
    double *value[3];
} dmb_sparse_rows;

enum { DMB_WHOLE_MASS = 0, DMB_WHOLE_DAMPING = 1, DMB_WHOLE_STIFFNESS = 2 };

/* M, C, K by all rows, including constrained ones. DMB_OK or DMB_ERR_NO_MEMORY; release accepts zeros too. */
int32_t dmb_whole_matrices(const dmb_linear *linear, dmb_sparse_rows *out);
/* Jacobian of the active equations, by the rows of the scene. Errors and release as above. */
int32_t dmb_whole_jacobian(const dmb_linear *linear, dmb_sparse_rows *out);
void dmb_sparse_rows_release(const dmb_allocator *allocator, dmb_sparse_rows *sparse);
/* y = A x; y += A^T x. */
void dmb_sparse_times(const dmb_sparse_rows *sparse, int kind, const double *x, double *y);
void dmb_sparse_add_transposed(const dmb_sparse_rows *sparse, int kind, const double *x, double *y);

/* ---- Result ------------------------------------------------------------------------------------------------------ */

struct dmb_state_space {
    uint32_t magic;
    dmb_allocator allocator;
    dmb_state_space_info info;
    dmb_sparse_rows whole, jacobian;
    uint32_t *coordinate_start, *coordinate_column; /* R by rows */
    double *coordinate_value;
    double *A, *B, *C, *D; /* row-major */
    double *shapes;        /* shape (coordinates, rows) */
    void *block;           /* of all arrays except those of the sparse matrices */
    size_t block_size;
};

/* ---- Computation ------------------------------------------------------------------------------------------------- */

/* An output as a linear function of the motion: P d + S d' + T d'' + F f, each shape (rows). */
typedef struct dmb_output_rows {
    double *pose, *speed, *acceleration, *force;
    uint32_t drive, bit; /* as in dmb_linear_output */
    double direct, integral;
    int32_t accelerates; /* 1: T is nonzero */
    int32_t reserved;
} dmb_output_rows;

typedef struct dmb_space_work {
    dmb_sim *sim; /* for its message */
    dmb_state_space_options options;
    dmb_linear *linear;
    dmb_dynamic_stiffness stiffness;
    dmb_state_space *space;
    dmb_linear_excitation *inputs;
    dmb_output_rows *outputs;
    uint32_t input_count, output_count;
    uint32_t *input_state; /* first state of each input, DMB_NONE: none, shape (inputs) */
    double *work;          /* shape (8 rows) */
    void *block;
    size_t block_size;
} dmb_space_work;

/* Linear functions of the outputs, from those of a response. */
int32_t dmb_space_read_outputs(dmb_space_work *w, const dmb_output *outputs);
/* Computes the basis in space->shapes, with its count. */
int32_t dmb_space_make_basis(dmb_space_work *w);
/* Largest number of shapes in a basis. */
uint64_t dmb_space_basis_workspace(const dmb_space_work *w);
/* Computes A, B, C, D. */
int32_t dmb_space_fill(dmb_space_work *w);
/* DMB_NOTE_INCOMPLETE with its message if coefficients change with the rotation of parts; w->work is overwritten.
 * Errors as dmb_linear_make. */
int32_t dmb_space_note_turning(dmb_space_work *w, const dmb_linear_options *how);
/* Number of additional states of an input. */
uint32_t dmb_space_states_of(const dmb_space_work *w, const dmb_linear_excitation *input);

#endif
