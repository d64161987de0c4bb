/* CHOLMOD, if it belongs to the build (DMB_WITH_CHOLMOD): linked, or loaded when a scene requires it (DMB_LAZY). The
 * order determines the last digits of a scene with joints. Therefore a build with CHOLMOD uses no other order: if it
 * cannot be loaded, ordering fails. */
#include "math/bridge.h"

#include "base/build.h"

#if DMB_WITH_CHOLMOD
#include <cholmod.h>

typedef int start_call(cholmod_common *);
typedef cholmod_factor *analyze_call(cholmod_sparse *, cholmod_common *);
typedef int free_factor_call(cholmod_factor **, cholmod_common *);
#define SAME(name, type) _Static_assert(_Generic(&(name), type * : 1, default : 0), #name)
SAME(cholmod_start, start_call);
SAME(cholmod_finish, start_call);
SAME(cholmod_analyze, analyze_call);
SAME(cholmod_free_factor, free_factor_call);

typedef struct cholmod_calls {
    start_call *start, *finish;
    analyze_call *analyze;
    free_factor_call *free_factor;
} cholmod_calls;

#if DMB_LAZY
static int calls_of_build(cholmod_calls *calls)
{
    static const char *const names[] = {"cholmod_start", "cholmod_finish", "cholmod_analyze", "cholmod_free_factor"};
    dmb_foreign found[4];
    if (!dmb_foreign_load(DMB_CHOLMOD_SONAME, 4, names, found)) return 0;
    calls->start = (start_call *)found[0];
    calls->finish = (start_call *)found[1];
    calls->analyze = (analyze_call *)found[2];
    calls->free_factor = (free_factor_call *)found[3];
    return 1;
}
#else
static int calls_of_build(cholmod_calls *calls)
{
    calls->start = cholmod_start;
    calls->finish = cholmod_finish;
    calls->analyze = cholmod_analyze;
    calls->free_factor = cholmod_free_factor;
    return 1;
}
#endif

int dmb_has_cholmod(void)
{
    cholmod_calls calls;
    return calls_of_build(&calls);
}

/* No output, no error handler, AMD only, and no more analysis than the order requires. */
static void configure(cholmod_common *common)
{
    common->print = 0;
    common->error_handler = NULL;
    common->nmethods = 1;
    common->method[0].ordering = CHOLMOD_AMD;
    common->postorder = 1;
    common->supernodal = CHOLMOD_SIMPLICIAL;
}

/* The graph as a matrix without values, of which CHOLMOD reads the upper triangle. It is not modified. */
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

int32_t dmb_fill_reducing_order(const dmb_allocator *allocator, uint32_t n, const int32_t *start,
                                const int32_t *neighbour, uint32_t *order)
{
    cholmod_common common;
    cholmod_calls calls;
    (void)allocator;
    int32_t status = DMB_ERR_NO_MEMORY;
    for (uint32_t k = 0; k < n; k++) order[k] = k;
    if (n <= 2) return DMB_OK; /* any order is optimal */
    if (!calls_of_build(&calls)) return DMB_ERR_UNSUPPORTED;
    if (!calls.start(&common)) return DMB_ERR_NO_MEMORY;
    configure(&common);
    cholmod_sparse A = graph_matrix(n, start, neighbour);
    cholmod_factor *L = calls.analyze(&A, &common);
    if (L != NULL && common.status >= CHOLMOD_OK) {
        for (uint32_t k = 0; k < n; k++) order[k] = (uint32_t)((const int32_t *)L->Perm)[k];
        status = DMB_OK;
    }
    calls.free_factor(&L, &common);
    calls.finish(&common);
    return status;
}

#else

int dmb_has_cholmod(void)
{
    return 0;
}

int32_t dmb_fill_reducing_order(const dmb_allocator *allocator, uint32_t n, const int32_t *start,
                                const int32_t *neighbour, uint32_t *order)
{
    return dmb_minimum_degree(allocator, n, start, neighbour, order);
}
#endif
