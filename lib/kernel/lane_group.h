/* Which places of a run are side by side, and how their numbers get into lanes and out of them. */
#ifndef DMB_KERNEL_LANE_GROUP_H
#define DMB_KERNEL_LANE_GROUP_H

#include "math/real.h"

#define LANES DMB_REAL_LANES

/* Places of a group of lanes in a run: behind its end the last one is taken again, and left out when results are
 * stored. */
typedef struct lane_group {
    uint32_t place[LANES];
    uint32_t used;
} lane_group;

static lane_group group_at(uint32_t first, uint32_t count)
{
    lane_group g;
    g.used = count - first < LANES ? count - first : LANES;
    for (uint32_t l = 0; l < LANES; l++) g.place[l] = l < g.used ? first + l : count - 1;
    return g;
}

/* x[i] = numbers i of `size` at each place, i < count */
static inline void load(const double *from, uint32_t size, uint32_t count, const lane_group *g, uint32_t next,
                        dmb_real *x)
{
    for (uint32_t i = 0; i < count; i++) {
        dmb_real numbers = dmb_real_of(from[size * (g->place[0] + next) + i]);
        for (int l = 1; l < LANES; l++) dmb_real_set_lane(&numbers, l, from[size * (g->place[l] + next) + i]);
        x[i] = numbers;
    }
}

static inline void store(const dmb_real *x, uint32_t size, const lane_group *g, double *to)
{
    for (uint32_t l = 0; l < g->used; l++)
        for (uint32_t i = 0; i < size; i++) to[size * g->place[l] + i] = dmb_real_lane(x + i, (int)l);
}

static inline void add_lane(const dmb_real *x, int lane, uint32_t count, double *restrict to)
{
    for (uint32_t i = 0; i < count; i++) to[i] += dmb_real_lane(x + i, lane);
}

#endif
