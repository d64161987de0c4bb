/* Symmetric pencil K + factor G of block-tridiagonal matrices, and block-sparse ones where joints connect chains, K
 * positive definite: its critical factors > 0, counted by Sylvester's law of inertia, found by bisection, and their
 * vectors by inverse iteration (Parlett, The symmetric eigenvalue problem, 3.3 and 4.2).
 *
 * A vector has the rows of the scene, 0 in those of jointed chains, and then the reduced coordinates of these. */
#ifndef DMB_ANALYSIS_BUCKLING_PENCIL_H
#define DMB_ANALYSIS_BUCKLING_PENCIL_H

#include "base/memory.h"
#include "sim/sim.h"

typedef struct dmb_pencil_matrix {
    double *diagonal, *lower, *upper; /* storage of the scene's layout */
    double *jointed; /* values of the scene's pattern, as in system/solve/reduced_system.h; none without joints */
} dmb_pencil_matrix;

typedef struct dmb_pencil {
    const dmb_scene *scene;
    const dmb_sim
        *sim; /* its reduced_size, reduced_row and progress; the caller's to set, NULL without joints and progress */
    dmb_pencil_matrix K, G, work;
    uint32_t unknowns; /* length of a vector */
    uint32_t reserved;
    uint8_t *pivot;          /* (rows) */
    uint32_t *reduced_pivot; /* (rows of the pattern) */
    double *room;            /* (square of the largest cluster) */
    double *image;           /* (unknowns) G x */
} dmb_pencil;

uint32_t dmb_pencil_unknowns(const dmb_scene *scene);
void dmb_pencil_lay_out(dmb_arena *arena, const dmb_scene *scene, dmb_pencil *pencil);
/* Factors in 0 .. factor: 1. 0 if a block stays singular at all factors next to it, and nothing can be counted. */
int dmb_pencil_count(dmb_pencil *pencil, double factor, uint32_t *count);
/* The factor number k = 0, 1 .. counted from 0 upwards to a relative `tolerance`, the search beginning at `guess` > 0;
 * infinite if it is beyond `most`, NaN if it cannot be counted. */
double dmb_pencil_factor(dmb_pencil *pencil, uint32_t k, double guess, double most, double tolerance);
/* Vector of a critical factor into x (unknowns), apart from `others` earlier ones of the same factor, (others,
 * unknowns). Returns the factor once more, as Rayleigh's quotient of the vector. */
double dmb_pencil_vector(dmb_pencil *pencil, double factor, const double *other, uint32_t others, double *x);

/* ---- Where K or G is not symmetric ---- */
/* The same factors, as many as `wanted`, and their vectors, shape (wanted, unknowns): the real positive eigenvalues
 * 1/factor of -K^-1 G that are largest, by Krylov subspaces. *found: how many there are below `most`.
 * DMB_ERR_NO_MEMORY, _SINGULAR, _NO_CONVERGENCE. */
typedef struct dmb_pencil_search {
    uint32_t wanted;
    double most;
    const dmb_allocator *allocator;
} dmb_pencil_search;

int32_t dmb_pencil_general(dmb_pencil *pencil, const dmb_pencil_search *search, double *factors, double *vectors,
                           uint32_t *found);

/* Operations on these. y = A x; factors of K + factor G into `work`, 0 where they are singular; x <- (K + factor G)^-1
 * x; any vector, the same for the same seed > 0. */
void dmb_pencil_multiply(const dmb_pencil *pencil, const dmb_pencil_matrix *A, const double *x, double *y);
int dmb_pencil_shift_and_factor(dmb_pencil *pencil, double factor);
void dmb_pencil_solve(const dmb_pencil *pencil, double *x);
void dmb_pencil_draw(const dmb_pencil *pencil, uint64_t seed, double *x);

#endif
