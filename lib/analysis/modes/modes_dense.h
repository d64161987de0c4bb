/* Parts that the dense ways to all modes share. */
#ifndef DMB_ANALYSIS_MODES_MODES_DENSE_H
#define DMB_ANALYSIS_MODES_MODES_DENSE_H

#include "analysis/modes/modes.h"

typedef struct dmb_dense {
    size_t n;             /* coordinates */
    size_t m;             /* rigid-body motions, which are the first of X */
    double *M, *X;        /* mass, gone after the modes X of the symmetric part of K, X^T M X = I, shape (n, n) */
    double *square;       /* [1/s2] their eigenvalues, ascending, shape (n) */
    double *motion;       /* rigid-body motions by coordinates, and M times them, shape (2, rigid_count, n) */
    double *rate;         /* [1/s] what their displacements are measured by, shape (n) */
    double *coupling;     /* skew part of K, then C; shape (n, n), as the following only where they are coupled */
    double *half;         /* work, shape (n + 1, n) */
    double *system, *V;   /* the coupled equations and their vectors, shape (m, m), m of dmb_coupled_size */
    double *re, *im;      /* shape (2n) */
    double *work, *x, *y; /* of LAPACK; rows */
    void *block;
    size_t bytes;
} dmb_dense;

/* Number of the coupled equations: 2n with damping, n without, 0 where nothing couples. */
size_t dmb_coupled_size(const dmb_mode_search *search);
/* Adds the modes of the coupled equations, X and square being there, the skew part of K in coupling. */
int32_t dmb_modes_coupled(dmb_mode_search *search, dmb_dense *d);

#endif
