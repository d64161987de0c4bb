/* Rainflow counting of a sequence of levels as it arrives (ASTM E1049, 5.4.4; Matsuishi, Endo 1968). Turning points
 * whose ranges shrink are not counted yet: of levels 0 .. n - 1 at most n + 2. Cycles are told with the values of their
 * turning points, not with the middles of levels. */
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

/* The last level goes on in the direction of the one before it: it takes its place. */
static int goes_on(const dmb_rainflow *flow, uint32_t level)
{
    const dmb_turn *last = flow->turns + flow->count - 1;
    return flow->count > 1 && (last[0].level > last[-1].level) == (level > last[0].level);
}

/* Within the level of the last turn it may lie farther out; the start has no direction yet. */
static void stay(dmb_rainflow *flow, double value)
{
    dmb_turn *last = flow->turns + flow->count - 1;
    if (flow->count < 2) return;
    last->value = last[0].level > last[-1].level ? fmax(last->value, value) : fmin(last->value, value);
}

/* X the range of the last two turns, Y that of the two before: Y is counted where X >= Y; as a cycle, and its turns go,
 * or as half a one with the start of all, which goes (eq:fatigue.rainflow). */
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

/* A turn is one only once the next level turns back: the last one is not counted against those before until then. */
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

/* The last turn counts as one: cycles that it closes are whole ones. They are at the end of the list and are passed
 * over, together with their turns, without writing. */
void dmb_rainflow_rest(const dmb_rainflow *flow, dmb_rainflow_fn count, void *context)
{
    uint32_t n = flow->count, first = 0;
    if (n < 3) {
        visit_rest(flow, count, context);
        return;
    }
    const dmb_turn *last = flow->turns + n - 1;
    n--; /* turns before the last one */
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
