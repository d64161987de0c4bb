/* Copy of the caller's recorder, checked. */
#include <math.h>

#include "base/sized_struct.h"
#include "base/value_check.h"
#include "output/output.h"
#include "output/text_file.h"
#include "query/query.h"
#include "sim/access.h"

DMB_DECLARE_STRUCT(dmb_recorder)

enum { DMB_OUTPUTS_MAX = 4096 };

/* A sample that is earlier than its time by less than this fraction of an interval is due: sums of step lengths have
 * rounding errors. */
#define DMB_SAMPLE_SLACK 1e-6

int dmb_table_fits(uint64_t row_count, uint64_t capacity, uint64_t width)
{
    return row_count <= capacity && capacity <= SIZE_MAX / sizeof(double) / width;
}

/* Rows in a table that the caller keeps. */
static void check_table(dmb_check *check, const double *table, uint64_t row_count, uint64_t capacity, uint64_t width)
{
    if (capacity > 0) dmb_check_pointer(check, "table", table);
    if (!dmb_table_fits(row_count, capacity, width))
        dmb_check_fail(check, DMB_ERR_VALUE, "row_count", (double)row_count,
                       "<= capacity, and capacity one whose table fits into memory; start with row_count 0");
}

int32_t dmb_recorder_read_struct(dmb_recorder *out, const dmb_recorder *given, dmb_message *why)
{
    dmb_check check = dmb_check_of(why, "recorder", DMB_NONE);
    if (given == NULL) return DMB_ERR_NULL;
    const int32_t status = dmb_recorder_read(out, given);
    if (status < 0) return status;
    dmb_check_count(&check, "output_count", out->output_count, 1, DMB_OUTPUTS_MAX);
    dmb_check_pointer(&check, "outputs", out->outputs);
    dmb_check_at_least(&check, "interval", out->interval, 0.0);
    if (check.status == DMB_OK)
        check_table(&check, out->table, out->row_count, out->capacity, 1 + (uint64_t)out->output_count);
    return check.status;
}

/* A sim that went back to before the last row would write rows out of order, or none until it is there again. */
static int32_t check_order(double last, double time, const char *what, dmb_message *why)
{
    if (!(time < last)) return DMB_OK;
    dmb_message_set(why,
                    "%s: time of the sim = %g s, must be >= %g s, that of the last row; set row_count to the number of "
                    "rows to keep after a restore",
                    what, time, last);
    return DMB_ERR_ORDER;
}

static double *row_of(const dmb_recorder *r, uint64_t row)
{
    return r->table + (size_t)row * (1u + r->output_count);
}

/* Samples are due at multiples of the interval since the first row: the first step that reaches or passes one is
 * recorded, so that late samples do not shift later ones. */
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

/* The row is counted only when it is complete. */
static int32_t take(dmb_recorder *recorder, const dmb_sim *sim, dmb_message *why)
{
    int32_t status = dmb_sim_check(sim);
    dmb_recorder r;
    double *row;
    if (status == DMB_OK) status = dmb_recorder_read_struct(&r, recorder, why);
    if (status == DMB_OK && r.row_count > 0)
        status = check_order(row_of(&r, r.row_count - 1)[0], dmb_sim_time(sim), "recorder", why);
    if (status < 0) return status;
    if (!is_due(&r, dmb_sim_time(sim))) return DMB_OK;
    if (r.row_count == r.capacity) return DMB_NOTE_FULL;
    row = row_of(&r, r.row_count);
    row[0] = dmb_sim_time(sim);
    for (uint32_t i = 0; i < r.output_count; ++i) {
        status = value_of(&r, sim, &r.outputs[i], &row[1 + i]);
        if (status < 0) dmb_output_explain(sim->model, &r.outputs[i], i, status, why);
        if (status < 0) return status;
    }
    recorder->row_count = r.row_count + 1;
    return DMB_OK;
}

int32_t dmb_recorder_take(dmb_recorder *recorder, const dmb_sim *sim)
{
    dmb_message why;
    dmb_message_clear(&why);
    const int32_t status = take(recorder, sim, &why);
    return status < 0 ? dmb_sim_fail(sim, status, "recorder", why.text) : status;
}

/* ---- Profiles ---------------------------------------------------------------------------------------------------- */

/* Rows of whole profiles over time, in the caller's memory and as CSV. */

