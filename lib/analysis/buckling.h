/* A buckling analysis while it runs. */
#ifndef DMB_ANALYSIS_BUCKLING_H
#define DMB_ANALYSIS_BUCKLING_H

#include "analysis/load_pattern.h"
#include "analysis/pencil.h"
#include "analysis/static_state.h"

struct dmb_buckling {
    uint32_t magic;
    uint32_t count;          /* factors found */
    dmb_allocator allocator;
    dmb_sim *work;           /* a copy of the sim in its state, for shapes as its velocities */
    void *block;
    size_t block_size;
    double *factor;          /* (count) */
    double *vector;          /* (count, unknowns of the pencil) */
    double *shape;           /* (count, rows) body-frame displacements of the nodes; without joints it is the vector */
    double *response;        /* (rows) of the state to the pattern */
    dmb_load_pattern pattern;
    dmb_pencil pencil;
};

/* Body-frame displacements of the nodes, shape (rows), that a vector of the pencil stands for. */
void dmb_buckling_expand(dmb_buckling *buckling, const double *vector, double *shape);
/* K and G of the state in `work`. Errors, with a message in sim: DMB_ERR_ORDER (no stable equilibrium), _SINGULAR. */
int32_t dmb_buckling_linearise(dmb_buckling *buckling, dmb_sim *sim, const dmb_buckling_options *options);

#endif
