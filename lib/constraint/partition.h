/* Partition of the coordinates of a constraint component into dependent and independent ones (eq:static.blocks),
 *
 *     B x = 0,   B = [C_d, C_i] (rows x columns),   x_d = G x_i,   G = -C_d^-1 C_i,   null space R = [G; I]
 * (eq:joints.partition)
 *
 * by Gaussian elimination with complete pivoting on rows scaled to unit length in weighted columns (Wehage, Haug 1982).
 * Rows that vanish under elimination are redundant. The choice is stored as an order of rows and columns, so that later
 * matrices of the same component are factored without search; `quality` shows when it should be repeated.
 * Row-major, no allocation: all storage belongs to the caller. Results are bitwise reproducible. Matrices are stored
 * dense, but zeros are skipped: in a component of many bodies each row has entries of two bodies.
 *
 *     choose            at the start, and when the quality has decreased
 *     factor            each new B; then solve, solve_transposed, null_space, least_norm
 *     gram, project     independent: they require the choice and B, not the factors */
#ifndef DMB_CONSTRAINT_PARTITION_H
#define DMB_CONSTRAINT_PARTITION_H

#include <stdint.h>

/* A row is redundant if no entry that remains after elimination is larger than this fraction of its length. */
#define DMB_RANK_TOLERANCE 1e-8

/* The choice. The first `rank` items of row_order are the pivot rows, those of column_order the dependent columns;
 * pivot k is (row_order[k], column_order[k]). The remaining items are redundant rows and independent columns,
 * ascending. */
typedef struct dmb_partition {
    uint32_t rows, columns; /* of the matrix */
    uint32_t rank;
    uint32_t reserved;
    uint32_t *row_order;    /* shape (rows) */
    uint32_t *column_order; /* shape (columns) */
} dmb_partition;

/* Chooses the dependent columns. The caller sets rows, columns and the two arrays; their content and the rank are
 * computed.
 * B: shape (rows, stride >= columns), unchanged. weight: shape (columns), >= 0, column j is measured in units of
 * weight[j] (B_ij * weight[j]); a column with weight 0 cannot be dependent, and entries in such columns do not count
 * for the length of a row and the rank: B R = 0 holds for redundant rows in columns with a positive weight.
 * work: rows * columns + rows doubles.
 * Among candidates equal to within 1e-6 the lowest row and in it the lowest column is chosen, so that the choice does
 * not depend on rounding. Returns the quality: smallest over largest scaled pivot; 1 when the rank is 0. Rows of zeros
 * (shorter than 1e-300) are redundant. A row that is not finite is treated as zero and makes the quality 0. */
double dmb_partition_choose(const double *B, uint32_t stride, const double *weight, double *work,
                            dmb_partition *partition);

/* Factors C_d of the pivot rows and dependent columns (rank x rank) into lu, with row exchanges pivot[rank]; returns
 * the quality of this matrix under the present choice, measured as in choosing (scaled rows and columns):
 *
 *     smallest pivot / largest of the pivots and of the entries of pivot rows, independent columns included.
 *
 * In choosing the first pivot is the largest entry, so both qualities of one matrix agree (to 1e-6). Because entries
 * are included, the quality also decreases if a single row rotates away from its dependent column.
 * Rank 0: 1. Singular: 0, where a pivot is zero or not finite, or a pivot row shorter than 1e-300 or not finite; lu is
 * then invalid. */
double dmb_partition_factor(const double *B, uint32_t stride, const double *weight, const dmb_partition *partition,
                            double *lu, uint32_t *pivot);
/* x := C_d^-1 x, x: shape (rank), in the order of the pivot rows on entry and of the dependent columns on return. */
void dmb_partition_solve(const dmb_partition *partition, const double *lu, const uint32_t *pivot, double *x);
/* x := C_d^-T x, from the order of dependent columns to that of pivot rows: computes multipliers from the residuals of
 * the dependent equations. */
void dmb_partition_solve_transposed(const dmb_partition *partition, const double *lu, const uint32_t *pivot, double *x);
/* G = -C_d^-1 C_i, shape (rank, columns - rank), row-major; rows and columns in the order of column_order. */
void dmb_partition_null_space(const double *B, uint32_t stride, const dmb_partition *partition, const double *lu,
                              const uint32_t *pivot, double *G);

/* Projection in the metric 1/weight^2: x = W^2 B^T (B W^2 B^T)^-1 d over the pivot rows is the shortest x (in units of
 * weight) with B x = d. Columns of weight 0 do not change. */
/* Rows of the Jacobian, `stride` numbers apart, and weights of its columns. */
typedef struct dmb_jacobian {
    const double *rows;
    uint32_t stride;
    const double *weight;
} dmb_jacobian;

/* Factors B W^2 B^T of the pivot rows (Cholesky, in their order) into gram, shape (rank, rank). All of it is used: for
 * the factor, and for notes of the nonzero entries of the factor and of B. It is valid for the same B and choice only,
 * and must be passed on unchanged. Returns 0, or -1 if a pivot is at most 1e-16 of its diagonal or not finite. */
int32_t dmb_partition_gram(const dmb_jacobian *jacobian, const dmb_partition *partition, double *gram);
/* Excludes near-redundant rows (pivot below DMB_NEAR_REDUNDANT_PIVOT of the diagonal) from projections with gram: near
 * a singular configuration a projection would amplify the rounding errors of the poses. */
#define DMB_NEAR_REDUNDANT_PIVOT 1e-9
void dmb_partition_drop_near_redundant(const dmb_jacobian *jacobian, const dmb_partition *partition, double *gram);
/* d: shape (rank), in the order of pivot rows, overwritten; x: shape (columns), natural order, overwritten. */
void dmb_partition_project(const dmb_jacobian *jacobian, const dmb_partition *partition, const double *gram, double *d,
                           double *x);

/* Replaces the multipliers f of all rows (shape (rows), natural order) by those of least norm with the same B^T f (in
 * columns with a positive weight). Redundant rows usually have 0 on entry; other values are permitted.
 * work: exactly (rows - rank) * rows doubles. */
void dmb_partition_least_norm(const dmb_jacobian *jacobian, const dmb_partition *partition, const double *lu,
                              const uint32_t *pivot, double *work, double *f);

#endif