DMB_DEFINE_INIT(dmb_profile_recorder, 48, {.row_count = 0})
DMB_DECLARE_STRUCT(dmb_profile)

/* Bound of dmb_query_profile. */
enum { STATIONS_MAX = 1 << 24 };

static uint64_t width_of(const dmb_profile *profile)
{
    return 1 + (uint64_t)profile->station_count * profile->quantity_count;
}

/* Copies both structs and checks them as far as possible without a sim. */
static int32_t read_structs(const dmb_profile_recorder *given, dmb_profile_recorder *r, dmb_profile *profile,
                            dmb_message *why)
{
    dmb_check check = dmb_check_of(why, "profile recorder", DMB_NONE);
    if (given == NULL) return DMB_ERR_NULL;
    int32_t status = dmb_profile_recorder_read(r, given);
    if (status < 0) return status;
    dmb_check_pointer(&check, "profile", r->profile);
    if (check.status < 0) return check.status;
    status = dmb_profile_read(profile, r->profile);
    if (status < 0) return status;
    dmb_check_pointer(&check, "quantities of the profile", profile->quantities);
    dmb_check_count(&check, "station_count of the profile", profile->station_count, 1, STATIONS_MAX);
    dmb_check_count(&check, "quantity_count of the profile", profile->quantity_count, 1, DMB_PROFILE_QUANTITIES);
    dmb_check_at_least(&check, "interval", r->interval, 0.0);
    if (check.status == DMB_OK) check_table(&check, r->table, r->row_count, r->capacity, width_of(profile));
    return check.status;
}

/* The row is counted only when it is complete. */
static int32_t record_profile(dmb_profile_recorder *recorder, const dmb_sim *sim, dmb_message *why)
{
    int32_t status = dmb_sim_check(sim);
    dmb_profile_recorder r;
    dmb_profile profile;
    double *row;
    if (status == DMB_OK) status = read_structs(recorder, &r, &profile, why);
    if (status < 0) return status;
    const double time = dmb_sim_time(sim);
    const size_t width = (size_t)width_of(&profile);
    if (r.row_count > 0) status = check_order(r.table[(r.row_count - 1) * width], time, "profile recorder", why);
    if (status < 0) return status;
    if (r.row_count > 0 && !dmb_sample_is_due(r.interval, r.table[0], r.table[(r.row_count - 1) * width], time))
        return DMB_OK;
    if (r.row_count == r.capacity) return DMB_NOTE_FULL;
    row = r.table + (size_t)r.row_count * width;
    profile.values = row + 1;
    profile.station_stride = profile.quantity_count;
    profile.quantity_stride = 1;
    status = dmb_answer_profile(sim, &profile);
    if (status < 0) return status;
    row[0] = time;
    recorder->row_count = r.row_count + 1;
    return DMB_OK;
}

int32_t dmb_profile_recorder_take(dmb_profile_recorder *recorder, const dmb_sim *sim)
{
    dmb_message why;
    dmb_message_clear(&why);
    const int32_t status = record_profile(recorder, sim, &why);
    return status < 0 ? dmb_sim_fail(sim, status, "profile recorder", why.text) : status;
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

static int32_t write_profiles(const dmb_profile_recorder *recorder, const char *path, dmb_message *why)
{
    dmb_profile_recorder r;
    dmb_profile profile;
    dmb_text_file file;
    int32_t status = read_structs(recorder, &r, &profile, why);
    if (status < 0) return status;
    if (path == NULL) return DMB_ERR_NULL;
    status = dmb_text_open(&file, path);
    if (status < 0) return status;
    put_header(&file, &profile);
    for (uint64_t i = 0; i < r.row_count; i++) put_row(&file, &profile, r.table + (size_t)(i * width_of(&profile)));
    return dmb_text_close(&file);
}

int32_t dmb_profile_recorder_write_csv(const dmb_profile_recorder *recorder, const char *path)
{
    dmb_message why;
    dmb_message_clear(&why);
    const int32_t status = write_profiles(recorder, path, &why);
    return dmb_file_failed(NULL, "profile recorder", path, status, &why);
}

int32_t dmb_file_failed(const dmb_sim *sim, const char *call, const char *path, int32_t status, dmb_message *why)
{
    dmb_message none;
    if (status >= 0) return status;
    if (why == NULL) dmb_message_clear(why = &none);
    return dmb_sim_fail(sim, status, call, dmb_file_message(why, call, path, status));
}
