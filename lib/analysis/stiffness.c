#include "analysis/stiffness.h"

#include "math/block_inertia.h"

int32_t dmb_stiffness_negative(const dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    uint32_t negative = 0;
    if (scene->cluster_count) return -1;
    for (uint32_t c = 0; c < scene->chain_count; c++)
        negative += dmb_block_negative(&scene->layout, sim->stiffness_diagonal, sim->stiffness_lower,
                                       sim->stiffness_upper, scene->chains[c].first, scene->chains[c].count);
    return (int32_t)negative;
}
