/* The eigenvalues of largest modulus of an operator, from a block Krylov space with a basis orthonormal in the
 * operator's metric, every vector made orthogonal to all before: block Lanczos where the operator is symmetric in that
 * metric, block Arnoldi where it is not (Saad 2011, chapter 6). A start of several vectors finds as many equal values;
 * when all that is asked for has converged, a random vector is thrown in, which finds further ones. */
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
    int32_t partly;    /* 1: where fewer than wanted have converged in the end, those are the answer */
    void (*metric)(void *context, const double *x, double *y);                  /* y = G x */
    void (*apply)(void *context, const double *x, const double *Gx, double *y); /* y = A x */
    void (*draw)(void *context, uint64_t *seed, double *x);                     /* any vector of the space */
    int32_t (*go_on)(void *context); /* may be NULL: asked before each vector, < 0 ends the search */
    size_t most;                     /* vectors in its basis, 0: as dmb_krylov_largest says */
    int32_t counted; /* 1: the caller counts the values, so that no random vector is thrown in to confirm them */
    uint32_t enough; /* the search also ends with so many values beyond these two, < 0 and > 0; 0: not so. Symmetric */
    double beyond[2];
} dmb_operator;

typedef struct dmb_krylov {
    uint32_t count;        /* of values; a conjugate pair counts once and stands with im > 0 */
    uint32_t applications; /* of the operator */
    double *re, *im;       /* values, falling modulus, shape (count) */
    double next;   /* estimated modulus of value number `wanted` where fewer converged; 0 if there is no estimate */
    double *x, *y; /* vectors x + i y, of norm 1 in the metric, shape (count, length); y NULL if symmetric */
    dmb_allocator allocator;
    void *block;
    size_t block_size;
} dmb_krylov;

/* At least `wanted` values, or all there are; converged when the residual is below tolerance times the value. `start`:
 * vectors to begin with, 1 or more. Memory: some `wanted` vectors. DMB_ERR_NO_CONVERGENCE after some four times
 * `wanted` applications, eight times where it is not symmetric, or after `most`, DMB_ERR_NO_MEMORY; *out is empty
 * then. */
int32_t dmb_krylov_largest(const dmb_operator *A, uint32_t wanted, uint32_t start, double tolerance,
                           const dmb_allocator *allocator, dmb_krylov *out);
/* An empty one may be released too. */
void dmb_krylov_release(dmb_krylov *krylov);

#endif
