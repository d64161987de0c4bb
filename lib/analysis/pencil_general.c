/* Critical factors of a pencil that is not symmetric (friction, moments with a fixed axis): K x = -factor G x is
 * A x = x/factor with A = -K^-1 G. Complex eigenvalues of A belong to no factor: det (K + factor G) does not vanish
 * there. */
#include <math.h>
#include <string.h>

#include "analysis/pencil.h"
#include "math/krylov.h"

static void metric(void *context, const double *x, double *y)
{
    const dmb_pencil *pencil = context;
    memcpy(y, x, pencil->unknowns * sizeof(double));
}

static void apply(void *context, const double *x, const double *Gx, double *y)
{
    const dmb_pencil *pencil = context;
    (void)Gx;
    dmb_pencil_multiply(pencil, &pencil->G, x, y);
    for (uint32_t i = 0; i < pencil->unknowns; i++) y[i] = -y[i];
    dmb_pencil_solve(pencil, y);
}

static void draw(void *context, uint64_t *seed, double *x)
{
    const dmb_pencil *pencil = context;
    *seed += 0x9E3779B97F4A7C15u;
    dmb_pencil_draw(pencil, *seed | 1u, x);
    dmb_pencil_solve(pencil, x);
}

static int32_t go_on(void *context)
{
    const dmb_pencil *pencil = context;
    return dmb_progress_pulse(pencil->sim);
}

/* A double real value is split by rounding into two, or into a pair this close to the real axis. */
#define DMB_REAL_PAIR 1e-5
#define DMB_GENERAL_TOLERANCE 1e-9
#define DMB_GENERAL_MORE 10
#define DMB_GENERAL_MOST 120

static uint32_t take(const dmb_krylov *values, size_t length, uint32_t wanted, double most, double *factors,
                     double *vectors)
{
    uint32_t found = 0;
    for (uint32_t i = 0; i < values->count && found < wanted; i++) {
        const size_t n = length;
        const int pair = values->im[i] != 0.0;
        if (values->re[i] * most < 1.0 || fabs(values->im[i]) > DMB_REAL_PAIR * values->re[i]) continue;
        for (int part = 0; part <= pair && found < wanted; part++, found++) {
            factors[found] = 1.0 / values->re[i];
            memcpy(vectors + n * found, (part ? values->y : values->x) + n * i, n * sizeof(double));
        }
    }
    return found;
}

int32_t dmb_pencil_general(dmb_pencil *pencil, uint32_t wanted, double most, const dmb_allocator *allocator,
                           double *factors, double *vectors, uint32_t *found)
{
    const dmb_operator inverse = {.context = pencil,
                                  .length = pencil->unknowns,
                                  .dimension = pencil->unknowns,
                                  .metric = metric,
                                  .apply = apply,
                                  .draw = draw,
                                  .go_on = go_on};
    *found = 0;
    if (!dmb_pencil_shift_and_factor(pencil, 0.0)) return DMB_ERR_SINGULAR;
    for (uint32_t values = 2 * wanted + DMB_GENERAL_MORE; *found < wanted; values *= 3) {
        dmb_krylov largest;
        if (values > pencil->unknowns) values = pencil->unknowns;
        const int32_t status = dmb_krylov_largest(&inverse, values, 2, DMB_GENERAL_TOLERANCE, allocator, &largest);
        if (status < 0) return *found > 0 && status == DMB_ERR_NO_CONVERGENCE ? DMB_OK : status;
        *found = take(&largest, pencil->unknowns, wanted, most, factors, vectors);
        dmb_krylov_release(&largest);
        if (values >= pencil->unknowns || values > DMB_GENERAL_MOST) break;
    }
    return DMB_OK;
}
