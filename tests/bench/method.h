/* The method by which a scene is run. */
#ifndef BENCH_METHOD_H
#define BENCH_METHOD_H

#include "scenes.h"

typedef struct method {
    double step;      /* [s] fixed; 0: error-controlled */
    double tolerance; /* [rad] of a step, a tenth of it in metres; error-controlled only */
    double radius;    /* [-] spectral radius at infinite frequency */
    double horizon;   /* [s] where the answers are taken */
    double end;       /* [s] of the timed run, >= horizon */
    int ledger;
    int repeats;
} method;

/* Fixed steps, all else the library's defaults. */
static method method_fixed(double step, double horizon)
{
    const method how = {step, 0.0, 0.8, horizon, horizon, 1, 2};
    return how;
}

static dmb_sim_options options_of(const method *how)
{
    dmb_sim_options options = dmb_sim_options_default();
    options.energy_ledger = how->ledger;
    options.spectral_radius = how->radius;
    if (how->step <= 0.0) {
        options.tolerance_rotation = how->tolerance;
        options.tolerance_translation = 0.1 * how->tolerance;
    }
    return options;
}

static int32_t go_to(dmb_sim *sim, const method *how, double time)
{
    int32_t status = DMB_OK;
    if (how->step <= 0.0) return dmb_sim_advance(sim, time, NULL);
    const double first = floor(dmb_sim_time(sim) / how->step + 0.5), last = floor(time / how->step + 0.5);
    for (double k = first + 1.0; status >= 0 && k <= last; k += 1.0)
        status = dmb_sim_step(sim, k * how->step - dmb_sim_time(sim), NULL);
    return status;
}

#endif
