#include "math/bridge.h"

#include <cholmod.h>

/* Nothing printed, no handler called, AMD alone, and no more analysis than the order needs. */
static void configure(cholmod_common *common)
{
    common->print = 0;
    common->error_handler = NULL;
    common->nmethods = 1;
    common->method[0].ordering = CHOLMOD_AMD;
    common->postorder = 1;
    common->supernodal = CHOLMOD_SIMPLICIAL;
}

/* The graph as a matrix without values, of which CHOLMOD reads the upper triangle. It is not written to. */
static cholmod_sparse graph_matrix(uint32_t n, const int32_t *start, const int32_t *neighbour)
{
    cholmod_sparse A = {0};
    A.nrow = A.ncol = n;
    A.nzmax = (size_t)start[n];
    A.p = (void *)start;
    A.i = (void *)neighbour;
    A.stype = 1;
    A.itype = CHOLMOD_INT;
    A.xtype = CHOLMOD_PATTERN;
    A.dtype = CHOLMOD_DOUBLE;
    A.packed = 1;
    return A;
}

int32_t dmb_fill_reducing_order(uint32_t n, const int32_t *start, const int32_t *neighbour, uint32_t *order)
{
    cholmod_common common;
    int32_t status = DMB_ERR_NO_MEMORY;
    for (uint32_t k = 0; k < n; k++) order[k] = k;
    if (n <= 2) return DMB_OK; /* any order will do */
    if (!cholmod_start(&common)) return DMB_ERR_NO_MEMORY;
    configure(&common);
    cholmod_sparse A = graph_matrix(n, start, neighbour);
    cholmod_factor *L = cholmod_analyze(&A, &common);
    if (L != NULL && common.status >= CHOLMOD_OK) {
        for (uint32_t k = 0; k < n; k++) order[k] = (uint32_t)((const int32_t *)L->Perm)[k];
        status = DMB_OK;
    }
    cholmod_free_factor(&L, &common);
    cholmod_finish(&common);
    return status;
}
