/* The recorder's table as comma-separated values: one header line, '.' as decimal mark in every locale, and enough
 * digits to reproduce every number exactly. */
#include <math.h>
#include <stddef.h>

#include "analysis/response/response.h"
#include "base/sized_struct.h"
#include "model/model.h"
#include "output/output.h"
#include "output/text_file.h"
#include "query/query.h"

static void put_numbered(dmb_text_file *file, const char *kind, uint32_t number)
{
    dmb_text_put(file, " ");
    dmb_text_put(file, kind);
    dmb_text_put(file, " ");
    dmb_text_put_count(file, number);
}

/* "string 0 pipe 99 at 1", "body 2": no commas */
static void put_part(dmb_text_file *file, const dmb_place *place, int32_t part_alone)
{
    static const char *const kinds[] = {
        "part",
        [DMB_PART_TIME_FUNCTION] = "time_function",
        [DMB_PART_WALL] = "wall",
        [DMB_PART_STRING] = "string",
        [DMB_PART_BODY] = "body",
        [DMB_PART_BIT] = "bit",
        [DMB_PART_STABILISER] = "stabiliser",
        [DMB_PART_DRIVE] = "drive",
        [DMB_PART_LOAD] = "load",
        [DMB_PART_JOINT] = "joint",
        [DMB_PART_COUPLING] = "coupling",
        [DMB_PART_CONSTRAINT] = "constraint",
        [DMB_PART_SPRING] = "spring",
        [DMB_PART_FORCE] = "force",
        [DMB_PART_STUCK] = "stuck",
        [DMB_PART_INPUT] = "input",
        [DMB_PART_EVENT] = "event",
    };
    const uint32_t kind = place->part.index >> 24, number = place->part.index & 0xFFFFFFu;
    const int known = kind < sizeof kinds / sizeof kinds[0] && kinds[kind] != NULL;
    put_numbered(file, known ? kinds[kind] : kinds[0], number);
    if (kind != DMB_PART_STRING || part_alone) return;
    put_numbered(file, "pipe", place->pipe);
    dmb_text_put(file, " at ");
    dmb_text_put_short(file, place->fraction);
}

/* For an unknown quantity the whole place is written. */
static void put_place(dmb_text_file *file, const dmb_output_entry *entry, const dmb_place *place)
{
    const int32_t kind = entry != NULL ? entry->place : DMB_AT_PLACE;
    const int named = place->part.index != 0;
    if (kind == DMB_AT_SCENE || (kind == DMB_AT_STRING && !named)) return;
    if (kind == DMB_AT_CONTACT || kind == DMB_AT_WINDOW)
        put_numbered(file, kind == DMB_AT_CONTACT ? "contact" : "watch", place->pipe);
    else
        put_part(file, place, kind == DMB_AT_STRING);
}

static void put_header(dmb_text_file *file, const dmb_recorder *r)
{
    dmb_text_put(file, "time [s]");
    for (uint32_t i = 0; i < r->output_count; ++i) {
        const dmb_output *output = &r->outputs[i];
        const dmb_output_entry *name = dmb_output_name_of(output->quantity);
        dmb_text_put(file, ",");
        dmb_text_put(file, name != NULL ? name->name : "unknown");
        put_place(file, name, &output->place);
        dmb_text_put(file, " [");
        dmb_text_put(file, name != NULL ? name->unit : "-");
        dmb_text_put(file, "]");
    }
    dmb_text_put(file, "\n");
}

static void put_rows(dmb_text_file *file, const dmb_recorder *r)
{
    const double *value = r->table;
    for (uint64_t row = 0; row < r->row_count; ++row) {
        for (uint32_t i = 0; i <= r->output_count; ++i) {
            if (i > 0) dmb_text_put(file, ",");
            dmb_text_put_number(file, *value++);
        }
        dmb_text_put(file, "\n");
    }
}

static int32_t write_recorder(const dmb_recorder *recorder, const char *path, dmb_message *why)
{
    dmb_recorder r;
    dmb_text_file file;
    int32_t status = dmb_recorder_read_struct(&r, recorder, why);
    if (status < 0) return status;
    if (path == NULL) return DMB_ERR_NULL;
    status = dmb_text_open(&file, path);
    if (status < 0) return status;
    put_header(&file, &r);
    put_rows(&file, &r);
    return dmb_text_close(&file);
}

int32_t dmb_recorder_write_csv(const dmb_recorder *recorder, const char *path)
{
    dmb_message why;
    dmb_message_clear(&why);
    const int32_t status = write_recorder(recorder, path, &why);
    return dmb_file_failed("recorder", path, status, &why);
}

/* A frequency response as comma-separated values: frequency, then amplitude and phase of each transfer function and of
 * each combined output. */

static void put_name(dmb_text_file *file, const char *what, const char *unit, uint32_t input, uint32_t output)
{
    dmb_text_put(file, what);
    dmb_text_put(file, " of output ");
    dmb_text_put_count(file, output);
    dmb_text_put(file, input == DMB_COMBINED ? " for all inputs" : " for input ");
    if (input != DMB_COMBINED) dmb_text_put_count(file, input);
    dmb_text_put(file, unit);
}

static void put_response_header(dmb_text_file *file, const dmb_response *response)
{
    dmb_text_put(file, "frequency [Hz]");
    for (uint32_t i = 0; i <= response->excitations; i++)
        for (uint32_t k = 0; k < response->outputs; k++) {
            const uint32_t input = i < response->excitations ? i : DMB_COMBINED;
            dmb_text_put(file, ",");
            put_name(file, "amplitude", "", input, k);
            dmb_text_put(file, ",");
            put_name(file, "phase", " [rad]", input, k);
        }
    dmb_text_put(file, "\n");
}

static void put_value(dmb_text_file *file, const double value[2])
{
    dmb_text_put(file, ",");
    dmb_text_put_number(file, hypot(value[0], value[1]));
    dmb_text_put(file, ",");
    dmb_text_put_number(file, atan2(value[1], value[0]));
}

static void put_row(dmb_text_file *file, const dmb_response *response, uint32_t point)
{
    dmb_text_put_number(file, response->frequency[point]);
    for (uint32_t i = 0; i < response->excitations; i++)
        for (uint32_t k = 0; k < response->outputs; k++)
            put_value(file, dmb_response_value(response, point, i) + 2 * (size_t)k);
    for (uint32_t k = 0; k < response->outputs; k++) {
        double value[2];
        dmb_response_combined(response, point, k, value);
        put_value(file, value);
    }
    dmb_text_put(file, "\n");
}

static int32_t write_response(const dmb_response *response, const char *path)
{
    dmb_text_file file;
    if (response == NULL || path == NULL) return DMB_ERR_NULL;
    if (!dmb_handle_is(response, DMB_HANDLE_RESPONSE)) return DMB_ERR_HANDLE;
    const int32_t status = dmb_text_open(&file, path);
    if (status < 0) return status;
    put_response_header(&file, response);
    for (uint32_t point = 0; point < response->points; point++) put_row(&file, response, point);
    return dmb_text_close(&file);
}

int32_t dmb_response_write_csv(const dmb_response *response, const char *path)
{
    return dmb_file_failed("response", path, write_response(response, path), NULL);
}
