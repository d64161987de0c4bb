/* A recorder as the caller filled it, checked. */
#include <math.h>

#include "base/sized_struct.h"
#include "output/output.h"
#include "output/text_file.h"
#include "query/query.h"
#include "sim/access.h"

DMB_DECLARE_STRUCT(dmb_recorder)

enum { DMB_OUTPUTS_MAX = 4096 };

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
    if (out->output_count < 1 || out->output_count > DMB_OUTPUTS_MAX) return DMB_ERR_VALUE;
    if (out->outputs == NULL || (out->table == NULL && out->capacity > 0)) return DMB_ERR_NULL;
    if (!isfinite(out->interval)) return DMB_ERR_NOT_FINITE;
    if (out->interval < 0.0 || !dmb_table_fits(out->row_count, out->capacity, 1u + out->output_count))
        return DMB_ERR_VALUE;
    return DMB_OK;
}

static double *row_of(const dmb_recorder *r, uint64_t row)
{
    return r->table + (size_t)row * (1u + r->output_count);
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

static int32_t value_of(const dmb_recorder *r, const dmb_sim *sim, const dmb_output *output, double *value)
{
    if (r->window != NULL && output->quantity >= DMB_OUTPUT_WINDOW_MINIMUM &&
        output->quantity <= DMB_OUTPUT_WINDOW_LOW_SHARE)
        return dmb_window_value(r->window, output, value);
    return dmb_output_value(sim, output, value);
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
    for (uint32_t i = 0; i < r.output_count; ++i) {
        status = value_of(&r, sim, &r.outputs[i], &row[1 + i]);
        if (status < 0) return status;
    }
    recorder->row_count = r.row_count + 1;
    return DMB_OK;
}

/* ---- Profiles ---------------------------------------------------------------------------------------------------- */

/* Rows of whole profiles over time, in the caller's memory and as CSV. */

DMB_DEFINE_INIT(dmb_profile_recorder, 48, {.row_count = 0})
DMB_DECLARE_STRUCT(dmb_profile)

/* As of dmb_query_profile. */
enum { STATIONS_MAX = 1 << 24 };

static uint64_t width_of(const dmb_profile *profile)
{
    return 1 + (uint64_t)profile->station_count * profile->quantity_count;
}

/* Copies of both structs, as far as they can be checked without a sim. */
static int32_t take_structs(const dmb_profile_recorder *given, dmb_profile_recorder *r, dmb_profile *profile)
{
    int32_t status;
    if (given == NULL) return DMB_ERR_NULL;
    status = dmb_profile_recorder_read(r, given);
    if (status < 0) return status;
    if (r->profile == NULL || (r->table == NULL && r->capacity > 0)) return DMB_ERR_NULL;
    status = dmb_profile_read(profile, r->profile);
    if (status < 0) return status;
    if (profile->quantities == NULL) return DMB_ERR_NULL;
    if (profile->station_count < 1 || profile->station_count > STATIONS_MAX) return DMB_ERR_VALUE;
    if (profile->quantity_count < 1 || profile->quantity_count > DMB_PROFILE_COUNT) return DMB_ERR_VALUE;
    if (!isfinite(r->interval)) return DMB_ERR_NOT_FINITE;
    return r->interval < 0.0 || !dmb_table_fits(r->row_count, r->capacity, width_of(profile)) ? DMB_ERR_VALUE : DMB_OK;
}

/* The row counts only once it is whole. */
int32_t dmb_profile_recorder_take(dmb_profile_recorder *recorder, const dmb_sim *sim)
{
    int32_t status = dmb_sim_check(sim);
    dmb_profile_recorder r;
    dmb_profile profile;
    double *row;
    if (status == DMB_OK) status = take_structs(recorder, &r, &profile);
    if (status < 0) return status;
    const double time = dmb_sim_time(sim);
    const size_t width = (size_t)width_of(&profile);
    if (r.row_count > 0 && !dmb_sample_is_due(r.interval, r.table[0], r.table[(r.row_count - 1) * width], time))
        return DMB_OK;
    if (r.row_count == r.capacity) return DMB_NOTE_FULL;
    row = r.table + (size_t)r.row_count * width;
    profile.values = row + 1;
    profile.station_stride = profile.quantity_count;
    profile.quantity_stride = 1;
    status = dmb_query_profile(sim, &profile);
    if (status < 0) return status;
    row[0] = time;
    recorder->row_count = r.row_count + 1;
    return DMB_OK;
}

static void put_header(dmb_text_file *file, const dmb_profile *profile)
{
    dmb_text_put(file, "time [s],station");
    for (uint32_t q = 0; q < profile->quantity_count; q++) {
        const char *unit, *name = dmb_profile_name(profile->quantities[q], &unit);
        dmb_text_put(file, ",");
        dmb_text_put(file, name != NULL ? name : "unknown");
        dmb_text_put(file, " [");
        dmb_text_put(file, name != NULL ? unit : "-");
        dmb_text_put(file, "]");
    }
    dmb_text_put(file, "\n");
}

static void put_row(dmb_text_file *file, const dmb_profile *profile, const double *row)
{
    const double *value = row + 1;
    for (uint32_t i = 0; i < profile->station_count; i++) {
        dmb_text_put_number(file, row[0]);
        dmb_text_put(file, ",");
        dmb_text_put_count(file, i);
        for (uint32_t q = 0; q < profile->quantity_count; q++) {
            dmb_text_put(file, ",");
            dmb_text_put_number(file, *value++);
        }
        dmb_text_put(file, "\n");
    }
}

int32_t dmb_profile_recorder_write_csv(const dmb_profile_recorder *recorder, const char *path)
{
    dmb_profile_recorder r;
    dmb_profile profile;
    dmb_text_file file;
    int32_t status = take_structs(recorder, &r, &profile);
    if (status < 0) return status;
    if (path == NULL) return DMB_ERR_NULL;
    status = dmb_text_open(&file, path);
    if (status < 0) return status;
    put_header(&file, &profile);
    for (uint64_t i = 0; i < r.row_count; i++) put_row(&file, &profile, r.table + (size_t)(i * width_of(&profile)));
    return dmb_text_close(&file);
}
