#include "query/ask.h"
#include "state/layout.h"

DMB_DECLARE_STRUCT(dmb_statistics)

int32_t dmb_query_statistics(const dmb_sim *sim, dmb_statistics *statistics)
{
    const int32_t status = dmb_ask(sim, statistics);
    dmb_statistics answer = {0};
    const dmb_counters *counters;
    if (status < 0) return status;
    counters = sim->counters;
    answer.worst_iterations = (uint32_t)counters->worst_iterations;
    answer.steps = counters->steps;
    answer.rejected = counters->rejected;
    answer.iterations = counters->iterations;
    answer.limited = counters->limited;
    answer.bytes = dmb_sim_bytes(sim->scene);
    answer.worst_residual = counters->worst_residual;
    answer.projection[0] = counters->projection[0];
    answer.projection[1] = counters->projection[1];
    return dmb_statistics_write(statistics, &answer);
}
