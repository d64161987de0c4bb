/* Rows of whole profiles over time, in the caller's memory and as CSV. */
#include <math.h>

#include "base/sized_struct.h"
#include "output/recorder.h"
#include "output/text_file.h"
#include "sim/access.h"

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
