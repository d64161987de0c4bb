/* The library's own run beside a peer: once, energy ledger off. */
#ifndef BENCH_PEER_LIBRARY_H
#define BENCH_PEER_LIBRARY_H

#include "answers.h"
#include "method.h"
#include "peer_rows.h"

/* From time 0 to how->end; creation left out. Fills times, steps and answers; 0 after saying why not. */
static int library_measure(const scene *s, const method *how, yardstick *unit, peer_row *found, double values[2])
{
    const dmb_sim_options options = options_of(how);
    dmb_statistics statistics = dmb_statistics_default();
    dmb_sim *sim = NULL;
    int32_t status = dmb_sim_create(s->model, &options, &sim);
    const double begin = processor_time();
    if (status >= 0) status = go_to(sim, how, how->end);
    found->seconds = processor_time() - begin;
    if (status >= 0) status = scene_ask(s, sim, values);
    if (status >= 0) status = dmb_query_statistics(sim, &statistics);
    if (status < 0)
        row_failed(scene_names[s->kind], s->pipes * s->per_pipe, "code=drillmbd", dmb_status_name(status),
                   dmb_sim_message(sim));
    dmb_sim_destroy(&sim);
    yardstick_measure(unit);
    found->yardstick = yardstick_value(unit);
    found->end = how->end;
    found->steps = (double)statistics.steps;
    return status >= 0;
}

#endif
