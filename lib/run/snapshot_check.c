#include "run/snapshot_check.h"

#include <math.h>
#include <string.h>

#include "model/describe.h"
#include "model/limits.h"
#include "sim/own_scene.h"
#include "system/constrain/joint_motion.h"

/* A field of integers or of a struct has a bound of its own: a line of sim/sim.h that names none does not compile. */
#define DMB_DOUBLES(type) _Generic(*(type *)0, double : 1, default : 0)
#define DMB_NAMES_BOUND(type, name, count, check)                                                                 \
    _Static_assert(DMB_DOUBLES(type) ==                                                                           \
                       (DMB_CHECK_##check == DMB_CHECK_NUMBERS || DMB_CHECK_##check == DMB_CHECK_INPUTS ||        \
                        DMB_CHECK_##check == DMB_CHECK_SET_INPUTS || DMB_CHECK_##check == DMB_CHECK_EVENT_TIMES), \
                   #name ": its check does not fit its type");
DMB_CONFIGURATION_LIST(DMB_NAMES_BOUND)
DMB_MEMORY_LIST(DMB_NAMES_BOUND)
DMB_FACTOR_LIST(DMB_NAMES_BOUND)

/* One field in a snapshot, at any alignment. */
typedef struct probe {
    dmb_sim *sim;
    const dmb_field *field;
    const unsigned char *from;
} probe;

static int32_t refuse(const probe *p, size_t item, double value, const char *bound)
{
    dmb_message_set(
        &p->sim->message,
        "snapshot: %s, number %zu = %g, must be %s; these are no state of this model, take another snapshot",
        p->field->name, item, value, bound);
    return DMB_ERR_VALUE;
}

static double number_at(const probe *p, size_t i)
{
    double value;
    memcpy(&value, p->from + i * sizeof value, sizeof value);
    return value;
}

static uint32_t word_at(const probe *p, size_t i)
{
    uint32_t value;
    memcpy(&value, p->from + i * sizeof value, sizeof value);
    return value;
}

static int32_t check_numbers(const probe *p, size_t first, size_t end)
{
    for (size_t i = first; i < end; i++) {
        const double value = number_at(p, i);
        if (!isfinite(value)) return refuse(p, i, value, "finite");
    }
    return DMB_OK;
}

static int32_t check_inputs(const probe *p)
{
    for (size_t i = 0; i < p->field->bytes / sizeof(double); i++) {
        const double value = number_at(p, i);
        if (!isnan(value) && !(fabs(value) <= DMB_FORCE_MAX)) return refuse(p, i, value, "from -1e30 to 1e30, or NaN");
    }
    return DMB_OK;
}

static int32_t check_set_inputs(const probe *p)
{
    for (uint32_t i = 0; i < p->sim->scene->input_count; i++) {
        const dmb_scene_input *input = p->sim->scene->inputs + i;
        const double value = number_at(p, i);
        const int described = isnan(input->initial) != 0;
        if (input->target == DMB_TARGET_STUCK && value > 0.0 && value < 1.0) return refuse(p, i, value, "0 or 1");
        if (isnan(value) && described && dmb_input_is_programme(input->target)) continue;
        /* what is described may lie outside the bounds of what is set */
        if (value >= input->low && value <= input->high) continue;
        if (described && value == dmb_described_setting(p->sim, i)) continue;
        return refuse(p, i, value, "within the bounds of its input");
    }
    return DMB_OK;
}

static int32_t check_event_times(const probe *p)
{
    for (size_t i = 0; i < p->field->bytes / sizeof(double); i++) {
        const double value = number_at(p, i);
        if (isinf(value) && value < 0.0) return refuse(p, i, value, "a time, NaN or above all times");
    }
    return DMB_OK;
}

/* Words without the bits of `mark` below `end`. */
static int32_t check_words(const probe *p, uint32_t end, uint32_t mark)
{
    for (size_t i = 0; i < p->field->bytes / sizeof(uint32_t); i++) {
        const uint32_t value = word_at(p, i);
        if ((value & ~mark) >= end) return refuse(p, i, value, "an index or choice that the scene has");
    }
    return DMB_OK;
}

static int32_t check_ranks(const probe *p)
{
    for (uint32_t k = 0; k < p->sim->scene->cluster_count; k++) {
        const dmb_cluster *cluster = p->sim->scene->clusters + k;
        const uint32_t value = word_at(p, k);
        if (value > cluster->rows || value > cluster->columns)
            return refuse(p, k, value, "at most the rows and the columns of its cluster");
    }
    return DMB_OK;
}

/* A permutation of 0 .. count - 1, `first` being where it begins; cluster_scratch, which has more than a byte for each,
 * is where those seen are marked. */
static int32_t check_order(const probe *p, uint32_t first, uint32_t count)
{
    uint8_t *seen = (uint8_t *)(void *)p->sim->cluster_scratch;
    memset(seen, 0, count);
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t value = word_at(p, (size_t)first + i);
        if (value >= count || seen[value]) return refuse(p, (size_t)first + i, value, "one of its cluster, each once");
        seen[value] = 1;
    }
    return DMB_OK;
}

static int32_t check_orders(const probe *p, int32_t of_columns)
{
    int32_t status = DMB_OK;
    for (uint32_t k = 0; k < p->sim->scene->cluster_count && status >= 0; k++) {
        const dmb_cluster *cluster = p->sim->scene->clusters + k;
        status = of_columns ? check_order(p, cluster->column, cluster->columns)
                            : check_order(p, cluster->row, cluster->rows);
    }
    return status;
}

/* The newest of count samples stands at head, in a ring of the bit's capacity; without one both are 0. */
static int32_t check_heads(const probe *p)
{
    for (uint32_t k = 0; k < p->sim->scene->bit_count; k++) {
        const uint32_t capacity = p->sim->scene->bits[k].history_capacity;
        dmb_history_head head;
        memcpy(&head, p->from + k * sizeof head, sizeof head);
        if (head.head >= capacity && head.head != 0)
            return refuse(p, k, head.head, "below the capacity of the bit's history");
        if (head.count > capacity || (head.count == 0) != (capacity == 0))
            return refuse(p, k, head.count, "from 1 to the capacity of the bit's history");
        if (!isfinite(head.offset)) return refuse(p, k, head.offset, "finite");
    }
    return DMB_OK;
}

static int32_t check_clock(const probe *p)
{
    const int32_t status = check_numbers(p, 0, sizeof(dmb_clock) / sizeof(double)); /* all members are */
    dmb_clock clock;
    memcpy(&clock, p->from, sizeof clock);
    if (status < 0) return status;
    if (!(clock.time >= 0.0)) return refuse(p, 0, clock.time, ">= 0");
    if (!(clock.step >= 0.0)) return refuse(p, 1, clock.step, ">= 0");
    if (!(clock.next_step >= 0.0)) return refuse(p, 2, clock.next_step, ">= 0");
    return DMB_OK;
}

static int32_t check_counters(const probe *p)
{
    dmb_counters counters;
    memcpy(&counters, p->from, sizeof counters);
    const double numbers[] = {counters.largest_residual, counters.projection[0], counters.projection[1],
                              counters.assembly[0], counters.assembly[1]};
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++)
        if (!isfinite(numbers[i])) return refuse(p, i, numbers[i], "finite");
    return DMB_OK;
}

