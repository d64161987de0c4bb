/* The dynamic stiffness of a linearised scene at one frequency,
 *
 *     A(w) = (1 + i eta) K + i w C - w^2 M,     A d = f,
 *
 * or of motions that grow too, d ~ e^(p t), p = growth + i w: A(p) = (1 + i eta) K + p C + p^2 M,
 *
 * assembled in complex blocks, factored and solved: block-tridiagonal along a chain, block-sparse in the independent
 * coordinates where joints connect chains (dynamic_stiffness_links.c). Rows that guides hold do not move. Rows that
 * drives move do so as told: of displacements p that hold all equations of joints, d = p + R z, R^T A R z = -R^T A
 * p. */
#ifndef DMB_ANALYSIS_LINEAR_DYNAMIC_STIFFNESS_H
#define DMB_ANALYSIS_LINEAR_DYNAMIC_STIFFNESS_H

#include "analysis/linear/linearise.h"
#include "base/memory.h"
#include "math/block_kernel.h"
#include "math/complex_sparse.h"

typedef struct dmb_complex_number {
    double re, im;
} dmb_complex_number;

/* The system R^T A R of chains that joints connect, in the blocks of the scene's pattern. */
typedef struct dmb_dynamic_links {
    uint32_t count;       /* of its coordinates; 0 too where joints leave none */
    uint32_t *size, *row; /* of each block: coordinates, and the first of them, shape (blocks of the scene) */
    uint32_t *place;      /* of coordinate i of the linear system among them; DMB_NONE: none */
    dmb_complex_sparse matrix;
    dmb_complex_array solution;   /* shape (count) */
    dmb_complex_array half;       /* A_ij R_j, shape (6, the widest block) */
    dmb_complex_array multiplier; /* of one cluster, shape (the most rows of a cluster) */
    double *rest;                 /* forces that constraints balance, shape (2, the most rows of a cluster) */
    double *stiffness, *mass; /* what a pivot is held against: diagonals of R^T |K| R and R^T |M| R, shape (count) */
} dmb_dynamic_links;

typedef struct dmb_dynamic_stiffness {
    const dmb_linear *linear;
    double structural_damping;        /* [-] eta */
    double omega;                     /* [rad/s] of the present factors */
    double growth;                    /* [1/s] likewise; 0 of a response */
    dmb_complex_block_matrix factors; /* of chains without joints; the blocks of A of the others */
    dmb_complex_array told;           /* p, shape (rows) */
    dmb_dynamic_links links;
    void *block;
    size_t block_size;
} dmb_dynamic_stiffness;

/* DMB_OK or DMB_ERR_NO_MEMORY; release gives the memory back and takes a struct of zeros too. */
int32_t dmb_dynamic_stiffness_make(const dmb_linear *linear, double structural_damping, dmb_dynamic_stiffness *out);
void dmb_dynamic_stiffness_release(dmb_dynamic_stiffness *stiffness);

/* Factors at w. A node that nothing holds there, or -1. */
int64_t dmb_dynamic_stiffness_factor(dmb_dynamic_stiffness *stiffness, double omega);
/* The same at growth + i omega. */
int64_t dmb_dynamic_stiffness_factor_at(dmb_dynamic_stiffness *stiffness, double growth, double omega);
/* x, shape (rows): forces on entry (those on rows that are held do nothing), displacements of all rows on return.
 * moves 1: on entry displacements p. */
void dmb_dynamic_stiffness_solve(dmb_dynamic_stiffness *stiffness, int32_t moves, dmb_complex_array x);

/* 1 if the reciprocal of a pivot is so large that nothing but rounding holds its row at this frequency. */
static inline int32_t dmb_dynamic_is_loose(const dmb_dynamic_stiffness *s, double re, double im, double stiffness,
                                           double mass)
{
    const double a = re < 0.0 ? -re : re, b = im < 0.0 ? -im : im;
    const double square = s->omega * s->omega + s->growth * s->growth;
    return (a > b ? a : b) * (stiffness + square * mass) * DMB_LOOSE_PIVOT > 1.0;
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

/* The part of a dynamic stiffness where joints connect chains: R^T A R in complex blocks, one of each cluster of joints
 * and one of each other node, factored in the order of the scene's pattern. Its cost grows with the number of blocks,
 * and with the cube of the coordinates of one cluster. */

/* Sizes to begin with: `count`, the widest block, the most rows of constraint of a cluster. */
typedef struct dmb_links_size {
    uint32_t count, widest, rows;
} dmb_links_size;

dmb_links_size dmb_dynamic_links_size(const dmb_linear *linear);
void dmb_dynamic_links_lay_out(dmb_arena *arena, const dmb_linear *linear, dmb_links_size size, dmb_dynamic_links *out);
/* Numbers the coordinates; `size` as laid out with. */
void dmb_dynamic_links_number(const dmb_linear *linear, dmb_links_size size, dmb_dynamic_links *out);
/* From the blocks of A. A node that nothing holds, or -1. */
int64_t dmb_dynamic_links_factor(dmb_dynamic_stiffness *stiffness);
/* Rows of jointed chains of x: forces in, displacements out. */
void dmb_dynamic_links_solve(dmb_dynamic_stiffness *stiffness, dmb_complex_array x);

/* Forces that a motion at one frequency takes: products with the dynamic stiffness A as the scene has it, rows that are
 * held included, and the forces of constraint that balance them,
 *
 *     A x + B^T multiplier = f
 *
 * in the dependent rows of each cluster of joints. The residual in rows that are held is the force of their guides. */

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
