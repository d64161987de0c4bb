/* The eigenvalues of largest modulus of an operator, from a block Krylov space with a basis that is orthonormal in the
 * operator's metric, with full orthogonalisation: block Lanczos if the operator is symmetric in that metric, otherwise
 * block Arnoldi (Saad 2011, chapter 6). A start block of several vectors finds the same number of equal values. When
 * all requested values have converged, a random vector is appended, which finds further ones. */
#ifndef DMB_MATH_KRYLOV_H
#define DMB_MATH_KRYLOV_H

#include <stddef.h>
#include <stdint.h>

#include "drillmbd/base.h"

typedef struct dmb_operator {
    void *context;
    size_t length;     /* of vectors */
    size_t dimension;  /* of the space they span */
    int32_t symmetric; /* 1: x . G A y = y . G A x */
    int32_t partly;    /* 1: if fewer values than requested have converged at the end, these are returned; 2: all
                          requested are returned as they are, `next` > 0 */
    void (*metric)(void *context, const double *x, double *y);                  /* y = G x */
    void (*apply)(void *context, const double *x, const double *Gx, double *y); /* y = A x */
    void (*draw)(void *context, uint64_t *seed, double *x);                     /* a random vector of the space */
    int32_t (*go_on)(void *context); /* may be NULL: called before each vector, < 0 ends the search */
    /* Largest number of vectors in the basis; if `partly`, the search also ends once more vectors hardly reduce the
     * residual of the first value that has not converged. 0: default of dmb_krylov_largest */
    size_t most;
    int32_t counted; /* 1: the caller counts the values, so that no random vector is appended to confirm them */
    uint32_t enough; /* the search also ends if this number of values lies beyond these two bounds, < 0 and > 0; 0:
                        unused. Symmetric only */
    double beyond[2];
    int32_t positive; /* 1: values <= 0 are left out. Symmetric only */
} dmb_operator;

typedef struct dmb_krylov {
    uint32_t count;        /* of values; a conjugate pair counts once and is returned with im > 0 */
    uint32_t applications; /* of the operator */
    double *re, *im;       /* values, descending modulus, shape (count) */
    double next;   /* estimated modulus of value number `wanted` if fewer converged; 0 if there is no estimate */
    double bound;  /* of the modulus of the first value that has not converged, if fewer than wanted have: its estimate
                      and its residual; 0 if there is no estimate */
    double *x, *y; /* vectors x + i y, of norm 1 in the metric, shape (count, length); y NULL if symmetric */
    dmb_allocator allocator;
    void *block;
    size_t block_size;
} dmb_krylov;

/* Computes at least `wanted` values, or all if there are fewer. A value has converged if its residual is below
 * tolerance times the value. `start`: size of the start block, 1 or more. Memory: some `wanted` vectors.
 * DMB_ERR_NO_CONVERGENCE after some four times `wanted` applications, eight times if it is not symmetric, or after
 * `most`, DMB_ERR_NO_MEMORY; *out is then empty. */
int32_t dmb_krylov_largest(const dmb_operator *A, uint32_t wanted, uint32_t start, double tolerance,
                           const dmb_allocator *allocator, dmb_krylov *out);
/* An empty result may be released too. */
void dmb_krylov_release(dmb_krylov *krylov);

#endif
