/* Null space of a matrix with few columns (Golub, Van Loan 2013, 5.2 and 5.4): its rows are accumulated in a triangle
 * by Givens rotations, to which Householder QR with column pivoting is applied. For analyses; never called by steps. */
#ifndef DMB_MATH_NULL_SPACE_H
#define DMB_MATH_NULL_SPACE_H

#include <stddef.h>
#include <stdint.h>

/* Adds a row of n numbers, of which the first `from` are 0, to the triangle R, shape (n, n) by rows; row is
 * overwritten. */
void dmb_rotate_in(size_t n, size_t from, double *R, double *row);
/* Rank of A, shape (n, n) by rows, which becomes the triangle [T11 T12; 0 0] of its columns in `order`; v: shape (2n),
 * workspace. */
size_t dmb_triangulate(size_t n, double tolerance, double *A, uint32_t *order, double *v);
/* A after dmb_triangulate. */
typedef struct dmb_triangle {
    size_t n, rank;
    const double *A;
    const uint32_t *order;
} dmb_triangle;

/* Null vector number i of that triangle: q = (-T11^-1 T12 e_i; e_i) in the order of its columns. */
void dmb_null_vector(const dmb_triangle *triangle, size_t i, double *work, double *q);

#endif
