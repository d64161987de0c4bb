#include "output/recorder.h"

#include <math.h>

#include "base/sized_struct.h"
#include "output/window.h"
#include "query/channel.h"
#include "sim/access.h"

DMB_DECLARE_STRUCT(dmb_recorder)

enum { DMB_CHANNELS_MAX = 4096 };

/* A sample that falls short of its time by this part of an interval has reached it: sums of steps round. */
#define DMB_SAMPLE_SLACK 1e-6

int dmb_table_fits(uint64_t row_count, uint64_t capacity, uint64_t width)
{
    return row_count <= capacity && capacity <= SIZE_MAX / sizeof(double) / width;
}

int32_t dmb_recorder_take_struct(dmb_recorder *out, const dmb_recorder *given)
{
    int32_t status;
    if (given == NULL) return DMB_ERR_NULL;
    status = dmb_recorder_read(out, given);
    if (status < 0) return status;
    if (out->channel_count < 1 || out->channel_count > DMB_CHANNELS_MAX) return DMB_ERR_VALUE;
    if (out->channels == NULL || (out->table == NULL && out->capacity > 0)) return DMB_ERR_NULL;
    if (!isfinite(out->interval)) return DMB_ERR_NOT_FINITE;
    if (out->interval < 0.0 || !dmb_table_fits(out->row_count, out->capacity, 1u + out->channel_count))
        return DMB_ERR_VALUE;
    return DMB_OK;
}

static double *row_of(const dmb_recorder *r, uint64_t row)
{
    return r->table + (size_t)row * (1u + r->channel_count);
}

int dmb_sample_is_due(double interval, double first, double last, double time)
{
    if (!(interval > 0.0)) return 1;
    return floor((time - first) / interval + DMB_SAMPLE_SLACK) > floor((last - first) / interval + DMB_SAMPLE_SLACK);
}

static int is_due(const dmb_recorder *r, double time)
{
    return r->row_count == 0 || dmb_sample_is_due(r->interval, row_of(r, 0)[0], row_of(r, r->row_count - 1)[0], time);
}

static int32_t value_of(const dmb_recorder *r, const dmb_sim *sim, const dmb_channel *channel, double *value)
{
    if (r->window != NULL && channel->quantity >= DMB_CHANNEL_WINDOW_MINIMUM &&
        channel->quantity <= DMB_CHANNEL_WINDOW_LOW_SHARE)
        return dmb_window_value(r->window, channel, value);
    return dmb_channel_value(sim, channel, value);
}

/* The row counts only once it is whole. */
int32_t dmb_recorder_take(dmb_recorder *recorder, const dmb_sim *sim)
{
    int32_t status = dmb_sim_check(sim);
    dmb_recorder r;
    double *row;
    if (status == DMB_OK) status = dmb_recorder_take_struct(&r, recorder);
    if (status < 0) return status;
    if (!is_due(&r, dmb_sim_time(sim))) return DMB_OK;
    if (r.row_count == r.capacity) return DMB_NOTE_FULL;
    row = row_of(&r, r.row_count);
    row[0] = dmb_sim_time(sim);
    for (uint32_t i = 0; i < r.channel_count; ++i) {
        status = value_of(&r, sim, &r.channels[i], &row[1 + i]);
        if (status < 0) return status;
    }
    recorder->row_count = r.row_count + 1;
    return DMB_OK;
}