static int32_t check_factors(const probe *p)
{
    dmb_factor_reuse kept;
    memcpy(&kept, p->from, sizeof kept);
    return kept.step >= 0.0 && isfinite(kept.step) ? DMB_OK : refuse(p, 0, kept.step, "finite and >= 0");
}

static int32_t check_field(const probe *p)
{
    const dmb_hole *hole = &p->sim->scene->hole;
    const uint32_t segments = p->sim->scene->has_hole && !dmb_hole_is_straight(hole) ? hole->stations : 1;
    switch (p->field->check) {
    case DMB_CHECK_NUMBERS: return check_numbers(p, 0, p->field->bytes / sizeof(double));
    case DMB_CHECK_INPUTS: return check_inputs(p);
    case DMB_CHECK_SET_INPUTS: return check_set_inputs(p);
    case DMB_CHECK_EVENT_TIMES: return check_event_times(p);
    case DMB_CHECK_FLAGS: return check_words(p, 2, 0);
    case DMB_CHECK_SEGMENTS: return check_words(p, segments, 0);
    case DMB_CHECK_JOINT_SEGMENTS: return check_words(p, segments, DMB_SEGMENT_HELD);
    case DMB_CHECK_JOINT_STATES: return check_words(p, DMB_JOINT_OPEN + 1, 0);
    case DMB_CHECK_RANKS: return check_ranks(p);
    case DMB_CHECK_ROW_ORDER: return check_orders(p, 0);
    case DMB_CHECK_COLUMN_ORDER: return check_orders(p, 1);
    case DMB_CHECK_HISTORY_HEADS: return check_heads(p);
    case DMB_CHECK_CLOCK: return check_clock(p);
    case DMB_CHECK_LEDGER: return check_numbers(p, 0, sizeof(dmb_ledger) / sizeof(double)); /* all members are */
    case DMB_CHECK_COUNTERS: return check_counters(p);
    case DMB_CHECK_REUSE: return check_factors(p);
    default: return refuse(p, 0, p->field->check, "a field with a check"); /* not reached */
    }
}

int32_t dmb_snapshot_check(dmb_sim *sim, const dmb_field *fields, size_t count, const unsigned char *from)
{
    int32_t status = DMB_OK;
    for (size_t i = 0; i < count && status >= 0; i++) {
        const probe p = {sim, fields + i, from};
        if (fields[i].bytes > 0) status = check_field(&p);
        from += fields[i].bytes;
    }
    return status;
}
