/* The counts of a dmb_fatigue as bytes, from which another one with the same options and places can continue. */
#include "output/fatigue.h"

#include <math.h>
#include <string.h>

#include "base/failure.h"
#include "sim/access.h"

#define MARK UINT64_C(0x31657567697461) /* "atigue1" */

/* Header of the snapshot. The clipped samples of each place, the counters without their pointers, and the arrays of the
 * counters follow. */
typedef struct head {
    uint64_t mark;
    dmb_fatigue_options options;
    uint64_t place_count, samples;
    double first, last;
} head;

static size_t counters_of(const dmb_fatigue *fatigue)
{
    return (size_t)fatigue->place_count * fatigue->options.points;
}

/* Histograms and turning points follow each other in the block and are copied in one piece. */
static size_t array_bytes(const dmb_fatigue *fatigue)
{
    const size_t classes = fatigue->options.classes;
    return counters_of(fatigue) * (classes * sizeof(double) + (classes + 4) * sizeof(dmb_turn));
}

static size_t bytes_of(const dmb_fatigue *fatigue)
{
    return sizeof(head) + fatigue->place_count * sizeof(uint64_t) + counters_of(fatigue) * sizeof(dmb_fatigue_counter) +
           array_bytes(fatigue);
}

static int32_t check(const dmb_fatigue *fatigue, const void *other)
{
    if (fatigue == NULL) return DMB_ERR_NULL;
    if (!dmb_handle_is(fatigue, DMB_HANDLE_FATIGUE)) return DMB_ERR_HANDLE;
    return other == NULL ? DMB_ERR_NULL : DMB_OK;
}

int32_t dmb_fatigue_snapshot_size(const dmb_fatigue *fatigue, size_t *size)
{
    const int32_t status = check(fatigue, size);
    if (status >= 0) *size = bytes_of(fatigue);
    return dmb_failed("fatigue", status);
}

/* ---- Saving ------------------------------------------------------------------------------------------------------ */

static unsigned char *put(unsigned char *to, const void *from, size_t bytes)
{
    memcpy(to, from, bytes);
    return to + bytes;
}

int32_t dmb_fatigue_snapshot(const dmb_fatigue *fatigue, void *block, size_t size)
{
    const int32_t status = check(fatigue, block);
    unsigned char *to = block;
    if (status < 0) return dmb_failed("fatigue", status);
    if (size != bytes_of(fatigue)) return dmb_failed("fatigue", DMB_ERR_VALUE);
    const head start = {MARK, fatigue->options, fatigue->place_count, fatigue->samples, fatigue->first, fatigue->last};
    to = put(to, &start, sizeof start);
    for (uint32_t i = 0; i < fatigue->place_count; i++)
        to = put(to, &fatigue->sections[i].clipped, sizeof fatigue->sections[i].clipped);
    for (size_t i = 0; i < counters_of(fatigue); i++) {
        dmb_fatigue_counter counter = fatigue->counters[i];
        counter.cycles = NULL;
        counter.flow.turns = NULL;
        to = put(to, &counter, sizeof counter);
    }
    (void)put(to, fatigue->counters[0].cycles, array_bytes(fatigue));
    return DMB_OK;
}

/* ---- Restoring --------------------------------------------------------------------------------------------------- */

static int is_count(double value)
{
    return value >= 0.0 && isfinite(value);
}

static uint32_t range(const dmb_turn *a, const dmb_turn *b)
{
    return a->level > b->level ? a->level - b->level : b->level - a->level;
}

static dmb_turn turn_at(const unsigned char *turns, uint32_t i)
{
    dmb_turn turn;
    memcpy(&turn, turns + i * sizeof turn, sizeof turn);
    return turn;
}

/* Checks the turning points: they alternate, and all ranges except the last decrease. Of `classes` levels at most
 * classes + 1 are then possible, which leaves space for one more sample. */
static int are_turns(const unsigned char *turns, uint32_t count, uint32_t classes)
{
    if (count > classes + 2) return 0;
    for (uint32_t i = 0; i < count; i++) {
        const dmb_turn at = turn_at(turns, i);
        if (at.level >= classes || !isfinite(at.value)) return 0;
        if (i == 0) continue;
        const dmb_turn before = turn_at(turns, i - 1);
        if (at.level == before.level) return 0;
        if (i == 1) continue;
        const dmb_turn first = turn_at(turns, i - 2);
        if ((at.level > before.level) == (before.level > first.level)) return 0;
        if (i + 1 < count && range(&at, &before) >= range(&before, &first)) return 0;
    }
    return 1;
}

static int is_counter(const dmb_fatigue_counter *counter, uint32_t classes)
{
    return counter->damage >= 0.0 && is_count(counter->count) && is_count(counter->range) && !isnan(counter->lowest) &&
           !isnan(counter->highest) && counter->largest < classes;
}

/* Checks the counters and their arrays, because the bytes come from outside. */
static int are_counters(const dmb_fatigue *fatigue, const unsigned char *counters)
{
    const uint32_t classes = fatigue->options.classes;
    const size_t count = counters_of(fatigue);
    const unsigned char *numbers = counters + count * sizeof(dmb_fatigue_counter);
    const unsigned char *turns = numbers + count * classes * sizeof(double);
    for (size_t i = 0; i < count * classes; i++) {
        double cycles;
        memcpy(&cycles, numbers + i * sizeof cycles, sizeof cycles);
        if (!is_count(cycles)) return 0;
    }
    for (size_t i = 0; i < count; i++) {
        dmb_fatigue_counter counter;
        memcpy(&counter, counters + i * sizeof counter, sizeof counter);
        if (!is_counter(&counter, classes) ||
            !are_turns(turns + i * (classes + 4) * sizeof(dmb_turn), counter.flow.count, classes))
            return 0;
    }
    return 1;
}

static int is_of(const dmb_fatigue *fatigue, const head *start)
{
    return start->mark == MARK && start->place_count == fatigue->place_count && isfinite(start->first) &&
           isfinite(start->last) && memcmp(&start->options, &fatigue->options, sizeof fatigue->options) == 0;
}

int32_t dmb_fatigue_restore(dmb_fatigue *fatigue, const void *block, size_t size)
{
    const int32_t status = check(fatigue, block);
    const unsigned char *from = block;
    head start;
    if (status < 0) return dmb_failed("fatigue", status);
    if (size != bytes_of(fatigue)) return dmb_failed("fatigue", DMB_ERR_VALUE);
    memcpy(&start, from, sizeof start);
    from += sizeof start;
    if (!is_of(fatigue, &start) || !are_counters(fatigue, from + fatigue->place_count * sizeof(uint64_t)))
        return dmb_failed("fatigue", DMB_ERR_VALUE);
    for (uint32_t i = 0; i < fatigue->place_count; i++, from += sizeof(uint64_t))
        memcpy(&fatigue->sections[i].clipped, from, sizeof(uint64_t));
    for (size_t i = 0; i < counters_of(fatigue); i++, from += sizeof(dmb_fatigue_counter)) {
        dmb_fatigue_counter *to = &fatigue->counters[i];
        double *const cycles = to->cycles;
        dmb_turn *const turns = to->flow.turns;
        memcpy(to, from, sizeof *to);
        to->cycles = cycles;
        to->flow.turns = turns;
    }
    memcpy(fatigue->counters[0].cycles, from, array_bytes(fatigue));
    fatigue->samples = start.samples;
    fatigue->first = start.first;
    fatigue->last = start.last;
    return DMB_OK;
}
