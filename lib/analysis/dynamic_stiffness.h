/* The dynamic stiffness of a linearised scene at one frequency,
 *
 *     A(w) = (1 + i eta) K + i w C - w^2 M,     A d = f,
 *
 * assembled in complex blocks, factored and solved. Rows that guides hold do not move; rows that motion drives hold move
 * as they are told, and their columns of A go to the right-hand side. Where joints connect chains, the nodes they act on
 * are condensed: the chains are solved with these nodes held, and the Schur complement of the nodes, reduced to
 * independent coordinates by R, is solved by dense elimination (analysis/joint_condensation). */
#ifndef DMB_ANALYSIS_DYNAMIC_STIFFNESS_H
#define DMB_ANALYSIS_DYNAMIC_STIFFNESS_H

#include "analysis/linearise.h"
#include "math/block_complex.h"

typedef struct dmb_complex_number {
    double re, im;
} dmb_complex_number;

/* Rows of the nodes that joints act on, held in the chains and solved by themselves. */
typedef struct dmb_condensation {
    uint32_t rows;              /* 0 without joints; solved rows only */
    uint32_t reduced;           /* independent coordinates among them */
    uint32_t *row, *node;       /* shape (rows), ascending */
    uint32_t *place;            /* where a row is in `row`; UINT32_MAX: nowhere, shape (rows of the scene) */
    uint32_t *number;           /* of coordinate i of the scene among the reduced; UINT32_MAX: none */
    dmb_complex_array inside;   /* A_II^-1 A_Ij of each, shape (rows, rows of the scene) */
    dmb_complex_array schur;    /* shape (rows, rows) */
    dmb_complex_array half;     /* schur R, shape (rows, reduced) */
    dmb_complex_array force;    /* shape (rows) */
    dmb_complex_array moved;    /* displacements that drives of joints ask for, shape (rows) */
    double *dense;              /* [Re -Im; Im Re] of R^T schur R, then its factors, shape (2 reduced, 2 reduced) */
    double *solution;           /* shape (2 reduced) */
    uint32_t *pivot;            /* shape (2 reduced) */
} dmb_condensation;

typedef struct dmb_dynamic_stiffness {
    const dmb_linear *linear;
    double structural_damping;  /* [-] eta */
    double omega;               /* [rad/s] of the present factors */
    dmb_complex_block_matrix factors;
    uint8_t *held;              /* 1 of rows that are not solved in the chains, shape (rows) */
    dmb_complex_array told;     /* displacement of held rows, shape (held_count of the scene) */
    dmb_condensation condensation;
    void *block;
    size_t block_size;
} dmb_dynamic_stiffness;

/* DMB_OK or DMB_ERR_NO_MEMORY; release gives the memory back and takes a struct of zeros too. */
int32_t dmb_dynamic_stiffness_make(const dmb_linear *linear, double structural_damping, dmb_dynamic_stiffness *out);
void dmb_dynamic_stiffness_release(dmb_dynamic_stiffness *stiffness);

/* Factors at w. A node that nothing holds there, or -1. */
int64_t dmb_dynamic_stiffness_factor(dmb_dynamic_stiffness *stiffness, double omega);
/* x, shape (rows): forces in rows that are solved, prescribed displacements in rows that are held; displacements of all
 * rows on return. joint_moves 1: displacements too in the rows of nodes that joints act on, such that the equations of
 * the joints' drives hold; to them comes what R allows. */
void dmb_dynamic_stiffness_solve(dmb_dynamic_stiffness *stiffness, int32_t joint_moves, dmb_complex_array x);

/* y -= A_.j x: column of component c of a node, its chain alone. */
void dmb_dynamic_subtract_column(const dmb_dynamic_stiffness *stiffness, uint32_t node, uint32_t c,
                                 dmb_complex_number x, dmb_complex_array y);
/* A_j. x: row of component c of a node, its chain alone. */
dmb_complex_number dmb_dynamic_row_times(const dmb_dynamic_stiffness *stiffness, uint32_t node, uint32_t c,
                                         dmb_complex_array x);
/* x <- A_II^-1 x in one chain, rows that are held staying as they are. */
void dmb_dynamic_chain_solve(const dmb_dynamic_stiffness *stiffness, uint32_t chain, dmb_complex_array x);

/* An entry of A at the present frequency from those of M, C and K. */
static inline dmb_complex_number dmb_dynamic_entry(const dmb_dynamic_stiffness *s, double mass, double damping,
                                                   double stiffness)
{
    const double w = s->omega;
    const dmb_complex_number a = {stiffness - w * w * mass, w * damping + s->structural_damping * stiffness};
    return a;
}

#endif
