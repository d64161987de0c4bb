#include "query/ask.h"
#include "query/constraint.h"
#include "state/layout.h"

DMB_DECLARE_STRUCT(dmb_statistics)

static void count_constraints(const dmb_sim *sim, dmb_statistics *answer)
{
    for (uint32_t k = 0; k < sim->scene->cluster_count; k++) answer->dependent += sim->partition_rank[k];
    for (uint32_t i = 0; i < sim->scene->constraint_count; i++) answer->redundant += dmb_constraint_active(sim, i);
    answer->redundant -= answer->dependent;
    for (uint32_t j = 0; j < sim->scene->joint_count; j++)
        answer->misfit = fmax(answer->misfit, dmb_joint_misfit(sim, j));
}

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
    answer.assembly[0] = counters->assembly[0];
    answer.assembly[1] = counters->assembly[1];
    answer.switches = counters->switches;
    count_constraints(sim, &answer);
    return dmb_statistics_write(statistics, &answer);
}
