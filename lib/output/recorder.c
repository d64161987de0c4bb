#include "output/recorder.h"

#include <math.h>

#include "base/sized_struct.h"
#include "query/channel.h"
#include "sim/access.h"

DMB_DECLARE_STRUCT(dmb_recorder)

enum { DMB_CHANNELS_MAX = 4096 };

/* A sample that falls short of its time by this part of an interval has reached it: sums of steps round. */
#define DMB_SAMPLE_SLACK 1e-6

static int table_fits(const dmb_recorder *r)
{
    return r->row_count <= r->capacity && r->capacity <= SIZE_MAX / sizeof(double) / (1u + r->channel_count);
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
    if (out->interval < 0.0 || !table_fits(out)) return DMB_ERR_VALUE;
    return DMB_OK;
}

static double *row_of(const dmb_recorder *r, uint64_t row)
{
    return r->table + (size_t)row * (1u + r->channel_count);
}

/* Samples belong to whole multiples of the interval since the first one, so that they do not drift with the steps. */
static int is_due(const dmb_recorder *r, double time)
{
    double first, last;
    if (r->row_count == 0 || !(r->interval > 0.0)) return 1;
    first = row_of(r, 0)[0];
    last = row_of(r, r->row_count - 1)[0];
    return floor((time - first) / r->interval + DMB_SAMPLE_SLACK) >
           floor((last - first) / r->interval + DMB_SAMPLE_SLACK);
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
        status = dmb_channel_value(sim, &r.channels[i], &row[1 + i]);
        if (status < 0) return status;
    }
    recorder->row_count = r.row_count + 1;
    return DMB_OK;
}
