/* Rainflow counting of a sequence of levels as it arrives (ASTM E1049, 5.4.4; Matsuishi, Endo 1968). Turning points
 * with decreasing ranges are not counted yet: for levels 0 .. n - 1 at most n + 2. Cycles are reported with the values
 * of their turning points, not with the centres of levels. */
#include "output/output.h"

#include <math.h>

static uint32_t range(const dmb_turn *a, const dmb_turn *b)
{
    return a->level > b->level ? a->level - b->level : b->level - a->level;
}

static void tell(dmb_rainflow_fn count, void *context, const dmb_turn *a, const dmb_turn *b, double weight)
{
    count(context, a->level < b->level ? a : b, a->level < b->level ? b : a, weight);
}

/* 1 if the level continues in the direction of the last two turning points: it then replaces the last one. */
static int goes_on(const dmb_rainflow *flow, uint32_t level)
{
    const dmb_turn *last = flow->turns + flow->count - 1;
    return flow->count > 1 && (last[0].level > last[-1].level) == (level > last[0].level);
}

/* Updates the extreme value of the last turning point within its level; the first one has no direction yet. */
static void stay(dmb_rainflow *flow, double value)
{
    dmb_turn *last = flow->turns + flow->count - 1;
    if (flow->count < 2) return;
    last->value = last[0].level > last[-1].level ? fmax(last->value, value) : fmin(last->value, value);
}

/* X is the range of the last two turning points, Y that of the two before. If X >= Y, Y is counted: as a cycle, and its
 * turning points are removed; or as a half cycle if it contains the first turning point, which is removed
 * (eq:fatigue.rainflow). */
static void reduce(dmb_rainflow *flow, dmb_rainflow_fn count, void *context)
{
    while (flow->count >= 3) {
        dmb_turn *end = flow->turns + flow->count;
        if (range(end - 1, end - 2) < range(end - 2, end - 3)) return;
        if (flow->count == 3) {
            tell(count, context, end - 3, end - 2, 0.5);
            end[-3] = end[-2];
            end[-2] = end[-1];
            flow->count = 2;
        } else {
            tell(count, context, end - 3, end - 2, 1.0);
            end[-3] = end[-1];
            flow->count -= 2;
        }
    }
}

/* A turning point is final only when the next level reverses the direction. Until then the last one is not counted
 * against the earlier ones. */
void dmb_rainflow_add(dmb_rainflow *flow, uint32_t level, double value, dmb_rainflow_fn count, void *context)
{
    const dmb_turn turn = {value, level, 0};
    if (flow->count > 0 && level == flow->turns[flow->count - 1].level) {
        stay(flow, value);
        return;
    }
    if (goes_on(flow, level)) {
        flow->turns[flow->count - 1] = turn;
        return;
    }
    reduce(flow, count, context);
    flow->turns[flow->count++] = turn;
}

static void visit_rest(const dmb_rainflow *flow, dmb_rainflow_fn count, void *context)
{
    for (uint32_t i = 1; i < flow->count; i++) tell(count, context, flow->turns + i - 1, flow->turns + i, 0.5);
}

/* The last level is treated as a turning point: cycles that it closes are full cycles. They are at the end of the list
 * and are skipped, together with their turning points, without writing to it. */
void dmb_rainflow_rest(const dmb_rainflow *flow, dmb_rainflow_fn count, void *context)
{
    uint32_t n = flow->count, first = 0;
    if (n < 3) {
        visit_rest(flow, count, context);
        return;
    }
    const dmb_turn *last = flow->turns + n - 1;
    n--; /* turning points before the last one */
    while (n - first >= 2 && range(last, flow->turns + n - 1) >= range(flow->turns + n - 1, flow->turns + n - 2)) {
        const int whole = n - first > 2;
        tell(count, context, flow->turns + n - 2, flow->turns + n - 1, whole ? 1.0 : 0.5);
        if (whole)
            n -= 2;
        else
            first++;
    }
    for (uint32_t i = first + 1; i < n; i++) tell(count, context, flow->turns + i - 1, flow->turns + i, 0.5);
    tell(count, context, flow->turns + n - 1, last, 0.5);
}
